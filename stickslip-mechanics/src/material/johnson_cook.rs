//! Plasticity of Johnson and Cook (1983): hardening by strain and by the rate of strain, softening by the heat that
//! plastic work makes; elasticity in rate form, [`Hypoelastic`], and a radial return.
//!
//! ```text
//! J q <= Y,   q = sqrt(3/2 s : s),   s = dev(sigma),   Y = (A + B a^n) (1 + C ln max(r/r_0, 1)) (1 - T^m)
//! a: equivalent plastic strain,   r = da/dt,   W_p = integral of Y da      dissipated per undeformed volume
//! T = min(b W_p/(c (T_melt - T_room)), 1)                                  c: heat capacity of a volume, rho c_p
//! ```
//!
//! It may fail (Johnson and Cook 1985), where D comes to one:
//!
//! ```text
//! dD = da/e_f,   e_f = (D_1 + D_2 exp(D_3 m/q)) (1 + D_4 ln max(r/r_0, 1)) (1 + D_5 T)       m = tr(sigma)/3
//! ```
//! Then it bears the pressure of its volume alone, m = min(K ln J, 0), so that a gap must close before it is pressed; what
//! was stored in shear and tension is dissipated.
//!
//! The part b of the plastic work (Taylor and Quinney 1934) warms the material, and no heat is conducted: so it is where
//! flow is faster than heat spreads. At T_melt nothing is left of the strength. Rates below r_0 harden nothing. The yield
//! stress bounds the Kirchhoff stress, as in von Mises' law here. In a step the growth x of a solves
//!
//! ```text
//! J q* - 3 G J x = Y(a + x, x/dt, T)                                       q*: of the elastic step, T: at its start
//! ```
//!
//! The left side falls and the right grows, so there is one root. It lies below what each of the three terms would
//! leave alone; from there Newton's method goes, and where that leaves the bracket a quarter or the geometric mean of
//! it. Each lane stops by itself, and steps that are elastic take no trial.

use super::declaration::{
    Absent, AllowedRange, BadConstants, Constant, Declared, ENERGY_PER_VOLUME, End, Form, Given,
    NOT_NEGATIVE, POSITIVE, PRESSURE, Quantity, RATE, RATIO,
};
use super::{History, Hypoelastic, Isotropic, Law, Motion, Response, elastic};
use crate::column::Kind;
use crate::tensor::{Matrix, Number, Symmetric};
use serde::Serialize;

/// Plasticity of Johnson and Cook.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct JohnsonCook<T> {
    /// The law below yield.
    #[serde(flatten)]
    pub elastic: Hypoelastic<T>,
    /// A, yield stress in slow uniaxial tension before any flow [Pa].
    pub yield_stress: T,
    /// B [Pa].
    pub hardening_modulus: T,
    /// n [-].
    pub hardening_exponent: T,
    /// C [-].
    pub rate_coefficient: T,
    /// r_0 [1/s].
    pub reference_rate: T,
    /// What heat does; nothing where there is none.
    #[serde(flatten)]
    pub heat: Option<Softening<T>>,
    /// How it fails; never where there is none.
    #[serde(flatten)]
    pub failure: Option<Failure<T>>,
}

/// Constants of the strain at failure [-].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Failure<T> {
    /// D_1
    pub d1: T,
    /// D_2
    pub d2: T,
    /// D_3, negative for metals, which bear less strain in tension.
    pub d3: T,
    /// D_4
    pub d4: T,
    /// D_5
    pub d5: T,
}

/// What the heat of plastic work does.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Softening<T> {
    /// m [-].
    pub thermal_exponent: T,
    /// T_melt [K].
    pub melting_temperature: T,
    /// T_room, at which the material begins [K].
    pub room_temperature: T,
    /// c = rho c_p [J/m^3/K].
    pub heat_capacity: T,
    /// b, part of the plastic work that is heat [-].
    pub heated_share: T,
}

/// Names of the constants in scene files.
const YIELD_STRESS: &str = "yield_stress";
const HARDENING_MODULUS: &str = "hardening_modulus";
const HARDENING_EXPONENT: &str = "hardening_exponent";
const RATE_COEFFICIENT: &str = "rate_coefficient";
const REFERENCE_RATE: &str = "reference_rate";
const THERMAL_EXPONENT: &str = "thermal_exponent";
const MELTING_TEMPERATURE: &str = "melting_temperature";
const ROOM_TEMPERATURE: &str = "room_temperature";
const HEAT_CAPACITY: &str = "heat_capacity";
const HEATED_SHARE: &str = "heated_share";
const FAILURE: [&str; 5] = ["d1", "d2", "d3", "d4", "d5"];

/// What a particle remembers: the last two only where heat or failure need them.
const HISTORY: [History; 4] = [
    History::new("plastic_strain", "", Kind::Number),
    History::new("plastic_dissipation", "J/m^3", Kind::Number),
    History::new("temperature_rise", "K", Kind::Number),
    History::new("ductile_damage", "", Kind::Number),
];

/// T_room where none is given [K].
const USUAL_ROOM: f64 = 293.15;
/// b where none is given.
const USUAL_SHARE: f64 = 0.9;
/// Trials of a step at most.
const MOST_TRIALS: usize = 40;
/// What no quotient divides by less than.
const LEAST: f64 = 1e-30;
/// From which strain and temperature on there are powers.
const SMALLEST: f64 = 1e-20;

