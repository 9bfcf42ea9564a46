//! What laws in principal stretches share: their strains, their stress, and a bound of the stiffness against waves.
//!
//! ```text
//! e_i = ln(l_i),   l_i^2 principal values of F F^T,   t_i = dW/de_i,   J sigma = sum t_i n_i n_i^T
//! ```
//! A wave along n in which matter moves along m, both unit vectors, has the stiffness (Ogden 1997, section 6.3), with
//! x_i = n_i m_i and W_ij = d^2 W/(de_i de_j),
//!
//! ```text
//! Q = sum_i D_i x_i^2 + sum_i!=j (A_ij n_i^2 m_j^2 + C_ij x_i x_j)
//! D_i = W_ii - t_i,   A_ij = (t_i - t_j) l_i^2/(l_i^2 - l_j^2),   C_ij = W_ij + A_ij - t_i
//! ```
//! With any c >= 0, since sum n_i^2 m_j^2 = 1 and |sum x_i| <= sum |x_i| <= 1,
//!
//! ```text
//! Q <= c + max(D_i - c, A_ij) + 2/3 max |C_ij - c|
//! ```
//! The mean of C_ij for c makes this K + 4G/3 at rest. Of shear waves sum x_i = 0, and the first c falls away.

use crate::eigen::Principal;
use crate::tensor::{Matrix, Number, Symmetric};

/// Principal stretches of a deformation.
#[derive(Clone, Copy)]
pub struct Stretches<T> {
    principal: Principal<T>,
    /// e_i [-]
    pub strains: [T; 3],
}

/// t_i and W_ij of a state [Pa].
#[derive(Clone, Copy)]
pub struct Derivatives<T> {
    /// t_i
    pub stress: [T; 3],
    /// W_ij
    pub stiffness: [[T; 3]; 3],
}

/// Strains nearer than this are one.
const NEAR: f64 = 1e-3;
/// The other two axes beside each.
const PAIRS: [[usize; 2]; 3] = [[0, 1], [1, 2], [0, 2]];

impl<T: Number> Stretches<T> {
    /// Of a deformation.
    #[inline(always)]
    pub fn of(deformation: &Matrix<T>) -> Self {
        let principal = Principal::of(&deformation.times_transpose());
        Stretches { principal, strains: principal.values.map(|square| T::HALF * square.ln()) }
    }

    /// The Cauchy stress of these t_i [Pa].
    #[inline(always)]
    pub fn cauchy(&self, stress: [T; 3], jacobian: T) -> Symmetric<T> {
        self.principal.with(stress) * (T::ONE / jacobian)
    }

    /// Stiffness times J against no wave is above the first, and against no shear wave above the second [Pa].
    #[inline(always)]
    pub fn moduli(&self, of: &Derivatives<T>) -> [T; 2] {
        let (t, w) = (of.stress, of.stiffness);
        let (mut across, mut cross) = (T::ZERO, [T::ZERO; 3]);
        for (pair, [i, j]) in cross.iter_mut().zip(PAIRS) {
            let twice = T::of(2.0) * (self.strains[i] - self.strains[j]);
            let near = T::of(NEAR).at_least(twice.abs());
            // (t_i - t_j) l_i^2/(l_i^2 - l_j^2) = (t_i - t_j)/(1 - exp(-2 (e_i - e_j)))
            let square = self.principal.values;
            let apart = T::select(near, T::ONE, square[i] - square[j]);
            let slope = T::HALF * (T::HALF * (w[i][i] + w[j][j]) - w[i][j]);
            let one =
                T::select(near, slope * (T::ONE + T::HALF * twice), (t[i] - t[j]) * (square[i] / apart));
            let other = one - (t[i] - t[j]);
            across = across.max(one).max(other);
            *pair = w[i][j] + one - t[i];
        }
        let mean = (cross[0] + cross[1] + cross[2]) * T::of(1.0 / 3.0);
        let bound = |c: T| {
            let mut largest = across;
            let mut spread = T::ZERO;
            for i in 0..3 {
                largest = largest.max(w[i][i] - t[i] - c);
                spread = spread.max((cross[i] - c).abs());
            }
            largest + T::of(2.0 / 3.0) * spread
        };
        let positive = mean.max(T::ZERO);
        let shear = bound(mean);
        [(positive + bound(positive)).max(shear), shear]
    }
}
