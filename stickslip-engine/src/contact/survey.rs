//! Where bodies meet, and what the particles there say of their surfaces.

use super::law::{NearParticle, law};
use super::{Growth, Pair, Rules, SurfaceEstimate, TimeStep};
use crate::Kernels;
use crate::body::Body;
use crate::boundary::Boundary;
use crate::check::Interference;
use crate::grid::{
    ActiveBlocks, Field, Lattice, Node, Nodes, SIDE, SharedBlock, next_of, node_at, nodes_per_block,
};
use crate::lanes::{Laned, Processor};
use crate::scene::{ContactLaw, Face};
use crate::surroundings::{Chunk, MaterialSums, SeenBody, Surroundings, Wanted, behind};
use crate::tensor::{Real, Symmetric, Vector};
use crate::threads::each;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// A node that two or more bodies share, below also a *site*. A *side* is one body there, an *encounter* two of them.
#[derive(Clone, Debug)]
pub struct SharedNode<const D: usize> {
    /// The node.
    pub node: [i32; D],
    /// Its bodies, in [`SurveyPart::sides`].
    pub sides: Range<usize>,
    /// Its pairs, in [`SurveyPart::encounters`].
    pub encounters: Range<usize>,
}

/// One body's share of a site: a side.
#[derive(Clone, Copy, Debug)]
pub struct BodyShare<T, const D: usize> {
    /// Index of the body.
    pub body: usize,
    /// Its node in the field.
    pub index: usize,
    /// Its surface there.
    pub surface: SurfaceEstimate<T, D>,
    /// Gradient of its volume, into the body [m^2].
    pub volume_gradient: Vector<T, D>,
}

/// How two bodies face each other at a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facing<T, const D: usize> {
    /// Common normal from the first to the second [-].
    pub normal: Option<Vector<T, D>>,
    /// Distance between their surfaces, negative where they overlap [cells].
    pub gap: T,
}

/// What a law may look at to tell how two bodies face each other.
pub struct LawInputs<'a, T: 'static, const D: usize> {
    /// Everything near.
    pub near: &'a Near<'a, T, D>,
    /// All bodies at the node.
    pub sides: &'a [BodyShare<T, D>],
    /// The two among them.
    pub pair: [usize; 2],
    /// The node.
    pub node: [i32; D],
    /// Surfaces further apart cannot touch in this step [cells].
    pub reach: T,
}

/// Two sides of a site.
#[derive(Clone, Copy, Debug)]
pub struct Encounter<T, const D: usize> {
    /// The two sides, in [`SurveyPart::sides`].
    pub sides: [usize; 2],
    /// Number of the pair's rule.
    pub rule: usize,
    pub(super) facing: Facing<T, D>,
    /// The node's share of the contact area [m^2], in the plane per depth [m].
    pub(super) area: T,
    /// The part of an overlap that the step takes away, of an interference fit.
    pub(super) recovery: T,
}

/// Sites of some blocks.
#[derive(Clone, Debug)]
pub struct SurveyPart<T, const D: usize> {
    /// Nodes that two or more bodies share.
    pub sites: Vec<SharedNode<D>>,
    /// Bodies at the sites.
    pub sides: Vec<BodyShare<T, D>>,
    /// Pairs at the sites.
    pub encounters: Vec<Encounter<T, D>>,
}

impl<T: Copy, const D: usize> Encounter<T, D> {
    /// Common normal from the first to the second, if there is one [-].
    pub fn normal(&self) -> Option<Vector<T, D>> {
        self.facing.normal
    }
}

impl<T, const D: usize> Default for SurveyPart<T, D> {
    fn default() -> Self {
        SurveyPart { sites: Vec::new(), sides: Vec::new(), encounters: Vec::new() }
    }
}

/// All sites of a step, and room to find them in, kept from step to step.
#[derive(Debug)]
pub struct Survey<T, const D: usize> {
    parts: Vec<SurveyPart<T, D>>,
    /// How many parts this step has.
    count: usize,
    /// One for each thread.
    scratches: Vec<Mutex<Scratch<T, D>>>,
}

