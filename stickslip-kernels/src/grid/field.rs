//! What the nodes carry: all bodies' blocks in one slab, and the window through which a tile sees its part of it.

use super::{ActiveBlocks, Nodes, SIDE, Tile, every_node, layer, next_of, node_at, nodes_per_block};
use crate::basis::MAX_WIDTH;
use crate::lanes::{Any, Lanes, MOST_LANES, Machine, prefetch};
use crate::pages::ask_for_large;
use crate::tensor::{Real, Vector};
use crate::threads::{each, each_range};
use std::marker::PhantomData;
use std::ops::Range;

/// One body's share of one grid node. What particles give comes first, so that [`Window::add_to`] adds it at once.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Node<T, const D: usize> {
    /// Mass [kg].
    pub mass: T,
    /// Velocity now [m/s]; momentum [kg m/s] while particles are being scattered.
    pub velocity: Vector<T, D>,
    /// Force of the body's own stress [N].
    pub force: Vector<T, D>,
    /// Velocity as interpolated from the particles, before contact and forces [m/s].
    pub start: Vector<T, D>,
    /// Velocity as integrated with all forces and contact, whose change from `start` the particles take [m/s]. If the
    /// stress is updated first, the one that strains waits here while forces act on `velocity`.
    pub integrated: Vector<T, D>,
}

impl<T: Real, const D: usize> Node<T, D> {
    /// A node that nothing reaches.
    pub const EMPTY: Self = Node {
        mass: T::ZERO,
        velocity: Vector::ZERO,
        force: Vector::ZERO,
        start: Vector::ZERO,
        integrated: Vector::ZERO,
    };

    /// v = p / m, which is what the step begins with.
    #[inline]
    pub fn begin(&mut self) {
        self.divide_by_mass();
        self.start = self.velocity;
    }

    /// v = p / m
    #[inline]
    pub fn divide_by_mass(&mut self) {
        self.velocity = self.velocity / self.mass;
    }

    /// v += dt (f / m + g)
    #[inline]
    pub fn accelerate(&mut self, gravity: Vector<T, D>, dt: T) {
        self.velocity += (self.force / self.mass + gravity) * dt;
    }

    /// Takes a prescribed velocity [m/s].
    pub fn prescribe(&mut self, velocity: [f64; 3]) {
        self.velocity = Vector::of(velocity);
    }

    /// Sets the mass aside, for something else to be summed in its place.
    #[inline]
    pub fn lend_mass(&mut self, mass: &mut T) {
        *mass = std::mem::replace(&mut self.mass, T::ZERO);
    }

    /// Takes the mass back, and leaves the sum over the mass.
    #[inline]
    pub fn take_mass_back(&mut self, mass: &mut T) {
        let sum = std::mem::replace(&mut self.mass, *mass);
        *mass = sum / self.mass;
    }

    /// Keeps the velocity in `integrated`.
    #[inline]
    pub fn keep(&mut self) {
        self.integrated = self.velocity;
    }

    /// Keeps the velocity in `integrated`, and makes room for momentum.
    #[inline]
    pub fn keep_and_clear(&mut self) {
        self.keep();
        self.velocity = Vector::ZERO;
    }

    /// Takes the velocity that was kept, and keeps the one of now in `integrated`.
    #[inline]
    pub fn exchange(&mut self) {
        std::mem::swap(&mut self.integrated, &mut self.velocity);
    }

    /// Where a node's first eight numbers are in [`NodeSums`]: mass, velocity and force, and then zeros: in the plane
    /// the third axis has nothing to give.
    const GIVEN: [usize; MOST_LANES] =
        if D == 2 { [6, 0, 2, 1, 3, 4, 5, 7] } else { [6, 0, 2, 4, 1, 3, 5, 7] };

