//! Particles to field, field to particles: the sums over the nodes that one particle reaches.

use crate::basis::{Axis, Basis, MAX_WIDTH};
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

    /// Calls `f(place in the window, weight [-], gradient [1/m])` for every node.
    #[inline(always)]
    fn each(&self, block: [i32; D], mut f: impl FnMut(usize, T, Vector<T, D>)) {
        let offsets = self.axes.iter().zip(block).map(|(axis, block)| (axis.base - block * SIDE) as usize);
        let place = offsets.fold(0, |place, offset| place * WINDOW + offset);
        let h = self.per_cell;
        if D == 2 {
            let (x, y) = (&self.axes[0], &self.axes[1]);
            for i in 0..B::WIDTH {
                for j in 0..B::WIDTH {
                    let gradient = [x.slope[i] * y.weight[j] * h, x.weight[i] * y.slope[j] * h];
                    f(place + i * WINDOW + j, x.weight[i] * y.weight[j], Vector::from_fn(|k| gradient[k]));
                }
            }
        } else {
            let (x, y, z) = (&self.axes[0], &self.axes[1], &self.axes[D - 1]);
            for i in 0..B::WIDTH {
                for j in 0..B::WIDTH {
                    let (xy, dxy, xdy) = (
                        x.weight[i] * y.weight[j],
                        x.slope[i] * y.weight[j] * h,
                        x.weight[i] * y.slope[j] * h,
                    );
                    for k in 0..B::WIDTH {
                        let gradient = [dxy * z.weight[k], xdy * z.weight[k], xy * z.slope[k] * h];
                        f(
                            place + (i * WINDOW + j) * WINDOW + k,
                            xy * z.weight[k],
                            Vector::from_fn(|k| gradient[k]),
                        );
                    }
                }
            }
        }
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
        self.each(block, |place, weight, _| {
            let node = &mut window.nodes[place];
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
        self.each(block, |place, _, gradient| {
            window.nodes[place].force -= Vector::from_fn(|i| rows[i].dot(gradient));
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
        self.each(block, |place, weight, _| {
            for (sum, value) in sum.iter_mut().zip(value(&window.nodes[place])) {
                *sum += value * weight;
            }
        });
        sum
    }

    /// L = sum v_i (x) grad S_i, embedded in space [1/s].
    #[inline(always)]
    pub fn velocity_gradient(&self, window: &Window<T, D>, block: [i32; D]) -> Matrix<T> {
        let mut l = Matrix::ZERO;
        self.each(block, |place, _, gradient| {
            let v = window.nodes[place].velocity;
            for i in 0..D {
                for j in 0..D {
                    l.0[i][j] += v[i] * gradient[j];
                }
            }
        });
        l
    }
}

/// Offsets of the nodes that a basis reaches from its base node.
pub fn offsets<const D: usize>(width: usize) -> impl Iterator<Item = [usize; D]> {
    debug_assert!(width <= MAX_WIDTH, "no basis is wider");
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
