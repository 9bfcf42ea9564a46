//! The law and the scheme that scenes on the common grid get which name none, bodies on grids of their own, and glue,
//! held to the targets that they reach.
//!
//! # Source
//! The benchmarks themselves: each states its source, its target and why it is that.
//!
//! # Expected
//! At the quick tier's resolutions every target is reached but those that are known to be missed there, and every
//! quantity that a target is stated for is measured; on grids of their own those of the variants that they have. B19 on
//! them is left to `stickslip validate`: its load by a formula of place takes minutes.

use stickslip_validation::{BENCHMARKS, Suite, Tier, laws, schemes};

fn suite() -> Suite {
    Suite {
        benchmarks: BENCHMARKS.iter().collect(),
        laws: Vec::new(),
        schemes: Vec::new(),
        own: false,
        tier: Tier::Quick,
        threads: std::thread::available_parallelism().map_or(1, usize::from),
    }
}

#[test]
fn the_default_law_and_scheme_and_glue_reach_what_they_are_known_to_reach() {
    let held = laws().into_iter().filter(|law| law.default || law.word == "glued").collect();
    reaches(&Suite {
        laws: held,
        schemes: schemes().iter().filter(|scheme| scheme.default).collect(),
        ..suite()
    });
}

#[test]
fn grids_of_their_own_reach_what_they_are_known_to_reach() {
    let benchmarks = BENCHMARKS.iter().filter(|benchmark| benchmark.name != "B19").collect();
    reaches(&Suite { benchmarks, own: true, ..suite() });
}

fn reaches(suite: &Suite) {
    let mut wrong = Vec::new();
    for entry in &suite.run(&mut |_, _| {}).entries {
        let (name, law) = (entry.benchmark.name, entry.way.word());
        for run in &entry.runs {
            if let Err(failure) = &run.result {
                wrong.push(format!("{name} by {law} at {}: {failure}", run.resolution.cells));
            }
        }
        for target in entry.benchmark.targets {
            let judged = entry.judged(target).filter(|_| !entry.is_exempt(target));
            let measured = judged.and_then(|run| run.result.as_ref().ok());
            if measured.is_some_and(|outcome| outcome.value(target.metric).is_none()) {
                wrong.push(format!("{name} by {law} does not measure {}", target.metric));
            }
        }
        for target in entry.broken() {
            let measured =
                entry.judged(target).and_then(|run| run.result.as_ref().ok()?.value(target.metric));
            wrong.push(format!("{name} by {law}: {} is {measured:?}, asked {target}", target.metric));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}
