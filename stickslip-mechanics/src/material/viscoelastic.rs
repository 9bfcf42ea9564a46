//! Finite-strain linear viscoelasticity with a Prony series: a neo-Hookean network, part of whose chains let go and
//! join again, after Lubliner (1985) and Simo (1987); Simo and Hughes (1998), chapter 10.
//!
//! ```text
//! g(t)  = 1 - sum_i g_i (1 - exp(-t/tau_i))         shear modulus over the instantaneous one, t after a sudden strain
//! sigma = K/2 (J - 1/J) I + G/J dev(F_ A F_^T),     F_ = J^(-1/3) F,   A = (1 - sum g_i) I + sum g_i A_i
//! tau_i dA_i/dt = C_^-1 - A_i,                      C_ = F_^T F_,      A_i = I - 2 E_i
//! W     = U(J) + G/2 ((1 - sum g_i) (tr C_ - 3) + sum g_i (tr(C_ A_i) - ln det A_i - 3))
//! D     = sum G g_i/(2 tau_i) (tr X_i + tr X_i^-1 - 6) >= 0,   X_i = C_ A_i          dissipated per volume and time
//! ```
//!
//! What a branch remembers is its viscous strain E_i in the undeformed body, so a rotation leaves it alone. Its
//! equation is linear: after a sudden strain of any size, the stress relaxes by the Prony series exactly. Simo relaxes
//! the branches' stresses instead, which gives the same there and at small strain, but no energy that is exact at any;
//! here stored and dissipated energy are, and D is never negative.
//!
//! A step takes C_^-1 as linear in time and the decay as 1/(1 + x + x^2/2), x = dt/tau, which is exp(-x) to second
//! order and needs no exponential:
//!
//! ```text
//! A_i' = (A_i + x/2 C_n^-1 + x/2 (1 + x) C_n+1^-1) / (1 + x + x^2/2)
//! ```
//!
//! All weights are positive and their sum is one, so A_i stays positive definite at any step, and a step of many tau
//! goes to the limit. Volume strain is elastic.

use super::declaration::{
    Absent, AllowedRange, BadConstants, Constant, Declared, Form, Given, POSITIVE, Quantity, RATIO, TIME,
};
use super::history::{put_symmetric, symmetric};
use super::{History, Isotropic, Law, Motion, Response, elastic};
use crate::column::Kind;
use crate::tensor::{Matrix, Number, Symmetric, array};
use serde::{Serialize, Serializer};

/// Most terms of a Prony series.
const MOST_TERMS: usize = 8;
/// Entries of the history: the energy dissipated, and a tensor for each term.
const MOST_ENTRIES: usize = 1 + 6 * MOST_TERMS;
/// Name of the series in scene files.
const PRONY: &str = "prony";

/// What a particle remembers: as many tensors as there are terms.
const HISTORY: [History; 1 + MOST_TERMS] = [
    History::new("viscous_dissipation", "J/m^3", Kind::Number),
    History::new("viscous_strain_1", "", Kind::Symmetric),
    History::new("viscous_strain_2", "", Kind::Symmetric),
    History::new("viscous_strain_3", "", Kind::Symmetric),
    History::new("viscous_strain_4", "", Kind::Symmetric),
    History::new("viscous_strain_5", "", Kind::Symmetric),
    History::new("viscous_strain_6", "", Kind::Symmetric),
    History::new("viscous_strain_7", "", Kind::Symmetric),
    History::new("viscous_strain_8", "", Kind::Symmetric),
];

/// Finite-strain linear viscoelasticity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Viscoelastic<T> {
    /// Moduli against a sudden strain; the bulk modulus does not relax.
    #[serde(flatten)]
    pub elastic: Isotropic<T>,
    /// What relaxes, and how fast.
    pub prony: Prony<T>,
}

/// A Prony series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prony<T> {
    /// g_i, parts of the instantaneous shear modulus [-].
    shares: [T; MOST_TERMS],
    /// tau_i [s].
    times: [T; MOST_TERMS],
    terms: usize,
}

