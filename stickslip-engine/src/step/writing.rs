//! Values that others than steps give to particles, and to free rigid bodies.

use super::Engine;
use super::build::spin;
use crate::body::Totals;
use crate::door::{NoColumn, View, WRITABLE, WriteError, WrittenValues};
use crate::lanes::Laned;
use crate::rigid::{FreeMotion, RigidMotion};
use crate::tensor::{Vector, cross};
use std::sync::Mutex;

/// What of a body writing changes.
struct Holding {
    /// Kinetic, strain and potential energy, and what its material has dissipated [J].
    energy: f64,
    /// [kg m/s]
    momentum: [f64; 3],
    /// About the origin [kg m^2/s].
    angular_momentum: [f64; 3],
}

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Gives the particles of a body other values in a column, see [`crate::door::Simulation::write`], and books what
    /// that changed.
    ///
    /// # Errors
    /// What cannot be written; then nothing is changed.
    pub(super) fn put(&mut self, number: usize, name: &str, values: &[f64]) -> Result<(), WriteError> {
        if self.among.is_some() {
            return Err(WriteError::Shared);
        }
        self.show_references();
        let reference = self.reference_of(number);
        let body = &self.state.bodies[number];
        let found = body.particles.described().find(|(_, column)| column.name == name);
        let (first, column) = found.ok_or_else(|| NoColumn::among(&self.columns(number), name))?;
        if !WRITABLE.contains(&name) {
            return Err(WriteError::Fixed { name: name.to_string() });
        }
        if reference.is_some() && name != "velocity" {
            let body = self.name_of(number).to_string();
            return Err(WriteError::OwnGrid { name: name.to_string(), body });
        }
        if body.is_rigid() {
            return self.put_rigid(number, name, (values, column.kind.entries(D)));
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
        let gravity = self.settings.gravity.constant().unwrap_or_default();
        let before = Holding::of_particles(&self.totals_of(number), gravity);
        if let Some(place) = reference {
            self.put_velocities(place, values);
        } else {
            let particles = &mut self.state.bodies[number].particles;
            for entry in 0..entries {
                let line = particles.line_mut(first + entry).iter_mut();
                line.zip(values[entry..].iter().step_by(entries)).for_each(|(x, &value)| *x = T::of(value));
            }
            particles.compare();
        }
        let after = Holding::of_particles(&self.totals_of(number), gravity);
        self.book_written(number, [before, after]);
        Ok(())
    }

    /// Books what a body has more.
    fn book_written(&mut self, number: usize, [before, after]: [Holding; 2]) {
        self.state.written.resize(self.state.bodies.len(), WrittenValues::default());
        self.state.written[number].take(&before, &after);
        (self.state.signal, self.workspace.totals) = (None, Mutex::default());
    }

    /// Gives a free rigid body another velocity of its centre, or another spin.
    fn put_rigid(
        &mut self,
        number: usize,
        name: &str,
        (values, entries): (&[f64], usize),
    ) -> Result<(), WriteError> {
        let body = &mut self.state.bodies[number];
        let named = || body.name.clone();
        let Some((motion, free)) =
            body.motion.as_deref().and_then(|motion| Some((motion, motion.as_free()?)))
        else {
            return Err(WriteError::Prescribed { body: named() });
        };
        if name == "mass" {
            return Err(WriteError::RigidMass { body: named() });
        }
        if values.len() != entries || !values.iter().all(|&value| T::of(value).f64().is_finite()) {
            return Err(WriteError::Whole { body: named(), found: values.to_vec(), entries });
        }
        let before = Holding::of_rigid(motion, free);
        let mut momenta = [free.state.momentum, free.state.angular_momentum];
        let mut given = [0.0; 3];
        if name == "velocity" {
            given[..entries].copy_from_slice(values);
            momenta[0] = given.map(|v| free.mass * v);
        } else {
            given[3 - entries..].copy_from_slice(values);
            momenta[1] = free.inertia().times(given);
        }
        let mut moving = motion.clone();
        moving.set_momenta(momenta, 0.0);
        for i in 0..body.particles.len() {
            let mut particle = body.particles.get(i);
            particle.velocity = Vector::of(moving.velocity_at(particle.position.space()));
            particle.spin = spin::<T, D>(moving.spin());
            body.particles.set(i, &particle);
        }
        let after = moving.as_free().map(|free| Holding::of_rigid(&moving, free)).expect("it is free");
        body.motion = Some(Box::new(moving));
        self.book_written(number, [before, after]);
        Ok(())
    }
}

impl Holding {
    fn of_particles(totals: &Totals, gravity: [f64; 3]) -> Self {
        let potential: f64 = (0..3).map(|i| -gravity[i] * totals.first_moment[i]).sum();
        Holding {
            energy: totals.kinetic + totals.strain + totals.plastic + potential,
            momentum: totals.momentum,
            angular_momentum: totals.angular_momentum,
        }
    }

    /// Its potential energy stays.
    fn of_rigid(motion: &RigidMotion, free: &FreeMotion) -> Self {
        let orbit = cross(motion.center, free.state.momentum);
        Holding {
            energy: free.kinetic(),
            momentum: free.state.momentum,
            angular_momentum: [0, 1, 2].map(|i| orbit[i] + free.state.angular_momentum[i]),
        }
    }
}

impl WrittenValues {
    /// Books what a body has more.
    fn take(&mut self, before: &Holding, after: &Holding) {
        self.count += 1;
        self.energy += after.energy - before.energy;
        for i in 0..3 {
            self.momentum[i] += after.momentum[i] - before.momentum[i];
            self.angular_momentum[i] += after.angular_momentum[i] - before.angular_momentum[i];
        }
    }
}
