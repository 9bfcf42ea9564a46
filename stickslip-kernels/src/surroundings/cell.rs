//! Particles of a cell, side by side, added to the nodes that they reach.

use super::sums::{FIRST, FORCE, MASS, MaterialSums, Wanted, placed_rows, stress_rows};
use super::{Around, Chunk};
use crate::basis::{Basis, BoxSide, ShapeFunctions};
use crate::grid::{Nodes, SIDE, next_of, node_at};
use crate::lanes::{Laned, Lanes, MOST_LANES, Machine, Numbers, in_lanes, prefetch};
use crate::particles::{ColumnStart, Columns, deformation_entries, follow_one_another, stress_entries};
use crate::tensor::{Matrix, Number, Real, Symmetric, Vector, array};
use crate::transfer::pairs;
use std::marker::PhantomData;
use std::ops::Range;

impl<T: Laned, const D: usize, B: Basis<T>> Around<'_, T, D, B> {
    /// Adds the particles that are listed to the nodes that they reach.
    #[inline(always)]
    pub(super) fn add<M: Machine<T>, V: Lanes<Real = T>>(mut self) {
        let seen = Seen::<V, D>::new(&self);
        let columns = self.body.columns;
        let orders = [false, true].map(|guests| self.near.active.order(self.body.number, guests));
        let index = |chunk: &Chunk<D>| {
            &orders[usize::from(chunk.guests)][chunk.first as usize..][..chunk.count as usize]
        };
        let mut copies = CellCopies([Numbers::ZERO; ColumnStart::<3>::COUNT]);
        for place in 0..self.chunks.len() {
            if let Some(later) = self.chunks.get(place + AHEAD) {
                let index = index(later);
                fetch(&columns, [index[0], index[index.len() - 1]], self.sought);
            }
            let chunk = self.chunks[place];
            let members = CellMembers::new::<V>(&columns, index(&chunk), self.sought, &mut copies);
            self.chunk::<M, V>(&seen, &members, &chunk);
        }
    }

    #[inline(always)]
    fn chunk<M: Machine<T>, V: Lanes<Real = T>>(
        &mut self,
        seen: &Seen<V, D>,
        members: &CellMembers<'_, T, D>,
        &Chunk { cell, base, nodes, .. }: &Chunk<D>,
    ) {
        // No closure: the compiler may leave one of some size uninlined, and then its instructions are calls.
        let mut position = Vector::<V, D>::ZERO;
        // As the nodes see it everywhere: cells are listed by that box, and no other has its functions within them.
        let side = members.side(self.near.lattice.half_side, seen.per_cell);
        let mut shapes = [B::shape(V::ZERO, &side); D];
        for i in 0..D {
            position[i] = members.load(ColumnStart::<D>::POSITION + i);
            let r = (position[i] - seen.origin[i]) * seen.per_cell - V::splat(T::of(f64::from(cell[i])));
            shapes[i] = B::shape(r, &side);
            // The node sees a particle move away as the particle sees the node move: grad at the node = -grad S(x_p).
            let to_gradient = seen.per_cell * -seen.sign[i];
            for k in 0..B::WIDTH {
                shapes[i].difference[k] *= to_gradient;
            }
        }
        let volume: V = members.load(ColumnStart::<D>::VOLUME);
        let mut f = Matrix::ZERO;
        for (k, &[row, column]) in deformation_entries(D).iter().enumerate() {
            f.0[row][column] = members.load(ColumnStart::<D>::DEFORMATION + k);
        }
        let jacobian = f.det();
        // The room on the grid, in the plane an area.
        let room = if D == 2 { volume / f.0[2][2] } else { volume };
        let per_jacobian = V::ONE / jacobian;
        let mut inverse = [[V::ZERO; D]; D];
        for i in 0..D {
            for j in 0..D {
                let (a, b, c, d) = ((j + 1) % 3, (j + 2) % 3, (i + 1) % 3, (i + 2) % 3);
                let minor = f.0[a][c].times_plus(f.0[b][d], -(f.0[a][d] * f.0[b][c]));
                inverse[i][j] = minor * per_jacobian * (seen.sign[i] * seen.sign[j]);
            }
        }
        let (mut arm, mut place) = (Vector::<V, D>::ZERO, Vector::<V, D>::ZERO);
        for i in 0..D {
            arm[i] = seen.offset[i] + seen.sign[i] * position[i] - seen.first[i];
            let start: V = members.load(ColumnStart::<D>::START + i);
            place[i] = seen.start[i] + seen.sign[i] * start;
        }

        if self.body.trusts_deformation {
            for i in 0..D {
                for j in 0..D {
                    place[i] = (-inverse[i][j]).times_plus(arm[j], place[i]);
                }
            }
        }

        let mut placed = [V::ZERO; 4 * MOST_PLACED];
        for i in 0..D {
            placed[i] = place[i];
            placed[D + i] = arm[i];
            for j in 0..D {
                placed[2 * D + i * D + j] = inverse[i][j];
            }
        }
        let mut rows = [Rows::<T>::EMPTY; MOST_PLACED];
        for row in 0..placed_rows(D) {
            let k = 4 * row;
            rows[row].fill([placed[k], placed[k + 1], placed[k + 2], placed[k + 3]]);
        }
        let rooms = room.first(members.count);
        let mut left = nodes;
        while let Some(node) = next_of(&mut left) {
            let shares = self.shares(&shapes, base, node, rooms);
            let mut added = [M::Wide::NOTHING; FIRST + MOST_PLACED];
            for pair in 0..pairs(members.count) {
                let share = shares.pair::<M>(pair);
                added[0] += share;
                let weight = share.every_fourth(3);
                for row in 0..placed_rows(D) {
                    added[FIRST + row] = rows[row].pair::<M>(pair).times_plus(weight, added[FIRST + row]);
                }
            }
            let sums = self.sums_at(node);
            for row in 0..FIRST + placed_rows(D) {
                add::<M, T>(&mut sums.0[row], added[row]);
            }
        }
        if self.sought == Wanted::Everything {
            self.stress_and_mass::<M, V>(seen, members, (&shapes, base, nodes), [room, volume]);
        }
    }

    /// Adds what else there is than places, by the room on the grid and the volume that the stress fills.
    #[inline(always)]
    fn stress_and_mass<M: Machine<T>, V: Lanes<Real = T>>(
        &mut self,
        seen: &Seen<V, D>,
        members: &CellMembers<'_, T, D>,
        (shapes, base, mut nodes): (&Shapes<V, D, B>, [i32; D], Nodes),
        [room, filled]: [V; 2],
    ) {
        let mut stress = Symmetric::<V>::ZERO;
        for k in 0..stress_entries(D) {
            stress.0[k] = members.load::<V>(ColumnStart::<D>::STRESS + k) * seen.turn[k];
        }
        let mut rows = [Rows::<T>::EMPTY; MOST_STRESS];
        for row in 0..stress_rows(D) {
            let mut columns = [V::ZERO; 4];
            for i in 0..4 {
                if 4 * row + i < stress_entries(D) {
                    columns[i] = stress.0[4 * row + i] * room;
                }
            }
            rows[row].fill(columns);
        }
        let mut force = [Rows::<T>::EMPTY; D];
        for j in 0..D {
            let mut column = [V::ZERO; 4];
            for i in 0..D {
                column[i] = stress.at(i, j) * filled;
            }
            force[j].fill(column);
        }
        let mass: V = members.load(ColumnStart::<D>::MASS);
        let mut masses = Rows::<T>::EMPTY;
        masses.fill([mass; 4]);
        let here = V::ONE.first(members.count);
        while let Some(node) = next_of(&mut nodes) {
            let shares = self.shares(shapes, base, node, here);
            let mut added = [M::Wide::NOTHING; MOST_STRESS];
            let [mut weighed, mut pushed] = [M::Wide::NOTHING; 2];
            for pair in 0..pairs(members.count) {
                let share = shares.pair::<M>(pair);
                let weight = share.every_fourth(3);
                for row in 0..stress_rows(D) {
                    added[row] = rows[row].pair::<M>(pair).times_plus(weight, added[row]);
                }
                weighed = masses.pair::<M>(pair).times_plus(share, weighed);
                for j in 0..D {
                    pushed = force[j].pair::<M>(pair).times_plus(share.every_fourth(j), pushed);
                }
            }
            let sums = self.sums_at(node);
            for row in 0..stress_rows(D) {
                add::<M, T>(&mut sums.0[FIRST + placed_rows(D) + row], added[row]);
            }
            add::<M, T>(&mut sums.0[MASS], weighed);
            add::<M, T>(&mut sums.0[FORCE], pushed);
        }
    }

    /// grad S and S of each particle at a node of the block, times a number of each.
    #[inline(always)]
    fn shares<V: Lanes<Real = T>>(
        &self,
        shapes: &Shapes<V, D, B>,
        base: [i32; D],
        node: usize,
        factor: V,
    ) -> Rows<T> {
        let steps = node_at([0; D], node);
        let offset: [usize; D] = array(0, |i| (self.along(i, steps[i]) - base[i]) as usize);
        let [x, dx] = [shapes[0].weight[offset[0]] * factor, shapes[0].slope(offset[0]) * factor];
        let [y, dy] = [shapes[1].weight[offset[1]], shapes[1].slope(offset[1])];
        let mut shares = Rows::<T>::EMPTY;
        if const { D == 2 } {
            shares.fill([dx * y, x * dy, V::ZERO, x * y]);
        } else {
            let [z, dz] = [shapes[D - 1].weight[offset[D - 1]], shapes[D - 1].slope(offset[D - 1])];
            let yz = y * z;
            shares.fill([dx * yz, x * (dy * z), x * (y * dz), x * yz]);
        }
        shares
    }

    /// The sums at a node of the block.
    #[inline(always)]
    fn sums_at(&mut self, node: usize) -> &mut MaterialSums<T, D> {
        &mut self.sums[(self.wanted & ((1 << node) - 1)).count_ones() as usize]
    }
}

