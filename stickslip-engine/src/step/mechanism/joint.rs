//! What a joint pushes with and what it holds.

use super::row::{JointRow, Row};
use super::six::{Six, at, join};
use super::velocity_at;
use crate::body::Body;
use crate::rigid::Pose;
use crate::scene::{Joint, JointKind};
use crate::tensor::{Matrix, Vector, cross};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// What a joint did since the start, on the body that it holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JointSums {
    /// Impulse [N s].
    pub impulse: [f64; 3],
    /// Impulse of moments about the joint's point [N m s].
    pub moment: [f64; 3],
    /// Angle of a hinge or a planar joint [rad], way of a slider, change of a spring's length [m].
    pub way: f64,
    /// Its rate.
    pub speed: f64,
    /// Work on the free bodies [J].
    pub work: f64,
}

/// A joint in a step: where it is, and what it did.
#[derive(Clone, Debug)]
pub struct Link {
    /// The joint's point, and the arms to it from the centres of the bodies [m].
    arms: [[f64; 3]; 2],
    /// The axis now; of what turns or slides [-].
    axis: [f64; 3],
    /// Impulses on the bodies so far.
    impulses: [Six; 2],
}

/// Where the point of a body or of the ground is that was at `place` at the start.
fn now(pose: Option<&Pose>, place: [f64; 3]) -> [f64; 3] {
    pose.map_or(place, |pose| pose.now(place))
}

