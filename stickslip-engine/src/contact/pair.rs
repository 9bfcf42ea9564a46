//! Two bodies at a node: what is known of them there, and what contact may do to them.

use super::law::law;
use super::{ReferenceMap, Rule, Span, SurfaceLoad};
use crate::scene::ContactLaw;
use crate::tensor::{Real, Symmetric, Vector};

/// What the particles around a node say of one body's surface there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceEstimate<T, const D: usize> {
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
    /// Force of the body's stress on the node, -sum V sigma grad S, before this step's strain [N].
    pub force: Vector<T, D>,
    /// Where the material around the node was before it deformed.
    pub place: ReferenceMap<T, D>,
}

impl<T: Real, const D: usize> SurfaceEstimate<T, D> {
    /// Whether it is a rigid body's, which no impulse moves.
    #[inline]
    pub fn is_rigid(&self) -> bool {
        self.inverse_mass <= T::ZERO
    }
}

/// What the velocities of a pair are about to be used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactUse {
    /// As what forces and later contact change: interpolated velocities that strain nothing (USL, MUSL).
    Start,
    /// To strain the particles, and to displace them by the same (USF: interpolated, MUSL: interpolated once more).
    Strain,
    /// To change the particles' velocities: integrated with all forces of the step. In USL they also strain.
    VelocityChange,
}

/// A step of time, as contact needs it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeStep<T> {
    /// dt [s]
    pub duration: T,
    /// Side of a cell [m].
    pub cell: T,
    /// What the velocities are for.
    pub purpose: ContactUse,
}

impl<T: Real> TimeStep<T> {
    /// Speed of one cell in this step: h/dt [m/s].
    pub fn cell_speed(&self) -> T {
        self.cell / self.duration
    }
}

/// Two bodies at a node.
#[derive(Clone, Copy, Debug)]
pub struct Pair<'a, T, const D: usize> {
    /// The rule that holds between them.
    pub rule: &'a Rule<T>,
    /// Their surfaces.
    pub surfaces: [&'a SurfaceEstimate<T, D>; 2],
    /// Common normal from the first to the second, from the difference of their volume gradients [-].
    pub normal: Option<Vector<T, D>>,
    /// Distance between the surfaces at the node, negative where they overlap [cells].
    pub gap: T,
    /// The node's share of the contact area [m^2], in the plane per depth [m].
    pub area: T,
    /// The part of an overlap that the step takes away, of an interference fit that is being pressed; else 0 [-].
    pub recovery: T,
    /// The step.
    pub step: TimeStep<T>,
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
    /// What is left of the impulse that the law asked for, as the rule's largest strain allows [-].
    pub scale: T,
}

impl<T: Real, const D: usize> Change<T, D> {
    /// No contact.
    pub const NONE: Self =
        Change { impulse: [Vector::ZERO; 2], normal: T::ZERO, tangential: Vector::ZERO, scale: T::ONE };

    /// Whether it gives an impulse to either body.
    pub fn pushes(&self) -> bool {
        self.impulse.iter().any(|impulse| *impulse != Vector::ZERO)
    }
}

