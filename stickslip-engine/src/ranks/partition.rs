//! Which rank owns which block.

use super::{Ranks, combined, dealt};
use crate::grid::Periods;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, HashMap};

/// Parts of space, one a rank, by recursive bisection (Berger and Bokhari 1987): ranks are halved, and space with them
/// by a plane across the axis along which least lies beside it, so that both halves have their share of the load; where
/// the plane would cut through a layer of blocks, the next axes decide within that. Parts are compact, their surfaces
/// small, and bodies that touch along a plane are not parted there.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Partition {
    /// How many ranks.
    ranks: usize,
    /// Where ranks are halved: of all, then of the first half, and behind that of the second.
    cuts: Vec<Cut>,
}

/// Blocks on one side of it belong to the first half of some ranks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Cut {
    axis: usize,
    /// The first block on the other side, seen from the axis.
    from: [i32; 3],
}

/// What there is to do at a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BlockLoad {
    /// The block; in the plane the last number is 0.
    pub block: [i32; 3],
    /// How much, in any unit.
    pub load: u64,
    /// Whether several bodies reach nodes there, so that they may touch.
    pub meets: bool,
}

impl BlockLoad {
    /// That of a block in `D` dimensions.
    pub fn new<const D: usize>(block: [i32; D], load: u64, meets: bool) -> Self {
        BlockLoad { block: std::array::from_fn(|k| if k < D { block[k] } else { 0 }), load, meets }
    }
}

/// Particles of several bodies by their blocks in the first period, to be shared out.
#[derive(Clone, Debug, Default)]
pub struct Census<const D: usize> {
    periods: Periods<D>,
    blocks: HashMap<[i32; D], Counted>,
}

/// What is known of a block.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct Counted {
    /// Its particles.
    count: u64,
    /// The body that the last of them belongs to.
    last: Option<u32>,
    /// A body that may reach it.
    body: Option<u32>,
    /// Whether another one may.
    several: bool,
}

impl Counted {
    fn reach(&mut self, body: u32) {
        self.several |= self.body.is_some_and(|other| other != body);
        self.body = Some(body);
    }
}

impl<const D: usize> Census<D> {
    /// None yet, on a grid that repeats.
    pub fn new(periods: Periods<D>) -> Self {
        Census { periods, blocks: HashMap::new() }
    }

    /// Counts a particle of a body in a block; bodies come one after the other. Its body may reach the next block along
    /// each axis.
    pub fn count(&mut self, body: usize, block: [i32; D]) {
        let body = body as u32;
        let here = self.blocks.entry(block).or_default();
        here.count += 1;
        if here.last.replace(body) != Some(body) {
            for corner in 0..1 << D {
                let reached = std::array::from_fn(|k| block[k] + (corner >> k & 1));
                self.blocks.entry(self.periods.wrapped(reached)).or_default().reach(body);
            }
        }
    }

    /// Takes note of what another rank counted in a block.
    fn add(&mut self, block: [i32; D], counted: &Counted) {
        let here = self.blocks.entry(block).or_default();
        here.count += counted.count;
        here.several |= counted.several;
        counted.body.into_iter().for_each(|body| here.reach(body));
    }

    /// The census of all ranks, each of which counted some particles, of the blocks that this one sees to.
    pub fn of_all(self, ranks: &dyn Ranks) -> Self {
        let told =
            |(block, counted): ([i32; D], Counted)| (seer(block, ranks.count()), (block.to_vec(), counted));
        let mut here = Census::new(self.periods);
        for (block, counted) in dealt(ranks, self.blocks.into_iter().map(told)) {
            here.add(std::array::from_fn(|k| block[k]), &counted);
        }
        here
    }

    /// Parts of space with about as many particles each, by what each rank sees to.
    pub fn partition(&self, ranks: &dyn Ranks) -> Partition {
        let loaded = self.blocks.iter().filter(|(_, counted)| counted.count > 0);
        let load =
            |(block, counted): (&[i32; D], &Counted)| BlockLoad::new(*block, counted.count, counted.several);
        Partition::among_ranks::<D>(ranks, None, loaded.map(load).collect())
    }
}

/// The rank that sees to a block while ranks count particles, for it must be one of them.
fn seer<const D: usize>(block: [i32; D], ranks: usize) -> usize {
    let mix = |mixed: u64, place: &i32| {
        (mixed ^ u64::from(place.cast_unsigned())).wrapping_mul(0x9e37_79b9_7f4a_7c15)
    };
    ((block.iter().fold(0, mix) >> 32) % ranks as u64) as usize
}

