//! A file that ranks write together.

use crate::observe::file::FileSum;
use crate::ranks::{Ranks, bytes_of, gathered, read};
use serde::{Deserialize, Serialize};
use serde_bytes::ByteBuf;
use std::fs::{File, OpenOptions};
use std::hash::{BuildHasher, RandomState};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

/// A file that ranks write together: each its pieces, where all see the same file; else through the first, one after
/// the other. All ranks make the same calls in the same order.
pub(super) struct JointFile<'a> {
    ranks: &'a dyn Ranks,
    /// None where the first one writes for this rank.
    file: Option<File>,
    /// Whether each rank writes.
    each: bool,
    /// Whether all are on one machine.
    on_one_machine: bool,
    end: u64,
    /// Of all pieces so far.
    sum: crc32fast::Hasher,
    trouble: Option<io::Error>,
}

/// What a rank says of its piece.
#[derive(Serialize, Deserialize)]
struct Piece {
    bytes: u64,
    crc: u32,
}

/// An error of the disk as ranks tell each other.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Trouble {
    rank: usize,
    code: Option<i32>,
    told: String,
}

impl From<Trouble> for io::Error {
    /// Of the same kind, with the rank that has it.
    fn from(Trouble { rank, code, told }: Trouble) -> io::Error {
        let kind = code.map_or(io::ErrorKind::Other, |code| io::Error::from_raw_os_error(code).kind());
        io::Error::new(kind, if rank == 0 { told } else { format!("{told}, on rank {rank}") })
    }
}

impl<'a> JointFile<'a> {
    /// A new file, whose pieces begin at a place.
    pub(super) fn create(ranks: &'a dyn Ranks, path: &Path, start: u64) -> Self {
        let mut trouble = None;
        let mut file = None;
        let mut mark = Vec::new();
        if ranks.rank() == 0 {
            mark = own_mark();
            match File::create(path).and_then(|mut new| new.write_all(&mark).map(|()| new)) {
                Ok(new) => file = Some(new),
                Err(error) => trouble = Some(error),
            }
        }
        let mark = ranks.hear_first(&mark);
        if ranks.rank() > 0 {
            file = marked(path, &mark).ok();
        }
        let seen = file.as_ref().map(shows_all_the_same);
        let all: Vec<(Option<bool>, String)> = gathered(ranks, &(seen, machine()));
        let on_one_machine = all.iter().all(|(_, machine)| !machine.is_empty() && *machine == all[0].1);
        let each = all.iter().all(|(seen, _)| seen.is_some_and(|same| same || on_one_machine));
        if !each && ranks.rank() > 0 {
            file = None;
        }
        JointFile { ranks, file, each, on_one_machine, end: start, sum: crc32fast::Hasher::new(), trouble }
    }

    /// Puts the pieces of all ranks behind each other and behind what is there: where that of this rank lies.
    pub(super) fn put(&mut self, piece: &[u8]) -> u64 {
        let own = Piece { bytes: piece.len() as u64, crc: crc32fast::hash(piece) };
        let pieces = gathered(self.ranks, &own);
        let mut places = Vec::with_capacity(pieces.len());
        for piece in &pieces {
            places.push(self.end);
            self.end += piece.bytes;
            self.sum.combine(&crc32fast::Hasher::new_with_initial_len(piece.crc, piece.bytes));
        }
        let own = places[self.ranks.rank()];
        if self.each || self.ranks.rank() == 0 {
            self.write_at(own, piece);
        }
        if !self.each {
            self.write_through_first(piece, &places, &pieces);
        }
        own
    }

    fn write_through_first(&mut self, piece: &[u8], places: &[u64], pieces: &[Piece]) {
        for (rank, place) in places.iter().enumerate().skip(1).filter(|(rank, _)| pieces[*rank].bytes > 0) {
            let from = if self.ranks.rank() == 0 { &[rank][..] } else { &[] };
            let message = (self.ranks.rank() == rank).then(|| (0, piece.to_vec()));
            for (_, piece) in self.ranks.exchange_during(message.into_iter().collect(), from, &mut || ()) {
                self.write_at(*place, &piece);
            }
        }
    }

    fn write_at(&mut self, place: u64, bytes: &[u8]) {
        if self.trouble.is_some() || bytes.is_empty() {
            return;
        }
        let Some(file) = &mut self.file else { return };
        self.trouble = file.seek(SeekFrom::Start(place)).and_then(|_| file.write_all(bytes)).err();
    }

