//! What changes faster than steps can follow.

use super::table::short;
use super::warning::Warning;
use crate::scene::{Changes, LEAST_PART, Scene};

/// Loads, supports, gravity and prescribed motions that go and come back within the shortest steps to which runs cut
/// those of this length [s] for them.
pub(super) fn warning(scene: &Scene, step: f64) -> Option<Warning> {
    let changes = Changes::of(scene);
    let mut passed = changes.passed_over(step, scene.time.end);
    let first = passed.next()?;
    let shortest = LEAST_PART * step;
    let others = match passed.count() {
        0 => String::new(),
        others => format!(" (so do {others} more)"),
    };
    let what = match first.change.is_rate {
        true => "steps take its mean: what it adds up to is right, its peak is not seen",
        false => "steps take what it is at their ends, and may pass over it",
    };
    Some(Warning::about(
        first.change.key.clone(),
        format!(
            "goes and comes back within {} s at t = {} s{others}, and steps are {} s long, {} s where they are cut for \
             it; {what}; time.max_step = {} s, or smaller cells, would see it",
            short(shortest),
            short(first.time),
            short(step),
            short(shortest),
            short(shortest)
        ),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Dimension, Expression, Gravity, TimeTable};

    #[test]
    fn a_pulse_between_steps_is_told() {
        let mut scene = Scene::new(Dimension::Space, 1.0, 1.0);
        let mut gravity = |width: f64| {
            let rows = vec![[0.0, 0.0], [0.5, 0.0], [0.5 + 0.5 * width, 1.0], [0.5 + width, 0.0]];
            let table = Expression::Table(TimeTable::new(rows).expect("times ascend"));
            scene.gravity = Gravity([table, Expression::Constant(0.0), Expression::Constant(0.0)]);
            warning(&scene, 1e-3)
        };
        assert_eq!(gravity(4e-3), None);
        let warning = gravity(4e-6).expect("a pulse of 4 us in steps of 1 ms");
        assert_eq!(warning.key, "gravity");
        assert!(warning.text.starts_with("goes and comes back within"), "{}", warning.text);
        assert!(warning.text.contains("what it adds up to is right"), "{}", warning.text);
    }
}
