//! Laws that answer for all particles of a body at once: what they are asked, by the particles' numbers.

use super::Engine;
use crate::body::Body;
use crate::door::StepError;
use crate::lanes::Laned;
use crate::material::{Custom, LawArrays, LawOverArrays, MOST_HISTORY, Material};
use crate::particles::Particles;
use crate::pass::{FaultKind, ParticleFault};
use crate::tensor::{Real, Symmetric};
use std::time::Instant;

/// Room for what a law over arrays is asked, a row a particle by its number.
#[derive(Clone, Debug, Default)]
pub struct LawRoom {
    deformation: Vec<[f64; 9]>,
    stress: Vec<[f64; 6]>,
    history: Vec<f64>,
}

/// The law of a body, if it takes all particles at once.
pub(super) fn over_arrays<T: Real, const D: usize>(
    body: &Body<T, D>,
) -> Option<(Custom<T>, &'static dyn LawOverArrays)> {
    let Material::Custom(custom) = *body.matter.material else { return None };
    custom.law().over_arrays().filter(|_| !body.is_rigid()).map(|law| (custom, law))
}

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Whether a body has such a law.
    pub(super) fn has_laws_over_arrays(&self) -> bool {
        !self.settings.together.is_empty()
    }

    /// sigma = law(F) of these laws, once the particles have their F.
    pub(super) fn respond_together(&mut self, dt: T) -> Result<(), StepError> {
        let (start, time) = (Instant::now(), self.state.time + dt.f64());
        let mut asked = false;
        for &number in &self.settings.together {
            let body = &mut self.state.bodies[number];
            let Some((custom, law)) = over_arrays(body) else { continue };
            asked = true;
            let room = &mut self.workspace.laws;
            room.take(&custom, &body.particles);
            let LawRoom { deformation, stress, history } = room;
            law.respond(LawArrays { time, dt: dt.f64(), deformation, stress, history }).map_err(
                |reason| {
                    let what = format!("the law `{}` of body `{}`", custom.law().name(), body.name);
                    StepError::Outside { what, time, reason }
                },
            )?;
            if let Some(particle) = room.give(&custom, &mut body.particles) {
                let of_particle = body.particles.numbers()[particle];
                let kind = FaultKind::NotFinite;
                let fault = ParticleFault { body: number, particle, number: of_particle, kind };
                return Err(self.error(&self.report(&fault)));
            }
        }
        if asked {
            self.watch.lap("laws over arrays", start);
        }
        Ok(())
    }
}

impl LawRoom {
    /// Takes the particles of a body.
    fn take<T: Real, const D: usize>(&mut self, custom: &Custom<T>, particles: &Particles<T, D>) {
        let (count, components) = (particles.len(), custom.components());
        self.deformation.resize(count, [0.0; 9]);
        self.stress.resize(count, [0.0; 6]);
        self.history.resize(count * components, 0.0);
        for place in 0..count {
            let particle = particles.get(place);
            let row = particle.number as usize;
            let f = particle.deformation.0;
            self.deformation[row] = std::array::from_fn(|k| f[k / 3][k % 3].f64());
            self.stress[row] = particle.stress.0.map(T::f64);
            // SAFETY: the particle is there, and borrowed for reading.
            let history = custom.recalled(&unsafe { particles.view().history_of(place) });
            let row = &mut self.history[row * components..][..components];
            row.iter_mut().zip(history).for_each(|(kept, number)| *kept = number.f64());
        }
    }

    /// Gives the particles stress and history back; the first place in memory of one that is not finite.
    fn give<T: Real, const D: usize>(
        &self,
        custom: &Custom<T>,
        particles: &mut Particles<T, D>,
    ) -> Option<usize> {
        let components = custom.components();
        let mut wrong = None;
        for place in 0..particles.len() {
            let mut particle = particles.get(place);
            let row = particle.number as usize;
            particle.stress = Symmetric(self.stress[row].map(T::of));
            let kept = &self.history[row * components..][..components];
            if !particle.stress.0.iter().all(|x| x.is_finite()) || !kept.iter().all(|x| x.is_finite()) {
                wrong = wrong.or(Some(place));
            }
            let mut history = [T::ZERO; MOST_HISTORY];
            history.iter_mut().zip(kept).for_each(|(number, &kept)| *number = T::of(kept));
            particles.set(place, &particle);
            // SAFETY: the particle is there, and borrowed for writing.
            custom.keep(&history, &mut unsafe { particles.open().history_of(place) });
        }
        wrong
    }
}
