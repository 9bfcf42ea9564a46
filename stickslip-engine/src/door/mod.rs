//! A running simulation with dimension and precision erased: what the command line, Python and observers see.
//!
//! Everything that crosses this door is `f64`, SI and three-dimensional;
//! plane scenes have zeros in the third component.

mod column;
mod saved;
mod snapshot;

pub use crate::particles::{ColumnPlace, NumberFormat};
pub use crate::ranks::RankShare;
pub use column::{ColumnRef, NoColumn, WRITABLE, WriteError};
pub(crate) use saved::SavedUnbounded;
pub use saved::{NotTakenUp, RestoreError, SavedBody, SavedColumn, SavedShare, SavedState};
pub use snapshot::{ColumnSource, ParticleSnapshot, SnapshotColumn};

use crate::column::ColumnDescription;
use crate::outside::OutsideFault;
use crate::particles::by_number;
use crate::rigid::Pose;
use crate::scene::StartVelocities;
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::collections::HashMap;
use std::ops::Range;

/// A simulation as it is now: observers, checks and pictures look at this. Asking changes nothing.
pub trait View {
    /// Simulated time [s].
    fn time(&self) -> f64;
    /// Steps taken.
    fn steps(&self) -> u64;
    /// Particles in all bodies.
    fn particles(&self) -> usize;
    /// The step that [`Simulation::step`] would take now if nothing cut it short [s].
    fn stable_step(&self) -> f64;
    /// What makes that step so short; `None` where only the scene does, or nobody knows. All particles are looked at.
    fn step_limit(&self) -> Option<StepLimit> {
        None
    }
    /// Each body's mass, motion and energy now, in the order of the scene; on all ranks but the first nothing.
    fn bodies(&self) -> Vec<BodyState>;
    /// Where each body is that is rigid, in the order of the scene; of simulations that know none, nothing.
    fn poses(&self) -> Vec<Option<Pose>> {
        Vec::new()
    }
    /// The energy and momentum ledger now.
    fn ledger(&self) -> Ledger;
    /// How far dynamic relaxation has come; `None` where the scene asks for none.
    fn relaxation(&self) -> Option<RelaxationState> {
        None
    }
    /// What contact did since the start, per pair of bodies whose surfaces ever touched, ordered by pair; a
    /// [`ContactCursor`] makes means of it.
    fn contact_sums(&self) -> Vec<ContactSum>;
    /// What loads and supports did since the start, in the order of the scene.
    fn loads(&self) -> Vec<LoadState> {
        Vec::new()
    }
    /// What joints did since the start, in the order of the scene.
    fn joints(&self) -> Vec<JointState> {
        Vec::new()
    }
    /// What bodies did to faces of the domain since the start, by face and then by body, where the scene asks for that.
    fn walls(&self) -> Vec<WallState> {
        Vec::new()
    }
    /// The widest contact of each pair of bodies since the start, ordered by pair.
    fn patches(&self) -> Vec<ContactPatch>;
    /// The points of surfaces of bodies on grids of their own that passed a force in the last step, by body, point and
    /// partner; none before the first step.
    fn contact_points(&self) -> Vec<ContactPoint> {
        Vec::new()
    }
    /// What left the domain since the start with particles that were taken out, in the order of the bodies; nothing of
    /// simulations that take none out.
    fn removed(&self) -> Vec<RemovedParticles> {
        Vec::new()
    }
    /// What [`Simulation::write`] changed since the start, in the order of the bodies; nothing where nothing was
    /// written.
    fn written(&self) -> Vec<WrittenValues> {
        Vec::new()
    }
    /// All particles now, ordered by body and then by the particle's number in its body.
    fn snapshot(&self) -> ParticleSnapshot;
    /// Of these some particles, from a body and a number in it up to, not with, another.
    fn snapshot_between(&self, ends: [(u32, u32); 2], wanted: &dyn Fn(u32, u32) -> bool) -> ParticleSnapshot {
        let inside = |body, number| (ends[0]..ends[1]).contains(&(body, number)) && wanted(body, number);
        self.snapshot().only(inside)
    }
    /// Shows every particle of a body to `look`, in no order that means anything.
    fn visit(&self, body: usize, look: &mut dyn FnMut(&ParticleView)) {
        let all = self.snapshot();
        for i in (0..all.body.len()).filter(|&i| all.body[i] as usize == body) {
            look(&ParticleView {
                number: all.number[i],
                mass: all.mass[i],
                volume: all.volume[i],
                position: all.position[i],
                velocity: all.velocity[i],
                stress: all.stress[i],
            });
        }
    }
    /// The particle of a body that moves fastest against a velocity [m/s]; none of a body without particles.
    fn fastest(&self, body: usize, against: [f64; 3]) -> Option<ParticleView> {
        let mut fastest: Option<(f64, ParticleView)> = None;
        self.visit(body, &mut |particle| {
            let along = |i: usize| particle.velocity[i] - against[i];
            let square = (0..3).map(|i| along(i) * along(i)).sum();
            if square > fastest.map_or(-1.0, |(most, _)| most) {
                fastest = Some((square, *particle));
            }
        });
        fastest.map(|(_, particle)| particle)
    }
    /// What each particle of a body has: the columns of [`crate::column::EVERY`], and what the body's law remembers.
    /// None where nobody knows.
    fn columns(&self, _body: usize) -> Vec<ColumnDescription> {
        Vec::new()
    }
    /// The column of this name of a body's particles, where it lies; nothing is copied.
    ///
    /// # Errors
    /// The body's particles have no such column; the error names those that they have.
    fn column(&self, body: usize, name: &str) -> Result<ColumnRef<'_>, NoColumn> {
        Err(NoColumn::among(&self.columns(body), name))
    }
    /// Shows a column of a body's particles to `look`, the number and the components in space of one after the other,
    /// in no order that means anything; where ranks share them, only some of them are in one place at a time.
    ///
    /// # Errors
    /// As [`View::column`].
    fn visit_column(
        &self,
        body: usize,
        name: &str,
        look: &mut dyn FnMut(u32, &[f64]),
    ) -> Result<(), NoColumn> {
        let column = self.column(body, name)?;
        let (components, values) = (column.description.kind.components(), column.values());
        let rows = column.numbers().iter().zip(values.chunks_exact(components));
        rows.for_each(|(&number, row)| look(number, row));
        Ok(())
    }
    /// Where a column of a body's particles lies in memory; `number` is one. None if the particles have no such column,
    /// and of a rigid body without bounds, which gets other particles as bodies come near.
    fn column_place(&self, _body: usize, _name: &str) -> Option<ColumnPlace> {
        None
    }
    /// The particles of a body with some numbers, which ascend: those that are there, ordered by number.
    fn trace(&self, _body: usize, _numbers: &[u32]) -> Vec<TracedParticle> {
        Vec::new()
    }
    /// The same of several bodies, each with its numbers.
    fn trace_each(&self, wanted: &[(usize, Vec<u32>)]) -> Vec<Vec<TracedParticle>> {
        wanted.iter().map(|(body, numbers)| self.trace(*body, numbers)).collect()
    }
    /// The nodes of the last step's grid that carry mass.
    fn grid_snapshot(&self) -> GridSnapshot;
    /// Wall time spent so far in each verb of the step [s].
    fn timings(&self) -> Vec<(&'static str, f64)>;
    /// What each of the ranks that share the simulation has of it and did for it; nothing where nobody shares it.
    fn shares(&self) -> Vec<RankShare> {
        Vec::new()
    }
    /// Has the program of each rank do something with what that rank has, all at once, see
    /// [`crate::shared::Program`]: what each says, by rank. None where nobody shares the simulation.
    fn ask_ranks(&self, _asked: &dyn Fn() -> Vec<u8>) -> Option<Vec<Vec<u8>>> {
        None
    }
}

