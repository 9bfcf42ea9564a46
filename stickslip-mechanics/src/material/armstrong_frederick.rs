//! Elastoplasticity of von Mises whose yield surface moves (Armstrong and Frederick 1966; Lemaitre and Chaboche 1990,
//! section 5.4): kinematic hardening that saturates; elasticity in rate form, [`Hypoelastic`], and a radial return.
//!
//! ```text
//! q(J s - X) <= Y,   q(A) = sqrt(3/2 A : A),   s = dev(sigma),   Y = Y_0 + H a        a: equivalent plastic strain
//! dX    = 2/3 C de_p - g X da + dW X - X dW                                           X: back stress, of the Kirchhoff stress
//! bar:  |sigma - X| = Y,   X -> C/g (1 - exp(-g a)) in tension, and less by as much in compression after it
//! W     = Hooke's + 3/(4 C) X : X
//! D     = integral of (Y + 3 g/(2 C) X : X) da                                        dissipated per undeformed volume
//! ```
//!
//! A step is implicit: with r = 1/(1 + g x), T = J s* of the elastic step, and A = T - r X,
//!
//! ```text
//! q(A) = 3 G J x + C r x + Y_0 + H (a + x),   sigma = sigma* - 3 G x A/q(A),   X' = r (X + C x A/q(A))
//! ```
//! Since X is never above C/g, the right side grows by more than the left: there is one root, and none above
//! (q(A_0) - Y)/(3 G J + H). Newton's method goes from there, halving the bracket where it would leave it.

use super::declaration::{BadConstants, Constant, Declared, Given, NOT_NEGATIVE, POSITIVE, PRESSURE, RATIO};
use super::history::{put_symmetric, symmetric};
use super::{History, Hypoelastic, Isotropic, Law, Motion, Response, elastic};
use crate::column::Kind;
use crate::tensor::{Matrix, Number, Symmetric};
use serde::Serialize;

/// Elastoplasticity with kinematic hardening.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ArmstrongFrederick<T> {
    /// The law below yield.
    #[serde(flatten)]
    pub elastic: Hypoelastic<T>,
    /// Y_0, half of the width of the elastic range in uniaxial stress before any flow [Pa].
    pub yield_stress: T,
    /// C, growth of the back stress by plastic strain [Pa].
    pub kinematic_modulus: T,
    /// g, how fast it saturates [-].
    pub dynamic_recovery: T,
    /// H, growth of the yield stress by equivalent plastic strain [Pa].
    pub hardening_modulus: T,
}

/// Names of the constants in scene files.
const YIELD_STRESS: &str = "yield_stress";
const KINEMATIC_MODULUS: &str = "kinematic_modulus";
const DYNAMIC_RECOVERY: &str = "dynamic_recovery";
const HARDENING_MODULUS: &str = "hardening_modulus";

/// What a particle remembers.
const HISTORY: [History; 3] = [
    History::new("plastic_strain", "", Kind::Number),
    History::new("plastic_dissipation", "J/m^3", Kind::Number),
    History::new("back_stress", "Pa", Kind::Symmetric),
];
/// Entries of it, and where the back stress begins.
const ENTRIES: usize = 8;
const BACK_STRESS: usize = 2;

/// Newton's steps.
const TRIALS: usize = 7;

impl Declared for ArmstrongFrederick<f64> {
    const SUMMARY: &'static str =
        "Plastic flow with kinematic hardening that saturates, for metals that are loaded to and fro.";
    const CONSTANTS: &'static [Constant] = &elastic::and::<4, 9>([
        Constant::required(
            YIELD_STRESS,
            "Yield stress in uniaxial tension before any flow, Y_0.",
            (PRESSURE, POSITIVE),
            "\"100 MPa\"",
        ),
        Constant::required(
            KINEMATIC_MODULUS,
            "Growth of the back stress by plastic strain, C.",
            (PRESSURE, POSITIVE),
            "\"20 GPa\"",
        ),
        Constant::optional(
            DYNAMIC_RECOVERY,
            "How fast the back stress saturates, at C over this; without it, it never does (Prager).",
            (RATIO, NOT_NEGATIVE),
            0.0,
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
        Ok(ArmstrongFrederick {
            elastic: Hypoelastic { elastic },
            yield_stress: given.number(YIELD_STRESS),
            kinematic_modulus: given.number(KINEMATIC_MODULUS),
            dynamic_recovery: given.number(DYNAMIC_RECOVERY),
            hardening_modulus: given.number(HARDENING_MODULUS),
        })
    }

    fn given(&self) -> Given {
        self.elastic
            .given()
            .with(YIELD_STRESS, self.yield_stress)
            .with(KINEMATIC_MODULUS, self.kinematic_modulus)
            .with(DYNAMIC_RECOVERY, self.dynamic_recovery)
            .with(HARDENING_MODULUS, self.hardening_modulus)
    }

