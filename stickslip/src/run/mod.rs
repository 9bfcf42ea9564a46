//! The loop: step, observe, stop.

mod checkpoints;
mod clock;
mod contact_watch;
mod error;
mod not_finite;
mod origin;
mod start;
mod summary;
mod verdict;
mod widest;

pub use checkpoints::{Checkpointing, ResumeError, same_physics, unfinished};
pub use clock::Progress;
pub use error::RunError;
pub use start::{CarriedBodies, begin};
use start::{Remembered, carry};
pub use summary::{ReferenceResult, Summary};
pub use widest::{WidestContact, WidestContacts};

use crate::check::{Report, Warning};
use crate::door::{Ledger, Simulation, View};
use crate::march::{FailedStep, March, MarchEnd, Pace};
use crate::observe::{
    BegunFrom, Checkpoint, CheckpointForm, Doubt, Manifest, Memory, Observer, OutputError, OutputFolder,
    Patience, Performance, ReadError, Recorder, SceneSource, Status, Waiting, Writer, present_state_sum,
};
use crate::scene::{HealthCheck, Scene};
use checkpoints::Checkpoints;
use clock::{Beside, RunClock};
use contact_watch::ContactWatch;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use summary::Energies;
use verdict::{Noted, RunChecks};

/// How a scene is run.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Folder for the results; see [`OutputFolder::prepare`] for what may be there already.
    pub out: PathBuf,
    /// Set by whoever wants the run to stop: it does so after the step under way, with all outputs valid.
    pub stop: Arc<AtomicBool>,
    /// Threads that the simulation uses, for the record.
    pub threads: usize,
    /// Where the scene came from, for the record.
    pub source: Option<SceneSource>,
    /// What was doubtful about the scene before the run, for the record.
    pub scene_warnings: Vec<Warning>,
    /// When checkpoints are written, from which [`resume`] goes on.
    pub checkpoints: Checkpointing,
    /// Wall time after which the run stops with a checkpoint; as long as it takes without it.
    pub max_time: Option<Duration>,
    /// How long the run waits for a disk that takes nothing.
    pub patience: Patience,
}

impl RunOptions {
    /// A run that nobody stops, on all processors.
    pub fn new(out: impl Into<PathBuf>) -> Self {
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        RunOptions {
            out: out.into(),
            stop: Arc::default(),
            threads,
            source: None,
            scene_warnings: Vec::new(),
            checkpoints: Checkpointing::default(),
            max_time: None,
            patience: Patience::default(),
        }
    }

    /// The folder with how long its writers wait in a run that begins now.
    fn patient(&self, folder: OutputFolder) -> OutputFolder {
        let until = self.max_time.and_then(|longest| Instant::now().checked_add(longest));
        folder.with_patience(Waiting::new(self.patience.clone(), self.stop.clone(), until))
    }
}

/// Memory that the run of a scene takes beside its simulation, for the particles that its checks look at [bytes].
pub fn memory(report: &Report) -> f64 {
    let deforming = report.bodies.iter().filter(|body| !body.rigid);
    let particles: Vec<usize> = deforming.map(|body| body.particles).collect();
    verdict::bytes_of_neighbours(&particles, report.dimension.axes())
}

/// Runs a scene from the present state of its simulation to the end time, or to the state at rest that dynamic
/// relaxation looks for, and writes what the scene asks for.
///
/// Nothing is written before the folder is found usable. `progress` is called about ten times a second of wall time,
/// when there is something to note, and at the end.
///
/// # Errors
/// The folder cannot be used, a step fails, or an output cannot be written. In the last two cases the record of the run
/// says so, and everything written so far can be read; of a failing step the state in which it failed is the last
/// record.
pub fn run(
    scene: &Scene,
    simulation: &mut dyn Simulation,
    options: &RunOptions,
    progress: &mut dyn FnMut(&Progress),
) -> Result<Summary, RunError> {
    run_with(scene, simulation, options, &mut [], progress)
}

