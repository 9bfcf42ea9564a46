//! The blocks of one body: its particles by tile and cell, kept up to date as they move.

use super::{Blocks, Disjoint, MOST_NODES, SIDE, locate, node_at, nodes_per_block};
use crate::threads::{each, each_of};
use rayon::prelude::ParallelSliceMut;
use std::ops::{Index, IndexMut, Range};
use std::sync::LazyLock;

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

/// Blocks at a block + {0, 1}^D, a bit each.
pub(super) type CornerBlocks = u8;

/// The blocks that the particles of a cell reach.
fn corners_of<const D: usize>(cell: usize, reach: i32) -> CornerBlocks {
    let place: [i32; D] = node_at([0; D], cell);
    let reaches = |corner: usize| (0..D).all(|i| corner >> (D - 1 - i) & 1 == 0 || place[i] + reach >= SIDE);
    (0..1 << D).filter(|&corner| reaches(corner)).fold(0, |corners, corner| corners | 1 << corner)
}

/// The blocks at `home` + {0, 1}^D that are reached.
pub(super) fn reached_blocks<const D: usize>(
    home: [i32; D],
    reached: CornerBlocks,
) -> impl Iterator<Item = [i32; D]> {
    (0..1 << D)
        .filter(move |&corner| reached >> corner & 1 == 1)
        .map(move |corner| corner_block(home, corner))
}

/// The blocks of one body.
#[derive(Clone, Debug, Default)]
pub(super) struct CellList {
    /// Its tiles among those of all bodies, when they were counted last.
    pub tiles: Range<usize>,
    /// Its slots of the field likewise.
    pub slots: Range<usize>,
    /// Indices of the particles, by tile, then cell, then number.
    pub order: Vec<u32>,
    /// Place in `order` of each cell of each tile, and the end.
    pub cells: Vec<u32>,
    /// Home blocks with particles, sorted.
    pub homes: Vec<u64>,
    /// Of each tile, which blocks at `home` + {0, 1}^D its particles reach, a bit each.
    pub reached: Vec<CornerBlocks>,
    /// Blocks that the particles reach, sorted.
    pub blocks: Vec<u64>,
    /// Whether there are others among them, which particles of other ranks reach.
    pub has_foreign_blocks: bool,
    /// Whether it knows nothing of the particles that there are now.
    pub forgotten: bool,
    /// Whether it is begun anew, and not settled yet.
    pub begun: bool,
    /// Particles that belong to other ranks.
    pub guests: GuestList,
    /// Nodes that a particle reaches beyond its base node, along each axis.
    reach: i32,
    /// Particles on the move, by their new homes.
    movers: Vec<Mover>,
    /// The same as threads find them.
    leaving: Vec<Vec<Mover>>,
    /// How many have left each tile.
    gone: Vec<u32>,
    /// What the lists above become next.
    next: Next,
}

/// Particles of other ranks by tile and cell.
#[derive(Clone, Debug, Default)]
pub(super) struct GuestList {
    /// Indices of the particles, by tile, then cell, then number.
    pub order: Vec<u32>,
    /// Place in `order` of each cell of a tile, and its end, one tile after the other.
    pub cells: Vec<u32>,
    /// Home blocks with particles, sorted.
    pub homes: Vec<u64>,
}

#[derive(Clone, Debug, Default)]
struct Next {
    order: Vec<u32>,
    cells: Vec<u32>,
    homes: Vec<u64>,
    reached: Vec<CornerBlocks>,
    tiles: Vec<NextTile>,
}

/// What becomes a tile.
#[derive(Clone, Debug)]
struct NextTile {
    /// The tile with this home before, if there was one.
    old: Option<usize>,
    /// Those who come, in [`CellList::movers`].
    movers: Range<usize>,
    /// Its place in the order.
    start: usize,
}

/// Tiles that a thread takes at a time.
const TILES: usize = 32;

/// A particle and its new home, ordered by home and number.
#[derive(Clone, Copy, Debug)]
struct Mover {
    block: u64,
    cell: u32,
    particle: u32,
    /// Its number in its body, wherever it lies in memory.
    number: u32,
}

