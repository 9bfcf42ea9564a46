//! Empty space costs nothing.
//!
//! Source: the engine's promise that blocks exist only under particles. Set-up: two disks collide in a domain that just
//! holds them, and in one a thousand times as wide (a million times the area) with the same lower corner.
//!
//! Expected: the same bits, and the same nodes; no tolerance. Moving the lower corner as well changes where the grid
//! counts from and with it round-off, so only the number of nodes must stay and positions agree to 1e-9 of the disks.

use crate::trial::{largest_difference, start, take_steps};
use stickslip::door::{ContactCursor, GridSnapshot, ParticleSnapshot};

fn text(min: f64, max: f64) -> String {
    format!(
        r#"
        [space]
        dimension = "plane-strain"
        interior = "grid"
        cell = 0.0625
        domain = {{ min = [{min}, {min}], max = [{max}, {max}] }}
        [time]
        end = 1
        [materials]
        rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1000, poisson_ratio = 0.3 }} }}
        [[bodies]]
        name = "first"
        material = "rubber"
        shape.ball = {{ center = [0.25, 0.25], radius = 0.2 }}
        velocity = [0.1, 0.1]
        [[bodies]]
        name = "second"
        material = "rubber"
        shape.ball = {{ center = [0.6, 0.5], radius = 0.2 }}
        velocity = [-0.1, -0.1]
        "#
    )
}

fn run(text: &str) -> (ParticleSnapshot, GridSnapshot) {
    let mut simulation = start(text);
    take_steps(&mut *simulation, 80);
    assert!(!ContactCursor::default().read(&*simulation).is_empty(), "the disks meet");
    (simulation.snapshot(), simulation.grid_snapshot())
}

#[test]
fn a_larger_domain_changes_nothing() {
    let small = run(&text(0.0, 1.0));
    let large = run(&text(0.0, 1000.0));
    assert!(small == large, "the larger domain gives other bits");
    println!("{} particles, {} nodes in either domain", small.0.body.len(), small.1.body.len());

    let around = run(&text(-1024.0, 1024.0));
    assert_eq!(around.1.body.len(), small.1.body.len(), "nodes");
    let moved = largest_difference(&around.0.position, &small.0.position);
    println!("a lower corner a thousand times as far: {moved:.1e} m");
    assert!(moved < 0.2e-9, "{moved:e} m");
}
