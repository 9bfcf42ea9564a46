//! A file of particles, opened: who needs few of its columns reads those, one by one.

use super::file::ReadError;
use super::particles::particles_of;
use super::vtk::PointArrays;
use crate::column::{DERIVED, EVERY, IDENTITY, Kind};
use crate::door::{ParticleSnapshot, SnapshotColumn};
use std::path::Path;

/// A file that [`encode_particles`](super::encode_particles) made. Its columns are unpacked when asked for.
pub struct ParticleFile(PointArrays);

/// What a column of a file holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileColumn {
    /// One word.
    pub name: String,
    /// SI unit; empty for a number without one.
    pub unit: String,
    /// What a particle has in it.
    pub kind: Kind,
}

impl ParticleFile {
    /// Reads the packed bytes of a file, and what they hold.
    ///
    /// # Errors
    /// The file is missing, or was written by another program.
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        Ok(ParticleFile(PointArrays::open(path)?))
    }

    /// Reads what a file holds, but no column.
    ///
    /// # Errors
    /// As [`ParticleFile::open`].
    pub fn open_head(path: &Path) -> Result<Self, ReadError> {
        Ok(ParticleFile(PointArrays::open_head(path)?))
    }

    /// The particles of one of its pieces, see [`encode_particles`](super::encode_particles), whose packed bytes are
    /// read.
    ///
    /// # Errors
    /// As [`ParticleFile::open`], or there is no such piece.
    pub fn piece(&self, piece: usize) -> Result<Self, ReadError> {
        Ok(ParticleFile(self.0.piece(piece)?))
    }

    /// All that it holds, see [`read_particles`](super::read_particles).
    pub(super) fn snapshot(&self) -> Result<ParticleSnapshot, ReadError> {
        particles_of(&self.0)
    }

    /// How many pieces it has.
    pub fn pieces(&self) -> usize {
        self.0.pieces()
    }

    /// How many particles it holds.
    pub fn particles(&self) -> usize {
        self.0.count()
    }

    /// Its columns beside places, bodies and numbers, in the order of the file.
    pub fn columns(&self) -> impl Iterator<Item = FileColumn> {
        let held = self.0.names().filter(|name| !IDENTITY.contains(name));
        held.filter_map(|name| {
            let (unit, kind) = self.0.description(name)?;
            let known = EVERY.iter().chain(DERIVED.iter().map(|derived| &derived.column));
            let known = known.into_iter().find(|known| known.name == name);
            let unit = known.map_or(unit, |known| known.unit);
            Some(FileColumn { name: name.to_string(), unit: unit.to_string(), kind })
        })
    }

    /// Where the particles are [m].
    ///
    /// # Errors
    /// The file is cut short; so for the other columns.
    pub fn positions(&self) -> Result<Vec<[f64; 3]>, ReadError> {
        self.0.positions()
    }

    /// Whose they are: the body's place in the scene.
    ///
    /// # Errors
    /// The file is cut short.
    pub fn bodies(&self) -> Result<Vec<u32>, ReadError> {
        Ok(self.0.whole::<i32>(IDENTITY[0])?.into_iter().map(|body| body as u32).collect())
    }

    /// Their numbers in their bodies.
    ///
    /// # Errors
    /// The file is cut short.
    pub fn numbers(&self) -> Result<Vec<u32>, ReadError> {
        self.0.whole(IDENTITY[1])
    }

    /// A column with its values, those of one particle after the other.
    ///
    /// # Errors
    /// There is no such column, or the file is cut short.
    pub fn column(&self, FileColumn { name, unit, kind }: FileColumn) -> Result<SnapshotColumn, ReadError> {
        let (_, _, values) = self.0.described(&name)?;
        Ok(SnapshotColumn { name, unit, kind, values })
    }
}
