//! The same problem with other programs, as their users write it.

use crate::record::PeerResult;
use miette::miette;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use stickslip::observe::{OutputError, replace};
use stickslip_cli::bench::{BenchExtent, Effort, Failure};

/// Taichi and NVIDIA Warp from the Python package index.
pub struct Peers {
    /// Folder of the Python environment, made if it is not there.
    pub environment: PathBuf,
    /// How much is measured.
    pub extent: BenchExtent,
}

/// Packages that are installed; the newest of each, and what runs is in the report.
const PACKAGES: [&str; 3] = ["numpy", "taichi", "warp-lang"];
const CUBE: &str = include_str!("../../bench/peers/cube.py");
const SCRIPTS: [(&str, &str); 2] = [
    ("Taichi", include_str!("../../bench/peers/with_taichi.py")),
    ("Warp", include_str!("../../bench/peers/with_warp.py")),
];

impl Peers {
    /// Runs them, one after the other.
    ///
    /// # Errors
    /// A script fails.
    pub fn measure(&self, python: &Path) -> Result<Vec<PeerResult>, Failure> {
        let mut results = Vec::new();
        for (program, script) in SCRIPTS {
            eprintln!("{program} ...");
            results.extend(self.run(python, program, script)?);
        }
        Ok(results)
    }

    /// The environment's Python; the environment is made and the packages are installed first where they are missing.
    ///
    /// # Errors
    /// There is no Python 3, or the packages cannot be installed; each says what to do.
    pub fn prepare(&self) -> Result<PathBuf, Failure> {
        let python = self.environment.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
        let ready = quiet(&python).args(["-c", "import numpy, taichi, warp"]).status();
        if !ready.is_ok_and(|status| status.success()) {
            eprintln!("installing {} into {} ...", PACKAGES.join(", "), self.environment.display());
            let made = Command::new("python3").args(["-m", "venv"]).arg(&self.environment).status();
            succeeded(made, "cannot make a Python environment", "install Python 3 with its `venv`")?;
            let installed = Command::new(&python)
                .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"])
                .args(PACKAGES)
                .status();
            let advice = "both need a 64-bit processor and a Python that their wheels are made for";
            succeeded(installed, "cannot install Taichi and Warp", advice)?;
        }
        Ok(python)
    }

    fn run(&self, python: &Path, program: &str, script: &str) -> Result<Vec<PeerResult>, Failure> {
        let write = |name: &str, text: &str| {
            let path = self.environment.join(name);
            replace(&path, |file| file.write_all(text.as_bytes()))
                .map_err(|OutputError { source: error, .. }| {
                    Failure::Run(miette!("cannot write {}: {error}", path.display()))
                })
                .map(|()| path)
        };
        write("cube.py", CUBE)?;
        let script = write("script.py", script)?;
        let results = self.environment.join("results.json");
        let (cells, effort) = self.effort();
        let ran = quiet(python)
            .arg(script)
            .args(["--cells", &cells.to_string()])
            .args(["--warm-up", &effort.warm_up.to_string()])
            .args(["--repetitions", &effort.repetitions.to_string()])
            .args(["--steps", &effort.steps.to_string()])
            .args(["--seconds", &effort.seconds.to_string()])
            .arg("--out")
            .arg(&results)
            .stderr(Stdio::inherit())
            .status();
        succeeded(ran, &format!("cannot run {program}"), "see above what it says")?;
        let text = std::fs::read(&results)
            .map_err(|error| Failure::Run(miette!("{program} wrote no results: {error}")))?;
        serde_json::from_slice(&text).map_err(|error| Failure::Run(miette!("{program}: {error}")))
    }

    /// Cells along the cube, and how long to step.
    fn effort(&self) -> (usize, Effort) {
        match self.extent {
            BenchExtent::Full => {
                (32, Effort { warm_up: 8, repetitions: 5, least: 1, steps: 48, seconds: 15.0 })
            }
            BenchExtent::Quick => {
                (32, Effort { warm_up: 2, repetitions: 3, least: 1, steps: 32, seconds: 1.2 })
            }
            BenchExtent::Tiny => (4, Effort { warm_up: 1, repetitions: 2, least: 1, steps: 2, seconds: 0.1 }),
        }
    }
}

/// A program whose output nobody reads.
fn quiet(program: &Path) -> Command {
    let mut command = Command::new(program);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

fn succeeded(
    ended: std::io::Result<std::process::ExitStatus>,
    wrong: &str,
    advice: &str,
) -> Result<(), Failure> {
    match ended {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(Failure::Run(miette!(help = advice.to_owned(), "{wrong}: it ended with {status}"))),
        Err(error) => Err(Failure::Run(miette!(help = advice.to_owned(), "{wrong}: {error}"))),
    }
}
