//! How fast this machine could be, and how fast the program is on it.
//!
//! The rooms in the order of data: the machine's limits, problems, what a step must move, one measurement in a process
//! of its own, whole runs with and without outputs, problems on ranks, what they would take on many, other programs,
//! ratios against goals, and the report of it all.

mod end_to_end;
mod goals;
mod limits;
mod measure;
mod memory;
mod model;
mod multiply_add;
mod on_ranks;
mod peers;
mod problems;
mod record;
mod report;
mod scaling;
mod suite;

pub use measure::answer;
pub use peers::Peers;
pub use problems::BenchExtent;
pub use scaling::{CLUSTER, chart as scaling_chart};
pub use suite::{BenchSuite, PROBLEMS, write_scenes};
