//! Momentum of all bodies that nothing from outside explains.

use super::negligible::Negligible;
use super::{Check, CheckInputs, Finding, asks_for_damping, exceeds, minus, norm, place, share};
use crate::door::{BodyState, Ledger, View};
use crate::observe::{Memory, OutputError};
use crate::scene::{Body, ContactLaw, Face, HealthCheck, Normal, Scene, Spring};
use serde::{Deserialize, Serialize};

/// Holds the momentum of all bodies that forces move against what acted on them from outside:
///
/// ```text
/// |p(t) - p(0) - J(t)| / max(|m g t| + sum |J_i|, sum over bodies of M v_rms)
///
///     J_i: loads, supports, joints to the ground or to prescribed bodies, contact with prescribed bodies, values written
///     between steps
/// ```
/// with magnitudes, for what holds a body against gravity leaves next to nothing of the sum,
/// along the axes along which no face of the domain acts. Where the same of one body alone, with what other bodies gave
/// it in J, is at least half of that, it is named.
#[derive(Default)]
pub(super) struct MomentumCheck(MomentumBalance);

/// What is known of momenta since the start.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct MomentumBalance {
    account: Option<Account>,
    /// Of each body that forces move; empty until the first look.
    bodies: Vec<Account>,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Account {
    /// p(0) - J(0) [kg m/s].
    start: [f64; 3],
    /// Impulse of gravity so far [N s].
    weight: [f64; 3],
    /// Time [s] and weight [N] at the last look.
    time: f64,
    force: [f64; 3],
    /// Largest of what it is held against, of all bodies together [kg m/s].
    scale: f64,
}

/// Bodies, and what moves them.
pub(super) struct Moving<'a> {
    pub scene: &'a Scene,
    pub view: &'a dyn View,
    pub ledger: &'a Ledger,
    pub bodies: &'a [BodyState],
    pub negligible: &'a Negligible,
}

/// Momentum that is missing.
pub(super) struct Missing {
    /// How much [kg m/s].
    momentum: f64,
    /// The same over the most that there was [-].
    pub share: f64,
    /// The body that accounts for half of it or more.
    body: Option<usize>,
}

/// Part of what is missing that a body accounts for, to be named.
const MOST_OF_IT: f64 = 0.5;

impl Account {
    /// What is missing now, where `momentum` is that which gravity does not explain [kg m/s], and `force` the weight
    /// [N].
    fn missing(&mut self, momentum: [f64; 3], (time, force): (f64, [f64; 3])) -> [f64; 3] {
        let elapsed = time - self.time;
        self.weight = add(self.weight, add(force, self.force).map(|twice| 0.5 * elapsed * twice));
        (self.time, self.force) = (time, force);
        [0, 1, 2].map(|i| momentum[i] - self.weight[i] - self.start[i])
    }
}

impl MomentumBalance {
    /// What is missing now; none along axes along which something unknown may act.
    pub(super) fn update(&mut self, now: &Moving) -> Option<Missing> {
        let axes = free_axes(now.scene);
        // Damping slows bodies down relative to the grid, as it should.
        if asks_for_damping(now.scene) || axes == [false; 3] {
            return None;
        }
        let along = |vector: [f64; 3]| [0, 1, 2].map(|i| if axes[i] { vector[i] } else { 0.0 });
        let time = now.view.time();
        let gravity = now.scene.gravity.constant().unwrap_or_default();
        let moved: Vec<usize> = moved(now.scene).collect();
        let (given, passed) = impulses(now);
        let outside = moved.iter().fold([0.0; 3], |sum, &i| add(sum, given[i]));

        let mass: f64 = moved.iter().map(|&i| now.bodies[i].mass).sum();
        let held = minus(add(now.ledger.momentum, now.ledger.removed_momentum), outside);
        let weight = (time, gravity.map(|g| mass * g));
        let (start, force) = (held, weight.1);
        let account =
            self.account.get_or_insert_with(|| Account { start, time, force, ..Account::default() });
        let missing = along(account.missing(held, weight));
        let size = |&i: &usize| {
            let state = &now.bodies[i];
            (2.0 * state.mass * state.kinetic).sqrt() + now.negligible.momentum(i, state)
        };
        let size: f64 = moved.iter().map(size).sum();
        let through: f64 = passed.into_iter().map(|impulse| norm(along(impulse))).sum();
        account.scale = account.scale.max(size).max(norm(along(account.weight)) + through);
        let (momentum, scale) = (norm(missing), account.scale);

        let removed = now.view.removed();
        let begun = !self.bodies.is_empty();
        self.bodies.resize_with(now.bodies.len(), Account::default);
        let mut most = (MOST_OF_IT * momentum, None);
        for i in moved {
            let state = &now.bodies[i];
            let gone = removed.get(i).map_or([0.0; 3], |removed| removed.momentum);
            let held = minus(add(state.velocity.map(|v| state.mass * v), gone), given[i]);
            let force = gravity.map(|g| state.mass * g);
            if !begun {
                self.bodies[i] = Account { start: held, time, force, ..Account::default() };
            }
            let own = along(self.bodies[i].missing(held, (time, force)));
            // Along what is missing of all.
            let part = (0..3).map(|k| own[k] * missing[k]).sum::<f64>() / momentum;
            if part >= most.0 {
                most = (part, Some(i));
            }
        }
        Some(Missing { momentum, share: share(momentum, scale), body: most.1 })
    }
}

