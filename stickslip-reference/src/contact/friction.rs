//! Friction at a point that touches.

/// Coulomb's friction: the coefficient at rest, in motion, and the slip speed over which the one becomes the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// At rest [-].
    pub at_rest: f64,
    /// In motion [-].
    pub kinetic: f64,
    /// mu = mu_k + (mu_s - mu_k) exp(-|u| / u_0) [m/s]; zero: at once.
    pub decay_speed: f64,
    /// How strength follows pressure; none: at once.
    pub memory: Option<FrictionMemory>,
}

/// Shear strength mu S follows the pressure p with a delay (Prakash and Clifton 1993, Ranjith and Rice 2001):
///
/// ```text
/// dS/dt = -(|slip speed| + V) / L (S - p)
/// ```
/// Friction that follows at once lets elastic bodies flutter at the shortest waves there are, whatever the grid. A point
/// that sticks has the strength of its pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionMemory {
    /// L [m].
    pub length: f64,
    /// V [m/s].
    pub speed: f64,
}

impl FrictionMemory {
    /// S after a step, of a point with this pressure [Pa] and slip speed [m/s].
    pub fn after(&self, remembered: f64, (pressure, slip, dt): (f64, f64, f64)) -> f64 {
        let share = (-(slip + self.speed) * dt / self.length).exp_m1();
        remembered + share * (remembered - pressure)
    }
}

impl Friction {
    /// The coefficient of a point that slips at this speed; zero where it sticks.
    pub fn coefficient(&self, speed: f64) -> f64 {
        if speed <= 0.0 || self.at_rest == self.kinetic {
            return self.at_rest;
        }
        let rest = if self.decay_speed > 0.0 { (-speed / self.decay_speed).exp() } else { 0.0 };
        self.kinetic + (self.at_rest - self.kinetic) * rest
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

    #[test]
    fn the_coefficient_falls_once_a_point_slips() {
        let friction = Friction { at_rest: 0.5, kinetic: 0.3, decay_speed: 0.1, memory: None };
        assert_eq!(friction.coefficient(0.0), 0.5);
        assert!((friction.coefficient(0.1) - (0.3 + 0.2 * (-1.0_f64).exp())).abs() < 1e-15);
        assert_eq!(Friction { decay_speed: 0.0, ..friction }.coefficient(1e-9), 0.3);
    }
}
