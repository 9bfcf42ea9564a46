//! What the contact laws' validation came to: as text for the terminal, and the scenes that were run.

mod scenes;
mod text;

pub use scenes::write_scenes;
pub use text::{line, table};
