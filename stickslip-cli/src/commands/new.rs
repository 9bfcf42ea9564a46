//! `stickslip new`: a scene to start from.

use super::say;
use crate::failure::Failure;
use clap::Args;
use miette::miette;
use std::fs::File;
use std::io::{ErrorKind, Write};
use std::path::PathBuf;

/// Write a commented scene to start from.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The file to write.
    #[arg(default_value = "scene.toml")]
    file: PathBuf,
}

/// The scene: two disks that meet on a floor, in seconds of computing.
const SCENE: &str = include_str!("new.toml");

impl Arguments {
    pub fn execute(self) -> Result<(), Failure> {
        let file = self.file.display();
        let created = File::create_new(&self.file).and_then(|mut file| {
            // Half a scene is better not there; the first error is the one to report.
            file.write_all(SCENE.as_bytes()).inspect_err(|_| drop(std::fs::remove_file(&self.file)))
        });
        created.map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists => Failure::Input(miette!(
                help = "give another name: stickslip new other.toml",
                "{file} is there already"
            )),
            _ => Failure::unwritten(&self.file, &error),
        })?;
        say(&format!("{file} is written; now: stickslip run {file}"))
    }
}
