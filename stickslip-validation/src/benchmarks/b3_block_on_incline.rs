//! B3: a block on an incline slides as Coulomb says, or rests.

use super::reasons::{EXTRAPOLATED, OWN_NORMALS, PLANE_OF_PARTICLES, STAIRS};
use crate::benchmark::{Allowed, Benchmark, Case, Laws, Miss, Reason, Resolution, Target, Tier};
use crate::failure::CaseFailure;
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
                |    |  1 m x 0.5 m          aligned: the floor along the grid
        ________|____|____                   rotated: floor and gravity turned through it by 30 degrees
        //////////////////  driven <-
",
    set_up: "Plane strain; a block of soft rubber (E = 1 MPa, nu = 0.3, 1000 kg/m^3), 1 m long and 0.5 m high, on a \
rigid floor that is inclined by 30 degrees; g = 10 m/s^2. A block that is loaded at once leaves the floor and sets \
off meanwhile, so gravity's part across the floor comes first, for 0.2 s, and its part along it smoothly within 0.6 \
s more, as the acceleration of the floor away from under the block, which is the same to the block (d'Alembert); \
pic_share = 1 damps its shaking. Slides with mu = 0, 0.2, 0.4 and 0.99 tan(30 deg), rests with 1.01 tan(30 deg) and \
0.8 (quick: 0, 0.4 and 0.8).",
    exact: "a = g (sin - mu cos) against the floor while mu < tan, else rest. Measured over 0.4 s from there on are \
the acceleration by least squares, with any bounce taken out (d(v_along + mu v_away)/dt = g (sin - mu cos) whatever \
the block weighs meanwhile), less the exact one, over that of a block without friction, and the way gone by a block \
at rest over the way of a block without friction that starts then.",
    laws: Laws::Contact,
    measure: "block length/h",
    resolutions: &[Resolution::quick(10.0), Resolution::full(20.0)],
    targets: &[
        Target::new(
            SLIDES[0],
            0.0,
            Allowed::Within(0.01),
            "the block is rigid but for its shaking, which is damped",
        )
        .missed(&[Miss { cells: 20.0, off: 0.085 }]),
        Target::new(RESTS[0], 0.0, Allowed::Within(0.001), REST),
        Target::new(NEAR[0], 0.0, Allowed::Within(0.001), REST)
            .at(20.0)
            .missed(&[Miss { cells: 20.0, off: 0.048 }]),
        Target::new(
            SLIDES[1],
            0.0,
            Allowed::Within(0.03),
            "particles on the grid's lattice make stairs of an inclined face",
        ),
        Target::new(RESTS[1], 0.0, Allowed::Within(0.001), REST),
        Target::new(NEAR[1], 0.0, Allowed::Within(0.001), REST)
            .at(20.0)
            .missed(&[Miss { cells: 20.0, off: 0.023 }]),
    ],
    reasons: &[
        OWN_NORMALS,
        STAIRS,
        EXTRAPOLATED,
        PLANE_OF_PARTICLES,
        Reason {
            laws: &["surface"],
            text: "One per cent above the coefficient that would let it go, the block is set off by what is left of \
its shaking, and then slows down as Coulomb says, by a hundredth of free fall: too slowly to come to rest in the \
run. With the transfer flip it creeps by 0.005 of free fall at L/20. With rflip pic_share = 1 does not damp the \
shaking: the block bounces with 0.02 m/s where it slides on 0.99 tan and rests on 1.01 tan, against 0.0006 m/s with \
flip, nodes let go for moments as in B33, and it is set off more: 0.032 aligned and 0.015 rotated, and on 0.99 tan \
its acceleration is 0.057 too large, against 0.0006 with flip.",
        },
    ],
    run,
};

