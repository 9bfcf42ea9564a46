//! Shape functions: how much of a particle each grid node sees.
//!
//! A basis is a product over axes of one-dimensional functions, or a mean of such products over the corners of a
//! particle's domain. Along an axis, a particle reaches `WIDTH` nodes from a base node on. Coordinates are in cells.

use crate::tensor::{Number, Real};
use crate::transfer::{CornerTable, NodeTable};

/// Most nodes that any basis reaches along an axis.
pub const MAX_WIDTH: usize = 3;

/// Weights and slopes of one particle along one axis, for the nodes from its base node on.
#[derive(Clone, Copy, Debug)]
pub struct Axis<T> {
    /// Base node, in cells from the origin of the grid.
    pub base: i32,
    /// Weights and slopes.
    pub shape: ShapeFunctions<T>,
}

/// Weights and slopes along one axis, for the nodes from the base node on.
///
/// Slopes sum to zero, so what counts are differences between neighbours, and each has one factor:
///
/// ```text
/// sum f_i dS_i/dx = sum (f_{i+1} - f_i) difference_i
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ShapeFunctions<N> {
    /// S(x_p - x_i) [-]; zero beyond the basis' width.
    pub weight: [N; MAX_WIDTH],
    /// What a difference between a node and the next one adds to the gradient [1/cell]; zero beyond the basis' width.
    pub difference: [N; MAX_WIDTH - 1],
}

impl<N: Number> ShapeFunctions<N> {
    /// dS_i/dx [1/cell].
    #[inline(always)]
    pub fn slope(&self, i: usize) -> N {
        let before = if i == 0 { N::ZERO } else { self.difference[i - 1] };
        if i == MAX_WIDTH - 1 { before } else { before - self.difference[i] }
    }
}

/// The box as which nodes see a particle, along one axis.
#[derive(Clone, Copy, Debug)]
pub struct BoxSide<N> {
    /// Half of its side [cells].
    pub half: N,
    /// One over its side [1/cell].
    per_side: N,
}

impl<N: Number> BoxSide<N> {
    /// With this half side, at most half a cell [cells].
    #[inline(always)]
    pub fn new(half: N) -> Self {
        BoxSide { half, per_side: N::ONE / (half + half) }
    }
}

/// One-dimensional shape functions. Weights sum to one, slopes to zero, and a linear field is reproduced.
pub trait Basis<T: Real>: Copy + Send + Sync + 'static {
    /// Nodes that a particle reaches along an axis.
    const WIDTH: usize;

    /// What a particle's own box adds to its spread over the nodes, over the square of its half-width [-]:
    ///
    /// ```text
    /// mean over x_p of sum_i S_i (x_i - x_p)^2 = 1/6 + BOX_SPREAD l^2          [cells^2]
    /// ```
    const BOX_SPREAD: f64;

    /// Whether it is a mean over the corners of domains that deform with their particles, and no product over the axes.
    const CORNERS: bool = false;

    /// Weights and slopes node by node, where it is no product; else nothing.
    type Table<N: Number, const D: usize>: NodeTable<N, D>;

    /// Where the reach of a particle at `x` with the half side `half` begins: its base node is the next one below
    /// [cells].
    fn reach<N: Number>(x: N, half: N) -> N;

    /// Weights and slopes of a particle at `r` from its base node.
    fn shape<N: Number>(r: N, side: &BoxSide<N>) -> ShapeFunctions<N>;

    /// Factors that make the affine part of a field of its values at the nodes of an axis [1/cell]:
    ///
    /// ```text
    /// a_i = S_i (x_i - x_p) / sum_j S_j (x_j - x_p)^2
    /// ```
    #[inline(always)]
    fn affine<N: Number>(shape: &ShapeFunctions<N>, r: N) -> [N; MAX_WIDTH] {
        let mut factors = [N::ZERO; MAX_WIDTH];
        let mut spread = N::ZERO;
        for (i, factor) in factors.iter_mut().enumerate().take(Self::WIDTH) {
            let arm = N::of(i as f64) - r;
            *factor = shape.weight[i] * arm;
            spread += *factor * arm;
        }
        for factor in &mut factors {
            *factor /= spread;
        }
        factors
    }

    /// Base node, weights and slopes of a particle at `x` with the half side `half` [cells].
    #[inline(always)]
    fn axis(x: T, half: T) -> Axis<T> {
        let base = Self::reach(x, half).floor();
        Axis { base, shape: Self::shape(x - T::of(f64::from(base)), &BoxSide::new(half)) }
    }
}

