//! Momentum of all bodies that nothing from outside explains.

use super::{Check, CheckInputs, Finding, asks_for_damping, norm};
use crate::observe::{Memory, OutputError};
use crate::scene::{ContactLaw, Face, HealthCheck, Normal, Scene, Spring};
use serde::{Deserialize, Serialize};

/// Holds the momentum of all bodies that forces move against what acted on them from outside:
///
/// ```text
/// |p(t) - p(0) - J(t)| / max(|J|, sum over bodies of M v_rms),   J: gravity, loads, supports, joints to the ground or to
///                                                                prescribed bodies, contact with prescribed bodies
/// ```
/// along the axes along which no face of the domain acts.
#[derive(Default)]
pub(super) struct MomentumCheck {
    account: Option<Account>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Account {
    /// p(0) - J(0) [kg m/s].
    start: [f64; 3],
    /// Impulse of gravity so far [N s].
    weight: [f64; 3],
    /// Time [s] and weight [N] at the last look.
    time: f64,
    force: [f64; 3],
    /// Largest of what it is held against [kg m/s].
    scale: f64,
}

impl Check for MomentumCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::Momentum
    }

    fn advice(&self) -> &'static str {
        "two bodies should push each other alike: take normal = \"common\" in [[contact]]; smaller cells, a smaller \
         time.courant"
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        let axes = free_axes(look.scene);
        // Damping slows bodies down relative to the grid, as it should.
        if asks_for_damping(look.scene) || axes == [false; 3] {
            return Vec::new();
        }
        let along = |vector: [f64; 3]| [0, 1, 2].map(|i| if axes[i] { vector[i] } else { 0.0 });
        let (time, given) = (look.simulation.time(), outside(look));
        let mass: f64 = moved(look.scene).map(|i| look.bodies[i].mass).sum();
        let force = look.scene.gravity.constant().unwrap_or_default().map(|g| mass * g);
        let held = |weight: [f64; 3]| {
            let (momentum, gone) = (look.ledger.momentum, look.ledger.removed_momentum);
            [0, 1, 2].map(|i| momentum[i] + gone[i] - given[i] - weight[i])
        };
        let account = self.account.get_or_insert_with(|| Account {
            start: held([0.0; 3]),
            weight: [0.0; 3],
            time,
            force,
            scale: 0.0,
        });
        let elapsed = time - account.time;
        let mean = [0, 1, 2].map(|i| 0.5 * (force[i] + account.force[i]));
        account.weight.iter_mut().zip(mean).for_each(|(weight, mean)| *weight += elapsed * mean);
        (account.time, account.force) = (time, force);
        let now = held(account.weight);
        let speeds = moved(look.scene).map(|i| &look.bodies[i]);
        let size: f64 = speeds.map(|state| (2.0 * state.mass * state.kinetic).sqrt()).sum();
        let impulse = norm(along([0, 1, 2].map(|i| given[i] + account.weight[i])));
        account.scale = account.scale.max(size).max(impulse);
        let missing = norm(along([0, 1, 2].map(|i| now[i] - account.start[i])));
        let (share, bound) = (missing / account.scale, look.bound(self.kind()));
        if share.is_nan() || share <= bound {
            return Vec::new();
        }
        let message = format!(
            "the momentum of all bodies is off by {missing:.2e} kg m/s, {:.1} % of the most that there was, from what \
             acts on them from outside, where {:.3} % is allowed",
            100.0 * share,
            100.0 * bound
        );
        vec![Finding { body: None, position: None, worst: share, message }]
    }

    fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("account", &mut self.account)?;
        Ok(())
    }
}

/// Bodies that forces move.
fn moved(scene: &Scene) -> impl Iterator<Item = usize> {
    (0..scene.bodies.len()).filter(|&i| !scene.bodies[i].is_prescribed())
}

/// Axes along which nothing acts that is not booked: a mirror acts across itself, a fixed face in all directions. The
/// paper's own contact, with a normal for each body, pushes two bodies unlike by what their normals differ.
fn free_axes(scene: &Scene) -> [bool; 3] {
    let faces = scene.domain.as_ref().map_or([[Face::Open; 2]; 3], |domain| domain.faces);
    let unlike = scene.contact.iter().any(|rule| rule.normal == Normal::Own && rule.law != ContactLaw::None);
    let fixed = faces.as_flattened().contains(&Face::Fixed);
    // What these do between two looks is not known here.
    let driven = |spring: &Spring| spring.ends.iter().any(|end| scene.bodies[end.body].is_prescribed());
    let unknown = scene.gravity.constant().is_none() || scene.springs.iter().any(driven);
    faces.map(|faces| {
        !unlike && !fixed && !unknown && faces.iter().all(|face| matches!(face, Face::Open | Face::Periodic))
    })
}

/// Impulse from outside on all bodies that forces move since the start, but for gravity [N s].
fn outside(look: &CheckInputs) -> [f64; 3] {
    let mut sum = [0.0; 3];
    let mut add = |impulse: [f64; 3], sign: f64| (0..3).for_each(|i| sum[i] += sign * impulse[i]);
    let is_outside = |body: usize| look.scene.bodies[body].is_prescribed();
    look.simulation.loads().iter().for_each(|load| add(load.impulse, 1.0));
    for (joint, state) in look.scene.joints.iter().zip(look.simulation.joints()) {
        if joint.to.is_none_or(is_outside) {
            add(state.impulse, 1.0);
        }
    }
    for contact in look.simulation.contact_sums() {
        // The impulse of the first body on the second.
        match contact.bodies.map(is_outside) {
            [true, false] => add(contact.impulse, 1.0),
            [false, true] => add(contact.impulse, -1.0),
            _ => {}
        }
    }
    sum
}
