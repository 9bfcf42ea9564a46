//! All observers of a run, asked at the right times.

use super::arrivals::ArrivalsObserver;
use super::bodies::BodiesObserver;
use super::contacts::ContactsObserver;
use super::energy::EnergyObserver;
use super::fabric::FabricObserver;
use super::file::{OutputError, is_there};
use super::folder::OutputFolder;
use super::fringes::FringesObserver;
use super::fronts::FrontsObserver;
use super::grid::GridObserver;
use super::groups::{GroupsObserver, PAIRS};
use super::joints::JointsObserver;
use super::loads::LoadsObserver;
use super::memory::Memory;
use super::particles::ParticlesObserver;
use super::probes::ProbesObserver;
use super::reactions::ReactionsObserver;
use super::removed::RemovedObserver;
use super::sections::SectionsObserver;
use super::surfaces::SurfacesObserver;
use super::tractions::TractionsObserver;
use super::{
    ARRIVALS, BODIES, CONTACTS, Doubt, ENERGY, FABRIC, FRINGES, FRONTS, GRID, GROUP_CONTACTS, GROUPS, JOINTS,
    LOADS, Observer, PARTICLES, PROBES, REACTIONS, REMOVED, SECTIONS, SURFACES, TRACTIONS,
};
use crate::door::View;
use crate::scene::{Leaving, Scene};

/// Tables that keep their own length over a checkpoint: the file, and the part of the memory where they do.
pub(super) fn tables() -> impl Iterator<Item = (&'static str, String)> {
    let under_their_name = [
        BODIES, ENERGY, CONTACTS, LOADS, JOINTS, REMOVED, SECTIONS, REACTIONS, GROUPS, FABRIC, TRACTIONS,
        PROBES, ARRIVALS, FRONTS,
    ];
    let of_groups = (GROUP_CONTACTS, format!("{GROUPS}/{PAIRS}"));
    under_their_name.map(|name| (name, name.to_string())).into_iter().chain([of_groups])
}

/// The observers that a scene asks for, and those that are added.
pub struct Recorder<'a> {
    scheduled: Vec<Scheduled<'a>>,
    folder: OutputFolder,
}

struct Scheduled<'a> {
    /// Under which it remembers.
    name: String,
    observer: Box<dyn Observer + 'a>,
    /// Time of its last record [s].
    last: Option<f64>,
}

impl<'a> Recorder<'a> {
    /// Makes the files of every output that the scene asks for.
    ///
    /// # Errors
    /// A file cannot be made.
    pub fn new(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        let mut recorder = Recorder { scheduled: Vec::new(), folder: folder.clone() };
        recorder.schedule(BODIES, BodiesObserver::create(scene, folder)?);
        recorder.schedule(ENERGY, EnergyObserver::create(scene, folder)?);
        recorder.schedule(CONTACTS, ContactsObserver::create(scene, folder)?);
        if !scene.loads.is_empty() {
            recorder.schedule(LOADS, LoadsObserver::create(scene, folder)?);
        }
        if scene.joint_names().next().is_some() {
            recorder.schedule(JOINTS, JointsObserver::create(scene, folder)?);
        }
        if scene.domain.as_ref().is_some_and(|domain| domain.leaving == Leaving::Remove) {
            recorder.schedule(REMOVED, RemovedObserver::create(scene, folder)?);
        }
        let wanted = &scene.outputs.measurements;
        if !wanted.sections.is_empty() {
            recorder.schedule(SECTIONS, SectionsObserver::create(scene, folder)?);
        }
        if !wanted.reactions.is_empty() {
            recorder.schedule(REACTIONS, ReactionsObserver::create(scene, folder)?);
        }
        if !wanted.groups.is_empty() {
            recorder.schedule(GROUPS, GroupsObserver::create(scene, folder)?);
        }
        if !wanted.fabric.is_empty() {
            recorder.schedule(FABRIC, FabricObserver::create(scene, folder)?);
        }
        if let Some(asked) = &wanted.tractions {
            recorder.schedule(TRACTIONS, TractionsObserver::create((scene, asked), folder)?);
        }
        if !wanted.probes.is_empty() {
            recorder.schedule(PROBES, ProbesObserver::create(scene, folder)?);
        }
        if !wanted.arrivals.is_empty() {
            recorder.schedule(ARRIVALS, ArrivalsObserver::create(scene, folder)?);
        }
        if !wanted.fronts.is_empty() {
            recorder.schedule(FRONTS, FrontsObserver::create(scene, folder)?);
        }
        if scene.outputs.particles.is_some() || !scene.outputs.particles_at.is_empty() {
            recorder.schedule(PARTICLES, ParticlesObserver::create(scene, folder)?);
        }
        if scene.outputs.surfaces.is_some() {
            recorder.schedule(SURFACES, SurfacesObserver::create(scene, folder)?);
        }
        if scene.outputs.grid.is_some() {
            recorder.schedule(GRID, GridObserver::create(scene, folder)?);
        }
        if let Some(camera) = &scene.outputs.fringes {
            recorder.schedule(FRINGES, FringesObserver::create((scene, camera), folder)?);
        }
        Ok(recorder)
    }

