//! The part of the plane that an image shows.

/// A rectangle of the plane, and the pixels of its image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Lower left corner [m].
    pub low: [f64; 2],
    /// Upper right corner [m].
    pub high: [f64; 2],
    /// Width and height in pixels; pixels are square.
    pub size: [usize; 2],
}

impl Window {
    /// The whole of a rectangle in an image `width` pixels wide and as high as it takes.
    pub fn around([low, high]: [[f64; 2]; 2], width: usize) -> Self {
        let aspect = (high[1] - low[1]) / (high[0] - low[0]);
        let height = ((width as f64 * aspect).round() as usize).clamp(16, 8 * width);
        Window { low, high, size: [width, height] }
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
