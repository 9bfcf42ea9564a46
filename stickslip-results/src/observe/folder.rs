//! The folder that a run writes to: made, or cleared of the results of an earlier run, and of nothing else.

use super::checkpoint::{Checkpoint, is_checkpoint};
use super::file::{OutputError, new_part, whole_name};
use super::manifest::{Manifest, Status};
use super::waiting::Waiting;
use super::{
    ARRIVALS, BODIES, CHART, CHECKPOINTS, CONTACTS, ENERGY, FABRIC, FRINGES, FRINGES_ANIMATION,
    FRINGES_TABLE, FRONT_SPEEDS, FRONTS, GRID, GROUP_CONTACTS, GROUPS, JOINTS, LOADS, PARTICLES, PICTURE,
    PROBES, REACTIONS, REMOVED, SECTIONS, SURFACES, TRACTIONS,
};
use miette::Diagnostic;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Files that a run may leave in its folder.
const FILES: [&str; 23] = [
    BODIES,
    ENERGY,
    CONTACTS,
    LOADS,
    JOINTS,
    REMOVED,
    SECTIONS,
    REACTIONS,
    GROUPS,
    GROUP_CONTACTS,
    FABRIC,
    TRACTIONS,
    PROBES,
    ARRIVALS,
    FRONTS,
    FRONT_SPEEDS,
    FRINGES_TABLE,
    FRINGES_ANIMATION,
    "particles.pvd",
    "surfaces.pvd",
    "surfaces.csv",
    "grid.pvd",
    Manifest::FILE,
];
/// Folders of snapshots that a run may leave in its folder.
const SNAPSHOTS: [&str; 5] = [PARTICLES, SURFACES, GRID, FRINGES, CHECKPOINTS];

/// Where results of an earlier run stay until the next has its first record.
const PREVIOUS: &str = "previous";
/// Where those stay that can be gone on with, until the next run has finished.
const UNFINISHED: &str = "unfinished";
/// A file that is made to see whether one can be, and removed at once.
const TRIAL: &str = "stickslip";

/// A folder that is ready to take the results of a run.
#[derive(Clone, Debug)]
pub struct OutputFolder {
    path: PathBuf,
    /// The folder itself, open and locked while somebody holds it, where the system opens and locks folders.
    held: Arc<Option<File>>,
    waiting: Arc<Waiting>,
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
    /// A folder or a file of results is a link: what lies behind it is somebody else's.
    #[error("{} is a link, and a run writes through none", path.display())]
    #[diagnostic(help(
        "remove it; results that are to lie elsewhere go there by --out, or by a link in the place of the whole folder"
    ))]
    Link {
        /// The link.
        path: PathBuf,
    },
    /// Another run writes to it.
    #[error("another run is writing to {}", path.display())]
    #[diagnostic(help("wait until it has ended, or write to another folder"))]
    InUse {
        /// The folder.
        path: PathBuf,
    },
    /// It cannot be made, read or written.
    #[error("cannot write results to {}: {source}", path.display())]
    #[diagnostic(help("give a folder that you may write to"))]
    Unusable {
        /// The folder, or the file in it that stands in the way.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
}

impl OutputFolder {
    /// Makes the folder, or puts the results of an earlier run in it aside, into the folder `previous`, until
    /// [`OutputFolder::begun`].
    ///
    /// A folder counts as one of ours if it is empty or holds a [`Manifest`], or what a kill leaves of the first one.
    /// Only files that a run writes are moved: notes, plots and pictures beside them stay.
    ///
    /// # Errors
    /// The folder holds files but no manifest, or a link in the place of results, or it cannot be made or written.
    pub fn prepare(path: &Path) -> Result<Self, FolderError> {
        let unusable = |source| FolderError::Unusable { path: path.to_path_buf(), source };
        fs::create_dir_all(path).map_err(unusable)?;
        let held = lock(path)?;
        refuse_links(path)?;
        if let Some(found) = stranger(path)?
            && Manifest::read(path).is_err()
            && Manifest::read(&path.join(PREVIOUS)).is_err()
        {
            return Err(FolderError::Foreign { path: path.to_path_buf(), found });
        }
        // Asked for before anything is moved: a folder that cannot be written keeps its old results.
        try_to_write(path).map_err(unusable)?;
        clear_parts(path)?;
        put_aside(path)?;
        Ok(OutputFolder { path: path.to_path_buf(), held: Arc::new(held), waiting: Arc::default() })
    }

