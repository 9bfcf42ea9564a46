//! A run of ten million steps, with a table, health checks and checkpoints, takes no more memory than one of a million,
//! and keeps its energy.
//!
//! Set-up: two soft blocks of four cells that stand on the floor of a domain, one beside the other, when gravity is
//! switched on, in the plane: they swing for ten million steps. A row of the tables every ten thousand steps, 200 looks
//! of the health checks, and fifty checkpoints, of which two are kept.
//!
//! Expected: the memory of the process does not grow between the first million steps and the last by more than a
//! megabyte. No energy comes from nowhere. Exact bodies would swing for ever; these come to rest, and half of what the
//! fall set free, that of the swing, is lost, which no term of the ledger has: 0.482 was found, a known miss, and the
//! strain energy at rest is the other half. The run says so.
//!
//! `STICKSLIP_SOAK_STEPS=200000` takes fewer steps.

use stickslip::door::View;
use stickslip::observe::{Checkpoint, Observer, OutputError, Results, Status};
use stickslip::run::{Checkpointing, RunOptions, run_with};
use stickslip::scene::parse;

/// Length of a step, below the stable one [s].
const STEP: f64 = 2.5e-3;

const SCENE: &str = r#"
gravity = [0, -10]
parameters.steps = 1
[space]
dimension = "plane-strain"
interior = "grid"
cell = 0.1
domain = { min = [-1, 0], max = [1, 1], y_min = "fixed" }
[time]
end = "steps * 2.5 ms"
max_step = "2.5 ms"
[materials.rubber]
density = 1000
neo_hookean = { young_modulus = 1e5, poisson_ratio = 0.3 }
[[bodies]]
name = "left"
material = "rubber"
shape.box = { min = [-0.25, 0], max = [-0.05, 0.2] }
[[bodies]]
name = "right"
material = "rubber"
shape.box = { min = [0.05, 0], max = [0.25, 0.2] }
[[contact]]
between = ["left", "right"]
friction = 0.3
[outputs]
tables = "steps * 2.5 ms / 1000"
checkpoints = "steps * 2.5 ms / 50"
particles = "never"
"#;

/// Resident memory of this process [bytes].
fn resident() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
    line.trim().trim_end_matches(" kB").trim().parse::<f64>().unwrap() * 1024.0
}

/// Reads the memory after a part of the steps, and at the end.
struct Watch {
    early: f64,
    resident: Vec<f64>,
}

impl Observer for Watch {
    fn next(&self) -> f64 {
        if self.resident.is_empty() { self.early } else { f64::INFINITY }
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        if view.time() >= self.early {
            self.resident.push(resident());
        }
        Ok(())
    }
}

#[test]
#[ignore = "slow"]
#[cfg(target_os = "linux")]
fn ten_million_steps_take_no_more_memory_than_one_million() {
    let steps: u64 = std::env::var("STICKSLIP_SOAK_STEPS").map_or(10_000_000, |steps| steps.parse().unwrap());
    let scene = parse("soak.toml", SCENE, &[("steps".to_owned(), steps.to_string())]).unwrap().scene;
    let mut simulation = stickslip::step::build(&scene).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let checkpoints = Checkpointing { at_end: true, ..Checkpointing::default() };
    let options = RunOptions { threads: 1, checkpoints, ..RunOptions::new(folder.path().join("results")) };
    let mut watch = Watch { early: 0.1 * steps as f64 * STEP, resident: Vec::new() };
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let summary =
        alone.install(|| run_with(&scene, &mut *simulation, &options, &mut [&mut watch], &mut |_| {}));
    let summary = summary.unwrap();
    let (start, end) = (&summary.start, &summary.end);
    let fallen = start.potential - end.potential;
    let drift = (end.total - start.total) / fallen;
    let grown = watch.resident.last().unwrap() - watch.resident[0];
    println!("grown by {grown} bytes, energy drifts by {drift:e} of what the fall set free\n{summary}");
    assert!(grown < 1e6, "{grown} bytes");
    assert!((-0.51..=0.001).contains(&drift), "{drift}");
    assert!((end.strain / fallen - 0.5).abs() < 0.02, "{}", end.strain / fallen);

    assert_eq!(summary.status, Status::Finished);
    assert!(summary.performance.steps.abs_diff(steps) <= 1, "{}", summary.performance.steps);
    let results = Results::open(&options.out).unwrap();
    let rows = results.energy_table().unwrap().len();
    assert!((1000..=1002).contains(&rows), "{rows} rows");
    let looks = results.manifest().looks;
    assert!((195..=205).contains(&looks), "{looks} looks");
    let kinds: Vec<&str> = summary.warnings.iter().map(|warning| warning.kind.as_str()).collect();
    assert_eq!(kinds, ["energy"]);
    assert_eq!(Checkpoint::list(&options.out).unwrap().len(), 2);
}
