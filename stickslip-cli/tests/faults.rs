//! Faults of the disk and of memory, as the system makes them: disks that are full, limits on files, devices that
//! refuse, folders that are moved, removed or read-only, and no more memory.
//!
//! Expected after each: exit code 1 and a message that names the file; no file under its own name that is empty or half;
//! what was written before has the bytes of a run that met no fault; and what goes on from there ends in its bits.
#![cfg(target_os = "linux")]

mod stickslip;

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use stickslip::{Disk, MANY_FILES, Ran, Workplace, new_scene};

/// What a run meets.
#[derive(Clone, Copy, Debug)]
enum Fault {
    /// A disk of so many KiB.
    Space(u32),
    /// A limit on the length of files, in KiB.
    Limit(u32),
    /// A file in whose place there is a folder, from the first step on.
    File(&'static str),
    /// A disk of so many KiB for one folder of snapshots, from the first step on.
    Small(&'static str, u32),
    /// Once there is a snapshot of this number, its folder and that of the results cannot be written.
    ReadOnly(u32),
    /// Once there is a snapshot of this number, the folder of results is removed.
    Removed(u32),
    /// The same, and it is moved.
    Moved(u32),
}

/// Files of a run, by their names in its folder, but for its record, checkpoints, pictures and what has no name of its
/// own yet.
fn files(out: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![out.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
            let (path, name) = (entry.path(), entry.file_name().into_string().unwrap());
            if path.is_dir() && name != "checkpoints" {
                folders.push(path);
            } else if ["csv", "vtu", "pvd"].iter().any(|kind| name.ends_with(kind)) {
                let bytes = fs::read(&path).unwrap();
                assert!(!bytes.is_empty(), "{name} is empty");
                found.insert(path.strip_prefix(out).unwrap().to_path_buf(), bytes);
            }
        }
    }
    found
}

fn state_sum(out: &Path) -> serde_json::Value {
    let record: serde_json::Value = serde_json::from_slice(&fs::read(out.join("run.json")).unwrap()).unwrap();
    assert_eq!(record["status"], "finished");
    record["state_sum"].clone()
}

fn has_checkpoint(out: &Path) -> bool {
    let entries = fs::read_dir(out.join("checkpoints")).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).any(|path| path.extension().is_some_and(|kind| kind == "checkpoint"))
}

/// A run that meets no fault, against which the others are held.
struct Reference {
    files: BTreeMap<PathBuf, Vec<u8>>,
    sum: serde_json::Value,
}

impl Reference {
    fn new() -> Self {
        let workplace = workplace();
        workplace.succeed(&run_into("out"));
        let out = workplace.path("out");
        Reference { files: files(&out), sum: state_sum(&out) }
    }

    /// What is there has the bytes that it should, as far as it goes, and the program's own reader reads it all.
    fn holds_before(&self, workplace: &Workplace, out: &str) {
        let folder = workplace.path(out);
        if !folder.join("run.json").exists() {
            return;
        }
        for (name, found) in files(&folder) {
            let whole = &self.files[&name];
            let same = match name.extension().and_then(|kind| kind.to_str()) {
                Some("csv") => whole.starts_with(&found) && found.ends_with(b"\n"),
                Some("vtu") => *whole == found,
                // A list of files: each is there.
                _ => String::from_utf8(found).unwrap().split("file=\"").skip(1).all(|rest| {
                    let listed = rest.split('"').next().unwrap();
                    folder.join(listed).exists()
                }),
            };
            assert!(same, "{} is not what it should be", name.display());
        }
        let checked = workplace.run(&["check", out]);
        assert_eq!(checked.code, Some(0), "{}", checked.stderr);
    }

    /// The run has ended as the one that met no fault.
    fn holds_after(&self, out: &Path) {
        let found = files(out);
        assert_eq!(found.keys().collect::<Vec<_>>(), self.files.keys().collect::<Vec<_>>());
        for (name, whole) in &self.files {
            assert!(*whole == found[name], "{} differs", name.display());
        }
        assert_eq!(state_sum(out), self.sum);
    }
}

fn workplace() -> Workplace {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    workplace
}

fn run_into(out: &str) -> Vec<&str> {
    [&["run", "scene.toml", "--threads", "1", "--out", out][..], &MANY_FILES].concat()
}

/// Waits for a run that met its fault, or did not.
fn ended(child: Child) -> Ran {
    let output = child.wait_with_output().unwrap();
    let [stdout, stderr] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    Ran { code: output.status.code(), stdout, stderr }
}

