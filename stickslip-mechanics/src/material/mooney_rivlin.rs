//! Compressible Mooney-Rivlin elasticity (Mooney 1940; Rivlin 1948), with the part that keeps the volume split off
//! (Flory 1961) and the energy of volume of the neo-Hookean law here.
//!
//! ```text
//! W     = K/2 ((J^2 - 1)/2 - ln J) + C10 (I_1 - 3) + C01 (I_2 - 3)       b_ = J^(-2/3) F F^T,  c_ = b_^-1
//! I_1   = tr b_,   I_2 = (I_1^2 - b_ : b_)/2 = tr c_
//! sigma = K/2 (J - 1/J) I + 2/J (C10 dev(b_) - C01 dev(c_))
//! G     = 2 (C10 + C01)                                                  shear modulus at small strain
//! ```
//!
//! Waves: along a unit vector n, in which matter moves along m, C10 resists by no more than 8/3 C10 b_1 and C01 by no
//! more than C01 (10/3 c_1 - 2/9 I_2), with the largest eigenvalues b_1 and c_1. Both bounds hold for any state, n and
//! m, and are exact at rest; the tests look for a wave that is faster.

use super::declaration::{BadConstants, Constant, Declared, Given, NOT_NEGATIVE, POSITIVE, PRESSURE};
use super::{History, Isotropic, Law, Motion, Response};
use crate::tensor::{Matrix, Number, Symmetric};
use serde::Serialize;

/// Compressible Mooney-Rivlin elasticity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MooneyRivlin<T> {
    /// C10, what resists I_1 [Pa].
    pub c10: T,
    /// C01, what resists I_2 [Pa].
    pub c01: T,
    /// K, bulk modulus at small strain [Pa].
    pub bulk_modulus: T,
}

/// Names of the constants in scene files.
const C10: &str = "c10";
const C01: &str = "c01";
const BULK_MODULUS: &str = "bulk_modulus";

impl Declared for MooneyRivlin<f64> {
    const SUMMARY: &'static str = "Mooney-Rivlin elasticity for rubber at large strains; its shear modulus at small ones is 2 (c10 + c01).";
    const CONSTANTS: &'static [Constant] = &[
        Constant::required(
            C10,
            "C10, half of the shear modulus of the first invariant.",
            (PRESSURE, NOT_NEGATIVE.because(", else the material is not stable at every stretch")),
            "\"0.3 MPa\"",
        ),
        Constant::optional(
            C01,
            "C01, half of the shear modulus of the second invariant; none without it.",
            (PRESSURE, NOT_NEGATIVE.because(", else the material is not stable at every stretch")),
            0.0,
        ),
        Constant::required(
            BULK_MODULUS,
            "Bulk modulus K at small strain.",
            (PRESSURE, POSITIVE),
            "\"20 MPa\"",
        ),
    ];

    fn build(given: &Given) -> Result<Self, BadConstants> {
        let (c10, c01) = (given.number(C10), given.number(C01));
        if c10 + c01 <= 0.0 {
            return Err(BadConstants::together(
                "c10 + c01 = 0",
                "a sum above 0: nothing else keeps the shape",
            ));
        }
        Ok(MooneyRivlin { c10, c01, bulk_modulus: given.number(BULK_MODULUS) })
    }

    fn given(&self) -> Given {
        [(C10, self.c10), (C01, self.c01), (BULK_MODULUS, self.bulk_modulus)].into()
    }

    fn elastic(&self) -> Isotropic<f64> {
        Isotropic { bulk_modulus: self.bulk_modulus, shear_modulus: 2.0 * (self.c10 + self.c01) }
    }
}

impl<T: Copy> MooneyRivlin<T> {
    /// The same constants in other numbers.
    #[inline(always)]
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> MooneyRivlin<U> {
        MooneyRivlin { c10: f(self.c10), c01: f(self.c01), bulk_modulus: f(self.bulk_modulus) }
    }
}

/// b_ and its inverse c_ of a deformation and its determinant.
#[inline(always)]
fn stretches<T: Number>(deformation: &Matrix<T>, jacobian: T) -> [Symmetric<T>; 2] {
    let root = jacobian.cbrt();
    let square = root * root;
    let b = deformation.times_transpose() * (T::ONE / square);
    [b, deformation.inverse().transpose().times_transpose() * square]
}

/// The largest eigenvalue.
#[inline(always)]
fn largest<T: Number>(tensor: &Symmetric<T>) -> T {
    tensor.trace() * T::of(1.0 / 3.0) + tensor.deviator().largest_of_deviator()
}

impl<T: Number> MooneyRivlin<T> {
    /// Cauchy stress at the end of the step [Pa].
    #[inline(always)]
    pub fn stress(&self, motion: &Motion<T>) -> Symmetric<T> {
        let j = motion.jacobian;
        let inverse = T::ONE / j;
        let [b, c] = stretches(&motion.deformation, j);
        let shape = b.deviator() * (self.c10 + self.c10) - c.deviator() * (self.c01 + self.c01);
        shape * inverse + Symmetric::isotropic(T::HALF * self.bulk_modulus * (j - inverse))
    }
}