impl Check for MomentumCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::Momentum
    }

    fn advice(&self, scene: &Scene) -> &'static str {
        if scene.bodies.iter().all(Body::is_rigid) {
            return "try a smaller time.courant";
        }
        "two bodies should push each other alike: take normal = \"common\" in [[contact]]; smaller cells, a smaller \
         time.courant"
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        let CheckInputs { scene, simulation: view, ledger, bodies, negligible, .. } = *look;
        let Some(missing) = self.0.update(&Moving { scene, view, ledger, bodies, negligible }) else {
            return Vec::new();
        };
        let Missing { momentum, share, body } = missing;
        let bound = look.bound(self.kind());
        if !exceeds(share, bound) {
            return Vec::new();
        }
        let position = body.map(|body| bodies[body].position);
        let most = body.zip(position).map_or_else(String::new, |(body, position)| {
            format!("; most of it is `{}`'s, at {}", scene.bodies[body].name, place(position))
        });
        let message = format!(
            "the momentum of all bodies is off by {momentum:.2e} kg m/s, {:.1} % of the most that there was, from what \
             acts on them from outside, where {:.3} % is allowed{most}",
            100.0 * share,
            100.0 * bound
        );
        vec![Finding { body, position, worst: share, message }]
    }

    fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("account", &mut self.0.account)?;
        memory.keep("bodies", &mut self.0.bodies)?;
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

/// Impulse on each body since the start, but for gravity, and those that come from outside one by one [N s].
fn impulses(now: &Moving) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
    let (scene, view) = (now.scene, now.view);
    let mut given = vec![[0.0; 3]; now.bodies.len()];
    let mut passed = Vec::new();
    let prescribed = |body: usize| scene.bodies[body].is_prescribed();
    let mut give = |body: usize, impulse: [f64; 3]| given[body] = add(given[body], impulse);
    for (load, state) in scene.loads.iter().zip(view.loads()) {
        give(load.body, state.impulse);
        passed.push(state.impulse);
    }
    for (body, written) in view.written().iter().enumerate() {
        give(body, written.momentum);
        passed.push(written.momentum);
    }
    let joints = view.joints();
    for (joint, state) in scene.joints.iter().zip(&joints) {
        give(joint.body, state.impulse);
        if let Some(to) = joint.to {
            give(to, state.impulse.map(|j| -j));
        }
        if joint.to.is_none_or(prescribed) || prescribed(joint.body) {
            passed.push(state.impulse);
        }
    }
    for (spring, state) in scene.springs.iter().zip(joints.iter().skip(scene.joints.len())) {
        let [from, to] = [0, 1].map(|side| spring.ends[side].body);
        give(from, state.impulse);
        give(to, state.impulse.map(|j| -j));
    }
    for contact in view.contact_sums() {
        // The impulse of the first body on the second.
        let [first, second] = contact.bodies;
        give(first, contact.impulse.map(|j| -j));
        give(second, contact.impulse);
        if contact.bodies.into_iter().any(prescribed) {
            passed.push(contact.impulse);
        }
    }
    (given, passed)
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + b[i])
}
