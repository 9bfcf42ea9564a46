//! Where a message points: problems found later, the source, missing files.

use crate::{MINIMAL, ROLLING, WEDGE, edited};
use miette::Diagnostic;
use stickslip_scene::scene::{self, Problem, SceneError};

#[test]
fn problems_found_later_are_shown_at_their_key() {
    let loaded = scene::parse("a.toml", ROLLING, &[]).unwrap();
    for (key, place) in [
        ("bodies[1].shape.box.max", "51:42"),
        ("bodies[0].shape.ball.radius", "44:52"),
        ("bodies[0].shape", "44:1"),
        ("bodies[1]", "48:1"),
        ("bodies[1].nothing.of.the.kind", "48:1"),
        ("time.unknown", "26:2"),
        ("", "1:1"),
    ] {
        let problem = Problem {
            key: key.to_string(),
            found: "this".into(),
            allowed: "that".into(),
            help: Some("so".into()),
        };
        let error = loaded.source.locate(problem).to_string();
        let key = if key.is_empty() { String::new() } else { format!("{key}: ") };
        assert_eq!(error, format!("a.toml:{place}: {key}found this; allowed: that; so"));
    }
}

#[test]
fn the_source_is_shown() {
    let error = scene::parse("a.toml", &edited(MINIMAL, "0.1 m", "0.1 s"), &[]).unwrap_err();
    let mut shown = String::new();
    let handler = miette::GraphicalReportHandler::new_themed(miette::GraphicalTheme::unicode_nocolor());
    handler.render_report(&mut shown, &error).unwrap();
    assert!(shown.contains("[a.toml:3:8]") && shown.contains("cell = \"0.1 s\""), "{shown}");
    let SceneError::Mistake(mistake) = &error else { panic!("{error}") };
    assert_eq!((mistake.line, mistake.column, mistake.problem.key.as_str()), (3, 8, "space.cell"));
}

#[test]
fn missing_files_suggest_their_neighbours() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scenes");
    let error = scene::load(&std::path::Path::new(folder).join("minimul.toml"), &[]).unwrap_err();
    assert!(error.to_string().contains("minimul.toml"), "{error}");
    assert_eq!(error.help().unwrap().to_string(), "did you mean `minimal.toml`?");
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(400))]

    /// Whatever is damaged in a file, the answer is a scene or a mistake in a place of that file.
    #[test]
    fn damaged_files_are_read_or_refused(
        (text, from, length) in (proptest::sample::select(vec![MINIMAL, ROLLING, WEDGE]), 0..2000_usize, 0..12_usize),
        instead in "[\"\\[\\]{}=.,#\n a-z0-9\u{b5}-]{0,6}",
    ) {
        let from = from % text.len();
        let to = (from + length).min(text.len());
        let damaged = format!("{}{instead}{}", &text[..from], &text[to..]);
        if let Err(SceneError::Mistake(mistake)) = scene::parse("a.toml", &damaged, &[]) {
            proptest::prop_assert!(mistake.line <= damaged.lines().count() + 1, "{}", mistake);
            proptest::prop_assert!(!mistake.problem.found.is_empty() && !mistake.problem.allowed.is_empty());
        }
    }
}
