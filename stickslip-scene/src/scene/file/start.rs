//! `[start]`: from where bodies begin, if not as their shapes are filled.

use super::Context;
use super::quantity::{Duration, QuantityInput};
use super::read::table;
use super::text::{Choice, Text, Word};
use crate::scene;
use crate::scene::StartVelocities;
use crate::scene::error::Fault;

table! {
    /// Bodies begin as another run left them: a settled packing is made once, and used in many runs.
    Start {
        /// Folder of results, whose newest checkpoint is taken, a file of a checkpoint, or a snapshot (`.vtu`) in a
        /// folder of results; a relative path starts at the folder of the scene file. Each body of the scene that has
        /// the name of one there begins with its particles: places, deformation, stress, and what their law remembers.
        /// It must have the shape that it has there, and be filled as it is there; material, loads and contact may be
        /// others.
        from: Text,
        /// Time in that run [s]: the snapshot nearest to it is taken, not the newest checkpoint. Only of a folder.
        at: Option<QuantityInput<Duration>>,
        /// What becomes of their velocities.
        #[schemars(extend("default" = "kept"))]
        velocities: Option<Word<StartVelocities>>,
    }
}

impl Choice for StartVelocities {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("kept", StartVelocities::Kept, "They go on."),
        ("zero", StartVelocities::Zero, "The bodies begin at rest."),
    ];
}

impl Start {
    /// Where it lies, as seen from where the program runs.
    pub fn resolve(&self, context: &Context) -> Result<scene::Start, Fault> {
        let name = self.from.value(context)?;
        let from = context.folder.join(&name);
        let at = self
            .at
            .as_ref()
            .map(|at| at.checked(context, "a time [s] of 0 or more, like \"0.3 s\"", |at| at >= 0.0))
            .transpose()?;
        if let (Some(at), Some("vtu" | "checkpoint")) =
            (&self.at, from.extension().and_then(|kind| kind.to_str()))
        {
            return Err(at.node().fault("a time beside a folder of results: `from` names one of its files"));
        }
        let velocities =
            self.velocities.as_ref().map_or(Ok(StartVelocities::Kept), |word| word.value(context))?;
        Ok(scene::Start { from, at, velocities })
    }
}
