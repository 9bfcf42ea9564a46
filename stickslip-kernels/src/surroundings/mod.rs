//! What a body's particles say at the nodes of a block where it meets others.
//!
//! Every particle near such nodes is visited once and added to all that it reaches, those of a cell side by side.
//! Behind a mirror its image is added.

// Sums over nodes and components read better by their indices.
#![allow(clippy::needless_range_loop)]

mod cell;
mod reference_map;
mod sums;
#[cfg(test)]
mod tests;

pub use reference_map::{Offset, ReferenceMap};
pub use sums::{MaterialSums, Wanted};

use crate::basis::{Basis, MAX_WIDTH, takes_most_time};
use crate::boundary::Wall;
use crate::grid::{ActiveBlocks, Lattice, Nodes, SIDE, every_node, layer};
use crate::lanes::{Laned, Lanes, Machine, Processor, Work};
use crate::particles::Columns;
use crate::scheme::Face;
use crate::tensor::array;
use std::marker::PhantomData;

/// The nodes of a block that lie so deep behind a wall: `depth` or further out.
pub fn behind<const D: usize>(wall: &Wall, block: [i32; D], depth: i32) -> Nodes {
    let depth_of = |n: i32| (block[wall.axis] * SIDE + n - wall.node) * wall.inward;
    let layers = (0..SIDE).filter(|&n| depth_of(n) <= depth).map(|n| layer::<D>(wall.axis, n));
    layers.fold(0, |nodes, layer| nodes | layer) & every_node(D)
}

/// For each axis, the mirror that particles are seen in, if any.
pub type Mirrors<'a, const D: usize> = [Option<&'a Wall>; D];

/// Where particles and nodes are, and who looks.
pub struct Surroundings<'a, T, const D: usize> {
    /// The blocks.
    pub active: &'a ActiveBlocks<D>,
    /// Where the nodes are.
    pub lattice: Lattice<T, D>,
    /// The faces of the domain that do something.
    pub walls: &'a [Wall],
    /// Who looks.
    pub processor: Processor,
}

/// A body whose particles are added.
pub struct SeenBody<T, const D: usize> {
    /// Its index.
    pub number: usize,
    /// Its particles, which nobody writes to meanwhile.
    pub columns: Columns<T, D>,
    /// Whether surfaces may be found by its particles' deformation.
    pub trusts_deformation: bool,
    /// Along which axes it is joined to its own images.
    pub is_joined: [bool; D],
}

/// How [`sum_around`] is called.
pub type SumAround<T, const D: usize> = fn(
    &Surroundings<'_, T, D>,
    (&SeenBody<T, D>, [i32; D]),
    (Nodes, Wanted),
    (&mut [MaterialSums<T, D>], &mut Vec<Chunk<D>>),
);

/// Adds a body's particles to the wanted nodes of a block: the sums of the n-th of them are `sums[n]`.
/// `chunks` is room to work in. Where the grid repeats, particles around every image of the block are added.
pub fn sum_around<T: Laned, const D: usize, B: Basis<T>>(
    near: &Surroundings<'_, T, D>,
    (body, block): (&SeenBody<T, D>, [i32; D]),
    (wanted, sought): (Nodes, Wanted),
    (sums, chunks): (&mut [MaterialSums<T, D>], &mut Vec<Chunk<D>>),
) {
    let mut walls = near.walls.iter().filter(|wall| reflects(wall, block, B::WIDTH as i32));
    let mirrors_near: [Option<&Wall>; 6] = std::array::from_fn(|_| walls.next());
    // No mirror, and every mirror and combination of mirrors whose images reach nodes of the block.
    for combination in 0..1_u32 << mirrors_near.iter().flatten().count() {
        let mut mirrors: Mirrors<D> = [None; D];
        let chosen = mirrors_near.iter().flatten().enumerate().filter(|(i, _)| combination >> i & 1 == 1);
        if chosen.into_iter().all(|(_, &wall)| mirrors[wall.axis].replace(wall).is_none()) {
            for image in near.active.images_of(body.number) {
                let around = Around {
                    near,
                    body,
                    block: std::array::from_fn(|i| block[i] + image[i]),
                    image: *image,
                    wanted,
                    sought,
                    mirrors,
                    chunks: &mut *chunks,
                    sums: &mut *sums,
                    basis: PhantomData::<B>,
                };
                T::run(near.processor, around);
            }
        }
    }
}

/// Whether images of particles before a wall, which reach so many nodes along an axis, reach nodes of a block.
fn reflects<const D: usize>(wall: &Wall, block: [i32; D], width: i32) -> bool {
    let near = if wall.inward > 0 { 0 } else { SIDE - 1 };
    let depth = (block[wall.axis] * SIDE + near - wall.node) * wall.inward;
    wall.face == Face::Symmetry && depth < width
}

