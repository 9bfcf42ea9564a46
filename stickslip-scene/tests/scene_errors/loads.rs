//! Supports and loads.

use crate::{MINIMAL, check};
use stickslip_scene::{check as checks, scene};

const LOADED: &str = r#"[space]
dimension = "plane-strain"
cell = 0.1
[time]
end = 1
[materials.rubber]
density = 1000
neo_hookean = { young_modulus = "1 MPa", poisson_ratio = 0.3 }
[[bodies]]
name = "block"
material = "rubber"
shape.box = { min = [0, 0], max = [1, 1] }
[[bodies]]
name = "floor"
material = "rubber"
shape.half_space = { point = [0, 0], normal = [0, 1] }
rigid = {}
[[supports]]
name = "clamp"
body = "block"
on = "x_min"
displacement = [0, "free"]
[[loads]]
body = "block"
on = "y_max"
force = [{ table = [["0 s", 0], ["1 ms", "3 kN"]] }, "1 N/m * x / 1 m"]
"#;

#[test]
fn supports_and_loads() {
    scene::parse("a.toml", LOADED, &[]).unwrap_or_else(|error| panic!("{error}"));
    assert!(!MINIMAL.contains("loads"));
    check(
        LOADED,
        &[
            (
                "body = \"block\"\non = \"x_min\"",
                "body = \"floor\"",
                "20:8: supports[0].body: found \"floor\"; allowed: the name of a body that deforms (\"block\")",
            ),
            (
                "on = \"x_min\"",
                "on = \"left\"",
                "21:6: supports[0].on: found \"left\"; allowed: \"surface\", \"x_min\", \"x_max\", \"y_min\", \"y_max\", \"z_min\", \
                 \"z_max\" or \"volume\"",
            ),
            (
                "on = \"x_min\"",
                "on = \"z_min\"",
                "21:6: supports[0].on: found \"z_min\"; allowed: another face, as the scene is plane",
            ),
            (
                "displacement = [0, \"free\"]",
                "displacement = [\"free\", \"free\"]",
                "22:16: supports[0].displacement: found [\"free\", \"free\"]; allowed: a number along one axis at least: a \
                 part that is free needs no support",
            ),
            (
                "displacement = [0, \"free\"]",
                "displacement = [0, 0, 0]",
                "22:16: supports[0].displacement: found [0, 0, 0]; allowed: 2 numbers, as the scene is plane: [x, y]",
            ),
            (
                "displacement = [0, \"free\"]",
                "displacement = [0, 0]\nvelocity = [0, 0]",
                "23:1: supports[0].velocity: found `velocity` beside `displacement`; allowed: one of the two",
            ),
            (
                "displacement = [0, \"free\"]",
                "stiffness = \"-1 N/m\"",
                "22:13: supports[0].stiffness: found \"-1 N/m\"; allowed: a stiffness or an energy per area [N/m] above 0, \
                 like \"100 N/m\"",
            ),
            (
                "name = \"clamp\"",
                "name = \"load 1\"",
                "23:1: loads[0]: found the name `load 1`, which another has; allowed: a `name` of its own",
            ),
            (
                "force = [{ table",
                "pressure = 1\nforce = [{ table",
                "26:1: loads[0].pressure: found `pressure` beside another; allowed: one of force, traction, pressure and \
                 acceleration",
            ),
            (
                "[\"1 ms\", \"3 kN\"]",
                "[\"0 ms\", \"3 kN\"]",
                "26:34: loads[0].force[0].table[1][0]: found \"0 ms\"; allowed: a time after 0 s, that of the row before",
            ),
            (
                "\"3 kN\"",
                "\"3 kPa\"",
                "26:42: loads[0].force[0].table[1][1]: found \"3 kPa\", a pressure [Pa]; allowed: a force [N], like \"10 \
                 N\", or as much per metre of depth, a stiffness or an energy per area [N/m]",
            ),
            (
                "[[\"0 s\", 0], [\"1 ms\", \"3 kN\"]]",
                "[]",
                "26:20: loads[0].force[0].table: found []; allowed: a list of rows, each a time and a value: \
                 [[\"0 s\", 0], [\"1 ms\", 5]]",
            ),
            (
                "on = \"y_max\"\nforce = [{ table = [[\"0 s\", 0], [\"1 ms\", \"3 kN\"]] }, \"1 N/m * x / 1 m\"]",
                "on = \"volume\"\npressure = 5",
                "25:6: loads[0].on: found \"volume\"; allowed: a surface: a volume has no area",
            ),
        ],
    );
}