fn spawn(mut command: Command) -> Child {
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// A run that stops after a step, with a checkpoint.
fn begin(workplace: &Workplace) {
    let brief = workplace.run(&[&run_into("out")[..], &["--max-time", "1ns"]].concat());
    assert_eq!(brief.code, Some(4), "{}", brief.stderr);
}

/// Copies the files of a folder into another one.
fn copy_all(from: &Path, to: &Path) {
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        fs::copy(entry.path(), to.join(entry.file_name())).unwrap();
    }
}

/// Waits until a file is there, or the run has ended.
fn wait_for(path: &Path, child: &mut Child) {
    while !path.exists() && child.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_micros(200));
    }
}

impl Fault {
    /// Lets a run meet the fault and go on after it; false where it did not come to it, as where the run was faster.
    fn meet(self, reference: &Reference) -> bool {
        let workplace = workplace();
        match self {
            Fault::Space(kib) => {
                let Some(disk) = Disk::mount(workplace.path("disk"), kib) else { return false };
                let ran = workplace.run(&run_into("disk/out"));
                self.told(&ran, "disk/out") && {
                    reference.holds_before(&workplace, "disk/out");
                    disk.grow();
                    go_on(&workplace, "disk/out", reference);
                    true
                }
            }
            Fault::Limit(kib) => {
                let program = workplace.command(&[]).get_program().to_str().unwrap().to_owned();
                let line = format!("ulimit -f {kib}; exec '{program}' \"$@\"");
                let mut shell = Command::new("bash");
                shell.args(["-c", &line, "bash"]).args(run_into("out")).current_dir(workplace.path(""));
                let ran = ended(spawn(shell));
                self.told(&ran, "out") && {
                    reference.holds_before(&workplace, "out");
                    go_on(&workplace, "out", reference);
                    true
                }
            }
            Fault::File(name) => {
                begin(&workplace);
                let place = workplace.path("out").join(name);
                fs::create_dir(&place).unwrap();
                let ran = workplace.run(&["resume", "out"]);
                self.told(&ran, name) && {
                    fs::remove_dir(&place).unwrap();
                    reference.holds_before(&workplace, "out");
                    go_on(&workplace, "out", reference);
                    true
                }
            }
            Fault::Small(name, kib) => {
                begin(&workplace);
                let [place, aside] = [workplace.path("out").join(name), workplace.path("aside")];
                fs::rename(&place, &aside).unwrap();
                let Some(disk) = Disk::mount(place.clone(), kib) else { return false };
                copy_all(&aside, &place);
                let ran = workplace.run(&["resume", "out"]);
                self.told(&ran, name) && {
                    reference.holds_before(&workplace, "out");
                    copy_all(&place, &aside);
                    drop(disk);
                    fs::remove_dir(&place).unwrap();
                    fs::rename(&aside, &place).unwrap();
                    go_on(&workplace, "out", reference);
                    true
                }
            }
            Fault::ReadOnly(frame) => {
                fs::set_permissions(workplace.path(""), fs::Permissions::from_mode(0o777)).unwrap();
                let mut command = workplace.command(&run_into("out"));
                if fs::metadata("/proc/self").is_ok_and(|own| std::os::unix::fs::MetadataExt::uid(&own) == 0)
                {
                    // Nothing is read-only to root.
                    command.uid(65534).gid(65534);
                }
                let mut child = spawn(command);
                wait_for(&workplace.path(&format!("out/particles/{frame:05}.vtu")), &mut child);
                let set = |mode: u32| {
                    for folder in ["out", "out/particles"].map(|name| workplace.path(name)) {
                        fs::set_permissions(folder, fs::Permissions::from_mode(mode)).unwrap();
                    }
                };
                set(0o555);
                let ran = ended(child);
                set(0o755);
                self.told(&ran, "out") && {
                    reference.holds_before(&workplace, "out");
                    go_on(&workplace, "out", reference);
                    true
                }
            }
            Fault::Removed(frame) | Fault::Moved(frame) => {
                let mut child = spawn(workplace.command(&run_into("out")));
                let out = workplace.path("out");
                wait_for(&out.join(format!("particles/{frame:05}.vtu")), &mut child);
                fs::rename(&out, workplace.path("elsewhere")).unwrap();
                let moved = matches!(self, Fault::Moved(_));
                if !moved {
                    // The run may make a file in it meanwhile.
                    while fs::remove_dir_all(workplace.path("elsewhere")).is_err() {}
                }
                let ran = ended(child);
                assert!(!out.exists(), "{self:?}: something was made again");
                self.told(&ran, "out: it is ") && {
                    // What is being removed may have been seen while some of it was left.
                    let gone = !moved && ran.stderr.contains("removed now");
                    assert!(gone || ran.stderr.contains("elsewhere now"), "{}", ran.stderr);
                    if moved {
                        reference.holds_before(&workplace, "elsewhere");
                        go_on(&workplace, "elsewhere", reference);
                    }
                    true
                }
            }
        }
    }

