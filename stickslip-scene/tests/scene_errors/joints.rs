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
rigid.free = { mass = "2000 kg/m" }
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
            (
                "body = \"wheel\"",
                "body = \"road\"",
                "25:8: joints[0].body: found \"road\"; allowed: the name of a free rigid body, one with rigid = { \
                 free = {} } (\"cart\", \"wheel\")",
            ),
            (
                "to = \"cart\"",
                "to = \"road\"",
                "26:6: joints[0].to: found \"road\"; allowed: the name of a rigid body (\"cart\", \"wheel\")",
            ),
            (
                "to = \"cart\"",
                "to = \"wheel\"",
                "26:6: joints[0].to: found \"wheel\"; allowed: another body than the one that it holds",
            ),
            (
                "name = \"axle\"",
                "name = \"joint 2\"",
                "28:1: joints[1]: found the name `joint 2`, which another has; allowed: a `name` of its own",
            ),
            (
                "point = [1, 0.5], ",
                "point = [1, 0.5], axis = [0, 0, 1], ",
                "27:36: joints[0].hinge.axis: found [0, 0, 1]; allowed: no axis, as the scene is plane: a hinge \
                 turns about z",
            ),
            (
                "point = [1, 0.5], ",
                "",
                "27:1: joints[0].hinge.point: found nothing, the key is missing; allowed: a list such as [0, \"0.4 \
                 m\", 0], two in the plane",
            ),
            (
                "speed = \"20 rad/s\", ",
                "",
                "27:37: joints[0].hinge.limit: found \"500 N m\"; allowed: a `speed` beside it, which the motor \
                 keeps up with so much at most",
            ),
            (
                "\"500 N m\"",
                "\"-1 N m\"",
                "27:57: joints[0].hinge.limit: found \"-1 N m\", which is -1 kg*m^2/s^2; allowed: an energy or a \
                 moment [J] above 0, like \"10 J\"",
            ),
            (
                "\"500 N m\"",
                "\"500 s\"",
                "27:57: joints[0].hinge.limit: found \"500 s\", a time [s]; allowed: an energy or a moment [J], \
                 like \"10 J\", or as much per metre of depth, a force [N]",
            ),
            (
                "\"20 rad/s\"",
                "\"20 m/s\"",
                "27:37: joints[0].hinge.speed: found \"20 m/s\", a velocity [m/s]; allowed: a rate [1/s], like \"5 \
                 rad/s\"",
            ),
            (
                "\"20 rad/s\"",
                "{ table = [[0, 0], [\"1 s\", \"20 m/s\"]] }",
                "27:64: joints[0].hinge.speed.table[1][1]: found \"20 m/s\", a velocity [m/s]; allowed: a rate [1/s], \
                 like \"5 rad/s\"",
            ),
            (
                "\"20 rad/s\"",
                "[20]",
                "27:37: joints[0].hinge.speed: found [20]; allowed: a rate [1/s], like \"5 rad/s\", a formula, { table = \
                 ... } or { csv = ... }",
            ),
            (
                "\"1 kN\"",
                "{ table = [[\"1 s\", 0], [\"1 s\", \"1 kN\"]] }",
                "30:59: joints[1].slider.force.table[1][0]: found \"1 s\"; allowed: a time after 1 s, that of the row \
                 before",
            ),
            (
                "\"1 kN\"",
                "{ csv = \"force.csv\" }",
                "30:43: joints[1].slider.force.csv: found \"force.csv\"; allowed: a file that can be read; force.csv: No such \
                 file or directory (os error 2); a relative path starts at the scene's folder",
            ),
            (
                "slider = {",
                "weld = {}\nslider = {",
                "28:1: joints[1]: found a joint of several kinds; allowed: one of hinge, slider, planar, ball, weld and \
                 spring",
            ),
            (
                "slider = { axis = [1, 0], force = \"1 kN\" }",
                "",
                "28:1: joints[1]: found a joint of no kind; allowed: one of hinge, slider, planar, ball, weld and \
                 spring",
            ),
            (
                "slider = { axis = [1, 0], force = \"1 kN\" }",
                "planar = {}",
                "30:1: joints[1].planar: found a joint that does nothing; allowed: a `torque`, `speed`, `stiffness` or \
                 `dashpot`: in the plane a body moves so without a joint",
            ),
            (
                "slider = { axis = [1, 0], force = \"1 kN\" }",
                "planar = { normal = [0, 0, 1], torque = 1 }",
                "30:21: joints[1].planar.normal: found [0, 0, 1]; allowed: no normal, as the scene is plane: it moves in \
                 x and y and turns about z",
            ),
            (
                "axis = [1, 0]",
                "axis = [0, 0]",
                "30:19: joints[1].slider.axis: found [0, 0]; allowed: a direction: a vector that is not zero",
            ),
            (
                "slider = {",
                "rail = {",
                "30:1: joints[1].rail: found unknown key `rail`; allowed: name, repeat, body, to, hinge, slider, \
                 planar, ball, weld, spring",
            ),
            (
                ", stiffness = \"1 kN/m\"",
                "",
                "33:1: joints[2].spring: found a spring that does nothing; allowed: a `stiffness`, a `dashpot` or \
                 both",
            ),
            (
                "to = [-1, 1]",
                "to = [0, 1]",
                "33:32: joints[2].spring.to: found [0, 1]; allowed: another place than `from`: a spring acts along \
                 the line between them",
            ),
            (
                "\"1 kN/m\"",
                "\"1 kN\"",
                "33:53: joints[2].spring.stiffness: found \"1 kN\", a force [N]; allowed: a stiffness or an energy \
                 per area [N/m], like \"100 N/m\", or as much per metre of depth, a pressure [Pa]",
            ),
        ],
    );
}

