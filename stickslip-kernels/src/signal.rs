//! How fast waves and particles are.

use crate::lanes::Lanes;
use crate::tensor::Number;

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

/// Lanes in which [`signal_speed`] is at most this, told without a root:  2 sqrt(a b) <= most^2 - a - b. Those that may
/// be faster by round-off only are not among them, so that the fastest is found whatever comes first.
#[inline(always)]
pub fn no_faster<V: Lanes>([wave, speed]: [V; 2], most: V) -> u32 {
    let surely = V::splat(V::Real::ONE - V::Real::EPSILON * V::Real::of(16.0));
    let rest = most * most * surely - wave - speed;
    let product = wave * speed;
    rest.at_least(V::ZERO) & (rest * rest).at_least((product + product) + (product + product))
}
