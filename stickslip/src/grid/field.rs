//! What the nodes carry: all bodies' blocks in one slab, and the window through which a tile sees its part of it.

use super::{Cover, SIDE, Tile, locate, nodes_per_block};
use crate::basis::MAX_WIDTH;
use crate::tensor::{Real, Vector};
use std::marker::PhantomData;

/// One body's share of one grid node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node<T, const D: usize> {
    /// Mass [kg].
    pub mass: T,
    /// Velocity as interpolated from the particles, before contact and forces [m/s].
    pub start: Vector<T, D>,
    /// Velocity now [m/s]; momentum [kg m/s] while particles are being scattered.
    pub velocity: Vector<T, D>,
    /// Force of the body's own stress [N].
    pub force: Vector<T, D>,
}

impl<T: Real, const D: usize> Node<T, D> {
    /// A node that nothing reaches.
    pub const EMPTY: Self =
        Node { mass: T::ZERO, start: Vector::ZERO, velocity: Vector::ZERO, force: Vector::ZERO };
}

/// All bodies' blocks, in the order of [`Cover::slots`].
#[derive(Clone, Debug, Default)]
pub struct Field<T, const D: usize> {
    /// Nodes, block by block.
    pub nodes: Vec<Node<T, D>>,
}

impl<T: Real, const D: usize> Field<T, D> {
    /// Empties the field and gives it the blocks of a cover.
    pub fn clear(&mut self, cover: &Cover<D>) {
        self.nodes.clear();
        self.nodes.resize(cover.slots.len() * nodes_per_block(D), Node::EMPTY);
    }
}

/// Nodes along a side of a window: what a tile's particles reach.
pub const WINDOW: usize = SIDE as usize + MAX_WIDTH - 1;

/// A tile's part of the field, copied to one place: nodes `block * 4` to `block * 4 + 5` along each axis, the last fastest.
#[derive(Clone, Debug)]
pub struct Window<T, const D: usize> {
    /// The nodes.
    pub nodes: Vec<Node<T, D>>,
}

impl<T: Real, const D: usize> Default for Window<T, D> {
    fn default() -> Self {
        Window { nodes: vec![Node::EMPTY; WINDOW.pow(D as u32)] }
    }
}

impl<T: Real, const D: usize> Window<T, D> {
    /// Empties every node.
    pub fn clear(&mut self) {
        self.nodes.fill(Node::EMPTY);
    }

    /// Copies the tile's nodes from the field.
    pub fn load(&mut self, field: &Field<T, D>, tile: &Tile<D>) {
        for (i, node) in self.nodes.iter_mut().enumerate() {
            *node = field.nodes[field_index(tile, i)];
        }
    }

    /// Adds what was scattered into the window to the field.
    ///
    /// # Safety
    /// No other thread may touch the tile's slots meanwhile.
    pub unsafe fn add_to(&self, field: &Disjoint<Node<T, D>>, tile: &Tile<D>) {
        for (i, share) in self.nodes.iter().enumerate() {
            // SAFETY: the caller keeps other threads away from the tile's slots.
            let node = unsafe { field.get(field_index(tile, i)) };
            node.mass += share.mass;
            node.velocity += share.velocity;
            node.force += share.force;
        }
    }
}

/// Where node `i` of a window lies in the field.
#[inline(always)]
fn field_index<const D: usize>(tile: &Tile<D>, i: usize) -> usize {
    let mut rest = i;
    let mut node = [0; D];
    for n in node.iter_mut().rev() {
        *n = (rest % WINDOW) as i32;
        rest /= WINDOW;
    }
    let (block, local) = locate(node);
    let corner = block.iter().fold(0, |corner, &b| corner << 1 | b as usize);
    tile.slots[corner] as usize * nodes_per_block(D) + local
}

/// A slice whose entries threads write to without overlap.
pub struct Disjoint<'a, X> {
    start: *mut X,
    len: usize,
    slice: PhantomData<&'a mut [X]>,
}

// SAFETY: entries are only reached through `get`, whose callers keep threads apart.
unsafe impl<X: Send> Sync for Disjoint<'_, X> {}

impl<'a, X> Disjoint<'a, X> {
    /// Opens a slice to many threads.
    pub fn new(slice: &'a mut [X]) -> Self {
        Disjoint { start: slice.as_mut_ptr(), len: slice.len(), slice: PhantomData }
    }

    /// Entry `i`.
    ///
    /// # Safety
    /// No other reference to entry `i` may be alive.
    #[allow(clippy::mut_from_ref)]
    #[inline(always)]
    pub unsafe fn get(&self, i: usize) -> &mut X {
        assert!(i < self.len, "an index of the slice");
        // SAFETY: in bounds, and the caller holds the only reference.
        unsafe { &mut *self.start.add(i) }
    }
}