/// A simulation that can be stepped.
pub trait Simulation: View + Send {
    /// Takes one step, at most `longest` long, and returns its length [s].
    ///
    /// # Errors
    /// The step's failure, with the simulation left as it was when it went wrong, so that it can still be looked at.
    fn step(&mut self, longest: f64) -> Result<f64, StepError>;
    /// The same, faster where nobody looks: particles may stay behind. Who looks at particles, or at what they add up
    /// to, asks for [`Simulation::show`] before. The next step is the same.
    ///
    /// # Errors
    /// As for [`Simulation::step`].
    fn step_unseen(&mut self, longest: f64) -> Result<f64, StepError> {
        self.step(longest)
    }
    /// Lets particles that stayed behind catch up.
    fn show(&mut self) {}
    /// Drops all that can be made anew from the state between two steps: grid, lists, room to work in. The next step
    /// makes it anew, with the same bits as without.
    fn rebuild_workspace(&mut self) {}
    /// Keeps a copy of the state, to [`Simulation::take_back`] the steps after it.
    fn hold(&mut self) {}
    /// Goes back to the state that was held last; a simulation that holds none gives false, and stays as it is.
    fn take_back(&mut self) -> bool {
        false
    }
    /// Moves the columns of all particles to where they lay at first: steps that sort particles move them. What they
    /// hold, and in which order, stays.
    fn settle(&mut self) {}
    /// Gives the particles of a body other values in a column: the entries that the motion leaves free of one particle
    /// after the other, in the order of memory. [`WRITABLE`] names the columns. A free rigid body takes one value, that
    /// of the whole: the `velocity` of its centre of mass [m/s], or its `spin` [rad/s]; what joints do not allow of it,
    /// the next step takes away. The next step is as long as is stable with them. The ledger counts the energy that
    /// comes in with them as external work, and [`View::written`] has it.
    ///
    /// # Errors
    /// There is no such column, or it is not writable; the body is rigid and moves as the scene prescribes; too many
    /// values or too few; one that is not finite, and a mass that is not above zero. Then nothing is changed.
    fn write(&mut self, body: usize, name: &str, _values: &[f64]) -> Result<(), WriteError> {
        Err(NoColumn::among(&self.columns(body), name).into())
    }
    /// The state as data, to be taken up by another simulation of the same scene; `None` of one that has none, or that
    /// ranks share.
    fn save(&self) -> Option<SavedState> {
        None
    }
    /// The state [without particles](SavedState::without_particles); `None` of a simulation that has none.
    fn save_rest(&self) -> Option<SavedState> {
        None
    }
    /// The particles in [`Simulation::save`], body by body, at most so many at a time.
    fn save_shares(&self, _most: usize, _take: &mut dyn FnMut(Vec<SavedShare>)) {}
    /// The columns of a body in [`Simulation::save`], one after the other, so that no more than one is copied at a
    /// time, and the numbers of its particles in the order of memory. False of a simulation that has no state as data.
    fn save_columns(&self, _body: usize, _take: &mut dyn FnMut(&[u32], SavedColumn)) -> bool {
        false
    }
    /// The bytes of what the particles of bodies have, one body after the other: of each column its name, and each of
    /// its entries for one particle after the other, ordered by number. Where ranks share them, only some are in one
    /// place at a time. False of a simulation that has no state as data.
    fn visit_bytes(&self, mut bodies: Range<usize>, look: &mut dyn FnMut(usize, &[u8])) -> bool {
        bodies.all(|body| {
            let mut order: Option<Vec<u32>> = None;
            self.save_columns(body, &mut |numbers, column| {
                let order = order.get_or_insert_with(|| by_number(numbers));
                look(body, column.name.as_bytes());
                column.sorted_lines(order).for_each(|line| look(body, &line));
            })
        })
    }
    /// Lets bodies begin as those of the same name were in the state of another run, before the first step. The others
    /// begin as they are.
    ///
    /// # Errors
    /// A body of the same name is another one there; then nothing is changed.
    fn begin_from(&mut self, _state: &SavedState, _velocities: StartVelocities) -> Result<(), RestoreError> {
        Err(RestoreError("this simulation takes up none".to_string()))
    }
    /// The same of ranks that share the simulation: the state without particles, which the program of each rank finds
    /// by what it is asked, see [`crate::shared::Program`], and what becomes of velocities. `look` gets the bytes of
    /// the particles there as [`Simulation::visit_bytes`] shows them. None where nobody shares it.
    ///
    /// # Errors
    /// A body of the same name is another one there, or a rank does not find its share; then the simulation has lost
    /// particles.
    fn begin_on_ranks(
        &mut self,
        _rest: (&SavedState, StartVelocities),
        _asked: &[u8],
        _look: &mut dyn FnMut(usize, &[u8]),
    ) -> Option<Result<(), NotTakenUp>> {
        None
    }
    /// Takes up a state, and goes on from there.
    ///
    /// # Errors
    /// It is the state of another scene; then nothing is changed.
    fn restore(&mut self, _state: SavedState) -> Result<(), RestoreError> {
        Err(RestoreError("this simulation takes up none".to_string()))
    }
    /// The same of ranks that share the simulation: the state without particles, which the program of each rank finds
    /// by what it is asked, see [`crate::shared::Program`]. None where nobody shares it.
    ///
    /// # Errors
    /// It is the state of another scene, or a rank does not find its share; then the simulation has no particles.
    fn restore_on_ranks(&mut self, _rest: &SavedState, _asked: &[u8]) -> Option<Result<(), NotTakenUp>> {
        None
    }
}

