//! A body at rest presses with its weight, and what contacts push is what bodies gain.
//!
//! Source: Newton's second and third law. Set-up: a soft block falls from no height on a rigid floor; the same with a
//! soft floor that is fixed below. It shakes up and down, as nothing damps it.
//!
//! Expected: the contact force averaged over the run is the weight within 2 % (a mean over whole shakes would be
//! exact); the momentum of the block is the sum of contact force times time and its weight times time, to 1e-10 of
//! weight times time: each impulse of the table is the one that the body took.

use crate::trial::{distance, run_to, start};
use stickslip::door::ContactCursor;

fn scene(floor: &str) -> String {
    format!(
        r#"
        gravity = [0, -10]
        [space]
        dimension = "plane-strain"
        interior = "grid"
        cell = 0.1
        domain = {{ min = [-2, -0.3], max = [3, 2], y_min = "fixed" }}
        [time]
        end = 1
        [materials]
        rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1e6, poisson_ratio = 0.3 }} }}
        [[bodies]]
        name = "floor"
        material = "rubber"
        shape.box = {{ min = [-1, -0.3], max = [2, 0] }}
        {floor}
        [[bodies]]
        name = "block"
        material = "rubber"
        shape.box = {{ min = [0, 0], max = [1, 0.5] }}
        "#
    )
}

#[test]
fn contact_carries_the_weight() {
    for (name, floor) in [("rigid", "rigid = {}"), ("soft", "")] {
        let mut simulation = start(&scene(floor));
        let weight = simulation.bodies()[1].mass * 10.0;
        let (mut impulse, mut last, mut worst) = ([0.0; 3], 0.0, 0.0_f64);
        let end = 2.0;
        let mut cursor = ContactCursor::default();
        run_to(&mut *simulation, end, |s| {
            let dt = s.time() - last;
            last = s.time();
            for contact in cursor.read(s) {
                (0..3).for_each(|i| impulse[i] += contact.mean.force[i] * dt);
            }
            let block = &s.bodies()[1];
            let expected = [impulse[0], impulse[1] - weight * s.time(), impulse[2]];
            worst =
                worst.max(distance(block.velocity.map(|v| v * block.mass), expected) / (weight * s.time()));
        });
        let mean = impulse[1] / end / weight;
        println!("{name} floor: mean force / weight {mean:.4}, momentum against impulse {worst:.1e}");
        assert!((mean - 1.0).abs() < 0.02, "{name}: {mean}");
        assert!(worst < 1e-10, "{name}: {worst:e}");
    }
}
