//! The walls of a container, one by one: where two of them meet, both push.

use crate::geometry::{Shape, SignedDistance};

/// A wall: grains stay in a shape, or out of it.
#[derive(Clone, Debug)]
pub struct Wall {
    shape: Shape,
    out_of: bool,
}

impl Wall {
    /// How far a point is beyond the wall [m].
    pub fn level(&self, point: [f64; 3], dimension: usize) -> SignedDistance {
        let SignedDistance { distance, gradient } = self.shape.level(point, dimension);
        match self.out_of {
            true => SignedDistance { distance: -distance, gradient: gradient.map(|g| -g) },
            false => SignedDistance { distance, gradient },
        }
    }

    /// Whether it may be nearer than `reach` [m] to a point, or the point beyond it; always where the distance is not
    /// known exactly.
    pub fn may_reach(&self, point: [f64; 3], reach: f64, dimension: usize) -> bool {
        let exact = matches!(self.shape, Shape::HalfSpace { .. } | Shape::Ball { .. });
        !exact || self.level(point, dimension).distance > -reach
    }
}

impl Wall {
    /// Whether it is flat and stands at an end of the container along an axis.
    pub fn is_end(&self, axis: usize, ends: [f64; 2]) -> bool {
        let Shape::HalfSpace { point, normal } = &self.shape else { return false };
        let across = (0..3).all(|k| k == axis || normal[k].abs() <= 1e-12 * normal[axis].abs());
        across && ends.iter().any(|end| (point[axis] - end).abs() <= 1e-9 * (ends[1] - ends[0]))
    }
}

/// Lengths of a cylinder by which its round wall goes on beyond its ends.
const BEYOND: f64 = 10.0;

/// Walls all of which together hold what the shape holds.
pub fn walls(shape: &Shape, dimension: usize) -> Vec<Wall> {
    let half_space =
        |point: [f64; 3], normal: [f64; 3]| Wall { shape: Shape::half_space(point, normal), out_of: false };
    let axis = |k: usize, sign: f64| std::array::from_fn(|i| if i == k { sign } else { 0.0 });
    match shape {
        Shape::Box { min, max } => (0..dimension)
            .flat_map(|k| [half_space(*min, axis(k, -1.0)), half_space(*max, axis(k, 1.0))])
            .collect(),
        Shape::Cylinder { start, end, radius } if dimension == 3 => {
            let along: [f64; 3] = std::array::from_fn(|k| end[k] - start[k]);
            let far = |from: &[f64; 3], by: f64| std::array::from_fn(|k| from[k] + by * along[k]);
            let round =
                Shape::Cylinder { start: far(start, -BEYOND), end: far(end, BEYOND), radius: *radius };
            vec![
                half_space(*start, along.map(|x| -x)),
                half_space(*end, along),
                Wall { shape: round, out_of: false },
            ]
        }
        Shape::Polygon { points, height } => match sides_of_convex(points) {
            None => vec![Wall { shape: shape.clone(), out_of: false }],
            Some(sides) => {
                let mut walls: Vec<_> = sides
                    .into_iter()
                    .map(|([x, y], [nx, ny])| half_space([x, y, 0.0], [nx, ny, 0.0]))
                    .collect();
                if dimension == 3 {
                    walls.push(half_space([0.0, 0.0, height[0]], axis(2, -1.0)));
                    walls.push(half_space([0.0, 0.0, height[1]], axis(2, 1.0)));
                }
                walls
            }
        },
        Shape::Intersection(shapes) => shapes.iter().flat_map(|shape| walls(shape, dimension)).collect(),
        Shape::Difference(shapes) => {
            let Some((first, others)) = shapes.split_first() else { return Vec::new() };
            let cuts = others.iter().map(|shape| Wall { shape: shape.clone(), out_of: true });
            walls(first, dimension).into_iter().chain(cuts).collect()
        }
        Shape::Rotated { shape, center, axis, angle } => {
            let turned = |wall: Wall| Wall { shape: wall.shape.rotated(*center, *axis, *angle), ..wall };
            walls(shape, dimension).into_iter().map(turned).collect()
        }
        Shape::Ball { .. }
        | Shape::Cylinder { .. }
        | Shape::HalfSpace { .. }
        | Shape::Mesh(_)
        | Shape::Revolved(_)
        | Shape::Curved(_)
        | Shape::Union(_) => {
            vec![Wall { shape: shape.clone(), out_of: false }]
        }
    }
}

/// A point on each side of a polygon and the direction out of it; `None` where it is not convex.
fn sides_of_convex(points: &[[f64; 2]]) -> Option<Vec<([f64; 2], [f64; 2])>> {
    let count = points.len();
    let turn = |i: usize| {
        let [a, b, c] = [0, 1, 2].map(|step| points[(i + step) % count]);
        (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
    };
    let way = (0..count).map(turn).find(|turn| *turn != 0.0)?.signum();
    // Once round, and no more: turns of one sense add up to one full turn.
    let angle = |i: usize| {
        let [a, b, c] = [0, 1, 2].map(|step| points[(i + step) % count]);
        libm::atan2(turn(i), (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]))
    };
    let once = ((0..count).map(angle).sum::<f64>().abs() - std::f64::consts::TAU).abs() < 1.0;
    let convex = once && (0..count).all(|i| way * turn(i) >= 0.0);
    let side = |i: usize| {
        let [a, b] = [points[i], points[(i + 1) % count]];
        (a, [way * (b[1] - a[1]), way * (a[0] - b[0])])
    };
    convex.then(|| (0..count).map(side).filter(|(_, out)| *out != [0.0; 2]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn inside_is_behind_all_walls(point in prop::array::uniform3(-1.5..1.5f64), angle in 0.0..6.0f64) {
            let cube = Shape::cuboid([-1.0, -0.8, -0.5], [0.9, 1.0, 0.7]);
            let funnel = |points: Vec<[f64; 2]>| Shape::Polygon { points: points.into(), height: [-0.6, 0.6] };
            let convex = funnel(vec![[-1.0, 1.0], [1.0, 1.0], [0.2, -1.0], [-0.2, -1.0]]);
            let hollow = funnel(vec![[-1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [0.2, -1.0], [-0.2, -1.0]]);
            let can = Shape::Cylinder { start: [0.0, 0.0, -0.6], end: [0.1, 0.0, 0.7], radius: 0.8 };
            let ball = Shape::ball([0.3; 3], 0.5);
            for dimension in [2, 3] {
                let mut shapes = vec![
                    cube.clone(),
                    convex.clone(),
                    hollow.clone(),
                    cube.clone().without(ball.clone()),
                    convex.clone().and(ball.clone()),
                    cube.clone().rotated([0.1; 3], [0.0, 0.0, 1.0], angle),
                ];
                if dimension == 3 {
                    shapes.push(can.clone());
                }
                for shape in shapes {
                    let beyond = |wall: &Wall| wall.level(point, dimension).distance >= 0.0;
                    let inside = !walls(&shape, dimension).iter().any(beyond);
                    prop_assert_eq!(inside, shape.contains(point, dimension), "{:?}", shape);
                }
            }
        }
    }
}
