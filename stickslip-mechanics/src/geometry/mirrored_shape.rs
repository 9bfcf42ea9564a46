//! A shape together with its images: a face that lies on a mirror, or where the shape is joined to itself a period
//! further, is no surface.

use super::Bounds;
use super::rotation::Rotation;
use super::{Shape, SignedDistance};

/// A mirror across an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror {
    /// Axis across the mirror.
    pub axis: usize,
    /// Where it stands along the axis [m].
    pub position: f64,
    /// Which way the shape lies: 1 above, -1 below.
    pub inward: f64,
}

/// A shape and its images in mirrors.
#[derive(Clone, Debug, PartialEq)]
pub struct MirroredShape {
    /// The shape, continued through the mirrors where it ends on them.
    shape: Shape,
    mirrors: Vec<Mirror>,
    /// Axes along which it repeats, and its two ends there [m].
    repeats: Vec<(usize, [f64; 2])>,
    dimension: usize,
}

impl MirroredShape {
    /// A shape before mirrors.
    ///
    /// Faces on a mirror are left out of half-spaces, boxes, cylinders, polygons, revolved ones too, and meshes, also
    /// where these are combined; of shapes that are turned about another axis than the mirror's only out of half-spaces
    /// and meshes.
    pub fn new(shape: &Shape, mirrors: Vec<Mirror>, dimension: usize) -> Self {
        let shape = mirrors.iter().fold(shape.clone(), |shape, mirror| continued(shape, mirror, dimension));
        MirroredShape { shape, mirrors, repeats: Vec::new(), dimension }
    }

    /// The same, joined to itself at its two ends along an axis [m]: it has no end there. Between two images it goes
    /// straight on, as at a mirror.
    pub fn joined(mut self, axis: usize, ends: [f64; 2]) -> Self {
        for (position, inward) in ends.into_iter().zip([1.0, -1.0]) {
            self.shape = continued(self.shape, &Mirror { axis, position, inward }, self.dimension);
        }
        self.repeats.push((axis, ends));
        self
    }

    /// The shape without its images.
    pub fn half(&self) -> &Shape {
        &self.shape
    }

    /// A box that holds it; `None` of one without bounds, or with images.
    pub fn bounds(&self) -> Option<Bounds> {
        let alone = self.mirrors.is_empty() && self.repeats.is_empty();
        self.shape.bounds(self.dimension).filter(|_| alone)
    }

    /// A box that holds the shape as it is continued, without images; `None` of one without bounds.
    pub fn bounds_of_one(&self) -> Option<Bounds> {
        self.shape.bounds(self.dimension)
    }

    /// Whether it is joined to itself along an axis.
    pub fn is_joined(&self, axis: usize) -> bool {
        self.repeats.iter().any(|(along, _)| *along == axis)
    }

    /// Signed distance to the surface and its gradient, as [`Shape::level`].
    pub fn level(&self, mut point: [f64; 3]) -> SignedDistance {
        let mut sign = [1.0; 3];
        for &(axis, [first, last]) in &self.repeats {
            point[axis] = first + (point[axis] - first).rem_euclid(last - first);
        }
        for Mirror { axis, position, inward } in &self.mirrors {
            if (point[*axis] - position) * inward < 0.0 {
                point[*axis] = 2.0 * position - point[*axis];
                sign[*axis] = -sign[*axis];
            }
        }
        let level = self.shape.level(point, self.dimension);
        SignedDistance { gradient: std::array::from_fn(|k| level.gradient[k] * sign[k]), ..level }
    }
}

/// Round-off in where a face lies, relative to the larger of 1 m and its distance from the origin.
const ROUND_OFF: f64 = 1e-9;

pub(super) fn on(mirror: &Mirror, x: f64) -> bool {
    (x - mirror.position).abs() <= ROUND_OFF * mirror.position.abs().max(1.0)
}

