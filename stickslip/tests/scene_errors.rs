//! Every mistake in a scene file is shown with its place, its key, what was found, what is allowed and what to try.
//!
//! Each case is a right scene with one edit, and the whole message that it must give.

use miette::Diagnostic;
use stickslip::scene::{self, Problem, SceneError};

const MINIMAL: &str = include_str!("scenes/minimal.toml");
const ROLLING: &str = include_str!("scenes/rolling.toml");
const WEDGE: &str = include_str!("scenes/wedge.toml");

fn message(text: &str) -> String {
    message_with(text, &[])
}

fn message_with(text: &str, overrides: &[(&str, &str)]) -> String {
    let overrides: Vec<_> =
        overrides.iter().map(|(name, value)| (name.to_string(), value.to_string())).collect();
    match scene::parse("a.toml", text, &overrides) {
        Ok(loaded) => panic!("no error in {:#?}", loaded.scene),
        Err(error) => error.to_string(),
    }
}

/// The scene with `from` replaced by `to`, once.
fn edited(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from} is not in the scene");
    text.replacen(from, to, 1)
}

fn check(text: &str, cases: &[(&str, &str, &str)]) {
    let wrong: Vec<String> = cases
        .iter()
        .filter_map(|(from, to, expected)| {
            let found = message(&edited(text, from, to));
            let expected = format!("a.toml:{expected}");
            (found != expected).then(|| format!("`{from}` -> `{to}`\n  gives {found}\n  not   {expected}\n"))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_examples_are_right() {
    for text in [MINIMAL, ROLLING, WEDGE] {
        scene::parse("a.toml", text, &[]).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn keys() {
    let space = "dimension, cell, particles_per_side, basis, precision, domain";
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
                "1:1: time: found nothing, the key is missing; allowed: a table with the keys end, courant, max_step, stress_update, pic_share",
            ),
            (
                "[time]",
                "[[time]]",
                "5:1: time: found a list of 1; allowed: a table with the keys end, courant, max_step, stress_update, pic_share",
            ),
            (
                "[[bodies]]",
                "[bodies]",
                "12:2: bodies: found a table; allowed: a list [...] of a table with the keys name, material, shape, particles, velocity, spin, rigid; tables in a list have two brackets: [[bodies]]",
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
                "15:7: bodies[0].shape.bal: found unknown shape `bal`; allowed: ball, box, cylinder, half_space, polygon, union, intersection, difference, rotated; did you mean `ball`?",
            ),
            (
                "shape.ball =",
                "shape.box = {}\nshape.ball =",
                "16:7: bodies[0].shape.ball: found a second shape, `ball`; allowed: one shape; union = [...] joins shapes",
            ),
        ],
    );
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
                "\"2d\"",
                "2:13: space.dimension: found \"2d\"; allowed: \"plane-strain\", \"plane-stress\" or \"3d\"",
            ),
            (
                "\"3d\"",
                "\"plane_strain\"",
                "2:13: space.dimension: found \"plane_strain\"; allowed: \"plane-strain\", \"plane-stress\" or \"3d\"; did you mean `plane-strain`?",
            ),
            (
                "\"1 s\"",
                "\"1 s + 1 m\"",
                "6:8: time.end: found a time [s] with a length [m]; allowed: terms of the same dimension",
            ),
            (
                "\"1 s\"",
                "\"2 * t\"",
                "6:12: time.end: found `t`, the time; allowed: a formula without time: only prescribed motion and references vary in time",
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
fn values_out_of_range() {
    check(
        MINIMAL,
        &[
            (
                "\"0.1 m\"",
                "\"-0.1 m\"",
                "3:8: space.cell: found \"-0.1 m\"; allowed: a length [m] above 0, like \"0.4 m\"",
            ),
            ("\"0.1 m\"", "0", "3:8: space.cell: found 0; allowed: a length [m] above 0, like \"0.4 m\""),
            (
                "\"0.4 m\"",
                "\"1 m - 2 m\"",
                "15:45: bodies[0].shape.ball.radius: found \"1 m - 2 m\", which is -1 m; allowed: a length [m] above 0, like \"0.4 m\"",
            ),
            (
                "\"1 s\"",
                "1\ncourant = 1.5",
                "7:11: time.courant: found 1.5; allowed: a number above 0 and up to 1",
            ),
            (
                "\"1 s\"",
                "1\npic_share = -0.1",
                "7:13: time.pic_share: found -0.1; allowed: a number from 0 to 1",
            ),
            (
                "\"1 s\"",
                "1\nmax_step = 0",
                "7:12: time.max_step: found 0; allowed: a time [s] above 0, like \"2.5 ms\"",
            ),
            (
                "[time]",
                "particles_per_side = 9\n[time]",
                "5:22: space.particles_per_side: found 9; allowed: a whole number from 1 to 8",
            ),
            (
                "[time]",
                "particles_per_side = 1.5\n[time]",
                "5:22: space.particles_per_side: found 1.5; allowed: a whole number from 1 to 8",
            ),
            (
                "[time]",
                "domain = { min = [0, 0, 0], max = [1, 0, 1] }\n[time]",
                "5:39: space.domain.max[1]: found 0; allowed: more than 0 m, the y of min",
            ),
            (
                "\"1000 kg/m^3\"",
                "-1",
                "9:11: materials.rubber.density: found -1; allowed: a density [kg/m^3] above 0, like \"1000 kg/m^3\"",
            ),
            (
                "\"3 MPa\"",
                "\"-3 MPa\"",
                "10:57: materials.rubber.neo_hookean.shear_modulus: found \"-3 MPa\" (-3000000 Pa); allowed: a positive number",
            ),
            (
                ", shear_modulus = \"3 MPa\"",
                "",
                "10:1: materials.rubber.neo_hookean: found bulk_modulus; allowed: two of bulk_modulus, shear_modulus, young_modulus, poisson_ratio, p_wave_modulus (not E with M)",
            ),
            (
                "material = \"rubber\"",
                "material = \"ruber\"",
                "14:12: bodies[0].material: found \"ruber\"; allowed: the name of a material (\"rubber\"); did you mean `rubber`?",
            ),
            (
                "neo_hookean = ",
                "neohookean = ",
                "10:1: materials.rubber.neohookean: found unknown key `neohookean`; allowed: density, neo_hookean, hypoelastic; did you mean `neo_hookean`?",
            ),
            (
                "neo_hookean = ",
                "#",
                "8:12: materials.rubber: found no law; allowed: a law (neo_hookean, hypoelastic), like neo_hookean = { bulk_modulus = \"6 MPa\", shear_modulus = \"3 MPa\" }",
            ),
            (
                "shear_modulus",
                "sheer_modulus",
                "10:41: materials.rubber.neo_hookean.sheer_modulus: found unknown key `sheer_modulus`; allowed: bulk_modulus, shear_modulus, young_modulus, poisson_ratio, p_wave_modulus; did you mean `shear_modulus`?",
            ),
        ],
    );
    let none = MINIMAL.split("[[bodies]]").next().unwrap();
    assert_eq!(
        message(&format!("bodies = []\n{none}")),
        "a.toml:1:10: bodies: found no body; allowed: at least one [[bodies]]"
    );
}

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

#[test]
fn parameters() {
    check(
        ROLLING,
        &[
            (
                "\"radius / cells_per_radius\"",
                "\"raduis / 8\"",
                "12:9: parameters.cell: found unknown name `raduis`; allowed: a parameter (cells_per_radius, contact, cell, radius, angle), pi or inf; did you mean `radius`?",
            ),
            (
                "radius = \"1.6 m\"",
                "radius = \"8 * cell\"",
                "12:8: parameters.cell: found the circle cell -> radius -> cell; allowed: parameters that do not need each other in a circle",
            ),
            (
                "angle = \"pi / 4\"",
                "angle = true",
                "14:9: parameters.angle: found `true`; allowed: a number, or a formula or a word in quotes",
            ),
            (
                "angle = \"pi / 4\"",
                "t = 1",
                "14:1: parameters.t: found the name `t`, which formulas use already; allowed: another name",
            ),
            (
                "angle = \"pi / 4\"",
                "my-angle = 1",
                "14:1: parameters.my-angle: found the name `my-angle`; allowed: letters, digits and _, not beginning with a digit",
            ),
            (
                "radius = \"1.6 m\"",
                "radius = \"1.6 s\"",
                "44:32: bodies[0].shape.ball.center[2]: found \"radius\", a time [s]; allowed: a length [m], like \"0.4 m\"",
            ),
        ],
    );
    let circle = message(&edited(ROLLING, "cell = \"radius / cells_per_radius\"", "cell = \"cell\""));
    assert!(circle.contains("parameters.cell: found the circle cell -> cell;"), "{circle}");
}

#[test]
fn overrides() {
    let parameters = "(cells_per_radius, contact, cell, radius, angle)";
    for (name, value, expected) in [
        ("cels_per_radius", "4", format!("--set cels_per_radius:1:1: found no parameter `cels_per_radius`; allowed: a parameter of the scene {parameters}; did you mean `cells_per_radius`?")),
        ("colour", "4", format!("--set colour:1:1: found no parameter `colour`; allowed: a parameter of the scene {parameters}; other keys are set by their path with dots: time.end=\"1 s\"")),
        ("radius", "2 kgg", "--set radius:1:10: parameters.radius: found `kgg` after a number; allowed: a unit such as m, mm, kg, ms, MPa, deg; did you mean `kg`?".to_string()),
        ("time.end", "-1 s", "--set time.end:1:10: time.end: found \"-1 s\"; allowed: a time [s] above 0, like \"2.5 ms\"".to_string()),
        ("time.ende", "1 s", "--set time.ende:1:1: time.ende: found unknown key `ende`; allowed: end, courant, max_step, stress_update, pic_share; did you mean `end`?".to_string()),
        ("bodies[7].name", "x", "--set bodies[7].name:1:1: bodies: found number 7 of a list of 2; allowed: a number in the list, from 0".to_string()),
        ("title.x", "x", "--set title.x:1:1: title: found `.x` in \"Sphere rolling down an inclined plane ({contact})\"; allowed: a name in a table".to_string()),
    ] {
        assert_eq!(message_with(ROLLING, &[(name, value)]), expected);
    }
}

#[test]
fn problems_found_later_are_shown_at_their_key() {
    let loaded = scene::parse("a.toml", ROLLING, &[]).unwrap();
    for (key, place) in [
        ("bodies[1].shape.box.max", "51:42"),
        ("bodies[0].shape.ball.radius", "44:52"),
        ("bodies[0].shape", "44:1"),
        ("bodies[1]", "48:1"),
        ("bodies[1].nothing.of.the.kind", "48:1"),
        ("time.unknown", "26:2"),
        ("", "1:1"),
    ] {
        let problem = Problem {
            key: key.to_string(),
            found: "this".into(),
            allowed: "that".into(),
            help: Some("so".into()),
        };
        let error = loaded.source.locate(problem).to_string();
        let key = if key.is_empty() { String::new() } else { format!("{key}: ") };
        assert_eq!(error, format!("a.toml:{place}: {key}found this; allowed: that; so"));
    }
}

#[test]
fn the_source_is_shown() {
    let error = scene::parse("a.toml", &edited(MINIMAL, "0.1 m", "0.1 s"), &[]).unwrap_err();
    let mut shown = String::new();
    let handler = miette::GraphicalReportHandler::new_themed(miette::GraphicalTheme::unicode_nocolor());
    handler.render_report(&mut shown, &error).unwrap();
    assert!(shown.contains("[a.toml:3:8]") && shown.contains("cell = \"0.1 s\""), "{shown}");
    let SceneError::Mistake(mistake) = &error else { panic!("{error}") };
    assert_eq!((mistake.line, mistake.column, mistake.problem.key.as_str()), (3, 8, "space.cell"));
}

#[test]
fn missing_files_suggest_their_neighbours() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scenes");
    let error = scene::load(&std::path::Path::new(folder).join("minimul.toml"), &[]).unwrap_err();
    assert!(error.to_string().contains("minimul.toml"), "{error}");
    assert_eq!(error.help().unwrap().to_string(), "did you mean `minimal.toml`?");
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(400))]

    /// Whatever is damaged in a file, the answer is a scene or a mistake in a place of that file.
    #[test]
    fn damaged_files_are_read_or_refused(
        (text, from, length) in (proptest::sample::select(vec![MINIMAL, ROLLING, WEDGE]), 0..2000_usize, 0..12_usize),
        instead in "[\"\\[\\]{}=.,#\n a-z0-9\u{b5}-]{0,6}",
    ) {
        let from = from % text.len();
        let to = (from + length).min(text.len());
        let damaged = format!("{}{instead}{}", &text[..from], &text[to..]);
        if let Err(SceneError::Mistake(mistake)) = scene::parse("a.toml", &damaged, &[]) {
            proptest::prop_assert!(mistake.line <= damaged.lines().count() + 1, "{}", mistake);
            proptest::prop_assert!(!mistake.problem.found.is_empty() && !mistake.problem.allowed.is_empty());
        }
    }
}

