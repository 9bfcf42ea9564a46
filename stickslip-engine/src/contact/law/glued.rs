//! Bodies glued together: one velocity for both.
//!
//! ```text
//! J = -m* (v_1 - v_2),   m* = m_1 m_2/(m_1 + m_2)
//! ```
//! the momentum equation of one body, Sulsky, Chen and Schreyer (1994); eq. (15) of Bardenhagen et al. (2001).

use super::PairLaw;
use crate::contact::{Change, Pair};
use crate::tensor::{Real, Vector};

/// Contact always and in every direction.
pub struct Glued;

impl<T: Real, const D: usize> PairLaw<T, D> for Glued {
    fn change(&self, pair: &Pair<T, D>, [v, w]: [Vector<T, D>; 2]) -> Change<T, D> {
        let impulse = (w - v) * pair.reduced_mass();
        let n = pair.normal.unwrap_or(Vector::ZERO);
        let along = impulse.dot(n);
        pair.exchange(along, impulse - n * along, n)
    }
}
