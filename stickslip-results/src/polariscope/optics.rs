//! From stress to light.
//!
//! ```text
//! N = t (sigma_1 - sigma_2) / f_sigma,   f_sigma = wavelength / C           fringe order
//! circular, dark field   I = sin^2(pi N)                                    Frocht (1941), Photoelasticity I
//! circular, light field  I = cos^2(pi N)
//! plane, dark field      I = sin^2(2 (theta - alpha)) sin^2(pi N)
//! plane, light field     I = 1 - sin^2(2 (theta - alpha)) sin^2(pi N)       theta: principal direction
//!                                                                           alpha: polariser
//! ```
//!
//! Bardenhagen et al. (2001) draw cos((sigma_1 - sigma_2) / s) = cos(2 pi N), so s = f_sigma / (2 pi t). Of white light
//! each wavelength has its own order, N(lambda) = N lambda_0 / lambda: the stress-optic coefficient is taken to be the
//! same for all. In space the stress is averaged along the ray, which is exact where the principal directions do not
//! turn along it.

use super::color::{spectral_color, white_light};
use super::stress_map::Ray;
use crate::scene::{Light, Polariscope, PolariscopeField, Sensitivity};
use std::f64::consts::PI;

/// Linear red, green and blue.
pub type LinearRgb = [f64; 3];

/// A polariscope ready to be looked through.
#[derive(Clone, Debug)]
pub struct Optics {
    polariscope: Polariscope,
    /// Light without polarisers.
    lamp: LinearRgb,
    /// Of white light, the mean of cos(2 pi N(lambda)) by colour, at multiples of 1 / [`PER_ORDER`] of N.
    mean_cosine: Vec<LinearRgb>,
}

/// Entries of the table of white light in one order.
const PER_ORDER: usize = 64;
/// Orders in the table; beyond, white light has no fringes any more.
const MOST_ORDERS: usize = 24;

/// Fringe order at a pixel and how it varies there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Phase {
    /// Fringe order N.
    pub order: f64,
    /// Change of N over the pixel's width and height.
    pub change: [f64; 2],
    /// Angle of the larger principal stress from the x axis [rad]; only for optics that see directions.
    pub angle: f64,
}

impl Optics {
    /// The optics of a polariscope.
    pub fn new(polariscope: &Polariscope) -> Self {
        let (lamp, mean_cosine) = match polariscope.light {
            Light::Grey => ([1.0; 3], Vec::new()),
            Light::Monochrome => (spectral_color(polariscope.wavelength), Vec::new()),
            Light::White => ([1.0; 3], white_cosines(polariscope.wavelength)),
        };
        Optics { polariscope: *polariscope, lamp, mean_cosine }
    }

    /// Fringe order N of a ray for the polariscope's wavelength.
    pub fn order(&self, ray: &Ray) -> f64 {
        let difference = ray.principal_difference();
        match self.polariscope.sensitivity {
            Sensitivity::StressPerFringe(stress) => difference / stress,
            Sensitivity::StressThicknessPerFringe(fringe) => difference * ray.path / fringe,
        }
    }

    /// Whether the light depends on the principal direction.
    pub fn sees_directions(&self) -> bool {
        self.polariscope.polarizer.is_some()
    }

    /// Light that leaves the polariscope, of a lamp of brightness 1, averaged over the pixel.
    pub fn light(&self, phase: &Phase) -> LinearRgb {
        // Mean of cos(2 pi N) over a pixel on which N is linear.
        let blur = sinc(phase.change[0]) * sinc(phase.change[1]);
        let cosine = self.cosine(phase.order);
        let turned = [0, 1, 2].map(|i| 0.5 * (self.lamp[i] - blur * cosine[i]));
        let crossed = match self.polariscope.polarizer {
            None => turned,
            Some(alpha) => turned.map(|light| light * (2.0 * (phase.angle - alpha)).sin().powi(2)),
        };
        match self.polariscope.field {
            PolariscopeField::Dark => crossed,
            PolariscopeField::Light => [0, 1, 2].map(|i| self.lamp[i] - crossed[i]),
        }
    }

    /// The lamp's light times cos(2 pi N), by colour.
    fn cosine(&self, order: f64) -> LinearRgb {
        if self.polariscope.light != Light::White {
            let cosine = (2.0 * PI * order).cos();
            return self.lamp.map(|light| light * cosine);
        }
        let place = order * PER_ORDER as f64;
        let (entry, share) = (place as usize, place.fract());
        match (self.mean_cosine.get(entry), self.mean_cosine.get(entry + 1)) {
            (Some(a), Some(b)) => [0, 1, 2].map(|i| a[i] + share * (b[i] - a[i])),
            _ => [0.0; 3],
        }
    }
}

fn white_cosines(wavelength: f64) -> Vec<LinearRgb> {
    let spectrum = white_light();
    let mean = |entry: usize| {
        let order = entry as f64 / PER_ORDER as f64;
        let mut mean = [0.0; 3];
        for (own, shares) in &spectrum {
            let cosine = (2.0 * PI * order * wavelength / own).cos();
            (0..3).for_each(|i| mean[i] += shares[i] * cosine);
        }
        mean
    };
    (0..=MOST_ORDERS * PER_ORDER).map(mean).collect()
}

/// sin(pi x) / (pi x)
fn sinc(x: f64) -> f64 {
    let phase = PI * x;
    let square = phase * phase;
    // The series where fringes are wide, which is nearly everywhere: within 1e-9.
    if square < 0.25 {
        1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0))
    } else {
        phase.sin() / phase
    }
}