    /// Takes what particles gave.
    ///
    /// # Safety
    /// The node must be there, and nobody else may use it meanwhile.
    #[inline(always)]
    unsafe fn take<M: Machine<T>>(node: *mut Self, sums: &NodeSums<T>) {
        const { assert!(size_of::<Self>() == (1 + 4 * D) * size_of::<T>()) };
        let first = node.cast::<T>();
        // SAFETY: the sums are eight numbers, and a node has nine or more.
        unsafe {
            let sums = M::Wide::load(sums.as_ptr().cast());
            (M::Wide::load(first) + sums.permuted(Self::GIVEN)).store(first);
        }
    }
}

/// Blocks that a thread takes at a time.
const BLOCKS: usize = 64;

/// All bodies' blocks, in the order of [`ActiveBlocks::slots`].
#[derive(Clone, Debug, Default)]
pub struct Field<T, const D: usize> {
    /// Nodes, block by block.
    pub nodes: Vec<Node<T, D>>,
    /// Of each block, the nodes with mass, once [`Field::find_present`] has found them.
    pub present: Vec<Nodes>,
    /// Velocities of the nodes' start as the transfer wants them, if it filters them: v(m) of
    /// [`crate::transfer::Xpic`] [m/s].
    pub filtered: Vec<Vector<T, D>>,
    /// Means over the particles around each node, if any body's material wants them: of the dilatation rate [1/s], or
    /// of the pressure over the density [J/kg].
    pub means: Vec<T>,
}

impl<T: Real, const D: usize> Field<T, D> {
    /// Empties the field and gives it the active blocks.
    pub fn clear(&mut self, active: &ActiveBlocks<D>) {
        let count = active.slots.len() * nodes_per_block(D);
        if count > self.nodes.capacity() {
            // Nothing in it is of use any more, and a slab of its own gets pages of its own.
            self.nodes = Vec::with_capacity(count + count / 4);
            ask_for_large(self.nodes.as_ptr(), self.nodes.capacity());
        }
        self.nodes.truncate(count);
        each(&mut self.nodes, 4096, |_, node| *node = Node::EMPTY);
        self.nodes.resize(count, Node::EMPTY);
    }

