//! B21: a cantilever swings with its first frequency.

use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target};
use crate::failure::CaseFailure;
use crate::measuring::angular_frequency;
use crate::outcome::Outcome;
use crate::trial::Trial;
use std::f64::consts::{FRAC_PI_2, TAU};

pub const BENCHMARK: Benchmark = Benchmark {
    name: "B21",
    title: "Cantilever, first frequency",
    source: "Euler and Bernoulli's beam, with shear and rotary inertia by Dunkerley's rule",
    picture: "
      //|_______________________
      //|_______________________|  8 H x H      gravity, at once
      //|
",
    set_up: "Plane strain; a beam 8 H x H of E = rho = 1, nu = 0.3 from a fixed face. A gravity that bends its tip \
down by 0.04 H at rest comes at once, so that it swings about that. One and a half periods.",
    exact: "w_b = 1.87510^2 sqrt(E' I/(rho H L^4)), E' = E/(1 - nu^2). Shear by itself gives w_s = (pi/2L) sqrt(5 \
G/(6 rho)), rotary inertia takes 4.648 (H^2/12)/L^2: 1/w^2 = (1 + 4.648 H^2/(12 L^2))/w_b^2 + 1/w_s^2, which is 1.4 \
% below w_b. Measured is the frequency of the centre's height, by least squares, over that.",
    laws: Laws::Bulk,
    measure: "H/h",
    resolutions: &[Resolution::quick(4.0), Resolution::quick(8.0)],
    targets: &[
        Target::new(FREQUENCY, 1.0, Allowed::Within(0.04), "four cells on the height").at(4.0),
        Target::new(
            FREQUENCY,
            1.0,
            Allowed::Within(0.02),
            "eight cells; Dunkerley's rule is a lower bound, by 0.3 %",
        )
        .at(8.0),
        Target::new(ENERGY, 0.0, Allowed::Within(0.02), "a swing and a half loses next to nothing").at(4.0),
        Target::new(ENERGY, 0.0, Allowed::Within(0.01), "a swing and a half loses next to nothing").at(8.0),
    ],
    reasons: &[],
    run,
};

const FREQUENCY: &str = "first frequency";
const ENERGY: &str = "energy drift";
const LENGTH: f64 = 8.0;
const POISSON: f64 = 0.3;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let plane = 1.0 / (1.0 - POISSON * POISSON);
    let shear = 0.5 / (1.0 + POISSON);
    let bending = 1.875_10_f64.powi(2) * (plane / 12.0 / LENGTH.powi(4)).sqrt();
    let sliding = FRAC_PI_2 / LENGTH * (5.0 / 6.0 * shear).sqrt();
    let rotary = 1.0 + 4.648 / 12.0 / LENGTH.powi(2);
    let exact = (rotary / bending.powi(2) + 1.0 / sliding.powi(2)).powf(-0.5);
    // A tip that sinks by rho g H L^4/(8 E' I) = 0.04 H.
    let gravity = 0.04 * 8.0 * plane / 12.0 / LENGTH.powi(4);
    let mut trial = Trial::start(
        "cantilever",
        format!(
            r#"title = "Cantilever"
gravity = [0, -{gravity}]
{}domain = {{ min = [0, -4], max = [12, 5], x_min = "fixed" }}
{}[materials.rubber]
density = 1
neo_hookean = {{ young_modulus = 1, poisson_ratio = {POISSON} }}
[[bodies]]
name = "beam"
material = "rubber"
shape.box = {{ min = [0, 0], max = [{LENGTH}, 1] }}
"#,
            case.space("plane-strain", 1.0 / case.cells),
            case.time(1.5 * TAU / exact)
        ),
    )?;
    let mut heights = Vec::new();
    while trial.advance()? {
        heights.push((trial.time(), trial.bodies()[0].position[1]));
    }
    let mut outcome = Outcome::default();
    outcome.measure(FREQUENCY, angular_frequency(&heights, exact) / exact);
    outcome.measure(ENERGY, trial.energy_drift());
    outcome.include(trial);
    Ok(outcome)
}
