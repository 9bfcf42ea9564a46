//! Checkpoints of a run: when they are written, and whether one fits a scene.

use crate::door::{RestoreError, Simulation, View};
use crate::observe::{
    Checkpoint, CheckpointForm, Manifest, Memory, OutputError, OutputFolder, ReadError, SceneRecord,
    Schedule, Status, Writer,
};
use crate::scene::Scene;
use miette::Diagnostic;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// When a run writes checkpoints, beside the times that its scene names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Checkpointing {
    /// Wall time from one to the next; none by wall time without it.
    pub every: Option<Duration>,
    /// Whether one is written where the run ends, so that it can be continued.
    pub at_end: bool,
    /// How many are kept, the newest; at least 1.
    pub keep: usize,
}

impl Default for Checkpointing {
    /// None but those that the scene asks for.
    fn default() -> Self {
        Checkpointing { every: None, at_end: false, keep: 2 }
    }
}

/// Why a run cannot go on from its checkpoints.
#[derive(Debug, thiserror::Error, Diagnostic)]
pub enum ResumeError {
    /// The folder holds no run, or none of its checkpoints can be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Unread(#[from] ReadError),
    /// The run has finished, and made none.
    #[error("there is nothing to go on from in {}: the run finished without a checkpoint", path.display())]
    #[diagnostic(help("run the scene anew"))]
    None {
        /// Where checkpoints would be.
        path: PathBuf,
    },
    /// An output is not as it was at the checkpoint.
    #[error("{} is not as it was at the checkpoint: {}", .0.path.display(), .0.source)]
    #[diagnostic(help("put back what was changed or removed, or run the scene anew"))]
    Misfit(#[source] OutputError),
    /// The scene is another one than that of the run, in more than its outputs and its end.
    #[error("{} was made with another scene: {key} was {then}, and is {now}", path.display())]
    #[diagnostic(help(
        "a run goes on with other outputs, but of the same fringes and unit of time, another end and other threads \
         only; run the changed scene anew, or put back what was changed: where it is a sha256, the file, \
         unless another version or machine reads it otherwise"
    ))]
    Changed {
        /// The checkpoint.
        path: PathBuf,
        /// Where the scenes differ first.
        key: String,
        /// What the run had there.
        then: String,
        /// What the scene has there.
        now: String,
    },
    /// The bodies are not those of the run, although the scene reads the same: a file that it names has changed.
    #[error("{} does not fit the scene: {problem}", path.display())]
    #[diagnostic(help(
        "a mesh or a table that the scene names has changed: put it back, or run the scene anew"
    ))]
    Other {
        /// The checkpoint.
        path: PathBuf,
        /// What does not fit.
        problem: RestoreError,
    },
    /// The scene begins from another run, whose bodies are not those of the scene.
    #[error("the scene cannot begin from {}: {problem}", path.display())]
    #[diagnostic(help(
        "a body begins from one that has its name, its shape, its particles and the same cells; only material, \
         contact, loads and the other bodies may be new"
    ))]
    Begin {
        /// The checkpoint.
        path: PathBuf,
        /// What does not fit.
        problem: RestoreError,
    },
    /// The scene begins from a snapshot that has not all that it needs.
    #[error("the scene cannot begin from {}: it lacks {}", path.display(), missing.join(", "))]
    #[diagnostic(help(
        "record that run with [outputs.snapshots] that leave out nothing, or begin from one of its checkpoints, which \
         have everything"
    ))]
    Lacks {
        /// The snapshot.
        path: PathBuf,
        /// What it lacks, and which key left it out.
        missing: Vec<String>,
    },
    /// The scene begins from the folder that takes its results.
    #[error("the scene begins from {}, and would write its results there", path.display())]
    #[diagnostic(help("write to another folder"))]
    Itself {
        /// The checkpoint.
        path: PathBuf,
    },
    /// The run is past the end that it should go on to.
    #[error("the run is at t = {time:e} s already, past its new end at {end:e} s")]
    #[diagnostic(help("give a later end, with --until or as time.end"))]
    Past {
        /// Where it is [s].
        time: f64,
        /// Where it should end [s].
        end: f64,
    },
}

/// Writes the checkpoints of a run, by a thread of its own, one at a time.
pub(super) struct Checkpoints {
    options: Checkpointing,
    /// In simulated time.
    schedule: Schedule,
    last: Instant,
    folder: OutputFolder,
    scene: SceneRecord,
    writer: Writer<()>,
    /// Whether the folder for them is made.
    prepared: bool,
    trouble: Arc<Mutex<Option<OutputError>>>,
}

