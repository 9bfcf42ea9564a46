//! B24: Taylor's bar, a copper rod shot at a wall.

use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target};
use crate::failure::CaseFailure;
use crate::outcome::Outcome;
use crate::trial::Trial;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "B24",
    title: "Taylor bar",
    source: "Wilkins and Guinan (1973); the set-up of many codes, among them Kamoulakos (1990) and Zhu and Cescotto \
(1995)",
    picture: "
       |wall
       |_________________
       |                 |
       |                 |   <- 227 m/s
       |_________________|
       |
",
    set_up: "In space; a quarter, between mirrors, of a copper rod of 32.4 mm and radius 3.2 mm: E = 117 GPa, nu = \
0.35, 8930 kg/m^3, von Mises with yield stress 400 MPa and hardening modulus 100 MPa. The wall is without friction: \
a mirror. 80 us.",
    exact: "Published final lengths are 21.4 to 21.5 mm, foot radii 7.0 to 7.2 mm. Measured are the farthest \
particle from the wall and, within half of R0 of the wall, from the axis, each with half of its size.",
    laws: Laws::Bulk,
    measure: "R0/h",
    resolutions: &[Resolution::quick(4.0), Resolution::full(8.0)],
    targets: &[
        Target::new(
            LENGTH,
            21.45,
            Allowed::Between(21.1, 21.8),
            "four cells on the radius: 1.5 % beside the published span",
        )
        .at(4.0),
        Target::new(
            FOOT,
            7.1,
            Allowed::Between(6.5, 7.5),
            "four cells on the radius, particles stretched to twice their size",
        )
        .at(4.0),
        Target::new(LENGTH, 21.45, Allowed::Between(21.3, 21.6), "the published span and half a per cent")
            .at(8.0),
        Target::new(
            FOOT,
            7.1,
            Allowed::Between(6.8, 7.3),
            "the published span and 2 %: particles tell the rim coarsely",
        )
        .at(8.0),
    ],
    reasons: &[],
    run,
};

const LENGTH: &str = "length [mm]";
const FOOT: &str = "foot radius [mm]";
const RADIUS: f64 = 3.2e-3;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let h = RADIUS / case.cells;
    let room = (0.04 / h).ceil() * h;
    let mut trial = Trial::start(
        "taylor_bar",
        format!(
            r#"title = "Taylor bar"
{}domain = {{ min = [0, 0, 0], max = [{}, {}, {room}], x_min = "symmetry", y_min = "symmetry", z_min = "symmetry" }}
{}[materials.copper]
density = 8930
von_mises = {{ young_modulus = 117e9, poisson_ratio = 0.35, yield_stress = 400e6, hardening_modulus = 100e6 }}
[[bodies]]
name = "rod"
material = "copper"
shape.intersection = [
    {{ cylinder = {{ start = [0, 0, 0], end = [0, 0, 32.4e-3], radius = {RADIUS} }} }},
    {{ half_space = {{ point = [0, 0, 0], normal = [-1, 0, 0] }} }},
    {{ half_space = {{ point = [0, 0, 0], normal = [0, -1, 0] }} }},
]
velocity = [0, 0, -227]
"#,
            case.space("3d", h),
            3.0 * RADIUS,
            3.0 * RADIUS,
            case.time(80e-6)
        ),
    )?;
    while trial.advance()? {}
    let snapshot = trial.snapshot();
    let (mut length, mut foot) = (0.0_f64, 0.0_f64);
    for (&[x, y, z], volume) in snapshot.position.iter().zip(&snapshot.volume) {
        let half = 0.5 * volume.cbrt();
        length = length.max(z + half);
        if z < 0.5 * RADIUS {
            foot = foot.max(x.hypot(y) + half);
        }
    }
    let mut outcome = Outcome::default();
    outcome.measure(LENGTH, 1e3 * length);
    outcome.measure(FOOT, 1e3 * foot);
    outcome.include(trial);
    Ok(outcome)
}
