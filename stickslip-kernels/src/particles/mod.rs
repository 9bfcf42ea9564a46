//! Particles of one body as columns, so that a processor can take several at a time; seen from outside, they are rows.

mod rows;
#[cfg(test)]
mod tests;

pub use rows::{Shown, fill_holes, number_of, write_number};

use crate::column::{ColumnDescription, EVERY, Kind, NUMBER, same};
use crate::grid::Disjoint;
use crate::material::{History, Keep, Recall, history_entries};
use crate::matter::Particle;
use crate::natural::{self, Natural};
use crate::pages::ask_for_large;
use crate::tensor::{Matrix, Real, Symmetric, Vector};
use crate::threads::each_range;
use std::ops::Range;

/// Place of the first entry of a column of [`EVERY`], or, of a name that it does not have, of the history.
pub const fn first_of(name: &str, dimension: usize) -> usize {
    let (mut i, mut sum) = (0, 0);
    while i < EVERY.len() && !same(EVERY[i].name, name) {
        sum += EVERY[i].kind.entries(dimension);
        i += 1;
    }
    sum
}

/// A place that must be known.
const fn known(name: &str, dimension: usize) -> usize {
    let first = first_of(name, dimension);
    assert!(first < first_of("", dimension), "a column of every particle");
    first
}

/// Entries of F that a motion in `D` dimensions leaves free, by row and column; the others are zero.
pub const fn deformation_entries(dimension: usize) -> &'static [[usize; 2]] {
    if dimension == 2 {
        &[[0, 0], [0, 1], [1, 0], [1, 1], [2, 2]]
    } else {
        &[[0, 0], [0, 1], [0, 2], [1, 0], [1, 1], [1, 2], [2, 0], [2, 1], [2, 2]]
    }
}

/// Entries of the stress that a motion in `D` dimensions leaves free: xx, yy, zz, xy, then yz, xz.
pub const fn stress_entries(dimension: usize) -> usize {
    Kind::Symmetric.entries(dimension)
}

/// Components that the angular velocity of a motion in `D` dimensions has: about the third axis, or about all.
pub const fn spin_entries(dimension: usize) -> usize {
    Kind::Rotation.entries(dimension)
}

/// Where the entries of the columns of [`EVERY`] begin.
#[derive(Clone, Copy, Debug)]
pub struct ColumnStart<const D: usize>;

impl<const D: usize> ColumnStart<D> {
    /// First component of the position.
    pub const POSITION: usize = known("position", D);
    /// First component of the velocity.
    pub const VELOCITY: usize = known("velocity", D);
    /// First of [`spin_entries`].
    pub const SPIN: usize = known("spin", D);
    /// Mass.
    pub const MASS: usize = known("mass", D);
    /// Volume.
    pub const VOLUME: usize = known("volume", D);
    /// Half the side of the undeformed box.
    pub const HALF_WIDTH: usize = known("half_width", D);
    /// First of [`deformation_entries`].
    pub const DEFORMATION: usize = known("deformation", D);
    /// First of [`stress_entries`].
    pub const STRESS: usize = known("stress", D);
    /// First component of the start.
    pub const START: usize = known("start", D);
    /// Number of entries that all bodies have.
    pub const COUNT: usize = first_of("", D);
    /// First entry of the history of the body's law.
    pub const HISTORY: usize = Self::COUNT;
}

/// Particles of one body.
#[derive(Clone, Debug)]
pub struct Particles<T, const D: usize> {
    /// How many.
    len: usize,
    /// How many lie behind them that belong to another rank: only contact looks at these.
    guests: usize,
    /// One column after the other, [`Particles::stride`] apart, and room for one more, where particles are sorted.
    columns: Vec<T>,
    /// Room for a column: an odd number of cache lines, else all columns would fall into the same places of a cache.
    stride: usize,
    /// Each particle's number in its body, and room for as many more; a stride each.
    numbers: Vec<u32>,
    /// Whether the room is before the columns and numbers, or behind them.
    later: bool,
    /// What the body's law remembers.
    history: &'static [History],
    /// What its transfer carries beside the columns that all have.
    transfer: &'static [History],
    /// What bulk viscosity needs.
    viscosity: &'static [History],
    /// What initial stress and heat need.
    natural: &'static [History],
    /// Mass [kg] and half the side of the undeformed box [m] of every particle, where it is known that they are alike:
    /// then nobody needs to read these columns.
    alike: Option<[T; 2]>,
}

