//! What can end a run before its time.

use crate::door::StepError;
use crate::observe::{FolderError, OutputError};
use miette::Diagnostic;

/// Why a run ended before its time.
#[derive(Debug, thiserror::Error, Diagnostic)]
pub enum RunError {
    /// The folder for the results cannot be used: the user's choice; nothing was run and nothing written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Folder(#[from] FolderError),

    /// A step failed. The state in which it failed is the last record of every output.
    #[error("{error}{}", unsaved.as_ref().map(|error| format!(" (and its last frame is lost: {error})")).unwrap_or_default())]
    #[diagnostic(help("{}", error.advice()))]
    Step {
        /// What went wrong.
        #[source]
        error: StepError,
        /// Why the last record could not be written, if so.
        unsaved: Option<OutputError>,
    },

    /// The steps became so short that time stands still.
    #[error("time stands still at t = {time:.6e} s: the stable step is {step:.3e} s")]
    #[diagnostic(help(
        "a particle is far too fast or far too compressed; look at the last frame, try a smaller time.courant"
    ))]
    Stuck {
        /// Simulated time [s].
        time: f64,
        /// The step that the simulation would take [s].
        step: f64,
    },

    /// An output could not be written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Output(#[from] OutputError),
}
