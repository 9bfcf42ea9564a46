//! Loads on bodies that ranks share: a node takes what acts on the points of all ranks.

use super::super::Engine;
use super::super::loads::{ForeignPoint, LoadedNode, LoadedPoint, UNKNOWN};
use crate::basis::Basis;
use crate::exact::ExactSum;
use crate::grid::{node_at, nodes_per_block};
use crate::lanes::Laned;
use crate::load::{LoadPoints, PointForce};
use crate::part::PartPoint;
use crate::ranks::{Message, Ranks, bytes_of, read};
use crate::tensor::Vector;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A point at a node that other ranks have, too.
#[derive(Serialize, Deserialize)]
struct SentPoint {
    /// Its load, and its number among the points of that.
    key: [u32; 2],
    /// Force, inertia, springs and velocity of a support, see [`PointForce`].
    felt: [[f64; 3]; 4],
    /// The nodes that move it, the axes along which they are mirror images, and N_i.
    nodes: Vec<([i32; 3], u32, f64)>,
}

/// A point whose particle moves to another rank, and its load.
#[derive(Serialize, Deserialize)]
pub(super) struct LeavingPoint {
    load: u32,
    point: PartPoint,
}

/// Points by the ranks to which they move.
pub(super) type LeavingPoints = BTreeMap<usize, Vec<LeavingPoint>>;

impl<T: Laned, const D: usize, B: Basis<T>> Engine<T, D, B> {
    /// Takes out the points that particles of a body carry which move to other ranks, by their places.
    pub(super) fn take_points_out(
        &mut self,
        body: usize,
        leavers: impl Iterator<Item = (usize, u32)>,
        points: &mut LeavingPoints,
    ) {
        let loaded = |(_, load): &(usize, &mut LoadPoints)| load.body == body && !load.points.is_empty();
        let mut loads = self.settings.loads.iter_mut().enumerate().filter(loaded).peekable();
        if loads.peek().is_none() {
            return;
        }
        let numbers = self.state.bodies[body].particles.numbers();
        let mut leavers: Vec<(u32, usize)> =
            leavers.map(|(rank, place)| (numbers[place as usize], rank)).collect();
        leavers.sort_unstable();
        for (i, load) in loads {
            let places = self.workspace.loads.places_of(i, load);
            let mut stay = 0;
            for place in 0..places.len() {
                let point = load.points[place];
                match leavers.binary_search_by_key(&point.particle, |(number, _)| *number) {
                    Ok(at) => {
                        points.entry(leavers[at].1).or_default().push(LeavingPoint { load: i as u32, point });
                    }
                    Err(_) => {
                        if stay < place {
                            (load.points[stay], places[stay]) = (point, places[place]);
                        }
                        stay += 1;
                    }
                }
            }
            load.points.truncate(stay);
            places.truncate(stay);
        }
    }

    /// Sends points to the ranks of their particles, and takes in those that come.
    pub(super) fn take_points_in(&mut self, ranks: &dyn Ranks, leaving: &LeavingPoints) {
        if self.settings.loads.iter().all(|load| load.count == 0) {
            return;
        }
        let messages = leaving.iter().map(|(rank, points)| (*rank, bytes_of(points))).collect();
        let came = ranks.exchange(messages);
        let mut more: BTreeMap<usize, Vec<PartPoint>> = BTreeMap::new();
        for LeavingPoint { load, point } in came.iter().flat_map(|(_, came)| read::<Vec<LeavingPoint>>(came))
        {
            more.entry(load as usize).or_default().push(point);
        }
        for (i, mut more) in more {
            let load = &mut self.settings.loads[i];
            let places = self.workspace.loads.places_of(i, load);
            more.sort_unstable_by_key(|point| point.number);
            // From the end on, where there is room.
            let mut known = load.points.len();
            let mut end = known + more.len();
            load.points.resize(end, more[0]);
            places.resize(end, UNKNOWN);
            while let Some(point) = more.pop() {
                while known > 0 && load.points[known - 1].number > point.number {
                    (known, end) = (known - 1, end - 1);
                    (load.points[end], places[end]) = (load.points[known], places[known]);
                }
                end -= 1;
                (load.points[end], places[end]) = (point, UNKNOWN);
            }
        }
    }

    /// Tells other ranks of the points at nodes that they have, too, and takes note of theirs.
    pub(in super::super) fn share_points(&mut self) {
        let Some(among) = &self.among else { return };
        let (active, room) = (&self.workspace.active, &mut self.workspace.loads);
        room.foreign.clear();
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
        let shared =
            room.points.iter().zip(&room.numbers).filter(|(point, _)| point.nodes.iter().any(is_shared));
        let sent: Vec<SentPoint> = shared
            .map(|(LoadedPoint { felt, nodes, .. }, &[load, point])| SentPoint {
                key: [load, self.settings.loads[load as usize].points[point as usize].number],
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
            for SentPoint { key, felt, nodes } in read::<Vec<SentPoint>>(&message) {
                let body = self.settings.loads[key[0] as usize].body;
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
                let felt = PointForce { force, inertia, spring, speed, ..PointForce::default() };
                room.foreign.push(ForeignPoint { key, felt, nodes: here.collect() });
            }
        }
        room.foreign.sort_unstable_by_key(|point| point.key);
    }

    /// Adds sums of all ranks up, where there are others.
    pub(in super::super) fn add_up(&self, sums: &mut [ExactSum]) {
        if let Some(among) = &self.among {
            among.add_up(sums.iter_mut());
        }
    }
}
