//! What is wrong or doubtful with a scene, and what its run will cost: [`stickslip_scene::check`] for this engine.

pub use stickslip_scene::check::*;

use crate::scene::{Problem, Scene};
use stickslip_engine::footprint::OfEngine;

/// Memory that the machine has free [bytes]; infinite where it does not say.
pub fn free_memory() -> f64 {
    let memory = sysinfo::MemoryRefreshKind::nothing().with_ram();
    let system = sysinfo::System::new_with_specifics(sysinfo::RefreshKind::nothing().with_memory(memory));
    let free = system.available_memory();
    let free = system.cgroup_limits().map_or(free, |limits| free.min(limits.free_memory));
    if free > 0 { free as f64 } else { f64::INFINITY }
}

/// Finds what is wrong with a scene, else says what the run will be on this machine; see [`Report::on`] for another.
///
/// # Errors
/// As [`problems`].
pub fn report(scene: &Scene) -> Result<Report, Problem> {
    stickslip_scene::check::report(scene, &OfEngine)
}
