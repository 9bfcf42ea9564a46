//! Coming to roll: a disk that slides, and one that spins on the spot, end up rolling.

use crate::benchmark::{Allowed, Benchmark, Case, Laws, Miss, Reason, Resolution, Target};
use crate::failure::CaseFailure;
use crate::measuring::TimeMean;
use crate::outcome::Outcome;
use crate::trial::Trial;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "rolling",
    title: "Disks that come to roll",
    source: "Coulomb's law and a rigid disk's moment of inertia",
    picture: "
          ____                ____
         /    \\  v0 ->      / --> \\  w0
        |  o   |            |  o   |
         \\____/             \\____/
        ________            ________   rigid, mu = 0.3
",
    set_up: "Plane strain; a disk of R = E = rho = 1, nu = 0.45, fitted, under a gravity of 0.002 (contact \
half-width 0.08 R) on a rigid floor with mu = 0.3, once with v0 = 0.06 and no spin, once with the spin 0.06 and no \
velocity; for 120 R/c.",
    exact: "Friction acts until the disk rolls: from v0/(3 mu g) = 33 R/c on at (2/3) v0, and from w0 R/(3 mu g) on \
at w0 R/3; then it goes on rolling. Measured are the mean speed over the last half of the run over that, and the \
spin times R over it.",
    laws: Laws::Bulk,
    measure: "R/h",
    resolutions: &[Resolution::quick(8.0), Resolution::full(16.0)],
    targets: &[
        Target::new(SPEEDS[0], 1.0, Allowed::Within(0.02), ROLLS),
        Target::new(SPINS[0], 1.0, Allowed::Within(0.02), ROLLS),
        Target::new(
            SPEEDS[1],
            1.0,
            Allowed::Within(0.03),
            "the speed is half of the other disk's, what is lost the same",
        )
        .missed(&[Miss { cells: 8.0, off: 0.057 }]),
        Target::new(
            SPINS[1],
            1.0,
            Allowed::Within(0.03),
            "the speed is half of the other disk's, what is lost the same",
        ),
    ],
    reasons: &[Reason {
        laws: &["gimp-modified-last-rflip"],
        text: "The disk weighs a little more against turning than a smooth one, as the grid does (1.1 % at R/8), \
and its contact spreads over cells beside the patch. A disk that spins on the spot gets 0.962 of the speed at R/8; \
FLIP alone gave 0.938.",
    }],
    run,
};

const SPEEDS: [&str; 2] = ["speed, after sliding", "speed, after spinning"];
const SPINS: [&str; 2] = ["spin R/v, after sliding", "spin R/v, after spinning"];
const ROLLS: &str = "pressure shortens the surface by 0.006, a dent of 0.01 R friction's arm";
const START: f64 = 0.06;
const END: f64 = 120.0;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut outcome = Outcome::default();
    for (i, (name, start, part)) in [
        ("sliding", format!("velocity = [{START}, 0]"), 2.0 / 3.0),
        ("spinning", format!("spin = -{START}"), 1.0 / 3.0),
    ]
    .into_iter()
    .enumerate()
    {
        let [speed, spin] = roll(case, name, &start, &mut outcome)?;
        outcome.measure(SPEEDS[i], speed / (part * START));
        outcome.measure(SPINS[i], spin / speed);
    }
    Ok(outcome)
}

/// Mean speed and mean spin, forward, over the last half of the run.
fn roll(case: &Case, name: &str, start: &str, outcome: &mut Outcome) -> Result<[f64; 2], CaseFailure> {
    let mut trial = Trial::start(
        name,
        format!(
            r#"title = "Disks that come to roll"
gravity = [0, -0.002]
{}{}[materials.rubber]
density = 1
neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.45 }}
[[bodies]]
name = "disk"
material = "rubber"
shape.ball = {{ center = [0, 1], radius = 1 }}
particles = "fitted"
{start}
[[bodies]]
name = "floor"
material = "rubber"
shape.half_space = {{ point = [0, 0], normal = [0, 1] }}
rigid = {{}}
{}"#,
            case.space("plane-strain", 1.0 / case.cells),
            case.time(END),
            case.contact(0.3)
        ),
    )?;
    let (mut speed, mut spin) = (TimeMean::default(), TimeMean::default());
    while trial.advance()? {
        if trial.time() > 0.5 * END {
            let disk = trial.bodies().swap_remove(0);
            speed.add(disk.velocity[0], trial.step_length());
            spin.add(-disk.spin[2], trial.step_length());
        }
    }
    outcome.include(trial);
    Ok([speed.value(), spin.value()])
}
