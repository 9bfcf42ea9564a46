//! All chosen laws through all chosen benchmarks, side by side on the machine's cores.

use crate::benchmark::{Benchmark, Case, Laws, Resolution, Target, Tier};
use crate::failure::Failure;
use crate::outcome::Outcome;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use stickslip::scene::{ContactLaw, ContactRule};

/// A contact law of the engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Law {
    /// Its word in scene files.
    pub word: &'static str,
    /// When its bodies push on each other, in a sentence.
    pub meaning: &'static str,
    /// Whether scenes get it that name no law.
    pub default: bool,
    /// Which benchmarks it can be put to; `None` where nothing ever touches.
    kind: Option<Laws>,
}

/// What to run.
#[derive(Clone, Debug)]
pub struct Suite {
    /// The benchmarks.
    pub benchmarks: Vec<&'static Benchmark>,
    /// The laws.
    pub laws: Vec<Law>,
    /// How much.
    pub tier: Tier,
    /// Runs at a time; each has one thread.
    pub threads: usize,
}

/// What came of it.
#[derive(Debug)]
pub struct Report {
    /// How much was run.
    pub tier: Tier,
    /// A benchmark and a law each, benchmark by benchmark.
    pub entries: Vec<Entry>,
}

/// One law in one benchmark.
#[derive(Debug)]
pub struct Entry {
    /// The benchmark.
    pub benchmark: &'static Benchmark,
    /// The law.
    pub law: Law,
    /// From coarse to fine.
    pub runs: Vec<Run>,
}

/// One law in one benchmark at one resolution.
#[derive(Debug)]
pub struct Run {
    /// The resolution.
    pub resolution: Resolution,
    /// What was measured.
    pub result: Result<Outcome, Failure>,
}

/// A case that just ended.
#[derive(Debug)]
pub struct Finished<'a> {
    /// The benchmark.
    pub benchmark: &'static Benchmark,
    /// The law's word.
    pub law: &'static str,
    /// Cells on the benchmark's length.
    pub cells: f64,
    /// What was measured.
    pub result: &'a Result<Outcome, Failure>,
    /// How many cases have ended, this one included.
    pub done: usize,
    /// How many there are.
    pub all: usize,
}

/// How a law did by a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Reached.
    Reached,
    /// Missed, or not measured because the run went wrong.
    Missed,
    /// Stated for a resolution that was not run.
    Open,
}

/// The engine's contact laws, the default first.
pub fn laws() -> Vec<Law> {
    let mut laws: Vec<Law> = ContactLaw::words()
        .map(|(word, law, meaning)| Law {
            word,
            meaning,
            default: law == ContactRule::default().law,
            kind: match law {
                ContactLaw::None => None,
                ContactLaw::Glued => Some(Laws::Glued),
                _ => Some(Laws::Contact),
            },
        })
        .filter(|law| law.kind.is_some())
        .collect();
    laws.sort_by_key(|law| !law.default);
    laws
}

impl Suite {
    /// Runs everything; `progress` is told of each case as it ends.
    pub fn run(&self, progress: &mut dyn FnMut(&Finished)) -> Report {
        let mut entries: Vec<Entry> = Vec::new();
        for &benchmark in &self.benchmarks {
            for &law in self.laws.iter().filter(|law| law.kind == Some(benchmark.laws)) {
                entries.push(Entry { benchmark, law, runs: Vec::new() });
            }
        }
        let cases: Vec<(usize, Resolution)> = (entries.iter().enumerate())
            .flat_map(|(i, entry)| {
                let due = entry.benchmark.resolutions.iter().filter(|r| r.tier <= self.tier);
                due.map(move |&resolution| (i, resolution))
            })
            .collect();
        let jobs: Vec<(&'static Benchmark, Case)> = (cases.iter())
            .map(|&(i, Resolution { cells, .. })| {
                (entries[i].benchmark, Case { law: entries[i].law.word, cells, tier: self.tier })
            })
            .collect();
        let results = side_by_side(&jobs, self.threads, progress);
        for ((entry, resolution), result) in cases.into_iter().zip(results) {
            entries[entry].runs.push(Run { resolution, result });
        }
        Report { tier: self.tier, entries }
    }
}

/// Runs the cases on so many threads, each with its engine on one thread, and returns the results in the order of the cases.
fn side_by_side(
    jobs: &[(&'static Benchmark, Case)],
    threads: usize,
    progress: &mut dyn FnMut(&Finished),
) -> Vec<Result<Outcome, Failure>> {
    let next = AtomicUsize::new(0);
    let mut results: Vec<Option<Result<Outcome, Failure>>> = jobs.iter().map(|_| None).collect();
    std::thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for _ in 0..threads.clamp(1, jobs.len().max(1)) {
            let (sender, next) = (sender.clone(), &next);
            scope.spawn(move || {
                let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build();
                let alone = alone.expect("the system has one more thread");
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    let Some((benchmark, case)) = jobs.get(number) else { break };
                    let result = alone.install(|| (benchmark.run)(case));
                    sender.send((number, result)).expect("whoever started this waits for it");
                }
            });
        }
        drop(sender);
        for (done, (number, result)) in receiver.into_iter().enumerate() {
            let (benchmark, Case { law, cells, .. }) = jobs[number];
            progress(&Finished { benchmark, law, cells, result: &result, done: done + 1, all: jobs.len() });
            results[number] = Some(result);
        }
    });
    results.into_iter().map(|result| result.expect("every case ends")).collect()
}

