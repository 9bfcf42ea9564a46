//! How long a step may be for free rigid bodies, in which no wave runs.

use super::MassProperties;
use super::light::longest_carried;
use crate::scene::{JointKind, Scene};
use crate::tensor::Vector;

/// A run in which a rigid body is free takes so many steps at least.
const FEWEST_STEPS: f64 = 1000.0;
/// The period over 2 pi of what swings by its weight holds so many steps at least.
const STEPS_A_SWING: f64 = 25.0;
/// A spring's period over 2 pi holds so many steps at least.
const STEPS_A_SPRING: f64 = 50.0;

/// The longest step of a scene's rigid bodies [s]; infinite where they set none.
///
/// ```text
/// dt <= end / 1000,   sqrt(r / g) / 25,   sqrt(m / k) / 50,   m / (50 d)
/// ```
/// r: the cell or the smallest radius of gyration, g: gravity; m, k, d: smallest mass at a spring or dashpot of a joint,
/// and these, for
/// hinges with the moment of inertia about the centre in place of the mass. Bodies of a mechanism move by a small part
/// of a period in such a step. What bodies on grids of their own carry has the step of that.
pub fn longest_step(scene: &Scene) -> f64 {
    let free = |body: usize| {
        let body = &scene.bodies[body];
        body.as_free_rigid().and_then(|free| MassProperties::of(scene, body, free))
    };
    if scene.bodies.iter().all(|body| body.as_free_rigid().is_none()) {
        return f64::INFINITY;
    }
    let mut longest = (scene.time.end / FEWEST_STEPS).min(longest_carried(scene));
    let gravity = Vector(scene.gravity.strongest(scene.time.end)).norm();
    if gravity > 0.0 {
        let bodies = (0..scene.bodies.len()).filter_map(free);
        let radius = |body: MassProperties| (body.inertia.trace() / body.mass).sqrt();
        let least = bodies.map(radius).fold(scene.discretization.cell, f64::min);
        longest = longest.min((least / gravity).sqrt() / STEPS_A_SWING);
    }
    for joint in &scene.joints {
        let (axis, stiffness, dashpot) = match &joint.kind {
            JointKind::Hinge { axis, motor, .. } | JointKind::Planar { axis, motor } => {
                (Some(axis), motor.stiffness, motor.dashpot)
            }
            JointKind::Slider { motor, .. } => (None, motor.stiffness, motor.dashpot),
            JointKind::Spring { stiffness, dashpot, .. } => (None, *stiffness, *dashpot),
            JointKind::Ball { .. } | JointKind::Weld => continue,
        };
        for properties in [Some(joint.body), joint.to].into_iter().flatten().filter_map(free) {
            let inertia = match axis {
                Some(axis) => Vector(properties.inertia.times(*axis)).dot(Vector(*axis)),
                None => properties.mass,
            };
            if stiffness > 0.0 {
                longest = longest.min((inertia / stiffness).sqrt() / STEPS_A_SPRING);
            }
            if dashpot > 0.0 {
                longest = longest.min(inertia / dashpot / STEPS_A_SPRING);
            }
        }
    }
    longest
}
