//! `stickslip schema`: the JSON schema of scene files.

use super::say;
use crate::failure::Failure;
use clap::Args;

/// Print the JSON schema of scene files, for completion in editors.
#[derive(Debug, Args)]
pub struct Arguments {}

impl Arguments {
    pub fn execute(self) -> Result<(), Failure> {
        let schema = stickslip::scene::schema();
        say(&serde_json::to_string_pretty(&schema).expect("a schema is plain data"))
    }
}