/// Columns that not all bodies have: what a law remembers, behind that what a transfer carries, what bulk viscosity
/// needs, and what initial stress and heat need.
#[derive(Clone, Copy, Debug, Default)]
pub struct OwnColumns {
    /// Of the law.
    pub history: &'static [History],
    /// Of the transfer.
    pub transfer: &'static [History],
    /// Of bulk viscosity.
    pub viscosity: &'static [History],
    /// Of the state without stress, see [`crate::natural`].
    pub natural: &'static [History],
}

impl OwnColumns {
    /// All of them.
    fn all(self) -> impl Iterator<Item = &'static History> {
        self.history.iter().chain(self.transfer).chain(self.viscosity).chain(self.natural)
    }

    /// Their entries.
    const fn entries(self, dimension: usize) -> usize {
        history_entries(self.history, dimension)
            + history_entries(self.transfer, dimension)
            + history_entries(self.viscosity, dimension)
            + history_entries(self.natural, dimension)
    }
}

/// Where a column of a body's particles lies in memory, for those who look there without asking again, such as arrays
/// of Python. Between two steps it stays there, and after a step or another state it is there again once the simulation
/// has [settled](crate::door::Simulation::settle).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColumnPlace {
    /// Name, unit and components.
    pub column: ColumnDescription,
    /// Address of the first particle's first entry, with its provenance exposed; the next particle follows it.
    pub address: usize,
    /// What a number is.
    pub format: NumberFormat,
    /// From an entry to the next [bytes].
    pub stride: usize,
    /// Which component in space each entry is: those that the motion leaves free, the others are zero.
    pub components: Vec<usize>,
    /// Particles.
    pub len: usize,
}

/// What a number is in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumberFormat {
    /// `f32`
    Single,
    /// `f64`
    Double,
    /// `u32`
    Count,
}

/// Components in space that a column has at most.
pub const MOST_COMPONENTS: usize = Kind::Tensor.components();

/// Bytes in a cache line.
const LINE: usize = 64;

impl<T: Real, const D: usize> Particles<T, D> {
    /// Entries from a column to the next, of so many particles; a body without any takes no memory.
    const fn stride_of(count: usize) -> usize {
        if count == 0 {
            return 0;
        }
        let lines = (count * size_of::<T>()).div_ceil(LINE) | 1;
        lines * LINE / size_of::<T>()
    }

    /// Columns of a body with these of its own, an entry each, with room for one more.
    const fn columns_of(own: OwnColumns) -> usize {
        ColumnStart::<D>::HISTORY + own.entries(D) + 1
    }

    /// Memory that so many particles take, of a body with these columns of its own: all columns and numbers, and the
    /// room in which they are sorted [bytes].
    pub const fn bytes_of(count: usize, own: OwnColumns) -> usize {
        Self::stride_of(count) * (Self::columns_of(own) * size_of::<T>() + 2 * size_of::<u32>())
    }

    /// The particles `f(0)` to `f(count - 1)`, before anything moves, of a body with these columns of its own.
    pub fn from_fn(count: usize, own: OwnColumns, f: impl Fn(usize) -> Particle<T, D>) -> Self {
        let stride = Self::stride_of(count);
        let columns = vec![T::ZERO; stride * Self::columns_of(own)];
        ask_for_large(columns.as_ptr(), columns.len());
        let numbers = vec![0; 2 * stride];
        let OwnColumns { history, transfer, viscosity, natural } = own;
        let mut particles = Particles {
            len: count,
            guests: 0,
            columns,
            stride,
            numbers,
            later: false,
            history,
            transfer,
            viscosity,
            natural,
            alike: None,
        };
        for i in 0..count {
            let particle = f(i);
            particles.set(i, &particle);
            for k in 0..D {
                particles.columns[(ColumnStart::<D>::START + k) * stride + i] = particle.position[k];
            }
        }
        let mut column = ColumnStart::<D>::HISTORY;
        for remembered in own.all() {
            for entry in 0..remembered.column.kind.entries(D) {
                particles.columns[column * stride..][..count].fill(T::of(remembered.start_of(D, entry)));
                column += 1;
            }
        }
        particles.compare();
        particles
    }

