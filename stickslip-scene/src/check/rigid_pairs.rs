//! Rigid bodies that run into each other: contact does not act between them, so they pass.

use super::bodies::FillingExtent;
use super::neighbours::pairs_within;
use super::penetration::{SharedRoom, deepest};
use super::warning::{Warning, and_more};
use crate::geometry::{Bounds, SignedDistance};
use crate::rigid::{Pose, RigidMotion};
use crate::scene::{BodyMotion, ContactLaw, Expression, Scene};
use rayon::prelude::*;

/// Times at which the bodies' places are looked at, from the start to the end.
const LOOKS: usize = 1024;
/// Of these, so many at most compare the shapes of two bodies, where their boxes meet.
const CLOSE_LOOKS: usize = 64;
/// Bodies that overlap by less than this touch: a path in so many steps is no better [cells].
const TOUCH: f64 = 1e-3;

/// A rigid body's places at equal intervals, and the box that holds it at each.
struct RigidPath {
    body: usize,
    poses: Vec<Pose>,
    boxes: Vec<Bounds>,
}

impl RigidPath {
    fn of(scene: &Scene, extent: &FillingExtent, body: usize) -> Option<RigidPath> {
        let mut motion = RigidMotion::prescribed(&scene.bodies[body].motion, extent.center)?;
        let step = scene.time.end / LOOKS as f64;
        let mut poses = vec![motion.pose()];
        for i in 0..LOOKS {
            // What fails here fails in the run, which says so.
            motion.set_step(i as f64 * step, step).ok()?;
            motion.advance(&motion.rotation(step), step);
            poses.push(motion.pose());
        }
        let bounds = extent.bounds;
        let place = |pose: &Pose| match bounds.is_finite() {
            true => Bounds::around(bounds.corners().map(|corner| pose.now(corner))),
            false => bounds,
        };
        let boxes = poses.iter().map(place).collect();
        Some(RigidPath { body, poses, boxes })
    }

    fn swept(&self) -> Bounds {
        self.boxes.iter().fold(Bounds::EMPTY, |all, bounds| all.united(bounds))
    }
}

/// Where and when two paths meet first.
struct PathMeeting {
    pair: [usize; 2],
    time: f64,
    shared: SharedRoom,
}

/// Rigid bodies whose shapes overlap at one of 1024 times; those of a rule with the law `none` are meant to, and those
/// without bounds are not compared with each other.
pub(super) fn warning(scene: &Scene, extents: &[FillingExtent]) -> Option<Warning> {
    let paths = (0..scene.bodies.len()).filter_map(|body| RigidPath::of(scene, &extents[body], body));
    let paths: Vec<_> = paths.collect();
    let swept: Vec<_> = paths.iter().map(RigidPath::swept).collect();
    let pairs = pairs_within(&swept, 0.0);
    let met: Vec<_> = pairs.par_iter().filter_map(|&[a, b]| meet(scene, [&paths[a], &paths[b]])).collect();
    let first = met.iter().min_by(|a, b| a.time.total_cmp(&b.time))?;
    let [a, b] = first.pair.map(|body| scene.bodies[body].name.as_str());
    let axes = scene.dimension.axes();
    let place: Vec<_> = first.shared.place[..axes].iter().map(|x| format!("{x:.4}")).collect();
    let when =
        if first.time == 0.0 { "at the start".into() } else { format!("from t = {:.4e} s on", first.time) };
    Some(Warning::about(
        format!("bodies[{}].rigid", first.pair[1]),
        format!(
            "{} overlap {when}, near ({}) m: they pass, for their motion is prescribed; \
             let one of them be free or deform, or change its path (looked at {LOOKS} times)",
            and_more(&format!("the rigid bodies `{a}` and `{b}`"), met.len() - 1),
            place.join(", ")
        ),
    ))
}

/// Whether two bodies never move against each other.
fn together(scene: &Scene, pair: [usize; 2]) -> bool {
    let motions = pair.map(|body| match &scene.bodies[body].motion {
        BodyMotion::Rigid { velocity, spin } => Some((velocity, spin)),
        BodyMotion::Free { .. } | BodyMotion::FreeRigid(_) => None,
    });
    let [Some((v, spin)), Some((w, turn))] = motions else { return false };
    let still = |spin: &[Expression; 3]| spin.iter().all(|s| *s == Expression::Constant(0.0));
    v == w && still(spin) && still(turn)
}

