//! Loads on bodies that ranks share: a node takes what acts on the points of all ranks.

use super::super::Engine;
use super::super::loads::{LoadedNode, LoadedPoint};
use crate::basis::Basis;
use crate::exact::ExactSum;
use crate::grid::{node_at, nodes_per_block};
use crate::lanes::Laned;
use crate::load::PointForce;
use crate::ranks::{Message, bytes_of, read};
use crate::tensor::Vector;
use serde::{Deserialize, Serialize};

/// A point at a node that other ranks have, too.
#[derive(Serialize, Deserialize)]
struct SentPoint {
    /// Its place among the points of all loads.
    point: u32,
    /// Force, inertia, springs and velocity of a support, see [`PointForce`].
    felt: [[f64; 3]; 4],
    /// The nodes that move it, the axes along which they are mirror images, and N_i.
    nodes: Vec<([i32; 3], u32, f64)>,
}

impl<T: Laned, const D: usize, B: Basis<T>> Engine<T, D, B> {
    /// Tells other ranks of the points at nodes that they have, too, and takes note of theirs.
    pub(in super::super) fn share_points(&mut self) {
        let Some(among) = &self.among else { return };
        let (active, room) = (&self.workspace.active, &mut self.workspace.loads);
        let nodes_here = &self.workspace.field.nodes;
        let Some(border) = active.border.as_deref() else { return };
        let n = nodes_per_block(D);
        // Blocks of this rank's tiles that others hold, too: with a tile of any body.
        let blocks = active.blocks_sent();
        let is_shared = |node: &LoadedNode<T>| {
            let (_, block) = active.slots[node.index as usize / n];
            blocks.binary_search(&block).is_ok()
        };
        let place = |index: u32| {
            let (_, block) = active.slots[index as usize / n];
            let node: [i32; D] = node_at(block, index as usize % n);
            std::array::from_fn(|k| if k < D { node[k] } else { 0 })
        };
        let shared = room.points.iter().zip(0..).filter(|(point, _)| point.nodes.iter().any(is_shared));
        let sent: Vec<SentPoint> = shared
            .map(|(LoadedPoint { felt, nodes, .. }, point)| SentPoint {
                point,
                felt: [felt.force, felt.inertia, felt.spring, felt.speed].map(|felt| felt.space()),
                nodes: (nodes.iter())
                    .map(|node| (place(node.index), node.mirrored, node.weight.f64()))
                    .collect(),
            })
            .collect();
        let message = bytes_of(&sent);
        let to = border.outgoing.iter().filter(|_| !sent.is_empty());
        let messages: Vec<Message> = to.map(|traffic| (traffic.rank, message.clone())).collect();
        for (_, message) in among.ranks.exchange(messages) {
            for SentPoint { point, felt, nodes } in read::<Vec<SentPoint>>(&message) {
                let [load, _] = room.numbers[point as usize];
                let body = self.settings.loads[load as usize].body;
                let here = nodes.into_iter().filter_map(|(node, mirrored, weight)| {
                    // One without mass is beyond what this rank has of the block.
                    let index = active.node_index(body, std::array::from_fn(|k| node[k]))?;
                    (nodes_here[index].mass > T::ZERO).then(|| LoadedNode {
                        index: index as u32,
                        mirrored,
                        weight: T::of(weight),
                    })
                });
                let [force, inertia, spring, speed] = felt.map(Vector::of);
                let known = &mut room.points[point as usize];
                known.felt = PointForce { force, inertia, spring, speed, ..PointForce::default() };
                known.nodes.clear();
                known.nodes.extend(here);
            }
        }
    }

    /// Adds sums of all ranks up, where there are others.
    pub(in super::super) fn add_up(&self, sums: &mut [ExactSum]) {
        if let Some(among) = &self.among {
            among.add_up(sums.iter_mut());
        }
    }
}
