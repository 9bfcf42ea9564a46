//! Metal and polymer foam that is crushed: the isotropic law of Deshpande and Fleck (2000), with the hardening of Reyes
//! et al. (2003); elasticity in rate form, [`Hypoelastic`], and an implicit return to the ellipse.
//!
//! ```text
//! S <= Y,   S^2 = A q^2 + B p^2,   A = 2 (1 + nu)/3,   B = 3 (1 - 2 nu)                  nu: plastic Poisson's ratio
//! p = -tr(sigma)/3,   q = sqrt(3/2 s : s),   s = dev(sigma)
//! Y = Y_0 + H a - R ln(1 - (a/a_D)^b)                                                 a: equivalent plastic strain
//! flow along the normal: in shear da A q/S, in compaction da B p/S
//! ```
//! In their form S^2 = (q^2 + alpha^2 p^2)/(1 + (alpha/3)^2) with alpha^2 = 9 (1 - 2 nu)/(2 (1 + nu)), and Reyes' gamma
//! is H a_D. In uniaxial stress S is its magnitude, a the plastic part of the logarithmic strain, and nu the strain
//! across over it. The true stress is bounded, as a foam with nu = 0 keeps its section: then Y is also force over the
//! section at the start. It flows and hardens in tension as in compression.
//!
//! A step ends at q = q*/(1 + 3 G A t) and p = p*/(1 + K B t) of the elastic step's q* and p*, with the t >= 0 that
//! solves
//!
//! ```text
//! S(t) = Y(a + t S(t)),   t <= (S*/Y - 1)/min(3 G A, K B)
//! ```
//! S falls by t and t S grows, so there is one root. Newton's method on Y/S - 1, which is straight without hardening
//! where one of q and p is zero, goes there from t = 0, and halves the bracket where it would leave it. Where
//! 1 - (a/a_D)^b is below 1e-4, Y goes on as a straight line: foam so dense is all but elastic.
//!
//! ```text
//! D = integral of J (Y da + w B p/S da)                                               dissipated by undeformed volume
//! ```
//! with the elastic energy w by volume: what is compacted under a stress has less volume to store it.

use super::declaration::{
    Absent, AllowedRange, BadConstants, Constant, Declared, End, Form, Given, NOT_NEGATIVE, POSITIVE,
    PRESSURE, Quantity, RATIO,
};
use super::{History, Hypoelastic, Isotropic, Law, Motion, Response, elastic};
use crate::column::Kind;
use crate::tensor::{Matrix, Number, Symmetric};
use serde::Serialize;

/// Foam that is crushed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CrushableFoam<T> {
    /// The law below yield.
    #[serde(flatten)]
    pub elastic: Hypoelastic<T>,
    /// Y_0, yield stress in uniaxial stress before any flow [Pa].
    pub plateau_stress: T,
    /// nu [-]
    pub plastic_poisson_ratio: T,
    /// H, growth of the yield stress by equivalent plastic strain [Pa].
    pub hardening_modulus: T,
    /// What happens as the pores close.
    #[serde(flatten)]
    pub densification: Option<Densification<T>>,
}

/// Hardening as the pores close.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Densification<T> {
    /// a_D, logarithmic strain at which no pores are left [-].
    pub densification_strain: T,
    /// R [Pa]
    pub densification_stress: T,
    /// b [-]
    pub densification_exponent: T,
    /// a/a_D from which on Y is a straight line.
    #[serde(skip)]
    dense: T,
}

/// Names of the constants in scene files.
const PLATEAU_STRESS: &str = "plateau_stress";
const PLASTIC_POISSON_RATIO: &str = "plastic_poisson_ratio";
const HARDENING_MODULUS: &str = "hardening_modulus";
const DENSIFICATION_STRAIN: &str = "densification_strain";
const DENSIFICATION_STRESS: &str = "densification_stress";
const DENSIFICATION_EXPONENT: &str = "densification_exponent";

/// What a particle remembers.
const HISTORY: [History; 2] = [
    History::new("plastic_strain", "", Kind::Number),
    History::new("plastic_dissipation", "J/m^3", Kind::Number),
];

