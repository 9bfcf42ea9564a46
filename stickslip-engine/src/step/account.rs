//! The verb that books what a step did: contact, the work of friction and of damping, and what forces lack to balance.

use super::Engine;
use super::state::Workspace;
use crate::body::Body;
use crate::contact::{BlockSums, Change, Impulse, Impulses, Span};
use crate::exact::ExactSum;
use crate::grid::{Node, locate, next_of, node_at, nodes_per_block};
use crate::lanes::Laned;
use crate::pass::FaultReport;
use crate::ranks::{combined, joined};
use crate::scene::ContactLaw;
use crate::tensor::{Real, Vector};
use crate::threads::each;
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// Blocks that a thread takes at a time.
const BLOCKS: usize = 16;

/// Sums over nodes: unbalanced force, force of the stress and other forces [N], kinetic energy at the step's start and
/// what damping took [J].
pub(super) type NodeTotals = [f64; 5];

/// What a step adds up, before it is rounded.
#[derive(Clone, Debug, Default)]
pub(super) struct StepSums {
    /// Over the nodes; to the last one passes add what they took from the particles' kinetic energy [J].
    pub nodes: [ExactSum; 5],
    /// Nodes at which pairs had not come to rest.
    unsettled: ExactSum,
    /// Of contact, what friction and bonds took and what prescribed motion did [J], and how many impulses were reduced.
    contact: [ExactSum; 4],
}

/// What a step is like on one rank, or on several together.
#[derive(Serialize, Deserialize)]
struct StepEnd {
    fault: Option<(u32, FaultReport)>,
    signal: Option<f64>,
    sums: Vec<ExactSum>,
}

impl StepEnd {
    /// That of both: the first fault by pass, body and particle.
    fn and(self, other: Self) -> Self {
        let rank = |(pass, fault): &(u32, FaultReport)| (*pass, fault.body, fault.number);
        let faults = self.fault.into_iter().chain(other.fault);
        StepEnd {
            fault: faults.min_by_key(rank),
            signal: self.signal.into_iter().chain(other.signal).reduce(f64::max),
            sums: joined(self.sums, other.sums),
        }
    }
}

impl StepSums {
    /// What damping took from the particles' kinetic energy [J].
    pub fn damped(&mut self) -> &mut ExactSum {
        &mut self.nodes[4]
    }

    /// At how many nodes pairs had not come to rest when the last sweep over them was done.
    pub fn unsettled(&mut self) -> &mut ExactSum {
        &mut self.unsettled
    }

    /// Adds what contact did in a use.
    fn touch(&mut self, touches: &[BlockSums]) {
        for touch in touches {
            let [friction, adhesion, work, reduced] = &mut self.contact;
            friction.add(touch.friction);
            adhesion.add(touch.adhesion);
            work.add(touch.work);
            reduced.add(touch.reduced as f64);
        }
    }
}

/// Part of what an impulse changes of the heavier node's velocity, that it must leave of the motion against it so that
/// surfaces slip or part and do not stick.
const LEFT_OVER: f64 = 1e-3;