    /// Whether a run ended by the fault; then it must say so.
    fn told(self, ran: &Ran, file: &str) -> bool {
        assert!(!ran.stderr.contains("panicked"), "{self:?}: {}", ran.stderr);
        // A checkpoint that cannot be written ends no run.
        if ran.code == Some(0) {
            return ran.stderr.contains("warning: no checkpoint: cannot write");
        }
        assert_eq!(ran.code, Some(1), "{self:?}: {}", ran.stderr);
        assert!(ran.stderr.contains("cannot write "), "{self:?}: {}", ran.stderr);
        assert!(ran.stderr.contains(file), "{self:?}: {}", ran.stderr);
        true
    }
}

/// Goes on with a run, or begins it anew where it made no checkpoint.
fn go_on(workplace: &Workplace, out: &str, reference: &Reference) {
    match has_checkpoint(&workplace.path(out)) {
        true => workplace.succeed(&["resume", out]),
        false => workplace.succeed(&run_into(out)),
    };
    reference.holds_after(&workplace.path(out));
}

/// Lets runs meet faults; gives how many they met.
fn meet_all(faults: impl IntoIterator<Item = Fault>) -> usize {
    let reference = Reference::new();
    // A run may be over before its folder is touched.
    let met = faults.into_iter().filter(|fault| (0..5).any(|_| fault.meet(&reference)));
    met.count()
}

#[test]
fn a_run_that_meets_a_fault_says_so_and_goes_on_after_it() {
    let faults = [
        Fault::Space(700),
        Fault::Limit(40),
        Fault::File("particles/00004.vtu"),
        Fault::Small("particles", 100),
        Fault::ReadOnly(3),
        Fault::Removed(3),
        Fault::Moved(5),
    ];
    let met = meet_all(faults);
    assert!(met >= 5, "{met} faults were met: all, or all but those of disks, where none may be mounted");
}

/// Killed while a snapshot has not its own name yet: what is left of it is in nobody's way.
#[test]
fn a_run_that_is_killed_inside_a_write_goes_on() {
    let workplace = workplace();
    // So that writes take a while.
    let large = ["--set", "outputs.snapshots.precision=double", "--set", "cells_per_radius=12"];
    workplace.succeed(&[&run_into("whole")[..], &large].concat());
    let brief = [&run_into("out")[..], &large, &["--max-time", "1ns"]].concat();
    assert_eq!(workplace.run(&brief).code, Some(4));
    let out = workplace.path("out");
    let parts = || -> Vec<PathBuf> {
        let entries = fs::read_dir(out.join("particles")).unwrap().flatten().map(|entry| entry.path());
        entries.filter(|path| path.extension().is_some_and(|kind| kind == "part")).collect()
    };
    let killed_in_write = || {
        let mut child = spawn(workplace.command(&["resume", "out"]));
        while parts().is_empty() && child.try_wait().unwrap().is_none() {}
        child.kill().unwrap();
        child.wait().unwrap();
        let left = parts();
        for part in &left {
            let name = part.file_name().unwrap().to_str().unwrap().split_at("00000.vtu".len()).0.to_owned();
            assert!(!out.join("particles").join(&name).exists(), "{name} has not its own name");
        }
        assert_eq!(workplace.run(&["check", "out"]).code, Some(0));
        !left.is_empty()
    };
    // One that is too late ends the run, or finds the file whole.
    let met = (0..50).filter(|_| killed_in_write()).take(2).count();
    assert!(met > 0, "no kill came inside a write");
    workplace.succeed(&["resume", "out"]);
    assert!(parts().is_empty());
    assert!(files(&workplace.path("whole")) == files(&out));
    assert_eq!(state_sum(&workplace.path("whole")), state_sum(&out));
}