/// So much more may lie beside a plane before another axis than that of an earlier partition is cut: particles would
/// have to move house for little.
const MORE: f64 = 1.25;
/// What lies beside a plane where bodies may touch costs so many times as much: both sides find the contact.
const CONTACT: u64 = 5;

/// Numbers that ranks add up place by place: the load there, and what it weighs beside a plane; by part of space, axis
/// and place along it.
type Layers = BTreeMap<(u32, u8, i32), [u64; 2]>;

/// A part of space that some ranks share.
struct Shared {
    /// How many.
    ranks: usize,
    /// Place of the cut that halves it.
    cut: usize,
    /// The loads there that this rank knows.
    loads: Vec<BlockLoad>,
}

impl Partition {
    /// [`Partition::balanced`], of blocks whose loads these ranks know.
    pub fn among_ranks<const D: usize>(
        ranks: &dyn Ranks,
        before: Option<&Partition>,
        own: Vec<BlockLoad>,
    ) -> Self {
        let together = |layers: Layers| combined(ranks, &layers, join_layers);
        Self::balanced::<D>(ranks.count(), before, (own, &together))
    }

    /// Parts with about the same load each, of blocks whose loads some ranks know, each its own; cut along the same
    /// axes as an earlier partition where these are nearly as good. `together` adds up what all of them say.
    fn balanced<const D: usize>(
        ranks: usize,
        before: Option<&Partition>,
        (own, together): (Vec<BlockLoad>, &dyn Fn(Layers) -> Layers),
    ) -> Self {
        let before = before.filter(|before| before.ranks == ranks);
        let mut cuts = vec![Cut { axis: 0, from: [i32::MAX; 3] }; ranks.max(1) - 1];
        let mut parts = vec![Shared { ranks, cut: 0, loads: own }];
        loop {
            parts.retain(|part| part.ranks > 1);
            if parts.is_empty() {
                return Partition { ranks, cuts };
            }
            let usual = |part: &Shared| before.map(|before| before.cuts[part.cut].axis);
            let found = find_cuts::<D>(&parts, &usual, together);
            let mut halves = Vec::with_capacity(2 * parts.len());
            for (Shared { ranks, cut, loads }, found) in parts.into_iter().zip(found) {
                cuts[cut] = found;
                let is_before = |load: &BlockLoad| seen_from::<D>(found.axis, load.block) < found.from;
                let (one, other) = loads.into_iter().partition(is_before);
                let first = ranks / 2;
                halves.push(Shared { ranks: first, cut: cut + 1, loads: one });
                // Behind the cuts of the first half.
                halves.push(Shared { ranks: ranks - first, cut: cut + first, loads: other });
            }
            parts = halves;
        }
    }

    /// The rank that owns a block.
    pub fn owner<const D: usize>(&self, block: [i32; D]) -> usize {
        let (mut rank, mut count, mut cut) = (0, self.ranks, 0);
        while count > 1 {
            let first = count / 2;
            let Cut { axis, from } = self.cuts[cut];
            cut += 1;
            if seen_from::<D>(axis, BlockLoad::new(block, 0, false).block) < from {
                count = first;
            } else {
                // Behind the cuts of the first half.
                (rank, count, cut) = (rank + first, count - first, cut + first - 1);
            }
        }
        rank
    }
}