/// Trials of a step at most; most take two to five.
const MOST_TRIALS: usize = 60;
/// From which trial on every fourth one halves the bracket.
const PATIENCE: usize = 10;
/// 1 - (a/a_D)^b at least.
const LEAST_LEFT: f64 = 1e-4;
/// What has a power at least.
const LEAST: f64 = 1e-30;

const STABLE: AllowedRange =
    AllowedRange::between(-1.0, 0.5).because(", for at 0.5 nothing is compacted: von_mises");
const EXPONENTS: AllowedRange = AllowedRange {
    from: End::At(1.0),
    to: End::At(100.0),
    because: ", for below 1 hardening would begin without end",
};

/// A constant of densification.
const fn dense(name: &'static str, summary: &'static str, quantity: Quantity) -> Constant {
    Constant { name, summary, form: Form::Number(quantity), absent: Absent::Judged }
}

impl Declared for CrushableFoam<f64> {
    const SUMMARY: &'static str = "Foam that flows at a plateau stress as its pores collapse, and hardens as they \
                                   close, after Deshpande and Fleck.";
    const CONSTANTS: &'static [Constant] = &elastic::and::<6, 11>([
        Constant::required(
            PLATEAU_STRESS,
            "Yield stress in uniaxial stress before any flow, Y_0.",
            (PRESSURE, POSITIVE),
            "\"2 MPa\"",
        ),
        Constant::optional(
            PLASTIC_POISSON_RATIO,
            "Plastic strain across over that along uniaxial stress, nu; 0 without it.",
            (RATIO, STABLE),
            0.0,
        ),
        Constant::optional(
            HARDENING_MODULUS,
            "Growth of the yield stress by equivalent plastic strain, H; none without it.",
            (PRESSURE, NOT_NEGATIVE.because(", for softening would follow the grid")),
            0.0,
        ),
        dense(
            DENSIFICATION_STRAIN,
            "Logarithmic strain in uniaxial compression at which no pores are left, a_D; without it they never close.",
            Quantity { name: DENSIFICATION_STRAIN, unit: RATIO, bounds: POSITIVE },
        ),
        dense(
            DENSIFICATION_STRESS,
            "Factor R of the hardening -R ln(1 - (a/a_D)^b).",
            Quantity { name: DENSIFICATION_STRESS, unit: PRESSURE, bounds: POSITIVE },
        ),
        dense(
            DENSIFICATION_EXPONENT,
            "Exponent b in it.",
            Quantity { name: DENSIFICATION_EXPONENT, unit: RATIO, bounds: EXPONENTS },
        ),
    ]);

    fn build(given: &Given) -> Result<Self, BadConstants> {
        let elastic = Isotropic::build(given)?;
        if elastic.shear_modulus == 0.0 {
            return Err(BadConstants::together("G = 0", "G above 0: a fluid has nothing that yields"));
        }
        Ok(CrushableFoam {
            elastic: Hypoelastic { elastic },
            plateau_stress: given.number(PLATEAU_STRESS),
            plastic_poisson_ratio: given.number(PLASTIC_POISSON_RATIO),
            hardening_modulus: given.number(HARDENING_MODULUS),
            densification: Densification::build(given)?,
        })
    }

    fn given(&self) -> Given {
        let given = self
            .elastic
            .given()
            .with(PLATEAU_STRESS, self.plateau_stress)
            .with(PLASTIC_POISSON_RATIO, self.plastic_poisson_ratio)
            .with(HARDENING_MODULUS, self.hardening_modulus);
        match self.densification {
            None => given,
            Some(dense) => given
                .with(DENSIFICATION_STRAIN, dense.densification_strain)
                .with(DENSIFICATION_STRESS, dense.densification_stress)
                .with(DENSIFICATION_EXPONENT, dense.densification_exponent),
        }
    }

    fn elastic(&self) -> Isotropic<f64> {
        self.elastic.elastic
    }
}

impl Densification<f64> {
    /// By a_D [-], R [Pa] and b [-].
    pub fn new(strain: f64, stress: f64, exponent: f64) -> Self {
        Densification {
            densification_strain: strain,
            densification_stress: stress,
            densification_exponent: exponent,
            dense: libm::pow(1.0 - LEAST_LEFT, 1.0 / exponent),
        }
    }

