//! Velocities of free rigid bodies, impulses of contact and those of joints, found together.

use super::joint::poses;
use super::row::{JointRow, Row};
use super::six::{self, Six, SixFactor, SixMatrix, at, join};
use super::surfaces::{RigidContact, RigidSurfaces};
use super::sweeps::{packed, solve, tolerance as tolerance_of};
use super::touch::{Touch, TouchForce, least_slip};
use super::{FreeBody, Mechanism, slot};
use crate::body::Body;
use crate::contact::{Impulses, Solve, Span};
use crate::grid::{ActiveBlocks, Lattice, locate};
use crate::ranks::{Ranks, gathered, largest};
use crate::scene::Joint;
use crate::tensor::{Real, Vector};
use serde::{Deserialize, Serialize};

/// A use of contact in which free rigid bodies take part.
///
/// Contact is solved against rigid bodies of given velocities V, over and over, and V is bettered by Newton's method:
///
/// ```text
/// (M + A) dV = p* - p + J(V) + G^T l,    g/dt + G dV = 0,    p <- p + M dV,    V = V(p)
/// ```
/// p: momenta, p*: those without contact; A = sum m g g^T over the nodes in contact, with their mass m and the direction
/// g along which the deformable body follows the rigid one: the normal, and where it sticks all directions. As long as
/// no node begins or ends to touch or to slip, one round is exact.
pub struct Coupling<'a, T, const D: usize> {
    /// Contact at the nodes.
    pub solve: Solve<'a, T, D>,
    /// Where nodes are.
    pub lattice: &'a Lattice<T, D>,
    /// The joints that hold in this use, and whether rigid bodies push on each other in it.
    pub joints: &'a [Joint],
    pub surfaces: Option<&'a RigidSurfaces>,
    /// The blocks, and the ranks that share them, if there are any. All of them have all free bodies.
    pub active: &'a ActiveBlocks<D>,
    pub ranks: Option<&'a dyn Ranks>,
}

/// What contact does to a free body at the nodes of a block. Each rank adds up its blocks, and all of them the sums of
/// these in one order: so it does not matter who has which block.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct BlockPush {
    /// Place of the body in the mechanism, and the block; in the plane its third place is 0.
    body: usize,
    block: [i32; 3],
    /// J of the block's nodes, and their part of A.
    impulse: Six,
    matrix: SixMatrix,
}

/// Searches for contacts of rigid bodies at most, and how much faster than it was looked ahead for a body may become.
const MAX_SEARCHES: usize = 3;
/// How often in a step contacts may break loose at most: each may take others with it.
const MAX_BREAKS: usize = 2;
const FASTER: f64 = 1.5;
/// Contacts of a packing are searched once more where a body would sink in by more than this part of its radius.
const MISSED: f64 = 0.01;
/// Rounds at most.
const MAX_ROUNDS: usize = 60;
/// From this round on one whose equations did not come to rest is the last.
const MAX_UNHELD: usize = 5;
/// From this round on a node in contact counts as one that sticks: velocities then come closer in each round.
const SURE: usize = 12;
/// Rounds end where velocities change by less than this part of themselves.
const TOLERANCE: f64 = 1e-13;
/// The same in units of the last place of the numbers that nodes have, and of places.
const ROUND_OFF: f64 = 8.0;
/// A node sticks whose tangential impulse stops this part of its slip.
const STICKING: f64 = 0.999;

/// A node of a free body that contact may push.
struct TouchedNode {
    /// Place of the body in the mechanism, and index of the node in the field.
    body: usize,
    index: usize,
    /// From the body's centre to the node [m].
    arm: [f64; 3],
}

/// Where contact may push free bodies.
struct Touched {
    nodes: Vec<TouchedNode>,
    /// Which parts of the survey have any.
    parts: Vec<bool>,
    /// Whether any rank has one.
    anywhere: bool,
}

