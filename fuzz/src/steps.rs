//! Small scenes, built and taken some steps: what reading and the check let pass is to run, or to fail with a sentence.

use crate::scene::{read, sites};
use stickslip::check::report;
use stickslip::march::March;
use stickslip::step::build;

/// Particle sites of scenes that are stepped.
const MOST_SITES: f64 = 600.0;
/// Bodies of those.
const MOST_BODIES: usize = 8;
/// Steps that are taken.
const STEPS: usize = 3;
/// Particles of all bodies: rigid ones without bounds have some where others are.
const MOST_PARTICLES: usize = 5000;

/// Reads a scene, and steps it if it is small and sound.
pub fn run(bytes: &[u8]) {
    let Ok(text) = str::from_utf8(bytes) else { return };
    let Some(loaded) = read(text) else { return };
    let scene = &loaded.scene;
    if sites(scene).0 > MOST_SITES || scene.bodies.len() > MOST_BODIES {
        return;
    }
    if report(scene).map_or(true, |report| report.particles > MOST_PARTICLES) {
        return;
    }
    let mut simulation = build(scene).expect("the check has found it sound");
    let mut march = March::to(scene.time.end);
    for _ in 0..STEPS {
        if !matches!(march.step(simulation.as_mut()), Ok(Some(_))) {
            break;
        }
    }
    let ledger = simulation.ledger();
    assert!(simulation.time() >= 0.0 && !format!("{ledger:?}").is_empty());
    assert_eq!(simulation.bodies().len(), scene.bodies.len());
    std::hint::black_box((simulation.snapshot(), simulation.loads(), simulation.joints(), simulation.save()));
}

/// Scenes with a little of everything.
pub fn seeds() -> Vec<Vec<u8>> {
    let space = crate::template::SCENE.replace("plane-strain", "plane-stress");
    [crate::template::SCENE, SPACE, &space].map(|text| text.as_bytes().to_vec()).into()
}

const SPACE: &str = r#"
gravity = [0, 0, -10]
space = { dimension = "3d", cell = 0.5, basis = "spline" }
time = { end = 0.1, stress_update = "first", transfer = "apic" }
damping = { local = 0.1 }
[materials.m]
density = 1000
viscoelastic = { bulk_modulus = 2e5, shear_modulus = 5e4, prony = [[0.4, 0.05]] }
[[bodies]]
name = "a"
material = "m"
shape.ball = { center = [0, 0, 0.9], radius = 0.8 }
[[bodies]]
name = "f"
material = "m"
rigid = {}
shape.half_space = { point = [0, 0, 0], normal = [0, 0, 1] }
[[contact]]
friction = 0.3
law = "gap"
[[supports]]
name = "s"
body = "a"
on = "z_max"
displacement = [0, "free", "-t * 1 m/s"]
"#;
