//! What two surfaces bear across and along their normal beside pushing: friction, cohesion, viscosity, adhesion.
//!
//! ```text
//! mu(s)   = mu_k + (mu_s - mu_k) exp(-s / s_c)        velocity weakening; s_c = 0: mu_k as soon as they slip
//! stick:    m* s <= mu_s J_n + c A dt
//! slip:     J_t   = mu(s) J_n + c A dt + eta A dt s'   towards rest, s' = s - J_t / m*
//! pull:     J_n  >= - a A dt                           while the gap is below 1 % of a cell
//! ```
//! s, s': speed of slip before and after [m/s]; m*: reduced mass [kg]; J_n: push [N s]; A: contact area of the node
//! [m^2]. Coulomb's law is mu_s = mu_k and nothing else. Static and kinetic coefficients with an exponential between
//! them are those of Oden and Martins (1985), Comput. Methods Appl. Mech. Eng. 52, 527-634.
//!
//! The tangential history of sticking nodes is the deformation of the bodies themselves: a node sticks until its load
//! exceeds the bound, so partial slip (Cattaneo 1938, Mindlin 1949) needs no spring of its own.

use super::Pair;
use crate::scene::ContactRule;
use crate::tensor::Real;
use stickslip_scene::friction::coefficient;

/// Resistance of a pair of surfaces against slip and against parting.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Friction<T> {
    /// mu_s: coefficient of friction until they slip; infinity sticks [-].
    pub at_rest: T,
    /// mu_k: coefficient of friction at high speeds of slip [-].
    pub kinetic: T,
    /// s_c: speed of slip over which the coefficient falls from one to the other [m/s].
    pub decay_speed: T,
    /// c: shear strength of the contact without any push [Pa].
    pub cohesion: T,
    /// a: tensile strength of the contact [Pa].
    pub adhesion: T,
    /// eta: shear traction over speed of slip [Pa s/m].
    pub viscosity: T,
}

/// Gap over which surfaces that adhere hold each other [cells].
const BOND: f64 = 0.01;

/// How two surfaces are loaded at a node in one use of contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceLoad<T> {
    /// Reduced mass [kg].
    pub mass: T,
    /// Normal impulse that presses them together, not negative [N s].
    pub push: T,
    /// Contact area of the node times the duration of the step [m^2 s].
    pub exposure: T,
}

impl<T: Real> Friction<T> {
    /// Coulomb's law with one coefficient.
    pub fn coulomb(coefficient: T) -> Self {
        Friction { at_rest: coefficient, kinetic: coefficient, ..Friction::default() }
    }

    /// The same in double precision.
    pub fn double(&self) -> Friction<f64> {
        Friction {
            at_rest: self.at_rest.f64(),
            kinetic: self.kinetic.f64(),
            decay_speed: self.decay_speed.f64(),
            cohesion: self.cohesion.f64(),
            adhesion: self.adhesion.f64(),
            viscosity: self.viscosity.f64(),
        }
    }

    /// Whether surfaces that touch resist slip or parting by their area.
    pub fn bonds(&self) -> bool {
        [self.cohesion, self.adhesion, self.viscosity].iter().any(|x| *x > T::ZERO)
    }

    /// mu(s) [-]
    pub fn coefficient(&self, slip: T) -> T {
        coefficient([self.at_rest, self.kinetic], self.decay_speed, slip)
    }

    /// The fraction of the slip `slip` [m/s] that the surfaces stop under a load: 1 where they stick [-].
    pub fn stopped(&self, slip: T, load: SurfaceLoad<T>) -> T {
        let momentum = load.mass * slip;
        let cohesion = self.cohesion * load.exposure;
        // An infinite coefficient sticks even without any push.
        if !self.at_rest.is_finite() || momentum <= self.at_rest * load.push + cohesion {
            return T::ONE;
        }
        // What opposes the slip over what would stop it; not one minus what is left of it,
        // which is round-off where the push is small.
        let viscous = self.viscosity * load.exposure;
        let opposed = self.coefficient(slip) * load.push + cohesion + viscous * slip;
        (opposed / (slip * (load.mass + viscous))).min(T::ONE)
    }

