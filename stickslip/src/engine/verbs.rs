//! The verbs of the step: what each does to a node or a particle.

use super::Engine;
use super::cpu::{Fault, FaultKind};
use crate::basis::Basis;
use crate::body::Particle;
use crate::contact::{Impulse, Near, Survey, solve};
use crate::door::StepError;
use crate::grid::{Blocks, Lattice, Node, Window, addressable, node_at, nodes_per_block};
use crate::material::Motion;
use crate::tensor::{Matrix, Real, Vector};
use crate::transfer::Stencil;
use rayon::prelude::*;
use std::time::Instant;

/// Steps between sorts of the particles in memory.
const SORT_INTERVAL: u64 = 256;

/// What a scatter gives to the nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Share {
    /// Mass and momentum.
    Momentum,
    /// Force.
    Force,
    /// Mass, momentum and force.
    Everything,
}

impl<T: Real, const D: usize, B: Basis<T>> Engine<T, D, B> {
    pub(super) fn cover(&mut self) {
        let start = Instant::now();
        let mut blocks = self.cover_particles();
        if self.steps.is_multiple_of(SORT_INTERVAL) {
            self.sort_particles();
            blocks = blocks.max(self.cover_particles());
        }
        if blocks == Blocks::New {
            self.boundary.cover(&self.cover);
        }
        self.field.clear(&self.cover);
        self.watch.lap("cover", start);
    }

    fn cover_particles(&mut self) -> Blocks {
        let counts: Vec<usize> = self.bodies.iter().map(|body| body.particles.len()).collect();
        let (bodies, lattice) = (&self.bodies, &self.lattice);
        self.cover.update(&counts, |body, particle| {
            Stencil::<T, D, B>::new(lattice, &bodies[body].particles[particle]).base()
        })
    }

    /// Brings the particles' order in memory close to the order in which tiles visit them.
    fn sort_particles(&mut self) {
        for (i, body) in self.bodies.iter_mut().enumerate() {
            body.particles = self.cover.order_of(i).iter().map(|&p| body.particles[p as usize]).collect();
        }
    }

    pub(super) fn scatter(&mut self, share: Share) {
        let start = Instant::now();
        let momentum = |p: &Particle<T, D>, stencil: &Stencil<T, D, B>, window: &mut Window<T, D>, block| {
            stencil.scatter_momentum(window, block, (p.mass, p.velocity));
        };
        let force = |p: &Particle<T, D>, stencil: &Stencil<T, D, B>, window: &mut Window<T, D>, block| {
            stencil.scatter_force(window, block, &(p.stress * (p.volume * p.deformation.det())));
        };
        match share {
            Share::Momentum => self.scatter_each(momentum),
            Share::Force => self.scatter_each(force),
            Share::Everything => self.scatter_each(|p, stencil, window, block| {
                momentum(p, stencil, window, block);
                force(p, stencil, window, block);
            }),
        }
        if share != Share::Force {
            self.boundary.fold_momentum(&mut self.field);
        }
        if share != Share::Momentum {
            self.boundary.fold_force(&mut self.field);
        }
        self.watch.lap("scatter", start);
    }

    /// v = p / m
    pub(super) fn interpolated_velocities(&mut self) {
        self.velocities(|node| node.start = node.velocity);
    }

    /// Sets the integrated velocities aside in `start` and makes room for mass and momentum.
    pub(super) fn set_velocities_aside(&mut self) {
        self.field.nodes.par_iter_mut().with_min_len(4096).for_each(|node| {
            *node = Node { start: node.velocity, force: node.force, ..Node::EMPTY };
        });
    }

    /// v = p / m, with the integrated velocities kept in `start`.
    pub(super) fn modified_velocities(&mut self) {
        self.velocities(|_| {});
    }

    fn velocities(&mut self, before_walls: impl Fn(&mut Node<T, D>) + Sync) {
        self.field.nodes.par_iter_mut().with_min_len(4096).for_each(|node| {
            if node.mass > T::ZERO {
                node.velocity = node.velocity / node.mass;
                before_walls(node);
            }
        });
        self.hold();
    }

    /// Prescribed velocities of rigid bodies and walls.
    fn hold(&mut self) {
        let n = nodes_per_block(D);
        for (slot, &(body, block)) in self.cover.slots.iter().enumerate() {
            if let Some(motion) = &self.rigid[body as usize] {
                for local in 0..n {
                    let position = self.lattice.position(node_at(block, local)).space();
                    self.field.nodes[slot * n + local].velocity = Vector::of(motion.velocity_at(position));
                }
            }
        }
        self.boundary.hold(&mut self.field);
    }

    pub(super) fn survey(&mut self) -> Survey<T, D> {
        let start = Instant::now();
        let near = Near {
            cover: &self.cover,
            bodies: &self.bodies,
            field: &self.field,
            lattice: self.lattice,
            boundary: &self.boundary,
            rules: &self.rules,
        };
        let survey = near.survey::<B>();
        self.impulses.clear();
        self.watch.lap("survey", start);
        survey
    }

    pub(super) fn contact(&mut self, survey: &Survey<T, D>, dt: T) {
        let impulses = self.contact_unrecorded(survey, dt);
        self.tally.add(&impulses);
        self.impulses.extend(impulses);
    }

    /// Contact on velocities that only strain the particles: it enters no sum of forces and works.
    pub(super) fn contact_unrecorded(&mut self, survey: &Survey<T, D>, dt: T) -> Vec<Impulse<T, D>> {
        let start = Instant::now();
        let impulses = solve(survey, &self.rules, &self.field, self.lattice.cell / dt);
        for impulse in &impulses {
            for (node, velocity) in impulse.nodes.into_iter().zip(impulse.velocity) {
                self.field.nodes[node].velocity += velocity;
            }
        }
        self.boundary.hold(&mut self.field);
        self.watch.lap("contact", start);
        impulses
    }