/// How often a step interpolates velocities: after the second time u^1 is at the nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Interpolated {
    /// At its start.
    Once,
    /// At its start, and with the particles' new velocities.
    Twice,
}

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Books what the step did, and measures how far from balance its forces are. Nothing of it changes the step.
    ///
    /// Works are force times the mean of u^0 and u^1, the velocities interpolated before and after. Where the step does
    /// not interpolate a second time, u^1 is the node's own new velocity for damping, and u^0 for friction.
    pub(super) fn account(&mut self, dt: T, interpolated: Interpolated) {
        let twice = interpolated == Interpolated::Twice;
        self.book_contact(dt, twice);
        self.account_walls(dt);
        if self.measures_balance() {
            let start = Instant::now();
            self.workspace.sum_over_nodes(&self.state.bodies, |Workspace { boundary, .. }, place, node| {
                let (node, impulse) = node;
                let [unbalanced, internal, external] = balance(node, impulse, dt, boundary.is_fixed(place));
                let kinetic = 0.5 * (node.start.dot(node.start) * node.mass).f64();
                [unbalanced, internal, external, kinetic, damping_work(node, impulse, twice)]
            });
            self.watch.lap("accounts", start);
        }
    }

    /// Ends the step on all ranks: books its sums, or gives the first fault that any of them found.
    pub(super) fn end_step(&mut self, dt: T) -> Result<(), FaultReport> {
        let StepSums { nodes: [unbalanced, internal, external, kinetic, damped], unsettled, contact } =
            std::mem::take(&mut self.workspace.sums);
        let [rubbed, torn, work, reduced] = contact;
        let mut sums =
            [unbalanced, internal, external, kinetic, damped, unsettled, rubbed, torn, work, reduced];
        if let Some(signal) = self.workspace.reference_signal {
            self.state.signal = Some(self.state.signal.map_or(signal, |own| own.max(signal)));
        }
        if let Some(among) = &mut self.among {
            let own = StepEnd { fault: among.fault(), signal: self.state.signal, sums: sums.to_vec() };
            let all = combined(&*among.ranks, &own, StepEnd::and);
            if let Some((_, fault)) = all.fault {
                return Err(fault);
            }
            self.state.signal = all.signal;
            sums.iter_mut().zip(all.sums).for_each(|(sum, all)| *sum = all);
        }
        let [unbalanced, internal, external, kinetic, damped, unsettled, rubbed, torn, work, reduced] =
            sums.each_ref().map(ExactSum::value);
        self.state.damping += damped;
        let contact = &mut self.state.contact_sums;
        (contact.friction, contact.adhesion) = (contact.friction + rubbed, contact.adhesion + torn);
        contact.work += work;
        contact.scaled += reduced as u64;
        contact.unsettled += unsettled as u64;
        if self.measures_balance() {
            self.state.relaxation.take([unbalanced, internal, external], kinetic);
        }
        self.book_touches(dt);
        Ok(())
    }

    /// Books what pairs of bodies did in the step. Of several ranks, each books the pairs whose sums it keeps.
    fn book_touches(&mut self, dt: T) {
        let start = Instant::now();
        let Workspace { touches, mechanism, boundary, reference_touches, .. } = &mut self.workspace;
        if !reference_touches.is_empty() {
            touches[1].append(reference_touches);
            touches[1].sort_unstable_by_key(BlockSums::rank);
        }
        let (sums, place) = (&mut self.state.contact_sums, (&self.settings.lattice, &*boundary));
        if let Some(among) = &self.among {
            among.send_to_keepers(touches);
        }
        // How long surfaces touch is counted once a step.
        let [first, second, third] = touches;
        sums.add(first, place, 0.0);
        sums.add(second, place, dt.f64());
        sums.count(third);
        for touch in mechanism.booked() {
            sums.friction += touch.friction;
            if self.among.as_ref().is_none_or(|among| among.keeps(touch.bodies)) {
                sums.touch(touch, dt.f64());
            }
        }
        self.watch.lap("contact", start);
    }

    /// Whether a step looks how far its forces are from balance.
    pub(super) fn measures_balance(&self) -> bool {
        self.settings.damping.acts() || self.settings.time.relax.is_some()
    }

    /// Books what contact did: impulses by pair of bodies, and the work of friction in this step, what its impulses
    /// took from the particles' kinetic energy, and likewise that of bonds that give way.
    ///
    /// ```text
    /// W = -sum J . (w^0 + w^1)/2,   w = u_a - u_b of the particles' velocities, interpolated before and after the step
    /// ```
    /// This is exact for FLIP, where particles take changes at nodes: sum_p m_p v_p . sum_i S_i dv_i = sum_i m_i dv_i .
    /// v_i, with v_i interpolated from the v_p. The velocity of a node with next to no mass is mostly what forces do to
    /// it within the step, and says little of how particles move. Surfaces that stick rub nothing: what u^0 and u^1 of
    /// light nodes differ by then is no slip, and is booked neither as friction nor as that of a bond that gives way.
    fn book_contact(&mut self, dt: T, twice: bool) {
        let start = Instant::now();
        let [mut one, mut two, mut three] = std::mem::take(&mut self.workspace.touches);
        let (nodes, rules) = (&self.workspace.field.nodes, &self.settings.rules);
        let seen = |node: usize| {
            let node = &nodes[node];
            if twice { (node.start + node.velocity) * T::HALF } else { node.start }
        };
        // Whether an impulse on the first body left some of the motion against it.
        let yields = |impulse: &Impulse<T, D>, given: Vector<T, D>| {
            let [a, b] = impulse.nodes.map(|node| &nodes[node]);
            let left = -given.dot(a.integrated - b.integrated);
            let heaviest = a.mass.max(b.mass);
            let stopped = given.dot(given) / heaviest;
            left > stopped * T::of(LEFT_OVER)
        };
        let works = |impulse: &Impulse<T, D>| {
            let [a, b] = impulse.bodies;
            let rule = rules.rule(rules.number(a, b));
            let Change { impulse: [on_a, _], normal, tangential, .. } = impulse.change;
            let rubs =
                rule.law != ContactLaw::Glued && tangential != Vector::ZERO && yields(impulse, tangential);
            // A bond that holds passes work on to the strain, as a push does; one that gives way takes it.
            let strength = rule.friction.adhesion * impulse.area * dt;
            let pulls =
                strength > T::ZERO && normal >= strength * T::of(0.999) && yields(impulse, on_a - tangential);
            if !rubs && !pulls {
                return [0.0; 2];
            }
            let [v, w] = impulse.nodes.map(seen);
            let took = |impulse: Vector<T, D>| -impulse.dot(v - w).f64();
            [if rubs { took(tangential) } else { 0.0 }, if pulls { took(on_a - tangential) } else { 0.0 }]
        };
        let [first, second, _] = &self.workspace.impulses;
        self.list_touches(&mut one, (first, |impulse| impulse.span == Span::EachUse), works);
        self.list_touches(&mut two, (second, |_| true), works);
        [&one, &two].into_iter().for_each(|touches| self.workspace.sums.touch(touches));
        three.clear();
        self.workspace.sums.touch(&self.workspace.reference_touches);
        // What a body does to itself is no pair's.
        self.workspace.reference_touches.retain(|touch| touch.bodies[0] < touch.bodies[1]);
        self.workspace.touches = [one, two, three];
        self.watch.lap("contact", start);
    }

    /// Lists what pairs did in the third use of contact. What the others gave stands in the account of the step.
    pub(super) fn count_pushes(&mut self) {
        let [one, two, mut three] = std::mem::take(&mut self.workspace.touches);
        let pushes = |impulse: &Impulse<T, D>| impulse.change.pushes();
        self.list_touches(&mut three, (&self.workspace.impulses[2], pushes), |_| [0.0; 2]);
        for touch in &mut three {
            // It enters no sum of works.
            touch.work = 0.0;
        }
        self.workspace.sums.touch(&three);
        self.workspace.touches = [one, two, three];
    }

    /// Lists what pairs did in a use of contact at the blocks that this rank books, by the impulses that count.
    fn list_touches(
        &self,
        touches: &mut Vec<BlockSums>,
        (impulses, counts): (&Impulses<T, D>, impl Fn(&Impulse<T, D>) -> bool),
        works: impl Fn(&Impulse<T, D>) -> [f64; 2],
    ) {
        let Workspace { active, boundary, .. } = &self.workspace;
        let here = |impulse: &&Impulse<T, D>| counts(impulse) && active.books(locate(impulse.node).0);
        let here = impulses.iter().filter(here);
        BlockSums::list(touches, here, (&self.settings.lattice, boundary), works);
    }
}

