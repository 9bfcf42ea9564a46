//! Where a scene begins that begins from another run: a checkpoint of it, or a snapshot.

use super::ResumeError;
use crate::column::{EVERY, optional_in_files};
use crate::door::{NotTakenUp, RestoreError, SavedState, Simulation, View};
use crate::observe::{
    Checkpoint, Frame, Manifest, Memory, ParticleFile, ParticlesThere, ReadError, ReadProblem, Results,
    begin_on_ranks, state_sum, verify_snapshot,
};
use crate::scene::{BodyMotion, Expression, Scene, Start, StartVelocities};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A state of another run.
pub(super) struct Origin {
    /// All of it, or all but the particles.
    pub state: SavedState,
    /// Where they lie that are not in it.
    particles: Option<ParticlesThere>,
    /// The file that has it.
    pub from: PathBuf,
    /// Whether that is a snapshot.
    pub is_snapshot: bool,
    /// What the run remembered there, where that is known.
    pub memory: Option<Memory>,
    /// Newer checkpoints, which cannot be read.
    pub damaged: Vec<PathBuf>,
}

/// Part of the time between two snapshots by which a time may be off that asks for one of them.
const NEAR: f64 = 0.5;

impl Origin {
    /// What `start` names; of a snapshot only if it has all that the simulation of the scene needs.
    ///
    /// # Errors
    /// It cannot be read, lacks something, or has other bodies of the same names.
    pub(super) fn of(scene: &Scene, start: &Start, view: &dyn View) -> Result<Self, ResumeError> {
        if start.from.extension().is_some_and(|kind| kind == "vtu") {
            let folder =
                start.from.parent().and_then(Path::parent).filter(|folder| !folder.as_os_str().is_empty());
            let folder = folder.unwrap_or(Path::new("."));
            let results = Results::open(folder)?;
            let same = |frame: &&Frame| frame.path.file_name() == start.from.file_name();
            let named =
                results.frames().iter().find(same).filter(|frame| is_one_file(&frame.path, &start.from));
            let frame = named.ok_or_else(|| {
                let listed = "it is none of the snapshots of particles that the run around it lists";
                ReadError { path: start.from.clone(), problem: ReadProblem::Layout(listed.to_string()) }
            })?;
            return Self::of_frame(scene, (folder, &results, frame), view);
        }
        if let Some(at) = start.at {
            let results = Results::open(&start.from)?;
            let frame = frame_at(&results, &start.from, at)?;
            return Self::of_frame(scene, (&start.from, &results, frame), view);
        }
        let (mut checkpoint, from, damaged) = match start.from.is_file() {
            true => (Checkpoint::open(&start.from)?, start.from.clone(), Vec::new()),
            false => Checkpoint::newest(&start.from)?,
        };
        // Ranks find theirs for themselves.
        let particles = checkpoint.particles(&from).filter(|_| !view.shares().is_empty());
        if particles.is_none() {
            checkpoint.fill(&from)?;
        }
        let memory = Some(checkpoint.memory(&from));
        let damaged = damaged.into_iter().map(|error| error.path).collect();
        Ok(Origin { state: checkpoint.state, particles, from, is_snapshot: false, memory, damaged })
    }

    fn of_frame(
        scene: &Scene,
        (folder, results, frame): (&Path, &Results, &Frame),
        view: &dyn View,
    ) -> Result<Self, ResumeError> {
        verify_snapshot(folder, &frame.path)?;
        let (from, names) = (frame.path.clone(), results.body_names());
        let recorded = RecordedBodies { record: &results.manifest().scene.value(), names };
        let missing = recorded.missing(scene, &ParticleFile::open_head(&from)?, view);
        if !missing.is_empty() {
            return Err(ResumeError::Lacks { path: from, missing });
        }
        recorded.compare(scene).map_err(|problem| ResumeError::Begin { path: from.clone(), problem })?;
        let (particles, state) = if view.shares().is_empty() {
            (None, SavedState::of_snapshot(&results.particles(frame)?, frame.time, names))
        } else {
            let (particles, there) = ParticlesThere::in_snapshot(&from, names)?;
            (Some(particles), SavedState::of_frame(frame.time, &there))
        };
        Ok(Origin { state, particles, from, is_snapshot: true, memory: None, damaged: Vec::new() })
    }

    /// Lets bodies begin with it: the [`state_sum`] of what was read.
    ///
    /// # Errors
    /// The particles cannot be read, or bodies of the same names are others.
    pub(super) fn begin(
        &self,
        simulation: &mut dyn Simulation,
        velocities: StartVelocities,
    ) -> Result<String, ResumeError> {
        let (path, from) = (self.from.clone(), (&self.state, velocities));
        let begun = self.particles.as_ref().and_then(|particles| begin_on_ranks(simulation, from, particles));
        let problem = match begun {
            Some(Ok(sum)) => return Ok(sum),
            Some(Err(NotTakenUp::Unfound(problem))) => {
                return Err(ReadError { path, problem: ReadProblem::Layout(problem) }.into());
            }
            Some(Err(NotTakenUp::Other(problem))) => problem,
            None => match simulation.begin_from(&self.state, velocities) {
                Ok(()) => return Ok(state_sum(&self.state)),
                Err(problem) => problem,
            },
        };
        Err(ResumeError::Begin { path, problem })
    }
}

fn is_one_file(a: &Path, b: &Path) -> bool {
    a.canonicalize().ok().zip(b.canonicalize().ok()).is_some_and(|(a, b)| a == b)
}

