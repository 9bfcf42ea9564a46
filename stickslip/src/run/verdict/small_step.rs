//! Steps that shrink without end.

use super::{Check, CheckInputs, Finding};
use crate::scene::HealthCheck;

/// Holds the step that is allowed against the first one: below the bound a run no longer comes forward.
pub(super) struct SmallStepCheck;

impl Check for SmallStepCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::SmallStep
    }

    fn advice(&self) -> &'static str {
        "a particle is far too fast or far too compressed: look at the last frame with --color velocity; try smaller \
         cells, a smaller time.courant, a stiffer material"
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        let ([step, first], bound) = (look.steps, look.bound(self.kind()));
        let share = step / first;
        if share.is_nan() || share >= bound {
            return Vec::new();
        }
        let message = format!(
            "steps have shrunk to {step:.2e} s, {share:.1e} of the first one, where {bound} is allowed"
        );
        // The smallest share is the worst.
        vec![Finding { body: None, position: None, worst: 1.0 / share, message }]
    }
}
