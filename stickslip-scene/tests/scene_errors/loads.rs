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
                "velocity = [\"1 Hz * x0\", 0]",
                "22:21: supports[0].velocity[0]: found unknown name `x0`; allowed: a parameter (there are none), pi or inf; \
                 one that varies from place to place is written as a displacement: \"0.1 Hz * t * x0\"",
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
                "26:1: loads[0].pressure: found `pressure` beside another; allowed: one of force, traction, pressure, \
                 acceleration and temperature",
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
fn gravity_over_time() {
    let text = |gravity: &str| format!("gravity = {gravity}\n{LOADED}");
    let gravity = r#"[0, { table = [["0 s", 0], ["1 s", "-10 m/s^2"]] }]"#;
    let scene = scene::parse("a.toml", &text(gravity), &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    assert_eq!((scene.gravity.at(0.5), scene.gravity.constant()), ([0.0, -5.0, 0.0], None));
    check(
        &text("[0, \"-9.81 m/s^2 * min(t / 10 ms, 1)\"]"),
        &[
            (
                "-9.81 m/s^2 *",
                "-9.81 m/s *",
                "1:15: gravity[1]: found \"-9.81 m/s * min(t / 10 ms, 1)\", a velocity [m/s]; allowed: an acceleration \
                 [m/s^2], like \"9.81 m/s^2\"",
            ),
            (
                "t / 10 ms",
                "y / 10 m",
                "1:34: gravity[1]: found unknown name `y`; allowed: a parameter (there are none), pi or inf",
            ),
            (
                "\"-9.81 m/s^2 * min(t / 10 ms, 1)\"",
                "{ table = [[1, 0], [0, 1]] }",
                "1:35: gravity[1].table[1][0]: found 0; allowed: a time after 1 s, that of the row before",
            ),
        ],
    );
}

const SPRING: &str = r#"[[springs]]
from = { body = "block", on = "y_min" }
to = { body = "floor2", on = "y_max" }
stiffness = "1 kN/m"
"#;

#[test]
fn springs() {
    let plate = "[[bodies]]\nname = \"floor2\"\nmaterial = \"rubber\"\nrigid = {}\n\
                 shape.box = { min = [0, -2], max = [1, -1] }\n";
    let text = format!("{}{plate}{SPRING}", LOADED.replace("[0, 0], normal", "[0, -3], normal"));
    let scene = scene::parse("a.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    assert_eq!(checks::problems(&scene), Ok(()));
    assert_eq!(scene.joint_names().collect::<Vec<_>>(), ["spring 1"]);
    check(
        &text,
        &[
            (
                "from = { body = \"block\"",
                "from = { body = \"blok\"",
                "33:17: springs[0].from.body: found \"blok\"; allowed: the name of a body (\"block\", \"floor\", \
                 \"floor2\"); did you mean `block`?",
            ),
            (
                "stiffness = \"1 kN/m\"",
                "",
                "32:1: springs[0]: found a spring that does nothing; allowed: a `stiffness`, a `dashpot` or both",
            ),
            (
                "stiffness = \"1 kN/m\"",
                "dashpot = 0",
                "35:11: springs[0].dashpot: found 0; allowed: a force per velocity [N*s/m] above 0, like \"10 N*s/m\"",
            ),
            (
                "on = \"y_min\" }",
                "on = \"z_min\" }",
                "33:31: springs[0].from.on: found \"z_min\"; allowed: another face, as the scene is plane",
            ),
            (
                "stiffness = \"1 kN/m\"",
                "stiffness = 1\n[[springs]]\nname = \"spring 1\"\nfrom = { body = \"block\" }\nto = { body = \"floor2\" }\n\
                 stiffness = 1",
                "37:8: springs[1].name: found \"spring 1\"; allowed: a name that no other in the list has",
            ),
        ],
    );
    assert_eq!(
        problem(&text.replace("on = \"y_min\" }", "within.ball = { center = [9, 9], radius = 1 } }")),
        "springs[0].from.within: no part of body `block`; a part that the body has"
    );
    assert_eq!(
        problem(&text.replace("from = { body = \"block\"", "from = { body = \"floor2\"")),
        "springs[0]: a spring between `floor2` and `floor2`; one between bodies of which one can move: not both are as \
         prescribed"
    );
    assert!(
        problem(&text.replace(
            "to = { body = \"floor2\", on = \"y_max\" }",
            "to = { body = \"block\", on = \"y_min\" }"
        ))
        .contains("another place: a spring acts along the line between the centres")
    );
}

/// What is wrong with a scene once it is read.
fn problem(text: &str) -> String {
    let scene = scene::parse("a.toml", text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    let problem = checks::problems(&scene).expect_err("a problem");
    format!("{}: {}; {}", problem.key, problem.found, problem.allowed)
}

#[test]
fn temperatures() {
    let force =
        "on = \"y_max\"\nforce = [{ table = [[\"0 s\", 0], [\"1 ms\", \"3 kN\"]] }, \"1 N/m * x / 1 m\"]";
    let text = LOADED.replace(force, "temperature = \"20 * t / 1 s\"");
    let expands = text.replace("density = 1000", "density = 1000\nthermal_expansion = 1e-5");
    let scene = scene::parse("a.toml", &expands, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    assert_eq!(checks::problems(&scene), Ok(()));
    check(
        &expands,
        &[
            (
                "temperature = \"20",
                "on = \"x_max\"\ntemperature = \"20",
                "26:6: loads[0].on: found \"x_max\"; allowed: \"volume\": a surface has no mass",
            ),
            (
                "thermal_expansion = 1e-5",
                "thermal_expansion = 12",
                "8:21: materials.rubber.thermal_expansion: found 12; allowed: a number per kelvin, of magnitude below 0.01, \
                 like 1.2e-5",
            ),
            (
                "\"20 * t / 1 s\"",
                "\"20 Pa\"",
                "26:15: loads[0].temperature: found \"20 Pa\", a pressure [Pa]; allowed: a number without unit, like 0.5",
            ),
        ],
    );
    assert_eq!(
        problem(&text),
        "loads[0].temperature: a temperature of `block`, whose material does not expand by it; a body with a \
         `thermal_expansion`: that of materials.rubber is 0"
    );
    assert_eq!(
        problem(&format!("{expands}[[loads]]\nbody = \"block\"\ntemperature = 5\n")),
        "loads[1].temperature: a second temperature of `block`; one for each body; its formula may tell places apart, by \
         if(x0 < 1, 20, 50)"
    );
}

#[test]
fn initial_stresses() {
    let shape = "shape.box = { min = [0, 0], max = [1, 1] }";
    let with = |stress: &str| LOADED.replacen(shape, &format!("{shape}\n{stress}"), 1);
    let text = with("stress = { yy = \"-20 kN/m^3 * (1 m - y)\" }");
    let scene = scene::parse("a.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    assert_eq!(checks::problems(&scene), Ok(()));
    check(
        &text,
        &[
            (
                "kN/m^3",
                "kN/m^2",
                "13:17: bodies[0].stress.yy: found \"-20 kN/m^2 * (1 m - y)\", a stiffness or an energy per area [N/m]; \
                 allowed: a pressure [Pa], like \"6 MPa\"",
            ),
            (
                "(1 m - y)",
                "(1 m - t * 1 m/s)",
                "13:38: bodies[0].stress.yy: found `t`, the time; allowed: a formula without time: only prescribed motion, \
                 gravity, loads and references vary in time",
            ),
        ],
    );
    assert_eq!(
        problem(&with("stress = { xz = 1 }")),
        "bodies[0].stress: [0.0, 0.0, 0.0, 0.0, 0.0, 1.0] Pa (xx, yy, zz, xy, yz, xz) at [0.025, 0.025, 0.0] m in \
         `block`; none out of the plane of the scene; in plane strain along z, zz, alone"
    );
    assert!(problem(&with("stress.yy = \"1 Pa * 1 m / (y - y)\"")).contains("stresses that are numbers"));
    let flows = with("stress.xy = \"1 MPa\"").replace(
        "neo_hookean = { young_modulus = \"1 MPa\"",
        "von_mises = { yield_stress = 1000, young_modulus = \"1 MPa\"",
    );
    assert!(problem(&flows).ends_with("a stress under which the material neither flows nor breaks"));
    let water = with("stress.xy = 1")
        .replace("young_modulus = \"1 MPa\", poisson_ratio = 0.3", "bulk_modulus = 1e6, shear_modulus = 0");
    assert!(problem(&water).contains("a fluid bears none along its planes"));
    let rigid = LOADED.replace("rigid = {}", "rigid = {}\nstress.xx = 1");
    assert_eq!(problem(&rigid), "bodies[1].stress: a stress of the rigid body `floor`; a body that deforms");
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

/// The force at 1 ms by a file of these lines, 3 kN in all of them, or what is wrong with it.
fn force_of(csv: &str, keys: &str) -> Result<f64, String> {
    let table = format!("{{ csv = \"push.csv\" {keys} }}");
    let text = LOADED.replace(r#"{ table = [["0 s", 0], ["1 ms", "3 kN"]] }"#, &table);
    let files = std::collections::BTreeMap::from([("push.csv".into(), csv.as_bytes().to_vec())]);
    let loaded = scene::parse_beside("a.toml", &text, &[], &files).map_err(|error| error.to_string())?;
    let scene::Action::Force([x, ..]) = &loaded.scene.loads[1].action else { panic!("a force") };
    Ok(x.at(1e-3))
}

#[test]
fn a_table_has_the_units_of_its_head() {
    for csv in [
        "time [ms], force [kN]\n0, 0\n1, 3\n",
        "t (us),F (N)\n0,0\n1000,3000\n",
        "t / ms,F / kN\n0,0\n1,3\n",
        "t_s, force_N\n0, 0\n1e-3, 3000\n",
        // Of a plane scene per metre of depth, too; and what some programs end lines with.
        "time [ms], line load [kN/m],\n0, 0,\n1, 3,\n",
    ] {
        assert_eq!(force_of(csv, "").map(|force| (force / 3000.0 * 1e9).round()), Ok(1e9), "{csv}");
    }
    for (csv, found) in [
        (
            "time [ms], force [MPa]\n0, 0\n",
            "in row 1 of push.csv: `force [MPa]`; allowed: the unit of a force [N] in",
        ),
        (
            "time [fortnights], force\n0, 0\n",
            "in row 1 of push.csv: `time [fortnights]`; allowed: the unit of a time",
        ),
        (
            "time_ms, force\n0, 0\n",
            "in row 1 of push.csv: `time_ms`; allowed: units in brackets, `time [ms]`",
        ),
        (
            "time, force kN\n0, 0\n",
            "in row 1 of push.csv: `force kN`; allowed: units in brackets, `force [kN]`",
        ),
    ] {
        let error = force_of(csv, "").expect_err(csv);
        assert!(error.contains(found), "{error}");
    }
}

#[test]
fn a_table_of_more_columns_says_which_are_meant() {
    let csv = "t [ms], p, F [kN]\n0, 7, 0\n1, 7, 3\n";
    for columns in ["[1, 3]", "[\"t\", \"f\"]", "[\"t [ms]\", 3]"] {
        assert_eq!(force_of(csv, &format!(", columns = {columns}")), Ok(3000.0), "{columns}");
    }
    for (csv, keys, found) in [
        (
            "0,1,5\n1,2,5\n",
            "",
            "in row 1 of push.csv: 3 columns, `0, 1, 5`; allowed: two, a time and a value",
        ),
        ("0,1\n1,2,5\n", "", "in row 2 of push.csv: 3 columns, `1, 2, 5`; allowed: two, a time and a value"),
        (
            "t,F\n0,1\n",
            ", columns = [\"t\", \"G\"]",
            "no column `G`; allowed: one of those that it names: t, F",
        ),
        ("t,F\n0,1\n", ", columns = [1, 0]", "the column 0; allowed: the columns of the time and the value"),
    ] {
        let error = force_of(csv, keys).expect_err(csv);
        assert!(error.contains(found), "{error}");
    }
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
    fn memory(&self, _: &scene::Scene, _: &[checks::BodySize]) -> f64 {
        0.0
    }
    fn copy(&self, _: &scene::Scene, _: &[checks::BodySize]) -> f64 {
        0.0
    }
}