#[test]
#[ignore = "slow: a minute"]
fn sixty_faults_are_met_and_lived_through() {
    let by_file = ["particles/00002.vtu", "particles/00009.vtu", "grid/00003.vtu", "grid/00006.vtu"];
    let by_file = by_file.map(Fault::File).into_iter();
    let small = (1..=5).flat_map(|i| [("particles", 60 * i), ("grid", 60 * i)]);
    let by_file = by_file.chain(small.map(|(name, kib)| Fault::Small(name, kib)));
    let faults: Vec<Fault> = (1..=20)
        .map(|i| Fault::Space(8 + 85 * i))
        .chain((1..=14).map(|i| Fault::Limit(2 + 4 * i)))
        .chain(by_file)
        .chain(
            (1..=16)
                .step_by(4)
                .flat_map(|i| [Fault::ReadOnly(i), Fault::Removed(i + 1), Fault::Moved(i + 2)]),
        )
        .collect();
    let count = faults.len();
    let met = meet_all(faults);
    println!("{met} of {count} faults were met");
    assert!(met >= 50, "{met} of {count}");
}

/// A full disk, or a folder that is moved, before there is a checkpoint: the record says that the run failed, and
/// `resume` begins anew, as long as the scene is what it was.
#[test]
fn a_run_that_met_a_fault_before_its_first_checkpoint_is_begun_anew_by_resume() {
    let reference = Reference::new();
    let no_checkpoints = ["--set", "outputs.checkpoints=10"];
    let status = |out: &Path| {
        let record: serde_json::Value =
            serde_json::from_slice(&fs::read(out.join("run.json")).unwrap()).unwrap();
        record["status"].as_str().unwrap().to_owned()
    };
    let begins_anew = |workplace: &Workplace, out: &str| {
        assert!(!has_checkpoint(&workplace.path(out)));
        assert_eq!(status(&workplace.path(out)), "failed");
        let changed = workplace.run(&["resume", out, "--scene", "other.toml"]);
        assert_eq!(changed.code, Some(2), "{}", changed.stderr);
        assert!(changed.stderr.contains("was made with another scene"), "{}", changed.stderr);
        let ran = workplace.run(&["resume", out]);
        assert_eq!(ran.code, Some(0), "{}", ran.stderr);
        assert!(ran.stderr.contains("has no checkpoint: the run begins anew"), "{}", ran.stderr);
        reference.holds_after(&workplace.path(out));
    };
    let with_other = || {
        let workplace = workplace();
        workplace.write("other.toml", &new_scene().replace("density = ", "density = 2 #"));
        workplace
    };
    let moved = with_other();
    let mut child = spawn(moved.command(&[&run_into("out")[..], &no_checkpoints].concat()));
    wait_for(&moved.path("out/particles/00002.vtu"), &mut child);
    fs::rename(moved.path("out"), moved.path("elsewhere")).unwrap();
    assert_eq!(ended(child).code, Some(1));
    begins_anew(&moved, "elsewhere");

    let full = with_other();
    let Some(disk) = Disk::mount(full.path("disk"), 700) else { return };
    // Nothing is left for a record either.
    let mut child = spawn(full.command(&[&run_into("disk/out")[..], &no_checkpoints].concat()));
    wait_for(&full.path("disk/out/particles/00001.vtu"), &mut child);
    let mut filler = fs::File::create(full.path("disk/filler")).unwrap();
    while std::io::Write::write_all(&mut filler, &[0; 4096]).is_ok() {}
    let ran = ended(child);
    assert_eq!(ran.code, Some(1), "{}", ran.stderr);
    assert!(ran.stderr.contains("free some space"), "{}", ran.stderr);
    assert!(ran.stderr.contains("begins anew where there is none"), "{}", ran.stderr);
    drop(filler);
    fs::remove_file(full.path("disk/filler")).unwrap();
    disk.grow();
    begins_anew(&full, "disk/out");
}

#[test]
fn memory_that_runs_out_before_the_run_is_told_in_a_sentence() {
    let workplace = workplace();
    let program = workplace.command(&[]).get_program().to_str().unwrap().to_owned();
    let line = format!(
        "ulimit -v 400000; exec '{program}' run scene.toml --threads 1 --max-memory 1TB --set cells_per_radius=300"
    );
    let mut shell = Command::new("bash");
    shell.args(["-c", &line]).current_dir(workplace.path(""));
    let ran = ended(spawn(shell));
    assert_eq!(ran.code, Some(1), "{}", ran.stderr);
    assert!(ran.stderr.contains("out of memory: the system has no "), "{}", ran.stderr);
    assert!(!ran.stderr.contains("memory allocation of"), "{}", ran.stderr);
}

