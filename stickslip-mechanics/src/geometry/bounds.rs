//! Boxes that hold shapes.

use super::Shape;
use super::rotation::Rotation;
use serde::Serialize;

/// A box with faces across the axes. In the plane its third component is zero.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bounds {
    /// Lower corner [m].
    pub min: [f64; 3],
    /// Upper corner [m].
    pub max: [f64; 3],
}

impl Bounds {
    /// Holds no point.
    pub const EMPTY: Bounds = Bounds { min: [f64::INFINITY; 3], max: [f64::NEG_INFINITY; 3] };
    /// Holds every point.
    pub const EVERYTHING: Bounds = Bounds { min: [f64::NEG_INFINITY; 3], max: [f64::INFINITY; 3] };

    /// The smallest box that holds all points.
    pub fn around(points: impl IntoIterator<Item = [f64; 3]>) -> Self {
        points
            .into_iter()
            .fold(Bounds::EMPTY, |bounds, point| bounds.united(&Bounds { min: point, max: point }))
    }

    /// Holds no point.
    pub fn is_empty(&self) -> bool {
        (0..3).any(|k| self.min[k] > self.max[k])
    }

    /// The part that both boxes hold.
    pub fn intersected(&self, other: &Bounds) -> Bounds {
        Bounds {
            min: std::array::from_fn(|k| self.min[k].max(other.min[k])),
            max: std::array::from_fn(|k| self.max[k].min(other.max[k])),
        }
    }

    /// The smallest box that holds both boxes.
    pub fn united(&self, other: &Bounds) -> Bounds {
        Bounds {
            min: std::array::from_fn(|k| self.min[k].min(other.min[k])),
            max: std::array::from_fn(|k| self.max[k].max(other.max[k])),
        }
    }

    /// The box with every face moved out by `margin` [m].
    pub fn grown(&self, margin: f64) -> Bounds {
        Bounds { min: self.min.map(|x| x - margin), max: self.max.map(|x| x + margin) }
    }

    /// Whether it reaches to infinity nowhere.
    pub fn is_finite(&self) -> bool {
        self.min.iter().chain(&self.max).all(|x| x.is_finite())
    }

    /// Length of each side [m], zero for an empty box.
    pub fn size(&self) -> [f64; 3] {
        std::array::from_fn(|k| (self.max[k] - self.min[k]).max(0.0))
    }

    /// Its middle [m].
    pub fn middle(&self) -> [f64; 3] {
        std::array::from_fn(|k| 0.5 * (self.min[k] + self.max[k]))
    }

    /// Its corners.
    pub fn corners(&self) -> impl Iterator<Item = [f64; 3]> {
        let sides = [self.min, self.max];
        (0..8usize).map(move |i| std::array::from_fn(|k| sides[i >> k & 1][k]))
    }
}

impl Shape {
    /// A box that holds the shape; `None` where the shape may reach to infinity.
    ///
    /// Exact for all simple shapes; for a turned shape the box of its turned box. A half-space bounds what it is cut
    /// with only where it lies across an axis; empty where nothing can be inside.
    pub fn bounds(&self, dimension: usize) -> Option<Bounds> {
        let mut bounds = self.reach(dimension);
        if bounds.is_empty() {
            return Some(Bounds::EMPTY);
        }
        if dimension == 2 {
            (bounds.min[2], bounds.max[2]) = (0.0, 0.0);
        }
        bounds.is_finite().then_some(bounds)
    }

    /// A point that belongs to the shape, bounded or not: about it a rigid body without bounds turns [m].
    ///
    /// Of a half-space its point, of a ball its centre, of another shape with bounds the middle of its box; of shapes
    /// combined that of the first.
    pub fn anchor(&self, dimension: usize) -> [f64; 3] {
        match self {
            Shape::HalfSpace { point, .. } => *point,
            Shape::Union(shapes) | Shape::Intersection(shapes) | Shape::Difference(shapes) => {
                shapes.first().map_or([0.0; 3], |shape| shape.anchor(dimension))
            }
            Shape::Rotated { shape, center, axis, angle } => {
                Rotation::new(*center, *axis, *angle, dimension).forward(shape.anchor(dimension))
            }
            shape => shape.bounds(dimension).map_or([0.0; 3], |bounds| bounds.middle()),
        }
    }

