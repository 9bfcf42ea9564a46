//! `stickslip resume DIR`: go on with a run from its newest checkpoint.

use super::run::How;
use crate::failure::Failure;
use clap::Args;
use miette::{IntoDiagnostic, miette};
use std::path::PathBuf;
use stickslip::observe::{Manifest, SceneSource};

/// Go on with a run: one that was stopped or killed, or a finished one to a later end.
///
/// The results of a run that was stopped end bit for bit as those of one that was not. A finished run ended its last
/// step exactly at its end, and has that step beyond those of a run that went further at once.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Folder of results that `stickslip run` wrote.
    results: PathBuf,

    /// Simulated time to go on to, such as "4 s"; without this, the one that was named last, or the end of the scene.
    #[arg(long, value_name = "TIME")]
    until: Option<String>,

    /// Scene file, with other outputs or another end; without this, the one that was run, where it lay, or as it was run
    /// if it is not there any more.
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,

    #[command(flatten)]
    how: How,
}

impl Arguments {
    /// Threads that the user asks for.
    #[cfg(feature = "mpi")]
    pub(super) fn threads(&self) -> Option<usize> {
        self.how.threads()
    }

    pub fn execute(self) -> Result<(), Failure> {
        self.how.use_threads()?;
        // Whoever names the scene does not need the record, which a power cut may have taken.
        let before = Manifest::read(&self.results);
        let mut source = match (self.scene, before) {
            (Some(path), before) => {
                let path = std::path::absolute(path).into_diagnostic().map_err(Failure::Run)?;
                let source = before.ok().and_then(|before| before.source);
                SceneSource {
                    path,
                    set: source.map_or_else(Vec::new, |source| source.set),
                    until: None,
                    text: None,
                }
            }
            (None, Err(error)) => return Err(Failure::input(error)),
            (None, Ok(before)) => before.source.ok_or_else(|| {
                Failure::Input(miette!(
                    help = "name the scene file with --scene",
                    "{} does not say which scene file it came from",
                    self.results.display()
                ))
            })?,
        };
        source.until = self.until.or(source.until);
        let read = if source.is_gone() {
            let gone = format!("the scene file {} is not there", source.path.display());
            let Some(recorded) = source.recorded() else {
                return Err(Failure::Input(miette!(help = "name it with --scene", "{gone}")));
            };
            self.how.note(&format!("{gone}; the run goes on with the scene as it was run"));
            recorded
        } else {
            source.load()
        };
        let loaded = read.map_err(Failure::input)?;
        self.how.make(&loaded, (source, self.results), stickslip::run::resume)
    }
}