/// Magnitudes of the forces at a node of a deformable body that was integrated over a step [N]:
///
/// ```text
/// |r|, |f|, |r - f|        r = (m (v~ - v^0) - J) / dt
/// ```
/// r: unbalanced force, with which walls leave alone what they hold; f: force of the stress; r - f: gravity, loads
/// and contact; J: impulse of damping, which is none of them. At a fixed face f alone counts, which is there what the
/// wall bears.
fn balance<T: Real, const D: usize>(
    node: &Node<T, D>,
    damping: Vector<T, D>,
    dt: T,
    fixed: bool,
) -> [f64; 3] {
    let internal = node.force.norm().f64();
    if fixed {
        return [0.0, internal, 0.0];
    }
    let unbalanced = (node.integrated - node.start) * (node.mass / dt) - damping / dt;
    [unbalanced.norm().f64(), internal, (unbalanced - node.force).norm().f64()]
}

/// What damping took from the particles' kinetic energy by its impulse J at a node [J]:
///
/// ```text
/// W = -J . (u^0 + u^1)/2
/// ```
/// Exact for FLIP, see the work of friction; with the node's own new velocity where it changes alike all around.
fn damping_work<T: Real, const D: usize>(node: &Node<T, D>, impulse: Vector<T, D>, twice: bool) -> f64 {
    let after = if twice { node.velocity } else { node.integrated };
    -(impulse.dot(node.start + after) * T::HALF).f64()
}

impl<T: Real, const D: usize> Workspace<T, D> {
    /// Adds to the sums of the step what there is of the nodes of deformable bodies that have mass, that this rank
    /// books, and that repeat no other behind a mirror. `of_node` is told where the node is, and the impulse of damping there.
    fn sum_over_nodes(
        &mut self,
        bodies: &[Body<T, D>],
        of_node: impl Fn(&Self, [i32; D], (&Node<T, D>, Vector<T, D>)) -> NodeTotals + Sync,
    ) where
        Self: Sync,
    {
        let n = nodes_per_block(D);
        let mut sums = std::mem::take(&mut self.block_sums);
        sums.clear();
        sums.resize(self.active.slots.len(), NodeTotals::default());
        let workspace = &*self;
        each(&mut sums, BLOCKS, |slot, sum| {
            let (body, block) = workspace.active.slots[slot];
            if bodies[body as usize].is_rigid() || !workspace.active.books(block) {
                return;
            }
            let mut places = workspace.field.present[slot];
            while let Some(local) = next_of(&mut places) {
                let place = node_at(block, local);
                if !workspace.boundary.is_mirrored(place) {
                    let index = slot * n + local;
                    let impulse = workspace.damping_impulses.get(index).copied().unwrap_or(Vector::ZERO);
                    let found = of_node(workspace, place, (&workspace.field.nodes[index], impulse));
                    sum.iter_mut().zip(found).for_each(|(sum, found)| *sum += found);
                }
            }
        });
        for (i, total) in self.sums.nodes.iter_mut().enumerate() {
            sums.iter().for_each(|sum| total.add(sum[i]));
        }
        self.block_sums = sums;
    }
}
