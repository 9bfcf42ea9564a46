//! Files that hold no closed surface of triangles.

use crate::{MINIMAL, edited};
use std::fs;
use stickslip_scene::scene;

/// A tetrahedron, its faces one after the other.
const FACES: [&str; 4] = ["f 1 3 2", "f 1 2 4", "f 2 3 4", "f 3 1 4"];
const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

/// The message of a scene whose body is a mesh from a file with this text.
fn message(file: &str, text: Option<&str>) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    if let Some(text) = text {
        fs::write(folder.path().join(file), text).expect("written");
    }
    let shape = MINIMAL.lines().find(|line| line.starts_with("shape")).expect("a body has a shape");
    let scene = edited(MINIMAL, shape, &format!("shape.mesh = {{ file = \"{file}\" }}"));
    let name = folder.path().join("a.toml").display().to_string();
    let found = scene::parse(&name, &scene, &[]).map(|_| ()).map_err(|error| error.to_string());
    let place = format!("{}/", folder.path().display());
    found.expect_err("no mesh").replace(&place, "")
}

#[test]
fn what_is_no_mesh_is_told_with_line_key_and_place() {
    let of = |faces: &[&str]| format!("{CORNERS}{}\n", faces.join("\n"));
    let [a, b, c, d] = FACES;
    let cases = [
        (
            "missing.stl",
            None,
            "found \"missing.stl\"; allowed: a file that can be read; missing.stl: No such file or directory",
        ),
        (
            "part.step",
            Some(String::new()),
            "found \"part.step\"; allowed: a file of triangles that ends in .stl, .obj or .ply",
        ),
        (
            "empty.obj",
            Some(CORNERS.to_string()),
            "found in empty.obj: no triangle; allowed: a closed surface of triangles that face outward",
        ),
        ("words.stl", Some("solid x\nfacet normal 0 0 zero\n".to_string()), "found in words.stl: no STL: "),
        (
            "words.ply",
            Some("ply\nformat ascii 1.0\nelement\n".to_string()),
            "found in words.ply: no PLY: a header with `element`",
        ),
        (
            "open.obj",
            Some(of(&[a, b, c])),
            "found in open.obj: a surface with holes: 3 open edges, the first near (0, 0.5, 0); allowed",
        ),
        (
            "faces.obj",
            Some(of(&[a, b, c, "f 3 4 1"])),
            "found in faces.obj: 3 edges where triangles face opposite ways or are more than two, the first near ",
        ),
        (
            "inward.obj",
            Some(of(&["f 1 2 3", "f 1 4 2", "f 2 4 3", "f 3 4 1"])),
            "found in inward.obj: a surface inside out: its volume is -1.6667e-1; allowed",
        ),
        (
            "flat.obj",
            Some(of(&[a, b, c, d]) + "v 2 0 0\nf 1 2 5\n"),
            "found in flat.obj: 1 triangle without area, the first near (1, 0, 0); allowed",
        ),
    ];
    for (file, text, expected) in cases {
        let found = message(file, text.as_deref());
        assert!(found.starts_with("a.toml:") && found.contains("bodies[0].shape.mesh.file: "), "{found}");
        assert!(found.contains(expected), "{found}\n  not {expected}");
    }
}

/// In the plane a scene says where the plane cuts the mesh, in space it does not.
#[test]
fn sections_of_meshes_are_of_the_plane() {
    let faces = format!("{CORNERS}{}\n", FACES.join("\n"));
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("part.obj"), faces).expect("written");
    let found = |dimension: &str, section: &str| {
        let text = format!(
            r#"
space = {{ dimension = "{dimension}", cell = 0.1 }}
time.end = 1
materials.clay = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }} }}
bodies = [{{ name = "part", material = "clay", shape.mesh = {{ file = "part.obj"{section} }} }}]
"#
        );
        let name = folder.path().join("a.toml").display().to_string();
        let loaded = scene::parse(&name, &text, &[]).map_err(|error| error.to_string());
        loaded.map(|loaded| loaded.scene.bodies[0].shape.volume(2))
    };
    // A triangle whose sides are half as long.
    let area = found("plane-strain", ", section = 0.5").expect("it is cut").expect("it has an area");
    assert!((area - 0.125).abs() < 1e-12, "{area}");
    for (dimension, section, expected) in [
        ("plane-strain", "", "shape.mesh.section: found nothing, the key is missing; allowed: the height z"),
        (
            "plane-stress",
            ", section = 1.5",
            "shape.mesh.section: found 1.5; allowed: a height within the mesh, 0 m to 1 m",
        ),
        (
            "3d",
            ", section = 0.5",
            "shape.mesh.section: found 0.5; allowed: no section, as the scene is in space",
        ),
    ] {
        let error = found(dimension, section).expect_err("no body");
        assert!(error.contains(expected), "{error}\n  not {expected}");
    }
}
