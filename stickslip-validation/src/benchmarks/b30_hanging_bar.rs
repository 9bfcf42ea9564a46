//! B30: a bar hangs from a fixed face, and goes on hanging.

use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target, Tier};
use crate::failure::CaseFailure;
use crate::measuring::TimeMean;
use crate::outcome::Outcome;
use crate::trial::Trial;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "B30",
    title: "Hanging bar",
    source: "Linear elasticity; tension that lasts is where particles may bunch",
    picture: "
        ////////  fixed
        |      |
        |      |  10 cm x 2 cm      gravity 9.81 m/s^2, at once
        |      |
        |______|
",
    set_up: "Plane strain; a gel bar (E = 50 kPa, nu = 0.3, 1000 kg/m^3, neo-Hookean) hangs from a fixed face, \
undeformed at first, so that it swings up and down for good. 18 periods of 4L/c = 54 ms, about a second; in the full \
tier 1000 periods at L/25 and 100 on finer cells. c is that of long waves in a plate, sqrt(E'/rho), E' = E/(1 - nu^2).",
    exact: "At a distance s below the face the bar sinks by (rho g/E') (L s - s^2/2), so its centre of mass by rho g \
L^2/(3 E') = 0.595 mm, in the mean over time. The face keeps the bar as wide as it is: over some 0.3 widths it \
stretches by E'/M = 0.82 of that, which takes 2 % of the way. Measured are the mean way of the centre over the last \
third of the run over that, and over the mean of the first third; and the energy that came or went.",
    laws: Laws::Bulk,
    measure: "L/h",
    resolutions: &[Resolution::quick(25.0), Resolution::quick(50.0), Resolution::full(100.0)],
    targets: &[
        Target::new(SAG, 1.0, Allowed::Within(0.1), "five cells across see the fixed end coarsely").at(25.0),
        Target::new(SAG, 1.0, Allowed::Within(0.05), "the fixed end takes 2 %, finite strain gives 2 %")
            .at(50.0),
        Target::new(SAG, 1.0, Allowed::Within(0.05), "the fixed end takes 2 %, finite strain gives 2 %")
            .at(100.0),
        Target::new(STAYS, 1.0, Allowed::Within(0.02), STEADY).at(25.0),
        Target::new(STAYS, 1.0, Allowed::Within(0.02), STEADY).at(50.0),
        Target::new(STAYS, 1.0, Allowed::Within(0.02), STEADY).at(100.0),
        Target::new(ENERGY, 0.0, Allowed::Within(0.02), NOTHING).at(25.0),
        Target::new(ENERGY, 0.0, Allowed::Within(0.01), NOTHING).at(50.0),
        Target::new(ENERGY, 0.0, Allowed::Within(0.01), NOTHING).at(100.0),
    ],
    reasons: &[],
    run,
};

const SAG: &str = "mean sag, late";
const STAYS: &str = "mean sag, late over early";
const ENERGY: &str = "energy drift";
const STEADY: &str = "a bar does not grow; the thirds hold no whole number of the bar's own periods";
const NOTHING: &str = "nothing takes energy; what the grid does not resolve may lose a little";
const LENGTH: f64 = 0.1;
const WIDTH: f64 = 0.02;
const YOUNG: f64 = 5e4;
const POISSON: f64 = 0.3;
const DENSITY: f64 = 1000.0;
const G: f64 = 9.81;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let h = LENGTH / case.cells;
    let plane = YOUNG / (1.0 - POISSON * POISSON);
    let period = 4.0 * LENGTH / (plane / DENSITY).sqrt();
    let periods = match case.tier {
        Tier::Quick => 18.0,
        Tier::Full if case.cells < 50.0 => 1000.0,
        Tier::Full => 100.0,
    };
    let end = periods * period;
    let mut trial = Trial::start(
        "hanging_bar",
        format!(
            r#"title = "Hanging bar"
gravity = [0, -{G}]
{}domain = {{ min = [-{WIDTH}, -0.2], max = [{}, 0], y_max = "fixed" }}
{}[materials.gel]
density = {DENSITY}
neo_hookean = {{ young_modulus = {YOUNG}, poisson_ratio = {POISSON} }}
[[bodies]]
name = "bar"
material = "gel"
shape.box = {{ min = [0, -{LENGTH}], max = [{WIDTH}, 0] }}
"#,
            case.space("plane-strain", h),
            2.0 * WIDTH,
            case.time(end)
        ),
    )?;
    let start = trial.bodies()[0].position[1];
    let mut thirds = [TimeMean::default(); 3];
    while trial.advance()? {
        let third = (3.0 * trial.time() / end).min(2.0) as usize;
        thirds[third].add(start - trial.bodies()[0].position[1], trial.step_length());
    }
    let [early, _, late] = thirds.map(|third| third.value());
    let mut outcome = Outcome::default();
    outcome.measure(SAG, late / (DENSITY * G * LENGTH * LENGTH / (3.0 * plane)));
    outcome.measure(STAYS, late / early);
    outcome.measure(ENERGY, trial.energy_drift());
    outcome.include(trial);
    Ok(outcome)
}
