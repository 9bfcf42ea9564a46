//! What a scene costs in memory.

use crate::check::Footprint;
use crate::geometry::Bounds;
use crate::grid::Node;
use crate::particles::Particles;
use crate::scene::{Precision, Scene};
use crate::step::{heated_bodies, own_columns, particles_around};
use crate::tensor::Real;

/// Each particle's place in the order of blocks and cells, of which there are two: one while the next is made [bytes].
const ORDER_BYTES: usize = 2 * size_of::<u32>();
/// Nodes per cell that particles fill: blocks are covered whole, with those that a body's rim reaches.
const NODES_PER_CELL: f64 = 4.0;

/// What this engine takes.
#[derive(Clone, Copy, Debug)]
pub struct OfEngine;

impl Footprint for OfEngine {
    fn particles_around(&self, scene: &Scene, body: usize, boxes: &[Bounds]) -> usize {
        particles_around(scene, body, boxes)
    }

    fn memory(&self, scene: &Scene, particles: &[usize]) -> f64 {
        let [held, grid] = cost(scene, particles);
        // With the copy of the state before each step, where steps may be taken again.
        let copies = if scene.health.retries > 0 { 2.0 } else { 1.0 };
        copies * held + grid + (ORDER_BYTES * particles.iter().sum::<usize>()) as f64
    }

    fn copy(&self, scene: &Scene, particles: &[usize]) -> f64 {
        cost(scene, particles)[0]
    }
}

fn cost(scene: &Scene, particles: &[usize]) -> [f64; 2] {
    match (scene.dimension.axes(), scene.precision) {
        (2, Precision::Double) => cost_of::<f64, 2>(scene, particles),
        (2, Precision::Single) => cost_of::<f32, 2>(scene, particles),
        (_, Precision::Double) => cost_of::<f64, 3>(scene, particles),
        (_, Precision::Single) => cost_of::<f32, 3>(scene, particles),
    }
}

/// Bytes of the particles, and of the nodes around them.
fn cost_of<T: Real, const D: usize>(scene: &Scene, particles: &[usize]) -> [f64; 2] {
    let node = size_of::<Node<T, D>>() as f64;
    let heated = heated_bodies(scene);
    let of_body = |(number, (body, &count)): (usize, (&crate::scene::Body, &usize))| {
        let own = own_columns(scene, body, heated.contains(&number));
        let per_cell = (scene.discretization.cell / scene.lattice(body).spacing).powi(D as i32);
        let themselves = Particles::<T, D>::bytes_of(count, own) as f64;
        [themselves, node * NODES_PER_CELL * count as f64 / per_cell]
    };
    let of_bodies = scene.bodies.iter().zip(particles).enumerate().map(of_body);
    of_bodies.fold([0.0; 2], |[held, grid], [more, nodes]| [held + more, grid + nodes])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::report;

    /// A block with its lower face at a height above a floor without bounds; surfaces between nodes, as they are once
    /// bodies have moved.
    fn scene(block: &str, height: f64) -> Scene {
        let text = format!(
            r#"
            space = {{ dimension = "3d", interior = "grid", cell = 0.1 }}
            time.end = 1
            materials.rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1e6, poisson_ratio = 0.3 }} }}
            [[bodies]]
            name = "block"
            material = "rubber"
            {block}
            shape.box = {{ min = [-0.03, -0.03, {height}], max = [1.97, 1.97, {top}] }}
            [[bodies]]
            name = "floor"
            material = "rubber"
            rigid = {{}}
            shape.half_space = {{ point = [0, 0, -0.03], normal = [0, 0, 1] }}
            "#,
            top = height + 1.0
        );
        crate::scene::parse("block.toml", &text, &[]).unwrap_or_else(|e| panic!("{e:?}")).scene
    }

    fn of_floor(scene: &Scene) -> usize {
        report(scene, &OfEngine).expect("no problem").bodies[1].particles
    }

    /// What the engine fills around a block at rest, within a fifth; as many where the block is above the floor yet.
    #[test]
    fn a_floor_without_bounds_counts_with_what_the_run_will_have() {
        let resting = scene("", -0.03);
        let mut simulation = crate::step::build(&resting).expect("no problem");
        simulation.step(1e-6).expect("a step");
        let particles = simulation.particles() - 8 * 20 * 20 * 10;
        let found = of_floor(&resting);
        assert!((found as f64 / particles as f64 - 1.0).abs() < 0.2, "{found} of {particles}");
        let above = of_floor(&scene("", 2.97));
        assert!((above as f64 / found as f64 - 1.0).abs() < 0.2, "{above} {found}");
        assert_eq!(of_floor(&scene("rigid = {}", 2.97)), 0);
    }

    /// At least what the particles hold: 30 columns of 8 bytes, and numbers.
    #[test]
    fn the_memory_is_at_least_that_of_the_particles() {
        let report = report(&scene("", 2.97), &OfEngine).expect("no problem");
        let each = report.memory / report.particles as f64;
        assert!((30.0 * 8.0 + 4.0 * 4.0..400.0).contains(&each), "{each}");
    }

    /// The copy in a checkpoint takes what is saved, and not much more.
    #[test]
    fn the_copy_for_a_checkpoint_is_what_is_saved() {
        let scene = scene("", 2.97);
        let saved = crate::step::build(&scene).expect("no problem").save().expect("it can be saved");
        let block = &saved.bodies[0];
        let bytes =
            block.columns.iter().map(|column| column.bytes.len()).sum::<usize>() + 4 * block.numbers.len();
        let share = OfEngine.copy(&scene, &[block.numbers.len(), 0]) / bytes as f64;
        assert!((1.0..1.1).contains(&share), "{share}");
    }
}
