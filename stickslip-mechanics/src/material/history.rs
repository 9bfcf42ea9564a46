//! What particles remember of their past: declared by their law, kept in columns of their own.

use super::BadConstants;
use crate::column::{ColumnDescription, Kind, reserved};
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

/// Whether a history finds room, and its columns have names of their own.
///
/// # Errors
/// More components than [`MOST_HISTORY`]; a name that is no word, that every particle or every file has already, or
/// that two columns have.
pub(super) fn check(history: &[History]) -> Result<(), BadConstants> {
    let components = history_entries(history, 3);
    if components > MOST_HISTORY {
        let found = format!("a history of {components} components");
        return Err(BadConstants::together(found, format!("at most {MOST_HISTORY} components in space")));
    }
    for (i, name) in history.iter().map(|history| history.column.name).enumerate() {
        let found = format!("a history called `{name}`");
        if name.is_empty() || !name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
        {
            let allowed = "a word of lower-case letters, digits and underscores";
            return Err(BadConstants::together(found, allowed));
        }
        if reserved().any(|taken| taken == name) {
            let taken: Vec<&str> = reserved().collect();
            let allowed = format!("a name that no column has already; these are taken: {}", taken.join(", "));
            return Err(BadConstants::together(found, allowed));
        }
        if history[..i].iter().any(|before| before.column.name == name) {
            return Err(BadConstants::together(format!("{found} twice"), "a name for each column"));
        }
    }
    Ok(())
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

#[cfg(test)]
mod tests {
    use super::*;

    const fn number(name: &'static str) -> History {
        History::new(name, "", Kind::Number)
    }

    #[test]
    fn names_that_files_have_already_are_refused() {
        for name in ["velocity", "half_width", "pressure", "von_mises", "body", "number"] {
            let bad = check(&[number("heat"), number(name)]).expect_err(name);
            assert_eq!(bad.found, format!("a history called `{name}`"));
            assert!(
                bad.allowed.contains("position, velocity, ") && bad.allowed.contains("pressure"),
                "{bad}"
            );
        }
        for name in ["", "Heat", "back stress", "a<b"] {
            let bad = check(&[number(name)]).expect_err(name);
            assert!(bad.allowed.starts_with("a word of lower-case letters"), "{bad}");
        }
        let twice = check(&[number("heat"), number("heat")]).expect_err("twice");
        assert_eq!(twice.found, "a history called `heat` twice");
        let much = [History::new("strain", "", Kind::Tensor); 8];
        assert_eq!(check(&much).expect_err("72").found, "a history of 72 components");
        assert_eq!(check(&[number("heat"), number("pressure_2")]), Ok(()));
    }
}
