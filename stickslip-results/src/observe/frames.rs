//! Snapshots through time: numbered files, and the list that tells their times: for ParaView's own a `.pvd`, else a
//! table.

use super::file::{
    FileSum, OutputError, ReadError, ReadProblem, is_there, read_bytes, remove_from, replace, replace_by,
    replace_summed, secure,
};
use super::folder::OutputFolder;
use super::memory::Memory;
use super::vtk::{PointArrays, TIME, VtkFile};
use super::work::work;
use super::writer::Writer;
use super::xml::attribute;
use crate::scene::SeriesFormat;
use crate::surface::model::Model;
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
    /// The file.
    pub path: PathBuf,
}

/// A snapshot as a file, ready to be written: it borrows nothing, so that another thread may write it.
pub(super) enum FrameFile {
    /// For ParaView.
    Vtk(VtkFile),
    /// In glTF.
    Model(Model),
}

impl FrameFile {
    /// Writes it; it appears under its name once complete.
    ///
    /// # Errors
    /// The disk is full or refuses, or the file would be larger than its format allows; then no file of this name
    /// appears.
    fn put(&self, path: &Path) -> Result<FileSum, OutputError> {
        match self {
            FrameFile::Vtk(file) => file.put(path),
            FrameFile::Model(model) => {
                let bytes = model.encode().map_err(OutputError::at(path))?;
                replace_summed(path, |file| file.write_all(&bytes))
            }
        }
    }

    /// Reads all of a file, as far as it can tell by itself whether it is whole.
    ///
    /// # Errors
    /// Something is cut short or damaged.
    pub(super) fn check(path: &Path) -> Result<(), ReadError> {
        if path.extension().is_none_or(|kind| kind != ending(SeriesFormat::Glb)) {
            return PointArrays::open(path)?.check();
        }
        let bytes = read_bytes(path).map_err(|error| ReadProblem::Io(error).at(path))?;
        Model::check(&bytes).map_err(|what| ReadProblem::Layout(format!("no {what}")).at(path))
    }
}

impl From<VtkFile> for FrameFile {
    fn from(file: VtkFile) -> Self {
        FrameFile::Vtk(file)
    }
}

/// A growing series of snapshots, written by a thread of its own. Its list has those that are complete, at any time.
pub(super) struct Frames {
    writer: Writer<Series>,
}

