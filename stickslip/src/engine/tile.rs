//! A pass over the particles of a tile, several at a time.
//!
//! Particles of one cell are taken as many at a time as the processor has lanes, and where cells of the plane have too few, those of a tile: straight from memory where they lie side by side there,
//! by copies where they do not. A group with a fault is left to the reference path, which says what is wrong with whom.

use super::pass::{Pass, Verbs, Visit};
use crate::basis::Basis;
use crate::body::Body;
use crate::grid::{WINDOW, node_at};
use crate::lanes::{Laned, Lanes, MOST_LANES, Machine, Numbers, Work, in_lanes, prefetch};
use crate::material::{Material, Motion, Thickness};
use crate::particles::{Column, Columns, deformation_entries, stress_entries};
use crate::tensor::{Matrix, Real, Symmetric, Vector, array};
use crate::transfer::{Group, Load, Own, Share, Shared, Start};
use std::ops::Range;

/// A tile's particles, several at a time.
pub struct SeveralAtATime<'a, 'b, T, const D: usize, B>(pub &'a mut Visit<'b, T, D, B>);

impl<T: Laned, const D: usize, B: Basis<T>> Work for SeveralAtATime<'_, '_, T, D, B> {
    type Real = T;
    type Output = ();

    #[inline(always)]
    fn run<M: Machine<T>>(self) {
        let visit = self.0;
        // SAFETY: the caller of this work keeps others away from the tile's nodes.
        unsafe { visit.open() };
        if D == 3 {
            visit.groups::<M, M::Wide>();
        } else if visit.sparse() {
            visit.groups_across_cells::<M, M::Quad>();
        } else {
            // In the plane a cell holds four particles as a rule.
            visit.groups::<M, M::Quad>();
        }
        // SAFETY: as above.
        unsafe { visit.close() };
    }
}

impl<T: Laned, const D: usize, B: Basis<T>> Visit<'_, T, D, B> {
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
            material: self.body.material.map(V::splat),
            per_density: V::splat(T::ONE / self.body.density),
            origin: splat(&self.pass.lattice.origin),
            per_cell: V::splat(self.pass.lattice.per_cell),
            domain: self.pass.domain.map(|[min, max]| [splat(&min), splat(&max)]),
        }
    }

    /// Cell by cell: particles of one cell share their nodes.
    #[inline(always)]
    fn groups<M: Machine<T>, V: Lanes<Real = T>>(&mut self) {
        let visit = self;
        let constants = visit.constants::<V>();
        let (columns, order, cells) = (visit.columns, visit.order, visit.cells);
        let mut copies = Copies([Numbers::ZERO; MOST_COLUMNS]);
        for (cell, ends) in cells.windows(2).enumerate() {
            let (mut first, end) = (ends[0] as usize, ends[1] as usize);
            while first < end {
                let index = &order[first..end.min(first + V::COUNT)];
                if let Some(&later) = order.get(first + AHEAD) {
                    fetch(&columns, later as usize, &visit.pass.verbs);
                }
                // Indices within a cell ascend.
                let in_a_row = index[index.len() - 1] as usize - index[0] as usize == index.len() - 1;
                let members = Members::new::<V>(&columns, index, in_a_row, &visit.pass.verbs, &mut copies);
                let place = Place::new(visit.tile.block, cell);
                let base = Vector::from_fn(|i| V::splat(T::of(f64::from(place.base[i]))));
                let start = Shared::new::<D>(place.start);
                match group::<T, V, M, D, B, _>(visit, &constants, &members, (base, start)) {
                    Some(inside) => visit.left |= u64::from(!every::<V>(inside)) << cell,
                    None => {
                        for &index in index {
                            // SAFETY: the tile's particles are this call's alone.
                            unsafe { visit.one(index, cell) };
                        }
                    }
                }
                first += index.len();
            }
        }
    }

    /// In the order of cells, as many particles at a time as there are lanes.
    #[inline(always)]
    fn groups_across_cells<M: Machine<T>, V: Lanes<Real = T>>(&mut self) {
        let visit = self;
        let constants = visit.constants::<V>();
        let (columns, order, cells) = (visit.columns, visit.order, visit.cells);
        let mut copies = Copies([Numbers::ZERO; MOST_COLUMNS]);
        let (mut first, end) = (cells[0] as usize, cells[cells.len() - 1] as usize);
        let mut cell = 0;
        while first < end {
            let index = &order[first..end.min(first + V::COUNT)];
            if let Some(&later) = order.get(first + AHEAD) {
                fetch(&columns, later as usize, &visit.pass.verbs);
            }
            let mut homes = [0; MOST_LANES];
            let (mut starts, mut bases) = ([0; MOST_LANES], [[T::ZERO; MOST_LANES]; D]);
            let mut in_a_row = true;
            for lane in 0..V::COUNT {
                // Lanes beyond repeat the first.
                if lane < index.len() {
                    in_a_row &= index[lane] as usize == index[0] as usize + lane;
                    while cells[cell + 1] as usize <= first + lane {
                        cell += 1;
                    }
                    homes[lane] = cell;
                } else {
                    homes[lane] = homes[0];
                }
                let place = Place::new(visit.tile.block, homes[lane]);
                starts[lane] = place.start;
                for (bases, base) in bases.iter_mut().zip(place.base) {
                    bases[lane] = T::of(f64::from(base));
                }
            }
            let members = Members::new::<V>(&columns, index, in_a_row, &visit.pass.verbs, &mut copies);
            // SAFETY: as many numbers as any machine has lanes.
            let base = Vector::from_fn(|i| unsafe { V::load(bases[i].as_ptr()) });
            let start = Own::new::<D>(starts);
            match group::<T, V, M, D, B, _>(visit, &constants, &members, (base, start)) {
                Some(inside) => {
                    for (lane, &home) in homes.iter().enumerate().take(index.len()) {
                        visit.left |= u64::from(inside >> lane & 1 == 0) << home;
                    }
                }
                None => {
                    for (&index, &home) in index.iter().zip(&homes) {
                        // SAFETY: the tile's particles are this call's alone.
                        unsafe { visit.one(index, home) };
                    }
                }
            }
            first += index.len();
        }
    }
}

