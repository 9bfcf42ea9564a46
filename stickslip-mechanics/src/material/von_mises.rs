//! Elastoplasticity of von Mises with isotropic hardening: elasticity in rate form, [`Hypoelastic`], and a radial
//! return (Wilkins 1964; Simo and Hughes 1998, section 3.3).
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
//!
//! Hardening may saturate (Voce 1948) or follow a table, and the strength may grow with the rate of flow (Cowper and
//! Symonds 1957; as a law of flow, Perzyna 1966):
//!
//! ```text
//! Y   = Y_0 + H a + Q (1 - exp(-b a)),   or straight lines between the points (a_i, Y_i), and constant after the last
//! J q = Y (1 + (a'/D)^(1/n)),   so a' = D (J q/Y - 1)^n where J q > Y, else 0                 a': da/dt
//! ```
//! A step is implicit: its growth x of a solves
//!
//! ```text
//! J q* - 3 G J x = Y(a + x) (1 + y),   x = D dt y^n,   0 <= y <= ((J q* - Y)/(3 G J D dt))^(1/n)
//! ```
//! for y, or with y = 0 for x. The left side falls and the right one grows, so there is one root; Newton's method goes
//! there from the lower end, and halves the bracket where it would leave it. A step without duration has no rate.

use super::declaration::{
    Absent, AllowedRange, BadConstants, Constant, ConstantUnit, Declared, End, Form, Given, NOT_NEGATIVE,
    POSITIVE, PRESSURE, Quantity, RATE, RATIO,
};
use super::{History, Hypoelastic, Isotropic, Law, Motion, Response, elastic};
use crate::column::Kind;
use crate::tensor::{Matrix, Number, Symmetric, array};
use serde::{Serialize, Serializer};

/// Elastoplasticity of von Mises.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct VonMises<T> {
    /// The law below yield.
    #[serde(flatten)]
    pub elastic: Hypoelastic<T>,
    /// Y_0, yield stress in slow uniaxial tension before any flow [Pa].
    pub yield_stress: T,
    /// H, growth of the yield stress by equivalent plastic strain [Pa].
    pub hardening_modulus: T,
    /// Hardening that is no straight line.
    #[serde(flatten)]
    pub hardening: Option<Hardening<T>>,
    /// Growth of the strength with the rate of flow.
    #[serde(flatten)]
    pub rate: Option<Rate<T>>,
}

/// Hardening that is no straight line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Hardening<T> {
    /// Voce's, beside H a.
    Saturating {
        /// Q, growth of the yield stress in the end [Pa].
        saturation_stress: T,
        /// b [-]
        saturation_exponent: T,
    },
    /// By a table, in place of H a.
    Tabulated {
        /// Its points.
        hardening_table: Table<T>,
    },
}

/// Points of equivalent plastic strain and yield stress after that of Y_0 at no strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Table<T> {
    /// a_i [-]
    strains: [T; MOST_POINTS],
    /// Y_i [Pa]
    stresses: [T; MOST_POINTS],
    count: usize,
}

/// Growth of the strength with the rate of flow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rate<T> {
    /// D, rate of equivalent plastic strain at which the strength is twice the slow one [1/s].
    pub reference_rate: T,
    /// n [-]
    pub rate_exponent: T,
}

/// Most points of a table.
const MOST_POINTS: usize = 8;

/// Names of the constants of flow in scene files.
const YIELD_STRESS: &str = "yield_stress";
const HARDENING_MODULUS: &str = "hardening_modulus";
const SATURATION_STRESS: &str = "saturation_stress";
const SATURATION_EXPONENT: &str = "saturation_exponent";
const HARDENING_TABLE: &str = "hardening_table";
const REFERENCE_RATE: &str = "reference_rate";
const RATE_EXPONENT: &str = "rate_exponent";

/// What a particle remembers: the second only where the rate counts.
const HISTORY: [History; 2] = [
    History::new("plastic_strain", "", Kind::Number),
    History::new("plastic_dissipation", "J/m^3", Kind::Number),
];

/// Trials of a step at most; most take two to five.
const MOST_TRIALS: usize = 60;
/// From which trial on every fourth one halves the bracket.
const PATIENCE: usize = 10;
/// What is raised to no power, and no step of flow is slower than.
const LEAST: f64 = 1e-30;

const EXPONENTS: AllowedRange = AllowedRange {
    from: End::At(1.0),
    to: End::At(100.0),
    because: ", for below 1 strength would grow ever faster with the rate",
};

/// A number that may be missing.
const fn judged(
    name: &'static str,
    summary: &'static str,
    (unit, bounds): (ConstantUnit, AllowedRange),
) -> Constant {
    Constant { name, summary, form: Form::Number(Quantity { name, unit, bounds }), absent: Absent::Judged }
}

impl Table<f64> {
    /// The table of these pairs of strain [-] and stress [Pa], at most eight.
    pub fn new(pairs: &[[f64; 2]]) -> Self {
        let mut table = Table { strains: [0.0; MOST_POINTS], stresses: [0.0; MOST_POINTS], count: 0 };
        for &[strain, stress] in &pairs[..pairs.len().min(MOST_POINTS)] {
            (table.strains[table.count], table.stresses[table.count]) = (strain, stress);
            table.count += 1;
        }
        table
    }
}

impl<T: Serialize> Serialize for Table<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq((0..self.count).map(|i| [&self.strains[i], &self.stresses[i]]))
    }
}

