//! The state of a simulation as data: what a checkpoint holds of it.

use super::{ParticleSnapshot, RemovedParticles, WrittenValues};
use crate::column::Kind;
use crate::contact::ContactSums;
use crate::load::LoadSums;
use crate::rigid::{Pose, RigidState};
use crate::step::{JointSums, RelaxationProgress, SavedNodes, TouchForce, WallSums};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use stickslip_reference::contact::Memory;

/// All that a simulation is between two steps, whatever its dimension and precision. A simulation of the same scene
/// that takes it up takes the same steps, bit for bit.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SavedState {
    /// Simulated time [s].
    pub time: f64,
    /// Steps taken.
    pub steps: u64,
    /// How many more count for when spins settle; none in runs that began from no other.
    pub(crate) phase: u64,
    /// The bodies in the order of the scene.
    pub bodies: Vec<SavedBody>,
    /// Fastest signal [m/s]; unknown before the first step.
    pub(crate) signal: Option<f64>,
    /// Energy that damping took [J].
    pub(crate) damping: f64,
    /// The part of it that impacts of rigid bodies took [J].
    pub(crate) impacts: f64,
    /// Work of gravity, where that varies [J].
    pub(crate) gravity_work: f64,
    pub(crate) relaxation: RelaxationProgress,
    pub(crate) loads: Vec<LoadSums>,
    pub(crate) contact_sums: ContactSums,
    pub(crate) unbounded: Vec<SavedUnbounded>,
    /// Of each load, how far its points were from their places where the run began; none if they were there.
    pub(crate) moved: Vec<Vec<[f64; 3]>>,
    pub(crate) joints: Vec<JointSums>,
    pub(crate) springs: Vec<JointSums>,
    pub(crate) walls: Vec<WallSums>,
    pub(crate) longest_rigid: Option<f64>,
    /// What rigid bodies pushed each other with; nothing where none did.
    pub(crate) touch_forces: Vec<TouchForce>,
    /// Nodes of bodies on grids of their own.
    pub(crate) nodes: Vec<SavedNodes>,
    /// Points of these bodies that touch.
    pub(crate) touching: Vec<Memory>,
    /// What left the domain, body by body; nothing where nothing did.
    pub(crate) removed: Vec<RemovedParticles>,
    /// What was written to particles between steps, body by body; nothing where nothing was.
    pub(crate) written: Vec<WrittenValues>,
    /// Whether it comes from a snapshot, which knows less.
    #[serde(skip)]
    pub(crate) of_snapshot: bool,
}

impl SavedState {
    /// All of it but particles: bodies have neither numbers nor columns, but those that have no particles anywhere keep
    /// the names of columns.
    pub fn without_particles(&self) -> Self {
        let names = |body: &SavedBody| match body.numbers.is_empty() {
            true => body.columns.iter().map(SavedColumn::emptied).collect(),
            false => Vec::new(),
        };
        let body = |body: &SavedBody| SavedBody {
            name: body.name.clone(),
            numbers: Vec::new(),
            columns: names(body),
            missing: body.missing,
            motion: body.motion,
        };
        SavedState {
            time: self.time,
            steps: self.steps,
            phase: self.phase,
            bodies: self.bodies.iter().map(body).collect(),
            signal: self.signal,
            damping: self.damping,
            impacts: self.impacts,
            gravity_work: self.gravity_work,
            relaxation: self.relaxation,
            loads: self.loads.clone(),
            contact_sums: self.contact_sums.clone(),
            unbounded: self.unbounded.clone(),
            moved: self.moved.clone(),
            joints: self.joints.clone(),
            springs: self.springs.clone(),
            walls: self.walls.clone(),
            longest_rigid: self.longest_rigid,
            touch_forces: self.touch_forces.clone(),
            nodes: self.nodes.clone(),
            touching: self.touching.clone(),
            removed: self.removed.clone(),
            written: self.written.clone(),
            of_snapshot: self.of_snapshot,
        }
    }

