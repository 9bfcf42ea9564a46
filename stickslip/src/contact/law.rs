//! Contact laws at one node: from the velocities of two bodies to their changes by contact.

use super::Rule;
use crate::scene::{ContactLaw, Normal};
use crate::tensor::{Real, Symmetric, Vector};

/// What the particles around a node say of one body's surface there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface<T, const D: usize> {
    /// 1/m of the body's share of the node, zero for a rigid body [1/kg].
    pub inverse_mass: T,
    /// Outward normal from the gradient of the body's own grid mass, if it has one [-].
    pub normal: Option<Vector<T, D>>,
    /// Cauchy stress: the body's particle stresses interpolated by volume [Pa].
    pub stress: Symmetric<T>,
    /// Volume with which the stress was weighted [m^3].
    pub volume: T,
    /// P-wave modulus of the material: stresses far below it count as none [Pa].
    pub modulus: T,
}

/// Two bodies at a node.
#[derive(Clone, Copy, Debug)]
pub struct Pair<'a, T, const D: usize> {
    /// The rule that holds between them.
    pub rule: &'a Rule<T>,
    /// Their surfaces.
    pub surfaces: [&'a Surface<T, D>; 2],
    /// Common normal from the first to the second, from the difference of their volume gradients [-].
    pub normal: Option<Vector<T, D>>,
    /// Distance between the surfaces at the node, negative where they overlap [cells].
    pub gap: T,
    /// Largest change of velocity that a cell bears in this step: gamma h/dt [m/s].
    pub limit: T,
}

/// What contact does to two bodies at a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change<T, const D: usize> {
    /// Impulse on each body [N s]; equal and opposite with a common normal.
    pub impulse: [Vector<T, D>; 2],
    /// Impulse on the first body along the normal; negative pushes it away from the second [N s].
    pub normal: T,
    /// Impulse on the first body across the normal [N s].
    pub tangential: Vector<T, D>,
}

impl<T: Real, const D: usize> Change<T, D> {
    /// No contact.
    pub const NONE: Self = Change { impulse: [Vector::ZERO; 2], normal: T::ZERO, tangential: Vector::ZERO };
}

/// Surfaces closer than this part of a cell touch: round-off must not part bodies that start in contact.
const TOUCHING: f64 = 1e-6;

/// Stress below this fraction of the modulus counts as none.
const STRESS_FREE: f64 = 1e-12;

