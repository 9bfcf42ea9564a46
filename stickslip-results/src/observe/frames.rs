//! Snapshots through time: numbered `.vtu` files, and the `.pvd` file that tells ParaView their times.

use super::file::{
    FileSum, OutputError, ReadError, ReadProblem, is_there, read_bytes, remove_from, replace, secure,
};
use super::folder::OutputFolder;
use super::memory::Memory;
use super::vtu::Vtu;
use super::writer::Writer;
use super::xml::attribute;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

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
    /// A series, `name.pvd` and files in the folder `name`: empty, or what is there of a run that goes on.
    pub(super) fn create(folder: &OutputFolder, name: &'static str) -> Result<Self, OutputError> {
        let path = folder.join(name);
        fs::create_dir_all(&path).map_err(OutputError::at(&path))?;
        let series = Series { folder: folder.clone(), name, times: Vec::new(), sums: Vec::new(), secured: 0 };
        // That of a run that goes on stays until it is cut.
        if !series.collection().exists() {
            series.write_collection()?;
        }
        Ok(Frames { writer: Writer::start(series, &path, folder.waiting())? })
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

    /// Keeps which snapshots there are, or takes away those that were made later.
    ///
    /// # Errors
    /// The disk is full or refuses; a snapshot is missing.
    pub(super) fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        // What the checkpoint does not know was not there.
        let (mut times, mut sums) = match memory.is_taking_up() {
            true => Default::default(),
            false => self.writer.ask(|series| {
                series.secure()?;
                Ok((series.times.clone(), series.sums.clone()))
            })?,
        };
        memory.keep("times", &mut times)?;
        memory.keep("sums", &mut sums)?;
        let in_earnest = memory.is_in_earnest();
        if memory.is_taking_up() {
            self.writer.ask(move |series| series.cut((times, sums), in_earnest))
        } else {
            Ok(())
        }
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
    /// Of each, what is in its file; unknown of those that are older than sums.
    sums: Vec<Option<FileSum>>,
    /// How many of them are known to be on the disk.
    secured: usize,
}

impl Series {
    /// Adds a snapshot; after an error the series is as it was.
    fn push(&mut self, time: f64, snapshot: &Vtu) -> Result<(), OutputError> {
        if self.times.last() == Some(&time) {
            let last = self.times.len() - 1;
            self.secured = self.secured.min(last);
            self.sums[last] = Some(snapshot.put(&self.path(last))?);
            return Ok(());
        }
        let path = self.path(self.times.len());
        self.sums.push(Some(snapshot.put(&path)?));
        self.times.push(time);
        self.write_collection().inspect_err(|_| {
            // A snapshot that no list names only takes the room that the record of the failed run needs.
            let _ = fs::remove_file(&path);
            self.times.pop();
            self.sums.pop();
        })
    }

    /// Waits until all of it is on the disk.
    fn secure(&mut self) -> Result<(), OutputError> {
        for path in (self.secured..self.times.len()).map(|number| self.path(number)) {
            secure(&path)?;
        }
        self.secured = self.times.len();
        secure(&self.collection())?;
        secure(&self.folder.join(self.name))
    }

    /// Takes away all but the snapshots at these times.
    fn cut(
        &mut self,
        (times, mut sums): (Vec<f64>, Vec<Option<FileSum>>),
        in_earnest: bool,
    ) -> Result<(), OutputError> {
        sums.resize(times.len(), None);
        (sums.iter().enumerate()).try_for_each(|(number, sum)| is_there(&self.path(number), sum.as_ref()))?;
        if !in_earnest {
            return Ok(());
        }
        (self.times, self.sums) = (times, sums);
        self.secured = self.secured.min(self.times.len());
        remove_from((self.times.len()..).map(|number| self.path(number)))?;
        self.write_collection()
    }

    fn collection(&self) -> PathBuf {
        self.folder.join(&format!("{}.pvd", self.name))
    }

    fn path(&self, number: usize) -> PathBuf {
        self.folder.join(&self.file(number))
    }

    fn file(&self, number: usize) -> String {
        format!("{}/{number:05}.vtu", self.name)
    }

    fn write_collection(&self) -> Result<(), OutputError> {
        replace(&self.collection(), |xml| {
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
        let xml = String::from_utf8(read_bytes(path)?).map_err(io::Error::other)?;
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
    let inside = Path::new(&file).components().all(|part| matches!(part, Component::Normal(_)));
    if !inside || file.is_empty() {
        return Err(ReadProblem::Layout(format!("it lists `{file}`, which is no file of the folder")));
    }
    Ok(Frame { time: attribute(tag, "timestep")?, path: collection.with_file_name(file) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_names_files_of_its_folder_only() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("particles.pvd");
        let list = |file: &str| {
            let entry = format!("<DataSet timestep=\"0\" part=\"0\" file=\"{file}\"/>");
            fs::write(&path, format!("<Collection>{entry}</Collection>")).unwrap();
            read_frames(&path)
        };
        assert_eq!(list("particles/00000.vtu").unwrap()[0].path, folder.path().join("particles/00000.vtu"));
        for file in ["/dev/zero", "../other/00000.vtu", "a/../../b.vtu", "", "."] {
            let error = list(file).unwrap_err().to_string();
            assert!(error.contains("no file of the folder"), "{file}: {error}");
        }
    }

    #[test]
    #[cfg(unix)]
    fn a_device_in_the_place_of_a_list_is_refused() {
        let error = read_frames(Path::new("/dev/zero")).unwrap_err().to_string();
        assert!(error.contains("it is no file"), "{error}");
    }
}
