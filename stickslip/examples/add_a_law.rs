//! A law of our own, from outside the crate: Saint Venant-Kirchhoff elasticity that remembers how far it was
//! compressed.
//!
//! ```text
//! S = lambda tr(E) I + 2 mu E,   E = (F^T F - I) / 2,   sigma = F S F^T / J
//!    ________________  symmetry
//!   |   bar, v ->    |#
//!   |________________|#  rigid     L/c after first touch the bar stands still, compressed by v/c everywhere;
//!           L          symmetry    c^2 = (lambda + 2 mu) / rho
//! ```
//!
//! `cargo run --release --package stickslip --example add_a_law`

use std::error::Error;
use std::ops::ControlFlow;
use stickslip::column::Kind;
use stickslip::geometry::Shape;
use stickslip::march::march;
use stickslip::material::{CustomLaw, History, Isotropic, Material, Motion};
use stickslip::scene::{Body, Dimension, Domain, Face, NamedMaterial, Scene, VolumeChange};
use stickslip::step;
use stickslip::tensor::{Matrix, Symmetric};

const LENGTH: f64 = 1.0;
const HEIGHT: f64 = 0.125;
const DENSITY: f64 = 1000.0;
/// A hundredth of the wave speed.
const SPEED: f64 = 10.0;
const LAMBDA: f64 = 4e8;
const MU: f64 = 3e8;

#[derive(Debug)]
struct SaintVenantKirchhoff;

/// E = (F^T F - I) / 2
fn strain(f: &Matrix<f64>) -> Matrix<f64> {
    Matrix::from_fn(|i, j| {
        let c: f64 = (0..3).map(|k| f.0[k][i] * f.0[k][j]).sum();
        0.5 * (c - f64::from(i == j))
    })
}

impl CustomLaw for SaintVenantKirchhoff {
    fn name(&self) -> &'static str {
        "saint_venant_kirchhoff"
    }

    /// What each particle remembers. Memory, `View::column`, snapshots and `--color compression` follow.
    fn history(&self) -> &'static [History] {
        const { &[History::new("compression", "", Kind::Number)] }
    }

    fn elastic(&self) -> Isotropic<f64> {
        Isotropic { bulk_modulus: LAMBDA + 2.0 / 3.0 * MU, shear_modulus: MU }
    }

    fn respond(&self, motion: &Motion<f64>, history: &mut [f64]) -> Symmetric<f64> {
        let (f, e) = (motion.deformation, strain(&motion.deformation));
        let trace: f64 = (0..3).map(|i| e.0[i][i]).sum();
        let s = Matrix::IDENTITY * (LAMBDA * trace) + e * (2.0 * MU);
        let transposed = Matrix::from_fn(|i, j| f.0[j][i]);
        let sigma = (f * s * transposed).0.map(|row| row.map(|x| x / motion.jacobian));
        history[0] = history[0].max(1.0 - motion.jacobian);
        let [xx, yy, zz] = [0, 1, 2].map(|i| sigma[i][i]);
        Symmetric([xx, yy, zz, sigma[0][1], sigma[1][2], sigma[0][2]])
    }

    fn strain_energy(&self, deformation: &Matrix<f64>, _: &Symmetric<f64>, _: &[f64]) -> f64 {
        let e = strain(deformation);
        let trace: f64 = (0..3).map(|i| e.0[i][i]).sum();
        0.5 * LAMBDA * trace * trace + MU * e.0.iter().flatten().map(|x| x * x).sum::<f64>()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let wave_speed = ((LAMBDA + 2.0 * MU) / DENSITY).sqrt();
    let transit = LENGTH / wave_speed;
    let mut simulation = step::build(&impact(2.0 * transit)?)?;
    let mut stands = None;
    march(&mut *simulation, 2.0 * transit, |view, _| {
        if view.bodies()[0].velocity[0] > 0.0 {
            return ControlFlow::Continue(());
        }
        stands = Some(view.time() / transit);
        ControlFlow::Break(())
    })?;
    let stands = stands.ok_or("the bar never stands still")?;

    // The bar is body 0. Its column lies in the engine and is only looked at.
    let compression = simulation.column(0, "compression")?;
    let sum: f64 = compression.rows().map(|(_, [compression])| compression).sum();
    let mean = sum / compression.len() as f64 * wave_speed / SPEED;
    println!("the bar stands still {stands:.4} transits of a wave after first touch");
    println!("it was compressed by {mean:.4} v/c, the mean of its particles");
    assert!((stands - 1.0).abs() < 0.03, "{stands}");
    // The largest is remembered. Behind a front on a grid the bar swings: by up to 27 % where nothing damps it (the
    // integral of Airy's function), and less where the front is young.
    assert!((1.0..1.27).contains(&mean), "{mean}");
    Ok(())
}

/// A bar that touches a rigid wall on its right, between planes of symmetry above and below.
fn impact(end: f64) -> Result<Scene, Box<dyn Error>> {
    let cell = LENGTH / 64.0;
    let mut scene = Scene::new(Dimension::PlaneStrain, cell, end);
    let mut domain = Domain::new([-1.5 * LENGTH, 0.0, 0.0], [0.5 * LENGTH, HEIGHT, 0.0]);
    domain.faces[1] = [Face::Symmetry; 2];
    scene.domain = Some(domain);
    let law = Material::custom(&SaintVenantKirchhoff);
    let ours = scene.add_material(NamedMaterial {
        name: "ours".to_string(),
        density: DENSITY,
        law,
        volume_change: VolumeChange::Own,
        thermal_expansion: 0.0,
    });
    let bar = Body::new("bar", ours, Shape::rectangle([-LENGTH, 0.0], [0.0, HEIGHT]));
    scene.add_body(bar.moving([SPEED, 0.0, 0.0], [0.0; 3]));
    let wall = Body::new("wall", ours, Shape::rectangle([0.0, 0.0], [4.0 * cell, HEIGHT]));
    scene.add_body(wall.rigid([0.0; 3], [0.0; 3]));
    Ok(scene)
}
