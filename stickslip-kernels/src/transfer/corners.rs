//! Shape functions of particles whose domains are convected: mean tent functions of their corners (CPDI).
//!
//! A particle's domain is a parallelogram, in space a parallelepiped, whose half edges r_a deform with it
//! (convected particle domain interpolation, CPDI: Sadeghirad, Brannon and Burghardt 2011, Int. J. Numer. Meth. Eng.
//! 86). With N the tent functions, s the signs of its 2^D corners and l half the side of its undeformed box:
//!
//! ```text
//! r_a = l F e_a,     x_s = x_p + sum_a s_a r_a                                                                  (a)
//! S_i = 2^-D sum_s N_i(x_s)                                                                                     (b)
//! d_ia = 2^-D sum_s s_a N_i(x_s),     grad S_i = sum_a d_ia R^-T e_a,     R = (r_1 ... r_D)                     (c)
//! ```
//! With (b) and (c), x_p and F change such that each corner moves by the grid's velocity at the corner, as far as one
//! domain can follow it:
//!
//! ```text
//! d(x_p + sum_a s_a r_a)/dt = sum_i v_i (S_i + sum_a s_a d_ia)
//! ```
//! which along an axis is exactly v at the corner, and nearly elsewhere, for a parallelogram has fewer ways to move
//! than its corners. So neighbours go on sharing their corners: no gap opens between them, a uniform stress gives no
//! force within a body, and places and deformation gradients go together. (Not where L is changed on its way, as by
//! averages of the volume, nor where a domain is shortened.)

// Sums over nodes and components read better by their indices.
#![allow(clippy::needless_range_loop)]

use crate::tensor::{Matrix, Number, Vector};

/// Nodes that a particle reaches along an axis.
const WIDTH: usize = 3;
/// The same in space.
const NODES: usize = WIDTH.pow(3);

/// Weights and slopes of a particle at each of the nodes that it reaches, where they are no product over the axes.
/// Nodes are counted with the last axis fastest, as many along each as the basis reaches.
pub trait NodeTable<N, const D: usize>: Copy {
    /// Of a particle at `r` from its base node, with the half edges of its domain in the columns of `edges` [cells].
    fn new(r: &Vector<N, D>, edges: &Matrix<N>) -> Self;

    /// S_i [-]
    fn weight(&self, node: usize) -> N;

    /// Slope of S_i along an axis [1/cell].
    fn slope(&self, node: usize, axis: usize) -> N;
}

/// Of bases that are products.
impl<N: Number, const D: usize> NodeTable<N, D> for () {
    #[inline(always)]
    fn new(_r: &Vector<N, D>, _edges: &Matrix<N>) -> Self {}

    #[inline(always)]
    fn weight(&self, _node: usize) -> N {
        N::ZERO
    }

    #[inline(always)]
    fn slope(&self, _node: usize, _axis: usize) -> N {
        N::ZERO
    }
}

/// (b) and (c).
#[derive(Clone, Copy, Debug)]
pub struct CornerTable<N> {
    weight: [N; NODES],
    slope: [[N; NODES]; 3],
}

impl<N: Number, const D: usize> NodeTable<N, D> for CornerTable<N> {
    #[inline(always)]
    fn new(r: &Vector<N, D>, edges: &Matrix<N>) -> Self {
        let count = WIDTH.pow(D as u32);
        let mut table = CornerTable { weight: [N::ZERO; NODES], slope: [[N::ZERO; NODES]; 3] };
        let share = N::of(0.5_f64.powi(D as i32));
        for corner in 0..1_usize << D {
            let mut tents = [[N::ONE; WIDTH]; 3];
            for axis in 0..D {
                let mut place = r[axis];
                for edge in 0..D {
                    let half = edges.0[axis][edge];
                    place = if corner >> edge & 1 == 1 { place + half } else { place - half };
                }
                tents[axis] = tents_at(place);
            }
            for node in 0..count {
                let mut product = share;
                for axis in 0..D {
                    product *= tents[axis][step::<D>(node, axis)];
                }
                table.weight[node] += product;
                for edge in 0..D {
                    let slope = &mut table.slope[edge][node];
                    *slope = if corner >> edge & 1 == 1 { *slope + product } else { *slope - product };
                }
            }
        }
        // From differences along the edges to slopes along the axes.
        let inverse = edges.inverse();
        for node in 0..count {
            let mut along = [N::ZERO; 3];
            for axis in 0..D {
                for edge in 0..D {
                    along[axis] = table.slope[edge][node].times_plus(inverse.0[edge][axis], along[axis]);
                }
            }
            for axis in 0..D {
                table.slope[axis][node] = along[axis];
            }
        }
        table
    }

    #[inline(always)]
    fn weight(&self, node: usize) -> N {
        self.weight[node]
    }

    #[inline(always)]
    fn slope(&self, node: usize, axis: usize) -> N {
        self.slope[axis][node]
    }
}

/// Tent functions of three nodes in a row, at a place from the first one on [cells].
#[inline(always)]
fn tents_at<N: Number>(place: N) -> [N; WIDTH] {
    // Rounding may leave a corner beside the cells that its particle reaches.
    let first = (N::ONE - place.max(N::ZERO)).max(N::ZERO);
    let last = (place - N::ONE).max(N::ZERO);
    [first, (N::ONE - first) - last, last]
}

