//! A simulation that several ranks share, as the first of them sees it.
//!
//! The first rank has a [`Simulation`] like any other: [`lead`] gives it. The others [`follow`]: whatever the first one
//! asks of its simulation, it tells them, and all of them do it together. So a run, its outputs and its checks are
//! written once, for a simulation, and only the first rank has them. What it is shown of particles (a snapshot, a state
//! as data, a column) it holds for as long as it looks.

use crate::column::ColumnDescription;
use crate::contact::ContactSums;
use crate::door::{
    BodyState, ColumnRef, ContactPatch, ContactSum, GridSnapshot, JointState, Ledger, LoadState, NoColumn,
    ParticleSnapshot, ParticleView, RankShare, RelaxationState, RemovedParticles, RestoreError, SavedBody,
    SavedColumn, SavedState, Simulation, StepError, StepLimit, TracedParticle, View, WallState, WriteError,
    WrittenValues,
};
use crate::lanes::Processor;
use crate::ranks::{Ranks, Threads, all_of, bytes_of, read};
use crate::rigid::Pose;
use crate::scene::{Problem, Scene, StartVelocities};
use crate::step::{self, ParticleLoop};
use rayon::ThreadPoolBuilder;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The simulation of a scene, which other ranks share; they [`follow`] until it is dropped.
///
/// # Errors
/// What [`crate::check::problems`] finds, and what ranks cannot share yet: the others find the same.
pub fn lead(
    scene: &Scene,
    path: ParticleLoop,
    ranks: Arc<dyn Ranks>,
) -> Result<Box<dyn Simulation>, Problem> {
    Ok(Box::new(Leader(Part::new(scene, path, ranks)?)))
}

/// Does what the first rank asks of the simulation of this scene, until it drops it.
///
/// # Errors
/// What [`lead`] finds.
pub fn follow(scene: &Scene, path: ParticleLoop, ranks: Arc<dyn Ranks>) -> Result<(), Problem> {
    let mut part = Part::new(scene, path, ranks)?;
    while part.obey() {}
    Ok(())
}

/// What the first of so many ranks makes of the simulation of a scene: threads of this process, each with a pool of one
/// thread. For tests and measurements; one process with as many threads is faster.
pub fn among_threads<X: Send>(
    scene: &Scene,
    count: usize,
    act: impl FnOnce(Result<Box<dyn Simulation>, Problem>) -> X + Send,
) -> X {
    let path = ParticleLoop::Lanes(Processor::best());
    // A pool for each: who waits for another rank keeps a thread of its pool.
    let pool = || ThreadPoolBuilder::new().num_threads(1).build().expect("the system gives a thread");
    std::thread::scope(|scope| {
        let mut ranks = Threads::start(count.max(1)).into_iter();
        let first = ranks.next().expect("there is one");
        for other in ranks {
            // What is wrong with the scene, the first one says.
            scope.spawn(move || pool().install(|| follow(scene, path, Arc::new(other))));
        }
        pool().install(|| act(lead(scene, path, Arc::new(first))))
    })
}

/// What the first rank asks of all, itself included.
#[derive(Serialize, Deserialize)]
enum Call {
    Step(f64),
    Rebuild,
    Hold,
    TakeBack,
    Settle,
    StableStep,
    StepLimit,
    Particles,
    Bodies,
    Ledger,
    Loads,
    ContactSums,
    Patches,
    Snapshot,
    Visit(usize),
    Fastest(usize, [f64; 3]),
    Column(usize, String),
    Trace(usize, Vec<u32>),
    Grid,
    Shares,
    Save,
    SaveColumns(usize),
    /// A state follows.
    Restore,
    /// A state follows; whether it is that of a snapshot, and what becomes of velocities.
    BeginFrom(bool, StartVelocities),
    End,
}

/// One rank's part of a simulation. All ranks make the same calls of it in the same order, and the first gets what they
/// give together.
struct Part {
    own: Box<dyn Simulation>,
    scene: Scene,
    path: ParticleLoop,
    ranks: Arc<dyn Ranks>,
}

/// The first rank's.
struct Leader(Part);

/// [`bytes_of`] where fields may be left out: with their names.
fn named_bytes_of(said: &impl Serialize) -> Vec<u8> {
    rmp_serde::to_vec_named(said).expect("memory takes what is written")
}

impl Part {
    fn new(scene: &Scene, path: ParticleLoop, ranks: Arc<dyn Ranks>) -> Result<Self, Problem> {
        let own = step::build_among(scene, path, ranks.clone())?;
        Ok(Part { own, scene: scene.clone(), path, ranks })
    }

