//! Soil that bears no tension, on shape functions by which particles next to each other do not press alike.

use super::warning::{Warning, and_more};
use crate::material::Material;
use crate::scene::{BasisKind, Interior, Scene};

/// Deforming bodies on the common grid whose particles open where they are pulled, by functions with kinks. Measured:
/// chapter 4 of the book, `drucker_prager`, and the test of sand in `famous.rs`; nothing is for `spline`.
pub(super) fn warning(scene: &Scene) -> Option<Warning> {
    if scene.discretization.basis == BasisKind::Cubic {
        return None;
    }
    let loose = |&body: &usize| {
        let law = &scene.materials[scene.bodies[body].material].law;
        opens(law) && !scene.bodies[body].is_rigid() && scene.interior(body) == Interior::Grid
    };
    let loose: Vec<_> = (0..scene.bodies.len()).filter(loose).collect();
    let first = *loose.first()?;
    Some(Warning::about(
        format!("bodies[{first}].material"),
        format!(
            "soil that bears no tension: of {} particles that have flowed rest side by side with unlike volumes, and \
             the larger ones bear nothing (in a column of sand that collapsed, with 20 cells along its side, 41 % of \
             those inside by `gimp` and `apic`); space.basis = \"cubic\" and time.transfer = \"apic\" leave 5 %",
            and_more(&format!("`{}`", scene.bodies[first].name), loose.len() - 1),
        ),
    ))
}

/// Whether particles of this law keep a gap where they are pulled apart.
fn opens(law: &Material<f64>) -> bool {
    match law {
        Material::DruckerPrager(law) => law.cohesion == 0.0 || law.tension_strength == Some(0.0),
        Material::MohrCoulomb(law) => law.cohesion == 0.0 || law.tension_strength == Some(0.0),
        Material::MuI(_) => true,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    fn told(law: &str, space: &str) -> bool {
        let text = format!(
            "time.end = 1\n\
             [space]\n\
             dimension = 'plane-strain'\n\
             interior = 'grid'\n\
             cell = 0.1\n\
             {space}\n\
             [materials.soil]\n\
             density = 1600\n\
             {law}\n\
             [[bodies]]\n\
             name = 'heap'\n\
             material = 'soil'\n\
             shape.box = {{ min = [0, 0], max = [1, 1] }}\n"
        );
        let scene = crate::scene::parse("a.toml", &text, &[]).expect("a scene").scene;
        super::warning(&scene).is_some()
    }

    #[test]
    fn soil_without_tension_is_told_of_unless_its_functions_are_cubic() {
        let sand = "drucker_prager = { young_modulus = 1e6, poisson_ratio = 0.3, friction_angle = '30 deg' }";
        let clay = "mohr_coulomb = { young_modulus = 1e6, poisson_ratio = 0.3, friction_angle = '30 deg', cohesion = 1e3 }";
        assert!(told(sand, ""));
        assert!(told(sand, "basis = 'spline'"));
        assert!(!told(sand, "basis = 'cubic'"));
        assert!(!told(clay, ""));
        assert!(told(&clay.replace("1e3 }", "1e3, tension_strength = 0 }"), ""));
    }
}