/// How far a node is from the first one along an axis [cells].
#[inline(always)]
pub const fn step<const D: usize>(node: usize, axis: usize) -> usize {
    let mut rest = node;
    let mut behind = D - 1;
    while behind > axis {
        rest /= WIDTH;
        behind -= 1;
    }
    rest % WIDTH
}

/// The half edges of a particle's domain [m], (a), in the columns; shortened together where a domain would reach
/// further than half a cell, `most`, from its particle along an axis, for a particle reaches no more nodes (as Homel,
/// Brannon and Guilkey 2016, Int. J. Numer. Meth. Eng. 106, shorten those that would be longer than a cell).
#[inline(always)]
pub fn convected_edges<N: Number, const D: usize>(
    deformation: &Matrix<N>,
    half_width: N,
    most: N,
) -> Matrix<N> {
    let mut edges = Matrix::ZERO;
    edges.0[2][2] = half_width;
    for i in 0..D {
        for j in 0..D {
            edges.0[i][j] = deformation.0[i][j] * half_width;
        }
    }
    let reach = extent::<N, D>(&edges);
    let mut longest = most;
    for i in 0..D {
        longest = longest.max(reach[i]);
    }
    let shorter = most / longest;
    for i in 0..D {
        for j in 0..D {
            edges.0[i][j] *= shorter;
        }
    }
    edges
}

/// How far a domain reaches from its particle along each axis [unit of the edges].
#[inline(always)]
pub fn extent<N: Number, const D: usize>(edges: &Matrix<N>) -> Vector<N, D> {
    let mut extent = Vector::ZERO;
    for i in 0..D {
        for j in 0..D {
            extent[i] += edges.0[i][j].abs();
        }
    }
    extent
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Weights sum to one, slopes to zero, and the value and the slopes of a linear field are exact, for domains that
    /// are sheared, turned and stretched, the longest shortened.
    fn reproduces_linear_fields<const D: usize>() {
        let random = |i: usize| (i as f64 * 0.754_877_666_2).fract() - 0.5;
        for trial in 0..200 {
            let f = Matrix::from_fn(|i, j| {
                let within = i < D && j < D;
                let diagonal = if i == j { 1.0 } else { 0.0 };
                if within { diagonal + 1.5 * random(9 * trial + 3 * i + j) } else { diagonal }
            });
            if f.det() < 0.1 {
                continue;
            }
            let edges = convected_edges::<f64, D>(&f, 0.25, 0.5);
            let reach = extent::<f64, D>(&edges);
            let r = Vector::from_fn(|i| reach[i] + 0.5 + random(7 * trial + i));
            let table = <CornerTable<f64> as NodeTable<f64, D>>::new(&r, &edges);
            let of = |node: usize| NodeTable::<f64, D>::weight(&table, node);
            let slope = |node: usize, axis: usize| NodeTable::<f64, D>::slope(&table, node, axis);
            let nodes = 0..WIDTH.pow(D as u32);
            assert!((nodes.clone().map(of).sum::<f64>() - 1.0).abs() < 1e-14, "{trial}");
            for axis in 0..D {
                assert!(reach[axis] <= 0.5 + 1e-15);
                let place = nodes.clone().map(|node| of(node) * step::<D>(node, axis) as f64).sum::<f64>();
                assert!((place - r[axis]).abs() < 1e-13, "{trial}: {place} for {}", r[axis]);
                for other in 0..D {
                    let along = |node: usize| slope(node, other) * step::<D>(node, axis) as f64;
                    let expected = if axis == other { 1.0 } else { 0.0 };
                    let found = nodes.clone().map(along).sum::<f64>();
                    assert!((found - expected).abs() < 1e-11, "{trial}: {found}");
                }
                assert!(nodes.clone().map(|node| slope(node, axis)).sum::<f64>().abs() < 1e-12, "{trial}");
            }
        }
    }

    #[test]
    fn linear_fields_are_reproduced() {
        reproduces_linear_fields::<2>();
        reproduces_linear_fields::<3>();
    }

    /// Along a line, x_p and F change such that both ends of a domain move by the grid's velocities there, whatever
    /// these are.
    #[test]
    fn ends_move_with_the_grid() {
        let velocity = [0.3, -1.1, 0.7];
        let at = |x: f64| tents_at(x).iter().zip(velocity).map(|(tent, v)| tent * v).sum::<f64>();
        for (r, half) in [(0.9, 0.4), (1.3, 0.45), (0.5, 0.3)] {
            let mut edges = Matrix::IDENTITY * 0.25;
            edges.0[0][0] = half;
            let table = <CornerTable<f64> as NodeTable<f64, 2>>::new(&Vector([r, 1.0]), &edges);
            // The same along the other axis, so that only the first counts.
            let sum =
                |of: &dyn Fn(usize) -> f64| (0..9).map(|node| of(node) * velocity[node / 3]).sum::<f64>();
            let centre = sum(&|node| NodeTable::<f64, 2>::weight(&table, node));
            let stretching = sum(&|node| NodeTable::<f64, 2>::slope(&table, node, 0));
            for sign in [-1.0, 1.0] {
                let end = centre + sign * half * stretching;
                assert!((end - at(r + sign * half)).abs() < 1e-14, "{end}");
            }
        }
    }
}
