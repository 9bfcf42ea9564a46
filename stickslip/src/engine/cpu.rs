//! Loops over tiles on threads, with the same bits for any number of them.
//!
//! Tiles of one colour scatter side by side, colours one after the other, and a tile's particles in their own order: no sum
//! depends on which thread comes first.

use super::Engine;
use crate::basis::Basis;
use crate::body::{Body, Particle};
use crate::grid::{Disjoint, Tile, Window};
use crate::tensor::Real;
use crate::transfer::Stencil;
use rayon::prelude::*;

/// A particle that a verb cannot go on with.
pub struct Fault {
    /// Index of the body.
    pub body: usize,
    /// Index of the particle in memory.
    pub particle: usize,
    /// What is wrong with it.
    pub kind: FaultKind,
}

/// What can be wrong with a particle.
pub enum FaultKind {
    /// Its deformation gradient has no positive determinant.
    Inverted,
    /// It left the domain.
    Escaped,
    /// No thickness leaves it without stress out of the plane.
    NoThickness,
    /// A value of it is not a finite number.
    NotFinite,
}

impl<T: Real, const D: usize, B: Basis<T>> Engine<T, D, B> {
    /// Lets every particle add to its tile's window, and the windows to the field.
    pub(super) fn scatter_each(
        &mut self,
        scatter: impl Fn(&Particle<T, D>, &Stencil<T, D, B>, &mut Window<T, D>, [i32; D]) + Sync,
    ) {
        let nodes = Disjoint::new(&mut self.field.nodes);
        let (cover, bodies, lattice) = (&self.cover, &self.bodies, &self.lattice);
        for color in &cover.colors {
            color.par_iter().with_min_len(4).for_each_init(Window::default, |window, &tile| {
                let tile = &cover.tiles[tile as usize];
                window.clear();
                for &index in cover.particles_of(tile) {
                    let particle = &bodies[tile.body].particles[index as usize];
                    let stencil = Stencil::<T, D, B>::new(lattice, particle);
                    scatter(particle, &stencil, window, tile.block);
                }
                // SAFETY: tiles of one colour share no slot, and colours follow one another.
                unsafe { window.add_to(&nodes, tile) };
            });
        }
    }

    /// Visits every particle of the deformable bodies with its stencil and window; returns the first fault by body and particle.
    pub(super) fn each_particle(
        &mut self,
        visit: impl Fn(
            &Body<T, D>,
            &mut Particle<T, D>,
            &Stencil<T, D, B>,
            &Window<T, D>,
            [i32; D],
        ) -> Result<(), FaultKind>
        + Sync,
    ) -> Option<Fault> {
        let mut particles: Vec<Vec<Particle<T, D>>> =
            self.bodies.iter_mut().map(|body| std::mem::take(&mut body.particles)).collect();
        let columns: Vec<Disjoint<Particle<T, D>>> = particles.iter_mut().map(|p| Disjoint::new(p)).collect();
        let (cover, field, bodies, lattice) = (&self.cover, &self.field, &self.bodies, &self.lattice);
        let of_tile = |window: &mut Window<T, D>, tile: &Tile<D>| -> Option<Fault> {
            let body = &bodies[tile.body];
            if body.rigid {
                return None;
            }
            window.load(field, tile);
            let mut first = None;
            for &index in cover.particles_of(tile) {
                // SAFETY: every particle belongs to one tile, and every tile to one call.
                let particle = unsafe { columns[tile.body].get(index as usize) };
                let stencil = Stencil::<T, D, B>::new(lattice, particle);
                if let Err(kind) = visit(body, particle, &stencil, window, tile.block) {
                    let fault = Fault { body: tile.body, particle: index as usize, kind };
                    first = earlier(first, Some(fault));
                }
            }
            first
        };
        let fault = (cover.tiles.par_iter().with_min_len(4))
            .map_init(Window::default, of_tile)
            .reduce(|| None, earlier);
        drop(columns);
        for (body, particles) in self.bodies.iter_mut().zip(particles) {
            body.particles = particles;
        }
        fault
    }
}

/// The fault of the lower body and particle.
fn earlier(a: Option<Fault>, b: Option<Fault>) -> Option<Fault> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if (b.body, b.particle) < (a.body, a.particle) { b } else { a }),
        (a, b) => a.or(b),
    }
}
