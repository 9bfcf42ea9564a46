//! The engine of Stickslip: many deformable bodies in frictional contact, by the material point method.
//!
//! It reads no files and writes none. The rooms below are in reading order: each uses only rooms above it.

pub use stickslip_kernels::{
    Compiled, Kernels, basis, boundary, exact, grid, lanes, natural, pages, particles, pass, surroundings,
    threads, transfer,
};
pub use stickslip_scene::{
    check, column, geometry, initial_stress, material, number, outside, part, rigid, scene, tensor,
};

// Processes that share a simulation.
pub mod ranks;

// Bodies.
pub mod body;

// The stable time step.
pub mod clock;

// Damping of the nodes' velocities.
pub mod damping;

// What holds, presses, pulls or drives parts of bodies.
pub mod load;

// A running simulation with dimension and precision erased.
pub mod door;

// What bodies do to each other at the nodes they share.
pub mod contact;

// The step and its verbs.
pub mod step;

// A simulation that several ranks share, as the first of them sees it.
pub mod shared;

// Steps to a time: the one loop.
pub mod march;

// What a scene costs in memory.
pub mod footprint;
