//! Dynamic relaxation that came to its end before the bodies were at rest.

use super::{Check, CheckInputs, EARLY, Finding};
use crate::scene::{HealthCheck, Interior, Scene};

/// Looks whether the bodies are at rest when the run ends.
pub(super) struct RelaxationCheck;

impl Check for RelaxationCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::Relaxation
    }

    fn advice(&self, scene: &Scene) -> &'static str {
        let mut bodies = 0..scene.bodies.len();
        // Particles that cross cells make forces of their own.
        match bodies.any(|i| !scene.bodies[i].is_rigid() && scene.interior(i) == Interior::Grid) {
            true => {
                "try interior = \"reference\" for bodies that stay whole, whose residual has no noise; a later \
                 time.end, a larger time.relax.residual; what nothing holds never comes to rest"
            }
            false => {
                "try a later time.end, a larger time.relax.residual; what nothing holds never comes to rest"
            }
        }
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        let (Some(state), Some(asked)) = (look.simulation.relaxation(), look.scene.time.relax) else {
            return Vec::new();
        };
        if state.at_rest || look.simulation.time() < look.scene.time.end * (1.0 - EARLY) {
            return Vec::new();
        }
        let message = format!(
            "the bodies are not at rest at the end: residual {:.2e} after {} peaks, where {:.0e} is asked for",
            state.residual, state.peaks, asked.residual
        );
        vec![Finding { body: None, position: None, worst: state.residual, message }]
    }
}
