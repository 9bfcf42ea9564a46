//! What the contact laws' validation came to: as text for the terminal.

mod text;

pub use text::{line, table};
