//! What this rank and others share of the grid.
//!
//! A tile belongs to one rank, and the windows of all tiles at a block are added by each rank that has a tile there,
//! in the order of their colours: so all of them have the same nodes, bit for bit, as one rank alone would have. A
//! *foreign* tile is one of another rank near this one's.
//!
//! Of a block that a rank reaches only from blocks before it, it has the first layers of nodes right, as far as its
//! tiles reach, and the others nobody asks for: if a tile has its home there, the tile's rank has the whole block.
//! Blocks that are nobody's home are whole wherever they are held, and so are those near mirrors.

use super::cell_list::{CellLists, CornerBlocks, block_of, corner_block, key, reached_blocks};
use super::{Periods, SIDE, Tile, count_at, nodes_at};
use std::collections::HashMap;
use std::ops::Range;

/// A tile whose particles another rank has. They are ordered by body and home, whoever has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ForeignTile {
    /// Index of the body.
    pub body: u32,
    /// Key of its home block.
    pub(super) home: u64,
    /// Which blocks its particles reach.
    pub(super) reached: CornerBlocks,
    /// The rank.
    pub rank: usize,
}

impl ForeignTile {
    /// Bytes that name a tile: body, home, blocks that it reaches.
    pub(super) const BYTES: usize = 13;

    /// Names a tile.
    pub(super) fn write(body: usize, home: u64, reached: CornerBlocks) -> [u8; Self::BYTES] {
        let mut bytes = [reached; Self::BYTES];
        bytes[..4].copy_from_slice(&(body as u32).to_le_bytes());
        bytes[4..12].copy_from_slice(&home.to_le_bytes());
        bytes
    }

    /// The tiles that a rank has named.
    pub fn read(rank: usize, bytes: &[u8]) -> impl Iterator<Item = ForeignTile> {
        bytes.chunks_exact(Self::BYTES).map(move |bytes| ForeignTile {
            body: u32::from_le_bytes(std::array::from_fn(|i| bytes[i])),
            home: u64::from_le_bytes(std::array::from_fn(|i| bytes[4 + i])),
            reached: bytes[12],
            rank,
        })
    }
}

/// A slot of the field to which tiles of other ranks give, too.
#[derive(Clone, Debug)]
pub struct BorderSlot {
    /// The slot.
    pub slot: u32,
    /// Who gives, in [`Border::givers`], in the order of colours.
    pub givers: Range<usize>,
}

/// A tile that gives to a slot.
#[derive(Clone, Copy, Debug)]
pub struct Giver {
    /// Place of its window: those that are kept, and behind them those of foreign tiles.
    pub window: u32,
    /// Which of the tile's blocks the slot is.
    pub corner: u8,
}

/// Tiles of another rank, and what is sent there or comes from there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Traffic {
    /// The other rank.
    pub rank: usize,
    /// What is sent or comes, in this order.
    pub windows: Vec<SentWindow>,
}

/// A part of a tile's window that one rank sends to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SentWindow {
    /// The tile's place in [`Border::kept`] where it is sent, and in [`Border::foreign`] where it comes.
    pub place: u32,
    /// The tile's blocks that the other rank holds, too.
    pub corners: CornerBlocks,
    /// Of each of them, along which axes the receiver has the first layers only.
    pub cuts: [Cut; 8],
}

/// Axes along which a rank has the first layers of a block only, a bit each: the last axis in the lowest bit, as that
/// of `corner_block`.
pub type Cut = u8;

