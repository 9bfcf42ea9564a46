//! Parts of one body that face each other across a slit which its grid cannot see.

use super::warning::{Warning, and_more};
use crate::geometry::{Shape, SurfacePoint};
use crate::packing::near;
use crate::scene::{Interior, Scene};
use rayon::prelude::*;

/// Slits narrower than this many cells of a grid of the body's own are bridged by its shape functions.
const OWN: f64 = 3.0;
/// So are those of the common grid, whose nodes take both sides for one.
const COMMON: f64 = 1.5;
/// Distance of neighbouring points of the surface [cells].
const SPACING: f64 = 0.5;
/// The two normals of a slit add up to less than this: the flanks of a notch that closes are none.
const PARALLEL: f64 = 0.3;
/// Gaps narrower than this are round-off between parts that touch [cells].
const TOUCHING: f64 = 1e-6;

/// What is less of a length is round-off in the distance from a curved surface.
const ROUND_OFF: f64 = 1e-3;

/// Two points that face each other.
struct Slit {
    gap: f64,
    place: [f64; 3],
}

/// A warning of the narrowest slit that a grid bridges at the start.
pub(super) fn warning(scene: &Scene) -> Option<Warning> {
    let found: Vec<_> = (0..scene.bodies.len())
        .into_par_iter()
        .filter(|&body| !scene.bodies[body].is_rigid())
        .filter_map(|body| Some((body, narrowest(scene, body)?)))
        .collect();
    let (body, Slit { gap, place }) = found.iter().min_by(|a, b| a.1.gap.total_cmp(&b.1.gap))?;
    let (cell, reach) = (scene.cell(&scene.bodies[*body]), reach(scene, *body));
    let place: Vec<String> = place[..scene.dimension.axes()].iter().map(|x| format!("{x:.3e}")).collect();
    let text = format!(
        "not resolved by the grid: parts of {} face each other {gap:.3e} m apart near ({}) m, {:.2} cells; nearer \
         than {reach} cells they share shape functions, so that they push each other before they touch, and stick. \
         Make bodies of parts that will meet, or take space.cell below {:.1e} m",
        and_more(&format!("`{}`", scene.bodies[*body].name), found.len() - 1),
        place.join(", "),
        gap / cell,
        gap / reach
    );
    Some(Warning::about(format!("bodies[{body}].shape"), text))
}

/// How far parts of a body must be apart to be two [cells].
fn reach(scene: &Scene, body: usize) -> f64 {
    if scene.interior(body) == Interior::Reference { OWN } else { COMMON }
}

/// The narrowest slit of a body that is narrower than its grid can see.
fn narrowest(scene: &Scene, body: usize) -> Option<Slit> {
    let shape = &scene.bodies[body].shape;
    let (cell, axes) = (scene.cell(&scene.bodies[body]), scene.dimension.axes());
    let bounds = shape.bounds(axes).filter(|_| !is_simple(shape))?;
    let reach = reach(scene, body) * cell;
    // Most points have nothing in the ball before them, as wide as a slit may be.
    let has_room = |point: &SurfacePoint| {
        let middle = std::array::from_fn(|i| point.position[i] + 0.5 * reach * point.normal[i]);
        shape.distance(middle, axes) > 0.5 * reach * (1.0 - ROUND_OFF)
    };
    let surface = shape.surface(SPACING * cell, axes, &bounds);
    let points: Vec<SurfacePoint> = surface.into_par_iter().filter(|point| !has_room(point)).collect();
    let positions: Vec<[f64; 3]> = points.iter().map(|point| point.position).collect();
    let near = near(&positions, &vec![0.0; points.len()], reach + SPACING * cell, axes);
    let pairs = (0..points.len()).flat_map(|i| near.of(i).map(move |j| (i, j)));
    let gaps = pairs.filter_map(|(i, j)| Some((gap(&points[i], &points[j], cell)?, i)));
    let (gap, i) = gaps.filter(|(gap, _)| *gap < reach).min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(Slit { gap, place: positions[i] })
}

