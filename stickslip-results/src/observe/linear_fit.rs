//! What the particles around a point have there: the straight line through them in the sense of least squares.
//!
//! ```text
//! q(x) = q_m + grad q . (x - x_m),   grad q = C^-1 sum w (x_p - x_m) q_p / W
//! x_m = sum w x_p / W,   q_m = sum w q_p / W,   C = sum w (x_p - x_m) (x) (x_p - x_m) / W,   W = sum w
//! ```
//! (moving least squares, Lancaster & Salkauskas 1981, Math. Comp. 37). It is the mean of the particles with other
//! weights, whose sum is W too:
//!
//! ```text
//! a_p = w_p (1 + k . (x_p - x_m)),   k = C^-1 (x - x_m)
//! ```
//! Exact for what is linear, up to the surface and a quarter of a cell beyond. Farther out it is the value there.

use crate::exact::ExactSum;
use serde::{Deserialize, Serialize};

/// Sums over particles around a point of their weights and places.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct PlaceSums {
    weight: ExactSum,
    /// Of offsets from the point [m].
    first: [ExactSum; 3],
    /// xx, yy, zz, xy, yz, xz.
    second: [ExactSum; 6],
}

/// k and x_m of a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct LinearFit {
    slope: [f64; 3],
    /// As an offset from the point [m].
    middle: [f64; 3],
}

/// sqrt(k . C k) at most: 1.6 on a face, 2.2 on an edge, 2.9 on a corner, 2.8 a quarter of a cell before a face.
const FARTHEST: f64 = 3.0;
/// Variance of the places along an axis, over the radius of the weights squared, below which nothing is known of slopes
/// along it: the body is as thin as a particle.
const THIN: f64 = 1.25e-3;
/// Rows and columns of the entries of `second`.
const ENTRIES: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [0, 2]];

impl PlaceSums {
    /// Adds a particle at an offset from the point [m].
    pub(super) fn add(&mut self, weight: f64, offset: [f64; 3]) {
        self.weight.add(weight);
        self.first.iter_mut().zip(offset).for_each(|(sum, x)| sum.add(weight * x));
        let products = ENTRIES.map(|[i, j]| weight * offset[i] * offset[j]);
        self.second.iter_mut().zip(products).for_each(|(sum, x)| sum.add(x));
    }

    /// Adds the sums over others.
    pub(super) fn merge(&mut self, other: &PlaceSums) {
        self.weight.merge(&other.weight);
        ExactSum::merge_each(&mut self.first, &other.first);
        ExactSum::merge_each(&mut self.second, &other.second);
    }

    /// W
    pub(super) fn weight(&self) -> f64 {
        self.weight.value()
    }

    /// The fit of weights that reach this far [m].
    pub(super) fn fit(&self, radius: f64) -> LinearFit {
        let weight = self.weight();
        let middle = self.first.each_ref().map(|sum| sum.value() / weight);
        let mut variance = [[0.0; 3]; 3];
        for ([i, j], sum) in ENTRIES.into_iter().zip(&self.second) {
            variance[i][j] = sum.value() / weight - middle[i] * middle[j];
            variance[j][i] = variance[i][j];
        }
        let (values, axes) = principal(variance);
        let least = THIN * radius * radius;
        let along = |axis: usize| -(0..3).map(|i| axes[axis][i] * middle[i]).sum::<f64>();
        let known = (0..3).filter(|&axis| values[axis] > least);
        let far = known.clone().map(|axis| along(axis).powi(2) / values[axis]).sum::<f64>().sqrt();
        let part = if far > FARTHEST { FARTHEST / far } else { 1.0 };
        let mut slope = [0.0; 3];
        for axis in known {
            (0..3).for_each(|i| slope[i] += part * along(axis) / values[axis] * axes[axis][i]);
        }
        LinearFit { slope, middle }
    }
}

impl LinearFit {
    /// a_p / w_p of a particle at an offset from the point [m].
    pub(super) fn part(&self, offset: [f64; 3]) -> f64 {
        1.0 + (0..3).map(|i| self.slope[i] * (offset[i] - self.middle[i])).sum::<f64>()
    }
}