/// The limit comes down on a run under way: the next large block is refused.
#[test]
#[cfg(target_env = "gnu")]
fn memory_that_runs_out_in_a_run_names_the_checkpoint_and_the_run_goes_on() {
    let reference = Reference::new();
    let met = (0..5).any(|_| {
        let workplace = workplace();
        let mut command = workplace.command(&run_into("out"));
        // So that each is asked of the system.
        command.env("MALLOC_MMAP_THRESHOLD_", "32768");
        let mut child = spawn(command);
        wait_for(&workplace.path("out/particles/00007.vtu"), &mut child);
        let pid = child.id().to_string();
        let held = fs::read_to_string(format!("/proc/{pid}/statm")).unwrap_or_default();
        let pages: Option<u64> = held.split(' ').next().and_then(|pages| pages.parse().ok());
        // A little less than it has: what it gives back at the end is enough to say so.
        let limit = format!("--as={}", (4096 * pages.unwrap_or_default()).saturating_sub(1 << 19));
        let limited = Command::new("prlimit").args(["--pid", &pid, &limit]).output();
        let ran = ended(child);
        if ran.code == Some(0) || limited.is_ok_and(|output| !output.status.success()) {
            return false;
        }
        assert_eq!(ran.code, Some(1), "{}", ran.stderr);
        assert!(ran.stderr.contains("out of memory: the system has no "), "{}", ran.stderr);
        let named = ran.stderr.contains("`stickslip resume out` goes on from out/checkpoints/");
        reference.holds_before(&workplace, "out");
        go_on(&workplace, "out", &reference);
        named
    });
    assert!(met, "the limit was never met");
}

/// A flipped bit is found, in whatever file it is; and by nobody where there is none.
#[test]
fn a_flipped_bit_is_found_in_every_kind_of_file() {
    let workplace = workplace();
    let fringes = "\n[outputs.fringes]\ninterval = 0.02\nstress_parameter = 1e4\nwidth = 40\n";
    let groups = "\nreactions = [\"y_min\"]\n[[outputs.groups]]\nname = \"all\"\nbodies = [\"*\"]\n";
    let scene = new_scene().replace("y_min = \"fixed\" }", "y_min = \"fixed\", leaving = \"remove\" }");
    workplace.write("scene.toml", &(scene + groups + fringes));
    workplace.succeed(&run_into("out"));
    let whole = workplace.succeed(&["check", "out"]);
    assert!(whole.contains("are as the run wrote them"), "{whole}");
    let newest =
        fs::read_dir(workplace.path("out/checkpoints")).unwrap().map(|entry| entry.unwrap().path()).max();
    let newest = newest.unwrap().strip_prefix(workplace.path("out")).unwrap().to_str().unwrap().to_owned();
    for name in [
        "particles/00003.vtu",
        "particles.pvd",
        "grid/00002.vtu",
        "grid.pvd",
        "fringes/00001.png",
        "fringes.csv",
        "energy.csv",
        "contacts.csv",
        "group_contacts.csv",
        "reactions.csv",
        "run.json",
        &newest,
    ] {
        let path = workplace.path("out").join(name);
        let kept = fs::read(&path).unwrap();
        for place in [1, 3].map(|part| part * kept.len() / 4) {
            let mut flipped = kept.clone();
            flipped[place] ^= 1;
            fs::write(&path, &flipped).unwrap();
            let ran = workplace.run(&["check", "out"]);
            assert_eq!(ran.code, Some(2), "{name} at {place}: {}", ran.stdout);
            assert!(ran.stderr.contains(name), "{name}: {}", ran.stderr);
        }
        fs::write(&path, &kept).unwrap();
    }
    // A list with another time is a list all the same.
    let list = workplace.path("out/particles.pvd");
    let kept = fs::read_to_string(&list).unwrap();
    let time = kept.split("timestep=\"").nth(3).and_then(|rest| rest.split('"').next()).unwrap();
    let other = format!("{:e}", 1.5 * time.parse::<f64>().unwrap());
    fs::write(&list, kept.replace(time, &other)).unwrap();
    let ran = workplace.run(&["check", "out"]);
    assert_eq!(ran.code, Some(2), "{}", ran.stdout);
    assert!(ran.stderr.contains("it has 00002.vtu at t = "), "{}", ran.stderr);
    fs::write(&list, &kept).unwrap();
    // What is behind the checkpoint has no sum, and is read.
    for name in ["reactions.csv", "groups.csv", "group_contacts.csv", "removed.csv"] {
        let path = workplace.path("out").join(name);
        let kept = fs::read(&path).unwrap();
        fs::write(&path, [&kept[..], b"half a row\n"].concat()).unwrap();
        let ran = workplace.run(&["check", "out"]);
        assert_eq!(ran.code, Some(2), "{name}: {}", ran.stdout);
        assert!(ran.stderr.contains(name), "{name}: {}", ran.stderr);
        fs::write(&path, &kept).unwrap();
    }
    assert_eq!(workplace.succeed(&["check", "out"]), whole);
    let set = workplace.run(&["check", "out", "--set", "cells=4"]);
    assert_eq!(set.code, Some(2), "{}", set.stdout);
    assert!(set.stderr.contains("a folder of results has no parameters to set"), "{}", set.stderr);
    // Tables are held against their sums when a run goes on, too.
    let table = workplace.path("out/energy.csv");
    let text = fs::read_to_string(&table).unwrap();
    let digit = text.find("\n0.0").unwrap() + 4;
    let mut flipped = text.clone().into_bytes();
    flipped[digit] ^= 1;
    fs::write(&table, flipped).unwrap();
    let ran = workplace.run(&["resume", "out", "--until", "0.09"]);
    assert_eq!(ran.code, Some(2), "{}", ran.stderr);
    assert!(
        ran.stderr.contains("energy.csv") && ran.stderr.contains("bytes of it have changed"),
        "{}",
        ran.stderr
    );
    fs::write(&table, text).unwrap();
    workplace.succeed(&["resume", "out", "--until", "0.09"]);
}