#[test]
fn a_camera_behind_a_polariscope() {
    let plane = MINIMAL
        .replace("\"3d\"", "\"plane-strain\"")
        .replace("[0, 0, 0]", "[0, 0]")
        .replace("shape.ball", "\nshape.ball");
    let scene = format!(
        "{plane}\n[outputs.fringes]\ninterval = \"1 ms\"\nexposure = \"0.5 ms\"\nstress_optic_coefficient = \"4e-12 m^2/N\"\nthickness = \"6 mm\"\n"
    );
    scene::parse("a.toml", &scene, &[]).unwrap_or_else(|error| panic!("{error}"));
    let space = scene.replace("\"plane-strain\"", "\"3d\"").replace("[0, 0]", "[0, 0, 0]");
    check(
        &scene,
        &[
            (
                "interval = \"1 ms\"",
                "interval = 0",
                "19:12: outputs.fringes.interval: found 0; allowed: a time [s] above 0, like \"2.5 ms\"",
            ),
            (
                "interval = \"1 ms\"",
                "",
                "18:10: outputs.fringes.interval: found nothing, the key is missing; allowed: a time [s], like \"2.5 ms\"",
            ),
            (
                "exposure = \"0.5 ms\"",
                "exposure = \"2 ms\"",
                "20:12: outputs.fringes.exposure: found \"2 ms\"; allowed: at most the interval, 0.001 s",
            ),
            (
                "exposure = \"0.5 ms\"",
                "exposure = \"-1 ms\"",
                "20:12: outputs.fringes.exposure: found \"-1 ms\"; allowed: a time [s] of 0 or more, like \"2.5 ms\"",
            ),
            (
                "thickness = \"6 mm\"",
                "samples = 0.5\nthickness = 1",
                "22:11: outputs.fringes.samples: found 0.5; allowed: a whole number from 1 to 64",
            ),
            (
                "thickness = \"6 mm\"",
                "",
                "21:28: outputs.fringes.stress_optic_coefficient: found \"4e-12 m^2/N\"; allowed: in a plane scene together with a thickness",
            ),
            (
                "thickness = \"6 mm\"",
                "stress_parameter = \"1 MPa\"",
                "22:20: outputs.fringes.stress_parameter: found \"1 MPa\"; allowed: either stress_optic_coefficient or stress_parameter",
            ),
            (
                "stress_optic_coefficient = \"4e-12 m^2/N\"",
                "stress_parameter = \"1 MPa\"",
                "22:13: outputs.fringes.thickness: found \"6 mm\"; allowed: no thickness beside stress_parameter, which holds for the stress itself",
            ),
            (
                "stress_optic_coefficient = \"4e-12 m^2/N\"",
                "",
                "19:12: outputs.fringes.interval: found \"1 ms\"; allowed: fringes with stress_optic_coefficient and thickness, or with stress_parameter, such as \"20 MPa\"",
            ),
            (
                "4e-12 m^2/N",
                "4 MPa",
                "21:28: outputs.fringes.stress_optic_coefficient: found \"4 MPa\", a pressure [Pa]; allowed: a compliance [1/Pa], like \"4e-12 m^2/N\"",
            ),
            (
                "thickness",
                "wavelength = \"1 um\"\nthickness",
                "22:14: outputs.fringes.wavelength: found \"1 um\"; allowed: a visible wavelength, \"380 nm\" to \"780 nm\"",
            ),
            (
                "thickness",
                "light = \"gray\"\nthickness",
                "22:9: outputs.fringes.light: found \"gray\"; allowed: \"grey\", \"monochrome\" or \"white\"; did you mean `grey`?",
            ),
            (
                "thickness",
                "bodies = [\"bal\"]\nthickness",
                "22:11: outputs.fringes.bodies[0]: found \"bal\"; allowed: the name of a body (\"ball\"); did you mean `ball`?",
            ),
            (
                "thickness",
                "view = { min = [0, 0], max = [1, 0] }\nthickness",
                "22:34: outputs.fringes.view.max[1]: found 0; allowed: more than 0 m, the y of min",
            ),
        ],
    );
    check(
        &space,
        &[(
            "thickness = \"6 mm\"",
            "thickness = \"7 mm\"",
            "22:13: outputs.fringes.thickness: found \"7 mm\"; allowed: no thickness in 3d, where light crosses the bodies as thick as they are",
        )],
    );
}

