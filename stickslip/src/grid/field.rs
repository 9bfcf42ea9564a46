//! What the nodes carry: all bodies' blocks in one slab, and the window through which a tile sees its part of it.

use super::{Cover, Nodes, SIDE, Tile, next_of, nodes_per_block};
use crate::basis::MAX_WIDTH;
use crate::lanes::{Lanes, Machine, prefetch};
use crate::tensor::{Real, Vector};
use crate::transfer::Share;
use rayon::prelude::*;
use std::marker::PhantomData;

/// One body's share of one grid node, one number after the other: windows take four of them at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Node<T, const D: usize> {
    /// Velocity as interpolated from the particles, before contact and forces [m/s].
    pub start: Vector<T, D>,
    /// Velocity as integrated, which moves the particles [m/s].
    pub carry: Vector<T, D>,
    /// Force of the body's own stress [N].
    pub force: Vector<T, D>,
    /// Velocity now [m/s]; momentum [kg m/s] while particles are being scattered.
    pub velocity: Vector<T, D>,
    /// Mass [kg].
    pub mass: T,
}

impl<T: Real, const D: usize> Node<T, D> {
    /// A node that nothing reaches.
    pub const EMPTY: Self = Node {
        mass: T::ZERO,
        start: Vector::ZERO,
        velocity: Vector::ZERO,
        force: Vector::ZERO,
        carry: Vector::ZERO,
    };
}

/// Blocks that a thread takes at a time.
const BLOCKS: usize = 64;

/// All bodies' blocks, in the order of [`Cover::slots`].
#[derive(Clone, Debug, Default)]
pub struct Field<T, const D: usize> {
    /// Nodes, block by block.
    pub nodes: Vec<Node<T, D>>,
    /// Of each block, the nodes with mass, once [`Field::find_present`] has found them.
    pub present: Vec<Nodes>,
}

impl<T: Real, const D: usize> Field<T, D> {
    /// Empties the field and gives it the blocks of a cover.
    pub fn clear(&mut self, cover: &Cover<D>) {
        self.nodes.truncate(cover.slots.len() * nodes_per_block(D));
        self.nodes.par_iter_mut().with_min_len(4096).for_each(|node| *node = Node::EMPTY);
        self.nodes.resize(cover.slots.len() * nodes_per_block(D), Node::EMPTY);
    }

    /// Finds the nodes that have mass and does something to each of them.
    pub fn find_present(&mut self, f: impl Fn(&mut Node<T, D>) + Sync) {
        let n = nodes_per_block(D);
        self.present.resize(self.nodes.len() / n, 0);
        let blocks = self.nodes.par_chunks_exact_mut(n).zip(&mut self.present).with_min_len(BLOCKS);
        blocks.for_each(|(nodes, present)| {
            *present = 0;
            for (local, node) in nodes.iter_mut().enumerate() {
                if node.mass > T::ZERO {
                    *present |= 1 << local;
                    f(node);
                }
            }
        });
    }

    /// Does something to each node that has mass.
    pub fn each_present(&mut self, f: impl Fn(&mut Node<T, D>) + Sync) {
        let blocks = self.nodes.par_chunks_exact_mut(nodes_per_block(D)).zip(&self.present);
        blocks.with_min_len(BLOCKS).for_each(|(nodes, &present)| {
            let mut places = present;
            while let Some(local) = next_of(&mut places) {
                f(&mut nodes[local]);
            }
        });
    }
}

/// Nodes along a side of a window: what a tile's particles reach.
pub const WINDOW: usize = SIDE as usize + MAX_WIDTH - 1;

/// Nodes of a window in space; in the plane the first [`WINDOW`] squared are used.
pub const WINDOW_NODES: usize = WINDOW * WINDOW * WINDOW;

/// What a gather takes from the nodes, see [`Window::load`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sought<T> {
    /// v - (1 - a) v0, from which particles take their velocities; `a` is the PIC share.
    pub change: Option<T>,
    /// The velocities that strain particles.
    pub flow: bool,
    /// The velocities that move particles.
    pub carry: bool,
}

