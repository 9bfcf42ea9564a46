//! The benchmarks, one file each; every file reads like a report. To add one, write its file and seat it in [`BENCHMARKS`].

mod b3_block_on_incline;
mod b5_equal_bars;
mod b7_impedance_mismatch;
mod b9_two_disks;
mod corners;
mod identity;
mod m3_registration;
mod m4_first_contact;
mod m5_patch;
mod m6_friction_ratio;

use crate::benchmark::Benchmark;

/// All benchmarks, in the order of the page.
pub static BENCHMARKS: &[Benchmark] = &[
    m3_registration::BENCHMARK,
    m4_first_contact::BENCHMARK,
    m5_patch::BENCHMARK,
    m6_friction_ratio::BENCHMARK,
    identity::BENCHMARK,
    b3_block_on_incline::BENCHMARK,
    corners::BENCHMARK,
    b5_equal_bars::BENCHMARK,
    b7_impedance_mismatch::BENCHMARK,
    b9_two_disks::BENCHMARK,
];