/// One body at one time.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct BodyState {
    /// Mass; zero for a rigid body without bounds [kg].
    pub mass: f64,
    /// Centre of mass; of a rigid body without bounds the point about which it turns [m].
    pub position: [f64; 3],
    /// Velocity of the centre of mass [m/s].
    pub velocity: [f64; 3],
    /// Angular velocity: the inverse of the inertia tensor times the angular momentum,
    /// both about the centre of mass [rad/s].
    pub spin: [f64; 3],
    /// Angular momentum about the origin; zero for a rigid body without bounds [kg m^2/s].
    pub angular_momentum: [f64; 3],
    /// Kinetic energy [J].
    pub kinetic: f64,
    /// Strain energy [J].
    pub strain: f64,
}

/// Energy and momentum of everything. Dissipated and supplied energies are summed from the start.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// Kinetic energy of the particles [J].
    pub kinetic: f64,
    /// Strain energy [J].
    pub strain: f64,
    /// Potential energy in gravity, zero at the origin; zero where gravity varies in time, whose work is external [J].
    pub potential: f64,
    /// Work done on the bodies by prescribed motion, loads and supports, and what was written to particles between
    /// steps, less the energy that went with particles which left the domain [J].
    pub external_work: f64,
    /// Dissipated by friction, cohesion and viscosity of contacts [J].
    pub friction: f64,
    /// Taken by bonds of contacts that adhere, where they give way [J].
    pub adhesion: f64,
    /// Dissipated by the materials: by plastic flow, viscosity and damage [J].
    pub plastic: f64,
    /// Dissipated by damping, and by impacts of rigid bodies [J].
    pub damping: f64,
    /// The part of it that impacts took, of free rigid bodies on each other and on prescribed ones [J].
    pub impacts: f64,
    /// kinetic + strain + potential + friction + adhesion + plastic + damping - external work [J];
    /// constant in an exact solution.
    pub total: f64,
    /// By how much, either way, kinetic and strain energy of bodies on grids of their own do not add up, for they are
    /// half a step apart [J].
    pub half_step: f64,
    /// Linear momentum [kg m/s].
    pub momentum: [f64; 3],
    /// Angular momentum about the origin [kg m^2/s].
    pub angular_momentum: [f64; 3],
    /// Impulses of contact at nodes that were reduced to the rule's `max_strain`, since the start.
    pub scaled_impulses: u64,
    /// Nodes of three bodies and more where contact was still changing velocities when it was cut short,
    /// since the start.
    pub unsettled_nodes: u64,
    /// Mass of particles that left the domain and were taken out, since the start [kg].
    pub removed_mass: f64,
    /// Their kinetic, strain and potential energy when they were taken out [J].
    pub removed_energy: f64,
    /// Their momentum then [kg m/s].
    pub removed_momentum: [f64; 3],
    /// Their angular momentum then, about the origin [kg m^2/s].
    pub removed_angular_momentum: [f64; 3],
}