/// Eigenvalues of a symmetric matrix and their unit vectors, by Jacobi's rotations.
fn principal(mut matrix: [[f64; 3]; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
    let mut axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    // Each sweep squares what is off the diagonal.
    for [p, q] in [[0, 1], [0, 2], [1, 2]].repeat(8) {
        if matrix[p][q] == 0.0 {
            continue;
        }
        let theta = 0.5 * (matrix[q][q] - matrix[p][p]) / matrix[p][q];
        let tangent = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
        let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
        let sine = tangent * cosine;
        for row in &mut matrix {
            let [a, b] = [row[p], row[q]];
            (row[p], row[q]) = (cosine * a - sine * b, sine * a + cosine * b);
        }
        for k in 0..3 {
            let [a, b] = [matrix[p][k], matrix[q][k]];
            (matrix[p][k], matrix[q][k]) = (cosine * a - sine * b, sine * a + cosine * b);
            let [a, b] = [axes[p][k], axes[q][k]];
            (axes[p][k], axes[q][k]) = (cosine * a - sine * b, sine * a + cosine * b);
        }
    }
    (std::array::from_fn(|i| matrix[i][i]), axes)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Value at a point of q = 1 + 2 x - 3 y + z / 2 on particles in the first octant, half a metre apart; cells of 1 m.
    fn value_at(point: [f64; 3], dimension: usize) -> f64 {
        let side = |axis: usize| if axis < dimension { 0..12 } else { 0..1 };
        let mut sums = PlaceSums::default();
        let mut particles = Vec::new();
        for (i, j, k) in side(0).flat_map(|i| side(1).flat_map(move |j| side(2).map(move |k| (i, j, k)))) {
            let place = [i, j, k].map(|i| 0.25 + 0.5 * f64::from(i));
            let offset: [f64; 3] =
                std::array::from_fn(|i| if i < dimension { place[i] - point[i] } else { 0.0 });
            let r = offset.iter().map(|x| x * x).sum::<f64>().sqrt() / 2.0;
            if r < 1.0 {
                let weight = (1.0 - r).powi(4) * (1.0 + 4.0 * r);
                sums.add(weight, offset);
                particles.push((weight, offset, linear(std::array::from_fn(|i| point[i] + offset[i]))));
            }
        }
        let fit = sums.fit(2.0);
        let parts = particles.iter().map(|&(weight, offset, q)| (weight * fit.part(offset), q));
        let (all, sum) = parts.fold((0.0, 0.0), |(all, sum), (a, q)| (all + a, sum + a * q));
        assert!((all / sums.weight() - 1.0).abs() < 1e-12);
        sum / all
    }

    fn linear([x, y, z]: [f64; 3]) -> f64 {
        1.0 + 2.0 * x - 3.0 * y + 0.5 * z
    }

    #[test]
    fn what_is_linear_is_exact_up_to_faces_edges_and_corners() {
        for point in [[2.0, 3.0, 2.5], [0.0, 3.0, 3.0], [0.1, 0.0, 3.0], [0.0; 3], [-0.2, 3.0, 2.6]] {
            let found = value_at(point, 3);
            assert!((found - linear(point)).abs() < 1e-9, "{point:?}: {found}");
            let flat = [point[0], point[1], 0.0];
            assert!((value_at(flat, 2) - linear(flat)).abs() < 1e-9, "{point:?}");
        }
    }

    /// A cell and more beyond the surface the value stays near that of the surface.
    #[test]
    fn nothing_is_carried_far_beyond_a_surface() {
        for away in [0.5, 1.0, 1.5, 1.7] {
            let found = value_at([-away, 3.0, 0.0], 2);
            assert!((found - linear([0.0, 3.0, 0.0])).abs() < 1.0, "{away}: {found}");
        }
    }

    /// A row of particles tells no slope across it.
    #[test]
    fn a_body_as_thin_as_a_particle_has_no_slope_across() {
        let mut sums = PlaceSums::default();
        // At 45 degrees, and the point beside the row.
        let row: Vec<[f64; 3]> =
            (-3..=3).map(|i| [0.3 * f64::from(i) + 0.1, 0.3 * f64::from(i) - 0.1, 0.0]).collect();
        row.iter().for_each(|&offset| sums.add(1.0, offset));
        let fit = sums.fit(2.0);
        assert!(row.iter().all(|&offset| (fit.part(offset) - 1.0).abs() < 1e-12), "{fit:?}");
    }

    #[test]
    fn principal_axes_give_the_matrix_back() {
        let matrix = [[4.0, 1.0, -2.0], [1.0, 2.0, 0.5], [-2.0, 0.5, 3.0]];
        let (values, axes) = principal(matrix);
        for i in 0..3 {
            for j in 0..3 {
                let back: f64 = (0..3).map(|k| values[k] * axes[k][i] * axes[k][j]).sum();
                assert!((back - matrix[i][j]).abs() < 1e-12, "{back}");
            }
        }
    }
}
