//! Which motions joints leave together, and what drives one that they do not.
//!
//! Each joint holds some relative velocities of its two bodies, a row of coefficients each. Rows are made orthogonal
//! one after the other (Gram and Schmidt); what is left of one that follows from the others is nothing, and its right
//! side must then be nothing, too:
//!
//! ```text
//! J v = b           v: velocities and spins of the free bodies, b: of those that move as prescribed
//! ```
//! It is looked at where the bodies begin. Bodies joined without a loop can move in all ways that each joint leaves.

use super::bodies::FillingExtent;
use super::dead_keys::first_key;
use super::warning::Warning;
use crate::scene::{BodyMotion, Joint, JointKind, Motor, Problem, Scene};
use crate::tensor::{Vector, cross};
use std::collections::BTreeMap;

/// Joints in a loop of bodies, or several of these, that are looked at: rows are compared each with all others.
const MOST: usize = 120;
/// What is left of a row of length 1 that follows from others, or of a speed.
const ROUND_OFF: f64 = 1e-9;
/// Instants of the run at which speeds of motors are asked.
const INSTANTS: usize = 16;

/// # Errors
/// A motor that turns or pushes what other joints hold fast, or faster than another does.
pub(super) fn check(scene: &Scene, extents: &[FillingExtent]) -> Result<(), Problem> {
    for joints in loops(scene) {
        let mut freedom = Freedom::new(scene, extents, &joints);
        for &number in &joints {
            let joint = &scene.joints[number];
            for (row, speed) in freedom.held(joint) {
                if !freedom.take(row, vec![speed; freedom.times.len()]) {
                    return Err(Problem {
                        key: format!("joints[{number}].{}", joint.kind.name()),
                        found: format!(
                            "`{}`, which holds `{}` to another motion than joints before it do",
                            joint.name, scene.bodies[joint.body].name
                        ),
                        allowed: "joints that leave a motion to their bodies".into(),
                        help: None,
                    });
                }
            }
        }
        for &number in &joints {
            let joint = &scene.joints[number];
            let Some((motor, row, base)) = freedom.driven(joint) else { continue };
            let Some(speed) = motor.speed.as_ref().filter(|_| motor.limit == f64::INFINITY) else { continue };
            let speeds = freedom.times.iter().map(|&time| speed.at(time) + base).collect();
            if !freedom.take(row, speeds) {
                return Err(Problem {
                    key: format!("joints[{number}].{}.speed", joint.kind.name()),
                    found: format!("a motor of `{}` against what other joints hold or drive", joint.name),
                    allowed: "speeds of motions that all joints together leave".into(),
                    help: Some(format!(
                        "`{}` has {} joints; leave out one, or give the motor a `limit`",
                        scene.bodies[joint.body].name,
                        scene.joints.iter().filter(|other| other.body == joint.body && other.holds()).count()
                    )),
                });
            }
        }
    }
    Ok(())
}

/// What pushes a motion that other joints hold fast.
pub(super) fn warning(scene: &Scene, extents: &[FillingExtent]) -> Option<Warning> {
    loops(scene).into_iter().find_map(|joints| {
        let mut freedom = Freedom::new(scene, extents, &joints);
        for &number in &joints {
            for (row, _) in freedom.held(&scene.joints[number]) {
                freedom.take(row, Vec::new());
            }
        }
        joints.iter().find_map(|&number| {
            let joint = &scene.joints[number];
            let (motor, row, _) = freedom.driven(joint)?;
            let push = if matches!(joint.kind, JointKind::Hinge { .. }) { "torque" } else { "force" };
            let limited = motor.speed.is_some().then_some("speed");
            let key = first_key(motor, push).or(limited).filter(|_| freedom.left(&row).1 <= ROUND_OFF)?;
            let why = format!("does not act: other joints hold what `{}` leaves", joint.name);
            Some(Warning::about(format!("joints[{number}].{}.{key}", joint.kind.name()), why))
        })
    })
}

