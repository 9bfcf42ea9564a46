//! Everything that a run writes, and reading it back.
//!
//! One file for each kind of output; to add one, write its file and list it in [`Recorder::new`]. An [`Observer`] of
//! another crate is added with [`Recorder::add`]. Outputs look at the simulation between steps and never change how it
//! steps: a record is made after the first step that reaches a multiple of the output's interval and carries the true
//! time; the start and the end are always recorded. Whatever ends a run (its end time, the user, a failing step, a full
//! disk), every file that is there can be read: tables hold whole rows only, and snapshots, their `.pvd` list and
//! `run.json` are written under another name and renamed when complete.

mod arrivals;
mod bodies;
mod checkpoint;
mod contacts;
mod energy;
mod fabric;
mod file;
mod folder;
mod frames;
mod fringes;
mod fronts;
mod grid;
mod groups;
mod joints;
mod linear_fit;
mod loads;
mod manifest;
mod memory;
mod particle_file;
mod particles;
mod pieces;
mod points;
mod probes;
mod reactions;
mod recorded;
mod recorder;
mod removed;
mod results;
mod schedule;
mod sections;
mod shared;
mod state_sum;
mod surfaces;
mod table;
mod tractions;
mod verify;
mod vtk;
mod waiting;
mod work;
mod writer;
mod xml;

pub use arrivals::ArrivalRow;
pub use bodies::BodyRow;
pub use checkpoint::{Checkpoint, CheckpointForm};
pub use contacts::ContactRow;
pub use energy::EnergyRow;
pub use fabric::FabricRow;
pub use file::{OutputError, ReadError, ReadProblem, replace, replace_by, whole_name};
pub use folder::{FolderError, OutputFolder};
pub use frames::Frame;
pub use fringes::{FRAMES_PER_SECOND, FringeRow};
pub use fronts::{FrontRow, FrontSpeedRow};
pub use grid::encode_grid;
pub use groups::{GroupContactRow, GroupRow};
pub use joints::JointRow;
pub use loads::LoadRow;
pub use manifest::{
    BegunFrom, Manifest, Performance, ReferenceCurve, RunWarning, SceneRecord, SceneSource, Status, Timing,
    as_text,
};
pub use memory::Memory;
pub use particle_file::{FileColumn, ParticleFile};
pub use particles::{FileColumns, encode_particles, read_columns, read_particles};
pub use points::PointSample;
pub use probes::ProbeRow;
pub use reactions::ReactionRow;
pub use recorded::{
    RecordedBody, RecordedMeasurements, RecordedOutputs, RecordedScene, RecordedShape, RecordedTime,
};
pub use recorder::Recorder;
pub use removed::RemovedRow;
pub use results::Results;
pub use schedule::Schedule;
pub use sections::SectionRow;
pub use shared::{
    Meeting, PROGRAM, ParticlesThere, WantedStarts, begin_on_ranks, cell_of, counts, has_near, meeting,
    starts,
};
pub use state_sum::{present_state_sum, state_sum};
pub use table::{CellValue, TableRow};
pub use tractions::TractionRow;
pub use verify::{Verified, verify, verify_snapshot};
pub use vtk::VtkFile;
pub use waiting::{Patience, Waiting};
pub use writer::Writer;

use crate::door::View;

/// Folder of checkpoints in that of a run.
const CHECKPOINTS: &str = "checkpoints";
const BODIES: &str = "bodies.csv";
const ENERGY: &str = "energy.csv";
const CONTACTS: &str = "contacts.csv";
const LOADS: &str = "loads.csv";
const JOINTS: &str = "joints.csv";
const REMOVED: &str = "removed.csv";
const PROBES: &str = "probes.csv";
const ARRIVALS: &str = "arrivals.csv";
const SECTIONS: &str = "sections.csv";
const REACTIONS: &str = "reactions.csv";
const GROUPS: &str = "groups.csv";
const GROUP_CONTACTS: &str = "group_contacts.csv";
const FABRIC: &str = "fabric.csv";
const TRACTIONS: &str = "tractions.csv";
const FRONTS: &str = "fronts.csv";
const FRONT_SPEEDS: &str = "front_speeds.csv";
const PARTICLES: &str = "particles";
const GRID: &str = "grid";
const SURFACES: &str = "surfaces";
const FRINGES: &str = "fringes";
const FRINGES_TABLE: &str = "fringes.csv";
const FRINGES_ANIMATION: &str = "fringes.png";
/// The picture of the last snapshot, which is drawn once a run has ended.
pub const PICTURE: &str = "picture.png";
/// The chart, which is drawn then, too.
pub const CHART: &str = "plot.png";

/// What makes records doubtful.
#[derive(Clone, Debug, PartialEq)]
pub struct Doubt {
    /// A sentence.
    pub message: String,
    /// What to try.
    pub advice: &'static str,
}

impl Doubt {
    /// Of all that have these names, the same: a sentence about the first, with how many more there are.
    fn of_all(names: &[&String], message: impl Fn(&str) -> String, advice: &'static str) -> Vec<Doubt> {
        let Some((first, others)) = names.split_first() else { return Vec::new() };
        let more = if others.is_empty() { String::new() } else { format!(" and {} more", others.len()) };
        vec![Doubt { message: message(&format!("`{first}`{more}")), advice }]
    }
}

/// One kind of output, or whatever else wants to look at a run.
pub trait Observer {
    /// The time from which its next record is due [s]; 0 asks for every step.
    fn next(&self) -> f64;

    /// Records the present state. What takes long is handed over, to be written while the run goes on.
    /// Contacts are read by a [`crate::door::ContactCursor`] of the observer's own.
    ///
    /// # Errors
    /// The disk is full or refuses, now or at an earlier record; what was written before stays readable.
    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError>;

    /// Writes what only the whole of the records tells: called once, after the last.
    ///
    /// # Errors
    /// The disk is full or refuses.
    fn conclude(&mut self) -> Result<(), OutputError> {
        Ok(())
    }

    /// What makes its records doubtful, known after [`Observer::conclude`].
    fn doubts(&self) -> Vec<Doubt> {
        Vec::new()
    }

    /// Keeps what it needs to go on in a resumed run, or takes that up, see [`Memory`]. When it keeps, all that was
    /// handed over is on the disk on return; when it takes up, what was written after the checkpoint is cut off.
    ///
    /// # Errors
    /// The disk is full or refuses; a file is not as it was at the checkpoint.
    fn remember(&mut self, _view: &dyn View, _memory: &mut Memory) -> Result<(), OutputError> {
        Ok(())
    }

    /// Whether a second record at the same time takes the place of the first, as for snapshots; tables would repeat a
    /// row.
    fn replaces(&self) -> bool {
        false
    }
}

impl<O: Observer + ?Sized> Observer for &mut O {
    fn next(&self) -> f64 {
        (**self).next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        (**self).observe(view)
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        (**self).conclude()
    }

    fn doubts(&self) -> Vec<Doubt> {
        (**self).doubts()
    }

    fn remember(&mut self, view: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        (**self).remember(view, memory)
    }

    fn replaces(&self) -> bool {
        (**self).replaces()
    }
}