    pub(super) fn accelerate(&mut self, dt: T) {
        let start = Instant::now();
        let gravity = self.gravity;
        self.field.nodes.par_iter_mut().with_min_len(4096).for_each(|node| {
            if node.mass > T::ZERO {
                node.velocity += (node.force / node.mass + gravity) * dt;
            }
        });
        self.hold();
        self.watch.lap("accelerate", start);
    }

    /// v_p = (1 - a) (v_p + sum S_i (v_i - v_i^0)) + a sum S_i v_i,   a: PIC share
    pub(super) fn accept(&mut self) -> Result<(), StepError> {
        let start = Instant::now();
        let pic = self.pic_share;
        let fault = self.each_particle(|_, particle, stencil, window, block| {
            let [velocity, before] = stencil.interpolate(window, block, |node| [node.velocity, node.start]);
            let flip = particle.velocity + (velocity - before);
            particle.velocity = flip * (T::ONE - pic) + velocity * pic;
            particle.velocity.is_finite().then_some(()).ok_or(FaultKind::NotFinite)
        });
        self.watch.lap("gather", start);
        fault.map_or(Ok(()), |fault| Err(self.error(&fault)))
    }

    pub(super) fn displace(&mut self, dt: T) -> Result<(), StepError> {
        self.displace_by(dt, |node| node.velocity)
    }

    pub(super) fn displace_aside(&mut self, dt: T) -> Result<(), StepError> {
        self.displace_by(dt, |node| node.start)
    }

    fn displace_by(
        &mut self,
        dt: T,
        velocity: impl Fn(&Node<T, D>) -> Vector<T, D> + Sync,
    ) -> Result<(), StepError> {
        let start = Instant::now();
        let (lattice, domain) = (self.lattice, self.domain);
        let fault = self.each_particle(|_, particle, stencil, window, block| {
            let [velocity] = stencil.interpolate(window, block, |node| [velocity(node)]);
            let position = particle.position + velocity * dt;
            if !position.is_finite() {
                return Err(FaultKind::NotFinite);
            }
            particle.position = position;
            if escaped::<T, D, B>(particle, &lattice, domain) { Err(FaultKind::Escaped) } else { Ok(()) }
        });
        let fault = fault.or(self.move_rigid_bodies(dt));
        self.watch.lap("gather", start);
        fault.map_or(Ok(()), |fault| Err(self.error(&fault)))
    }

    /// Moves rigid bodies as prescribed; returns the first fault by body and particle.
    fn move_rigid_bodies(&mut self, dt: T) -> Option<Fault> {
        let mut first = None;
        for (i, (body, motion)) in self.bodies.iter_mut().zip(&mut self.rigid).enumerate() {
            if let Some(motion) = motion {
                let dt = dt.f64();
                let rotation = motion.rotation(dt);
                let turn = Matrix::from_fn(|i, j| T::of(rotation.0[i][j]));
                for (p, particle) in body.particles.iter_mut().enumerate() {
                    let position = particle.position.space();
                    let moved = Vector::of(motion.moved(position, &rotation, dt));
                    let kind = if !moved.is_finite() {
                        Some(FaultKind::NotFinite)
                    } else {
                        particle.velocity = Vector::of(motion.velocity_at(position));
                        particle.position = moved;
                        particle.deformation = turn * particle.deformation;
                        escaped::<T, D, B>(particle, &self.lattice, self.domain).then_some(FaultKind::Escaped)
                    };
                    first = first.or(kind.map(|kind| Fault { body: i, particle: p, kind }));
                }
                motion.advance(dt);
            }
        }
        first
    }

    /// F = (I + L dt) F,  sigma = law(F)
    pub(super) fn strain(&mut self, dt: T) -> Result<(), StepError> {
        let start = Instant::now();
        let fault = self.each_particle(|body, particle, stencil, window, block| {
            let increment = Matrix::IDENTITY + stencil.velocity_gradient(window, block) * dt;
            let deformation = increment * particle.deformation;
            let jacobian = deformation.det();
            if !jacobian.is_finite() {
                return Err(FaultKind::NotFinite);
            }
            particle.deformation = deformation;
            if jacobian <= T::ZERO {
                return Err(FaultKind::Inverted);
            }
            let motion = Motion { deformation, jacobian, increment, stress: particle.stress };
            let (motion, stress) = body.respond(motion).ok_or(FaultKind::NoThickness)?;
            (particle.deformation, particle.stress) = (motion.deformation, stress);
            particle.stress.is_finite().then_some(()).ok_or(FaultKind::NotFinite)
        });
        self.watch.lap("strain", start);
        fault.map_or(Ok(()), |fault| Err(self.error(&fault)))
    }

    fn error(&self, fault: &Fault) -> StepError {
        let body = &self.bodies[fault.body];
        let particle = &body.particles[fault.particle];
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

/// Whether a particle is outside the domain, or so far away that its cell has no number.
fn escaped<T: Real, const D: usize, B: Basis<T>>(
    particle: &Particle<T, D>,
    lattice: &Lattice<T, D>,
    domain: Option<[Vector<T, D>; 2]>,
) -> bool {
    let outside = domain.is_some_and(|[min, max]| {
        (0..D).any(|i| particle.position[i] < min[i] || particle.position[i] > max[i])
    });
    outside || !addressable(Stencil::<T, D, B>::new(lattice, particle).base())
}
