//! Bodies that overlap at the start are pressed apart on request, and keep their overlap without.
//!
//! Source: Lame's equations of thick rings; Timoshenko and Goodier, Theory of Elasticity, art. 28.
//!
//! Set-up: two rings of 10, 20 and 30 mm with an interference of 2.5 um on the radius, a quarter in plane stress
//! (`scenes/press_fit.toml`), on cells of 2 mm; surfaces grow within 50 us, and the run ends at rest.
//!
//! Expected: the pressure of 6.15 MPa that the radial and hoop stresses of both rings away from their edges tell, within
//! 2 %, as curved faces of particles are stairs; the work of the push is the energy that is stored and damped, within
//! 2 %; without `overlap = "press"` no stress on the common grid, and the same pressure on grids of their own.

use crate::trial::run_to;
use stickslip::scene::{self, Interior, Scene};

const RADII: [f64; 3] = [10e-3, 20e-3, 30e-3];

/// The scene on cells of 2 mm, with these lines in place of those that press.
fn rings(rule: &str) -> Scene {
    let pressed = "overlap = \"press\"\npress_time = \"50 us\"\n";
    let text = include_str!("../../../scenes/press_fit.toml");
    assert!(text.contains(pressed));
    let set = [("cell".to_string(), "2 mm".to_string())];
    let loaded = scene::parse("press_fit.toml", &text.replace(pressed, rule), &set);
    loaded.unwrap_or_else(|error| panic!("{error}")).scene
}

/// E d / (R ((c^2 + R^2)/(c^2 - R^2) + (R^2 + a^2)/(R^2 - a^2)))
fn pressure() -> f64 {
    let [a, r, c] = RADII.map(|radius| radius * radius);
    210e9 * 2.5e-6 / (RADII[1] * ((c + r) / (c - r) + (r + a) / (r - a)))
}

/// Radial and hoop stress at a radius under a pressure of 1 between the rings.
fn lame(radius: f64) -> [f64; 2] {
    let [a, r, c] = RADII.map(|radius| radius * radius);
    let square = radius * radius;
    match square < r {
        true => [1.0 - a / square, 1.0 + a / square].map(|x| -x * r / (r - a)),
        false => [1.0 - c / square, 1.0 + c / square].map(|x| x * r / (c - r)),
    }
}

/// Pressure between the rings over Lame's once they rest, and the time that took [s].
fn pressed(scene: &Scene) -> (f64, f64) {
    let mut simulation = stickslip::step::build(scene).expect("a sound scene");
    let mut steps = 0;
    while simulation.relaxation().is_some_and(|relaxation| !relaxation.at_rest) && steps < 20_000 {
        simulation.step(f64::INFINITY).expect("the trial is sound");
        steps += 1;
    }
    let (snapshot, ledger) = (simulation.snapshot(), simulation.ledger());
    let (mut product, mut square) = (0.0, 0.0);
    for (position, stress) in snapshot.position.iter().zip(&snapshot.stress) {
        let [x, y, _] = *position;
        let radius = x.hypot(y);
        if (radius - RADII[1]).abs() < 3e-3 || !(12e-3..=28e-3).contains(&radius) {
            continue;
        }
        let (cos, sin) = (x / radius, y / radius);
        let [xx, yy, _, xy, ..] = *stress;
        let radial = cos * cos * xx + sin * sin * yy + 2.0 * cos * sin * xy;
        let hoop = xx + yy - radial;
        for (found, exact) in [radial, hoop].into_iter().zip(lame(radius)) {
            product += found * exact;
            square += exact * exact;
        }
    }
    let found = product / square / pressure();
    let closed = (ledger.total / ledger.external_work).abs();
    println!("{steps} steps, pressure {found:.4} of Lame's, ledger {closed:.1e}, {ledger:?}");
    assert!(ledger.external_work > 0.0 && closed < 0.02, "{ledger:?}");
    (found, simulation.time())
}

#[test]
fn a_ring_is_pressed_on_another() {
    let (found, time) = pressed(&rings("overlap = \"press\"\npress_time = \"50 us\"\n"));
    assert!(time > 100e-6, "at rest at {time} s, before the surfaces have grown");
    assert!((found - 1.0).abs() < 0.02, "{found}");
}

#[test]
fn an_overlap_on_grids_of_their_own_is_an_interference_fit() {
    let mut scene = rings("");
    scene.discretization.interior = Interior::Reference;
    let (found, _) = pressed(&scene);
    assert!((found - 1.0).abs() < 0.02, "{found}");
}

#[test]
fn an_overlap_that_is_kept_has_no_stress() {
    let mut scene = rings("");
    scene.discretization.interior = Interior::Grid;
    let mut simulation = stickslip::step::build(&scene).expect("a sound scene");
    run_to(&mut *simulation, 20e-6, |_| {});
    assert!(simulation.snapshot().stress.iter().flatten().all(|stress| stress.abs() < 1.0));
}
