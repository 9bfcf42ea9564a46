//! Keys and tables: unknown, missing, misplaced; values of the wrong kind or unit.

use crate::{MINIMAL, check, edited};
use stickslip_scene::scene::{self, Dimension};

#[test]
fn keys() {
    let space = "dimension, cell, particles_per_side, basis, interior, precision, domain";
    check(
        MINIMAL,
        &[
            (
                "cell = ",
                "cel = ",
                &format!("3:1: space.cel: found unknown key `cel`; allowed: {space}; did you mean `cell`?"),
            ),
            (
                "cell = ",
                "gravity = [0, 0, 0]\ncell = ",
                &format!(
                    "3:1: space.gravity: found unknown key `gravity`; allowed: {space}; `gravity` belongs to the top of the file, above the first [table]"
                ),
            ),
            (
                "cell = \"0.1 m\"",
                "",
                "1:2: space.cell: found nothing, the key is missing; allowed: a length [m], like \"0.4 m\"",
            ),
            (
                "[time]\nend = \"1 s\"",
                "",
                "1:1: time: found nothing, the key is missing; allowed: a table with the keys end, courant, max_step, stress_update, transfer, pic_share, xpic_order, relax, energy_drift",
            ),
            (
                "[time]",
                "[[time]]",
                "5:1: time: found a list of 1; allowed: a table with the keys end, courant, max_step, stress_update, transfer, pic_share, xpic_order, relax, energy_drift",
            ),
            (
                "[[bodies]]",
                "[bodies]",
                "12:2: bodies: found a table; allowed: a list [...] of a table with the keys name, repeat, array, material, shape, beyond_mirrors, particles, particles_per_side, interior, cell, velocity, spin, rigid, stress; tables in a list have two brackets: [[bodies]]",
            ),
            (
                "radius = \"0.4 m\"",
                "raduis = \"0.4 m\"",
                "15:36: bodies[0].shape.ball.raduis: found unknown key `raduis`; allowed: center, radius; did you mean `radius`?",
            ),
            (
                ", radius = \"0.4 m\"",
                "",
                "15:7: bodies[0].shape.ball.radius: found nothing, the key is missing; allowed: a length [m], like \"0.4 m\"",
            ),
            (
                "shape.ball",
                "shape.bal",
                "15:7: bodies[0].shape.bal: found unknown shape `bal`; allowed: ball, box, cylinder, cone, ring, capsule, rounded_box, ellipsoid, superquadric, torus, half_space, polygon, spline, revolved, mesh, union, intersection, difference, rotated; did you mean `ball`?",
            ),
            (
                "shape.ball =",
                "shape.box = {}\nshape.ball =",
                "16:7: bodies[0].shape.ball: found a second shape, `ball`; allowed: one shape; union = [...] joins shapes",
            ),
        ],
    );
}

/// Two dimensions are plane strain where nothing else is said, as in other codes.
#[test]
fn the_plane_for_short() {
    let plane = edited(&edited(MINIMAL, "3d", "2d"), "[0, 0, 0]", "[0, 0]");
    let read = scene::parse("a.toml", &plane, &[]).expect("a scene in the plane");
    assert_eq!(read.scene.dimension, Dimension::PlaneStrain);
}