/// What left the domain with the particles of a body that were taken out since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RemovedParticles {
    /// How many.
    pub count: u64,
    /// When the first was taken out [s].
    pub time: f64,
    /// Where that was [m].
    pub place: [f64; 3],
    /// Their mass [kg].
    pub mass: f64,
    /// Their kinetic, strain and potential energy then [J].
    pub energy: f64,
    /// What their material had dissipated [J].
    pub plastic: f64,
    /// Their momentum [kg m/s].
    pub momentum: [f64; 3],
    /// Their angular momentum about the origin [kg m^2/s].
    pub angular_momentum: [f64; 3],
}

/// What a body has more since the start by [`Simulation::write`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WrittenValues {
    /// How often values were written.
    pub count: u64,
    /// Kinetic, strain and potential energy, and what its material has dissipated [J]: the latter and the strain energy
    /// are those of its mass.
    pub energy: f64,
    /// Momentum [kg m/s].
    pub momentum: [f64; 3],
    /// Angular momentum about the origin [kg m^2/s].
    pub angular_momentum: [f64; 3],
}

/// What a body did to a face of the domain since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WallState {
    /// Axis across the face.
    pub axis: usize,
    /// Whether it is the upper one.
    pub upper: bool,
    /// Index of the body.
    pub body: usize,
    /// Impulse on the face [N s].
    pub impulse: [f64; 3],
    /// Its moment about the middle of the face [N m s].
    pub moment: [f64; 3],
}

/// What a load or a support did. Impulse and work are sums since the start: differences are what it did in between.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LoadState {
    /// Impulse on the body [N s].
    pub impulse: [f64; 3],
    /// Impulse of moments about the middle of its part, where that is in each step [N m s].
    pub moment: [f64; 3],
    /// Work on the body [J].
    pub work: f64,
    /// How far its part is from where it was at the start, the mean over the part [m].
    pub displacement: [f64; 3],
}

