//! Pictures as a paper wants them: backgrounds, parts of the scene, isolines, arrows, half-spaces, paths of the camera.

mod stickslip;

use ::stickslip::image::Image;
use stickslip::{Workplace, new_scene};

/// A coarse and short run of the new scene.
fn thrown_disk() -> Workplace {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let coarse = ["--set", "cells_per_radius=4", "--set", "time.end=0.1 s"];
    workplace.succeed(&[&["run", "scene.toml", "--quiet"][..], &coarse].concat());
    workplace
}

/// What `stickslip render` draws with some flags.
fn picture(workplace: &Workplace, flags: &[&str]) -> Image {
    workplace.succeed(&[&["render", "scene.results", "--out", "p.png"], flags].concat());
    Image::read_png(&workplace.path("p.png")).unwrap()
}

/// How many pixels are as dark as isolines and arrows.
fn dark(image: &Image) -> usize {
    image.pixels.chunks(3).filter(|rgb| rgb.iter().all(|c| *c < 45)).count()
}

const BARE: [&str; 2] = ["--hide", "title,time,axes,legend,scale-bar"];

#[test]
fn a_picture_stands_on_any_colour_or_none() {
    let workplace = thrown_disk();
    let white = picture(&workplace, &[]);
    assert_eq!((white.color(0, 0), white.opacity.len()), ([255; 3], 0));
    let colored = picture(&workplace, &["--background", "#102030"]);
    assert_eq!(colored.color(0, 0), [0x10, 0x20, 0x30]);
    let bright = colored.pixels.chunks(3).filter(|rgb| rgb.iter().all(|c| *c > 190)).count();
    assert!(bright > 200, "letters can be read: {bright}");

    let clear = picture(&workplace, &["--background", "transparent"]);
    assert_eq!(clear.size, white.size);
    assert_eq!(clear.opacity[0], 0);
    let middle = clear.size[1] * 3 / 4 * clear.size[0] + clear.size[0] / 2;
    assert_eq!(clear.opacity[middle], 255, "the bar hides what is behind it");
    // On white it is the other picture.
    for (i, alpha) in clear.opacity.iter().map(|alpha| u32::from(*alpha)).enumerate() {
        for k in 3 * i..3 * i + 3 {
            let on_white = (u32::from(clear.pixels[k]) * alpha + 255 * (255 - alpha)) / 255;
            assert!(on_white.abs_diff(u32::from(white.pixels[k])) <= 2, "{i}");
        }
    }
    workplace.succeed(&[
        "render",
        "scene.results",
        "--animate",
        "--background",
        "transparent",
        "--out",
        "f.gif",
    ]);
    let film = std::fs::read(workplace.path("f.gif")).unwrap();
    let mut decoder = gif::Decoder::new(&film[..]).unwrap();
    assert!(decoder.read_next_frame().unwrap().unwrap().transparent.is_some());
}

#[test]
fn a_window_shows_a_part_and_nothing_else() {
    let workplace = thrown_disk();
    // In the bar, twice as wide as high.
    let inside = ["--window", "-10 cm,-6cm,0.02,0"];
    let image = picture(&workplace, &[&inside[..], &BARE, &["--color", "pressure"]].concat());
    let [width, height] = image.size;
    assert_eq!(width - 24, 2 * (height - 24), "{width} x {height}");
    assert_eq!(image.color(0, 0), [255; 3]);
    let all = (14..height - 14).all(|y| (14..width - 14).all(|x| image.color(x, y) != [255; 3]));
    assert!(all, "the bar fills the picture");
}

#[test]
fn stress_is_averaged_unless_the_user_says_no() {
    let workplace = thrown_disk();
    let stress = |flags: &[&str]| picture(&workplace, &[&["--color", "von_mises"], flags].concat());
    assert_eq!(stress(&[]), stress(&["--smooth", "yes"]));
    assert_ne!(stress(&[]), stress(&["--smooth", "no"]));
    let speed = |flags: &[&str]| picture(&workplace, &[&["--color", "velocity"], flags].concat());
    assert_eq!(speed(&[]), speed(&["--smooth", "no"]));
}

#[test]
fn isolines_and_arrows_are_drawn() {
    let workplace = thrown_disk();
    let look = ["--color", "velocity", "--colors", "greys", "--range", "0,3"];
    let plain = dark(&picture(&workplace, &look));
    let lines = dark(&picture(&workplace, &[&look[..], &["--contours", "12"]].concat()));
    assert!(lines > plain + 500, "{plain} {lines}");
    let arrows = dark(&picture(&workplace, &[&look[..], &["--vectors", "velocity"]].concat()));
    assert!(arrows > plain + 500, "{plain} {arrows}");
}

