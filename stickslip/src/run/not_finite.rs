//! Values that are not finite numbers: no check, table or frame is right from there on, and the run ends.

use crate::column::EVERY;
use crate::door::{BodyState, ContactSum, JointState, StepError, View};
use crate::observe::{BodyRow, CellValue, EnergyRow, TableRow};
use crate::scene::{Load, Scene};

/// The first value that is not finite in what the bodies and the ledger add up to, in what loads, joints and contact
/// gave, with the particle that has it, where one does.
pub(super) fn in_sums(scene: &Scene, view: &dyn View) -> Option<StepError> {
    let (what, body) =
        of_bodies(scene, view).or_else(|| of_forces(scene, view)).or_else(|| of_ledger(view))?;
    let of_body = body.and_then(|body| in_body(scene, (view, body), Looked::All));
    let bodies = || (0..scene.bodies.len()).find_map(|body| in_body(scene, (view, body), Looked::All));
    Some(of_body.or_else(bodies).unwrap_or_else(|| {
        let position = body.and_then(|body| view.bodies().get(body).map(|state| state.position));
        StepError::NoNumber { what, position: position.filter(|place| finite(place)), time: view.time() }
    }))
}

/// The first value that is not finite in what laws and heat remember of particles; all else each step looks at.
pub(super) fn in_histories(scene: &Scene, view: &dyn View) -> Option<StepError> {
    (0..scene.bodies.len()).find_map(|body| in_body(scene, (view, body), Looked::Own))
}

fn finite(values: &[f64]) -> bool {
    values.iter().all(|value| value.is_finite())
}

/// Columns of particles that are looked at.
#[derive(Clone, Copy, PartialEq)]
enum Looked {
    All,
    /// Those that not all bodies have.
    Own,
}

/// The first particle of a body with a value that is not finite.
fn in_body(scene: &Scene, (view, body): (&dyn View, usize), looked: Looked) -> Option<StepError> {
    let own = |name: &str| EVERY.iter().all(|every| every.name != name);
    let columns = view.columns(body).into_iter();
    let columns = columns.filter(|column| looked == Looked::All || own(column.name));
    let mut first: Option<(u32, &'static str)> = None;
    for column in columns {
        // The body has the columns that it says it has.
        let _ = view.visit_column(body, column.name, &mut |number, row| {
            if !finite(row) && first.is_none_or(|(known, _)| number < known) {
                first = Some((number, column.name));
            }
        });
    }
    let (number, column) = first?;
    let traced = view.trace(body, &[number]);
    let position = traced.first().map(|particle| particle.position).filter(|place| finite(place));
    let what = format!("`{column}` of particle {number} of body `{}`", scene.bodies[body].name);
    Some(StepError::NoNumber { what, position, time: view.time() })
}

/// The first column of a row whose number is not finite.
fn bad_column(mut row: impl TableRow) -> Option<&'static str> {
    let bad = |(name, value)| match value {
        CellValue::Number(number) if !number.is_finite() => Some(name),
        _ => None,
    };
    row.columns().into_iter().find_map(bad)
}

fn of_bodies(scene: &Scene, view: &dyn View) -> Option<(String, Option<usize>)> {
    let of_body = |(body, state): (usize, BodyState)| {
        let name = &scene.bodies[body].name;
        let column = bad_column(BodyRow { time: view.time(), body: name.clone(), state })?;
        Some((format!("`{column}` of body `{name}`"), Some(body)))
    };
    view.bodies().into_iter().enumerate().find_map(of_body)
}

fn of_forces(scene: &Scene, view: &dyn View) -> Option<(String, Option<usize>)> {
    let of_load = |(i, load): (usize, &Load)| {
        let state = *view.loads().get(i)?;
        let sound = finite(&state.impulse) && finite(&[state.work]);
        let name = &scene.bodies[load.body].name;
        (!sound).then(|| (format!("impulse or work of load {} on body `{name}`", i + 1), Some(load.body)))
    };
    let loads = scene.loads.iter().enumerate().find_map(of_load);
    let joints = || {
        let sound = |state: &JointState| finite(&state.impulse) && finite(&[state.work]);
        let place = view.joints().iter().position(|state| !sound(state))?;
        let name = scene.joint_names().nth(place).unwrap_or_default();
        Some((format!("impulse or work of joint `{name}`"), None))
    };
    let contacts = || {
        let bad = |sum: &ContactSum| !finite(&sum.impulse) || !sum.friction.is_finite();
        let sum = view.contact_sums().into_iter().find(bad)?;
        let [a, b] = sum.bodies.map(|body| &scene.bodies[body].name);
        Some((format!("impulse of contact between `{a}` and `{b}`"), Some(sum.bodies[0])))
    };
    loads.or_else(joints).or_else(contacts)
}

fn of_ledger(view: &dyn View) -> Option<(String, Option<usize>)> {
    let column = bad_column(EnergyRow { time: view.time(), ledger: view.ledger() })?;
    Some((format!("`{column}` of all bodies"), None))
}
