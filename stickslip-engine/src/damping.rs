//! Damping: of the nodes' velocities by a viscous force and by Cundall's local damping, and of the particles by bulk
//! viscosity.
//!
//! The first two act on the velocity v~ with which a body leaves the forces, walls and contacts of a step that it began
//! with v^0. Contact forces so belong to the unbalanced force, and bodies that rest on each other are left alone.

use crate::column::{BULK_VISCOSITY, Kind};
use crate::grid::Node;
use crate::material::History;
use crate::scene;
use crate::tensor::{Real, Vector};
pub use stickslip_kernels::viscosity::BulkViscosity;

/// Damping at the nodes of deformable bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeDamping<T> {
    /// alpha [1/s]
    viscous: T,
    /// lambda, from 0 to below 1 [-]
    local: T,
}

impl<T: Real> NodeDamping<T> {
    /// What a scene asks for.
    pub fn new(scene: &scene::Damping) -> Self {
        NodeDamping { viscous: T::of(scene.viscous), local: T::of(scene.local) }
    }

    /// With another rate of the viscous one beside its own [1/s].
    pub fn with_viscous(self, rate: T) -> Self {
        NodeDamping { viscous: self.viscous + rate, ..self }
    }

    /// The same in double precision.
    pub fn double(&self) -> NodeDamping<f64> {
        NodeDamping { viscous: self.viscous.f64(), local: self.local.f64() }
    }

    /// Whether it does anything.
    pub fn acts(&self) -> bool {
        self.viscous > T::ZERO || self.local > T::ZERO
    }

    /// Damps the integrated velocity of a node, whose change the particles take, and says by which impulse [N s].
    pub fn act<const D: usize>(&self, node: &mut Node<T, D>, impulse: &mut Vector<T, D>, dt: T) {
        let damped = self.damped(node.integrated, node.start, dt);
        *impulse = (damped - node.integrated) * node.mass;
        node.integrated = damped;
    }

    /// The velocity that damping leaves a node, component by component [m/s].
    ///
    /// ```text
    /// local:    w = sign(v~) max(|v~| - lambda |v~ - v^0|, 0)        f_d = -lambda |f| sign(w),  f = m (v~ - v^0) / dt
    /// viscous:  v = w / (1 + alpha dt)                               f = -alpha m v
    /// ```
    /// Cundall (1987), Analytical and Computational Methods in Engineering Rock Mechanics, chapter 4, for the first;
    /// the second is proportional damping by mass (Rayleigh). Both are implicit: they take the velocity after the step,
    /// so no alpha dt is unstable and local damping never turns a velocity around.
    #[inline]
    pub fn damped<const D: usize>(&self, velocity: Vector<T, D>, start: Vector<T, D>, dt: T) -> Vector<T, D> {
        let share = T::ONE / (T::ONE + self.viscous * dt);
        Vector::from_fn(|i| {
            let against = self.local * (velocity[i] - start[i]).abs();
            let left = (velocity[i].abs() - against).max(T::ZERO) * share;
            if velocity[i] < T::ZERO { -left } else { left }
        })
    }
}

/// The columns that particles have for bulk viscosity: its pressure, with which the next forces are made, if a scene
/// asks for it.
pub fn viscosity_columns(scene: &scene::Damping) -> &'static [History] {
    const PRESSURE: &[History] = &[History::new(BULK_VISCOSITY, "Pa", Kind::Number)];
    if scene.bulk == [0.0; 2] { &[] } else { PRESSURE }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn damping(viscous: f64, local: f64) -> NodeDamping<f64> {
        NodeDamping::new(&scene::Damping { viscous, local, ..Default::default() })
    }

    #[test]
    fn viscous_damping_is_stable_for_any_rate_and_falls_at_the_speed_that_balances_it() {
        let (alpha, dt, g) = (1e6, 1e-3, 9.81);
        let mut v = Vector([5.0]);
        for _ in 0..100 {
            v = damping(alpha, 0.0).damped(v + Vector([g * dt]), v, dt);
        }
        assert!((v[0] - g / alpha).abs() < 1e-12 * g / alpha, "{v:?}");
    }

    #[test]
    fn local_damping_is_a_part_of_the_unbalanced_force_against_the_motion() {
        let act = |velocity, start| damping(0.0, 0.8).damped(Vector([velocity]), Vector([start]), 1e-3)[0];
        assert_eq!(act(1.0, 1.0), 1.0, "no force");
        assert!((act(1.5, 1.0) - 1.1_f64).abs() < 1e-15, "faster by a fifth of it");
        assert!((act(-1.0, -1.5) + 0.6_f64).abs() < 1e-15, "slower by nine fifths");
        assert_eq!(act(0.1, 1.0), 0.0, "to rest, and no further");
        assert_eq!(act(0.0, -2.0), 0.0, "what a wall stopped stays");
    }
}