impl Mover {
    /// Their order as one number, which is compared without branches.
    fn rank(&self) -> u128 {
        u128::from(self.block) << 64 | u128::from(self.cell) << 32 | u128::from(self.number)
    }
}

/// Stands in the order for a particle that has left.
const GONE: u32 = u32::MAX;

/// The blocks of all bodies, by body. Those of a body that has nothing here take no memory.
#[derive(Clone, Debug, Default)]
pub(super) struct CellLists {
    lists: Vec<Option<Box<CellList>>>,
    /// See [`CellList`].
    reach: i32,
}

impl CellLists {
    /// Of so many bodies, none of which has anything here, and whose particles reach so many nodes beyond their base
    /// nodes.
    pub fn of_none(bodies: usize, reach: i32) -> Self {
        CellLists { lists: vec![None; bodies], reach }
    }

    /// How many bodies there are.
    pub fn len(&self) -> usize {
        self.lists.len()
    }

    /// Forgets what a body has here, and the room that it took.
    pub fn clear(&mut self, body: usize) {
        self.lists[body] = None;
    }

    /// Does something to the lists of some bodies, which ascend, so many at a time by a thread.
    pub fn each_of(&mut self, bodies: &[u32], size: usize, work: impl Fn(usize, &mut CellList) + Sync) {
        let reach = self.reach;
        each_of(&mut self.lists, bodies, size, |body, list| work(body, made(list, reach)));
    }
}

fn made(list: &mut Option<Box<CellList>>, reach: i32) -> &mut CellList {
    list.get_or_insert_with(|| Box::new(CellList::of_none(reach)))
}

impl Index<usize> for CellLists {
    type Output = CellList;

    fn index(&self, body: usize) -> &CellList {
        static NOTHING: LazyLock<CellList> = LazyLock::new(CellList::default);
        self.lists[body].as_deref().unwrap_or_else(|| &NOTHING)
    }
}

impl IndexMut<usize> for CellLists {
    fn index_mut(&mut self, body: usize) -> &mut CellList {
        made(&mut self.lists[body], self.reach)
    }
}

impl CellList {
    /// One of a body without particles, which reach so many nodes beyond their base nodes.
    fn of_none(reach: i32) -> Self {
        CellList { reach, ..CellList::default() }
    }

    /// Looks at all particles: their base nodes and numbers.
    pub fn start<const D: usize>(
        &mut self,
        (count, reach): (usize, i32),
        (base, number): (impl Fn(usize) -> [i32; D], impl Fn(usize) -> u32 + Sync),
    ) -> Blocks {
        self.find_all((count, reach), (base, &number));
        self.settle::<D>(&number);
        Blocks::New
    }

    /// Looks at all particles, which are all on the move.
    pub fn find_all<const D: usize>(
        &mut self,
        (count, reach): (usize, i32),
        (base, number): (impl Fn(usize) -> [i32; D], impl Fn(usize) -> u32),
    ) {
        let (tiles, slots) = (self.tiles.clone(), self.slots.clone());
        *self = CellList { tiles, slots, begun: true, ..Self::of_none(reach) };
        let movers = (0..count).map(|i| mover(base(i), (i as u32, number(i))));
        self.movers.extend(movers);
    }

    /// Looks at the particles in cells that particles have left.
    pub fn update<const D: usize>(
        &mut self,
        left: &[u64],
        (base, number): (impl Fn(usize) -> [i32; D] + Sync, impl Fn(usize) -> u32 + Sync),
    ) -> Blocks {
        self.find_movers(left, (base, &number), |_| false);
        if self.movers.is_empty() { Blocks::Same } else { self.settle::<D>(&number) }
    }

