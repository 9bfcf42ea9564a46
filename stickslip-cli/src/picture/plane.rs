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
        let mut drawn = DrawnGrains { grains, size: window.size, grain };
        drawn.close();
        drawn
    }

    /// Fills cracks between grains of one body, a pixel of the file wide at most, which are no edges of it.
    fn close(&mut self) {
        let [width, height] = self.size;
        let body = |x: i64, y: i64| {
            let place = [x, y].map(usize::try_from);
            let [Ok(x), Ok(y)] = place else { return None };
            self.grain(x, y).map(|(index, grain)| (index as u32, grain.body))
        };
        let filled = |place: usize| {
            if self.grain[place] != NOTHING {
                return None;
            }
            let (x, y) = ((place % width) as i64, (place / width) as i64);
            let first = |dx: i64, dy: i64| (1..=SAMPLES as i64).find_map(|k| body(x + k * dx, y + k * dy));
            [(1, 0), (0, 1), (1, 1), (1, -1)].iter().find_map(|&(dx, dy)| {
                let (index, one) = first(dx, dy)?;
                (first(-dx, -dy)?.1 == one).then_some((place, index))
            })
        };
        let filled: Vec<(usize, u32)> = (0..width * height).into_par_iter().filter_map(filled).collect();
        filled.into_iter().for_each(|(place, index)| self.grain[place] = index);
    }

    /// The colour of a pixel, which `color` says of a grain; `None` where there is nothing.
    pub fn color(&self, x: usize, y: usize, color: impl Fn(&Grain) -> Rgb) -> Option<Rgb> {
        let (_, grain) = self.grain(x, y)?;
        let reach = SAMPLES as i64;
        let rim = [(-reach, 0), (reach, 0), (0, -reach), (0, reach)].iter().any(|(dx, dy)| {
            let place = [x as i64 + dx, y as i64 + dy].map(usize::try_from);
            let [Ok(x), Ok(y)] = place else { return true };
            self.grain(x, y).is_none_or(|(_, neighbour)| neighbour.body != grain.body)
        });
        let color = color(grain);
        Some(if rim { shaded(color, 0.45) } else { color })
    }

    /// How many grains are particles rather than mirror images, which come last.
    pub fn count(&self, mirrored: bool) -> usize {
        if mirrored { self.grains.len() / 2 } else { self.grains.len() }
    }

    /// The grain at a pixel, with its index.
    pub fn grain(&self, x: usize, y: usize) -> Option<(usize, &Grain)> {
        let [width, height] = self.size;
        let index = *self.grain.get(y * width + x).filter(|_| x < width && y < height)? as usize;
        Some((index, self.grains.get(index)?))
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
            drawn.grain(column as usize, row as usize).is_some()
        };
        assert!(hit(0.8, 0.45) && hit(-0.8, -0.45));
        assert!(!hit(-0.3, 0.45) && !hit(0.3, -0.45));
    }

    #[test]
    fn a_crack_is_closed_and_a_gap_is_not() {
        let grain = |body: u32, x: f64| Grain {
            body,
            position: [x, 0.0, 0.0],
            side: 1.0,
            deformation: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            color: [0.5; 3],
        };
        // A pixel is 0.05 m.
        let window = PlaneView { low: [-2.0, -2.0], high: [2.0, 2.0], size: [80, 80] };
        for (body, apart, closed) in [(0, 1.1, true), (0, 1.4, false), (1, 1.1, false)] {
            let grains = [grain(0, -0.5 * apart), grain(body, 0.5 * apart)];
            let drawn = DrawnGrains::new(&grains, &window);
            assert_eq!(drawn.grain(40, 40).is_some(), closed, "{body} {apart}");
        }
    }
}
