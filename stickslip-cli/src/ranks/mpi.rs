//! Ranks that are processes, by MPI.

use mpi::datatype::PartitionMut;
use mpi::environment::Universe;
use mpi::point_to_point::{Destination, MatchedReceiveVec, Source};
use mpi::topology::{Communicator, Process, SimpleCommunicator};
use mpi::traits::{CommunicatorCollectives, Root};
use mpi::{Tag, Threading, request};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
use stickslip::ranks::{Join, Message, Ranks, SentAndWaited};

/// Bytes of a piece: MPI counts with 32 bits. A message of several has as many whole ones as fit, and a shorter one.
const PIECE: usize = 1 << 30;

/// Messages of this tag are for the first rank.
const FOR_FIRST: Tag = 0;
/// Those of an exchange have this tag or the next one, by turns: who has left one may send in the next while others are
/// still there.
const EXCHANGE: Tag = 1;
/// Those between ranks that both know of each other.
const EXPECTED: Tag = 3;
/// Those up and down the tree in which all are joined.
const TREE: Tag = 4;

/// The processes of an MPI job.
pub struct Mpi {
    rank: usize,
    count: usize,
    counted: Mutex<Counted>,
}

#[derive(Default)]
struct Counted {
    exchanges: u64,
    sent: SentAndWaited,
}

impl Mpi {
    /// Joins the job that the launcher began. What is given beside ends it when it is dropped.
    ///
    /// # Errors
    /// This MPI lets only one thread of a process call it, ever.
    pub fn join() -> Result<(Universe, Self), String> {
        let joined = mpi::initialize_with_threading(Threading::Serialized);
        let (universe, threading) = joined.ok_or("MPI was started before")?;
        if threading < Threading::Serialized {
            return Err("this MPI does not let threads of a process call it by turns".to_string());
        }
        let world = universe.world();
        let (rank, count) = (world.rank() as usize, world.size() as usize);
        Ok((universe, Mpi { rank, count, counted: Mutex::default() }))
    }

    /// What MPI calls itself.
    pub fn version() -> String {
        mpi::environment::library_version().unwrap_or_default().trim().to_string()
    }

    /// The machine on which this process is.
    pub fn machine() -> String {
        mpi::environment::processor_name().unwrap_or_default()
    }

    /// Ends all processes of the job.
    pub fn abort(code: i32) -> ! {
        world().abort(code)
    }

    /// What the first rank says, to all: down a binomial tree.
    fn down_the_tree(&self, said: Vec<u8>) -> Vec<u8> {
        let world = world();
        let parent_bit = if self.rank == 0 {
            self.count.next_power_of_two()
        } else {
            self.rank & self.rank.wrapping_neg()
        };
        let said = match self.rank {
            0 => said,
            rank => self.counted(0, 0, || receive(&world, rank - parent_bit, TREE)),
        };
        let bits = (0..usize::BITS).rev().map(|bit| 1 << bit).skip_while(|bit| *bit >= parent_bit);
        for other in bits.map(|bit| self.rank + bit).filter(|other| *other < self.count) {
            self.counted(1, said.len(), || send(&world, (other, &said), TREE));
        }
        said
    }

    fn counted<X>(&self, messages: usize, bytes: usize, act: impl FnOnce() -> X) -> X {
        let begun = Instant::now();
        let result = act();
        let Counted { sent, .. } = &mut *self.counted.lock().unwrap_or_else(PoisonError::into_inner);
        sent.messages += messages as u64;
        sent.bytes += bytes as u64;
        sent.waited += begun.elapsed().as_secs_f64();
        result
    }
}

fn world() -> SimpleCommunicator {
    SimpleCommunicator::world()
}

/// A message in pieces, the last of them shorter than the others, perhaps empty.
fn pieces(message: &[u8]) -> impl Iterator<Item = &[u8]> {
    (0..=message.len() / PIECE).map(|i| &message[i * PIECE..message.len().min((i + 1) * PIECE)])
}

/// Sends a message to a rank, which waits for it.
fn send(world: &SimpleCommunicator, (to, message): (usize, &[u8]), tag: Tag) {
    let to = world.process_at_rank(to as i32);
    pieces(message).for_each(|piece| to.send_with_tag(piece, tag));
}

/// The next message of a rank.
fn receive(world: &SimpleCommunicator, from: usize, tag: Tag) -> Vec<u8> {
    let (mut whole, from) = (Vec::new(), world.process_at_rank(from as i32));
    loop {
        let (piece, _) = from.matched_probe_with_tag(tag).matched_receive_vec::<u8>();
        let last = piece.len() < PIECE;
        if whole.is_empty() {
            whole = piece;
        } else {
            whole.extend(piece);
        }
        if last {
            return whole;
        }
    }
}

/// What a rank says to all, in pieces; its length is known.
fn spread(from: &Process, said: &mut [u8]) {
    said.chunks_mut(PIECE).for_each(|piece| from.broadcast_into(piece));
}

impl Ranks for Mpi {
    fn rank(&self) -> usize {
        self.rank
    }

    fn count(&self) -> usize {
        self.count
    }

