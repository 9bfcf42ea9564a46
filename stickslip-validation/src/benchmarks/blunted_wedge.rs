//! A metal wedge that a flat die blunts: all of the contact's surface comes from plastic flow.

use super::reasons::AT_A_DISTANCE;
use crate::benchmark::{Allowed, Benchmark, Case, Laws, Reason, Resolution, Target};
use crate::failure::CaseFailure;
use crate::outcome::Outcome;
use crate::trial::Trial;
use std::f64::consts::{FRAC_PI_2, PI};

pub const BENCHMARK: Benchmark = Benchmark {
    name: "wedge",
    title: "Wedge blunted by a flat die",
    source: "Slip lines of the rigid-plastic body: Hill, Lee and Tupper (1947), Proc. R. Soc. Lond. A 188, 273; \
Hill (1950), The Mathematical Theory of Plasticity, chapter VIII",
    picture: "
             ==================   rigid die, without friction, down by t
              ____c____|
           _,/    :    \\,_  lip, falls by delta from the die
          /       :       \\
        /         : 60 deg  \\
      /___________:___________\\
      /////////////////////////   rigid floor, glued
",
    set_up: "Plane strain; the wedge is L high and has a half-angle of 60 degrees, von Mises without hardening, Y = \
E/500, nu = 0.3, GIMP, half of it before a mirror. The die comes down by t = 0.15 L within 100 L/c, smoothly, and \
rests for 20 more.",
    exact: "Below the die a triangle, beside it a fan of the angle pi/2 - delta, then a triangle under the lip, \
whose face is as long as the contact's half-width c. It ends on the old face, c (1 + cos delta) = (t + c sin delta) \
tan 60, and holds what the die displaced, t^2 tan 60 = (c - t tan 60) c sin delta: c = 2.7155 t, delta = 40.4 \
degrees. Pressure 2k (1 + pi/2 - delta) = 3.730 k, k = Y/sqrt(3). Force is measured as its impulse over that of the \
exact force, over the second half of the way, and at the end of the rest; width at the end, by the particles that \
are less than half a cell below the die.",
    laws: Laws::Contact,
    measure: "L/h",
    resolutions: &[Resolution::quick(32.0), Resolution::full(64.0)],
    targets: &[
        Target::new(
            FORCE,
            1.0,
            Allowed::Within(0.05),
            "pressure and width in one; the wedge is elastic besides, and 13 cells make the half-width",
        ),
        Target::new(
            REST,
            1.0,
            Allowed::Within(0.1),
            "what presses at the end is what the last nodes at the rim hold",
        ),
        Target::new(WIDTH, 1.0, Allowed::Within(0.1), "a cell in 13"),
        Target::new(
            LOSS,
            0.0,
            Allowed::Between(-0.02, 0.005),
            "of the work of flow; particles reach the die with a speed of their own, which contact takes",
        ),
    ],
    reasons: &[
        AT_A_DISTANCE,
        Reason {
            laws: &["gap", "separation"],
            text: "The faces beside the contact run towards the die at 40 degrees, where these laws know a surface \
to half a cell.",
        },
    ],
    run,
};

const FORCE: &str = "force over exact";
const REST: &str = "force at rest over exact";
const WIDTH: &str = "half-width over exact";
const LOSS: &str = "energy drift";
/// Half-angle of the wedge [rad].
const HALF_ANGLE: f64 = PI / 3.0;
/// Yield stress over Young's modulus.
const YIELD: f64 = 0.002;
/// The die's way [L].
const WAY: f64 = 0.15;
/// Time in which it comes down [L/c].
const RAMP: f64 = 100.0;
/// The run's end [L/c].
const END: f64 = 120.0;

/// Half-width of the contact over the die's way, and pressure over k.
fn exact() -> (f64, f64) {
    let slope = HALF_ANGLE.tan();
    let width = |delta: f64| slope / (1.0 + delta.cos() - slope * delta.sin());
    // From a lip's face that is as steep as the wedge's on, what the lip holds beyond what the die displaced grows with
    // delta.
    let (mut low, mut high) = (0.0, FRAC_PI_2 - HALF_ANGLE);
    while (width(high) - slope) * width(high) * high.sin() < slope {
        high += 0.01;
    }
    for _ in 0..60 {
        let delta = 0.5 * (low + high);
        let more = (width(delta) - slope) * width(delta) * delta.sin() > slope;
        *(if more { &mut high } else { &mut low }) = delta;
    }
    (width(low), 2.0 * (1.0 + FRAC_PI_2 - low))
}

