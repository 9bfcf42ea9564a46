//! Ranks that are threads of one process: for tests, and to try what others will be.

use super::{Message, Ranks, SentAndWaited};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// What all of them have in common.
struct Common {
    /// Messages to each rank, with their senders.
    boxes: Vec<Mutex<Vec<Message>>>,
    /// What each rank says to all.
    said: Vec<Mutex<Vec<u8>>>,
    meeting: Mutex<Meeting>,
    /// Wakes those that wait.
    bell: Condvar,
}

/// Where ranks wait for each other.
#[derive(Default)]
struct Meeting {
    /// How many wait.
    here: usize,
    /// How often all of them have met.
    held: u64,
    /// Whether one has left for ever.
    left: bool,
}

/// A rank that is a thread of this process. Each needs a pool of threads of its own: who waits for another rank keeps
/// one of them.
pub struct Threads {
    rank: usize,
    common: Arc<Common>,
    sent: Mutex<SentAndWaited>,
}

impl Threads {
    /// So many ranks, each for a thread of its own.
    pub fn start(count: usize) -> Vec<Threads> {
        let common = Arc::new(Common {
            boxes: (0..count).map(|_| Mutex::default()).collect(),
            said: (0..count).map(|_| Mutex::default()).collect(),
            meeting: Mutex::default(),
            bell: Condvar::new(),
        });
        (0..count).map(|rank| Threads { rank, common: common.clone(), sent: Mutex::default() }).collect()
    }

    /// Waits until all ranks are here.
    ///
    /// # Panics
    /// One has left: it will never come.
    fn meet(&self) {
        let Common { boxes, meeting, bell, .. } = &*self.common;
        let begun = Instant::now();
        let mut now = open(meeting);
        let held = now.held;
        now.here += 1;
        if now.here == boxes.len() {
            (now.here, now.held) = (0, held + 1);
            bell.notify_all();
        }
        while now.held == held {
            assert!(!now.left, "a rank has left the others");
            now = bell.wait(now).unwrap_or_else(PoisonError::into_inner);
        }
        open(&self.sent).waited += begun.elapsed().as_secs_f64();
    }

    fn count_sent(&self, bytes: usize) {
        let mut sent = open(&self.sent);
        (sent.messages, sent.bytes) = (sent.messages + 1, sent.bytes + bytes as u64);
    }
}

impl Drop for Threads {
    /// Who goes keeps nobody waiting.
    fn drop(&mut self) {
        open(&self.common.meeting).left = true;
        self.common.bell.notify_all();
    }
}

fn open<X>(mutex: &Mutex<X>) -> MutexGuard<'_, X> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Ranks for Threads {
    fn rank(&self) -> usize {
        self.rank
    }

    fn count(&self) -> usize {
        self.common.boxes.len()
    }

    fn exchange(&self, messages: Vec<Message>) -> Vec<Message> {
        for (to, message) in messages {
            self.count_sent(message.len());
            open(&self.common.boxes[to]).push((self.rank, message));
        }
        self.meet();
        let mut came = std::mem::take(&mut *open(&self.common.boxes[self.rank]));
        came.sort_by_key(|(from, _)| *from);
        // Nobody sends again before all have taken what came.
        self.meet();
        came
    }

    fn gather(&self, said: &[u8]) -> Vec<Vec<u8>> {
        self.count_sent(said.len());
        *open(&self.common.said[self.rank]) = said.to_vec();
        self.meet();
        let all = self.common.said.iter().map(|said| open(said).clone()).collect();
        self.meet();
        all
    }

    fn traffic(&self) -> SentAndWaited {
        *open(&self.sent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::ExactSum;

    /// Who waits for a rank that is gone is told so.
    #[test]
    fn nobody_waits_for_a_rank_that_has_left() {
        let mut ranks = Threads::start(2);
        drop(ranks.pop());
        let waiting = ranks.remove(0);
        let waits = std::thread::spawn(move || waiting.largest(1.0)).join();
        assert!(waits.is_err());
    }

    /// Each of some ranks sends its number to all others, many times, and says it.
    #[test]
    fn messages_come_to_whom_they_are_for() {
        std::thread::scope(|scope| {
            for ranks in Threads::start(4) {
                scope.spawn(move || {
                    let rank = ranks.rank();
                    for turn in 0..50_u8 {
                        let others = (0..4).filter(|&to| to != rank);
                        let came =
                            ranks.exchange(others.map(|to| (to, vec![rank as u8, to as u8, turn])).collect());
                        let wanted = (0..4).filter(|&from| from != rank);
                        let wanted: Vec<_> =
                            wanted.map(|from| (from, vec![from as u8, rank as u8, turn])).collect();
                        assert_eq!(came, wanted);
                        assert_eq!(ranks.gather(&[rank as u8; 2]), [[0, 0], [1, 1], [2, 2], [3, 3]]);
                        assert_eq!(ranks.largest(-(rank as f64)), 0.0);
                        let mut sums =
                            [[1e300, -1e300, 1.0, 0.5][rank], 0.1].map(|x| [x].into_iter().sum::<ExactSum>());
                        ranks.add_up(&mut sums);
                        assert_eq!(sums.map(|sum| sum.value()), [1.5, 0.4]);
                    }
                });
            }
        });
    }
}