impl Checkpoints {
    pub(super) fn new(
        (scene, record): (&Scene, SceneRecord),
        folder: &OutputFolder,
        options: &Checkpointing,
        view: &dyn View,
    ) -> Result<Self, OutputError> {
        let writer = Writer::start((), &Checkpoint::folder(folder.path()), folder.waiting())?;
        let mut checkpoints = Checkpoints {
            options: options.clone(),
            schedule: Schedule::every(scene.outputs.checkpoints.unwrap_or(f64::INFINITY)),
            last: Instant::now(),
            folder: folder.clone(),
            scene: record,
            writer,
            prepared: false,
            trouble: Arc::default(),
        };
        checkpoints.made(view.time());
        Ok(checkpoints)
    }

    /// Whether it is time for one.
    pub(super) fn due(&self, view: &dyn View) -> bool {
        view.time() >= self.schedule.next()
            || self.options.every.is_some_and(|every| self.last.elapsed() >= every)
    }

    /// Where the next one will lie.
    pub(super) fn path(&self, view: &dyn View) -> PathBuf {
        Checkpoint::path(self.folder.path(), view.steps())
    }

    /// Saves the present state, and what is remembered beside it. Of a simulation that cannot be saved there is none.
    /// One that cannot be written does not end the run, see [`Checkpoints::trouble`].
    ///
    /// # Errors
    /// The folder is not where it was, or the disk takes nothing and the run is to stop.
    pub(super) fn save(
        &mut self,
        simulation: &dyn Simulation,
        memory: Memory,
        form: CheckpointForm,
    ) -> Result<(), OutputError> {
        self.folder.is_in_place()?;
        // One at a time: each is a copy of the state in memory.
        self.finish()?;
        self.made(simulation.time());
        let path = self.path(simulation);
        let (folder, keep) = (self.folder.clone(), self.options.keep.max(1));
        let (trouble, first) = (Arc::clone(&self.trouble), !std::mem::replace(&mut self.prepared, true));
        let prepare = move |folder: &OutputFolder| if first { Checkpoint::prepare(folder) } else { Ok(()) };
        let note = move |done: Result<(), OutputError>| {
            if let Err(error) = done {
                *trouble.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
            }
        };
        if !simulation.shares().is_empty() {
            // Ranks write together, and go on once they have.
            let Some(rest) = simulation.save_rest() else {
                Checkpoint::clear_beside(&path);
                return Ok(());
            };
            let checkpoint = Checkpoint::new(&self.scene, rest, memory);
            let write = || checkpoint.write_shared((&path, form), simulation);
            let done = prepare(&folder)
                .and_then(|()| folder.waiting().watch(&path, write))
                .and_then(|()| Checkpoint::keep_newest(folder.path(), keep));
            if done.is_err() {
                Checkpoint::clear_beside(&path);
            }
            note(done);
            self.last = Instant::now();
            return Ok(());
        }
        let Some(state) = simulation.save() else { return Ok(()) };
        let checkpoint = Checkpoint::new(&self.scene, state, memory);
        self.writer.hand_over(0, move |()| {
            note(
                prepare(&folder)
                    .and_then(|()| checkpoint.write(&path, form))
                    .and_then(|()| Checkpoint::keep_newest(folder.path(), keep)),
            );
            Ok(())
        });
        Ok(())
    }

    /// Waits until the last one is on the disk; whether it could be written, [`Checkpoints::trouble`] says.
    ///
    /// # Errors
    /// The disk takes nothing, and the run is to stop.
    pub(super) fn finish(&mut self) -> Result<(), OutputError> {
        self.writer.ask(|()| Ok(()))
    }

