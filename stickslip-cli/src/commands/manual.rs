//! `stickslip manual`: pages for `man`.

use super::Command;
use crate::failure::Failure;
use crate::files;
use clap::{Args, CommandFactory};
use clap_mangen::Man;
use std::path::{Path, PathBuf};

/// Write pages for `man`: one for each command, and one for all.
#[derive(Debug, Args)]
pub struct Arguments {
    /// A folder for the pages.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

impl Arguments {
    pub fn execute(self) -> Result<(), Failure> {
        std::fs::create_dir_all(&self.folder).map_err(|error| Failure::unwritten(&self.folder, &error))?;
        let mut command = Command::command().disable_help_subcommand(true);
        command.build();
        write_pages(&command, &self.folder)
    }
}

/// The page of a command, and those of the commands below it.
fn write_pages(command: &clap::Command, folder: &Path) -> Result<(), Failure> {
    let page = Man::new(command.clone());
    let path = folder.join(page.get_filename());
    files::write(&path, files::MAN_PAGE, |file| page.render(file))
        .map_err(|error| Failure::unwritten(&path, &error))?;
    command
        .get_subcommands()
        .filter(|below| !below.is_hide_set())
        .try_for_each(|below| write_pages(below, folder))
}
