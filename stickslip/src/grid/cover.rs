//! Which blocks a body's particles reach, and where bodies meet.
//!
//! A particle's *home* is the cell of its base node. Particles that share a home block form a tile; a tile writes to its own
//! block and to the next one along each axis, since no basis reaches more than three nodes.

use super::{SIDE, locate, nodes_per_block};
use rayon::prelude::*;

/// Particles of one body that share a home block.
#[derive(Clone, Copy, Debug)]
pub struct Tile<const D: usize> {
    /// Index of the body.
    pub body: usize,
    /// Home block.
    pub block: [i32; D],
    /// Its number among the body's tiles.
    pub number: usize,
    /// Field slots of the blocks at `block` + {0, 1}^D, the last axis fastest.
    pub slots: [u32; 8],
}

/// The blocks of one body.
#[derive(Clone, Debug, Default)]
struct Holding {
    /// Indices of the particles, by tile, then cell, then index.
    order: Vec<u32>,
    /// Place in `order` of each cell of each tile, and the end.
    cells: Vec<u32>,
    /// Home blocks with particles, sorted.
    homes: Vec<u64>,
    /// Blocks that the particles reach, sorted.
    blocks: Vec<u64>,
    /// Home (tile and cell) of each particle.
    home: Vec<u32>,
}

/// Bodies that hold the same block: `slots[start..end]` of [`Cover::shared_slots`].
#[derive(Clone, Copy, Debug)]
pub struct Meeting<const D: usize> {
    /// The block.
    pub block: [i32; D],
    start: usize,
    end: usize,
}

/// The blocks under all bodies.
#[derive(Clone, Debug, Default)]
pub struct Cover<const D: usize> {
    holdings: Vec<Holding>,
    /// Tiles of all bodies, by body and block.
    pub tiles: Vec<Tile<D>>,
    /// Indices of the tiles by colour: tiles of one colour never write to the same slot.
    pub colors: Vec<Vec<u32>>,
    /// Body and block of each field slot.
    pub slots: Vec<(u32, [i32; D])>,
    /// First slot of each body, and the number of slots.
    first_slot: Vec<usize>,
    /// Blocks that two or more bodies hold.
    pub meetings: Vec<Meeting<D>>,
    shared: Vec<u32>,
}

/// Whether the blocks under the particles, and with them the field's slots, are others than before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Blocks {
    /// The same.
    Same,
    /// Others.
    New,
}

/// Blocks further than this from the origin have no key.
const REACH: i32 = 1 << 20;

/// Cells from the origin of the grid, along an axis, within which blocks have keys.
pub const MOST_CELLS: i32 = (REACH - 2) * SIDE;

/// Whether a base node lies where blocks have keys.
pub fn addressable<const D: usize>(base: [i32; D]) -> bool {
    base.iter().all(|n| n.unsigned_abs() < MOST_CELLS as u32)
}

fn key<const D: usize>(block: [i32; D]) -> u64 {
    block.iter().fold(0, |key, &b| (key << 21) | (b + REACH) as u64)
}

fn block_of<const D: usize>(mut key: u64) -> [i32; D] {
    let mut block = [0; D];
    for b in block.iter_mut().rev() {
        *b = (key & ((1 << 21) - 1)) as i32 - REACH;
        key >>= 21;
    }
    block
}

/// The block at `block` + the bits of `corner`, the last axis in the lowest bit.
fn corner_block<const D: usize>(block: [i32; D], corner: usize) -> [i32; D] {
    std::array::from_fn(|i| block[i] + (corner >> (D - 1 - i) & 1) as i32)
}

impl<const D: usize> Cover<D> {
    /// Covers bodies of `counts` particles and says whether their blocks are others than before; `base(body, particle)` is a particle's base node, which must be [`addressable`].
    pub fn update(&mut self, counts: &[usize], base: impl Fn(usize, usize) -> [i32; D] + Sync) -> Blocks {
        self.holdings.resize_with(counts.len(), Holding::default);
        let changed = self
            .holdings
            .par_iter_mut()
            .zip(counts)
            .enumerate()
            .map(|(body, (holding, &count))| holding.update(count, |particle| base(body, particle)))
            .reduce(|| Change::None, Change::max);
        match changed {
            Change::None | Change::Cells => {}
            Change::Blocks => self.rebuild(),
        }
        if changed == Change::Blocks { Blocks::New } else { Blocks::Same }
    }

