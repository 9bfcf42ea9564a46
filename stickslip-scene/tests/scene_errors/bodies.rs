//! Bodies, contact, known answers, and scenes in the plane.

use crate::{ROLLING, WEDGE, check};

#[test]
fn bodies_contact_and_references() {
    let names = "(\"sphere\", \"plane\", \"rubber\", \"rock\", \"any\")";
    check(
        ROLLING,
        &[
            (
                "name = \"plane\"",
                "name = \"sphere\"",
                "49:8: bodies[1].name: found \"sphere\"; allowed: a name that no other body has",
            ),
            (
                "name = \"plane\"",
                "name = \"any\"",
                "49:8: bodies[1].name: found \"any\"; allowed: a name; `any` matches every body",
            ),
            (
                "rigid = {}",
                "rigid = {}\nvelocity = [0, 0, 0]",
                "53:1: bodies[1].velocity: found `velocity` of a rigid body; allowed: its motion in rigid = { velocity = ... }",
            ),
            (
                "spin = [0, \"5 rad/s\", 0]",
                "spin = 5",
                "46:8: bodies[0].spin: found 5; allowed: 3 numbers, as the scene is 3d, like [0, \"5 rad/s\", 0]",
            ),
            (
                "[\"sphere\", \"rock\"]",
                "[\"spheer\", \"rock\"]",
                &format!(
                    "55:12: contact[0].between[0]: found \"spheer\"; allowed: the name of a body or a material, or any {names}; did you mean `sphere`?"
                ),
            ),
            (
                "[\"sphere\", \"rock\"]",
                "[\"sphere\"]",
                "55:11: contact[0].between: found [\"sphere\"]; allowed: two names of bodies or materials: [\"sphere\", \"any\"]",
            ),
            (
                "friction = 0.495",
                "friction = -0.1",
                "57:12: contact[0].friction: found -0.1; allowed: a number from 0 on, or inf",
            ),
            (
                "max_strain = 0.5",
                "max_strain = 0",
                "58:14: contact[0].max_strain: found 0; allowed: a number above 0 and up to 1",
            ),
            (
                "contact = \"gap\"",
                "contact = \"gapp\"",
                "56:7: contact[0].law: found \"{contact}\", which is \"gapp\"; allowed: \"surface\", \"gap\", \"separation\", \"regression\", \"traction\", \"kinematic\", \"glued\" or \"none\"; did you mean `gap`?",
            ),
            (
                "law = \"{contact}\"",
                "law = \"surface\"\nnormal = \"own\"",
                "57:10: contact[0].normal: found \"own\"; allowed: \"common\" with law = \"surface\", which finds one direction for the pair",
            ),
            (
                "law = \"{contact}\"",
                "law = \"traction\"\ncohesion = 10",
                "57:12: contact[0].cohesion: found 10; allowed: 0 with each body's own normal; normal = \"common\" gives the pair one direction and an area",
            ),
            (
                "law = \"{contact}\"",
                "law = \"{contct}\"",
                "56:8: contact[0].law: found unknown parameter `contct`; allowed: a parameter (cells_per_radius, contact, cell, radius, angle); did you mean `contact`?",
            ),
            (
                "body = \"sphere\"",
                "body = \"plain\"",
                "66:8: references[0].body: found \"plain\"; allowed: the name of a body (\"sphere\", \"plane\"); did you mean `plane`?",
            ),
            (
                "quantity = \"x\"",
                "quantity = \"u\"",
                "67:12: references[0].quantity: found \"u\"; allowed: a column of bodies.csv (\"x\", \"y\", \"z\", \"vx\", \"vy\", \"vz\", \"wx\", \"wy\", \"wz\", \"mass\", \"kinetic\", \"strain\")",
            ),
            (
                "\"5 / 7 * 10 m/s^2 * sin(angle) * t\"",
                "\"10 m/s^2 * t^2\"",
                "74:9: references[1].value: found \"10 m/s^2 * t^2\", a length [m]; allowed: a velocity [m/s], like \"5 m/s\"",
            ),
            (
                "tables = \"10 ms\"",
                "tables = \"never\"",
                "61:11: outputs.tables: found unknown name `never`; allowed: a parameter (cells_per_radius, contact, cell, radius, angle), pi or inf",
            ),
            (
                "grid = \"never\"",
                "grid = 0",
                "63:8: outputs.grid: found 0; allowed: a time [s] above 0, like \"2.5 ms\"",
            ),
        ],
    );
}

