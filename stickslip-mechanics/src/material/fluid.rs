//! Fluids: pressure by the volume, and a shear stress by the rate of shear that may begin at a yield stress
//! (Newton; Bingham 1922; Herschel and Bulkley 1926).
//!
//! ```text
//! sigma = -p I + s
//! p     = max(K/g (J^-g - 1), -p_t)            over that of the surroundings; Cole (1948), Murnaghan (1944)
//! t     = t_y + eta r_0 (r/r_0)^n              t = sqrt(s : s/2),  r: rate of shear,  r_0 = 1/s
//! W     = K/g ((J^(1-g) - 1)/(g - 1) + J - 1) + J^2 s : s/(4 G)
//! ```
//!
//! One curve of pressure has the usual equations of state: g = 7 is Tait's for water, g = 1 is linear in the density,
//! and a gas that exchanges no heat has its ratio of heat capacities for g and K = g p_0, with the pressure p_0 of the
//! surroundings, over which p counts (a stiffened gas: K = g (p_0 + p_inf)).
//!
//! Against sudden shear a fluid is stiff by G/J, in rate form as [`Hypoelastic`]: what the step adds to s relaxes as the
//! yield stress and the viscosity allow (Maxwell 1867; Saramito 2007). This is how the yield stress is regularised: below
//! it nothing flows at all. It also keeps the stable step that of sound, however viscous the fluid: a dashpot without
//! the spring would need steps of h^2 rho/(2 eta). The step is implicit, with the trial s* and t*,
//!
//! ```text
//! t* - G/J r dt = t_y + eta r_0 (r/r_0)^n,   s = s* (1 - G/J r dt/t*)
//! ```
//!
//! which for n = 1 is solved at once, and otherwise by five steps of Newton's method in ln r; that function is convex,
//! so that they come from above. In steady flow t is exact at any step. While shear changes, s lags by eta/G; in
//! steady shear r, normal stresses differ by 2 t r eta/G. Both are small where t is small against G.

use super::declaration::{
    Absent, AllowedRange, BadConstants, Constant, Declared, End, Form, Given, NOT_NEGATIVE, POSITIVE,
    PRESSURE, Quantity, RATIO, VISCOSITY,
};
use super::{History, Hypoelastic, Isotropic, Law, Motion, Response};
use crate::column::Kind;
use crate::tensor::{Matrix, Number, Symmetric};
use serde::Serialize;

/// A fluid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fluid<T> {
    /// K, bulk modulus at rest [Pa].
    pub bulk_modulus: T,
    /// g, exponent of the pressure, at least 1 [-].
    pub pressure_exponent: T,
    /// p_t, largest tension that it bears; none where there is no bound [Pa].
    pub tensile_strength: Option<T>,
    /// eta, viscosity at a rate of shear of 1/s [Pa s].
    pub viscosity: T,
    /// t_y, shear stress below which it does not flow [Pa].
    pub yield_stress: T,
    /// n [-].
    pub flow_exponent: T,
    /// G, stiffness against sudden shear [Pa].
    pub shear_modulus: T,
    /// J at which the tension is p_t.
    #[serde(skip)]
    largest_volume: T,
    #[serde(skip)]
    form: Simplicity,
}

/// What of it is simple, and so cheap.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Simplicity {
    /// g, if it is one of the first few whole numbers, else 0.
    pressure: u32,
    /// Whether n = 1.
    flow_is_linear: bool,
    /// Whether anything resists its flow.
    resists: bool,
}

/// Names of the constants in scene files.
const BULK_MODULUS: &str = "bulk_modulus";
const PRESSURE_EXPONENT: &str = "pressure_exponent";
const TENSILE_STRENGTH: &str = "tensile_strength";
const VISCOSITY_KEY: &str = "viscosity";
const YIELD_STRESS: &str = "yield_stress";
const FLOW_EXPONENT: &str = "flow_exponent";
const SHEAR_MODULUS: &str = "shear_modulus";

/// What a particle remembers.
const HISTORY: [History; 1] = [History::new("viscous_dissipation", "J/m^3", Kind::Number)];

/// G over K where none is given: steps are then 0.87 of those without viscosity.
const USUAL_SHARE: f64 = 0.25;
/// The largest whole exponent that is multiplied out.
const MOST_FACTORS: u32 = 8;
/// Steps of Newton's method.
const TRIALS: usize = 5;
/// Volume ratio that no fluid comes to.
const NEVER: f64 = 1e30;
/// What no quotient divides by less than.
const LEAST: f64 = 1e-30;