    /// What each rank says, by rank, for the first.
    fn gathered<X: Serialize + DeserializeOwned>(&self, said: &X) -> Vec<X> {
        all_of(self.ranks.tell_first(&bytes_of(said)))
    }

    /// Does what the first rank asks; false if that was the last.
    fn obey(&mut self) -> bool {
        match read(&self.ranks.hear_first(&[])) {
            // A step that fails does so on all ranks, and the first tells the user.
            Call::Step(longest) => drop(self.own.step(longest)),
            Call::Rebuild => self.own.rebuild_workspace(),
            Call::Hold => self.own.hold(),
            Call::TakeBack => drop(self.own.take_back()),
            Call::Settle => self.own.settle(),
            Call::StableStep => drop(self.own.stable_step()),
            Call::StepLimit => drop(self.own.step_limit()),
            Call::Particles => drop(self.particles()),
            Call::Bodies => drop(self.own.bodies()),
            Call::Ledger => drop(self.own.ledger()),
            Call::Loads => drop(self.own.loads()),
            Call::ContactSums => drop(self.contact_sums()),
            Call::Patches => drop(self.patches()),
            Call::Snapshot => drop(self.snapshot()),
            Call::Visit(body) => drop(self.views(body)),
            Call::Fastest(body, against) => drop(self.fastest(body, against)),
            Call::Column(body, name) => drop(self.column(body, &name)),
            Call::Trace(body, numbers) => drop(self.trace(body, &numbers)),
            Call::Grid => drop(self.grid_snapshot()),
            Call::Shares => drop(self.shares()),
            Call::Save => drop(self.save()),
            Call::SaveColumns(body) => drop(self.save_columns(body, &mut |_, _| ())),
            Call::Restore => {
                let state = read(&self.ranks.hear_first(&[]));
                drop(self.begin_anew(|whole| whole.restore(state)));
            }
            Call::BeginFrom(of_snapshot, velocities) => {
                let state = SavedState { of_snapshot, ..read(&self.ranks.hear_first(&[])) };
                drop(self.begin_anew(|whole| whole.begin_from(&state, velocities)));
            }
            Call::End => return false,
        }
        true
    }

    fn particles(&self) -> usize {
        self.gathered(&self.own.particles()).iter().sum()
    }

    fn contact_sums(&self) -> Vec<ContactSum> {
        let mut all = self.gathered(&self.own.contact_sums()).concat();
        all.sort_unstable_by_key(|sum| sum.bodies);
        all
    }

    fn patches(&self) -> Vec<ContactPatch> {
        let mut all = self.gathered(&self.own.patches()).concat();
        all.sort_unstable_by_key(|patch| (patch.body_a, patch.body_b));
        all
    }

    fn snapshot(&self) -> ParticleSnapshot {
        ParticleSnapshot::merged(self.gathered(&self.own.snapshot()))
    }

    /// The particles of a body as they can be seen, by their numbers.
    fn views(&self, body: usize) -> Vec<ParticleView> {
        let mut own = Vec::new();
        self.own.visit(body, &mut |particle| own.push(*particle));
        let mut all = self.gathered(&own).concat();
        all.sort_unstable_by_key(|particle| particle.number);
        all
    }

    fn fastest(&self, body: usize, against: [f64; 3]) -> Option<ParticleView> {
        let square = |particle: &ParticleView| -> f64 {
            (0..3).map(|i| (particle.velocity[i] - against[i]).powi(2)).sum()
        };
        let all = self.gathered(&self.own.fastest(body, against));
        all.into_iter().flatten().max_by(|a, b| square(a).total_cmp(&square(b)).then(b.number.cmp(&a.number)))
    }

    /// The numbers of a body's particles, and their components in space one particle after the other.
    fn column(&self, body: usize, name: &str) -> Result<(ColumnDescription, Vec<u32>, Vec<f64>), NoColumn> {
        let column = self.own.column(body, name)?;
        let (count, numbers) = (column.description.kind.components(), column.numbers().to_vec());
        let values = column.values();
        let all = self.gathered(&(numbers, values));
        let numbers: Vec<u32> = all.iter().flat_map(|(numbers, _)| numbers).copied().collect();
        let values: Vec<f64> = all.iter().flat_map(|(_, values)| values).copied().collect();
        debug_assert_eq!(values.len(), count * numbers.len());
        Ok((column.description, numbers, values))
    }

    fn trace(&self, body: usize, numbers: &[u32]) -> Vec<TracedParticle> {
        let mut all = self.gathered(&self.own.trace(body, numbers)).concat();
        all.sort_unstable_by_key(|particle| particle.number);
        all
    }