    /// Ends the file: with what the first rank puts before all pieces, which fits where they begin, and behind them;
    /// and if it must outlive a power cut, once it is on the disk.
    ///
    /// # Errors
    /// A rank could not write, or the disk refuses: all ranks say so.
    pub(super) fn finish(mut self, [before, behind]: [&[u8]; 2], for_good: bool) -> Result<FileSum, Trouble> {
        if self.ranks.rank() == 0 {
            self.write_at(0, before);
            self.write_at(self.end, behind);
        }
        // What another machine has not flushed, the first cannot flush later.
        let flushes = for_good || self.each && !self.on_one_machine;
        let flushed = self.file.as_ref().filter(|_| flushes).map_or(Ok(()), File::sync_data);
        let trouble = self.trouble.take().or(flushed.err());
        let own = trouble.map(|error| Trouble {
            rank: self.ranks.rank(),
            code: error.raw_os_error(),
            told: error.to_string(),
        });
        if let Some(trouble) = gathered(self.ranks, &own).into_iter().flatten().next() {
            return Err(trouble);
        }
        let mut sum = crc32fast::Hasher::new();
        sum.update(before);
        sum.combine(&self.sum);
        sum.update(behind);
        let bytes = self.end + behind.len() as u64;
        Ok(FileSum { bytes, crc: sum.finalize() })
    }
}

/// Bytes that no other file begins with.
fn own_mark() -> Vec<u8> {
    // Each state is another one.
    bytes_of(&(RandomState::new().hash_one(0), std::process::id()))
}

/// The file there, if it is the one with the mark.
fn marked(path: &Path, mark: &[u8]) -> io::Result<File> {
    let mut file = OpenOptions::new().read(true).write(true).open(path)?;
    let mut found = vec![0; mark.len()];
    file.read_exact(&mut found)?;
    if !mark.is_empty() && found == mark { Ok(file) } else { Err(io::ErrorKind::NotFound.into()) }
}

/// What no other machine has, nor this one after it is started again; nothing where that is not known, as it is only
/// under Linux.
fn machine() -> String {
    std::fs::read_to_string("/proc/sys/kernel/random/boot_id").unwrap_or_default()
}

/// Whether machines that write to parts of a file beside each other keep each other's bytes: those that share disks do,
/// by locks of their own. Others write back whole pages, with what they saw of the bytes between.
#[cfg(target_os = "linux")]
fn shows_all_the_same(file: &File) -> bool {
    /// Lustre, GPFS, Ceph, OCFS2, GFS2: as `statfs` names them.
    const SHARED: [u32; 5] = [0x0bd0_0bd0, 0x4750_4653, 0x00c3_6400, 0x7461_636f, 0x0116_1970];
    rustix::fs::fstatfs(file).is_ok_and(|found| SHARED.contains(&(found.f_type as u32)))
}

#[cfg(not(target_os = "linux"))]
fn shows_all_the_same(_: &File) -> bool {
    false
}

/// A file whose pieces ranks read, each its own: themselves where all see it, else the first for them.
pub(super) struct JointReading<'a> {
    ranks: &'a dyn Ranks,
    file: io::Result<File>,
    each: bool,
}

impl<'a> JointReading<'a> {
    /// A file that is there.
    pub(super) fn open(ranks: &'a dyn Ranks, path: &Path) -> Self {
        let file = crate::observe::file::open_file(path);
        let length = file.as_ref().ok().and_then(|file| Some(file.metadata().ok()?.len()));
        let lengths = gathered(ranks, &length);
        let each = lengths.iter().all(|length| length.is_some() && *length == lengths[0]);
        JointReading { ranks, file, each }
    }