/// How many particles ahead of the present ones numbers are fetched into the cache: columns are too many for a processor to do so by itself.
const AHEAD: usize = 32;

/// Fetches what a pass needs of a particle and those beside it.
#[inline(always)]
fn fetch<T: Real, const D: usize>(columns: &Columns<T, D>, particle: usize, verbs: &Verbs) {
    for column in 0..columns_read::<D>(verbs) {
        // SAFETY: the particle exists.
        prefetch(unsafe { columns.at(column, particle) });
    }
}

/// What all particles of a tile have in common.
struct Constants<V, const D: usize> {
    material: Material<V>,
    /// 1/rho_0 [m^3/kg]
    per_density: V,
    origin: Vector<V, D>,
    per_cell: V,
    domain: Option<[Vector<V, D>; 2]>,
}

impl<V: Lanes, const D: usize> Constants<V, D> {
    #[inline(always)]
    fn in_cells(&self, position: &Vector<V, D>) -> Vector<V, D> {
        (*position - self.origin) * self.per_cell
    }
}

#[inline(always)]
fn splat<V: Lanes, const D: usize>(vector: &Vector<V::Real, D>) -> Vector<V, D> {
    Vector::from_fn(|i| V::splat(vector[i]))
}

/// A cell.
struct Place<const D: usize> {
    /// Its base node.
    base: [i32; D],
    /// That node's place in the window.
    start: usize,
}

impl<const D: usize> Place<D> {
    #[inline(always)]
    fn new(block: [i32; D], cell: usize) -> Self {
        let start = node_at([0; D], cell).iter().fold(0, |place, &n| place * WINDOW + n as usize);
        Place { base: node_at(block, cell), start }
    }
}

/// Up to as many particles as there are lanes, as columns: the body's own where they lie side by side and fill the lanes, else copies.
struct Members<'a, T, const D: usize> {
    columns: &'a Columns<T, D>,
    index: &'a [u32],
    first: *mut T,
    stride: usize,
    copied: bool,
}

/// Columns of particles that do not lie side by side or do not fill the lanes.
struct Copies<T>([Numbers<T>; MOST_COLUMNS]);

/// Columns of a particle in space.
const MOST_COLUMNS: usize = Column::<3>::COUNT;

