//! Scenes of Stickslip: what a user asks for, and what is wrong or doubtful with it before it runs.
//!
//! The rooms below are in reading order: each uses only rooms above it.

#![forbid(unsafe_code)]

// One number, or several side by side: what laws compute with.
pub mod number;

// Vector<T, D>, Matrix<T>, Symmetric<T>
pub mod tensor;

// Shapes: inside(x), bounds; filling them with particles.
pub mod geometry;

// Grains in a container, at random and without overlap.
pub mod packing;

// What a column of particles holds: name, unit, components.
pub mod column;

// What a scene file only names, and the program that runs the scene gives.
pub mod outside;

// One file a law: equation, code, tests.
pub mod material;

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
