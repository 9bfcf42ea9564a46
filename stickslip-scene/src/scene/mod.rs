//! What the user asks for: a [`Scene`], in SI units, with every parameter resolved.
//!
//! A scene is plain data. It says nothing about precision of its storage, threads or blocks; the engine is built from
//! it. Vectors have three components; a plane scene uses the first two and takes the third as zero.

mod body_list;
mod building;
mod course;
mod document_node;
mod error;
mod expression;
mod file;
mod formula;
mod fringes;
mod gravity;
mod health;
mod held_faces;
mod joints;
mod letters;
mod load;
mod loads;
mod measurements;
mod name_pattern;
mod outside;
mod overrides;
mod parameters;
mod periodic;
mod problem;
mod schema;
mod source;
mod springs;
mod suggestion;
mod units;
mod was_read;

pub use crate::friction::FrictionMemory;
pub use crate::scheme::{BasisKind, Face, Interior, Transfer, VolumeChange};
pub use body_list::BodyList;
pub use course::{Change, Changes, Course, LEAST_PART, MOST_PIECES, Passing, TOLERANCE};
pub use error::{Mistake, SceneError};
pub use expression::{Expression, Moment, Program, TimeTable};
pub use file::{Disk, SceneFiles};
pub use fringes::{Fringes, Light, Overlay, Polariscope, PolariscopeField, Sensitivity};
pub use gravity::Gravity;
pub use health::{Health, HealthCheck, HealthRule, Response};
pub use joints::{Joint, JointKind, Motor};
pub use letters::{escaped, shortened, steers_terminal, steers_text};
pub use load::{Loaded, load, parse, parse_beside};
pub use loads::{Action, Dashpot, Extent, Load, Part, RIGID, Support, SupportMotion};
pub use measurements::{
    Anchor, Arrival, FACES, Fabric, Front, Group, Measurements, Observable, Probe, Reading, Section,
    TimeUnit, Tractions,
};
pub use name_pattern::{NamePattern, RuleNames, is_pattern};
pub use outside::{LEAST_CALLS, MOST_CALLS, MeanRoom, OutsideUse, OutsideValue};
pub use periodic::{PERIOD_STEP, SHORTEST_PERIOD};
pub use problem::Problem;
pub use schema::schema;
pub use source::Source;
pub use springs::{Spring, SpringEnd};
pub use was_read::{FileRead, WasRead, first_other, sum_of_file};

use crate::geometry::{Arrangement, Shape, SiteLattice};
use crate::material::{Material, Thickness};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::collections::HashSet;
use std::path::PathBuf;

/// Everything that a run needs, resolved to SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scene {
    /// One line for plots, pictures and summaries.
    pub title: String,
    /// What the scene shows and which numbers it must give.
    pub about: String,
    /// The named parameters of the file with the values of this run.
    pub parameters: BTreeMap<String, Parameter>,
    /// Two or three dimensions.
    pub dimension: Dimension,
    /// Number format of the particles and the grid.
    pub precision: Precision,
    /// Cells, particles and shape functions.
    pub discretization: Discretization,
    /// Where material may be, and what its faces do; `None` is unbounded space.
    pub domain: Option<Domain>,
    /// Time and how it is stepped.
    pub time: Time,
    /// From where bodies begin, if not as their shapes are filled.
    pub start: Option<Start>,
    /// What slows the bodies down beside contact and materials.
    pub damping: Damping,
    /// What a run watches, and what it does where something is wrong.
    pub health: Health,
    /// Acceleration of every body.
    pub gravity: Gravity,
    /// The materials that bodies name.
    pub materials: Vec<NamedMaterial>,
    /// The bodies, in the order of the file.
    pub bodies: BodyList,
    /// What holds, presses, pulls or drives parts of bodies from outside: supports, then loads.
    pub loads: Vec<Load>,
    /// What joins rigid bodies to each other and to the ground.
    pub joints: Vec<Joint>,
    /// Springs and dashpots between parts of bodies.
    pub springs: Vec<Spring>,
    /// Contact rules; the first that matches a pair holds, see [`Scene::contact_between`].
    pub contact: Vec<ContactRule>,
    /// What is written, and how often.
    pub outputs: Outputs,
    /// Known answers that plots and summaries hold the run against.
    pub references: Vec<Reference>,
}

