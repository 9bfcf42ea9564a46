//! Film: sums up light while the shutter is open.

use super::color::Screen;
use super::optics::LinearRgb;
use crate::image::Image;
use serde::{Deserialize, Serialize};

/// Light on each pixel, linear, summed over exposures.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Film {
    size: [usize; 2],
    light: Vec<[f32; 3]>,
    exposures: usize,
}

impl Film {
    /// Film of this width and height in pixels.
    pub fn new(size: [usize; 2]) -> Self {
        Film { size, light: vec![[0.0; 3]; size[0] * size[1]], exposures: 0 }
    }

    /// Whether it has this width and height in pixels, and light on each.
    pub fn fits(&self, size: [usize; 2]) -> bool {
        self.size == size && size[0].checked_mul(size[1]) == Some(self.light.len())
    }

    /// Times that light fell on it.
    pub fn exposures(&self) -> usize {
        self.exposures
    }

    /// Adds the light of an instant, rows from the top.
    pub(crate) fn expose(&mut self, light: &[LinearRgb]) {
        self.exposures += 1;
        for (sum, light) in self.light.iter_mut().zip(light) {
            (0..3).for_each(|i| sum[i] += light[i] as f32);
        }
    }

    /// The image of the mean light; what is too bright or out of the screen's gamut is clipped.
    pub fn develop(&self) -> Image {
        let share = 1.0 / self.exposures.max(1) as f64;
        let screen = Screen::new();
        let mut pixels = vec![0; 3 * self.light.len()];
        for (pixel, light) in pixels.chunks_exact_mut(3).zip(&self.light) {
            (0..3).for_each(|i| pixel[i] = screen.byte(f64::from(light[i]) * share));
        }
        Image::opaque(self.size, pixels)
    }
}