/// [`run`], with further observers beside those that the scene asks for: each is asked after the first step that
/// reaches its [`Observer::next`], and at the start and the end.
///
/// # Errors
/// As [`run`]; an observer's own error ends the run too.
pub fn run_with(
    scene: &Scene,
    simulation: &mut dyn Simulation,
    options: &RunOptions,
    observers: &mut [&mut dyn Observer],
    progress: &mut dyn FnMut(&Progress),
) -> Result<Summary, RunError> {
    // Its results would be put aside, and removed.
    if let Some(start) = scene.start.as_ref().filter(|start| is_within(&start.from, &options.out)) {
        return Err(ResumeError::Itself { path: start.from.clone() }.into());
    }
    let (carried, remembered) = carry(scene, simulation)?.unzip();
    let folder = options.patient(OutputFolder::prepare(&options.out)?);
    let beginning = Beginning {
        news: carried.iter().map(CarriedBodies::to_string).collect(),
        passed_over: carried.iter().filter_map(CarriedBodies::damage).collect(),
        begun_from: carried.as_ref().map(CarriedBodies::record),
        remembered: remembered.flatten(),
        ..Beginning::default()
    };
    drive(scene, simulation, (options, folder), (observers, beginning), progress)
}

/// Whether a path is a folder or lies in it, as far as both are there.
fn is_within(path: &Path, folder: &Path) -> bool {
    let [path, folder] = [path, folder].map(|path| path.canonicalize().ok());
    path.zip(folder).is_some_and(|(path, folder)| path.starts_with(folder))
}

/// Takes up a run where its newest checkpoint left it, and goes on to the end of `scene`, which may have other outputs
/// and another end than the run had. `simulation` is a new one of the scene. The outputs end bit for bit as those of a
/// run that was never interrupted; what was written after the checkpoint is cut off and written anew.
///
/// # Errors
/// As [`run`]; [`ResumeError`] where there is nothing to go on from, or the scene is another one: then nothing is
/// changed.
pub fn resume(
    scene: &Scene,
    simulation: &mut dyn Simulation,
    options: &RunOptions,
    progress: &mut dyn FnMut(&Progress),
) -> Result<Summary, RunError> {
    // A power cut may have taken the record; the checkpoint holds the scene, too.
    let before = Manifest::read(&options.out);
    if Checkpoint::list(&options.out).map_err(ResumeError::from)?.is_empty() {
        return begin_anew(scene, simulation, (options, before), progress);
    }
    let folder = options.patient(OutputFolder::reopen(&options.out)?);
    let (mut checkpoint, path, damaged) = Checkpoint::newest(&options.out).map_err(ResumeError::from)?;
    same_physics(&path, &checkpoint.scene(), &Manifest::record(scene))?;
    let time = checkpoint.state.time;
    if time > scene.time.end {
        return Err(ResumeError::Past { time, end: scene.time.end }.into());
    }
    let memory = checkpoint.memory(&path);
    let passed_over: Vec<String> =
        damaged.iter().map(|error| format!("{error}; an earlier checkpoint is taken")).collect();
    let mut notes = passed_over.clone();
    let version = env!("CARGO_PKG_VERSION");
    if checkpoint.program != version {
        let program = &checkpoint.program;
        notes.push(format!("version {program} began the run, and version {version} goes on with it"));
    }
    let restored = checkpoint.restore(&path, simulation).map_err(ResumeError::from)?;
    restored.map_err(|problem| ResumeError::Other { path: path.clone(), problem })?;
    let before = before.ok();
    let ended = before.as_ref().filter(|before| before.status == Status::Finished);
    let ended = ended.map(|before| before.performance.time).filter(|&end| end == time);
    let (mut resumed, mut ends, begun_from, scene_warnings) = before
        .map_or_else(Default::default, |before| {
            (before.resumed, before.ends, before.begun_from, before.scene_warnings)
        });
    resumed.push(time);
    ends.extend(ended);
    let damaged = damaged.into_iter().map(|error| error.path).collect();
    let (steps, end, from) = (simulation.steps(), scene.time.end, path.display());
    let news = vec![format!("goes on at t = {time} s, step {steps}, to t = {end} s, from {from}")];
    let memory = Some(memory);
    let beginning = Beginning {
        memory,
        resumed,
        ends,
        begun_from,
        scene_warnings,
        damaged,
        passed_over,
        news,
        notes,
        remembered: None,
    };
    drive(scene, simulation, (options, folder), (&mut [], beginning), progress)
}

