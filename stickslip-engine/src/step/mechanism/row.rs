//! One equation that a joint or a contact holds.

use super::six::{self, Six, SixFactor};

/// One equation in a step: along it, two bodies have no velocity against each other that leads away from where a joint
/// wants them, or toward each other where they touch.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Places of the free bodies in the mechanism; `None`: what no impulse moves.
    pub bodies: [Option<usize>; 2],
    /// What an impulse along it does to each body per unit; its velocity along it is this times the velocities.
    pub directions: [Six; 2],
    /// Impulse so far [N s, N m s].
    pub impulse: f64,
    /// Velocity along it that is too much, as found so far [m/s, rad/s].
    pub off: f64,
    /// What an impulse of one changes of the bodies' velocities.
    pub response: [Six; 2],
    /// What it changes of the velocity along it.
    pub yields: f64,
}

/// An equation that a joint holds.
#[derive(Clone, Copy, Debug)]
pub struct JointRow {
    /// Number of the joint, and of the equation in it.
    pub joint: usize,
    pub number: usize,
    pub row: Row,
    /// The largest impulse.
    pub limit: f64,
}

impl Row {
    pub fn new(bodies: [Option<usize>; 2], directions: [Six; 2]) -> Self {
        Row { bodies, directions, impulse: 0.0, off: 0.0, response: [[0.0; 6]; 2], yields: 0.0 }
    }

    /// Takes the inertia of the bodies, by the factors of their matrices.
    pub fn respond(&mut self, factors: &[SixFactor]) {
        self.yields = 0.0;
        for side in 0..2 {
            let Some(body) = self.bodies[side] else { continue };
            self.response[side] = factors[body].solve(&self.directions[side]);
            self.yields += six::dot(&self.directions[side], &self.response[side]);
        }
    }
}
