//! The stable time step.

use crate::body::{Body, Particle};
use crate::tensor::Real;
use rayon::prelude::*;

/// Fastest signal over all particles: wave speed plus particle speed [m/s].
///
/// ```text
/// c + |v|,   c^2 = M J / rho_0          M: P-wave modulus in the present state, in plane stress a plate's
/// ```
/// A step dt = courant h / max(c + |v|) lets no signal cross more than that fraction of a cell (Courant, Friedrichs and Lewy 1928).
pub fn fastest_signal<T: Real, const D: usize>(bodies: &[Body<T, D>]) -> f64 {
    let of_body = |body: &Body<T, D>| {
        let signal = |particle: Particle<T, D>| {
            let speed = particle.velocity.norm();
            let modulus = body.wave_modulus(&particle.deformation, particle.deformation.det());
            ((modulus / body.density).sqrt() + speed).f64()
        };
        (0..body.particles.len())
            .into_par_iter()
            .map(|i| signal(body.particles.get(i)))
            .reduce(|| 0.0, f64::max)
    };
    bodies.par_iter().map(of_body).reduce(|| 0.0, f64::max)
}
