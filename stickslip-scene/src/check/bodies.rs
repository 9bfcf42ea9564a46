//! Bodies as their particles show them: how many, how large, and whether the domain holds them.

use super::own_grid::{OwnGrid, filled};
use super::table::short;
use crate::geometry::{self, Arrangement, Bounds, ParticleSite, Shape};
use crate::scene::{Face, Problem, Scene};
use rayon::prelude::*;

/// Particles are numbered with 32 bits in their body, and take hundreds of bytes.
const MOST_SITES: f64 = 1e9;

/// Cells from the grid's origin along an axis; the grid numbers its blocks that far and a little further.
const MOST_CELLS: f64 = 4e6;

/// Particles may lie outside the domain by this share of their spacing.
const ROUND_OFF: f64 = 1e-6;

/// The filling of a body in numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct FillingExtent {
    /// Number of particles.
    pub particles: usize,
    /// Mass of all particles [kg], in the plane per metre of depth.
    pub mass: f64,
    /// Holds all particles with their width [m].
    pub bounds: Bounds,
    /// Holds all particles' centres [m].
    pub centers: Bounds,
    /// Centre of mass, of a body without bounds the point about which it turns [m].
    pub center: [f64; 3],
    /// Its grid, if it has one of its own, without points of its surface.
    pub grid: Option<OwnGrid>,
}

impl FillingExtent {
    /// Of a rigid body without bounds.
    fn unbounded(center: [f64; 3]) -> FillingExtent {
        FillingExtent {
            particles: 0,
            mass: 0.0,
            bounds: Bounds::EVERYTHING,
            centers: Bounds::EVERYTHING,
            center,
            grid: None,
        }
    }
}

/// Each body's extent, in the order of the scene.
pub(super) fn measure(scene: &Scene) -> Result<Vec<FillingExtent>, Problem> {
    // Collected before the first problem is taken, so that it is the first in the scene and not the first in time.
    let all: Vec<_> = (0..scene.bodies.len()).into_par_iter().map(|i| measure_body(scene, i)).collect();
    all.into_iter().collect()
}

fn measure_body(scene: &Scene, i: usize) -> Result<FillingExtent, Problem> {
    let body = &scene.bodies[i];
    let lattice = scene.lattice(body);
    // Only rigid bodies may be without bounds; those have particles where others come near.
    let Some(bounds) = body.shape.bounds(lattice.dimension) else {
        return Ok(FillingExtent::unbounded(body.shape.anchor(lattice.dimension)));
    };
    let sites = lattice.sites(&bounds);
    if sites > MOST_SITES {
        return Err(Problem {
            key: "space.cell".into(),
            found: format!(
                "cells of {} m, {sites:.1e} particle sites in body `{}`",
                short(scene.cell(body)),
                body.name
            ),
            allowed: format!("at most {MOST_SITES:.1e} sites in a body"),
            help: Some("are the units of the cell and the shape right?".into()),
        });
    }
    let cell = scene.discretization.cell;
    let reach = (0..lattice.dimension)
        .flat_map(|k| [bounds.min[k] - lattice.origin[k], bounds.max[k] - lattice.origin[k]])
        .fold(0.0_f64, |reach, x| reach.max(x.abs()));
    if reach.is_finite() && reach > MOST_CELLS * cell {
        return Err(Problem {
            key: format!("bodies[{i}].shape"),
            found: format!("`{}` reaches {:.1e} cells from the grid's origin", body.name, reach / cell),
            allowed: format!("at most {MOST_CELLS:.0e} cells"),
            help: Some("put the corner space.domain.min near the bodies: the grid starts there".into()),
        });
    }
    let mut extent = FillingExtent {
        particles: 0,
        mass: 0.0,
        bounds: Bounds::EMPTY,
        centers: Bounds::EMPTY,
        center: [0.0; 3],
        grid: None,
    };
    let (mut moment, mut whole) = ([0.0; 3], 0.0);
    let density = scene.materials[body.material].density;
    // Shapes without bounds are refused before.
    let all: Option<Box<dyn Iterator<Item = ParticleSite>>> = match scene.arrangement(body) {
        Arrangement::Parts(faces) => filled(scene, body, faces).map(|(sites, grid)| {
            extent.grid = Some(grid);
            Box::new(sites.into_iter()) as _
        }),
        arrangement => geometry::sites(&body.shape, &lattice, arrangement),
    };
    let Some(all) = all else {
        return Err(match bounds.is_empty() {
            true => no_particles(scene, i, &bounds),
            false => Problem {
                key: format!("bodies[{i}].shape"),
                found: format!("`{}`, over which no grid of its own fits", body.name),
                allowed: "a shape that is two cells thick and more; or interior = \"grid\"".to_string(),
                help: None,
            },
        });
    };
    for ParticleSite { position, volume, half_width } in all {
        extent.particles += 1;
        extent.mass += volume * density;
        whole += volume;
        moment = std::array::from_fn(|k| moment[k] + volume * position[k]);
        extent.centers = extent.centers.united(&Bounds { min: position, max: position });
        let reach = |sign: f64| {
            std::array::from_fn(|k| position[k] + if k < lattice.dimension { sign * half_width } else { 0.0 })
        };
        extent.bounds = extent.bounds.united(&Bounds { min: reach(-1.0), max: reach(1.0) });
    }
    if extent.particles == 0 {
        return Err(no_particles(scene, i, &bounds));
    }
    extent.center = moment.map(|x| x / whole);
    Ok(extent)
}

