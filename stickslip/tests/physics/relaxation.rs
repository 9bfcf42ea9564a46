//! Dynamic relaxation finds the state at rest, and says how near it came.
//!
//! Source: kinetic damping (Cundall 1982; Barnes 1999). A slender bar of length L that hangs under its own weight sags
//! by rho g L^2 / (2 E) at its lower end, and by two thirds of that at its centre of mass.
//!
//! Set-up: a gel bar in plane stress, 10 cm by 2 cm, E = 50 kPa, nu = 0.3, cells of 5 mm, held at its upper end; a
//! stack of a disk and a block on a rigid floor, with friction; a bar of metal that yields under its weight.
//!
//! Expected: the sag of the centre within 1 % and of the end within 2 % (the clamp holds the width, the end's particles
//! lie a quarter of a cell above it), in less than a fifth of the steps of 20 periods, with a residual of 1e-3; the
//! weight on the floor within 1 %.

use crate::trial::{run_to, start};
use stickslip::door::{ContactCursor, View};
use stickslip::run::{RunOptions, run};

/// The bar, with places for damping and time.
pub const BAR: &str = r#"
    gravity = [0, -9.81]
    DAMPING
    time = { TIME }
    materials.gel = { density = 1000, neo_hookean = { young_modulus = 5e4, poisson_ratio = 0.3 } }
    [space]
    dimension = "plane-stress"
    interior = "grid"
    cell = 5e-3
    domain = { min = [-0.02, -0.12], max = [0.02, 0], y_max = "fixed" }
    [[bodies]]
    name = "bar"
    material = "gel"
    shape.box = { min = [-0.01, -0.1], max = [0.01, 0] }
    [outputs]
    particles = "never"
"#;

/// Its length [m].
pub const LENGTH: f64 = 0.1;
/// Sag of its centre of mass and of its lower end [m].
pub const SAG: [f64; 2] =
    [1000.0 * 9.81 * LENGTH * LENGTH / 5e4 / 3.0, 1000.0 * 9.81 * LENGTH * LENGTH / 5e4 / 2.0];
/// Period of its slowest swing, 4 L / sqrt(E / rho) [s].
const PERIOD: f64 = 0.05657;

/// The bar with damping, and keys of its time.
pub fn bar(damping: &str, time: &str) -> String {
    BAR.replace("DAMPING", damping).replace("TIME", time)
}

/// By how much the lowest particles have sunk [m].
pub fn lowest(view: &dyn View) -> f64 {
    let lowest = view.snapshot().position.iter().map(|x| x[1]).fold(0.0, f64::min);
    -lowest - (LENGTH - 0.00125)
}

#[test]
fn a_hanging_bar_finds_its_static_sag() {
    let mut simulation = start(&bar("", "end = 1.1314, relax = { residual = 1e-3 }"));
    let total = simulation.ledger().total;
    run_to(&mut *simulation, 20.0 * PERIOD, |_| {});
    let relaxation = simulation.relaxation().expect("asked for");
    let (sag, tip) = (-simulation.bodies()[0].position[1] - 0.5 * LENGTH, lowest(&*simulation));
    let per_period = PERIOD / (simulation.time() / simulation.steps() as f64);
    println!(
        "{} steps, {:.2} periods, {relaxation:?}; sag of the centre {:.4}, of the lower end {:.4}",
        simulation.steps(),
        simulation.time() / PERIOD,
        sag / SAG[0],
        tip / SAG[1]
    );
    assert!(relaxation.at_rest && relaxation.residual <= 1e-3 && relaxation.peaks > 0, "{relaxation:?}");
    assert!((sag / SAG[0] - 1.0).abs() < 0.01, "{sag}");
    assert!((tip / SAG[1] - 1.0).abs() < 0.02, "{tip}");
    assert!((simulation.steps() as f64) < 20.0 * per_period / 5.0);
    let ledger = simulation.ledger();
    assert!(ledger.kinetic <= 1e-6 * ledger.strain, "{ledger:?}");
    assert!((ledger.total - total).abs() < 3e-3 * ledger.damping, "{ledger:?}");
}

