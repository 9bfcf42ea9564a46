//! Particles, and what a body of them is made of.

use crate::material::{Keep, Material, Motion, Recall, Thickness};
use crate::scheme::VolumeChange;
use crate::tensor::{Matrix, Number, Real, Symmetric, Vector};
use std::sync::Arc;

/// A material point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle<T, const D: usize> {
    /// Position [m].
    pub position: Vector<T, D>,
    /// Velocity [m/s].
    pub velocity: Vector<T, D>,
    /// Angular velocity, see [`crate::transfer::rotation`]; in the plane about the third axis [rad/s].
    pub spin: Vector<T, 3>,
    /// Mass [kg].
    pub mass: T,
    /// Volume, J times the undeformed one [m^3]; in the plane per metre of undeformed thickness.
    pub volume: T,
    /// Half the side of its undeformed box [m].
    pub half_width: T,
    /// Deformation gradient F, embedded in space; in the plane F_zz is the thickness over the undeformed one [-].
    pub deformation: Matrix<T>,
    /// Cauchy stress, tension positive [Pa].
    pub stress: Symmetric<T>,
    /// Its number in its body, from the filling.
    pub number: u32,
}

impl<T: Real, const D: usize> Particle<T, D> {
    /// The room that it takes on the grid: its volume, in the plane its area [m^D].
    pub fn room(&self) -> T {
        if D == 2 { self.volume / self.deformation.0[2][2] } else { self.volume }
    }
}

/// Square of the radius of gyration of a particle about each axis, a constant of it.
///
/// ```text
/// k^2 = cell + share l^2          l: half the side of the undeformed box
/// ```
/// See [`crate::transfer::rotation`] for its source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gyration<T> {
    /// Of all particles alike [m^2].
    pub cell: T,
    /// What the particle's own box adds [-].
    pub share: T,
}

impl<N: Number> Gyration<N> {
    /// k^2 of a particle with this half-width [m^2].
    #[inline(always)]
    pub fn squared(&self, half_width: N) -> N {
        self.share.times_plus(half_width * half_width, self.cell)
    }
}

/// What a body is made of.
#[derive(Clone, Debug)]
pub struct Matter<T> {
    /// Constitutive law, one for all bodies of a material.
    pub material: Arc<Material<T>>,
    /// Mass per undeformed volume [kg/m^3].
    pub density: T,
    /// Expansion by temperature [1/K].
    pub expansion: T,
    /// Which thickness its particles take.
    pub thickness: Thickness,
    /// What its particles' own rotation weighs.
    pub gyration: Gyration<T>,
    /// Whose change of volume its particles take.
    pub volume_change: VolumeChange,
}

impl<T: Real> Matter<T> {
    /// Kinetic energy of a particle, m (v^2 + k^2 w^2)/2 [J].
    #[inline]
    pub fn kinetic<const D: usize>(&self, particle: &Particle<T, D>) -> T {
        let Particle { velocity, spin, half_width, .. } = *particle;
        let turning = self.gyration.squared(half_width) * spin.dot(spin);
        T::HALF * particle.mass * (velocity.dot(velocity) + turning)
    }

    /// A particle's motion with the thickness that it takes, and the stress after it;
    /// `None` if no thickness is free of stress.
    #[inline]
    pub fn respond(
        &self,
        motion: Motion<T>,
        history: &mut impl Keep<T>,
    ) -> Option<(Motion<T>, Symmetric<T>)> {
        self.material.respond_with(self.thickness, motion, history)
    }

    /// Stiffness against the fastest wave in the present state of a particle, times J [Pa].
    #[inline]
    pub fn wave_modulus<const D: usize>(&self, particle: &Particle<T, D>, history: &impl Recall<T>) -> T {
        let f = &particle.deformation;
        self.material.wave_modulus(self.thickness, (f, f.det()), history)
    }

    /// How large its particles are against turning.
    pub fn gyration(&self) -> Gyration<f64> {
        Gyration { cell: self.gyration.cell.f64(), share: self.gyration.share.f64() }
    }
}
