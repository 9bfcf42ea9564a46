//! A simulation that its Python object, arrays over its memory and a run share: each call takes a lock and gives it
//! back.
//!
//! So a function that a run calls between two steps may ask the simulation whatever it likes. Nobody waits for Python
//! while holding the lock.

use crate::functions::is_in_function;
use rayon::ThreadPool;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use stickslip::column::ColumnDescription;
use stickslip::door::{
    BodyState, ColumnPlace, ColumnRef, ContactPatch, ContactPoint, ContactSum, GridSnapshot, JointState,
    Ledger, LoadState, NoColumn, ParticleSnapshot, ParticleView, RelaxationState, RemovedParticles,
    RestoreError, SavedColumn, SavedState, Simulation, StepError, StepLimit, TracedParticle, View, WallState,
    WriteError, WrittenValues,
};
use stickslip::rigid::Pose;
use stickslip::scene::StartVelocities;

/// A simulation with the threads that it uses.
pub struct Shared {
    simulation: Mutex<Box<dyn Simulation>>,
    pool: ThreadPool,
    /// Arrays over its memory that somebody holds.
    arrays: AtomicUsize,
}

impl Shared {
    /// Of a simulation that these threads step.
    pub fn new(simulation: Box<dyn Simulation>, pool: ThreadPool) -> Self {
        Shared { simulation: Mutex::new(simulation), pool, arrays: AtomicUsize::new(0) }
    }

    /// Threads that step it.
    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// Particles of a body.
    pub fn count(&self, body: usize) -> usize {
        self.lock().column(body, "mass").map_or(0, |mass| mass.len())
    }

    fn lock(&self) -> MutexGuard<'_, Box<dyn Simulation>> {
        // The step that called it holds the lock: waiting for that would take forever.
        assert!(
            !is_in_function(),
            "a law, load or motion in Python asks its simulation; it may use its arguments alone"
        );
        self.simulation.lock().expect("no call of the engine panicked before")
    }

    /// Asks the simulation, whose own loops use its threads.
    fn ask<X: Send>(&self, ask: impl FnOnce(&mut dyn Simulation) -> X + Send) -> X {
        let mut guard = self.lock();
        let simulation: &mut dyn Simulation = &mut **guard;
        self.pool.install(|| ask(simulation))
    }

    /// Changes the simulation; then columns go back to where arrays look for them.
    fn change<X: Send>(&self, change: impl FnOnce(&mut dyn Simulation) -> X + Send) -> X {
        self.ask(|simulation| {
            let outcome = change(simulation);
            if self.arrays.load(Ordering::Relaxed) > 0 {
                simulation.settle();
            }
            outcome
        })
    }
}

/// A hold on a simulation: whoever reads its memory has one as long as it does. While there is any, columns lie where
/// they lay at first, after each step and each state that is taken up.
pub struct Hold(Arc<Shared>);

impl Hold {
    /// A column, held where it lies from now on; none if there is no such column, or it does not stay.
    pub fn column(shared: &Arc<Shared>, body: usize, name: &str) -> Option<(ColumnPlace, Hold)> {
        shared.ask(|simulation| {
            simulation.settle();
            let place = simulation.column_place(body, name)?;
            shared.arrays.fetch_add(1, Ordering::Relaxed);
            Some((place, Hold(Arc::clone(shared))))
        })
    }
}

impl Drop for Hold {
    fn drop(&mut self) {
        self.0.arrays.fetch_sub(1, Ordering::Relaxed);
    }
}

/// The simulation for those who take one: runs, steps to a time, readers of contacts.
#[derive(Clone)]
pub struct Handle(pub Arc<Shared>);

impl Simulation for Handle {
    fn step(&mut self, longest: f64) -> Result<f64, StepError> {
        self.0.change(|simulation| simulation.step(longest))
    }

    fn rebuild_workspace(&mut self) {
        self.0.change(|simulation| simulation.rebuild_workspace());
    }

    fn hold(&mut self) {
        self.0.ask(|simulation| simulation.hold());
    }

    fn take_back(&mut self) -> bool {
        self.0.change(|simulation| simulation.take_back())
    }

    fn settle(&mut self) {
        self.0.change(|simulation| simulation.settle());
    }