/// What this rank shares with others.
#[derive(Clone, Debug, Default)]
pub struct Border {
    /// Tiles of other ranks that may have to do with those here; some are at no block that this rank holds.
    pub foreign: Vec<ForeignTile>,
    /// Colour of each of them.
    pub(super) colors: Vec<usize>,
    /// Tiles of this rank whose windows are kept: others want them, or they wait for those of others.
    pub kept: Vec<u32>,
    /// Of each tile, its place among those if it is one, and its blocks to which others give, too.
    pub of_tile: Vec<(Option<u32>, CornerBlocks)>,
    /// Slots to which others give, too.
    pub slots: Vec<BorderSlot>,
    /// Who gives to them.
    pub givers: Vec<Giver>,
    /// What is sent, by rank.
    pub outgoing: Vec<Traffic>,
    /// What comes, by rank.
    pub incoming: Vec<Traffic>,
    /// Body and number of the tiles of this rank that others may have to do with, in their order.
    pub(super) near: Vec<[u32; 2]>,
    /// Of each home block, the other ranks that may have to do with tiles there, as far as it is known.
    pub(super) ranks_near: HashMap<u64, Box<[u32]>>,
    /// Blocks that several bodies hold, sorted, and where their slots are in [`super::ActiveBlocks`].
    pub(super) shared: Vec<(u64, [u32; 2])>,
    /// Blocks of this rank's tiles that are near others, sorted.
    held: Vec<u64>,
    /// Along which axes this rank has their first layers only.
    cuts: Vec<Cut>,
    /// Of each of them, whether this rank has a tile whose home it is, or if there is none, is the first of those that
    /// reach it.
    booked: Vec<bool>,
    /// Home blocks of tiles of all ranks near here, and their ranks, sorted.
    homes: Vec<(u64, usize)>,
}

/// Faces that are mirrors.
#[derive(Clone, Debug, Default)]
pub struct Mirrors {
    /// Axis and node of each.
    pub faces: Vec<(usize, i32)>,
}

impl Mirrors {
    /// Adds the blocks in which images of nodes of these blocks lie, as far as particles reach behind mirrors.
    fn add_images<const D: usize>(&self, blocks: &mut Vec<u64>) {
        for &(axis, node) in &self.faces {
            let near = |block: &[i32; D]| is_near(block[axis], node);
            let images = blocks.iter().map(|&block| block_of::<D>(block)).filter(near).flat_map(|block| {
                let image = |n: i32| (2 * node - n).div_euclid(SIDE);
                let first = block[axis] * SIDE;
                [image(first), image(first + SIDE - 1)].map(|along| {
                    let mut image = block;
                    image[axis] = along;
                    key(image)
                })
            });
            let images: Vec<u64> = images.collect();
            blocks.extend(images);
            blocks.sort_unstable();
            blocks.dedup();
        }
    }

    /// Whether a block may have images of nodes near mirrors, or nodes whose images count.
    pub(super) fn are_near<const D: usize>(&self, block: [i32; D]) -> bool {
        self.faces.iter().any(|&(axis, node)| (block[axis] - node.div_euclid(SIDE)).abs() <= 3)
    }

    /// How many blocks away along each axis tiles may have to do with those at a block.
    pub(super) fn radius<const D: usize>(&self, block: [i32; D]) -> [i32; D] {
        std::array::from_fn(|i| {
            let near = self.faces.iter().any(|&(axis, node)| axis == i && is_near(block[axis], node));
            if near { 4 } else { 1 }
        })
    }
}

/// Whether a block lies within two blocks of a mirror.
fn is_near(along: i32, node: i32) -> bool {
    (along - node.div_euclid(SIDE)).abs() <= 2
}

impl Border {
    /// Whether this rank holds a block of the first period that others may hold, too.
    pub(super) fn holds(&self, block: u64) -> bool {
        self.held.binary_search(&block).is_ok()
    }

    /// Along which axes this rank has the first layers only of a block of the first period; none if it does not hold
    /// it.
    fn cut(&self, block: u64) -> Option<Cut> {
        self.held.binary_search(&block).ok().map(|place| self.cuts[place])
    }

    /// Whether what is at a block that this rank holds is booked by it: one of those does who have the whole block.
    pub fn books<const D: usize>(&self, block: [i32; D]) -> bool {
        self.held.binary_search(&key(block)).map_or(true, |place| self.booked[place])
    }

    /// Where the slots of a block of the first period are, if several bodies hold it.
    pub(super) fn slots_of(&self, block: u64) -> Option<Range<usize>> {
        let place = self.shared.binary_search_by_key(&block, |(block, _)| *block).ok()?;
        let [start, end] = self.shared[place].1;
        Some(start as usize..end as usize)
    }

    /// The foreign tiles of a body.
    pub fn of_body(&self, body: usize) -> Range<usize> {
        let first = |body: usize| self.foreign.partition_point(|tile| (tile.body as usize) < body);
        first(body)..first(body + 1)
    }