/// What nodes see of a group of particles along each axis.
type Shapes<V, const D: usize, B> = [ShapeFunctions<V, <B as Basis<<V as Lanes>::Real>>::Width>; D];

/// Rows of place, centre and inverse of F, in space.
const MOST_PLACED: usize = placed_rows(3);
/// Rows of the stress, in space.
const MOST_STRESS: usize = stress_rows(3);

#[inline(always)]
fn add<M: Machine<T>, T: Real>(row: &mut [T; 4], added: M::Wide) {
    let row = row.as_mut_ptr();
    // SAFETY: a row has four numbers, borrowed for writing.
    unsafe { (M::Quad::load(row) + M::halves(added)).store(row) }
}

/// How a block's particles are seen, in every lane.
pub(super) struct Seen<V, const D: usize> {
    origin: Vector<V, D>,
    per_cell: V,
    /// The first node of the block [m].
    first: Vector<V, D>,
    /// A point `x` is seen at `offset + sign x`.
    offset: Vector<V, D>,
    /// The same of a point of the undeformed body. One that is joined to its own images is one for all of them; any
    /// other has only one place.
    start: Vector<V, D>,
    sign: Vector<V, D>,
    /// Signs of the entries of a stress.
    turn: [V; 6],
}

impl<V: Lanes, const D: usize> Seen<V, D> {
    #[inline(always)]
    pub(super) fn new<B>(around: &Around<'_, V::Real, D, B>) -> Self {
        let lattice = &around.near.lattice;
        let splat = |x: Vector<V::Real, D>| Vector::<V, D>::from_fn(|i| V::splat(x[i]));
        let sign = |i: usize| if i < D && around.mirrors[i].is_some() { -V::ONE } else { V::ONE };
        let offset = Vector::<V, D>::from_fn(|i| match around.mirrors[i] {
            Some(wall) => {
                let position = lattice.origin[i] + V::Real::of(f64::from(wall.node)) * lattice.cell;
                V::splat(position + position)
            }
            None => V::ZERO,
        });
        let joined = |i: usize| around.image[i] != 0 && around.body.is_joined[i];
        let start = Vector::from_fn(|i| match joined(i) {
            true => V::splat(V::Real::of(f64::from(-around.image[i] * SIDE)) * lattice.cell),
            false => offset[i],
        });
        Seen {
            start,
            origin: splat(lattice.origin),
            per_cell: V::splat(lattice.per_cell),
            first: splat(lattice.position(node_at(around.block, 0))),
            offset,
            sign: Vector::from_fn(sign),
            turn: [V::ONE, V::ONE, V::ONE, sign(0) * sign(1), sign(1) * sign(2), sign(0) * sign(2)],
        }
    }
}