    fn write(&mut self, body: usize, name: &str, values: &[f64]) -> Result<(), WriteError> {
        self.0.change(|simulation| simulation.write(body, name, values))
    }

    fn save(&self) -> Option<SavedState> {
        self.0.ask(|simulation| simulation.save())
    }

    fn save_columns(&self, body: usize, take: &mut dyn FnMut(&[u32], SavedColumn)) -> bool {
        self.0.lock().save_columns(body, take)
    }

    /// The bodies have begun where the scene asks for it when the simulation was made; what was changed since stays.
    fn begin_from(&mut self, _: &SavedState, _: StartVelocities) -> Result<(), RestoreError> {
        Ok(())
    }

    fn restore(&mut self, state: SavedState) -> Result<(), RestoreError> {
        self.0.change(|simulation| simulation.restore(state))
    }
}

impl View for Handle {
    fn time(&self) -> f64 {
        self.0.lock().time()
    }

    fn steps(&self) -> u64 {
        self.0.lock().steps()
    }

    fn particles(&self) -> usize {
        self.0.lock().particles()
    }

    fn stable_step(&self) -> f64 {
        self.0.ask(|simulation| simulation.stable_step())
    }

    fn step_limit(&self) -> Option<StepLimit> {
        self.0.ask(|simulation| simulation.step_limit())
    }

    fn bodies(&self) -> Vec<BodyState> {
        self.0.ask(|simulation| simulation.bodies())
    }

    fn poses(&self) -> Vec<Option<Pose>> {
        self.0.lock().poses()
    }

    fn ledger(&self) -> Ledger {
        self.0.ask(|simulation| simulation.ledger())
    }

    fn relaxation(&self) -> Option<RelaxationState> {
        self.0.lock().relaxation()
    }

    fn contact_sums(&self) -> Vec<ContactSum> {
        self.0.ask(|simulation| simulation.contact_sums())
    }

    fn loads(&self) -> Vec<LoadState> {
        self.0.ask(|simulation| simulation.loads())
    }

    fn joints(&self) -> Vec<JointState> {
        self.0.ask(|simulation| simulation.joints())
    }

    fn removed(&self) -> Vec<RemovedParticles> {
        self.0.lock().removed()
    }

    fn written(&self) -> Vec<WrittenValues> {
        self.0.lock().written()
    }

    fn walls(&self) -> Vec<WallState> {
        self.0.ask(|simulation| simulation.walls())
    }

    fn patches(&self) -> Vec<ContactPatch> {
        self.0.ask(|simulation| simulation.patches())
    }

    fn contact_points(&self) -> Vec<ContactPoint> {
        self.0.ask(|simulation| simulation.contact_points())
    }

    fn snapshot(&self) -> ParticleSnapshot {
        self.0.ask(|simulation| simulation.snapshot())
    }

    fn visit(&self, body: usize, look: &mut dyn FnMut(&ParticleView)) {
        self.0.lock().visit(body, look);
    }

    fn fastest(&self, body: usize, against: [f64; 3]) -> Option<ParticleView> {
        self.0.ask(|simulation| simulation.fastest(body, against))
    }

    fn columns(&self, body: usize) -> Vec<ColumnDescription> {
        self.0.lock().columns(body)
    }

    /// A copy: the lock is given back.
    fn column(&self, body: usize, name: &str) -> Result<ColumnRef<'_>, NoColumn> {
        let guard = self.0.lock();
        let column = guard.column(body, name)?;
        let count = column.description.kind.components();
        let mut values = vec![0.0; count * column.len()];
        column.copy_to(&mut values);
        let mut numbers = column.numbers().to_vec();
        numbers.sort_unstable();
        Ok(ColumnRef::new(column.description, numbers, move |row, component| values[row * count + component]))
    }

    fn column_place(&self, body: usize, name: &str) -> Option<ColumnPlace> {
        self.0.lock().column_place(body, name)
    }

    fn trace(&self, body: usize, wanted: &[u32]) -> Vec<TracedParticle> {
        self.0.ask(|simulation| simulation.trace(body, wanted))
    }

    fn grid_snapshot(&self) -> GridSnapshot {
        self.0.ask(|simulation| simulation.grid_snapshot())
    }

    fn timings(&self) -> Vec<(&'static str, f64)> {
        self.0.lock().timings()
    }
}