    /// Finds the nodes that have mass and does something to each of them.
    pub fn find_present(&mut self, f: impl Fn(&mut Node<T, D>) + Sync) {
        let n = nodes_per_block(D);
        self.present.resize(self.nodes.len() / n, 0);
        let nodes = Disjoint::new(&mut self.nodes);
        each(&mut self.present, BLOCKS, |block, present| {
            // SAFETY: every block has nodes of its own.
            let nodes = unsafe { nodes.part(block * n, n) };
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
        self.each_index(|_, node| f(node));
    }

    /// Does something to each node that has mass and to its entry of a list, which gets one for every node.
    pub fn each_with<X: Clone + Send>(
        &mut self,
        (entries, empty): (&mut Vec<X>, X),
        f: impl Fn(&mut Node<T, D>, &mut X) + Sync,
    ) {
        entries.resize(self.nodes.len(), empty);
        let entries = Disjoint::new(entries);
        // SAFETY: every node has an entry of its own.
        self.each_index(|index, node| f(node, unsafe { entries.get(index) }));
    }

    /// Does something to each node that has mass and to its filtered velocity.
    pub fn each_filtered(&mut self, f: impl Fn(&mut Node<T, D>, &mut Vector<T, D>) + Sync) {
        let mut filtered = std::mem::take(&mut self.filtered);
        self.each_with((&mut filtered, Vector::ZERO), f);
        self.filtered = filtered;
    }

    /// Does something to each node that has mass and to its mean.
    pub fn each_mean(&mut self, f: impl Fn(&mut Node<T, D>, &mut T) + Sync) {
        let mut means = std::mem::take(&mut self.means);
        self.each_with((&mut means, T::ZERO), f);
        self.means = means;
    }

    /// Does something to each node that has mass; `f` is told its index, and each index once.
    fn each_index(&mut self, f: impl Fn(usize, &mut Node<T, D>) + Sync) {
        let n = nodes_per_block(D);
        let (nodes, present) = (Disjoint::new(&mut self.nodes), &self.present);
        each_range(present.len(), BLOCKS, &|blocks| {
            for block in blocks {
                // SAFETY: every block has nodes of its own.
                let nodes = unsafe { nodes.part(block * n, n) };
                let mut places = present[block];
                while let Some(local) = next_of(&mut places) {
                    f(block * n + local, &mut nodes[local]);
                }
            }
        });
    }
}

/// Nodes along a side of a tile's window: what its particles reach, so many nodes each.
pub const fn window_side(width: usize) -> usize {
    SIDE as usize + width - 1
}

/// Nodes of the largest window in space; the first side^D of them are used.
pub const WINDOW_NODES: usize = window_side(MAX_WIDTH).pow(3);

/// What a gather takes from the nodes, see [`Window::load`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sought {
    /// The change of the velocities in the step, which FLIP takes.
    pub change: bool,
    /// The integrated velocities themselves, of which PIC takes a share.
    pub integrated: bool,
    /// With the filtered velocities of the start in them, for those of the start.
    pub filtered: bool,
    /// The velocities that move and strain particles.
    pub flow: bool,
}

/// What a node is given: momentum [kg m/s] and force [N] along each axis, mass [kg] and nothing in the last place.
pub type NodeSums<T> = [[T; 2]; 4];

/// What a node tells: a velocity, and nothing in the places beyond.
pub type NodeValues<T> = [T; NODE_VALUES];

/// Numbers of that.
pub const NODE_VALUES: usize = 4;

/// A tile's part of the field in one place: nodes from `block * 4` on, [`window_side`] of them along each axis, the last
/// fastest.
#[derive(Clone, Debug)]
pub struct Window<T, const D: usize> {
    /// Change of the velocities in the step [m/s].
    pub change: [NodeValues<T>; WINDOW_NODES],
    /// The integrated velocities [m/s].
    pub integrated: [NodeValues<T>; WINDOW_NODES],
    /// The velocities that move and strain particles [m/s], and in the last place [`Field::means`].
    pub flow: [NodeValues<T>; WINDOW_NODES],
    /// What was scattered so far.
    pub sums: [NodeSums<T>; WINDOW_NODES],
}

impl<T: Real, const D: usize> Default for Window<T, D> {
    fn default() -> Self {
        Window {
            change: [[T::ZERO; 4]; WINDOW_NODES],
            integrated: [[T::ZERO; 4]; WINDOW_NODES],
            flow: [[T::ZERO; 4]; WINDOW_NODES],
            sums: [[[T::ZERO; 2]; 4]; WINDOW_NODES],
        }
    }
}

/// Nodes that lie side by side in the window and in the field.
struct NodeRun {
    /// The first one's place in the window.
    place: usize,
    /// Its place in the field.
    node: usize,
    /// How many.
    count: usize,
}

/// The nodes of a tile's window with this side. An iterator, for loops over it are compiled where they stand.
struct NodeRuns<'a, const D: usize> {
    /// Slots of the blocks at the window, as [`Tile::slots`].
    slots: &'a [u32; 8],
    side: usize,
    /// Along the first two axes, and which half of the row.
    next: [usize; 3],
}

impl<'a, const D: usize> NodeRuns<'a, D> {
    #[inline(always)]
    fn new(slots: &'a [u32; 8], side: usize) -> Self {
        NodeRuns { slots, side, next: [0; 3] }
    }
}

impl<const D: usize> Iterator for NodeRuns<'_, D> {
    type Item = NodeRun;

    #[inline(always)]
    fn next(&mut self) -> Option<NodeRun> {
        const S: usize = SIDE as usize;
        let [x, y, half] = self.next;
        if x == self.side {
            return None;
        }
        let rows = if D == 2 { 1 } else { self.side };
        self.next = match (half, y + 1 == rows) {
            (0, _) => [x, y, 1],
            (_, false) => [x, y + 1, 0],
            _ => [x + 1, 0, 0],
        };
        let (place, corner, local) = match D {
            2 => (x * self.side, x / S * 2, x % S * S),
            _ => ((x * self.side + y) * self.side, x / S * 4 + y / S * 2, (x % S * S + y % S) * S),
        };
        Some(NodeRun {
            place: place + half * S,
            node: self.slots[corner + half] as usize * nodes_per_block(D) + local,
            count: if half == 0 { S } else { self.side - S },
        })
    }
}