impl Declared for VonMises<f64> {
    const SUMMARY: &'static str = "Plastic flow at a yield stress that may harden, elastic below it as the \
                                   hypoelastic law, for metals and clay.";
    const CONSTANTS: &'static [Constant] = &elastic::and::<7, 12>([
        Constant::required(
            YIELD_STRESS,
            "Yield stress in slow uniaxial tension before any flow, Y_0.",
            (PRESSURE, POSITIVE),
            "\"40 MPa\"",
        ),
        Constant::optional(
            HARDENING_MODULUS,
            "Growth of the yield stress by equivalent plastic strain, H; none without it.",
            (PRESSURE, NOT_NEGATIVE.because(", for softening would follow the grid")),
            0.0,
        ),
        judged(
            SATURATION_STRESS,
            "Growth of the yield stress that saturates, after Voce, Q of Q (1 - exp(-b a)); none without it.",
            (PRESSURE, POSITIVE),
        ),
        judged(SATURATION_EXPONENT, "How fast it saturates with plastic strain, b.", (RATIO, POSITIVE)),
        Constant {
            name: HARDENING_TABLE,
            summary: "Yield stress by equivalent plastic strain in place of other hardening: up to eight pairs of \
                      strain and stress after the yield_stress at no strain, such as [[0.02, \"60 MPa\"], \
                      [0.1, \"75 MPa\"]].",
            form: Form::Pairs(
                [
                    Quantity {
                        name: "plastic strain",
                        unit: RATIO,
                        bounds: POSITIVE.because(", for at none stands the yield_stress"),
                    },
                    Quantity { name: "stress", unit: PRESSURE, bounds: POSITIVE },
                ],
                MOST_POINTS,
            ),
            absent: Absent::Judged,
        },
        judged(
            REFERENCE_RATE,
            "Rate of plastic strain at which the strength is twice the slow one, D of Cowper and Symonds; without it \
             no rate counts.",
            (RATE, POSITIVE),
        ),
        judged(RATE_EXPONENT, "Exponent n of the rate of flow D (q/Y - 1)^n.", (RATIO, EXPONENTS)),
    ]);

    fn build(given: &Given) -> Result<Self, BadConstants> {
        let elastic = Isotropic::build(given)?;
        if elastic.shear_modulus == 0.0 {
            return Err(BadConstants::together("G = 0", "G above 0: a fluid has nothing that yields"));
        }
        let (yield_stress, hardening_modulus) = (given.number(YIELD_STRESS), given.number(HARDENING_MODULUS));
        let rate = both(given, [REFERENCE_RATE, RATE_EXPONENT])?
            .map(|[reference_rate, rate_exponent]| Rate { reference_rate, rate_exponent });
        let hardening = Hardening::build(given)?;
        Ok(VonMises { elastic: Hypoelastic { elastic }, yield_stress, hardening_modulus, hardening, rate })
    }

    fn given(&self) -> Given {
        let elastic = self.elastic.given();
        let mut given =
            elastic.with(YIELD_STRESS, self.yield_stress).with(HARDENING_MODULUS, self.hardening_modulus);
        match self.hardening {
            None => {}
            Some(Hardening::Saturating { saturation_stress, saturation_exponent }) => {
                given = given
                    .with(SATURATION_STRESS, saturation_stress)
                    .with(SATURATION_EXPONENT, saturation_exponent);
            }
            Some(Hardening::Tabulated { hardening_table: Table { strains, stresses, count } }) => {
                given.put(HARDENING_TABLE, (0..count).flat_map(|i| [strains[i], stresses[i]]).collect());
            }
        }
        match self.rate {
            None => given,
            Some(Rate { reference_rate, rate_exponent }) => {
                given.with(REFERENCE_RATE, reference_rate).with(RATE_EXPONENT, rate_exponent)
            }
        }
    }

    fn elastic(&self) -> Isotropic<f64> {
        self.elastic.elastic
    }
}

/// Two constants that hold together, or neither.
fn both(given: &Given, names: [&str; 2]) -> Result<Option<[f64; 2]>, BadConstants> {
    match names.map(|name| given.get(name)) {
        [Some(one), Some(other)] => Ok(Some([one, other])),
        [None, None] => Ok(None),
        [one, other] => {
            let (here, missing) = if one.is_some() { (names[0], names[1]) } else { (names[1], names[0]) };
            let found = format!("{}, but no {missing}", one.or(other).expect("one of them"));
            Err(BadConstants::of(here, found, format!("{} and {} together, or neither", names[0], names[1])))
        }
    }
}

impl Hardening<f64> {
    /// What is given of it.
    fn build(given: &Given) -> Result<Option<Self>, BadConstants> {
        let saturating = both(given, [SATURATION_STRESS, SATURATION_EXPONENT])?.map(
            |[saturation_stress, saturation_exponent]| Hardening::Saturating {
                saturation_stress,
                saturation_exponent,
            },
        );
        let pairs = given.pairs(HARDENING_TABLE);
        if pairs.is_empty() {
            return Ok(saturating);
        }
        let bad =
            |found: String, allowed: &str| Err(BadConstants::of(HARDENING_TABLE, found, allowed.to_string()));
        if let Some(other) = [HARDENING_MODULUS, SATURATION_STRESS]
            .into_iter()
            .find(|name| given.get(name).is_some_and(|value| value > 0.0))
        {
            return bad(
                format!("a table beside {other}"),
                "one of them: the table is the whole curve of hardening",
            );
        }
        let mut before = [0.0, given.number(YIELD_STRESS)];
        for &[strain, stress] in pairs {
            if strain <= before[0] {
                return bad(
                    format!("plastic strain {strain} after {}", before[0]),
                    "plastic strains that grow",
                );
            }
            if stress < before[1] {
                return bad(
                    format!("stress {stress} Pa after {} Pa", before[1]),
                    "stresses from the yield_stress on that do not fall, for softening would follow the grid",
                );
            }
            before = [strain, stress];
        }
        Ok(Some(Hardening::Tabulated { hardening_table: Table::new(pairs) }))
    }
}

