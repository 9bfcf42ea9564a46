//! Nearly incompressible materials, in which the grid resists more than the material does.

use super::warning::{Warning, and_more};
use crate::scene::{Dimension, Scene, VolumeChange};

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
}
