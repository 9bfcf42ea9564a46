//! B8: a solitary wave runs down a chain of spheres.
//!
//! Source: Nesterenko (1983), and for the discrete chain Chatterjee (1999):
//! V = 0.6887 (2 E / (d rho^1.5 (1 - nu^2)))^(1/3) F^(1/6), F the largest force between two spheres. A sphere that strikes
//! with 0.5 m/s sends a wave of 2.012 N at 25.25 m/s down spheres of 20 mm of 10 MPa, 1000 kg/m^3 and nu = 0.3.
//!
//! Set-up: halves of such spheres in a row beside a mirror; the first strikes. The speed is two diameters over the time
//! from the largest force between the second and the third sphere to that between the fourth and the fifth.
//!
//! Expected: the speed within 10 %. The aim is 5 %, which asks for more cells than a test can have: the contact is as wide
//! as 0.11 of a radius, less than a cell at R/8. It is 8 % too slow there, and the force falls by 3 % from sphere to
//! sphere; at R/4 it is 6 % too slow by luck, as the force falls by 20 %.

use crate::trial::{run_to, start};
use stickslip::door::ContactCursor;

/// Speed of the wave [m/s] and its force on the way [N].
fn wave(cells: f64, spheres: usize) -> [f64; 2] {
    let diameter = 0.02;
    let mut simulation = start(&format!(
        r#"
        time.end = 1
        materials.rubber = {{ density = 1000, neo_hookean = {{ young_modulus = "10 MPa", poisson_ratio = 0.3 }} }}
        [space]
        dimension = "3d"
        interior = "grid"
        cell = "10 mm / {cells}"
        domain = {{ min = [-0.06, 0, -0.02], max = [0.3, 0.02, 0.02], y_min = "symmetry" }}
        [[bodies]]
        name = "ball {{i}}"
        repeat.i = {spheres}
        material = "rubber"
        particles = "fitted"
        shape.intersection = [
            {{ ball = {{ center = ["(2 * i + 1) * 10 mm", 0, 0], radius = "10 mm" }} }},
            {{ half_space = {{ point = [0, 0, 0], normal = [0, -1, 0] }} }},
        ]
        velocity = ["0.5 m/s * if(i == 0, 1, 0)", 0, 0]
        "#
    ));
    let mut cursor = ContactCursor::default();
    // Of the contacts after the first, the time of the largest force and that force.
    let mut peaks = [[0.0; 2]; 4];
    let end = diameter * 4.5 / 25.0 + 0.7e-3;
    for sample in 1..=400 {
        run_to(&mut *simulation, end * f64::from(sample) / 400.0, |_| {});
        for contact in cursor.read(&*simulation) {
            let force = 2.0 * contact.mean.normal;
            if let Some(peak) = peaks.get_mut(contact.body_a).filter(|peak| peak[1] < force) {
                *peak = [simulation.time(), force];
            }
        }
    }
    [2.0 * diameter / (peaks[3][0] - peaks[1][0]), peaks[2][1]]
}

fn check(cells: f64, spheres: usize) {
    let [speed, force] = wave(cells, spheres);
    println!("R/{cells}: {speed:.2} m/s, exact 25.25 m/s; force {force:.3} N, exact 2.012 N");
    assert!((speed / 25.25 - 1.0).abs() < 0.1, "{speed}");
}

#[test]
fn a_wave_runs_down_a_row_of_coarse_spheres() {
    check(4.0, 6);
}

#[test]
#[ignore = "slow: a minute"]
fn a_wave_runs_down_a_row_of_spheres() {
    check(8.0, 7);
}
