//! How far points are from a shape, and in which direction.

use super::Shape;
use super::inside::along_and_across;
use super::rotation::Rotation;

/// How far a point is from a surface, and which way leads out fastest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignedDistance {
    /// Distance to the surface [m], negative inside.
    pub distance: f64,
    /// Its gradient, a unit vector; zero where no direction stands out, as at the centre of a ball [-].
    pub gradient: [f64; 3],
}

impl SignedDistance {
    /// Far outside of everything.
    pub(super) const NOWHERE: SignedDistance = SignedDistance { distance: f64::INFINITY, gradient: [0.0; 3] };
    /// Deep inside of everything.
    pub(super) const EVERYWHERE: SignedDistance =
        SignedDistance { distance: f64::NEG_INFINITY, gradient: [0.0; 3] };

    fn new(distance: f64, gradient: [f64; 3]) -> Self {
        SignedDistance { distance, gradient }
    }

    /// Of the part that is in both.
    fn intersected(self, other: SignedDistance) -> SignedDistance {
        if other.distance > self.distance { other } else { self }
    }

    /// Of the part that is in either.
    fn united(self, other: SignedDistance) -> SignedDistance {
        if other.distance < self.distance { other } else { self }
    }

    /// Of what the shape leaves.
    fn complement(self) -> SignedDistance {
        SignedDistance { distance: -self.distance, gradient: self.gradient.map(|g| -g) }
    }

    /// Of the part that is in both of two solids with faces at right angles, exactly.
    pub(super) fn square(self, other: SignedDistance) -> SignedDistance {
        if self.distance <= 0.0 || other.distance <= 0.0 {
            return self.intersected(other);
        }
        let distance = self.distance.hypot(other.distance);
        let along = |k: usize| self.gradient[k] * self.distance + other.gradient[k] * other.distance;
        SignedDistance { distance, gradient: std::array::from_fn(|k| along(k) / distance) }
    }
}

impl Shape {
    /// Where a turn about an axis by an angle, as of [`Shape::Rotated`], takes a point [m].
    pub fn turned_point(
        point: [f64; 3],
        (center, axis, angle): ([f64; 3], [f64; 3], f64),
        dimension: usize,
    ) -> [f64; 3] {
        Rotation::new(center, axis, angle, dimension).forward(point)
    }

    /// Distance from a point to the shape's surface [m], negative inside; see [`Shape::level`].
    pub fn distance(&self, point: [f64; 3], dimension: usize) -> f64 {
        self.level(point, dimension).distance
    }

