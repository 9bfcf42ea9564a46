//! Bodies from particles in CSV files.

use crate::edited;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;
use stickslip_scene::geometry;
use stickslip_scene::scene::{self, BodyMotion, Loaded, SceneError};

const CLOUD: &str = r#"[space]
dimension = "plane-strain"
cell = "2 mm"
[time]
end = 1
[materials.sand]
density = 2000
neo_hookean = { young_modulus = "1 MPa", poisson_ratio = 0.3 }
[[point_clouds]]
name = "grain"
file = "grains.csv"
unit = "1 mm"
material = "sand"
"#;

/// Two squares of 8 by 8 particles, with the given columns.
fn grains(header: &str, row: impl Fn([f64; 2], usize) -> String) -> String {
    let mut text = format!("{header}\n");
    for n in 0..128_usize {
        let (body, i, j) = (n / 64, n % 64 / 8, n % 8);
        let at = [12.0 * body as f64 + i as f64 + 0.5, j as f64 + 0.5];
        writeln!(text, "{}", row(at, body)).expect("text");
    }
    text
}

fn usual() -> String {
    grains("id, X, Y, volume, vx, vy, body", |[x, y], body| format!("7, {x}, {y}, 1, {y}, 2, {}", body + 3))
}

fn parse(text: &str, csv: &str) -> Result<Loaded, SceneError> {
    let files = BTreeMap::from([(PathBuf::from("grains.csv"), csv.as_bytes().to_vec())]);
    scene::parse_beside("a.toml", text, &[], &files)
}

#[test]
fn particles_become_bodies_in_si_units() {
    let scene = parse(CLOUD, &usual()).unwrap_or_else(|error| panic!("{error}")).scene;
    let names: Vec<_> = scene.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["grain 3", "grain 4"]);
    let second = &scene.bodies[1];
    assert_eq!(second.particles_per_side, Some(2));
    let sites: Vec<_> =
        geometry::sites(&second.shape, &scene.lattice(second), second.particles).expect("its own").collect();
    assert_eq!((sites.len(), sites[9].position), (64, [0.0135, 0.0015, 0.0]));
    assert!((sites[9].volume - 1e-6).abs() < 1e-20);
    let BodyMotion::Free { velocity, spin } = second.motion else { panic!("it is free") };
    assert!((velocity[0] - 0.004).abs() < 1e-15 && (velocity[1] - 0.002).abs() < 1e-15 && spin == [0.0; 3]);
    // By masses, and all in one body.
    let masses = grains("x,y,mass", |[x, y], _| format!("{x},{y},0.002"));
    let one = &parse(CLOUD, &masses).unwrap_or_else(|error| panic!("{error}")).scene.bodies[..];
    let [one] = one else { panic!("{one:?}") };
    assert_eq!(one.name, "grain");
    assert!((one.shape.volume(2).expect("a sum") - 128e-6).abs() < 1e-15);
}

#[test]
fn files_that_are_no_particles() {
    let plain = |header: &str| grains(header, |[x, y], _| format!("{x},{y},1"));
    let replaced = |from: &str, to: &str| {
        let text = plain("x,y,volume");
        assert!(text.contains(from));
        text.replacen(from, to, 1)
    };
    let wrong: Vec<String> = [
        (plain("x,z,volume"), "in grains.csv: no column y among `x, z, volume`; allowed: columns x, y and in space z, named in the first line"),
        (plain("x,y,size"), "in grains.csv: no column volume among `x, y, size`; allowed: a column volume or mass, named in the first line"),
        (plain("x,y,volume,x"), "in grains.csv, line 1, column 4: a second column x; allowed: one of each name"),
        (plain("x,y,volume,vx"), "in grains.csv: no column vy among `x, y, volume, vx`; allowed: all of vx, vy and in space vz, or none of them"),
        (replaced("0.5,1.5,1", "0.5,1.5O,1"), "in grains.csv, line 3, column 2: `1.5O` as y; allowed: a finite number"),
        (replaced("0.5,1.5,1", "0.5,inf,1"), "in grains.csv, line 3, column 2: `inf` as y; allowed: a finite number"),
        (replaced("0.5,1.5,1", "0.5,1.5,0"), "in grains.csv, line 3, column 3: `0` as volume; allowed: a number above 0"),
        (replaced("0.5,1.5,1", "0.5,1.5"), "in grains.csv, line 3, column 3: `` as volume; allowed: a number, a row as long as the first"),
        ("x,y,volume\n".to_string(), "in grains.csv: no particles; allowed: a row for each particle below the names of columns"),
        (grains("x,y,volume", |[x, y], _| format!("{x},{y},0.1")), "in grains.csv: `grain`, whose particles fill 0.20 of the space around them; allowed: volumes that fill the space between particles, two deep at least; is `unit` that of the file?"),
        (grains("x,y,volume", |[x, y], _| format!("{x},{y},4")), "in grains.csv: `grain`, whose particles fill the space around them 2.8 times; allowed: volumes that fill the space between particles once; is `unit` that of the file?"),
        (grains("x,y,volume", |[x, y], _| format!("{x},{y},9")), "in grains.csv: particles 0.0030 m apart, more than a cell; allowed: at most 0.002 m; is `unit` that of the file? Each cell needs a particle at least"),
        (replaced("0.5,1.5,1", "1e9,1e9,1"), "in grains.csv: 1 bodies in boxes of 1.0e18 particles' size in all; allowed: at most 100000 bodies, each in one place; is `unit` that of the file?"),
    ]
    .iter()
    .filter_map(|(csv, expected)| {
        let found = parse(CLOUD, csv).expect_err(expected).to_string();
        let expected = format!("a.toml:11:8: point_clouds[0].file: found {expected}");
        (!found.starts_with(&expected)).then(|| format!("gives {found}\nnot   {expected}\n"))
    })
    .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn tables_that_do_not_suit_their_file() {
    for (from, to, expected) in [
        (
            "material",
            "velocity = [1, 0]\nmaterial",
            "a.toml:13:1: point_clouds[0].velocity: found `velocity` beside velocities in grains.csv; allowed: one of \
             the two",
        ),
        (
            "material = \"sand\"",
            "material = \"sand\"\nrigid = {}",
            "a.toml:11:8: point_clouds[0].file: found in grains.csv: velocities of a rigid body; allowed: no columns \
             vx, vy, vz beside `rigid`",
        ),
        (
            "grains.csv",
            "grain.csv",
            "a.toml:11:8: point_clouds[0].file: found \"grain.csv\"; allowed: a file that can be read; grain.csv: \
             entity not found; a relative path starts at the scene's folder",
        ),
        (
            "\"1 mm\"",
            "\"1 s\"",
            "a.toml:12:8: point_clouds[0].unit: found \"1 s\", a time [s]; allowed: a length [m], like \"0.4 m\"",
        ),
        (
            "unit = \"1 mm\"",
            "scale = 2",
            "a.toml:12:1: point_clouds[0].scale: found unknown key `scale`; allowed: name, file, unit, material, \
             velocity, spin, rigid",
        ),
    ] {
        // The last is the table's.
        let at = CLOUD.rfind("[[point_clouds]]").expect("there");
        let text = format!("{}{}", &CLOUD[..at], edited(&CLOUD[at..], from, to));
        assert_eq!(parse(&text, &usual()).expect_err(expected).to_string(), expected);
    }
}
