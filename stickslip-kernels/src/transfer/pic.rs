//! PIC: particles take the nodes' velocities themselves (Harlow 1964).
//!
//! ```text
//! m_i v_i = sum_p m_p S_ip v_p
//! v_p = sum_i S_ip v_i
//! ```
//! What a cell cannot tell apart is averaged away in every step: no noise, but bodies lose energy, spin and vibration
//! the faster the smaller the step. For flows and for coming to rest, not for waves.

use super::TransferRule;

/// See the module: FLIP with all of the share that PIC may have, so that the ledger knows what is lost.
#[derive(Clone, Copy, Debug)]
pub struct Pic;

impl TransferRule for Pic {
    const ALWAYS_PIC: bool = true;
}
