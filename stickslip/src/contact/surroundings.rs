//! What a body's particles say at the nodes of a block where it meets others.
//!
//! Every particle near such nodes is visited once and added to all that it reaches, those of a cell side by side. Behind a mirror its image
//! is added.

// Sums over nodes and components read better by their indices.
#![allow(clippy::needless_range_loop)]

use super::{Near, Place};
use crate::basis::{Basis, MAX_WIDTH};
use crate::boundary::Wall;
use crate::grid::{Nodes, SIDE, next_of, node_at, nodes_per_block};
use crate::lanes::{Laned, Lanes, MOST_LANES, Machine, Work, in_lanes};
use crate::particles::{Column, Columns, deformation_entries, stress_entries};
use crate::scene::Face;
use crate::tensor::{Matrix, Number, Real, Symmetric, Vector, array};
use std::marker::PhantomData;

/// Nodes of a block whose coordinate along an axis is `n`; bits beyond the block mean nothing.
fn layer<const D: usize>(axis: usize, n: i32) -> Nodes {
    let every: Nodes = match D - 1 - axis {
        0 => 0x1111_1111_1111_1111,
        1 => 0x000f_000f_000f_000f,
        _ => 0xffff,
    };
    every << (n as u32 * (SIDE as u32).pow((D - 1 - axis) as u32))
}

/// All nodes of a block.
pub const fn every_node(dimension: usize) -> Nodes {
    Nodes::MAX >> (Nodes::BITS as usize - nodes_per_block(dimension))
}

/// The nodes of a block that lie so deep behind a wall: `depth` or further out.
pub fn behind<const D: usize>(wall: &Wall, block: [i32; D], depth: i32) -> Nodes {
    let depth_of = |n: i32| (block[wall.axis] * SIDE + n - wall.node) * wall.inward;
    let layers = (0..SIDE).filter(|&n| depth_of(n) <= depth).map(|n| layer::<D>(wall.axis, n));
    layers.fold(0, |nodes, layer| nodes | layer) & every_node(D)
}

/// Sums over the particles around a node.
///
/// ```text
/// row 0     sum V grad S [m^2], sum V S [m^3]       with the gradient at the node
/// row 1     sum m grad S [kg/m], sum m S [kg]       likewise
/// row 2     force of the stress on the node [N]
/// beyond    sum V S of place, centre, inverse of F, and stress, one number after the other
/// ```
/// Places are seen from the first node of the block.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub struct Sums<T, const D: usize>([[T; 4]; ROWS]);

const ROWS: usize = 9;
/// Rows before those that are weighted by volume.
const FIRST: usize = 3;

/// Numbers of a particle that are weighted by volume.
const fn weighted(dimension: usize) -> usize {
    2 * dimension + dimension * dimension + stress_entries(dimension)
}

const fn weighted_rows(dimension: usize) -> usize {
    weighted(dimension).div_ceil(4)
}

impl<T: Real, const D: usize> Sums<T, D> {
    /// Of no particle.
    pub const EMPTY: Self = Sums([[T::ZERO; 4]; ROWS]);

    /// sum V S [m^3]
    pub fn volume(&self) -> T {
        self.0[0][3]
    }

    /// sum m S [kg]
    pub fn mass(&self) -> T {
        self.0[1][3]
    }

    /// sum V grad S [m^2]
    pub fn volume_gradient(&self) -> Vector<T, D> {
        Vector::from_fn(|i| self.0[0][i])
    }

    /// sum m grad S [kg/m]
    pub fn mass_gradient(&self) -> Vector<T, D> {
        Vector::from_fn(|i| self.0[1][i])
    }

    /// Force of the stress on the node [N].
    pub fn force(&self) -> Vector<T, D> {
        Vector::from_fn(|i| self.0[2][i])
    }

    fn number(&self, k: usize) -> T {
        self.0[FIRST + k / 4][k % 4]
    }

