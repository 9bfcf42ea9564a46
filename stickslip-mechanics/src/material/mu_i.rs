//! Grains that flow densely, by the law mu(I) of Jop, Forterre and Pouliquen (2006), elastic in rate form as
//! [`Hypoelastic`] below yield; integrated after Dunatunga and Kamrin (2015), with the gap of [`soil`].
//!
//! ```text
//! q/sqrt(3) <= mu p,  mu = mu_s + (mu_2 - mu_s)/(I_0/I + 1),  I = |g| d/sqrt(p/rho_s)     |g| = sqrt(2 D_p : D_p)
//! p = -tr(sigma)/3 >= 0,   q = sqrt(3/2 s : s),   s = dev(sigma),   stress is zero where grains are apart
//! ```
//!
//! Flow keeps the volume, so the pressure is that of the elastic step, p*. With S_s = sqrt(3) mu_s p, S_2 = sqrt(3)
//! mu_2 p and A = sqrt(3) G dt I_0 sqrt(p/rho_s)/d, q at the end of a step beyond S_s is the smaller root of
//!
//! ```text
//! q^2 - (S_2 + q* + A) q + S_2 q* + S_s A = 0                                             star: of the elastic step
//! ```
//! The plastic shear strain grows by da = (q* - q)/(3 G), which is |g| dt/sqrt(3), and J q da is dissipated per
//! undeformed volume.

use super::declaration::{BadConstants, Constant, DENSITY, Declared, Given, LENGTH, POSITIVE, RATIO};
use super::soil::{self, equivalent, pressure};
use super::{History, Hypoelastic, Isotropic, Law, Motion, Response, elastic};
use crate::tensor::{Matrix, Number, Symmetric};
use serde::Serialize;

/// Grains that flow densely.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MuI<T> {
    /// The law below yield.
    #[serde(flatten)]
    pub elastic: Hypoelastic<T>,
    /// mu_s, friction of slow flow [-].
    pub static_friction: T,
    /// mu_2, friction that fast flow comes near [-].
    pub limiting_friction: T,
    /// I_0 [-]
    pub inertial_number: T,
    /// d [m]
    pub grain_diameter: T,
    /// rho_s [kg/m^3]
    pub grain_density: T,
}

/// Names of the constants in scene files.
const STATIC_FRICTION: &str = "static_friction";
const LIMITING_FRICTION: &str = "limiting_friction";
const INERTIAL_NUMBER: &str = "inertial_number";
const GRAIN_DIAMETER: &str = "grain_diameter";
const GRAIN_DENSITY: &str = "grain_density";

/// I_0 of glass beads, Jop et al. (2006).
const OF_GLASS_BEADS: f64 = 0.279;

impl Declared for MuI<f64> {
    const SUMMARY: &'static str =
        "Dense flow of dry grains: friction that grows with the rate of shear, mu(I); they come apart.";
    const CONSTANTS: &'static [Constant] = &elastic::and::<5, 10>([
        Constant::required(
            STATIC_FRICTION,
            "Shear stress over pressure where flow begins, mu_s.",
            (RATIO, POSITIVE),
            "0.38",
        ),
        Constant::required(
            LIMITING_FRICTION,
            "Shear stress over pressure that fast flow comes near, mu_2, at least mu_s.",
            (RATIO, POSITIVE),
            "0.64",
        ),
        Constant::optional(
            INERTIAL_NUMBER,
            "Inertial number at which friction is halfway between both, I_0; that of glass beads without it.",
            (RATIO, POSITIVE),
            OF_GLASS_BEADS,
        ),
        Constant::required(GRAIN_DIAMETER, "Diameter of the grains, d.", (LENGTH, POSITIVE), "\"1 mm\""),
        Constant::required(
            GRAIN_DENSITY,
            "Density of the grains themselves, rho_s.",
            (DENSITY, POSITIVE),
            "\"2500 kg/m^3\"",
        ),
    ]);

    fn build(given: &Given) -> Result<Self, BadConstants> {
        let elastic = Isotropic::build(given)?;
        if elastic.shear_modulus == 0.0 {
            return Err(BadConstants::together("G = 0", "G above 0: a fluid has no friction within"));
        }
        let (least, most) = (given.number(STATIC_FRICTION), given.number(LIMITING_FRICTION));
        if most < least {
            let allowed = format!("at least the {STATIC_FRICTION}, {least}");
            return Err(BadConstants::of(LIMITING_FRICTION, most.to_string(), allowed));
        }
        Ok(MuI {
            elastic: Hypoelastic { elastic },
            static_friction: least,
            limiting_friction: most,
            inertial_number: given.number(INERTIAL_NUMBER),
            grain_diameter: given.number(GRAIN_DIAMETER),
            grain_density: given.number(GRAIN_DENSITY),
        })
    }

    fn given(&self) -> Given {
        self.elastic
            .given()
            .with(STATIC_FRICTION, self.static_friction)
            .with(LIMITING_FRICTION, self.limiting_friction)
            .with(INERTIAL_NUMBER, self.inertial_number)
            .with(GRAIN_DIAMETER, self.grain_diameter)
            .with(GRAIN_DENSITY, self.grain_density)
    }

    fn elastic(&self) -> Isotropic<f64> {
        self.elastic.elastic
    }
}