impl<'a, T: Real, const D: usize> Members<'a, T, D> {
    #[inline(always)]
    fn new<V: Lanes<Real = T>>(
        columns: &'a Columns<T, D>,
        index: &'a [u32],
        in_a_row: bool,
        verbs: &Verbs,
        copies: &mut Copies<T>,
    ) -> Self {
        if in_a_row && index.len() == V::COUNT {
            // SAFETY: the particle exists.
            let first = unsafe { columns.at(0, index[0] as usize) };
            Members { columns, index, first, stride: columns.stride(), copied: false }
        } else {
            // SAFETY: the tile's particles are this pass' alone.
            unsafe { copies.take::<V, D>(columns, index, columns_read::<D>(verbs)) };
            Members {
                columns,
                index,
                first: copies.0.as_mut_ptr().cast(),
                stride: Copies::<T>::STRIDE,
                copied: true,
            }
        }
    }

    #[inline(always)]
    fn load<V: Lanes<Real = T>>(&self, column: usize) -> V {
        // SAFETY: the tile's particles are this pass' alone, and copies are as long as any machine's lanes.
        unsafe { V::load(self.first.add(column * self.stride)) }
    }

    #[inline(always)]
    fn store<V: Lanes<Real = T>>(&self, column: usize, numbers: V) {
        // SAFETY: as above.
        unsafe { numbers.store(self.first.add(column * self.stride)) }
    }

    /// Writes what was stored in copies of some columns to the particles.
    #[inline(always)]
    fn give_back(&self, columns: Range<usize>) {
        if self.copied {
            // SAFETY: the tile's particles are this pass' alone.
            unsafe { give_back(self.columns, self.index, columns, self.first) }
        }
    }

    #[inline(always)]
    fn vector<V: Lanes<Real = T>>(&self, column: usize) -> Vector<V, D> {
        // No closure: the compiler may leave one of this size uninlined, and then its instructions are calls.
        let mut vector = Vector::ZERO;
        for i in 0..D {
            vector[i] = self.load(column + i);
        }
        vector
    }

    #[inline(always)]
    fn store_vector<V: Lanes<Real = T>>(&self, column: usize, vector: &Vector<V, D>) {
        for i in 0..D {
            self.store(column + i, vector[i]);
        }
    }

    #[inline(always)]
    fn deformation<V: Lanes<Real = T>>(&self) -> Matrix<V> {
        let mut f = Matrix::ZERO;
        for (k, &[row, column]) in deformation_entries(D).iter().enumerate() {
            f.0[row][column] = self.load(Column::<D>::DEFORMATION + k);
        }
        f
    }

    #[inline(always)]
    fn store_deformation<V: Lanes<Real = T>>(&self, f: &Matrix<V>) {
        for (k, &[row, column]) in deformation_entries(D).iter().enumerate() {
            self.store(Column::<D>::DEFORMATION + k, f.0[row][column]);
        }
    }

    #[inline(always)]
    fn stress<V: Lanes<Real = T>>(&self) -> Symmetric<V> {
        let mut stress = Symmetric::ZERO;
        for k in 0..stress_entries(D) {
            stress.0[k] = self.load(Column::<D>::STRESS + k);
        }
        stress
    }

    #[inline(always)]
    fn store_stress<V: Lanes<Real = T>>(&self, stress: &Symmetric<V>) {
        for k in 0..stress_entries(D) {
            self.store(Column::<D>::STRESS + k, stress.0[k]);
        }
    }
}

impl<T: Real> Copies<T> {
    /// Entries from a column to the next.
    const STRIDE: usize = size_of::<Numbers<T>>() / size_of::<T>();

    /// The first so many columns, and the first particle in the lanes beyond.
    ///
    /// # Safety
    /// The particles must exist, and nobody may write to them meanwhile.
    #[inline(always)]
    unsafe fn take<V: Lanes<Real = T>, const D: usize>(
        &mut self,
        columns: &Columns<T, D>,
        index: &[u32],
        count: usize,
    ) {
        let index = in_lanes(index);
        for (column, copy) in self.0.iter_mut().enumerate().take(count) {
            // SAFETY: the caller's.
            unsafe { V::gather(columns.at(column, 0), &index).store(copy.0.as_mut_ptr()) };
        }
    }
}

/// Writes copies of some columns to the particles.
///
/// # Safety
/// The particles must exist, and nobody may use them meanwhile; `copies` are columns of [`Copies`].
#[inline(never)]
unsafe fn give_back<T: Real, const D: usize>(
    columns: &Columns<T, D>,
    index: &[u32],
    which: Range<usize>,
    copies: *const T,
) {
    for column in which {
        for (lane, &i) in index.iter().enumerate() {
            // SAFETY: the caller's.
            unsafe { *columns.at(column, i as usize) = *copies.add(column * Copies::<T>::STRIDE + lane) };
        }
    }
}

