//! Transfer for several particles at once: of one cell, which share their nodes, or of several cells of a tile.
//!
//! A gather has a particle in each lane and hands every node's values to all of them. A scatter has the components of
//! momentum or force of two particles in the lanes and adds up one pair after the other,
//! in the order in which they come.

// Sums over nodes and components read better by their indices.
#![allow(clippy::needless_range_loop)]

use super::corners::NodeTable;
use crate::basis::{Basis, BoxSide, Entries, Line, Neighbours, Plane, ShapeFunctions, Space};
use crate::grid::{NODE_VALUES, NodeSums, NodeValues, SIDE, WINDOW_NODES, Window, window_side};
use crate::lanes::{Lanes, MOST_LANES, Machine, Numbers};
use crate::tensor::{Matrix, Number, Real, Symmetric, Vector};
use std::marker::PhantomData;

/// Where in the window the nodes of a group's particles begin: the place of their base node.
pub trait Start: Copy {
    /// Of the particle in a lane.
    fn of(&self, lane: usize) -> usize;

    /// A component of the value at the node that comes `offset` after the base node.
    fn value<V: Lanes>(
        &self,
        nodes: &[NodeValues<V::Real>; WINDOW_NODES],
        offset: usize,
        component: usize,
    ) -> V;

    /// The place of all, if they share one.
    fn shared(&self) -> Option<usize>;
}

/// Particles of one cell.
#[derive(Clone, Copy, Debug)]
pub struct CellGroup(usize);

/// Particles each of a cell of its own.
#[derive(Clone, Copy, Debug)]
pub struct Own([usize; MOST_LANES]);

impl CellGroup {
    /// Particles whose base node has a place in a window with this side.
    #[inline(always)]
    pub fn new<const D: usize>(start: usize, window: usize) -> Self {
        assert!(start <= last_start(D, window), "a tile's cells lie in its block");
        CellGroup(start)
    }
}

impl Own {
    /// Particles whose base nodes have places in a window with this side.
    #[inline(always)]
    pub fn new<const D: usize>(starts: [usize; MOST_LANES], window: usize) -> Self {
        for start in starts {
            assert!(start <= last_start(D, window), "a tile's cells lie in its block");
        }
        Own(starts)
    }
}

impl Start for CellGroup {
    #[inline(always)]
    fn of(&self, _lane: usize) -> usize {
        self.0
    }

    #[inline(always)]
    fn value<V: Lanes>(
        &self,
        nodes: &[NodeValues<V::Real>; WINDOW_NODES],
        offset: usize,
        component: usize,
    ) -> V {
        V::splat(nodes[self.0 + offset][component])
    }

    #[inline(always)]
    fn shared(&self) -> Option<usize> {
        Some(self.0)
    }
}

impl Start for Own {
    #[inline(always)]
    fn of(&self, lane: usize) -> usize {
        self.0[lane]
    }

    #[inline(always)]
    fn value<V: Lanes>(
        &self,
        nodes: &[NodeValues<V::Real>; WINDOW_NODES],
        offset: usize,
        component: usize,
    ) -> V {
        let mut index = [0; MOST_LANES];
        for lane in 0..V::COUNT {
            index[lane] = (self.0[lane] + offset) * NODE_VALUES + component;
        }
        // SAFETY: an offset is at most a particle's reach, and starts are before the last one.
        unsafe { V::gather(nodes.as_ptr().cast(), &index) }
    }

    #[inline(always)]
    fn shared(&self) -> Option<usize> {
        None
    }
}

/// Several particles of one tile with their shape functions.
#[derive(Clone, Copy, Debug)]
pub struct Group<V: Lanes, const D: usize, B: Basis<V::Real>, S> {
    shapes: [ShapeFunctions<V, B::Width>; D],
    /// Weights and slopes of bases that are no product over the axes, see [`Basis::CORNERS`].
    table: B::Table<V, D>,
    /// Places after the base nodes [cells].
    r: Vector<V, D>,
    start: S,
    /// How many particles; lanes beyond have their place.
    count: usize,
    basis: PhantomData<B>,
}