/// The state of another run, from which bodies of the same names begin.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Start {
    /// Its folder of results, a checkpoint, or a snapshot.
    #[serde(serialize_with = "path_as_text")]
    pub from: PathBuf,
    /// Time of the snapshot in the folder [s]; `None`: its newest checkpoint.
    pub at: Option<f64>,
    /// What becomes of the velocities there.
    pub velocities: StartVelocities,
}

/// What becomes of velocities where bodies begin as another run left them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StartVelocities {
    /// They go on.
    Kept,
    /// The bodies begin at rest.
    Zero,
}

/// A named parameter of a scene file as it was used.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Parameter {
    /// A number in SI units.
    Number(f64),
    /// A word, such as the name of a contact law.
    Text(String),
}

impl Parameter {
    /// Its number in SI units, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Parameter::Number(value) => Some(*value),
            Parameter::Text(_) => None,
        }
    }
}

/// Two or three dimensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Dimension {
    /// Plane strain: two dimensions, no strain out of the plane; masses and forces are per metre of depth.
    PlaneStrain,
    /// Plane stress: two dimensions, no stress out of the plane; masses and forces are per metre of undeformed
    /// thickness.
    PlaneStress,
    /// Three dimensions.
    Space,
}

impl Dimension {
    /// Its name in sentences.
    pub fn name(self) -> &'static str {
        match self {
            Dimension::PlaneStrain => "plane strain",
            Dimension::PlaneStress => "plane stress",
            Dimension::Space => "space",
        }
    }

    /// Number of axes: 2 or 3.
    pub fn axes(self) -> usize {
        match self {
            Dimension::PlaneStrain | Dimension::PlaneStress => 2,
            Dimension::Space => 3,
        }
    }

    /// Whether vectors have two components.
    pub fn is_plane(self) -> bool {
        self.axes() == 2
    }

    /// The thickness that particles take.
    pub fn thickness(self) -> Thickness {
        match self {
            Dimension::PlaneStress => Thickness::Free,
            Dimension::PlaneStrain | Dimension::Space => Thickness::Moved,
        }
    }
}

/// Number format of the particles and the grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Precision {
    /// `f32`.
    Single,
    /// `f64`.
    #[default]
    Double,
}

/// How the arrays of files for ParaView are packed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Compression {
    /// In blocks, by zlib.
    #[default]
    Zlib,
    /// Not at all.
    None,
}

/// Format of the files of a series of snapshots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SeriesFormat {
    /// VTK's unstructured grid.
    Vtu,
    /// VTK's polygons.
    #[default]
    Vtp,
    /// A model in glTF.
    Glb,
}

/// Cells, particles and shape functions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Discretization {
    /// Side of a grid cell [m].
    pub cell: f64,
    /// Particles along each side of a cell: 2 means 4 in the plane, 8 in space.
    pub particles_per_side: usize,
    /// Shape functions.
    pub basis: BasisKind,
    /// Where bodies that deform and do not say so are computed.
    pub interior: Interior,
    /// Why that was chosen, where the scene leaves it open.
    #[serde(skip)]
    pub because: Option<String>,
}

/// A box that holds all material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Domain {
    /// Lower corner [m]; grid nodes lie at whole cells from here.
    pub min: [f64; 3],
    /// Upper corner [m].
    pub max: [f64; 3],
    /// What the lower and the upper face across each axis do.
    pub faces: [[Face; 2]; 3],
    /// What becomes of a particle that leaves it.
    #[serde(default, skip_serializing_if = "Leaving::stops")]
    pub leaving: Leaving,
}

/// What becomes of a particle of a deformable body that leaves the domain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Leaving {
    /// It ends the run; so does that of a rigid body in any case.
    #[default]
    Stop,
    /// It is taken out, and the run goes on without it.
    Remove,
}

impl Leaving {
    /// Whether it ends the run: a record of a scene does not say so.
    fn stops(&self) -> bool {
        *self == Leaving::Stop
    }
}

