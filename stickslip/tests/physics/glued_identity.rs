//! Bodies glued together equal one body.
//!
//! Source: identity. With one velocity for all bodies at every shared node, the grid sums the same particles as it does
//! for one body, in another order.
//!
//! Set-up: a block of soft rubber, spinning and flying, as one body; the same block cut along grid lines in two and in
//! three that meet at a node, glued. All stress updates, in the plane and in space.
//!
//! Expected: positions and velocities of all particles equal to round-off of the steps taken: 1e-9 of the block's size
//! and of its speed (measured about 1e-13; the largest seen stands in the printed line).

use crate::trial::{STRESS_UPDATES, largest_difference, start, take_steps};
use stickslip::door::ParticleSnapshot;

fn body(name: &str, min: &str, max: &str, motion: &str) -> String {
    format!(
        "[[bodies]]\nname = \"{name}\"\nmaterial = \"rubber\"\nshape.box = {{ min = {min}, max = {max} }}\n{motion}\n"
    )
}

fn scene(dimension: &str, update: &str, bodies: &str) -> String {
    format!(
        r#"
        space = {{ dimension = "{dimension}", interior = "grid", cell = 0.1 }}
        time = {{ end = 1, stress_update = "{update}" }}
        gravity = {}
        materials.rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1e5, poisson_ratio = 0.3 }} }}
        {bodies}
        [[contact]]
        law = "glued"
        "#,
        if dimension == "3d" { "[0, -10, 3]" } else { "[0, -10]" }
    )
}

/// Particles in the order of their position at the start, which the parts share with the whole.
fn arranged(snapshot: &ParticleSnapshot, start: &ParticleSnapshot) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
    let mut order: Vec<usize> = (0..start.body.len()).collect();
    let place = |p: usize| start.position[p].map(|x| (x * 1e6).round() as i64);
    order.sort_by_key(|&p| place(p));
    order.iter().map(|&p| (snapshot.position[p], snapshot.velocity[p])).unzip()
}

fn compare(name: &str, whole: &str, parts: &str, steps: usize) {
    let [whole, parts] = [whole, parts].map(|scene| {
        let mut simulation = start(scene);
        let first = simulation.snapshot();
        take_steps(&mut *simulation, steps);
        (arranged(&simulation.snapshot(), &first), simulation.time())
    });
    let positions = largest_difference(&whole.0.0, &parts.0.0);
    let velocities = largest_difference(&whole.0.1, &parts.0.1);
    println!(
        "{name}, {steps} steps: position {positions:.1e} m of 1 m, velocity {velocities:.1e} m/s of 3 m/s"
    );
    assert!((whole.1 - parts.1).abs() < 1e-12, "{name}: the same steps, {} {}", whole.1, parts.1);
    assert!(positions < 1e-9 && velocities < 1e-9 * 3.0, "{name}: {positions:e} m, {velocities:e} m/s");
}

#[test]
fn in_the_plane() {
    let motion = "velocity = [2, 1]";
    for update in STRESS_UPDATES {
        let scene = |bodies: &str| scene("plane-strain", update, bodies);
        let whole = scene(&body("whole", "[0, 0]", "[0.8, 0.6]", motion));
        let two =
            body("left", "[0, 0]", "[0.4, 0.6]", motion) + &body("right", "[0.4, 0]", "[0.8, 0.6]", motion);
        compare(&format!("plane, {update}, two"), &whole, &scene(&two), 300);
        let three = body("left", "[0, 0]", "[0.4, 0.6]", motion)
            + &body("below", "[0.4, 0]", "[0.8, 0.3]", motion)
            + &body("above", "[0.4, 0.3]", "[0.8, 0.6]", motion);
        compare(&format!("plane, {update}, three"), &whole, &scene(&three), 300);
    }
}

#[test]
fn in_space() {
    let motion = "velocity = [2, 1, 0.5]";
    for update in STRESS_UPDATES {
        let scene = |bodies: &str| scene("3d", update, bodies);
        let whole = scene(&body("whole", "[0, 0, 0]", "[0.8, 0.6, 0.4]", motion));
        let two = body("left", "[0, 0, 0]", "[0.4, 0.6, 0.4]", motion)
            + &body("right", "[0.4, 0, 0]", "[0.8, 0.6, 0.4]", motion);
        compare(&format!("space, {update}, two"), &whole, &scene(&two), 60);
        let three = body("left", "[0, 0, 0]", "[0.4, 0.6, 0.4]", motion)
            + &body("below", "[0.4, 0, 0]", "[0.8, 0.3, 0.4]", motion)
            + &body("above", "[0.4, 0.3, 0]", "[0.8, 0.6, 0.4]", motion);
        compare(&format!("space, {update}, three"), &whole, &scene(&three), 60);
    }
}
