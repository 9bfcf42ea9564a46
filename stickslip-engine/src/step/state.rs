//! What a simulation is between two steps, and what can be made anew from that.

use super::account::{NodeTotals, StepSums};
use super::cpu::Threads;
use super::heat::Warmed;
use super::loads::LoadRoom;
use super::mechanism::{JointSums, Mechanism, RigidSurfaces, TouchForce};
use super::reference::{CommonPartner, ReferenceBody, References, Skin, Touching};
use super::relax::RelaxationProgress;
use super::springs::SpringRoom;
use super::together::LawRoom;
use super::unbounded::Unbounded;
use super::walls::{WallBooks, WallSums};
use crate::body::{Body, Totals};
use crate::boundary::{Boundary, Wall};
use crate::contact::{BlockSums, ContactSums, Impulses, Rules, Survey};
use crate::damping::{BulkViscosity, NodeDamping};
use crate::door::{RemovedParticles, WrittenValues};
use crate::exact::ExactSum;
use crate::grid::{ActiveBlocks, Field, Lattice, Periods};
use crate::load::{LoadPoints, LoadSums, SpringPoints};
use crate::scene::{Changes, Gravity, Joint, Leaving, Time, Transfer};
use crate::tensor::Vector;
use std::sync::{Arc, Mutex};
use stickslip_reference::cells::Table;
use stickslip_reference::contact::{Neighbours, PeriodLengths};

use crate::pass::{Found, ParticleLoop};

/// What the scene says, the same in every step.
pub struct Settings<T, const D: usize> {
    pub lattice: Lattice<T, D>,
    /// Lower and upper corner of the domain [m].
    pub domain: Option<[Vector<T, D>; 2]>,
    /// The same without end where it is periodic: what particles may not leave [m].
    pub held: Option<[Vector<T, D>; 2]>,
    /// What becomes of a particle that leaves it.
    pub leaving: Leaving,
    /// Particles of each body at the start; none of rigid ones without bounds.
    pub filled: Vec<usize>,
    pub gravity: Gravity,
    /// What changes in the scene over time, which steps follow.
    pub changes: Changes,
    pub transfer: Transfer,
    pub pic_share: T,
    /// Faces of the domain that are not open.
    pub walls: Vec<Wall>,
    pub damping: NodeDamping<T>,
    pub viscosity: Option<BulkViscosity<T>>,
    pub rules: Rules<T>,
    /// Supports and loads with their points.
    pub loads: Vec<LoadPoints>,
    /// What joins rigid bodies.
    pub joints: Vec<Joint>,
    /// Springs between parts of bodies.
    pub springs: Vec<SpringPoints>,
    /// Surfaces of rigid bodies that may touch each other.
    pub surfaces: RigidSurfaces,
    /// Of each body, whether it is rigid and free; empty where none is.
    pub free: Vec<bool>,
    /// Rigid bodies, in their order.
    pub rigid: Vec<usize>,
    /// Bodies on grids of their own, in their order.
    pub references: Vec<ReferenceBody<D>>,
    /// Bodies on the common grid that such a body may meet.
    pub common: Vec<CommonPartner>,
    /// After which lengths everything is there again for these.
    pub lengths: PeriodLengths<D>,
    /// The functions at the particles of each of these.
    pub tables: Vec<Table<T, D>>,
    /// Bodies whose law takes all particles at once, in their order.
    pub together: Vec<usize>,
    /// Whether any body's material wants means of dilatation rate and pressure.
    pub averages_volume: bool,
    /// Whether some bodies begin with a stress.
    pub begins_stressed: bool,
    pub time: Time,
    pub path: ParticleLoop,
}

/// All that a copied, stored or resumed simulation needs: the same state takes the same steps, bit for bit.
#[derive(Clone)]
pub struct State<T, const D: usize> {
    /// Bodies with their particles, wherever these lie in memory: no sum follows that order. Rigid ones have their
    /// motion and pose.
    pub bodies: Vec<Body<T, D>>,
    /// Rigid bodies without bounds, with the blocks around which they have particles.
    pub unbounded: Vec<Unbounded<D>>,
    /// Nodes of bodies on grids of their own.
    pub references: References<D>,
    /// What contact did, pair by pair, and works since the start.
    pub contact_sums: ContactSums,
    /// The longest step that rigid bodies allow, by the scene with which the run began [s].
    pub longest_rigid: f64,
    /// What loads did since the start.
    pub loads: Vec<LoadSums>,
    /// What joints did since the start.
    pub joints: Vec<JointSums>,
    /// What rigid bodies pushed each other with in the last step.
    pub touch_forces: Vec<TouchForce>,
    /// What left the domain with particles since the start, body by body; empty until something does.
    pub removed: Vec<RemovedParticles>,
    /// What was written to particles between steps since the start, body by body; empty until something is.
    pub written: Vec<WrittenValues>,
    /// What springs did since the start, on the first of their bodies.
    pub springs: Vec<JointSums>,
    /// What bodies did to the domain's faces since the start, of each wall body by body; empty where nobody asks.
    pub walls: Vec<WallSums>,
    /// What damping took since the start, and impacts of rigid bodies [J].
    pub damping: f64,
    /// The part of it that impacts took [J].
    pub impacts: f64,
    /// Work of gravity since the start, where that varies [J].
    pub gravity_work: f64,
    /// How far dynamic relaxation has come.
    pub relaxation: RelaxationProgress,
    /// Fastest signal now [m/s]; unknown before the first step.
    pub signal: Option<f64>,
    /// Simulated time [s].
    pub time: f64,
    /// Steps taken.
    pub steps: u64,
    /// How many more count for when spins settle, so that they do in a run that begins from another one when they would
    /// have in that; a snapshot does not know.
    pub phase: u64,
}

