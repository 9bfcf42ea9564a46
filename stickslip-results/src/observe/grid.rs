//! `grid.pvd`: the grid nodes that carry mass through time, for ParaView.

use super::file::OutputError;
use super::folder::OutputFolder;
use super::frames::Frames;
use super::memory::Memory;
use super::schedule::Schedule;
use super::vtk::{NUMBER, VECTOR, VtkFile};
use super::{GRID, Observer};
use crate::door::{GridSnapshot, View};
use crate::scene::{Scene, SeriesFormat, SnapshotContent};

/// Bytes of a node in a snapshot: 13 numbers and a whole one.
const NODE_BYTES: usize = 13 * size_of::<f64>() + size_of::<u32>();

/// Writes `grid.pvd` and `grid/`.
pub(super) struct GridObserver {
    schedule: Schedule,
    frames: Frames,
    /// How files hold it.
    content: SnapshotContent,
    /// Steps taken at the checkpoint from which the run went on, and the grid there, which nobody can make anew.
    taken_up: Option<(u64, GridSnapshot)>,
}

impl GridObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        Ok(GridObserver {
            schedule: Schedule::every(scene.outputs.grid.unwrap_or(f64::INFINITY)),
            frames: Frames::create(folder, GRID, SeriesFormat::Vtu)?,
            content: scene.outputs.snapshots.clone(),
            taken_up: None,
        })
    }
}

impl GridObserver {
    /// The grid of the last step.
    fn grid(&self, view: &dyn View) -> GridSnapshot {
        match &self.taken_up {
            Some((steps, grid)) if *steps == view.steps() => grid.clone(),
            _ => view.grid_snapshot(),
        }
    }
}

impl Observer for GridObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        self.frames.make_room()?;
        let snapshot = self.grid(view);
        let bytes = NODE_BYTES * snapshot.mass.len();
        let content = self.content.clone();
        self.frames.push(time, bytes, move |_| encode_grid(&snapshot, time, &content).into());
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.frames.finish()
    }

    fn remember(&mut self, view: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        let mut grid = (!memory.is_taking_up()).then(|| (view.steps(), self.grid(view)));
        memory.keep("grid", &mut grid)?;
        if memory.is_taking_up() {
            self.taken_up = grid.filter(|(_, grid)| grid.is_even());
        }
        self.schedule.remember(memory)?;
        self.frames.remember(memory)
    }

    fn replaces(&self) -> bool {
        true
    }
}

/// The nodes of the last step's grid at a time [s] as a file for ParaView, ready to be written.
///
/// Node by node and body by body: `mass` [kg], `velocity` [m/s], internal `force` [N], `contact_impulse` [N s] and the
/// index of the `body`; the side of a `cell` [m] holds for the whole file. Of the `content` precision and compression
/// count.
pub fn encode_grid(snapshot: &GridSnapshot, time: f64, content: &SnapshotContent) -> VtkFile {
    let body: Vec<i32> = snapshot.body.iter().map(|&body| body as i32).collect();
    let mut file = VtkFile::new(time, &snapshot.position, content);
    file.field("dimension", snapshot.dimension as f64);
    file.field("cell", snapshot.cell);
    file.real("mass", NUMBER, &snapshot.mass);
    file.real("velocity", VECTOR, snapshot.velocity.as_flattened());
    file.real("force", VECTOR, snapshot.force.as_flattened());
    file.real("contact_impulse", VECTOR, snapshot.contact_impulse.as_flattened());
    file.whole("body", &body);
    file
}
