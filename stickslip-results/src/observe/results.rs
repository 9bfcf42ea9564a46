//! Reading what a run wrote: for plots, pictures and tests.

use super::arrivals::ArrivalRow;
use super::bodies::BodyRow;
use super::contacts::ContactRow;
use super::energy::EnergyRow;
use super::fabric::FabricRow;
use super::file::{ReadError, ReadProblem};
use super::frames::{Frame, read_frames};
use super::fringes::{FringeRow, frame_file};
use super::fronts::{FrontRow, FrontSpeedRow};
use super::groups::{GroupContactRow, GroupRow};
use super::joints::JointRow;
use super::loads::LoadRow;
use super::manifest::Manifest;
use super::particles::read_particles;
use super::probes::ProbeRow;
use super::reactions::ReactionRow;
use super::recorded::RecordedScene;
use super::removed::RemovedRow;
use super::sections::SectionRow;
use super::table::{TableRow, read_rows};
use super::tractions::TractionRow;
use super::{
    ARRIVALS, BODIES, CONTACTS, ENERGY, FABRIC, FRINGES, FRINGES_TABLE, FRONT_SPEEDS, FRONTS, GROUP_CONTACTS,
    GROUPS, JOINTS, LOADS, PARTICLES, PROBES, REACTIONS, REMOVED, SECTIONS, TRACTIONS,
};
use crate::column::every;
use crate::door::ParticleSnapshot;
use std::fs;
use std::path::{Path, PathBuf};

/// The results of a run, finished or not.
#[derive(Clone, Debug)]
pub struct Results {
    folder: PathBuf,
    manifest: Manifest,
    frames: Vec<Frame>,
}

impl Results {
    /// Opens the folder of a run. Tables and particles are read when asked for.
    ///
    /// # Errors
    /// The folder holds no record of a run, or its list of snapshots cannot be read.
    pub fn open(folder: &Path) -> Result<Self, ReadError> {
        let manifest = Manifest::read(folder)?;
        let collection = folder.join(format!("{PARTICLES}.pvd"));
        let frames = if collection.exists() { read_frames(&collection)? } else { Vec::new() };
        Ok(Results { folder: folder.to_path_buf(), manifest, frames })
    }

    /// What was run and how it went.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// The scene that was run.
    ///
    /// # Errors
    /// Another version of the program wrote it.
    pub fn scene(&self) -> Result<RecordedScene, ReadError> {
        let read = self.manifest.scene.read();
        read.map_err(|error| ReadProblem::from(error).at(&self.folder.join(Manifest::FILE)))
    }

    /// Names of the bodies, in the order of the numbers in snapshots.
    pub fn body_names(&self) -> &[String] {
        &self.manifest.bodies
    }

    /// Snapshots of particles in the order of time; none if the scene asked for none.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// Whether snapshots hold every particle of their bodies with all columns that pictures, fringes and
    /// [`Results::particles`] need.
    pub fn has_whole_snapshots(&self) -> bool {
        let scene = self.manifest.scene.value();
        let asked = |key: &str| scene.pointer(&format!("/outputs/snapshots/{key}"));
        if asked("every").and_then(|every| every.as_u64()).is_some_and(|every| every > 1) {
            return false;
        }
        let Some(columns) = asked("columns").and_then(|columns| columns.as_array()) else { return true };
        let has = |name: &str| name == every("position").name || columns.iter().any(|column| column == name);
        ParticleSnapshot::default().columns().all(|(column, _)| has(column.name))
    }

    /// The particles of a snapshot.
    ///
    /// # Errors
    /// The file is missing or damaged.
    pub fn particles(&self, frame: &Frame) -> Result<ParticleSnapshot, ReadError> {
        read_particles(&frame.path)
    }

    /// `bodies.csv`: at each time a row for each body, in the order of the scene.
    ///
    /// # Errors
    /// The file is missing or damaged; so for the other tables.
    pub fn bodies_table(&self) -> Result<Vec<BodyRow>, ReadError> {
        self.table(BODIES)
    }

    /// `energy.csv`: a row for each time.
    ///
    /// # Errors
    /// The file is missing or damaged.
    pub fn energy_table(&self) -> Result<Vec<EnergyRow>, ReadError> {
        self.table(ENERGY)
    }