/// What a group scatters.
#[derive(Clone, Copy, Debug)]
pub struct ScatterTerms<V, const D: usize> {
    /// Momentum and mass.
    pub momentum: Option<Momentum<V, D>>,
    /// V sigma/h, tension positive [N].
    pub stress: Option<Symmetric<V>>,
}

/// Momentum that a group scatters.
#[derive(Clone, Copy, Debug)]
pub struct Momentum<V, const D: usize> {
    /// m v [kg m/s]
    pub own: Vector<V, D>,
    /// m h G: change of the momentum by a cell along each axis, embedded in space [kg m/s].
    pub per_cell: Matrix<V>,
    /// Mass that nodes are given [kg].
    pub mass: V,
}

/// An entry for each node of one plane, and of another.
type TwoPlanes<B, T, X> = (Plane<B, T, X>, Plane<B, T, X>);

/// Place of the last base node that a particle may have in a window with this side.
#[inline(always)]
const fn last_start(dimension: usize, window: usize) -> usize {
    let mut place = 0;
    let mut axis = 0;
    while axis < dimension {
        place = place * window + SIDE as usize - 1;
        axis += 1;
    }
    place
}

impl<V: Lanes, const D: usize, B: Basis<V::Real>, S: Start> Group<V, D, B, S> {
    /// Particles at `r` from their base nodes [cells], `count` of them, with boxes of these sides, or with domains that
    /// have these half edges [cells]; `start` has the base nodes' places in the window.
    #[inline(always)]
    pub fn new(
        r: Vector<V, D>,
        (sides, edges): (&[BoxSide<V>; D], &Matrix<V>),
        start: S,
        count: usize,
    ) -> Self {
        // No closure: the compiler may leave one of this size uninlined, and then its instructions are calls.
        let mut shapes = [B::shape(r[0], &sides[0]); D];
        for i in 1..D {
            shapes[i] = B::shape(r[i], &sides[i]);
        }
        Group { shapes, table: B::Table::<V, D>::new(&r, edges), r, start, count, basis: PhantomData }
    }

    /// Place of a node in the window, after that of the base node.
    #[inline(always)]
    fn offset(i: usize, j: usize, k: usize) -> usize {
        if D == 2 { i * Self::WINDOW + j } else { (i * Self::WINDOW + j) * Self::WINDOW + k }
    }

    /// Nodes along a side of the window.
    const WINDOW: usize = window_side(B::WIDTH);

    /// Nodes along the third axis.
    const DEPTH: usize = if D == 2 { 1 } else { B::WIDTH };

    /// G2P: sum S_i of a value at the nodes.
    #[inline(always)]
    pub fn interpolate(&self, nodes: &[NodeValues<V::Real>; WINDOW_NODES]) -> Vector<V, D> {
        let mut sum = [V::NOTHING; D];
        if B::CORNERS {
            for (n, [i, j, k]) in Self::nodes() {
                for c in 0..D {
                    let value: V = self.start.value(nodes, Self::offset(i, j, k), c);
                    sum[c] = self.table.weight(n).times_plus(value, sum[c]);
                }
            }
            return Vector(sum);
        }
        let [x, y, z] = [&self.shapes[0], &self.shapes[1], &self.shapes[D - 1]];
        for i in 0..B::WIDTH {
            let mut plane = [V::NOTHING; D];
            for j in 0..B::WIDTH {
                let mut row = [V::NOTHING; D];
                for k in 0..Self::DEPTH {
                    for c in 0..D {
                        let value: V = self.start.value(nodes, Self::offset(i, j, k), c);
                        row[c] = if D == 2 { value } else { z.weight[k].times_plus(value, row[c]) };
                    }
                }
                for c in 0..D {
                    plane[c] = y.weight[j].times_plus(row[c], plane[c]);
                }
            }
            for c in 0..D {
                sum[c] = x.weight[i].times_plus(plane[c], sum[c]);
            }
        }
        Vector(sum)
    }

