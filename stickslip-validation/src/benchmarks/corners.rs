//! Corners: a block with sharp corners, pressed on a bed and pushed sideways.

use super::reasons::{EXTRAPOLATED, OWN_NORMALS, PLANE_OF_PARTICLES, STAIRS};
use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target};
use crate::failure::CaseFailure;
use crate::measuring::{mean, slope};
use crate::outcome::Outcome;
use crate::scenery::turned_box;
use crate::trial::Trial;
use stickslip::door::BodyState;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "corners",
    title: "Block with sharp corners, pressed and pushed",
    source: "Coulomb's law; the set-up at which laws with tilted normals at corners stick",
    picture: "
              push ->  ______
                      |block |   pressed down by its weight
              ________|______|________
             |     deformable bed     |
             |________________________|
             /////// glued slab ///////
",
    set_up: "Plane strain; a block 1 m x 0.5 m on a bed 3 m x 0.3 m, both of soft rubber (E = 1 MPa, nu = 0.3, 1000 \
kg/m^3), the bed glued on a rigid slab. They touch at the start. Gravity presses with 10 m/s^2 and pushes sideways \
with 6 m/s^2; mu = 0.3; 0.6 s. Once along the grid, once turned through it by 20 degrees.",
    exact: "a = 6 - 0.3 * 10 = 3 m/s^2. The load comes at once, so the block bounces on its bed, by 0.1 m/s, and \
weighs on it now more, now less: its acceleration at any time is 6 - 0.3 N/m with the push N of the bed, and a \
straight line through its speed is off by as much as the bounce has changed from one end to the other, some 2 %. By \
Newton's law across the bed N/m = 10 + dv_away/dt, so d(v_along + mu v_away)/dt = 6 - 0.3 * 10 at any time, however \
it bounces, and only if friction is mu N and points back. Its least-squares slope over the second half of the run \
is measured, over the exact one. A block that nothing carries would have it too, so its sinking is measured beside \
it: the mean way toward the bed in that half.",
    laws: Laws::Contact,
    measure: "block length/h",
    resolutions: &[Resolution::quick(10.0), Resolution::full(20.0)],
    targets: &[
        Target::new(
            METRICS[0],
            1.0,
            Allowed::Within(0.02),
            "corners are a few of the contact's nodes; 2 % is what the best published normals reach here",
        ),
        Target::new(METRICS[1], 1.0, Allowed::Within(0.02), "the same law must not know where the grid lies"),
        Target::new(SINKING[0], 0.0, Allowed::Within(0.1), CARRIED),
        Target::new(SINKING[1], 0.0, Allowed::Within(0.1), CARRIED),
    ],
    reasons: &[OWN_NORMALS, STAIRS, EXTRAPOLATED, PLANE_OF_PARTICLES],
    run,
};

const METRICS: [&str; 2] = ["acceleration, aligned", "acceleration, rotated"];
const SINKING: [&str; 2] = ["sinking [cells], aligned", "sinking [cells], rotated"];
const CARRIED: &str = "block and bed give by 0.02 cells of a tenth of the block";
const PRESS: f64 = 10.0;
const PUSH: f64 = 6.0;
const FRICTION: f64 = 0.3;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut outcome = Outcome::default();
    for (i, degrees) in [0.0_f64, 20.0].into_iter().enumerate() {
        let (acceleration, sinking) = push(case, degrees.to_radians(), &mut outcome)?;
        outcome.measure(METRICS[i], acceleration / (PUSH - FRICTION * PRESS));
        outcome.measure(SINKING[i], sinking);
    }
    Ok(outcome)
}

/// The block's acceleration along the bed, which is turned through the grid by `turn` [m/s^2], and how deep it sinks
/// [cells].
fn push(case: &Case, turn: f64, outcome: &mut Outcome) -> Result<(f64, f64), CaseFailure> {
    let (h, interior) = (1.0 / case.cells, case.interior);
    let (sin, cos) = turn.sin_cos();
    let mut trial = Trial::start(
        if turn == 0.0 { "aligned" } else { "rotated" },
        format!(
            r#"title = "Block with sharp corners, pressed and pushed"
gravity = [{}, {}]
space = {{ dimension = "plane-strain", interior = "{interior}", cell = {h} }}
time.end = 0.6
materials.rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1e6, poisson_ratio = 0.3 }} }}
[[bodies]]
name = "slab"
material = "rubber"
{}
rigid = {{}}
[[bodies]]
name = "bed"
material = "rubber"
{}
[[bodies]]
name = "block"
material = "rubber"
{}
[[contact]]
between = ["slab", "bed"]
law = "glued"
{}"#,
            PUSH * cos + PRESS * sin,
            PUSH * sin - PRESS * cos,
            turned_box([-0.6, -0.3 - 2.0 * h], [2.4, -0.3], turn),
            turned_box([-0.6, -0.3], [2.4, 0.0], turn),
            turned_box([0.0, 0.0], [1.0, 0.5], turn),
            case.contact(FRICTION)
        ),
    )?;
    let (mut speeds, mut heights) = (Vec::new(), Vec::new());
    let away = |x: [f64; 3]| x[1] * cos - x[0] * sin;
    let start = away(trial.bodies()[2].position);
    while trial.advance()? {
        if trial.time() >= 0.3 {
            let BodyState { position: x, velocity: v, .. } = trial.bodies().swap_remove(2);
            speeds.push((trial.time(), v[0] * cos + v[1] * sin + FRICTION * away(v)));
            heights.push(away(x));
        }
    }
    outcome.include(trial);
    Ok((slope(&speeds), (start - mean(&heights)) / h))
}