/// A vector in the first places of four lanes.
#[inline(always)]
fn load_vector<V: Lanes, const D: usize>(vector: &Vector<V::Real, D>) -> V {
    // SAFETY: it has `D` components.
    unsafe { V::load_first(vector.0.as_ptr(), D) }
}

#[inline(always)]
fn store_vector<V: Lanes>(place: &mut NodeValues<V::Real>, vector: V) {
    const { assert!(V::COUNT == 4) };
    // SAFETY: there is room for four numbers.
    unsafe { vector.store(place.as_mut_ptr()) }
}

impl<T: Real, const D: usize> Window<T, D> {
    /// Empties what particles scatter into, of a window with this side.
    #[inline(always)]
    pub fn clear(&mut self, side: usize) {
        self.sums[..side.pow(D as u32)].fill([[T::ZERO; 2]; 4]);
    }

    /// Takes from the field what is sought at the nodes of a window with this side.
    ///
    /// # Safety
    /// No other thread may write to the tile's slots meanwhile.
    #[inline(always)]
    pub unsafe fn load<M: Machine<T>>(
        &mut self,
        (field, filtered, means): (&Disjoint<Node<T, D>>, &[Vector<T, D>], &[T]),
        tile: &Tile<D>,
        side: usize,
        sought: Sought,
    ) {
        for NodeRun { place, node, count } in NodeRuns::<D>::new(&tile.slots, side) {
            for k in 0..count {
                let (start, mean) = (filtered.get(node + k), means.get(node + k));
                // SAFETY: the caller keeps writers away from the tile's slots.
                let node = unsafe { field.read(node + k) };
                let place = place + k;
                if sought.change {
                    let integrated: M::Quad = load_vector(&node.integrated);
                    let start: M::Quad = load_vector(&node.start);
                    store_vector(&mut self.change[place], integrated - start);
                }
                if sought.integrated {
                    let mut integrated: M::Quad = load_vector(&node.integrated);
                    if let (true, Some(start)) = (sought.filtered, start) {
                        integrated += load_vector::<M::Quad, D>(start) - load_vector(&node.start);
                    }
                    store_vector::<M::Quad>(&mut self.integrated[place], integrated);
                }
                if sought.flow {
                    store_vector::<M::Quad>(&mut self.flow[place], load_vector(&node.velocity));
                }
                if let Some(&mean) = mean {
                    self.flow[place][NODE_VALUES - 1] = mean;
                }
            }
        }
    }

    /// Adds to the field what was scattered into a window with this side.
    ///
    /// # Safety
    /// No other thread may touch the tile's slots meanwhile.
    #[inline(always)]
    pub unsafe fn add_to<M: Machine<T>>(&self, field: &Disjoint<Node<T, D>>, tile: &Tile<D>, side: usize) {
        for NodeRun { place, node, count } in NodeRuns::<D>::new(&tile.slots, side) {
            for k in 0..count {
                // SAFETY: the caller keeps other threads away from the tile's slots.
                unsafe { Node::take::<M>(field.get(node + k), &self.sums[place + k]) };
            }
        }
    }
}

/// Nodes of a tile's window with this side that are at one of its blocks, and in the first layers that particles reach
/// from the block before along the axes of the cut, see [`super::Border`].
pub fn nodes_at<const D: usize>(corner: usize, cut: u8, side: usize) -> impl Iterator<Item = usize> {
    let along = |axis: usize| layers::<D>((corner, cut), side, axis);
    let (rows, last) = (along(0), along(D - 1));
    let middle = if D == 3 { along(1) } else { 0..1 };
    rows.flat_map(move |row| {
        let (middle, last) = (middle.clone(), last.clone());
        middle.flat_map(move |place| {
            let start = if D == 3 { (row * side + place) * side } else { row * side };
            last.clone().map(move |node| start + node)
        })
    })
}

