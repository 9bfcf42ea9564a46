//! Checkpoints: all that a run needs to go on, in a file that is whole or not there.
//!
//! ```text
//! "stickslip checkpoint", a zero, the version of the format as u32, little-endian
//! sections: some particles each, in MessagePack, packed by zlib or as they are
//! the head, a map in MessagePack: program, scene, state without particles, memory, where sections lie, their SHA-256
//! whether the head is packed by zlib, a byte: 1 if it is, else 0
//! where the head lies as u64, little-endian
//! SHA-256 of all that but the sections
//! ```

mod sections;

use sections::Sections;
pub(super) use sections::{MOST_PARTICLES, Section};

use super::CHECKPOINTS;
use super::file::{
    OutputError, ReadError, ReadProblem, open_file, replace_by, replace_for_good, secure_name, whole_name,
};
use super::folder::OutputFolder;
use super::manifest::SceneRecord;
use super::memory::{Memory, Values};
use super::shared::{self, ParticlesThere};
use super::work::work;
use crate::door::{NotTakenUp, RestoreError, SavedState, Simulation};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// A moment of a run from which it can go on.
#[derive(Debug, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Version of the program that wrote it.
    pub program: String,
    /// The scene as run, as `run.json` has it.
    scene: String,
    /// The simulation; of a checkpoint that was [opened](Checkpoint::open), maybe without particles.
    pub state: SavedState,
    /// How far outputs and checks have come.
    memory: Values,
    /// Where particles lie that are not in the state.
    sections: Vec<Section>,
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
/// Version of the format.
const VERSION: u32 = 4;
/// No version will ever be above this.
const LAST: u32 = 1 << 16;
/// Bytes that one of a packed map may stand for, so that no file takes memory out of proportion to its size; a map that
/// would be smaller is written as it is.
const MOST_COMPRESSED: u64 = 50;
/// Bytes of a sum.
const SUM: usize = 32;
/// Bytes before sections.
pub(super) const START: usize = MAGIC.len() + size_of::<u32>();

impl Checkpoint {
    /// A moment of the run of a scene.
    pub fn new(scene: &SceneRecord, state: SavedState, memory: Memory) -> Self {
        Checkpoint {
            program: env!("CARGO_PKG_VERSION").to_string(),
            scene: serde_json::to_string(scene).expect("a scene is plain data whose keys are text"),
            state,
            memory: memory.into_values(),
            sections: Vec::new(),
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
        replace_for_good(path, |file| {
            file.write_all(&first_line())?;
            let mut sections = Sections::new(form);
            Sections::of_state(&self.state, &mut |shares| file.write_all(&sections.add(shares)))?;
            self.write_head(file, (sections.list, form))
        })
    }

    /// Writes one of the present state of a simulation that ranks share, each with sections of its own, in the same
    /// way; `state` is all of it but particles.
    ///
    /// # Errors
    /// The disk of one of them is full or refuses, or nobody shares the simulation; then nothing is left of it.
    pub fn write_shared(
        &self,
        (path, form): (&Path, CheckpointForm),
        simulation: &dyn Simulation,
    ) -> Result<(), OutputError> {
        replace_by(path, |part| {
            let sections = shared::write_sections(simulation, (part, form))?;
            let mut file = OpenOptions::new().write(true).open(part)?;
            file.seek(SeekFrom::Start(sections.last().map_or(START as u64, Section::end)))?;
            self.write_head(&mut file, (sections, form))?;
            file.sync_all()
        })?;
        secure_name(path)
    }

    /// Writes the head behind sections.
    fn write_head(
        &self,
        file: &mut dyn Write,
        (sections, form): (Vec<Section>, CheckpointForm),
    ) -> io::Result<()> {
        let place = sections.last().map_or(START as u64, Section::end);
        let (is_packed, head) = work(|| {
            let head = Checkpoint {
                program: self.program.clone(),
                scene: self.scene.clone(),
                state: self.state.without_particles(),
                memory: self.memory.clone(),
                sections,
            };
            rmp_serde::to_vec_named(&head).map(|head| sections::packed(head, form)).map_err(io_error)
        })?;
        let mut summed = Summed { file, sum: Sha256::new_with_prefix(first_line()) };
        summed.write_all(&head)?;
        summed.write_all(&[u8::from(is_packed)])?;
        summed.write_all(&place.to_le_bytes())?;
        let Summed { file, sum } = summed;
        file.write_all(&sum.finalize())
    }

    /// Reads one, with all its particles.
    ///
    /// # Errors
    /// It is missing, damaged, of another version of the format, or no checkpoint.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let mut checkpoint = Self::open(path)?;
        checkpoint.fill(path)?;
        Ok(checkpoint)
    }

