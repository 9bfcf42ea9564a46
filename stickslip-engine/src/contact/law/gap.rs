//! Contact where surfaces touch, told by the room that the bodies leave around a node.
//!
//! ```text
//! gap <= 0   and   ( u . n > 0   or   n . sigma . n < 0 )
//! ```
//! with the gap of [`Pair::gap`] and the traction rule for release. Our own; needs no list of particles.

use super::PairLaw;
use super::traction::{joint, pressed};
use crate::contact::{Change, Pair, common_normal, own_normals};
use crate::scene::Normal;
use crate::tensor::{Real, Vector};

/// Contact without a gap.
pub struct Gap;

/// Surfaces closer than this part of a cell touch: round-off must not part bodies that start in contact.
fn touching<T: Real>() -> T {
    T::of(1e-6).max(T::of(16.0) * T::EPSILON)
}

impl<T: Real, const D: usize> PairLaw<T, D> for Gap {
    fn change(&self, pair: &Pair<T, D>, velocities: [Vector<T, D>; 2]) -> Change<T, D> {
        if pair.gap > touching() {
            return Change::NONE;
        }
        match pair.rule.normal {
            Normal::Common => common_normal(pair, velocities, |approach, n| {
                approach > T::ZERO || joint(pair, n).is_some_and(|traction| traction < T::ZERO)
            }),
            Normal::Own => {
                own_normals(pair, velocities, |surface, approach, n| pressed(surface, approach, n))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::contact::pair::tests::{rule, step, surface};
    use crate::contact::{Change, Pair};
    use crate::scene::{ContactLaw, Normal};
    use crate::tensor::Vector;

    #[test]
    fn surfaces_with_a_gap_do_not_touch_whatever_the_normal() {
        let surfaces = [surface(1.0, [0.0, -1.0]), surface(3.0, [0.0, 1.0])];
        for normal in [Normal::Own, Normal::Common] {
            let rule = rule(ContactLaw::Gap, normal, 0.25);
            let touching = |gap| {
                let normal = Some(Vector([0.0, -1.0]));
                let pair = Pair {
                    rule: &rule,
                    surfaces: [&surfaces[0], &surfaces[1]],
                    normal,
                    gap,
                    area: 0.0,
                    recovery: 0.0,
                    step: step(100.0),
                };
                pair.change([Vector([0.0, -8.0]), Vector::ZERO]) != Change::NONE
            };
            assert!(touching(0.0) && touching(-0.1) && !touching(0.01), "{normal:?}");
        }
    }
}
