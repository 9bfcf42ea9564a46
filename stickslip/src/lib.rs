//! Many deformable bodies in frictional contact, by the material point method.
//!
//! The rooms below are in reading order: each uses only rooms above it.

pub mod tensor; // Real, Vector<T, D>, Matrix<T>, Symmetric<T>

pub mod check;
pub mod geometry; // shapes: inside(x), bounds; filling them with particles
pub mod material; // one file a law: equation, code, tests
pub mod scene; // what the user asks for; scene file -> Scene, with errors that point at line and key // what is wrong or doubtful with a scene, before it runs

pub mod basis; // shape functions: linear, GIMP
pub mod body; // particles, and what they add up to
pub mod grid; // the sparse field: blocks of nodes under each body's particles
pub mod transfer; // particles -> field, field -> particles

pub mod boundary; // mirrors and fixed faces of the domain
pub mod clock; // the stable time step
pub mod contact;
pub mod door; // a running simulation with dimension and precision erased // what bodies do to each other at the nodes they share

pub mod engine; // the step and its verbs

pub mod observe; // one file a kind of output; results read back
pub mod run; // the loop: step, observe, stop