/// Begins a run anew that ended before its first checkpoint, by a fault of the disk or a kill.
fn begin_anew(
    scene: &Scene,
    simulation: &mut dyn Simulation,
    (options, before): (&RunOptions, Result<Manifest, ReadError>),
    progress: &mut dyn FnMut(&Progress),
) -> Result<Summary, RunError> {
    let before = before.map_err(ResumeError::from)?;
    if before.status == Status::Finished {
        return Err(ResumeError::None { path: options.out.clone() }.into());
    }
    same_physics(&options.out, &before.scene.value(), &Manifest::record(scene))?;
    let news = format!("{} has no checkpoint: the run begins anew", options.out.display());
    let clock = RunClock::start(simulation, options.threads);
    progress(&Progress { news: vec![news], ..clock.progress(simulation, scene.time.end) });
    run(scene, simulation, options, progress)
}

/// From where a run begins.
#[derive(Default)]
struct Beginning {
    /// What was remembered at the checkpoint, if it goes on from one.
    memory: Option<Memory>,
    /// Times at which it was taken up, the last of them now [s].
    resumed: Vec<f64>,
    /// Ends at which it was finished before, and beyond which it goes on [s].
    ends: Vec<f64>,
    /// What its bodies begin from, if that is another run.
    begun_from: Option<BegunFrom>,
    /// What was doubtful about the scene when the run began.
    scene_warnings: Vec<Warning>,
    /// Newer checkpoints, which cannot be read.
    damaged: Vec<PathBuf>,
    /// What is wrong with those, of this run or of the one from which it begins: for the record.
    passed_over: Vec<String>,
    /// From where.
    news: Vec<String>,
    /// What the user should know of the checkpoints.
    notes: Vec<String>,
    /// What another run remembered of the bodies that begin as it left them.
    remembered: Option<Remembered>,
}