    /// Whether the results of an earlier run are put aside.
    pub fn has_previous(&self) -> bool {
        self.path.join(PREVIOUS).exists()
    }

    /// Removes the results of an earlier run: there are others now. Those of a run that did not finish and has a
    /// checkpoint are moved into the folder `unfinished` instead, in the place of what is there, until
    /// [`OutputFolder::finished`]; gives that folder then.
    ///
    /// # Errors
    /// They cannot be removed or moved.
    pub fn begun(&self) -> Result<Option<PathBuf>, FolderError> {
        let previous = self.path.join(PREVIOUS);
        let unfinished = Some(self.path.join(UNFINISHED)).filter(|_| can_go_on(&previous));
        if let Some(unfinished) = &unfinished {
            make_room(unfinished)?;
            move_results(&previous, unfinished)?;
        }
        clear(&previous)?;
        remove_empty(&previous)?;
        Ok(unfinished)
    }

    /// Removes the results of an earlier run that did not finish: this one has.
    ///
    /// # Errors
    /// They cannot be removed.
    pub fn finished(&self) -> Result<(), FolderError> {
        let unfinished = self.path.join(UNFINISHED);
        clear(&unfinished)?;
        remove_empty(&unfinished)
    }

    /// The folder of a run that goes on: everything in it stays but what is half-written.
    ///
    /// # Errors
    /// Another run writes to it, it has a link in the place of results, or it cannot be read.
    pub fn reopen(path: &Path) -> Result<Self, FolderError> {
        let unusable = |source| FolderError::Unusable { path: path.to_path_buf(), source };
        fs::read_dir(path).map_err(unusable)?;
        let held = lock(path)?;
        refuse_links(path)?;
        try_to_write(path).map_err(unusable)?;
        clear_parts(path)?;
        Ok(OutputFolder { path: path.to_path_buf(), held: Arc::new(held), waiting: Arc::default() })
    }

    /// The same, with how long its writers wait for a disk that takes nothing.
    pub fn with_patience(self, waiting: Waiting) -> Self {
        OutputFolder { waiting: Arc::new(waiting), ..self }
    }

    /// How long its writers wait.
    pub fn waiting(&self) -> &Arc<Waiting> {
        &self.waiting
    }

    /// Looks whether the folder is still where it was, where the system can tell: what is written now would go
    /// elsewhere, or nowhere.
    ///
    /// # Errors
    /// It was moved or removed.
    pub fn is_in_place(&self) -> Result<(), OutputError> {
        let Some(held) = &*self.held else { return Ok(()) };
        if fs::metadata(&self.path).is_ok_and(|found| is_one(held, &found)) {
            return Ok(());
        }
        let now = place(held).map_or("it was moved or removed".to_string(), |now| format!("it is {now} now"));
        let told = format!("{now}: the folder is not where the run began to write");
        Err(OutputError::at(&self.path)(io::Error::new(io::ErrorKind::NotFound, told)))
    }

    /// The folder where it is now, if it was moved and the system says where to.
    pub fn moved(&self) -> Option<OutputFolder> {
        let held = self.held.as_ref().as_ref()?;
        let path = PathBuf::from(place(held)?.strip_prefix("at ")?);
        let found = fs::metadata(&path).ok()?;
        is_one(held, &found).then(|| OutputFolder { path, ..self.clone() })
    }

