//! Checkpoints: all that a run needs to go on, in a file that is whole or not there.
//!
//! ```text
//! "stickslip checkpoint", a zero, the version of the format as u32, little-endian
//! a map in MessagePack: program, scene, state, memory
//! SHA-256 of all bytes before it
//! ```
//! In version 2 the map is compressed by zlib, in version 1 it is not; both are written.

use super::CHECKPOINTS;
use super::file::{OutputError, ReadError, ReadProblem, read_bytes, replace_for_good};
use super::folder::OutputFolder;
use super::memory::{Memory, Values};
use crate::door::{SavedColumn, SavedState, Simulation};
use crate::scene::Scene;
use flate2::Compression;
use flate2::bufread::ZlibDecoder;
use flate2::write::ZlibEncoder;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fs;
use std::io::{self, BufReader, Read, Write};
use std::path::{Path, PathBuf};

/// A moment of a run from which it can go on.
#[derive(Debug, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Version of the program that wrote it.
    pub program: String,
    /// The scene as run, as `run.json` has it.
    scene: String,
    /// The simulation.
    pub state: SavedState,
    /// How far outputs and checks have come.
    memory: Values,
}

/// How a checkpoint is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CheckpointForm {
    /// As it is, which takes little time.
    Plain,
    /// By zlib, in two thirds of the space.
    Compressed,
}

/// The beginning of every checkpoint.
const MAGIC: &[u8; 21] = b"stickslip checkpoint\0";
/// Versions of the format, by whether the map is compressed.
const PLAIN: u32 = 1;
const COMPRESSED: u32 = 2;
/// Bytes that one of a compressed map may stand for, so that no file takes memory out of proportion to its size; a map
/// that would be smaller is written plain.
const MOST_COMPRESSED: u64 = 50;
/// Bytes of a sum.
const SUM: usize = 32;

impl Checkpoint {
    /// A moment of the run of a scene.
    pub fn new(scene: &serde_json::Value, state: SavedState, memory: Memory) -> Self {
        Checkpoint {
            program: env!("CARGO_PKG_VERSION").to_string(),
            scene: scene.to_string(),
            state,
            memory: memory.into_values(),
        }
    }

    /// Where the checkpoints lie in the folder of a run.
    pub fn folder(results: &Path) -> PathBuf {
        results.join(CHECKPOINTS)
    }

    /// Where a checkpoint after so many steps lies there.
    pub fn path(results: &Path, steps: u64) -> PathBuf {
        Self::folder(results).join(format!("{steps:010}.checkpoint"))
    }

    /// The scene as run.
    pub fn scene(&self) -> serde_json::Value {
        serde_json::from_str(&self.scene).unwrap_or_default()
    }

    /// What was kept of outputs and checks.
    pub fn memory(&mut self, path: &Path) -> Memory {
        Memory::of(std::mem::take(&mut self.memory), path)
    }

    /// Writes it: beside its place first, flushed to the disk, then renamed into place, so that whatever happens there
    /// is the whole of it or nothing.
    ///
    /// # Errors
    /// The disk is full or refuses; then nothing is left of it.
    pub fn write(&self, path: &Path, form: CheckpointForm) -> Result<(), OutputError> {
        let plain = || self.write_as(PLAIN, path, |file| self.encode(file));
        if form == CheckpointForm::Plain {
            return plain();
        }
        let mut most = false;
        self.write_as(COMPRESSED, path, |file| {
            let mut compressed = ZlibEncoder::new(file, Compression::fast());
            self.encode(&mut compressed)?;
            compressed.try_finish()?;
            most = compressed.total_in() > MOST_COMPRESSED * compressed.total_out();
            Ok(())
        })?;
        if most { plain() } else { Ok(()) }
    }

    fn write_as(
        &self,
        version: u32,
        path: &Path,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        replace_for_good(path, |file| {
            let mut summed = Summed { file, sum: Sha256::new() };
            summed.write_all(MAGIC)?;
            summed.write_all(&version.to_le_bytes())?;
            write(&mut summed)?;
            let Summed { file, sum } = summed;
            file.write_all(&sum.finalize())
        })
    }

    fn encode(&self, file: &mut dyn Write) -> io::Result<()> {
        self.serialize(&mut rmp_serde::Serializer::new(file).with_struct_map()).map_err(io_error)
    }

