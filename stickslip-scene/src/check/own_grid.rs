//! What bodies on grids of their own consist of, which tells their memory and time.

use super::bodies::FillingExtent;
use super::neighbours::pairs_within;
use crate::geometry::form::{Form, HeldFaces};
use crate::geometry::{Bounds, ParticleSite, Shape};
use crate::scene::{Body, ContactLaw, Face, Interior, RuleNames, Scene};
use crate::tensor::Vector;
use rayon::prelude::*;
use stickslip_reference::cells::CellKinds;
use stickslip_reference::surface::free_points;

/// A body on a grid of its own in numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OwnGrid {
    /// Cells that hold particles.
    pub cells: usize,
    /// How many of them differ.
    pub kinds: CellKinds,
    /// Nodes.
    pub nodes: usize,
    /// Memory of the grid, without what moves [bytes].
    pub bytes: usize,
    /// Points of the surface.
    pub points: usize,
    /// Points so near a partner at the start that contact looks at them in every step, for each partner.
    pub near: usize,
}

/// The particles of a body on a grid of its own, and that grid with no points yet; `None` where none fits.
pub(super) fn filled(scene: &Scene, body: &Body, faces: HeldFaces) -> Option<(Vec<ParticleSite>, OwnGrid)> {
    let cell = scene.cell(body);
    match scene.dimension.axes() {
        2 => filled_in::<2>(&body.shape, cell, faces),
        _ => filled_in::<3>(&body.shape, cell, faces),
    }
}

fn filled_in<const D: usize>(
    shape: &Shape,
    cell: f64,
    faces: HeldFaces,
) -> Option<(Vec<ParticleSite>, OwnGrid)> {
    let form = Form::<D>::new(shape, cell, faces).ok()?;
    let site = |(place, volume)| ParticleSite::of_volume(place, volume, D);
    let grid = OwnGrid {
        cells: form.cells.len(),
        kinds: CellKinds::of(&form),
        nodes: form.nodes(),
        bytes: bytes_of(&form),
        ..OwnGrid::default()
    };
    Some((form.parts().into_iter().map(site).collect(), grid))
}

/// Memory of a grid, of one that faces hold without its shares of followers [bytes].
fn bytes_of<const D: usize>(form: &Form<D>) -> usize {
    fn room<X>(list: &Vec<X>) -> usize {
        list.capacity() * size_of::<X>()
    }
    let lists = room(&form.offsets) + room(&form.cells) + room(&form.places) + room(&form.volumes);
    let held = if form.held.is_some() { form.nodes() * size_of::<Vector<f64, D>>() } else { 0 };
    size_of::<Form<D>>() + lists + room(&form.node_volumes) + form.followers.bytes() + held
}

/// Points of surfaces that are nearer to a partner than this are looked at in every step [cells].
const NEAR: f64 = 0.4;

/// Points of a surface by which those near partners are told, about; of larger surfaces each stands for some.
const MOST_POINTS: usize = 5000;

/// Points of a surface, and for how many each stands.
#[derive(Default)]
struct Surface {
    count: usize,
    points: Vec<[f64; 3]>,
    stand_for: usize,
}

impl Surface {
    /// None of a body on the common grid.
    fn of(scene: &Scene, body: usize) -> Self {
        if scene.interior(body) != Interior::Reference {
            return Surface::default();
        }
        let body = &scene.bodies[body];
        let (cell, faces) = (scene.cell(body), scene.held_faces(body));
        let all = free_points(&body.shape, (cell, &faces), scene.dimension.axes());
        let stand_for = all.len().div_ceil(MOST_POINTS).max(1);
        let points = all.iter().step_by(stand_for).map(|point| point.position).collect();
        Surface { count: all.len(), points, stand_for }
    }

    /// How many are near something.
    fn near(&self, is_near: impl Fn(&[f64; 3]) -> bool) -> usize {
        self.stand_for * self.points.iter().filter(|point| is_near(point)).count()
    }
}

