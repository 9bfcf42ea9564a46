//! Particles that turn: their velocities around them, and what they weigh against turning.

use crate::matter::Gyration;
use crate::tensor::{Matrix, Number, Real, Vector};

/// Gradient of the velocities around a particle that turns, (c) of [`super::Rflip`], embedded in space [1/s].
/// `half_step` is dt/2 in the middle of a step, else 0 [s].
#[inline(always)]
pub fn gradient<N: Number, const D: usize>(spin: &Vector<N, 3>, half_step: N) -> Matrix<N> {
    let [x, y, z] = spin.0;
    let mut gradient = Matrix::ZERO;
    if const { D == 2 } {
        let inward = -(half_step * z * z);
        gradient.0[0] = [inward, -z, N::ZERO];
        gradient.0[1] = [z, inward, N::ZERO];
        return gradient;
    }
    let square = spin.dot(*spin);
    let skew = [[N::ZERO, -z, y], [z, N::ZERO, -x], [-y, x, N::ZERO]];
    for i in 0..3 {
        for j in 0..3 {
            let product = spin[i] * spin[j];
            let twice = if i == j { product - square } else { product };
            gradient.0[i][j] = half_step.times_plus(twice, skew[i][j]);
        }
    }
    gradient
}

/// The angular velocity with a share of that of the material around the particle: half of the curl of its velocity.
#[inline(always)]
pub fn toward<N: Number>(spin: Vector<N, 3>, gradient: &Matrix<N>, share: N) -> Vector<N, 3> {
    let l = &gradient.0;
    let mut new = spin;
    for i in 0..3 {
        let [j, k] = [(i + 1) % 3, (i + 2) % 3];
        let around = N::HALF * (l[k][j] - l[j][k]);
        new[i] = share.times_plus(around - spin[i], spin[i]);
    }
    new
}

/// Sum of S (x_i - x_p) x u_i from the sums `moments[c][a]` of S (x_i - x_p)_a u_c; in the plane about the third axis.
#[inline(always)]
pub fn moment<N: Number, const D: usize>(moments: &Matrix<N>) -> Vector<N, 3> {
    let m = &moments.0;
    let z = m[1][0] - m[0][1];
    if D == 2 { Vector([N::ZERO, N::ZERO, z]) } else { Vector([m[2][1] - m[1][2], m[0][2] - m[2][0], z]) }
}

/// What particles weigh against turning, by a basis with this [`Basis::BOX_SPREAD`](crate::basis::Basis::BOX_SPREAD) on
/// cells of a size; `half_side` as in [`crate::grid::Lattice`].
pub fn gyration<T: Real>(box_spread: f64, cell: f64, half_side: Option<f64>) -> Gyration<T> {
    if let Some(half) = half_side {
        let square = cell * cell / 3.0 + 2.0 * half * half * box_spread * cell * cell;
        return Gyration { cell: T::of(square), share: T::ZERO };
    }
    Gyration { cell: T::of(cell * cell / 3.0), share: T::of(2.0 * box_spread) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Velocities around a particle that turns by W dt/2: W (1 + W dt/2), against the cross products.
    #[test]
    fn the_gradient_is_that_of_a_turning_body() {
        let (spin, arm) = (Vector([0.3, -0.7, 0.5]), [0.2, 0.4, -0.9]);
        let once = crate::tensor::cross(spin.0, arm);
        let twice = crate::tensor::cross(spin.0, once);
        let found = gradient::<f64, 3>(&spin, 0.01);
        for i in 0..3 {
            let product: f64 = (0..3).map(|j| found.0[i][j] * arm[j]).sum();
            assert!((product - (once[i] + 0.01 * twice[i])).abs() < 1e-15);
        }
        let flat = Vector([0.0, 0.0, 0.5]);
        let (plane, space) = (gradient::<f64, 2>(&flat, 0.01), gradient::<f64, 3>(&flat, 0.01));
        for i in 0..2 {
            for j in 0..2 {
                assert_eq!(plane.0[i][j], space.0[i][j]);
            }
        }
    }
}
