//! A pass over the particles of a tile, several at a time.
//!
//! Particles of one cell are taken as many at a time as the processor has lanes, and where cells of the plane have too
//! few, those of a tile: straight from memory where they lie side by side there and fill the lanes, else by copies. A
//! group with a fault is taken again, one particle at a time, to find out what is wrong with whom.

use super::group::{Constants, every, group, splat};
use super::members::{AHEAD, Copies, Members, fetch};
use super::{FaultKind, ParticleLoop, Visit};
use crate::basis::{Basis, takes_most_time};
use crate::grid::{node_at, window_side};
use crate::lanes::{Any, Laned, Lanes, MOST_LANES, Machine, Pack, Work};
use crate::matter::Gyration;
use crate::particles::follow_one_another;
use crate::tensor::Vector;
use crate::transfer::{CellGroup, Own, Start};
use std::marker::PhantomData;

/// A tile's particles, several at a time.
pub struct SeveralAtATime<'a, 'b, T, const D: usize, B> {
    visit: &'a mut Visit<'b, T, D>,
    basis: PhantomData<B>,
}

/// Takes the tile's particles through the pass, by shape functions `B`.
///
/// # Safety
/// Nobody else may use the tile's nodes and particles meanwhile.
pub unsafe fn visit<T: Laned, const D: usize, B: Basis<T>>(path: ParticleLoop, visit: &mut Visit<'_, T, D>) {
    match path {
        ParticleLoop::Lanes(processor) => {
            T::run(processor, SeveralAtATime { visit, basis: PhantomData::<B> })
        }
        // SAFETY: the caller's.
        ParticleLoop::OneLane => unsafe { visit.take_one_by_one::<B>() },
    }
}

impl<T: Laned, const D: usize, B: Basis<T>> Work for SeveralAtATime<'_, '_, T, D, B> {
    type Real = T;
    type Output = ();
    const BY_AVX512: bool = D == 3 && takes_most_time::<T, B>();

    #[inline(always)]
    fn run<M: Machine<T>>(self) {
        let (visit, side) = (self.visit, window_side(B::WIDTH));
        // SAFETY: the caller of this work keeps others away from the tile's nodes.
        unsafe { visit.open::<M>(side) };
        // Constant blocks, so that only what the dimension and the basis take is compiled.
        if const { D == 3 } {
            visit.groups::<M, M::Wide, B>();
        } else if const { takes_most_time::<T, B>() } && visit.sparse() {
            visit.groups_across_cells::<M, M::Quad, B>();
        } else {
            // In the plane a cell holds four particles as a rule.
            visit.groups::<M, M::Quad, B>();
        }
        // SAFETY: as above.
        unsafe { visit.close::<M>(side) };
    }

    /// One particle at a time on x86-64: without AVX2 several bring little, and would double what is compiled.
    #[cfg(all(target_arch = "x86_64", not(portable_lanes)))]
    fn run_anywhere(self) {
        // SAFETY: the caller of this work keeps others away from the tile's nodes and particles.
        unsafe { self.visit.take_one_by_one::<B>() };
    }
}