/// The chart of a table that was cut would be another one.
#[test]
fn a_table_that_was_cut_is_not_taken_for_whole() {
    let workplace = workplace();
    workplace.succeed(&run_into("out"));
    for table in ["contacts", "bodies"] {
        let name = &format!("{table}.csv");
        let path = workplace.path("out").join(name);
        let kept = fs::read(&path).unwrap();
        let line = kept.iter().rposition(|&byte| byte == b'\n').unwrap();
        let row = kept[..line].iter().rposition(|&byte| byte == b'\n').unwrap() + 1;
        // A whole row, half a row, and nearly all.
        for length in [row, row + 5, 200] {
            fs::write(&path, &kept[..length]).unwrap();
            let ran = workplace.run(&["plot", "out", "--table", table]);
            assert_eq!(ran.code, Some(2), "{name}: {}{}", ran.stdout, ran.stderr);
            assert!(ran.stderr.contains(name) && ran.stderr.contains("it was cut"), "{}", ran.stderr);
        }
        fs::write(&path, kept).unwrap();
    }
    let plot = ["plot", "out", "--table", "contacts"];
    workplace.succeed(&plot);
    fs::write(workplace.path("out/contacts.csv"), "garbage").unwrap();
    let garbage = workplace.run(&plot);
    assert_eq!(garbage.code, Some(2), "{}", garbage.stdout);
}

/// VTK's reader, the one inside ParaView, reads what was written before a disk was full.
#[test]
fn paraview_reads_what_was_written_before_a_disk_was_full() {
    let named = std::env::var("STICKSLIP_PYTHON").ok();
    let python = named.unwrap_or_else(|| "python3".into());
    let find = "import importlib.util as i, sys; sys.exit(i.find_spec('vtk') is None)";
    let has_vtk = Command::new(&python).args(["-c", find]).status().is_ok_and(|status| status.success());
    let workplace = workplace();
    let Some(_disk) = Disk::mount(workplace.path("disk"), 700).filter(|_| has_vtk) else {
        eprintln!("skipped: no package `vtk`, or no disk may be mounted");
        return;
    };
    let ran = workplace.run(&run_into("disk/out"));
    assert_eq!(ran.code, Some(1), "{}", ran.stderr);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../stickslip/tests/read_with_vtk.py");
    let series = workplace.path("disk/out/particles.pvd");
    let output = Command::new(&python).arg(script).arg(series).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let read: Vec<Vec<serde_json::Value>> = serde_json::from_slice(&output.stdout).unwrap();
    assert!(read[0].len() > 2, "{} snapshots", read[0].len());
    assert!(read[0].iter().all(|snapshot| snapshot["complaints"] == serde_json::json!([])));
}