impl<T: Number> VonMises<T> {
    /// The same constants in other numbers.
    #[inline(always)]
    pub fn map<U: Number>(&self, f: impl Fn(T) -> U) -> VonMises<U> {
        VonMises {
            yield_stress: f(self.yield_stress),
            hardening_modulus: f(self.hardening_modulus),
            hardening: self.hardening.as_ref().map(|hardening| match hardening {
                Hardening::Saturating { saturation_stress, saturation_exponent } => Hardening::Saturating {
                    saturation_stress: f(*saturation_stress),
                    saturation_exponent: f(*saturation_exponent),
                },
                Hardening::Tabulated { hardening_table: Table { strains, stresses, count } } => {
                    let hardening_table = Table {
                        strains: array(U::ZERO, |i| f(strains[i])),
                        stresses: array(U::ZERO, |i| f(stresses[i])),
                        count: *count,
                    };
                    Hardening::Tabulated { hardening_table }
                }
            }),
            rate: self.rate.as_ref().map(|rate| Rate {
                reference_rate: f(rate.reference_rate),
                rate_exponent: f(rate.rate_exponent),
            }),
            elastic: Hypoelastic { elastic: self.elastic.elastic.map(f) },
        }
    }
}

impl<T: Number> Table<T> {
    /// Points from the one at no strain on, each with the next; after the last a straight line that does not rise.
    #[inline(always)]
    fn lines(&self, yield_stress: T) -> impl Iterator<Item = [[T; 2]; 2]> {
        let point = move |i: usize| match i {
            0 => [T::ZERO, yield_stress],
            _ => [self.strains[i - 1], self.stresses[i - 1]],
        };
        (0..=self.count).map(move |i| {
            let [strain, stress] = point(i);
            [[strain, stress], if i < self.count { point(i + 1) } else { [strain + T::ONE, stress] }]
        })
    }

    /// Y and its slope [Pa].
    #[inline(always)]
    fn strength(&self, strain: T, yield_stress: T) -> [T; 2] {
        let (mut from, mut to) = ([T::ZERO; 2], [T::ONE; 2]);
        for line in self.lines(yield_stress) {
            let reached = strain.at_least(line[0][0]);
            for k in 0..2 {
                from[k] = T::select(reached, line[0][k], from[k]);
                to[k] = T::select(reached, line[1][k], to[k]);
            }
        }
        let slope = (to[1] - from[1]) / (to[0] - from[0]);
        [from[1] + slope * (strain - from[0]), slope]
    }

    /// Integral of Y da [Pa].
    #[inline(always)]
    fn dissipation(&self, strain: T, yield_stress: T) -> T {
        let mut sum = T::ZERO;
        for (i, [from, to]) in self.lines(yield_stress).enumerate() {
            let past = (strain - from[0]).max(T::ZERO);
            let width = to[0] - from[0];
            let within = if i < self.count { past.min(width) } else { past };
            let slope = (to[1] - from[1]) / width;
            sum += (from[1] + T::HALF * slope * within) * within;
        }
        sum
    }
}

/// A particle before its plastic step.
#[derive(Clone, Copy, Debug)]
struct Before<T> {
    /// a [-]
    strain: T,
    /// J q* [Pa]
    trial: T,
    /// 3 G J [Pa]
    stiffness: T,
    /// [s]
    dt: T,
}

/// A trial of a step.
#[derive(Clone, Copy, Debug)]
struct Tried<T> {
    /// x [-]
    growth: T,
    /// By how much the elastic side is above that of strength [Pa].
    off: T,
    /// How fast that falls [Pa].
    slope: T,
}

impl<T: Number> VonMises<T> {
    /// Y and its slope [Pa].
    #[inline(always)]
    fn strength(&self, strain: T) -> [T; 2] {
        let linear = self.yield_stress + self.hardening_modulus * strain;
        match &self.hardening {
            None => [linear, self.hardening_modulus],
            Some(Hardening::Saturating { saturation_stress, saturation_exponent }) => {
                let left = *saturation_stress * (-(*saturation_exponent * strain)).exp();
                let hardened = linear + (*saturation_stress - left);
                [hardened, self.hardening_modulus + *saturation_exponent * left]
            }
            Some(Hardening::Tabulated { hardening_table }) => {
                hardening_table.strength(strain, self.yield_stress)
            }
        }
    }

    /// D dt, or 1 of a step without duration, and 1 where the rate counts, else 0.
    #[inline(always)]
    fn slow_strain(rate: &Rate<T>, dt: T) -> [T; 2] {
        let slow = rate.reference_rate * dt;
        let sudden = T::ZERO.at_least(slow);
        [T::select(sudden, T::ONE, slow.max(T::of(LEAST))), T::select(sudden, T::ZERO, T::ONE)]
    }