/// Where each part of space is halved: so that each half of its ranks has its share of the load.
fn find_cuts<const D: usize>(
    parts: &[Shared],
    usual: &dyn Fn(&Shared) -> Option<usize>,
    together: &dyn Fn(Layers) -> Layers,
) -> Vec<Cut> {
    let mut layers = Layers::new();
    for (i, part) in (0..).zip(parts) {
        for load in &part.loads {
            for axis in 0..D {
                add(&mut layers, (i, axis as u8, load.block[axis]), load);
            }
        }
    }
    let layers = together(layers);
    let mut axes = Vec::new();
    // Of each part the load before the cut that is wanted, and the place of the cut as far as it is known, seen from
    // its axis.
    let mut wanted = Vec::new();
    let mut places: Vec<Vec<i32>> = Vec::new();
    for (i, part) in (0..).zip(parts) {
        let crossings: [_; D] = std::array::from_fn(|axis| {
            let along = along(&layers, (i, axis as u8));
            let whole: u64 = along.iter().map(|(_, [load, _])| load).sum();
            let wanted = whole as f64 * (part.ranks / 2) as f64 / part.ranks as f64;
            crossing(&along, wanted)
                .map(|(at, before)| (along[at].0, wanted - before, beside(&along, at, wanted - before)))
        });
        let costs = crossings.map(|crossing| crossing.map_or(0.0, |(.., beside)| beside));
        let least = (0..D).fold(0, |a, b| if costs[b] < costs[a] { b } else { a });
        let axis = usual(part).filter(|&usual| costs[usual] <= MORE * costs[least]).unwrap_or(least);
        axes.push(axis);
        wanted.push(crossings[axis].map_or(0.0, |(_, rest, _)| rest));
        places.push(crossings[axis].iter().map(|(place, ..)| *place).collect());
    }
    for step in 1..D {
        let mut rows = Layers::new();
        for (i, part) in parts.iter().enumerate() {
            let next = (axes[i] + step) % D;
            for load in
                part.loads.iter().filter(|load| seen_from::<D>(axes[i], load.block).starts_with(&places[i]))
            {
                add(&mut rows, (i as u32, 0, load.block[next]), load);
            }
        }
        let rows = together(rows);
        for (i, place) in places.iter_mut().enumerate() {
            let along = along(&rows, (i as u32, 0));
            let Some((at, before)) = crossing(&along, wanted[i]) else { continue };
            wanted[i] -= before;
            place.push(along[at].0);
            if step + 1 == D && along[at].1[0] as f64 - wanted[i] < wanted[i] {
                // It is nearer to the end of the block.
                *place.last_mut().expect("it has some") += 1;
            }
        }
    }
    let cut = |(axis, place): (usize, Vec<i32>)| {
        let is_known = place.len() == D;
        let from = |k: usize| if !is_known { i32::MAX } else { place.get(k).copied().unwrap_or(0) };
        Cut { axis, from: std::array::from_fn(from) }
    };
    axes.into_iter().zip(places).map(cut).collect()
}

fn add(layers: &mut Layers, place: (u32, u8, i32), load: &BlockLoad) {
    let weight = load.load * if load.meets { CONTACT } else { 1 };
    add_sums(layers, place, [load.load, weight]);
}

fn add_sums(layers: &mut Layers, place: (u32, u8, i32), [load, weight]: [u64; 2]) {
    let sums = layers.entry(place).or_default();
    *sums = [sums[0] + load, sums[1] + weight];
}

/// The layers of a part along an axis, by their places.
fn along(layers: &Layers, (part, axis): (u32, u8)) -> Vec<(i32, [u64; 2])> {
    let all = layers.range((part, axis, i32::MIN)..=(part, axis, i32::MAX));
    all.map(|(&(.., place), &layer)| (place, layer)).collect()
}

/// Adds what two ranks say.
fn join_layers(mut layers: Layers, others: Layers) -> Layers {
    others.into_iter().for_each(|(place, sums)| add_sums(&mut layers, place, sums));
    layers
}

/// The first of some layers with which the load comes to what is wanted, and the load before it.
fn crossing(along: &[(i32, [u64; 2])], wanted: f64) -> Option<(usize, f64)> {
    let mut sum = 0;
    for (at, (_, [load, _])) in along.iter().enumerate() {
        if (sum + load) as f64 >= wanted {
            return Some((at, sum as f64));
        }
        sum += load;
    }
    // Whatever is lost to round-off.
    let (at, (_, [load, _])) = along.iter().enumerate().next_back()?;
    Some((at, (sum - load) as f64))
}

/// What lies on both sides of a cut that leaves a load of a layer before it: a part of the layer with the next one
/// behind it, and the other part with the one before.
fn beside(along: &[(i32, [u64; 2])], at: usize, rest: f64) -> f64 {
    let (place, [load, weight]) = along[at];
    let before = rest / load.max(1) as f64;
    let weight_at = |place: i32| {
        along.binary_search_by_key(&place, |(place, _)| *place).map_or(0.0, |at| along[at].1[1] as f64)
    };
    weight as f64 + before * weight_at(place + 1) + (1.0 - before) * weight_at(place - 1)
}