/// How many chunks ahead of the present one numbers are fetched into the cache.
const AHEAD: usize = 3;

/// The columns that sums are made of.
#[inline(always)]
fn columns_read<const D: usize>(sought: Wanted) -> [Range<usize>; 3] {
    let (stress, start) = (ColumnStart::<D>::STRESS, ColumnStart::<D>::START);
    let [first, last] = match sought {
        Wanted::Places => [ColumnStart::<D>::VOLUME, stress],
        Wanted::Everything => [ColumnStart::<D>::MASS, start],
    };
    [ColumnStart::<D>::POSITION..ColumnStart::<D>::VELOCITY, first..last, start..ColumnStart::<D>::COUNT]
}

/// Fetches what is read of two particles and those beside them.
#[inline(always)]
fn fetch<T: Real, const D: usize>(columns: &Columns<T, D>, particles: [u32; 2], sought: Wanted) {
    for range in columns_read::<D>(sought) {
        for column in range {
            for particle in particles {
                // SAFETY: the particle exists.
                prefetch(unsafe { columns.at(column, particle as usize) });
            }
        }
    }
}

/// Particles of a cell, one in each lane, the first in the lanes beyond: as columns,
/// the body's own where they lie side by side, else copies.
struct CellMembers<'a, T, const D: usize> {
    first: *const T,
    stride: usize,
    count: usize,
    source: PhantomData<&'a T>,
}

