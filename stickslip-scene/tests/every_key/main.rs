//! Every key of every table of scene files changes something or is told of.
//!
//! The keys come from the schema, so a new one fails here until a case shows what it does. A case is a scene, what else
//! is set in it, a key and a value for it: with the value the scene must be another one, or the reader must refuse or
//! tell. That keys act in a run, too, is shown beside the laws and outputs that they are for; `dead` has those that do
//! nothing in some scenes, and how that is told.

mod bodies;
mod dead;
mod laws;
mod loads;
mod outputs;
mod schema_path;
mod shapes;
mod whole;

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use stickslip_scene::scene::{self, Loaded, SceneError};

/// Keys that are set to values in one scene.
struct Cases {
    scene: &'static str,
    /// What is set in both scenes that are compared: a key and its value each.
    with: &'static [(&'static str, &'static str)],
    keys: &'static [(&'static str, &'static str)],
}

/// Two bodies that deform, one that is free and one that moves as prescribed.
const PLANE: &str = r#"
[parameters]
r = "1 cm"
[shapes]
tip.ball = { center = [0, 0], radius = "r" }
[space]
dimension = "plane-strain"
cell = "1 cm"
domain = { min = [-1, -1], max = [1, 1] }
[time]
end = 1
[materials.m]
density = 1000
neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 }
[[bodies]]
name = "a"
material = "m"
shape.box = { min = [0, 0], max = [0.1, 0.1] }
[[bodies]]
name = "b"
material = "m"
shape.box = { min = [0, 0.2], max = [0.1, 0.3] }
[[bodies]]
name = "c"
material = "m"
shape.ball = { center = [0.5, 0], radius = 0.1 }
rigid.free = {}
[[bodies]]
name = "d"
material = "m"
shape.ball = { center = [-0.5, 0], radius = 0.1 }
rigid = {}
"#;

/// One body in space.
const SPACE: &str = r#"
[space]
dimension = "3d"
cell = "1 cm"
domain = { min = [-1, -1, -1], max = [1, 1, 1] }
[time]
end = 1
[materials.m]
density = 1000
neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 }
[[bodies]]
name = "a"
material = "m"
shape.box = { min = [0, 0, 0], max = [0.1, 0.1, 0.1] }
[[bodies]]
name = "c"
material = "m"
shape.ball = { center = [0.5, 0, 0], radius = 0.1 }
rigid.free = {}
"#;

fn read(scene: &str, set: &[(&str, &str)]) -> Result<Loaded, SceneError> {
    let files = BTreeMap::from([
        (PathBuf::from("push.csv"), b"t,F,G\n0,0,0\n1,2,3\n".to_vec()),
        (PathBuf::from("two.csv"), b"t,F\n0,0\n1,2\n".to_vec()),
        (PathBuf::from("three.csv"), b"t,F\n0,0\n1,3\n".to_vec()),
        (PathBuf::from("labels.png"), labels(7)),
        (PathBuf::from("others.png"), labels(9)),
        (PathBuf::from("grains.csv"), cloud(1.0)),
        (PathBuf::from("stones.csv"), cloud(1.5)),
        (PathBuf::from("part.obj"), TETRAHEDRON.as_bytes().to_vec()),
        (PathBuf::from("other.obj"), TETRAHEDRON.replace("v 0 0 1", "v 0 0 2").into_bytes()),
    ]);
    // What has no dot would be a parameter.
    let (whole, parts): (Vec<_>, Vec<_>) = set.iter().partition(|(key, _)| !key.contains(['.', '[']));
    let mut text: toml::Table = scene.parse().expect("the scene is TOML");
    for (key, value) in whole {
        let read = format!("value = {value}").parse::<toml::Table>().ok();
        let value = read.and_then(|mut table| table.remove("value"));
        text.insert(key.to_string(), value.unwrap_or_else(|| toml::Value::String(value_of(set, key))));
    }
    let set: Vec<(String, String)> =
        parts.into_iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    scene::parse_beside("a.toml", &text.to_string(), &set, &files)
}

/// The word that a key is set to.
fn value_of(set: &[(&str, &str)], key: &str) -> String {
    set.iter().find(|(other, _)| *other == key).map_or(String::new(), |(_, value)| value.to_string())
}

const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

/// Four by four pixels with the labels 3 and another.
fn labels(other: u8) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 4, 4);
    encoder.set_color(png::ColorType::Grayscale);
    let pixels = [0, 0, 0, 0, 0, 3, 3, 0, 0, 3, 3, 0, 0, 0, 0, other];
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&pixels)).expect("written");
    bytes
}

/// A square of 8 by 8 particles.
fn cloud(shift: f64) -> Vec<u8> {
    let row = |n: i32| format!("{},{},1\n", f64::from(n % 8) + shift, f64::from(n / 8) + 0.5);
    format!("x,y,volume\n{}", (0..64).map(row).collect::<String>()).into_bytes()
}

/// What is wrong with a case, if something is: the key must make another scene, or one where there was none.
fn fault(cases: &Cases, (key, value): (&str, &str)) -> Option<String> {
    let set: Vec<_> = cases.with.iter().copied().chain([(key, value)]).collect();
    match (read(cases.scene, cases.with), read(cases.scene, &set)) {
        (_, Err(error)) => Some(format!("{key} = {value}: {error}")),
        (Ok(before), Ok(after)) if after.scene == before.scene => {
            Some(format!("{key} = {value} changes nothing"))
        }
        _ => None,
    }
}

#[test]
fn every_key_of_the_schema_changes_the_scene() {
    let schema = scene::schema();
    let mut left: BTreeSet<String> = schema_path::keys(&schema);
    let mut faults = Vec::new();
    let all = [whole::CASES, bodies::CASES, laws::CASES, loads::CASES, outputs::CASES, shapes::CASES];
    for cases in all.into_iter().flatten() {
        for &(key, value) in cases.keys {
            let found = schema_path::pointers(&schema, key);
            faults.extend(found.is_empty().then(|| format!("{key} is not in the schema")));
            left.retain(|pointer| !found.contains(pointer));
            faults.extend(fault(cases, (key, value)));
        }
    }
    faults.extend(left.into_iter().map(|pointer| format!("no case for {pointer}")));
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}
