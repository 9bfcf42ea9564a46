//! Bodies too thin for the grid: a cell bends more stiffly than the material in it.

use super::table::short;
use super::warning::{Warning, and_more};
use crate::geometry::{self, Mirror, MirroredShape};
use crate::scene::{Face, Interior, Scene};
use crate::tensor::Vector;
use rayon::prelude::*;

/// Fewer cells than this through a body bend too stiffly. A beam with gimp and two particles a side deflects, of what
/// is exact, by 0.62 at one cell and by 0.95 at two.
const NEEDED: f64 = 3.0;

/// Thicknesses nearer to the bound than this share are round-off and the last step to the surface.
const TOLERANCE: f64 = 2e-3;

/// Deformable bodies fewer than three cells thick, and longer than they are thick.
pub(super) fn warning(scene: &Scene) -> Option<Warning> {
    let cell = |body: usize| scene.cell(&scene.bodies[body]);
    let thin: Vec<_> = (0..scene.bodies.len())
        .into_par_iter()
        .filter(|&body| !scene.bodies[body].is_rigid())
        .filter_map(|body| Some((body, thickness(scene, body, NEEDED * cell(body))?)))
        .filter(|&(body, thickness)| is_long(scene, body, thickness))
        .collect();
    let (body, thickness) = *thin.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let measured = match scene.interior(body) {
        Interior::Reference => {
            "bends too easily: a beam two cells thick deflects by 1.07 of what it should, one of three \
                                cells by 1.03"
        }
        Interior::Grid => {
            "bends too stiffly: a beam one cell thick deflects by 0.62 of what it should, one of two cells \
                           by 0.95 (gimp)"
        }
    };
    Some(Warning::about(
        format!("bodies[{body}].shape"),
        format!(
            "thinner than {NEEDED} cells: {} ({} m thick, {:.1} cells) {measured}; cells of at most {} m give it \
             {NEEDED}; if it does not bend, this does no harm",
            and_more(&format!("`{}`", scene.bodies[body].name), thin.len() - 1),
            short(thickness),
            thickness / cell(body),
            short(thickness / NEEDED)
        ),
    ))
}

/// Whether a body is so much longer than it is thick that it can bend; grains do not.
fn is_long(scene: &Scene, body: usize, thickness: f64) -> bool {
    let bounds = scene.bodies[body].shape.bounds(scene.dimension.axes());
    bounds.is_none_or(|bounds| bounds.size().into_iter().fold(0.0, f64::max) > LONG * thickness)
}

/// Thicknesses that a body that can bend is long, at least.
const LONG: f64 = 2.0;

/// How thick a body is where it is thickest [m], if that is less than `enough`: the shortest way through it at the
/// particles furthest from its surface.
///
/// A ring or shell is as thick as its wall. What a mirror completes counts whole; so does what goes on in a fixed face.
pub(super) fn thickness(scene: &Scene, body: usize, enough: f64) -> Option<f64> {
    let (axes, cell) = (scene.dimension.axes(), scene.cell(&scene.bodies[body]));
    let shape = &scene.bodies[body].shape;
    let whole = MirroredShape::new(shape, continuing_faces(scene), axes);
    let sites =
        geometry::sites(shape, &scene.lattice(&scene.bodies[body]), scene.arrangement(&scene.bodies[body]))?;
    let (mut deepest, mut depth) = (Vec::new(), 0.0);
    for site in sites {
        let here = -whole.level(site.position).distance;
        if 2.0 * here >= enough {
            return None;
        }
        if here > (1.0 + TOLERANCE) * depth {
            deepest.clear();
            depth = here;
        }
        if here >= (1.0 - TOLERANCE) * depth {
            deepest.push(site.position);
        }
    }
    let through = |&point: &[f64; 3]| {
        let out = |way: [f64; 3]| way_out(&whole, point, way, (enough, TOLERANCE * cell));
        let across = |way: [f64; 3]| out(way) + out(way.map(|x| -x));
        let gradient = whole.level(point).gradient;
        ways(gradient, axes).into_iter().map(across).fold(f64::INFINITY, f64::min)
    };
    let thickest =
        deepest.iter().step_by(deepest.len().div_ceil(MOST_PLACES).max(1)).map(through).fold(0.0, f64::max);
    (thickest > 0.0 && thickest < enough * (1.0 - TOLERANCE)).then_some(thickest)
}

/// Places at which a body is measured, of those that are deepest in it.
const MOST_PLACES: usize = 64;

/// Way from a point inside out of a body, at most `enough` [m]; where two parts of the body meet within a `seam`, it
/// goes on [m].
fn way_out(whole: &MirroredShape, point: [f64; 3], way: [f64; 3], (enough, seam): (f64, f64)) -> f64 {
    let depth = |length: f64| -whole.level((Vector(point) + Vector(way) * length).0).distance;
    let mut length = 0.0;
    while length < enough {
        // Of shapes combined the depth may be too small, never too large.
        let inside = depth(length);
        if inside > 1e-3 * seam {
            length += inside;
        } else if depth(length + seam) > 1e-3 * seam {
            length += seam;
        } else {
            break;
        }
    }
    length
}

