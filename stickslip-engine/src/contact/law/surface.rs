//! Contact of exact surfaces: bodies touch where their undeformed shapes, carried along by the deformation, touch.
//!
//! Our own. Each body knows where the material around a node was before it deformed ([`crate::contact::ReferenceMap`]),
//! hence the distance and the normal of its surface there. The pair takes one normal from both, the flatter and surer
//! one deciding, and one gap, where the smaller share of the node lies. Contact is one unilateral impulse a step, with
//! Coulomb's bound on the whole of it (Moreau 1988):
//!
//! ```text
//! u = v_1 - v_2,   u_n <= max(gap, 0)/dt,   J_n >= 0,   |J_t| <= mu J_n,   J_t against the slip
//! ```
//! Bodies may close a gap within a step, and never pull, unless they adhere ([`crate::contact::Friction`]). The impulse
//! for the velocities that strain and move particles is not part of the sum: bodies that press on each other strain
//! with a common normal velocity, whether they are being compressed or released.

use super::{NearParticle, PairLaw};
use crate::body::Body;
use crate::contact::{BodyShare, Change, ContactUse, Facing, LawInputs, Pair, Span};
use crate::tensor::{Real, Vector};

/// Contact of carried surfaces.
pub struct Surface;

impl<T: Real, const D: usize> PairLaw<T, D> for Surface {
    fn span(&self) -> Span {
        Span::WholeStep
    }

    fn by_place(&self) -> bool {
        true
    }

    fn facing(&self, look: &LawInputs<T, D>, _: &mut Vec<NearParticle<T, D>>) -> Option<Facing<T, D>> {
        let pair = look.pair.map(|side| &look.sides[side]);
        // Seen from the body with less volume there: the other may go on far beyond it.
        let near = if pair[0].surface.volume <= pair[1].surface.volume { 0 } else { 1 };
        let seen = |side: usize, point: Vector<T, D>| {
            let BodyShare { body, surface, .. } = pair[side];
            surface.place.offset(point, &look.near.bodies[*body].whole)
        };
        // Its centre, moved onto the other's surface.
        let center = pair[near].surface.place.center;
        let from = seen(1 - near, center);
        let point = center - from.normal * from.distance;
        let cell = look.near.lattice.cell;
        let [a, b] = [0, 1].map(|side| seen(side, point));
        let gap = (a.distance + b.distance) / cell;
        if gap > look.reach {
            return None;
        }
        // Where the normals agree, it does not matter whose counts more.
        let weights = match (a.normal + b.normal).norm() < T::of(AGREEING) {
            true => [T::ONE; 2],
            false => [0, 1].map(|side| {
                let doubt = doubt(&look.near.bodies[pair[side].body]);
                flatness(|arm| seen(side, point + arm).normal, cell, doubt)
            }),
        };
        Some(Facing { normal: (a.normal * weights[0] - b.normal * weights[1]).direction(), gap })
    }

    fn change(&self, pair: &Pair<T, D>, [v, w]: [Vector<T, D>; 2]) -> Change<T, D> {
        let Some(n) = pair.normal else { return Change::NONE };
        let m = pair.reduced_mass();
        let u = v - w;
        let friction = &pair.rule.friction;
        // The speed that closes the gap in this step, and that at which surfaces part that grow.
        let closing = pair.gap.max(T::ZERO) * pair.step.cell_speed();
        let parting = pair.growth_speed();
        // What keeps the surfaces from crossing, or from parting; a bond does not draw them over a gap.
        let normal = |u: Vector<T, D>| m * (u.dot(n) - u.dot(n).max(T::ZERO).min(closing) + parting);
        let across = |u: Vector<T, D>| u - n * u.dot(n);
        match pair.step.purpose {
            ContactUse::VelocityChange => {
                let slip = across(u);
                let Some((normal, load)) = friction.borne(normal(u), pair) else { return Change::NONE };
                pair.exchange(-normal, -slip * (m * friction.stopped(slip.norm(), load)), n)
            }
            // The sum is judged later.
            ContactUse::Start => Change::NONE,
            ContactUse::Strain => {
                let [a, b] = pair.surfaces;
                let ahead = u + (a.force * a.inverse_mass - b.force * b.inverse_mass) * pair.step.duration;
                let wanted = normal(ahead);
                let Some((borne, load)) = friction.borne(wanted, pair) else { return Change::NONE };
                // A bond that gives way lets the bodies part, and strains none.
                let held = wanted != T::ZERO && borne == wanted;
                let sticks = friction.stopped(across(ahead).norm(), load) == T::ONE;
                let tangential = if sticks { across(u) * m } else { Vector::ZERO };
                pair.exchange(if held { -normal(u) } else { T::ZERO }, -tangential, n)
            }
        }
    }
}

/// Angle between two normals that are the same for all that contact does [rad].
const AGREEING: f64 = 1e-3;

/// How far the normal of a body's face may be off, as the square of an angle in radians: it is as good as the
/// deformation that carries it, which is known to two degrees, and to ten where plastic flow resists no error of it: of
/// a material that may flow, whether it has or not.
fn doubt<T: Real, const D: usize>(body: &Body<T, D>) -> T {
    T::of(if body.trusts_deformation() { 1e-3 } else { 0.03 })
}