#[test]
fn free_rigid_bodies() {
    check(
        CART,
        &[
            (
                "rigid.free = { mass = \"2000 kg/m\" }",
                "rigid = { free = {}, velocity = [1, 0] }",
                "13:22: bodies[0].rigid.velocity: found `velocity` prescribed to a free body; allowed: the velocity \
                 at the start as the body's own key, beside `rigid`",
            ),
            (
                "mass = \"2000 kg/m\"",
                "mass = 0",
                "13:23: bodies[0].rigid.free.mass: found 0; allowed: a mass [kg] above 0, like \"3 kg\"",
            ),
            (
                "mass = \"2000 kg/m\"",
                "mass = \"2 m\"",
                "13:23: bodies[0].rigid.free.mass: found \"2 m\", a length [m]; allowed: a mass [kg], like \"3 \
                 kg\", or as much per metre of depth, a quantity in kg/m",
            ),
            (
                "inertia = \"20 kg*m^2\"",
                "inertia = [1, 2, 3]",
                "18:43: bodies[1].rigid.free.inertia: found [1, 2, 3]; allowed: one number, as the scene is plane",
            ),
            (
                "inertia = \"20 kg*m^2\"",
                "inertia = -1",
                "18:43: bodies[1].rigid.free.inertia: found -1; allowed: a quantity in kg*m^2 above 0, like \"1 \
                 kg*m^2\"",
            ),
            (
                "mass = \"2000 kg/m\"",
                "weight = 2",
                "13:16: bodies[0].rigid.free.weight: found unknown key `weight`; allowed: mass, inertia",
            ),
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
    let mirrored = CART.replacen(
        "cell = 0.1",
        "cell = 0.1\ndomain = { min = [-9, -1], max = [9, 1.5], y_max = \"symmetry\" }",
        1,
    );
    // Its slider holds it on the mirror; one that leads off it does not.
    let along = scene::parse("a.toml", &mirrored, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    assert_eq!(checks::problems(&along), Ok(()));
    for (from, to, found) in [
        (
            "point = [1, 0.5]",
            "point = [1, 500]",
            ("joints[0].hinge.point", "a point 499 m away from a body that it holds"),
        ),
        (
            "body = \"wheel\"\nto = \"cart\"\nhinge = { point = [1, 0.5], speed = \"20 rad/s\", limit = \"500 N m\" }",
            "body = \"wheel\"\nto = \"far\"\nweld = {}\n[[bodies]]\nname = \"far\"\nmaterial = \"steel\"\nrigid.free = {}\n\
             shape.ball = { center = [900, 0], radius = 0.5 }",
            ("joints[0].to", "a body 898 m away from the other one"),
        ),
        (
            "shape.box = { min = [0, 1], max = [2, 1.5] }",
            "shape.half_space = { point = [0, 0], normal = [0, -1] }",
            ("bodies[0].rigid.free", "`cart`, which has no finite mass or inertia"),
        ),
        (
            CART,
            &mirrored.replace("axis = [1, 0]", "axis = [1, 1]"),
            ("bodies[0].rigid.free", "`cart`, through which a symmetry face of the domain goes"),
        ),
    ] {
        let (key, what) = problem(from, to);
        assert_eq!((key.as_str(), what.as_str()), found);
    }
}