    /// The equation of a step at this y, or at this x where no rate counts.
    #[inline(always)]
    fn tried(&self, before: &Before<T>, unknown: T) -> Tried<T> {
        let Some(rate) = &self.rate else {
            let [strength, slope] = self.strength(before.strain + unknown);
            let off = before.trial - before.stiffness * unknown - strength;
            return Tried { growth: unknown, off, slope: before.stiffness + slope };
        };
        let [slow, counts] = Self::slow_strain(rate, before.dt);
        let n = rate.rate_exponent;
        // x/y
        let part = slow * ((n - T::ONE) * unknown.max(T::of(LEAST)).ln()).exp();
        let growth = part * unknown;
        let over = T::ONE + counts * unknown;
        let [strength, slope] = self.strength(before.strain + growth);
        let off = before.trial - before.stiffness * growth - strength * over;
        Tried { growth, off, slope: (before.stiffness + slope * over) * n * part + strength * counts }
    }

    /// Growth of a in the step, of each lane by itself.
    #[inline(always)]
    fn growth(&self, before: &Before<T>) -> T {
        let [start, slope] = self.strength(before.strain);
        let excess = (before.trial - start).max(T::ZERO);
        let mut searching = ((1 << T::SIDE_BY_SIDE) - 1) & !T::ZERO.at_least(excess);
        if searching == 0 {
            return T::ZERO;
        }
        let elastic = excess / before.stiffness;
        let (mut high, slope) = match &self.rate {
            None => (elastic, before.stiffness + slope),
            Some(rate) => {
                let [slow, counts] = Self::slow_strain(rate, before.dt);
                let share = (elastic / slow).max(T::of(LEAST));
                (
                    (share.ln() / rate.rate_exponent).exp() * (T::ONE + T::of(64.0) * T::EPSILON),
                    start * counts,
                )
            }
        };
        let (mut low, mut unknown) = (T::ZERO, (excess / slope).min(high));
        // Round-off may be above what the search ends by, so the best trial counts.
        let (mut growth, mut best) = (T::ZERO, before.trial);
        for count in 0..MOST_TRIALS {
            let Tried { growth: found, off, slope } = self.tried(before, unknown);
            let better = searching & best.at_least(off.abs());
            growth = T::select(better, found, growth);
            best = T::select(better, off.abs(), best);
            let short = off.at_least(T::ZERO);
            low = T::select(short, unknown, low);
            high = T::select(short, high, unknown);
            let sound = (T::of(4.0) * T::EPSILON * before.trial).at_least(off.abs());
            let shut = (T::of(2.0) * T::EPSILON * high).at_least(high - low);
            let newton = unknown + off / slope;
            let rests = (T::of(4.0) * T::EPSILON * unknown).at_least((newton - unknown).abs());
            searching &= !(sound | shut | rests);
            if searching == 0 {
                break;
            }
            let inside = newton.at_least(low) & high.at_least(newton);
            let halves = count >= PATIENCE && count % 4 == 2;
            let next = T::select(if halves { 0 } else { inside }, newton, T::HALF * (low + high));
            unknown = T::select(searching, next, unknown);
        }
        growth.min(elastic)
    }
}

impl<T: Number> Law<T> for VonMises<T> {
    /// Equivalent plastic strain, sqrt(2/3 D_p : D_p) over time, and W_p where it does not follow from that.
    type History = [T; 2];

