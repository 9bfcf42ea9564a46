//! Turns about an axis.

use crate::tensor::{Vector, cross};

/// A turn about an axis through a fixed point.
pub struct Rotation {
    center: [f64; 3],
    axis: [f64; 3],
    sine: f64,
    cosine: f64,
}

impl Rotation {
    /// Right-handed by `angle` [rad] about `axis`, of any length; a turn about an axis of no length is no turn.
    ///
    /// In the plane only the axis's component out of the plane counts.
    pub fn new(center: [f64; 3], axis: [f64; 3], angle: f64, dimension: usize) -> Self {
        let axis = if dimension == 2 { [0.0, 0.0, axis[2]] } else { axis };
        match Vector(axis).direction() {
            Some(axis) => Rotation { center, axis: axis.0, sine: libm::sin(angle), cosine: libm::cos(angle) },
            None => Rotation { center, axis: [0.0; 3], sine: 0.0, cosine: 1.0 },
        }
    }

    /// Where a point goes [m].
    pub fn forward(&self, point: [f64; 3]) -> [f64; 3] {
        self.turn(point, self.sine)
    }

    /// Where a point comes from [m].
    pub(super) fn back(&self, point: [f64; 3]) -> [f64; 3] {
        self.turn(point, -self.sine)
    }

    /// A direction after the turn.
    pub(super) fn turned(&self, direction: [f64; 3]) -> [f64; 3] {
        (Vector(self.forward((Vector(self.center) + Vector(direction)).0)) - Vector(self.center)).0
    }

    /// c + d cos + (n x d) sin + n (n . d)(1 - cos),  d = x - c        Rodrigues (1840)
    fn turn(&self, point: [f64; 3], sine: f64) -> [f64; 3] {
        let arm = Vector(point) - Vector(self.center);
        let n = Vector(self.axis);
        let side = Vector(cross(n.0, arm.0));
        let turned = arm * self.cosine + side * sine + n * (n.dot(arm) * (1.0 - self.cosine));
        (Vector(self.center) + turned).0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Rotation3, Unit, Vector3};

    #[test]
    fn agrees_with_nalgebra_and_back_undoes_forward() {
        let (center, axis, angle) = ([0.5, -1.0, 2.0], [1.0, -2.0, 0.5], 2.1);
        let ours = Rotation::new(center, axis, angle, 3);
        let theirs = Rotation3::from_axis_angle(&Unit::new_normalize(Vector3::from(axis)), angle);
        let point = [3.0, 0.2, -0.7];
        let exact = theirs * (Vector3::from(point) - Vector3::from(center)) + Vector3::from(center);
        for k in 0..3 {
            assert!((ours.forward(point)[k] - exact[k]).abs() < 1e-14);
            assert!((ours.back(ours.forward(point))[k] - point[k]).abs() < 1e-14);
        }
    }
}
