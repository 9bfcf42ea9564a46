//! Periodic domains: faces that do not fit each other, and bodies that they cannot hold.

use crate::{edited, message};
use stickslip_scene::{check, scene};

const TUBE: &str = r#"[space]
dimension = "plane-strain"
cell = 0.1
[space.domain]
min = [0, -1]
max = [2.4, 2]
x_min = "periodic"
x_max = "periodic"
[time]
end = 1
[materials.rubber]
density = 1000
neo_hookean = { young_modulus = 1e5, poisson_ratio = 0.3 }
[[bodies]]
name = "floor"
material = "rubber"
shape.half_space = { point = [0, 0], normal = [0, 1] }
rigid = {}
[[bodies]]
name = "left"
material = "rubber"
shape.ball = { center = [0.1, 0.3], radius = 0.3 }
[[bodies]]
name = "right"
material = "rubber"
shape.ball = { center = [1.8, 0.3], radius = 0.3 }
[[bodies]]
name = "lid"
material = "rubber"
shape.box = { min = [0, 1], max = [2.4, 1.2] }
rigid.free = {}
[[joints]]
body = "lid"
slider = { axis = [0, 1] }
"#;

/// What is wrong with the scene after an edit, if it can be read.
fn problem(from: &str, to: &str) -> Option<String> {
    let loaded =
        scene::parse("a.toml", &edited(TUBE, from, to), &[]).unwrap_or_else(|error| panic!("{error}"));
    let problem = check::problems(&loaded.scene).err()?;
    Some(loaded.source.locate(problem).to_string())
}

#[test]
fn a_sound_one_is_sound() {
    assert_eq!(problem("end = 1", "end = 2"), None);
    // Two disks whose surfaces touch through the faces.
    assert_eq!(problem("center = [1.8, 0.3]", "center = [1.9, 0.3]"), None);
    // Rigid bodies that may meet anywhere.
    let ram = "[[bodies]]\nname = \"ram\"\nmaterial = \"rubber\"\nshape.box = { min = [0.6, 0.1], max = [0.8, 0.3] }\n\
               rigid.free = {}\n[[joints]]";
    assert_eq!(problem("[[joints]]", ram), None);
}

#[test]
fn faces_that_do_not_fit() {
    let cases = [
        (
            "x_max = \"periodic\"",
            "",
            "a.toml:7:9: space.domain.x_min: found \"periodic\", and `x_max` is not; allowed: both faces across x \
             periodic, or neither",
        ),
        (
            "x_max = \"periodic\"",
            "x_max = \"periodic\"\ny_max = \"periodic\"",
            "a.toml:9:9: space.domain.y_max: found \"periodic\", and `y_min` is not; allowed: both faces across y \
             periodic, or neither",
        ),
        (
            "max = [2.4, 2]",
            "max = [2.2, 2]",
            "a.toml:6:7: space.domain.max: found a period of 22 cells of 0.1 m along x; allowed: 8 cells or more between \
             periodic faces, a multiple of 4; put the upper x face at 2.4 m, or take cells of 0.09166666667 m",
        ),
        (
            "max = [2.4, 2]",
            "max = [0.4, 2]",
            "a.toml:6:7: space.domain.max: found a period of 4 cells of 0.1 m along x; allowed: 8 cells or more between \
             periodic faces, a multiple of 4; put the upper x face at 0.8 m, or take cells of 0.05 m",
        ),
        (
            "[time]",
            "[outputs]\nreactions = [\"x_max\"]\n[time]",
            "a.toml:10:13: outputs.reactions: found `x_max`, a face of the domain that is periodic; allowed: faces that \
             are \"symmetry\" or \"fixed\"",
        ),
    ];
    for (from, to, expected) in cases {
        assert_eq!(problem(from, to).as_deref(), Some(expected), "`{from}` -> `{to}`");
    }
    assert_eq!(
        message(&edited(TUBE, "x_max = \"periodic\"", "x_max = \"cyclic\"")),
        "a.toml:8:9: space.domain.x_max: found \"cyclic\"; allowed: \"open\", \"symmetry\", \"fixed\" or \"periodic\""
    );
}

#[test]
fn bodies_that_it_cannot_hold() {
    let cases = [
        (
            "center = [1.8, 0.3]",
            "center = [2.0, 0.3]",
            "a.toml:26:1: bodies[2].shape: found `right` overlaps `left` in 8 particles near (-0.1750, 0.2250) m, \
             through a periodic face; allowed: bodies that touch but do not overlap; move one of them, or cut one shape \
             out of the other with a difference",
        ),
        (
            "center = [1.8, 0.3]",
            "center = [3.4, 0.3]",
            "a.toml:26:1: bodies[2].shape: found the middle of `right` lies at 3.4 m along x; allowed: from 0 to 2.4 m, \
             in the domain",
        ),
        (
            "shape.ball = { center = [1.8, 0.3], radius = 0.3 }",
            "shape.box = { min = [0.1, 0.6], max = [2.4, 0.8] }",
            "a.toml:26:1: bodies[2].shape: found `right` is 2.3 m long along x, with a period of 2.4 m; allowed: at most \
             2.1 m, which leaves 3 cells between it and its next image; or 2.4 m, which joins it to that",
        ),
        (
            "normal = [0, 1]",
            "normal = [0.1, 1]",
            "a.toml:17:1: bodies[0].shape: found `floor`, which has no bounds and does not go straight on along x; \
             allowed: along periodic x, half-spaces whose normals have no part along x",
        ),
        (
            "rigid = {}",
            "rigid = { spin = 1 }",
            "a.toml:18:18: bodies[0].rigid.spin: found `floor`, which has no bounds, turns in a periodic domain; allowed: \
             no spin",
        ),
        (
            "slider = { axis = [0, 1] }",
            "hinge = { point = [1.2, 1] }",
            "a.toml:31:1: bodies[3].rigid: found `lid`, which is joined to its own images along x, turns; allowed: no \
             turning but about x; hold it by a slider in [[joints]]",
        ),
    ];
    for (from, to, expected) in cases {
        assert_eq!(problem(from, to).as_deref(), Some(expected), "`{from}` -> `{to}`");
    }
}

#[test]
fn grains_longer_than_a_container_that_repeats() {
    let packing = "[[packings]]\nname = \"grain\"\nmaterial = \"rubber\"\nshape.ball = { center = [0, 0], radius = 0.7 }\n\
                   within.box = { min = [0, -0.9], max = [2.4, 0.9] }\ncount = 1\n[[joints]]";
    assert_eq!(
        message(&edited(TUBE, "[[joints]]", packing)),
        "a.toml:36:1: packings[0].within: found a container that repeats along x and is shorter than two of the largest \
         grains; allowed: at least 3.3600 m between the periodic faces"
    );
}
