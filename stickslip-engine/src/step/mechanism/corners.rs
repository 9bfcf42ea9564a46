//! Corners of rigid bodies, at which faces end that bear on others.

use crate::geometry::{Rotation, Shape};
use crate::tensor::Vector;

/// How far around a corner it is looked whether it stands out, over the distance between points of the surface.
const AROUND: f64 = 1e-3;
/// A corner is on the surface if it is no farther off than this, over the same.
const ON: f64 = 1e-9;
/// Fewer than this of the directions in which one looks are inside where a corner stands out [-].
const STANDS_OUT: f64 = 0.45;

/// How far from a corner the points of its faces are, over the same: the corner itself is on several faces at once.
const BESIDE: f64 = 1e-4;

/// A corner, and the ways from it along which lie the faces that meet there.
struct Corner {
    place: [f64; 3],
    ways: Vec<[f64; 3]>,
}

/// Points beside the corners that stand out of a shape, one on each face. Points of a surface are middles of its
/// pieces, so what a face bears at its rim would be borne half a piece within it, now here and now there as round-off
/// tilts it.
pub fn corners(shape: &Shape, spacing: f64, axes: usize) -> Vec<[f64; 3]> {
    let on = |place: &[f64; 3]| shape.level(*place, axes).distance.abs() <= ON * spacing;
    let stands_out = |place: &[f64; 3]| {
        let around: Vec<bool> = directions(axes)
            .map(|way| shape.contains(std::array::from_fn(|k| place[k] + AROUND * spacing * way[k]), axes))
            .collect();
        let inside = around.iter().filter(|inside| **inside).count();
        (inside as f64) < STANDS_OUT * around.len() as f64
    };
    let all =
        of_parts(shape, axes).into_iter().filter(|corner| on(&corner.place) && stands_out(&corner.place));
    all.flat_map(|Corner { place, ways }| {
        ways.into_iter().map(move |way| std::array::from_fn(|k| place[k] + BESIDE * spacing * way[k]))
    })
    .filter(on)
    .collect()
}

/// A shape in the plane that a box meets at a corner of either.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plain {
    /// A box.
    Box,
    /// A half-space.
    HalfSpace,
}

impl Plain {
    /// Which one a shape is, turned or not; none in space, where edges cross.
    pub fn of(shape: &Shape, axes: usize) -> Option<Self> {
        match shape {
            Shape::Box { .. } if axes == 2 => Some(Plain::Box),
            Shape::HalfSpace { .. } if axes == 2 => Some(Plain::HalfSpace),
            Shape::Rotated { shape, .. } => Plain::of(shape, axes),
            _ => None,
        }
    }
}

/// Corners of all that a shape is made of.
fn of_parts(shape: &Shape, axes: usize) -> Vec<Corner> {
    match shape {
        Shape::Box { min, max } => {
            let of = |number: usize| {
                let upper = |k: usize| number >> k & 1 == 1;
                let place = |k: usize| if upper(k) { max[k] } else { min[k] };
                let inward = |k: usize| if upper(k) { -1.0 } else { 1.0 };
                let way = |face: usize| {
                    std::array::from_fn(|k| if k < axes && k != face { inward(k) } else { 0.0 })
                };
                let place = std::array::from_fn(|k| if k < axes { place(k) } else { 0.0 });
                Corner { place, ways: (0..axes).map(way).collect() }
            };
            (0..1 << axes).map(of).collect()
        }
        Shape::Polygon { points, .. } if axes == 2 => {
            let count = points.len();
            let of = |i: usize| {
                let [x, y] = points[i];
                let way = |[a, b]: [f64; 2]| {
                    let length = (a - x).hypot(b - y);
                    [(a - x) / length, (b - y) / length, 0.0]
                };
                let ways = [points[(i + count - 1) % count], points[(i + 1) % count]].map(way).to_vec();
                Corner { place: [x, y, 0.0], ways }
            };
            (0..count).map(of).collect()
        }
        Shape::Union(parts) | Shape::Intersection(parts) | Shape::Difference(parts) => {
            parts.iter().flat_map(|part| of_parts(part, axes)).collect()
        }
        Shape::Rotated { shape, center, axis, angle } => {
            let rotation = Rotation::new(*center, *axis, *angle, axes);
            let origin = Vector(rotation.forward([0.0; 3]));
            let turned = |way: [f64; 3]| (Vector(rotation.forward(way)) - origin).0;
            let of = |Corner { place, ways }| Corner {
                place: rotation.forward(place),
                ways: ways.into_iter().map(turned).collect(),
            };
            of_parts(shape, axes).into_iter().map(of).collect()
        }
        _ => Vec::new(),
    }
}

/// Directions all around, askew to the faces of most shapes.
fn directions(axes: usize) -> impl Iterator<Item = [f64; 3]> {
    const COUNT: usize = 40;
    (0..COUNT).map(move |number| {
        // Along a spiral from pole to pole, in steps of the golden angle.
        let share = (number as f64 + 0.5) / COUNT as f64;
        let z = if axes == 2 { 0.0 } else { 1.0 - 2.0 * share };
        let angle =
            if axes == 2 { std::f64::consts::TAU * share } else { 2.399_963_229_728_653 * number as f64 };
        let across = (1.0 - z * z).sqrt();
        [across * libm::cos(angle), across * libm::sin(angle), z]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A brick has four corners in the plane, of two faces each, and eight of three in space; a bin of three boxes has
    /// the six of its outline that stand out; turned by a quarter, corners turn with the shape.
    #[test]
    fn corners_are_those_that_stand_out() {
        let brick = Shape::Box { min: [0.0; 3], max: [2.0, 1.0, 1.0] };
        assert_eq!(corners(&brick, 0.1, 2).len(), 4 * 2);
        assert_eq!(corners(&brick, 0.1, 3).len(), 8 * 3);
        let part = |min: [f64; 2], max: [f64; 2]| Shape::Box {
            min: [min[0], min[1], 0.0],
            max: [max[0], max[1], 1.0],
        };
        let bin = Shape::Union(vec![
            part([-8.0, -1.0], [8.0, 0.0]),
            part([-8.0, 0.0], [-6.0, 9.0]),
            part([6.0, 0.0], [8.0, 9.0]),
        ]);
        let found = corners(&bin, 0.1, 2);
        assert_eq!(found.len(), 6 * 2, "{found:?}");
        let (shape, center, axis) = (Box::new(brick), [0.0; 3], [0.0, 0.0, 1.0]);
        let turned = Shape::Rotated { shape, center, axis, angle: std::f64::consts::FRAC_PI_2 };
        let far = |to: [f64; 2]| {
            let off = |c: &[f64; 3]| (c[0] - to[0]).hypot(c[1] - to[1]);
            corners(&turned, 0.1, 2).iter().map(off).fold(f64::INFINITY, f64::min)
        };
        let beside = |to: [f64; 2]| (far(to) / (BESIDE * 0.1) - 1.0).abs() < 1e-6;
        assert!([[0.0, 0.0], [0.0, 2.0], [-1.0, 0.0], [-1.0, 2.0]].into_iter().all(beside));
    }
}