impl<T: Real, const D: usize> Pair<'_, T, D> {
    /// What contact does to two bodies with these velocities [m/s].
    pub fn change(&self, velocities: [Vector<T, D>; 2]) -> Change<T, D> {
        let change = match (self.rule.law, self.rule.normal) {
            (ContactLaw::None, _) => Change::NONE,
            (ContactLaw::Glued, _) => self.glued(velocities),
            (_, Normal::Own) => self.own_normals(velocities),
            (_, Normal::Common) => self.common_normal(velocities),
        };
        self.scaled(change)
    }

    /// m_1 m_2 / (m_1 + m_2) [kg]
    fn reduced_mass(&self) -> T {
        let [a, b] = self.surfaces;
        let sum = a.inverse_mass + b.inverse_mass;
        if sum > T::ZERO { T::ONE / sum } else { T::ZERO }
    }

    /// Both bodies take their common velocity.
    fn glued(&self, [v, w]: [Vector<T, D>; 2]) -> Change<T, D> {
        self.exchange(T::ZERO, (w - v) * self.reduced_mass(), Vector::ZERO)
    }

    /// Equal and opposite impulses: `normal` along the common normal and `tangential` across it, on the first body [N s].
    fn exchange(&self, normal: T, tangential: Vector<T, D>, n: Vector<T, D>) -> Change<T, D> {
        let impulse = n * normal + tangential;
        Change { impulse: [impulse, -impulse], normal, tangential }
    }

    /// One normal for the pair and one decision.
    ///
    /// ```text
    /// J_n = -m* u . n,   J_t = -m* min(|u_t|, mu max(u . n, 0)) u_t/|u_t|,   u = v_1 - v_2,  m* = m_1 m_2/(m_1 + m_2)
    /// ```
    /// which is eq. (10) of Bardenhagen et al. (2001) for n_2 = -n_1. While compressed bodies depart, the normal impulse gives back
    /// strain energy by pulling, and a pull bears no friction.
    fn common_normal(&self, [v, w]: [Vector<T, D>; 2]) -> Change<T, D> {
        let Some(n) = self.normal else { return Change::NONE };
        let u = v - w;
        let approach = u.dot(n);
        if !self.touching(approach, n) {
            return Change::NONE;
        }
        let slip = u - n * approach;
        let m = self.reduced_mass();
        let tangential = slip * (m * sticking(slip.norm(), self.rule.friction, approach.max(T::ZERO)));
        self.exchange(-m * approach, -tangential, n)
    }

    /// Whether the pair is in contact, decided for both bodies at once.
    fn touching(&self, approach: T, n: Vector<T, D>) -> bool {
        let approaching = approach > T::ZERO;
        match self.rule.law {
            ContactLaw::Kinematic => approaching,
            ContactLaw::Traction => match self.traction(n) {
                Some(traction) => traction < T::ZERO,
                None => approaching,
            },
            ContactLaw::Gap => {
                self.gap <= T::of(TOUCHING) && (approaching || self.traction(n).is_some_and(|t| t < T::ZERO))
            }
            ContactLaw::None | ContactLaw::Glued => false,
        }
    }

    /// n . sigma . n of both bodies together [Pa], eq. (9); `None` where they are stress free.
    fn traction(&self, n: Vector<T, D>) -> Option<T> {
        let [a, b] = self.surfaces;
        let stress = (a.stress * a.volume + b.stress * b.volume) * (T::ONE / (a.volume + b.volume));
        loaded(n.dot(stress.times(n)), a.modulus.min(b.modulus))
    }

    /// Each body by its own normal and its own traction, as the paper prints it, eqs. (5), (8)-(13).
    fn own_normals(&self, velocities: [Vector<T, D>; 2]) -> Change<T, D> {
        let [a, b] = self.surfaces;
        let share = a.inverse_mass + b.inverse_mass;
        let apart = self.rule.law == ContactLaw::Gap && self.gap > T::of(TOUCHING);
        if share <= T::ZERO || apart {
            return Change::NONE;
        }
        // m_2/M = (1/m_1)/(1/m_1 + 1/m_2)
        let center = velocities[1] * (a.inverse_mass / share) + velocities[0] * (b.inverse_mass / share);
        let mut change = Change::NONE;
        for (i, surface) in self.surfaces.into_iter().enumerate() {
            let Some(n) = surface.normal else { continue };
            let dv = velocities[i] - center;
            let approach = dv.dot(n);
            let traction = match self.rule.law {
                ContactLaw::Kinematic => None,
                _ => loaded(n.dot(surface.stress.times(n)), surface.modulus),
            };
            if !traction.map_or(approach > T::ZERO, |t| t < T::ZERO) {
                continue;
            }
            let slip = dv - n * approach;
            let tangential = slip * -sticking(slip.norm(), self.rule.friction, approach.abs());
            if surface.inverse_mass > T::ZERO {
                let mass = T::ONE / surface.inverse_mass;
                change.impulse[i] = (tangential - n * approach) * mass;
                if i == 0 || self.surfaces[0].inverse_mass <= T::ZERO {
                    change.normal = -approach * mass;
                    change.tangential = if i == 0 { tangential * mass } else { -tangential * mass };
                }
            }
        }
        change
    }

    /// The change reduced so that no cell strains by more than the rule allows, eqs. (20)-(22).
    fn scaled(&self, change: Change<T, D>) -> Change<T, D> {
        let largest = (change.impulse.iter().zip(self.surfaces))
            .flat_map(|(impulse, surface)| (*impulse * surface.inverse_mass).0)
            .fold(T::ZERO, |max, x| max.max(x.abs()));
        if largest <= self.limit {
            return change;
        }
        let factor = self.limit / largest;
        Change {
            impulse: change.impulse.map(|j| j * factor),
            normal: change.normal * factor,
            tangential: change.tangential * factor,
        }
    }
}

