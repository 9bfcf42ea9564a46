//! What scenes and kernels of Stickslip share: numbers and tensors, shapes, laws of materials, and the names of what a
//! scheme can be.
//!
//! The rooms below are in reading order: each uses only rooms above it.

#![forbid(unsafe_code)]

// One number, or several side by side: what laws compute with.
pub mod number;

// Vector<T, D>, Matrix<T>, Symmetric<T>
pub mod tensor;

// Principal values and axes of symmetric tensors.
pub mod eigen;

// Shapes: inside(x), bounds; filling them with particles.
pub mod geometry;

// Friction of two surfaces: its coefficient, and what of the pressure it remembers.
pub mod friction;

// What a column of particles holds: name, unit, components.
pub mod column;

// What a scene file only names, and the program that runs the scene gives.
pub mod outside;

// One file a law: equation, code, tests.
pub mod material;

// Shape functions, transfer, faces of the domain: their names.
pub mod scheme;
