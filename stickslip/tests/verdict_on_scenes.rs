//! The verdict on runs of the engine: it is silent on the paper's scenes and on others that are right, and tells of
//! bodies that the grid tears and of one that meets itself.
//!
//! # Set-up
//! - The six scenes of the paper that [`PAPER`] names, coarse: spheres with R/4, disks with D/40.
//! - A strip of rubber of four cells' width and 20 cells' length that is pulled to 1.6 of its length, slowly (book,
//!   chapter 17), by `gimp`.
//! - The scenes of the folder `sound`: rigid bodies at rest on friction and on each other, a block at rest by each
//!   bond, a gripper that closes from a first touch on, flat bars that strike each other; on grids of their own blocks
//!   at rest without gravity, on a slope and on a face of the domain, and one that a pressure strikes within a step.
//!   Their residuals are round-off, or a contact that is not resolved at first and is later.
//! - Two halves of one body that meet, on the common grid and on a grid of its own.
//! - A disk of rubber with R/5 that is thrown against a rigid floor with 0.7 of its wave speed sqrt(E/rho), mu = 0.3,
//!   by each basis.
//!
//! # Expected
//! No warning of any kind on the paper's scenes and the sound ones; what contacts lack in resolution is told apart from
//! them, and is nothing in the sound ones. The body that meets itself is told by `self-contact`. The strip and the disk
//! are told by `tearing` and `strain` where they tear, the strip by `gimp`, the disk by `gimp` and `linear`, and by
//! neither of these where they hold, the disk by `spline`.

use std::path::Path;
use stickslip::run::{self, RunOptions};
use stickslip::scene::{self, Scene};

/// The paper's scenes, and what makes them coarse.
const PAPER: [(&str, &str, &str); 6] = [
    ("inclined_plane_slip.toml", "cells_per_radius", "4"),
    ("inclined_plane_no_slip.toml", "cells_per_radius", "4"),
    ("backspin.toml", "cells_per_radius", "4"),
    ("disks_collinear.toml", "cells_per_diameter", "40"),
    ("disks_zigzag.toml", "cells_per_diameter", "40"),
    ("disks_glued.toml", "cells_per_diameter", "40"),
];

/// Kinds of the warnings that a run ends with; it writes tables alone.
fn kinds(mut scene: Scene) -> Vec<String> {
    scene.outputs.particles = None;
    scene.outputs.fringes = None;
    let out = tempfile::tempdir().expect("a folder");
    let options = RunOptions { threads: 1, ..RunOptions::new(out.path().join("results")) };
    let mut simulation = stickslip::step::build(&scene).expect("no problem");
    let summary = run::run(&scene, &mut *simulation, &options, &mut |_| {}).expect("the run ends");
    summary.warnings.into_iter().map(|warning| warning.kind).collect()
}

/// Whether a run tells that its body tears, and that its places have left its strain.
fn told(name: &str, text: &str) -> [bool; 2] {
    let scene = scene::parse(name, text, &[]).unwrap_or_else(|error| panic!("{error:?}\n{text}")).scene;
    let kinds = kinds(scene);
    println!("{name}: {kinds:?}");
    ["tearing", "strain"].map(|kind| kinds.iter().any(|told| told == kind))
}

#[test]
fn the_papers_scenes_are_not_doubted() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/paper");
    std::thread::scope(|scope| {
        for (name, key, cells) in PAPER {
            let path = folder.join(name);
            scope.spawn(move || {
                let coarse = [(key.to_owned(), cells.to_owned())];
                let scene = scene::load(&path, &coarse).unwrap_or_else(|error| panic!("{error}")).scene;
                let kinds = kinds(scene);
                assert!(kinds.is_empty(), "{name}: {kinds:?}");
            });
        }
    });
}

