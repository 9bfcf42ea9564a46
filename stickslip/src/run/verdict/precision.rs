//! Steps that are lost in the rounding of positions.

use super::{Check, CheckInputs, Finding, norm};
use crate::observe::{Memory, OutputError};
use crate::scene::{self, HealthCheck, Scene};

/// Adds up the way of bodies whose steps are about as short as the spacing of numbers where they are.
#[derive(Default)]
pub(super) struct PrecisionCheck {
    /// Way that may be lost, body by body [m].
    doubtful: Vec<f64>,
    time: f64,
}

/// Spacings of numbers in a step: below, rounding takes or adds more than a tenth of each.
const SPACINGS: f64 = 5.0;

impl Check for PrecisionCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::Precision
    }

    fn advice(&self, _: &Scene) -> &'static str {
        "take space.precision = \"double\", or bring the bodies nearer to the origin"
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        let epsilon = match look.scene.precision {
            scene::Precision::Single => f64::from(f32::EPSILON),
            scene::Precision::Double => f64::EPSILON,
        };
        let begun = !self.doubtful.is_empty();
        self.doubtful.resize(look.bodies.len(), 0.0);
        let time = look.simulation.time();
        // The way since the last look; at the start, that of the whole run.
        let since = if begun { time - self.time } else { look.scene.time.end - time };
        self.time = time;
        let step = look.simulation.stable_step();
        let mut findings = Vec::new();
        for body in look.free() {
            let state = &look.bodies[body];
            let speed = norm(state.velocity);
            // Of many bodies not all have particles that are looked at.
            let places = look.particles[body].iter().map(|particle| particle.position);
            let farthest = places.chain([state.position]).flatten();
            let spacing = epsilon * farthest.map(f64::abs).fold(0.0, f64::max);
            let way = if speed * step < SPACINGS * spacing { speed * since } else { 0.0 };
            let doubtful = self.doubtful[body] + way;
            if begun {
                self.doubtful[body] = doubtful;
            }
            let cells = doubtful / look.scene.discretization.cell;
            if cells > look.bound(self.kind()) {
                let name = &look.scene.bodies[body].name;
                let message = format!(
                    "`{name}` moves by {:.2e} m a step where numbers are {spacing:.2e} m apart: \
                     rounding takes or adds a part of its way, or all",
                    speed * step
                );
                findings.push(Finding {
                    body: Some(body),
                    position: Some(state.position),
                    worst: cells,
                    message,
                });
            }
        }
        findings
    }

    fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("doubtful", &mut self.doubtful)?;
        memory.keep("time", &mut self.time)?;
        Ok(())
    }
}
