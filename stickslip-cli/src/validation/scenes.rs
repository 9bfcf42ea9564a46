//! The scenes of validation as files that `stickslip run` takes.

use std::fs;
use std::io;
use std::path::Path;
use stickslip_validation::Report;

/// Writes every scene to `folder/BENCHMARK/LAW/CELLS/NAME.toml`.
///
/// # Errors
/// The folder cannot be written.
pub fn write_scenes(report: &Report, folder: &Path) -> io::Result<()> {
    for entry in &report.entries {
        for run in &entry.runs {
            let place =
                folder.join(entry.benchmark.name).join(entry.law.word).join(run.resolution.cells.to_string());
            let Ok(outcome) = &run.result else { continue };
            fs::create_dir_all(&place)?;
            for (name, text) in &outcome.scenes {
                fs::write(place.join(format!("{name}.toml")), text)?;
            }
        }
    }
    Ok(())
}
