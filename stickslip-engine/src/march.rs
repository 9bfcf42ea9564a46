//! Steps to a time: the one loop of runs, examples and tests; validation and measurements of speed take its steps one
//! by one ([`March`]).

use crate::door::{Simulation, StepError};
use crate::scene::LEAST_PART;
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// Remainder of the way, as a part of the last step, that is rounding and not time to be simulated.
const ROUNDING: f64 = 1e-6;

/// The way of a simulation to a time, step by step.
#[derive(Clone, Debug)]
pub struct March {
    /// Where it ends [s].
    until: f64,
    /// Length of the last step [s].
    last: f64,
    /// How long steps may be.
    pace: Pace,
    /// How often a step that fails is halved, at most.
    retries: usize,
    /// Whether particles may stay behind.
    unseen: bool,
    /// What failed in the last step, before it succeeded.
    failed: Option<FailedStep>,
}

/// How long steps may be, as a part of the stable one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pace {
    /// Now: halved by a step that fails, and growing back to the limit with those that do not.
    part: f64,
    /// At most.
    limit: f64,
}

/// A step that failed and was taken again.
#[derive(Clone, Debug, PartialEq)]
pub struct FailedStep {
    /// What went wrong first.
    pub error: StepError,
    /// Length of the step that succeeded, as a part of the stable one.
    pub part: f64,
}

/// So many steps as the last one was are far from the end: that may have been cut for what changes in it.
const NEAR: f64 = 4.0 / LEAST_PART;
/// By how much the part grows with each step that does not fail: it doubles in seven.
const GROWTH: f64 = 1.1;
/// The limit is never less.
const LEAST_LIMIT: f64 = 1.0 / 64.0;

impl Default for Pace {
    fn default() -> Self {
        Pace { part: 1.0, limit: 1.0 }
    }
}

impl Pace {
    /// Longest step, as a part of the stable one.
    pub fn part(&self) -> f64 {
        self.part
    }

    /// Halves all steps from now on, down to a 64th of the stable one.
    pub fn cut(&mut self) {
        self.limit = LEAST_LIMIT.max(0.5 * self.limit);
        self.part = self.part.min(self.limit);
    }

    /// Whether it is above zero and at most 1, as that of a run is.
    pub fn is_sound(&self) -> bool {
        0.0 < self.part && self.part <= self.limit && self.limit <= 1.0
    }
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
        March::from(0.0, until)
    }

    /// To a time [s], after a step of this length [s].
    pub fn from(last: f64, until: f64) -> Self {
        March { until, last, pace: Pace::default(), retries: 0, unseen: false, failed: None }
    }

    /// At this pace. A step that fails is taken again from memory, with half of its length and half of that, down to
    /// 2^-`retries` of the stable step; the state is copied before each step, unless `retries` is 0.
    pub fn with_retries(mut self, pace: Pace, retries: usize) -> Self {
        (self.pace, self.retries) = (pace, retries);
        self
    }

    /// By [steps after which particles may stay behind](Simulation::step_unseen): who looks asks them to be shown.
    pub fn unseen(mut self) -> Self {
        self.unseen = true;
        self
    }

    /// How long steps may be.
    pub fn pace(&self) -> Pace {
        self.pace
    }

    /// Halves all steps from now on, see [`Pace::cut`].
    pub fn cut(&mut self) {
        self.pace.cut();
    }

    /// What failed in the last step, before it succeeded.
    pub fn failed(&self) -> Option<&FailedStep> {
        self.failed.as_ref()
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
        let longest = self.longest(self.until - before, simulation);
        self.failed = None;
        match self.retries {
            0 => self.take_step(longest, simulation)?,
            _ => self.step_again(longest, simulation)?,
        };
        self.pace.part = self.pace.limit.min(GROWTH * self.pace.part);
        let time = simulation.time();
        if time <= before {
            return Err(MarchError::Stuck { time, step: simulation.stable_step() });
        }
        self.last = time - before;
        Ok(Some(self.last))
    }

    fn take_step(&self, longest: f64, simulation: &mut dyn Simulation) -> Result<f64, StepError> {
        if self.unseen { simulation.step_unseen(longest) } else { simulation.step(longest) }
    }

    /// Takes a step, with half of its length if it fails.
    fn step_again(&mut self, longest: f64, simulation: &mut dyn Simulation) -> Result<f64, StepError> {
        simulation.hold();
        let least = self.pace.limit * 0.5_f64.powi(self.retries as i32);
        let mut longest = longest;
        loop {
            let error = match self.take_step(longest, simulation) {
                Ok(step) => return Ok(step),
                Err(error) => error,
            };
            // Of the state before the step; it is needed to look at what failed if this was the last time.
            let tried = self.failed.as_ref().map_or(self.pace.part, |failed| failed.part);
            if tried <= least || !simulation.take_back() {
                return Err(error);
            }
            let stable = simulation.stable_step();
            let part = least.max(0.5 * tried.min(longest / stable));
            longest = part * stable;
            self.pace.part = part;
            let error = self.failed.take().map_or(error, |failed| failed.error);
            self.failed = Some(FailedStep { error, part });
        }
    }

    /// Longest next step [s].
    ///
    /// Where more than one and less than two steps remain, they are shared equally: a last step of nearly no length
    /// would divide forces by nearly nothing.
    fn longest(&self, remaining: f64, simulation: &dyn Simulation) -> f64 {
        let part = self.pace.part;
        // Asking for the stable step may cost a look at all particles: only near the end.
        if part == 1.0 && remaining > NEAR * self.last && self.last > 0.0 {
            return remaining;
        }
        let stable = part * simulation.stable_step();
        match remaining {
            remaining if remaining > stable && remaining < 2.0 * stable => 0.5 * remaining,
            // The simulation itself knows how long a whole step is.
            remaining if part == 1.0 => remaining,
            remaining => remaining.min(stable),
        }
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