fn drive(
    scene: &Scene,
    simulation: &mut dyn Simulation,
    (options, folder): (&RunOptions, OutputFolder),
    (observers, mut beginning): (&mut [&mut dyn Observer], Beginning),
    progress: &mut dyn FnMut(&Progress),
) -> Result<Summary, RunError> {
    simulation.show();
    let mut kept = Kept {
        clock: RunClock::start(simulation, options.threads),
        start: simulation.ledger(),
        verdict: RunChecks::new(scene, simulation),
        contact_watch: ContactWatch::new(simulation.time()),
        last_step: 0.0,
        pace: Pace::default(),
    };
    if let Some(remembered) = &mut beginning.remembered {
        kept.verdict.carry(scene, remembered).map_err(ResumeError::Misfit)?;
    }
    if let Some(memory) = &mut beginning.memory {
        kept.remember(simulation, memory).map_err(ResumeError::Misfit)?;
        Recorder::find(&folder, memory).map_err(ResumeError::Misfit)?;
    }
    let mut manifest = Manifest::new(scene, kept.clock.performance(simulation));
    manifest.source.clone_from(&options.source);
    manifest.scene_warnings = match options.scene_warnings.is_empty() {
        true => std::mem::take(&mut beginning.scene_warnings),
        false => options.scene_warnings.clone(),
    };
    manifest.resumed = std::mem::take(&mut beginning.resumed);
    manifest.ends = std::mem::take(&mut beginning.ends);
    manifest.begun_from = beginning.begun_from.take();
    if beginning.memory.is_none() {
        record(&manifest, &folder)?;
    }
    let recorder = Recorder::new(scene, &folder).map_err(RunError::from).and_then(|mut recorder| {
        observers.iter_mut().for_each(|observer| recorder.add(&mut **observer));
        if let Some(memory) = &mut beginning.memory {
            recorder.remember(simulation, memory).map_err(ResumeError::Misfit)?;
        }
        Ok(recorder)
    });
    if beginning.memory.is_some() {
        // Only now is anything changed.
        match recorder {
            Err(RunError::Output(error)) => return Err(ResumeError::Misfit(error).into()),
            Err(error) => return Err(error),
            Ok(_) => {}
        }
        beginning.damaged.iter().try_for_each(|path| Checkpoint::put_away(path))?;
        record(&manifest, &folder)?;
    }
    for passed_over in std::mem::take(&mut beginning.passed_over) {
        let noted = (HealthCheck::Checkpoint, passed_over, "look at the disk and the memory of the machine");
        kept.verdict.note_each((scene, simulation), noted);
    }
    if !beginning.news.is_empty() {
        let news = std::mem::take(&mut beginning.news);
        progress(&Progress { news, ..kept.clock.progress(simulation, scene.time.end) });
    }
    let outcome = recorder.and_then(|recorder| {
        let record = (scene, manifest.scene.clone());
        let checkpoints = Checkpoints::new(record, &folder, &options.checkpoints, simulation)?;
        let memory = beginning.memory.take();
        let (simulation, kept, folder) = (&mut *simulation, &mut kept, &folder);
        let watched = Watched { scene, simulation, recorder, kept, options, folder, checkpoints, memory };
        watched.to(scene.time.end, beginning.notes, progress)
    });

    manifest.performance = Performance { ranks: simulation.shares(), ..kept.clock.performance(simulation) };
    manifest.status = outcome.as_ref().map_or(Status::Failed, |(status, _)| *status);
    manifest.state_sum = outcome.as_ref().ok().and_then(|(_, sum)| sum.clone());
    manifest.relaxation = simulation.relaxation();
    [manifest.warnings, manifest.remarks] = kept.verdict.found(scene);
    manifest.looks = kept.verdict.looks();
    // Whatever went wrong with files: if the folder is not where it was, that is why.
    let in_place = folder.is_in_place();
    let outcome = match (outcome, in_place) {
        (Err(RunError::Output(_)) | Ok(_), Err(moved)) => {
            (manifest.status, manifest.error) = (Status::Failed, Some(moved.to_string()));
            // Its record says so where it is now, if that can be known.
            let _ = folder.moved().map(|folder| record(&manifest, &folder));
            return Err(moved.into());
        }
        (outcome, _) => outcome,
    };
    let stopped = kept
        .verdict
        .stop()
        .map(|warning| RunError::Unhealthy { warning: Box::new(warning.clone()), time: simulation.time() });
    let ended = outcome.and_then(|_| stopped.map_or(Ok(()), Err));
    manifest.error = ended.as_ref().err().map(RunError::to_string);
    manifest.tables = folder.tables();
    let saved = record(&manifest, &folder);
    if saved.is_err() {
        // The one that is there says no more than that, if the disk takes even this.
        let _ = Manifest::mark_as_failed(&folder);
    }
    ended?;
    saved?;
    if manifest.status == Status::Finished {
        // What cannot be removed stays: this run has its results.
        let _ = folder.finished();
    }
    let contacts = kept.contact_watch.widest(scene, simulation);
    let energies = Energies { start: kept.start, scale: kept.verdict.energy_scale() };
    Ok(Summary::new(scene, simulation, energies, (manifest, contacts)))
}

/// Writes the record of a run, by a thread that waits no longer than the others.
fn record(manifest: &Manifest, folder: &OutputFolder) -> Result<(), OutputError> {
    let owned = (manifest.clone(), folder.clone());
    let mut writer = Writer::start(owned, &folder.join(Manifest::FILE), folder.waiting())?;
    writer.ask(|(manifest, folder)| manifest.write(folder))
}

/// What a run remembers beside the state of the simulation and its outputs.
struct Kept {
    clock: RunClock,
    /// Energy and momentum at the start.
    start: Ledger,
    verdict: RunChecks,
    contact_watch: ContactWatch,
    /// Length of the last step [s].
    last_step: f64,
    /// How long steps may be.
    pace: Pace,
}

impl Kept {
    /// What is new after a step of this length [s].
    fn look(&mut self, scene: &Scene, view: &dyn View, (march, step): (&mut March, f64)) -> Vec<String> {
        self.last_step = step;
        let mut lines = Vec::new();
        if let Some(FailedStep { error, part }) = march.failed() {
            let noted = Noted {
                check: HealthCheck::FailedStep,
                message: format!(
                    "a step failed, and was taken again with {part:.3} of the stable one: {error}"
                ),
                worst: 1.0 / part,
                advice: error.advice().to_owned(),
            };
            lines.extend(self.verdict.note(scene, view, noted));
        }
        if let Some(noted) = self.contact_watch.look(scene, view) {
            self.verdict.note(scene, view, noted);
        }
        lines.extend(self.verdict.look(scene, view, (step, march.pace().part())));
        if self.verdict.asks_to_cut() {
            march.cut();
        }
        self.pace = march.pace();
        lines
    }