    /// Looks whether the tables that a checkpoint knows are there: before they are opened, which would make them.
    ///
    /// # Errors
    /// One is not.
    pub fn find(folder: &OutputFolder, memory: &Memory) -> Result<(), OutputError> {
        let mut known = tables().filter(|(_, part)| memory.has(&format!("{part}/length")));
        known.try_for_each(|(name, _)| is_there(&folder.join(name), None))
    }

    /// Adds an observer, to be asked after those of the scene.
    pub fn add(&mut self, observer: impl Observer + 'a) {
        let name = format!("added {}", self.scheduled.len());
        self.schedule(&name, observer);
    }

    fn schedule(&mut self, name: &str, observer: impl Observer + 'a) {
        self.scheduled.push(Scheduled { name: name.to_string(), observer: Box::new(observer), last: None });
    }

    /// Lets every output keep what it needs to go on, or take that up, see [`Observer::remember`].
    ///
    /// # Errors
    /// A file cannot be written, or is not as it was.
    pub fn remember(&mut self, view: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        self.scheduled.iter_mut().try_for_each(|Scheduled { name, observer, last }| {
            memory.part(name, |memory| {
                memory.keep("last", last)?;
                observer.remember(view, memory)
            })
        })
    }

    /// Whether something is to be recorded now.
    pub fn is_due(&self, view: &dyn View) -> bool {
        let time = view.time();
        self.scheduled.iter().any(|output| time >= output.observer.next())
    }

    /// Records what is due: to be called after each step.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn record_due(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        self.record_where(view, |output| time >= output.observer.next())
    }

    /// Records the present state in every output that does not have it yet: at the start and the end of a run.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn record_present(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        self.record_where(view, |output| output.last != Some(time))
    }

    /// Records the state in which a step failed. If the time did not advance, tables keep the row that they have and
    /// snapshots are replaced: what went wrong is to be seen. Tables take no rows with numbers that are not finite.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn record_failure(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        self.folder.is_in_place()?;
        let due = |output: &&mut Scheduled| output.last != Some(time) || output.observer.replaces();
        self.scheduled.iter_mut().filter(due).try_for_each(|output| match output.observer.observe(view) {
            Err(error) if error.is_no_number() => Ok(()),
            other => other.map(|()| output.last = Some(time)),
        })
    }

    /// Lets every output write what only the whole run tells: to be called once, after the last record.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn conclude(&mut self) -> Result<(), OutputError> {
        self.scheduled.iter_mut().try_for_each(|output| output.observer.conclude())
    }

    /// What makes records doubtful, once they are concluded: see [`Observer::doubts`].
    pub fn doubts(&self) -> impl Iterator<Item = Doubt> {
        self.scheduled.iter().flat_map(|output| output.observer.doubts())
    }

    fn record_where(
        &mut self,
        view: &dyn View,
        chosen: impl Fn(&Scheduled) -> bool,
    ) -> Result<(), OutputError> {
        let mut due = self.scheduled.iter_mut().filter(|output| chosen(output)).peekable();
        if due.peek().is_some() {
            self.folder.is_in_place()?;
        }
        due.try_for_each(|output| {
            output.observer.observe(view)?;
            output.last = Some(view.time());
            Ok(())
        })
    }
}
