//! Soil and rock whose strength grows with the pressure: the cone of Drucker and Prager (1952), elastic in rate form as
//! [`Hypoelastic`], with a return to the cone or to its end (de Souza Neto, Peric and Owen 2008, section 8.3).
//!
//! ```text
//! J q <= A J p + k,   J p >= -t,   p = -tr(sigma)/3,   q = sqrt(3/2 s : s)       t = min(t_0, k/A)
//! da  = max(0, q* - A p* - k/J) / (3 G + K A B)                                  star: of the elastic step
//! q   = q* - 3 G da,   p = p* + K B da,   s = (q/q*) s*                          on the cone
//! p   = -t/J,   q = min(q*, (k - A t)/J)                                         where that p is below -t/J
//! dD  = ((A - B) J p + k) da + t (p - p* - K B da)/K                             dissipated per undeformed volume
//! ```
//!
//! A, B and k follow from Mohr and Coulomb's friction angle phi, dilation angle psi and cohesion c:
//!
//! ```text
//! outside        A = 6 sin(phi)/(3 - sin(phi)),   k = 6 c cos(phi)/(3 - sin(phi))      triaxial compression
//! inside         A = 6 sin(phi)/(3 + sin(phi)),   k = 6 c cos(phi)/(3 + sin(phi))      triaxial extension
//! plane-strain   A = sin(phi)/N,   k = c cos(phi)/N,   N = sqrt((1 - B^2/9)/3) + B sin(phi)/9
//!                B = 3 sin(psi)/sqrt(3 + sin(psi)^2)
//! ```
//! and B by the first two is A with psi for phi. The third follows from flow that leaves the thickness alone, with s_zz
//! = -2 B q/9, so that strength and dilation in the plane are those of Mohr and Coulomb; with psi = phi it is Drucker
//! and Prager's own.
//!
//! a is the plastic shear strain, sqrt(2/3 e : e) of the deviator of its rate over time. The star is of a step that
//! begins with the gap by which the soil came apart, see [`soil`]. As in [`super::VonMises`], cohesion and tension
//! bound the Kirchhoff stress. Strength does not change with strain: softening would follow the grid.

use super::declaration::{Absent, BadConstants, Constant, Declared, Form, Given};
use super::soil::{self, Strength, equivalent, pressure};
use super::{History, Hypoelastic, Isotropic, Law, Motion, Response, elastic};
use crate::tensor::{Matrix, Number, Symmetric};
use serde::Serialize;

/// Which of Mohr and Coulomb's states the cone has the strength of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
enum Fit {
    Outside,
    Inside,
    PlaneStrain,
}

/// Soil by Drucker and Prager.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DruckerPrager<T> {
    /// The law below yield.
    #[serde(flatten)]
    pub elastic: Hypoelastic<T>,
    /// phi [rad]
    pub friction_angle: T,
    /// psi [rad]
    pub dilation_angle: T,
    /// c [Pa]
    pub cohesion: T,
    /// t_0, largest mean tension if it is bounded [Pa].
    pub tension_strength: Option<T>,
    fit: Fit,
    /// A [-]
    #[serde(skip)]
    friction: T,
    /// B [-]
    #[serde(skip)]
    dilation: T,
    /// k [Pa]
    #[serde(skip)]
    strength: T,
    /// t [Pa]
    #[serde(skip)]
    tension: T,
}

/// Name of the fit in scene files.
const FIT: &str = "fit";
/// The fits as scene files name them, in the order of [`Fit`].
const FITS: &[(&str, &str)] = &[
    ("outside", "Strength of triaxial compression; elsewhere the soil bears more than by Mohr and Coulomb."),
    ("inside", "Strength of triaxial extension; elsewhere the soil bears less than by Mohr and Coulomb."),
    ("plane-strain", "Strength and dilation of flow in plane strain."),
];
const PLACES: [Fit; 3] = [Fit::Outside, Fit::Inside, Fit::PlaneStrain];

/// A, B and k over c, of sines of the angles and the cosine of the first.
fn cone(fit: Fit, (friction, dilation): (f64, f64), cosine: f64) -> [f64; 3] {
    match fit {
        Fit::Outside => {
            let a = 6.0 / (3.0 - friction);
            [a * friction, 6.0 * dilation / (3.0 - dilation), a * cosine]
        }
        Fit::Inside => {
            let a = 6.0 / (3.0 + friction);
            [a * friction, 6.0 * dilation / (3.0 + dilation), a * cosine]
        }
        Fit::PlaneStrain => {
            let b = 3.0 * dilation / (3.0 + dilation * dilation).sqrt();
            let a = 1.0 / (((1.0 - b * b / 9.0) / 3.0).sqrt() + b * friction / 9.0);
            [a * friction, b, a * cosine]
        }
    }
}

