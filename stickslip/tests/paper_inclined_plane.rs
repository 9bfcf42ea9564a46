//! A soft sphere on an inclined plane against a rigid one.
//!
//! # Source
//! Bardenhagen, Guilkey, Roessig, Brackbill, Witzel and Foster (2001), CMES 2(4), 509-522, section 3.1, figures 3 to 6.
//!
//! # Set-up
//! ```text
//!          _____
//!        /       \            z
//!       |    o--R-|           |   gravity 10 m/s^2, inclined by pi/4 or pi/3 toward x
//!        \ _____ /            |
//!   ---------+-----------     +---- x, distance down the slope
//!   /////////////////////
//! ```
//! `scenes/paper/inclined_plane_no_slip.toml` and `inclined_plane_slip.toml`: R = 1.6 m, halved by a symmetry plane;
//! neo-Hookean with K = 6 MPa, G = 3 MPa, 1000 kg/m^3, on a plane ten times as stiff and dense;
//! cells of R/2 to R/12 with 8 particles, GIMP; 2 s.
//!
//! # Expected
//! Ratios to the rigid solution, x = (25 sqrt 2 / 14) t^2 (23) without slip and x = (5/2)(sqrt 3 - 2/7) t^2 (24) with
//! slip; from the default also the height at which Hertz lets the centre stand, R - (9 F^2 / (16 R E*^2))^(1/3) with
//! E* = 7.64 MPa: 1.555 m and 1.565 m. The paper's rule holds the sphere 0.6 cells above the plane and is slower, as
//! the paper finds, the more so the larger the cells.
//!
//! # Tolerance
//! | cells | contact  | no slip: x, v  | expected        | slip: x, v     | expected  |
//! |-------|----------|----------------|-----------------|----------------|-----------|
//! | R/2   | traction | 0.012          | x < 0.02        |                |           |
//! | R/4   | traction | 0.821, 0.902   | x 0.80 to 0.92  | 0.859, 0.916   |           |
//! | R/8   | traction | 0.948, 0.987   | x 0.93, v 0.96  | 0.924, 0.967   | x 0.91    |
//! | R/12  | traction | 0.976, 1.001   | x nearer still  |                |           |
//! | R/4   | default  | 0.986, 0.961   | x within 7 %    | 1.003, 1.000   | x within 3 % |
//! | R/8   | default  | 1.003, 0.993   | x within 3 %    | 1.001, 0.991   | x within 3 % |
//!
//! The older, kinematic rule gives 0.862, 0.954 at R/4 and 0.965, 1.010 at R/8 without slip, and 0.937, 0.980 at R/8
//! with it. Over the kinetic energy at the end, energy comes from nowhere by 1.4 % with the older rule at R/4, and is
//! lost by 1.6 % with the paper's and by 0.9 % with the default.
//!
//! Room is left for where nodes lie under the sphere: shifted along the slope by quarters of a cell, the law gap at R/4
//! without slip gives 0.952 to 0.958, shifted across it 0.930 to 0.952. Runs repeat bit for bit.

mod paper_sphere;

use paper_sphere::Roll;

/// The paper's transfer, which its rule is run with.
const FLIP: (&str, &str) = ("time.transfer", "flip");

const NO_SLIP: &str = "inclined_plane_no_slip.toml";
const SLIP: &str = "inclined_plane_slip.toml";

/// Side of a cell at R/8 [m].
const FINE_CELL: f64 = 0.2;
/// Side of a cell at R/4 [m].
const COARSE_CELL: f64 = 0.4;

#[test]
fn the_default_rolls_on_coarse_cells() {
    let roll = Roll::down(NO_SLIP, &[("cells_per_radius", "4")]);
    assert!((roll.distance - 1.0).abs() < 0.07, "{roll:?}");
    assert!((roll.rolling - 1.0).abs() < 0.1, "{roll:?}");
    assert!((roll.height - 1.555).abs() < 0.1 * COARSE_CELL, "{roll:?}");
    assert!((-0.015..0.002).contains(&roll.gain), "{roll:?}");
}

#[test]
fn the_default_slips_on_coarse_cells() {
    let roll = Roll::down(SLIP, &[("cells_per_radius", "4")]);
    assert!((roll.distance - 1.0).abs() < 0.03, "{roll:?}");
    assert!((roll.height - 1.565).abs() < 0.1 * COARSE_CELL, "{roll:?}");
    // Nodes that meet lose energy (measured -0.66 %); friction is booked as what it takes from the particles.
    assert!((-0.01..0.002).contains(&roll.gain), "{roll:?}");
}