/// The sound scenes, each with what is set in it.
const SOUND: [(&str, &[(&str, &str)]); 13] = [
    ("box_below_friction.toml", &[]),
    ("box_on_slope.toml", &[]),
    ("tower.toml", &[("time.end", "1 s")]),
    ("bonded_block.toml", &[("n", "4"), ("time.end", "1 s")]),
    ("bonded_block.toml", &[("n", "4"), ("time.end", "1 s"), ("coh", "1000"), ("fx", "10")]),
    ("bonded_block.toml", &[("n", "4"), ("time.end", "1 s"), ("adh", "10000"), ("fy", "210")]),
    ("bonded_block.toml", &[("n", "4"), ("time.end", "1 s"), ("vis", "1000")]),
    ("gripper.toml", &[("time.end", "300 ms")]),
    ("split_bars.toml", &[]),
    ("blocks_at_rest.toml", &[]),
    ("blocks_on_slope.toml", &[]),
    ("block_on_face.toml", &[]),
    ("struck_block.toml", &[]),
];

#[test]
fn sound_scenes_are_not_doubted() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/sound");
    for (name, set) in SOUND {
        let set: Vec<_> = set.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
        let scene = scene::load(&folder.join(name), &set).unwrap_or_else(|error| panic!("{error}")).scene;
        let doubts = kinds(scene);
        assert!(doubts.is_empty(), "{name} {set:?}: {doubts:?}");
    }
}

#[test]
fn a_body_that_meets_itself_on_the_grid_is_told() {
    let text = r#"
        space = { dimension = "plane-strain", interior = "grid", cell = "1.25 mm" }
        time.end = "50 ms"
        damping.viscous = 200
        materials.rubber = { density = 1100, neo_hookean = { young_modulus = "1 MPa", poisson_ratio = 0.4 } }
        [[bodies]]
        name = "jaw"
        material = "rubber"
        shape.union = [
            { box = { min = [0, 0], max = ["20 mm", "10 mm"] } },
            { box = { min = [0, "15 mm"], max = ["20 mm", "25 mm"] } },
        ]
        [[supports]]
        body = "jaw"
        on = "y_min"
        within.box = { min = ["-1 mm", "-1 mm"], max = ["21 mm", "1 mm"] }
        [[supports]]
        body = "jaw"
        on = "y_max"
        within.box = { min = ["-1 mm", "24 mm"], max = ["21 mm", "26 mm"] }
        displacement = [0, "-6 mm * t / 50 ms"]
        "#;
    let scene =
        |text: &str| scene::parse("jaw.toml", text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
    assert_eq!(kinds(scene(text)), ["self-contact"]);
    // On a grid of its own its parts meet as bodies do.
    assert_eq!(kinds(scene(&text.replace("\"grid\"", "\"reference\""))), [""; 0]);
}

#[test]
fn a_strip_that_is_pulled_until_the_grid_tears_it_is_told() {
    let text = r#"
        space = { dimension = "plane-stress", interior = "grid", cell = 0.1 }
        time.end = 160
        damping.viscous = 0.3
        [materials.rubber]
        density = 1
        neo_hookean = { young_modulus = 1, poisson_ratio = 0.3 }
        [[bodies]]
        name = "strip"
        material = "rubber"
        shape.box = { min = [0, 0], max = [2, 0.4] }
        [[supports]]
        body = "strip"
        on = "x_min"
        displacement = [0, "free"]
        [[supports]]
        body = "strip"
        on = "x_max"
        displacement = ["3 * t / 400", "free"]
        "#;
    assert_eq!(told("gimp", text), [true, true]);
}

#[test]
fn a_disk_that_is_thrown_hard_is_told_where_it_tears() {
    let thrown = |basis: &str| {
        let text = format!(
            r#"
            space = {{ dimension = "plane-strain", interior = "grid", cell = 0.2, basis = "{basis}" }}
            time.end = 12
            [materials.rubber]
            density = 1
            neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }}
            [[bodies]]
            name = "disk"
            material = "rubber"
            shape.ball = {{ center = [0.03, 1.05], radius = 1 }}
            velocity = [0, -0.7]
            [[bodies]]
            name = "floor"
            material = "rubber"
            shape.half_space = {{ point = [0, 0], normal = [0, 1] }}
            rigid = {{}}
            [[contact]]
            friction = 0.3
            "#
        );
        told(basis, &text)
    };
    for basis in ["gimp", "linear"] {
        assert_eq!(thrown(basis), [true, true], "{basis}");
    }
    assert_eq!(thrown("spline"), [false, false]);
}
