//! The step: explicit MPM with contact, a list of verbs.

mod build;
mod cpu;
mod join;
mod look;
mod pass;
mod tile;
mod unbounded;
mod verbs;
mod watch;

pub(crate) use build::history;
pub use build::{build, build_on};
pub use pass::Path;
pub(crate) use unbounded::particles_around;

use crate::basis::Basis;
use crate::body::{Body, Totals};
use crate::boundary::Boundary;
use crate::clock::fastest_signal;
use crate::contact::{Impulses, Rules, Survey, Tally};
use crate::door::StepError;
use crate::grid::{Cover, Field, Lattice};
use crate::lanes::Laned;
use crate::rigid::RigidMotion;
use crate::scene::{StressUpdate, Time, Transfer};
use crate::tensor::Vector;
use crate::transfer::Share;
use cpu::Workshop;
use std::marker::PhantomData;
use std::sync::{Arc, Mutex};
use unbounded::Unbounded;
use watch::Watch;

/// A simulation in `D` dimensions and precision `T`, with shape functions `B`.
pub struct Engine<T, const D: usize, B> {
    bodies: Vec<Body<T, D>>,
    /// Prescribed motion of rigid bodies.
    rigid: Vec<Option<RigidMotion>>,
    /// Rigid bodies without bounds.
    unbounded: Vec<Unbounded<D>>,
    lattice: Lattice<T, D>,
    /// Lower and upper corner of the domain [m].
    domain: Option<[Vector<T, D>; 2]>,
    gravity: Vector<T, D>,
    transfer: Transfer,
    pic_share: T,
    rules: Rules<T>,
    boundary: Boundary,
    clock: Time,
    cover: Cover<D>,
    field: Field<T, D>,
    /// Where bodies meet in this step.
    meeting: Survey<T, D>,
    /// Which bodies glue joins at a node.
    groups: Vec<usize>,
    /// What contact did in the last step, use by use.
    impulses: [Impulses<T, D>; 3],
    tally: Tally,
    /// Fastest signal now [m/s]; unknown before the first step.
    signal: Option<f64>,
    /// Cells of each tile that particles have left.
    left: Vec<u64>,
    /// What the last pass took from the kinetic energy of each tile's particles [J].
    damped: Vec<f64>,
    /// What damping took since the start [J].
    damping: f64,
    /// What the particles of each body add up to since the last step, once somebody has asked.
    totals: Mutex<Option<Arc<[Totals]>>>,
    path: Path,
    workshop: Workshop<T, D>,
    time: f64,
    steps: u64,
    watch: Watch,
    basis: PhantomData<B>,
}

impl<T: Laned, const D: usize, B: Basis<T>> Engine<T, D, B> {
    /// One step of `dt`. Numbers are equations of Bardenhagen et al. (2001).
    ///
    /// Contact is applied to the interpolated and to the integrated velocities. Particles are strained and moved by the same velocities:
    /// the first ([`StressUpdate::First`]), the second ([`StressUpdate::Last`]), or the particles' new velocities scattered once more
    /// ([`StressUpdate::ModifiedLast`]).
    fn advance(&mut self, dt: T) -> Result<(), StepError> {
        let when = self.clock.stress_update;
        self.cover(); //                                blocks under each body's particles
        self.scatter(match when {
            StressUpdate::First => Share::Mass, //      m, p
            _ => Share::Everything,             //                  m, p, f = -sum V sigma grad S
        });
        self.interpolated_velocities(); //              v = p / m                           (4)
        self.survey(dt); //                             surfaces, normals and gaps where bodies meet
        self.join(); //                                 glued bodies interpolate as one
        self.first_contact(dt); //                      v~ from interpolated velocities     (5)-(13), (20)-(22)
        if when == StressUpdate::First {
            self.strain_and_scatter(dt)?; //            F = (I + L dt) F, sigma = law(F), f
            self.keep(); //                             v~ moves the particles, too
        }
        self.accelerate(dt); //                         v += dt (f / m + g)                 (3)
        self.contact(dt); //                            v~ from integrated velocities
        match when {
            StressUpdate::First => {
                self.friction_work(dt);
                self.take_back(); //                    v~ from interpolated velocities
                self.accept_and_displace(dt) //         particles: v += dv, x += v~ dt
            }
            StressUpdate::Last => {
                self.friction_work(dt);
                self.keep();
                self.accept_strain_and_displace(dt) //  particles: v += dv, F, sigma, x += v~ dt
            }
            StressUpdate::ModifiedLast => {
                self.keep_and_make_room();
                self.accept_and_scatter(dt)?; //        particles: v += dv; p
                self.modified_velocities(); //          v = p / m
                self.friction_work(dt);
                self.contact_unrecorded(dt); //         v~
                self.strain_and_displace(dt) //         particles: F, sigma, x += v~ dt
            }
        }
    }

    /// Longest stable step now [s].
    fn stable(&self) -> f64 {
        let signal = self.signal.unwrap_or_else(|| fastest_signal(&self.bodies));
        let step = self.clock.courant * self.lattice.cell.f64() / signal;
        self.clock.max_step.map_or(step, |longest| step.min(longest))
    }
}
