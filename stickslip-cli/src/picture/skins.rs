//! Bodies in space as smooth surfaces: the triangles of their shapes, carried along by their particles.

use super::camera::Point;
use super::setting::SymmetryPlane;
use rayon::prelude::*;
use std::collections::HashSet;
use stickslip::door::ParticleSnapshot;
use stickslip::geometry::Bounds;
use stickslip::scene::Scene;
use stickslip::surface::{self, CarriedSkin, Skin};
use stickslip::tensor::Vector;

/// The surfaces of a run's bodies, tied to the particles of its first snapshot.
#[derive(Clone, Debug)]
pub struct Skins(Vec<BodySkin>);

#[derive(Clone, Debug)]
struct BodySkin {
    body: u32,
    /// Numbers of its particles at the start, in order.
    numbers: Vec<u32>,
    carried: CarriedSkin,
}

/// Triangles of some bodies.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Places of the corners [m].
    pub corners: Vec<Point>,
    /// Outward unit normals of the surface at the corners.
    pub normals: Vec<Point>,
    /// Where the corners were at the start [m].
    pub reference: Vec<[f64; 3]>,
    /// Values at the corners, in SI units.
    pub values: Vec<f64>,
    /// Corners, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Body of each triangle.
    pub body: Vec<u32>,
}

/// Corners nearer to a mirror than this part of a triangle's side lie on it: edges of surfaces are blunted.
const AT_MIRROR: f64 = 0.6;

impl Skins {
    /// The surfaces of a scene's bodies by their undeformed particles; bodies without bounds have none.
    pub fn new(scene: &Scene, first: &ParticleSnapshot) -> Self {
        let dimension = first.dimension;
        let within = scene.domain.as_ref().map(|domain| Bounds { min: domain.min, max: domain.max });
        let by_body = by_body(first);
        let skin = |(number, body): (usize, &stickslip::scene::Body)| {
            let own = by_body.get(number).filter(|own| !own.is_empty())?;
            let mean = own.iter().map(|&i| first.volume[i]).sum::<f64>() / own.len() as f64;
            let spacing = mean.cbrt();
            let skin = Skin::of(&body.shape, spacing, dimension, within)?;
            let places = own.iter().map(|&i| first.position[i]).collect();
            let carried = CarriedSkin::new(skin, places, spacing);
            let numbers = own.iter().map(|&i| first.number[i]).collect();
            Some(BodySkin { body: number as u32, numbers, carried })
        };
        let bodies: Vec<_> = scene.bodies.iter().enumerate().collect();
        Skins(bodies.into_par_iter().filter_map(skin).collect())
    }

    /// The surfaces in a snapshot of those bodies whose particles are all there, with a value at each corner: `value`
    /// tells it from the body and the place, or gives nothing where it is that of the particles around.
    pub fn mesh(
        &self,
        particles: &ParticleSnapshot,
        values: &[f64],
        value: impl Fn(u32, [f64; 3]) -> Option<f64> + Sync,
    ) -> Mesh {
        let by_body = by_body(particles);
        let carried = |skin: &BodySkin| -> Option<(Vec<[f64; 3]>, Vec<f64>)> {
            let own = by_body.get(skin.body as usize)?;
            let is_whole = own.len() == skin.numbers.len()
                && own.iter().zip(&skin.numbers).all(|(&i, number)| particles.number[i] == *number);
            if !is_whole {
                return None;
            }
            let positions: Vec<[f64; 3]> = own.iter().map(|&i| particles.position[i]).collect();
            let deformations: Vec<[f64; 9]> = own.iter().map(|&i| particles.deformation[i]).collect();
            let corners = skin.carried.corners(&positions, &deformations);
            let own_values: Vec<f32> = own.iter().map(|&i| values[i] as f32).collect();
            let around = skin.carried.at_corners(&own_values);
            let at =
                |(corner, around): (&[f64; 3], &f32)| value(skin.body, *corner).unwrap_or(f64::from(*around));
            let values: Vec<f64> = corners.iter().zip(&around).map(at).collect();
            Some((corners, values))
        };
        let found: Vec<_> = self.0.par_iter().map(carried).collect();
        let mut mesh = Mesh::default();
        for (skin, found) in self.0.iter().zip(found) {
            let Some((corners, values)) = found else { continue };
            let first = mesh.corners.len() as u32;
            let known = skin.carried.skin();
            mesh.triangles.extend(known.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
            mesh.body.extend(std::iter::repeat_n(skin.body, known.triangles.len()));
            mesh.corners.extend(corners.into_iter().map(Vector));
            mesh.reference.extend(&known.corners);
            mesh.values.extend(values);
        }
        mesh.turn_outwards();
        mesh
    }
}

/// The particles of each body in the order of their numbers.
fn by_body(particles: &ParticleSnapshot) -> Vec<Vec<usize>> {
    let count = particles.body.iter().max().map_or(0, |last| *last as usize + 1);
    let mut own = vec![Vec::new(); count];
    particles.body.iter().enumerate().for_each(|(i, &body)| own[body as usize].push(i));
    own.iter_mut().for_each(|own| own.sort_by_key(|&i| particles.number[i]));
    own
}

impl Mesh {
    /// The bodies among them.
    pub fn bodies(&self) -> HashSet<u32> {
        self.body.iter().copied().collect()
    }

