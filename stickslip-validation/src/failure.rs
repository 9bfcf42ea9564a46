//! What went wrong with a run.

use stickslip::march::MarchError;
use stickslip::scene::{Problem, SceneError};

/// Why a case gave no numbers.
#[derive(Debug, thiserror::Error)]
pub enum CaseFailure {
    /// The benchmark's scene is not one.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// The benchmark's scene cannot be simulated.
    #[error("{0}")]
    Build(#[from] Problem),
    /// A step went wrong, or none brings the time forward.
    #[error("{0}")]
    Step(#[from] MarchError),
    /// What was to be measured did not happen.
    #[error("not to be measured: {0}")]
    Absent(&'static str),
    /// The program is at fault.
    #[error("the program is at fault; it said why on its error output")]
    Panic,
}