const ABOVE_TO_ONE: AllowedRange = AllowedRange {
    from: End::At(0.01),
    to: End::At(1.0),
    because: ", for above 1 hardening would grow without end",
};
/// The smallest strain at failure.
const LEAST_STRAIN: f64 = 1e-6;
/// The largest exponent in it.
const MOST_EXPONENT: f64 = 60.0;
const ANY: AllowedRange = AllowedRange { from: End::Free, to: End::Free, because: "" };
const SHARES: AllowedRange = AllowedRange { from: End::At(0.0), to: End::At(1.0), because: "" };

/// A constant of which the law says itself when it may be missing.
const fn judged(
    name: &'static str,
    summary: &'static str,
    (unit, bounds): (super::ConstantUnit, AllowedRange),
) -> Constant {
    Constant { name, summary, form: Form::Number(Quantity { name, unit, bounds }), absent: Absent::Judged }
}

impl Declared for JohnsonCook<f64> {
    const SUMMARY: &'static str = "Plastic flow of metals at high rates, after Johnson and Cook: it hardens by strain and rate, and softens by \
                                   its heat, and may fail.";
    const CONSTANTS: &'static [Constant] = &elastic::and::<15, 20>([
        Constant::required(
            YIELD_STRESS,
            "Yield stress in slow uniaxial tension before any flow, A.",
            (PRESSURE, POSITIVE),
            "\"90 MPa\"",
        ),
        Constant::optional(
            HARDENING_MODULUS,
            "Growth of the yield stress by the power of plastic strain, B; none without it.",
            (PRESSURE, NOT_NEGATIVE.because(", for softening would follow the grid")),
            0.0,
        ),
        Constant::optional(HARDENING_EXPONENT, "Exponent of plastic strain, n.", (RATIO, ABOVE_TO_ONE), 1.0),
        Constant::optional(
            RATE_COEFFICIENT,
            "Relative growth of the yield stress by the logarithm of the rate, C; none without it.",
            (RATIO, NOT_NEGATIVE.because(", for what softens by its rate is not stable")),
            0.0,
        ),
        Constant::optional(
            REFERENCE_RATE,
            "Rate of plastic strain from which on the rate hardens.",
            (RATE, POSITIVE),
            1.0,
        ),
        judged(
            THERMAL_EXPONENT,
            "Exponent of temperature, m; without it heat softens nothing.",
            (RATIO, POSITIVE),
        ),
        judged(
            MELTING_TEMPERATURE,
            "Temperature at which no strength is left, in kelvin.",
            (RATIO, POSITIVE),
        ),
        judged(
            ROOM_TEMPERATURE,
            "Temperature of the start, at which A, B and C hold, in kelvin; 293.15 without it.",
            (RATIO, POSITIVE),
        ),
        judged(
            HEAT_CAPACITY,
            "Heat that warms a volume by a kelvin: density times specific heat.",
            (ENERGY_PER_VOLUME, POSITIVE),
        ),
        judged(HEATED_SHARE, "Part of the plastic work that becomes heat; 0.9 without it.", (RATIO, SHARES)),
        judged(FAILURE[0], "Strain at failure, D1; without it nothing fails.", (RATIO, ANY)),
        judged(FAILURE[1], "Strain at failure by mean stress, D2; 0 without it.", (RATIO, NOT_NEGATIVE)),
        judged(
            FAILURE[2],
            "Factor of mean stress over equivalent stress in its exponential, D3, negative for metals; 0 without it.",
            (RATIO, ANY),
        ),
        judged(FAILURE[3], "Growth of the strain at failure by the rate, D4; 0 without it.", (RATIO, ANY)),
        judged(FAILURE[4], "Growth of the strain at failure by temperature, D5; 0 without it.", (RATIO, ANY)),
    ]);

    fn build(given: &Given) -> Result<Self, BadConstants> {
        let elastic = Isotropic::build(given)?;
        if elastic.shear_modulus == 0.0 {
            return Err(BadConstants::together("G = 0", "G above 0: a fluid has nothing that yields"));
        }
        Ok(JohnsonCook {
            elastic: Hypoelastic { elastic },
            yield_stress: given.number(YIELD_STRESS),
            hardening_modulus: given.number(HARDENING_MODULUS),
            hardening_exponent: given.number(HARDENING_EXPONENT),
            rate_coefficient: given.number(RATE_COEFFICIENT),
            reference_rate: given.number(REFERENCE_RATE),
            heat: Softening::build(given)?,
            failure: Failure::build(given)?,
        })
    }

    fn given(&self) -> Given {
        let given = self
            .elastic
            .given()
            .with(YIELD_STRESS, self.yield_stress)
            .with(HARDENING_MODULUS, self.hardening_modulus)
            .with(HARDENING_EXPONENT, self.hardening_exponent)
            .with(RATE_COEFFICIENT, self.rate_coefficient)
            .with(REFERENCE_RATE, self.reference_rate);
        let given = match self.failure {
            None => given,
            Some(Failure { d1, d2, d3, d4, d5 }) => FAILURE
                .into_iter()
                .zip([d1, d2, d3, d4, d5])
                .fold(given, |given, (key, value)| given.with(key, value)),
        };
        match self.heat {
            None => given,
            Some(heat) => given
                .with(THERMAL_EXPONENT, heat.thermal_exponent)
                .with(MELTING_TEMPERATURE, heat.melting_temperature)
                .with(ROOM_TEMPERATURE, heat.room_temperature)
                .with(HEAT_CAPACITY, heat.heat_capacity)
                .with(HEATED_SHARE, heat.heated_share),
        }
    }

    fn elastic(&self) -> Isotropic<f64> {
        self.elastic.elastic
    }
}

