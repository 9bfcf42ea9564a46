//! The step: explicit MPM with contact, a list of verbs.

mod build;
mod cpu;
mod join;
mod look;
mod rigid;
mod verbs;
mod watch;

pub use build::build;

use crate::basis::Basis;
use crate::body::Body;
use crate::boundary::Boundary;
use crate::clock::fastest_signal;
use crate::contact::{Impulse, Rules, Tally};
use crate::door::StepError;
use crate::grid::{Cover, Field, Lattice};
use crate::scene::{StressUpdate, Time};
use crate::tensor::{Real, Vector};
use rigid::RigidMotion;
use std::marker::PhantomData;
use verbs::Share;
use watch::Watch;

/// A simulation in `D` dimensions and precision `T`, with shape functions `B`.
pub struct Engine<T, const D: usize, B> {
    bodies: Vec<Body<T, D>>,
    /// Prescribed motion of rigid bodies.
    rigid: Vec<Option<RigidMotion>>,
    lattice: Lattice<T, D>,
    /// Lower and upper corner of the domain [m].
    domain: Option<[Vector<T, D>; 2]>,
    gravity: Vector<T, D>,
    pic_share: T,
    rules: Rules<T>,
    boundary: Boundary,
    clock: Time,
    cover: Cover<D>,
    field: Field<T, D>,
    /// What contact did in the last step, both uses.
    impulses: Vec<Impulse<T, D>>,
    tally: Tally,
    time: f64,
    steps: u64,
    watch: Watch,
    basis: PhantomData<B>,
}

impl<T: Real, const D: usize, B: Basis<T>> Engine<T, D, B> {
    /// One step of `dt`. Numbers are equations of Bardenhagen et al. (2001).
    ///
    /// Contact is applied to the interpolated and to the integrated velocities. The strain comes from the first
    /// ([`StressUpdate::First`]), from the second ([`StressUpdate::Last`]), or from the particles' new velocities scattered
    /// once more ([`StressUpdate::ModifiedLast`]).
    fn advance(&mut self, dt: T) -> Result<(), StepError> {
        let when = self.clock.stress_update;
        self.cover(); //                                blocks under each body's particles
        self.scatter(match when {
            StressUpdate::First => Share::Momentum, //  m, p
            _ => Share::Everything,                 //                  m, p, f = -sum V sigma grad S
        });
        self.interpolated_velocities(); //              v = p / m                           (4)
        let survey = self.survey(); //                  surfaces, normals and gaps where bodies meet
        self.join(&survey); //                         glued bodies interpolate as one
        self.contact(&survey, dt); //                   v~ from interpolated velocities     (5)-(13), (20)-(22)
        if when == StressUpdate::First {
            self.strain(dt)?;
            self.scatter(Share::Force);
        }
        self.accelerate(dt); //                         v += dt (f / m + g)                 (3)
        self.contact(&survey, dt); //                   v~ from integrated velocities
        self.accept()?; //                              particles: v += dv
        match when {
            StressUpdate::First => self.displace(dt), // particles: x += v dt
            StressUpdate::Last => {
                self.strain(dt)?; //                    F = (I + L dt) F, sigma = law(F)
                self.displace(dt)
            }
            StressUpdate::ModifiedLast => {
                self.set_velocities_aside();
                self.scatter(Share::Momentum);
                self.modified_velocities();
                self.contact_unrecorded(&survey, dt);
                self.strain(dt)?;
                self.displace_aside(dt)
            }
        }
    }

    /// Longest stable step now [s].
    fn stable(&self) -> f64 {
        let signal = fastest_signal(&self.bodies);
        let step = self.clock.courant * self.lattice.cell.f64() / signal;
        self.clock.max_step.map_or(step, |longest| step.min(longest))
    }
}
