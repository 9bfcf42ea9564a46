//! Loads on bodies that ranks share: a node takes what acts on the points of all ranks.

use super::super::Engine;
use super::super::loads::{ForeignPoint, LoadedNode, LoadedPoint, UNKNOWN, key_of};
use crate::exact::ExactSum;
use crate::grid::{SentBlock, is_within, node_at, nodes_per_block, window_side};
use crate::lanes::Laned;
use crate::load::{LoadPoints, PointForce};
use crate::part::PartPoint;
use crate::ranks::{Message, Ranks, bytes_of, read};
use crate::tensor::Vector;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A node that moves a point: its place, the axes along which it is a mirror image, and N_i.
type SentNode = ([i32; 3], u32, f64);

/// A point at nodes that another rank has, too.
#[derive(Serialize, Deserialize)]
struct SentPoint {
    /// Its load, and its number among the points of that.
    key: [u32; 2],
    /// Force, inertia, springs and velocity of a support, see [`PointForce`].
    felt: [[f64; 3]; 4],
    /// Those of the nodes that the other rank has.
    nodes: Vec<SentNode>,
}

/// A point whose particle moves to another rank, and its load.
#[derive(Serialize, Deserialize)]
pub(super) struct LeavingPoint {
    load: u32,
    point: PartPoint,
}

/// Points by the ranks to which they move.
pub(super) type LeavingPoints = BTreeMap<usize, Vec<LeavingPoint>>;

impl<T: Laned, const D: usize> Engine<T, D> {
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

    /// Tells each other rank of the points at nodes that it has, too, and takes note of theirs.
    pub(in super::super) fn share_points(&mut self) {
        let Some(among) = &self.among else { return };
        let (active, room) = (&self.workspace.active, &mut self.workspace.loads);
        room.foreign.clear();
        let Some(border) = active.border.as_deref() else { return };
        let (n, side) = (nodes_per_block(D), window_side(self.kernels.width));
        let blocks = active.blocks_sent();
        let mut sent: Vec<Vec<SentPoint>> = border.outgoing.iter().map(|_| Vec::new()).collect();
        let mut wanted: Vec<(usize, SentNode)> = Vec::new();
        for (LoadedPoint { felt, nodes, .. }, &number) in room.points.iter().zip(&room.numbers) {
            wanted.clear();
            for &LoadedNode { index, mirrored, weight } in nodes {
                let (slot, local) = (index as usize / n, index as usize % n);
                let (_, block) = active.slots[slot];
                let first = blocks.partition_point(|there| there.block < block);
                let there = blocks[first..].iter().take_while(|there| there.block == block);
                for SentBlock { to, .. } in there.filter(|there| is_within::<D>(local, there.cut, side)) {
                    let place: [i32; D] = node_at(block, local);
                    let place = std::array::from_fn(|k| if k < D { place[k] } else { 0 });
                    wanted.push((*to, (place, mirrored, weight.f64())));
                }
            }
            wanted.sort_by_key(|(to, _)| *to);
            for nodes in wanted.chunk_by(|a, b| a.0 == b.0) {
                sent[nodes[0].0].push(SentPoint {
                    key: key_of(&self.settings.loads, number),
                    felt: [felt.force, felt.inertia, felt.spring, felt.speed].map(|felt| felt.space()),
                    nodes: nodes.iter().map(|(_, node)| *node).collect(),
                });
            }
        }
        let to = border.outgoing.iter().zip(sent).filter(|(_, sent)| !sent.is_empty());
        let messages: Vec<Message> = to.map(|(traffic, sent)| (traffic.rank, bytes_of(&sent))).collect();
        for (_, message) in among.ranks.exchange(messages) {
            for SentPoint { key, felt, nodes } in read::<Vec<SentPoint>>(&message) {
                let body = self.settings.loads[key[0] as usize].body;
                let here = nodes.into_iter().map(|(node, mirrored, weight)| {
                    let index = active.node_index(body, std::array::from_fn(|k| node[k]));
                    let index = index.expect("nodes are sent to those who have them") as u32;
                    LoadedNode { index, mirrored, weight: T::of(weight) }
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
