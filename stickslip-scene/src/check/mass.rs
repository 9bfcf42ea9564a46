//! Bodies whose particles have another mass than their shapes: those that their lattice does not fit.

use super::bodies::{FillingExtent, smallest_extent};
use super::table::short;
use super::warning::{Warning, and_more};
use crate::geometry::{Arrangement, Curved, Shape, SiteLattice, fits};
use crate::scene::{Problem, Scene};
use rayon::prelude::*;

/// Share of its mass by which a body may be off without a word: what stairs make of a ball of four cells a radius.
const TOLD: f64 = 0.03;
/// Share by which it may be off at all: a row of particles then is half as thick again as the body.
const REFUSED: f64 = 0.5;

/// Finer sites along a side of a particle by which the volume of combined shapes is measured, and particles of a body
/// up to which it is: of more, what lies between them is little.
const FINER: f64 = 5.0;
const MOST: usize = 20_000;

/// # Errors
/// A body that deforms and whose particles have more than half its mass too much; specks of images may.
pub(super) fn check(scene: &Scene, extents: &[FillingExtent]) -> Result<(), Problem> {
    let drawn = |body: usize| match &scene.bodies[body].shape {
        Shape::Curved(curved) => !matches!(curved, Curved::Image(_) | Curved::PointCloud(_)),
        _ => true,
    };
    let all = worst(scene, extents);
    let Some(&(body, off)) = all.iter().find(|&&(body, off)| off > REFUSED && drawn(body)) else {
        return Ok(());
    };
    let of = &scene.bodies[body];
    let lattice = scene.lattice(of);
    Err(Problem {
        key: format!("bodies[{body}].shape"),
        found: format!(
            "`{}`, whose particles on a lattice of {} m have {:.2} times its mass",
            of.name,
            short(lattice.spacing),
            1.0 + off
        ),
        allowed: format!("a body whose particles have at most {:.1} times its mass", 1.0 + REFUSED),
        help: Some(remedy(scene, body)),
    })
}

/// Bodies that deform and whose particles' mass is off by more than a few per cent.
pub(super) fn warning(scene: &Scene, extents: &[FillingExtent]) -> Option<Warning> {
    let off = worst(scene, extents);
    let (body, most) = *off.first()?;
    let named = and_more(&format!("`{}`", scene.bodies[body].name), off.len() - 1);
    Some(Warning::about(
        format!("bodies[{body}].shape"),
        format!(
            "the particles of {named} do not fit the shape: their mass is off, at most by {:+.1} %; {}",
            100.0 * most,
            remedy(scene, body)
        ),
    ))
}

/// What to write for a body that its lattice does not fit.
fn remedy(scene: &Scene, body: usize) -> String {
    let (of, axes) = (&scene.bodies[body], scene.dimension.axes());
    // Ten particles through it: stairs are within a tenth.
    let cell = 0.1 * smallest_extent(&of.shape, axes) * scene.per_side(of);
    match fits(&of.shape, axes) {
        true => "particles = \"fitted\" beside its shape gives it its exact mass".to_string(),
        false => format!(
            "put its faces on the lattice of particles, {} m, or take cells of {} m",
            short(scene.lattice(of).spacing),
            short(cell.min(0.5 * scene.discretization.cell))
        ),
    }
}

/// Bodies whose mass is off by more than is left without a word, the worst first, with the share by which it is.
fn worst(scene: &Scene, extents: &[FillingExtent]) -> Vec<(usize, f64)> {
    let on_lattice = |&body: &usize| {
        let of = &scene.bodies[body];
        of.particles == Arrangement::Lattice && !of.is_rigid()
    };
    let off = |body: usize| {
        let of = &scene.bodies[body];
        let lattice = scene.lattice(of);
        let exact = match of.shape.volume(lattice.dimension) {
            Some(volume) => volume,
            None if extents[body].particles <= MOST => measured(scene, body)?,
            None => return None,
        };
        let filled = extents[body].mass / scene.materials[of.material].density;
        let off = filled / exact - 1.0;
        (off.is_finite() && off.abs() > TOLD).then_some((body, off))
    };
    let mut all: Vec<(usize, f64)> =
        (0..scene.bodies.len()).into_par_iter().filter(on_lattice).filter_map(off).collect();
    all.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()).then(a.0.cmp(&b.0)));
    all
}

/// The volume of a body's shape by sites that are finer than its particles [m^3], in the plane its area [m^2].
fn measured(scene: &Scene, body: usize) -> Option<f64> {
    let of = &scene.bodies[body];
    let lattice = scene.lattice(of);
    let finer = SiteLattice { spacing: lattice.spacing / FINER, ..lattice };
    Some(finer.volume() * finer.sites_inside(&of.shape)?.count() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::bodies::measure;
    use crate::check::tests::{free, scene};
    use crate::scene::Dimension;

    /// Cells of 10 mm, particles 5 mm apart.
    fn strip(y: [f64; 2]) -> Scene {
        let shape = Shape::Box { min: [0.0, y[0], 0.0], max: [0.1, y[1], 0.0] };
        scene(Dimension::PlaneStrain, 0.01, vec![free("strip", 0, shape)])
    }

    fn said(scene: &Scene) -> Result<Option<String>, Problem> {
        let extents = measure(scene).expect("filled");
        check(scene, &extents).map(|()| warning(scene, &extents).map(|warning| warning.text))
    }

    /// 1 mm around a row of particles of 5 mm.
    #[test]
    fn a_body_thinner_than_its_lattice_is_refused_with_the_way_out() {
        let problem = said(&strip([0.002, 0.003])).expect_err("five times too heavy");
        assert!(problem.found.ends_with("have 5.00 times its mass"), "{problem}");
        assert!(problem.help.expect("a way out").contains("particles = \"fitted\""));
    }

    /// 33.7 mm get seven rows, 35 mm.
    #[test]
    fn a_mass_that_is_off_by_per_cents_is_told_with_the_figure() {
        let text = said(&strip([0.0, 0.0337])).expect("allowed").expect("told");
        assert!(text.contains("at most by +3.9 %"), "{text}");
        assert_eq!(said(&strip([0.0, 0.035])), Ok(None));
        let mut fitted = strip([0.002, 0.003]);
        fitted.bodies[0].particles = Arrangement::Fitted;
        assert_eq!(said(&fitted), Ok(None));
    }

    /// A strip of 3 mm cut out of a larger one, and one cut along the lattice.
    #[test]
    fn combined_shapes_are_measured() {
        let cut = |thickness: f64| {
            let all = Shape::Box { min: [0.0; 3], max: [0.1, 0.1, 0.0] };
            let rest = Shape::HalfSpace { point: [0.0, thickness, 0.0], normal: [0.0, 1.0, 0.0] };
            let shape = Shape::Intersection(vec![all, rest]);
            scene(Dimension::PlaneStrain, 0.01, vec![free("cut", 0, shape)])
        };
        assert!(said(&cut(0.003)).is_err());
        assert_eq!(said(&cut(0.02)), Ok(None));
    }
}