/// What is known of bodies, in their order.
pub type ByBody<X> = [(usize, X)];

/// What is known of a body, if anything is.
pub fn of_body<X>(all: &ByBody<X>, body: usize) -> Option<&X> {
    let place = all.binary_search_by_key(&body, |(body, _)| *body).ok()?;
    Some(&all[place].1)
}

/// Lists, grids and room to work in, all of which follow from the state: dropping them changes no step.
pub struct Workspace<T, const D: usize> {
    /// Cell lists of the particles, and the active blocks.
    pub active: ActiveBlocks<D>,
    /// How far each body's order in memory is from that of tiles and cells; nothing is known of bodies beyond.
    pub disorder: Vec<Disorder>,
    /// Whether there are cell lists that hold for all particles but those that `left` their cells; else they are made
    /// from nothing.
    pub listed: bool,
    /// Nodes of all bodies' active blocks.
    pub field: Field<T, D>,
    /// Nodes that walls govern.
    pub boundary: Boundary,
    /// Where bodies meet in this step.
    pub survey: Survey<T, D>,
    /// Room for glue at one node: for each body there, one that stands for all that glue joins with it.
    pub groups: Vec<usize>,
    /// What contact did in the last step, use by use.
    pub impulses: [Impulses<T, D>; 3],
    /// Cells of each tile that particles have left.
    pub left: Vec<u64>,
    /// How many particles left cells of each tile.
    pub moved: Vec<u32>,
    /// What the last pass took from the kinetic energy of each tile's particles [J].
    pub damped: Vec<f64>,
    /// Sums over the step, which are booked at its end.
    pub sums: StepSums,
    /// What bodies did to faces in the step, where somebody asks.
    pub wall_sums: WallBooks,
    /// The same of bodies on grids of their own, as they touched the faces.
    pub reference_walls: WallBooks,
    /// Room for loads and supports.
    pub loads: LoadRoom<T, D>,
    /// Room for laws that take a body at once.
    pub laws: LawRoom,
    /// Room for springs.
    pub springs: SpringRoom<T, D>,
    /// Room for what heat does to the particles of a body.
    pub warmed: Vec<Warmed<T>>,
    /// What each of the rigid bodies found as it moved, and how many of its particles changed their cells.
    pub displaced: Vec<Option<(Found<T>, u32)>>,
    /// Free rigid bodies in a step.
    pub mechanism: Mechanism,
    /// Impulses of damping at the nodes in the last step, where there is damping [N s].
    pub damping_impulses: Vec<Vector<T, D>>,
    /// What pairs with bodies on grids of their own did in the step.
    pub reference_touches: Vec<BlockSums>,
    /// The points of theirs that touch in the step.
    pub reference_touching: Touching<D>,
    /// Points of theirs that may come to touch.
    pub neighbours: Neighbours<D>,
    /// What of bodies on the common grid is near their surfaces.
    pub skin: Skin,
    /// The signal that these bodies allow, if there are any [m/s].
    pub reference_signal: Option<f64>,
    /// What pairs of bodies did in the step, use by use of contact.
    pub touches: [Vec<BlockSums>; 3],
    /// Room for sums of mass times velocity over parts of a body's particles.
    pub weights: Vec<[ExactSum; D]>,
    /// Room for sums over the nodes of each block.
    pub block_sums: Vec<NodeTotals>,
    /// What the particles of each body add up to since the last step, once somebody has asked.
    pub totals: Mutex<Option<Arc<ByBody<Totals>>>>,
    /// What threads work with.
    pub threads: Threads<T, D>,
}

impl<T, const D: usize> Workspace<T, D> {
    /// An empty one, for a domain with these faces, on a grid that repeats or not.
    pub fn new(boundary: Boundary, periods: Periods<D>) -> Self {
        Workspace {
            active: ActiveBlocks::new(periods),
            disorder: Vec::new(),
            listed: false,
            field: Field { nodes: Vec::new(), present: Vec::new(), filtered: Vec::new(), means: Vec::new() },
            boundary,
            survey: Survey::default(),
            groups: Vec::new(),
            impulses: Default::default(),
            left: Vec::new(),
            moved: Vec::new(),
            damped: Vec::new(),
            sums: StepSums::default(),
            wall_sums: WallBooks::default(),
            reference_walls: WallBooks::default(),
            loads: LoadRoom::default(),
            laws: LawRoom::default(),
            springs: SpringRoom::default(),
            warmed: Vec::new(),
            displaced: Vec::new(),
            mechanism: Mechanism::default(),
            damping_impulses: Vec::new(),
            reference_touches: Vec::new(),
            reference_touching: Touching::default(),
            neighbours: Neighbours::default(),
            skin: Skin::default(),
            reference_signal: None,
            touches: Default::default(),
            weights: Vec::new(),
            block_sums: Vec::new(),
            totals: Mutex::new(None),
            threads: Threads::default(),
        }
    }
}

/// How far the order of a body's particles in memory is from that in which tiles visit them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Disorder {
    /// Particles that changed their cell since they were last sorted.
    moved: usize,
    /// That number summed over steps: what disorder in memory has cost.
    cost: usize,
}

impl Disorder {
    /// Particles in any order.
    pub fn any(count: usize) -> Self {
        Disorder { moved: count, cost: count }
    }

    /// Takes note of a step in which so many particles changed their cells.
    pub fn add(&mut self, moved: usize) {
        self.moved += moved;
        self.cost += self.moved;
    }

    /// Whether disorder has cost about as much as sorting does: a step costs that much more with a seventh to a fourth
    /// of the particles in other cells than they were sorted by.
    pub fn is_costly(self, count: usize) -> bool {
        4 * self.cost > count
    }
}
