//! A pass as the equations read, one particle and one node after the other: an oracle for the tests.

use super::{FaultKind, ParticleLoop, Pass, Visit};
use super::{home, is_outside};
use crate::basis::Basis;
use crate::grid::{addressable, window_side};
use crate::lanes::Any;
use crate::material::Motion;
use crate::matter::Particle;
use crate::scheme::Transfer;
use crate::signal::signal_speed;
use crate::tensor::{Matrix, Real, Symmetric, Vector};
use crate::transfer::{Share, Stencil, has_spin};
use crate::viscosity::BulkViscosity;

/// Takes the tile's particles through the pass, by shape functions `B`.
///
/// # Safety
/// Nobody else may use the tile's nodes and particles meanwhile.
pub unsafe fn visit_naively<T: Real, const D: usize, B: Basis<T>>(
    _: ParticleLoop,
    visit: &mut Visit<'_, T, D>,
) {
    // SAFETY: the caller's.
    unsafe { visit.take_naively::<B>() }
}

impl<T: Real, const D: usize> Visit<'_, T, D> {
    /// Takes the tile's particles one by one through the pass.
    ///
    /// # Safety
    /// Nobody else may use the tile's nodes and particles meanwhile.
    unsafe fn take_naively<B: Basis<T>>(&mut self) {
        let side = window_side(B::WIDTH);
        // SAFETY: the caller's.
        unsafe {
            self.open::<Any>(side);
            self.naively::<B>();
            self.close::<Any>(side);
        }
    }

    /// Changes the tile's particles one by one.
    ///
    /// # Safety
    /// Nobody else may use the tile's particles meanwhile.
    unsafe fn naively<B: Basis<T>>(&mut self) {
        for (cell, ends) in self.cells.windows(2).enumerate() {
            for place in ends[0]..ends[1] {
                // SAFETY: the caller's.
                unsafe { self.naive_one::<B>(self.order[place as usize], cell) };
            }
        }
    }

    /// Takes one particle, whose home is a cell.
    ///
    /// # Safety
    /// Nobody else may use the particle meanwhile.
    unsafe fn naive_one<B: Basis<T>>(&mut self, index: u32, cell: usize) {
        // SAFETY: the caller's.
        let mut particle = unsafe { self.columns.get(index as usize) };
        let stencil = Stencil::<T, D, B>::of(&self.pass.lattice, &particle);
        let outcome = self.change_naively((&mut particle, index as usize), &stencil);
        // SAFETY: the caller's.
        unsafe { self.columns.set(index as usize, &particle) };
        match outcome {
            Ok(()) if self.pass.verbs.smooth => {
                let velocity = stencil.interpolate(&self.window.integrated, self.tile.block);
                let smooth = Particle { velocity, ..particle };
                let given = (T::ZERO, &smooth, &Matrix::ZERO);
                stencil.scatter_momentum(self.window, self.tile.block, given);
            }
            Ok(()) => self.scatter_naively((&particle, index as usize), &stencil),
            Err(kind) => self.find_fault(index, kind),
        }
        if self.pass.verbs.advect {
            let moved = Stencil::<T, D, B>::of(&self.pass.lattice, &particle).base() != stencil.base();
            self.left |= u64::from(moved) << cell;
            self.moved += u32::from(moved);
            // SAFETY: the caller's.
            let history = unsafe { self.columns.history_of(index as usize) };
            let wave = self.matter.wave_modulus(&particle, &history) / self.matter.density;
            let signal = signal_speed([wave, particle.velocity.dot(particle.velocity)]);
            self.found.signal = self.found.signal.max(signal);
        }
    }

    fn change_naively<B: Basis<T>>(
        &mut self,
        (particle, index): (&mut Particle<T, D>, usize),
        stencil: &Stencil<T, D, B>,
    ) -> Result<(), FaultKind> {
        let Pass { verbs, dt, transfer, pic, ref lattice, domain, viscosity } = *self.pass;
        let block = self.tile.block;
        if verbs.update_velocity {
            let kept = T::ONE - pic;
            particle.velocity += stencil.interpolate(&self.window.change, block);
            let moments = stencil.moments(&self.window.change, block);
            let torque = stencil.torque(&self.window.change, block);
            let gyration = self.matter.gyration.squared(particle.half_width);
            let spin = particle.spin;
            if has_spin(transfer) {
                particle.spin += torque * (T::ONE / gyration);
            }
            let mut rate = self.strain_rate(index);
            let given = skew(&spin) + rate.matrix();
            if transfer == Transfer::Apic {
                rate += moments.symmetric_part() * (T::of(2.0) / gyration);
            }
            let kinetic = |particle: &Particle<T, D>, rate: &Symmetric<T>| {
                self.matter.kinetic(particle) + T::of(0.25) * particle.mass * gyration * rate.double_dot(rate)
            };
            let before = kinetic(particle, &rate);
            if pic > T::ZERO {
                let mean = stencil.interpolate(&self.window.integrated, block);
                particle.velocity = particle.velocity * kept + mean * pic;
                if transfer == Transfer::Rflip {
                    let gradient = stencil.velocity_gradient(&self.window.integrated, block);
                    particle.spin = particle.spin * kept + half_curl(&gradient) * pic;
                }
            }
            if transfer == Transfer::Apic {
                let others = stencil.moments(&self.window.integrated, block) - given * stencil.spread();
                let affine = given + others * (T::ONE / inertia(gyration, &stencil.spread()));
                particle.spin = half_curl(&affine);
                rate = affine.symmetric_part();
            }
            let damped = before - kinetic(particle, &rate);
            self.damped += damped.f64();
            self.put_strain_rate(index, &rate);
            let sound = particle.velocity.is_finite() && particle.spin.is_finite();
            sound.then_some(()).ok_or(FaultKind::NotFinite)?;
        }
        if verbs.update_stress {
            let mut gradient = stencil.velocity_gradient(&self.window.flow, block);
            if !self.means.is_empty() {
                let more =
                    (stencil.interpolate_mean(&self.window.flow, block) - gradient.trace()) / T::of(D as f64);
                (0..D).for_each(|i| gradient.0[i][i] += more);
            }
            if transfer == Transfer::Rflip && verbs.settle {
                let before = self.matter.kinetic(particle);
                let share = (T::of(8.0 * 0.3) * particle.spin.norm() * dt).min(T::ONE);
                particle.spin += (half_curl(&gradient) - particle.spin) * share;
                self.damped += (before - self.matter.kinetic(particle)).f64();
            }
            if transfer == Transfer::Apic && !verbs.update_velocity && verbs.advect {
                let before = self.matter.kinetic(particle);
                let given = skew(&particle.spin) + self.strain_rate(index).matrix();
                let turned = given * stencil.moments(&self.window.flow, block).transpose();
                let gyration = self.matter.gyration.squared(particle.half_width);
                particle.spin += half_curl(&turned) * (T::of(2.0) * dt / gyration);
                self.damped += (before - self.matter.kinetic(particle)).f64();
            }
            let increment = Matrix::IDENTITY + gradient * dt;
            let deformation = increment * particle.deformation;
            let jacobian = deformation.det();
            if !jacobian.is_finite() {
                return Err(FaultKind::NotFinite);
            }
            let undeformed = particle.mass / self.matter.density;
            (particle.deformation, particle.volume) = (deformation, undeformed * jacobian);
            if jacobian <= T::ZERO {
                return Err(FaultKind::Inverted);
            }
            let motion = Motion { deformation, jacobian, increment, stress: particle.stress, dt };
            // SAFETY: the caller of this pass keeps others away from the tile's particles.
            let mut history = unsafe { self.columns.history_of(index) };
            let (motion, stress) = self.matter.respond(motion, &mut history).ok_or(FaultKind::NoThickness)?;
            (particle.deformation, particle.volume) = (motion.deformation, undeformed * motion.jacobian);
            particle.stress = stress;
            particle.stress.is_finite().then_some(()).ok_or(FaultKind::NotFinite)?;
            if let Some(BulkViscosity { coefficients: [linear, quadratic] }) = viscosity {
                let density = particle.mass / particle.volume;
                let speed = (self.matter.wave_modulus(particle, &history) / self.matter.density).sqrt();
                let closing = (-gradient.trace()).max(T::ZERO) * self.pass.lattice.cell;
                let pressure = density * (linear * speed * closing + quadratic * closing * closing);
                let before = self.viscosity_column(index, Some(pressure));
                let mean = (before + pressure) * T::HALF;
                self.damped -= (mean * particle.volume * gradient.trace() * dt).f64();
            }
        }
        if verbs.advect {
            let position = particle.position + stencil.interpolate(&self.window.flow, block) * dt;
            if !position.is_finite() {
                return Err(FaultKind::NotFinite);
            }
            particle.position = position;
            let home = home::<T, D, B>(lattice, (position, particle.half_width));
            if is_outside(position, domain) || !addressable(home) {
                return Err(FaultKind::Escaped);
            }
        }
        Ok(())
    }

    /// The rate of strain that the transfer carries; zero if it carries none.
    fn strain_rate(&self, index: usize) -> Symmetric<T> {
        let mut rate = Symmetric::ZERO;
        for (entry, column) in rate.0.iter_mut().zip(self.columns.transfer_columns()) {
            // SAFETY: the caller of this pass keeps others away from the tile's particles.
            *entry = unsafe { *self.columns.at(column, index) };
        }
        rate
    }

    /// Pressure of the bulk viscosity, zero if there is none, and what comes in its place.
    fn viscosity_column(&self, index: usize, after: Option<T>) -> T {
        let Some(column) = self.columns.viscosity_columns().next() else { return T::ZERO };
        // SAFETY: the caller of this pass keeps others away from the tile's particles.
        let entry = unsafe { &mut *self.columns.at(column, index) };
        std::mem::replace(entry, after.unwrap_or(*entry))
    }

    fn put_strain_rate(&self, index: usize, rate: &Symmetric<T>) {
        for (&entry, column) in rate.0.iter().zip(self.columns.transfer_columns()) {
            // SAFETY: as above.
            unsafe { *self.columns.at(column, index) = entry };
        }
    }

    fn scatter_naively<B: Basis<T>>(
        &mut self,
        (particle, index): (&Particle<T, D>, usize),
        stencil: &Stencil<T, D, B>,
    ) {
        let half_step = if self.pass.transfer == Transfer::Apic { T::ZERO } else { T::HALF * self.pass.dt };
        let turning = skew(&particle.spin);
        let gradient = turning + turning * turning * half_step + self.strain_rate(index).matrix();
        let viscosity = self.viscosity_column(index, None);
        let (window, block) = (&mut *self.window, self.tile.block);
        match self.pass.verbs.scatter {
            Some(Share::Mass | Share::Everything) => {
                stencil.scatter_momentum(window, block, (particle.mass, particle, &gradient));
            }
            Some(Share::Momentum) => {
                stencil.scatter_momentum(window, block, (T::ZERO, particle, &gradient));
            }
            Some(share @ (Share::Dilatation | Share::MeanStress)) => {
                let sum = match share {
                    Share::MeanStress => particle.volume * mean_stress::<T, D>(&particle.stress),
                    _ => particle.mass * stencil.velocity_gradient(&window.flow, block).trace(),
                };
                let still = Particle { velocity: Vector::ZERO, ..*particle };
                stencil.scatter_momentum(window, block, (sum, &still, &Matrix::ZERO));
            }
            Some(Share::Force) | None => {}
        }
        if matches!(self.pass.verbs.scatter, Some(Share::Force | Share::Everything)) {
            let mut pull = particle.stress * particle.volume;
            (0..D).for_each(|i| pull.0[i] -= viscosity * particle.volume);
            if !self.means.is_empty() {
                let mean = particle.mass * stencil.interpolate_mean(&window.flow, block);
                let own = particle.volume * mean_stress::<T, D>(&particle.stress);
                (0..D).for_each(|i| pull.0[i] += mean - own);
            }
            stencil.scatter_force(window, block, &pull);
        }
    }
}

