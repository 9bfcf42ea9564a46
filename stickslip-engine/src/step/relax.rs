//! Dynamic relaxation: the state at rest, looked for by motion.
//!
//! Where all bodies that deform are on grids of their own, forces follow from places alone, and a viscous force brings
//! them to rest that is critical for the slowest swing which there still is ([`super::reference`]). Else there is noise
//! of particles that change their cells, and damping is kinetic.
//!
//! Bodies that are let go swing about the state at rest, and pass it when they are fastest. Where their kinetic energy
//! has passed a peak they are stopped, and let go again from there (Cundall 1982, Adaptive density-scaling for
//! time-explicit calculations; Barnes 1999, Int. J. Space Struct. 14). Between two stops a viscous force slows them down
//! at a rate that falls with the time since the last one:
//!
//! ```text
//! alpha = r / t,   r = 0.1
//! ```
//! as in the accelerated descents of Nesterov (Su, Boyd & Candes 2016, J. Mach. Learn. Res. 17, where r = 3 is proved
//! for all convex energies, and to begin anew where the speed falls to be quick). What is fast, such as noise of
//! particles that change their cells, so dies out after a stop and does not call for the next one; what is slow has
//! its way. Steps to rest at 1e-3 with r = 0, 0.1, 0.3, 1: a hanging bar 347, 200, 328, 464; a cantilever 10530,
//! 16201, 19675, 21923; a bar of four cells in torsion 7310, 6823, 6861, 6727. A thick cylinder of eight cells comes
//! to rest with 0.1 and not without. What all of this takes from the bodies the ledger counts as damping.

use super::Engine;
use crate::lanes::Laned;
use crate::rigid::RigidMotion;
use crate::scene;
use crate::tensor::Vector;
use crate::threads::each;
use serde::{Deserialize, Serialize};
use std::sync::PoisonError;
use std::time::Instant;

/// r
const RATE: f64 = 0.1;

/// How far the bodies are from rest.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct RelaxationProgress {
    /// Unbalanced forces at the nodes over those that act there, in the last step [-].
    pub residual: f64,
    /// Kinetic energy at the nodes with which the last step began, and the step before that [J].
    pub kinetic: [f64; 2],
    /// How often they were stopped.
    pub peaks: u64,
    /// Time since they were stopped, or began [s].
    pub since: f64,
    /// Whether they are at rest.
    pub at_rest: bool,
    /// How long the last step was [s].
    pub last_step: f64,
}

impl Default for RelaxationProgress {
    /// Nothing is known yet.
    fn default() -> Self {
        RelaxationProgress {
            residual: 1.0,
            kinetic: [0.0; 2],
            peaks: 0,
            since: 0.0,
            last_step: 0.0,
            at_rest: false,
        }
    }
}

impl RelaxationProgress {
    /// Takes note of a step's forces, summed over the nodes of deformable bodies, and of the kinetic energy there:
    ///
    /// ```text
    /// R = sum |r_i| / max(sum |f_i|, sum |r_i - f_i|)
    /// ```
    /// r: unbalanced force, f: force of the stress, r - f: gravity, loads and contact.
    pub fn take(&mut self, [unbalanced, internal, external]: [f64; 3], kinetic: f64) {
        let applied = internal.max(external);
        // What is no number is not balanced.
        self.residual = if unbalanced == 0.0 { 0.0 } else { unbalanced / applied };
        self.kinetic = [kinetic, self.kinetic[0]];
    }
}

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Rate of the viscous damping in a step, beside that of the scene: none where nothing is to come to rest [1/s].
    pub(super) fn relaxing_rate(&self, dt: T) -> T {
        match self.settings.time.relax {
            Some(_) => T::of(RATE) / (T::of(self.state.relaxation.since) + dt),
            None => T::ZERO,
        }
    }

    /// Stops bodies on the common grid, and those beside them, where their kinetic energy has passed a peak after a
    /// step, and says whether all are at rest.
    pub(super) fn relax(&mut self, dt: f64) {
        let Some(scene::Relaxation { residual }) = self.settings.time.relax else { return };
        let start = Instant::now();
        self.state.relaxation.since += dt;
        self.state.relaxation.last_step = dt;
        let [now, before] = self.state.relaxation.kinetic;
        if now < before && !self.all_have_grids() {
            self.stop();
        }
        let moved = |velocity: [f64; 3]| velocity != [0.0; 3];
        let driven = |motion: &RigidMotion| moved(motion.velocity()) || moved(motion.spin());
        let bodies = &self.state.bodies;
        let mut motions = self.settings.rigid.iter().filter_map(|&body| bodies[body].motion.as_deref());
        let balanced = self.state.relaxation.residual <= residual;
        let (time, dt) = (self.state.time, self.stable());
        let end = self.settings.time.end;
        let still = !self.settings.rules.grow(time)
            && self.settings.gravity.is_still(time, dt, end)
            && self.settings.loads.iter().all(|load| load.is_still(time, dt, end));
        let resting = balanced && still && !motions.any(driven);
        self.state.relaxation.at_rest = resting && {
            let [kinetic, strain] = self.energies();
            kinetic <= residual * residual * strain
        };
        self.watch.lap("relaxation", start);
    }

    /// Whether all deformable bodies are on grids of their own.
    pub(super) fn all_have_grids(&self) -> bool {
        self.settings.references.len() + self.settings.rigid.len() == self.state.bodies.len()
    }

    /// Kinetic and strain energy of the deformable bodies [J].
    fn energies(&mut self) -> [f64; 2] {
        self.show_references();
        let totals = self.totals();
        let free = totals.iter().filter(|(body, _)| !self.state.bodies[*body].is_rigid());
        // The first rank knows the totals of all bodies.
        self.first_says(free.fold([0.0; 2], |[kinetic, strain], (_, totals)| {
            [kinetic + totals.kinetic, strain + totals.strain]
        }))
    }

    /// Takes all velocities from the deformable bodies.
    fn stop(&mut self) {
        self.state.damping += self.energies()[0];
        each(&mut self.state.bodies, 1, |_, body| {
            if let Some(body) = body.here_mut().filter(|body| !body.is_rigid()) {
                body.particles.stop();
            }
        });
        self.state.references.nodes.iter_mut().for_each(|nodes| nodes.velocities.fill(Vector::ZERO));
        *self.workspace.totals.get_mut().unwrap_or_else(PoisonError::into_inner) = None;
        self.state.relaxation.peaks += 1;
        self.state.relaxation.kinetic = [0.0; 2];
        self.state.relaxation.since = 0.0;
    }
}
