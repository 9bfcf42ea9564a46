//! Clay by the critical state: modified Cam-clay (Roscoe and Burland 1968), with the implicit return of Borja and Lee
//! (1990) in one unknown.
//!
//! ```text
//! q^2/M^2 + P (P - P_c) <= 0,   P = p + t,  P_c = p_c + t,   p = -tr(sigma)/3,   q = sqrt(3/2 s : s),  s = dev(sigma)
//! v = v_0 J = 1 + e                                              specific volume, e: void ratio
//! elastic   dv = -kappa dP/P,   so K = v P/kappa,   G = r K,   r = 3 (1 - 2 nu)/(2 (1 + nu))
//! flow      de_p = df (2 P - P_c) in volume, df 2 q/M^2 in shear     along the normal of the ellipse
//! hardening P_c = P_c0 exp(x/(lambda - kappa))                   x: v that flow took, "plastic_compaction"
//! ```
//!
//! In a body without stress and strain P = t: t is the floor of pressure that gives unstressed clay a stiffness, and
//! the mean tension that clay bears. A step that is elastic ends at P* and s*, and one that flows at
//!
//! ```text
//! P_c = P_cn exp(y L kappa/lambda),   P = P_c exp((1 - y) L)/2,   L = ln(2 P*/P_cn)
//! q   = q*/(1 + 6 G f/M^2),           f = kappa (1 - kappa/lambda) y/(1 - y) B((1 - y) L)/(v P_c)
//! B(z) = z/(exp(z) - 1)
//! ```
//! with the y between 0 and 1 that puts it on the ellipse: 0 is the elastic step, 1 the critical state. It exists for
//! every step, wet or dry, and Newton's method within a bracket finds it. Volume follows v exactly, so that lines in
//! the plane of v and ln(P) have the slopes lambda and kappa at any strain.
//!
//! ```text
//! W = kappa/v_0 (P - t - t ln(P/t) + q^2/(6 r P))                stored per undeformed volume
//! D = p dx/v_0 + J q de_q + kappa/(6 r v_0) q^2 dP/P^2           dissipated
//! ```
//! The last term of D is no flow: with one Poisson's ratio at all pressures, elasticity takes energy as a sheared clay
//! is compressed, and gives it back as it expands (Zytynski et al. 1978), so D may fall by so much.
//!
//! Clay that is pulled apart keeps P at a thousandth of t, and the rest of its expansion undoes x, so that it must be
//! compressed again before it bears pressure. P_c stays between twice that and exp(20) P_c0.

use super::declaration::{
    Absent, AllowedRange, BadConstants, Constant, Declared, Form, Given, POSITIVE, PRESSURE, Quantity, RATIO,
};
use super::hypoelastic::turned_and_strained;
use super::soil::{self, equivalent, pressure};
use super::{History, Hypoelastic, Isotropic, Law, Motion, Response};
use crate::column::Kind;
use crate::tensor::{Matrix, Number, Symmetric, array};
use serde::Serialize;

/// Modified Cam-clay.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ModifiedCamClay<T> {
    /// M, q over p in the critical state [-].
    pub critical_slope: T,
    /// lambda, fall of v by ln(p) in normal compression [-].
    pub compression_slope: T,
    /// kappa, the same as pressure is taken off [-].
    pub swelling_slope: T,
    /// nu [-]
    pub poisson_ratio: T,
    /// p_c before anything moves [Pa].
    pub preconsolidation_pressure: T,
    /// e before anything moves [-].
    pub void_ratio: T,
    /// t [Pa]
    pub tension_strength: T,
    /// ln(P_c0/t)
    #[serde(skip)]
    start: T,
}

/// Names of the constants in scene files.
const CRITICAL_SLOPE: &str = "critical_slope";
const COMPRESSION_SLOPE: &str = "compression_slope";
const SWELLING_SLOPE: &str = "swelling_slope";
const POISSON_RATIO: &str = "poisson_ratio";
const PRECONSOLIDATION_PRESSURE: &str = "preconsolidation_pressure";
const VOID_RATIO: &str = "void_ratio";

