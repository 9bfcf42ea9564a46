//! The benchmarks, one file each; every file reads like a report. To add one, write its file and list it in
//! [`BENCHMARKS`].

mod b10_collinear_disks;
mod b11_cylinder;
mod b12_sphere_impact;
mod b13_disk;
mod b13_sphere;
mod b14_partial_slip;
mod b17_manufactured;
mod b19_vortex;
mod b1_incline;
mod b20_spinning_disk;
mod b21_cantilever;
mod b21_large_deflection;
mod b21_loaded;
mod b24_taylor_bar;
mod b29_stack;
mod b2_backspin;
mod b30_hanging_bar;
mod b31_held_strip;
mod b32_free_spin;
mod b33_slow_sliding;
mod b3_block_on_incline;
mod b5_equal_bars;
mod b7_impedance_mismatch;
mod b9_two_disks;
mod blunted_wedge;
mod bodies_at_node;
mod coming_to_roll;
mod cook;
mod corners;
mod die;
mod flat_wall;
mod groove;
mod identity;
mod lame;
mod m1_momentum;
mod m2_dissipation;
mod m3_registration;
mod m4_first_contact;
mod m5_patch;
mod m6_friction_ratio;
mod maw_curve;
mod punch;
mod reasons;
mod rigid_half_space;
mod rolling_sphere;
mod spinning_ring;
mod spinning_to_a_stop;
mod turning_disk;

use crate::benchmark::Benchmark;

/// All benchmarks, in the order of the page.
pub static BENCHMARKS: &[Benchmark] = &[
    m1_momentum::BENCHMARK,
    m2_dissipation::BENCHMARK,
    m3_registration::BENCHMARK,
    m4_first_contact::BENCHMARK,
    m5_patch::BENCHMARK,
    m6_friction_ratio::BENCHMARK,
    identity::BENCHMARK,
    corners::BENCHMARK,
    rigid_half_space::BENCHMARK,
    die::BENCHMARK,
    blunted_wedge::BENCHMARK,
    turning_disk::BENCHMARK,
    b1_incline::BENCHMARK,
    b2_backspin::BENCHMARK,
    b3_block_on_incline::BENCHMARK,
    b5_equal_bars::BENCHMARK,
    b7_impedance_mismatch::BENCHMARK,
    b9_two_disks::BENCHMARK,
    b10_collinear_disks::BENCHMARK,
    b11_cylinder::BENCHMARK,
    b12_sphere_impact::BENCHMARK,
    b13_sphere::BENCHMARK,
    b13_disk::BENCHMARK,
    b14_partial_slip::BENCHMARK,
    b29_stack::BENCHMARK,
    b17_manufactured::BENCHMARK,
    b19_vortex::BENCHMARK,
    b20_spinning_disk::BENCHMARK,
    spinning_ring::BENCHMARK,
    b21_cantilever::BENCHMARK,
    b21_large_deflection::BENCHMARK,
    b21_loaded::BENCHMARK,
    lame::BENCHMARK,
    b30_hanging_bar::BENCHMARK,
    b31_held_strip::BENCHMARK,
    b32_free_spin::BENCHMARK,
    groove::BENCHMARK,
    flat_wall::BENCHMARK,
    b33_slow_sliding::BENCHMARK,
    coming_to_roll::BENCHMARK,
    spinning_to_a_stop::BENCHMARK,
    punch::BENCHMARK,
    cook::BENCHMARK,
    b24_taylor_bar::BENCHMARK,
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::benchmark::{Laws, Target, Tier};
    use crate::scheme::schemes;
    use crate::suite::laws;

    /// A bound that lies within the target, or at cells that nobody runs, bounds nothing.
    #[test]
    fn known_misses_are_of_resolutions_that_are_run_and_lie_beyond_the_target() {
        for benchmark in BENCHMARKS {
            for target in benchmark.targets {
                for miss in target.misses {
                    let name = (benchmark.name, target.metric, miss);
                    let judged = target.at.is_none_or(|cells| cells == miss.cells);
                    assert!(
                        judged && benchmark.resolutions.iter().any(|run| run.cells == miss.cells),
                        "{name:?}"
                    );
                    let beyond = [-miss.off, miss.off].map(|off| !target.is_met_by(target.exact + off));
                    assert!(beyond[0] || beyond[1], "{name:?}");
                }
            }
        }
    }

    #[test]
    fn every_benchmark_can_fail_in_the_quick_tier() {
        for benchmark in BENCHMARKS {
            let due: Vec<f64> = benchmark.due(Tier::Quick).map(|resolution| resolution.cells).collect();
            let judged = |target: &Target| target.at.is_none_or(|cells| due.contains(&cells));
            assert!(!due.is_empty() && benchmark.targets.iter().any(judged), "{}", benchmark.name);
        }
    }

    /// Whoever reads that a miss is known wants to know why, and by how much.
    #[test]
    fn known_misses_have_reasons_with_figures() {
        let known = |benchmark: &&Benchmark| benchmark.targets.iter().any(|target| !target.misses.is_empty());
        for benchmark in BENCHMARKS.iter().filter(known) {
            // Of what was measured, not names of benchmarks or cells.
            let digit = |c: Option<&u8>| c.is_some_and(u8::is_ascii_digit);
            let figures = |text: &str| {
                let text = text.as_bytes();
                (0..text.len()).any(|i| {
                    let decimal = text[i] == b'.' && digit(text.get(i + 1));
                    i > 0 && digit(text.get(i - 1)) && (decimal || text[i..].starts_with(b" %"))
                })
            };
            let bulk = benchmark.laws == Laws::Bulk;
            let default = if bulk { &schemes()[0].word } else { laws()[0].word };
            assert!(benchmark.reasons(default).any(figures), "{}", benchmark.name);
        }
    }
}