const ONE_OR_ABOVE: AllowedRange = AllowedRange {
    from: End::At(1.0),
    to: End::Free,
    because: ", else the speed of sound would fall as the fluid is pressed",
};
const FLOW_EXPONENTS: AllowedRange = AllowedRange {
    from: End::At(0.1),
    to: End::At(3.0),
    because: "; below 1 a fluid thins as it is sheared, above 1 it thickens",
};

impl Declared for Fluid<f64> {
    const SUMMARY: &'static str = "A fluid with an equation of state, of Newton, Bingham or Herschel and Bulkley, for water, oil, gas, mud and \
                                   fresh concrete.";
    const CONSTANTS: &'static [Constant] = &[
        Constant::required(
            BULK_MODULUS,
            "Bulk modulus K at rest; of a gas g times the pressure of the surroundings.",
            (PRESSURE, POSITIVE),
            "\"2.2 GPa\"",
        ),
        Constant::optional(
            PRESSURE_EXPONENT,
            "Exponent g of the pressure K/g (J^-g - 1); 7 for water, 1 for a pressure linear in the density, of a gas its \
             ratio of heat capacities.",
            (RATIO, ONE_OR_ABOVE),
            7.0,
        ),
        Constant {
            name: TENSILE_STRENGTH,
            summary: "Largest tension that the fluid bears, 0 for spray; without it there is no bound but that of the \
                      equation of state.",
            form: Form::Number(Quantity { name: TENSILE_STRENGTH, unit: PRESSURE, bounds: NOT_NEGATIVE }),
            absent: Absent::Judged,
        },
        Constant::optional(
            VISCOSITY_KEY,
            "Viscosity eta, by a flow_exponent that at a rate of shear of 1/s; none without it.",
            (VISCOSITY, NOT_NEGATIVE),
            0.0,
        ),
        Constant::optional(
            YIELD_STRESS,
            "Shear stress below which it does not flow; none without it.",
            (PRESSURE, NOT_NEGATIVE),
            0.0,
        ),
        Constant::optional(
            FLOW_EXPONENT,
            "Exponent n of the rate of shear, after Herschel and Bulkley.",
            (RATIO, FLOW_EXPONENTS),
            1.0,
        ),
        Constant {
            name: SHEAR_MODULUS,
            summary: "Stiffness against sudden shear, of fluids that have a viscosity or a yield stress; a quarter of the \
                      bulk modulus without it.",
            form: Form::Number(Quantity { name: SHEAR_MODULUS, unit: PRESSURE, bounds: POSITIVE }),
            absent: Absent::Judged,
        },
    ];

    fn build(given: &Given) -> Result<Self, BadConstants> {
        let (viscosity, yield_stress) = (given.number(VISCOSITY_KEY), given.number(YIELD_STRESS));
        let flow_exponent = given.number(FLOW_EXPONENT);
        let resists = viscosity > 0.0 || yield_stress > 0.0;
        for (key, useless) in [(FLOW_EXPONENT, viscosity == 0.0), (SHEAR_MODULUS, !resists)] {
            let value = given.get(key).filter(|&value| (key, value) != (FLOW_EXPONENT, 1.0));
            if let Some(value) = value.filter(|_| useless) {
                let missing =
                    if key == FLOW_EXPONENT { "a viscosity" } else { "a viscosity or a yield_stress" };
                return Err(BadConstants::of(key, value.to_string(), format!("none without {missing}")));
            }
        }
        let bulk_modulus = given.number(BULK_MODULUS);
        let pressure_exponent = given.number(PRESSURE_EXPONENT);
        let tensile_strength = given.get(TENSILE_STRENGTH);
        // p of no volume at all is K/g.
        let left = tensile_strength.map_or(0.0, |most| 1.0 - pressure_exponent * most / bulk_modulus);
        let whole = (1..=MOST_FACTORS).find(|&whole| f64::from(whole) == pressure_exponent);
        let usual = if resists { USUAL_SHARE * bulk_modulus } else { 0.0 };
        Ok(Fluid {
            bulk_modulus,
            pressure_exponent,
            tensile_strength,
            viscosity,
            yield_stress,
            flow_exponent,
            shear_modulus: given.get(SHEAR_MODULUS).unwrap_or(usual),
            largest_volume: if left > 0.0 { left.powf(-1.0 / pressure_exponent).min(NEVER) } else { NEVER },
            form: Simplicity { pressure: whole.unwrap_or(0), flow_is_linear: flow_exponent == 1.0, resists },
        })
    }

    fn given(&self) -> Given {
        let given = Given::from([
            (BULK_MODULUS, self.bulk_modulus),
            (PRESSURE_EXPONENT, self.pressure_exponent),
            (VISCOSITY_KEY, self.viscosity),
            (YIELD_STRESS, self.yield_stress),
            (FLOW_EXPONENT, self.flow_exponent),
        ]);
        let stiff = (self.shear_modulus > 0.0).then_some(self.shear_modulus);
        [(TENSILE_STRENGTH, self.tensile_strength), (SHEAR_MODULUS, stiff)]
            .into_iter()
            .filter_map(|(key, value)| Some((key, value?)))
            .fold(given, |given, (key, value)| given.with(key, value))
    }

    /// Nothing of a fluid keeps its shape.
    fn elastic(&self) -> Isotropic<f64> {
        Isotropic { bulk_modulus: self.bulk_modulus, shear_modulus: 0.0 }
    }
}