    /// G2P: sum S_i of the last of a node's values.
    #[inline(always)]
    pub fn interpolate_mean(&self, nodes: &[NodeValues<V::Real>; WINDOW_NODES]) -> V {
        let mut sum = V::NOTHING;
        for (n, [i, j, k]) in Self::nodes() {
            let value: V = self.start.value(nodes, Self::offset(i, j, k), NODE_VALUES - 1);
            sum = self.weight(n, [i, j, k]).times_plus(value, sum);
        }
        sum
    }

    /// G2P: h L = sum v_i (x) h grad S_i, embedded in space, and sum S_i v_i of the same velocities [m/s].
    #[inline(always)]
    pub fn flow(&self, nodes: &[NodeValues<V::Real>; WINDOW_NODES]) -> (Matrix<V>, Vector<V, D>) {
        if B::CORNERS { self.sums_of_slopes(nodes) } else { self.sums(nodes, &self.slopes()) }
    }

    #[inline(always)]
    fn slopes(&self) -> [Line<B, V::Real, V>; D] {
        let mut slopes = [Line::<B, V::Real, V>::all(V::ZERO); D];
        for axis in 0..D {
            for i in 0..B::WIDTH {
                slopes[axis][i] = self.shapes[axis].slope(i);
            }
        }
        slopes
    }

    /// G2P: sum v_i (x) S_i (x_i - x_p) over h, embedded in space, and sum S_i v_i [m/s].
    #[inline(always)]
    pub fn moments(&self, nodes: &[NodeValues<V::Real>; WINDOW_NODES]) -> (Matrix<V>, Vector<V, D>) {
        if B::CORNERS {
            return self.sums_of_arms(nodes);
        }
        let mut arms = [Line::<B, V::Real, V>::all(V::ZERO); D];
        for axis in 0..D {
            for i in 0..B::WIDTH {
                arms[axis][i] = self.shapes[axis].weight[i] * (V::of(i as f64) - self.r[axis]);
            }
        }
        self.sums(nodes, &arms)
    }

    /// sum S_i (x_i - x_p) (x) (x_i - x_p) over h^2, embedded in space.
    #[inline(always)]
    pub fn spread(&self) -> Matrix<V> {
        let mut spread = Matrix::<V>::ZERO;
        if B::CORNERS {
            for (n, at) in Self::nodes() {
                for a in 0..D {
                    let share = self.table.weight(n) * (V::of(at[a] as f64) - self.r[a]);
                    for b in 0..D {
                        let arm = V::of(at[b] as f64) - self.r[b];
                        spread.0[a][b] = share.times_plus(arm, spread.0[a][b]);
                    }
                }
            }
            return spread;
        }
        for axis in 0..D {
            for i in 0..B::WIDTH {
                let arm = V::of(i as f64) - self.r[axis];
                let share = self.shapes[axis].weight[i] * arm;
                spread.0[axis][axis] = share.times_plus(arm, spread.0[axis][axis]);
            }
        }
        spread
    }