/// The fraction of the slip that friction stops: min(|slip|, mu |dv_n|)/|slip|.
fn sticking<T: Real>(slip: T, friction: T, normal: T) -> T {
    let bound = friction * normal;
    // An infinite coefficient sticks even without any normal velocity.
    if friction > T::of(1e30) || bound >= slip { T::ONE } else { bound / slip }
}

fn loaded<T: Real>(traction: T, modulus: T) -> Option<T> {
    (traction.abs() > T::of(STRESS_FREE) * modulus).then_some(traction)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surface(mass: f64, normal: [f64; 2]) -> Surface<f64, 2> {
        Surface {
            inverse_mass: 1.0 / mass,
            normal: Some(Vector(normal)),
            stress: Symmetric([0.0, -1.0, 0.0, 0.0, 0.0, 0.0]),
            volume: 1.0,
            modulus: 10.0,
        }
    }

    fn rule(law: ContactLaw, normal: Normal, friction: f64) -> Rule<f64> {
        Rule { law, normal, friction, max_strain: 0.5 }
    }

    /// m = 1, 3; v = (4, -8), 0: v_cm = (1, -2), dv_1 = (3, -6), dv_2 = (-1, 2); n_1 = (0, -1), so dv_n1 = 6, dv_t1 = 3.
    /// mu = 1/4: v~_1 = v_1 - 6 (n_1 + t_1/4) = (4 - 1.5, -8 + 6), eq. (10); n_2 at atan(3/4) from -n_1, so dv_n2 = 1,
    /// dv_t2 = 2, v~_2 = -(n_2 + t_2/4).
    #[test]
    fn own_normals_give_the_papers_equation_10() {
        let rule = rule(ContactLaw::Kinematic, Normal::Own, 0.25);
        let surfaces = [surface(1.0, [0.0, -1.0]), surface(3.0, [0.6, 0.8])];
        let pair = Pair {
            rule: &rule,
            surfaces: [&surfaces[0], &surfaces[1]],
            normal: None,
            gap: 0.0,
            limit: 100.0,
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
                    limit: 100.0,
                };
                pair.change([Vector([4.0, -8.0]), Vector::ZERO])
            });
            for body in 0..2 {
                let difference = (own.impulse[body] - common.impulse[body]).norm();
                assert!(difference < 1e-14, "friction {friction}: {own:?} {common:?}");
            }
        }
    }

    #[test]
    fn surfaces_with_a_gap_do_not_touch_whatever_the_normal() {
        let surfaces = [surface(1.0, [0.0, -1.0]), surface(3.0, [0.0, 1.0])];
        for normal in [Normal::Own, Normal::Common] {
            let rule = rule(ContactLaw::Gap, normal, 0.25);
            let touching = |gap| {
                let normal = Some(Vector([0.0, -1.0]));
                let pair =
                    Pair { rule: &rule, surfaces: [&surfaces[0], &surfaces[1]], normal, gap, limit: 100.0 };
                pair.change([Vector([0.0, -8.0]), Vector::ZERO]) != Change::NONE
            };
            assert!(touching(0.0) && touching(-0.1) && !touching(0.01), "{normal:?}");
        }
    }

    /// The lighter body's velocity changes by 6 m/s; eqs. (20)-(22) allow the limit along an axis, and both bodies get less.
    #[test]
    fn scaling_limits_the_change_and_keeps_the_momentum() {
        let surfaces = [surface(1.0, [0.0, -1.0]), surface(3.0, [0.0, 1.0])];
        for law in [ContactLaw::Kinematic, ContactLaw::Glued] {
            for (limit, factor) in [(100.0, 1.0), (6.0, 1.0), (1.5, 0.25)] {
                let rule = rule(law, Normal::Common, 0.25);
                let normal = Some(Vector([0.0, -1.0]));
                let pair =
                    Pair { rule: &rule, surfaces: [&surfaces[0], &surfaces[1]], normal, gap: 0.0, limit };
                let change = pair.change([Vector([0.0, -8.0]), Vector::ZERO]);
                assert!((change.impulse[0][1] - 6.0 * factor).abs() < 1e-14, "{law:?}, {limit}: {change:?}");
                assert_eq!(change.impulse[0] + change.impulse[1], Vector::ZERO);
            }
        }
    }
}
