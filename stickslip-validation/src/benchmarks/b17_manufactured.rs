//! B17: a motion that is prescribed, and the body force that makes it so.

use crate::benchmark::{Allowed, Benchmark, Case, Laws, Miss, Reason, Resolution, Target};
use crate::failure::CaseFailure;
use crate::outcome::Outcome;
use crate::trial::Trial;
use std::f64::consts::TAU;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "B17",
    title: "Manufactured motion along the axes",
    source: "After Wallstedt and Guilkey (2008), J. Comput. Phys. 227; from rest, and for this law",
    picture: "
      ___________
     | -> <- | <- ->   between mirrors, stretched and squeezed by up to 31 %
     |  ...  |  ...
     |___________|
",
    set_up: "Plane strain; a square of E = rho = 1, nu = 0.3 between four symmetry faces, with a force per mass, a \
formula of t, x0 and y0, that makes it move as the exact answer does. Until it is furthest from where it was, t = 1.",
    exact: "u_x = A sin(2 pi X) (1 - cos(pi t))/2, u_y = -A sin(2 pi Y) (1 - cos(pi t))/2, A = 0.05. Measured is the \
root of the mean square error of the particles' places, over A.",
    laws: Laws::Bulk,
    measure: "side/h",
    resolutions: &[Resolution::quick(8.0), Resolution::quick(16.0), Resolution::full(32.0)],
    targets: &[
        Target::new(ERROR, 0.0, Allowed::Within(0.08), "eight cells on a wave").at(8.0),
        Target::new(ERROR, 0.0, Allowed::Within(0.02), "second order").at(16.0),
        Target::new(ERROR, 0.0, Allowed::Within(0.005), "second order")
            .at(32.0)
            .missed(&[Miss { cells: 32.0, off: 0.012 }]),
    ],
    reasons: &[Reason {
        laws: &["gimp-modified-last-rflip"],
        text: "From 8 to 16 cells the order is 2.0, then the error stays at 1 % of the amplitude, with a twentieth of \
the longest step as well: the boxes of uniform GIMP keep their width while the square is stretched and squeezed by 31 %.",
    }],
    run,
};

const ERROR: &str = "error of places";
const AMPLITUDE: f64 = 0.05;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut trial = Trial::start("square", scene(case))?;
    let start = trial.snapshot();
    while trial.advance()? {}
    let now = trial.snapshot();
    let grown = 0.5 * (1.0 - (0.5 * TAU * trial.time()).cos());
    let squares = start.position.iter().zip(&now.position).map(|(before, after)| {
        let error =
            |i: usize, sign: f64| after[i] - before[i] - sign * AMPLITUDE * (TAU * before[i]).sin() * grown;
        error(0, 1.0).powi(2) + error(1, -1.0).powi(2)
    });
    let mut outcome = Outcome::default();
    outcome.measure(ERROR, (squares.sum::<f64>() / start.position.len() as f64).sqrt() / AMPLITUDE);
    outcome.include(trial);
    Ok(outcome)
}

fn scene(case: &Case) -> String {
    // P = dW/da along an axis with stretches a, and b across it:
    // dP/da = K/2 (b^2 + 1/a^2) + G (a b)^(-2/3) (2/9 + 5 (b^2 + 1)/(9 a^2)); force per mass u'' - dP/da da/dX / rho.
    let grown = "((1 - cos(pi * t)) / 2)";
    let stretch =
        |x: &str, sign: &str| format!("(1 {sign} 2 * pi * {AMPLITUDE} * cos(2 * pi * {x}) * {grown})");
    let force = |x: &str, (a, b): (&str, &str)| {
        format!(
            "{AMPLITUDE} * sin(2 * pi * {x}) * (pi^2 / 2 * cos(pi * t) + \
             4 * pi^2 * {grown} * (bulk / 2 * ({b}^2 + 1 / {a}^2) + \
             shear * ({a} * {b})^(-2 / 3) * (2 / 9 + 5 * ({b}^2 + 1) / (9 * {a}^2))))"
        )
    };
    let (a, b) = (stretch("x0", "+"), stretch("y0", "-"));
    format!(
        r#"title = "Manufactured motion"
{}{}[space.domain]
min = [0, 0]
max = [1, 1]
x_min = "symmetry"
x_max = "symmetry"
y_min = "symmetry"
y_max = "symmetry"
[parameters]
bulk = "1 / (3 * (1 - 2 * 0.3))"
shear = "1 / (2 * (1 + 0.3))"
[materials.rubber]
density = 1
neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }}
[[bodies]]
name = "square"
material = "rubber"
shape.box = {{ min = [0, 0], max = [1, 1] }}
[[loads]]
body = "square"
acceleration = ["{}", "-{}"]
"#,
        case.space("plane-strain", 1.0 / case.cells),
        case.time(1.0),
        force("x0", (&a, &b)),
        force("y0", (&b, &a)),
    )
}