    /// Sums of v_i, by components, with the shape function's factor along each axis in turn replaced by another one,
    /// and with none.
    #[inline(always)]
    fn sums(
        &self,
        nodes: &[NodeValues<V::Real>; WINDOW_NODES],
        others: &[Line<B, V::Real, V>; D],
    ) -> (Matrix<V>, Vector<V, D>) {
        let [x, y, z] = [&self.shapes[0], &self.shapes[1], &self.shapes[D - 1]];
        let [other_x, other_y, other_z] = [&others[0], &others[1], &others[D - 1]];
        let mut sums = Matrix::<V>::ZERO;
        for c in 0..D {
            for axis in 0..D {
                sums.0[c][axis] = V::NOTHING;
            }
        }
        let mut sum = Vector([V::NOTHING; D]);
        for i in 0..B::WIDTH {
            // Sums over a plane of nodes: of values, and with the other factors along y and z.
            let mut plane = [[V::NOTHING; D]; 3];
            for j in 0..B::WIDTH {
                let (mut row, mut other) = ([V::NOTHING; D], [V::NOTHING; D]);
                for k in 0..Self::DEPTH {
                    for c in 0..D {
                        let value: V = self.start.value(nodes, Self::offset(i, j, k), c);
                        if D == 2 {
                            row[c] = value;
                        } else {
                            row[c] = z.weight[k].times_plus(value, row[c]);
                            other[c] = other_z[k].times_plus(value, other[c]);
                        }
                    }
                }
                for c in 0..D {
                    plane[0][c] = y.weight[j].times_plus(row[c], plane[0][c]);
                    plane[1][c] = other_y[j].times_plus(row[c], plane[1][c]);
                    if D == 3 {
                        plane[2][c] = y.weight[j].times_plus(other[c], plane[2][c]);
                    }
                }
            }
            for c in 0..D {
                sum[c] = x.weight[i].times_plus(plane[0][c], sum[c]);
                sums.0[c][0] = other_x[i].times_plus(plane[0][c], sums.0[c][0]);
                sums.0[c][1] = x.weight[i].times_plus(plane[1][c], sums.0[c][1]);
                if D == 3 {
                    sums.0[c][2] = x.weight[i].times_plus(plane[2][c], sums.0[c][2]);
                }
            }
        }
        (sums, sum)
    }

    /// [`Group::flow`] by slopes node by node.
    #[inline(always)]
    fn sums_of_slopes(&self, nodes: &[NodeValues<V::Real>; WINDOW_NODES]) -> (Matrix<V>, Vector<V, D>) {
        let (mut sums, mut sum) = (Matrix::<V>::ZERO, Vector::ZERO);
        for (n, [i, j, k]) in Self::nodes() {
            for c in 0..D {
                let value: V = self.start.value(nodes, Self::offset(i, j, k), c);
                sum[c] = self.table.weight(n).times_plus(value, sum[c]);
                for axis in 0..D {
                    sums.0[c][axis] = self.table.slope(n, axis).times_plus(value, sums.0[c][axis]);
                }
            }
        }
        (sums, sum)
    }

    /// [`Group::moments`] by weights node by node.
    #[inline(always)]
    fn sums_of_arms(&self, nodes: &[NodeValues<V::Real>; WINDOW_NODES]) -> (Matrix<V>, Vector<V, D>) {
        let (mut sums, mut sum) = (Matrix::<V>::ZERO, Vector::ZERO);
        for (n, at) in Self::nodes() {
            for c in 0..D {
                let value: V = self.start.value(nodes, Self::offset(at[0], at[1], at[2]), c);
                let value = self.table.weight(n) * value;
                sum[c] += value;
                for axis in 0..D {
                    let arm = V::of(at[axis] as f64) - self.r[axis];
                    sums.0[c][axis] = arm.times_plus(value, sums.0[c][axis]);
                }
            }
        }
        (sums, sum)
    }

