//! Closed faces of the domain as bodies on grids of their own meet them: rigid half-spaces, without friction behind a
//! mirror, and with as much as sticks behind a fixed face.

use crate::boundary::Wall;
use crate::geometry::SignedDistance;
use crate::geometry::form::Reaction;
use crate::scene::Face;
use crate::step::walls::WallBooks;
use crate::tensor::{Vector, cross};
use stickslip_reference::contact::{Friction, Obstacle, PeriodLengths, Touch};

/// A closed face of the domain.
pub(super) struct RigidWall<const D: usize> {
    number: usize,
    axis: usize,
    /// 1 for a lower face, -1 for an upper one.
    inward: f64,
    middle: [f64; 3],
    lengths: PeriodLengths<D>,
}

impl<const D: usize> RigidWall<D> {
    /// A face by its number, which follows those of the bodies, and its middle [m].
    pub fn new(number: usize, wall: &Wall, middle: [f64; 3], lengths: PeriodLengths<D>) -> Self {
        RigidWall { number, axis: wall.axis, inward: f64::from(wall.inward), middle, lengths }
    }

    /// Adds to the same books what faces that hold a body did to it.
    pub fn book_held(
        walls: &[Self],
        books: &mut WallBooks,
        (body, reactions): (usize, &[Reaction<D>]),
        bodies: usize,
    ) {
        for Reaction { faces, impulse, at } in reactions {
            let holding = |face: &Self| faces >> (2 * face.axis + usize::from(face.inward < 0.0)) & 1 == 1;
            for k in 0..D {
                // A face takes what acts across it; what acts along it is that of a fixed face, else of any.
                let Some(face) = (walls.iter().position(|face| face.axis == k && holding(face)))
                    .or_else(|| walls.iter().position(holding))
                else {
                    continue;
                };
                let impulse = Vector::<f64, D>::from_fn(|a| if a == k { -impulse[a] } else { 0.0 }).space();
                let arm = (*at - Vector::of(walls[face].middle)).space();
                let sums = books.entry(face * bodies + body).or_default();
                let both = impulse.into_iter().chain(cross(arm, impulse));
                sums.iter_mut().zip(both).for_each(|(sum, x)| sum.add(x));
            }
        }
    }

    /// Adds the impulse on the faces by bodies in a step of `dt` [s] and its moment about the middle, where a body is
    /// `here`, to books by face and body.
    pub fn book(
        walls: &[Self],
        books: &mut WallBooks,
        (touches, dt): (&[Touch<D>], f64),
        (here, bodies): (impl Fn(usize) -> bool, usize),
    ) {
        for touch in touches {
            let [body, partner] = [touch.memory.body as usize, touch.memory.partner as usize];
            let Some(face) = partner.checked_sub(bodies).filter(|_| here(body)) else { continue };
            let (impulse, at) = ((touch.force() * -dt).space(), (touch.at - touch.away).space());
            let moment = cross([0, 1, 2].map(|k| at[k] - walls[face].middle[k]), impulse);
            let sums = books.entry(face * bodies + body).or_default();
            sums.iter_mut().zip(impulse.into_iter().chain(moment)).for_each(|(sum, x)| sum.add(x));
        }
    }
}

impl<const D: usize> Obstacle for RigidWall<D> {
    fn body(&self) -> usize {
        self.number
    }

    fn level(&self, place: [f64; 3]) -> SignedDistance {
        let mut gradient = [0.0; 3];
        gradient[self.axis] = self.inward;
        SignedDistance { distance: (place[self.axis] - self.middle[self.axis]) * self.inward, gradient }
    }

    fn velocity(&self, _: [f64; 3]) -> [f64; 3] {
        [0.0; 3]
    }

    fn bounds(&self) -> [[f64; 3]; 2] {
        let mut bounds = [[f64::NEG_INFINITY; 3], [f64::INFINITY; 3]];
        bounds[usize::from(self.inward > 0.0)][self.axis] = self.middle[self.axis];
        bounds
    }

    fn nearest(&self, place: [f64; 3]) -> (SignedDistance, [f64; 3]) {
        let away = self.lengths.away(Vector::of(self.middle), Vector::of(place));
        (self.level(place), away.space())
    }
}

/// Friction on a closed face: none on a mirror, and a fixed one holds what touches it.
pub(super) fn friction(face: Face) -> Friction {
    let coefficient = if face == Face::Fixed { f64::INFINITY } else { 0.0 };
    Friction { at_rest: coefficient, kinetic: coefficient, ..Friction::default() }
}