/// The die's way at a time [L].
fn way(time: f64) -> f64 {
    let share = (time / RAMP).min(1.0);
    WAY * (share - (2.0 * PI * share).sin() / (2.0 * PI))
}

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let h = 1.0 / case.cells;
    let (half, thick) = (HALF_ANGLE.tan(), 4.0 * h);
    let wide = ((half + 0.5) / h).ceil() * h;
    let mut trial = Trial::start(
        "wedge",
        format!(
            r#"title = "Wedge blunted by a flat die"
time.end = {END}
materials.metal = {{ density = 1, von_mises = {{ young_modulus = 1, poisson_ratio = 0.3, yield_stress = {YIELD} }} }}
[space]
dimension = "plane-strain"
interior = "grid"
cell = {h}
basis = "gimp"
domain.min = [0, -{thick}]
domain.max = [{wide}, 1.5]
domain.x_min = "symmetry"
[[bodies]]
name = "wedge"
material = "metal"
shape.polygon = {{ points = [[0, 0], [{half}, 0], [0, 1]] }}
[[bodies]]
name = "floor"
material = "metal"
shape.box = {{ min = [0, -{thick}], max = [{wide}, 0] }}
rigid = {{}}
[[bodies]]
name = "die"
material = "metal"
shape.box = {{ min = [0, 1], max = [{}, {}] }}
rigid.velocity = [0, "-{WAY} / {RAMP} * (1 - cos(2 * pi * min(t / {RAMP}, 1)))"]
[[contact]]
between = ["floor", "any"]
law = "glued"
{}"#,
            0.9 * half,
            1.0 + thick,
            case.contact(0.0)
        ),
    )?;
    let (width, pressure) = exact();
    let force = |time: f64| pressure * YIELD / 3.0_f64.sqrt() * width * way(time);
    let (mut impulse, mut exact_impulse) = (0.0, 0.0);
    let (mut at_rest, mut rest) = (0.0, 0.0);
    while trial.advance()? {
        let (pushed, dt) = (trial.force(0, 2)[1], trial.step_length());
        let middle = trial.time() - 0.5 * dt;
        if (0.5..1.0).contains(&(middle / RAMP)) {
            impulse += pushed * dt;
            exact_impulse += force(middle) * dt;
        } else if middle > 0.5 * (RAMP + END) {
            at_rest += pushed * dt;
            rest += force(END) * dt;
        }
    }
    let now = trial.snapshot();
    let die = 1.0 - WAY;
    let touching = (0..now.body.len()).filter(|&p| now.body[p] == 0 && now.position[p][1] > die - 0.5 * h);
    let farthest = touching.map(|p| now.position[p][0]).fold(0.0, f64::max);
    let mut outcome = Outcome::default();
    outcome.measure(FORCE, impulse / exact_impulse);
    outcome.measure(REST, at_rest / rest);
    outcome.measure(WIDTH, farthest / (width * WAY));
    outcome.include(trial);
    outcome.measure(LOSS, outcome.record.energy_drift);
    Ok(outcome)
}

#[test]
fn the_slip_lines_are_those_of_the_text() {
    let (width, pressure) = exact();
    assert!((width - 2.7155).abs() < 1e-4 && (pressure - 3.7302).abs() < 1e-4, "{width} {pressure}");
    let slope = HALF_ANGLE.tan();
    let delta = 1.0 + FRAC_PI_2 - 0.5 * pressure;
    assert!((width * (1.0 + delta.cos()) - (1.0 + width * delta.sin()) * slope).abs() < 1e-9);
    assert!(((width - slope) * width * delta.sin() - slope).abs() < 1e-9);
    assert!((way(RAMP) - WAY).abs() < 1e-12 && way(END) == way(RAMP));
}
