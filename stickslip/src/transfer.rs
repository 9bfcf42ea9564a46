//! Particles to field, field to particles: the sums over the nodes that one particle reaches.

use crate::basis::{Axis, Basis};
use crate::body::Particle;
use crate::grid::{Lattice, Node, SIDE, WINDOW, Window};
use crate::tensor::{Matrix, Real, Symmetric, Vector};
use std::marker::PhantomData;

/// The nodes that one particle reaches, with its shape functions there.
#[derive(Clone, Copy, Debug)]
pub struct Stencil<T, const D: usize, B> {
    axes: [Axis<T>; D],
    /// 1/cell [1/m]
    per_cell: T,
    basis: PhantomData<B>,
}

/// The nodes of a stencil along the last axis.
struct Row<T, const D: usize> {
    /// Place of the first in the window.
    start: usize,
    /// Product of the other axes' weights [-].
    weight: T,
    /// Gradient of that product; nothing along the last axis [1/m].
    slope: Vector<T, D>,
}

impl<T: Real, const D: usize, B: Basis<T>> Stencil<T, D, B> {
    /// The stencil of a particle.
    #[inline(always)]
    pub fn new(lattice: &Lattice<T, D>, particle: &Particle<T, D>) -> Self {
        let per_cell = T::ONE / lattice.cell;
        let x = lattice.cells(particle.position);
        let half = particle.half_width * per_cell;
        Stencil { axes: std::array::from_fn(|i| B::axis(x[i], half)), per_cell, basis: PhantomData }
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
            (0..D).fold(T::ONE, |w, i| w * if i == skip { T::ONE } else { self.axes[i].weight[offset[i]] })
        };
        let gradient = Vector::from_fn(|i| weight(i) * self.axes[i].slope[offset[i]] * self.per_cell);
        (weight(D), gradient)
    }

    /// Calls `f(row)` for every row of nodes along the last axis.
    #[inline(always)]
    fn each_row(&self, block: [i32; D], mut f: impl FnMut(Row<T, D>)) {
        let offsets = self.axes.iter().zip(block).map(|(axis, block)| (axis.base - block * SIDE) as usize);
        let start = offsets.fold(0, |place, offset| place * WINDOW + offset);
        let h = self.per_cell;
        let x = &self.axes[0];
        if D == 2 {
            for i in 0..B::WIDTH {
                let slope = Vector::from_fn(|axis| if axis == 0 { x.slope[i] * h } else { T::ZERO });
                f(Row { start: start + i * WINDOW, weight: x.weight[i], slope });
            }
        } else {
            let y = &self.axes[1];
            for i in 0..B::WIDTH {
                for j in 0..B::WIDTH {
                    let slope = [x.slope[i] * y.weight[j] * h, x.weight[i] * y.slope[j] * h, T::ZERO];
                    let weight = x.weight[i] * y.weight[j];
                    let start = start + (i * WINDOW + j) * WINDOW;
                    f(Row { start, weight, slope: Vector::from_fn(|axis| slope[axis]) });
                }
            }
        }
    }

    /// Weight [-] and gradient [1/m] of a row's node number `k`.
    #[inline(always)]
    fn in_row(&self, row: &Row<T, D>, k: usize) -> (T, Vector<T, D>) {
        let last = &self.axes[D - 1];
        let mut gradient = row.slope * last.weight[k];
        gradient[D - 1] = row.weight * last.slope[k] * self.per_cell;
        (row.weight * last.weight[k], gradient)
    }

    /// Calls `f(node, weight [-], gradient [1/m])` for every node.
    #[inline(always)]
    fn each(&self, window: &Window<T, D>, block: [i32; D], mut f: impl FnMut(&Node<T, D>, T, Vector<T, D>)) {
        self.each_row(block, |row| {
            for (k, node) in window.nodes[row.start..row.start + B::WIDTH].iter().enumerate() {
                let (weight, gradient) = self.in_row(&row, k);
                f(node, weight, gradient);
            }
        });
    }

    /// Calls `f(node, weight [-], gradient [1/m])` for every node, to change it.
    #[inline(always)]
    fn each_mut(
        &self,
        window: &mut Window<T, D>,
        block: [i32; D],
        mut f: impl FnMut(&mut Node<T, D>, T, Vector<T, D>),
    ) {
        self.each_row(block, |row| {
            for (k, node) in window.nodes[row.start..row.start + B::WIDTH].iter_mut().enumerate() {
                let (weight, gradient) = self.in_row(&row, k);
                f(node, weight, gradient);
            }
        });
    }

    /// Adds a particle's mass and momentum to the window's nodes.
    ///
    /// ```text
    /// m_i += S_i m,   p_i += S_i m v          Sulsky, Chen and Schreyer (1994)
    /// ```
    #[inline(always)]
    pub fn scatter_momentum(
        &self,
        window: &mut Window<T, D>,
        block: [i32; D],
        (mass, velocity): (T, Vector<T, D>),
    ) {
        let momentum = velocity * mass;
        self.each_mut(window, block, |node, weight, _| {
            node.mass += mass * weight;
            node.velocity += momentum * weight;
        });
    }

    /// Adds the force of a particle's stress to the window's nodes.
    ///
    /// ```text
    /// f_i += -V sigma grad S_i                Sulsky, Chen and Schreyer (1994)
    /// ```
    /// `stress` is V sigma, tension positive [J].
    #[inline(always)]
    pub fn scatter_force(&self, window: &mut Window<T, D>, block: [i32; D], stress: &Symmetric<T>) {
        let rows: [Vector<T, D>; D] = std::array::from_fn(|i| Vector::from_fn(|j| stress.at(i, j)));
        self.each_mut(window, block, |node, _, gradient| {
            node.force -= Vector::from_fn(|i| rows[i].dot(gradient));
        });
    }

    /// sum S_i of `value` over the window's nodes.
    #[inline(always)]
    pub fn interpolate<const N: usize>(
        &self,
        window: &Window<T, D>,
        block: [i32; D],
        value: impl Fn(&Node<T, D>) -> [Vector<T, D>; N],
    ) -> [Vector<T, D>; N] {
        let mut sum = [Vector::ZERO; N];
        self.each(window, block, |node, weight, _| {
            for (sum, value) in sum.iter_mut().zip(value(node)) {
                *sum += value * weight;
            }
        });
        sum
    }

    /// L = sum v_i (x) grad S_i, embedded in space [1/s].
    #[inline(always)]
    pub fn velocity_gradient(&self, window: &Window<T, D>, block: [i32; D]) -> Matrix<T> {
        let mut l = Matrix::ZERO;
        self.each(window, block, |node, _, gradient| {
            for i in 0..D {
                for j in 0..D {
                    l.0[i][j] += node.velocity[i] * gradient[j];
                }
            }
        });
        l
    }
}

/// Whole steps from 0 to below `width` along every axis: the nodes that a basis reaches from its base node.
pub fn offsets<const D: usize>(width: usize) -> impl Iterator<Item = [usize; D]> {
    (0..width.pow(D as u32)).map(move |i| {
        let mut rest = i;
        let mut offset = [0; D];
        for o in offset.iter_mut().rev() {
            *o = rest % width;
            rest /= width;
        }
        offset
    })
}