    /// The stress weighted by volume [Pa].
    pub fn stress(&self) -> Symmetric<T> {
        let mut stress = Symmetric::ZERO;
        for (k, entry) in stress.0.iter_mut().enumerate().take(stress_entries(D)) {
            *entry = self.number(2 * D + D * D + k) / self.volume();
        }
        stress
    }

    /// The place weighted by volume.
    pub fn place(&self) -> Place<T, D> {
        let share = T::ONE / self.volume();
        let vector = |first: usize| Vector::from_fn(|i| self.number(first + i) * share);
        let inverse = Matrix::from_fn(|i, j| match i < D && j < D {
            true => self.number(2 * D + i * D + j) * share,
            false => T::ZERO,
        });
        Place { place: vector(0), inverse, center: vector(D) }
    }
}

/// For each axis, the mirror that particles are seen in, if any.
pub type Mirrors<'a, const D: usize> = [Option<&'a Wall>; D];

impl<T: Laned, const D: usize> Near<'_, T, D> {
    /// Adds a body's particles to the wanted nodes of a block: the sums of the n-th of them are `sums[n]`.
    pub fn sum_around<B: Basis<T>>(
        &self,
        (body, block): (usize, [i32; D]),
        wanted: Nodes,
        sums: &mut [Sums<T, D>],
    ) {
        let mut walls = self.boundary.walls.iter().filter(|wall| self.reflects::<B>(wall, block));
        let near: [Option<&Wall>; 6] = std::array::from_fn(|_| walls.next());
        // No mirror, and every mirror and combination of mirrors whose images reach nodes of the block.
        for combination in 0..1_u32 << near.iter().flatten().count() {
            let mut mirrors: Mirrors<D> = [None; D];
            let chosen = near.iter().flatten().enumerate().filter(|(i, _)| combination >> i & 1 == 1);
            if chosen.into_iter().all(|(_, &wall)| mirrors[wall.axis].replace(wall).is_none()) {
                let around = Around {
                    near: self,
                    body,
                    block,
                    wanted,
                    mirrors,
                    sums: &mut *sums,
                    basis: PhantomData::<B>,
                };
                T::run(self.processor, around);
            }
        }
    }

    /// Whether images of particles before a wall reach nodes of a block.
    fn reflects<B: Basis<T>>(&self, wall: &Wall, block: [i32; D]) -> bool {
        let near = if wall.inward > 0 { 0 } else { SIDE - 1 };
        let depth = (block[wall.axis] * SIDE + near - wall.node) * wall.inward;
        wall.face == Face::Symmetry && depth < B::WIDTH as i32
    }
}

/// The particles of a body around a block, as they are or as they are seen in mirrors.
struct Around<'a, T, const D: usize, B> {
    near: &'a Near<'a, T, D>,
    body: usize,
    block: [i32; D],
    wanted: Nodes,
    mirrors: Mirrors<'a, D>,
    sums: &'a mut [Sums<T, D>],
    basis: PhantomData<B>,
}

impl<T: Laned, const D: usize, B: Basis<T>> Work for Around<'_, T, D, B> {
    type Real = T;
    type Output = ();

    #[inline(always)]
    fn run<M: Machine<T>>(self) {
        if D == 2 { self.sum::<M, M::Quad>() } else { self.sum::<M, M::Wide>() }
    }
}

/// Cells along an axis whose particles reach nodes of a block, at most.
const SPAN: usize = SIDE as usize + MAX_WIDTH - 1;

