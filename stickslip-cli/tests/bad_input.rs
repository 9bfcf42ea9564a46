//! Input at fault: exit code 2, a message that says what and where, and nothing left behind.

mod stickslip;

use std::fs;
use stickslip::{Workplace, new_scene, outcome};

#[test]
fn an_unknown_flag_is_refused() {
    let ran = Workplace::new().run(&["run", "scene.toml", "--thread", "2"]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.stderr.contains("--threads"), "{}", ran.stderr);
}

/// The variable that limits the instructions, and the bits that they give.
#[test]
fn instructions_are_limited_by_name_and_give_the_same_bits() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let run = |limit: Option<&str>, out: &str| {
        let coarse = ["--set", "cells_per_radius=3", "--set", "time.end=0.02"];
        let run = [&["run", "scene.toml", "--out", out, "--threads", "1"][..], &coarse].concat();
        workplace.command(&run).envs(limit.map(|limit| ("STICKSLIP_INSTRUCTIONS", limit))).output().unwrap()
    };
    let refused = run(Some("sse"), "refused");
    let told = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(2), "{told}");
    assert!(
        told.contains("STICKSLIP_INSTRUCTIONS") && told.contains("found sse, allowed: avx2, base"),
        "{told}"
    );
    assert!(!workplace.path("refused").exists());
    for (limit, out) in [(Some("base"), "base"), (Some("avx2"), "limited"), (None, "best")] {
        assert!(run(limit, out).status.success(), "{limit:?}");
    }
    assert!(outcome(&workplace.path("limited")) == outcome(&workplace.path("best")));
}

#[test]
fn a_missing_scene_is_refused_by_name() {
    let workplace = Workplace::new();
    for command in ["run", "check"] {
        let ran = workplace.run(&[command, "nowhere.toml"]);
        assert_eq!(ran.code, Some(2));
        assert!(ran.stderr.contains("nowhere.toml"), "{}", ran.stderr);
    }
    assert!(!workplace.path("nowhere.results").exists());
}

#[test]
fn a_misspelt_key_is_named_with_its_place_and_no_folder_is_left() {
    let workplace = Workplace::new();
    let scene = new_scene().replace("end = ", "endd = ");
    workplace.write("scene.toml", &scene);
    let ran = workplace.run(&["run", "scene.toml"]);
    assert_eq!(ran.code, Some(2), "{}", ran.stderr);
    let line = 1 + scene.lines().position(|line| line.starts_with("endd")).unwrap();
    assert!(ran.stderr.contains(&format!("scene.toml:{line}:1")), "{}", ran.stderr);
    assert!(ran.stderr.contains("`end`"), "{}", ran.stderr);
    assert!(!workplace.path("scene.results").exists());
}

#[test]
fn a_wrong_unit_is_refused() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene().replace("\"0.5 s\"", "\"0.5 m\""));
    let ran = workplace.run(&["check", "scene.toml"]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.stderr.contains("scene.toml:"), "{}", ran.stderr);
}

#[test]
fn a_wall_between_nodes_is_shown_where_the_domain_stands() {
    let workplace = Workplace::new();
    let scene = new_scene().replace("\"4 * radius\"], y_min", "\"4.05 * radius\"], y_max");
    workplace.write("scene.toml", &scene);
    let ran = workplace.run(&["run", "scene.toml"]);
    let line = 1 + scene.lines().position(|line| line.starts_with("domain")).unwrap();
    assert_eq!(ran.code, Some(2));
    assert!(ran.stderr.contains(&format!("scene.toml:{line}:")), "{}", ran.stderr);
    assert!(ran.stderr.contains("40.4 cells") && ran.stderr.contains("wall at 0.4 m"), "{}", ran.stderr);
}

#[test]
fn a_particle_that_leaves_stops_the_run_and_everything_can_be_read() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let thrown = "bodies[0].velocity=[\"1 m/s\", \"100 m/s\"]";
    let ran = workplace.run(&["run", "scene.toml", "--set", thrown, "--set", "cells_per_radius=4"]);
    assert_eq!(ran.code, Some(1), "{}", ran.stderr);
    assert!(ran.stderr.contains("of body `disk` left the domain at ("), "{}", ran.stderr);
    assert!(ran.stderr.contains("make the domain larger"), "{}", ran.stderr);
    workplace.succeed(&["render", "scene.results", "--out", "last.png"]);
    let jpeg = workplace.run(&["render", "scene.results", "--out", "last.jpg"]);
    assert_eq!(jpeg.code, Some(2));
    assert!(jpeg.stderr.contains(".png"), "{}", jpeg.stderr);
}

