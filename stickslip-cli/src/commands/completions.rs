//! `stickslip completions`: what lets shells complete the command.

use super::{Command, say};
use crate::failure::Failure;
use clap::{Args, CommandFactory};
use clap_complete::Shell;

/// Print a script that lets a shell complete commands, options and files.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The shell.
    shell: Shell,
}

impl Arguments {
    pub fn execute(self) -> Result<(), Failure> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut Command::command(), "stickslip", &mut script);
        say(&String::from_utf8_lossy(&script))
    }
}
