//! A capsule: all points near a line between two points.

use super::{Curved, Solid, length_fault, point_fault};
use crate::geometry::Bounds;
use crate::geometry::distance::SignedDistance;
use crate::tensor::Vector;
use serde::Serialize;
use std::f64::consts::PI;

/// A cylinder with half a ball on each end; in the plane a rectangle with half a disk on each end.
///
/// ```text
/// d(x) = |x - nearest point between start and end| - radius
/// ```
/// Exact.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Capsule {
    /// Centre of the half ball at one end [m].
    pub start: [f64; 3],
    /// Centre of the half ball at the other end [m].
    pub end: [f64; 3],
    /// Radius [m].
    pub radius: f64,
}

impl Capsule {
    fn length(&self, dimension: usize) -> f64 {
        (0..dimension).map(|k| (self.end[k] - self.start[k]).powi(2)).sum::<f64>().sqrt()
    }
}

impl Solid for Capsule {
    fn level(&self, point: [f64; 3], dimension: usize) -> SignedDistance {
        let flat = |a: [f64; 3]| Vector(std::array::from_fn(|k| if k < dimension { a[k] } else { 0.0 }));
        let (start, end, point) = (flat(self.start), flat(self.end), flat(point));
        let axis = end - start;
        let squared = axis.dot(axis);
        let along = if squared > 0.0 { ((point - start).dot(axis) / squared).clamp(0.0, 1.0) } else { 0.0 };
        let arm = point - start - axis * along;
        let length = arm.norm();
        let gradient = if length > 0.0 { (arm / length).0 } else { [0.0; 3] };
        SignedDistance { distance: length - self.radius, gradient }
    }

    fn bounds(&self, _: usize) -> Bounds {
        Bounds::around([self.start, self.end]).grown(self.radius)
    }

    fn volume(&self, dimension: usize) -> Option<f64> {
        let (radius, length) = (self.radius, self.length(dimension));
        Some(match dimension {
            2 => 2.0 * radius * length + PI * radius * radius,
            _ => PI * radius * radius * (length + 4.0 / 3.0 * radius),
        })
    }

    fn copied(&self, factor: f64, place: &dyn Fn([f64; 3]) -> [f64; 3]) -> Curved {
        let Capsule { start, end, radius } = *self;
        Curved::Capsule(Capsule { start: place(start), end: place(end), radius: factor * radius })
    }

    fn fault(&self, _: usize) -> Option<(&'static str, String, &'static str)> {
        point_fault("start", &self.start)
            .or_else(|| point_fault("end", &self.end))
            .or_else(|| length_fault("radius", self.radius))
    }
}
