//! `stickslip sweep`: every combination is run, one failure does not stop the others, mistakes cost nothing.

mod stickslip;

use std::collections::BTreeMap;
use std::fs;
use stickslip::{Workplace, new_scene};

/// The scene of `stickslip new` with a probe and a threshold, short and coarse.
fn place() -> (Workplace, Vec<&'static str>) {
    let workplace = Workplace::new();
    let measured =
        "[[outputs.arrivals]]\nquantity = \"speed\"\nthreshold = \"0.02 m/s\"\nbodies = [\"disk\"]\n";
    workplace.write("scene.toml", &format!("{}\n{measured}", new_scene()));
    let short =
        ["--set", "cells_per_radius=2", "--set", "time.end=10 ms", "--set", "outputs.particles=never"];
    (workplace, short.to_vec())
}

/// `sweep.csv`: the rows by column.
fn table(workplace: &Workplace, folder: &str) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(workplace.path(folder).join("sweep.csv")).unwrap();
    reader.deserialize().map(|row| row.unwrap()).collect()
}

#[test]
fn every_combination_is_run_and_stands_in_the_table() {
    let (workplace, short) = place();
    let values = ["--set", "friction=0,0.5", "--set", "bodies[0].velocity=[0, 0],[0, 1e-3]", "--jobs", "2"];
    let said = workplace.succeed(&[&["sweep", "scene.toml"][..], &values, &short].concat());
    assert!(said.contains("4 of 4 runs finished") && said.contains("scene.sweep"), "{said}");
    let heading = said.lines().next().expect("a table of what differs");
    assert!(heading.contains("friction  bodies[0].velocity") && !heading.contains("particles"), "{said}");
    let rows = table(&workplace, "scene.sweep");
    assert_eq!(rows.len(), 4);
    let column = |name: &str| rows.iter().map(|row| row[name].as_str()).collect::<Vec<_>>();
    assert_eq!(column("friction")[..3], ["0", "0", "0.5"], "the last parameter changes fastest");
    assert_eq!(column("status"), ["finished"; 4]);
    assert_eq!(column("time"), ["0.01"; 4]);
    for row in &rows {
        let results = workplace.path("scene.sweep").join(&row["run"]);
        for file in ["run.json", "bodies.csv", "arrivals.csv", "plot.png"] {
            assert!(results.join(file).exists(), "{}: {file}", row["run"]);
        }
        // Gravity alone: 0.02 m/s, less the push at the start, after some two milliseconds.
        let arrival: f64 = row["arrival speed disk"].parse().unwrap();
        assert!((1.5e-3..4e-3).contains(&arrival), "{row:?}");
    }
    assert!(workplace.path("scene.sweep/plot.png").exists());
    workplace.succeed(&["plot", "scene.sweep", "--out", "sweep.svg"]);
    assert!(fs::read_to_string(workplace.path("sweep.svg")).unwrap().contains("friction"));
    let chosen = ["plot", "scene.sweep", "--quantity", "kinetic_energy,energy_drift", "--out", "chosen.svg"];
    workplace.succeed(&chosen);
    let drawn = fs::read_to_string(workplace.path("chosen.svg")).unwrap();
    assert!(drawn.contains("kinetic energy at the end") && drawn.contains("energy drift, relative"));
    let refused = workplace.run(&["plot", "scene.sweep", "--quantity", "x"]);
    assert_eq!(refused.code, Some(2), "{}", refused.stderr);
    assert!(refused.stderr.contains("found `x`; allowed: time, steps"), "{}", refused.stderr);

    let alone = ["run", "scene.toml", "--set", "friction=0.5", "--set", "bodies[0].velocity=[0, 0]"];
    workplace.succeed(&[&alone[..], &short].concat());
    let same = ["scene.results", "scene.sweep/friction=0.5,bodies_0_.velocity=_0,_0_"]
        .map(|folder| fs::read(workplace.path(folder).join("bodies.csv")).unwrap());
    assert_eq!(same[0], same[1], "a run of a sweep is that run");
}

#[test]
fn a_run_that_fails_is_named_and_the_others_go_on() {
    let (workplace, short) = place();
    // Thrown out of the domain within the run.
    let values = ["--set", "bodies[0].velocity=[0, \"100 m/s\"],[0, 0]"];
    let ran = workplace.run(&[&["sweep", "scene.toml"][..], &values, &short].concat());
    assert_eq!(ran.code, Some(1), "{}", ran.stderr);
    assert!(
        ran.stderr.contains("1 of 2 runs failed") && ran.stderr.contains("left the domain"),
        "{}",
        ran.stderr
    );
    let rows = table(&workplace, "scene.sweep");
    assert_eq!([&rows[0]["status"], &rows[1]["status"]], ["failed", "finished"]);
    assert!(rows[0]["error"].contains("left the domain") && rows[1]["error"].is_empty());
}

#[test]
fn mistakes_are_refused_before_anything_is_run() {
    let (workplace, _) = place();
    let cases = [
        (&["--set", "fricton=0,1"][..], "friction"),
        (&["--set", "friction=0,-1"], "a number from 0 on"),
        (&["--set", "friction=0,,1"], "empty value"),
        (&["--set", "friction="], "name=value"),
        (&["--set", "friction=1,1"], "twice"),
        (&["--set", "friction=0.5"], "stickslip run"),
        (&["--set", "friction=0,1", "--set", "friction=2"], "`friction` twice"),
        (&[], "--set"),
    ];
    for (arguments, expected) in cases {
        let ran = workplace.run(&[&["sweep", "scene.toml"][..], arguments].concat());
        assert_eq!(ran.code, Some(2), "{arguments:?}: {}", ran.stderr);
        assert!(ran.stderr.contains(expected), "{arguments:?}: {}", ran.stderr);
        assert!(!workplace.path("scene.sweep").exists(), "{arguments:?}");
    }
}

#[test]
fn a_folder_with_other_files_is_left_alone() {
    let (workplace, short) = place();
    fs::create_dir(workplace.path("mine")).unwrap();
    workplace.write("mine/thesis.txt", "years of work");
    let arguments = ["sweep", "scene.toml", "--set", "friction=0,1", "--out", "mine"];
    let ran = workplace.run(&[&arguments[..], &short].concat());
    assert_eq!(ran.code, Some(2), "{}", ran.stderr);
    assert!(ran.stderr.contains("thesis.txt"), "{}", ran.stderr);
    assert_eq!(fs::read_dir(workplace.path("mine")).unwrap().count(), 1);
}
