//! A part of an image as a shape.

use super::lattice::Lattice;
use crate::geometry::Bounds;
use crate::geometry::curved::{Curved, Solid};
use crate::geometry::distance::SignedDistance;
use crate::geometry::from_file::FromFile;
use crate::tensor::Vector;
use serde::{Serialize, Serializer};
use std::sync::Arc;

/// A part of an image: its surface is where a smooth field of signed distances is zero.
///
/// ```text
/// d(x) = sum over pixels of c_i B(x - x_i),   B: cubic B-splines,   normal = grad d / |grad d|
/// ```
/// The normal has no steps. Distances are good to a part of a pixel as far as the field goes, some pixels around the
/// part; beyond it they are too long by a few hundredths. A copy shares the field.
#[derive(Clone, Debug, PartialEq)]
pub struct ImagePart {
    name: Arc<str>,
    levels: Arc<Levels>,
    /// Middle of the first pixel of the field [m].
    first: [f64; 3],
    /// Side of a pixel [m].
    pixel: f64,
}

/// What is known of a part; lengths are in pixels, from the middle of the first of its field.
#[derive(Debug, PartialEq)]
struct Levels {
    coefficients: Lattice,
    /// Pixels that hold it.
    held: [[f64; 3]; 2],
}

/// Slopes of the field below which no direction stands out.
const FLAT: f64 = 0.1;

impl ImagePart {
    /// Of distances in pixels as coefficients of B-splines; its pixels are between the corners `held`.
    pub(super) fn new(
        name: &str,
        (coefficients, held): (Lattice, [[f64; 3]; 2]),
        first: [f64; 3],
        pixel: f64,
    ) -> Self {
        ImagePart { name: name.into(), levels: Arc::new(Levels { coefficients, held }), first, pixel }
    }

    pub(super) fn is_plane(&self) -> bool {
        self.levels.coefficients.dimension() == 2
    }
}

impl Solid for ImagePart {
    fn level(&self, point: [f64; 3], dimension: usize) -> SignedDistance {
        let field = &self.levels.coefficients;
        if field.dimension() != dimension {
            return SignedDistance::NOWHERE;
        }
        let place: [f64; 3] =
            std::array::from_fn(
                |k| if k < dimension { (point[k] - self.first[k]) / self.pixel } else { 0.0 },
            );
        // Where all splines are that reach there.
        let within: [f64; 3] = std::array::from_fn(|k| match k < dimension {
            true => place[k].clamp(1.0, (field.counts[k] - 2) as f64 * (1.0 - 1e-12)),
            false => 0.0,
        });
        let (distance, gradient) = field.spline_at(within);
        let slope = Vector(gradient).norm();
        let out = if slope < FLAT { Vector([0.0; 3]) } else { Vector(gradient) / slope };
        let (distance, out) = match place == within {
            true => (distance, out),
            // Beyond the field, from the place on the surface that is nearest to the edge of the field.
            false => {
                let arm = Vector(place) - (Vector(within) - out * distance);
                (arm.norm(), arm / arm.norm())
            }
        };
        SignedDistance { distance: distance * self.pixel, gradient: out.0 }
    }

    fn bounds(&self, dimension: usize) -> Bounds {
        if self.levels.coefficients.dimension() != dimension {
            return Bounds::EMPTY;
        }
        let [min, max] = self.levels.held.map(|x| std::array::from_fn(|k| self.first[k] + self.pixel * x[k]));
        Bounds { min, max }
    }

    fn volume(&self, _: usize) -> Option<f64> {
        None
    }

    fn copied(&self, factor: f64, place: &dyn Fn([f64; 3]) -> [f64; 3]) -> Curved {
        Curved::Image(ImagePart { first: place(self.first), pixel: factor * self.pixel, ..self.clone() })
    }

    fn fault(&self, _: usize) -> Option<(&'static str, String, &'static str)> {
        None
    }
}

impl Serialize for ImagePart {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Levels { coefficients, held } = &*self.levels;
        let counts = coefficients.counts.iter().map(|&count| count as f64);
        let place = held.iter().flatten().chain(&self.first).chain([&self.pixel]).copied();
        let values = coefficients.values.iter().map(|&value| f64::from(value));
        FromFile::new(&self.name, counts.chain(place).chain(values)).serialize(serializer)
    }
}
