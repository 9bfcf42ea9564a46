//! Rigid floor: it does what a very stiff deformable floor does.

use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target};
use crate::failure::CaseFailure;
use crate::outcome::Outcome;
use crate::trial::Trial;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "rigid",
    title: "Rigid floor as the limit of a stiff one",
    source: "Limit: stiffness and density of the floor to infinity at one wave speed",
    picture: "
               __
              /  \\   v down
              \\__/
        ________________
        |_______________|   rigid, or a thousand times stiffer and denser
",
    set_up: "Plane strain; a disk of radius R, E = rho = 1, nu = 0.3, half a cell of 4 particles above a floor 4 R \
wide and R/2 thick; v/c = 0.05, without friction, until the disk flies off. The floor is rigid, or deformable with \
E = rho = 1000 and free.",
    exact: "Both give the same motion and force, but for the floor's recoil (0.2 %) and compliance (0.1 %). \
Measured are the differences of restitution and of the largest force over a tenth of R/c, relative.",
    laws: Laws::Contact,
    measure: "R/h",
    resolutions: &[Resolution::quick(8.0), Resolution::full(16.0)],
    targets: &[
        Target::new(
            "restitution, rigid over stiff",
            1.0,
            Allowed::Within(0.01),
            "three times what recoil and compliance make",
        ),
        Target::new(
            "largest force, rigid over stiff",
            1.0,
            Allowed::Within(0.01),
            "three times what recoil and compliance make",
        ),
    ],
    reasons: &[],
    run,
};

const SPEED: f64 = 0.05;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut outcome = Outcome::default();
    let rigid = drop(case, "rigid", "rigid = {}", &mut outcome)?;
    let stiff = drop(case, "stiff", "", &mut outcome)?;
    outcome.measure("restitution, rigid over stiff", rigid.0 / stiff.0);
    outcome.measure("largest force, rigid over stiff", rigid.1 / stiff.1);
    Ok(outcome)
}

/// Restitution, and the largest mean force over a tenth of R/c.
fn drop(case: &Case, name: &str, motion: &str, outcome: &mut Outcome) -> Result<(f64, f64), CaseFailure> {
    let (h, interior) = (1.0 / case.cells, case.interior);
    let mut trial = Trial::start(
        name,
        format!(
            r#"title = "Rigid floor as the limit of a stiff one"
space = {{ dimension = "plane-strain", interior = "{interior}", cell = {h} }}
time.end = 14
materials.elastic = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }} }}
materials.stiff = {{ density = 1000, neo_hookean = {{ young_modulus = 1000, poisson_ratio = 0.3 }} }}
[[bodies]]
name = "disk"
material = "elastic"
shape.ball = {{ center = [0, {}], radius = 1 }}
velocity = [0, -{SPEED}]
[[bodies]]
name = "floor"
material = "stiff"
shape.box = {{ min = [-2, -0.5], max = [2, 0] }}
{motion}
{}"#,
            1.0 + 0.5 * h,
            case.contact(0.0)
        ),
    )?;
    let (mut largest, mut impulse, mut since) = (0.0_f64, 0.0, 0.0);
    while trial.advance()? {
        impulse += trial.force(0, 1)[1] * trial.step_length();
        if trial.time() - since >= 0.1 {
            largest = largest.max(-impulse / (trial.time() - since));
            (impulse, since) = (0.0, trial.time());
        }
    }
    let bodies = trial.bodies();
    outcome.include(trial);
    Ok(((bodies[0].velocity[1] - bodies[1].velocity[1]) / SPEED, largest))
}
