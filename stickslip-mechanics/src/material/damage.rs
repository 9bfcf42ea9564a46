//! Isotropic damage with softening that the cell regularises: neo-Hookean elasticity,
//! of which a crack takes what it can no longer carry.
//!
//! ```text
//! sigma = (1 - d) (dev(sigma_0) + p_0(max(J, 1)) I) + p_0(min(J, 1)) I        sigma_0, p_0: neo-Hookean
//! d     = 1 - k_0/k exp(-(k - k_0)/k_f),   k = max(k_0, largest e so far)     k_0 = f_t/E
//! e     = max(K I_1 + G s_1, 0)/E                                             Rankine
//! e     = (r - 1)/(2 r (1 - 2 nu)) I_1 + 1/(2 r) sqrt(((r - 1)/(1 - 2 nu) I_1)^2 + 12 r/(1 + nu)^2 J_2)
//!                                                                             modified von Mises
//! I_1   = J - 1,   s_1: largest eigenvalue of dev(b_),   J_2 = 1/8 dev(b_) : dev(b_),   b_ = J^(-2/3) F F^T
//! k_f   = G_f/(h f_t) - k_0/2                                                 h: the cell, Bazant and Oh (1983)
//! D     = Y dd,   Y = W_dev + W_vol(max(J, 1))                                dissipated per undeformed volume
//! ```
//!
//! A closed crack bears pressure. The equivalent strain e is the strain of a bar in tension: by Rankine the largest
//! principal stress without damage over E, so that nothing is crushed; by de Vree et al. (1995) one by which a bar in
//! compression bears r times as much, and by which pressure across a tension delays the crack. A crack is as wide as a
//! cell, so what a bar of it dissipates, f_t k_0/2 + f_t k_f, is the fracture energy over the cell, whatever the cell
//! (crack band). Where the cell is above 2 E G_f/f_t^2 no softening is slow enough for that: the bar would snap back,
//! and the scene is refused.
//!
//! Damage never heals, and ends a millionth below one. It follows strain at once and knows no direction; a crack that
//! runs at an angle to the grid is wider than a cell.

use super::declaration::{
    Absent, AllowedRange, BadConstants, Constant, Declared, ENERGY_PER_AREA, End, Form, Given, POSITIVE,
    PRESSURE, Quantity, RATIO,
};
use super::{History, Isotropic, Law, Motion, NeoHookean, Response, elastic};
use crate::column::Kind;
use crate::tensor::{Matrix, Number, Symmetric};
use serde::Serialize;

/// What a material breaks by.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "criterion", rename_all = "kebab-case")]
enum Criterion<T> {
    /// The largest principal stress.
    Rankine,
    /// Invariants of strain, de Vree et al. (1995).
    ModifiedVonMises {
        /// r, stress of a bar in compression where damage begins over that in tension [-].
        strength_ratio: T,
    },
}

/// Isotropic damage.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Damage<T> {
    /// The law without damage.
    #[serde(flatten)]
    pub elastic: NeoHookean<T>,
    /// f_t, stress of a bar in tension where damage begins [Pa].
    pub tensile_strength: T,
    /// What e is.
    #[serde(flatten)]
    criterion: Criterion<T>,
    /// G_f, energy that a crack takes [J/m^2].
    pub fracture_energy: T,
    /// k_f, strain over which a crack softens, from the cell; without a cell none softens [-].
    #[serde(skip)]
    softening_strain: T,
}

/// Names of the constants in scene files.
const TENSILE_STRENGTH: &str = "tensile_strength";
const CRITERION: &str = "criterion";
const STRENGTH_RATIO: &str = "strength_ratio";
const FRACTURE_ENERGY: &str = "fracture_energy";

/// The criteria as scene files name them.
const RANKINE: &str = "rankine";
const MODIFIED_VON_MISES: &str = "modified-von-mises";
const CRITERIA: &[(&str, &str)] = &[
    (RANKINE, "The largest principal stress: for tension and splitting; nothing is crushed."),
    (MODIFIED_VON_MISES, "Invariants of strain after de Vree et al. (1995): for what crushes or shears."),
];
/// r where none is given.
const USUAL_RATIO: f64 = 10.0;

