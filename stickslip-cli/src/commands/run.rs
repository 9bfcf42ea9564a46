//! `stickslip run SCENE`: from a scene file to numbers, a chart and a picture.

use super::{assignment, at_start, load, report, say, stop_on_interrupt};
use crate::failure::Failure;
use crate::illustration::illustrate;
use crate::memory;
use crate::progress::{Display, ProgressForm};
use crate::ranks;
use crate::tell::tell;
use bytesize::ByteSize;
use clap::Args;
use miette::{IntoDiagnostic, miette};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use stickslip::check::{free_memory, pairs_without_friction};
use stickslip::door::{RankShare, Simulation};
use stickslip::observe::{
    ArrivalRow, FrontSpeedRow, Manifest, Patience, Performance, Results, SceneSource, Status,
};
use stickslip::run::{Checkpointing, Progress, RunError, RunOptions, Summary};
use stickslip::scene::{Loaded, Scene};

/// Run a scene and write its results.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file.
    #[arg(required_unless_present = "again")]
    scene: Option<PathBuf>,

    /// Run the scene of a folder of results again, as it was then, beside it, and say whether it ends in the same bits;
    /// exit code 3 if not.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["scene", "parameters"])]
    again: Option<PathBuf>,

    /// Folder for the results; the name of the scene with `.results`, in this folder, without this.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Give a named parameter of the scene another value; may be repeated.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    parameters: Vec<(String, String)>,

    /// Begin anew in a folder whose run did not finish and could go on; its results stay in DIR/unfinished until the
    /// new run has finished.
    #[arg(long)]
    overwrite: bool,

    #[command(flatten)]
    how: How,
}

/// Refuses a folder with a run that did not finish and can go on.
fn unfinished(folder: &Path, scene: &Scene) -> Result<(), Failure> {
    let newest = stickslip::run::unfinished(folder, scene).map_err(Failure::input)?;
    let Some(newest) = newest else { return Ok(()) };
    let folder = folder.display();
    Err(Failure::Input(miette!(
        help = format!("`stickslip resume {folder}` goes on with it; --overwrite begins anew"),
        "{folder} holds a run that did not finish, with a checkpoint: {}",
        newest.display()
    )))
}

/// How a run is made, new or taken up.
#[derive(Debug, Args)]
pub(super) struct How {
    /// Threads; without this as many as there are processors, shared out where several processes share them.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,

    /// Wall time between checkpoints, from which `stickslip resume` goes on: "10min", "1h 30min"; "never" leaves out
    /// the one at the end, too.
    #[arg(long, value_name = "TIME", default_value = "10min", value_parser = wall_time)]
    checkpoint_every: WallTime,

    /// How many checkpoints are kept, the newest ones.
    #[arg(long, value_name = "NUMBER", default_value_t = 2, value_parser = clap::value_parser!(u16).range(1..))]
    keep_checkpoints: u16,

    /// Stop after this wall time, from the start of the program, with a checkpoint and exit code 4: "8h", or "never".
    #[arg(long, value_name = "TIME", default_value = "never", value_parser = wall_time)]
    max_time: WallTime,

    /// When the program was started, about.
    #[arg(skip = Instant::now())]
    begun: Instant,

    /// Memory that the run may take, as `stickslip check` estimates it, such as "40 GB"; what is free without this.
    #[arg(long, value_name = "SIZE")]
    max_memory: Option<ByteSize>,

    /// Exit with code 3 if the summary warns that results are doubtful.
    #[arg(long)]
    strict: bool,

    /// Say nothing but warnings and errors.
    #[arg(short, long)]
    quiet: bool,

    /// Say where the time went, too.
    #[arg(short, long, conflicts_with = "quiet")]
    verbose: bool,

    /// How progress is shown.
    #[arg(long, value_enum, default_value = "auto", value_name = "FORM")]
    progress: ProgressForm,
}

/// A wall time; without one, never.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WallTime(pub(super) Option<Duration>);

pub(super) fn wall_time(text: &str) -> Result<WallTime, String> {
    if text.trim() == "never" {
        return Ok(WallTime(None));
    }
    let time =
        text.trim().parse::<jiff::SignedDuration>().ok().and_then(|time| Duration::try_from(time).ok());
    let time = time.filter(|time| !time.is_zero());
    time.map(|time| WallTime(Some(time)))
        .ok_or("allowed: a time above zero, such as 10min or 1h 30min, or never".into())
}

/// Where the results go if the user does not say.
pub fn default_folder(scene: &Path, kind: &str) -> PathBuf {
    let mut name = scene.file_stem().unwrap_or(scene.as_os_str()).to_owned();
    name.push(format!(".{kind}"));
    PathBuf::from(name)
}