/// The snapshot nearest to a time [s], if it is near.
fn frame_at<'a>(results: &'a Results, folder: &Path, at: f64) -> Result<&'a Frame, ReadError> {
    let frames = results.frames();
    let refuse = |what: String| ReadError { path: folder.to_path_buf(), problem: ReadProblem::Layout(what) };
    let off = |frame: &Frame| (frame.time - at).abs();
    let nearest = frames.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
    let nearest = nearest.ok_or_else(|| refuse("it has no snapshots of particles".to_string()))?;
    let [first, last] = [&frames[0], &frames[frames.len() - 1]].map(|frame| frame.time);
    let apart = (last - first) / (frames.len().max(2) - 1) as f64;
    if off(nearest) <= NEAR * apart {
        return Ok(nearest);
    }
    let found = format!("found no snapshot near t = {at} s; allowed: {first} s to {last} s");
    Err(refuse(format!("{found}, the nearest is at {} s", nearest.time)))
}

/// The bodies of the run of a snapshot, as its record has them.
struct RecordedBodies<'a> {
    record: &'a Value,
    names: &'a [String],
}

impl RecordedBodies<'_> {
    /// The body of a name, in the record.
    fn body(&self, name: &str) -> Option<&Value> {
        let number = self.names.iter().position(|known| known == name)?;
        self.record.pointer(&format!("/bodies/{number}"))
    }

    /// What the bodies of a scene need and a snapshot was not asked to have.
    fn missing(&self, scene: &Scene, file: &ParticleFile, view: &dyn View) -> Vec<String> {
        let asked = |key: &str| self.record.pointer(&format!("/outputs/snapshots/{key}"));
        let list = |key: &str| asked(key).and_then(Value::as_array);
        let mut missing = Vec::new();
        if let Some(every) = asked("every").and_then(Value::as_u64).filter(|&every| every > 1) {
            missing.push(format!("all but each {every}th particle (outputs.snapshots.every)"));
        }
        let carried =
            || (scene.bodies.iter().enumerate()).filter(|(_, body)| self.names.contains(&body.name));
        if let Some(written) = list("bodies") {
            let left_out = carried().filter(|(_, body)| written.iter().all(|name| *name != *body.name));
            missing.extend(
                left_out.map(|(_, body)| format!("the body `{}` (outputs.snapshots.bodies)", body.name)),
            );
        }
        let Some(written) = list("columns") else { return missing };
        let held: Vec<String> = file.columns().map(|column| column.name).collect();
        let mut wanted: Vec<&str> = EVERY
            .iter()
            .map(|column| column.name)
            .filter(|name| optional_in_files().any(|own| own == *name))
            .collect();
        for (i, body) in carried().filter(|(_, body)| !body.is_rigid()) {
            let own = view.columns(i).into_iter().map(|column| column.name);
            let own = own.filter(|name| !EVERY.iter().any(|every| every.name == *name));
            wanted.extend(own.filter(|name| written.iter().all(|column| column != name)));
            let law = self.body(&body.name).and_then(|body| body.get("material")).and_then(Value::as_u64);
            let law = law.and_then(|number| self.record.pointer(&format!("/materials/{number}/law")));
            if kind(law) != kind(serde_json::to_value(scene.materials[body.material].law).ok().as_ref()) {
                missing.push(format!(
                    "all that the law of `{}` remembered (outputs.snapshots.columns)",
                    body.name
                ));
            }
        }
        wanted.dedup();
        let absent = wanted.into_iter().filter(|name| held.iter().all(|held| held != name));
        missing.extend(absent.map(|name| format!("`{name}` (outputs.snapshots.columns)")));
        missing
    }

    /// Looks whether the bodies of a scene have the shapes and fillings of those of the same names: places before
    /// anything moved are in no snapshot.
    fn compare(&self, scene: &Scene) -> Result<(), RestoreError> {
        let now = Manifest::record(scene);
        for (number, body) in scene.bodies.iter().enumerate() {
            let Some(then) = self.body(&body.name) else { continue };
            let here = &now["bodies"][number];
            let pairs = ["shape", "particles", "particles_per_side"].map(|key| [&then[key], &here[key]]);
            let lattice = |key: &str| [&self.record["discretization"][key], &now["discretization"][key]];
            let same = pairs.iter().all(|[then, now]| then == now)
                && ["cell", "particles_per_side"].map(lattice).iter().all(|[then, now]| then == now);
            if !same {
                let name = &body.name;
                return Err(RestoreError::new(format!(
                    "body `{name}` has another shape or another filling in it"
                )));
            }
            let unmoved = |motion: &BodyMotion| match motion {
                BodyMotion::Rigid { velocity, spin } => {
                    velocity.iter().chain(spin.iter()).all(|of| matches!(of, Expression::Constant(0.0)))
                }
                _ => true,
            };
            let unbounded = body.shape.bounds(scene.dimension.axes()).is_none();
            if unbounded && !(unmoved(&body.motion) && then["motion"] == here["motion"]) {
                let name = &body.name;
                return Err(RestoreError::new(format!(
                    "body `{name}` has no bounds and moves: a snapshot does not say where it is, and a checkpoint does"
                )));
            }
        }
        Ok(())
    }
}

/// What a law is called in a record.
fn kind(law: Option<&Value>) -> Option<&str> {
    match law? {
        Value::Object(law) => law.keys().next().map(String::as_str),
        Value::String(law) => Some(law),
        _ => None,
    }
}
