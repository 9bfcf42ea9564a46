//! B21-loaded: a cantilever held by a support, under a force at its end and under pressure.

use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target};
use crate::failure::CaseFailure;
use crate::outcome::Outcome;
use crate::trial::Trial;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "B21-loaded",
    title: "Cantilever under a force and under pressure",
    source: "Euler and Bernoulli's beam, with shear by Timoshenko (1921)",
    picture: "
                               | F            p
      //|______________________V      //| | | | | | | | | |
      //|______________________|      //|_V_V_V_V_V_V_V_V_V_
        10 H x H                      //|__________________|
",
    set_up: "Plane stress; a beam 10 H x H of E = rho = 1, nu = 0, three tenths of a cell off the grid along both \
axes, whose left face a support holds. A force F L^2/(E I) = 0.02 along its right face, or a pressure p L^3/(E I) = \
0.05 on its upper one; at rest by dynamic relaxation.",
    exact: "The end sinks by F L^3/(3 E I) + F L/(5/6 G H), the upper face on average by p L^4/(20 E I) + p L^2/(3 5/6 \
G H). Measured are these, by `loads.csv`'s mean displacement of the face, and the support's force over the load.",
    laws: Laws::Bulk,
    measure: "H/h",
    resolutions: &[Resolution::quick(4.0), Resolution::quick(8.0)],
    targets: &[
        Target::new(SINKS[0], 1.0, Allowed::Within(0.05), COARSE).at(4.0),
        Target::new(SINKS[1], 1.0, Allowed::Within(0.05), COARSE).at(4.0),
        Target::new(SINKS[0], 1.0, Allowed::Within(0.02), FINE).at(8.0),
        Target::new(SINKS[1], 1.0, Allowed::Within(0.02), FINE).at(8.0),
        Target::new(
            REACTION,
            1.0,
            Allowed::Within(0.01),
            "in the last step: forces are in balance to 0.1 % of all of them",
        ),
        Target::new(WORK, 1.0, Allowed::Within(1e-3), "the ledger closes"),
    ],
    reasons: &[],
    run,
};

const SINKS: [&str; 2] = ["deflection by a force", "deflection by pressure"];
const REACTION: &str = "force of the support";
const WORK: &str = "energy at rest over work";
const COARSE: &str = "four cells on the height, and a border off the grid";
const FINE: &str = "eight cells";
const LENGTH: f64 = 10.0;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut outcome = Outcome::default();
    let (inertia, shear) = (1.0 / 12.0, 5.0 / 6.0 * 0.5);
    let force = 0.02 * inertia / LENGTH.powi(2);
    let pressure = 0.05 * inertia / LENGTH.powi(3);
    let exact = [
        force * (LENGTH.powi(3) / (3.0 * inertia) + LENGTH / shear),
        pressure * (LENGTH.powi(4) / (20.0 * inertia) + LENGTH.powi(2) / (3.0 * shear)),
    ];
    let loads = [
        (format!("on = \"x_max\"\nforce = [0, -{force}]"), force),
        (format!("on = \"y_max\"\npressure = {pressure}"), pressure * LENGTH),
    ];
    let (mut reactions, mut works): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    for ((metric, exact), (load, whole)) in SINKS.into_iter().zip(exact).zip(loads) {
        let mut trial = Trial::start(metric.replace(' ', "_"), scene(case, &load))?;
        // What the support bore in the last steps, in which the load is what it was.
        let mut before = (0.0, 0.0);
        let mut last = before;
        while trial.advance()? && !trial.is_at_rest() {
            (before, last) = (last, (trial.time(), trial.loads()[0].impulse[1]));
        }
        let loads = trial.loads();
        let ledger = trial.ledger();
        outcome.measure(metric, -loads[1].displacement[1] / exact);
        reactions.push((last.1 - before.1) / (last.0 - before.0) / whole);
        works.push((ledger.strain + ledger.kinetic + ledger.damping) / (loads[0].work + loads[1].work));
        outcome.include(trial);
    }
    let worst = |values: Vec<f64>| {
        values.into_iter().fold(1.0, |a: f64, b| if (b - 1.0).abs() > (a - 1.0).abs() { b } else { a })
    };
    outcome.measure(REACTION, worst(reactions));
    outcome.measure(WORK, worst(works));
    Ok(outcome)
}

fn scene(case: &Case, load: &str) -> String {
    let h = 1.0 / case.cells;
    let off = 0.3 * h;
    format!(
        r#"title = "Cantilever under load"
{}domain = {{ min = [-1, -4], max = [12, 4] }}
{}relax = {{ residual = 1e-3 }}
[materials.rubber]
density = 1
neo_hookean = {{ young_modulus = 1, poisson_ratio = 0 }}
[[bodies]]
name = "beam"
material = "rubber"
particles = "fitted"
shape.box = {{ min = [{off}, {off}], max = [{}, {}] }}
[[supports]]
body = "beam"
on = "x_min"
[[loads]]
body = "beam"
{load}
"#,
        case.space("plane-stress", h),
        case.time(20_000.0),
        LENGTH + off,
        1.0 + off,
    )
}
