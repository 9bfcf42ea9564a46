//! Plane scenes: every particle is drawn as the parallelogram that its square has become.

use super::grains::Grain;
use crate::drawing::{Rgb, SAMPLES, shaded};
use rayon::prelude::*;

/// A window on the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneView {
    /// Lower left corner [m].
    pub low: [f64; 2],
    /// Upper right corner [m].
    pub high: [f64; 2],
    /// Width and height in pixels.
    pub size: [usize; 2],
}

const NOTHING: u32 = u32::MAX;
/// Rows of the image that one thread draws at a time.
const BAND: usize = 48;
/// Particles are drawn this much larger, so that rounding leaves no cracks between them.
const OVERLAP: f64 = 1.03;

impl PlaneView {
    /// Pixel of a position, from the left and from the top.
    pub fn pixel(&self, x: [f64; 2]) -> [f64; 2] {
        let scale = self.scale();
        [(x[0] - self.low[0]) * scale, (self.high[1] - x[1]) * scale]
    }

    /// Position of a pixel.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.low[0] + x / self.scale(), self.high[1] - y / self.scale()]
    }

    /// Pixels per metre.
    pub fn scale(&self) -> f64 {
        self.size[0] as f64 / (self.high[0] - self.low[0])
    }
}

/// The grains in a window.
pub struct DrawnGrains<'a> {
    grains: &'a [Grain],
    size: [usize; 2],
    /// Index of the grain at each pixel.
    grain: Vec<u32>,
}

impl<'a> DrawnGrains<'a> {
    /// Draws the grains; where they overlap, the later one shows.
    pub fn new(grains: &'a [Grain], window: &PlaneView) -> Self {
        let [width, height] = window.size;
        let mut grain = vec![NOTHING; width * height];
        grain.par_chunks_mut(BAND * width).enumerate().for_each(|(band, pixels)| {
            for (i, each) in grains.iter().enumerate() {
                draw((i as u32, each), window, band * BAND, pixels);
            }
        });
        DrawnGrains { grains, size: window.size, grain }
    }

    /// The colour of a pixel; `None` where there is nothing.
    pub fn color(&self, x: usize, y: usize) -> Option<Rgb> {
        let grain = self.at(x as i64, y as i64)?;
        let reach = SAMPLES as i64;
        let rim = [(-reach, 0), (reach, 0), (0, -reach), (0, reach)].iter().any(|(dx, dy)| {
            self.at(x as i64 + dx, y as i64 + dy).is_none_or(|neighbour| neighbour.body != grain.body)
        });
        Some(if rim { shaded(grain.color, 0.45) } else { grain.color })
    }

    fn at(&self, x: i64, y: i64) -> Option<&Grain> {
        let x = usize::try_from(x).ok().filter(|x| *x < self.size[0])?;
        let y = usize::try_from(y).ok().filter(|y| *y < self.size[1])?;
        self.grains.get(self.grain[y * self.size[0] + x] as usize)
    }
}

/// Marks the pixels of one grain on the rows from `top` on: those whose place in the undeformed square is inside it.
fn draw((index, grain): (u32, &Grain), window: &PlaneView, top: usize, pixels: &mut [u32]) {
    let [width, _] = window.size;
    let rows = pixels.len() / width;
    let half = 0.5 * OVERLAP * grain.side * window.scale();
    let f = &grain.deformation;
    let reach = [(f[0].abs() + f[1].abs()) * half, (f[3].abs() + f[4].abs()) * half];
    let [x, y] = window.pixel([grain.position[0], grain.position[1]]);
    let det = f[0] * f[4] - f[1] * f[3];
    let span = |center: f64, reach: f64, end: usize| {
        let low = (center - reach).floor().max(0.0) as usize;
        low..((center + reach).ceil().max(0.0) as usize).min(end)
    };
    for row in span(y - top as f64, reach[1], rows) {
        let up = y - ((top + row) as f64 + 0.5);
        for column in span(x, reach[0], width) {
            let right = column as f64 + 0.5 - x;
            let local = [(f[4] * right - f[1] * up) / det, (f[0] * up - f[3] * right) / det];
            if local[0].abs() <= half && local[1].abs() <= half {
                pixels[row * width + column] = index;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sheared_square_is_drawn_as_a_parallelogram() {
        let grain = Grain {
            body: 0,
            position: [0.0; 3],
            side: 1.0,
            deformation: [1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            color: [0.5; 3],
        };
        let grains = [grain];
        let window = PlaneView { low: [-2.0, -2.0], high: [2.0, 2.0], size: [80, 80] };
        let drawn = DrawnGrains::new(&grains, &window);
        let hit = |x: f64, y: f64| {
            let [column, row] = window.pixel([x, y]);
            drawn.color(column as usize, row as usize).is_some()
        };
        assert!(hit(0.8, 0.45) && hit(-0.8, -0.45));
        assert!(!hit(-0.3, 0.45) && !hit(0.3, -0.45));
    }
}
