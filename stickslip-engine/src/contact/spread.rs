//! How wide a contact is across its shorter side, from where its nodes lie.
//!
//! ```text
//! b = min(sqrt(A/pi), max(A / (2 pi s_1), sqrt(3) s_2))
//! s_i^2 = variance of the area along its i-th longest direction - h^2/4
//! ```
//! A round patch has the radius of a circle with its area A [m^2], an ellipse its shorter half-axis, s_1 being half of
//! the longer one, and a strip 1.1 of its half-width, with s_1 that of its length. Of several patches apart, as below
//! feet in a row, s_1 says little, and s_2 of a strip is b / sqrt(3). Shares of nodes lie up to a cell off the surface:
//! that is the h^2/4. A ring reads as what is wider, a circle of its area:
//! the moments of a ring do not tell how narrow it is.

use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Shares of a contact's area and where they lie.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// [m^2]
    pub area: f64,
    /// Area times place [m^3].
    first: [f64; 3],
    /// Area times product of two places [m^4].
    second: [[f64; 3]; 3],
}

impl Spread {
    /// Adds a node's share of the area.
    pub fn add(&mut self, area: f64, place: [f64; 3]) {
        self.area += area;
        for i in 0..3 {
            self.first[i] += area * place[i];
            for j in 0..3 {
                self.second[i][j] += area * place[i] * place[j];
            }
        }
    }

    /// Adds others.
    pub fn merge(&mut self, other: &Spread) {
        self.area += other.area;
        for i in 0..3 {
            self.first[i] += other.first[i];
            (0..3).for_each(|j| self.second[i][j] += other.second[i][j]);
        }
    }

    /// The same elsewhere, so far away [m].
    pub fn moved(&self, way: [f64; 3]) -> Spread {
        let Spread { area, first, second } = *self;
        let product = |i: usize, j: usize| {
            second[i][j] + first[i] * way[j] + way[i] * first[j] + area * way[i] * way[j]
        };
        Spread {
            area,
            first: std::array::from_fn(|i| first[i] + area * way[i]),
            second: std::array::from_fn(|i| std::array::from_fn(|j| product(i, j))),
        }
    }

    /// With its image in a mirror `at` a place along an axis [m].
    pub fn with_image(&self, axis: usize, at: f64) -> Spread {
        let mut image = *self;
        let (twice, area) = (2.0 * at, self.area);
        image.first[axis] = twice * area - self.first[axis];
        for k in 0..3 {
            let product = twice * self.first[k] - self.second[axis][k];
            image.second[axis][k] = product;
            image.second[k][axis] = product;
        }
        image.second[axis][axis] = twice * (twice * area - 2.0 * self.first[axis]) + self.second[axis][axis];
        Spread {
            area: 2.0 * area,
            first: std::array::from_fn(|i| self.first[i] + image.first[i]),
            second: std::array::from_fn(|i| std::array::from_fn(|j| self.second[i][j] + image.second[i][j])),
        }
    }

    /// Half of the shorter side of a contact in space [m], on cells of this size [m].
    pub fn half_width(&self, cell: f64) -> f64 {
        if self.area <= 0.0 {
            return 0.0;
        }
        let center = self.first.map(|x| x / self.area);
        let variance = |i: usize, j: usize| self.second[i][j] / self.area - center[i] * center[j];
        let [longest, shorter, _] =
            eigenvalues(std::array::from_fn(|i| std::array::from_fn(|j| variance(i, j))));
        let [longest, shorter] = [longest, shorter].map(|square| (square - 0.25 * cell * cell).max(0.0));
        let round = (self.area / PI).sqrt();
        round.min((self.area / (2.0 * PI * longest.sqrt())).max((3.0 * shorter).sqrt()))
    }
}

