//! Nearly incompressible materials, in which the grid resists more than the material does.

use super::thickness::thickness;
use super::warning::{Warning, and_more};
use crate::scene::{BasisKind, Dimension, Interior, Scene, VolumeChange};
use rayon::prelude::*;

/// Above this Poisson's ratio forces come out too high by per cents: see the benchmark `punch`.
const LOCKS: f64 = 0.49;

/// Materials of deformable bodies whose Poisson's ratio is close to 0.5. A thin plate in plane stress is free to keep
/// its volume, and does not lock.
pub(super) fn warning(scene: &Scene) -> Option<Warning> {
    if scene.dimension == Dimension::PlaneStress {
        return None;
    }
    let deforms = |material: usize| {
        let of = |body: &&crate::scene::Body| body.material == material;
        scene.bodies.iter().filter(of).any(|body| !body.is_rigid())
    };
    let own = |material: usize| scene.materials[material].volume_change == VolumeChange::Own;
    let ratio = |material: usize| scene.materials[material].law.elastic().poisson_ratio();
    let close: Vec<_> =
        (0..scene.materials.len()).filter(|&i| ratio(i) > LOCKS + 1e-9 && deforms(i) && own(i)).collect();
    let closest = *close.iter().max_by(|&&a, &&b| ratio(a).total_cmp(&ratio(b)))?;
    let name = &scene.materials[closest].name;
    let elastic = scene.materials[closest].law.elastic();
    Some(Warning::about(
        format!("materials.{name}"),
        format!(
            "nearly incompressible: {} has a Poisson's ratio of {:.6} (K/G = {:.0}); the cells lock, \
             and it is stiffer than it should be: at 0.4999 a punch meets twice the force with 8 cells under it; take \
             volume_change = \"averaged\" for it, which resists as it should, or a ratio of 0.49 (K = {LIMIT:.0} G) \
             if its compressibility does not matter",
            and_more(&format!("`{name}`"), close.len() - 1),
            ratio(closest),
            elastic.bulk_modulus / elastic.shear_modulus,
            LIMIT = 2.0 * (1.0 + LOCKS) / (3.0 * (1.0 - 2.0 * LOCKS)),
        ),
    ))
}

/// Above this Poisson's ratio what bends is too stiff already, where few cells lie across it.
const BENDS_STIFFLY: f64 = 0.4;
/// The same of bodies on grids of their own: a clamped beam of length 8 and thickness 1 in plane strain sags under its
/// weight in the mean, of what it does by 16 cells, by 0.986 at 0.45 with two cells across, and at 0.49 by 0.83, 0.89,
/// 0.94 and 0.99 with two, three, four and eight. Chapter 3 of the book has what the messages say.
const BENDS_STIFFLY_ON_OWN_GRID: f64 = 0.45;
/// Cells across a body from which on that is a matter of per cents up to a ratio of 0.49.
const ENOUGH: f64 = 8.0;

