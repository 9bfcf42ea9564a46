//! How long bodies on grids of their own take.

use super::memory::BodySize;
use super::report::MachineSpeed;
use crate::material::Material;
use crate::scene::{Body, Precision, Scene};
use serde::Serialize;

/// What takes time, in particles: as long as one core takes for so many on the common grid in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Work {
    /// What all cores share.
    pub shared: f64,
    /// The largest part of it that is not shared: one core does it.
    pub largest: f64,
    /// What one core does while others wait.
    pub alone: f64,
}

impl Work {
    /// How long it takes [s].
    pub fn seconds(&self, machine: &MachineSpeed) -> f64 {
        let together = (self.shared / machine.cores as f64).max(self.largest);
        (together + self.alone) / machine.particle_steps_per_second
    }
}

/// What bodies on grids of their own take.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct OwnGridWork {
    /// Their particles.
    pub particles: usize,
    /// Whether nothing else deforms: then there is no common grid.
    pub is_all: bool,
    /// What is done before the first step: grids, and the search of neighbours.
    pub start: Work,
    /// What a step takes, with its part of what some steps do: neighbours, rows of tables, snapshots.
    pub step: Work,
}

// In particles, which by `MachineSpeed::default` are microseconds of one core, in the plane and in space. Measured on
// a virtual machine with two cores of an AMD EPYC with AVX2, other work beside it, in November 2026: 36 to 12,500
// disks of four to eight cells, 8 to 100 balls of five to eight, squares of 100 cells and cubes of 10 to 40, apart and
// packed. By the times of "stress update", "contact" and "outputs" in run.json of `run --threads 1`, times the share
// of the processor that the run had. Many small bodies take up to twice as long where they do not fit into caches, and
// half as long where they do.

/// A cell in the pass over particles, however many it has, by laws that take roots and products alone.
const CELL: [f64; 2] = [0.3, 1.3];
/// The same where particles stay behind: neo-Hookean bodies in double precision, whose cells go side by side.
const CELL_SIDE_BY_SIDE: [f64; 2] = [0.1, 0.3];
/// The same by laws that take logarithms or powers of principal stretches.
const CELL_BY_STRETCHES: [f64; 2] = [2.6, 5.5];
/// A node: contact adds its forces, velocities and places change, followers follow.
const NODE: [f64; 2] = [0.05, 0.05];
/// A point near a partner: where it lies there, and what the layer does.
const NEAR_POINT: [f64; 2] = [1.0, 5.0];
/// A point of the surface where neighbours are sought anew.
const SOUGHT_POINT: [f64; 2] = [3.0, 3.0];
/// A particle in a row of tables, and in a snapshot.
const ROW: f64 = 0.3;
const SNAPSHOT: f64 = 2.0;
/// A point of the surface before the first step. Its parts of cells are cut for each of the grids that are made: two by
/// the checks before the run, one by those of the engine, and two for the body, one after the other.
const BEGUN_POINT: [f64; 2] = [90.0, 150.0];
/// What of the latter all cores share.
const BEGUN_TOGETHER: f64 = 0.6;
/// How far a body moves until neighbours are sought anew [cells].
const SKIN: f64 = 0.25;

