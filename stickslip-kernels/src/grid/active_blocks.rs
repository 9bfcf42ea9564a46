//! Which blocks a body's particles reach, and where bodies meet.
//!
//! A particle's *home* is the cell of its base node. Particles that share a home block form a tile; a tile writes to
//! its own block and to the next one along each axis, as far as its particles reach,
//! since no basis reaches more than four nodes.

use super::border::{Border, Cut, ForeignTile, Mirrors, Traffic};
use super::cell_list::{CellList, CellLists, GuestList, block_of, corner_block, key, reached_blocks};
use super::message::{Message, message_to};
use super::{Nodes, Periods, cells_at, cells_reaching, locate, nodes_per_block};
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
    /// Place of the body among those that are here.
    pub place: usize,
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
    cell_lists: CellLists,
    /// Bodies that have particles or blocks here, in their order: of several ranks, none looks at any others in a step.
    here: Vec<u32>,
    /// Bodies of which particles have come that may not be listed there yet.
    newcomers: Vec<u32>,
    /// Bodies that have guests.
    hosts: Vec<u32>,
    /// Tiles of all bodies, by body and block.
    pub tiles: Vec<Tile<D>>,
    /// Indices of the tiles of small bodies, by body and colour.
    pub small: Vec<u32>,
    /// All tiles of several small bodies in each range of these: ranges never write to the same slot.
    pub portions: Vec<Range<usize>>,
    /// Indices of the other tiles by colour: tiles of one colour never write to the same slot.
    pub colors: Vec<Vec<u32>>,
    /// Room for the tiles of a body with their colours; foreign ones are numbered behind those of this rank.
    colored: Vec<(usize, u32)>,
    /// Colour of each tile, where there are other ranks.
    color_of: Vec<usize>,
    /// What other ranks share, where there are any.
    pub border: Option<Box<Border>>,
    /// Faces behind which images lie.
    mirrors: Mirrors,
    /// Body and block of each field slot.
    pub slots: Vec<(u32, [i32; D])>,
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

/// A particle on the move to another rank.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Emigrant {
    /// Index of its body.
    pub body: usize,
    /// Its index there.
    pub particle: u32,
    /// Where it goes.
    pub rank: usize,
}

/// A block of this rank's tiles that another rank holds, too.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SentBlock<const D: usize> {
    /// The block.
    pub block: [i32; D],
    /// Place of the other rank in [`Border::outgoing`].
    pub to: usize,
    /// Along which axes that rank has the first layers only.
    pub cut: Cut,
}

/// Most tiles of a small body.
const MOST_SMALL: usize = 64;

/// A small body has at most this part of all tiles: so there are enough of them to share out.
const LEAST_SMALL: usize = 64;

/// Tiles of a portion, or a few more.
const PORTION: usize = 32;

