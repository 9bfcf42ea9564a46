//! `loads.csv`: forces and moments of supports and loads, and how far their parts have moved.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::memory::Memory;
use super::schedule::Schedule;
use super::table::{CellValue, CsvTable, TableRow, columns};
use super::{LOADS, Observer};
use crate::door::{LoadState, View};
use crate::scene::Scene;

/// What a support or a load did, its force averaged from the row before to this one; the columns of `loads.csv`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadRow {
    /// Simulated time at which the average ends [s].
    pub time: f64,
    /// Name of the support or load.
    pub load: String,
    /// Mean force on the body since the row before [N].
    pub force: [f64; 3],
    /// Mean moment on it about the middle of its part since the row before [N m].
    pub moment: [f64; 3],
    /// Mean displacement of its part now [m].
    pub displacement: [f64; 3],
    /// Work on the body since the start [J].
    pub work: f64,
}

impl TableRow for LoadRow {
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
        let Self { time, load, force: [fx, fy, fz], moment: [mx, my, mz], .. } = self;
        let Self { displacement: [ux, uy, uz], work, .. } = self;
        columns![time, load, fx, fy, fz, mx, my, mz, ux, uy, uz, work]
    }
}

/// Writes `loads.csv`; each row is the mean since the row before.
pub(super) struct LoadsObserver {
    names: Vec<String>,
    /// Time of the last row [s], and what was known then.
    before: (f64, Vec<LoadState>),
    schedule: Schedule,
    table: CsvTable<LoadRow>,
}

impl LoadsObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        Ok(LoadsObserver {
            names: scene.loads.iter().map(|load| load.name.clone()).collect(),
            before: (0.0, vec![LoadState::default(); scene.loads.len()]),
            schedule: Schedule::every(scene.outputs.tables),
            table: CsvTable::create(folder, LOADS, scene.outputs.measurements.unit())?,
        })
    }
}

impl Observer for LoadsObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let (time, now) = (view.time(), view.loads());
        let (since, before) = std::mem::replace(&mut self.before, (time, now.clone()));
        let elapsed = time - since;
        // The start has no time before it to average over.
        if elapsed > 0.0 {
            let mean =
                |now: [f64; 3], before: [f64; 3]| std::array::from_fn(|i| (now[i] - before[i]) / elapsed);
            let rows = self.names.iter().zip(now.iter().zip(&before)).map(|(name, (now, before))| LoadRow {
                time,
                load: name.clone(),
                force: mean(now.impulse, before.impulse),
                moment: mean(now.moment, before.moment),
                displacement: now.displacement,
                work: now.work,
            });
            self.table.append(rows)?;
        }
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.table.finish()
    }

    fn remember(&mut self, _: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("before", &mut self.before)?;
        self.before.1.resize(self.names.len(), LoadState::default());
        self.schedule.remember(memory)?;
        self.table.remember(memory)
    }
}
