//! All observers of a run, asked at the right times.

use super::Observer;
use super::arrivals::ArrivalsObserver;
use super::bodies::BodiesObserver;
use super::contacts::ContactsObserver;
use super::energy::EnergyObserver;
use super::file::OutputError;
use super::folder::OutputFolder;
use super::fringes::FringesObserver;
use super::fronts::FrontsObserver;
use super::grid::GridObserver;
use super::loads::LoadsObserver;
use super::particles::ParticlesObserver;
use super::probes::ProbesObserver;
use crate::door::View;
use crate::scene::Scene;

/// The observers that a scene asks for, and those that are added.
pub struct Recorder<'a> {
    scheduled: Vec<Scheduled<'a>>,
}

struct Scheduled<'a> {
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
        let mut observers: Vec<Box<dyn Observer + 'a>> = vec![
            Box::new(BodiesObserver::create(scene, folder)?),
            Box::new(EnergyObserver::create(scene, folder)?),
            Box::new(ContactsObserver::create(scene, folder)?),
        ];
        if !scene.loads.is_empty() {
            observers.push(Box::new(LoadsObserver::create(scene, folder)?));
        }
        let wanted = &scene.outputs.measurements;
        if !wanted.probes.is_empty() {
            observers.push(Box::new(ProbesObserver::create(scene, folder)?));
        }
        if !wanted.arrivals.is_empty() {
            observers.push(Box::new(ArrivalsObserver::create(scene, folder)?));
        }
        if !wanted.fronts.is_empty() {
            observers.push(Box::new(FrontsObserver::create(scene, folder)?));
        }
        if scene.outputs.particles.is_some() || !scene.outputs.particles_at.is_empty() {
            observers.push(Box::new(ParticlesObserver::create(scene, folder)?));
        }
        if let Some(interval) = scene.outputs.grid {
            observers.push(Box::new(GridObserver::create(interval, folder)?));
        }
        if let Some(camera) = &scene.outputs.fringes {
            observers.push(Box::new(FringesObserver::create((scene, camera), folder)?));
        }
        let scheduled = observers.into_iter().map(|observer| Scheduled { observer, last: None }).collect();
        Ok(Recorder { scheduled })
    }

    /// Adds an observer, to be asked after those of the scene.
    pub fn add(&mut self, observer: impl Observer + 'a) {
        self.scheduled.push(Scheduled { observer: Box::new(observer), last: None });
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
    /// snapshots are replaced: what went wrong is to be seen.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn record_failure(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        self.record_where(view, |output| output.last != Some(time) || output.observer.replaces())
    }

    /// Lets every output write what only the whole run tells: to be called once, after the last record.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn conclude(&mut self) -> Result<(), OutputError> {
        self.scheduled.iter_mut().try_for_each(|output| output.observer.conclude())
    }

    fn record_where(
        &mut self,
        view: &dyn View,
        chosen: impl Fn(&Scheduled) -> bool,
    ) -> Result<(), OutputError> {
        for output in &mut self.scheduled {
            if chosen(output) {
                output.observer.observe(view)?;
                output.last = Some(view.time());
            }
        }
        Ok(())
    }
}
