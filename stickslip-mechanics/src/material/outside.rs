//! A law that a scene file only names, with its moduli at small strain; the program that runs the scene gives it.

use super::declaration::{Constant, Given};
use super::{BadConstants, CustomLaw, Isotropic, Material, Motion, elastic};
use crate::outside::{GIVEN, OUTSIDE, OutsideFault};
use crate::tensor::{Matrix, Symmetric};

/// The constants that a scene file gives such a law.
pub const OUTSIDE_CONSTANTS: &[Constant] = &elastic::CONSTANTS;

/// Particles of a body as a law over arrays is asked of them: rows are particles by their numbers.
#[derive(Debug)]
pub struct LawArrays<'a> {
    /// Time at the end of the step [s].
    pub time: f64,
    /// How long the step takes [s].
    pub dt: f64,
    /// Deformation gradient F at the end of the step, row by row [-].
    pub deformation: &'a [[f64; 9]],
    /// Cauchy stress, xx yy zz xy yz xz, tension positive [Pa]: that at the start of the step, to be changed into that
    /// at its end.
    pub stress: &'a mut [[f64; 6]],
    /// The components in space of one column of history after the other, likewise.
    pub history: &'a mut [f64],
}

/// A [`CustomLaw`] that answers for all particles of a body at once, between two passes over them.
///
/// The engine asks [`CustomLaw::respond`] first, particle by particle, whose stress then is that at the start of the
/// step; it may note of the motion in the history what arrays do not have.
pub trait LawOverArrays: std::fmt::Debug + Send + Sync {
    /// Stress and history at the end of the step. It must depend on nothing else.
    ///
    /// # Errors
    /// Whatever keeps it from an answer; it ends the step.
    fn respond(&self, particles: LawArrays<'_>) -> Result<(), OutsideFault>;
}

/// The name of a law that nobody has given yet.
#[derive(Debug)]
struct Missing {
    name: &'static str,
    elastic: Isotropic<f64>,
}

/// The place of a law of this name with these elastic constants, which [`Material::check`] refuses until
/// [`Material::custom`] with the law itself stands there. The name stays in memory.
///
/// # Errors
/// Constants that are missing, too many, or of no stable material.
pub fn outside_law(name: String, given: &Given) -> Result<Material<f64>, BadConstants> {
    let elastic = Isotropic::build(given)?;
    Ok(Material::custom(Box::leak(Box::new(Missing { name: name.leak(), elastic }))))
}

impl CustomLaw for Missing {
    fn name(&self) -> &'static str {
        self.name
    }

    fn key(&self) -> &'static str {
        OUTSIDE
    }

    fn check(&self) -> Result<(), BadConstants> {
        Err(BadConstants::of("law", format!("the law `{}`, which is not given", self.name), GIVEN))
    }

    fn elastic(&self) -> Isotropic<f64> {
        self.elastic
    }

    fn respond(&self, _: &Motion<f64>, _: &mut [f64]) -> Symmetric<f64> {
        Symmetric::isotropic(f64::NAN)
    }

    fn strain_energy(&self, _: &Matrix<f64>, _: &Symmetric<f64>, _: &[f64]) -> f64 {
        f64::NAN
    }
}
