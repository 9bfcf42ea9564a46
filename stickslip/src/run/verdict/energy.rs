//! Energy that came from nowhere or went there.

use super::{Check, CheckInputs, Finding, STEPS, exceeds, share};
use crate::door::Ledger;
use crate::scene::{BasisKind, HealthCheck, Scene};
use serde::{Deserialize, Serialize};

/// The total of the ledger against its start, over the largest energy so far that moved, was stored, was set free by
/// falling or turned to heat, and what is too little to be judged ([`super::negligible`]).
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct EnergyBalance {
    first: Option<Ledger>,
    /// Energy gained since the start, lost if negative, beyond what kinetic and strain energy differ by for being half
    /// a step apart [J].
    pub drift: f64,
    /// What it is held against [J].
    pub scale: f64,
}

impl EnergyBalance {
    /// Takes note of how large energies are, which are held to be no less than `least` [J].
    pub(super) fn weigh(&mut self, now: &Ledger, least: f64) {
        let first = self.first.get_or_insert_with(|| now.clone());
        let heat = now.friction + now.adhesion + now.plastic + now.damping;
        // The zero of the potential energy is arbitrary.
        let fallen = (now.potential - first.potential).abs();
        self.scale = self.scale.max(now.kinetic + now.strain).max(heat).max(fallen).max(least);
    }

    /// The drift now.
    pub(super) fn update(&mut self, now: &Ledger, least: f64) {
        self.weigh(now, least);
        let gained = self.first.as_ref().map_or(0.0, |first| now.total - first.total);
        self.drift = (gained.abs() - now.half_step).max(0.0).copysign(gained);
    }

    /// Drift over scale [-].
    pub(super) fn relative(&self) -> f64 {
        share(self.drift, self.scale)
    }
}

/// When energies are weighed between two looks. Looks come in step with what swings as often as they do or a multiple
/// of it, and would see all of it at the same instant of its swing, where there may be next to no energy.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct WeighingTimes {
    next: u64,
    count: u64,
}

/// By how much more than [`STEPS`] two weighings are apart: by parts of this that never repeat.
const SCATTER: f64 = 150.0;
/// The golden ratio's, whose multiples fill up the numbers from 0 to 1 most evenly.
const GOLDEN: f64 = 0.618_033_988_749_895;

impl WeighingTimes {
    /// Whether it is time after so many steps.
    pub(super) fn are_due(&self, steps: u64) -> bool {
        steps >= self.next
    }

    /// The same, and then the next one is another.
    pub(super) fn come(&mut self, steps: u64) -> bool {
        if !self.are_due(steps) {
            return false;
        }
        self.count += 1;
        self.next = steps + STEPS + (SCATTER * (self.count as f64 * GOLDEN).fract()) as u64;
        true
    }
}

/// Holds the drift against the bound that the scene sets.
pub(super) struct EnergyCheck;

impl Check for EnergyCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::Energy
    }

    fn advice(&self, scene: &Scene) -> &'static str {
        match scene.discretization.basis {
            BasisKind::Linear => {
                "try space.basis = \"gimp\", smaller cells, a smaller time.courant; health.energy sets what is allowed"
            }
            _ => "try smaller cells, a smaller time.courant; health.energy sets what is allowed",
        }
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        let bound = look.bound(self.kind());
        let drift = look.balance.relative();
        if !exceeds(drift.abs(), bound) {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// What swings with a period of any number of steps is seen near its peak.
    #[test]
    fn energies_are_weighed_at_all_instants_of_a_swing() {
        for period in 100..400 {
            let mut times = WeighingTimes::default();
            let swing = |step: u64| (std::f64::consts::PI * step as f64 / f64::from(period)).sin().powi(2);
            let seen = (0..100 * period as u64).filter(|&step| times.come(step)).map(swing);
            let most = seen.fold(0.0, f64::max);
            assert!(most > 0.9, "{period}: {most}");
        }
    }
}