#[test]
fn what_does_not_fit_is_refused() {
    let workplace = thrown_disk();
    for (flags, words) in [
        (&["--contours", "5"][..], "--color"),
        (&["--contours", "0", "--color", "xx"], "1..=100"),
        (&["--window", "0,0,1"], "four lengths"),
        (&["--window", "0,0,0,1,1,1"], "LEFT,BOTTOM,RIGHT,TOP"),
        (&["--window", "0,0,1,-1"], "lower corner"),
        (&["--background", "mauve"], "#RRGGBB"),
        (&["--view", "0,10:20,10"], "--animate"),
        (&["--view", "0,10:20,10", "--animate"], "--view: found a plane scene; allowed: scenes in space"),
        (&["--view", "x"], "scenes in space"),
        (&["--balls"], "--balls: found a plane scene; allowed: scenes in space"),
        (&["--smooth", "yes"], "--smooth: found no column of numbers; allowed: with --color"),
        (&["--range", "0,1"], "--range: found no column"),
        (&["--colors", "greys"], "--colors: found no column"),
        (&["--fringes", "--colors", "greys"], "--colors"),
        (&["--animate", "--background", "transparent", "--out", "f.mp4"], ".gif"),
        (&["--fringes", "--background", "black"], "--background"),
        (&["--vectors", "speed"], "velocity"),
        (&["--hide", "bodies"], "scale-bar"),
    ] {
        let ran = workplace.run(&[&["render", "scene.results"], flags].concat());
        assert_eq!(ran.code, Some(2), "{flags:?}");
        assert!(ran.stderr.contains(words), "{flags:?}: {}", ran.stderr);
    }
}

/// A ball above a half-space.
const DROPPED: &str = r#"
    space = { dimension = "3d", interior = "grid", cell = 0.1 }
    gravity = [0, 0, -10]
    time.end = 0.02
    materials.rubber = { density = 1000, neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 } }
    bodies = [
        { name = "ball", material = "rubber", shape.ball = { center = [0, 0, 0.32], radius = 0.3 } },
        { name = "floor", material = "rubber", rigid = {},
          shape.half_space = { point = [0, 0, 0], normal = [0, 0, 1] } },
    ]
    contact = [{ friction = 0.3 }]
    outputs.particles = 0.01
"#;