    /// Bytes of each table in it.
    pub fn tables(&self) -> BTreeMap<String, u64> {
        let tables = FILES.iter().filter(|name| name.ends_with(".csv"));
        let length = |name: &&str| Some((name.to_string(), fs::metadata(self.join(name)).ok()?.len()));
        tables.filter_map(length).collect()
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

fn try_to_write(path: &Path) -> io::Result<()> {
    let (trial, _) = new_part(&path.join(TRIAL))?;
    fs::remove_file(trial)
}

/// Refuses links in the places of results, here and where those of earlier runs are.
fn refuse_links(path: &Path) -> Result<(), FolderError> {
    let folders = [path.to_path_buf(), path.join(PREVIOUS), path.join(UNFINISHED)];
    let inside = folders.iter().flat_map(|folder| {
        SNAPSHOTS.iter().chain(&FILES).chain(&[PREVIOUS, UNFINISHED]).map(|name| folder.join(name))
    });
    match inside.into_iter().find(|place| place.is_symlink()) {
        Some(path) => Err(FolderError::Link { path }),
        None => Ok(()),
    }
}

/// An entry of a folder that is not what a run leaves which is killed while it writes its first record.
fn stranger(path: &Path) -> Result<Option<String>, FolderError> {
    let names = names(path)?.into_iter().map(|name| name.to_string_lossy().into_owned());
    Ok(names
        .into_iter()
        .find(|name| !whole_name(name).is_some_and(|whole| [Manifest::FILE, TRIAL].contains(&whole))))
}

/// Removes what earlier runs left half-written.
fn clear_parts(path: &Path) -> Result<(), FolderError> {
    let is_ours = |whole: &str| [TRIAL, PICTURE, CHART].contains(&whole) || FILES.contains(&whole);
    let folders = SNAPSHOTS.map(|name| path.join(name));
    let here = names(path)?.into_iter().map(|name| (path, name, &is_ours as &dyn Fn(&str) -> bool));
    let mut all: Vec<_> = here.collect();
    for folder in folders.iter().filter(|folder| folder.is_dir()) {
        all.extend(names(folder)?.into_iter().map(|name| (folder.as_path(), name, &is_snapshot as _)));
    }
    let parts =
        all.iter().filter(|(_, name, is_ours)| name.to_str().and_then(whole_name).is_some_and(is_ours));
    parts.into_iter().try_for_each(|(folder, name, _)| remove(&folder.join(name)))
}

/// The names in a folder.
fn names(path: &Path) -> Result<Vec<OsString>, FolderError> {
    let names: io::Result<Vec<_>> =
        fs::read_dir(path).and_then(|entries| entries.map(|entry| Ok(entry?.file_name())).collect());
    names.map_err(|source| FolderError::Unusable { path: path.to_path_buf(), source })
}

/// Opens a folder and locks it against other runs, until what is returned is dropped or the process ends, however it
/// ends. Systems that open no folders give nothing.
fn lock(path: &Path) -> Result<Option<File>, FolderError> {
    let Ok(folder) = File::open(path) else { return Ok(None) };
    match folder.try_lock() {
        Err(TryLockError::WouldBlock) => Err(FolderError::InUse { path: path.to_path_buf() }),
        // Systems that lock no folders have none locked.
        Ok(()) | Err(TryLockError::Error(_)) => Ok(Some(folder)),
    }
}

/// Whether an open folder is the one that was found under its name.
fn is_one(held: &File, found: &fs::Metadata) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        held.metadata().is_ok_and(|held| (held.dev(), held.ino()) == (found.dev(), found.ino()))
    }
    #[cfg(not(unix))]
    {
        let _ = held;
        found.is_dir()
    }
}

/// Where an open folder is now, where the system says so.
fn place(held: &File) -> Option<String> {
    #[cfg(target_os = "linux")]
    {
        use std::os::fd::AsRawFd;
        let link = fs::read_link(format!("/proc/self/fd/{}", held.as_raw_fd())).ok()?;
        let now = link.to_str()?;
        Some(if now.ends_with(" (deleted)") { "removed".to_string() } else { format!("at {now}") })
    }
    #[cfg(not(target_os = "linux"))]
    {
        let _ = held;
        None
    }
}

