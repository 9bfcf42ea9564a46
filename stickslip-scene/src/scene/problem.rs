//! What is wrong with a scene, said so that the user can mend it.

use super::letters::{escaped, shortened};

/// A mistake in a scene, tied to the key that holds it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{key}: {found}; allowed: {allowed}")]
pub struct Problem {
    /// Path of the key in the scene file: `bodies[1].shape.ball.radius`. The loader turns it into file,
    /// line and column.
    pub key: String,
    /// What was found.
    pub found: String,
    /// What is allowed.
    pub allowed: String,
    /// What to try, if there is more to say.
    pub help: Option<String>,
}

impl Problem {
    /// The same with escapes for letters that would steer a terminal, and no longer than anybody reads: parts of it are
    /// words of a file.
    pub(super) fn shown(self) -> Self {
        let Problem { key, found, allowed, help } = self;
        let shown = |text: &str| escaped(&shortened(text));
        let [key, found, allowed] = [key, found, allowed].map(|text| shown(&text));
        Problem { key, found, allowed, help: help.as_deref().map(shown) }
    }
}
