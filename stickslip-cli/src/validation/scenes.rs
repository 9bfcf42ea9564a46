//! The scenes of validation as files that `stickslip run` takes.

use crate::files;
use std::fs;
use std::io;
use std::path::Path;
use stickslip_validation::{Run, SuiteEntry};

/// Writes every scene of a run to `folder/BENCHMARK/LAW_OR_SCHEME/CELLS/NAME.toml`.
///
/// # Errors
/// The folder cannot be written.
pub fn write_scenes(entry: &SuiteEntry, run: &Run, folder: &Path) -> io::Result<()> {
    let Ok(outcome) = &run.result else { return Ok(()) };
    let place =
        folder.join(entry.benchmark.name).join(entry.way.word()).join(run.resolution.cells.to_string());
    fs::create_dir_all(&place)?;
    outcome
        .scenes
        .iter()
        .try_for_each(|(name, text)| files::write_scene(&place.join(format!("{name}.toml")), text))
}
