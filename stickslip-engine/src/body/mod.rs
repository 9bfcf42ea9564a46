//! A body: particles that share a material, and what they add up to.

mod totals;

pub use totals::{TotalSums, Totals, TurningSums};

use crate::geometry::MirroredShape;
use crate::material::{Keep, Material, Motion, Recall, Thickness};
use crate::particles::Particles;
use crate::rigid::RigidMotion;
use crate::scene::VolumeChange;
use crate::tensor::{Matrix, Number, Real, Symmetric, Vector};
use std::ops::{Deref, DerefMut};
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

/// A body: what there is of it here. Where ranks share a simulation, one of which nothing is here is no more than a
/// reference to what all bodies of its kind have in common: it deforms, and has neither particles nor a name, and an
/// empty shape.
#[derive(Clone, Debug)]
pub enum Body<T, const D: usize> {
    /// With all that belongs to it.
    Here(Box<BodyHere<T, D>>),
    /// Without.
    Elsewhere(Arc<BodyHere<T, D>>),
}

impl<T, const D: usize> Deref for Body<T, D> {
    type Target = BodyHere<T, D>;

    #[inline(always)]
    fn deref(&self) -> &BodyHere<T, D> {
        match self {
            Body::Here(body) => body,
            Body::Elsewhere(kind) => kind,
        }
    }
}

impl<T, const D: usize> DerefMut for Body<T, D> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut BodyHere<T, D> {
        self.here_mut().expect("it is here")
    }
}

impl<T, const D: usize> From<BodyHere<T, D>> for Body<T, D> {
    fn from(body: BodyHere<T, D>) -> Self {
        Body::Here(Box::new(body))
    }
}

impl<T, const D: usize> Body<T, D> {
    /// It, if something of it is here.
    #[inline(always)]
    pub fn here_mut(&mut self) -> Option<&mut BodyHere<T, D>> {
        match self {
            Body::Here(body) => Some(body),
            Body::Elsewhere(_) => None,
        }
    }
}

/// Particles that share a material and move as one body.
#[derive(Clone, Debug)]
pub struct BodyHere<T, const D: usize> {
    /// Name in the scene.
    pub name: String,
    /// Constitutive law, one for all bodies of a material.
    pub material: Arc<Material<T>>,
    /// Mass per undeformed volume [kg/m^3].
    pub density: T,
    /// Expansion by temperature [1/K].
    pub expansion: T,
    /// Its particles, in the order of memory.
    pub particles: Particles<T, D>,
    /// Its motion and pose if it is rigid: prescribed, whatever pushes it.
    pub motion: Option<Box<RigidMotion>>,
    /// Its undeformed shape with its images in the domain's mirrors.
    pub whole: MirroredShape,
    /// Which thickness its particles take.
    pub thickness: Thickness,
    /// What its particles' own rotation weighs.
    pub gyration: Gyration<T>,
    /// Whose change of volume its particles take.
    pub volume_change: VolumeChange,
}

impl<T: Real, const D: usize> BodyHere<T, D> {
    /// The same body with other particles, and moved otherwise if it is rigid.
    pub fn like(&self, particles: Particles<T, D>, motion: Option<Box<RigidMotion>>) -> Self {
        BodyHere {
            name: self.name.clone(),
            material: self.material.clone(),
            density: self.density,
            expansion: self.expansion,
            particles,
            motion,
            whole: self.whole.clone(),
            thickness: self.thickness,
            gyration: self.gyration,
            volume_change: self.volume_change,
        }
    }

    /// Kinetic energy of a particle, m (v^2 + k^2 w^2)/2 [J].
    #[inline]
    pub fn kinetic(&self, particle: &Particle<T, D>) -> T {
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
    pub fn wave_modulus(&self, particle: &Particle<T, D>, history: &impl Recall<T>) -> T {
        let f = &particle.deformation;
        self.material.wave_modulus(self.thickness, (f, f.det()), history)
    }

    /// Whether its particles take means of dilatation rate and pressure, see [`crate::step`]'s `average.rs`.
    #[inline]
    pub fn averages_volume(&self) -> bool {
        self.volume_change == VolumeChange::Averaged && !self.is_rigid()
    }

    /// Whether it is rigid and moves as prescribed.
    #[inline]
    pub fn is_rigid(&self) -> bool {
        self.motion.is_some()
    }

    /// Whether surfaces may be found by its particles' deformation: of one that deforms its law says so.
    #[inline]
    pub fn trusts_deformation(&self) -> bool {
        self.is_rigid() || self.material.trusts_deformation()
    }
}
