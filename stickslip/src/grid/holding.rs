//! The blocks of one body: its particles by tile and cell, kept up to date as they move.

use super::{Blocks, SIDE, locate, nodes_per_block};

/// Blocks further than this from the origin have no key.
const REACH: i32 = 1 << 20;

/// Cells from the origin of the grid, along an axis, within which blocks have keys.
pub const MOST_CELLS: i32 = (REACH - 2) * SIDE;

/// Whether a base node lies where blocks have keys.
pub fn addressable<const D: usize>(base: [i32; D]) -> bool {
    base.iter().all(|n| n.unsigned_abs() < MOST_CELLS as u32)
}

pub(super) fn key<const D: usize>(block: [i32; D]) -> u64 {
    block.iter().fold(0, |key, &b| (key << 21) | (b + REACH) as u64)
}

pub(super) fn block_of<const D: usize>(mut key: u64) -> [i32; D] {
    let mut block = [0; D];
    for b in block.iter_mut().rev() {
        *b = (key & ((1 << 21) - 1)) as i32 - REACH;
        key >>= 21;
    }
    block
}

/// The block at `block` + the bits of `corner`, the last axis in the lowest bit.
pub(super) fn corner_block<const D: usize>(block: [i32; D], corner: usize) -> [i32; D] {
    std::array::from_fn(|i| block[i] + (corner >> (D - 1 - i) & 1) as i32)
}

/// The blocks of one body.
#[derive(Clone, Debug, Default)]
pub(super) struct Holding {
    /// Indices of the particles, by tile, then cell, then index.
    pub order: Vec<u32>,
    /// Place in `order` of each cell of each tile, and the end.
    pub cells: Vec<u32>,
    /// Home blocks with particles, sorted.
    pub homes: Vec<u64>,
    /// Blocks that the particles reach, sorted.
    pub blocks: Vec<u64>,
    /// Particles that changed their cell since they were last sorted in memory.
    moved: usize,
    /// That number summed over steps: what disorder in memory has cost.
    disorder: usize,
    /// Particles on the move.
    movers: Vec<Mover>,
    /// What the lists above become next.
    next: Next,
}

#[derive(Clone, Debug, Default)]
struct Next {
    order: Vec<u32>,
    cells: Vec<u32>,
    homes: Vec<u64>,
}

/// A particle and its new home, ordered by home.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Mover {
    block: u64,
    cell: u32,
    particle: u32,
}

/// Stands in the order for a particle that has left.
const GONE: u32 = u32::MAX;

impl Holding {
    /// Looks at all particles.
    pub fn start<const D: usize>(&mut self, count: usize, base: impl Fn(usize) -> [i32; D]) -> Blocks {
        *self = Holding::default();
        self.movers.extend((0..count).map(|particle| mover(base(particle), particle as u32)));
        self.settle::<D>(&[]);
        self.moved = count;
        self.disorder = count;
        Blocks::New
    }

    /// Looks at the particles in cells that particles have left.
    pub fn update<const D: usize>(&mut self, left: &[u64], base: impl Fn(usize) -> [i32; D]) -> Blocks {
        let n = nodes_per_block(D);
        self.movers.clear();
        for (tile, &left) in left.iter().enumerate().filter(|(_, left)| **left != 0) {
            for cell in (0..n).filter(|cell| left >> cell & 1 == 1) {
                let ends = [0, 1].map(|end| self.cells[tile * n + cell + end] as usize);
                for place in &mut self.order[ends[0]..ends[1]] {
                    let new = mover(base(*place as usize), *place);
                    if (new.block, new.cell as usize) != (self.homes[tile], cell) {
                        self.movers.push(new);
                        *place = GONE;
                    }
                }
            }
        }
        self.moved += self.movers.len();
        self.disorder += self.moved;
        if self.movers.is_empty() { Blocks::Same } else { self.settle::<D>(left) }
    }