    /// Nobody knows how many messages come. Each rank sends such that it knows when all of its own are being received,
    /// enters a barrier then, and takes what comes until all are there (Hoefler, Siebert and Lumsdaine 2010).
    fn exchange(&self, messages: Vec<Message>) -> Vec<Message> {
        let tag = {
            let mut counted = self.counted.lock().unwrap_or_else(PoisonError::into_inner);
            counted.exchanges += 1;
            EXCHANGE + (counted.exchanges % 2) as Tag
        };
        let bytes = messages.iter().map(|(_, message)| message.len()).sum();
        let world = world();
        self.counted(messages.len(), bytes, || {
            let mut came: Vec<Message> = Vec::new();
            // Whose message is not whole yet.
            let mut open: Vec<usize> = Vec::new();
            request::scope(|scope| {
                let mut sends = Vec::new();
                for (to, message) in &messages {
                    let to = world.process_at_rank(*to as i32);
                    let send = |piece| to.immediate_synchronous_send_with_tag(scope, piece, tag);
                    sends.extend(pieces(message).map(send));
                }
                let mut barrier = None;
                loop {
                    if let Some(found) = world.any_process().immediate_matched_probe_with_tag(tag) {
                        let (piece, status) = found.matched_receive_vec::<u8>();
                        let (from, whole) = (status.source_rank() as usize, piece.len() < PIECE);
                        match came.iter_mut().find(|(other, _)| *other == from && open.contains(&from)) {
                            Some((_, message)) => message.extend(piece),
                            None => came.push((from, piece)),
                        }
                        open.retain(|&other| other != from);
                        open.extend(Some(from).filter(|_| !whole));
                        continue;
                    }
                    sends = sends.into_iter().filter_map(|send| send.test().err()).collect();
                    barrier = match barrier {
                        None if sends.is_empty() => Some(world.immediate_barrier()),
                        None => None,
                        Some(barrier) => match request::Request::test(barrier) {
                            Ok(_) => break,
                            Err(barrier) => Some(barrier),
                        },
                    };
                    std::thread::yield_now();
                }
            });
            came.sort_by_key(|(from, _)| *from);
            came
        })
    }

    fn exchange_during(
        &self,
        messages: Vec<Message>,
        from: &[usize],
        work: &mut dyn FnMut(),
    ) -> Vec<Message> {
        let bytes = messages.iter().map(|(_, message)| message.len()).sum();
        let world = world();
        request::scope(|scope| {
            let mut sends = Vec::new();
            self.counted(messages.len(), bytes, || {
                for (to, message) in &messages {
                    let to = world.process_at_rank(*to as i32);
                    sends.extend(
                        pieces(message).map(|piece| to.immediate_send_with_tag(scope, piece, EXPECTED)),
                    );
                }
            });
            work();
            self.counted(0, 0, || {
                let came = from.iter().map(|&rank| (rank, receive(&world, rank, EXPECTED))).collect();
                for send in sends {
                    send.wait();
                }
                came
            })
        })
    }

    /// Up a binomial tree to the first rank, and down again.
    fn combine(&self, said: Vec<u8>, join: Join) -> Vec<u8> {
        let world = world();
        let mut all = said;
        for bit in (0..usize::BITS).map(|bit| 1 << bit).take_while(|bit| *bit < self.count) {
            if self.rank & bit != 0 {
                self.counted(1, all.len(), || send(&world, (self.rank - bit, &all), TREE));
                break;
            }
            if self.rank + bit < self.count {
                let other = self.counted(0, 0, || receive(&world, self.rank + bit, TREE));
                all = join(&all, &other);
            }
        }
        self.down_the_tree(all)
    }

    fn gather(&self, said: &[u8]) -> Vec<Vec<u8>> {
        let world = world();
        self.counted(1, said.len(), || {
            let mut lengths = vec![0_u64; self.count];
            world.all_gather_into(&(said.len() as u64), &mut lengths);
            let lengths: Vec<usize> = lengths.iter().map(|&length| length as usize).collect();
            let sum: usize = lengths.iter().sum();
            let mut all: Vec<Vec<u8>>;
            if sum < PIECE {
                let mut together = vec![0; sum];
                let counts: Vec<i32> = lengths.iter().map(|&length| length as i32).collect();
                let starts: Vec<i32> = (counts.iter())
                    .scan(0, |end, count| {
                        *end += count;
                        Some(*end - count)
                    })
                    .collect();
                let mut partition = PartitionMut::new(&mut together[..], counts, &starts[..]);
                world.all_gather_varcount_into(said, &mut partition);
                let mut rest = &together[..];
                all = Vec::with_capacity(self.count);
                for length in lengths {
                    let (own, others) = rest.split_at(length);
                    all.push(own.to_vec());
                    rest = others;
                }
            } else {
                all = lengths.iter().map(|&length| vec![0; length]).collect();
                all[self.rank].copy_from_slice(said);
                for (rank, said) in all.iter_mut().enumerate() {
                    spread(&world.process_at_rank(rank as i32), said);
                }
            }
            all
        })
    }

    fn hear_first(&self, said: &[u8]) -> Vec<u8> {
        self.down_the_tree(said.to_vec())
    }

    fn tell_first(&self, said: &[u8]) -> Vec<Vec<u8>> {
        let (world, bytes) = (world(), if self.rank == 0 { 0 } else { said.len() });
        self.counted(usize::from(self.rank > 0), bytes, || {
            if self.rank > 0 {
                send(&world, (0, said), FOR_FIRST);
                return Vec::new();
            }
            let others = (1..self.count).map(|rank| receive(&world, rank, FOR_FIRST));
            [said.to_vec()].into_iter().chain(others).collect()
        })
    }

    fn traffic(&self) -> SentAndWaited {
        self.counted.lock().unwrap_or_else(PoisonError::into_inner).sent
    }
}
