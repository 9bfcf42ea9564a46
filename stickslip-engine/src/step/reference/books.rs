//! What points that touch did: as sums by pair of bodies, and one by one.

use super::Engine;
use crate::contact::BlockSums;
use crate::door::{ContactPoint, Touched};
use crate::lanes::Laned;
use crate::tensor::{Vector, cross};
use stickslip_reference::contact::{Memory, Met, Obstacle, Touch};

impl<T: Laned, const D: usize> Engine<T, D> {
    /// The points that passed a force in the last step, by body, point and partner. All ranks know them.
    pub(in crate::step) fn pressed_points(&self) -> Vec<ContactPoint> {
        let bodies = self.state.bodies.len();
        let touched = |partner: usize| match partner.checked_sub(bodies) {
            None => Touched::Body(partner),
            Some(wall) => {
                let wall = &self.settings.walls[wall];
                Touched::Face { axis: wall.axis, upper: wall.inward < 0 }
            }
        };
        let shown = |touch: &Touch<D>| ContactPoint {
            body: touch.memory.body as usize,
            partner: touched(touch.memory.partner as usize),
            position: touch.at.space(),
            undeformed: self.settings.references[touch.side].surface[touch.memory.point as usize]
                .place
                .space(),
            // Zeros get no sign.
            normal: (Vector::ZERO - touch.normal).space(),
            area: touch.area,
            pressure: 0.0 + touch.pressure(),
            shear: (Vector::ZERO + touch.traction).space(),
        };
        let touches = &self.workspace.reference_touching.touches;
        touches.iter().filter(|touch| touch.force() != Vector::ZERO).map(shown).collect()
    }
}

/// Adds up what touches did in a step of `dt` [s], pair by pair in the order of bodies, and what was lost with those
/// that have parted. Partners have the numbers below `bodies`, faces of the domain those from there on.
pub(super) fn book<const D: usize>(
    all: &mut Vec<BlockSums>,
    obstacles: &[&dyn Obstacle],
    (touches, parted, dt): (&[Touch<D>], &[Memory], f64),
    bodies: usize,
) {
    all.clear();
    // What a face takes is no pair's, as what a body does to itself.
    let pair_of = |body: usize, partner: usize| [body, if partner < bodies { partner } else { body }];
    for memory in parted {
        let [body, partner] = [memory.body as usize, memory.partner as usize];
        let sums = sums_of(all, pair_of(body, partner));
        sums.friction += memory.energy;
        sums.adhesion += memory.bond.unwrap_or_default();
    }
    for touch in touches {
        let [body, partner] = [touch.memory.body as usize, touch.memory.partner as usize];
        sums_of(all, pair_of(body, partner)).work += touch.deepening;
        if partner >= bodies {
            continue;
        }
        add(sums_of(all, [body, partner]), (touch, dt), body < partner, obstacles);
    }
}

/// The sums of a pair of bodies.
fn sums_of(all: &mut Vec<BlockSums>, [a, b]: [usize; 2]) -> &mut BlockSums {
    let pair = [a.min(b), a.max(b)];
    let place = all.binary_search_by_key(&pair, |sums| sums.bodies).unwrap_or_else(|place| {
        all.insert(place, BlockSums { bodies: pair, ..BlockSums::default() });
        place
    });
    &mut all[place]
}

fn add<const D: usize>(
    sums: &mut BlockSums,
    (touch, dt): (&Touch<D>, f64),
    is_first: bool,
    obstacles: &[&dyn Obstacle],
) {
    // Through a periodic face it acts where the first body is.
    let at = if is_first { touch.at } else { touch.at - touch.away }.space();
    let push = touch.normal * (touch.area * touch.pressure() * dt);
    let rub = touch.traction * (touch.area * dt);
    // Of the first body on the second.
    let sign = if is_first { -1.0 } else { 1.0 };
    let (on_second, tangential) = ((push + rub) * sign, rub * -sign);
    let magnitude = (push + rub).norm();
    let turn = cross(at, on_second.space());
    for k in 0..3 {
        sums.impulse[k] += on_second.space()[k];
        sums.tangential[k] += tangential.space()[k];
        sums.moment[k] += magnitude * at[k];
        sums.turn[k] += turn[k];
    }
    sums.normal += push.norm().copysign(touch.pressure());
    sums.magnitude += magnitude;
    sums.friction += touch.friction;
    sums.adhesion += touch.torn;
    // Where the layer does not press yet, friction may remember a pressure.
    if magnitude > 0.0 {
        sums.spread.add(touch.area, at);
        sums.gap -= touch.area * touch.depth();
        sums.nodes += 1;
    }
    sums.slip += touch.area * if touch.friction > 0.0 { touch.slip.norm() * dt } else { 0.0 };
    // What a body gains that nothing prescribes is its own energy.
    if let Met::Obstacle(r) = touch.met
        && !obstacles[r].has_energy()
    {
        let speed = Vector::<f64, D>::of(obstacles[r].velocity((touch.at - touch.away).space()));
        sums.work += (push + rub).dot(speed);
    }
}
