//! All chosen laws and schemes through all chosen benchmarks, side by side on the machine's cores.

use crate::benchmark::{Benchmark, Case, Laws, Miss, Resolution, Target, Tier};
use crate::failure::CaseFailure;
use crate::outcome::Outcome;
use crate::own_grids::{common_grid_only, is_not_measured, own_misses, own_reasons};
use crate::scheme::{Scheme, schemes};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use stickslip::scene::{ContactLaw, ContactRule};

/// A contact law of the engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LawUnderTest {
    /// Its word in scene files.
    pub word: &'static str,
    /// When its bodies push on each other, in a sentence.
    pub meaning: &'static str,
    /// Whether scenes get it that name no law.
    pub default: bool,
    /// The law itself.
    pub law: ContactLaw,
}

/// What a benchmark is put to: a contact law, or a scheme of the step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Candidate {
    /// A contact law, by the scheme of scenes that name none.
    Law(LawUnderTest),
    /// A scheme, with the contact law of scenes that name none.
    Scheme(&'static Scheme),
    /// Bodies on grids of their own, which elastic ones get by default.
    Own,
}

/// What to run.
#[derive(Clone, Debug)]
pub struct Suite {
    /// The benchmarks.
    pub benchmarks: Vec<&'static Benchmark>,
    /// The laws for benchmarks of contact.
    pub laws: Vec<LawUnderTest>,
    /// The schemes for benchmarks of the step itself, [`Laws::Bulk`].
    pub schemes: Vec<&'static Scheme>,
    /// Whether bodies on grids of their own are put to all benchmarks that they can be put to.
    pub own: bool,
    /// How much.
    pub tier: Tier,
    /// Runs at a time; each has one thread.
    pub threads: usize,
}

/// What came of it.
#[derive(Debug)]
pub struct SuiteReport {
    /// How much was run.
    pub tier: Tier,
    /// A benchmark and a law or scheme each, benchmark by benchmark.
    pub entries: Vec<SuiteEntry>,
}

/// One law or scheme in one benchmark.
#[derive(Debug)]
pub struct SuiteEntry {
    /// The benchmark.
    pub benchmark: &'static Benchmark,
    /// The law or scheme.
    pub way: Candidate,
    /// Those that have ended, from coarse to fine.
    pub runs: Vec<Run>,
}

/// One law or scheme in one benchmark at one resolution.
#[derive(Debug)]
pub struct Run {
    /// The resolution.
    pub resolution: Resolution,
    /// What was measured.
    pub result: Result<Outcome, CaseFailure>,
}

/// A case that just ended.
#[derive(Debug)]
pub struct Finished<'a> {
    /// Benchmark, and law or scheme.
    pub entry: &'a SuiteEntry,
    /// Resolution and result.
    pub run: &'a Run,
    /// How many cases have ended, this one included.
    pub done: usize,
    /// How many there are.
    pub all: usize,
}

/// How a law or scheme did by a target.
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
pub fn laws() -> Vec<LawUnderTest> {
    let mut laws: Vec<LawUnderTest> = ContactLaw::words()
        .map(|(word, law, meaning)| LawUnderTest {
            word,
            meaning,
            default: law == ContactRule::default().law,
            law,
        })
        .collect();
    laws.sort_by_key(|law| !law.default);
    laws
}

impl Suite {
    /// Runs everything, coarse resolutions before fine ones; `progress` is told of each case as it ends, and of all
    /// that have ended so far.
    pub fn run(&self, progress: &mut dyn FnMut(&Finished, &SuiteReport)) -> SuiteReport {
        let mut report = SuiteReport { tier: self.tier, entries: Vec::new() };
        let mut jobs: Vec<CaseJob> = Vec::new();
        for &benchmark in &self.benchmarks {
            for way in self.ways(benchmark) {
                for (rank, &resolution) in benchmark.due(self.tier).enumerate() {
                    let case = way.case(resolution, self.tier);
                    jobs.push(CaseJob { entry: report.entries.len(), rank, benchmark, resolution, case });
                }
                report.entries.push(SuiteEntry { benchmark, way, runs: Vec::new() });
            }
        }
        jobs.sort_by_key(|job| job.rank);
        let mut done = 0;
        side_by_side(&jobs, self.threads, &mut |number, result| {
            let CaseJob { entry, resolution, .. } = jobs[number];
            let runs = &mut report.entries[entry].runs;
            let place = runs.partition_point(|run| run.resolution.cells < resolution.cells);
            runs.insert(place, Run { resolution, result });
            done += 1;
            let entry = &report.entries[entry];
            progress(&Finished { entry, run: &entry.runs[place], done, all: jobs.len() }, &report);
        });
        report
    }

