//! The verb that books reactions of the domain's faces, where the scene asks for them.

use super::Engine;
use crate::basis::Basis;
use crate::lanes::Laned;
use crate::tensor::{Vector, cross};
use serde::{Deserialize, Serialize};

/// What a body did to a face of the domain since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WallSums {
    /// Impulse on the face [N s].
    pub impulse: [f64; 3],
    /// Its moment about the middle of the face [N m s].
    pub moment: [f64; 3],
}

impl<T: Laned, const D: usize, B: Basis<T>> Engine<T, D, B> {
    /// Books what bodies did to the faces of the domain in the step.
    pub(super) fn account_walls(&mut self, dt: T) {
        let (sums, bodies) = (&mut self.state.walls, self.state.bodies.len());
        let (Some([min, max]), false) = (self.settings.domain, sums.is_empty()) else { return };
        let (lattice, walls) = (&self.settings.lattice, &self.settings.walls);
        let position =
            |place: [i32; 3]| Vector(lattice.position(std::array::from_fn::<_, D, _>(|i| place[i])).space());
        let workspace = &mut self.workspace;
        let all = &self.state.bodies;
        workspace.boundary.book(&workspace.field, dt, |node, impulse| {
            if all[node.body as usize].is_rigid() {
                return;
            }
            let wall = &walls[node.wall];
            let mut middle = ((min + max) * T::HALF).space();
            let mut face = node.place;
            face[wall.axis] = wall.node;
            middle[wall.axis] = position(face).0[wall.axis];
            let moment = cross((position(node.place) - Vector(middle)).0, impulse);
            let sums = &mut sums[node.wall * bodies + node.body as usize];
            for i in 0..3 {
                sums.impulse[i] -= impulse[i];
                sums.moment[i] -= moment[i];
            }
        });
    }
}
