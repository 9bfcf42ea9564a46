//! Surfaces of bodies: of the undeformed shape, as the scene knows it, and carried along by the particles; and as a
//! model for other programs.

mod carried;
pub mod model;
mod palette;
mod skin;

pub use carried::CarriedSkin;
pub use palette::body_color;
pub use skin::Skin;

use crate::tensor::{Vector, cross};

/// Outward unit normals at the corners of triangles, which are counterclockwise seen from outside: those of the
/// triangles around, by their areas. Zero where these have none.
pub fn normals(corners: &[Vector<f64, 3>], triangles: &[[u32; 3]]) -> Vec<Vector<f64, 3>> {
    let mut sums = vec![Vector::ZERO; corners.len()];
    for triangle in triangles {
        let area = area(triangle.map(|corner| corners[corner as usize]));
        triangle.iter().for_each(|&corner| sums[corner as usize] += area);
    }
    sums.into_iter().map(|sum: Vector<f64, 3>| sum.direction().unwrap_or(Vector::ZERO)).collect()
}

/// Twice a triangle's area along its normal [m^2].
pub fn area([a, b, c]: [Vector<f64, 3>; 3]) -> Vector<f64, 3> {
    Vector(cross((b - a).0, (c - a).0))
}
