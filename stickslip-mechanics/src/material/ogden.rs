//! Ogden's elasticity in principal stretches (Ogden 1972), with the part that keeps the volume split off and the energy
//! of volume of the neo-Hookean law here.
//!
//! ```text
//! W   = K/2 ((J^2 - 1)/2 - ln J) + sum_p mu_p/a_p (L_1^a_p + L_2^a_p + L_3^a_p - 3),   L_i = J^(-1/3) l_i
//! t_i = K/2 (J^2 - 1) + sum_p mu_p (L_i^a_p - (L_1^a_p + L_2^a_p + L_3^a_p)/3)        principal values of J sigma
//! G   = 1/2 sum_p mu_p a_p                                                           shear modulus at small strain
//! ```
//!
//! With mu_p a_p > 0 for every p each term resists every stretch.

use super::declaration::{
    Absent, AllowedRange, BadConstants, Constant, Declared, End, Form, Given, POSITIVE, PRESSURE, Quantity,
    RATIO,
};
use super::principal::{Derivatives, Stretches};
use super::{History, Isotropic, Law, Motion, Response};
use crate::tensor::{Matrix, Number, Symmetric, array};
use serde::{Serialize, Serializer};

/// Most terms.
const MOST_TERMS: usize = 3;

/// Names of the constants in scene files.
const TERMS: &str = "terms";
const BULK_MODULUS: &str = "bulk_modulus";

/// Ogden's elasticity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Ogden<T> {
    /// mu_p and a_p.
    pub terms: Terms<T>,
    /// K, bulk modulus at small strain [Pa].
    pub bulk_modulus: T,
}

/// Moduli and exponents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terms<T> {
    /// mu_p [Pa]
    moduli: [T; MOST_TERMS],
    /// a_p [-]
    exponents: [T; MOST_TERMS],
    count: usize,
}

impl Terms<f64> {
    /// These pairs of modulus [Pa] and exponent [-], at most three.
    pub fn new(pairs: &[[f64; 2]]) -> Self {
        let mut terms = Terms { moduli: [0.0; MOST_TERMS], exponents: [1.0; MOST_TERMS], count: 0 };
        for &[modulus, exponent] in &pairs[..pairs.len().min(MOST_TERMS)] {
            (terms.moduli[terms.count], terms.exponents[terms.count]) = (modulus, exponent);
            terms.count += 1;
        }
        terms
    }
}

impl<T: Copy> Terms<T> {
    /// Its pairs.
    #[inline(always)]
    fn pairs(&self) -> impl Iterator<Item = [T; 2]> + '_ {
        (0..self.count).map(|i| [self.moduli[i], self.exponents[i]])
    }
}

impl<T: Serialize> Serialize for Terms<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq((0..self.count).map(|i| [&self.moduli[i], &self.exponents[i]]))
    }
}

const ANY: AllowedRange = AllowedRange { from: End::Free, to: End::Free, because: "" };

impl Declared for Ogden<f64> {
    const SUMMARY: &'static str =
        "Ogden's elasticity for rubber and tissue at large strains, of up to three powers of the stretches.";
    const CONSTANTS: &'static [Constant] = &[
        Constant {
            name: TERMS,
            summary: "Pairs of modulus mu and exponent a of the energy mu/a (L1^a + L2^a + L3^a - 3), such as [[\"0.6 MPa\", 1.3], \
                      [\"-10 kPa\", -2]].",
            form: Form::Pairs(
                [
                    Quantity { name: "modulus", unit: PRESSURE, bounds: ANY },
                    Quantity { name: "exponent", unit: RATIO, bounds: ANY },
                ],
                MOST_TERMS,
            ),
            absent: Absent::Refused("[[\"0.6 MPa\", 1.3], [\"-10 kPa\", -2]]"),
        },
        Constant::required(
            BULK_MODULUS,
            "Bulk modulus K at small strain.",
            (PRESSURE, POSITIVE),
            "\"20 MPa\"",
        ),
    ];

    fn build(given: &Given) -> Result<Self, BadConstants> {
        let terms = Terms::new(given.pairs(TERMS));
        if let Some([modulus, exponent]) = terms.pairs().find(|[modulus, exponent]| modulus * exponent <= 0.0)
        {
            return Err(BadConstants::of(
                TERMS,
                format!("modulus {modulus} Pa with exponent {exponent}"),
                "a product above 0, else the term gives way to some stretch",
            ));
        }
        Ok(Ogden { terms, bulk_modulus: given.number(BULK_MODULUS) })
    }

    fn given(&self) -> Given {
        let mut given = Given::from([(BULK_MODULUS, self.bulk_modulus)]);
        given.put(TERMS, self.terms.pairs().flatten().collect());
        given
    }

    fn elastic(&self) -> Isotropic<f64> {
        let twice: f64 = self.terms.pairs().map(|[modulus, exponent]| modulus * exponent).sum();
        Isotropic { bulk_modulus: self.bulk_modulus, shear_modulus: 0.5 * twice }
    }
}

