//! What a column of particles holds: a name, a unit and its components.
//!
//! Memory, packing for lanes, snapshots, files and colours follow from this description; none lists columns by hand.

use crate::tensor::Symmetric;
use serde::{Deserialize, Serialize};

/// A column of particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColumnDescription {
    /// One word, as files and `--color` name it.
    pub name: &'static str,
    /// SI unit; empty for a number without one.
    pub unit: &'static str,
    /// What a particle has in it.
    pub kind: Kind,
}

/// The columns that the particles of every body have, in the order of memory;
/// behind them lies the history of the body's law.
///
/// The volume is J times the undeformed one; the half-width is half the side of the undeformed box; the start is the
/// position before anything moved, which no step writes to.
pub const EVERY: [ColumnDescription; 9] = [
    described("position", "m", Kind::Vector),
    described("velocity", "m/s", Kind::Vector),
    described("spin", "rad/s", Kind::Rotation),
    described("mass", "kg", Kind::Number),
    described("volume", "m^3", Kind::Number),
    described("half_width", "m", Kind::Number),
    described("deformation", "", Kind::Tensor),
    described("stress", "Pa", Kind::Symmetric),
    described("start", "m", Kind::Vector),
];

/// Whose a particle is, and which: columns of whole numbers in snapshots and files.
pub const IDENTITY: [&str; 2] = ["body", NUMBER.name];

/// Number of a particle in its body, from the filling; it never changes.
pub const NUMBER: ColumnDescription = described("number", "", Kind::Number);

/// A number that follows from a column of every particle. No particle carries it; files have it for whoever looks.
#[derive(Clone, Copy, Debug)]
pub struct Derived {
    /// Name, unit and components.
    pub column: ColumnDescription,
    /// The column of [`EVERY`] from which it follows.
    pub from: &'static str,
    /// Its value, from the components in space of that column.
    pub value: fn(&[f64]) -> f64,
}

/// The numbers that files have beside what particles carry, from the Cauchy stress sigma (tension positive) [Pa]:
///
/// ```text
/// pressure  = -tr(sigma) / 3
/// von_mises = sqrt(3/2 s : s),   s = sigma - tr(sigma)/3 I
/// ```
pub const DERIVED: [Derived; 2] = [
    Derived {
        column: described("pressure", "Pa", Kind::Number),
        from: "stress",
        value: |sigma| -symmetric(sigma).trace() / 3.0,
    },
    Derived {
        column: described("von_mises", "Pa", Kind::Number),
        from: "stress",
        value: |sigma| {
            let s = symmetric(sigma).deviator();
            (1.5 * s.double_dot(&s)).sqrt()
        },
    },
];

fn symmetric(components: &[f64]) -> Symmetric<f64> {
    Symmetric(std::array::from_fn(|k| components[k]))
}

const fn described(name: &'static str, unit: &'static str, kind: Kind) -> ColumnDescription {
    ColumnDescription { name, unit, kind }
}

/// The column of [`EVERY`] of this name, which must be there.
pub const fn every(name: &str) -> ColumnDescription {
    let mut i = 0;
    while !same(EVERY[i].name, name) {
        i += 1;
        assert!(i < EVERY.len(), "a column of every particle");
    }
    EVERY[i]
}

/// Whether two names are the same.
pub const fn same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut i = 0;
    while i < a.len() && i < b.len() && a[i] == b[i] {
        i += 1;
    }
    i == a.len() && i == b.len()
}

/// Name of the column in which a transfer carries the rate of strain.
pub const STRAIN_RATE: &str = "strain_rate";

/// Pressure of the bulk viscosity that some scenes ask for.
pub const BULK_VISCOSITY: &str = "bulk_viscosity";

/// What the law sees of the deformation beside F, of bodies that begin with a stress.
pub const INITIAL_STRETCH: &str = "initial_stretch";

/// How much warmer than at the start a particle is, of bodies that loads heat.
pub const TEMPERATURE: &str = "temperature";

/// Relative growth by the heating of the last step.
pub const THERMAL_STRAIN_STEP: &str = "thermal_strain_step";

/// Names of the columns that only some bodies have, whatever their law.
const OF_SOME: [&str; 5] = [STRAIN_RATE, BULK_VISCOSITY, INITIAL_STRETCH, TEMPERATURE, THERMAL_STRAIN_STEP];

/// Names of the columns that every file of particles may have.
pub fn in_files() -> impl Iterator<Item = &'static str> {
    let every = EVERY.iter().map(|column| column.name);
    every.chain(IDENTITY).chain(DERIVED.iter().map(|derived| derived.column.name))
}

/// Names of those of them that a file may do without, and of what only some bodies have.
pub fn optional_in_files() -> impl Iterator<Item = &'static str> {
    // What the engine keeps for itself is in no file.
    let kept = ["position", "spin", "half_width", "start"];
    in_files().chain(OF_SOME).filter(move |name| !kept.contains(name) && !IDENTITY.contains(name))
}

/// Names that no column of history may have: a file would hold two columns called the same.
pub fn reserved() -> impl Iterator<Item = &'static str> {
    in_files().chain(OF_SOME)
}

/// What a particle has in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Kind {
    /// A number.
    Number,
    /// A vector: x, y, z.
    Vector,
    /// An angular velocity: in the plane only about the third axis.
    Rotation,
    /// A tensor: xx, xy, xz, yx, yy, yz, zx, zy, zz.
    Tensor,
    /// A symmetric tensor: xx, yy, zz, xy, yz, xz.
    Symmetric,
}

/// Entries of a tensor, row by row, that a motion in the plane leaves free; the others are zero.
const PLANE_TENSOR: [usize; 5] = [0, 1, 3, 4, 8];

impl Kind {
    /// Components in space.
    #[inline(always)]
    pub const fn components(self) -> usize {
        self.entries(3)
    }

    /// Components that a motion in so many dimensions leaves free.
    #[inline(always)]
    pub const fn entries(self, dimension: usize) -> usize {
        match (self, dimension) {
            (Kind::Number, _) | (Kind::Rotation, 2) => 1,
            (Kind::Vector, dimension) => dimension,
            (Kind::Rotation, _) => 3,
            (Kind::Tensor, 2) => PLANE_TENSOR.len(),
            (Kind::Tensor, _) => 9,
            (Kind::Symmetric, 2) => 4,
            (Kind::Symmetric, _) => 6,
        }
    }

    /// Which of the components in space the `entry`-th free one is.
    #[inline(always)]
    pub const fn place(self, dimension: usize, entry: usize) -> usize {
        match (self, dimension) {
            (Kind::Tensor, 2) => PLANE_TENSOR[entry],
            (Kind::Rotation, 2) => 2,
            _ => entry,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn free_entries_have_places_of_their_own_that_ascend() {
        for kind in [Kind::Number, Kind::Vector, Kind::Rotation, Kind::Tensor, Kind::Symmetric] {
            for dimension in [2, 3] {
                let places: Vec<usize> =
                    (0..kind.entries(dimension)).map(|k| kind.place(dimension, k)).collect();
                assert!(places.windows(2).all(|pair| pair[0] < pair[1]), "{kind:?} {places:?}");
                assert!(places.iter().all(|&place| place < kind.components()), "{kind:?} {places:?}");
            }
        }
    }
}
