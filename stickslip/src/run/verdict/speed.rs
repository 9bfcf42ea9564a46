//! Motion within a body that nears the speed of its waves.

use super::{Check, CheckInputs, Finding, minus, norm, place};
use crate::scene::HealthCheck;

/// Holds the speed of particles, relative to their body on the whole, against its waves.
pub(super) struct SpeedCheck;

impl Check for SpeedCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::Speed
    }

    fn advice(&self) -> &'static str {
        "it strains by about as much at once: try slower motion, a stiffer material, a smaller time.courant"
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        let bound = look.bound(self.kind());
        let of_body = |body: usize| {
            let whole = look.bodies[body].velocity;
            let speed = |velocity| norm(minus(velocity, whole));
            let by_speed = |a: &&_, b: &&_| f64::total_cmp(&speed(velocity(a)), &speed(velocity(b)));
            let fastest = look.particles[body].iter().max_by(by_speed)?;
            let share = speed(fastest.velocity) / look.wave_speed(body);
            if share.is_nan() || share <= bound {
                return None;
            }
            let name = &look.scene.bodies[body].name;
            let message = format!(
                "a part of `{name}` moves against the rest by {share:.2} of its wave speed at {}, \
                 where {bound} is allowed",
                place(fastest.position)
            );
            Some(Finding { body: Some(body), position: Some(fastest.position), worst: share, message })
        };
        look.free().filter_map(of_body).collect()
    }
}

fn velocity(particle: &crate::door::TracedParticle) -> [f64; 3] {
    particle.velocity
}