/// Bodies of few cells across and with a Poisson's ratio from 0.4 to 0.49, which do not bend as they should.
pub(super) fn bending(scene: &Scene) -> Option<Warning> {
    if scene.dimension == Dimension::PlaneStress {
        return None;
    }
    let by_splines = matches!(scene.discretization.basis, BasisKind::Spline | BasisKind::Cubic);
    let on_own_grid = |body: usize| scene.interior(body) == Interior::Reference;
    let cell = |body: usize| scene.cell(&scene.bodies[body]);
    let material = |body: usize| &scene.materials[scene.bodies[body].material];
    let ratio = |body: usize| material(body).law.elastic().poisson_ratio();
    let stiff = |&body: &usize| {
        let least = match on_own_grid(body) {
            true => BENDS_STIFFLY_ON_OWN_GRID,
            false if by_splines => return false,
            false => BENDS_STIFFLY,
        };
        let between = ratio(body) > least + 1e-9 && ratio(body) <= LOCKS + 1e-9;
        between && !scene.bodies[body].is_rigid() && material(body).volume_change == VolumeChange::Own
    };
    let thin: Vec<_> = (0..scene.bodies.len())
        .into_par_iter()
        .filter(stiff)
        .filter_map(|body| Some((body, thickness(scene, body, ENOUGH * cell(body))?)))
        .collect();
    let (body, thickness) = *thin.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let measured = match on_own_grid(body) {
        true => {
            "a beam of two cells sags by 0.83 of what it should at 0.49, of four by 0.94 and of eight by 0.99; take \
             volume_change = \"averaged\" for its material (two cells 0.94, four 0.98), or smaller cells"
        }
        false => {
            "a beam of four cells sags by 0.93 of what it should at 0.4, by 0.89 at 0.45 and by 0.65 at 0.49, one of \
             eight by 0.83 at 0.49 (gimp); take volume_change = \"averaged\" for its material (0.92), smaller cells, \
             or space.basis = \"spline\" (0.97 at 0.49), by which what rolls or swings for long loses its motion"
        }
    };
    Some(Warning::about(
        format!("bodies[{body}].material"),
        format!(
            "a Poisson's ratio of {:.3} with {:.1} cells across: {} bends too stiffly; {measured}; if it does not \
             bend, this does no harm",
            ratio(body),
            thickness / cell(body),
            and_more(&format!("`{}`", scene.bodies[body].name), thin.len() - 1),
        ),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::tests::{at_rest, free, scene};
    use crate::geometry::Shape;
    use crate::material::{Isotropic, Material, NeoHookean};

    #[test]
    fn a_deformable_body_above_a_ratio_of_0_49_is_told_of() {
        let disk = || Shape::Ball { center: [0.0; 3], radius: 1.0 };
        let with = |nu: f64, dimension, rigid: bool| {
            let body = if rigid { at_rest("it", disk()) } else { free("it", 1, disk()) };
            let mut scene = scene(dimension, 0.1, vec![body]);
            let elastic =
                Isotropic { bulk_modulus: 2.0 * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu)), shear_modulus: 1.0 };
            scene.materials[1].law = Material::NeoHookean(NeoHookean { elastic });
            warning(&scene).map(|warning| warning.to_string())
        };
        let strain = Dimension::PlaneStrain;
        let text = with(0.4999, strain, false).expect("it locks");
        assert!(text.starts_with("materials.stiff: nearly incompressible: `stiff` has"), "{text}");
        assert!(text.contains("0.499900") && text.contains("averaged"), "{text}");
        assert_eq!(with(0.49, strain, false), None);
        assert_eq!(with(0.4999, strain, true), None);
        assert_eq!(with(0.4999, Dimension::PlaneStress, false), None);
    }

    #[test]
    fn what_bends_with_few_cells_across_is_told_of_from_a_ratio_of_0_4_on() {
        let with = |nu: f64, dimension, cells: f64| {
            let bar = Shape::cuboid([0.0; 3], [4.0, 1.0, 1.0]);
            let mut scene = scene(dimension, 1.0 / cells, vec![free("bar", 1, bar)]);
            let elastic =
                Isotropic { bulk_modulus: 2.0 * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu)), shear_modulus: 1.0 };
            scene.materials[1].law = Material::NeoHookean(NeoHookean { elastic });
            bending(&scene).map(|warning| warning.to_string())
        };
        let strain = Dimension::PlaneStrain;
        let text = with(0.45, strain, 4.0).expect("it is too stiff");
        assert!(text.contains("ratio of 0.450 with 4.0 cells across: `bar` bends too stiffly"), "{text}");
        assert!(with(0.49, strain, 6.0).is_some());
        assert_eq!(with(0.4, strain, 4.0), None);
        assert_eq!(with(0.45, strain, 10.0), None);
        assert_eq!(with(0.4999, strain, 4.0), None, "the other warning is of these");
        assert_eq!(with(0.45, Dimension::PlaneStress, 4.0), None);
    }

    #[test]
    fn on_a_grid_of_its_own_less_is_too_stiff() {
        let with = |nu: f64, cells: f64| {
            let bar = Shape::cuboid([0.0; 3], [4.0, 1.0, 1.0]);
            let mut scene = scene(Dimension::PlaneStrain, 1.0 / cells, vec![free("bar", 1, bar)]);
            scene.discretization.interior = Interior::Reference;
            let elastic =
                Isotropic { bulk_modulus: 2.0 * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu)), shear_modulus: 1.0 };
            scene.materials[1].law = Material::NeoHookean(NeoHookean { elastic });
            bending(&scene).map(|warning| warning.to_string())
        };
        assert_eq!(with(0.45, 4.0), None);
        assert!(with(0.48, 4.0).is_some_and(|text| text.contains("of four by 0.94")));
        assert_eq!(with(0.48, 10.0), None);
    }
}
