//! Plane stress: waves at the speeds of thin bars and plates, and Hooke's law of a pressed bar.
//!
//! Source: elementary theory (Kolsky 1963, Stress Waves in Solids, chapter 3). A wave along a thin bar is faster the
//! more its sides are held:
//!
//! ```text
//! bar, sides and faces free:   c = sqrt(E/rho)
//! plate, faces free:           c = sqrt(E/(rho (1 - nu^2)))
//! held all around:             c = sqrt(M/rho),   M = E (1 - nu)/((1 + nu)(1 - 2 nu))
//! ```
//!
//! Set-up: 120 cells along x, nu = 0.3, both laws; the left end follows a glued rigid piston, which moves by a smooth
//! pulse of 30 cells length. The speed is the distance of two sections over the time between the centres of the pulse
//! there. The bar is 3 cells high; the plate has mirrors at its sides. Plane strain with mirrors is the control: it
//! must give the speed held all around.
//!
//! Expected: speeds within 0.5 %: a pulse of 30 cells is dispersed by the grid by (2 pi/30)^2/24 = 0.2 %, by the bar's
//! height by nu^2 (2 pi 3/30)^2/24 = 0.15 %. Measured: 0.15 % for the bar, 0.03 % else. Energy of the pulse equals the
//! piston's work within 1 %; measured 0.3 %.
//!
//! A bar pressed slowly between a mirror and a rigid plate: stress over strain is E, cross strain over strain is -nu in
//! the plane and out of it, each within 0.2 % of itself: the bar keeps ringing by so much.

use crate::trial::{mean_where, run_to, start};

const YOUNG: f64 = 1.0;
const POISSON: f64 = 0.3;
/// The bar is the unit of length.
const CELL: f64 = 1.0 / 120.0;
/// Top speed of the piston over sqrt(E/rho).
const SPEED: f64 = 1e-4;
const PULSE: f64 = 0.25;

fn wave(dimension: &str, law: &str, held: bool) -> (f64, f64) {
    let height = 3.0 * CELL;
    let faces = if held { "y_min = \"symmetry\", y_max = \"symmetry\"" } else { "" };
    let [low, high] = if held { [0.0, height] } else { [-10.0 * CELL, 10.0 * CELL] };
    let scene = format!(
        r#"
        space.dimension = "{dimension}"
        space.interior = "grid"
        space.cell = {CELL}
        space.domain = {{ min = [-0.1, {low}], max = [1.1, {high}], {faces} }}
        time.end = 1
        materials.bar = {{ density = 1, {law} = {{ young_modulus = {YOUNG}, poisson_ratio = {POISSON} }} }}
        [[bodies]]
        name = "bar"
        material = "bar"
        shape.box = {{ min = [0, 0], max = [1, {height}] }}
        [[bodies]]
        name = "piston"
        material = "bar"
        shape.box = {{ min = [-0.05, 0], max = [0, {height}] }}
        rigid = {{ velocity = ["{SPEED} * if(t < {PULSE}, sin(pi * t / {PULSE})^2, 0)", 0] }}
        [[contact]]
        law = "glued"
        "#
    );
    let mut simulation = start(&scene);
    // sum v dt and sum t v dt at each section.
    let mut sums = [[0.0; 2]; 2];
    let mut before = 0.0;
    let mut energy = 0.0;
    run_to(&mut *simulation, 0.95, |s| {
        let (t, snapshot) = (s.time(), s.snapshot());
        for (section, sum) in [0.25, 0.55].into_iter().zip(&mut sums) {
            let near = |p: usize| snapshot.body[p] == 0 && (snapshot.position[p][0] - section).abs() < CELL;
            let v = mean_where(&snapshot, near, |p| snapshot.velocity[p][0]) * (t - before);
            sum[0] += v;
            sum[1] += v * t;
        }
        before = t;
        if t < 0.5 {
            let ledger = s.ledger();
            energy = (ledger.kinetic + ledger.strain) / ledger.external_work;
        }
    });
    let [first, second] = sums.map(|[v, tv]| tv / v);
    (0.3 / (second - first), energy)
}

#[test]
fn waves_run_as_fast_as_the_sides_allow() {
    let plate = (1.0 / (1.0 - POISSON * POISSON)).sqrt();
    let solid = ((1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON))).sqrt();
    for law in ["neo_hookean", "hypoelastic"] {
        for (name, dimension, held, exact) in [
            ("bar", "plane-stress", false, 1.0),
            ("plate", "plane-stress", true, plate),
            ("solid", "plane-strain", true, solid),
        ] {
            let (speed, energy) = wave(dimension, law, held);
            println!("{law} {name}: speed {:.4} of the exact, energy {energy:.4} of the work", speed / exact);
            assert!((speed / exact - 1.0).abs() < 0.005, "{law} {name}: {speed} {exact}");
            assert!((energy - 1.0).abs() < 0.01, "{law} {name}: energy {energy}");
        }
    }
}

#[test]
fn a_pressed_bar_obeys_hooke_with_e_and_nu() {
    for law in ["neo_hookean", "hypoelastic"] {
        let scene = format!(
            r#"
            space.dimension = "plane-stress"
            space.interior = "grid"
            space.cell = 0.05
            space.domain = {{ min = [0, 0], max = [1.5, 0.5], x_min = "symmetry", y_min = "symmetry" }}
            time = {{ end = 40, pic_share = 0.02 }}
            materials.bar = {{ density = 1, {law} = {{ young_modulus = {YOUNG}, poisson_ratio = {POISSON} }} }}
            [[bodies]]
            name = "bar"
            material = "bar"
            shape.box = {{ min = [0, 0], max = [1, 0.2] }}
            [[bodies]]
            name = "plate"
            material = "bar"
            shape.box = {{ min = [1, 0], max = [1.2, 0.4] }}
            rigid = {{ velocity = ["-1e-6 * if(t < 20, sin(pi * t / 20)^2, 0)", 0] }}
            "#
        );
        let mut simulation = start(&scene);
        run_to(&mut *simulation, 40.0, |_| {});
        let snapshot = simulation.snapshot();
        // Away from the plate, whose contact is uneven at its corner.
        let inside = |p: usize| snapshot.body[p] == 0 && snapshot.position[p][0] < 0.5;
        let mean = |quantity: &dyn Fn(usize) -> f64| mean_where(&snapshot, inside, quantity);
        let strain = |k: usize| mean(&|p| snapshot.deformation[p][4 * k] - 1.0);
        let stress = mean(&|p| snapshot.stress[p][0]);
        let (young, in_plane, out) = (stress / strain(0), -strain(1) / strain(0), -strain(2) / strain(0));
        println!(
            "{law}: strain {:.3e}, E {young:.5}, nu {in_plane:.5} in the plane, {out:.5} out of it",
            strain(0)
        );
        assert!(strain(0) < -5e-6, "{law}: strain {}", strain(0));
        let tolerance = 2e-3;
        assert!((young / YOUNG - 1.0).abs() < tolerance, "{law}: E {young}");
        assert!((in_plane / POISSON - 1.0).abs() < tolerance, "{law}: nu {in_plane}");
        assert!((out / POISSON - 1.0).abs() < tolerance, "{law}: nu {out}");
        // Round-off of the modulus.
        let most = (0..snapshot.body.len()).map(|p| snapshot.stress[p][2].abs()).fold(0.0, f64::max);
        assert!(most < 1e-13 * YOUNG, "{law}: {most:e}");
    }
}
