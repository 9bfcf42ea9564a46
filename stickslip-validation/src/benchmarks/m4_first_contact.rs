//! M4: contact begins when surfaces touch, and no earlier.

use super::reasons::{AT_A_DISTANCE, EXTRAPOLATED};
use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target};
use crate::failure::CaseFailure;
use crate::measuring::farthest;
use crate::outcome::Outcome;
use crate::trial::Trial;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "M4",
    title: "First contact",
    source: "Geometry: a gap g closes at v after g/v",
    picture: "
      v ->   +---------+          +---------+
             |  first  |<-- g --> | second  |
             +---------+          +---------+
",
    set_up: "Plane strain, Poisson's ratio 0; two bars of 8 x 4 cells filled from the lattice, with faces on it, \
and two of 8.37 x 3.81 cells with fitted particles and faces anywhere; a gap of 2 cells and so every smaller gap on \
the way; v/c = 0.02. The whole drifts against the grid so that the surfaces meet on a node and a quarter, a half \
and three quarters of a cell behind it. 1 to 4 particles a cell and direction.",
    exact: "Contact begins at g/v. Measured is (g/v - t) v/h, in cells: positive is too early; the worst of the \
four meeting places.",
    laws: Laws::Contact,
    measure: "bar length/h",
    resolutions: &[Resolution::quick(8.0)],
    targets: &[
        Target::new(LATTICE[0], 0.0, Allowed::Within(0.05), WHY),
        Target::new(LATTICE[1], 0.0, Allowed::Within(0.05), WHY),
        Target::new(LATTICE[2], 0.0, Allowed::Within(0.05), WHY),
        Target::new(LATTICE[3], 0.0, Allowed::Within(0.05), WHY),
        Target::new(FITTED[0], 0.0, Allowed::Within(0.05), WHY),
        Target::new(FITTED[1], 0.0, Allowed::Within(0.05), WHY),
        Target::new(FITTED[2], 0.0, Allowed::Within(0.05), WHY),
        Target::new(FITTED[3], 0.0, Allowed::Within(0.05), WHY),
    ],
    reasons: &[AT_A_DISTANCE, EXTRAPOLATED],
    run,
};

const LATTICE: [&str; 4] =
    ["cells too early, 1 particle a side", "2 particles a side", "3 particles a side", "4 particles a side"];
const FITTED: [&str; 4] =
    ["fitted, 1 particle a side", "fitted, 2 particles", "fitted, 3 particles", "fitted, 4 particles"];
const WHY: &str = "a twentieth of a cell is small against elastic approach at any resolution; published laws: 1 to \
2 cells, gap tests 0.3";
const GAP: f64 = 2.0;
const SPEED: f64 = 0.02;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut outcome = Outcome::default();
    for (metrics, arrangement) in [(LATTICE, "lattice"), (FITTED, "fitted")] {
        for (metric, particles) in metrics.into_iter().zip(1..) {
            let mut early = Vec::new();
            for meeting in [0.0, 0.25, 0.5, 0.75] {
                early.push(approach(case, (arrangement, particles), meeting, &mut outcome)?);
            }
            outcome.measure(metric, farthest(&early));
        }
    }
    Ok(outcome)
}

/// Cells by which contact is too early when surfaces meet `meeting` cells behind a node. Units of h = rho = E = 1.
fn approach(
    case: &Case,
    (arrangement, particles): (&str, usize),
    meeting: f64,
    outcome: &mut Outcome,
) -> Result<f64, CaseFailure> {
    // Fitted bars are no whole number of particles long and high.
    let (longer, height) = if arrangement == "fitted" { (0.37, 3.81) } else { (0.0, 4.0) };
    let (length, exact) = (case.cells + longer, GAP / SPEED);
    // The second bar's face starts on a node.
    let drift = meeting / exact;
    let mut trial = Trial::start(
        format!("{arrangement}_{particles}_per_side_meeting_{meeting}"),
        format!(
            r#"title = "First contact"
space = {{ dimension = "plane-strain", interior = "grid", cell = 1, particles_per_side = {particles} }}
time.end = {}
materials.elastic = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0 }} }}
[[bodies]]
name = "first"
material = "elastic"
shape.box = {{ min = [{}, 0], max = [{}, {height}] }}
particles = "{arrangement}"
velocity = [{}, 0]
[[bodies]]
name = "second"
material = "elastic"
shape.box = {{ min = [0, 0], max = [{length}, {height}] }}
particles = "{arrangement}"
velocity = [{drift}, 0]
{}"#,
            exact * 1.5,
            -GAP - length,
            -GAP,
            SPEED + drift,
            case.contact(0.0)
        ),
    )?;
    while trial.first_contact().is_none() && trial.advance()? {}
    let seen = trial.first_contact().ok_or(CaseFailure::Absent("the bars never push"))?;
    outcome.include(trial);
    Ok((exact - seen) * SPEED)
}