impl<T: Laned, const D: usize, B: Basis<T>> Around<'_, T, D, B> {
    #[inline(always)]
    fn sum<M: Machine<T>, V: Lanes<Real = T>>(mut self) {
        let reach = B::WIDTH as i32 - 1;
        // The lowest cell, where it is and not as it is seen, and the nodes that each cell from there on reaches along each axis.
        let mut lowest = [0; D];
        let mut reached = [[Nodes::MAX; SPAN]; 3];
        for i in 0..D {
            let first = self.block[i] * SIDE;
            lowest[i] = self.mirrors[i].map_or(first, |wall| 2 * wall.node - first - (SIDE - 1)) - reach;
            for cell in 0..SIDE + reach {
                let steps = (cell - reach).max(0)..(cell + 1).min(SIDE);
                let nodes = steps.map(|step| layer::<D>(i, self.along(i, step)));
                reached[i][cell as usize] = nodes.fold(0, |all, nodes| all | nodes);
            }
        }
        let seen = Seen::<V, D>::new(&self);
        let columns = self.near.bodies[self.body].particles.view();
        let ends: [[i32; 2]; D] =
            array([0; 2], |i| [lowest[i], lowest[i] + SIDE + reach - 1].map(|cell| cell.div_euclid(SIDE)));
        let mut home: [i32; D] = array(0, |i| ends[i][0]);
        loop {
            // Of the home block, the cells that count, as steps from the lowest; in the plane the third axis has one step.
            let mut steps = [[0, 1]; 3];
            let mut nodes = self.wanted;
            for i in 0..D {
                let first = home[i] * SIDE - lowest[i];
                steps[i] = [first.max(0), (first + SIDE).min(SIDE + reach)];
                let along = &reached[i][steps[i][0] as usize..steps[i][1] as usize];
                nodes &= along.iter().fold(0, |all, nodes| all | nodes);
            }
            let tile = if nodes == 0 { None } else { self.near.cover.tile_at(self.body, home) };
            if let Some((order, cells)) = tile {
                for x in steps[0][0]..steps[0][1] {
                    for y in steps[1][0]..steps[1][1] {
                        for z in steps[2][0]..steps[2][1] {
                            let step: [i32; D] = array(0, |i| [x, y, z][i]);
                            let mut nodes = self.wanted;
                            let mut local = 0;
                            for i in 0..D {
                                nodes &= reached[i][step[i] as usize];
                                local = local * SIDE + (lowest[i] + step[i] - home[i] * SIDE);
                            }
                            let local = local as usize;
                            let (mut first, end) = (cells[local] as usize, cells[local + 1] as usize);
                            while nodes != 0 && first < end {
                                let count = (end - first).min(V::COUNT);
                                let place: [[i32; D]; 2] =
                                    [array(0, |i| lowest[i] + step[i]), array(0, |i| step[i] - reach)];
                                self.group::<M, V>(
                                    &seen,
                                    &columns,
                                    &order[first..first + count],
                                    place,
                                    nodes,
                                );
                                first += count;
                            }
                        }
                    }
                }
            }
            // The next home block, the last axis fastest.
            let mut axis = D;
            loop {
                if axis == 0 {
                    return;
                }
                axis -= 1;
                home[axis] += 1;
                if home[axis] <= ends[axis][1] {
                    break;
                }
                home[axis] = ends[axis][0];
            }
        }
    }

    /// Coordinate in the block of the node that is `step` from the lowest along an axis, and the other way round.
    #[inline(always)]
    fn along(&self, axis: usize, step: i32) -> i32 {
        if self.mirrors[axis].is_some() { SIDE - 1 - step } else { step }
    }

    /// Adds particles of one cell to nodes; the cell, and its steps from the lowest node.
    #[inline(always)]
    fn group<M: Machine<T>, V: Lanes<Real = T>>(
        &mut self,
        seen: &Seen<V, D>,
        columns: &Columns<T, D>,
        index: &[u32],
        [cell, base]: [[i32; D]; 2],
        mut nodes: Nodes,
    ) {
        // No closure: the compiler may leave one of some size uninlined, and then its instructions are calls.
        let mut position = Vector::<V, D>::ZERO;
        let members = Members::new(columns, index);
        let half = members.load::<V>(Column::<D>::HALF_WIDTH) * seen.per_cell;
        let mut shapes = [B::shape(V::ZERO, half); D];
        for i in 0..D {
            position[i] = members.load(Column::<D>::POSITION + i);
            let r = (position[i] - seen.origin[i]) * seen.per_cell - V::splat(T::of(f64::from(cell[i])));
            shapes[i] = B::shape(r, half);
            // The node sees a particle move away as the particle sees the node move: grad at the node = -grad S(x_p).
            for rise in &mut shapes[i].rise {
                *rise *= seen.per_cell * -seen.sign[i];
            }
        }
        let mass: V = members.load(Column::<D>::MASS);
        let volume: V = members.load(Column::<D>::VOLUME);
        let mut f = Matrix::ZERO;
        for (k, &[row, column]) in deformation_entries(D).iter().enumerate() {
            f.0[row][column] = members.load(Column::<D>::DEFORMATION + k);
        }
        let mut stress = Symmetric::<V>::ZERO;
        for k in 0..stress_entries(D) {
            stress.0[k] = members.load::<V>(Column::<D>::STRESS + k) * seen.turn[k];
        }
        let jacobian = f.det();
        // The room on the grid, in the plane an area, and the volume that the stress fills.
        let room =
            if D == 2 { volume * (f.0[0][0] * f.0[1][1] - f.0[0][1] * f.0[1][0]) } else { volume * jacobian };
        let filled = volume * jacobian;
        let per_jacobian = V::ONE / jacobian;
        let mut inverse = [[V::ZERO; D]; D];
        for i in 0..D {
            for j in 0..D {
                let (a, b, c, d) = ((j + 1) % 3, (j + 2) % 3, (i + 1) % 3, (i + 2) % 3);
                let minor = f.0[a][c] * f.0[b][d] - f.0[a][d] * f.0[b][c];
                inverse[i][j] = minor * per_jacobian * (seen.sign[i] * seen.sign[j]);
            }
        }
        let (mut arm, mut place) = (Vector::<V, D>::ZERO, Vector::<V, D>::ZERO);
        for i in 0..D {
            arm[i] = seen.offset[i] + seen.sign[i] * position[i] - seen.first[i];
            let start: V = members.load(Column::<D>::START + i);
            place[i] = seen.offset[i] + seen.sign[i] * start;
        }
        for i in 0..D {
            for j in 0..D {
                place[i] -= inverse[i][j] * arm[j];
            }
        }

        let mut by_volume = [V::ZERO; 4 * (ROWS - FIRST)];
        for i in 0..D {
            by_volume[i] = place[i] * room;
            by_volume[D + i] = arm[i] * room;
            for j in 0..D {
                by_volume[2 * D + i * D + j] = inverse[i][j] * room;
            }
        }
        for k in 0..stress_entries(D) {
            by_volume[2 * D + D * D + k] = stress.0[k] * room;
        }
        let mut rows = [Rows::<T>::EMPTY; ROWS - FIRST];
        for row in 0..weighted_rows(D) {
            let k = 4 * row;
            rows[row].fill([by_volume[k], by_volume[k + 1], by_volume[k + 2], by_volume[k + 3]]);
        }
        let mut force = [Rows::<T>::EMPTY; D];
        for j in 0..D {
            let mut column = [V::ZERO; 4];
            for i in 0..D {
                column[i] = stress.at(i, j) * filled;
            }
            force[j].fill(column);
        }
        let (room, mass) = (room.numbers(), mass.numbers());

        while let Some(node) = next_of(&mut nodes) {
            let steps = node_at([0; D], node);
            let offset: [usize; D] = array(0, |i| (self.along(i, steps[i]) - base[i]) as usize);
            let [x, dx] = [shapes[0].weight[offset[0]], shapes[0].slope(offset[0])];
            let [y, dy] = [shapes[1].weight[offset[1]], shapes[1].slope(offset[1])];
            let mut shares = Rows::<T>::EMPTY;
            if D == 2 {
                shares.fill([dx * y, x * dy, V::ZERO, x * y]);
            } else {
                let [z, dz] = [shapes[D - 1].weight[offset[D - 1]], shapes[D - 1].slope(offset[D - 1])];
                let yz = y * z;
                shares.fill([dx * yz, x * (dy * z), x * (y * dz), x * yz]);
            }
            let mut added = [M::Quad::ZERO; ROWS];
            for p in 0..index.len().min(MOST_LANES) {
                let share = shares.get::<M>(p);
                added[0] += share * M::Quad::splat(room.0[p]);
                added[1] += share * M::Quad::splat(mass.0[p]);
                for j in 0..D {
                    added[2] += force[j].get::<M>(p) * M::Quad::splat(shares.0[p][j]);
                }
                let weight = M::Quad::splat(shares.0[p][3]);
                for row in 0..weighted_rows(D) {
                    added[FIRST + row] += rows[row].get::<M>(p) * weight;
                }
            }
            let rank = (self.wanted & ((1 << node) - 1)).count_ones() as usize;
            let sums = &mut self.sums[rank].0;
            for row in 0..FIRST + weighted_rows(D) {
                // SAFETY: a row has four numbers, borrowed for writing.
                unsafe { (M::Quad::load(sums[row].as_ptr()) + added[row]).store(sums[row].as_mut_ptr()) }
            }
        }
    }
}

