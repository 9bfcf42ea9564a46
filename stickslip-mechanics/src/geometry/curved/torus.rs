//! A torus: a round tube in a ring.

use super::{Curved, Solid, length_fault, point_fault};
use crate::geometry::Bounds;
use crate::geometry::distance::SignedDistance;
use crate::tensor::Vector;
use serde::Serialize;
use std::f64::consts::PI;

/// All points near a circle; three dimensions only.
///
/// ```text
/// d(x) = sqrt((rho - radius)^2 + z^2) - tube_radius,   rho: distance from the axis, z: along it
/// ```
/// Exact.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Torus {
    /// Centre [m].
    pub center: [f64; 3],
    /// Axis around which the tube goes, any length [-].
    pub axis: [f64; 3],
    /// Radius of the circle in the middle of the tube [m].
    pub radius: f64,
    /// Radius of the tube [m], below the other: the torus has a hole.
    pub tube_radius: f64,
}

impl Torus {
    fn direction(&self) -> Vector<f64, 3> {
        Vector(self.axis).direction().unwrap_or(Vector([0.0, 0.0, 1.0]))
    }
}

impl Solid for Torus {
    fn level(&self, point: [f64; 3], dimension: usize) -> SignedDistance {
        if dimension == 2 {
            return SignedDistance::NOWHERE;
        }
        let axis = self.direction();
        let arm = Vector(point) - Vector(self.center);
        let along = arm.dot(axis);
        let across = arm - axis * along;
        let rho = across.norm();
        let length = (rho - self.radius).hypot(along);
        let distance = length - self.tube_radius;
        if rho == 0.0 || length == 0.0 {
            return SignedDistance { distance, gradient: [0.0; 3] };
        }
        let gradient = across * ((rho - self.radius) / (rho * length)) + axis * (along / length);
        SignedDistance { distance, gradient: gradient.0 }
    }

    fn bounds(&self, dimension: usize) -> Bounds {
        if dimension == 2 {
            return Bounds::EMPTY;
        }
        let axis = self.direction();
        // The circle reaches radius sqrt(1 - n_k^2) along axis k.
        let reach = axis.0.map(|n| self.radius * (1.0 - n * n).max(0.0).sqrt() + self.tube_radius);
        Bounds {
            min: std::array::from_fn(|k| self.center[k] - reach[k]),
            max: std::array::from_fn(|k| self.center[k] + reach[k]),
        }
    }

    fn volume(&self, dimension: usize) -> Option<f64> {
        (dimension == 3).then_some(2.0 * PI * PI * self.radius * self.tube_radius.powi(2))
    }

    fn copied(&self, factor: f64, place: &dyn Fn([f64; 3]) -> [f64; 3]) -> Curved {
        Curved::Torus(Torus {
            center: place(self.center),
            axis: self.axis,
            radius: factor * self.radius,
            tube_radius: factor * self.tube_radius,
        })
    }

    fn fault(&self, dimension: usize) -> Option<(&'static str, String, &'static str)> {
        let whole = self.tube_radius < self.radius;
        let wide = || ("tube_radius", format!("{} m", self.tube_radius), "less than the torus's radius");
        let direction = Vector(self.axis).is_finite() && self.axis != [0.0; 3];
        (dimension == 2)
            .then(|| ("", "a torus in a plane scene".to_string(), "a ball, box or polygon"))
            .or_else(|| point_fault("center", &self.center))
            .or_else(|| (!direction).then(|| ("axis", format!("{:?}", self.axis), "a vector of some length")))
            .or_else(|| length_fault("radius", self.radius))
            .or_else(|| length_fault("tube_radius", self.tube_radius))
            .or_else(|| (!whole).then(wide))
    }
}
