//! Parts of bodies on which loads and springs act, as points that particles carry along.

use crate::geometry::{Arrangement, ParticleSite, Shape, sites};
use crate::scene::{Body, Extent, Face, Part, Scene};
use rstar::{AABB, PointDistance, RTree, RTreeObject};
use serde::{Deserialize, Serialize};

/// A point of a part, and the particle that carries it.
///
/// ```text
/// x_s = x_p + F_p (X_s - X_p)          n da = J F_p^-T N dA          (Nanson)
/// ```
/// Where a lattice of particles has stairs, points are on the stairs: they lie in their particles' cubes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PartPoint {
    /// Its own number among all points of the part.
    pub number: u32,
    /// Number of the particle in its body, the nearest one.
    pub particle: u32,
    /// Where the point is at the start, X_s [m].
    pub position: [f64; 3],
    /// How far it is from there where the run begins, if its body begins as another run left it [m].
    pub moved: [f64; 3],
    /// From the particle to the point, X_s - X_p [m].
    pub arm: [f64; 3],
    /// Outward unit normal N of the undeformed surface; zero within a volume.
    pub normal: [f64; 3],
    /// Undeformed area that it stands for [m^2], within a volume its volume [m^3]; in the plane per metre of depth.
    pub measure: f64,
}

/// How far beneath a surface a shape is asked whether it holds a piece of it, over the spacing.
const INWARD: f64 = 1e-4;

/// Over the cell: nearer to a mirror, a surface lies on it, and is none of the whole body.
const ON_MIRROR: f64 = 1e-6;

/// Whether a point lies on a face of the domain that is a mirror.
fn on_mirror(scene: &Scene, point: [f64; 3]) -> bool {
    let near = ON_MIRROR * scene.discretization.cell;
    scene.domain.iter().any(|domain| {
        let on = |axis: usize, side: usize| {
            let at = if side == 0 { domain.min[axis] } else { domain.max[axis] };
            domain.faces[axis][side] == Face::Symmetry && (point[axis] - at).abs() < near
        };
        (0..scene.dimension.axes()).any(|axis| on(axis, 0) || on(axis, 1))
    })
}

/// A particle in a tree of places.
struct Leaf(usize, ParticleSite);

impl RTreeObject for Leaf {
    type Envelope = AABB<[f64; 3]>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_point(self.1.position)
    }
}

impl PointDistance for Leaf {
    fn distance_2(&self, point: &[f64; 3]) -> f64 {
        self.1.position.iter().zip(point).map(|(a, b)| (a - b) * (a - b)).sum()
    }
}

/// The points of a part of a body, and what they are together.
#[derive(Clone, Debug)]
pub struct PartPoints {
    /// Index of the body.
    pub body: usize,
    /// The points; none where the body has nothing there.
    pub points: Vec<PartPoint>,
    /// Area of all of them, or volume [m^2 or m^3].
    pub measure: f64,
    /// Their mean place at the start [m].
    pub center: [f64; 3],
}

impl PartPoints {
    /// Those of a part of a body of the scene.
    pub fn new(scene: &Scene, body: usize, part: &Part) -> Self {
        let mut points = Vec::new();
        visit(scene, body, part, &mut |point| points.push(point));
        let measure = points.iter().map(|point| point.measure).sum::<f64>();
        let mean =
            |i: usize| points.iter().map(|point| point.measure / measure * point.position[i]).sum::<f64>();
        let center = [mean(0), mean(1), mean(2)];
        PartPoints { body, points, measure, center }
    }
}

/// Shows the points of a part of a body one after the other, by their numbers; none where it has nothing there.
pub fn visit(scene: &Scene, body: usize, part: &Part, look: &mut dyn FnMut(PartPoint)) {
    let body = &scene.bodies[body];
    let Some(particles) = sites(&body.shape, &scene.lattice(body), scene.arrangement(body)) else { return };
    let mut number = 0;
    let mut show = |point: PartPoint| {
        look(PartPoint { number, ..point });
        number += 1;
    };
    if part.on == Extent::Volume {
        let lattice = scene.lattice(body);
        let point = |(particle, site): (usize, ParticleSite)| PartPoint {
            number: 0,
            moved: [0.0; 3],
            particle: particle as u32,
            position: site.position,
            arm: [0.0; 3],
            normal: [0.0; 3],
            measure: site.volume,
        };
        let within =
            |site: [f64; 3]| part.within.as_ref().is_none_or(|shape| lattice.contains_site(shape, site));
        particles.enumerate().map(point).filter(|point| within(point.position)).for_each(show);
    } else {
        on_surface((scene, body, part), particles).into_iter().for_each(&mut show);
    }
}

/// The points of a part of a surface, of a body that these particles fill.
fn on_surface(
    (scene, body, part): (&Scene, &Body, &Part),
    particles: impl Iterator<Item = ParticleSite>,
) -> Vec<PartPoint> {
    let lattice = scene.lattice(body);
    let dimension = lattice.dimension;
    let inside =
        |point: [f64; 3]| part.within.as_ref().is_none_or(|shape: &Shape| shape.contains(point, dimension));
    let Some(bounds) = body.shape.bounds(dimension) else { return Vec::new() };
    let leaves = particles.enumerate().map(|(i, site)| Leaf(i, site)).collect();
    let tree = RTree::bulk_load(leaves);
    let surface = body.shape.surface(lattice.spacing, dimension, &bounds);
    let chosen = surface.into_iter().filter(|point| {
        // What lies on the border of the shape is in it where the body beneath is.
        let beneath = std::array::from_fn(|k| point.position[k] - INWARD * lattice.spacing * point.normal[k]);
        part.on.has(point.normal) && inside(beneath) && !on_mirror(scene, point.position)
    });
    chosen
        .filter_map(|point| {
            let Leaf(particle, site) = tree.nearest_neighbor(point.position)?;
            // Fitted particles follow the surface; those of a lattice have their cubes' stairs.
            let reach = if body.particles == Arrangement::Lattice { site.half_width } else { f64::INFINITY };
            let arm = std::array::from_fn(|k| (point.position[k] - site.position[k]).clamp(-reach, reach));
            let position = std::array::from_fn(|k| site.position[k] + arm[k]);
            Some(PartPoint {
                number: 0,
                particle: *particle as u32,
                position,
                moved: [0.0; 3],
                arm,
                normal: point.normal,
                measure: point.area,
            })
        })
        .collect()
}