#[test]
fn in_space_half_spaces_have_clean_edges_and_the_camera_moves() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", DROPPED);
    workplace.succeed(&["run", "scene.toml", "--quiet"]);
    let flags = ["--view", "-y", "--color", "velocity", "--size", "400x300"];
    let image = picture(&workplace, &[&flags[..], &BARE].concat());
    // From the side the floor is a rectangle: each row of its lower half is one colour from end to end.
    let grey = |rgb: [u8; 3]| rgb[0] > 60 && rgb[0] < 250 && rgb[0].abs_diff(rgb[2]) < 4;
    let last = (0..300).rev().find(|&y| grey(image.color(200, y))).unwrap();
    let ends = |y: usize| {
        let row: Vec<usize> = (0..400).filter(|&x| grey(image.color(x, y))).collect();
        (row[0], row[row.len() - 1], row.len())
    };
    let (left, right, count) = ends(last - 4);
    assert_eq!(right - left + 1, count, "nothing interrupts it");
    assert!((1..6).all(|k| ends(last - 4 - k) == (left, right, count)), "its ends are straight");
    // What is not shown is not there.
    let alone = picture(&workplace, &[&flags[..], &BARE, &["--body", "ball"]].concat());
    assert!(!grey(alone.color(200, last - 4)), "{:?}", alone.color(200, last - 4));

    // The ball is round: its surface is drawn, and its particles only where the user wants them or the scene is gone.
    let round = |image: &Image| {
        let is_ball = |x: i64, y: i64| {
            (0..400).contains(&x) && (0..300).contains(&y) && image.color(x as usize, y as usize) != [255; 3]
        };
        let columns: Vec<i64> = (0..400).filter(|&x| (0..300).any(|y| is_ball(x, y))).collect();
        let rows: Vec<i64> = (0..300).filter(|&y| (0..400).any(|x| is_ball(x, y))).collect();
        let [x, y] = [&columns, &rows].map(|ends| (ends[0] + ends[ends.len() - 1]) as f64 / 2.0);
        let radius = columns.len() as f64 / 2.0;
        let rim = |share: f64| {
            let angles = (0..180).map(|k| f64::from(k).to_radians() * 2.0);
            let seen = angles.filter(|a| {
                is_ball(
                    (x + share * radius * a.cos()).round() as i64,
                    (y + share * radius * a.sin()).round() as i64,
                )
            });
            seen.count()
        };
        (rim(0.97), rim(1.03))
    };
    assert_eq!(round(&alone), (180, 0));
    let balls = picture(&workplace, &[&flags[..], &BARE, &["--body", "ball", "--balls"]].concat());
    assert_ne!(balls, alone);
    assert_ne!(round(&balls), (180, 0));
    // Surfaces follow from the recorded text of the scene: without it balls are drawn.
    std::fs::rename(workplace.path("scene.toml"), workplace.path("gone.toml")).unwrap();
    let without_file = || picture(&workplace, &[&flags[..], &BARE, &["--body", "ball"]].concat());
    assert_eq!(without_file(), alone);
    let record = workplace.path("scene.results/run.json");
    let whole = std::fs::read_to_string(&record).unwrap();
    let (before, behind) = whole.rsplit_once("\"text\": ").unwrap();
    std::fs::write(&record, format!("{before}\"unread\": {behind}")).unwrap();
    assert_eq!(without_file(), balls);
    std::fs::write(&record, whole).unwrap();
    std::fs::rename(workplace.path("gone.toml"), workplace.path("scene.toml")).unwrap();

    let near = picture(&workplace, &[&flags[..], &["--window", "-0.3,-0.3,0,0.3,0.3,0.6"]].concat());
    assert_ne!(near, picture(&workplace, &flags));
    let path = ["render", "scene.results", "--animate", "--view", "0,0:90,0", "--size", "300x200"];
    workplace.succeed(&path);
    let ran = workplace.run(&["render", "scene.results", "--window", "0,0,1,1"]);
    assert!(ran.code == Some(2) && ran.stderr.contains("six lengths"), "{}", ran.stderr);
    // It falls: arrows point down, out of the ball's middle.
    let arrows = picture(&workplace, &[&flags[..], &BARE, &["--vectors", "velocity"]].concat());
    assert!(dark(&arrows) > dark(&picture(&workplace, &[&flags[..], &BARE].concat())) + 100);
    // One side of a ball in the light of colours has the other's values: no line where all fall alike.
    let still = picture(&workplace, &[&flags[..], &BARE, &["--range", "0,9", "--contours", "8"]].concat());
    assert_eq!(still, picture(&workplace, &[&flags[..], &BARE, &["--range", "0,9"]].concat()));
}

const BALLS: &str = r#"
    space = { dimension = "3d", interior = "grid", cell = "2 cm" }
    gravity = [0, 0, "-9.81 m/s^2"]
    time.end = "2 ms"
    outputs.particles = "1 ms"
    materials.rubber = { density = 1000, neo_hookean = { young_modulus = "1 MPa", poisson_ratio = 0.3 } }
    bodies = [
        { name = "left", material = "rubber", shape.ball = { center = [0, 0, 0], radius = "5 cm" } },
        { name = "right", material = "rubber", shape.ball = { center = [0.2, 0, 0], radius = "5 cm" } },
        { name = "floor", material = "rubber", shape.half_space = { point = [0, 0, -1], normal = [0, 0, 1] }, rigid = {} },
    ]
    contact = [{ between = ["*", "*"], friction = 0 }]
"#;

