//! Problems with known answers, and how close each contact law and each scheme of the step comes to them.
//!
//! The laws come from the engine's list, the schemes from [`KEYS`], the problems from [`BENCHMARKS`]: one file each,
//! which reads like a report. To add a benchmark, write its file and list it there. Everything here drives the engine
//! as any user can: scenes are text, and simulations are stepped and looked at through [`stickslip::door`].

#![forbid(unsafe_code)]

// What a benchmark is: its report, its targets, its resolutions.
mod benchmark;

// What went wrong with a run.
mod failure;
mod finite_elements;

// How deep bodies reach into each other.
mod penetration;

// A scene under way, and what every run records.
mod trial;

// What a benchmark measured.
mod outcome;

// Small mathematics of measuring: slope, mean, deviation.
mod measuring;

// Pieces of scenes that benchmarks share.
mod scenery;

// The benchmarks, one file each.
mod benchmarks;

// Bodies on grids of their own: what they cannot be put to, and what they are known to miss.
mod own_grids;

// Schemes of the step: what a scene's keys choose, in every combination.
mod scheme;

// All chosen laws and schemes through all chosen benchmarks, side by side on the machine's cores.
mod suite;

pub use benchmark::{Allowed, Benchmark, Case, Laws, Miss, Reason, Resolution, Target, Tier};
pub use benchmarks::BENCHMARKS;
pub use failure::CaseFailure;
pub use outcome::{Measurement, Outcome};
pub use own_grids::own_misses;
pub use scheme::{KEYS, Key, Scheme, schemes};
pub use suite::{Candidate, Finished, LawUnderTest, Run, Suite, SuiteEntry, SuiteReport, Verdict, laws};
pub use trial::{RunRecord, Trial};