/// "A flat spot" keeps the sphere where it is (figure 5). It does where the plane's surface lies amid a cell, as in the
/// scene; on nodes, with a plane of one cell, the sphere rides half a cell above it and slides half the way.
#[test]
fn the_papers_rule_does_not_roll_on_the_coarsest_cells() {
    let paper = [("cells_per_radius", "2"), ("contact", "traction"), FLIP];
    let roll = Roll::down(NO_SLIP, &paper);
    assert!(roll.distance.abs() < 0.02 && roll.speed.abs() < 0.02, "{roll:?}");
    let shallow = [("space.domain.min", "[-4, 0, -0.8]"), ("bodies[1].shape.box.min", "[-3.2, 0, -0.8]")];
    let riding = Roll::down(NO_SLIP, &[&paper[..], &shallow].concat());
    assert!(riding.distance < 0.6 && riding.rolling < 0.7, "{riding:?}");
}

#[test]
fn the_papers_rule_lags_on_coarse_cells_and_loses_energy_where_the_older_rule_gains() {
    let [paper, older] = ["traction", "kinematic"]
        .map(|contact| Roll::down(NO_SLIP, &[("cells_per_radius", "4"), ("contact", contact), FLIP]));
    assert!((0.80..0.92).contains(&paper.distance), "{paper:?}");
    assert!((0.80..0.92).contains(&older.distance), "{older:?}");
    assert!((-0.025..0.0).contains(&paper.gain), "{paper:?}");
    assert!((0.005..0.025).contains(&older.gain), "{older:?}");
}

#[test]
#[ignore = "slow: two minutes"]
fn the_default_rolls_as_a_rigid_sphere() {
    let roll = Roll::down(NO_SLIP, &[("cells_per_radius", "8")]);
    assert!((roll.distance - 1.0).abs() < 0.03, "{roll:?}");
    assert!((roll.speed - 1.0).abs() < 0.03, "{roll:?}");
    assert!((roll.height - 1.555).abs() < 0.1 * FINE_CELL, "{roll:?}");
    assert!(roll.gain.abs() < 0.005, "{roll:?}");
}

#[test]
#[ignore = "slow: two minutes"]
fn the_default_slips_as_a_rigid_sphere() {
    let roll = Roll::down(SLIP, &[("cells_per_radius", "8")]);
    assert!((roll.distance - 1.0).abs() < 0.03, "{roll:?}");
    assert!((roll.speed - 1.0).abs() < 0.03, "{roll:?}");
    assert!((roll.height - 1.565).abs() < 0.1 * FINE_CELL, "{roll:?}");
    assert!(roll.gain.abs() < 0.005, "{roll:?}");
}

#[test]
#[ignore = "slow: ten minutes"]
fn the_papers_rule_converges_without_slip() {
    let [coarse, fine, finest] = ["4", "8", "12"]
        .map(|cells| Roll::down(NO_SLIP, &[("cells_per_radius", cells), ("contact", "traction"), FLIP]));
    assert!(fine.distance >= 0.93 && fine.speed >= 0.96, "{fine:?}");
    assert!((fine.distance - 1.0).abs() < (coarse.distance - 1.0).abs(), "{coarse:?} {fine:?}");
    assert!((finest.distance - 1.0).abs() < (fine.distance - 1.0).abs(), "{fine:?} {finest:?}");
}

#[test]
#[ignore = "slow: two minutes"]
fn the_papers_rule_converges_with_slip() {
    let [coarse, fine] = ["4", "8"]
        .map(|cells| Roll::down(SLIP, &[("cells_per_radius", cells), ("contact", "traction"), FLIP]));
    assert!(fine.distance >= 0.91, "{fine:?}");
    assert!((fine.distance - 1.0).abs() < (coarse.distance - 1.0).abs(), "{coarse:?} {fine:?}");
}

/// For the record: the paper gives no such run.
#[test]
#[ignore = "slow: four minutes"]
fn the_older_rule_on_fine_cells() {
    for (scene, distance) in [(NO_SLIP, 0.965), (SLIP, 0.937)] {
        let roll = Roll::down(scene, &[("cells_per_radius", "8"), ("contact", "kinematic"), FLIP]);
        assert!((roll.distance - distance).abs() < 0.02, "{roll:?}");
        assert!(roll.gain > 0.01, "{roll:?}");
    }
}