/// What a particle remembers: d, the largest e so far, and what the crack took.
const HISTORY: [History; 3] = [
    History::new("damage", "", Kind::Number),
    History::new("damage_strain", "", Kind::Number),
    History::new("damage_dissipation", "J/m^3", Kind::Number),
];

/// What is left of the stiffness of broken pieces at least: without any,
/// a thin plate of them would have no thickness [-].
const LEAST_LEFT: f64 = 1e-6;
/// Strain that stands for no softening.
const NEVER: f64 = 1e30;

/// What r may be.
const ONE_OR_ABOVE: AllowedRange = AllowedRange { from: End::At(1.0), to: End::Free, because: "" };

impl Declared for Damage<f64> {
    const SUMMARY: &'static str = "Neo-Hookean elasticity that breaks at a strength and takes a fracture energy, for rock, concrete and \
                                   glass; the crack is as wide as a cell.";
    const CONSTANTS: &'static [Constant] = &elastic::and::<4, 9>([
        Constant::required(
            TENSILE_STRENGTH,
            "Stress in uniaxial tension at which damage begins, f_t.",
            (PRESSURE, POSITIVE),
            "\"4 MPa\"",
        ),
        Constant::required(
            FRACTURE_ENERGY,
            "Energy that a crack takes per area, G_f.",
            (ENERGY_PER_AREA, POSITIVE),
            "\"100 J/m^2\"",
        ),
        Constant {
            name: CRITERION,
            summary: "What it breaks by; `rankine` by default, or `modified-von-mises` where a `strength_ratio` is \
                      given.",
            form: Form::Word(CRITERIA),
            absent: Absent::Judged,
        },
        Constant {
            name: STRENGTH_RATIO,
            summary: "Strength in uniaxial compression over that in tension, by `modified-von-mises`; 10 without it.",
            form: Form::Number(Quantity { name: STRENGTH_RATIO, unit: RATIO, bounds: ONE_OR_ABOVE }),
            absent: Absent::Judged,
        },
    ]);

    fn build(given: &Given) -> Result<Self, BadConstants> {
        let elastic = Isotropic::build(given)?;
        if elastic.shear_modulus == 0.0 {
            return Err(BadConstants::together("G = 0", "G above 0: a fluid has nothing that breaks"));
        }
        let named = given.get(CRITERION).map(|place| CRITERIA[place as usize].0);
        let criterion = match (named, given.get(STRENGTH_RATIO)) {
            (Some(RANKINE), Some(ratio)) => {
                let allowed = format!(
                    "no {STRENGTH_RATIO} with {CRITERION} = {RANKINE:?}, by which nothing is crushed; \
                     {MODIFIED_VON_MISES:?} has one"
                );
                return Err(BadConstants::of(STRENGTH_RATIO, ratio.to_string(), allowed));
            }
            (Some(RANKINE) | None, None) => Criterion::Rankine,
            (_, ratio) => Criterion::ModifiedVonMises { strength_ratio: ratio.unwrap_or(USUAL_RATIO) },
        };
        Ok(Damage {
            elastic: NeoHookean { elastic },
            tensile_strength: given.number(TENSILE_STRENGTH),
            criterion,
            fracture_energy: given.number(FRACTURE_ENERGY),
            softening_strain: NEVER,
        })
    }

    fn given(&self) -> Given {
        let given = self
            .elastic
            .given()
            .with(TENSILE_STRENGTH, self.tensile_strength)
            .with(FRACTURE_ENERGY, self.fracture_energy);
        match self.criterion {
            Criterion::Rankine => given.with(CRITERION, 0.0),
            Criterion::ModifiedVonMises { strength_ratio } => {
                given.with(CRITERION, 1.0).with(STRENGTH_RATIO, strength_ratio)
            }
        }
    }

    fn elastic(&self) -> Isotropic<f64> {
        self.elastic.elastic
    }

    fn on_grid(self, cell: f64) -> Result<Self, BadConstants> {
        let (strength, energy) = (self.tensile_strength, self.fracture_energy);
        let onset = strength / self.elastic.elastic.young_modulus();
        let softening_strain = energy / (cell * strength) - 0.5 * onset;
        if softening_strain > 0.0 {
            return Ok(Damage { softening_strain, ..self });
        }
        let largest = 2.0 * energy / (onset * strength);
        Err(BadConstants::of(
            FRACTURE_ENERGY,
            format!("{energy} J/m^2 with cells of {cell} m"),
            format!(
                "cells below {largest:.4e} m, 2 E G_f/f_t^2: in larger ones a crack would give back more energy than it takes"
            ),
        ))
    }
}

