//! Eq. (10) of Bardenhagen et al. (2001), whatever decides about contact: with one normal for the pair,
//! and with each body's own.

use super::{Change, Pair, SurfaceEstimate, SurfaceLoad};
use crate::tensor::{Real, Vector};

/// One normal for the pair and one decision, `touching(approach [m/s], n)`.
///
/// ```text
/// J_n = -m* u . n,   J_t = -m* min(|u_t|, mu max(u . n, 0)) u_t/|u_t|,   u = v_1 - v_2,  m* = m_1 m_2/(m_1 + m_2)
/// ```
/// which is eq. (10) for n_2 = -n_1, with Coulomb's bound; [`crate::contact::Friction`] has the others. While
/// compressed bodies depart, the normal impulse gives back strain energy by pulling, and a pull bears no friction.
pub fn common_normal<T: Real, const D: usize>(
    pair: &Pair<T, D>,
    [v, w]: [Vector<T, D>; 2],
    touching: impl FnOnce(T, Vector<T, D>) -> bool,
) -> Change<T, D> {
    let Some(n) = pair.normal else { return Change::NONE };
    let u = v - w;
    let approach = u.dot(n);
    let m = pair.reduced_mass();
    let friction = &pair.rule.friction;
    let (normal, load) = match (touching(approach, n), friction.borne(m * approach, pair)) {
        (true, _) => (m * approach, pair.load(m * approach.max(T::ZERO))),
        // Surfaces that adhere pull as they part.
        (false, Some(bond)) if approach <= T::ZERO => bond,
        _ => return Change::NONE,
    };
    let slip = u - n * approach;
    let tangential = slip * (m * friction.stopped(slip.norm(), load));
    pair.exchange(-normal, -tangential, n)
}

/// Each body by its own normal and its own decision, `touching(surface, approach [m/s], n)`, as the paper prints it,
/// eqs. (5), (8)-(13). Against a rigid body it is the rigid one's normal: that surface is where it is said to be, and
/// stairs of a lattice would grip on a flat wall.
pub fn own_normals<T: Real, const D: usize>(
    pair: &Pair<T, D>,
    velocities: [Vector<T, D>; 2],
    touching: impl Fn(&SurfaceEstimate<T, D>, T, Vector<T, D>) -> bool,
) -> Change<T, D> {
    let [a, b] = pair.surfaces;
    let share = a.inverse_mass + b.inverse_mass;
    if share <= T::ZERO {
        return Change::NONE;
    }
    // m_2/M = (1/m_1)/(1/m_1 + 1/m_2)
    let center = velocities[1] * (a.inverse_mass / share) + velocities[0] * (b.inverse_mass / share);
    let mut change = Change::NONE;
    for (i, surface) in pair.surfaces.into_iter().enumerate() {
        let other = pair.surfaces[1 - i];
        let of_wall = if other.is_rigid() { other.normal.map(|n| -n) } else { None };
        let Some(n) = of_wall.or(surface.normal) else { continue };
        let dv = velocities[i] - center;
        let approach = dv.dot(n);
        if !touching(surface, approach, n) {
            continue;
        }
        let slip = dv - n * approach;
        if !surface.is_rigid() {
            let mass = T::ONE / surface.inverse_mass;
            let load = SurfaceLoad { mass, push: mass * approach.abs(), exposure: T::ZERO };
            let tangential = slip * -pair.rule.friction.stopped(slip.norm(), load);
            change.impulse[i] = (tangential - n * approach) * mass;
            if i == 0 || a.is_rigid() {
                change.normal = -approach * mass;
                change.tangential = if i == 0 { tangential * mass } else { -tangential * mass };
            }
        }
    }
    // A rigid body decides nothing; the force on it is the other's reaction.
    for i in 0..2 {
        if pair.surfaces[i].is_rigid() {
            change.impulse[i] = -change.impulse[1 - i];
        }
    }
    change
}

#[cfg(test)]
mod tests {
    use super::super::pair::tests::{rule, step, surface};
    use super::*;
    use crate::scene::{ContactLaw, Normal};

