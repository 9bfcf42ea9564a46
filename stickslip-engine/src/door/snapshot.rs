//! Particles of all bodies at one time, as columns: what files, pictures and tests look at.

use crate::column::{self, ColumnDescription, Kind};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Where a snapshot's columns come from: a running engine, or a file.
pub trait ColumnSource {
    /// Why there is no such column.
    type Error;
    /// The `N` components in space of a column of every particle, one particle after the other, in SI units.
    ///
    /// # Errors
    /// There is none.
    fn column<const N: usize>(&self, column: &ColumnDescription) -> Result<Vec<[f64; N]>, Self::Error>;
}

/// A column as a snapshot holds it: a number or some a particle.
trait Values: Sized {
    const COMPONENTS: usize;
    fn flat(&self) -> &[f64];
    fn from_source<S: ColumnSource>(source: &S, column: &ColumnDescription) -> Result<Self, S::Error>;
    fn of_flat(values: Vec<f64>) -> Self;
}

/// Columns as bytes, one number behind the other, little-endian.
mod flat {
    use super::Values;
    use serde::{Deserializer, Serializer};

    pub fn serialize<V: Values, S: Serializer>(values: &V, serializer: S) -> Result<S::Ok, S::Error> {
        let bytes: Vec<u8> = values.flat().iter().flat_map(|x| x.to_le_bytes()).collect();
        serde_bytes::serialize(&bytes, serializer)
    }

    pub fn deserialize<'de, V: Values, D: Deserializer<'de>>(deserializer: D) -> Result<V, D::Error> {
        let bytes: Vec<u8> = serde_bytes::deserialize(deserializer)?;
        Ok(V::of_flat(bytes.as_chunks().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect()))
    }
}

impl Values for Vec<f64> {
    const COMPONENTS: usize = 1;
    fn flat(&self) -> &[f64] {
        self
    }
    fn from_source<S: ColumnSource>(source: &S, column: &ColumnDescription) -> Result<Self, S::Error> {
        Ok(source.column::<1>(column)?.into_flattened())
    }
    fn of_flat(values: Vec<f64>) -> Self {
        values
    }
}

impl<const N: usize> Values for Vec<[f64; N]> {
    const COMPONENTS: usize = N;
    fn flat(&self) -> &[f64] {
        self.as_flattened()
    }
    fn from_source<S: ColumnSource>(source: &S, column: &ColumnDescription) -> Result<Self, S::Error> {
        source.column(column)
    }
    fn of_flat(values: Vec<f64>) -> Self {
        values.as_chunks().0.to_vec()
    }
}

/// The entries in these rows.
fn picked<X: Copy>(all: Vec<X>, rows: &[usize]) -> Vec<X> {
    rows.iter().map(|&i| all[i]).collect()
}

