//! Angular momentum lost or gained where no torque acts.

use super::{Check, CheckInputs, Finding, asks_for_damping, exceeds, minus, norm, share};
use crate::door::{BodyState, WrittenValues};
use crate::observe::{Memory, OutputError};
use crate::scene::{Face, HealthCheck, Scene, Transfer};
use crate::tensor::cross;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Holds angular momentum against its start: of each body that nothing but gravity has touched, about its own centre of
/// mass, and of all bodies where nothing from outside acts.
#[derive(Default)]
pub(super) struct SpinCheck {
    alone: Vec<Alone>,
    together: Option<Together>,
    begun: bool,
}

/// A body that nothing has touched yet.
#[derive(Serialize, Deserialize)]
struct Alone {
    body: usize,
    /// At the start.
    mass: f64,
    velocity: [f64; 3],
    angular_momentum: [f64; 3],
    time: f64,
    /// How often values had been written to it.
    written: u64,
}

/// Bodies that only act on each other.
#[derive(Serialize, Deserialize)]
struct Together {
    angular_momentum: [f64; 3],
    /// Sum of the bodies' own angular momenta and of the moments of their momenta about the centre of all, each counted
    /// positive, at most so far [kg m^2/s].
    scale: f64,
}

/// Energy of the turning over that of all motion about the centre of mass and of strain: below, a body does not turn,
/// it rings.
const TURNS: f64 = 0.01;
/// The same over the energy of the motion on the whole: below, the turning is round-off, or a push that is no more than
/// [`PUSHED`].
const ROUNDING: f64 = 1e-4;
/// Moment of a body's momentum over arm times momentum: below, bodies meet head on, and the moment is round-off.
const HEAD_ON: f64 = 1e-3;
/// Change of the velocity that gravity does not explain, over the speed of the particles: something else pushed.
const PUSHED: f64 = 1e-4;
/// Cells to a face that does something: nearer, a body may feel it.
const NEAR: f64 = 2.0;

impl Check for SpinCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::AngularMomentum
    }

    fn advice(&self, scene: &Scene) -> &'static str {
        match scene.time.transfer {
            Transfer::Rflip | Transfer::Apic => "try smaller cells; compare with another time.stress_update",
            _ => "try time.transfer = \"rflip\" or \"apic\", smaller cells",
        }
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        // Damping slows turning bodies down, as it should.
        if asks_for_damping(look.scene) {
            return Vec::new();
        }
        if !self.begun {
            self.begin(look);
            return Vec::new();
        }
        let touched: BTreeSet<usize> =
            look.simulation.patches().iter().flat_map(|patch| [patch.body_a, patch.body_b]).collect();
        let written = look.simulation.written();
        self.alone.retain(|alone| {
            alone.body < look.bodies.len() && !touched.contains(&alone.body) && alone.unpushed(look, &written)
        });
        let mut findings: Vec<_> = self.alone.iter().filter_map(|alone| alone.look(look)).collect();
        findings.extend(self.together.as_mut().and_then(|together| together.look(look)));
        findings
    }

    fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("alone", &mut self.alone)?;
        memory.keep("together", &mut self.together)?;
        memory.keep("begun", &mut self.begun)?;
        Ok(())
    }
}

impl SpinCheck {
    fn begin(&mut self, look: &CheckInputs) {
        self.begun = true;
        let (time, written) = (look.simulation.time(), look.simulation.written());
        let alone = |body: usize| {
            let state = &look.bodies[body];
            let (mass, velocity) = (state.mass, state.velocity);
            Alone {
                body,
                mass,
                velocity,
                angular_momentum: own(state),
                time,
                written: writes(&written, body),
            }
        };
        let pushed = |&body: &usize| look.scene.loads.iter().any(|load| load.body == body);
        // One that is joined to its own images turns against them.
        let joined = |&body: &usize| look.scene.joined_ends(body).iter().any(Option::is_some);
        self.alone = look.free().filter(|body| !pushed(body) && !joined(body)).map(alone).collect();
        if look.bodies.len() > 1 && isolated(look.scene) {
            self.together = Some(Together { angular_momentum: own_of_all(look), scale: 0.0 });
        }
    }
}

/// Nothing outside the bodies acts on them, and each force has its reaction at the same place: through a periodic face
/// that is a period away, and there the angular momentum of all is not conserved.
fn isolated(scene: &Scene) -> bool {
    let faces = scene.domain.iter().flat_map(|domain| domain.faces).flatten();
    scene.gravity.is_none()
        && scene.loads.is_empty()
        && scene.bodies.iter().all(|body| !body.is_rigid())
        && faces.into_iter().all(|face| face == Face::Open)
}

/// How often values were written to a body between steps.
fn writes(written: &[WrittenValues], body: usize) -> u64 {
    written.get(body).map_or(0, |written| written.count)
}

/// Angular momentum about the body's own centre of mass [kg m^2/s].
fn own(state: &BodyState) -> [f64; 3] {
    minus(state.angular_momentum, cross(state.position, state.velocity.map(|v| state.mass * v)))
}