/// Tent functions of the particle's centre (Sulsky, Chen and Schreyer 1994).
#[derive(Clone, Copy, Debug)]
pub struct Linear;

impl<T: Real> Basis<T> for Linear {
    const WIDTH: usize = 2;
    const BOX_SPREAD: f64 = 0.0;
    type Table<N: Number, const D: usize> = ();

    /// Slopes: the limit of the quotient where a particle sits on a node, and the same elsewhere.
    #[inline(always)]
    fn affine<N: Number>(shape: &ShapeFunctions<N>, _r: N) -> [N; MAX_WIDTH] {
        [shape.slope(0), shape.slope(1), N::ZERO]
    }

    #[inline(always)]
    fn reach<N: Number>(x: N, _half: N) -> N {
        x
    }

    #[inline(always)]
    fn shape<N: Number>(r: N, _side: &BoxSide<N>) -> ShapeFunctions<N> {
        ShapeFunctions { weight: [N::ONE - r, r, N::ZERO], difference: [N::ONE, N::ZERO] }
    }
}

/// Tent functions averaged over the particle's box (Bardenhagen and Kober 2004, eq. 34).
///
/// ```text
/// with l = half of the box's side, r = x - base in [l, 1 + l):
/// r <= 1 - l:  S_0 = 1 - r,                 S_2 = 0
/// else:        S_0 = (1 + l - r)^2 / (4l),  S_2 = (r - 1 + l)^2 / (4l)
/// S_1 = 1 - S_0 - S_2
/// ```
/// Needs l <= 1/2. The box keeps its first size and direction (uniform GIMP, `space.basis = "gimp"`).
///
/// With l = 1/2, whatever the particle's size, they are the quadratic B-splines of its centre
/// (Steffen, Kirby and Berzins 2008, Int. J. Numer. Meth. Eng. 76), the tent averaged over a cell:
///
/// ```text
/// S_0 = (3/2 - r)^2 / 2,   S_1 = 3/4 - (r - 1)^2,   S_2 = (r - 1/2)^2 / 2
/// ```
/// That is `space.basis = "spline"`. The grid has no end at walls and mirrors, nodes beyond them are images of those
/// before them, so no function is cut there.
#[derive(Clone, Copy, Debug)]
pub struct Gimp;

impl<T: Real> Basis<T> for Gimp {
    const WIDTH: usize = 3;
    const BOX_SPREAD: f64 = 1.0 / 3.0;
    type Table<N: Number, const D: usize> = ();

    #[inline(always)]
    fn reach<N: Number>(x: N, half: N) -> N {
        x - half
    }

    #[inline(always)]
    fn shape<N: Number>(r: N, &BoxSide { half, per_side }: &BoxSide<N>) -> ShapeFunctions<N> {
        // Without a branch: `near` stops at 2l, where S_0 goes on as a straight line. No sum cancels, so that a node
        // that a particle hardly reaches gets hardly any mass, but not less than none.
        let before = (N::ONE + half) - r;
        let near = before.min(half + half);
        let beyond = (r - (N::ONE - half)).max(N::ZERO);
        let (falling, rising) = (near * per_side, beyond * per_side);
        let first = N::HALF * near * falling + (before - near);
        let last = N::HALF * beyond * rising;
        ShapeFunctions { weight: [first, N::ONE - first - last, last], difference: [falling, rising] }
    }
}

/// Mean tent functions of the corners of a domain that deforms with its particle (CPDI): equations in
/// `transfer/corners.rs`. Along the axes, of a domain that lies along them, with l half of its side and
/// r = x - base in [l, 1 + l):
///
/// ```text
/// S_0 = (max(1 + l - r, 0) + max(1 - l - r, 0)) / 2,   S_2 = max(r - 1 + l, 0) / 2,   S_1 = 1 - S_0 - S_2
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Cpdi;

impl<T: Real> Basis<T> for Cpdi {
    const WIDTH: usize = 3;
    const BOX_SPREAD: f64 = 1.0;
    const CORNERS: bool = true;
    type Table<N: Number, const D: usize> = CornerTable<N>;

    #[inline(always)]
    fn reach<N: Number>(x: N, half: N) -> N {
        x - half
    }

