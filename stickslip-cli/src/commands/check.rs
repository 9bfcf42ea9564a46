//! `stickslip check SCENE`: what a run would be, without running it.

use super::{assignment, load, report, say};
use crate::failure::Failure;
use clap::Args;
use std::path::PathBuf;

/// Read a scene and report bodies, particles, memory, step, expected time and whether contact is resolved.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file.
    scene: PathBuf,

    /// Give a named parameter of the scene another value; may be repeated.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    parameters: Vec<(String, String)>,
}

impl Arguments {
    pub fn execute(self) -> Result<(), Failure> {
        let loaded = load(&self.scene, &self.parameters).map_err(Failure::input)?;
        say(&report(&loaded)?.to_string())?;
        if loaded.scene.start.is_none() {
            return Ok(());
        }
        // As the run will begin, so that what it would refuse is refused here.
        let built = stickslip::step::build(&loaded.scene);
        let mut simulation = built.map_err(|problem| Failure::input(loaded.source.locate(problem)))?;
        let carried = stickslip::run::begin(&loaded.scene, &mut *simulation).map_err(Failure::input)?;
        carried.map_or(Ok(()), |carried| say(&format!("\n{carried}")))
    }
}
