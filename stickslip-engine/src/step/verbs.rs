//! The verbs of the step: what each does to a node or a particle.

use super::Engine;
use super::build::spin;
use super::pass::{Fault, FaultKind, Found, Pass, Path, Verbs, escaped, signal};
use crate::basis::Basis;
use crate::contact::{Change, Near, Record, Solve, Span, Step, Use};
use crate::door::StepError;
use crate::grid::{Blocks, Disjoint, node_at, nodes_per_block};
use crate::lanes::{Laned, Processor};
use crate::scene::{ContactLaw, StressUpdate};
use crate::tensor::{Matrix, Vector};
use crate::transfer::Share;
use rayon::prelude::*;
use std::time::Instant;

/// The uses of contact in a step.
#[derive(Clone, Copy)]
enum Contact {
    /// Of the interpolated velocities.
    Interpolated,
    /// Of the integrated velocities.
    Integrated,
    /// Of the velocities that strain and move particles, where they are scattered anew.
    Unrecorded,
}

impl<T: Laned, const D: usize, B: Basis<T>> Engine<T, D, B> {
    pub(super) fn cover(&mut self) {
        let start = Instant::now();
        let (bodies, lattice) = (&self.bodies, &self.lattice);
        let left = (self.steps > 0).then_some(&self.left[..]);
        let count = |body: usize| bodies[body].particles.len();
        let blocks = self.cover.update((bodies.len(), count, B::WIDTH as i32 - 1), left, |body, particle| {
            let (position, half_width) = bodies[body].particles.place(particle);
            let x = lattice.cells(position);
            std::array::from_fn(|i| B::reach(x[i], half_width * lattice.per_cell).floor())
        });
        let blocks = blocks.max(self.spread(blocks));
        self.tidy();
        if blocks == Blocks::New {
            self.boundary.cover(&self.cover);
        }
        self.left.clear();
        self.left.resize(self.cover.tiles.len(), 0);
        self.damped.clear();
        self.damped.resize(self.cover.tiles.len(), 0.0);
        self.field.clear(&self.cover);
        self.watch.lap("cover", start);
    }

    /// Sorts particles in memory into the order in which tiles visit them, where they are no longer nearly so.
    fn tidy(&mut self) {
        let cover = &self.cover;
        (self.bodies.par_iter_mut().with_min_len(16).enumerate())
            .filter(|(i, _)| cover.untidy(*i))
            .for_each(|(i, body)| body.particles.permute(cover.order_of(i)));
        for i in 0..self.bodies.len() {
            if self.cover.untidy(i) {
                self.cover.tidied(i);
            }
        }
    }

    /// The particles' share in the nodes.
    pub(super) fn scatter(&mut self, share: Share) {
        let verbs = Verbs { scatter: Some(share), ..Verbs::default() };
        self.run_pass("scatter", verbs, T::ZERO).expect("a scatter changes no particle");
    }

    /// v_p = (1 - a) (v_p + sum S_i (v_i - v_i^0)) + a sum S_i v_i,   a: PIC share; the particle's rotation likewise
    pub(super) fn accept_and_scatter(&mut self, dt: T) -> Result<(), StepError> {
        let verbs = Verbs { accept: true, scatter: Some(Share::Momentum), ..Verbs::default() };
        self.run_pass("accept", verbs, dt)
    }

    /// F = (I + L dt) F,  sigma = law(F), and the force of the new stress.
    pub(super) fn strain_and_scatter(&mut self, dt: T) -> Result<(), StepError> {
        let verbs = Verbs { strain: true, scatter: Some(Share::Force), ..Verbs::default() };
        self.run_pass("strain", verbs, dt)
    }

    /// v += dv,  x += v dt
    pub(super) fn accept_and_displace(&mut self, dt: T) -> Result<(), StepError> {
        self.run_pass("displace", Verbs { accept: true, displace: true, ..Verbs::default() }, dt)
    }

    /// v += dv,  F = (I + L dt) F,  sigma = law(F),  x += v dt
    pub(super) fn accept_strain_and_displace(&mut self, dt: T) -> Result<(), StepError> {
        self.run_pass("strain", Verbs { accept: true, strain: true, displace: true, scatter: None }, dt)
    }

    /// F = (I + L dt) F,  sigma = law(F),  x += v dt
    pub(super) fn strain_and_displace(&mut self, dt: T) -> Result<(), StepError> {
        self.run_pass("strain", Verbs { strain: true, displace: true, ..Verbs::default() }, dt)
    }