/// How many [`nodes_at`] gives.
pub fn count_at<const D: usize>(corner: usize, cut: u8, side: usize) -> usize {
    (0..D).map(|axis| layers::<D>((corner, cut), side, axis).len()).product()
}

/// Their layers along an axis.
fn layers<const D: usize>((corner, cut): (usize, u8), side: usize, axis: usize) -> Range<usize> {
    let bit = D - 1 - axis;
    match (corner >> bit & 1, cut >> bit & 1) {
        (1, _) => SIDE as usize..side,
        (_, 1) => 0..side - SIDE as usize,
        _ => 0..SIDE as usize,
    }
}

/// Whether a node of a block is in its first layers along the axes of a cut, where windows have this side.
pub fn is_within<const D: usize>(local: usize, cut: u8, side: usize) -> bool {
    let place: [i32; D] = node_at([0; D], local);
    (0..D).all(|axis| cut >> (D - 1 - axis) & 1 == 0 || place[axis] < side as i32 - SIDE)
}

/// Cells of a tile, a bit each, whose particles reach such nodes.
pub fn cells_at<const D: usize>(corner: usize, cut: u8, side: usize) -> u64 {
    let reach = side as i32 - SIDE;
    let is_one = |cell: &usize| {
        let place: [i32; D] = node_at([0; D], *cell);
        (0..D).all(|axis| {
            let bit = D - 1 - axis;
            match (corner >> bit & 1, cut >> bit & 1) {
                (1, _) => place[axis] + reach >= SIDE,
                (_, 1) => place[axis] < reach,
                _ => true,
            }
        })
    };
    (0..nodes_per_block(D)).filter(is_one).fold(0, |cells, cell| cells | 1 << cell)
}

/// Adds to a node of a slot what a tile gave it: a place of its window with this side, at this one of its blocks.
///
/// # Safety
/// No other thread may touch the slot meanwhile.
pub unsafe fn add_at<T: Real, const D: usize>(
    sums: &NodeSums<T>,
    field: &Disjoint<Node<T, D>>,
    (slot, corner): (u32, u8),
    (place, side): (usize, usize),
) {
    let along = |axis: usize| place / side.pow((D - 1 - axis) as u32) % side;
    let local = (0..D).fold(0, |local, axis| {
        let bit = usize::from(corner) >> (D - 1 - axis) & 1;
        local * SIDE as usize + along(axis) - bit * SIDE as usize
    });
    // SAFETY: the caller keeps other threads away from the slot.
    unsafe { Node::take::<Any>(field.get(slot as usize * nodes_per_block(D) + local), sums) };
}

/// Cells of a tile, a bit each, whose particles reach some nodes of one of its blocks, a bit each: of those, the first
/// layers along the axes of the cut.
pub fn cells_reaching<const D: usize>(nodes: Nodes, (corner, cut): (usize, u8), side: usize) -> u64 {
    let width = side as i32 - SIDE + 1;
    let bit = |bits: usize, axis: usize| bits >> (D - 1 - axis) & 1 == 1;
    // Of each axis and place of a node along it, the cells from which particles reach that far.
    let along: [[u64; SIDE as usize]; D] = std::array::from_fn(|axis| {
        std::array::from_fn(|place| {
            let place = place as i32;
            let is_there = bit(corner, axis) || !bit(usize::from(cut), axis) || place < width - 1;
            let last = place + if bit(corner, axis) { SIDE } else { 0 };
            let cells = (last - width + 1).max(0)..(last + 1).min(SIDE);
            cells.filter(|_| is_there).fold(0, |all, n| all | layer::<D>(axis, n))
        })
    });
    let (mut nodes, mut cells) = (nodes, 0);
    while let Some(local) = next_of(&mut nodes) {
        let place: [i32; D] = node_at([0; D], local);
        cells |= (0..D).fold(u64::MAX, |all, axis| all & along[axis][place[axis] as usize]);
    }
    cells & every_node(D)
}

