//! A box with rounded edges and corners.

use super::{Curved, Solid, length_fault, point_fault};
use crate::geometry::Bounds;
use crate::geometry::distance::{SignedDistance, slab};
use serde::Serialize;
use std::f64::consts::PI;

/// All points no further than `rounding` from a box that is smaller by that on all sides.
///
/// ```text
/// d(x) = distance to the smaller box - rounding
/// ```
/// Exact.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RoundedBox {
    /// Lower corner, as if it were sharp [m].
    pub min: [f64; 3],
    /// Upper corner, as if it were sharp [m].
    pub max: [f64; 3],
    /// Radius of edges and corners [m], at most half of the shortest side.
    pub rounding: f64,
}

impl RoundedBox {
    /// Sides of the smaller box [m].
    fn sides(&self) -> [f64; 3] {
        std::array::from_fn(|k| self.max[k] - self.min[k] - 2.0 * self.rounding)
    }
}

impl Solid for RoundedBox {
    fn level(&self, point: [f64; 3], dimension: usize) -> SignedDistance {
        let r = self.rounding;
        let inner = (0..dimension)
            .map(|k| slab(k, [self.min[k] + r, self.max[k] - r], point[k]))
            .fold(SignedDistance::EVERYWHERE, SignedDistance::square);
        SignedDistance { distance: inner.distance - r, ..inner }
    }

    fn bounds(&self, _: usize) -> Bounds {
        Bounds { min: self.min, max: self.max }
    }

    fn volume(&self, dimension: usize) -> Option<f64> {
        let ([x, y, z], r) = (self.sides(), self.rounding);
        Some(match dimension {
            2 => x * y + 2.0 * r * (x + y) + PI * r * r,
            _ => {
                x * y * z
                    + 2.0 * r * (x * y + y * z + z * x)
                    + PI * r * r * (x + y + z)
                    + 4.0 / 3.0 * PI * r.powi(3)
            }
        })
    }

    fn copied(&self, factor: f64, place: &dyn Fn([f64; 3]) -> [f64; 3]) -> Curved {
        let RoundedBox { min, max, rounding } = *self;
        Curved::RoundedBox(RoundedBox { min: place(min), max: place(max), rounding: factor * rounding })
    }

    fn fault(&self, dimension: usize) -> Option<(&'static str, String, &'static str)> {
        let ordered = (0..dimension).all(|k| self.min[k] < self.max[k]);
        let found = || format!("from {:?} to {:?} m", &self.min[..dimension], &self.max[..dimension]);
        // A box that is round from end to end may miss by round-off.
        let room = (0..dimension).all(|k| 2.0 * self.rounding <= (self.max[k] - self.min[k]) * (1.0 + 1e-12));
        point_fault("min", &self.min)
            .or_else(|| point_fault("max", &self.max))
            .or_else(|| (!ordered).then(|| ("max", found(), "each component above that of min")))
            .or_else(|| length_fault("rounding", self.rounding))
            .or_else(|| {
                (!room).then(|| {
                    ("rounding", format!("{} m", self.rounding), "at most half of the shortest side")
                })
            })
    }
}
