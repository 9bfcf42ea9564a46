//! A disk from an image rolls as the exact disk does.
//!
//! Source: identity; x = g sin(a) t^2 / 3 of a rigid disk that rolls. Set-up: a disk of rubber of 40 pixels in diameter,
//! eight cells to its radius, is set on a half-space and rolls down a slope of 0.2 rad for three quarters of a turn: the
//! exact disk on its lattice, one from the greys of an image, which are what the disk covers of each pixel, and one from
//! labels, all or nothing, each at two places between the pixels.
//!
//! Expected: the way within 1 % of that of the exact disk at all times by greys, whose surface is off by 0.1 pixels,
//! 0.5 % of the radius. Labels leave it open by 0.4 pixels, 2 % of the radius, and so is their way: 2 %.

use crate::trial::{RUBBER, run_to, start_in};
use std::fs::File;
use std::path::Path;
use stickslip::door::Simulation;

/// Pixels along a side of the image, and in the disk's radius.
const SIDE: usize = 50;
const RADIUS: f64 = 20.0;

/// Writes the image of a disk with its middle here [pixels from the upper left corner].
fn write(path: &Path, [x, y]: [f64; 2], grey: bool) {
    let pixel = |number: usize| {
        let place = [number % SIDE, number / SIDE].map(|at| at as f64 + 0.5);
        let outside = (place[0] - x).hypot(place[1] - y) - RADIUS;
        let covered = if grey { (0.5 - outside).clamp(0.0, 1.0) } else { f64::from(outside < 0.0) };
        (200.0 * covered).round() as u8
    };
    let pixels: Vec<u8> = (0..SIDE * SIDE).map(pixel).collect();
    let mut encoder = png::Encoder::new(File::create(path).expect("a file"), SIDE as u32, SIDE as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&pixels)).expect("written");
}

/// The ways of a disk of radius 1 m down the slope, at equal times.
fn ways(simulation: &mut dyn Simulation) -> Vec<f64> {
    // The slope comes first.
    let body = |simulation: &dyn Simulation| simulation.bodies()[1].position;
    let first = body(simulation);
    (1..=12)
        .map(|i| {
            run_to(simulation, 0.25 * f64::from(i), |_| {});
            body(simulation)[0] - first[0]
        })
        .collect()
}

#[test]
fn a_disk_of_forty_pixels_rolls_as_the_exact_disk() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = |disk: &str| {
        let text = format!(
            r#"
            gravity = ["8 * sin(0.2)", "-8 * cos(0.2)"]
            space = {{ dimension = "plane-strain", interior = "grid", cell = 0.125 }}
            time.end = 3
            {RUBBER}
            [[bodies]]
            name = "slope"
            material = "rubber"
            shape.half_space = {{ point = [0, 0], normal = [0, 1] }}
            rigid = {{}}
            {disk}
            [[contact]]
            friction = 0.5
            "#
        );
        ways(&mut *start_in(folder.path(), &text))
    };
    let exact = scene(
        "[[bodies]]\nname = \"disk\"\nmaterial = \"rubber\"\nshape.ball = { center = [0, 1], radius = 1 }",
    );
    let rigid = 8.0 * 0.2f64.sin() * 9.0 / 3.0;
    println!("exact disk: {:.4} of the way of a rigid one", exact[11] / rigid);
    for (grey, keys, allowed) in [(true, "threshold = 100", 0.01), (false, "labels = [200]", 0.02)] {
        for [x, y] in [[25.0, 25.0], [25.21, 24.63]] {
            write(&folder.path().join("disk.png"), [x, y], grey);
            // The middle of the disk one radius above the slope.
            let origin = [-0.05 * x, 1.0 - 0.05 * (SIDE as f64 - y)];
            let found = scene(&format!(
                "[[images]]\nname = \"disk\"\nfile = \"disk.png\"\nmaterial = \"rubber\"\npixel = 0.05\n\
                 origin = {origin:?}\n{keys}"
            ));
            let off: Vec<f64> = found.iter().zip(&exact).map(|(found, exact)| found / exact - 1.0).collect();
            println!("{keys}, middle at {x}, {y}: off by {off:.4?} of the way");
            let most = off.iter().fold(0.0_f64, |most, off| most.max(off.abs()));
            assert!(most < allowed, "{keys}, middle at {x}, {y}: {most}");
        }
    }
}
