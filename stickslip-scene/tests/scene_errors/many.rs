//! Tables that stand for many: `repeat`, patterns of names, and packings.

use crate::{check, message};
use stickslip_scene::geometry::Shape;
use stickslip_scene::scene::{self, BodyMotion, Scene};

const MANY: &str = r#"
space = { dimension = "plane-strain", cell = "1 mm" }
time.end = 1
parameters.r = "5 mm"

[materials.clay]
density = 1000
neo_hookean = { young_modulus = "1 MPa", poisson_ratio = 0.3 }

[[bodies]]
name = "disk {i} of row {j + 1}"
repeat = { j = 3, i = "3 - j" }
material = "clay"
shape.ball = { center = ["(2 * i + j) * r", "sqrt(3) * j * r"], radius = "r" }
velocity = ["i * 1 m/s", 0]

[[bodies]]
name = "floor"
material = "clay"
shape.box = { min = ["-1 cm", "-2 cm"], max = ["4 cm", "-5 mm"] }

[[packings]]
name = "grain"
material = "clay"
shape.ball = { center = [0, 0], radius = "1 mm" }
sizes = { uniform = [0.9, 1.1] }
within.box = { min = ["-1 cm", "3 cm"], max = ["3 cm", "5 cm"] }
solid_fraction = 0.7

[[supports]]
body = "disk * of row 1"
within.ball = { center = ["2 cm", 0], radius = "2.5 cm" }

[[contact]]
between = ["grain *", "disk *"]
friction = 0.4

[[contact]]
between = ["grain *", "grain *"]
friction = 0.2

[[outputs.probes]]
name = "at {k}"
repeat.k = 4
at = ["k * 1 cm", "4 cm"]

[[outputs.probes]]
name = "row"
at = [0, "4 cm"]
to = ["2 cm", "5 cm"]
count = 3

[[outputs.groups]]
name = "all grains"
bodies = ["grain *"]

[[outputs.arrivals]]
quantity = "speed"
threshold = 1
bodies = ["disk 0 *"]
"#;

fn scene() -> Scene {
    scene::parse("a.toml", MANY, &[]).unwrap_or_else(|error| panic!("{error}")).scene
}

#[test]
fn a_table_stands_for_many_with_indices_in_its_formulas_and_names() {
    let scene = scene();
    let names: Vec<&str> = scene.bodies.iter().map(|body| body.name.as_str()).take(7).collect();
    let expected =
        ["disk 0 of row 1", "disk 1 of row 1", "disk 2 of row 1", "disk 0 of row 2", "disk 1 of row 2"];
    assert_eq!(names[..5], expected);
    assert_eq!(names[5..], ["disk 0 of row 3", "floor"]);
    let Shape::Ball { center, radius } = scene.bodies[4].shape else { panic!("a disk") };
    assert!(
        (center[0] - 0.015).abs() < 1e-15 && (center[1] - 3.0_f64.sqrt() * 0.005).abs() < 1e-15,
        "{center:?}"
    );
    assert_eq!(radius, 0.005);
    let probes: Vec<_> =
        scene.outputs.measurements.probes.iter().map(|probe| (&*probe.name, probe.at[0])).collect();
    let at = [("at 0", 0.0), ("at 1", 0.01), ("at 2", 0.02), ("at 3", 0.03)];
    let row = [("row 1", 0.0), ("row 2", 0.01), ("row 3", 0.02)];
    assert_eq!(probes, [&at[..], &row[..]].concat());
}

#[test]
fn an_array_makes_copies_with_numbers() {
    let make = |array: &str| {
        let text = MANY.replace("name = \"floor\"", &format!("name = \"floor\"\narray.{array}"));
        scene::parse("a.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}")).scene
    };
    let centers = |scene: &Scene| -> Vec<(String, [f64; 2])> {
        let floors = scene.bodies.iter().filter(|body| body.name.starts_with("floor "));
        let middle = |shape: &Shape| shape.bounds(2).expect("bounded").middle();
        floors
            .map(|body| (body.name.clone(), middle(&body.shape)))
            .map(|(name, [x, y, _])| (name, [x, y]))
            .collect()
    };
    let near = |found: &[(String, [f64; 2])], expected: &[(&str, [f64; 2])]| {
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for ((name, at), (wanted, place)) in found.iter().zip(expected) {
            assert!(name == wanted && (0..2).all(|k| (at[k] - place[k]).abs() < 1e-12), "{found:?}");
        }
    };
    let rows = make("square = { spacing = \"10 cm\", counts = [1, 2] }");
    near(&centers(&rows), &[("floor 1", [0.015, -0.0125]), ("floor 2", [0.015, 0.0875])]);
    let ring = make("ring = { center = [0, -1], count = 2, orientation = \"kept\" }");
    near(&centers(&ring), &[("floor 1", [0.015, -0.0125]), ("floor 2", [-0.015, -1.9875])]);
    let path = make("path = { points = [[0, -1], [0, -2]], spacing = \"50 cm\" }");
    near(&centers(&path), &[("floor 1", [0.0, -1.0]), ("floor 2", [0.0, -1.5]), ("floor 3", [0.0, -2.0])]);
    let inside = make(
        "hexagonal = { spacing = \"6 cm\", within.box = { min = [-1, -1], max = [\"-89 cm\", \"-90 cm\"] } }",
    );
    near(
        &centers(&inside),
        &[
            ("floor 1", [-0.975, -0.9925]),
            ("floor 2", [-0.915, -0.9925]),
            ("floor 3", [-0.945, -0.9925 + 0.06 * 0.75_f64.sqrt()]),
        ],
    );
}