    fn grid_snapshot(&self) -> GridSnapshot {
        GridSnapshot::merged(self.gathered(&self.own.grid_snapshot()))
    }

    fn shares(&self) -> Vec<RankShare> {
        self.gathered(&self.own.shares()).concat()
    }

    fn save(&self) -> Option<SavedState> {
        let own = self.own.save()?;
        let mut all: Vec<_> = self.gathered(&own.bodies).into_iter().map(Vec::into_iter).collect();
        let of_body = |_| SavedBody::merged(all.iter_mut().filter_map(Iterator::next).collect());
        let bodies = own.bodies.iter().filter_map(of_body).collect();
        let sums = self.ranks.tell_first(&named_bytes_of(&own.contact_sums));
        let contact_sums = ContactSums::merged(all_of(sums));
        Some(SavedState { bodies, contact_sums, ..own })
    }

    fn save_columns(&self, body: usize, take: &mut dyn FnMut(&[u32], SavedColumn)) -> bool {
        let mut known: Option<(Vec<u32>, Vec<usize>)> = None;
        self.own.save_columns(body, &mut |numbers, column| {
            let (numbers, ends) = known.get_or_insert_with(|| {
                let all = self.gathered(&numbers.to_vec());
                (all.concat(), all.iter().map(Vec::len).collect())
            });
            let parts = self.gathered(&column);
            if let Some(column) = SavedColumn::merged(parts, ends) {
                take(numbers, column);
            }
        })
    }

    /// Begins with another state, which the whole simulation takes up before it is shared.
    fn begin_anew(
        &mut self,
        begin: impl FnOnce(&mut dyn Simulation) -> Result<(), RestoreError>,
    ) -> Result<(), RestoreError> {
        self.own = step::build_among_from(&self.scene, self.path, self.ranks.clone(), begin)?;
        Ok(())
    }
}

impl Leader {
    /// Tells the others what all are to do.
    fn tell(&self, call: &Call) -> &Part {
        self.0.ranks.hear_first(&bytes_of(call));
        &self.0
    }

    fn tell_mut(&mut self, call: &Call) -> &mut Part {
        self.tell(call);
        &mut self.0
    }
}

impl Drop for Leader {
    /// The others follow no longer; those of a rank that panics may not hear it.
    fn drop(&mut self) {
        if !std::thread::panicking() {
            self.tell(&Call::End);
        }
    }
}

impl View for Leader {
    fn time(&self) -> f64 {
        self.0.own.time()
    }

    fn steps(&self) -> u64 {
        self.0.own.steps()
    }

    fn particles(&self) -> usize {
        self.tell(&Call::Particles).particles()
    }

    fn stable_step(&self) -> f64 {
        self.tell(&Call::StableStep).own.stable_step()
    }

    fn step_limit(&self) -> Option<StepLimit> {
        self.tell(&Call::StepLimit).own.step_limit()
    }

    fn bodies(&self) -> Vec<BodyState> {
        self.tell(&Call::Bodies).own.bodies()
    }

    fn poses(&self) -> Vec<Option<Pose>> {
        self.0.own.poses()
    }

    fn ledger(&self) -> Ledger {
        self.tell(&Call::Ledger).own.ledger()
    }

    fn relaxation(&self) -> Option<RelaxationState> {
        self.0.own.relaxation()
    }

    fn contact_sums(&self) -> Vec<ContactSum> {
        self.tell(&Call::ContactSums).contact_sums()
    }

    fn loads(&self) -> Vec<LoadState> {
        self.tell(&Call::Loads).own.loads()
    }

    fn joints(&self) -> Vec<JointState> {
        self.0.own.joints()
    }

    fn walls(&self) -> Vec<WallState> {
        self.0.own.walls()
    }

    fn patches(&self) -> Vec<ContactPatch> {
        self.tell(&Call::Patches).patches()
    }

    fn removed(&self) -> Vec<RemovedParticles> {
        self.0.own.removed()
    }

    fn written(&self) -> Vec<WrittenValues> {
        self.0.own.written()
    }

    fn snapshot(&self) -> ParticleSnapshot {
        self.tell(&Call::Snapshot).snapshot()
    }

    fn visit(&self, body: usize, look: &mut dyn FnMut(&ParticleView)) {
        self.tell(&Call::Visit(body)).views(body).iter().for_each(look);
    }

    fn fastest(&self, body: usize, against: [f64; 3]) -> Option<ParticleView> {
        self.tell(&Call::Fastest(body, against)).fastest(body, against)
    }

