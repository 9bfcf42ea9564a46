//! Where two bodies share most room, from the distances to their exact surfaces.
//!
//! ```text
//! depth = -2 min over x of g(x),   g = max(d_a, d_b)
//! ```
//! d_a and d_b are signed distances, negative inside: for two balls the depth is the sum of the radii less the distance
//! of the centres, for two faces it is how far they reach past each other. g changes by no more than the way walked, so
//! a box whose centre has a g above half its diagonal holds no common point, and is left out. In the boxes of a cell
//! that remain, g is walked down: to where both distances are equal, then along the sum of the two gradients, which
//! vanishes where the surfaces face each other. What a walk ends on is common to both; a deeper place than it finds may
//! be missed, as in grooves finer than a cell.

use crate::geometry::{Bounds, SignedDistance};
use crate::tensor::Vector;

/// Where two bodies share most room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SharedRoom {
    /// A place in both [m].
    pub place: [f64; 3],
    /// By how much they overlap there [m].
    pub depth: f64,
}

/// The deepest place in a `room` that two bodies share, if there is any; each `level` is of one body's surface, as
/// [`crate::geometry::Shape::level`].
pub(super) fn deepest(
    levels: [&dyn Fn([f64; 3]) -> SignedDistance; 2],
    room: &Bounds,
    cell: f64,
    dimension: usize,
) -> Option<SharedRoom> {
    if room.is_empty() || !room.is_finite() {
        return None;
    }
    let mut boxes = vec![*room];
    let mut found: Option<SharedRoom> = None;
    while let Some(part) = boxes.pop() {
        let size = part.size();
        let half_diagonal = 0.5 * Vector(size).norm();
        let center = std::array::from_fn(|k| 0.5 * (part.min[k] + part.max[k]));
        if worse(&levels, center) > half_diagonal {
            continue;
        }
        let longest = (0..dimension).max_by(|&i, &j| size[i].total_cmp(&size[j])).unwrap_or(0);
        if size[longest] > cell {
            let mut halves = [part; 2];
            halves[0].max[longest] = center[longest];
            halves[1].min[longest] = center[longest];
            boxes.extend(halves);
            continue;
        }
        let low = descend(&levels, center, cell);
        found = found.into_iter().chain(low).max_by(|a, b| a.depth.total_cmp(&b.depth));
    }
    found
}

/// max(d_a, d_b) at a point [m].
fn worse(levels: &[&dyn Fn([f64; 3]) -> SignedDistance; 2], point: [f64; 3]) -> f64 {
    levels[0](point).distance.max(levels[1](point).distance)
}

/// Halvings of a step of half a cell: down to what no number resolves.
const HALVINGS: usize = 40;
/// Steps in a walk that finds its way down.
const STEPS: usize = 100;

/// Walks down from a point; what it finds, if that is in both.
fn descend(
    levels: &[&dyn Fn([f64; 3]) -> SignedDistance; 2],
    start: [f64; 3],
    cell: f64,
) -> Option<SharedRoom> {
    let mut here = level_out(levels, start, cell);
    let mut low = worse(levels, here);
    let (mut step, mut halvings) = (0.5 * cell, 0);
    for _ in 0..STEPS {
        let [a, b] = levels.map(|level| Vector(level(here).gradient));
        let uphill = a + b;
        // Above what is left to walk, nothing is common.
        if halvings == HALVINGS || low > 3.0 * step || uphill.norm() <= 1e-9 {
            break;
        }
        let next = level_out(levels, (Vector(here) - uphill * (step / uphill.norm())).0, cell);
        let there = worse(levels, next);
        if there < low {
            (here, low) = (next, there);
        } else {
            step *= 0.5;
            halvings += 1;
        }
    }
    (low < 0.0 && low.is_finite()).then_some(SharedRoom { place: here, depth: -2.0 * low })
}