    #[inline(always)]
    fn history(&self) -> &'static [History] {
        match self.rate {
            Some(_) => &HISTORY,
            None => &HISTORY[..1],
        }
    }

    /// Plastic flow resists no error of F.
    #[inline(always)]
    fn trusts_deformation(&self) -> bool {
        false
    }

    #[inline(always)]
    fn respond(&self, motion: &Motion<T>, &[plastic_strain, lost]: &[T; 2]) -> Response<T, [T; 2]> {
        let three_g = T::of(3.0) * self.elastic.elastic.shear_modulus;
        let trial = self.elastic.stress(motion);
        let deviator = trial.deviator();
        let q = (T::of(1.5) * deviator.double_dot(&deviator)).sqrt();
        let mut work = lost;
        let flow = match (&self.hardening, &self.rate) {
            (None, None) => {
                let allowed = self.yield_stress + self.hardening_modulus * plastic_strain;
                let excess = (motion.jacobian * q - allowed).max(T::ZERO);
                excess / (three_g * motion.jacobian + self.hardening_modulus)
            }
            _ => {
                let (trial, stiffness) = (motion.jacobian * q, three_g * motion.jacobian);
                let before = Before { strain: plastic_strain, trial, stiffness, dt: motion.dt };
                let growth = self.growth(&before);
                work += (trial - stiffness * growth) * growth;
                growth
            }
        };
        // Without excess nothing is divided: a stress without deviator stays as it is.
        let share = three_g * flow / q.max(T::EPSILON * self.yield_stress);
        Response { stress: trial - deviator * share, history: [plastic_strain + flow, work] }
    }

    #[inline(always)]
    fn strain_energy(&self, deformation: &Matrix<T>, stress: &Symmetric<T>, _history: &[T; 2]) -> T {
        self.elastic.strain_energy(deformation, stress, &[])
    }

    #[inline(always)]
    fn dissipation(&self, &[plastic_strain, work]: &[T; 2]) -> T {
        if self.rate.is_some() {
            return work;
        }
        let linear = (self.yield_stress + T::HALF * self.hardening_modulus * plastic_strain) * plastic_strain;
        match &self.hardening {
            None => linear,
            Some(Hardening::Saturating { saturation_stress, saturation_exponent }) => {
                let decayed = T::ONE - (-(*saturation_exponent * plastic_strain)).exp();
                let part = (plastic_strain - decayed / *saturation_exponent).max(T::ZERO);
                linear + *saturation_stress * part
            }
            Some(Hardening::Tabulated { hardening_table }) => {
                hardening_table.dissipation(plastic_strain, self.yield_stress)
            }
        }
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
    use crate::material::tests::{follow, motion_of, rotation, sample_gradients};
    use crate::material::trials::{
        Chance, answers_are_numbers, lanes_know_nothing_of_each_other, plates_have_a_thickness,
    };

    const LAW: VonMises<f64> = VonMises {
        elastic: Hypoelastic { elastic: Isotropic { bulk_modulus: 600.0, shear_modulus: 300.0 } },
        yield_stress: 0.9,
        hardening_modulus: 3.0,
        hardening: None,
        rate: None,
    };
    const VOCE: VonMises<f64> = VonMises {
        hardening: Some(Hardening::Saturating { saturation_stress: 0.6, saturation_exponent: 15.0 }),
        ..LAW
    };
    const RATE: Rate<f64> = Rate { reference_rate: 40.0, rate_exponent: 5.0 };
    const NONE: [f64; 2] = [0.0; 2];

    fn tabulated() -> VonMises<f64> {
        let pairs = [[0.01, 1.1], [0.05, 1.5], [0.2, 1.5], [0.3, 2.5]];
        let hardening = Some(Hardening::Tabulated { hardening_table: Table::new(&pairs) });
        VonMises { hardening_modulus: 0.0, hardening, ..LAW }
    }

    /// All kinds of hardening, without and with a rate.
    fn laws() -> Vec<VonMises<f64>> {
        let slow = [LAW, VOCE, tabulated()];
        let fast = slow.map(|law| VonMises { rate: Some(RATE), ..law });
        let linear = VonMises { rate: Some(Rate { reference_rate: 40.0, rate_exponent: 1.0 }), ..LAW };
        let steep = VonMises { rate: Some(Rate { reference_rate: 1e3, rate_exponent: 100.0 }), ..VOCE };
        slow.into_iter().chain(fast).chain([linear, steep]).collect()
    }

    /// A bar that keeps its volume, by its logarithmic strain.
    fn bar(strain: f64) -> Matrix<f64> {
        let (along, across) = (strain.exp(), (-0.5 * strain).exp());
        Matrix([[along, 0.0, 0.0], [0.0, across, 0.0], [0.0, 0.0, across]])
    }

    fn equivalent(stress: &Symmetric<f64>) -> f64 {
        let s = stress.deviator();
        (1.5 * s.double_dot(&s)).sqrt()
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
    fn beyond_yield_the_stress_stays_on_the_surface() {
        for law in [LAW, VOCE, tabulated()] {
            for h in sample_gradients() {
                let (end, [plastic_strain, _], _) = follow(&law, (50, 1.0), |t| Matrix::IDENTITY + h * t);
                let [allowed, _] = law.strength(plastic_strain);
                assert!(plastic_strain > 0.01, "{plastic_strain}");
                assert!((end.jacobian * equivalent(&end.stress) / allowed - 1.0).abs() < 1e-12);
            }
        }
    }

    /// Y_0 + H a + Q (1 - exp(-b a)), by the textbook's formula.
    #[test]
    fn voces_bar_bears_the_formula() {
        for strain in [0.01f64, 0.1, 0.5] {
            let (end, [a, _], _) = follow(&VOCE, (200, 1.0), |t| bar(strain * t));
            let exact = 0.9 + 3.0 * a + 0.6 * (1.0 - (-15.0 * a).exp());
            assert!((equivalent(&end.stress) / exact - 1.0).abs() < 1e-10, "{strain} {a}");
            assert!((a - (strain - exact / 900.0)).abs() < 1e-6, "{strain} {a}");
        }
    }

    /// The curve goes through its points and is straight between them; of straight hardening it is von Mises' law.
    #[test]
    fn a_table_goes_through_its_points() {
        let law = tabulated();
        for (strain, stress) in [
            (0.0, 0.9),
            (0.005, 1.0),
            (0.01, 1.1),
            (0.03, 1.3),
            (0.1, 1.5),
            (0.2, 1.5),
            (0.25, 2.0),
            (0.3, 2.5),
        ] {
            assert!((law.strength(strain)[0] - stress).abs() < 1e-12, "{strain}");
        }
        assert_eq!(law.strength(7.0), [2.5, 0.0]);
        // Areas of the trapezoids by hand.
        let exact = 0.01 * 1.0 + 0.04 * 1.3 + 0.15 * 1.5 + 0.1 * 2.0 + 0.7 * 2.5;
        assert!((law.dissipation(&[1.0, 0.0]) - exact).abs() < 1e-12);
        let table = Table::new(&[[0.5, 0.9 + 1.5], [2.0, 0.9 + 6.0]]);
        let straight = VonMises {
            hardening_modulus: 0.0,
            hardening: Some(Hardening::Tabulated { hardening_table: table }),
            ..LAW
        };
        for h in sample_gradients() {
            let path = |t: f64| Matrix::IDENTITY + h * (6.0 * t);
            let (end, [strain, _], _) = follow(&straight, (50, 1.0), path);
            let (exact, [linear, _], _) = follow(&LAW, (50, 1.0), path);
            assert!((strain / linear - 1.0).abs() < 1e-10 && strain > 0.1, "{strain} {linear}");
            assert!(end.stress.0.iter().zip(exact.stress.0).all(|(s, e)| (s - e).abs() < 1e-10));
        }
    }

    /// Flow at rates from D/1000 to 1000 D: Y (1 + (a'/D)^(1/n)), with the a' of the last step.
    #[test]
    fn a_bar_at_a_rate_bears_what_cowper_and_symonds_say() {
        for slow in [LAW, VOCE, tabulated()] {
            for (rate_exponent, share) in
                [1.0, 5.0, 20.0].into_iter().flat_map(|n| [1e-3, 1.0, 1e3].map(|r| (n, r)))
            {
                let law = VonMises { rate: Some(Rate { rate_exponent, ..RATE }), ..slow };
                // Strength a thousand times the slow one takes elastic strain of its own.
                let strain = if rate_exponent == 1.0 && share > 1.0 { 4.0 } else { 0.25 };
                let (steps, rate) = (2000, 40.0 * share);
                let until = |last: usize| {
                    let strained = strain * last as f64 / steps as f64;
                    follow(&law, (last, strained / rate), |t| bar(strained * t))
                };
                let (end, [a, _], _) = until(steps);
                let (_, [b, _], _) = until(steps - 1);
                let flows = (a - b) / (strain / rate / steps as f64);
                assert!(flows > 0.1 * rate && flows < 1.1 * rate, "{rate_exponent} {share}: {flows}");
                let exact = law.strength(a)[0] * (1.0 + (flows / 40.0).powf(1.0 / rate_exponent));
                assert!((equivalent(&end.stress) / exact - 1.0).abs() < 1e-6, "{rate_exponent} {share}");
            }
        }
    }

    /// Held at its strain, stress relaxes by 3 G D (q/Y - 1)^n, here in ten thousand explicit steps.
    #[test]
    fn a_bar_that_is_held_relaxes_by_the_law_of_flow() {
        let rate = Rate { reference_rate: 40.0, rate_exponent: 3.0 };
        let law = VonMises { hardening_modulus: 0.0, rate: Some(rate), ..LAW };
        let duration = 1e-3;
        let sudden = Motion { dt: 1e-12, ..motion_of(bar(0.003)) };
        let first = law.respond(&sudden, &NONE);
        let (mut stress, mut history) = (first.stress, first.history);
        let mut q = equivalent(&stress);
        assert!(q > 2.5, "nothing flows in no time: {q}");
        for _ in 0..4000 {
            let still = Motion { increment: Matrix::IDENTITY, stress, dt: duration / 4000.0, ..sudden };
            let after = law.respond(&still, &history);
            (stress, history) = (after.stress, after.history);
        }
        for _ in 0..10_000 {
            q -= duration / 10_000.0 * 900.0 * 40.0 * (q / 0.9 - 1.0).powi(3);
        }
        assert!(q < 1.3 && (equivalent(&stress) / q - 1.0).abs() < 1e-3, "{} {q}", equivalent(&stress));
    }

    /// A fast rate law in slow motion is the law without rate, and a step without duration has no rate.
    #[test]
    fn slow_flow_has_no_rate() {
        for slow in [LAW, VOCE, tabulated()] {
            let law = VonMises { rate: Some(Rate { reference_rate: 1e12, rate_exponent: 1.0 }), ..slow };
            for h in sample_gradients() {
                let path = |t: f64| Matrix::IDENTITY + h * t;
                let (end, _, _) = follow(&law, (50, 1.0), path);
                let (exact, _, _) = follow(&slow, (50, 1.0), path);
                assert!(end.stress.0.iter().zip(exact.stress.0).all(|(s, e)| (s - e).abs() < 1e-9));
            }
            let fast = VonMises { rate: Some(RATE), ..slow };
            let sudden = Motion { dt: 0.0, ..motion_of(bar(0.1)) };
            let [found, exact] = [fast, slow].map(|law| law.respond(&sudden, &NONE));
            assert!((found.history[0] / exact.history[0] - 1.0).abs() < 1e-12);
        }
    }

    /// A step's equation holds to round-off whatever its constants, in 100,000 steps.
    #[test]
    fn the_search_solves_every_step() {
        let mut chance = Chance(5);
        for trial in 0..100_000 {
            let mut decade = |least: f64, most: f64| 10f64.powf(least + (most - least) * chance.number());
            let hardening = match trial % 3 {
                0 => None,
                1 => Some(Hardening::Saturating {
                    saturation_stress: decade(-3.0, 3.0),
                    saturation_exponent: decade(-1.0, 6.0),
                }),
                _ => {
                    let strains = [decade(-6.0, 0.0), decade(-6.0, 0.0), decade(-6.0, 0.0)];
                    let stresses = [decade(-4.0, 3.0), decade(-4.0, 3.0), decade(-4.0, 3.0)];
                    let pair = |i: usize| {
                        [strains[..=i].iter().sum::<f64>(), 0.9 + stresses[..=i].iter().sum::<f64>()]
                    };
                    Some(Hardening::Tabulated { hardening_table: Table::new(&[pair(0), pair(1), pair(2)]) })
                }
            };
            let rate = Rate { reference_rate: decade(-6.0, 6.0), rate_exponent: decade(0.0, 2.0) };
            let hardening_modulus = if trial % 3 == 2 { 0.0 } else { decade(-3.0, 3.0) };
            let law =
                VonMises { hardening_modulus, hardening, rate: (trial % 2 == 0).then_some(rate), ..LAW };
            let strain = [0.0, decade(-12.0, 0.5)][trial / 6 % 2];
            let dt = decade(-12.0, 0.0);
            let start = law.strength(strain)[0];
            let before = Before { strain, trial: start * (1.0 + decade(-6.0, 3.0)), stiffness: 900.0, dt };
            let growth = law.growth(&before);
            // Below that a power has no root any more.
            if law.rate.is_some() && growth < 1e-290 {
                assert!(growth >= 0.0 && before.trial < start * (1.0 + 1e-2), "{law:?} {before:?} {growth}");
                continue;
            }
            let over = law
                .rate
                .map_or(0.0, |rate| (growth / (rate.reference_rate * dt)).powf(1.0 / rate.rate_exponent));
            let off = before.trial - 900.0 * growth - law.strength(strain + growth)[0] * (1.0 + over);
            // What round-off of the strain, and of the root that it is a power of, is worth.
            let roots = 1.0 + law.rate.map_or(0.0, |rate| rate.rate_exponent);
            let worth = (900.0 + law.strength(strain + growth)[1] * (1.0 + over)) * (strain + roots * growth);
            let size = match law.hardening {
                Some(Hardening::Saturating { saturation_stress, .. }) => before.trial + saturation_stress,
                _ => before.trial,
            };
            let allowed = 1e-14 * size + 4.0 * f64::EPSILON * worth;
            assert!(growth >= 0.0 && off.abs() < allowed, "{off} {allowed} {law:?} {before:?} {growth}");
        }
    }

    /// With little change of volume, for the rate form's energy of that is exact only where it is small.
    #[test]
    fn the_work_is_stored_or_dissipated() {
        for law in laws() {
            for h in sample_gradients() {
                let motion = |t: f64| {
                    let f = Matrix::IDENTITY + h * t;
                    f * ((1.0 + 1e-3 * t) / f.det().cbrt())
                };
                let (end, history, work) = follow(&law, (4000, 0.01), motion);
                let stored = law.strain_energy(&end.deformation, &end.stress, &history);
                let dissipated = law.dissipation(&history);
                assert!(law.rate.is_some() || dissipated > 0.9 * work, "{dissipated} of {work}");
                assert!(
                    ((stored + dissipated) / work - 1.0).abs() < 1e-3,
                    "{law:?} {stored} + {dissipated}, {work}"
                );
            }
        }
    }

    #[test]
    fn flow_never_gives_energy_back() {
        let mut chance = Chance(3);
        for law in laws() {
            for path in 0..400 {
                let size = [1e-4, 1e-2, 0.3][path % 3];
                let (mut f, mut stress, mut history) = (Matrix::IDENTITY, Symmetric::ZERO, NONE);
                for _ in 0..8 {
                    let increment = chance.deformation(size);
                    f = increment * f;
                    let dt = [1e-9, 1e-3, 10.0][path / 3 % 3];
                    let motion = Motion { deformation: f, jacobian: f.det(), increment, stress, dt };
                    let after = law.respond(&motion, &history);
                    assert!(after.history[0] >= history[0]);
                    assert!(law.dissipation(&after.history) >= law.dissipation(&history), "{law:?}");
                    (stress, history) = (after.stress, after.history);
                }
            }
        }
    }

    #[test]
    fn a_step_of_rotation_only_rotates_the_stress() {
        for law in [LAW, VOCE, tabulated()] {
            let (before, history, _) =
                follow(&law, (50, 1.0), |t| Matrix::IDENTITY + sample_gradients()[2] * t);
            let q = rotation();
            let motion = Motion { deformation: q * before.deformation, increment: q, ..before };
            let after = law.respond(&motion, &history);
            for (s, e) in after.stress.0.iter().zip(before.stress.rotated(&q).0) {
                assert!((s - e).abs() < 1e-12, "{s} {e}");
            }
            assert!((after.history[0] - history[0]).abs() < 1e-12);
        }
    }

    /// Of the motion beforehand turned as a whole, the stress is that turned.
    #[test]
    fn a_turned_motion_has_a_turned_stress() {
        let q = rotation();
        for law in laws() {
            for h in sample_gradients() {
                let motion = motion_of(Matrix::IDENTITY + h);
                let turned = q * motion.deformation * q.transpose();
                let [one, other] = [motion.deformation, turned].map(|f| law.respond(&motion_of(f), &NONE));
                let exact = one.stress.rotated(&q);
                assert!(other.stress.0.iter().zip(exact.0).all(|(s, e)| (s - e).abs() < 1e-10), "{law:?}");
                assert!((one.history[0] - other.history[0]).abs() < 1e-12);
            }
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
            // Of steel in Pa.
            let si = VonMises {
                elastic: Hypoelastic { elastic: Isotropic { bulk_modulus: 160e9, shear_modulus: 80e9 } },
                yield_stress: 250e6,
                hardening_modulus: law.hardening_modulus * 1e9,
                hardening: match law.hardening {
                    Some(Hardening::Saturating { .. }) => {
                        Some(Hardening::Saturating { saturation_stress: 150e6, saturation_exponent: 15.0 })
                    }
                    Some(Hardening::Tabulated { .. }) => Some(Hardening::Tabulated {
                        hardening_table: Table::new(&[[0.01, 300e6], [0.3, 500e6]]),
                    }),
                    None => None,
                },
                ..law
            };
            answers_are_numbers(&si.map(|x| x as f32), 5_000);
        }
    }

    /// The tangent of a step along any axis is below the elastic one.
    #[test]
    fn no_wave_is_faster_than_the_elastic_one() {
        let mut chance = Chance(9);
        for law in laws() {
            for size in [1e-4, 1e-2, 0.2] {
                for _ in 0..20 {
                    let h = chance.matrix() * size;
                    let (before, history, _) = follow(&law, (20, 1e-3), |t| Matrix::IDENTITY + h * t);
                    let n = chance.direction();
                    let along = |e: f64| {
                        let increment = Matrix::IDENTITY + Matrix::from_fn(|i, j| e * n[i] * n[j]);
                        let deformation = increment * before.deformation;
                        let motion = Motion { deformation, jacobian: deformation.det(), increment, ..before };
                        let stress = law.respond(&motion, &history).stress;
                        (0..9).map(|k| n[k / 3] * n[k % 3] * stress.at(k / 3, k % 3)).sum::<f64>()
                    };
                    let e = 1e-6;
                    let tangent = before.jacobian * (along(e) - along(-e)) / (2.0 * e);
                    let modulus = law.wave_modulus(&before.deformation, before.jacobian, &history);
                    assert!(tangent < modulus * (1.0 + 1e-4), "{law:?} {size}: {tangent} {modulus}");
                }
            }
        }
    }

    #[test]
    fn constants_that_make_no_material_are_refused() {
        let law = LAWS.iter().find(|law| law.name == "von_mises").expect("a law of the list");
        let elastic = || Given::from([("bulk_modulus", 6.0), ("shear_modulus", 3.0)]);
        let with = |more: &[(&str, f64)]| {
            law.build(&more.iter().fold(elastic(), |given, &(name, value)| given.with(name, value)))
        };
        let plain = with(&[("yield_stress", 1.0)]).unwrap();
        assert_eq!(plain.given().get("hardening_modulus"), Some(0.0));
        assert_eq!((plain.given().get(SATURATION_STRESS), plain.history().len()), (None, 1));
        let rate = [(YIELD_STRESS, 1.0), (REFERENCE_RATE, 40.0), (RATE_EXPONENT, 5.0)];
        assert_eq!(with(&rate).unwrap().history().len(), 2);
        for (constants, key) in [
            (&[][..], None),
            (&[("yield_stress", 0.0)], Some("yield_stress")),
            (&[("yield_stress", 1.0), ("hardening_modulus", -1.0)], Some("hardening_modulus")),
            (&[("yield_stress", 1.0), ("young_modulus", 1.0)], None),
            (&[(YIELD_STRESS, 1.0), (SATURATION_STRESS, 1.0)], Some(SATURATION_STRESS)),
            (&[(YIELD_STRESS, 1.0), (SATURATION_EXPONENT, 1.0)], Some(SATURATION_EXPONENT)),
            (
                &[(YIELD_STRESS, 1.0), (SATURATION_STRESS, -1.0), (SATURATION_EXPONENT, 1.0)],
                Some(SATURATION_STRESS),
            ),
            (
                &[(YIELD_STRESS, 1.0), (SATURATION_STRESS, 1.0), (SATURATION_EXPONENT, 0.0)],
                Some(SATURATION_EXPONENT),
            ),
            (&rate[..2], Some(REFERENCE_RATE)),
            (&[rate[0], rate[2]], Some(RATE_EXPONENT)),
            (&[rate[0], (REFERENCE_RATE, 0.0), rate[2]], Some(REFERENCE_RATE)),
            (&[rate[0], rate[1], (RATE_EXPONENT, 0.5)], Some(RATE_EXPONENT)),
        ] {
            assert_eq!(with(constants).unwrap_err().key.as_deref(), key, "{constants:?}");
        }
        let table = |pairs: &[f64], more: &[(&str, f64)]| {
            let mut given = elastic().with(YIELD_STRESS, 1.0);
            given.put(HARDENING_TABLE, pairs.to_vec());
            law.build(&more.iter().fold(given, |given, &(name, value)| given.with(name, value)))
        };
        let sound = table(&[0.1, 1.0, 0.2, 2.0], &[]).expect("a table");
        assert_eq!(law.build(&sound.given()), Ok(sound));
        for (pairs, found) in [
            (&[0.0, 1.0][..], "plastic strain 0"),
            (&[0.1, 0.5], "stress 0.5 Pa after 1 Pa"),
            (&[0.1, 2.0, 0.1, 3.0], "plastic strain 0.1 after 0.1"),
            (&[0.1, 2.0, 0.2, 1.5], "stress 1.5 Pa after 2 Pa"),
            (&[0.1; 18], "9 pairs"),
        ] {
            let bad = table(pairs, &[]).unwrap_err();
            assert_eq!((bad.key.as_deref(), &*bad.found), (Some(HARDENING_TABLE), found));
        }
        let saturates = [(SATURATION_STRESS, 1.0), (SATURATION_EXPONENT, 1.0)];
        for more in [&[(HARDENING_MODULUS, 1.0)][..], &saturates] {
            let bad = table(&[0.1, 2.0], more).unwrap_err();
            assert_eq!(bad.found, format!("a table beside {}", more[0].0));
        }
    }
}
