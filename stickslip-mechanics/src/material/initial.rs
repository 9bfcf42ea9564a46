//! Initial stress: the deformation that a law must see for its stress to be a given one.
//!
//! ```text
//! sigma(A) = sigma_0,   A = A^T          the law then sees F A, with F of the body as it is drawn
//! ```
//! Laws in rate form carry their stress along, whatever F is, and need no A.

use super::history::{AtRest, history_entries};
use super::{Keep, Material, Motion, Recall};
use crate::tensor::{Matrix, Symmetric};

/// Why a material cannot begin with a stress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoStretch {
    /// It would flow or break under it.
    Yields,
    /// No deformation gives it.
    None,
}

impl NoStretch {
    /// What of it to say.
    pub fn reason(self) -> &'static str {
        match self {
            NoStretch::Yields => "a stress under which the material neither flows nor breaks",
            NoStretch::None => {
                "a stress that some deformation gives by the material's law: none is beyond its strength, and a fluid \
                 bears none along its planes"
            }
        }
    }
}

/// What a law remembers of one particle.
struct Memory(Vec<f64>);

impl Recall<f64> for Memory {
    const DIMENSION: usize = 3;
    fn recall(&self, entry: usize) -> f64 {
        self.0[entry]
    }
}

impl Keep<f64> for Memory {
    fn keep(&mut self, entry: usize, value: f64) {
        self.0[entry] = value;
    }
}

/// Over the modulus: stresses nearer than this are the same, up to what F rounds to.
const SAME: f64 = 1e-13;
/// Trials of Newton's iteration; a sound stress takes five or so.
const MOST_TRIALS: usize = 60;
/// Halvings of a trial's step.
const MOST_HALVINGS: usize = 40;
/// Change of an entry of A that the derivative is taken over.
const CHANGE: f64 = 1e-7;

impl Material<f64> {
    /// Whether its stress is that of the step before, changed, whatever F is: asked of a pressure, which sand bears, too.
    pub fn carries_stress(&self) -> bool {
        let modulus = self.elastic().p_wave_modulus();
        self.carries(&Symmetric::isotropic(-1e-9 * modulus))
    }

    fn carries(&self, stress: &Symmetric<f64>) -> bool {
        let (kept, lost) = self.sudden(&Matrix::IDENTITY, stress);
        lost == 0.0 && kept.0.iter().zip(stress.0).all(|(a, b)| (a - b).abs() <= 1e-12 * b.abs())
    }

    /// Stress after a sudden deformation, and what it dissipates.
    fn sudden(&self, deformation: &Matrix<f64>, stress: &Symmetric<f64>) -> (Symmetric<f64>, f64) {
        let declared = self.history();
        let rest = AtRest(declared);
        let mut memory = Memory((0..history_entries(declared, 3)).map(|entry| rest.recall(entry)).collect());
        let motion = Motion {
            deformation: *deformation,
            jacobian: deformation.det(),
            increment: *deformation,
            stress: *stress,
            dt: 0.0,
        };
        let after = self.respond(&motion, &mut memory);
        let [_, lost] = self.energies(deformation, &after, &memory);
        (after, lost)
    }

    /// A, the symmetric deformation with this Cauchy stress; the identity where the law carries its stress.
    ///
    /// # Errors
    /// The material flows or breaks under it, or no deformation gives it.
    pub fn stretch_under(&self, stress: &Symmetric<f64>) -> Result<Symmetric<f64>, NoStretch> {
        if !stress.is_finite() {
            return Err(NoStretch::None);
        }
        if self.carries_stress() {
            let sound = self.carries(stress);
            return if sound { Ok(Symmetric::isotropic(1.0)) } else { Err(NoStretch::Yields) };
        }
        let modulus = self.elastic().p_wave_modulus();
        let off = |stretch: &Symmetric<f64>| {
            let (found, _) = self.sudden(&stretch.matrix(), &Symmetric::ZERO);
            (found - *stress) * (1.0 / modulus)
        };
        let size = |off: &Symmetric<f64>| off.double_dot(off).sqrt();
        let mut stretch = Symmetric::isotropic(1.0);
        let mut now = off(&stretch);
        for _ in 0..MOST_TRIALS {
            if size(&now) <= SAME {
                break;
            }
            let columns: [Symmetric<f64>; 6] = std::array::from_fn(|k| {
                let mut other = stretch;
                other.0[k] += CHANGE;
                (off(&other) - now) * (1.0 / CHANGE)
            });
            let step = solve(&columns, &now);
            let mut share = 1.0;
            let nearer = (0..MOST_HALVINGS).find_map(|_| {
                let trial = stretch - step * share;
                share *= 0.5;
                let there = (is_positive(&trial)).then(|| off(&trial))?;
                (there.is_finite() && size(&there) < size(&now)).then_some((trial, there))
            });
            let Some((trial, there)) = nearer else { break };
            (stretch, now) = (trial, there);
        }
        let (_, lost) = self.sudden(&stretch.matrix(), &Symmetric::ZERO);
        if lost != 0.0 {
            return Err(NoStretch::Yields);
        }
        if size(&now) <= 10.0 * SAME { Ok(stretch) } else { Err(NoStretch::None) }
    }
}

/// Whether a symmetric matrix stretches every direction by more than nothing (Sylvester).
fn is_positive(a: &Symmetric<f64>) -> bool {
    a.0[0] > 0.0 && a.0[0] * a.0[1] > a.0[3] * a.0[3] && a.matrix().det() > 0.0
}

/// Pivots below this, over the largest entry, are none: along there nothing can be done.
const NOTHING: f64 = 1e-6;