impl<T: Copy> Fluid<T> {
    /// The same constants in other numbers.
    #[inline(always)]
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> Fluid<U> {
        Fluid {
            bulk_modulus: f(self.bulk_modulus),
            pressure_exponent: f(self.pressure_exponent),
            tensile_strength: self.tensile_strength.map(&f),
            viscosity: f(self.viscosity),
            yield_stress: f(self.yield_stress),
            flow_exponent: f(self.flow_exponent),
            shear_modulus: f(self.shear_modulus),
            largest_volume: f(self.largest_volume),
            form: self.form,
        }
    }
}

/// Shear stress of a trial, and by what it relaxes.
#[derive(Clone, Copy)]
struct Relaxing<T> {
    /// t* [Pa]
    trial: T,
    /// G r dt [Pa]
    drop: T,
}

/// t of a deviator [Pa]
#[inline(always)]
fn shear_stress<T: Number>(deviator: &Symmetric<T>) -> T {
    (T::HALF * deviator.double_dot(deviator)).sqrt()
}

impl<T: Number> Fluid<T> {
    /// J^-g
    #[inline(always)]
    fn power(&self, j: T) -> T {
        let per = T::ONE / j;
        let mut power = T::ONE;
        for _ in 0..self.form.pressure {
            power *= per;
        }
        if self.form.pressure > 0 { power } else { (-self.pressure_exponent * j.ln()).exp() }
    }

    /// p of a volume ratio [Pa]
    #[inline(always)]
    fn pressure(&self, j: T) -> T {
        self.bulk_modulus / self.pressure_exponent * (self.power(j.min(self.largest_volume)) - T::ONE)
    }

    /// t* and G r dt of a trial, in a step of this stiffness and duration.
    #[inline(always)]
    fn relaxing(&self, deviator: &Symmetric<T>, shear_modulus: T, dt: T) -> Relaxing<T> {
        let trial = shear_stress(deviator);
        let excess = (trial - self.yield_stress).max(T::ZERO);
        let (eta, stiffness) = (self.viscosity, shear_modulus * dt);
        let resisted = if self.form.flow_is_linear {
            excess * (stiffness / (stiffness + eta).max(T::of(LEAST)))
        } else {
            // ln of what the spring and the dashpot would take alone; the root is below both.
            let n = self.flow_exponent;
            let wanted = excess.max(T::of(LEAST)).ln();
            let (spring, dashpot) = (stiffness.max(T::of(LEAST)).ln(), eta.ln());
            let mut rate = (wanted - spring).min((wanted - dashpot) / n);
            for _ in 0..TRIALS {
                let by_spring = (spring + rate - wanted).exp();
                let by_dashpot = (dashpot + n * rate - wanted).exp();
                let sum = by_spring + by_dashpot;
                rate -= sum.ln() * sum / (by_spring + n * by_dashpot);
            }
            (spring + rate).exp().min(excess)
        };
        // A sudden change of shape leaves what the yield stress bears.
        let sudden = T::ZERO.at_least(dt);
        Relaxing { trial, drop: T::select(sudden, excess, resisted) }
    }
}

