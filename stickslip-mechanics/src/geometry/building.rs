//! Shapes in code.

use super::{Capsule, Curved, Ellipsoid, Revolved, RoundedBox, Shape, Superquadric, Torus};
use crate::tensor::Vector;

impl Shape {
    /// A ball [m].
    pub fn ball(center: [f64; 3], radius: f64) -> Self {
        Shape::Ball { center, radius }
    }

    /// A ball of plane scenes [m].
    pub fn disk([x, y]: [f64; 2], radius: f64) -> Self {
        Shape::Ball { center: [x, y, 0.0], radius }
    }

    /// A box with faces across the axes, between its lower and its upper corner [m].
    pub fn cuboid(min: [f64; 3], max: [f64; 3]) -> Self {
        Shape::Box { min, max }
    }

    /// A box of plane scenes, between its lower and its upper corner [m].
    pub fn rectangle([x, y]: [f64; 2], [right, top]: [f64; 2]) -> Self {
        Shape::Box { min: [x, y, 0.0], max: [right, top, 0.0] }
    }

    /// All points behind the plane through `point` [m] with this outward normal of any length.
    pub fn half_space(point: [f64; 3], normal: [f64; 3]) -> Self {
        Shape::HalfSpace { point, normal }
    }

    /// An ellipsoid with axes along those of space [m]; in the plane an ellipse.
    pub fn ellipsoid(center: [f64; 3], semi_axes: [f64; 3]) -> Self {
        Curved::Ellipsoid(Ellipsoid { center, semi_axes }).into()
    }

    /// A superquadric [m]; see [`Superquadric`].
    pub fn superquadric(center: [f64; 3], semi_axes: [f64; 3], exponents: [f64; 2]) -> Self {
        Curved::Superquadric(Superquadric { center, semi_axes, exponents }).into()
    }

    /// All points within `radius` of the line between two points [m].
    pub fn capsule(start: [f64; 3], end: [f64; 3], radius: f64) -> Self {
        Curved::Capsule(Capsule { start, end, radius }).into()
    }

    /// A torus around an axis of any length through its centre, with the radii of its circle and of its tube [m].
    pub fn torus(center: [f64; 3], axis: [f64; 3], [radius, tube_radius]: [f64; 2]) -> Self {
        Curved::Torus(Torus { center, axis, radius, tube_radius }).into()
    }

    /// A box between two corners whose edges and corners have a radius [m].
    pub fn rounded_box((min, max): ([f64; 3], [f64; 3]), rounding: f64) -> Self {
        Curved::RoundedBox(RoundedBox { min, max, rounding }).into()
    }

    /// What a polygon sweeps that is turned around an axis of any length through `center` [m]; its corners are
    /// distances from the axis and places along it from the centre.
    pub fn revolved(points: Vec<[f64; 2]>, center: [f64; 3], axis: [f64; 3]) -> Self {
        Shape::Revolved(Revolved { points: points.into(), center, axis })
    }

    /// A cone between the centres of its ends, with the radius of each, one of which may be 0 [m]; space only.
    pub fn cone(start: [f64; 3], end: [f64; 3], [start_radius, end_radius]: [f64; 2]) -> Self {
        let axis: [f64; 3] = std::array::from_fn(|k| end[k] - start[k]);
        let length = Vector(axis).norm();
        let points = vec![[0.0, 0.0], [start_radius, 0.0], [end_radius, length], [0.0, length]];
        Shape::revolved(points, start, axis)
    }

    /// A disk with a hole, in plane scenes [m].
    pub fn ring(center: [f64; 2], [inner_radius, outer_radius]: [f64; 2]) -> Self {
        Shape::disk(center, outer_radius).without(Shape::disk(center, inner_radius))
    }

    /// A cylinder with a bore, of this width about its centre along an axis of any length [m]; space only.
    pub fn tube(center: [f64; 3], axis: [f64; 3], ([inner, outer], width): ([f64; 2], f64)) -> Self {
        let half = 0.5 * width;
        Shape::revolved(vec![[inner, -half], [outer, -half], [outer, half], [inner, half]], center, axis)
    }

    /// The shape turned by `angle` [rad], right-handed, about an axis through `center` [m]; in the plane the axis is
    /// (0, 0, 1).
    pub fn rotated(self, center: [f64; 3], axis: [f64; 3], angle: f64) -> Self {
        Shape::Rotated { shape: Box::new(self), center, axis, angle }
    }

    /// Points in both shapes.
    pub fn and(self, other: Shape) -> Self {
        Shape::Intersection(vec![self, other])
    }

    /// Points in either shape.
    pub fn or(self, other: Shape) -> Self {
        Shape::Union(vec![self, other])
    }

    /// Points in this shape and not in the other.
    pub fn without(self, other: Shape) -> Self {
        Shape::Difference(vec![self, other])
    }

    /// The shape made `factor` times as large, and moved so that the point `from` [m] comes to lie at `to` [m].
    pub fn copied(&self, factor: f64, from: [f64; 3], to: [f64; 3]) -> Shape {
        let point = |x: [f64; 3]| -> [f64; 3] { std::array::from_fn(|k| to[k] + factor * (x[k] - from[k])) };
        let all = |shapes: &[Shape]| shapes.iter().map(|shape| shape.copied(factor, from, to)).collect();
        match self {
            Shape::Ball { center, radius } => Shape::Ball { center: point(*center), radius: factor * radius },
            Shape::Box { min, max } => Shape::Box { min: point(*min), max: point(*max) },
            Shape::Cylinder { start, end, radius } => {
                Shape::Cylinder { start: point(*start), end: point(*end), radius: factor * radius }
            }
            Shape::HalfSpace { point: on, normal } => Shape::HalfSpace { point: point(*on), normal: *normal },
            Shape::Polygon { points, height } => {
                let moved = |x: f64, k: usize| to[k] + factor * (x - from[k]);
                Shape::Polygon {
                    points: points.iter().map(|&[x, y]| [moved(x, 0), moved(y, 1)]).collect(),
                    height: height.map(|z| moved(z, 2)),
                }
            }
            Shape::Mesh(mesh) => Shape::Mesh(mesh.copied(point)),
            Shape::Revolved(revolved) => Shape::Revolved(revolved.copied(factor, point)),
            Shape::Curved(curved) => Shape::Curved(curved.solid().copied(factor, &point)),
            Shape::Union(shapes) => Shape::Union(all(shapes)),
            Shape::Intersection(shapes) => Shape::Intersection(all(shapes)),
            Shape::Difference(shapes) => Shape::Difference(all(shapes)),
            Shape::Rotated { shape, center, axis, angle } => {
                shape.copied(factor, from, to).rotated(point(*center), *axis, *angle)
            }
        }
    }
}
