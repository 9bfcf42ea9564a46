//! How fast the error of places falls with the cells, by each basis.
//!
//! # Source
//! B17 and B19, whose files state them: a square that a manufactured body force stretches and squeezes by 31 % along
//! the axes (after Wallstedt and Guilkey 2008), and a ring that turns and is sheared by up to 71 % (after Kamojjala,
//! Brannon, Sadeghirad and Guilkey 2015).
//!
//! # Set-up
//! B17 with 8, 16 and 32 cells on a side, B19 with R/16 and R/32, by each basis with `modified-last` and `rflip`.
//!
//! # Expected
//! Second order by functions over the particles' boxes, p = ln(e_k/e_(k+1)) / ln 2 >= 1.8, as long as what boxes that
//! keep their width miss is small: from 8 to 16 cells by `gimp` (2.0) and `spline` (1.8). `linear` has no order: the
//! error grows with finer cells, for particles cross more of them. B19 is of second order by `gimp` (1.85) and `spline`
//! (1.8), and of order 0.2 by `linear`.
//!
//! # Known miss
//! In B17 from 16 to 32 cells `gimp` has the order 0.9 and `spline` 0.8, held above 0.5. In B19 from R/32 to R/64
//! `gimp` has 0.66, whose error the benchmark bounds.

use stickslip_validation::{BENCHMARKS, Run, Suite, Tier, schemes};

/// Errors of a benchmark's runs, from coarse to fine.
fn errors(name: &str, tier: Tier, basis: &str) -> Vec<f64> {
    let word = format!("{basis}-modified-last-rflip");
    let suite = Suite {
        benchmarks: BENCHMARKS.iter().filter(|benchmark| benchmark.name == name).collect(),
        laws: Vec::new(),
        schemes: schemes().iter().filter(|scheme| scheme.word == word).collect(),
        own: false,
        tier,
        threads: 1,
    };
    let report = suite.run(&mut |_, _| {});
    let [entry] = &report.entries[..] else { panic!("one benchmark by one scheme") };
    let error = |run: &Run| {
        let cells = run.resolution.cells;
        let outcome = run.result.as_ref().unwrap_or_else(|failure| panic!("{basis}, {cells}: {failure}"));
        outcome.value("error of places").expect("it is what the benchmark measures")
    };
    let errors: Vec<f64> = entry.runs.iter().map(error).collect();
    println!("{name}, {basis}: errors {errors:.4?}, orders {:.2?}", orders(&errors));
    errors
}

/// Between one resolution and the next, of which each halves the cells.
fn orders(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect()
}

#[test]
#[ignore = "slow"]
fn boxes_that_keep_their_width_are_of_second_order_until_their_width_counts() {
    for basis in ["gimp", "spline"] {
        let orders = orders(&errors("B17", Tier::Full, basis));
        assert!(orders[0] >= 1.8 && orders[1] >= 0.5, "{basis}: {orders:?}");
    }
}

#[test]
#[ignore = "slow"]
fn linear_functions_have_no_order() {
    let errors = errors("B17", Tier::Full, "linear");
    assert!(errors.is_sorted() && errors[0] > 0.1, "{errors:?}");
}

#[test]
fn a_vortex_is_of_second_order() {
    is_of_second_order_in_a_vortex("gimp");
}

#[test]
#[ignore = "slow"]
fn a_vortex_is_of_second_order_by_boxes_of_a_cell() {
    is_of_second_order_in_a_vortex("spline");
}

fn is_of_second_order_in_a_vortex(basis: &str) {
    let orders = orders(&errors("B19", Tier::Quick, basis));
    assert!(orders[0] >= 1.8, "{basis}: {orders:?}");
}

#[test]
#[ignore = "slow"]
fn linear_functions_stall_in_a_vortex() {
    let orders = orders(&errors("B19", Tier::Quick, "linear"));
    assert!(orders[0] < 0.5, "{orders:?}");
}