    /// Takes the tiles that other ranks have named, and finds the blocks that this rank holds.
    pub(super) fn find<const D: usize>(
        &mut self,
        (named, rank): (&[ForeignTile], usize),
        lists: &CellLists,
        (periods, mirrors): (Periods<D>, &Mirrors),
    ) {
        let wrapped = |block: [i32; D]| key(periods.wrapped(block));
        self.foreign.clear();
        self.foreign.extend(named);
        self.foreign.sort_unstable();
        let own = self.near.iter().map(|&[body, number]| {
            let list = &lists[body as usize];
            (list.homes[number as usize], list.reached[number as usize])
        });
        self.homes.clear();
        self.homes.extend(own.clone().map(|(home, _)| (wrapped(block_of(home)), rank)));
        self.homes.extend(self.foreign.iter().map(|tile| (wrapped(block_of(tile.home)), tile.rank)));
        self.homes.sort_unstable();
        self.homes.dedup();
        let own = held_blocks(own, &self.homes, (periods, mirrors));
        self.held.clear();
        self.held.extend(own.iter().map(|(block, _)| block));
        self.cuts.clear();
        self.cuts.extend(own.iter().map(|(_, cut)| cut));
        let mut first: Vec<usize> = vec![usize::MAX; self.held.len()];
        let reached =
            |home: u64, reached: CornerBlocks| reached_blocks::<D>(block_of(home), reached).map(wrapped);
        let tiles = self.foreign.iter().map(|tile| (tile.home, tile.reached, tile.rank));
        let near = self.near.iter().map(|&[body, number]| {
            let list = &lists[body as usize];
            (list.homes[number as usize], list.reached[number as usize], rank)
        });
        for (home, blocks, of) in tiles.chain(near) {
            for block in reached(home, blocks) {
                if let Ok(place) = self.held.binary_search(&block) {
                    first[place] = first[place].min(of);
                }
            }
        }
        for &(home, of) in &self.homes {
            if let Ok(place) = self.held.binary_search(&home) {
                first[place] = of;
            }
        }
        self.booked.clear();
        self.booked.extend(first.iter().map(|&first| first == rank));
    }

    /// The blocks of a body's foreign tiles that this rank holds.
    pub(super) fn blocks_of<const D: usize>(
        &self,
        body: usize,
        periods: Periods<D>,
    ) -> impl Iterator<Item = u64> {
        let tiles = &self.foreign[self.of_body(body)];
        let blocks = tiles.iter().flat_map(|tile| reached_blocks::<D>(block_of(tile.home), tile.reached));
        blocks.map(move |block| key(periods.wrapped(block))).filter(|block| self.holds(*block))
    }