/// Time and how it is stepped.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Time {
    /// Simulated time at which the run ends [s].
    pub end: f64,
    /// Time step as a fraction of the time in which a wave crosses a cell.
    pub courant: f64,
    /// No step is longer than this [s].
    pub max_step: Option<f64>,
    /// When in the step the stress is updated.
    pub stress_update: StressUpdate,
    /// What particles take from the grid and give to it.
    pub transfer: Transfer,
    /// Share of the grid's velocity itself (PIC) in the particles' new velocity;
    /// the rest takes the grid's change of velocity (FLIP). 0 to 1.
    pub pic_share: f64,
    /// m of XPIC(m); other transfers have none.
    pub xpic_order: usize,
    /// The run looks for the state at rest, and ends there if that comes before `end`.
    pub relax: Option<Relaxation>,
    /// Drift of the energy, and energy that becomes noise, that a run may have, over the energy that moved [-]; see
    /// [`Scene::health_bound`].
    pub energy_drift: f64,
}

/// Dynamic relaxation: by critical damping of bodies on grids of their own (Underwood 1983), and where others deform,
/// by velocities that are set to zero wherever the kinetic energy has passed a peak (Cundall 1982).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Relaxation {
    /// The bodies are at rest once the sum of the unbalanced forces at the nodes is at most this part of the sum of the
    /// internal or of the external forces there, whichever is larger [-].
    pub residual: f64,
}

/// What slows deformable bodies down beside contact and materials; by default nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Damping {
    /// Rate alpha of a force f = -alpha m v at every node, relative to the grid at rest [1/s].
    pub viscous: f64,
    /// Part lambda of the unbalanced force at a node that acts against its velocity, f_d = -lambda |f| sign(v)
    /// (Cundall 1987): from 0 to below 1 [-].
    pub local: f64,
    /// Bulk viscosity, where material is compressed: its coefficients c_1 and c_2 of the first and second power of the
    /// rate (Landshoff 1955; von Neumann and Richtmyer 1950) [-].
    pub bulk: [f64; 2],
}

impl Damping {
    /// What a scene has that names none: nothing, and a little local damping where it looks for the state at rest.
    /// There velocities of single particles, which no node sees, would stop the bodies again and again before they have
    /// moved.
    pub fn of(relax: Option<Relaxation>) -> Self {
        Damping { local: if relax.is_some() { 0.05 } else { 0.0 }, ..Damping::default() }
    }
}

/// Most that the coefficients of bulk viscosity may be: beyond, the stable step would be shorter than waves ask for.
pub const MOST_BULK: [f64; 2] = [1.0, 10.0];

/// When in the step strain and stress are computed (Bardenhagen 2002; Nairn 2003).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum StressUpdate {
    /// From the velocities interpolated at the start of the step (USF).
    First,
    /// From the integrated velocities at the end of the step (USL).
    Last,
    /// From the particles' new velocities, interpolated once more at the end of the step (MUSL).
    #[default]
    ModifiedLast,
}

/// A material with its name and density.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NamedMaterial {
    /// The name that bodies and contact rules use.
    pub name: String,
    /// Mass per undeformed volume [kg/m^3].
    pub density: f64,
    /// The constitutive law with its constants.
    pub law: Material<f64>,
    /// Whether its particles change their volume each by itself.
    pub volume_change: VolumeChange,
    /// alpha, by how much it grows in every direction without stress, for each kelvin [1/K].
    pub thermal_expansion: f64,
}

/// A body: a shape filled with a material, and how it moves at the start.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Body {
    /// Its name, unique in the scene.
    pub name: String,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// Where it is at the start.
    pub shape: Shape,
    /// How its particles are laid out.
    pub particles: Arrangement,
    /// Particles along each side of a cell, where it has not those of the scene.
    pub particles_per_side: Option<usize>,
    /// Where it is computed, if not where those of the scene are; see [`Scene::interior`].
    pub interior: Option<Interior>,
    /// Side of the cells of its own grid, where it is not that of the scene's [m]; see [`Scene::cell`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cell: Option<f64>,
    /// How it moves.
    pub motion: BodyMotion,
    /// Cauchy stress before anything moves, by the place: xx, yy, zz, xy, yz, xz, tension positive [Pa]; `None`: none.
    pub stress: Option<Box<[Expression; 6]>>,
    /// Velocity at the start by the place, of a body that deforms, beside that of `motion` [m/s]; `None`: none.
    pub velocity_by_place: Option<Box<[Expression; 3]>>,
}