impl<T: Copy> MuI<T> {
    /// The same constants in other numbers.
    #[inline(always)]
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> MuI<U> {
        MuI {
            static_friction: f(self.static_friction),
            limiting_friction: f(self.limiting_friction),
            inertial_number: f(self.inertial_number),
            grain_diameter: f(self.grain_diameter),
            grain_density: f(self.grain_density),
            elastic: self.elastic.map(f),
        }
    }
}

impl<T: Number> Law<T> for MuI<T> {
    /// a, o and D, as of [`super::DruckerPrager`].
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
        let g = self.elastic.elastic.shear_modulus;
        let trial = soil::trial(&self.elastic, motion, opening);
        let deviator = trial.stress.deviator();
        let (q, pressed) = (equivalent(&deviator), pressure(&trial.stress));
        let p = pressed.max(T::ZERO);
        let root = T::of(3f64.sqrt());
        let (least, most) = (root * self.static_friction * p, root * self.limiting_friction * p);
        let inertia = self.inertial_number * (p / self.grain_density).sqrt() / self.grain_diameter;
        let rate = root * g * motion.dt * inertia;
        let beyond = q.max(least);
        let apart = most - beyond + rate;
        let half = most + beyond + rate + (apart * apart + T::of(4.0) * rate * (beyond - least)).sqrt();
        let tiny = T::EPSILON * T::EPSILON * g;
        let flowing = T::of(2.0) * (most * beyond + least * rate) / half.max(tiny);
        let left = q.min(flowing);
        let stress = trial.stress
            - deviator * T::select(left.at_least(q), T::ZERO, T::ONE - left / q.max(tiny))
            + Symmetric::isotropic(pressed - p);
        let flow = (q - left) / (T::of(3.0) * g);
        // The mean of the stress over the step along the flow.
        let past = T::of(1.5) * trial.before.deviator().double_dot(&deviator) / q.max(tiny);
        let lost = lost + (T::HALF * (past + motion.jacobian * left) * flow).max(T::ZERO);
        let opening = soil::opening(&self.elastic, T::ZERO, p - pressed);
        Response { stress, history: [strain + flow, opening, lost] }
    }

    #[inline(always)]
    fn strain_energy(&self, deformation: &Matrix<T>, stress: &Symmetric<T>, _history: &[T; 3]) -> T {
        self.elastic.strain_energy(deformation, stress, &[])
    }

    #[inline(always)]
    fn dissipation(&self, &[_, _, lost]: &[T; 3]) -> T {
        lost
    }

    /// Of the elastic law, at the volume that closing an opening leaves, and more for flow at constant volume while the
    /// whole expands: at most (mu_2 K)^2/(4 G).
    #[inline(always)]
    fn wave_modulus(&self, deformation: &Matrix<T>, jacobian: T, &[_, opening, _]: &[T; 3]) -> T {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic.elastic;
        let apart = self.limiting_friction * k;
        let more = apart * apart / (T::of(4.0) * g);
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

    fn given() -> Given {
        ELASTIC
            .given()
            .with(STATIC_FRICTION, 0.38)
            .with(LIMITING_FRICTION, 0.64)
            .with(GRAIN_DIAMETER, 1e-3)
            .with(GRAIN_DENSITY, 2500.0)
            .with(INERTIAL_NUMBER, OF_GLASS_BEADS)
    }

    fn law(diameter: f64) -> MuI<f64> {
        Declared::build(&given().with(GRAIN_DIAMETER, diameter)).expect("sound constants")
    }

    /// Of slow flow, of flow at the rates of the paths below, and without rate.
    fn laws() -> [MuI<f64>; 4] {
        let even = given().with(LIMITING_FRICTION, 0.38);
        [law(1e-3), law(10.0), law(1e4), Declared::build(&even).expect("sound constants")]
    }

    fn outside(law: &MuI<f64>, state: &State<[f64; 3]>) -> f64 {
        let (p, q) = (state.p(), state.q());
        (q - 3f64.sqrt() * law.limiting_friction * p).max(-p) / (ELASTIC.bulk_modulus + p.abs())
    }

    #[test]
    fn below_yield_it_is_the_elastic_law_and_small_strain_gives_hooke() {
        for law in laws() {
            let under = Symmetric([-120e3, -100e3, -100e3, 0.0, 10e3, 0.0]);
            for h in sample_gradients() {
                let motion = Motion { stress: under, ..motion_of(Matrix::IDENTITY + h * 1e-5) };
                let response = law.respond(&motion, &[0.0; 3]);
                assert_eq!(response.stress, law.elastic.stress(&motion));
                assert_eq!(response.history, [0.0; 3]);
                let pressed = Symmetric::isotropic(-100e3);
                let motion = Motion { stress: pressed, ..motion_of(Matrix::IDENTITY + h * 1e-7) };
                let exact = hooke(&ELASTIC, &(h * 1e-7).symmetric_part()) + pressed;
                let stress = law.respond(&motion, &[0.0; 3]).stress;
                assert!(stress.0.iter().zip(exact.0).all(|(s, e)| (s - e).abs() < 1e-5), "{stress:?}");
            }
            let rest = law.respond(&motion_of(Matrix::IDENTITY), &[0.0; 3]);
            assert_eq!((rest.stress, rest.history), (Symmetric::ZERO, [0.0; 3]));
        }
    }

    /// Sheared at a constant rate and volume: q/(sqrt(3) p) = mu(I) at every rate, from slow to fast, by |g| = 2 de/dt.
    #[test]
    fn steady_shear_has_the_friction_of_its_rate() {
        let law = law(1e-3);
        for rate in [1e-3, 1.0, 30.0, 300.0, 3000.0, 1e5] {
            let p = 10e3;
            let mut state: State<[f64; 3]> = State::under(Symmetric::isotropic(-p));
            state.motion.dt = 1e-4 / rate;
            for _ in 0..400 {
                state = state.moved(&law, along_axes([0.5e-4, -0.5e-4, 0.0]));
            }
            let number = rate * 1e-3 / (p / 2500f64).sqrt();
            let exact = 0.38 + (0.64 - 0.38) / (OF_GLASS_BEADS / number + 1.0);
            let found = state.q() / (3f64.sqrt() * state.p());
            assert!((found / exact - 1.0).abs() < 1e-6, "{rate}: {found} {exact}");
            assert!((state.p() / p - 1.0).abs() < 1e-9);
        }
    }

    /// By slow flow the strength in triaxial compression: q = sqrt(3) mu_s p under a constant pressure at the sides.
    #[test]
    fn slow_flow_has_the_strength_of_a_cone() {
        let slope = 3f64.sqrt() * 0.38;
        let law = law(1e-9);
        let end = pressed(&law, (State::under(Symmetric::isotropic(-100e3)), true), (400, -1e-4), |_| {});
        let exact = slope * 100e3 / (1.0 - slope / 3.0);
        assert!((end.q() / exact - 1.0).abs() < 1e-6, "{} {exact}", end.q());
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
                (q - 3f32.sqrt() * law.limiting_friction * p).max(-p) / (20e6 + p.abs() + q)
            });
        }
    }

    #[test]
    fn it_carries_a_stress_within_the_cone() {
        let material = Material::MuI(law(1e-3));
        assert!(material.carries_stress());
        let borne = Symmetric([-50e3, -50e3, -80e3, 1e3, 0.0, 0.0]);
        assert_eq!(material.stretch_under(&borne), Ok(Symmetric::isotropic(1.0)));
        let not = Symmetric([-50e3, -50e3, -400e3, 0.0, 0.0, 0.0]);
        assert_eq!(material.stretch_under(&not), Err(NoStretch::Yields));
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
        let law = law(1e-3);
        let mut state = State::under(Symmetric::isotropic(-100e3));
        state = state.moved(&law, Matrix::IDENTITY + sample_gradients()[2] * 0.01);
        // In no time, else the flow that the stress drives goes on.
        state.motion.dt = 0.0;
        only_turns(&law, &state);
    }

    #[test]
    fn grains_that_came_apart_close_before_they_press() {
        let law = law(1e-3);
        let mut state = State::under(Symmetric::isotropic(-10e3));
        for _ in 0..100 {
            state = state.moved(&law, along_axes([1e-3; 3]));
        }
        assert_eq!((state.p(), state.q()), (0.0, 0.0));
        for _ in 0..99 {
            state = state.moved(&law, along_axes([-1e-3; 3]));
            assert!(state.p().abs() < 1e-6, "{state:?}");
        }
        state = state.moved(&law, along_axes([-1e-3; 3]));
        assert!((state.p() / 10e3 - 1.0).abs() < 1e-2 && state.history[1].abs() < 1e-12, "{state:?}");
    }

    #[test]
    fn noise_does_not_open_for_good_what_is_pressed() {
        noise_leaves_no_gap(&law(1e-3), ELASTIC.bulk_modulus);
    }

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
        let law = LAWS.iter().find(|law| law.name == "mu_i").expect("a law of the list");
        for (key, value) in [
            (STATIC_FRICTION, 0.0),
            (LIMITING_FRICTION, 0.3),
            (INERTIAL_NUMBER, 0.0),
            (GRAIN_DIAMETER, 0.0),
            (GRAIN_DENSITY, -1.0),
        ] {
            let bad = law.build(&given().with(key, value)).unwrap_err();
            assert_eq!(bad.key.as_deref(), Some(key), "{key} {value}");
        }
        assert!(law.build(&ELASTIC.given()).is_err());
    }
}
