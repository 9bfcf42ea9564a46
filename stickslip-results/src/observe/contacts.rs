//! `contacts.csv`: the forces between bodies that touch.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::memory::Memory;
use super::schedule::Schedule;
use super::table::{CellValue, CsvTable, TableRow, columns};
use super::{CONTACTS, Observer};
use crate::door::{ContactCursor, ContactMean, ContactState, View};
use crate::scene::Scene;

/// Contact of one pair of bodies, averaged from the row before to this one; the columns of `contacts.csv`.
///
/// Pairs that exerted no force on each other in that time have no row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactRow {
    /// Simulated time at which the average ends [s].
    pub time: f64,
    /// Name of the first body.
    pub body_a: String,
    /// Name of the second body.
    pub body_b: String,
    /// How they pressed on each other since the row before.
    pub mean: ContactMean,
}

impl TableRow for ContactRow {
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
        let Self { time, body_a, body_b, mean } = self;
        let ContactMean { force: [fx, fy, fz], normal, tangential, nodes, position: [x, y, z], .. } = mean;
        let ContactMean { area, gap, slip, friction, .. } = mean;
        columns![
            time, body_a, body_b, fx, fy, fz, normal, tangential, nodes, x, y, z, area, gap, slip, friction
        ]
    }
}

/// Writes `contacts.csv`; each row is the mean since the row before.
pub(super) struct ContactsObserver {
    names: Vec<String>,
    cursor: ContactCursor,
    schedule: Schedule,
    table: CsvTable<ContactRow>,
}

impl ContactsObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        Ok(ContactsObserver {
            names: scene.bodies.iter().map(|body| body.name.clone()).collect(),
            cursor: ContactCursor::default(),
            schedule: Schedule::every(scene.outputs.tables),
            table: CsvTable::create(folder, CONTACTS, scene.outputs.measurements.unit())?,
        })
    }
}

impl Observer for ContactsObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        let name = |body: usize| self.names[body].clone();
        let contacts = self.cursor.read(view).into_iter();
        self.table.append(contacts.map(|ContactState { body_a, body_b, mean, .. }| ContactRow {
            time,
            body_a: name(body_a),
            body_b: name(body_b),
            mean,
        }))?;
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.table.finish()
    }

    fn remember(&mut self, _: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("cursor", &mut self.cursor)?;
        self.schedule.remember(memory)?;
        self.table.remember(memory)
    }
}