/// Bodies that a thread takes at a time.
const BODIES: usize = 16;

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

    /// The same between mirrors, for one of several ranks.
    pub fn among_ranks(self, mirrors: Mirrors) -> Self {
        ActiveBlocks { mirrors, border: Some(Box::default()), ..self }
    }

    /// Bodies that have particles or blocks here, in their order.
    pub fn here(&self) -> &[u32] {
        &self.here
    }

    /// Takes note that bodies are here.
    fn welcome(&mut self, bodies: impl IntoIterator<Item = u32>) {
        let known = self.here.len();
        self.here.extend(bodies);
        if self.here.len() > known {
            self.here.sort_unstable();
            self.here.dedup();
        }
    }

    /// Begins with lists of so many bodies, of which those with particles are here, if there are none yet.
    fn begin(&mut self, bodies: usize, count: impl Fn(usize) -> usize, reach: i32) {
        if self.cell_lists.len() != bodies {
            self.cell_lists = CellLists::of_none(bodies, reach);
            self.here = (0..bodies as u32).filter(|&body| count(body as usize) > 0).collect();
            if self.here.is_empty() {
                // Somebody has to say that there are no blocks.
                self.here = (0..bodies.min(1) as u32).collect();
            }
        }
    }

    /// Does something to the list of each body that is here, on threads.
    fn each_here(&mut self, work: impl Fn(usize, &mut CellList) + Sync) {
        self.cell_lists.each_of(&self.here, BODIES, work);
    }

    /// Whether what is at a block is booked by this rank; by one that is alone, always.
    pub fn books(&self, block: [i32; D]) -> bool {
        self.border.as_ref().is_none_or(|border| border.books(block))
    }

    /// Names the tiles of this rank to those who may have to do with them, which `owner` tells for blocks of the first
    /// period: by rank, each tile as [`ForeignTile::read`] reads it.
    pub fn named(&mut self, rank: usize, owner: impl Fn([i32; D]) -> usize) -> Vec<Message> {
        let mut border = self.border.take().expect("there are other ranks");
        let Border { near, ranks_near, .. } = &mut *border;
        near.clear();
        let mut messages: Vec<Message> = Vec::new();
        for body in self.here.iter().map(|&body| body as usize) {
            let list = &self.cell_lists[body];
            for (number, (&home, &reached)) in list.homes.iter().zip(&list.reached).enumerate() {
                let others =
                    ranks_near.entry(home).or_insert_with(|| self.ranks_near(block_of(home), rank, &owner));
                if others.is_empty() && self.mirrors.faces.is_empty() {
                    continue;
                }
                near.push([body as u32, number as u32]);
                let name = ForeignTile::write(body, home, reached);
                others.iter().for_each(|&to| message_to(&mut messages, to as usize).extend(name));
            }
        }
        self.border = Some(border);
        messages
    }

    /// The other ranks that may have to do with tiles at a block.
    fn ranks_near(&self, home: [i32; D], rank: usize, owner: &impl Fn([i32; D]) -> usize) -> Box<[u32]> {
        let radius = self.mirrors.radius(home);
        let count: i32 = radius.iter().map(|radius| 2 * radius + 1).product();
        let beside = |n: i32| {
            let mut rest = n;
            let block = std::array::from_fn(|i| {
                let side = 2 * radius[i] + 1;
                let step = rest % side - radius[i];
                rest /= side;
                home[i] + step
            });
            owner(self.periods.wrapped(block))
        };
        let mut near: Vec<u32> =
            (0..count).map(beside).filter(|&other| other != rank).map(|other| other as u32).collect();
        near.sort_unstable();
        near.dedup();
        near.into()
    }

    /// Takes note that blocks have other owners than before.
    pub fn forget_owners(&mut self) {
        self.border.iter_mut().for_each(|border| border.ranks_near.clear());
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
        self.begin(bodies, &count, reach);
        let changed = AtomicBool::new(false);
        self.each_here(|body, cell_list| {
            let looks = (|particle| base(body, particle), |particle| number(body, particle));
            let blocks = match left {
                Some(left) if !cell_list.forgotten => {
                    let left = &left[cell_list.tiles.clone()];
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

    /// The same for the particles of one of several ranks, in steps: finds those on the move, and those in blocks of
    /// the first period that are `lost` to other ranks. Then follow [`ActiveBlocks::emigrants`],
    /// [`ActiveBlocks::renumber`], [`ActiveBlocks::arrive`] and [`ActiveBlocks::settle`].
    pub fn find_movers(
        &mut self,
        (bodies, count, reach): (usize, impl Fn(usize) -> usize + Sync, i32),
        left: Option<&[u64]>,
        (base, number): (impl Fn(usize, usize) -> [i32; D] + Sync, impl Fn(usize, usize) -> u32 + Sync),
        lost: impl Fn([i32; D]) -> bool + Sync,
    ) {
        self.begin(bodies, &count, reach);
        let periods = self.periods;
        self.each_here(|body, cell_list| {
            let looks = (|particle| base(body, particle), |particle| number(body, particle));
            match left {
                Some(left) if !cell_list.forgotten => {
                    let left = &left[cell_list.tiles.clone()];
                    cell_list.find_movers(left, looks, |block| lost(periods.wrapped(block)));
                }
                _ => cell_list.find_all((count(body), reach), looks),
            }
        });
    }

    /// Those on the move to other ranks, which are in no list from now on, by body and index; `abroad` tells whose a
    /// block of the first period is, if not this rank's.
    pub fn emigrants(&mut self, abroad: impl Fn([i32; D]) -> Option<usize>) -> Vec<Emigrant> {
        let (periods, lists) = (self.periods, &mut self.cell_lists);
        let mut all = Vec::new();
        for body in self.here.iter().map(|&body| body as usize) {
            let gone = lists[body].emigrants(|block| abroad(periods.wrapped(block)));
            all.extend(gone.into_iter().map(|(particle, rank)| Emigrant { body, particle, rank }));
        }
        all
    }

    /// Takes note that particles of a body lie elsewhere in memory, from where to where; `base` knows them there.
    pub fn renumber(&mut self, body: usize, moves: &[[u32; 2]], base: impl Fn(usize) -> [i32; D]) {
        self.cell_lists[body].renumber(moves, base);
    }

    /// Takes note of more particles of a body, with these indices.
    pub fn arrive(
        &mut self,
        (body, particles): (usize, Range<usize>),
        looks: (impl Fn(usize) -> [i32; D], impl Fn(usize) -> u32),
    ) {
        self.newcomers.push(body as u32);
        self.cell_lists[body].arrive(particles, looks);
    }

    /// Brings the lists up to date, and says whether the blocks under this rank's particles are others than before.
    pub fn settle(&mut self, number: impl Fn(usize, usize) -> u32 + Sync) -> Blocks {
        let newcomers = std::mem::take(&mut self.newcomers);
        self.welcome(newcomers);
        let changed = AtomicBool::new(false);
        self.each_here(|body, cell_list| {
            let settled =
                cell_list.is_stale().then(|| cell_list.settle::<D>(&|particle| number(body, particle)));
            if settled == Some(Blocks::New) {
                changed.store(true, Ordering::Relaxed);
            }
        });
        if changed.into_inner() { Blocks::New } else { Blocks::Same }
    }

    /// Covers the tiles of this rank and of others at the same blocks, which those have named.
    pub fn cover(&mut self, named: &[ForeignTile], rank: usize) {
        let mut border = self.border.take().unwrap_or_default();
        border.find((named, rank), &self.cell_lists, (self.periods, &self.mirrors));
        self.welcome(border.foreign.chunk_by(|a, b| a.body == b.body).map(|of_body| of_body[0].body));
        for body in self.here.iter().map(|&body| body as usize) {
            let cell_list = &mut self.cell_lists[body];
            if cell_list.has_foreign_blocks {
                cell_list.find_blocks::<D>();
            }
            let own = cell_list.blocks.len();
            cell_list.blocks.extend(border.blocks_of(body, self.periods));
            if cell_list.blocks.len() > own {
                cell_list.has_foreign_blocks = true;
                cell_list.blocks.sort_unstable();
                cell_list.blocks.dedup();
            }
        }
        self.border = Some(border);
        self.rebuild();
    }

    /// Takes note that a body has other particles: the next update looks at all of them.
    pub fn forget(&mut self, body: usize) {
        self.cell_lists[body].forgotten = true;
    }

    /// Covers a body anew: all its particles are others than before. Counts as [`ActiveBlocks::update`] does. Among
    /// ranks [`ActiveBlocks::cover`] has to follow.
    pub fn replace(
        &mut self,
        (body, count, reach): (usize, usize, i32),
        looks: (impl Fn(usize) -> [i32; D], impl Fn(usize) -> u32 + Sync),
    ) {
        self.welcome([body as u32]);
        self.cell_lists[body].start((count, reach), looks);
        if self.border.is_none() {
            self.rebuild();
        }
    }

    /// The blocks of a body.
    pub fn blocks_of(&self, body: usize) -> impl Iterator<Item = [i32; D]> {
        self.slots[self.slots_of_body(body)].iter().map(|(_, block)| *block)
    }

    /// The blocks that this rank's particles of a body reach, some of them several times.
    pub fn reached_by(&self, body: usize) -> impl Iterator<Item = [i32; D]> {
        let list = &self.cell_lists[body];
        let of_tile = |tile: usize| list.reached_by::<D>(tile);
        (0..list.homes.len()).flat_map(of_tile).map(|block| self.periods.wrapped(block))
    }

    fn rebuild(&mut self) {
        let (lists, images) = (&mut self.cell_lists, &mut self.images);
        self.here.retain(|&body| {
            let is_here = !lists[body as usize].is_empty();
            if !is_here {
                lists.clear(body as usize);
                images.get_mut(body as usize).into_iter().for_each(Vec::clear);
            }
            is_here
        });
        if self.periods.any() {
            self.find_images();
        }
        let periods = self.periods;
        self.slots.clear();
        self.tiles.clear();
        self.keys.clear();
        for (place_of_body, body) in self.here.iter().map(|&body| body as usize).enumerate() {
            let cell_list = &mut self.cell_lists[body];
            let (first, first_tile) = (self.slots.len(), self.tiles.len());
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
                self.tiles.push(Tile { body, block, number, place: place_of_body, slots });
            }
            (cell_list.slots, cell_list.tiles) = (first..self.slots.len(), first_tile..self.tiles.len());
        }
        self.share_out();
        self.meet();
        self.share();
    }

    /// Finds what this rank shares with others.
    fn share(&mut self) {
        let Some(mut border) = self.border.take() else { return };
        let slot = |body: usize, block: u64| {
            let list = &self.cell_lists[body];
            let place = list.blocks.binary_search(&block).ok()?;
            Some((list.slots.start + place) as u32)
        };
        let own = (&self.tiles[..], &self.cell_lists);
        border.share(own, (slot, &self.color_of), (self.periods, &self.mirrors));
        self.border = Some(border);
    }

    /// Finds the images of blocks that bodies reach, and gives these blocks the nodes of those in the first period.
    fn find_images(&mut self) {
        let periods = self.periods;
        self.images.resize_with(self.cell_lists.len(), Vec::new);
        let border = self.border.as_deref();
        for body in self.here.iter().map(|&body| body as usize) {
            let (cell_list, images) = (&mut self.cell_lists[body], &mut self.images[body]);
            images.clear();
            let foreign = border.map_or(&[][..], |border| &border.foreign[border.of_body(body)]);
            let own = cell_list.homes.iter().zip(&cell_list.reached).map(|(&home, &reached)| (home, reached));
            for (home, reached) in own.chain(foreign.iter().map(|tile| (tile.home, tile.reached))) {
                images.extend(reached_blocks::<D>(block_of(home), reached).map(|block| {
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

    /// Small bodies together make portions, each for one thread; the tiles of large ones get colours. In both, a slot
    /// is given what its tiles have in the order of their colours: whether a body is small changes no bit.
    fn share_out(&mut self) {
        self.small.clear();
        self.portions.clear();
        self.colors.resize_with(1 << D, Vec::new);
        self.colors.iter_mut().for_each(Vec::clear);
        let mut border = self.border.take();
        let count = self.tiles.len();
        if let Some(border) = &mut border {
            self.color_of.resize(count, 0);
            border.colors.resize(border.foreign.len(), 0);
        }
        for place in 0..self.here.len() {
            let body = self.here[place] as usize;
            let tiles = self.tiles_of_body(body);
            let small = tiles.len() <= MOST_SMALL && tiles.len() * LEAST_SMALL <= count;
            self.color(body, border.as_deref());
            if let Some(border) = &mut border {
                for &(color, tile) in &self.colored {
                    match (tile as usize).checked_sub(count) {
                        Some(foreign) => border.colors[foreign] = color,
                        None => self.color_of[tile as usize] = color,
                    }
                }
                self.colored.retain(|&(_, tile)| (tile as usize) < count);
            }
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
        self.border = border;
    }

    /// Finds the colours of a body's tiles, foreign ones among them: those of one colour have no slot in common. Where
    /// the grid repeats, several tiles may have the same nodes: each of them gets other colours.
    fn color(&mut self, body: usize, border: Option<&Border>) {
        let (tiles, periods) = (self.tiles_of_body(body), self.periods);
        let ActiveBlocks { colored, tiles: all, .. } = self;
        let own = tiles.map(|i| (all[i].block, i as u32));
        let foreign = border.map(|border| (&border.foreign[..], border.of_body(body)));
        let foreign = foreign.into_iter().flat_map(|(tiles, range)| {
            range.map(|place| (block_of(tiles[place].home), (all.len() + place) as u32))
        });
        let everyone = own.chain(foreign);
        colored.clear();
        if !periods.any() {
            let color = |block: [i32; D]| block.iter().fold(0, |color, b| color << 1 | (b & 1) as usize);
            colored.extend(everyone.map(|(block, tile)| (color(block), tile)));
            return;
        }
        let mut places: Vec<(u64, u64, u32)> =
            everyone.map(|(block, tile)| (key(periods.wrapped(block)), key(block), tile)).collect();
        places.sort_unstable();
        for images in places.chunk_by(|a, b| a.0 == b.0) {
            for (number, &(block, _, tile)) in images.iter().enumerate() {
                colored.push((number * 3_usize.pow(D as u32) + periods.color(block_of(block)), tile));
            }
        }
    }

    fn meet(&mut self) {
        self.shared_blocks.clear();
        self.shared.clear();
        self.border.iter_mut().for_each(|border| border.shared.clear());
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
            if let Some(border) = &mut self.border {
                border.shared.push((group[0].0, [start as u32, self.shared.len() as u32]));
            }
        }
        // By first body: its particles stay in the cache from block to block.
        self.shared_blocks.sort_unstable_by_key(|meeting| self.shared[meeting.start]);
    }

    /// Places in the body's order where the particles of each cell of a tile begin, and where the last ends.
    pub fn cells_of(&self, tile: &Tile<D>) -> &[u32] {
        let n = nodes_per_block(D);
        &self.cell_lists[tile.body].cells[tile.number * n..=(tile.number + 1) * n]
    }

    /// The tiles whose particles another rank sees, and in which cells those are, a bit each: particles that reach
    /// nodes which the other rank has and several bodies have mass at. `present`: the nodes of each slot with mass,
    /// `side`: that of windows.
    pub fn seen_by<'a>(
        &'a self,
        traffic: &'a Traffic,
        present: &'a [Nodes],
        side: usize,
    ) -> impl Iterator<Item = (&'a Tile<D>, u64)> {
        let border = self.border.as_deref().into_iter();
        border.flat_map(move |border| {
            traffic.windows.iter().filter_map(move |window| {
                let tile = &self.tiles[border.kept[window.place as usize] as usize];
                let seen = |corner: usize| {
                    let block = self.periods.wrapped(corner_block(tile.block, corner));
                    let Some(slots) = border.slots_of(key(block)) else { return 0 };
                    let part = (corner, window.cuts[corner]);
                    // Images of nodes near mirrors look at others.
                    if self.mirrors.are_near(block) {
                        return cells_at::<D>(corner, window.cuts[corner], side);
                    }
                    let nodes = self.shared[slots].iter().map(|&slot| present[slot as usize]);
                    let [_, several] =
                        nodes.fold([0, 0], |[once, twice], nodes| [once | nodes, twice | once & nodes]);
                    cells_reaching::<D>(several, part, side)
                };
                let corners = (0..1 << D).filter(|corner| window.corners >> corner & 1 == 1);
                let cells = corners.fold(0, |cells, corner| cells | seen(corner));
                (cells != 0).then_some((tile, cells))
            })
        })
    }

    /// Whether several bodies hold a block that a tile reaches; known where there are other ranks.
    pub fn meets(&self, tile: &Tile<D>) -> bool {
        let reached = self.cell_lists[tile.body].reached_by::<D>(tile.number);
        let held_by_several =
            |border: &Border, block| border.slots_of(key(self.periods.wrapped(block))).is_some();
        let meets = |border: &Border| reached.into_iter().any(|block| held_by_several(border, block));
        self.border.as_deref().is_some_and(meets)
    }

    /// Blocks of this rank's tiles that other ranks hold, too, sorted; once for each of these.
    pub fn blocks_sent(&self) -> Vec<SentBlock<D>> {
        let mut blocks: Vec<SentBlock<D>> = Vec::new();
        let Some(border) = &self.border else { return blocks };
        for (to, traffic) in border.outgoing.iter().enumerate() {
            for window in &traffic.windows {
                let home = self.tiles[border.kept[window.place as usize] as usize].block;
                let corners = (0..1 << D).filter(|corner| window.corners >> corner & 1 == 1);
                blocks.extend(corners.map(|corner| {
                    let block = self.periods.wrapped(corner_block(home, corner));
                    SentBlock { block, to, cut: window.cuts[corner] }
                }));
            }
        }
        blocks.sort_unstable();
        blocks.dedup();
        blocks
    }

    /// The key of a tile's home.
    pub fn home_of(&self, tile: &Tile<D>) -> u64 {
        key(tile.block)
    }

    /// Indices of a body's own particles, or of those that are guests of other ranks, by tile, cell and number.
    pub fn order(&self, body: usize, guests: bool) -> &[u32] {
        let cell_list = &self.cell_lists[body];
        if guests { &cell_list.guests.order } else { &cell_list.order }
    }

    /// Sends the guests of all bodies away, and says which had some.
    pub fn dismiss_guests(&mut self) -> Vec<u32> {
        let hosts = std::mem::take(&mut self.hosts);
        hosts.iter().for_each(|&body| self.cell_lists[body as usize].guests = GuestList::default());
        hosts
    }

    /// Takes note of guests of a body in a tile of another rank, by its home: the particles of each cell, with these
    /// indices from `first` on. Tiles come in their order.
    pub fn invite(&mut self, (body, home): (usize, u64), first: usize, counts: impl Iterator<Item = usize>) {
        if self.hosts.last() != Some(&(body as u32)) {
            self.hosts.push(body as u32);
        }
        let GuestList { order, cells, homes } = &mut self.cell_lists[body].guests;
        homes.push(home);
        let mut end = first;
        for count in counts {
            cells.push(order.len() as u32);
            order.extend(end as u32..(end + count) as u32);
            end += count;
        }
        cells.push(order.len() as u32);
    }

    /// Indices of a body's particles by tile, cell and number.
    pub fn order_of(&self, body: usize) -> &[u32] {
        self.order(body, false)
    }

    /// The slots of a body.
    pub fn slots_of_body(&self, body: usize) -> Range<usize> {
        self.cell_lists[body].slots.clone()
    }

    /// The tiles of a body.
    pub fn tiles_of_body(&self, body: usize) -> Range<usize> {
        self.cell_lists[body].tiles.clone()
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
        let list = &self.cell_lists[body];
        let place = list.blocks.binary_search(&key(block)).ok()?;
        Some((list.slots.start + place) * nodes_per_block(D) + local)
    }

    /// How far away blocks are whose nodes are those of the first period and which a body's particles reach, in blocks.
    #[inline]
    pub fn images_of(&self, body: usize) -> &[[i32; D]] {
        if self.periods.any() { &self.images[body] } else { &[[0; D]] }
    }

    /// A body's particles whose home is a block: whether they are guests, and the places where those of each cell begin
    /// and where the last ends, in the [order](ActiveBlocks::order) of its own particles or its guests.
    #[inline]
    pub fn tile_at(&self, body: usize, block: [i32; D]) -> Option<(bool, &[u32])> {
        let (cell_list, n) = (&self.cell_lists[body], nodes_per_block(D));
        if let Ok(tile) = cell_list.homes.binary_search(&key(block)) {
            return Some((false, &cell_list.cells[tile * n..=(tile + 1) * n]));
        }
        let GuestList { cells, homes, .. } = &cell_list.guests;
        let tile = homes.binary_search(&key(block)).ok()?;
        Some((true, &cells[tile * (n + 1)..][..=n]))
    }

    /// Indices of a body's particles whose home is a cell.
    pub fn particles_in(&self, body: usize, cell: [i32; D]) -> &[u32] {
        let (block, local) = locate(cell);
        let Some((guests, cells)) = self.tile_at(body, block) else { return &[] };
        &self.order(body, guests)[cells[local] as usize..cells[local + 1] as usize]
    }
}
