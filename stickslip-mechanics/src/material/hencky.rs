//! Hencky's elasticity: Hooke's law between the logarithmic strain and the Kirchhoff stress (Hencky 1928; Anand 1979).
//!
//! ```text
//! W       = K/2 (tr e)^2 + G dev(e) : dev(e),   e = 1/2 ln(F F^T)
//! J sigma = K tr(e) I + 2 G dev(e)
//! ```
//!
//! A bar with free sides has J sigma = E ln(l). Anand found metals and rubber to follow it up to strains of 0.3; far
//! beyond, at a stretch of e^(4/3) in tension, waves have no real speed and the material is not stable.

use super::declaration::{BadConstants, Constant, Declared, Given};
use super::principal::{Derivatives, Stretches};
use super::{History, Isotropic, Law, Motion, Response, elastic};
use crate::tensor::{Matrix, Number, Symmetric};
use serde::Serialize;

/// Hencky's elasticity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Hencky<T> {
    /// Moduli.
    #[serde(flatten)]
    pub elastic: Isotropic<T>,
}

impl Declared for Hencky<f64> {
    const SUMMARY: &'static str =
        "Hooke's law in logarithmic strain (Hencky 1928), for moderate strains and large rotations.";
    const CONSTANTS: &'static [Constant] = &elastic::CONSTANTS;

    fn build(given: &Given) -> Result<Self, BadConstants> {
        let elastic = Isotropic::build(given)?;
        if elastic.shear_modulus == 0.0 {
            return Err(BadConstants::together("G = 0", "G above 0; `fluid` is a law for what has none"));
        }
        Ok(Hencky { elastic })
    }

    fn given(&self) -> Given {
        self.elastic.given()
    }

    fn elastic(&self) -> Isotropic<f64> {
        self.elastic
    }
}

impl<T: Copy> Hencky<T> {
    /// The same constants in other numbers.
    #[inline(always)]
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> Hencky<U> {
        Hencky { elastic: self.elastic.map(f) }
    }
}

impl<T: Number> Hencky<T> {
    /// Cauchy stress at the end of the step [Pa].
    #[inline(always)]
    pub fn stress(&self, motion: &Motion<T>) -> Symmetric<T> {
        let stretches = Stretches::of(&motion.deformation);
        stretches.cauchy(self.derivatives(&stretches).stress, motion.jacobian)
    }

    #[inline(always)]
    fn derivatives(&self, stretches: &Stretches<T>) -> Derivatives<T> {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic;
        let e = stretches.strains;
        let two_g = g + g;
        let lame = k - two_g * T::of(1.0 / 3.0);
        let pressure = lame * (e[0] + e[1] + e[2]);
        let mut stiffness = [[lame; 3]; 3];
        for (i, row) in stiffness.iter_mut().enumerate() {
            row[i] += two_g;
        }
        Derivatives { stress: e.map(|e| pressure + two_g * e), stiffness }
    }

    #[inline(always)]
    fn moduli(&self, deformation: &Matrix<T>) -> [T; 2] {
        let stretches = Stretches::of(deformation);
        // Of what is no longer stable, a part of what it was at rest.
        let least = T::of(LEAST_LEFT) * self.elastic.shear_modulus;
        stretches.moduli(&self.derivatives(&stretches)).map(|modulus| modulus.max(least))
    }
}

/// What moduli are at least, over G.
const LEAST_LEFT: f64 = 1e-3;

