//! Free rigid bodies and joints: what they need.

use super::bodies::FillingExtent;
use super::neighbours::pairs_within;
use super::table::short;
use crate::rigid::MassProperties;
use crate::scene::{ContactLaw, Face, JointKind, Problem, Scene};
use crate::tensor::Vector;

/// A joint holds a body at points this far from it at most, over the size of the larger of its bodies: a bob on a thread
/// is far from its hinge, and a slip of a unit is farther.
const FARTHEST: f64 = 100.0;

/// # Errors
/// A free rigid body without bounds or through a mirror, a joint far from its bodies, or glue between rigid bodies.
pub(super) fn check(scene: &Scene, extents: &[FillingExtent]) -> Result<(), Problem> {
    for (i, body) in scene.bodies.iter().enumerate() {
        let Some(free) = body.as_free_rigid() else { continue };
        let problem = |found: String, allowed: &str| Problem {
            key: format!("bodies[{i}].rigid.free"),
            found,
            allowed: allowed.to_string(),
            help: None,
        };
        if MassProperties::of(scene, body, free).is_none() {
            let found = format!("`{}`, which has no finite mass or inertia", body.name);
            return Err(problem(found, "a body of finite size that has a volume"));
        }
        let bounds = &extents[i].bounds;
        let through = scene.domain.iter().any(|domain| {
            let near = 1e-6 * scene.discretization.cell;
            (0..scene.dimension.axes()).any(|k| {
                domain.faces[k][0] == Face::Symmetry && bounds.min[k] < domain.min[k] + near
                    || domain.faces[k][1] == Face::Symmetry && bounds.max[k] > domain.max[k] - near
            })
        });
        if through {
            let found = format!("`{}`, through which a symmetry face of the domain goes", body.name);
            return Err(problem(found, "a body beside the mirror, or a domain without it"));
        }
    }
    for (i, joint) in scene.joints.iter().enumerate() {
        let point = match &joint.kind {
            JointKind::Hinge { point, .. } | JointKind::Ball { point } => *point,
            JointKind::Slider { .. } | JointKind::Weld | JointKind::Spring { .. } => continue,
        };
        let held = [Some(joint.body), joint.to].into_iter().flatten().map(|body| &extents[body].bounds);
        let held: Vec<_> = held.filter(|bounds| bounds.is_finite()).collect();
        let size = held.iter().map(|bounds| Vector(bounds.size()).norm()).fold(0.0, f64::max);
        let away = |bounds: &&crate::geometry::Bounds| {
            let beyond = |k: usize| (bounds.min[k] - point[k]).max(point[k] - bounds.max[k]).max(0.0);
            Vector(std::array::from_fn::<f64, 3, _>(beyond)).norm()
        };
        let farthest = held.iter().map(away).fold(0.0, f64::max);
        if farthest > FARTHEST * size {
            return Err(Problem {
                key: format!("joints[{i}].{}.point", joint.kind.name()),
                found: format!("a point {} m away from a body that it holds", short(farthest)),
                allowed: format!("a point no farther than {FARTHEST} times their size, {} m", short(size)),
                help: Some("lengths without a unit are metres".to_string()),
            });
        }
    }
    glued(scene, extents)
}

/// # Errors
/// Glue between rigid bodies.
fn glued(scene: &Scene, extents: &[FillingExtent]) -> Result<(), Problem> {
    if scene.bodies.iter().all(|body| body.as_free_rigid().is_none()) {
        return Ok(());
    }
    let boxes: Vec<_> = extents.iter().map(|extent| extent.bounds).collect();
    for [a, b] in pairs_within(&boxes, scene.discretization.cell) {
        let rigid = [a, b].iter().all(|&body| scene.bodies[body].is_rigid());
        let Some(rule) = scene.contact_rule_between(a, b) else { continue };
        if rigid && scene.may_touch([a, b]) && scene.contact[rule].law == ContactLaw::Glued {
            let [a, b] = [a, b].map(|body| &scene.bodies[body].name);
            return Err(Problem {
                key: format!("contact[{rule}].law"),
                found: format!("\"glued\" between the rigid bodies `{a}` and `{b}`"),
                allowed: "another law, and a weld where one of them is free".to_string(),
                help: Some(format!("[[joints]] with body = {b:?}, to = {a:?}, weld = {{}}")),
            });
        }
    }
    Ok(())
}
