//! B7: a bar hits a bar of another impedance.

use super::reasons::OWN_NORMALS;
use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target};
use crate::failure::CaseFailure;
use crate::measuring::{farthest, mean};
use crate::outcome::Outcome;
use crate::trial::Trial;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "B7",
    title: "Impedance mismatch",
    source: "Elementary theory of impact of bars: one velocity and one traction at the interface",
    picture: "
      v ->   +--------------++-------------------------+
             |  Z = rho c   ||  Z2 = rho2 c2           |   at rest
             +--------------++-------------------------+
",
    set_up: "Plane strain, nu = 0; bars 1 and 2 long and four cells high, v = 0.01, faces touching on grid nodes at \
the start; first bar E = rho = 1; second bar (E, rho) = (10, 10), (1, 4), (16, 1).",
    exact: "sigma = -Z1 Z2 v/(Z1 + Z2) in both bars behind the fronts. Measured before waves come back from the \
free ends, when the front in the second bar has gone 0.8 to 1.8: the second bar's stress from two cells behind the \
interface to half of the front's way, as behind the front the grid rings over ten cells and more (a bar cut in two \
and glued rings alike); and the difference of the bars' stresses in the four cells on either side of the interface; \
both over the exact stress, the worst of the three pairs.",
    laws: Laws::Contact,
    measure: "L/h",
    resolutions: &[Resolution::quick(25.0), Resolution::quick(50.0), Resolution::full(100.0)],
    targets: &[
        Target::new(
            "transmitted stress off",
            0.0,
            Allowed::Within(0.03),
            "exact but for the rest of the ringing behind the front, which the mean takes out",
        ),
        Target::new(
            "tractions apart",
            0.0,
            Allowed::Within(0.05),
            "the centre-of-mass rule shares velocity by mass, not by impedance; the first cells show it",
        ),
    ],
    reasons: &[OWN_NORMALS],
    run,
};

const SPEED: f64 = 0.01;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut outcome = Outcome::default();
    let (mut off, mut apart) = (Vec::new(), Vec::new());
    for (modulus, density) in [(10.0, 10.0), (1.0, 4.0), (16.0, 1.0)] {
        let (transmitted, jump) = strike(case, modulus, density, &mut outcome)?;
        off.push(transmitted);
        apart.push(jump);
    }
    outcome.measure("transmitted stress off", farthest(&off));
    outcome.measure("tractions apart", farthest(&apart));
    Ok(outcome)
}

/// Error of the transmitted stress and difference of tractions, over the exact stress.
fn strike(case: &Case, modulus: f64, density: f64, outcome: &mut Outcome) -> Result<(f64, f64), CaseFailure> {
    let (h, interior) = (1.0 / case.cells, case.interior);
    let height = 4.0 * h;
    let wave = (modulus / density).sqrt();
    // The pressure of the first bar lasts until t = 2, and in the second the front comes to the end at 2.
    let end = (1.8 / wave).min(1.6);
    let mut trial = Trial::start(
        format!("modulus_{modulus}_density_{density}"),
        format!(
            r#"title = "Impedance mismatch"
space = {{ dimension = "plane-strain", interior = "{interior}", cell = {h} }}
time.end = {end}
materials.first = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0 }} }}
materials.second = {{ density = {density}, neo_hookean = {{ young_modulus = {modulus}, poisson_ratio = 0 }} }}
[[bodies]]
name = "first"
material = "first"
shape.box = {{ min = [0, 0], max = [1, {height}] }}
velocity = [{SPEED}, 0]
[[bodies]]
name = "second"
material = "second"
shape.box = {{ min = [1, 0], max = [3, {height}] }}
{}"#,
            case.contact(0.0)
        ),
    )?;
    let impedance = density * wave;
    let exact = -impedance * SPEED / (1.0 + impedance);
    let (mut transmitted, mut jumps) = (Vec::new(), Vec::new());
    let mut next = 0.75 * end;
    while trial.advance()? {
        if trial.time() < next {
            continue;
        }
        next += 0.0125 * end;
        let now = trial.snapshot();
        let stress = |body: u32, from: f64, to: f64| {
            let inside = |&p: &usize| now.body[p] == body && (from..to).contains(&now.position[p][0]);
            mean(&(0..now.body.len()).filter(inside).map(|p| now.stress[p][0]).collect::<Vec<_>>())
        };
        transmitted.push(stress(1, 1.0 + 2.0 * h, 1.0 + 0.5 * wave * trial.time()));
        let place = 1.0 + trial.time() * SPEED / (1.0 + impedance);
        jumps.push(stress(0, place - 4.0 * h, 2.0) - stress(1, 0.0, place + 4.0 * h));
    }
    outcome.include(trial);
    Ok((mean(&transmitted) / exact - 1.0, mean(&jumps) / exact))
}
