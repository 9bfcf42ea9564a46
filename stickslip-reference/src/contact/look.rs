//! Where a place lies in a body: its undeformed place, the distance to the surface and the way out.

use crate::interior::Interior;
use stickslip_mechanics::geometry::form::Weights;
use stickslip_mechanics::geometry::{MirroredShape, SignedDistance};
use stickslip_mechanics::tensor::{Matrix, Vector};

/// What a body is at a place.
#[derive(Clone, Copy, Debug)]
pub struct Seen<const D: usize> {
    /// Where it was undeformed [m].
    pub place: Vector<f64, D>,
    /// Functions there.
    pub weights: Weights<D>,
    /// Distance to the surface [m], negative inside.
    pub distance: f64,
    /// Unit normal, out of the body.
    pub normal: Vector<f64, D>,
}

/// Newton's steps at most.
const STEPS: usize = 12;
/// When a place is found, in cells.
const FOUND: f64 = 1e-10;
/// How far a place may be moved at once, in cells: far ones are sought by way of near ones.
const STRIDE: f64 = 1.0;
/// How far beyond the surface a map is followed, in cells.
const BEYOND: f64 = 1.5;
/// A normal that looks along another is not that of a partner's face.
const FACING: f64 = -0.3;
/// How far a point is moved back to find the face that it came through, in cells.
pub(super) const BACK: f64 = 0.3;

/// Whether a face with this outward normal looks at a partner whose surface has that one.
pub(super) fn looks_at<const D: usize>(normal: Vector<f64, D>, toward: Vector<f64, D>) -> bool {
    normal.dot(toward) < FACING
}

/// What a body is at a place, sought from an undeformed place near it; `toward` is the outward normal of the partner's
/// surface there: near corners the face counts that looks at it. `None` where the place is far from the body, or no
/// face of it looks at the partner.
pub fn look<const D: usize>(
    (interior, shape): (&Interior<D>, &MirroredShape),
    at: Vector<f64, D>,
    start: Vector<f64, D>,
    toward: Option<Vector<f64, D>>,
) -> Option<Seen<D>> {
    let cell = interior.form.cell;
    let mut place = start;
    let mut inverse = Matrix::IDENTITY;
    let mut weights = interior.form.weights(place);
    for step in 0.. {
        let (x, deformation) = interior.map(&weights);
        inverse = space(&deformation).inverse();
        let change = times(&inverse, at - x);
        let length = change.norm();
        if length.is_nan() || step == STEPS {
            return None;
        }
        place += if length > STRIDE * cell { change * (STRIDE * cell / length) } else { change };
        weights = interior.form.weights(place);
        if length < FOUND * cell {
            break;
        }
    }
    let level = shape.level(place.space());
    if level.distance.is_nan() || level.distance > BEYOND * cell {
        return None;
    }
    let outward = |gradient: Vector<f64, D>| {
        let normal = transposed_times(&inverse, gradient);
        (normal.norm(), normal)
    };
    let gradient = Vector::of(level.gradient);
    let (length, normal) = outward(gradient);
    let seen = Seen { place, weights, distance: level.distance / length, normal: normal * (1.0 / length) };
    let facing = |normal: Vector<f64, D>| toward.is_none_or(|toward| looks_at(normal, toward));
    if length > 0.0 && facing(seen.normal) {
        return Some(seen);
    }
    // The face that the point came through: seen from a little before it.
    let toward = toward?;
    let back = times(&inverse, toward) * (-BACK * cell);
    let before = shape.level((place + back).space());
    let (gradient, distance) = came_through(&before, back);
    let (length, normal) = outward(gradient);
    let (normal, distance) = (normal * (1.0 / length), distance / length);
    (length > 0.0 && facing(normal)).then_some(Seen { place, weights, distance, normal })
}

/// Direction and distance of the face that a point came through, from what is nearest where it was, `back` from here.
pub(super) fn came_through<const D: usize>(
    before: &SignedDistance,
    back: Vector<f64, D>,
) -> (Vector<f64, D>, f64) {
    let gradient = Vector::of(before.gradient);
    (gradient, before.distance - gradient.dot(back))
}

fn space<const D: usize>(rows: &[[f64; D]; D]) -> Matrix<f64> {
    Matrix::from_fn(|i, j| if i < D && j < D { rows[i][j] } else { f64::from(u8::from(i == j)) })
}

fn times<const D: usize>(matrix: &Matrix<f64>, vector: Vector<f64, D>) -> Vector<f64, D> {
    Vector::from_fn(|i| (0..D).map(|j| matrix.0[i][j] * vector[j]).sum())
}

fn transposed_times<const D: usize>(matrix: &Matrix<f64>, vector: Vector<f64, D>) -> Vector<f64, D> {
    Vector::from_fn(|i| (0..D).map(|j| matrix.0[j][i] * vector[j]).sum())
}
