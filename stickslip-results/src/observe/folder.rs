//! The folder that a run writes to: made, or cleared of the results of an earlier run, and of nothing else.

use super::file::part_of;
use super::manifest::Manifest;
use super::{
    ARRIVALS, BODIES, CONTACTS, ENERGY, FRINGES, FRINGES_ANIMATION, FRINGES_TABLE, FRONT_SPEEDS, FRONTS,
    GRID, LOADS, PARTICLES, PROBES,
};
use miette::Diagnostic;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Files that a run may leave in its folder.
const FILES: [&str; 13] = [
    BODIES,
    ENERGY,
    CONTACTS,
    LOADS,
    PROBES,
    ARRIVALS,
    FRONTS,
    FRONT_SPEEDS,
    FRINGES_TABLE,
    FRINGES_ANIMATION,
    "particles.pvd",
    "grid.pvd",
    Manifest::FILE,
];
/// Folders of snapshots that a run may leave in its folder.
const SNAPSHOTS: [&str; 3] = [PARTICLES, GRID, FRINGES];

/// A folder that is ready to take the results of a run.
#[derive(Clone, Debug)]
pub struct OutputFolder {
    path: PathBuf,
}

/// A folder that cannot take the results of a run: the user's choice, to be mended before the run starts.
#[derive(Debug, thiserror::Error, Diagnostic)]
pub enum FolderError {
    /// It holds files that are not the results of a run.
    #[error("{} holds files that are not the results of a run, such as `{found}`", path.display())]
    #[diagnostic(help("give a folder that is new or empty, or one that `stickslip run` wrote, with --out"))]
    Foreign {
        /// The folder.
        path: PathBuf,
        /// One of the files.
        found: String,
    },
    /// It cannot be made, read or written.
    #[error("cannot write results to {}: {source}", path.display())]
    #[diagnostic(help("give a folder that you may write to with --out"))]
    Unusable {
        /// The folder, or the file in it that stands in the way.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
}

impl OutputFolder {
    /// Makes the folder, or clears it of the results of an earlier run.
    ///
    /// A folder counts as one of ours if it is empty or holds a [`Manifest`]. Only files that a run writes are removed:
    /// notes, plots and pictures beside them stay.
    ///
    /// # Errors
    /// The folder holds files but no manifest, or it cannot be made or written.
    pub fn prepare(path: &Path) -> Result<Self, FolderError> {
        let unusable = |source| FolderError::Unusable { path: path.to_path_buf(), source };
        fs::create_dir_all(path).map_err(unusable)?;
        let mut entries = fs::read_dir(path).map_err(unusable)?;
        if let Some(entry) = entries.next().transpose().map_err(unusable)?
            && Manifest::read(path).is_err()
        {
            let found = entry.file_name().to_string_lossy().into_owned();
            return Err(FolderError::Foreign { path: path.to_path_buf(), found });
        }
        // Asked for before anything is removed: a folder that cannot be written keeps its old results.
        let trial = path.join(".stickslip");
        fs::write(&trial, []).and_then(|()| fs::remove_file(&trial)).map_err(unusable)?;
        clear(path)?;
        Ok(OutputFolder { path: path.to_path_buf() })
    }

    /// Where a file of this folder lies.
    pub fn join(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

fn clear(path: &Path) -> Result<(), FolderError> {
    for name in SNAPSHOTS {
        clear_snapshots(&path.join(name))?;
    }
    // The manifest goes last: a run that is stopped here leaves a folder that the next run still knows as ours.
    for name in FILES {
        remove(&path.join(name))?;
        remove(&part_of(&path.join(name)))?;
    }
    Ok(())
}

fn clear_snapshots(path: &Path) -> Result<(), FolderError> {
    let unusable = |source| FolderError::Unusable { path: path.to_path_buf(), source };
    let entries = match fs::read_dir(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        other => other.map_err(unusable)?,
    };
    for entry in entries {
        let name = entry.map_err(unusable)?.file_name();
        if is_snapshot(&name.to_string_lossy()) {
            remove(&path.join(name))?;
        }
    }
    match fs::remove_dir(path) {
        Err(error) if error.kind() == io::ErrorKind::DirectoryNotEmpty => Ok(()),
        other => other.map_err(unusable),
    }
}

/// `00012.vtu` or `00012.png`, or the same not yet renamed.
fn is_snapshot(name: &str) -> bool {
    let name = name.strip_suffix(".part").unwrap_or(name);
    (name.strip_suffix(".vtu").or_else(|| name.strip_suffix(".png")))
        .is_some_and(|number| number.len() >= 5 && number.bytes().all(|b| b.is_ascii_digit()))
}

fn remove(path: &Path) -> Result<(), FolderError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        other => other.map_err(|source| FolderError::Unusable { path: path.to_path_buf(), source }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_with_foreign_files_is_refused_and_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("thesis.tex"), "years of work").unwrap();
        fs::write(folder.path().join("bodies.csv"), "somebody else's").unwrap();
        let error = OutputFolder::prepare(folder.path()).unwrap_err();
        assert!(matches!(error, FolderError::Foreign { .. }), "{error}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    fn a_json_file_of_another_program_does_not_make_a_folder_ours() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("run.json"), r#"{"program": "another", "version": "1"}"#).unwrap();
        assert!(OutputFolder::prepare(folder.path()).is_err());
    }

    #[test]
    fn a_file_in_the_place_of_the_folder_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out");
        fs::write(&path, "").unwrap();
        let error = OutputFolder::prepare(&path).unwrap_err();
        assert!(matches!(error, FolderError::Unusable { .. }), "{error}");
        assert!(error.to_string().contains("out"), "{error}");
    }

    #[test]
    fn snapshots_are_known_by_name() {
        assert!(is_snapshot("00000.vtu") && is_snapshot("123456.vtu") && is_snapshot("00003.vtu.part"));
        assert!(is_snapshot("00004.png"));
        assert!(!is_snapshot("mine.vtu") && !is_snapshot("1.vtu") && !is_snapshot("00000.vtp"));
    }
}
