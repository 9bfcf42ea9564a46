//! Formulas, units, names and whole values, as `--set` gives them: a line of the input for each place in a scene.

use crate::scene::draw;
use std::collections::BTreeMap;
use stickslip::scene::{Expression, parse_beside};

const SCENE: &str = r#"
title = "{word} {a}"
gravity = [0, "-a * 1 m/s^2"]
space = { dimension = "plane-strain", cell = 0.5 }
time.end = "1 s"
[parameters]
a = 1
b = "a * 2 mm"
word = "gap"
[materials.m]
density = "1 g/cm^3"
neo_hookean = { young_modulus = 1, poisson_ratio = 0.3 }
[[bodies]]
name = "n {i}"
repeat = { i = 2 }
material = "m"
shape.ball = { center = ["3 m * i", 0], radius = 1 }
rigid = { velocity = ["sin(t * 1 rad/s) * b / 1 s", 0] }
[[bodies]]
name = "o"
material = "m"
shape.ball = { center = [0, 4], radius = 1 }
[[loads]]
name = "l"
body = "o"
pressure = "if(x > x0, 1 kPa, 2 kPa * y / 1 m)"
"#;

/// Where the lines of an input go, in turn.
const PLACES: [&str; 6] =
    ["a", "b", "word", "loads[0].pressure", "bodies[0].rigid.velocity[1]", "bodies[0].repeat.i"];

/// Sets the values and evaluates what comes of them. A line that holds `name=value` names its place itself.
pub fn run(bytes: &[u8]) {
    let Ok(text) = str::from_utf8(bytes) else { return };
    let named = |(i, line): (usize, &str)| match line.split_once(":=") {
        Some((name, value)) => (name.to_string(), value.to_string()),
        None => (PLACES[i % PLACES.len()].to_string(), line.to_string()),
    };
    let set: Vec<_> =
        text.lines().take(8).enumerate().filter(|(_, line)| !line.is_empty()).map(named).collect();
    match parse_beside("a.toml", SCENE, &set, &BTreeMap::new()) {
        Err(error) => draw(error),
        Ok(loaded) => {
            let velocities = loaded.scene.bodies.iter().filter_map(|body| match &body.motion {
                stickslip::scene::BodyMotion::Rigid { velocity, spin } => {
                    Some(velocity.iter().chain(spin.iter()))
                }
                _ => None,
            });
            velocities.flatten().for_each(|expression: &Expression| {
                for t in [0.0, 0.3, f64::MAX] {
                    std::hint::black_box(expression.at(t));
                }
            });
        }
    }
}

/// Values of every kind.
pub fn seeds() -> Vec<Vec<u8>> {
    [
        "2\n3 m * a\nkinematic\n1 bar\n5 m/s * min(t / 1 ms, 1)\n3",
        "mod(7, 3)\n-2^2 * 1 inch\n{a}\n\ntanh(t / 1 s) * 1 cm/s\n",
        "pi / 6\n1e-3 km\nw\nif(t < 1 s, 1 Pa, 2 Pa)\n-(1 + 2) * 3 mm/s\n2",
        "bodies[1].name:=\"{a + 1} {word}\"\ntime.end:=1e3 ms\nmaterials.m.density:=1 t/m^3\nspace.cell:={ table = [[0, 1]] }",
        "exp(1) + sqrt(2) * abs(-3) - floor(2.5)\nmax(1 m, 2 m)\na\n10 N/cm^2\n1 m/s + 2 km/h\na + 1",
    ]
    .map(|text| text.as_bytes().to_vec())
    .into()
}
