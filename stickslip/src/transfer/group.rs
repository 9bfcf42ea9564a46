//! Transfer for several particles of one cell at once: they share their nodes.
//!
//! A gather has a particle in each lane and hands every node's values to all of them. A scatter has the components of momentum or force
//! in the lanes and adds up one particle after the other, in the order in which they come. Sums run axis by axis.

// Sums over nodes and components read better by their indices.
#![allow(clippy::needless_range_loop)]

use crate::basis::{Basis, MAX_WIDTH, Shape};
use crate::grid::{WINDOW, WINDOW_NODES, Window};
use crate::lanes::{Lanes, MOST_LANES, Machine, Numbers};
use crate::tensor::{Matrix, Number, Real, Symmetric, Vector};
use std::marker::PhantomData;

/// Several particles of one cell with their shape functions.
#[derive(Clone, Copy, Debug)]
pub struct Group<V, const D: usize, B> {
    shapes: [Shape<V>; D],
    /// Place in the window of the cell's base node.
    start: usize,
    /// How many particles; lanes beyond repeat the first.
    count: usize,
    basis: PhantomData<B>,
}

/// What a group scatters.
#[derive(Clone, Copy, Debug)]
pub struct Load<V, const D: usize> {
    /// Momentum [kg m/s] and mass [kg].
    pub momentum: Option<(Vector<V, D>, V)>,
    /// V sigma/h, tension positive [N].
    pub stress: Option<Symmetric<V>>,
}

/// Nodes of a window that come before the last reach of a particle.
const fn last_start(dimension: usize) -> usize {
    let mut place = 0;
    let mut axis = 0;
    while axis < dimension {
        place = place * WINDOW + WINDOW - MAX_WIDTH;
        axis += 1;
    }
    place
}

impl<V: Lanes, const D: usize, B: Basis<V::Real>> Group<V, D, B> {
    /// Particles at `r` from their base node with half-widths `half` [cells], `count` of them; `start` is the base node's place in the window.
    #[inline(always)]
    pub fn new(r: Vector<V, D>, half: V, start: usize, count: usize) -> Self {
        assert!(start <= last_start(D), "a tile's cells lie in its block");
        // No closure: the compiler may leave one of this size uninlined, and then its instructions are calls.
        let mut shapes = [B::shape(r[0], half); D];
        for i in 1..D {
            shapes[i] = B::shape(r[i], half);
        }
        Group { shapes, start, count, basis: PhantomData }
    }

    /// Place of a node in the window.
    #[inline(always)]
    fn place(&self, i: usize, j: usize, k: usize) -> usize {
        self.start + if D == 2 { i * WINDOW + j } else { (i * WINDOW + j) * WINDOW + k }
    }

    /// Nodes along the third axis.
    const DEPTH: usize = if D == 2 { 1 } else { B::WIDTH };

    /// sum S_i of a value at the nodes.
    #[inline(always)]
    pub fn interpolate(&self, nodes: &[Vector<V::Real, D>; WINDOW_NODES]) -> Vector<V, D> {
        let mut sum = Vector::ZERO;
        for i in 0..B::WIDTH {
            let mut plane = Vector::<V, D>::ZERO;
            for j in 0..B::WIDTH {
                let mut row = Vector::<V, D>::ZERO;
                for k in 0..Self::DEPTH {
                    let node = &nodes[self.place(i, j, k)];
                    for c in 0..D {
                        let value = V::splat(node[c]);
                        row[c] = if D == 2 { value } else { row[c] + self.shapes[D - 1].weight[k] * value };
                    }
                }
                plane += row * self.shapes[1].weight[j];
            }
            sum += plane * self.shapes[0].weight[i];
        }
        sum
    }

    /// h L = sum v_i (x) h grad S_i, embedded in space [m/s].
    #[inline(always)]
    pub fn velocity_gradient(&self, nodes: &[Vector<V::Real, D>; WINDOW_NODES]) -> Matrix<V> {
        let [x, y, z] = [&self.shapes[0], &self.shapes[1], &self.shapes[D - 1]];
        let mut l = Matrix::<V>::ZERO;
        for i in 0..B::WIDTH {
            // Sums over a plane of nodes: of values, and of slopes along y and z.
            let mut plane = [[V::ZERO; D]; 3];
            for j in 0..B::WIDTH {
                let (mut row, mut sloped) = ([V::ZERO; D], [V::ZERO; D]);
                for k in 0..Self::DEPTH {
                    let node = &nodes[self.place(i, j, k)];
                    for c in 0..D {
                        let value = V::splat(node[c]);
                        if D == 2 {
                            row[c] = value;
                        } else {
                            row[c] += z.weight[k] * value;
                            sloped[c] += z.slope[k] * value;
                        }
                    }
                }
                for c in 0..D {
                    plane[0][c] += y.weight[j] * row[c];
                    plane[1][c] += y.slope[j] * row[c];
                    if D == 3 {
                        plane[2][c] += y.weight[j] * sloped[c];
                    }
                }
            }
            for c in 0..D {
                l.0[c][0] += x.slope[i] * plane[0][c];
                l.0[c][1] += x.weight[i] * plane[1][c];
                if D == 3 {
                    l.0[c][2] += x.weight[i] * plane[2][c];
                }
            }
        }
        l
    }

