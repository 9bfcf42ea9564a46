//! How fast this machine could be, and how fast the program is on it.
//!
//! The rooms in the order of data: the machine's limits, problems, what a step must move, one measurement in a process
//! of its own, and the report of it all. `stickslip-bench` has more problems, and what developers ask of them all.

mod limits;
mod measure;
mod memory;
mod model;
mod multiply_add;
mod problems;
mod record;
mod report;
mod suite;

pub use crate::chart::{Chart, Curve, Panel, draw};
pub use crate::failure::Failure;
pub use measure::{BenchSample, BenchTask, Effort, MEASURE, Order, answer};
pub use model::PARTICLES_PER_CELL;
pub use problems::{BLOCKS_APART, BLOCKS_IN_CONTACT, BenchCase, BenchExtent, BenchScheme, cases, grown};
pub use record::{BenchRecord, Measured, median};
pub use report::{TextTable, percent};
pub use suite::{BenchSuite, PROBLEMS, problem_of, write_scenes};