    /// P2G: adds what the particles scatter to the window, two particles at a time.
    ///
    /// ```text
    /// m_i += S_i m,   p_i += S_i m (v + G (x_i - x_p)),   f_i += -V sigma grad S_i
    /// ```
    #[inline(always)]
    pub fn scatter<M: Machine<V::Real>>(&self, window: &mut Window<V::Real, D>, load: &ScatterTerms<V, D>) {
        let n = self.count;
        // No closures, see `Group::new`.
        let mut pairs = PairLoad { momentum: None, stress: None };
        if let Some(Momentum { own, per_cell: Matrix(m), mass }) = load.momentum {
            // At the base node.
            let mut first = own;
            for c in 0..D {
                for axis in 0..D {
                    first[c] = (-m[c][axis]).times_plus(self.r[axis], first[c]);
                }
            }
            pairs.momentum = Some(MomentumRows {
                first: RowsOfLanes::of::<V, D>([first[0], first[1], first[D - 1], mass], n),
                steps: [
                    RowsOfLanes::of::<V, D>([m[0][0], m[1][0], m[2][0], V::ZERO], n),
                    RowsOfLanes::of::<V, D>([m[0][1], m[1][1], m[2][1], V::ZERO], n),
                    if D == 2 {
                        RowsOfLanes::ZERO
                    } else {
                        RowsOfLanes::of::<V, D>([m[0][2], m[1][2], m[2][2], V::ZERO], n)
                    },
                ],
            });
        }
        if let Some(stress) = load.stress {
            let [xx, yy, zz, xy, yz, xz] = stress.0;
            let [xx, yy, zz] = [xx.first(n), yy.first(n), zz.first(n)];
            let [xy, yz, xz] = [xy.first(n), yz.first(n), xz.first(n)];
            let x = RowsOfLanes::new([xx, xy, xz, V::ZERO]);
            let y = RowsOfLanes::new([xy, yy, yz, V::ZERO]);
            let z = if D == 2 { y } else { RowsOfLanes::new([xz, yz, zz, V::ZERO]) };
            pairs.stress = Some([x, y, z]);
        }
        match self.start.shared() {
            Some(start) if B::CORNERS => self.scatter_by_nodes::<M>(window, start, &pairs),
            // A number that the compiler knows, so that loops over pairs are unrolled.
            Some(start) if n == V::COUNT => {
                Group { count: V::COUNT, ..*self }.scatter_together::<M>(window, start, &pairs);
            }
            Some(start) => self.scatter_together::<M>(window, start, &pairs),
            None => self.scatter_singly::<M>(window, &pairs),
        }
    }

    /// For particles that share their nodes: sums over particles first.
    #[inline(always)]
    fn scatter_together<M: Machine<V::Real>>(
        &self,
        window: &mut Window<V::Real, D>,
        start: usize,
        PairLoad { momentum, stress }: &PairLoad<V::Real>,
    ) {
        let mut below = Plane::<B, V::Real, _>::all(M::Wide::ZERO);
        for i in 0..B::WIDTH {
            let [mut momenta, mut forces] = [Plane::<B, V::Real, _>::all(M::Wide::ZERO); 2];
            if let Some(momentum) = momentum {
                momenta = self.momenta::<M>(i, momentum);
            }
            if let Some(stress) = stress {
                (forces, below) = self.forces::<M>(i, stress, &below);
            }
            for j in 0..B::WIDTH {
                for k in 0..Self::DEPTH {
                    let n = j * Self::DEPTH + k;
                    add::<M, _>(&mut window.sums[start + Self::offset(i, j, k)], momenta[n], forces[n]);
                }
            }
        }
    }

    /// Momentum and mass that the nodes of a plane across the first axis get.
    #[inline(always)]
    fn momenta<M: Machine<V::Real>>(
        &self,
        i: usize,
        load: &MomentumRows<V::Real>,
    ) -> Plane<B, V::Real, M::Wide> {
        let mut weights = Plane::<B, V::Real, _>::all(Numbers::ZERO);
        for j in 0..B::WIDTH {
            for k in 0..Self::DEPTH {
                weights[j * Self::DEPTH + k] = (self.shapes[0].weight[i] * self.across(j, k)).numbers();
            }
        }
        let mut sums = Plane::<B, V::Real, _>::all(M::Wide::NOTHING);
        for pair in 0..self.pairs() {
            let along_x = load.steps[0].get::<M>(pair);
            let along_y = load.steps[1].get::<M>(pair);
            let along_z = load.steps[2].get::<M>(pair);
            // From node to node.
            let mut line = along_x.times_plus(M::Wide::of(i as f64), load.first.get::<M>(pair));
            for j in 0..B::WIDTH {
                let mut row = line;
                for k in 0..Self::DEPTH {
                    let n = j * Self::DEPTH + k;
                    sums[n] = row.times_plus(factors::<M, _>(&weights[n], pair), sums[n]);
                    if k + 1 < Self::DEPTH {
                        row += along_z;
                    }
                }
                if j + 1 < B::WIDTH {
                    line += along_y;
                }
            }
        }
        sums
    }

