//! Friction at a point that touches.

use stickslip_mechanics::friction::{FrictionMemory, coefficient};

/// Coulomb's friction: the coefficient at rest, in motion, and the slip speed over which the one becomes the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// At rest [-].
    pub at_rest: f64,
    /// In motion [-].
    pub kinetic: f64,
    /// Speed of slip over which the coefficient falls from one to the other; zero: at once [m/s].
    pub decay_speed: f64,
    /// How strength follows pressure; none: at once. A point that sticks has the strength of its pressure.
    pub memory: Option<FrictionMemory>,
}

impl Friction {
    /// The coefficient of a point that slips at this speed [m/s].
    pub fn coefficient(&self, speed: f64) -> f64 {
        coefficient([self.at_rest, self.kinetic], self.decay_speed, speed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_coefficient_falls_once_a_point_slips() {
        let friction = Friction { at_rest: 0.5, kinetic: 0.3, decay_speed: 0.1, memory: None };
        assert_eq!(friction.coefficient(0.0), 0.5);
        assert!((friction.coefficient(0.1) - (0.3 + 0.2 * (-1.0_f64).exp())).abs() < 1e-15);
        assert_eq!(Friction { decay_speed: 0.0, ..friction }.coefficient(1e-9), 0.3);
    }
}
