//! Which points are inside a shape.
//!
//! Shapes with flat faces are half-open, lower faces in and upper faces out, so that shapes that share a face share no
//! point; a ball and the side of a cylinder are open, so that they keep their symmetry. What is cut out of a shape by
//! [`Shape::Difference`] is exactly what the cutter would hold.

use super::Shape;
use super::rotation::Rotation;

/// Direction in which a [`NudgedPoint`] is moved: no plane that people draw holds it.
const NUDGE: [f64; 3] = [1.0, 0.754_877_666_2, 0.569_840_290_9];

/// A point, and the short way by which it is moved off faces that round-off would decide about.
#[derive(Clone, Copy, Debug)]
pub(super) struct NudgedPoint {
    point: [f64; 3],
    nudged: [f64; 3],
    margin: f64,
    dimension: usize,
}

impl NudgedPoint {
    /// A point that decides ties of up to `margin` [m] as an exact point on the border would.
    pub(super) fn new(point: [f64; 3], margin: f64, dimension: usize) -> Self {
        let nudged = std::array::from_fn(|k| point[k] + margin * NUDGE[k]);
        NudgedPoint { point, nudged, margin, dimension }
    }

    fn turned_back(self, rotation: &Rotation) -> Self {
        NudgedPoint { point: rotation.back(self.point), nudged: rotation.back(self.nudged), ..self }
    }
}

impl Shape {
    /// Whether a point [m] is inside; faces are half-open, balls and other curved shapes open. In the plane, what is of
    /// space only holds no point.
    pub fn contains(&self, point: [f64; 3], dimension: usize) -> bool {
        self.contains_point(NudgedPoint::new(point, 0.0, dimension))
    }

    /// [`Shape::contains`] for a point that may lie on the border but for round-off.
    pub(super) fn contains_point(&self, probe: NudgedPoint) -> bool {
        let NudgedPoint { point, nudged, margin, dimension } = probe;
        match self {
            Shape::Ball { center, radius } => {
                let squared: f64 = (0..dimension).map(|k| (point[k] - center[k]).powi(2)).sum();
                squared < (radius - margin).max(0.0).powi(2)
            }
            Shape::Box { min, max } => (0..dimension).all(|k| min[k] <= nudged[k] && nudged[k] < max[k]),
            Shape::Cylinder { start, end, radius } => {
                let (along, _) = along_and_across(nudged, *start, *end);
                let (_, across) = along_and_across(point, *start, *end);
                dimension == 3 && (0.0..1.0).contains(&along) && across < radius - margin
            }
            Shape::HalfSpace { point: on, normal } => {
                (0..dimension).map(|k| (nudged[k] - on[k]) * normal[k]).sum::<f64>() <= 0.0
            }
            Shape::Polygon { points, height } => {
                points.contains([nudged[0], nudged[1]])
                    && (dimension == 2 || height[0] <= nudged[2] && nudged[2] < height[1])
            }
            Shape::Mesh(mesh) => dimension == 3 && mesh.contains(nudged),
            Shape::Revolved(revolved) => dimension == 3 && revolved.contains(point, nudged, margin),
            Shape::Curved(curved) => curved.solid().level(point, dimension).distance < -margin,
            Shape::Union(shapes) => shapes.iter().any(|shape| shape.contains_point(probe)),
            Shape::Intersection(shapes) => shapes.iter().all(|shape| shape.contains_point(probe)),
            Shape::Difference(shapes) => shapes.split_first().is_some_and(|(first, others)| {
                first.contains_point(probe) && !others.iter().any(|shape| shape.contains_point(probe))
            }),
            Shape::Rotated { shape, center, axis, angle } => {
                shape.contains_point(probe.turned_back(&Rotation::new(*center, *axis, *angle, dimension)))
            }
        }
    }
}