    fn columns(&self, body: usize) -> Vec<ColumnDescription> {
        self.0.own.columns(body)
    }

    fn column(&self, body: usize, name: &str) -> Result<ColumnRef<'_>, NoColumn> {
        let found = self.tell(&Call::Column(body, name.to_string())).column(body, name);
        let (description, numbers, values) = found?;
        let count = description.kind.components();
        Ok(ColumnRef::new(description, numbers, move |row, k| values[row * count + k]))
    }

    fn trace(&self, body: usize, numbers: &[u32]) -> Vec<TracedParticle> {
        self.tell(&Call::Trace(body, numbers.to_vec())).trace(body, numbers)
    }

    fn grid_snapshot(&self) -> GridSnapshot {
        self.tell(&Call::Grid).grid_snapshot()
    }

    fn timings(&self) -> Vec<(&'static str, f64)> {
        self.0.own.timings()
    }

    fn shares(&self) -> Vec<RankShare> {
        self.tell(&Call::Shares).shares()
    }
}

impl Simulation for Leader {
    fn step(&mut self, longest: f64) -> Result<f64, StepError> {
        self.tell_mut(&Call::Step(longest)).own.step(longest)
    }

    fn rebuild_workspace(&mut self) {
        self.tell_mut(&Call::Rebuild).own.rebuild_workspace();
    }

    fn hold(&mut self) {
        self.tell_mut(&Call::Hold).own.hold();
    }

    fn take_back(&mut self) -> bool {
        self.tell_mut(&Call::TakeBack).own.take_back()
    }

    fn settle(&mut self) {
        self.tell_mut(&Call::Settle).own.settle();
    }

    fn write(&mut self, _: usize, _: &str, _: &[f64]) -> Result<(), WriteError> {
        Err(WriteError::Shared)
    }

    fn save(&self) -> Option<SavedState> {
        self.tell(&Call::Save).save()
    }

    fn save_columns(&self, body: usize, take: &mut dyn FnMut(&[u32], SavedColumn)) -> bool {
        self.tell(&Call::SaveColumns(body)).save_columns(body, take)
    }

    fn begin_from(&mut self, state: &SavedState, velocities: StartVelocities) -> Result<(), RestoreError> {
        let part = self.tell_mut(&Call::BeginFrom(state.of_snapshot, velocities));
        part.ranks.hear_first(&named_bytes_of(state));
        part.begin_anew(|whole| whole.begin_from(state, velocities))
    }

    fn restore(&mut self, state: SavedState) -> Result<(), RestoreError> {
        let part = self.tell_mut(&Call::Restore);
        part.ranks.hear_first(&named_bytes_of(&state));
        part.begin_anew(|whole| whole.restore(state))
    }
}

impl SavedBody {
    /// A body whose parts ranks have.
    fn merged(mut parts: Vec<SavedBody>) -> Option<SavedBody> {
        let counts: Vec<usize> = parts.iter().map(|part| part.numbers.len()).collect();
        let columns = (0..parts.first()?.columns.len()).filter_map(|column| {
            let of_part = |part: &mut SavedBody| SavedColumn {
                name: part.columns[column].name.clone(),
                width: part.columns[column].width,
                bytes: std::mem::take(&mut part.columns[column].bytes),
            };
            SavedColumn::merged(parts.iter_mut().map(of_part).collect(), &counts)
        });
        let columns = columns.collect();
        let numbers = parts.iter().flat_map(|part| &part.numbers).copied().collect();
        let first = parts.swap_remove(0);
        // Each rank misses those of the others.
        let missing = first.missing.saturating_sub(counts[1..].iter().sum());
        Some(SavedBody { columns, numbers, missing, ..first })
    }
}

impl SavedColumn {
    /// A column whose parts ranks have, of so many particles each: entry by entry, those of one behind the other.
    fn merged(parts: Vec<SavedColumn>, counts: &[usize]) -> Option<SavedColumn> {
        let width = parts.first()?.width;
        let entries = parts.iter().zip(counts).find(|(_, count)| **count > 0);
        let entries = entries.map_or(0, |(part, count)| part.bytes.len() / (width * count));
        let mut bytes = Vec::with_capacity(parts.iter().map(|part| part.bytes.len()).sum());
        for entry in 0..entries {
            for (part, count) in parts.iter().zip(counts) {
                bytes.extend_from_slice(&part.bytes[entry * width * count..(entry + 1) * width * count]);
            }
        }
        parts.into_iter().next().map(|first| SavedColumn { bytes, ..first })
    }
}
