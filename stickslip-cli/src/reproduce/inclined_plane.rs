//! Section 3.1: a sphere on an inclined plane, without and with slip; figures 3 to 6.

use super::Study;
use super::case::{PaperCase, PaperResolution, PaperScene, Runs, TouchRule};
use super::sphere::{DISTANCE, SPEED, Sphere, figure, table};
use crate::failure::Failure;
use crate::page::{Figure, Section};

/// The study.
pub struct InclinedPlane;

impl Study for InclinedPlane {
    fn name(&self) -> &'static str {
        "inclined-plane"
    }

    fn cases(&self, level: PaperResolution) -> Vec<PaperCase> {
        no_slip(level).iter().chain(&slip(level)).map(Sphere::case).collect()
    }

    fn section(&self, level: PaperResolution, runs: &Runs) -> Result<Section, Failure> {
        let (no_slip, slip) = (no_slip(level), slip(level));
        let finest = finest(&no_slip).max(finest(&slip));
        let both: Vec<Sphere> =
            no_slip.iter().chain(&slip).filter(|sphere| sphere.cells == finest).copied().collect();
        let plain: Vec<Sphere> = no_slip.iter().map(|sphere| Sphere { label: "", ..*sphere }).collect();
        let both_title = "Sphere on an inclined plane, the finest cells, without slip (π/4, friction 0.495) and with (π/3, 0.286).";
        let all_title = "The same without slip on cells of a part of the radius R.";
        let figures = [
            (Figure::new("Figure 3", format!("{both_title} Distance.")), DISTANCE, &both),
            (Figure::new("Figure 4", format!("{both_title} Velocity.")), SPEED, &both),
            (Figure::new("Figure 5", format!("{all_title} Distance.")), DISTANCE, &plain),
            (Figure::new("Figure 6", format!("{all_title} Velocity.")), SPEED, &plain),
        ];
        let mut section = Section::new("Sphere on an inclined plane")
            .text(
                "Section 3.1. A soft sphere of 1.6 m rolls down a plane that is ten times as stiff and dense. The paper finds it close to \
                 a rigid sphere, a little slower, and closer with smaller cells; on cells of R/2 it stands on a flat spot and does not \
                 roll, and its velocity shows small skips. Dashed: the rigid sphere.",
            );
        for (empty, axis, spheres) in figures {
            section = section.figure(figure(empty, axis, spheres, runs)?);
        }
        let all: Vec<Sphere> = no_slip.into_iter().chain(slip).collect();
        let caption = "Distance and velocity at 2 s against the rigid sphere of equations (23) and (24).";
        Ok(section.table(table(caption, &all, runs)?))
    }
}

fn spheres(scene: PaperScene, label: &'static str, cells: &[usize]) -> Vec<Sphere> {
    let of_rule = |rule| cells.iter().map(move |&cells| Sphere { scene, rule, cells, label });
    TouchRule::BOTH.into_iter().flat_map(of_rule).collect()
}

fn no_slip(level: PaperResolution) -> Vec<Sphere> {
    let cells: &[usize] = match level {
        PaperResolution::Sketch => &[2],
        PaperResolution::Quick => &[2, 4],
        PaperResolution::Full => &[2, 4, 8],
    };
    spheres(PaperScene::NO_SLIP, "no slip", cells)
}

fn slip(level: PaperResolution) -> Vec<Sphere> {
    let cells: &[usize] = match level {
        PaperResolution::Sketch => &[2],
        PaperResolution::Quick => &[4],
        PaperResolution::Full => &[4, 8],
    };
    spheres(PaperScene::SLIP, "slip", cells)
}

fn finest(spheres: &[Sphere]) -> usize {
    spheres.iter().map(|sphere| sphere.cells).max().unwrap_or(0)
}
