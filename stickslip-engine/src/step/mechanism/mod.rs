//! Free rigid bodies, and joints between them.
//!
//! A free rigid body has six numbers, its momenta. Contact acts on it at the nodes, where it has one velocity for all of
//! them, v + w x r. Its new velocities and all impulses are found together ([`Coupling`]):
//!
//! ```text
//! M (V - V^n) = dt F + J(V) + G^T l,     g(x(V)) = 0
//! ```
//! V: velocities of all free bodies after the step, M: their inertia, F: gravity, loads and what joints push with,
//! J(V): impulses of contact with deformable bodies, as their laws give them against a rigid body that moves with V,
//! g = 0: what joints hold, at the end of the step, with their impulses l along the rows of G (SHAKE: Ryckaert, Ciccotti
//! and Berendsen 1977). So contact with a light body is as stable as with a heavy one, momentum is exchanged to
//! round-off, and joints do not drift.

mod conjugate;
mod corners;
mod coupling;
mod direct;
mod joint;
mod layers;
mod neighbours;
mod row;
mod six;
mod sparse;
mod surfaces;
mod sweeps;
mod touch;

pub use coupling::Coupling;
pub use joint::JointSums;
pub use surfaces::RigidSurfaces;

use super::Engine;
use super::loads::ForceOnBody;
use crate::body::Body;
use crate::contact::RigidTouch;
use crate::lanes::Laned;
use crate::rigid::RigidMotion;
use crate::scene::{JointKind, Motor};
use crate::tensor::{Vector, cross};
use joint::Link;
use neighbours::Neighbours;
use row::{JointRow, Row};
use six::{Six, SixMatrix, join};
use std::time::Instant;
use touch::Touch;
pub use touch::TouchForce;

/// A step turns free rigid bodies by so much at most [rad].
const TURN: f64 = 0.05;
/// The same of balls and disks in a packing, which touch wherever they have turned to.
const TURN_OF_BALLS: f64 = 0.5;

/// Free rigid bodies and joints in a step.
#[derive(Clone, Debug, Default)]
pub struct Mechanism {
    /// The free bodies, in the order of the scene.
    pub bodies: Vec<FreeBody>,
    /// The joints, in the order of the scene.
    links: Vec<Link>,
    /// Room for what joints hold.
    rows: Vec<JointRow>,
    /// Where rigid bodies touch each other.
    touches: Vec<Touch>,
    /// What they pushed each other with in the step before, in the order of pairs.
    before: Vec<TouchForce>,
    /// Which of them are near each other.
    neighbours: Neighbours,
    /// What they did to each other in the step.
    booked: Vec<RigidTouch>,
    /// When the step began [s].
    time: f64,
    /// Magnitude of gravity [m/s^2].
    gravity: f64,
}

/// A free rigid body in a step.
#[derive(Clone, Debug)]
pub struct FreeBody {
    /// Index of the body.
    pub index: usize,
    /// Velocities at the start of the step.
    start: Six,
    /// Momenta with all forces but those of contact and of what joints hold.
    target: Six,
    /// Momenta as found so far.
    momenta: Six,
    /// Inertia at the start of the step.
    inertia: SixMatrix,
    /// How far its points are from its centre, by its inertia [m]: speeds of turning count with this.
    radius: f64,
}

/// The place of a body among the free ones.
fn slot(bodies: &[FreeBody], body: usize) -> Option<usize> {
    bodies.binary_search_by_key(&body, |free| free.index).ok()
}

impl Mechanism {
    /// The place of a body among the free ones.
    fn slot(&self, body: usize) -> Option<usize> {
        slot(&self.bodies, body)
    }

    /// What rigid bodies did to each other in the step, once that was accounted for.
    pub fn booked(&self) -> &[RigidTouch] {
        &self.booked
    }

    /// How fast a unit impulse along a direction at an arm makes a free body there along it [1/kg]; not at all what is
    /// not free.
    pub fn yields(&self, body: usize, arm: [f64; 3], direction: [f64; 3]) -> f64 {
        let Some(slot) = self.slot(body) else { return 0.0 };
        let along = six::at(arm, direction);
        six::dot(&along, &self.bodies[slot].inertia.factor().solve(&along))
    }

    /// Gives a body an impulse at a place, if it is free, in a step of `dt` [s].
    pub fn push<T, const D: usize>(
        &mut self,
        bodies: &mut [Body<T, D>],
        (body, dt): (usize, f64),
        (place, impulse): ([f64; 3], [f64; 3]),
    ) {
        let Some(slot) = self.slot(body) else { return };
        let motion = bodies[body].motion.as_deref_mut().expect("free bodies are rigid");
        let arm = (Vector(place) - Vector(motion.center)).0;
        let free = &mut self.bodies[slot];
        six::add(&mut free.target, 1.0, &six::at(arm, impulse));
        free.momenta = free.target;
        motion.set_momenta(six::parts(free.target), dt);
    }
}

