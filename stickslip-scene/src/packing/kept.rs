//! Packings that are kept: the same packing is made once, and found again.
//!
//! A file in the user's folder for what can be made anew, named by a hash of all that the packing depends on. It ends in a
//! hash of itself, so that one that is damaged is made anew, and appears under its name when it is complete, so that
//! several processes may make the same.

use super::{NoPacking, Packing, Placement};
use sha2::{Digest, Sha256};
use std::fmt::{self, Write as _};
use std::fs;
use std::hash::{BuildHasher, RandomState};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

/// Beside the version of the crate: another number where the same packing comes out with other places.
const EDITION: u32 = 2;

/// Where kept packings lie, if not in the user's own folder; `off` keeps none.
const VARIABLE: &str = "STICKSLIP_CACHE";

/// What was made faster than this is not kept.
const WORTH_KEEPING: Duration = Duration::from_millis(200);

/// Packings that are kept; those that were made first go first.
const MOST_KEPT: usize = 50;

/// Numbers of a grain: its size, its place, the axis of its turn and the angle.
const NUMBERS: usize = 8;

/// Bytes of a hash.
const HASH: usize = 32;

impl Packing<'_> {
    /// As [`Packing::place`], from the user's folder if the same packing is kept there. What cannot be read or written is
    /// no error: then it is made.
    ///
    /// # Errors
    /// See [`NoPacking`].
    pub fn find_or_place(&self) -> Result<Vec<Placement>, NoPacking> {
        self.kept_in(folder().as_deref(), WORTH_KEEPING)
    }

    fn kept_in(&self, folder: Option<&Path>, worth: Duration) -> Result<Vec<Placement>, NoPacking> {
        let Some(folder) = folder else { return self.place() };
        let path = folder.join(format!("{}.packing", self.name()));
        if let Some(found) = fs::read(&path).ok().and_then(|bytes| decoded(&bytes)) {
            return Ok(found);
        }
        let start = Instant::now();
        let placed = self.place()?;
        if start.elapsed() >= worth && keep(&path, &placed).is_ok() {
            clear(folder);
        }
        Ok(placed)
    }

    /// A hash of all that it depends on.
    fn name(&self) -> String {
        let mut hash = Hashing(Sha256::new());
        // All of it, meshes and images too; numbers are printed with all their digits.
        let written = write!(hash, "{} {EDITION} {self:?}", env!("CARGO_PKG_VERSION"));
        written.expect("a hash takes all text");
        hash.0.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// Hashes what is written to it.
struct Hashing(Sha256);

impl fmt::Write for Hashing {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.update(text);
        Ok(())
    }
}

/// Where packings are kept, if anywhere.
fn folder() -> Option<PathBuf> {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
    match set(VARIABLE) {
        Some(off) if off == "off" => None,
        Some(folder) => Some(PathBuf::from(folder)),
        None if cfg!(windows) => Some(PathBuf::from(set("LOCALAPPDATA")?).join("stickslip").join("cache")),
        None if cfg!(target_os = "macos") => {
            Some(PathBuf::from(set("HOME")?).join("Library").join("Caches").join("stickslip"))
        }
        None => {
            let home = || Some(PathBuf::from(set("HOME")?).join(".cache"));
            Some(set("XDG_CACHE_HOME").map(PathBuf::from).or_else(home)?.join("stickslip"))
        }
    }
}

fn encoded(placed: &[Placement]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(8 * NUMBERS * placed.len() + HASH);
    for Placement { scale, position: [x, y, z], turn: ([a, b, c], angle) } in placed {
        let numbers: [f64; NUMBERS] = [*scale, *x, *y, *z, *a, *b, *c, *angle];
        numbers.iter().for_each(|number| bytes.extend(number.to_le_bytes()));
    }
    let hash = Sha256::digest(&bytes);
    bytes.extend_from_slice(&hash);
    bytes
}

/// What [`encoded`] made; `None` if the bytes are not as it made them.
fn decoded(bytes: &[u8]) -> Option<Vec<Placement>> {
    let (numbers, hash) = bytes.split_at_checked(bytes.len().checked_sub(HASH)?)?;
    if Sha256::digest(numbers)[..] != *hash || numbers.len() % (8 * NUMBERS) != 0 {
        return None;
    }
    let number = |bytes: &[u8]| Some(f64::from_le_bytes(bytes.try_into().ok()?));
    let numbers: Vec<f64> = numbers.chunks(8).map(number).collect::<Option<_>>()?;
    let placement = |of: &[f64]| Placement {
        scale: of[0],
        position: [of[1], of[2], of[3]],
        turn: ([of[4], of[5], of[6]], of[7]),
    };
    Some(numbers.chunks(NUMBERS).map(placement).collect())
}

