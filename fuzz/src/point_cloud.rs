//! Particles: CSV files that a scene names, in the plane and in space.

use crate::image::read_beside;
use std::fmt::Write as _;

const REST: &str = "time.end = 1\n[materials.m]\ndensity = 2\n\
    neo_hookean = { young_modulus = 1, poisson_ratio = 0.3 }\n[[point_clouds]]\nname = \"g\"\nmaterial = \"m\"\n\
    file = \"1.csv\"\n";

/// Reads a CSV file of particles.
pub fn run(bytes: &[u8]) {
    for dimension in ["plane-strain", "3d"] {
        let text = format!("space = {{ dimension = \"{dimension}\", cell = 2 }}\n{REST}");
        let _ = read_beside(&text, &[("1.csv", bytes)]);
    }
}

/// Two squares and a cube.
pub fn seeds() -> Vec<Vec<u8>> {
    let mut squares = "body,x,y,volume,vx,vy\n".to_string();
    for n in 0..32 {
        let (body, x, y) = (n / 16, n / 4, n % 4);
        writeln!(squares, "{body},{x}.5,{y}.5,1,0,-1").expect("a string takes all text");
    }
    let mut cube = "x, y, z, mass\n".to_string();
    for n in 0..27 {
        writeln!(cube, "{}, {}, {}, 2", n / 9, n / 3 % 3, n % 3).expect("a string takes all text");
    }
    vec![squares.into_bytes(), cube.into_bytes()]
}