    /// Finds out whether all particles are alike, once their masses and boxes are written.
    pub fn compare(&mut self) {
        let same = |column: usize| {
            let (first, others) = self.line(column).split_first()?;
            others.iter().all(|other| other == first).then_some(*first)
        };
        self.alike = same(ColumnStart::<D>::MASS).zip(same(ColumnStart::<D>::HALF_WIDTH)).map(<[T; 2]>::from);
    }

    /// How many.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Entries of a particle in all columns.
    fn entries(&self) -> usize {
        ColumnStart::<D>::HISTORY + self.own().entries(D)
    }

    /// What their law remembers.
    pub fn history(&self) -> &'static [History] {
        self.history
    }

    /// Its own columns.
    pub fn own(&self) -> OwnColumns {
        OwnColumns {
            history: self.history,
            transfer: self.transfer,
            viscosity: self.viscosity,
            natural: self.natural,
        }
    }

    /// The columns that not all bodies have.
    pub fn own_columns(&self) -> impl Iterator<Item = ColumnDescription> {
        self.own().all().map(|own| own.column)
    }

    /// All columns by the place of their first entry: those that every body has, and its own.
    pub fn described(&self) -> impl Iterator<Item = (usize, ColumnDescription)> {
        EVERY.into_iter().chain(self.own_columns()).scan(0, |first, column| {
            let this = *first;
            *first += column.kind.entries(D);
            Some((this, column))
        })
    }

    /// The description and the entries of the column of this name: its components in space, one value a particle in the
    /// order of memory, and `None` for a component that the motion does not leave free.
    pub fn column(&self, name: &str) -> Option<(ColumnDescription, [Option<&[T]>; MOST_COMPONENTS])> {
        let (first, column) = self.described().find(|(_, column)| column.name == name)?;
        let mut components = [None; MOST_COMPONENTS];
        for entry in 0..column.kind.entries(D) {
            components[column.kind.place(D, entry)] = Some(self.line(first + entry));
        }
        Some((column, components))
    }

    /// An entry of a column by its place, of all particles in the order of memory.
    pub fn line(&self, entry: usize) -> &[T] {
        &self.columns[self.first() + entry * self.stride..][..self.len]
    }

    /// The same, to be written. Who writes masses or boxes [compares](Particles::compare) the particles then.
    pub fn line_mut(&mut self, entry: usize) -> &mut [T] {
        if entry == ColumnStart::<D>::MASS || entry == ColumnStart::<D>::HALF_WIDTH {
            self.alike = None;
        }
        let first = self.first() + entry * self.stride;
        &mut self.columns[first..][..self.len]
    }

    /// None at all.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Each particle's number in its body, in the order of memory.
    pub fn numbers(&self) -> &[u32] {
        &self.numbers[self.first_number()..][..self.len]
    }

    fn first_number(&self) -> usize {
        if self.later { self.stride } else { 0 }
    }

    /// Where the first column begins.
    #[inline(always)]
    fn first(&self) -> usize {
        if self.later { self.stride } else { 0 }
    }

    /// Particle `i`.
    #[inline]
    pub fn get(&self, i: usize) -> Particle<T, D> {
        assert!(i < self.len + self.guests, "a particle of the body");
        // SAFETY: in range, and borrowed for reading.
        Particle { number: self.numbers[self.first_number() + i], ..unsafe { self.view().get(i) } }
    }

    /// Position [m] and half the side of the undeformed box [m] of particle `i`.
    #[inline]
    pub fn place(&self, i: usize) -> (Vector<T, D>, T) {
        let at = |column: usize| self.columns[self.first() + column * self.stride + i];
        (Vector::from_fn(|k| at(ColumnStart::<D>::POSITION + k)), self.half_width(i))
    }

    /// Where particle `i` was before its body deformed [m].
    #[inline]
    pub fn start(&self, i: usize) -> Vector<T, D> {
        let at = |column: usize| self.columns[self.first() + column * self.stride + i];
        Vector::from_fn(|k| at(ColumnStart::<D>::START + k))
    }

    /// Half the side of the undeformed box of particle `i` [m].
    #[inline]
    pub fn half_width(&self, i: usize) -> T {
        self.columns[self.first() + ColumnStart::<D>::HALF_WIDTH * self.stride + i]
    }

    /// The state without stress of particle `i`, of a material with this expansion by temperature; `None` where that is
    /// the one in which its body is drawn.
    pub fn natural(&self, i: usize, expansion: T) -> Option<Natural<T>> {
        let columns = self.view().natural_columns();
        let mut entries = [T::ZERO; natural::most_entries(3)];
        for (entry, column) in entries.iter_mut().zip(columns.clone()) {
            *entry = self.line(column)[i];
        }
        (!columns.is_empty()).then(|| Natural::new::<D>((&entries, columns.len()), expansion))
    }

    /// Writes particle `i`.
    pub fn set(&mut self, i: usize, particle: &Particle<T, D>) {
        assert!(i < self.len(), "a particle of the body");
        let first = self.first_number();
        self.numbers[first + i] = particle.number;
        self.alike = self.alike.filter(|alike| *alike == [particle.mass, particle.half_width]);
        // SAFETY: in range, and borrowed for writing.
        unsafe { self.open().set(i, particle) };
    }

    /// All particles in the order of memory.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Particle<T, D>> + '_ {
        (0..self.len()).map(|i| self.get(i))
    }

    /// Takes from all particles their velocities and what else they carry of motion.
    pub fn stop(&mut self) {
        let of_motion = self.view().transfer_columns().start..self.view().viscosity_columns().end;
        for column in (ColumnStart::<D>::VELOCITY..ColumnStart::<D>::MASS).chain(of_motion) {
            let first = self.first() + column * self.stride;
            self.columns[first..][..self.len].fill(T::ZERO);
        }
    }

    /// The columns, to be read only.
    #[inline(always)]
    pub fn view(&self) -> Columns<T, D> {
        Columns {
            start: self.columns[self.first()..].as_ptr().cast_mut(),
            stride: self.stride,
            history: history_entries(self.history, D),
            transfer: history_entries(self.transfer, D),
            viscosity: history_entries(self.viscosity, D),
            natural: history_entries(self.natural, D),
            alike: self.alike,
        }
    }

    /// Opens the columns to many threads.
    pub fn open(&mut self) -> Columns<T, D> {
        let (first, view) = (self.first(), self.view());
        Columns { start: self.columns[first..].as_mut_ptr(), ..view }
    }

    /// Puts the particles into the order of a permutation: first the one whose index comes first.
    /// Every column moves into the room beside it.
    pub fn permute(&mut self, order: &[u32]) {
        assert_eq!(order.len(), self.len, "a permutation names every particle");
        self.guests = 0;
        let count = self.entries();
        for column in 0..count {
            let column = if self.later { column } else { count - 1 - column };
            move_over(&mut self.columns[column * self.stride..][..2 * self.stride], self.later, order);
        }
        move_over(&mut self.numbers, self.later, order);
        self.later = !self.later;
    }

    /// Moves columns and numbers back to where they lay before anything was sorted. The order of the particles stays.
    pub fn settle(&mut self) {
        if self.later {
            self.columns.copy_within(self.stride.., 0);
            self.numbers.copy_within(self.stride.., 0);
            self.later = false;
        }
    }

    /// Takes out particles by their places, which must ascend; the others keep their order, and all their memory.
    pub fn remove(&mut self, gone: &[u32]) {
        let (columns, alike) = (self.entries(), self.alike);
        (0..columns).for_each(|entry| close_gaps(self.line_mut(entry), gone));
        self.alike = alike;
        let (first, len) = (self.first_number(), self.len);
        close_gaps(&mut self.numbers[first..first + len], gone);
        self.len -= gone.len();
        self.guests = 0;
    }

    /// Those with some numbers, in any order.
    #[must_use]
    pub fn with_numbers(&self, numbers: &[u32]) -> Self {
        let mut wanted = numbers.to_vec();
        wanted.sort_unstable();
        let gone = self.numbers().iter().zip(0..).filter(|(number, _)| wanted.binary_search(number).is_err());
        let gone: Vec<u32> = gone.map(|(_, place)| place).collect();
        let mut some = self.clone();
        some.remove(&gone);
        some
    }

    /// Keeps the first particles only.
    pub fn truncate(&mut self, count: usize) {
        let rest: Vec<u32> = (count as u32..self.len as u32).collect();
        self.remove(&rest);
    }

    /// Becomes other particles, in the memory that is there if they take as much.
    pub fn become_others(&mut self, others: Self) {
        if others.columns.len() != self.columns.len() {
            *self = others;
            return;
        }
        let Particles { columns, numbers, .. } = self;
        columns.copy_from_slice(&others.columns);
        numbers.clear();
        numbers.extend_from_slice(&others.numbers);
        let (columns, numbers) = (std::mem::take(columns), std::mem::take(numbers));
        *self = Particles { columns, numbers, ..others };
    }

    /// Becomes a copy of the particles of the same body, in the memory that is there.
    pub fn become_copy_of(&mut self, other: &Self) {
        let Particles {
            len,
            guests,
            columns,
            stride,
            numbers,
            later,
            history,
            transfer,
            viscosity,
            natural,
            alike,
        } = self;
        columns.clone_from(&other.columns);
        numbers.clone_from(&other.numbers);
        (*len, *guests, *stride, *later) = (other.len, other.guests, other.stride, other.later);
        (*history, *transfer) = (other.history, other.transfer);
        (*viscosity, *natural) = (other.viscosity, other.natural);
        *alike = other.alike;
    }

    /// Where a column lies as long as nothing is sorted, and after it once they are settled; `number` is one, too.
    pub fn column_place(&self, name: &str) -> Option<ColumnPlace> {
        let len = self.len;
        // From the vectors' own pointers: those of a slice would not outlive what writes through the vector.
        if name == NUMBER.name {
            let address = self.numbers.as_ptr().wrapping_add(self.first_number()).expose_provenance();
            let (format, components) = (NumberFormat::Count, vec![0]);
            return Some(ColumnPlace { column: NUMBER, address, format, stride: 0, components, len });
        }
        let (first, column) = self.described().find(|(_, column)| column.name == name)?;
        let start = self.columns.as_ptr().wrapping_add(self.first() + first * self.stride);
        Some(ColumnPlace {
            column,
            address: start.expose_provenance(),
            format: if size_of::<T>() == 4 { NumberFormat::Single } else { NumberFormat::Double },
            stride: self.stride * size_of::<T>(),
            components: (0..column.kind.entries(D)).map(|entry| column.kind.place(D, entry)).collect(),
            len,
        })
    }
}