impl<T: Real, const D: usize> Coupling<'_, T, D> {
    /// Finds the velocities of free bodies and the impulses at the nodes, lists these and applies both; says whether
    /// velocities came to rest.
    pub fn settle(
        &self,
        bodies: &mut [Body<T, D>],
        mechanism: &mut Mechanism,
        listed: &mut Impulses<T, D>,
    ) -> bool {
        let dt = self.solve.step.duration.f64();
        for free in &mut mechanism.bodies {
            let state = bodies[free.index].motion.as_deref().and_then(|motion| motion.as_free());
            let state = state.expect("it is free").state;
            free.target = join(state.momentum, state.angular_momentum);
        }
        let touched = self.touched(bodies, &mechanism.bodies);
        self.find_rows(mechanism, dt);
        let (mut settled, mut found) = (false, None);
        for _ in 0..MAX_SEARCHES {
            let sought: Vec<f64> = mechanism.bodies.iter().map(|free| free.speed(bodies)).collect();
            let contacts = found.take().unwrap_or_else(|| self.contacts(bodies, mechanism, dt));
            self.find_touches(contacts, bodies, mechanism, dt);
            for free in &mut mechanism.bodies {
                free.momenta = free.target;
                let motion = bodies[free.index].motion.as_deref_mut().expect("it is rigid");
                motion.set_momenta(six::parts(free.target), dt);
            }
            settled = self.iterate(bodies, mechanism, &touched, listed);
            // Those that break loose have less friction from then on.
            for _ in 0..MAX_BREAKS {
                // With velocities that are not found yet the next step takes it up.
                if !self.judge_slip(bodies, mechanism) || !settled && packed(&mechanism.touches) {
                    break;
                }
                settled = self.iterate(bodies, mechanism, &touched, listed);
            }
            // Joints and impacts may have made a body faster than it was looked ahead for.
            let outran = |(free, sought): (&FreeBody, &f64)| free.speed(bodies) > FASTER * sought;
            if mechanism.touches.is_empty() && self.surfaces.is_none()
                || !mechanism.bodies.iter().zip(&sought).any(outran)
            {
                break;
            }
            // Something always does in a packing; rarely it meets what was not looked at.
            if packed(&mechanism.touches) {
                let contacts = self.contacts(bodies, mechanism, dt);
                if !missed(&contacts, bodies, mechanism, dt) {
                    break;
                }
                found = Some(contacts);
                mechanism.before = mechanism.touches.iter().filter_map(|touch| touch.force(dt)).collect();
            }
        }
        self.finish(bodies, mechanism, (&touched, listed));
        self.move_nodes(bodies, (&mechanism.bodies, &touched.nodes));
        self.solve.apply(listed);
        settled
    }

    /// Betters the velocities, round by round, with the contacts and joints that were found; says whether they came to
    /// rest.
    fn iterate(
        &self,
        bodies: &mut [Body<T, D>],
        mechanism: &mut Mechanism,
        touched: &Touched,
        listed: &mut Impulses<T, D>,
    ) -> bool {
        let dt = self.solve.step.duration.f64();
        let far = mechanism.bodies.iter().map(|free| {
            let motion = bodies[free.index].motion.as_deref().expect("it is rigid");
            free.radius + Vector(motion.center).norm()
        });
        // Places are no nearer than round-off.
        let round_off = ROUND_OFF * f64::EPSILON * far.fold(0.0, f64::max) / dt;
        let placed = !(self.joints.is_empty() && mechanism.touches.is_empty());
        let tolerance = TOLERANCE.max(ROUND_OFF * T::EPSILON.f64());
        let alone = !mechanism.touches.is_empty() && !touched.anywhere && mechanism.rows.is_empty();
        let mut first = 0.0;
        for round in 0..MAX_ROUNDS {
            self.move_nodes(bodies, (&mechanism.bodies, &touched.nodes));
            self.solve.list(|part| round == 0 || touched.parts[part], listed);
            let (impulses, nodes) = self.sum((touched, listed), (bodies, &mechanism.bodies), round >= SURE);
            let factors: Vec<SixFactor> = nodes.iter().map(SixMatrix::factor).collect();
            let missing = |(i, free): (usize, &FreeBody)| {
                let missing = std::array::from_fn(|k| free.target[k] - free.momenta[k] + impulses[i][k]);
                factors[i].solve(&missing)
            };
            let mut changes: Vec<Six> = mechanism.bodies.iter().enumerate().map(missing).collect();
            self.find_off(bodies, mechanism, dt);
            mechanism.rows.iter_mut().for_each(|held| held.row.respond(&factors));
            mechanism.touches.iter_mut().flat_map(Touch::rows_mut).for_each(|row| row.respond(&factors));
            let held =
                solve(&mut mechanism.rows, &mut mechanism.touches, (&mut changes, &nodes, D), round_off);
            let (mut moved, mut speed) = (0.0_f64, 0.0_f64);
            for (free, change) in mechanism.bodies.iter_mut().zip(&changes) {
                let gained = free.inertia.times(change);
                six::add(&mut free.momenta, 1.0, &gained);
                let motion = bodies[free.index].motion.as_deref_mut().expect("it is rigid");
                motion.set_momenta(six::parts(free.momenta), dt);
                moved = moved.max(free.size(change));
                speed = speed.max(free.speed(bodies)).max(free.size(&free.start)).max(free.pushed());
            }
            // Nothing but contacts of rigid bodies: another round would only sweep on, as the next step does.
            if alone || !held && round >= MAX_UNHELD {
                return held;
            }
            if round == 0 && !mechanism.touches.is_empty() {
                first = 10.0 * tolerance_of(&mechanism.touches) * moved;
            }
            if moved <= tolerance * speed + if placed { round_off + first } else { 0.0 } {
                return held;
            }
        }
        false
    }

    /// Nodes of free bodies where others are.
    fn touched(&self, bodies: &[Body<T, D>], free: &[FreeBody]) -> Touched {
        let (mut nodes, mut parts, mut here) = (Vec::new(), Vec::new(), false);
        for part in self.solve.survey.parts() {
            let before = nodes.len();
            for site in &part.sites {
                let is_booked = self.active.books(locate(site.node).0);
                for side in &part.sides[site.sides.clone()] {
                    let Ok(body) = free.binary_search_by_key(&side.body, |free| free.index) else { continue };
                    let arm = arm(self.lattice, site.node, &bodies[side.body]);
                    nodes.push(TouchedNode { body, index: side.index, arm });
                    here |= is_booked;
                }
            }
            parts.push(nodes.len() > before);
        }
        let here = f64::from(u8::from(here));
        let anywhere = self.ranks.map_or(here, |ranks| largest(ranks, here)) > 0.0;
        Touched { nodes, parts, anywhere }
    }

    /// Gives nodes the velocities that free bodies have there.
    fn move_nodes(&self, bodies: &[Body<T, D>], (free, touched): (&[FreeBody], &[TouchedNode])) {
        for node in touched {
            let motion = bodies[free[node.body].index].motion.as_deref().expect("it is rigid");
            let velocities = join(motion.velocity(), motion.spin());
            // SAFETY: nobody else looks at the nodes meanwhile.
            unsafe { self.solve.nodes.get(node.index) }.prescribe(super::velocity_at(&velocities, node.arm));
        }
    }

    /// Impulses of contact on the free bodies, and M + A of each.
    fn sum(
        &self,
        (touched, listed): (&Touched, &Impulses<T, D>),
        (bodies, free): (&[Body<T, D>], &[FreeBody]),
        sure: bool,
    ) -> (Vec<Six>, Vec<SixMatrix>) {
        let mut impulses = vec![[0.0; 6]; free.len()];
        let mut matrices: Vec<SixMatrix> = free.iter().map(|free| free.inertia).collect();
        if touched.anywhere {
            let mut pushes = self.pushes((touched, listed), (bodies, free), sure);
            if let Some(ranks) = self.ranks {
                pushes = gathered(ranks, &pushes).concat();
            }
            pushes.sort_unstable_by_key(|push| (push.body, push.block));
            for BlockPush { body, impulse, matrix, .. } in &pushes {
                six::add(&mut impulses[*body], 1.0, impulse);
                matrices[*body].add_all(matrix);
            }
        }
        (impulses, matrices)
    }

    /// What contact does to free bodies at the nodes of the blocks that this rank books; those of a block follow one
    /// another.
    fn pushes(
        &self,
        (touched, listed): (&Touched, &Impulses<T, D>),
        (bodies, free): (&[Body<T, D>], &[FreeBody]),
        sure: bool,
    ) -> Vec<BlockPush> {
        let mut pushes: Vec<BlockPush> = Vec::new();
        // Where those of the block at hand begin.
        let (mut first, mut last) = (0, None);
        let parts = self.solve.survey.parts().iter().enumerate().filter(|(i, _)| touched.parts[*i]);
        for (impulse, encounter, part) in parts.flat_map(|(number, part)| {
            let encounters = listed.of(number).iter().zip(&part.encounters);
            encounters.map(move |(impulse, encounter)| (impulse, encounter, part))
        }) {
            let (block, _) = locate(impulse.node);
            if !self.counts(impulse.span) || !self.active.books(block) {
                continue;
            }
            if last != Some(block) {
                (first, last) = (pushes.len(), Some(block));
            }
            for side in 0..2 {
                let index = impulse.bodies[side];
                let Some(body) = slot(free, index) else { continue };
                let given = impulse.change.impulse[side].space();
                if given == [0.0; 3] {
                    continue;
                }
                let here = pushes[first..].iter().position(|push| push.body == body);
                let place = here.map_or(pushes.len(), |here| first + here);
                if place == pushes.len() {
                    let block = std::array::from_fn(|i| if i < D { block[i] } else { 0 });
                    let (impulse, matrix) = ([0.0; 6], SixMatrix::default());
                    pushes.push(BlockPush { body, block, impulse, matrix });
                }
                let BlockPush { impulse: sum, matrix, .. } = &mut pushes[place];
                let arm = arm(self.lattice, impulse.node, &bodies[index]);
                six::add(sum, 1.0, &at(arm, given));
                let other = &part.sides[encounter.sides[1 - side]].surface;
                if other.is_rigid() {
                    continue;
                }
                let mass = 1.0 / other.inverse_mass.f64();
                let held = mass * self.slip(impulse.nodes, encounter.normal()) * STICKING;
                let sticks = sure || impulse.change.tangential.norm().f64() >= held;
                match encounter.normal().filter(|_| !sticks) {
                    Some(n) => matrix.add(mass, &at(arm, n.space())),
                    None => (0..D).for_each(|k| {
                        let axis = std::array::from_fn(|i| f64::from(u8::from(i == k)));
                        matrix.add(mass, &at(arm, axis));
                    }),
                }
            }
        }
        pushes
    }

    /// How fast two bodies slip at their nodes before contact [m/s].
    fn slip(&self, nodes: [usize; 2], normal: Option<Vector<T, D>>) -> f64 {
        // SAFETY: nobody else looks at the nodes meanwhile.
        let [v, w] = nodes.map(|node| unsafe { self.solve.nodes.get(node) }.velocity);
        let u = v - w;
        normal.map_or(0.0, |n| (u - n * u.dot(n)).norm().f64())
    }

    /// Whether impulses of a law are part of this use: those that judge the whole step are judged by its second use.
    fn counts(&self, span: Span) -> bool {
        span == Span::EachUse || self.solve.given.is_some()
    }

    /// What the joints hold in this step.
    fn find_rows(&self, mechanism: &mut Mechanism, dt: f64) {
        let Mechanism { bodies, links, rows, .. } = mechanism;
        rows.clear();
        for (number, joint) in self.joints.iter().enumerate() {
            let held = [slot(bodies, joint.body), joint.to.and_then(|to| slot(bodies, to))];
            links[number].rows((number, joint), (held, D, dt), rows);
        }
    }

    /// How far the equations are from holding with the velocities found so far.
    fn find_off(&self, bodies: &[Body<T, D>], mechanism: &mut Mechanism, dt: f64) {
        let motion = |body: usize| bodies[body].motion.as_deref().expect("joints hold rigid bodies");
        let mut rows = mechanism.rows.iter_mut().peekable();
        for (number, joint) in self.joints.iter().enumerate() {
            if rows.peek().is_none_or(|held: &&mut JointRow| held.joint != number) {
                continue;
            }
            let after = poses(joint, |body| motion(body).next_pose(dt));
            let velocities = [Some(joint.body), joint.to]
                .map(|body| body.map_or([0.0; 6], |body| join(motion(body).velocity(), motion(body).spin())));
            let center = motion(joint.body).pose().begun();
            let time = mechanism.time;
            let off = mechanism.links[number].off(joint, (after, velocities, center), (D, time, dt));
            while let Some(held) = rows.next_if(|held| held.joint == number) {
                held.row.off = off[held.number];
            }
        }
        for touch in &mut mechanism.touches {
            let pair = touch.contact.bodies.map(motion);
            let velocities = pair.map(|motion| join(motion.velocity(), motion.spin()));
            let along = |row: &Row| {
                six::dot(&row.directions[0], &velocities[0]) + six::dot(&row.directions[1], &velocities[1])
            };
            touch.normal.off = along(&touch.normal) - touch.parting;
            for row in &mut touch.tangents {
                row.off = along(row);
            }
        }
    }

    /// Where rigid bodies touch or may in this step.
    fn contacts(&self, bodies: &[Body<T, D>], mechanism: &mut Mechanism, dt: f64) -> Vec<RigidContact> {
        let near = &mut mechanism.neighbours;
        self.surfaces.map_or_else(Vec::new, |surfaces| surfaces.contacts(bodies, self.solve.rules, dt, near))
    }

    /// Takes up the contacts of rigid bodies in this step.
    fn find_touches(
        &self,
        contacts: Vec<RigidContact>,
        bodies: &[Body<T, D>],
        mechanism: &mut Mechanism,
        dt: f64,
    ) {
        mechanism.touches.clear();
        let rules = self.solve.rules;
        for contact in contacts {
            let motions = contact.bodies.map(|body| bodies[body].motion.as_deref().expect("it is rigid"));
            let slots = contact.bodies.map(|body| mechanism.slot(body));
            let start = [0, 1].map(|side| match slots[side] {
                Some(slot) => mechanism.bodies[slot].start,
                None => join(motions[side].velocity(), motions[side].spin()),
            });
            let [a, b] = contact.bodies;
            let centers = contact.centers(motions.map(|motion| motion.center));
            let rule = rules.rule(rules.number(a, b));
            mechanism.touches.push(Touch::new(
                contact,
                rule,
                (slots, centers, start),
                (D, dt, mechanism.gravity),
            ));
        }
        let Mechanism { touches, before, .. } = mechanism;
        // Both are in the order of pairs.
        let mut before = &before[..];
        for of_pair in touches.chunk_by_mut(|a, b| a.contact.bodies == b.contact.bodies) {
            let pair = of_pair[0].contact.bodies;
            let first = before.iter().take_while(|force| force.bodies < pair).count();
            let count = before[first..].iter().take_while(|force| force.bodies == pair).count();
            let (forces, rest) = before[first..].split_at(count);
            before = rest;
            let apart = |touch: &Touch, force: &TouchForce| {
                (Vector(force.place) - Vector(touch.contact.place)).norm()
            };
            for touch in of_pair.iter_mut() {
                let near = forces.iter().min_by(|a, b| apart(touch, a).total_cmp(&apart(touch, b)));
                touch.slipped(near.map(|force| force.slip));
            }
            // Each force of the step before goes to the contact of its pair that is next to where it was.
            for force in forces {
                let near = of_pair.iter_mut().min_by(|a, b| apart(a, force).total_cmp(&apart(b, force)));
                near.into_iter().for_each(|touch| touch.expect((Vector(force.force) * dt).0));
            }
        }
    }

    /// Looks which contacts of rigid bodies slip; says whether any of them broke loose.
    fn judge_slip(&self, bodies: &[Body<T, D>], mechanism: &mut Mechanism) -> bool {
        let least = least_slip(&mechanism.touches);
        let mut broke = false;
        for touch in &mut mechanism.touches {
            let motions =
                touch.contact.bodies.map(|body| bodies[body].motion.as_deref().expect("it is rigid"));
            let velocities = motions.map(|motion| join(motion.velocity(), motion.spin()));
            let centers = touch.contact.centers(motions.map(|motion| motion.center));
            let (relative, normal) = (
                Vector(touch.contact.relative(velocities.each_ref(), centers)),
                Vector(touch.contact.normal),
            );
            let slip = (relative - normal * relative.dot(normal)).norm();
            broke |= touch.judge(slip, least);
        }
        broke
    }

    /// Gives the bodies exactly the momenta that contact and joints gave them.
    fn finish(
        &self,
        bodies: &mut [Body<T, D>],
        mechanism: &mut Mechanism,
        (touched, listed): (&Touched, &Impulses<T, D>),
    ) {
        let dt = self.solve.step.duration.f64();
        let (impulses, _) = self.sum((touched, listed), (bodies, &mechanism.bodies), true);
        for (free, impulse) in mechanism.bodies.iter_mut().zip(&impulses) {
            free.momenta = free.target;
            six::add(&mut free.momenta, 1.0, impulse);
        }
        let Mechanism { bodies: free, links, rows, touches, .. } = &mut *mechanism;
        let all = rows.iter().map(|held| &held.row).chain(touches.iter().flat_map(Touch::rows));
        for row in all {
            for side in 0..2 {
                if let Some(body) = row.bodies[side] {
                    six::add(&mut free[body].momenta, row.impulse, &row.directions[side]);
                }
            }
        }
        for held in rows {
            links[held.joint].take(&held.row);
        }
        for free in &mechanism.bodies {
            let motion = bodies[free.index].motion.as_deref_mut().expect("it is rigid");
            motion.set_momenta(six::parts(free.momenta), dt);
        }
    }
}