fn no_particles(scene: &Scene, i: usize, bounds: &Bounds) -> Problem {
    let body = &scene.bodies[i];
    let lattice = scene.lattice(body);
    let thickness = smallest_extent(&body.shape, lattice.dimension);
    let (found, help) = if bounds.is_empty() {
        (
            format!("`{}` is empty: no point is inside", body.name),
            "do the shapes that are combined meet?".into(),
        )
    } else {
        let found = format!(
            "`{}` holds no particle: it is {thickness:.4} m across, particles are {:.4} m apart",
            body.name, lattice.spacing
        );
        // Two particles through the thickness.
        let cell = 0.5 * thickness * scene.per_side(body);
        (found, format!("take cells of at most {cell:.3e} m, or a larger shape"))
    };
    Problem {
        key: format!("bodies[{i}].shape"),
        found,
        allowed: "a shape with room for particles".into(),
        help: Some(help),
    }
}

/// Smallest side of a shape's box [m], in the shape's own frame if it is turned.
pub(super) fn smallest_extent(shape: &Shape, dimension: usize) -> f64 {
    match shape {
        Shape::Rotated { shape, .. } => smallest_extent(shape, dimension),
        Shape::Cylinder { start, end, radius } => {
            let length: f64 = (0..3).map(|k| (end[k] - start[k]).powi(2)).sum();
            length.sqrt().min(2.0 * radius)
        }
        shape => {
            let size = shape.bounds(dimension).map_or([f64::INFINITY; 3], |bounds| bounds.size());
            size[..dimension].iter().fold(f64::INFINITY, |a, &b| a.min(b))
        }
    }
}

