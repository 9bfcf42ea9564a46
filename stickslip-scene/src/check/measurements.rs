//! Probes that would ride with no material, and reactions of faces that do nothing.

use crate::scene::{Anchor, FACES, Face, Problem, Scene};

/// Each point of the material must start in its body, or within a cell of it; faces with reactions must do something.
pub(super) fn check(scene: &Scene) -> Result<(), Problem> {
    for [axis, side] in scene.outputs.measurements.faces() {
        let face = scene.domain.as_ref().map_or(Face::Open, |domain| domain.faces[axis][side]);
        if matches!(face, Face::Open | Face::Periodic) {
            let what = if face == Face::Open { "open" } else { "periodic" };
            return Err(Problem {
                key: "outputs.reactions".to_string(),
                found: format!("`{}`, a face of the domain that is {what}", FACES[axis][side]),
                allowed: "faces that are \"symmetry\" or \"fixed\"".to_string(),
                help: None,
            });
        }
    }
    for (i, probe) in scene.outputs.measurements.probes.iter().enumerate() {
        if probe.fixed_in == Anchor::Space {
            continue;
        }
        let holds = |body: &&crate::scene::Body| {
            !body.is_rigid() && probe.body.as_ref().is_none_or(|name| *name == body.name)
        };
        let distances = scene
            .bodies
            .iter()
            .filter(holds)
            .map(|body| body.shape.distance(probe.at, scene.dimension.axes()));
        let distance = distances.fold(f64::INFINITY, f64::min);
        if distance > scene.discretization.cell {
            let body = probe.body.as_ref().map_or("any body".to_string(), |name| format!("`{name}`"));
            return Err(Problem {
                key: format!("outputs.probes[{i}].at"),
                found: format!(
                    "{:?} m, {distance:.3e} m outside {body}",
                    &probe.at[..scene.dimension.axes()]
                ),
                allowed: "a point in the body, as the probe moves with its material".into(),
                help: Some("a probe with fixed_in = \"space\" may wait where no material is".into()),
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::tests::{free, scene};
    use crate::geometry::Shape;
    use crate::scene::{Dimension, Probe};

    #[test]
    fn a_probe_of_the_material_starts_in_it() {
        let ball = free("ball", 0, Shape::Ball { center: [0.0; 3], radius: 1.0 });
        let mut scene = scene(Dimension::PlaneStrain, 0.1, vec![ball]);
        let probe = |x: f64, fixed_in| Probe { name: "p".into(), at: [x, 0.0, 0.0], body: None, fixed_in };
        scene.outputs.measurements.probes = vec![probe(1.0, Anchor::Material), probe(3.0, Anchor::Space)];
        assert_eq!(check(&scene), Ok(()));
        scene.outputs.measurements.probes.push(probe(1.2, Anchor::Material));
        let problem = check(&scene).unwrap_err();
        assert_eq!(problem.key, "outputs.probes[2].at");
        assert!(problem.found.contains("outside any body"), "{problem}");
    }
}