    #[inline(always)]
    fn shape<N: Number>(r: N, &BoxSide { half, per_side }: &BoxSide<N>) -> ShapeFunctions<N> {
        let before = (N::ONE + half) - r;
        let near = before.min(half + half);
        let beyond = (r - (N::ONE - half)).max(N::ZERO);
        let first = N::HALF * near + (before - near);
        let last = N::HALF * beyond;
        let difference = [near * per_side, beyond * per_side];
        ShapeFunctions { weight: [first, N::ONE - first - last, last], difference }
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
            assert!((sum(&|k| axis.shape.weight[k]) - 1.0).abs() < 1e-14);
            assert!((sum(&|k| axis.shape.weight[k] * node(k)) - x).abs() < 1e-13, "x = {x}");
            assert!(sum(&|k| axis.shape.slope(k)).abs() < 1e-14);
            assert!((sum(&|k| axis.shape.slope(k) * node(k)) - 1.0).abs() < 1e-13, "x = {x}");
            assert!(axis.shape.weight.iter().all(|&w| (-1e-15..=1.0).contains(&w)));
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
    fn corners_reproduce_linear_fields() {
        reproduces_linear_fields::<Cpdi>();
    }

    /// Against the formulas of the splines.
    #[test]
    fn boxes_of_a_cell_make_quadratic_splines() {
        for i in 0..=100 {
            let r = 0.5 + 0.01 * f64::from(i);
            let shape = <Gimp as Basis<f64>>::shape(r, &BoxSide::new(0.5));
            let exact =
                [0.5 * (1.5 - r) * (1.5 - r), 0.75 - (r - 1.0) * (r - 1.0), 0.5 * (r - 0.5) * (r - 0.5)];
            let slopes = [r - 1.5, 2.0 - 2.0 * r, r - 0.5];
            for k in 0..3 {
                assert!((shape.weight[k] - exact[k]).abs() < 1e-14, "{r} {k}");
                assert!((shape.slope(k) - slopes[k]).abs() < 1e-14, "{r} {k}");
            }
        }
    }

    #[test]
    fn slopes_of_splines_are_continuous() {
        let slope = |x: f64, node: i32| {
            let axis = <Gimp as Basis<f64>>::axis(x, 0.5);
            (0..3).filter(|k| axis.base + k == node).map(|k| axis.shape.slope(k as usize)).sum::<f64>()
        };
        for node in -1..3 {
            for crossing in [0.5, 1.5] {
                let jump = slope(crossing + 1e-9, node) - slope(crossing - 1e-9, node);
                assert!(jump.abs() < 1e-8, "{node} {crossing}: {jump}");
            }
        }
    }

    /// A linear field u = 0.3 + 0.7 x of the nodes has this slope by the factors of APIC, too.
    fn finds_the_affine_part<B: Basis<f64>>() {
        for i in 0..200 {
            let x = 0.01 * f64::from(i) + 1e-3;
            let axis = B::axis(x, 0.25);
            let factors = B::affine(&axis.shape, x - f64::from(axis.base));
            let value = |k: usize| 0.3 + 0.7 * (f64::from(axis.base) + k as f64);
            let found: f64 = (0..MAX_WIDTH).map(|k| factors[k] * value(k)).sum();
            assert!((found - 0.7).abs() < 1e-12, "{x}: {found}");
        }
    }

    #[test]
    fn both_find_the_affine_part() {
        finds_the_affine_part::<Linear>();
        finds_the_affine_part::<Gimp>();
    }

    fn spreads_over_the_nodes<B: Basis<f64>>() {
        for half in [0.25, 0.5, 0.1667] {
            let n = 10_000;
            let spread = |x: f64| {
                let axis = B::axis(x, half);
                let arm = |k: usize| f64::from(axis.base) + k as f64 - x;
                (0..MAX_WIDTH).map(|k| axis.shape.weight[k] * arm(k).powi(2)).sum::<f64>()
            };
            let mean =
                (0..n).map(|i| spread((f64::from(i) + 0.5) / f64::from(n))).sum::<f64>() / f64::from(n);
            assert!((mean - (1.0 / 6.0 + B::BOX_SPREAD * half * half)).abs() < 1e-7, "{mean}");
        }
    }

    #[test]
    fn both_spread_as_stated() {
        spreads_over_the_nodes::<Linear>();
        spreads_over_the_nodes::<Gimp>();
        spreads_over_the_nodes::<Cpdi>();
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
                assert!((average - axis.shape.weight[k]).abs() < 1e-7, "x = {x}, node {k}");
            }
        }
    }
}
