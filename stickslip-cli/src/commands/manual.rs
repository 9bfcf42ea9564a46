//! `stickslip manual`: pages for `man`.

use super::Command;
use crate::failure::Failure;
use clap::{Args, CommandFactory};
use miette::miette;
use std::path::PathBuf;

/// Write pages for `man`: one for each command, and one for all.
#[derive(Debug, Args)]
pub struct Arguments {
    /// A folder for the pages.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

impl Arguments {
    pub fn execute(self) -> Result<(), Failure> {
        let failed =
            |error| Failure::Run(miette!("cannot write pages into {}: {error}", self.folder.display()));
        std::fs::create_dir_all(&self.folder).map_err(failed)?;
        let command = Command::command().disable_help_subcommand(true);
        clap_mangen::generate_to(command, &self.folder).map_err(failed)
    }
}
