//! What uniform GIMP is known to miss is right where functions have no kinks.
//!
//! # Set-up
//! The benchmark of a floor that creeps under a pressed block (B33), at the quick tier's resolution, by
//! `spline-modified-last-rflip`.
//!
//! # Source
//! The benchmark itself states it.
//!
//! # Expected
//! Its target, 1 % for friction, with no allowance for known misses.

use stickslip_validation::{BENCHMARKS, Suite, Tier, schemes};

#[test]
fn functions_without_kinks_mend_slow_sliding() {
    let suite = Suite {
        benchmarks: BENCHMARKS.iter().filter(|benchmark| benchmark.name == "B33").collect(),
        laws: Vec::new(),
        schemes: schemes().iter().filter(|scheme| scheme.word == "spline-modified-last-rflip").collect(),
        own: false,
        tier: Tier::Quick,
        threads: std::thread::available_parallelism().map_or(1, usize::from),
    };
    let report = suite.run(&mut |_, _| {});
    let outcome = report.entries[0].runs[0].result.as_ref().unwrap_or_else(|failure| panic!("{failure}"));
    for speed in ["1e-4 c", "1e-3 c", "1e-2 c"] {
        let metric = format!("friction/mu at {speed}");
        let value = outcome.value(&metric).unwrap_or_else(|| panic!("it does not measure {metric}"));
        println!("{metric}: {value:.4}");
        assert!((value - 1.0).abs() <= 0.01, "{metric}: {value}");
    }
}