#[test]
fn an_unknown_parameter_is_refused() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let ran = workplace.run(&["check", "scene.toml", "--set", "fricton=0"]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.stderr.contains("friction"), "{}", ran.stderr);
}

#[test]
fn a_folder_with_other_files_is_left_alone() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    fs::create_dir(workplace.path("mine")).unwrap();
    workplace.write("mine/thesis.txt", "years of work");
    let ran = workplace.run(&["run", "scene.toml", "--out", "mine"]);
    assert_eq!(ran.code, Some(2), "{}", ran.stderr);
    assert!(ran.stderr.contains("thesis.txt"), "{}", ran.stderr);
    assert_eq!(fs::read_dir(workplace.path("mine")).unwrap().count(), 1);
}

#[test]
fn an_out_that_is_a_file_is_refused() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    workplace.write("out", "a file");
    let ran = workplace.run(&["run", "scene.toml", "--out", "out"]);
    assert_eq!(ran.code, Some(2), "{}", ran.stderr);
}

#[test]
fn a_folder_that_is_no_run_cannot_be_drawn() {
    let workplace = Workplace::new();
    for command in ["render", "plot"] {
        let ran = workplace.run(&[command, "."]);
        assert_eq!(ran.code, Some(2));
        assert!(ran.stderr.contains("run.json"), "{}", ran.stderr);
    }
}

#[test]
fn new_does_not_overwrite() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", "mine");
    let ran = workplace.run(&["new"]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.stderr.contains("scene.toml is there already"), "{}", ran.stderr);
    assert_eq!(fs::read_to_string(workplace.path("scene.toml")).unwrap(), "mine");
}

#[test]
fn a_rule_that_never_holds_is_told_of_by_check_and_before_a_run() {
    let workplace = Workplace::new();
    let scene = new_scene() + "\n[[contact]]\nbetween = [\"disk\", \"bar\"]\nfriction = 0.9\n";
    workplace.write("scene.toml", &scene);
    let line = scene.lines().count() - 2;
    let warning = format!("warning: scene.toml:{line}:1: contact[1]: never holds: contact[0]");
    let report = workplace.succeed(&["check", "scene.toml"]);
    assert!(report.contains(&warning), "{report}");
    let ran = workplace.run(&["run", "scene.toml", "--set", "time.end=1 ms", "--set", "cells_per_radius=4"]);
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    assert!(ran.stderr.contains(&warning), "{}", ran.stderr);
    let record = fs::read_to_string(workplace.path("scene.results/run.json")).unwrap();
    let record: serde_json::Value = serde_json::from_str(&record).unwrap();
    let found = &record["scene_warnings"][0];
    assert_eq!(
        (&found["key"], &found["place"]),
        (&"contact[1]".into(), &format!("scene.toml:{line}:1").into())
    );
    assert!(found["text"].as_str().unwrap().starts_with("never holds: contact[0]"), "{found}");
}

/// A launcher that begins several of a program that was built without MPI: the first says so, and none begins a run
/// that the others would have begun, too.
#[test]
#[cfg(not(feature = "mpi"))]
fn processes_of_a_program_without_mpi_run_nothing() {
    let workplace = Workplace::new();
    workplace.succeed(&["new"]);
    let launched = |rank: &str, words: &[&str]| {
        let mut command = workplace.command(words);
        command.envs([("OMPI_COMM_WORLD_RANK", rank), ("OMPI_COMM_WORLD_SIZE", "4")]).output().unwrap()
    };
    let first = launched("0", &["run", "scene.toml"]);
    let told = String::from_utf8_lossy(&first.stderr);
    assert_eq!(first.status.code(), Some(2), "{told}");
    assert!(told.contains("found 4 processes") && told.contains("--features mpi"), "{told}");
    let other = launched("1", &["run", "scene.toml"]);
    assert!(other.status.code() == Some(2) && other.stderr.is_empty() && other.stdout.is_empty());
    assert!(!workplace.path("scene.results").exists());
    // Runs that have nothing to do with each other.
    let mut alone = workplace.command(&["run", "scene.toml", "--quiet", "--set", "cells_per_radius=2"]);
    alone.envs([("OMPI_COMM_WORLD_RANK", "1"), ("OMPI_COMM_WORLD_SIZE", "4"), ("STICKSLIP_ALONE", "1")]);
    assert!(alone.status().unwrap().success() && workplace.path("scene.results").exists());
    // What is no run, one of them does.
    let said = [0, 1].map(|rank| launched(&rank.to_string(), &["check", "scene.toml"]).stdout);
    assert!(!said[0].is_empty() && said[1].is_empty());
}