/// Which of the columns of every particle a snapshot holds. What they are called, their units and kinds are
/// [`column::EVERY`]'s; who fills, writes or reads a snapshot goes over this list.
macro_rules! snapshot {
    ($($(#[$doc:meta])* $name:ident: $values:ty,)*) => {
        /// Particles of all bodies as columns of equal length.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
        pub struct ParticleSnapshot {
            /// 2 or 3.
            pub dimension: usize,
            /// Index of the body.
            pub body: Vec<u32>,
            /// Number of the particle in its body, from the filling; it never changes.
            pub number: Vec<u32>,
            $($(#[$doc])* #[serde(with = "flat")] pub $name: $values,)*
            /// What the laws of the bodies remember; of the particles of other bodies zero.
            pub history: Vec<SnapshotColumn>,
        }

        impl ParticleSnapshot {
            /// The columns of every particle that it holds, with the components in space of one particle after the
            /// other.
            pub fn columns(&self) -> impl Iterator<Item = (ColumnDescription, &[f64])> {
                [$((described::<$values>(stringify!($name)), self.$name.flat()),)*].into_iter()
            }

            /// The particles for which a body and a number are wanted.
            pub fn only(&self, wanted: impl Fn(u32, u32) -> bool) -> Self {
                let rows = 0..self.number.len();
                let rows: Vec<usize> = rows.filter(|&i| wanted(self.body[i], self.number[i])).collect();
                self.of_rows(&rows)
            }

            /// Several snapshots of the same bodies, each of other particles, as one: ordered by body and number.
            pub fn merged(parts: Vec<Self>) -> Self {
                let mut parts = parts.into_iter();
                let Some(mut all) = parts.next() else { return ParticleSnapshot::default() };
                for part in parts {
                    all.body.extend(part.body);
                    all.number.extend(part.number);
                    $(all.$name.extend(part.$name);)*
                    for (column, more) in all.history.iter_mut().zip(part.history) {
                        column.values.extend(more.values);
                    }
                }
                let mut rows: Vec<usize> = (0..all.number.len()).collect();
                rows.sort_unstable_by_key(|&i| (all.body[i], all.number[i]));
                // Column by column, so that none is there twice for longer than it takes.
                ParticleSnapshot {
                    dimension: all.dimension,
                    body: picked(all.body, &rows),
                    number: picked(all.number, &rows),
                    $($name: picked(all.$name, &rows),)*
                    history: all.history.into_iter().map(|column| column.only(&rows)).collect(),
                }
            }

            /// The particles in some rows that follow one another.
            pub fn rows(&self, rows: Range<usize>) -> Self {
                self.of_rows(&rows.collect::<Vec<_>>())
            }

            /// The particles in these rows.
            fn of_rows(&self, rows: &[usize]) -> Self {
                ParticleSnapshot {
                    dimension: self.dimension,
                    body: rows.iter().map(|&i| self.body[i]).collect(),
                    number: rows.iter().map(|&i| self.number[i]).collect(),
                    $($name: rows.iter().map(|&i| self.$name[i]).collect(),)*
                    history: self.history.iter().map(|column| column.only(rows)).collect(),
                }
            }

            /// The columns of every particle from where they are, with neither bodies and numbers nor history.
            ///
            /// # Errors
            /// A column that is not there.
            pub fn of_columns<S: ColumnSource>(dimension: usize, source: &S) -> Result<Self, S::Error> {
                Ok(ParticleSnapshot {
                    dimension,
                    $($name: Values::from_source(source, &described::<$values>(stringify!($name)))?,)*
                    ..ParticleSnapshot::default()
                })
            }
        }

        // A column that is not described, or has another number of components, does not compile.
        $(const _: ColumnDescription = described::<$values>(stringify!($name));)*
    };
}

snapshot! {
    /// Position [m].
    position: Vec<[f64; 3]>,
    /// Velocity [m/s].
    velocity: Vec<[f64; 3]>,
    /// Cauchy stress xx, yy, zz, xy, yz, xz, tension positive [Pa].
    stress: Vec<[f64; 6]>,
    /// Deformation gradient, row by row [-].
    deformation: Vec<[f64; 9]>,
    /// Mass [kg].
    mass: Vec<f64>,
    /// Volume now [m^3].
    volume: Vec<f64>,
}

/// The description of a column of every particle with so many components.
const fn described<V: Values>(name: &str) -> ColumnDescription {
    let described = column::every(name);
    assert!(described.kind.components() == V::COMPONENTS, "as many components as its kind has");
    described
}

impl ParticleSnapshot {
    /// The history of this name; `None` where no body's law has it.
    pub fn remembered(&self, name: &str) -> Option<&SnapshotColumn> {
        self.history.iter().find(|column| column.name == name)
    }

    /// What it takes in memory [bytes].
    pub fn bytes(&self) -> usize {
        let history = self.history.iter().map(|column| &column.values[..]);
        let numbers: usize = self.columns().map(|(_, values)| values).chain(history).map(size_of_val).sum();
        numbers + size_of_val(&self.body[..]) + size_of_val(&self.number[..])
    }
}

/// A column of history in a snapshot: what a law calls it, and a value for every particle of all bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SnapshotColumn {
    /// Its name.
    pub name: String,
    /// SI unit; empty for a number without one.
    pub unit: String,
    /// What each particle has.
    pub kind: Kind,
    /// The components in space of one particle after the other.
    #[serde(with = "flat")]
    pub values: Vec<f64>,
}

impl SnapshotColumn {
    fn only(&self, rows: &[usize]) -> Self {
        let count = self.kind.components();
        let values =
            rows.iter().flat_map(|&row| self.values[row * count..][..count].iter().copied()).collect();
        SnapshotColumn { name: self.name.clone(), unit: self.unit.clone(), kind: self.kind, values }
    }

    /// One number for a particle: a number itself, the length of a vector, and of a tensor the root of the sum of its
    /// squared entries (Frobenius).
    pub fn magnitude(&self, particle: usize) -> f64 {
        let count = self.kind.components();
        let values = &self.values[particle * count..][..count];
        let of_squares = |values: &[f64]| values.iter().map(|x| x * x).sum::<f64>();
        match self.kind {
            Kind::Number => values[0],
            // The entries beside the diagonal stand for two each.
            Kind::Symmetric => (of_squares(values) + of_squares(&values[3..])).sqrt(),
            Kind::Vector | Kind::Rotation | Kind::Tensor => of_squares(values).sqrt(),
        }
    }
}
