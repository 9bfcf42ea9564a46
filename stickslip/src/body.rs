//! A body: particles that share a material, and what they add up to.

use crate::geometry::Whole;
use crate::material::{Material, Motion, Thickness};
use crate::particles::Particles;
use crate::tensor::{Matrix, Real, Symmetric, Vector, cross};

/// A material point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle<T, const D: usize> {
    /// Position [m].
    pub position: Vector<T, D>,
    /// Velocity [m/s].
    pub velocity: Vector<T, D>,
    /// Mass [kg].
    pub mass: T,
    /// Undeformed volume [m^3]; in the plane per metre of undeformed thickness.
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
    /// The room that it takes on the grid: its volume now, in the plane its area [m^D].
    pub fn room(&self) -> T {
        let f = &self.deformation.0;
        let stretch = if D == 2 { f[0][0] * f[1][1] - f[0][1] * f[1][0] } else { self.deformation.det() };
        self.volume * stretch
    }
}

/// Particles that share a material and move as one body.
#[derive(Clone, Debug)]
pub struct Body<T, const D: usize> {
    /// Name in the scene.
    pub name: String,
    /// Constitutive law.
    pub material: Material<T>,
    /// Mass per undeformed volume [kg/m^3].
    pub density: T,
    /// Its particles, in the order of memory.
    pub particles: Particles<T, D>,
    /// Whether its motion is prescribed, whatever pushes it.
    pub rigid: bool,
    /// Its undeformed shape with its images in the domain's mirrors.
    pub whole: Whole,
    /// Which thickness its particles take.
    pub thickness: Thickness,
}

/// Sums over the particles of one body, in `f64` and SI units whatever the precision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Totals {
    /// sum m [kg]
    pub mass: f64,
    /// sum m x [kg m]
    pub first_moment: [f64; 3],
    /// sum m v [kg m/s]
    pub momentum: [f64; 3],
    /// sum m x cross v, about the origin [kg m^2/s]
    pub angular_momentum: [f64; 3],
    /// sum m v^2 / 2 [J]
    pub kinetic: f64,
    /// sum V W [J]
    pub strain: f64,
}

impl<T: Real, const D: usize> Body<T, D> {
    /// Mass, momentum and energy, summed in the order of memory.
    pub fn totals(&self) -> Totals {
        let mut totals = Totals::default();
        let law = self.material.law();
        for particle in self.particles.iter() {
            let (m, x, v) = (particle.mass.f64(), particle.position.space(), particle.velocity.space());
            let l = cross(x, v);
            totals.mass += m;
            for i in 0..3 {
                totals.first_moment[i] += m * x[i];
                totals.momentum[i] += m * v[i];
                totals.angular_momentum[i] += m * l[i];
                totals.kinetic += 0.5 * m * v[i] * v[i];
            }
            // A particle that turned inside out has stopped the run and has no energy.
            if !self.rigid && particle.deformation.det() > T::ZERO {
                let energy = law.strain_energy(&particle.deformation, &particle.stress);
                totals.strain += particle.volume.f64() * energy.f64();
            }
        }
        totals
    }

    /// A particle's motion with the thickness that it takes, and its Cauchy stress after it [Pa]; `None` if no thickness is free of stress.
    #[inline]
    pub fn respond(&self, motion: Motion<T>) -> Option<(Motion<T>, Symmetric<T>)> {
        self.material.respond(self.thickness, motion)
    }

    /// Stiffness against the fastest wave in a state of deformation, times J [Pa].
    #[inline]
    pub fn wave_modulus(&self, deformation: &Matrix<T>, jacobian: T) -> T {
        self.material.wave_modulus(self.thickness, deformation, jacobian)
    }

    /// Angular velocity: the inverse of the inertia tensor times the angular momentum, both about the centre of mass [rad/s].
    pub fn spin(&self, totals: &Totals) -> [f64; 3] {
        let center = totals.first_moment.map(|x| x / totals.mass);
        let mean = totals.momentum.map(|p| p / totals.mass);
        let mut inertia = Matrix::<f64>::ZERO;
        let mut angular = [0.0; 3];
        for particle in self.particles.iter() {
            let m = particle.mass.f64();
            let (x, v) = (particle.position.space(), particle.velocity.space());
            let r: [f64; 3] = std::array::from_fn(|i| x[i] - center[i]);
            let l = cross(r, std::array::from_fn(|i| v[i] - mean[i]));
            let square = r.iter().map(|a| a * a).sum::<f64>();
            for i in 0..3 {
                angular[i] += m * l[i];
                for j in 0..3 {
                    inertia.0[i][j] += m * (f64::from(u8::from(i == j)) * square - r[i] * r[j]);
                }
            }
        }
        if D == 2 {
            return [0.0, 0.0, angular[2] / inertia.0[2][2]];
        }
        let inverse = inertia.inverse();
        std::array::from_fn(|i| (0..3).map(|j| inverse.0[i][j] * angular[j]).sum())
    }
}
