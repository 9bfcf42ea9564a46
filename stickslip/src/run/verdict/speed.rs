//! Motion that nears the speed of waves.

use super::{Check, CheckInputs, Finding, exceeds, minus, norm, place, share};
use crate::scene::{HealthCheck, Scene};

/// Holds the fastest particle of each body that deforms, relative to the body on the whole, against the body's waves;
/// and the fastest point of each free rigid body, in the scene's frame, against those of its material, beyond which it
/// would be far from rigid. Every particle is looked at.
pub(super) struct SpeedCheck;

impl Check for SpeedCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::Speed
    }

    fn advice(&self, _: &Scene) -> &'static str {
        "what moves so would strain by about as much at once: try slower motion, a stiffer material, a smaller time.courant"
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        let bound = look.bound(self.kind());
        let of_body = |body: usize| {
            let rigid = look.scene.bodies[body].is_rigid();
            let against = if rigid { [0.0; 3] } else { look.bodies[body].velocity };
            let fastest = look.simulation.fastest(body, against)?;
            let share = share(norm(minus(fastest.velocity, against)), look.wave_speed(body));
            if !exceeds(share, bound) {
                return None;
            }
            let (name, place) = (&look.scene.bodies[body].name, place(fastest.position));
            let message = if rigid {
                format!(
                    "the rigid body `{name}` moves by {share:.2} of the wave speed of its material at {place}, where \
                     {bound} is allowed"
                )
            } else {
                format!(
                    "a part of `{name}` moves against the rest by {share:.2} of its wave speed at {place}, where \
                     {bound} is allowed"
                )
            };
            Some(Finding { body: Some(body), position: Some(fastest.position), worst: share, message })
        };
        let moved = (0..look.bodies.len()).filter(|&body| !look.scene.bodies[body].is_prescribed());
        moved.filter_map(of_body).collect()
    }
}
