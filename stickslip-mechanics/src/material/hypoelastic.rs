//! Linear elasticity in rate form (the paper's law for disks), integrated objectively after Hughes and Winget (1980).
//!
//! ```text
//! sigma rate = (K - 2G/3) tr(D) I + 2 G D          (rate seen by an observer turning with the material)
//! H = 2 (dF - I)(dF + I)^-1,  D dt = (H + H^T)/2,  W dt = (H - H^T)/2
//! Q = (I - W dt/2)^-1 (I + W dt/2),  sigma' = Q sigma Q^T + (K - 2G/3) tr(D dt) I + 2 G D dt
//! ```
//!
//! A step that is a pure rotation gives D = 0 exactly, and Q is that rotation.

use super::declaration::{BadConstants, Constant, Declared, Given};
use super::{History, Isotropic, Law, Motion, Response, elastic};
use crate::tensor::{Matrix, Number, Symmetric};
use serde::Serialize;

/// Linear elasticity in rate form.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Hypoelastic<T> {
    /// Moduli.
    #[serde(flatten)]
    pub elastic: Isotropic<T>,
}

impl Declared for Hypoelastic<f64> {
    const SUMMARY: &'static str = "Linear elasticity in rate form with an objective stress rate, for small strains and large rotations.";
    const CONSTANTS: &'static [Constant] = &elastic::CONSTANTS;

    fn build(given: &Given) -> Result<Self, BadConstants> {
        Ok(Hypoelastic { elastic: Isotropic::build(given)? })
    }

    fn given(&self) -> Given {
        self.elastic.given()
    }

    fn elastic(&self) -> Isotropic<f64> {
        self.elastic
    }
}

impl<T: Copy> Hypoelastic<T> {
    /// The same constants in other numbers.
    #[inline(always)]
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> Hypoelastic<U> {
        Hypoelastic { elastic: self.elastic.map(f) }
    }
}

impl<T: Number> Hypoelastic<T> {
    /// Cauchy stress at the end of the step [Pa].
    #[inline(always)]
    pub fn stress(&self, motion: &Motion<T>) -> Symmetric<T> {
        let (turned, strain) = turned_and_strained(motion);
        self.strained(&turned, &strain)
    }

    /// Stress that a strain adds to another [Pa].
    #[inline(always)]
    pub(super) fn strained(&self, stress: &Symmetric<T>, strain: &Symmetric<T>) -> Symmetric<T> {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic;
        let lame = k - T::of(2.0 / 3.0) * g;
        *stress + Symmetric::isotropic(lame * strain.trace()) + *strain * (T::of(2.0) * g)
    }
}

/// Q sigma Q^T [Pa] and D dt [-] of a step.
#[inline(always)]
pub(super) fn turned_and_strained<T: Number>(motion: &Motion<T>) -> (Symmetric<T>, Symmetric<T>) {
    let identity = Matrix::IDENTITY;
    let h = (motion.increment - identity) * (motion.increment + identity).inverse() * T::of(2.0);
    let half_spin = (h - h.transpose()) * T::of(0.25);
    let rotation = (identity - half_spin).inverse() * (identity + half_spin);
    (motion.stress.rotated(&rotation), h.symmetric_part())
}

impl<T: Number> Law<T> for Hypoelastic<T> {
    type History = [T; 0];

    #[inline(always)]
    fn history(&self) -> &'static [History] {
        &[]
    }

    #[inline(always)]
    fn respond(&self, motion: &Motion<T>, _history: &[T; 0]) -> Response<T, [T; 0]> {
        Response { stress: self.stress(motion), history: [] }
    }

    #[inline(always)]
    fn strain_energy(&self, deformation: &Matrix<T>, stress: &Symmetric<T>, _history: &[T; 0]) -> T {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic;
        let mean = stress.trace() / T::of(3.0);
        let deviator = stress.deviator();
        // A fluid has no deviator, whatever it is divided by.
        let shear = deviator.double_dot(&deviator) / (T::of(4.0) * g.max(T::EPSILON * k));
        deformation.det() * (T::HALF * mean * mean / k + shear)
    }

    #[inline(always)]
    fn wave_modulus(&self, _deformation: &Matrix<T>, jacobian: T, _history: &[T; 0]) -> T {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic;
        (k + T::of(4.0 / 3.0) * g) * jacobian
    }

    #[inline(always)]
    fn shear_modulus(&self, _deformation: &Matrix<T>, jacobian: T, _history: &[T; 0]) -> T {
        self.elastic.shear_modulus * jacobian
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::tests::{hooke, motion_of, rotation, sample_gradients};

    const LAW: Hypoelastic<f64> =
        Hypoelastic { elastic: Isotropic { bulk_modulus: 6.0, shear_modulus: 3.0 } };

    #[test]
    fn small_strain_gives_hooke() {
        for h in sample_gradients() {
            let f = Matrix::IDENTITY + h * 1e-6;
            let stress = LAW.stress(&motion_of(f));
            let exact = hooke(&LAW.elastic, &(h * 1e-6).symmetric_part());
            for (s, e) in stress.0.iter().zip(exact.0) {
                assert!((s - e).abs() < 1e-10, "{s} {e}");
            }
        }
    }

    #[test]
    fn a_step_of_rotation_only_rotates_the_stress() {
        let q = rotation();
        let before = Symmetric([1.0, -2.0, 0.5, 0.3, -0.7, 0.2]);
        let motion = Motion { stress: before, ..motion_of(q) };
        let after = LAW.stress(&motion);
        for (s, e) in after.0.iter().zip(before.rotated(&q).0) {
            assert!((s - e).abs() < 1e-13, "{s} {e}");
        }
    }

    #[test]
    fn energy_is_the_work_of_the_stress_at_small_strain() {
        for h in sample_gradients() {
            let h = h * 1e-4;
            let n = 400;
            let (mut work, mut stress, mut f) = (0.0, Symmetric::ZERO, Matrix::IDENTITY);
            for i in 0..n {
                let next = Matrix::IDENTITY + h * ((i + 1) as f64 / n as f64);
                let increment = next * f.inverse();
                let motion = Motion { increment, stress, ..motion_of(next) };
                let after = LAW.stress(&motion);
                let strain = (increment - Matrix::IDENTITY).symmetric_part();
                work += next.det() * ((stress + after) * 0.5).double_dot(&strain);
                (stress, f) = (after, next);
            }
            let energy = LAW.strain_energy(&f, &stress, &[]);
            assert!((work / energy - 1.0).abs() < 1e-3, "{work} {energy}");
        }
    }
}
