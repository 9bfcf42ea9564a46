//! What a picture shows: a snapshot, and of each particle the value that colour stands for.

use super::quantity::{ColorQuantity, Parts};
use super::smooth::Smoother;
use rayon::prelude::*;
use stickslip::door::ParticleSnapshot;

/// A snapshot with the value of each particle that colour stands for.
pub struct Subject<'a> {
    /// The particles.
    pub particles: &'a ParticleSnapshot,
    /// What colour stands for.
    pub quantity: &'a ColorQuantity,
    /// In SI units; averaged over neighbours where they are to be.
    pub values: Vec<f64>,
    /// What the values are averaged by.
    smoother: Option<Smoother>,
}

impl<'a> Subject<'a> {
    /// The values of a snapshot, averaged over neighbours or each particle's own.
    pub fn new(particles: &'a ParticleSnapshot, quantity: &'a ColorQuantity, smooth: bool) -> Self {
        let smooth = smooth && *quantity != ColorQuantity::Body;
        let smoother = smooth.then(|| smoother(particles, quantity));
        let value = |i: usize| {
            let fitted = smoother.as_ref().and_then(|all| all.at(particles.body[i], particles.position[i]));
            quantity.value_of(fitted.unwrap_or_else(|| quantity.parts(particles, i)))
        };
        let values = (0..particles.body.len()).into_par_iter().map(value).collect();
        Subject { particles, quantity, values, smoother }
    }

    /// What the values are averaged by, if they are.
    pub fn smoother(&self) -> Option<&Smoother> {
        self.smoother.as_ref()
    }
}

/// Averages what the values of a quantity are made of.
pub fn smoother(particles: &ParticleSnapshot, quantity: &ColorQuantity) -> Smoother {
    Smoother::new(particles, |i| quantity.parts(particles, i))
}

/// Averages velocities.
pub fn velocities(particles: &ParticleSnapshot) -> Smoother {
    let parts = |i: usize| -> Parts {
        let [x, y, z] = particles.velocity[i];
        [x, y, z, 0.0, 0.0, 0.0]
    };
    Smoother::new(particles, parts)
}
