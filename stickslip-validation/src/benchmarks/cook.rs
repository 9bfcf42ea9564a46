//! Cook's membrane: a tapered panel that bends and shears, near incompressibility.

use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target};
use crate::failure::CaseFailure;
use crate::finite_elements::ElementGrid;
use crate::outcome::Outcome;
use crate::trial::Trial;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "cook",
    title: "Cook's membrane near incompressibility",
    source: "Cook (1974), J. Struct. Div. ASCE 100, for the panel; linear elasticity by finite elements with reduced \
integration of the volume's change (Hughes 1980), here in the benchmark",
    picture: "
        ////    _____  44/48 + 16/48
        ///| _-      |
        ///|         |
        ///|       _-
        ///|    _-
        ///|_ -          1 long, 44/48 high at the wall
",
    set_up: "Plane strain; the panel with corners (0, 0), (48, 44), (48, 60), (0, 44) over 48, E = rho = 1, \
neo-Hookean, fixed at its left side, under its own weight of g = 0.001 and at rest by dynamic relaxation; \
nu = 0.3 and 0.4999, where the change of volume is averaged.",
    exact: "The sag of its centre of mass by 32 x 32 and 64 x 64 linear elements, extrapolated to none, small strain.",
    laws: Laws::Bulk,
    measure: "length/h",
    resolutions: &[Resolution::quick(12.0), Resolution::full(24.0)],
    targets: &[
        Target::new(SAGS[0], 1.0, Allowed::Within(0.05), COARSE).at(12.0),
        Target::new(SAGS[1], 1.0, Allowed::Within(0.05), COARSE).at(12.0),
        Target::new(SAGS[0], 1.0, Allowed::Within(0.025), FINE).at(24.0),
        Target::new(SAGS[1], 1.0, Allowed::Within(0.025), FINE).at(24.0),
    ],
    reasons: &[],
    run,
};

const SAGS: [&str; 2] = ["sag, nu = 0.3", "sag, nu = 0.4999"];
const COARSE: &str = "4 cells on the free end; a slanting border counts by whole particles";
const FINE: &str = "half of what 12 cells may";
const CASES: [(f64, &str); 2] = [(0.3, "own"), (0.4999, "averaged")];
const G: f64 = 1e-3;

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut outcome = Outcome::default();
    for (metric, (poisson, volume_change)) in SAGS.into_iter().zip(CASES) {
        let sag = sag(case, (poisson, volume_change), &mut outcome)?;
        let [coarse, fine] = [32, 64].map(|elements| exact_sag(poisson, elements));
        outcome.measure(metric, sag / (2.0 * fine - coarse));
    }
    Ok(outcome)
}

/// How far the centre of mass sinks.
fn sag(
    case: &Case,
    (poisson, volume_change): (f64, &str),
    outcome: &mut Outcome,
) -> Result<f64, CaseFailure> {
    let mut trial = Trial::start(
        format!("nu_{poisson}"),
        format!(
            r#"title = "Cook's membrane"
gravity = [0, -{G}]
{}domain = {{ min = [0, -0.5], max = [1.5, 2], x_min = "fixed" }}
{}relax = {{ residual = 1e-3 }}
[materials.rubber]
density = 1
volume_change = "{volume_change}"
neo_hookean = {{ young_modulus = 1, poisson_ratio = {poisson} }}
[[bodies]]
name = "panel"
material = "rubber"
shape.polygon.points = [[0, 0], [1, "44 / 48"], [1, "60 / 48"], [0, "44 / 48"]]
"#,
            case.space("plane-strain", 1.0 / case.cells),
            case.time(200.0)
        ),
    )?;
    let start = trial.bodies()[0].position[1];
    while trial.advance()? && !trial.is_at_rest() {}
    let sunk = start - trial.bodies()[0].position[1];
    outcome.include(trial);
    Ok(sunk)
}

/// The same by n x n elements.
fn exact_sag(poisson: f64, n: usize) -> f64 {
    let mut grid = ElementGrid::new(n, poisson, |u, v| [u, (44.0 * u + v * (44.0 - 28.0 * u)) / 48.0]);
    for j in 0..=n {
        let node = grid.node(0, j);
        grid.prescribed[2 * node] = Some(0.0);
        grid.prescribed[2 * node + 1] = Some(0.0);
    }
    let areas = grid.add_weight([0.0, -G]);
    let displacement = grid.solve();
    let moment: f64 = areas.iter().enumerate().map(|(node, area)| area * displacement[2 * node + 1]).sum();
    -moment / areas.iter().sum::<f64>()
}

#[test]
fn elements_converge_and_a_beam_of_the_mean_height_sags_about_as_much() {
    let [a, b, c] = [16, 32, 64].map(|n| exact_sag(0.4999, n));
    assert!((b - c).abs() < 0.6 * (a - b).abs() && (c / b - 1.0).abs() < 0.01, "{a} {b} {c}");
    // w L^4 / (20 E I) is the mean of a uniform cantilever's deflection, without its shear.
    let (height, load): (f64, f64) = (30.0 / 48.0, G * 30.0 / 48.0);
    let beam = load / (20.0 * height.powi(3) / 12.0 / (1.0 - 0.25));
    assert!((0.5..2.0).contains(&(c / beam)), "{c} {beam}");
}
