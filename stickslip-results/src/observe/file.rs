//! Files that are whole at any time, and what can go wrong with them.

use super::work::took;
use crate::scene::escaped;
use miette::Diagnostic;
use serde::{Deserialize, Serialize};
use std::ffi::OsStr;
use std::fmt::Display;
use std::fs::{self, File};
use std::hash::{BuildHasher, RandomState};
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

/// A file of results that could not be written.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[error("cannot write {}: {source}", path.display())]
#[diagnostic(help("{}", remedy(source)))]
pub struct OutputError {
    /// The file.
    pub path: PathBuf,
    /// What the operating system says.
    pub source: io::Error,
}

impl OutputError {
    /// That a number of a table is not finite: none of its rows is written.
    pub(super) fn no_number(path: &Path, what: String) -> Self {
        OutputError {
            path: path.to_path_buf(),
            source: io::Error::new(io::ErrorKind::InvalidData, NoNumber(what)),
        }
    }

    /// Whether it is that.
    pub fn is_no_number(&self) -> bool {
        self.source.get_ref().is_some_and(|inner| inner.is::<NoNumber>())
    }

    /// Ties an error of the operating system to the file at hand.
    pub(super) fn at(path: &Path) -> impl FnOnce(io::Error) -> OutputError + '_ {
        move |source| OutputError { path: path.to_path_buf(), source }
    }
}

/// A number of a table that is not finite.
#[derive(Debug, thiserror::Error)]
#[error("{0} is not a finite number")]
struct NoNumber(String);

fn remedy(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "free some space, or ask for outputs less often; everything written before can be read, and \
             `stickslip resume` goes on from the last checkpoint, or begins anew where there is none"
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "give a folder that you may write to"
        }
        io::ErrorKind::NotFound => {
            "was it moved or removed? `stickslip resume` goes on where it is now, or once it is back, from the last \
             checkpoint, or begins anew where there is none"
        }
        io::ErrorKind::TimedOut => {
            "see what is wrong with the disk; everything written before can be read, and `stickslip resume` goes on \
             from the last checkpoint, or begins anew where there is none"
        }
        _ => "everything written before can be read",
    }
}

/// A file of results that could not be read.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[error("cannot read {}: {problem}", path.display())]
#[diagnostic(help("give the folder that `stickslip run` wrote, complete and unchanged"))]
pub struct ReadError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub problem: ReadProblem,
}

