//! Loads and supports, on something that is there.

use super::table::short;
use super::warning::Warning;
use crate::outside::GIVEN;
use crate::part;
use crate::scene::{Action, Dashpot, Extent, Load, Moment, Problem, Scene, SupportMotion};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::HashSet;

/// Where a load or a support acts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoadReport {
    /// Its name.
    pub name: String,
    /// Name of its body.
    pub body: String,
    /// Points on which it acts.
    pub points: usize,
    /// Their area [m^2], of a volume its volume [m^3]; in the plane per metre of depth.
    pub measure: f64,
    /// Unit of that.
    pub unit: &'static str,
    /// How far a support is away from its part when the run begins, at most [m].
    pub jumps: f64,
}

/// Where each acts, in the order of the scene.
///
/// # Errors
/// A load on a body that is not there or is rigid, or on a part where its body has nothing; one that needs a surface or
/// a volume on the other; a value that is no number at the start.
pub(super) fn check(scene: &Scene) -> Result<Vec<LoadReport>, Problem> {
    let keys = keys(scene);
    let mut heated = HashSet::new();
    for (load, key) in scene.loads.iter().zip(&keys) {
        if matches!(load.action, Action::Temperature(_)) && !heated.insert(load.body) {
            let name = scene.bodies.get(load.body).map_or("", |body| &body.name);
            return Err(Problem {
                key: format!("{key}.temperature"),
                found: format!("a second temperature of `{name}`"),
                allowed: "one for each body; its formula may tell places apart, by if(x0 < 1, 20, 50)"
                    .to_string(),
                help: None,
            });
        }
    }
    // Collected before the first problem is taken, so that it is the first in the scene and not the first in time.
    let all: Vec<_> = scene.loads.par_iter().zip(&keys).map(|(load, key)| report(scene, load, key)).collect();
    all.into_iter().collect()
}

/// The table of the file that each stands for.
pub(super) fn keys(scene: &Scene) -> Vec<String> {
    let (mut supports, mut loads) = (0, 0);
    let key = |load: &Load| {
        let (kind, number) =
            if load.is_support() { ("supports", &mut supports) } else { ("loads", &mut loads) };
        *number += 1;
        format!("{kind}[{}]", *number - 1)
    };
    scene.loads.iter().map(key).collect()
}

/// How far the displacement of a support is from none at the start, at most over its points [m].
fn jump(action: &Action, place: [f64; 3]) -> f64 {
    let Action::Support(support) = action else { return 0.0 };
    let start = Moment { time: 0.0, place, start: place, ..Moment::default() };
    let away = support.motion.iter().flatten().map(|motion| match motion {
        SupportMotion::Displacement(displacement) => displacement.at_moment(&start),
        SupportMotion::Velocity(_) => 0.0,
    });
    away.map(|away| away * away).sum::<f64>().sqrt()
}

/// A support that jumps: over the cell, this is more than what springs of supports give way by under any sound load.
const JUMP: f64 = 1e-3;

/// Supports that are not where their parts are when the run begins.
pub(super) fn warning(scene: &Scene, loads: &[LoadReport]) -> Option<Warning> {
    let far = |load: &&LoadReport| load.jumps > JUMP * scene.discretization.cell;
    let farthest = loads.iter().filter(far).max_by(|a, b| a.jumps.total_cmp(&b.jumps))?;
    Some(Warning::about(
        "supports",
        format!(
            "`{}` begins {} m away from its part of `{}`, which it pulls there at once: energies of the blow, and what \
             the step makes of it, stay in the ledger; let it grow from 0, such as by \" * min(t / 10 ms, 1)\"",
            farthest.name,
            short(farthest.jumps),
            farthest.body
        ),
    ))
}

fn report(scene: &Scene, load: &Load, key: &str) -> Result<LoadReport, Problem> {
    let problem = |part: &str, found: String, allowed: &str| Problem {
        key: format!("{key}.{part}"),
        found,
        allowed: allowed.to_string(),
        help: None,
    };
    let Some(body) = scene.bodies.get(load.body).filter(|body| match load.is_support() {
        true => !body.is_rigid(),
        false => !body.is_prescribed(),
    }) else {
        let found = scene
            .bodies
            .get(load.body)
            .map_or("no body".to_string(), |body| format!("rigid `{}`", body.name));
        return Err(problem("body", found, "a body that deforms"));
    };
    let on_volume = load.part.on == Extent::Volume;
    let per_area = match &load.action {
        Action::Pressure(_) | Action::Traction(_) => true,
        Action::Support(support) => support.dashpot == Some(Dashpot::Absorbing),
        Action::Force(_) | Action::Acceleration(_) | Action::Temperature(_) => false,
    };
    if on_volume && per_area {
        return Err(problem("on", "a volume".to_string(), "a surface: a volume has no area"));
    }
    if !on_volume && load.action.is_on_particles() {
        return Err(problem("on", "a surface".to_string(), "a volume: a surface has no mass"));
    }
    if let Some(value) = load.action.outside().filter(|value| value.function().is_none()) {
        let found = format!("the function `{}`, which is not given", value.name());
        return Err(problem(load.action.key(), found, GIVEN));
    }
    if matches!(load.action, Action::Temperature(_)) {
        let material = &scene.materials[body.material];
        if body.is_rigid() {
            return Err(problem("body", format!("rigid `{}`", body.name), "a body that deforms"));
        }
        if material.thermal_expansion == 0.0 {
            let found = format!("a temperature of `{}`, whose material does not expand by it", body.name);
            let allowed =
                format!("a body with a `thermal_expansion`: that of materials.{} is 0", material.name);
            return Err(problem("temperature", found, &allowed));
        }
    }
    let (mut first, mut points, mut measure, mut jumps) = (None, 0, 0.0, 0.0_f64);
    part::visit(scene, load.body, &load.part, &mut |point| {
        first.get_or_insert(point.position);
        points += 1;
        measure += point.measure;
        jumps = jumps.max(jump(&load.action, point.position));
    });
    let Some(first) = first else {
        let part = if load.part.within.is_some() { "within" } else { "on" };
        let nothing = problem(part, format!("no part of body `{}`", body.name), "a part that the body has");
        return Err(Problem {
            help: Some(format!(
                "places are those of the undeformed body at the start, with a point every {} m or so",
                short(scene.lattice(body).spacing)
            )),
            ..nothing
        });
    };
    let start = Moment { time: 0.0, place: first, start: first, ..Moment::default() };
    if let Some(value) =
        load.action.values().map(|value| value.at_moment(&start)).find(|value| !value.is_finite())
    {
        let found = format!("{value} at t = 0, x = {first:?} m");
        return Err(Problem { key: key.to_string(), ..problem("", found, "values that are numbers") });
    }
    let axes = scene.dimension.axes() - usize::from(!on_volume);
    Ok(LoadReport {
        name: load.name.clone(),
        body: body.name.clone(),
        points,
        measure,
        unit: ["m", "m", "m^2", "m^3"][axes],
        jumps,
    })
}