impl<T: Number> Law<T> for Fluid<T> {
    type History = [T; 1];

    #[inline(always)]
    fn history(&self) -> &'static [History] {
        &HISTORY
    }

    /// Flow resists no error of F.
    #[inline(always)]
    fn trusts_deformation(&self) -> bool {
        false
    }

    #[inline(always)]
    fn respond(&self, motion: &Motion<T>, &[lost]: &[T; 1]) -> Response<T, [T; 1]> {
        let pressure = Symmetric::isotropic(-self.pressure(motion.jacobian));
        if !self.form.resists {
            return Response { stress: pressure, history: [lost] };
        }
        // Of the Kirchhoff stress J s, so that volume that changes under shear takes no energy along.
        let j = motion.jacobian;
        let g = self.shear_modulus / j;
        let before = motion.stress.deviator() * (T::ONE / motion.increment.det());
        // Only its deviator counts.
        let elastic = Hypoelastic { elastic: Isotropic { bulk_modulus: g, shear_modulus: g } };
        let deviator = elastic.stress(&Motion { stress: before, ..*motion }).deviator();
        let Relaxing { trial, drop } = self.relaxing(&deviator, g, motion.dt);
        let left = T::ONE - drop / trial.max(T::of(LEAST));
        let flow = T::select(T::ZERO.at_least(motion.dt), T::ZERO, drop / g);
        // The mean shear stress of the step.
        let mean = T::HALF * (shear_stress(&before) + (trial - drop).max(T::ZERO));
        let lost = lost + j * mean * flow;
        Response { stress: pressure + deviator * left.max(T::ZERO), history: [lost] }
    }

    #[inline(always)]
    fn strain_energy(&self, deformation: &Matrix<T>, stress: &Symmetric<T>, _history: &[T; 1]) -> T {
        let (k, exponent) = (self.bulk_modulus, self.pressure_exponent);
        let j = deformation.det();
        let inside = j.min(self.largest_volume);
        let volume = if self.form.pressure == 1 {
            k * (inside - T::ONE - inside.ln())
        } else {
            let grown = (self.power(inside) * inside - T::ONE) / (exponent - T::ONE);
            k / exponent * (grown + inside - T::ONE)
        };
        let stretched = (inside - j) * self.pressure(inside);
        let deviator = stress.deviator();
        // A fluid without viscosity has no deviator, whatever it is divided by.
        let shear = deviator.double_dot(&deviator) / (T::of(4.0) * self.shear_modulus.max(T::EPSILON * k));
        volume + stretched + j * j * shear
    }

    #[inline(always)]
    fn dissipation(&self, &[lost]: &[T; 1]) -> T {
        lost
    }

    /// Of sudden shear; a fluid in tension at its strength is as stiff as just before.
    #[inline(always)]
    fn wave_modulus(&self, _deformation: &Matrix<T>, jacobian: T, _history: &[T; 1]) -> T {
        let inside = jacobian.min(self.largest_volume);
        self.bulk_modulus * self.power(inside) * inside + T::of(4.0 / 3.0) * self.shear_modulus
    }

    /// None in the long run: a fluid is no plate.
    #[inline(always)]
    fn shear_modulus(&self, _deformation: &Matrix<T>, _jacobian: T, _history: &[T; 1]) -> T {
        T::ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::tests::{follow, motion_of, rotation, sample_gradients};
    use crate::material::trials::{Chance, answers_are_numbers, lanes_know_nothing_of_each_other};
    use crate::material::{LAWS, Material, Thickness};

    const K: f64 = 2e3;

    fn law(more: &[(&str, f64)]) -> Fluid<f64> {
        let description = LAWS.iter().find(|law| law.name == "fluid").expect("a law of the list");
        let given =
            more.iter().fold(Given::from([(BULK_MODULUS, K)]), |given, &(key, value)| given.with(key, value));
        match description.build(&given).unwrap_or_else(|bad| panic!("{bad}")) {
            Material::Fluid(fluid) => fluid,
            other => panic!("{other:?}"),
        }
    }

    fn shear(gamma: f64) -> Matrix<f64> {
        Matrix([[1.0, gamma, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    }

    /// The shear stress after steps of this rate and duration from rest.
    fn sheared(law: &Fluid<f64>, rate: f64, (steps, dt): (usize, f64)) -> (Symmetric<f64>, f64) {
        let (mut stress, mut history) = (Symmetric::ZERO, [0.0]);
        for _ in 0..steps {
            let response = law.respond(&Motion { stress, dt, ..motion_of(shear(rate * dt)) }, &history);
            (stress, history) = (response.stress, response.history);
        }
        (stress, history[0])
    }

    #[test]
    fn pressure_is_that_of_tait_and_of_gases() {
        for (exponent, j) in [(7.0, 0.97), (7.0, 1.02), (1.0, 0.8), (1.4, 0.5), (1.4, 3.0), (2.5, 1.1)] {
            let stress = law(&[(PRESSURE_EXPONENT, exponent)])
                .respond(&motion_of(Matrix::IDENTITY * f64::cbrt(j)), &[0.0]);
            let exact = K / exponent * (j.powf(-exponent) - 1.0);
            let off = stress.stress - Symmetric::isotropic(-exact);
            assert!(off.0.iter().all(|x| x.abs() < 1e-11 * K), "{exponent} {j}: {off:?}");
        }
    }

    /// 2 eta D less its mean, for any rate of strain, at steps far longer than eta/G; and the dashpot's power.
    #[test]
    fn slow_flow_has_newtons_viscosity() {
        let law = law(&[(VISCOSITY_KEY, 0.3)]);
        let dt = 1.0;
        for h in sample_gradients() {
            let rate = h * 1e-4;
            let increment = Matrix::IDENTITY + rate * dt;
            let motion = Motion { dt, increment, ..motion_of(Matrix::IDENTITY) };
            let mut response = law.respond(&motion, &[0.0]);
            for _ in 0..3 {
                response = law.respond(&Motion { stress: response.stress, ..motion }, &response.history);
            }
            let d = rate.symmetric_part().deviator();
            let off = response.stress.deviator() - d * (2.0 * law.viscosity);
            let size = (d * (2.0 * law.viscosity)).double_dot(&d).sqrt();
            assert!(off.double_dot(&off).sqrt() < 1e-3 * size, "{off:?}");
            let power = 2.0 * law.viscosity * d.double_dot(&d);
            // The first step begins at rest.
            assert!((response.history[0] / (3.5 * dt * power) - 1.0).abs() < 2e-3, "{:?}", response.history);
        }
    }

    /// t_y + eta r^n, whether a step is short or long against eta/G.
    #[test]
    fn steady_shear_gives_herschel_and_bulkley() {
        for (n, yield_stress) in [(1.0, 0.0), (1.0, 0.2), (0.4, 0.2), (0.3, 0.0), (1.8, 0.1)] {
            let law = law(&[
                (VISCOSITY_KEY, 0.05),
                (YIELD_STRESS, yield_stress),
                (FLOW_EXPONENT, n),
                (SHEAR_MODULUS, 500.0),
            ]);
            for rate in [1e-3, 0.1, 1.0, 20.0] {
                let exact = yield_stress + 0.05 * f64::powf(rate, n);
                // Until sheared far enough, and longer than what relaxes.
                let relaxes = exact / (500.0 * rate * n.min(1.0));
                for (steps, dt) in [(400, relaxes * 0.1), (50, relaxes * 10.0)] {
                    let found = sheared(&law, rate, (steps, dt)).0.0[3];
                    let error = (found / exact - 1.0).abs();
                    assert!(error < 2e-4 + 1e-3 * exact, "{n} {yield_stress} {rate}: {found}, not {exact}");
                }
            }
        }
    }

    /// The equation of the step holds to round-off, over sixty decades of its terms.
    #[test]
    fn five_trials_solve_the_step() {
        let mut chance = Chance(3);
        let mut worst = 0.0f64;
        for _ in 0..20_000 {
            let n = 0.1 + 2.9 * chance.number();
            let mut decade = |least: f64, most: f64| 10f64.powf(least + (most - least) * chance.number());
            let (viscosity, shear_modulus) = (decade(-6.0, 6.0), decade(0.0, 9.0));
            let (dt, trial) = (decade(-9.0, 0.0), decade(-3.0, 6.0));
            let law = Fluid {
                viscosity,
                shear_modulus,
                flow_exponent: n,
                form: Simplicity { flow_is_linear: false, resists: true, pressure: 7 },
                ..law(&[(YIELD_STRESS, 1e-4)])
            };
            let shear = Symmetric([0.0, 0.0, 0.0, trial, 0.0, 0.0]);
            let drop = law.relaxing(&shear, law.shear_modulus, dt).drop;
            let rate = drop / (shear_modulus * dt);
            let off = drop + viscosity * rate.powf(n) - (trial - law.yield_stress);
            worst = worst.max((off / trial).abs());
        }
        assert!(worst < 1e-9, "{worst}");
    }

    /// Mud on a slope stays: below the yield stress nothing flows, however long, and what is sheared back is elastic.
    #[test]
    fn below_the_yield_stress_nothing_flows() {
        let law = law(&[(VISCOSITY_KEY, 0.05), (YIELD_STRESS, 0.5), (SHEAR_MODULUS, 500.0)]);
        let (stress, lost) = sheared(&law, 9e-4, (1000, 1e-3));
        assert!((stress.0[3] / 0.45 - 1.0).abs() < 1e-3 && lost == 0.0, "{stress:?}");
        let mut held = stress;
        for _ in 0..1000 {
            held =
                law.respond(&Motion { stress: held, dt: 1e3, ..motion_of(Matrix::IDENTITY) }, &[0.0]).stress;
        }
        assert!((held.0[3] - stress.0[3]).abs() < 1e-12);
    }

    #[test]
    fn a_fluid_bears_no_more_tension_than_its_strength() {
        for (most, exponent) in [(0.0, 7.0), (3.0, 7.0), (3.0, 1.0), (3.0, 1.4)] {
            let law = law(&[(TENSILE_STRENGTH, most), (PRESSURE_EXPONENT, exponent)]);
            for (j, kept) in [(0.99, false), (1.0 + 0.5 * most / K, false), (1.5, true), (20.0, true)] {
                let pressure = law.pressure(j);
                let free = K / exponent * (f64::powf(j, -exponent) - 1.0);
                let exact = if kept { -most } else { free };
                assert!((pressure - exact).abs() < 1e-9, "{most} {j}: {pressure} {exact}");
            }
            assert!(law.wave_modulus(&Matrix::IDENTITY, 20.0, &[0.0]) > 0.5 * K);
        }
        // Tait's equation alone never comes to this tension.
        assert_eq!(law(&[(TENSILE_STRENGTH, K)]).largest_volume, NEVER);
    }

    #[test]
    fn the_work_is_stored_or_dissipated() {
        for law in [
            law(&[]),
            law(&[(VISCOSITY_KEY, 30.0), (PRESSURE_EXPONENT, 1.4)]),
            law(&[(VISCOSITY_KEY, 30.0), (YIELD_STRESS, 20.0), (TENSILE_STRENGTH, 5.0)]),
            law(&[
                (VISCOSITY_KEY, 30.0),
                (YIELD_STRESS, 20.0),
                (FLOW_EXPONENT, 0.5),
                (PRESSURE_EXPONENT, 1.0),
            ]),
        ] {
            for h in sample_gradients() {
                let motion = |t: f64| {
                    let f = Matrix::IDENTITY + h * (2.0 * t);
                    f * ((1.0 + 0.02 * (3.0 * t).sin()) / f.det().cbrt())
                };
                let (end, history, work) = follow(&law, (4000, 1.0), motion);
                let stored = law.strain_energy(&end.deformation, &end.stress, &history);
                assert!(law.form.resists == (history[0] > 0.5 * work), "{history:?} {work}");
                let error = ((stored + history[0]) / work - 1.0).abs();
                assert!(error < 1e-5, "{law:?}: {stored} + {}, {work}", history[0]);
            }
        }
    }

    #[test]
    fn a_step_of_rotation_only_rotates_the_stress() {
        let law = law(&[(YIELD_STRESS, 5.0)]);
        let before = Symmetric([1.0, -2.0, 1.0, 0.3, -0.7, 0.2]);
        let q = rotation();
        let after = law.respond(&Motion { stress: before, ..motion_of(q) }, &[0.0]);
        assert!(after.stress.0.iter().zip(before.rotated(&q).0).all(|(s, e)| (s - e).abs() < 1e-12));
        assert_eq!(after.history, [0.0]);
    }

    /// d^2/de^2 of the work of a sudden stretch along an axis, at every volume and of any direction of shear.
    #[test]
    fn the_wave_modulus_is_that_of_sudden_strain() {
        for exponent in [1.0, 1.4, 7.0] {
            let law = law(&[(VISCOSITY_KEY, 1e9), (PRESSURE_EXPONENT, exponent)]);
            for j in [0.7f64, 0.95, 1.0, 1.05, 1.5] {
                let f = Matrix::IDENTITY * j.cbrt();
                let stress = |e: f64| {
                    let increment = Matrix([[1.0 + e, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
                    let motion = Motion { dt: 1e-9, increment, ..motion_of(increment * f) };
                    law.respond(&motion, &[0.0]).stress.0[0]
                };
                let tangent = j * (stress(1e-5) - stress(-1e-5)) / 2e-5;
                let modulus = law.wave_modulus(&f, j, &[0.0]);
                assert!((tangent / modulus - 1.0).abs() < 1e-6, "{exponent} {j}: {tangent} {modulus}");
            }
        }
    }

    #[test]
    fn particles_side_by_side_know_nothing_of_each_other() {
        let thins =
            law(&[(VISCOSITY_KEY, 0.1), (YIELD_STRESS, 2.0), (FLOW_EXPONENT, 0.3), (TENSILE_STRENGTH, 1.0)]);
        lanes_know_nothing_of_each_other(&law(&[]), &law(&[]).map(Number::of), 2000);
        lanes_know_nothing_of_each_other(&thins, &thins.map(Number::of), 2000);
    }

    #[test]
    fn whatever_the_motion_the_answers_are_numbers() {
        answers_are_numbers(&law(&[]), 20_000);
        let muds = [(VISCOSITY_KEY, 0.1), (YIELD_STRESS, 2.0), (TENSILE_STRENGTH, 0.0)];
        answers_are_numbers(&law(&muds), 20_000);
        answers_are_numbers(
            &law(&[&muds[..], &[(FLOW_EXPONENT, 0.3), (PRESSURE_EXPONENT, 1.4)]].concat()),
            20_000,
        );
        answers_are_numbers(&law(&[(YIELD_STRESS, 2.0)]), 20_000);
        let thins = law(&[(VISCOSITY_KEY, 0.1), (YIELD_STRESS, 2.0), (FLOW_EXPONENT, 0.3)]);
        answers_are_numbers(&thins.map(|x| x as f32), 20_000);
    }

    /// At rest it bears pressure alone, but for what its yield stress holds.
    #[test]
    fn it_begins_with_a_pressure() {
        let pressed = Symmetric::isotropic(-0.01 * K);
        let sheared = Symmetric([-20.0, -20.0, -20.0, 1.0, 0.0, 0.0]);
        for (law, bears) in [
            (law(&[]), false),
            (law(&[(VISCOSITY_KEY, 1.0)]), false),
            (law(&[(VISCOSITY_KEY, 1.0), (YIELD_STRESS, 2.0)]), true),
        ] {
            let material = Material::Fluid(law);
            let stretch = material.stretch_under(&pressed).expect("a fluid bears pressure").matrix();
            assert!((law.pressure(stretch.det()) / (0.01 * K) - 1.0).abs() < 1e-9);
            assert_eq!(material.stretch_under(&sheared).is_ok(), bears, "{law:?}");
            assert!(!material.carries_stress());
            // So that a scene in plane stress is refused.
            assert_eq!(material.wave_modulus_at_rest(Thickness::Free), 0.0);
        }
    }

    #[test]
    fn constants_that_make_no_fluid_are_refused() {
        let description = LAWS.iter().find(|law| law.name == "fluid").expect("a law of the list");
        for (key, value) in [
            (BULK_MODULUS, 0.0),
            (PRESSURE_EXPONENT, 0.5),
            (TENSILE_STRENGTH, -1.0),
            (VISCOSITY_KEY, -1.0),
            (YIELD_STRESS, -1.0),
            (FLOW_EXPONENT, 0.0),
            (FLOW_EXPONENT, 0.5),
            (SHEAR_MODULUS, 1.0),
        ] {
            let given = Given::from([(BULK_MODULUS, K)]).with(key, value);
            assert_eq!(description.build(&given).unwrap_err().key.as_deref(), Some(key), "{value}");
        }
        let thins = law(&[(VISCOSITY_KEY, 1.0), (FLOW_EXPONENT, 0.5)]);
        let again = description.build(&thins.given()).expect("its own constants");
        assert_eq!(again, Material::Fluid(thins));
    }
}