    /// All three, or nothing.
    fn build(given: &Given) -> Result<Option<Self>, BadConstants> {
        let all = [DENSIFICATION_STRAIN, DENSIFICATION_STRESS, DENSIFICATION_EXPONENT];
        if let [Some(strain), Some(stress), Some(exponent)] = all.map(|key| given.get(key)) {
            return Ok(Some(Densification::new(strain, stress, exponent)));
        }
        let Some((key, value)) = all.into_iter().find_map(|key| Some((key, given.get(key)?))) else {
            return Ok(None);
        };
        let missing = all.into_iter().find(|other| given.get(other).is_none()).expect("one is missing");
        let found = format!("{value}, but no {missing}");
        Err(BadConstants::of(key, found, format!("{} together, or none", all.join(", "))))
    }
}

impl<T: Copy> CrushableFoam<T> {
    /// The same constants in other numbers.
    #[inline(always)]
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> CrushableFoam<U> {
        CrushableFoam {
            elastic: Hypoelastic { elastic: self.elastic.elastic.map(&f) },
            plateau_stress: f(self.plateau_stress),
            plastic_poisson_ratio: f(self.plastic_poisson_ratio),
            hardening_modulus: f(self.hardening_modulus),
            densification: self.densification.map(|dense| Densification {
                densification_strain: f(dense.densification_strain),
                densification_stress: f(dense.densification_stress),
                densification_exponent: f(dense.densification_exponent),
                dense: f(dense.dense),
            }),
        }
    }
}

/// A particle before its plastic step.
#[derive(Clone, Copy, Debug)]
struct Before<T> {
    /// a [-]
    strain: T,
    /// A q*^2 and B p*^2 [Pa^2]
    squares: [T; 2],
    /// 3 G A and K B [Pa]
    stiffness: [T; 2],
}

impl<T: Number> Before<T> {
    /// S, and its slope, at t.
    #[inline(always)]
    fn equivalent(&self, t: T) -> [T; 2] {
        let [mut square, mut falls] = [T::ZERO; 2];
        for k in 0..2 {
            let left = T::ONE / (T::ONE + self.stiffness[k] * t);
            let part = self.squares[k] * left * left;
            square += part;
            falls += part * left * self.stiffness[k];
        }
        let stress = square.sqrt();
        [stress, -falls / stress]
    }
}

impl<T: Number> Densification<T> {
    /// Growth of Y, and its slope [Pa].
    #[inline(always)]
    fn strength(&self, strain: T) -> [T; 2] {
        let (stress, exponent) = (self.densification_stress, self.densification_exponent);
        let closed = strain / self.densification_strain;
        let within = closed.min(self.dense).max(T::of(LEAST));
        let power = (exponent * within.ln()).exp();
        let left = T::ONE - power;
        let slope = stress * exponent * (power / within) / left;
        let beyond = slope * (closed - within).max(T::ZERO);
        [beyond - stress * left.ln(), slope / self.densification_strain]
    }
}

impl<T: Number> CrushableFoam<T> {
    /// A and B.
    #[inline(always)]
    fn shares(&self) -> [T; 2] {
        let nu = self.plastic_poisson_ratio;
        [T::of(2.0 / 3.0) * (T::ONE + nu), T::of(3.0) * (T::ONE - nu - nu)]
    }

    /// Y, and its slope [Pa].
    #[inline(always)]
    fn strength(&self, strain: T) -> [T; 2] {
        let linear = [self.plateau_stress + self.hardening_modulus * strain, self.hardening_modulus];
        match &self.densification {
            None => linear,
            Some(dense) => {
                let [stress, slope] = dense.strength(strain);
                [linear[0] + stress, linear[1] + slope]
            }
        }
    }

