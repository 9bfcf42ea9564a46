//! Bodies that begin with velocities by the place, and rigid ones that go where they are told.
//!
//! Source: the first longitudinal mode of a free bar, v = v_0 cos(pi y / L), turns back after half a period L / c,
//! c^2 = E / rho; x = x_0 + u(t).
//!
//! Set-up: a bar of 6 by 1 m in plane stress in cells of 10 cm that begins with that velocity; the same with a part
//! that is a number; a rigid body on a path by a formula and one by a table.
//!
//! Expected: each particle has the velocity of its place to round-off, the bar the energy v_0^2 m / 4 to 1e-3, and
//! after half a period the reversed velocity at its ends within 3 %; rigid bodies are at u(t) to 1e-12 m after each
//! step.

use crate::trial::{mean_where, run_to, start};
use std::f64::consts::PI;

fn bar(velocity: &str) -> String {
    format!(
        r#"
        space = {{ dimension = "plane-stress", interior = "grid", cell = 0.1 }}
        time.end = 0.1
        materials.soft = {{ density = 1100, neo_hookean = {{ young_modulus = 17e6, poisson_ratio = 0.3 }} }}
        [[bodies]]
        name = "bar"
        material = "soft"
        shape.box = {{ min = [-1, 0], max = [0, 6] }}
        velocity = {velocity}
        "#
    )
}

#[test]
fn a_bar_begins_in_its_first_mode() {
    let mut simulation = start(&bar(r#"[0, "1 m/s * cos(pi * y / 6 m)"]"#));
    let begun = simulation.snapshot();
    for (place, velocity) in begun.position.iter().zip(&begun.velocity) {
        let exact = (PI * place[1] / 6.0).cos();
        assert!((velocity[1] - exact).abs() < 1e-12 && velocity[0] == 0.0, "{velocity:?} at {place:?}");
    }
    let ledger = simulation.ledger();
    assert!((ledger.kinetic / (0.25 * 6600.0) - 1.0).abs() < 1e-3, "{ledger:?}");
    assert!(ledger.momentum[1].abs() < 1e-9, "{ledger:?}");
    run_to(&mut *simulation, 6.0 / (17e6_f64 / 1100.0).sqrt(), |_| {});
    let turned = simulation.snapshot();
    let end = mean_where(&turned, |p| begun.position[p][1] > 5.9, |p| turned.velocity[p][1]);
    println!("end at half a period: {end:.4} m/s");
    assert!((end - 1.0).abs() < 0.03, "{end}");
}

#[test]
fn numbers_and_formulas_go_together() {
    let simulation = start(&bar(r#"[2, "y * 1 Hz"]"#));
    let begun = simulation.snapshot();
    for (place, velocity) in begun.position.iter().zip(&begun.velocity) {
        assert!((velocity[0] - 2.0).abs() < 1e-14 && (velocity[1] - place[1]).abs() < 1e-12, "{velocity:?}");
    }
}

#[test]
fn rigid_bodies_follow_their_paths() {
    let more = r#"
        [[bodies]]
        name = "shaker"
        material = "soft"
        shape.box = { min = [1, 0], max = [2, 1] }
        rigid.displacement = ["0.1 * sin(300 * t)", "-5 cm * min(t / 20 ms, 1)"]
        [[bodies]]
        name = "press"
        material = "soft"
        shape.box = { min = [3, 0], max = [4, 1] }
        rigid = { displacement = [0, { table = [[0, 0], [0.03, 0.2], [0.05, -0.1]] }], spin = 3 }
    "#;
    let mut simulation = start(&(bar("[0, 0]") + more));
    let begun: Vec<[f64; 3]> = simulation.bodies().iter().map(|body| body.position).collect();
    let mut rows = 0;
    run_to(&mut *simulation, 0.1, |simulation| {
        let (t, bodies) = (simulation.time(), simulation.bodies());
        let off = |body: usize, axis: usize, exact: f64| {
            let found = bodies[body].position[axis] - begun[body][axis];
            assert!((found - exact).abs() < 1e-12, "{t} s: {found} for {exact}");
        };
        off(1, 0, 0.1 * (300.0 * t).sin());
        off(1, 1, -0.05 * (t / 0.02).min(1.0));
        let exact = match t {
            t if t < 0.03 => 0.2 * t / 0.03,
            t if t < 0.05 => 0.2 - 0.3 * (t - 0.03) / 0.02,
            _ => -0.1,
        };
        off(2, 1, exact);
        rows += [0.02, 0.03, 0.05].iter().filter(|row| (t - **row).abs() < 1e-12).count();
    });
    assert_eq!(rows, 3, "steps end at rows and kinks");
}
