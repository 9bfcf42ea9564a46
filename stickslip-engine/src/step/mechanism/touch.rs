//! Contact of rigid bodies with each other: pushes and friction that are found together with joints.

use super::row::Row;
use super::six::{Six, at};
use super::surfaces::{RigidContact, tangents};
use crate::contact::{Friction, RigidTouch, Rule};
use crate::tensor::{Real, Vector};
use serde::{Deserialize, Serialize};

/// Part of an overlap that a step takes away, where gravity would give as much speed over that way.
const RECOVERY: f64 = 0.2;

/// Surfaces slip whose speed of slip is more than this part of the largest speed that pushes make in a step; less is what
/// solving for these may leave over.
const SLIPS: f64 = 1e-5;
/// Surfaces that meet anew are at rest across if they slip by less than this part of the speed at which they meet.
const AT_REST: f64 = 1e-6;

/// What two rigid bodies push each other with at a place: with this the next step begins to look for its own.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub struct TouchForce {
    /// Indices of the bodies, the smaller first.
    pub bodies: [usize; 2],
    /// Where [m].
    pub place: [f64; 3],
    /// On the first body [N].
    pub force: [f64; 3],
    /// How fast the surfaces slipped at the end of the step; 0 where they stuck [m/s].
    pub slip: f64,
}

/// How fast surfaces slip that do not stick, where contacts make these speeds [m/s].
pub fn least_slip(touches: &[Touch]) -> f64 {
    SLIPS * touches.iter().map(Touch::speed).fold(0.0, f64::max)
}

/// A contact between two rigid bodies in a step. With the velocities v after the step, along its normal n and across,
///
/// ```text
/// n.v >= w,   l_n >= 0,   l_n (n.v - w) = 0
/// stick:    |l_t| <= mu_s l_n + c A dt
/// slip:      l_t  = mu(s) l_n + c A dt + eta A dt |v_t|,   against the slip
/// pull:      l_n >= -a A dt   where n.v >= max(w, 0)
/// ```
/// w = -gap / dt, without the slack that faces have: the surfaces do not overlap after the step; where they would, and
/// approach each other at the speed v^n, w = e v^n with the coefficient of restitution e (Newton; Moreau 1988). Those
/// that overlap part slowly.
/// mu(s), c, a, eta: see [`Friction`]; A: the contact's share of the area over which they touch. Surfaces that stuck at
/// the end of the step before bear the static coefficient, and so do those that come to rest; once they slip it is
/// that of their slip.
#[derive(Clone, Debug)]
pub struct Touch {
    pub contact: RigidContact,
    /// Along the normal, and across it.
    pub normal: Row,
    pub tangents: Vec<Row>,
    /// What it bears across, and against parting.
    pub grip: Grip,
    /// Speed along the normal at which they part, w [m/s].
    pub parting: f64,
    /// How its friction depends on the slip.
    law: Friction<f64>,
    /// Speeds with which they meet and, across, slip at the start of the step [m/s].
    start: [f64; 2],
    /// How fast they slip after it, 0 where they stick [m/s].
    slip: f64,
}

/// What the surfaces of a contact bear in a step beside a push.
#[derive(Clone, Copy, Debug, Default)]
pub struct Grip {
    /// Coefficient of friction.
    pub friction: f64,
    /// Shear without a push, c A dt [N s].
    pub cohesion: f64,
    /// Pull, a A dt [N s].
    pub adhesion: f64,
    /// Of viscosity, over the speed of slip: eta A dt [kg].
    pub drag: f64,
    /// How much slower than a pull holds them surfaces come together without a push, min(w, 0) [m/s].
    pub way_in: f64,
}

impl Grip {
    /// The largest impulse across the normal of surfaces that stick, pushed by an impulse or pulled [N s].
    #[inline(always)]
    pub fn strength(&self, push: f64) -> f64 {
        // What has no push has no friction, however rough.
        self.cohesion + if push > 0.0 { self.friction * push } else { 0.0 }
    }

    /// What opposes a slip that an impulse of `wanted` would stop [N s], where a contact yields by `yields` [1/kg]: all
    /// of it where they stick.
    #[inline(always)]
    pub fn borne(&self, wanted: f64, (push, yields): (f64, f64)) -> f64 {
        let strength = self.strength(push);
        if wanted <= strength {
            return wanted;
        }
        // l = strength + drag s,   s = yields (wanted - l)
        (strength + self.drag * yields * wanted) / (1.0 + self.drag * yields)
    }

    /// Whether nothing opposes slip.
    #[inline(always)]
    pub fn is_smooth(&self) -> bool {
        self.friction == 0.0 && self.cohesion == 0.0 && self.drag == 0.0
    }
}

