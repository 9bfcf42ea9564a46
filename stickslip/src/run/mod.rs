//! The loop: step, observe, stop.

mod clock;
mod contact_watch;
mod error;
mod summary;
mod verdict;
mod widest;

pub use clock::Progress;
pub use error::RunError;
pub use summary::{ReferenceResult, Summary};
pub use widest::{WidestContact, WidestContacts};

use crate::door::Simulation;
use crate::march::{MarchEnd, march};
use crate::observe::{Manifest, Observer, OutputFolder, Recorder, Status};
use crate::scene::Scene;
use clock::RunClock;
use contact_watch::ContactWatch;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use summary::Energies;
use verdict::RunChecks;

/// How a scene is run.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Folder for the results; see [`OutputFolder::prepare`] for what may be there already.
    pub out: PathBuf,
    /// Set by whoever wants the run to stop: it does so after the step under way, with all outputs valid.
    pub stop: Arc<AtomicBool>,
    /// Threads that the simulation uses, for the record.
    pub threads: usize,
}

impl RunOptions {
    /// A run that nobody stops, on all processors.
    pub fn new(out: impl Into<PathBuf>) -> Self {
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        RunOptions { out: out.into(), stop: Arc::default(), threads }
    }
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
    let folder = OutputFolder::prepare(&options.out)?;
    let clock = RunClock::start(simulation, options.threads);
    let mut manifest = Manifest::new(scene, clock.performance(simulation));
    manifest.write(&folder)?;
    let start = simulation.ledger();

    let mut verdict = RunChecks::new(scene, simulation);
    let mut contact_watch = ContactWatch::new(simulation.time());
    let outcome = Recorder::new(scene, &folder).map_err(RunError::from).and_then(|mut recorder| {
        observers.iter_mut().for_each(|observer| recorder.add(&mut **observer));
        let (verdict, contact_watch) = (&mut verdict, &mut contact_watch);
        let watched = Watched { scene, simulation, recorder, verdict, contact_watch, options, clock: &clock };
        watched.to(scene.time.end, progress)
    });

    manifest.performance = clock.performance(simulation);
    manifest.status = *outcome.as_ref().unwrap_or(&Status::Failed);
    manifest.relaxation = simulation.relaxation();
    manifest.warnings = verdict.warnings().to_vec();
    manifest.error = outcome.as_ref().err().map(RunError::to_string);
    let saved = manifest.write(&folder);
    outcome?;
    saved?;
    let contacts = contact_watch.widest(scene, simulation);
    let energies = Energies { start, scale: verdict.energy_scale() };
    Ok(Summary::new(scene, simulation, energies, (manifest, contacts)))
}

/// A run under way.
struct Watched<'a> {
    scene: &'a Scene,
    simulation: &'a mut dyn Simulation,
    recorder: Recorder<'a>,
    verdict: &'a mut RunChecks,
    contact_watch: &'a mut ContactWatch,
    options: &'a RunOptions,
    clock: &'a RunClock,
}

impl Watched<'_> {
    fn to(mut self, end: f64, progress: &mut dyn FnMut(&Progress)) -> Result<Status, RunError> {
        self.recorder.record_present(self.simulation)?;
        let Watched { scene, simulation, recorder, verdict, contact_watch, options, clock } = &mut self;
        let mut reports = clock.reports();
        let mut notes = verdict.look(scene, *simulation);
        let mut recorded = Ok(());
        let stop = || options.stop.load(Ordering::Relaxed);
        let way = match stop() {
            true => Ok(MarchEnd::BrokenOff),
            false => march(*simulation, end, |simulation, _| {
                recorded = recorder.record_due(simulation);
                notes.extend(contact_watch.look(scene, simulation));
                notes.extend(verdict.look(scene, simulation));
                if reports.due() || !notes.is_empty() {
                    let notes = std::mem::take(&mut notes);
                    progress(&Progress { notes, ..clock.progress(simulation, end) });
                }
                if recorded.is_err() || stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            }),
        };
        recorded?;
        let status = match way {
            Ok(MarchEnd::Arrived) => Status::Finished,
            Ok(MarchEnd::BrokenOff) => Status::Interrupted,
            Err(error) => {
                let recorded = recorder.record_failure(*simulation).and_then(|()| recorder.conclude());
                return Err(RunError::Step { error, unsaved: recorded.err() });
            }
        };
        notes.extend(self.verdict.conclude(self.scene, self.simulation));
        self.recorder.record_present(self.simulation)?;
        self.recorder.conclude()?;
        progress(&Progress { notes, ..self.clock.progress(self.simulation, end) });
        Ok(status)
    }
}
