//! What a column of particles holds: a name, a unit and its components.
//!
//! Memory, packing for lanes, snapshots, files and colours follow from this description; none lists columns by hand.

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

/// What a particle has in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
