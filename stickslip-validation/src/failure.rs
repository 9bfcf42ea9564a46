//! What went wrong with a run.

use stickslip::door::StepError;
use stickslip::scene::{Problem, SceneError};

/// Why a case gave no numbers.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The benchmark's scene is not one.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// The benchmark's scene cannot be simulated.
    #[error("{0}")]
    Build(#[from] Problem),
    /// A step went wrong.
    #[error("{0}")]
    Step(#[from] StepError),
    /// The time step fell to nothing.
    #[error("the time step fell to nothing at t = {time:.4e} s")]
    Stuck {
        /// When [s].
        time: f64,
    },
    /// What was to be measured did not happen.
    #[error("not to be measured: {0}")]
    Absent(&'static str),
    /// The program is at fault.
    #[error("the program is at fault; it said why on its error output")]
    Panic,
}