/// Places in memory of particles with these numbers, in the order of the numbers.
pub fn by_number(numbers: &[u32]) -> Vec<u32> {
    let mut places: Vec<u32> = (0..numbers.len() as u32).collect();
    if numbers.iter().all(|&number| (number as usize) < numbers.len()) {
        (numbers.iter().zip(0..)).for_each(|(&number, place)| places[number as usize] = place);
    } else {
        // Some are gone.
        places.sort_unstable_by_key(|&place| numbers[place as usize]);
    }
    places
}

/// Whether particles with these indices lie side by side in memory, in this order.
#[inline(always)]
pub fn follow_one_another(index: &[u32]) -> bool {
    index.iter().zip(index[0]..).fold(true, |all, (&i, next)| all & (i == next))
}

/// Moves what is not gone to the front, in its order.
fn close_gaps<X: Copy>(line: &mut [X], gone: &[u32]) {
    let Some(&first) = gone.first() else { return };
    let mut to = first as usize;
    for (i, &before) in gone.iter().enumerate() {
        let from = before as usize + 1;
        let end = gone.get(i + 1).map_or(line.len(), |&next| next as usize);
        line.copy_within(from..end, to);
        to += end - from;
    }
}

/// Particles that a thread takes at a time.
const PART: usize = 1 << 13;

