//! How far points are from a shape, and in which direction.

use super::inside::along_and_across;
use super::rotation::Rotation;
use super::{Shape, polygon};

impl Shape {
    /// Distance from a point to the shape's surface [m], negative inside.
    ///
    /// Exact for simple and turned shapes; of shapes combined, the sign is exact and the magnitude is at most the true one:
    /// `min` over a union, `max` over an intersection. In the plane, a cylinder is infinitely far away.
    pub fn distance(&self, point: [f64; 3], dimension: usize) -> f64 {
        let norm = |values: [f64; 3]| (0..dimension).map(|k| values[k] * values[k]).sum::<f64>().sqrt();
        match self {
            Shape::Ball { center, radius } => norm(std::array::from_fn(|k| point[k] - center[k])) - radius,
            Shape::Box { min, max } => {
                let beyond: [f64; 3] = std::array::from_fn(|k| (min[k] - point[k]).max(point[k] - max[k]));
                let deepest = beyond[..dimension].iter().fold(f64::NEG_INFINITY, |a, &b| a.max(b));
                norm(beyond.map(|b| b.max(0.0))) + deepest.min(0.0)
            }
            Shape::Cylinder { .. } if dimension == 2 => f64::INFINITY,
            Shape::Cylinder { start, end, radius } => {
                let length = norm(std::array::from_fn(|k| end[k] - start[k]));
                let (along, across) = along_and_across(point, *start, *end);
                prism(across - radius, (-along).max(along - 1.0) * length)
            }
            Shape::HalfSpace { point: on, normal } => {
                (0..dimension).map(|k| (point[k] - on[k]) * normal[k]).sum::<f64>() / norm(*normal)
            }
            Shape::Polygon { points, height } => {
                let base = polygon::distance(points, [point[0], point[1]]);
                if dimension == 2 {
                    base
                } else {
                    prism(base, (height[0] - point[2]).max(point[2] - height[1]))
                }
            }
            Shape::Union(shapes) => {
                shapes.iter().map(|shape| shape.distance(point, dimension)).fold(f64::INFINITY, f64::min)
            }
            Shape::Intersection(shapes) => {
                shapes.iter().map(|shape| shape.distance(point, dimension)).fold(f64::NEG_INFINITY, f64::max)
            }
            Shape::Difference(shapes) => shapes.split_first().map_or(f64::INFINITY, |(first, others)| {
                let cut = others.iter().map(|shape| -shape.distance(point, dimension));
                cut.fold(first.distance(point, dimension), f64::max)
            }),
            Shape::Rotated { shape, center, axis, angle } => {
                shape.distance(Rotation::new(*center, *axis, *angle, dimension).back(point), dimension)
            }
        }
    }

    /// Unit vector from a point towards the nearest part of the surface, or away from it for a point inside: minus the
    /// gradient of [`Shape::distance`] by central differences over `step` [m]. `None` where no direction stands out.
    pub fn direction_to(&self, point: [f64; 3], step: f64, dimension: usize) -> Option<[f64; 3]> {
        let mut direction = [0.0; 3];
        for k in 0..dimension {
            let at = |offset: f64| {
                let mut moved = point;
                moved[k] += offset;
                self.distance(moved, dimension)
            };
            direction[k] = (at(-step) - at(step)) / (2.0 * step);
        }
        let norm = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
        // A distance has a gradient of length one; on ridges, where two parts are equally near, it is shorter.
        (norm > 0.9 && norm.is_finite()).then(|| direction.map(|d| d / norm))
    }
}

/// Distance to a prism from the distances to its sides and to its ends.
fn prism(side: f64, end: f64) -> f64 {
    side.max(0.0).hypot(end.max(0.0)) + side.max(end).min(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::inside::tests::any_shape;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_sign_says_inside_and_no_step_outruns_the_distance(
            a in any_shape(),
            b in any_shape(),
            points in prop::array::uniform2(prop::array::uniform3(-2.0..2.0f64)),
            dimension in 2..=3usize,
        ) {
            let pair = vec![a, b];
            for shape in [Shape::Union(pair.clone()), Shape::Intersection(pair.clone()), Shape::Difference(pair)] {
                let [near, far] = points.map(|point| shape.distance(point, dimension));
                if near.abs() > 1e-9 && near.is_finite() {
                    prop_assert_eq!(near < 0.0, shape.contains(points[0], dimension));
                }
                let [p, q] = points;
                let apart = (0..dimension).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
                prop_assert!(!(near - far).is_finite() || (near - far).abs() <= apart + 1e-9);
            }
        }
    }

    #[test]
    fn distances_to_simple_solids_are_exact() {
        let cube = Shape::Box { min: [-1.0; 3], max: [1.0; 3] };
        assert_eq!(cube.distance([4.0, 5.0, 0.0], 3), 5.0);
        assert_eq!(cube.distance([0.5, 0.0, 0.25], 3), -0.5);
        let can = Shape::Cylinder { start: [0.0; 3], end: [0.0, 0.0, 2.0], radius: 1.0 };
        assert_eq!(can.distance([4.0, 0.0, 6.0], 3), 5.0);
        assert_eq!(can.distance([0.0, 0.0, 1.75], 3), -0.25);
        let floor = Shape::HalfSpace { point: [0.0, 1.0, 0.0], normal: [0.0, 3.0, 0.0] };
        assert_eq!(floor.distance([7.0, 3.0, 0.0], 3), 2.0);
    }

    #[test]
    fn the_direction_points_at_the_surface() {
        let floor = Shape::Box { min: [-9.0, -9.0, -1.0], max: [9.0, 9.0, 0.0] };
        let direction = floor.direction_to([1.0, 2.0, 3.0], 1e-6, 3).expect("one face is nearest");
        assert!((direction[2] + 1.0).abs() < 1e-9 && direction[0].abs() < 1e-9, "{direction:?}");
        assert_eq!(Shape::Ball { center: [0.0; 3], radius: 1.0 }.direction_to([0.0; 3], 1e-6, 3), None);
    }
}
