//! What bodies with interior "reference" cannot have yet.
//!
//! [`OF_BODY`], [`OF_SCENE`] and the table of contact rules in `contact` are the whole list, a row for each: what the
//! engine learns is struck out there.

mod contact;
#[cfg(test)]
mod tests;

use super::bodies::smallest_extent;
use super::settings::is_over_arrays;
use super::table::short;
use crate::geometry::form::Form;
use crate::geometry::{Curved, Shape};
use crate::material::Material;
use crate::rigid::{Carried, carried_bodies};
use crate::scene::{Body, FACES, Face, Interior, Leaving, NamedMaterial, Problem, Scene};

/// What a body may not have, by its number.
const OF_BODY: &[fn(&Scene, usize) -> Option<Problem>] =
    &[point_cloud, particles_per_side, thickness, cells, law_over_arrays, damage, walls, joined];

/// What a scene may not have in which there is one, by the number of the first.
const OF_SCENE: &[fn(&Scene, usize) -> Option<Problem>] = &[removal, joints, light_bodies];

/// Particles along each side of a cell.
const PER_SIDE: f64 = 2.0;

/// Cells that a body has across, at least: its outer nodes follow those inside.
const THINNEST: f64 = 2.0;

/// Cells by which its grid reaches beyond it on every side.
const MARGIN: f64 = 2.0;

/// Cells that its grid has at most.
const MOST_CELLS: f64 = (1_u64 << 31) as f64;

/// What reaches no further beyond a face of the domain ends on it [cells].
const ROUND_OFF: f64 = 1e-9;

/// # Errors
/// The first thing that bodies with interior "reference" cannot have, or cells of a body that has no grid of its own.
/// Shapes without bounds are refused before, for all
/// bodies that deform.
pub(super) fn check(scene: &Scene) -> Result<(), Problem> {
    let mut bodies = (0..scene.bodies.len()).filter(|&body| is_reference(scene, body)).peekable();
    let found = bodies.peek().and_then(|&first| OF_SCENE.iter().find_map(|row| row(scene, first)));
    let found = found.or_else(|| bodies.find_map(|body| OF_BODY.iter().find_map(|row| row(scene, body))));
    found.or_else(|| cells_of_no_grid(scene)).map_or_else(|| contact::check(scene), Err)
}

/// Cells of a body that has no grid of its own.
fn cells_of_no_grid(scene: &Scene) -> Option<Problem> {
    let has_none = |body: &usize| scene.bodies[*body].cell.is_some() && !is_reference(scene, *body);
    let body = (0..scene.bodies.len()).find(has_none)?;
    let Body { name, cell, .. } = &scene.bodies[body];
    let why = match (scene.bodies[body].is_rigid(), &scene.discretization.because) {
        (true, _) => "is rigid".to_string(),
        (false, Some(because)) => format!("is on the grid that all share: {because}"),
        (false, None) => "is on the grid that all share".to_string(),
    };
    Some(Problem {
        key: format!("bodies[{body}].cell"),
        found: format!("{} m, where `{name}` {why}", short(cell.unwrap_or_default())),
        allowed: "none; or interior = \"reference\" for a body that deforms".to_string(),
        help: None,
    })
}

/// Chooses where bodies are computed that do not say so, in a scene that leaves it open: on grids of their own those
/// that are elastic, on the common grid the others; all there where nothing is elastic, or where something asks for
/// what the former have not, such as a key of the common grid. It says why.
pub(crate) fn choose_interior(scene: &mut Scene, wanted: Option<&str>) {
    let open = |body: &Body| !body.is_rigid() && body.interior.is_none();
    let open: Vec<usize> = (0..scene.bodies.len()).filter(|&body| open(&scene.bodies[body])).collect();
    if open.is_empty() {
        return;
    }
    let flowing: Vec<usize> =
        open.iter().copied().filter(|&body| !stays_whole(material(scene, body))).collect();
    let inelastic = flowing.first().map(|&body| {
        let law = material(scene, body).law.name();
        format!("`{}` is of a material that may flow or part, `{law}`", scene.bodies[body].name)
    });
    scene.discretization.interior = Interior::Reference;
    flowing.iter().for_each(|&body| scene.bodies[body].interior = Some(Interior::Grid));
    // Nobody has written the interior that the problem speaks of.
    let refused = || {
        let problem = check(scene).err()?;
        let found = problem.found.split(", where `").next().unwrap_or_default();
        let of_interior = problem.key.ends_with("interior").then(|| inelastic.clone()).flatten();
        Some(of_interior.unwrap_or_else(|| format!("`{}` is {found}", problem.key)))
    };
    // Nobody knows what a law from outside does.
    let is_custom = |&body: &usize| matches!(material(scene, body).law, Material::Custom(_));
    let none_beside = flowing.len() == open.len() || flowing.iter().any(is_custom);
    let because = (wanted.map(|key| format!("`{key}` is written")))
        .or_else(|| inelastic.clone().filter(|_| none_beside))
        .or_else(refused)
        .or_else(|| no_grid(scene));
    if let Some(why) = because {
        scene.discretization.interior = Interior::Grid;
        scene.discretization.because = Some(why);
        flowing.iter().for_each(|&body| scene.bodies[body].interior = None);
    }
}

