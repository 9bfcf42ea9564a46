//! Steps that shrink without end.

use super::{Check, CheckInputs, Finding, place};
use crate::door::StepLimit;
use crate::scene::{HealthCheck, Scene};

/// Holds the step that is allowed against the first one: below the bound a run no longer comes forward. Names who
/// allows no longer ones.
pub(super) struct SmallStepCheck;

impl Check for SmallStepCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::SmallStep
    }

    fn advice(&self, _: &Scene) -> &'static str {
        "a particle is far too fast or far too compressed: look at the last frame with --color velocity; try smaller \
         cells, a smaller time.courant, a stiffer material"
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        let ([step, first], bound) = (look.steps, look.bound(self.kind()));
        let share = step / first;
        // Where the first step takes no time, the loop over steps says so. One without end bounds nothing: all is at
        // rest.
        if first == 0.0 || first.is_infinite() || share >= bound {
            return Vec::new();
        }
        let shrunk = format!(
            "steps have shrunk to {step:.2e} s, {share:.1e} of the first one, where {bound} is allowed"
        );
        // The smallest share is the worst.
        let worst = 1.0 / share;
        let Some(StepLimit { body, particle, position }) = look.simulation.step_limit() else {
            return vec![Finding { body: None, position: None, worst, message: shrunk }];
        };
        let name = &look.scene.bodies[body].name;
        let who = match particle {
            Some(number) => format!("particle {number} of `{name}`"),
            None => format!("the rigid body `{name}`, which turns too fast"),
        };
        let message = format!("{shrunk}: {who}, at {}, allows no longer ones", place(position));
        vec![Finding { body: Some(body), position: Some(position), worst, message }]
    }
}