    fn run_pass(&mut self, name: &'static str, verbs: Verbs, dt: T) -> Result<(), StepError> {
        let start = Instant::now();
        let mut found = self.pass(&Pass {
            verbs,
            dt,
            transfer: self.transfer,
            pic: self.pic_share,
            lattice: self.lattice,
            domain: self.domain,
        });
        if verbs.accept || verbs.strain {
            // Tile after tile, whoever took them.
            self.damping += self.damped.iter().sum::<f64>();
        }
        if verbs.displace {
            found = found.and(self.move_rigid_bodies(dt));
            self.signal = Some(found.signal.f64());
        }
        if let Some(share) = verbs.scatter {
            self.boundary.fold(&mut self.field, share);
        }
        self.watch.lap(name, start);
        found.fault.map_or(Ok(()), |fault| Err(self.error(&fault)))
    }

    /// v = p / m
    pub(super) fn interpolated_velocities(&mut self) {
        let start = Instant::now();
        self.field.find_present(|node| {
            node.velocity = node.velocity / node.mass;
            node.start = node.velocity;
        });
        self.hold();
        self.watch.lap("velocities", start);
    }

    /// Keeps the nodes' velocities.
    pub(super) fn keep(&mut self) {
        self.field.each_present(|node| node.integrated = node.velocity);
    }

    /// Takes back the velocities that were kept, and keeps those of now.
    pub(super) fn take_back(&mut self) {
        self.field.each_present(|node| std::mem::swap(&mut node.integrated, &mut node.velocity));
    }

    /// Keeps the nodes' velocities and makes room for momentum.
    pub(super) fn keep_and_make_room(&mut self) {
        let start = Instant::now();
        self.field.each_present(|node| {
            node.integrated = node.velocity;
            node.velocity = Vector::ZERO;
        });
        self.watch.lap("velocities", start);
    }

    /// v = p / m of the particles' new velocities.
    pub(super) fn modified_velocities(&mut self) {
        let start = Instant::now();
        self.field.each_present(|node| node.velocity = node.velocity / node.mass);
        self.hold();
        self.watch.lap("velocities", start);
    }

    /// Prescribed velocities of rigid bodies and walls.
    fn hold(&mut self) {
        let n = nodes_per_block(D);
        for (body, motion) in self.rigid.iter().enumerate() {
            let Some(motion) = motion else { continue };
            for slot in self.cover.slots_held(body) {
                let (_, block) = self.cover.slots[slot];
                for local in 0..n {
                    let position = self.lattice.position(node_at(block, local)).space();
                    self.field.nodes[slot * n + local].velocity = Vector::of(motion.velocity_at(position));
                }
            }
        }
        self.boundary.hold(&mut self.field);
    }

    pub(super) fn survey(&mut self, dt: T) {
        let start = Instant::now();
        let near = Near {
            cover: &self.cover,
            bodies: &self.bodies,
            field: &self.field,
            lattice: self.lattice,
            boundary: &self.boundary,
            rules: &self.rules,
            ahead: (self.clock.stress_update != StressUpdate::First).then_some(dt),
            processor: match self.path {
                Path::Lanes(processor) => processor,
                Path::Reference => Processor::Any,
            },
        };
        near.survey::<B>(&mut self.meeting);
        self.watch.lap("survey", start);
    }

    /// Contact on the interpolated velocities, which strain the particles if the stress is updated first.
    pub(super) fn first_contact(&mut self, dt: T) {
        self.exchange(dt, Contact::Interpolated);
        let impulses = self.impulses[0].iter().filter(|impulse| impulse.span == Span::EachUse);
        // How long surfaces touch is counted once a step.
        self.tally.add(impulses, (&self.lattice, &self.boundary), 0.0);
    }

    /// Contact on the integrated velocities, after what it gave to the interpolated ones.
    pub(super) fn contact(&mut self, dt: T) {
        self.exchange(dt, Contact::Integrated);
        self.tally.add(self.impulses[1].iter(), (&self.lattice, &self.boundary), dt.f64());
    }

    /// Books the work of friction in this step, what its impulses took from the particles' kinetic energy, and likewise that of bonds that give way.
    ///
    /// ```text
    /// W = -sum J . (u^0 + u^1)/2,   u = v_a - v_b of the particles' velocities, interpolated before and after the step
    /// ```
    /// This is exact for FLIP, where particles take changes at nodes: sum_p m_p v_p . sum_i S_i dv_i = sum_i m_i dv_i . v_i, with v_i
    /// interpolated from the v_p. The velocity of a node with next to no mass is mostly what forces do to it within the step, and says little of
    /// how particles move. Where the step does not interpolate a second time, u^1 = u^0.
    pub(super) fn friction_work(&mut self, dt: T) {
        let interpolated_twice = self.clock.stress_update == StressUpdate::ModifiedLast;
        let (nodes, rules) = (&self.field.nodes, &self.rules);
        let seen = |node: usize| {
            let node = &nodes[node];
            if interpolated_twice { (node.start + node.velocity) * T::HALF } else { node.start }
        };
        let [first, second, _] = &self.impulses;
        let first = first.iter().filter(|impulse| impulse.span == Span::EachUse);
        for impulse in first.chain(second.iter()) {
            let [a, b] = impulse.bodies;
            let rule = rules.rule(rules.number(a, b));
            let Change { impulse: [on_a, _], normal, tangential, .. } = impulse.change;
            let rubs = tangential != Vector::ZERO && rule.law != ContactLaw::Glued;
            // A bond that holds passes work on to the strain, as a push does; one that gives way takes it.
            let strength = rule.friction.adhesion * impulse.area * dt;
            let pulls = strength > T::ZERO && normal >= strength * T::of(0.999);
            if !rubs && !pulls {
                continue;
            }
            let [v, w] = impulse.nodes.map(seen);
            if rubs {
                self.tally.rub(impulse.bodies, -tangential.dot(v - w).f64());
            }
            if pulls {
                self.tally.adhesion -= (on_a - tangential).dot(v - w).f64();
            }
        }
    }