impl Alone {
    fn unpushed(&self, look: &CheckInputs, written: &[WrittenValues]) -> bool {
        let Some(gravity) = look.scene.gravity.constant() else { return false };
        let state = &look.bodies[self.body];
        // What left the domain took its spin along, and what was written brings its own.
        if state.mass < self.mass || writes(written, self.body) != self.written {
            return false;
        }
        let fallen = look.simulation.time() - self.time;
        let push: [f64; 3] =
            std::array::from_fn(|i| state.velocity[i] - self.velocity[i] - gravity[i] * fallen);
        let speed = (2.0 * state.kinetic / state.mass).sqrt();
        norm(push) <= PUSHED * speed
            && !look.particles[self.body].iter().any(|particle| near_face(look.scene, particle.position))
    }

    fn look(&self, look: &CheckInputs) -> Option<Finding> {
        let state = &look.bodies[self.body];
        let now = own(state);
        let (before, after) = (norm(self.angular_momentum), norm(now));
        let change = share(norm(minus(now, self.angular_momentum)), before.max(after));
        // L^2 / 2 I, with I = m r^2 over the particles watched, which is right in the plane and large enough in space.
        let particles = &look.particles[self.body];
        if particles.is_empty() {
            return None;
        }
        let squares = particles.iter().map(|particle| norm(minus(particle.position, state.position)).powi(2));
        let inertia = state.mass * squares.sum::<f64>() / particles.len() as f64;
        let turning = 0.5 * before.max(after).powi(2) / inertia;
        let whole = 0.5 * state.mass * norm(state.velocity).powi(2);
        let least = 0.5 * state.mass * look.negligible.speed(self.body).powi(2);
        let rings = turning < TURNS * (state.kinetic - whole + state.strain);
        let rests = turning < least || turning < ROUNDING * whole;
        if rings || rests || !exceeds(change, look.bound(HealthCheck::AngularMomentum)) {
            return None;
        }
        let name = &look.scene.bodies[self.body].name;
        let message = format!(
            "angular momentum of `{name}` is off by {:.1} % though no torque acts on it",
            100.0 * change
        );
        Some(Finding { body: Some(self.body), position: Some(state.position), worst: change, message })
    }
}

impl Together {
    fn look(&mut self, look: &CheckInputs) -> Option<Finding> {
        let mass: f64 = look.bodies.iter().map(|state| state.mass).sum();
        let mean = |of: fn(&BodyState) -> [f64; 3]| {
            [0, 1, 2].map(|i| look.bodies.iter().map(|state| state.mass * of(state)[i]).sum::<f64>() / mass)
        };
        let (center, velocity) = (mean(|state| state.position), mean(|state| state.velocity));
        let size = |state: &BodyState| {
            let relative = minus(state.velocity, velocity).map(|v| state.mass * v);
            norm(own(state)) + norm(cross(minus(state.position, center), relative))
        };
        // Of bodies that meet head on, or fly side by side, arm and momentum have no moment but that of round-off.
        let most = |(body, state): (usize, &BodyState)| {
            let relative = minus(state.velocity, velocity).map(|v| state.mass * v);
            let whole = state.velocity.map(|v| state.mass * v);
            let momentum = (HEAD_ON * norm(relative)).max(ROUNDING * norm(whole));
            norm(minus(state.position, center)) * momentum.max(look.negligible.momentum(body, state))
        };
        let sizes = look.bodies.iter().enumerate().map(|(i, state)| size(state).max(most((i, state))));
        self.scale = self.scale.max(sizes.sum());
        let change = share(norm(minus(own_of_all(look), self.angular_momentum)), self.scale);
        if !exceeds(change, look.bound(HealthCheck::AngularMomentum)) {
            return None;
        }
        let message = format!(
            "angular momentum of all bodies is off by {:.1} % of the bodies' own though nothing outside acts",
            100.0 * change
        );
        Some(Finding { body: None, position: None, worst: change, message })
    }
}

/// Angular momentum of all bodies about the origin, with what left the domain and without what was written to them
/// between steps [kg m^2/s].
fn own_of_all(look: &CheckInputs) -> [f64; 3] {
    let (momentum, gone) = (look.ledger.angular_momentum, look.ledger.removed_angular_momentum);
    let written = look.simulation.written();
    [0, 1, 2].map(|i| {
        momentum[i] + gone[i] - written.iter().map(|written| written.angular_momentum[i]).sum::<f64>()
    })
}

fn near_face(scene: &Scene, x: [f64; 3]) -> bool {
    let Some(domain) = &scene.domain else { return false };
    let reach = NEAR * scene.discretization.cell;
    let acts = |face: Face| matches!(face, Face::Symmetry | Face::Fixed);
    (0..scene.dimension.axes()).any(|axis| {
        let [lower, upper] = domain.faces[axis];
        (acts(lower) && x[axis] < domain.min[axis] + reach)
            || (acts(upper) && x[axis] > domain.max[axis] - reach)
    })
}
