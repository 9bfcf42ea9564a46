//! Snapshots through time: numbered `.vtu` files, and the `.pvd` file that tells ParaView their times.

use super::file::{OutputError, ReadError, ReadProblem, replace};
use super::folder::OutputFolder;
use super::vtu::Vtu;
use super::xml::attribute;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::fs;
use std::path::{Path, PathBuf};

/// A snapshot of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Simulated time [s].
    pub time: f64,
    /// The `.vtu` file.
    pub path: PathBuf,
}

/// A growing series of snapshots. The `.pvd` file lists those that are complete, at any time.
pub(super) struct Frames {
    folder: OutputFolder,
    name: &'static str,
    times: Vec<f64>,
}

impl Frames {
    /// An empty series: `name.pvd`, and files in the folder `name`.
    pub(super) fn create(folder: &OutputFolder, name: &'static str) -> Result<Self, OutputError> {
        let path = folder.join(name);
        fs::create_dir_all(&path).map_err(OutputError::at(&path))?;
        let frames = Frames { folder: folder.clone(), name, times: Vec::new() };
        frames.write_collection()?;
        Ok(frames)
    }

    /// Adds a snapshot at a time [s]; a second one at the time of the last takes its place.
    ///
    /// # Errors
    /// The disk is full or refuses; then the series stays as it was.
    pub(super) fn push(&mut self, time: f64, snapshot: &Vtu) -> Result<(), OutputError> {
        let new = self.times.last() != Some(&time);
        let number = self.times.len() - usize::from(!new);
        snapshot.write(&self.folder.join(&self.file(number)))?;
        if new {
            self.times.push(time);
            self.write_collection()?;
        }
        Ok(())
    }

    fn file(&self, number: usize) -> String {
        format!("{}/{number:05}.vtu", self.name)
    }

    fn write_collection(&self) -> Result<(), OutputError> {
        replace(&self.folder.join(&format!("{}.pvd", self.name)), |xml| {
            writeln!(xml, "<?xml version=\"1.0\"?>")?;
            writeln!(xml, "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">")?;
            writeln!(xml, "<Collection>")?;
            for (number, time) in self.times.iter().enumerate() {
                let file = self.file(number);
                writeln!(xml, "<DataSet timestep=\"{time:e}\" part=\"0\" file=\"{file}\"/>")?;
            }
            writeln!(xml, "</Collection>")?;
            writeln!(xml, "</VTKFile>")
        })
    }
}

/// The snapshots that a `.pvd` file lists.
pub(super) fn read_frames(path: &Path) -> Result<Vec<Frame>, ReadError> {
    let read = || -> Result<Vec<Frame>, ReadProblem> {
        let xml = fs::read_to_string(path)?;
        let mut reader = Reader::from_str(&xml);
        let mut frames = Vec::new();
        loop {
            match reader.read_event()? {
                Event::Empty(tag) if tag.name().0 == "DataSet" => frames.push(frame(&tag, path)?),
                Event::Eof => return Ok(frames),
                _ => {}
            }
        }
    };
    read().map_err(|problem| problem.at(path))
}

fn frame(tag: &BytesStart, collection: &Path) -> Result<Frame, ReadProblem> {
    let file: String = attribute(tag, "file")?;
    Ok(Frame { time: attribute(tag, "timestep")?, path: collection.with_file_name(file) })
}
