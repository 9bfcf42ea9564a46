//! The rule of 2000: contact where bodies approach.
//!
//! ```text
//! (v_a - v_cm) . n_a > 0          eq. (8) of Bardenhagen et al. (2001); Bardenhagen, Brackbill and Sulsky (2000)
//! ```
//! Frictionless collisions gain energy by it.

use super::PairLaw;
use crate::contact::{Change, Pair, common_normal, own_normals};
use crate::scene::Normal;
use crate::tensor::{Real, Vector};

/// Contact on approach.
pub struct Kinematic;

impl<T: Real, const D: usize> PairLaw<T, D> for Kinematic {
    fn change(&self, pair: &Pair<T, D>, velocities: [Vector<T, D>; 2]) -> Change<T, D> {
        match pair.rule.normal {
            Normal::Common => common_normal(pair, velocities, |approach, _| approach > T::ZERO),
            Normal::Own => own_normals(pair, velocities, |_, approach, _| approach > T::ZERO),
        }
    }
}
