//! Problem P6: whole runs as a user starts them, with and without outputs.

use super::measure::{BenchTask, Order};
use super::problems::BenchExtent;
use super::record::EndToEnd;
use crate::failure::Failure;
use miette::miette;
use std::path::{Path, PathBuf};

/// A scene of the paper that is run whole.
pub struct WholeRun {
    /// Its name.
    pub name: &'static str,
    scene: &'static str,
    overrides: &'static [(&'static str, &'static str)],
}

const SPHERE: &str = include_str!("../../../scenes/paper/inclined_plane_no_slip.toml");
const DISKS: &str = include_str!("../../../scenes/paper/disks_collinear.toml");
/// Runs with and runs without outputs; they take turns, so that a disturbance hits both kinds.
const REPETITIONS: usize = 3;
/// What takes the outputs away, but for the first and the last row of each table.
const SILENT: [(&str, &str); 3] =
    [("outputs.tables", "1e9 s"), ("outputs.particles", "never"), ("outputs.grid", "never")];

/// The scenes that are run whole.
pub fn wholes(extent: BenchExtent) -> Vec<WholeRun> {
    let sphere = |overrides| WholeRun { name: "sphere R/8", scene: SPHERE, overrides };
    let disks = |overrides| WholeRun { name: "disks n = 80", scene: DISKS, overrides };
    match extent {
        BenchExtent::Full => {
            vec![sphere(&[("cells_per_radius", "8")]), disks(&[("cells_per_diameter", "80")])]
        }
        BenchExtent::Quick => Vec::new(),
        BenchExtent::Tiny => vec![sphere(&[("cells_per_radius", "2"), ("time.end", "10 ms")])],
    }
}

impl WholeRun {
    /// Runs it with and without outputs, each in a process of its own.
    ///
    /// # Errors
    /// A run fails, or its folder cannot be written.
    pub fn measure(&self, threads: usize) -> Result<EndToEnd, Failure> {
        let folder = TemporaryFolder::new()?;
        let (mut with_outputs, mut without_outputs) = (Vec::new(), Vec::new());
        let mut sample = None;
        for _ in 0..REPETITIONS {
            for (silent, times) in [(&[][..], &mut with_outputs), (&SILENT[..], &mut without_outputs)] {
                let overrides = self.overrides.iter().chain(silent);
                let order = Order {
                    scene: self.scene.to_owned(),
                    overrides: overrides
                        .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
                        .collect(),
                    threads,
                    task: BenchTask::Run(folder.0.clone()),
                };
                let ran = order.measure()?;
                times.extend(&ran.repetitions);
                sample = Some(ran);
            }
        }
        let sample = sample.expect("there are repetitions");
        let fastest = |times: &[f64]| times.iter().copied().fold(f64::INFINITY, f64::min);
        Ok(EndToEnd {
            scene: self.name.to_owned(),
            threads,
            particles: sample.particles,
            steps: sample.steps,
            ratio: fastest(&with_outputs) / fastest(&without_outputs),
            with_outputs,
            without_outputs,
        })
    }
}

/// A folder for results that nobody will look at; it goes with this value.
struct TemporaryFolder(PathBuf);

impl TemporaryFolder {
    fn new() -> Result<Self, Failure> {
        let folder = std::env::temp_dir().join(format!("stickslip-bench-{}", std::process::id()));
        let cannot = |path: &Path, error| Failure::Run(miette!("cannot make {}: {error}", path.display()));
        std::fs::create_dir_all(&folder).map_err(|error| cannot(&folder, error))?;
        Ok(TemporaryFolder(folder))
    }
}

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        // What is left of it lies where the system clears up itself.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
