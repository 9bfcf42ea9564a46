//! How much memory a run takes, and whether a machine has it.

use super::bodies::FillingExtent;
use super::own_grid::OwnGrid;
use super::table::{bytes, short};
use super::warning::Warning;
use crate::geometry::Bounds;
use crate::scene::{Interior, Scene};
use crate::tensor::Vector;

/// How much there is of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodySize {
    /// Number of particles.
    pub particles: usize,
    /// Its grid, if it has one of its own.
    pub grid: Option<OwnGrid>,
}

/// What only the engine that runs a scene knows of its cost.
pub trait Footprint {
    /// Particles that a rigid body without bounds has in its pose at the start around others that fill these boxes.
    fn particles_around(&self, scene: &Scene, body: usize, boxes: &[Bounds]) -> usize;

    /// Memory of bodies of these sizes and of the grid [B].
    fn memory(&self, scene: &Scene, bodies: &[BodySize]) -> f64;

    /// Memory of the copy of the bodies that there is while a checkpoint is written [B].
    fn copy(&self, scene: &Scene, bodies: &[BodySize]) -> f64;
}

/// Particles of a rigid body without bounds around all that deform on the common grid, or 0 for one with bounds. Those
/// that are not near it count as if they had been moved straight to its surface, as they will have fallen or flown.
/// Bodies on grids of their own touch its shape, not particles.
pub(super) fn particles_near_others(
    footprint: &dyn Footprint,
    (scene, extents): (&Scene, &[FillingExtent]),
    body: usize,
) -> usize {
    if extents[body].bounds.is_finite() {
        return 0;
    }
    let is_other = |&i: &usize| !scene.bodies[i].is_rigid() && scene.interior(i) == Interior::Grid;
    let others = (0..scene.bodies.len()).filter(is_other).map(|i| extents[i].bounds);
    let boxes: Vec<_> = others.map(|bounds| at_surface(scene, body, bounds)).collect();
    footprint.particles_around(scene, body, &boxes)
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
