//! Transfer for several particles at once: of one cell, which share their nodes, or of several cells of a tile.
//!
//! A gather has a particle in each lane and hands every node's values to all of them. A scatter has the components of
//! momentum or force of two particles in the lanes and adds up one pair after the other,
//! in the order in which they come.

// Sums over nodes and components read better by their indices.
#![allow(clippy::needless_range_loop)]

use crate::basis::{Basis, BoxSide, Entries, Line, Neighbours, Plane, ShapeFunctions, Space};
use crate::grid::{NODE_VALUES, NodeSums, NodeValues, SIDE, WINDOW_NODES, Window, window_side};
use crate::lanes::{Lanes, MOST_LANES, Machine};
use crate::tensor::{Matrix, Number, Real, Symmetric, Vector};
use std::hint::black_box;
use std::marker::PhantomData;
use std::mem::MaybeUninit;

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
    /// Particles at `r` from their base nodes [cells], `count` of them, with boxes of this side; `start` has the base
    /// nodes' places in the window.
    #[inline(always)]
    pub fn new(r: Vector<V, D>, side: &BoxSide<V>, start: S, count: usize) -> Self {
        // No closure: the compiler may leave one of this size uninlined, and then its instructions are calls.
        let mut shapes = [B::shape(r[0], side); D];
        for i in 1..D {
            shapes[i] = B::shape(r[i], side);
        }
        Group { shapes, r, start, count, basis: PhantomData }
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
        for [i, j, k] in Self::nodes() {
            let value: V = self.start.value(nodes, Self::offset(i, j, k), NODE_VALUES - 1);
            sum = self.weight([i, j, k]).times_plus(value, sum);
        }
        sum
    }

    /// G2P: h L = sum v_i (x) h grad S_i, embedded in space, and sum S_i v_i of the same velocities [m/s].
    #[inline(always)]
    pub fn flow(&self, nodes: &[NodeValues<V::Real>; WINDOW_NODES]) -> (Matrix<V>, Vector<V, D>) {
        let mut slopes = [Line::<B, V::Real, V>::all(V::ZERO); D];
        for axis in 0..D {
            for i in 0..B::WIDTH {
                slopes[axis][i] = self.shapes[axis].slope(i);
            }
        }
        self.sums::<true>(nodes, &slopes)
    }

    /// G2P: sum v_i (x) S_i (x_i - x_p) over h, embedded in space, and sum S_i v_i [m/s]; without the diagonal, which
    /// turns nothing, if that is not asked for.
    #[inline(always)]
    pub fn moments<const DIAGONAL: bool>(
        &self,
        nodes: &[NodeValues<V::Real>; WINDOW_NODES],
    ) -> (Matrix<V>, Vector<V, D>) {
        let mut arms = [Line::<B, V::Real, V>::all(V::ZERO); D];
        for axis in 0..D {
            for i in 0..B::WIDTH {
                arms[axis][i] = self.shapes[axis].weight[i] * (V::of(i as f64) - self.r[axis]);
            }
        }
        self.sums::<DIAGONAL>(nodes, &arms)
    }

    /// sum S_i (x_i - x_p) (x) (x_i - x_p) over h^2, embedded in space.
    #[inline(always)]
    pub fn spread(&self) -> Matrix<V> {
        let mut spread = Matrix::<V>::ZERO;
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
    /// and with none; those of a component along its own axis are zero without the diagonal.
    #[inline(always)]
    fn sums<const DIAGONAL: bool>(
        &self,
        nodes: &[NodeValues<V::Real>; WINDOW_NODES],
        others: &[Line<B, V::Real, V>; D],
    ) -> (Matrix<V>, Vector<V, D>) {
        let [x, y, z] = [&self.shapes[0], &self.shapes[1], &self.shapes[D - 1]];
        let [other_x, other_y, other_z] = [&others[0], &others[1], &others[D - 1]];
        let mut sums = Matrix::<V>::ZERO;
        for c in 0..D {
            for axis in 0..D {
                sums.0[c][axis] = if DIAGONAL || c != axis { V::NOTHING } else { V::ZERO };
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
                            if DIAGONAL || c != 2 {
                                other[c] = other_z[k].times_plus(value, other[c]);
                            }
                        }
                    }
                }
                for c in 0..D {
                    plane[0][c] = y.weight[j].times_plus(row[c], plane[0][c]);
                    if DIAGONAL || c != 1 {
                        plane[1][c] = other_y[j].times_plus(row[c], plane[1][c]);
                    }
                    if D == 3 && (DIAGONAL || c != 2) {
                        plane[2][c] = y.weight[j].times_plus(other[c], plane[2][c]);
                    }
                }
            }
            for c in 0..D {
                sum[c] = x.weight[i].times_plus(plane[0][c], sum[c]);
                if DIAGONAL || c != 0 {
                    sums.0[c][0] = other_x[i].times_plus(plane[0][c], sums.0[c][0]);
                }
                if DIAGONAL || c != 1 {
                    sums.0[c][1] = x.weight[i].times_plus(plane[1][c], sums.0[c][1]);
                }
                if D == 3 && (DIAGONAL || c != 2) {
                    sums.0[c][2] = x.weight[i].times_plus(plane[2][c], sums.0[c][2]);
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
        // Written where they stay, without closures (see `Group::new`): copies of them would cost as much as the sums.
        let mut momentum = [RowsOfLanes::EMPTY; 4];
        let mut stress = [RowsOfLanes::EMPTY; 3];
        if let Some(Momentum { own, per_cell: Matrix(m), mass }) = load.momentum {
            // At the base node.
            let mut first = own;
            for c in 0..D {
                for axis in 0..D {
                    first[c] = (-m[c][axis]).times_plus(self.r[axis], first[c]);
                }
            }
            momentum[0].put::<V, D>([first[0], first[1], first[D - 1], mass], n);
            for axis in 0..D {
                momentum[axis + 1].put::<V, D>([m[0][axis], m[1][axis], m[2][axis], V::ZERO], n);
            }
        }
        if let Some(load) = load.stress {
            let [xx, yy, zz, xy, yz, xz] = load.0;
            stress[0].put::<V, D>([xx, xy, xz, V::ZERO], n);
            stress[1].put::<V, D>([xy, yy, yz, V::ZERO], n);
            if D == 3 {
                stress[2].put::<V, D>([xz, yz, zz, V::ZERO], n);
            }
        }
        let pairs = PairLoad {
            momentum: load.momentum.is_some().then_some(&momentum),
            stress: load.stress.is_some().then_some(&stress),
        };
        match self.start.shared() {
            // A number that the compiler knows, so that loops over pairs are unrolled.
            Some(start) if n == V::COUNT => {
                Group { count: V::COUNT, ..*self }.scatter_together::<M>(window, start, &pairs);
            }
            Some(start) => self.scatter_together::<M>(window, start, &pairs),
            None => self.scatter_singly::<M>(window, &pairs),
        }
    }

    /// For particles that share their nodes: sums over particles first, register by register of a node's numbers, so
    /// that the sums over a plane of nodes stay in registers.
    #[inline(always)]
    fn scatter_together<M: Machine<V::Real>>(
        &self,
        window: &mut Window<V::Real, D>,
        start: usize,
        PairLoad { momentum, stress }: &PairLoad<'_, V::Real>,
    ) {
        let mut below = [Plane::<B, V::Real, _>::all(Register::<M, V::Real>::ZERO); MOST_REGISTERS];
        for i in 0..B::WIDTH {
            let mut weights = Plane::<B, V::Real, _>::all(Factors::EMPTY);
            let mut slopes = PlaneSlopes::<V, B>::empty();
            if momentum.is_some() {
                self.put_weights(i, &mut weights);
            }
            if stress.is_some() {
                self.put_slopes(i, &mut slopes);
            }
            // Where two registers hold a row, the factors of all particles would spill: they are loaded where needed.
            let (weights, slopes) = match <M::Wide as Lanes>::REGISTERS {
                1 => (&weights, &slopes),
                _ => (black_box(&weights), black_box(&slopes)),
            };
            for part in 0..<M::Wide as Lanes>::REGISTERS {
                let [mut momenta, mut forces] =
                    [Plane::<B, V::Real, _>::all(Register::<M, V::Real>::ZERO); 2];
                if let Some(momentum) = momentum {
                    momenta = self.momenta::<M>((i, part), momentum, weights);
                }
                if let Some(stress) = stress {
                    (forces, below[part]) = self.forces::<M>((i, part), stress, (slopes, &below[part]));
                }
                for j in 0..B::WIDTH {
                    for k in 0..Self::DEPTH {
                        let n = j * Self::DEPTH + k;
                        let node = &mut window.sums[start + Self::offset(i, j, k)];
                        add::<M, _>((node, part), momenta[n], forces[n]);
                    }
                }
            }
        }
    }

    /// S_i at the nodes of a plane across the first axis.
    #[inline(always)]
    fn put_weights(&self, i: usize, weights: &mut Plane<B, V::Real, Factors<V::Real>>) {
        for j in 0..B::WIDTH {
            for k in 0..Self::DEPTH {
                weights[j * Self::DEPTH + k].put(self.shapes[0].weight[i] * self.across(j, k));
            }
        }
    }

    /// Differences of S_i from a plane to the next, and within it.
    #[inline(always)]
    fn put_slopes(&self, i: usize, slopes: &mut PlaneSlopes<V, B>) {
        let [x, y, z] = [&self.shapes[0], &self.shapes[1], &self.shapes[D - 1]];
        for j in 0..B::WIDTH {
            for k in 0..Self::DEPTH {
                if i + 1 < B::WIDTH {
                    slopes.along_x[j * Self::DEPTH + k].put(self.across(j, k) * x.difference[i]);
                }
                if j + 1 < B::WIDTH {
                    let weight = if D == 2 { x.weight[i] } else { x.weight[i] * z.weight[k] };
                    slopes.along_y[j * Self::DEPTH + k].put(weight * y.difference[j]);
                }
                if k + 1 < Self::DEPTH {
                    slopes.along_z[j * (Self::DEPTH - 1) + k]
                        .put(x.weight[i] * y.weight[j] * z.difference[k]);
                }
            }
        }
    }

    /// Momentum and mass that the nodes of a plane across the first axis get.
    #[inline(always)]
    fn momenta<M: Machine<V::Real>>(
        &self,
        (i, part): (usize, usize),
        load: &[RowsOfLanes<V::Real>; 4],
        weights: &Plane<B, V::Real, Factors<V::Real>>,
    ) -> PlaneSums<B, M, V::Real> {
        let mut sums = Plane::<B, V::Real, _>::all(Register::<M, V::Real>::NOTHING);
        for pair in 0..self.pairs() {
            let (along_x, along_y) = (load[1].get::<M>(pair, part), load[2].get::<M>(pair, part));
            let along_z = load[D].get::<M>(pair, part);
            // From node to node.
            let mut line =
                along_x.times_plus(Register::<M, V::Real>::of(i as f64), load[0].get::<M>(pair, part));
            for j in 0..B::WIDTH {
                let mut row = line;
                for k in 0..Self::DEPTH {
                    let n = j * Self::DEPTH + k;
                    sums[n] = row.times_plus(weights[n].get::<M>(pair), sums[n]);
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
        (i, part): (usize, usize),
        load: &[RowsOfLanes<V::Real>; 3],
        (slopes, below): (&PlaneSlopes<V, B>, &PlaneSums<B, M, V::Real>),
    ) -> TwoPlanes<B, V::Real, Register<M, V::Real>> {
        let mut above = Plane::<B, V::Real, _>::all(Register::<M, V::Real>::NOTHING);
        if i + 1 < B::WIDTH {
            for pair in 0..self.pairs() {
                let row = load[0].get::<M>(pair, part);
                for n in 0..B::WIDTH * Self::DEPTH {
                    above[n] = row.times_plus(slopes.along_x[n].get::<M>(pair), above[n]);
                }
            }
        }
        let [mut right, mut back] = [Neighbours::<B, V::Real, _>::all(Register::<M, V::Real>::NOTHING); 2];
        for pair in 0..self.pairs() {
            let (row_y, row_z) = (load[1].get::<M>(pair, part), load[D - 1].get::<M>(pair, part));
            for n in 0..(B::WIDTH - 1) * Self::DEPTH {
                right[n] = row_y.times_plus(slopes.along_y[n].get::<M>(pair), right[n]);
            }
            for n in 0..B::WIDTH * (Self::DEPTH - 1) {
                back[n] = row_z.times_plus(slopes.along_z[n].get::<M>(pair), back[n]);
            }
        }
        let mut forces = Plane::<B, V::Real, _>::all(Register::<M, V::Real>::ZERO);
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

    /// For particles that share no nodes.
    #[inline(always)]
    fn scatter_singly<M: Machine<V::Real>>(
        &self,
        window: &mut Window<V::Real, D>,
        PairLoad { momentum, stress }: &PairLoad<'_, V::Real>,
    ) {
        let [x, y, z] = [&self.shapes[0], &self.shapes[1], &self.shapes[D - 1]];
        let mut weights = Space::<B, V::Real, _>::all(Factors::EMPTY);
        let mut slopes = Space::<B, V::Real, _>::all([Factors::EMPTY; D]);
        for (n, [i, j, k]) in Self::nodes().enumerate() {
            if momentum.is_some() {
                weights[n].put(self.weight([i, j, k]));
            }
            if stress.is_some() {
                let depth = if D == 2 { V::ONE } else { z.weight[k] };
                slopes[n][0].put(x.slope(i) * self.across(j, k));
                slopes[n][1].put(x.weight[i] * y.slope(j) * depth);
                if D == 3 {
                    slopes[n][2].put(x.weight[i] * y.weight[j] * z.slope(k));
                }
            }
        }
        let parts = <M::Wide as Lanes>::REGISTERS;
        for turn in 0..parts * self.count.min(MOST_LANES) {
            let (p, part) = (turn / parts, turn % parts);
            let (mut rows, mut momenta) =
                ([Register::<M, V::Real>::ZERO; 3], [Register::<M, V::Real>::ZERO; 4]);
            if let Some([first, steps @ ..]) = momentum {
                momenta[0] = first.one::<M>(p, part);
                for axis in 0..D {
                    momenta[axis + 1] = steps[axis].one::<M>(p, part);
                }
            }
            if let Some(stress) = stress {
                for axis in 0..D {
                    rows[axis] = stress[axis].one::<M>(p, part);
                }
            }
            for (n, [i, j, k]) in Self::nodes().enumerate() {
                let (mut given, mut force) = (Register::<M, V::Real>::ZERO, Register::<M, V::Real>::NOTHING);
                if momentum.is_some() {
                    let mut row = momenta[0];
                    for (axis, steps) in [i, j, k].into_iter().enumerate().take(D) {
                        row = momenta[axis + 1].times_plus(Register::<M, V::Real>::of(steps as f64), row);
                    }
                    given = row * weights[n].get::<M>(p / 2);
                }
                if stress.is_some() {
                    for axis in 0..D {
                        force = (-rows[axis]).times_plus(slopes[n][axis].get::<M>(p / 2), force);
                    }
                }
                let node = &mut window.sums[self.start.of(p) + Self::offset(i, j, k)];
                add::<M, _>((node, part), given, force);
            }
        }
    }

    /// The nodes that a particle reaches.
    #[inline(always)]
    fn nodes() -> impl Iterator<Item = [usize; 3]> {
        let count = B::WIDTH * B::WIDTH * Self::DEPTH;
        (0..count).map(|n| [n / (B::WIDTH * Self::DEPTH), n / Self::DEPTH % B::WIDTH, n % Self::DEPTH])
    }

    #[inline(always)]
    fn pairs(&self) -> usize {
        pairs(self.count)
    }

    /// S_i of the node `i`, `j` and `k` after the base node.
    #[inline(always)]
    fn weight(&self, [i, j, k]: [usize; 3]) -> V {
        self.shapes[0].weight[i] * self.across(j, k)
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

/// Differences of the weights of a group's particles from a plane of nodes to the next, and between neighbours in it.
struct PlaneSlopes<V: Lanes, B: Basis<V::Real>> {
    along_x: Plane<B, V::Real, Factors<V::Real>>,
    along_y: Neighbours<B, V::Real, Factors<V::Real>>,
    along_z: Neighbours<B, V::Real, Factors<V::Real>>,
}

impl<V: Lanes, B: Basis<V::Real>> PlaneSlopes<V, B> {
    /// To be put.
    #[inline(always)]
    fn empty() -> Self {
        let between = Neighbours::<B, V::Real, _>::all(Factors::EMPTY);
        PlaneSlopes {
            along_x: Plane::<B, V::Real, _>::all(Factors::EMPTY),
            along_y: between,
            along_z: between,
        }
    }
}

/// What a group scatters, by pairs of particles.
struct PairLoad<'a, T> {
    /// Momentum and mass at the base node, and by how much they change to the next node along each axis.
    momentum: Option<&'a [RowsOfLanes<T>; 4]>,
    /// Columns of V sigma/h.
    stress: Option<&'a [RowsOfLanes<T>; 3]>,
}

/// Four numbers of each particle of a group: of two particles the first, then the second and so on.
#[repr(align(64))]
struct RowsOfLanes<T>(MaybeUninit<[[[T; 2]; 4]; MOST_LANES / 2]>);

impl<T: Real> RowsOfLanes<T> {
    /// To be [put](RowsOfLanes::put).
    const EMPTY: Self = RowsOfLanes(MaybeUninit::uninit());

    /// Those of the first `n` particles, and zeros for the partner of a last one without; in the plane the third number
    /// is zero.
    #[inline(always)]
    fn put<V: Lanes<Real = T>, const D: usize>(&mut self, [x, y, z, rest]: [V; 4], n: usize) {
        let mut columns = [x, y, if D == 2 { V::ZERO } else { z }, rest];
        if !n.is_multiple_of(2) {
            for column in &mut columns {
                *column = column.first(n);
            }
        }
        // SAFETY: there is room for the lanes of any register.
        unsafe { V::store_pairs(columns, self.0.as_mut_ptr().cast()) };
    }

    /// What a register holds of the rows of a pair, its `part`-th.
    #[inline(always)]
    fn get<M: Machine<T>>(&self, pair: usize, part: usize) -> Register<M, T> {
        debug_assert!(pair < MOST_LANES / 2, "a pair of the group");
        // SAFETY: a row is eight numbers, and those of all pairs of a group were put.
        unsafe {
            Register::<M, T>::load(self.0.as_ptr().cast::<T>().add(8 * pair + part * Register::<M, T>::COUNT))
        }
    }

    /// The same of one particle, with zeros in the place of its partner.
    #[inline(always)]
    fn one<M: Machine<T>>(&self, particle: usize, part: usize) -> Register<M, T> {
        let only = if particle.is_multiple_of(2) { [T::ONE, T::ZERO] } else { [T::ZERO, T::ONE] };
        self.get::<M>(particle / 2, part) * Register::<M, T>::alternate(only)
    }
}

/// What multiplies the rows of a group's particles.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Factors<T: Copy>(MaybeUninit<[T; MOST_LANES]>);

impl<T: Real> Factors<T> {
    /// To be [put](Factors::put).
    const EMPTY: Self = Factors(MaybeUninit::uninit());

    #[inline(always)]
    fn put<V: Lanes<Real = T>>(&mut self, lanes: V) {
        if V::COUNT == 1 {
            // Its partner has zero.
            self.0.write(lanes.numbers().0);
        } else {
            // SAFETY: there is room for the lanes of any register.
            unsafe { lanes.store(self.0.as_mut_ptr().cast()) };
        }
    }

    /// Those of two particles.
    #[inline(always)]
    fn get<M: Machine<T>>(&self, pair: usize) -> Register<M, T> {
        debug_assert!(pair < MOST_LANES / 2, "a pair of the group");
        // SAFETY: those of all pairs of a group were put.
        let [a, b] = unsafe { self.0.as_ptr().cast::<[T; 2]>().add(pair).read() };
        Register::<M, T>::alternate([a, b])
    }
}

/// Registers that hold the numbers of two particles at most.
const MOST_REGISTERS: usize = 2;

/// What one of them holds.
type Register<M, T> = <<M as Machine<T>>::Wide as Lanes>::Register;

/// What such a register holds at each node of a plane.
type PlaneSums<B, M, T> = Plane<B, T, Register<M, T>>;

/// Adds momentum and force, each of two particles, to a node: what a register holds of it, its `part`-th.
#[inline(always)]
fn add<M: Machine<T>, T: Real>(
    (node, part): (&mut NodeSums<T>, usize),
    momentum: Register<M, T>,
    force: Register<M, T>,
) {
    // SAFETY: a node has eight numbers, borrowed for writing.
    unsafe {
        let node = node.as_mut_ptr().cast::<T>().add(part * Register::<M, T>::COUNT);
        (Register::<M, T>::load(node) + momentum.add_neighbours(force)).store(node);
    }
}