/// Position along the line from `start` to `end` as a fraction of its length, and distance from the line [m].
pub(super) fn along_and_across(point: [f64; 3], start: [f64; 3], end: [f64; 3]) -> (f64, f64) {
    let axis: [f64; 3] = std::array::from_fn(|k| end[k] - start[k]);
    let squared: f64 = axis.iter().map(|a| a * a).sum();
    let along = (0..3).map(|k| (point[k] - start[k]) * axis[k]).sum::<f64>() / squared;
    let across: f64 = (0..3).map(|k| (point[k] - start[k] - along * axis[k]).powi(2)).sum();
    (along, across.sqrt())
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::geometry::curved::tests::any_curved;
    use crate::geometry::revolved::tests::any_revolved;
    use proptest::prelude::*;

    fn simple_shape() -> impl Strategy<Value = Shape> {
        let point = || prop::array::uniform3(-1.0..1.0f64);
        let size = || 0.2..1.5f64;
        prop_oneof![
            (point(), size()).prop_map(|(center, radius)| Shape::Ball { center, radius }),
            (point(), prop::array::uniform3(size()))
                .prop_map(|(min, s)| Shape::Box { min, max: std::array::from_fn(|k| min[k] + s[k]) }),
            (point(), prop::array::uniform3(size()), size()).prop_map(|(start, s, radius)| {
                Shape::Cylinder { start, end: std::array::from_fn(|k| start[k] + s[k]), radius }
            }),
            (point(), prop::array::uniform3(0.1..1.0f64))
                .prop_map(|(point, normal)| Shape::HalfSpace { point, normal }),
            (prop::collection::vec(prop::array::uniform2(-1.0..1.0f64), 3..7), -1.0..0.0f64)
                .prop_map(|(points, low)| Shape::Polygon { points: points.into(), height: [low, low + 1.0] }),
        ]
    }

    /// Shapes of every kind, some of them turned.
    pub fn any_shape() -> impl Strategy<Value = Shape> {
        (
            prop_oneof![simple_shape(), any_curved(), any_revolved()],
            prop::array::uniform3(0.1..1.0f64),
            prop_oneof![Just(0.0), -3.0..3.0f64],
        )
            .prop_map(|(shape, axis, angle)| match angle {
                0.0 => shape,
                _ => Shape::Rotated { shape: std::boxed::Box::new(shape), center: [0.1; 3], axis, angle },
            })
    }

    proptest! {
        #[test]
        fn sets_obey_boolean_identities(
            a in any_shape(),
            b in any_shape(),
            point in prop::array::uniform3(-2.0..2.0f64),
            dimension in 2..=3usize,
        ) {
            let inside = |shape: &Shape| shape.contains(point, dimension);
            let (in_a, in_b) = (inside(&a), inside(&b));
            let pair = vec![a.clone(), b.clone()];
            prop_assert_eq!(inside(&Shape::Union(pair.clone())), in_a || in_b);
            prop_assert_eq!(inside(&Shape::Intersection(pair.clone())), in_a && in_b);
            let cut = Shape::Difference(pair.clone());
            prop_assert_eq!(inside(&cut), in_a && !in_b);
            // A = (A and B) or (A without B), and the two share nothing.
            let both = Shape::Intersection(pair);
            prop_assert!(!(inside(&both) && inside(&cut)));
            prop_assert_eq!(inside(&Shape::Union(vec![both, cut])), in_a);
        }

        #[test]
        fn turning_a_shape_and_a_point_together_changes_nothing(
            shape in any_shape(),
            point in prop::array::uniform3(-2.0..2.0f64),
            axis in prop::array::uniform3(0.1..1.0f64),
            angle in -4.0..4.0f64,
        ) {
            let turned = Rotation::new([0.3, -0.2, 0.5], axis, angle, 3).forward(point);
            let inside = shape.contains(point, 3);
            // Points nearer to the border than round-off may go either way.
            prop_assume!(shape.distance(point, 3).abs() > 1e-12);
            let shape = std::boxed::Box::new(shape);
            prop_assert_eq!(Shape::Rotated { shape, center: [0.3, -0.2, 0.5], axis, angle }.contains(turned, 3), inside);
        }
    }

    #[test]
    fn two_boxes_that_share_a_face_share_no_point() {
        let box_of = |min, max| Shape::Box { min: [min, 0.0, 0.0], max: [max, 1.0, 1.0] };
        let face = [0.3, 0.5, 0.5];
        assert!(!box_of(0.0, 0.3).contains(face, 3) && box_of(0.3, 1.0).contains(face, 3));
    }

    #[test]
    fn a_cylinder_ends_at_its_ends_and_its_radius() {
        let cylinder = Shape::Cylinder { start: [1.0, 0.0, 0.0], end: [3.0, 0.0, 0.0], radius: 0.5 };
        for (point, inside) in [
            ([1.1, 0.3, 0.39], true),
            ([0.9, 0.0, 0.0], false),
            ([2.0, 0.4, 0.4], false),
            ([3.1, 0.0, 0.0], false),
        ] {
            assert_eq!(cylinder.contains(point, 3), inside, "{point:?}");
        }
    }

    #[test]
    fn in_the_plane_the_third_coordinate_does_not_count() {
        let ball = Shape::Ball { center: [0.0, 0.0, 7.0], radius: 1.0 };
        assert!(ball.contains([0.6, 0.6, 0.0], 2) && !ball.contains([0.6, 0.6, 0.0], 3));
    }
}
