//! `probes.csv`: motion and stress at points, through time.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::points::{PointSample, Points, SamplePoint};
use super::schedule::Schedule;
use super::table::{CsvTable, TableRow};
use super::{Observer, PROBES};
use crate::door::View;
use crate::scene::{Observable, Probe, Scene};
use serde::{Deserialize, Serialize};

/// A probe at one time, in SI units; the columns of `probes.csv`. A probe without material around has no row.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ProbeRow {
    /// Simulated time [s].
    pub time: f64,
    /// Name of the probe.
    pub probe: String,
    /// Where it is, first component [m].
    pub x: f64,
    /// Where it is, second component [m].
    pub y: f64,
    /// Where it is, third component [m].
    pub z: f64,
    /// Velocity of the material, first component [m/s].
    pub vx: f64,
    /// Velocity of the material, second component [m/s].
    pub vy: f64,
    /// Velocity of the material, third component [m/s].
    pub vz: f64,
    /// Cauchy stress, normal along x, tension positive [Pa].
    pub xx: f64,
    /// Normal stress along y [Pa].
    pub yy: f64,
    /// Normal stress along z [Pa].
    pub zz: f64,
    /// Shear stress in the plane of x and y [Pa].
    pub xy: f64,
    /// Shear stress in the plane of y and z [Pa].
    pub yz: f64,
    /// Shear stress in the plane of x and z [Pa].
    pub xz: f64,
    /// Minus a third of the trace of the stress [Pa].
    pub pressure: f64,
    /// Difference of the principal stresses in the plane of x and y [Pa].
    pub stress_difference: f64,
    /// Equivalent stress of von Mises [Pa].
    pub von_mises: f64,
}

impl TableRow for ProbeRow {
    fn time(&self) -> f64 {
        self.time
    }
}

impl ProbeRow {
    fn new(time: f64, probe: &str, sample: &PointSample) -> Self {
        let ([x, y, z], [vx, vy, vz]) = (sample.position, sample.velocity);
        let [xx, yy, zz, xy, yz, xz] = sample.stress;
        let [pressure, stress_difference, von_mises] =
            [Observable::Pressure, Observable::StressDifference, Observable::VonMises]
                .map(|quantity| quantity.value(&sample.velocity, &sample.stress));
        let probe = probe.to_string();
        ProbeRow {
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
            von_mises,
        }
    }

    /// The value of a quantity.
    pub fn quantity(&self, quantity: Observable) -> f64 {
        quantity.value(&[self.vx, self.vy, self.vz], &[self.xx, self.yy, self.zz, self.xy, self.yz, self.xz])
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
    schedule: Schedule,
    table: CsvTable<ProbeRow>,
}

impl ProbesObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        let wanted = &scene.outputs.measurements;
        Ok(ProbesObserver {
            names: wanted.probes.iter().map(|probe| probe.name.clone()).collect(),
            points: Points::new(scene, points(scene, wanted.probes.iter())),
            schedule: Schedule::every(wanted.samples),
            table: CsvTable::create(folder.join(PROBES), wanted.unit())?,
        })
    }
}

impl Observer for ProbesObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        let samples = self.points.sample(view);
        let rows = self.names.iter().zip(&samples);
        self.table.append(
            rows.filter_map(|(name, sample)| sample.as_ref().map(|sample| ProbeRow::new(time, name, sample))),
        )?;
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.table.finish()
    }
}