/// t over the first p_c where none is given.
const USUAL_TENSION: f64 = 0.01;
/// P over t at least, and its logarithm.
const LEAST_SHARE: f64 = 1e-3;
const LEAST: f64 = -3.0 * std::f64::consts::LN_10;
/// Most of ln(P_c/P_c0), and of ln(P) in a step.
const MOST: f64 = 20.0;
const MOST_TIMES: f64 = 485_165_195.409_790_3;
/// Trials of Newton's method; steps of up to 1e-3 of strain take three to five.
const MOST_TRIALS: usize = 60;

const STABLE: AllowedRange = AllowedRange::between(-1.0, 0.5).because(", else the material is not stable");

/// What a particle remembers.
const HISTORY: [History; 3] = [
    History::new("plastic_compaction", "", Kind::Number),
    History::new("plastic_shear_strain", "", Kind::Number),
    History::new("clay_dissipation", "J/m^3", Kind::Number),
];

impl Declared for ModifiedCamClay<f64> {
    const SUMMARY: &'static str =
        "Modified Cam-clay: strength and stiffness of clay follow pressure and void ratio.";
    const CONSTANTS: &'static [Constant] = &[
        Constant::required(
            CRITICAL_SLOPE,
            "q over p in the critical state, M: 6 sin(phi)/(3 - sin(phi)) of a friction angle phi.",
            (RATIO, POSITIVE),
            "1.0",
        ),
        Constant::required(
            COMPRESSION_SLOPE,
            "Fall of the specific volume 1 + e by ln(p) in normal compression, lambda; 0.434 of the compression index.",
            (RATIO, POSITIVE),
            "0.2",
        ),
        Constant::required(
            SWELLING_SLOPE,
            "Fall of the specific volume by ln(p) in unloading and reloading, kappa, below lambda.",
            (RATIO, POSITIVE),
            "0.04",
        ),
        Constant::required(
            POISSON_RATIO,
            "Poisson's ratio nu, above -1 and below 0.5.",
            (RATIO, STABLE),
            "0.3",
        ),
        Constant::required(
            PRECONSOLIDATION_PRESSURE,
            "Pressure p_c up to which the clay was compressed before anything moves.",
            (PRESSURE, POSITIVE),
            "\"100 kPa\"",
        ),
        Constant::required(
            VOID_RATIO,
            "Volume of the pores over that of the grains before anything moves, e.",
            (RATIO, POSITIVE),
            "1.0",
        ),
        Constant {
            name: soil::TENSION_STRENGTH,
            summary: "Mean tension that it bears, and floor of pressure that its stiffness follows; a hundredth of the \
                      preconsolidation pressure without it.",
            form: Form::Number(Quantity {
                name: soil::TENSION_STRENGTH,
                unit: PRESSURE,
                bounds: POSITIVE.because(", else clay without stress has no stiffness"),
            }),
            absent: Absent::Judged,
        },
    ];

    fn build(given: &Given) -> Result<Self, BadConstants> {
        let (compression, swelling) = (given.number(COMPRESSION_SLOPE), given.number(SWELLING_SLOPE));
        if swelling >= compression {
            let allowed =
                format!("below the {COMPRESSION_SLOPE}, {compression}, else nothing is left that flow takes");
            return Err(BadConstants::of(SWELLING_SLOPE, swelling.to_string(), allowed));
        }
        let preconsolidation_pressure = given.number(PRECONSOLIDATION_PRESSURE);
        let tension_strength =
            given.get(soil::TENSION_STRENGTH).unwrap_or(USUAL_TENSION * preconsolidation_pressure);
        Ok(ModifiedCamClay {
            critical_slope: given.number(CRITICAL_SLOPE),
            compression_slope: compression,
            swelling_slope: swelling,
            poisson_ratio: given.number(POISSON_RATIO),
            preconsolidation_pressure,
            void_ratio: given.number(VOID_RATIO),
            tension_strength,
            start: libm::log(preconsolidation_pressure / tension_strength + 1.0),
        })
    }

    fn given(&self) -> Given {
        Given::from([
            (CRITICAL_SLOPE, self.critical_slope),
            (COMPRESSION_SLOPE, self.compression_slope),
            (SWELLING_SLOPE, self.swelling_slope),
            (POISSON_RATIO, self.poisson_ratio),
            (PRECONSOLIDATION_PRESSURE, self.preconsolidation_pressure),
            (VOID_RATIO, self.void_ratio),
            (soil::TENSION_STRENGTH, self.tension_strength),
        ])
    }

    /// Under the preconsolidation pressure.
    fn elastic(&self) -> Isotropic<f64> {
        let pressure = self.preconsolidation_pressure + self.tension_strength;
        let bulk_modulus = (1.0 + self.void_ratio) * pressure / self.swelling_slope;
        Isotropic { bulk_modulus, shear_modulus: self.shear_ratio() * bulk_modulus }
    }
}