    /// What a snapshot of a run at a time [s] knows of its state, for [`crate::door::Simulation::begin_from`]; it is
    /// none that a simulation of the same scene could take up. `names` are those of its bodies, by their numbers.
    ///
    /// It has not the spin of particles, where they were before anything moved, and momenta of rigid bodies: a scene
    /// that begins from it finds these from its own filling and from the velocities.
    pub fn of_snapshot(snapshot: &ParticleSnapshot, time: f64, names: &[String]) -> Self {
        let places: Vec<Option<usize>> = (0..names.len()).map(Some).collect();
        let mut state = Self::of_frame(time, &[]);
        for SavedShare { body, numbers, columns } in SavedShare::of_snapshot(snapshot, &places) {
            let name = names[body].clone();
            state.bodies.push(SavedBody { name, numbers, columns, motion: None, missing: 0 });
        }
        state
    }

    /// The same without particles, of bodies of these names that have some.
    pub fn of_frame(time: f64, names: &[String]) -> Self {
        let body = |name: &String| SavedBody {
            name: name.clone(),
            numbers: Vec::new(),
            columns: Vec::new(),
            motion: None,
            missing: 0,
        };
        SavedState {
            time,
            steps: 0,
            phase: 0,
            bodies: names.iter().map(body).collect(),
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
            nodes: Vec::new(),
            touching: Vec::new(),
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
    /// Its entries, each the numbers of particles in an order of their places.
    pub fn sorted_lines<'a>(&'a self, order: &'a [u32]) -> impl Iterator<Item = Vec<u8>> + 'a {
        // A state that was read may be anybody's; without a width or particles there is nothing.
        let each = self.width.checked_mul(order.len()).unwrap_or_default();
        let lines = self.bytes.chunks_exact(each.max(1)).filter(move |_| each > 0);
        lines.map(|line| {
            order
                .iter()
                .flat_map(|&place| &line[place as usize * self.width..][..self.width])
                .copied()
                .collect()
        })
    }

    /// The same column of some of so many particles.
    fn part(&self, count: usize, particles: Range<usize>) -> SavedColumn {
        let lines = self.bytes.chunks_exact((self.width * count).max(1));
        let part = particles.start * self.width..particles.end * self.width;
        SavedColumn { bytes: lines.flat_map(|line| &line[part.clone()]).copied().collect(), ..self.emptied() }
    }

    /// The same column of no particles.
    pub(crate) fn emptied(&self) -> SavedColumn {
        SavedColumn { name: self.name.clone(), width: self.width, bytes: Vec::new() }
    }

    /// A column of which there are parts, each of so many particles, at least one; none if they are not of one column.
    fn joined(parts: Vec<(usize, SavedColumn)>) -> Option<SavedColumn> {
        let (_, like) = parts.first()?;
        let entries_of = |(count, part): &(usize, SavedColumn)| {
            let each = part.width.checked_mul(*count).filter(|&each| each > 0)?;
            let whole = part.bytes.len().is_multiple_of(each);
            let same = whole && (&part.name, part.width) == (&like.name, like.width);
            same.then(|| part.bytes.len() / each)
        };
        let entries = entries_of(parts.first()?)?;
        if parts.iter().any(|part| entries_of(part) != Some(entries)) {
            return None;
        }
        let mut bytes = Vec::with_capacity(parts.iter().map(|(_, part)| part.bytes.len()).sum());
        for entry in 0..entries {
            for (count, part) in &parts {
                let each = part.width * count;
                bytes.extend_from_slice(&part.bytes[entry * each..][..each]);
            }
        }
        Some(SavedColumn { bytes, ..like.emptied() })
    }

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
    pub(crate) missing: usize,
    /// Where it is and how it moves, if it is rigid.
    pub(crate) motion: Option<RigidState>,
}

/// Some particles of a body between two steps.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SavedShare {
    /// The body's place in the scene.
    pub body: usize,
    /// Each particle's number in its body.
    pub numbers: Vec<u32>,
    /// What they have.
    pub columns: Vec<SavedColumn>,
}

impl SavedShare {
    /// Particles of a snapshot, body by body, where it is known at which place each of its bodies stands in a state.
    pub fn of_snapshot(snapshot: &ParticleSnapshot, places: &[Option<usize>]) -> Vec<SavedShare> {
        let mut rows = vec![Vec::new(); places.len()];
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
        let share = |(&body, rows): (&Option<usize>, Vec<usize>)| {
            Some(SavedShare {
                body: body.filter(|_| !rows.is_empty())?,
                numbers: rows.iter().map(|&row| snapshot.number[row]).collect(),
                columns: columns
                    .iter()
                    .map(|column| SavedColumn::of(*column, &rows, snapshot.dimension))
                    .collect(),
            })
        };
        places.iter().zip(rows).filter_map(share).collect()
    }

