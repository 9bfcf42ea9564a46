//! Gravity, and its work where it varies in time.
//!
//! Weights have a potential energy as long as gravity is constant. Where it varies, the ledger has none, and the work
//! of each step counts as done from outside:
//!
//! ```text
//! W = dt g . sum m (v^0 + v^1) / 2     g: the mean over the step
//! ```
//! It is what its impulse dt m g adds to the kinetic energy, a pulse within one step too. The way of a step, v^1 dt,
//! would make that up only over many.

use super::Engine;
use crate::body::Body;
use crate::exact::ExactSum;
use crate::lanes::Laned;
use crate::particles::ColumnStart;
use crate::tensor::{Real, Vector};
use crate::threads::each;

/// Particles that a thread takes at a time.
const PART: usize = 1 << 13;

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Gravity in a step from now on, its mean [m/s^2].
    pub(super) fn gravity(&self, dt: T) -> Vector<T, D> {
        Vector::of(self.settings.gravity.over_step(self.state.time, dt.f64()))
    }

    /// sum m v of all bodies that gravity pulls, where it varies; else nothing is summed [kg m/s].
    pub(super) fn weigh(&mut self) -> Option<Vector<f64, 3>> {
        if self.settings.gravity.constant().is_some() {
            return None;
        }
        let mut sums: [ExactSum; 3] = Default::default();
        let mut parts = std::mem::take(&mut self.workspace.weights);
        // All ranks have rigid bodies: the first counts them.
        let counts = self.among.as_ref().is_none_or(|among| among.ranks.rank() == 0);
        for &body in self.settings.rigid.iter().filter(|_| counts) {
            let Some(motion) = &self.state.bodies[body].motion else { continue };
            let mass = motion.as_free().map_or(0.0, |free| free.mass);
            sums.iter_mut().zip(motion.velocity()).for_each(|(sum, v)| sum.add(mass * v));
        }
        // Of several ranks one has the particles of a body on a grid of its own.
        let own = self.settings.references.iter().zip(&self.state.references.nodes);
        for (_, nodes) in own.filter(|(own, _)| !self.state.bodies[own.body].particles.is_empty()) {
            for (mass, _, velocity) in nodes.carried() {
                sums.iter_mut().zip(velocity.0).for_each(|(sum, v)| sum.add(mass * v));
            }
        }
        let on_grid =
            |&body: &usize| !self.state.bodies[body].is_rigid() && self.reference_of(body).is_none();
        for body in self.bodies_here().filter(on_grid).map(|body| &self.state.bodies[body]) {
            parts.clear();
            parts.resize_with(body.particles.len().div_ceil(PART), || {
                std::array::from_fn(|_| ExactSum::default())
            });
            each(&mut parts, 1, |part, sums| *sums = momentum(body, part));
            for part in &parts {
                sums.iter_mut().zip(part).for_each(|(sum, part)| sum.merge(part));
            }
        }
        self.workspace.weights = parts;
        self.add_up(&mut sums);
        Some(Vector(sums.map(|sum| sum.value())))
    }

    /// Books the work of gravity in a step of `dt` that began with this momentum, while `time` is still its start.
    pub(super) fn book_gravity(&mut self, dt: T, before: Option<Vector<f64, 3>>) {
        if let (Some(before), Some(after)) = (before, self.weigh()) {
            let gravity = Vector(self.gravity(dt).space());
            self.state.gravity_work += gravity.dot(before + after) * (0.5 * dt.f64());
        }
    }
}

/// sum m v of a part of a body's particles [kg m/s].
fn momentum<T: Real, const D: usize>(body: &Body<T, D>, part: usize) -> [ExactSum; D] {
    let end = body.particles.len().min((part + 1) * PART);
    let line = |column: usize| &body.particles.line(column)[part * PART..end];
    let masses = line(ColumnStart::<D>::MASS);
    std::array::from_fn(|i| {
        let speeds = line(ColumnStart::<D>::VELOCITY + i);
        masses.iter().zip(speeds).map(|(mass, speed)| mass.f64() * speed.f64()).sum()
    })
}
