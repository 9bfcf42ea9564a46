//! Scenes written in the tests, and how they are run.

use rayon::ThreadPoolBuilder;
use std::ops::ControlFlow;
use stickslip::door::{ParticleSnapshot, Simulation};
use stickslip::march::march;
use stickslip::step::ParticleLoop;
use stickslip::{scene, step};

/// Every stress update by its word in scene files.
pub const STRESS_UPDATES: [&str; 3] = ["first", "last", "modified-last"];

/// Rubber in scenes.
pub const RUBBER: &str =
    "materials.rubber = { density = 1000, neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 } }";

/// The simulation of a scene.
pub fn start(text: &str) -> Box<dyn Simulation> {
    start_in(std::path::Path::new(""), text)
}

/// The simulation of a scene that lies in a folder.
pub fn start_in(folder: &std::path::Path, text: &str) -> Box<dyn Simulation> {
    let name = folder.join("trial.toml").display().to_string();
    let loaded = scene::parse(&name, text, &[]).unwrap_or_else(|error| panic!("{error:?}\n{text}"));
    step::build(&loaded.scene).unwrap_or_else(|problem| panic!("{problem:?}\n{text}"))
}

/// The simulation of a scene on a path.
pub fn start_on(text: &str, path: ParticleLoop) -> Box<dyn Simulation> {
    let loaded = scene::parse("trial.toml", text, &[]).unwrap_or_else(|error| panic!("{error:?}\n{text}"));
    step::build_on(&loaded.scene, path).unwrap_or_else(|problem| panic!("{problem:?}\n{text}"))
}

/// Takes `count` steps of the stable length.
pub fn take_steps(simulation: &mut dyn Simulation, count: usize) {
    for _ in 0..count {
        simulation.step(f64::INFINITY).expect("the trial is sound");
    }
}

/// Steps to a time, and looks at the simulation after each step.
pub fn run_to(simulation: &mut dyn Simulation, end: f64, mut look: impl FnMut(&mut dyn Simulation)) {
    let seen = march(simulation, end, |simulation, _| {
        look(simulation);
        ControlFlow::Continue(())
    });
    seen.expect("the trial is sound");
}

/// Mean of a quantity over the particles that a filter takes.
pub fn mean_where(
    snapshot: &ParticleSnapshot,
    takes: impl Fn(usize) -> bool,
    quantity: impl Fn(usize) -> f64,
) -> f64 {
    let taken: Vec<usize> = (0..snapshot.body.len()).filter(|&p| takes(p)).collect();
    assert!(!taken.is_empty(), "no particle to average over");
    taken.iter().map(|&p| quantity(p)).sum::<f64>() / taken.len() as f64
}

/// Largest difference between two lists of vectors, any component.
pub fn largest_difference<const N: usize>(a: &[[f64; N]], b: &[[f64; N]]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().flatten().zip(b.iter().flatten()).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

/// |a - b| of vectors.
pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

/// |a| of a vector.
pub fn norm(a: [f64; 3]) -> f64 {
    distance(a, [0.0; 3])
}

/// Holds a scene in which bodies slide to the same bits after so many steps on one thread and on these numbers of them,
/// and after its state was saved, restored and taken back, with lists made anew.
pub fn same_bits(text: &str, steps: usize, threads: [usize; 2]) {
    let outcome = |threads: usize, restore: bool| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
        pool.install(|| {
            let mut simulation = start(text);
            for step in 0..steps {
                if restore && step % 20 == 7 {
                    let saved = simulation.save().expect("it can be saved");
                    take_steps(&mut *simulation, 3);
                    simulation.restore(saved).expect("it is its own state");
                    simulation.hold();
                    take_steps(&mut *simulation, 2);
                    assert!(simulation.take_back());
                    simulation.rebuild_workspace();
                }
                take_steps(&mut *simulation, 1);
            }
            assert!(simulation.ledger().friction > 0.0, "they slide");
            let points = simulation.contact_points();
            format!(
                "{:?} {:?} {:?} {points:?}",
                simulation.snapshot(),
                simulation.ledger(),
                simulation.bodies()
            )
        })
    };
    let one = outcome(1, false);
    for (threads, restore) in [(threads[0], false), (threads[1], false), (1, true)] {
        assert!(outcome(threads, restore) == one, "{threads} threads, resumed: {restore}\n{text}");
    }
}
