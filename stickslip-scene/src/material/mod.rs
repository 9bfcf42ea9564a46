//! Constitutive laws: pure functions from local motion to Cauchy stress, one file each, and the shelf that lists them.
//!
//! To add a law: write its file (constants, [`Law`], tests) and put it on the shelf below. Scene files, the schema and the
//! engine find it there.

mod elastic;
mod hypoelastic;
mod neo_hookean;
mod plane_stress;
mod von_mises;

pub use elastic::Isotropic;
pub use hypoelastic::Hypoelastic;
pub use neo_hookean::NeoHookean;
pub use plane_stress::Thickness;
pub use von_mises::VonMises;

use crate::tensor::{Matrix, Number, Real, Symmetric};
use serde::Serialize;
use std::collections::BTreeMap;

/// What a law is told of a particle.
#[derive(Clone, Copy, Debug)]
pub struct Motion<T> {
    /// Deformation gradient F at the end of the step [-].
    pub deformation: Matrix<T>,
    /// Determinant of F, positive [-].
    pub jacobian: T,
    /// Deformation of this step alone, I + L dt [-].
    pub increment: Matrix<T>,
    /// Cauchy stress at the start of the step, tension positive [Pa].
    pub stress: Symmetric<T>,
    /// Equivalent plastic strain at the start of the step, sqrt(2/3 D_p : D_p) over time; zero for laws that do not flow [-].
    pub plastic_strain: T,
}

/// What a law answers.
#[derive(Clone, Copy, Debug)]
pub struct Response<T> {
    /// Cauchy stress at the end of the step, tension positive [Pa].
    pub stress: Symmetric<T>,
    /// Equivalent plastic strain at the end of the step [-].
    pub plastic_strain: T,
}

/// A constitutive law in three dimensions.
///
/// A law is written once over [`Number`], with no branch on the motion: the engine calls it for several particles at a time.
pub trait Law<T: Number>: Send + Sync {
    /// Cauchy stress at the end of the step, tension positive [Pa].
    fn stress(&self, motion: &Motion<T>) -> Symmetric<T>;

    /// Stress and plastic strain at the end of the step; a law that does not flow leaves the latter alone.
    #[inline(always)]
    fn response(&self, motion: &Motion<T>) -> Response<T> {
        Response { stress: self.stress(motion), plastic_strain: motion.plastic_strain }
    }

    /// What plastic flow up to this strain dissipated per undeformed volume [J/m^3].
    #[inline(always)]
    fn dissipation(&self, _plastic_strain: T) -> T {
        T::ZERO
    }

    /// Strain energy per undeformed volume in a state of deformation and Cauchy stress [J/m^3].
    fn strain_energy(&self, deformation: &Matrix<T>, stress: &Symmetric<T>) -> T;

    /// Stiffness against a longitudinal wave in the present state, times J [Pa]: over the undeformed density it is the squared wave speed.
    fn wave_modulus(&self, deformation: &Matrix<T>, jacobian: T) -> T;

    /// Stiffness against a shear wave in the present state, times J [Pa]; plane stress needs it for its waves.
    fn shear_modulus(&self, deformation: &Matrix<T>, jacobian: T) -> T;
}

/// The shelf: every law with its constants.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Material<T> {
    /// See [`NeoHookean`].
    NeoHookean(NeoHookean<T>),
    /// See [`Hypoelastic`].
    Hypoelastic(Hypoelastic<T>),
    /// See [`VonMises`].
    VonMises(VonMises<T>),
}

/// A law as scene files name it.
pub struct Description {
    /// Key in a scene file.
    pub name: &'static str,
    /// One sentence for the schema.
    pub summary: &'static str,
    /// Its constants.
    pub constants: &'static [Constant],
    build: Build,
}

type Build = fn(&BTreeMap<String, f64>) -> Result<Material<f64>, BadConstants>;

/// A constant of a law as scene files name it.
#[derive(Clone, Copy)]
pub struct Constant {
    /// Key in a scene file.
    pub name: &'static str,
    /// One sentence for the schema.
    pub summary: &'static str,
    /// Powers of kilogram, metre and second.
    pub dimension: [i8; 3],
}

/// Powers of kilogram, metre and second of a pressure or a modulus.
const PRESSURE: [i8; 3] = [1, -1, -2];

/// Constants from which no stable material can be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{found}; {allowed}")]
pub struct BadConstants {
    /// The constant at fault, if it is one alone.
    pub key: Option<String>,
    /// What was found.
    pub found: String,
    /// What is allowed.
    pub allowed: String,
}

/// Every law that a scene file can name.
pub const SHELF: &[Description] = &[
    Description {
        name: "neo_hookean",
        summary: "Compressible neo-Hookean elasticity for large strains (Simo and Hughes 1998).",
        constants: &elastic::CONSTANTS,
        build: |values| Ok(Material::NeoHookean(NeoHookean { elastic: Isotropic::from_constants(values)? })),
    },
    Description {
        name: "hypoelastic",
        summary: "Linear elasticity in rate form with an objective stress rate, for small strains and large rotations.",
        constants: &elastic::CONSTANTS,
        build: |values| {
            Ok(Material::Hypoelastic(Hypoelastic { elastic: Isotropic::from_constants(values)? }))
        },
    },
    Description {
        name: "von_mises",
        summary: "Plastic flow at a yield stress that may harden, elastic below it as the hypoelastic law, for metals and clay.",
        constants: von_mises::CONSTANTS,
        build: |values| Ok(Material::VonMises(VonMises::from_constants(values)?)),
    },
];

impl Description {
    /// The material with these constants in SI units.
    ///
    /// # Errors
    /// Constants that are missing, too many, or of no stable material.
    pub fn build(&self, values: &BTreeMap<String, f64>) -> Result<Material<f64>, BadConstants> {
        (self.build)(values)
    }
}