impl<T, const D: usize> Default for Survey<T, D> {
    fn default() -> Self {
        Survey { parts: Vec::new(), count: 0, scratches: Vec::new() }
    }
}

impl<T, const D: usize> Survey<T, D> {
    /// A survey that found these sites.
    #[cfg(test)]
    pub fn of(parts: Vec<SurveyPart<T, D>>) -> Self {
        Survey { count: parts.len(), parts, scratches: Vec::new() }
    }

    /// The sites, part by part.
    pub fn parts(&self) -> &[SurveyPart<T, D>] {
        &self.parts[..self.count]
    }
}

/// What a thread writes down while it surveys a block.
#[derive(Debug)]
struct Scratch<T, const D: usize> {
    /// Nodes that each body of the block reaches and shares.
    present: Vec<Nodes>,
    /// Places of two bodies among those of the block, and the number of their rule.
    pairs: Vec<[usize; 3]>,
    /// Of each body, one node after the other.
    sums: Vec<MaterialSums<T, D>>,
    /// Particles that are about to be added to them.
    chunks: Vec<Chunk<D>>,
    /// Where the next sums of each body stand.
    next: Vec<usize>,
    /// P-wave modulus of each body [Pa].
    moduli: Vec<T>,
    /// Where each body stands among the sides of a node.
    places_here: Vec<Option<usize>>,
    /// Particles near a node, of laws that look at single ones.
    points: Vec<NearParticle<T, D>>,
}

impl<T, const D: usize> Default for Scratch<T, D> {
    fn default() -> Self {
        Scratch {
            present: Vec::new(),
            pairs: Vec::new(),
            sums: Vec::new(),
            chunks: Vec::new(),
            next: Vec::new(),
            moduli: Vec::new(),
            places_here: Vec::new(),
            points: Vec::new(),
        }
    }
}

/// Blocks of a part.
const BLOCKS: usize = 8;

/// Mass below this fraction of a full cell's does not make a node shared: that of a particle which reaches into the
/// node's surroundings by round-off of a cell. More would leave parts of a glued body that stick out by less to
/// themselves.
fn trace<T: Real>() -> T {
    T::EPSILON * T::EPSILON
}

/// The same for a rigid body, which acts in full wherever it is: a larger one, so that round-off of its position does
/// not decide where. It is that of a particle that reaches into the node's surroundings by this fraction of a cell.
fn rigid_trace<T: Real>() -> T {
    T::EPSILON.sqrt()
}

/// What a survey looks at.
pub struct Near<'a, T: 'static, const D: usize> {
    /// The blocks.
    pub active: &'a ActiveBlocks<D>,
    /// The bodies.
    pub bodies: &'a [Body<T, D>],
    /// The field, scattered.
    pub field: &'a Field<T, D>,
    /// Where the nodes are.
    pub lattice: Lattice<T, D>,
    /// The walls.
    pub boundary: &'a Boundary,
    /// Which law holds for which pair.
    pub rules: &'a Rules<T>,
    /// Step [s], if the nodes have the forces of the stress already.
    pub ahead: Option<T>,
    /// Time at which the step begins [s].
    pub time: f64,
    /// What knows the shape functions.
    pub kernels: &'static Kernels<T, D>,
    /// Who looks.
    pub processor: Processor,
}

impl<T: Real, const D: usize> Near<'_, T, D> {
    /// h^D [m^3]
    fn cell_volume(&self) -> T {
        (0..D).fold(T::ONE, |v, _| v * self.lattice.cell)
    }
}

