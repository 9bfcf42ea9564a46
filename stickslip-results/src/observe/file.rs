//! Files that are whole at any time, and what can go wrong with them.

use miette::Diagnostic;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
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
    /// Ties an error of the operating system to the file at hand.
    pub(super) fn at(path: &Path) -> impl FnOnce(io::Error) -> OutputError + '_ {
        move |source| OutputError { path: path.to_path_buf(), source }
    }
}

fn remedy(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "free some space, or ask for outputs less often; everything written before can be read"
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "give a folder that you may write to with --out"
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
    #[error("{0}")]
    Table(#[from] csv::Error),
    /// `run.json` is not as a run writes it.
    #[error("{0}")]
    Manifest(#[from] serde_json::Error),
    /// A `.pvd` or `.vtu` file is not XML.
    #[error("{0}")]
    Xml(#[from] quick_xml::Error),
    /// A `.pvd` or `.vtu` file holds something other than a run writes.
    #[error("{0}")]
    Layout(String),
}

impl ReadProblem {
    /// Names the file that has the problem.
    pub(super) fn at(self, path: &Path) -> ReadError {
        ReadError { path: path.to_path_buf(), problem: self }
    }
}

/// Writes a file under another name (`.part` appended) and renames it when complete:
/// a reader sees the old file or the new one.
///
/// # Errors
/// The disk is full or refuses; then the old file is untouched and nothing half-written is left.
pub(super) fn replace(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), OutputError> {
    let part = part_of(path);
    let written = File::create(&part).and_then(|file| {
        let mut file = BufWriter::with_capacity(1 << 18, file);
        write(&mut file)?;
        file.flush()
    });
    written.and_then(|()| fs::rename(&part, path)).map_err(|source| {
        // The first error is the one to report; a part that cannot be removed either is cleared by the next run.
        let _ = fs::remove_file(&part);
        OutputError { path: path.to_path_buf(), source }
    })
}

/// The name under which [`replace`] writes before it renames.
pub(super) fn part_of(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".part");
    PathBuf::from(name)
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
}