/// What a joint did on the body that it holds. Impulses and work are sums since the start: differences are what it did
/// in between.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JointState {
    /// Impulse [N s].
    pub impulse: [f64; 3],
    /// Impulse of moments about the joint's point, of sliders and welds about the body's centre [N m s].
    pub moment: [f64; 3],
    /// Angle of a hinge or a planar joint [rad], way of a slider, change of a spring's length since the start [m].
    pub way: f64,
    /// Its rate [rad/s, m/s].
    pub speed: f64,
    /// Work on free bodies [J].
    pub work: f64,
}

/// How far dynamic relaxation has come.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RelaxationState {
    /// Sum of the unbalanced forces at the nodes over that of the internal or of the external ones, whichever is
    /// larger; 1 before the first step [-].
    pub residual: f64,
    /// How often the kinetic energy passed a peak, and the bodies were stopped.
    pub peaks: u64,
    /// Whether the residual is as small as the scene asks, and the kinetic energy at most the square of that part of
    /// the strain energy, while no rigid body moves.
    pub at_rest: bool,
}

/// What contact did to two bodies since the start. Sums over time and nodes: differences are what it did in between.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactSum {
    /// Indices of the bodies, the smaller first.
    pub bodies: [usize; 2],
    /// Impulse of the first on the second [N s].
    pub impulse: [f64; 3],
    /// Impulses along each node's normal, positive when the bodies push each other apart [N s].
    pub normal: f64,
    /// Impulse across the nodes' normals [N s].
    pub tangential: [f64; 3],
    /// Magnitudes of the nodes' impulses [N s].
    pub magnitude: f64,
    /// The same times their places [N s m].
    pub moment: [f64; 3],
    /// Moment about the origin of the impulse of the first on the second [N m s].
    pub turn: [f64; 3],
    /// Area times duration [m^2 s], in the plane length per depth.
    pub area: f64,
    /// Distance between the surfaces times area and duration, negative where they overlap [m^3 s].
    pub gap: f64,
    /// How far the surfaces slipped on each other, the mean over their area [m].
    pub slip: f64,
    /// Work of friction [J].
    pub friction: f64,
    /// Grid nodes in contact in the last step in which the pair touched.
    pub nodes: usize,
    /// Impulses at nodes since the start, and how many of these were reduced to the rule's `max_strain`.
    pub pushes: u64,
    /// See `pushes`.
    pub reduced: u64,
}

/// A reader's place in time among the contacts. Each reader has its own, and none disturbs another.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct ContactCursor {
    since: f64,
    /// Sums at that time, by pair.
    before: HashMap<[usize; 2], ContactSum>,
}

impl ContactCursor {
    /// Contacts between the last reading, or the start, and now, ordered by pair; none if no time has passed.
    pub fn read(&mut self, view: &dyn View) -> Vec<ContactState> {
        let (time, mut found) = (view.time(), Vec::new());
        let elapsed = time - self.since;
        if elapsed <= 0.0 {
            return found;
        }
        for now in view.contact_sums() {
            let before = self.before.insert(now.bodies, now).unwrap_or_default();
            found.extend(now.mean(&before, elapsed));
        }
        self.since = time;
        found
    }
}

impl ContactSum {
    /// The mean over the time since other sums of the pair; none if the bodies did not push each other.
    fn mean(&self, before: &ContactSum, elapsed: f64) -> Option<ContactState> {
        let since = |of: fn(&ContactSum) -> [f64; 3]| {
            let [now, before] = [of(self), of(before)];
            [0, 1, 2].map(|i| now[i] - before[i])
        };
        let magnitude = self.magnitude - before.magnitude;
        let [area, gap] = [self.area - before.area, self.gap - before.gap];
        // The impulse on the second without what is across the normals, which is counted on the first.
        let push = [0, 1, 2].map(|i| since(|sum| sum.impulse)[i] + since(|sum| sum.tangential)[i]);
        let pushed = push.iter().map(|j| j * j).sum::<f64>().sqrt().copysign(self.normal - before.normal);
        (magnitude > 0.0).then(|| ContactState {
            body_a: self.bodies[0],
            body_b: self.bodies[1],
            direction: push.map(|j| j / pushed),
            mean: ContactMean {
                force: since(|sum| sum.impulse).map(|j| j / elapsed),
                normal: (self.normal - before.normal) / elapsed,
                tangential: since(|sum| sum.tangential).iter().map(|j| j * j).sum::<f64>().sqrt() / elapsed,
                nodes: self.nodes,
                position: since(|sum| sum.moment).map(|x| x / magnitude),
                area: area / elapsed,
                gap: if area > 0.0 { gap / area } else { 0.0 },
                slip: self.slip - before.slip,
                friction: self.friction - before.friction,
            },
        })
    }
}