impl<T: Number> Ogden<T> {
    /// The same constants in other numbers.
    #[inline(always)]
    pub fn map<U: Number>(&self, f: impl Fn(T) -> U) -> Ogden<U> {
        let Terms { moduli, exponents, count } = self.terms;
        let terms = Terms {
            moduli: array(U::ZERO, |i| f(moduli[i])),
            exponents: array(U::ZERO, |i| f(exponents[i])),
            count,
        };
        Ogden { terms, bulk_modulus: f(self.bulk_modulus) }
    }

    /// Cauchy stress at the end of the step [Pa].
    #[inline(always)]
    pub fn stress(&self, motion: &Motion<T>) -> Symmetric<T> {
        let stretches = Stretches::of(&motion.deformation);
        stretches.cauchy(self.derivatives(&stretches, motion.jacobian).stress, motion.jacobian)
    }

    /// L_i^a, and a third of their sum.
    #[inline(always)]
    fn powers(stretches: &Stretches<T>, exponent: T) -> ([T; 3], T) {
        let e = stretches.strains;
        let third = T::of(1.0 / 3.0);
        let mean = (e[0] + e[1] + e[2]) * third;
        let powers = e.map(|e| (exponent * (e - mean)).exp());
        (powers, (powers[0] + powers[1] + powers[2]) * third)
    }

    #[inline(always)]
    fn derivatives(&self, stretches: &Stretches<T>, jacobian: T) -> Derivatives<T> {
        let (k, square) = (self.bulk_modulus, jacobian * jacobian);
        let mut stress = [T::HALF * k * (square - T::ONE); 3];
        let mut stiffness = [[k * square; 3]; 3];
        let third = T::of(1.0 / 3.0);
        for [modulus, exponent] in self.terms.pairs() {
            let (powers, mean) = Self::powers(stretches, exponent);
            let both = modulus * exponent;
            for i in 0..3 {
                stress[i] += modulus * (powers[i] - mean);
                stiffness[i][i] += both * powers[i];
                for j in 0..3 {
                    stiffness[i][j] += both * third * (mean - powers[i] - powers[j]);
                }
            }
        }
        Derivatives { stress, stiffness }
    }

    #[inline(always)]
    fn moduli(&self, deformation: &Matrix<T>, jacobian: T) -> [T; 2] {
        let stretches = Stretches::of(deformation);
        stretches.moduli(&self.derivatives(&stretches, jacobian))
    }
}

