//! What the contact laws' validation came to: as text for the terminal, as a page, and the scenes that were run.

mod page;
mod scenes;
mod text;

pub use page::page;
pub use scenes::write_scenes;
pub use text::{broken, line, table};
