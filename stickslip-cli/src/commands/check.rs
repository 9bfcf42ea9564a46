//! `stickslip check SCENE`: what a run would be, without running it; of results, whether they are as they were written.

use super::{assignment, at_start, load, report, say};
use crate::failure::Failure;
use clap::Args;
use miette::miette;
use std::path::{Path, PathBuf};
use stickslip::observe::{Verified, verify};

/// Read a scene and report bodies, particles, memory, step, expected time and whether contact is resolved; or read a
/// folder of results and report what is not as the run wrote it.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file, or folder of results.
    scene: PathBuf,

    /// Give a named parameter of the scene another value; may be repeated.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    parameters: Vec<(String, String)>,
}

impl Arguments {
    pub fn execute(self) -> Result<(), Failure> {
        if self.scene.is_dir() {
            if !self.parameters.is_empty() {
                return Err(Failure::Input(miette!(
                    help = "name the scene file, or leave --set out",
                    "--set: a folder of results has no parameters to set"
                )));
            }
            return check_results(&self.scene);
        }
        let loaded = load(&self.scene, &self.parameters).map_err(Failure::input)?;
        say(&report(&loaded)?.to_string())?;
        if loaded.scene.start.is_none() {
            return Ok(());
        }
        // As the run will begin, so that what it would refuse is refused here.
        let built = stickslip::step::build(&loaded.scene);
        let mut simulation = built.map_err(|problem| Failure::input(loaded.source.locate(problem)))?;
        let carried = stickslip::run::begin(&loaded.scene, &mut *simulation)
            .map_err(|error| at_start(&loaded, error))?;
        carried.map_or(Ok(()), |carried| say(&format!("\n{carried}")))
    }
}

/// Reads all files of results, and names those that are not as the run wrote them.
fn check_results(folder: &Path) -> Result<(), Failure> {
    let Verified { files, summed, wrong } = verify(folder).map_err(Failure::input)?;
    let shown = folder.display();
    if wrong.is_empty() {
        return say(&format!(
            "{shown}: {files} files are as the run wrote them, {summed} of them by the sums in its newest checkpoint"
        ));
    }
    let lines: Vec<String> = wrong.iter().map(ToString::to_string).collect();
    Err(Failure::Input(miette!(
        help = "begin from a copy, or run the scene anew; the other files can be read",
        "{} of {files} files in {shown} are not as the run wrote them:\n{}",
        wrong.len(),
        lines.join("\n")
    )))
}