/// How a block's particles are seen, in every lane.
struct Seen<V, const D: usize> {
    origin: Vector<V, D>,
    per_cell: V,
    /// The first node of the block [m].
    first: Vector<V, D>,
    /// A point `x` is seen at `offset + sign x`.
    offset: Vector<V, D>,
    sign: Vector<V, D>,
    /// Signs of the entries of a stress.
    turn: [V; 6],
}

impl<V: Lanes, const D: usize> Seen<V, D> {
    #[inline(always)]
    fn new<B>(around: &Around<'_, V::Real, D, B>) -> Self {
        let lattice = &around.near.lattice;
        let splat = |x: Vector<V::Real, D>| Vector::<V, D>::from_fn(|i| V::splat(x[i]));
        let sign = |i: usize| if i < D && around.mirrors[i].is_some() { -V::ONE } else { V::ONE };
        let offset = Vector::from_fn(|i| match around.mirrors[i] {
            Some(wall) => {
                let position = lattice.origin[i] + V::Real::of(f64::from(wall.node)) * lattice.cell;
                V::splat(position + position)
            }
            None => V::ZERO,
        });
        Seen {
            origin: splat(lattice.origin),
            per_cell: V::splat(lattice.per_cell),
            first: splat(lattice.position(node_at(around.block, 0))),
            offset,
            sign: Vector::from_fn(sign),
            turn: [V::ONE, V::ONE, V::ONE, sign(0) * sign(1), sign(1) * sign(2), sign(0) * sign(2)],
        }
    }
}

