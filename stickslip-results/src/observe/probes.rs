//! `probes.csv`: motion and stress at points, through time.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::memory::Memory;
use super::points::{PointSample, Points, SamplePoint};
use super::schedule::Schedule;
use super::table::{CellValue, CsvTable, TableRow, columns};
use super::{Doubt, Observer, PROBES};
use crate::door::View;
use crate::scene::{Observable, Probe, Scene};
use std::collections::BTreeSet;

/// A probe at one time, in SI units; the columns of `probes.csv`. A probe without material around has no row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProbeRow {
    /// Simulated time [s].
    pub time: f64,
    /// Name of the probe.
    pub probe: String,
    /// Where it is, and the motion and stress of the material there.
    pub sample: PointSample,
    /// Minus a third of the trace of the stress [Pa].
    pub pressure: f64,
    /// Difference of the principal stresses in the plane of x and y [Pa].
    pub stress_difference: f64,
    /// Equivalent stress of von Mises [Pa].
    pub von_mises: f64,
}

impl TableRow for ProbeRow {
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
        let Self { time, probe, sample, pressure, stress_difference, von_mises } = self;
        let PointSample { position: [x, y, z], velocity: [vx, vy, vz], stress: [xx, yy, zz, xy, yz, xz] } =
            sample;
        columns![
            time,
            probe,
            x,
            y,
            z,
            vx,
            vy,
            vz,
            xx,
            yy,
            zz,
            xy,
            yz,
            xz,
            pressure,
            stress_difference,
            von_mises
        ]
    }
}

impl ProbeRow {
    fn new(time: f64, probe: &str, sample: PointSample) -> Self {
        let value = |quantity: Observable| quantity.value(&sample.velocity, &sample.stress);
        ProbeRow {
            time,
            probe: probe.to_string(),
            sample,
            pressure: value(Observable::Pressure),
            stress_difference: value(Observable::StressDifference),
            von_mises: value(Observable::VonMises),
        }
    }
}

/// The points of probes.
pub(super) fn points<'a>(
    scene: &'a Scene,
    probes: impl Iterator<Item = &'a Probe>,
) -> impl Iterator<Item = SamplePoint> {
    let body = |name: &String| scene.bodies.iter().position(|body| body.name == *name);
    probes.map(move |probe| SamplePoint {
        at: probe.at,
        body: probe.body.as_ref().and_then(body),
        fixed_in: probe.fixed_in,
    })
}

/// Writes `probes.csv`.
pub(super) struct ProbesObserver {
    names: Vec<String>,
    points: Points,
    /// Names of those that had material around them at some time.
    seen: BTreeSet<String>,
    schedule: Schedule,
    table: CsvTable<ProbeRow>,
}

impl ProbesObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        let wanted = &scene.outputs.measurements;
        Ok(ProbesObserver {
            names: wanted.probes.iter().map(|probe| probe.name.clone()).collect(),
            points: Points::new(scene, points(scene, wanted.probes.iter())),
            seen: BTreeSet::new(),
            schedule: Schedule::every(wanted.samples),
            table: CsvTable::create(folder, PROBES, wanted.unit())?,
        })
    }
}

impl Observer for ProbesObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        let samples = self.names.iter().zip(self.points.sample(view));
        let rows: Vec<_> =
            samples.filter_map(|(name, sample)| Some(ProbeRow::new(time, name, sample?))).collect();
        for row in &rows {
            if !self.seen.contains(&row.probe) {
                self.seen.insert(row.probe.clone());
            }
        }
        self.table.append(rows)?;
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.table.finish()
    }

    fn doubts(&self) -> Vec<Doubt> {
        let idle: Vec<&String> = self.names.iter().filter(|name| !self.seen.contains(*name)).collect();
        let message = |named: &str| format!("no material ever came to the probe {named}");
        Doubt::of_all(&idle, message, "move it, or let a body carry it (`fixed_in`)")
    }

    fn remember(&mut self, _: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        self.points.remember(memory)?;
        memory.keep("seen", &mut self.seen)?;
        self.schedule.remember(memory)?;
        self.table.remember(memory)
    }
}