/// A block's place along an axis, and then along the others.
fn seen_from<const D: usize>(axis: usize, block: [i32; 3]) -> [i32; 3] {
    std::array::from_fn(|k| if k < D { block[(axis + k) % D] } else { 0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ranks::Threads;

    /// A partition by one rank that knows all loads.
    fn balanced<const D: usize>(
        ranks: usize,
        before: Option<&Partition>,
        loads: Vec<BlockLoad>,
    ) -> Partition {
        Partition::balanced::<D>(ranks, before, (loads, &|layers| layers))
    }

    /// 16 x 16 blocks: four ranks have a square of them each, and three a third.
    #[test]
    fn loads_are_balanced() {
        let blocks: Vec<[i32; 2]> = (0..16).flat_map(|x| (0..16).map(move |y| [x, y])).collect();
        let loads: Vec<BlockLoad> = blocks.iter().map(|&block| BlockLoad::new(block, 3, false)).collect();
        let partition = balanced::<2>(4, None, loads.clone());
        for x in 0..16 {
            for y in 0..16 {
                assert_eq!(partition.owner([x, y]), (x / 8 * 2 + y / 8) as usize, "{x} {y}");
            }
        }
        let three = balanced::<2>(3, None, loads);
        let counts: Vec<usize> =
            (0..3).map(|rank| blocks.iter().filter(|block| three.owner(**block) == rank).count()).collect();
        assert!(counts.iter().all(|count| count.abs_diff(85) <= 1), "{counts:?}");
    }

    /// Several bodies have a load at the same block, which one rank owns.
    #[test]
    fn a_block_is_not_cut() {
        let twice = (0..7).flat_map(|z| [1, 2].map(|load| BlockLoad::new([0, 0, z], load, false)));
        let partition = balanced::<3>(2, None, twice.collect());
        let owners: Vec<usize> = (0..7).map(|z| partition.owner([0, 0, z])).collect();
        assert!(owners.is_sorted() && owners[2] == 0 && owners[4] == 1, "{owners:?}");
    }

    /// A part that becomes a little longer along another axis is cut as before, and along that once it is much longer.
    #[test]
    fn axes_stay() {
        let blocks = |x: i32, y: i32| {
            (0..x).flat_map(move |x| (0..y).map(move |y| BlockLoad::new([x, y], 1, false))).collect()
        };
        let first = balanced::<2>(2, None, blocks(11, 10));
        assert_eq!(first.cuts[0].axis, 0);
        let next = |x, y| balanced::<2>(2, Some(&first), blocks(x, y)).cuts[0].axis;
        assert_eq!([next(10, 12), next(10, 13)], [0, 1]);
    }

    /// Two bodies that lie upon each other are not parted where they touch, though the sides of both together are as
    /// long; nor are they by ranks that have a part of the particles each.
    #[test]
    fn contact_is_not_cut() {
        let find = |ranks: Threads| {
            let mut census = Census::<2>::default();
            for body in 0..2 {
                for (x, y) in (0..4).flat_map(|x| (0..8).map(move |y| (x + 4 * body, y))) {
                    // Now this rank counts some of them, now the other.
                    if (x + y) as usize % 2 == ranks.rank() {
                        census.count(body as usize, [x, y]);
                    }
                }
            }
            let all = census.of_all(&ranks);
            let meets = |(block, counted): (&[i32; 2], &Counted)| {
                counted.count == 0 || counted.several == (block[0] == 4)
            };
            assert!(all.blocks.iter().all(meets), "{all:?}");
            all.partition(&ranks)
        };
        let partitions: Vec<Partition> = std::thread::scope(|scope| {
            let started: Vec<_> =
                Threads::start(2).into_iter().map(|ranks| scope.spawn(move || find(ranks))).collect();
            started.into_iter().map(|rank| rank.join().unwrap()).collect()
        });
        for partition in &partitions {
            assert!(
                *partition == partitions[0] && (0..8).all(|x| partition.owner([x, 3]) == 0),
                "{partition:?}"
            );
            assert!((0..8).all(|x| partition.owner([x, 4]) == 1), "{partition:?}");
        }
    }

    /// Bodies that have particles in the same blocks meet there and in those that both reach, whoever counts them, also
    /// beyond the face at which the grid repeats.
    #[test]
    fn bodies_meet_where_both_reach() {
        let mut census = Census::<2>::new(Periods([8, 0]));
        for (body, blocks) in [(0, [1, 2]), (1, [0, 1]), (2, [6, 7])] {
            blocks.into_iter().for_each(|x| census.count(body, [x, 0]));
        }
        let mut met: Vec<i32> = (census.blocks.iter().filter(|(_, counted)| counted.several))
            .map(|(block, _)| block[0])
            .collect();
        met.sort_unstable();
        assert_eq!(met, [0, 0, 1, 1, 2, 2], "each in its row, and in the one above");
    }

    /// Where there are fewer blocks than ranks, some have nothing; every block has an owner.
    #[test]
    fn more_ranks_than_blocks() {
        let ends = [0, 9].into_iter().map(|z| BlockLoad::new([0, 0, z], 1, false));
        let partition = balanced::<3>(5, None, ends.collect());
        assert!(partition.owner([0, 0, 0]) < partition.owner([0, 0, 9]));
        assert!(partition.owner([0, 0, 9]) < 5 && partition.owner([-9, 3, 7]) < 5);
        assert_eq!(balanced::<3>(1, None, Vec::new()).owner([4, 5, 6]), 0);
        assert!(balanced::<3>(4, None, Vec::new()).owner([4, 5, 6]) < 4);
    }
}
