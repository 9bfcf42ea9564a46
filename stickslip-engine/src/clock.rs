//! The stable time step.

use crate::body::Body;
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
/// A step dt = courant h / max(c + |v|) lets no signal cross more than that fraction of a cell (Courant,
/// Friedrichs and Lewy 1928).
pub fn fastest_signal<T: Real, const D: usize>(bodies: &[Body<T, D>]) -> f64 {
    let of_body = |body: &Body<T, D>| {
        let signal = |i: usize| {
            let particle = body.particles.get(i);
            let speed = particle.velocity.norm();
            // SAFETY: the particles are borrowed for reading.
            let history = unsafe { body.particles.view().history_of(i) };
            let modulus = body.wave_modulus(&particle, &history);
            ((modulus / body.density).sqrt() + speed).f64()
        };
        by_parts(body.particles.len(), PARTICLES, |range: Range<usize>| range.map(signal).fold(0.0, f64::max))
            .into_iter()
            .fold(0.0, f64::max)
    };
    by_parts(bodies.len(), 1, |range| range.map(|i| of_body(&bodies[i])).fold(0.0, f64::max))
        .into_iter()
        .fold(0.0, f64::max)
}
