//! B32: bodies that nothing touches go on spinning.

use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target, Tier};
use crate::failure::CaseFailure;
use crate::outcome::Outcome;
use crate::trial::Trial;
use std::f64::consts::TAU;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "B32",
    title: "Free spin",
    source: "Conservation of angular momentum and of energy",
    picture: "
          _____                      ________________
        /   <-- \\                   |                |
       |    o--R-|   disk and ball  |       o        |  block of 2 R x R
        \\ _-->_ /                   |________________|
",
    set_up: "Disk, block (plane strain) and ball of E = rho = 1, nu = 0.3, neo-Hookean, with nothing around them, \
set spinning without any deformation. Rim speed 1/37 of the wave speed sqrt(E/rho); at R/5 the disk also spins at a \
tenth of that. The disk has R/4, R/5 and R/8 cells, the ball R/4, once on the lattice and once fitted; the block is \
16 x 8 cells. Two turns, the slow disk and the balls one; in the full tier ten and five.",
    exact: "Angular momentum, and kinetic and strain energy together, stay what they are. The body grows by the pull \
of its spin, by some 1/37^2 of its size, so its strain energy is 0.00015 of the kinetic one when it rests, and four \
times that when it rings. Measured at the end over the start.",
    laws: Laws::Bulk,
    measure: "R/h",
    resolutions: &[Resolution::quick(4.0), Resolution::quick(5.0), Resolution::quick(8.0)],
    targets: &[
        momentum(&DISK, 4.0),
        energy(&DISK, 4.0),
        strain(&DISK, 4.0),
        momentum(&DISK, 5.0),
        energy(&DISK, 5.0),
        strain(&DISK, 5.0),
        momentum(&DISK, 8.0),
        energy(&DISK, 8.0),
        strain(&DISK, 8.0),
        momentum(&SLOW, 5.0),
        energy(&SLOW, 5.0),
        strain(&SLOW, 5.0),
        momentum(&BALL, 4.0),
        energy(&BALL, 4.0),
        strain(&BALL, 4.0),
        momentum(&FITTED, 4.0),
        energy(&FITTED, 4.0),
        strain(&FITTED, 4.0),
        momentum(&BLOCK, 8.0),
        energy(&BLOCK, 8.0),
        strain(&BLOCK, 8.0),
    ],
    reasons: &[],
    run,
};

/// Cells on R from which on the finer targets hold.
const FINE: f64 = 5.0;

const fn momentum(names: &MetricNames, cells: f64) -> Target {
    let (tolerance, why) = match cells < FINE {
        true => (0.002, "nothing turns it; four cells on a radius may lose twice what five do"),
        false => (0.001, "nothing turns it; a transfer that has no affine part loses a little at the rim"),
    };
    Target::new(names.momentum, 1.0, Allowed::Within(tolerance), why).at(cells)
}

const fn energy(names: &MetricNames, cells: f64) -> Target {
    let why = "ten times what angular momentum may be off: small motion within cells is lost";
    Target::new(names.energy, 1.0, Allowed::Within(0.01), why).at(cells)
}

const fn strain(names: &MetricNames, cells: f64) -> Target {
    let most = if cells < FINE { 0.002 } else { 0.001 };
    let why = "the pull of the spin and its ringing store 0.0006; more is strain of what should turn rigidly";
    Target::new(names.strain, 0.0, Allowed::AtMost(most), why).at(cells)
}

/// What is measured of a body, by name.
struct MetricNames {
    momentum: &'static str,
    energy: &'static str,
    strain: &'static str,
}

const DISK: MetricNames = MetricNames {
    momentum: "angular momentum, disk",
    energy: "kinetic and strain energy, disk",
    strain: "strain over kinetic energy, disk",
};
const SLOW: MetricNames = MetricNames {
    momentum: "angular momentum, slow disk",
    energy: "kinetic and strain energy, slow disk",
    strain: "strain over kinetic energy, slow disk",
};
const BALL: MetricNames = MetricNames {
    momentum: "angular momentum, ball",
    energy: "kinetic and strain energy, ball",
    strain: "strain over kinetic energy, ball",
};
const FITTED: MetricNames = MetricNames {
    momentum: "angular momentum, fitted ball",
    energy: "kinetic and strain energy, fitted ball",
    strain: "strain over kinetic energy, fitted ball",
};
const BLOCK: MetricNames = MetricNames {
    momentum: "angular momentum, block",
    energy: "kinetic and strain energy, block",
    strain: "strain over kinetic energy, block",
};

/// Speed of a rim at R over the wave speed.
const SPIN: f64 = 1.0 / 37.0;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut outcome = Outcome::default();
    let (turns, fewer) = if case.tier == Tier::Quick { (2.0, 1.0) } else { (10.0, 5.0) };
    let round = "shape.ball = { center = [0, 0], radius = 1 }";
    spin(case, &DISK, ("disk", round, SPIN, turns), &mut outcome)?;
    if case.cells == 5.0 {
        spin(case, &SLOW, ("slow_disk", round, 0.1 * SPIN, fewer), &mut outcome)?;
    }
    if case.cells == 4.0 {
        let ball = "shape.ball = { center = [0, 0, 0], radius = 1 }";
        spin(case, &BALL, ("ball", ball, SPIN, fewer), &mut outcome)?;
        let fitted = format!("{ball}\nparticles = \"fitted\"");
        spin(case, &FITTED, ("fitted_ball", &fitted, SPIN, fewer), &mut outcome)?;
    }
    if case.cells == 8.0 {
        let block = "shape.box = { min = [-1, -0.5], max = [1, 0.5] }";
        spin(case, &BLOCK, ("block", block, SPIN, turns), &mut outcome)?;
    }
    Ok(outcome)
}

/// Lets a body spin for so many turns about the origin.
fn spin(
    case: &Case,
    names: &MetricNames,
    (name, shape, spin, turns): (&str, &str, f64, f64),
    outcome: &mut Outcome,
) -> Result<(), CaseFailure> {
    let space = name.ends_with("ball");
    let (dimension, written) =
        if space { ("3d", format!("[0, 0, {spin}]")) } else { ("plane-strain", spin.to_string()) };
    let mut trial = Trial::start(
        name,
        format!(
            r#"title = "Free spin"
{}{}[materials.rubber]
density = 1
neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }}
[[bodies]]
name = "body"
material = "rubber"
{shape}
spin = {written}
"#,
            case.space(dimension, 1.0 / case.cells),
            case.time(turns * TAU / spin)
        ),
    )?;
    while trial.advance()? {}
    let (first, last) = (trial.first_ledger(), trial.ledger());
    outcome.measure(names.momentum, last.angular_momentum[2] / first.angular_momentum[2]);
    outcome.measure(names.energy, (last.kinetic + last.strain) / (first.kinetic + first.strain));
    outcome.measure(names.strain, last.strain / first.kinetic);
    outcome.include(trial);
    Ok(())
}
