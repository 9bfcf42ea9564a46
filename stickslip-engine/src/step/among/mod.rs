//! A step of one of several ranks: what it sends to others, and takes from them.

mod carrying;
mod filling;
mod kinds;
mod loads;
mod taking_up;
mod totals;

pub(super) use carrying::Look;
pub(super) use filling::{SharedOut, Walked, share_out, walk, walk_together};
pub(super) use kinds::Kinds;
pub(crate) use taking_up::Find;

use self::loads::LeavingPoints;
use super::Engine;
use super::walls::WallBooks;
use crate::body::Body;
use crate::boundary::Wall;
use crate::contact::BlockSums;
use crate::door::RankShare;
use crate::exact::ExactSum;
use crate::grid::{
    ActiveBlocks, Blocks, Border, Cut, Disjoint, ForeignTile, Mirrors, Node, NodeSums, Tile, Traffic, add_at,
    add_corner, count_at, locate, nodes_at, nodes_per_block, window_side,
};
use crate::lanes::Laned;
use crate::material::Material;
use crate::particles::{Particles, Shown, number_of, write_number};
use crate::pass::FaultReport;
use crate::ranks::{
    BlockLoad, Message, Partition, Ranks, SentAndWaited, add_up_each, added, bytes_of, combined, gathered,
    largest, message_to, read, told_first,
};
use crate::scene::{self, BodyMotion, Face, Load, NamedMaterial, OutsideValue, Problem, Scene};
use crate::tensor::Real;
use crate::threads::each_range;
use crate::transfer::Share;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

/// What one of several ranks knows of the others.
pub(super) struct Among<T> {
    /// The ranks.
    pub ranks: Arc<dyn Ranks>,
    /// Who owns which block.
    partition: Partition,
    /// Where each body began.
    homes: Vec<Home>,
    /// The tiles that others have named, as they came.
    named: Vec<Message>,
    /// Passes over particles in the step so far.
    passes: u32,
    /// What is wrong with a particle of this rank in the step, and in which pass that was found.
    fault: Option<(u32, FaultReport)>,
    /// What names the tiles of this rank to others.
    names: Vec<Message>,
    /// Windows of tiles that are kept, and behind them those of foreign tiles.
    windows: Vec<NodeSums<T>>,
    /// Steps in which this rank did its part, the time in which it computed there [s], and what it sent.
    worked: Worked,
    /// What it computed in each step since the loads were compared last, without those in which particles move house
    /// [s].
    computed: Vec<f64>,
    /// Whether they do in this step.
    moves: bool,
    /// Steps that ranks lost by waiting for the one that computes longest, since it was last tried to share blocks out
    /// anew, and how many may be lost before it is tried again.
    lost: f64,
    bears: f64,
}

/// Where a body began.
#[derive(Clone, Copy, Debug)]
pub(super) struct Home {
    /// The rank that had its first particle; the first one, if it had none.
    pub rank: u32,
    /// How many particles it had: one without bounds counts as larger than all others.
    pub particles: usize,
}

/// What a rank did.
#[derive(Clone, Copy, Debug, Default)]
struct Worked {
    steps: u64,
    computed: f64,
    traffic: SentAndWaited,
}

/// Steps from one comparison of loads to the next.
const COMPARED_EVERY: usize = 16;
/// Steps that ranks may lose by waiting for the one that computes longest, before blocks are shared out anew: to move
/// particles costs about as much.
const LOST_AT_MOST: f64 = 0.5;
/// So many they may lose at most where it was tried in vain.
const MOST_BORNE: f64 = 100.0;
/// Another partition must lighten the rank that has most by so much.
const LIGHTER: f64 = 0.99;

impl Home {
    /// That of a body which began there with so many particles, none if it has no bounds.
    pub fn new(rank: usize, particles: usize) -> Self {
        Home { rank: rank as u32, particles: if particles == 0 { usize::MAX } else { particles } }
    }
}

/// Shares whole bodies out, those of these numbers: the largest first, each to the rank that has least.
fn share_out_bodies(homes: &mut [Home], mut whole: Vec<usize>, ranks: usize) {
    let mut given = vec![0_usize; ranks];
    whole.sort_by_key(|&body| (std::cmp::Reverse(homes[body].particles), body));
    for body in whole {
        let rank = (0..ranks).min_by_key(|&rank| given[rank]).expect("there is a rank");
        given[rank] += homes[body].particles;
        homes[body].rank = rank as u32;
    }
}