/// Contact between two bodies, see [`ContactCursor`].
#[derive(Clone, Debug, PartialEq)]
pub struct ContactState {
    /// Index of the first body; smaller than `body_b`.
    pub body_a: usize,
    /// Index of the second body.
    pub body_b: usize,
    /// Direction of the normal, from the first body to the second: that of the sum of all forces along nodes' normals,
    /// turned round where the bodies hold each other more than they push. Not a number where these forces cancel [-].
    pub direction: [f64; 3],
    /// How they pressed on each other.
    pub mean: ContactMean,
}

/// Contact of two bodies, averaged over the time between two readings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactMean {
    /// Mean force of the first on the second [N].
    pub force: [f64; 3],
    /// Mean of the sum over nodes of the force along each node's normal,
    /// positive when the bodies push each other apart [N].
    pub normal: f64,
    /// Magnitude of the mean of the sum over nodes of the force across each node's normal: forces that oppose each
    /// other, at two nodes or at two times, cancel [N].
    pub tangential: f64,
    /// Grid nodes that passed a force in the last step in which the surfaces touched.
    pub nodes: usize,
    /// Centre of the forces over nodes and time, each by its magnitude [m].
    pub position: [f64; 3],
    /// Area over which the bodies touched, its mean over the time as the force's [m^2],
    /// in the plane length per depth [m].
    pub area: f64,
    /// Mean distance between the surfaces over area and time, negative where they overlap [m].
    pub gap: f64,
    /// How far the surfaces slipped on each other, the mean over their area [m].
    pub slip: f64,
    /// Work of friction, cohesion and viscosity [J].
    pub friction: f64,
}

/// The widest contact of two bodies so far.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactPatch {
    /// Index of the first body; smaller than `body_b`.
    pub body_a: usize,
    /// Index of the second body.
    pub body_b: usize,
    /// Largest area over which they touched in a step, images in mirrors included [m^2],
    /// in the plane length per depth [m].
    pub area: f64,
    /// Half of its shorter side: of a circle the radius, of an ellipse the shorter half-axis, of a strip 1.1 of its
    /// half-width, of a ring the radius of a circle with its area; in the plane half of its length [m].
    pub half_width: f64,
    /// Impulses between the two since the start, the sum of their magnitudes over nodes and steps [N s].
    pub impulse: f64,
}

/// What acts on a body at a point of its surface that touches:
///
/// ```text
/// t = -p n + tau          traction per undeformed area
/// f = sum_s A_s t_s       force of a partner, with the opposite of what acts at the partner's points
/// ```
///
/// Where both bodies have points, each stands for half of its area, as the others carry the other half: the pressure is
/// that between the bodies, on either side.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactPoint {
    /// Index of the body.
    pub body: usize,
    /// What it touches.
    pub partner: Touched,
    /// Where it is as the forces of the step act [m].
    pub position: [f64; 3],
    /// Where it was undeformed [m].
    pub undeformed: [f64; 3],
    /// Unit normal n, out of the body: against that of the partner's surface there [-].
    pub normal: [f64; 3],
    /// Undeformed area A for which it stands [m^2], in the plane length per depth [m].
    pub area: f64,
    /// Pressure p, force over undeformed area; negative where adhesion pulls [Pa].
    pub pressure: f64,
    /// Shear traction tau on the body [Pa].
    pub shear: [f64; 3],
}

/// What a point of a surface touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Touched {
    /// The body with this index.
    Body(usize),
    /// A face of the domain.
    Face {
        /// Axis across it.
        axis: usize,
        /// Whether it is the upper one.
        upper: bool,
    },
}

/// A particle now, as [`Simulation::visit`] shows it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParticleView {
    /// Number of the particle in its body, from the filling; it never changes.
    pub number: u32,
    /// Mass [kg].
    pub mass: f64,
    /// Volume now [m^3].
    pub volume: f64,
    /// Position [m].
    pub position: [f64; 3],
    /// Velocity [m/s].
    pub velocity: [f64; 3],
    /// Cauchy stress xx, yy, zz, xy, yz, xz, tension positive [Pa].
    pub stress: [f64; 6],
}

/// What makes a stable step as short as it is: the particle whose wave and own speed are the fastest together, or the
/// free rigid body that turns fastest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepLimit {
    /// Index of the body.
    pub body: usize,
    /// Number of the particle in its body, if it is one.
    pub particle: Option<u32>,
    /// Where it is [m].
    pub position: [f64; 3],
}

