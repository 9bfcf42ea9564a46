//! What a scene costs in memory.

use crate::body::BodyHere;
use crate::check::{BodySize, Footprint, OwnGrid};
use crate::geometry::Bounds;
use crate::grid::Node;
use crate::particles::Particles;
use crate::scene::{Body, Precision, Scene};
use crate::step::{ReferenceBody, heated_bodies, own_columns, particles_around};
use crate::tensor::{Real, Vector};
use std::collections::HashMap;
use stickslip_reference::cells::Table;
use stickslip_reference::contact::{Memory, Neighbours, Touch};
use stickslip_reference::interior::Interior;
use stickslip_reference::surface::SurfacePoint;

/// Each particle's place in the order of blocks and cells, of which there are two: one while the next is made [bytes].
const ORDER_BYTES: usize = 2 * size_of::<u32>();
/// Nodes per cell that particles fill: blocks are covered whole, with those that a body's rim reaches.
const NODES_PER_CELL: f64 = 4.0;
/// What a simulation takes whatever is in it: rooms of threads, and of sums [bytes].
const ITSELF: f64 = 2e5;
/// Lists of points that touch: those of each body, and of all.
const TOUCHES: usize = 2;

/// What this engine takes.
#[derive(Clone, Copy, Debug)]
pub struct OfEngine;

impl Footprint for OfEngine {
    fn particles_around(&self, scene: &Scene, body: usize, boxes: &[Bounds]) -> usize {
        particles_around(scene, body, boxes)
    }

    fn memory(&self, scene: &Scene, bodies: &[BodySize]) -> f64 {
        let Cost { copied, other } = cost(scene, bodies);
        // With the copy of the state before each step, where steps may be taken again.
        let copies = if scene.health.retries > 0 { 2.0 } else { 1.0 };
        copies * copied + other + ITSELF
    }

    fn copy(&self, scene: &Scene, bodies: &[BodySize]) -> f64 {
        cost(scene, bodies).copied
    }
}

/// Memory of bodies [bytes].
#[derive(Clone, Copy, Debug, Default)]
struct Cost {
    /// Of what moves, which is copied for checkpoints.
    copied: f64,
    /// Of what is constant, or made anew.
    other: f64,
}

impl Cost {
    fn and(self, more: Cost) -> Cost {
        Cost { copied: self.copied + more.copied, other: self.other + more.other }
    }
}

fn cost(scene: &Scene, bodies: &[BodySize]) -> Cost {
    match (scene.dimension.axes(), scene.precision) {
        (2, Precision::Double) => cost_of::<f64, 2>(scene, bodies),
        (2, Precision::Single) => cost_of::<f32, 2>(scene, bodies),
        (_, Precision::Double) => cost_of::<f64, 3>(scene, bodies),
        (_, Precision::Single) => cost_of::<f32, 3>(scene, bodies),
    }
}

fn cost_of<T: Real, const D: usize>(scene: &Scene, sizes: &[BodySize]) -> Cost {
    let heated = heated_bodies(scene);
    let of_body = |(number, (body, size)): (usize, (&Body, &BodySize))| {
        let particles = Cost {
            copied: Particles::<T, D>::bytes_of(
                size.particles,
                own_columns(scene, body, heated.contains(&number)),
            ) as f64,
            other: 0.0,
        };
        particles.and(match &size.grid {
            Some(grid) => own_grid::<T, D>(grid),
            None => common_grid::<T, D>(scene, body, size.particles),
        })
    };
    let of_bodies = scene.bodies.iter().zip(sizes).enumerate().map(of_body);
    let grids: Vec<OwnGrid> = sizes.iter().filter_map(|size| size.grid).collect();
    of_bodies.fold(tables::<T, D>(&grids), Cost::and)
}

/// What particles on the common grid take there.
fn common_grid<T: Real, const D: usize>(scene: &Scene, body: &Body, particles: usize) -> Cost {
    let per_cell = (scene.discretization.cell / scene.lattice(body).spacing).powi(D as i32);
    let nodes = NODES_PER_CELL * particles as f64 / per_cell;
    let order = ORDER_BYTES * particles;
    Cost { copied: 0.0, other: nodes * size_of::<Node<T, D>>() as f64 + order as f64 }
}

/// What a body on a grid of its own takes beside its particles, with its part of contact.
fn own_grid<T: Real, const D: usize>(grid: &OwnGrid) -> Cost {
    let &OwnGrid { nodes, bytes, points, near, .. } = grid;
    // Masses; places, velocities and forces.
    let of_nodes = nodes * (size_of::<f64>() + 3 * size_of::<Vector<f64, D>>());
    let itself = size_of::<BodyHere<T, D>>() + size_of::<Interior<D>>() + size_of::<ReferenceBody<D>>();
    let surface = points * size_of::<SurfacePoint<D>>();
    // With what is known of them from the step before.
    let contact = near * (TOUCHES * size_of::<Touch<D>>() + size_of::<Memory>());
    Cost {
        copied: (of_nodes + near * size_of::<Memory>()) as f64,
        other: (itself + bytes + surface + contact + Neighbours::<D>::bytes_of(points, near)) as f64,
    }
}

/// What the functions at the particles of cells take: bodies that are alike share them.
fn tables<T: Real, const D: usize>(grids: &[OwnGrid]) -> Cost {
    let kinds: HashMap<u64, usize> =
        grids.iter().map(|grid| (grid.kinds.likeness, grid.kinds.count)).collect();
    let cells = grids.iter().map(|grid| grid.cells).sum();
    Cost { copied: 0.0, other: Table::<T, D>::bytes_of(kinds.into_values().sum(), cells) as f64 }
}
