//! The kernels of Stickslip: all that is done to particles several at a time, compiled for each basis, dimension,
//! precision and processor, and behind one table of functions ([`Kernels`]).
//!
//! What calls them, the step and contact at the nodes, is in the engine: a change there compiles none of this again.
//! The rooms below are in reading order: each uses only rooms above it.

pub use stickslip_mechanics::{column, geometry, material, number, scheme, tensor};

// Several numbers in a register, on whatever the processor has.
pub mod lanes;

// Loops over threads.
pub mod threads;

// Sums that do not depend on the order of what is added.
pub mod exact;

// Shape functions: linear, GIMP.
pub mod basis;

// Particles, and what a body is made of.
pub mod matter;

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

// How fast waves and particles are.
pub mod signal;

// Bulk viscosity.
pub mod viscosity;

// Nodes that move a point of a body.
pub mod points;

// What the particles of a body add up to.
pub mod totals;

// What a pass does to the particles of a tile.
pub mod pass;

// What particles say at the nodes of a block where bodies meet.
pub mod surroundings;

// The table.
mod kernels;

pub use kernels::{Compiled, Kernels, Place};
