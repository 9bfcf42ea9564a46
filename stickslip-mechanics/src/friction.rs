//! Friction of two surfaces: the coefficient by the speed of slip, and what of the pressure it remembers.

use crate::number::Real;
use serde::{Deserialize, Serialize};

/// The coefficient of surfaces that slip at a speed [m/s], from those at rest and in motion and the speed s_c over
/// which the one becomes the other (Oden and Martins 1985):
///
/// ```text
/// mu(s) = mu_k + (mu_s - mu_k) exp(-s / s_c)        s_c = 0: mu_k
/// ```
pub fn coefficient<T: Real>([at_rest, kinetic]: [T; 2], decay_speed: T, slip: T) -> T {
    if at_rest == kinetic {
        return at_rest;
    }
    let rest = if decay_speed > T::ZERO { T::of(libm::exp(-(slip / decay_speed).f64())) } else { T::ZERO };
    kinetic + (at_rest - kinetic) * rest
}

/// Friction that follows a change of the pressure p with a delay (Prakash and Clifton 1993, Ranjith and Rice 2001):
///
/// ```text
/// dS/dt = -(|slip speed| + V_0) / L (S - p),   |tau| <= mu S
/// ```
/// Friction that follows at once lets elastic bodies flutter at the shortest waves there are, whatever the grid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrictionMemory {
    /// L, the slip over which pressure is forgotten [m].
    pub length: f64,
    /// V_0, the speed at which surfaces forget that do not slip [m/s].
    pub speed: f64,
}

impl FrictionMemory {
    /// S after a step, of a point with this pressure [Pa] and slip speed [m/s].
    pub fn after(&self, remembered: f64, (pressure, slip, dt): (f64, f64, f64)) -> f64 {
        let share = libm::expm1(-(slip + self.speed) * dt / self.length);
        remembered + share * (remembered - pressure)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strength_follows_pressure_within_its_length() {
        // One length of slip: the difference falls to 1/e, in one step or in a thousand.
        let memory = FrictionMemory { length: 1e-3, speed: 0.0 };
        let mut many = 1.0;
        (0..1000).for_each(|_| many = memory.after(many, (3.0, 1.0, 1e-6)));
        let once = memory.after(1.0, (3.0, 1.0, 1e-3));
        let exact = 3.0 - 2.0 * (-1.0_f64).exp();
        assert!((many - exact).abs() < 1e-12 && (once - exact).abs() < 1e-14, "{many} {once}");
    }
}