impl Failure<f64> {
    /// D_1 with whatever else is given, or nothing.
    fn build(given: &Given) -> Result<Option<Self>, BadConstants> {
        let Some(d1) = given.get(FAILURE[0]) else {
            let lonely = FAILURE.into_iter().find_map(|key| Some((key, given.get(key)?)));
            return lonely.map_or(Ok(None), |(key, value)| {
                Err(BadConstants::of(key, format!("{value}, but no d1"), "d1 with it, or none of them"))
            });
        };
        let [d2, d3, d4, d5] = [1, 2, 3, 4].map(|i| given.get(FAILURE[i]).unwrap_or(0.0));
        if d1 + d2 <= 0.0 {
            let found = format!("{d1} with d2 = {d2}");
            return Err(BadConstants::of(
                FAILURE[0],
                found,
                "d1 + d2 above 0, the strain at failure in shear",
            ));
        }
        Ok(Some(Failure { d1, d2, d3, d4, d5 }))
    }
}

impl Softening<f64> {
    /// What is given of heat: m, T_melt and c together, or nothing.
    fn build(given: &Given) -> Result<Option<Self>, BadConstants> {
        let all = [THERMAL_EXPONENT, MELTING_TEMPERATURE, HEAT_CAPACITY];
        let [Some(thermal_exponent), Some(melting_temperature), Some(heat_capacity)] =
            all.map(|key| given.get(key))
        else {
            let lonely = all.into_iter().chain([ROOM_TEMPERATURE, HEATED_SHARE]);
            return match lonely.into_iter().find(|key| given.get(key).is_some()) {
                None => Ok(None),
                Some(key) => {
                    let missing = all.into_iter().find(|other| given.get(other).is_none());
                    let missing = missing.expect("one of them is missing");
                    let found = format!("{}, but no {missing}", given.number(key));
                    Err(BadConstants::of(key, found, format!("{} together, or none", all.join(", "))))
                }
            };
        };
        let room_temperature = given.get(ROOM_TEMPERATURE).unwrap_or(USUAL_ROOM);
        if melting_temperature <= room_temperature {
            let allowed = format!("a temperature above that of the room, {room_temperature} K");
            return Err(BadConstants::of(MELTING_TEMPERATURE, format!("{melting_temperature} K"), allowed));
        }
        let heated_share = given.get(HEATED_SHARE).unwrap_or(USUAL_SHARE);
        Ok(Some(Softening {
            thermal_exponent,
            melting_temperature,
            room_temperature,
            heat_capacity,
            heated_share,
        }))
    }
}

impl<T: Copy> JohnsonCook<T> {
    /// The same constants in other numbers.
    #[inline(always)]
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> JohnsonCook<U> {
        JohnsonCook {
            elastic: Hypoelastic { elastic: self.elastic.elastic.map(&f) },
            yield_stress: f(self.yield_stress),
            hardening_modulus: f(self.hardening_modulus),
            hardening_exponent: f(self.hardening_exponent),
            rate_coefficient: f(self.rate_coefficient),
            reference_rate: f(self.reference_rate),
            heat: self.heat.map(|heat| Softening {
                thermal_exponent: f(heat.thermal_exponent),
                melting_temperature: f(heat.melting_temperature),
                room_temperature: f(heat.room_temperature),
                heat_capacity: f(heat.heat_capacity),
                heated_share: f(heat.heated_share),
            }),
            failure: self.failure.map(|failure| Failure {
                d1: f(failure.d1),
                d2: f(failure.d2),
                d3: f(failure.d3),
                d4: f(failure.d4),
                d5: f(failure.d5),
            }),
        }
    }
}

/// q of a deviator [Pa]
#[inline(always)]
fn equivalent<T: Number>(deviator: &Symmetric<T>) -> T {
    (T::of(1.5) * deviator.double_dot(deviator)).sqrt()
}

/// x^exponent of x >= 0; below [`SMALLEST`] a straight line, so that its slope has an end.
#[inline(always)]
fn power<T: Number>(x: T, exponent: T) -> T {
    let smallest = T::of(SMALLEST);
    (exponent * x.max(smallest).ln()).exp() * (x / smallest).min(T::ONE)
}

impl<T: Number> Softening<T> {
    /// How much warmer plastic work has made the material [K].
    #[inline(always)]
    fn rise(&self, work: T) -> T {
        self.heated_share * work / self.heat_capacity
    }

    /// T
    #[inline(always)]
    fn homologous(&self, work: T) -> T {
        (self.rise(work) / (self.melting_temperature - self.room_temperature)).min(T::ONE)
    }

    /// 1 - T^m
    #[inline(always)]
    fn left(&self, work: T) -> T {
        T::ONE - power(self.homologous(work), self.thermal_exponent)
    }
}

