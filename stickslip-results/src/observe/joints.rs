//! `joints.csv`: forces and moments of joints and springs, and how far they have moved.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::memory::Memory;
use super::schedule::Schedule;
use super::table::{CellValue, CsvTable, TableRow, columns};
use super::{JOINTS, Observer};
use crate::door::{JointState, View};
use crate::scene::Scene;

/// What a joint or a spring did on the body that it holds, averaged from the row before to this one; the columns of
/// `joints.csv`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointRow {
    /// Simulated time at which the average ends [s].
    pub time: f64,
    /// Name of the joint or spring.
    pub joint: String,
    /// Mean force on the body since the row before [N].
    pub force: [f64; 3],
    /// Mean moment on it about the joint's point, of sliders and welds about its centre [N m].
    pub moment: [f64; 3],
    /// Angle of a hinge or a planar joint [rad], way of a slider, change of a spring's length since the start [m].
    pub way: f64,
    /// Its rate now [rad/s, m/s].
    pub rate: f64,
    /// Work on free bodies since the start [J].
    pub work: f64,
}

impl TableRow for JointRow {
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
        let Self { time, joint, force: [fx, fy, fz], moment: [mx, my, mz], way, rate, work } = self;
        columns![time, joint, fx, fy, fz, mx, my, mz, way, rate, work]
    }
}

/// Writes `joints.csv`; forces and moments of each row are means since the row before.
pub(super) struct JointsObserver {
    names: Vec<String>,
    /// Time of the last row [s], and what was known then.
    before: (f64, Vec<JointState>),
    schedule: Schedule,
    table: CsvTable<JointRow>,
}

impl JointsObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        let names: Vec<String> = scene.joint_names().map(String::from).collect();
        Ok(JointsObserver {
            before: (0.0, vec![JointState::default(); names.len()]),
            names,
            schedule: Schedule::every(scene.outputs.tables),
            table: CsvTable::create(folder, JOINTS, scene.outputs.measurements.unit())?,
        })
    }
}

impl Observer for JointsObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let (time, now) = (view.time(), view.joints());
        let (since, before) = std::mem::replace(&mut self.before, (time, now.clone()));
        let elapsed = time - since;
        // The start has no time before it to average over.
        if elapsed > 0.0 {
            let mean =
                |now: [f64; 3], before: [f64; 3]| std::array::from_fn(|i| (now[i] - before[i]) / elapsed);
            let rows = self.names.iter().zip(now.iter().zip(&before)).map(|(name, (now, before))| JointRow {
                time,
                joint: name.clone(),
                force: mean(now.impulse, before.impulse),
                moment: mean(now.moment, before.moment),
                way: now.way,
                rate: now.speed,
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
        self.before.1.resize(self.names.len(), JointState::default());
        self.schedule.remember(memory)?;
        self.table.remember(memory)
    }
}