/// How a body moves.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum BodyMotion {
    /// It deforms and moves under forces, from this start.
    Free {
        /// Velocity of its centre of mass [m/s].
        velocity: [f64; 3],
        /// Angular velocity about its centre of mass [rad/s]; in the plane only the third component.
        spin: [f64; 3],
    },
    /// It is rigid and moves as prescribed, whatever pushes it.
    Rigid {
        /// Velocity of its centre of mass at time t [m/s].
        velocity: Box<[Expression; 3]>,
        /// Angular velocity about its centre of mass at time t [rad/s].
        spin: Box<[Expression; 3]>,
    },
    /// It is rigid and moves under forces, from this start.
    FreeRigid(FreeRigid),
}

/// A rigid body that forces move.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FreeRigid {
    /// Velocity of its centre of mass at the start [m/s].
    pub velocity: [f64; 3],
    /// Angular velocity about its centre of mass at the start [rad/s].
    pub spin: [f64; 3],
    /// Its mass, if not that of its shape and its material's density [kg], in the plane per metre of depth.
    pub mass: Option<f64>,
    /// Moments of inertia about the three axes through its centre at the start, if not those of its shape [kg m^2].
    pub inertia: Option<[f64; 3]>,
}

/// How two bodies touch.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContactRule {
    /// The pairs it holds for: each entry is the name of bodies or of a material, or a pattern of names, in which `*`
    /// is any letters; `None` matches every body.
    pub between: [Option<String>; 2],
    /// The contact law.
    pub law: ContactLaw,
    /// Coefficient of friction of surfaces that do not slip; infinity sticks, 0 is frictionless. Written as `"inf"`
    /// where numbers cannot be infinite.
    #[serde(serialize_with = "infinity_as_text")]
    pub friction: f64,
    /// Whether the file says what the friction is; without, it is 0.
    #[serde(skip)]
    pub friction_given: bool,
    /// Coefficient of friction of surfaces that slip fast, at most [`ContactRule::friction`].
    #[serde(serialize_with = "infinity_as_text")]
    pub kinetic_friction: f64,
    /// Speed of slip over which friction falls from the one to the other [m/s]; 0: as soon as they slip.
    pub friction_decay_speed: f64,
    /// How friction follows a change of pressure; `None`: at once.
    pub friction_memory: Option<FrictionMemory>,
    /// Shear strength of the contact beside friction [Pa].
    pub cohesion: f64,
    /// Tensile strength of the contact [Pa].
    pub adhesion: f64,
    /// Shear traction over speed of slip [Pa s/m].
    pub viscosity: f64,
    /// Where the direction of the contact comes from.
    pub normal: Normal,
    /// Largest strain of a cell by contact in one step, the paper's gamma: 0 to 1.
    pub max_strain: f64,
    /// Coefficient of restitution between rigid bodies of which one is free: the speed at which they part over that at
    /// which they met, 0 to 1.
    pub restitution: f64,
    /// How bodies that overlap at the start are pressed apart; `None`: they are not, and the overlap stays as it is.
    pub press: Option<Press>,
}

/// An interference fit: surfaces grow from no overlap to all of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Press {
    /// Within which time [s]; `None`: ten times that in which a wave runs through the largest of the bodies.
    pub time: Option<f64>,
}

/// When bodies that share a grid node push on each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ContactLaw {
    /// They do not.
    None,
    /// When they approach (Bardenhagen, Brackbill and Sulsky 2000).
    Kinematic,
    /// When the normal traction between them is compressive (Bardenhagen et al. 2001).
    Traction,
    /// When they approach or the normal traction is compressive, once their surfaces touch:
    /// the bodies fill the room around the node.
    Gap,
    /// When their undeformed shapes, carried along by the deformation, touch: a push that sums over the step,
    /// never a pull.
    Surface,
    /// When they approach or the normal traction is compressive, once their extrapolated positions are close (Nairn
    /// 2013).
    Separation,
    /// When they approach, once the particles that logistic regression tells apart touch (Nairn,
    /// Hammerquist and Smith 2020).
    Regression,
    /// Always and in every direction: one velocity for both.
    Glued,
}