/// Moves results into the folder `previous`. If there are results in it already, those outside are of a run that never
/// came as far as its first record, and are removed; if it holds a part without a manifest, a run was stopped while it
/// moved them, and the rest follows.
fn put_aside(path: &Path) -> Result<(), FolderError> {
    let previous = path.join(PREVIOUS);
    if Manifest::read(&previous).is_ok() || Manifest::read(path).is_err() {
        return clear(path);
    }
    move_results(path, &previous)
}

/// Removes results that others are to be moved over. Without a manifest they are the first half of those others: the
/// manifest is moved last, and a run was stopped in between.
fn make_room(path: &Path) -> Result<(), FolderError> {
    if Manifest::read(path).is_ok() { clear(path) } else { Ok(()) }
}

fn move_results(from: &Path, to: &Path) -> Result<(), FolderError> {
    let unusable = |source| FolderError::Unusable { path: to.to_path_buf(), source };
    fs::create_dir_all(to).map_err(unusable)?;
    for folder in SNAPSHOTS {
        let snapshots = snapshots(&from.join(folder))?;
        if !snapshots.is_empty() {
            fs::create_dir_all(to.join(folder)).map_err(unusable)?;
        }
        for name in snapshots {
            fs::rename(from.join(folder).join(&name), to.join(folder).join(&name)).map_err(unusable)?;
        }
        remove_empty(&from.join(folder))?;
    }
    // As in `clear`, the manifest goes last.
    for name in FILES {
        match fs::rename(from.join(name), to.join(name)) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            other => other.map_err(unusable)?,
        }
    }
    Ok(())
}

/// Whether a folder holds a run that did not finish and has a checkpoint.
fn can_go_on(path: &Path) -> bool {
    Manifest::read(path).is_ok_and(|manifest| manifest.status != Status::Finished)
        && Checkpoint::list(path).is_ok_and(|checkpoints| !checkpoints.is_empty())
}

fn clear(path: &Path) -> Result<(), FolderError> {
    for name in SNAPSHOTS {
        clear_snapshots(&path.join(name))?;
    }
    // The manifest goes last: a run that is stopped here leaves a folder that the next run still knows as ours.
    for name in FILES {
        remove(&path.join(name))?;
    }
    Ok(())
}

fn clear_snapshots(path: &Path) -> Result<(), FolderError> {
    snapshots(path)?.into_iter().try_for_each(|name| remove(&path.join(name)))?;
    remove_empty(path)
}

/// The names of the snapshots in a folder; none where there is no folder.
fn snapshots(path: &Path) -> Result<Vec<OsString>, FolderError> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let ours = |name: &OsString| is_snapshot(&name.to_string_lossy());
    Ok(names(path)?.into_iter().filter(ours).collect())
}

/// Removes a folder that holds nothing.
fn remove_empty(path: &Path) -> Result<(), FolderError> {
    match fs::remove_dir(path) {
        // What is no folder stays.
        Err(error)
            if matches!(
                error.kind(),
                io::ErrorKind::DirectoryNotEmpty | io::ErrorKind::NotFound | io::ErrorKind::NotADirectory
            ) =>
        {
            Ok(())
        }
        other => other.map_err(|source| FolderError::Unusable { path: path.to_path_buf(), source }),
    }
}