impl Material<f64> {
    /// The same material in the precision of the engine.
    pub fn cast<T: Real>(&self) -> Material<T> {
        self.map(T::of)
    }

    /// Elastic moduli at small strain.
    pub fn elastic(&self) -> Isotropic<f64> {
        match self {
            Material::NeoHookean(law) => law.elastic,
            Material::Hypoelastic(law) => law.elastic,
            Material::VonMises(law) => law.elastic.elastic,
        }
    }
}

impl<T: Number> Material<T> {
    /// The same material with its constants in other numbers.
    #[inline(always)]
    pub fn map<U: Number>(&self, f: impl Fn(T) -> U) -> Material<U> {
        match self {
            Material::NeoHookean(law) => Material::NeoHookean(NeoHookean { elastic: law.elastic.map(f) }),
            Material::Hypoelastic(law) => Material::Hypoelastic(Hypoelastic { elastic: law.elastic.map(f) }),
            Material::VonMises(law) => Material::VonMises(law.map(f)),
        }
    }

    /// The law behind the name; ask once per body, not once per particle.
    pub fn law(&self) -> &dyn Law<T> {
        match self {
            Material::NeoHookean(law) => law,
            Material::Hypoelastic(law) => law,
            Material::VonMises(law) => law,
        }
    }

    /// Whether plastic strain is a part of a particle's state.
    #[inline(always)]
    pub fn flows(&self) -> bool {
        matches!(self, Material::VonMises(_))
    }

    /// [`Law::response`] where the compiler can see it.
    #[inline(always)]
    pub fn response(&self, motion: &Motion<T>) -> Response<T> {
        match self {
            Material::NeoHookean(law) => law.response(motion),
            Material::Hypoelastic(law) => law.response(motion),
            Material::VonMises(law) => law.response(motion),
        }
    }

    /// [`Law::strain_energy`] where the compiler can see it.
    #[inline(always)]
    pub fn strain_energy(&self, deformation: &Matrix<T>, stress: &Symmetric<T>) -> T {
        match self {
            Material::NeoHookean(law) => law.strain_energy(deformation, stress),
            Material::Hypoelastic(law) => law.strain_energy(deformation, stress),
            Material::VonMises(law) => law.strain_energy(deformation, stress),
        }
    }

    /// [`Law::dissipation`] where the compiler can see it.
    #[inline(always)]
    pub fn dissipation(&self, plastic_strain: T) -> T {
        match self {
            Material::NeoHookean(law) => law.dissipation(plastic_strain),
            Material::Hypoelastic(law) => law.dissipation(plastic_strain),
            Material::VonMises(law) => law.dissipation(plastic_strain),
        }
    }

    /// Stiffness against the fastest wave in the present state, times J [Pa]: [`Law::wave_modulus`], in plane stress that of a plate.
    #[inline(always)]
    pub fn wave_modulus(&self, thickness: Thickness, deformation: &Matrix<T>, jacobian: T) -> T {
        match self {
            Material::NeoHookean(law) => fastest(law, thickness, deformation, jacobian),
            Material::Hypoelastic(law) => fastest(law, thickness, deformation, jacobian),
            Material::VonMises(law) => fastest(law, thickness, deformation, jacobian),
        }
    }
}

impl<T: Real> Material<T> {
    /// The motion with the thickness that the particle takes, and the response to it; `None` if no thickness is free of stress.
    pub fn respond(&self, thickness: Thickness, motion: Motion<T>) -> Option<(Motion<T>, Response<T>)> {
        match thickness {
            Thickness::Moved => Some((motion, self.response(&motion))),
            Thickness::Free => plane_stress::with_free_thickness(self.law(), &motion),
        }
    }
}

#[inline(always)]
fn fastest<T: Number>(law: &impl Law<T>, thickness: Thickness, deformation: &Matrix<T>, jacobian: T) -> T {
    let waves = law.wave_modulus(deformation, jacobian);
    match thickness {
        Thickness::Moved => waves,
        Thickness::Free => plane_stress::plate_modulus(waves, law.shear_modulus(deformation, jacobian)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Displacement gradients of moderate size in every direction.
    pub fn sample_gradients() -> Vec<Matrix<f64>> {
        vec![
            Matrix([[0.1, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]),
            Matrix([[0.0, 0.2, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]),
            Matrix([[-0.1, 0.05, 0.02], [0.07, 0.12, -0.03], [-0.04, 0.06, 0.08]]),
        ]
    }

    /// The motion that leads to `f` in one step from rest.
    pub fn motion_of(f: Matrix<f64>) -> Motion<f64> {
        Motion {
            deformation: f,
            jacobian: f.det(),
            increment: f,
            stress: Symmetric::ZERO,
            plastic_strain: 0.0,
        }
    }

    /// sigma = (K - 2G/3) tr(e) I + 2 G e
    pub fn hooke(elastic: &Isotropic<f64>, strain: &Symmetric<f64>) -> Symmetric<f64> {
        let lame = elastic.bulk_modulus - 2.0 / 3.0 * elastic.shear_modulus;
        Symmetric::isotropic(lame * strain.trace()) + *strain * (2.0 * elastic.shear_modulus)
    }

    /// A turn by 0.7 rad about (1, 2, 2)/3, after Rodrigues.
    pub fn rotation() -> Matrix<f64> {
        let n = [1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0];
        let k = Matrix([[0.0, -n[2], n[1]], [n[2], 0.0, -n[0]], [-n[1], n[0], 0.0]]);
        let angle: f64 = 0.7;
        Matrix::IDENTITY + k * angle.sin() + k * k * (1.0 - angle.cos())
    }
}