    /// Finds those on the move among the particles in cells that particles have left, and takes all for such whose home
    /// is `lost`.
    pub fn find_movers<const D: usize>(
        &mut self,
        left: &[u64],
        (base, number): (impl Fn(usize) -> [i32; D] + Sync, impl Fn(usize) -> u32 + Sync),
        lost: impl Fn([i32; D]) -> bool + Sync,
    ) {
        let n = nodes_per_block(D);
        self.gone.clear();
        self.gone.resize(left.len(), 0);
        let count = left.len().div_ceil(TILES);
        self.leaving.resize_with(count.max(self.leaving.len()), Vec::new);
        let (cells, homes, order) = (&self.cells, &self.homes, Disjoint::new(&mut self.order));
        let gone = Disjoint::new(&mut self.gone);
        each(&mut self.leaving[..count], 1, |part, leaving| {
            let left = &left[part * TILES..left.len().min((part + 1) * TILES)];
            leaving.clear();
            for (i, &left) in left.iter().enumerate() {
                let tile = part * TILES + i;
                let is_lost = lost(block_of(homes[tile]));
                let left = if is_lost { u64::MAX } else { left };
                if left == 0 {
                    continue;
                }
                for cell in (0..n).filter(|cell| left >> cell & 1 == 1) {
                    for place in cells[tile * n + cell]..cells[tile * n + cell + 1] {
                        // SAFETY: every place belongs to one tile, and every tile to one part.
                        let particle = unsafe { order.get(place as usize) };
                        let i = *particle as usize;
                        let new = mover(base(i), (*particle, number(i)));
                        if is_lost || (new.block, new.cell as usize) != (homes[tile], cell) {
                            leaving.push(new);
                            // SAFETY: as above.
                            unsafe { *gone.get(tile) += 1 };
                            *particle = GONE;
                        }
                    }
                }
            }
        });
        self.movers.clear();
        for leaving in &self.leaving[..count] {
            self.movers.extend_from_slice(leaving);
        }
    }

    /// Takes those on the move to other ranks out of the list, whose owners `abroad` tells: each with its new owner, by
    /// index.
    pub fn emigrants<const D: usize>(
        &mut self,
        abroad: impl Fn([i32; D]) -> Option<usize>,
    ) -> Vec<(u32, usize)> {
        let mut gone = Vec::new();
        self.movers.retain(|mover| {
            let owner = abroad(block_of(mover.block));
            gone.extend(owner.map(|owner| (mover.particle, owner)));
            owner.is_none()
        });
        gone.sort_unstable();
        gone
    }

    /// Takes note that particles lie elsewhere in memory, from where to where; `base` knows them where they are now.
    pub fn renumber<const D: usize>(&mut self, moves: &[[u32; 2]], base: impl Fn(usize) -> [i32; D]) {
        let n = nodes_per_block(D);
        let mut still: Vec<[u32; 2]> = moves.to_vec();
        still.sort_unstable();
        let place = |particle: u32| still.binary_search_by_key(&particle, |&[from, _]| from);
        let mut found = vec![false; still.len()];
        for mover in self.movers.iter_mut().filter(|_| !still.is_empty()) {
            if let Ok(at) = place(mover.particle) {
                (mover.particle, found[at]) = (still[at][1], true);
            }
        }
        for &[from, to] in still.iter().zip(&found).filter(|(_, found)| !**found).map(|(moved, _)| moved) {
            let (block, cell) = locate(base(to as usize));
            let tile = self.homes.binary_search(&key(block)).expect("who does not move has a home");
            let ends = &self.cells[tile * n + cell..][..2];
            let here = &mut self.order[ends[0] as usize..ends[1] as usize];
            *here.iter_mut().find(|particle| **particle == from).expect("it is in its cell") = to;
        }
    }

    /// Takes note of more particles, with these indices.
    pub fn arrive<const D: usize>(
        &mut self,
        particles: Range<usize>,
        (base, number): (impl Fn(usize) -> [i32; D], impl Fn(usize) -> u32),
    ) {
        self.movers.extend(particles.map(|i| mover(base(i), (i as u32, number(i)))));
    }

    /// Whether the body has no particles and no blocks here.
    pub fn is_empty(&self) -> bool {
        self.homes.is_empty() && self.blocks.is_empty()
    }

