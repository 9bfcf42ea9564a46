//! Which blocks a body's particles reach, and where bodies meet.
//!
//! A particle's *home* is the cell of its base node. Particles that share a home block form a tile; a tile writes to
//! its own block and to the next one along each axis, as far as its particles reach,
//! since no basis reaches more than four nodes.

use super::cell_list::{CellList, block_of, corner_block, key};
use super::{Periods, locate, nodes_per_block};
use crate::threads::each;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// Particles of one body that share a home block.
#[derive(Clone, Copy, Debug)]
pub struct Tile<const D: usize> {
    /// Index of the body.
    pub body: usize,
    /// Home block, where its particles are: in a periodic domain it may lie periods away.
    pub block: [i32; D],
    /// Its number among the body's tiles.
    pub number: usize,
    /// Field slots of the blocks at `block` + {0, 1}^D, the last axis fastest;
    /// that of the home where particles do not reach so far.
    pub slots: [u32; 8],
}

/// Bodies that hold the same block: `slots[start..end]` of [`ActiveBlocks::shared_slots`].
#[derive(Clone, Copy, Debug)]
pub struct SharedBlock<const D: usize> {
    /// The block.
    pub block: [i32; D],
    start: usize,
    end: usize,
}

/// The blocks under all bodies.
#[derive(Clone, Debug, Default)]
pub struct ActiveBlocks<const D: usize> {
    cell_lists: Vec<CellList>,
    /// Tiles of all bodies, by body and block.
    pub tiles: Vec<Tile<D>>,
    /// Indices of the tiles of small bodies, by body and colour.
    pub small: Vec<u32>,
    /// All tiles of several small bodies in each range of these: ranges never write to the same slot.
    pub portions: Vec<Range<usize>>,
    /// Indices of the other tiles by colour: tiles of one colour never write to the same slot.
    pub colors: Vec<Vec<u32>>,
    /// Room for the tiles of a body with their colours.
    colored: Vec<(usize, u32)>,
    /// Body and block of each field slot.
    pub slots: Vec<(u32, [i32; D])>,
    /// First slot of each body, and the number of slots.
    first_slot: Vec<usize>,
    /// First tile of each body, and the number of tiles.
    first_tile: Vec<usize>,
    /// Blocks that two or more bodies hold.
    pub shared_blocks: Vec<SharedBlock<D>>,
    shared: Vec<u32>,
    /// Key and slot of every block, sorted.
    keys: Vec<(u64, u32)>,
    periods: Periods<D>,
    /// Where the grid repeats, for each body how far away from the first period blocks are that its particles reach, in
    /// blocks, sorted.
    images: Vec<Vec<[i32; D]>>,
}

/// Most tiles of a small body.
const MOST_SMALL: usize = 64;

/// A small body has at most this part of all tiles: so there are enough of them to share out.
const LEAST_SMALL: usize = 64;

/// Tiles of a portion, or a few more.
const PORTION: usize = 32;

/// Whether the blocks under the particles, and with them the field's slots, are others than before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Blocks {
    /// The same.
    Same,
    /// Others.
    New,
}

impl<const D: usize> ActiveBlocks<D> {
    /// No blocks, on a grid that repeats.
    pub fn new(periods: Periods<D>) -> Self {
        ActiveBlocks { periods, ..ActiveBlocks::default() }
    }

    /// Covers so many bodies of so many particles each, which reach so many nodes beyond their base nodes, and says
    /// whether their blocks are others than before; `base(body, particle)` is a particle's base node,
    /// which must be [`addressable`], `number(body, particle)` its number in the body.
    ///
    /// `left` says which cells of each tile particles have left since the last time, from the lowest bit on; without it
    /// all particles are looked at, as always of bodies that were [forgotten](ActiveBlocks::forget).
    pub fn update(
        &mut self,
        (bodies, count, reach): (usize, impl Fn(usize) -> usize + Sync, i32),
        left: Option<&[u64]>,
        (base, number): (impl Fn(usize, usize) -> [i32; D] + Sync, impl Fn(usize, usize) -> u32 + Sync),
    ) -> Blocks {
        self.cell_lists.resize_with(bodies, CellList::default);
        let first_tile = &self.first_tile;
        let changed = AtomicBool::new(false);
        each(&mut self.cell_lists, 16, |body, cell_list| {
            let looks = (|particle| base(body, particle), |particle| number(body, particle));
            let blocks = match left {
                Some(left) if !cell_list.forgotten => {
                    let left = &left[first_tile[body]..first_tile[body + 1]];
                    cell_list.update(left, looks)
                }
                _ => cell_list.start((count(body), reach), looks),
            };
            if blocks == Blocks::New {
                changed.store(true, Ordering::Relaxed);
            }
        });
        if changed.into_inner() {
            self.rebuild();
            return Blocks::New;
        }
        Blocks::Same
    }

