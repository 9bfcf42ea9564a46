//! What a point that touches bears across its normal, and the pull that it bears.

use stickslip_mechanics::friction::{FrictionMemory, coefficient};

/// Coulomb's friction, with the coefficient at rest, in motion, and the slip speed over which the one becomes the
/// other; and what surfaces bear by their area.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Friction {
    /// At rest [-].
    pub at_rest: f64,
    /// In motion [-].
    pub kinetic: f64,
    /// Speed of slip over which the coefficient falls from one to the other; zero: at once [m/s].
    pub decay_speed: f64,
    /// How strength follows pressure; none: at once. A point that sticks has the strength of its pressure.
    pub memory: Option<FrictionMemory>,
    /// Shear traction that a point bears without pressure [Pa].
    pub cohesion: f64,
    /// Tensile traction that a bond bears before it gives way [Pa].
    pub adhesion: f64,
    /// Shear traction over speed of slip [Pa s/m].
    pub viscosity: f64,
}

impl Friction {
    /// That of a point which nothing parts and nothing moves along.
    pub const GLUE: Self = Friction {
        at_rest: f64::INFINITY,
        kinetic: f64::INFINITY,
        decay_speed: 0.0,
        memory: None,
        cohesion: 0.0,
        adhesion: f64::INFINITY,
        viscosity: 0.0,
    };

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
        let friction = Friction { at_rest: 0.5, kinetic: 0.3, decay_speed: 0.1, ..Friction::default() };
        assert_eq!(friction.coefficient(0.0), 0.5);
        assert!((friction.coefficient(0.1) - (0.3 + 0.2 * (-1.0_f64).exp())).abs() < 1e-15);
        assert_eq!(Friction { decay_speed: 0.0, ..friction }.coefficient(1e-9), 0.3);
    }
}