/// Where the direction of a contact comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Normal {
    /// Each body uses the gradient of its own grid mass, as the paper prints it.
    Own,
    /// One direction for the pair, from the difference of the two volume gradients; conserves momentum.
    Common,
}

/// What is written, and how often. Intervals are in seconds of simulated time; `None` writes nothing.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outputs {
    /// Rows of `bodies.csv`, `energy.csv` and `contacts.csv`.
    pub tables: f64,
    /// Names of the bodies that have rows in `bodies.csv`; `None`: all. Those of which answers are known have them,
    /// too.
    pub bodies: Option<Vec<String>>,
    /// Particles for ParaView.
    pub particles: Option<f64>,
    /// Times of further snapshots of the particles, ascending [s].
    pub particles_at: Vec<f64>,
    /// What snapshots hold.
    pub snapshots: SnapshotContent,
    /// Surfaces of bodies.
    pub surfaces: Option<f64>,
    /// Of the files that have them.
    pub surface_format: SeriesFormat,
    /// Grid nodes for ParaView.
    pub grid: Option<f64>,
    /// Photoelastic fringes.
    pub fringes: Option<Fringes>,
    /// Checkpoints, from which a run can go on.
    pub checkpoints: Option<f64>,
    /// Probes, arrivals and fronts.
    pub measurements: Measurements,
}

/// What snapshots of particles and grid hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SnapshotContent {
    /// Number format of what files hold, whatever the run computes with.
    pub precision: Precision,
    /// How files are packed.
    pub compression: Compression,
    /// Names of the columns of particles beside their positions, body and number; `None`: all.
    pub columns: Option<Vec<String>>,
    /// Names of the bodies whose particles, or surfaces, they hold; `None`: all.
    pub bodies: Option<Vec<String>>,
    /// Of each body, the particles whose number is a multiple of this.
    pub every: usize,
}

impl SnapshotContent {
    /// Of each of these bodies, whether files hold it.
    pub fn held(&self, bodies: &[Body]) -> Vec<bool> {
        let named: Option<HashSet<&String>> = self.bodies.as_ref().map(|names| names.iter().collect());
        bodies.iter().map(|body| named.as_ref().is_none_or(|names| names.contains(&body.name))).collect()
    }
}

impl Default for SnapshotContent {
    fn default() -> Self {
        SnapshotContent {
            precision: Precision::Single,
            compression: Compression::Zlib,
            columns: None,
            bodies: None,
            every: 1,
        }
    }
}

/// A known answer for one quantity of one body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reference {
    /// Name of the body.
    pub body: String,
    /// A column of `bodies.csv`: `x`, `vx`, `wz` ...
    pub quantity: String,
    /// Its exact value as a function of time.
    pub value: Expression,
    /// What the answer assumes: `"rigid sphere, paper eq. (23)"`.
    pub label: String,
}

impl NamedMaterial {
    /// Speed of the fastest wave in an undeformed body, in plane stress in a plate [m/s].
    pub fn wave_speed(&self, thickness: Thickness) -> f64 {
        (self.law.wave_modulus_at_rest(thickness) / self.density).sqrt()
    }
}

impl Body {
    /// Whether it is rigid: it moves as prescribed, or it is free.
    pub fn is_rigid(&self) -> bool {
        matches!(self.motion, BodyMotion::Rigid { .. } | BodyMotion::FreeRigid(_))
    }

    /// How it starts as a rigid body that forces move, if it is one.
    pub fn as_free_rigid(&self) -> Option<&FreeRigid> {
        match &self.motion {
            BodyMotion::FreeRigid(free) => Some(free),
            BodyMotion::Free { .. } | BodyMotion::Rigid { .. } => None,
        }
    }

    /// Whether it is rigid and moves as prescribed, whatever pushes it.
    pub fn is_prescribed(&self) -> bool {
        matches!(self.motion, BodyMotion::Rigid { .. })
    }
}