/// The columns that a pass reads, from the first on.
#[inline(always)]
fn columns_read<const D: usize>(verbs: &Verbs) -> usize {
    let deformed = verbs.strain || verbs.scatter.is_some_and(|share| share != Share::Momentum);
    if deformed || verbs.displace { Column::<D>::START } else { Column::<D>::DEFORMATION }
}

/// Takes a group through a pass and says which particles did not leave their cells; nothing is done if any has a fault.
///
/// Particles have base nodes and places of these in the window.
#[inline(always)]
fn group<T: Laned, V: Lanes<Real = T>, M: Machine<T>, const D: usize, B: Basis<T>, S: Start>(
    visit: &mut Visit<'_, T, D, B>,
    constants: &Constants<V, D>,
    members: &Members<'_, T, D>,
    (base, start): (Vector<V, D>, S),
) -> Option<u32> {
    let Pass { verbs, dt, pic, .. } = *visit.pass;
    let Verbs { accept, strain, displace, scatter } = verbs;
    let position = members.vector::<V>(Column::<D>::POSITION);
    let half = members.load::<V>(Column::<D>::HALF_WIDTH) * constants.per_cell;
    let group =
        Group::<V, D, B, S>::new(constants.in_cells(&position) - base, half, start, members.index.len());
    let mut sound = u32::MAX;

    let mut velocity = Vector::ZERO;
    if accept || displace || scatter.is_some_and(|share| share != Share::Force) {
        velocity = members.vector::<V>(Column::<D>::VELOCITY);
    }
    if accept {
        let change = group.interpolate(&visit.window.change);
        velocity = velocity * V::splat(T::ONE - pic) + change;
        sound &= finite(&velocity.0);
    }

    let mut deformation = Matrix::ZERO;
    let mut stress = Symmetric::ZERO;
    let mut jacobian = V::ZERO;
    let mut carried = Vector::ZERO;
    let pushes = matches!(scatter, Some(Share::Force | Share::Everything));
    if strain || displace || pushes {
        deformation = members.deformation::<V>();
    }
    if strain || pushes {
        stress = members.stress::<V>();
    }
    if strain {
        let scale = V::splat(dt) * constants.per_cell;
        let flow = if verbs.one_flow() { &visit.window.carry } else { &visit.window.flow };
        let (gradient, mean) = group.flow(flow);
        carried = mean;
        let increment = Matrix::IDENTITY + gradient * scale;
        deformation = increment * deformation;
        jacobian = deformation.det();
        sound &= jacobian.at_least(V::splat(T::TINY)) & finite(&[jacobian]);
        let motion = Motion { deformation, jacobian, increment, stress };
        if D == 2 && visit.body.thickness == Thickness::Free {
            let motion = free_thickness(visit.body, motion)?;
            (deformation, jacobian, stress) = (motion.deformation, motion.jacobian, motion.stress);
        } else {
            stress = constants.material.stress(&motion);
        }
        sound &= finite(&stress.0);
    } else if displace || pushes {
        jacobian = deformation.det();
    }

    let mut inside = u32::MAX;
    if displace {
        if !verbs.one_flow() {
            carried = group.interpolate(&visit.window.carry);
        }
        let moved = position + carried * V::splat(dt);
        sound &= finite(&moved.0);
        let cells = constants.in_cells(&moved);
        for i in 0..D {
            let reach = B::reach(cells[i], half);
            inside &= reach.at_least(base[i]) & !reach.at_least(base[i] + V::ONE);
            if let Some([min, max]) = &constants.domain {
                sound &= moved[i].at_least(min[i]) & max[i].at_least(moved[i]);
            }
        }
        if !every::<V>(inside) {
            let far = V::splat(T::of(f64::from(crate::grid::MOST_CELLS - 1)));
            for i in 0..D {
                let reach = B::reach(cells[i], half);
                sound &= reach.at_least(-far) & far.at_least(reach);
            }
        }
        if !every::<V>(sound) {
            return None;
        }
        members.store_vector(Column::<D>::POSITION, &moved);
        members.give_back(Column::<D>::POSITION..Column::<D>::VELOCITY);
        let modulus = constants.material.wave_modulus(visit.body.thickness, &deformation, jacobian);
        let [wave, speed] = [modulus * constants.per_density, velocity.dot(velocity)];
        if !every::<V>(no_faster(wave, speed, V::splat(visit.found.signal))) {
            let signals = (wave.sqrt() + speed.sqrt()).numbers();
            for &signal in &signals.0[..V::COUNT] {
                visit.found.signal = visit.found.signal.max(signal);
            }
        }
    }
    if !every::<V>(sound) {
        return None;
    }
    if accept {
        members.store_vector(Column::<D>::VELOCITY, &velocity);
        members.give_back(Column::<D>::VELOCITY..Column::<D>::MASS);
    }
    if strain {
        members.store_deformation(&deformation);
        members.store_stress(&stress);
        members.give_back(Column::<D>::DEFORMATION..Column::<D>::START);
    }
    if let Some(share) = scatter {
        let mut load = Load { momentum: None, stress: None };
        if share != Share::Force {
            let mass = members.load::<V>(Column::<D>::MASS);
            load.momentum = Some((velocity * mass, if share == Share::Momentum { V::ZERO } else { mass }));
        }
        if pushes {
            let volume = members.load::<V>(Column::<D>::VOLUME);
            load.stress = Some(stress * (volume * jacobian * constants.per_cell));
        }
        group.scatter::<M>(visit.window, &load);
    }
    Some(inside)
}

