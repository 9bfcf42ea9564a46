//! What was read for a scene, in short: enough to tell whether somebody else has read the same.

use super::{Scene, SceneFiles};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::cell::RefCell;
use std::io;
use std::path::Path;

/// A file that a scene names, as it was read.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct FileRead {
    /// Where it lay, as text: names that are none have signs in place of what is no letter.
    pub path: String,
    /// Its length.
    pub bytes: u64,
    /// Its SHA-256.
    pub sha256: String,
}

/// All that was read for a scene, and what came of it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WasRead {
    /// The files that it names, in the order in which they were read.
    pub files: Vec<FileRead>,
    /// SHA-256 of the scene as a record has it.
    pub scene: String,
}

impl WasRead {
    /// That of a scene.
    pub fn new(files: &[FileRead], scene: &Scene) -> Self {
        let mut sum = Summed(Sha256::new());
        serde_json::to_writer(&mut sum, scene).expect("a scene is plain data whose keys are text");
        WasRead { files: files.to_vec(), scene: hex(&sum.0.finalize()) }
    }

    /// What another one has read otherwise of the same scene, in words: `None` if nothing.
    pub fn differs(&self, other: &WasRead) -> Option<String> {
        // Whatever the paths are from where each of them stands, the files are the same ones up to the first that
        // differs.
        let file = self.files.iter().zip(&other.files).find_map(|(file, other)| other_than(file, other));
        // Such as a library of mathematics that rounds otherwise.
        let scene =
            || (self.scene != other.scene).then(|| "made another scene of the same files".to_string());
        file.or_else(scene)
    }
}

/// The first file of `others` that is not as the one of the same path is here, in words.
pub fn first_other(here: &[FileRead], others: &[FileRead]) -> Option<String> {
    others.iter().find_map(|other| {
        let same_place = here.iter().find(|file| file.path == other.path)?;
        other_than(same_place, other)
    })
}

/// That the file of another one is not as it is here, in words.
fn other_than(here: &FileRead, other: &FileRead) -> Option<String> {
    let short = |file: &FileRead| format!("{} bytes with the sha256 {:.12}...", file.bytes, file.sha256);
    (here.sha256 != other.sha256).then(|| {
        let [other_file, file] = [other, here].map(short);
        format!("has another {}: {other_file}, where the first has {file}", other.path)
    })
}

/// Files that note what is read of them.
pub(super) struct Noted<'a> {
    files: &'a dyn SceneFiles,
    read: RefCell<Vec<FileRead>>,
}

impl<'a> Noted<'a> {
    pub fn new(files: &'a dyn SceneFiles) -> Self {
        Noted { files, read: RefCell::default() }
    }

    pub fn into_read(self) -> Vec<FileRead> {
        self.read.into_inner()
    }
}

impl SceneFiles for Noted<'_> {
    fn read(&self, path: &Path, most: u64) -> io::Result<Vec<u8>> {
        let bytes = self.files.read(path, most)?;
        let (path, sha256) = (path.display().to_string(), hex(&Sha256::digest(&bytes)));
        self.read.borrow_mut().push(FileRead { path, bytes: bytes.len() as u64, sha256 });
        Ok(bytes)
    }

    fn names(&self, folder: &Path) -> io::Result<Vec<String>> {
        self.files.names(folder)
    }
}

struct Summed(Sha256);

impl io::Write for Summed {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The SHA-256 of a file, such as that of the program itself.
///
/// # Errors
/// It cannot be read.
pub fn sum_of_file(path: &Path) -> io::Result<String> {
    let mut sum = Summed(Sha256::new());
    io::copy(&mut std::fs::File::open(path)?, &mut sum)?;
    Ok(hex(&sum.0.finalize()))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::parse_beside;
    use std::collections::BTreeMap;
    use std::path::PathBuf;

    const SCENE: &str = r#"
        [space]
        dimension = "2d"
        cell = 0.1
        [time]
        end = 1
        [materials.m]
        density = 1
        neo_hookean = { young_modulus = 1, poisson_ratio = 0.3 }
        [[point_clouds]]
        name = "cloud"
        material = "m"
        file = "grains.csv"
    "#;

    fn read(volume: &str) -> WasRead {
        read_in("there", volume)
    }

    fn read_in(folder: &str, volume: &str) -> WasRead {
        let rows =
            (0..400).map(|i| format!("{},{},{volume}\n", 0.05 * f64::from(i % 20), 0.05 * f64::from(i / 20)));
        let table = format!("x,y,volume\n{}", rows.collect::<String>());
        let files = BTreeMap::from([(PathBuf::from(folder).join("grains.csv"), table.into_bytes())]);
        parse_beside(&format!("{folder}/scene.toml"), SCENE, &[], &files).unwrap().was_read()
    }

    #[test]
    fn a_file_that_is_another_is_named_with_both_lengths() {
        let here = read("0.0025");
        assert_eq!(here.files.len(), 1);
        assert_eq!(here.differs(&read("0.0025")), None);
        let told = here.differs(&read("0.00250")).unwrap();
        let [was, is] = ["0.0025", "0.00250"].map(|volume| read(volume).files[0].clone());
        assert_eq!(is.bytes, was.bytes + 400, "a letter more in each of 400 rows");
        for part in [
            "has another there/grains.csv: ",
            &format!("{} bytes", is.bytes),
            &is.sha256[..12],
            &was.sha256[..12],
        ] {
            assert!(told.contains(part), "{told}");
        }
    }

    /// The first process reads by the path that it was given, others by an absolute one.
    #[test]
    fn a_file_is_the_same_by_another_path() {
        let here = read_in("there", "0.0025");
        assert_eq!(here.differs(&read_in("/far/there", "0.0025")), None);
        let told = here.differs(&read_in("/far/there", "0.0024")).unwrap();
        assert!(told.starts_with("has another /far/there/grains.csv: "), "{told}");
    }

    /// The digest of nothing, by FIPS 180-4.
    #[test]
    fn sums_are_sha_256() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let sum = sum_of_file(file.path()).unwrap();
        assert_eq!(sum, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    }
}
