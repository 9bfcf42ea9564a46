//! Springs between parts of bodies, on something that is there.

use crate::part::PartPoints;
use crate::scene::{Problem, Scene};
use crate::tensor::Vector;

/// Over the cell: nearer ends have no line between them.
const NEAR: f64 = 1e-6;

/// # Errors
/// A spring at a body that is not there, or at a part where its body has nothing; between parts whose motion is
/// prescribed; between parts whose centres are one point.
pub(super) fn check(scene: &Scene) -> Result<(), Problem> {
    for (i, spring) in scene.springs.iter().enumerate() {
        let problem = |part: &str, found: String, allowed: &str| Problem {
            key: format!("springs[{i}]{part}"),
            found,
            allowed: allowed.to_string(),
            help: None,
        };
        let mut centers = [[0.0; 3]; 2];
        for ((end, key), center) in spring.ends.iter().zip(["from", "to"]).zip(&mut centers) {
            let Some(body) = scene.bodies.get(end.body) else {
                return Err(problem(&format!(".{key}.body"), "no body".to_string(), "a body of the scene"));
            };
            let part = if end.part.within.is_some() { "within" } else { "on" };
            let points = PartPoints::new(scene, end.body, &end.part);
            if points.points.is_empty() {
                let found = format!("no part of body `{}`", body.name);
                return Err(problem(&format!(".{key}.{part}"), found, "a part that the body has"));
            }
            *center = points.center;
        }
        let bodies = [0, 1].map(|side| &scene.bodies[spring.ends[side].body]);
        if bodies.iter().all(|body| body.is_prescribed()) {
            let found = format!("a spring between `{}` and `{}`", bodies[0].name, bodies[1].name);
            return Err(problem(
                "",
                found,
                "one between bodies of which one can move: not both are as prescribed",
            ));
        }
        let apart = (Vector(centers[0]) - Vector(centers[1])).norm();
        if apart < NEAR * scene.discretization.cell {
            let found = format!("a part whose centre is at {:?} m, as that of the other", centers[1]);
            return Err(problem(
                ".to",
                found,
                "another place: a spring acts along the line between the centres",
            ));
        }
    }
    Ok(())
}
