//! What is wrong or doubtful with a scene, and what its run will cost: [`stickslip_scene::check`] for this engine.

pub use stickslip_scene::check::*;

use crate::scene::{Problem, Scene};
use stickslip_engine::footprint::OfEngine;

/// Finds what is wrong with a scene, else says what the run will be on this machine; see [`Report::on`] for another.
///
/// # Errors
/// As [`problems`].
pub fn report(scene: &Scene) -> Result<Report, Problem> {
    stickslip_scene::check::report(scene, &OfEngine)
}