    /// As [`Shape::bounds`], with infinite sides.
    fn reach(&self, dimension: usize) -> Bounds {
        let flat = |mut bounds: Bounds| {
            if dimension == 2 {
                (bounds.min[2], bounds.max[2]) = (f64::NEG_INFINITY, f64::INFINITY);
            }
            bounds
        };
        match self {
            Shape::Ball { center, radius } => flat(Bounds { min: *center, max: *center }.grown(*radius)),
            Shape::Box { min, max } => flat(Bounds { min: *min, max: *max }),
            Shape::Cylinder { .. } if dimension == 2 => Bounds::EMPTY,
            Shape::Cylinder { start, end, radius } => {
                let axis: [f64; 3] = std::array::from_fn(|k| end[k] - start[k]);
                let squared: f64 = axis.iter().map(|a| a * a).sum();
                // A disk of radius r with unit normal n reaches r sqrt(1 - n_k^2) along axis k.
                let rim = axis.map(|a| radius * (1.0 - a * a / squared).max(0.0).sqrt());
                let ends = Bounds::around([*start, *end]);
                Bounds {
                    min: std::array::from_fn(|k| ends.min[k] - rim[k]),
                    max: std::array::from_fn(|k| ends.max[k] + rim[k]),
                }
            }
            Shape::HalfSpace { point, normal } => {
                let mut bounds = Bounds::EVERYTHING;
                let mut across = (0..dimension).filter(|&k| normal[k] != 0.0);
                if let (Some(k), None) = (across.next(), across.next()) {
                    let side = if normal[k] > 0.0 { &mut bounds.max } else { &mut bounds.min };
                    side[k] = point[k];
                }
                bounds
            }
            Shape::Polygon { points, height } => flat(
                Bounds::around(points.iter().map(|&[x, y]| [x, y, height[0]]))
                    .united(&Bounds::around(points.iter().map(|&[x, y]| [x, y, height[1]]))),
            ),
            Shape::Mesh(_) if dimension == 2 => Bounds::EMPTY,
            Shape::Mesh(mesh) => mesh.bounds(),
            Shape::Revolved(_) if dimension == 2 => Bounds::EMPTY,
            Shape::Revolved(revolved) => revolved.bounds(),
            Shape::Curved(curved) => match curved.solid().bounds(dimension) {
                nowhere if nowhere.is_empty() => Bounds::EMPTY,
                bounds => flat(bounds),
            },
            Shape::Union(shapes) => shapes
                .iter()
                .map(|shape| shape.reach(dimension))
                .filter(|bounds| !bounds.is_empty())
                .fold(Bounds::EMPTY, |all, bounds| all.united(&bounds)),
            Shape::Intersection(shapes) => {
                shapes.iter().fold(Bounds::EVERYTHING, |all, shape| all.intersected(&shape.reach(dimension)))
            }
            Shape::Difference(shapes) => shapes.first().map_or(Bounds::EMPTY, |first| first.reach(dimension)),
            Shape::Rotated { shape, center, axis, angle } => {
                let rotation = Rotation::new(*center, *axis, *angle, dimension);
                match shape.as_ref() {
                    Shape::Ball { center, radius } => {
                        Shape::Ball { center: rotation.forward(*center), radius: *radius }.reach(dimension)
                    }
                    shape => match shape.bounds(dimension) {
                        Some(bounds) if bounds.is_empty() => Bounds::EMPTY,
                        Some(bounds) => {
                            flat(Bounds::around(bounds.corners().map(|corner| rotation.forward(corner))))
                        }
                        None => Bounds::EVERYTHING,
                    },
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::inside::tests::any_shape;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_point_inside_is_within_the_bounds(
            a in any_shape(),
            b in any_shape(),
            point in prop::array::uniform3(-2.0..2.0f64),
            dimension in 2..=3usize,
        ) {
            let pair = vec![a.clone(), b];
            for shape in [a, Shape::Union(pair.clone()), Shape::Intersection(pair.clone()), Shape::Difference(pair)] {
                if let Some(bounds) = shape.bounds(dimension) && shape.contains(point, dimension) {
                    let around = bounds.grown(1e-12);
                    let within = |k: usize| around.min[k] <= point[k] && point[k] <= around.max[k];
                    prop_assert!((0..dimension).all(within));
                }
            }
        }
    }

    #[test]
    fn a_half_space_is_unbounded_alone_and_cuts_what_it_meets() {
        let floor = Shape::HalfSpace { point: [0.0, 0.0, 0.5], normal: [0.0, 0.0, 2.0] };
        let cube = Shape::Box { min: [0.0; 3], max: [1.0; 3] };
        assert_eq!(floor.bounds(3), None);
        assert_eq!(
            Shape::Intersection(vec![cube.clone(), floor.clone()]).bounds(3),
            Some(Bounds { min: [0.0; 3], max: [1.0, 1.0, 0.5] })
        );
        assert_eq!(Shape::Difference(vec![cube.clone(), floor.clone()]).bounds(3), cube.bounds(3));
        assert_eq!(Shape::Union(vec![cube, floor]).bounds(3), None);
    }

    #[test]
    fn half_spaces_across_all_axes_bound_a_box() {
        let cuts = (0..4).map(|i| {
            let mut normal = [0.0; 3];
            normal[i / 2] = if i % 2 == 0 { 1.0 } else { -1.0 };
            Shape::HalfSpace { point: normal, normal }
        });
        let bounds = Shape::Intersection(cuts.collect()).bounds(2);
        assert_eq!(bounds, Some(Bounds { min: [-1.0, -1.0, 0.0], max: [1.0, 1.0, 0.0] }));
    }

    #[test]
    fn shapes_apart_have_an_empty_intersection() {
        let at = |x| Shape::Ball { center: [x, 0.0, 0.0], radius: 0.4 };
        assert_eq!(Shape::Intersection(vec![at(0.0), at(1.0)]).bounds(3), Some(Bounds::EMPTY));
    }

    #[test]
    fn a_turned_square_reaches_its_diagonal_and_a_slanted_cylinder_its_rim() {
        let square = Box::new(Shape::Box { min: [-1.0, -1.0, 0.0], max: [1.0, 1.0, 0.0] });
        let angle = std::f64::consts::FRAC_PI_4;
        let turned = Shape::Rotated { shape: square, center: [0.0; 3], axis: [0.0, 0.0, 1.0], angle };
        let bounds = turned.bounds(2).expect("bounded");
        assert!((bounds.max[0] - 2f64.sqrt()).abs() < 1e-15 && bounds.max[2] == 0.0);
        let slanted = Shape::Cylinder { start: [0.0; 3], end: [1.0, 1.0, 0.0], radius: 1.0 };
        let bounds = slanted.bounds(3).expect("bounded");
        assert!((bounds.max[0] - (1.0 + 0.5f64.sqrt())).abs() < 1e-15 && bounds.max[2] == 1.0);
    }
}
