//! PIC: particles take the nodes' velocities themselves (Harlow 1964).
//!
//! ```text
//! m_i v_i = sum_p m_p S_ip v_p
//! v_p = sum_i S_ip v_i
//! ```
//! What a cell cannot tell apart is averaged away in every step: no noise, but bodies lose energy, spin and vibration
//! the faster the smaller the step. For flows and for coming to rest, not for waves.

use super::flip::Flip;
use super::{Carried, Start, Surroundings, TransferRule};
use crate::basis::Basis;
use crate::lanes::Lanes;

/// See the module: FLIP with all of the share that PIC may have, so that the ledger knows what is lost.
#[derive(Clone, Copy, Debug)]
pub struct Pic;

impl TransferRule for Pic {
    const ALWAYS_PIC: bool = true;

    #[inline(always)]
    fn take_change<V: Lanes, const D: usize, B: Basis<V::Real>, S: Start>(
        around: &Surroundings<'_, V, D, B, S>,
        carried: &mut Carried<V, D>,
    ) {
        Flip::take_change(around, carried);
    }

    #[inline(always)]
    fn take_share<V: Lanes, const D: usize, B: Basis<V::Real>, S: Start>(
        around: &Surroundings<'_, V, D, B, S>,
        carried: &mut Carried<V, D>,
        share: V,
    ) {
        Flip::take_share(around, carried, share);
    }
}