impl<T: Real> Among<T> {
    /// Room for the windows of all tiles that are kept or come, so many nodes each.
    pub fn take_room(&mut self, border: Option<&Border>, nodes: usize) -> Vec<NodeSums<T>> {
        let mut windows = std::mem::take(&mut self.windows);
        let count = border.map_or(0, |border| border.kept.len() + border.foreign.len());
        windows.resize(count * nodes, NodeSums::default());
        windows
    }

    /// The windows that others wait for.
    ///
    /// # Safety
    /// Nobody may write to the windows meanwhile.
    pub unsafe fn windows_for_others<const D: usize>(
        border: &Border,
        (windows, share): (&Disjoint<NodeSums<T>>, Share),
        side: usize,
    ) -> Vec<Message> {
        let given = given::<D>(share);
        let message = |traffic: &Traffic| {
            let mut message = Vec::with_capacity(traffic.nodes::<D>(side) * given.len() * size_of::<T>());
            for sent in &traffic.windows {
                let first = sent.place as usize * side.pow(D as u32);
                for node in sent.nodes::<D>(side) {
                    // SAFETY: the caller's.
                    let sums = unsafe { windows.read(first + node) }.as_flattened();
                    given.iter().for_each(|&i| write_number(sums[i], &mut message));
                }
            }
            (traffic.rank, message)
        };
        border.outgoing.iter().map(message).collect()
    }

    /// Takes the windows of others, and adds those of all to the slots at the border.
    pub fn add_windows<const D: usize>(
        &mut self,
        (border, windows, came): (&Border, Vec<NodeSums<T>>, Vec<Message>),
        (nodes, share): (&Disjoint<Node<T, D>>, Share),
        side: usize,
    ) {
        self.windows = windows;
        let each_window = side.pow(D as u32);
        let given = given::<D>(share);
        let each_node = given.len() * size_of::<T>();
        // Of each foreign tile what came of each of its blocks, and how much of that it is.
        let nothing: ([&[u8]; 8], [Cut; 8]) = ([&[]; 8], [0; 8]);
        let mut parts = vec![nothing; border.foreign.len()];
        for ((from, message), traffic) in came.iter().zip(&border.incoming) {
            assert_eq!(*from, traffic.rank, "who shares blocks sends windows");
            let mut rest = &message[..];
            for sent in &traffic.windows {
                let (parts, cuts) = &mut parts[sent.place as usize];
                *cuts = sent.cuts;
                for corner in (0..1_usize << D).filter(|corner| sent.corners >> corner & 1 == 1) {
                    let count = count_at::<D>(corner, cuts[corner], side);
                    (parts[corner], rest) = rest.split_at(count * each_node);
                }
            }
            assert!(rest.is_empty(), "ranks agree on what they share");
        }
        let (windows, kept) = (&self.windows, border.kept.len());
        let add_foreign = |(slot, corner): (u32, u8), (bytes, cut): (&[u8], Cut)| {
            let places = nodes_at::<D>(usize::from(corner), cut, side);
            for (place, bytes) in places.zip(bytes.chunks_exact(each_node)) {
                let mut sums = NodeSums::default();
                let numbers = bytes.chunks_exact(size_of::<T>()).map(number_of);
                given.iter().zip(numbers).for_each(|(&i, x)| sums.as_flattened_mut()[i] = x);
                // SAFETY: each slot is in the list once, and the pass is over.
                unsafe { add_at(&sums, nodes, (slot, corner), (place, side)) };
            }
        };
        each_range(border.slots.len(), SLOTS, &|range| {
            for slot in &border.slots[range] {
                for giver in &border.givers[slot.givers.clone()] {
                    let part = (slot.slot, giver.corner);
                    match (giver.window as usize).checked_sub(kept) {
                        Some(foreign) => {
                            let (parts, cuts) = &parts[foreign];
                            let corner = usize::from(giver.corner);
                            add_foreign(part, (parts[corner], cuts[corner]));
                        }
                        None => {
                            let window = &windows[giver.window as usize * each_window..][..each_window];
                            // SAFETY: as above.
                            unsafe { add_corner(window, nodes, part, side) };
                        }
                    }
                }
            }
        });
    }
}