    /// Shows this rank its share of so many pieces, by their numbers, which `take` gets of the file, or what the system
    /// says. No rank may leave before a call of all has followed.
    pub(super) fn each_share(
        mut self,
        pieces: usize,
        read_piece: &dyn Fn(usize, &mut File) -> io::Result<Vec<u8>>,
        take: &mut dyn FnMut(usize, Result<Vec<u8>, String>),
    ) {
        let (rank, count) = (self.ranks.rank(), self.ranks.count());
        let share = |rank: usize| rank * pieces / count..(rank + 1) * pieces / count;
        let mut read_one = |piece: usize| match &mut self.file {
            Ok(file) => read_piece(piece, file).map_err(|error| format!("{error}, on rank {rank}")),
            Err(error) => Err(error.to_string()),
        };
        if self.each {
            share(rank).for_each(|piece| take(piece, read_one(piece)));
            return;
        }
        for other in 0..count {
            for piece in share(other) {
                if other == 0 {
                    if rank == 0 {
                        take(piece, read_one(piece));
                    }
                    continue;
                }
                let message = (rank == 0).then(|| (other, bytes_of(&read_one(piece).map(ByteBuf::from))));
                let from = if rank == other { &[0][..] } else { &[] };
                let came = self.ranks.exchange_during(message.into_iter().collect(), from, &mut || ());
                for (_, bytes) in came {
                    take(piece, read::<Result<ByteBuf, String>>(&bytes).map(ByteBuf::into_vec));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ranks::Threads;
    use std::fs;

    /// What each of some ranks makes of something, by rank.
    fn on_ranks<X: Send>(count: usize, act: impl Fn(&dyn Ranks) -> X + Sync) -> Vec<X> {
        let act = &act;
        std::thread::scope(|scope| {
            let threads = Threads::start(count).into_iter();
            let all: Vec<_> = threads.map(|ranks| scope.spawn(move || act(&ranks))).collect();
            all.into_iter().map(|one| one.join().unwrap()).collect()
        })
    }

    /// Each writes where all see the file, and the first for all where one does not: the same file, whose pieces come
    /// back in both ways.
    #[test]
    fn ranks_write_and_read_one_file_whether_they_see_it_or_not() {
        let folder = tempfile::tempdir().unwrap();
        for (name, sees_it) in [("seen", true), ("hidden", false)] {
            let path = folder.path().join(name);
            let there =
                |rank: usize| if sees_it || rank != 1 { path.clone() } else { folder.path().join("none") };
            let piece = |rank: usize, round: usize| vec![(10 * rank + round) as u8; 100 * rank * (round + 1)];
            let sums = on_ranks(3, |ranks| {
                let mut file = JointFile::create(ranks, &there(ranks.rank()), 20);
                assert_eq!(file.each, sees_it && cfg!(target_os = "linux"));
                for round in 0..2 {
                    file.put(&piece(ranks.rank(), round));
                }
                let ends: [&[u8]; 2] = if ranks.rank() == 0 { [&[7; 20], b"end"] } else { [&[], &[]] };
                file.finish(ends, true).unwrap()
            });
            let pieces = (0..2).flat_map(|round| (0..3).flat_map(move |rank| piece(rank, round)));
            let expected: Vec<u8> = [7; 20].into_iter().chain(pieces).chain(*b"end").collect();
            assert_eq!(fs::read(&path).unwrap(), expected);
            assert_eq!(sums[0], FileSum::of(&mut &expected[..], u64::MAX).unwrap());
            let read = on_ranks(3, |ranks| {
                let mut found = Vec::new();
                JointReading::open(ranks, &there(ranks.rank())).each_share(
                    7,
                    &|piece, file| {
                        file.seek(SeekFrom::Start(20 + 10 * piece as u64))?;
                        let mut bytes = vec![0; 10];
                        file.read_exact(&mut bytes).map(|()| bytes)
                    },
                    &mut |piece, bytes| found.push((piece, bytes.unwrap())),
                );
                // Nobody leaves before.
                ranks.gather(&[]);
                found
            });
            assert!(read.iter().all(|found| found.len() >= 2), "{read:?}");
            let read: Vec<(usize, Vec<u8>)> = read.concat();
            assert_eq!(read.len(), 7);
            for (i, (piece, bytes)) in read.iter().enumerate() {
                assert_eq!((*piece, &bytes[..]), (i, &expected[20 + 10 * i..][..10]), "{name}");
            }
        }
    }

    /// A folder that is not there, and a disk that takes nothing: all ranks say so.
    #[test]
    fn ranks_say_together_what_is_wrong_with_a_disk() {
        let folder = tempfile::tempdir().unwrap();
        let put = |path: &Path| {
            let said = on_ranks(2, |ranks| {
                let mut file = JointFile::create(ranks, path, 4);
                file.put(&[1; 1 << 20]);
                file.finish([&[0; 4], &[]], false).map(drop)
            });
            said.into_iter().map(|said| io::Error::from(said.unwrap_err())).collect::<Vec<_>>()
        };
        let missing = put(&folder.path().join("none/file"));
        assert!(missing.iter().all(|error| error.kind() == io::ErrorKind::NotFound), "{missing:?}");
        if cfg!(target_os = "linux") {
            let full = put(Path::new("/dev/full"));
            assert!(full.iter().all(|error| error.kind() == io::ErrorKind::StorageFull), "{full:?}");
        }
    }
}
