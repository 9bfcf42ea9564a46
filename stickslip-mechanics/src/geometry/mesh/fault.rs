//! Triangles that are no closed surface.

use std::fmt::{self, Display, Formatter};

/// Why triangles bound no solid. Places are in the units of the triangles.
#[derive(Clone, Debug, PartialEq)]
pub enum MeshFault {
    /// No triangle.
    Empty,
    /// Triangles without area, so without a normal.
    Flat {
        /// How many.
        count: usize,
        /// The middle of the first.
        near: [f64; 3],
    },
    /// Edges with a triangle on one side only: there are holes.
    Open {
        /// How many.
        count: usize,
        /// The middle of the first.
        near: [f64; 3],
    },
    /// Edges whose triangles face opposite ways, or with more than two triangles.
    Crossed {
        /// How many.
        count: usize,
        /// The middle of the first.
        near: [f64; 3],
    },
    /// All triangles face inward, or the volume is nothing.
    InsideOut {
        /// The volume, which is not positive.
        volume: f64,
    },
}

impl Display for MeshFault {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let many =
            |count: usize, one: &str| if count == 1 { format!("1 {one}") } else { format!("{count} {one}s") };
        let place = |[x, y, z]: &[f64; 3]| format!("({}, {}, {})", *x as f32, *y as f32, *z as f32);
        match self {
            MeshFault::Empty => write!(f, "no triangle"),
            MeshFault::Flat { count, near } => {
                write!(f, "{} without area, the first near {}", many(*count, "triangle"), place(near))
            }
            MeshFault::Open { count, near } => {
                write!(
                    f,
                    "a surface with holes: {}, the first near {}",
                    many(*count, "open edge"),
                    place(near)
                )
            }
            MeshFault::Crossed { count, near } => write!(
                f,
                "{} where triangles face opposite ways or are more than two, the first near {}",
                many(*count, "edge"),
                place(near)
            ),
            MeshFault::InsideOut { volume } => write!(f, "a surface inside out: its volume is {volume:.4e}"),
        }
    }
}

impl MeshFault {
    /// What to try.
    pub fn advice(&self) -> &'static str {
        match self {
            MeshFault::Empty => {
                "is it a mesh? only triangles and polygons count, no lines, points or curved surfaces"
            }
            MeshFault::Flat { .. } => "clean the mesh: merge close corners and remove triangles without area",
            MeshFault::Open { .. } => "fill the holes, and merge corners that are meant to be one",
            MeshFault::Crossed { .. } => {
                "let all triangles face outward, and keep parts that touch in edges apart"
            }
            MeshFault::InsideOut { .. } => {
                "flip the triangles: seen from outside, corners go round counterclockwise"
            }
        }
    }
}