/// What stands at a node of a window of those numbers: momentum and force along each axis, and mass.
fn given<const D: usize>(share: Share) -> Vec<usize> {
    let momentum = (0..D).map(|axis| 2 * axis).filter(|_| share.has_momentum());
    let force = (0..D).map(|axis| 2 * axis + 1).filter(|_| share.has_force());
    momentum.chain(force).chain(share.has_mass().then_some(6)).collect()
}

impl<T: Laned> Among<T> {
    /// Whether a block belongs to another rank since blocks were shared out anew in this step.
    pub fn has_lost<const D: usize>(&self, block: [i32; D]) -> bool {
        self.moves && self.partition.owner(block) != self.ranks.rank()
    }

    /// Begins a step, and says when.
    pub fn begin(&mut self) -> (Instant, SentAndWaited) {
        (self.passes, self.fault) = (0, None);
        (Instant::now(), self.ranks.traffic())
    }

    /// Ends a step that began then.
    pub fn end(&mut self, (begun, before): (Instant, SentAndWaited)) {
        let now = self.ranks.traffic().since(before);
        let Worked { steps, computed, traffic } = self.worked;
        let own = begun.elapsed().as_secs_f64() - now.waited;
        self.worked = Worked { steps: steps + 1, computed: computed + own, traffic: traffic.and(now) };
        if !std::mem::take(&mut self.moves) {
            self.computed.push(own);
        }
    }

    /// What this rank did, and has: so many particles.
    pub fn share(&self, particles: usize) -> RankShare {
        let Worked { steps, computed, traffic } = self.worked;
        RankShare { particles, steps, computed, traffic }
    }

    /// Takes note of what a pass found, the first fault of it by body and particle: all ranks make as many passes.
    pub fn take_note(&mut self, fault: Option<FaultReport>) {
        self.passes += 1;
        if self.fault.is_none() {
            self.fault = fault.map(|fault| (self.passes, fault));
        }
    }

    /// What this rank found first in the step, and in which pass.
    pub fn fault(&mut self) -> Option<(u32, FaultReport)> {
        self.fault.take()
    }

    /// Whether this rank keeps the sums of a pair of bodies: that of the smaller one does.
    pub fn keeps(&self, bodies: [usize; 2]) -> bool {
        self.keeper(bodies) == self.ranks.rank()
    }

    fn keeper(&self, bodies: [usize; 2]) -> usize {
        let [a, b] = bodies.map(|body| self.homes[body]);
        let home = if b.particles < a.particles { b } else { a };
        home.rank as usize
    }

    /// Leaves what pairs did in the uses of contact to those who keep their sums, ordered by pair and block.
    pub fn send_to_keepers(&self, touches: &mut [Vec<BlockSums>; 3]) {
        if self.homes.len() < 2 {
            return;
        }
        let mut others: BTreeMap<usize, Vec<(u8, BlockSums)>> = BTreeMap::new();
        for (number, touches) in (0..).zip(touches.iter_mut()) {
            touches.retain(|touch| {
                let keeper = self.keeper(touch.bodies);
                let here = keeper == self.ranks.rank();
                if !here {
                    others.entry(keeper).or_default().push((number, *touch));
                }
                here
            });
        }
        let messages = others.iter().map(|(rank, touches)| (*rank, bytes_of(touches))).collect();
        for (_, message) in self.ranks.exchange(messages) {
            for (number, touch) in read::<Vec<(u8, BlockSums)>>(&message) {
                touches[usize::from(number)].push(touch);
            }
        }
        touches.iter_mut().for_each(|touches| touches.sort_unstable_by_key(BlockSums::rank));
    }

    /// What each rank says, by rank.
    pub fn gathered<X: Serialize + DeserializeOwned>(&self, said: &X) -> Vec<X> {
        gathered(&*self.ranks, said)
    }

    /// Adds what bodies did to faces on other ranks.
    pub fn gather_walls(&self, booked: &mut WallBooks) {
        let places: Vec<usize> = booked.keys().copied().collect();
        // All ranks add up the same pairs.
        for place in self.gathered(&places).into_iter().flatten() {
            booked.entry(place).or_default();
        }
        self.add_up(booked.values_mut().flatten());
    }

    pub fn add_up<'a>(&self, sums: impl Iterator<Item = &'a mut ExactSum>) {
        add_up_each(&*self.ranks, sums);
    }
}

