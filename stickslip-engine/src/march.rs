//! Steps to a time: the one loop of runs, examples and tests; validation and measurements of speed take its steps one
//! by one ([`March`]).

use crate::door::{Simulation, StepError};
use std::ops::ControlFlow;

/// Remainder of the way, as a part of the last step, that is rounding and not time to be simulated.
const ROUNDING: f64 = 1e-6;

/// The way of a simulation to a time, step by step.
#[derive(Clone, Copy, Debug)]
pub struct March {
    /// Where it ends [s].
    until: f64,
    /// Length of the last step [s].
    last: f64,
}

/// Why a march stopped on its way.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MarchError {
    /// A step went wrong.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A step did not bring the time forward: it is below the spacing of numbers there.
    #[error("time stands still at t = {time:.6e} s: the stable step is {step:.3e} s")]
    Stuck {
        /// Time at which it stopped [s].
        time: f64,
        /// Length of the stable step [s].
        step: f64,
    },
}

impl MarchError {
    /// What the user can try.
    pub fn advice(&self) -> &'static str {
        match self {
            MarchError::Step(error) => error.advice(),
            MarchError::Stuck { .. } => {
                "a particle is far too fast or far too compressed; look at the last frame, try a smaller time.courant"
            }
        }
    }
}

impl March {
    /// To a time [s].
    pub fn to(until: f64) -> Self {
        March { until, last: 0.0 }
    }

    /// To a time [s], after a step of this length [s].
    pub fn from(last: f64, until: f64) -> Self {
        March { until, last }
    }

    /// Takes steps and shows the simulation after each, with the step's length [s], until `look` breaks off.
    ///
    /// # Errors
    /// See [`MarchError`].
    pub fn go(
        mut self,
        simulation: &mut dyn Simulation,
        mut look: impl FnMut(&mut dyn Simulation, f64) -> ControlFlow<()>,
    ) -> Result<MarchEnd, MarchError> {
        while let Some(step) = self.step(simulation)? {
            if look(simulation, step).is_break() && !self.is_done(simulation) {
                return Ok(MarchEnd::BrokenOff);
            }
        }
        Ok(MarchEnd::Arrived)
    }

    /// Whether the end is reached, or the state at rest that dynamic relaxation looks for.
    pub fn is_done(&self, simulation: &dyn Simulation) -> bool {
        let at_rest = simulation.relaxation().is_some_and(|relaxation| relaxation.at_rest);
        at_rest || self.until - simulation.time() <= ROUNDING * self.last
    }

    /// Takes the next step and returns its length [s]; none is left at the end, which is reached exactly, and at rest.
    ///
    /// # Errors
    /// See [`MarchError`]; the simulation is left as it was when it went wrong.
    pub fn step(&mut self, simulation: &mut dyn Simulation) -> Result<Option<f64>, MarchError> {
        if self.is_done(simulation) {
            return Ok(None);
        }
        let before = simulation.time();
        simulation.step(self.longest(self.until - before, simulation))?;
        let time = simulation.time();
        if time <= before {
            return Err(MarchError::Stuck { time, step: simulation.stable_step() });
        }
        self.last = time - before;
        Ok(Some(self.last))
    }

    /// Longest next step [s].
    ///
    /// Where more than one and less than two steps remain, they are shared equally: a last step of nearly no length
    /// would divide forces by nearly nothing.
    fn longest(&self, remaining: f64, simulation: &dyn Simulation) -> f64 {
        // Asking for the stable step may cost a look at all particles: only near the end.
        if remaining > 4.0 * self.last && self.last > 0.0 {
            return remaining;
        }
        let stable = simulation.stable_step();
        if remaining > stable && remaining < 2.0 * stable { 0.5 * remaining } else { remaining }
    }
}

/// How a march ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarchEnd {
    /// At its time, or at the state at rest that dynamic relaxation looks for.
    Arrived,
    /// `look` broke it off before that.
    BrokenOff,
}

/// Steps a simulation to a time [s] and shows it after each step, with the step's length [s], until `look` breaks off.
///
/// # Errors
/// See [`MarchError`].
pub fn march(
    simulation: &mut dyn Simulation,
    until: f64,
    look: impl FnMut(&mut dyn Simulation, f64) -> ControlFlow<()>,
) -> Result<MarchEnd, MarchError> {
    March::to(until).go(simulation, look)
}