    /// `contacts.csv`: at each time a row for each pair of bodies that touched since the time before.
    ///
    /// # Errors
    /// The file is missing or damaged.
    pub fn contacts_table(&self) -> Result<Vec<ContactRow>, ReadError> {
        self.table(CONTACTS)
    }

    /// `sections.csv`: at each time a row for each section; none if the scene has none.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn sections_table(&self) -> Result<Vec<SectionRow>, ReadError> {
        self.measured(SECTIONS)
    }

    /// `reactions.csv`: at each time but the first a row for each body at a face, and for each rigid body, that the
    /// scene asks for.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn reactions_table(&self) -> Result<Vec<ReactionRow>, ReadError> {
        self.measured(REACTIONS)
    }

    /// `groups.csv`: at each time a row for each group of bodies; none if the scene has none.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn groups_table(&self) -> Result<Vec<GroupRow>, ReadError> {
        self.measured(GROUPS)
    }

    /// `group_contacts.csv`: at each time a row for each pair of groups that touched since the time before; none if the
    /// scene has no groups.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn group_contacts_table(&self) -> Result<Vec<GroupContactRow>, ReadError> {
        self.measured(GROUP_CONTACTS)
    }

    /// `fabric.csv`: at each time but the first a row for each packing whose stress and fabric the scene asks for.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn fabric_table(&self) -> Result<Vec<FabricRow>, ReadError> {
        self.measured(FABRIC)
    }

    /// `tractions.csv`: at each time a row for each point of contact that the scene asks for.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn tractions_table(&self) -> Result<Vec<TractionRow>, ReadError> {
        self.measured(TRACTIONS)
    }

    /// `joints.csv`: at each time but the first a row for each joint; none if the scene has none.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn joints_table(&self) -> Result<Vec<JointRow>, ReadError> {
        self.measured(JOINTS)
    }

    /// `loads.csv`: at each time but the first a row for each support and load; none if the scene has none.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn loads_table(&self) -> Result<Vec<LoadRow>, ReadError> {
        self.measured(LOADS)
    }

    /// `removed.csv`: what bodies lost with particles that left the domain; none if the scene lets none go.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn removed_table(&self) -> Result<Vec<RemovedRow>, ReadError> {
        self.measured(REMOVED)
    }

    /// `fringes.csv`: a row for each frame of the scene's camera; none if it has none.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn fringes_table(&self) -> Result<Vec<FringeRow>, ReadError> {
        self.measured(FRINGES_TABLE)
    }

    /// Where the picture of a frame of the scene's camera is.
    pub fn fringe_picture(&self, row: &FringeRow) -> PathBuf {
        self.folder.join(FRINGES).join(frame_file(row.frame))
    }

    /// `probes.csv`: at each sample a row for each probe that has material around it; none if the scene has no probes.
    ///
    /// # Errors
    /// The file is damaged; so for the tables of the other measurements.
    pub fn probes_table(&self) -> Result<Vec<ProbeRow>, ReadError> {
        self.measured(PROBES)
    }

    /// `arrivals.csv`: a row for each threshold that was passed, in the order of passing.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn arrivals_table(&self) -> Result<Vec<ArrivalRow>, ReadError> {
        self.measured(ARRIVALS)
    }

    /// `fronts.csv`: at each sample a row for each front that there is.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn fronts_table(&self) -> Result<Vec<FrontRow>, ReadError> {
        self.measured(FRONTS)
    }

    /// `front_speeds.csv`: a row for each front that went far enough.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn front_speeds_table(&self) -> Result<Vec<FrontSpeedRow>, ReadError> {
        self.measured(FRONT_SPEEDS)
    }

    /// The rows of a table that is there only if the scene asks for it.
    fn measured<R: TableRow>(&self, name: &str) -> Result<Vec<R>, ReadError> {
        let known = self.manifest.tables.contains_key(name) || self.folder.join(name).exists();
        if known { self.table(name) } else { Ok(Vec::new()) }
    }

    /// The rows of a table, none of which is lost.
    fn table<R: TableRow>(&self, name: &str) -> Result<Vec<R>, ReadError> {
        let path = self.folder.join(name);
        let found = fs::metadata(&path).map_or(0, |about| about.len());
        if let Some(&wrote) = self.manifest.tables.get(name).filter(|&&wrote| found < wrote && found > 0) {
            let cut = format!("it was cut: it has {found} bytes where the run wrote {wrote}");
            return Err(ReadProblem::Layout(cut).at(&path));
        }
        read_rows(&path)
    }
}
