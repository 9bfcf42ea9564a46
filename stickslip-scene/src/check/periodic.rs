//! Bodies in a periodic domain: which of them it can hold, and where their images are.

use super::bodies::FillingExtent;
use super::table::short;
use crate::geometry::{Bounds, Shape};
use crate::scene::{BodyMotion, Expression, JointKind, Problem, Scene};
use std::borrow::Cow;

/// A body leaves as much room as this between itself and its next image: nearer, they have nodes in common [cells].
const ROOM: f64 = 3.0;

/// Directions are along a face within this.
const ALONG: f64 = 1e-12;

/// Refuses bodies that a periodic domain cannot hold.
pub(super) fn check(scene: &Scene, extents: &[FillingExtent]) -> Result<(), Problem> {
    let (axes, periods) = (scene.dimension.axes(), scene.periods());
    let periodic: Vec<usize> = (0..axes).filter(|&k| periods[k] > 0.0).collect();
    for (body, extent) in extents.iter().enumerate() {
        for &k in &periodic {
            if extent.bounds.is_finite() { bounded(scene, body, k)? } else { unbounded(scene, body, k)? }
        }
    }
    Ok(())
}

fn bounded(scene: &Scene, body: usize, k: usize) -> Result<(), Problem> {
    let (axis, axes, cell) = (["x", "y", "z"][k], scene.dimension.axes(), scene.discretization.cell);
    let (Some(bounds), Some(domain)) = (scene.bodies[body].shape.bounds(axes), &scene.domain) else {
        return Ok(());
    };
    let (name, period) = (&scene.bodies[body].name, scene.periods()[k]);
    let (length, middle) = (bounds.size()[k], bounds.middle()[k]);
    let problem = |found: String, allowed: String| Problem {
        key: format!("bodies[{body}].shape"),
        found,
        allowed,
        help: None,
    };
    if scene.joined_ends(body)[k].is_some() {
        return joined(scene, body, k);
    }
    if length > period - ROOM * cell {
        return Err(problem(
            format!(
                "`{name}` is {} m long along {axis}, with a period of {} m",
                short(length),
                short(period)
            ),
            format!(
                "at most {} m, which leaves {ROOM} cells between it and its next image; or {} m, which joins it to \
                 that",
                short(period - ROOM * cell),
                short(period)
            ),
        ));
    }
    if !(domain.min[k]..=domain.max[k]).contains(&middle) {
        return Err(problem(
            format!("the middle of `{name}` lies at {} m along {axis}", short(middle)),
            format!("from {} to {} m, in the domain", short(domain.min[k]), short(domain.max[k])),
        ));
    }
    Ok(())
}

/// A rigid body that is joined to its own images along an axis does not turn about another one.
fn joined(scene: &Scene, body: usize, k: usize) -> Result<(), Problem> {
    let (name, axis) = (&scene.bodies[body].name, ["x", "y", "z"][k]);
    let problem = |key: &str, help: Option<String>| Problem {
        key: format!("bodies[{body}].rigid{key}"),
        found: format!("`{name}`, which is joined to its own images along {axis}, turns"),
        allowed: format!("no turning but about {axis}"),
        help,
    };
    match &scene.bodies[body].motion {
        BodyMotion::Rigid { spin, .. } if (0..3).any(|i| i != k && spin[i] != Expression::Constant(0.0)) => {
            Err(problem(".spin", None))
        }
        BodyMotion::FreeRigid(_)
            if !scene.joints.iter().any(|joint| {
                joint.body == body
                    && match &joint.kind {
                        JointKind::Slider { .. } | JointKind::Weld => true,
                        JointKind::Planar { axis, .. } => axis[k].abs() >= 1.0 - 1e-12,
                        _ => false,
                    }
            }) =>
        {
            Err(problem("", Some("hold it by a slider in [[joints]]".to_string())))
        }
        _ => Ok(()),
    }
}

