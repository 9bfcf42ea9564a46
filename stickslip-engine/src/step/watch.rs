//! Wall time by verb; verbs of a kind share a name, such as `grid` or `contact`. Nothing in the step depends on it.

use std::time::{Duration, Instant};

/// Wall time spent in each verb, in the order of first use.
#[derive(Clone, Debug, Default)]
pub struct Stopwatch {
    laps: Vec<(&'static str, Duration)>,
}

impl Stopwatch {
    /// Adds the time since `start` to a verb.
    pub fn lap(&mut self, verb: &'static str, start: Instant) {
        let elapsed = start.elapsed();
        match self.laps.iter_mut().find(|(name, _)| *name == verb) {
            Some((_, total)) => *total += elapsed,
            None => self.laps.push((verb, elapsed)),
        }
    }

    /// Seconds by verb.
    pub fn seconds(&self) -> Vec<(&'static str, f64)> {
        self.laps.iter().map(|(verb, total)| (*verb, total.as_secs_f64())).collect()
    }
}