/// Four numbers, each the sum of two: particles are scattered two at a time.
pub type Halves<T> = [[T; 2]; 4];

/// A vector of each node of a window, with room for four numbers.
pub type Vectors<T> = [[T; 4]; WINDOW_NODES];

/// A tile's part of the field in one place: nodes `block * 4` to `block * 4 + 5` along each axis, the last fastest.
#[derive(Clone, Debug)]
pub struct Window<T, const D: usize> {
    /// v - (1 - a) v0 [m/s].
    pub change: Vectors<T>,
    /// The velocities that strain particles [m/s].
    pub flow: Vectors<T>,
    /// The velocities that move particles [m/s].
    pub carry: Vectors<T>,
    /// Momentum scattered so far [kg m/s], and mass [kg] in the last place; nothing between passes.
    pub momentum: [Halves<T>; WINDOW_NODES],
    /// Force scattered so far [N]; nothing between passes.
    pub force: [Halves<T>; WINDOW_NODES],
}

impl<T: Real, const D: usize> Default for Window<T, D> {
    fn default() -> Self {
        Window {
            change: [[T::ZERO; 4]; WINDOW_NODES],
            flow: [[T::ZERO; 4]; WINDOW_NODES],
            carry: [[T::ZERO; 4]; WINDOW_NODES],
            momentum: [[[T::ZERO; 2]; 4]; WINDOW_NODES],
            force: [[[T::ZERO; 2]; 4]; WINDOW_NODES],
        }
    }
}

/// Calls `f(node of the window, node of the field, how many in a row)` for the `side`^D first nodes of a tile's window.
#[inline(always)]
fn each_run<const D: usize>(tile: &Tile<D>, side: usize, mut f: impl FnMut(usize, usize, usize)) {
    const S: usize = SIDE as usize;
    for x in 0..side {
        for y in 0..if D == 2 { 1 } else { side } {
            for half in 0..2 {
                let (place, corner, local) = match D {
                    2 => (x * WINDOW, x / S * 2, x % S * S),
                    _ => ((x * WINDOW + y) * WINDOW, x / S * 4 + y / S * 2, (x % S * S + y % S) * S),
                };
                let first = tile.slots[corner + half] as usize * nodes_per_block(D) + local;
                let count = if half == 0 { S.min(side) } else { side.saturating_sub(S) };
                f(place + half * S, first, count);
            }
        }
    }
}

/// Vectors of a node: its numbers from so many dimensions on.
const START: usize = 0;
const CARRY: usize = 1;
const FORCE: usize = 2;
const VELOCITY: usize = 3;

/// Four numbers of a node in space, from a vector on: the next one's first number, or the mass, comes with it.
///
/// # Safety
/// The node must exist, and nobody may write to it meanwhile.
#[inline(always)]
unsafe fn four<Q: Lanes, const D: usize>(node: *const Node<Q::Real, D>, vector: usize) -> Q {
    // SAFETY: a node in space has thirteen numbers, four from its last vector on.
    unsafe { Q::load(node.cast::<Q::Real>().add(vector * D)) }
}

/// Writes such numbers back.
///
/// # Safety
/// The node must exist, and nobody else may use it meanwhile.
#[inline(always)]
unsafe fn put<Q: Lanes, const D: usize>(node: *mut Node<Q::Real, D>, vector: usize, numbers: Q) {
    // SAFETY: as above.
    unsafe { numbers.store(node.cast::<Q::Real>().add(vector * D)) }
}

