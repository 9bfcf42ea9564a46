//! Whether the files of results are as the run wrote them.

use super::checkpoint::Checkpoint;
use super::file::{FileSum, ReadError, ReadProblem, open_file};
use super::frames::{FrameFile, SeriesFiles};
use super::manifest::Manifest;
use super::memory::Memory;
use super::recorder::tables;
use super::results::Results;
use super::{FRINGES, FRINGES_TABLE, GRID, PARTICLES, SURFACES};
use crate::image::Image;
use crate::scene::SeriesFormat;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What was found of the files of results.
#[derive(Debug, Default)]
pub struct Verified {
    /// Files that were looked at.
    pub files: usize,
    /// Of these, how many were held against a sum that the newest checkpoint has of them. The others hold sums of their
    /// own, or are tables that can be read.
    pub summed: usize,
    /// What is not as the run wrote it.
    pub wrong: Vec<ReadError>,
}

/// Reads all files of results: holds them against the sums that the newest checkpoint has of them, and what was written
/// later against the sums in the files themselves.
///
/// # Errors
/// The folder holds no record of a run, or cannot be read. What is wrong with its files is found, not an error.
pub fn verify(folder: &Path) -> Result<Verified, ReadError> {
    let results = Results::open(folder)?;
    let mut verified = Verified::default();
    verified.note(Manifest::verify(folder));
    let mut newest = None;
    for path in Checkpoint::list(folder)? {
        let read = Checkpoint::open(&path);
        verified.note(read.map(|mut checkpoint| {
            newest.get_or_insert_with(|| checkpoint.memory(&path));
        }));
    }
    let sums = newest.map_or_else(|| Ok(Sums::default()), |mut memory| Sums::of(folder, &mut memory))?;
    verified.tables(&results, &sums);
    for (path, sum) in &sums.files {
        verified.note(sum.check(path));
        verified.summed += 1;
    }
    let later = |path: &Path| !sums.files.contains_key(path);
    let [particles, surfaces, grid] =
        [PARTICLES, SURFACES, GRID].map(|name| SeriesFiles::find(folder, name, SeriesFormat::Vtu));
    for files in [&particles, &surfaces, &grid].into_iter().filter(|files| files.list().exists()) {
        verified.note(files.check_list());
    }
    let others = [surfaces, grid].map(|files| files.frames().unwrap_or_default()).concat();
    for frame in results.frames().iter().chain(&others).filter(|frame| later(&frame.path)) {
        verified.note(FrameFile::check(&frame.path));
    }
    let pictures = results.fringes_table().unwrap_or_default();
    for path in pictures.iter().map(|row| picture(folder, row.frame)).filter(|path| later(path)) {
        verified.note(Image::read_png(&path).map(drop).map_err(|error| ReadProblem::Io(error).at(&path)));
    }
    Ok(verified)
}

/// Holds a snapshot against the sum that the newest checkpoint of its run has of it: of those that are written without
/// compression, whose blocks have no sums of their own. Without a checkpoint that knows it nothing is told.
///
/// # Errors
/// It is not as the run wrote it.
pub fn verify_snapshot(folder: &Path, snapshot: &Path) -> Result<(), ReadError> {
    let Ok((mut checkpoint, path, _)) = Checkpoint::newest(folder) else { return Ok(()) };
    let sums = Sums::of(folder, &mut checkpoint.memory(&path))?;
    sums.files.get(snapshot).map_or(Ok(()), |sum| sum.check(snapshot))
}

impl Verified {
    fn note(&mut self, found: Result<(), ReadError>) {
        self.files += 1;
        self.wrong.extend(found.err());
    }

    /// Each table by its sum, as far as that reaches, and all of it by reading it.
    fn tables(&mut self, results: &Results, sums: &Sums) {
        for (path, sum) in &sums.tables {
            let start = open_file(path).and_then(|mut file| FileSum::of(&mut file, sum.bytes));
            let start = start.map_err(ReadProblem::Io);
            let found = start.and_then(|start| if start == *sum { Ok(()) } else { Err(sum.differs(start)) });
            self.note(found.map_err(|problem| problem.at(path)));
            self.summed += 1;
        }
        let read = [
            results.bodies_table().err(),
            results.energy_table().err(),
            results.contacts_table().err(),
            results.loads_table().err(),
            results.joints_table().err(),
            results.sections_table().err(),
            results.reactions_table().err(),
            results.groups_table().err(),
            results.group_contacts_table().err(),
            results.fabric_table().err(),
            results.tractions_table().err(),
            results.removed_table().err(),
            results.probes_table().err(),
            results.arrivals_table().err(),
            results.fronts_table().err(),
            results.front_speeds_table().err(),
            results.fringes_table().err(),
        ];
        for error in read.into_iter().flatten() {
            if self.wrong.iter().all(|known| known.path != error.path) {
                self.files += usize::from(!sums.tables.contains_key(&error.path));
                self.wrong.push(error);
            }
        }
    }
}

/// What is in the table of fringes, among what is kept of the camera's film.
#[derive(Default, Serialize, Deserialize)]
struct FringesTable {
    table: FileSum,
}

/// What a checkpoint knows of files.
#[derive(Default)]
struct Sums {
    /// Of whole files.
    files: BTreeMap<PathBuf, FileSum>,
    /// Of the first bytes of tables.
    tables: BTreeMap<PathBuf, FileSum>,
}

impl Sums {
    fn of(folder: &Path, memory: &mut Memory) -> Result<Self, ReadError> {
        let mut sums = Sums::default();
        let unreadable = |error: super::OutputError| ReadProblem::Io(error.source).at(&error.path);
        for (name, part) in tables() {
            let mut sum = FileSum::default();
            let known = memory.part(&part, |memory| {
                Ok(memory.keep("length", &mut sum.bytes)? && memory.keep("sum", &mut sum.crc)?)
            });
            if known.map_err(unreadable)? {
                sums.tables.insert(folder.join(name), sum);
            }
        }
        let mut fringes = FringesTable::default();
        if memory.part(FRINGES, |memory| memory.keep("film", &mut fringes)).map_err(unreadable)? {
            sums.tables.insert(folder.join(FRINGES_TABLE), fringes.table);
        }
        for name in [PARTICLES, SURFACES, GRID, FRINGES] {
            let mut files: Vec<FileSum> = Vec::new();
            memory.part(name, |memory| memory.keep("sums", &mut files)).map_err(unreadable)?;
            let series = SeriesFiles::find(folder, name, SeriesFormat::Vtu);
            let path = |number: usize| match name {
                FRINGES => picture(folder, number),
                _ => series.path(number),
            };
            sums.files.extend(files.into_iter().enumerate().map(|(number, sum)| (path(number), sum)));
        }
        Ok(sums)
    }
}

/// Where a picture of fringes lies.
fn picture(folder: &Path, number: usize) -> PathBuf {
    folder.join(format!("{FRINGES}/{number:05}.png"))
}
