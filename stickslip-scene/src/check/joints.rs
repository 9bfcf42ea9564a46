//! Free rigid bodies and joints: what they need.

use super::bodies::FillingExtent;
use super::neighbours::pairs_within;
use super::table::short;
use super::warning::Warning;
use crate::geometry::Bounds;
use crate::rigid::MassProperties;
use crate::scene::{ContactLaw, Face, Joint, JointKind, Problem, Scene};
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
            (0..scene.dimension.axes()).filter(|&k| !scene.slides_along(i, k)).any(|k| {
                domain.faces[k][0] == Face::Symmetry && bounds.min[k] < domain.min[k] + near
                    || domain.faces[k][1] == Face::Symmetry && bounds.max[k] > domain.max[k] - near
            })
        });
        if through {
            let found = format!("`{}`, through which a symmetry face of the domain goes", body.name);
            let allowed = "a body beside the mirror, or one that a slider to the ground, whose axis lies along the \
                           mirror, a planar joint, whose normal lies across it, or a weld holds on it";
            return Err(problem(found, allowed));
        }
    }
    if let (Some(_), Some(body)) =
        (scene.time.relax, scene.bodies.iter().find(|body| body.as_free_rigid().is_some()))
    {
        return Err(Problem {
            key: "time.relax".to_string(),
            found: format!("dynamic relaxation with the free rigid body `{}`", body.name),
            allowed: "rigid bodies with prescribed motion: free ones do not come to rest so".to_string(),
            help: Some(
                "a dashpot on a joint, and [damping] for what deforms, bring them to rest in a run"
                    .to_string(),
            ),
        });
    }
    for (i, joint) in scene.joints.iter().enumerate() {
        let bodies = [Some(joint.body), joint.to];
        let (key, points) = match &joint.kind {
            JointKind::Hinge { point, .. } | JointKind::Ball { point } => ("point", [*point; 2]),
            JointKind::Spring { points, .. } => ("from", *points),
            JointKind::Slider { .. } | JointKind::Planar { .. } | JointKind::Weld => {
                apart(i, joint, extents)?;
                continue;
            }
        };
        let held =
            bodies.iter().zip(points).filter_map(|(body, point)| Some((&extents[(*body)?].bounds, point)));
        let held: Vec<_> = held.filter(|(bounds, _)| bounds.is_finite()).collect();
        let size = held.iter().map(|(bounds, _)| Vector(bounds.size()).norm()).fold(0.0, f64::max);
        let away = |(bounds, point): &(&Bounds, [f64; 3])| {
            let beyond = |k: usize| (bounds.min[k] - point[k]).max(point[k] - bounds.max[k]).max(0.0);
            Vector(std::array::from_fn::<f64, 3, _>(beyond)).norm()
        };
        let farthest = held.iter().map(away).fold(0.0, f64::max);
        if farthest > FARTHEST * size {
            return Err(Problem {
                key: format!("joints[{i}].{}.{key}", joint.kind.name()),
                found: format!("a point {} m away from a body that it holds", short(farthest)),
                allowed: format!("a point no farther than {FARTHEST} times their size, {} m", short(size)),
                help: Some("lengths without a unit are metres".to_string()),
            });
        }
    }
    glued(scene, extents)
}

/// # Errors
/// A slider, a planar joint or a weld between bodies far from each other.
fn apart(i: usize, joint: &Joint, extents: &[FillingExtent]) -> Result<(), Problem> {
    let Some(to) = joint.to else { return Ok(()) };
    let [a, b] = [joint.body, to].map(|body| &extents[body].bounds);
    if !(a.is_finite() && b.is_finite()) {
        return Ok(());
    }
    let gap = |k: usize| (a.min[k] - b.max[k]).max(b.min[k] - a.max[k]).max(0.0);
    let gap = Vector(std::array::from_fn::<f64, 3, _>(gap)).norm();
    let size = [a, b].map(|bounds| Vector(bounds.size()).norm()).into_iter().fold(0.0, f64::max);
    if gap <= FARTHEST * size {
        return Ok(());
    }
    Err(Problem {
        key: format!("joints[{i}].to"),
        found: format!("a body {} m away from the other one", short(gap)),
        allowed: format!("a body no farther than {FARTHEST} times their size, {} m", short(size)),
        help: Some("lengths without a unit are metres".to_string()),
    })
}

/// Free rigid bodies go through the faces of the domain.
pub(super) fn warning(scene: &Scene) -> Option<Warning> {
    let body = scene.bodies.iter().find(|body| body.as_free_rigid().is_some())?;
    let domain = scene.domain.as_ref()?;
    let axes = 0..scene.dimension.axes();
    let holds = axes.flat_map(|k| domain.faces[k]).any(|face| matches!(face, Face::Symmetry | Face::Fixed));
    holds.then(|| {
        Warning::about(
            "space.domain".to_string(),
            format!(
                "its faces hold what deforms, and not free rigid bodies such as `{}`, which leave the domain there and end \
                 the run; a rigid half-space with rigid = {{}} holds them",
                body.name
            ),
        )
    })
}

/// # Errors
/// Glue between rigid bodies.
fn glued(scene: &Scene, extents: &[FillingExtent]) -> Result<(), Problem> {
    if scene.bodies.iter().all(|body| body.as_free_rigid().is_none()) {
        return Ok(());
    }
    let joined = scene.joined_pairs();
    let boxes: Vec<_> = extents.iter().map(|extent| extent.bounds).collect();
    for [a, b] in pairs_within(&boxes, scene.discretization.cell) {
        let rigid = [a, b].iter().all(|&body| scene.bodies[body].is_rigid());
        let Some(rule) = scene.contact_rule_between(a, b) else { continue };
        if rigid && scene.may_touch([a, b], &joined) && scene.contact[rule].law == ContactLaw::Glued {
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