    /// Whether particles came, moved or left since the lists were made.
    pub fn is_stale(&self) -> bool {
        self.begun || !self.movers.is_empty() || self.gone.iter().any(|&gone| gone > 0)
    }

    /// The blocks at `home` + {0, 1}^D that the particles of a tile reach.
    pub fn reached_by<const D: usize>(&self, tile: usize) -> impl Iterator<Item = [i32; D]> {
        reached_blocks(block_of(self.homes[tile]), self.reached[tile])
    }

    /// Finds the blocks that the particles reach.
    pub fn find_blocks<const D: usize>(&mut self) {
        self.has_foreign_blocks = false;
        self.blocks.clear();
        for tile in 0..self.homes.len() {
            let reached = reached_blocks::<D>(block_of(self.homes[tile]), self.reached[tile]);
            self.blocks.extend(reached.map(key));
        }
        self.blocks.sort_unstable();
        self.blocks.dedup();
    }

    /// Gives the movers their places in the order.
    pub fn settle<const D: usize>(&mut self, number: &(impl Fn(usize) -> u32 + Sync)) -> Blocks {
        let n = nodes_per_block(D);
        // No two are equal, so their order does not depend on who sorts them.
        self.movers.par_sort_unstable_by_key(Mover::rank);
        self.plan(n);
        let mut corners = [0; MOST_NODES];
        for (cell, corners) in corners.iter_mut().enumerate().take(n) {
            *corners = corners_of::<D>(cell, self.reach);
        }
        let Next { order, cells, homes, reached, tiles } = &mut self.next;
        let (old_order, old_cells, movers, gone) = (&self.order, &self.cells, &self.movers, &self.gone);
        let old_reached = &self.reached;
        let places = Disjoint::new(order);
        let (tiles, places_of_cells) = (&*tiles, Disjoint::new(&mut cells[..]));
        each(&mut reached[..tiles.len()], TILES, |place_of_tile, reached| {
            let tile = &tiles[place_of_tile];
            // SAFETY: every tile has cells of its own.
            let cells = unsafe { places_of_cells.part(place_of_tile * n, n) };
            let mut place = tile.start;
            let mut put = |particle: u32| {
                // SAFETY: every place belongs to one tile.
                unsafe { *places.get(place) = particle };
                place += 1;
                place
            };
            let starts = tile.old.map_or(&[][..], |old| &old_cells[old * n..=(old + 1) * n]);
            if let Some(old) = tile.old.filter(|&old| tile.movers.is_empty() && gone[old] == 0) {
                *reached = old_reached[old];
                for (cell, &start) in cells.iter_mut().zip(starts) {
                    *cell = start - starts[0] + tile.start as u32;
                }
                old_order[starts[0] as usize..starts[n] as usize].iter().for_each(|&particle| {
                    put(particle);
                });
                return;
            }
            let mut arriving = &movers[tile.movers.clone()];
            let mut end = tile.start;
            *reached = 0;
            for (cell, start) in cells.iter_mut().enumerate() {
                let first = end;
                *start = end as u32;
                let here = arriving.iter().take_while(|mover| mover.cell as usize == cell).count();
                let (new, rest) = arriving.split_at(here);
                arriving = rest;
                let old = starts
                    .get(cell..cell + 2)
                    .map_or(&[][..], |ends| &old_order[ends[0] as usize..ends[1] as usize]);
                merge(old, new, (number, |particle| end = put(particle)));
                if end > first {
                    *reached |= corners[cell];
                }
            }
        });
        let same = !self.begun && *homes == self.homes && *reached == self.reached;
        self.begun = false;
        std::mem::swap(&mut self.order, order);
        std::mem::swap(&mut self.cells, cells);
        std::mem::swap(&mut self.homes, homes);
        std::mem::swap(&mut self.reached, reached);
        if same {
            return Blocks::Same;
        }
        self.find_blocks::<D>();
        Blocks::New
    }