fn turned(pose: Option<&Pose>, direction: [f64; 3]) -> [f64; 3] {
    pose.map_or(direction, |pose| pose.turned(direction))
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn scaled(a: [f64; 3], factor: f64) -> [f64; 3] {
    a.map(|a| factor * a)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    Vector(a).dot(Vector(b))
}

/// Two unit vectors across a unit vector and each other.
pub fn across(axis: [f64; 3]) -> [[f64; 3]; 2] {
    let least = (0..3).min_by(|&i, &j| axis[i].abs().total_cmp(&axis[j].abs())).unwrap_or(0);
    let other = std::array::from_fn(|i| f64::from(u8::from(i == least)));
    let first = Vector(cross(axis, other)).direction().expect("they are not parallel").0;
    [first, cross(axis, first)]
}

/// Poses of the two bodies of a joint; `None` is the ground.
pub fn poses(joint: &Joint, of: impl Fn(usize) -> Pose) -> [Option<Pose>; 2] {
    [Some(of(joint.body)), joint.to.map(of)]
}

/// Places at the start of the joint's points on the two bodies.
fn points(joint: &Joint, center: [f64; 3]) -> [[f64; 3]; 2] {
    match &joint.kind {
        JointKind::Hinge { point, .. } | JointKind::Ball { point } => [*point; 2],
        JointKind::Slider { .. } | JointKind::Planar { .. } | JointKind::Weld => [center; 2],
        JointKind::Spring { points, .. } => *points,
    }
}

/// Angle, way or change of length of a joint in these poses; angles within a turn.
fn way(joint: &Joint, poses: &[Option<Pose>; 2], center: [f64; 3]) -> f64 {
    let [a, b] = [poses[0].as_ref(), poses[1].as_ref()];
    let [p, q] = points(joint, center);
    match &joint.kind {
        JointKind::Hinge { axis, .. } | JointKind::Planar { axis, .. } => {
            let [e, f] = across(*axis);
            let (e_a, e_b, f_b) = (turned(a, e), turned(b, e), turned(b, f));
            libm::atan2(dot(e_a, f_b), dot(e_a, e_b))
        }
        JointKind::Slider { axis, .. } => dot(minus(now(a, p), now(b, q)), turned(b, *axis)),
        JointKind::Spring { .. } => {
            let length = |a: [f64; 3], b: [f64; 3]| Vector(minus(a, b)).norm();
            length(now(a, p), now(b, q)) - length(p, q)
        }
        JointKind::Ball { .. } | JointKind::Weld => 0.0,
    }
}

impl JointSums {
    /// Measures the joint where the bodies begin, at rest.
    pub fn begin<T, const D: usize>(&mut self, joint: &Joint, bodies: &[Body<T, D>]) {
        self.measure(joint, bodies, f64::INFINITY);
    }

    /// Measures the joint where the bodies are now.
    pub fn measure<T, const D: usize>(&mut self, joint: &Joint, bodies: &[Body<T, D>], dt: f64) {
        let pose = |body: usize| bodies[body].motion.as_deref().expect("joints hold rigid bodies").pose();
        let found = way(joint, &poses(joint, pose), pose(joint.body).begun());
        let mut change = found - self.way;
        if matches!(joint.kind, JointKind::Hinge { .. } | JointKind::Planar { .. }) {
            change -= TAU * ((change + PI) / TAU).floor();
        }
        self.way += change;
        self.speed = change / dt;
    }
}

impl Link {
    /// A joint where its bodies are now.
    pub fn new<T, const D: usize>(joint: &Joint, bodies: &[Body<T, D>]) -> Self {
        let motion = |body: usize| bodies[body].motion.as_deref().expect("joints hold rigid bodies");
        let [a, b] = poses(joint, |body| motion(body).pose());
        let center = motion(joint.body).pose().begun();
        let [p, q] = points(joint, center);
        let place = now(a.as_ref(), p);
        let (other, to) = (now(b.as_ref(), q), joint.to.map_or([0.0; 3], |to| motion(to).center));
        let axis = match &joint.kind {
            JointKind::Hinge { axis, .. }
            | JointKind::Slider { axis, .. }
            | JointKind::Planar { axis, .. } => turned(b.as_ref(), *axis),
            JointKind::Spring { .. } => {
                Vector(minus(place, other)).direction().map_or([0.0; 3], |direction| direction.0)
            }
            JointKind::Ball { .. } | JointKind::Weld => [0.0; 3],
        };
        // What holds acts at one point on both; a spring at its two ends.
        let on_other = if matches!(joint.kind, JointKind::Spring { .. }) { other } else { place };
        Link {
            arms: [minus(place, motion(joint.body).center), minus(on_other, to)],
            axis,
            impulses: [[0.0; 6]; 2],
        }
    }

    /// Impulses on the two bodies in a step by what needs no equation: pushes of motors, springs and dashpots.
    pub fn push<T, const D: usize>(
        &mut self,
        joint: &Joint,
        bodies: &[Body<T, D>],
        (time, dt): (f64, f64),
        way: f64,
    ) -> [Six; 2] {
        let six = |body: usize| {
            let motion = bodies[body].motion.as_deref().expect("joints hold rigid bodies");
            join(motion.velocity(), motion.spin())
        };
        let velocities = [six(joint.body), joint.to.map_or([0.0; 6], six)];
        let turning = || dot(minus(spin(&velocities[0]), spin(&velocities[1])), self.axis);
        let moving = || {
            let [a, b] = [0, 1].map(|side| velocity_at(&velocities[side], self.arms[side]));
            dot(minus(a, b), self.axis)
        };
        let driven = |motor: &crate::scene::Motor, speed: f64| {
            motor.push.over_step(time, dt) - motor.stiffness * way - motor.dashpot * speed
        };
        let given = match &joint.kind {
            JointKind::Hinge { motor, .. } | JointKind::Planar { motor, .. } => {
                let moment = scaled(self.axis, dt * driven(motor, turning()));
                [join([0.0; 3], moment), join([0.0; 3], scaled(moment, -1.0))]
            }
            JointKind::Slider { motor, .. } => self.along(dt * driven(motor, moving())),
            JointKind::Spring { points: [p, q], length, stiffness, dashpot } => {
                let drawn = Vector(minus(*p, *q)).norm();
                let stretch = way + drawn - length.unwrap_or(drawn);
                self.along(-dt * (stiffness * stretch + dashpot * moving()))
            }
            JointKind::Ball { .. } | JointKind::Weld => [[0.0; 6]; 2],
        };
        self.impulses = given;
        given
    }

    /// An impulse along the axis on the first body, and against it on the second.
    fn along(&self, impulse: f64) -> [Six; 2] {
        let [a, b] = self.arms;
        [at(a, scaled(self.axis, impulse)), at(b, scaled(self.axis, -impulse))]
    }

    /// The equations that a joint holds, between bodies at these places of the mechanism.
    pub fn rows(
        &self,
        (number, joint): (usize, &Joint),
        (bodies, dimension, dt): ([Option<usize>; 2], usize, f64),
        rows: &mut Vec<JointRow>,
    ) {
        let mut count = 0;
        let mut hold = |directions: [Six; 2], limit: f64| {
            let row = Row::new(bodies, directions);
            rows.push(JointRow { joint: number, number: count, row, limit });
            count += 1;
        };
        for direction in self.held(joint, dimension) {
            hold(self.directions(direction), f64::INFINITY);
        }
        match &joint.kind {
            JointKind::Hinge { motor, .. } | JointKind::Planar { motor, .. } if motor.speed.is_some() => {
                hold(self.directions(Direction::Turn(self.axis)), motor.limit * dt);
            }
            JointKind::Slider { motor, .. } if motor.speed.is_some() => {
                hold(self.directions(Direction::Way(self.axis)), motor.limit * dt);
            }
            _ => {}
        }
    }

    fn directions(&self, direction: Direction) -> [Six; 2] {
        let [a, b] = self.arms;
        match direction {
            Direction::Way(e) => [at(a, e), at(b, scaled(e, -1.0))],
            Direction::Turn(e) => [join([0.0; 3], e), join([0.0; 3], scaled(e, -1.0))],
        }
    }

    /// Along which directions the joint leaves no way and no turn.
    fn held(&self, joint: &Joint, dimension: usize) -> Vec<Direction> {
        let axes = |count: usize| (0..count).map(|k| std::array::from_fn(|i| f64::from(u8::from(i == k))));
        let ways = || axes(dimension).map(Direction::Way);
        let turns = || axes(3).skip(if dimension == 2 { 2 } else { 0 }).map(Direction::Turn);
        let [e, f] = across(if self.axis == [0.0; 3] { [0.0, 0.0, 1.0] } else { self.axis });
        match &joint.kind {
            JointKind::Hinge { .. } if dimension == 2 => ways().collect(),
            JointKind::Hinge { .. } => ways().chain([e, f].map(Direction::Turn)).collect(),
            JointKind::Planar { .. } if dimension == 2 => Vec::new(),
            JointKind::Planar { .. } => {
                [Direction::Way(self.axis), Direction::Turn(e), Direction::Turn(f)].to_vec()
            }
            JointKind::Ball { .. } => ways().collect(),
            JointKind::Weld => ways().chain(turns()).collect(),
            JointKind::Slider { .. } => {
                let in_plane = |e: &[f64; 3]| dimension == 3 || e[2].abs() < 0.5;
                [e, f].into_iter().filter(in_plane).map(Direction::Way).chain(turns()).collect()
            }
            JointKind::Spring { .. } => Vec::new(),
        }
    }

    /// How far each of its equations is from holding after the step, as a velocity; `poses` are those at its end.
    pub fn off(
        &self,
        joint: &Joint,
        (poses, velocities, center): ([Option<Pose>; 2], [Six; 2], [f64; 3]),
        (dimension, time, dt): (usize, f64, f64),
    ) -> Vec<f64> {
        let [a, b] = [poses[0].as_ref(), poses[1].as_ref()];
        let [p, q] = points(joint, center);
        let parted = minus(now(a, p), now(b, q));
        let twisted = match &joint.kind {
            // The part of the turn across the axis.
            JointKind::Hinge { axis, .. } | JointKind::Planar { axis, .. } => {
                cross(turned(b, *axis), turned(a, *axis))
            }
            _ => {
                let turn = |pose: Option<&Pose>| pose.map_or(Matrix::IDENTITY, |pose| pose.orientation);
                let between = turn(a) * turn(b).transpose();
                let r = &between.0;
                [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]].map(|x| 0.5 * x)
            }
        };
        let axis_now = match &joint.kind {
            JointKind::Slider { axis, .. } | JointKind::Planar { axis, .. } => turned(b, *axis),
            _ => self.axis,
        };
        // What slides may have gone any way along the axis as it is then, what is in a plane any way across it.
        let parted = match &joint.kind {
            JointKind::Slider { .. } => minus(parted, scaled(axis_now, dot(parted, axis_now))),
            JointKind::Planar { .. } => scaled(axis_now, dot(parted, axis_now)),
            _ => parted,
        };
        let mut off: Vec<f64> = (self.held(joint, dimension).into_iter())
            .map(|direction| match direction {
                Direction::Way(e) => dot(parted, e) / dt,
                Direction::Turn(e) => dot(twisted, e) / dt,
            })
            .collect();
        match &joint.kind {
            JointKind::Hinge { motor, .. } | JointKind::Planar { motor, .. } => {
                off.extend(motor.speed.as_ref().map(|speed| {
                    dot(minus(spin(&velocities[0]), spin(&velocities[1])), self.axis)
                        - speed.over_step(time, dt)
                }))
            }
            JointKind::Slider { motor, .. } => off.extend(motor.speed.as_ref().map(|speed| {
                let [v, w] = [0, 1].map(|side| velocity_at(&velocities[side], self.arms[side]));
                dot(minus(v, w), self.axis) - speed.over_step(time, dt)
            })),
            JointKind::Ball { .. } | JointKind::Weld | JointKind::Spring { .. } => {}
        }
        off
    }

    /// Takes the impulses of its equations.
    pub fn take(&mut self, row: &Row) {
        for side in 0..2 {
            super::six::add(&mut self.impulses[side], row.impulse, &row.directions[side]);
        }
    }

    /// Books the step; `mean` is the mean velocity of a free body in the step.
    pub fn book(&self, sums: &mut JointSums, mean: impl Fn(usize) -> Option<Six>) {
        let [impulse, moment] = super::six::parts(self.impulses[0]);
        let about_center = cross(self.arms[0], impulse);
        for i in 0..3 {
            sums.impulse[i] += impulse[i];
            sums.moment[i] += moment[i] - about_center[i];
        }
        for side in 0..2 {
            if let Some(mean) = mean(side) {
                sums.work += super::six::dot(&self.impulses[side], &mean);
            }
        }
    }
}

/// A direction in which a joint holds.
#[derive(Clone, Copy, Debug)]
enum Direction {
    Way([f64; 3]),
    Turn([f64; 3]),
}

fn spin(velocities: &Six) -> [f64; 3] {
    super::six::parts(*velocities)[1]
}