impl<T: Copy> Damage<T> {
    /// The same constants in other numbers.
    #[inline(always)]
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> Damage<U> {
        Damage {
            tensile_strength: f(self.tensile_strength),
            criterion: match self.criterion {
                Criterion::Rankine => Criterion::Rankine,
                Criterion::ModifiedVonMises { strength_ratio } => {
                    Criterion::ModifiedVonMises { strength_ratio: f(strength_ratio) }
                }
            },
            fracture_energy: f(self.fracture_energy),
            softening_strain: f(self.softening_strain),
            elastic: self.elastic.map(f),
        }
    }
}

/// p_0 of a volume ratio [Pa]
#[inline(always)]
fn pressure<T: Number>(bulk_modulus: T, j: T) -> T {
    T::HALF * bulk_modulus * (j - T::ONE / j)
}

/// W_vol of a volume ratio [J/m^3]
#[inline(always)]
fn volume_energy<T: Number>(bulk_modulus: T, j: T) -> T {
    T::HALF * bulk_modulus * (T::HALF * (j * j - T::ONE) - j.ln())
}

impl<T: Number> Damage<T> {
    /// k_0
    #[inline(always)]
    fn onset(&self) -> T {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic.elastic;
        self.tensile_strength * (T::of(3.0) * k + g) / (T::of(9.0) * k * g)
    }

    /// e of J and dev(b_).
    #[inline(always)]
    fn equivalent_strain(&self, j: T, deviator: &Symmetric<T>) -> T {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic.elastic;
        let sum = T::of(3.0) * k + g;
        let r = match self.criterion {
            Criterion::Rankine => {
                let largest = k * (j - T::ONE) + g * deviator.largest_of_deviator();
                // 1/E
                return largest.max(T::ZERO) * sum / (T::of(9.0) * k * g);
            }
            Criterion::ModifiedVonMises { strength_ratio } => strength_ratio,
        };
        // I_1/(1 - 2 nu) and J_2/(1 + nu)^2
        let first = (j - T::ONE) * sum / (T::of(3.0) * g);
        let per_shear = T::of(2.0 / 9.0) * sum / k;
        let second = T::of(0.125) * deviator.double_dot(deviator) * (per_shear * per_shear);
        let linear = (r - T::ONE) * first;
        (linear + (linear * linear + T::of(12.0) * r * second).sqrt()) / (r + r)
    }

    /// J, dev(b_), and Y, what damage acts on [J/m^3].
    #[inline(always)]
    fn active(&self, deformation: &Matrix<T>, j: T) -> (Symmetric<T>, T) {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic.elastic;
        let root = j.cbrt();
        let b = deformation.times_transpose() * (T::ONE / (root * root));
        let shear = T::HALF * g * (b.trace() - T::of(3.0));
        (b.deviator(), shear + volume_energy(k, j.max(T::ONE)))
    }
}

impl<T: Number> Law<T> for Damage<T> {
    type History = [T; 3];

