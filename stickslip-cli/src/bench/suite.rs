//! Which problems are measured, one after the other.

use super::limits::{self, Care};
use super::measure::{BenchSample, BenchTask, Effort, Order};
use super::memory;
use super::multiply_add::instructions;
use super::problems::{BenchCase, BenchExtent, cases};
use super::record::{BenchRecord, Computer, Measured, Skipped};
use crate::failure::Failure;
use crate::files;
use crate::tell::tell;
use miette::miette;
use std::collections::BTreeSet;
use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// What is to be measured.
pub struct BenchSuite {
    /// How much of each problem.
    pub extent: BenchExtent,
    /// `P1` to `P5`; all if empty.
    pub only: Vec<String>,
    /// Most threads.
    pub threads: usize,
}

/// Names of the problems.
pub const PROBLEMS: [&str; 5] = ["P1", "P2", "P3", "P4", "P5"];

/// The name of one of these problems, as a user writes it.
///
/// # Errors
/// It is none of them; those that are allowed.
pub fn problem_of(problems: &[&str], text: &str) -> Result<String, String> {
    let name = text.trim().to_uppercase();
    if problems.contains(&name.as_str()) {
        Ok(name)
    } else {
        Err(format!("allowed: {}", problems.join(", ")))
    }
}

#[test]
fn problems_are_known_by_name() {
    assert_eq!(problem_of(&PROBLEMS, "p3").as_deref(), Ok("P3"));
    assert!(problem_of(&PROBLEMS, "P8").unwrap_err().contains("P5"));
}

/// What a process may need for a particle; a case is left out if the machine does not have so much [bytes].
const MEMORY: f64 = 1000.0;

impl BenchSuite {
    /// Measures everything, and says on standard error what it is at.
    ///
    /// # Errors
    /// A measurement fails.
    pub fn run(&self) -> Result<BenchRecord, Failure> {
        let machine = self.machine();
        #[expect(clippy::disallowed_methods, reason = "a date, not an interval")]
        let now = SystemTime::now();
        let mut record = BenchRecord {
            program: "stickslip",
            version: env!("CARGO_PKG_VERSION"),
            unix_time: now.duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs()),
            machine,
            results: Vec::new(),
            skipped: Vec::new(),
        };
        let cases: Vec<BenchCase> = self.cases().collect();
        for compared in cases.chunk_by(BenchCase::is_compared_with) {
            match compared.iter().find_map(too_large) {
                Some(reason) => record.skipped.extend(
                    compared.iter().map(|case| Skipped { case: case.clone(), reason: reason.clone() }),
                ),
                None => record.results.extend(self.measure(compared, &record.machine)?),
            }
        }
        Ok(record)
    }

    /// Whether a problem is to be measured.
    pub fn wants(&self, problem: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|only| only == problem)
    }

    fn cases(&self) -> impl Iterator<Item = BenchCase> {
        cases(self.extent, self.threads).into_iter().filter(|case| self.wants(case.problem))
    }

    fn machine(&self) -> Computer {
        tell!("the machine's limits ...");
        let care = match self.extent {
            BenchExtent::Full => Care { bytes: 512 << 20, duration: Duration::from_secs(1) },
            BenchExtent::Quick => Care { bytes: 256 << 20, duration: Duration::from_millis(300) },
            BenchExtent::Tiny => Care { bytes: 1 << 20, duration: Duration::from_millis(2) },
        };
        let threads = BTreeSet::from([1, self.threads]);
        Computer {
            processor: processor(),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            instructions: instructions(),
            limits: threads.into_iter().map(|threads| limits::measure(threads, care)).collect(),
        }
    }

    /// How long a case is stepped.
    pub fn effort(&self) -> Effort {
        match self.extent {
            BenchExtent::Full => Effort { warm_up: 8, repetitions: 5, least: 12, steps: 64, seconds: 15.0 },
            BenchExtent::Quick => Effort { warm_up: 2, repetitions: 3, least: 8, steps: 32, seconds: 1.2 },
            BenchExtent::Tiny => Effort { warm_up: 1, repetitions: 2, least: 1, steps: 2, seconds: 0.1 },
        }
    }

    /// Measures cases that are compared in turns: what slows the machine for a while slows all of them.
    fn measure(&self, compared: &[BenchCase], machine: &Computer) -> Result<Vec<Measured>, Failure> {
        let mut effort = self.effort();
        let turns = match (compared.len(), self.extent) {
            (1, _) => 1,
            (_, BenchExtent::Full) => TURNS,
            (_, _) => TURNS_OF_QUICK,
        };
        effort.seconds /= turns as f64;
        let mut samples: Vec<BenchSample> = Vec::new();
        for turn in 0..turns {
            for (i, case) in compared.iter().enumerate() {
                if turn == 0 {
                    tell!("{} ...", case.label());
                }
                let sample = order(case, effort).measure()?;
                match samples.get_mut(i) {
                    Some(sum) => sum.add(sample),
                    None => samples.push(sample),
                }
                // All repetitions have as many steps as the first.
                (effort.steps, effort.seconds) = (samples[0].steps, f64::MAX);
            }
        }
        let measured = |(case, sample): (&BenchCase, _)| Measured::new(case.clone(), sample, machine);
        Ok(compared.iter().zip(samples).map(measured).collect())
    }
}

/// How often cases that are compared take turns.
const TURNS: usize = 5;
const TURNS_OF_QUICK: usize = 2;

fn order(case: &BenchCase, effort: Effort) -> Order {
    Order {
        scene: case.scene.clone(),
        overrides: Vec::new(),
        threads: case.threads,
        task: BenchTask::Steps(effort),
    }
}

/// Why a case does not fit into the machine's memory, if it may not.
fn too_large(case: &BenchCase) -> Option<String> {
    let (needed, left) = (MEMORY * case.expected as f64, memory::available()? as f64);
    let gigabytes = |bytes: f64| format!("{:.1} GB", bytes / 1e9);
    (needed > left).then(|| format!("it may need {}, and {} are free", gigabytes(needed), gigabytes(left)))
}

/// What the processor calls itself.
fn processor() -> String {
    let table = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = table.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}

/// Writes the scene of every case that is wanted into a folder, to be run and looked at.
///
/// # Errors
/// The folder cannot be written.
pub fn write_scenes(suite: &BenchSuite, folder: &Path) -> Result<usize, Failure> {
    let cannot = |error| Failure::Input(miette!("cannot write scenes to {}: {error}", folder.display()));
    std::fs::create_dir_all(folder).map_err(cannot)?;
    let mut written = 0;
    for case in suite.cases().filter(|case| case.threads == 1) {
        let name = case.label().replace(", ", "_").replace(' ', "_") + ".toml";
        files::write_scene(&folder.join(name), &case.scene).map_err(cannot)?;
        written += 1;
    }
    Ok(written)
}
