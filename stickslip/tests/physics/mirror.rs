//! Half a model with a symmetry face equals the whole.
//!
//! Source: identity. Set-up: a disk (a ball) that lies with its centre in the face falls on a soft slab, with friction,
//! so that the contact reaches across the face; the whole model has grid nodes in the plane of symmetry.
//! In the plane one face, in space two.
//!
//! Expected: particles of the half as those of the whole, to round-off of the steps taken: 1e-9 of the ball's size and
//! speed (the order of sums differs). With the stress updated last 1e5 times as much, which bounds what was measured
//! (4e-7 m): presumably since that update takes the velocity of nearly massless nodes as it is.

use crate::trial::{STRESS_UPDATES, largest_difference, start, take_steps};
use stickslip::door::{ContactCursor, ParticleSnapshot};

fn scene(dimension: &str, update: &str, half: bool) -> String {
    let low = if half { "0" } else { "-0.8" };
    let faces = match (half, dimension) {
        (false, _) => "",
        (true, "3d") => ", x_min = \"symmetry\", z_min = \"symmetry\"",
        (true, _) => ", x_min = \"symmetry\"",
    };
    let v =
        |x: &str, y: &str| if dimension == "3d" { format!("[{x}, {y}, {x}]") } else { format!("[{x}, {y}]") };
    let ball = format!("{{ ball = {{ center = {}, radius = 0.3 }} }}", v("0", "0.31"));
    let ball = match (half, dimension) {
        (false, _) => format!("shape.union = [{ball}]"),
        (true, _) => format!(
            "shape.intersection = [{ball}, {{ box = {{ min = {}, max = {} }} }}]",
            v("0", "0"),
            v("1", "1")
        ),
    };
    format!(
        r#"
        gravity = {}
        [space]
        dimension = "{dimension}"
        cell = 0.1
        domain = {{ min = {}, max = {}{faces} }}
        [time]
        end = 1
        stress_update = "{update}"
        [materials]
        rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1e5, poisson_ratio = 0.3 }} }}
        [[bodies]]
        name = "ball"
        material = "rubber"
        {ball}
        velocity = {}
        [[bodies]]
        name = "slab"
        material = "rubber"
        shape.box = {{ min = {}, max = {} }}
        [[contact]]
        friction = 0.3
        "#,
        v("0", "-10"),
        v(low, "-3"),
        v("0.8", "1"),
        v("0", "-2"),
        v(if half { "0" } else { "-0.5" }, "-0.3"),
        v("0.5", "0"),
    )
}

/// Positions and velocities of the particles that start in the half (the quarter),
/// in the order of their places at the start.
fn arranged(snapshot: &ParticleSnapshot, first: &ParticleSnapshot) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
    let inside = |x: &[f64; 3]| x[0] > 0.0 && (first.dimension == 2 || x[2] > 0.0);
    let mut order: Vec<usize> = (0..first.body.len()).filter(|&p| inside(&first.position[p])).collect();
    order.sort_by_key(|&p| (first.body[p], first.position[p].map(|x| (x * 1e6).round() as i64)));
    order.iter().map(|&p| (snapshot.position[p], snapshot.velocity[p])).unzip()
}

fn compare(dimension: &str, update: &str, steps: usize) {
    let [whole, half] = [false, true].map(|half| {
        let mut simulation = start(&scene(dimension, update, half));
        let first = simulation.snapshot();
        take_steps(&mut *simulation, steps);
        assert!(!ContactCursor::default().read(&*simulation).is_empty(), "the ball reaches the slab");
        arranged(&simulation.snapshot(), &first)
    });
    let position = largest_difference(&whole.0, &half.0);
    let velocity = largest_difference(&whole.1, &half.1);
    println!("{dimension}, {update}, {steps} steps: position {position:.1e} m, velocity {velocity:.1e} m/s");
    let amplified = if update == "last" { 1e5 } else { 1.0 };
    assert!(position < 0.3e-9 * amplified, "{dimension}, {update}: {position:e} m");
    assert!(velocity < 2e-9 * amplified, "{dimension}, {update}: {velocity:e} m/s");
}

#[test]
fn in_the_plane() {
    for update in STRESS_UPDATES {
        compare("plane-strain", update, 200);
    }
}

#[test]
fn in_space() {
    for update in STRESS_UPDATES {
        compare("3d", update, 100);
    }
}
