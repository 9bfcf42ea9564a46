//! Snapshots through time: numbered `.vtu` files, and the `.pvd` file that tells ParaView their times.

use super::file::{OutputError, ReadError, ReadProblem, replace};
use super::folder::OutputFolder;
use super::vtu::Vtu;
use super::writer::Writer;
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

/// A growing series of snapshots, written by a thread of its own. The `.pvd` file lists those that are complete,
/// at any time.
pub(super) struct Frames {
    writer: Writer<Series>,
}

impl Frames {
    /// An empty series: `name.pvd`, and files in the folder `name`.
    pub(super) fn create(folder: &OutputFolder, name: &'static str) -> Result<Self, OutputError> {
        let path = folder.join(name);
        fs::create_dir_all(&path).map_err(OutputError::at(&path))?;
        let series = Series { folder: folder.clone(), name, times: Vec::new() };
        series.write_collection()?;
        Ok(Frames { writer: Writer::start(series).map_err(OutputError::at(&path))? })
    }

    /// Waits until there is room in memory for another snapshot: to be called before one is made.
    ///
    /// # Errors
    /// An earlier snapshot could not be written: the disk is full or refuses; then the series ends before it.
    pub(super) fn make_room(&mut self) -> Result<(), OutputError> {
        self.writer.make_room()
    }

    /// Hands over a snapshot at a time [s] that takes so many bytes; a second one at the time of the last takes its
    /// place.
    pub(super) fn push(&mut self, time: f64, bytes: usize, encode: impl FnOnce() -> Vtu + Send + 'static) {
        self.writer.hand_over(bytes, move |series| series.push(time, &encode()));
    }

    /// Waits until everything is written.
    ///
    /// # Errors
    /// As [`Frames::make_room`].
    pub(super) fn finish(&mut self) -> Result<(), OutputError> {
        self.writer.finish()
    }
}

/// The files of a series.
struct Series {
    folder: OutputFolder,
    name: &'static str,
    times: Vec<f64>,
}

impl Series {
    /// Adds a snapshot; after an error the series is as it was.
    fn push(&mut self, time: f64, snapshot: &Vtu) -> Result<(), OutputError> {
        if self.times.last() == Some(&time) {
            return snapshot.write(&self.path(self.times.len() - 1));
        }
        let path = self.path(self.times.len());
        snapshot.write(&path)?;
        self.times.push(time);
        self.write_collection().inspect_err(|_| {
            // A snapshot that no list names only takes the room that the record of the failed run needs.
            let _ = fs::remove_file(&path);
            self.times.pop();
        })
    }

    fn path(&self, number: usize) -> PathBuf {
        self.folder.join(&self.file(number))
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