/// What these bodies take, with steps so long [s], and something that moves at this speed at the start [m/s].
pub(super) fn own_grid_work(
    scene: &Scene,
    sizes: &[BodySize],
    (time_step, speed): (f64, f64),
) -> Option<OwnGridWork> {
    let of = |costs: [f64; 2]| costs[scene.dimension.axes() - 2];
    let mut work = OwnGridWork::default();
    let (mut points, mut most_points) = (0.0, 0.0_f64);
    for (body, size) in scene.bodies.iter().zip(sizes) {
        let Some(grid) = size.grid else { continue };
        work.particles += size.particles;
        let cell = match scene.materials[body.material].law {
            Material::NeoHookean(_) if scene.precision == Precision::Double => of(CELL_SIDE_BY_SIDE),
            Material::Hencky(_) | Material::Ogden(_) | Material::MohrCoulomb(_) => of(CELL_BY_STRETCHES),
            _ => of(CELL),
        };
        let itself = cell * grid.cells as f64 + of(NEAR_POINT) * grid.near as f64;
        work.step.shared += itself;
        work.step.largest = work.step.largest.max(itself);
        work.step.alone += of(NODE) * grid.nodes as f64;
        points += grid.points as f64;
        most_points = most_points.max(grid.points as f64);
    }
    if work.particles == 0 {
        return None;
    }
    let deforming = |(body, size): (&Body, &BodySize)| !body.is_rigid() && size.grid.is_none();
    work.is_all = !scene.bodies.iter().zip(sizes).any(deforming);
    let search = of(SOUGHT_POINT) * points;
    let begun = |points: f64| BEGUN_TOGETHER * of(BEGUN_POINT) * points;
    work.start = Work {
        shared: begun(points) + search,
        largest: begun(most_points),
        alone: (1.0 - BEGUN_TOGETHER) * of(BEGUN_POINT) * points,
    };
    // What is done every so many seconds is done no more than once a step.
    let share = |every: f64| (time_step / every).min(1.0);
    let searches = share(SKIN * scene.discretization.cell / speed);
    let outputs = &scene.outputs;
    let written = ROW * share(outputs.tables) + SNAPSHOT * outputs.particles.map_or(0.0, share);
    work.step.shared += search * searches + written * work.particles as f64;
    Some(work)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::tests::{at_rest, free, report, scene};
    use crate::geometry::Shape;
    use crate::scene::{Dimension, Interior, StressUpdate};

    fn disks(count: usize, cells: f64) -> Scene {
        let disk = |i: usize| {
            let shape = Shape::Ball { center: [cells * 0.1 * i as f64, 0.0, 0.0], radius: 0.05 * cells };
            Body { interior: Some(Interior::Reference), ..free(&format!("disk {i}"), 0, shape) }
        };
        let floor = Shape::HalfSpace { point: [0.0, -0.05 * cells, 0.0], normal: [0.0, 1.0, 0.0] };
        let floor = at_rest("floor", floor);
        let mut scene = scene(Dimension::PlaneStrain, 0.1, (0..count).map(disk).chain([floor]).collect());
        scene.time.stress_update = StressUpdate::default();
        scene
    }

    fn on(cores: usize, scene: &Scene) -> f64 {
        let machine = MachineSpeed { particle_steps_per_second: 1e6, cores };
        report(scene).expect("no problem").on(machine).wall_time
    }

    /// A single body's particles are one core's, those of many are shared.
    #[test]
    fn more_cores_help_many_bodies() {
        let many = disks(40, 6.0);
        assert!((1.4..2.0).contains(&(on(1, &many) / on(2, &many))), "{} {}", on(1, &many), on(2, &many));
        let one = disks(1, 60.0);
        assert!(on(1, &one) / on(2, &one) < 1.1, "{} {}", on(1, &one), on(2, &one));
    }

    /// Forty disks of 45 cells and 81 nodes each, which touch.
    #[test]
    fn a_step_takes_what_its_cells_nodes_and_points_take() {
        let own = report(&disks(40, 6.0)).expect("no problem").own_grids.expect("all are");
        assert!(own.is_all);
        let cells = CELL_SIDE_BY_SIDE[0] * 45.0 * 40.0;
        assert!((1.2..12.0).contains(&(own.step.shared / cells)), "{own:?}");
        assert!((own.step.alone - NODE[0] * 81.0 * 40.0).abs() < 1e-9, "{own:?}");
        assert!(own.start.alone > 100.0 * own.step.alone, "{own:?}");
    }

    #[test]
    fn a_body_on_the_common_grid_counts_by_its_particles() {
        let mut mixed = disks(2, 6.0);
        let block = Shape::Box { min: [2.0, 0.0, 0.0], max: [3.0, 1.0, 0.0] };
        mixed.bodies = [mixed.bodies.to_vec(), vec![free("block", 0, block)]].concat().into();
        let report = report(&mixed).expect("no problem");
        let own = report.own_grids.expect("two are");
        assert_eq!((own.is_all, report.particles - own.particles), (false, 400));
    }
}
