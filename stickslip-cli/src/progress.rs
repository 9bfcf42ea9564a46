//! How far a run has come: a bar on a terminal, a line now and then elsewhere, or lines for programs.

use crate::drawing::prefix;
use crate::tell::tell;
use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::io::IsTerminal;
use std::time::{Duration, Instant};
use stickslip::run::Progress;

/// How progress is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ProgressForm {
    /// A bar on a terminal, a line every ten seconds elsewhere
    Auto,
    /// A line of JSON every second on standard error, for programs
    Json,
    /// Nothing but warnings
    None,
}

/// Whether standard error is a terminal that can write over a line, and show colours.
pub fn terminal() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("TERM").is_none_or(|kind| kind != "dumb")
}

/// Shows the progress of one run on standard error.
pub struct Display {
    form: ProgressForm,
    bar: Option<ProgressBar>,
    next_line: Cell<Instant>,
    trend: RefCell<Trend>,
}

/// Parts of a bar.
pub const PARTS: u64 = 1000;
/// Wall time between two lines where there is no terminal.
const BETWEEN_LINES: Duration = Duration::from_secs(10);
/// The same for programs.
const BETWEEN_RECORDS: Duration = Duration::from_secs(1);

impl Display {
    /// A display for a run until a simulated time [s].
    pub fn new(end: f64, form: ProgressForm) -> Self {
        let bar =
            (form == ProgressForm::Auto && terminal()).then(|| ProgressBar::new(PARTS).with_style(style()));
        if let Some(bar) = &bar {
            bar.set_message(format!("t = 0 of {end} s"));
        }
        let first = if form == ProgressForm::Json { Duration::ZERO } else { BETWEEN_LINES };
        Display { form, bar, next_line: Cell::new(Instant::now() + first), trend: RefCell::default() }
    }

    /// Shows the present state.
    pub fn show(&self, progress: &Progress) {
        if self.form != ProgressForm::None {
            progress.news.iter().for_each(|line| self.say(line));
        }
        for note in &progress.notes {
            self.say(&format!("t = {:.4e} s: warning: {note}", progress.time));
        }
        let rest = progress.relaxation.map(|state| {
            let mut trend = self.trend.borrow_mut();
            trend.see(Instant::now(), state.residual);
            format!("residual {:.1e}, {}", state.residual, trend.told())
        });
        if let Some(bar) = &self.bar {
            bar.set_position((progress.share() * PARTS as f64) as u64);
            bar.set_message(line(progress, rest.as_deref(), room()));
        } else if self.form != ProgressForm::None && Instant::now() >= self.next_line.get() {
            let (line, pause) = match self.form {
                ProgressForm::Json => (record(progress), BETWEEN_RECORDS),
                _ => (line(progress, rest.as_deref(), usize::MAX), BETWEEN_LINES),
            };
            tell!("{line}");
            self.next_line.set(Instant::now() + pause);
        }
    }