    /// Adds what the particles scatter to the window, one particle after the other.
    ///
    /// ```text
    /// m_i += S_i m,   p_i += S_i m v,   f_i += -V sigma grad S_i          Sulsky, Chen and Schreyer (1994)
    /// ```
    #[inline(always)]
    pub fn scatter<M: Machine<V::Real>>(&self, window: &mut Window<V::Real, D>, load: &Load<V, D>) {
        if let Some((momentum, mass)) = load.momentum {
            let z = if D == 2 { V::ZERO } else { momentum[D - 1] };
            self.scatter_momentum::<M>(window, &rows([momentum[0], momentum[1], z, mass]));
        }
        if let Some(stress) = load.stress {
            let [xx, yy, zz, xy, yz, xz] = (stress * -V::ONE).0;
            let x = rows([xx, xy, xz, V::ZERO]);
            let y = rows([xy, yy, yz, V::ZERO]);
            let z = if D == 2 { y } else { rows([xz, yz, zz, V::ZERO]) };
            self.scatter_force::<M>(window, [&x, &y, &z]);
        }
    }

    #[inline(always)]
    fn scatter_momentum<M: Machine<V::Real>>(&self, window: &mut Window<V::Real, D>, load: &Rows<V::Real>) {
        let along = numbers(&self.shapes[0].weight);
        for j in 0..B::WIDTH {
            for k in 0..Self::DEPTH {
                let across = self.across(j, k).numbers();
                let mut sums = [M::Quad::ZERO; MAX_WIDTH];
                for p in 0..self.count.min(MOST_LANES) {
                    let row = load.get::<M>(p) * M::Quad::splat(across.0[p]);
                    for i in 0..B::WIDTH {
                        sums[i] += row * M::Quad::splat(along[i].0[p]);
                    }
                }
                for i in 0..B::WIDTH {
                    add::<M, _>(&mut window.momentum[self.place(i, j, k)], sums[i]);
                }
            }
        }
    }

    #[inline(always)]
    fn scatter_force<M: Machine<V::Real>>(&self, window: &mut Window<V::Real, D>, load: [&Rows<V::Real>; 3]) {
        let [x, y, z] = [&self.shapes[0], &self.shapes[1], &self.shapes[D - 1]];
        let (weight, slope) = (numbers(&x.weight), numbers(&x.slope));
        for j in 0..B::WIDTH {
            for k in 0..Self::DEPTH {
                let across = self.across(j, k).numbers();
                let across_y = if D == 2 { y.slope[j] } else { y.slope[j] * z.weight[k] }.numbers();
                let across_z = if D == 2 { V::ZERO } else { y.weight[j] * z.slope[k] }.numbers();
                let mut sums = [M::Quad::ZERO; MAX_WIDTH];
                for p in 0..self.count.min(MOST_LANES) {
                    let sloped = load[0].get::<M>(p) * M::Quad::splat(across.0[p]);
                    let mut level = load[1].get::<M>(p) * M::Quad::splat(across_y.0[p]);
                    if D == 3 {
                        level += load[2].get::<M>(p) * M::Quad::splat(across_z.0[p]);
                    }
                    for i in 0..B::WIDTH {
                        sums[i] +=
                            level * M::Quad::splat(weight[i].0[p]) + sloped * M::Quad::splat(slope[i].0[p]);
                    }
                }
                for i in 0..B::WIDTH {
                    add::<M, _>(&mut window.force[self.place(i, j, k)], sums[i]);
                }
            }
        }
    }

    /// Product of the weights across the first axis.
    #[inline(always)]
    fn across(&self, j: usize, k: usize) -> V {
        let weight = self.shapes[1].weight[j];
        if D == 2 { weight } else { weight * self.shapes[D - 1].weight[k] }
    }
}

/// Four numbers of each particle of a group.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Rows<T>([[T; 4]; MOST_LANES]);

impl<T: Real> Rows<T> {
    #[inline(always)]
    fn get<M: Machine<T>>(&self, particle: usize) -> M::Quad {
        // SAFETY: a row is four numbers.
        unsafe { M::Quad::load(self.0[particle].as_ptr()) }
    }
}

#[inline(always)]
fn rows<V: Lanes>(columns: [V; 4]) -> Rows<V::Real> {
    let mut rows = Rows([[V::Real::ZERO; 4]; MOST_LANES]);
    V::store_rows(columns, &mut rows.0);
    rows
}

#[inline(always)]
fn numbers<V: Lanes>(lanes: &[V; MAX_WIDTH]) -> [Numbers<V::Real>; MAX_WIDTH] {
    [lanes[0].numbers(), lanes[1].numbers(), lanes[2].numbers()]
}

#[inline(always)]
fn add<M: Machine<T>, T: Real>(node: &mut [T; 4], sum: M::Quad) {
    // SAFETY: a node has four numbers, borrowed for writing.
    unsafe { (M::Quad::load(node.as_ptr()) + sum).store(node.as_mut_ptr()) }
}
