//! A column of a body's particles where it lies in the engine's memory, whatever its precision and dimension.

use crate::column::ColumnDescription;
use crate::particles::by_number;
use std::borrow::Cow;

/// A column of a body's particles: borrowed, and read as f64 in SI units and three dimensions.
///
/// Its rows are in the order of memory, the same for all columns of a body as long as nothing steps. That order changes
/// from step to step; a particle's number never does.
pub struct ColumnRef<'a> {
    /// Name, unit and components.
    pub description: ColumnDescription,
    numbers: Cow<'a, [u32]>,
    at: Box<dyn Fn(usize, usize) -> f64 + 'a>,
}

impl<'a> ColumnRef<'a> {
    /// A column of particles with these numbers, in any order: `at(row, component)` is a component in space.
    pub fn new(
        description: ColumnDescription,
        numbers: impl Into<Cow<'a, [u32]>>,
        at: impl Fn(usize, usize) -> f64 + 'a,
    ) -> Self {
        ColumnRef { description, numbers: numbers.into(), at: Box::new(at) }
    }

    /// Each particle's number in its body, in the order of memory.
    pub fn numbers(&self) -> &[u32] {
        &self.numbers
    }

    /// Particles of the body.
    pub fn len(&self) -> usize {
        self.numbers.len()
    }

    /// Whether the body has none.
    pub fn is_empty(&self) -> bool {
        self.numbers.is_empty()
    }

    /// Each particle's number, and its `N` components in space.
    ///
    /// # Panics
    /// `N` is not what [`Kind::components`](crate::column::Kind::components) says.
    pub fn rows<const N: usize>(&self) -> impl ExactSizeIterator<Item = (u32, [f64; N])> {
        let ColumnDescription { name, kind, .. } = self.description;
        assert_eq!(N, kind.components(), "components of `{name}`, which is a {kind:?}");
        let row = |(row, &number): (usize, &u32)| (number, std::array::from_fn(|k| (self.at)(row, k)));
        self.numbers.iter().enumerate().map(row)
    }

    /// The components in space of one particle after the other, in the order of memory.
    pub fn values(&self) -> Vec<f64> {
        let count = self.description.kind.components();
        (0..self.len()).flat_map(|row| (0..count).map(move |k| (self.at)(row, k))).collect()
    }

    /// The `N` components in space of each particle, in the order of their numbers.
    ///
    /// # Panics
    /// `N` is not what [`Kind::components`](crate::column::Kind::components) says.
    pub fn by_number<const N: usize>(&self) -> Vec<[f64; N]> {
        let mut values = vec![[0.0; N]; self.len()];
        self.copy_to(values.as_flattened_mut());
        values
    }

    /// Writes the components in space of one particle after the other, in the order of their numbers.
    ///
    /// # Panics
    /// There is not room for exactly so many.
    pub fn copy_to(&self, values: &mut [f64]) {
        let count = self.description.kind.components();
        assert_eq!(values.len(), count * self.len(), "room for `{}`", self.description.name);
        for (to, row) in values.chunks_exact_mut(count).zip(by_number(&self.numbers)) {
            to.iter_mut().enumerate().for_each(|(k, x)| *x = (self.at)(row as usize, k));
        }
    }
}

impl std::fmt::Debug for ColumnRef<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{:?} of {} particles", self.description, self.len())
    }
}

/// Values that a column of particles cannot take; then nothing is changed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WriteError {
    /// There is no such column.
    #[error(transparent)]
    Unknown(#[from] NoColumn),
    /// Several ranks share the simulation.
    #[error("several ranks share the simulation; allowed: one that one rank has")]
    Shared,
    /// It follows from others, or the engine relies on it.
    #[error("found `{name}`, which only steps write to; allowed: {}", WRITABLE.join(", "))]
    Fixed {
        /// The column.
        name: String,
    },
    /// The body is on a grid of its own, and its other columns follow from where its nodes are.
    #[error(
        "found `{name}` of body `{body}`, which is on a grid of its own; allowed: velocity; or interior = \"grid\" in \
         [space]"
    )]
    OwnGrid {
        /// The column.
        name: String,
        /// Name of the body.
        body: String,
    },
    /// The body moves as the scene prescribes.
    #[error("body `{body}` is rigid and moves as the scene prescribes; allowed: bodies that forces move")]
    Prescribed {
        /// Name of the body.
        body: String,
    },
    /// The mass of a rigid body is that of the scene.
    #[error("body `{body}` is rigid, and its mass is that of the scene; allowed: velocity, spin")]
    RigidMass {
        /// Name of the body.
        body: String,
    },
    /// Not one value for a rigid body, or one that is not finite.
    #[error(
        "found {found:?} for body `{body}`, which is rigid; allowed: {entries} finite numbers for the whole"
    )]
    Whole {
        /// Name of the body.
        body: String,
        /// What was found.
        found: Vec<f64>,
        /// Entries of its value.
        entries: usize,
    },
    /// Other numbers than the particles have.
    #[error("found {found} values; allowed: {wanted}, {entries} for each particle")]
    Count {
        /// How many were found.
        found: usize,
        /// How many are wanted.
        wanted: usize,
        /// Entries of a particle.
        entries: usize,
    },
    /// A value that no particle may have.
    #[error("found {value} for the particle at {place} in memory; allowed: {allowed}")]
    Value {
        /// Where the particle is in the order of memory.
        place: usize,
        /// What was found.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
}

/// Columns that others than steps may write to, by [`super::Simulation::write`].
pub const WRITABLE: [&str; 3] = ["velocity", "spin", "mass"];

/// A column that particles do not have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("found a column `{name}`, which the particles of the body do not have; allowed: {}", known.join(", "))]
pub struct NoColumn {
    /// What was asked for.
    pub name: String,
    /// What there is.
    pub known: Vec<&'static str>,
}

impl NoColumn {
    /// No column of this name among those there are.
    pub fn among(columns: &[ColumnDescription], name: &str) -> Self {
        NoColumn { name: name.to_string(), known: columns.iter().map(|column| column.name).collect() }
    }
}