/// Mean of the normal stresses along the axes that there are [Pa].
fn mean_stress<T: Real, const D: usize>(stress: &Symmetric<T>) -> T {
    (0..D).fold(T::ZERO, |sum, i| sum + stress.0[i]) / T::of(D as f64)
}

/// Inertia of the affine velocities around a particle, from the square of its radius of gyration and its spread over
/// the nodes: at least 2/3 of the latter [m^2].
fn inertia<T: Real>(gyration: T, spread: &Matrix<T>) -> T {
    let rows = spread.0.map(|row| row.into_iter().fold(T::ZERO, |sum, entry| sum + entry.abs()));
    rows.into_iter().fold(gyration * T::HALF, |most, row| most.max(row * T::of(2.0 / 3.0)))
}

/// Half of the curl of velocities with a gradient [rad/s].
fn half_curl<T: Real>(gradient: &Matrix<T>) -> Vector<T, 3> {
    let l = &gradient.0;
    Vector([l[2][1] - l[1][2], l[0][2] - l[2][0], l[1][0] - l[0][1]]) * T::HALF
}

/// W = w x
fn skew<T: Real>(spin: &Vector<T, 3>) -> Matrix<T> {
    let [x, y, z] = spin.0;
    Matrix([[T::ZERO, -z, y], [z, T::ZERO, -x], [-y, x, T::ZERO]])
}
