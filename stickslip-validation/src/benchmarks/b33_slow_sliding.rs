//! B33: a floor creeps under a pressed block, and friction is what Coulomb says.

use crate::benchmark::{Allowed, Benchmark, Case, Laws, Miss, Reason, Resolution, Target};
use crate::failure::CaseFailure;
use crate::measuring::TimeMean;
use crate::outcome::Outcome;
use crate::trial::Trial;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "B33",
    title: "Slow sliding",
    source: "Coulomb's law at speeds far below the wave speed",
    picture: "
         //////////////   rigid lid, glued on, pressed down by 1 %
        |              |
        |              |  2 H x H
        |______________|
      ____________________
      ////////////////////  rigid floor, creeping ->
",
    set_up: "Plane strain; a block 2 H x H of E = rho = 1, nu = 0.3 under a rigid lid that is glued on and comes \
down by 0.01 H, smoothly within 20 H/c. Then a rigid floor sets off, within 10 H/c, and goes on with 1e-4, 1e-3 or \
1e-2 of the wave speed c = sqrt(E/rho); mu = 0.3. The block gives by 0.009 H before it slides; when the floor has \
gone three times that and 10 H/c have passed, forces are measured for 60 H/c.",
    exact: "The block slides everywhere, so the mean force along the floor over that across it is mu, and no smaller \
where sliding is slower. Measured over mu.",
    laws: Laws::Bulk,
    measure: "H/h",
    resolutions: &[Resolution::quick(8.0), Resolution::full(16.0)],
    targets: &[
        Target::new(METRICS[0], 1.0, Allowed::Within(0.01), EXACT),
        Target::new(METRICS[1], 1.0, Allowed::Within(0.01), EXACT)
            .missed(&[Miss { cells: 8.0, off: 0.06 }, Miss { cells: 16.0, off: 0.08 }]),
        Target::new(METRICS[2], 1.0, Allowed::Within(0.01), EXACT)
            .missed(&[Miss { cells: 8.0, off: 0.3 }, Miss { cells: 16.0, off: 0.35 }]),
    ],
    reasons: &[Reason {
        laws: &["gimp-modified-last-rflip"],
        text: "The block shakes, more where the floor is faster, and nothing damps it: friction between a rigid and \
an elastic body feeds short waves (Martins, Guimaraes and Faria 1995; Adams 1995). Nodes let go for moments, and the \
mean falls short: 0.959 at 1e-3 c and 0.793 at 1e-2 c at H/8. It is no fault of the law of friction, and not of the \
block: the kinks of tent functions feed it, by apic too (0.867 at 1e-2 c). By quadratic \
B-splines it is 0.999 at all three speeds, and with FLIP alone and pic_share = 0.05 0.998 and 0.999.",
    }],
    run,
};

const METRICS: [&str; 3] = ["friction/mu at 1e-4 c", "friction/mu at 1e-3 c", "friction/mu at 1e-2 c"];
const EXACT: &str = "the block slides everywhere; only its shaking may let go for moments";
const FRICTION: f64 = 0.3;
/// How far the floor goes before all of the block slides: mu p/G, with p = 0.01 M [H].
const GIVE: f64 = 0.009;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut outcome = Outcome::default();
    for (metric, speed) in METRICS.into_iter().zip([1e-4, 1e-3, 1e-2]) {
        let ratio = creep(case, speed, &mut outcome)?;
        outcome.measure(metric, ratio / FRICTION);
    }
    Ok(outcome)
}

/// Mean force along the floor over that across it, at a speed of the floor over the wave speed.
fn creep(case: &Case, speed: f64, outcome: &mut Outcome) -> Result<f64, CaseFailure> {
    let h = 1.0 / case.cells;
    let thick = 3.0 * h;
    let begin = 40.0 + 3.0 * GIVE / speed;
    let end = begin + 60.0;
    let mut trial = Trial::start(
        format!("creep_{speed:e}"),
        format!(
            r#"title = "Slow sliding"
{}{}[materials.rubber]
density = 1
neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }}
[[bodies]]
name = "block"
material = "rubber"
shape.box = {{ min = [0, 0], max = [2, 1] }}
[[bodies]]
name = "floor"
material = "rubber"
shape.box = {{ min = [-1.5, -{thick}], max = [3, 0] }}
rigid.velocity = ["{speed} / 2 * (1 - cos(pi * min(max(t - 20, 0) / 10, 1)))", 0]
[[bodies]]
name = "lid"
material = "rubber"
shape.box = {{ min = [0, 1], max = [2, {}] }}
rigid.velocity = [0, "-0.01 / 20 * (1 - cos(2 * pi * min(t / 20, 1)))"]
[[contact]]
between = ["block", "lid"]
law = "glued"
{}"#,
            case.space("plane-strain", h),
            case.time(end),
            1.0 + thick,
            case.contact(FRICTION)
        ),
    )?;
    let (mut along, mut across) = (TimeMean::default(), TimeMean::default());
    while trial.advance()? {
        if trial.time() > begin {
            let force = trial.force(0, 1);
            along.add(-force[0], trial.step_length());
            across.add(-force[1], trial.step_length());
        }
    }
    outcome.include(trial);
    Ok(along.value() / across.value())
}
