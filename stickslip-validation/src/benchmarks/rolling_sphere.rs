//! What B1 and B2 share: the paper's soft sphere on its plane, held against a rigid one.

use crate::benchmark::Case;
use crate::failure::CaseFailure;
use crate::measuring::{mean, slope};
use crate::outcome::Outcome;
use crate::scenery::with_parameter;
use crate::trial::Trial;
use stickslip::scene::Parameter;

/// What the sphere did.
pub struct Roll {
    /// Distance at the end over that of the rigid sphere.
    pub distance: f64,
    /// Speed at the end over that of the rigid sphere.
    pub speed: f64,
    /// Acceleration by least squares over the second half of the run over that of the rigid sphere at the end; infinite
    /// where that is zero.
    pub acceleration: f64,
    /// Way in the second half of the run over that of the rigid sphere.
    pub mean_speed: f64,
    /// Angle turned times radius over the way gone in the second half of the run: both oscillate about their means.
    pub rolling: f64,
    /// Mean height of the centre in the last four fifths of the run [m].
    pub height: f64,
    /// Side of a cell [m].
    pub cell: f64,
    /// Kinetic energy at the end over that at the start.
    pub kinetic: f64,
}

/// Rolls the sphere of one of the paper's scenes; the cells are those on its radius.
pub fn roll(name: &str, scene: &str, case: &Case, outcome: &mut Outcome) -> Result<Roll, CaseFailure> {
    let text = with_parameter(scene, "cells_per_radius", &case.cells.to_string());
    let mut trial = Trial::start(name, with_parameter(&text, "contact", &format!("\"{}\"", case.law)))?;
    let end = trial.scene().time.end;
    let (mut speeds, mut heights, mut middle, mut angle) = (Vec::new(), Vec::new(), None, 0.0);
    while trial.advance()? {
        let sphere = trial.bodies().swap_remove(0);
        if trial.time() > 0.5 * end {
            speeds.push((trial.time(), sphere.velocity[0]));
            if middle.is_some() {
                angle += sphere.spin[1] * trial.step_length();
            }
            middle.get_or_insert((trial.time(), sphere.position[0]));
        }
        if trial.time() > 0.2 * end {
            heights.push(sphere.position[2]);
        }
    }
    let sphere = trial.bodies().swap_remove(0);
    let scene = trial.scene();
    let Some(radius) = scene.parameters.get("radius").and_then(Parameter::number) else {
        return Err(CaseFailure::Absent("the scene has no radius"));
    };
    let exact = |quantity: &str, time: f64| {
        let stated = scene.references.iter().find(|reference| reference.quantity == quantity);
        stated.map_or(f64::NAN, |reference| reference.value.at(time))
    };
    let (half, from) = middle.ok_or(CaseFailure::Absent("the second half of the run"))?;
    let roll = Roll {
        distance: sphere.position[0] / exact("x", end),
        speed: sphere.velocity[0] / exact("vx", end),
        acceleration: slope(&speeds) / ((exact("vx", end) - exact("vx", 0.5 * end)) / (0.5 * end)),
        mean_speed: (sphere.position[0] - from) / (exact("x", end) - exact("x", half)),
        rolling: angle * radius / (sphere.position[0] - from),
        height: mean(&heights),
        cell: scene.discretization.cell,
        kinetic: sphere.kinetic / trial.first_ledger().kinetic,
    };
    outcome.include(trial);
    Ok(roll)
}
