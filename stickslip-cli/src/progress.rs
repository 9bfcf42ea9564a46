//! How far a run has come: a bar on a terminal, a line now and then elsewhere.

use crate::drawing::prefix;
use indicatif::{ProgressBar, ProgressStyle};
use std::cell::Cell;
use std::time::{Duration, Instant};
use stickslip::run::Progress;

/// Shows the progress of one run on standard error.
pub struct Display {
    bar: Option<ProgressBar>,
    next_line: Cell<Instant>,
}

/// Parts of a bar.
pub const PARTS: u64 = 1000;
/// Wall time between two lines where there is no terminal.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

impl Display {
    /// A display for a run until a simulated time [s].
    pub fn new(end: f64, terminal: bool) -> Self {
        let bar = terminal.then(|| ProgressBar::new(PARTS).with_style(style()));
        if let Some(bar) = &bar {
            bar.set_message(format!("t = 0 of {end} s"));
        }
        Display { bar, next_line: Cell::new(Instant::now() + BETWEEN_LINES) }
    }

    /// Shows the present state.
    pub fn show(&self, progress: &Progress) {
        for line in &progress.news {
            self.bar.as_ref().map_or_else(|| eprintln!("{line}"), |bar| bar.println(line));
        }
        for note in &progress.notes {
            let line = format!("t = {:.4e} s: warning: {note}", progress.time);
            self.bar.as_ref().map_or_else(|| eprintln!("{line}"), |bar| bar.println(&line));
        }
        if let Some(bar) = &self.bar {
            bar.set_position((progress.share() * PARTS as f64) as u64);
            bar.set_message(line(progress));
        } else if Instant::now() >= self.next_line.get() {
            eprintln!("{}", line(progress));
            self.next_line.set(Instant::now() + BETWEEN_LINES);
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// What the bar of a run looks like.
pub fn style() -> ProgressStyle {
    let style = ProgressStyle::with_template("{bar:24.cyan/dim} {percent:>3} %  {wide_msg}");
    style.expect("the template is well formed").progress_chars("━╸─")
}

/// Shows the progress of a family of runs on standard error: a bar for all of them, or a line when one ends.
pub struct Family {
    bar: Option<ProgressBar>,
    shares: Vec<f64>,
    ended: usize,
}

impl Family {
    /// A display for so many runs.
    pub fn new(runs: usize, terminal: bool) -> Self {
        let bar = terminal.then(|| ProgressBar::new(PARTS).with_style(style()));
        if let Some(bar) = &bar {
            bar.set_message(format!("0 of {runs} runs"));
        }
        Family { bar, shares: vec![0.0; runs], ended: 0 }
    }

    /// The run of this number has done this share.
    pub fn show(&mut self, run: usize, share: f64) {
        self.shares[run] = share.clamp(0.0, 1.0);
        if let Some(bar) = &self.bar {
            let all = self.shares.iter().sum::<f64>() / self.shares.len() as f64;
            bar.set_position((all * PARTS as f64) as u64);
        }
    }

    /// The run of this number has ended; `line` says how.
    pub fn ended(&mut self, run: usize, line: &str) {
        self.ended += 1;
        self.show(run, 1.0);
        let line = format!("{} of {} runs, {}", self.ended, self.shares.len(), line.trim_end());
        match &self.bar {
            Some(bar) => bar.set_message(line),
            None => eprintln!("{line}"),
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

fn line(progress: &Progress) -> String {
    let rate = prefix(progress.particle_steps_per_second);
    // A wave crosses the paper's disks in a microsecond.
    let time = match progress.end < 1e-2 {
        true => format!("{:.3e} of {:.3e}", progress.time, progress.end),
        false => format!("{:.4} of {}", progress.time, progress.end),
    };
    format!(
        "t = {time} s, step {}, {:.1} {} particle-steps/s, {} left",
        progress.steps,
        progress.particle_steps_per_second / rate.factor,
        rate.letter,
        duration(progress.eta)
    )
}

/// `1 h 02 min`, `3 min 20 s`, `4 s`; unknown before there is a pace.
pub fn duration(seconds: f64) -> String {
    if !seconds.is_finite() {
        return "unknown time".to_owned();
    }
    let seconds = seconds.max(0.0).ceil() as u64;
    match (seconds / 3600, seconds / 60 % 60, seconds % 60) {
        (0, 0, seconds) => format!("{seconds} s"),
        (0, minutes, seconds) => format!("{minutes} min {seconds:02} s"),
        (hours, minutes, _) => format!("{hours} h {minutes:02} min"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_says_time_steps_pace_and_rest() {
        let progress = Progress {
            time: 0.5,
            end: 2.0,
            steps: 321,
            particles: 1000,
            particle_steps_per_second: 2.5e6,
            eta: 200.0,
            news: Vec::new(),
            notes: Vec::new(),
        };
        let expected = "t = 0.5000 of 2 s, step 321, 2.5 M particle-steps/s, 3 min 20 s left";
        assert_eq!(line(&progress), expected);
    }

    #[test]
    fn durations_read_well() {
        assert_eq!(duration(3.2), "4 s");
        assert_eq!(duration(3725.0), "1 h 02 min");
        assert_eq!(duration(f64::INFINITY), "unknown time");
    }
}
