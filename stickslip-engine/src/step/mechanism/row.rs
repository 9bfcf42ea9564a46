//! One equation that a joint or a contact holds, and how all of them are solved.

use super::six::{self, Six, SixFactor};
use super::touch::Touch;

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
    response: [Six; 2],
    /// What it changes of the velocity along it.
    yields: f64,
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

    /// The impulse that leaves no velocity along it, were it the only equation; so much yields count for one.
    fn wanted(&self, changes: &[Six], yields: f64) -> f64 {
        self.impulse - (self.off + self.along(changes)) / yields
    }
}

/// What a sweep over all equations changed.
#[derive(Default)]
struct Sweep {
    /// The largest change of a velocity, and the largest velocity that an impulse makes.
    moved: f64,
    largest: f64,
}

impl Sweep {
    fn set(&mut self, row: &mut Row, impulse: f64, changes: &mut [Six]) {
        let change = impulse - row.impulse;
        row.impulse = impulse;
        row.give(change, changes);
        self.moved = self.moved.max((change * row.yields).abs());
        self.largest = self.largest.max((impulse * row.yields).abs()).max(row.off.abs());
    }
}

impl Sweep {
    /// The impulses of one contact, with all others as they are.
    fn push(&mut self, touch: &mut Touch, changes: &mut [Six]) {
        let push = touch.normal.wanted(changes, touch.normal.yields).max(0.0);
        self.set(&mut touch.normal, push, changes);
        let strength = touch.strength();
        let yields = touch.tangents.iter().map(|row| row.yields).fold(0.0, f64::max);
        if touch.friction == 0.0 || yields == 0.0 {
            return;
        }
        let wanted = [0, 1].map(|i| touch.tangents.get(i).map_or(0.0, |row| row.wanted(changes, yields)));
        let size = wanted[0].hypot(wanted[1]);
        let scale = if size > strength { strength / size } else { 1.0 };
        for (row, wanted) in touch.tangents.iter_mut().zip(wanted) {
            self.set(row, scale * wanted, changes);
        }
    }
}

/// Sweeps over all equations at most.
const MAX_SWEEPS: usize = 2000;
/// They end where no impulse changes a velocity by more than this part of the largest change; where rigid bodies touch,
/// by more than the second.
const TOLERANCE: f64 = 1e-14;
/// Many points of a face share a load in many ways, between which sweeps go on for long.
pub const TOUCHING: f64 = 1e-9;

/// Finds the impulses with which all equations hold, and adds what they change to the bodies' changes of velocity
/// (projected Gauss-Seidel; friction on the disc of De Saxce and Feng 1998); says whether they came to rest, down to
/// velocities of `round_off`.
pub fn solve(held: &mut [JointRow], touches: &mut [Touch], changes: &mut [Six], round_off: f64) -> bool {
    for row in held.iter().map(|held| &held.row).chain(touches.iter().flat_map(Touch::rows)) {
        row.give(row.impulse, changes);
    }
    let tolerance = if touches.is_empty() { TOLERANCE } else { TOUCHING };
    for _ in 0..MAX_SWEEPS {
        let mut sweep = Sweep::default();
        for JointRow { row, limit, .. } in held.iter_mut().filter(|held| held.row.yields > 0.0) {
            let wanted = row.wanted(changes, row.yields).clamp(-*limit, *limit);
            sweep.set(row, wanted, changes);
        }
        for touch in touches.iter_mut().filter(|touch| touch.normal.yields > 0.0) {
            sweep.push(touch, changes);
        }
        if sweep.moved <= tolerance * sweep.largest + round_off {
            return true;
        }
    }
    false
}
