//! The transfer as the equations read, one particle and one node after the other: an oracle for the tests.

use super::offsets;
use crate::basis::{Axis, Basis};
use crate::grid::{Lattice, NodeValues, SIDE, WINDOW_NODES, Window, window_side};
use crate::matter::Particle;
use crate::tensor::{Matrix, Real, Symmetric, Vector};
use std::marker::PhantomData;

/// The nodes that one particle reaches, with its shape functions there.
#[derive(Clone, Copy, Debug)]
pub struct Stencil<T: Real, const D: usize, B: Basis<T>> {
    axes: [Axis<T, B::Width>; D],
    /// Place after the base node [cells].
    r: [T; D],
    /// 1/cell [1/m]
    per_cell: T,
    basis: PhantomData<B>,
}

impl<T: Real, const D: usize, B: Basis<T>> Stencil<T, D, B> {
    /// The stencil of a particle.
    #[inline(always)]
    pub fn of(lattice: &Lattice<T, D>, particle: &Particle<T, D>) -> Self {
        let x = lattice.cells(particle.position);
        let half = lattice.seen_half_side(particle.half_width);
        let axes: [Axis<T, B::Width>; D] = std::array::from_fn(|i| B::axis(x[i], half));
        let r = std::array::from_fn(|i| x[i] - T::of(f64::from(axes[i].base)));
        Stencil { axes, r, per_cell: lattice.per_cell, basis: PhantomData }
    }

    /// Base node: the first that the particle reaches along each axis.
    #[inline(always)]
    pub fn base(&self) -> [i32; D] {
        self.axes.map(|axis| axis.base)
    }

    /// Weight [-] and gradient [1/m] of the node at `base + offset`.
    #[inline(always)]
    pub fn at(&self, offset: [usize; D]) -> (T, Vector<T, D>) {
        let weight = |skip: usize| {
            let axis =
                |w, i: usize| w * if i == skip { T::ONE } else { self.axes[i].shape.weight[offset[i]] };
            (0..D).fold(T::ONE, axis)
        };
        let gradient = Vector::from_fn(|i| weight(i) * self.axes[i].shape.slope(offset[i]) * self.per_cell);
        (weight(D), gradient)
    }

    /// From the particle to the node at `base + offset` [m].
    #[inline(always)]
    fn arm(&self, offset: [usize; D]) -> Vector<T, D> {
        Vector::from_fn(|i| (T::of(offset[i] as f64) - self.r[i]) / self.per_cell)
    }

    /// Calls `f(place in the window of a block, offset from the base node)` for every node.
    #[inline(always)]
    fn each(&self, block: [i32; D], mut f: impl FnMut(usize, [usize; D])) {
        let side = window_side(B::WIDTH);
        let place = |node: [i32; D]| node.iter().fold(0, |place, &n| place * side + n as usize);
        let start = place(std::array::from_fn(|i| self.axes[i].base - block[i] * SIDE));
        for offset in offsets::<D>(B::WIDTH) {
            f(start + place(offset.map(|o| o as i32)), offset);
        }
    }

    /// Adds a particle's mass and momentum to the window's nodes.
    ///
    /// ```text
    /// m_i += S_i m,   p_i += S_i m (v + G (x_i - x_p))          Sulsky, Chen and Schreyer (1994) with G = 0
    /// ```
    /// G: gradient of the velocities that a particle gives, [`super::TransferRule::gradient`] [1/s]. `mass` is what the
    /// nodes are given; 0 where they have their mass already.
    pub fn scatter_momentum(
        &self,
        window: &mut Window<T, D>,
        block: [i32; D],
        (mass, particle, gradient): (T, &Particle<T, D>, &Matrix<T>),
    ) {
        self.each(block, |place, offset| {
            let (weight, arm) = (self.at(offset).0, self.arm(offset));
            let node = &mut window.sums[place];
            for (i, sums) in node.iter_mut().enumerate().take(D) {
                let beside = (0..D).fold(T::ZERO, |sum, j| sum + gradient.0[i][j] * arm[j]);
                sums[0] += particle.mass * (particle.velocity[i] + beside) * weight;
            }
            node[3][0] += mass * weight;
        });
    }