/// A particle now, as [`Simulation::trace`] gives it, with what it did since the start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TracedParticle {
    /// Number of the particle in its body, from the filling; it never changes.
    pub number: u32,
    /// Half the side of its undeformed box [m].
    pub half_width: f64,
    /// Half the side of the box as which the nodes see it [m].
    pub half_side: f64,
    /// Position [m].
    pub position: [f64; 3],
    /// Velocity [m/s].
    pub velocity: [f64; 3],
    /// Deformation gradient, row by row [-].
    pub deformation: [[f64; 3]; 3],
}

/// Grid nodes with mass as columns of equal length, ordered by body and place; a node that two bodies share stands
/// there twice.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GridSnapshot {
    /// 2 or 3.
    pub dimension: usize,
    /// Side of a cell [m].
    pub cell: f64,
    /// Index of the body.
    pub body: Vec<u32>,
    /// Position of the node [m].
    pub position: Vec<[f64; 3]>,
    /// The body's mass at the node [kg].
    pub mass: Vec<f64>,
    /// The body's velocity at the end of the step [m/s].
    pub velocity: Vec<[f64; 3]>,
    /// Force on the body from its own stress [N].
    pub force: Vec<[f64; 3]>,
    /// Change of the body's momentum by contact in the step [N s].
    pub contact_impulse: Vec<[f64; 3]>,
}

impl GridSnapshot {
    /// Several snapshots of other nodes each as one.
    pub fn merged(parts: Vec<Self>) -> Self {
        let mut parts = parts.into_iter();
        let Some(mut all) = parts.next() else { return GridSnapshot::default() };
        for part in parts {
            all.body.extend(part.body);
            all.position.extend(part.position);
            all.mass.extend(part.mass);
            all.velocity.extend(part.velocity);
            all.force.extend(part.force);
            all.contact_impulse.extend(part.contact_impulse);
        }
        let GridSnapshot { body, position, .. } = &all;
        let place = |a: [f64; 3], b: [f64; 3]| a.partial_cmp(&b).unwrap_or(Ordering::Equal);
        let mut rows: Vec<usize> = (0..body.len()).collect();
        rows.sort_by(|&a, &b| body[a].cmp(&body[b]).then_with(|| place(position[a], position[b])));
        all.of_rows(&rows)
    }

    /// The nodes in some rows that follow one another.
    pub fn rows(&self, rows: Range<usize>) -> Self {
        self.of_rows(&rows.collect::<Vec<_>>())
    }

    fn of_rows(&self, rows: &[usize]) -> Self {
        GridSnapshot {
            body: rows.iter().map(|&row| self.body[row]).collect(),
            position: rows.iter().map(|&row| self.position[row]).collect(),
            mass: rows.iter().map(|&row| self.mass[row]).collect(),
            velocity: rows.iter().map(|&row| self.velocity[row]).collect(),
            force: rows.iter().map(|&row| self.force[row]).collect(),
            contact_impulse: rows.iter().map(|&row| self.contact_impulse[row]).collect(),
            ..*self
        }
    }

    /// Whether all columns have one length.
    pub fn is_even(&self) -> bool {
        let GridSnapshot { body, position, mass, velocity, force, contact_impulse, .. } = self;
        let lengths = [position.len(), mass.len(), velocity.len(), force.len(), contact_impulse.len()];
        lengths.iter().all(|&length| length == body.len())
    }
}

