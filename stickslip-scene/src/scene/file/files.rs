//! Files that a scene names.

use super::text::Text;
use crate::scene::error::Fault;
use std::collections::BTreeMap;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Where a scene finds the files that it names: the disk, or files that lie in memory, by their paths.
pub trait SceneFiles {
    /// The bytes of a file.
    ///
    /// # Errors
    /// It cannot be read, is no file, or has more than `most` bytes.
    fn read(&self, path: &Path, most: u64) -> io::Result<Vec<u8>>;

    /// Names of the files in a folder.
    ///
    /// # Errors
    /// The folder cannot be read.
    fn names(&self, folder: &Path) -> io::Result<Vec<String>>;
}

/// The files of the disk. Pipes and devices are refused: who reads them may wait for ever.
#[derive(Clone, Copy, Debug)]
pub struct Disk;

impl SceneFiles for Disk {
    fn read(&self, path: &Path, most: u64) -> io::Result<Vec<u8>> {
        let about = std::fs::metadata(path)?;
        if !about.is_file() || about.len() > most {
            return Err(no_such_file(most));
        }
        std::fs::read(path)
    }

    fn names(&self, folder: &Path) -> io::Result<Vec<String>> {
        let open = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        Ok(std::fs::read_dir(open)?.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect())
    }
}

impl SceneFiles for BTreeMap<PathBuf, Vec<u8>> {
    fn read(&self, path: &Path, most: u64) -> io::Result<Vec<u8>> {
        let bytes = self.get(path).ok_or(ErrorKind::NotFound)?;
        if bytes.len() as u64 > most { Err(no_such_file(most)) } else { Ok(bytes.clone()) }
    }

    fn names(&self, folder: &Path) -> io::Result<Vec<String>> {
        let inside = self.keys().filter(|path| path.parent() == Some(folder));
        Ok(inside.filter_map(|path| Some(path.file_name()?.to_str()?.to_string())).collect())
    }
}

fn no_such_file(most: u64) -> io::Error {
    io::Error::new(ErrorKind::InvalidInput, format!("it is no file of at most {most} bytes"))
}

/// The bytes of a file that a key names.
///
/// # Errors
/// As [`SceneFiles::read`].
pub fn read_file(
    key: &Text,
    (name, path): (&str, &Path),
    (files, most): (&dyn SceneFiles, u64),
) -> Result<Vec<u8>, Fault> {
    files.read(path, most).map_err(|reason| {
        let help = format!("{}: {reason}; a relative path starts at the scene's folder", path.display());
        key.refused(name, "a file that can be read").help(Some(help))
    })
}
