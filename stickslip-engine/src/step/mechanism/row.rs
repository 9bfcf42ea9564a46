//! One equation that a joint holds, and how all of them are solved.

use super::six::{self, Six, SixFactor};

/// One equation that a joint holds in a step: along it, two bodies have no velocity against each other that leads away
/// from where the joint wants them.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Number of the joint, and of the equation in it.
    pub joint: usize,
    pub number: usize,
    /// Places of the free bodies in the mechanism; `None`: what no impulse moves.
    pub bodies: [Option<usize>; 2],
    /// What an impulse along it does to each body per unit; its velocity along it is this times the velocities.
    pub directions: [Six; 2],
    /// Impulse so far [N s, N m s].
    pub impulse: f64,
    /// The largest impulse.
    pub limit: f64,
    /// Velocity along it that is too much, as found so far [m/s, rad/s].
    pub off: f64,
    /// What an impulse of one changes of the bodies' velocities.
    response: [Six; 2],
    /// What it changes of the velocity along it.
    yields: f64,
}

impl Row {
    pub fn new(
        (joint, number): (usize, usize),
        bodies: [Option<usize>; 2],
        (directions, limit): ([Six; 2], f64),
    ) -> Self {
        Row {
            joint,
            number,
            bodies,
            directions,
            impulse: 0.0,
            limit,
            off: 0.0,
            response: [[0.0; 6]; 2],
            yields: 0.0,
        }
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

    /// Velocity along it of these changes of velocity.
    fn along(&self, changes: &[Six]) -> f64 {
        (0..2).filter_map(|side| Some(six::dot(&self.directions[side], &changes[self.bodies[side]?]))).sum()
    }

    /// Adds what an impulse changes.
    fn give(&self, impulse: f64, changes: &mut [Six]) {
        for side in 0..2 {
            if let Some(body) = self.bodies[side] {
                six::add(&mut changes[body], impulse, &self.response[side]);
            }
        }
    }
}

/// Sweeps over all equations at most.
const MAX_SWEEPS: usize = 2000;
/// They end where no impulse changes a velocity by more than this part of the largest change.
const TOLERANCE: f64 = 1e-14;

/// Finds the impulses with which all equations hold, and adds what they change to the bodies' changes of velocity
/// (projected Gauss-Seidel); says whether they came to rest.
pub fn solve(rows: &mut [Row], changes: &mut [Six]) -> bool {
    for row in rows.iter() {
        row.give(row.impulse, changes);
    }
    for _ in 0..MAX_SWEEPS {
        let (mut moved, mut largest) = (0.0_f64, 0.0_f64);
        for row in rows.iter_mut().filter(|row| row.yields > 0.0) {
            let before = row.impulse;
            let wanted = before - (row.off + row.along(changes)) / row.yields;
            row.impulse = wanted.clamp(-row.limit, row.limit);
            row.give(row.impulse - before, changes);
            moved = moved.max(((row.impulse - before) * row.yields).abs());
            largest = largest.max((row.impulse * row.yields).abs()).max(row.off.abs());
        }
        if moved <= TOLERANCE * largest {
            return true;
        }
    }
    false
}
