//! A law is two files: its own, and the list. Outside of them and of tests, nothing in the workspace says its name,
//! nor that of what it remembers; the gallery's scenes are scenes, and their pictures name what they show.

use std::path::{Path, PathBuf};
use stickslip_scene::material::{Absent, Description, LAWS, Material};
use stickslip_scene::scene;

/// All source files of the workspace that are no tests.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder of sources").flatten() {
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
        if path.is_dir() && !name.starts_with('.') && !["target", "tests", "gallery"].contains(&&*name) {
            sources(&path, found);
        } else if name.ends_with(".rs") && name != "tests.rs" {
            found.push(path);
        }
    }
}

/// Text before the tests of a file.
fn own(path: &Path) -> String {
    let text = std::fs::read_to_string(path).expect("readable sources");
    text.split("#[cfg(test)]").next().unwrap_or_default().to_string()
}

/// Whether a word stands in a text as a whole.
fn says(text: &str, word: &str) -> bool {
    let inside = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
    text.match_indices(word).any(|(at, _)| {
        !inside(text[..at].chars().next_back()) && !inside(text[at + word.len()..].chars().next())
    })
}

#[test]
fn a_law_is_its_own_file_and_a_line_on_the_list() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace");
    let mut files = Vec::new();
    sources(root, &mut files);
    let texts: Vec<(PathBuf, String)> = files.into_iter().map(|path| (path.clone(), own(&path))).collect();
    assert!(texts.len() > 200, "{} files", texts.len());
    let where_said = |word: &str| -> Vec<String> {
        let saying = texts.iter().filter(|(_, text)| says(text, word));
        let mut names: Vec<String> =
            saying.map(|(path, _)| path.strip_prefix(root).unwrap_or(path).display().to_string()).collect();
        names.sort();
        names
    };
    let file = |name: &str| format!("stickslip-mechanics/src/material/{name}.rs");
    for (law, kind) in [("viscoelastic", "Viscoelastic"), ("damage", "Damage")] {
        let mut two = [file(law), file("mod")];
        two.sort();
        assert_eq!(where_said(kind), two, "{kind}");
        let list = std::fs::read_to_string(root.join(file("mod"))).expect("the list");
        let lines: Vec<&str> = list.lines().filter(|line| says(line, kind)).collect();
        assert_eq!(lines, [format!("    {law} {kind};")]);
    }
    // Laws may share a column where it means the same.
    let laws: Vec<String> = LAWS.iter().map(|law| file(law.name)).collect();
    for (law, remembered) in [
        ("von_mises", "plastic_strain"),
        ("viscoelastic", "viscous_strain_1"),
        ("viscoelastic", "viscous_dissipation"),
        ("johnson_cook", "temperature_rise"),
        ("johnson_cook", "ductile_damage"),
        ("armstrong_frederick", "back_stress"),
        ("damage", "damage_strain"),
        ("damage", "damage_dissipation"),
    ] {
        let said = where_said(remembered);
        assert!(said.contains(&file(law)), "{remembered}");
        assert!(said.iter().all(|name| laws.contains(name)), "{remembered}: {said:?}");
    }
}

/// A material by the constants that a law declares: two elastic ones if it takes any two, and the examples of those
/// that must be given, as a scene file would have them.
fn example(law: &Description) -> Material<f64> {
    let mut constants = Vec::new();
    for constant in law.constants {
        match (constant.absent, constant.name) {
            (Absent::Refused(example), name) => constants.push(format!("{name} = {example}")),
            (Absent::Judged, "young_modulus") => constants.push("young_modulus = 1e9".to_string()),
            (Absent::Judged, "poisson_ratio") => constants.push("poisson_ratio = 0.25".to_string()),
            _ => {}
        }
    }
    let text = format!(
        r#"
        space = {{ dimension = "plane-strain", cell = "1 mm" }}
        time.end = 1
        materials.one = {{ density = 1000, {} = {{ {} }} }}
        bodies = [{{ name = "ball", material = "one", shape.ball = {{ center = [0, 0], radius = 1 }} }}]
        "#,
        law.name,
        constants.join(", ")
    );
    let loaded = scene::parse("law.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}\n{text}"));
    loaded.scene.materials[0].law
}

#[test]
fn every_law_gives_its_constants_back_and_is_within_their_bounds() {
    for description in LAWS {
        let material = example(description);
        assert_eq!(material.name(), description.name);
        assert_eq!(material.check(), Ok(()));
        let again = description.build(&material.given()).expect("its own constants");
        assert_eq!(again, material);
        let names: Vec<&str> = material.history().iter().map(|history| history.column.name).collect();
        assert!((1..names.len()).all(|i| !names[..i].contains(&names[i])), "{names:?}");
    }
}
