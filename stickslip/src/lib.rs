//! Many deformable bodies in frictional contact, by the material point method.
//!
//! This crate is the one to depend on. It holds the loop of a run, and shows what stands below it: scenes
//! ([`stickslip_scene`]), the engine ([`stickslip_engine`]) and results ([`stickslip_results`]).

pub use stickslip_engine::{
    basis, body, boundary, clock, contact, door, grid, lanes, march, pages, particles, step, transfer,
};
pub use stickslip_results::{image, observe, polariscope};
pub use stickslip_scene::{column, geometry, material, number, rigid, scene, tensor};

// What is wrong or doubtful with a scene, and what its run will cost.
pub mod check;

// The loop: step, observe, stop.
pub mod run;