    /// Reads one.
    ///
    /// # Errors
    /// It is missing, damaged, of a later version, or no checkpoint.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let read = || -> Result<Checkpoint, ReadProblem> {
            let layout = |what: &str| ReadProblem::Layout(what.to_string());
            let bytes = read_bytes(path)?;
            let head = MAGIC.len() + size_of::<u32>();
            if bytes.len() < head + SUM || !bytes.starts_with(MAGIC) {
                return Err(layout("it is no checkpoint of stickslip"));
            }
            let (content, sum) = bytes.split_at(bytes.len() - SUM);
            if Sha256::digest(content)[..] != *sum {
                return Err(layout("it is damaged: its bytes do not add up to its sum"));
            }
            let version = content[MAGIC.len()..head].try_into().map(u32::from_le_bytes).unwrap_or_default();
            let map = &content[head..];
            let decoded = match version {
                PLAIN => rmp_serde::from_slice(map),
                COMPRESSED => {
                    let most = MOST_COMPRESSED * map.len() as u64;
                    rmp_serde::from_read(BufReader::new(ZlibDecoder::new(map).take(most)))
                }
                _ => {
                    let known = format!("this program reads {PLAIN} and {COMPRESSED}");
                    return Err(layout(&format!("it is of version {version} of the format; {known}")));
                }
            };
            decoded.map_err(|error| layout(&format!("it is damaged: {error}")))
        };
        read().map_err(|problem| problem.at(path))
    }

    /// The checkpoints in the folder of a run, the newest first.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub fn list(folder: &Path) -> Result<Vec<PathBuf>, ReadError> {
        let path = folder.join(CHECKPOINTS);
        let entries = match fs::read_dir(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            other => other.map_err(|error| ReadProblem::from(error).at(&path))?,
        };
        let files = entries.flatten().filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_file()));
        let names = files.filter_map(|entry| entry.file_name().into_string().ok());
        let mut names: Vec<String> = names.filter(|name| is_checkpoint(name)).collect();
        names.sort_unstable_by_key(|name| std::cmp::Reverse((name.len(), name.clone())));
        Ok(names.into_iter().map(|name| path.join(name)).collect())
    }

    /// The newest checkpoint in the folder of a run that can be read, where it lies, and why newer ones cannot.
    ///
    /// # Errors
    /// There is none, or none can be read.
    pub fn newest(folder: &Path) -> Result<(Self, PathBuf, Vec<ReadError>), ReadError> {
        let mut damaged = Vec::new();
        for path in Self::list(folder)? {
            match Self::read(&path) {
                Ok(checkpoint) => return Ok((checkpoint, path, damaged)),
                Err(error) => damaged.push(error),
            }
        }
        let none =
            || ReadProblem::Layout("there is no checkpoint in it".to_string()).at(&folder.join(CHECKPOINTS));
        Err(damaged.into_iter().next().unwrap_or_else(none))
    }

    /// Makes the folder for the checkpoints of a run, and clears it of what was left half-written.
    ///
    /// # Errors
    /// The disk refuses.
    pub fn prepare(folder: &OutputFolder) -> Result<(), OutputError> {
        let path = folder.join(CHECKPOINTS);
        match fs::create_dir(&path) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            other => other.map_err(OutputError::at(&path))?,
        }
        for entry in fs::read_dir(&path).map_err(OutputError::at(&path))?.flatten() {
            if entry
                .file_name()
                .to_str()
                .and_then(|name| name.strip_suffix(".part"))
                .is_some_and(is_checkpoint)
            {
                fs::remove_file(entry.path()).map_err(OutputError::at(&entry.path()))?;
            }
        }
        Ok(())
    }

    /// Puts a checkpoint that cannot be read out of the way of others: its name gets `.damaged` appended.
    ///
    /// # Errors
    /// The disk refuses.
    pub fn put_away(path: &Path) -> Result<(), OutputError> {
        let mut name = path.as_os_str().to_owned();
        name.push(".damaged");
        fs::rename(path, name).map_err(OutputError::at(path))
    }

    /// Removes all but the newest checkpoints of a run.
    ///
    /// # Errors
    /// One cannot be removed.
    pub fn keep_newest(folder: &Path, count: usize) -> Result<(), OutputError> {
        let all = Self::list(folder)
            .map_err(|error| OutputError { path: error.path, source: io_error(error.problem) })?;
        all.iter().skip(count).try_for_each(|path| fs::remove_file(path).map_err(OutputError::at(path)))
    }
}

/// `0000012345.checkpoint`.
pub(super) fn is_checkpoint(name: &str) -> bool {
    let digits = name.strip_suffix(".checkpoint");
    digits.is_some_and(|digits| digits.len() >= 10 && digits.bytes().all(|byte| byte.is_ascii_digit()))
}

