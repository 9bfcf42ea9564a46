//! How far many runs have come: bars on a terminal, a line for each run that ends elsewhere.

use crate::progress::{PARTS, duration, style, terminal};
use crate::tell::tell;
use indicatif::{MultiProgress, ProgressBar};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;
use stickslip::run::Progress;

/// Shows the progress of many runs on standard error.
pub struct Board {
    bars: Option<MultiProgress>,
    ended: AtomicUsize,
    all: usize,
}

/// One run on the board.
pub struct Lane<'a> {
    board: &'a Board,
    bar: Option<ProgressBar>,
    name: &'a str,
    start: Instant,
}

impl Board {
    /// A board for runs that are to be done, besides others whose results are there already.
    pub fn new(runs: usize, kept: usize) -> Self {
        if kept > 0 {
            tell!("{kept} runs are there already");
        }
        let bars = terminal().then(MultiProgress::new);
        Board { bars, ended: AtomicUsize::new(0), all: runs }
    }

    /// A run begins.
    pub fn start<'a>(&'a self, name: &'a str) -> Lane<'a> {
        let bar = self.bars.as_ref().map(|bars| bars.add(ProgressBar::new(PARTS).with_style(style())));
        if let Some(bar) = &bar {
            bar.set_message(name.to_owned());
        }
        Lane { board: self, bar, name, start: Instant::now() }
    }

    /// Takes the bars away.
    pub fn clear(&self) {
        if let Some(bars) = &self.bars {
            // Bars that stay are no reason to fail.
            let _ = bars.clear();
        }
    }

    fn say(&self, line: &str) {
        match &self.bars {
            // A terminal that does not take the line is no reason to fail.
            Some(bars) => drop(bars.println(line)),
            None => tell!("{line}"),
        }
    }
}

impl Lane<'_> {
    /// Shows how far the run is.
    pub fn show(&self, progress: &Progress) {
        if let Some(bar) = &self.bar {
            bar.set_position((progress.share() * PARTS as f64) as u64);
            bar.set_message(format!("{}, {} left", self.name, duration(progress.eta)));
        }
    }

    /// The run has ended, well or with an error.
    pub fn end(self, error: Option<&str>) {
        if let (Some(bar), Some(bars)) = (&self.bar, &self.board.bars) {
            bars.remove(bar);
        }
        let number = self.board.ended.fetch_add(1, Ordering::Relaxed) + 1;
        let took = duration(self.start.elapsed().as_secs_f64());
        let outcome = error.map_or(took, |error| format!("failed: {error}"));
        self.board.say(&format!("{number} of {}: {}, {outcome}", self.board.all, self.name));
    }
}