impl<T: Laned, const D: usize> Visit<'_, T, D> {
    /// Takes the tile's particles one by one through the pass.
    ///
    /// # Safety
    /// Nobody else may use the tile's nodes and particles meanwhile.
    pub unsafe fn take_one_by_one<B: Basis<T>>(&mut self) {
        let side = window_side(B::WIDTH);
        // SAFETY: the caller's.
        unsafe { self.open::<Any>(side) };
        let (order, cells) = (self.order, self.cells);
        for (cell, ends) in cells.windows(2).enumerate() {
            order[ends[0] as usize..ends[1] as usize].iter().for_each(|&index| self.one::<B>(index, cell));
        }
        // SAFETY: the caller's.
        unsafe { self.close::<Any>(side) };
    }

    /// Takes one particle whose home is a cell, in a group of one lane, and finds out what is wrong with it.
    #[inline(never)]
    fn one<B: Basis<T>>(&mut self, index: u32, cell: usize) {
        let side = window_side(B::WIDTH);
        let (columns, indices) = (self.columns, [index]);
        let place = CellStart::new((self.tile.block, cell), side);
        let base = Vector::from_fn(|i| Pack([T::of(f64::from(place.base[i]))]));
        let start = CellGroup::new::<D>(place.start, side);
        let members = Members::in_a_row(&columns, &indices);
        let constants = self.constants::<Pack<T, 1>>();
        match group::<T, Pack<T, 1>, Any, D, B, _>(self, &constants, &members, (base, start)) {
            Ok(inside) => {
                self.left |= u64::from(inside & 1 == 0) << cell;
                self.moved += outside(inside, 1);
            }
            Err(kind) => self.find_fault(index, kind),
        }
    }

    /// Whether cells have too few particles to fill the lanes.
    #[inline(always)]
    fn sparse(&self) -> bool {
        let particles = self.cells[self.cells.len() - 1] - self.cells[0];
        let occupied = self.cells.windows(2).filter(|ends| ends[0] < ends[1]).count();
        (particles as usize) < 2 * occupied
    }

    #[inline(always)]
    fn constants<V: Lanes<Real = T>>(&self) -> Constants<V, D> {
        Constants {
            material: self.matter.material.map(V::splat),
            per_density: V::splat(T::ONE / self.matter.density),
            expansion: V::splat(self.matter.expansion),
            origin: splat(&self.pass.lattice.origin),
            cell: V::splat(self.pass.lattice.cell),
            per_cell: V::splat(self.pass.lattice.per_cell),
            gyration: Gyration {
                cell: V::splat(self.matter.gyration.cell),
                share: V::splat(self.matter.gyration.share),
            },
            domain: self.pass.domain.map(|[min, max]| [splat(&min), splat(&max)]),
        }
    }

    /// Cell by cell: particles of one cell share their nodes.
    #[inline(always)]
    fn groups<M: Machine<T>, V: Lanes<Real = T>, B: Basis<T>>(&mut self) {
        let (visit, side) = (self, window_side(B::WIDTH));
        let constants = visit.constants::<V>();
        let (columns, order, cells) = (visit.columns, visit.order, visit.cells);
        let mut copies = Copies::EMPTY;
        for (cell, ends) in cells.windows(2).enumerate() {
            let (mut first, end) = (ends[0] as usize, ends[1] as usize);
            while first < end {
                let index = &order[first..end.min(first + V::COUNT)];
                let later =
                    &order[(first + AHEAD).min(order.len())..order.len().min(first + AHEAD + V::COUNT)];
                if let [one, .., other] = *later {
                    fetch(&columns, one as usize, &visit.pass.verbs);
                    if other.abs_diff(one) >= V::COUNT as u32 {
                        fetch(&columns, other as usize, &visit.pass.verbs);
                    }
                }
                let in_a_row = follow_one_another(index);
                let place = CellStart::new((visit.tile.block, cell), side);
                let base = Vector::from_fn(|i| V::splat(T::of(f64::from(place.base[i]))));
                let start = CellGroup::new::<D>(place.start, side);
                match visit.group::<M, V, B, _>(&constants, (index, in_a_row), (base, start), &mut copies) {
                    Ok(inside) => {
                        visit.left |= u64::from(!every::<V>(inside)) << cell;
                        visit.moved += outside(inside, index.len());
                    }
                    Err(_) => index.iter().for_each(|&index| visit.one::<B>(index, cell)),
                }
                first += index.len();
            }
        }
    }

    /// One group, its particles side by side in memory or not.
    #[inline(always)]
    fn group<M: Machine<T>, V: Lanes<Real = T>, B: Basis<T>, S: Start>(
        &mut self,
        constants: &Constants<V, D>,
        (index, in_a_row): (&[u32], bool),
        place: (Vector<V, D>, S),
        copies: &mut Copies<T>,
    ) -> Result<u32, FaultKind> {
        let (columns, verbs) = (self.columns, self.pass.verbs);
        let members = match in_a_row && index.len() == V::COUNT {
            true => Members::in_a_row(&columns, index),
            false => Members::copied::<V>(&columns, index, &verbs, copies),
        };
        group::<T, V, M, D, B, S>(self, constants, &members, place)
    }

    /// In the order of cells, as many particles at a time as there are lanes.
    #[inline(always)]
    fn groups_across_cells<M: Machine<T>, V: Lanes<Real = T>, B: Basis<T>>(&mut self) {
        let (visit, side) = (self, window_side(B::WIDTH));
        let constants = visit.constants::<V>();
        let (columns, order, cells) = (visit.columns, visit.order, visit.cells);
        let mut copies = Copies::EMPTY;
        let (mut first, end) = (cells[0] as usize, cells[cells.len() - 1] as usize);
        let mut cell = 0;
        while first < end {
            let index = &order[first..end.min(first + V::COUNT)];
            if let Some(&later) = order.get(first + AHEAD) {
                fetch(&columns, later as usize, &visit.pass.verbs);
            }
            let mut homes = [0; MOST_LANES];
            let (mut starts, mut bases) = ([0; MOST_LANES], [[T::ZERO; MOST_LANES]; D]);
            for lane in 0..V::COUNT {
                // Lanes beyond repeat the first.
                if lane < index.len() {
                    while cells[cell + 1] as usize <= first + lane {
                        cell += 1;
                    }
                    homes[lane] = cell;
                } else {
                    homes[lane] = homes[0];
                }
                let place = CellStart::new((visit.tile.block, homes[lane]), side);
                starts[lane] = place.start;
                for (bases, base) in bases.iter_mut().zip(place.base) {
                    bases[lane] = T::of(f64::from(base));
                }
            }
            // SAFETY: as many numbers as any machine has lanes.
            let base = Vector::from_fn(|i| unsafe { V::load(bases[i].as_ptr()) });
            let start = Own::new::<D>(starts, side);
            let in_a_row = follow_one_another(index);
            match visit.group::<M, V, B, _>(&constants, (index, in_a_row), (base, start), &mut copies) {
                Ok(inside) => {
                    visit.moved += outside(inside, index.len());
                    for (lane, &home) in homes.iter().enumerate().take(index.len()) {
                        visit.left |= u64::from(inside >> lane & 1 == 0) << home;
                    }
                }
                Err(_) => index.iter().zip(&homes).for_each(|(&index, &home)| visit.one::<B>(index, home)),
            }
            first += index.len();
        }
    }
}

/// How many of the first lanes have no bit set.
#[inline(always)]
fn outside(inside: u32, lanes: usize) -> u32 {
    (!inside & ((1 << lanes) - 1)).count_ones()
}

/// A cell.
struct CellStart<const D: usize> {
    /// Its base node.
    base: [i32; D],
    /// That node's place in the window.
    start: usize,
}

impl<const D: usize> CellStart<D> {
    #[inline(always)]
    fn new((block, cell): ([i32; D], usize), window: usize) -> Self {
        let start = node_at([0; D], cell).iter().fold(0, |place, &n| place * window + n as usize);
        CellStart { base: node_at(block, cell), start }
    }
}