impl<T: Copy> ModifiedCamClay<T> {
    /// The same constants in other numbers.
    #[inline(always)]
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> ModifiedCamClay<U> {
        ModifiedCamClay {
            critical_slope: f(self.critical_slope),
            compression_slope: f(self.compression_slope),
            swelling_slope: f(self.swelling_slope),
            poisson_ratio: f(self.poisson_ratio),
            preconsolidation_pressure: f(self.preconsolidation_pressure),
            void_ratio: f(self.void_ratio),
            tension_strength: f(self.tension_strength),
            start: f(self.start),
        }
    }
}

/// B(z) and its derivative, from z and exp(z).
#[inline(always)]
fn bernoulli<T: Number>(z: T, exponential: T) -> [T; 2] {
    let small = T::of(0.1).at_least(z.abs());
    let square = z * z;
    let near = T::ONE - T::HALF * z
        + square * (T::of(1.0 / 12.0) - square * (T::of(1.0 / 720.0) - square * T::of(1.0 / 30240.0)));
    let near_slope =
        -T::HALF + z * (T::of(1.0 / 6.0) - square * (T::of(1.0 / 180.0) - square * T::of(1.0 / 5040.0)));
    let less_one = T::select(small, T::ONE, exponential - T::ONE);
    let far = z / less_one;
    let far_slope = (T::ONE - far * exponential) / less_one;
    [T::select(small, near, far), T::select(small, near_slope, far_slope)]
}

/// A step beyond the ellipse, in units of P_c at its start.
struct Flow<T> {
    /// L
    length: T,
    /// q*/M
    sheared: T,
    /// kappa/lambda
    slopes: T,
    /// 6 G kappa (1 - kappa/lambda)/(M^2 v P_cn)
    stiffness: T,
}

impl<T: Number> Flow<T> {
    /// P_c, and P over half of it, at y.
    #[inline(always)]
    fn pressures(&self, y: T) -> [T; 2] {
        [(y * self.length * self.slopes).exp(), ((T::ONE - y) * self.length).exp()]
    }

    /// How far outside of the ellipse y is, and how fast that changes.
    #[inline(always)]
    fn outside(&self, y: T) -> [T; 2] {
        let [consolidated, pressed] = self.pressures(y);
        let rest = T::ONE - y;
        let [b, b_slope] = bernoulli(rest * self.length, pressed);
        // q/q* = above/below
        let above = rest * consolidated;
        let below = above + self.stiffness * y * b;
        let grows = self.length * self.slopes;
        let above_slope = above * grows - consolidated;
        let below_slope = above_slope + self.stiffness * (b - y * self.length * b_slope);
        let ratio = above / below;
        let ratio_slope = (above_slope - ratio * below_slope) / below;
        let square = self.sheared * self.sheared;
        let half = T::HALF * pressed;
        let ellipse = half * (half - T::ONE) * consolidated * consolidated;
        let ellipse_slope = (grows + grows) * ellipse
            - self.length * half * (half + half - T::ONE) * consolidated * consolidated;
        [square * ratio * ratio + ellipse, T::of(2.0) * square * ratio * ratio_slope + ellipse_slope]
    }

    /// y of the lanes that flow, else 0.
    #[inline(always)]
    fn solved(&self, flows: u32) -> T {
        let (mut low, mut high, mut y) = (T::ZERO, T::ONE, T::ZERO);
        let mut searching = flows;
        for _ in 0..MOST_TRIALS {
            if searching == 0 {
                break;
            }
            let [off, slope] = self.outside(y);
            let beyond = off.at_least(T::ZERO);
            low = T::select(beyond, y, low);
            high = T::select(beyond, high, y);
            let next = y - off / slope;
            let inside = next.at_least(low) & high.at_least(next);
            let next = T::select(inside, next, T::HALF * (low + high));
            let sound = (T::of(4.0) * T::EPSILON).at_least(off.abs())
                | (T::of(4.0) * T::EPSILON * high).at_least(high - low);
            searching &= !sound;
            y = T::select(searching, next, y);
        }
        y
    }
}