#[test]
fn mistakes_in_arrays_lines_and_groups() {
    let floor = "name = \"floor\"";
    let with = |array: &str| format!("name = \"floor\"\narray = {array}");
    let cases = [
        (
            "{}",
            "19:1: bodies[1].array: found an array of no kind; allowed: one of square, hexagonal, ring and path",
        ),
        (
            "{ ring = { center = [0, 0], count = 2 }, path = { points = [[0, 0], [1, 0]], spacing = 1 } }",
            "19:1: bodies[1].array: found an array of several kinds; allowed: one of square, hexagonal, ring and path",
        ),
        (
            "{ square = { spacing = 1 } }",
            "19:11: bodies[1].array.square: found neither `counts` nor `within`; allowed: one of counts and within",
        ),
        (
            "{ square = { spacing = 1, counts = [2] } }",
            "19:44: bodies[1].array.square.counts: found 1 numbers; allowed: 2 whole numbers",
        ),
        (
            "{ square = { spacing = 0, counts = [2, 2] } }",
            "19:32: bodies[1].array.square.spacing: found 0; allowed: a length [m] above 0, like \"0.4 m\"",
        ),
        (
            "{ square = { spacing = 1, counts = [2000, 2000] } }",
            "19:11: bodies[1].array.square: found about 4.0e6 copies; allowed: at most 1000000; are the units right?",
        ),
        (
            "{ square = { spacing = 1, within.ball = { center = [0, 0], radius = \"1 cm\" } } }",
            "19:35: bodies[1].array.square.within: found a container in which the shape has no room; allowed: one that holds a copy at least",
        ),
        (
            "{ square = { spacing = 1, within.half_space = { point = [0, 0], normal = [0, 1] } } }",
            "19:35: bodies[1].array.square.within: found a shape without bounds; allowed: a container with bounds",
        ),
        (
            "{ ring = { center = [0, 0], count = 2, axis = [0, 1] } }",
            "19:55: bodies[1].array.ring.axis: found [0, 1]; allowed: no axis, as the scene is plane",
        ),
        (
            "{ path = { points = [[0, 0]], spacing = 1 } }",
            "19:29: bodies[1].array.path.points: found 1 points; allowed: at least 2 points, 4 if the last is the first",
        ),
        (
            "{ path = { points = [[0, 0], [0, 0]], spacing = 1 } }",
            "19:38: bodies[1].array.path.points[1]: found [0, 0]; allowed: another point than the one before it",
        ),
    ];
    for (array, expected) in cases {
        check(MANY, &[(floor, &with(array), expected)]);
    }
    check(
        MANY,
        &[
            (
                "count = 3\n",
                "",
                "47:1: outputs.probes[1].count: found nothing, the key is missing; allowed: how many probes the line has",
            ),
            (
                "to = [\"2 cm\", \"5 cm\"]\n",
                "",
                "50:9: outputs.probes[1].count: found 3; allowed: a count only beside `to`, the end of a line",
            ),
            (
                "count = 3",
                "count = 1",
                "51:9: outputs.probes[1].count: found 1; allowed: a whole number from 2 to 100000",
            ),
            (
                "bodies = [\"grain *\"]",
                "bodies = [\"gravel *\"]",
                "55:11: outputs.groups[0].bodies[0]: found \"gravel *\"; allowed: the name of a body (\"disk 0 of row 1\", \"disk 1 of row 1\", \"disk 2 of row 1\", \"disk 0 of row 2\", \"disk 1 of row 2\", \"disk 0 of row 3\", \"floor\", \"grain 1\", \"grain 2\", \"grain 3\", \"grain 4\", \"grain 5\", and 172 more); in a pattern, `*` is any letters: none of these names match it",
            ),
            (
                "name = \"all grains\"",
                "name = \"\"",
                "54:8: outputs.groups[0].name: found \"\"; allowed: a name that no other in the list has",
            ),
        ],
    );
}

