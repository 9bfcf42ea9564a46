//! `removed.csv`: particles that left the domain and were taken out, and what went with them.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::memory::Memory;
use super::schedule::Schedule;
use super::table::{CellValue, CsvTable, TableRow, columns};
use super::{Observer, REMOVED};
use crate::door::{RemovedParticles, View};
use crate::scene::Scene;

/// What one body has lost since the start; the columns of `removed.csv`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RemovedRow {
    /// Simulated time [s].
    pub time: f64,
    /// Name of the body.
    pub body: String,
    /// Particles.
    pub particles: usize,
    /// Their mass [kg].
    pub mass: f64,
    /// Their kinetic, strain and potential energy when they were taken out [J].
    pub energy: f64,
    /// Their momentum [kg m/s].
    pub momentum: [f64; 3],
    /// Their angular momentum about the origin [kg m^2/s].
    pub angular_momentum: [f64; 3],
}

impl TableRow for RemovedRow {
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
        let Self { time, body, particles, mass, energy, .. } = self;
        let Self { momentum: [px, py, pz], angular_momentum: [lx, ly, lz], .. } = self;
        columns![time, body, particles, mass, energy, px, py, pz, lx, ly, lz]
    }
}

/// Writes `removed.csv`: a row for each body that has lost particles.
pub(super) struct RemovedObserver {
    names: Vec<String>,
    schedule: Schedule,
    table: CsvTable<RemovedRow>,
}

impl RemovedObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        Ok(RemovedObserver {
            names: scene.bodies.iter().map(|body| body.name.clone()).collect(),
            schedule: Schedule::every(scene.outputs.tables),
            table: CsvTable::create(folder, REMOVED, scene.outputs.measurements.unit())?,
        })
    }
}

impl Observer for RemovedObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let (time, removed) = (view.time(), view.removed());
        let row = |(body, removed): (&String, RemovedParticles)| {
            let RemovedParticles { count, mass, energy, momentum, angular_momentum, .. } = removed;
            let particles = count as usize;
            let body = body.clone();
            (count > 0).then_some(RemovedRow {
                time,
                body,
                particles,
                mass,
                energy,
                momentum,
                angular_momentum,
            })
        };
        self.table.append(self.names.iter().zip(removed).filter_map(row))?;
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.table.finish()
    }

    fn remember(&mut self, _: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        self.schedule.remember(memory)?;
        self.table.remember(memory)
    }
}
