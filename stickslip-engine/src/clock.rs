//! The stable time step.

use crate::body::{Body, Particle};
use crate::tensor::Real;
use crate::threads::by_parts;
use std::ops::Range;

/// Particles that a thread takes at a time.
const PARTICLES: usize = 4096;

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
        let fastest = |range: Range<usize>| range.map(|i| signal(body.particles.get(i))).fold(0.0, f64::max);
        by_parts(body.particles.len(), PARTICLES, fastest).into_iter().fold(0.0, f64::max)
    };
    by_parts(bodies.len(), 1, |range| range.map(|i| of_body(&bodies[i])).fold(0.0, f64::max))
        .into_iter()
        .fold(0.0, f64::max)
}