#[test]
fn patterns_of_names_stand_for_all_bodies_that_match() {
    let scene = scene();
    let supports: Vec<_> = scene.loads.iter().map(|load| load.name.as_str()).collect();
    let on = ["0", "1", "2"].map(|i| format!("support on disk {i} of row 1"));
    assert_eq!(supports, on);
    assert_eq!(
        scene.outputs.measurements.arrivals[0].bodies,
        [0, 3, 5].map(|i| scene.bodies[i].name.clone())
    );
    let [disk, floor, grain, last] = [0, 6, 7, scene.bodies.len() - 1];
    assert!(scene.bodies[grain].name == "grain 1" && scene.bodies[last].name.starts_with("grain "));
    for (a, b, friction) in [(disk, grain, 0.4), (grain, last, 0.2), (grain, floor, 0.0), (disk, floor, 0.0)]
    {
        assert_eq!(scene.contact_between(a, b).friction, friction, "{a} {b}");
        assert_eq!(scene.contact_between(b, a).friction, friction, "{b} {a}");
    }
}

#[test]
fn a_packing_fills_its_container_as_asked() {
    let scene = scene();
    let grains = scene.bodies.iter().filter(|body| body.name.starts_with("grain "));
    let area: f64 = grains.map(|body| body.shape.volume(2).expect("a disk")).sum();
    assert!((area / (0.04 * 0.02) - 0.7).abs() < 1e-12, "{area}");
}

