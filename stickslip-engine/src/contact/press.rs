//! Interference fits: surfaces that overlap at the start grow from no overlap to all of it.
//!
//! ```text
//! gap = d_1 + d_2 + s(t),   s(t) = s_0 max(1 - t/T, 0)          s_0: overlap at the start
//! u_n <= B gap / dt         where the gap is negative, while t < 2 T
//! ```
//! with the distances d_a of the exact surfaces, so the surfaces touch at t = 0 and part as they grow, a step's part B
//! of what they overlap by at a time: what is left of the overlap is that of 1/B steps of growth, and fades after T. The
//! push does the work J_n (-u_n) on the bodies.

use crate::check::Interference;
use crate::tensor::Real;

/// B: the part of an overlap that a step takes away.
const RECOVERY: f64 = 0.2;

/// How far surfaces have grown, and how they part, in one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Growth<T> {
    /// s(t): what surfaces may still overlap by [cells].
    pub allowed: T,
    /// B while they grow, else 0 [-].
    pub recovery: T,
}

impl<T: Real> Growth<T> {
    /// At the end of a step, at a time [s], on cells of this size [m].
    pub fn of(fit: &Interference, time: f64, cell: f64) -> Self {
        let left = (1.0 - time / fit.time).max(0.0);
        let grows = time < 2.0 * fit.time;
        Growth {
            allowed: T::of(fit.depth * left / cell),
            recovery: if grows { T::of(RECOVERY) } else { T::ZERO },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_grow_evenly_and_then_rest() {
        let fit = Interference { depth: 0.02, time: 3.0 };
        let at = |time: f64| Growth::<f64>::of(&fit, time, 0.1);
        for (time, allowed) in [(0.0, 0.2), (1.5, 0.1), (3.0, 0.0), (5.0, 0.0)] {
            assert!((at(time).allowed - allowed).abs() < 1e-15, "{time}: {:?}", at(time));
        }
        assert_eq!([at(5.9).recovery, at(6.0).recovery], [RECOVERY, 0.0]);
    }
}
