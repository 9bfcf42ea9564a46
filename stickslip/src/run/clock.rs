//! Wall time of a run: how fast it goes and how long it will take.

use crate::door::{RelaxationState, View};
use crate::observe::{Memory, OutputError, Performance, Timing};
use serde::{Deserialize, Serialize};
use std::time::{Duration, Instant};

/// How far a run has come.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Simulated time [s].
    pub time: f64,
    /// Simulated time at which the run ends [s].
    pub end: f64,
    /// Steps taken.
    pub steps: u64,
    /// Particles in all bodies.
    pub particles: usize,
    /// Particles times steps over wall time, outputs included [1/s].
    pub particle_steps_per_second: f64,
    /// Wall time left at the present pace [s]; infinite while there is no pace yet, and where the run ends at rest.
    pub eta: f64,
    /// How far dynamic relaxation has come, which ends at rest and hardly ever at `end`.
    pub relaxation: Option<RelaxationState>,
    /// What happens now, which is no cause for worry.
    pub news: Vec<String>,
    /// What the user should know now and need not ask for: contact that is not resolved, results that are doubtful.
    pub notes: Vec<String>,
}

impl Progress {
    /// Part of the simulated time that is done, from 0 to 1.
    pub fn share(&self) -> f64 {
        if self.end > 0.0 { (self.time / self.end).clamp(0.0, 1.0) } else { 1.0 }
    }
}

/// Wall time between two reports of progress.
const REPORT: Duration = Duration::from_millis(100);

/// What a run does beside the steps.
#[derive(Clone, Copy, Debug)]
pub(super) enum Beside {
    /// Taking records, and waiting where the writer has too many, and for all of them at the end.
    Outputs,
    /// Of [`crate::scene::HealthCheck`], and whether contact is resolved.
    Checks,
    /// Taking the state for a checkpoint, and waiting for the last one.
    Checkpoints,
}

impl Beside {
    /// Their names among the timings.
    const NAMES: [&str; 3] = ["outputs", "checks", "checkpoints"];
}

/// When and where a run started.
pub(super) struct RunClock {
    start: Instant,
    threads: usize,
    first_time: f64,
    first_step: u64,
    /// What was done before this was taken up.
    before: Work,
    /// How long the run did what [`Beside`] lists.
    beside: [Duration; Beside::NAMES.len()],
}

/// Steps taken, the wall time that they took, and that of each verb [s].
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Work {
    steps: u64,
    wall_time: f64,
    timings: Vec<Timing>,
}

impl RunClock {
    pub(super) fn start(view: &dyn View, threads: usize) -> Self {
        RunClock {
            start: Instant::now(),
            threads,
            first_time: view.time(),
            first_step: view.steps(),
            before: Work::default(),
            beside: [Duration::ZERO; Beside::NAMES.len()],
        }
    }

    /// Counts what was done since a moment.
    pub(super) fn count(&mut self, what: Beside, since: Instant) {
        self.beside[what as usize] += since.elapsed();
    }

    /// Keeps what was done so far, or counts from there.
    pub(super) fn remember(&mut self, view: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        let Performance { wall_time, timings, .. } = self.performance(view);
        let mut work = Work { steps: self.before.steps + view.steps() - self.first_step, wall_time, timings };
        memory.keep("work", &mut work)?;
        if memory.is_taking_up() {
            self.before = work;
        }
        Ok(())
    }

    pub(super) fn progress(&self, view: &dyn View, end: f64) -> Progress {
        let wall = self.start.elapsed().as_secs_f64();
        let time = view.time();
        let (done, relaxation) = (time - self.first_time, view.relaxation());
        let has_pace = done > 0.0 && relaxation.is_none();
        Progress {
            time,
            end,
            steps: view.steps(),
            particles: view.particles(),
            particle_steps_per_second: self.rate(view, self.before.wall_time + wall),
            eta: if has_pace { wall * (end - time) / done } else { f64::INFINITY },
            relaxation,
            news: Vec::new(),
            notes: Vec::new(),
        }
    }

    pub(super) fn performance(&self, view: &dyn View) -> Performance {
        let wall_time = self.before.wall_time + self.start.elapsed().as_secs_f64();
        let earlier = |verb: &str| self.before.timings.iter().find(|timing| timing.verb == verb);
        let beside = Beside::NAMES.into_iter().zip(self.beside.map(|time| time.as_secs_f64()));
        let timing = |(verb, seconds): (&str, f64)| {
            let seconds = seconds + earlier(verb).map_or(0.0, |timing| timing.seconds);
            Timing { verb: verb.to_string(), seconds }
        };
        Performance {
            threads: self.threads,
            particles: view.particles(),
            time: view.time(),
            steps: view.steps(),
            wall_time,
            particle_steps_per_second: self.rate(view, wall_time),
            timings: view.timings().into_iter().chain(beside).map(timing).collect(),
            ranks: Vec::new(),
        }
    }

    fn rate(&self, view: &dyn View, wall: f64) -> f64 {
        let steps = self.before.steps + view.steps() - self.first_step;
        if steps > 0 && wall > 0.0 { steps as f64 * view.particles() as f64 / wall } else { 0.0 }
    }

    pub(super) fn reports(&self) -> Reports {
        Reports { last: self.start }
    }
}

/// Tells when the next report of progress is due.
pub(super) struct Reports {
    last: Instant,
}

impl Reports {
    /// True at most once in [`REPORT`].
    pub(super) fn due(&mut self) -> bool {
        let due = self.last.elapsed() >= REPORT;
        if due {
            self.last = Instant::now();
        }
        due
    }
}
