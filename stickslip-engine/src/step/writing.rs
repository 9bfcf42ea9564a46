//! Values that others than steps give to particles.

use super::Engine;
use crate::basis::Basis;
use crate::body::{Body, Totals};
use crate::door::{NoColumn, View, WRITABLE, WriteError, WrittenValues};
use crate::lanes::Laned;
use std::sync::Mutex;

impl<T: Laned, const D: usize, B: Basis<T>> Engine<T, D, B> {
    /// Gives the particles of a body other values in a column, see [`crate::door::Simulation::write`], and books what
    /// that changed.
    ///
    /// # Errors
    /// What cannot be written; then nothing is changed.
    pub(super) fn put(&mut self, number: usize, name: &str, values: &[f64]) -> Result<(), WriteError> {
        let body = &self.state.bodies[number];
        let found = body.particles.described().find(|(_, column)| column.name == name);
        let (first, column) = found.ok_or_else(|| NoColumn::among(&self.columns(number), name))?;
        if !WRITABLE.contains(&name) {
            return Err(WriteError::Fixed { name: name.to_string() });
        }
        if body.is_rigid() {
            return Err(WriteError::Rigid { body: body.name.clone() });
        }
        let entries = column.kind.entries(D);
        let (found, wanted) = (values.len(), entries * body.particles.len());
        if found != wanted {
            return Err(WriteError::Count { found, wanted, entries });
        }
        // In the precision of the particles, in which a large number may be infinite and a small one zero.
        let kept = |value: f64| T::of(value).f64();
        let (allowed, fits): (_, fn(f64) -> bool) = match name {
            "mass" => ("finite numbers above zero", |mass| mass.is_finite() && mass > 0.0),
            _ => ("finite numbers", f64::is_finite),
        };
        if let Some(at) = values.iter().position(|&value| !fits(kept(value))) {
            return Err(WriteError::Value { place: at / entries, value: values[at], allowed });
        }
        let before = Body::totals(&self.state.bodies[number]);
        let particles = &mut self.state.bodies[number].particles;
        for entry in 0..entries {
            let line = particles.line_mut(first + entry).iter_mut();
            line.zip(values[entry..].iter().step_by(entries)).for_each(|(x, &value)| *x = T::of(value));
        }
        let gravity = self.settings.gravity.constant().unwrap_or_default();
        self.state.written[number].take((&before, &Body::totals(&self.state.bodies[number])), gravity);
        (self.state.signal, self.workspace.totals) = (None, Mutex::default());
        Ok(())
    }
}

impl WrittenValues {
    /// Books what a body has more.
    fn take(&mut self, (before, after): (&Totals, &Totals), gravity: [f64; 3]) {
        let gained = |of: fn(&Totals) -> f64| of(after) - of(before);
        let gained3 = |of: fn(&Totals) -> [f64; 3]| [0, 1, 2].map(|i| of(after)[i] - of(before)[i]);
        self.count += 1;
        let moment = gained3(|totals| totals.first_moment);
        let potential: f64 = (0..3).map(|i| -gravity[i] * moment[i]).sum();
        self.energy += gained(|totals| totals.kinetic + totals.strain + totals.plastic) + potential;
        let (momentum, angular) =
            (gained3(|totals| totals.momentum), gained3(|totals| totals.angular_momentum));
        (0..3).for_each(|i| self.momentum[i] += momentum[i]);
        (0..3).for_each(|i| self.angular_momentum[i] += angular[i]);
    }
}
