//! A saved state, which ranks take up: each some of its particles, which then go to those that own their blocks.

use super::{Home, read_particles, share_out_bodies, walk, write_particles};
use crate::door::{NotTakenUp, RestoreError, SavedShare, SavedState};
use crate::lanes::Laned;
use crate::ranks::{Census, Message, Ranks, combined, gathered, message_to};
use crate::scene::Scene;
use crate::step::Engine;
use crate::step::build::loads;
use crate::step::saving::{append, began_at};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Finds the shares of a saved state that a rank takes up, and shows them one after the other.
pub(crate) type Find<'a> = &'a mut dyn FnMut(&mut dyn FnMut(Vec<SavedShare>)) -> Result<(), String>;

/// Particles that a rank sends and takes at a time.
const AT_A_TIME: usize = 1 << 16;

/// Of a body, its particles on a rank: how many, a sum over their numbers, and the smallest number with its particle's
/// block.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Found {
    count: u64,
    mixed: u64,
    first: Option<(u32, Vec<i32>)>,
}

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Takes up a state, of which `find` gives this rank some particles, as one of several ranks; before, it has no
    /// particles.
    ///
    /// # Errors
    /// It is of another scene, or a rank does not find what it should; then all ranks say so.
    pub(in crate::step) fn take_up_among(
        &mut self,
        (scene, ranks): (&Arc<Scene>, Arc<dyn Ranks>),
        rest: &SavedState,
        find: Find,
    ) -> Result<(), NotTakenUp> {
        // All ranks have the same of it, and find the same wrong with it.
        self.check_rest(rest)?;
        let mut taken = Ok(());
        let found = find(&mut |shares| {
            for share in shares {
                let appended = match share.body < self.state.bodies.len() {
                    false => Err(RestoreError("it has more bodies than the scene".to_string())),
                    true => {
                        let body = &mut **self.bring(share.body);
                        append(&body.name, &mut body.particles, &share)
                    }
                };
                taken = std::mem::replace(&mut taken, Ok(())).and(appended);
            }
        });
        let own = found.map_err(NotTakenUp::Unfound).and(taken.map_err(NotTakenUp::from));
        first_problem(&*ranks, own)?;

        let (census, of_bodies) = self.counted(&*ranks);
        let missing: Vec<usize> = rest.bodies.iter().map(|saved| saved.missing).collect();
        self.check_numbers(&*ranks, (&of_bodies, &missing))?;
        self.join_others(ranks.clone(), (census, of_bodies));
        self.send_home();
        self.settings.loads = loads(scene, (&self.state.bodies, &self.settings.filled), true);
        self.take_up_rest(rest.clone());
        let among = self.among.as_ref().expect("it has joined the others");
        self.state.contact_sums.keep(|bodies| among.keeps(bodies));
        first_problem(&*ranks, self.check_starts(scene).map_err(NotTakenUp::from))
    }

    /// In which blocks particles are, of which all ranks have some, and what there is of each body.
    pub(super) fn counted(&self, ranks: &dyn Ranks) -> (Census<D>, Vec<Found>) {
        let mut census = Census::new(self.settings.lattice.periods);
        let mut of_bodies = Vec::new();
        for (i, body) in self.state.bodies.iter().enumerate() {
            let particles = &body.particles;
            let blocks = (0..particles.len()).map(|particle| self.block_of(particles, particle));
            blocks.for_each(|block| census.count(i, block));
            let first = (particles.numbers().iter().zip(0..)).min();
            let first = first.map(|(&number, place)| (number, self.block_of(particles, place).to_vec()));
            let mixed =
                particles.numbers().iter().fold(0, |sum: u64, number| sum.wrapping_add(mixed(*number)));
            of_bodies.push(Found { count: particles.len() as u64, mixed, first });
        }
        let of_bodies = combined(ranks, &of_bodies, |mut all: Vec<Found>, others| {
            for (one, other) in all.iter_mut().zip(others) {
                one.count += other.count;
                one.mixed = one.mixed.wrapping_add(other.mixed);
                one.first = one.first.take().into_iter().chain(other.first).min();
            }
            all
        });
        (census, of_bodies)
    }

    /// Shares blocks out by where all particles are, which are not yet with the ranks that own them.
    pub(super) fn join_others(
        &mut self,
        ranks: Arc<dyn Ranks>,
        (census, of_bodies): (Census<D>, Vec<Found>),
    ) {
        let block = |at: &[i32]| std::array::from_fn(|k| at[k]);
        let partition = census.of_all(&*ranks).partition(&*ranks);
        let home = |(body, &filled): (Found, &usize)| {
            let rank =
                body.first.filter(|_| filled > 0).map_or(0, |(_, at)| partition.owner::<D>(block(&at)));
            Home::new(rank, filled)
        };
        let mut homes: Vec<Home> = of_bodies.into_iter().zip(&self.settings.filled).map(home).collect();
        let whole = self.settings.references.iter().map(|reference| reference.body);
        share_out_bodies(&mut homes, whole.collect(), ranks.count());
        self.join(ranks, (partition, homes));
    }

    /// Looks whether each body has as many particles as the scene, but for so many that have gone, each once.
    ///
    /// # Errors
    /// One has not: all ranks say so.
    pub(super) fn check_numbers(
        &self,
        ranks: &dyn Ranks,
        (of_bodies, missing): (&[Found], &[usize]),
    ) -> Result<(), NotTakenUp> {
        for (i, (&filled, (found, &missing))) in
            self.settings.filled.iter().zip(of_bodies.iter().zip(missing)).enumerate()
        {
            let (name, count) = (self.name_of(i), found.count as usize);
            if filled > 0 && count.checked_add(missing) != Some(filled) {
                let off = format!("body `{name}` has {filled} particles in the scene, and {count} in it");
                return Err(RestoreError(off).into());
            }
            let each_once = || (0..filled as u32).fold(0, |sum: u64, number| sum.wrapping_add(mixed(number)));
            if filled > 0 && missing == 0 && found.mixed != each_once() {
                return Err(
                    RestoreError(format!("body `{name}` has particles that are numbered twice")).into()
                );
            }
        }
        first_problem(ranks, self.find_twins(ranks, missing).map_err(NotTakenUp::from))
    }

    /// Looks for particles that are numbered twice on different ranks, of bodies of which it is not known which numbers
    /// there must be: each rank sees to some numbers.
    fn find_twins(&self, ranks: &dyn Ranks, missing: &[usize]) -> Result<(), RestoreError> {
        let mut messages: Vec<Message> = Vec::new();
        let mut seen: Vec<[u32; 2]> = Vec::new();
        let some = self.state.bodies.iter().zip(&self.settings.filled).zip(missing).zip(0..);
        for (((body, &filled), &missing), i) in some {
            let numbers = body.particles.numbers().iter().filter(|_| filled == 0 || missing > 0);
            for &number in numbers {
                match number as usize % ranks.count() {
                    rank if rank == ranks.rank() => seen.push([i, number]),
                    rank => message_to(&mut messages, rank)
                        .extend([i, number].map(u32::to_le_bytes).as_flattened()),
                }
            }
        }
        for (_, message) in ranks.exchange(messages) {
            let (numbers, _) = message.as_chunks();
            seen.extend(numbers.as_chunks().0.iter().map(|two: &[[u8; 4]; 2]| two.map(u32::from_le_bytes)));
        }
        seen.sort_unstable();
        let Some(twins) = seen.windows(2).find(|two| two[0] == two[1]) else { return Ok(()) };
        let name = self.name_of(twins[0][0] as usize);
        Err(RestoreError(format!("body `{name}` has particles that are numbered twice")))
    }

    /// Sends all particles to the ranks that own their blocks, some at a time.
    pub(super) fn send_home(&mut self) {
        let ranks = self.among.as_ref().expect("it has joined the others").ranks.clone();
        let at_a_time = (AT_A_TIME / ranks.count()).max(256);
        loop {
            let mut messages: Vec<Message> = Vec::new();
            let mut room = vec![at_a_time; ranks.count()];
            for body in 0..self.state.bodies.len() {
                let particles = &self.state.bodies[body].particles;
                let mut gone: Vec<(usize, u32)> = Vec::new();
                for particle in self.of_other_ranks(body, particles) {
                    let owner = self.owner_of((body, particles), particle as usize);
                    if room[owner] > 0 {
                        room[owner] -= 1;
                        gone.push((owner, particle));
                    }
                }
                let places: Vec<u32> = gone.iter().map(|&(_, particle)| particle).collect();
                gone.sort_unstable();
                write_particles((body, particles), &gone, &mut messages);
                if !places.is_empty() {
                    self.state.bodies[body].particles.take_out(&places);
                }
            }
            let some = !messages.is_empty();
            let kinds = self.kinds.as_ref();
            for (_, message) in ranks.exchange(messages) {
                read_particles(&message, (&mut self.state.bodies, kinds), &mut |_, _, _| ());
            }
            if !self.on_any_rank(some) {
                break;
            }
        }
        for body in 0..self.state.bodies.len() {
            self.state.bodies[body].here_mut().into_iter().for_each(|body| body.particles.fit());
            self.order_by_number(body);
            self.let_go(body);
        }
    }

    /// Looks whether particles began where the scene has them begin.
    fn check_starts(&self, scene: &Scene) -> Result<(), RestoreError> {
        for ((body, own), &filled) in scene.bodies.iter().zip(&self.state.bodies).zip(&self.settings.filled) {
            let is_known = filled > 0 && !own.particles.is_empty();
            if is_known && !began_at(&own.particles, walk(scene, body)) {
                return Err(RestoreError(format!(
                    "body `{}` began elsewhere than it does in the scene",
                    body.name
                )));
            }
        }
        Ok(())
    }
}

/// What is wrong on the first rank on which something is, for all.
pub(super) fn first_problem(ranks: &dyn Ranks, own: Result<(), NotTakenUp>) -> Result<(), NotTakenUp> {
    let all = gathered(ranks, &own.err());
    all.into_iter().flatten().next().map_or(Ok(()), Err)
}

/// A number whose sum over particles tells those with other numbers (the finalizer of SplitMix64, Steele et al. 2014).
fn mixed(number: u32) -> u64 {
    let mut x = u64::from(number).wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}
