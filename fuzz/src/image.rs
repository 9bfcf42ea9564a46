//! Images: PNG and TIFF files that a scene names, as labels and as greys, in the plane and as stacks.

use crate::is_one_in;
use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::PathBuf;
use stickslip::check::report;
use stickslip::scene::{Loaded, parse_beside};

const PLANE: &str = "space = { dimension = \"plane-strain\", cell = 0.5 }\n";
const SPACE: &str = "space = { dimension = \"3d\", cell = 0.5 }\n";
const REST: &str = "time.end = 1\n[materials.m]\ndensity = 1\n\
    neo_hookean = { young_modulus = 1, poisson_ratio = 0.3 }\n[[images]]\nname = \"g\"\nmaterial = \"m\"\n\
    pixel = 0.25\n";
/// One image of so many is filled: that takes a hundred times as long as reading.
const FILLED: u64 = 50;
/// Particle sites of those.
const MOST_SITES: f64 = 2e3;
/// Bodies of those.
const MOST_BODIES: usize = 30;

/// The scene of a text, beside files.
pub fn read_beside(text: &str, files: &[(&str, &[u8])]) -> Option<Loaded> {
    let files: BTreeMap<PathBuf, Vec<u8>> =
        files.iter().map(|(name, bytes)| (PathBuf::from(name), bytes.to_vec())).collect();
    match parse_beside("a.toml", text, &[], &files) {
        Ok(loaded) => Some(loaded),
        Err(error) => {
            assert!(!error.to_string().is_empty());
            None
        }
    }
}

fn read(space: &str, more: &str, files: &[(&str, &[u8])]) {
    let Some(loaded) = read_beside(&format!("{space}{REST}{more}"), files) else { return };
    let few = crate::scene::sites(&loaded.scene).0 < MOST_SITES && loaded.scene.bodies.len() < MOST_BODIES;
    if few && is_one_in(FILLED, files[0].1) {
        let _ = report(&loaded.scene);
    }
}

/// Reads a PNG file.
pub fn png(bytes: &[u8]) {
    read(PLANE, "file = \"1.png\"\n", &[("1.png", bytes)]);
    read(PLANE, "file = \"1.png\"\nthreshold = 2\n", &[("1.png", bytes)]);
    read(SPACE, "file = \"*.png\"\nbackground = 1\n", &[("1.png", bytes), ("2.png", bytes)]);
}

/// Reads a TIFF file.
pub fn tiff(bytes: &[u8]) {
    read(PLANE, "file = \"1.tif\"\nthreshold = 2\nsolid = \"dark\"\n", &[("1.tif", bytes)]);
    read(SPACE, "file = \"1.tif\"\n", &[("1.tif", bytes)]);
}

/// Labels of two bodies, on 6 x 4 pixels.
const LABELS: [u8; 24] = [0, 1, 1, 1, 0, 0, 0, 1, 1, 1, 2, 2, 0, 0, 1, 0, 2, 2, 0, 0, 0, 0, 2, 2];

/// Labels of eight bits, of one, and indices of four.
pub fn png_seeds() -> Vec<Vec<u8>> {
    use png::{BitDepth, ColorType};
    let encoded = |color, depth, data: &[u8]| {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 6, 4);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if color == ColorType::Indexed {
            encoder.set_palette(vec![0; 48]);
        }
        let mut writer = encoder.write_header().expect("memory takes all");
        writer.write_image_data(data).expect("memory takes all");
        writer.finish().expect("memory takes all");
        bytes
    };
    let wide: Vec<u8> = LABELS.iter().flat_map(|&label| [0, label]).collect();
    let colors: Vec<u8> = LABELS.iter().flat_map(|&label| [label; 3]).collect();
    vec![
        encoded(ColorType::Grayscale, BitDepth::Eight, &LABELS),
        encoded(ColorType::Grayscale, BitDepth::One, &[0x70, 0x78, 0x24, 0x0c]),
        encoded(
            ColorType::Indexed,
            BitDepth::Four,
            &[0x01, 0x11, 0, 0x01, 0x12, 0x20, 0, 0x10, 0x22, 0, 0, 0x22],
        ),
        encoded(ColorType::Grayscale, BitDepth::Sixteen, &wide),
        encoded(ColorType::Rgb, BitDepth::Eight, &colors),
    ]
}

/// A stack of two slices of eight bits, and others of sixteen and of real numbers, and a packed one.
pub fn tiff_seeds() -> Vec<Vec<u8>> {
    use tiff::encoder::{Compression, DeflateLevel, TiffEncoder, colortype};
    let floats = LABELS.map(f32::from);
    let wide = LABELS.map(u16::from);
    let mut all = Vec::new();
    for kind in 0..4 {
        let mut bytes = Cursor::new(Vec::new());
        let encoder = TiffEncoder::new(&mut bytes).expect("memory takes all");
        let packing = match kind {
            2 => Compression::Lzw,
            3 => Compression::Deflate(DeflateLevel::Fast),
            _ => Compression::Uncompressed,
        };
        let mut encoder = encoder.with_compression(packing);
        for _ in 0..2 {
            match kind {
                1 => encoder.write_image::<colortype::Gray16>(6, 4, &wide),
                2 => encoder.write_image::<colortype::Gray32Float>(6, 4, &floats),
                _ => encoder.write_image::<colortype::Gray8>(6, 4, &LABELS),
            }
            .expect("memory takes all");
        }
        all.push(bytes.into_inner());
    }
    all
}
