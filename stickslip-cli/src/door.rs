//! The command from outside.

use crate::commands::Command;
use crate::view::{Library, answer};
use clap::Parser;
use std::path::Path;
use stickslip::observe::ReadError;

/// As [`crate::execute`], but what went wrong comes back in words.
///
/// # Errors
/// The command line is none, or what it asks for cannot be done.
pub fn ask(arguments: &[&str]) -> Result<(), String> {
    let command = Command::try_parse_from(arguments).map_err(|error| error.to_string())?;
    command.execute().map_err(|failure| failure.to_string())
}

/// The viewer of a folder of results, without its port.
pub struct Viewer(Library);

/// The port that requests to a [`Viewer`] should name.
pub const PORT: u16 = 8000;

impl Viewer {
    /// Opens a folder of results.
    ///
    /// # Errors
    /// It holds none.
    pub fn open(folder: &Path) -> Result<Self, ReadError> {
        Ok(Viewer(Library::open(folder, None)?))
    }

    /// The status and the bytes that a request gets: its address, and the headers that it has.
    pub fn answer(&self, address: &str, headers: &[(&str, &str)]) -> (u16, Vec<u8>) {
        let header = |name: &str| {
            headers.iter().find(|(key, _)| key.eq_ignore_ascii_case(name)).map(|(_, value)| *value)
        };
        let (code, content) = answer(&self.0, PORT, address, &header);
        (code, content.bytes)
    }
}