/// Whether no part of a shape can face another.
fn is_simple(shape: &Shape) -> bool {
    match shape {
        Shape::Ball { .. } | Shape::Box { .. } | Shape::Cylinder { .. } => true,
        Shape::Rotated { shape, .. } => is_simple(shape),
        _ => false,
    }
}

/// How wide the room between two points is that face each other across it [m].
fn gap(one: &SurfacePoint, other: &SurfacePoint, cell: f64) -> Option<f64> {
    let off: [f64; 3] = std::array::from_fn(|i| other.position[i] - one.position[i]);
    let along = |normal: [f64; 3]| (0..3).map(|i| off[i] * normal[i]).sum::<f64>();
    let gap = along(one.normal);
    let sum: f64 = (0..3).map(|i| (one.normal[i] + other.normal[i]).powi(2)).sum();
    let aside: f64 = (0..3).map(|i| (off[i] - gap * one.normal[i]).powi(2)).sum();
    let faces = gap > TOUCHING * cell && along(other.normal) < 0.0;
    (faces && sum < PARALLEL * PARALLEL && aside.sqrt() < SPACING * cell).then_some(gap)
}

#[cfg(test)]
mod tests {
    use crate::check::tests::report;

    fn told(shape: &str, interior: &str) -> Vec<String> {
        let text = format!(
            "space = {{ dimension = '2d', cell = 0.1, interior = '{interior}' }}\ntime.end = 1\n\
             materials.gum = {{ density = 1, neo_hookean = {{ young_modulus = 9, poisson_ratio = 0 }} }}\n\
             contact = [{{ law = 'none' }}]\n\
             bodies = [{{ name = 'a', material = 'gum', shape = {shape} }}]\n"
        );
        let scene = crate::scene::parse("slit.toml", &text, &[]).expect("a scene").scene;
        let warnings = report(&scene).expect("no problem").warnings;
        warnings.iter().map(|w| w.to_string()).filter(|w| w.contains("face each other")).collect()
    }

    /// Two boxes of ten cells, one above the other at a gap of so many cells.
    fn boxes(gap: f64) -> String {
        let low = 1.0 + 0.1 * gap;
        format!(
            "{{ union = [{{ box = {{ min = [0, 0], max = [1, 1] }} }}, \
             {{ box = {{ min = [0, {low}], max = [1, {}] }} }}] }}",
            low + 1.0
        )
    }

    #[test]
    fn slits_that_a_grid_bridges_are_told_with_place_and_cells() {
        let found = told(&boxes(0.8), "reference");
        let begin =
            "bodies[0].shape: not resolved by the grid: parts of `a` face each other 8.000e-2 m apart";
        assert!(found.len() == 1 && found[0].starts_with(begin), "{found:?}");
        assert!(found[0].contains("0.80 cells; nearer than 3 cells") && found[0].contains("below 2.7e-2 m"));
        assert_eq!(told(&boxes(2.4), "reference").len(), 1);
        assert_eq!(told(&boxes(1.4), "grid").len(), 1);
        // A bore of two cells.
        let bore = "{ difference = [{ box = { min = [0, 0], max = [2, 2] } }, \
                    { ball = { center = [1, 1], radius = 0.1 } }] }";
        assert_eq!(told(bore, "reference").len(), 1);
    }

    #[test]
    fn parts_that_grids_tell_apart_are_not_told_of_nor_thin_walls_and_parts_that_join() {
        for (shape, interior) in [
            (boxes(3.1), "reference"),
            (boxes(1.6), "grid"),
            (boxes(0.0), "reference"),
            // A ring whose wall has two and a half cells, and a notch of thirty degrees.
            (
                "{ difference = [{ ball = { center = [0, 0], radius = 1 } }, \
                 { ball = { center = [0, 0], radius = 0.75 } }] }"
                    .to_string(),
                "reference",
            ),
            (
                "{ difference = [{ box = { min = [-1, 0], max = [1, 2] } }, \
                 { polygon = { points = [[0, 1], [0.27, 2.1], [-0.27, 2.1]] } }] }"
                    .to_string(),
                "reference",
            ),
        ] {
            assert_eq!(told(&shape, interior), [""; 0], "{shape} on {interior}");
        }
    }
}
