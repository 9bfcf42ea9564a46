//! The state of a simulation as data: what a checkpoint holds of it.

use super::{ParticleSnapshot, RemovedParticles, WrittenValues};
use crate::column::Kind;
use crate::contact::ContactSums;
use crate::load::LoadSums;
use crate::rigid::{Pose, RigidState};
use crate::step::{JointSums, RelaxationProgress, TouchForce, WallSums};
use serde::{Deserialize, Serialize};

/// All that a simulation is between two steps, whatever its dimension and precision. A simulation of the same scene
/// that takes it up takes the same steps, bit for bit.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SavedState {
    /// Simulated time [s].
    pub time: f64,
    /// Steps taken.
    pub steps: u64,
    /// How many more count for when spins settle; none in runs that began from no other.
    #[serde(default)]
    pub(crate) phase: u64,
    /// The bodies in the order of the scene.
    pub bodies: Vec<SavedBody>,
    /// Fastest signal [m/s]; unknown before the first step.
    pub(crate) signal: Option<f64>,
    /// Energy that damping took [J].
    pub(crate) damping: f64,
    /// The part of it that impacts of rigid bodies took [J].
    #[serde(default)]
    pub(crate) impacts: f64,
    /// Work of gravity, where that varies [J].
    #[serde(default)]
    pub(crate) gravity_work: f64,
    pub(crate) relaxation: RelaxationProgress,
    pub(crate) loads: Vec<LoadSums>,
    pub(crate) contact_sums: ContactSums,
    pub(crate) unbounded: Vec<SavedUnbounded>,
    /// Of each load, how far its points were from their places where the run began; none if they were there.
    pub(crate) moved: Vec<Vec<[f64; 3]>>,
    #[serde(default)]
    pub(crate) joints: Vec<JointSums>,
    #[serde(default)]
    pub(crate) springs: Vec<JointSums>,
    #[serde(default)]
    pub(crate) walls: Vec<WallSums>,
    #[serde(default)]
    pub(crate) longest_rigid: Option<f64>,
    /// What rigid bodies pushed each other with; nothing where none did.
    #[serde(default)]
    pub(crate) touch_forces: Vec<TouchForce>,
    /// What left the domain, body by body; nothing where nothing did.
    #[serde(default)]
    pub(crate) removed: Vec<RemovedParticles>,
    /// What was written to particles between steps, body by body; nothing where nothing was.
    #[serde(default)]
    pub(crate) written: Vec<WrittenValues>,
    /// Whether it comes from a snapshot, which knows less.
    #[serde(skip)]
    pub(crate) of_snapshot: bool,
}

impl SavedState {
    /// What a snapshot of a run at a time [s] knows of its state, for [`crate::door::Simulation::begin_from`]; it is
    /// none that a simulation of the same scene could take up. `names` are those of its bodies, by their numbers.
    ///
    /// It has not the spin of particles, where they were before anything moved, and momenta of rigid bodies: a scene
    /// that begins from it finds these from its own filling and from the velocities.
    pub fn of_snapshot(snapshot: &ParticleSnapshot, time: f64, names: &[String]) -> Self {
        let mut rows = vec![Vec::new(); names.len()];
        for (row, &body) in snapshot.body.iter().enumerate() {
            if let Some(rows) = rows.get_mut(body as usize) {
                rows.push(row);
            }
        }
        let history =
            snapshot.history.iter().map(|column| (&column.name[..], column.kind, &column.values[..]));
        let columns: Vec<(&str, Kind, &[f64])> = snapshot
            .columns()
            .map(|(column, values)| (column.name, column.kind, values))
            .chain(history)
            .collect();
        let body = |(name, rows): (&String, Vec<usize>)| SavedBody {
            name: name.clone(),
            numbers: rows.iter().map(|&row| snapshot.number[row]).collect(),
            columns: columns
                .iter()
                .map(|column| SavedColumn::of(*column, &rows, snapshot.dimension))
                .collect(),
            motion: None,
            missing: 0,
        };
        SavedState {
            time,
            steps: 0,
            phase: 0,
            bodies: names.iter().zip(rows).filter(|(_, rows)| !rows.is_empty()).map(body).collect(),
            signal: None,
            damping: 0.0,
            impacts: 0.0,
            relaxation: RelaxationProgress::default(),
            loads: Vec::new(),
            contact_sums: ContactSums::default(),
            unbounded: Vec::new(),
            moved: Vec::new(),
            joints: Vec::new(),
            springs: Vec::new(),
            touch_forces: Vec::new(),
            walls: Vec::new(),
            gravity_work: 0.0,
            removed: Vec::new(),
            written: Vec::new(),
            longest_rigid: None,
            of_snapshot: true,
        }
    }
}

impl SavedColumn {
    /// Some rows of a column with all components in space.
    fn of((name, kind, values): (&str, Kind, &[f64]), rows: &[usize], dimension: usize) -> Self {
        let places = (0..kind.entries(dimension)).map(|entry| kind.place(dimension, entry));
        let numbers =
            places.flat_map(|place| rows.iter().map(move |row| values[row * kind.components() + place]));
        let bytes = numbers.flat_map(f64::to_le_bytes).collect();
        SavedColumn { name: name.to_string(), width: size_of::<f64>(), bytes }
    }
}

/// A body between two steps.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SavedBody {
    /// Its name in the scene.
    pub name: String,
    /// Each particle's number in its body, in the order of memory.
    pub numbers: Vec<u32>,
    /// What its particles have.
    pub columns: Vec<SavedColumn>,
    /// How many of its particles have left the domain and are not there.
    #[serde(default)]
    pub(crate) missing: usize,
    /// Where it is and how it moves, if it is rigid.
    pub(crate) motion: Option<RigidState>,
}

/// A column of particles.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SavedColumn {
    /// Its name, see [`crate::column::EVERY`] and the laws' histories.
    pub name: String,
    /// Bytes of a number: 4 or 8.
    pub width: usize,
    /// Its entries that the motion leaves free, one behind the other: each the numbers of all particles in the order of
    /// memory, little-endian, IEEE 754.
    #[serde(with = "serde_bytes")]
    pub bytes: Vec<u8>,
}

/// Where a rigid body without bounds has particles.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct SavedUnbounded {
    pub served: Vec<Vec<i32>>,
    pub pose: Option<Pose>,
}

/// A state that belongs to another scene than the simulation that should take it up.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct RestoreError(pub(crate) String);

impl RestoreError {
    /// One that says so.
    pub fn new(problem: impl Into<String>) -> Self {
        RestoreError(problem.into())
    }
}