fn unbounded(scene: &Scene, body: usize, k: usize) -> Result<(), Problem> {
    let (name, axis) = (&scene.bodies[body].name, ["x", "y", "z"][k]);
    if !is_endless(&scene.bodies[body].shape, k) {
        return Err(Problem {
            key: format!("bodies[{body}].shape"),
            found: format!("`{name}`, which has no bounds and does not go straight on along {axis}"),
            allowed: format!("along periodic {axis}, half-spaces whose normals have no part along {axis}"),
            help: None,
        });
    }
    match &scene.bodies[body].motion {
        BodyMotion::Rigid { spin, .. } if spin.iter().any(|spin| *spin != Expression::Constant(0.0)) => {
            Err(Problem {
                key: format!("bodies[{body}].rigid.spin"),
                found: format!("`{name}`, which has no bounds, turns in a periodic domain"),
                allowed: "no spin".to_string(),
                help: None,
            })
        }
        _ => Ok(()),
    }
}

/// Whether a shape is the same all along an axis.
fn is_endless(shape: &Shape, k: usize) -> bool {
    match shape {
        Shape::HalfSpace { normal, .. } => normal[k].abs() <= ALONG,
        Shape::Box { min, max } => min[k] == f64::NEG_INFINITY && max[k] == f64::INFINITY,
        Shape::Union(shapes) | Shape::Intersection(shapes) | Shape::Difference(shapes) => {
            shapes.iter().all(|shape| is_endless(shape, k))
        }
        Shape::Rotated { shape, axis, .. } => {
            (0..3).all(|i| i == k || axis[i] == 0.0) && is_endless(shape, k)
        }
        _ => false,
    }
}

/// A scene with the images of its bodies that come near others.
pub(super) struct Images<'a> {
    pub scene: Cow<'a, Scene>,
    /// Of which body each body is, or is an image.
    pub of: Vec<usize>,
    /// How each is moved from there [m].
    pub away: Vec<[f64; 3]>,
}

impl<'a> Images<'a> {
    /// Bodies in these boxes, and those of their images that reach into the box around all of them.
    pub fn new(scene: &'a Scene, boxes: &[Bounds]) -> Self {
        let mut images = Images {
            scene: Cow::Borrowed(scene),
            of: (0..boxes.len()).collect(),
            away: vec![[0.0; 3]; boxes.len()],
        };
        let periods = scene.periods();
        if periods == [0.0; 3] {
            return images;
        }
        let finite = || boxes.iter().enumerate().filter(|(_, bounds)| bounds.is_finite());
        let all = finite().fold(Bounds::EMPTY, |all, (_, bounds)| all.united(bounds));
        let steps = (0..27).map(|i| [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1].map(f64::from));
        let ways: Vec<[f64; 3]> = steps
            .filter(|step| (0..3).all(|k| step[k] == 0.0 || periods[k] > 0.0) && *step != [0.0; 3])
            .map(|step| std::array::from_fn(|k| step[k] * periods[k]))
            .collect();
        let mut bodies = scene.bodies.clone();
        for (body, bounds) in finite() {
            for way in &ways {
                if !moved(bounds, way).intersected(&all).is_empty() {
                    let mut image = scene.bodies[body].clone();
                    image.shape = image.shape.copied(1.0, [0.0; 3], *way);
                    bodies.push(image);
                    images.of.push(body);
                    images.away.push(*way);
                }
            }
        }
        images.scene = Cow::Owned(Scene { bodies, ..scene.clone() });
        images
    }

    /// The boxes of all.
    pub fn boxes(&self, boxes: &[Bounds]) -> Vec<Bounds> {
        self.of.iter().zip(&self.away).map(|(&body, way)| moved(&boxes[body], way)).collect()
    }

    /// Whether a pair is that of two bodies, or of the first and an image of a later one: every pair is there once.
    pub fn counts(&self, [a, b]: [usize; 2]) -> bool {
        self.of[a] == a && a < self.of[b]
    }

    /// What a message about a body says of it: nothing, unless it is an image.
    pub fn through(&self, body: usize) -> &'static str {
        if self.of[body] == body { "" } else { ", through a periodic face" }
    }
}

fn moved(bounds: &Bounds, way: &[f64; 3]) -> Bounds {
    let to = |x: [f64; 3]| std::array::from_fn(|k| x[k] + way[k]);
    Bounds { min: to(bounds.min), max: to(bounds.max) }
}
