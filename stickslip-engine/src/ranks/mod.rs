//! Ranks: processes that share a simulation, each with the particles in its blocks.
//!
//! A rank owns the blocks of a part of space. What it needs of others comes in messages: particles that move to its
//! blocks, the windows of tiles at blocks that it holds, and sums that everybody knows. Sums of particles at a node
//! follow the colours of tiles, and all others are exact: so any number of ranks gives the same bits as one.

mod partition;
mod threads;

pub(crate) use partition::{BlockLoad, Census, Partition};
pub use threads::Threads;

use crate::exact::ExactSum;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ops::AddAssign;

pub use crate::grid::{Message, message_to};

/// What all ranks say, joined two by two, for all of them. It must not matter who is joined with whom.
pub fn combined<X: Serialize + DeserializeOwned>(ranks: &dyn Ranks, said: &X, join: impl Fn(X, X) -> X) -> X {
    let join = |a: &[u8], b: &[u8]| bytes_of(&join(read(a), read(b)));
    read(&ranks.combine(bytes_of(said), &join))
}

/// Sums of what two say, place by place.
pub fn added<X: AddAssign>(mut all: Vec<X>, others: Vec<X>) -> Vec<X> {
    all.iter_mut().zip(others).for_each(|(sum, other)| *sum += other);
    all
}

/// Of what each rank has for some, what this one gets, its own first.
pub fn dealt<X: Serialize + DeserializeOwned>(
    ranks: &dyn Ranks,
    all: impl IntoIterator<Item = (usize, X)>,
) -> Vec<X> {
    let (mut here, mut others) = (Vec::new(), BTreeMap::<usize, Vec<X>>::new());
    for (rank, one) in all {
        if rank == ranks.rank() { &mut here } else { others.entry(rank).or_default() }.push(one);
    }
    let messages = others.iter().map(|(rank, some)| (*rank, bytes_of(some))).collect();
    for (_, message) in ranks.exchange(messages) {
        here.extend(read::<Vec<X>>(&message));
    }
    here
}

/// What each rank says, by rank.
pub fn gathered<X: Serialize + DeserializeOwned>(ranks: &dyn Ranks, said: &X) -> Vec<X> {
    all_of(ranks.gather(&bytes_of(said)))
}

/// Bytes of what ranks tell each other.
pub fn bytes_of(said: &impl Serialize) -> Vec<u8> {
    postcard::to_stdvec(said).expect("memory takes what is written")
}

/// What such bytes say.
pub fn read<X: DeserializeOwned>(bytes: &[u8]) -> X {
    postcard::from_bytes(bytes).expect("ranks run the same program")
}

/// What the bytes of each rank say.
pub fn all_of<X: DeserializeOwned>(said: Vec<Vec<u8>>) -> Vec<X> {
    // Each message goes as soon as it is read.
    said.into_iter().map(|said| read(&said)).collect()
}

/// What each rank says, by rank, on the first; on the others nothing.
pub fn told_first<X: Serialize + DeserializeOwned>(ranks: &dyn Ranks, said: &X) -> Vec<X> {
    all_of(ranks.tell_first(&bytes_of(said)))
}

/// What a rank sent to others, and how long it waited for them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SentAndWaited {
    /// Messages sent, what is said to all counted once.
    pub messages: u64,
    /// Their bytes.
    pub bytes: u64,
    /// Time in calls that wait for others [s].
    pub waited: f64,
}

impl SentAndWaited {
    /// What was since an earlier moment.
    pub fn since(self, before: SentAndWaited) -> Self {
        SentAndWaited {
            messages: self.messages - before.messages,
            bytes: self.bytes - before.bytes,
            waited: self.waited - before.waited,
        }
    }

    /// Both together.
    pub fn and(self, other: SentAndWaited) -> Self {
        SentAndWaited {
            messages: self.messages + other.messages,
            bytes: self.bytes + other.bytes,
            waited: self.waited + other.waited,
        }
    }
}

/// What a rank has of a simulation, and what it did for it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RankShare {
    /// Its particles now.
    pub particles: usize,
    /// Steps of which it did its part.
    pub steps: u64,
    /// Wall time in steps without waiting for other ranks [s].
    pub computed: f64,
    /// What it sent in steps, and how long it waited for others there.
    pub traffic: SentAndWaited,
}

impl RankShare {
    /// What it has, and what it did since `before`.
    pub fn since(self, before: RankShare) -> RankShare {
        RankShare {
            particles: self.particles,
            steps: self.steps - before.steps,
            computed: self.computed - before.computed,
            traffic: self.traffic.since(before.traffic),
        }
    }
}

/// Makes one message of two.
pub type Join<'a> = &'a dyn Fn(&[u8], &[u8]) -> Vec<u8>;

/// The ranks of a simulation, as one of them sees it. All of them make the same calls in the same order.
pub trait Ranks: Send + Sync {
    /// This one's number.
    fn rank(&self) -> usize;

    /// How many there are.
    fn count(&self) -> usize;

    /// Sends a message to each of some other ranks, and takes those that came, by rank.
    fn exchange(&self, messages: Vec<Message>) -> Vec<Message>;

    /// Sends a message to each of some other ranks and works while they are under way, then takes one of each of
    /// `from`, in this order. Both sides know who sends to whom. No rank may leave before a call of all has followed.
    fn exchange_during(&self, messages: Vec<Message>, from: &[usize], work: &mut dyn FnMut())
    -> Vec<Message>;

    /// What all ranks say, joined two by two, for all of them. It must not matter who is joined with whom.
    fn combine(&self, said: Vec<u8>, join: Join) -> Vec<u8> {
        let all = self.gather(&said).into_iter();
        all.reduce(|a, b| join(&a, &b)).unwrap_or(said)
    }

    /// What each rank says, by rank.
    fn gather(&self, said: &[u8]) -> Vec<Vec<u8>>;

    /// What the first rank says; what others say, nobody hears.
    fn hear_first(&self, said: &[u8]) -> Vec<u8> {
        let said = if self.rank() == 0 { said } else { &[] };
        self.gather(said).swap_remove(0)
    }

    /// What each rank says, by rank, to the first; the others hear nothing.
    fn tell_first(&self, said: &[u8]) -> Vec<Vec<u8>> {
        let all = self.gather(said);
        if self.rank() == 0 { all } else { Vec::new() }
    }

    /// What was sent so far, and how long this rank waited for others.
    fn traffic(&self) -> SentAndWaited;
}

/// The largest of the numbers of all ranks.
pub fn largest(ranks: &dyn Ranks, x: f64) -> f64 {
    combined(ranks, &x, f64::max)
}

/// Adds up the sums of all ranks.
pub fn add_up(ranks: &dyn Ranks, sums: &mut Vec<ExactSum>) {
    *sums = combined(ranks, sums, joined);
}

/// The same of sums that lie anywhere.
pub fn add_up_each<'a>(ranks: &dyn Ranks, sums: impl Iterator<Item = &'a mut ExactSum>) {
    let places: Vec<&mut ExactSum> = sums.collect();
    let mut all: Vec<ExactSum> = places.iter().map(|sum| (**sum).clone()).collect();
    add_up(ranks, &mut all);
    places.into_iter().zip(all).for_each(|(place, sum)| *place = sum);
}

/// Sums that belong together, added.
pub fn joined(mut sums: Vec<ExactSum>, others: Vec<ExactSum>) -> Vec<ExactSum> {
    ExactSum::merge_each(&mut sums, &others);
    sums
}
