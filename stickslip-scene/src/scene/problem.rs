//! What is wrong with a scene, said so that the user can mend it.

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
    /// The same with escapes for letters that would steer a terminal: parts of it are words of a file.
    pub(super) fn shown(self) -> Self {
        let shown = |text: String| -> String {
            let letter = |letter: char| match letter.is_control() && letter != '\n' {
                true => letter.escape_default().to_string(),
                false => letter.to_string(),
            };
            text.chars().map(letter).collect()
        };
        let Problem { key, found, allowed, help } = self;
        Problem { key: shown(key), found: shown(found), allowed: shown(allowed), help: help.map(shown) }
    }
}