    /// The normal impulse that the surfaces bear where `wanted` keeps them together, and how they are loaded by it;
    /// `None` where they part. Positive pushes [N s]. Surfaces that touch and resist slip without a push bear none.
    pub fn borne<const D: usize>(&self, wanted: T, pair: &Pair<T, D>) -> Option<(T, SurfaceLoad<T>)> {
        let load = pair.load(wanted.max(T::ZERO));
        let touch = pair.gap <= T::of(BOND);
        let pull = if touch { self.adhesion * load.exposure } else { T::ZERO };
        let resist = touch && (self.cohesion > T::ZERO || self.viscosity > T::ZERO);
        let borne = wanted.max(-pull);
        (wanted > T::ZERO || pull > T::ZERO || resist).then_some((borne, load))
    }
}

impl<T: Real> From<&ContactRule> for Friction<T> {
    fn from(rule: &ContactRule) -> Self {
        Friction {
            at_rest: T::of(rule.friction),
            kinetic: T::of(rule.kinetic_friction),
            decay_speed: T::of(rule.friction_decay_speed),
            cohesion: T::of(rule.cohesion),
            adhesion: T::of(rule.adhesion),
            viscosity: T::of(rule.viscosity),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOAD: SurfaceLoad<f64> = SurfaceLoad { mass: 2.0, push: 3.0, exposure: 0.1 };

    #[test]
    fn coulomb_stops_what_the_push_bears() {
        let friction = Friction::coulomb(0.5);
        // mu J_n = 1.5 stops 0.75 m/s of 2 kg.
        for (slip, stopped) in [(0.5, 1.0), (0.75, 1.0), (1.5, 0.5), (7.5, 0.1)] {
            assert!((friction.stopped(slip, LOAD) - stopped).abs() < 1e-15, "{slip}");
        }
        assert_eq!(Friction::coulomb(f64::INFINITY).stopped(1e9, SurfaceLoad { push: 0.0, ..LOAD }), 1.0);
        assert_eq!(Friction::coulomb(0.5).stopped(1.0, SurfaceLoad { push: 0.0, ..LOAD }), 0.0);
    }

    #[test]
    fn friction_falls_from_static_to_kinetic_with_the_slip() {
        let friction = Friction { at_rest: 0.8, kinetic: 0.2, decay_speed: 0.5, ..Friction::default() };
        assert_eq!(friction.coefficient(0.0), 0.8);
        assert!((friction.coefficient(0.5) - (0.2 + 0.6 / std::f64::consts::E)).abs() < 1e-15);
        assert!((friction.coefficient(50.0) - 0.2).abs() < 1e-15);
        // 0.8 x 3 N s hold 1.2 m/s; once they slip at once by 0.2 x 3 N s only.
        let brittle = Friction { decay_speed: 0.0, ..friction };
        assert_eq!(brittle.stopped(1.2, LOAD), 1.0);
        assert!((brittle.stopped(1.5, LOAD) - 0.6 / 3.0).abs() < 1e-15);
    }

    #[test]
    fn cohesion_bears_shear_without_a_push() {
        let friction = Friction { cohesion: 10.0, ..Friction::default() };
        let load = SurfaceLoad { push: 0.0, ..LOAD };
        assert_eq!(friction.stopped(0.5, load), 1.0);
        assert!((friction.stopped(2.0, load) - 0.25).abs() < 1e-15);
    }

    /// J_t = eta A dt s' with s' = s - J_t/m: s' = s m/(m + eta A dt), however viscous.
    #[test]
    fn viscosity_slows_without_turning_the_slip_back() {
        let load = SurfaceLoad { push: 0.0, ..LOAD };
        for (viscosity, kept) in [(20.0, 0.5), (1e12, 2.0 / 1e11)] {
            let friction = Friction { viscosity, ..Friction::default() };
            let after = 1.0 - friction.stopped(3.0, load);
            assert!((after / kept - 1.0).abs() < 1e-3, "{viscosity}: {after}");
        }
    }
}
