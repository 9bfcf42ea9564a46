//! The sparse grid: blocks of nodes that exist only under a body's particles.
//!
//! Space is cut into cells, nodes are their corners, and a block is 4^D nodes. Each body owns the blocks that its
//! particles reach, so memory and time follow the particles, never bodies x grid nor the size of the domain.

mod active_blocks;
mod border;
mod cell_list;
mod field;
mod message;
mod periods;

pub use active_blocks::{ActiveBlocks, Blocks, Emigrant, SentBlock, SharedBlock, Tile};
pub use border::{Border, BorderSlot, Cut, ForeignTile, Giver, Mirrors, Traffic};
pub use cell_list::{MOST_CELLS, addressable};
pub use field::{
    Disjoint, Field, NODE_VALUES, Node, NodeSums, NodeValues, Sought, WINDOW_NODES, Window, add_at,
    add_corner, cells_at, cells_reaching, count_at, is_within, nodes_at, window_side,
};
pub use message::{Message, message_to};

pub use periods::Periods;

use crate::tensor::{Real, Vector};

/// Nodes along a side of a block.
pub const SIDE: i32 = 4;

/// Nodes in a block: 4^D.
pub const fn nodes_per_block(dimension: usize) -> usize {
    (SIDE as usize).pow(dimension as u32)
}

/// Most nodes in a block.
const MOST_NODES: usize = nodes_per_block(3);

/// Nodes of a block, a bit each, the lowest first.
pub type Nodes = u64;

/// Nodes of a block whose coordinate along an axis is `n`; bits beyond the block mean nothing.
pub fn layer<const D: usize>(axis: usize, n: i32) -> Nodes {
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

/// The lowest place in `nodes`, which is taken out of it.
#[inline(always)]
pub fn next_of(nodes: &mut Nodes) -> Option<usize> {
    let place = nodes.trailing_zeros();
    *nodes &= nodes.wrapping_sub(1);
    (place < Nodes::BITS).then_some(place as usize)
}

/// Where the nodes are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice<T, const D: usize> {
    /// Position of the node at zero [m].
    pub origin: Vector<T, D>,
    /// Side of a cell [m].
    pub cell: T,
    /// Its inverse [1/m].
    pub per_cell: T,
    /// Half the side of the box as which the nodes see every particle [cells]: 1/2 by quadratic splines, see
    /// [`crate::basis::Gimp`], 1 by cubic ones; `None` where they see each as its own box.
    pub half_side: Option<T>,
    /// After how many blocks it repeats.
    pub periods: Periods<D>,
}

impl<T: Real, const D: usize> Lattice<T, D> {
    /// A grid with a node at `origin` and cells of side `cell` [m].
    pub fn new(origin: Vector<T, D>, cell: T) -> Self {
        Lattice { origin, cell, per_cell: T::ONE / cell, half_side: None, periods: Periods::default() }
    }

    /// Half the side of the box as which the nodes see a particle with a box of this half side [m], in cells.
    #[inline(always)]
    pub fn seen_half_side(&self, half_width: T) -> T {
        self.half_side.unwrap_or_else(|| half_width * self.per_cell)
    }

    /// The same in metres.
    #[inline(always)]
    pub fn half_box(&self, half_width: T) -> T {
        self.half_side.map_or(half_width, |half| half * self.cell)
    }

    /// Position in cells from the origin.
    #[inline(always)]
    pub fn cells(&self, position: Vector<T, D>) -> Vector<T, D> {
        (position - self.origin) * self.per_cell
    }

    /// Position of that image of a node which is nearest to a place along each axis [m].
    pub fn position_near(&self, node: [i32; D], place: [f64; 3]) -> [f64; 3] {
        let mut position = self.position(node).space();
        for (i, &blocks) in self.periods.0.iter().enumerate().filter(|(_, blocks)| **blocks > 0) {
            let period = f64::from(blocks * SIDE) * self.cell.f64();
            position[i] -= period * ((position[i] - place[i]) / period).round();
        }
        position
    }

    /// Position of a node [m].
    #[inline(always)]
    pub fn position(&self, node: [i32; D]) -> Vector<T, D> {
        Vector::from_fn(|i| self.origin[i] + T::of(f64::from(node[i])) * self.cell)
    }
}

/// The block that holds a node, and the node's place in it, the last axis fastest.
#[inline(always)]
pub fn locate<const D: usize>(node: [i32; D]) -> ([i32; D], usize) {
    let mut local = 0;
    for n in node {
        local = local * SIDE as usize + n.rem_euclid(SIDE) as usize;
    }
    (node.map(|n| n.div_euclid(SIDE)), local)
}

/// The node at a place of a block.
#[inline(always)]
pub fn node_at<const D: usize>(block: [i32; D], local: usize) -> [i32; D] {
    let mut rest = local as i32;
    let mut node = [0; D];
    for i in (0..D).rev() {
        node[i] = block[i] * SIDE + rest % SIDE;
        rest /= SIDE;
    }
    node
}