/// Joints of bodies that hang together, by their numbers, where there are more than bodies: so they make a loop.
fn loops(scene: &Scene) -> Vec<Vec<usize>> {
    let mut group: Vec<usize> = (0..scene.bodies.len()).collect();
    fn first(group: &mut [usize], mut body: usize) -> usize {
        while group[body] != body {
            group[body] = group[group[body]];
            body = group[body];
        }
        body
    }
    let is_free = |body: usize| scene.bodies[body].as_free_rigid().is_some();
    let holding = || scene.joints.iter().enumerate().filter(|(_, joint)| joint.holds());
    for (_, joint) in holding() {
        if let Some(to) = joint.to.filter(|&to| is_free(to)) {
            let (a, b) = (first(&mut group, joint.body), first(&mut group, to));
            group[a] = b;
        }
    }
    let mut joints: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (number, joint) in holding() {
        joints.entry(first(&mut group, joint.body)).or_default().push(number);
    }
    let mut bodies: BTreeMap<usize, usize> = BTreeMap::new();
    for body in (0..scene.bodies.len()).filter(|&body| is_free(body)) {
        *bodies.entry(first(&mut group, body)).or_default() += 1;
    }
    let is_loop = |(of, joints): &(usize, Vec<usize>)| joints.len() > bodies[of] && joints.len() <= MOST;
    joints.into_iter().filter(is_loop).map(|(_, joints)| joints).collect()
}

/// Coefficients of the velocities of free bodies, six each.
type Row = Vec<f64>;

/// What some joints leave.
struct Freedom<'a> {
    scene: &'a Scene,
    extents: &'a [FillingExtent],
    /// Where the velocities of each free body stand in a row.
    places: BTreeMap<usize, usize>,
    /// A length that makes spins and velocities alike [m].
    length: f64,
    /// Instants at which right sides are known [s].
    times: Vec<f64>,
    /// Rows of length 1 across each other, with right sides.
    taken: Vec<(Row, Vec<f64>)>,
}

impl<'a> Freedom<'a> {
    fn new(scene: &'a Scene, extents: &'a [FillingExtent], joints: &[usize]) -> Self {
        let both = |&joint: &usize| [Some(scene.joints[joint].body), scene.joints[joint].to];
        let bodies: Vec<usize> = joints.iter().flat_map(both).flatten().collect();
        let mut places = BTreeMap::new();
        for &body in bodies.iter().filter(|&&body| scene.bodies[body].as_free_rigid().is_some()) {
            let next = 6 * places.len();
            places.entry(body).or_insert(next);
        }
        let sizes = places.keys().map(|&body| Vector(extents[body].bounds.size()).norm());
        let length = sizes.filter(|size| size.is_finite()).fold(0.0, f64::max);
        // Where others carry the bodies away, their places at the start say nothing of later.
        let carried = bodies.iter().any(|&body| match &scene.bodies[body].motion {
            BodyMotion::Rigid { velocity, spin } => {
                velocity.iter().chain(spin.iter()).any(|part| part.constant() != Some(0.0))
            }
            _ => false,
        });
        let instants = if carried { 1 } else { INSTANTS };
        let times = (0..instants).map(|i| scene.time.end * i as f64 / INSTANTS as f64).collect();
        let length = if length > 0.0 { length } else { 1.0 };
        Freedom { scene, extents, places, length, times, taken: Vec::new() }
    }

    /// The row of a relative velocity at a point, or of a relative spin, along a direction; and what bodies that move
    /// as prescribed add to it at the start.
    fn row(&self, joint: &Joint, point: Option<[f64; 3]>, direction: [f64; 3]) -> (Row, f64) {
        let mut row = vec![0.0; 6 * self.places.len()];
        let mut known = 0.0;
        for (body, sign) in [(Some(joint.body), 1.0), (joint.to, -1.0)] {
            let Some(body) = body else { continue };
            let moment = point.map_or(direction, |point| {
                cross((Vector(point) - Vector(self.extents[body].center)).0, direction)
            });
            let along = if point.is_some() { direction } else { [0.0; 3] };
            match (self.places.get(&body), &self.scene.bodies[body].motion) {
                (Some(&place), _) => {
                    for k in 0..3 {
                        row[place + k] += sign * along[k];
                        row[place + 3 + k] += sign * moment[k] / self.length;
                    }
                }
                (None, BodyMotion::Rigid { velocity, spin }) => {
                    let at = |of: &[crate::scene::Expression; 3]| of.each_ref().map(|part| part.at(0.0));
                    known += sign
                        * (Vector(along).dot(Vector(at(velocity))) + Vector(moment).dot(Vector(at(spin))));
                }
                _ => {}
            }
        }
        (row, known)
    }