    /// Gives the movers their places in the order.
    fn settle<const D: usize>(&mut self, left: &[u64]) -> Blocks {
        let n = nodes_per_block(D);
        self.movers.sort_unstable();
        let Next { order, cells, homes } = &mut self.next;
        order.clear();
        cells.clear();
        homes.clear();
        let (mut tile, mut movers) = (0, &self.movers[..]);
        while tile < self.homes.len() || !movers.is_empty() {
            let old = self.homes.get(tile).copied().unwrap_or(u64::MAX);
            let block = movers.first().map_or(old, |mover| old.min(mover.block));
            let (mut arriving, later) = movers.split_at(movers.partition_point(|mover| mover.block == block));
            movers = later;
            let start = order.len();
            let starts: &[u32] = if old == block { &self.cells[tile * n..=(tile + 1) * n] } else { &[] };
            if arriving.is_empty() && left[tile] == 0 {
                order.extend_from_slice(&self.order[starts[0] as usize..starts[n] as usize]);
                cells.extend(starts[..n].iter().map(|&place| place - starts[0] + start as u32));
            } else {
                for cell in 0..n {
                    cells.push(order.len() as u32);
                    let here = arriving.partition_point(|mover| mover.cell as usize == cell);
                    let (new, rest) = arriving.split_at(here);
                    arriving = rest;
                    let old = starts
                        .get(cell..cell + 2)
                        .map_or(&[][..], |ends| &self.order[ends[0] as usize..ends[1] as usize]);
                    merge(order, old, new);
                }
            }
            if order.len() > start {
                homes.push(block);
            } else {
                cells.truncate(cells.len() - n);
            }
            tile += usize::from(old == block);
        }
        cells.push(order.len() as u32);
        let same = *homes == self.homes;
        std::mem::swap(&mut self.order, order);
        std::mem::swap(&mut self.cells, cells);
        std::mem::swap(&mut self.homes, homes);
        if same {
            return Blocks::Same;
        }
        self.blocks.clear();
        for &home in &self.homes {
            self.blocks.extend((0..1 << D).map(|corner| key(corner_block::<D>(block_of(home), corner))));
        }
        self.blocks.sort_unstable();
        self.blocks.dedup();
        Blocks::New
    }

    /// Whether disorder in memory has cost about as much as sorting does.
    pub fn untidy(&self) -> bool {
        self.disorder > self.order.len() / 2
    }

    /// Takes note that the particles in memory are in their order.
    pub fn tidied(&mut self) {
        (self.moved, self.disorder) = (0, 0);
        for (place, particle) in self.order.iter_mut().enumerate() {
            *particle = place as u32;
        }
    }
}

fn mover<const D: usize>(base: [i32; D], particle: u32) -> Mover {
    let (block, cell) = locate(base);
    Mover { block: key(block), cell: cell as u32, particle }
}

/// Appends those who stayed and those who came, in the order of their indices.
fn merge(order: &mut Vec<u32>, old: &[u32], mut new: &[Mover]) {
    for &particle in old.iter().filter(|&&particle| particle != GONE) {
        while let Some((first, rest)) = new.split_first()
            && first.particle < particle
        {
            order.push(first.particle);
            new = rest;
        }
        order.push(particle);
    }
    order.extend(new.iter().map(|mover| mover.particle));
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// What the lists say, found by sorting all particles.
    fn sorted(bases: &[[i32; 2]]) -> (Vec<u32>, Vec<u64>, Vec<u32>) {
        let mut all: Vec<Mover> = bases.iter().enumerate().map(|(i, &base)| mover(base, i as u32)).collect();
        all.sort_unstable();
        let mut homes: Vec<u64> = all.iter().map(|mover| mover.block).collect();
        homes.dedup();
        let cell = |home: u64, cell: usize| {
            all.partition_point(|mover| (mover.block, mover.cell as usize) < (home, cell)) as u32
        };
        let mut cells: Vec<u32> =
            homes.iter().flat_map(|&home| (0..16).map(move |c| cell(home, c))).collect();
        cells.push(all.len() as u32);
        (all.iter().map(|mover| mover.particle).collect(), homes, cells)
    }

    proptest! {
        /// Particles that jump about, some of them each time, are where sorting all of them would put them.
        #[test]
        fn movers_find_their_places(
            start in prop::collection::vec(prop::array::uniform2(-9..9_i32), 1..60),
            jumps in prop::collection::vec(prop::collection::vec((0..60_usize, prop::array::uniform2(-9..9_i32)), 0..9), 1..6),
        ) {
            let mut bases = start;
            let mut holding = Holding::default();
            holding.start(bases.len(), |i| bases[i]);
            for jumps in jumps {
                let mut left = vec![0; holding.homes.len()];
                for (i, to) in jumps {
                    let i = i % bases.len();
                    let home = mover(bases[i], 0);
                    // Only cells known before the step are marked, as the engine does.
                    if let Ok(tile) = holding.homes.binary_search(&home.block) {
                        left[tile] |= 1 << home.cell;
                        bases[i] = to;
                    }
                }
                let homes = holding.homes.clone();
                let blocks = holding.update(&left, |i| bases[i]);
                let (order, expected, cells) = sorted(&bases);
                prop_assert_eq!(&holding.order, &order);
                prop_assert_eq!(&holding.cells, &cells);
                prop_assert_eq!(&holding.homes, &expected);
                prop_assert_eq!(blocks == Blocks::Same, homes == holding.homes);
            }
        }
    }
}
