//! What pictures and charts share: an antialiased canvas, letters, axis marks and colours.

mod background;
mod canvas;
mod colors;
mod ticks;

pub use background::Background;
pub use canvas::{Canvas, Ink, SAMPLES, register_font, save, without_background};
pub use colors::{ColorMap, Rgb, Scale, shaded};
pub use stickslip::surface::body_color;
pub use ticks::{Prefix, axis_prefix, label, prefix, ticks};

use std::path::PathBuf;

/// A drawing that could not be made.
#[derive(Debug, thiserror::Error)]
pub enum DrawError {
    /// The file cannot be written.
    #[error("cannot write {path}: {source}")]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The drawing library gave up.
    #[error("cannot draw: {0}")]
    Ink(String),
    /// There is nothing to see.
    #[error("there is nothing to draw: {0}")]
    Empty(String),
}

impl DrawError {
    /// From an error of the drawing library, whose type depends on the kind of file.
    pub fn ink(error: impl std::fmt::Display) -> Self {
        DrawError::Ink(error.to_string())
    }
}
