//! What a scene is told to take in memory is what it takes.

use stickslip_engine::check::{BodySize, Footprint, report};
use stickslip_engine::footprint::OfEngine;
use stickslip_engine::scene::{Scene, parse};
use stickslip_engine::step::build;

/// A block with its lower face at a height above a floor without bounds; surfaces between nodes, as they are once
/// bodies have moved.
fn scene(block: &str, height: f64) -> Scene {
    let text = format!(
        r#"
        space = {{ dimension = "3d", interior = "grid", cell = 0.1 }}
        time.end = 1
        materials.rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1e6, poisson_ratio = 0.3 }} }}
        [[bodies]]
        name = "block"
        material = "rubber"
        {block}
        shape.box = {{ min = [-0.03, -0.03, {height}], max = [1.97, 1.97, {top}] }}
        [[bodies]]
        name = "floor"
        material = "rubber"
        rigid = {{}}
        shape.half_space = {{ point = [0, 0, -0.03], normal = [0, 0, 1] }}
        "#,
        top = height + 1.0
    );
    parse("block.toml", &text, &[]).unwrap_or_else(|e| panic!("{e:?}")).scene
}

fn of_floor(scene: &Scene) -> usize {
    report(scene, &OfEngine).expect("no problem").bodies[1].particles
}

/// What the engine fills around a block at rest, within a fifth; as many where the block is above the floor yet.
#[test]
fn a_floor_without_bounds_counts_with_what_the_run_will_have() {
    let resting = scene("", -0.03);
    let mut simulation = build(&resting).expect("no problem");
    simulation.step(1e-6).expect("a step");
    let particles = simulation.particles() - 8 * 20 * 20 * 10;
    let found = of_floor(&resting);
    assert!((found as f64 / particles as f64 - 1.0).abs() < 0.2, "{found} of {particles}");
    let above = of_floor(&scene("", 2.97));
    assert!((above as f64 / found as f64 - 1.0).abs() < 0.2, "{above} {found}");
    assert_eq!(of_floor(&scene("rigid = {}", 2.97)), 0);
    // Bodies on grids of their own touch its shape.
    assert_eq!(of_floor(&scene("interior = \"reference\"", 2.97)), 0);
}

/// At least what the particles hold: 30 columns of 8 bytes, and numbers.
#[test]
fn the_memory_is_at_least_that_of_the_particles() {
    let report = report(&scene("", 2.97), &OfEngine).expect("no problem");
    let each = report.memory / report.particles as f64;
    assert!((30.0 * 8.0 + 4.0 * 4.0..400.0).contains(&each), "{each}");
}

/// The copy in a checkpoint takes what is saved, and not much more.
#[test]
fn the_copy_for_a_checkpoint_is_what_is_saved() {
    let scene = scene("", 2.97);
    let saved = build(&scene).expect("no problem").save().expect("it can be saved");
    let block = &saved.bodies[0];
    let bytes =
        block.columns.iter().map(|column| column.bytes.len()).sum::<usize>() + 4 * block.numbers.len();
    let sizes = [block.numbers.len(), 0].map(|particles| BodySize { particles, grid: None });
    let share = OfEngine.copy(&scene, &sizes) / bytes as f64;
    assert!((1.0..1.1).contains(&share), "{share}");
}
