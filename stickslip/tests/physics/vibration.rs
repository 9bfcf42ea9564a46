//! What bends to and fro goes on to do so, but for a part of its swing that becomes noise: a known miss.
//!
//! Source: free vibration without damping keeps its amplitude. The first frequency of a slender cantilever is
//! 1.875^2 / (2 pi L^2) sqrt(E I / (rho A)).
//!
//! Set-up: a bar of gel of 16 by 4 cells, held at one end, that begins to sag under its weight and swings about the
//! static answer, its end by half a cell.
//!
//! Expected: all of the swing of its middle in the first three periods is left after 17. Particles that move through a
//! part of a cell and back make noise, of which the particles' own rotation takes most: 0.85 must be left.

use crate::trial::{run_to, start};

const LENGTH: f64 = 0.08;
const WIDTH: f64 = 0.02;
const YOUNG: f64 = 50e3;
const DENSITY: f64 = 1000.0;

/// What is left of a bar's swing after 17 periods.
fn swing_left(basis: &str) -> f64 {
    let slender = (YOUNG * WIDTH * WIDTH / (12.0 * DENSITY)).sqrt();
    let period = std::f64::consts::TAU * (LENGTH / 1.875).powi(2) / slender;
    let mut simulation = start(&format!(
        r#"
        gravity = [0, -0.5]
        [space]
        dimension = "plane-stress"
        interior = "grid"
        cell = 0.005
        basis = "{basis}"
        domain = {{ min = [0, -0.1], max = [0.12, 0.1], x_min = "fixed" }}
        [time]
        end = 100
        [materials.gel]
        density = {DENSITY}
        neo_hookean = {{ young_modulus = {YOUNG}, poisson_ratio = 0.3 }}
        [[bodies]]
        name = "bar"
        material = "gel"
        shape.box = {{ min = [0, {}], max = [{LENGTH}, {}] }}
        "#,
        -0.5 * WIDTH,
        0.5 * WIDTH
    ));
    let mut swing = |from: f64, to: f64| {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        run_to(&mut *simulation, to * period, |simulation| {
            if simulation.time() >= from * period {
                let y = simulation.bodies()[0].position[1];
                (low, high) = (low.min(y), high.max(y));
            }
        });
        high - low
    };
    let first = swing(0.0, 3.0);
    swing(17.0, 20.0) / first
}

#[test]
fn a_beam_goes_on_to_bend_to_and_fro() {
    for basis in ["spline", "cubic", "gimp"] {
        let left = swing_left(basis);
        println!("{basis}: {left:.4} of the swing left after 17 periods");
        assert!((0.85..1.02).contains(&left), "{basis}: {left}");
    }
}

/// Speed that a disk of rubber with so many cells a radius keeps while it rolls for two turns on a rigid floor.
fn rolled(cells: usize, basis: &str) -> f64 {
    let end = 2.0 * 2.0 * std::f64::consts::PI * 0.1;
    let mut simulation = start(&format!(
        r#"
        gravity = [0, -10]
        space = {{ dimension = "plane-strain", interior = "grid", cell = "0.1 m / {cells}", basis = "{basis}" }}
        time.end = {end}
        materials.rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1e6, poisson_ratio = 0.3 }} }}
        [[bodies]]
        name = "disk"
        material = "rubber"
        shape.ball = {{ center = [0, 0.1], radius = 0.1 }}
        velocity = [1, 0]
        spin = -10
        [[bodies]]
        name = "floor"
        material = "rubber"
        shape.half_space = {{ point = [0, 0], normal = [0, 1] }}
        rigid = {{}}
        [[contact]]
        friction = 0.5
        "#
    ));
    run_to(&mut *simulation, end, |_| {});
    simulation.bodies()[0].velocity[0]
}

/// What rolls loses its speed to noise, and only smaller cells help: splines, by which a disk that spins in flight has
/// the right stress, slow it down far more. Measured 0.87 and 0.96 of its speed by `gimp` with 4 and 8 cells a radius,
/// 0.36 by `spline` with 4; exact is 1.
#[test]
fn what_rolls_loses_less_by_gimp_than_by_splines() {
    let [gimp, spline] = ["gimp", "spline"].map(|basis| rolled(4, basis));
    println!("speed left after two turns: gimp {gimp:.3}, spline {spline:.3}");
    assert!((0.82..1.0).contains(&gimp) && spline < 0.5, "{gimp} {spline}");
}