/// The shape without its faces on a mirror: it goes straight on behind it.
fn continued(shape: Shape, mirror: &Mirror, dimension: usize) -> Shape {
    let Mirror { axis, inward, .. } = *mirror;
    let all = |shapes: Vec<Shape>| shapes.into_iter().map(|s| continued(s, mirror, dimension)).collect();
    match shape {
        Shape::HalfSpace { point, normal } => half_space(point, normal, mirror, dimension),
        Shape::Box { mut min, mut max } => {
            if inward > 0.0 && on(mirror, min[axis]) {
                min[axis] = f64::NEG_INFINITY;
            } else if inward < 0.0 && on(mirror, max[axis]) {
                max[axis] = f64::INFINITY;
            }
            Shape::Box { min, max }
        }
        Shape::Polygon { points, mut height } if axis == 2 => {
            if inward > 0.0 && on(mirror, height[0]) {
                height[0] = f64::NEG_INFINITY;
            } else if inward < 0.0 && on(mirror, height[1]) {
                height[1] = f64::INFINITY;
            }
            Shape::Polygon { points, height }
        }
        Shape::Polygon { points, height } => {
            Shape::Polygon { points: drawn_out(&points, mirror).into(), height }
        }
        Shape::Union(shapes) => Shape::Union(all(shapes)),
        Shape::Intersection(shapes) => Shape::Intersection(all(shapes)),
        Shape::Difference(shapes) => Shape::Difference(all(shapes)),
        // Turned about the mirror's own axis it ends where it ended.
        Shape::Rotated { shape, center, axis: about, angle }
            if dimension == 3 && (0..3).all(|k| k == axis || about[k] == 0.0) =>
        {
            Shape::Rotated {
                shape: Box::new(continued(*shape, mirror, dimension)),
                center,
                axis: about,
                angle,
            }
        }
        Shape::Rotated { shape, center, axis, angle } => match *shape {
            Shape::HalfSpace { point, normal } => {
                let rotation = Rotation::new(center, axis, angle, dimension);
                half_space(rotation.forward(point), rotation.turned(normal), mirror, dimension)
            }
            Shape::Mesh(mesh) => {
                let turned = mesh.turned(&Rotation::new(center, axis, angle, dimension));
                match turned.continued(mirror) {
                    Some(whole) => Shape::Mesh(whole),
                    None => Shape::Rotated { shape: Box::new(Shape::Mesh(mesh)), center, axis, angle },
                }
            }
            shape => Shape::Rotated { shape: Box::new(shape), center, axis, angle },
        },
        Shape::Mesh(mesh) => Shape::Mesh(mesh.continued(mirror).unwrap_or(mesh)),
        Shape::Cylinder { start, end, radius } => {
            let [start, end] = [[start, end], [end, start]].map(|ends| beyond(ends, mirror));
            Shape::Cylinder { start, end, radius }
        }
        Shape::Revolved(revolved) => Shape::Revolved(revolved.continued(mirror)),
        Shape::Ball { .. } | Shape::Curved(_) => shape,
    }
}

/// A half-space that ends on the mirror is everything, one that starts there is nothing.
fn half_space(point: [f64; 3], normal: [f64; 3], mirror: &Mirror, dimension: usize) -> Shape {
    let Mirror { axis, inward, .. } = *mirror;
    let across: f64 = (0..dimension).map(|k| normal[k].abs()).sum::<f64>() - normal[axis].abs();
    if !on(mirror, point[axis]) || across > ROUND_OFF * normal[axis].abs() {
        Shape::HalfSpace { point, normal }
    } else if normal[axis] * inward < 0.0 {
        Shape::Box { min: [f64::NEG_INFINITY; 3], max: [f64::INFINITY; 3] }
    } else {
        Shape::Union(Vec::new())
    }
}

/// How far behind a mirror counts as endless, in sizes of the shape.
const FAR: f64 = 1e3;

/// The first end of a cylinder's axis, moved far behind the mirror if its flat face lies on it.
fn beyond([mut end, other]: [[f64; 3]; 2], mirror: &Mirror) -> [f64; 3] {
    let Mirror { axis, inward, .. } = *mirror;
    let length = (end[axis] - other[axis]).abs();
    let upright = (0..3).all(|k| k == axis || (end[k] - other[k]).abs() <= ROUND_OFF * length);
    if upright && on(mirror, end[axis]) {
        end[axis] -= FAR * length * inward;
    }
    end
}

/// A polygon whose edges on the mirror are moved far behind it.
pub(super) fn drawn_out(points: &[[f64; 2]], mirror: &Mirror) -> Vec<[f64; 2]> {
    let Mirror { axis, position, inward } = *mirror;
    let size = points.iter().flatten().fold(1.0, |size: f64, x| size.max((x - position).abs()));
    let behind = |mut point: [f64; 2]| {
        point[axis] = position - FAR * inward * size;
        point
    };
    let next = |i: usize| points[(i + 1) % points.len()];
    let mut drawn = Vec::new();
    for (i, &point) in points.iter().enumerate() {
        drawn.push(point);
        if on(mirror, point[axis]) && on(mirror, next(i)[axis]) {
            drawn.extend([behind(point), behind(next(i))]);
        }
    }
    drawn
}

#[cfg(test)]
mod tests {
    use super::*;

    const MIRROR: Mirror = Mirror { axis: 1, position: 0.0, inward: 1.0 };