/// Slots that a thread takes at a time.
const SLOTS: usize = 8;

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Becomes one of several ranks, with its particles in its share of the blocks.
    pub(super) fn join(&mut self, ranks: Arc<dyn Ranks>, (partition, homes): (Partition, Vec<Home>)) {
        self.among = Some(Among {
            ranks,
            partition,
            homes,
            named: Vec::new(),
            passes: 0,
            fault: None,
            names: Vec::new(),
            windows: Vec::new(),
            worked: Worked::default(),
            computed: Vec::new(),
            moves: true,
            lost: 0.0,
            bears: LOST_AT_MOST,
        });
        self.watch_borders();
    }

    /// Name of a body, which may be elsewhere.
    pub(super) fn name_of(&self, body: usize) -> &str {
        match &self.kinds {
            Some(kinds) => &kinds.scene.bodies[body].name,
            None => &self.state.bodies[body].name,
        }
    }

    /// Gives a body all that belongs to it, if something of it comes here.
    pub(super) fn bring(&mut self, body: usize) -> &mut Body<T, D> {
        let here = &mut self.state.bodies[body];
        self.kinds.iter().for_each(|kinds| kinds.bring(here, body));
        here
    }

    /// A body with all that belongs to it, wherever it is.
    pub(super) fn brought<'a>(&self, body: &'a Body<T, D>, number: usize) -> Cow<'a, Body<T, D>> {
        match (body, &self.kinds) {
            (Body::Elsewhere(_), Some(kinds)) => {
                let mut body = body.clone();
                kinds.bring(&mut body, number);
                Cow::Owned(body)
            }
            _ => Cow::Borrowed(body),
        }
    }

    /// Keeps next to nothing of a body of which nothing is here.
    pub(super) fn let_go(&mut self, body: usize) {
        self.kinds.iter().for_each(|kinds| kinds.let_go(&mut self.state.bodies[body], body));
    }

    /// The blocks that any rank names, and this rank's among them, sorted.
    pub(super) fn blocks_of_all(&self, own: Vec<[i32; D]>) -> Vec<[i32; D]> {
        let Some(among) = &self.among else { return own };
        let said: Vec<i32> = own.into_iter().flatten().collect();
        let all = among.gathered(&said).concat();
        let mut all = all.as_chunks().0.to_vec();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Whether something is so on any rank.
    pub(super) fn on_any_rank(&self, here: bool) -> bool {
        self.among.as_ref().map_or(here, |among| largest(&*among.ranks, f64::from(u8::from(here))) > 0.0)
    }

    /// What each rank says, for the first; what this one says, where there are no others.
    pub(super) fn told_first<X: Serialize + DeserializeOwned>(&self, said: X) -> Vec<X> {
        let Some(among) = &self.among else { return vec![said] };
        told_first(&*among.ranks, &said)
    }

    /// What the first rank says; what this one says, where there are no others.
    pub(super) fn first_says<X: Serialize + DeserializeOwned>(&self, said: X) -> X {
        let Some(among) = &self.among else { return said };
        read(&among.ranks.hear_first(&bytes_of(&said)))
    }

    /// How many particles each body has on all ranks.
    pub(super) fn counts_of_all(&self) -> Vec<usize> {
        let own: Vec<usize> = self.state.bodies.iter().map(|body| body.particles.len()).collect();
        let Some(among) = &self.among else { return own };
        combined(&*among.ranks, &own, added)
    }

    /// Which particles of a body are not in this rank's share, by their places in memory.
    pub(super) fn of_other_ranks(&self, body: usize, particles: &Particles<T, D>) -> Vec<u32> {
        let Some(among) = &self.among else { return Vec::new() };
        let abroad =
            |&particle: &u32| self.owner_of((body, particles), particle as usize) != among.ranks.rank();
        (0..particles.len() as u32).filter(abroad).collect()
    }

    /// The rank that owns a particle: that of its block, or of its whole body where that has a grid of its own.
    fn owner_of(&self, (body, particles): (usize, &Particles<T, D>), particle: usize) -> usize {
        let owner = |among: &Among<T>| match self.reference_of(body) {
            Some(_) => among.homes[body].rank as usize,
            None => among.partition.owner(self.block_of(particles, particle)),
        };
        self.among.as_ref().map_or(0, owner)
    }

    /// The home block of a particle, in the first period.
    fn block_of(&self, particles: &Particles<T, D>, particle: usize) -> [i32; D] {
        let lattice = &self.settings.lattice;
        lattice.periods.wrapped(locate((self.kernels.home)(lattice, particles.place(particle))).0)
    }

    /// Lets the blocks know that there are other ranks.
    pub(super) fn watch_borders(&mut self) {
        if self.among.is_some() {
            let mirror = |wall: &Wall| (wall.face == Face::Symmetry).then_some((wall.axis, wall.node));
            let mirrors = Mirrors { faces: self.settings.walls.iter().filter_map(mirror).collect() };
            self.workspace.active = ActiveBlocks::new(self.settings.lattice.periods).among_ranks(mirrors);
        }
    }

    /// Gives ranks that computed less than others more blocks, by the time that they took. Which rank has a block
    /// changes no bit.
    pub(super) fn rebalance(&mut self) {
        let Some(among) = &mut self.among else { return };
        if !self.workspace.listed || among.computed.len() < COMPARED_EVERY {
            return;
        }
        // The median: whatever else a machine does slows down some steps only.
        among.computed.sort_unstable_by(f64::total_cmp);
        let computed = among.computed[among.computed.len() / 2];
        among.computed.clear();
        let particles: usize = self.state.bodies.iter().map(|body| body.particles.len()).sum();
        let all = among.gathered(&(computed, particles));
        let whole: f64 = all.iter().map(|(computed, _)| computed).sum();
        let most = all.iter().map(|(computed, _)| *computed).fold(0.0, f64::max);
        among.lost += COMPARED_EVERY as f64 * (most * all.len() as f64 / whole - 1.0);
        if among.lost <= among.bears {
            return;
        }
        among.lost = 0.0;
        // What a rank does whatever it has stands on its particles, too: they count within bounds.
        let mean = whole / all.iter().map(|(_, particles)| *particles as f64).sum::<f64>();
        let own = (computed / particles.max(1) as f64 / mean).clamp(0.5, 2.0);
        let active = &self.workspace.active;
        let load = |tile: &Tile<D>| {
            let cells = active.cells_of(tile);
            let count = f64::from(cells[cells.len() - 1] - cells[0]);
            let block = self.settings.lattice.periods.wrapped(tile.block);
            BlockLoad::new(block, (100.0 * own * count).ceil() as u64, active.meets(tile))
        };
        let loads: Vec<BlockLoad> = active.tiles.iter().map(load).collect();
        let next = Partition::among_ranks::<D>(&*among.ranks, Some(&among.partition), loads.clone());
        let heaviest = |partition: &Partition| {
            let mut of_ranks = vec![0_u64; all.len()];
            for BlockLoad { block, load, .. } in &loads {
                of_ranks[partition.owner::<D>(std::array::from_fn(|k| block[k]))] += load;
            }
            combined(&*among.ranks, &of_ranks, added).into_iter().max().unwrap_or(0) as f64
        };
        let lightens = heaviest(&next) < LIGHTER * heaviest(&among.partition);
        // Where there is nothing to gain, it is not tried all the time.
        among.bears = if lightens { LOST_AT_MOST } else { (2.0 * among.bears).min(MOST_BORNE) };
        if lightens {
            among.partition = next;
            among.moves = true;
            among.named.clear();
            self.workspace.active.forget_owners();
        }
    }

    /// Lets particles move to the ranks that own their blocks, and says whether the blocks under those that are here
    /// are others than before.
    pub(super) fn cross_borders(&mut self) -> Blocks {
        let among = self.among.take().expect("there are other ranks");
        let rank = among.ranks.rank();
        let lattice = self.settings.lattice;
        let abroad = |block: [i32; D]| Some(among.partition.owner(block)).filter(|&owner| owner != rank);
        let gone = self.workspace.active.emigrants(abroad);
        let mut messages: Vec<Message> = Vec::new();
        let mut points = LeavingPoints::new();
        for of_body in gone.chunk_by(|a, b| a.body == b.body) {
            let body = of_body[0].body;
            let leavers = of_body.iter().map(|one| (one.rank, one.particle));
            self.take_points_out(body, leavers, &mut points);
            let particles = &mut self.state.bodies[body].particles;
            let mut by_rank: Vec<(usize, u32)> = of_body.iter().map(|one| (one.rank, one.particle)).collect();
            by_rank.sort_unstable();
            write_particles((body, particles), &by_rank, &mut messages);
            let places: Vec<u32> = of_body.iter().map(|one| one.particle).collect();
            let moves = particles.take_out(&places);
            if particles.is_empty() {
                particles.fit();
            }
            self.workspace.disorder.get_mut(body).into_iter().for_each(|disorder| disorder.add(moves.len()));
            let base = |particle: usize| (self.kernels.home)(&lattice, particles.place(particle));
            self.workspace.active.renumber(body, &moves, base);
            self.workspace.loads.follow(&self.settings.loads, (body, &moves));
        }
        for (_, message) in among.ranks.exchange(messages) {
            let Self { state, workspace, kinds, .. } = self;
            read_particles(&message, (&mut state.bodies, kinds.as_ref()), &mut |body, first, particles| {
                let count = particles.len() - first;
                workspace.disorder.get_mut(body).into_iter().for_each(|disorder| disorder.add(count));
                let base = |particle: usize| (self.kernels.home)(&lattice, particles.place(particle));
                let number = |particle: usize| particles.numbers()[particle];
                workspace.active.arrive((body, first..particles.len()), (base, number));
            });
        }
        self.take_points_in(&*among.ranks, &points);
        self.among = Some(among);
        let bodies = &self.state.bodies;
        self.workspace.active.settle(|body, particle| bodies[body].particles.numbers()[particle])
    }

    /// Covers the blocks of the particles that are here, which may be others than before, and those that other ranks
    /// have beside them.
    pub(super) fn cover_blocks(&mut self, blocks: Blocks) -> Blocks {
        let mut among = self.among.take().expect("there are other ranks");
        let rank = among.ranks.rank();
        let own = blocks == Blocks::New || !self.workspace.listed || among.moves;
        if own {
            among.names = self.workspace.active.named(rank, |block| among.partition.owner(block));
        }
        let named = among.ranks.exchange(among.names.clone());
        let changed = own || named != among.named;
        if changed {
            let tiles = named.iter().flat_map(|(from, names)| ForeignTile::read(*from, names));
            let tiles: Vec<ForeignTile> = tiles.collect();
            self.workspace.active.cover(&tiles, rank);
            // Surfaces of bodies are known wherever they have nodes.
            for tile in &tiles {
                self.bring(tile.body as usize);
            }
            if among.moves {
                let gone = (0..self.state.bodies.len() as u32)
                    .filter(|body| self.workspace.active.here().binary_search(body).is_err());
                gone.collect::<Vec<_>>().into_iter().for_each(|body| self.let_go(body as usize));
            }
            among.named = named;
        }
        self.among = Some(among);
        if changed { Blocks::New } else { Blocks::Same }
    }

    /// Sends the guests of the step before away.
    pub(super) fn dismiss_guests(&mut self) {
        for host in self.workspace.active.dismiss_guests() {
            // One that lost its particles with them may have gone.
            let host = self.state.bodies[host as usize].here_mut();
            host.into_iter().for_each(|body| body.particles.dismiss_guests());
        }
    }

    /// What contact looks at of particles, where it knows how long they still move before it acts on them or not.
    pub(super) fn guests_show(&self, knows_when: bool) -> Shown {
        if knows_when && self.settings.rules.judge_by_place() { Shown::Places } else { Shown::Everything }
    }

    /// Shows particles around nodes where bodies meet to the other ranks that have these nodes, as their guests.
    pub(super) fn invite_guests(&mut self, shown: Shown) {
        let Some(among) = self.among.as_ref().filter(|_| self.state.bodies.len() > 1) else { return };
        let (active, present) = (&self.workspace.active, &self.workspace.field.present);
        let Some(border) = active.border.as_deref() else { return };
        let mut guests = Vec::new();
        let message = |traffic: &Traffic| {
            let mut message = Vec::new();
            for (tile, seen) in active.seen_by(traffic, present, window_side(self.kernels.width)) {
                let cells = active.cells_of(tile);
                message.extend_from_slice(&(tile.body as u32).to_le_bytes());
                message.extend_from_slice(&active.home_of(tile).to_le_bytes());
                guests.clear();
                for (cell, ends) in cells.windows(2).enumerate() {
                    let here = if seen >> cell & 1 == 1 { ends[0]..ends[1] } else { 0..0 };
                    message.extend_from_slice(&(here.end - here.start).to_le_bytes());
                    guests.extend_from_slice(
                        &active.order_of(tile.body)[here.start as usize..here.end as usize],
                    );
                }
                self.state.bodies[tile.body].particles.write_guests(&guests, shown, &mut message);
            }
            (traffic.rank, message)
        };
        let messages = border.outgoing.iter().map(message).collect();
        let from: Vec<usize> = border.incoming.iter().map(|traffic| traffic.rank).collect();
        let came = among.ranks.exchange_during(messages, &from, &mut || ());
        let n = nodes_per_block(D);
        // Body, home, particles in each cell, their bytes.
        let mut tiles: Vec<(usize, u64, Vec<usize>, &[u8])> = Vec::new();
        for (_, message) in &came {
            let mut rest = &message[..];
            while let Some((body, after)) = split_number(rest)
                && let Some((home, mut after)) = after.split_first_chunk()
            {
                let mut counts = Vec::with_capacity(n);
                for _ in 0..n {
                    let (count, others) = split_number(after).expect("a count for each cell");
                    counts.push(count);
                    after = others;
                }
                let count = counts.iter().sum::<usize>();
                let (bytes, others) =
                    after.split_at(self.state.bodies[body].particles.bytes_of_guests(count, shown));
                tiles.push((body, u64::from_le_bytes(*home), counts, bytes));
                rest = others;
            }
        }
        tiles.sort_unstable_by_key(|&(body, home, ..)| (body, home));
        for (body, home, counts, bytes) in tiles {
            let particles = &mut self.state.bodies[body].particles;
            let first = particles.len() + particles.guests();
            particles.receive_guests(bytes, counts.iter().sum(), shown);
            self.workspace.active.invite((body, home), first, counts.into_iter());
        }
    }
}

