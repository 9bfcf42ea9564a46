//! A pass over the particles of a tile, several at a time.
//!
//! Particles of one cell are taken as many at a time as the processor has lanes: straight from memory where they lie side by side there,
//! one by one where they do not. A group with a fault is left to the reference path, which says what is wrong with whom.

use super::pass::{Pass, Verbs, Visit};
use crate::basis::Basis;
use crate::body::Body;
use crate::grid::{WINDOW, node_at};
use crate::lanes::{Laned, Lanes, MOST_LANES, Machine, Numbers, Work, prefetch};
use crate::material::{Material, Motion, Thickness};
use crate::particles::{Column, Columns, deformation_entries, stress_entries};
use crate::tensor::{Matrix, Real, Symmetric, Vector, array};
use crate::transfer::{Group, Load, Share};

/// A tile's particles, several at a time.
pub struct SeveralAtATime<'a, 'b, T, const D: usize, B>(pub &'a mut Visit<'b, T, D, B>);

impl<T: Laned, const D: usize, B: Basis<T>> Work for SeveralAtATime<'_, '_, T, D, B> {
    type Real = T;
    type Output = ();

    #[inline(always)]
    fn run<M: Machine<T>>(self) {
        // In the plane a cell holds four particles as a rule.
        if D == 2 { self.groups::<M, M::Quad>() } else { self.groups::<M, M::Wide>() }
    }
}

impl<T: Laned, const D: usize, B: Basis<T>> SeveralAtATime<'_, '_, T, D, B> {
    #[inline(always)]
    fn groups<M: Machine<T>, V: Lanes<Real = T>>(self) {
        let visit = self.0;
        let constants = Constants {
            material: visit.body.material.map(V::splat),
            per_density: V::splat(T::ONE / visit.body.density),
            origin: splat(&visit.pass.lattice.origin),
            per_cell: V::splat(visit.pass.lattice.per_cell),
            domain: visit.pass.domain.map(|[min, max]| [splat(&min), splat(&max)]),
        };
        let (columns, order, cells) = (visit.columns, visit.order, visit.cells);
        for (cell, ends) in cells.windows(2).enumerate() {
            let (mut first, end) = (ends[0] as usize, ends[1] as usize);
            while first < end {
                let count = (end - first).min(V::COUNT);
                if let Some(&later) = order.get(first + AHEAD) {
                    fetch(&columns, later as usize, &visit.pass.verbs);
                }
                let members = Members::new(&columns, &order[first..first + count], V::COUNT);
                let place = Place::new(visit.tile.block, cell);
                match group::<T, V, M, D, B>(visit, &constants, &members, &place) {
                    Some(left) => visit.left |= u64::from(left) << cell,
                    None => {
                        for &index in &order[first..first + count] {
                            // SAFETY: the tile's particles are this call's alone.
                            unsafe { visit.one(index, cell) };
                        }
                    }
                }
                first += count;
            }
        }
    }
}

/// How many particles ahead of the present ones numbers are fetched into the cache: columns are too many for a processor to do so by itself.
const AHEAD: usize = 32;

/// Fetches what a pass needs of a particle and those beside it.
#[inline(always)]
fn fetch<T: Real, const D: usize>(columns: &Columns<T, D>, particle: usize, verbs: &Verbs) {
    let fetch = |first: usize, last: usize| {
        for column in first..last {
            // SAFETY: the particle exists.
            prefetch(unsafe { columns.at(column, particle) });
        }
    };
    fetch(Column::<D>::POSITION, Column::<D>::DEFORMATION);
    if verbs.strain || verbs.scatter.is_some_and(|share| share != Share::Momentum) {
        fetch(Column::<D>::DEFORMATION, Column::<D>::COUNT);
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

/// Up to as many particles as there are lanes.
struct Members<'a, T, const D: usize> {
    columns: &'a Columns<T, D>,
    index: &'a [u32],
    lie: Lie,
}

/// How the members of a group lie in memory.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Lie {
    /// Side by side, one in every lane.
    Full,
    /// Side by side, with lanes to spare.
    Part,
    /// Anyhow.
    Apart,
}

impl<'a, T: Real, const D: usize> Members<'a, T, D> {
    #[inline(always)]
    fn new(columns: &'a Columns<T, D>, index: &'a [u32], lanes: usize) -> Self {
        // Indices within a cell ascend.
        let lie = match index[index.len() - 1] as usize - index[0] as usize == index.len() - 1 {
            true if index.len() == lanes => Lie::Full,
            true => Lie::Part,
            false => Lie::Apart,
        };
        Members { columns, index, lie }
    }

