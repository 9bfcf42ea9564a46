//! Tension that lasts and spin, where the stress is updated first or last.
//!
//! # Source
//! The benchmarks B30, B31 and B32: each states its source.
//!
//! # Set-up
//! A bar that hangs (B30, L/25) and a strip that is held and pulled (B31, L/50), by `gimp-first-rflip` and
//! `gimp-last-rflip`; the disks that spin freely (B32, R/5) by `gimp-first-rflip`.
//!
//! # Expected
//! The targets of B30 and B31, 5 % for the sag, which is half of what B30 allows at L/25; but for the force at twice the
//! length, where GIMP has torn whatever the stress update.
//!
//! # Known miss
//! `first` makes spin: a body that turns by the angle w dt in a step gains about 2 pi w dt of its angular momentum in a
//! turn, which are 1.4 % for the disk and 0.14 % for the slow one. Allowed is no more than that, and no loss.

use stickslip_validation::{BENCHMARKS, Case, Outcome, Tier, laws, schemes};

/// What a benchmark measures by a scheme, on one thread.
fn measured(name: &str, word: &str, cells: f64) -> Outcome {
    let benchmark = BENCHMARKS.iter().find(|benchmark| benchmark.name == name).expect("its name");
    let scheme = schemes().iter().find(|scheme| scheme.word == word).expect("its word");
    let case = Case { law: laws()[0].word, interior: "grid", scheme, cells, tier: Tier::Quick };
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread can be started");
    let outcome = alone.install(|| (benchmark.run)(&case));
    outcome.unwrap_or_else(|failure| panic!("{name} by {word}: {failure}"))
}

/// The value of a quantity, which is printed.
fn value(outcome: &Outcome, metric: &str) -> f64 {
    let value = outcome.value(metric).unwrap_or_else(|| panic!("{metric} is not measured"));
    println!("{metric}: {value:.5}");
    value
}

fn tension_lasts(word: &str) {
    println!("{word}");
    let bar = measured("B30", word, 25.0);
    let strip = measured("B31", word, 50.0);
    for (outcome, metric, exact, bound) in [
        (&bar, "mean sag, late", 1.0, 0.05),
        (&bar, "mean sag, late over early", 1.0, 0.02),
        (&bar, "energy drift", 0.0, 0.02),
        (&strip, "force at 1.01, early", 1.0, 0.02),
        (&strip, "force at 1.01, late", 1.0, 0.02),
        (&strip, "force at 1.01, late over early", 1.0, 0.005),
        (&strip, "force at 1.2", 1.0, 0.03),
    ] {
        let value = value(outcome, metric);
        assert!((value - exact).abs() <= bound, "{word}, {metric}: {value}, allowed {exact} +- {bound}");
    }
}

#[test]
fn tension_lasts_by_first() {
    tension_lasts("gimp-first-rflip");
}

#[test]
fn tension_lasts_by_last() {
    tension_lasts("gimp-last-rflip");
}

#[test]
fn spin_grows_by_first_no_faster_than_is_known() {
    let outcome = measured("B32", "gimp-first-rflip", 5.0);
    // The disk turns twice, the slow one once.
    for (metric, turns, a_turn) in
        [("angular momentum, disk", 2.0, 0.014), ("angular momentum, slow disk", 1.0, 0.0014)]
    {
        let gained = value(&outcome, metric) - 1.0;
        assert!((0.0..=turns * a_turn).contains(&gained), "{metric}: {gained}");
    }
}
