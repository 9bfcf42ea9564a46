//! What is wrong or doubtful with a scene before it runs.
//!
//! [`problems`] finds mistakes that no run should start with; [`report`] says what the run will be: bodies, particles,
//! memory, steps, time, and whether its contacts are resolved by the grid.

mod accuracy;
mod bodies;
mod contact;
mod dead_keys;
mod effort;
mod flat;
mod hertz;
mod joint_freedom;
mod joints;
mod loads;
mod locking;
mod mass;
mod measurements;
mod memory;
mod neighbours;
mod overlap;
mod own_grid;
mod penetration;
mod periodic;
mod precision;
mod press_fit;
mod pulses;
mod reference;
mod report;
mod rigid_pairs;
mod rules;
mod settings;
mod shapes;
mod slits;
mod soil;
mod springs;
mod supports;
mod table;
mod thickness;
mod touch;
mod warning;

pub use accuracy::Errors;
pub use contact::{ContactEstimate, ContactResolution};
pub use effort::{OwnGridWork, Work};
pub use flat::lies_flat;
pub use hertz::{Hertz, HertzPatch};
pub use loads::LoadReport;
pub use memory::{BodySize, Footprint};
pub use own_grid::OwnGrid;
pub use press_fit::{Interference, interferences};
pub(crate) use reference::choose_interior;
pub use report::{BodyReport, MachineSpeed, MaterialReport, Report, report};
pub use rules::{RuleReport, pairs_without_friction};
pub use warning::Warning;

use crate::initial_stress;
use crate::scene::{Problem, Scene};

/// Finds what is wrong with a scene and takes its geometry to see.
///
/// # Errors
/// The first of: settings that allow no step, a material that is not stable, a domain whose walls miss the grid, motion
/// out of the plane, a shape that is not one or holds no particle, a body that deforms and is unbounded, what bodies
/// with interior = "reference" cannot have, a body outside the domain, one that a periodic domain cannot hold, two
/// bodies in one place, a free rigid body without an end, a joint far from its bodies, a stress that no deformation
/// gives, a load on nothing, a spring at nothing.
pub fn problems(scene: &Scene) -> Result<(), Problem> {
    examine(scene).map(|_| ())
}

/// Finds what is wrong, and returns each body's filling in numbers and where loads act.
fn examine(scene: &Scene) -> Result<(Vec<bodies::FillingExtent>, Vec<LoadReport>), Problem> {
    settings::check(scene)?;
    shapes::check(scene)?;
    measurements::check(scene)?;
    reference::check(scene)?;
    let extents = bodies::measure(scene)?;
    bodies::check_domain(scene, &extents)?;
    periodic::check(scene, &extents)?;
    mass::check(scene, &extents)?;
    // Where bodies begin elsewhere, whoever lets them begin looks.
    if scene.start.is_none() {
        overlap::check(scene, &extents)?;
        press_fit::check_press(scene)?;
    }
    precision::check(scene, &extents)?;
    joints::check(scene, &extents)?;
    joint_freedom::check(scene, &extents)?;
    springs::check(scene)?;
    (0..scene.bodies.len()).try_for_each(|body| initial_stress::check(scene, body))?;
    Ok((extents, loads::check(scene)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Bounds, Shape};
    use crate::material::{Isotropic, Material, NeoHookean};
    use crate::scene::*;

    /// An engine that takes 300 bytes a particle.
    struct Lean;

    impl Footprint for Lean {
        fn particles_around(&self, _scene: &Scene, _body: usize, _boxes: &[Bounds]) -> usize {
            0
        }
        fn memory(&self, _scene: &Scene, bodies: &[BodySize]) -> f64 {
            300.0 * bodies.iter().map(|body| body.particles).sum::<usize>() as f64
        }
        fn copy(&self, _scene: &Scene, bodies: &[BodySize]) -> f64 {
            200.0 * bodies.iter().map(|body| body.particles).sum::<usize>() as f64
        }
    }

    /// What the run will be with that engine.
    pub fn report(scene: &Scene) -> Result<Report, Problem> {
        crate::check::report(scene, &Lean)
    }

    pub fn neo_hookean(name: &str, factor: f64) -> NamedMaterial {
        let elastic = Isotropic { bulk_modulus: 6e6 * factor, shear_modulus: 3e6 * factor };
        let law = Material::NeoHookean(NeoHookean { elastic });
        NamedMaterial {
            name: name.into(),
            density: 1000.0 * factor,
            law,
            volume_change: Default::default(),
            thermal_expansion: 0.0,
        }
    }

    pub fn free(name: &str, material: usize, shape: Shape) -> Body {
        Body::new(name, material, shape)
    }

    /// A rigid body that does not move.
    pub fn at_rest(name: &str, shape: Shape) -> Body {
        Body::new(name, 1, shape).rigid([0.0; 3], [0.0; 3])
    }

    /// Bodies of two materials, the second ten times stiffer and denser, in unbounded space without gravity.
    pub fn scene(dimension: Dimension, cell: f64, bodies: Vec<Body>) -> Scene {
        let mut scene = Scene::new(dimension, cell, 2.0);
        scene.time.stress_update = StressUpdate::First;
        scene.outputs.tables = 0.1;
        scene.outputs.particles = None;
        scene.materials = vec![neo_hookean("soft", 1.0), neo_hookean("stiff", 10.0)];
        scene.bodies = bodies.into();
        scene
    }

    /// The paper's half sphere (R = 1.6 m, symmetry plane y = 0) at rest on a slope of 45 degrees.
    pub fn incline(cells_per_radius: f64) -> Scene {
        let (radius, cell) = (1.6, 1.6 / cells_per_radius);
        let ball = Shape::Ball { center: [2.4, 0.0, radius], radius };
        let half = Shape::HalfSpace { point: [0.0; 3], normal: [0.0, -1.0, 0.0] };
        let plane = Shape::Box { min: [0.0, 0.0, -1.6], max: [20.8, 3.2, 0.0] };
        let bodies = vec![free("sphere", 0, Shape::Intersection(vec![ball, half])), free("plane", 1, plane)];
        let mut scene = scene(Dimension::Space, cell, bodies);
        let slope = std::f64::consts::FRAC_PI_4;
        scene.gravity = [10.0 * slope.sin(), 0.0, -10.0 * slope.cos()].into();
        scene.domain = Some(Domain {
            min: [0.0, 0.0, -1.6],
            max: [20.8, 3.2, 4.8],
            faces: [[Face::Open; 2], [Face::Symmetry, Face::Open], [Face::Fixed, Face::Open]],
            leaving: Leaving::Stop,
        });
        scene
    }

    #[test]
    fn the_papers_incline_has_no_problem_at_any_resolution() {
        for cells_per_radius in [2.0, 4.0, 8.0, 12.0] {
            assert_eq!(problems(&incline(cells_per_radius)), Ok(()));
        }
    }
}