impl Prony<f64> {
    /// The series of these pairs of share [-] and time [s], at most eight.
    pub fn new(pairs: &[[f64; 2]]) -> Self {
        let mut prony = Prony { shares: [0.0; MOST_TERMS], times: [1.0; MOST_TERMS], terms: 0 };
        for &[share, time] in &pairs[..pairs.len().min(MOST_TERMS)] {
            (prony.shares[prony.terms], prony.times[prony.terms]) = (share, time);
            prony.terms += 1;
        }
        prony
    }
}

impl<T: Copy> Prony<T> {
    /// Its pairs of share and time.
    fn pairs(&self) -> impl Iterator<Item = [T; 2]> + '_ {
        (0..self.terms).map(|i| [self.shares[i], self.times[i]])
    }
}

impl<T: Serialize> Serialize for Prony<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq((0..self.terms).map(|i| [&self.shares[i], &self.times[i]]))
    }
}

impl Declared for Viscoelastic<f64> {
    const SUMMARY: &'static str = "Neo-Hookean elasticity whose shear stiffness relaxes by a Prony series, for polymers and gels; \
                                   the elastic constants are those of a sudden strain.";
    const CONSTANTS: &'static [Constant] = &elastic::and::<1, 6>([Constant {
        name: PRONY,
        summary: "What of the shear modulus relaxes and how fast: pairs of share g and time tau, such as [[0.5, \"10 ms\"]].",
        form: Form::Pairs(
            [
                Quantity { name: "share", unit: RATIO, bounds: AllowedRange::between(0.0, 1.0) },
                Quantity { name: "time", unit: TIME, bounds: POSITIVE },
            ],
            MOST_TERMS,
        ),
        absent: Absent::Refused("[[0.5, \"10 ms\"]]"),
    }]);

    fn build(given: &Given) -> Result<Self, BadConstants> {
        let elastic = Isotropic::build(given)?;
        if elastic.shear_modulus == 0.0 {
            return Err(BadConstants::together(
                "G = 0",
                "G above 0: a fluid has no shear stress that relaxes",
            ));
        }
        let prony = Prony::new(given.pairs(PRONY));
        let sum: f64 = prony.pairs().map(|[share, _]| share).sum();
        if sum >= 1.0 {
            return Err(BadConstants::of(
                PRONY,
                format!("shares whose sum is {sum}"),
                "a sum below 1, else nothing is left that keeps the shape",
            ));
        }
        Ok(Viscoelastic { elastic, prony })
    }

    fn given(&self) -> Given {
        let mut given = self.elastic.given();
        given.put(PRONY, self.prony.pairs().flatten().collect());
        given
    }

    fn elastic(&self) -> Isotropic<f64> {
        self.elastic
    }
}

impl<T: Number> Viscoelastic<T> {
    /// The same constants in other numbers.
    #[inline(always)]
    pub fn map<U: Number>(&self, f: impl Fn(T) -> U) -> Viscoelastic<U> {
        let Prony { shares, times, terms } = self.prony;
        let prony =
            Prony { shares: array(U::ZERO, |i| f(shares[i])), times: array(U::ZERO, |i| f(times[i])), terms };
        Viscoelastic { elastic: self.elastic.map(f), prony }
    }

    /// A = (1 - sum g_i) I + sum g_i A_i = I - 2 sum g_i E_i
    #[inline(always)]
    fn network(&self, history: &[T; MOST_ENTRIES]) -> Symmetric<T> {
        let mut network = Symmetric::isotropic(T::ONE);
        for i in 0..self.prony.terms {
            network = network - strain(history, i) * (self.prony.shares[i] + self.prony.shares[i]);
        }
        network
    }
}

/// E_i
#[inline(always)]
fn strain<T: Number>(history: &[T; MOST_ENTRIES], term: usize) -> Symmetric<T> {
    symmetric(history, 1 + 6 * term)
}

/// I - 2 E
#[inline(always)]
fn metric<T: Number>(strain: &Symmetric<T>) -> Symmetric<T> {
    Symmetric::isotropic(T::ONE) - *strain * T::of(2.0)
}

/// (I - C_^-1)/2 of a deformation whose inverse and determinant are known.
#[inline(always)]
fn elastic_strain<T: Number>(inverse: &Matrix<T>, jacobian: T) -> Symmetric<T> {
    let root = jacobian.cbrt();
    let metric = inverse.times_transpose() * (root * root);
    (Symmetric::isotropic(T::ONE) - metric) * T::HALF
}

