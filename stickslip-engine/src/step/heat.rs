//! Loads that are temperatures: heat that makes particles grow.
//!
//! A law sees the deformation without the growth, see [`crate::natural`]. Growth by dq/q works against the stress and
//! takes the energy that is there along:
//!
//! ```text
//! W = sum (3 E - V tr sigma) ln(q^1/q^0)            E: strain energy of a particle
//! ```
//! with half of the growth of the last step and half of that of the next one, by the state between them.

use super::Engine;
use crate::body::Body;
use crate::door::StepError;
use crate::exact::ExactSum;
use crate::lanes::Laned;
use crate::load::LoadPoints;
use crate::natural::heat_in;
use crate::particles::ColumnStart;
use crate::pass::{FaultKind, ParticleFault};
use crate::scene::{Action, Expression, Moment};
use crate::tensor::{Real, Vector};
use crate::threads::each;
use std::time::Instant;

/// Particles that a thread takes at a time.
const PARTICLES: usize = 256;

/// What heat does to a particle in a step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Warmed<T> {
    /// T at the end of the step [K].
    temperature: T,
    /// q^1/q^0 - 1
    strain: T,
    /// [J]
    work: f64,
    /// What is wrong with that.
    fault: Option<FaultKind>,
}

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Brings what loads heat to the temperature at the end of a step of `dt` from now on, and books what that does.
    ///
    /// # Errors
    /// A particle shrinks to nothing, or its energy is not a finite number.
    pub(super) fn heat(&mut self, dt: T) -> Result<(), StepError> {
        let (time, room) = (self.state.time + dt.f64(), &mut self.workspace.warmed);
        let mut faults: Vec<ParticleFault> = Vec::new();
        for (load, sums) in self.settings.loads.iter().zip(&mut self.state.loads) {
            let Action::Temperature(temperature) = &load.action else { continue };
            let start = Instant::now();
            let body = &mut self.state.bodies[load.body];
            room.clear();
            room.resize(body.particles.len(), Warmed::default());
            {
                let body = &*body;
                each(room, PARTICLES, |i, warmed| *warmed = warm(body, i, (load, temperature, time)));
            }
            let numbers = body.particles.numbers().iter().zip(&*room).enumerate();
            faults.extend(numbers.filter_map(|(particle, (&number, warmed))| {
                let kind = warmed.fault?;
                Some(ParticleFault { body: load.body, particle, number, kind })
            }));
            let first = first_of_heat(body);
            let set = |line: &mut [T], of: fn(&Warmed<T>) -> T| {
                line.iter_mut().zip(&*room).for_each(|(entry, warmed)| *entry = of(warmed));
            };
            if let Some(body) = body.here_mut() {
                set(body.particles.line_mut(first), |warmed| warmed.temperature);
                set(body.particles.line_mut(first + 1), |warmed| warmed.strain);
            }
            let mut work = [room.iter().map(|warmed| warmed.work).sum::<ExactSum>()];
            self.among.iter().for_each(|among| among.add_up(work.iter_mut()));
            sums.work += work[0].value();
            self.watch.lap("heat", start);
        }
        self.judge(faults.into_iter().min_by_key(|fault| (fault.body, fault.number)))
    }
}

/// Where a heated body has its temperatures.
fn first_of_heat<T: Real, const D: usize>(body: &Body<T, D>) -> usize {
    let columns = body.particles.view().natural_columns();
    columns.start + heat_in::<D>(columns.len()).expect("a body that loads heat has the columns of heat")
}

/// What a load does to particle `i` of its body.
fn warm<T: Real, const D: usize>(
    body: &Body<T, D>,
    i: usize,
    (load, temperature, time): (&LoadPoints, &Expression, f64),
) -> Warmed<T> {
    let particles = &body.particles;
    let first = first_of_heat(body);
    let [before, strain] = [0, 1].map(|k| particles.line(first + k)[i]);
    if !load.heats[particles.numbers()[i] as usize] {
        return Warmed { temperature: before, ..Warmed::default() };
    }
    let particle = particles.get(i);
    let start = Vector::<T, D>::from_fn(|k| particles.line(ColumnStart::<D>::START + k)[i]);
    let moment = Moment { time, place: particle.position.space(), start: start.space(), ..Moment::default() };
    let after = T::of(temperature.at_moment(&moment));
    let alpha = body.matter.expansion.f64();
    let size = 1.0 + alpha * after.f64();
    if size.is_nan() || size <= 0.0 {
        return Warmed { temperature: before, fault: Some(FaultKind::Shrunk), ..Warmed::default() };
    }
    let next = alpha * (after.f64() - before.f64()) / (1.0 + alpha * before.f64());
    let growth = 0.5 * (libm::log1p(strain.f64()) + libm::log1p(next));
    let mut work = 0.0;
    if growth != 0.0 {
        let natural = particles.natural(i, body.matter.expansion).expect("heated bodies have such a state");
        let (elastic, _) = natural.elastic(&particle.deformation, T::ONE);
        // SAFETY: the particles are borrowed for reading.
        let history = unsafe { particles.view().history_of(i) };
        let [energy, _] = body.matter.material.energies(&elastic, &particle.stress, &history);
        let stored = energy * (particle.mass / body.matter.density / natural.volume);
        work = growth * (3.0 * stored.f64() - (particle.volume * particle.stress.trace()).f64());
    }
    if !work.is_finite() {
        return Warmed { temperature: before, fault: Some(FaultKind::NotFinite), ..Warmed::default() };
    }
    Warmed { temperature: after, strain: T::of(next), work, fault: None }
}
