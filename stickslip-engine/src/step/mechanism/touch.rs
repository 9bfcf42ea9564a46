//! Contact of rigid bodies with each other: pushes and friction that are found together with joints.

use super::row::Row;
use super::six::{Six, at};
use super::surfaces::{RigidContact, tangents};
use crate::contact::{RigidTouch, Rule};
use crate::tensor::{Real, Vector};
use serde::{Deserialize, Serialize};

/// Part of an overlap that a step takes away, where gravity would give as much speed over that way.
const RECOVERY: f64 = 0.2;

/// What two rigid bodies push each other with at a place: with this the next step begins to look for its own.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub struct TouchForce {
    /// Indices of the bodies, the smaller first.
    pub bodies: [usize; 2],
    /// Where [m].
    pub place: [f64; 3],
    /// On the first body [N].
    pub force: [f64; 3],
}

/// A contact between two rigid bodies in a step. With the velocities v after the step, along its normal n and across,
///
/// ```text
/// n.v >= w,   l_n >= 0,   l_n (n.v - w) = 0,        |l_t| <= mu l_n, against the slip where they slip
/// ```
/// w = -gap / dt: the surfaces do not overlap after the step; where they would, and approach each other at the speed
/// v^n, w = e v^n with the coefficient of restitution e (Newton; Moreau 1988). Those that overlap part slowly.
#[derive(Clone, Debug)]
pub struct Touch {
    pub contact: RigidContact,
    /// Along the normal, and across it.
    pub normal: Row,
    pub tangents: Vec<Row>,
    /// Coefficient of friction in this step.
    pub friction: f64,
    /// Speed along the normal at which they part, w [m/s].
    pub parting: f64,
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
        let bounces = approach * dt > contact.gap && approach > 0.0 && rule.restitution > 0.0;
        let parting = if bounces {
            rule.restitution * approach
        } else if contact.gap > 0.0 {
            -contact.gap / dt
        } else {
            // No faster than what falls by as much, or an overlap would be a store of energy.
            (RECOVERY * -contact.gap / dt).min((-contact.gap * gravity).sqrt())
        };
        Touch {
            contact,
            normal: row(contact.normal),
            tangents: tangents(contact.normal, dimension).into_iter().map(row).collect(),
            friction: rule.friction.coefficient(T::of(slip)).f64(),
            parting,
        }
    }

    /// Lets it begin with a part of an impulse that is likely [N s].
    pub fn expect(&mut self, impulse: [f64; 3]) {
        let along = |row: &Row| Vector(super::six::parts(row.directions[0])[0]).dot(Vector(impulse));
        self.normal.impulse += along(&self.normal).max(0.0);
        // Where normals have turned, a part of a push is along the surface.
        if self.friction > 0.0 {
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

    /// What it pushes the first body with in a step of `dt` [s], if it does.
    pub fn force(&self, dt: f64) -> Option<TouchForce> {
        let RigidTouch { bodies, push, rub, place, .. } = self.sum(0.0);
        let force = ((Vector(push) + Vector(rub)) / dt).0;
        (self.normal.impulse > 0.0).then_some(TouchForce { bodies, place, force })
    }

    /// What it did in the step, with the work that friction took [J].
    pub fn sum(&self, friction: f64) -> RigidTouch {
        let push = Vector(self.contact.normal) * self.normal.impulse;
        let rub = self.tangents.iter().fold(Vector([0.0; 3]), |sum, row| {
            sum + Vector(super::six::parts(row.directions[0])[0]) * row.impulse
        });
        let RigidContact { bodies, place, .. } = self.contact;
        let (push, rub) = (push.0, rub.0);
        RigidTouch { bodies, push, rub, place, friction }
    }
}