impl<T: Number> ModifiedCamClay<T> {
    /// G/K
    #[inline(always)]
    fn shear_ratio(&self) -> T {
        T::of(1.5) * (T::ONE - self.poisson_ratio - self.poisson_ratio) / (T::ONE + self.poisson_ratio)
    }

    /// ln(P_c/t)
    #[inline(always)]
    fn consolidated(&self, compaction: T) -> T {
        let hardened = compaction / (self.compression_slope - self.swelling_slope);
        (self.start + hardened.min(T::of(MOST))).max(T::of(LEAST + std::f64::consts::LN_2))
    }

    /// v by which the clay came apart beyond where P_c has its least value.
    #[inline(always)]
    fn gap(&self, compaction: T) -> T {
        let hardening = self.compression_slope - self.swelling_slope;
        ((T::of(LEAST + std::f64::consts::LN_2) - self.start) * hardening - compaction).max(T::ZERO)
    }

    /// Bounds of J K, and r: P is nowhere above P_c.
    #[inline(always)]
    fn stiffest(&self, jacobian: T, compaction: T) -> [T; 2] {
        let pressure = self.tension_strength * self.consolidated(compaction).exp();
        let bulk = jacobian * jacobian * (T::ONE + self.void_ratio) * pressure / self.swelling_slope;
        [bulk, self.shear_ratio()]
    }
}

impl<T: Number> Law<T> for ModifiedCamClay<T> {
    /// x, the plastic shear strain and D.
    type History = [T; 3];

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
    fn respond(&self, motion: &Motion<T>, &[compaction, strain, lost]: &[T; 3]) -> Response<T, [T; 3]> {
        let (kappa, slope) = (self.swelling_slope, self.critical_slope);
        let (t, whole, j) = (self.tension_strength, T::ONE + self.void_ratio, motion.jacobian);
        // J/J_n - 1 = det(I + A) - 1, without the round-off of one
        let a = motion.increment - Matrix::IDENTITY;
        let second = T::HALF * (a.trace() * a.trace() - (a * a).trace());
        let grown = a.trace() + second + a.det();
        let j_before = j / (T::ONE + grown);

        let p_before = pressure(&motion.stress);
        let before = (p_before + t).max(t * T::of(LEAST_SHARE));
        let log_before = (before / t).ln();
        let reduced = -(whole * j_before * grown);
        // What came apart closes first.
        let closed = self.gap(compaction).min(reduced.max(T::ZERO));
        let wanted = (reduced - closed) / kappa;
        let rise = wanted.max(T::of(LEAST) - log_before).min(T::of(MOST));
        // What the elastic volume does not follow.
        let apart = kappa * (wanted - rise) + closed;
        let compacted = compaction + apart;
        let log_start = self.consolidated(compacted);
        let start = t * log_start.exp();
        let grows = before * (rise.exp() - T::ONE);
        let trial = before + grows;

        let ratio = self.shear_ratio();
        let g = ratio * whole * j / kappa * (T::HALF * (before + trial.min(start)));
        // Without a bulk modulus: 2 G D alone.
        let shear =
            Hypoelastic { elastic: Isotropic { bulk_modulus: T::of(2.0 / 3.0) * g, shear_modulus: g } };
        let (turned, step) = turned_and_strained(motion);
        let elastic = shear.strained(&turned, &step);
        let deviator = elastic.deviator();
        let q = equivalent(&deviator);

        let flow = Flow {
            length: T::of(std::f64::consts::LN_2) + log_before + rise - log_start,
            sheared: q / (slope * start),
            slopes: kappa / self.compression_slope,
            stiffness: T::of(6.0) * g / (slope * slope) * kappa * (T::ONE - kappa / self.compression_slope)
                / (whole * j * start),
        };
        let flows = !T::ZERO.at_least(flow.sheared * flow.sheared + trial / start * (trial / start - T::ONE));
        let flows = flows & ((1 << T::SIDE_BY_SIDE) - 1);
        let y = flow.solved(flows);
        let [consolidated, pressed] = flow.pressures(y);
        let most = (self.preconsolidation_pressure + t) * T::of(MOST_TIMES);
        let ellipse = (start * consolidated).min(most);
        let after = T::select(flows, (T::HALF * pressed * consolidated * start).min(ellipse), trial);
        let squared = after * (ellipse - after).max(T::ZERO);
        let left = T::select(flows, q.min(slope * squared.sqrt()), q);
        let compacted_by = y * flow.length * kappa * (T::ONE - flow.slopes);

        let p_after = T::select(flows, after - t, p_before + (before - (p_before + t)) + grows);
        let share = left / q.max(T::EPSILON * T::EPSILON * start);
        // Without flow nothing is taken apart and put together, so that a stress that rests stays as it is.
        let at_rest = elastic + Symmetric::isotropic(pressure(&elastic) - p_after);
        let flown = deviator * share - Symmetric::isotropic(p_after);
        let stress = Symmetric(array(T::ZERO, |i| T::select(flows, flown.0[i], at_rest.0[i])));

        let sheared = (q - left) / (T::of(3.0) * g);
        // The mean of the stress over the step; of the deviator what lies along the flow.
        let past = turned.deviator();
        let along = T::of(1.5) * past.double_dot(&deviator) / q.max(T::EPSILON * T::EPSILON * start);
        let by_shear = T::HALF * (j_before * along + j * left) * sheared;
        let by_volume = (T::HALF * (before + after) - t) * (compacted_by + apart) / whole;
        let q_before = equivalent(&past);
        let by_elasticity =
            kappa / (T::of(6.0) * ratio * whole) * (q_before / before * (left / after) * (after - before));
        let lost = lost + (by_shear + by_volume).max(T::ZERO) + by_elasticity;
        Response { stress, history: [compacted + compacted_by, strain + sheared, lost] }
    }