impl<T: Number> Law<T> for Hencky<T> {
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
        let stretches = Stretches::of(deformation);
        let (e, t) = (stretches.strains, self.derivatives(&stretches).stress);
        T::HALF * (e[0] * t[0] + e[1] * t[1] + e[2] * t[2])
    }

    #[inline(always)]
    fn wave_modulus(&self, deformation: &Matrix<T>, _jacobian: T, _history: &[T; 0]) -> T {
        self.moduli(deformation)[0]
    }

    #[inline(always)]
    fn shear_modulus(&self, deformation: &Matrix<T>, _jacobian: T, _history: &[T; 0]) -> T {
        self.moduli(deformation)[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::LAWS;
    use crate::material::tests::{follow, hooke, motion_of, rotation, sample_gradients};
    use crate::material::trials::{
        answers_are_numbers, lanes_know_nothing_of_each_other, plates_have_a_thickness, stiffness_over_moduli,
    };

    const LAW: Hencky<f64> = Hencky { elastic: Isotropic { bulk_modulus: 6.0, shear_modulus: 3.0 } };

    #[test]
    fn small_strain_gives_hooke() {
        for h in sample_gradients() {
            let stress = LAW.stress(&motion_of(Matrix::IDENTITY + h * 1e-6));
            let exact = hooke(&LAW.elastic, &(h * 1e-6).symmetric_part());
            assert!(stress.0.iter().zip(exact.0).all(|(s, e)| (s - e).abs() < 1e-10), "{stress:?} {exact:?}");
        }
    }

    /// J sigma = E ln(l) of a bar whose sides are free, and turned with it.
    #[test]
    fn a_bar_bears_youngs_modulus_times_its_logarithmic_strain() {
        let (e, nu) = (LAW.elastic.young_modulus(), LAW.elastic.poisson_ratio());
        for strain in [-0.5f64, -0.01, 0.2, 1.0] {
            let stretch = |i: usize| (if i == 0 { strain } else { -nu * strain }).exp();
            let f = Matrix::from_fn(|i, j| if i == j { stretch(i) } else { 0.0 });
            let stress = LAW.stress(&motion_of(rotation() * f));
            let exact = Symmetric([e * strain / f.det(), 0.0, 0.0, 0.0, 0.0, 0.0]).rotated(&rotation());
            assert!(stress.0.iter().zip(exact.0).all(|(s, e)| (s - e).abs() < 1e-13), "{stress:?} {exact:?}");
        }
    }

    /// Simple shear: equal and opposite logarithmic stretches asinh(gamma/2), half a turn of the spin ahead (Anand).
    #[test]
    fn simple_shear_has_the_stress_of_the_textbook() {
        for gamma in [1e-3f64, 0.3, 1.0, 4.0] {
            let f = Matrix([[1.0, gamma, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
            let stress = LAW.stress(&motion_of(f)).0;
            let strain = (0.5 * gamma).asinh();
            let root = (1.0 + 0.25 * gamma * gamma).sqrt();
            let exact = [2.0 * 3.0 * strain * 0.5 * gamma / root, 2.0 * 3.0 * strain / root];
            assert!(
                (stress[0] - exact[0]).abs() < 1e-13 && (stress[3] - exact[1]).abs() < 1e-13,
                "{stress:?}"
            );
        }
    }

    #[test]
    fn energy_is_the_work_of_the_stress() {
        for h in sample_gradients() {
            let (end, _, work) = follow(&LAW, (2000, 1.0), |t| Matrix::IDENTITY + h * (3.0 * t));
            let energy = LAW.strain_energy(&end.deformation, &end.stress, &[]);
            assert!((work / energy - 1.0).abs() < 1e-5, "{work} {energy}");
        }
    }

    #[test]
    fn rotation_rotates_the_stress() {
        let q = rotation();
        for h in sample_gradients() {
            let f = Matrix::IDENTITY + h;
            let (turned, expected) = (LAW.stress(&motion_of(q * f)), LAW.stress(&motion_of(f)).rotated(&q));
            assert!(turned.0.iter().zip(expected.0).all(|(s, e)| (s - e).abs() < 1e-13));
        }
    }

    /// No wave is faster than the law says, in 1000 states of stretches up to e; at rest the moduli are Hooke's.
    #[test]
    fn moduli_are_those_of_the_fastest_waves_or_above() {
        for bulk_modulus in [6.0, 0.1] {
            let law = Hencky { elastic: Isotropic { bulk_modulus, ..LAW.elastic } };
            let [waves, shear] = stiffness_over_moduli(&law, (1000, 1.0));
            assert!((0.6..1.0 + 1e-6).contains(&waves), "{waves}");
            assert!((0.5..1.0 + 1e-6).contains(&shear), "{shear}");
        }
        let [waves, shear] = LAW.moduli(&Matrix::IDENTITY);
        assert!((waves / 10.0 - 1.0).abs() < 1e-12 && (shear / 3.0 - 1.0).abs() < 1e-12, "{waves} {shear}");
    }

    #[test]
    fn particles_side_by_side_know_nothing_of_each_other() {
        lanes_know_nothing_of_each_other(&LAW, &LAW.map(Number::of), 2000);
    }

    #[test]
    fn plates_have_a_thickness_without_stress() {
        plates_have_a_thickness(&LAW, 400);
    }

    #[test]
    fn whatever_the_motion_the_answers_are_numbers() {
        answers_are_numbers(&LAW, 20_000);
        answers_are_numbers(&LAW.map(|x| x as f32), 20_000);
    }

    #[test]
    fn constants_that_make_no_material_are_refused() {
        let law = LAWS.iter().find(|law| law.name == "hencky").expect("a law of the list");
        let with = |k, g| law.build(&[("bulk_modulus", k), ("shear_modulus", g)].into());
        assert!(with(1.0, 1.0).is_ok());
        assert_eq!(with(-1.0, 1.0).unwrap_err().key.as_deref(), Some("bulk_modulus"));
        assert_eq!(with(1.0, 0.0).unwrap_err().found, "G = 0");
    }
}