/// How flat a surface is around a point: large on a face, 2 at a right-angled edge.
///
/// ```text
/// 1 / max(1 - c^2, doubt),   c = |mean of the normals half a cell away|
/// ```
fn flatness<T: Real, const D: usize>(normal: impl Fn(Vector<T, D>) -> Vector<T, D>, cell: T, doubt: T) -> T {
    let mut sum = Vector::ZERO;
    for axis in 0..D {
        for half in [-T::HALF, T::HALF] {
            sum += normal(Vector::from_fn(|i| if i == axis { half * cell } else { T::ZERO }));
        }
    }
    let mean = sum.norm() / T::of(2.0 * D as f64);
    T::ONE / (T::ONE - mean * mean).max(doubt)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::TimeStep;
    use crate::contact::pair::tests::{rule, surface};
    use crate::scene::{ContactLaw, Normal};

    /// Masses 1 and 3, so m* = 3/4; the first flies down at the second, one cell of 1 m a step of 1 s.
    fn impulse(gap: f64, purpose: ContactUse, force: f64, velocity: [f64; 2]) -> [f64; 2] {
        bonded(0.0, gap, purpose, force, velocity)
    }

    /// The same where an area of 1 m adheres.
    fn bonded(adhesion: f64, gap: f64, purpose: ContactUse, force: f64, velocity: [f64; 2]) -> [f64; 2] {
        let mut rule = rule(ContactLaw::Surface, Normal::Common, 0.5);
        rule.friction.adhesion = adhesion;
        let surfaces = [
            crate::contact::SurfaceEstimate { force: Vector([0.0, force]), ..surface(1.0, [0.0, -1.0]) },
            surface(3.0, [0.0, 1.0]),
        ];
        let pair = Pair {
            rule: &rule,
            surfaces: [&surfaces[0], &surfaces[1]],
            normal: Some(Vector([0.0, -1.0])),
            gap,
            area: 1.0,
            recovery: 0.0,
            step: TimeStep { duration: 1.0, cell: 1.0, purpose },
        };
        Surface.change(&pair, [Vector(velocity), Vector::ZERO]).impulse[0].0
    }

    #[test]
    fn bodies_close_their_gap_and_no_more_and_never_pull() {
        assert_eq!(impulse(0.5, ContactUse::VelocityChange, 0.0, [0.0, -0.4]), [0.0, 0.0]);
        assert_eq!(impulse(0.5, ContactUse::VelocityChange, 0.0, [0.0, -0.9]), [0.0, 0.75 * 0.4]);
        assert_eq!(impulse(-0.5, ContactUse::VelocityChange, 0.0, [0.0, -0.4]), [0.0, 0.75 * 0.4]);
        assert_eq!(impulse(-0.5, ContactUse::VelocityChange, 0.0, [0.0, 0.4]), [0.0, 0.0]);
    }

    /// A bond stops surfaces that part, up to its strength, within a hundredth of a cell; it does not draw them
    /// together, and what it cannot hold it does not strain.
    #[test]
    fn a_bond_holds_what_it_bears_and_draws_nothing() {
        let bonded = |gap, purpose, speed| bonded(0.3, gap, purpose, 0.0, [0.0, speed])[1];
        assert_eq!(
            (bonded(0.0, ContactUse::VelocityChange, 0.25), bonded(0.0, ContactUse::VelocityChange, 2.0)),
            (-0.75 * 0.25, -0.3)
        );
        assert_eq!(
            (
                bonded(0.009, ContactUse::VelocityChange, 0.0),
                bonded(0.009, ContactUse::VelocityChange, -0.005)
            ),
            (0.0, 0.0)
        );
        assert_eq!(bonded(0.011, ContactUse::VelocityChange, 0.25), 0.0);
        assert_eq!(
            (bonded(0.0, ContactUse::Strain, 0.25), bonded(0.0, ContactUse::Strain, 2.0)),
            (-0.75 * 0.25, 0.0)
        );
    }

    #[test]
    fn friction_stops_the_slip_up_to_its_coefficient() {
        assert_eq!(impulse(0.0, ContactUse::VelocityChange, 0.0, [0.25, -1.0]), [-0.75 * 0.25, 0.75]);
        assert_eq!(impulse(0.0, ContactUse::VelocityChange, 0.0, [-2.0, -1.0]), [0.75 * 0.5, 0.75]);
    }

    /// The stress pushes the first body against the second: they strain together even while they part,
    /// and stick if they can.
    #[test]
    fn bodies_that_press_strain_with_one_normal_velocity() {
        assert_eq!(impulse(0.0, ContactUse::Strain, -1.0, [0.25, 0.5]), [-0.75 * 0.25, -0.75 * 0.5]);
        assert_eq!(impulse(0.0, ContactUse::Strain, -1.0, [2.0, 0.5]), [0.0, -0.75 * 0.5]);
        assert_eq!(impulse(0.0, ContactUse::Strain, 0.0, [0.25, 0.5]), [0.0, 0.0]);
    }

    #[test]
    fn a_face_is_flatter_than_an_edge() {
        let (down, left) = (Vector([0.0, -1.0]), Vector([-1.0, 0.0]));
        let edge = flatness(|arm: Vector<f64, 2>| if arm[0] + arm[1] < 0.0 { left } else { down }, 1.0, 1e-3);
        assert!((edge - 2.0).abs() < 1e-12, "{edge}");
        assert_eq!(flatness(|_: Vector<f64, 2>| down, 1.0, 1e-3), 1000.0);
    }
}
