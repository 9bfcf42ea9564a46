//! Ranks that are threads of one process: for tests, and to try what others will be.

use super::{Message, Ranks, SentAndWaited};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::available_parallelism;
use std::time::{Duration, Instant};

/// What all of them have in common.
struct Common {
    /// Messages to each rank, with their senders, and how many ever came.
    boxes: Vec<(Mutex<Vec<Message>>, AtomicU64)>,
    /// What each rank says to all.
    said: Vec<Mutex<Vec<u8>>>,
    meeting: Mutex<Meeting>,
    /// How often all ranks have met.
    held: AtomicU64,
    /// Wakes those that wait.
    bell: Condvar,
}

/// Where ranks wait for each other.
#[derive(Default)]
struct Meeting {
    /// How many wait.
    here: usize,
    /// Whether one has left for ever.
    left: bool,
}

/// A rank that is a thread of this process. Each needs a pool of threads of its own: who waits for another rank keeps
/// one of them.
pub struct Threads {
    rank: usize,
    common: Arc<Common>,
    sent: Mutex<SentAndWaited>,
    /// For how long one looks out for another before it lies down: not at all where not all have a processor.
    patience: Duration,
}

/// To be woken takes about as long.
const PATIENCE: Duration = Duration::from_micros(100);

impl Threads {
    /// So many ranks, each for a thread of its own.
    pub fn start(count: usize) -> Vec<Threads> {
        let common = Arc::new(Common {
            boxes: (0..count).map(|_| Default::default()).collect(),
            said: (0..count).map(|_| Mutex::default()).collect(),
            meeting: Mutex::default(),
            held: AtomicU64::new(0),
            bell: Condvar::new(),
        });
        let fits = available_parallelism().is_ok_and(|processors| count <= processors.get());
        let patience = if fits { PATIENCE } else { Duration::ZERO };
        let rank = |rank| Threads { rank, common: common.clone(), sent: Mutex::default(), patience };
        (0..count).map(rank).collect()
    }

    /// Waits until all ranks are here.
    ///
    /// # Panics
    /// One has left: it will never come.
    fn meet(&self) {
        let Common { boxes, meeting, held, bell, .. } = &*self.common;
        let begun = Instant::now();
        let mut now = open(meeting);
        let before = held.load(Ordering::Acquire);
        now.here += 1;
        if now.here == boxes.len() {
            now.here = 0;
            held.store(before + 1, Ordering::Release);
            bell.notify_all();
        }
        drop(now);
        self.wait_until(|| held.load(Ordering::Acquire) != before);
        open(&self.sent).waited += begun.elapsed().as_secs_f64();
    }

    /// Waits until something is so.
    ///
    /// # Panics
    /// A rank has left: it will never be.
    fn wait_until(&self, is_so: impl Fn() -> bool) {
        let Common { meeting, bell, .. } = &*self.common;
        let begun = Instant::now();
        while begun.elapsed() < self.patience {
            if is_so() {
                return;
            }
            std::hint::spin_loop();
        }
        let mut now = open(meeting);
        while !is_so() {
            assert!(!now.left, "a rank has left the others");
            now = bell.wait(now).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Puts a message into a rank's box.
    fn send(&self, (to, message): Message) {
        self.count_sent(message.len());
        let (messages, came) = &self.common.boxes[to];
        open(messages).push((self.rank, message));
        came.fetch_add(1, Ordering::Release);
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
        messages.into_iter().for_each(|message| self.send(message));
        self.meet();
        let mut came = std::mem::take(&mut *open(&self.common.boxes[self.rank].0));
        came.sort_by_key(|(from, _)| *from);
        // Nobody sends again before all have taken what came.
        self.meet();
        came
    }

    fn exchange_during(
        &self,
        messages: Vec<Message>,
        from: &[usize],
        work: &mut dyn FnMut(),
    ) -> Vec<Message> {
        let Common { meeting, bell, .. } = &*self.common;
        messages.into_iter().for_each(|message| self.send(message));
        // Who lies down looks once more before, by this lock.
        drop(open(meeting));
        bell.notify_all();
        work();
        let begun = Instant::now();
        let (messages, count) = &self.common.boxes[self.rank];
        // The first of each: what it sends afterwards may have come, too.
        let mut came = Vec::with_capacity(from.len());
        let mut seen = u64::MAX;
        while came.len() < from.len() {
            self.wait_until(|| count.load(Ordering::Acquire) != seen);
            let mut messages = open(messages);
            seen = count.load(Ordering::Acquire);
            while let Some(next) = from.get(came.len())
                && let Some(place) = messages.iter().position(|(from, _)| from == next)
            {
                came.push(messages.remove(place));
            }
        }
        open(&self.sent).waited += begun.elapsed().as_secs_f64();
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
    use crate::ranks::{add_up, largest};

    /// Who waits for a rank that is gone is told so.
    #[test]
    fn nobody_waits_for_a_rank_that_has_left() {
        let mut ranks = Threads::start(2);
        drop(ranks.pop());
        let waiting = ranks.remove(0);
        let waits = std::thread::spawn(move || largest(&waiting, 1.0)).join();
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
                        let next = vec![((rank + 1) % 4, vec![turn])];
                        let mut worked = false;
                        let came = ranks.exchange_during(next, &[(rank + 3) % 4], &mut || worked = true);
                        assert!(worked && came == [((rank + 3) % 4, vec![turn])]);
                        assert_eq!(largest(&ranks, -(rank as f64)), 0.0);
                        let numbers = [[1e300, -1e300, 1.0, 0.5][rank], 0.1];
                        let mut sums = numbers.map(|x| [x].into_iter().sum::<ExactSum>()).to_vec();
                        add_up(&ranks, &mut sums);
                        assert_eq!(sums.iter().map(ExactSum::value).collect::<Vec<_>>(), [1.5, 0.4]);
                    }
                });
            }
        });
    }
}