/// Moves one half of a slice over the other in the order of a permutation: the later half or the earlier one.
fn move_over<X: Copy + Send + Sync>(halves: &mut [X], later: bool, order: &[u32]) {
    let (lower, upper) = halves.split_at_mut(halves.len() / 2);
    let (to, from) = if later { (lower, &*upper) } else { (upper, &*lower) };
    let to = Disjoint::new(&mut to[..order.len()]);
    each_range(order.len(), PART, &|range| {
        // SAFETY: every place lies in one range.
        let to = unsafe { to.part(range.start, range.len()) };
        for (to, &i) in to.iter_mut().zip(&order[range]) {
            *to = from[i as usize];
        }
    });
}

/// The columns of a body's particles, open to many threads that keep to particles of their own. Good until the
/// particles are used in any other way.
#[derive(Clone, Copy, Debug)]
pub struct Columns<T, const D: usize> {
    start: *mut T,
    stride: usize,
    /// Entries of the history.
    history: usize,
    /// Entries of what the transfer carries.
    transfer: usize,
    /// Entries of what bulk viscosity needs.
    viscosity: usize,
    /// Entries of what initial stress and heat need.
    natural: usize,
    /// Mass and half the side of the box of all particles, see [`Particles`].
    alike: Option<[T; 2]>,
}

