//! Turning: a squeezed disk turns between frictionless walls.

use super::reasons::{AT_A_DISTANCE, EXTRAPOLATED, OWN_NORMALS, RELEASE};
use crate::benchmark::{Allowed, Benchmark, Case, Laws, Miss, Reason, Resolution, Target};
use crate::failure::CaseFailure;
use crate::measuring::{deviation, mean};
use crate::outcome::Outcome;
use crate::trial::Trial;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "turning",
    title: "Squeezed disk that turns between frictionless walls",
    source: "Isotropy: an elastic disk feels the same wherever it is squeezed",
    picture: "
        _____________________  rigid, without friction
              /    \\
             | <--  |   squeezed by a tenth on either side
              \\____/
        _____________________  rigid, without friction
",
    set_up: "Plane strain; a disk of radius R, E = rho = 1, nu = 0.3, neo-Hookean, GIMP, spinning with 0.05 c/R \
between two rigid walls that close in by 0.1 R each within 30 R/c, smoothly; then for 126 R/c, a turn of the disk \
at its first spin. Forces are means over R/c.",
    exact: "The walls' forces do not change while the disk turns, and pass through its centre, so that its spin \
does not either. Measured from 35 R/c on are the standard deviation of the force over its mean, and how far the \
walls push ahead of the centre: the change of angular momentum over the impulse of both walls.",
    laws: Laws::Contact,
    measure: "R/h",
    resolutions: &[Resolution::quick(8.0), Resolution::full(16.0), Resolution::full(32.0)],
    targets: &[
        Target::new(
            NOISE,
            0.0,
            Allowed::Within(0.05),
            "a wall that meets node after node may tremble, by a twentieth of its force",
        ),
        Target::new(
            AHEAD,
            0.0,
            Allowed::Within(0.001),
            "a thousandth is the rolling resistance of a steel wheel",
        )
        .missed(&[
            Miss { cells: 8.0, off: 0.0026 },
            Miss { cells: 16.0, off: 0.0032 },
            Miss { cells: 32.0, off: 0.0018 },
        ]),
    ],
    reasons: &[
        OWN_NORMALS,
        AT_A_DISTANCE,
        EXTRAPOLATED,
        RELEASE,
        Reason {
            laws: &["surface", "gap", "separation"],
            text: "The walls do push ahead of the centre, by 0.0017 R, 0.0021 R and 0.0012 R at R/8, R/16 and R/32; \
with the transfer flip, with which all that follows was measured, by 0.003 R at each. The moment of their forces \
says so, too. Stress does not lag: with a quarter of the step it is 0.0022 R at R/8. The moment goes with the \
square of the spin (half the spin 0.0009 R, twice 0.008 R) and is the same for a fifth of the squeeze. It is in the \
bulk, not in the contact: particles in rings (0.0026 R), the hypoelastic law (0.0035 R) and the other stress \
updates (0.002 R) have it as well, and walls that turn about a resting disk drag it along. As the squeeze goes \
round, particles get velocities within their cells that the grid does not see, and their deformation gradients \
leave what their places say: after a turn by 2 to 3 % in the middle of the disk, at R/16 as at R/8. What the spin \
loses is found there, as strain energy and as such motion. A free disk loses 5 % of its angular momentum in that \
time at R/8 and 1 % at R/16. The number of particles does not decide: with 4, 16 and 36 a cell it is 0.0026, 0.0022 \
and 0.0021 R at R/8, with 9 it is 0.0010 R.",
        },
        Reason {
            laws: &["gap", "separation", "traction"],
            text: "A small push ahead says little here, for it goes with the square of the spin, and the disk has \
lost its spin while the walls closed in: when measuring begins, of its angular momentum 0.40 is left with traction, \
0.59 with gap and 0.58 with separation at R/8, and -0.16, -0.14 and 0.16 at R/16, where it turns no more. With \
surface 0.96 and 0.97 are left.",
        },
    ],
    run,
};

const NOISE: &str = "scatter of the force";
const AHEAD: &str = "push ahead of the centre over R";
const SPIN: f64 = 0.05;
const SQUEEZE: f64 = 0.1;
const RAMP: f64 = 30.0;
/// The walls rest, and what their stopping left has rung out [R/c].
const BEGIN: f64 = 35.0;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let (h, interior) = (1.0 / case.cells, case.interior);
    let basis = if case.is_own() { "" } else { ", basis = \"gimp\"" };
    let thick = 3.0 * h;
    let end = BEGIN + 2.0 * std::f64::consts::PI / SPIN;
    let speed = format!("({SQUEEZE} / {RAMP}) * (1 - cos(2 * pi * min(t / {RAMP}, 1)))");
    let mut trial = Trial::start(
        "turning",
        format!(
            r#"title = "Squeezed disk that turns between frictionless walls"
space = {{ dimension = "plane-strain", interior = "{interior}", cell = {h}{basis} }}
time.end = {end}
materials.rubber = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }} }}
[[bodies]]
name = "disk"
material = "rubber"
shape.ball = {{ center = [0, 1], radius = 1 }}
spin = {SPIN}
[[bodies]]
name = "floor"
material = "rubber"
shape.box = {{ min = [-0.8, -{thick}], max = [0.8, 0] }}
rigid.velocity = [0, "{speed}"]
[[bodies]]
name = "ceiling"
material = "rubber"
shape.box = {{ min = [-0.8, 2], max = [0.8, {}] }}
rigid.velocity = [0, "-{speed}"]
{}"#,
            2.0 + thick,
            case.contact(0.0)
        ),
    )?;
    let (mut forces, mut impulse, mut since, mut all, mut turning) = (Vec::new(), 0.0, BEGIN, 0.0, None);
    while trial.advance()? {
        if trial.time() < BEGIN {
            continue;
        }
        turning.get_or_insert_with(|| trial.ledger().angular_momentum[2]);
        let push = [1, 2].map(|wall| trial.force(0, wall)[1].abs() * trial.step_length());
        impulse += 0.5 * (push[0] + push[1]);
        all += push[0] + push[1];
        if trial.time() - since >= 1.0 {
            forces.push(impulse / (trial.time() - since));
            (impulse, since) = (0.0, trial.time());
        }
    }
    let turning = turning.ok_or(CaseFailure::Absent("the time after the walls have closed in"))?;
    let lost = turning - trial.ledger().angular_momentum[2];
    let mut outcome = Outcome::default();
    outcome.measure(NOISE, deviation(&forces) / mean(&forces));
    outcome.measure(AHEAD, lost / all);
    outcome.include(trial);
    Ok(outcome)
}