/// The motion with the thickness that every particle takes, one by one, and the stress after it; `None` if any has none.
#[inline(always)]
fn free_thickness<T: Real, V: Lanes<Real = T>, const D: usize>(
    body: &Body<T, D>,
    motion: Motion<V>,
) -> Option<Motion<V>> {
    let mut numbers = [Numbers([T::ZERO; MOST_LANES]); 25];
    {
        let mut next = numbers.iter_mut();
        let mut put = |x: V| next.next().map(|place| *place = x.numbers());
        for row in motion.deformation.0.iter().chain(&motion.increment.0) {
            for &x in row {
                put(x);
            }
        }
        for x in motion.stress.0 {
            put(x);
        }
        put(motion.jacobian);
    }
    one_thickness_after_another(body, &mut numbers, V::COUNT)?;
    // SAFETY: `numbers` are as long as any machine's lanes.
    let get = |k: usize| unsafe { V::load(numbers[k].0.as_ptr()) };
    let matrix = |first: usize| Matrix::from_fn(|i, j| get(first + 3 * i + j));
    let stress = Symmetric(array(V::ZERO, |k| get(18 + k)));
    Some(Motion { deformation: matrix(0), increment: matrix(9), stress, jacobian: get(24) })
}

/// F, the increment, the stress and J of every lane before and after its thickness is found.
#[inline(never)]
fn one_thickness_after_another<T: Real, const D: usize>(
    body: &Body<T, D>,
    numbers: &mut [Numbers<T>; 25],
    lanes: usize,
) -> Option<()> {
    for lane in 0..lanes {
        let get = |k: usize| numbers[k].0[lane];
        let motion = Motion {
            deformation: Matrix::from_fn(|i, j| get(3 * i + j)),
            increment: Matrix::from_fn(|i, j| get(9 + 3 * i + j)),
            stress: Symmetric(std::array::from_fn(|k| get(18 + k))),
            jacobian: get(24),
        };
        let (motion, stress) = body.respond(motion)?;
        for i in 0..3 {
            for j in 0..3 {
                numbers[3 * i + j].0[lane] = motion.deformation.0[i][j];
            }
        }
        for (k, x) in stress.0.into_iter().enumerate() {
            numbers[18 + k].0[lane] = x;
        }
        numbers[24].0[lane] = motion.jacobian;
    }
    Some(())
}

/// Whether the bits of all lanes are set.
#[inline(always)]
fn every<V: Lanes>(bits: u32) -> bool {
    let all = (1 << V::COUNT) - 1;
    bits & all == all
}

/// Lanes in which every number is finite; their sum must be, too.
#[inline(always)]
fn finite<V: Lanes>(numbers: &[V]) -> u32 {
    let mut sum = V::ZERO;
    for &x in numbers {
        sum += x;
    }
    V::splat(V::Real::LARGEST).at_least(sum.abs())
}

/// Lanes in which sqrt(a) + sqrt(b) <= most, told without a root:  2 sqrt(a b) <= most^2 - a - b.
#[inline(always)]
fn no_faster<V: Lanes>(a: V, b: V, most: V) -> u32 {
    let rest = most * most - a - b;
    let product = a * b;
    rest.at_least(V::ZERO) & (rest * rest).at_least((product + product) + (product + product))
}
