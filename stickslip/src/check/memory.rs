//! How much memory a run takes, and whether a machine has it.

use super::bodies::Extent;
use super::per_side;
use super::rules::is_rigid;
use super::table::{bytes, short};
use super::warning::Warning;
use crate::engine::particles_around;
use crate::geometry::Bounds;
use crate::grid::Node;
use crate::particles::Particles;
use crate::scene::{Precision, Scene};
use crate::tensor::{Real, Vector};

/// Each particle's place in the order of blocks and cells, of which there are two: one while the next is made [bytes].
const ORDER_BYTES: usize = 2 * size_of::<u32>();
/// Nodes per cell that particles fill: blocks are covered whole, with those that a body's rim reaches.
const NODES_PER_CELL: f64 = 4.0;

/// Particles of a rigid body without bounds around all deformable bodies, or 0 for one with bounds. Those that are not
/// near it count as if they had been moved straight to its surface, as they will have fallen or flown.
pub(super) fn particles_near_others(scene: &Scene, extents: &[Extent], body: usize) -> usize {
    if extents[body].bounds.is_finite() {
        return 0;
    }
    let others = (0..scene.bodies.len()).filter(|&i| !is_rigid(scene, i)).map(|i| extents[i].bounds);
    let boxes: Vec<_> = others.map(|bounds| at_surface(scene, body, bounds)).collect();
    particles_around(scene, body, &boxes)
}

/// A box, moved to a body's surface if it is before it.
fn at_surface(scene: &Scene, body: usize, bounds: Bounds) -> Bounds {
    let axes = scene.dimension.axes();
    let levels = bounds.corners().map(|corner| scene.bodies[body].shape.level(corner, axes));
    let nearest = levels.min_by(|a, b| a.distance.total_cmp(&b.distance)).expect("a box has corners");
    let way = Vector(nearest.gradient) * -nearest.distance.max(0.0);
    let moved = |point: [f64; 3]| (Vector(point) + way).0;
    Bounds { min: moved(bounds.min), max: moved(bounds.max) }
}

/// Memory of particles and grid [bytes]; `particles` counts those of each body.
pub(super) fn estimate(scene: &Scene, particles: &[usize]) -> f64 {
    match (scene.dimension.axes(), scene.precision) {
        (2, Precision::Double) => of::<f64, 2>(scene, particles),
        (2, Precision::Single) => of::<f32, 2>(scene, particles),
        (_, Precision::Double) => of::<f64, 3>(scene, particles),
        (_, Precision::Single) => of::<f32, 3>(scene, particles),
    }
}

fn of<T: Real, const D: usize>(scene: &Scene, particles: &[usize]) -> f64 {
    let node = size_of::<Node<T, D>>() as f64;
    let of_body = |(i, &count): (usize, &usize)| {
        let body = &scene.bodies[i];
        let flow = !is_rigid(scene, i) && scene.materials[body.material].law.flows();
        let per_cell = per_side(scene, body).powi(D as i32);
        let themselves = Particles::<T, D>::bytes_of(count, flow) + ORDER_BYTES * count;
        themselves as f64 + node * NODES_PER_CELL * count as f64 / per_cell
    };
    particles.iter().enumerate().map(of_body).sum()
}

/// What to say where a run needs more than there is [bytes].
pub(super) fn warning(needed: f64, available: f64, cell: f64, axes: usize) -> Option<Warning> {
    (needed > available).then(|| {
        // Rounded up to three digits, as particles follow the cell's size by its power.
        let fits = 1.05 * cell * (needed / available).powf(1.0 / axes as f64);
        Warning::about(
            "space.cell",
            format!(
                "the run needs about {}, and this machine has {} to give: it would be killed, \
                 or take for ever; cells of {} m would fit",
                bytes(needed),
                bytes(available),
                short(fits)
            ),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::bodies::measure;
    use crate::check::tests::{at_rest, free, scene};
    use crate::geometry::Shape;
    use crate::scene::{Dimension, Motion};

    /// Surfaces between nodes, as they are once bodies have moved.
    fn floor() -> crate::scene::Body {
        at_rest("floor", Shape::HalfSpace { point: [0.0, 0.0, -0.03], normal: [0.0, 0.0, 1.0] })
    }

    fn block(height: f64) -> crate::scene::Body {
        let [min, max] = [[-0.03, -0.03, height], [1.97, 1.97, height + 1.0]];
        free("block", 0, Shape::Box { min, max })
    }

    fn estimated(bodies: Vec<crate::scene::Body>) -> usize {
        let scene = scene(Dimension::Space, 0.1, bodies);
        let extents = measure(&scene).expect("filled");
        (0..scene.bodies.len()).map(|body| particles_near_others(&scene, &extents, body)).sum()
    }

    /// What the engine fills around a block at rest, within a fifth; as many where the block is above the floor yet.
    #[test]
    fn a_floor_without_bounds_counts_with_what_the_run_will_have() {
        let mut scene = scene(Dimension::Space, 0.1, vec![block(-0.03), floor()]);
        let mut simulation = crate::engine::build(&scene).expect("no problem");
        simulation.step(1e-6).expect("a step");
        let particles = simulation.particles() - 8 * 20 * 20 * 10;
        let found = estimated(scene.bodies.clone());
        assert!((found as f64 / particles as f64 - 1.0).abs() < 0.2, "{found} of {particles}");
        let above = estimated(vec![block(2.97), floor()]);
        assert!((above as f64 / found as f64 - 1.0).abs() < 0.2, "{above} {found}");
        scene.bodies[0].motion = Motion::Rigid {
            velocity: [0.0; 3].map(crate::scene::Expression::Constant),
            spin: [0.0; 3].map(crate::scene::Expression::Constant),
        };
        assert_eq!(estimated(scene.bodies), 0);
    }

    #[test]
    fn a_run_that_does_not_fit_is_told_cells_that_do() {
        assert_eq!(warning(1e9, 2e9, 0.1, 3), None);
        let text = warning(68e9, 23e9, 0.1, 3).expect("too large").to_string();
        assert!(
            text.starts_with("space.cell: the run needs about 68.0 GB, and this machine has 23.0 GB"),
            "{text}"
        );
        assert!(text.contains("cells of 0.1507 m"), "{text}");
    }
}