/// The grids of bodies that have some of their own, with the points of their surfaces.
pub(super) fn own_grids(scene: &Scene, extents: &[FillingExtent]) -> Vec<Option<OwnGrid>> {
    let mut grids: Vec<Option<OwnGrid>> = extents.iter().map(|extent| extent.grid).collect();
    if grids.iter().all(Option::is_none) {
        return grids;
    }
    let axes = scene.dimension.axes();
    let reach = |body: usize| NEAR * scene.cell(&scene.bodies[body]);
    let surfaces: Vec<Surface> =
        (0..scene.bodies.len()).into_par_iter().map(|body| Surface::of(scene, body)).collect();
    let boxes: Vec<Bounds> = extents.iter().map(|extent| extent.bounds).collect();
    let names = RuleNames::new(scene);
    let meet = |[a, b]: [usize; 2]| {
        let rule = names.rule(names.class(a), names.class(b));
        rule.is_none_or(|rule| scene.contact[rule].law != ContactLaw::None)
    };
    let near = |pair: [usize; 2]| {
        let [a, b] = pair;
        let of = |body: usize, other: usize| {
            let reach = reach(body);
            let (around, shape) = (boxes[other].grown(reach), &scene.bodies[other].shape);
            let is_around = |at: &[f64; 3]| (0..axes).all(|k| around.min[k] < at[k] && at[k] < around.max[k]);
            surfaces[body].near(|at| is_around(at) && shape.distance(*at, axes) < reach)
        };
        [(a, of(a, b)), (b, of(b, a))]
    };
    let pairs = pairs_within(&boxes, (0..boxes.len()).map(reach).fold(0.0, f64::max));
    let pairs: Vec<_> = pairs.into_par_iter().filter(|&pair| meet(pair)).flat_map_iter(near).collect();
    let at_faces =
        |(body, surface): (usize, &Surface)| (body, surface.near(|at| is_near_face(scene, at, reach(body))));
    let all: Vec<(usize, usize)> = surfaces.iter().enumerate().map(at_faces).chain(pairs).collect();
    for (grid, surface) in grids.iter_mut().zip(&surfaces) {
        grid.iter_mut().for_each(|grid| grid.points = surface.count);
    }
    for (body, near) in all {
        grids[body].iter_mut().for_each(|grid| grid.near += near);
    }
    grids
}

/// Whether a place is near a closed face of the domain.
fn is_near_face(scene: &Scene, at: &[f64; 3], reach: f64) -> bool {
    let Some(domain) = &scene.domain else { return false };
    let is_closed = |face: Face| matches!(face, Face::Symmetry | Face::Fixed);
    (0..scene.dimension.axes()).any(|k| {
        let [lower, upper] = domain.faces[k].map(is_closed);
        (lower && at[k] - domain.min[k] < reach) || (upper && domain.max[k] - at[k] < reach)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::bodies::measure;
    use crate::check::tests::{at_rest, free, scene};
    use crate::scene::Dimension;

    /// Two disks of six cells that touch, on a floor, of which one is a copy of the other: so points lie 0.47 cells
    /// apart, and a gap of 0.4 cells opens within 1.1 cells between disks, and within 1.5 above the floor.
    #[test]
    fn points_near_partners_are_counted() {
        let disk = |x: f64| {
            let shape = Shape::Ball { center: [x, 0.3, 0.0], radius: 0.3 };
            Body { interior: Some(Interior::Reference), ..free("disk", 0, shape) }
        };
        let floor = at_rest("floor", Shape::HalfSpace { point: [0.0; 3], normal: [0.0, 1.0, 0.0] });
        let scene = scene(Dimension::PlaneStrain, 0.1, vec![disk(0.3), disk(0.9), floor]);
        let grids = own_grids(&scene, &measure(&scene).expect("no problem"));
        let [Some(one), Some(other)] = [grids[0], grids[1]] else { panic!("both have grids") };
        assert_eq!((one.points, one.cells, one.nodes), (40, 45, 81));
        assert!((8..=12).contains(&one.near), "{}", one.near);
        assert_eq!((one.kinds, one.points), (other.kinds, other.points));
        assert_eq!(grids[2], None);
    }
}