    /// What a joint holds: rows, and their right sides.
    fn held(&self, joint: &Joint) -> Vec<(Row, f64)> {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let (ways, turns) = match self.scene.dimension.axes() {
            2 => (&axes[..2], &axes[2..]),
            _ => (&axes[..], &axes[..]),
        };
        let center = self.extents[joint.body].center;
        let across = |axis: &[f64; 3]| {
            let beside = |&way: &[f64; 3]| {
                Vector((Vector(way) - Vector(*axis) * Vector(way).dot(Vector(*axis))).0).direction()
            };
            let list = |all: &[[f64; 3]]| all.iter().filter_map(beside).map(|way| way.0).collect::<Vec<_>>();
            [list(ways), list(turns)]
        };
        let (point, held_ways, held_turns) = match &joint.kind {
            JointKind::Hinge { point, axis, .. } => (*point, ways.to_vec(), across(axis)[1].clone()),
            JointKind::Slider { axis, .. } => (center, across(axis)[0].clone(), turns.to_vec()),
            JointKind::Planar { axis, .. } => {
                let normal = if ways.len() == 3 { vec![*axis] } else { Vec::new() };
                (center, normal, across(axis)[1].clone())
            }
            JointKind::Ball { point } => (*point, ways.to_vec(), Vec::new()),
            JointKind::Weld => (center, ways.to_vec(), turns.to_vec()),
            JointKind::Spring { .. } => return Vec::new(),
        };
        let at_point = held_ways.into_iter().map(|way| self.row(joint, Some(point), way));
        let turning = held_turns.into_iter().map(|turn| self.row(joint, None, turn));
        at_point.chain(turning).map(|(row, known)| (row, -known)).collect()
    }