    /// Finds who gives to which slot, and whose windows go where; `slot` of a body's block of the first period, and
    /// `color` of each tile.
    pub(super) fn share<const D: usize>(
        &mut self,
        (tiles, lists): (&[Tile<D>], &CellLists),
        (slot, color): (impl Fn(usize, u64) -> Option<u32>, &[usize]),
        (periods, mirrors): (Periods<D>, &Mirrors),
    ) {
        let wrapped = |block: [i32; D]| key(periods.wrapped(block));
        // What foreign tiles give.
        let mut gifts: Vec<(u32, usize, u32, u8)> = Vec::new();
        for (place, tile) in self.foreign.iter().enumerate() {
            for corner in (0..1 << D).filter(|&corner| tile.reached >> corner & 1 == 1) {
                let block = wrapped(corner_block(block_of(tile.home), corner));
                if let Some(slot) = slot(tile.body as usize, block) {
                    gifts.push((slot, self.colors[place], place as u32, corner as u8));
                }
            }
        }
        let mut border: Vec<u32> = gifts.iter().map(|gift| gift.0).collect();
        border.sort_unstable();
        border.dedup();
        // Of each rank that has foreign tiles, the blocks that it holds near here.
        let mut others: Vec<usize> = self.foreign.iter().map(|tile| tile.rank).collect();
        others.sort_unstable();
        others.dedup();
        let held_by = |rank: usize| {
            let tiles = self.foreign.iter().filter(|tile| tile.rank == rank);
            held_blocks(tiles.map(|tile| (tile.home, tile.reached)), &self.homes, (periods, mirrors))
        };
        let held: Vec<Vec<(u64, Cut)>> = others.iter().map(|&rank| held_by(rank)).collect();
        let mut sent: Vec<Vec<SentWindow>> = vec![Vec::new(); others.len()];
        self.kept.clear();
        self.of_tile.clear();
        self.of_tile.resize(tiles.len(), (None, 0));
        for &[body, number] in &self.near {
            let i = lists[body as usize].tiles.start + number as usize;
            let tile = &tiles[i];
            let reached = lists[tile.body].reached[tile.number];
            let shared = (0..1_usize << D)
                .filter(|&corner| {
                    reached >> corner & 1 == 1 && border.binary_search(&tile.slots[corner]).is_ok()
                })
                .fold(0, |shared, corner| shared | 1 << corner);
            let place = self.kept.len() as u32;
            let mut wanted = shared != 0;
            for (held, sent) in held.iter().zip(&mut sent) {
                let held = |block: [i32; D]| {
                    let found = held.binary_search_by_key(&wrapped(block), |(block, _)| *block);
                    found.ok().map(|at| held[at].1)
                };
                let window = SentWindow::new((place, tile.block, reached), held);
                wanted |= window.corners != 0;
                sent.extend(Some(window).filter(|window| window.corners != 0));
            }
            self.of_tile[i] = (wanted.then_some(place), shared);
            if wanted {
                self.kept.push(i as u32);
            }
            for corner in (0..1 << D).filter(|corner| shared >> corner & 1 == 1) {
                gifts.push((tile.slots[corner], color[i], place, corner as u8 | OWN));
            }
        }
        gifts.sort_unstable();
        self.slots.clear();
        self.givers.clear();
        for gifts in gifts.chunk_by(|a, b| a.0 == b.0) {
            let first = self.givers.len();
            self.givers.extend(gifts.iter().map(|&(_, _, place, corner)| match corner & OWN {
                0 => Giver { window: self.kept.len() as u32 + place, corner },
                _ => Giver { window: place, corner: corner & !OWN },
            }));
            self.slots.push(BorderSlot { slot: gifts[0].0, givers: first..self.givers.len() });
        }
        let sent = others.iter().zip(sent).filter(|(_, sent)| !sent.is_empty());
        self.outgoing = sent.map(|(&rank, windows)| Traffic { rank, windows }).collect();
        let come = |&rank: &usize| {
            let tiles = self.foreign.iter().zip(0..).filter(|(tile, _)| tile.rank == rank);
            let windows = tiles.map(|(tile, place)| {
                SentWindow::new((place, block_of::<D>(tile.home), tile.reached), |block| {
                    self.cut(wrapped(block))
                })
            });
            Traffic { rank, windows: windows.filter(|window| window.corners != 0).collect() }
        };
        self.incoming = others.iter().map(come).filter(|traffic| !traffic.windows.is_empty()).collect();
    }
}

impl Traffic {
    /// How many nodes are sent or come, of windows with this side.
    pub fn nodes<const D: usize>(&self, side: usize) -> usize {
        let of_window = |sent: &SentWindow| {
            let corners = (0..1_usize << D).filter(|corner| sent.corners >> corner & 1 == 1);
            corners.map(|corner| count_at::<D>(corner, sent.cuts[corner], side)).sum::<usize>()
        };
        self.windows.iter().map(of_window).sum()
    }
}

impl SentWindow {
    /// The nodes that are sent of a window with this side.
    pub fn nodes<const D: usize>(&self, side: usize) -> impl Iterator<Item = usize> {
        let corners = (0..1_usize << D).filter(|corner| self.corners >> corner & 1 == 1);
        corners.flat_map(move |corner| nodes_at::<D>(corner, self.cuts[corner], side))
    }

    /// What of a tile at a place, with a home and the blocks that it reaches, is sent to a rank: what it holds of a
    /// block `held` tells.
    fn new<const D: usize>(
        (place, home, reached): (u32, [i32; D], CornerBlocks),
        held: impl Fn([i32; D]) -> Option<Cut>,
    ) -> Self {
        let mut window = SentWindow { place, corners: 0, cuts: [0; 8] };
        for corner in (0..1_usize << D).filter(|&corner| reached >> corner & 1 == 1) {
            if let Some(cut) = held(corner_block(home, corner)) {
                window.corners |= 1 << corner;
                window.cuts[corner] = cut;
            }
        }
        window
    }
}