impl Frames {
    /// A series, the list `name.pvd` or `name.csv` and files in the folder `name`: empty, or what is there of a run
    /// that goes on, in its format.
    pub(super) fn create(
        folder: &OutputFolder,
        name: &'static str,
        format: SeriesFormat,
    ) -> Result<Self, OutputError> {
        let path = folder.join(name);
        fs::create_dir_all(&path).map_err(OutputError::at(&path))?;
        let files = SeriesFiles::find(folder.path(), name, format);
        let series = Series { files, times: Vec::new(), sums: Vec::new(), secured: 0 };
        // That of a run that goes on stays until it is cut.
        if !series.files.list().exists() {
            series.write_list()?;
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

    /// Hands over a snapshot at a time [s] that takes so many bytes, to be made in the format of the series; a second
    /// one at the time of the last takes its place.
    pub(super) fn push(
        &mut self,
        time: f64,
        bytes: usize,
        encode: impl FnOnce(SeriesFormat) -> FrameFile + Send + 'static,
    ) {
        self.writer.hand_over(bytes, move |series| {
            let file = work(|| encode(series.files.format));
            series.push(time, &file)
        });
    }

    /// Adds a snapshot at a time [s] that `write` puts under a name of its own, before it gets the name that it has in
    /// the series; a second one at the time of the last takes its place.
    ///
    /// # Errors
    /// The disk is full or refuses, now or at an earlier snapshot; then the series is as it was.
    pub(super) fn put(
        &mut self,
        time: f64,
        write: impl FnOnce(&Path) -> io::Result<FileSum>,
    ) -> Result<(), OutputError> {
        let path = self.writer.ask(move |series| Ok(series.next_path(time)))?;
        let sum = self.put_at(&path, write)?;
        self.writer.ask(move |series| series.list(time, sum))
    }

    /// Makes a file that is none of the series in the same way.
    ///
    /// # Errors
    /// The disk is full or refuses.
    pub(super) fn put_at(
        &self,
        path: &Path,
        write: impl FnOnce(&Path) -> io::Result<FileSum>,
    ) -> Result<FileSum, OutputError> {
        replace_by(path, |part| self.writer.waiting().watch(path, || write(part)))
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

/// Where the files of a series lie.
pub(super) struct SeriesFiles {
    /// That of the run.
    folder: PathBuf,
    name: &'static str,
    format: SeriesFormat,
}

/// How names of files of a format end.
fn ending(format: SeriesFormat) -> &'static str {
    match format {
        SeriesFormat::Vtu => "vtu",
        SeriesFormat::Vtp => "vtp",
        SeriesFormat::Glb => "glb",
    }
}

impl SeriesFiles {
    /// Those that are there, or else those in a format: the list tells which a run wrote.
    pub(super) fn find(folder: &Path, name: &'static str, otherwise: SeriesFormat) -> Self {
        let of = |format| SeriesFiles { folder: folder.to_path_buf(), name, format };
        let is_there = |files: &SeriesFiles| {
            let frames = files.frames().unwrap_or_default();
            frames.first().is_some_and(|frame| files.path(0) == frame.path)
        };
        let known = [SeriesFormat::Vtu, SeriesFormat::Vtp, SeriesFormat::Glb].map(of);
        known.into_iter().find(is_there).unwrap_or_else(|| of(otherwise))
    }

    /// The list of files and their times.
    pub(super) fn list(&self) -> PathBuf {
        let kind = if self.format == SeriesFormat::Glb { "csv" } else { "pvd" };
        self.folder.join(format!("{}.{kind}", self.name))
    }

    /// The snapshots that the list has.
    ///
    /// # Errors
    /// It is missing, or not as a run writes it.
    pub(super) fn frames(&self) -> Result<Vec<Frame>, ReadError> {
        if self.format == SeriesFormat::Glb { read_table(&self.list()) } else { read_frames(&self.list()) }
    }

    /// Whether the list is what a run writes for its snapshots, with the times that these have.
    ///
    /// # Errors
    /// It is not, or cannot be read.
    pub(super) fn check_list(&self) -> Result<(), ReadError> {
        let list = self.list();
        let wrong = |what: String| ReadProblem::Layout(what).at(&list);
        let frames = self.frames()?;
        let times: Vec<f64> = frames.iter().map(|frame| frame.time).collect();
        let found = read_bytes(&list).map_err(|error| ReadProblem::Io(error).at(&list))?;
        if found != self.listing(&times).as_bytes() {
            return Err(wrong("it is no list that a run wrote: bytes of it have changed".to_string()));
        }
        if self.format == SeriesFormat::Glb {
            return Ok(());
        }
        for frame in &frames {
            // What is wrong with a snapshot is told of it.
            let Ok(time) = PointArrays::open(&frame.path).and_then(|points| points.field(TIME)) else {
                continue;
            };
            if time != frame.time {
                let name = frame.path.file_name().unwrap_or_default().display();
                return Err(wrong(format!("it has {name} at t = {:e} s, which says {time:e} s", frame.time)));
            }
        }
        Ok(())
    }

    /// The list for snapshots at these times.
    fn listing(&self, times: &[f64]) -> String {
        let files = times.iter().enumerate().map(|(number, time)| (time, self.file(number)));
        if self.format == SeriesFormat::Glb {
            let rows = files.map(|(time, file)| format!("{time:e},{file}\n"));
            return format!("{TABLE_HEADER}\n{}", rows.collect::<String>());
        }
        let rows = files
            .map(|(time, file)| format!("<DataSet timestep=\"{time:e}\" part=\"0\" file=\"{file}\"/>\n"));
        format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" \
             byte_order=\"LittleEndian\">\n<Collection>\n{}</Collection>\n</VTKFile>\n",
            rows.collect::<String>()
        )
    }

    /// The file of a snapshot.
    pub(super) fn path(&self, number: usize) -> PathBuf {
        self.folder.join(self.file(number))
    }

    fn file(&self, number: usize) -> String {
        format!("{}/{number:05}.{}", self.name, ending(self.format))
    }
}

/// A series that grows.
struct Series {
    files: SeriesFiles,
    times: Vec<f64>,
    /// Of each, what is in its file.
    sums: Vec<FileSum>,
    /// How many of them are known to be on the disk.
    secured: usize,
}

impl Series {
    /// Adds a snapshot; after an error the series is as it was.
    fn push(&mut self, time: f64, snapshot: &FrameFile) -> Result<(), OutputError> {
        let sum = snapshot.put(&self.next_path(time))?;
        self.list(time, sum)
    }

    /// Where the next snapshot lies: at the time of the last, in its place.
    fn next_path(&self, time: f64) -> PathBuf {
        let again = usize::from(self.times.last() == Some(&time));
        self.files.path(self.times.len() - again)
    }

    /// Puts a snapshot that is there on the list; after an error the series is as it was.
    fn list(&mut self, time: f64, sum: FileSum) -> Result<(), OutputError> {
        if self.times.last() == Some(&time) {
            let last = self.times.len() - 1;
            self.secured = self.secured.min(last);
            self.sums[last] = sum;
            return Ok(());
        }
        let path = self.next_path(time);
        self.sums.push(sum);
        self.times.push(time);
        self.write_list().inspect_err(|_| {
            // A snapshot that no list names only takes the room that the record of the failed run needs.
            let _ = fs::remove_file(&path);
            self.times.pop();
            self.sums.pop();
        })
    }

    /// Waits until all of it is on the disk.
    fn secure(&mut self) -> Result<(), OutputError> {
        for path in (self.secured..self.times.len()).map(|number| self.files.path(number)) {
            secure(&path)?;
        }
        self.secured = self.times.len();
        secure(&self.files.list())?;
        secure(&self.files.folder.join(self.files.name))
    }

    /// Takes away all but the snapshots at these times.
    fn cut(
        &mut self,
        (mut times, mut sums): (Vec<f64>, Vec<FileSum>),
        in_earnest: bool,
    ) -> Result<(), OutputError> {
        times.truncate(sums.len());
        sums.truncate(times.len());
        (sums.iter().enumerate())
            .try_for_each(|(number, sum)| is_there(&self.files.path(number), Some(sum)))?;
        if !in_earnest {
            return Ok(());
        }
        (self.times, self.sums) = (times, sums);
        self.secured = self.secured.min(self.times.len());
        remove_from((self.times.len()..).map(|number| self.files.path(number)))?;
        self.write_list()
    }

    fn write_list(&self) -> Result<(), OutputError> {
        let text = self.files.listing(&self.times);
        replace(&self.files.list(), |list| list.write_all(text.as_bytes()))
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

/// The first line of a list that is a table.
const TABLE_HEADER: &str = "time,path";

/// The snapshots that such a list has.
fn read_table(path: &Path) -> Result<Vec<Frame>, ReadError> {
    let read = || -> Result<Vec<Frame>, ReadProblem> {
        let bytes = read_bytes(path)?;
        let mut reader = csv::Reader::from_reader(&bytes[..]);
        let rows: Result<Vec<(f64, String)>, csv::Error> = reader.deserialize().collect();
        let frame = |(time, file): (f64, String)| Ok(Frame { time, path: listed(&file, path)? });
        rows?.into_iter().map(frame).collect()
    };
    read().map_err(|problem| problem.at(path))
}

fn frame(tag: &BytesStart, list: &Path) -> Result<Frame, ReadProblem> {
    let file: String = attribute(tag, "file")?;
    Ok(Frame { time: attribute(tag, "timestep")?, path: listed(&file, list)? })
}

/// A file that a list names: one of its folder.
fn listed(file: &str, list: &Path) -> Result<PathBuf, ReadProblem> {
    let inside = Path::new(file).components().all(|part| matches!(part, Component::Normal(_)));
    if !inside || file.is_empty() {
        return Err(ReadProblem::Layout(format!("it lists `{file}`, which is no file of the folder")));
    }
    Ok(list.with_file_name(file))
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
    fn the_format_of_a_series_is_that_of_its_files() {
        let folder = tempfile::tempdir().unwrap();
        let find = || SeriesFiles::find(folder.path(), "surfaces", SeriesFormat::Vtp).format;
        assert_eq!(find(), SeriesFormat::Vtp, "as wanted where there are none");
        fs::write(folder.path().join("surfaces.csv"), "time,path\n0e0,surfaces/00000.glb\n").unwrap();
        assert_eq!(find(), SeriesFormat::Glb);
        let files = SeriesFiles::find(folder.path(), "surfaces", SeriesFormat::Vtu);
        assert_eq!(files.frames().unwrap(), [Frame { time: 0.0, path: files.path(0) }]);
    }

    #[test]
    #[cfg(unix)]
    fn a_device_in_the_place_of_a_list_is_refused() {
        let error = read_frames(Path::new("/dev/zero")).unwrap_err().to_string();
        assert!(error.contains("it is no file"), "{error}");
    }
}