    #[inline(always)]
    fn load<V: Lanes<Real = T>>(&self, column: usize) -> V {
        // SAFETY: the tile's particles are this pass' alone.
        unsafe {
            let first = self.columns.at(column, self.index[0] as usize);
            match self.lie {
                Lie::Full => V::load(first),
                Lie::Part => V::load_part(first, self.index.len()),
                Lie::Apart => V::load(collect(self.columns.at(column, 0), self.index).0.as_ptr()),
            }
        }
    }

    #[inline(always)]
    fn store<V: Lanes<Real = T>>(&self, column: usize, numbers: V) {
        // SAFETY: the tile's particles are this pass' alone.
        unsafe {
            let first = self.columns.at(column, self.index[0] as usize);
            match self.lie {
                Lie::Full => numbers.store(first),
                Lie::Part => numbers.store_part(first, self.index.len()),
                Lie::Apart => spread(self.columns.at(column, 0), self.index, &numbers.numbers().0),
            }
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

/// Numbers that lie apart, and the first in the lanes beyond.
///
/// # Safety
/// They must be there, and nobody may write to them meanwhile.
#[inline(never)]
unsafe fn collect<T: Real>(column: *const T, index: &[u32]) -> Numbers<T> {
    let mut numbers = [T::ZERO; MOST_LANES];
    for (lane, x) in numbers.iter_mut().enumerate() {
        // SAFETY: the caller's.
        *x = unsafe { *column.add(index[if lane < index.len() { lane } else { 0 }] as usize) };
    }
    Numbers(numbers)
}

/// Writes numbers that lie apart.
///
/// # Safety
/// There must be room for them, and nobody may use it meanwhile.
#[inline(never)]
unsafe fn spread<T: Real>(column: *mut T, index: &[u32], numbers: &[T; MOST_LANES]) {
    for (&i, &x) in index.iter().zip(numbers) {
        // SAFETY: the caller's.
        unsafe { *column.add(i as usize) = x };
    }
}

/// Takes a group through a pass and says whether any particle left the cell; nothing is done if any has a fault.
#[inline(always)]
fn group<T: Laned, V: Lanes<Real = T>, M: Machine<T>, const D: usize, B: Basis<T>>(
    visit: &mut Visit<'_, T, D, B>,
    constants: &Constants<V, D>,
    members: &Members<'_, T, D>,
    place: &Place<D>,
) -> Option<bool> {
    let Pass { verbs, dt, pic, .. } = *visit.pass;
    let Verbs { accept, strain, displace, scatter } = verbs;
    let position = members.vector::<V>(Column::<D>::POSITION);
    let half = members.load::<V>(Column::<D>::HALF_WIDTH) * constants.per_cell;
    let base = Vector::from_fn(|i| V::splat(T::of(f64::from(place.base[i]))));
    let group =
        Group::<V, D, B>::new(constants.in_cells(&position) - base, half, place.start, members.index.len());
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
    let pushes = matches!(scatter, Some(Share::Force | Share::Everything));
    if strain || displace || pushes {
        deformation = members.deformation::<V>();
    }
    if strain || pushes {
        stress = members.stress::<V>();
    }
    if strain {
        let scale = V::splat(dt) * constants.per_cell;
        let increment = Matrix::IDENTITY + group.velocity_gradient(&visit.window.flow) * scale;
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
        let moved = position + group.interpolate(&visit.window.carry) * V::splat(dt);
        sound &= finite(&moved.0);
        let cells = constants.in_cells(&moved);
        for i in 0..D {
            let reach = B::reach(cells[i], half);
            inside &= reach.at_least(base[i]) & !reach.at_least(base[i] + V::ONE);
            if let Some([min, max]) = &constants.domain {
                sound &= moved[i].at_least(min[i]) & max[i].at_least(moved[i]);
            }
            let far = V::splat(T::of(f64::from(crate::grid::MOST_CELLS - 1)));
            sound &= reach.at_least(-far) & far.at_least(reach);
        }
        if !every::<V>(sound) {
            return None;
        }
        members.store_vector(Column::<D>::POSITION, &moved);
        let modulus = constants.material.wave_modulus(visit.body.thickness, &deformation, jacobian);
        let signal = (modulus * constants.per_density).sqrt() + velocity.norm();
        let signals = signal.numbers();
        for &signal in &signals.0[..V::COUNT] {
            visit.found.signal = visit.found.signal.max(signal);
        }
    }
    if !every::<V>(sound) {
        return None;
    }
    if accept {
        members.store_vector(Column::<D>::VELOCITY, &velocity);
    }
    if strain {
        members.store_deformation(&deformation);
        members.store_stress(&stress);
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
    Some(!every::<V>(inside))
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

/// Lanes in which every number is finite.
#[inline(always)]
fn finite<V: Lanes>(numbers: &[V]) -> u32 {
    let mut sum = V::ZERO;
    for x in numbers {
        sum += x.abs();
    }
    V::splat(V::Real::LARGEST).at_least(sum)
}
