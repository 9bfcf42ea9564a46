//! Shape functions: how much of a particle each grid node sees.
//!
//! A basis is a product over axes of one-dimensional functions. Along an axis, a particle reaches `WIDTH` nodes from a
//! base node on. Coordinates are in cells.

use crate::tensor::{Number, Real};
use std::fmt::Debug;
use std::ops::{Index, IndexMut};

/// Most nodes that any basis reaches along an axis.
pub const MAX_WIDTH: usize = 4;

/// How many nodes a basis reaches along an axis, for arrays of as many: a wide basis makes those of others no larger.
pub trait Width: Copy + Debug + Send + Sync + 'static {
    /// Nodes along an axis.
    const NODES: usize;
    /// An entry for each node along an axis.
    type Line<X: Copy + Debug>: Entries<X>;
    /// An entry for each node of a plane.
    type Plane<X: Copy + Debug>: Entries<X>;
    /// An entry for each two nodes of a plane that are neighbours along one axis.
    type Neighbours<X: Copy + Debug>: Entries<X>;
    /// An entry for each node in space.
    type Space<X: Copy + Debug>: Entries<X>;
}

/// An array whatever its length.
pub trait Entries<X>: Copy + Debug + Index<usize, Output = X> + IndexMut<usize> {
    /// With the same in every place.
    fn all(entry: X) -> Self;
}

impl<X: Copy + Debug, const COUNT: usize> Entries<X> for [X; COUNT] {
    #[inline(always)]
    fn all(entry: X) -> Self {
        [entry; COUNT]
    }
}

/// Two nodes.
#[derive(Clone, Copy, Debug)]
pub struct Two;

/// Three nodes.
#[derive(Clone, Copy, Debug)]
pub struct Three;

/// Four nodes.
#[derive(Clone, Copy, Debug)]
pub struct Four;

macro_rules! width {
    ($name:ident: $nodes:literal) => {
        impl Width for $name {
            const NODES: usize = $nodes;
            type Line<X: Copy + Debug> = [X; $nodes];
            type Plane<X: Copy + Debug> = [X; $nodes * $nodes];
            type Neighbours<X: Copy + Debug> = [X; $nodes * ($nodes - 1)];
            type Space<X: Copy + Debug> = [X; $nodes * $nodes * $nodes];
        }
    };
}

width!(Two: 2);
width!(Three: 3);
width!(Four: 4);

/// An entry for each node that a basis reaches along an axis.
pub type Line<B, T, X> = <<B as Basis<T>>::Width as Width>::Line<X>;
/// The same in a plane.
pub type Plane<B, T, X> = <<B as Basis<T>>::Width as Width>::Plane<X>;
/// An entry for each two of them that are neighbours along one axis.
pub type Neighbours<B, T, X> = <<B as Basis<T>>::Width as Width>::Neighbours<X>;
/// The same in space.
pub type Space<B, T, X> = <<B as Basis<T>>::Width as Width>::Space<X>;

/// Weights and slopes of one particle along one axis, for the nodes from its base node on.
#[derive(Clone, Copy, Debug)]
pub struct Axis<T: Number, W: Width> {
    /// Base node, in cells from the origin of the grid.
    pub base: i32,
    /// Weights and slopes.
    pub shape: ShapeFunctions<T, W>,
}

/// Weights and slopes along one axis, for the nodes from the base node on.
///
/// Slopes sum to zero, so what counts are differences between neighbours, and each has one factor:
///
/// ```text
/// sum f_i dS_i/dx = sum (f_{i+1} - f_i) difference_i
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ShapeFunctions<N: Number, W: Width> {
    /// S(x_p - x_i) [-].
    pub weight: W::Line<N>,
    /// What a difference between a node and the next one adds to the gradient [1/cell]; zero in the last place.
    pub difference: W::Line<N>,
}

impl<N: Number, W: Width> ShapeFunctions<N, W> {
    /// dS_i/dx [1/cell].
    #[inline(always)]
    pub fn slope(&self, i: usize) -> N {
        let before = if i == 0 { N::ZERO } else { self.difference[i - 1] };
        if i == W::NODES - 1 { before } else { before - self.difference[i] }
    }
}

/// The box as which nodes see a particle, along one axis.
#[derive(Clone, Copy, Debug)]
pub struct BoxSide<N> {
    /// Half of its side [cells].
    half: N,
    /// One over its side [1/cell].
    per_side: N,
}

impl<N: Number> BoxSide<N> {
    /// With this half side, at most half a cell, or a cell by cubic splines [cells].
    #[inline(always)]
    pub fn new(half: N) -> Self {
        BoxSide { half, per_side: N::ONE / (half + half) }
    }
}

