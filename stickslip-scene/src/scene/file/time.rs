//! `[time]`: duration and time step.

use super::Context;
use super::quantity::{Duration, QuantityInput, Ratio};
use super::read::table;
use super::text::{Choice, Count, Word};
use crate::scene::error::Fault;
use crate::scene::{self, Relaxation, StressUpdate, Transfer};

table! {
    /// Duration and time step.
    Time {
        /// Simulated time at which the run ends [s].
        end: QuantityInput<Duration>,
        /// Time step as a fraction of the time in which a wave crosses a cell, above 0 and up to 1.
        #[schemars(extend("default" = scene::Time::until(1.0).courant))]
        courant: Option<QuantityInput<Ratio>>,
        /// No step is longer than this [s]; by default only the Courant number limits it.
        max_step: Option<QuantityInput<Duration>>,
        /// When in the step the stress is updated.
        #[schemars(extend("default" = StressUpdate::default()))]
        stress_update: Option<Word<StressUpdate>>,
        /// What velocities particles take from the grid and give to it.
        #[schemars(extend("default" = Transfer::default()))]
        transfer: Option<Word<Transfer>>,
        /// Share of the grid's velocity itself (PIC) in the particles' new velocity, 0 to 1; the rest is FLIP.
        #[schemars(extend("default" = scene::Time::until(1.0).pic_share))]
        pic_share: Option<QuantityInput<Ratio>>,
        /// Order m of the transfer `xpic`: 1 is PIC, each order more costs a pass over the particles and damps less.
        #[schemars(extend("default" = scene::Time::until(1.0).xpic_order))]
        xpic_order: Option<Count>,
        /// Dynamic relaxation: the run looks for the state at rest and ends as soon as it has it, at `end` at the
        /// latest. By default it does not.
        relax: Option<RelaxTable>,
        /// Drift of the total energy beyond which a run warns, over the largest energy that moved, was stored or turned
        /// to heat; above 0.
        #[schemars(extend("default" = scene::Time::until(1.0).energy_drift))]
        energy_drift: Option<QuantityInput<Ratio>>,
    }
}

table! {
    /// Dynamic relaxation. Bodies with interior "reference" are damped critically for the slowest swing that they still
    /// have (Underwood 1983). Where others deform, all velocities are set to zero wherever the kinetic energy has
    /// passed a peak (Cundall 1982).
    RelaxTable {
        /// The run ends once the sum of the unbalanced forces at the nodes is at most this part of the sum of the
        /// internal or of the external forces there, whichever is larger; above 0 and below 1.
        #[schemars(extend("default" = Relaxation::default().residual))]
        residual: Option<QuantityInput<Ratio>>,
    }
}

impl Choice for StressUpdate {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("modified-last", StressUpdate::ModifiedLast, "From the particles' new velocities (MUSL)."),
        ("first", StressUpdate::First, "From the velocities at the start of the step (USF)."),
        ("last", StressUpdate::Last, "From the velocities at the end of the step (USL)."),
    ];
}

impl Choice for Transfer {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        (
            "rflip",
            Transfer::Rflip,
            "Changes of velocity, and of the particles' rotation: bodies keep their spin.",
        ),
        (
            "flip",
            Transfer::Flip,
            "Changes of velocity alone (FLIP), as most codes have it: bodies lose spin at their rims.",
        ),
        (
            "apic",
            Transfer::Apic,
            "The grid's velocity and its affine field (APIC): bodies keep their spin, vibration is damped by the step.",
        ),
        (
            "xpic",
            Transfer::Xpic,
            "PIC that leaves alone what the grid resolves (XPIC, of order `xpic_order`): noise goes, waves stay.",
        ),
        (
            "pic",
            Transfer::Pic,
            "The grid's velocity itself (PIC): spin and vibration are damped by the step.",
        ),
    ];
}

impl Time {
    /// Duration and time step in SI units.
    pub fn resolve(&self, context: &Context) -> Result<scene::Time, Fault> {
        let mut time = scene::Time::until(self.end.positive(context)?);
        if let Some(courant) = &self.courant {
            let allowed = "a number above 0 and up to 1";
            time.courant = courant.checked(context, allowed, |value| value > 0.0 && value <= 1.0)?;
        }
        if let Some(step) = &self.max_step {
            time.max_step = Some(step.positive(context)?);
        }
        if let Some(word) = &self.stress_update {
            time.stress_update = word.value(context)?;
        }
        if let Some(word) = &self.transfer {
            time.transfer = word.value(context)?;
        }
        if let Some(share) = &self.pic_share {
            if matches!(time.transfer, Transfer::Pic | Transfer::Apic | Transfer::Xpic) {
                return Err(share
                    .refused(share.value(context)?, "no share unless `transfer` is \"rflip\" or \"flip\""));
            }
            let allowed = "a number from 0 to 1";
            time.pic_share = share.checked(context, allowed, |value| (0.0..=1.0).contains(&value))?;
        }
        if let Some(order) = &self.xpic_order {
            time.xpic_order = order.value(context, 1..=20)?;
            if time.transfer != Transfer::Xpic {
                return Err(order.refused(context, "no order unless `transfer` is \"xpic\"")?);
            }
        }
        if let Some(table) = &self.relax {
            let mut relaxation = Relaxation::default();
            if let Some(residual) = &table.residual {
                let allowed = "a number above 0 and below 1";
                relaxation.residual =
                    residual.checked(context, allowed, |value| value > 0.0 && value < 1.0)?;
            }
            time.relax = Some(relaxation);
        }
        if let Some(drift) = &self.energy_drift {
            time.energy_drift = drift.checked(context, "a number above 0", |value| value > 0.0)?;
        }
        Ok(time)
    }
}