fn meet(scene: &Scene, paths: [&RigidPath; 2]) -> Option<PathMeeting> {
    let pair = paths.map(|path| path.body);
    if together(scene, pair) || scene.contact_between(pair[0], pair[1]).law == ContactLaw::None {
        return None;
    }
    let (cell, axes) = (scene.discretization.cell, scene.dimension.axes());
    let room = |look: usize| {
        let [a, b] = paths.map(|path| path.boxes[look]);
        let room = a.intersected(&b);
        let size = room.size();
        (!room.is_empty() && size[..axes].iter().all(|&side| side > TOUCH * cell)).then_some(room)
    };
    let near: Vec<_> = (0..=LOOKS).filter_map(|look| Some((look, room(look)?))).collect();
    let met = |(look, room): &(usize, Bounds)| {
        let levels = paths.map(|path| {
            let (shape, pose) = (&scene.bodies[path.body].shape, path.poses[*look]);
            move |x: [f64; 3]| {
                let level = shape.level(pose.start(x), axes);
                SignedDistance { gradient: pose.turned(level.gradient), ..level }
            }
        });
        let shared = deepest([&levels[0], &levels[1]], room, cell, axes)?;
        let time = scene.time.end * *look as f64 / LOOKS as f64;
        (shared.depth > TOUCH * cell).then_some(PathMeeting { pair, time, shared })
    };
    // Far apart first, then all between the last look without and the first with.
    let every = near.len().div_ceil(CLOSE_LOOKS).max(1);
    let late = (0..near.len()).step_by(every).find(|&i| met(&near[i]).is_some())?;
    near[late.saturating_sub(every - 1)..=late].iter().find_map(met)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::bodies::measure;
    use crate::check::tests::{at_rest, free, scene};
    use crate::geometry::Shape;
    use crate::scene::{Body, ContactRule, Dimension};

    fn block(name: &str, x: f64, velocity: [f64; 3], spin: f64) -> Body {
        let shape = Shape::Box { min: [x, 0.0, 0.0], max: [x + 1.0, 1.0, 0.0] };
        let [velocity, spin] = [velocity, [0.0, 0.0, spin]].map(|v| Box::new(v.map(Expression::Constant)));
        Body { motion: BodyMotion::Rigid { velocity, spin }, ..free(name, 1, shape) }
    }

    fn said(bodies: Vec<Body>) -> Option<String> {
        let scene = scene(Dimension::PlaneStrain, 0.1, bodies);
        warning(&scene, &measure(&scene).expect("filled")).map(|warning| warning.to_string())
    }

    /// 1 m apart at 1 m/s, to t = 2 s: from 1 s on, but for a look or two.
    #[test]
    fn rigid_bodies_that_run_into_each_other_are_told_of_with_the_time() {
        let text = said(vec![block("ram", 0.0, [1.0, 0.0, 0.0], 0.0), block("anvil", 2.0, [0.0; 3], 0.0)]);
        let text = text.expect("they meet");
        assert!(
            text.starts_with("bodies[1].rigid: the rigid bodies `ram` and `anvil` overlap from t = 1.00"),
            "{text}"
        );
        // A block of 1 m by 1 m beside another sweeps over it when it turns.
        let turning = said(vec![block("a", 0.0, [0.0; 3], 1.0), block("b", 1.1, [0.0; 3], 0.0)]);
        assert!(turning.is_some());
    }

    #[test]
    fn those_that_part_slide_stay_or_move_alike_are_not() {
        let pair = |v: [f64; 3], w: [f64; 3]| said(vec![block("a", 0.0, v, 0.0), block("b", 1.0, w, 0.0)]);
        for (v, w) in [
            ([-1.0, 0.0, 0.0], [0.0; 3]),
            ([0.0, 1.0, 0.0], [0.0; 3]),
            ([0.0; 3], [0.0; 3]),
            ([1.0, 1.0, 0.0], [1.0, 1.0, 0.0]),
        ] {
            assert_eq!(pair(v, w), None, "{v:?} {w:?}");
        }
        let deforming = free("b", 0, Shape::Box { min: [1.0, 0.0, 0.0], max: [2.0, 1.0, 0.0] });
        assert_eq!(said(vec![block("a", 0.0, [1.0, 0.0, 0.0], 0.0), deforming]), None);
    }

    #[test]
    fn a_half_space_in_the_way_counts_and_the_law_none_means_it() {
        let floor = at_rest("floor", Shape::HalfSpace { point: [0.0, -0.5, 0.0], normal: [0.0, 1.0, 0.0] });
        let wall = at_rest("wall", Shape::HalfSpace { point: [-9.0, 0.0, 0.0], normal: [1.0, 0.0, 0.0] });
        let falling = block("ram", 0.0, [0.0, -1.0, 0.0], 0.0);
        let mut scene = scene(Dimension::PlaneStrain, 0.1, vec![falling, floor, wall]);
        let said = |scene: &Scene| warning(scene, &measure(scene).expect("filled"));
        assert!(
            said(&scene).expect("it falls through").text.contains("`ram` and `floor` overlap from t = 5.0")
        );
        let between = [Some("floor".to_string()), None];
        scene.contact = vec![ContactRule { between, law: ContactLaw::None, ..Default::default() }];
        assert_eq!(said(&scene), None);
    }
}
