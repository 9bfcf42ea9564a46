//! An observer of our own, asked after every step of a run: a bar hits a wall and comes to rest, all at once.
//!
//! ```text
//!    ________________  symmetry
//!   |   bar, v ->    |#
//!   |________________|#  rigid     L/c after first touch the wave from the wall has stopped all of the bar:
//!           L          symmetry    its kinetic energy, m v^2/2, is strain energy
//! ```
//!
//! c is the speed of a longitudinal wave, sqrt(M/rho), for symmetry keeps the bar from bulging.
//!
//! `cargo run --release --package stickslip --example add_an_observer`

use std::error::Error;
use stickslip::door::View;
use stickslip::geometry::Shape;
use stickslip::observe::{Observer, OutputError};
use stickslip::run::{RunOptions, run_with};
use stickslip::scene::{Body, Dimension, Domain, Face, NamedMaterial, Scene};
use stickslip::step;

const LENGTH: f64 = 1.0;
const HEIGHT: f64 = 0.125;
const DENSITY: f64 = 1000.0;
const WAVE_MODULUS: f64 = 1e9;
/// A hundredth of the wave speed.
const SPEED: f64 = 10.0;

/// The largest strain energy of a run, and when it was.
#[derive(Default)]
struct Peak {
    energy: f64,
    time: f64,
}

impl Observer for Peak {
    /// Always due: asked after every step.
    fn next(&self) -> f64 {
        0.0
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let energy = view.ledger().strain;
        if energy > self.energy {
            *self = Peak { energy, time: view.time() };
        }
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let transit = LENGTH / (WAVE_MODULUS / DENSITY).sqrt();
    let scene = impact(2.0 * transit)?;
    let mut simulation = step::build(&scene)?;
    let kinetic = simulation.ledger().kinetic;

    // The run writes its tables and snapshots as always; our observer is asked beside them.
    let results = std::env::temp_dir().join("stickslip_add_an_observer.results");
    let mut peak = Peak::default();
    run_with(&scene, &mut *simulation, &RunOptions::new(results), &mut [&mut peak], &mut |_| {})?;

    println!("largest strain energy: {:.4} of the kinetic energy before", peak.energy / kinetic);
    println!("reached {:.4} transits of a wave after first touch", peak.time / transit);
    assert!((peak.energy / kinetic - 1.0).abs() < 0.05, "{} {kinetic}", peak.energy);
    assert!((peak.time / transit - 1.0).abs() < 0.05, "{} {transit}", peak.time);
    Ok(())
}

/// A bar that touches a rigid wall on its right, between planes of symmetry above and below.
fn impact(end: f64) -> Result<Scene, Box<dyn Error>> {
    let cell = LENGTH / 64.0;
    let mut scene = Scene::new(Dimension::PlaneStrain, cell, end);
    let mut domain = Domain::new([-1.5 * LENGTH, 0.0, 0.0], [0.5 * LENGTH, HEIGHT, 0.0]);
    domain.faces[1] = [Face::Symmetry; 2];
    scene.domain = Some(domain);
    let moduli = [("p_wave_modulus", WAVE_MODULUS), ("poisson_ratio", 0.3)];
    let plastic = scene.add_material(NamedMaterial::new("plastic", DENSITY, "neo_hookean", &moduli)?);
    let bar = Body::new("bar", plastic, Shape::rectangle([-LENGTH, 0.0], [0.0, HEIGHT]));
    scene.add_body(bar.moving([SPEED, 0.0, 0.0], [0.0; 3]));
    let wall = Body::new("wall", plastic, Shape::rectangle([0.0, 0.0], [4.0 * cell, HEIGHT]));
    scene.add_body(wall.rigid([0.0; 3], [0.0; 3]));
    Ok(scene)
}