impl<T: Number> Law<T> for Viscoelastic<T> {
    type History = [T; MOST_ENTRIES];

    #[inline(always)]
    fn history(&self) -> &'static [History] {
        &HISTORY[..1 + self.prony.terms]
    }

    #[inline(always)]
    fn respond(&self, motion: &Motion<T>, history: &[T; MOST_ENTRIES]) -> Response<T, [T; MOST_ENTRIES]> {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic;
        let j = motion.jacobian;
        // F_n^-1 = F^-1 dF, for F = dF F_n.
        let inverse = motion.deformation.inverse();
        let before = elastic_strain(&(inverse * motion.increment), j / motion.increment.det());
        let after = elastic_strain(&inverse, j);
        // C_ in the middle of the step.
        let middle = metric(&((before + after) * T::HALF)).matrix().inverse().symmetric_part();
        let mut next = *history;
        for i in 0..self.prony.terms {
            let x = motion.dt / self.prony.times[i];
            let half = x * T::HALF;
            let past = strain(history, i);
            let sum = past + before * half + after * (half * (T::ONE + x));
            let now = sum * (T::ONE / (half.times_plus(x, T::ONE + x)));
            // -dW/dA : dA, with A = I - 2 E.
            let mean = metric(&((past + now) * T::HALF)).matrix().inverse().symmetric_part();
            let lost = (middle - mean).double_dot(&(now - past)) * (g * self.prony.shares[i]);
            next[0] += lost;
            put_symmetric(&mut next, 1 + 6 * i, &now);
        }
        let network = self.network(&next).rotated(&motion.deformation).deviator();
        let root = j.cbrt();
        let inverse = T::ONE / j;
        let pressure = T::HALF * k * (j - inverse);
        let stress = network * (g * inverse * (root * inverse)) + Symmetric::isotropic(pressure);
        Response { stress, history: next }
    }

    #[inline(always)]
    fn strain_energy(
        &self,
        deformation: &Matrix<T>,
        _stress: &Symmetric<T>,
        history: &[T; MOST_ENTRIES],
    ) -> T {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic;
        let j = deformation.det();
        let root = j.cbrt();
        let right = deformation.transpose().times_transpose() * (T::ONE / (root * root));
        let mut chains = right.double_dot(&self.network(history)) - T::of(3.0);
        for i in 0..self.prony.terms {
            chains -= self.prony.shares[i] * metric(&strain(history, i)).matrix().det().ln();
        }
        T::HALF * k * (T::HALF * (j * j - T::ONE) - j.ln()) + T::HALF * g * chains
    }

    #[inline(always)]
    fn dissipation(&self, history: &[T; MOST_ENTRIES]) -> T {
        history[0]
    }

    /// Of a sudden strain.
    #[inline(always)]
    fn wave_modulus(&self, deformation: &Matrix<T>, jacobian: T, history: &[T; MOST_ENTRIES]) -> T {
        let (k, j) = (self.elastic.bulk_modulus, jacobian);
        let shear = self.shear_modulus(deformation, jacobian, history);
        T::HALF * k * (j * j + T::ONE) + T::of(4.0 / 3.0) * shear
    }

    #[inline(always)]
    fn shear_modulus(&self, deformation: &Matrix<T>, jacobian: T, history: &[T; MOST_ENTRIES]) -> T {
        let root = jacobian.cbrt();
        let b = self.network(history).rotated(deformation).0;
        self.elastic.shear_modulus * (b[0].max(b[1]).max(b[2]) * (root * (T::ONE / jacobian)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::tests::{follow, hooke, motion_of, rotation, sample_gradients};
    use crate::material::{Entries, LAWS, Material, NeoHookean, Thickness};

    const ELASTIC: Isotropic<f64> = Isotropic { bulk_modulus: 6.0, shear_modulus: 3.0 };
    const PAIRS: [[f64; 2]; 2] = [[0.5, 0.3], [0.2, 2.0]];
    const NONE: [f64; MOST_ENTRIES] = <[f64; MOST_ENTRIES]>::ZERO;

    fn law() -> Viscoelastic<f64> {
        Viscoelastic { elastic: ELASTIC, prony: Prony::new(&PAIRS) }
    }

    /// G(t)/G(0)
    fn relaxed(t: f64) -> f64 {
        1.0 - PAIRS.iter().map(|[g, tau]| g * (1.0 - (-t / tau).exp())).sum::<f64>()
    }

    /// The state after this deformation came in one sudden step and was held.
    fn held(f: Matrix<f64>, (steps, duration): (usize, f64)) -> (Motion<f64>, [f64; MOST_ENTRIES]) {
        let sudden = Motion { dt: 0.0, ..motion_of(f) };
        let mut answer = law().respond(&sudden, &NONE);
        let rest = Motion { increment: Matrix::IDENTITY, dt: duration / steps as f64, ..sudden };
        for _ in 0..steps {
            answer = law().respond(&Motion { stress: answer.stress, ..rest }, &answer.history);
        }
        (Motion { stress: answer.stress, ..rest }, answer.history)
    }

    #[test]
    fn a_sudden_strain_is_neo_hookean_and_a_small_one_hookes() {
        for h in sample_gradients() {
            let (state, _) = held(Matrix::IDENTITY + h, (0, 0.0));
            let exact = NeoHookean { elastic: ELASTIC }.stress(&motion_of(Matrix::IDENTITY + h));
            assert!(state.stress.0.iter().zip(exact.0).all(|(s, e)| (s - e).abs() < 1e-13));
            let (state, _) = held(Matrix::IDENTITY + h * 1e-6, (0, 0.0));
            let exact = hooke(&ELASTIC, &(h * 1e-6).symmetric_part());
            assert!(state.stress.0.iter().zip(exact.0).all(|(s, e)| (s - e).abs() < 1e-10));
        }
    }

    /// Relaxation after a sudden strain of any size: the deviator follows the Prony series,
    /// and halving the step quarters the error.
    #[test]
    fn stress_relaxes_by_the_prony_series_to_second_order() {
        for h in sample_gradients() {
            let f = Matrix::IDENTITY + h;
            let sudden = NeoHookean { elastic: ELASTIC }.stress(&motion_of(f)).deviator();
            let error = |steps: usize| {
                let (state, _) = held(f, (steps, 1.0));
                let off = state.stress.deviator() - sudden * relaxed(1.0);
                (off.double_dot(&off) / sudden.double_dot(&sudden)).sqrt()
            };
            let errors = [20, 40, 80].map(error);
            let order = (errors[1] / errors[2]).log2();
            assert!(errors[2] < 2e-4 && (order - 2.0).abs() < 0.1, "{errors:?}, order {order}");
        }
    }

    /// A small strain grows evenly for a second: sigma_xy = 2 G gamma' integral of g(t).
    #[test]
    fn a_growing_small_strain_gives_the_integral_of_the_series_to_second_order() {
        let gamma = 1e-6;
        let exact = ELASTIC.shear_modulus
            * gamma
            * (1.0 - PAIRS.iter().map(|[g, tau]| g * (1.0 - tau * (1.0 - (-1.0 / tau).exp()))).sum::<f64>());
        let shear = |t: f64| Matrix([[1.0, gamma * t, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        let error = |steps| (follow(&law(), (steps, 1.0), shear).0.stress.0[3] / exact - 1.0).abs();
        let errors = [20, 40, 80].map(error);
        let order = (errors[1] / errors[2]).log2();
        assert!(errors[2] < 1e-4 && (order - 2.0).abs() < 0.1, "{errors:?}, order {order}");
    }

    #[test]
    fn a_step_of_any_length_is_stable_and_long_ones_find_the_limit() {
        let f = Matrix::IDENTITY + sample_gradients()[2];
        let sudden = NeoHookean { elastic: ELASTIC }.stress(&motion_of(f)).deviator();
        for duration in [1e3, 1e6, 1e9] {
            let (state, history) = held(f, (2, duration));
            let off = state.stress.deviator() - sudden * relaxed(1e9);
            assert!(off.0.iter().all(|x| x.abs() < 1e-3), "{duration}: {off:?}");
            assert!(history[0] > 0.0);
        }
    }

    #[test]
    fn rotation_rotates_the_stress_and_leaves_the_history_alone() {
        let q = rotation();
        let (before, history) = held(Matrix::IDENTITY + sample_gradients()[2], (10, 0.5));
        let motion = Motion { deformation: q * before.deformation, increment: q, dt: 0.0, ..before };
        let after = law().respond(&motion, &history);
        let expected = before.stress.rotated(&q);
        assert!(after.stress.0.iter().zip(expected.0).all(|(s, e)| (s - e).abs() < 1e-13));
        assert!(after.history.iter().zip(history).all(|(a, b)| (a - b).abs() < 1e-14));
    }

    /// The work of a strain to and fro, large, and as fast as the chains are: stored or dissipated, to second order.
    #[test]
    fn the_work_is_stored_or_dissipated() {
        for h in sample_gradients() {
            let path = |t: f64| Matrix::IDENTITY + h * (2.5 * t).sin();
            let error = |steps| {
                let (end, history, work) = follow(&law(), (steps, 1.5), path);
                let stored = law().strain_energy(&end.deformation, &end.stress, &history);
                let lost = law().dissipation(&history);
                assert!(lost > 0.0 && stored > 0.0);
                ((stored + lost) / work - 1.0).abs()
            };
            let errors = [100, 200, 400].map(error);
            assert!(errors[2] < 2e-5, "{errors:?}");
            assert!((errors[1] / errors[2]).log2() > 1.8, "{errors:?}");
        }
    }

    /// A thin plate under a sudden small strain that is held: sigma_xx = E(t)/(1 - nu(t)^2) e with the moduli of K and
    /// G g(t), for both the strain in the plane and the stress out of it are given at all times.
    #[test]
    fn a_thin_plate_relaxes_with_a_free_thickness() {
        struct Memory(Vec<f64>);
        impl crate::material::Recall<f64> for Memory {
            const DIMENSION: usize = 2;
            fn recall(&self, entry: usize) -> f64 {
                self.0[entry]
            }
        }
        impl crate::material::Keep<f64> for Memory {
            fn keep(&mut self, entry: usize, value: f64) {
                self.0[entry] = value;
            }
        }
        let material = Material::Viscoelastic(law());
        let mut memory = Memory(vec![0.0; 1 + 4 * PAIRS.len()]);
        let e = 1e-5;
        let f = Matrix([[1.0 + e, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        let sudden = Motion { dt: 0.0, ..motion_of(f) };
        let (mut now, mut stress) =
            material.respond_with(Thickness::Free, sudden, &mut memory).expect("a stable law");
        let plate = |g: f64| {
            let moduli = Isotropic { shear_modulus: g, ..ELASTIC };
            moduli.young_modulus() / (1.0 - moduli.poisson_ratio().powi(2))
        };
        assert!((stress.0[0] / (plate(ELASTIC.shear_modulus) * e) - 1.0).abs() < 1e-4);
        for _ in 0..20_000 {
            let next = Motion { increment: Matrix::IDENTITY, dt: 1e-3, stress, ..now };
            (now, stress) = material.respond_with(Thickness::Free, next, &mut memory).expect("a stable law");
        }
        let exact = plate(ELASTIC.shear_modulus * relaxed(20.0)) * e;
        assert!((stress.0[0] / exact - 1.0).abs() < 1e-3, "{} {exact}", stress.0[0]);
    }

    #[test]
    fn constants_that_make_no_material_are_refused() {
        let description = LAWS.iter().find(|law| law.name == "viscoelastic").expect("a law of the list");
        let with = |pairs: &[f64]| {
            let mut given = ELASTIC.given();
            given.put(PRONY, pairs.to_vec());
            description.build(&given)
        };
        assert_eq!(with(&[0.5, 0.3]).unwrap().history().len(), 2);
        for (pairs, found) in [
            (&[0.5, -1.0][..], "time -1 s"),
            (&[1.5, 1.0], "share 1.5"),
            (&[0.5, 1.0, 0.5, 2.0], "shares whose sum is 1"),
            (&[], "0 pairs"),
            (&[0.01; 18], "9 pairs"),
        ] {
            let bad = with(pairs).unwrap_err();
            assert_eq!((bad.key.as_deref(), &bad.found[..]), (Some(PRONY), found));
        }
    }
}
