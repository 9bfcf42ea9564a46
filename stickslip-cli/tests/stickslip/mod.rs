//! The program as a user runs it: in a folder of its own, with its output caught.
#![allow(dead_code, reason = "each test file uses a part")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// An empty folder to run the program in; it goes when the test ends.
pub struct Workplace(TempDir);

/// A short run of the new scene, and one with time for something to happen to it.
pub const SHORT: [&str; 4] = ["--set", "cells_per_radius=4", "--threads", "1"];
pub const LONG: [&str; 8] = [
    "--set",
    "cells_per_radius=10",
    "--set",
    "time.end=0.9",
    "--set",
    "outputs.checkpoints=0.01",
    "--threads",
    "1",
];

/// A short run of it with many files.
pub const MANY_FILES: [&str; 12] = [
    "--set",
    "cells_per_radius=4",
    "--set",
    "time.end=0.08",
    "--set",
    "outputs.tables=0.001",
    "--set",
    "outputs.particles=0.004",
    "--set",
    "outputs.grid=0.01",
    "--set",
    "outputs.checkpoints=0.01",
];

/// Words, and more of them.
pub fn with<'a>(words: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    [words, more].concat()
}

/// The new scene in a workplace, and its results by one process in `one`, as these words have it.
pub fn with_results(words: &[&str]) -> Workplace {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    workplace.succeed(&with(&["run", "scene.toml", "--quiet", "--out", "one"], words));
    workplace
}

/// A small disk of its own, while this lives.
pub struct Disk(PathBuf);

impl Disk {
    /// None where the test may not mount one.
    pub fn mount(path: PathBuf, kib: u32) -> Option<Self> {
        std::fs::create_dir(&path).unwrap();
        let size = format!("size={kib}k");
        let mounted = Command::new("mount").args(["-t", "tmpfs", "-o", &size, "tmpfs"]).arg(&path).output();
        mounted.is_ok_and(|output| output.status.success()).then_some(Disk(path))
    }

    pub fn grow(&self) {
        let grown = Command::new("mount").args(["-o", "remount,size=64m"]).arg(&self.0).status();
        assert!(grown.unwrap().success());
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg("--lazy").arg(&self.0).status();
    }
}

/// Processes of a run into a folder that MPI started, by rank.
pub fn ranks(out: &str) -> BTreeMap<usize, u32> {
    let all = std::fs::read_dir("/proc").unwrap().flatten();
    let all = all.filter_map(|entry| entry.file_name().to_str()?.parse::<u32>().ok());
    let of_run = all.filter_map(|pid| {
        let words = std::fs::read(format!("/proc/{pid}/cmdline")).ok()?;
        let words: Vec<&[u8]> = words.split(|&byte| byte == 0).collect();
        if words[0] != env!("CARGO_BIN_EXE_stickslip").as_bytes() || !words.contains(&out.as_bytes()) {
            return None;
        }
        let environment = std::fs::read_to_string(format!("/proc/{pid}/environ")).ok()?;
        let rank = environment.split('\0').find_map(|line| line.strip_prefix("OMPI_COMM_WORLD_RANK="));
        Some((rank?.parse().ok()?, pid))
    });
    of_run.collect()
}

/// What a run of the program left.
pub struct Ran {
    /// Exit code; `None` after a signal.
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Workplace {
    pub fn new() -> Self {
        Workplace(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    /// The program with its arguments, not yet running.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_stickslip"));
        command.args(arguments).current_dir(self.0.path());
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Ran {
        let output = self.command(arguments).output().unwrap();
        Ran {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Runs the program, which must succeed, and gives its standard output.
    pub fn succeed(&self, arguments: &[&str]) -> String {
        let ran = self.run(arguments);
        assert_eq!(ran.code, Some(0), "{arguments:?}: {}", ran.stderr);
        ran.stdout
    }
}

/// The scene that `stickslip new` writes.
pub fn new_scene() -> String {
    let workplace = Workplace::new();
    workplace.succeed(&["new"]);
    std::fs::read_to_string(workplace.path("scene.toml")).unwrap()
}

/// The record of a run.
pub fn record(folder: &Path) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(folder.join("run.json")).unwrap()).unwrap()
}

/// All files of results but the record and the checkpoints, and the sum of the last state.
pub fn outcome(folder: &Path) -> (BTreeMap<PathBuf, Vec<u8>>, serde_json::Value) {
    let mut files = BTreeMap::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(inside) = open.pop() {
        for entry in std::fs::read_dir(inside).unwrap().flatten() {
            let name = entry.path().strip_prefix(folder).unwrap().to_path_buf();
            if entry.path().is_dir() {
                open.extend((name != Path::new("checkpoints")).then(|| entry.path()));
            } else if name != Path::new("run.json") {
                files.insert(name, std::fs::read(entry.path()).unwrap());
            }
        }
    }
    (files, record(folder)["state_sum"].clone())
}

/// Whether there is one to go on from.
pub fn has_checkpoint(folder: &Path) -> bool {
    std::fs::read_dir(folder.join("checkpoints")).is_ok_and(|entries| {
        entries.flatten().any(|entry| entry.path().extension().is_some_and(|ending| ending == "checkpoint"))
    })
}

/// A Python that can drive a browser: `STICKSLIP_PYTHON`, else `python3`. `None` where there is no browser and nobody
/// requires one; `./check` installs both.
pub fn python_with_browser() -> Option<String> {
    let named = std::env::var("STICKSLIP_PYTHON").ok();
    let python = named.clone().unwrap_or_else(|| "python3".to_owned());
    let has = |program: &str, arguments: &[&str]| {
        Command::new(program).args(arguments).output().is_ok_and(|output| output.status.success())
    };
    let find = "import importlib.util as i, sys; sys.exit(i.find_spec('selenium') is None)";
    if !has(&python, &["-c", find]) || !has("chromedriver", &["--version"]) {
        let required = named.is_some() || std::env::var_os("CI").is_some();
        assert!(!required, "the packages chromium, chromium-driver, and selenium for {python} are needed");
        eprintln!("skipped: chromedriver, or the package `selenium` for {python}, is not there");
        return None;
    }
    Some(python)
}
