//! M6: sliding bodies exchange tangential and normal impulse in the ratio mu.

use super::reasons::{EXTRAPOLATED, OWN_NORMALS, PLANE_OF_PARTICLES, STAIRS};
use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target};
use crate::failure::CaseFailure;
use crate::outcome::Outcome;
use crate::scenery::turned_box;
use crate::trial::Trial;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "M6",
    title: "Friction ratio",
    source: "Coulomb's law, integrated over an impact",
    picture: "
             ______   u ->
            |______|  v down
         ________________
        |________________|
",
    set_up: "Plane strain; a block of 12 x 6 cells hits a block of 32 x 8 cells of the same material (nu = 0.3), \
face to face, at v/c = 0.005 and slides along it at u/c = 0.05, fast enough to slide everywhere and throughout; mu \
= 0.3. Once along the grid, once turned through it by 30 degrees.",
    exact: "The upper block's change of momentum along the face over that across it is mu. Measured is their ratio \
over mu.",
    laws: Laws::Contact,
    measure: "block length/h",
    resolutions: &[Resolution::quick(12.0), Resolution::full(24.0)],
    targets: &[
        Target::new(
            METRICS[0],
            1.0,
            Allowed::Within(0.02),
            "exact for one common normal; the rim of the patch tilts normals of a body's own mass by 45 degrees",
        ),
        Target::new(METRICS[1], 1.0, Allowed::Within(0.02), "the same through a turned grid"),
    ],
    reasons: &[OWN_NORMALS, STAIRS, EXTRAPOLATED, PLANE_OF_PARTICLES],
    run,
};

const METRICS: [&str; 2] = ["ratio/mu, aligned", "ratio/mu, rotated"];
const FRICTION: f64 = 0.3;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut outcome = Outcome::default();
    for (metric, degrees) in METRICS.into_iter().zip([0.0_f64, 30.0]) {
        let ratio = strike(case, degrees.to_radians(), &mut outcome)?;
        outcome.measure(metric, ratio / FRICTION);
    }
    Ok(outcome)
}

/// Impulse along the face over impulse across it; the face is turned through the grid by `turn` [rad]. Units of block
/// length = rho = E = 1.
fn strike(case: &Case, turn: f64, outcome: &mut Outcome) -> Result<f64, CaseFailure> {
    let (h, interior) = (1.0 / case.cells, case.interior);
    let (sin, cos) = turn.sin_cos();
    let (along, down) = (0.05, 0.005);
    let mut trial = Trial::start(
        if turn == 0.0 { "aligned" } else { "rotated" },
        format!(
            r#"title = "Friction ratio"
space = {{ dimension = "plane-strain", interior = "{interior}", cell = {h} }}
time.end = 4
materials.elastic = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }} }}
[[bodies]]
name = "upper"
material = "elastic"
{}
velocity = [{}, {}]
[[bodies]]
name = "lower"
material = "elastic"
{}
{}"#,
            turned_box([0.0, 0.0], [1.0, 0.5], turn),
            along * cos + down * sin,
            along * sin - down * cos,
            turned_box([-8.0 / 12.0, -8.0 / 12.0], [2.0, 0.0], turn),
            case.contact(FRICTION)
        ),
    )?;
    let before = trial.bodies()[0].velocity;
    while trial.advance()? {}
    let after = trial.bodies()[0].velocity;
    outcome.include(trial);
    let change = [0, 1].map(|i| after[i] - before[i]);
    Ok(-(change[0] * cos + change[1] * sin) / (change[1] * cos - change[0] * sin))
}