#[test]
fn types_and_units() {
    check(
        MINIMAL,
        &[
            ("\"0.1 m\"", "true", "3:8: space.cell: found `true`; allowed: a length [m], like \"0.4 m\""),
            ("\"0.1 m\"", "[1]", "3:8: space.cell: found [1]; allowed: a length [m], like \"0.4 m\""),
            (
                "\"0.1 m\"",
                "\"0.1 s\"",
                "3:8: space.cell: found \"0.1 s\", a time [s]; allowed: a length [m], like \"0.4 m\"",
            ),
            (
                "\"6 MPa\"",
                "\"6 mm\"",
                "10:32: materials.rubber.neo_hookean.bulk_modulus: found \"6 mm\", a length [m]; allowed: a pressure [Pa], like \"6 MPa\"",
            ),
            (
                "\"6 MPa\"",
                "\"6 Mpa\"",
                "10:35: materials.rubber.neo_hookean.bulk_modulus: found `Mpa` after a number; allowed: a unit such as m, mm, kg, ms, MPa, deg; did you mean `MPa`?",
            ),
            (
                "\"0.1 m\"",
                "0.1 m",
                "3:8: found `0.1 m` without quotes; allowed: a number, or text in quotes; text, and numbers with units, stand in quotes: cell = \"0.4 m\"",
            ),
            ("end =", "end = 2\nend =", "7:1: found `end` for the second time; allowed: each key once"),
            (
                "[0, 0, 0]",
                "[0, 0]",
                "15:25: bodies[0].shape.ball.center: found [0, 0]; allowed: 3 numbers, as the scene is 3d: [x, y, z]",
            ),
            (
                "[0, 0, 0]",
                "[0, \"1 s\", 0]",
                "15:29: bodies[0].shape.ball.center[1]: found \"1 s\", a time [s]; allowed: a length [m], like \"0.4 m\"",
            ),
            (
                "[0, 0, 0]",
                "0",
                "15:25: bodies[0].shape.ball.center: found 0; allowed: a list such as [0, \"0.4 m\", 0], two in the plane",
            ),
            (
                "\"3d\"",
                "\"2D\"",
                "2:13: space.dimension: found \"2D\"; allowed: \"plane-strain\", \"plane-stress\", \"2d\" or \"3d\"; did you mean `2d`?",
            ),
            (
                "\"3d\"",
                "\"plane_strain\"",
                "2:13: space.dimension: found \"plane_strain\"; allowed: \"plane-strain\", \"plane-stress\", \"2d\" or \"3d\"; did you mean `plane-strain`?",
            ),
            (
                "\"1 s\"",
                "\"1 s + 1 m\"",
                "6:8: time.end: found a time [s] with a length [m]; allowed: terms of the same dimension",
            ),
            (
                "\"1 s\"",
                "\"2 * t\"",
                "6:12: time.end: found `t`, the time; allowed: a formula without time: only prescribed motion, gravity, loads and references vary in time",
            ),
            (
                "\"1 s\"",
                "\"1 s / 0\"",
                "6:7: time.end: found \"1 s / 0\", which is inf s; allowed: a time [s], like \"2.5 ms\"",
            ),
            ("\"ball\"", "7", "13:8: bodies[0].name: found 7; allowed: text in quotes"),
        ],
    );
}

#[test]
fn laws_of_other_programs_have_an_answer() {
    let law = MINIMAL.lines().find(|line| line.starts_with("neo_hookean")).expect("a law");
    for (other, answer) in [
        ("sand", "here: `drucker_prager` or `mohr_coulomb`, with friction_angle"),
        ("cam_clay", "here: `modified_cam_clay`, which hardens as it is compacted"),
        ("JC", "here: `johnson_cook`, with yield_stress = A"),
        ("mooney", "here: `mooney_rivlin`, with c10"),
        ("elastic", "here: `hypoelastic`, Hooke's law"),
        ("jh2", "here: none that tension cracks and pressure crushes"),
        ("hoek_brown", "here: `mohr_coulomb`, with friction_angle"),
        ("creep", "here: `von_mises` flows by a power of its overstress"),
        ("MAT_DRUCKER_PRAGER", "did you mean `drucker_prager`?"),
    ] {
        let text = edited(MINIMAL, law, &format!("{other} = {{ young_modulus = 1e6 }}"));
        let error = scene::parse("a.toml", &text, &[]).expect_err("no law of ours").to_string();
        assert!(error.contains(&format!("found unknown key `{other}`; allowed: density, ")), "{error}");
        assert!(error.contains(&format!("; {answer}")), "{error}");
    }
}

/// Johnson and Cook (1983) eq. (1) has A, B, n, C and m.
#[test]
fn constants_of_papers_are_told_their_keys() {
    let law = MINIMAL.lines().find(|line| line.starts_with("neo_hookean")).expect("a law");
    for (letter, key) in [("A", "yield_stress"), ("B", "hardening_modulus"), ("C", "rate_coefficient")] {
        let text = edited(MINIMAL, law, &format!("johnson_cook = {{ young_modulus = 1e6, {letter} = 1e6 }}"));
        let error = scene::parse("a.toml", &text, &[]).expect_err("a letter is no key").to_string();
        assert!(
            error.contains(&format!("johnson_cook.{letter}: found unknown key `{letter}`; allowed: ")),
            "{error}"
        );
        assert!(error.ends_with(&format!("; did you mean `{key}`?")), "{error}");
    }
}
