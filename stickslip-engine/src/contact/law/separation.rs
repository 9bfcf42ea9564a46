//! Contact where the bodies' extrapolated positions are close, with the traction rule for release.
//!
//! ```text
//! x_a   = sum_p V_p S_i x_p / sum_p V_p S_i                            the body's place as the node sees it
//! e_a   = h (1 - 2 (|(x_a - x_i) . n| / (1.25 h))^0.58)               distance of the node inside the body's edge
//! gap   = -(e_a + e_b)                                                 touching below zero
//! ```
//! Nairn (2013), Comput. Model. Eng. Sci. 92, 271, extrapolates the positions; the power law that turns them into edges
//! is that of Nairn, Hammerquist and Smith (2020), Comput. Methods Appl. Mech. Eng. 362, 112859, for particles that
//! fill their domains. Extrapolated positions see a body through its mass around the node,
//! so the gap is known to a fraction of a cell.

use super::traction::joint;
use super::{NearParticle, PairLaw};
use crate::contact::{Change, Facing, LawInputs, Pair, common_normal};
use crate::tensor::{Real, Vector};

/// Contact of extrapolated positions.
pub struct Separation;

/// Reach of a particle that fills a quarter of a cell [cells].
const REACH: f64 = 1.25;
/// Power of the extrapolated position that gives the edge.
const POWER: f64 = 0.58;

/// Distance from the node to the edge of a body whose centre is `center` away along the normal,
/// positive inside [cells].
fn edge<T: Real>(center: T) -> T {
    T::of(1.0 - 2.0 * libm::pow((center.abs().f64() / REACH).min(1.0), POWER))
}

impl<T: Real, const D: usize> PairLaw<T, D> for Separation {
    fn facing(&self, look: &LawInputs<T, D>, _: &mut Vec<NearParticle<T, D>>) -> Option<Facing<T, D>> {
        let [a, b] = look.pair.map(|side| &look.sides[side]);
        let Some(normal) = (b.volume_gradient - a.volume_gradient).direction() else {
            return Some(Facing { normal: None, gap: T::ONE });
        };
        let edges = [a, b].map(|side| edge(side.surface.place.center.dot(normal) / look.near.lattice.cell));
        Some(Facing { normal: Some(normal), gap: -(edges[0] + edges[1]) })
    }

    fn change(&self, pair: &Pair<T, D>, velocities: [Vector<T, D>; 2]) -> Change<T, D> {
        if pair.gap > T::ZERO {
            return Change::NONE;
        }
        common_normal(pair, velocities, |approach, n| {
            approach > T::ZERO || joint(pair, n).is_some_and(|traction| traction < T::ZERO)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Material behind a plane at distance `surface` from a node, weighted by the tent function:
    /// where its centre seems.
    fn center(surface: f64) -> f64 {
        let n = 100_000;
        let (mut volume, mut moment) = (0.0, 0.0);
        for i in 0..n {
            let x = -1.0 + (surface + 1.0) * (f64::from(i) + 0.5) / f64::from(n);
            volume += 1.0 - x.abs();
            moment += x * (1.0 - x.abs());
        }
        moment / volume
    }

    #[test]
    fn the_edge_of_a_half_space_is_found_within_a_fraction_of_a_cell() {
        for surface in [-0.8, -0.5, -0.2, 0.0, 0.2, 0.5, 0.8_f64] {
            let found: f64 = edge(center(surface));
            assert!((found - surface).abs() < 0.26, "{surface}: {found}");
        }
        assert!(edge(center(0.0)).abs() < 0.08);
    }
}
