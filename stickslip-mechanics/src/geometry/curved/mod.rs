//! Shapes with curved surfaces, a file each: what they say of themselves, and the list of them.

mod capsule;
mod ellipsoid;
mod rounded_box;
mod superquadric;
mod torus;

pub use capsule::Capsule;
pub use ellipsoid::Ellipsoid;
pub use rounded_box::RoundedBox;
pub use superquadric::{MOST_EXPONENT, Superquadric};
pub use torus::Torus;

use super::distance::SignedDistance;
use super::{Bounds, ImagePart, PointCloud, Shape};
use serde::Serialize;

/// A shape with a curved surface.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Curved {
    /// An ellipsoid; in the plane, an ellipse.
    Ellipsoid(Ellipsoid),
    /// A superquadric; in the plane, a superellipse.
    Superquadric(Superquadric),
    /// All points near a line between two points.
    Capsule(Capsule),
    /// A torus; three dimensions only.
    Torus(Torus),
    /// A box with rounded edges and corners.
    RoundedBox(RoundedBox),
    /// A part of an image.
    Image(ImagePart),
    /// What given particles fill.
    PointCloud(PointCloud),
}

/// What such a shape says of itself. In the plane, only the first two coordinates count.
pub(super) trait Solid {
    /// Signed distance to the surface and its gradient.
    fn level(&self, point: [f64; 3], dimension: usize) -> SignedDistance;
    /// A box that holds it [m].
    fn bounds(&self, dimension: usize) -> Bounds;
    /// Volume [m^3], in the plane area [m^2], where a closed form exists.
    fn volume(&self, dimension: usize) -> Option<f64>;
    /// It `factor` times as large, with its points where `place` puts them [m].
    fn copied(&self, factor: f64, place: &dyn Fn([f64; 3]) -> [f64; 3]) -> Curved;
    /// What is wrong with it: the key, what was found and what is allowed.
    fn fault(&self, dimension: usize) -> Option<(&'static str, String, &'static str)>;
}

impl Curved {
    pub(super) fn solid(&self) -> &dyn Solid {
        match self {
            Curved::Ellipsoid(solid) => solid,
            Curved::Superquadric(solid) => solid,
            Curved::Capsule(solid) => solid,
            Curved::Torus(solid) => solid,
            Curved::RoundedBox(solid) => solid,
            Curved::Image(solid) => solid,
            Curved::PointCloud(solid) => solid,
        }
    }

    /// Its key in a scene file.
    pub fn word(&self) -> &'static str {
        match self {
            Curved::Ellipsoid(_) => "ellipsoid",
            Curved::Superquadric(_) => "superquadric",
            Curved::Capsule(_) => "capsule",
            Curved::Torus(_) => "torus",
            Curved::RoundedBox(_) => "rounded_box",
            Curved::Image(_) => "image",
            Curved::PointCloud(_) => "point_cloud",
        }
    }

    /// What is wrong with it, if anything: the key within the shape, what was found and what is allowed.
    pub fn fault(&self, dimension: usize) -> Option<(&'static str, String, &'static str)> {
        self.solid().fault(dimension)
    }
}

impl From<Curved> for Shape {
    fn from(curved: Curved) -> Self {
        Shape::Curved(curved)
    }
}

/// The fault of a length that is none.
fn length_fault(key: &'static str, length: f64) -> Option<(&'static str, String, &'static str)> {
    let fine = length > 0.0 && length.is_finite();
    (!fine).then(|| (key, format!("{length} m"), "a finite number above 0"))
}