    /// Takes note that a body has other particles: the next update looks at all of them.
    pub fn forget(&mut self, body: usize) {
        self.cell_lists[body].forgotten = true;
    }

    /// Covers a body anew: all its particles are others than before. Counts as [`ActiveBlocks::update`] does.
    pub fn replace(
        &mut self,
        (body, count, reach): (usize, usize, i32),
        looks: (impl Fn(usize) -> [i32; D], impl Fn(usize) -> u32 + Sync),
    ) {
        self.cell_lists[body].start((count, reach), looks);
        self.rebuild();
    }

    fn rebuild(&mut self) {
        if self.periods.any() {
            self.find_images();
        }
        let periods = self.periods;
        self.slots.clear();
        self.tiles.clear();
        self.first_slot.clear();
        self.first_tile.clear();
        self.keys.clear();
        for (body, cell_list) in self.cell_lists.iter().enumerate() {
            let first = self.slots.len();
            self.first_slot.push(first);
            self.first_tile.push(self.tiles.len());
            for (i, &key) in cell_list.blocks.iter().enumerate() {
                self.slots.push((body as u32, block_of(key)));
                self.keys.push((key, (first + i) as u32));
            }
            for (number, &home) in cell_list.homes.iter().enumerate() {
                let block = block_of(home);
                let mut slots = [0; 8];
                for (corner, slot) in slots.iter_mut().enumerate().take(1 << D) {
                    // What is not reached is given nothing: the home block may stand for it.
                    let reached = cell_list.reached[number] >> corner & 1 == 1;
                    let key = key(periods.wrapped(if reached { corner_block(block, corner) } else { block }));
                    let place = cell_list
                        .blocks
                        .binary_search(&key)
                        .expect("a body holds every block its tiles reach");
                    *slot = (first + place) as u32;
                }
                self.tiles.push(Tile { body, block, number, slots });
            }
        }
        self.first_slot.push(self.slots.len());
        self.first_tile.push(self.tiles.len());
        self.share_out();
        self.meet();
    }

    /// Finds the images of blocks that bodies reach, and gives these blocks the nodes of those in the first period.
    fn find_images(&mut self) {
        let periods = self.periods;
        self.images.resize_with(self.cell_lists.len(), Vec::new);
        for (cell_list, images) in self.cell_lists.iter_mut().zip(&mut self.images) {
            images.clear();
            for (&home, &reached) in cell_list.homes.iter().zip(&cell_list.reached) {
                let corners = (0..1 << D).filter(|&corner| reached >> corner & 1 == 1);
                images.extend(corners.map(|corner| {
                    let block = corner_block::<D>(block_of(home), corner);
                    let first = periods.wrapped(block);
                    std::array::from_fn(|i| block[i] - first[i])
                }));
            }
            images.sort_unstable();
            images.dedup();
            cell_list
                .blocks
                .iter_mut()
                .for_each(|block| *block = key(periods.wrapped(block_of::<D>(*block))));
            cell_list.blocks.sort_unstable();
            cell_list.blocks.dedup();
        }
    }

    /// Small bodies together make portions, each for one thread; the tiles of large ones get colours. In both, a slot is
    /// given what its tiles have in the order of their colours: whether a body is small changes no bit.
    fn share_out(&mut self) {
        self.small.clear();
        self.portions.clear();
        self.colors.resize_with(1 << D, Vec::new);
        self.colors.iter_mut().for_each(Vec::clear);
        for body in 0..self.cell_lists.len() {
            let tiles = self.tiles_of_body(body);
            let small = tiles.len() <= MOST_SMALL && tiles.len() * LEAST_SMALL <= self.tiles.len();
            self.color(tiles);
            if !small {
                for &(color, tile) in &self.colored {
                    self.colors.resize_with(self.colors.len().max(color + 1), Vec::new);
                    self.colors[color].push(tile);
                }
            } else {
                self.colored.sort_unstable();
                let first = self.small.len();
                self.small.extend(self.colored.iter().map(|&(_, tile)| tile));
                match self.portions.last_mut() {
                    Some(portion) if portion.len() < PORTION => portion.end = self.small.len(),
                    _ => self.portions.push(first..self.small.len()),
                }
            }
        }
    }

