//! B5: a bar hits an equal bar at rest.

use super::reasons::{AT_A_DISTANCE, RELEASE};
use crate::benchmark::{Allowed, Benchmark, Case, Laws, Reason, Resolution, Target};
use crate::failure::CaseFailure;
use crate::outcome::Outcome;
use crate::trial::Trial;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "B5",
    title: "Equal bars in impact",
    source: "Elementary theory of impact of bars; the literature puts it to contact laws as \"equal bars\"",
    picture: "
      v ->   +-----------------++-----------------+
             |   first, L      ||   second, L     |   at rest
             +-----------------++-----------------+
",
    set_up: "Plane strain with Poisson's ratio 0, so that the bars stay straight; units of L = rho = E = 1, c = \
sqrt(E/rho). Bars four cells high, neo-Hookean, faces touching on grid nodes at the start; v/c = 0.002 and 0.02; \
without friction, 3 L/c.",
    exact: "Stress -rho c v/2 behind the fronts; at L/c kinetic and strain energy are equal; contact lasts 2 L/c; \
then the first bar rests, the second moves at v, and no energy is lost. Contact counts as long as its force is a \
tenth of the exact one.",
    laws: Laws::Contact,
    measure: "L/h",
    resolutions: &[Resolution::quick(25.0), Resolution::quick(50.0), Resolution::full(100.0)],
    targets: &[
        Target::new(RESTITUTION[0], 1.0, Allowed::AtLeast(0.95), SHARP).at(50.0),
        Target::new(RESTITUTION[1], 1.0, Allowed::AtLeast(0.95), SHARP).at(50.0),
        Target::new(
            END[0],
            1.0,
            Allowed::Between(1.0, 1.04),
            "bars must not let go early; two cells of travel of the wave are 0.04 at 50 cells",
        )
        .at(50.0),
        Target::new(END[1], 1.0, Allowed::Between(1.0, 1.04), "the same at ten times the speed").at(50.0),
        Target::new(
            ENERGY[0],
            0.0,
            Allowed::Between(-0.03, 1e-4),
            "what restitution allows; a gain is never right, and 1e-4 is the time step's",
        )
        .at(50.0),
        Target::new(ENERGY[1], 0.0, Allowed::Between(-0.03, 1e-4), "the same at ten times the speed")
            .at(50.0),
        Target::new(
            "strain/kinetic energy at L/c",
            1.0,
            Allowed::Within(0.05),
            "exact but for the ringing behind the fronts",
        )
        .at(50.0),
    ],
    reasons: &[
        AT_A_DISTANCE,
        RELEASE,
        Reason {
            laws: &["traction"],
            text: "Two nodes deep the bodies are held together as one while they press; what the grid does not \
resolve there is lost, and the second bar gets less.",
        },
    ],
    run,
};

const SHARP: &str =
    "a sharp front rings on a grid, which keeps a few per cent of the energy from the bars' motion";
const SPEEDS: [f64; 2] = [0.002, 0.02];
const RESTITUTION: [&str; 2] = ["restitution, v/c = 0.002", "restitution, v/c = 0.02"];
const END: [&str; 2] = ["contact ends over 2L/c, v/c = 0.002", "contact ends over 2L/c, v/c = 0.02"];
const ENERGY: [&str; 2] = ["energy left over, v/c = 0.002", "energy left over, v/c = 0.02"];

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut outcome = Outcome::default();
    for (i, speed) in SPEEDS.into_iter().enumerate() {
        impact(case, i, speed, &mut outcome)?;
    }
    Ok(outcome)
}

fn impact(case: &Case, i: usize, speed: f64, outcome: &mut Outcome) -> Result<(), CaseFailure> {
    let (h, interior) = (1.0 / case.cells, case.interior);
    let height = 4.0 * h;
    let mut trial = Trial::start(
        format!("speed_{speed}"),
        format!(
            r#"title = "Equal bars in impact"
space = {{ dimension = "plane-strain", interior = "{interior}", cell = {h} }}
time.end = 3
materials.elastic = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0 }} }}
[[bodies]]
name = "first"
material = "elastic"
shape.box = {{ min = [0, 0], max = [1, {height}] }}
velocity = [{speed}, 0]
[[bodies]]
name = "second"
material = "elastic"
shape.box = {{ min = [1, 0], max = [2, {height}] }}
{}"#,
            case.contact(0.0)
        ),
    )?;
    let tenth = 0.1 * 0.5 * speed * height;
    let (mut end, mut shares) = (None, f64::NAN);
    while trial.advance()? {
        if trial.force(0, 1)[0] > tenth {
            end = Some(trial.time());
        }
        if trial.time() < 1.0 {
            let now = trial.ledger();
            shares = now.strain / now.kinetic;
        }
    }
    let bodies = trial.bodies();
    outcome.measure(RESTITUTION[i], (bodies[1].velocity[0] - bodies[0].velocity[0]) / speed);
    outcome.measure(END[i], end.ok_or(CaseFailure::Absent("the bars never push"))? / 2.0);
    outcome.measure(ENERGY[i], trial.ledger().total / trial.first_ledger().total - 1.0);
    if i == 0 {
        outcome.measure("strain/kinetic energy at L/c", shares);
    }
    outcome.include(trial);
    Ok(())
}
