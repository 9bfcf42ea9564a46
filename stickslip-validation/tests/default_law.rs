//! The law and the scheme that scenes get which name none, and glue, held to the targets that they reach.
//!
//! # Source
//! The benchmarks themselves: each states its source, its target and why it is that.
//!
//! # Expected
//! At the quick tier's resolutions every target is reached but those that its benchmark states as known to be missed
//! there, and every quantity that a target is stated for is measured.

use stickslip_validation::{BENCHMARKS, Suite, Tier, laws, schemes};

#[test]
fn the_default_law_and_scheme_and_glue_reach_what_they_are_known_to_reach() {
    let held = laws().into_iter().filter(|law| law.default || law.word == "glued").collect();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let suite = Suite {
        benchmarks: BENCHMARKS.iter().collect(),
        laws: held,
        schemes: schemes().iter().filter(|scheme| scheme.default).collect(),
        own: false,
        tier: Tier::Quick,
        threads,
    };
    let mut wrong = Vec::new();
    for entry in &suite.run(&mut |_, _| {}).entries {
        let (name, law) = (entry.benchmark.name, entry.way.word());
        for run in &entry.runs {
            if let Err(failure) = &run.result {
                wrong.push(format!("{name} by {law} at {}: {failure}", run.resolution.cells));
            }
        }
        for target in entry.benchmark.targets {
            let measured = entry.judged(target).and_then(|run| run.result.as_ref().ok());
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