    /// The chosen laws or schemes that a benchmark can be put to.
    fn ways(&self, benchmark: &Benchmark) -> Vec<Candidate> {
        let own = (self.own && common_grid_only(benchmark).is_none()).then_some(Candidate::Own);
        let fit = |law: &&LawUnderTest| benchmark.laws.contains(law.law);
        let laws = self.laws.iter().filter(fit).copied().map(Candidate::Law);
        let schemes = self.schemes.iter().copied().map(Candidate::Scheme);
        match benchmark.laws {
            Laws::Bulk => own.into_iter().chain(schemes).collect(),
            _ => own.into_iter().chain(laws).collect(),
        }
    }
}

impl Candidate {
    /// Its word on the command line.
    pub fn word(&self) -> &'static str {
        match self {
            Candidate::Law(law) => law.word,
            Candidate::Scheme(scheme) => &scheme.word,
            Candidate::Own => "own",
        }
    }

    /// What it does, in a sentence.
    pub fn meaning(&self) -> &'static str {
        match self {
            Candidate::Law(law) => law.meaning,
            Candidate::Scheme(scheme) => &scheme.meaning,
            Candidate::Own => {
                "points of surfaces that lie inside of a partner, of bodies on grids of their own"
            }
        }
    }

    /// Whether scenes get it that name none.
    pub fn is_default(&self) -> bool {
        match self {
            Candidate::Law(law) => law.default,
            Candidate::Scheme(scheme) => scheme.default,
            Candidate::Own => false,
        }
    }

    /// Whether targets are asked of it, and not only figures to compare.
    fn is_required(&self) -> bool {
        let is_glued = matches!(self, Candidate::Law(LawUnderTest { law: ContactLaw::Glued, .. }));
        self.is_default() || is_glued || *self == Candidate::Own
    }

    fn case(&self, resolution: Resolution, tier: Tier) -> Case {
        let usual = Case {
            law: laws()[0].word,
            interior: "grid",
            scheme: &schemes()[0],
            cells: resolution.cells,
            tier,
        };
        match self {
            Candidate::Law(law) => Case { law: law.word, ..usual },
            Candidate::Scheme(scheme) => Case { scheme, ..usual },
            Candidate::Own => Case { interior: "reference", ..usual },
        }
    }
}

/// A case of a benchmark, and whose it is.
struct CaseJob {
    entry: usize,
    /// How many resolutions of the benchmark are coarser.
    rank: usize,
    benchmark: &'static Benchmark,
    resolution: Resolution,
    case: Case,
}

/// Does the jobs on so many threads, each with its engine on one thread, and hands on each result, here, as it comes.
fn side_by_side(
    jobs: &[CaseJob],
    threads: usize,
    receive: &mut dyn FnMut(usize, Result<Outcome, CaseFailure>),
) {
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for _ in 0..threads.clamp(1, jobs.len().max(1)) {
            let (sender, next) = (sender.clone(), &next);
            scope.spawn(move || {
                let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build();
                let alone = alone.expect("the system has one more thread");
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    let Some(CaseJob { benchmark, case, .. }) = jobs.get(number) else { break };
                    // A fault of the program in one case must not lose the others.
                    let result = catch_unwind(AssertUnwindSafe(|| alone.install(|| (benchmark.run)(case))));
                    let result = result.unwrap_or(Err(CaseFailure::Panic));
                    sender.send((number, result)).expect("whoever started this waits for it");
                }
            });
        }
        drop(sender);
        receiver.into_iter().for_each(|(number, result)| receive(number, result));
    });
}

