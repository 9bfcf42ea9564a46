//! A thick ring under pressure from inside.

use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target};
use crate::failure::CaseFailure;
use crate::outcome::Outcome;
use crate::trial::Trial;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "lame",
    title: "Thick ring under pressure from inside",
    source: "Lame and Clapeyron (1833)",
    picture: "
        . - - .
      /  . - .  \\        radii 1 and 2, a quarter of it between mirrors
     |  |  p  |  |
      \\  ` - `  /
        ` - - `
",
    set_up: "Plane strain; a ring of radii 1 and 2, E = rho = 1, nu = 0.3, a quarter of it between two symmetry faces, \
with a pressure of 0.001 on its inner surface; at rest by dynamic relaxation.",
    exact: "u = p/(2 G) a^2/(b^2 - a^2) ((1 - 2 nu) r + b^2/r). Measured are the mean radial displacement of the inner \
surface and of the particles beyond r = 1.5, over the exact, and the force of the pressure along x over p a.",
    laws: Laws::Bulk,
    measure: "(b - a)/h",
    resolutions: &[Resolution::quick(8.0), Resolution::full(16.0)],
    targets: &[
        Target::new(
            INNER,
            1.0,
            Allowed::Within(0.02),
            "eight cells; a round border counts by whole particles",
        )
        .at(8.0),
        Target::new(
            OUTER,
            1.0,
            Allowed::Within(0.02),
            "eight cells; a round border counts by whole particles",
        )
        .at(8.0),
        Target::new(INNER, 1.0, Allowed::Within(0.01), "half of what 8 cells may").at(16.0),
        Target::new(OUTER, 1.0, Allowed::Within(0.01), "half of what 8 cells may").at(16.0),
        Target::new(
            FORCE,
            1.0,
            Allowed::Within(0.005),
            "the pressure follows a surface that has grown by 0.2 %",
        ),
    ],
    reasons: &[],
    run,
};

const INNER: &str = "displacement inside";
const OUTER: &str = "displacement outside";
const FORCE: &str = "force of the pressure";
const POISSON: f64 = 0.3;
const PRESSURE: f64 = 1e-3;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut trial = Trial::start("ring", scene(case))?;
    let start = trial.snapshot();
    let (mut before, mut last) = ((0.0, 0.0), (0.0, 0.0));
    while trial.advance()? && !trial.is_at_rest() {
        (before, last) = (last, (trial.time(), trial.loads()[0].impulse[0]));
    }
    let shear = 0.5 / (1.0 + POISSON);
    let exact = |r: f64| PRESSURE / (2.0 * shear) / 3.0 * ((1.0 - 2.0 * POISSON) * r + 4.0 / r);
    let mut outcome = Outcome::default();
    // Over a quarter turn, the mean of a radial unit vector's component is 2/pi.
    let [x, y, _] = trial.loads()[0].displacement;
    outcome.measure(INNER, 0.5 * (x + y) * std::f64::consts::FRAC_PI_2 / exact(1.0));
    let now = trial.snapshot();
    let ratios: Vec<f64> = (start.position.iter().zip(&now.position))
        .filter_map(|(before, after)| {
            let r = before[0].hypot(before[1]);
            let outward = (0..2).map(|i| (after[i] - before[i]) * before[i] / r).sum::<f64>();
            (r > 1.5).then_some(outward / exact(r))
        })
        .collect();
    outcome.measure(OUTER, ratios.iter().sum::<f64>() / ratios.len() as f64);
    outcome.measure(FORCE, (last.1 - before.1) / (last.0 - before.0) / PRESSURE);
    outcome.include(trial);
    Ok(outcome)
}

fn scene(case: &Case) -> String {
    format!(
        r#"title = "Thick ring under pressure"
{}domain = {{ min = [0, 0], max = [2.5, 2.5], x_min = "symmetry", y_min = "symmetry" }}
{}relax = {{ residual = 1e-3 }}
[materials.rubber]
density = 1
neo_hookean = {{ young_modulus = 1, poisson_ratio = {POISSON} }}
[[bodies]]
name = "ring"
material = "rubber"
[bodies.shape]
intersection = [
    {{ difference = [{{ ball = {{ center = [0, 0], radius = 2 }} }}, {{ ball = {{ center = [0, 0], radius = 1 }} }}] }},
    {{ box = {{ min = [0, 0], max = [2, 2] }} }},
]
[[loads]]
body = "ring"
within.ball = {{ center = [0, 0], radius = 1.5 }}
pressure = {PRESSURE}
"#,
        case.space("plane-strain", 1.0 / case.cells),
        case.time(400.0),
    )
}
