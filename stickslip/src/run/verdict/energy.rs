//! Energy that came from nowhere or went there.

use super::{Check, CheckInputs, Finding};
use crate::door::Ledger;

/// The total of the ledger against its start, over the largest energy so far that moved, was stored, was set free by
/// falling or turned to heat.
#[derive(Clone, Debug, Default)]
pub(super) struct EnergyBalance {
    first: Option<Ledger>,
    /// Energy gained since the start, lost if negative [J].
    pub drift: f64,
    /// What it is held against [J].
    pub scale: f64,
}

impl EnergyBalance {
    pub(super) fn update(&mut self, now: &Ledger) {
        let first = self.first.get_or_insert_with(|| now.clone());
        let heat = now.friction + now.adhesion + now.plastic + now.damping;
        // The zero of the potential energy is arbitrary.
        let fallen = (now.potential - first.potential).abs();
        self.scale = self.scale.max(now.kinetic + now.strain).max(heat).max(fallen);
        self.drift = now.total - first.total;
    }

    /// Drift over scale [-].
    pub(super) fn relative(&self) -> f64 {
        if self.scale > 0.0 { self.drift / self.scale } else { 0.0 }
    }
}

/// Holds the drift against the bound that the scene sets.
pub(super) struct EnergyCheck;

impl Check for EnergyCheck {
    fn kind(&self) -> &'static str {
        "energy"
    }

    fn advice(&self) -> &'static str {
        "try smaller cells, the gimp basis, a smaller time.courant; time.energy_drift sets what is allowed"
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        let bound = look.scene.time.energy_drift;
        let drift = look.balance.relative();
        if drift.is_nan() || drift.abs() <= bound {
            return Vec::new();
        }
        let message = format!(
            "energy {}: {:+.2e} J, {:+.1} % of the most that there was, where {} % is allowed",
            if drift > 0.0 { "comes from nowhere" } else { "is lost" },
            look.balance.drift,
            100.0 * drift,
            100.0 * bound
        );
        vec![Finding { body: None, position: None, worst: drift, message }]
    }
}