    /// Why the last one could not be written, told once.
    pub(super) fn trouble(&self) -> Option<OutputError> {
        self.trouble.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    fn made(&mut self, time: f64) {
        self.last = Instant::now();
        self.schedule.recorded(time);
    }
}

/// The newest checkpoint of a run in a folder that did not finish, where a new run of `scene` there is likely a
/// mistake: the run was killed or ran out of its time; or it was interrupted, failed or was stopped by a check, and
/// could go on with `scene`, see [`same_physics`]. None where there is no such run, or one is under way.
///
/// # Errors
/// The folder cannot be read.
pub fn unfinished(folder: &Path, scene: &Scene) -> Result<Option<PathBuf>, ReadError> {
    let Ok(before) = Manifest::read(folder) else { return Ok(None) };
    let could_go_on = match before.status {
        Status::Finished => false,
        Status::Running | Status::OutOfTime => true,
        Status::Interrupted | Status::Stopped | Status::Failed => {
            same_physics(folder, &before.scene.value(), &Manifest::record(scene)).is_ok()
        }
    };
    if !could_go_on || Checkpoint::list(folder)?.is_empty() || OutputFolder::reopen(folder).is_err() {
        return Ok(None);
    }
    Ok(Checkpoint::newest(folder).ok().map(|(_, path, _)| path))
}

/// What of a scene may change where a run goes on.
const FREE: &[&str] = &[
    "title",
    "about",
    "parameters",
    "outputs",
    "references",
    "health",
    "domain.leaving",
    "start.from",
    "start.at",
    "time.end",
    "time.energy_drift",
];

/// Holds the scene of a run in `path` against another, both as `run.json` has them
/// ([`crate::observe::Manifest::record`]).
///
/// # Errors
/// They differ in more than outputs and end.
pub fn same_physics(path: &Path, then: &Value, now: &Value) -> Result<(), ResumeError> {
    let fixed = FIXED.iter().find_map(|(pointer, key)| {
        let [then, now] = [then, now].map(|scene| scene.pointer(pointer).filter(|value| !value.is_null()));
        let same = then == now || (*key == "outputs.fringes" && (then.is_none() || now.is_none()));
        (!same).then(|| (key.to_string(), then, now))
    });
    let Some((key, then, now)) = fixed.or_else(|| first_difference(String::new(), then, now)) else {
        return Ok(());
    };
    let short = |value: Option<&Value>| {
        let text = value.map_or("nothing".to_string(), Value::to_string);
        if text.chars().count() > 60 { text.chars().take(57).chain("...".chars()).collect() } else { text }
    };
    Err(ResumeError::Changed { path: path.to_path_buf(), key, then: short(then), now: short(now) })
}

/// What may not change although the outputs around it may: a column counts in the unit of time, and film has light on
/// it.
const FIXED: [(&str, &str); 2] =
    [("/outputs/measurements/time_unit", "outputs.time_unit"), ("/outputs/fringes", "outputs.fringes")];

type Difference<'a> = (String, Option<&'a Value>, Option<&'a Value>);

fn first_difference<'a>(key: String, then: &'a Value, now: &'a Value) -> Option<Difference<'a>> {
    if FREE.contains(&key.as_str()) {
        return None;
    }
    match (then, now) {
        (Value::Object(a), Value::Object(b)) => {
            let names = a.keys().chain(b.keys().filter(|name| !a.contains_key(*name)));
            let place = |name: &String| if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
            names.into_iter().find_map(|name| match (a.get(name), b.get(name)) {
                (Some(then), Some(now)) => first_difference(place(name), then, now),
                _ if FREE.contains(&place(name).as_str()) => None,
                (then, now) => Some((place(name), then, now)),
            })
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            let both = a.iter().zip(b).enumerate();
            both.into_iter().find_map(|(i, (then, now))| first_difference(format!("{key}[{i}]"), then, now))
        }
        (Value::Array(a), Value::Array(b)) => {
            // Of another length: the first whose name is in one of them only, if they have names.
            let lacks = |list: &[Value], item: &&Value| {
                let name = item.get("name");
                name.is_some() && list.iter().all(|other| other.get("name") != name)
            };
            let place = |item: &Value| format!("{key}[{}]", item["name"]);
            let gone = a.iter().find(|item| lacks(b, item)).map(|item| (place(item), Some(item), None));
            let new = || b.iter().find(|item| lacks(a, item)).map(|item| (place(item), None, Some(item)));
            gone.or_else(new).or(Some((key, Some(then), Some(now))))
        }
        _ if then == now => None,
        _ => Some((key, Some(then), Some(now))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn scenes_differ_where_they_do_and_may_in_outputs_and_end() {
        let scene = json!({"time": {"end": 1.0, "courant": 0.4}, "outputs": {"tables": 0.1}, "bodies": [{"name": "a"}]});
        let with = |pointer: &str, value: Value| {
            let mut changed = scene.clone();
            *changed.pointer_mut(pointer).unwrap() = value;
            first_difference(String::new(), &scene, &changed).map(|(key, ..)| key)
        };
        assert_eq!(with("/time/end", json!(2.0)), None);
        assert_eq!(with("/outputs", json!(null)), None);
        assert_eq!(with("/time/courant", json!(0.5)), Some("time.courant".to_string()));
        assert_eq!(with("/bodies/0/name", json!("b")), Some("bodies[0].name".to_string()));
        assert_eq!(with("/bodies", json!([])), Some("bodies[\"a\"]".to_string()));
        assert_eq!(with("/bodies", json!([1, 2])), Some("bodies[\"a\"]".to_string()));
        assert_eq!(with("/time", json!({"courant": 0.4, "more": 1})), Some("time.more".to_string()));
    }
}
