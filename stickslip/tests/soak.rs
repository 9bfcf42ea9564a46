//! A run of ten million steps takes no more memory than one of a million, and keeps its energy.
//!
//! Set-up: two soft blocks of four cells that stand on the floor of a domain, one beside the other, when gravity is
//! switched on, in the plane: they swing for ten million steps.
//!
//! Expected: the memory of the process does not grow between the first million steps and the last by more than a
//! megabyte. No energy comes from nowhere. Exact bodies would swing for ever; these come to rest, and half of what the
//! fall set free, that of the swing, is lost, which no term of the ledger has: 0.482 was found, a known miss, and the
//! strain energy at rest is the other half.

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
shape.box = { min = [-0.25, 0], max = [-0.05, 0.2] }
[[bodies]]
name = "right"
material = "rubber"
shape.box = { min = [0.05, 0], max = [0.25, 0.2] }
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
    assert!((-0.51..=0.001).contains(&drift), "{drift}");
    assert!((end.strain / fallen - 0.5).abs() < 0.02, "{}", end.strain / fallen);
    assert_eq!(simulation.steps(), 10_000_000);
}
