//! The paper's scenes with disks, run for some transits of a longitudinal wave through a disk.

use std::path::Path;
use stickslip::engine;
use stickslip::scene::{self, Parameter, Scene};

/// What happened to the disks.
#[derive(Debug)]
pub struct Chain {
    /// Momentum of the disks less the impulses of the striker and the frame, over the largest of these [-].
    pub momentum: f64,
    /// Energy of the disks less the striker's work, over that work [-].
    pub energy: f64,
}

impl Chain {
    /// Runs a scene with overrides, written as `stickslip run --set` takes them, to a time [transits].
    pub fn run(name: &str, overrides: &[(&str, &str)], cells: (&str, &str), transits: f64) -> Chain {
        let overrides: Vec<_> = overrides.iter().copied().chain([cells]).collect();
        let scene = load(name, &overrides);
        let chain = Chain::of(&scene, transits * number(&scene, "transit"));
        println!("{name} {overrides:?}: {chain:.4?}");
        chain
    }

    fn of(scene: &Scene, end: f64) -> Chain {
        let mut simulation = engine::build(scene).unwrap_or_else(|error| panic!("{error:?}"));
        let deformable = |body: usize| scene.bodies[body].name.starts_with("disk");
        let mut impulse = [0.0; 2];
        let mut pushed = 0.0_f64;
        simulation.take_contacts();
        while simulation.time() < end * (1.0 - 1e-12) {
            let start = simulation.time();
            simulation.step(end - start).unwrap_or_else(|error| panic!("{error}"));
            let dt = simulation.time() - start;
            for contact in simulation.take_contacts() {
                let (a, b) = (contact.body_a, contact.body_b);
                if deformable(a) != deformable(b) {
                    let sign = if deformable(a) { -dt } else { dt };
                    (0..2).for_each(|i| impulse[i] += sign * contact.force[i]);
                    pushed = pushed.max(impulse[0].abs());
                }
            }
        }
        let ledger = simulation.ledger();
        let missing = (0..2).map(|i| (ledger.momentum[i] - impulse[i]).abs()).fold(0.0, f64::max);
        Chain { momentum: missing / pushed, energy: ledger.total / ledger.external_work }
    }
}

fn load(name: &str, overrides: &[(&str, &str)]) -> Scene {
    let path =
        Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/paper")).join(format!("disks_{name}.toml"));
    let overrides: Vec<_> =
        overrides.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    scene::load(&path, &overrides).unwrap_or_else(|error| panic!("{error}")).scene
}

fn number(scene: &Scene, name: &str) -> f64 {
    match scene.parameters[name] {
        Parameter::Number(value) => value,
        Parameter::Text(_) => panic!("{name} is a number"),
    }
}