/// Columns of particles that do not lie side by side.
struct CellCopies<T>([Numbers<T>; ColumnStart::<3>::COUNT]);

impl<'a, T: Real, const D: usize> CellMembers<'a, T, D> {
    #[inline(always)]
    fn new<V: Lanes<Real = T>>(
        columns: &'a Columns<T, D>,
        index: &[u32],
        sought: Wanted,
        copies: &'a mut CellCopies<T>,
    ) -> Self {
        let in_a_row = follow_one_another(index);
        let (first, stride) = if in_a_row {
            // SAFETY: the particle exists.
            (unsafe { columns.at(0, index[0] as usize) }.cast_const(), columns.stride())
        } else {
            let lanes = in_lanes(index);
            for range in columns_read::<D>(sought) {
                for column in range {
                    // SAFETY: the particles exist, and nobody writes to them in a survey.
                    unsafe {
                        V::gather(columns.at(column, 0), &lanes).store(copies.0[column].0.as_mut_ptr())
                    };
                }
            }
            (copies.0.as_ptr().cast(), size_of::<Numbers<T>>() / size_of::<T>())
        };
        CellMembers { first, stride, count: index.len(), source: PhantomData }
    }

    /// A side of their boxes as the nodes see them.
    #[inline(always)]
    fn side<V: Lanes<Real = T>>(&self, half_side: Option<T>, per_cell: V) -> BoxSide<V> {
        BoxSide::new(match half_side {
            Some(half) => V::splat(half),
            None => self.load::<V>(ColumnStart::<D>::HALF_WIDTH) * per_cell,
        })
    }

    /// Their numbers in a column.
    #[inline(always)]
    fn load<V: Lanes<Real = T>>(&self, column: usize) -> V {
        // SAFETY: as many numbers as there are particles; nobody writes to them in a survey.
        unsafe {
            let first = self.first.add(column * self.stride);
            V::load_part(first, self.count, *first)
        }
    }
}

/// Four numbers of each particle of a group.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Rows<T>([[T; 4]; MOST_LANES]);

impl<T: Real> Rows<T> {
    const EMPTY: Self = Rows([[T::ZERO; 4]; MOST_LANES]);

    #[inline(always)]
    fn fill<V: Lanes<Real = T>>(&mut self, columns: [V; 4]) {
        V::store_rows(columns, &mut self.0);
    }

    /// The numbers of two particles.
    #[inline(always)]
    fn pair<M: Machine<T>>(&self, pair: usize) -> M::Wide {
        // SAFETY: two rows are eight numbers.
        unsafe { M::Wide::load(self.0[2 * pair..2 * pair + 2].as_ptr().cast()) }
    }
}
