//! A spinning soft sphere set on a plane against a rigid one.
//!
//! # Source
//! Bardenhagen, Guilkey, Roessig, Brackbill, Witzel and Foster (2001), CMES 2(4), 509-522, section 3.2,
//! figures 7 and 8.
//!
//! # Set-up
//! ```text
//!          _____
//!        /   ->  \  5 rad/s   z
//!       |    o--R-|           |   gravity 10 m/s^2
//!        \ _<-__ /            |
//!   ---------+-----------     +---- x, distance
//!   /////////////////////
//! ```
//! `scenes/paper/backspin.toml`: R = 1 m, halved by a symmetry plane, friction 0.5; neo-Hookean with K = 6 MPa, G = 3
//! MPa, 1000 kg/m^3, on a plane ten times as stiff and dense; cells of R/4 to R/12 with 8 particles, GIMP; 1 s.
//!
//! # Expected
//! Ratios to the rigid solution, which slips for 2/7 s, x = (5/2) t^2 (25), and then rolls at 10/7 m/s (26); from the
//! default also the height at which Hertz lets the centre stand, R - (9 F^2 / (16 R E*^2))^(1/3) with E* = 7.64 MPa:
//! 0.974 m.
//!
//! # Tolerance
//! | cells | contact  | x, v           | expected     |
//! |-------|----------|----------------|--------------|
//! | R/4   | default  | 0.926, 0.860   |              |
//! | R/8   | default  | 0.982, 0.978   | x within 4 % |
//! | R/12  | default  | 0.997, 0.994   |              |
//! | R/4   | traction | 0.237, -0.217  |              |
//! | R/8   | traction | 0.718, 0.483   | x 0.65       |
//! | R/12  | traction | 0.889, 0.735   | x 0.87       |
//!
//! The older, kinematic rule gives 0.439 at R/4 and 0.820, 0.887 at R/8,
//! and gains 73 % of the final kinetic energy there, the paper's 4 %.
//!
//! The sphere skips, more the larger the cells, and what it does between two landings decides how far it gets: shifted
//! by quarters of a cell along the plane the default at R/4 gives 0.926 to 0.966, which is why R/4 is held to 10 %
//! only. Runs repeat bit for bit.

mod paper_sphere;

use paper_sphere::Roll;

/// The paper's transfer, which its rule is run with.
const FLIP: (&str, &str) = ("time.transfer", "flip");

const BACKSPIN: &str = "backspin.toml";

/// Side of a cell at R/8 [m].
const FINE_CELL: f64 = 0.125;
/// Side of a cell at R/4 [m].
const COARSE_CELL: f64 = 0.25;

#[test]
fn the_default_gathers_speed_on_coarse_cells() {
    let roll = Roll::down(BACKSPIN, &[("cells_per_radius", "4")]);
    assert!((roll.distance - 1.0).abs() < 0.1, "{roll:?}");
    assert!((roll.rolling - 1.0).abs() < 0.15, "{roll:?}");
    assert!((roll.height - 0.974).abs() < 0.1 * COARSE_CELL, "{roll:?}");
}

#[test]
#[ignore = "slow: one minute"]
fn the_default_rolls_as_a_rigid_sphere() {
    let roll = Roll::down(BACKSPIN, &[("cells_per_radius", "8")]);
    assert!((roll.distance - 1.0).abs() < 0.04, "{roll:?}");
    assert!((roll.speed - 1.0).abs() < 0.05, "{roll:?}");
    assert!((roll.rolling - 1.0).abs() < 0.05, "{roll:?}");
    assert!((roll.height - 0.974).abs() < 0.1 * FINE_CELL, "{roll:?}");
}

#[test]
#[ignore = "slow: six minutes"]
fn the_papers_rule_converges() {
    let [coarse, fine, finest] = ["4", "8", "12"]
        .map(|cells| Roll::down(BACKSPIN, &[("cells_per_radius", cells), ("contact", "traction"), FLIP]));
    assert!(fine.distance >= 0.65, "{fine:?}");
    assert!(finest.distance >= 0.87, "{finest:?}");
    assert!((fine.distance - 1.0).abs() < (coarse.distance - 1.0).abs(), "{coarse:?} {fine:?}");
    assert!((finest.distance - 1.0).abs() < (fine.distance - 1.0).abs(), "{fine:?} {finest:?}");
}

/// For the record: the paper gives no such run.
#[test]
#[ignore = "slow: one minute"]
fn the_older_rule_on_fine_cells() {
    let roll = Roll::down(BACKSPIN, &[("cells_per_radius", "8"), ("contact", "kinematic"), FLIP]);
    assert!((roll.distance - 0.82).abs() < 0.05, "{roll:?}");
    assert!(roll.gain > 0.3, "{roll:?}");
}
