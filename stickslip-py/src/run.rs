//! Runs: steps to a time, with results or without. Between two steps Python has its say: signals, functions that look
//! at the simulation, a line that shows how far it is.

use crate::engine::Engine;
use crate::errors;
use crate::scene::until;
use pyo3::prelude::*;
use serde_json::json;
use std::ffi::OsString;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use stickslip::door::View;
use stickslip::march::march;
use stickslip::observe::{Observer, OutputError, SceneSource, Schedule, replace};
use stickslip::run::{Checkpointing, Progress, ReferenceResult, RunOptions, Summary, resume, run_with};

/// What Python wants of steps to a time.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Way {
    /// Simulated time at which they end [s].
    until: f64,
    /// Simulated time from one call of `callback` to the next; 0 calls it after every step [s].
    every: f64,
    /// Called without arguments at the start, as often as `every` says, and at the end.
    callback: Option<Py<PyAny>>,
    /// Called ten times a second with time, end, steps, particles, and what the user should know.
    show: Option<Py<PyAny>>,
}

/// What Python wants of a run that leaves results.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct RunRequest {
    /// Its folder.
    out: PathBuf,
    /// Whether it goes on from its newest checkpoint.
    resumed: bool,
    /// Where the scene came from: file, and what was set.
    source: (PathBuf, Vec<(String, String)>, Option<String>),
    /// The scene as text.
    text: String,
    /// Whether it came from no file, and is written beside the results.
    is_new: bool,
    /// Wall time between checkpoints; none at all without it [s].
    checkpoint_every: Option<f64>,
    /// Wall time after which it stops [s].
    max_time: Option<f64>,
}

/// Wall time from one look of Python to the next.
const LOOK: Duration = Duration::from_millis(50);

/// What Python does between two steps, and what came of it.
struct Between {
    show: Option<Py<PyAny>>,
    stop: Arc<AtomicBool>,
    raised: Mutex<Option<PyErr>>,
}

impl Between {
    fn new(show: Option<Py<PyAny>>) -> Self {
        Between { show, stop: Arc::default(), raised: Mutex::new(None) }
    }

    /// Does something in Python; an exception stops the run after the step under way.
    fn attach(&self, act: impl FnOnce(Python<'_>) -> PyResult<()>) {
        if let Err(error) = Python::attach(act) {
            self.raised.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            self.stop.store(true, Ordering::Relaxed);
        }
    }

    /// Sees to signals, Ctrl-C among them, and shows how far the run is.
    fn look(&self, (time, end): (f64, f64), (steps, particles): (u64, usize), notes: Vec<String>) {
        self.attach(|py| {
            py.check_signals()?;
            let show = self.show.as_ref().map(|show| show.call1(py, (time, end, steps, particles, notes)));
            show.transpose().map(drop)
        });
    }

    fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// The exception that stopped it.
    fn outcome(self) -> PyResult<()> {
        self.raised.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
    }
}

/// A function that looks at the simulation now and then.
struct Call<'a> {
    callback: Py<PyAny>,
    schedule: Schedule,
    between: &'a Between,
}

impl Call<'_> {
    fn of<'a>(way: &mut Way, between: &'a Between) -> Option<Call<'a>> {
        let schedule = Schedule::every(way.every);
        way.callback.take().map(|callback| Call { callback, schedule, between })
    }
}

impl Observer for Call<'_> {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        self.schedule.recorded(view.time());
        if !self.between.is_stopped() {
            self.between.attach(|py| self.callback.call0(py).map(drop));
        }
        Ok(())
    }
}

/// Writes the scene beside the results, from where a run that goes on reads it.
struct SceneFile {
    path: PathBuf,
    text: Option<String>,
}

impl Observer for SceneFile {
    fn next(&self) -> f64 {
        f64::INFINITY
    }

    fn observe(&mut self, _: &dyn View) -> Result<(), OutputError> {
        let Some(text) = self.text.take() else { return Ok(()) };
        replace(&self.path, |file| file.write_all(text.as_bytes()))
    }
}

