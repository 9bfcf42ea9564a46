//! The report of `stickslip reproduce`, opened in a real browser.
//!
//! Needs Chromium with its driver and a Python with the package `selenium` (`STICKSLIP_PYTHON`,
//! else `python3`); `./check` installs them.

mod stickslip;

use serde_json::Value;
use std::path::Path;
use std::process::Command;
use stickslip::{Workplace, new_scene};

/// What the browser finds on a page; `None` where there is no browser and nobody requires one.
fn look_at(page: &Path) -> Option<Value> {
    let python = stickslip::python_with_browser()?;
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/look_at_page.py");
    let output = Command::new(&python).arg(script).arg(page).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

/// A page that a reader can read: figures seen, images decoded, tables filled, links that lead somewhere,
/// and no word to the network.
fn assert_readable(found: &Value) {
    for (figure, images) in found["figures"].as_object().unwrap() {
        let images = images.as_array().unwrap();
        assert!(!images.is_empty(), "{figure} is empty");
        for image in images {
            let side = |axis: usize| image["size"][axis].as_f64().unwrap();
            assert!(side(0) > 100.0 && side(1) > 40.0, "{figure}: {image}");
            assert_eq!(image["decoded"], true, "{figure}: {image}");
            assert_eq!(image["described"], true, "{figure}: {image}");
        }
    }
    let tables = found["tables"].as_array().unwrap();
    assert!(!tables.is_empty());
    for table in tables {
        assert!(table["rows"].as_u64() > Some(0) && table["numbers"].as_u64() > Some(0), "{table}");
    }
    let links = found["links"].as_object().unwrap();
    assert!(links.len() > 1 && links.values().all(|works| works == true), "{links:?}");
    for nothing in ["complaints", "requests"] {
        assert_eq!(found[nothing], Value::Array(Vec::new()), "{nothing}");
    }
    assert_eq!(found["wider_than_the_window"], false);
    assert_ne!(found["background"], found["dark_background"], "light and dark");
}

#[test]
fn every_figure_of_the_paper_is_seen_in_a_browser() {
    let workplace = Workplace::new();
    workplace.succeed(&["reproduce", "--sketch", "--out", "paper"]);
    let Some(found) = look_at(&workplace.path("paper/report.html")) else { return };
    assert_readable(&found);
    for number in 3..=11 {
        let images = found["figures"][format!("figure-{number}")].as_array();
        let expected = if number < 9 { 2 } else { 12 };
        assert_eq!(
            images.map(Vec::len),
            Some(expected),
            "figure {number}: an image a rule, or a time and rule"
        );
    }
    for number in 9..=11 {
        let images = found["figures"][format!("experiment-of-figure-{number}")].as_array().map(Vec::len);
        assert!(images >= Some(6), "the paper's frames, and the experiment's times: {images:?}");
    }
    let text = found["text"].as_str().unwrap();
    for word in [
        "The experiment",
        "traction",
        "surface",
        "2.097",
        "Poisson",
        "energy error",
        "time taken",
        "How this was made",
    ] {
        assert!(text.contains(word), "no word on {word}");
    }
    // The paper's frames of its simulation and of its experiment.
    for time in [2.2, 5.5, 7.7, 2.6, 6.6, 9.2, 3.0, 6.0, 9.0, 5.3, 10.5, 15.8, 1.4, 3.6, 5.8, 1.6, 4.2, 6.8] {
        for rule in ["traction (paper)", "surface (default)"] {
            assert!(text.contains(&format!("{rule}, t = {time:.1}")), "no fringes by {rule} at {time}");
        }
    }
    assert_eq!(found["warnings"], 0, "no run failed");
}

#[test]
fn a_browser_plays_an_animation_of_fringes() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let short =
        ["--set", "cells_per_radius=4", "--set", "time.end=0.5 s", "--set", "outputs.particles=0.1 s"];
    workplace.succeed(&[&["run", "scene.toml"][..], &short].concat());
    let fringes =
        ["--fringes", "--stress-parameter", "2000", "--animate", "--rate", "4", "--size", "300x200"];
    workplace.succeed(&[&["render", "scene.results"][..], &fringes].concat());
    let Some(found) = look_at(&workplace.path("scene.results/fringes_animation.png")) else { return };
    assert!(found["pictures"].as_u64() >= Some(4), "of six pictures, four a second: {found}");
}

#[test]
fn finished_runs_stand_and_failures_are_told() {
    let workplace = Workplace::new();
    let part = ["reproduce", "--sketch", "--only", "backspin", "--out", "paper"];
    workplace.succeed(&part);
    let wall_time = || {
        let record = std::fs::read(workplace.path("paper/runs/backspin-surface-R2/run.json")).unwrap();
        serde_json::from_slice::<Value>(&record).unwrap()["performance"]["wall_time"].clone()
    };
    let first = wall_time();
    let again = workplace.run(&part);
    assert_eq!((again.code, wall_time()), (Some(0), first), "{}", again.stderr);

    // What is no folder of results cannot be written to: that run fails, the report says so, and the other stands.
    std::fs::remove_dir_all(workplace.path("paper/runs/backspin-surface-R2")).unwrap();
    std::fs::create_dir(workplace.path("paper/runs/backspin-surface-R2")).unwrap();
    workplace.write("paper/runs/backspin-surface-R2/thesis.tex", "years of work");
    let failed = workplace.run(&part);
    assert_eq!(failed.code, Some(1), "{}", failed.stderr);
    assert!(failed.stderr.contains("backspin-surface-R2"), "{}", failed.stderr);
    let report = std::fs::read_to_string(workplace.path("paper/report.html")).unwrap();
    assert!(report.contains("class=\"warning\"") && report.contains("thesis.tex"));
}

#[test]
fn an_unknown_part_is_refused() {
    let ran = Workplace::new().run(&["reproduce", "--only", "foreword"]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.stderr.contains("backspin") && ran.stderr.contains("disks"), "{}", ran.stderr);
}
