//! Scenes of Stickslip: what a user asks for, and what is wrong or doubtful with it before it runs.
//!
//! The rooms below are in reading order: each uses only rooms above it.

#![forbid(unsafe_code)]

pub use stickslip_mechanics::{column, friction, geometry, material, number, outside, scheme, tensor};

// Grains in a container, at random and without overlap.
pub mod packing;

// What the user asks for; scene file -> Scene, with errors that point at line and key.
pub mod scene;

// Prescribed motion of rigid bodies.
pub mod rigid;

// Stress with which bodies begin.
pub mod initial_stress;

// Parts of bodies on which loads act.
pub mod part;

// What is wrong or doubtful with a scene, before it runs.
pub mod check;
