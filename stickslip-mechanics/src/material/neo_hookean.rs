//! Compressible neo-Hookean elasticity (Simo and Hughes 1998, section 9.2; the paper's law for spheres and planes).
//!
//! ```text
//! W     = K/2 ((J^2 - 1)/2 - ln J) + G/2 (J^(-2/3) tr(F F^T) - 3)
//! sigma = K/2 (J - 1/J) I + G J^(-5/3) dev(F F^T)
//! ```

use super::declaration::{BadConstants, Constant, Declared, Given};
use super::{History, Isotropic, Law, Motion, Response, elastic};
use crate::tensor::{Matrix, Number, Symmetric};
use serde::Serialize;

/// Compressible neo-Hookean elasticity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NeoHookean<T> {
    /// Moduli at small strain.
    #[serde(flatten)]
    pub elastic: Isotropic<T>,
}

impl Declared for NeoHookean<f64> {
    const SUMMARY: &'static str =
        "Compressible neo-Hookean elasticity for large strains (Simo and Hughes 1998).";
    const CONSTANTS: &'static [Constant] = &elastic::CONSTANTS;

    fn build(given: &Given) -> Result<Self, BadConstants> {
        Ok(NeoHookean { elastic: Isotropic::build(given)? })
    }

    fn given(&self) -> Given {
        self.elastic.given()
    }

    fn elastic(&self) -> Isotropic<f64> {
        self.elastic
    }
}

impl<T: Copy> NeoHookean<T> {
    /// The same constants in other numbers.
    #[inline(always)]
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> NeoHookean<U> {
        NeoHookean { elastic: self.elastic.map(f) }
    }
}

impl<T: Number> NeoHookean<T> {
    /// Cauchy stress at the end of the step [Pa].
    #[inline(always)]
    pub fn stress(&self, motion: &Motion<T>) -> Symmetric<T> {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic;
        let j = motion.jacobian;
        let b = motion.deformation.times_transpose();
        let root = j.cbrt();
        // J^(-2/3) = J^(1/3)/J
        let inverse = T::ONE / j;
        let pressure = T::HALF * k * (j - inverse);
        b.deviator() * (g * inverse * (root * inverse)) + Symmetric::isotropic(pressure)
    }
}

impl<T: Number> Law<T> for NeoHookean<T> {
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
    fn strain_energy(&self, deformation: &Matrix<T>, _stress: &Symmetric<T>, _history: &[T; 0]) -> T {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic;
        let j = deformation.det();
        let root = j.cbrt();
        let trace = deformation.times_transpose().trace();
        T::HALF * k * (T::HALF * (j * j - T::ONE) - j.ln())
            + T::HALF * g * (trace / (root * root) - T::of(3.0))
    }

    #[inline(always)]
    fn wave_modulus(&self, deformation: &Matrix<T>, jacobian: T, history: &[T; 0]) -> T {
        let k = self.elastic.bulk_modulus;
        let j = jacobian;
        T::HALF * k * (j * j + T::ONE) + T::of(4.0 / 3.0) * self.shear_modulus(deformation, jacobian, history)
    }

    #[inline(always)]
    fn shear_modulus(&self, deformation: &Matrix<T>, jacobian: T, _history: &[T; 0]) -> T {
        let root = jacobian.cbrt();
        let b = deformation.times_transpose();
        self.elastic.shear_modulus * (b.0[0].max(b.0[1]).max(b.0[2]) * (root * (T::ONE / jacobian)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::tests::{hooke, motion_of, sample_gradients};

    const LAW: NeoHookean<f64> = NeoHookean { elastic: Isotropic { bulk_modulus: 6.0, shear_modulus: 3.0 } };

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
    fn energy_is_the_work_of_the_stress() {
        for h in sample_gradients() {
            let (n, mut work) = (2000, 0.0);
            for i in 0..n {
                let f = Matrix::IDENTITY + h * ((i as f64 + 0.5) / n as f64);
                let l = h * (1.0 / n as f64) * f.inverse();
                work += f.det() * LAW.stress(&motion_of(f)).double_dot(&l.symmetric_part());
            }
            let energy = LAW.strain_energy(&(Matrix::IDENTITY + h), &Symmetric::ZERO, &[]);
            assert!((work - energy).abs() < 1e-6 * energy, "{work} {energy}");
        }
    }

    #[test]
    fn rotation_rotates_the_stress() {
        let q = crate::material::tests::rotation();
        for h in sample_gradients() {
            let f = Matrix::IDENTITY + h;
            let turned = LAW.stress(&motion_of(q * f));
            let expected = LAW.stress(&motion_of(f)).rotated(&q);
            for (s, e) in turned.0.iter().zip(expected.0) {
                assert!((s - e).abs() < 1e-13 * 10.0, "{s} {e}");
            }
        }
    }
}