impl Touch {
    /// A contact of bodies with these centres, places in the mechanism, and velocities at the start of the step.
    pub fn new<T: Real>(
        contact: RigidContact,
        rule: &Rule<T>,
        (slots, centers, start): ([Option<usize>; 2], [[f64; 3]; 2], [Six; 2]),
        (dimension, dt, gravity): (usize, f64, f64),
    ) -> Self {
        let row = |direction: [f64; 3]| {
            let arm = |side: usize| (Vector(contact.place) - Vector(centers[side])).0;
            Row::new(slots, [at(arm(0), direction), at(arm(1), direction.map(|x| -x))])
        };
        let relative = Vector(contact.relative([&start[0], &start[1]], centers));
        let approach = -relative.dot(Vector(contact.normal));
        let slip = (relative + Vector(contact.normal) * approach).norm();
        let law = rule.friction.double();
        let exposure = contact.area * dt;
        let gap = (contact.gap.abs() - contact.slack).max(0.0).copysign(contact.gap);
        let bounces = approach * dt > contact.gap && approach > 0.0 && rule.restitution > 0.0;
        let parting = if bounces {
            rule.restitution * approach
        } else if gap > 0.0 {
            -gap / dt
        } else {
            // No faster than what falls by as much, or an overlap would be a store of energy.
            (RECOVERY * -gap / dt).min((-gap * gravity).sqrt())
        };
        Touch {
            contact,
            normal: row(contact.normal),
            tangents: tangents(contact.normal, dimension).into_iter().map(row).collect(),
            grip: Grip {
                friction: law.at_rest,
                cohesion: law.cohesion * exposure,
                adhesion: law.adhesion * exposure,
                drag: law.viscosity * exposure,
                way_in: parting.min(0.0),
            },
            parting,
            law,
            start: [approach.abs(), slip],
            slip: 0.0,
        }
    }

    /// Says how fast its surfaces slipped at the end of the step before, if they touched: those that did not stick have
    /// the friction of their slip.
    pub fn slipped(&mut self, before: Option<f64>) {
        let [meeting, slip] = self.start;
        if before.map_or(slip > AT_REST * meeting, |before| before > 0.0) {
            self.slide(slip);
        }
    }

    /// Takes the friction of a slip [m/s].
    fn slide(&mut self, slip: f64) {
        (self.slip, self.grip.friction) = (slip, self.law.coefficient(slip));
    }

    /// The largest speed that its impulses make [m/s].
    pub fn speed(&self) -> f64 {
        self.rows().map(|row| (row.impulse * row.yields).abs()).fold(0.0, f64::max)
    }

    /// Looks at how fast its surfaces slip with the velocities found [m/s]: they stick if no faster than `least`. Says
    /// whether they began to slip, against less friction than they were taken to have.
    pub fn judge(&mut self, speed: f64, least: f64) -> bool {
        let (stuck, slips) = (self.slip == 0.0, speed > least);
        if stuck && slips {
            self.slide(speed);
        }
        self.slip = if slips { speed } else { 0.0 };
        stuck && slips && self.normal.impulse > 0.0 && self.law.kinetic != self.law.at_rest
    }

    /// Lets it begin with a part of an impulse that is likely [N s].
    pub fn expect(&mut self, impulse: [f64; 3]) {
        let along = |row: &Row| Vector(super::six::parts(row.directions[0])[0]).dot(Vector(impulse));
        let normal = along(&self.normal);
        self.normal.impulse += if self.grip.adhesion > 0.0 { normal } else { normal.max(0.0) };
        // Where normals have turned, a part of a push is along the surface.
        if !self.grip.is_smooth() {
            for row in &mut self.tangents {
                row.impulse += along(row);
            }
        }
    }

    /// Its equations.
    pub fn rows(&self) -> impl Iterator<Item = &Row> {
        std::iter::once(&self.normal).chain(&self.tangents)
    }

    /// Its equations, to change.
    pub fn rows_mut(&mut self) -> impl Iterator<Item = &mut Row> {
        std::iter::once(&mut self.normal).chain(&mut self.tangents)
    }

    /// Whether it gave bodies an impulse.
    pub fn acts(&self) -> bool {
        self.rows().any(|row| row.impulse != 0.0)
    }

    /// What it acts on the first body with in a step of `dt` [s], if it does.
    pub fn force(&self, dt: f64) -> Option<TouchForce> {
        let RigidTouch { bodies, push, rub, place, .. } = self.sum(0.0);
        let force = ((Vector(push) + Vector(rub)) / dt).0;
        self.acts().then_some(TouchForce { bodies, place, force, slip: self.slip })
    }

    /// What it did in the step, with the work that friction took [J].
    pub fn sum(&self, friction: f64) -> RigidTouch {
        let normal = self.normal.impulse;
        let push = Vector(self.contact.normal) * normal;
        let rub = self.tangents.iter().fold(Vector([0.0; 3]), |sum, row| {
            sum + Vector(super::six::parts(row.directions[0])[0]) * row.impulse
        });
        let RigidContact { bodies, place, .. } = self.contact;
        let (push, rub) = (push.0, rub.0);
        RigidTouch { bodies, push, rub, normal, place, friction }
    }
}
