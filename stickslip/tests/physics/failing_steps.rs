//! A step that goes wrong says which particle of which body, where and when, and leaves what it saw.
//!
//! Set-ups: a block that spins with linear functions and the stress updated last; a block that flies out of the domain;
//! one that turns in plane stress until its law has no answer; rigid blocks whose prescribed motion leaves the domain
//! or is no number. Expected: the failure of that
//! kind with the body's name; a place inside or at the edge of the body; the time of the step before;
//! the simulation can still be looked at.

use crate::trial::start;
use stickslip::door::StepError;
use stickslip::material::{CustomLaw, Isotropic, Law, Material, Motion, NeoHookean};
use stickslip::tensor::{Matrix, Symmetric};
use stickslip::{scene, step};

fn scene(motion: &str) -> String {
    format!(
        r#"
        [space]
        dimension = "plane-strain"
        interior = "grid"
        cell = 0.1
        domain = {{ min = [-20, -2], max = [2, 2] }}
        [time]
        end = 1
        courant = 1
        [materials]
        rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1e5, poisson_ratio = 0.3 }} }}
        [[bodies]]
        name = "still"
        material = "rubber"
        shape.box = {{ min = [-0.7, 0], max = [-0.2, 0.5] }}
        [[bodies]]
        name = "runaway"
        material = "rubber"
        shape.box = {{ min = [0, 0], max = [0.5, 0.5] }}
        {motion}
        "#
    )
}

#[test]
fn a_particle_that_inverts() {
    // Linear functions with the stress updated last fold the corners of a spinning block.
    let text = scene("spin = 3").replace("cell = 0.1", "cell = 0.1\nbasis = \"linear\"");
    let text = text.replace("courant = 1", "stress_update = \"last\"");
    let mut simulation = start(&text);
    let error = loop {
        let before = simulation.time();
        if let Err(error) = simulation.step(1.0) {
            assert_eq!(simulation.time(), before, "a step that fails takes no time");
            break error;
        }
        assert!(simulation.steps() < 5000, "a particle must fold");
    };
    println!("{error}");
    let StepError::Inverted { body, number, position, time, determinant } = error else { panic!("{error}") };
    assert_eq!(body, "runaway");
    assert_eq!(time, simulation.time());
    assert!(determinant <= 0.0, "{determinant}");
    let snapshot = simulation.snapshot();
    let p = (0..snapshot.body.len()).find(|&p| snapshot.body[p] == 1 && snapshot.number[p] == number);
    let p = p.expect("the particle exists");
    assert_eq!(snapshot.position[p], position);
    // What is drawn of it takes no room.
    let undeformed = snapshot.mass[p] / 1000.0;
    assert!((snapshot.volume[p] / undeformed - determinant).abs() < 1e-12, "{}", snapshot.volume[p]);
}

/// Neo-Hookean, but under pressure at any thickness once it is turned by more than a tenth.
#[derive(Debug)]
struct Pressed;

const ELASTIC: Isotropic<f64> = Isotropic { bulk_modulus: 8e4, shear_modulus: 4e4 };

impl CustomLaw for Pressed {
    fn name(&self) -> &'static str {
        "pressed"
    }

    fn elastic(&self) -> Isotropic<f64> {
        ELASTIC
    }

    fn respond(&self, motion: &Motion<f64>, _: &mut [f64]) -> Symmetric<f64> {
        let law = NeoHookean { elastic: ELASTIC };
        if motion.deformation.0[1][0] < 0.1 { law.stress(motion) } else { Symmetric::isotropic(-1e4) }
    }

    fn strain_energy(&self, deformation: &Matrix<f64>, stress: &Symmetric<f64>, _: &[f64]) -> f64 {
        NeoHookean { elastic: ELASTIC }.strain_energy(deformation, stress, &[])
    }
}

#[test]
fn a_particle_without_a_thickness() {
    let text = scene("spin = 3").replace("plane-strain", "plane-stress");
    let mut scene = scene::parse("trial.toml", &text, &[]).unwrap_or_else(|error| panic!("{error:?}")).scene;
    scene.materials[0].law = Material::custom(&Pressed);
    let mut simulation = step::build(&scene).unwrap_or_else(|problem| panic!("{problem:?}"));
    let error = loop {
        let before = simulation.time();
        if let Err(error) = simulation.step(1.0) {
            assert_eq!(simulation.time(), before, "a step that fails takes no time");
            break error;
        }
        assert!(simulation.time() < 0.1, "the block must have turned");
    };
    println!("{error}");
    let StepError::NoThickness { body, number, position, time } = error else { panic!("{error}") };
    assert_eq!(body, "runaway");
    assert_eq!(time, simulation.time());
    let snapshot = simulation.snapshot();
    let p = (0..snapshot.body.len()).find(|&p| snapshot.body[p] == 1 && snapshot.number[p] == number);
    let p = p.expect("the particle exists");
    assert_eq!(snapshot.position[p], position);
    let turned = snapshot.deformation[p][3];
    assert!(turned > 0.05 && turned < 0.1, "{turned}");
}

#[test]
fn a_body_that_leaves_the_domain() {
    let mut simulation = start(&scene("velocity = [10, 0]"));
    let error = loop {
        if let Err(error) = simulation.step(1.0) {
            break error;
        }
        assert!(simulation.time() < 1.0, "the block must be gone");
    };
    println!("{error}");
    let StepError::Escaped { body, position, time, .. } = error else { panic!("{error}") };
    assert_eq!(body, "runaway");
    assert!(position[0] > 2.0 && position[0] < 2.1, "{position:?}");
    assert!((time - 0.15).abs() < 0.02, "{time}");
    assert_eq!(simulation.snapshot().body.len(), simulation.particles());
}

#[test]
fn prescribed_motion_that_leaves_the_domain_or_is_no_number() {
    for (velocity, escapes) in [("10 m/s", true), ("1 m/s * sqrt(0.05 - t / (1 s))", false)] {
        let mut simulation = start(&scene(&format!("rigid = {{ velocity = [\"{velocity}\", 0] }}")));
        let error = loop {
            if let Err(error) = simulation.step(0.01) {
                break error;
            }
            assert!(simulation.time() < 1.0, "the motion must fail: {velocity}");
        };
        println!("{error}");
        match error {
            StepError::Escaped { body, .. } if escapes => assert_eq!(body, "runaway"),
            StepError::NotFinite { body, position, .. } if !escapes => {
                assert_eq!(body, "runaway");
                assert!(position.iter().all(|x| x.is_finite()), "{position:?}");
            }
            other => panic!("{velocity}: {other}"),
        }
    }
}
