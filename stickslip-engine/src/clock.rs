//! The stable time step.

use crate::body::{Body, Particle};
use crate::lanes::Lanes;
use crate::material::Recall;
use crate::tensor::{Number, Real};
use crate::threads::by_parts;
use std::ops::Range;

/// Particles that a thread takes at a time.
const PARTICLES: usize = 4096;

/// Wave speed plus a particle's speed [m/s], from their squares.
///
/// ```text
/// c + |v|,   c^2 = M J / rho_0          M: P-wave modulus in the present state, in plane stress a plate's
/// ```
/// A step dt = courant h / max(c + |v|) lets no signal cross more than that fraction of a cell (Courant,
/// Friedrichs and Lewy 1928).
#[inline(always)]
pub fn signal_speed<N: Number>([wave, speed]: [N; 2]) -> N {
    wave.sqrt() + speed.sqrt()
}

/// Lanes in which [`signal_speed`] is at most this, told without a root:  2 sqrt(a b) <= most^2 - a - b.
#[inline(always)]
pub fn no_faster<V: Lanes>([wave, speed]: [V; 2], most: V) -> u32 {
    let rest = most * most - wave - speed;
    let product = wave * speed;
    rest.at_least(V::ZERO) & (rest * rest).at_least((product + product) + (product + product))
}

/// [`signal_speed`] of a particle [m/s]; of a rigid body's its speed: no wave runs there.
pub fn signal<T: Real, const D: usize>(
    body: &Body<T, D>,
    particle: &Particle<T, D>,
    history: &impl Recall<T>,
) -> T {
    let velocity = particle.velocity;
    let wave = if body.is_rigid() { T::ZERO } else { body.wave_modulus(particle, history) / body.density };
    signal_speed([wave, velocity.dot(velocity)])
}

/// The fastest [`signal`] of all particles [m/s].
pub fn fastest_signal<T: Real, const D: usize>(bodies: &[Body<T, D>]) -> f64 {
    let of_body = |body: &Body<T, D>| {
        let of_particle = |i: usize| {
            // SAFETY: the particles are borrowed for reading.
            let history = unsafe { body.particles.view().history_of(i) };
            let mut particle = body.particles.get(i);
            if let Some(natural) = body.particles.natural(i, body.expansion) {
                particle.deformation = natural.elastic(&particle.deformation, T::ONE).0;
            }
            signal(body, &particle, &history).f64()
        };
        let fastest = |range: Range<usize>| range.map(of_particle).fold(0.0, f64::max);
        by_parts(body.particles.len(), PARTICLES, fastest).into_iter().fold(0.0, f64::max)
    };
    by_parts(bodies.len(), 1, |range| range.map(|i| of_body(&bodies[i])).fold(0.0, f64::max))
        .into_iter()
        .fold(0.0, f64::max)
}
