//! From a scene to a simulation.

use super::Engine;
use super::rigid::RigidMotion;
use super::watch::Watch;
use crate::basis::{Basis, Gimp, Linear};
use crate::body::{Body, Particle};
use crate::boundary::{Boundary, Wall};
use crate::contact::{Rules, Survey, Tally};
use crate::door::Simulation;
use crate::grid::{Cover, Field, Lattice};
use crate::scene::{BasisKind, Dimension, Face, Motion, Precision, Problem, Scene};
use crate::tensor::{Matrix, Real, Symmetric, Vector, cross};
use std::marker::PhantomData;

/// The simulation of a scene.
///
/// # Errors
/// A body that cannot be filled with particles.
pub fn build(scene: &Scene) -> Result<Box<dyn Simulation>, Problem> {
    match (scene.dimension, scene.precision) {
        (Dimension::PlaneStrain, Precision::Double) => with_basis::<f64, 2>(scene),
        (Dimension::PlaneStrain, Precision::Single) => with_basis::<f32, 2>(scene),
        (Dimension::Space, Precision::Double) => with_basis::<f64, 3>(scene),
        (Dimension::Space, Precision::Single) => with_basis::<f32, 3>(scene),
    }
}

fn with_basis<T: Real, const D: usize>(scene: &Scene) -> Result<Box<dyn Simulation>, Problem> {
    Ok(match scene.discretization.basis {
        BasisKind::Linear => Box::new(Engine::<T, D, Linear>::new(scene)?),
        BasisKind::Gimp => Box::new(Engine::<T, D, Gimp>::new(scene)?),
    })
}

impl<T: Real, const D: usize, B: Basis<T>> Engine<T, D, B> {
    /// The simulation of a scene of this dimension and precision.
    ///
    /// # Errors
    /// A body that cannot be filled with particles.
    pub fn new(scene: &Scene) -> Result<Self, Problem> {
        let cell = scene.discretization.cell;
        let origin = scene.domain.as_ref().map_or([0.0; 3], |domain| domain.min);
        let lattice = Lattice { origin: Vector::of(origin), cell: T::of(cell) };
        let mut bodies = Vec::new();
        let mut rigid = Vec::new();
        for (i, request) in scene.bodies.iter().enumerate() {
            let material = &scene.materials[request.material];
            let (positions, volume, half_width) = fill(scene, i)?;
            let center = mean(&positions);
            rigid.push(match &request.motion {
                Motion::Free { .. } => None,
                Motion::Rigid { velocity, spin } => {
                    Some(RigidMotion::new(center, velocity.clone(), spin.clone()))
                }
            });
            let velocity = |x: [f64; 3]| match &request.motion {
                Motion::Free { velocity, spin } => {
                    let turn = cross(*spin, std::array::from_fn(|i| x[i] - center[i]));
                    std::array::from_fn(|i| velocity[i] + turn[i])
                }
                Motion::Rigid { .. } => rigid[i].as_ref().map_or([0.0; 3], |motion| motion.velocity_at(x)),
            };
            let particle = |(number, &x): (usize, &[f64; 3])| Particle {
                position: Vector::of(x),
                velocity: Vector::of(velocity(x)),
                mass: T::of(volume * material.density),
                volume: T::of(volume),
                half_width: T::of(half_width),
                deformation: Matrix::IDENTITY,
                stress: Symmetric::ZERO,
                number: number as u32,
            };
            bodies.push(Body {
                name: request.name.clone(),
                material: material.law.cast(),
                density: T::of(material.density),
                particles: positions.iter().enumerate().map(particle).collect(),
                rigid: rigid[i].is_some(),
            });
        }
        Ok(Engine {
            bodies,
            rigid,
            lattice,
            domain: scene.domain.as_ref().map(|domain| [domain.min, domain.max].map(Vector::of)),
            gravity: Vector::of(scene.gravity),
            pic_share: T::of(scene.time.pic_share),
            rules: Rules::new(scene),
            boundary: Boundary::new(walls::<D>(scene)),
            clock: scene.time.clone(),
            cover: Cover::default(),
            field: Field { nodes: Vec::new() },
            survey: Survey::default(),
            tally: Tally::default(),
            time: 0.0,
            steps: 0,
            watch: Watch::default(),
            basis: PhantomData,
        })
    }
}

/// The domain's faces that do something.
fn walls<const D: usize>(scene: &Scene) -> Vec<Wall> {
    let Some(domain) = &scene.domain else { return Vec::new() };
    let mut walls = Vec::new();
    for axis in 0..D {
        let upper = ((domain.max[axis] - domain.min[axis]) / scene.discretization.cell).round() as i32;
        for (face, node, inward) in [(domain.faces[axis][0], 0, 1), (domain.faces[axis][1], upper, -1)] {
            if face != Face::Open {
                walls.push(Wall { axis, node, inward, face });
            }
        }
    }
    walls
}

fn mean(positions: &[[f64; 3]]) -> [f64; 3] {
    let sum = positions.iter().fold([0.0; 3], |sum: [f64; 3], x| std::array::from_fn(|i| sum[i] + x[i]));
    sum.map(|x| x / positions.len() as f64)
}

fn fill(scene: &Scene, body: usize) -> Result<(Vec<[f64; 3]>, f64, f64), Problem> {
    use crate::geometry::Shape;
    let d = if scene.dimension == Dimension::Space { 3 } else { 2 };
    let h = scene.discretization.cell / scene.discretization.particles_per_side as f64;
    let origin = scene.domain.as_ref().map_or([0.0; 3], |domain| domain.min);
    let (min, max) = match &scene.bodies[body].shape {
        Shape::Ball { center, radius } => (center.map(|c| c - radius), center.map(|c| c + radius)),
        Shape::Box { min, max } => (*min, *max),
        _ => unimplemented!(),
    };
    let inside = |x: [f64; 3]| match &scene.bodies[body].shape {
        Shape::Ball { center, radius } => {
            (0..d).map(|i| (x[i] - center[i]).powi(2)).sum::<f64>() < radius * radius
        }
        _ => (0..d).all(|i| x[i] > min[i] && x[i] < max[i]),
    };
    let lo: [i64; 3] =
        std::array::from_fn(|i| if i < d { ((min[i] - origin[i]) / h).floor() as i64 - 1 } else { 0 });
    let hi: [i64; 3] =
        std::array::from_fn(|i| if i < d { ((max[i] - origin[i]) / h).ceil() as i64 + 1 } else { 0 });
    let mut out = Vec::new();
    for i in lo[0]..=hi[0] {
        for j in lo[1]..=hi[1] {
            for k in lo[2]..=hi[2] {
                let n = [i, j, k];
                let x: [f64; 3] =
                    std::array::from_fn(|a| if a < d { origin[a] + (n[a] as f64 + 0.5) * h } else { 0.0 });
                let in_domain = scene
                    .domain
                    .as_ref()
                    .is_none_or(|dm| (0..d).all(|a| x[a] > dm.min[a] && x[a] < dm.max[a]));
                if inside(x) && in_domain {
                    out.push(x);
                }
            }
        }
    }
    Ok((out, h.powi(d as i32), h / 2.0))
}
