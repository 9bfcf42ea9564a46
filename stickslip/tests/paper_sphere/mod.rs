//! The paper's scenes with a sphere, run to their end and held against the rigid solution that they state.

use std::path::Path;
use stickslip::scene::{self, Scene};
use stickslip::step;

/// What a sphere did in a scene.
#[derive(Debug)]
pub struct Roll {
    /// Distance at the end over that of the rigid sphere [-].
    pub distance: f64,
    /// Speed at the end over that of the rigid sphere [-].
    pub speed: f64,
    /// Spin times radius over speed at the end: 1 rolls, less slides forward [-].
    pub rolling: f64,
    /// Mean height of the centre of mass above the plane's undeformed surface in the last four fifths of the run [m].
    pub height: f64,
    /// Energy gained from nowhere until the end over the kinetic energy then [-].
    pub gain: f64,
}

/// Part of the run in which the sphere settles on the plane: its height counts from here on.
const SETTLING: f64 = 0.2;

/// Remainder of the run that is rounding and not time to be simulated [s].
const ROUNDING: f64 = 1e-12;

impl Roll {
    /// Runs a scene of the paper with these overrides, written as `stickslip run --set` takes them.
    pub fn down(name: &str, overrides: &[(&str, &str)]) -> Roll {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/paper")).join(name);
        let overrides: Vec<_> =
            overrides.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
        let scene = scene::load(&path, &overrides).unwrap_or_else(|error| panic!("{error}")).scene;
        let roll = Roll::of(&scene);
        println!("{name} {overrides:?}: {roll:.4?}");
        roll
    }

    fn of(scene: &Scene) -> Roll {
        let mut simulation = step::build(scene).unwrap_or_else(|error| panic!("{error:?}"));
        let sphere = scene.bodies.iter().position(|body| body.name == "sphere").unwrap();
        let end = scene.time.end;
        let energy = simulation.ledger().total;
        let (mut height, mut duration) = (0.0, 0.0);
        while end - simulation.time() > ROUNDING {
            let start = simulation.time();
            simulation.step(end - start).unwrap_or_else(|error| panic!("{error}"));
            if start > SETTLING * end {
                let dt = simulation.time() - start;
                height += simulation.bodies()[sphere].position[2] * dt;
                duration += dt;
            }
        }
        let state = &simulation.bodies()[sphere];
        let radius = scene.parameters["radius"].number().expect("a radius is a number");
        let ledger = simulation.ledger();
        Roll {
            distance: state.position[0] / reference(scene, "x"),
            speed: state.velocity[0] / reference(scene, "vx"),
            rolling: state.spin[1] * radius / state.velocity[0],
            height: height / duration,
            gain: (ledger.total - energy) / ledger.kinetic,
        }
    }
}

/// What the rigid sphere has reached at the end.
fn reference(scene: &Scene, quantity: &str) -> f64 {
    let stated = |reference: &&scene::Reference| reference.body == "sphere" && reference.quantity == quantity;
    scene.references.iter().find(stated).unwrap().value.at(scene.time.end)
}
