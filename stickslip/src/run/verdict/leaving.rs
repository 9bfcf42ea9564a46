//! Particles that left the domain and were taken out.

use super::{Check, CheckInputs, Finding, place};
use crate::observe::{Memory, OutputError};
use crate::scene::{HealthCheck, Scene};

/// Tells of each body that loses particles, at each look at which it has lost more.
#[derive(Default)]
pub(super) struct LeavingCheck {
    /// How many each body had lost at the last look.
    known: Vec<u64>,
}

impl Check for LeavingCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::Leaving
    }

    fn advice(&self, _: &Scene) -> &'static str {
        "the run goes on without them; if none should leave, make the domain larger or put a face in the way"
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        let removed = look.simulation.removed();
        self.known.resize(removed.len(), 0);
        let mut findings = Vec::new();
        for (body, (removed, known)) in removed.iter().zip(&mut self.known).enumerate() {
            if std::mem::replace(known, removed.count) == removed.count {
                continue;
            }
            let name = &look.scene.bodies[body].name;
            let left = if look.bodies[body].mass == 0.0 { ", all that there were" } else { "" };
            let message = format!(
                "{} particles of `{name}` left the domain and were taken out{left}, {:.3e} kg, the first at t = {:.4e} s \
                 near {}",
                removed.count,
                removed.mass,
                removed.time,
                place(removed.place)
            );
            let worst = removed.count as f64;
            findings.push(Finding { body: Some(body), position: Some(removed.place), worst, message });
        }
        findings
    }

    fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("known", &mut self.known)?;
        Ok(())
    }
}
