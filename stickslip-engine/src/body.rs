//! A body: particles that share a material and move as one.

pub use stickslip_kernels::matter::{Gyration, Matter, Particle};
pub use stickslip_kernels::totals::{TotalSums, Totals, TurningSums};

use crate::Kernels;
use crate::geometry::MirroredShape;
use crate::lanes::Laned;
use crate::particles::Particles;
use crate::rigid::RigidMotion;
use crate::scene::VolumeChange;
use crate::tensor::Real;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

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
    /// What it is made of.
    pub matter: Matter<T>,
    /// Its particles, in the order of memory.
    pub particles: Particles<T, D>,
    /// Its motion and pose if it is rigid: prescribed, whatever pushes it.
    pub motion: Option<Box<RigidMotion>>,
    /// Its undeformed shape with its images in the domain's mirrors.
    pub whole: MirroredShape,
}

impl<T: Real, const D: usize> BodyHere<T, D> {
    /// The same body with other particles, and moved otherwise if it is rigid.
    pub fn like(&self, particles: Particles<T, D>, motion: Option<Box<RigidMotion>>) -> Self {
        BodyHere {
            name: self.name.clone(),
            matter: self.matter.clone(),
            particles,
            motion,
            whole: self.whole.clone(),
        }
    }

    /// Whether its particles take means of dilatation rate and pressure, see [`crate::step`]'s `average.rs`.
    #[inline]
    pub fn averages_volume(&self) -> bool {
        self.matter.volume_change == VolumeChange::Averaged && !self.is_rigid()
    }

    /// Whether it is rigid and moves as prescribed.
    #[inline]
    pub fn is_rigid(&self) -> bool {
        self.motion.is_some()
    }

    /// Whether surfaces may be found by its particles' deformation: of one that deforms its law says so.
    #[inline]
    pub fn trusts_deformation(&self) -> bool {
        self.is_rigid() || self.matter.material.trusts_deformation()
    }
}

/// Sums over its particles.
impl<T: Laned, const D: usize> BodyHere<T, D> {
    /// Mass, momentum and energy.
    pub fn totals(&self, kernels: &Kernels<T, D>) -> Totals {
        self.total_sums(kernels).rounded()
    }

    /// The same before it is rounded.
    pub fn total_sums(&self, kernels: &Kernels<T, D>) -> TotalSums {
        (kernels.total_sums)(&self.matter, &self.particles, self.is_rigid())
    }

    /// Angular velocity: the inverse of the inertia tensor times the angular momentum,
    /// both about the centre of mass [rad/s].
    pub fn spin(&self, kernels: &Kernels<T, D>, totals: &Totals) -> [f64; 3] {
        self.turning_sums(kernels, totals).spin::<D>()
    }

    /// What [`TurningSums::spin_of_points`] needs of these particles of a body with these totals.
    pub fn turning_of_points(&self, kernels: &Kernels<T, D>, totals: &Totals) -> [TurningSums; 2] {
        [Gyration { cell: 0.0, share: 0.0 }, self.matter.gyration()]
            .map(|size| (kernels.turning_sums)(&self.particles, totals, size))
    }

    /// Inertia and angular momentum about the centre of mass of these particles of a body with these totals.
    pub fn turning_sums(&self, kernels: &Kernels<T, D>, totals: &Totals) -> TurningSums {
        (kernels.turning_sums)(&self.particles, totals, self.matter.gyration())
    }
}