    #[inline(always)]
    fn history(&self) -> &'static [History] {
        &HISTORY
    }

    /// What is broken resists no error of F.
    #[inline(always)]
    fn trusts_deformation(&self) -> bool {
        false
    }

    #[inline(always)]
    fn respond(&self, motion: &Motion<T>, &[damage, largest, lost]: &[T; 3]) -> Response<T, [T; 3]> {
        let Isotropic { bulk_modulus: k, shear_modulus: g } = self.elastic.elastic;
        let (f, j) = (&motion.deformation, motion.jacobian);
        let (deviator, energy) = self.active(f, j);
        let onset = self.onset();
        let strain = self.equivalent_strain(j, &deviator).max(largest);
        let beyond = strain.max(onset);
        let left = onset / beyond * ((onset - beyond) / self.softening_strain).exp();
        let now = (T::ONE - left.max(T::of(LEAST_LEFT))).max(damage);
        // F_n = dF^-1 F
        let (_, before) = self.active(&(motion.increment.inverse() * *f), j / motion.increment.det());
        let lost = lost + T::HALF * (before + energy) * (now - damage);
        let open = pressure(k, j.max(T::ONE));
        let shut = pressure(k, j.min(T::ONE));
        let whole = T::ONE - now;
        let stress = deviator * (whole * g / j) + Symmetric::isotropic(whole * open + shut);
        Response { stress, history: [now, strain, lost] }
    }

    #[inline(always)]
    fn strain_energy(&self, deformation: &Matrix<T>, _stress: &Symmetric<T>, &[damage, ..]: &[T; 3]) -> T {
        let j = deformation.det();
        let (_, active) = self.active(deformation, j);
        let shut = volume_energy(self.elastic.elastic.bulk_modulus, j.min(T::ONE));
        (T::ONE - damage) * active + shut
    }

    #[inline(always)]
    fn dissipation(&self, &[_, _, lost]: &[T; 3]) -> T {
        lost
    }

    /// At most that without damage; what the volume of broken pieces grows by stiffens nothing.
    #[inline(always)]
    fn wave_modulus(&self, deformation: &Matrix<T>, jacobian: T, history: &[T; 3]) -> T {
        let (k, whole) = (self.elastic.elastic.bulk_modulus, T::ONE - history[0]);
        let (shut, open) = (jacobian.min(T::ONE), jacobian.max(T::ONE));
        let volume = shut * shut + T::ONE + whole * (open * open - T::ONE);
        T::HALF * k * volume + T::of(4.0 / 3.0) * self.shear_modulus(deformation, jacobian, history)
    }

    #[inline(always)]
    fn shear_modulus(&self, deformation: &Matrix<T>, jacobian: T, &[damage, ..]: &[T; 3]) -> T {
        (T::ONE - damage) * self.elastic.shear_modulus(deformation, jacobian, &[])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::plane_stress::thickening;
    use crate::material::tests::{follow, motion_of, rotation, sample_gradients};

    const ELASTIC: Isotropic<f64> = Isotropic { bulk_modulus: 6e3, shear_modulus: 4e3 };
    const STRENGTH: f64 = 1.0;
    const ENERGY: f64 = 1e-3;

    fn given() -> Given {
        ELASTIC.given().with(TENSILE_STRENGTH, STRENGTH).with(FRACTURE_ENERGY, ENERGY)
    }

    fn law_of(given: &Given, cell: f64) -> Damage<f64> {
        let law: Damage<f64> = Declared::build(given).unwrap();
        law.on_grid(cell).unwrap()
    }

    /// By modified von Mises.
    fn law(cell: f64) -> Damage<f64> {
        law_of(&given().with(STRENGTH_RATIO, 8.0), cell)
    }

    fn by_rankine(cell: f64) -> Damage<f64> {
        law_of(&given(), cell)
    }

    /// A bar whose length has this strain, with free sides as long as it is whole: Hooke's strains,
    /// which damage leaves in proportion.
    fn bar(strain: f64) -> Matrix<f64> {
        let across = 1.0 - ELASTIC.poisson_ratio() * strain;
        Matrix([[1.0 + strain, 0.0, 0.0], [0.0, across, 0.0], [0.0, 0.0, across]])
    }

    fn onset() -> f64 {
        STRENGTH / ELASTIC.young_modulus()
    }

    #[test]
    fn below_its_strength_it_is_neo_hookean() {
        for (h, law) in sample_gradients().into_iter().flat_map(|h| [(h, law(0.1)), (h, by_rankine(0.1))]) {
            let motion = motion_of(Matrix::IDENTITY + h * 1e-4);
            let response = law.respond(&motion, &[0.0; 3]);
            let exact = NeoHookean { elastic: ELASTIC }.stress(&motion);
            assert!(response.stress.0.iter().zip(exact.0).all(|(s, e)| (s - e).abs() < 1e-10));
            assert_eq!(response.history[0], 0.0);
        }
    }

    /// sigma = f_t exp(-(e - k_0)/k_f) in a bar, within the squares of strain,
    /// and the strength in compression is r times as large.
    #[test]
    fn a_bar_softens_by_the_exponential_and_bears_more_in_compression() {
        let law = law(0.1);
        let softening = ENERGY / (0.1 * STRENGTH) - 0.5 * onset();
        for times in [1.0, 2.0, 10.0, 40.0] {
            let strain = onset() * times;
            let (end, [damage, ..], _) = follow(&law, (200, 1.0), |t| bar(strain * t));
            let exact = STRENGTH * (-(strain - onset()) / softening).exp();
            assert!((end.stress.0[0] / exact - 1.0).abs() < 5.0 * strain, "{times}: {}", end.stress.0[0]);
            assert!((0.0..1.0).contains(&damage));
        }
        let stress = |strain: f64| follow(&law, (200, 1.0), |t| bar(strain * t));
        assert!(stress(-7.9 * onset()).1[0] < 1e-12);
        assert!(stress(-8.1 * onset()).1[0] > 1e-3);
    }

    /// e of Hooke's strain under principal stresses, turned.
    fn equivalent(law: &Damage<f64>, principal: [f64; 3]) -> f64 {
        let (e, nu) = (ELASTIC.young_modulus(), ELASTIC.poisson_ratio());
        let sum: f64 = principal.iter().sum();
        let strain = principal.map(|stress| ((1.0 + nu) * stress - nu * sum) / e);
        let stretch = Matrix::from_fn(|a, b| if a == b { 1.0 + strain[a] } else { 0.0 });
        let (f, q) = (rotation() * stretch, rotation());
        let f = f * q.transpose();
        law.equivalent_strain(f.det(), &law.active(&f, f.det()).0) * e
    }

    /// E e is the stress of a bar in tension that is as near to breaking: at the middle of a disk between plates, which
    /// has f_t across and 3 f_t along, Rankine's is f_t, and de Vree's with r = 10 is 0.55 f_t, so that the disk bears
    /// 1.8 times what Griffith's formula says. Two tensions are as one by Rankine, and pressure breaks nothing.
    #[test]
    fn the_criteria_say_what_stress_breaks() {
        let small = 1e-4;
        let mises = law_of(&given().with(STRENGTH_RATIO, 10.0), 0.1);
        // (r - 1)/(2 r) sum + 1/(2 r) sqrt(((r - 1) sum)^2 + 12 r J_2) of stresses 1, -3, 0
        let splitting = -0.9 + (18f64 * 18.0 + 120.0 * 13.0 / 3.0).sqrt() / 20.0;
        assert!((splitting - 0.552).abs() < 1e-3);
        for (law, stresses, expected) in [
            (by_rankine(0.1), [1.0, 0.0, 0.0], 1.0),
            (by_rankine(0.1), [1.0, -3.0, 0.0], 1.0),
            (by_rankine(0.1), [1.0, 1.0, 0.0], 1.0),
            (by_rankine(0.1), [0.5, 1.0, 1.0], 1.0),
            (by_rankine(0.1), [1.0, -1.0, 0.0], 1.0),
            (by_rankine(0.1), [0.0, -1.0, 0.0], 0.0),
            (by_rankine(0.1), [-1.0, -2.0, -1.0], 0.0),
            (mises, [1.0, 0.0, 0.0], 1.0),
            (mises, [1.0, -3.0, 0.0], splitting),
            (mises, [0.0, -10.0, 0.0], 1.0),
        ] {
            let found = equivalent(&law, stresses.map(|stress| stress * small)) / small;
            assert!((found - expected).abs() < 1e-3, "{law:?} {stresses:?}: {found}, not {expected}");
        }
    }

    #[test]
    fn a_strength_ratio_is_refused_where_nothing_is_crushed() {
        let bad = <Damage<f64> as Declared>::build(&given().with(CRITERION, 0.0).with(STRENGTH_RATIO, 8.0));
        assert_eq!(bad.unwrap_err().key.as_deref(), Some(STRENGTH_RATIO));
        let ten = law_of(&given().with(CRITERION, 1.0), 0.1).criterion;
        assert_eq!(ten, Criterion::ModifiedVonMises { strength_ratio: 10.0 });
    }

    #[test]
    fn what_a_bar_of_a_cell_dissipates_is_the_fracture_energy_whatever_the_cell() {
        for cell in [0.02, 0.1, 0.5] {
            let law = law(cell);
            let softening = ENERGY / (cell * STRENGTH) - 0.5 * onset();
            let (_, history, _) = follow(&law, (20_000, 1.0), |t| bar((onset() + 20.0 * softening) * t));
            let taken = cell * law.dissipation(&history);
            assert!((taken / ENERGY - 1.0).abs() < 0.05 + 10.0 * softening, "{cell}: {taken}");
        }
    }

    #[test]
    fn the_work_is_stored_or_dissipated() {
        for h in sample_gradients() {
            let path = |t: f64| Matrix::IDENTITY + h * (0.05 * (4.0 * t).sin());
            for law in [law(0.1), by_rankine(0.1)] {
                let error = |steps| {
                    let (end, history, work) = follow(&law, (steps, 1.0), path);
                    let stored = law.strain_energy(&end.deformation, &end.stress, &history);
                    assert!(history[0] > 0.05 && history[2] > 0.0, "{history:?}");
                    ((stored + history[2]) / work - 1.0).abs()
                };
                assert!(error(8000) < 1e-4, "{} {}", error(4000), error(8000));
            }
        }
    }

    #[test]
    fn damage_never_heals_and_a_closed_crack_bears_pressure() {
        let law = law(0.1);
        let (_, broken, _) = follow(&law, (400, 1.0), |t| bar(60.0 * onset() * t));
        assert!(broken[0] > 0.9);
        let squeezed = Matrix::IDENTITY * 0.999;
        let rest = law.respond(&Motion { increment: Matrix::IDENTITY, ..motion_of(squeezed) }, &broken);
        assert_eq!(rest.history, broken);
        let whole = NeoHookean { elastic: ELASTIC }.stress(&motion_of(squeezed));
        assert!((rest.stress.0[0] / whole.0[0] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn rotation_rotates_the_stress_and_damages_nothing() {
        let q = rotation();
        for law in [law(0.1), by_rankine(0.1)] {
            let (before, history, _) =
                follow(&law, (100, 1.0), |t| Matrix::IDENTITY + sample_gradients()[2] * (0.02 * t));
            let motion = Motion { deformation: q * before.deformation, increment: q, ..before };
            let after = law.respond(&motion, &history);
            let expected = before.stress.rotated(&q);
            assert!(history[0] > 0.1);
            assert!(after.stress.0.iter().zip(expected.0).all(|(s, e)| (s - e).abs() < 1e-10));
            assert!(after.history.iter().zip(history).all(|(a, b)| (a - b).abs() < 1e-12));
        }
    }

    /// A plate that is cracked across and then pressed along has a thickness without stress, however far it is broken.
    #[test]
    fn a_cracked_plate_that_is_pressed_has_a_thickness() {
        for law in [law(0.1), by_rankine(0.1)] {
            for opened in [1.5, 3.0, 10.0, 40.0] {
                let (mut along, mut across, mut history) = (1.0, 1.0, [0.0; 3]);
                let mut now = Motion { dt: 1.0, ..motion_of(Matrix::IDENTITY) };
                for step in 0..400 {
                    let (opens, presses) =
                        if step < 200 { (opened * onset() / 200.0, 0.0) } else { (0.0, 5e-4) };
                    (across, along) = (across + opens, along - presses);
                    let thick = now.deformation.0[2][2];
                    let deformation = Matrix([[across, 0.0, 0.0], [0.0, along, 0.0], [0.0, 0.0, thick]]);
                    let increment = deformation * now.deformation.inverse();
                    let motion = Motion { deformation, jacobian: deformation.det(), increment, ..now };
                    let thickening = thickening(&law, &motion, &history);
                    assert_eq!(thickening.found, 1, "{law:?} {opened} {step} {motion:?}");
                    let moved = motion.thickened(thickening.stretch);
                    let response = law.respond(&moved, &history);
                    let stress = response.stress;
                    assert!(stress.0[2].abs() < 1e-9 * ELASTIC.bulk_modulus, "{opened} {step}: {stress:?}");
                    (now, history) = (Motion { stress, ..moved }, response.history);
                }
                assert!(history[0] > 0.1, "{history:?}");
            }
        }
    }

    #[test]
    fn cells_that_snap_back_are_refused_with_the_largest_that_does_not() {
        let largest = 2.0 * ENERGY / (onset() * STRENGTH);
        let on = |cell| Damage { softening_strain: NEVER, ..law(0.1) }.on_grid(cell);
        assert!(on(0.99 * largest).is_ok());
        let bad = on(1.01 * largest).unwrap_err();
        assert_eq!(bad.key.as_deref(), Some(FRACTURE_ENERGY));
        assert!(bad.allowed.starts_with(&format!("cells below {largest:.4e} m")), "{bad}");
    }
}