/// The fault of a point that is nowhere.
fn point_fault(key: &'static str, point: &[f64; 3]) -> Option<(&'static str, String, &'static str)> {
    let fine = point.iter().all(|x| x.is_finite());
    (!fine).then(|| (key, format!("{point:?}"), "finite numbers"))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::geometry::zero_level;
    use crate::tensor::Vector;
    use proptest::prelude::*;

    /// One of each.
    pub fn any_curved() -> impl Strategy<Value = Shape> {
        let point = || prop::array::uniform3(-1.0..1.0f64);
        let sizes = || prop::array::uniform3(0.2..1.5f64);
        let exponents = || prop::array::uniform2(2.0..8.0f64);
        prop_oneof![
            (point(), sizes()).prop_map(|(center, semi_axes)| Shape::ellipsoid(center, semi_axes)),
            (point(), sizes(), exponents())
                .prop_map(|(center, semi_axes, exponents)| Shape::superquadric(center, semi_axes, exponents)),
            (point(), point(), 0.1..0.8f64)
                .prop_map(|(start, end, radius)| Shape::capsule(start, end, radius)),
            (point(), sizes(), 0.2..0.9f64).prop_map(|(center, axis, part)| Shape::torus(
                center,
                axis,
                [0.8, 0.8 * part]
            )),
            (point(), sizes(), 0.05..1.0f64).prop_map(|(min, size, part)| {
                let shortest = size.into_iter().fold(f64::INFINITY, f64::min);
                let max = std::array::from_fn(|k| min[k] + size[k]);
                Shape::rounded_box((min, max), 0.5 * part * shortest)
            }),
        ]
    }

    fn apart(a: [f64; 3], b: [f64; 3], dimension: usize) -> f64 {
        (0..dimension).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
    }

    proptest! {
        /// One step along the gradient by the distance ends on the surface, whose normal is the gradient.
        #[test]
        fn the_distance_leads_to_the_surface(
            shape in any_curved(),
            point in prop::array::uniform3(-2.0..2.0f64),
            dimension in 2..=3usize,
        ) {
            let level = shape.level(point, dimension);
            prop_assume!(level.distance.is_finite() && level.gradient != [0.0; 3]);
            let foot: [f64; 3] = std::array::from_fn(|k| point[k] - level.distance * level.gradient[k]);
            let there = shape.level(foot, dimension);
            prop_assert!(there.distance.abs() < 1e-9, "{shape:?} {level:?} {there:?}");
            let turn = Vector(there.gradient).dot(Vector(level.gradient));
            prop_assert!((turn - 1.0).abs() < 1e-6, "{shape:?} {level:?} {there:?}");
        }

        /// No point of the surface is nearer than the distance, by looking at many of them.
        #[test]
        fn no_point_of_the_surface_is_nearer(
            shape in any_curved(),
            point in prop::array::uniform3(-1.5..1.5f64),
            dimension in 2..=3usize,
        ) {
            let Some(bounds) = shape.bounds(dimension).filter(|bounds| !bounds.is_empty()) else { return Ok(()) };
            let spacing = Vector(bounds.size()).norm() / 12.0;
            let nearest = zero_level::pieces(&|x| shape.level(x, dimension), &bounds, spacing, dimension)
                .into_iter()
                .map(|piece| apart(piece.position, point, dimension))
                .fold(f64::INFINITY, f64::min);
            let distance = shape.level(point, dimension).distance.abs();
            prop_assert!(nearest > distance - 1e-6, "{shape:?}: {nearest} {distance}");
        }
    }

    /// The volume that the surface encloses is the one of the closed form.
    #[test]
    fn surfaces_hold_the_volumes() {
        let all = [
            Shape::ellipsoid([0.1, 0.2, -0.1], [0.9, 0.5, 0.6]),
            Shape::superquadric([0.1, 0.2, -0.1], [0.9, 0.5, 0.6], [3.0, 5.0]),
            Shape::superquadric([0.0; 3], [0.4, 0.5, 0.6], [6.0, 2.0]),
            Shape::capsule([-0.3, 0.1, 0.0], [0.4, 0.3, 0.2], 0.35),
            Shape::torus([0.1; 3], [1.0, 0.5, 2.0], [0.7, 0.25]),
            Shape::rounded_box(([-0.5, -0.4, -0.3], [0.6, 0.4, 0.5]), 0.2),
        ];
        for (shape, dimension) in all.iter().flat_map(|shape| [(shape, 2), (shape, 3)]) {
            let Some(exact) = shape.volume(dimension) else { continue };
            let bounds = shape.bounds(dimension).expect("bounded");
            let (mut volume, mut sum) = (0.0, Vector([0.0; 3]));
            for piece in shape.surface(0.04, dimension, &bounds) {
                let area = Vector(piece.normal) * piece.area;
                sum += area;
                volume += area.dot(Vector(piece.position)) / dimension as f64;
            }
            assert!((volume / exact - 1.0).abs() < 4e-3, "{shape:?} in {dimension}: {volume} for {exact}");
            assert!(sum.norm() < 1e-9, "{shape:?} in {dimension}: {sum:?}");
        }
    }
}
