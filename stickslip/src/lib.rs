//! Many deformable bodies in frictional contact, by the material point method.
//!
//! The rooms below are in reading order: each uses only rooms above it.

pub mod tensor; // Real, Vector<T, D>, Matrix<T, D>, symmetric stress

pub mod check;
pub mod geometry; // shapes: inside(x), bounds; filling them with particles
pub mod material; // one file a law: equation, code, tests
pub mod scene; // what the user asks for; scene file -> Scene, with errors that point at line and key // what is wrong or doubtful with a scene before it runs: overlap, domain, resolution, cost

pub mod door; // a running simulation with dimension and precision erased; what observers see

pub mod observe; // one file a kind of output: tables, snapshots for ParaView, the record of the run; reading them back
pub mod run; // the loop: step, observe, stop