    /// t of each lane by itself, and S there.
    #[inline(always)]
    fn flow(&self, before: &Before<T>) -> [T; 2] {
        let [stress, falls] = before.equivalent(T::ZERO);
        let [start, hardens] = self.strength(before.strain);
        let flows = !start.at_least(stress) & ((1 << T::SIDE_BY_SIDE) - 1);
        let mut searching = flows;
        if searching == 0 {
            return [T::ZERO, stress];
        }
        let excess = stress / start - T::ONE;
        let (mut low, mut high) = (T::ZERO, excess / before.stiffness[0].min(before.stiffness[1]));
        // The first of Newton's steps, by the slope of Y/S at no flow.
        let slope = hardens - start * falls / (stress * stress);
        let mut t = ((T::ONE - start / stress) / slope).min(high);
        // Round-off may be above what the search ends by, so the best trial counts.
        let (mut found, mut best) = ([T::ZERO, stress], T::of(1.0 / LEAST));
        for count in 0..MOST_TRIALS {
            let [stress, falls] = before.equivalent(t);
            let [strength, hardens] = self.strength(before.strain + t * stress);
            let off = T::ONE - strength / stress;
            let better = searching & best.at_least(off.abs());
            best = T::select(better, off.abs(), best);
            found = [T::select(better, t, found[0]), T::select(better, stress, found[1])];
            let short = off.at_least(T::ZERO);
            low = T::select(short, t, low);
            high = T::select(short, high, t);
            let grows = hardens * (stress + t * falls);
            let newton = t + off * stress / (grows - strength * falls / stress);
            let sound = (T::of(4.0) * T::EPSILON).at_least(off.abs())
                | (T::of(4.0) * T::EPSILON * t).at_least((newton - t).abs())
                | (T::of(2.0) * T::EPSILON * high).at_least(high - low);
            searching &= !sound;
            if searching == 0 {
                break;
            }
            let inside = newton.at_least(low) & high.at_least(newton);
            let halves = count >= PATIENCE && count % 4 == 2;
            let next = T::select(if halves { 0 } else { inside }, newton, T::HALF * (low + high));
            t = T::select(searching, next, t);
        }
        [T::select(flows, found[0], T::ZERO), T::select(flows, found[1], stress)]
    }
}

impl<T: Number> Law<T> for CrushableFoam<T> {
    /// a and D.
    type History = [T; 2];

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
    fn respond(&self, motion: &Motion<T>, &[strain, lost]: &[T; 2]) -> Response<T, [T; 2]> {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic.elastic;
        let trial = self.elastic.stress(motion);
        let mean = trial.trace() * T::of(1.0 / 3.0);
        let deviator = trial - Symmetric::isotropic(mean);
        let q_squared = T::of(1.5) * deviator.double_dot(&deviator);
        let [a, b] = self.shares();
        let stiffness = [T::of(3.0) * g * a, k * b];
        let before = Before { strain, squares: [a * q_squared, b * mean * mean], stiffness };
        let [t, equivalent] = self.flow(&before);
        let [sheared, compacted] = stiffness.map(|stiffness| stiffness * t);
        let (shear_left, left) = (T::ONE / (T::ONE + sheared), T::ONE / (T::ONE + compacted));
        // Without flow nothing is taken apart and put together, so that a stress that rests stays as it is.
        let stress =
            trial - deviator * (sheared * shear_left) - Symmetric::isotropic(mean * (compacted * left));
        let growth = t * equivalent;
        let (m, q2) = (mean * left, q_squared * shear_left * shear_left);
        let stored = T::HALF * m * m / k + q2 / (T::of(6.0) * g);
        let dissipated = motion.jacobian * (equivalent * growth - stored * (b * m * t));
        Response { stress, history: [strain + growth, lost + dissipated.max(T::ZERO)] }
    }

    #[inline(always)]
    fn strain_energy(&self, deformation: &Matrix<T>, stress: &Symmetric<T>, _history: &[T; 2]) -> T {
        self.elastic.strain_energy(deformation, stress, &[])
    }

    #[inline(always)]
    fn dissipation(&self, &[_, lost]: &[T; 2]) -> T {
        lost
    }

    #[inline(always)]
    fn wave_modulus(&self, deformation: &Matrix<T>, jacobian: T, _history: &[T; 2]) -> T {
        self.elastic.wave_modulus(deformation, jacobian, &[])
    }