    /// Contact on the velocities that strain and move the particles: it enters no sum of forces and works, for no particle takes it as a
    /// change of its velocity.
    pub(super) fn contact_unrecorded(&mut self, dt: T) {
        self.exchange(dt, Contact::Unrecorded);
    }

    fn exchange(&mut self, duration: T, contact: Contact) {
        let start = Instant::now();
        let [first, second, third] = &mut self.impulses;
        let (purpose, record, given, listed) = match contact {
            Contact::Interpolated => {
                let strains = self.clock.stress_update == StressUpdate::First;
                (if strains { Use::Strain } else { Use::Start }, Record::Kept, None, first)
            }
            Contact::Integrated => (Use::Motion, Record::Kept, Some(&*first), second),
            Contact::Unrecorded => (Use::Strain, Record::Dropped, None, third),
        };
        let step = Step { duration, cell: self.lattice.cell, purpose };
        let nodes = Disjoint::new(&mut self.field.nodes);
        Solve { survey: &self.meeting, rules: &self.rules, nodes, step, given }.impulses(record, listed);
        self.tally.scaled += listed.reduced();
        self.tally.unsettled += listed.unsettled();
        self.boundary.hold(&mut self.field);
        self.watch.lap("contact", start);
    }

    pub(super) fn accelerate(&mut self, dt: T) {
        let start = Instant::now();
        let gravity = self.gravity;
        self.field.each_present(|node| node.velocity += (node.force / node.mass + gravity) * dt);
        self.hold();
        self.watch.lap("accelerate", start);
    }

    /// Moves rigid bodies as prescribed.
    fn move_rigid_bodies(&mut self, dt: T) -> Found<T> {
        let mut found = Found::NOTHING;
        for (i, (body, motion)) in self.bodies.iter_mut().zip(&mut self.rigid).enumerate() {
            let Some(motion) = motion else { continue };
            let dt = dt.f64();
            let rotation = motion.rotation(dt);
            // One without bounds is everywhere: its particles stand for what the others are near.
            let domain = self.domain.filter(|_| !self.unbounded.iter().any(|unbounded| unbounded.body == i));
            let turn = Matrix::from_fn(|i, j| T::of(rotation.0[i][j]));
            for p in 0..body.particles.len() {
                let mut particle = body.particles.get(p);
                let position = particle.position.space();
                let moved = Vector::of(motion.moved(position, &rotation, dt));
                let kind = if !moved.is_finite() {
                    Some(FaultKind::NotFinite)
                } else {
                    particle.velocity = Vector::of(motion.velocity_at(position));
                    particle.spin = spin::<T, D>(motion.spin());
                    particle.position = moved;
                    particle.deformation = turn * particle.deformation;
                    escaped::<T, D, B>(&particle, &self.lattice, domain).then_some(FaultKind::Escaped)
                };
                body.particles.set(p, &particle);
                let fault = kind.map(|kind| Fault { body: i, particle: p, kind });
                // SAFETY: the particles are borrowed here alone.
                let history = unsafe { body.particles.view().history_of(p) };
                found = found.and(Found { fault, signal: signal(body, &particle, &history) });
            }
            motion.advance(&rotation, dt);
            self.left[self.cover.tiles_held(i)].fill(u64::MAX);
        }
        found
    }

    fn error(&self, fault: &Fault) -> StepError {
        let body = &self.bodies[fault.body];
        let particle = body.particles.get(fault.particle);
        let (name, number, position, time) =
            (body.name.clone(), particle.number, particle.position.space(), self.time);
        match fault.kind {
            FaultKind::Inverted => StepError::Inverted {
                body: name,
                number,
                position,
                time,
                determinant: particle.deformation.det().f64(),
            },
            FaultKind::Escaped => StepError::Escaped { body: name, number, position, time },
            FaultKind::NoThickness => StepError::NoThickness { body: name, number, position, time },
            FaultKind::NotFinite => StepError::NotFinite { body: name, number, position, time },
        }
    }
}