// SAFETY: entries are only reached through unsafe functions, whose callers keep threads apart.
unsafe impl<T: Send, const D: usize> Sync for Columns<T, D> {}
// SAFETY: as above.
unsafe impl<T: Send, const D: usize> Send for Columns<T, D> {}

impl<T: Real, const D: usize> Columns<T, D> {
    /// Entries from a column to the next.
    #[inline(always)]
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// Mass [kg] and half the side of the undeformed box [m] of every particle, if they are known to be alike.
    #[inline(always)]
    pub fn alike(&self) -> Option<[T; 2]> {
        self.alike
    }

    /// Entries of the history.
    #[inline(always)]
    pub fn history(&self) -> usize {
        self.history
    }

    /// Places of the columns of the transfer.
    #[inline(always)]
    pub fn transfer_columns(&self) -> Range<usize> {
        let first = ColumnStart::<D>::HISTORY + self.history;
        first..first + self.transfer
    }

    /// Place of the column of bulk viscosity, if there is one.
    #[inline(always)]
    pub fn viscosity_columns(&self) -> Range<usize> {
        let first = self.transfer_columns().end;
        first..first + self.viscosity
    }

    /// Places of the columns of the state without stress.
    #[inline(always)]
    pub fn natural_columns(&self) -> Range<usize> {
        let first = self.viscosity_columns().end;
        first..first + self.natural
    }

    /// The entry of particle `i` in a column.
    ///
    /// # Safety
    /// The column and the particle must exist, and nobody may use the entry but by this pointer.
    #[inline(always)]
    pub unsafe fn at(&self, column: usize, i: usize) -> *mut T {
        debug_assert!(column < self.natural_columns().end && i < self.stride, "an entry");
        // SAFETY: the caller's.
        unsafe { self.start.add(column * self.stride + i) }
    }

