//! The verb that books reactions of the domain's faces, where the scene asks for them.

use super::Engine;
use crate::boundary::Wall;
use crate::exact::ExactSum;
use crate::grid::{Lattice, nodes_per_block};
use crate::lanes::Laned;
use crate::tensor::{Real, Vector, cross};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Impulse and moment of pairs of a face and a body in a step, by their place in [`super::state::State::walls`].
pub type WallBooks = BTreeMap<usize, [ExactSum; 6]>;

/// What a body did to a face of the domain since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WallSums {
    /// Impulse on the face [N s].
    pub impulse: [f64; 3],
    /// Its moment about the middle of the face [N m s].
    pub moment: [f64; 3],
}

/// The middle of a face of the domain between these corners [m].
pub(super) fn middle<T: Real, const D: usize>(
    wall: &Wall,
    lattice: &Lattice<T, D>,
    [min, max]: [Vector<T, D>; 2],
) -> [f64; 3] {
    let mut middle = ((min + max) * T::HALF).space();
    middle[wall.axis] = lattice.position([wall.node; D])[wall.axis].f64();
    middle
}

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Books what bodies did to the faces of the domain in the step.
    pub(super) fn account_walls(&mut self, dt: T) {
        let bodies = self.state.bodies.len();
        let (Some(corners), false) = (self.settings.domain, self.state.walls.is_empty()) else { return };
        let (lattice, walls) = (&self.settings.lattice, &self.settings.walls);
        let position =
            |place: [i32; 3]| Vector(lattice.position(std::array::from_fn::<_, D, _>(|i| place[i])).space());
        let workspace = &mut self.workspace;
        let (all, active, n) = (&self.state.bodies, &workspace.active, nodes_per_block(D));
        let booked = &mut workspace.wall_sums;
        *booked = std::mem::take(&mut workspace.reference_walls);
        workspace.boundary.book(&workspace.field, dt, |node, impulse| {
            let (_, block) = active.slots[node.index / n];
            if all[node.body as usize].is_rigid() || !active.books(block) {
                return;
            }
            let middle = middle(&walls[node.wall], lattice, corners);
            let moment = cross((position(node.place) - Vector(middle)).0, impulse);
            let sums = booked.entry(node.wall * bodies + node.body as usize).or_default();
            sums.iter_mut().zip(impulse.into_iter().chain(moment)).for_each(|(sum, x)| sum.add(-x));
        });
        if let Some(among) = &self.among {
            among.gather_walls(booked);
        }
        for (&place, booked) in &*booked {
            let WallSums { impulse, moment } = &mut self.state.walls[place];
            let sums = impulse.iter_mut().chain(moment);
            sums.zip(booked).for_each(|(sum, booked)| *sum += booked.value());
        }
    }
}
