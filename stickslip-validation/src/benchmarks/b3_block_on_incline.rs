//! B3: a block on an incline slides as Coulomb says, or rests.

use super::reasons::{EXTRAPOLATED, OWN_NORMALS, PLANE_OF_PARTICLES, STAIRS};
use crate::benchmark::{Allowed, Benchmark, Case, Laws, Reason, Resolution, Target, Tier};
use crate::failure::Failure;
use crate::measuring::{farthest, slope};
use crate::outcome::Outcome;
use crate::scenery::turned_box;
use crate::trial::Trial;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "B3",
    title: "Block on an incline",
    source: "Coulomb's law",
    picture: "
                 ____
                |    |  1 m x 0.5 m          aligned: the geometry along the grid, gravity inclined
        ________|____|____                   rotated: gravity down, the geometry turned through the grid
        //////////////////
",
    set_up: "Plane strain; a block of soft rubber (E = 1 MPa, nu = 0.3, 1000 kg/m^3), 1 m long and 0.5 m high, on a rigid floor; g = 10 m/s^2, 30 degrees. \
The load comes at once, so the block shakes while it settles; 0.8 s are 57 transits of the block. Slides with mu = 0, 0.2, 0.4 and 0.99 tan(30 deg), rests with \
1.01 tan(30 deg) and 0.8.",
    exact: "a = g (sin - mu cos) while mu < tan, else rest. Measured are the acceleration along the incline by least squares over the second half of \
the run, with the bounce taken out (d(v_along + mu v_away)/dt = g (sin - mu cos) whatever the block weighs meanwhile), less the exact one, and the way gone by a block at rest in that half, both over those of a block without friction.",
    laws: Laws::Contact,
    measure: "block length/h",
    resolutions: &[Resolution::quick(10.0), Resolution::full(20.0)],
    targets: &[
        Target::new(
            SLIDES[0],
            0.0,
            Allowed::Within(0.01),
            "the block is rigid but for its shaking, which the fit averages",
        ),
        Target::new(
            RESTS[0],
            0.0,
            Allowed::Within(0.001),
            "exactly at rest; a thousandth of free fall is the shaking",
        ),
        Target::new(
            SLIDES[1],
            0.0,
            Allowed::Within(0.03),
            "particles on the grid's lattice make stairs of an inclined face",
        ),
        Target::new(
            RESTS[1],
            0.0,
            Allowed::Within(0.001),
            "exactly at rest; a thousandth of free fall is the shaking",
        ),
    ],
    reasons: &[
        OWN_NORMALS,
        STAIRS,
        EXTRAPOLATED,
        PLANE_OF_PARTICLES,
        Reason {
            laws: &["surface"],
            text: "The block is loaded at once and nothing damps it, so it shakes for longer than the run; at the top of each bounce it weighs little and slips a little. It does so with cells half as large and steps a quarter as long; with time.pic_share = 1 it comes to rest and stays.",
        },
    ],
    run,
};

const SLIDES: [&str; 2] = ["acceleration off, aligned", "acceleration off, rotated"];
const RESTS: [&str; 2] = ["creep at rest, aligned", "creep at rest, rotated"];
const ANGLE: f64 = std::f64::consts::PI / 6.0;
const G: f64 = 10.0;

fn run(case: &Case) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    let tan = ANGLE.tan();
    for (turn, variant) in [0.0, ANGLE].into_iter().zip(0..) {
        let slides: &[f64] = match case.tier {
            Tier::Quick => &[0.0, 0.4],
            Tier::Full => &[0.0, 0.2, 0.4, 0.99 * tan],
        };
        let mut off = Vec::new();
        for &friction in slides {
            let (acceleration, _) = slide(case, turn, friction, &mut outcome)?;
            off.push(acceleration - (1.0 - friction / tan));
        }
        outcome.measure(SLIDES[variant], farthest(&off));
        let mut creep = Vec::new();
        for friction in [1.01 * tan, 0.8] {
            creep.push(slide(case, turn, friction, &mut outcome)?.1);
        }
        outcome.measure(RESTS[variant], farthest(&creep));
    }
    Ok(outcome)
}

/// Acceleration and way in the second half of the run over those without friction; the floor is turned against the grid by `turn` [rad].
fn slide(case: &Case, turn: f64, friction: f64, outcome: &mut Outcome) -> Result<(f64, f64), Failure> {
    let h = 1.0 / case.cells;
    // The incline falls toward x where it lies along the grid; turned clockwise by its angle, gravity points down.
    let down = -0.5 * std::f64::consts::PI + ANGLE - turn;
    let mut trial = Trial::start(
        format!("{}_mu_{friction:.4}", if turn == 0.0 { "aligned" } else { "rotated" }),
        format!(
            r#"title = "Block on an incline"
gravity = [{}, {}]
space = {{ dimension = "plane-strain", cell = {h} }}
time.end = 0.8
materials.rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1e6, poisson_ratio = 0.3 }} }}
[[bodies]]
name = "floor"
material = "rubber"
{}
rigid = {{}}
[[bodies]]
name = "block"
material = "rubber"
{}
{}"#,
            G * down.cos(),
            G * down.sin(),
            turned_box([-0.5, -3.0 * h], [3.0, 0.0], -turn),
            turned_box([0.0, 0.0], [1.0, 0.5], -turn),
            case.contact(friction)
        ),
    )?;
    let (along, away) = ([turn.cos(), -turn.sin()], [turn.sin(), turn.cos()]);
    let project = |x: [f64; 3]| x[0] * along[0] + x[1] * along[1];
    let (mut speeds, mut from) = (Vec::new(), None);
    while trial.advance()? {
        if trial.time() >= 0.4 {
            let block = trial.bodies().swap_remove(1);
            // The bounce changes the weight on the floor, and with it the friction: along + mu x away changes by gravity alone.
            let leaving = block.velocity[0] * away[0] + block.velocity[1] * away[1];
            speeds.push((trial.time(), project(block.velocity) + friction * leaving));
            from.get_or_insert(project(block.position));
        }
    }
    let free = G * ANGLE.sin();
    let way =
        project(trial.bodies()[1].position) - from.ok_or(Failure::Absent("the second half of the run"))?;
    outcome.include(trial);
    Ok((slope(&speeds) / free, way / (0.5 * free * (0.8_f64.powi(2) - 0.4_f64.powi(2)))))
}