/// A disk on a floor, and a block on the disk, with friction.
pub fn stack(interior: &str) -> String {
    r#"
        gravity = [0, -9.81]
        space = { dimension = "plane-strain", interior = "INTERIOR", cell = 0.01 }
        time = { end = 5, relax = {} }
        materials.gel = { density = 1000, neo_hookean = { young_modulus = 5e4, poisson_ratio = 0.3 } }
        contact = [{ friction = 0.5 }]
        [[bodies]]
        name = "floor"
        material = "gel"
        shape.half_space = { point = [0, 0], normal = [0, 1] }
        rigid = {}
        [[bodies]]
        name = "disk"
        material = "gel"
        shape.ball = { center = [0, 0.05], radius = 0.05 }
        [[bodies]]
        name = "block"
        material = "gel"
        shape.box = { min = [-0.05, 0.1], max = [0.05, 0.14] }
    "#
    .replace("INTERIOR", interior)
}

/// The stack comes to rest, and the floor bears its weight.
pub fn stack_comes_to_rest(scene: &str) {
    let mut simulation = start(scene);
    let mut contacts = ContactCursor::default();
    run_to(&mut *simulation, 5.0, |simulation| {
        if simulation.relaxation().is_some_and(|state| !state.at_rest && state.residual > 2e-3) {
            contacts.read(simulation);
        }
    });
    let relaxation = simulation.relaxation().expect("asked for");
    let weight = 9.81 * simulation.bodies().iter().skip(1).map(|body| body.mass).sum::<f64>();
    let found = contacts.read(&*simulation);
    let borne =
        found.iter().find(|contact| contact.body_a == 0).expect("the floor bears").mean.force[1] / weight;
    println!("{relaxation:?} after {} steps; floor bears {borne:.4} of the weight", simulation.steps());
    assert!(relaxation.at_rest);
    assert!((borne - 1.0).abs() < 0.01, "{borne}");
}

#[test]
fn a_stack_comes_to_rest_on_its_floor() {
    stack_comes_to_rest(
        &stack("grid").replace("radius = 0.05 }", "radius = 0.05 }\n        particles = \"fitted\""),
    );
}

#[test]
fn metal_yields_on_the_way_and_comes_to_rest() {
    let law = "von_mises = { young_modulus = 5e4, poisson_ratio = 0.3, yield_stress = 700, hardening_modulus = 2e4 }";
    let elastic = "neo_hookean = { young_modulus = 5e4, poisson_ratio = 0.3 }";
    let mut simulation =
        start(&bar("", "end = 2, relax = {}").replace(elastic, law).replace("plane-stress", "plane-strain"));
    run_to(&mut *simulation, 2.0, |_| {});
    let (relaxation, ledger) = (simulation.relaxation().expect("asked for"), simulation.ledger());
    println!("{relaxation:?}, plastic {:.2e} J, strain {:.2e} J", ledger.plastic, ledger.strain);
    assert!(relaxation.at_rest && ledger.plastic > 0.0);
}

#[test]
fn the_record_of_a_run_says_whether_it_came_to_rest() {
    let folder = std::env::temp_dir().join(format!("stickslip-relaxation-{}", std::process::id()));
    for (end, at_rest) in [(1.0, true), (0.05, false)] {
        let text = bar("", &format!("end = {end}, relax = {{}}"));
        let scene = stickslip::scene::parse("bar.toml", &text, &[]).expect("a scene").scene;
        let mut simulation = stickslip::step::build(&scene).expect("a sound scene");
        let summary = run(&scene, &mut *simulation, &RunOptions::new(&folder), &mut |_| {}).expect("a run");
        let state = summary.relaxation.expect("asked for");
        assert_eq!(state.at_rest, at_rest, "{state:?}");
        let warned = summary.warnings.iter().any(|warning| warning.kind == "relaxation");
        assert_eq!(warned, !at_rest, "{:?}", summary.warnings);
        let text = summary.to_string();
        assert!(
            text.contains(if at_rest { "relaxation at rest" } else { "relaxation not at rest" }),
            "{text}"
        );
        let manifest = stickslip::observe::Manifest::read(&folder).expect("the record");
        assert_eq!(manifest.relaxation, Some(state));
        assert_eq!(simulation.time() < end, at_rest);
    }
    std::fs::remove_dir_all(&folder).expect("the folder of the run");
}
