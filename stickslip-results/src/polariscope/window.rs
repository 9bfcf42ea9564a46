//! The part of the plane that an image shows.

use serde::{Deserialize, Serialize};

/// A rectangle of the plane, and the pixels of its image.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ImageWindow {
    /// Lower left corner [m].
    pub low: [f64; 2],
    /// Upper right corner [m].
    pub high: [f64; 2],
    /// Width and height in pixels; pixels are square.
    pub size: [usize; 2],
}

impl ImageWindow {
    /// The whole of a rectangle in an image `width` pixels wide and as high as it takes.
    pub fn around([low, high]: [[f64; 2]; 2], width: usize) -> Self {
        let aspect = (high[1] - low[1]) / (high[0] - low[0]);
        let height = ((width as f64 * aspect).round() as usize).clamp(16, 8 * width);
        ImageWindow { low, high, size: [width, height] }
    }

    /// A rectangle in the middle of an image of this size.
    pub fn fitted_into([low, high]: [[f64; 2]; 2], size: [usize; 2]) -> Self {
        let pixels = size.map(|side| side as f64);
        let scale = (pixels[0] / (high[0] - low[0])).min(pixels[1] / (high[1] - low[1]));
        let end = |axis: usize, side: f64| 0.5 * (low[axis] + high[axis] + side * pixels[axis] / scale);
        ImageWindow { low: [end(0, -1.0), end(1, -1.0)], high: [end(0, 1.0), end(1, 1.0)], size }
    }

    /// Pixels per metre.
    pub fn scale(&self) -> f64 {
        self.size[0] as f64 / (self.high[0] - self.low[0])
    }

    /// Pixel of a position, from the left and from the top; the middle of the first pixel is at 0.5.
    pub fn pixel(&self, x: [f64; 2]) -> [f64; 2] {
        let scale = self.scale();
        [(x[0] - self.low[0]) * scale, (self.high[1] - x[1]) * scale]
    }

    /// Position of the middle of a pixel [m].
    pub fn position(&self, column: usize, row: usize) -> [f64; 2] {
        let scale = self.scale();
        [self.low[0] + (column as f64 + 0.5) / scale, self.high[1] - (row as f64 + 0.5) / scale]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_holds_what_it_must() {
        let tall = ImageWindow::around([[1.0, 0.0], [2.0, 3.0]], 100);
        assert_eq!((tall.size, tall.pixel([1.5, 3.0])), ([100, 300], [50.0, 0.0]));
        let [x, y] = tall.position(0, 299);
        assert!((x - 1.005).abs() < 1e-12 && (y - 0.005).abs() < 1e-12);
        let wide = ImageWindow::fitted_into([[1.0, 0.0], [2.0, 3.0]], [600, 300]);
        assert_eq!((wide.low, wide.high), ([-1.5, 0.0], [4.5, 3.0]));
        assert_eq!(wide.scale(), 100.0);
    }
}