/// Cells in the box round a shape over which a grid is tried before the run, at most: larger ones are refused as they
/// are built, if they are.
const MOST_TRIED: f64 = 2e5;

/// A shape over which no grid of its own fits: balls and boxes are judged by their sides.
fn no_grid(scene: &Scene) -> Option<String> {
    let is_simple = |shape: &Shape| matches!(shape, Shape::Ball { .. } | Shape::Box { .. });
    let found = |body: usize| {
        let (shape, cell) = (&scene.bodies[body].shape, scene.cell(&scene.bodies[body]));
        if !is_reference(scene, body)
            || is_simple(shape)
            || matches!(shape, Shape::Curved(Curved::PointCloud(_)))
            || cells_around(scene, body) > MOST_TRIED
        {
            return None;
        }
        let faces = scene.held_faces(&scene.bodies[body]);
        let fails = match scene.dimension.axes() {
            2 => Form::<2>::new(shape, cell, faces).is_err(),
            _ => Form::<3>::new(shape, cell, faces).is_err(),
        };
        let name = &scene.bodies[body].name;
        fails.then(|| {
            format!("no grid of its own fits over `{name}`, as over what is less than two cells thick")
        })
    };
    (0..scene.bodies.len()).find_map(found)
}

/// Whether a material is elastic and keeps its shape.
fn stays_whole(material: &NamedMaterial) -> bool {
    is_solid(material)
        && material.law.trusts_deformation()
        && !matches!(material.law, Material::Damage(_) | Material::Custom(_))
}

/// Whether a law takes material apart: by damage, or by a strain at failure.
fn may_part(material: &NamedMaterial) -> bool {
    matches!(material.law, Material::Damage(_)) || material.law.given().get("d1").is_some()
}

/// Whether a material resists shear.
fn is_solid(material: &NamedMaterial) -> bool {
    let elastic = material.law.elastic();
    elastic.shear_modulus > LEAST_SHEAR * elastic.bulk_modulus
}

/// Shear over bulk modulus of a solid, at least; below it material is a fluid, or locks.
const LEAST_SHEAR: f64 = 1e-3;

/// Whether there is a body of that number, with that interior.
fn is_reference(scene: &Scene, body: usize) -> bool {
    body < scene.bodies.len() && scene.interior(body) == Interior::Reference
}

/// The key that gives a body its interior.
fn interior_key(scene: &Scene, body: usize) -> String {
    match scene.bodies[body].interior {
        Some(_) => format!("bodies[{body}].interior"),
        None => "space.interior".to_string(),
    }
}

/// What a body cannot have, and what it may have without changing its interior.
fn problem(scene: &Scene, body: usize, key: String, found: &str, allowed: &str) -> Problem {
    let name = &scene.bodies[body].name;
    Problem {
        key,
        found: format!("{found}, where `{name}` has interior = \"reference\""),
        allowed: format!("{allowed}; or interior = \"grid\" for `{name}`"),
        help: None,
    }
}

fn point_cloud(scene: &Scene, body: usize) -> Option<Problem> {
    let Shape::Curved(Curved::PointCloud(_)) = &scene.bodies[body].shape else { return None };
    let problem = problem(scene, body, interior_key(scene, body), "a body of a point cloud", "");
    // Tables of point clouds have no such key.
    let allowed = "interior = \"grid\" in [space], and \"reference\" for other bodies";
    Some(Problem { allowed: allowed.to_string(), ..problem })
}

fn particles_per_side(scene: &Scene, body: usize) -> Option<Problem> {
    let found = scene.per_side(&scene.bodies[body]);
    let key = match scene.bodies[body].particles_per_side {
        Some(_) => format!("bodies[{body}].particles_per_side"),
        None => "space.particles_per_side".to_string(),
    };
    (found != PER_SIDE).then(|| problem(scene, body, key, &found.to_string(), "2, the default"))
}

fn thickness(scene: &Scene, body: usize) -> Option<Problem> {
    let least = THINNEST * scene.cell(&scene.bodies[body]);
    let extent = smallest_extent(&scene.bodies[body].shape, scene.dimension.axes());
    // A shape in which nothing is has a problem of its own.
    let is_thin = extent > 0.0 && extent < least * (1.0 - ROUND_OFF);
    let found = format!("a shape {} m across", short(extent));
    let allowed = format!("at least {THINNEST} cells, {} m", short(least));
    is_thin.then(|| problem(scene, body, format!("bodies[{body}].shape"), &found, &allowed))
}