#[test]
fn measurements() {
    let cases = [
        ("time_unit = \"1 m\"", "outputs.time_unit: found \"1 m\"", "a time [s]"),
        ("time_unit = 0", "outputs.time_unit: found 0", "a time [s] above 0"),
        ("samples = \"steps\"", "outputs.samples: found unknown name `steps`", "a parameter"),
        ("probes = [{ name = \"p\", at = [0, 0] }]", "outputs.probes[0].at: found", "3 numbers"),
        (
            "probes = [{ name = \"p\", at = [0, 0, 0] }, { name = \"p\", at = [0, 0, 0] }]",
            "outputs.probes[1].name: found \"p\"",
            "a name that no other in the list has",
        ),
        (
            "probes = [{ name = \"p\", at = [0, 0, 0], body = \"plane\" }]",
            "\"plane\"",
            "a body that is not rigid (\"sphere\")",
        ),
        (
            "probes = [{ name = \"p\", at = [0, 0, 0], fixed_in = \"materiel\" }]",
            "outputs.probes[0].fixed_in: found \"materiel\"",
            "did you mean `material`?",
        ),
        (
            "arrivals = [{ quantity = \"vx\", threshold = \"1 Pa\", bodies = [\"sphere\"] }]",
            "outputs.arrivals[0].threshold: found \"1 Pa\", a pressure [Pa]",
            "a velocity [m/s] other than 0",
        ),
        (
            "arrivals = [{ quantity = \"vx\", threshold = 0, bodies = [\"sphere\"] }]",
            "outputs.arrivals[0].threshold: found 0",
            "other than 0",
        ),
        (
            "arrivals = [{ quantity = \"vx\", threshold = 1 }]",
            "watches no probe and no body",
            "probes = [...]",
        ),
        (
            "arrivals = [{ quantity = \"vx\", threshold = 1, probes = [\"p\"] }]",
            "outputs.arrivals[0].probes[0]: found \"p\"",
            "the name of a probe ()",
        ),
        (
            "fronts = [{ name = \"f\", quantity = \"xx\", threshold = 1, from = [0, 0, 0], direction = [0, 0, 0] }]",
            "outputs.fronts[0].direction: found",
            "a direction that is not zero",
        ),
        (
            "fronts = [{ name = \"f\", quantity = \"xx\", threshold = 1, from = [0, 0, 0], direction = [1, 0, 0], fit = [2, 1] }]",
            "outputs.fronts[0].fit[1]: found 1",
            "more than 2 m",
        ),
    ];
    for (text, found, allowed) in cases {
        let message = message(&edited(ROLLING, "grid = \"never\"", text));
        assert!(message.contains(found) && message.contains(allowed), "`{text}`\n  gives {message}");
    }
}
