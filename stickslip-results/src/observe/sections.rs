//! `sections.csv`: forces and moments in the material across planes.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::memory::Memory;
use super::schedule::Schedule;
use super::shared::{Asked, Question, answer};
use super::table::{CellValue, CsvTable, TableRow, columns};
use super::{Doubt, Observer, SECTIONS};
use crate::door::{ParticleView, View};
use crate::exact::ExactSum;
use crate::scene::{Domain, Scene, Section};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
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
    sections: Vec<SectionCut>,
    /// Names of those that material crossed at some time.
    crossed: BTreeSet<String>,
    schedule: Schedule,
    table: CsvTable<SectionRow>,
}

impl SectionsObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        let measurements = &scene.outputs.measurements;
        let domain = scene.domain.clone().filter(|domain| domain.periods() != [0.0; 3]);
        let cut = |section: &Section| SectionCut {
            section: section.clone(),
            bodies: (0..scene.bodies.len())
                .filter(|&i| section.bodies.contains(&scene.bodies[i].name))
                .collect(),
            cell: scene.discretization.cell,
            axes: scene.dimension.axes(),
            domain: domain.clone(),
        };
        Ok(SectionsObserver {
            sections: measurements.sections.iter().map(cut).collect(),
            crossed: BTreeSet::new(),
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
        let time = view.time();
        let rows = self.sections.iter().map(|cut| {
            let sums = answer(view, cut);
            let [fx, fy, fz, mx, my, mz, area] = sums.each_ref().map(ExactSum::value);
            let section = cut.section.name.clone();
            if area > 0.0 && !self.crossed.contains(&section) {
                self.crossed.insert(section.clone());
            }
            SectionRow { time, section, force: [fx, fy, fz], moment: [mx, my, mz], area }
        });
        self.table.append(rows)?;
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.table.finish()
    }

    fn doubts(&self) -> Vec<Doubt> {
        let names = self.sections.iter().map(|cut| &cut.section.name);
        let idle: Vec<&String> = names.filter(|name| !self.crossed.contains(*name)).collect();
        let message = |named: &str| format!("no material ever came to the section {named}");
        Doubt::of_all(&idle, message, "its rows are 0: move its point, or widen `within`")
    }

    fn remember(&mut self, _: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("crossed", &mut self.crossed)?;
        self.schedule.remember(memory)?;
        self.table.remember(memory)
    }
}

/// A section through the bodies of a scene.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct SectionCut {
    section: Section,
    /// Indices of the bodies that it cuts.
    bodies: Vec<usize>,
    cell: f64,
    /// Of the scene.
    axes: usize,
    /// Where images of particles are, if the domain is periodic.
    domain: Option<Domain>,
}

impl SectionCut {
    /// What a particle adds to force, moment and area; nothing if it is not near.
    fn share(&self, particle: &ParticleView) -> Option<[f64; 7]> {
        let Section { point, normal: n, within, .. } = &self.section;
        let x = self.domain.as_ref().map_or(particle.position, |domain| {
            let middle = within.map_or(*point, |[min, max]| std::array::from_fn(|k| 0.5 * (min[k] + max[k])));
            domain.image_near(particle.position, middle)
        });
        let from: [f64; 3] = std::array::from_fn(|k| x[k] - point[k]);
        let away = (0..3).map(|k| from[k] * n[k]).sum::<f64>().abs();
        let inside =
            within.is_none_or(|[min, max]| (0..self.axes).all(|k| (min[k]..=max[k]).contains(&x[k])));
        if away >= self.cell || !inside {
            return None;
        }
        let share = particle.volume * (1.0 - away / self.cell) / self.cell;
        let [xx, yy, zz, xy, yz, xz] = particle.stress;
        let traction = [
            xx * n[0] + xy * n[1] + xz * n[2],
            xy * n[0] + yy * n[1] + yz * n[2],
            xz * n[0] + yz * n[1] + zz * n[2],
        ];
        let ([fx, fy, fz], [mx, my, mz]) = (traction, cross(from, traction));
        Some([fx, fy, fz, mx, my, mz, 1.0].map(|x| share * x))
    }
}

impl Question for SectionCut {
    /// Force, moment and area.
    type Answer = [ExactSum; 7];

    fn look(&self, view: &dyn View) -> Self::Answer {
        let mut sums = [0; 7].map(|_| ExactSum::default());
        for &body in &self.bodies {
            view.visit(body, &mut |particle| {
                let share = self.share(particle).into_iter().flatten();
                sums.iter_mut().zip(share).for_each(|(sum, x)| sum.add(x));
            });
        }
        sums
    }

    fn join(mut one: Self::Answer, other: Self::Answer) -> Self::Answer {
        ExactSum::merge_each(&mut one, &other);
        one
    }

    fn asked(&self) -> Asked {
        Asked::Section(self.clone())
    }
}
