//! Stress on the pixels of an image, interpolated between the particles of one body.
//!
//! Moving least squares (Lancaster and Salkauskas 1981): around each pixel a plane a + b.(x - x_pixel) is fitted to the
//! stress of the particles within a reach R of two distances between particles, with weights
//!
//! ```text
//! w = A (1 - r^2/R^2)^3          A: the particle's area
//! ```
//!
//! so stress that varies linearly is met exactly, up to the body's surface. Only the body's own particles count: stress
//! does not smear across contacts. How much of the body covers a pixel is
//!
//! ```text
//! c = sum w / (pi R^2 / 4)       1 inside, 1/2 on a straight surface
//! ```

use super::ImageWindow;
use super::cloud::{Cloud, Outline};
use super::seen::SeenBody;
use rayon::prelude::*;
use std::f64::consts::PI;

/// What a ray of light meets in one body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ray {
    /// Share of the pixel that the body covers, 0 to 1.
    pub coverage: f64,
    /// Cauchy stress xx, yy, xy, averaged along the ray, tension positive [Pa].
    pub stress: [f64; 3],
    /// Way through the body [m]; 1 in a plane scene.
    pub path: f64,
}

/// The rays through one body, on the pixels of a part of a window.
#[derive(Clone, Debug)]
pub struct StressMap {
    /// Index of the body.
    pub body: usize,
    /// Left and top pixel.
    pub corner: [usize; 2],
    /// Width and height in pixels.
    pub size: [usize; 2],
    /// Rows from the top.
    pub rays: Vec<Ray>,
}

/// Reach of the kernel in distances between particles: a dozen of them, so that the steps of a lattice smooth out.
pub const REACH: f64 = 2.0;

/// Reach in pixels at least: the kernels of neighbouring pixels then leave no particle out, and the edge of a body is as
/// sharp as the pixels.
pub const LEAST_PIXELS: f64 = 1.5;

/// Part of the points' mean square distance (in reaches) added to that of every fit: a single row of particles has no
/// slope across itself.
const RIDGE: f64 = 1e-3;

impl Ray {
    /// Difference of the principal stresses in the plane, sqrt((xx - yy)^2 + 4 xy^2) [Pa].
    pub fn principal_difference(&self) -> f64 {
        let [xx, yy, xy] = self.stress;
        (xx - yy).hypot(2.0 * xy)
    }

    /// Angle of the larger principal stress from the x axis, -pi/2 to pi/2 [rad].
    pub fn principal_angle(&self) -> f64 {
        let [xx, yy, xy] = self.stress;
        0.5 * (2.0 * xy).atan2(xx - yy)
    }
}

impl StressMap {
    /// The rays of a window that may meet a body; `None` if all miss it.
    pub(super) fn new(seen: &SeenBody, window: &ImageWindow) -> Option<Self> {
        let cloud = Cloud::of(seen, REACH, LEAST_PIXELS / window.scale());
        let Outline { body, bounds, reach, .. } = cloud.outline;
        let [left, bottom] = window.pixel(bounds[0].map(|x| x - reach));
        let [right, top] = window.pixel(bounds[1].map(|x| x + reach));
        let inside = |pixel: f64, axis: usize| pixel.clamp(0.0, window.size[axis] as f64) as usize;
        let corner = [inside(left.floor(), 0), inside(top.floor(), 1)];
        let end = [inside(right.ceil(), 0), inside(bottom.ceil(), 1)];
        if end[0] <= corner[0] || end[1] <= corner[1] {
            return None;
        }
        let size = [end[0] - corner[0], end[1] - corner[1]];
        let mut rays = vec![Ray::default(); size[0] * size[1]];
        rays.par_chunks_mut(size[0]).enumerate().for_each_init(Vec::new, |sums, (row, rays)| {
            let first = window.position(corner[0], corner[1] + row);
            sums.clear();
            sums.resize(rays.len(), FitSums::default());
            sum_row(&cloud, first, (window.scale(), &mut *sums));
            for (ray, sums) in rays.iter_mut().zip(&*sums) {
                *ray = sums.ray(reach, window.scale());
            }
        });
        Some(StressMap { body, corner, size, rays })
    }

