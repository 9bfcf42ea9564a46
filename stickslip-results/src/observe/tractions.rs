//! `tractions.csv`: pressure and shear at points of surfaces that touch.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::memory::Memory;
use super::schedule::Schedule;
use super::table::{CellValue, CsvTable, TableRow, columns};
use super::{Observer, TRACTIONS};
use crate::door::{ContactPoint, Touched, View};
use crate::scene::{FACES, Scene, Tractions};
use std::collections::HashSet;

/// A point of a body's surface that touches, as the forces of the last step acted; the columns of `tractions.csv`.
///
/// ```text
/// t = -p n + tau          traction on the body, per undeformed area
/// f = sum_s A_s t_s       force on it; where its partner has points, too, less the same sum over these
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TractionRow {
    /// Simulated time at the end of the step [s].
    pub time: f64,
    /// Name of the body.
    pub body: String,
    /// Name of the body, or word of the face of the domain, that it touches.
    pub partner: String,
    /// Where the point is [m].
    pub position: [f64; 3],
    /// Where it was undeformed [m].
    pub undeformed: [f64; 3],
    /// Unit normal n, out of the body [-].
    pub normal: [f64; 3],
    /// Undeformed area A for which the row stands [m^2], in the plane length per depth [m]: half of the point's where
    /// the partner has points, too.
    pub area: f64,
    /// Pressure p between the two, force over undeformed area, at least 0 [Pa].
    pub pressure: f64,
    /// Shear traction tau on the body [Pa].
    pub shear: [f64; 3],
}

impl TableRow for TractionRow {
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
        let Self { time, body, partner, position: [x, y, z], undeformed: [x0, y0, z0], .. } = self;
        let Self { normal: [nx, ny, nz], area, pressure, shear: [tx, ty, tz], .. } = self;
        columns![time, body, partner, x, y, z, x0, y0, z0, nx, ny, nz, area, pressure, tx, ty, tz]
    }
}

/// Writes `tractions.csv`.
pub(super) struct TractionsObserver {
    names: Vec<String>,
    /// Of each body, whether its points have rows.
    wanted: Vec<bool>,
    /// When the run was taken up, and the points of the step before, which the simulation does not know [s].
    taken_up: Option<(f64, Vec<ContactPoint>)>,
    schedule: Schedule,
    table: CsvTable<TractionRow>,
}

impl TractionsObserver {
    pub(super) fn create(
        (scene, asked): (&Scene, &Tractions),
        folder: &OutputFolder,
    ) -> Result<Self, OutputError> {
        let named: Option<HashSet<&String>> = asked.bodies.as_ref().map(|names| names.iter().collect());
        let is_wanted = |name: &String| named.as_ref().is_none_or(|names| names.contains(name));
        let names: Vec<String> = scene.bodies.iter().map(|body| body.name.clone()).collect();
        Ok(TractionsObserver {
            wanted: names.iter().map(is_wanted).collect(),
            names,
            taken_up: None,
            schedule: Schedule::every(asked.interval.unwrap_or(scene.outputs.tables)),
            table: CsvTable::create(folder, TRACTIONS, scene.outputs.measurements.unit())?,
        })
    }

    /// The points that have rows now.
    fn points(&self, view: &dyn View) -> Vec<ContactPoint> {
        let mut points = match &self.taken_up {
            Some((time, points)) if *time == view.time() => points.clone(),
            _ => view.contact_points(),
        };
        points.retain(|point| self.wanted.get(point.body) == Some(&true));
        points
    }

    fn row(&self, time: f64, point: ContactPoint) -> TractionRow {
        let ContactPoint { body, partner, position, undeformed, normal, area, pressure, shear } = point;
        let partner = match partner {
            Touched::Body(body) => self.names[body].clone(),
            Touched::Face { axis, upper } => FACES[axis][usize::from(upper)].to_string(),
        };
        let body = self.names[body].clone();
        TractionRow { time, body, partner, position, undeformed, normal, area, pressure, shear }
    }
}

impl Observer for TractionsObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        let rows: Vec<_> = self.points(view).into_iter().map(|point| self.row(time, point)).collect();
        self.table.append(rows)?;
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.table.finish()
    }

    fn remember(&mut self, view: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        let mut known = (view.time(), self.points(view));
        if memory.keep("points", &mut known)? && memory.is_taking_up() {
            self.taken_up = Some(known);
        }
        self.schedule.remember(memory)?;
        self.table.remember(memory)
    }
}
