//! Steps that shrink without end.

use super::{Check, CheckInputs, Finding};
use crate::observe::{Memory, OutputError};
use crate::scene::HealthCheck;

/// Holds the step that is allowed against the first one: below the bound a run no longer comes forward.
#[derive(Default)]
pub(super) struct SmallStepCheck {
    /// The stable step at the start [s].
    first: f64,
}

impl Check for SmallStepCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::SmallStep
    }

    fn advice(&self) -> &'static str {
        "a particle is far too fast or far too compressed: look at the last frame with --color velocity; try smaller \
         cells, a smaller time.courant, a stiffer material"
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        if self.first == 0.0 {
            self.first = look.step;
        }
        let (share, bound) = (look.step / self.first, look.bound(self.kind()));
        if share.is_nan() || share >= bound {
            return Vec::new();
        }
        let message = format!(
            "steps have shrunk to {:.2e} s, {share:.1e} of the first one, where {bound} is allowed",
            look.step
        );
        // The smallest share is the worst.
        vec![Finding { body: None, position: None, worst: 1.0 / share, message }]
    }

    fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("first", &mut self.first)?;
        Ok(())
    }
}