/// Adds to a slot what a tile gave it: the part of its sums, of a window with this side, that is this one of its
/// blocks.
///
/// # Safety
/// No other thread may touch the slot meanwhile.
pub unsafe fn add_corner<T: Real, const D: usize>(
    sums: &[NodeSums<T>],
    field: &Disjoint<Node<T, D>>,
    (slot, corner): (u32, u8),
    side: usize,
) {
    const S: usize = SIDE as usize;
    let along = |axis: usize| layers::<D>((usize::from(corner), 0), side, axis);
    let (rows, row) = (if D == 2 { 0..1 } else { along(1) }, along(D - 1));
    for x in along(0) {
        for y in rows.clone() {
            let (place, local) = match D {
                2 => (x * side, x % S * S),
                _ => ((x * side + y) * side, (x % S * S + y % S) * S),
            };
            let first = slot as usize * nodes_per_block(D) + local;
            let nodes = (first..).zip(&sums[place + row.start..place + row.end]);
            for (node, sums) in nodes {
                // SAFETY: the caller keeps other threads away from the slot.
                unsafe { Node::take::<Any>(field.get(node), sums) };
            }
        }
    }
}

impl<T: Real, const D: usize> Disjoint<'_, Node<T, D>> {
    /// Fetches the nodes of a tile's window with this side into the cache.
    #[inline(always)]
    pub fn fetch(&self, tile: &Tile<D>, side: usize) {
        for NodeRun { node, count, .. } in NodeRuns::<D>::new(&tile.slots, side) {
            let (mut line, end) = (self.place(node).cast::<u8>(), self.place(node + count).cast::<u8>());
            while line < end {
                prefetch(line);
                line = line.wrapping_add(64);
            }
        }
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

    /// Entry `i`, to be read only.
    ///
    /// # Safety
    /// Nobody may write to entry `i` while the reference is alive.
    #[inline(always)]
    pub unsafe fn read(&self, i: usize) -> &X {
        assert!(i < self.len, "an index of the slice");
        // SAFETY: in bounds, and the caller keeps writers away.
        unsafe { &*self.start.add(i) }
    }

    /// So many entries from `first` on.
    ///
    /// # Safety
    /// No other reference to any of them may be alive.
    #[allow(clippy::mut_from_ref)]
    #[inline(always)]
    pub unsafe fn part(&self, first: usize, count: usize) -> &mut [X] {
        assert!(first <= self.len && count <= self.len - first, "a part of the slice");
        // SAFETY: in bounds, and the caller holds the only reference.
        unsafe { std::slice::from_raw_parts_mut(self.start.add(first), count) }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The nodes of a block that one rank sends windows of are those of which it tells what else acts there.
    fn cuts_agree<const D: usize>() {
        for side in SIDE as usize + 1..2 * SIDE as usize {
            for (corner, cut) in (0..1 << D).flat_map(|corner| (0..1 << D).map(move |cut| (corner, cut))) {
                let local = |node: usize| -> Option<usize> {
                    let place = |axis: usize| (node / side.pow((D - 1 - axis) as u32) % side) as i32;
                    let at = |axis: usize| place(axis) - SIDE * (corner >> (D - 1 - axis) & 1) as i32;
                    let inside = (0..D).all(|axis| (0..SIDE).contains(&at(axis)));
                    inside.then(|| (0..D).fold(0, |local, axis| SIDE as usize * local + at(axis) as usize))
                };
                let wanted =
                    |node: &usize| local(*node).is_some_and(|local| is_within::<D>(local, cut, side));
                let wanted: Vec<usize> = (0..side.pow(D as u32)).filter(wanted).collect();
                let sent: Vec<usize> = nodes_at::<D>(corner, cut, side).collect();
                assert_eq!(sent, wanted, "corner {corner}, cut {cut}, side {side}");
            }
        }
    }

    #[test]
    fn nodes_that_are_sent_are_within_the_cut() {
        cuts_agree::<2>();
        cuts_agree::<3>();
    }
}
