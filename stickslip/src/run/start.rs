//! Scenes whose bodies begin as another run left them.

use super::ResumeError;
use super::origin::Origin;
use crate::door::Simulation;
use crate::observe::{BegunFrom, Memory};
use crate::scene::{BodyMotion, Scene};
use std::collections::HashSet;
use std::fmt::{self, Display, Formatter};
use std::path::PathBuf;

/// Which bodies of a scene begin as another run left them.
#[derive(Clone, Debug, PartialEq)]
pub struct CarriedBodies {
    /// The checkpoint or the snapshot from which they come.
    pub from: PathBuf,
    /// Whether it is a snapshot, which is rounded and knows less.
    pub rounded: bool,
    /// Simulated time there [s].
    pub time: f64,
    /// The [`state_sum`](crate::observe::state_sum) of what was read.
    pub sum: String,
    /// How many bodies begin so, and how many the scene has.
    pub count: [usize; 2],
    /// Names of those of the scene that are not there, and begin as their shapes are filled.
    pub new: Vec<String>,
    /// Names of those there that the scene does not have.
    pub left_out: Vec<String>,
    /// Newer checkpoints there, which cannot be read.
    pub damaged: Vec<PathBuf>,
    /// Names of those whose velocities in the scene are passed over.
    pub passed_over: Vec<String>,
}

/// Lets bodies begin as another run left them, if the scene asks for it and no step is taken yet.
///
/// # Errors
/// The other run cannot be read, or has other bodies of these names; then nothing is changed.
pub fn begin(scene: &Scene, simulation: &mut dyn Simulation) -> Result<Option<CarriedBodies>, ResumeError> {
    Ok(carry(scene, simulation)?.map(|(carried, _)| carried))
}

/// What another run remembered of its bodies, and their names there.
pub(super) type Remembered = (Memory, Vec<String>);

/// [`begin`], with what the other run remembered, where that is known.
pub(super) fn carry(
    scene: &Scene,
    simulation: &mut dyn Simulation,
) -> Result<Option<(CarriedBodies, Option<Remembered>)>, ResumeError> {
    let Some(start) = scene.start.as_ref().filter(|_| simulation.steps() == 0) else { return Ok(None) };
    let origin = Origin::of(scene, start, &*simulation)?;
    let sum = origin.begin(simulation, start.velocities)?;
    let Origin { state, from, is_snapshot, memory, damaged, .. } = origin;

    let names: Vec<String> = state.bodies.iter().map(|body| body.name.clone()).collect();
    let there: HashSet<&str> = names.iter().map(String::as_str).collect();
    let here: HashSet<&str> = scene.bodies.iter().map(|body| body.name.as_str()).collect();
    let (carried, new): (Vec<_>, Vec<_>) =
        scene.bodies.iter().partition(|body| there.contains(body.name.as_str()));
    let moves = |body: &crate::scene::Body| match &body.motion {
        BodyMotion::Free { velocity, spin } => {
            body.velocity_by_place.is_some() || [velocity, spin].iter().any(|of| **of != [0.0; 3])
        }
        BodyMotion::FreeRigid(free) => [free.velocity, free.spin].iter().any(|of| *of != [0.0; 3]),
        BodyMotion::Rigid { .. } => false,
    };
    let named = |bodies: &mut dyn Iterator<Item = &crate::scene::Body>| {
        bodies.map(|body| body.name.clone()).collect::<Vec<String>>()
    };
    let bodies = CarriedBodies {
        from,
        rounded: is_snapshot,
        time: state.time,
        sum,
        count: [carried.len(), scene.bodies.len()],
        new: named(&mut new.into_iter()),
        left_out: names.iter().filter(|name| !here.contains(name.as_str())).cloned().collect(),
        damaged,
        passed_over: named(&mut carried.into_iter().filter(|body| moves(body))),
    };
    Ok(Some((bodies, memory.map(|memory| (memory, names)))))
}

impl CarriedBodies {
    /// As the record of a run has it.
    pub(super) fn record(&self) -> BegunFrom {
        BegunFrom { path: self.from.clone(), time: self.time, state_sum: self.sum.clone() }
    }

    /// What is wrong with checkpoints there, if something is.
    pub(super) fn damage(&self) -> Option<String> {
        let newest = self.damaged.first()?;
        Some(format!("{} is damaged, and an earlier checkpoint is taken", newest.display()))
    }
}

/// Names that are listed; beyond, how many more.
const LISTED: usize = 8;

impl Display for CarriedBodies {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let [count, all] = self.count;
        let (time, from) = (self.time, self.from.display());
        write!(f, "{count} of {all} bodies begin as they were at t = {time} s in {from}")?;
        for (what, names) in [("new", &self.new), ("left out", &self.left_out)] {
            if !names.is_empty() {
                let listed: Vec<String> = names.iter().take(LISTED).map(|name| format!("`{name}`")).collect();
                write!(f, "\n  {what:<12}{}", listed.join(", "))?;
            }
            if names.len() > LISTED {
                write!(f, " and {} more", names.len() - LISTED)?;
            }
        }
        if self.rounded {
            let what = "from a snapshot: in its precision, and each particle turns as its body does";
            write!(f, "\n  rounded     {what}")?;
        }
        if let Some(damage) = self.damage() {
            write!(f, "\n  warning     {damage}")?;
        }
        for name in &self.passed_over {
            write!(f, "\n  warning     `{name}` begins with the velocities it had there, not with its own")?;
        }
        Ok(())
    }
}
