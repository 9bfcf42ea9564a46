//! `energy.csv`: where the energy is and went, and the momentum of everything.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::memory::Memory;
use super::schedule::Schedule;
use super::table::{CellValue, CsvTable, TableRow, columns};
use super::{ENERGY, Observer};
use crate::door::{Ledger, View};
use crate::scene::Scene;

/// Energy and momentum of everything at one time; the columns of `energy.csv`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EnergyRow {
    /// Simulated time [s].
    pub time: f64,
    /// What each term is; impulses and nodes that are counted have no column.
    pub ledger: Ledger,
}

impl TableRow for EnergyRow {
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
        let Self { time, ledger } = self;
        let Ledger { kinetic, strain, potential, external_work, friction, adhesion, .. } = ledger;
        let Ledger {
            plastic, damping, total, momentum: [px, py, pz], angular_momentum: [lx, ly, lz], ..
        } = ledger;
        columns![
            time,
            kinetic,
            strain,
            potential,
            external_work,
            friction,
            adhesion,
            plastic,
            damping,
            total,
            px,
            py,
            pz,
            lx,
            ly,
            lz
        ]
    }
}

/// Writes `energy.csv`.
pub(super) struct EnergyObserver {
    schedule: Schedule,
    table: CsvTable<EnergyRow>,
}

impl EnergyObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        Ok(EnergyObserver {
            schedule: Schedule::every(scene.outputs.tables),
            table: CsvTable::create(folder, ENERGY, scene.outputs.measurements.unit())?,
        })
    }
}

impl Observer for EnergyObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        self.table.append([EnergyRow { time, ledger: view.ledger() }])?;
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