    /// Adds the force of a particle's stress to the window's nodes.
    ///
    /// ```text
    /// f_i += -V sigma grad S_i                Sulsky, Chen and Schreyer (1994)
    /// ```
    /// `stress` is V sigma, tension positive [J].
    pub fn scatter_force(&self, window: &mut Window<T, D>, block: [i32; D], stress: &Symmetric<T>) {
        self.each(block, |place, offset| {
            let force = stress.times(self.at(offset).1);
            for i in 0..D {
                window.sums[place][i][1] -= force[i];
            }
        });
    }

    /// sum S_i of a value at the window's nodes.
    pub fn interpolate(&self, nodes: &[NodeValues<T>; WINDOW_NODES], block: [i32; D]) -> Vector<T, D> {
        let mut sum = Vector::ZERO;
        self.each(block, |place, offset| {
            sum += Vector::from_fn(|i| nodes[place][i]) * self.at(offset).0;
        });
        sum
    }

    /// sum S_i of the last of a node's values.
    pub fn interpolate_mean(&self, nodes: &[NodeValues<T>; WINDOW_NODES], block: [i32; D]) -> T {
        let mut sum = T::ZERO;
        self.each(block, |place, offset| sum += nodes[place][3] * self.at(offset).0);
        sum
    }

    /// sum v_i (x) S_i (x_i - x_p) of a value at the window's nodes, embedded in space [m^2/s].
    pub fn moments(&self, nodes: &[NodeValues<T>; WINDOW_NODES], block: [i32; D]) -> Matrix<T> {
        let mut moments = Matrix::ZERO;
        self.each(block, |place, offset| {
            let (weight, arm) = (self.at(offset).0, self.arm(offset));
            for (row, value) in moments.0.iter_mut().zip(nodes[place]).take(D) {
                for j in 0..D {
                    row[j] += weight * arm[j] * value;
                }
            }
        });
        moments
    }

    /// sum S_i (x_i - x_p) x v_i of a value at the window's nodes; in the plane about the third axis [m^2/s].
    pub fn torque(&self, nodes: &[NodeValues<T>; WINDOW_NODES], block: [i32; D]) -> Vector<T, 3> {
        let mut sum = Vector::ZERO;
        self.each(block, |place, offset| {
            let (weight, arm) = (self.at(offset).0, self.arm(offset));
            let (mut r, mut v) = ([T::ZERO; 3], [T::ZERO; 3]);
            for i in 0..D {
                (r[i], v[i]) = (arm[i], nodes[place][i]);
            }
            let across = |i: usize, j: usize| r[i] * v[j] - r[j] * v[i];
            sum += Vector([across(1, 2), across(2, 0), across(0, 1)]) * weight;
        });
        sum
    }

    /// D = sum S_i (x_i - x_p) (x) (x_i - x_p), embedded in space [m^2].
    pub fn spread(&self) -> Matrix<T> {
        let mut spread = Matrix::ZERO;
        for offset in offsets::<D>(B::WIDTH) {
            let (weight, arm) = (self.at(offset).0, self.arm(offset));
            for i in 0..D {
                (0..D).for_each(|j| spread.0[i][j] += weight * arm[i] * arm[j]);
            }
        }
        spread
    }

    /// L = sum v_i (x) grad S_i, embedded in space [1/s].
    pub fn velocity_gradient(&self, nodes: &[NodeValues<T>; WINDOW_NODES], block: [i32; D]) -> Matrix<T> {
        let mut l = Matrix::ZERO;
        self.each(block, |place, offset| {
            let (velocity, gradient) = (nodes[place], self.at(offset).1);
            for (i, row) in l.0.iter_mut().enumerate().take(D) {
                for (j, entry) in row.iter_mut().enumerate().take(D) {
                    *entry += velocity[i] * gradient[j];
                }
            }
        });
        l
    }
}