impl Declared for DruckerPrager<f64> {
    const SUMMARY: &'static str = "Soil and rock whose strength grows with pressure, by Drucker and Prager, with dilation; \
                                   elastic below it as the hypoelastic law.";
    const CONSTANTS: &'static [Constant] = &{
        let [friction, dilation, cohesion, tension] =
            soil::constants("Largest mean tension -p; without it, that of the end of the cone.");
        elastic::and::<5, 10>([
            friction,
            dilation,
            cohesion,
            tension,
            Constant {
                name: FIT,
                summary: "Where the cone has the strength of Mohr and Coulomb; `outside` by default.",
                form: Form::Word(FITS),
                absent: Absent::Default(0.0),
            },
        ])
    };

    fn build(given: &Given) -> Result<Self, BadConstants> {
        let elastic = Isotropic::build(given)?;
        if elastic.shear_modulus == 0.0 {
            return Err(BadConstants::together("G = 0", "G above 0: a fluid has no friction within"));
        }
        let strength = Strength::build(given)?;
        let fit = PLACES[given.number(FIT) as usize];
        let (phi, psi) = (strength.friction_angle, strength.dilation_angle);
        let [friction, dilation, cohesive] = cone(fit, (libm::sin(phi), libm::sin(psi)), libm::cos(phi));
        let cohesive = cohesive * strength.cohesion;
        Ok(DruckerPrager {
            elastic: Hypoelastic { elastic },
            friction_angle: phi,
            dilation_angle: psi,
            cohesion: strength.cohesion,
            tension_strength: strength.tension_strength,
            fit,
            friction,
            dilation,
            strength: cohesive,
            tension: strength.tension(cohesive / friction),
        })
    }

    fn given(&self) -> Given {
        let strength = Strength {
            friction_angle: self.friction_angle,
            dilation_angle: self.dilation_angle,
            cohesion: self.cohesion,
            tension_strength: self.tension_strength,
        };
        strength.given(self.elastic.given()).with(FIT, self.fit as usize as f64)
    }

    fn elastic(&self) -> Isotropic<f64> {
        self.elastic.elastic
    }
}

impl<T: Copy> DruckerPrager<T> {
    /// The same constants in other numbers.
    #[inline(always)]
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> DruckerPrager<U> {
        DruckerPrager {
            friction_angle: f(self.friction_angle),
            dilation_angle: f(self.dilation_angle),
            cohesion: f(self.cohesion),
            tension_strength: self.tension_strength.map(&f),
            fit: self.fit,
            friction: f(self.friction),
            dilation: f(self.dilation),
            strength: f(self.strength),
            tension: f(self.tension),
            elastic: self.elastic.map(f),
        }
    }
}

impl<T: Number> Law<T> for DruckerPrager<T> {
    /// a, o and D.
    type History = [T; 3];