#[test]
fn a_table_from_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let load = |csv: &str| {
        std::fs::write(folder.path().join("push.csv"), csv).expect("written");
        let text = LOADED.replace(r#"{ table = [["0 s", 0], ["1 ms", "3 kN"]] }"#, r#"{ csv = "push.csv" }"#);
        std::fs::write(folder.path().join("a.toml"), text).expect("written");
        scene::load(&folder.path().join("a.toml"), &[])
    };
    let scene = load("time, force\n0, 0\n1e-3, 3000\n").unwrap_or_else(|error| panic!("{error}")).scene;
    let scene::Action::Force([x, ..]) = &scene.loads[1].action else { panic!("{:?}", scene.loads) };
    assert_eq!([-1.0, 0.5e-3, 2.0].map(|time| x.at(time)), [0.0, 1500.0, 3000.0]);
    for (csv, found) in [
        (
            "0, 0\n1, nan\n",
            "in row 2 of push.csv: `1, nan`; allowed: a time and a value, numbers in SI units with a comma",
        ),
        ("0, 0\n0, 1\n", "in row 2 of push.csv: the time 0 s; allowed: a time after that of the row before"),
        (
            "0 s, 1\n",
            "in row 1 of push.csv: `0 s, 1`; allowed: a time and a value, numbers in SI units with a comma",
        ),
        ("time, force\n", "found \"push.csv\"; allowed: a file with at least one row of a time and a value"),
    ] {
        let error = load(csv).expect_err(found).to_string();
        assert!(error.contains(found), "{error}");
    }
    std::fs::remove_file(folder.path().join("push.csv")).expect("removed");
    std::fs::create_dir(folder.path().join("push.csv")).expect("made");
    let error = scene::load(&folder.path().join("a.toml"), &[]).expect_err("a folder").to_string();
    assert!(error.contains("allowed: a file that can be read"), "{error}");
}

#[test]
fn a_load_on_nothing() {
    let text = LOADED.replace("on = \"x_min\"", "within.ball = { center = [5, 5], radius = 1 }");
    let scene = scene::parse("a.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    let problem = checks::problems(&scene).expect_err("nothing is there");
    assert_eq!(
        (problem.key.as_str(), problem.found.as_str()),
        ("supports[0].within", "no part of body `block`")
    );
}

#[test]
fn a_support_that_jumps_is_told() {
    let warnings = |displacement: &str| {
        let text = LOADED.replace("[0, \"free\"]", displacement);
        let scene = scene::parse("a.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
        let report = checks::report(&scene, &NoMemory).unwrap_or_else(|problem| panic!("{problem:?}"));
        report
            .warnings
            .iter()
            .filter(|warning| warning.key == "supports")
            .map(ToString::to_string)
            .collect::<Vec<_>>()
    };
    assert_eq!(warnings("[\"1 cm * min(t / 1 ms, 1)\", \"free\"]"), Vec::<String>::new());
    let told = warnings("[\"3 cm + 1 cm * y0 / 1 m\", \"free\"]");
    assert!(
        told.len() == 1 && told[0].contains("`clamp` begins 0.03975 m away from its part of `block`"),
        "{told:?}"
    );
}

/// An engine that takes no memory.
struct NoMemory;

impl checks::Footprint for NoMemory {
    fn particles_around(&self, _: &scene::Scene, _: usize, _: &[stickslip_scene::geometry::Bounds]) -> usize {
        0
    }
    fn memory(&self, _: &scene::Scene, _: &[usize]) -> f64 {
        0.0
    }
    fn copy(&self, _: &scene::Scene, _: &[usize]) -> f64 {
        0.0
    }
}