impl Scene {
    /// Names of what has rows in `joints.csv`: joints, and then springs.
    pub fn joint_names(&self) -> impl Iterator<Item = &str> {
        let joints = self.joints.iter().map(|joint| joint.name.as_str());
        joints.chain(self.springs.iter().map(|spring| spring.name.as_str()))
    }

    /// The particle sites of a body: every cell of the scene's grid divided into equal parts.
    pub fn lattice(&self, body: &Body) -> SiteLattice {
        SiteLattice {
            origin: self.domain.as_ref().map_or([0.0; 3], |domain| domain.min),
            spacing: self.cell(body) / self.per_side(body),
            dimension: self.dimension.axes(),
        }
    }

    /// Particles of a body along each side of a cell.
    pub(crate) fn per_side(&self, body: &Body) -> f64 {
        body.particles_per_side.unwrap_or(self.discretization.particles_per_side) as f64
    }

    /// Where a body is computed: as it says, or else as the scene does. A rigid one is on the grid.
    pub fn interior(&self, body: usize) -> Interior {
        self.interior_of(&self.bodies[body])
    }

    /// Side of the cells on which a body is computed: of its own grid, or of the one that all share [m].
    pub fn cell(&self, body: &Body) -> f64 {
        let own = body.cell.filter(|_| self.interior_of(body) == Interior::Reference);
        own.unwrap_or(self.discretization.cell)
    }

    fn interior_of(&self, body: &Body) -> Interior {
        match body {
            body if body.is_rigid() => Interior::Grid,
            body => body.interior.unwrap_or(self.discretization.interior),
        }
    }

    /// How particles are laid out in a body: parts of the cells of a grid of its own, or as the body says.
    pub fn arrangement(&self, body: &Body) -> Arrangement {
        match self.interior_of(body) {
            Interior::Reference => Arrangement::Parts(self.held_faces(body)),
            Interior::Grid => body.particles,
        }
    }

    /// Pairs of rigid bodies that a joint holds together, the smaller index first: they do not touch each other.
    /// Springs do not hold.
    pub fn joined_pairs(&self) -> HashSet<[usize; 2]> {
        let holding = self.joints.iter().filter(|joint| joint.holds());
        holding.filter_map(|joint| Some([joint.body.min(joint.to?), joint.body.max(joint.to?)])).collect()
    }

    /// Whether contact can act between two bodies: not between prescribed ones, nor between those that are joined.
    pub fn may_touch(&self, [a, b]: [usize; 2], joined: &HashSet<[usize; 2]>) -> bool {
        let both = |is: fn(&Body) -> bool| is(&self.bodies[a]) && is(&self.bodies[b]);
        !(both(Body::is_prescribed) || joined.contains(&[a.min(b), a.max(b)]))
    }

    /// The rule for two bodies, given by index: the first in the file that matches, else the default rule.
    pub fn contact_between(&self, a: usize, b: usize) -> ContactRule {
        self.contact_rule_between(a, b).map(|rule| self.contact[rule].clone()).unwrap_or_default()
    }

    /// Number of the rule for two bodies: the first in the file that matches; `None` where the default rule holds.
    pub fn contact_rule_between(&self, a: usize, b: usize) -> Option<usize> {
        let matches = |filter: &Option<String>, body: usize| {
            filter.as_ref().is_none_or(|name| {
                let body = &self.bodies[body];
                let pattern = NamePattern::new(name);
                pattern.matches(&body.name) || pattern.matches(&self.materials[body.material].name)
            })
        };
        self.contact.iter().position(|rule| {
            let [first, second] = &rule.between;
            (matches(first, a) && matches(second, b)) || (matches(first, b) && matches(second, a))
        })
    }
}

/// JSON has text alone: what is no letter of a path is replaced.
fn path_as_text<S: serde::Serializer>(path: &std::path::Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&path.to_string_lossy())
}

/// JSON has no infinity; scene files write it `"inf"`.
fn infinity_as_text<S: serde::Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    if value.is_infinite() { serializer.serialize_str("inf") } else { serializer.serialize_f64(*value) }
}