    /// The motor of a joint, the row of the motion that it drives, and what is to be added to its speed.
    fn driven<'j>(&self, joint: &'j Joint) -> Option<(&'j Motor, Row, f64)> {
        let (motor, (row, known)) = match &joint.kind {
            JointKind::Hinge { axis, motor, .. } | JointKind::Planar { axis, motor } => {
                (motor, self.row(joint, None, *axis))
            }
            JointKind::Slider { axis, motor } => {
                (motor, self.row(joint, Some(self.extents[joint.body].center), *axis))
            }
            _ => return None,
        };
        Some((motor, row, -known))
    }

    /// A row of length 1 along this one without its parts along those that were taken, which are listed; and how long
    /// it is then.
    fn left(&self, row: &Row) -> (Row, f64, Vec<f64>) {
        let size = dot(row, row).sqrt();
        let mut left: Row = row.iter().map(|x| x / size).collect();
        let mut parts = vec![0.0; self.taken.len()];
        // Twice is enough (Kahan and Parlett).
        for _ in 0..2 {
            for ((taken, _), part) in self.taken.iter().zip(&mut parts) {
                let along = dot(&left, taken);
                left.iter_mut().zip(taken).for_each(|(x, y)| *x -= along * y);
                *part += along;
            }
        }
        let rest = dot(&left, &left).sqrt();
        (left, rest, parts)
    }

    /// Adds a row with its right sides; not, if they contradict what was taken.
    fn take(&mut self, row: Row, sides: Vec<f64>) -> bool {
        let size = dot(&row, &row).sqrt();
        if size <= ROUND_OFF {
            return true;
        }
        let sides: Vec<f64> = sides.iter().map(|side| side / size).collect();
        let (left, rest, parts) = self.left(&row);
        let known = self.sides(&parts, sides.len());
        if rest <= ROUND_OFF {
            let large = sides.iter().chain(&known).fold(0.0_f64, |most, side| most.max(side.abs()));
            return sides.iter().zip(&known).all(|(side, known)| (side - known).abs() <= 1e-6 * large);
        }
        let own = sides.iter().zip(known).map(|(side, known)| (side - known) / rest).collect();
        self.taken.push((left.iter().map(|x| x / rest).collect(), own));
        true
    }

    /// Right sides of a sum of the rows that were taken.
    fn sides(&self, parts: &[f64], count: usize) -> Vec<f64> {
        let mut sum = vec![0.0; count];
        for ((_, sides), part) in self.taken.iter().zip(parts) {
            sum.iter_mut().zip(sides).for_each(|(sum, side)| *sum += part * side);
        }
        sum
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use crate::check::tests::report;

    fn said(dimension: &str, joints: &str) -> Result<Vec<String>, String> {
        let (ball, more) = match dimension {
            "3d" => (", 0", "min = [0, 0, 0], max = [1, 1, 1]"),
            _ => ("", "min = [0, 0], max = [1, 1]"),
        };
        let text = format!(
            "space = {{ dimension = '{dimension}', cell = 0.25 }}\ntime.end = 1\n\
             materials.iron = {{ density = 1, neo_hookean = {{ young_modulus = 9, poisson_ratio = 0 }} }}\n\
             bodies = [\n\
             {{ name = 'a', material = 'iron', shape.box = {{ {more} }}, rigid.free = {{}} }},\n\
             {{ name = 'b', material = 'iron', shape.ball = {{ center = [3, 0{ball}], radius = 1 }}, rigid.free = {{}} }} ]\n\
             joints = [{joints}]\n"
        );
        let scene =
            crate::scene::parse("joints.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
        match report(&scene) {
            Ok(report) => Ok(report.warnings.iter().map(|warning| warning.to_string()).collect()),
            Err(problem) => Err(problem.key),
        }
    }

    /// Two hinges hold a body of the plane fast; one and a slider through it leave it a motion in a dead centre only.
    #[test]
    fn a_motor_against_other_joints_is_refused() {
        let hinge = |x: f64, more: &str| format!("{{ body = 'a', hinge = {{ point = [{x}, 0] {more} }} }},");
        for (joints, key) in [
            (hinge(0.0, "") + &hinge(1.0, ", speed = 5"), "joints[1].hinge.speed"),
            (hinge(0.0, ", speed = '5 rad/s * t / 1 s'") + &hinge(1.0, ""), "joints[0].hinge.speed"),
            (hinge(0.0, ", speed = 5") + &hinge(0.0, ", speed = 3"), "joints[1].hinge.speed"),
            (
                "{ body = 'a', weld = {} }, { body = 'a', slider = { axis = [1, 0], speed = 1 } },".into(),
                "joints[1].slider.speed",
            ),
        ] {
            assert_eq!(said("plane-strain", &joints), Err(key.to_string()), "{joints}");
        }
        for joints in [
            hinge(0.0, "") + &hinge(1.0, ""),
            hinge(0.0, ", speed = 5") + &hinge(0.0, ""),
            hinge(0.0, ", speed = 5") + &hinge(0.0, ", speed = 5"),
            hinge(0.0, ", speed = 5")
                + "{ body = 'b', to = 'a', hinge.point = [1, 0] }, { body = 'b', slider.axis = [0, 1] },",
        ] {
            assert_eq!(said("plane-strain", &joints), Ok(Vec::new()), "{joints}");
        }
        let pushed = hinge(0.0, ", torque = 5") + &hinge(1.0, "");
        let found = said("plane-strain", &pushed).expect("a warning");
        assert!(found[0].starts_with("joints[0].hinge.torque: does not act: other joints hold"), "{found:?}");
    }

    /// A door: two hinges on one line leave it its turn, two on lines side by side do not.
    #[test]
    fn a_door_turns_on_two_hinges() {
        let hinge = |x: f64, z: f64, more: &str| {
            format!("{{ body = 'a', hinge = {{ point = [{x}, 0, {z}], axis = [0, 0, 1] {more} }} }},")
        };
        assert_eq!(said("3d", &(hinge(0.0, 0.0, "") + &hinge(0.0, 1.0, ", speed = 2"))), Ok(Vec::new()));
        let apart = hinge(0.0, 0.0, "") + &hinge(1.0, 1.0, ", speed = 2");
        assert_eq!(said("3d", &apart), Err("joints[1].hinge.speed".into()));
    }
}