    fn elastic(&self) -> Isotropic<f64> {
        self.elastic.elastic
    }
}

impl<T: Copy> ArmstrongFrederick<T> {
    /// The same constants in other numbers.
    #[inline(always)]
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> ArmstrongFrederick<U> {
        ArmstrongFrederick {
            yield_stress: f(self.yield_stress),
            kinematic_modulus: f(self.kinematic_modulus),
            dynamic_recovery: f(self.dynamic_recovery),
            hardening_modulus: f(self.hardening_modulus),
            elastic: Hypoelastic { elastic: self.elastic.elastic.map(f) },
        }
    }
}

/// A step before its flow.
struct Trial<T> {
    /// 3/2 of T : T, T : X and X : X [Pa^2]
    products: [T; 3],
    /// 3 G J [Pa]
    stiffness: T,
    /// Y before it [Pa]
    allowed: T,
}

impl<T: Number> ArmstrongFrederick<T> {
    /// x, and q(A).
    #[inline(always)]
    fn flow(&self, trial: &Trial<T>) -> [T; 2] {
        let (c, g, h) = (self.kinematic_modulus, self.dynamic_recovery, self.hardening_modulus);
        let [tt, tx, xx] = trial.products;
        let least = T::EPSILON * self.yield_stress;
        // r and q(A)
        let state = |x: T| {
            let r = T::ONE / (T::ONE + g * x);
            let square = tt - (r + r) * tx + r * r * xx;
            [r, square.max(T::ZERO).sqrt().max(least)]
        };
        let linear = trial.stiffness + h;
        let excess = (state(T::ZERO)[1] - trial.allowed).max(T::ZERO);
        let (mut low, mut high) = (T::ZERO, excess / linear);
        let mut x = high;
        for _ in 0..TRIALS {
            let [r, q] = state(x);
            let off = q - linear * x - c * r * x - trial.allowed;
            let short = off.at_least(T::ZERO);
            low = T::select(short, x, low);
            high = T::select(short, high, x);
            // dA/dx = g r^2 X
            let slope = linear + c * r * r - g * r * r * (tx - r * xx) / q;
            let newton = x + off / slope;
            let inside = newton.at_least(low) & high.at_least(newton);
            x = T::select(inside, newton, T::HALF * (low + high));
        }
        let x = T::select(T::ZERO.at_least(excess), T::ZERO, x);
        [x, state(x)[1]]
    }
}

impl<T: Number> Law<T> for ArmstrongFrederick<T> {
    type History = [T; ENTRIES];

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
    fn respond(&self, motion: &Motion<T>, history: &[T; ENTRIES]) -> Response<T, [T; ENTRIES]> {
        let (c, j) = (self.kinematic_modulus, motion.jacobian);
        let three_g = T::of(3.0) * self.elastic.elastic.shear_modulus;
        let trial = self.elastic.stress(motion);
        let turning = Hypoelastic { elastic: Isotropic { bulk_modulus: T::ZERO, shear_modulus: T::ZERO } };
        let back = turning.stress(&Motion { stress: symmetric(history, BACK_STRESS), ..*motion });
        let kirchhoff = trial.deviator() * j;
        let allowed = self.yield_stress + self.hardening_modulus * history[0];
        let products =
            [kirchhoff.double_dot(&kirchhoff), kirchhoff.double_dot(&back), back.double_dot(&back)]
                .map(|product| T::of(1.5) * product);
        let [x, q] = self.flow(&Trial { products, stiffness: three_g * j, allowed });
        let r = T::ONE / (T::ONE + self.dynamic_recovery * x);
        let direction = (kirchhoff - back * r) * (T::ONE / q);
        let moved = (back + direction * (c * x)) * r;
        let recovered = T::of(1.5) * self.dynamic_recovery / c * moved.double_dot(&moved);
        let mut next = *history;
        next[0] += x;
        next[1] += (allowed + T::HALF * self.hardening_modulus * x + recovered) * x;
        put_symmetric(&mut next, BACK_STRESS, &moved);
        Response { stress: trial - direction * (three_g * x), history: next }
    }

    #[inline(always)]
    fn strain_energy(&self, deformation: &Matrix<T>, stress: &Symmetric<T>, history: &[T; ENTRIES]) -> T {
        let back = symmetric(history, BACK_STRESS);
        self.elastic.strain_energy(deformation, stress, &[])
            + T::of(0.75) * back.double_dot(&back) / self.kinematic_modulus
    }

    #[inline(always)]
    fn dissipation(&self, history: &[T; ENTRIES]) -> T {
        history[1]
    }

    #[inline(always)]
    fn wave_modulus(&self, deformation: &Matrix<T>, jacobian: T, _history: &[T; ENTRIES]) -> T {
        self.elastic.wave_modulus(deformation, jacobian, &[])
    }

