//! Images that make no bodies.

use crate::{MINIMAL, edited};
use std::fs::{self, File};
use std::path::Path;
use stickslip_scene::scene;

/// A grey PNG of 4 x 4 pixels.
fn write(path: &Path, pixels: &[u8; 16]) {
    let mut encoder = png::Encoder::new(File::create(path).expect("a file"), 4, 4);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.write_header().and_then(|mut writer| writer.write_image_data(pixels)).expect("written");
}

const LABELS: [u8; 16] = [0, 0, 0, 0, 0, 3, 3, 0, 0, 3, 3, 0, 0, 0, 0, 7];

/// What a scene says with this table of an image, in a folder with images.
fn read(dimension: &str, table: &str) -> Result<Vec<String>, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    write(&at("labels.png"), &LABELS);
    write(&at("empty.png"), &[0; 16]);
    for slice in [1, 2, 10] {
        write(&at(&format!("slice {slice}.png")), &LABELS);
    }
    fs::write(at("words.png"), "no image").expect("written");
    let mut encoder = png::Encoder::new(File::create(at("slice wide.png")).expect("a file"), 2, 1);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&[1, 1])).expect("written");
    let scene = edited(MINIMAL, "3d", dimension);
    let bodies = scene.find("[[bodies]]").expect("bodies");
    let scene = format!("{}[[images]]\nname = \"grain\"\nmaterial = \"rubber\"\n{table}\n", &scene[..bodies]);
    let place = format!("{}/", folder.path().display());
    let loaded = scene::parse(&format!("{place}a.toml"), &scene, &[]);
    let names = |scene: scene::Scene| scene.bodies.iter().map(|body| body.name.clone()).collect();
    loaded.map(|loaded| names(loaded.scene)).map_err(|error| error.to_string().replace(&place, ""))
}

#[test]
fn labels_and_slices_are_bodies() {
    let plane = |table: &str| read("plane-strain", table).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(plane("file = \"labels.png\"\npixel = 1"), ["grain 3", "grain 7"]);
    assert_eq!(plane("file = \"labels.png\"\npixel = 1\nlabels = [3]"), ["grain 3"]);
    assert_eq!(plane("file = \"labels.png\"\npixel = 1\nbackground = 3"), ["grain 0", "grain 7"]);
    assert_eq!(plane("file = \"labels.png\"\npixel = 1\nleast_pixels = 2"), ["grain 3"]);
    // Corners touch.
    assert_eq!(plane("file = \"labels.png\"\npixel = 1\nthreshold = 0.5"), ["grain 1"]);
    assert_eq!(plane("file = \"labels.png\"\npixel = 1\nthreshold = 5"), ["grain 1"]);
    let space = read("3d", "file = \"slice *0.png\"\npixel = 1");
    assert!(
        space.expect_err("one slice").contains("one slice; allowed: a stack of them, as the scene is 3d")
    );
    let space = read("3d", "file = \"slice 1*.png\"\npixel = 1").unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(space, ["grain 3", "grain 7"]);
}

#[test]
fn what_makes_no_bodies_is_told_with_line_and_key() {
    for (dimension, table, expected) in [
        (
            "plane-strain",
            "file = \"missing.png\"\npixel = 1",
            "15:8: images[0].file: found \"missing.png\"; allowed: a file that can be read; missing.png: No such file",
        ),
        (
            "plane-strain",
            "file = \"a.toml\"\npixel = 1",
            "15:8: images[0].file: found \"a.toml\"; allowed: an image that ends in .png, .tif or .tiff",
        ),
        (
            "plane-strain",
            "file = \"words.png\"\npixel = 1",
            "15:8: images[0].file: found in words.png: no PNG: Invalid PNG signature.; allowed: an image of greys or",
        ),
        (
            "plane-strain",
            "file = \"empty.png\"\npixel = 1",
            "15:8: images[0].file: found in empty.png: no pixels but those of the background, 0; allowed: an image with labels",
        ),
        (
            "plane-strain",
            "file = \"labels.png\"\npixel = 1\nthreshold = 200",
            "15:8: images[0].file: found in labels.png: greys from 0 to 7; allowed: an image with greys on both sides of ",
        ),
        (
            "plane-strain",
            "file = \"labels.png\"\npixel = 0",
            "16:9: images[0].pixel: found 0; allowed: a length [m] above 0, like \"0.4 m\"",
        ),
        (
            "plane-strain",
            "file = \"labels.png\"\npixel = 1\nlabels = [3, 4]",
            "17:14: images[0].labels[1]: found 4; allowed: a label that pixels of the image have, least_pixels at least",
        ),
        (
            "plane-strain",
            "file = \"labels.png\"\npixel = 1\nthreshold = 5\nbackground = 1",
            "18:14: images[0].background: found 1; allowed: nothing beside threshold: the pixels are no labels",
        ),
        (
            "plane-strain",
            "file = \"labels.png\"\npixel = 1\nsolid = \"dark\"",
            "17:9: images[0].solid: found \"dark\"; allowed: solid beside threshold",
        ),
        (
            "plane-strain",
            "file = \"labels.png\"\npixel = 1\nthreshhold = 5",
            "17:1: images[0].threshhold: found unknown key `threshhold`; allowed: name, file, pixel, origin, ",
        ),
        (
            "plane-strain",
            "file = \"slice 1*.png\"\npixel = 1",
            "15:8: images[0].file: found in slice 1*.png: 2 slices; allowed: one, as the scene is plane",
        ),
        (
            "3d",
            "file = \"slice *.png\"\npixel = 1",
            "15:8: images[0].file: found in slice wide.png: a slice of 2 x 1 pixels; allowed: 4 x 4, as the first slice",
        ),
        (
            "3d",
            "file = \"scan *.png\"\npixel = 1",
            "15:8: images[0].file: found \"scan *.png\"; allowed: images that can be read; ",
        ),
    ] {
        let found = read(dimension, table).expect_err("no bodies");
        assert!(found.starts_with(&format!("a.toml:{expected}")), "{table}\n{found}\n{expected}");
    }
}
