//! Shapes from images: the parts that pixels of a label, or bright ones, make up; and from given particles.

mod cloud;
mod lattice;
mod part;
mod parts;
#[cfg(test)]
mod tests;

pub use cloud::{CloudPoints, NoCloud, PointCloud, mean_spacing, point_clouds};
pub use part::ImagePart;
pub use parts::{Pixels, Solids, Spread, image_parts};