/// Refuses a body with particles' centres outside the domain, where a step would refuse them.
pub(super) fn check_domain(scene: &Scene, extents: &[FillingExtent]) -> Result<(), Problem> {
    let Some(domain) = &scene.domain else { return Ok(()) };
    for (i, extent) in extents.iter().enumerate().filter(|(_, extent)| extent.bounds.is_finite()) {
        let lattice = scene.lattice(&scene.bodies[i]);
        for k in (0..lattice.dimension).filter(|&k| !domain.is_periodic(k)) {
            let sides = [
                (extent.bounds.min[k], extent.centers.min[k], domain.min[k], -1.0, "below its lower"),
                (extent.bounds.max[k], extent.centers.max[k], domain.max[k], 1.0, "above its upper"),
            ];
            for (reach, center, at, outward, side) in sides {
                if outward * (center - at) > -ROUND_OFF * lattice.spacing {
                    let beyond = outward * (reach - at);
                    let axis = ["x", "y", "z"][k];
                    return Err(Problem {
                        key: format!("bodies[{i}].shape"),
                        found: format!(
                            "`{}` leaves the domain: it reaches {beyond:.4} m {side} {axis} face at {at} m",
                            scene.bodies[i].name
                        ),
                        allowed: "bodies inside the domain".into(),
                        help: Some(match domain.faces[k][usize::from(outward > 0.0)] {
                            Face::Symmetry => "make the domain larger, move the body, or let the mirror cut it: \
                                               beyond_mirrors = \"cut\""
                                .into(),
                            _ => "make the domain larger, move the body, or cut it at the face with a half-space"
                                .to_string(),
                        }),
                    });
                }
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::tests::{free, incline, scene};
    use crate::scene::Dimension;

    fn ball(x: f64, radius: f64) -> Shape {
        Shape::Ball { center: [x, 0.05, 0.05], radius }
    }

    #[test]
    fn a_box_has_its_exact_particles_mass_and_bounds() {
        let plane = &measure(&incline(4.0)).expect("no problem")[1];
        assert_eq!(plane.particles, 104 * 16 * 8);
        assert!((plane.mass / (20.8 * 3.2 * 1.6 * 1e4) - 1.0).abs() < 1e-12);
        let exact = [20.8, 3.2, 1.6];
        assert!((0..3).all(|k| (plane.bounds.size()[k] - exact[k]).abs() < 1e-12));
    }

    #[test]
    fn a_body_without_particles_is_told_which_cells_would_do() {
        let small = || free("grain", 0, ball(0.0, 0.01));
        let problem = measure(&scene(Dimension::Space, 0.1, vec![small()])).expect_err("between the sites");
        assert_eq!(problem.key, "bodies[0].shape");
        assert!(problem.found.contains("`grain`") && problem.found.contains("0.0500 m apart"), "{problem}");
        assert!(problem.help.expect("a cell").contains("2.000e-2"));
        assert!(measure(&scene(Dimension::Space, 0.02, vec![small()])).is_ok());
    }

    #[test]
    fn an_empty_shape_and_a_cell_of_the_wrong_unit_are_told_apart() {
        let nothing = Shape::Intersection(vec![ball(0.0, 0.4), ball(1.0, 0.4)]);
        let problem =
            measure(&scene(Dimension::Space, 0.1, vec![free("it", 0, nothing)])).expect_err("empty");
        assert!(problem.found.contains("empty"), "{problem}");
        let huge = scene(Dimension::Space, 1e-5, vec![free("it", 0, ball(0.0, 1.0))]);
        assert_eq!(measure(&huge).expect_err("8e15 sites").key, "space.cell");
    }

    #[test]
    fn a_body_far_from_the_grids_origin_is_refused() {
        for (x, allowed) in [(3e5, true), (1e6, false), (-1e12, false)] {
            let far = scene(Dimension::Space, 0.1, vec![free("far", 0, ball(x, 1.0))]);
            assert_eq!(measure(&far).is_ok(), allowed, "{x}");
        }
    }

    #[test]
    fn a_body_beyond_a_face_is_told_which_and_by_how_much() {
        let mut scene = incline(4.0);
        scene.bodies[1].shape = Shape::Box { min: [0.0, 0.0, -1.6], max: [21.2, 3.2, 0.0] };
        let extents = measure(&scene).expect("filled");
        let problem = check_domain(&scene, &extents).expect_err("0.4 m too long");
        assert_eq!(problem.key, "bodies[1].shape");
        assert!(problem.found.contains("0.4000 m above its upper x face at 20.8 m"), "{problem}");
    }
}
