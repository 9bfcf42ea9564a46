//! `grid.pvd`: the grid nodes that carry mass through time, for ParaView.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::frames::Frames;
use super::schedule::Schedule;
use super::vtu::{NUMBER, VECTOR, Vtu};
use super::{GRID, Observer};
use crate::door::{GridSnapshot, View};

/// Bytes of a node in a snapshot: 13 numbers and a whole one.
const NODE_BYTES: usize = 13 * size_of::<f64>() + size_of::<u32>();

/// Writes `grid.pvd` and `grid/`.
pub(super) struct GridObserver {
    schedule: Schedule,
    frames: Frames,
}

impl GridObserver {
    pub(super) fn create(interval: f64, folder: &OutputFolder) -> Result<Self, OutputError> {
        Ok(GridObserver { schedule: Schedule::every(interval), frames: Frames::create(folder, GRID)? })
    }
}

impl Observer for GridObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        self.frames.make_room()?;
        let snapshot = view.grid_snapshot();
        let bytes = NODE_BYTES * snapshot.mass.len();
        self.frames.push(time, bytes, move || encode_grid(&snapshot, time));
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.frames.finish()
    }

    fn replaces(&self) -> bool {
        true
    }
}

/// The nodes of the last step's grid at a time [s] as a file for ParaView, ready to be written.
///
/// Node by node and body by body: `mass` [kg], `velocity` [m/s], internal `force` [N], `contact_impulse` [N s] and the
/// index of the `body`; the side of a `cell` [m] holds for the whole file.
pub fn encode_grid(snapshot: &GridSnapshot, time: f64) -> Vtu {
    let body: Vec<i32> = snapshot.body.iter().map(|&body| body as i32).collect();
    let mut file = Vtu::new(time, &snapshot.position);
    file.field("dimension", snapshot.dimension as f64);
    file.field("cell", snapshot.cell);
    file.point_data("mass", NUMBER, &snapshot.mass);
    file.point_data("velocity", VECTOR, snapshot.velocity.as_flattened());
    file.point_data("force", VECTOR, snapshot.force.as_flattened());
    file.point_data("contact_impulse", VECTOR, snapshot.contact_impulse.as_flattened());
    file.point_data("body", NUMBER, &body);
    file
}
