//! Gravity, and its work where it varies in time.
//!
//! Weights have a potential energy as long as gravity is constant. Where it varies, the ledger has none, and the work
//! of each step counts as done from outside:
//!
//! ```text
//! W = g . sum m (x^1 - x^0)            g: in the middle of the step
//! ```

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
    /// Gravity in a step from now on, that of its middle [m/s^2].
    pub(super) fn gravity(&self, dt: T) -> Vector<T, D> {
        Vector::of(self.settings.gravity.at(self.state.time + 0.5 * dt.f64()))
    }

    /// sum m x of all bodies that gravity pulls, where it varies; else nothing is summed [kg m].
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
            sums.iter_mut().zip(motion.center).for_each(|(sum, x)| sum.add(mass * x));
        }
        for body in self.bodies_here().map(|body| &self.state.bodies[body]).filter(|body| !body.is_rigid()) {
            parts.clear();
            parts.resize_with(body.particles.len().div_ceil(PART), || {
                std::array::from_fn(|_| ExactSum::default())
            });
            each(&mut parts, 1, |part, moment| *moment = first_moment(body, part));
            for moment in &parts {
                sums.iter_mut().zip(moment).for_each(|(sum, moment)| sum.merge(moment));
            }
        }
        self.workspace.weights = parts;
        self.add_up(&mut sums);
        Some(Vector(sums.map(|sum| sum.value())))
    }

    /// Books the work of gravity in a step of `dt` that began with these moments, while `time` is still its start.
    pub(super) fn book_gravity(&mut self, dt: T, before: Option<Vector<f64, 3>>) {
        if let (Some(before), Some(after)) = (before, self.weigh()) {
            let gravity = Vector(self.gravity(dt).space());
            self.state.gravity_work += gravity.dot(after - before);
        }
    }
}

/// sum m x of a part of a body's particles [kg m].
fn first_moment<T: Real, const D: usize>(body: &Body<T, D>, part: usize) -> [ExactSum; D] {
    let end = body.particles.len().min((part + 1) * PART);
    let line = |column: usize| &body.particles.line(column)[part * PART..end];
    let masses = line(ColumnStart::<D>::MASS);
    std::array::from_fn(|i| {
        let places = line(ColumnStart::<D>::POSITION + i);
        masses.iter().zip(places).map(|(mass, place)| mass.f64() * place.f64()).sum()
    })
}
