//! B32: bodies that nothing touches go on spinning.

use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target, Tier};
use crate::failure::Failure;
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
        Target::new(DISK.momentum, 1.0, Allowed::Within(0.002), COARSE).at(4.0),
        Target::new(DISK.momentum, 1.0, Allowed::Within(0.001), FINE).at(5.0),
        Target::new(DISK.momentum, 1.0, Allowed::Within(0.001), FINE).at(8.0),
        Target::new(DISK.energy, 1.0, Allowed::Within(0.01), ENERGY).at(4.0),
        Target::new(DISK.energy, 1.0, Allowed::Within(0.01), ENERGY).at(5.0),
        Target::new(DISK.energy, 1.0, Allowed::Within(0.01), ENERGY).at(8.0),
        Target::new(DISK.strain, 0.0, Allowed::AtMost(0.002), STRAIN).at(4.0),
        Target::new(DISK.strain, 0.0, Allowed::AtMost(0.001), STRAIN).at(5.0),
        Target::new(DISK.strain, 0.0, Allowed::AtMost(0.001), STRAIN).at(8.0),
        Target::new(SLOW.momentum, 1.0, Allowed::Within(0.001), FINE).at(5.0),
        Target::new(SLOW.energy, 1.0, Allowed::Within(0.01), ENERGY).at(5.0),
        Target::new(
            SLOW.strain,
            0.0,
            Allowed::AtMost(0.001),
            "a hundredth of the fast disk's, and some noise",
        )
        .at(5.0),
        Target::new(BALL.momentum, 1.0, Allowed::Within(0.002), COARSE).at(4.0),
        Target::new(BALL.energy, 1.0, Allowed::Within(0.01), ENERGY).at(4.0),
        Target::new(BALL.strain, 0.0, Allowed::AtMost(0.002), STRAIN).at(4.0),
        Target::new(FITTED.momentum, 1.0, Allowed::Within(0.002), COARSE).at(4.0),
        Target::new(FITTED.energy, 1.0, Allowed::Within(0.01), ENERGY).at(4.0),
        Target::new(FITTED.strain, 0.0, Allowed::AtMost(0.002), STRAIN).at(4.0),
        Target::new(BLOCK.momentum, 1.0, Allowed::Within(0.001), FINE).at(8.0),
        Target::new(BLOCK.energy, 1.0, Allowed::Within(0.01), ENERGY).at(8.0),
        Target::new(BLOCK.strain, 0.0, Allowed::AtMost(0.001), STRAIN).at(8.0),
    ],
    reasons: &[],
    run,
};

const COARSE: &str = "nothing turns it; four cells on a radius may lose twice what five do";
const FINE: &str = "nothing turns it; a transfer that has no affine part loses a little at the rim";
const ENERGY: &str = "ten times what angular momentum may be off: small motion within cells is lost";
const STRAIN: &str =
    "the pull of the spin and its ringing store 0.0006; more is strain of what should turn rigidly";

/// What is measured of a body, by name.
struct Names {
    momentum: &'static str,
    energy: &'static str,
    strain: &'static str,
}

const DISK: Names = Names {
    momentum: "angular momentum, disk",
    energy: "kinetic and strain energy, disk",
    strain: "strain over kinetic energy, disk",
};
const SLOW: Names = Names {
    momentum: "angular momentum, slow disk",
    energy: "kinetic and strain energy, slow disk",
    strain: "strain over kinetic energy, slow disk",
};
const BALL: Names = Names {
    momentum: "angular momentum, ball",
    energy: "kinetic and strain energy, ball",
    strain: "strain over kinetic energy, ball",
};
const FITTED: Names = Names {
    momentum: "angular momentum, fitted ball",
    energy: "kinetic and strain energy, fitted ball",
    strain: "strain over kinetic energy, fitted ball",
};
const BLOCK: Names = Names {
    momentum: "angular momentum, block",
    energy: "kinetic and strain energy, block",
    strain: "strain over kinetic energy, block",
};

/// Speed of a rim at R over the wave speed.
const SPIN: f64 = 1.0 / 37.0;

fn run(case: &Case) -> Result<Outcome, Failure> {
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
    names: &Names,
    (name, shape, spin, turns): (&str, &str, f64, f64),
    outcome: &mut Outcome,
) -> Result<(), Failure> {
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