/// Writes particles of a body, by their places and ordered by the ranks to which they go, behind the messages to these.
fn write_particles<T: Real, const D: usize>(
    (body, particles): (usize, &Particles<T, D>),
    by_rank: &[(usize, u32)],
    messages: &mut Vec<Message>,
) {
    for some in by_rank.chunk_by(|a, b| a.0 == b.0) {
        let message = message_to(messages, some[0].0);
        message.extend((body as u32).to_le_bytes());
        message.extend((some.len() as u32).to_le_bytes());
        let some: Vec<u32> = some.iter().map(|&(_, particle)| particle).collect();
        particles.write_particles(&some, message);
    }
}

/// Takes in the particles of a message; `arrived` gets the body, the place of the first of them, and all that the body
/// has.
fn read_particles<T: Real, const D: usize>(
    message: &[u8],
    (bodies, kinds): (&mut [Body<T, D>], Option<&Kinds<T, D>>),
    arrived: &mut dyn FnMut(usize, usize, &Particles<T, D>),
) {
    let mut rest = message;
    while let Some((body, after)) = split_number(rest)
        && let Some((count, after)) = split_number(after)
    {
        kinds.into_iter().for_each(|kinds| kinds.bring(&mut bodies[body], body));
        let particles = &mut bodies[body].particles;
        let (bytes, after) = after.split_at(particles.message_bytes(count));
        let first = particles.len();
        particles.take_in(bytes, count);
        arrived(body, first, particles);
        rest = after;
    }
}

