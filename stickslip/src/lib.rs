//! Many deformable bodies in frictional contact, by the material point method.
//!
//! The rooms below are in reading order: each uses only rooms above it.

// One number, or several side by side: what laws compute with.
pub mod number;

// Several numbers in a register, on whatever the processor has.
pub mod lanes;

// Vector<T, D>, Matrix<T>, Symmetric<T>
pub mod tensor;

// Shapes: inside(x), bounds; filling them with particles.
pub mod geometry;

// One file a law: equation, code, tests.
pub mod material;

// What the user asks for; scene file -> Scene, with errors that point at line and key.
pub mod scene;

// What is wrong or doubtful with a scene, before it runs.
pub mod check;

// Shape functions: linear, GIMP.
pub mod basis;

// Particles, and what they add up to.
pub mod body;

// Large pages of memory.
pub mod pages;

// A body's particles as columns in memory.
pub mod particles;

// The sparse field: blocks of nodes under each body's particles.
pub mod grid;

// Particles -> field, field -> particles.
pub mod transfer;

// Mirrors and fixed faces of the domain.
pub mod boundary;

// The stable time step.
pub mod clock;

// A running simulation with dimension and precision erased.
pub mod door;

// What bodies do to each other at the nodes they share.
pub mod contact;

// The step and its verbs.
pub mod engine;

// RGB images: PNG files and animations.
pub mod image;

// A virtual polariscope: fringes of the stress in a snapshot.
pub mod polariscope;

// One file a kind of output; results read back.
pub mod observe;

// The loop: step, observe, stop.
pub mod run;
