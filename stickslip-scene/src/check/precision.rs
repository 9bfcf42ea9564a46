//! Bodies that would stand still in single precision: rounding takes all of each step.

use super::bodies::FillingExtent;
use super::contact::starting_velocity;
use super::report::time_step;
use super::table::short;
use crate::scene::{Precision, Problem, Scene};

/// # Errors
/// A body that deforms begins with a velocity whose way in a step is less than half of the spacing of numbers wherever
/// its particles are.
pub(super) fn check(scene: &Scene, extents: &[FillingExtent]) -> Result<(), Problem> {
    if scene.precision == Precision::Double || scene.start.is_some() {
        return Ok(());
    }
    let step = time_step(scene, extents);
    for (body, extent) in scene.bodies.iter().zip(extents).filter(|(body, _)| !body.is_rigid()) {
        let velocity = starting_velocity(body);
        let fastest = (0..3).max_by(|&a, &b| velocity[a].abs().total_cmp(&velocity[b].abs())).unwrap_or(0);
        let [low, high] = [extent.centers.min[fastest], extent.centers.max[fastest]];
        let nearest = if low * high <= 0.0 { 0.0 } else { low.abs().min(high.abs()) };
        let (way, spacing) = (velocity[fastest].abs() * step, spacing(nearest));
        if way > 0.0 && way < 0.5 * spacing {
            return Err(Problem {
                key: "space.precision".to_string(),
                found: format!(
                    "\"single\" with `{}` {} m from the origin: it moves by {} m a step, where numbers are {} m apart, and \
                     would stand still",
                    body.name,
                    short(nearest),
                    short(way),
                    short(spacing)
                ),
                allowed: "\"double\", or bodies nearer to the origin".to_string(),
                help: None,
            });
        }
    }
    Ok(())
}

/// From a number to the next in single precision.
fn spacing(x: f64) -> f64 {
    let x = x as f32;
    f64::from(f32::from_bits(x.to_bits() + 1)) - f64::from(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::problems;
    use crate::check::tests::{free, scene};
    use crate::geometry::Shape;
    use crate::scene::{BodyMotion, Dimension};

    #[test]
    fn a_body_that_would_stand_still_is_refused() {
        let at = |x: f64, precision, speed: f64| {
            let block = Shape::cuboid([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0]);
            let mut scene = scene(Dimension::PlaneStrain, 0.25, vec![free("block", 1, block)]);
            scene.precision = precision;
            scene.time.max_step = Some(1e-3);
            let BodyMotion::Free { velocity, .. } = &mut scene.bodies[0].motion else { unreachable!() };
            *velocity = [speed, 0.0, 0.0];
            problems(&scene).map_err(|problem| (problem.key, problem.found))
        };
        // Numbers are 1/1024 m apart there.
        let (key, found) = at(1e4, Precision::Single, 0.4).unwrap_err();
        assert_eq!(key, "space.precision");
        assert!(found.contains("`block` 10000") && found.contains("would stand still"), "{found}");
        assert_eq!(at(1e4, Precision::Double, 0.4), Ok(()));
        assert_eq!(at(1e4, Precision::Single, 0.6), Ok(()), "it moves, and the run watches how well");
        assert_eq!(at(1e4, Precision::Single, 0.0), Ok(()));
        assert_eq!(at(1.0, Precision::Single, 0.4), Ok(()));
    }
}