/// x of sum_k columns_k x_k = right (Gauss, with pivots by rows); unknowns on which nothing depends are zero.
fn solve(columns: &[Symmetric<f64>; 6], right: &Symmetric<f64>) -> Symmetric<f64> {
    let mut rows: [[f64; 7]; 6] =
        std::array::from_fn(|i| std::array::from_fn(|k| if k < 6 { columns[k].0[i] } else { right.0[i] }));
    let largest = columns.iter().flat_map(|column| column.0).map(f64::abs).fold(0.0, f64::max);
    let (mut used, mut of) = (0, [None; 6]);
    for k in 0..6 {
        let best = (used..6).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs()));
        let Some(best) = best.filter(|&i| rows[i][k].abs() > NOTHING * largest) else { continue };
        rows.swap(used, best);
        let pivot = rows[used];
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != used) {
            let factor = row[k] / pivot[k];
            row.iter_mut().zip(pivot).for_each(|(entry, pivot)| *entry -= factor * pivot);
        }
        of[k] = Some(used);
        used += 1;
    }
    Symmetric(std::array::from_fn(|k| of[k].map_or(0.0, |row: usize| rows[row][6] / rows[row][k])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Given, LAWS};

    fn law(name: &str, more: &[(&str, f64)]) -> Material<f64> {
        let law = LAWS.iter().find(|law| law.name == name).expect("a law of the list");
        let mut given: Given = [("bulk_modulus", 6.0), ("shear_modulus", 3.0)].into();
        for &(name, value) in more {
            given = given.with(name, value);
        }
        if name == "ogden" {
            given.put("terms", vec![2.0, 2.0, -1.0, -2.0]);
        }
        if name == "viscoelastic" {
            given.put("prony", vec![0.5, 0.1]);
        }
        (law.build)(&given).unwrap_or_else(|bad| panic!("{bad:?}"))
    }

    fn laws() -> Vec<Material<f64>> {
        let flows = [("yield_stress", 3.0), ("hardening_modulus", 0.0)];
        let by_rate = [("hardening_exponent", 1.0), ("rate_coefficient", 0.1), ("reference_rate", 1.0)];
        let crushed = [("plateau_stress", 40.0), ("plastic_poisson_ratio", 0.0), ("hardening_modulus", 0.0)];
        let moves = [("kinematic_modulus", 1.0), ("dynamic_recovery", 1.0)];
        vec![
            law("hencky", &[]),
            law("mooney_rivlin", &[("c10", 1.0), ("c01", 0.5)]),
            law("ogden", &[]),
            law("johnson_cook", &[&flows[..], &by_rate].concat()),
            law("armstrong_frederick", &[&flows[..], &moves].concat()),
            law("crushable_foam", &crushed),
            law("neo_hookean", &[]),
            law("hypoelastic", &[]),
            law("von_mises", &[("yield_stress", 3.0), ("hardening_modulus", 0.0)]),
            law("viscoelastic", &[]),
            law("damage", &[("tensile_strength", 3.0), ("fracture_energy", 1e3), ("strength_ratio", 10.0)])
                .on_grid(0.1)
                .expect("cells are small"),
            law("damage", &[("tensile_strength", 3.0), ("fracture_energy", 1e3)])
                .on_grid(0.1)
                .expect("cells are small"),
        ]
    }

    /// A law sees the stretch, and says the stress.
    #[test]
    fn every_law_finds_its_stretch() {
        for law in laws() {
            for stress in [
                [0.0; 6],
                [-1e-6, 0.0, 0.0, 0.0, 0.0, 0.0],
                [-1.0, -1.5, -0.5, 0.2, -0.1, 0.3],
                [0.3, 0.2, 0.1, -0.2, 0.0, 0.0],
                [-20.0, -20.0, -20.0, 0.0, 0.0, 0.0],
            ] {
                let stress = Symmetric(stress);
                let found =
                    law.stretch_under(&stress).unwrap_or_else(|no| panic!("{law:?} {stress:?} {no:?}"));
                let before = if law.carries_stress() { stress } else { Symmetric::ZERO };
                let (after, lost) = law.sudden(&found.matrix(), &before);
                let off = after - stress;
                assert!(off.double_dot(&off).sqrt() < 1e-11 && lost == 0.0, "{law:?} {after:?}");
            }
        }
        assert_eq!(
            laws().iter().map(Material::carries_stress).collect::<Vec<_>>(),
            [false, false, false, true, true, true, false, true, true, false, false, false]
        );
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let far = Symmetric([0.0, 0.0, 0.0, 5.0, 0.0, 0.0]);
        let [.., flows, _, breaks, _] = &laws()[..] else { panic!("laws") };
        assert_eq!(flows.stretch_under(&far), Err(NoStretch::Yields));
        assert!(breaks.stretch_under(&Symmetric([4.0, 0.0, 0.0, 0.0, 0.0, 0.0])).is_err());
        let water = |name: &str| {
            let law = LAWS.iter().find(|law| law.name == name).expect("a law of the list");
            (law.build)(&[("bulk_modulus", 6.0), ("shear_modulus", 0.0)].into()).expect("a fluid")
        };
        let fluid = water("neo_hookean");
        assert_eq!(fluid.stretch_under(&far), Err(NoStretch::None));
        let pressed = fluid.stretch_under(&Symmetric::isotropic(-0.6)).expect("a fluid bears pressure");
        // K/2 (J - 1/J) = -0.6
        let j = pressed.matrix().det();
        assert!((3.0 * (j - 1.0 / j) + 0.6).abs() < 1e-11, "{pressed:?}");
        assert_eq!(law("neo_hookean", &[]).stretch_under(&Symmetric([f64::NAN; 6])), Err(NoStretch::None));
    }
}