/// Refuses what ranks cannot share yet.
pub(super) fn can_be_shared(scene: &Scene) -> Result<(), Problem> {
    let over_arrays = |material: &NamedMaterial| match material.law {
        Material::Custom(custom) => custom.law().over_arrays().is_some(),
        _ => false,
    };
    let moves_by_function = |body: &scene::Body| match &body.motion {
        BodyMotion::Rigid { velocity, spin } => {
            velocity.iter().chain(spin.iter()).any(|of| of.outside().is_some())
        }
        _ => false,
    };
    let by_function = |load: &Load| load.action.outside().and_then(OutsideValue::function).is_some();
    let refused = [
        ("bodies.rigid", "a function from outside", scene.bodies.iter().any(moves_by_function)),
        ("loads", "a function from outside", scene.loads.iter().any(by_function)),
        ("materials", "a law over arrays", scene.materials.iter().any(over_arrays)),
    ];
    let found = refused.into_iter().find(|(.., is_there)| *is_there);
    found.map_or(Ok(()), |(key, found, _)| {
        Err(Problem {
            key: key.to_string(),
            found: found.to_string(),
            allowed: "what several ranks can share".to_string(),
            help: Some("simulate it by one rank".to_string()),
        })
    })
}

/// A number of four bytes at the front, and what is behind it.
fn split_number(bytes: &[u8]) -> Option<(usize, &[u8])> {
    let (number, rest) = bytes.split_first_chunk()?;
    Some((u32::from_le_bytes(*number) as usize, rest))
}
