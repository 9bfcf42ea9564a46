//! Elastoplasticity of von Mises with linear isotropic hardening: elasticity in rate form, [`Hypoelastic`], and a
//! radial return (Wilkins 1964; Simo and Hughes 1998, section 3.3).
//!
//! ```text
//! J q <= Y,   q = sqrt(3/2 s : s),   s = dev(sigma),   Y = Y_0 + H a          a: equivalent plastic strain
//! da  = max(0, J q* - Y) / (3 G J + H)              q*, s*: of the elastic step sigma*
//! sigma = sigma* - (3 G da / q*) s*
//! W_p = Y_0 a + H a^2 / 2                           dissipated per undeformed volume
//! ```
//!
//! The yield stress bounds the Kirchhoff stress J sigma, so that what flow dissipates depends on a alone; J is one but
//! for the elastic volume strain. Flow keeps the volume.

use super::declaration::{BadConstants, Constant, Declared, Given, NOT_NEGATIVE, POSITIVE, PRESSURE};
use super::{History, Hypoelastic, Isotropic, Law, Motion, Response, elastic};
use crate::column::Kind;
use crate::tensor::{Matrix, Number, Symmetric};
use serde::Serialize;

/// Elastoplasticity of von Mises.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct VonMises<T> {
    /// The law below yield.
    #[serde(flatten)]
    pub elastic: Hypoelastic<T>,
    /// Y_0, yield stress in uniaxial tension before any flow [Pa].
    pub yield_stress: T,
    /// H, growth of the yield stress by equivalent plastic strain [Pa].
    pub hardening_modulus: T,
}

/// Names of the constants of flow in scene files.
const YIELD_STRESS: &str = "yield_stress";
const HARDENING_MODULUS: &str = "hardening_modulus";

/// What a particle remembers.
const HISTORY: [History; 1] = [History::new("plastic_strain", "", Kind::Number)];

impl Declared for VonMises<f64> {
    const SUMMARY: &'static str = "Plastic flow at a yield stress that may harden, elastic below it as the hypoelastic law, \
                                   for metals and clay.";
    const CONSTANTS: &'static [Constant] = &elastic::and::<2, 7>([
        Constant::required(
            YIELD_STRESS,
            "Yield stress in uniaxial tension before any flow, Y_0.",
            (PRESSURE, POSITIVE),
            "\"40 MPa\"",
        ),
        Constant::optional(
            HARDENING_MODULUS,
            "Growth of the yield stress by equivalent plastic strain, H; none without it.",
            (PRESSURE, NOT_NEGATIVE.because(", for softening would follow the grid")),
            0.0,
        ),
    ]);

    fn build(given: &Given) -> Result<Self, BadConstants> {
        let elastic = Isotropic::build(given)?;
        if elastic.shear_modulus == 0.0 {
            return Err(BadConstants::together("G = 0", "G above 0: a fluid has nothing that yields"));
        }
        let (yield_stress, hardening_modulus) = (given.number(YIELD_STRESS), given.number(HARDENING_MODULUS));
        Ok(VonMises { elastic: Hypoelastic { elastic }, yield_stress, hardening_modulus })
    }

    fn given(&self) -> Given {
        let elastic = self.elastic.given();
        elastic.with(YIELD_STRESS, self.yield_stress).with(HARDENING_MODULUS, self.hardening_modulus)
    }

    fn elastic(&self) -> Isotropic<f64> {
        self.elastic.elastic
    }
}

impl<T: Copy> VonMises<T> {
    /// The same constants in other numbers.
    #[inline(always)]
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> VonMises<U> {
        VonMises {
            yield_stress: f(self.yield_stress),
            hardening_modulus: f(self.hardening_modulus),
            elastic: Hypoelastic { elastic: self.elastic.elastic.map(f) },
        }
    }
}

impl<T: Number> Law<T> for VonMises<T> {
    /// Equivalent plastic strain, sqrt(2/3 D_p : D_p) over time.
    type History = [T; 1];