    #[inline(always)]
    fn shear_modulus(&self, deformation: &Matrix<T>, jacobian: T, _history: &[T; ENTRIES]) -> T {
        self.elastic.shear_modulus(deformation, jacobian, &[])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::tests::{follow, motion_of, rotation, sample_gradients};
    use crate::material::trials::{
        Chance, answers_are_numbers, lanes_know_nothing_of_each_other, plates_have_a_thickness,
    };
    use crate::material::{LAWS, VonMises};

    const LAW: ArmstrongFrederick<f64> = ArmstrongFrederick {
        elastic: Hypoelastic { elastic: Isotropic { bulk_modulus: 6000.0, shear_modulus: 3000.0 } },
        yield_stress: 0.9,
        kinematic_modulus: 60.0,
        dynamic_recovery: 50.0,
        hardening_modulus: 0.0,
    };
    const NONE: [f64; ENTRIES] = [0.0; ENTRIES];

    fn equivalent(tensor: &Symmetric<f64>) -> f64 {
        let s = tensor.deviator();
        (1.5 * s.double_dot(&s)).sqrt()
    }

    /// A bar that keeps its volume, by its logarithmic strain; its deviator is that of a bar with free sides.
    fn bar(strain: f64) -> Matrix<f64> {
        let (along, across) = (strain.exp(), (-0.5 * strain).exp());
        Matrix([[along, 0.0, 0.0], [0.0, across, 0.0], [0.0, 0.0, across]])
    }

    /// Stress of that bar if its sides were free.
    fn along(stress: &Symmetric<f64>) -> f64 {
        stress.0[0] - stress.0[1]
    }

    #[test]
    fn below_yield_it_is_the_elastic_law() {
        for h in sample_gradients() {
            let motion = motion_of(Matrix::IDENTITY + h * 1e-4);
            let response = LAW.respond(&motion, &NONE);
            assert_eq!((response.stress, response.history), (LAW.elastic.stress(&motion), NONE));
        }
    }

    /// sigma = Y_0 + C/g (1 - exp(-g a)).
    #[test]
    fn a_bar_in_tension_saturates_by_the_exponential() {
        for strain in [1e-3f64, 0.01, 0.05, 0.2] {
            let (end, history, _) = follow(&LAW, (4000, 1.0), |t| bar(strain * t));
            let exact = LAW.yield_stress + 60.0 / 50.0 * (1.0 - (-50.0 * history[0]).exp());
            assert!(
                (along(&end.stress) / exact - 1.0).abs() < 1e-3,
                "{strain}: {} {exact}",
                along(&end.stress)
            );
        }
    }

    /// After tension it yields in compression where the stress has fallen by 2 Y_0 (Bauschinger 1881).
    #[test]
    fn what_was_stretched_yields_early_when_it_is_pressed() {
        let (before, history, _) = follow(&LAW, (400, 1.0), |t| bar(0.05 * t));
        let three_g = 3.0 * LAW.elastic.elastic.shear_modulus;
        for (share, flows) in [(0.999, false), (1.001, true)] {
            let increment = bar(-2.0 * LAW.yield_stress / three_g * share);
            let deformation = increment * before.deformation;
            let after = LAW.respond(&Motion { deformation, increment, ..before }, &history);
            assert_eq!(after.history[0] > history[0], flows, "{share}");
        }
    }

    /// A loop that has settled: the stress amplitude is Y_0 + C/g tanh(g w/2), with the plastic strain's width w.
    #[test]
    fn a_settled_loop_is_that_of_lemaitre_and_chaboche() {
        // To and fro by straight lines, from the middle; a half loop for each whole number.
        let after = |halves: f64| {
            let path = |t: f64| {
                let place = (halves * t + 0.5) % 2.0;
                bar(0.01 * if place < 1.0 { 2.0 * place - 1.0 } else { 3.0 - 2.0 * place })
            };
            follow(&LAW, (2000 * halves.ceil() as usize, 1.0), path)
        };
        let (end, last, _) = after(20.5);
        let (_, before, _) = after(19.5);
        let width = last[0] - before[0];
        let exact = LAW.yield_stress + 60.0 / 50.0 * (0.5 * 50.0 * width).tanh();
        assert!((width / 0.02 - 1.0).abs() < 0.1, "{width}");
        assert!((along(&end.stress).abs() / exact - 1.0).abs() < 2e-3, "{} {exact}", along(&end.stress));
    }

    #[test]
    fn with_a_small_kinematic_modulus_it_is_von_mises() {
        let law = ArmstrongFrederick { kinematic_modulus: 1e-9, hardening_modulus: 3.0, ..LAW };
        let mises = VonMises {
            elastic: LAW.elastic,
            yield_stress: 0.9,
            hardening_modulus: 3.0,
            hardening: None,
            rate: None,
        };
        for h in sample_gradients() {
            let path = |t: f64| Matrix::IDENTITY + h * t;
            let (end, history, _) = follow(&law, (50, 1.0), path);
            let (exact, [strain, _], _) = follow(&mises, (50, 1.0), path);
            assert!((history[0] / strain - 1.0).abs() < 1e-8);
            assert!(end.stress.0.iter().zip(exact.stress.0).all(|(s, e)| (s - e).abs() < 1e-8));
        }
    }

    /// A step's equation holds to round-off, in 100,000 steps of moduli over decades and back stresses in any direction.
    #[test]
    fn seven_trials_solve_every_step() {
        let mut chance = Chance(5);
        for _ in 0..100_000 {
            let mut decade = |least: f64, most: f64| 10f64.powf(least + (most - least) * chance.number());
            let law = ArmstrongFrederick {
                kinematic_modulus: decade(-2.0, 4.0),
                dynamic_recovery: decade(0.0, 3.5),
                ..LAW
            };
            let size = decade(-3.0, 2.0);
            let most = law.kinematic_modulus / law.dynamic_recovery;
            let back = chance.matrix().symmetric_part().deviator();
            let back = back * (most * chance.number() / equivalent(&back));
            let kirchhoff = back + chance.matrix().symmetric_part().deviator() * size;
            let products = [(kirchhoff, kirchhoff), (kirchhoff, back), (back, back)]
                .map(|(a, b)| 1.5 * a.double_dot(&b));
            let trial = Trial { products, stiffness: 9000.0, allowed: 0.9 };
            let [x, q] = law.flow(&trial);
            let r = 1.0 / (1.0 + law.dynamic_recovery * x);
            let off = q - (9000.0 + law.kinematic_modulus * r) * x - 0.9;
            assert!(x >= 0.0 && (x == 0.0 || off.abs() < 1e-9 * (q + most)), "{off} {law:?} {products:?}");
        }
    }

    #[test]
    fn the_work_is_stored_or_dissipated() {
        for h in sample_gradients() {
            let motion = |t: f64| {
                let f = Matrix::IDENTITY + h * (4.0 * t).sin();
                f * ((1.0 + 1e-4 * t) / f.det().cbrt())
            };
            let (end, history, work) = follow(&LAW, (8000, 1.0), motion);
            let stored = LAW.strain_energy(&end.deformation, &end.stress, &history);
            let dissipated = LAW.dissipation(&history);
            assert!(dissipated > 0.8 * work, "{dissipated} of {work}");
            assert!(((stored + dissipated) / work - 1.0).abs() < 2e-3, "{stored} + {dissipated}, {work}");
        }
    }

    #[test]
    fn a_step_of_rotation_only_rotates_the_stress_and_the_back_stress() {
        let (before, history, _) = follow(&LAW, (50, 1.0), |t| Matrix::IDENTITY + sample_gradients()[2] * t);
        let q = rotation();
        let motion = Motion { deformation: q * before.deformation, increment: q, ..before };
        let after = LAW.respond(&motion, &history);
        let turned = |tensor: &Symmetric<f64>, from: &Symmetric<f64>| {
            tensor.0.iter().zip(from.rotated(&q).0).all(|(s, e)| (s - e).abs() < 1e-11)
        };
        assert!(turned(&after.stress, &before.stress));
        assert!(turned(&symmetric(&after.history, BACK_STRESS), &symmetric(&history, BACK_STRESS)));
        assert!((after.history[0] - history[0]).abs() < 1e-12);
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
        answers_are_numbers(&ArmstrongFrederick { dynamic_recovery: 0.0, ..LAW }, 20_000);
    }

    #[test]
    fn constants_that_make_no_material_are_refused() {
        let law = LAWS.iter().find(|law| law.name == "armstrong_frederick").expect("a law of the list");
        let with = |key: &str, value: f64| {
            let all = [
                ("bulk_modulus", 6.0),
                ("shear_modulus", 3.0),
                (YIELD_STRESS, 1.0),
                (KINEMATIC_MODULUS, 1.0),
            ];
            law.build(&Given::from(all).with(key, value))
        };
        assert!(with(DYNAMIC_RECOVERY, 0.0).is_ok());
        for (key, value) in [
            (YIELD_STRESS, 0.0),
            (KINEMATIC_MODULUS, 0.0),
            (DYNAMIC_RECOVERY, -1.0),
            (HARDENING_MODULUS, -1.0),
        ] {
            assert_eq!(with(key, value).unwrap_err().key.as_deref(), Some(key));
        }
        assert_eq!(with("shear_modulus", 0.0).unwrap_err().found, "G = 0");
    }
}