impl<T: Number> Law<T> for MooneyRivlin<T> {
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
        let j = deformation.det();
        let [b, c] = stretches(deformation, j).map(|tensor| tensor.trace() - T::of(3.0));
        T::HALF * self.bulk_modulus * (T::HALF * (j * j - T::ONE) - j.ln()) + self.c10 * b + self.c01 * c
    }

    #[inline(always)]
    fn wave_modulus(&self, deformation: &Matrix<T>, jacobian: T, _history: &[T; 0]) -> T {
        let j = jacobian;
        let [b, c] = stretches(deformation, j);
        let second = T::of(10.0 / 3.0) * largest(&c) - T::of(2.0 / 9.0) * c.trace();
        T::HALF * self.bulk_modulus * (j * j + T::ONE)
            + T::of(8.0 / 3.0) * self.c10 * largest(&b)
            + self.c01 * second
    }

    #[inline(always)]
    fn shear_modulus(&self, deformation: &Matrix<T>, jacobian: T, _history: &[T; 0]) -> T {
        let [b, c] = stretches(deformation, jacobian);
        T::of(2.0) * (self.c10 * largest(&b) + self.c01 * largest(&c))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::tests::{follow, hooke, motion_of, rotation, sample_gradients};
    use crate::material::trials::{
        answers_are_numbers, lanes_know_nothing_of_each_other, plates_have_a_thickness, stiffness_over_moduli,
    };
    use crate::material::{LAWS, NeoHookean};

    const LAW: MooneyRivlin<f64> = MooneyRivlin { c10: 1.1, c01: 0.4, bulk_modulus: 6.0 };

    fn diagonal(stretches: [f64; 3]) -> Matrix<f64> {
        Matrix::from_fn(|i, j| if i == j { stretches[i] } else { 0.0 })
    }

    #[test]
    fn small_strain_gives_hooke() {
        for h in sample_gradients() {
            let stress = LAW.stress(&motion_of(Matrix::IDENTITY + h * 1e-6));
            let exact = hooke(&LAW.elastic(), &(h * 1e-6).symmetric_part());
            assert!(stress.0.iter().zip(exact.0).all(|(s, e)| (s - e).abs() < 1e-10), "{stress:?} {exact:?}");
        }
    }

    #[test]
    fn without_c01_it_is_neo_hookean() {
        let law = MooneyRivlin { c01: 0.0, ..LAW };
        for h in sample_gradients() {
            let motion = motion_of(Matrix::IDENTITY + h);
            let exact = NeoHookean { elastic: law.elastic() }.stress(&motion);
            assert!(law.stress(&motion).0.iter().zip(exact.0).all(|(s, e)| (s - e).abs() < 1e-13));
        }
    }

    /// Of a material that keeps its volume, under a stress along one axis or two (Treloar 1975):
    /// 2 (l^2 - 1/l) (C10 + C01/l) and 2 (l^2 - 1/l^4) (C10 + C01 l^2). What is left is pressure alone.
    #[test]
    fn bars_and_balloons_bear_the_stress_of_the_textbook() {
        for stretch in [0.4f64, 0.8, 1.5, 3.0, 6.0] {
            let across = stretch.powf(-0.5);
            let one = LAW.stress(&motion_of(diagonal([stretch, across, across])));
            let exact = 2.0 * (stretch.powi(2) - 1.0 / stretch) * (LAW.c10 + LAW.c01 / stretch);
            assert!(((one.0[0] - one.0[1]) / exact - 1.0).abs() < 1e-12, "{stretch}: {one:?} {exact}");
            let two = LAW.stress(&motion_of(diagonal([stretch, stretch, stretch.powi(-2)])));
            let exact = 2.0 * (stretch.powi(2) - stretch.powi(-4)) * (LAW.c10 + LAW.c01 * stretch.powi(2));
            assert!(((two.0[0] - two.0[2]) / exact - 1.0).abs() < 1e-12, "{stretch}: {two:?} {exact}");
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
            assert!(turned.0.iter().zip(expected.0).all(|(s, e)| (s - e).abs() < 1e-12));
        }
    }

    /// No wave is faster than the law says, in 1000 states of stretches up to e, whatever resists;
    /// the fastest found come near, and at rest the moduli are Hooke's.
    #[test]
    fn moduli_are_those_of_the_fastest_waves_or_above() {
        for (c10, c01) in [(1.1, 0.4), (1.5, 0.0), (0.0, 1.5)] {
            let law = MooneyRivlin { c10, c01, bulk_modulus: 0.1 };
            let [waves, shear] = stiffness_over_moduli(&law, (1000, 1.0));
            assert!((0.8..1.0 + 1e-6).contains(&waves), "{law:?} {waves}");
            assert!((0.9..1.0 + 1e-6).contains(&shear), "{law:?} {shear}");
        }
        let rest = LAW.wave_modulus(&Matrix::IDENTITY, 1.0, &[]);
        assert!((rest / LAW.elastic().p_wave_modulus() - 1.0).abs() < 1e-7, "{rest}");
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
        let law = LAWS.iter().find(|law| law.name == "mooney_rivlin").expect("a law of the list");
        let with = |c10, c01, bulk_modulus| {
            law.build(&[(C10, c10), (C01, c01), (BULK_MODULUS, bulk_modulus)].into())
        };
        assert!(with(1.0, 0.0, 1.0).is_ok() && with(0.0, 1.0, 1.0).is_ok());
        for (constants, key) in [
            ((-1.0, 2.0, 1.0), Some(C10)),
            ((2.0, -1.0, 1.0), Some(C01)),
            ((1.0, 0.0, 0.0), Some(BULK_MODULUS)),
            ((0.0, 0.0, 1.0), None),
        ] {
            let bad = with(constants.0, constants.1, constants.2).unwrap_err();
            assert_eq!(bad.key.as_deref(), key, "{constants:?}");
        }
    }
}