impl<T: Laned, const D: usize> Near<'_, T, D> {
    /// How far surfaces of an interference fit have grown when the step ends.
    fn growth(&self, fit: &Interference) -> Growth<T> {
        Growth::of(fit, self.time + self.ahead.map_or(0.0, T::f64), self.lattice.cell.f64())
    }

    /// Surveys every node that two or more bodies share.
    pub fn survey(&self, survey: &mut Survey<T, D>) {
        let Survey { parts, count, scratches } = survey;
        *count = self.active.shared_blocks.len().div_ceil(BLOCKS);
        parts.resize_with(parts.len().max(*count), SurveyPart::default);
        scratches.resize_with(scratches.len().max(rayon::current_num_threads()), Mutex::default);
        let all = &self.active.shared_blocks;
        each(&mut parts[..*count], 1, |number, part| {
            let shared_blocks = &all[number * BLOCKS..all.len().min((number + 1) * BLOCKS)];
            let thread = rayon::current_thread_index().unwrap_or(0);
            let mut scratch = scratches[thread].lock().unwrap_or_else(PoisonError::into_inner);
            part.sites.clear();
            part.sides.clear();
            part.encounters.clear();
            shared_blocks.iter().for_each(|meeting| self.survey_block(meeting, &mut scratch, part));
        });
    }

    /// A body as sums over its particles see it.
    fn seen(&self, number: usize) -> SeenBody<T, D> {
        let body = &self.bodies[number];
        SeenBody {
            number,
            columns: body.particles.view(),
            trusts_deformation: body.trusts_deformation(),
            is_joined: std::array::from_fn(|axis| body.whole.is_joined(axis)),
        }
    }

    fn survey_block(
        &self,
        meeting: &SharedBlock<D>,
        scratch: &mut Scratch<T, D>,
        part: &mut SurveyPart<T, D>,
    ) {
        let Scratch { present, pairs, sums, chunks, next, moduli, places_here, points } = scratch;
        let (n, slots, block) = (nodes_per_block(D), self.active.slots_of(meeting), meeting.block);
        let body = |slot: u32| self.active.slots[slot as usize].0 as usize;
        present.clear();
        present.extend(slots.iter().map(|&slot| self.field.present[slot as usize]));
        let shared = self.pairs(slots, (&mut *present, !self.governed(block)), pairs);
        if shared == 0 {
            return;
        }
        let surroundings = Surroundings {
            active: self.active,
            lattice: self.lattice,
            walls: &self.boundary.walls,
            processor: self.processor,
        };
        sums.clear();
        next.clear();
        moduli.clear();
        moduli.extend(
            slots
                .iter()
                .map(|&slot| &self.bodies[body(slot)])
                .map(|body| body.matter.material.wave_modulus_at_rest(body.matter.thickness)),
        );
        let by_place = |&[_, _, rule]: &[usize; 3]| law::<T, D>(self.rules.rule(rule).law).by_place();
        let places = self.ahead.is_some() && pairs.iter().all(by_place);
        let sought = if places { Wanted::Places } else { Wanted::Everything };
        for (&slot, present) in slots.iter().zip(present.iter_mut()) {
            *present &= shared;
            let first = sums.len();
            next.push(first);
            sums.resize(first + present.count_ones() as usize, MaterialSums::EMPTY);
            (self.kernels.sum_around)(
                &surroundings,
                (&self.seen(body(slot)), block),
                (*present, sought),
                (&mut sums[first..], chunks),
            );
        }
        let mut nodes = shared;
        while let Some(local) = next_of(&mut nodes) {
            let node = node_at(block, local);
            let first = part.sides.len();
            places_here.clear();
            for (i, &slot) in slots.iter().enumerate() {
                let here = present[i] >> local & 1 == 1;
                places_here.push(here.then_some(part.sides.len()));
                if here {
                    let modulus = moduli[i];
                    let index = slot as usize * n + local;
                    part.sides.push(self.side((index, node, modulus), &sums[next[i]], sought));
                    next[i] += 1;
                }
            }
            let reach = self.reach(&part.sides[first..]);
            let start = part.encounters.len();
            for &[a, b, rule] in &*pairs {
                if let (Some(a), Some(b)) = (places_here[a], places_here[b]) {
                    let pair = [a - first, b - first];
                    let look = LawInputs { near: self, sides: &part.sides[first..], pair, node, reach };
                    let held = self.rules.rule(rule);
                    let Some(mut facing) = law(held.law).facing(&look, points) else { continue };
                    let area = area(&look, &facing);
                    let growth = held.press.map_or(Growth::default(), |fit| self.growth(&fit));
                    facing.gap += growth.allowed;
                    let recovery = growth.recovery;
                    part.encounters.push(Encounter { sides: [a, b], rule, facing, area, recovery });
                }
            }
            if part.encounters.len() == start {
                part.sides.truncate(first);
                continue;
            }
            part.sites.push(SharedNode {
                node,
                sides: first..part.sides.len(),
                encounters: start..part.encounters.len(),
            });
        }
    }

    /// Nodes of a block where a wall decides what happens.
    fn governed(&self, block: [i32; D]) -> Nodes {
        let walls = self.boundary.walls.iter().map(|wall| match wall.face {
            Face::Fixed => behind(wall, block, 0),
            _ => behind(wall, block, -1),
        });
        walls.fold(0, |nodes, governed| nodes | governed)
    }

    /// Lists the bodies of a block that may touch at free nodes, by their places in `slots`, with the numbers of their
    /// rules; returns the nodes that they share. Nodes that a body reaches by a trace only are struck off `present`.
    fn pairs(
        &self,
        slots: &[u32],
        (present, free): (&mut [Nodes], Nodes),
        pairs: &mut Vec<[usize; 3]>,
    ) -> Nodes {
        pairs.clear();
        let several =
            (present.iter()).fold([0, 0], |[once, twice], nodes| [once | nodes, twice | once & nodes])[1];
        let n = nodes_per_block(D);
        for (&slot, present) in slots.iter().zip(&mut *present) {
            let owner = &self.bodies[self.active.slots[slot as usize].0 as usize];
            let trace = if owner.is_rigid() { rigid_trace::<T>() } else { trace::<T>() };
            let least = trace * self.cell_volume() * owner.matter.density;
            let mut nodes = *present & several & free;
            while let Some(local) = next_of(&mut nodes) {
                if self.field.nodes[slot as usize * n + local].mass <= least {
                    *present &= !(1 << local);
                }
            }
        }
        let body = |place: usize| self.active.slots[slots[place] as usize].0 as usize;
        let mut all = 0;
        for a in 0..slots.len() {
            for b in a + 1..slots.len() {
                let shared = present[a] & present[b] & free;
                let bodies = [body(a), body(b)];
                if shared == 0 || bodies.iter().all(|&body| self.bodies[body].is_rigid()) {
                    continue;
                }
                let rule = self.rules.number(bodies[0], bodies[1]);
                if self.rules.rule(rule).law != ContactLaw::None {
                    pairs.push([a, b, rule]);
                    all |= shared;
                }
            }
        }
        all
    }

    fn side(
        &self,
        (index, node, modulus): (usize, [i32; D], T),
        sums: &MaterialSums<T, D>,
        sought: Wanted,
    ) -> BodyShare<T, D> {
        let body = self.active.slots[index / nodes_per_block(D)].0 as usize;
        let owner = &self.bodies[body];
        let arm = Vector::from_fn(|i| T::of(f64::from(node[i].rem_euclid(SIDE))) * self.lattice.cell);
        let Node { mass, force, .. } = self.field.nodes[index];
        let (normal, stress, force) = match sought {
            Wanted::Places => (None, Symmetric::ZERO, force),
            // A node on a mirror carries its half of the mass, and so of the force.
            Wanted::Everything => {
                ((-sums.mass_gradient()).direction(), sums.stress(), sums.force() * (mass / sums.mass()))
            }
        };
        let place = sums.place(!owner.trusts_deformation()).seen_from(arm);
        // A rigid surface is where it is said to be; its lattice has stairs.
        let exact =
            (owner.is_rigid() && normal.is_some()).then(|| place.offset(Vector::ZERO, &owner.whole).normal);
        let normal = exact.filter(|n| *n != Vector::ZERO).or(normal);
        let surface = SurfaceEstimate {
            inverse_mass: if owner.is_rigid() { T::ZERO } else { T::ONE / mass },
            normal,
            stress,
            volume: sums.volume(),
            modulus,
            force,
            place,
        };
        BodyShare { body, index, surface, volume_gradient: sums.volume_gradient() }
    }

    /// Surfaces further apart at a node cannot touch in this step [cells].
    ///
    /// Twice the largest way that the bodies could go against each other with the velocities and forces that they have,
    /// and a tenth of a cell for what they get in the step from elsewhere; a cell where forces are not known yet:
    /// nothing moves by that in a step.
    fn reach(&self, sides: &[BodyShare<T, D>]) -> T {
        let Some(dt) = self.ahead else { return T::ONE };
        let node = |side: &BodyShare<T, D>| &self.field.nodes[side.index];
        let ahead = |side: &BodyShare<T, D>| side.surface.force * (side.surface.inverse_mass * dt);
        let mut fastest = T::ZERO;
        for (i, a) in sides.iter().enumerate() {
            for b in &sides[..i] {
                let speed = (node(a).velocity - node(b).velocity).norm() + (ahead(a) - ahead(b)).norm();
                fastest = fastest.max(speed);
            }
        }
        let way = fastest * dt * self.lattice.per_cell;
        (way + way + T::of(0.1)).min(T::ONE)
    }
}

