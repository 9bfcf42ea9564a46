//! Bodies on grids of their own come to rest by damping that is critical for their slowest swing.
//!
//! Source: Underwood (1983); the sag of a slender bar under its weight, rho g L^2/(2 E), of its centre two thirds of
//! that; a cantilever's end under a force, F L^3/(3 E I) + F L/(5/6 G H); Lame's equations of thick rings (Timoshenko
//! and Goodier, art. 28); the torque of a square bar of side a in torsion, 0.1406 G a^4 twist (art. 109).
//!
//! Set-up: the hanging bar of `relaxation.rs`, held by a support; `scenes/loaded_beam.toml` on four cells; two rings of
//! 10, 20 and 30 mm without friction under pressure from outside, which they share as one would; a bar of four cells
//! whose ends are twisted and held; a disk and a block on a floor with friction.
//!
//! Expected: displacements within 2 % (1.5 % at the centre of the bar, which is strained by 1.2 %), stresses of the
//! rings within 2 %, as on the common grid; the torque within 3 %, as its bar has four cells; the weight on the floor
//! within 1 %. The ledger closes to 3e-3 of what damping took. Steps to rest are bounded by what was measured, a third
//! more; bits are the same for any number of threads and after a resume on the way.

use crate::ranks::compare;
use crate::relaxation::{LENGTH, SAG, bar, lowest, stack, stack_comes_to_rest};
use crate::trial::{start, take_steps};
use rayon::ThreadPoolBuilder;
use stickslip::door::Simulation;

/// The hanging bar on a grid of its own, at rest at a residual.
fn hanging(residual: f64) -> String {
    let text = bar("", &format!("end = 2, relax = {{ residual = {residual} }}"))
        .replace("interior = \"grid\"", "interior = \"reference\"")
        .replace("max = [0.02, 0], y_max = \"fixed\"", "max = [0.02, 0.02]");
    format!("{text}\n[[supports]]\nbody = \"bar\"\non = \"y_max\"\n")
}

/// Runs to rest, which takes at most so many steps, and says how many.
fn rest(simulation: &mut dyn Simulation, most: u64) -> u64 {
    let end = |simulation: &dyn Simulation| simulation.relaxation().is_some_and(|state| state.at_rest);
    while !end(simulation) && simulation.steps() < 4 * most {
        take_steps(simulation, 1);
    }
    let state = simulation.relaxation().expect("asked for");
    println!("{state:?} after {} steps, {:?}", simulation.steps(), simulation.ledger());
    assert!(state.at_rest && simulation.steps() <= most, "{state:?} after {} steps", simulation.steps());
    simulation.steps()
}

#[test]
fn a_hanging_bar_finds_its_static_sag() {
    for (residual, most) in [(1e-3, 170), (1e-4, 270)] {
        let mut simulation = start(&hanging(residual));
        let total = simulation.ledger().total;
        rest(&mut *simulation, most);
        let (sag, tip) = (-simulation.bodies()[0].position[1] - 0.5 * LENGTH, lowest(&*simulation));
        println!("sag of the centre {:.4}, of the lower end {:.4}", sag / SAG[0], tip / SAG[1]);
        // Strains of 1.2 % at the clamp, which the formula does not have, add as much.
        assert!((sag / SAG[0] - 1.0).abs() < 0.015, "{sag}");
        assert!((tip / SAG[1] - 1.0).abs() < 0.02, "{tip}");
        let ledger = simulation.ledger();
        assert!((ledger.total - total).abs() < 3e-3 * ledger.damping, "{ledger:?}");
    }
}

#[test]
fn a_cantilever_bends_as_beam_theory_says() {
    let text =
        include_str!("../../../scenes/loaded_beam.toml").replace("relax = {}", "relax.residual = 1e-4");
    let set = [("cells_per_height".to_string(), "4".to_string())];
    let loaded = stickslip::scene::parse("loaded_beam.toml", &text, &set).expect("a scene").scene;
    let mut simulation = stickslip::step::build(&loaded).expect("a sound scene");
    rest(&mut *simulation, 5200);
    let sunk = simulation.loads().iter().map(|load| -load.displacement[1]).fold(0.0, f64::max);
    println!("sunk {sunk} m");
    // Four cells across sink by 1.016 of it, those of the scene by 1.004.
    assert!((sunk / 0.0335 - 1.0).abs() < 0.02, "{sunk}");
}

