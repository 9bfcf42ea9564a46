//! Stressed particles that cross cells with linear functions, whose slopes jump there.

use super::{Check, CheckInputs, Finding, exceeds, place};
use crate::door::TracedParticle;
use crate::scene::{BasisKind, HealthCheck, Scene};
use crate::tensor::{Matrix, Symmetric};

/// Counts the particles that have left their first cell while their body is under stress.
pub(super) struct CrossingCheck;

/// Stress over the stiffness against waves, below which jumps of the forces harm nobody.
const STRESSED: f64 = 1e-3;

impl Check for CrossingCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::CellCrossing
    }

    fn advice(&self, _: &Scene) -> &'static str {
        "forces jump at each crossing: take space.basis = \"gimp\""
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        match look.scene.discretization.basis {
            BasisKind::Linear => look.on_grid().filter_map(|body| crossing(look, body)).collect(),
            BasisKind::Gimp | BasisKind::Spline | BasisKind::Cubic => Vec::new(),
        }
    }
}

fn crossing(look: &CheckInputs, body: usize) -> Option<Finding> {
    let origin = look.scene.domain.as_ref().map_or([0.0; 3], |domain| domain.min);
    let size = look.scene.discretization.cell;
    let cell = |x: [f64; 3]| [0, 1, 2].map(|i| ((x[i] - origin[i]) / size).floor() as i64);
    let (start, now) = (&look.neighbours[body].start, &look.particles[body]);
    if now.is_empty() {
        return None;
    }
    let crossed: Vec<&TracedParticle> = now
        .iter()
        .zip(start)
        .filter(|(now, start)| cell(now.position) != cell(**start))
        .map(|it| it.0)
        .collect();
    let share = crossed.len() as f64 / now.len() as f64;
    // W = sigma^2 / 2 M per volume
    let state = &look.bodies[body];
    let density = look.scene.materials[look.scene.bodies[body].material].density;
    let stress = (2.0 * state.strain * density / (state.mass * look.wave_modulus(body))).sqrt();
    if !exceeds(share, look.bound(HealthCheck::CellCrossing)) || !exceeds(stress, STRESSED) {
        return None;
    }
    let most = crossed.into_iter().max_by(|a, b| strain(a).total_cmp(&strain(b)))?;
    let name = &look.scene.bodies[body].name;
    let message = format!(
        "{:.0} % of `{name}` crossed cells with linear functions under a stress of {stress:.1e} of its stiffness; \
         of them what is strained most is at {}",
        100.0 * share,
        place(most.position)
    );
    Some(Finding { body: Some(body), position: Some(most.position), worst: stress, message })
}

/// |F F^T - 1|^2 [-]
fn strain(particle: &TracedParticle) -> f64 {
    let strain = Matrix(particle.deformation).times_transpose() - Symmetric::isotropic(1.0);
    strain.double_dot(&strain)
}