const SLIDES: [&str; 2] = ["acceleration off, aligned", "acceleration off, rotated"];
const RESTS: [&str; 2] = ["creep at rest, mu = 0.8, aligned", "creep at rest, mu = 0.8, rotated"];
const NEAR: [&str; 2] = ["creep at rest, mu = 1.01 tan, aligned", "creep at rest, mu = 1.01 tan, rotated"];
const REST: &str = "exactly at rest; a thousandth of free fall is the shaking";
const ANGLE: f64 = std::f64::consts::PI / 6.0;
const G: f64 = 10.0;
/// Gravity across the floor alone acts until then [s].
const SETTLED: f64 = 0.2;
/// That along it acts in full from then on [s].
const LOADED: f64 = 0.8;
const END: f64 = 1.2;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
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
        let (_, creep) = slide(case, turn, 0.8, &mut outcome)?;
        outcome.measure(RESTS[variant], creep);
        if case.tier == Tier::Full {
            let (_, creep) = slide(case, turn, 1.01 * tan, &mut outcome)?;
            outcome.measure(NEAR[variant], creep);
        }
    }
    Ok(outcome)
}

/// Acceleration and way under the full load over those without friction; the floor is turned against the grid by `turn`
/// [rad].
fn slide(case: &Case, turn: f64, friction: f64, outcome: &mut Outcome) -> Result<(f64, f64), CaseFailure> {
    let (h, interior) = (1.0 / case.cells, case.interior);
    let damps = if case.is_own() { "" } else { ", pic_share = 1" };
    let (along, away) = ([turn.cos(), -turn.sin()], [turn.sin(), turn.cos()]);
    let (press, free) = (G * ANGLE.cos(), G * ANGLE.sin());
    // Speed of the floor: its acceleration grows from nothing to `free` as (1 - cos)/2.
    let ramp = LOADED - SETTLED;
    let growing = format!("(t - {SETTLED}) / 2 - {ramp} / (2 * pi) * sin(pi * (t - {SETTLED}) / {ramp})");
    let speed = format!("if(t < {SETTLED}, 0, if(t < {LOADED}, {growing}, t - {}))", SETTLED + 0.5 * ramp);
    // Nothing damps a body on a grid of its own: what would shake it comes slowly.
    let weight = |g: f64| match case.is_own() {
        true => format!("\"{g} / 2 * (1 - cos(pi * min(t / {SETTLED}, 1)))\""),
        false => g.to_string(),
    };
    let mut trial = Trial::start(
        format!("{}_mu_{friction:.4}", if turn == 0.0 { "aligned" } else { "rotated" }),
        format!(
            r#"title = "Block on an incline"
gravity = [{}, {}]
space = {{ dimension = "plane-strain", interior = "{interior}", cell = {h} }}
time = {{ end = {END}{damps} }}
materials.rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1e6, poisson_ratio = 0.3 }} }}
[[bodies]]
name = "floor"
material = "rubber"
{}
rigid.velocity = ["{} * {speed}", "{} * {speed}"]
[[bodies]]
name = "block"
material = "rubber"
{}
{}"#,
            weight(-press * away[0]),
            weight(-press * away[1]),
            turned_box([-1.0, -3.0 * h], [4.0, 0.0], -turn),
            -free * along[0],
            -free * along[1],
            turned_box([0.0, 0.0], [1.0, 0.5], -turn),
            case.contact(friction)
        ),
    )?;
    let project = |x: [f64; 2], direction: [f64; 2]| x[0] * direction[0] + x[1] * direction[1];
    let (mut speeds, mut ways) = (Vec::new(), Vec::new());
    while trial.advance()? {
        if trial.time() >= LOADED {
            let bodies = trial.bodies();
            let [floor, block] = [&bodies[0], &bodies[1]];
            let velocity = [0, 1].map(|i| block.velocity[i] - floor.velocity[i]);
            // The bounce changes the weight on the floor, and with it the friction: along + mu x away changes by
            // gravity alone.
            let moving = project(velocity, along) + friction * project(velocity, away);
            speeds.push((trial.time(), moving));
            ways.push(project([0, 1].map(|i| block.position[i] - floor.position[i]), along));
        }
    }
    outcome.include(trial);
    let [first, .., last] = ways[..] else { return Err(CaseFailure::Absent("the run under the full load")) };
    Ok((slope(&speeds) / free, (last - first) / (0.5 * free * (END - LOADED).powi(2))))
}
