//! Surfaces of bodies: of the undeformed shape, as the scene knows it, and carried along by the particles.

mod carried;
mod skin;

pub use carried::CarriedSkin;
pub use skin::Skin;