impl FreeBody {
    fn new(index: usize, motion: &RigidMotion) -> Option<Self> {
        let free = motion.as_free()?;
        let momenta = join(free.state.momentum, free.state.angular_momentum);
        let inertia = free.inertia();
        Some(FreeBody {
            index,
            start: join(motion.velocity(), motion.spin()),
            target: momenta,
            momenta,
            inertia: SixMatrix::inertia(free.mass, &inertia),
            radius: (inertia.trace() / free.mass).sqrt(),
        })
    }
}

impl FreeBody {
    /// How fast velocities are, those of turning by the body's radius [m/s].
    fn size(&self, velocities: &Six) -> f64 {
        let [v, w] = six::parts(*velocities).map(|part| Vector(part).norm());
        v + w * self.radius
    }

    /// How fast the body is now [m/s].
    fn speed<T, const D: usize>(&self, bodies: &[Body<T, D>]) -> f64 {
        let motion = bodies[self.index].motion.as_deref().expect("it is rigid");
        self.size(&join(motion.velocity(), motion.spin()))
    }

    /// How much speed the pushes of the step alone give it [m/s].
    fn pushed(&self) -> f64 {
        let begun = self.inertia.times(&self.start);
        let gained = std::array::from_fn(|k| self.target[k] - begun[k]);
        self.size(&self.inertia.factor().solve(&gained))
    }
}

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Takes up the free bodies as they are, before the step's first contact.
    pub(super) fn find_free_bodies(&mut self) {
        if self.settings.free.is_empty() {
            return;
        }
        let gravity = self.gravity(T::ZERO).norm().f64();
        let bodies = &self.state.bodies;
        let of = |index: usize| FreeBody::new(index, bodies[index].motion.as_deref()?);
        let mechanism = &mut self.workspace.mechanism;
        mechanism.time = self.state.time;
        mechanism.gravity = gravity;
        mechanism.before.clone_from(&self.state.touch_forces);
        mechanism.bodies.clear();
        mechanism.bodies.extend(self.settings.rigid.iter().filter_map(|&body| of(body)));
        mechanism.links.clear();
        mechanism.links.extend(self.settings.joints.iter().map(|joint| Link::new(joint, bodies)));
    }

    /// Gravity, loads, what joints push with and the layers of bodies on grids of their own change the momenta of free
    /// rigid bodies.
    pub(super) fn push_free_bodies(&mut self, dt: T) {
        if self.workspace.mechanism.bodies.is_empty() {
            return;
        }
        let start = Instant::now();
        let gravity = self.gravity(dt).space();
        let loaded = self.settings.loads.iter().any(|load| self.settings.free[load.body]);
        let forces = if loaded { self.forces_on_free_bodies() } else { Vec::new() };
        let mechanism = &mut self.workspace.mechanism;
        let (dt, time) = (dt.f64(), self.state.time);
        let bodies = &mut self.state.bodies;
        let mut impulses = vec![[0.0; 6]; mechanism.bodies.len()];
        let slot = |body: usize| slot(&mechanism.bodies, body);
        for ForceOnBody { body, force, place, .. } in forces {
            let (Some(slot), Some(motion)) = (slot(body), &bodies[body].motion) else { continue };
            let arm = (Vector(place) - Vector(motion.center)).0;
            six::add(&mut impulses[slot], dt, &six::at(arm, force));
        }
        for (i, joint) in self.settings.joints.iter().enumerate() {
            let sums = &self.state.joints[i];
            let pushes = mechanism.links[i].push(joint, bodies, (time, dt), sums.way);
            for (body, push) in [Some(joint.body), joint.to].into_iter().zip(pushes) {
                if let Some(slot) = body.and_then(slot) {
                    six::add(&mut impulses[slot], 1.0, &push);
                }
            }
        }
        let touches = (&self.workspace.reference_touching.touches[..], dt);
        self.workspace.reference_touching.rate = mechanism.add_layers(bodies, touches, &mut impulses);
        for (free, impulse) in mechanism.bodies.iter_mut().zip(&impulses) {
            let motion = bodies[free.index].motion.as_deref_mut().expect("free bodies are rigid");
            // After contact on the interpolated velocities, if there was any.
            let state = motion.as_free().expect("it is free").state;
            free.target = join(state.momentum, state.angular_momentum);
            let weight = free.inertia.times(&join(gravity, [0.0; 3]));
            six::add(&mut free.target, dt, &weight);
            six::add(&mut free.target, 1.0, impulse);
            free.momenta = free.target;
            motion.set_momenta(six::parts(free.target), dt);
        }
        self.watch.lap("mechanism", start);
    }

    /// The longest step in which no free rigid body, and no motor of a joint, turns by more than a part of a radian [s].
    pub(super) fn longest_turn(&self) -> f64 {
        let motors = self.settings.joints.iter().map(|joint| match &joint.kind {
            JointKind::Hinge { motor: Motor { speed: Some(speed), .. }, .. }
            | JointKind::Planar { motor: Motor { speed: Some(speed), .. }, .. } => {
                speed.at(self.state.time).abs()
            }
            _ => 0.0,
        });
        let motors = TURN / motors.fold(0.0, f64::max);
        self.longest_turns().map(|(_, longest)| longest).fold(motors, f64::min)
    }

    /// The free rigid bodies, each with the longest step by how fast it turns [s].
    pub(super) fn longest_turns(&self) -> impl Iterator<Item = (usize, f64)> {
        let packed = self.settings.joints.is_empty()
            && self.needs_no_grid()
            && sweeps::many(self.state.touch_forces.len());
        let motions =
            self.settings.rigid.iter().map(|&body| (body, self.state.bodies[body].motion.as_deref()));
        let free =
            motions.filter_map(|(body, motion)| Some((body, motion.filter(|it| it.as_free().is_some())?)));
        free.map(move |(body, motion)| {
            let turn = if packed && self.settings.surfaces.is_ball(body) { TURN_OF_BALLS } else { TURN };
            (body, turn / Vector(motion.spin()).norm())
        })
    }

    /// Books what joints and the contacts of rigid bodies did in the step, once velocities are known. Works are those of
    /// impulses on the mean of the velocities before and after, which is what they change of the kinetic energy.
    pub(super) fn account_mechanism(&mut self, dt: T) {
        let mechanism = &mut self.workspace.mechanism;
        mechanism.booked.clear();
        if mechanism.bodies.is_empty() {
            return;
        }
        let mut booked = std::mem::take(&mut mechanism.booked);
        let mechanism = &*mechanism;
        let bodies = &self.state.bodies;
        let mean = |body: usize| {
            let motion =
                bodies[body].motion.as_deref().expect("joints and these contacts are of rigid bodies");
            let after = join(motion.velocity(), motion.spin());
            match mechanism.slot(body) {
                Some(slot) => std::array::from_fn(|k| 0.5 * (mechanism.bodies[slot].start[k] + after[k])),
                None => after,
            }
        };
        self.state.touch_forces.clear();
        let forces = mechanism.touches.iter().filter_map(|touch| touch.force(dt.f64()));
        self.state.touch_forces.extend(forces);
        let mut work = 0.0;
        for touch in mechanism.touches.iter().filter(|touch| touch.acts()) {
            let means = touch.contact.bodies.map(mean);
            let works =
                |row: &Row| [0, 1].map(|side| row.impulse * six::dot(&row.directions[side], &means[side]));
            let lost = |row: &Row| -works(row).iter().sum::<f64>();
            let rubbed: f64 = touch.tangents.iter().map(lost).sum();
            let parted = lost(&touch.normal);
            if touch.normal.impulse > 0.0 {
                self.state.damping += parted;
                self.state.impacts += parted;
            } else {
                // Bonds that give way.
                self.state.contact_sums.adhesion += parted;
            }
            // What prescribed bodies put in.
            for row in touch.rows() {
                let prescribed = (0..2).filter(|side| row.bodies[*side].is_none());
                work -= prescribed.map(|side| works(row)[side]).sum::<f64>();
            }
            booked.push(touch.sum(rubbed));
        }
        self.state.contact_sums.work += work;
        for (i, joint) in self.settings.joints.iter().enumerate() {
            let (link, sums) = (&mechanism.links[i], &mut self.state.joints[i]);
            link.book(sums, |side| {
                let body = [Some(joint.body), joint.to][side]?;
                mechanism.slot(body).map(|_| mean(body))
            });
            sums.measure(joint, bodies, dt.f64());
        }
        self.workspace.mechanism.booked = booked;
    }
}

/// Velocity of a rigid body at a point [m/s].
fn velocity_at(velocities: &Six, arm: [f64; 3]) -> [f64; 3] {
    let [v, w] = six::parts(*velocities);
    let turn = cross(w, arm);
    std::array::from_fn(|i| v[i] + turn[i])
}
