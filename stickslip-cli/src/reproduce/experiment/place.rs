//! Where the disks lie, and what the paper says of its pictures of them.

use crate::reproduce::case::PaperScene;
use crate::reproduce::disks::{ARRANGEMENTS, DiskArrangement};

/// Disks in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Four in a row.
    Row,
    /// Five in a zig-zag that slide on each other.
    Sliding,
    /// The same glued as in the paper's simulation, wherever their particles share nodes of the grid.
    Glued,
    /// The same glued by strips of stated width.
    Strips,
    /// Four in a row that touch over flats.
    Flats,
    /// Five in a zig-zag that slide on flats.
    SlidingFlats,
}

impl Place {
    /// All.
    #[cfg(test)]
    pub const ALL: [Place; 6] =
        [Place::Row, Place::Sliding, Place::Glued, Place::Strips, Place::Flats, Place::SlidingFlats];
    /// The three of the paper's simulation.
    pub const PAPER: [Place; 3] = [Place::Row, Place::Sliding, Place::Glued];
    /// The three of the experiment as far as it is known.
    pub const KNOWN: [Place; 3] = [Place::Row, Place::Sliding, Place::Strips];

    pub fn scene(self) -> PaperScene {
        match self {
            Place::Row => PaperScene::PLEXIGLAS_ROW,
            Place::Sliding => PaperScene::PLEXIGLAS_SLIDING,
            Place::Glued => PaperScene::PLEXIGLAS_GLUED,
            Place::Strips => PaperScene::PLEXIGLAS_STRIPS,
            Place::Flats => PaperScene::PLEXIGLAS_FLATS,
            Place::SlidingFlats => PaperScene::PLEXIGLAS_SLIDING_FLATS,
        }
    }

    /// Which of the paper's arrangements it is.
    pub fn arrangement_index(self) -> usize {
        match self {
            Place::Row | Place::Flats => 0,
            Place::Sliding | Place::SlidingFlats => 1,
            Place::Glued | Place::Strips => 2,
        }
    }

    /// How many disks there are.
    pub fn disks(self) -> usize {
        if self.arrangement_index() == 0 { 4 } else { 5 }
    }

    /// What the paper says of it.
    pub fn arrangement(self) -> &'static DiskArrangement {
        &ARRANGEMENTS[self.arrangement_index()]
    }
}