/// Particles of a cell, one in each lane; the first in the lanes beyond.
struct Members<'a, T, const D: usize> {
    columns: &'a Columns<T, D>,
    index: [usize; MOST_LANES],
    count: usize,
    /// Whether they lie side by side in memory.
    in_a_row: bool,
}

impl<'a, T: Real, const D: usize> Members<'a, T, D> {
    #[inline(always)]
    fn new(columns: &'a Columns<T, D>, index: &[u32]) -> Self {
        // Indices within a cell ascend.
        let in_a_row = (index[index.len() - 1] - index[0]) as usize == index.len() - 1;
        Members { columns, index: in_lanes(index), count: index.len(), in_a_row }
    }

    /// Their numbers in a column.
    #[inline(always)]
    fn load<V: Lanes<Real = T>>(&self, column: usize) -> V {
        // SAFETY: the particles exist, and nobody writes to them in a survey.
        unsafe {
            let first = self.columns.at(column, self.index[0]);
            match self.in_a_row {
                true if self.count == V::COUNT => V::load(first),
                true => V::load_part(first, self.count),
                false => V::gather(self.columns.at(column, 0), &self.index),
            }
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

    #[inline(always)]
    fn get<M: Machine<T>>(&self, particle: usize) -> M::Quad {
        // SAFETY: a row is four numbers.
        unsafe { M::Quad::load(self.0[particle].as_ptr()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::basis::{Gimp, Linear};
    use crate::body::{Body, Particle};
    use crate::boundary::{Boundary, reflect};
    use crate::contact::{Rules, rules};
    use crate::geometry::{Shape, Whole};
    use crate::grid::{Cover, Field, Lattice};
    use crate::lanes::Processor;
    use crate::material::{Isotropic, Material, NeoHookean, Thickness};
    use crate::particles::Particles;
    use crate::transfer::{Stencil, offsets};

    /// Particles strewn over a few cells before two mirrors, deformed and stressed.
    fn body<const D: usize>() -> Body<f64, D> {
        let random = |i: usize| (i as f64 * 0.754_877_666_2).fract();
        let place = |i: usize, n: usize| Vector::from_fn(|k| 5.0 * random((k + n) * i + k));
        let particle = |i: usize| {
            let mut deformation = Matrix::IDENTITY;
            let mut stress = Symmetric::ZERO;
            for (k, &[row, column]) in deformation_entries(D).iter().enumerate() {
                deformation.0[row][column] += 0.3 * random(31 * i + 7 * k) - 0.15;
            }
            (0..stress_entries(D)).for_each(|k| stress.0[k] = random(17 * i + 5 * k) - 0.5);
            Particle {
                position: place(i, 11),
                velocity: Vector::ZERO,
                mass: 1.0 + random(i),
                volume: 0.5 + random(2 * i + 1),
                half_width: 0.2 + 0.05 * random(3 * i),
                deformation,
                stress,
                number: i as u32,
            }
        };
        // Where they were at first, and where they are now.
        let mut particles = Particles::from_fn(300, particle);
        for i in 0..300 {
            particles.set(i, &Particle { position: place(i, 3), ..particle(i) });
        }
        Body {
            name: String::new(),
            material: Material::NeoHookean(NeoHookean {
                elastic: Isotropic { bulk_modulus: 1.0, shear_modulus: 1.0 },
            }),
            density: 1.0,
            particles,
            rigid: false,
            whole: Whole::new(&Shape::Ball { center: [0.0; 3], radius: 1.0 }, Vec::new(), D),
            thickness: Thickness::Moved,
        }
    }

    /// The same sums, particle by particle as the equations read, for every image of the node.
    fn plainly<const D: usize, B: Basis<f64>>(
        near: &Near<'_, f64, D>,
        node: [i32; D],
        first: Vector<f64, D>,
    ) -> Sums<f64, D> {
        let mut sums = Sums::<f64, D>::EMPTY;
        for turned in offsets::<D>(2) {
            let walls: Vec<&Wall> =
                near.boundary.walls.iter().filter(|wall| turned[wall.axis] == 1).collect();
            if walls.len() != turned.iter().sum::<usize>() {
                continue;
            }
            let image = walls.iter().fold(node, |node, wall| wall.image(node));
            let flip = |v: Vector<f64, D>| walls.iter().fold(v, |v, wall| reflect(v, wall.axis));
            let seen = |mut x: Vector<f64, D>| {
                walls.iter().for_each(|wall| x[wall.axis] = 2.0 * f64::from(wall.node) - x[wall.axis]);
                x
            };
            let sign = |i: usize| if i < D && turned[i] == 1 { -1.0 } else { 1.0 };
            let columns = near.bodies[0].particles.view();
            for (index, particle) in near.bodies[0].particles.iter().enumerate() {
                let stencil = Stencil::<f64, D, B>::new(&near.lattice, &particle);
                let Some(offset) = offsets::<D>(B::WIDTH)
                    .find(|offset| (0..D).all(|i| stencil.base()[i] + offset[i] as i32 == image[i]))
                else {
                    continue;
                };
                let (weight, gradient) = stencil.at(offset);
                let force =
                    flip(-particle.stress.times(gradient)) * (particle.volume * particle.deformation.det());
                let gradient = flip(-gradient);
                let share = particle.room() * weight;
                let inverse = particle.deformation.inverse();
                let inverse = Matrix::from_fn(|i, j| inverse.0[i][j] * sign(i) * sign(j));
                let arm = seen(particle.position) - first;
                let at = |k: usize| unsafe { *columns.at(Column::<D>::START + k, index) };
                // SAFETY of `at`: nobody else uses the particles.
                let start = seen(Vector::from_fn(at));
                let mut numbers = Vec::new();
                numbers
                    .extend((0..D).map(|i| start[i] - (0..D).map(|j| inverse.0[i][j] * arm[j]).sum::<f64>()));
                numbers.extend(arm.0);
                numbers.extend((0..D * D).map(|k| inverse.0[k / D][k % D]));
                let pairs = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [0, 2]];
                numbers.extend(
                    (0..stress_entries(D))
                        .map(|k| particle.stress.0[k] * sign(pairs[k][0]) * sign(pairs[k][1])),
                );
                for i in 0..D {
                    sums.0[0][i] += gradient[i] * particle.room();
                    sums.0[1][i] += gradient[i] * particle.mass;
                    sums.0[2][i] += force[i];
                }
                sums.0[0][3] += share;
                sums.0[1][3] += particle.mass * weight;
                for (k, number) in numbers.into_iter().enumerate() {
                    sums.0[FIRST + k / 4][k % 4] += share * number;
                }
            }
        }
        sums
    }

    fn particles_of_a_cell_side_by_side_give_the_sums<const D: usize, B: Basis<f64>>() {
        let lattice = Lattice::new(Vector::ZERO, 1.0);
        let bodies = [body::<D>()];
        let mut cover = Cover::<D>::default();
        cover.update((1, |_| 300, B::WIDTH as i32 - 1), None, |_, particle| {
            let (position, half) = bodies[0].particles.place(particle);
            std::array::from_fn(|i| Number::max(B::reach(position[i], half), -9.0).floor() as i32)
        });
        let wall = |axis, node, inward| Wall { axis, node, inward, face: Face::Symmetry };
        let boundary = Boundary::new(vec![wall(0, 0, 1), wall(D - 1, 5, -1)]);
        let rules = Rules::of_all(1, rules::Rule::from(&crate::scene::ContactRule::default()));
        let field = Field { nodes: Vec::new(), present: Vec::new() };
        for processor in Processor::available() {
            let near = Near {
                cover: &cover,
                bodies: &bodies,
                field: &field,
                lattice,
                boundary: &boundary,
                rules: &rules,
                processor,
            };
            for block in offsets::<D>(2).map(|block| block.map(|b| b as i32)) {
                let wanted = every_node(D) & 0x9e37_79b9_7f4a_7c15;
                let mut sums = vec![Sums::EMPTY; wanted.count_ones() as usize];
                near.sum_around::<B>((0, block), wanted, &mut sums);
                let mut nodes = wanted;
                for sums in &sums {
                    let node = node_at(block, next_of(&mut nodes).expect("as many nodes as sums"));
                    let plain = plainly::<D, B>(&near, node, lattice.position(node_at(block, 0)));
                    for (a, b) in sums.0.as_flattened().iter().zip(plain.0.as_flattened()) {
                        assert!((a - b).abs() < 1e-10, "{block:?} {node:?}: {sums:?} {plain:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn sums_are_those_of_the_equations() {
        particles_of_a_cell_side_by_side_give_the_sums::<2, Linear>();
        particles_of_a_cell_side_by_side_give_the_sums::<2, Gimp>();
        particles_of_a_cell_side_by_side_give_the_sums::<3, Linear>();
        particles_of_a_cell_side_by_side_give_the_sums::<3, Gimp>();
    }

    #[test]
    fn nodes_behind_a_wall() {
        let wall = Wall { axis: 1, node: 6, inward: -1, face: Face::Fixed };
        for (block, nodes) in [([0, 0], 0), ([0, 1], 0xcccc), ([3, 2], 0xffff)] {
            assert_eq!(behind::<2>(&wall, block, 0), nodes, "{block:?}");
        }
        let wall = Wall { axis: 0, node: 1, inward: 1, face: Face::Fixed };
        assert_eq!(behind::<3>(&wall, [0; 3], -1), 0xffff);
    }
}