fn keep(path: &Path, placed: &[Placement]) -> std::io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder)?;
    // A name that nobody else has: each state is another one.
    let number = RandomState::new().hash_one(0) as u32;
    let part = path.with_extension(format!("{number:08x}.part"));
    // A file or a link of this name is somebody else's, or was left by a process that was killed.
    let mut file = fs::File::create_new(&part)?;
    let written = file.write_all(&encoded(placed)).and_then(|()| fs::rename(&part, path));
    if written.is_err() {
        let _ = fs::remove_file(&part);
    }
    written
}

/// Removes the oldest beyond those that are kept.
fn clear(folder: &Path) {
    let Ok(files) = fs::read_dir(folder) else { return };
    let packing = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "packing");
    let paths = files.flatten().map(|file| file.path()).filter(packing);
    let made = |path: PathBuf| Some((fs::metadata(&path).ok()?.modified().ok()?, path));
    let mut all: Vec<(SystemTime, PathBuf)> = paths.filter_map(made).collect();
    all.sort();
    for (_, path) in &all[..all.len().saturating_sub(MOST_KEPT)] {
        let _ = fs::remove_file(path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Shape;
    use crate::packing::{Amount, Sizes};

    fn packing<'a>(container: &'a Shape, grain: &'a Shape, seed: u64) -> Packing<'a> {
        let (sizes, amount) = (Sizes::Uniform(0.8, 1.2), Amount::Count(20));
        Packing {
            container,
            grain,
            sizes,
            amount,
            turned: true,
            gap: 0.0,
            settle: None,
            seed,
            dimension: 2,
            repeats: [None; 3],
        }
    }

    #[test]
    fn a_packing_is_made_once_and_found_again() {
        let folder = tempfile::tempdir().unwrap();
        let (container, grain) =
            (Shape::rectangle([0.0, 0.0], [9.0, 9.0]), Shape::rectangle([0.0; 2], [0.9, 0.7]));
        let packing = packing(&container, &grain, 3);
        let get = || packing.kept_in(Some(folder.path()), Duration::ZERO).unwrap();
        let files = || -> Vec<PathBuf> {
            fs::read_dir(folder.path()).unwrap().map(|file| file.unwrap().path()).collect()
        };
        let made = packing.place().unwrap();
        assert_eq!(get(), made);
        let [file] = &files()[..] else { panic!("one file: {:?}", files()) };
        // What the file holds is what is found.
        let other = &made[..7];
        fs::write(file, encoded(other)).unwrap();
        assert_eq!(get(), other);
        // Whatever is wrong with it, it is made anew.
        let whole = encoded(&made);
        let mut turned = whole.clone();
        turned[100] ^= 1;
        for damaged in [&whole[..whole.len() - 1], &turned, &[], &whole[..HASH]] {
            fs::write(file, damaged).unwrap();
            assert_eq!(get(), made);
            assert_eq!(fs::read(file).unwrap(), whole);
        }
    }

    #[test]
    fn another_packing_is_another_file() {
        let (square, round) = (Shape::rectangle([0.0, 0.0], [9.0, 9.0]), Shape::disk([4.5, 4.5], 4.5));
        // Another last digit of its radius.
        let (grain, other) = (Shape::disk([0.0; 2], 0.4), Shape::disk([0.0; 2], 0.4_f64.next_up()));
        let first = packing(&square, &grain, 1);
        assert_eq!(first.name(), packing(&square.clone(), &grain.clone(), 1).name());
        let others = [
            packing(&square, &grain, 2),
            packing(&round, &grain, 1),
            packing(&square, &other, 1),
            Packing { gap: 1e-9, ..first.clone() },
            Packing { settle: Some([0.0, -1.0, 0.0]), ..first.clone() },
            Packing { repeats: [Some([0.0, 9.0]), None, None], ..first.clone() },
        ];
        assert!(others.iter().all(|other| other.name() != first.name()));
    }

    #[test]
    fn the_oldest_go_and_small_ones_are_not_kept() {
        let folder = tempfile::tempdir().unwrap();
        let (container, grain) = (Shape::rectangle([0.0, 0.0], [9.0, 9.0]), Shape::disk([0.0; 2], 0.4));
        packing(&container, &grain, 1).kept_in(Some(folder.path()), Duration::from_secs(60)).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        for i in 0..MOST_KEPT + 3 {
            fs::write(folder.path().join(format!("{i}.packing")), []).unwrap();
        }
        fs::write(folder.path().join("notes.txt"), []).unwrap();
        packing(&container, &grain, 1).kept_in(Some(folder.path()), Duration::ZERO).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), MOST_KEPT + 1);
        assert!(folder.path().join("notes.txt").exists());
        // A folder that cannot be is no error.
        let nowhere = folder.path().join("notes.txt");
        assert!(packing(&container, &grain, 1).kept_in(Some(&nowhere), Duration::ZERO).is_ok());
    }
}
