//! Ranks: processes that share a simulation, each with the particles in its blocks.
//!
//! A rank owns the blocks of a part of space. What it needs of others comes in messages: particles that move to its
//! blocks, the windows of tiles at blocks that it holds, and sums that everybody knows. Sums of particles at a node
//! follow the colours of tiles, and all others are exact: so any number of ranks gives the same bits as one.

mod partition;
mod threads;

pub use partition::Partition;
pub use threads::Threads;

use crate::exact::ExactSum;
use serde::{Deserialize, Serialize};

/// A message with the other rank: whom it is for, or who sent it.
pub type Message = (usize, Vec<u8>);

/// The message to a rank among some, from now on if not before.
pub fn message_to(messages: &mut Vec<Message>, rank: usize) -> &mut Vec<u8> {
    let place = messages.iter().position(|(to, _)| *to == rank).unwrap_or_else(|| {
        messages.push((rank, Vec::new()));
        messages.len() - 1
    });
    &mut messages[place].1
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

/// The ranks of a simulation, as one of them sees it. All of them make the same calls in the same order.
pub trait Ranks: Send + Sync {
    /// This one's number.
    fn rank(&self) -> usize;

    /// How many there are.
    fn count(&self) -> usize;

    /// Sends a message to each of some other ranks, and takes those that came, by rank.
    fn exchange(&self, messages: Vec<Message>) -> Vec<Message>;

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

    /// The largest of the numbers of all ranks.
    fn largest(&self, x: f64) -> f64 {
        let said = self.gather(&x.to_le_bytes());
        let numbers =
            said.iter().filter_map(|bytes| bytes.first_chunk().map(|bytes| f64::from_le_bytes(*bytes)));
        numbers.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Adds up the sums of all ranks.
    fn add_up(&self, sums: &mut [ExactSum]) {
        let mut said = Vec::new();
        sums.iter_mut().for_each(|sum| sum.write_to(&mut said));
        sums.fill(ExactSum::default());
        for bytes in self.gather(&said) {
            let mut rest = &bytes[..];
            for sum in &mut *sums {
                let (other, behind) = ExactSum::read_from(rest).expect("ranks run the same program");
                sum.merge(&other);
                rest = behind;
            }
        }
    }
}