/// Rings that press each other under a pressure of 10 MPa from outside.
const RINGS: &str = r#"
    time = { end = 0.1, relax = { residual = 1e-4 } }
    materials.steel = { density = 7800, hypoelastic = { young_modulus = "210 GPa", poisson_ratio = 0.3 } }
    contact = [{ friction = 0 }]
    [space]
    dimension = "plane-stress"
    interior = "reference"
    cell = "2 mm"
    [[bodies]]
    name = "inner"
    material = "steel"
    shape.ring = { center = [0, 0], inner_radius = "10 mm", outer_radius = "20 mm" }
    [[bodies]]
    name = "outer"
    material = "steel"
    shape.ring = { center = [0, 0], inner_radius = "20 mm", outer_radius = "30 mm" }
    [[loads]]
    body = "outer"
    on = "surface"
    within.ring = { center = [0, 0], inner_radius = "28 mm", outer_radius = "32 mm" }
    pressure = "10 MPa"
"#;

#[test]
fn rings_share_a_pressure_as_one_would() {
    let mut simulation = start(RINGS);
    rest(&mut *simulation, 450);
    let [a, c] = [10e-3_f64, 30e-3].map(|radius| radius * radius);
    let snapshot = simulation.snapshot();
    let (mut product, mut square) = (0.0, 0.0);
    for (position, stress) in snapshot.position.iter().zip(&snapshot.stress) {
        let [x, y, _] = *position;
        let radius = x.hypot(y);
        if (radius - 20e-3).abs() < 3e-3 || !(12e-3..=28e-3).contains(&radius) {
            continue;
        }
        let (cos, sin) = (x / radius, y / radius);
        let [xx, yy, _, xy, ..] = *stress;
        let radial = cos * cos * xx + sin * sin * yy + 2.0 * cos * sin * xy;
        let exact = [-1.0, 1.0].map(|sign| -10e6 * c / (c - a) * (1.0 + sign * a / (radius * radius)));
        for (found, exact) in [radial, xx + yy - radial].into_iter().zip(exact) {
            product += found * exact;
            square += exact * exact;
        }
    }
    let found = product / square;
    println!("stresses {found:.4} of Lame's");
    assert!((found - 1.0).abs() < 0.02, "{found}");
}

/// A square bar whose ends are twisted by 0.02 and held, free along it.
const TORSION: &str = r#"
    time = { end = 400, relax = { residual = 1e-4 } }
    materials.m = { density = 1, neo_hookean = { young_modulus = 1, poisson_ratio = 0.3 } }
    space = { dimension = "3d", interior = "reference", cell = 0.25 }
    [[bodies]]
    name = "bar"
    material = "m"
    shape.box = { min = [-0.5, -0.5, 0], max = [0.5, 0.5, 4] }
    [[supports]]
    body = "bar"
    on = "z_min"
    displacement = [0, 0, "free"]
    [[supports]]
    body = "bar"
    on = "z_max"
    displacement = ["-0.02 * min(t / 20, 1) * y0", "0.02 * min(t / 20, 1) * x0", "free"]
"#;

#[test]
fn a_bar_that_is_twisted_comes_to_rest() {
    let mut simulation = start(TORSION);
    rest(&mut *simulation, 275);
    let ledger = simulation.ledger();
    assert!(ledger.total.abs() < 3e-3 * ledger.external_work, "{ledger:?}");
    let strain = ledger.strain;
    // Half of torque times angle.
    let exact = 0.5 * 0.1406 / 2.6 * 0.02 * 0.02 / 4.0;
    println!("energy {:.4} of Saint-Venant's", strain / exact);
    assert!((strain / exact - 1.0).abs() < 0.03, "{strain}");
}

#[test]
fn a_stack_comes_to_rest_on_its_floor() {
    stack_comes_to_rest(&stack("reference"));
}

