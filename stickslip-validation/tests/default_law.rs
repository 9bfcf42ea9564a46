//! The law that scenes get which name none, and glue, held to the targets that they reach.
//!
//! # Source
//! The benchmarks themselves: each states its source, its target and why it is that.
//!
//! # Expected
//! What the default law reaches at the quick tier's resolutions, it keeps. Targets that it misses are on the page of
//! `stickslip validate` and not here. Every benchmark named measures every quantity that it has a target for at these resolutions.

use stickslip_validation::{BENCHMARKS, Benchmark, Entry, Suite, Tier, Verdict, laws};

fn run(name: &str) -> Entry {
    let benchmarks: Vec<&'static Benchmark> =
        BENCHMARKS.iter().filter(|benchmark| benchmark.name == name).collect();
    let kept = laws().into_iter().filter(|law| law.default || law.word == "glued").collect();
    let suite = Suite { benchmarks, laws: kept, tier: Tier::Quick, threads: 1 };
    let mut report = suite.run(&mut |_, _| {});
    report.entries.swap_remove(0)
}

/// Runs a benchmark and holds the default law to some of its quantities.
fn holds(name: &str, metrics: &[&str]) {
    let entry = run(name);
    for run in &entry.runs {
        let outcome = run.result.as_ref().unwrap_or_else(|failure| panic!("{name}: {failure}"));
        for target in entry.benchmark.targets.iter().filter(|target| entry.judged(target).is_some()) {
            assert!(outcome.value(target.metric).is_some(), "{name} does not measure {}", target.metric);
        }
    }
    for metric in metrics {
        let targets: Vec<_> =
            entry.benchmark.targets.iter().filter(|target| target.metric == *metric).collect();
        assert!(!targets.is_empty(), "{name} has no target for {metric}");
        for target in targets {
            let measured = entry.judged(target).map(|run| run.result.as_ref().map(|o| o.value(metric)));
            assert_eq!(
                entry.verdict(target),
                Verdict::Reached,
                "{name}, {metric}: {measured:?}, target {target}"
            );
        }
    }
}

#[test]
fn contact_of_two_to_five_bodies_keeps_momentum() {
    holds("M1", &["momentum from nowhere, 2 bodies", "3 bodies", "4 bodies", "5 bodies"]);
}

#[test]
fn contact_of_two_to_five_bodies_gains_no_energy() {
    holds("M2", &["energy gained, 2 bodies", "3 bodies", "4 bodies", "5 bodies"]);
}

#[test]
fn contact_begins_when_surfaces_touch() {
    holds(
        "M4",
        &[
            "cells too early, 1 particle a side",
            "2 particles a side",
            "3 particles a side",
            "4 particles a side",
            "fitted, 1 particle a side",
            "fitted, 2 particles",
            "fitted, 3 particles",
            "fitted, 4 particles",
        ],
    );
}

#[test]
fn an_interface_along_the_grid_leaves_the_stress_uniform() {
    holds("M5", &["largest error of stress, 0 degrees"]);
}

#[test]
fn equal_bars_exchange_their_velocities() {
    holds(
        "B5",
        &[
            "restitution, v/c = 0.002",
            "restitution, v/c = 0.02",
            "contact ends over 2L/c, v/c = 0.002",
            "contact ends over 2L/c, v/c = 0.02",
            "energy left over, v/c = 0.002",
            "energy left over, v/c = 0.02",
        ],
    );
}

#[test]
fn tractions_of_unlike_bars_are_equal() {
    holds("B7", &["tractions apart"]);
}

#[test]
fn a_block_with_corners_slides_at_any_angle_to_the_grid() {
    holds(
        "corners",
        &[
            "acceleration, aligned",
            "acceleration, rotated",
            "sinking [cells], aligned",
            "sinking [cells], rotated",
        ],
    );
}

#[test]
fn a_block_slides_and_rests_as_coulomb_says() {
    holds(
        "B3",
        &[
            "acceleration off, aligned",
            "acceleration off, rotated",
            "creep at rest, mu = 0.8, aligned",
            "creep at rest, mu = 0.8, rotated",
        ],
    );
}

#[test]
fn an_elastic_sphere_is_thrown_back_by_its_patch() {
    holds("B13", &["u1/v at u0 = 4 mu v"]);
}

#[test]
fn a_rigid_floor_is_the_limit_of_a_stiff_one() {
    holds("rigid", &["restitution, rigid over stiff", "largest force, rigid over stiff"]);
}

#[test]
fn a_body_cut_in_two_and_glued_is_the_body() {
    holds("identity", &["difference of position", "difference of velocity"]);
}