    fn rebuild(&mut self) {
        self.slots.clear();
        self.tiles.clear();
        self.first_slot.clear();
        let mut keys = Vec::new();
        for (body, holding) in self.holdings.iter().enumerate() {
            let first = self.slots.len();
            self.first_slot.push(first);
            for (i, &key) in holding.blocks.iter().enumerate() {
                self.slots.push((body as u32, block_of(key)));
                keys.push((key, (first + i) as u32));
            }
            for (number, &home) in holding.homes.iter().enumerate() {
                let block = block_of(home);
                let mut slots = [0; 8];
                for (corner, slot) in slots.iter_mut().enumerate().take(1 << D) {
                    let key = key(corner_block(block, corner));
                    let place =
                        holding.blocks.binary_search(&key).expect("a body holds every block its tiles reach");
                    *slot = (first + place) as u32;
                }
                self.tiles.push(Tile { body, block, number, slots });
            }
        }
        self.first_slot.push(self.slots.len());
        self.color();
        self.meet(keys);
    }

    fn color(&mut self) {
        self.colors.clear();
        self.colors.resize_with(1 << D, Vec::new);
        for (i, tile) in self.tiles.iter().enumerate() {
            let color = tile.block.iter().fold(0, |color, b| color << 1 | (b & 1) as usize);
            self.colors[color].push(i as u32);
        }
    }

    fn meet(&mut self, mut keys: Vec<(u64, u32)>) {
        self.meetings.clear();
        self.shared.clear();
        if self.holdings.len() < 2 {
            return;
        }
        keys.sort_unstable();
        for group in keys.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() > 1) {
            let start = self.shared.len();
            self.shared.extend(group.iter().map(|(_, slot)| slot));
            self.meetings.push(Meeting { block: block_of(group[0].0), start, end: self.shared.len() });
        }
    }

    /// Places in the body's order where the particles of each cell of a tile begin, and where the last ends.
    pub fn cells_of(&self, tile: &Tile<D>) -> &[u32] {
        let n = nodes_per_block(D);
        &self.holdings[tile.body].cells[tile.number * n..=(tile.number + 1) * n]
    }

    /// Indices of a body's particles by tile, cell and index.
    pub fn order_of(&self, body: usize) -> &[u32] {
        &self.holdings[body].order
    }

    /// Slots of the bodies that hold a shared block, ordered by body.
    pub fn slots_of(&self, meeting: &Meeting<D>) -> &[u32] {
        &self.shared[meeting.start..meeting.end]
    }

    /// The field index of a body's node, if the body holds its block.
    pub fn node_index(&self, body: usize, node: [i32; D]) -> Option<usize> {
        let (block, local) = locate(node);
        let place = self.holdings[body].blocks.binary_search(&key(block)).ok()?;
        Some((self.first_slot[body] + place) * nodes_per_block(D) + local)
    }

    /// Indices of a body's particles whose home is a cell.
    pub fn particles_in(&self, body: usize, cell: [i32; D]) -> &[u32] {
        let (block, local) = locate(cell);
        let holding = &self.holdings[body];
        match holding.homes.binary_search(&key(block)) {
            Ok(tile) => {
                let place = tile * nodes_per_block(D) + local;
                &holding.order[holding.cells[place] as usize..holding.cells[place + 1] as usize]
            }
            Err(_) => &[],
        }
    }
}

/// What a new look at the particles changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Change {
    None,
    Cells,
    Blocks,
}

impl Holding {
    fn update<const D: usize>(&mut self, count: usize, base: impl Fn(usize) -> [i32; D]) -> Change {
        let n = nodes_per_block(D);
        let mut homes = Vec::new();
        for particle in 0..count {
            let (block, _) = locate(base(particle));
            let key = key(block);
            if homes.last() != Some(&key) {
                homes.push(key);
            }
        }
        homes.sort_unstable();
        homes.dedup();

        let mut home = Vec::with_capacity(count);
        let (mut last_key, mut last_tile) = (u64::MAX, 0);
        for particle in 0..count {
            let (block, cell) = locate(base(particle));
            let key = key(block);
            if key != last_key {
                last_tile = homes.binary_search(&key).expect("every home was collected above");
                last_key = key;
            }
            home.push((last_tile * n + cell) as u32);
        }
        let same_homes = homes == self.homes;
        if same_homes && home == self.home {
            return Change::None;
        }
        self.home = home;
        self.sort(homes.len() * n);
        if same_homes {
            return Change::Cells;
        }
        self.blocks.clear();
        for &home in &homes {
            self.blocks.extend((0..1 << D).map(|corner| key(corner_block::<D>(block_of(home), corner))));
        }
        self.blocks.sort_unstable();
        self.blocks.dedup();
        self.homes = homes;
        Change::Blocks
    }

    /// Counting sort of the particles by home.
    fn sort(&mut self, cells: usize) {
        self.cells.clear();
        self.cells.resize(cells + 1, 0);
        for &home in &self.home {
            self.cells[home as usize + 1] += 1;
        }
        for i in 0..cells {
            self.cells[i + 1] += self.cells[i];
        }
        let mut next = self.cells.clone();
        self.order.resize(self.home.len(), 0);
        for (particle, &home) in self.home.iter().enumerate() {
            let place = &mut next[home as usize];
            self.order[*place as usize] = particle as u32;
            *place += 1;
        }
    }
}