    /// With its mirror image, without the faces at which the mirror cut bodies open.
    pub fn mirrored(mut self, SymmetryPlane { axis, position }: SymmetryPlane) -> Self {
        let sides = self
            .triangles
            .iter()
            .map(|[a, b, _]| (self.corners[*a as usize] - self.corners[*b as usize]).norm());
        let near = AT_MIRROR * sides.sum::<f64>() / self.triangles.len().max(1) as f64;
        for corner in self.corners.iter_mut().filter(|corner| (corner[axis] - position).abs() < near) {
            corner[axis] = position;
        }
        let is_cut = |triangle: &[u32; 3]| {
            triangle.iter().all(|&corner| self.corners[corner as usize][axis] == position)
        };
        let kept: Vec<bool> = self.triangles.iter().map(|triangle| !is_cut(triangle)).collect();
        let mut keep = kept.iter();
        self.triangles.retain(|_| *keep.next().expect("there is one for each"));
        let mut keep = kept.iter();
        self.body.retain(|_| *keep.next().expect("there is one for each"));
        let count = self.corners.len() as u32;
        let image = |corner: &Point| {
            let mut image = *corner;
            image[axis] = 2.0 * position - image[axis];
            image
        };
        let corners: Vec<Point> = self.corners.iter().map(image).collect();
        // Seen in a mirror, what was counterclockwise is clockwise.
        let triangles: Vec<[u32; 3]> =
            self.triangles.iter().map(|[a, b, c]| [count + a, count + c, count + b]).collect();
        self.corners.extend(corners);
        self.triangles.extend(triangles);
        self.body.extend_from_within(..);
        self.values.extend_from_within(..);
        self.reference.extend_from_within(..);
        self.turn_outwards();
        // The two halves meet without an edge.
        for (corner, normal) in self.corners.iter().zip(&mut self.normals) {
            if corner[axis] == position {
                normal[axis] = 0.0;
                *normal = normal.direction().unwrap_or(Vector::ZERO);
            }
        }
        self
    }

    /// Unit normal of a triangle; zero of one without area.
    pub fn face(&self, triangle: usize) -> Point {
        let corners = self.triangles[triangle].map(|corner| self.corners[corner as usize]);
        surface::area(corners).direction().unwrap_or(Vector::ZERO)
    }

    /// Normals at the corners: those of the triangles around, by their areas.
    fn turn_outwards(&mut self) {
        self.normals = surface::normals(&self.corners, &self.triangles);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BALL: &str = r#"
        space = { dimension = "3d", interior = "grid", cell = 0.25 }
        time.end = 1
        materials.rubber = { density = 1, neo_hookean = { young_modulus = 1, poisson_ratio = 0.3 } }
        bodies = [
            { name = "ball", material = "rubber", shape.ball = { center = [0, 0, 0], radius = 1 } },
            { name = "floor", material = "rubber", shape.half_space = { point = [0, 0, -2], normal = [0, 0, 1] },
              rigid = {} },
        ]
    "#;

    #[test]
    fn a_ball_has_a_round_surface_that_moves_with_it() {
        let scene =
            stickslip::scene::parse("a.toml", BALL, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
        let grains = super::super::sample::ball([0.0; 3], 1.0, 0.125);
        let count = grains.len();
        let mut particles = ParticleSnapshot {
            dimension: 3,
            body: vec![0; count],
            number: (0..count as u32).rev().collect(),
            position: grains.iter().map(|grain| grain.position).collect(),
            velocity: vec![[0.0; 3]; count],
            stress: vec![[0.0; 6]; count],
            mass: vec![1.0; count],
            volume: vec![0.125f64.powi(3); count],
            deformation: grains.iter().map(|grain| grain.deformation).collect(),
            ..Default::default()
        };
        let skins = Skins::new(&scene, &particles);
        particles.position.iter_mut().for_each(|x| x[0] += 3.0);
        let values: Vec<f64> = particles.position.iter().map(|x| x[2]).collect();
        let mesh = skins.mesh(&particles, &values, |_, _| None);
        assert_eq!(mesh.bodies(), HashSet::from([0]));
        for (i, corner) in mesh.corners.iter().enumerate() {
            let arm = *corner - Vector([3.0, 0.0, 0.0]);
            assert!((arm.norm() - 1.0).abs() < 0.02 && mesh.normals[i].dot(arm) > 0.95, "{arm:?}");
            assert!((mesh.values[i] - arm[2]).abs() < 0.15);
            assert!((Vector(mesh.reference[i]) - arm).norm() < 1e-5);
        }
        let both = mesh.clone().mirrored(SymmetryPlane { axis: 0, position: 0.0 });
        let last = both.corners.len() - 1;
        assert_eq!(both.triangles.len(), 2 * mesh.triangles.len());
        assert!(both.normals[last].dot(both.corners[last] + Vector([3.0, 0.0, 0.0])) > 0.95);
        // A mirror through it: half of it, without the cut, twice.
        let half = mesh.clone().mirrored(SymmetryPlane { axis: 2, position: -1.0 });
        assert!(half.triangles.len() < 2 * mesh.triangles.len(), "the cap in the mirror is gone");
        let seam = half.corners.iter().zip(&half.normals).filter(|(corner, _)| corner[2] == -1.0);
        assert!(seam.into_iter().all(|(_, normal)| normal[2] == 0.0));
        // A body that lost a particle has no surface.
        let fewer = particles.only(|_, number| number != 7);
        assert!(skins.mesh(&fewer, &values, |_, _| None).triangles.is_empty());
    }
}
