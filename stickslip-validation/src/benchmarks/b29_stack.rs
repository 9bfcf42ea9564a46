//! B29: a stack of ten blocks under its weight.

use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target, Tier};
use crate::failure::CaseFailure;
use crate::measuring::mean;
use crate::outcome::Outcome;
use crate::trial::Trial;
use stickslip::door::ParticleSnapshot;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "B29",
    title: "Stack of ten blocks",
    source: "Statics",
    picture: "
            |_|
            |_|   ten blocks
            |_|
        ____|_|____  rigid floor
",
    set_up: "Plane strain; ten square blocks of side 1, E = rho = 1, nu = 0.3, on each other at the start, mu = \
0.3; the load comes at once: 10 rho g/E = 0.005; 1000 transits of the stack (quick: 25).",
    exact: "No sinking, no creep, a mean stress of the base of 10 rho g. Sinking is the overlap of two blocks' \
faces, each face the mean of its row of particles and their half-height as strained; the worst interface, averaged \
over the last fifth of the run; creep its change from the fifth before. Stress is that of the lowest row in these \
two fifths.",
    laws: Laws::Contact,
    measure: "block/h",
    resolutions: &[Resolution::quick(4.0), Resolution::full(8.0)],
    targets: &[
        Target::new(
            "sinking [cells]",
            0.0,
            Allowed::Within(0.05),
            "a twentieth of a cell an interface is half a cell in the stack",
        ),
        Target::new(
            "creep [cells]",
            0.0,
            Allowed::Within(0.005),
            "a tenth of the sinking allowed, in a fifth of the run",
        ),
        Target::new(
            "base stress over weight",
            1.0,
            Allowed::Within(0.03),
            "the average over the stack's oscillations",
        ),
        Target::new(
            "energy drift",
            0.0,
            Allowed::Between(-1.0, 0.01),
            "over the largest energy that moved or was stored; the stack may come to rest, it must not gain",
        ),
    ],
    reasons: &[],
    run,
};

const BLOCKS: u32 = 10;
const GRAVITY: f64 = 5e-4;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let (h, interior) = (1.0 / case.cells, case.interior);
    let transits = if case.tier == Tier::Full { 1000.0 } else { 25.0 };
    let end = transits * f64::from(BLOCKS);
    let block = |i: u32| {
        format!(
            "[[bodies]]\nname = \"block_{i}\"\nmaterial = \"elastic\"\nshape.box = {{ min = [0, {i}], max = [1, {}] \
}}\n",
            i + 1
        )
    };
    let mut trial = Trial::start(
        "stack",
        format!(
            r#"title = "Stack of ten blocks"
gravity = [0, -{GRAVITY}]
space = {{ dimension = "plane-strain", interior = "{interior}", cell = {h} }}
time.end = {end}
materials.elastic = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }} }}
{}[[bodies]]
name = "floor"
material = "elastic"
shape.box = {{ min = [-1, -{}], max = [2, 0] }}
rigid = {{}}
{}"#,
            (0..BLOCKS).map(block).collect::<String>(),
            2.0 * h,
            case.contact(0.3)
        ),
    )?;
    let start = trial.snapshot();
    // Overlaps and the base's stress in the last two fifths.
    let (mut overlaps, mut stresses) = ([Vec::new(), Vec::new()], Vec::new());
    let mut next = 0.6 * end;
    while trial.advance()? {
        if trial.time() < next {
            continue;
        }
        next += end / 1000.0;
        let now = trial.snapshot();
        let last = usize::from(trial.time() > 0.8 * end);
        let interfaces: Vec<f64> = (0..BLOCKS)
            .map(|i| face(&start, &now, i, Side::Top) - face(&start, &now, i + 1, Side::Bottom))
            .take(BLOCKS as usize - 1)
            .chain([-face(&start, &now, 0, Side::Bottom)])
            .collect();
        overlaps[last].push(interfaces);
        stresses.push(mean(&row(&start, 0, Side::Bottom).map(|p| now.stress[p][1]).collect::<Vec<_>>()));
    }
    let [before, after] = overlaps.map(|samples| {
        let interface = |i: usize| mean(&samples.iter().map(|sample| sample[i] / h).collect::<Vec<_>>());
        (0..BLOCKS as usize).map(interface).fold(f64::NEG_INFINITY, f64::max)
    });
    // The lowest row carries all but its own lower half.
    let weight = GRAVITY * (f64::from(BLOCKS) - 0.25 * h);
    let mut outcome = Outcome::default();
    outcome.measure("sinking [cells]", after);
    outcome.measure("creep [cells]", after - before);
    outcome.measure("base stress over weight", -mean(&stresses) / weight);
    outcome.include(trial);
    outcome.measure("energy drift", outcome.record.energy_drift);
    Ok(outcome)
}

#[derive(Clone, Copy, PartialEq)]
enum Side {
    Bottom,
    Top,
}

/// The particles of a block that were its lowest or highest row at the start.
fn row(start: &ParticleSnapshot, block: u32, side: Side) -> impl Iterator<Item = usize> {
    let width = start.volume[0].sqrt();
    let level = match side {
        Side::Bottom => f64::from(block) + 0.5 * width,
        Side::Top => f64::from(block + 1) - 0.5 * width,
    };
    (0..start.body.len())
        .filter(move |&p| start.body[p] == block && (start.position[p][1] - level).abs() < 0.1 * width)
}

/// Mean height of a block's lower or upper face [m].
fn face(start: &ParticleSnapshot, now: &ParticleSnapshot, block: u32, side: Side) -> f64 {
    let half = 0.5 * start.volume[0].sqrt();
    let sign = if side == Side::Top { 1.0 } else { -1.0 };
    let heights: Vec<f64> =
        row(start, block, side).map(|p| now.position[p][1] + sign * half * now.deformation[p][4]).collect();
    mean(&heights)
}
