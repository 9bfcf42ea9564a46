//! Runs of tests, and whether two of a scene are one: every file but the times in the record and the checkpoints, byte
//! by byte.

#![allow(dead_code, unused_macros)] // each test uses some of it

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use stickslip::observe::{Manifest, OutputError, RunWarning};
use stickslip::run::{Checkpointing, RunOptions};
use stickslip::scene::{Scene, parse};

/// The tables of every kind of measurement, for a scene with bodies `low` and `high`.
macro_rules! every_measurement {
    () => {
        r#"[outputs.fringes]
interval = 0.03
exposure = 0.02
samples = 5
stress_parameter = 4e3
width = 90
overlay = "force-chains"
bodies = ["low", "high"]
[[outputs.groups]]
name = "low and high"
bodies = ["low", "high"]
[[outputs.groups]]
name = "others"
bodies = ["*"]
[[outputs.sections]]
name = "waist"
point = [0, 0.5]
normal = [0, 1]
[[outputs.probes]]
name = "heart"
at = [0.2, 1.5]
fixed_in = "material"
[[outputs.probes]]
name = "place"
at = [0.1, 0.4]
fixed_in = "space"
[[outputs.arrivals]]
quantity = "speed"
threshold = 0.2
bodies = ["low", "high"]
[[outputs.arrivals]]
quantity = "von_mises"
threshold = 3e3
reading = "any"
bodies = ["low"]
[[outputs.fronts]]
name = "wave"
quantity = "von_mises"
threshold = 1e3
from = [0, 1]
direction = [0, -1]
bodies = ["low"]
"#
    };
}

/// A disk that remembers and one that flows, which fall on each other and on a rigid floor beside a driven paddle.
macro_rules! two_disks {
    () => {
        r#"[materials.slow]
density = 1000
viscoelastic = { bulk_modulus = 2e5, shear_modulus = 5e4, prony = [[0.4, 0.05]] }
[materials.clay]
density = 1000
von_mises = { young_modulus = 2e5, poisson_ratio = 0.3, yield_stress = 2e3 }
[[bodies]]
name = "low"
material = "slow"
shape.ball = { center = [0, 0.5], radius = 0.5 }
[[bodies]]
name = "high"
material = "clay"
shape.ball = { center = [0.2, 1.52], radius = 0.5 }
velocity = [0, -2]
spin = 3
[[bodies]]
name = "floor"
material = "slow"
shape.half_space = { point = [0, -0.01], normal = [0, 1] }
rigid = {}
[[bodies]]
name = "paddle"
material = "slow"
shape.box = { min = [-0.9, 0.3], max = [-0.6, 0.6] }
rigid = { velocity = ["0.6 * sin(20 * t)", 0], spin = "2 * t" }
"#
    };
}

/// The scene of a text.
pub fn scene(text: &str) -> Scene {
    scene_in(Path::new(""), text)
}

/// The scene of a text that lies in a folder, beside the files that it names.
pub fn scene_in(folder: &Path, text: &str) -> Scene {
    let name = folder.join("scene.toml").display().to_string();
    parse(&name, text, &[]).unwrap_or_else(|error| panic!("{error}")).scene
}

/// The box from the origin to (x, 1, 1) as a mesh.
pub fn box_of_triangles(x: f64) -> String {
    let corner = |i: usize| {
        let [far, right, up] = [0, 1, 2].map(|axis| i >> axis & 1);
        format!("v {} {right} {up}\n", if far == 1 { x } else { 0.0 })
    };
    let faces = [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]];
    let face = |[a, b, c, d]: [usize; 4]| format!("f {a} {b} {c}\nf {a} {c} {d}\n");
    (0..8).map(corner).chain(faces.map(face)).collect()
}

/// A run on one thread, with a checkpoint at its end.
pub fn options(out: &Path) -> RunOptions {
    let checkpoints = Checkpointing { at_end: true, ..Checkpointing::default() };
    RunOptions { threads: 1, checkpoints, ..RunOptions::new(out) }
}

/// Asks the run to stop after so many steps.
pub struct StopAfter(pub u64, pub RunOptions);

impl stickslip::observe::Observer for StopAfter {
    fn next(&self) -> f64 {
        0.0
    }

    fn observe(&mut self, view: &dyn stickslip::door::View) -> Result<(), OutputError> {
        if view.steps() >= self.0 {
            self.1.stop.store(true, Ordering::Relaxed);
        }
        Ok(())
    }
}

/// Every file of a run but its record and its checkpoints, by name.
pub fn files(out: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    let mut folders = vec![out.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
            let (path, name) = (entry.path(), entry.file_name().into_string().unwrap());
            match path.is_dir() {
                true if name != "checkpoints" => folders.push(path),
                false if name != Manifest::FILE => {
                    found.push((path.strip_prefix(out).unwrap().to_path_buf(), fs::read(&path).unwrap()));
                }
                _ => {}
            }
        }
    }
    found.sort();
    found
}

/// Two runs of a scene ended in the same bits.
pub fn assert_same_run(expected: &Path, found: &Path) {
    let (expected_files, found_files) = (files(expected), files(found));
    let names = |files: &[(PathBuf, Vec<u8>)]| files.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&expected_files), names(&found_files));
    for ((name, expected), (_, found)) in expected_files.iter().zip(&found_files) {
        assert!(expected == found, "{} differs", name.display());
    }
    let [expected, found] = [expected, found].map(|out| Manifest::read(out).unwrap());
    assert!(expected.state_sum.is_some());
    assert_eq!(expected.state_sum, found.state_sum);
    // A damaged checkpoint is none of the run's doings.
    let of_the_run = |warning: &RunWarning| warning.kind != "checkpoint";
    let found_warnings: Vec<_> = found.warnings.into_iter().filter(of_the_run).collect();
    assert_eq!((expected.warnings, expected.status), (found_warnings, found.status));
    assert_eq!(expected.remarks, found.remarks);
    assert_eq!(expected.looks, found.looks);
    assert_eq!(expected.performance.steps, found.performance.steps);
    assert_eq!(expected.relaxation, found.relaxation);
}