    /// Deals out particles of which bodies have so many, body by body and at most so many at a time: `share` gives some
    /// of a body by their places in memory.
    ///
    /// # Errors
    /// Those of who takes them.
    pub fn deal<E>(
        counts: impl IntoIterator<Item = usize>,
        most: usize,
        share: impl Fn(usize, Range<usize>) -> SavedShare,
        take: &mut dyn FnMut(Vec<SavedShare>) -> Result<(), E>,
    ) -> Result<(), E> {
        let (mut shares, mut room) = (Vec::new(), most);
        for (body, count) in counts.into_iter().enumerate() {
            let mut first = 0;
            while first < count {
                let end = count.min(first + room);
                shares.push(share(body, first..end));
                (first, room) = (end, room - (end - first));
                if room == 0 {
                    take(std::mem::take(&mut shares))?;
                    room = most;
                }
            }
        }
        if shares.is_empty() { Ok(()) } else { take(shares) }
    }
}

impl SavedBody {
    /// Some of its particles, which is the body at this place in the scene.
    pub fn share(&self, body: usize, particles: Range<usize>) -> SavedShare {
        let count = self.numbers.len();
        let columns = self.columns.iter().map(|column| column.part(count, particles.clone()));
        SavedShare { body, numbers: self.numbers[particles.clone()].to_vec(), columns: columns.collect() }
    }

    /// Gives it the particles in these shares; false if they do not have the same columns.
    pub fn fill(&mut self, shares: Vec<SavedShare>) -> bool {
        let Some((numbers, columns)) = SavedShare::joined(shares) else { return false };
        self.numbers = numbers;
        if !self.numbers.is_empty() {
            self.columns = columns;
        }
        true
    }
}

impl SavedShare {
    /// The numbers and columns of all particles in shares of a body, none of shares without any; `None` if they do not
    /// have the same columns.
    pub(crate) fn joined(mut shares: Vec<SavedShare>) -> Option<(Vec<u32>, Vec<SavedColumn>)> {
        shares.retain(|share| !share.numbers.is_empty());
        let numbers: Vec<u32> = shares.iter().flat_map(|share| &share.numbers).copied().collect();
        let count = shares.first().map_or(0, |first| first.columns.len());
        if shares.iter().any(|share| share.columns.len() != count) {
            return None;
        }
        let of_column = |column: usize| {
            let part = |share: &mut SavedShare| {
                let of = &mut share.columns[column];
                let bytes = std::mem::take(&mut of.bytes);
                (share.numbers.len(), SavedColumn { bytes, ..of.emptied() })
            };
            SavedColumn::joined(shares.iter_mut().map(part).collect())
        };
        let columns: Option<Vec<SavedColumn>> = (0..count).map(of_column).collect();
        Some((numbers, columns?))
    }
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
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
#[error("{0}")]
pub struct RestoreError(pub(crate) String);

/// Why ranks do not take up a state.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
pub enum NotTakenUp {
    /// One of them does not find its share of the particles.
    #[error("{0}")]
    Unfound(String),
    /// It belongs to another scene.
    #[error(transparent)]
    Other(#[from] RestoreError),
}

impl RestoreError {
    /// One that says so.
    pub fn new(problem: impl Into<String>) -> Self {
        RestoreError(problem.into())
    }
}
