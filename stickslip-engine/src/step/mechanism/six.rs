//! Six numbers of a rigid body: velocity and angular velocity, or momentum and angular momentum about its centre.

use crate::tensor::{Matrix, cross};
use serde::{Deserialize, Serialize};

/// Velocity [m/s] and then angular velocity [rad/s] of a rigid body; or impulses, or what an impulse does per unit.
pub type Six = [f64; 6];

/// Those of a vector at a point and of a turn: (v, r x v + w).
pub fn at(arm: [f64; 3], vector: [f64; 3]) -> Six {
    join(vector, cross(arm, vector))
}

/// The two parts in one.
pub fn join([a, b, c]: [f64; 3], [d, e, f]: [f64; 3]) -> Six {
    [a, b, c, d, e, f]
}

/// The two parts.
pub fn parts([a, b, c, d, e, f]: Six) -> [[f64; 3]; 2] {
    [[a, b, c], [d, e, f]]
}

pub fn dot(a: &Six, b: &Six) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// a += factor b
pub fn add(a: &mut Six, factor: f64, b: &Six) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += factor * b);
}

/// The least that is left of an entry of the diagonal.
const LIGHTEST: f64 = 4.0 * f64::EPSILON;

/// A symmetric positive definite matrix of six by six.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct SixMatrix([Six; 6]);

impl SixMatrix {
    /// Mass and tensor of inertia of a body.
    pub fn inertia(mass: f64, inertia: &Matrix<f64>) -> Self {
        let mut all = SixMatrix::default();
        for i in 0..3 {
            all.0[i][i] = mass;
            for j in 0..3 {
                all.0[3 + i][3 + j] = inertia.0[i][j];
            }
        }
        all
    }

    /// Adds factor g g^T.
    pub fn add(&mut self, factor: f64, g: &Six) {
        for (row, gi) in self.0.iter_mut().zip(g) {
            add(row, factor * gi, g);
        }
    }

    /// Adds another one.
    pub fn add_all(&mut self, other: &SixMatrix) {
        self.0.iter_mut().zip(&other.0).for_each(|(row, others)| add(row, 1.0, others));
    }

    pub fn times(&self, x: &Six) -> Six {
        std::array::from_fn(|i| dot(&self.0[i], x))
    }

    /// What of it counts: all of it, or what there is of it in the plane.
    pub fn part<const N: usize>(&self) -> [[f64; N]; N] {
        let number = |k: usize| if N == 3 { [0, 1, 5][k] } else { k };
        std::array::from_fn(|i| std::array::from_fn(|j| self.0[number(i)][number(j)]))
    }

    /// Its Cholesky factor L, with A = L L^T. What next to nothing follows is as light as round-off lets it be: a body of
    /// a millionth of a millionth of the mass at its nodes has none across what touches it.
    pub fn factor(&self) -> SixFactor {
        let mut lower = [[0.0; 6]; 6];
        for i in 0..6 {
            for j in 0..=i {
                let rest = self.0[i][j] - (0..j).map(|k| lower[i][k] * lower[j][k]).sum::<f64>();
                lower[i][j] = match i == j {
                    true => rest.max(LIGHTEST * self.0[i][i]).sqrt(),
                    false => rest / lower[j][j],
                };
            }
        }
        SixFactor(lower)
    }
}

/// The Cholesky factor of a matrix.
#[derive(Clone, Copy, Debug, Default)]
pub struct SixFactor([Six; 6]);

impl SixFactor {
    /// A^-1 b
    pub fn solve(&self, b: &Six) -> Six {
        let mut x = *b;
        for i in 0..6 {
            let known = (0..i).map(|k| self.0[i][k] * x[k]).sum::<f64>();
            x[i] = (x[i] - known) / self.0[i][i];
        }
        for i in (0..6).rev() {
            let known = (i + 1..6).map(|k| self.0[k][i] * x[k]).sum::<f64>();
            x[i] = (x[i] - known) / self.0[i][i];
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factor_solves() {
        let inertia = Matrix([[2.0, 0.3, 0.0], [0.3, 1.0, 0.1], [0.0, 0.1, 3.0]]);
        let mut matrix = SixMatrix::inertia(5.0, &inertia);
        matrix.add(7.0, &at([0.1, -0.4, 0.2], [0.6, 0.0, 0.8]));
        let wanted = [1.0, -2.0, 3.0, 0.5, 0.0, -1.5];
        let found = matrix.factor().solve(&matrix.times(&wanted));
        assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
    }
}