impl<T: Number> Failure<T> {
    /// e_f of m/q, max(r/r_0, 1) and T.
    #[inline(always)]
    fn strain(&self, [triaxiality, rate, homologous]: [T; 3]) -> T {
        let exponent = (self.d3 * triaxiality).min(T::of(MOST_EXPONENT));
        let by_stress = self.d1 + self.d2 * exponent.exp();
        let by_rate = T::ONE + self.d4 * rate.ln();
        (by_stress * by_rate * (T::ONE + self.d5 * homologous)).max(T::of(LEAST_STRAIN))
    }
}

/// A particle before its plastic step.
#[derive(Clone, Copy, Debug)]
struct Before<T> {
    /// a [-]
    plastic_strain: T,
    /// 1 - T^m [-]
    cool: T,
    /// J q* [Pa]
    trial: T,
    /// 3 G J [Pa]
    stiffness: T,
    /// dt r_0; zero where the step is sudden, and then rates harden nothing [-].
    slow_strain: T,
}

impl<T: Number> Before<T> {
    /// r/r_0 if a grows by so much; a step without duration has none.
    #[inline(always)]
    fn rate(&self, growth: T) -> T {
        let slow = self.slow_strain.max(T::of(LEAST));
        T::select(T::ZERO.at_least(self.slow_strain), T::ZERO, growth / slow)
    }
}

impl<T: Number> JohnsonCook<T> {
    /// Y, and its slope, after a step in which a grows by so much.
    #[inline(always)]
    fn strength(&self, before: &Before<T>, growth: T) -> [T; 2] {
        let strain = before.plastic_strain + growth;
        let hardened = self.hardening_modulus * power(strain, self.hardening_exponent);
        let base = self.yield_stress + hardened;
        let timed = before.rate(growth);
        let rate = T::ONE + self.rate_coefficient * timed.max(T::ONE).ln();
        let positive = growth.max(T::of(LEAST));
        let by_rate = T::select(timed.at_least(T::ONE), self.rate_coefficient / positive, T::ZERO);
        let exponent = T::select(strain.at_least(T::of(SMALLEST)), self.hardening_exponent, T::ONE);
        let by_strain = exponent * hardened / strain.max(T::of(LEAST));
        [before.cool * base * rate, before.cool * (by_strain * rate + base * by_rate)]
    }

    /// Growth of a in the step, and Y after it.
    #[inline(always)]
    fn growth(&self, before: &Before<T>) -> [T; 2] {
        let least = T::of(LEAST);
        let (n, a) = (self.hardening_exponent, before.plastic_strain);
        let [start, _] = self.strength(before, T::ZERO);
        let excess = (before.trial - start).max(T::ZERO);
        let nothing = T::ZERO.at_least(excess);
        let mut searching = ((1 << T::SIDE_BY_SIDE) - 1) & !nothing;
        if searching == 0 {
            return [T::ZERO, start];
        }
        // What elasticity, hardening and the rate alone would leave; the root is below each.
        let elastic = excess / before.stiffness;
        let wanted = power(a, n) + excess / (self.hardening_modulus * before.cool).max(least);
        let rounding = T::of(256.0) * T::EPSILON * a / n;
        let alone = power(wanted.min(T::of(1.0 / LEAST)), T::ONE / n).max(T::of(SMALLEST));
        let hardening = alone - a + rounding;
        let per_decade = (self.rate_coefficient * start).max(least);
        let rate = (excess / per_decade).min(T::of(60.0)).exp() * before.slow_strain;
        let by_rate = T::select(T::ZERO.at_least(before.slow_strain), elastic, rate);
        let by_rate = T::select((excess / per_decade).at_least(T::of(60.0)), elastic, by_rate);
        let (mut low, mut high) = (T::ZERO, elastic.min(hardening).min(by_rate));
        let mut growth = high;
        for _ in 0..MOST_TRIALS {
            let [strength, slope] = self.strength(before, growth);
            let off = before.trial - before.stiffness * growth - strength;
            let sound = (T::of(4.0) * T::EPSILON * before.trial).at_least(off.abs());
            let short = off.at_least(T::ZERO);
            low = T::select(short, growth, low);
            high = T::select(short, high, growth);
            let shut = (T::of(2.0) * T::EPSILON * high).at_least(high - low);
            searching &= !(sound | shut);
            if searching == 0 {
                break;
            }
            let newton = growth + off / (before.stiffness + slope);
            let outside = low.at_least(newton) | newton.at_least(high);
            let inside = (T::of(0.25) * high).max((low * high).sqrt());
            growth = T::select(searching, T::select(outside, inside, newton), growth);
        }
        let growth = T::select(nothing, T::ZERO, growth);
        [growth, self.strength(before, growth)[0]]
    }
}

impl<T: Number> Law<T> for JohnsonCook<T> {
    type History = [T; 4];