/// The file is read back with VTK in stickslip-py/tests/test_readers.py.
#[test]
fn surfaces_of_bodies_in_space_are_a_model() {
    let workplace = Workplace::new();
    workplace.write("balls.toml", BALLS);
    workplace.succeed(&["run", "balls.toml", "--quiet"]);
    let render = |flags: &[&str]| {
        workplace.run(&[&["render", "balls.results", "--out", "balls.glb"][..], flags].concat())
    };
    let ran = render(&[]);
    assert!(ran.stdout.contains("holds the surfaces of 2 bodies at t = 0.002000 s"), "{}", ran.stderr);
    let by_body = std::fs::read(workplace.path("balls.glb")).unwrap();
    let ran = render(&["--frame", "0", "--body", "left", "--color", "velocity"]);
    assert!(ran.stdout.contains("holds the surface of one body at t = 0.000000 s"), "{}", ran.stderr);
    let by_value = std::fs::read(workplace.path("balls.glb")).unwrap();
    let has = |file: &[u8], word: &str| file.windows(word.len()).any(|bytes| bytes == word.as_bytes());
    assert!(has(&by_body, "\"right\"") && !has(&by_body, "COLOR_0"));
    assert!(has(&by_value, "COLOR_0") && !has(&by_value, "\"right\""));
    for (flags, expected) in [
        (&["--size", "800x600"][..], "--size: found a model"),
        (&["--view", "x"], "--view: found a model"),
        (&["--frame", "0,1"], "for one snapshot in .glb"),
        (&["--animate"], "ends in .png, .gif, .mp4 or .webm"),
    ] {
        let refused = render(flags);
        assert_eq!(refused.code, Some(2), "{flags:?}: {}", refused.stderr);
        assert!(refused.stderr.contains(expected), "{flags:?}: {}", refused.stderr);
    }
    assert_eq!(
        std::fs::read(workplace.path("balls.glb")).unwrap(),
        by_value,
        "what is refused changes nothing"
    );
    workplace.write("balls.glb", "mine");
    assert!(render(&[]).code != Some(0), "and what is no model stays");

    let flat = thrown_disk();
    let refused = flat.run(&["render", "scene.results", "--out", "disk.glb"]);
    assert_eq!(refused.code, Some(2));
    assert!(refused.stderr.contains("--out: found a plane scene"), "{}", refused.stderr);
}

/// Films are made by the user's ffmpeg, which reads them back here: every picture, in its colours, with even sides.
#[test]
fn films_play_every_picture() {
    let ffmpeg = |arguments: &[&str], folder: &std::path::Path| {
        std::process::Command::new("ffmpeg").args(arguments).current_dir(folder).output()
    };
    let workplace = thrown_disk();
    if ffmpeg(&["-version"], &workplace.path("")).is_err() {
        eprintln!("skipped: ffmpeg is not on the path");
        let refused = workplace.run(&["render", "scene.results", "--animate", "--out", "film.mp4"]);
        assert_eq!(refused.code, Some(2), "{}", refused.stderr);
        assert!(refused.stderr.contains("ffmpeg, which is not on the path"), "{}", refused.stderr);
        return;
    }
    let size = ["--size", "401x301"];
    workplace.succeed(&[&["render", "scene.results", "--all", "--out", "pictures"][..], &size].concat());
    let mut pictures: Vec<_> = std::fs::read_dir(workplace.path("pictures")).unwrap().collect();
    pictures.sort_by_key(|entry| entry.as_ref().unwrap().path());
    for film in ["film.mp4", "film.webm"] {
        for _ in 0..2 {
            // Its own it replaces.
            let said = workplace
                .succeed(&[&["render", "scene.results", "--animate", "--out", film][..], &size].concat());
            assert!(said.contains(&format!("{film} plays {} pictures", pictures.len())), "{said}");
        }
        let read = ["-loglevel", "error", "-i", film, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"];
        let decoded = ffmpeg(&read, &workplace.path("")).unwrap();
        assert!(decoded.status.success(), "{}", String::from_utf8_lossy(&decoded.stderr));
        let frames: Vec<&[u8]> = decoded.stdout.chunks_exact(3 * 402 * 302).collect();
        assert_eq!((frames.len(), decoded.stdout.len()), (pictures.len(), pictures.len() * 3 * 402 * 302));
        for (frame, picture) in frames.iter().zip(&pictures) {
            let picture = Image::read_png(&picture.as_ref().unwrap().path()).unwrap();
            let off: u64 = (0..301)
                .flat_map(|y| (0..3 * 401).map(move |x| (3 * 402 * y + x, 3 * 401 * y + x)))
                .map(|(a, b)| u64::from(frame[a].abs_diff(picture.pixels[b])))
                .sum();
            // Films keep half of the colours' pixels, and lose a little of each.
            let mean = off as f64 / picture.pixels.len() as f64;
            assert!(mean < 4.0, "{film}: {mean} of 255");
        }
        workplace.write(film, "mine");
        let refused = workplace.run(&["render", "scene.results", "--animate", "--out", film]);
        assert!(refused.code != Some(0) && std::fs::read(workplace.path(film)).unwrap() == b"mine");
    }
}
