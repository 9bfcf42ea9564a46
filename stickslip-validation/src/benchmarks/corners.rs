//! Corners: a block with sharp corners, pressed on a bed and pushed sideways.

use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target};
use crate::failure::Failure;
use crate::measuring::slope;
use crate::outcome::Outcome;
use crate::scenery::turned_box;
use crate::trial::Trial;

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
    set_up: "Plane strain; a block 1 m x 0.5 m on a bed 3 m x 0.3 m, both of soft rubber (E = 1 MPa, nu = 0.3, 1000 kg/m^3), the bed glued on \
a rigid slab. They touch at the start. Gravity presses with 10 m/s^2 and pushes sideways with 6 m/s^2; mu = 0.3; 0.6 s. Once along the grid, once turned through it by 20 degrees.",
    exact: "a = 6 - 0.3 * 10 = 3 m/s^2. Measured is the block's acceleration by least squares over the second half of the run, over the exact one, \
with its bounce taken out: d(v_along + mu v_away)/dt = 6 - 0.3 * 10 whatever it weighs on the bed meanwhile.",
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
    ],
    run,
};

const METRICS: [&str; 2] = ["acceleration, aligned", "acceleration, rotated"];
const PRESS: f64 = 10.0;
const PUSH: f64 = 6.0;
const FRICTION: f64 = 0.3;

fn run(case: &Case) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    for (metric, degrees) in METRICS.into_iter().zip([0.0_f64, 20.0]) {
        let acceleration = push(case, degrees.to_radians(), &mut outcome)?;
        outcome.measure(metric, acceleration / (PUSH - FRICTION * PRESS));
    }
    Ok(outcome)
}

/// The block's acceleration along the bed, which is turned through the grid by `turn` [m/s^2].
fn push(case: &Case, turn: f64, outcome: &mut Outcome) -> Result<f64, Failure> {
    let h = 1.0 / case.cells;
    let (sin, cos) = turn.sin_cos();
    let mut trial = Trial::start(
        if turn == 0.0 { "aligned" } else { "rotated" },
        format!(
            r#"title = "Block with sharp corners, pressed and pushed"
gravity = [{}, {}]
space = {{ dimension = "plane-strain", cell = {h} }}
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
    let mut speeds = Vec::new();
    while trial.advance()? {
        if trial.time() >= 0.3 {
            let v = trial.bodies()[2].velocity;
            // The bounce changes the weight on the bed, and with it the friction: along + mu x away changes by the pushes alone.
            let (along, away) = (v[0] * cos + v[1] * sin, v[1] * cos - v[0] * sin);
            speeds.push((trial.time(), along + FRICTION * away));
        }
    }
    outcome.include(trial);
    Ok(slope(&speeds))
}