    #[inline(always)]
    fn history(&self) -> &'static [History] {
        match (&self.heat, &self.failure) {
            (_, Some(_)) => &HISTORY,
            (Some(_), None) => &HISTORY[..3],
            (None, None) => &HISTORY[..2],
        }
    }

    /// Plastic flow resists no error of F.
    #[inline(always)]
    fn trusts_deformation(&self) -> bool {
        false
    }

    #[inline(always)]
    fn respond(&self, motion: &Motion<T>, history: &[T; 4]) -> Response<T, [T; 4]> {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic.elastic;
        let &[plastic_strain, work, _, damage] = history;
        let (three_g, j) = (T::of(3.0) * g, motion.jacobian);
        let failed = match self.failure {
            Some(_) => damage.at_least(T::ONE),
            None => 0,
        };
        let trial = self.elastic.stress(motion);
        let deviator = trial.deviator();
        let cool = self.heat.map_or(T::ONE, |heat| heat.left(work));
        let before = Before {
            plastic_strain,
            cool: T::select(failed, T::ZERO, cool),
            trial: j * equivalent(&deviator),
            stiffness: three_g * j,
            slow_strain: motion.dt * self.reference_rate,
        };
        let [growth, strength] = self.growth(&before);
        // Without flow nothing is divided: a stress without deviator stays as it is.
        let q = (before.trial / j).max(T::EPSILON * self.yield_stress);
        let share = (three_g * growth / q).min(T::ONE);
        let mut lost = work + strength * growth;
        let (mut stress, mut torn) = (trial - deviator * share, damage);
        if let Some(failure) = self.failure {
            // What fails now lets go of what the step before left.
            let mean = stress.trace() * T::of(1.0 / 3.0);
            let left = motion.stress.trace().max(T::ZERO) * T::of(1.0 / 3.0);
            let in_shear = T::HALF * equivalent(&motion.stress.deviator()) * growth;
            let let_go = j * (in_shear + T::HALF * left * left / k);
            let pressed = (k * j.ln()).min(T::ZERO);
            lost += T::select(failed, let_go, T::ZERO);
            stress += Symmetric::isotropic(T::select(failed, pressed - mean, T::ZERO));
            let homologous = self.heat.map_or(T::ZERO, |heat| heat.homologous(work));
            let triaxiality = mean / (strength / j).max(T::EPSILON * self.yield_stress);
            let at = [triaxiality, before.rate(growth).max(T::ONE), homologous];
            torn = T::select(failed, T::ONE, (damage + growth / failure.strain(at)).min(T::ONE));
        }
        let rise = self.heat.map_or(T::ZERO, |heat| heat.rise(lost));
        Response { stress, history: [plastic_strain + growth, lost, rise, torn] }
    }

    #[inline(always)]
    fn strain_energy(&self, deformation: &Matrix<T>, stress: &Symmetric<T>, _history: &[T; 4]) -> T {
        self.elastic.strain_energy(deformation, stress, &[])
    }

    #[inline(always)]
    fn dissipation(&self, &[_, work, ..]: &[T; 4]) -> T {
        work
    }

    #[inline(always)]
    fn wave_modulus(&self, deformation: &Matrix<T>, jacobian: T, _history: &[T; 4]) -> T {
        self.elastic.wave_modulus(deformation, jacobian, &[])
    }

    #[inline(always)]
    fn shear_modulus(&self, deformation: &Matrix<T>, jacobian: T, _history: &[T; 4]) -> T {
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

    /// Copper, in MPa, mm and ms but for the rate, from Johnson and Cook (1983).
    const COPPER: JohnsonCook<f64> = JohnsonCook {
        elastic: Hypoelastic { elastic: Isotropic { bulk_modulus: 129e3, shear_modulus: 46e3 } },
        yield_stress: 90.0,
        hardening_modulus: 292.0,
        hardening_exponent: 0.31,
        rate_coefficient: 0.025,
        reference_rate: 1e-3,
        heat: Some(Softening {
            thermal_exponent: 1.09,
            melting_temperature: 1356.0,
            room_temperature: 294.0,
            heat_capacity: 8.96e-3 * 383.0,
            heated_share: 0.9,
        }),
        failure: None,
    };
    /// From Johnson and Cook (1985).
    const FAILS: JohnsonCook<f64> = JohnsonCook {
        failure: Some(Failure { d1: 0.54, d2: 4.89, d3: -3.03, d4: 0.014, d5: 1.12 }),
        ..COPPER
    };
    const NONE: [f64; 4] = [0.0; 4];

    fn equivalent(stress: &Symmetric<f64>) -> f64 {
        super::equivalent(&stress.deviator())
    }

    /// A bar that keeps its volume, by its logarithmic strain.
    fn bar(strain: f64) -> Matrix<f64> {
        let (along, across) = (strain.exp(), (-0.5 * strain).exp());
        Matrix([[along, 0.0, 0.0], [0.0, across, 0.0], [0.0, 0.0, across]])
    }

    #[test]
    fn below_yield_it_is_the_elastic_law() {
        for h in sample_gradients() {
            let motion = motion_of(Matrix::IDENTITY + h * 1e-3);
            let response = COPPER.respond(&motion, &NONE);
            assert_eq!((response.stress, response.history), (COPPER.elastic.stress(&motion), NONE));
        }
    }

    #[test]
    fn without_rate_and_heat_straight_hardening_is_that_of_von_mises() {
        let law = JohnsonCook { hardening_exponent: 1.0, rate_coefficient: 0.0, heat: None, ..COPPER };
        let mises = VonMises {
            elastic: law.elastic,
            yield_stress: 90.0,
            hardening_modulus: 292.0,
            hardening: None,
            rate: None,
        };
        for h in sample_gradients() {
            let path = |t: f64| Matrix::IDENTITY + h * t;
            let (end, history, _) = follow(&law, (50, 1.0), path);
            let (exact, [strain, _], _) = follow(&mises, (50, 1.0), path);
            assert!((history[0] / strain - 1.0).abs() < 1e-10 && strain > 0.01, "{history:?} {strain}");
            assert!(end.stress.0.iter().zip(exact.stress.0).all(|(s, e)| (s - e).abs() < 1e-8 * 90.0));
        }
    }

    /// Uniaxial strain rates from 1e-4 to 1e4 per second to a strain of 0.5: the flow stress is the formula's, with the
    /// temperature of dT = b Y/c da, here by the midpoint rule in ten thousand steps.
    #[test]
    fn a_bar_of_copper_flows_by_the_formula() {
        for rate in [1e-7, 1e-3, 1.0, 10.0] {
            let Softening { thermal_exponent, heat_capacity, .. } = COPPER.heat.expect("it softens");
            let strength = |strain: f64, rise: f64| {
                let cool = 1.0 - f64::powf(rise / (1356.0 - 294.0), thermal_exponent);
                (90.0 + 292.0 * strain.powf(0.31)) * (1.0 + 0.025 * f64::ln((rate / 1e-3f64).max(1.0))) * cool
            };
            let (mut rise, step) = (0.0f64, 0.5e-4);
            for i in 0..10_000 {
                let strain = (i as f64 + 0.5) * step;
                let middle = rise + 0.5 * step * 0.9 / heat_capacity * strength(strain, rise);
                rise += step * 0.9 / heat_capacity * strength(strain, middle);
            }
            let (end, history, _) = follow(&COPPER, (4000, 0.5 / rate), |t| bar(0.5 * t));
            let exact = strength(history[0], rise);
            let found = end.jacobian * equivalent(&end.stress);
            assert!((found / exact - 1.0).abs() < 1e-3, "{rate}: {found}, not {exact}");
            assert!((history[2] / rise - 1.0).abs() < 0.01, "{rate}: {history:?}, {rise} K");
        }
        // By hand: (90 + 292 0.2^0.31)(1 + 0.025 ln 1e6) at 294 K; 0.003 of the strain are elastic.
        let cold = JohnsonCook { heat: None, ..COPPER };
        let (end, _, _) = follow(&cold, (4000, 0.2 / 1e3), |t| bar(0.2 * t));
        assert!((equivalent(&end.stress) / 359.6 - 1.0).abs() < 4e-3, "{}", equivalent(&end.stress));
    }

    /// A step's equation holds to a few units of round-off whatever its constants, in 100,000 steps.
    #[test]
    fn the_search_solves_every_step() {
        let mut chance = Chance(5);
        for _ in 0..100_000 {
            let mut decade = |least: f64, most: f64| 10f64.powf(least + (most - least) * chance.number());
            let law = JohnsonCook {
                hardening_modulus: decade(0.0, 4.0),
                hardening_exponent: decade(-1.5, 0.0),
                rate_coefficient: decade(-4.0, 0.0),
                ..COPPER
            };
            let before = Before {
                plastic_strain: [0.0, decade(-12.0, 0.5)][usize::from(chance.number() > 0.3)],
                cool: chance.number(),
                trial: 0.0,
                stiffness: 138e3,
                slow_strain: [0.0, 10f64.powf(-12.0 * chance.number())][usize::from(chance.number() > 0.2)],
            };
            let start = law.strength(&before, 0.0)[0];
            let trial = start * (1.0 + 10f64.powf(-6.0 + 8.0 * chance.number()));
            let before = Before { trial, ..before };
            let [growth, strength] = law.growth(&before);
            let off = (trial - before.stiffness * growth - strength).abs() / trial;
            assert!(growth >= 0.0 && off < 4e-15, "{off} {law:?} {before:?} {growth}");
        }
    }

    /// In single precision as well.
    #[test]
    fn single_precision_finds_the_same_stress() {
        let single = COPPER.map(|x| x as f32);
        for h in sample_gradients() {
            let motion = motion_of(Matrix::IDENTITY + h * 0.1);
            let exact = COPPER.respond(&motion, &NONE);
            let narrow = Motion {
                deformation: Matrix(motion.deformation.0.map(|row| row.map(|x| x as f32))),
                jacobian: motion.jacobian as f32,
                increment: Matrix(motion.increment.0.map(|row| row.map(|x| x as f32))),
                stress: Symmetric([0.0; 6]),
                dt: motion.dt as f32,
            };
            let found = single.respond(&narrow, &[0.0; 4]);
            let size = equivalent(&exact.stress);
            for (s, e) in found.stress.deviator().0.iter().zip(exact.stress.deviator().0) {
                assert!((f64::from(*s) - e).abs() < 2e-3 * size, "{s} {e}");
            }
        }
    }

    /// What comes to its melting point flows without resistance and still bears pressure.
    #[test]
    fn molten_metal_has_no_strength() {
        let heat = COPPER.heat.map(|heat| Softening { heat_capacity: 0.01, ..heat });
        let (end, history, _) = follow(&JohnsonCook { heat, ..COPPER }, (400, 1.0), |t| bar(0.5 * t) * 0.99);
        assert!((history[2] / (1356.0 - 294.0) - 1.0).abs() < 1e-5, "{history:?}");
        assert!(equivalent(&end.stress) < 1e-3 * 90.0 && end.stress.trace() < -1e3, "{:?}", end.stress);
    }

    /// Slowly and without mean stress at D_1 + D_2, earlier under a mean stress as large as q.
    /// Then it bears no shear and no tension, and pressure where its volume is below that of the start.
    #[test]
    fn it_fails_at_the_strain_of_the_formula() {
        let failure = Failure { d1: 0.1, d2: 0.2, d3: -1.5, d4: 0.0, d5: 0.0 };
        let law = JohnsonCook { heat: None, failure: Some(failure), ..COPPER };
        let (end, history, _) = follow(&law, (3000, 1e6), |t| bar(0.29 * t));
        assert!(history[3] > 0.95 && history[3] < 1.0 && equivalent(&end.stress) > 90.0, "{history:?}");
        let exact = history[0] / 0.3;
        assert!((history[3] / exact - 1.0).abs() < 1e-3, "{history:?}");
        let (end, broken, _) = follow(&law, (3000, 1e6), |t| bar(0.31 * t));
        assert!(broken[3] == 1.0 && equivalent(&end.stress) < 1e-9, "{broken:?}");
        // m/q of one: stretched in volume by q/K.
        let strained = |t: f64| {
            let a = 0.12 * t;
            let q = 90.0 + 292.0 * a.powf(0.31);
            bar(a) * (q / 129e3 / 3.0).exp()
        };
        let (_, history, _) = follow(&law, (3000, 1e6), strained);
        let exact = history[0] / (0.1 + 0.2 * f64::exp(-1.5));
        assert!((history[3] / exact - 1.0).abs() < 0.02, "{history:?} {exact}");
        for j in [0.99, 1.0, 1.2] {
            let motion = motion_of(Matrix::IDENTITY * f64::cbrt(j));
            let after = law.respond(&Motion { stress: end.stress, ..motion }, &broken);
            let exact = (129e3 * j.ln()).min(0.0);
            assert!((after.stress.trace() / 3.0 - exact).abs() < 1e-9, "{j}: {:?}", after.stress);
            assert!(after.history.iter().zip(broken).all(|(a, b)| (a - b).abs() < 1e-12));
        }
    }

    /// Also through the failure, which lets go of shear and tension.
    #[test]
    fn what_failure_lets_go_of_is_dissipated() {
        let failure = Failure { d1: 0.002, d2: 0.0, d3: 0.0, d4: 0.0, d5: 0.0 };
        let law = JohnsonCook { failure: Some(failure), ..COPPER };
        for h in sample_gradients() {
            let motion = |t: f64| {
                let f = Matrix::IDENTITY + h * (0.1 * t);
                f * ((1.0 + 3e-3 * t) / f.det().cbrt())
            };
            let (end, history, work) = follow(&law, (8000, 1.0), motion);
            let stored = law.strain_energy(&end.deformation, &end.stress, &history);
            assert!(history[3] == 1.0 && stored < 1e-9 * work, "{history:?}");
            let dissipated = law.dissipation(&history);
            assert!(((stored + dissipated) / work - 1.0).abs() < 5e-3, "{stored} + {dissipated}, {work}");
        }
    }

    #[test]
    fn the_work_is_stored_or_dissipated() {
        for h in sample_gradients() {
            let motion = |t: f64| {
                let f = Matrix::IDENTITY + h * t;
                f * ((1.0 + 1e-3 * t) / f.det().cbrt())
            };
            let (end, history, work) = follow(&COPPER, (4000, 1.0), motion);
            let stored = COPPER.strain_energy(&end.deformation, &end.stress, &history);
            let dissipated = COPPER.dissipation(&history);
            assert!(dissipated > 0.9 * work, "{dissipated} of {work}");
            assert!(((stored + dissipated) / work - 1.0).abs() < 1e-3, "{stored} + {dissipated}, {work}");
        }
    }

    #[test]
    fn a_step_of_rotation_only_rotates_the_stress() {
        let (before, history, _) =
            follow(&COPPER, (50, 1.0), |t| Matrix::IDENTITY + sample_gradients()[2] * t);
        let q = rotation();
        let motion = Motion { deformation: q * before.deformation, increment: q, ..before };
        let after = COPPER.respond(&motion, &history);
        // What rate there was hardened it; now nothing moves, and a step may let go of that part.
        let off = equivalent(&(after.stress - before.stress.rotated(&q))) / equivalent(&before.stress);
        assert!(off < 1.0 - 1.0 / (1.0 + 0.025 * f64::ln(1e3)) && after.history[0] < history[0] + 1e-3);
        let slow = JohnsonCook { rate_coefficient: 0.0, heat: None, ..COPPER };
        let (before, history, _) = follow(&slow, (50, 1.0), |t| Matrix::IDENTITY + sample_gradients()[2] * t);
        let motion = Motion { deformation: q * before.deformation, increment: q, ..before };
        let after = slow.respond(&motion, &history);
        assert!(after.stress.0.iter().zip(before.stress.rotated(&q).0).all(|(s, e)| (s - e).abs() < 1e-9));
        assert!((after.history[0] - history[0]).abs() < 1e-12);
    }

    #[test]
    fn particles_side_by_side_know_nothing_of_each_other() {
        lanes_know_nothing_of_each_other(&COPPER, &COPPER.map(Number::of), 2000);
        lanes_know_nothing_of_each_other(&FAILS, &FAILS.map(Number::of), 2000);
    }

    #[test]
    fn plates_have_a_thickness_without_stress() {
        plates_have_a_thickness(&COPPER, 400);
        plates_have_a_thickness(
            &JohnsonCook {
                failure: Some(Failure { d1: 0.01, d2: 0.0, d3: 0.0, d4: 0.0, d5: 0.0 }),
                ..COPPER
            },
            400,
        );
    }

    #[test]
    fn whatever_the_motion_the_answers_are_numbers() {
        answers_are_numbers(&COPPER, 20_000);
        answers_are_numbers(&FAILS, 20_000);
        // In Pa and s.
        let si = JohnsonCook {
            elastic: Hypoelastic { elastic: Isotropic { bulk_modulus: 129e9, shear_modulus: 46e9 } },
            yield_stress: 90e6,
            hardening_modulus: 292e6,
            reference_rate: 1.0,
            heat: COPPER.heat.map(|heat| Softening { heat_capacity: 3.43e6, ..heat }),
            ..FAILS
        };
        answers_are_numbers(&si, 20_000);
        answers_are_numbers(&si.map(|x| x as f32), 20_000);
        answers_are_numbers(&JohnsonCook { hardening_modulus: 0.0, heat: None, ..COPPER }, 20_000);
    }

    /// The tangent of an elastic step along any axis is below it, and of a plastic one further below.
    #[test]
    fn no_wave_is_faster_than_the_elastic_one() {
        let mut chance = Chance(9);
        for size in [1e-4, 1e-2, 0.2] {
            for _ in 0..200 {
                let f = Matrix::IDENTITY + chance.matrix() * size;
                let (before, history, _) =
                    follow(&COPPER, (20, 1e-3), |t| Matrix::IDENTITY + (f - Matrix::IDENTITY) * t);
                let n = chance.direction();
                let along = |e: f64| {
                    let increment = Matrix::IDENTITY + Matrix::from_fn(|i, j| e * n[i] * n[j]);
                    let deformation = increment * before.deformation;
                    let motion = Motion { deformation, jacobian: deformation.det(), increment, ..before };
                    let stress = COPPER.respond(&motion, &history).stress;
                    (0..3)
                        .flat_map(|i| (0..3).map(move |j| (i, j)))
                        .map(|(i, j)| n[i] * n[j] * stress.at(i, j))
                        .sum::<f64>()
                };
                let e = 1e-6;
                let tangent = before.jacobian * (along(e) - along(-e)) / (2.0 * e);
                let modulus = COPPER.wave_modulus(&before.deformation, before.jacobian, &history);
                assert!(tangent < modulus * (1.0 + 1e-4), "{size}: {tangent} {modulus}");
            }
        }
    }

    #[test]
    fn constants_that_make_no_material_are_refused() {
        let law = LAWS.iter().find(|law| law.name == "johnson_cook").expect("a law of the list");
        let with = |more: &[(&str, f64)]| {
            let elastic = Given::from([("bulk_modulus", 6.0), ("shear_modulus", 3.0), (YIELD_STRESS, 1.0)]);
            law.build(&more.iter().fold(elastic, |given, &(name, value)| given.with(name, value)))
        };
        let heat = [(THERMAL_EXPONENT, 1.0), (MELTING_TEMPERATURE, 1000.0), (HEAT_CAPACITY, 1.0)];
        assert_eq!(with(&heat).expect("all of heat").history().len(), 3);
        assert_eq!(with(&[]).expect("no heat").history().len(), 2);
        assert_eq!(with(&[("d1", 0.5)]).expect("failure").history().len(), 4);
        for (constants, key) in [
            (&[(YIELD_STRESS, 0.0)][..], Some(YIELD_STRESS)),
            (&[(HARDENING_MODULUS, -1.0)], Some(HARDENING_MODULUS)),
            (&[(HARDENING_EXPONENT, 0.0)], Some(HARDENING_EXPONENT)),
            (&[(HARDENING_EXPONENT, 1.5)], Some(HARDENING_EXPONENT)),
            (&[(RATE_COEFFICIENT, -0.1)], Some(RATE_COEFFICIENT)),
            (&[(REFERENCE_RATE, 0.0)], Some(REFERENCE_RATE)),
            (&heat[..2], Some(THERMAL_EXPONENT)),
            (&[(HEATED_SHARE, 0.5)], Some(HEATED_SHARE)),
            (&[heat[0], (MELTING_TEMPERATURE, 200.0), heat[2]], Some(MELTING_TEMPERATURE)),
            (&[(HEATED_SHARE, 1.5)], Some(HEATED_SHARE)),
            (&[("d3", -1.0)], Some("d3")),
            (&[("d1", -0.1), ("d2", 0.05)], Some("d1")),
            (&[("d1", 0.1), ("d2", -0.05)], Some("d2")),
            (&[("shear_modulus", 0.0)], None),
        ] {
            assert_eq!(with(constants).unwrap_err().key.as_deref(), key, "{constants:?}");
        }
    }
}
