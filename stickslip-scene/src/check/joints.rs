//! Free rigid bodies and joints: what they need.

use super::bodies::FillingExtent;
use super::neighbours::pairs_within;
use super::table::short;
use super::warning::Warning;
use crate::geometry::{Bounds, Curved, Shape};
use crate::rigid::MassProperties;
use crate::scene::{ContactLaw, ContactRule, Face, Joint, JointKind, Problem, RuleNames, Scene};
use crate::tensor::Vector;

/// A joint holds a body at points this far from it at most, over the size of the larger of its bodies: a bob on a thread
/// is far from its hinge, and a slip of a unit is farther.
const FARTHEST: f64 = 100.0;

/// # Errors
/// A free rigid body without bounds or through a mirror, a joint far from its bodies, glue between rigid bodies, or
/// a bond of those that touch at a point.
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
    glued(scene, extents)?;
    bonded(scene)
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

/// Whether a shape has flat faces, by which it touches over an area.
fn has_faces(shape: &Shape) -> bool {
    match shape {
        Shape::Ball { .. } => false,
        Shape::Curved(Curved::RoundedBox(_) | Curved::Image(_) | Curved::PointCloud(_)) => true,
        Shape::Curved(_) => false,
        Shape::Rotated { shape, .. } => has_faces(shape),
        Shape::Union(shapes) | Shape::Intersection(shapes) | Shape::Difference(shapes) => {
            shapes.iter().any(has_faces)
        }
        Shape::Box { .. }
        | Shape::Cylinder { .. }
        | Shape::HalfSpace { .. }
        | Shape::Polygon { .. }
        | Shape::Mesh(_)
        | Shape::Revolved(_) => true,
    }
}

/// What a rule has that acts by area: the first such key, and its value.
fn by_area(rule: &ContactRule) -> Option<(&'static str, String)> {
    let given = [
        ("cohesion", rule.cohesion, "Pa"),
        ("adhesion", rule.adhesion, "Pa"),
        ("viscosity", rule.viscosity, "Pa s/m"),
    ];
    let (key, value, unit) = given.into_iter().find(|(_, value, _)| *value > 0.0)?;
    Some((key, format!("{} {unit}", short(value))))
}

/// Bodies of each kind and class that are looked at: more of them differ in nothing that counts here.
const OF_A_KIND: usize = 2;

/// # Errors
/// Cohesion, adhesion or viscosity between rigid bodies of which one is free and one has no faces: they touch at a
/// point, and a point has no area.
fn bonded(scene: &Scene) -> Result<(), Problem> {
    let acts = |rule: &ContactRule| rule.law != ContactLaw::None && by_area(rule).is_some();
    if !scene.contact.iter().any(acts) || scene.bodies.iter().all(|body| body.as_free_rigid().is_none()) {
        return Ok(());
    }
    let (names, joined) = (RuleNames::new(scene), scene.joined_pairs());
    // Of each class, and of each kind by whether it is free and has faces.
    let mut some = vec![[const { Vec::new() }; 4]; names.classes()];
    for (i, body) in scene.bodies.iter().enumerate().filter(|(_, body)| body.is_rigid()) {
        let kind = usize::from(body.as_free_rigid().is_some()) + 2 * usize::from(has_faces(&body.shape));
        let list: &mut Vec<usize> = &mut some[names.class(i)][kind];
        if list.len() < OF_A_KIND {
            list.push(i);
        }
    }
    for p in 0..names.classes() {
        for q in p..names.classes() {
            let Some(rule) = names.rule(p, q).filter(|&rule| acts(&scene.contact[rule])) else { continue };
            let pairs =
                some[p].iter().flatten().flat_map(|&a| some[q].iter().flatten().map(move |&b| [a, b]));
            let points = |pair: &[usize; 2]| pair.iter().any(|&body| !has_faces(&scene.bodies[body].shape));
            let touch = |[a, b]: [usize; 2]| a != b && scene.may_touch([a, b], &joined);
            let Some([a, b]) = pairs.filter(points).find(|&pair| touch(pair)) else { continue };
            let (key, value) = by_area(&scene.contact[rule]).expect("the rule acts by area");
            let [a, b] = [a, b].map(|body| &scene.bodies[body].name);
            return Err(Problem {
                key: format!("contact[{rule}].{key}"),
                found: format!("{value} between the rigid bodies `{a}` and `{b}`, which touch at points"),
                allowed: "friction alone where a rigid body has no flat faces: points have no area".to_string(),
                help: Some(
                    "another rule before this one for such pairs, or a shape with faces, as a polygon or a box"
                        .to_string(),
                ),
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::bodies::measure;

    /// A body of this shape on a floor, with a rule; what is wrong with it.
    fn problem(body: &str, rule: &str) -> Option<Problem> {
        let text = format!(
            "space = {{ dimension = 'plane-strain', cell = 0.1 }}\ntime.end = 1\n\
             materials.clay = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0 }} }}\n\
             contact = [{{ {rule} }}]\n\
             bodies = [{{ name = 'floor', material = 'clay', rigid = {{}}, shape.half_space = {{ point = [0, 0], normal = [0, 1] }} }},\n\
             {{ name = 'it', material = 'clay', {body} }}]\n"
        );
        let scene = crate::scene::parse("bonds.toml", &text, &[]).expect("a scene").scene;
        check(&scene, &measure(&scene).expect("filled")).err()
    }

    #[test]
    fn what_acts_by_area_is_refused_of_rigid_bodies_that_touch_at_points() {
        let disk = "shape.ball = { center = [0, 1], radius = 1 }";
        let block = "shape.box = { min = [0, 0], max = [1, 1] }";
        let free = |shape: &str| format!("{shape}, rigid = {{ free = {{}} }}");
        for (key, value) in [("cohesion", "10 Pa"), ("adhesion", "10 Pa"), ("viscosity", "10 Pa s/m")] {
            let rule = format!("friction = 0.5, {key} = '{value}'");
            let found = problem(&free(disk), &rule).expect("a disk has no face");
            assert_eq!(found.key, format!("contact[0].{key}"));
            assert!(found.found.starts_with(&format!("{value} between the rigid bodies")), "{}", found.found);
            // A block has faces, and what deforms has an area wherever it touches.
            assert!(problem(&free(block), &rule).is_none() && problem(disk, &rule).is_none());
        }
        assert!(problem(&free(disk), "friction = 0.5").is_none());
    }
}