impl<T: Real, const D: usize> Window<T, D> {
    /// Takes from the field what is sought at the `side`^D first nodes.
    ///
    /// # Safety
    /// No other thread may write to the tile's slots meanwhile.
    #[inline(always)]
    pub unsafe fn load<M: Machine<T>>(
        &mut self,
        field: &Disjoint<Node<T, D>>,
        tile: &Tile<D>,
        side: usize,
        sought: Sought<T>,
    ) {
        let rest = T::ONE - sought.change.unwrap_or(T::ZERO);
        let rests = M::Quad::splat(rest);
        each_run(tile, side, |place, first, count| {
            let nodes = field.run(first, count);
            for (k, place) in (place..place + count).enumerate() {
                let node = nodes.wrapping_add(k);
                // SAFETY: a node of the run, and the caller keeps writers away from the tile's slots.
                unsafe {
                    if D == 3 {
                        if sought.change.is_some() {
                            let change =
                                four::<M::Quad, D>(node, CARRY) - four::<M::Quad, D>(node, START) * rests;
                            change.store(self.change[place].as_mut_ptr());
                        }
                        if sought.flow {
                            four::<M::Quad, D>(node, VELOCITY).store(self.flow[place].as_mut_ptr());
                        }
                        if sought.carry {
                            four::<M::Quad, D>(node, CARRY).store(self.carry[place].as_mut_ptr());
                        }
                    } else {
                        let node = &*node;
                        for i in 0..D {
                            self.change[place][i] = node.carry[i] - node.start[i] * rest;
                            self.flow[place][i] = node.velocity[i];
                            self.carry[place][i] = node.carry[i];
                        }
                    }
                }
            }
        });
    }

    /// Adds to the field what was scattered into the `side`^D first nodes, and empties them.
    ///
    /// # Safety
    /// No other thread may touch the tile's slots meanwhile.
    #[inline(always)]
    pub unsafe fn add_to<M: Machine<T>>(
        &mut self,
        field: &Disjoint<Node<T, D>>,
        tile: &Tile<D>,
        (side, share): (usize, Share),
    ) {
        let moves = share != Share::Force;
        let pushes = matches!(share, Share::Force | Share::Everything);
        each_run(tile, side, |place, first, count| {
            let nodes = field.run(first, count);
            for (k, place) in (place..place + count).enumerate() {
                let node = nodes.wrapping_add(k);
                let (momentum, force) = (&mut self.momentum[place], &mut self.force[place]);
                // SAFETY: a node of the run, and the caller keeps other threads away from the tile's slots.
                unsafe {
                    if D == 3 {
                        // The velocity's first number comes with the force: both are read before either is written.
                        let velocity = four::<M::Quad, D>(node, VELOCITY) + M::Quad::pair_sums(momentum);
                        if pushes {
                            let force = four::<M::Quad, D>(node, FORCE) + M::Quad::pair_sums(force);
                            put(node, FORCE, force);
                        }
                        if moves {
                            put(node, VELOCITY, velocity);
                        }
                    } else {
                        let node = &mut *node;
                        node.mass += momentum[3][0] + momentum[3][1];
                        for i in 0..D {
                            node.velocity[i] += momentum[i][0] + momentum[i][1];
                            node.force[i] += force[i][0] + force[i][1];
                        }
                    }
                }
                if moves {
                    *momentum = [[T::ZERO; 2]; 4];
                }
                if pushes {
                    *force = [[T::ZERO; 2]; 4];
                }
            }
        });
    }
}

impl<T: Real, const D: usize> Disjoint<'_, Node<T, D>> {
    /// Fetches the `side`^D first nodes of a tile's window into the cache.
    #[inline(always)]
    pub fn fetch(&self, tile: &Tile<D>, side: usize) {
        each_run(tile, side, |_, first, count| {
            let (mut line, end) = (self.place(first).cast::<u8>(), self.place(first + count).cast::<u8>());
            while line < end {
                prefetch(line);
                line = line.wrapping_add(64);
            }
        });
    }
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

    /// Where entry `i` is.
    #[inline(always)]
    fn place(&self, i: usize) -> *const X {
        self.start.wrapping_add(i)
    }

    /// Where `count` entries from `first` on are.
    #[inline(always)]
    fn run(&self, first: usize, count: usize) -> *mut X {
        assert!(first + count <= self.len, "entries of the slice");
        self.start.wrapping_add(first)
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