/// The particles of a body around a block, as they are or as they are seen in mirrors.
struct Around<'a, T, const D: usize, B> {
    near: &'a Surroundings<'a, T, D>,
    body: &'a SeenBody<T, D>,
    block: [i32; D],
    /// How many blocks that is from the one whose nodes these are.
    image: [i32; D],
    wanted: Nodes,
    sought: Wanted,
    mirrors: Mirrors<'a, D>,
    chunks: &'a mut Vec<Chunk<D>>,
    sums: &'a mut [MaterialSums<T, D>],
    basis: PhantomData<B>,
}

impl<T: Laned, const D: usize, B: Basis<T>> Work for Around<'_, T, D, B> {
    type Real = T;
    type Output = ();
    const BY_AVX512: bool = D == 3 && takes_most_time::<T, B>();

    #[inline(always)]
    fn run<M: Machine<T>>(self) {
        if const { D == 2 } { self.sum::<M, M::Quad>() } else { self.sum::<M, M::Wide>() }
    }
}

/// Particles of a cell, no more than there are lanes, and the nodes that they reach.
#[derive(Clone, Copy, Debug)]
pub struct Chunk<const D: usize> {
    /// Whether they are guests of another rank.
    guests: bool,
    /// Place of the first in the order of these.
    first: u32,
    count: u32,
    cell: [i32; D],
    /// Its steps from the first node of the block.
    base: [i32; D],
    nodes: Nodes,
}

/// Cells along an axis whose particles reach nodes of a block, at most.
const SPAN: usize = SIDE as usize + MAX_WIDTH - 1;

impl<T: Laned, const D: usize, B: Basis<T>> Around<'_, T, D, B> {
    #[inline(always)]
    fn sum<M: Machine<T>, V: Lanes<Real = T>>(mut self) {
        let reach = B::WIDTH as i32 - 1;
        // The lowest cell, where it is and not as it is seen, and the nodes that each cell from there on reaches along
        // each axis.
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
        self.chunks.clear();
        let ends: [[i32; 2]; D] =
            array([0; 2], |i| [lowest[i], lowest[i] + SIDE + reach - 1].map(|cell| cell.div_euclid(SIDE)));
        let mut home: [i32; D] = array(0, |i| ends[i][0]);
        loop {
            // Of the home block, the cells that count, as steps from the lowest;
            // in the plane the third axis has one step.
            let mut steps = [[0, 1]; 3];
            let mut nodes = self.wanted;
            for i in 0..D {
                let first = home[i] * SIDE - lowest[i];
                steps[i] = [first.max(0), (first + SIDE).min(SIDE + reach)];
                let along = &reached[i][steps[i][0] as usize..steps[i][1] as usize];
                nodes &= along.iter().fold(0, |all, nodes| all | nodes);
            }
            let tile = if nodes == 0 { None } else { self.near.active.tile_at(self.body.number, home) };
            if let Some((guests, cells)) = tile {
                self.list((cells, guests), (lowest, home), (&reached, steps), V::COUNT);
            }
            // The next home block, the last axis fastest.
            let mut axis = D;
            loop {
                if axis == 0 {
                    return self.add::<M, V>();
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

    /// Lists the particles of a tile that reach wanted nodes, as many at a time as there are lanes.
    #[inline(always)]
    fn list(
        &mut self,
        (cells, guests): (&[u32], bool),
        (lowest, home): ([i32; D], [i32; D]),
        (reached, steps): (&[[Nodes; SPAN]; 3], [[i32; 2]; 3]),
        lanes: usize,
    ) {
        let reach = B::WIDTH as i32 - 1;
        for x in steps[0][0]..steps[0][1] {
            let along_x = self.wanted & reached[0][x as usize];
            for y in steps[1][0]..steps[1][1] {
                let along_y = along_x & reached[1][y as usize];
                if along_y == 0 {
                    continue;
                }
                for z in steps[2][0]..steps[2][1] {
                    let step: [i32; D] = array(0, |i| [x, y, z][i]);
                    let cell: [i32; D] = array(0, |i| lowest[i] + step[i]);
                    let nodes = if D == 2 { along_y } else { along_y & reached[2][z as usize] };
                    let mut local = 0;
                    for i in 0..D {
                        local = local * SIDE + (cell[i] - home[i] * SIDE);
                    }
                    let (mut first, end) = (cells[local as usize], cells[local as usize + 1]);
                    while nodes != 0 && first < end {
                        let count = (end - first).min(lanes as u32);
                        let base = array(0, |i| step[i] - reach);
                        self.chunks.push(Chunk { first, guests, count, cell, base, nodes });
                        first += count;
                    }
                }
            }
        }
    }

    /// Coordinate in the block of the node that is `step` from the lowest along an axis, and the other way round.
    #[inline(always)]
    fn along(&self, axis: usize, step: i32) -> i32 {
        if self.mirrors[axis].is_some() { SIDE - 1 - step } else { step }
    }
}