    /// Forces that the nodes of a plane across the first axis get, and what passes to the next plane, given what passed
    /// to this one: sums over particles stand between two neighbours, one of which gets what the other one gives.
    #[inline(always)]
    fn forces<M: Machine<V::Real>>(
        &self,
        i: usize,
        load: &[RowsOfLanes<V::Real>; 3],
        below: &Plane<B, V::Real, M::Wide>,
    ) -> TwoPlanes<B, V::Real, M::Wide> {
        let [x, y, z] = [&self.shapes[0], &self.shapes[1], &self.shapes[D - 1]];
        // To the next plane of nodes, and within this one.
        let mut along_x = Plane::<B, V::Real, _>::all(Numbers::ZERO);
        let [mut along_y, mut along_z] = [Neighbours::<B, V::Real, _>::all(Numbers::ZERO); 2];
        for j in 0..B::WIDTH {
            for k in 0..Self::DEPTH {
                if i + 1 < B::WIDTH {
                    along_x[j * Self::DEPTH + k] = (self.across(j, k) * x.difference[i]).numbers();
                }
                if j + 1 < B::WIDTH {
                    let weight = if D == 2 { x.weight[i] } else { x.weight[i] * z.weight[k] };
                    along_y[j * Self::DEPTH + k] = (weight * y.difference[j]).numbers();
                }
                if k + 1 < Self::DEPTH {
                    along_z[j * (Self::DEPTH - 1) + k] =
                        (x.weight[i] * y.weight[j] * z.difference[k]).numbers();
                }
            }
        }
        let mut above = Plane::<B, V::Real, _>::all(M::Wide::NOTHING);
        if i + 1 < B::WIDTH {
            for pair in 0..self.pairs() {
                let row = load[0].get::<M>(pair);
                for n in 0..B::WIDTH * Self::DEPTH {
                    above[n] = row.times_plus(factors::<M, _>(&along_x[n], pair), above[n]);
                }
            }
        }
        let [mut right, mut back] = [Neighbours::<B, V::Real, _>::all(M::Wide::NOTHING); 2];
        for pair in 0..self.pairs() {
            let (row_y, row_z) = (load[1].get::<M>(pair), load[2].get::<M>(pair));
            for n in 0..(B::WIDTH - 1) * Self::DEPTH {
                right[n] = row_y.times_plus(factors::<M, _>(&along_y[n], pair), right[n]);
            }
            for n in 0..B::WIDTH * (Self::DEPTH - 1) {
                back[n] = row_z.times_plus(factors::<M, _>(&along_z[n], pair), back[n]);
            }
        }
        let mut forces = Plane::<B, V::Real, _>::all(M::Wide::ZERO);
        for j in 0..B::WIDTH {
            for k in 0..Self::DEPTH {
                let n = j * Self::DEPTH + k;
                let mut sum = above[n] - below[n];
                if j + 1 < B::WIDTH {
                    sum += right[n];
                }
                if j > 0 {
                    sum -= right[n - Self::DEPTH];
                }
                if k + 1 < Self::DEPTH {
                    sum += back[j * (Self::DEPTH - 1) + k];
                }
                if k > 0 {
                    sum -= back[j * (Self::DEPTH - 1) + k - 1];
                }
                forces[n] = sum;
            }
        }
        (forces, above)
    }

