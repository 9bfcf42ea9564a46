//! A scene in code: a disk on a slope rolls where friction holds it and slips where it does not.
//!
//! ```text
//!      ___
//!     /   \  R                mu >= tan(slope)/3:  a = 2/3 g sin(slope)                 it rolls
//!     \___/                   below:               a = g (sin(slope) - mu cos(slope))   it slips
//!   =========  rigid, mu      both of a rigid disk; the rubber one follows within 2 %
//! ```
//!
//! The axes are turned with the slope: x is down it, and gravity leans.
//!
//! `cargo run --release --package stickslip --example build_a_scene`

use std::error::Error;
use std::ops::ControlFlow;
use stickslip::door::{NoColumn, View};
use stickslip::geometry::Shape;
use stickslip::march::march;
use stickslip::scene::{Body, ContactRule, Dimension, NamedMaterial, Scene};
use stickslip::step;

const GRAVITY: f64 = 9.81;
const SLOPE: f64 = std::f64::consts::FRAC_PI_6;
const RADIUS: f64 = 0.5;
const END: f64 = 1.0;

fn main() -> Result<(), Box<dyn Error>> {
    let rolls = 2.0 / 3.0 * GRAVITY * SLOPE.sin();
    let slips = GRAVITY * (SLOPE.sin() - 0.1 * SLOPE.cos());
    for (friction, exact) in [(0.5, rolls), (0.1, slips)] {
        let mut simulation = step::build(&slope(friction)?)?;
        // After each step there is a look at the simulation; here it only goes on.
        march(&mut *simulation, END, |_, _| ControlFlow::Continue(()))?;
        let disk = &simulation.bodies()[0];
        let acceleration = disk.velocity[0] / simulation.time();
        let top = speed_of_top(&*simulation)? / disk.velocity[0];
        println!(
            "friction {friction}: acceleration {acceleration:.3} m/s^2, that of a rigid disk {exact:.3} m/s^2"
        );
        println!("  the top is {top:.3} times as fast as the centre");

        assert!((acceleration / exact - 1.0).abs() < 0.02, "{acceleration} {exact}");
        // A rolling disk turns about the point on which it stands.
        assert_eq!((top - 2.0).abs() < 0.1, friction == 0.5, "{top}");
    }
    Ok(())
}

/// A disk of soft rubber at rest on a rigid slope; what is not said here is as in a scene file that does not say it.
fn slope(friction: f64) -> Result<Scene, Box<dyn Error>> {
    let mut scene = Scene::new(Dimension::PlaneStrain, RADIUS / 8.0, END);
    scene.gravity = [GRAVITY * SLOPE.sin(), -GRAVITY * SLOPE.cos(), 0.0].into();
    let moduli = [("young_modulus", 1e6), ("poisson_ratio", 0.3)];
    let rubber = scene.add_material(NamedMaterial::new("rubber", 1000.0, "neo_hookean", &moduli)?);
    scene.add_body(Body::new("disk", rubber, Shape::disk([0.0, RADIUS], RADIUS)).fitted());
    let below = Shape::half_space([0.0; 3], [0.0, 1.0, 0.0]);
    scene.add_body(Body::new("slope", rubber, below).rigid([0.0; 3], [0.0; 3]));
    scene.contact = vec![ContactRule::default().with_friction(friction)];
    Ok(scene)
}

/// Velocity down the slope of the disk's highest particle [m/s]. The disk is body 0; all columns of a body have its
/// particles in the same order.
fn speed_of_top(view: &dyn View) -> Result<f64, NoColumn> {
    let (position, velocity) = (view.column(0, "position")?, view.column(0, "velocity")?);
    let heights = position.rows().map(|(_, [_, y, _])| y);
    let speeds = velocity.rows().map(|(_, [vx, _, _])| vx);
    let top = heights.zip(speeds).max_by(|(a, _), (b, _)| a.total_cmp(b));
    Ok(top.map_or(0.0, |(_, speed)| speed))
}