    /// The ray through a pixel of the window, if it is one of the map's.
    pub fn ray(&self, column: usize, row: usize) -> Option<&Ray> {
        let x = column.checked_sub(self.corner[0]).filter(|x| *x < self.size[0])?;
        let y = row.checked_sub(self.corner[1]).filter(|y| *y < self.size[1])?;
        Some(&self.rays[y * self.size[0] + x])
    }
}

/// Sums over the points around a pixel, with the four values v of each, and lengths in reaches:
///
/// ```text
/// w, w v, w dy, w dy v, w dy dy | w dx, w dx v, w dx dy | w dx dx
/// ```
#[derive(Clone, Copy, Debug, Default)]
struct FitSums {
    plain: [f64; 11],
    along: [f64; 6],
    square: f64,
}

/// Adds the points of a cloud to the pixels of a row, of which the first is at a place; `scale` is in pixels per metre.
fn sum_row(cloud: &Cloud, first: [f64; 2], (scale, row): (f64, &mut [FitSums])) {
    let reach = cloud.outline.reach;
    let step = 1.0 / (scale * reach);
    for point in cloud.across(first[1]) {
        let [left, dy] = [0, 1].map(|axis| (point.place[axis] - first[axis]) / reach);
        let half = 1.0 - dy * dy;
        if half <= 0.0 {
            continue;
        }
        let [a, b, c, d] = point.values;
        let plain = [1.0, a, b, c, d, dy, dy * a, dy * b, dy * c, dy * d, dy * dy];
        let along = [1.0, a, b, c, d, dy];
        let wide = half.sqrt();
        // Pixels whose middle is so near; beyond the row there are none.
        let start = ((left - wide) / step).ceil().max(0.0) as usize;
        let end = (((left + wide) / step).floor() + 1.0).clamp(0.0, row.len() as f64) as usize;
        for (column, sums) in row.iter_mut().enumerate().take(end).skip(start) {
            let dx = left - column as f64 * step;
            let gap = (half - dx * dx).max(0.0);
            let w = point.area * gap * gap * gap;
            let wdx = w * dx;
            for (sum, factor) in sums.plain.iter_mut().zip(plain) {
                *sum += w * factor;
            }
            for (sum, factor) in sums.along.iter_mut().zip(along) {
                *sum += wdx * factor;
            }
            sums.square += wdx * dx;
        }
    }
}

impl FitSums {
    /// The ray through a pixel whose points lie so far away at most [m]; `scale` is in pixels per metre.
    fn ray(&self, reach: f64, scale: f64) -> Ray {
        let FitSums { plain, along, square } = self;
        let filled = plain[0] / (0.25 * PI * reach * reach);
        // Across a straight surface c rises by 128 / (35 pi R) a metre where it is 1/2.
        let rise = 128.0 / (35.0 * PI * reach * scale);
        let coverage = (0.5 + (filled - 0.5) / rise).clamp(0.0, 1.0);
        if coverage == 0.0 {
            return Ray::default();
        }
        let [a, b, c] = first_row_of_inverse([plain[0], along[0], plain[5]], [*square, along[5], plain[10]]);
        let fitted = |k: usize| a * plain[k] + b * along[k] + c * plain[5 + k];
        Ray { coverage, stress: [fitted(1), fitted(2), fitted(3)], path: fitted(4).max(0.0) }
    }
}

/// First row of the inverse of the matrix of moments, made regular by [`RIDGE`].
fn first_row_of_inverse([one, x, y]: [f64; 3], [xx, xy, yy]: [f64; 3]) -> [f64; 3] {
    let (xx, yy) = (xx + RIDGE * one, yy + RIDGE * one);
    let cofactors = [xx * yy - xy * xy, xy * y - x * yy, x * xy - xx * y];
    let det = one * cofactors[0] + x * cofactors[1] + y * cofactors[2];
    cofactors.map(|cofactor| cofactor / det)
}
