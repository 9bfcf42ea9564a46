//! Particles that have left the domain, where the scene goes on without them.

use super::Engine;
use crate::body::Totals;
use crate::door::RemovedParticles;
use crate::grid::SIDE;
use crate::lanes::Laned;
use crate::particles::ColumnStart;
use crate::scene::Leaving;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::PoisonError;

/// Steps from one removal to the next: to take particles out costs about as much as to sort the body. Those that are
/// outside meanwhile, by a few cells at most, behave as if the domain ended there.
const EVERY: u64 = 10;
/// A particle moves by less in a step [cells].
const MARGIN: i32 = 2;

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Whether deformable bodies go on without particles that leave the domain.
    pub(super) fn removes_leavers(&self) -> bool {
        self.settings.domain.is_some() && self.settings.leaving == Leaving::Remove
    }

    /// Takes out the particles of deformable bodies that are outside the domain, and books what goes with them.
    pub(super) fn remove_leavers(&mut self) {
        if !self.removes_leavers() || !self.state.steps.is_multiple_of(EVERY) {
            return;
        }
        let outside = self.bodies_here().map(|body| (body, self.outside(body)));
        let outside: BTreeMap<usize, Vec<u32>> = outside.filter(|(_, outside)| !outside.is_empty()).collect();
        let gone = outside.iter().map(|(&body, outside)| self.first_of(body, outside));
        let gone: Vec<Gone> = gone.collect();
        let mut gone = match &self.among {
            Some(among) => among.gathered(&gone).concat(),
            None => gone,
        };
        // The same of all orders in memory, and whichever rank has them.
        gone.sort_unstable_by_key(|gone| (gone.body, gone.number));
        for of_body in gone.chunk_by(|a, b| a.body == b.body) {
            let count = of_body.iter().map(|gone| gone.count).sum();
            let here = outside.get(&of_body[0].body).map_or(&[][..], Vec::as_slice);
            self.remove((of_body[0].body, here), (count, of_body[0].place));
        }
    }

    /// What of a body is outside, and which of that is the first by number.
    fn first_of(&self, body: usize, outside: &[u32]) -> Gone {
        let particles = outside.iter().map(|&p| self.state.bodies[body].particles.get(p as usize));
        let first = particles.min_by_key(|particle| particle.number).expect("some are outside");
        let (number, place) = (first.number, first.position.space());
        Gone { body, count: outside.len() as u64, number, place }
    }

    /// The particles of a deformable body that are outside the domain, by their places in memory, ascending. Only tiles
    /// at the domain's faces are looked at.
    fn outside(&self, body: usize) -> Vec<u32> {
        let mut found = Vec::new();
        let Some([min, max]) = self.settings.held.filter(|_| !self.state.bodies[body].is_rigid()) else {
            return found;
        };
        let (active, particles) = (&self.workspace.active, &self.state.bodies[body].particles);
        let end = self.settings.lattice.cells(max);
        let end: [i32; D] = std::array::from_fn(|k| end[k].floor());
        let lines: [&[T]; D] = std::array::from_fn(|k| particles.line(ColumnStart::<D>::POSITION + k));
        for tile in &active.tiles[active.tiles_of_body(body)] {
            let inside = (0..D).all(|k| {
                let first = tile.block[k] * SIDE;
                first - MARGIN > 0 && first + SIDE + MARGIN < end[k]
            });
            if inside {
                continue;
            }
            let cells = active.cells_of(tile);
            let order = &active.order_of(body)[cells[0] as usize..cells[cells.len() - 1] as usize];
            found.extend(order.iter().filter(|&&p| {
                (0..D).any(|k| lines[k][p as usize] < min[k] || lines[k][p as usize] > max[k])
            }));
        }
        found.sort_unstable();
        found
    }

    /// Takes particles out of a body: those of this rank, of so many, the first of which is at this place.
    fn remove(&mut self, (number, outside): (usize, &[u32]), (count, first): (u64, [f64; 3])) {
        let gravity = self.settings.gravity.constant().unwrap_or_default();
        let before = self.totals_of(number);
        if !outside.is_empty() {
            self.state.bodies[number].particles.remove(outside);
        }
        let after = self.totals_of(number);
        self.state.removed.resize(self.state.bodies.len(), RemovedParticles::default());
        let removed = &mut self.state.removed[number];
        if removed.count == 0 {
            (removed.time, removed.place) = (self.state.time, first);
        }
        removed.take(count, (&before, &after), gravity);
        if !outside.is_empty() {
            self.workspace.active.forget(number);
        }
        *self.workspace.totals.get_mut().unwrap_or_else(PoisonError::into_inner) = None;
    }
}

/// What of a body is outside the domain on one rank.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Gone {
    body: usize,
    count: u64,
    /// The first particle by number, and where it is [m].
    number: u32,
    place: [f64; 3],
}

impl RemovedParticles {
    /// Books what a body has less.
    fn take(&mut self, count: u64, (before, after): (&Totals, &Totals), gravity: [f64; 3]) {
        let gone = |of: fn(&Totals) -> f64| of(before) - of(after);
        let gone3 = |of: fn(&Totals) -> [f64; 3]| [0, 1, 2].map(|i| of(before)[i] - of(after)[i]);
        self.count += count;
        self.mass += gone(|totals| totals.mass);
        let moment = gone3(|totals| totals.first_moment);
        let potential: f64 = (0..3).map(|i| -gravity[i] * moment[i]).sum();
        self.energy += gone(|totals| totals.kinetic + totals.strain) + potential;
        self.plastic += gone(|totals| totals.plastic);
        let (momentum, angular) = (gone3(|totals| totals.momentum), gone3(|totals| totals.angular_momentum));
        (0..3).for_each(|i| self.momentum[i] += momentum[i]);
        (0..3).for_each(|i| self.angular_momentum[i] += angular[i]);
    }
}
