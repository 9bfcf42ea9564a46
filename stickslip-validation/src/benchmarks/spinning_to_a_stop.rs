//! Spinning to a stop: a rod that stands on its end and turns is stopped by friction.

use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target};
use crate::failure::CaseFailure;
use crate::measuring::slope;
use crate::outcome::Outcome;
use crate::trial::Trial;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "pivot",
    title: "Rod that spins on its end to a stop",
    source: "Coulomb's law under even pressure: a torque of (2/3) mu N R",
    picture: "
         _____
        |     |   <-- w0, R high
        |     |
        |_____|
      ___________   rigid, mu = 0.3
",
    set_up: "In space; a cylinder of R = E = rho = 1, R high, nu = 0.3, fitted, stands on a rigid floor under a \
gravity of 0.002, mu = 0.3, and spins about its axis with 0.024 at first.",
    exact: "w' = -(4/3) mu g/R, so it stops at t = 3 w0 R/(4 mu g) = 30. The load comes at once and the rod bounces \
on it; d(w + (4/3) mu v/R)/dt is that whatever it weighs meanwhile. Measured are the slope of that from 2 to 25 over \
the exact one, and the largest spin that is left from 34 to 40 over the first: once the rod stands it swings in \
twist, with 1/(30 w_t) = 0.03 of the first spin, w_t = (pi/2) sqrt(G/rho)/R.",
    laws: Laws::Bulk,
    measure: "R/h",
    resolutions: &[Resolution::quick(4.0), Resolution::full(8.0)],
    targets: &[
        Target::new(
            TORQUE,
            1.0,
            Allowed::Within(0.1),
            "four cells on the radius tell the arm of friction within a tenth",
        )
        .at(4.0),
        Target::new(TORQUE, 1.0, Allowed::Within(0.05), "pressure is even but for the rim").at(8.0),
        Target::new(STOPS, 0.0, Allowed::Within(0.05), STANDS).at(4.0),
        Target::new(STOPS, 0.0, Allowed::Within(0.05), STANDS).at(8.0),
    ],
    reasons: &[],
    run,
};

const TORQUE: &str = "deceleration";
const STOPS: &str = "spin left";
const STANDS: &str = "friction holds what it has stopped; twist swings on with 0.03";
const SPIN: f64 = 0.024;
const FRICTION: f64 = 0.3;
const G: f64 = 0.002;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut trial = Trial::start(
        "pivot",
        format!(
            r#"title = "Rod that spins on its end to a stop"
gravity = [0, 0, -{G}]
{}{}[materials.rubber]
density = 1
neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }}
[[bodies]]
name = "rod"
material = "rubber"
shape.cylinder = {{ start = [0, 0, 0], end = [0, 0, 1], radius = 1 }}
particles = "fitted"
spin = [0, 0, {SPIN}]
[[bodies]]
name = "floor"
material = "rubber"
shape.half_space = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
rigid = {{}}
{}"#,
            case.space("3d", 1.0 / case.cells),
            case.time(40.0),
            case.contact(FRICTION)
        ),
    )?;
    let (mut spins, mut left) = (Vec::new(), 0.0_f64);
    let arm = 4.0 / 3.0 * FRICTION;
    while trial.advance()? {
        let rod = trial.bodies().swap_remove(0);
        if (2.0..25.0).contains(&trial.time()) {
            spins.push((trial.time(), rod.spin[2] + arm * rod.velocity[2]));
        }
        if trial.time() > 34.0 {
            left = left.max(rod.spin[2].abs());
        }
    }
    let mut outcome = Outcome::default();
    outcome.measure(TORQUE, -slope(&spins) / (arm * G));
    outcome.measure(STOPS, left / SPIN);
    outcome.include(trial);
    Ok(outcome)
}
