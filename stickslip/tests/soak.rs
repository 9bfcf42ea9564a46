//! A run of ten million steps takes no more memory than one of a million, and keeps its energy.
//!
//! Set-up: two soft blocks of four cells on a frictional floor, one beside the other, under gravity, let go from a little
//! above, in the plane.
//!
//! Expected: the memory of the process does not grow between the first million steps and the last by more than a
//! megabyte; the total of the ledger stays within 1 % of the energy that the fall set free.

use stickslip::march::March;
use stickslip::scene::parse;

const SCENE: &str = r#"
gravity = [0, -10]
[space]
dimension = "plane-strain"
cell = 0.1
domain = { min = [-1, 0], max = [1, 1], y_min = "fixed" }
[time]
end = 1e9
[materials.rubber]
density = 1000
neo_hookean = { young_modulus = 1e5, poisson_ratio = 0.3 }
[[bodies]]
name = "left"
material = "rubber"
shape.box = { min = [-0.25, 0.12], max = [-0.05, 0.32] }
[[bodies]]
name = "right"
material = "rubber"
shape.box = { min = [0.05, 0.12], max = [0.25, 0.32] }
[[contact]]
between = ["left", "right"]
friction = 0.3
"#;

/// Resident memory of this process [bytes].
fn resident() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
    line.trim().trim_end_matches(" kB").trim().parse::<f64>().unwrap() * 1024.0
}

#[test]
#[ignore = "slow"]
#[cfg(target_os = "linux")]
fn ten_million_steps_take_no_more_memory_than_one_million() {
    let scene = parse("soak.toml", SCENE, &[]).unwrap().scene;
    let mut simulation = stickslip::step::build(&scene).unwrap();
    let start = simulation.ledger();
    let mut way = March::to(scene.time.end);
    let mut steps =
        |count: u64| (0..count).for_each(|_| assert!(way.step(&mut *simulation).unwrap().is_some()));
    steps(1_000_000);
    let early = resident();
    steps(9_000_000);
    let grown = resident() - early;
    let end = simulation.ledger();
    let fallen = start.potential - end.potential;
    let drift = (end.total - start.total) / fallen;
    println!("grown by {grown} bytes, energy drifts by {drift:e} of what the fall set free, {end:?}");
    assert!(grown < 1e6, "{grown} bytes");
    assert!(drift.abs() < 0.01, "{drift}");
    assert_eq!(simulation.steps(), 10_000_000);
}
