//! Closed faces of the domain as bodies on grids of their own meet them: rigid half-spaces, those behind mirrors without
//! friction, fixed ones with as much as sticks.

use crate::boundary::Wall;
use crate::geometry::SignedDistance;
use crate::scene::Face;
use crate::step::walls::WallBooks;
use crate::tensor::cross;
use stickslip_reference::contact::{Friction, Rigid, Touch};

/// A closed face of the domain.
pub(super) struct RigidWall {
    number: usize,
    axis: usize,
    position: f64,
    inward: f64,
    /// The middle of the face [m].
    middle: [f64; 3],
}

impl RigidWall {
    /// The face of this number among those of a domain from `min` to `max` [m]; bodies have the numbers below `bodies`.
    pub fn new(wall: &Wall, (number, bodies): (usize, usize), [min, max]: [[f64; 3]; 2]) -> Self {
        let Wall { axis, inward, .. } = *wall;
        let position = if inward > 0 { min[axis] } else { max[axis] };
        let mut middle = [0, 1, 2].map(|k| 0.5 * (min[k] + max[k]));
        middle[axis] = position;
        RigidWall { number: bodies + number, axis, position, inward: f64::from(inward), middle }
    }

    /// Adds the impulse on the face by bodies in a step of `dt` [s] and its moment about the middle, where a body is
    /// `here`, to books by face and body.
    pub fn book<const D: usize>(
        walls: &[Self],
        books: &mut WallBooks,
        (touches, dt): (&[Touch<D>], f64),
        (here, bodies): (impl Fn(usize) -> bool, usize),
    ) {
        for touch in touches {
            let [body, partner] = [touch.memory.body as usize, touch.memory.partner as usize];
            let Some(wall) = partner.checked_sub(bodies).and_then(|number| walls.get(number)) else {
                continue;
            };
            if !here(body) {
                continue;
            }
            let impulse = (touch.normal * touch.pressure() + touch.traction) * (-touch.area * dt);
            let impulse = impulse.space();
            let at = touch.at.space();
            let moment = cross([0, 1, 2].map(|k| at[k] - wall.middle[k]), impulse);
            let sums = books.entry((wall.number - bodies) * bodies + body).or_default();
            sums.iter_mut().zip(impulse.into_iter().chain(moment)).for_each(|(sum, x)| sum.add(x));
        }
    }
}

impl Rigid for RigidWall {
    fn body(&self) -> usize {
        self.number
    }

    fn level(&self, place: [f64; 3]) -> SignedDistance {
        let mut gradient = [0.0; 3];
        gradient[self.axis] = self.inward;
        SignedDistance { distance: (place[self.axis] - self.position) * self.inward, gradient }
    }

    fn velocity(&self, _: [f64; 3]) -> [f64; 3] {
        [0.0; 3]
    }

    fn bounds(&self) -> [[f64; 3]; 2] {
        let mut bounds = [[f64::NEG_INFINITY; 3], [f64::INFINITY; 3]];
        bounds[usize::from(self.inward > 0.0)][self.axis] = self.position;
        bounds
    }
}

/// Friction on a closed face: none on a mirror, and a fixed one holds what touches it.
pub(super) fn friction(face: Face) -> Friction {
    let coefficient = if face == Face::Fixed { f64::INFINITY } else { 0.0 };
    Friction { at_rest: coefficient, kinetic: coefficient, decay_speed: 0.0, memory: None }
}
