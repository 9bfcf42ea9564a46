//! Rigid bodies: those whose motion is prescribed, and free ones, which forces move.

mod free;
mod light;
mod longest_step;

pub use free::{FreeMotion, FreeState, MassProperties};
use free::{quaternion_of, turn_of};
pub use light::{Carried, carried_bodies};
pub use longest_step::longest_step;

use crate::outside::OutsideFault;
use crate::scene::{BodyMotion, Expression, OutsideValue};
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
    /// What moves it.
    drive: Drive,
    /// Velocity of the centre in this step [m/s].
    now: [f64; 3],
    /// Angular velocity in this step [rad/s].
    turning: [f64; 3],
}

/// What moves a rigid body.
#[derive(Clone, Debug)]
enum Drive {
    /// Formulas of velocity and angular velocity.
    Prescribed { velocity: [Expression; 3], spin: [Expression; 3] },
    /// Its inertia and what acts on it.
    Free(FreeMotion),
}

/// What of a rigid body's motion changes from step to step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigidState {
    start: [f64; 3],
    center: [f64; 3],
    orientation: Matrix<f64>,
    velocity: [f64; 3],
    spin: [f64; 3],
    /// Momenta of a free one.
    free: Option<FreeState>,
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
    /// The prescribed motion of a body whose centre is at `center` [m]; `None` if none is prescribed.
    pub fn prescribed(motion: &BodyMotion, center: [f64; 3]) -> Option<Self> {
        match motion {
            BodyMotion::Free { .. } | BodyMotion::FreeRigid(_) => None,
            BodyMotion::Rigid { velocity, spin } => {
                Some(RigidMotion::new(center, *velocity.clone(), *spin.clone()))
            }
        }
    }

    /// A body at rest at `center` until its first step. A function from outside that fails now is asked again in the
    /// first step, and fails there.
    pub fn new(center: [f64; 3], velocity: [Expression; 3], spin: [Expression; 3]) -> Self {
        let mut motion = RigidMotion {
            center,
            start: center,
            orientation: Matrix::IDENTITY,
            drive: Drive::Prescribed { velocity, spin },
            now: [0.0; 3],
            turning: [0.0; 3],
        };
        let _ = motion.set_time(0.0);
        motion
    }

    /// A free body with this velocity [m/s] and angular velocity [rad/s] at the start.
    pub fn free(properties: &MassProperties, velocity: [f64; 3], spin: [f64; 3]) -> Self {
        let center = properties.center;
        RigidMotion {
            center,
            start: center,
            orientation: Matrix::IDENTITY,
            drive: Drive::Free(FreeMotion::new(properties, velocity, spin)),
            now: velocity,
            turning: spin,
        }
    }

    /// Takes the velocities that are prescribed at time `t` [s]; a free body keeps its own.
    ///
    /// # Errors
    /// A function from outside that has no answer.
    pub fn set_time(&mut self, t: f64) -> Result<(), OutsideFault> {
        if let Drive::Prescribed { velocity, spin } = &self.drive {
            (self.now, self.turning) = (OutsideValue::vector(velocity, t)?, OutsideValue::vector(spin, t)?);
        }
        Ok(())
    }

    /// Takes the velocities that are prescribed over a step of `dt` from `time` on [s], the means: they move the body
    /// as far as it moves in that time. A free body keeps its own.
    ///
    /// # Errors
    /// A function from outside that has no answer.
    pub fn set_step(&mut self, time: f64, dt: f64) -> Result<(), OutsideFault> {
        if let Drive::Prescribed { velocity, spin } = &self.drive {
            let mean = |of| OutsideValue::vector_over_step(of, (time, dt));
            (self.now, self.turning) = (mean(velocity)?, mean(spin)?);
        }
        Ok(())
    }

    /// The velocity of the centre and the angular velocity that are prescribed at time `t` [s]; in a step the body has
    /// their means. What comes from outside is not asked for more than steps need: of it, and of a free body, those of
    /// the last step.
    pub fn velocities_at(&self, t: f64) -> [[f64; 3]; 2] {
        let of_step = [self.now, self.turning];
        let Drive::Prescribed { velocity, spin } = &self.drive else { return of_step };
        let at_time = |of: &[Expression; 3]| OutsideValue::vector(of, t).ok();
        let is_known = velocity.iter().chain(spin.iter()).all(|part| part.outside().is_none());
        let now = if is_known { at_time(velocity).zip(at_time(spin)) } else { None };
        now.map_or(of_step, |(velocity, spin)| [velocity, spin])
    }

    /// How far a step of `dt` from `time` on takes the centre of a body whose motion a formula or a table prescribes
    /// [m].
    pub fn prescribed_way(&self, time: f64, dt: f64) -> f64 {
        let Drive::Prescribed { velocity, .. } = &self.drive else { return 0.0 };
        // What comes from outside is asked for no more than a step needs.
        let is_known = velocity.iter().all(|part| part.outside().is_none());
        let along = |part: &Expression| if is_known { dt * part.over_step(time, dt) } else { 0.0 };
        velocity.iter().map(along).map(|way| way * way).sum::<f64>().sqrt()
    }

    /// Its momenta and inertia, if it is free.
    pub fn as_free(&self) -> Option<&FreeMotion> {
        match &self.drive {
            Drive::Free(free) => Some(free),
            Drive::Prescribed { .. } => None,
        }
    }

    /// Gives a free body these momenta [kg m/s, kg m^2/s], and the velocities that it has with them in a step of `dt`.
    pub fn set_momenta(&mut self, [momentum, angular_momentum]: [[f64; 3]; 2], dt: f64) {
        if let Drive::Free(free) = &mut self.drive {
            (free.state.momentum, free.state.angular_momentum) = (momentum, angular_momentum);
            (self.now, self.turning) = (free.velocity(), free.spin(dt));
        }
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
        self.orientation = match &mut self.drive {
            Drive::Prescribed { .. } => *rotation * self.orientation,
            Drive::Free(free) => {
                free.turn(self.turning, dt);
                free.orientation()
            }
        };
    }

    /// Where it will be after a step of `dt` with the velocities that it has.
    pub fn next_pose(&self, dt: f64) -> Pose {
        let mut next = self.clone();
        next.advance(&self.rotation(dt), dt);
        next.pose()
    }

    /// Where the body is now.
    pub fn pose(&self) -> Pose {
        Pose { start: self.start, center: self.center, orientation: self.orientation }
    }

    /// Where it is and how it moves.
    pub fn state(&self) -> RigidState {
        let RigidMotion { start, center, orientation, now, turning, .. } = *self;
        let free = self.as_free().map(|free| free.state);
        RigidState { start, center, orientation, velocity: now, spin: turning, free }
    }

    /// Whether a state is that of a body which moves in the same way: both free, or both prescribed.
    pub fn is_like(&self, state: &RigidState) -> bool {
        self.as_free().is_some() == state.free.is_some()
    }

    /// Goes on from there.
    pub fn restore(&mut self, state: &RigidState) {
        (self.center, self.orientation) = (state.center, state.orientation);
        (self.now, self.turning) = (state.velocity, state.spin);
        if let (Drive::Free(free), Some(saved)) = (&mut self.drive, state.free) {
            free.state = saved;
        }
    }

    /// Puts it where it has turned so, and where a point of it is now that was at `began` before anything moved [m]. The
    /// turn may be one to single precision only.
    pub fn put(&mut self, orientation: Matrix<f64>, [began, now]: [[f64; 3]; 2]) {
        let quaternion = quaternion_of(&orientation);
        self.orientation = turn_of(quaternion);
        let arm = self.orientation.times(std::array::from_fn(|i| began[i] - self.start[i]));
        self.center = std::array::from_fn(|i| now[i] - arm[i]);
        if let Drive::Free(free) = &mut self.drive {
            free.put(quaternion);
        }
    }

    /// Gives a free body the momenta that it has with a velocity of its centre [m/s] and an angular velocity [rad/s].
    pub fn set_velocities(&mut self, [velocity, spin]: [[f64; 3]; 2]) {
        let Some(free) = self.as_free() else { return };
        let momenta = [velocity.map(|v| free.mass * v), free.inertia().times(spin)];
        self.set_momenta(momenta, 0.0);
    }

    /// Brings it to rest where it is.
    pub fn stop(&mut self) {
        self.set_momenta([[0.0; 3]; 2], 0.0);
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
    #[inline]
    pub fn turned(&self, direction: [f64; 3]) -> [f64; 3] {
        self.orientation.times(direction)
    }

    /// Where the centre was at the start [m].
    #[inline]
    pub fn begun(&self) -> [f64; 3] {
        self.start
    }

    /// The same, moved on [m].
    pub fn moved(&self, by: [f64; 3]) -> Pose {
        Pose { center: std::array::from_fn(|k| self.center[k] + by[k]), ..*self }
    }

    /// Where a point of the body is now that was at `place` at the start [m].
    #[inline]
    pub fn now(&self, place: [f64; 3]) -> [f64; 3] {
        let turn = &self.orientation.0;
        std::array::from_fn(|i| {
            self.center[i] + (0..3).map(|j| turn[i][j] * (place[j] - self.start[j])).sum::<f64>()
        })
    }

    /// Where the point of the body was at the start that is here now [m].
    #[inline]
    pub fn start(&self, position: [f64; 3]) -> [f64; 3] {
        let turn = &self.orientation.0;
        std::array::from_fn(|i| {
            self.start[i] + (0..3).map(|j| turn[j][i] * (position[j] - self.center[j])).sum::<f64>()
        })
    }
}