    #[inline(always)]
    fn history(&self) -> &'static [History] {
        &HISTORY
    }

    /// Plastic flow resists no error of F.
    #[inline(always)]
    fn trusts_deformation(&self) -> bool {
        false
    }

    #[inline(always)]
    fn respond(&self, motion: &Motion<T>, &[plastic_strain]: &[T; 1]) -> Response<T, [T; 1]> {
        let three_g = T::of(3.0) * self.elastic.elastic.shear_modulus;
        let trial = self.elastic.stress(motion);
        let deviator = trial.deviator();
        let q = (T::of(1.5) * deviator.double_dot(&deviator)).sqrt();
        let allowed = self.yield_stress + self.hardening_modulus * plastic_strain;
        let excess = (motion.jacobian * q - allowed).max(T::ZERO);
        let flow = excess / (three_g * motion.jacobian + self.hardening_modulus);
        // Without excess nothing is divided: a stress without deviator stays as it is.
        let share = three_g * flow / q.max(T::EPSILON * self.yield_stress);
        Response { stress: trial - deviator * share, history: [plastic_strain + flow] }
    }

    #[inline(always)]
    fn strain_energy(&self, deformation: &Matrix<T>, stress: &Symmetric<T>, _history: &[T; 1]) -> T {
        self.elastic.strain_energy(deformation, stress, &[])
    }

    #[inline(always)]
    fn dissipation(&self, &[plastic_strain]: &[T; 1]) -> T {
        (self.yield_stress + T::HALF * self.hardening_modulus * plastic_strain) * plastic_strain
    }

    #[inline(always)]
    fn wave_modulus(&self, deformation: &Matrix<T>, jacobian: T, _history: &[T; 1]) -> T {
        self.elastic.wave_modulus(deformation, jacobian, &[])
    }

    #[inline(always)]
    fn shear_modulus(&self, deformation: &Matrix<T>, jacobian: T, _history: &[T; 1]) -> T {
        self.elastic.shear_modulus(deformation, jacobian, &[])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::LAWS;
    use crate::material::tests::{follow, motion_of, rotation, sample_gradients};

    const LAW: VonMises<f64> = VonMises {
        elastic: Hypoelastic { elastic: Isotropic { bulk_modulus: 600.0, shear_modulus: 300.0 } },
        yield_stress: 0.9,
        hardening_modulus: 3.0,
    };

    fn equivalent(stress: &Symmetric<f64>) -> f64 {
        let s = stress.deviator();
        (1.5 * s.double_dot(&s)).sqrt()
    }

    #[test]
    fn below_yield_it_is_the_elastic_law() {
        for h in sample_gradients() {
            let motion = motion_of(Matrix::IDENTITY + h * 1e-3);
            let response = LAW.respond(&motion, &[0.0]);
            assert_eq!(response.stress, LAW.elastic.stress(&motion));
            assert_eq!(response.history, [0.0]);
        }
        let rest = LAW.respond(&motion_of(Matrix::IDENTITY), &[0.0]);
        assert_eq!((rest.stress, rest.history), (Symmetric::ZERO, [0.0]));
    }

    #[test]
    fn beyond_yield_the_stress_stays_on_the_surface() {
        for h in sample_gradients() {
            let (end, [plastic_strain], _) = follow(&LAW, (50, 1.0), |t| Matrix::IDENTITY + h * t);
            let allowed = LAW.yield_stress + LAW.hardening_modulus * plastic_strain;
            assert!(plastic_strain > 0.01, "{plastic_strain}");
            assert!((end.jacobian * equivalent(&end.stress) / allowed - 1.0).abs() < 1e-12);
        }
    }

    /// sigma_xx of a bar whose sides are free and whose length has this logarithmic strain, e > Y_0/E, at small elastic
    /// strain: Y_0 + H (e - sigma/E), so (Y_0 + H e)/(1 + H/E).
    #[test]
    fn a_bar_in_tension_hardens_by_the_tangent_of_the_textbook() {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = LAW.elastic.elastic;
        let young = 9.0 * k * g / (3.0 * k + g);
        let e: f64 = 0.2;
        let exact = (LAW.yield_stress + LAW.hardening_modulus * e) / (1.0 + LAW.hardening_modulus / young);
        // The width that leaves the sides free: plastic strain keeps the volume, elastic strain has Poisson's ratio.
        let nu = (3.0 * k - 2.0 * g) / (2.0 * (3.0 * k + g));
        let width = |t: f64| {
            let strain = e * t;
            let yielding = LAW.yield_stress / young;
            let stress = match strain < yielding {
                true => young * strain,
                false => {
                    (LAW.yield_stress + LAW.hardening_modulus * strain)
                        / (1.0 + LAW.hardening_modulus / young)
                }
            };
            (-nu * stress / young - 0.5 * (strain - stress / young)).exp()
        };
        let bar = |t: f64| {
            let (length, width) = ((e * t).exp(), width(t));
            Matrix([[length, 0.0, 0.0], [0.0, width, 0.0], [0.0, 0.0, width]])
        };
        let (end, [plastic_strain], _) = follow(&LAW, (2000, 1.0), bar);
        assert!((end.stress.0[0] / exact - 1.0).abs() < 2e-3, "{} {exact}", end.stress.0[0]);
        assert!(end.stress.0[1].abs() < 2e-3 * exact, "{:?}", end.stress);
        assert!((plastic_strain - (e - exact / young)).abs() < 1e-4);
    }

    /// With little change of volume, for the rate form's energy of that is exact only where it is small.
    #[test]
    fn the_work_is_stored_or_dissipated() {
        for h in sample_gradients() {
            let motion = |t: f64| {
                let f = Matrix::IDENTITY + h * t;
                f * ((1.0 + 1e-3 * t) / f.det().cbrt())
            };
            let (end, history, work) = follow(&LAW, (4000, 1.0), motion);
            let stored = LAW.strain_energy(&end.deformation, &end.stress, &history);
            let dissipated = LAW.dissipation(&history);
            assert!(dissipated > 0.9 * work, "{dissipated} of {work}");
            assert!(((stored + dissipated) / work - 1.0).abs() < 1e-3, "{stored} + {dissipated}, {work}");
        }
    }

    #[test]
    fn a_step_of_rotation_only_rotates_the_stress() {
        let (before, history, _) = follow(&LAW, (50, 1.0), |t| Matrix::IDENTITY + sample_gradients()[2] * t);
        let q = rotation();
        let motion = Motion { deformation: q * before.deformation, increment: q, ..before };
        let after = LAW.respond(&motion, &history);
        for (s, e) in after.stress.0.iter().zip(before.stress.rotated(&q).0) {
            assert!((s - e).abs() < 1e-12, "{s} {e}");
        }
        assert!((after.history[0] - history[0]).abs() < 1e-12);
    }

    #[test]
    fn constants_that_make_no_material_are_refused() {
        let law = LAWS.iter().find(|law| law.name == "von_mises").expect("a law of the list");
        let elastic = || Given::from([("bulk_modulus", 6.0), ("shear_modulus", 3.0)]);
        let with = |more: &[(&str, f64)]| {
            law.build(&more.iter().fold(elastic(), |given, &(name, value)| given.with(name, value)))
        };
        assert_eq!(with(&[("yield_stress", 1.0)]).unwrap().given().get("hardening_modulus"), Some(0.0));
        for (constants, key) in [
            (&[][..], None),
            (&[("yield_stress", 0.0)], Some("yield_stress")),
            (&[("yield_stress", 1.0), ("hardening_modulus", -1.0)], Some("hardening_modulus")),
            (&[("yield_stress", 1.0), ("young_modulus", 1.0)], None),
        ] {
            assert_eq!(with(constants).unwrap_err().key.as_deref(), key, "{constants:?}");
        }
    }
}