    /// Finds the colours of a body's tiles: those of one colour have no slot in common. Where the grid repeats, several
    /// tiles may have the same nodes: each of them gets other colours.
    fn color(&mut self, tiles: Range<usize>) {
        let ActiveBlocks { colored, tiles: all, periods, .. } = self;
        colored.clear();
        if !periods.any() {
            let color = |i: usize| all[i].block.iter().fold(0, |color, b| color << 1 | (b & 1) as usize);
            colored.extend(tiles.map(|i| (color(i), i as u32)));
            return;
        }
        let first = |i: usize| key(periods.wrapped(all[i].block));
        let mut places: Vec<(u64, u32)> = tiles.map(|i| (first(i), i as u32)).collect();
        places.sort_unstable();
        for images in places.chunk_by(|a, b| a.0 == b.0) {
            for (number, &(block, tile)) in images.iter().enumerate() {
                colored.push((number * 3_usize.pow(D as u32) + periods.color(block_of(block)), tile));
            }
        }
    }

    fn meet(&mut self) {
        self.shared_blocks.clear();
        self.shared.clear();
        if self.cell_lists.len() < 2 {
            return;
        }
        self.keys.sort_unstable();
        for group in self.keys.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() > 1) {
            let start = self.shared.len();
            self.shared.extend(group.iter().map(|(_, slot)| slot));
            self.shared_blocks.push(SharedBlock {
                block: block_of(group[0].0),
                start,
                end: self.shared.len(),
            });
        }
        // By first body: its particles stay in the cache from block to block.
        self.shared_blocks.sort_unstable_by_key(|meeting| self.shared[meeting.start]);
    }

    /// Places in the body's order where the particles of each cell of a tile begin, and where the last ends.
    pub fn cells_of(&self, tile: &Tile<D>) -> &[u32] {
        let n = nodes_per_block(D);
        &self.cell_lists[tile.body].cells[tile.number * n..=(tile.number + 1) * n]
    }

    /// Indices of a body's particles by tile, cell and number.
    pub fn order_of(&self, body: usize) -> &[u32] {
        &self.cell_lists[body].order
    }

    /// The slots of a body.
    pub fn slots_of_body(&self, body: usize) -> Range<usize> {
        self.first_slot[body]..self.first_slot[body + 1]
    }

    /// The tiles of a body.
    pub fn tiles_of_body(&self, body: usize) -> Range<usize> {
        self.first_tile[body]..self.first_tile[body + 1]
    }

    /// Takes note that a body's particles have been brought into their order in memory.
    pub fn tidied(&mut self, body: usize) {
        self.cell_lists[body].tidied();
    }

    /// Slots of the bodies that hold a shared block, ordered by body.
    pub fn slots_of(&self, meeting: &SharedBlock<D>) -> &[u32] {
        &self.shared[meeting.start..meeting.end]
    }

    /// The field index of a body's node, if the body holds its block.
    pub fn node_index(&self, body: usize, node: [i32; D]) -> Option<usize> {
        let (block, local) = locate(node);
        let block = self.periods.wrapped(block);
        let place = self.cell_lists[body].blocks.binary_search(&key(block)).ok()?;
        Some((self.first_slot[body] + place) * nodes_per_block(D) + local)
    }

    /// How far away blocks are whose nodes are those of the first period and which a body's particles reach, in blocks.
    #[inline]
    pub fn images_of(&self, body: usize) -> &[[i32; D]] {
        if self.periods.any() { &self.images[body] } else { &[[0; D]] }
    }

    /// A body's particles whose home is a block: indices of all its particles, and places there where those of each
    /// cell begin, and where the last ends.
    #[inline]
    pub fn tile_at(&self, body: usize, block: [i32; D]) -> Option<(&[u32], &[u32])> {
        let cell_list = &self.cell_lists[body];
        let tile = cell_list.homes.binary_search(&key(block)).ok()?;
        let n = nodes_per_block(D);
        Some((&cell_list.order, &cell_list.cells[tile * n..=(tile + 1) * n]))
    }

    /// Indices of a body's particles whose home is a cell.
    pub fn particles_in(&self, body: usize, cell: [i32; D]) -> &[u32] {
        let (block, local) = locate(cell);
        let Some((order, cells)) = self.tile_at(body, block) else { return &[] };
        &order[cells[local] as usize..cells[local + 1] as usize]
    }
}
