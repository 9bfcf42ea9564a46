//! Section 3.2: a spinning sphere set on a plane; figures 7 and 8.

use super::Study;
use super::case::{PaperCase, PaperResolution, PaperScene, Runs, TouchRule};
use super::sphere::{DISTANCE, SPEED, Sphere, figure, table};
use crate::failure::Failure;
use crate::page::{Figure, Section};

/// The study.
pub struct Backspin;

impl Study for Backspin {
    fn name(&self) -> &'static str {
        "backspin"
    }

    fn cases(&self, level: PaperResolution) -> Vec<PaperCase> {
        spheres(level).iter().map(Sphere::case).collect()
    }

    fn section(&self, level: PaperResolution, runs: &Runs) -> Result<Section, Failure> {
        let spheres = spheres(level);
        let title = "Sphere of 1 m that spins at 5 rad/s, set on a flat plane with friction 0.5.";
        let section = Section::new("Backspin").text(
            "Section 3.2. Friction accelerates a rigid sphere for 2/7 s; then it rolls at 10/7 m/s. The paper finds convergence toward \
             that, with a velocity that oscillates because the soft sphere skips. Dashed: the rigid sphere.",
        );
        let distance =
            figure(Figure::new("Figure 7", format!("{title} Distance.")), DISTANCE, &spheres, runs)?;
        let speed = figure(Figure::new("Figure 8", format!("{title} Velocity.")), SPEED, &spheres, runs)?;
        let caption = "Distance and velocity at 1 s against the rigid sphere of equations (25) and (26).";
        Ok(section.figure(distance).figure(speed).table(table(caption, &spheres, runs)?))
    }
}

fn spheres(level: PaperResolution) -> Vec<Sphere> {
    let cells: &[usize] = match level {
        PaperResolution::Sketch => &[2],
        PaperResolution::Quick => &[4],
        PaperResolution::Full => &[4, 8],
    };
    let of_rule =
        |rule| cells.iter().map(move |&cells| Sphere { scene: PaperScene::BACKSPIN, rule, cells, label: "" });
    TouchRule::BOTH.into_iter().flat_map(of_rule).collect()
}
