//! B13-plane: a disk strikes a plane obliquely.

use super::reasons::{AT_A_DISTANCE, EXTRAPOLATED, OWN_NORMALS, RELEASE};
use crate::benchmark::{Allowed, Benchmark, Case, Laws, Reason, Resolution, Target};
use crate::failure::CaseFailure;
use crate::outcome::Outcome;
use crate::trial::Trial;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "B13-plane",
    title: "Oblique impact of a disk",
    source: "Rigid-body impact with Coulomb friction for gross slip; Maw, Barber and Fawcett (1976) for the \
reversal, here in the plane",
    picture: "
             ___
            /   \\   u0 ->, v down
            \\___/
        ________________  rigid floor
",
    set_up: "Plane strain; a disk of radius R, E = rho = 1, nu = 0.3, touching the floor, not spinning, v/c = 0.02, \
mu = 0.3, u0 = 2, 7 and 12 mu v.",
    exact: "The contact point's tangential velocity u = v_x + omega R. Where it slips throughout, with the disk's \
chi = 3/2 (tangential and normal compliance of a line contact are equal) above u0 = (4 chi - 1) mu v = 5 mu v, \
friction takes mu (1 + e) v, e = 1, from v_x, and 2 L/R times as much from omega R, with L the height of the centre \
above the floor, where friction acts: the mean over friction's impulse in the run, 0.96 R. So u changes by -2 mu (1 \
+ 2 L/R) v. At 2 mu v the elastic tangential spring throws it back: u1 < 0. Velocities over v.",
    laws: Laws::Contact,
    measure: "R/h",
    resolutions: &[Resolution::quick(10.0), Resolution::quick(20.0), Resolution::full(40.0)],
    targets: &[
        Target::new(
            METRICS[1],
            0.0,
            Allowed::Within(0.05),
            "the benchmark's figure; restitution 0.97 alone makes 0.027",
        ),
        Target::new(
            METRICS[2],
            0.0,
            Allowed::Within(0.05),
            "the benchmark's figure; restitution 0.97 alone makes 0.027",
        ),
        Target::new(
            METRICS[0],
            -0.3,
            Allowed::AtMost(0.0),
            "the reversal needs tangential elasticity of the patch; its exact size is not known here",
        ),
    ],
    reasons: &[
        OWN_NORMALS,
        AT_A_DISTANCE,
        EXTRAPOLATED,
        RELEASE,
        Reason {
            laws: &["surface", "gap"],
            text: "The patch is two cells wide at R/10. The disk skips over it from node to node, which leaves it \
shaking (e = 0.97) and makes the floor push a tenth of a cell ahead of its centre, which turns it.",
        },
    ],
    run,
};

const METRICS: [&str; 3] = ["u1/v at u0 = 2 mu v", "u1/v off at u0 = 7 mu v", "u1/v off at u0 = 12 mu v"];
const SPEED: f64 = 0.02;
const FRICTION: f64 = 0.3;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut outcome = Outcome::default();
    for (metric, slip) in METRICS.into_iter().zip([2.0, 7.0, 12.0]) {
        let (after, arm) = strike(case, slip * FRICTION, &mut outcome)?;
        let exact = if slip > 5.0 { (slip - 2.0 * (1.0 + 2.0 * arm)) * FRICTION } else { 0.0 };
        outcome.measure(metric, after - exact);
    }
    Ok(outcome)
}

/// The contact point's tangential velocity after the impact for one before it, both over the normal speed, and the mean
/// height of the centre over the impulse of friction.
fn strike(case: &Case, before: f64, outcome: &mut Outcome) -> Result<(f64, f64), CaseFailure> {
    let (h, interior) = (1.0 / case.cells, case.interior);
    let mut trial = Trial::start(
        format!("slip_{before:.1}"),
        format!(
            r#"title = "Oblique impact of a disk"
space = {{ dimension = "plane-strain", interior = "{interior}", cell = {h} }}
time.end = 16
materials.elastic = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }} }}
[[bodies]]
name = "disk"
material = "elastic"
shape.ball = {{ center = [0, 1], radius = 1 }}
velocity = [{}, -{SPEED}]
[[bodies]]
name = "floor"
material = "elastic"
shape.box = {{ min = [-0.8, -{}], max = [1.6, 0] }}
rigid = {{}}
{}"#,
            before * SPEED,
            2.0 * h,
            case.contact(FRICTION)
        ),
    )?;
    let (mut impulse, mut moment) = (0.0, 0.0);
    while trial.advance()? {
        let share = trial.force(0, 1)[0] * trial.step_length();
        impulse += share;
        moment += share * trial.bodies()[0].position[1];
    }
    let disk = trial.bodies().swap_remove(0);
    outcome.include(trial);
    Ok(((disk.velocity[0] + disk.spin[2]) / SPEED, moment / impulse))
}