/// One-dimensional shape functions. Weights sum to one, slopes to zero, and a linear field is reproduced.
pub trait Basis<T: Real>: Copy + Send + Sync + 'static {
    /// Nodes that a particle reaches along an axis, as a type.
    type Width: Width;

    /// The same as a number.
    const WIDTH: usize = <Self::Width as Width>::NODES;

    /// What a particle's own box adds to its spread over the nodes, over the square of its half-width [-]:
    ///
    /// ```text
    /// mean over x_p of sum_i S_i (x_i - x_p)^2 = 1/6 + BOX_SPREAD l^2          [cells^2]
    /// ```
    const BOX_SPREAD: f64;

    /// Where the reach of a particle at `x` with the half side `half` begins: its base node is the next one below
    /// [cells].
    fn reach<N: Number>(x: N, half: N) -> N;

    /// Weights and slopes of a particle at `r` from its base node.
    fn shape<N: Number>(r: N, side: &BoxSide<N>) -> ShapeFunctions<N, Self::Width>;

    /// Base node, weights and slopes of a particle at `x` with the half side `half` [cells].
    #[inline(always)]
    fn axis(x: T, half: T) -> Axis<T, Self::Width> {
        let base = Self::reach(x, half).floor();
        Axis { base, shape: Self::shape(x - T::of(f64::from(base)), &BoxSide::new(half)) }
    }
}

/// Whether a basis is one of those that most runs take, in double precision: linear functions and GIMP. Its kernels have
/// what would cost a build too much for all: in space AVX-512, in the plane groups of particles of several cells.
pub const fn takes_most_time<T: Real, B: Basis<T>>() -> bool {
    size_of::<T>() == 8 && B::WIDTH <= 3
}

/// Tent functions of the particle's centre (Sulsky, Chen and Schreyer 1994).
#[derive(Clone, Copy, Debug)]
pub struct Linear;

impl<T: Real> Basis<T> for Linear {
    type Width = Two;
    const BOX_SPREAD: f64 = 0.0;

    #[inline(always)]
    fn reach<N: Number>(x: N, _half: N) -> N {
        x
    }

    #[inline(always)]
    fn shape<N: Number>(r: N, _side: &BoxSide<N>) -> ShapeFunctions<N, Two> {
        ShapeFunctions { weight: [N::ONE - r, r], difference: [N::ONE, N::ZERO] }
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
    type Width = Three;
    const BOX_SPREAD: f64 = 1.0 / 3.0;

    #[inline(always)]
    fn reach<N: Number>(x: N, half: N) -> N {
        x - half
    }

    #[inline(always)]
    fn shape<N: Number>(r: N, &BoxSide { half, per_side }: &BoxSide<N>) -> ShapeFunctions<N, Three> {
        // Without a branch: `near` stops at 2l, where S_0 goes on as a straight line. No sum cancels, so that a node
        // that a particle hardly reaches gets hardly any mass, but not less than none.
        let before = (N::ONE + half) - r;
        let near = before.min(half + half);
        let beyond = (r - (N::ONE - half)).max(N::ZERO);
        let (falling, rising) = (near * per_side, beyond * per_side);
        let first = N::HALF * near * falling + (before - near);
        let last = N::HALF * beyond * rising;
        let difference = [falling, rising, N::ZERO];
        ShapeFunctions { weight: [first, N::ONE - first - last, last], difference }
    }
}

/// Cubic B-splines of the particle's centre (Steffen, Kirby and Berzins 2008, Int. J. Numer. Meth. Eng. 76), the tent
/// averaged over a cell twice: `space.basis = "cubic"`.
///
/// ```text
/// with t = r - 1 in [0, 1):
/// S_0 = (1 - t)^3 / 6,   S_1 = 2/3 - t^2 (1 - t/2),   S_3 = t^3 / 6,   S_2 = 1 - S_0 - S_1 - S_3
/// ```
/// Nodes see every particle as a box of two cells, l = 1, which is how much further than a tent they reach. Walls and
/// mirrors cut no function, as in [`Gimp`].
#[derive(Clone, Copy, Debug)]
pub struct Cubic;

impl<T: Real> Basis<T> for Cubic {
    type Width = Four;
    const BOX_SPREAD: f64 = 1.0 / 6.0;

    #[inline(always)]
    fn reach<N: Number>(x: N, half: N) -> N {
        x - half
    }