impl<T: Real, const D: usize> Pair<'_, T, D> {
    /// What contact does to two bodies with these velocities [m/s], by the rule's law and scaled.
    pub fn change(&self, velocities: [Vector<T, D>; 2]) -> Change<T, D> {
        let law = law(self.rule.law);
        let change = law.change(self, velocities);
        // Over a whole step an impulse mostly takes back what forces did to a node of little mass:
        // that strains nothing.
        let strains = law.span() == Span::EachUse || self.step.purpose == ContactUse::Strain;
        if strains { self.scaled(change) } else { change }
    }

    /// Speed at which surfaces that have grown into each other part in this step; 0 of others [m/s].
    pub fn growth_speed(&self) -> T {
        (-self.gap).max(T::ZERO) * self.recovery * self.step.cell_speed()
    }

    /// m_1 m_2 / (m_1 + m_2) [kg]
    pub fn reduced_mass(&self) -> T {
        let [a, b] = self.surfaces;
        let sum = a.inverse_mass + b.inverse_mass;
        if sum > T::ZERO { T::ONE / sum } else { T::ZERO }
    }

    /// How the pair is loaded by a normal impulse that presses it together [N s].
    pub fn load(&self, push: T) -> SurfaceLoad<T> {
        SurfaceLoad { mass: self.reduced_mass(), push, exposure: self.area * self.step.duration }
    }

    /// Equal and opposite impulses: `normal` along the common normal `n` and `tangential` across it,
    /// on the first body [N s].
    pub fn exchange(&self, normal: T, tangential: Vector<T, D>, n: Vector<T, D>) -> Change<T, D> {
        let impulse = n * normal + tangential;
        Change { impulse: [impulse, -impulse], normal, tangential, scale: T::ONE }
    }

    /// The change reduced so that no cell strains by more than the rule allows, eqs. (20)-(22). Deformable bodies that
    /// are glued are one body, whose cells strain as they do: there is nothing to reduce,
    /// and a part with little mass must follow.
    fn scaled(&self, change: Change<T, D>) -> Change<T, D> {
        let largest = (change.impulse.iter().zip(self.surfaces))
            .flat_map(|(impulse, surface)| (*impulse * surface.inverse_mass).0)
            .fold(T::ZERO, |max, x| max.max(x.abs()));
        // gamma h/dt
        let limit = self.rule.max_strain * self.step.cell_speed();
        let one_body =
            self.rule.law == ContactLaw::Glued && self.surfaces.iter().all(|side| !side.is_rigid());
        if largest <= limit || one_body {
            return change;
        }
        let factor = limit / largest;
        Change {
            impulse: change.impulse.map(|j| j * factor),
            normal: change.normal * factor,
            tangential: change.tangential * factor,
            scale: factor,
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::contact::Friction;
    use crate::scene::Normal;

    pub fn surface(mass: f64, normal: [f64; 2]) -> SurfaceEstimate<f64, 2> {
        SurfaceEstimate {
            inverse_mass: 1.0 / mass,
            normal: Some(Vector(normal)),
            stress: Symmetric([0.0, -1.0, 0.0, 0.0, 0.0, 0.0]),
            volume: 1.0,
            modulus: 10.0,
            force: Vector::ZERO,
            place: ReferenceMap::EMPTY,
        }
    }

    /// A step in which contact may change velocities by `limit` [m/s] under [`rule`].
    pub fn step(limit: f64) -> TimeStep<f64> {
        TimeStep { duration: 1.0, cell: 2.0 * limit, purpose: ContactUse::VelocityChange }
    }

    pub fn rule(law: ContactLaw, normal: Normal, friction: f64) -> Rule<f64> {
        Rule {
            law,
            normal,
            friction: Friction::coulomb(friction),
            max_strain: 0.5,
            restitution: 0.0,
            friction_memory: None,
            press: None,
        }
    }

    /// The lighter body's velocity changes by 6 m/s; eqs. (20)-(22) allow the limit along an axis,
    /// and both bodies get less.
    #[test]
    fn scaling_limits_the_change_and_keeps_the_momentum() {
        let surfaces = [surface(1.0, [0.0, -1.0]), surface(3.0, [0.0, 1.0])];
        for law in [ContactLaw::Kinematic, ContactLaw::Traction] {
            for (limit, factor) in [(100.0, 1.0), (6.0, 1.0), (1.5, 0.25)] {
                let rule = rule(law, Normal::Common, 0.25);
                let normal = Some(Vector([0.0, -1.0]));
                let pair = Pair {
                    rule: &rule,
                    surfaces: [&surfaces[0], &surfaces[1]],
                    normal,
                    gap: 0.0,
                    area: 0.0,
                    recovery: 0.0,
                    step: step(limit),
                };
                let change = pair.change([Vector([0.0, -8.0]), Vector::ZERO]);
                assert!((change.impulse[0][1] - 6.0 * factor).abs() < 1e-14, "{law:?}, {limit}: {change:?}");
                assert_eq!(change.impulse[0] + change.impulse[1], Vector::ZERO);
            }
        }
    }
}
