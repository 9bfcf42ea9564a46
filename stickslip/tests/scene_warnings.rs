//! What is doubtful with a scene but allowed: each case is told of with its place, and the scenes of the repository are
//! told of nothing but contacts that the grid does not resolve.

use std::path::{Path, PathBuf};
use stickslip::check::{Warning, pairs_without_friction, report};
use stickslip::scene;

const DOUBTFUL: &str = r#"
gravity = [0, "-9.81 m/s^2"]
space = { dimension = "plane-strain", interior = "grid", cell = "1 cm" }
time.end = "1 s"
materials.rubber = { density = 1000, neo_hookean = { shear_modulus = "1 MPa", poisson_ratio = 0.499 } }
materials.steel = { density = 8000, neo_hookean = { young_modulus = "200 GPa", poisson_ratio = 0.3 } }

[[bodies]]
name = "strip"
material = "rubber"
shape.box = { min = [0, 0], max = ["30 cm", "2 cm"] }

[[bodies]]
name = "roller"
material = "rubber"
shape.ball = { center = ["10 cm", "11.99 cm"], radius = "10 cm" }

[[bodies]]
name = "ram"
material = "steel"
shape.box = { min = ["40 cm", 0], max = ["50 cm", "10 cm"] }
rigid = { velocity = ["20 cm/s", 0] }

[[bodies]]
name = "anvil"
material = "steel"
shape.box = { min = ["60 cm", 0], max = ["70 cm", "10 cm"] }
rigid = {}

[[contact]]
between = ["rubber", "any"]
friction = 0.5

[[contact]]
between = ["roller", "strip"]
friction = 0.1

[[contact]]
between = ["ram", "anvil"]
friction = 0.1
"#;

#[test]
fn each_doubt_is_told_of_where_it_stands_in_the_file() {
    let loaded = scene::parse("a.toml", DOUBTFUL, &[]).expect("a scene");
    let report = report(&loaded.scene).expect("no problem").placed(&loaded.source);
    let found: Vec<_> = report.warnings.iter().map(ToString::to_string).collect();
    let line = |text: &str, nth: usize| {
        1 + DOUBTFUL.match_indices(text).nth(nth).map_or(0, |(at, _)| DOUBTFUL[..at].matches('\n').count())
    };
    for (line, expected) in [
        (
            line("[[contact]]", 1),
            "contact[1]: never holds: contact[0] ([\"rubber\", \"any\"]) comes before it",
        ),
        (
            line("[[contact]]", 2),
            "contact[2]: never acts: [\"ram\", \"anvil\"] matches rigid bodies with prescribed motion only",
        ),
        (
            line("shape.ball", 0),
            "bodies[1].shape: `roller` overlaps `strip` by 1.000e-4 m (1.00e-2 cells) near (0.1000, 0.0",
        ),
        (line("rigid", 1), "bodies[3].rigid: the rigid bodies `ram` and `anvil` overlap from t = 5.0"),
        (
            line("materials.rubber", 0),
            "materials.rubber: nearly incompressible: `rubber` has a Poisson's ratio of 0.499000",
        ),
        (line("shape.box", 0), "bodies[0].shape: thinner than 3 cells: `strip` (0.02 m thick, 2.0 cells)"),
    ] {
        let start = format!("a.toml:{line}:");
        let told = found.iter().any(|text| text.starts_with(&start) && text.contains(expected));
        assert!(told, "no `{start} ... {expected}` in\n{}", found.join("\n"));
    }
}

/// What the scenes of folders are told before a run.
fn told_in(folders: &[&str]) -> Vec<(PathBuf, Vec<Warning>)> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(here.join(folder)).expect("a folder"));
    let paths = files.map(|file| file.expect("a file").path());
    let told = |path: PathBuf| {
        let scene = scene::load(&path, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
        let report = report(&scene).unwrap_or_else(|problem| panic!("{}: {problem}", path.display()));
        (path, report.warnings)
    };
    paths.filter(|path| path.extension().is_some_and(|end| end == "toml")).map(told).collect()
}

#[test]
fn the_scenes_of_the_repository_are_told_of_nothing_but_resolution() {
    let all = told_in(&["../scenes", "../scenes/paper", "../scenes/shapes"]);
    for (path, warnings) in &all {
        let others: Vec<_> =
            warnings.iter().filter(|warning| !warning.text.starts_with("not resolved")).collect();
        assert!(others.is_empty(), "{}: {others:?}", path.display());
    }
    assert!(all.len() >= 10, "{}", all.len());
}

/// Lines that anybody reads before a run.
const READ: usize = 10;

#[test]
fn no_scene_is_told_of_more_than_anybody_reads() {
    let scenes = ["../scenes", "../scenes/paper", "../scenes/shapes", "../scenes/experiment"];
    let all = told_in(&[&scenes[..], &["../scenes/gallery", "tests/sound"]].concat());
    for (path, warnings) in &all {
        assert!(warnings.len() <= READ, "{}: {warnings:?}", path.display());
    }
    assert!(all.len() >= 40, "{}", all.len());
}

/// A rule that names no friction, and pairs that no rule names; glued bodies rub on nothing.
#[test]
fn pairs_without_a_word_on_friction_are_named() {
    let said = |rules: &str| {
        let (head, _) = DOUBTFUL.split_once("[[contact]]").expect("it has rules");
        let loaded = scene::parse("a.toml", &format!("{head}{rules}"), &[]).expect("a scene");
        pairs_without_friction(&loaded.scene)
    };
    let all =
        "the friction of `strip` and `roller`, and of 4 more pairs, is 0, as no [[contact]] says what it is";
    assert_eq!(said("").as_deref(), Some(all));
    let one = "[[contact]]\nbetween = [\"roller\", \"any\"]\nfriction = 0\n";
    let others = "[[contact]]\nbetween = [\"strip\", \"ram\"]\nlaw = \"glued\"\n[[contact]]\nlaw = \"gap\"";
    let last = "the friction of `strip` and `anvil` is 0, as no [[contact]] says what it is";
    assert_eq!(said(&format!("{one}{others}")).as_deref(), Some(last));
    assert_eq!(said("[[contact]]\nfriction = 0"), None);
}