    /// Says something beside the progress; to programs as a record.
    fn say(&self, line: &str) {
        match &self.bar {
            Some(bar) => bar.println(line),
            None if self.form == ProgressForm::Json => tell!("{}", json!({ "message": line })),
            None => tell!("{line}"),
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
    let style = ProgressStyle::with_template("{bar:16.cyan/dim} {percent:>3} %  {wide_msg}");
    style.expect("the template is well formed").progress_chars("━╸─")
}

/// Columns that the bar leaves for a message.
fn room() -> usize {
    usize::from(console::Term::stderr().size().1).saturating_sub(24)
}

/// Shows the progress of a family of runs on standard error: a bar for all of them, or a line when one ends.
pub struct FamilyDisplay {
    bar: Option<ProgressBar>,
    shares: Vec<f64>,
    ended: usize,
}

impl FamilyDisplay {
    /// A display for so many runs.
    pub fn new(runs: usize, terminal: bool) -> Self {
        let bar = terminal.then(|| ProgressBar::new(PARTS).with_style(style()));
        if let Some(bar) = &bar {
            bar.set_message(format!("0 of {runs} runs"));
        }
        FamilyDisplay { bar, shares: vec![0.0; runs], ended: 0 }
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
            None => tell!("{line}"),
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// How the residual of dynamic relaxation changes in wall time: the straight line through its logarithms.
#[derive(Default)]
struct Trend(VecDeque<(Instant, f64)>);

/// Wall time over which it is looked at.
const SEEN: Duration = Duration::from_secs(10);
/// Wall time below which it says nothing.
const LEAST_SEEN: f64 = 1.0;

impl Trend {
    fn see(&mut self, now: Instant, residual: f64) {
        if residual > 0.0 {
            self.0.push_back((now, residual.ln()));
        }
        while self.0.front().is_some_and(|(then, _)| now.duration_since(*then) > SEEN) {
            self.0.pop_front();
        }
    }

    /// In words.
    fn told(&self) -> String {
        let (Some(first), Some(last)) = (self.0.front(), self.0.back()) else { return "at rest".to_owned() };
        if last.0.duration_since(first.0).as_secs_f64() < LEAST_SEEN {
            return "its trend is not known yet".to_owned();
        }
        let points = self.0.iter().map(|(then, log)| (then.duration_since(first.0).as_secs_f64(), *log));
        let count = self.0.len() as f64;
        let [time, log] = points.clone().fold([0.0, 0.0], |[x, y], (a, b)| [x + a / count, y + b / count]);
        let [across, along] = points
            .fold([0.0, 0.0], |[xy, xx], (a, b)| [xy + (a - time) * (b - log), xx + (a - time) * (a - time)]);
        let slope = across / along;
        let tenfold = std::f64::consts::LN_10 / slope.abs();
        match slope {
            // In the time that is looked at it changes by less than a quarter.
            slope if slope.abs() * SEEN.as_secs_f64() < 0.25 => "no longer falling".to_owned(),
            slope if slope < 0.0 => format!("a tenth of it in {}", duration(tenfold)),
            _ => "growing".to_owned(),
        }
    }
}

/// The time left, or how far from rest the bodies are, and as much of the rest as has room in so many columns.
fn line(progress: &Progress, settling: Option<&str>, room: usize) -> String {
    let rate = prefix(progress.particle_steps_per_second);
    // A wave crosses the paper's disks in a microsecond.
    let time = match progress.end < 1e-2 {
        true => format!("{:.3e} of {:.3e}", progress.time, progress.end),
        false => format!("{:.4} of {}", progress.time, progress.end),
    };
    let pace = progress.particle_steps_per_second / rate.factor;
    let mut line = settling.map_or_else(|| format!("{} left", duration(progress.eta)), str::to_owned);
    let rest = [
        format!("t = {time} s"),
        format!("step {}", progress.steps),
        format!("{pace:.1} {} particle-steps/s", rate.letter),
    ];
    for part in rest {
        if line.len() + 2 + part.len() > room {
            break;
        }
        line = format!("{line}, {part}");
    }
    line
}

/// The same for programs, in SI units; what is not known yet is null.
fn record(progress: &Progress) -> String {
    let Progress { time, end, steps, particles, particle_steps_per_second, eta, relaxation, .. } = progress;
    let record = json!({
        "time": time,
        "end": end,
        "steps": steps,
        "particles": particles,
        "particle_steps_per_second": particle_steps_per_second,
        "seconds_left": eta,
        "residual": relaxation.map(|state| state.residual),
    });
    record.to_string()
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
            relaxation: None,
            news: Vec::new(),
            notes: Vec::new(),
        };
        let whole = "3 min 20 s left, t = 0.5000 of 2 s, step 321, 2.5 M particle-steps/s";
        assert_eq!(line(&progress, None, usize::MAX), whole);
        // Beside the bar on a terminal of 80 columns.
        assert_eq!(line(&progress, None, 56), "3 min 20 s left, t = 0.5000 of 2 s, step 321");
        assert_eq!(line(&progress, None, 5), "3 min 20 s left");
        let record: serde_json::Value = serde_json::from_str(&record(&progress)).expect("JSON");
        assert_eq!((&record["seconds_left"], &record["steps"]), (&json!(200.0), &json!(321)));
    }

    /// A residual that falls to a tenth every four seconds, one that stays, and one that grows.
    #[test]
    fn the_trend_of_a_residual_is_told() {
        let begun = Instant::now();
        let told = |tenths_per_second: f64| {
            let mut trend = Trend::default();
            assert_eq!(trend.told(), "at rest");
            for i in 0..200 {
                let time = 0.1 * f64::from(i);
                let noise = 1.0 + 0.2 * (7.0 * time).sin();
                trend.see(
                    begun + Duration::from_secs_f64(time),
                    noise * 10_f64.powf(-tenths_per_second * time),
                );
                if i == 3 {
                    assert_eq!(trend.told(), "its trend is not known yet");
                }
            }
            trend.told()
        };
        assert_eq!([0.26, 0.0, -0.1].map(told), ["a tenth of it in 4 s", "no longer falling", "growing"]);
        let relaxing = Progress {
            time: 0.5,
            end: 2.0,
            steps: 321,
            particles: 1000,
            particle_steps_per_second: 2.5e6,
            eta: f64::INFINITY,
            relaxation: None,
            news: Vec::new(),
            notes: Vec::new(),
        };
        let whole = "residual 1e-2, growing, t = 0.5000 of 2 s, step 321, 2.5 M particle-steps/s";
        assert_eq!(line(&relaxing, Some("residual 1e-2, growing"), usize::MAX), whole);
    }

    #[test]
    fn durations_read_well() {
        assert_eq!(duration(3.2), "4 s");
        assert_eq!(duration(3725.0), "1 h 02 min");
        assert_eq!(duration(f64::INFINITY), "unknown time");
    }
}
