//! Periodic faces: everything is there again a period further.

use super::{Domain, Face, Scene};

/// A period is a multiple of so many cells: the grid comes in blocks of them.
pub const PERIOD_STEP: usize = 4;

/// Cells of the shortest period: a particle must not reach a node from both sides.
pub const SHORTEST_PERIOD: usize = 2 * PERIOD_STEP;

/// A body is as long as the period, and so without end, within this share of a cell.
const AS_LONG: f64 = 1e-6;

impl Domain {
    /// Whether the faces across an axis are periodic.
    pub fn is_periodic(&self, axis: usize) -> bool {
        self.faces[axis] == [Face::Periodic; 2]
    }

    /// After which length everything repeats along each axis [m]; 0 where nothing does.
    pub fn periods(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| if self.is_periodic(k) { self.max[k] - self.min[k] } else { 0.0 })
    }

    /// The image of a place that is nearest to another place along each axis [m].
    pub fn image_near(&self, place: [f64; 3], to: [f64; 3]) -> [f64; 3] {
        let periods = self.periods();
        std::array::from_fn(|k| match periods[k] {
            0.0 => place[k],
            period => place[k] - period * ((place[k] - to[k]) / period).round(),
        })
    }
}

impl Scene {
    /// After which length everything repeats along each axis [m]; 0 where nothing does.
    pub fn periods(&self) -> [f64; 3] {
        self.domain.as_ref().map_or([0.0; 3], Domain::periods)
    }

    /// Along each axis the two ends of a body that is as long as the period [m]: it is joined to its own images there.
    pub fn joined_ends(&self, body: usize) -> [Option<[f64; 2]>; 3] {
        let axes = self.dimension.axes();
        let Some(bounds) = self.bodies[body].shape.bounds(axes) else { return [None; 3] };
        let periods = self.periods();
        let ends = |k: usize| {
            let (length, slack) = (bounds.max[k] - bounds.min[k], AS_LONG * self.discretization.cell);
            (periods[k] > 0.0 && (length - periods[k]).abs() <= slack)
                .then_some([bounds.min[k], bounds.max[k]])
        };
        [0, 1, 2].map(ends)
    }
}