    /// For particles that share their nodes, by weights and slopes node by node.
    #[inline(always)]
    fn scatter_by_nodes<M: Machine<V::Real>>(
        &self,
        window: &mut Window<V::Real, D>,
        start: usize,
        PairLoad { momentum, stress }: &PairLoad<V::Real>,
    ) {
        for (n, at) in Self::nodes() {
            let [mut given, mut force] = [M::Wide::NOTHING; 2];
            if let Some(MomentumRows { first, steps }) = momentum {
                let weights = self.weight(n, at).numbers();
                for pair in 0..self.pairs() {
                    let mut row = first.get::<M>(pair);
                    for axis in 0..D {
                        row = steps[axis].get::<M>(pair).times_plus(M::Wide::of(at[axis] as f64), row);
                    }
                    given = row.times_plus(factors::<M, _>(&weights, pair), given);
                }
            }
            if let Some(stress) = stress {
                for axis in 0..D {
                    let slopes = (-self.table.slope(n, axis)).numbers();
                    for pair in 0..self.pairs() {
                        let row = stress[axis].get::<M>(pair);
                        force = row.times_plus(factors::<M, _>(&slopes, pair), force);
                    }
                }
            }
            let [i, j, k] = at;
            add::<M, _>(&mut window.sums[start + Self::offset(i, j, k)], given, force);
        }
    }

    /// For particles that share no nodes.
    #[inline(always)]
    fn scatter_singly<M: Machine<V::Real>>(
        &self,
        window: &mut Window<V::Real, D>,
        PairLoad { momentum, stress }: &PairLoad<V::Real>,
    ) {
        let [x, y, z] = [&self.shapes[0], &self.shapes[1], &self.shapes[D - 1]];
        let mut weights = Space::<B, V::Real, _>::all(Numbers::ZERO);
        let mut slopes = Space::<B, V::Real, _>::all([Numbers::ZERO; D]);
        for (n, [i, j, k]) in Self::nodes() {
            if momentum.is_some() {
                weights[n] = self.weight(n, [i, j, k]).numbers();
            }
            if stress.is_some() && B::CORNERS {
                for axis in 0..D {
                    slopes[n][axis] = self.table.slope(n, axis).numbers();
                }
            } else if stress.is_some() {
                let depth = if D == 2 { V::ONE } else { z.weight[k] };
                slopes[n][0] = (x.slope(i) * self.across(j, k)).numbers();
                slopes[n][1] = (x.weight[i] * y.slope(j) * depth).numbers();
                if D == 3 {
                    slopes[n][2] = (x.weight[i] * y.weight[j] * z.slope(k)).numbers();
                }
            }
        }
        for p in 0..self.count.min(MOST_LANES) {
            let (mut rows, mut momenta) = ([M::Wide::ZERO; 3], [M::Wide::ZERO; 4]);
            if let Some(MomentumRows { first, steps }) = momentum {
                momenta[0] = first.one::<M>(p);
                for axis in 0..D {
                    momenta[axis + 1] = steps[axis].one::<M>(p);
                }
            }
            if let Some(stress) = stress {
                for axis in 0..D {
                    rows[axis] = stress[axis].one::<M>(p);
                }
            }
            for (n, [i, j, k]) in Self::nodes() {
                let (mut given, mut force) = (M::Wide::ZERO, M::Wide::NOTHING);
                if momentum.is_some() {
                    let mut row = momenta[0];
                    for (axis, steps) in [i, j, k].into_iter().enumerate().take(D) {
                        row = momenta[axis + 1].times_plus(M::Wide::of(steps as f64), row);
                    }
                    given = row * factors::<M, _>(&weights[n], p / 2);
                }
                if stress.is_some() {
                    for axis in 0..D {
                        force = (-rows[axis]).times_plus(factors::<M, _>(&slopes[n][axis], p / 2), force);
                    }
                }
                add::<M, _>(&mut window.sums[self.start.of(p) + Self::offset(i, j, k)], given, force);
            }
        }
    }

