//! What walls give to nodes in a step: reactions of the domain's faces.
//!
//! A fixed face gives a node whatever takes its velocity away. A mirror gives the particles before it
//!
//! ```text
//! R = sum_on (-dt f - m v) + sum_behind (-2 dt f + 2 m dv)          across the mirror
//! ```
//! f: force of the stress of these particles alone; on the mirror, v: the velocity across it that everything else gives
//! a node; behind it, dv: the change of the velocity of a node in the step. This is what momentum needs: the forces of
//! the stress of one side add up to nothing over all nodes, and what particles give to nodes behind the mirror counts
//! before it once more, with the other sign.

use super::{Boundary, Wall};
use crate::grid::{Field, Node};
use crate::scheme::Face;
use crate::tensor::{Real, Vector};

/// A node that a wall governs.
#[derive(Clone, Copy, Debug)]
pub struct WallNode {
    /// Its index in the field.
    pub index: usize,
    /// Number of the wall.
    pub wall: usize,
    /// Index of its body.
    pub body: u32,
    /// Where it is; of one behind a mirror, where it is seen on it.
    pub place: [i32; 3],
    /// Whether the wall takes its momentum: a fixed face does that before a mirror, and the first of several.
    takes_momentum: bool,
}

/// Nodes that walls govern, and what they are given in a step.
#[derive(Clone, Debug, Default)]
pub struct WallTally {
    /// On and behind fixed faces, and on mirrors.
    held: Vec<WallNode>,
    /// Impulse on each of them by what took its velocity [N s].
    impulses: Vec<[f64; 3]>,
    /// Of each, the force of the stress along a mirror's axis [N].
    forces: Vec<f64>,
    /// Behind mirrors.
    behind: Vec<WallNode>,
    /// Whether the nodes' velocities are those whose change the particles take.
    counts: bool,
}

impl WallTally {
    /// No nodes.
    pub fn clear(&mut self) {
        self.held.clear();
        self.behind.clear();
    }

    /// Takes up a node that a wall governs, unless it repeats another behind another mirror.
    pub fn add<const D: usize>(
        &mut self,
        walls: &[Wall],
        wall: usize,
        (index, body, node): (usize, u32, [i32; D]),
    ) {
        let others = || walls.iter().enumerate().filter(|(i, _)| *i != wall);
        if others().any(|(_, other)| other.face == Face::Symmetry && other.depth(node) < 0) {
            return;
        }
        let mirror = walls[wall].face == Face::Symmetry;
        let holds = |(i, other): (usize, &Wall)| {
            other.face == Face::Fixed && other.depth(node) <= 0 && (mirror || i < wall)
        };
        let takes_momentum = !others().any(holds);
        let mut place = [0; 3];
        place[..D].copy_from_slice(&node);
        let Wall { axis, node: face, .. } = walls[wall];
        let behind = mirror && walls[wall].depth(node) < 0;
        if behind {
            place[axis] = face;
        }
        let node = WallNode { index, wall, body, place, takes_momentum };
        if behind {
            self.behind.push(node);
        } else if mirror || takes_momentum {
            self.held.push(node);
        }
    }

    /// Has room for what the nodes are given.
    pub fn begin(&mut self) {
        self.impulses.clear();
        self.impulses.resize(self.held.len(), [0.0; 3]);
        self.forces.clear();
        self.forces.resize(self.held.len(), 0.0);
    }

    /// Notes the forces of the stress on mirrors, before these take them.
    pub fn take_forces<T: Real, const D: usize>(&mut self, walls: &[Wall], nodes: &[Node<T, D>]) {
        for (held, force) in self.held.iter().zip(&mut self.forces) {
            if walls[held.wall].face == Face::Symmetry {
                *force += nodes[held.index].force[walls[held.wall].axis].f64();
            }
        }
    }

    /// Notes the momentum that walls are about to take, where it counts.
    pub fn take_momentum<T: Real, const D: usize>(&mut self, walls: &[Wall], nodes: &[Node<T, D>]) {
        if !self.counts {
            return;
        }
        for (held, impulse) in self.held.iter().zip(&mut self.impulses) {
            let (node, Wall { axis, face, .. }) = (&nodes[held.index], walls[held.wall]);
            if held.takes_momentum && node.mass > T::ZERO {
                let taken = |i: &usize| face == Face::Fixed || *i == axis;
                (0..D).filter(taken).for_each(|i| impulse[i] -= (node.mass * node.velocity[i]).f64());
            }
        }
    }
}

impl Boundary {
    /// From now on in the step, velocities are those whose change the particles take, or no more.
    pub fn count(&mut self, counts: bool) {
        if let Some(tally) = &mut self.tally {
            tally.counts = counts;
        }
    }

    /// Tells what walls gave to each node in a step of `dt` [s], and forgets it.
    pub fn book<T: Real, const D: usize>(
        &mut self,
        field: &Field<T, D>,
        dt: T,
        mut give: impl FnMut(&WallNode, [f64; 3]),
    ) {
        let Some(tally) = &mut self.tally else { return };
        for ((held, impulse), force) in tally.held.iter().zip(&tally.impulses).zip(&tally.forces) {
            let mut impulse = *impulse;
            impulse[self.walls[held.wall].axis] -= dt.f64() * force;
            give(held, impulse);
        }
        for behind in &tally.behind {
            let (node, axis) = (&field.nodes[behind.index], self.walls[behind.wall].axis);
            if node.mass > T::ZERO {
                let change: Vector<T, D> = node.integrated - node.start;
                let mut impulse = [0.0; 3];
                impulse[axis] = 2.0 * (node.mass * change[axis] - node.force[axis] * dt).f64();
                give(behind, impulse);
            }
        }
        tally.begin();
    }
}