/// Normal along the difference of the volume gradients, and the gap from the room that the bodies leave around the node
/// [cells].
///
/// ```text
/// gap / h = 1 - sum_a V_a / h^D,   V_a = sum_p V_p S_i(x_p)
/// ```
/// Where material fills space without a gap, the volumes interpolated to a node are a whole cell; a thin gap through
/// the node takes its width times h^(D-1) from that. Overlap is negative. Needs no normal, and stairs of the particles'
/// lattice average out. All bodies that touch either of the two count.
/// A surface of radius R seems h^2/(6R) further away than its nearest point.
pub fn room<T: Real, const D: usize>(look: &LawInputs<T, D>) -> Facing<T, D> {
    let LawInputs { near, sides, pair, .. } = look;
    let touches = |a: &BodyShare<T, D>, b: &BodyShare<T, D>| {
        near.rules.rule(near.rules.number(a.body, b.body)).law != ContactLaw::None
    };
    let counts = |(i, side): &(usize, &BodyShare<T, D>)| {
        pair.contains(i) || pair.iter().any(|&of_pair| touches(side, &sides[of_pair]))
    };
    let volumes = sides.iter().enumerate().filter(counts).map(|(_, side)| side.surface.volume);
    let [a, b] = pair.map(|side| sides[side].volume_gradient);
    Facing { normal: (b - a).direction(), gap: T::ONE - volumes.sum::<T>() / near.cell_volume() }
}