    #[inline(always)]
    fn shape<N: Number>(r: N, _side: &BoxSide<N>) -> ShapeFunctions<N, Four> {
        // Round-off may leave a particle beside its cell. No sum cancels where a node gets hardly anything.
        let before = ((N::ONE + N::ONE) - r).max(N::ZERO);
        let beyond = (r - N::ONE).max(N::ZERO);
        let [falling, rising] = [before, beyond].map(|part| N::HALF * part * part);
        let [first, last] = [falling * before, rising * beyond].map(|cube| cube * N::of(1.0 / 3.0));
        let second = N::of(2.0 / 3.0) - beyond * beyond * (N::ONE - N::HALF * beyond);
        ShapeFunctions {
            weight: [first, second, N::ONE - first - second - last, last],
            difference: [falling, N::ONE - falling - rising, rising, N::ZERO],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sides of boxes that particles may have.
    const HALF_SIDES: [f64; 3] = [0.25, 0.5, 0.1667];

    fn reproduces_linear_fields<B: Basis<f64>>(half_sides: [f64; 3]) {
        for i in 0..2000 {
            let (x, half) = (-3.0 + i as f64 * 0.00317, half_sides[i % 3]);
            let axis = B::axis(x, half);
            let node = |k: usize| f64::from(axis.base) + k as f64;
            let sum = |f: &dyn Fn(usize) -> f64| (0..B::WIDTH).map(f).sum::<f64>();
            assert!((sum(&|k| axis.shape.weight[k]) - 1.0).abs() < 1e-14);
            assert!((sum(&|k| axis.shape.weight[k] * node(k)) - x).abs() < 1e-13, "x = {x}");
            assert!(sum(&|k| axis.shape.slope(k)).abs() < 1e-14);
            assert!((sum(&|k| axis.shape.slope(k) * node(k)) - 1.0).abs() < 1e-13, "x = {x}");
            assert!((0..B::WIDTH).all(|k| (-1e-15..=1.0).contains(&axis.shape.weight[k])));
        }
    }

    #[test]
    fn linear_reproduces_linear_fields() {
        reproduces_linear_fields::<Linear>(HALF_SIDES);
    }

    #[test]
    fn gimp_reproduces_linear_fields() {
        reproduces_linear_fields::<Gimp>(HALF_SIDES);
    }

    #[test]
    fn cubic_splines_reproduce_linear_fields() {
        reproduces_linear_fields::<Cubic>([1.0; 3]);
    }

    /// S(d) of the node at a distance d, against the formula of the splines.
    fn cubic(d: f64) -> f64 {
        let d = d.abs();
        if d < 1.0 { 2.0 / 3.0 - d * d + 0.5 * d * d * d } else { (2.0 - d).max(0.0).powi(3) / 6.0 }
    }

    /// Weights are the formula's, at the ends of a cell too, and slopes their derivatives.
    #[test]
    fn cubic_splines_are_those_of_the_formula() {
        for i in 0..=300 {
            let x = -1.5 + 0.01 * f64::from(i);
            let axis = <Cubic as Basis<f64>>::axis(x, 1.0);
            for node in axis.base - 2..axis.base + 6 {
                let d = x - f64::from(node);
                let slope = (cubic(d + 1e-5) - cubic(d - 1e-5)) / 2e-5;
                let seen = usize::try_from(node - axis.base).ok().filter(|&k| k < 4);
                let found = seen.map_or([0.0; 2], |k| [axis.shape.weight[k], axis.shape.slope(k)]);
                assert!((found[0] - cubic(d)).abs() < 1e-15, "{x} {node}: {found:?}");
                assert!((found[1] - slope).abs() < 1e-9, "{x} {node}: {found:?} {slope}");
            }
        }
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

    fn spreads_over_the_nodes<B: Basis<f64>>(half_sides: &[f64]) {
        for &half in half_sides {
            let n = 10_000;
            let spread = |x: f64| {
                let axis = B::axis(x, half);
                let arm = |k: usize| f64::from(axis.base) + k as f64 - x;
                (0..B::WIDTH).map(|k| axis.shape.weight[k] * arm(k).powi(2)).sum::<f64>()
            };
            let mean =
                (0..n).map(|i| spread((f64::from(i) + 0.5) / f64::from(n))).sum::<f64>() / f64::from(n);
            assert!((mean - (1.0 / 6.0 + B::BOX_SPREAD * half * half)).abs() < 1e-7, "{mean}");
        }
    }

    #[test]
    fn all_spread_as_stated() {
        spreads_over_the_nodes::<Linear>(&HALF_SIDES);
        spreads_over_the_nodes::<Gimp>(&HALF_SIDES);
        spreads_over_the_nodes::<Cubic>(&[1.0]);
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
