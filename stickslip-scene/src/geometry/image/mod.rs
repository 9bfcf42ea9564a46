//! Shapes from images: the parts that pixels of a label, or bright ones, make up.

mod lattice;
mod part;
mod parts;
#[cfg(test)]
mod tests;

pub use part::ImagePart;
pub use parts::{Pixels, Solids, Spread, image_parts};