    /// Lists the tiles that there will be, and makes room for them.
    fn plan(&mut self, n: usize) {
        let Next { order, cells, homes, reached, tiles } = &mut self.next;
        homes.clear();
        tiles.clear();
        let (mut tile, mut first, mut start) = (0, 0, 0);
        while tile < self.homes.len() || first < self.movers.len() {
            let old = self.homes.get(tile).copied().unwrap_or(u64::MAX);
            let block = self.movers.get(first).map_or(old, |mover| old.min(mover.block));
            let movers = first..first + self.movers[first..].partition_point(|mover| mover.block == block);
            let was = (old == block).then_some(tile);
            let stay = was.map_or(0, |tile| {
                (self.cells[(tile + 1) * n] - self.cells[tile * n] - self.gone[tile]) as usize
            });
            let count = stay + movers.len();
            first = movers.end;
            tile += usize::from(was.is_some());
            if count > 0 {
                homes.push(block);
                tiles.push(NextTile { old: was, movers, start });
                start += count;
            }
        }
        order.resize(start, 0);
        reached.resize(tiles.len(), 0);
        cells.resize(tiles.len() * n + 1, 0);
        cells[tiles.len() * n] = start as u32;
    }

    /// Takes note that the particles in memory are in their order.
    pub fn tidied(&mut self) {
        for (place, particle) in self.order.iter_mut().enumerate() {
            *particle = place as u32;
        }
    }
}

fn mover<const D: usize>(base: [i32; D], (particle, number): (u32, u32)) -> Mover {
    let (block, cell) = locate(base);
    Mover { block: key(block), cell: cell as u32, particle, number }
}

/// Hands out those who stayed and those who came, in the order of their numbers.
fn merge(old: &[u32], mut new: &[Mover], (number, mut put): (&impl Fn(usize) -> u32, impl FnMut(u32))) {
    for &particle in old.iter().filter(|&&particle| particle != GONE) {
        while let Some((first, rest)) = new.split_first()
            && first.number < number(particle as usize)
        {
            put(first.particle);
            new = rest;
        }
        put(particle);
    }
    new.iter().for_each(|mover| put(mover.particle));
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Of a particle at a place in memory.
    fn number(i: usize) -> u32 {
        (i as u32 * 37) % 61
    }

    /// What the lists say, found by sorting all particles.
    fn sorted(bases: &[[i32; 2]]) -> (Vec<u32>, Vec<u64>, Vec<u32>) {
        let seen = |(i, &base): (usize, &[i32; 2])| mover(base, (i as u32, number(i)));
        let mut all: Vec<Mover> = bases.iter().enumerate().map(seen).collect();
        all.sort_unstable_by_key(Mover::rank);
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
            let mut cell_list = CellList::default();
            cell_list.start((bases.len(), 1), (|i: usize| bases[i], number));
            for jumps in jumps {
                let mut left = vec![0; cell_list.homes.len()];
                for (i, to) in jumps {
                    let i = i % bases.len();
                    let home = mover(bases[i], (0, 0));
                    // Only cells known before the step are marked, as the engine does.
                    if let Ok(tile) = cell_list.homes.binary_search(&home.block) {
                        left[tile] |= 1 << home.cell;
                        bases[i] = to;
                    }
                }
                let (homes, blocks_before) = (cell_list.homes.clone(), cell_list.blocks.clone());
                let blocks = cell_list.update(&left, (|i: usize| bases[i], number));
                let (order, expected, cells) = sorted(&bases);
                prop_assert_eq!(&cell_list.order, &order);
                prop_assert_eq!(&cell_list.cells, &cells);
                prop_assert_eq!(&cell_list.homes, &expected);
                // Every block that a particle reaches, and no other.
                let mut reached: Vec<u64> = (bases.iter())
                    .flat_map(|&[x, y]| [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]].map(|node| key(locate(node).0)))
                    .collect();
                reached.sort_unstable();
                reached.dedup();
                prop_assert_eq!(&cell_list.blocks, &reached);
                prop_assert!(blocks == Blocks::New || homes == cell_list.homes && blocks_before == cell_list.blocks);
            }
        }
    }
}
