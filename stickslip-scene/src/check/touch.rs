//! Where a ball or a cylinder of one body is nearest to another body.

use super::bodies::FillingExtent;
use crate::geometry::{RoundPart, Shape};
use crate::scene::{Body, Scene};
use crate::tensor::{Vector, cross};

/// Lengths that differ by this share of a radius are the same.
pub(super) const SAME: f64 = 1e-6;

/// A ball of one body that faces another body, or a cylinder that does so all along.
pub(super) struct BallContact {
    pub pair: [usize; 2],
    /// Masses that move: of the ball or cylinder itself, even if a symmetry plane cuts it, and of the other body [kg].
    pub masses: [f64; 2],
    /// Effective radius [m].
    pub radius: f64,
    pub gap: f64,
    /// Unit vector from the ball's centre to the other body.
    pub direction: Vector<f64, 3>,
    /// Length of the line in which cylinders touch in space [m].
    pub length: Option<f64>,
}

impl BallContact {
    /// Where a ball or cylinder of the first body is nearest to the second; `None` if none faces it.
    pub(super) fn of(scene: &Scene, extents: &[FillingExtent], pair: [usize; 2]) -> Option<BallContact> {
        let [first, second] = pair.map(|i| &scene.bodies[i]);
        let full = |part: &RoundPart| !part.hollow;
        let balls = first.shape.round_parts(scene.dimension.axes()).into_iter().filter(full);
        let touches = balls.filter_map(|ball| {
            let (gap, direction) = facing(&ball, first, second, scene.dimension.axes())?;
            let opposite = opposite_ball(&second.shape, &ball, gap, direction, scene.dimension.axes());
            let curvature = opposite.map_or(0.0, |part| if part.hollow { -1.0 } else { 1.0 } / part.radius);
            let radius = 1.0 / (1.0 / ball.radius + curvature);
            let whole = |part: RoundPart, body: &Body| {
                let volume = solid(&part).volume(scene.dimension.axes());
                volume.map(|volume| volume * scene.materials[body.material].density)
            };
            let lengths = [Some(ball), opposite].into_iter().flatten().filter_map(|part| part.axis);
            let length = lengths.map(|axis| Vector(axis).norm()).reduce(f64::min);
            let other_ball = opposite.filter(full).and_then(|part| whole(part, second));
            let masses = [whole(ball, first)?, other_ball.unwrap_or(extents[pair[1]].mass)];
            (radius > 0.0 && radius.is_finite()).then_some(BallContact {
                pair,
                masses,
                radius,
                gap,
                direction,
                length,
            })
        });
        touches.min_by(|a, b| a.gap.total_cmp(&b.gap))
    }
}

/// Gap and direction from a ball of `first` to `second`, if the ball's surface is the body's surface there.
fn facing(ball: &RoundPart, first: &Body, second: &Body, dimension: usize) -> Option<(f64, Vector<f64, 3>)> {
    let distance = second.shape.distance(ball.center, dimension);
    let direction = Vector(second.shape.direction_to(ball.center, SAME * ball.radius, dimension)?);
    let point = Vector(ball.center) + direction * ball.radius;
    if let Some((axis, ends)) = ball.axis.zip(ball.ends()) {
        // All along, and not with an end.
        let even = |end| (second.shape.distance(end, dimension) - distance).abs() <= SAME * ball.radius;
        if direction.dot(Vector(axis)).abs() > SAME * ball.radius || !ends.into_iter().all(even) {
            return None;
        }
    }
    let on_surface = first.shape.distance(point.0, dimension).abs() < SAME * ball.radius;
    (distance > 0.0 && on_surface).then_some((distance - ball.radius, direction))
}

/// The ball of the opposite shape, to a cylinder the cylinder beside it, that holds the point nearest to a ball.
fn opposite_ball(
    opposite: &Shape,
    ball: &RoundPart,
    gap: f64,
    direction: Vector<f64, 3>,
    dimension: usize,
) -> Option<RoundPart> {
    let foot = Vector(ball.center) + direction * (ball.radius + gap);
    let along = |part: &RoundPart| match (ball.axis, part.axis) {
        (Some(a), Some(b)) => Vector(cross(a, b)).norm() <= SAME * Vector(a).norm() * Vector(b).norm(),
        (None, None) => true,
        _ => false,
    };
    let holds =
        |part: &RoundPart| along(part) && solid(part).distance(foot.0, dimension).abs() < SAME * part.radius;
    opposite.round_parts(dimension).into_iter().find(holds)
}

/// A round part by itself.
fn solid(part: &RoundPart) -> Shape {
    let RoundPart { center, radius, .. } = *part;
    part.ends().map_or(Shape::Ball { center, radius }, |[start, end]| Shape::Cylinder { start, end, radius })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::bodies::measure;
    use crate::check::tests::{free, scene};
    use crate::scene::Dimension;

    fn touch(first: Shape, second: Shape) -> Option<BallContact> {
        let scene = scene(Dimension::Space, 0.1, vec![free("first", 0, first), free("second", 0, second)]);
        BallContact::of(&scene, &measure(&scene).expect("filled"), [0, 1])
    }

    fn ball(x: f64, radius: f64) -> Shape {
        Shape::Ball { center: [x, 0.0, 0.0], radius }
    }

    #[test]
    fn a_ball_cut_off_before_it_reaches_the_other_body_does_not_face_it() {
        let behind = |x| Shape::HalfSpace { point: [x, 0.0, 0.0], normal: [1.0, 0.0, 0.0] };
        let cut = |x| Shape::Intersection(vec![ball(0.0, 1.0), behind(x)]);
        let wall = || Shape::Box { min: [1.2, -1.0, -1.0], max: [1.6, 1.0, 1.0] };
        assert!(touch(cut(0.5), wall()).is_none());
        assert!((touch(cut(1.5), wall()).expect("whole").gap - 0.2).abs() < 1e-12);
    }

    #[test]
    fn balls_face_along_their_centres_with_the_harmonic_radius() {
        let touch = touch(ball(0.0, 1.0), ball(4.5, 3.0)).expect("two balls");
        assert!((touch.gap - 0.5).abs() < 1e-12 && (touch.radius - 0.75).abs() < 1e-12);
        assert!((touch.direction[0] - 1.0).abs() < 1e-9);
        assert!((touch.masses[1] / touch.masses[0] - 27.0).abs() < 1e-9);
    }
}
