//! Results of Stickslip: what a run writes, and reading it back.
//!
//! The rooms below are in reading order: each uses only rooms above it.

#![forbid(unsafe_code)]

use stickslip_engine::{door, exact, ranks};
use stickslip_scene::{check, column, geometry, rigid, scene, tensor};

// RGB images: PNG files and animations.
pub mod image;

// A virtual polariscope: fringes of the stress in a snapshot.
pub mod polariscope;

// Surfaces of bodies, as triangles that their particles carry along.
pub mod surface;

// One file a kind of output; results read back.
pub mod observe;
