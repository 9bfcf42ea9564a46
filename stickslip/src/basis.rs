//! Shape functions: how much of a particle each grid node sees.
//!
//! A basis is a product over axes of one-dimensional functions. Along an axis, a particle reaches `WIDTH` nodes from a
//! base node on. Coordinates are in cells.

use crate::tensor::Real;

/// Most nodes that any basis reaches along an axis.
pub const MAX_WIDTH: usize = 3;

/// Weights and slopes of one particle along one axis, for the nodes from its base node on.
#[derive(Clone, Copy, Debug)]
pub struct Axis<T> {
    /// Base node, in cells from the origin of the grid.
    pub base: i32,
    /// S(x_p - x_i) [-]; zero beyond the basis' width.
    pub weight: [T; MAX_WIDTH],
    /// dS/dx [1/cell].
    pub slope: [T; MAX_WIDTH],
}

/// One-dimensional shape functions. Weights sum to one, slopes to zero, and a linear field is reproduced.
pub trait Basis<T: Real>: Copy + Send + Sync + 'static {
    /// Nodes that a particle reaches along an axis.
    const WIDTH: usize;

    /// Base node, weights and slopes of a particle at `x` with half-width `half` [cells].
    fn axis(x: T, half: T) -> Axis<T>;
}

/// Tent functions of the particle's centre (Sulsky, Chen and Schreyer 1994).
#[derive(Clone, Copy, Debug)]
pub struct Linear;

impl<T: Real> Basis<T> for Linear {
    const WIDTH: usize = 2;

    #[inline(always)]
    fn axis(x: T, _half: T) -> Axis<T> {
        let base = x.floor();
        let r = x - T::of(f64::from(base));
        Axis { base, weight: [T::ONE - r, r, T::ZERO], slope: [-T::ONE, T::ONE, T::ZERO] }
    }
}

/// Tent functions averaged over the particle's box, which keeps its first size and direction
/// (uniform GIMP; Bardenhagen and Kober 2004, eq. 34).
///
/// ```text
/// with l = half-width, r = x - base in [l, 1 + l):
/// r <= 1 - l:  S_0 = 1 - r,                 S_2 = 0
/// else:        S_0 = (1 + l - r)^2 / (4l),  S_2 = (r - 1 + l)^2 / (4l)
/// S_1 = 1 - S_0 - S_2
/// ```
/// Needs l <= 1/2.
#[derive(Clone, Copy, Debug)]
pub struct Gimp;

impl<T: Real> Basis<T> for Gimp {
    const WIDTH: usize = 3;

    #[inline(always)]
    fn axis(x: T, half: T) -> Axis<T> {
        let base = (x - half).floor();
        let r = x - T::of(f64::from(base));
        let inner = T::ONE - half;
        let (first, last, first_slope, last_slope) = if r <= inner {
            (T::ONE - r, T::ZERO, -T::ONE, T::ZERO)
        } else {
            let (before, beyond) = (T::ONE + half - r, r - inner);
            let width = T::of(2.0) * half;
            let area = T::of(2.0) * width;
            (before * before / area, beyond * beyond / area, -before / width, beyond / width)
        };
        Axis {
            base,
            weight: [first, T::ONE - first - last, last],
            slope: [first_slope, -first_slope - last_slope, last_slope],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reproduces_linear_fields<B: Basis<f64>>() {
        for i in 0..2000 {
            let (x, half) = (-3.0 + i as f64 * 0.00317, [0.25, 0.5, 0.1667][i % 3]);
            let axis = B::axis(x, half);
            let node = |k: usize| f64::from(axis.base) + k as f64;
            let sum = |f: &dyn Fn(usize) -> f64| (0..MAX_WIDTH).map(f).sum::<f64>();
            assert!((sum(&|k| axis.weight[k]) - 1.0).abs() < 1e-14);
            assert!((sum(&|k| axis.weight[k] * node(k)) - x).abs() < 1e-13, "x = {x}");
            assert!(sum(&|k| axis.slope[k]).abs() < 1e-14);
            assert!((sum(&|k| axis.slope[k] * node(k)) - 1.0).abs() < 1e-13, "x = {x}");
            assert!(axis.weight.iter().all(|&w| (-1e-15..=1.0).contains(&w)));
        }
    }

    #[test]
    fn linear_reproduces_linear_fields() {
        reproduces_linear_fields::<Linear>();
    }

    #[test]
    fn gimp_reproduces_linear_fields() {
        reproduces_linear_fields::<Gimp>();
    }

    #[test]
    fn gimp_is_the_average_of_tents_over_the_particle() {
        for i in 0..200 {
            let (x, half) = (0.3 + i as f64 * 0.01, 0.25);
            let axis = <Gimp as Basis<f64>>::axis(x, half);
            for k in 0..3 {
                let node = f64::from(axis.base) + k as f64;
                let n = 20_000;
                let average = (0..n)
                    .map(|j| x - half + 2.0 * half * (j as f64 + 0.5) / n as f64)
                    .map(|y| (1.0 - (y - node).abs()).max(0.0))
                    .sum::<f64>()
                    / n as f64;
                assert!((average - axis.weight[k]).abs() < 1e-7, "x = {x}, node {k}");
            }
        }
    }
}
