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

/// Friction that follows a change of the pressure p with a delay (Prakash and Clifton 1993, Ranjith and Rice 2001), of a
/// point that touches for a time t:
///
/// ```text
/// dS/dt = -max((|slip speed| + V_0) / L, 30 / t) (S - p),   |tau| <= mu S
/// ```
/// Friction that follows at once lets elastic bodies flutter at the shortest waves there are, whatever the grid. What
/// has touched for a short time only follows sooner: bodies that bounce and roll rub as without a memory.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrictionMemory {
    /// L, the slip over which pressure is forgotten [m]; zero: at once.
    pub length: f64,
    /// V_0, the speed at which surfaces forget that do not slip [m/s].
    pub speed: f64,
}

/// How often a point forgets in the time for which it has touched, at least: a disk thrown onto a floor at an angle
/// rubs by 1.018 times its coefficient, by 1.036 with 10; a dragged block by the same with 10, 30 and 100.
const FRESH: f64 = 30.0;

impl FrictionMemory {
    /// S after a step, of a point with this pressure [Pa] and slip speed [m/s] that has touched for so long [s].
    pub fn after(&self, remembered: f64, (pressure, slip, dt): (f64, f64, f64), touched: f64) -> f64 {
        let rate = ((slip + self.speed) / self.length).max(FRESH / touched);
        let share = libm::expm1(-rate * dt);
        remembered + share * (remembered - pressure)
    }

    /// Within which time surfaces that do not slip follow pressure [s].
    pub fn time(&self) -> f64 {
        self.length / self.speed
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
        (0..1000).for_each(|_| many = memory.after(many, (3.0, 1.0, 1e-6), f64::INFINITY));
        let once = memory.after(1.0, (3.0, 1.0, 1e-3), f64::INFINITY);
        let exact = 3.0 - 2.0 * (-1.0_f64).exp();
        assert!((many - exact).abs() < 1e-12 && (once - exact).abs() < 1e-14, "{many} {once}");
        // One that has just come follows sooner.
        let fresh = memory.after(1.0, (3.0, 1.0, 1e-6), 1e-6);
        assert!((fresh - 3.0).abs() < 1e-12, "{fresh}");
    }
}
