//! `bodies.csv`: where each body is and how it moves.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::memory::Memory;
use super::schedule::Schedule;
use super::table::{CellValue, CsvTable, TableRow, columns};
use super::{BODIES, Observer};
use crate::door::{BodyState, View};
use crate::scene::{Body, Scene};
use std::collections::HashSet;

/// One body at one time, in SI units; the columns of `bodies.csv`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyRow {
    /// Simulated time [s].
    pub time: f64,
    /// Name of the body.
    pub body: String,
    /// Its mass, motion and energy; the angular momentum has no column.
    pub state: BodyState,
}

impl TableRow for BodyRow {
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
        let Self { time, body, state } = self;
        let BodyState { mass, position: [x, y, z], velocity: [vx, vy, vz], spin: [wx, wy, wz], .. } = state;
        let BodyState { kinetic, strain, .. } = state;
        columns![time, body, mass, x, y, z, vx, vy, vz, wx, wy, wz, kinetic, strain]
    }
}

/// Writes `bodies.csv`.
pub(super) struct BodiesObserver {
    names: Vec<String>,
    /// Which of them have rows.
    wanted: Vec<bool>,
    schedule: Schedule,
    table: CsvTable<BodyRow>,
}

impl BodiesObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        let of_choice = scene.outputs.bodies.as_ref().map(|names| {
            let answered = scene.references.iter().map(|reference| &reference.body);
            names.iter().chain(answered).collect::<HashSet<_>>()
        });
        let is_wanted = |body: &Body| of_choice.as_ref().is_none_or(|wanted| wanted.contains(&body.name));
        Ok(BodiesObserver {
            wanted: scene.bodies.iter().map(is_wanted).collect(),
            names: scene.bodies.iter().map(|body| body.name.clone()).collect(),
            schedule: Schedule::every(scene.outputs.tables),
            table: CsvTable::create(folder, BODIES, scene.outputs.measurements.unit())?,
        })
    }
}

impl Observer for BodiesObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        let bodies = self.names.iter().zip(view.bodies()).zip(&self.wanted);
        let wanted = bodies.filter(|(_, wanted)| **wanted);
        self.table.append(wanted.map(|((body, state), _)| BodyRow { time, body: body.clone(), state }))?;
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
