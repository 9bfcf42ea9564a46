//! `sections.csv`: forces and moments in the material across planes.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::memory::Memory;
use super::schedule::Schedule;
use super::table::{CellValue, CsvTable, TableRow, columns};
use super::{Observer, SECTIONS};
use crate::door::{ParticleSnapshot, View};
use crate::scene::{Domain, Scene, Section};
use stickslip_scene::tensor::cross;

/// Force and moment across a plane at one time, in SI units; the columns of `sections.csv`.
///
/// ```text
/// f = integral sigma n dA,     m = integral (x - c) x sigma n dA
/// ```
/// n: normal of the plane, c: its point; of the material on the side to which n points on the rest. The stress is that
/// of particles up to a cell away, each with its volume and the weight (1 - |d| / h) / h at the distance d.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SectionRow {
    /// Simulated time [s].
    pub time: f64,
    /// Name of the section.
    pub section: String,
    /// Force [N].
    pub force: [f64; 3],
    /// Moment about the point [N m].
    pub moment: [f64; 3],
    /// Area of the material there [m^2], in the plane length per depth [m].
    pub area: f64,
}

impl TableRow for SectionRow {
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
        let Self { time, section, force: [fx, fy, fz], moment: [mx, my, mz], area } = self;
        columns![time, section, fx, fy, fz, mx, my, mz, area]
    }
}

/// Writes `sections.csv`.
pub(super) struct SectionsObserver {
    /// With the indices of the bodies that each cuts.
    sections: Vec<(Section, Vec<bool>)>,
    cell: f64,
    /// Where images of particles are, if the domain is periodic.
    domain: Option<Domain>,
    schedule: Schedule,
    table: CsvTable<SectionRow>,
}

impl SectionsObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        let measurements = &scene.outputs.measurements;
        let cuts = |section: &Section| {
            let cut = |body: &crate::scene::Body| section.bodies.contains(&body.name);
            (section.clone(), scene.bodies.iter().map(cut).collect())
        };
        Ok(SectionsObserver {
            sections: measurements.sections.iter().map(cuts).collect(),
            cell: scene.discretization.cell,
            domain: scene.domain.clone().filter(|domain| domain.periods() != [0.0; 3]),
            schedule: Schedule::every(scene.outputs.tables),
            table: CsvTable::create(folder, SECTIONS, measurements.unit())?,
        })
    }
}

impl Observer for SectionsObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let (time, mut particles) = (view.time(), view.snapshot());
        let places = particles.position.clone();
        let rows = self.sections.iter().map(|(section, cuts)| {
            if let Some(domain) = &self.domain {
                let middle = section
                    .within
                    .map_or(section.point, |[min, max]| std::array::from_fn(|k| 0.5 * (min[k] + max[k])));
                let near = |place: &[f64; 3]| domain.image_near(*place, middle);
                particles.position = places.iter().map(near).collect();
            }
            let [force, moment, [area, ..]] = across(section, cuts, &particles, self.cell);
            SectionRow { time, section: section.name.clone(), force, moment, area }
        });
        self.table.append(rows)?;
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

/// Force, moment and area of a section.
fn across(section: &Section, cuts: &[bool], particles: &ParticleSnapshot, cell: f64) -> [[f64; 3]; 3] {
    let Section { point, normal: n, within, .. } = section;
    let (mut force, mut moment, mut area) = ([0.0; 3], [0.0; 3], 0.0);
    for i in 0..particles.body.len() {
        if !cuts[particles.body[i] as usize] {
            continue;
        }
        let x = particles.position[i];
        let from: [f64; 3] = std::array::from_fn(|k| x[k] - point[k]);
        let away = (0..3).map(|k| from[k] * n[k]).sum::<f64>().abs();
        let inside = within
            .is_none_or(|[min, max]| (0..particles.dimension).all(|k| (min[k]..=max[k]).contains(&x[k])));
        if away >= cell || !inside {
            continue;
        }
        let share = particles.volume[i] * (1.0 - away / cell) / cell;
        let [xx, yy, zz, xy, yz, xz] = particles.stress[i];
        let traction = [
            xx * n[0] + xy * n[1] + xz * n[2],
            xy * n[0] + yy * n[1] + yz * n[2],
            xz * n[0] + yz * n[1] + zz * n[2],
        ];
        let turn = cross(from, traction);
        for k in 0..3 {
            force[k] += share * traction[k];
            moment[k] += share * turn[k];
        }
        area += share;
    }
    [force, moment, [area, 0.0, 0.0]]
}