    /// m = 1, 3; v = (4, -8), 0: v_cm = (1, -2), dv_1 = (3, -6), dv_2 = (-1, 2); n_1 = (0, -1), so dv_n1 = 6,
    /// dv_t1 = 3. mu = 1/4: v~_1 = v_1 - 6 (n_1 + t_1/4) = (4 - 1.5, -8 + 6), eq. (10); n_2 at atan(3/4) from -n_1, so
    /// dv_n2 = 1, dv_t2 = 2, v~_2 = -(n_2 + t_2/4).
    #[test]
    fn own_normals_give_the_papers_equation_10() {
        let rule = rule(ContactLaw::Kinematic, Normal::Own, 0.25);
        let surfaces = [surface(1.0, [0.0, -1.0]), surface(3.0, [0.6, 0.8])];
        let pair = Pair {
            rule: &rule,
            surfaces: [&surfaces[0], &surfaces[1]],
            normal: None,
            gap: 0.0,
            area: 0.0,
            recovery: 0.0,
            step: step(100.0),
        };
        let change = pair.change([Vector([4.0, -8.0]), Vector::ZERO]);
        let tangent = [-1.6 / 2.0, 1.2 / 2.0];
        let expected = [[-1.5, 6.0], [0, 1].map(|i| -3.0 * ([0.6, 0.8][i] + 0.25 * tangent[i]))];
        for (impulse, expected) in change.impulse.iter().zip(expected) {
            for i in 0..2 {
                assert!((impulse[i] - expected[i]).abs() < 1e-14, "{:?} {expected:?}", impulse);
            }
        }
    }

    /// With n_2 = -n_1 both forms are the same law.
    #[test]
    fn opposite_normals_make_own_and_common_equal() {
        let surfaces = [surface(1.0, [0.0, -1.0]), surface(3.0, [0.0, 1.0])];
        for friction in [0.0, 0.25, 2.0, f64::INFINITY] {
            let [own, common] = [Normal::Own, Normal::Common].map(|normal| {
                let rule = rule(ContactLaw::Traction, normal, friction);
                let normal = Some(Vector([0.0, -1.0]));
                let pair = Pair {
                    rule: &rule,
                    surfaces: [&surfaces[0], &surfaces[1]],
                    normal,
                    gap: 0.0,
                    area: 0.0,
                    recovery: 0.0,
                    step: step(100.0),
                };
                pair.change([Vector([4.0, -8.0]), Vector::ZERO])
            });
            for body in 0..2 {
                let difference = (own.impulse[body] - common.impulse[body]).norm();
                assert!(difference < 1e-14, "friction {friction}: {own:?} {common:?}");
            }
        }
    }

    /// A flat frictionless wall only pushes, whatever the other's stairs say.
    #[test]
    fn against_a_wall_the_walls_normal_counts() {
        let rule = rule(ContactLaw::Kinematic, Normal::Own, 0.0);
        let free = surface(2.0, [0.6, -0.8]);
        let wall = SurfaceEstimate { inverse_mass: 0.0, ..surface(1.0, [0.0, 1.0]) };
        let pair = Pair {
            rule: &rule,
            surfaces: [&free, &wall],
            normal: None,
            gap: 0.0,
            area: 0.0,
            recovery: 0.0,
            step: step(100.0),
        };
        let [on_free, on_wall] = pair.change([Vector([3.0, -8.0]), Vector::ZERO]).impulse;
        assert_eq!((on_free, on_wall), (Vector([0.0, 16.0]), Vector([0.0, -16.0])));
    }

    #[test]
    fn a_rigid_body_feels_the_reaction() {
        let rule = rule(ContactLaw::Kinematic, Normal::Own, 0.25);
        let free = surface(2.0, [0.0, -1.0]);
        let rigid = SurfaceEstimate { inverse_mass: 0.0, ..surface(1.0, [0.0, 1.0]) };
        for surfaces in [[&free, &rigid], [&rigid, &free]] {
            let pair = Pair {
                rule: &rule,
                surfaces,
                normal: None,
                gap: 0.0,
                area: 0.0,
                recovery: 0.0,
                step: step(100.0),
            };
            let down = Vector([0.0, -8.0]);
            let velocities = surfaces.map(|side| if side.inverse_mass > 0.0 { down } else { Vector::ZERO });
            let [a, b] = pair.change(velocities).impulse;
            assert_eq!((a + b, a.norm()), (Vector::ZERO, 16.0));
        }
    }
}
