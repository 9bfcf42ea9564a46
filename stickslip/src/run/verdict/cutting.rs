//! Shorter steps where something drifts.

use super::energy::EnergyBalance;
use super::momentum::{MomentumBalance, Moving};
use super::negligible::Negligible;
use crate::door::View;
use crate::observe::{Memory, OutputError};
use crate::scene::{HealthCheck, Response, Scene};
use serde::{Deserialize, Serialize};

/// Asks for shorter steps where a drift goes beyond its bound and further still. It looks at times that follow from the
/// steps alone: no output changes a step.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct StepCutting<B> {
    balance: B,
    /// Largest relative drift for which steps were cut [-].
    worst: f64,
    asks: bool,
}

/// Steps are cut again where the drift has grown by this.
const WORSE: f64 = 1.1;

impl<B: Default> StepCutting<B> {
    /// That of a scene, if it wants any.
    fn of(scene: &Scene, check: HealthCheck) -> Option<Self> {
        (scene.health.response(check) == Response::CutStep).then(Self::default)
    }

    fn see(&mut self, drift: f64, bound: f64) {
        if drift > bound && drift > WORSE * self.worst {
            (self.worst, self.asks) = (drift, true);
        }
    }
}

/// What a scene wants steps to be cut for.
pub(super) struct StepCuttings {
    energy: Option<StepCutting<EnergyBalance>>,
    momentum: Option<StepCutting<MomentumBalance>>,
}

impl StepCuttings {
    pub(super) fn of(scene: &Scene) -> Self {
        StepCuttings {
            energy: StepCutting::of(scene, HealthCheck::Energy),
            momentum: StepCutting::of(scene, HealthCheck::Momentum),
        }
    }

    /// Looks at what drifts now.
    pub(super) fn look(&mut self, scene: &Scene, view: &dyn View, negligible: &Negligible) {
        let bound = |check| scene.health_bound(check);
        if let Some(cutting) = &mut self.energy {
            let ledger = view.ledger();
            cutting.balance.update(&ledger, negligible.energy(view, &ledger));
            cutting.see(cutting.balance.relative().abs(), bound(HealthCheck::Energy));
        }
        if let Some(cutting) = &mut self.momentum {
            let (ledger, bodies) = (view.ledger(), view.bodies());
            let moving = Moving { scene, view, ledger: &ledger, bodies: &bodies, negligible };
            let missing = cutting.balance.update(&moving).map_or(0.0, |missing| missing.share);
            cutting.see(missing, bound(HealthCheck::Momentum));
        }
    }

    /// Whether steps are to be shorter from now on; told once.
    pub(super) fn ask(&mut self) -> bool {
        let energy = self.energy.as_mut().map(|cutting| &mut cutting.asks);
        let momentum = self.momentum.as_mut().map(|cutting| &mut cutting.asks);
        let mut asked = false;
        energy.into_iter().chain(momentum).for_each(|asks| asked |= std::mem::take(asks));
        asked
    }

    /// Keeps what is known of the run so far, or takes that up.
    pub(super) fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        if let Some(cutting) = &mut self.energy {
            memory.keep("cutting", cutting)?;
        }
        if let Some(cutting) = &mut self.momentum {
            memory.keep("cutting by momentum", cutting)?;
        }
        Ok(())
    }
}