    fn remember(&mut self, view: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("start", &mut self.start)?;
        memory.keep("last_step", &mut self.last_step)?;
        self.last_step = if self.last_step.is_finite() { self.last_step.max(0.0) } else { 0.0 };
        memory.keep("pace", &mut self.pace)?;
        self.pace = Some(self.pace).filter(Pace::is_sound).unwrap_or_default();
        memory.keep("contact_watch", &mut self.contact_watch)?;
        memory.part("clock", |memory| self.clock.remember(view, memory))?;
        memory.part("verdict", |memory| self.verdict.remember(memory))
    }
}

/// A run under way.
struct Watched<'a> {
    scene: &'a Scene,
    simulation: &'a mut dyn Simulation,
    recorder: Recorder<'a>,
    kept: &'a mut Kept,
    options: &'a RunOptions,
    folder: &'a OutputFolder,
    checkpoints: Checkpoints,
    /// What was remembered at the checkpoint from which the run goes on.
    memory: Option<Memory>,
}

impl Watched<'_> {
    fn to(
        mut self,
        end: f64,
        mut notes: Vec<String>,
        progress: &mut dyn FnMut(&Progress),
    ) -> Result<(Status, Option<String>), RunError> {
        let Watched { scene, simulation, recorder, kept, options, folder, checkpoints, memory } = &mut self;
        match memory {
            Some(memory) => {
                memory.take_up();
                recorder.remember(*simulation, memory)?;
            }
            None => {
                recorder.record_present(*simulation)?;
                notes.extend(kept.verdict.look(scene, *simulation, (0.0, 1.0)));
                if folder.has_previous() {
                    // Keeping waits until the first records are on the disk.
                    recorder.remember(*simulation, &mut Memory::keeping(folder.path()))?;
                    if let Some(unfinished) = folder.begun()? {
                        let place = unfinished.display();
                        let told = format!(
                            "the run before did not finish; its results stay in {place} until this has"
                        );
                        progress(&Progress { news: vec![told], ..kept.clock.progress(*simulation, end) });
                    }
                }
            }
        }
        let mut reports = kept.clock.reports();
        let mut recorded = Ok(());
        let begun = Instant::now();
        let late = || options.max_time.is_some_and(|longest| begun.elapsed() >= longest);
        let stop = || options.stop.load(Ordering::Relaxed) || late();
        let mut march =
            March::from(kept.last_step, end).with_retries(kept.pace, scene.health.retries).unseen();
        let mut stopped = stop() || kept.verdict.stop().is_some();
        let way = loop {
            if stopped && !march.is_done(*simulation) {
                break Ok(MarchEnd::BrokenOff);
            }
            let step = match march.step(*simulation) {
                Ok(Some(step)) => step,
                Ok(None) => break Ok(MarchEnd::Arrived),
                Err(error) => break Err(error),
            };
            let saves = checkpoints.due(*simulation);
            let looks_at = (step, march.pace().part());
            if saves || recorder.is_due(*simulation) || kept.verdict.is_due(scene, *simulation, looks_at) {
                simulation.show();
            }
            let begun = Instant::now();
            let looks = kept.verdict.looks();
            if recorder.is_due(*simulation)
                && let Some(error) = not_finite::in_sums(scene, *simulation)
            {
                break Err(error.into());
            }
            recorded = recorder.record_due(*simulation);
            kept.clock.count(Beside::Outputs, begun);
            let begun = Instant::now();
            notes.extend(kept.look(scene, *simulation, (&mut march, step)));
            if kept.verdict.looks() > looks
                && let Some(error) = not_finite::in_histories(scene, *simulation)
            {
                break Err(error.into());
            }
            kept.clock.count(Beside::Checks, begun);
            if reports.due() || !notes.is_empty() {
                let notes = std::mem::take(&mut notes);
                progress(&Progress { notes, ..kept.clock.progress(*simulation, end) });
            }
            if recorded.is_ok() && saves {
                let begun = Instant::now();
                recorded =
                    save(*simulation, (recorder, kept, checkpoints, CheckpointForm::Plain), memory.as_ref());
                kept.clock.count(Beside::Checkpoints, begun);
            }
            let trouble = checkpoints.trouble();
            notes
                .extend(trouble.and_then(|error| kept.verdict.note_checkpoint((scene, *simulation), &error)));
            stopped = recorded.is_err() || stop() || kept.verdict.stop().is_some();
        };
        simulation.show();
        recorded?;
        let way = way.and_then(|way| {
            let bad = not_finite::in_sums(scene, *simulation);
            bad.or_else(|| not_finite::in_histories(scene, *simulation)).map_or(Ok(way), |e| Err(e.into()))
        });
        let status = match way {
            Ok(MarchEnd::Arrived) => Status::Finished,
            Ok(MarchEnd::BrokenOff) if options.stop.load(Ordering::Relaxed) => Status::Interrupted,
            Ok(MarchEnd::BrokenOff) => Status::OutOfTime,
            Err(error) => {
                let recorded = recorder.record_failure(*simulation).and_then(|()| recorder.conclude());
                return Err(RunError::Step { error, unsaved: recorded.err() });
            }
        };
        let sum = present_state_sum(scene, *simulation);
        if options.checkpoints.at_end {
            // Before what is recorded at an end only: a run that goes on has none there.
            let begun = Instant::now();
            // That of a finished run stays; who stops one may not wait for it.
            let form = match status {
                Status::Finished => CheckpointForm::Compressed,
                _ => CheckpointForm::Plain,
            };
            save(*simulation, (recorder, kept, checkpoints, form), memory.as_ref())?;
            kept.clock.count(Beside::Checkpoints, begun);
        }
        let begun = Instant::now();
        notes.extend(kept.verdict.conclude(scene, *simulation, march.pace().part()));
        if let Some(noted) = kept.contact_watch.conclude(scene, *simulation) {
            // The summary has a line for it.
            kept.verdict.note(scene, *simulation, noted);
        }
        kept.clock.count(Beside::Checks, begun);
        let begun = Instant::now();
        recorder.record_present(*simulation)?;
        recorder.conclude()?;
        // Of a run that was broken off, nobody knows what would have come.
        let finished = status == Status::Finished;
        let doubts: Vec<Doubt> = recorder.doubts().filter(|_| finished).collect();
        if !doubts.is_empty() {
            let messages: Vec<&str> = doubts.iter().map(|doubt| doubt.message.as_str()).collect();
            let advice: Vec<&str> = doubts.iter().map(|doubt| doubt.advice).collect();
            let (messages, advice) = (messages.join("; "), advice.join("; "));
            let noted = (HealthCheck::Probe, messages, advice.as_str());
            notes.extend(kept.verdict.note_each((scene, *simulation), noted));
        }
        kept.clock.count(Beside::Outputs, begun);
        let begun = Instant::now();
        checkpoints.finish()?;
        kept.clock.count(Beside::Checkpoints, begun);
        let trouble = checkpoints.trouble();
        notes.extend(trouble.and_then(|error| kept.verdict.note_checkpoint((scene, *simulation), &error)));
        let status = if kept.verdict.stop().is_some() { Status::Stopped } else { status };
        progress(&Progress { notes, ..kept.clock.progress(*simulation, end) });
        Ok((status, sum))
    }
}

/// Has a checkpoint of the present moment written, and shows it; none of a simulation that cannot be saved.
fn save(
    simulation: &dyn Simulation,
    (recorder, kept, checkpoints, form): (&mut Recorder, &mut Kept, &mut Checkpoints, CheckpointForm),
    before: Option<&Memory>,
) -> Result<(), OutputError> {
    let path = checkpoints.path(simulation);
    let mut memory =
        before.map_or_else(|| Memory::keeping(&path), |before| Memory::keeping_beside(&path, before));
    kept.remember(simulation, &mut memory)?;
    recorder.remember(simulation, &mut memory)?;
    checkpoints.save(simulation, memory, form)
}
