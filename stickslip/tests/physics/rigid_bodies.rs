//! Rigid bodies with prescribed motion do the work that the others gain.
//!
//! Source: energy theorem. Set-ups: a rigid punch, set in motion over some milliseconds, pushes a free soft block
//! without friction; a rigid belt runs under a soft block that lies on it, with friction;
//! a rigid cylinder turns in place.
//!
//! Expected: work of the prescribed motion = kinetic + strain energy + dissipated by friction, within 3 % for the punch
//! and 5 % for the belt: contact on the grid is slightly inelastic. The impulse in the table is the block's momentum to
//! 1e-10. The belt drags with mu times the normal impulse, m (g t + vy) of a block that shakes on it, within 1 %. Rigid
//! bodies move by the integral of their velocity to the second order of the step: 1e-6 m for the punch, whose speed has
//! a kink. A turn of w dt a step by (I - W dt/2)^-1 (I + W dt/2) lags by (w dt)^2/12 of the angle: 1.33e-4 of a radian
//! in all for the cylinder, whose steps of 0.02 s only its own rim limits; 1 % above that is allowed.

use crate::trial::{RUBBER, largest_difference, run_to, start};
use stickslip::door::ContactCursor;

#[test]
fn a_punch_pushes_a_block() {
    for law in ["surface", "gap", "kinematic", "traction"] {
        let scene = format!(
            r#"
            space = {{ dimension = "plane-strain", interior = "grid", cell = 0.05 }}
            time.end = 1
            {RUBBER}
            [[bodies]]
            name = "block"
            material = "rubber"
            shape.box = {{ min = [0, 0], max = [1, 0.5] }}
            [[bodies]]
            name = "punch"
            material = "rubber"
            shape.box = {{ min = [-0.2, -0.1], max = [0, 0.6] }}
            rigid = {{ velocity = ["0.5 m/s * min(t / 50 ms, 1)", 0] }}
            [[contact]]
            law = "{law}"
            normal = "common"
            "#
        );
        let mut simulation = start(&scene);
        let (from, end) = (simulation.bodies()[1].position[0], 0.15);
        let (mut impulse, mut last) = (0.0, 0.0);
        let mut cursor = ContactCursor::default();
        run_to(&mut *simulation, end, |s| {
            let dt = s.time() - last;
            last = s.time();
            impulse += cursor.read(s).iter().map(|contact| contact.mean.force[0] * dt).sum::<f64>();
        });
        let (ledger, bodies) = (simulation.ledger(), simulation.bodies());
        let gained = ledger.kinetic + ledger.strain + ledger.friction;
        let momentum = bodies[0].mass * bodies[0].velocity[0];
        let moved = bodies[1].position[0] - from - (0.5 * 0.5 * 0.05 + 0.5 * (end - 0.05));
        println!(
            "{law}: work {:.4} J, gained/work {:.4}, impulse/momentum - 1 {:.1e}, punch off by {moved:.1e} m",
            ledger.external_work,
            gained / ledger.external_work,
            (impulse.abs() / momentum) - 1.0
        );
        assert!(
            (impulse.abs() / momentum - 1.0).abs() < 1e-10,
            "{law}: impulse {impulse}, momentum {momentum}"
        );
        assert!(moved.abs() < 1e-6, "{law}: the punch is off by {moved} m");
        if law == "surface" || law == "gap" {
            let found = gained / ledger.external_work;
            assert!((found - 1.0).abs() < 0.03, "{law}: gained/work {found}");
        }
    }
}

#[test]
fn a_belt_drags_a_block() {
    let friction = 0.3;
    let scene = format!(
        r#"
        gravity = [0, -10]
        space = {{ dimension = "plane-strain", interior = "grid", cell = 0.1 }}
        time.end = 1
        {RUBBER}
        [[bodies]]
        name = "belt"
        material = "rubber"
        shape.box = {{ min = [-1, -0.3], max = [2, 0] }}
        rigid = {{ velocity = [-4, 0] }}
        [[bodies]]
        name = "block"
        material = "rubber"
        shape.box = {{ min = [-0.5, 0], max = [0.5, 0.5] }}
        [[contact]]
        friction = {friction}
        "#
    );
    let (mut simulation, end) = (start(&scene), 0.25);
    let before = simulation.ledger();
    run_to(&mut *simulation, end, |_| {});
    let (block, ledger) = (simulation.bodies()[1].clone(), simulation.ledger());
    // The floor's impulse is what gravity gave and what the block still bounces with.
    let ratio = block.velocity[0] / (-friction * (10.0 * end + block.velocity[1]));
    let gained = ledger.total + ledger.external_work - before.total;
    println!("belt: vx/(mu (g t + vy)) {ratio:.4}, gained/work {:.4}", gained / ledger.external_work);
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
    assert!((gained / ledger.external_work - 1.0).abs() < 0.05, "{gained} of {}", ledger.external_work);
}

#[test]
fn a_cylinder_turns_about_its_centre() {
    let (spin, end) = (2.0, 0.5);
    let mut simulation = start(
        r#"
        space = { dimension = "plane-strain", interior = "grid", cell = 0.1 }
        time.end = 1
        materials.rubber = { density = 1000, neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 } }
        [[bodies]]
        name = "wheel"
        material = "rubber"
        shape.ball = { center = [0, -1], radius = 1 }
        rigid = { spin = 2 }
        "#,
    );
    let first = simulation.snapshot();
    run_to(&mut *simulation, end, |_| {});
    let (sin, cos) = f64::sin_cos(spin * end);
    let turned: Vec<[f64; 3]> = (first.position.iter())
        .map(|x| [cos * x[0] - sin * (x[1] + 1.0), sin * x[0] + cos * (x[1] + 1.0) - 1.0, 0.0])
        .collect();
    let off = largest_difference(&simulation.snapshot().position, &turned);
    println!("wheel: off by {off:.1e} m of 1 m after {} rad", spin * end);
    let step = end / simulation.steps() as f64;
    let lag = (spin * step).powi(2) / 12.0 * spin * end;
    assert!(off < 1.01 * lag, "{off:e} m, the scheme's own lag is {lag:e}");
}

/// Floors as wide as the block, one a hair further left or right than the other: 1e-12 of a cell more or less of it
/// reaches the nodes beside the block, where a rigid body acts in full or not at all.
#[test]
fn a_hair_of_a_rigid_body_at_a_node_does_nothing() {
    let run = |drift: f64| {
        let mut simulation = start(&format!(
            r#"
            space = {{ dimension = "plane-strain", interior = "grid", cell = 0.1 }}
            time = {{ end = 1, max_step = "0.5 ms" }}
            {RUBBER}
            [[bodies]]
            name = "block"
            material = "rubber"
            shape.box = {{ min = [0, 0], max = [1, 0.5] }}
            velocity = [0, -2]
            [[bodies]]
            name = "floor"
            material = "rubber"
            shape.box = {{ min = [0, -0.3], max = [1, 0] }}
            rigid = {{ velocity = [{drift}, 0] }}
            "#
        ));
        let mut path = Vec::new();
        run_to(&mut *simulation, 0.05, |s| path.push(s.bodies()[0].velocity));
        path
    };
    let [left, right] = [-1e-12, 1e-12].map(run);
    let off = largest_difference(&left, &right);
    println!("hair: velocity off by {off:.1e} m/s of 2 m/s");
    assert!(off < 1e-9, "{off:e} m/s");
}