    /// Particle `i` but for its number.
    ///
    /// # Safety
    /// The particle must exist, and nobody may write to it meanwhile.
    #[inline]
    pub unsafe fn get(&self, i: usize) -> Particle<T, D> {
        // SAFETY: the caller's.
        let at = |column: usize| unsafe { *self.at(column, i) };
        let mut deformation = Matrix::ZERO;
        for (k, &[row, column]) in deformation_entries(D).iter().enumerate() {
            deformation.0[row][column] = at(ColumnStart::<D>::DEFORMATION + k);
        }
        let mut stress = Symmetric::ZERO;
        for (k, entry) in stress.0.iter_mut().enumerate().take(stress_entries(D)) {
            *entry = at(ColumnStart::<D>::STRESS + k);
        }
        let mut spin = Vector::ZERO;
        for k in 0..spin_entries(D) {
            spin[3 - spin_entries(D) + k] = at(ColumnStart::<D>::SPIN + k);
        }
        Particle {
            position: Vector::from_fn(|k| at(ColumnStart::<D>::POSITION + k)),
            velocity: Vector::from_fn(|k| at(ColumnStart::<D>::VELOCITY + k)),
            spin,
            mass: at(ColumnStart::<D>::MASS),
            volume: at(ColumnStart::<D>::VOLUME),
            half_width: at(ColumnStart::<D>::HALF_WIDTH),
            deformation,
            stress,
            number: 0,
        }
    }

    /// Writes particle `i` but for its number.
    ///
    /// # Safety
    /// The particle must exist, and nobody may use it meanwhile.
    pub unsafe fn set(&self, i: usize, particle: &Particle<T, D>) {
        // SAFETY: the caller's.
        let put = |column: usize, x: T| unsafe { *self.at(column, i) = x };
        for k in 0..D {
            put(ColumnStart::<D>::POSITION + k, particle.position[k]);
            put(ColumnStart::<D>::VELOCITY + k, particle.velocity[k]);
        }
        for k in 0..spin_entries(D) {
            put(ColumnStart::<D>::SPIN + k, particle.spin[3 - spin_entries(D) + k]);
        }
        put(ColumnStart::<D>::MASS, particle.mass);
        put(ColumnStart::<D>::VOLUME, particle.volume);
        put(ColumnStart::<D>::HALF_WIDTH, particle.half_width);
        for (k, &[row, column]) in deformation_entries(D).iter().enumerate() {
            put(ColumnStart::<D>::DEFORMATION + k, particle.deformation.0[row][column]);
        }
        for (k, &x) in particle.stress.0.iter().enumerate().take(stress_entries(D)) {
            put(ColumnStart::<D>::STRESS + k, x);
        }
    }
}

/// The history of one particle in its columns; nobody else may use the particle meanwhile. Rigid bodies keep none,
/// and recall zeros.
#[derive(Clone, Copy, Debug)]
pub struct HistoryOf<T, const D: usize> {
    columns: Columns<T, D>,
    particle: usize,
}

impl<T: Real, const D: usize> Columns<T, D> {
    /// The history of particle `i`.
    ///
    /// # Safety
    /// The particle must exist, nobody may write to its history while what is returned is used for reading, nor use it
    /// while that is used for writing.
    #[inline(always)]
    pub unsafe fn history_of(self, i: usize) -> HistoryOf<T, D> {
        HistoryOf { columns: self, particle: i }
    }
}

impl<T: Real, const D: usize> Recall<T> for HistoryOf<T, D> {
    const DIMENSION: usize = D;
    #[inline(always)]
    fn recall(&self, entry: usize) -> T {
        if entry >= self.columns.history {
            return T::ZERO;
        }
        // SAFETY: that of `Columns::history_of`.
        unsafe { *self.columns.at(ColumnStart::<D>::HISTORY + entry, self.particle) }
    }
}

impl<T: Real, const D: usize> Keep<T> for HistoryOf<T, D> {
    #[inline(always)]
    fn keep(&mut self, entry: usize, value: T) {
        // SAFETY: as above.
        unsafe { *self.columns.at(ColumnStart::<D>::HISTORY + entry, self.particle) = value }
    }
}
