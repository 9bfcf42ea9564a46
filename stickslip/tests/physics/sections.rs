//! Forces and moments across planes.
//!
//! Set-up: the cantilever of `scenes/loaded_beam.toml`, 8 cells high, at rest under a force at its end.
//!
//! Expected: every section bears the force, and the moment of the force about it, F (L + u - x).

use crate::trial::start;
use stickslip::run::{RunOptions, run};
use stickslip::scene::parse;

#[test]
fn a_cantilever_has_the_shear_and_the_moments_of_its_load() {
    let text = format!(
        "{}\n[outputs]\nparticles = \"never\"\n[[outputs.sections]]\nname = \"at {{i}}\"\nrepeat = {{ i = 3 }}\n\
         point = [\"0.25 * (1 + i)\", 0]\nnormal = [2, 0]\n",
        include_str!("../../../scenes/loaded_beam.toml")
    );
    let scene = parse("beam.toml", &text, &[]).expect("a scene").scene;
    let folder = tempfile::tempdir().expect("a folder");
    let mut simulation = start(&text);
    run(&scene, &mut *simulation, &RunOptions::new(folder.path().join("out")), &mut |_| {}).expect("it runs");
    let results = stickslip::observe::Results::open(&folder.path().join("out")).expect("results");
    let rows = results.sections_table().expect("a table");
    let force = 0.1 * 1e7 * 1e-3 / 12.0;
    for (i, row) in rows[rows.len() - 3..].iter().enumerate() {
        let arm = 1.0 - 0.25 * (1 + i) as f64;
        let [shear, moment] = [row.force[1] / -force, row.moment[2] / (-force * arm)];
        println!(
            "{}: shear {shear:.4}, moment {moment:.4} of the exact, area {:.5} m",
            row.section, row.area
        );
        assert!((shear - 1.0).abs() < 0.02 && (moment - 1.0).abs() < 0.03, "{row:?}");
        assert!((row.area - 0.1).abs() < 1e-3, "{row:?}");
    }
}
