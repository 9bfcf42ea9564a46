//! Every mistake in a scene file is shown with its place, its key, what was found, what is allowed and what to try.
//!
//! Each case is a right scene with one edit, and the whole message that it must give; `LAWS` in it stands for the names
//! of all materials' laws.

mod bodies;
mod health;
mod images;
mod joints;
mod keys;
mod loads;
mod many;
mod meshes;
mod outputs;
mod outside;
mod parameters;
mod periodic;
mod places;
mod point_clouds;
mod shapes;
mod values;

use stickslip_scene::material::LAWS;
use stickslip_scene::scene;

const MINIMAL: &str = include_str!("../scenes/minimal.toml");
const ROLLING: &str = include_str!("../scenes/rolling.toml");
const WEDGE: &str = include_str!("../scenes/wedge.toml");

fn message(text: &str) -> String {
    message_with(text, &[])
}

fn message_with(text: &str, overrides: &[(&str, &str)]) -> String {
    let overrides: Vec<_> =
        overrides.iter().map(|(name, value)| (name.to_string(), value.to_string())).collect();
    match scene::parse("a.toml", text, &overrides) {
        Ok(loaded) => panic!("no error in {:#?}", loaded.scene),
        Err(error) => error.to_string(),
    }
}

/// The scene with `from` replaced by `to`, once.
fn edited(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from} is not in the scene");
    text.replacen(from, to, 1)
}

fn check(text: &str, cases: &[(&str, &str, &str)]) {
    let laws = LAWS.iter().map(|law| law.name).collect::<Vec<_>>().join(", ");
    let wrong: Vec<String> = cases
        .iter()
        .filter_map(|(from, to, expected)| {
            let found = message(&edited(text, from, to));
            let expected = format!("a.toml:{}", expected.replace("LAWS", &laws));
            (found != expected).then(|| format!("`{from}` -> `{to}`\n  gives {found}\n  not   {expected}\n"))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_examples_are_right() {
    for text in [MINIMAL, ROLLING, WEDGE] {
        scene::parse("a.toml", text, &[]).unwrap_or_else(|error| panic!("{error}"));
    }
}