/// A node's share of the area over which a pair faces each other [m^2].
///
/// ```text
/// integral of S_i n dA over a body's surface = integral of grad S_i dV = -sum_p V_p grad S_i(x_p)
/// ```
/// by the divergence theorem, so the volume gradient along the normal is the surface that the node sees; the pair
/// shares the smaller of the two. Summed over nodes it is the whole area, as the functions S_i sum to one.
fn area<T: Real, const D: usize>(look: &LawInputs<T, D>, facing: &Facing<T, D>) -> T {
    let Some(normal) = facing.normal else { return T::ZERO };
    let [a, b] = look.pair.map(|side| look.sides[side].volume_gradient.dot(normal));
    (-a).min(b).max(T::ZERO)
}

impl<T: Real, const D: usize> SurveyPart<T, D> {
    /// The pair of an encounter.
    pub fn pair<'a>(
        &'a self,
        encounter: &Encounter<T, D>,
        rules: &'a Rules<T>,
        step: TimeStep<T>,
    ) -> Pair<'a, T, D> {
        let [a, b] = encounter.sides.map(|side| &self.sides[side]);
        let rule = rules.rule(encounter.rule);
        Pair {
            rule,
            surfaces: [&a.surface, &b.surface],
            normal: encounter.facing.normal,
            gap: encounter.facing.gap,
            area: encounter.area,
            recovery: encounter.recovery,
            step,
        }
    }
}
