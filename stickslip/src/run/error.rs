//! What can end a run before its time.

use super::ResumeError;
use crate::march::MarchError;
use crate::observe::{FolderError, OutputError, RunWarning};
use miette::Diagnostic;

/// Why a run ended before its time.
#[derive(Debug, thiserror::Error, Diagnostic)]
pub enum RunError {
    /// The folder for the results cannot be used: the user's choice; nothing was run and nothing written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Folder(#[from] FolderError),

    /// There is nothing to go on from, or not with this scene; nothing was changed.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Resume(#[from] ResumeError),

    /// A step failed. The state in which it failed is the last record of every output.
    #[error("{error}{}", unsaved.as_ref().map(|error| format!(" (and its last frame is lost: {error})")).unwrap_or_default())]
    #[diagnostic(help("{}", error.advice()))]
    Step {
        /// What went wrong.
        #[source]
        error: MarchError,
        /// Why the last record could not be written, if so.
        unsaved: Option<OutputError>,
    },

    /// A check of the scene's `[health]` that stops the run found something. Everything is recorded up to there, and a
    /// checkpoint is made if the run makes any.
    #[error("stopped at t = {time:.6e} s by health.{}: {}", warning.kind.replace('-', "_"), warning.message)]
    #[diagnostic(help("{}", warning.advice))]
    Unhealthy {
        /// What it found.
        warning: Box<RunWarning>,
        /// When [s].
        time: f64,
    },

    /// An output could not be written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Output(#[from] OutputError),
}
