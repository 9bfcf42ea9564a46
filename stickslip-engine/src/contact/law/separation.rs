//! Contact where the bodies' extrapolated positions are close, with the traction rule for release.
//!
//! ```text
//! x_a   = sum_p V_p S_i x_p / sum_p V_p S_i                            the body's place as the node sees it
//! e_a   = h (1 - 2 (|(x_a - x_i) . n| / (r h))^0.58)                  distance of the node inside the body's edge
//! gap   = -(e_a + e_b)                                                 touching below zero
//! ```
//! Nairn (2013), Comput. Model. Eng. Sci. 92, 271, extrapolates the positions; the power law that turns them into edges
//! is that of Nairn, Hammerquist and Smith (2020), Comput. Methods Appl. Mech. Eng. 362, 112859, for particles that
//! fill their domains, with the reach r of a particle: 1.25 cells where its box is half a cell wide, 1.5 by quadratic
//! splines, 1.6 by cubic ones. Extrapolated positions see a body through its mass around the node, so the gap is known
//! to a fraction of a cell.

use super::traction::joint;
use super::{NearParticle, PairLaw};
use crate::contact::{Change, Facing, LawInputs, Pair, common_normal};
use crate::tensor::{Real, Vector};

/// Contact of extrapolated positions.
pub struct Separation;

/// Reach of a particle that fills a quarter of a cell, and by quadratic and cubic splines [cells].
const REACH: f64 = 1.25;
const REACH_OF_QUADRATIC: f64 = 1.5;
const REACH_OF_CUBIC: f64 = 1.6;
/// Power of the extrapolated position that gives the edge.
const POWER: f64 = 0.58;

/// Reach of particles of which nodes see each as a box of this half side, or as its own box [cells].
fn reach<T: Real>(half_side: Option<T>) -> f64 {
    match half_side {
        None => REACH,
        Some(half) if half > T::HALF => REACH_OF_CUBIC,
        Some(_) => REACH_OF_QUADRATIC,
    }
}

/// Distance from the node to the edge of a body whose centre is `center` away along the normal, for particles of some
/// reach; positive inside [cells].
fn edge<T: Real>(center: T, reach: f64) -> T {
    T::of(1.0 - 2.0 * libm::pow((center.abs().f64() / reach).min(1.0), POWER))
}

impl<T: Real, const D: usize> PairLaw<T, D> for Separation {
    fn facing(&self, look: &LawInputs<T, D>, _: &mut Vec<NearParticle<T, D>>) -> Option<Facing<T, D>> {
        let [a, b] = look.pair.map(|side| &look.sides[side]);
        let Some(normal) = (b.volume_gradient - a.volume_gradient).direction() else {
            return Some(Facing { normal: None, gap: T::ONE });
        };
        let lattice = &look.near.lattice;
        let reach = reach(lattice.half_side);
        let edges = [a, b].map(|side| edge(side.surface.place.center.dot(normal) / lattice.cell, reach));
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

    fn tent(x: f64) -> f64 {
        1.0 - x.abs()
    }

    fn spline(x: f64) -> f64 {
        if x.abs() < 0.5 { 0.75 - x * x } else { 0.5 * (1.5 - x.abs()).powi(2) }
    }

    fn cubic(x: f64) -> f64 {
        let x = x.abs();
        if x < 1.0 { 2.0 / 3.0 - x * x * (1.0 - 0.5 * x) } else { (2.0 - x).powi(3) / 6.0 }
    }

    /// A shape function, how far it reaches, and the boxes of its particles [cells].
    struct Function(fn(f64) -> f64, f64, Option<f64>);

    /// Material behind a plane at distance `surface` from a node, weighted by a function: where its centre seems.
    fn center(surface: f64, &Function(weight, end, _): &Function) -> f64 {
        let n = 100_000;
        let (mut volume, mut moment) = (0.0, 0.0);
        for i in 0..n {
            let x = -end + (surface + end) * (f64::from(i) + 0.5) / f64::from(n);
            volume += weight(x);
            moment += x * weight(x);
        }
        moment / volume
    }

    #[test]
    fn the_edge_of_a_half_space_is_found_within_a_fraction_of_a_cell() {
        let functions =
            [Function(tent, 1.0, None), Function(spline, 1.5, Some(0.5)), Function(cubic, 2.0, Some(1.0))];
        for function in functions {
            let found = |surface: f64| edge::<f64>(center(surface, &function), reach(function.2));
            for surface in [-0.8, -0.5, -0.2, 0.0, 0.2, 0.5, 0.8] {
                assert!((found(surface) - surface).abs() < 0.26, "{surface}: {}", found(surface));
            }
            // Bodies that touch at the node do not seem apart.
            assert!((0.0..0.08).contains(&found(0.0)), "{}", found(0.0));
        }
    }
}