    #[inline(always)]
    fn history(&self) -> &'static [History] {
        &soil::HISTORY
    }

    /// Plastic flow resists no error of F.
    #[inline(always)]
    fn trusts_deformation(&self) -> bool {
        false
    }

    #[inline(always)]
    fn respond(&self, motion: &Motion<T>, &[strain, opening, lost]: &[T; 3]) -> Response<T, [T; 3]> {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic.elastic;
        let (a, b, three_g, j) = (self.friction, self.dilation, T::of(3.0) * g, motion.jacobian);
        let trial = soil::trial(&self.elastic, motion, opening);
        let deviator = trial.stress.deviator();
        let (q, p) = (equivalent(&deviator), pressure(&trial.stress));
        let (strength, tension) = (self.strength / j, self.tension / j);
        let sheared = (q - a * p - strength).max(T::ZERO) / (three_g + k * a * b);
        let whole = (p + k * b * sheared).at_least(-tension);
        // Beyond the end of the cone, or its cut.
        let left = q.min((strength - a * tension).max(T::ZERO));
        let flow = T::select(whole, sheared, (q - left) / three_g);
        let dilated = p + k * b * flow;
        let after = dilated.max(-tension);
        // Without flow nothing is divided: a stress without deviator stays as it is.
        let share = (three_g * flow / q.max(T::EPSILON * T::EPSILON * g)).min(T::ONE);
        let stress = trial.stress - deviator * share + Symmetric::isotropic(p - after);
        let mean = T::HALF * (pressure(&trial.before) + j * after);
        let by_shear = (mean * (a - b) + self.strength).max(T::ZERO) * flow;
        let by_tension = self.tension / k * (after - dilated);
        let opening = soil::opening(&self.elastic, self.tension, after - dilated);
        let history = [strain + flow, opening, lost + by_shear + by_tension];
        Response { stress, history }
    }

    #[inline(always)]
    fn strain_energy(&self, deformation: &Matrix<T>, stress: &Symmetric<T>, _history: &[T; 3]) -> T {
        self.elastic.strain_energy(deformation, stress, &[])
    }

    #[inline(always)]
    fn dissipation(&self, &[_, _, lost]: &[T; 3]) -> T {
        lost
    }

    /// Of the elastic law, at the volume that closing an opening leaves, and more: where soil that dilates by less than
    /// it rubs flows while it expands, it is stiffer than elastic, by at most
    /// (K (A - B) + k)^2/(4 (3 G + K A B)).
    #[inline(always)]
    fn wave_modulus(&self, deformation: &Matrix<T>, jacobian: T, &[_, opening, _]: &[T; 3]) -> T {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic.elastic;
        let (a, b) = (self.friction, self.dilation);
        let apart = k * (a - b) + self.strength;
        let more = apart * apart / (T::of(4.0) * (T::of(3.0) * g + k * a * b));
        (self.elastic.wave_modulus(deformation, jacobian, &[]) + more * jacobian) * (-opening).exp()
    }

    #[inline(always)]
    fn shear_modulus(&self, deformation: &Matrix<T>, jacobian: T, &[_, opening, _]: &[T; 3]) -> T {
        self.elastic.shear_modulus(deformation, jacobian, &[]) * (-opening).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::soil::tests::{
        Chance, State, along_axes, in_single_precision, ledger, noise_leaves_no_gap, only_turns,
        plates_have_a_thickness, pressed, random_paths, stiffest_on_paths,
    };
    use crate::material::tests::{hooke, motion_of, sample_gradients};
    use crate::material::{LAWS, Material, NoStretch};

    const ELASTIC: Isotropic<f64> = Isotropic { bulk_modulus: 20e6, shear_modulus: 10e6 };

    fn law(angles: [f64; 2], cohesion: f64, fit: Fit) -> DruckerPrager<f64> {
        let given = ELASTIC
            .given()
            .with("friction_angle", angles[0].to_radians())
            .with("dilation_angle", angles[1].to_radians())
            .with("cohesion", cohesion)
            .with(FIT, fit as usize as f64);
        Declared::build(&given).expect("sound constants")
    }

    fn cut(law: DruckerPrager<f64>, tension: f64) -> DruckerPrager<f64> {
        Declared::build(&law.given().with("tension_strength", tension)).expect("sound constants")
    }

    fn laws() -> [DruckerPrager<f64>; 7] {
        [
            law([30.0, 0.0], 0.0, Fit::Outside),
            law([35.0, 10.0], 0.0, Fit::PlaneStrain),
            law([30.0, 30.0], 20e3, Fit::Inside),
            law([30.0, 5.0], 20e3, Fit::Outside),
            law([0.0, 0.0], 20e3, Fit::Outside),
            cut(law([30.0, 5.0], 20e3, Fit::Outside), 5e3),
            cut(law([0.0, 0.0], 20e3, Fit::Outside), 0.0),
        ]
    }

    /// q - A p - k/J over the scale of it; positive outside of the cone.
    fn outside(law: &DruckerPrager<f64>, state: &State<[f64; 3]>) -> f64 {
        let j = state.motion.jacobian;
        let cone = state.q() - law.friction * state.p() - law.strength / j;
        let cut = -law.tension / j - state.p();
        cone.max(cut) / (ELASTIC.bulk_modulus + state.p().abs())
    }

    #[test]
    fn below_yield_it_is_the_elastic_law_and_small_strain_gives_hooke() {
        for law in laws() {
            let under = Symmetric([-120e3, -100e3, -100e3, 0.0, 10e3, 0.0]);
            for h in sample_gradients() {
                let motion = Motion { stress: under, ..motion_of(Matrix::IDENTITY + h * 1e-5) };
                let response = law.respond(&motion, &[0.0; 3]);
                if law.friction > 0.0 {
                    assert_eq!(response.stress, law.elastic.stress(&motion));
                    assert_eq!(response.history, [0.0; 3]);
                }
                let motion =
                    Motion { stress: Symmetric::isotropic(-100e3), ..motion_of(Matrix::IDENTITY + h * 1e-7) };
                let exact = hooke(&ELASTIC, &(h * 1e-7).symmetric_part()) + motion.stress;
                let stress = law.respond(&motion, &[0.0; 3]).stress;
                assert!(
                    stress.0.iter().zip(exact.0).all(|(s, e)| (s - e).abs() < 1e-5),
                    "{stress:?} {exact:?}"
                );
            }
            let rest = law.respond(&motion_of(Matrix::IDENTITY), &[0.0; 3]);
            assert_eq!((rest.stress, rest.history), (Symmetric::ZERO, [0.0; 3]));
        }
    }

    /// sigma_1 = sigma_3 N + 2 c sqrt(N), N = (1 + sin(phi))/(1 - sin(phi)), by Mohr and Coulomb under a pressure of
    /// 100 kPa at the sides: in triaxial compression by the fit outside, in extension by that inside, and in plane
    /// strain by the third with any dilation.
    #[test]
    fn strengths_are_those_of_mohr_and_coulomb() {
        let side = 100e3;
        for (cohesion, angles) in [(0.0, [30.0f64, 0.0]), (15e3, [35.0, 12.0]), (15e3, [25.0, 25.0])] {
            let sine = angles[0].to_radians().sin();
            let ratio = (1.0 + sine) / (1.0 - sine);
            // Cohesion is by undeformed area: soil that loosens has less of it.
            let most = |j: f64| side * ratio + 2.0 * cohesion / j * ratio.sqrt();
            let least = |j: f64| (side - 2.0 * cohesion / j * ratio.sqrt()) / ratio;
            let start = State::under(Symmetric::isotropic(-side));
            for (fit, both, axial) in
                [(Fit::Outside, true, -1e-4), (Fit::Inside, true, 1e-4), (Fit::PlaneStrain, false, -1e-4)]
            {
                let law = law(angles, cohesion, fit);
                let end = pressed(&law, (start, both), (1500, axial), |_| {});
                let (found, j) = (-end.stress().0[2], end.motion.jacobian);
                let exact = if axial < 0.0 { most(j) } else { least(j) };
                assert!((found / exact - 1.0).abs() < 1e-4, "{fit:?} {angles:?}: {found} {exact}");
            }
        }
    }

    /// In plane strain the rate of volume strain over that of shear in the plane is the sine of the dilation angle.
    #[test]
    fn dilation_in_plane_strain_is_the_angle_given() {
        let law = law([35.0, 12.0], 0.0, Fit::PlaneStrain);
        let start = State::under(Symmetric::isotropic(-100e3));
        let middle = pressed(&law, (start, false), (1500, -1e-4), |_| {});
        let end = pressed(&law, (middle, false), (100, -1e-4), |_| {});
        let grown = |axis: usize| {
            (end.motion.deformation.0[axis][axis] / middle.motion.deformation.0[axis][axis]).ln()
        };
        let sine = (grown(0) + grown(2)) / (grown(0) - grown(2));
        assert!((sine - 12f64.to_radians().sin()).abs() < 1e-4, "{sine}");
    }

    #[test]
    fn on_random_paths_the_stress_stays_within_and_dissipation_never_falls() {
        for law in laws() {
            let start = |chance: &mut Chance| Symmetric::isotropic(-100e3 * (1.0 + chance.next()));
            random_paths(&law, start, |before, after| {
                assert!(outside(&law, after) < 1e-12, "{law:?} {after:?}");
                assert!(law.dissipation(&after.history) >= law.dissipation(&before.history));
                assert!(after.history[0] >= before.history[0] && after.history[1] >= 0.0);
            });
        }
    }

    #[test]
    fn single_precision_stays_within_too() {
        for law in laws() {
            let law = law.map(|x| x as f32);
            in_single_precision(&law, 100e3, |motion, _| {
                let (p, q) = (pressure(&motion.stress), equivalent(&motion.stress.deviator()));
                let cone = q - law.friction * p - law.strength / motion.jacobian;
                cone.max(-law.tension / motion.jacobian - p) / (20e6 + p.abs() + q)
            });
        }
    }

    /// Sand begins with a stress that it bears, and is refused one that it does not.
    #[test]
    fn it_carries_a_stress_within_the_cone() {
        for law in [laws()[0], laws()[3]] {
            let material = Material::DruckerPrager(law);
            assert!(material.carries_stress());
            let borne = Symmetric([-50e3, -50e3, -100e3, 1e3, 0.0, 0.0]);
            assert_eq!(material.stretch_under(&borne), Ok(Symmetric::isotropic(1.0)));
            let not = Symmetric([-50e3, -50e3, -400e3, 0.0, 0.0, 0.0]);
            assert_eq!(material.stretch_under(&not), Err(NoStretch::Yields));
        }
    }

    #[test]
    fn the_work_is_stored_or_dissipated() {
        for law in laws() {
            let misses = ledger(&law, (Symmetric::isotropic(-50e3), 0.05), 8000);
            assert!(misses < 2e-3, "{law:?}: {misses}");
        }
    }

    #[test]
    fn a_step_of_rotation_only_rotates_the_stress() {
        for law in laws() {
            let start = State::under(Symmetric::isotropic(-100e3));
            let h = sample_gradients()[2];
            let state = start.moved(&law, Matrix::IDENTITY + h * 0.01);
            only_turns(&law, &state);
        }
    }

    /// Sand that is pulled apart bears nothing, and nothing again until it has its volume back.
    #[test]
    fn sand_that_came_apart_closes_before_it_presses() {
        let law = law([30.0, 0.0], 0.0, Fit::Outside);
        let mut state = State::under(Symmetric::isotropic(-10e3));
        let pulled = 10e3 / ELASTIC.bulk_modulus;
        for _ in 0..100 {
            state = state.moved(&law, along_axes([1e-3; 3]));
        }
        assert_eq!((state.p(), state.q()), (0.0, 0.0));
        assert!((state.history[1] - (0.3 - pulled)).abs() < 1e-6, "{:?}", state.history);
        let waves = law.wave_modulus(&state.motion.deformation, state.motion.jacobian, &state.history);
        assert!((waves / law.wave_modulus(&Matrix::IDENTITY, 1.0, &[0.0; 3]) - 1.0).abs() < 1e-2);
        for _ in 0..99 {
            state = state.moved(&law, along_axes([-1e-3; 3]));
            assert!(state.p().abs() < 1e-6, "{state:?}");
        }
        state = state.moved(&law, along_axes([-1e-3; 3]));
        assert!((state.p() / 10e3 - 1.0).abs() < 1e-2, "{}", state.p());
        assert!(state.history[1].abs() < 1e-12);
    }

    #[test]
    fn noise_does_not_open_for_good_what_is_pressed() {
        noise_leaves_no_gap(&law([30.0, 0.0], 0.0, Fit::Outside), ELASTIC.bulk_modulus);
    }

    /// The stiffest that a small step finds, over what is said: below one, and not by much.
    #[test]
    fn the_wave_modulus_is_an_upper_bound() {
        for law in laws() {
            let largest = stiffest_on_paths(&law, Symmetric::isotropic(-100e3));
            assert!((0.75..1.0 + 1e-5).contains(&largest), "{law:?}: {largest}");
        }
    }

    #[test]
    fn a_thin_plate_of_it_has_a_thickness() {
        for law in laws() {
            plates_have_a_thickness(&law, ELASTIC.bulk_modulus);
        }
    }

    #[test]
    fn constants_that_make_no_material_are_refused() {
        let law = LAWS.iter().find(|law| law.name == "drucker_prager").expect("a law of the list");
        let with = |more: &[(&str, f64)]| {
            law.build(&more.iter().fold(ELASTIC.given(), |given, &(name, value)| given.with(name, value)))
        };
        let sound = with(&[("friction_angle", 0.5)]).expect("sand").given();
        assert_eq!(
            (sound.get("cohesion"), sound.get("tension_strength"), sound.get(FIT)),
            (Some(0.0), None, Some(0.0))
        );
        for (constants, key) in [
            (&[][..], None),
            (&[("friction_angle", 30.0)], Some("friction_angle")),
            (&[("friction_angle", -0.1)], Some("friction_angle")),
            (&[("friction_angle", 0.5), ("dilation_angle", 0.6)], Some("dilation_angle")),
            (&[("friction_angle", 0.5), ("cohesion", -1.0)], Some("cohesion")),
            (&[("friction_angle", 0.5), ("tension_strength", -1.0)], Some("tension_strength")),
            (&[("friction_angle", 0.5), (FIT, 3.0)], Some(FIT)),
            (&[("friction_angle", 0.0)], None),
        ] {
            let bad = with(constants).unwrap_err();
            assert_eq!(bad.key.as_deref(), key, "{constants:?}");
        }
        let bad = with(&[("friction_angle", 30.0)]).unwrap_err();
        assert_eq!(bad.found, "30 rad");
        assert!(bad.allowed.contains("degrees have their unit"), "{bad}");
    }
}