    /// Reads all that one has but particles, and looks whether these are there as they were written.
    ///
    /// # Errors
    /// It is missing, damaged, of another version of the format, or no checkpoint.
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        let open = || -> Result<Checkpoint, ReadProblem> {
            let mut file = open_file(path)?;
            let length = file.metadata()?.len();
            let mut line = [0; START];
            if length < (START + SUM) as u64
                || file.read_exact(&mut line).is_err()
                || !line.starts_with(MAGIC)
            {
                return Err(layout("it is no checkpoint of stickslip"));
            }
            let version = line[MAGIC.len()..].try_into().map(u32::from_le_bytes).unwrap_or_default();
            match version {
                VERSION => Self::open_head(&mut file, length),
                version if version > LAST => Err(damaged()),
                _ => {
                    let known = format!("this program reads version {VERSION}");
                    Err(layout(&format!("it is of version {version} of the format; {known}")))
                }
            }
        };
        open().map_err(|problem| problem.at(path))
    }

    /// All but particles, of a file of this length.
    fn open_head(file: &mut File, length: u64) -> Result<Self, ReadProblem> {
        const END: usize = size_of::<u8>() + size_of::<u64>() + SUM;
        let mut end = [0; END];
        file.seek(SeekFrom::Start(length.saturating_sub(END as u64)))?;
        file.read_exact(&mut end).map_err(|_| damaged())?;
        let ([is_packed], place, sum) = (&end[..1], &end[1..END - SUM], &end[END - SUM..]) else {
            return Err(damaged());
        };
        let place = u64::from_le_bytes(place.try_into().expect("it has eight bytes"));
        let size = length.checked_sub(END as u64).and_then(|end| end.checked_sub(place));
        let size = size.filter(|_| place >= START as u64).ok_or_else(damaged)?;
        file.seek(SeekFrom::Start(place))?;
        let mut head = Vec::new();
        file.take(size).read_to_end(&mut head)?;
        let mut found = Sha256::new_with_prefix(first_line());
        found.update(&head);
        found.update([*is_packed]);
        found.update(place.to_le_bytes());
        if found.finalize()[..] != *sum {
            return Err(damaged());
        }
        let checkpoint: Checkpoint = sections::unpacked((*is_packed == 1, &head))?;
        let mut begin = START as u64;
        for section in &checkpoint.sections {
            if section.place() != begin || section.end() > place {
                return Err(damaged());
            }
            section.check(file)?;
            begin = section.end();
        }
        if begin == place { Ok(checkpoint) } else { Err(damaged()) }
    }

    /// Gives the state the particles that it has in sections.
    ///
    /// # Errors
    /// They cannot be read.
    pub fn fill(&mut self, path: &Path) -> Result<(), ReadError> {
        let mut fill = || -> Result<(), ReadProblem> {
            let sections = std::mem::take(&mut self.sections);
            if sections.is_empty() {
                return Ok(());
            }
            let mut file = open_file(path)?;
            let mut of_bodies: Vec<Vec<_>> = self.state.bodies.iter().map(|_| Vec::new()).collect();
            for share in sections.iter().map(|section| section.read(&mut file)) {
                for share in share? {
                    let of_body = of_bodies.get_mut(share.body);
                    of_body.ok_or_else(|| layout("it has particles of no body"))?.push(share);
                }
            }
            let filled = self.state.bodies.iter_mut().zip(of_bodies).all(|(body, shares)| body.fill(shares));
            if filled { Ok(()) } else { Err(layout("its particles have not all the same columns")) }
        };
        fill().map_err(|problem| problem.at(path))
    }

    /// Where the particles lie, if there are any.
    pub fn particles(&self, path: &Path) -> Option<ParticlesThere> {
        (!self.sections.is_empty()).then(|| ParticlesThere::in_sections(path, &self.sections))
    }

    /// Lets a simulation of its scene take it up: by each rank some of its particles, where ranks share it.
    ///
    /// # Errors
    /// Its particles cannot be read; or it is of another scene, which the inner one says.
    pub fn restore(
        mut self,
        path: &Path,
        simulation: &mut dyn Simulation,
    ) -> Result<Result<(), RestoreError>, ReadError> {
        if let Some(particles) = self.particles(path)
            && let Some(restored) = shared::restore(simulation, &self.state, &particles)
        {
            return match restored {
                Err(NotTakenUp::Unfound(problem)) => Err(layout(&problem).at(path)),
                Err(NotTakenUp::Other(problem)) => Ok(Err(problem)),
                Ok(()) => Ok(Ok(())),
            };
        }
        self.fill(path)?;
        Ok(simulation.restore(self.state))
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

    /// The newest checkpoint in the folder of a run that can be [opened](Checkpoint::open), where it lies, and why
    /// newer ones cannot.
    ///
    /// # Errors
    /// There is none, or none can be read.
    pub fn newest(folder: &Path) -> Result<(Self, PathBuf, Vec<ReadError>), ReadError> {
        let mut damaged = Vec::new();
        for path in Self::list(folder)? {
            match Self::open(&path) {
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
                .and_then(whole_name)
                .is_some_and(|name| is_checkpoint(name) || of_checkpoint(name).is_some())
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

    /// Removes what lies beside the place of a checkpoint that is not there.
    pub fn clear_beside(path: &Path) {
        if !path.exists() {
            // What stays goes with the next one that is written.
            let _ = fs::remove_file(path.with_extension("vtu"));
        }
    }

    /// Removes all but the newest checkpoints of a run, and what belongs to none of these.
    ///
    /// # Errors
    /// One cannot be removed.
    pub fn keep_newest(folder: &Path, count: usize) -> Result<(), OutputError> {
        let all = Self::list(folder)
            .map_err(|error| OutputError { path: error.path, source: io_error(error.problem) })?;
        let (kept, old) = all.split_at(count.min(all.len()));
        let path = folder.join(CHECKPOINTS);
        let names = fs::read_dir(&path).into_iter().flatten().flatten().map(|entry| entry.file_name());
        let is_left = |name: &OsString| {
            let of = name.to_str().and_then(of_checkpoint);
            of.is_some_and(|checkpoint| !kept.contains(&path.join(checkpoint)))
        };
        let left: Vec<PathBuf> = names.filter(is_left).map(|name| path.join(name)).collect();
        old.iter().chain(&left).try_for_each(|path| fs::remove_file(path).map_err(OutputError::at(path)))
    }
}

/// How a checkpoint begins.
pub(super) fn first_line() -> [u8; START] {
    let mut line = [0; START];
    line[..MAGIC.len()].copy_from_slice(MAGIC);
    line[MAGIC.len()..].copy_from_slice(&VERSION.to_le_bytes());
    line
}

fn damaged() -> ReadProblem {
    layout("it is damaged: its bytes do not add up to its sum")
}

fn layout(what: &str) -> ReadProblem {
    ReadProblem::Layout(what.to_string())
}

/// What cannot be decoded although it is as it was written.
fn damage(error: &impl std::fmt::Display) -> ReadProblem {
    layout(&format!("it is damaged: {error}"))
}

/// The name of the checkpoint to which a frame beside it belongs: that of `0000012345.vtu`.
fn of_checkpoint(name: &str) -> Option<String> {
    let checkpoint = format!("{}.checkpoint", name.strip_suffix(".vtu")?);
    is_checkpoint(&checkpoint).then_some(checkpoint)
}

/// `0000012345.checkpoint`.
pub(super) fn is_checkpoint(name: &str) -> bool {
    let digits = name.strip_suffix(".checkpoint");
    digits.is_some_and(|digits| digits.len() >= 10 && digits.bytes().all(|byte| byte.is_ascii_digit()))
}

impl Checkpoint {
    /// The bytes of a checkpoint that has a section with these bytes, and else what a head says: sound by its sums
    /// whatever they are, so that one can try what reading makes of it. None where the head is none.
    #[doc(hidden)]
    pub fn sealed(section: &[u8], head: &[u8]) -> Option<Vec<u8>> {
        let checkpoint: Checkpoint = rmp_serde::from_slice(head).ok()?;
        let mut bytes = [&first_line()[..], section].concat();
        let sections = vec![Section::sealed(section).at(START as u64)];
        checkpoint.write_head(&mut bytes, (sections, CheckpointForm::Plain)).ok()?;
        Some(bytes)
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
    use flate2::Compression;
    use flate2::write::ZlibEncoder;

    /// One without sections, with a head that is packed.
    fn file(version: u32, head: &[u8]) -> Vec<u8> {
        let place = (START as u64).to_le_bytes();
        let mut bytes = [&MAGIC[..], &version.to_le_bytes(), head, &[1], &place].concat();
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
        for head in [&b"no zlib"[..], &[], &whole, &whole[..whole.len() / 2], &zipped(b"\xc0")] {
            fs::write(&path, file(VERSION, head)).unwrap();
            let told = refused(&path);
            assert!(told.contains("it is damaged") && !told.contains("do not add up"), "{told}");
        }
        fs::write(&path, file(VERSION + 1, &whole)).unwrap();
        assert!(refused(&path).contains("this program reads version"), "{}", refused(&path));
    }
}
