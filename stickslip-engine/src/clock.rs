//! The stable time step.

use crate::body::{Body, Particle};
use crate::material::Recall;
use crate::particles::ColumnStart;
use crate::tensor::Real;
use crate::threads::by_parts;
use std::ops::Range;
pub use stickslip_kernels::signal::{no_faster, signal_speed};

/// Particles that a thread takes at a time.
const PARTICLES: usize = 4096;

/// [`signal_speed`] of a particle [m/s]; of a rigid body's its speed: no wave runs there.
pub fn signal<T: Real, const D: usize>(
    body: &Body<T, D>,
    particle: &Particle<T, D>,
    history: &impl Recall<T>,
) -> T {
    let velocity = particle.velocity;
    let wave = if body.is_rigid() {
        T::ZERO
    } else {
        body.matter.wave_modulus(particle, history) / body.matter.density
    };
    signal_speed([wave, velocity.dot(velocity)])
}

/// A particle that is faster than others.
#[derive(Clone, Copy, Debug)]
pub struct Fastest {
    /// Its body.
    pub body: usize,
    /// Its place in memory there.
    pub particle: usize,
    /// Its number there.
    pub number: u32,
    /// How fast it is [m/s].
    pub speed: f64,
}

impl Fastest {
    /// The fastest of some, of equal ones the first by body and number.
    fn of(some: impl Iterator<Item = Fastest>) -> Option<Fastest> {
        some.fold(None, |fastest: Option<Fastest>, next| {
            let Some(now) = fastest else { return (next.speed > -1.0).then_some(next) };
            let first = (next.body, next.number) < (now.body, now.number);
            Some(if next.speed > now.speed || next.speed == now.speed && first { next } else { now })
        })
    }

    /// The fastest of the particles of a body, which have these numbers, by what `speed` says of each.
    fn in_body(numbers: &[u32], body: usize, speed: impl Fn(usize) -> f64 + Sync) -> Option<Fastest> {
        let of_particle =
            |particle: usize| Fastest { body, particle, number: numbers[particle], speed: speed(particle) };
        let of_part = |range: Range<usize>| Fastest::of(range.map(of_particle));
        Fastest::of(by_parts(numbers.len(), PARTICLES, of_part).into_iter().flatten())
    }
}

/// The particle with the fastest [`signal`] of all, in cells of the common grid: those of a body on a finer grid of its
/// own are so much faster. None where there are no particles.
pub fn fastest_signal<T: Real, const D: usize>(
    bodies: &[Body<T, D>],
    finer: &(dyn Fn(usize) -> f64 + Sync),
) -> Option<Fastest> {
    let of_body = |i: usize| {
        let (body, finer) = (&bodies[i], finer(i));
        let of_particle = |p: usize| {
            // SAFETY: the particles are borrowed for reading.
            let history = unsafe { body.particles.view().history_of(p) };
            let mut particle = body.particles.get(p);
            if let Some(natural) = body.particles.natural(p, body.matter.expansion) {
                particle.deformation = natural.elastic(&particle.deformation, T::ONE).0;
            }
            signal(body, &particle, &history).f64() * finer
        };
        Fastest::in_body(body.particles.numbers(), i, of_particle)
    };
    let of_bodies = by_parts(bodies.len(), 1, |range| of_body(range.start));
    Fastest::of(of_bodies.into_iter().flatten())
}

/// The particle of a body that moves fastest against a velocity [m/s].
pub fn fastest_motion<T: Real, const D: usize>(
    bodies: &[Body<T, D>],
    body: usize,
    against: [f64; 3],
) -> Option<Fastest> {
    let particles = &bodies[body].particles;
    let velocity: [&[T]; D] = std::array::from_fn(|axis| particles.line(ColumnStart::<D>::VELOCITY + axis));
    let square = |particle: usize| {
        let along = |axis: usize| velocity[axis][particle].f64() - against[axis];
        (0..D).map(|axis| along(axis) * along(axis)).sum()
    };
    let fastest = Fastest::in_body(particles.numbers(), body, square);
    fastest.map(|fastest| Fastest { speed: fastest.speed.sqrt(), ..fastest })
}
