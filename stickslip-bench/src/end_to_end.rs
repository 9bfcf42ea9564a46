//! Problem P6: whole runs as a user starts them, with and without outputs, checks and checkpoints.

use crate::record::EndToEnd;
use miette::miette;
use std::path::{Path, PathBuf};
use stickslip_cli::bench::{BenchExtent, BenchSample, BenchTask, Failure, Order};

/// A scene of the paper that is run whole.
pub struct WholeRun {
    /// Its name.
    pub name: &'static str,
    scene: &'static str,
    overrides: &'static [(&'static str, &'static str)],
}

const SPHERE: &str = include_str!("../../scenes/paper/inclined_plane_no_slip.toml");
const DISKS: &str = include_str!("../../scenes/paper/disks_collinear.toml");
/// Runs of each kind; they take turns, so that a disturbance hits all of them.
const REPETITIONS: usize = 3;
/// What takes the outputs away, but for the first and the last row of each table.
const SILENT: [(&str, &str); 3] =
    [("outputs.tables", "1e9 s"), ("outputs.particles", "never"), ("outputs.grid", "never")];

/// Checkpoints in a run that has some: many, so that what they add can be told from what else varies.
const CHECKPOINTS: u32 = 20;
/// Seconds from one checkpoint to the next in the ratio that is asked for.
const APART: f64 = 60.0;

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
    /// Runs it as it is, without outputs, and with checkpoints, each in a process of its own. What checks take a run
    /// counts itself: it is less than what runs differ by.
    ///
    /// # Errors
    /// The scene has mistakes, a run fails, or its folder cannot be written.
    pub fn measure(&self, threads: usize) -> Result<EndToEnd, Failure> {
        let folder = TemporaryFolder::new()?;
        let own: Vec<(String, String)> = owned(self.overrides);
        let end =
            stickslip::scene::parse("benchmark", self.scene, &own).map_err(Failure::input)?.scene.time.end;
        let checkpoints =
            vec![("outputs.checkpoints".to_owned(), format!("{} s", end / f64::from(CHECKPOINTS)))];
        let kinds = [Vec::new(), owned(&SILENT), checkpoints];
        let mut samples: [Vec<BenchSample>; 3] = Default::default();
        for _ in 0..REPETITIONS {
            for (changes, samples) in kinds.iter().zip(&mut samples) {
                let order = Order {
                    scene: self.scene.to_owned(),
                    overrides: own.iter().chain(changes).cloned().collect(),
                    threads,
                    task: BenchTask::Run(folder.0.clone()),
                };
                samples.push(order.measure()?);
            }
        }
        let least = |times: Vec<f64>| times.into_iter().fold(f64::INFINITY, f64::min);
        let wall = |samples: &[BenchSample]| samples.iter().flat_map(|ran| ran.repetitions.clone()).collect();
        let [with_outputs, without_outputs]: [Vec<f64>; 2] = [wall(&samples[0]), wall(&samples[1])];
        // Of the processor, where the system tells it: other programs hardly disturb it.
        let work = |samples: &[BenchSample]| {
            least(
                samples
                    .iter()
                    .filter_map(|ran| ran.processor_time.or(ran.repetitions.first().copied()))
                    .collect(),
            )
        };
        let [whole, saving] = [0, 2].map(|kind: usize| work(&samples[kind]));
        let in_checks =
            |ran: &BenchSample| ran.verbs.iter().find(|(verb, _)| verb == "checks").map(|(_, s)| *s);
        let checks: f64 = samples[0].iter().filter_map(in_checks).sum();
        let run: f64 = with_outputs.iter().sum();
        let sample = samples[0].first().expect("there are repetitions");
        Ok(EndToEnd {
            scene: self.name.to_owned(),
            threads,
            particles: sample.particles,
            steps: sample.steps,
            ratio: least(with_outputs.clone()) / least(without_outputs.clone()),
            checks: run / (run - checks),
            checkpoints: 1.0 + (saving - whole) / f64::from(CHECKPOINTS) / APART,
            with_outputs,
            without_outputs,
        })
    }
}

fn owned(pairs: &[(&str, &str)]) -> Vec<(String, String)> {
    pairs.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect()
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
