//! Many deformable bodies in frictional contact, by the material point method.
//!
//! This crate is the one to depend on. It holds the loop of a run, and shows what stands below it: scenes
//! ([`stickslip_scene`]), the engine ([`stickslip_engine`]) and results ([`stickslip_results`]).
//!
//! A scene comes from a file, by [`scene::load`], or from code, by [`scene::Scene::new`]; [`step::build`] makes a
//! [`door::Simulation`] of it, which is stepped and looked at; [`run::run`] does that until the scene's end and writes
//! what the scene asks for. This is `examples/build_a_scene.rs`:
//!
#![doc = concat!("```\n", include_str!("../examples/build_a_scene.rs"), "```")]
//!
//! `examples/add_an_observer.rs` looks at a run after every step, with an observer of its own; `examples/add_a_law.rs`
//! gives a body a law of its own.

#![forbid(unsafe_code)]

pub use stickslip_engine::{
    basis, body, boundary, clock, contact, door, exact, grid, lanes, march, pages, particles, ranks, shared,
    step, transfer,
};
pub use stickslip_results::{image, observe, polariscope, surface};
pub use stickslip_scene::{column, geometry, material, number, outside, rigid, scene, tensor};

// What is wrong or doubtful with a scene, and what its run will cost.
pub mod check;

// The loop: step, observe, stop.
pub mod run;