/// Cells in the box round a body and its margin; none of one without bounds.
fn cells_around(scene: &Scene, body: usize) -> f64 {
    let (axes, cell) = (scene.dimension.axes(), scene.cell(&scene.bodies[body]));
    let Some(bounds) = scene.bodies[body].shape.bounds(axes) else { return 0.0 };
    bounds.grown(MARGIN * cell).size()[..axes].iter().map(|side| (side / cell).ceil()).product()
}

fn cells(scene: &Scene, body: usize) -> Option<Problem> {
    let (cell, cells) = (scene.cell(&scene.bodies[body]), cells_around(scene, body));
    let key = match scene.bodies[body].cell {
        Some(_) => format!("bodies[{body}].cell"),
        None => "space.cell".to_string(),
    };
    let found = format!("{cells:.1e} cells of {} m in the box round a body", short(cell));
    let allowed = format!("at most {MOST_CELLS:.1e}");
    (cells > MOST_CELLS).then(|| problem(scene, body, key, &found, &allowed))
}

fn law_over_arrays(scene: &Scene, body: usize) -> Option<Problem> {
    let allowed = "a law that takes one particle at a time";
    is_over_arrays(material(scene, body))
        .then(|| problem(scene, body, law_key(scene, body), "a law over arrays", allowed))
}

fn damage(scene: &Scene, body: usize) -> Option<Problem> {
    let allowed = "a law that leaves material in one piece";
    may_part(material(scene, body))
        .then(|| problem(scene, body, law_key(scene, body), "a law by which material parts", allowed))
}

fn material(scene: &Scene, body: usize) -> &NamedMaterial {
    &scene.materials[scene.bodies[body].material]
}

fn law_key(scene: &Scene, body: usize) -> String {
    let material = material(scene, body);
    format!("materials.{}.{}", material.name, material.law.name())
}

fn walls(scene: &Scene, body: usize) -> Option<Problem> {
    let (axes, near) = (scene.dimension.axes(), ROUND_OFF * scene.discretization.cell);
    let (domain, bounds) = (scene.domain.as_ref()?, scene.bodies[body].shape.bounds(axes)?);
    let sides = (0..axes).flat_map(|k| {
        let beyond = [domain.min[k] - bounds.min[k], bounds.max[k] - domain.max[k]];
        (0..2).map(move |side| (domain.faces[k][side], FACES[k][side], beyond[side]))
    });
    let mut walls = sides.filter(|(face, ..)| matches!(face, Face::Symmetry | Face::Fixed));
    let (_, name, _) = walls.find(|(.., beyond)| *beyond > near)?;
    let found = format!("a body that reaches beyond the face `{name}` of the domain");
    let allowed = format!("a body that ends there, or {name} = \"open\"");
    Some(problem(scene, body, format!("bodies[{body}].shape"), &found, &allowed))
}

fn joined(scene: &Scene, body: usize) -> Option<Problem> {
    let axis = scene.joined_ends(body).iter().position(Option::is_some)?;
    let found = format!("a body that is joined to its own images along {}", ["x", "y", "z"][axis]);
    Some(problem(
        scene,
        body,
        format!("bodies[{body}].shape"),
        &found,
        "one that ends between the periodic faces",
    ))
}

fn removal(scene: &Scene, body: usize) -> Option<Problem> {
    let removes = scene.domain.as_ref().is_some_and(|domain| domain.leaving == Leaving::Remove);
    let key = "space.domain.leaving".to_string();
    removes.then(|| problem(scene, body, key, "\"remove\"", "\"stop\", the default"))
}

/// A free rigid body so light that the layer of contact would make steps far shorter than waves do.
fn light_bodies(scene: &Scene, _: usize) -> Option<Problem> {
    let light = carried_bodies(scene).into_iter().find(|carried| carried.ratio > MOST_RATIO)?;
    let Carried { body, mass, partner, ratio, .. } = light;
    let is_given = scene.bodies[body].as_free_rigid().is_some_and(|free| free.mass.is_some());
    let key = format!("bodies[{body}].rigid.free{}", if is_given { ".mass" } else { "" });
    let name = &scene.bodies[body].name;
    let found = format!("{} kg of `{name}`, so light that contact would make steps very short", short(mass));
    let allowed = format!("at least {} kg", short(mass * ratio / MOST_RATIO));
    Some(problem(scene, partner, key, &found, &allowed))
}

/// The square of the fastest motion of a free rigid body on cells all around over that of waves in these, at most: with
/// it, steps are about a tenth as long as without the body.
const MOST_RATIO: f64 = 400.0;

fn joints(scene: &Scene, _: usize) -> Option<Problem> {
    let mut ends = scene.joints.iter().enumerate().flat_map(|(i, joint)| {
        let ends = [("body", Some(joint.body)), ("to", joint.to)];
        ends.into_iter().filter_map(move |(key, body)| Some((i, key, body?)))
    });
    let (i, key, body) = ends.find(|&(.., body)| is_reference(scene, body))?;
    Some(problem(scene, body, format!("joints[{i}].{key}"), "a joint", "rigid bodies"))
}
