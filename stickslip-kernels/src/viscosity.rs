//! Bulk viscosity of the particles.

use crate::tensor::{Number, Real};

/// Bulk viscosity: a pressure against compression, which spreads shocks over a few cells and takes the noise behind
/// them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BulkViscosity<T> {
    /// c_1 and c_2 [-].
    pub coefficients: [T; 2],
}

impl<T: Real> BulkViscosity<T> {
    /// With c_1 and c_2, if either is above zero.
    pub fn new(coefficients: [f64; 2]) -> Option<Self> {
        (coefficients != [0.0; 2]).then(|| BulkViscosity { coefficients: coefficients.map(T::of) })
    }

    /// Pressure over the density [J/kg]:
    ///
    /// ```text
    /// q / rho = h d (c_1 c + c_2 h d),   d = max(-tr L, 0)
    /// ```
    /// Landshoff (1955), LA-1930, for the first power of d; von Neumann and Richtmyer (1950), J. Appl. Phys. 21, for
    /// the second. `rate` is h tr L [m/s], `speed` the wave speed c [m/s].
    #[inline(always)]
    pub fn over_density<N: Number>([linear, quadratic]: [N; 2], rate: N, speed: N) -> N {
        let closing = (-rate).max(N::ZERO);
        closing * (linear * speed + quadratic * closing)
    }
}
