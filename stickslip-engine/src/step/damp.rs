//! The verb that damps the nodes' velocities, and what it takes.

use super::Engine;
use super::state::Workspace;
use crate::basis::Basis;
use crate::body::Body;
use crate::grid::{Disjoint, next_of, node_at, nodes_per_block};
use crate::lanes::Laned;
use crate::scene::StressUpdate;
use crate::tensor::{Real, Vector};
use crate::threads::{each, each_range};
use std::time::Instant;

/// Blocks that a thread takes at a time.
const BLOCKS: usize = 16;

impl<T: Laned, const D: usize, B: Basis<T>> Engine<T, D, B> {
    /// Damps the integrated velocities of deformable bodies, whose change the particles take, by
    /// [`crate::damping::NodeDamping::damped`]. What mirrors repeat is damped alike.
    pub(super) fn damp(&mut self, dt: T) {
        let damping = self.settings.damping;
        if !damping.acts() {
            return;
        }
        let start = Instant::now();
        let n = nodes_per_block(D);
        let (bodies, slots) = (&self.state.bodies, &self.workspace.active.slots);
        let field = &mut self.workspace.field;
        let (present, impulses) = (&field.present, &mut self.workspace.damping_impulses);
        impulses.resize(field.nodes.len(), Vector::ZERO);
        let nodes = Disjoint::new(&mut field.nodes);
        let impulses = Disjoint::new(impulses);
        each_range(slots.len(), BLOCKS, &|blocks| {
            for block in blocks.filter(|&block| !bodies[slots[block].0 as usize].is_rigid()) {
                // SAFETY: every block has nodes of its own.
                let (nodes, impulses) = unsafe { (nodes.part(block * n, n), impulses.part(block * n, n)) };
                let mut places = present[block];
                while let Some(local) = next_of(&mut places) {
                    let node = &mut nodes[local];
                    let damped = damping.damped(node.integrated, node.start, dt);
                    impulses[local] = (damped - node.integrated) * node.mass;
                    node.integrated = damped;
                }
            }
        });
        self.watch.lap("damping", start);
    }

    /// Books what damping took from the particles' kinetic energy in this step.
    ///
    /// ```text
    /// W = -sum J . (u^0 + u^1)/2     J: impulse of damping at a node, u: velocities interpolated before and after
    /// ```
    /// Exact for FLIP, see the work of friction. Where the step does not interpolate a second time, u^1 is the node's
    /// own new velocity: exact where the velocity changes alike all around.
    pub(super) fn book_damping(&mut self) {
        if !self.settings.damping.acts() {
            return;
        }
        let start = Instant::now();
        let interpolated_twice = self.settings.time.stress_update == StressUpdate::ModifiedLast;
        let [taken, ..] = self.workspace.sum_over_nodes(
            &self.state.bodies,
            |Workspace { field, damping_impulses, .. }, _, index| {
                let node = &field.nodes[index];
                let after = if interpolated_twice { node.velocity } else { node.integrated };
                [-(damping_impulses[index].dot(node.start + after) * T::HALF).f64(), 0.0, 0.0, 0.0]
            },
        );
        self.state.damping += taken;
        self.watch.lap("damping", start);
    }
}

/// What is summed over nodes at a time.
pub(super) type NodeTotals = [f64; 4];

impl<T: Real, const D: usize> Workspace<T, D> {
    /// Sums over the nodes of deformable bodies that have mass and repeat no other behind a mirror. `of_node` is told
    /// which node it is, and its index. Block after block, whoever took them.
    pub(super) fn sum_over_nodes(
        &mut self,
        bodies: &[Body<T, D>],
        of_node: impl Fn(&Self, [i32; D], usize) -> NodeTotals + Sync,
    ) -> NodeTotals
    where
        Self: Sync,
    {
        let n = nodes_per_block(D);
        let mut sums = std::mem::take(&mut self.block_sums);
        sums.clear();
        sums.resize(self.active.slots.len(), NodeTotals::default());
        let workspace = &*self;
        each(&mut sums, BLOCKS, |slot, sum| {
            let (body, block) = workspace.active.slots[slot];
            if bodies[body as usize].is_rigid() {
                return;
            }
            let mut places = workspace.field.present[slot];
            while let Some(local) = next_of(&mut places) {
                let place = node_at(block, local);
                if !workspace.boundary.mirrors(place) {
                    let found = of_node(workspace, place, slot * n + local);
                    sum.iter_mut().zip(found).for_each(|(sum, found)| *sum += found);
                }
            }
        });
        let mut total = NodeTotals::default();
        for sum in &sums {
            total.iter_mut().zip(sum).for_each(|(total, sum)| *total += sum);
        }
        self.block_sums = sums;
        total
    }
}
