//! Rigid bodies with prescribed motion.

use crate::scene::{BodyMotion, Expression};
use crate::tensor::{Matrix, cross};
use serde::{Deserialize, Serialize};

/// How a rigid body moves, and where it is.
#[derive(Clone, Debug)]
pub struct RigidMotion {
    /// Centre of mass now [m].
    pub center: [f64; 3],
    /// Centre of mass before anything moved [m].
    start: [f64; 3],
    /// How it has turned since then.
    orientation: Matrix<f64>,
    velocity: [Expression; 3],
    spin: [Expression; 3],
    /// Velocity of the centre in this step [m/s].
    now: [f64; 3],
    /// Angular velocity in this step [rad/s].
    turning: [f64; 3],
}

/// What of a rigid body's motion changes from step to step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigidState {
    start: [f64; 3],
    center: [f64; 3],
    orientation: Matrix<f64>,
    velocity: [f64; 3],
    spin: [f64; 3],
}

impl RigidState {
    /// Where it was before anything moved [m].
    pub fn start(&self) -> [f64; 3] {
        self.start
    }

    /// Whether it is somewhere else than it was then.
    pub fn has_moved(&self) -> bool {
        self.center != self.start || self.orientation != Matrix::IDENTITY
    }
}

impl RigidMotion {
    /// The prescribed motion of a body whose centre is at `center` [m]; `None` if it is not rigid.
    pub fn prescribed(motion: &BodyMotion, center: [f64; 3]) -> Option<Self> {
        match motion {
            BodyMotion::Free { .. } => None,
            BodyMotion::Rigid { velocity, spin } => {
                Some(RigidMotion::new(center, velocity.clone(), spin.clone()))
            }
        }
    }

    /// A body at rest at `center` until its first step.
    pub fn new(center: [f64; 3], velocity: [Expression; 3], spin: [Expression; 3]) -> Self {
        let (start, orientation) = (center, Matrix::IDENTITY);
        let mut motion =
            RigidMotion { center, start, orientation, velocity, spin, now: [0.0; 3], turning: [0.0; 3] };
        motion.set_time(0.0);
        motion
    }

    /// Takes the velocities of time `t` [s].
    pub fn set_time(&mut self, t: f64) {
        self.now = std::array::from_fn(|i| self.velocity[i].at(t));
        self.turning = std::array::from_fn(|i| self.spin[i].at(t));
    }

    /// v + w x (x - c) [m/s]
    pub fn velocity_at(&self, position: [f64; 3]) -> [f64; 3] {
        let turn = cross(self.turning, std::array::from_fn(|i| position[i] - self.center[i]));
        std::array::from_fn(|i| self.now[i] + turn[i])
    }

    /// The rotation of a step of `dt`.
    pub fn rotation(&self, dt: f64) -> Matrix<f64> {
        Matrix::rotation_by(self.turning.map(|w| w * dt))
    }

    /// Where a step of `dt` with this rotation takes a point.
    pub fn moved(&self, position: [f64; 3], rotation: &Matrix<f64>, dt: f64) -> [f64; 3] {
        let arm: [f64; 3] = std::array::from_fn(|i| position[i] - self.center[i]);
        std::array::from_fn(|i| {
            self.center[i] + self.now[i] * dt + (0..3).map(|j| rotation.0[i][j] * arm[j]).sum::<f64>()
        })
    }

    /// Moves the whole by a step of `dt` with this rotation.
    pub fn advance(&mut self, rotation: &Matrix<f64>, dt: f64) {
        for i in 0..3 {
            self.center[i] += self.now[i] * dt;
        }
        self.orientation = *rotation * self.orientation;
    }

    /// Where the body is now.
    pub fn pose(&self) -> Pose {
        Pose { start: self.start, center: self.center, orientation: self.orientation }
    }

    /// Where it is and how it moves.
    pub fn state(&self) -> RigidState {
        let RigidMotion { start, center, orientation, now, turning, .. } = *self;
        RigidState { start, center, orientation, velocity: now, spin: turning }
    }

    /// Goes on from there.
    pub fn restore(&mut self, state: &RigidState) {
        (self.center, self.orientation) = (state.center, state.orientation);
        (self.now, self.turning) = (state.velocity, state.spin);
    }

    /// Velocity of the centre now [m/s].
    pub fn velocity(&self) -> [f64; 3] {
        self.now
    }

    /// Angular velocity now [rad/s].
    pub fn spin(&self) -> [f64; 3] {
        self.turning
    }
}

/// Where a rigid body is: x = c + Q (X - c_0).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    start: [f64; 3],
    center: [f64; 3],
    /// Q, the turn since the start.
    pub orientation: Matrix<f64>,
}

impl Pose {
    /// A direction in the body as it is now.
    pub fn turned(&self, direction: [f64; 3]) -> [f64; 3] {
        self.orientation.times(direction)
    }

    /// Where a point of the body is now that was at `place` at the start [m].
    pub fn now(&self, place: [f64; 3]) -> [f64; 3] {
        let turn = &self.orientation.0;
        std::array::from_fn(|i| {
            self.center[i] + (0..3).map(|j| turn[i][j] * (place[j] - self.start[j])).sum::<f64>()
        })
    }

    /// Where the point of the body was at the start that is here now [m].
    pub fn start(&self, position: [f64; 3]) -> [f64; 3] {
        let turn = &self.orientation.0;
        std::array::from_fn(|i| {
            self.start[i] + (0..3).map(|j| turn[j][i] * (position[j] - self.center[j])).sum::<f64>()
        })
    }
}
