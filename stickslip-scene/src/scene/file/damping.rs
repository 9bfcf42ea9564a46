//! `[damping]`: what slows the bodies down beside contact and materials.

use super::Context;
use super::quantity::{Measure, QuantityInput, Ratio};
use super::read::table;
use crate::scene;
use crate::scene::error::Fault;
use crate::scene::units::Powers;
use crate::scene::{MOST_BULK, Relaxation};

/// In one over seconds.
pub struct Rate;

impl Measure for Rate {
    const POWERS: [i8; 3] = [0, 0, -1];

    fn name() -> String {
        Powers::from(Self::POWERS).name()
    }

    fn example() -> String {
        "1 / 0.2 s".to_string()
    }
}

table! {
    /// What slows deformable bodies down beside contact and materials; by default nothing, with `time.relax` a little
    /// local damping.
    Damping {
        /// Rate alpha [1/s] of a force f = -alpha m v at every node, relative to the grid at rest (mass-proportional
        /// Rayleigh damping): a free body loses its velocity as exp(-alpha t).
        #[schemars(extend("default" = 0))]
        viscous: Option<QuantityInput<Rate>>,
        /// Part lambda, 0 to below 1, of the unbalanced force at a node that acts against its velocity, component by
        /// component: f_d = -lambda |f| sign(v) (Cundall 1987). Forces in balance are left alone. By default 0, with
        /// `time.relax` 0.05.
        local: Option<QuantityInput<Ratio>>,
        /// Bulk viscosity c_1, 0 to 1, of the first power of the rate of compression: a pressure
        /// rho h c_1 c d, with the wave speed c and d = max(-tr L, 0) (Landshoff 1955). 0.06 is usual: it takes the
        /// noise behind a shock.
        #[schemars(extend("default" = 0))]
        bulk_linear: Option<QuantityInput<Ratio>>,
        /// Bulk viscosity c_2, 0 to 10, of its second power: a pressure rho h^2 c_2 d^2 (von Neumann and Richtmyer
        /// 1950). 1.5 is usual: it spreads a strong shock over a few cells.
        #[schemars(extend("default" = 0))]
        bulk_quadratic: Option<QuantityInput<Ratio>>,
    }
}

impl Damping {
    /// Damping in SI units, of a scene that looks for a state at rest or does not.
    pub fn resolve(&self, context: &Context, relax: Option<Relaxation>) -> Result<scene::Damping, Fault> {
        let mut damping = scene::Damping::of(relax);
        if let Some(rate) = &self.viscous {
            damping.viscous = rate.checked(context, "a rate [1/s] from 0 on", |value| value >= 0.0)?;
        }
        if let Some(share) = &self.local {
            let allowed = "a number from 0 to below 1";
            damping.local = share.checked(context, allowed, |value| (0.0..1.0).contains(&value))?;
        }
        let bulk = [(&self.bulk_linear, MOST_BULK[0]), (&self.bulk_quadratic, MOST_BULK[1])];
        for (written, (coefficient, most)) in bulk.into_iter().enumerate() {
            if let Some(coefficient) = coefficient {
                let allowed = format!("a number from 0 to {most}");
                damping.bulk[written] =
                    coefficient.checked(context, &allowed, |value| (0.0..=most).contains(&value))?;
            }
        }
        Ok(damping)
    }
}