    /// The nodes that a particle reaches, numbered.
    #[inline(always)]
    fn nodes() -> impl Iterator<Item = (usize, [usize; 3])> {
        let count = B::WIDTH * B::WIDTH * Self::DEPTH;
        (0..count).map(|n| (n, [n / (B::WIDTH * Self::DEPTH), n / Self::DEPTH % B::WIDTH, n % Self::DEPTH]))
    }

    #[inline(always)]
    fn pairs(&self) -> usize {
        pairs(self.count)
    }

    /// S_i of the `n`-th node, `i`, `j` and `k` after the base node.
    #[inline(always)]
    fn weight(&self, n: usize, [i, j, k]: [usize; 3]) -> V {
        if B::CORNERS { self.table.weight(n) } else { self.shapes[0].weight[i] * self.across(j, k) }
    }

    /// Product of the weights across the first axis.
    #[inline(always)]
    fn across(&self, j: usize, k: usize) -> V {
        let weight = self.shapes[1].weight[j];
        if D == 2 { weight } else { weight * self.shapes[D - 1].weight[k] }
    }
}

/// Pairs of a group of so many particles; the last one of the last may be none.
#[inline(always)]
pub fn pairs(count: usize) -> usize {
    count.min(MOST_LANES).div_ceil(2)
}

/// What a group scatters, by pairs of particles.
struct PairLoad<T> {
    /// Momentum and mass.
    momentum: Option<MomentumRows<T>>,
    /// Columns of V sigma/h.
    stress: Option<[RowsOfLanes<T>; 3]>,
}

/// Momentum and mass at the base node, and by how much they change to the next node along each axis.
struct MomentumRows<T> {
    first: RowsOfLanes<T>,
    steps: [RowsOfLanes<T>; 3],
}

/// Four numbers of each particle of a group: of two particles the first, then the second and so on.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct RowsOfLanes<T>([[[T; 2]; 4]; MOST_LANES / 2]);

impl<T: Real> RowsOfLanes<T> {
    const ZERO: Self = RowsOfLanes([[[T::ZERO; 2]; 4]; MOST_LANES / 2]);

    #[inline(always)]
    fn new<V: Lanes<Real = T>>(columns: [V; 4]) -> Self {
        let mut rows = Self::ZERO;
        V::store_pairs(columns, &mut rows.0);
        rows
    }

    /// Those of the first `n` particles, and zeros; in the plane the third number is zero.
    #[inline(always)]
    fn of<V: Lanes<Real = T>, const D: usize>([x, y, z, rest]: [V; 4], n: usize) -> Self {
        let z = if D == 2 { V::ZERO } else { z.first(n) };
        Self::new([x.first(n), y.first(n), z, rest.first(n)])
    }

    #[inline(always)]
    fn get<M: Machine<T>>(&self, pair: usize) -> M::Wide {
        // SAFETY: a row is eight numbers.
        unsafe { M::Wide::load(self.0[pair].as_ptr().cast()) }
    }

    /// The row of a particle, with zeros in the place of its partner.
    #[inline(always)]
    fn one<M: Machine<T>>(&self, particle: usize) -> M::Wide {
        let only = if particle.is_multiple_of(2) { [T::ONE, T::ZERO] } else { [T::ZERO, T::ONE] };
        self.get::<M>(particle / 2) * M::Wide::alternate(only)
    }
}

/// What multiplies the rows of two particles.
#[inline(always)]
fn factors<M: Machine<T>, T: Real>(numbers: &Numbers<T>, pair: usize) -> M::Wide {
    let [a, b] = [numbers.0[2 * pair], numbers.0[2 * pair + 1]];
    M::Wide::alternate([a, b])
}

/// Adds momentum and force, each of two particles, to a node.
#[inline(always)]
fn add<M: Machine<T>, T: Real>(node: &mut NodeSums<T>, momentum: M::Wide, force: M::Wide) {
    let node = node.as_mut_ptr().cast();
    // SAFETY: a node has eight numbers, borrowed for writing.
    unsafe { (M::Wide::load(node) + momentum.add_neighbours(force)).store(node) }
}