/// `00012.vtu`, `00012.vtp`, `00012.glb`, `00012.png`, a checkpoint, or the same not yet renamed.
fn is_snapshot(name: &str) -> bool {
    let name = whole_name(name).or_else(|| name.strip_suffix(".damaged")).unwrap_or(name);
    let numbered = (["vtu", "vtp", "glb", "png"].iter())
        .find_map(|kind| name.strip_suffix(kind)?.strip_suffix('.'))
        .is_some_and(|number| number.len() >= 5 && number.bytes().all(|b| b.is_ascii_digit()));
    numbered || is_checkpoint(name)
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
    fn earlier_results_stay_until_there_are_others() {
        let folder = tempfile::tempdir().unwrap();
        let [out, inside, kept] = ["", "previous", "unfinished"].map(|name| folder.path().join(name));
        let full: Vec<(String, String)> =
            (["bodies.csv", "particles/00000.vtu", "checkpoints/0000000012.checkpoint"])
                .map(|name| (name.to_string(), format!("{name} of the first run")))
                .into();
        let exist = |place: &Path| {
            full.iter().all(|(name, text)| fs::read_to_string(place.join(name)).ok().as_ref() == Some(text))
        };
        for name in ["particles", "checkpoints"] {
            fs::create_dir(out.join(name)).unwrap();
        }
        full.iter().for_each(|(name, text)| fs::write(out.join(name), text).unwrap());
        fs::write(out.join("notes.txt"), "mine").unwrap();
        let scene = crate::scene::Scene::new(crate::scene::Dimension::Space, 1.0, 1.0);
        let folder = OutputFolder { path: out.clone(), held: Arc::default(), waiting: Arc::default() };
        Manifest::new(&scene, Default::default()).write(&folder).unwrap();
        drop(OutputFolder::prepare(&out).unwrap());
        assert!(exist(&inside) && !out.join("bodies.csv").exists() && out.join("notes.txt").exists());
        // A run that ends before its first record takes nothing away.
        fs::write(out.join("bodies.csv"), "half of the second run").unwrap();
        let folder = OutputFolder::prepare(&out).unwrap();
        assert!(exist(&inside) && !out.join("bodies.csv").exists() && folder.has_previous());
        // It had not finished, and could be gone on with.
        assert_eq!(folder.begun().unwrap(), Some(kept.clone()));
        assert!(!folder.has_previous() && exist(&kept) && out.join("notes.txt").exists());
        folder.finished().unwrap();
        assert!(!kept.exists() && out.join("notes.txt").exists());
    }

    /// Which a kill leaves.
    #[test]
    fn results_that_were_moved_in_part_are_not_lost() {
        let folder = tempfile::tempdir().unwrap();
        let [out, inside, kept] = ["", "previous", "unfinished"].map(|name| folder.path().join(name));
        let put = |place: &Path, name: &str| {
            fs::create_dir_all(place.join(name).parent().unwrap()).unwrap();
            fs::write(place.join(name), name).unwrap();
        };
        let names = ["particles/00000.vtu", "particles/00001.vtu", "checkpoints/0000000012.checkpoint"];
        let all_in = |place: &Path| {
            names.iter().all(|name| fs::read_to_string(place.join(name)).is_ok_and(|text| text == **name))
        };
        put(&inside, names[0]);
        names[1..].iter().for_each(|name| put(&out, name));
        let scene = crate::scene::Scene::new(crate::scene::Dimension::Space, 1.0, 1.0);
        let folder = OutputFolder { path: out.clone(), held: Arc::default(), waiting: Arc::default() };
        Manifest::new(&scene, Default::default()).write(&folder).unwrap();
        let folder = OutputFolder::prepare(&out).unwrap();
        assert!(all_in(&inside));
        // The same on the way to where what has not finished is kept.
        fs::create_dir_all(kept.join("particles")).unwrap();
        fs::rename(inside.join(names[0]), kept.join(names[0])).unwrap();
        assert_eq!(folder.begun().unwrap(), Some(kept.clone()));
        assert!(all_in(&kept));
    }

    /// Of a folder of snapshots, of a table, and where earlier results are: nothing behind them is touched.
    #[cfg(unix)]
    #[test]
    fn a_folder_with_links_in_the_place_of_results_is_refused() {
        let scene = crate::scene::Scene::new(crate::scene::Dimension::Space, 1.0, 1.0);
        for name in
            ["particles", "checkpoints", "energy.csv", "run.json", "previous", "previous/grid", "unfinished"]
        {
            let (folder, elsewhere) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
            let out = folder.path();
            let held =
                OutputFolder { path: out.to_path_buf(), held: Arc::default(), waiting: Arc::default() };
            Manifest::new(&scene, Default::default()).write(&held).unwrap();
            fs::write(elsewhere.path().join("00000.vtu"), "mine").unwrap();
            let link = out.join(name);
            fs::create_dir_all(link.parent().unwrap()).unwrap();
            let _ = fs::remove_file(&link);
            std::os::unix::fs::symlink(elsewhere.path(), &link).unwrap();
            for refused in [OutputFolder::prepare(out), OutputFolder::reopen(out)] {
                assert!(matches!(refused, Err(FolderError::Link { path }) if path == link), "{name}");
            }
            assert_eq!(fs::read_to_string(elsewhere.path().join("00000.vtu")).unwrap(), "mine");
            assert!(link.is_symlink());
        }
    }

    #[test]
    fn what_a_kill_leaves_of_the_first_record_is_no_stranger() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["run.json.0123abcd.part", "stickslip.0123abcd.part"] {
            fs::write(folder.path().join(name), "{").unwrap();
        }
        drop(OutputFolder::prepare(folder.path()).unwrap());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        fs::write(folder.path().join("run.json.0123abcd.part"), "{").unwrap();
        fs::write(folder.path().join("notes.json.0123abcd.part"), "mine").unwrap();
        assert!(matches!(OutputFolder::prepare(folder.path()), Err(FolderError::Foreign { .. })));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    /// A run that is killed while it is drawn goes on, and leaves what one does that was not.
    #[test]
    fn what_a_kill_leaves_of_a_file_goes_as_the_run_goes_on() {
        let folder = tempfile::tempdir().unwrap();
        let parts = ["energy.csv", PICTURE, CHART, "run.json", "particles/00003.vtu", "mine.png"];
        fs::create_dir(folder.path().join("particles")).unwrap();
        for whole in parts {
            fs::write(folder.path().join(format!("{whole}.0123abcd.part")), "half").unwrap();
        }
        drop(OutputFolder::reopen(folder.path()).unwrap());
        let left = names(folder.path()).unwrap();
        assert!(left.iter().all(|name| name == "particles" || name == "mine.png.0123abcd.part"), "{left:?}");
        assert_eq!(fs::read_dir(folder.path().join("particles")).unwrap().count(), 0);
    }

    #[test]
    fn results_of_a_finished_run_go_once_there_are_others() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path();
        fs::create_dir(out.join("checkpoints")).unwrap();
        fs::write(out.join("checkpoints/0000000012.checkpoint"), "the last state").unwrap();
        let scene = crate::scene::Scene::new(crate::scene::Dimension::Space, 1.0, 1.0);
        let folder = OutputFolder { path: out.to_path_buf(), held: Arc::default(), waiting: Arc::default() };
        let manifest = Manifest::new(&scene, Default::default());
        Manifest { status: Status::Finished, ..manifest }.write(&folder).unwrap();
        assert_eq!(OutputFolder::prepare(out).unwrap().begun().unwrap(), None);
        assert_eq!(fs::read_dir(out).unwrap().count(), 0);
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
        assert!(is_snapshot("00000.vtu") && is_snapshot("123456.vtu") && !is_snapshot("00003.vtu.part"));
        assert!(is_snapshot("00003.vtu.0123abcd.part") && !is_snapshot("mine.0123abcd.part"));
        assert!(is_snapshot("00004.png") && is_snapshot("0000000012.checkpoint.0123abcd.part"));
        assert!(!is_snapshot("mine.vtu") && !is_snapshot("1.vtu") && !is_snapshot("00000.stl"));
        assert!(is_snapshot("00001.vtp") && is_snapshot("00002.glb") && !is_snapshot("00002vtp"));
    }
}