#[test]
fn bits_do_not_depend_on_threads_or_resumes() {
    let outcome = |text: &str, threads: usize, restore: bool| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
        pool.install(|| {
            let mut simulation = start(text);
            for step in 0..60 {
                if restore && step % 20 == 7 {
                    let saved = simulation.save().expect("it can be saved");
                    simulation = start(text);
                    simulation.restore(saved).expect("it is of the same scene");
                }
                take_steps(&mut *simulation, 1);
            }
            let relaxation = simulation.relaxation();
            format!("{:?} {:?} {relaxation:?}", simulation.snapshot(), simulation.ledger())
        })
    };
    for text in [stack("reference"), TORSION.to_string()] {
        let one = outcome(&text, 1, false);
        for (threads, restore) in [(2, false), (1, true)] {
            assert!(outcome(&text, threads, restore) == one, "{threads} threads, resumed: {restore}");
        }
    }
}

/// Two bars that hang apart, the one on the common grid, the other on one of its own.
#[test]
fn bodies_of_both_kinds_come_to_rest_together() {
    let text = bar("", "end = 2, relax = { residual = 1e-3 }")
        .replace("max = [0.02, 0], y_max = \"fixed\"", "max = [0.08, 0.02]");
    let text = format!(
        r#"
        contact = [{{ law = "none" }}]
        {text}
        [[bodies]]
        name = "other"
        material = "gel"
        interior = "reference"
        shape.box = {{ min = [0.04, -0.1], max = [0.06, 0] }}
        [[supports]]
        body = "bar"
        on = "y_max"
        [[supports]]
        body = "other"
        on = "y_max"
        "#
    );
    let mut simulation = start(&text);
    rest(&mut *simulation, 270);
    for body in simulation.bodies() {
        let sag = -body.position[1] - 0.5 * LENGTH;
        println!("sag {:.4}", sag / SAG[0]);
        assert!((sag / SAG[0] - 1.0).abs() < 0.02, "{sag}");
    }
}

/// Two bars that hang side by side with a spring between them, one pulled aside.
const COUPLED: &str = r#"
    gravity = [0, -9.81]
    time = { end = 5, relax = { residual = 1e-6 } }
    materials.gel = { density = 1000, neo_hookean = { young_modulus = 5e4, poisson_ratio = 0.3 } }
    contact = [{ law = "none" }]
    [space]
    dimension = "plane-strain"
    interior = "reference"
    cell = 5e-3
    domain = { min = [-0.1, -0.2], max = [0.2, 0.1] }
    [[bodies]]
    name = "left"
    material = "gel"
    shape.box = { min = [0, -0.1], max = [0.02, 0] }
    [[bodies]]
    name = "right"
    material = "gel"
    shape.box = { min = [0.05, -0.1], max = [0.07, 0] }
    [[supports]]
    body = "left"
    on = "y_max"
    [[supports]]
    body = "right"
    on = "y_max"
    [[loads]]
    body = "right"
    on = "y_min"
    force = [0.05, 0]
    [[springs]]
    from = { body = "left", on = "x_max" }
    to = { body = "right", on = "x_min" }
    stiffness = 200
"#;

#[test]
fn bodies_that_a_spring_couples_come_to_rest() {
    let mut simulation = start(COUPLED);
    rest(&mut *simulation, 1400);
    // The force that it pulls the left bar aside with is what its clamp takes.
    let before = simulation.loads()[0];
    let (time, spring) = (simulation.time(), simulation.joints()[0]);
    take_steps(&mut *simulation, 20);
    let held = (simulation.loads()[0].impulse[0] - before.impulse[0]) / (simulation.time() - time);
    let pull = (simulation.joints()[0].impulse[0] - spring.impulse[0]) / (simulation.time() - time);
    println!("held by {held} N/m, pulled by {pull} N/m");
    assert!(pull.abs() > 1e-3 && (held + pull).abs() < 5e-3 * pull.abs(), "{held} {pull}");
}

#[test]
fn ranks_share_a_way_to_rest() {
    compare("coupled bars", COUPLED, 100);
}