impl Entry {
    /// The run that a target is judged by: at the resolution it is stated for, else the finest.
    pub fn judged(&self, target: &Target) -> Option<&Run> {
        match target.at {
            Some(cells) => self.runs.iter().find(|run| run.resolution.cells == cells),
            None => self.runs.last(),
        }
    }

    /// How the law did by a target.
    pub fn verdict(&self, target: &Target) -> Verdict {
        let Some(run) = self.judged(target) else { return Verdict::Open };
        match &run.result {
            Ok(outcome) if outcome.value(target.metric).is_some_and(|value| target.holds(value)) => {
                Verdict::Reached
            }
            _ => Verdict::Missed,
        }
    }

    /// How the law did by all targets: missed if one is, open if all are.
    pub fn overall(&self) -> Verdict {
        let verdicts: Vec<_> = self.benchmark.targets.iter().map(|target| self.verdict(target)).collect();
        match () {
            () if verdicts.contains(&Verdict::Missed) => Verdict::Missed,
            () if verdicts.contains(&Verdict::Reached) => Verdict::Reached,
            () => Verdict::Open,
        }
    }

    /// Observed order of convergence of a target's quantity between the two finest runs; `None` with fewer, or where an error is nothing.
    ///
    /// ```text
    /// p = ln(e_k / e_(k+1)) / ln(n_(k+1) / n_k),   e = |measured - exact|,  n cells;   log2(e_k / e_(k+1)) where cells double
    /// ```
    pub fn order(&self, target: &Target) -> Option<f64> {
        let error = |run: &Run| {
            let value = run.result.as_ref().ok()?.value(target.metric)?;
            let error = (value - target.exact).abs();
            (error > NOTHING && error.is_finite()).then_some((run.resolution.cells, error))
        };
        let [.., coarse, fine] = &self.runs[..] else { return None };
        let ((n, e), (finer, less)) = (error(coarse)?, error(fine)?);
        Some((e / less).ln() / (finer / n).ln())
    }
}

/// Errors below this are round-off.
const NOTHING: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::benchmark::Allowed;

    const TARGETS: &[Target] = &[
        Target::new("error", 0.0, Allowed::Within(0.02), "a test"),
        Target::new("late", 1.0, Allowed::AtLeast(0.9), "a test").at(40.0),
    ];

    /// An error of 1/n^2; with the law "traction" the finest run fails.
    fn square(case: &Case) -> Result<Outcome, Failure> {
        if case.law == "traction" && case.cells > 15.0 {
            return Err(Failure::Absent("a test"));
        }
        let mut outcome = Outcome::default();
        outcome.measure("error", 1.0 / case.cells.powi(2));
        Ok(outcome)
    }

    static BENCHMARK: Benchmark = Benchmark {
        name: "test",
        title: "a test",
        source: "",
        picture: "",
        set_up: "",
        exact: "",
        laws: Laws::Contact,
        measure: "n",
        resolutions: &[
            Resolution::quick(5.0),
            Resolution::quick(10.0),
            Resolution::quick(20.0),
            Resolution::full(40.0),
        ],
        targets: TARGETS,
        run: square,
    };

    #[test]
    fn order_and_verdicts_come_from_the_finest_runs_however_many_threads() {
        for threads in [1, 3] {
            let suite = Suite { benchmarks: vec![&BENCHMARK], laws: laws(), tier: Tier::Quick, threads };
            let mut seen = 0;
            let report = suite.run(&mut |finished| {
                seen += 1;
                assert_eq!((finished.done, finished.all), (seen, 3 * report_laws()));
            });
            assert_eq!(seen, 3 * report_laws());
            for entry in &report.entries {
                let cells: Vec<_> = entry.runs.iter().map(|run| run.resolution.cells).collect();
                assert_eq!(cells, [5.0, 10.0, 20.0]);
                let [error, late] = TARGETS else { panic!("two targets") };
                assert_eq!(entry.verdict(late), Verdict::Open);
                let fails = entry.law.word == "traction";
                assert_eq!(entry.verdict(error), if fails { Verdict::Missed } else { Verdict::Reached });
                assert_eq!(entry.overall(), entry.verdict(error));
                assert_eq!(entry.order(error).map(|p| (p * 1e9).round() / 1e9), (!fails).then_some(2.0));
            }
        }
    }

    fn report_laws() -> usize {
        laws().iter().filter(|law| law.kind == Some(Laws::Contact)).count()
    }

    #[test]
    fn laws_are_the_engines_with_the_default_first() {
        let laws = laws();
        assert!(laws[0].default && laws.iter().filter(|law| law.default).count() == 1);
        assert!(laws.iter().any(|law| law.word == "traction") && laws.iter().all(|law| law.word != "none"));
    }
}