/// The blocks that a rank holds by these tiles, by their homes and what they reach, and along which axes it has their
/// first layers only: sorted. `homes`: those of all tiles near there.
fn held_blocks<const D: usize>(
    tiles: impl Iterator<Item = (u64, CornerBlocks)>,
    homes: &[(u64, usize)],
    (periods, mirrors): (Periods<D>, &Mirrors),
) -> Vec<(u64, Cut)> {
    let mut all: Vec<(u64, Cut)> = tiles
        .flat_map(|(home, reached)| {
            let corners = (0..1_usize << D).filter(move |&corner| reached >> corner & 1 == 1);
            corners.map(move |corner| {
                (key(periods.wrapped(corner_block(block_of::<D>(home), corner))), corner as Cut)
            })
        })
        .collect();
    all.sort_unstable();
    // Of several tiles that reach it, what any of them does.
    all.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 &= next.1;
        }
        same
    });
    for (block, cut) in &mut all {
        let place = homes.partition_point(|(home, _)| home < block);
        if homes.get(place).is_none_or(|(home, _)| home != block) || mirrors.are_near(block_of::<D>(*block)) {
            *cut = 0;
        }
    }
    if !mirrors.faces.is_empty() {
        let mut blocks: Vec<u64> = all.iter().map(|(block, _)| *block).collect();
        mirrors.add_images::<D>(&mut blocks);
        let cut = |block: u64| {
            all.binary_search_by_key(&block, |(block, _)| *block).map_or(0, |place| all[place].1)
        };
        return blocks.into_iter().map(|block| (block, cut(block))).collect();
    }
    all
}