#[test]
fn wall_times_are_above_zero_or_never() {
    assert_eq!(wall_time("1h 30min"), Ok(WallTime(Some(Duration::from_secs(5400)))));
    assert_eq!(wall_time("never"), Ok(WallTime(None)));
    for wrong in ["0s", "-3min", "10", "soon", ""] {
        assert!(wall_time(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn results_go_beside_the_user_not_beside_the_scene() {
    let folder = default_folder(Path::new("scenes/paper/inclined_plane_no_slip.toml"), "results");
    assert_eq!(folder, PathBuf::from("inclined_plane_no_slip.results"));
}

impl Arguments {
    /// Threads that the user asks for.
    #[cfg(feature = "mpi")]
    pub(super) fn threads(&self) -> Option<usize> {
        self.how.threads()
    }

    pub fn execute(self) -> Result<(), Failure> {
        self.how.use_threads()?;
        let before = self.again.as_deref().map(Repeated::of).transpose()?;
        let (mut loaded, source, usual) = match (&before, self.scene) {
            (Some(before), _) => (before.scene(&self.how)?, before.source.clone(), before.folder()),
            (None, scene) => {
                let (scene, set) = (scene.unwrap_or_default(), self.parameters);
                let loaded = load(&scene, &set).map_err(Failure::input)?;
                let path = std::path::absolute(&scene).into_diagnostic().map_err(Failure::Run)?;
                let source = SceneSource { path, set, until: None, text: None };
                (loaded, source, default_folder(&scene, "results"))
            }
        };
        let out = self.out.unwrap_or(usual);
        if !self.overwrite {
            unfinished(&out, &loaded.scene)?;
        }
        let mut make: Make =
            |scene, simulation, options, progress| stickslip::run::run(scene, simulation, options, progress);
        // A run that was continued has steps that end where it ended before.
        for end in before.iter().flat_map(|before| before.ends()) {
            loaded.scene.time.end = end;
            self.how.make(&loaded, (source.clone(), out.clone()), make)?;
            make = stickslip::run::resume;
        }
        match before {
            Some(before) => before.compare(&out),
            None => self.how.make(&loaded, (source, out), make),
        }
    }
}

/// A run that is made again, to see whether it ends in the same bits.
struct Repeated {
    results: PathBuf,
    source: SceneSource,
    manifest: Manifest,
    /// Of its last state.
    sum: String,
}

impl Repeated {
    fn of(results: &Path) -> Result<Self, Failure> {
        let manifest = Manifest::read(results).map_err(Failure::input)?;
        let lacks = |what: &str| Failure::Input(miette!("{} does not say {what}", results.display()));
        let source = manifest.source.clone().ok_or_else(|| lacks("which scene file it came from"))?;
        let source = SceneSource { until: None, ..source };
        let sum = manifest.state_sum.clone();
        let sum = sum.ok_or_else(|| lacks("in which bits it ended: it failed, or was killed"))?;
        Ok(Repeated { results: results.to_path_buf(), source, manifest, sum })
    }

    /// `DIR.again`
    fn folder(&self) -> PathBuf {
        let mut name = self.results.components().as_path().as_os_str().to_owned();
        name.push(".again");
        PathBuf::from(name)
    }

    /// The scene as it was run, to the end that the run had; of a record that does not have its text, that of the file.
    ///
    /// # Errors
    /// It cannot be read, or is not that of the run any more.
    fn scene(&self, how: &How) -> Result<Loaded, Failure> {
        let SceneSource { path, text, .. } = &self.source;
        if let Some(text) = text {
            let changed = match std::fs::read_to_string(path) {
                Ok(now) => Some("has changed since").filter(|_| now != *text),
                Err(_) => Some("cannot be read any more"),
            };
            if let Some(changed) = changed {
                how.note(&format!("{} {changed}; the scene is run again as it was then", path.display()));
            }
        }
        let read = self.source.recorded().unwrap_or_else(|| self.source.load());
        let mut loaded = read.map_err(Failure::input)?;
        loaded.scene.time.end = self.manifest.performance.time;
        let now = Manifest::record(&loaded.scene);
        stickslip::run::same_physics(&self.results, &self.manifest.scene.value(), &now)
            .map_err(Failure::input)?;
        Ok(loaded)
    }

    /// The ends to which it went, one after the other [s].
    fn ends(&self) -> impl Iterator<Item = f64> {
        self.manifest.ends.iter().copied().chain([self.manifest.performance.time])
    }

    fn compare(&self, out: &Path) -> Result<(), Failure> {
        let now = Manifest::read(out).map_err(Failure::input)?;
        if now.state_sum.as_ref() == Some(&self.sum) {
            return say(&format!("the same bits as {}: {}", self.results.display(), self.sum));
        }
        let (steps, before) = (now.performance.steps, self.manifest.performance.steps);
        say(&format!("other bits than {}, after {steps} steps and {before}", self.results.display()))?;
        if now.version != self.manifest.version {
            say(&format!("  version {} made it, and this is {}", self.manifest.version, now.version))?;
        }
        if let Some(then) =
            self.manifest.begun_from.as_ref().filter(|then| now.begun_from.as_ref() != Some(then))
        {
            let (path, time) = (then.path.display(), then.time);
            say(&format!("  its bodies began from {path} at t = {time} s, which is another state now"))?;
        }
        Err(Failure::Differs)
    }
}

/// A run, new or taken up.
type Make =
    fn(&Scene, &mut dyn Simulation, &RunOptions, &mut dyn FnMut(&Progress)) -> Result<Summary, RunError>;

impl How {
    /// Makes the threads of the run; before the scene is read, which already takes some.
    pub(super) fn use_threads(&self) -> Result<(), Failure> {
        ranks::use_threads(self.threads(), ranks::neighbours())
    }

    /// Threads that the user asks for.
    pub(super) fn threads(&self) -> Option<usize> {
        self.threads.map(usize::from)
    }

    /// Tells the user something that is no reason to stop.
    pub(super) fn note(&self, text: &str) {
        if !self.quiet {
            tell!("note: {text}");
        }
    }

    /// Makes a run of a scene in a folder, from the warnings before it to the pictures behind it.
    pub(super) fn make(
        &self,
        loaded: &Loaded,
        (source, out): (SceneSource, PathBuf),
        make: Make,
    ) -> Result<(), Failure> {
        let scene = &loaded.scene;
        let threads = rayon::current_num_threads();
        let report = report(loaded)?;
        let WallTime(every) = self.checkpoint_every;
        let at_end = every.is_some() || self.max_time.0.is_some() || scene.outputs.checkpoints.is_some();
        let limit = self.max_memory.map_or_else(free_memory, |limit| limit.as_u64() as f64);
        let copy = if at_end { report.checkpoint_memory } else { 0.0 };
        if report.memory + copy > limit {
            let size = |bytes: f64| ByteSize(bytes as u64).display().si();
            return Err(Failure::Input(miette!(
                help = "take larger cells, fewer particles, or a larger machine; --max-memory allows more or less, and \
                        --checkpoint-every never saves what checkpoints need",
                "the run needs about {}, with {} of them for checkpoints, and may take {}",
                size(report.memory + copy),
                size(copy),
                size(limit)
            )));
        }
        if let Some(pairs) = pairs_without_friction(scene) {
            self.note(&pairs);
        }
        // What the run measures, its summary says.
        let warnings: Vec<_> = report.warnings.into_iter().filter(|warning| !warning.is_estimate()).collect();
        for warning in &warnings {
            tell!("warning: {warning}");
        }
        let mut simulation = ranks::simulation(loaded, &source)?;
        memory::run_writes_to(&out);
        let options = RunOptions {
            stop: stop_on_interrupt()?,
            threads,
            scene_warnings: warnings,
            source: Some(SceneSource { text: Some(loaded.source.text().to_owned()), ..source }),
            checkpoints: Checkpointing { every, at_end, keep: usize::from(self.keep_checkpoints) },
            max_time: self.max_time.0.map(|longest| longest.saturating_sub(self.begun.elapsed())),
            patience: Patience {
                tell: tell_of_dead_disk,
                tell_slow: tell_of_slow_disk,
                ..Patience::default()
            },
            ..RunOptions::new(&out)
        };
        let form = match self.progress {
            ProgressForm::Auto if self.quiet => ProgressForm::None,
            form => form,
        };
        let display = Display::new(scene.time.end, form);
        let outcome = make(scene, &mut *simulation, &options, &mut |progress| display.show(progress));
        display.finish();
        // Pictures take as much memory again.
        drop(simulation);
        let summary = match outcome {
            Ok(summary) => summary,
            Err(error @ RunError::Folder(_)) => return Err(Failure::input(error)),
            Err(RunError::Resume(error)) => return Err(at_start(loaded, error)),
            // The folder itself has gone.
            Err(RunError::Output(error)) if error.path == out => return Err(Failure::run(error)),
            Err(error) => {
                // The failure is the news; a picture of it is welcome but must not hide it.
                let _ = illustrate(&out);
                if at_end && matches!(error, RunError::Unhealthy { .. }) {
                    say(&format!("go on with: stickslip resume {}", out.display()))?;
                }
                return Err(Failure::run(error));
            }
        };
        let say = |text: &str| if self.quiet { Ok(()) } else { say(text) };
        say(&format!("{}\n{summary}{}", scene.title, measured(&out, scene)?))?;
        if self.verbose {
            say(&times(&summary.performance))?;
        }
        let drawn = illustrate(&out).map_err(Failure::after_the_run)?;
        say(&format!("results in {}/: {drawn}", out.display()))?;
        if summary.status != Status::Finished && at_end {
            say(&format!("go on with: stickslip resume {}", out.display()))?;
        }
        if self.quiet {
            summary.warning_lines().iter().for_each(|line| tell!("warning: {line}"));
        }
        match (summary.status, summary.warnings.len()) {
            (Status::Interrupted, _) => Err(Failure::Interrupted),
            (Status::OutOfTime, _) => Err(Failure::OutOfTime),
            (_, warnings @ 1..) if self.strict => Err(Failure::Doubtful(warnings)),
            _ => Ok(()),
        }
    }
}

/// Where the time of a run went: a line for each part of the step, for what a run does beside, and for the rest.
fn times(performance: &Performance) -> String {
    let Performance { wall_time, timings, ranks, .. } = performance;
    let rest = wall_time - timings.iter().map(|timing| timing.seconds).sum::<f64>();
    let parts = timings.iter().map(|timing| (timing.verb.as_str(), timing.seconds));
    let line = |(part, seconds): (&str, f64)| {
        format!(
            "  {part:<20} {seconds:>9.3} s  {:>3.0} %",
            100.0 * seconds / wall_time.max(f64::MIN_POSITIVE)
        )
    };
    let lines = parts.chain([("the rest", rest)]).map(line);
    lines.chain(balance(ranks)).collect::<Vec<_>>().join("\n")
}

/// What each rank had and did in the steps: how well the load is balanced.
fn balance(ranks: &[RankShare]) -> Vec<String> {
    let Some(slowest) = ranks.iter().map(|rank| rank.computed).max_by(f64::total_cmp) else {
        return Vec::new();
    };
    let head = "  rank   particles   computing     waiting   sent a step".to_string();
    let line = |(number, rank): (usize, &RankShare)| {
        let RankShare { particles, steps, computed, traffic } = rank;
        let waited = traffic.waited;
        let per_step = |count: u64| count as f64 / *steps.max(&1) as f64;
        let size = ByteSize(per_step(traffic.bytes) as u64).display().si();
        let messages = per_step(traffic.messages);
        format!(
            "  {number:>4} {particles:>11} {computed:>9.3} s {waited:>9.3} s   {size} in {messages:.0} messages"
        )
    };
    let mean = ranks.iter().map(|rank| rank.computed).sum::<f64>() / ranks.len() as f64;
    let last = format!(
        "  the slowest rank computes {:.2} times as long as the mean",
        slowest / mean.max(f64::MIN_POSITIVE)
    );
    [head].into_iter().chain((0..).zip(ranks).map(line)).chain([last]).collect()
}

/// Tells the user of a file that processes write together, and all wait for.
fn tell_of_slow_disk(path: &Path, waited: Duration) {
    let (path, waited) = (path.display(), waited.as_secs());
    tell!(
        "\nwarning: {path} is not written after {waited} s; all processes wait until it is, whatever they are asked"
    );
}

/// Tells the user of a disk that takes nothing.
fn tell_of_dead_disk(path: &Path, waited: Duration) {
    let (path, waited) = (path.display(), waited.as_secs());
    tell!(
        "\nwarning: the disk has taken nothing for {path} in {waited} s; the run waits for it, and Ctrl-C or --max-time \
         end it"
    );
}

/// A line for each arrival and each front's speed; a threshold that was not passed has none.
fn measured(folder: &Path, scene: &Scene) -> Result<String, Failure> {
    let results = Results::open(folder).map_err(Failure::run)?;
    let unit = scene.outputs.measurements.unit();
    let arrival = |row: &ArrivalRow| {
        let units = unit.map_or(String::new(), |unit| format!(", {:.4} time units", row.time / unit));
        let ArrivalRow { time, quantity, threshold, place, reading, .. } = row;
        format!("  arrival    {quantity} {threshold:.3e} at {place} ({reading}): t = {time:.6e} s{units}\n")
    };
    let speed = |row: &FrontSpeedRow| {
        let FrontSpeedRow { front, speed, error, .. } = row;
        format!("  front      {front}: {speed:.6} m/s by fit, standard error {error:.2}\n")
    };
    let arrivals = results.arrivals_table().map_err(Failure::run)?;
    let speeds = results.front_speeds_table().map_err(Failure::run)?;
    Ok(arrivals.iter().map(arrival).chain(speeds.iter().map(speed)).collect())
}
