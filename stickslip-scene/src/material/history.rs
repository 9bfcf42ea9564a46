//! What particles remember of their past: declared by their law, kept in columns of their own.

use crate::column::{ColumnDescription, Kind};
use crate::tensor::{Number, Symmetric, array};

/// Most entries that the history of a particle in space may have.
pub const MOST_HISTORY: usize = 64;

/// A column of history as a law declares it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct History {
    /// Name, unit and components.
    pub column: ColumnDescription,
    /// Its value before anything moves; of tensors that of the diagonal, the rest is zero.
    pub start: f64,
}

impl History {
    /// A column that begins at zero.
    pub const fn new(name: &'static str, unit: &'static str, kind: Kind) -> Self {
        History { column: ColumnDescription { name, unit, kind }, start: 0.0 }
    }

    /// What the `entry`-th free component is before anything moves.
    pub fn start_of(&self, dimension: usize, entry: usize) -> f64 {
        match (self.column.kind, self.column.kind.place(dimension, entry)) {
            (Kind::Tensor, 0 | 4 | 8) | (Kind::Symmetric, 0..=2) => self.start,
            (Kind::Tensor | Kind::Symmetric, _) => 0.0,
            _ => self.start,
        }
    }
}

/// Entries that a history has in so many dimensions.
#[inline(always)]
pub const fn history_entries(history: &[History], dimension: usize) -> usize {
    let (mut i, mut sum) = (0, 0);
    while i < history.len() {
        sum += history[i].column.kind.entries(dimension);
        i += 1;
    }
    sum
}

/// A law's history as it computes with it: the components of its columns in space, one after the other.
pub trait Entries<T>: Copy {
    /// All zero.
    const ZERO: Self;
    /// The entries.
    fn entries(&self) -> &[T];
    /// The entries, to be changed.
    fn entries_mut(&mut self) -> &mut [T];
}

impl<T: Number, const N: usize> Entries<T> for [T; N] {
    const ZERO: Self = [T::ZERO; N];
    #[inline(always)]
    fn entries(&self) -> &[T] {
        self
    }
    #[inline(always)]
    fn entries_mut(&mut self) -> &mut [T] {
        self
    }
}

/// The symmetric tensor whose entries begin at a place of a history.
#[inline(always)]
pub(super) fn symmetric<T: Number>(entries: &[T], first: usize) -> Symmetric<T> {
    Symmetric(array(T::ZERO, |k| entries[first + k]))
}

/// Writes a symmetric tensor to a place of a history.
#[inline(always)]
pub(super) fn put_symmetric<T: Number>(entries: &mut [T], first: usize, tensor: &Symmetric<T>) {
    entries[first..first + 6].copy_from_slice(&tensor.0);
}

/// Where the history of a particle is read, entry by entry as its columns have them.
pub trait Recall<T> {
    /// Dimensions of the motion: in the plane, columns have only the entries that it leaves free.
    const DIMENSION: usize;
    /// An entry.
    fn recall(&self, entry: usize) -> T;
}

/// Where the history of a particle is written as well.
pub trait Keep<T>: Recall<T> {
    /// Writes an entry.
    fn keep(&mut self, entry: usize, value: T);
}

/// History before anything moves, in space.
#[derive(Clone, Copy, Debug)]
pub struct AtRest(pub &'static [History]);

impl<T: Number> Recall<T> for AtRest {
    const DIMENSION: usize = 3;
    fn recall(&self, entry: usize) -> T {
        let mut first = 0;
        for history in self.0 {
            let count = history.column.kind.components();
            if entry < first + count {
                return T::of(history.start_of(3, entry - first));
            }
            first += count;
        }
        T::ZERO
    }
}

/// A history from where it is read.
#[inline(always)]
pub(super) fn recalled<T: Number, E: Entries<T>, R: Recall<T>>(declared: &[History], from: &R) -> E {
    let mut history = E::ZERO;
    let (mut entry, mut first) = (0, 0);
    for history_column in declared {
        let kind = history_column.column.kind;
        for k in 0..kind.entries(R::DIMENSION) {
            history.entries_mut()[first + kind.place(R::DIMENSION, k)] = from.recall(entry);
            entry += 1;
        }
        first += kind.components();
    }
    history
}

/// Writes a history to where it is kept.
#[inline(always)]
pub(super) fn kept<T: Number, E: Entries<T>, K: Keep<T>>(declared: &[History], history: &E, to: &mut K) {
    let (mut entry, mut first) = (0, 0);
    for history_column in declared {
        let kind = history_column.column.kind;
        for k in 0..kind.entries(K::DIMENSION) {
            to.keep(entry, history.entries()[first + kind.place(K::DIMENSION, k)]);
            entry += 1;
        }
        first += kind.components();
    }
}