    #[inline(always)]
    fn strain_energy(&self, _deformation: &Matrix<T>, stress: &Symmetric<T>, _history: &[T; 3]) -> T {
        let t = self.tension_strength;
        let pressed = (pressure(stress) + t).max(t * T::of(LEAST_SHARE));
        let q = equivalent(&stress.deviator());
        let shear = q * q / (T::of(6.0) * self.shear_ratio() * pressed);
        self.swelling_slope / (T::ONE + self.void_ratio) * (pressed - t - t * (pressed / t).ln() + shear)
    }

    #[inline(always)]
    fn dissipation(&self, &[_, _, lost]: &[T; 3]) -> T {
        lost
    }

    /// Of the pressure P_c, above which none is: of clay that is less pressed it is above the stiffness.
    #[inline(always)]
    fn wave_modulus(&self, _deformation: &Matrix<T>, jacobian: T, &[compaction, ..]: &[T; 3]) -> T {
        let [bulk, ratio] = self.stiffest(jacobian, compaction);
        bulk * (T::ONE + T::of(4.0 / 3.0) * ratio)
    }

    #[inline(always)]
    fn shear_modulus(&self, _deformation: &Matrix<T>, jacobian: T, &[compaction, ..]: &[T; 3]) -> T {
        let [bulk, ratio] = self.stiffest(jacobian, compaction);
        bulk * ratio
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::soil::tests::{
        Chance, State, along_axes, in_single_precision, ledger, only_turns, plates_have_a_thickness, pressed,
        random_paths, stiffest_on_paths,
    };
    use crate::material::tests::{hooke, motion_of, sample_gradients};
    use crate::material::{LAWS, Material, NoStretch};

    const M: f64 = 0.9;
    const LAMBDA: f64 = 0.2;
    const KAPPA: f64 = 0.04;
    const FIRST: f64 = 100e3;

    fn given() -> Given {
        Given::from([
            (CRITICAL_SLOPE, M),
            (COMPRESSION_SLOPE, LAMBDA),
            (SWELLING_SLOPE, KAPPA),
            (POISSON_RATIO, 0.3),
            (PRECONSOLIDATION_PRESSURE, FIRST),
            (VOID_RATIO, 1.2),
        ])
    }

    fn law(tension: f64) -> ModifiedCamClay<f64> {
        Declared::build(&given().with("tension_strength", tension)).expect("sound constants")
    }

    fn laws() -> [ModifiedCamClay<f64>; 3] {
        let stiff =
            given().with(SWELLING_SLOPE, 0.005).with(COMPRESSION_SLOPE, 0.05).with(CRITICAL_SLOPE, 1.4);
        [law(1e3), law(1.0), Declared::build(&stiff).expect("sound constants")]
    }

    fn consolidated(law: &ModifiedCamClay<f64>, history: &[f64; 3]) -> f64 {
        law.tension_strength * law.consolidated(history[0]).exp()
    }

    /// q^2/M^2 + P (P - P_c) over P_c^2 and what it is at least; positive outside of the ellipse.
    fn outside(law: &ModifiedCamClay<f64>, state: &State<[f64; 3]>) -> f64 {
        let (c, t) = (consolidated(law, &state.history), law.tension_strength);
        let (p, q) = (state.p() + t, state.q() / law.critical_slope);
        (q * q + p * (p - c)) / (c + 1e-2 * t).powi(2)
    }

    /// Small strain is Hooke's with K = v P/kappa and Poisson's ratio, and flows nowhere.
    #[test]
    fn within_the_ellipse_small_strain_gives_hooke_under_the_pressure() {
        for law in laws() {
            for under in [Symmetric([-50e3, -45e3, -55e3, 2e3, 0.0, 1e3]), Symmetric::ZERO] {
                let bulk_modulus =
                    (1.0 + law.void_ratio) * (pressure(&under) + law.tension_strength) / law.swelling_slope;
                let moduli = Isotropic { bulk_modulus, shear_modulus: law.shear_ratio() * bulk_modulus };
                assert!((moduli.poisson_ratio() - 0.3).abs() < 1e-12);
                for h in sample_gradients() {
                    let h = h * 1e-7;
                    let motion = Motion { stress: under, ..motion_of(Matrix::IDENTITY + h) };
                    let response = law.respond(&motion, &[0.0; 3]);
                    let exact = hooke(&moduli, &h.symmetric_part());
                    let turned = Hypoelastic { elastic: moduli }.stress(&motion) - exact;
                    let found = response.stress - turned;
                    let scale = 1e-5 * bulk_modulus * 1e-7 + 1e-10 * pressure(&under).abs();
                    let near = found.0.iter().zip(exact.0).all(|(s, e)| (s - e).abs() < scale);
                    assert!(near, "{law:?} {found:?} {exact:?}");
                    assert_eq!(response.history[..2], [0.0; 2]);
                }
                let rest = law.respond(&Motion { stress: under, ..motion_of(Matrix::IDENTITY) }, &[0.0; 3]);
                assert_eq!((rest.stress, rest.history), (under, [0.0; 3]));
            }
        }
    }

    /// v = v_n - lambda ln(p/p_n) in normal compression, and kappa for lambda as the pressure is taken off: slopes at
    /// any strain.
    #[test]
    fn lines_of_normal_compression_and_swelling_have_their_slopes() {
        let law = law(1.0);
        let volume = |state: &State<[f64; 3]>| 2.2 * state.motion.jacobian;
        let start = State::under(Symmetric::isotropic(-FIRST));
        let step = |state: State<[f64; 3]>, count: usize, strain: f64| {
            (0..count).fold(state, |state, _| state.moved(&law, along_axes([strain; 3])))
        };
        let slope = |a: &State<[f64; 3]>, b: &State<[f64; 3]>| (volume(a) - volume(b)) / (b.p() / a.p()).ln();
        let some = step(start, 100, -1e-3);
        let most = step(some, 100, -1e-3);
        assert!(most.p() > 5.0 * FIRST, "{}", most.p());
        assert!((slope(&some, &most) / LAMBDA - 1.0).abs() < 1e-5, "{}", slope(&some, &most));
        assert!((slope(&start, &most) / LAMBDA - 1.0).abs() < 1e-5, "{}", slope(&start, &most));
        let less = step(most, 20, 1e-3);
        assert!((slope(&most, &less) / KAPPA - 1.0).abs() < 1e-5, "{}", slope(&most, &less));
        let again = step(less, 20, -1e-3);
        assert!(
            (again.p() / most.p() - 1.0).abs() < 1e-6 && (again.history[0] - most.history[0]).abs() < 1e-9
        );
        // One step of the same volume change.
        let at_once = start.moved(&law, along_axes([most.motion.jacobian.cbrt().ln(); 3]));
        assert!((at_once.p() / most.p() - 1.0).abs() < 1e-6, "{} {}", at_once.p(), most.p());
    }

    /// Clay sheared at constant volume from normal consolidation ends at P = P_0 2^-(1 - kappa/lambda), q = M P; one
    /// that bore four times its pressure ends at the same for P_c0, whatever the way.
    #[test]
    fn undrained_it_ends_in_the_critical_state_of_its_volume() {
        for t in [1.0, 1e3] {
            let law = law(t);
            for over in [1.0, 4.0] {
                let mut state = State::under(Symmetric::isotropic(-FIRST / over));
                let (first, start) = (FIRST + t, FIRST / over + t);
                for _ in 0..6000 {
                    state = state.moved(&law, along_axes([1e-4, 1e-4, -2e-4]));
                }
                // On the line of swelling from P_c0 to P_0 the volume grew by kappa ln(P_c0/P_0).
                let exact =
                    first * (first / start).powf(-KAPPA / LAMBDA) * 2f64.powf(-(1.0 - KAPPA / LAMBDA));
                let found = state.p() + t;
                assert!((found / exact - 1.0).abs() < 1e-3, "{t} {over}: {found} {exact}");
                assert!((state.q() / (M * found) - 1.0).abs() < 1e-3, "{} {found}", state.q());
            }
        }
    }

    /// Under a constant pressure at the sides q = M P = 3 M P_3/(3 - M), and the volume ends on the critical line:
    /// v = v_0 - (lambda - kappa) ln(2 P/P_c0) - kappa ln(P/P_0).
    #[test]
    fn drained_it_ends_in_the_critical_state() {
        let law = law(1.0);
        for over in [1.0, 8.0] {
            let start: State<[f64; 3]> = State::under(Symmetric::isotropic(-FIRST / over));
            let end = pressed(&law, (start, true), (6000, -2e-4), |_| {});
            let (first, side) = (FIRST + 1.0, FIRST / over + 1.0);
            let exact = 3.0 * side / (3.0 - M);
            assert!(((end.p() + 1.0) / exact - 1.0).abs() < 2e-3, "{over}: {} {exact}", end.p());
            assert!((end.q() / (M * exact) - 1.0).abs() < 4e-3, "{over}: {}", end.q());
            let volume = 2.2 - (LAMBDA - KAPPA) * (2.0 * exact / first).ln() - KAPPA * (exact / side).ln();
            assert!(
                (2.2 * end.motion.jacobian - volume).abs() < 2e-3,
                "{over}: {}",
                2.2 * end.motion.jacobian
            );
        }
    }

    #[test]
    fn on_random_paths_the_stress_stays_within_and_flow_dissipates() {
        for law in laws() {
            let start = |chance: &mut Chance| Symmetric::isotropic(-0.5 * FIRST * (1.0 + chance.next()));
            random_paths(&law, start, |before, after| {
                assert!(outside(&law, after) < 1e-7, "{law:?} {before:?} {after:?}");
                assert!(after.history[1] >= before.history[1]);
                assert!(after.p() >= -law.tension_strength);
                // What elasticity gives back, beyond what flow takes.
                let t = law.tension_strength;
                let [a, b] = [before, after].map(|state| (state.p() + t).max(LEAST_SHARE * t));
                let given = law.swelling_slope / (6.0 * law.shear_ratio() * (1.0 + law.void_ratio))
                    * (before.q() * after.q() * (b - a) / (a * b)).min(0.0);
                let fallen = law.dissipation(&after.history) - law.dissipation(&before.history) - given;
                assert!(
                    fallen >= -1e-6 * (given.abs() + law.dissipation(&before.history).abs() + 1.0),
                    "{fallen} {given}"
                );
            });
        }
    }

    #[test]
    fn single_precision_stays_within_too() {
        for law in laws() {
            let law = law.map(|x| x as f32);
            in_single_precision(&law, 50e3, |motion, history| {
                let (p, q) = (pressure(&motion.stress), equivalent(&motion.stress.deviator()));
                let c = law.tension_strength * law.consolidated(history[0]).exp();
                let scale = c + 1e-2 * law.tension_strength;
                let (p, q) = (p + law.tension_strength, q / law.critical_slope);
                (q * q + p * (p - c)) / (scale * scale) * 0.01
            });
        }
    }

    #[test]
    fn it_carries_a_stress_within_the_ellipse() {
        let material = Material::ModifiedCamClay(law(1e3));
        assert!(material.carries_stress());
        let borne = Symmetric([-50e3, -50e3, -70e3, 1e3, 0.0, 0.0]);
        assert_eq!(material.stretch_under(&borne), Ok(Symmetric::isotropic(1.0)));
        for not in [[-50e3, -50e3, -200e3], [-120e3; 3], [2e3; 3]] {
            let not = Symmetric([not[0], not[1], not[2], 0.0, 0.0, 0.0]);
            assert_eq!(material.stretch_under(&not), Err(NoStretch::Yields), "{not:?}");
        }
    }

    #[test]
    fn the_work_is_stored_or_dissipated() {
        for law in laws() {
            for stress in [Symmetric::isotropic(-50e3), Symmetric::isotropic(-FIRST)] {
                let misses = [4000, 8000].map(|steps| ledger(&law, (stress, 0.05), steps));
                assert!(misses[1] < 2e-3, "{law:?}: {misses:?}");
            }
        }
    }

    #[test]
    fn a_step_of_rotation_only_rotates_the_stress() {
        for law in laws() {
            let start = State::under(Symmetric::isotropic(-FIRST));
            only_turns(&law, &start.moved(&law, Matrix::IDENTITY + sample_gradients()[2] * 0.01));
        }
    }

    /// Clay that is pulled apart and has its volume back presses as clay of that volume that was never strong.
    #[test]
    fn clay_that_came_apart_closes_before_it_presses() {
        let law = law(1e3);
        let mut state: State<[f64; 3]> = State::under(Symmetric::isotropic(-10e3));
        let first = state.motion.stress;
        for _ in 0..400 {
            state = state.moved(&law, along_axes([1e-3; 3]));
        }
        assert!((state.p() / law.tension_strength + 1.0).abs() < 0.01, "{}", state.p());
        // v = N - lambda ln(P), with P_c0 on that line and kappa ln(P_c0/P_0) of swelling.
        let (c, before) = (FIRST + 1e3, pressure(&first) + 1e3);
        let exact = |state: &State<[f64; 3]>| {
            c * (c / before).powf(-KAPPA / LAMBDA) * (-2.2 * (state.motion.jacobian - 1.0) / LAMBDA).exp()
        };
        for _ in 0..200 {
            state = state.moved(&law, along_axes([-1e-3; 3]));
            assert!(state.p() < 0.0, "{}", state.p());
        }
        for _ in 0..200 {
            state = state.moved(&law, along_axes([-1e-3; 3]));
            assert!(
                ((state.p() + 1e3) / exact(&state) - 1.0).abs() < 1e-2,
                "{} {}",
                state.p(),
                exact(&state)
            );
        }
    }

    #[test]
    fn the_wave_modulus_is_an_upper_bound() {
        for law in laws() {
            let largest = stiffest_on_paths(&law, Symmetric::isotropic(-FIRST));
            assert!((0.75..1.0 + 1e-4).contains(&largest), "{law:?}: {largest}");
        }
    }

    #[test]
    fn a_thin_plate_of_it_has_a_thickness() {
        for law in laws() {
            plates_have_a_thickness(&law, law.elastic().bulk_modulus);
        }
    }

    #[test]
    fn constants_that_make_no_material_are_refused() {
        let law = LAWS.iter().find(|law| law.name == "modified_cam_clay").expect("a law of the list");
        let sound = law.build(&given()).expect("clay").given();
        assert_eq!(sound.get("tension_strength"), Some(1e3));
        for (key, value) in [
            (CRITICAL_SLOPE, 0.0),
            (COMPRESSION_SLOPE, -0.1),
            (SWELLING_SLOPE, 0.2),
            (SWELLING_SLOPE, 0.0),
            (POISSON_RATIO, 0.5),
            (PRECONSOLIDATION_PRESSURE, 0.0),
            (VOID_RATIO, 0.0),
            ("tension_strength", 0.0),
        ] {
            let bad = law.build(&given().with(key, value)).unwrap_err();
            assert_eq!(bad.key.as_deref(), Some(key), "{key} {value}");
        }
        assert!(law.build(&Given::default()).is_err());
    }
}