/// A step that went wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StepError {
    /// A particle turned inside out.
    #[error(
        "particle {number} of body `{body}` inverted at {} m, t = {time:.6e} s (determinant of F: {determinant:.3e})",
        place(position)
    )]
    Inverted {
        /// Name of the body.
        body: String,
        /// Number of the particle in its body.
        number: u32,
        /// Where it is [m].
        position: [f64; 3],
        /// When [s].
        time: f64,
        /// Determinant of its deformation gradient.
        determinant: f64,
    },
    /// A particle left the domain.
    #[error(
        "particle {number} of body `{body}` left {} at {} m, t = {time:.6e} s",
        if *bounded { "the domain" } else { "all that the grid can number" },
        place(position)
    )]
    Escaped {
        /// Whether the scene has a domain.
        bounded: bool,
        /// Name of the body.
        body: String,
        /// Number of the particle in its body.
        number: u32,
        /// Where it is [m].
        position: [f64; 3],
        /// When [s].
        time: f64,
    },
    /// Plane stress found no thickness of a particle without stress out of the plane.
    #[error(
        "particle {number} of body `{body}` finds no thickness without stress out of the plane at {} m, t = {time:.6e} s",
        place(position)
    )]
    NoThickness {
        /// Name of the body.
        body: String,
        /// Number of the particle in its body.
        number: u32,
        /// Where it is [m].
        position: [f64; 3],
        /// When [s].
        time: f64,
    },
    /// A body on a grid of its own is so deep in another that they may pass through each other.
    #[error(
        "the surface of body `{body}` is {depth:.1} cells deep in {partner} at {} m, t = {time:.6e} s",
        place(position)
    )]
    Pierced {
        /// Name of the body.
        body: String,
        /// The other one.
        partner: String,
        /// How deep [cells].
        depth: f64,
        /// Where [m].
        position: [f64; 3],
        /// When [s].
        time: f64,
    },
    /// A value of the state, or of what it adds up to, is not a finite number.
    #[error(
        "{what} is not a finite number{}, t = {time:.6e} s",
        position.as_ref().map(|position| format!(" at {} m", place(position))).unwrap_or_default()
    )]
    NoNumber {
        /// What it is, and of what.
        what: String,
        /// Where the particle or the body is, if that is known [m].
        position: Option<[f64; 3]>,
        /// When [s].
        time: f64,
    },
    /// Heat leaves a particle no size: 1 + alpha T is not above zero.
    #[error(
        "particle {number} of body `{body}` shrinks to nothing by its change of temperature at {} m, t = {time:.6e} s",
        place(position)
    )]
    Shrunk {
        /// Name of the body.
        body: String,
        /// Number of the particle in its body.
        number: u32,
        /// Where it is [m].
        position: [f64; 3],
        /// When [s].
        time: f64,
    },
    /// A function from outside has no answer.
    #[error("{what} failed near t = {time:.6e} s: {reason}")]
    Outside {
        /// What it is, and of what.
        what: String,
        /// When [s].
        time: f64,
        /// Why.
        reason: OutsideFault,
    },
    /// A particle's position, velocity or stress is not a finite number.
    #[error(
        "particle {number} of body `{body}` has a value that is not finite near {} m, t = {time:.6e} s",
        place(position)
    )]
    NotFinite {
        /// Name of the body.
        body: String,
        /// Number of the particle in its body.
        number: u32,
        /// Where it was last [m].
        position: [f64; 3],
        /// When [s].
        time: f64,
    },
}

/// `(0.1503, -2, 0)`: five digits are enough to find a particle in a picture.
fn place(position: &[f64; 3]) -> String {
    let short = |x: f64| format!("{x:.4e}").parse().unwrap_or(x).to_string();
    format!("({})", position.map(short).join(", "))
}

impl StepError {
    /// What the user can try.
    pub fn advice(&self) -> &'static str {
        match self {
            StepError::Inverted { .. } => {
                "try a smaller time.courant, more cells, the gimp basis, or a stiffer material; look at the last frame"
            }
            StepError::Escaped { bounded: false, .. } => {
                "it is millions of cells from the origin: look at the last frame for what threw it there, end the run \
                 earlier, or give the scene a domain"
            }
            StepError::Escaped { bounded: true, .. } => {
                "make the domain larger, end the run earlier, put a face in the way, or let particles of deformable \
                 bodies go: space.domain.leaving = \"remove\""
            }
            StepError::NoThickness { .. } => {
                "it strained far in one step: try a smaller time.courant; look at the last frame for what went wrong first"
            }
            StepError::Shrunk { .. } => {
                "1 + thermal_expansion times temperature must stay above zero: see which unit each of them has; a \
                 load's `temperature` is the change since the start"
            }
            StepError::Pierced { .. } => {
                "bodies that meet faster than their waves are not stopped by the layer between them, and would pass \
                 through each other: try slower motion or a stiffer material"
            }
            StepError::Outside { .. } => "mend the function, and go on from the last checkpoint",
            StepError::NotFinite { .. } | StepError::NoNumber { .. } => {
                "try a smaller time.courant, or mend the formula of a prescribed motion; look at the last frame for what went wrong first"
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_particle_that_left_is_named_with_its_place() {
        let position = [0.1503039572985548, -2.0, 1.23456e-7];
        let error =
            StepError::Escaped { bounded: true, body: "disk".into(), number: 7, position, time: 0.25 };
        let expected =
            "particle 7 of body `disk` left the domain at (0.1503, -2, 0.00000012346) m, t = 2.500000e-1 s";
        assert_eq!(error.to_string(), expected);
    }
}
