//! How fast the error of places falls with the cells, by each basis.
//!
//! # Source
//! B17, whose file states it: a square that a manufactured body force stretches and squeezes by 31 % (after Wallstedt
//! and Guilkey 2008).
//!
//! # Set-up
//! B17 with 8, 16 and 32 cells on a side, by each basis with `modified-last` and `rflip`.
//!
//! # Expected
//! Second order by functions over the particles' boxes, p = ln(e_k/e_(k+1)) / ln 2 >= 1.8, as long as what boxes that
//! keep their width miss is small: from 8 to 16 cells by `gimp` (2.0) and `spline` (1.8), and on to 32 by `cpdi`, whose
//! domains stretch (2.6 and 2.4). `linear` has no order: the error grows with finer cells, for particles cross more of
//! them.
//!
//! # Known miss
//! From 16 to 32 cells `gimp` has the order 0.9 and `spline` 0.8, held above 0.5.

use stickslip_validation::{BENCHMARKS, Suite, Tier, schemes};

/// Errors with 8, 16 and 32 cells.
fn errors(basis: &str) -> [f64; 3] {
    let word = format!("{basis}-modified-last-rflip");
    let suite = Suite {
        benchmarks: BENCHMARKS.iter().filter(|benchmark| benchmark.name == "B17").collect(),
        laws: Vec::new(),
        schemes: schemes().iter().filter(|scheme| scheme.word == word).collect(),
        tier: Tier::Full,
        threads: 1,
    };
    let report = suite.run(&mut |_, _| {});
    let [entry] = &report.entries[..] else { panic!("one benchmark by one scheme") };
    let errors = [8.0, 16.0, 32.0].map(|cells| {
        let run = entry.runs.iter().find(|run| run.resolution.cells == cells).expect("the full tier has it");
        let outcome = run.result.as_ref().unwrap_or_else(|failure| panic!("{basis}, {cells}: {failure}"));
        outcome.value("error of places").expect("it is what B17 measures")
    });
    println!("{basis}: errors {errors:.4?}, orders {:.2?}", orders(errors));
    errors
}

fn orders([coarse, middle, fine]: [f64; 3]) -> [f64; 2] {
    [(coarse / middle).log2(), (middle / fine).log2()]
}

#[test]
fn boxes_that_keep_their_width_are_of_second_order_until_their_width_counts() {
    for basis in ["gimp", "spline"] {
        let [first, then] = orders(errors(basis));
        assert!(first >= 1.8 && then >= 0.5, "{basis}: {first}, {then}");
    }
}

#[test]
fn domains_that_stretch_are_of_second_order() {
    let orders = orders(errors("cpdi"));
    assert!(orders.into_iter().all(|order| order >= 1.8), "{orders:?}");
}

#[test]
fn linear_functions_have_no_order() {
    let errors = errors("linear");
    assert!(errors.is_sorted() && errors[0] > 0.1, "{errors:?}");
}