/// Eigenvalues of a symmetric matrix, the largest first, by the angle of its deviator (Smith 1961).
fn eigenvalues(a: [[f64; 3]; 3]) -> [f64; 3] {
    let mean = (a[0][0] + a[1][1] + a[2][2]) / 3.0;
    let d = |i: usize, j: usize| if i == j { a[i][j] - mean } else { a[i][j] };
    let square = (0..9).map(|k| d(k / 3, k % 3).powi(2)).fold(0.0, |sum, x| sum + x);
    let size = (square / 6.0).sqrt();
    let determinant = d(0, 0) * (d(1, 1) * d(2, 2) - d(1, 2) * d(2, 1))
        - d(0, 1) * (d(1, 0) * d(2, 2) - d(1, 2) * d(2, 0))
        + d(0, 2) * (d(1, 0) * d(2, 1) - d(1, 1) * d(2, 0));
    let cosine = if size > 0.0 { 0.5 * determinant / size.powi(3) } else { 0.0 };
    let angle = libm::acos(cosine.clamp(-1.0, 1.0)) / 3.0;
    let [first, last] = [0.0, 2.0].map(|third| mean + 2.0 * size * libm::cos(angle + third * PI / 3.0));
    [first, 3.0 * mean - first - last, last]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Squares of a tenth of a cell of 1 m wherever a patch is, in a plane that is turned.
    fn patch(holds: impl Fn(f64, f64) -> bool) -> Spread {
        let mut spread = Spread::default();
        let (along, across) = ([0.6, 0.8, 0.0], [0.48, -0.36, 0.8]);
        for i in -400..400 {
            for j in -400..400 {
                let (x, y) = (0.1 * (f64::from(i) + 0.5), 0.1 * (f64::from(j) + 0.5));
                // Off the plane, as nodes are: by h^2/4 in every direction.
                if holds(x, y) {
                    for k in 0..8 {
                        let off = |axis: usize| if k >> axis & 1 == 1 { 0.5 } else { -0.5 };
                        let place = std::array::from_fn(|k| 5.0 + x * along[k] + y * across[k] + off(k));
                        spread.add(0.01 / 8.0, place);
                    }
                }
            }
        }
        spread
    }

    fn near(found: f64, expected: f64) {
        assert!((found / expected - 1.0).abs() < 0.01, "{found} instead of {expected}");
    }

    #[test]
    fn a_circle_has_its_radius_and_an_ellipse_its_shorter_half_axis() {
        near(patch(|x, y| x * x + y * y < 16.0).half_width(1.0), 4.0);
        near(patch(|x, y| x * x / 9.0 + y * y < 16.0).half_width(1.0), 4.0);
        near(patch(|x, y| x * x + y * y < 1.0).half_width(1.0), 1.0);
    }

    /// However long it is, and narrower than a cell; 2 pi to 4 sqrt(3), what an ellipse is for a strip, is 1.1.
    #[test]
    fn a_strip_has_a_tenth_more_than_its_half_width() {
        for (half_width, half_length) in [(4.0, 12.0), (2.0, 12.0), (2.0, 36.0), (0.5, 36.0)] {
            let strip = patch(|x, y| x.abs() < half_length && y.abs() < half_width);
            near(strip.half_width(1.0), half_width * 2.0 * 3f64.sqrt() / PI);
        }
    }

    /// Two feet far from each other are as wide as a strip through both.
    #[test]
    fn feet_in_a_row_are_not_narrower_for_standing_apart() {
        let feet = patch(|x, y| (x.abs() - 30.0).powi(2) + y * y < 16.0);
        near(feet.half_width(1.0), 4.0 * 0.75f64.sqrt());
    }

    /// A mirror across the length of a strip, then one along it.
    #[test]
    fn a_strip_goes_on_behind_mirrors() {
        for (axis, at) in [(0, 6.75), (1, 2.75)] {
            let [mut half, mut whole] = [Spread::default(); 2];
            for k in 0..320 {
                let place = [7.0 + 0.5 * f64::from(k / 8), 3.0 + 0.5 * f64::from(k % 8), 2.0];
                let mut image = place;
                image[axis] = 2.0 * at - place[axis];
                half.add(0.25, place);
                whole.add(0.25, place);
                whole.add(0.25, image);
            }
            let found = half.with_image(axis, at);
            assert_eq!(found.area, whole.area);
            near(found.half_width(0.5), whole.half_width(0.5));
            assert!(found.half_width(0.5) < 0.99 * (whole.area / PI).sqrt());
        }
    }
}
