//! Rows of an image of the plane, and the pixels of particles in them.

use super::grains::Grain;
use super::plane::{NOTHING, PlaneView};
use super::splat::Shares;
use std::ops::Range;

/// Rows that one thread draws at a time.
pub const BAND: usize = 48;

/// Some rows of an image.
pub struct Band<'a> {
    window: &'a PlaneView,
    /// The first of them, and how many they are.
    top: usize,
    rows: usize,
}

impl<'a> Band<'a> {
    /// Those that one thread draws at a time, by their number.
    pub fn new(number: usize, window: &'a PlaneView) -> Self {
        let top = number * BAND;
        Band { window, top, rows: BAND.min(window.size[1] - top) }
    }

    /// Rows of the band and columns between two corners of the image [pixels].
    fn within(&self, low: [f64; 2], high: [f64; 2]) -> [Range<usize>; 2] {
        let range = |low: f64, high: f64, end: usize| {
            low.floor().max(0.0) as usize..(high.ceil().max(0.0) as usize).min(end)
        };
        let top = self.top as f64;
        [range(low[1] - top, high[1] - top, self.rows), range(low[0], high[0], self.window.size[0])]
    }

    /// Visits the band's pixels of a grain, as if the half of its side were `half` [m]: with the place in the
    /// undeformed square from its middle [m].
    pub fn visit(&self, grain: &Grain, half: f64, mut visit: impl FnMut(usize, [f64; 2])) {
        let (f, scale) = (&grain.deformation, self.window.scale());
        let det = f[0] * f[4] - f[1] * f[3];
        let reach = [0, 1].map(|axis| (f[3 * axis].abs() + f[3 * axis + 1].abs()) * half * scale);
        let [x, y] = self.window.pixel([grain.position[0], grain.position[1]]);
        let [rows, columns] = self.within([x - reach[0], y - reach[1]], [x + reach[0], y + reach[1]]);
        for row in rows {
            let up = (y - ((self.top + row) as f64 + 0.5)) / scale;
            for column in columns.clone() {
                let right = (column as f64 + 0.5 - x) / scale;
                let local = [(f[4] * right - f[1] * up) / det, (f[0] * up - f[3] * right) / det];
                if local[0].abs() <= half && local[1].abs() <= half {
                    visit(row * self.window.size[0] + column, local);
                }
            }
        }
    }

    /// Marks what is free between three grains, each pixel as the nearest of them.
    pub fn join(&self, grains: &[Grain], three: [u32; 3], pixels: &mut [u32]) {
        let corners = three.map(|i| {
            let [x, y, _] = grains[i as usize].position;
            self.window.pixel([x, y])
        });
        let bound = |pick: fn(f64, f64) -> f64| {
            [0, 1].map(|axis| pick(corners[0][axis], pick(corners[1][axis], corners[2][axis])))
        };
        let [rows, columns] = self.within(bound(f64::min), bound(f64::max));
        let Some(shares) = Shares::new(corners.map(|[x, y]| [x, y, 0.0])) else { return };
        for row in rows {
            let y = (self.top + row) as f64 + 0.5;
            for column in columns.clone() {
                let (pixel, x) = (row * self.window.size[0] + column, column as f64 + 0.5);
                if pixels[pixel] == NOTHING && shares.at([x, y]).iter().all(|share| *share >= 0.0) {
                    let apart = corners.map(|corner| (corner[0] - x).hypot(corner[1] - y));
                    let nearest = (0..3).min_by(|&a, &b| apart[a].total_cmp(&apart[b]));
                    pixels[pixel] = three[nearest.expect("there are three")];
                }
            }
        }
    }
}