/// The point near one at which both distances are about equal.
fn level_out(levels: &[&dyn Fn([f64; 3]) -> SignedDistance; 2], mut point: [f64; 3], cell: f64) -> [f64; 3] {
    for _ in 0..4 {
        let [a, b] = levels.map(|level| level(point));
        let difference = a.distance - b.distance;
        let slope = Vector(a.gradient) - Vector(b.gradient);
        let square = slope.dot(slope);
        if !difference.is_finite() || square <= 1e-12 || difference.abs() <= 1e-12 * cell {
            break;
        }
        let way = slope * (-difference / square);
        let length = way.norm();
        point = (Vector(point) + way * (cell / length.max(cell))).0;
    }
    point
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Shape;

    fn shared(a: &Shape, b: &Shape, dimension: usize) -> Option<SharedRoom> {
        let [of_a, of_b] = [a, b].map(|shape| move |x| shape.level(x, dimension));
        let bounds = |shape: &Shape| shape.bounds(dimension).unwrap_or(Bounds::EVERYTHING);
        deepest([&of_a, &of_b], &bounds(a).intersected(&bounds(b)), 0.1, dimension)
    }

    fn ball(center: [f64; 3], radius: f64) -> Shape {
        Shape::Ball { center, radius }
    }

    /// Along axes and askew, down to a millionth of a cell, in the plane and in space.
    #[test]
    fn balls_overlap_by_what_their_centres_lack() {
        for direction in [[1.0, 0.0, 0.0], [0.6, 0.8, 0.0], [0.48, 0.64, 0.6]] {
            let dimension = if direction[2] == 0.0 { 2 } else { 3 };
            for depth in [1e-7, 1e-4, 0.02] {
                let center = direction.map(|x| x * (2.0 - depth));
                let found = shared(&ball([0.0; 3], 1.0), &ball(center, 1.0), dimension).expect("overlap");
                assert!((found.depth / depth - 1.0).abs() < 1e-3, "{direction:?} {depth}: {found:?}");
                let touching =
                    shared(&ball([0.0; 3], 1.0), &ball(direction.map(|x| 2.0 * x), 1.0), dimension);
                assert!(touching.is_none_or(|found| found.depth < 1e-12), "{touching:?}");
            }
        }
    }

    #[test]
    fn faces_overlap_by_what_they_reach_past_each_other() {
        let block = |x: f64| Shape::Box { min: [x, 0.0, 0.0], max: [x + 1.0, 1.0, 1.0] };
        let turned = |x: f64| Shape::Rotated {
            shape: Box::new(block(x)),
            center: [0.3; 3],
            axis: [1.0, 2.0, 0.5],
            angle: 0.7,
        };
        for make in [&block as &dyn Fn(f64) -> Shape, &turned] {
            let found = shared(&make(0.0), &make(1.0 - 1e-5), 3).expect("overlap");
            assert!((found.depth / 1e-5 - 1.0).abs() < 1e-3, "{found:?}");
            assert!(shared(&make(0.0), &make(1.0), 3).is_none_or(|found| found.depth < 1e-12));
        }
        let floor = Shape::HalfSpace { point: [0.0; 3], normal: [0.0, 0.0, 1.0] };
        let found = shared(&ball([0.2, 0.3, 0.999], 1.0), &floor, 3).expect("overlap");
        assert!((found.depth / 1e-3 - 1.0).abs() < 1e-3, "{found:?}");
    }

    /// A corner 0.01 m through a face: both are 0.0041 m deep where that is the most.
    #[test]
    fn a_corner_through_a_face_is_found() {
        let square = Box::new(Shape::Box { min: [0.0; 3], max: [1.0, 1.0, 0.0] });
        let angle = std::f64::consts::FRAC_PI_4;
        let turned = |y: f64| {
            let lifted = Shape::Box { min: [0.0, y, 0.0], max: [1.0, y + 1.0, 0.0] };
            Shape::Rotated { shape: Box::new(lifted), center: [0.0, y, 0.0], axis: [0.0, 0.0, 1.0], angle }
        };
        let floor = Shape::HalfSpace { point: [0.0; 3], normal: [0.0, 1.0, 0.0] };
        let found = shared(&turned(-0.01), &floor, 2).expect("overlap");
        let exact = 0.02 / (1.0 + 2f64.sqrt());
        assert!((found.depth / exact - 1.0).abs() < 1e-3, "{found:?} {exact}");
        assert!(shared(&turned(0.0), &floor, 2).is_none_or(|found| found.depth < 1e-12));
        assert!(shared(&square, &ball([0.5, 1.2, 0.0], 0.1), 2).is_none());
    }

    #[test]
    fn a_ball_in_a_hole_of_its_size_touches_all_round() {
        let block = Shape::Box { min: [-2.0; 3], max: [2.0; 3] };
        let hollow = |radius| Shape::Difference(vec![block.clone(), ball([0.0; 3], radius)]);
        assert!(shared(&hollow(1.0), &ball([0.0; 3], 1.0), 3).is_none_or(|found| found.depth < 1e-12));
        let found = shared(&hollow(1.0), &ball([0.0; 3], 1.001), 3).expect("overlap");
        assert!((found.depth / 1e-3 - 1.0).abs() < 1e-3, "{found:?}");
    }
}
