//! Ring: a thin ring spins, and its hoop holds it together.

use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target, Tier};
use crate::failure::CaseFailure;
use crate::measuring::TimeMean;
use crate::outcome::Outcome;
use crate::trial::Trial;
use std::f64::consts::TAU;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "ring",
    title: "Spinning ring",
    source: "Balance of half a ring: the hoop stress over the thickness is that of rho w^2 r^2",
    picture: "
          .-----.
        / .---.   \\
       | |     |   |  four cells thick      spinning
        \\ `---'   /
          `-----'
",
    set_up: "Plane strain; a ring from 0.9 to 1.1 R of E = rho = 1, nu = 0.3, neo-Hookean, spinning without any \
deformation at first with 1/20 of the wave speed at R, for a turn (20 of its breathing periods), in the full tier \
for ten.",
    exact: "The integral of the hoop stress over the thickness is that of rho w^2 r^2, whatever the law. The ring \
breathes about that. Measured over that are means over the last half turn, with radius and spin of the moment; and \
angular momentum at the end over the start.",
    laws: Laws::Bulk,
    measure: "R/h",
    resolutions: &[Resolution::quick(20.0), Resolution::full(40.0)],
    targets: &[
        Target::new(
            HOOP,
            1.0,
            Allowed::Within(0.03),
            "stairs of particles at both rims carry less; 1 % of the breathing is left",
        ),
        Target::new(MOMENTUM, 1.0, Allowed::Within(0.001), "nothing turns it"),
    ],
    reasons: &[],
    run,
};

const HOOP: &str = "hoop stress";
const MOMENTUM: &str = "angular momentum";
const SPIN: f64 = 0.05;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let turn = TAU / SPIN;
    let end = if case.tier == Tier::Quick { turn } else { 10.0 * turn };
    let mut trial = Trial::start(
        "ring",
        format!(
            r#"title = "Spinning ring"
{}{}[materials.rubber]
density = 1
neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }}
[[bodies]]
name = "ring"
material = "rubber"
shape.difference = [
    {{ ball = {{ center = [0, 0], radius = 1.1 }} }},
    {{ ball = {{ center = [0, 0], radius = 0.9 }} }},
]
spin = {SPIN}
"#,
            case.space("plane-strain", 1.0 / case.cells),
            case.time(end)
        ),
    )?;
    let (mut hoop, mut exact, mut since) = (TimeMean::default(), TimeMean::default(), end - 0.5 * turn);
    while trial.advance()? {
        if trial.time() < since {
            continue;
        }
        since += 0.2;
        let (snapshot, spin) = (trial.snapshot(), trial.bodies()[0].spin[2]);
        for ((x, s), volume) in snapshot.position.iter().zip(&snapshot.stress).zip(&snapshot.volume) {
            let r2 = x[0] * x[0] + x[1] * x[1];
            // A share of the thickness, of particles spread evenly over the ring.
            let share = volume / r2.sqrt();
            hoop.add((s[0] * x[1] * x[1] + s[1] * x[0] * x[0] - 2.0 * s[3] * x[0] * x[1]) / r2, share);
            exact.add(spin * spin * r2, share);
        }
    }
    let mut outcome = Outcome::default();
    outcome.measure(HOOP, hoop.value() / exact.value());
    outcome.measure(MOMENTUM, trial.ledger().angular_momentum[2] / trial.first_ledger().angular_momentum[2]);
    outcome.include(trial);
    Ok(outcome)
}