    /// Signed distance from a point to the shape's surface and its gradient.
    ///
    /// Exact for simple and turned shapes; of shapes combined, the sign is exact and the magnitude is at most the true
    /// one: `min` over a union, `max` over an intersection. In the plane, what is of space
    /// only is infinitely far away.
    pub fn level(&self, point: [f64; 3], dimension: usize) -> SignedDistance {
        match self {
            Shape::Ball { center, radius } => {
                let arm = std::array::from_fn(|k| if k < dimension { point[k] - center[k] } else { 0.0 });
                let length = norm(arm);
                let gradient = if length > 0.0 { arm.map(|a| a / length) } else { [0.0; 3] };
                SignedDistance::new(length - radius, gradient)
            }
            Shape::Box { min, max } => (0..dimension)
                .map(|k| slab(k, [min[k], max[k]], point[k]))
                .fold(SignedDistance::EVERYWHERE, SignedDistance::square),
            Shape::Cylinder { .. } if dimension == 2 => SignedDistance::NOWHERE,
            Shape::Cylinder { start, end, radius } => {
                let axis: [f64; 3] = std::array::from_fn(|k| end[k] - start[k]);
                let length = norm(axis);
                let (along, across) = along_and_across(point, *start, *end);
                let from_axis: [f64; 3] = std::array::from_fn(|k| point[k] - start[k] - along * axis[k]);
                let outward = if across > 0.0 { from_axis.map(|a| a / across) } else { [0.0; 3] };
                let (beyond, sign) = if along > 0.5 { (along - 1.0, 1.0) } else { (-along, -1.0) };
                SignedDistance::new(across - radius, outward)
                    .square(SignedDistance::new(beyond * length, axis.map(|a| sign * a / length)))
            }
            Shape::HalfSpace { point: on, normal } => {
                let normal = std::array::from_fn(|k| if k < dimension { normal[k] } else { 0.0 });
                let gradient = normal.map(|n| n / norm(normal));
                SignedDistance::new((0..dimension).map(|k| (point[k] - on[k]) * gradient[k]).sum(), gradient)
            }
            Shape::Polygon { points, height } => {
                let (distance, [x, y]) = points.distance([point[0], point[1]]);
                let base = SignedDistance::new(distance, [x, y, 0.0]);
                if dimension == 2 { base } else { base.square(slab(2, *height, point[2])) }
            }
            Shape::Mesh(_) if dimension == 2 => SignedDistance::NOWHERE,
            Shape::Mesh(mesh) => mesh.level(point),
            Shape::Revolved(_) if dimension == 2 => SignedDistance::NOWHERE,
            Shape::Revolved(revolved) => revolved.level(point),
            Shape::Curved(curved) => curved.solid().level(point, dimension),
            Shape::Union(shapes) => shapes
                .iter()
                .map(|shape| shape.level(point, dimension))
                .fold(SignedDistance::NOWHERE, SignedDistance::united),
            Shape::Intersection(shapes) => (shapes.iter())
                .map(|shape| shape.level(point, dimension))
                .fold(SignedDistance::EVERYWHERE, SignedDistance::intersected),
            Shape::Difference(shapes) => {
                shapes.split_first().map_or(SignedDistance::NOWHERE, |(first, others)| {
                    let cut = others.iter().map(|shape| shape.level(point, dimension).complement());
                    cut.fold(first.level(point, dimension), SignedDistance::intersected)
                })
            }
            Shape::Rotated { shape, center, axis, angle } => {
                let rotation = Rotation::new(*center, *axis, *angle, dimension);
                let level = shape.level(rotation.back(point), dimension);
                SignedDistance { gradient: rotation.turned(level.gradient), ..level }
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

/// What lies between two faces across an axis.
pub(super) fn slab(axis: usize, [low, high]: [f64; 2], x: f64) -> SignedDistance {
    let (distance, sign) = if low - x > x - high { (low - x, -1.0) } else { (x - high, 1.0) };
    let mut gradient = [0.0; 3];
    gradient[axis] = sign;
    SignedDistance { distance, gradient }
}

fn norm(a: [f64; 3]) -> f64 {
    a.iter().map(|a| a * a).sum::<f64>().sqrt()
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

    proptest! {
        /// On edges and ridges no gradient exists: where the two differences disagree, the point is left out.
        #[test]
        fn the_gradient_is_the_slope_of_the_distance(
            a in any_shape(),
            b in any_shape(),
            point in prop::array::uniform3(-2.0..2.0f64),
            dimension in 2..=3usize,
        ) {
            let pair = vec![a, b];
            for shape in [Shape::Union(pair.clone()), Shape::Intersection(pair.clone()), Shape::Difference(pair)] {
                let level = shape.level(point, dimension);
                prop_assume!(level.distance.is_finite());
                prop_assert!(norm(level.gradient) == 0.0 || (norm(level.gradient) - 1.0).abs() < 1e-12);
                for k in 0..dimension {
                    let at = |offset: f64| {
                        let mut moved = point;
                        moved[k] += offset;
                        shape.distance(moved, dimension)
                    };
                    let step = 1e-6;
                    let [back, ahead] = [(level.distance - at(-step)) / step, (at(step) - level.distance) / step];
                    if (back - ahead).abs() < 1e-4 && level.distance.abs() > 1e-4 {
                        prop_assert!((0.5 * (back + ahead) - level.gradient[k]).abs() < 1e-4, "{shape:?} {level:?}");
                    }
                }
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
