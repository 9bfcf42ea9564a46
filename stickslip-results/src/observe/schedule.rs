//! When an output is due.

use super::file::OutputError;
use super::memory::Memory;

/// Whole multiples of an interval of simulated time, and single times besides.
///
/// The run does not shorten steps for outputs: a record is made after the first step that reaches a multiple, and
/// carries the time at which it was made. Multiples that a step jumps over are skipped. An interval of zero asks for
/// every step, an infinite one for none but the first.
#[derive(Clone, Debug)]
pub struct Schedule {
    interval: f64,
    next: f64,
    /// Time of the last record [s].
    last: Option<f64>,
    /// Single times still to come, ascending.
    single: Vec<f64>,
}

/// Part of the interval by which a record may come early, so that the rounding of summed steps does not delay it by a
/// whole step.
const EARLY: f64 = 1e-6;

impl Schedule {
    /// Due at once, then at multiples of `interval` [s].
    pub fn every(interval: f64) -> Self {
        Schedule { interval, next: f64::NEG_INFINITY, last: None, single: Vec::new() }
    }

    /// Due at these times besides, which ascend [s].
    pub(super) fn and_at(self, times: &[f64]) -> Self {
        Schedule { single: times.to_vec(), ..self }
    }

    /// The time from which the next record is due [s].
    pub fn next(&self) -> f64 {
        let single = self.single.first().map_or(f64::INFINITY, |time| time * (1.0 - EARLY));
        self.next.min(single)
    }

    /// Notes that a record was made at `time` [s].
    pub fn recorded(&mut self, time: f64) {
        let multiple = (time / self.interval + EARLY).floor() + 1.0;
        self.next = if self.interval > 0.0 { (multiple - EARLY) * self.interval } else { time };
        self.single.retain(|single| single * (1.0 - EARLY) > time);
        self.last = Some(time);
    }

    /// Whether the last record was made at `time` [s].
    pub(super) fn has(&self, time: f64) -> bool {
        self.last == Some(time)
    }

    /// Keeps when the last record was made, or goes on from there.
    pub(super) fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        let mut last = self.last;
        memory.keep("recorded", &mut last)?;
        if let Some(time) = last.filter(|_| memory.is_taking_up()) {
            self.recorded(time);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn records(interval: f64, step: f64, steps: usize) -> Vec<usize> {
        taken(Schedule::every(interval), step, steps)
    }

    fn taken(mut schedule: Schedule, step: f64, steps: usize) -> Vec<usize> {
        let mut time = 0.0;
        let mut records = Vec::new();
        for i in 0..=steps {
            if time >= schedule.next() {
                schedule.recorded(time);
                records.push(i);
            }
            time += step;
        }
        records
    }

    #[test]
    fn summed_steps_meet_the_multiples_in_spite_of_rounding() {
        assert_eq!(records(0.1, 0.01, 50), [0, 10, 20, 30, 40, 50]);
        assert_eq!(records(0.3, 0.1, 9), [0, 3, 6, 9]);
    }

    #[test]
    fn steps_longer_than_the_interval_skip_multiples() {
        assert_eq!(records(0.1, 0.25, 4), [0, 1, 2, 3, 4]);
        assert_eq!(records(0.1, 0.04, 10), [0, 3, 5, 8, 10]);
    }

    #[test]
    fn single_times_come_besides_the_multiples() {
        let schedule = || Schedule::every(0.4).and_at(&[0.1, 0.35, 0.8, 0.81]);
        assert_eq!(taken(schedule(), 0.1, 10), [0, 1, 4, 8, 9]);
        let never = Schedule::every(f64::INFINITY).and_at(&[0.3]);
        assert_eq!(taken(never, 0.1, 10), [0, 3]);
    }

    #[test]
    fn zero_asks_for_every_step_and_infinity_for_the_first() {
        assert_eq!(records(0.0, 0.25, 3), [0, 1, 2, 3]);
        assert_eq!(records(f64::INFINITY, 0.25, 3), [0]);
    }
}