/// From a rigid body's centre to a node [m].
fn arm<T: Real, const D: usize>(lattice: &Lattice<T, D>, node: [i32; D], body: &Body<T, D>) -> [f64; 3] {
    let center = body.motion.as_deref().expect("it is rigid").center;
    let place = lattice.position_near(node, center);
    std::array::from_fn(|i| if i < D { place[i] - center[i] } else { 0.0 })
}

/// Whether rigid bodies, with the velocities found, would overlap by the end of the step where no contact was found.
fn missed<T: Real, const D: usize>(
    contacts: &[RigidContact],
    bodies: &[Body<T, D>],
    mechanism: &Mechanism,
    dt: f64,
) -> bool {
    contacts.iter().any(|contact| {
        let motions = contact.bodies.map(|body| bodies[body].motion.as_deref().expect("it is rigid"));
        let velocities = motions.map(|motion| join(motion.velocity(), motion.spin()));
        let centers = contact.centers(motions.map(|motion| motion.center));
        let relative = contact.relative(velocities.each_ref(), centers);
        let after = contact.gap + Vector(relative).dot(Vector(contact.normal)) * dt;
        let slots = contact.bodies.iter().filter_map(|body| mechanism.slot(*body));
        let radius = slots.map(|slot| mechanism.bodies[slot].radius).fold(f64::INFINITY, f64::min);
        after < contact.gap.min(0.0) - MISSED * radius
    })
}