    #[inline(always)]
    fn shear_modulus(&self, deformation: &Matrix<T>, jacobian: T, _history: &[T; 2]) -> T {
        self.elastic.shear_modulus(deformation, jacobian, &[])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::LAWS;
    use crate::material::soil::tests::{State, along_axes, only_turns, stiffest_on_paths};
    use crate::material::tests::{follow, motion_of, rotation, sample_gradients};
    use crate::material::trials::{
        Chance, answers_are_numbers, lanes_know_nothing_of_each_other, plates_have_a_thickness,
    };

    /// Aluminium foam of 0.34 g/cm^3, in MPa, much as Reyes et al. (2003) fitted it.
    const FOAM: CrushableFoam<f64> = CrushableFoam {
        elastic: Hypoelastic { elastic: Isotropic { bulk_modulus: 400.0, shear_modulus: 500.0 } },
        plateau_stress: 3.0,
        plastic_poisson_ratio: 0.0,
        hardening_modulus: 1.5,
        densification: None,
    };
    const NONE: [f64; 2] = [0.0; 2];

    fn closing() -> CrushableFoam<f64> {
        CrushableFoam { densification: Some(Densification::new(2.1, 60.0, 4.0)), ..FOAM }
    }

    fn laws() -> Vec<CrushableFoam<f64>> {
        let across = [FOAM, closing()].into_iter().flat_map(|law| {
            [-0.5, 0.0, 0.3, 0.49].map(|nu| CrushableFoam { plastic_poisson_ratio: nu, ..law })
        });
        let soon = CrushableFoam { densification: Some(Densification::new(0.02, 1.0, 1.0)), ..FOAM };
        across.chain([CrushableFoam { hardening_modulus: 0.0, ..FOAM }, soon]).collect()
    }

    /// S of a stress.
    fn equivalent(law: &CrushableFoam<f64>, stress: &Symmetric<f64>) -> f64 {
        let ([a, b], s, p) = (law.shares(), stress.deviator(), stress.trace() / 3.0);
        (a * 1.5 * s.double_dot(&s) + b * p * p).sqrt()
    }

    #[test]
    fn below_yield_it_is_the_elastic_law() {
        for law in laws() {
            for h in sample_gradients() {
                let motion = motion_of(Matrix::IDENTITY + h * 1e-3);
                let response = law.respond(&motion, &NONE);
                assert_eq!((response.stress, response.history), (law.elastic.stress(&motion), NONE));
            }
            let rest = law.respond(&motion_of(Matrix::IDENTITY), &NONE);
            assert_eq!((rest.stress, rest.history), (Symmetric::ZERO, NONE));
        }
    }

    #[test]
    fn beyond_yield_the_stress_stays_on_the_ellipse() {
        for law in laws() {
            for h in sample_gradients() {
                let (end, [strain, _], _) = follow(&law, (50, 1.0), |t| Matrix::IDENTITY + h * (4.0 * t));
                assert!(strain > 0.01, "{strain}");
                let [allowed, slope] = law.strength(strain);
                let off = (equivalent(&law, &end.stress) / allowed - 1.0).abs();
                assert!(off < 1e-12 + 1e-15 * slope / allowed, "{law:?} {off}");
            }
        }
    }

    /// alpha and the hardening as Deshpande and Fleck (2000) and Reyes et al. (2003) write them.
    #[test]
    fn it_is_the_law_of_the_papers() {
        let alpha_squared = |nu: f64| 9.0 * (1.0 - 2.0 * nu) / (2.0 * (1.0 + nu));
        for nu in [0.0, 0.1, 0.3] {
            let law = CrushableFoam { plastic_poisson_ratio: nu, ..closing() };
            let [a, b] = law.shares();
            let c = 1.0 + alpha_squared(nu) / 9.0;
            assert!((a * c - 1.0).abs() < 1e-14 && (b * c / alpha_squared(nu) - 1.0).abs() < 1e-14);
            for share in [0.1f64, 0.5, 0.9] {
                let exact = 3.0 + 1.5 * 2.1 * share + 60.0 * f64::ln(1.0 / (1.0 - share.powi(4)));
                assert!((law.strength(2.1 * share)[0] / exact - 1.0).abs() < 1e-13);
            }
        }
    }

    /// A bar with free sides bears Y(a), becomes wider by nu a, and nothing else, to four fifths of its length.
    #[test]
    fn a_crushed_bar_bears_the_formula() {
        let elastic = FOAM.elastic.elastic;
        let (young, ratio) = (elastic.young_modulus(), elastic.poisson_ratio());
        for (nu, sign) in [0.0, 0.1, 0.3].into_iter().flat_map(|nu| [(nu, -1.0), (nu, 1.0)]) {
            let law = CrushableFoam { plastic_poisson_ratio: nu, ..closing() };
            let most = if sign < 0.0 { 1.6 } else { 0.5 };
            let bar = |t: f64| {
                // Elastic up to a tenth of the way, then by the plastic strain.
                let a = most * ((t - 0.1) / 0.9).max(0.0);
                let stress = law.strength(a)[0] * (t / 0.1).min(1.0);
                let along = (sign * (a + stress / young)).exp();
                let across = (-sign * (nu * a + ratio * stress / young)).exp();
                Matrix([[along, 0.0, 0.0], [0.0, across, 0.0], [0.0, 0.0, across]])
            };
            let (end, [strain, lost], work) = follow(&law, (4000, 1.0), bar);
            let exact = law.strength(most)[0];
            assert!((end.stress.0[0] / (sign * exact) - 1.0).abs() < 1e-3, "{nu} {:?} {exact}", end.stress);
            assert!(end.stress.0[1].abs() < 1e-3 * exact, "{nu} {:?}", end.stress);
            assert!((strain / most - 1.0).abs() < 1e-3, "{nu} {strain}");
            assert!(lost > 0.9 * work, "{lost} {work}");
        }
    }

    /// Under pressure alone p = Y/sqrt(B), and the plastic part of ln(J) is -sqrt(B) a.
    #[test]
    fn pressure_crushes_it_at_its_own_strength() {
        for law in [FOAM, closing(), CrushableFoam { plastic_poisson_ratio: 0.25, ..closing() }] {
            let root = law.shares()[1].sqrt();
            let volume = -1.5;
            let (end, [strain, _], _) =
                follow(&law, (1000, 1.0), |t| Matrix::IDENTITY * (volume * t / 3.0).exp());
            let pressure = -end.stress.trace() / 3.0;
            assert!((pressure * root / law.strength(strain)[0] - 1.0).abs() < 1e-10);
            let exact = (-volume - pressure / 400.0) / root;
            assert!((strain / exact - 1.0).abs() < 1e-3, "{strain} {exact}");
        }
    }

    /// In a die: rates of p, q and a, integrated here in 200,000 explicit steps.
    #[test]
    fn in_a_die_it_follows_its_equations() {
        for nu in [0.0, 0.2, 0.4] {
            let law = CrushableFoam { plastic_poisson_ratio: nu, ..closing() };
            let Isotropic { bulk_modulus: k, shear_modulus: g } = law.elastic.elastic;
            let [a, b] = [2.0 / 3.0 * (1.0 + nu), 3.0 * (1.0 - 2.0 * nu)];
            let (steps, most) = (200_000, 1.2);
            let d = most / f64::from(steps);
            let (mut p, mut q, mut strain) = (0.0f64, 0.0f64, 0.0f64);
            for _ in 0..steps {
                let s = (a * q * q + b * p * p).sqrt();
                let (mut dq, mut dp) = (3.0 * g * (2.0 / 3.0 * d), k * d);
                let yields = 3.0 + 1.5 * strain - 60.0 * (1.0 - (strain / 2.1).powi(4)).ln();
                if s >= yields {
                    let hardens =
                        1.5 + 60.0 * 4.0 * (strain / 2.1).powi(3) / (2.1 * (1.0 - (strain / 2.1).powi(4)));
                    let (nq, np) = (a * q / s, b * p / s);
                    let da = (nq * dq + np * dp) / (3.0 * g * nq * nq + k * np * np + hardens);
                    dq -= 3.0 * g * nq * da;
                    dp -= k * np * da;
                    strain += da;
                }
                (p, q) = (p + dp, q + dq);
            }
            let path = |t: f64| along_axes([-most * t, 0.0, 0.0]);
            let (end, history, _) = follow(&law, (4000, 1.0), path);
            let (found, side) = (end.stress.0[0], end.stress.0[1]);
            assert!((found / (-p - 2.0 / 3.0 * q) - 1.0).abs() < 1e-3, "{nu}: {found} {p} {q}");
            assert!((side - (q / 3.0 - p)).abs() < 1e-3 * p, "{nu}: {side} {p} {q}");
            assert!((history[0] / strain - 1.0).abs() < 1e-3, "{nu}: {history:?} {strain}");
        }
    }

    /// A step's equation holds to round-off whatever its constants, in 100,000 steps.
    #[test]
    fn the_search_solves_every_step() {
        let mut chance = Chance(5);
        for trial in 0..100_000 {
            let mut decade = |least: f64, most: f64| 10f64.powf(least + (most - least) * chance.number());
            let (a_d, r, exponent) = (decade(-3.0, 1.0), decade(-3.0, 3.0), decade(0.0, 1.5));
            let densification = (trial % 2 == 0).then(|| Densification::new(a_d, r, exponent));
            let hardening_modulus = [0.0, decade(-3.0, 4.0)][trial / 2 % 2];
            let nu = [-0.9, 0.0, 0.3, 0.499][trial / 4 % 4];
            let law = CrushableFoam { densification, hardening_modulus, plastic_poisson_ratio: nu, ..FOAM };
            let strain = [0.0, decade(-12.0, 0.5)][trial / 16 % 2];
            let [start, _] = law.strength(strain);
            let square = (start * (1.0 + decade(-6.0, 3.0))).powi(2);
            let share = [0.0, 0.5, 1.0, 1e-6][trial / 32 % 4];
            let [a, b] = law.shares();
            let before = Before {
                strain,
                squares: [square * share, square * (1.0 - share)],
                stiffness: [1500.0 * a, 400.0 * b],
            };
            let [t, stress] = law.flow(&before);
            let after = strain + t * stress;
            let [strength, slope] = law.strength(after);
            // What round-off of the strain, and of what is left of the pores, is worth.
            let noise = slope * after + if trial % 2 == 0 { r / LEAST_LEFT * 1e-2 } else { 0.0 };
            let allowed = 1e-13 * stress + 16.0 * f64::EPSILON * noise;
            assert!(t > 0.0 && (strength - stress).abs() < allowed, "{strength} {stress} {law:?} {before:?}");
        }
    }

    /// Foam without pores bears pressure as its elastic law has it.
    #[test]
    fn foam_without_pores_is_all_but_elastic() {
        let law = closing();
        let path = |t: f64| along_axes([-3.0 * t, 0.0, 0.0]);
        let (end, history, _) = follow(&law, (3000, 1.0), path);
        assert!(history[0] > 0.99 * 2.1, "{history:?}");
        let next = end.deformation * along_axes([-1e-3, 0.0, 0.0]);
        let motion = Motion {
            deformation: next,
            jacobian: next.det(),
            increment: along_axes([-1e-3, 0.0, 0.0]),
            ..end
        };
        let tangent = (end.stress.0[0] - law.respond(&motion, &history).stress.0[0]) / 1e-3;
        assert!((tangent / law.elastic().p_wave_modulus() - 1.0).abs() < 0.05, "{tangent}");
    }

    /// Of foam that is crushed at a small elastic strain, for the rate form's energy is exact only there.
    #[test]
    fn the_work_is_stored_or_dissipated() {
        let crushed = laws().into_iter().filter(|law| {
            law.plastic_poisson_ratio < 0.4
                && law.densification.is_none_or(|dense| dense.densification_strain > 1.0)
        });
        let mut worst = 0.0f64;
        for law in crushed {
            for h in sample_gradients() {
                let motion = |t: f64| {
                    let f = Matrix::IDENTITY + h * (3.0 * t).sin();
                    f * (1.0 - 0.1 * (4.0 * t).sin())
                };
                let (end, history, work) = follow(&law, (4000, 1.0), motion);
                let stored = law.strain_energy(&end.deformation, &end.stress, &history);
                let dissipated = law.dissipation(&history);
                worst = worst.max(((stored + dissipated) / work - 1.0).abs());
                assert!(worst < 2e-3, "{law:?} {stored} + {dissipated}, {work}");
            }
        }
    }

    #[test]
    fn flow_never_gives_energy_back() {
        let mut chance = Chance(3);
        for law in laws() {
            for path in 0..400 {
                let size = [1e-4, 1e-2, 0.15][path % 3];
                let (mut f, mut stress, mut history) = (Matrix::IDENTITY, Symmetric::ZERO, NONE);
                for _ in 0..8 {
                    let increment = Matrix::IDENTITY + chance.matrix() * size;
                    f = increment * f;
                    let motion = Motion { deformation: f, jacobian: f.det(), increment, stress, dt: 1e-3 };
                    let after = law.respond(&motion, &history);
                    assert!(after.history[0] >= history[0] && after.history[1] >= history[1], "{law:?}");
                    (stress, history) = (after.stress, after.history);
                }
                assert!(size < 0.1 || history[1] > 0.0, "{law:?} {history:?}");
            }
        }
    }

    #[test]
    fn a_step_of_rotation_only_rotates_the_stress() {
        for law in laws() {
            let start = State::under(Symmetric::ZERO);
            let before = start.moved(&law, Matrix::IDENTITY + sample_gradients()[2]);
            only_turns(&law, &before);
        }
    }

    #[test]
    fn a_turned_motion_has_a_turned_stress() {
        let q = rotation();
        for law in laws() {
            for h in sample_gradients() {
                let f = Matrix::IDENTITY + h;
                let [one, other] = [f, q * f * q.transpose()].map(|f| law.respond(&motion_of(f), &NONE));
                let exact = one.stress.rotated(&q);
                assert!(other.stress.0.iter().zip(exact.0).all(|(s, e)| (s - e).abs() < 1e-9), "{law:?}");
                assert!((one.history[0] - other.history[0]).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_wave_modulus_is_an_upper_bound() {
        for law in laws() {
            let largest = stiffest_on_paths(&law, Symmetric::ZERO);
            assert!((0.75..1.0 + 1e-4).contains(&largest), "{law:?}: {largest}");
        }
    }

    #[test]
    fn particles_side_by_side_know_nothing_of_each_other() {
        for law in laws() {
            lanes_know_nothing_of_each_other(&law, &law.map(Number::of), 400);
        }
    }

    #[test]
    fn plates_have_a_thickness_without_stress() {
        for law in laws() {
            plates_have_a_thickness(&law, 100);
        }
    }

    #[test]
    fn whatever_the_motion_the_answers_are_numbers() {
        for law in laws() {
            answers_are_numbers(&law, 5_000);
            answers_are_numbers(&law.map(|x| x as f32), 5_000);
            // In Pa.
            let si = CrushableFoam {
                elastic: Hypoelastic { elastic: Isotropic { bulk_modulus: 400e6, shear_modulus: 500e6 } },
                plateau_stress: 3e6,
                hardening_modulus: law.hardening_modulus * 1e6,
                densification: law.densification.map(|dense| Densification {
                    densification_stress: dense.densification_stress * 1e6,
                    ..dense
                }),
                ..law
            };
            answers_are_numbers(&si.map(|x| x as f32), 5_000);
        }
    }

    #[test]
    fn constants_that_make_no_material_are_refused() {
        let law = LAWS.iter().find(|law| law.name == "crushable_foam").expect("a law of the list");
        let with = |more: &[(&str, f64)]| {
            let elastic = Given::from([("bulk_modulus", 6.0), ("shear_modulus", 3.0), (PLATEAU_STRESS, 1.0)]);
            law.build(&more.iter().fold(elastic, |given, &(name, value)| given.with(name, value)))
        };
        let all = [(DENSIFICATION_STRAIN, 2.0), (DENSIFICATION_STRESS, 1.0), (DENSIFICATION_EXPONENT, 3.0)];
        let sound = with(&all).expect("all of densification");
        assert_eq!(law.build(&sound.given()), Ok(sound));
        assert_eq!(with(&[]).expect("none").given().get(PLASTIC_POISSON_RATIO), Some(0.0));
        for (constants, key) in [
            (&[(PLATEAU_STRESS, 0.0)][..], Some(PLATEAU_STRESS)),
            (&[(PLASTIC_POISSON_RATIO, 0.5)], Some(PLASTIC_POISSON_RATIO)),
            (&[(HARDENING_MODULUS, -1.0)], Some(HARDENING_MODULUS)),
            (&all[..1], Some(DENSIFICATION_STRAIN)),
            (&all[..2], Some(DENSIFICATION_STRAIN)),
            (&all[1..], Some(DENSIFICATION_STRESS)),
            (&[all[0], all[1], (DENSIFICATION_EXPONENT, 0.5)], Some(DENSIFICATION_EXPONENT)),
            (&[(DENSIFICATION_STRAIN, 0.0), all[1], all[2]], Some(DENSIFICATION_STRAIN)),
            (&[("shear_modulus", 0.0)], None),
        ] {
            assert_eq!(with(constants).unwrap_err().key.as_deref(), key, "{constants:?}");
        }
    }
}