/// A SHA-256 of the particles of a state, in hexadecimal: of each body its name, its particles' numbers in ascending
/// order, and each entry of each column in that order, then time and steps. Where particles lie in memory does not enter.
pub fn state_sum(state: &SavedState) -> String {
    let mut sum = StateSum::default();
    for body in &state.bodies {
        sum.begin(&body.name, &body.numbers);
        body.columns.iter().for_each(|column| sum.add(column));
    }
    sum.finish(state.time, state.steps)
}

/// The [`state_sum`] of a simulation of a scene as it is now, for which no more than one column is copied at a time; none
/// of a simulation that has no state as data.
pub fn present_state_sum(scene: &Scene, simulation: &dyn Simulation) -> Option<String> {
    let mut sum = StateSum::default();
    for (number, body) in scene.bodies.iter().enumerate() {
        let mut begun = false;
        let known = simulation.save_columns(number, &mut |numbers, column| {
            if !std::mem::replace(&mut begun, true) {
                sum.begin(&body.name, numbers);
            }
            sum.add(&column);
        });
        if !known {
            return None;
        }
    }
    Some(sum.finish(simulation.time(), simulation.steps()))
}

#[derive(Default)]
struct StateSum {
    sum: Sha256,
    /// Places in memory of the particles of the body at hand, by their numbers.
    order: Vec<u32>,
}

impl StateSum {
    fn begin(&mut self, name: &str, numbers: &[u32]) {
        self.sum.update(name.as_bytes());
        self.order = (0..numbers.len() as u32).collect();
        self.order.sort_unstable_by_key(|&place| numbers[place as usize]);
    }

    fn add(&mut self, column: &SavedColumn) {
        let (sum, width) = (&mut self.sum, column.width);
        sum.update(column.name.as_bytes());
        // A state that was read may be anybody's; without a width or particles there is nothing to add.
        let Some(length) = width.checked_mul(self.order.len()).filter(|&length| length > 0) else { return };
        for line in column.bytes.chunks_exact(length) {
            self.order.iter().for_each(|&place| sum.update(&line[place as usize * width..][..width]));
        }
    }

    fn finish(mut self, time: f64, steps: u64) -> String {
        self.sum.update(time.to_le_bytes());
        self.sum.update(steps.to_le_bytes());
        self.sum.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// A file and the sum of what was written to it.
struct Summed<W> {
    file: W,
    sum: Sha256,
}

impl<W: Write> Write for Summed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.sum.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// An error of the encoder; what the disk says stands in it.
fn io_error(error: impl std::error::Error + Send + Sync + 'static) -> io::Error {
    let mut cause: Option<&(dyn std::error::Error + 'static)> = Some(&error);
    while let Some(this) = cause {
        if let Some(io) = this.downcast_ref::<io::Error>() {
            return io.raw_os_error().map_or_else(|| io.kind().into(), io::Error::from_raw_os_error);
        }
        cause = this.source();
    }
    io::Error::other(error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(version: u32, map: &[u8]) -> Vec<u8> {
        let mut bytes = [&MAGIC[..], &version.to_le_bytes(), map].concat();
        let sum = Sha256::digest(&bytes);
        bytes.extend(sum);
        bytes
    }

    fn zipped(bytes: &[u8]) -> Vec<u8> {
        let mut zipped = ZlibEncoder::new(Vec::new(), Compression::fast());
        zipped.write_all(bytes).unwrap();
        zipped.finish().unwrap()
    }

    fn refused(path: &Path) -> String {
        Checkpoint::read(path).map(drop).unwrap_err().to_string()
    }

    /// With a sum that is right: what is no map, cut short, or stands for far more bytes than it has.
    #[test]
    fn compressed_files_of_others_are_damaged() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("0000000001.checkpoint");
        // An array of a million zeros.
        let many = [&[0xdd, 0x00, 0x0f, 0x42, 0x40][..], &[0; 1_000_000]].concat();
        let whole = zipped(&many);
        assert!(many.len() > 100 * whole.len());
        for map in [&b"no zlib"[..], &[], &whole, &whole[..whole.len() / 2], &zipped(b"\xc0")] {
            fs::write(&path, file(COMPRESSED, map)).unwrap();
            assert!(refused(&path).contains("it is damaged"), "{}", refused(&path));
        }
        fs::write(&path, file(3, &whole)).unwrap();
        assert!(refused(&path).contains("this program reads 1 and 2"), "{}", refused(&path));
    }
}
