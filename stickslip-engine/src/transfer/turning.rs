//! Particles that carry the rotation of the material around them (`transfer = "rflip"`).
//!
//! FLIP gives a node the velocity of its particles' centre of mass. At a rim that is not the velocity at the node:
//! rigid rotation strains the rim, and forces there act with too short an arm, so bodies lose their spin. Here a
//! particle has an angular velocity w_p of its own beside v_p, as in the rigid particle-in-cell method (RPIC: Jiang,
//! Schroeder, Selle, Teran and Stomakhin 2015, ACM Trans. Graph. 34, section 5.3), and takes changes of both,
//! as FLIP does:
//!
//! ```text
//! m_i v_i = sum_p m_p S_ip (v_p + w_p x (x_i - x_p))                                                            (a)
//! v_p += sum_i S_ip dv_i,    k_p^2 w_p += sum_i S_ip (x_i - x_p) x dv_i                                         (b)
//! ```
//! (b) is the transpose of (a) for masses m_p and moments of inertia m_p k_p^2. So forces at the nodes do the same work
//! on the particles' kinetic energy, sum m_p (v_p^2 + k_p^2 w_p^2)/2, as on the nodes' velocities,
//! and give them all of their torque:
//!
//! ```text
//! sum_p m_p (x_p x dv_p + k_p^2 dw_p) = sum_i x_i x m_i dv_i
//! ```
//! k_p must not change while a particle moves, or energy is made; it is that for which the nodes' moment of inertia and
//! the particles' are the same in the mean over places, k^2 = 2 (h^2/6 + b l^2) with b = [`Basis::BOX_SPREAD`]. Rigid
//! rotation is a state of (a) and (b): nothing is strained.
//!
//! Within a step particles turn. Velocities that are scattered in its middle, at places of its start,
//! so have the gradient
//!
//! ```text
//! W + (dt/2) W^2,    W = w x                                                                                    (c)
//! ```
//! without which a body spins up by 1e-4 of its angular momentum in a turn at five cells a radius.
//!
//! Changes alone let the noise of angular velocities grow from turn to turn, for a particle's own moment of inertia
//! among the nodes changes with its place while k does not. So with each radian that it turns,
//! a particle takes a part of the rotation around it:
//!
//! ```text
//! w_p += NOISE |w_p| dt (curl v / 2 - w_p)                                                                      (d)
//! ```
//! which takes next to nothing from a body that only vibrates. The ledger's damping counts what it takes.

use crate::basis::Basis;
use crate::body::Gyration;
use crate::tensor::{Matrix, Number, Real, Vector};

/// Gradient of the velocities around a particle that turns, (c), embedded in space [1/s].
/// `half_step` is dt/2 in the middle of a step, else 0 [s].
#[inline(always)]
pub fn gradient<N: Number, const D: usize>(spin: &Vector<N, 3>, half_step: N) -> Matrix<N> {
    let [x, y, z] = spin.0;
    let mut gradient = Matrix::ZERO;
    if D == 2 {
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

/// What a particle takes of the rotation around it with each radian that it turns (d): without it the strain energy of
/// a disk of eight cells a radius, whose rim moves at a tenth of the wave speed, doubles in ten turns;
/// three times as much takes no more noise [-].
const NOISE: f64 = 0.3;

/// The angular velocity after a step, (d). `gradient`: L, embedded in space [1/s].
#[inline(always)]
pub fn settled<N: Number, const D: usize>(spin: Vector<N, 3>, gradient: &Matrix<N>, dt: N) -> Vector<N, 3> {
    let speed = if D == 2 { spin[2].abs() } else { spin.norm() };
    toward(spin, gradient, (N::of(NOISE) * speed * dt).min(N::ONE))
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

/// What particles of a basis on cells of a size weigh against turning.
pub fn gyration<T: Real, B: Basis<T>>(cell: f64) -> Gyration<T> {
    Gyration { cell: T::of(cell * cell / 3.0), share: T::of(2.0 * B::BOX_SPREAD) }
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