/// Steps to a time without results.
#[pyfunction]
pub fn walk(py: Python<'_>, engine: &Bound<'_, Engine>, mut way: Way) -> PyResult<()> {
    let engine = engine.get();
    let between = Between::new(way.show.take());
    let mut call = Call::of(&mut way, &between);
    let marched = py.detach(|| {
        let mut handle = engine.handle();
        let (mut looked, mut called) = (Instant::now(), handle.time());
        // A function of Python's does not fail here: its exception stops the way.
        let mut due = |handle: &dyn View, always: bool| {
            let time = handle.time();
            let due = call.as_mut().filter(|call| always || time > called && call.next() <= time);
            let _ = due.map_or(Ok(()), |call| {
                called = time;
                call.observe(handle)
            });
            called
        };
        due(&handle, true);
        let stepped = if between.is_stopped() {
            Ok(())
        } else {
            let marched = march(&mut handle, way.until, |simulation, _| {
                due(&*simulation, false);
                if looked.elapsed() >= LOOK {
                    looked = Instant::now();
                    let far = (simulation.time(), way.until);
                    between.look(far, (simulation.steps(), simulation.particles()), Vec::new());
                }
                if between.is_stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            marched.map(drop)
        };
        if stepped.is_ok() && due(&handle, false) < handle.time() {
            due(&handle, true);
        }
        stepped
    });
    between.outcome()?;
    marched.map_err(|error| errors::of_march(py, &error))
}

/// A run that leaves results, begun now or gone on with: what it came to as text, its warnings as lines of that, and
/// all as JSON.
#[pyfunction]
pub fn run(
    py: Python<'_>,
    engine: &Bound<'_, Engine>,
    mut way: Way,
    request: RunRequest,
) -> PyResult<(String, Vec<String>, String)> {
    let engine = engine.get();
    let scene = until(&engine.scene, way.until);
    let between = Between::new(way.show.take());
    let RunRequest { out, resumed, source, text, is_new, checkpoint_every, max_time } = request;
    let (path, set, named) = source;
    let every = checkpoint_every.map(seconds).transpose()?;
    let max_time = max_time.map(seconds).transpose()?;
    let at_end = every.is_some() || max_time.is_some() || scene.outputs.checkpoints.is_some();
    let mut file = SceneFile { path: out.join("scene.toml"), text: is_new.then(|| text.clone()) };
    let options = RunOptions {
        stop: Arc::clone(&between.stop),
        threads: engine.shared.threads(),
        source: Some(SceneSource { path, set, until: named, text: Some(text) }),
        checkpoints: Checkpointing { every, at_end, ..Checkpointing::default() },
        max_time,
        ..RunOptions::new(out)
    };
    let mut call = Call::of(&mut way, &between);
    let outcome = py.detach(|| {
        let mut handle = engine.handle();
        let show = &mut |progress: &Progress| {
            let Progress { time, end, steps, particles, notes, .. } = progress;
            between.look((*time, *end), (*steps, *particles), notes.clone());
        };
        if resumed {
            return resume(&scene, &mut handle, &options, show);
        }
        let mut observers: Vec<&mut dyn Observer> = vec![&mut file];
        observers.extend(call.as_mut().map(|call| call as &mut dyn Observer));
        run_with(&scene, &mut handle, &options, &mut observers, show)
    });
    drop(call);
    between.outcome()?;
    outcome.map(|summary| described(&summary)).map_err(|error| errors::of_run(py, &error))
}

/// Does what the words of a command line ask for, the program's name first, and gives the exit code; for processes that
/// do nothing else. `called` are the words by which scripts call the command.
#[pyfunction]
pub fn command(words: Vec<OsString>, called: Vec<OsString>) -> u8 {
    stickslip_cli::is_called(called);
    stickslip_cli::execute(words)
}

/// The newest checkpoint of a run in a folder that did not finish, where a new one of this scene is likely a mistake.
#[pyfunction]
pub fn unfinished(py: Python<'_>, engine: &Bound<'_, Engine>, folder: PathBuf) -> PyResult<Option<PathBuf>> {
    stickslip::run::unfinished(&folder, &engine.get().scene)
        .map_err(|error| errors::of_file(py, "ResultsError", &error))
}

fn seconds(seconds: f64) -> PyResult<Duration> {
    let wrong = || format!("found {seconds} s of wall time; allowed: seconds above zero, or None");
    let duration = Duration::try_from_secs_f64(seconds).ok().filter(|duration| !duration.is_zero());
    duration.ok_or_else(|| pyo3::exceptions::PyValueError::new_err(wrong()))
}

/// A summary as the command prints it, the warnings in it, and all as JSON.
fn described(summary: &Summary) -> (String, Vec<String>, String) {
    let reference = |reference: &ReferenceResult| {
        let ReferenceResult { body, quantity, label, value, exact } = reference;
        json!({ "body": body, "quantity": quantity, "label": label, "value": value, "exact": exact })
    };
    let record = json!({
        "status": summary.status,
        "performance": summary.performance,
        "start": summary.start,
        "end": summary.end,
        "energy_drift": summary.energy_drift(),
        "relative_energy_drift": summary.relative_energy_drift(),
        "relaxation": summary.relaxation,
        "warnings": summary.warnings,
        "references": summary.references.iter().map(reference).collect::<Vec<_>>(),
    });
    (summary.to_string(), summary.warning_lines(), record.to_string())
}
