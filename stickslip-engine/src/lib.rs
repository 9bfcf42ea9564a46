//! The engine of Stickslip: many deformable bodies in frictional contact, by the material point method.
//!
//! It reads no files and writes none. The rooms below are in reading order: each uses only rooms above it.

pub use stickslip_scene::{
    check, column, geometry, initial_stress, material, number, outside, part, rigid, scene, tensor,
};

// Several numbers in a register, on whatever the processor has.
pub mod lanes;

// Loops over threads.
pub mod threads;

// Sums that do not depend on the order of what is added.
pub mod exact;

// Processes that share a simulation.
pub mod ranks;

// Shape functions: linear, GIMP.
pub mod basis;

// Particles, and what they add up to.
pub mod body;

// Large pages of memory.
pub mod pages;

// What a law sees of the deformation where bodies begin with a stress or are heated.
pub mod natural;

// A body's particles as columns in memory.
pub mod particles;

// The sparse field: blocks of nodes under each body's particles.
pub mod grid;

// Particles to grid (P2G), grid to particles (G2P).
pub mod transfer;

// Mirrors and fixed faces of the domain.
pub mod boundary;

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

/// What of a step knows the shape functions.
pub mod kernels;

// A simulation that several ranks share, as the first of them sees it.
pub mod shared;

// Steps to a time: the one loop.
pub mod march;

// What a scene costs in memory.
pub mod footprint;
