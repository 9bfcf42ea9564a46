//! `bodies.csv`: where each body is and how it moves.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::schedule::Schedule;
use super::table::{CsvTable, TableRow};
use super::{BODIES, Observer};
use crate::door::{BodyState, View};
use crate::scene::Scene;
use serde::{Deserialize, Serialize};

/// One body at one time, in SI units; the columns of `bodies.csv`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyRow {
    /// Simulated time [s].
    pub time: f64,
    /// Name of the body.
    pub body: String,
    /// Mass [kg].
    pub mass: f64,
    /// Centre of mass, first component [m].
    pub x: f64,
    /// Centre of mass, second component [m].
    pub y: f64,
    /// Centre of mass, third component [m].
    pub z: f64,
    /// Velocity of the centre of mass, first component [m/s].
    pub vx: f64,
    /// Velocity of the centre of mass, second component [m/s].
    pub vy: f64,
    /// Velocity of the centre of mass, third component [m/s].
    pub vz: f64,
    /// Angular velocity, first component [rad/s].
    pub wx: f64,
    /// Angular velocity, second component [rad/s].
    pub wy: f64,
    /// Angular velocity, third component [rad/s].
    pub wz: f64,
    /// Kinetic energy [J].
    pub kinetic: f64,
    /// Strain energy [J].
    pub strain: f64,
}

impl BodyRow {
    /// The row of a body in a state at a time [s].
    pub fn new(time: f64, body: &str, state: &BodyState) -> Self {
        let ([x, y, z], [vx, vy, vz], [wx, wy, wz]) = (state.position, state.velocity, state.spin);
        let BodyState { mass, kinetic, strain, .. } = *state;
        BodyRow { time, body: body.to_string(), mass, x, y, z, vx, vy, vz, wx, wy, wz, kinetic, strain }
    }

    /// The number in a column by the column's name; `None` for a name that is no column of numbers.
    pub fn quantity(&self, column: &str) -> Option<f64> {
        Some(match column {
            "time" => self.time,
            "mass" => self.mass,
            "x" => self.x,
            "y" => self.y,
            "z" => self.z,
            "vx" => self.vx,
            "vy" => self.vy,
            "vz" => self.vz,
            "wx" => self.wx,
            "wy" => self.wy,
            "wz" => self.wz,
            "kinetic" => self.kinetic,
            "strain" => self.strain,
            _ => return None,
        })
    }
}

impl TableRow for BodyRow {
    fn time(&self) -> f64 {
        self.time
    }
}

/// Writes `bodies.csv`.
pub(super) struct BodiesObserver {
    names: Vec<String>,
    schedule: Schedule,
    table: CsvTable<BodyRow>,
}

impl BodiesObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        Ok(BodiesObserver {
            names: scene.bodies.iter().map(|body| body.name.clone()).collect(),
            schedule: Schedule::every(scene.outputs.tables),
            table: CsvTable::create(folder.join(BODIES), scene.outputs.measurements.unit())?,
        })
    }
}

impl Observer for BodiesObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        let states = view.bodies();
        let rows = self.names.iter().zip(&states).map(|(name, state)| BodyRow::new(time, name, state));
        self.table.append(rows)?;
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.table.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_column_but_the_name_is_a_quantity() {
        let row = serde_json::to_value(BodyRow::default()).unwrap();
        for column in row.as_object().unwrap().keys() {
            assert_eq!(BodyRow::default().quantity(column).is_some(), column != "body", "{column}");
        }
        assert_eq!(BodyRow { wz: 3.0, ..Default::default() }.quantity("wz"), Some(3.0));
    }
}