/// Why a file of results could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadProblem {
    /// The operating system refuses.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// A table is not as a run writes it.
    #[error("{}", shown(.0))]
    Table(#[from] csv::Error),
    /// `run.json` is not as a run writes it.
    #[error("{}", shown(.0))]
    Manifest(#[from] serde_json::Error),
    /// A file for ParaView is not XML.
    #[error("{}", shown(.0))]
    Xml(#[from] quick_xml::Error),
    /// A file of a series, or its list, holds something other than a run writes.
    #[error("{}", shown(.0))]
    Layout(String),
}

/// A message that may have words of a file in it.
fn shown(message: &impl Display) -> String {
    escaped(&message.to_string())
}

impl ReadProblem {
    /// Names the file that has the problem.
    pub(super) fn at(self, path: &Path) -> ReadError {
        ReadError { path: path.to_path_buf(), problem: self }
    }
}

/// Writes a file under a name of its own beside it (`NAME.1f3a9c0d.part`) and renames it when complete: a reader sees
/// the old file or the new one. Nothing that is there already is written to, and no link is followed.
///
/// # Errors
/// The disk is full or refuses; then the old file is untouched and nothing half-written is left.
pub fn replace(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), OutputError> {
    put(path, false, write).map(drop)
}

/// What a file holds, in short: enough to find that a bit of it has changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct FileSum {
    /// Its length.
    pub bytes: u64,
    /// CRC-32 of them, as zlib has it.
    pub crc: u32,
}

impl FileSum {
    /// That of the first bytes of a file.
    pub(super) fn of(file: &mut impl Read, bytes: u64) -> io::Result<FileSum> {
        let mut summed = SummedFile::new(io::sink());
        io::copy(&mut file.take(bytes), &mut summed)?;
        Ok(summed.sum())
    }

    /// Whether a file is still what it was.
    ///
    /// # Errors
    /// It is missing, or not as it was.
    pub(super) fn check(&self, path: &Path) -> Result<(), ReadError> {
        let found = open_file(path).and_then(|mut file| FileSum::of(&mut file, u64::MAX));
        match found.map_err(|error| ReadProblem::Io(error).at(path))? {
            found if found == *self => Ok(()),
            found => Err(self.differs(found).at(path)),
        }
    }

    /// What is wrong where something else was found.
    pub(super) fn differs(&self, found: FileSum) -> ReadProblem {
        ReadProblem::Layout(match self.bytes == found.bytes {
            true => "its contents are not those that the run wrote: bytes of it have changed".to_string(),
            false => format!("it has {} bytes where the run wrote {}", found.bytes, self.bytes),
        })
    }
}

/// A file that sums what goes into it.
pub(super) struct SummedFile<W> {
    pub inner: W,
    crc: crc32fast::Hasher,
    bytes: u64,
}

impl<W> SummedFile<W> {
    /// A file that holds nothing yet.
    pub(super) fn new(inner: W) -> Self {
        SummedFile { inner, crc: crc32fast::Hasher::new(), bytes: 0 }
    }

    /// The sum so far.
    pub(super) fn sum(&self) -> FileSum {
        FileSum { bytes: self.bytes, crc: self.crc.clone().finalize() }
    }

    /// Goes on from what is there, or was there before.
    pub(super) fn go_on_from(&mut self, sum: FileSum) {
        (self.crc, self.bytes) = (crc32fast::Hasher::new_with_initial_len(sum.crc, sum.bytes), sum.bytes);
    }
}

impl<W: Write> Write for SummedFile<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        took();
        self.crc.update(&bytes[..written]);
        self.bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

/// [`replace`], with what went into the file.
///
/// # Errors
/// As [`replace`].
pub(super) fn replace_summed(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<FileSum, OutputError> {
    put(path, false, write)
}

/// The same, flushed to the disk before it is renamed, and its name after that: for what must outlive a power cut.
///
/// # Errors
/// As [`replace`].
pub(super) fn replace_for_good(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), OutputError> {
    put(path, true, write)?;
    secure_name(path)
}

/// Waits until the name of a file is on the disk.
///
/// # Errors
/// The disk refuses.
pub(super) fn secure_name(path: &Path) -> Result<(), OutputError> {
    match path.parent() {
        // A name alone lies in the folder where the program runs.
        Some(folder) if folder.as_os_str().is_empty() => secure(Path::new(".")),
        folder => folder.map_or(Ok(()), secure),
    }
}

fn put(
    path: &Path,
    flushed: bool,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<FileSum, OutputError> {
    replace_with(path, |_, file| {
        let mut file = BufWriter::with_capacity(1 << 18, SummedFile::new(file));
        write(&mut file)?;
        let file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
        if flushed {
            file.inner.sync_all()?;
        }
        Ok(file.sum())
    })
}

/// The same of a file that `write` fills by that other name, under which there is an empty one.
///
/// # Errors
/// As [`replace`].
pub fn replace_by<X>(path: &Path, write: impl FnOnce(&Path) -> io::Result<X>) -> Result<X, OutputError> {
    replace_with(path, |part, _| write(part))
}

fn replace_with<X>(path: &Path, write: impl FnOnce(&Path, File) -> io::Result<X>) -> Result<X, OutputError> {
    let (part, file) = new_part(path).map_err(OutputError::at(path))?;
    write(&part, file).and_then(|made| fs::rename(&part, path).map(|()| made)).map_err(|source| {
        // The first error is the one to report; a part that cannot be removed either is cleared by the next run.
        let _ = fs::remove_file(&part);
        OutputError { path: path.to_path_buf(), source }
    })
}

/// The bytes of a file.
///
/// # Errors
/// As [`open_file`].
pub(super) fn read_bytes(path: &Path) -> io::Result<Vec<u8>> {
    let (mut file, mut bytes) = (open_file(path)?, Vec::new());
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Opens a file. Pipes and devices are refused: who reads them may wait for ever.
///
/// # Errors
/// It is missing, or no file, or the disk refuses.
pub(super) fn open_file(path: &Path) -> io::Result<File> {
    if !fs::metadata(path)?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is no file"));
    }
    File::open(path)
}

/// Waits until a file or a folder is on the disk.
///
/// # Errors
/// The disk refuses.
pub(super) fn secure(path: &Path) -> Result<(), OutputError> {
    File::open(path).and_then(|file| file.sync_all()).map_err(OutputError::at(path))
}

/// Whether there is a file that holds something, and as much as it did where its sum is known.
///
/// # Errors
/// There is none, it is empty, or of another length.
pub(super) fn is_there(path: &Path, sum: Option<&FileSum>) -> Result<(), OutputError> {
    let wrong = |what: String| Err(OutputError::at(path)(io::Error::new(io::ErrorKind::InvalidData, what)));
    match (fs::metadata(path).map_err(OutputError::at(path))?.len(), sum) {
        (0, _) => wrong("it is empty".to_string()),
        (bytes, Some(sum)) if bytes != sum.bytes => {
            wrong(format!("it has {bytes} bytes where the run wrote {}", sum.bytes))
        }
        _ => Ok(()),
    }
}

/// Removes files one after the other until one is not there.
///
/// # Errors
/// One cannot be removed.
pub(super) fn remove_from(paths: impl Iterator<Item = PathBuf>) -> Result<(), OutputError> {
    for path in paths {
        match fs::remove_file(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => break,
            other => other.map_err(OutputError::at(&path))?,
        }
    }
    Ok(())
}

/// Names that are tried for a part: that even one is taken has odds of one to billions.
const TRIALS: u32 = 16;
/// Digits of a part's number.
const DIGITS: usize = 8;
/// The longest name that a part repeats: systems take 255 bytes [bytes].
const LONGEST_NAME: usize = 200;

/// A new and empty file beside a path, and its name: one that nobody has, and nobody can know before.
///
/// # Errors
/// The disk refuses.
pub(super) fn new_part(path: &Path) -> io::Result<(PathBuf, File)> {
    let name = path.file_name().filter(|name| name.len() <= LONGEST_NAME).unwrap_or(OsStr::new("stickslip"));
    let mut taken = io::ErrorKind::AlreadyExists.into();
    for trial in 0..TRIALS {
        let mut name = name.to_owned();
        // Each state is another one.
        name.push(format!(".{:08x}.part", RandomState::new().hash_one(trial) as u32));
        let part = path.with_file_name(name);
        match File::create_new(&part) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => taken = error,
            other => return other.map(|file| (part, file)),
        }
    }
    Err(taken)
}

/// The name that a part gets when it is complete; none of a name that no part has.
pub fn whole_name(part: &str) -> Option<&str> {
    let (name, number) = part.strip_suffix(".part")?.rsplit_once('.')?;
    let is_number = number.len() == DIGITS && number.bytes().all(|byte| byte.is_ascii_hexdigit());
    is_number.then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_replacement_leaves_the_old_file_and_no_part() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.json");
        replace(&path, |file| file.write_all(b"old")).unwrap();
        let error = replace(&path, |file| {
            file.write_all(b"half of the n")?;
            Err(io::ErrorKind::StorageFull.into())
        })
        .unwrap_err();
        assert!(error.to_string().contains("run.json"), "{error}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    /// Under whatever name a part could have, and where the file itself is a link.
    #[cfg(unix)]
    #[test]
    fn neither_files_beside_it_nor_behind_links_are_written() {
        let folder = tempfile::tempdir().unwrap();
        let [path, beside, victim] = ["x.png", "x.png.part", "victim"].map(|name| folder.path().join(name));
        fs::write(&victim, "mine").unwrap();
        std::os::unix::fs::symlink(&victim, &beside).unwrap();
        std::os::unix::fs::symlink(&victim, &path).unwrap();
        replace(&path, |file| file.write_all(b"new")).unwrap();
        assert!(!path.is_symlink() && beside.is_symlink());
        assert_eq!(
            (fs::read(&path).unwrap(), fs::read(&victim).unwrap()),
            (b"new".to_vec(), b"mine".to_vec())
        );
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3);
    }

    #[test]
    fn parts_are_known_by_their_names_and_take_those_of_long_files() {
        let folder = tempfile::tempdir().unwrap();
        let (part, _) = new_part(&folder.path().join("00003.vtu")).unwrap();
        assert_eq!(whole_name(part.file_name().unwrap().to_str().unwrap()), Some("00003.vtu"));
        for name in ["00003.vtu.part", "a.12345.part", "00003.vtu"] {
            assert_eq!(whole_name(name), None);
        }
        // 255 bytes are what systems take.
        let long = folder.path().join("x".repeat(255));
        replace(&long, |file| file.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&long).unwrap(), b"new");
    }
}
