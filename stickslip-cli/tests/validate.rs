//! `stickslip validate`: a page, the scenes that were run, and errors for names that are none.

mod stickslip;

use std::fs;
use stickslip::Workplace;

#[test]
fn a_page_says_what_each_law_reaches_and_the_scenes_can_be_run() {
    let workplace = Workplace::new();
    let said =
        workplace.succeed(&["validate", "m4", "--law", "surface", "--law", "traction", "--out", "seen"]);
    assert!(said.contains("M4 First contact") && said.contains("seen/index.html"), "{said}");
    let html = fs::read_to_string(workplace.path("seen/index.html")).unwrap();
    for part in [
        "<title>Contact laws and schemes against known answers</title>",
        "<section id=\"m4-first-contact\">",
        "surface *",
        "traction",
        "<a class=\"passed\" href=\"#m4-first-contact\">8 of 8</a>",
        "<a class=\"failed\" href=\"#m4-first-contact\">0 of 8</a>",
        "0 ± 0.05",
    ] {
        assert!(html.contains(part), "{part} is missing in {html}");
    }
    let scene = "seen/scenes/M4/surface/8/fitted_2_per_side_meeting_0.25.toml";
    workplace.succeed(&["check", scene]);
}

#[test]
fn a_benchmark_of_the_step_runs_by_the_schemes_that_are_named() {
    let workplace = Workplace::new();
    let schemes = ["--scheme", "linear-first-flip", "--scheme", "gimp-last-rflip"];
    let said = workplace.succeed(&[&["validate", "wall", "--out", "seen"][..], &schemes].concat());
    assert!(said.contains("gimp-last-rflip ") && said.contains("linear-first-flip "), "{said}");
    let html = fs::read_to_string(workplace.path("seen/index.html")).unwrap();
    assert!(html.contains("Scheme by benchmark") && !html.contains("Law by benchmark"), "{html}");
    let scene =
        fs::read_to_string(workplace.path("seen/scenes/wall/linear-first-flip/12/gap_aligned.toml")).unwrap();
    for key in ["basis = \"linear\"", "stress_update = \"first\"", "transfer = \"flip\""] {
        assert!(scene.contains(key), "{key} is missing in {scene}");
    }
}

#[test]
fn names_that_are_none_are_answered_with_those_that_are() {
    let workplace = Workplace::new();
    for (arguments, names) in [
        (["validate", "B99"], "B5"),
        (["validate", "--law=soft"], "traction"),
        (["validate", "--scheme=soft"], "gimp-modified-last-rflip"),
    ] {
        let ran = workplace.run(&arguments);
        assert_eq!(ran.code, Some(2), "{}", ran.stderr);
        assert!(ran.stderr.contains(names), "{}", ran.stderr);
    }
    workplace.write("file", "");
    let ran = workplace.run(&["validate", "M4", "--out", "file"]);
    assert_eq!(ran.code, Some(2), "{}", ran.stderr);
    assert!(ran.stderr.contains("cannot write to file"), "{}", ran.stderr);
}