/// The faces of the domain behind which a body goes on as if they were mirrors.
fn continuing_faces(scene: &Scene) -> Vec<Mirror> {
    let Some(domain) = &scene.domain else { return Vec::new() };
    let faces = (0..scene.dimension.axes()).flat_map(|axis| [0, 1].map(|side| (axis, side)));
    (faces.filter(|&(axis, side)| domain.faces[axis][side] != Face::Open))
        .map(|(axis, side)| match side {
            0 => Mirror { axis, position: domain.min[axis], inward: 1.0 },
            _ => Mirror { axis, position: domain.max[axis], inward: -1.0 },
        })
        .collect()
}

/// Unit vectors along which a body is measured, to and fro: that to its surface, the axes and their diagonals.
fn ways(gradient: [f64; 3], axes: usize) -> Vec<[f64; 3]> {
    let unit = |way: [f64; 3]| Vector(way).norm();
    // The others are the opposite of these.
    let all = 3_i32.pow(axes as u32);
    let lattice = (all / 2 + 1..all).map(|i| {
        std::array::from_fn(|k| if k < axes { f64::from(i / 3_i32.pow(k as u32) % 3 - 1) } else { 0.0 })
    });
    lattice.chain([gradient]).filter(|&way| unit(way) > 0.5).map(|way| way.map(|x| x / unit(way))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::tests::{at_rest, free, scene};
    use crate::geometry::Shape;
    use crate::scene::{Dimension, Domain};

    /// On cells of 0.1 m.
    fn said(dimension: Dimension, shape: Shape) -> Option<String> {
        warning(&scene(dimension, 0.1, vec![free("it", 0, shape)])).map(|warning| warning.to_string())
    }

    fn strip(thickness: f64) -> Shape {
        Shape::Box { min: [0.0; 3], max: [2.0, thickness, 0.0] }
    }

    fn disk(radius: f64) -> Shape {
        Shape::Ball { center: [0.5, 0.5, 0.0], radius }
    }

    #[test]
    fn strips_of_one_and_two_cells_are_thin_and_of_three_are_not() {
        let plane = Dimension::PlaneStrain;
        for (thickness, cells) in [(0.1, "1.0 cells"), (0.2, "2.0 cells"), (0.25, "2.5 cells")] {
            let text = said(plane, strip(thickness)).expect("thin");
            assert!(text.contains("`it`") && text.contains(cells) && text.contains("0.62"), "{text}");
        }
        assert_eq!(said(plane, strip(0.3)), None);
        let shape = || Box::new(strip(0.2));
        let turned = Shape::Rotated { shape: shape(), center: [0.0; 3], axis: [0.0, 0.0, 1.0], angle: 0.4 };
        let text = said(plane, turned).expect("thin");
        assert!(text.contains("(0.2 m thick"), "{text}");
    }

    /// A disk 4 cells across is none, its rim of a cell is one; a sheet in space is one, turned or not.
    #[test]
    fn a_ring_is_as_thick_as_its_wall() {
        let plane = Dimension::PlaneStrain;
        assert_eq!(said(plane, disk(0.2)), None);
        // A grain of two cells has nothing to bend.
        assert_eq!(said(plane, disk(0.1)), None);
        let ring = |inner| Shape::Difference(vec![disk(0.5), disk(inner)]);
        assert!(said(plane, ring(0.4)).expect("thin").contains("1.0 cells"));
        assert_eq!(said(plane, ring(0.15)), None);
        let sheet = Shape::Box { min: [0.0; 3], max: [1.0, 1.0, 0.1] };
        assert!(said(Dimension::Space, sheet).is_some());
    }

    #[test]
    fn layers_that_lie_on_each_other_are_one_body() {
        let layer = |i: u32| {
            let y = 0.1 * f64::from(i);
            Shape::Box { min: [0.0, y, 0.0], max: [2.0, y + 0.1, 0.0] }
        };
        assert_eq!(said(Dimension::PlaneStrain, Shape::Union((0..6).map(layer).collect())), None);
        assert!(said(Dimension::PlaneStrain, Shape::Union((0..2).map(layer).collect())).is_some());
    }

    #[test]
    fn a_mirror_doubles_what_lies_on_it_and_rigid_bodies_do_not_bend() {
        let mut scene = scene(Dimension::PlaneStrain, 0.1, vec![free("half", 0, strip(0.2))]);
        assert!(warning(&scene).is_some());
        let open = [Face::Open; 2];
        let faces = [open, [Face::Symmetry, Face::Open], open];
        scene.domain = Some(Domain { faces, ..Domain::new([-1.0, 0.0, 0.0], [4.0; 3]) });
        assert_eq!(warning(&scene), None);
        scene.domain = None;
        scene.bodies = vec![at_rest("half", strip(0.2))].into();
        assert_eq!(warning(&scene), None);
    }
}