#[test]
fn plane_scenes() {
    check(
        WEDGE,
        &[
            (
                "[0, \"-9.81 m/s^2\"]",
                "[0, 0, -9.81]",
                "3:11: gravity: found [0, 0, -9.81]; allowed: 2 numbers, as the scene is plane: [x, y]",
            ),
            (
                "spin = \"30 deg / 1 s\"",
                "spin = [0, 0, 1]",
                "33:8: bodies[0].spin: found [0, 0, 1]; allowed: one number, as the scene is plane: the turn about z, like \"5 rad/s\"",
            ),
            (
                "spin = \"30 deg / 1 s\"",
                "spin = \"30 deg\"",
                "33:8: bodies[0].spin: found \"30 deg\", an angle or a ratio; allowed: a rate [1/s], like \"5 rad/s\"",
            ),
            (
                "y_min = \"fixed\"",
                "z_min = \"fixed\"",
                "19:9: space.domain.z_min: found \"fixed\"; allowed: x_min, x_max, y_min and y_max only, as the scene is plane",
            ),
            (
                ", angle = \"5 deg\"",
                ", axis = [0, 0, 1], angle = \"5 deg\"",
                "45:121: bodies[1].shape.rotated.axis: found [0, 0, 1]; allowed: no axis, as the scene is plane",
            ),
            (
                "[0.05, 0.5], [0, 0.41]]",
                "[0.05, 0.5]]",
                "45:50: bodies[1].shape.rotated.shape.polygon.points: found [[-0.05, 0.5], [0.05, 0.5]]; allowed: at least 3 corners",
            ),
            (
                "normal = [0, 1]",
                "normal = [0, 0]",
                "38:54: bodies[0].shape.difference[1].intersection[1].half_space.normal: found [0, 0]; allowed: a direction, not zero",
            ),
            (
                "t / ramp",
                "t / rammp",
                "46:46: bodies[1].rigid.velocity[1]: found unknown name `rammp`; allowed: a parameter (g, drop, ramp), pi or inf; did you mean `ramp`?",
            ),
        ],
    );
}

/// What a rigid body is told to do: go with a velocity, or be somewhere; and only what deforms has a velocity by place.
#[test]
fn displacements_and_velocities_by_place() {
    let message = |keys: &str| {
        let text = format!(
            "space = {{ dimension = \"plane-strain\", cell = 0.1 }}\ntime.end = 1\n\
             materials.m = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }} }}\n\
             [[bodies]]\nname = \"a\"\nmaterial = \"m\"\nshape.box = {{ min = [0, 0], max = [1, 1] }}\n{keys}\n"
        );
        stickslip_scene::scene::parse("a.toml", &text, &[])
            .err()
            .map_or(String::new(), |error| error.to_string())
    };
    for (keys, found) in [
        (
            "rigid = { velocity = [1, 0], displacement = [\"1 m/s * t\", 0] }",
            "rigid.displacement: found `displacement` beside `velocity`; allowed: one of the two",
        ),
        ("rigid.displacement = [\"1 m * cos(t / 1 s)\", 0]", "allowed: one that is 0 at t = 0"),
        ("rigid = { free = {}, displacement = [0, 0] }", "found `displacement` prescribed to a free body"),
        ("rigid.displacement = [\"1 m/s\", 0]", "a velocity [m/s]; allowed: a length [m]"),
        ("rigid.free = {}\nvelocity = [\"x * 1 Hz\", 0]", "unknown name `x`"),
        ("velocity = [\"x * 1 Hz * t\", 0]", "`t`, the time"),
    ] {
        let message = message(keys);
        assert!(message.contains(found), "{keys}: {message}");
    }
    for keys in ["rigid.displacement = [\"1 m * sin(t / 1 s)\", 0]", "velocity = [\"x * 1 Hz\", 3]"] {
        assert_eq!(message(keys), "");
    }
}
