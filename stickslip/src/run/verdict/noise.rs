//! Energy that became noise and was damped, though the scene asks for no damping.

use super::{Check, CheckInputs, Finding, asks_for_damping};
use crate::scene::{BasisKind, HealthCheck, Scene};
use crate::transfer::pic_share;

/// Holds what damping took from bodies that deform against the bound on it; what rigid bodies lose in impacts, which is
/// booked with it, became no noise. `rflip` takes noise from particles' own rotation;
/// what it takes came from motion that the grid did not carry on, so the ledger closes and the swing is gone.
pub(super) struct NoiseCheck;

impl Check for NoiseCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::Noise
    }

    fn advice(&self, scene: &Scene) -> &'static str {
        match scene.discretization.basis {
            BasisKind::Gimp | BasisKind::Linear => {
                "what bends, twists, spins or rolls loses its motion to it: try smaller cells, smaller deflections; \
                 space.basis = \"cpdi\" keeps more of a swing in place, hardly more of rolling; see the column `damping` of \
                 energy.csv"
            }
            BasisKind::Cpdi | BasisKind::Cubic => {
                "what bends, twists, spins or rolls loses its motion to it: try smaller cells, smaller deflections; see \
                 the column `damping` of energy.csv"
            }
            BasisKind::Spline => {
                "what bends, twists, spins or rolls loses its motion to it: try smaller cells, smaller deflections, \
                 space.basis = \"gimp\", by which what rolls or swings loses less than by splines; see the column \
                 `damping` of energy.csv"
            }
        }
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        let damping = look.ledger.damping - look.ledger.impacts;
        let scale = look.balance.scale;
        let part = damping / scale;
        let time = &look.scene.time;
        let takes_velocities = pic_share(time.transfer, time.pic_share) > 0.0;
        let wanted = takes_velocities || asks_for_damping(look.scene);
        if wanted || part.is_nan() || part.abs() <= look.bound(self.kind()) {
            return Vec::new();
        }
        let message = format!(
            "energy becomes noise: damping, which the scene does not ask for, {} {:.2e} J, {:.1} % of the most that \
             there was",
            if damping > 0.0 { "took" } else { "gave" },
            damping.abs(),
            100.0 * part.abs()
        );
        vec![Finding { body: None, position: None, worst: part, message }]
    }
}
