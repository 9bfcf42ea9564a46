//! The stable time step.

use crate::body::Body;
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
        let signal = |i: usize| {
            let particle = body.particles.get(i);
            let speed = particle.velocity.norm();
            // SAFETY: the particles are borrowed for reading.
            let history = unsafe { body.particles.view().history_of(i) };
            let modulus = body.wave_modulus(&particle, &history);
            ((modulus / body.density).sqrt() + speed).f64()
        };
        (0..body.particles.len()).into_par_iter().map(signal).reduce(|| 0.0, f64::max)
    };
    bodies.par_iter().map(of_body).reduce(|| 0.0, f64::max)
}