impl<T: Number> Law<T> for Ogden<T> {
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
        let stretches = Stretches::of(deformation);
        let mut energy = T::HALF * self.bulk_modulus * (T::HALF * (j * j - T::ONE) - j.ln());
        for [modulus, exponent] in self.terms.pairs() {
            let (_, mean) = Self::powers(&stretches, exponent);
            energy += T::of(3.0) * modulus / exponent * (mean - T::ONE);
        }
        energy
    }

    #[inline(always)]
    fn wave_modulus(&self, deformation: &Matrix<T>, jacobian: T, _history: &[T; 0]) -> T {
        self.moduli(deformation, jacobian)[0]
    }

    #[inline(always)]
    fn shear_modulus(&self, deformation: &Matrix<T>, jacobian: T, _history: &[T; 0]) -> T {
        self.moduli(deformation, jacobian)[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::tests::{follow, hooke, motion_of, rotation, sample_gradients};
    use crate::material::trials::{
        answers_are_numbers, lanes_know_nothing_of_each_other, plates_have_a_thickness, stiffness_over_moduli,
    };
    use crate::material::{LAWS, MooneyRivlin, NeoHookean};

    /// Treloar's rubber, in MPa, from Ogden (1972).
    const TRELOAR: [[f64; 2]; 3] = [[0.63, 1.3], [0.0012, 5.0], [-0.01, -2.0]];

    fn law() -> Ogden<f64> {
        Ogden { terms: Terms::new(&TRELOAR), bulk_modulus: 5.0 }
    }

    fn diagonal(stretches: [f64; 3]) -> Matrix<f64> {
        Matrix::from_fn(|i, j| if i == j { stretches[i] } else { 0.0 })
    }

    #[test]
    fn small_strain_gives_hooke() {
        for h in sample_gradients() {
            let stress = law().stress(&motion_of(Matrix::IDENTITY + h * 1e-6));
            let exact = hooke(&law().elastic(), &(h * 1e-6).symmetric_part());
            assert!(stress.0.iter().zip(exact.0).all(|(s, e)| (s - e).abs() < 1e-10), "{stress:?} {exact:?}");
        }
    }

    #[test]
    fn with_exponents_of_two_it_is_neo_hookean_and_mooney_rivlin() {
        let neo = NeoHookean { elastic: Isotropic { bulk_modulus: 5.0, shear_modulus: 2.2 } };
        let mooney = MooneyRivlin { c10: 1.1, c01: 0.4, bulk_modulus: 5.0 };
        for h in sample_gradients() {
            let motion = motion_of(Matrix::IDENTITY + h * 3.0);
            let one = Ogden { terms: Terms::new(&[[2.2, 2.0]]), bulk_modulus: 5.0 }.stress(&motion);
            assert!(one.0.iter().zip(neo.stress(&motion).0).all(|(s, e)| (s - e).abs() < 1e-12));
            let two =
                Ogden { terms: Terms::new(&[[2.2, 2.0], [-0.8, -2.0]]), bulk_modulus: 5.0 }.stress(&motion);
            assert!(two.0.iter().zip(mooney.stress(&motion).0).all(|(s, e)| (s - e).abs() < 1e-12));
        }
    }

    /// Rubber that keeps its volume, along one axis: sum mu_p (l^a_p - l^(-a_p/2)), two: sum mu_p (l^a_p - l^(-2 a_p)).
    #[test]
    fn bars_and_balloons_bear_the_stress_of_the_textbook() {
        for stretch in [0.5f64, 1.2, 3.0, 7.0] {
            let sum = |across: f64| -> f64 {
                TRELOAR.iter().map(|[mu, a]| mu * (stretch.powf(*a) - stretch.powf(across * a))).sum()
            };
            let thin = stretch.powf(-0.5);
            let one = law().stress(&motion_of(diagonal([stretch, thin, thin]))).0;
            assert!(((one[0] - one[1]) / sum(-0.5) - 1.0).abs() < 1e-12, "{stretch}: {one:?}");
            let two = law().stress(&motion_of(diagonal([stretch, stretch, stretch.powi(-2)]))).0;
            assert!(((two[0] - two[2]) / sum(-2.0) - 1.0).abs() < 1e-12, "{stretch}: {two:?}");
        }
    }

    #[test]
    fn energy_is_the_work_of_the_stress() {
        for h in sample_gradients() {
            let (end, _, work) = follow(&law(), (2000, 1.0), |t| Matrix::IDENTITY + h * (3.0 * t));
            let energy = law().strain_energy(&end.deformation, &end.stress, &[]);
            assert!((work / energy - 1.0).abs() < 1e-5, "{work} {energy}");
        }
    }

    #[test]
    fn rotation_rotates_the_stress() {
        let q = rotation();
        for h in sample_gradients() {
            let f = Matrix::IDENTITY + h;
            let (turned, expected) =
                (law().stress(&motion_of(q * f)), law().stress(&motion_of(f)).rotated(&q));
            assert!(turned.0.iter().zip(expected.0).all(|(s, e)| (s - e).abs() < 1e-13));
        }
    }

    /// No wave is faster than the law says, in 1000 states of stretches up to e, and some are as fast; at rest the moduli are Hooke's.
    #[test]
    fn moduli_are_those_of_the_fastest_waves_or_above() {
        for (pairs, bulk_modulus) in [
            (&TRELOAR[..], 0.1),
            (&TRELOAR, 10.0),
            (&[[1.0, 2.0]], 0.1),
            (&[[-1.0, -2.0]], 0.1),
            (&[[0.1, 8.0], [-0.5, -0.5]], 0.1),
        ] {
            let law = Ogden { terms: Terms::new(pairs), bulk_modulus };
            let [waves, shear] = stiffness_over_moduli(&law, (1000, 1.0));
            assert!((0.95..1.0 + 1e-6).contains(&waves), "{pairs:?}: {waves}");
            assert!((0.9..1.0 + 1e-6).contains(&shear), "{pairs:?}: {shear}");
        }
        let [waves, shear] = law().moduli(&Matrix::IDENTITY, 1.0);
        let elastic = law().elastic();
        assert!((waves / elastic.p_wave_modulus() - 1.0).abs() < 1e-12, "{waves}");
        assert!((shear / elastic.shear_modulus - 1.0).abs() < 1e-12, "{shear}");
    }

    #[test]
    fn particles_side_by_side_know_nothing_of_each_other() {
        lanes_know_nothing_of_each_other(&law(), &law().map(Number::of), 2000);
    }

    #[test]
    fn plates_have_a_thickness_without_stress() {
        plates_have_a_thickness(&law(), 400);
    }

    #[test]
    fn whatever_the_motion_the_answers_are_numbers() {
        answers_are_numbers(&law(), 20_000);
        answers_are_numbers(&law().map(|x| x as f32), 20_000);
    }

    #[test]
    fn constants_that_make_no_material_are_refused() {
        let description = LAWS.iter().find(|law| law.name == "ogden").expect("a law of the list");
        let with = |pairs: &[f64], bulk_modulus| {
            let mut given = Given::from([(BULK_MODULUS, bulk_modulus)]);
            given.put(TERMS, pairs.to_vec());
            description.build(&given)
        };
        assert!(with(&[1.0, 2.0, -1.0, -2.0], 1.0).is_ok());
        for (pairs, found) in [
            (&[1.0, -2.0][..], "modulus 1 Pa with exponent -2"),
            (&[1.0, 0.0], "modulus 1 Pa with exponent 0"),
            (&[], "0 pairs"),
            (&[1.0; 8], "4 pairs"),
        ] {
            let bad = with(pairs, 1.0).unwrap_err();
            assert_eq!((bad.key.as_deref(), &bad.found[..]), (Some(TERMS), found));
        }
        assert_eq!(with(&[1.0, 2.0], 0.0).unwrap_err().key.as_deref(), Some(BULK_MODULUS));
    }
}