/// Marks the corner of a tile of this rank.
const OWN: u8 = 1 << 7;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::ActiveBlocks;
    use proptest::prelude::*;

    /// Two bodies in a strip of blocks, between mirrors or not, whose blocks belong to ranks as chance has it.
    #[derive(Clone, Debug)]
    struct Shared {
        /// Body and base node of each particle.
        particles: Vec<(usize, [i32; 2])>,
        /// Rank of each block, in rows of eight.
        owners: Vec<usize>,
        /// Whether there are mirrors; without them, of some blocks ranks have a part only.
        mirrored: bool,
    }

    const RANKS: usize = 3;

    fn shared() -> impl Strategy<Value = Shared> {
        let particles = prop::collection::vec((0..2_usize, prop::array::uniform2(-1..31_i32)), 1..60);
        let owners = prop::collection::vec(0..RANKS, 100);
        let all = (particles, owners, any::<bool>());
        all.prop_map(|(particles, owners, mirrored)| Shared { particles, owners, mirrored })
    }

    impl Shared {
        fn owner(&self, [x, y]: [i32; 2]) -> usize {
            self.owners[((x + 1).clamp(0, 9) * 10 + (y + 1).clamp(0, 9)) as usize]
        }

        /// The blocks of each rank, after all have named their tiles.
        fn ranks(&self) -> Vec<ActiveBlocks<2>> {
            let mut ranks: Vec<ActiveBlocks<2>> = (0..RANKS).map(|rank| self.alone(rank)).collect();
            let named: Vec<_> =
                (0..RANKS).map(|rank| ranks[rank].named(rank, |block| self.owner(block))).collect::<Vec<_>>();
            for (rank, active) in ranks.iter_mut().enumerate() {
                let to_it = |from: usize| {
                    named[from].iter().filter(move |(to, _)| *to == rank).map(move |(_, names)| (from, names))
                };
                let tiles =
                    (0..RANKS).flat_map(to_it).flat_map(|(from, names)| ForeignTile::read(from, names));
                active.cover(&tiles.collect::<Vec<_>>(), rank);
            }
            ranks
        }

        fn alone(&self, rank: usize) -> ActiveBlocks<2> {
            let faces = if self.mirrored { vec![(0, 0), (1, 30)] } else { Vec::new() };
            let mirrors = Mirrors { faces };
            let mut active = ActiveBlocks::<2>::new(Periods::default()).among_ranks(mirrors);
            let own = |body: usize| {
                let here = move |&&(of, base): &&(usize, [i32; 2])| {
                    of == body && self.owner(base.map(|n| n.div_euclid(SIDE))) == rank
                };
                self.particles.iter().filter(here).map(|(_, base)| *base).collect::<Vec<_>>()
            };
            let bases = [own(0), own(1)];
            let base = |body: usize, i: usize| bases[body][i];
            active.find_movers(
                (2, |body: usize| bases[body].len(), 2),
                None,
                (base, |_, i: usize| i as u32),
                |_| false,
            );
            assert!(
                active.emigrants(|block| Some(self.owner(block)).filter(|&owner| owner != rank)).is_empty()
            );
            active.settle(|_, i| i as u32);
            active
        }
    }

    /// Body and home of tiles, which of their blocks, and how much of these.
    type Names = Vec<(u32, u64, CornerBlocks, [Cut; 8])>;

    proptest! {
        /// What one rank sends is what the other waits for, and each block is booked by one rank that has a tile there.
        #[test]
        fn ranks_agree_on_what_they_share(shared in shared()) {
            let ranks = shared.ranks();
            for (a, sender) in ranks.iter().enumerate() {
                for (b, receiver) in ranks.iter().enumerate().filter(|(b, _)| *b != a) {
                    let border = |active: &ActiveBlocks<2>| active.border.clone().expect("there are ranks");
                    let [from, to] = [sender, receiver].map(border);
                    let of = |traffic: &[Traffic], rank: usize| {
                        let traffic = traffic.iter().filter(|traffic| traffic.rank == rank);
                        traffic.flat_map(|traffic| traffic.windows.clone()).collect::<Vec<SentWindow>>()
                    };
                    let sent = of(&from.outgoing, b).into_iter().map(|SentWindow { place, corners, cuts }| {
                        let tile = &sender.tiles[from.kept[place as usize] as usize];
                        (tile.body as u32, key(tile.block), corners, cuts)
                    });
                    let waited = of(&to.incoming, a).into_iter().map(|SentWindow { place, corners, cuts }| {
                        let tile = &to.foreign[place as usize];
                        (tile.body, tile.home, corners, cuts)
                    });
                    let (sent, waited): (Names, Names) = (sent.collect(), waited.collect());
                    prop_assert_eq!(sent, waited, "{} to {}", a, b);
                }
            }
            for x in -1..9 {
                for y in -1..9 {
                    let here = |active: &ActiveBlocks<2>| active.slots.iter().any(|(_, block)| *block == [x, y]);
                    let reaches = |active: &ActiveBlocks<2>| {
                        let tiles = active.tiles.iter().flat_map(|tile| tile.slots);
                        let mut blocks = tiles.map(|slot| active.slots[slot as usize].1);
                        here(active) && blocks.any(|block| block == [x, y])
                    };
                    let books = ranks.iter().filter(|active| here(active) && active.books([x, y])).count();
                    prop_assert_eq!(books, usize::from(ranks.iter().any(reaches)), "{} {}", x, y);
                }
            }
        }

        /// A slot at the border is given the parts of all tiles that reach it, in the order in which one rank alone
        /// would give them.
        #[test]
        fn slots_are_given_what_one_rank_would_give(shared in shared()) {
            let colors = |block: [i32; 2]| ((block[0] & 1) << 1 | block[1] & 1) as usize;
            for active in shared.ranks() {
                let border = active.border.as_deref().expect("there are ranks");
                for BorderSlot { slot, givers } in &border.slots {
                    let (body, block) = active.slots[*slot as usize];
                    let home = |giver: &Giver| match (giver.window as usize).checked_sub(border.kept.len()) {
                        Some(place) => block_of::<2>(border.foreign[place].home),
                        None => active.tiles[border.kept[giver.window as usize] as usize].block,
                    };
                    let found: Vec<[i32; 2]> = border.givers[givers.clone()].iter().map(home).collect();
                    for (giver, home) in border.givers[givers.clone()].iter().zip(&found) {
                        prop_assert_eq!(corner_block(*home, usize::from(giver.corner)), block);
                    }
                    let near = |n: i32, block: i32| (block * SIDE - 2..block * SIDE + SIDE).contains(&n);
                    let reaches = |&&(of, base): &&(usize, [i32; 2])| {
                        of == body as usize && (0..2).all(|i| near(base[i], block[i]))
                    };
                    let homes = shared.particles.iter().filter(reaches);
                    let mut wanted: Vec<[i32; 2]> = homes.map(|(_, base)| base.map(|n| n.div_euclid(SIDE))).collect();
                    wanted.sort_by_key(|&block| (colors(block), block));
                    wanted.dedup();
                    prop_assert_eq!(found, wanted);
                }
            }
        }
    }
}