impl SuiteEntry {
    /// The run that a target is judged by: at the resolution it is stated for, else the finest.
    pub fn judged(&self, target: &Target) -> Option<&Run> {
        match target.at {
            Some(cells) => self.runs.iter().find(|run| run.resolution.cells == cells),
            None => self.runs.last(),
        }
    }

    /// How the law or scheme did by a target.
    pub fn verdict(&self, target: &Target) -> Verdict {
        let Some(run) = self.judged(target) else { return Verdict::Open };
        match &run.result {
            Ok(outcome) => match outcome.value(target.metric) {
                Some(value) if target.is_met_by(value) => Verdict::Reached,
                None if self.is_exempt(target) => Verdict::Open,
                _ => Verdict::Missed,
            },
            Err(_) => Verdict::Missed,
        }
    }

    /// Regressions of the law or scheme that scenes get which name none, or of glue: targets that it misses and is not
    /// known to miss there, or misses by more than is known. Nothing is asked of others, which are there to be
    /// compared.
    pub fn broken(&self) -> impl Iterator<Item = &'static Target> {
        let required = self.way.is_required();
        let known = |target: &Target| {
            self.judged(target).is_some_and(|run| {
                let value = run.result.as_ref().ok().and_then(|outcome| outcome.value(target.metric));
                value.is_some_and(|value| target.is_known(value, run.resolution.cells, self.misses(target)))
            })
        };
        let targets = self.benchmark.targets.iter().filter(move |_| required);
        targets.filter(move |target| self.verdict(target) == Verdict::Missed && !known(target))
    }

    /// Where it is known to miss a target.
    pub fn misses(&self, target: &Target) -> &'static [Miss] {
        if self.way == Candidate::Own { own_misses(self.benchmark, target) } else { target.misses }
    }

    /// Whether a target is of a variant that grids of their own do not have.
    pub fn is_exempt(&self, target: &Target) -> bool {
        self.way == Candidate::Own && is_not_measured(self.benchmark, target)
    }

    /// Why it misses targets, as far as that is known.
    pub fn reasons(&self) -> Vec<&'static str> {
        match self.way {
            Candidate::Own => own_reasons(self.benchmark).collect(),
            _ => self.benchmark.reasons(self.way.word()).collect(),
        }
    }

    /// How the law or scheme did by all targets: missed if one is, open if all are.
    pub fn overall(&self) -> Verdict {
        let verdicts: Vec<_> = self.benchmark.targets.iter().map(|target| self.verdict(target)).collect();
        match () {
            () if verdicts.contains(&Verdict::Missed) => Verdict::Missed,
            () if verdicts.contains(&Verdict::Reached) => Verdict::Reached,
            () => Verdict::Open,
        }
    }

    /// Observed order of convergence of a target's quantity between the two finest runs; `None` with fewer, or where an
    /// error is nothing.
    ///
    /// ```text
    /// p = ln(e_k / e_(k+1)) / ln(n_(k+1) / n_k),   e = |measured - exact|,  n cells
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
    use crate::benchmark::{Allowed, Laws};

    const TARGETS: &[Target] = &[
        Target::new("error", 0.0, Allowed::Within(0.02), "a test"),
        Target::new("late", 1.0, Allowed::AtLeast(0.9), "a test").at(40.0),
    ];
    const TOO_MUCH: &[Target] = &[
        Target::new("error", 0.0, Allowed::Within(1e-6), "a test"),
        Target::new("error", 0.0, Allowed::Within(1e-6), "a test")
            .missed(&[Miss { cells: 20.0, off: 0.003 }]),
        Target::new("error", 0.0, Allowed::Within(1e-6), "a test")
            .missed(&[Miss { cells: 10.0, off: 0.003 }]),
        Target::new("error", 0.0, Allowed::Within(1e-6), "a test")
            .missed(&[Miss { cells: 20.0, off: 0.002 }]),
        Target::new("not measured", 0.0, Allowed::Within(1e-6), "a test"),
    ];

    /// An error of 1/n^2; with the law "traction" the finest run fails, with "gap" by a fault.
    fn square(case: &Case) -> Result<Outcome, CaseFailure> {
        if case.law == "traction" && case.cells > 15.0 {
            return Err(CaseFailure::Absent("a test"));
        }
        assert!(case.law != "gap" || case.cells < 15.0, "a test");
        let mut outcome = Outcome::default();
        outcome.measure("error", 1.0 / case.cells.powi(2));
        Ok(outcome)
    }

    const BENCHMARK: Benchmark = Benchmark {
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
        reasons: &[],
        run: square,
    };

    static TEST: Benchmark = BENCHMARK;

    #[test]
    fn order_and_verdicts_come_from_the_finest_runs_however_many_threads() {
        for threads in [1, 3] {
            let suite = Suite {
                benchmarks: vec![&TEST],
                laws: laws(),
                schemes: Vec::new(),
                own: false,
                tier: Tier::Quick,
                threads,
            };
            let mut seen = 0;
            let mut least = 0.0;
            let report = suite.run(&mut |finished, report| {
                seen += 1;
                assert_eq!((finished.done, finished.all), (seen, 3 * report_laws()));
                assert_eq!(report.entries.iter().map(|entry| entry.runs.len()).sum::<usize>(), seen);
                let cells = finished.run.resolution.cells;
                assert!(threads > 1 || cells >= least, "{cells} after {least}");
                least = cells;
            });
            assert_eq!(seen, 3 * report_laws());
            for entry in &report.entries {
                let cells: Vec<_> = entry.runs.iter().map(|run| run.resolution.cells).collect();
                assert_eq!(cells, [5.0, 10.0, 20.0]);
                let [error, late] = TARGETS else { panic!("two targets") };
                assert_eq!(entry.verdict(late), Verdict::Open);
                let fails = ["traction", "gap"].contains(&entry.way.word());
                assert_eq!(entry.verdict(error), if fails { Verdict::Missed } else { Verdict::Reached });
                assert_eq!(entry.overall(), entry.verdict(error));
                assert_eq!(entry.order(error).map(|p| (p * 1e9).round() / 1e9), (!fails).then_some(2.0));
            }
        }
    }

    #[test]
    fn the_default_law_may_miss_what_it_is_known_to_miss_and_others_anything() {
        let demanding: &'static Benchmark =
            Box::leak(Box::new(Benchmark { targets: TOO_MUCH, name: "demanding", ..BENCHMARK }));
        let suite = Suite {
            benchmarks: vec![demanding],
            laws: laws(),
            schemes: Vec::new(),
            own: false,
            tier: Tier::Quick,
            threads: 2,
        };
        for entry in &suite.run(&mut |_, _| {}).entries {
            let broken: Vec<_> =
                entry.broken().map(|target| TOO_MUCH.iter().position(|of| of == target).unwrap()).collect();
            assert_eq!(
                broken,
                if entry.way.is_default() { &[0, 2, 3, 4][..] } else { &[] },
                "{:?}",
                entry.way
            );
        }
    }

    #[test]
    fn bulk_benchmarks_run_by_every_scheme_and_only_the_default_one_is_required() {
        let bulk: &'static Benchmark =
            Box::leak(Box::new(Benchmark { laws: Laws::Bulk, targets: TOO_MUCH, ..BENCHMARK }));
        let suite = Suite {
            benchmarks: vec![bulk, &TEST],
            laws: Vec::new(),
            schemes: schemes().iter().collect(),
            own: false,
            tier: Tier::Quick,
            threads: 1,
        };
        let entries = suite.run(&mut |_, _| {}).entries;
        let words: Vec<_> = entries.iter().map(|entry| entry.way.word()).collect();
        assert_eq!(words, schemes().iter().map(|scheme| &*scheme.word).collect::<Vec<_>>());
        for entry in &entries {
            assert_eq!(entry.broken().count() > 0, entry.way.is_default(), "{:?}", entry.way);
        }
    }

    fn report_laws() -> usize {
        laws().iter().filter(|law| Laws::Contact.contains(law.law)).count()
    }

    #[test]
    fn laws_are_the_engines_with_the_default_first() {
        let laws = laws();
        assert!(laws[0].default && laws.iter().filter(|law| law.default).count() == 1);
        assert_eq!(laws.len(), ContactLaw::words().count());
    }
}
