//! Tables of times and values: CSV files that a load names.

use crate::image::read_beside;
use stickslip::scene::Action;

const SCENE: &str = "space = { dimension = \"plane-strain\", cell = 0.5 }\ntime.end = 1\n[materials.m]\ndensity = 1\n\
    neo_hookean = { young_modulus = 1, poisson_ratio = 0.3 }\n[[bodies]]\nname = \"a\"\nmaterial = \"m\"\n\
    shape.ball = { center = [0, 0], radius = 2 }\n[[loads]]\nname = \"l\"\nbody = \"a\"\n\
    force = [0, { csv = \"t.csv\" }]\n";

/// Reads a table and its values.
pub fn run(bytes: &[u8]) {
    let Some(loaded) = read_beside(SCENE, &[("t.csv", bytes)]) else { return };
    if let Action::Force(force) = &loaded.scene.loads[0].action {
        for time in [-1.0, 0.0, 0.5, 1e300] {
            std::hint::black_box(force[1].at(time));
        }
    }
}

/// Tables with and without a header.
pub fn seeds() -> Vec<Vec<u8>> {
    [
        "time,value\n0,1\n0.5,2\n",
        "time [ms],F (kN)\n0,1\n1,2\n",
        "0, 1e3\r\n1e-3,\"5\"\n",
        "\u{feff}t;v\n1,2\n",
    ]
    .map(|text| text.as_bytes().to_vec())
    .into()
}