    /// Every way to write the upper half of something that the mirror completes.
    #[test]
    fn a_face_on_the_mirror_is_no_surface() {
        let ball = || Shape::Ball { center: [0.0; 3], radius: 1.0 };
        let below = |y| Shape::HalfSpace { point: [0.0; 3], normal: [0.0, y, 0.0] };
        let cut = [
            Shape::Intersection(vec![ball(), below(-2.0)]),
            Shape::Difference(vec![ball(), below(1.0)]),
            ball(),
        ];
        for shape in cut {
            let whole = MirroredShape::new(&shape, vec![MIRROR], 3);
            for point in [[0.3, 0.0, 0.4], [0.3, 0.01, 0.4], [0.1, -0.5, 0.2], [0.0, 0.0, 1.5]] {
                assert_eq!(whole.level(point), ball().level(point, 3), "{shape:?}");
            }
        }
        let points = vec![[-1.0, 0.0], [1.0, 0.0], [1.0, 2.0], [-1.0, 2.0]];
        let height = [0.0, 0.0];
        for shape in [
            Shape::Box { min: [-1.0, 0.0, 0.0], max: [1.0, 2.0, 0.0] },
            Shape::Polygon { points: points.into(), height },
        ] {
            let level = MirroredShape::new(&shape, vec![MIRROR], 2).level([0.9, 0.01, 0.0]);
            assert!((level.distance + 0.1).abs() < 1e-12 && level.gradient[0] == 1.0, "{level:?}");
        }
    }

    /// A cylinder upon the mirror, either way round, is twice as long; between two mirrors it is endless;
    /// across the mirror it stays.
    #[test]
    fn a_cylinder_goes_on_behind_the_mirror_that_it_stands_on() {
        let [foot, top] = [[1.0, 0.0, 2.0], [1.0, 0.1, 2.0]];
        let cylinder = |start, end| Shape::Cylinder { start, end, radius: 0.5 };
        let twice = cylinder([1.0, -0.1, 2.0], top);
        let lid = Mirror { position: 0.1, inward: -1.0, ..MIRROR };
        for [start, end] in [[foot, top], [top, foot]] {
            let upon = MirroredShape::new(&cylinder(start, end), vec![MIRROR], 3);
            let between = MirroredShape::new(&cylinder(start, end), vec![MIRROR, lid], 3);
            for point in [[1.4, 0.0, 2.0], [1.0, -0.05, 2.51], [1.4, 0.04, 2.0], [1.1, 0.2, 2.0]] {
                let (found, exact) = (upon.level(point), twice.level(point, 3));
                assert!((found.distance - exact.distance).abs() < 1e-12, "{point:?}: {found:?} {exact:?}");
                let side = f64::hypot(point[0] - 1.0, point[2] - 2.0) - 0.5;
                assert!((between.level(point).distance - side).abs() < 1e-12, "{point:?}");
            }
        }
        let lying = cylinder([0.0; 3], [1.0, 0.0, 0.0]);
        assert_eq!(
            MirroredShape::new(&lying, vec![MIRROR], 3).level([0.5, 0.1, 0.0]),
            lying.level([0.5, 0.1, 0.0], 3)
        );
    }

    /// The ends of a strip are no surface, wherever along it one looks; its sides are.
    #[test]
    fn a_strip_that_is_joined_to_itself_has_no_end() {
        let strip = Shape::Box { min: [-1.0, 0.0, 0.0], max: [3.0, 0.5, 0.0] };
        let whole = MirroredShape::new(&strip, Vec::new(), 2).joined(0, [-1.0, 3.0]);
        for x in [-5.0, -1.0, 0.3, 2.999, 3.0, 41.7] {
            let level = whole.level([x, 0.4, 0.0]);
            assert!((level.distance + 0.1).abs() < 1e-12 && level.gradient[1] == 1.0, "{x}: {level:?}");
        }
        // A hole in it is there again four metres further.
        let hole = Shape::Difference(vec![strip, Shape::Ball { center: [0.5, 0.25, 0.0], radius: 0.1 }]);
        let whole = MirroredShape::new(&hole, Vec::new(), 2).joined(0, [-1.0, 3.0]);
        for x in [0.5, 4.5, -7.5] {
            assert!((whole.level([x, 0.25, 0.0]).distance - 0.1).abs() < 1e-12, "{x}");
        }
    }

    #[test]
    fn a_face_off_the_mirror_stays() {
        let shape = Shape::Box { min: [-1.0, 0.5, 0.0], max: [1.0, 2.0, 0.0] };
        let whole = MirroredShape::new(&shape, vec![MIRROR], 2);
        let level = whole.level([0.0, -0.2, 0.0]);
        assert!((level.distance - 0.3).abs() < 1e-12 && level.gradient[1] == 1.0, "{level:?}");
    }
}
