//! Single precision gives the same motion as double precision, and so do linear functions where nothing strains.
//!
//! Set-up: an oblique collision of two disks with friction (and of balls), once in `f32` and once in `f64`.
//!
//! Expected: positions within 1e-4 of the bodies' size and velocities within 1e-3 of their speed: about 300 steps, each
//! rounding at 6e-8 the positions counted in cells, and a stiff law that turns errors of strain into forces. Momentum
//! of the pair to 1e-4 of one body's.

use crate::trial::{distance, largest_difference, run_to, start};

fn scene(dimension: &str, precision: &str, basis: &str) -> String {
    let z = if dimension == "3d" { [", 0", ", 0.05"] } else { ["", ""] };
    format!(
        r#"
        space = {{ dimension = "{dimension}", interior = "grid", cell = 0.05, precision = "{precision}", basis = "{basis}" }}
        time.end = 1
        materials.rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1000, poisson_ratio = 0.3 }} }}
        [[bodies]]
        name = "first"
        material = "rubber"
        shape.ball = {{ center = [0.2, 0.2{}], radius = 0.2 }}
        velocity = [0.1, 0{}]
        [[bodies]]
        name = "second"
        material = "rubber"
        shape.ball = {{ center = [0.62, 0.3{}], radius = 0.2 }}
        velocity = [-0.1, 0{}]
        [[contact]]
        friction = 0.3
        "#,
        z[0], z[0], z[1], z[0]
    )
}

#[test]
fn single_agrees_with_double() {
    for (dimension, end) in [("plane-strain", 1.5), ("3d", 0.8)] {
        let [double, single] = ["double", "single"].map(|precision| {
            let mut simulation = start(&scene(dimension, precision, "gimp"));
            let before = simulation.ledger();
            run_to(&mut *simulation, end, |_| {});
            let momentum = distance(simulation.ledger().momentum, before.momentum);
            (simulation.snapshot(), momentum / (0.1 * simulation.bodies()[0].mass), simulation.steps())
        });
        let position = largest_difference(&double.0.position, &single.0.position) / 0.2;
        let velocity = largest_difference(&double.0.velocity, &single.0.velocity) / 0.1;
        println!(
            "{dimension}, {} steps: position {position:.1e}, velocity {velocity:.1e}, momentum {:.1e}",
            double.2, single.1
        );
        assert!(position < 1e-4, "{dimension}: position {position:e}");
        assert!(velocity < 1e-3, "{dimension}: velocity {velocity:e}");
        assert!(single.1 < 1e-4, "{dimension}: momentum {:e}", single.1);
    }
}

/// A body that only flies is not strained by crossing cells, whatever the functions.
#[test]
fn linear_functions_carry_a_flight() {
    for dimension in ["plane-strain", "3d"] {
        let mut simulation =
            start(&scene(dimension, "double", "linear").replace("velocity = [-0.1", "velocity = [0.1"));
        let before = simulation.snapshot();
        run_to(&mut *simulation, 2.0, |_| {});
        let flown: Vec<[f64; 3]> = before.position.iter().map(|x| [x[0] + 0.2, x[1], x[2]]).collect();
        let position = largest_difference(&simulation.snapshot().position, &flown);
        println!("{dimension}: flight of 4 cells to {position:.1e} m");
        assert!(position < 1e-12, "{dimension}: {position:e} m");
    }
}

#[test]
fn linear_functions_carry_a_collision() {
    let mut simulation = start(&scene("plane-strain", "double", "linear"));
    let (before, bodies) = (simulation.ledger(), simulation.bodies());
    run_to(&mut *simulation, 2.0, |_| {});
    let after = simulation.bodies();
    let momentum = distance(simulation.ledger().momentum, before.momentum) / (0.1 * bodies[0].mass);
    let speed =
        distance(after[0].velocity, after[1].velocity) / distance(bodies[0].velocity, bodies[1].velocity);
    println!("linear collision: momentum {momentum:.1e}, rebound/approach {speed:.3}");
    assert!(momentum < 1e-10, "momentum {momentum:e}");
    assert!(after[0].velocity[0] < 0.0 && after[1].velocity[0] > 0.0, "they bounce off each other");
    assert!(speed < 1.0, "rebound {speed}");
}