#[test]
fn grains_of_a_packing_may_be_free_rigid_bodies() {
    let text = |rigid: &str| {
        MANY.replace(
            "solid_fraction = 0.7",
            &format!("solid_fraction = 0.7\nvelocity = [0, -1]\nrigid{rigid}"),
        )
    };
    let scene =
        scene::parse("a.toml", &text(".free = {}"), &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    let grains: Vec<_> = scene.bodies.iter().filter(|body| body.name.starts_with("grain ")).collect();
    assert!(grains.len() > 100);
    for grain in grains {
        let BodyMotion::FreeRigid(free) = &grain.motion else { panic!("{:?}", grain.motion) };
        // Each has the mass of its own shape.
        assert_eq!((free.velocity, free.mass, free.inertia), ([0.0, -1.0, 0.0], None, None));
    }
    let message = scene::parse("a.toml", &text(" = {}"), &[]).expect_err("they have a velocity").to_string();
    assert!(
        message.ends_with("29:1: packings[0].velocity: found `velocity` of a rigid body; allowed: its motion in rigid = { velocity = ... }"),
        "{message}"
    );
}

/// A run that ends at rest has rows, however late its end is; many bodies have fewer rows and snapshots.
#[test]
fn intervals_of_outputs_follow_from_bodies_and_rest() {
    let outputs = |text: &str| {
        scene::parse("a.toml", text, &[]).unwrap_or_else(|error| panic!("{error}")).scene.outputs
    };
    let few = &MANY[..MANY.find("[[packings]]").expect("it has some")];
    assert_eq!((outputs(few).tables, outputs(few).particles), (1.0 / 200.0, Some(1.0 / 20.0)));
    let many = MANY.replace("solid_fraction = 0.7", "count = 193");
    assert_eq!((outputs(&many).tables, outputs(&many).particles), (1.0 / 30.0, Some(1.0 / 4.0)));
    // 0.4 of the time in which a wave of sqrt(M / rho), M = 1.346 E, crosses a cell.
    let step = 0.4 * 1e-3 / (1e3_f64 * 0.7 / (1.3 * 0.4)).sqrt();
    let relaxed = |text: &str, end: &str| {
        outputs(&text.replace("time.end = 1", &format!("time = {{ end = {end}, relax = {{}} }}")))
    };
    assert!((relaxed(few, "1000").tables / (100.0 * step) - 1.0).abs() < 1e-12);
    assert!((relaxed(&many, "1000").tables / (100.0 * 200.0 / 30.0 * step) - 1.0).abs() < 1e-12);
    assert_eq!(relaxed(few, "1e-4").tables, 1e-4 / 200.0);
    let asked = few.to_string() + "[outputs]\ntables = 2";
    assert_eq!(relaxed(&asked, "1000").tables, 2.0);
}

#[test]
fn problems_found_later_are_shown_at_the_table_that_stands_for_many() {
    let text = MANY.replace("max = [\"4 cm\", \"-5 mm\"]", "max = [\"4 cm\", \"1 mm\"]");
    let loaded = scene::parse("a.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let problem =
        stickslip_scene::check::problems(&loaded.scene).expect_err("the floor reaches into the first row");
    assert_eq!(problem.key, "bodies[6].shape");
    let shown = loaded.source.locate(problem).to_string();
    assert!(
        shown.starts_with("a.toml:20:1: bodies[1].shape: found `floor` overlaps `disk 0 of row 1`"),
        "{shown}"
    );
    assert_eq!(loaded.source.written("bodies[9].shape.ball"), "packings[0].shape.ball");
    assert_eq!(loaded.source.written("supports[2].within"), "supports[0].within");
    assert_eq!(loaded.source.written("outputs.probes[3].at"), "outputs.probes[0].at");
}

#[test]
fn mistakes() {
    check(
        MANY,
        &[
            (
                "repeat = { j = 3, i = \"3 - j\" }",
                "repeat = { j = 2.5 }",
                "12:16: bodies[0].repeat.j: found 2.5; allowed: a whole number from 0 on, of at most 1000000 repetitions in all",
            ),
            (
                "j = 3, i",
                "j = 5, i",
                "12:23: bodies[0].repeat.i: found \"3 - j\", which is -1; allowed: a whole number from 0 on, of at most 1000000 repetitions in all; this is with j = 4",
            ),
            (
                "repeat = { j = 3, i = \"3 - j\" }",
                "repeat = {}",
                "12:1: bodies[0].repeat: found a table; allowed: a table of indices and how many values they have: { i = 10, j = 5 }",
            ),
            (
                "repeat = { j = 3, i = \"3 - j\" }",
                "repeat = { j = 1000000, i = 1000000, k = 0 }",
                "12:29: bodies[0].repeat.i: found 1000000; allowed: a whole number from 0 on, of at most 1000000 repetitions in all; this is with j = 0",
            ),
            (
                "repeat.k = 4",
                "repeat.r = 4",
                "44:8: outputs.probes[0].repeat.r: found the index `r`, which is the name of a parameter or of another index; allowed: another name",
            ),
            (
                "repeat.k = 4",
                "repeat.sin = 4",
                "44:8: outputs.probes[0].repeat.sin: found the name `sin`, which formulas use already; allowed: another name",
            ),
            (
                "disk {i} of row {j + 1}",
                "disk of row {j + 1}",
                "11:8: bodies[0].name: found \"disk of row {j + 1}\", which is \"disk of row 1\"; allowed: a name that no other body has; this is with j = 0, i = 1",
            ),
            (
                "{j + 1}",
                "{l + 1}",
                "11:26: bodies[0].name: found unknown name `l`; allowed: a parameter (r, j, i), pi or inf; this is with j = 0, i = 0",
            ),
            (
                "name = \"floor\"",
                "name = \"floor*\"",
                "18:8: bodies[1].name: found \"floor*\"; allowed: a name without `*`, which is any letters where bodies are named",
            ),
            (
                "body = \"disk * of row 1\"",
                "body = \"grain\"",
                "31:8: supports[0].body: found \"grain\"; allowed: the name of a body that deforms (\"disk 0 of row 1\", \"disk 1 of row 1\", \"disk 2 of row 1\", \"disk 0 of row 2\", \"disk 1 of row 2\", \"disk 0 of row 3\", \"floor\", \"grain 1\", \"grain 2\", \"grain 3\", \"grain 4\", \"grain 5\", and 172 more); `grain *` is all whose names begin so",
            ),
            (
                "solid_fraction = 0.7",
                "count = 900",
                "28:9: packings[0].count: found grains of 3.538 times the volume of the container; allowed: less than about 0.6 of it in space, 0.8 in the plane; fewer or smaller grains, or a larger container; are the units right?",
            ),
            (
                "sizes = { uniform = [0.9, 1.1] }",
                "sizes = { numbers = [0.8, 1.2] }",
                "26:22: packings[0].sizes.numbers[0]: found 0.8; allowed: a size and its share, such as [1.5, 0.3]",
            ),
            (
                "between = [\"grain *\", \"disk *\"]",
                "between = [\"grian *\", \"disk *\"]",
                "35:12: contact[0].between[0]: found \"grian *\"; allowed: the name of a body or a material, or any (\"disk 0 of row 1\", \"disk 1 of row 1\", \"disk 2 of row 1\", \"disk 0 of row 2\", \"disk 1 of row 2\", \"disk 0 of row 3\", \"floor\", \"grain 1\", \"grain 2\", \"grain 3\", \"grain 4\", \"grain 5\", and 174 more); in a pattern, `*` is any letters: none of these names match it",
            ),
            (
                "solid_fraction = 0.7",
                "solid_fraction = 0.7\nsettle = [0, 0]",
                "29:10: packings[0].settle: found [0, 0]; allowed: a direction: a vector that is not zero",
            ),
            (
                "solid_fraction = 0.7",
                "solid_fraction = 1.2",
                "28:18: packings[0].solid_fraction: found 1.2; allowed: a number above 0 and below 1",
            ),
            (
                "solid_fraction = 0.7",
                "",
                "22:1: packings[0]: found neither `count` nor `solid_fraction`; allowed: one of count and solid_fraction",
            ),
            (
                "solid_fraction = 0.7",
                "solid_fraction = 0.7\ncount = 9",
                "28:1: packings[0].solid_fraction: found `solid_fraction` beside `count`; allowed: one of count and solid_fraction",
            ),
            (
                "sizes = { uniform = [0.9, 1.1] }",
                "sizes = { uniform = [1.1, 0.9] }",
                "26:21: packings[0].sizes.uniform: found [1.1, 0.9]; allowed: the smallest size first",
            ),
            (
                "sizes = { uniform = [0.9, 1.1] }",
                "sizes = { normal = [1, 0.4] }",
                "26:20: packings[0].sizes.normal: found [1, 0.4]; allowed: sizes above 0, the largest at most 10 times the smallest; these are from -0.200 to 2.200",
            ),
            (
                "sizes = { uniform = [0.9, 1.1] }",
                "sizes = { uniforn = [0.9, 1.1] }",
                "26:11: packings[0].sizes.uniforn: found unknown key `uniforn`; allowed: uniform, normal, lognormal, numbers, volumes; did you mean `uniform`?",
            ),
            (
                "within.box = { min = [\"-1 cm\", \"3 cm\"], max = [\"3 cm\", \"5 cm\"] }",
                "within.half_space = { point = [0, 0], normal = [0, 1] }",
                "27:1: packings[0].within: found a shape without bounds, or in which almost nothing is; allowed: a container",
            ),
            (
                "radius = \"1 mm\" }\nsizes",
                "radius = \"1 um\" }\nsizes",
                "22:1: packings[0]: found about 1.8e8 grains; allowed: at most 1000000; are the units of the grain and the container right?",
            ),
        ],
    );
    let content = |keys: &str| message(&format!("{MANY}\n[outputs.snapshots]\n{keys}\n"));
    assert_eq!(
        content("columns = [\"velocity\", \"stres\"]"),
        "a.toml:63:24: outputs.snapshots.columns[1]: found \"stres\"; allowed: a column of particles (\"velocity\", \
         \"mass\", \"volume\", \"deformation\", \"stress\", \"pressure\", \"von_mises\", \"strain_rate\", \
         \"bulk_viscosity\", \"initial_stretch\", \"temperature\", \"thermal_strain_step\"); did you mean `stress`?"
    );
    assert_eq!(
        content("every = 0"),
        "a.toml:63:9: outputs.snapshots.every: found 0; allowed: a whole number from 1 to 1000000"
    );
    assert_eq!(
        content("precision = \"half\""),
        "a.toml:63:13: outputs.snapshots.precision: found \"half\"; allowed: \"double\" or \"single\""
    );
    assert_eq!(
        content("compression = \"gzip\""),
        "a.toml:63:15: outputs.snapshots.compression: found \"gzip\"; allowed: \"zlib\" or \"none\""
    );
    let outputs = |keys: &str| message(&format!("{MANY}\n[outputs]\n{keys}\n"));
    assert_eq!(
        outputs("surfaces = \"1 ms\"\nsurface_format = \"stl\""),
        "a.toml:64:18: outputs.surface_format: found \"stl\"; allowed: \"vtp\", \"vtu\" or \"glb\""
    );
    let rows = message(&format!("{MANY}\n[outputs]\nbodies = [\"pebble *\"]\n"));
    let start = "a.toml:63:11: outputs.bodies[0]: found \"pebble *\"; allowed: ";
    assert!(rows.starts_with(start), "{rows}");
    let dense = message(&MANY.replace("solid_fraction = 0.7", "solid_fraction = 0.9"));
    let start = "a.toml:28:18: packings[0].solid_fraction: found grains that fill 0.900 of the container, and jam; allowed: about 0.";
    assert!(dense.starts_with(start) && dense.contains("fewer or smaller grains"), "{dense}");
}
