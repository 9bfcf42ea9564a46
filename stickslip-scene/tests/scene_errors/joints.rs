//! Free rigid bodies and joints.

use crate::check;
use stickslip_scene::{check as checks, scene};

const CART: &str = r#"[space]
dimension = "plane-strain"
cell = 0.1
[time]
end = 1
[materials.steel]
density = 7800
neo_hookean = { young_modulus = "200 GPa", poisson_ratio = 0.3 }
[[bodies]]
name = "cart"
material = "steel"
shape.box = { min = [0, 1], max = [2, 1.5] }
rigid.free = { mass = "2 t/m" }
[[bodies]]
name = "wheel"
material = "steel"
shape.ball = { center = [1, 0.5], radius = 0.5 }
rigid.free = { mass = "100 kg", inertia = "20 kg*m^2" }
[[bodies]]
name = "road"
material = "steel"
shape.box = { min = [-9, -1], max = [9, 0] }
[[joints]]
name = "axle"
body = "wheel"
to = "cart"
hinge = { point = [1, 0.5], speed = "20 rad/s", limit = "500 N m" }
[[joints]]
body = "cart"
slider = { axis = [1, 0], force = "1 kN" }
[[joints]]
body = "cart"
spring = { from = [0, 1], to = [-1, 1], stiffness = "1 kN/m" }
"#;

#[test]
fn joints() {
    let loaded = scene::parse("a.toml", CART, &[]).unwrap_or_else(|error| panic!("{error}"));
    let names: Vec<_> = loaded.scene.joints.iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(names, ["axle", "joint 2", "joint 3"]);
    check(
        CART,
        &[
            ("body = \"wheel\"", "body = \"road\"", ""),
            ("to = \"cart\"", "to = \"road\"", ""),
            ("to = \"cart\"", "to = \"wheel\"", ""),
            ("name = \"axle\"", "name = \"joint 2\"", ""),
            ("point = [1, 0.5], ", "point = [1, 0.5], axis = [0, 0, 1], ", ""),
            ("point = [1, 0.5], ", "", ""),
            ("speed = \"20 rad/s\", ", "", ""),
            ("\"500 N m\"", "\"-1 N m\"", ""),
            ("\"500 N m\"", "\"500 N\"", ""),
            ("\"20 rad/s\"", "\"20 m/s\"", ""),
            ("slider = {", "weld = {}\nslider = {", ""),
            ("slider = { axis = [1, 0], force = \"1 kN\" }", "", ""),
            ("axis = [1, 0]", "axis = [0, 0]", ""),
            ("slider = {", "rail = {", ""),
            (", stiffness = \"1 kN/m\"", "", ""),
            ("to = [-1, 1]", "to = [0, 1]", ""),
            ("\"1 kN/m\"", "\"1 kN\"", ""),
        ],
    );
}

#[test]
fn free_rigid_bodies() {
    check(
        CART,
        &[
            ("rigid.free = { mass = \"2 t/m\" }", "rigid = { free = {}, velocity = [1, 0] }", ""),
            ("mass = \"2 t/m\"", "mass = 0", ""),
            ("mass = \"2 t/m\"", "mass = \"2 m\"", ""),
            ("inertia = \"20 kg*m^2\"", "inertia = [1, 2, 3]", ""),
            ("inertia = \"20 kg*m^2\"", "inertia = -1", ""),
            ("mass = \"2 t/m\"", "weight = 2", ""),
        ],
    );
}

/// What the check before a run finds in the scene with an edit: its key and what was found.
fn problem(from: &str, to: &str) -> (String, String) {
    assert!(CART.contains(from), "{from}");
    let text = CART.replacen(from, to, 1);
    let scene = scene::parse("a.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    let problem = checks::problems(&scene).expect_err("it is wrong");
    (problem.key, problem.found)
}

#[test]
fn joints_hold_near_their_bodies() {
    for (from, to, found) in [
        ("point = [1, 0.5]", "point = [1, 500]", ("", "")),
        (
            "shape.box = { min = [0, 1], max = [2, 1.5] }",
            "shape.half_space = { point = [0, 0], normal = [0, -1] }",
            ("", ""),
        ),
        (
            "cell = 0.1",
            "cell = 0.1\ndomain = { min = [-9, -1], max = [2, 9], x_max = \"symmetry\" }",
            ("", ""),
        ),
    ] {
        let (key, what) = problem(from, to);
        assert_eq!((key.as_str(), what.as_str()), found);
    }
}
