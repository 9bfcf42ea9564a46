//! What nobody means to do and somebody does: each ends with a sentence and an exit code, and takes nothing away.

mod stickslip;

use std::fs;
use std::process::Stdio;
use std::time::{Duration, Instant};
use stickslip::{Ran, Workplace, new_scene};

/// The new scene, coarse and short.
const QUICK: [&str; 4] = ["--set", "cells_per_radius=4", "--set", "time.end=20 ms"];

fn workplace() -> Workplace {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    workplace
}

fn run(workplace: &Workplace, more: &[&str]) -> Ran {
    workplace.run(&[&["run", "scene.toml"][..], &QUICK, more].concat())
}

fn refused(ran: &Ran, why: &str) {
    assert_eq!(ran.code, Some(2), "{}{}", ran.stdout, ran.stderr);
    assert!(ran.stderr.contains(why), "{why}: {}", ran.stderr);
    assert!(!ran.stderr.contains("panicked"), "{}", ran.stderr);
}

/// A scene with this title and these parameters, checked within ten seconds.
fn check_with(title: &str, parameters: &str) -> Ran {
    let workplace = Workplace::new();
    let scene = new_scene();
    let written = scene.lines().find(|line| line.starts_with("title = ")).unwrap();
    let scene = scene.replace(written, &format!("title = \"{title}\""));
    workplace
        .write("scene.toml", &scene.replacen("[parameters]\n", &format!("[parameters]\n{parameters}"), 1));
    let begun = Instant::now();
    let ran = workplace.run(&["check", "scene.toml"]);
    assert!(begun.elapsed() < Duration::from_secs(10), "it took {:?}", begun.elapsed());
    ran
}

#[test]
fn parameters_that_wait_for_each_other_without_end_are_refused() {
    let chain = |order: &mut dyn Iterator<Item = usize>| -> String {
        order.map(|i| format!("p{i} = \"p{} + 1\"\n", i + 1)).collect::<String>() + "p3000 = 1\n"
    };
    refused(&check_with("t", &chain(&mut (0..3000))), "wait for each other");
    // In the other order nobody waits.
    let forward = "p3000 = 1\n".to_string() + &chain(&mut (0..3000).rev()).replace("p3000 = 1\n", "");
    let ran = check_with("t", &forward);
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    for first in ["x", ""] {
        let doubled = |i: usize| format!("w{i} = \"{{w{0}}}{{w{0}}}\"\n", i - 1);
        let doubled: String = (1..=40).rev().map(doubled).collect();
        refused(&check_with("{w40}", &format!("{doubled}w0 = \"{first}\"\n")), "grows without end");
    }
}

/// What grows with the square of a file's length would take minutes here.
#[test]
fn long_files_are_read_in_a_time_in_proportion_to_their_length() {
    let workplace = Workplace::new();
    let check = |what: &str, text: &str| {
        workplace.write("scene.toml", text);
        let begun = Instant::now();
        let ran = workplace.run(&["check", "scene.toml"]);
        let took = begun.elapsed();
        assert!(took < Duration::from_secs(15), "{what}: {took:?}");
        assert!(ran.stdout.len() + ran.stderr.len() < 4_000_000, "{what}: {} bytes said", ran.stderr.len());
        ran
    };
    let scene = new_scene();
    let with_parameters =
        |lines: &str| scene.replacen("[parameters]\n", &format!("[parameters]\n{lines}"), 1);
    let all = |count: usize, line: &dyn Fn(usize) -> String| (0..count).map(line).collect::<String>();

    let braces = scene.replace("name = \"disk\"", &format!("name = \"{}\"", "{1}".repeat(40_000)));
    refused(&check("braces", &braces), "grows without end");
    let numbers = all(20_000, &|i| format!("n{i} = {i}\n"));
    assert_eq!(check("parameters", &with_parameters(&numbers)).code, Some(0));
    let chain = all(20_000, &|i| format!("n{i} = \"n{} + 1\"\n", i.wrapping_sub(1)))
        .replace(&format!("n{}", usize::MAX), "0");
    assert_eq!(check("a chain of parameters", &with_parameters(&chain)).code, Some(0));
    let words = all(20_000, &|i| format!("w{i} = \"w {i}\"\n"));
    refused(&check("words that nobody uses", &with_parameters(&words)), "w0");
    let rule = "[[contact]]\nbetween = [\"disk\", \"bar\"]\nfriction = 0.1\n";
    assert_eq!(check("rules", &(scene.clone() + &rule.repeat(20_000))).code, Some(0));
    let long = scene.replace("name = \"disk\"", &format!("name = \"{}\"", "x".repeat(1_000_000)));
    let ran = check("a long name", &long);
    assert!(ran.stderr.len() < 20_000, "{} bytes said", ran.stderr.len());
    let unknown = with_parameters(&numbers).replace("name = \"disk\"", "name = \"{unknown}\"");
    let ran = check("an unknown parameter among many", &unknown);
    refused(&ran, "letters more");
    assert!(ran.stderr.len() < 20_000, "{} bytes said", ran.stderr.len());
    refused(&check("a long key", &format!("{scene}\n[{}]\n", "k".repeat(2000))), "a key of 2000 bytes");
    refused(&check("values", &format!("x = [{}]\n{scene}", "1,".repeat(10_000_001))), "at most 10000000");
}

/// An image of 65,536 labels, a pixel each: pairs of them are two billions.
#[test]
fn an_image_of_many_labels_is_read_in_a_while() {
    let workplace = Workplace::new();
    let (side, file) = (256_u32, fs::File::create(workplace.path("labels.png")).unwrap());
    let mut encoder = png::Encoder::new(file, side, side);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    let pixels: Vec<u8> = (0..side * side).flat_map(|label| (label as u16).to_be_bytes()).collect();
    encoder.write_header().unwrap().write_image_data(&pixels).unwrap();
    workplace.write(
        "scene.toml",
        "[space]\ndimension = \"2d\"\ninterior = \"grid\"\ncell = 0.01\n[time]\nend = 1e-5\n[materials.m]\ndensity = 1000\n\
         neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 }\n[[images]]\nname = \"b\"\nmaterial = \"m\"\n\
         file = \"labels.png\"\npixel = 0.02\n",
    );
    let begun = Instant::now();
    // A pixel is parted from all around it, and nothing is left.
    refused(&workplace.run(&["check", "scene.toml"]), "`b 1` holds no particle");
    assert!(begun.elapsed() < Duration::from_secs(60), "{:?}", begun.elapsed());
}

/// Of a scene, of its folder and of the folder for results, with a file beside the scene.
#[test]
#[cfg(target_os = "linux")]
fn names_that_are_no_text_are_names() {
    use std::os::unix::ffi::OsStrExt;
    let name = |text: &[u8]| std::ffi::OsStr::from_bytes(text).to_owned();
    let workplace = Workplace::new();
    let inside = workplace.path("").join(name(b"caf\xe9"));
    fs::create_dir(&inside).unwrap();
    let places = (0..64).map(|i| [0.025 + 0.05 * f64::from(i % 8), 0.025 + 0.05 * f64::from(i / 8)]);
    let rows: String = places.map(|[x, y]| format!("{x},{y},0.0025\n")).collect();
    fs::write(inside.join("grains.csv"), format!("x,y,volume\n{rows}")).unwrap();
    let scene = "[parameters]\nspeed = 1\n[space]\ndimension = \"2d\"\ninterior = \"grid\"\ncell = 0.1\n[time]\nend = 1e-3\n[materials.m]\n\
                 density = 1000\nneo_hookean = { young_modulus = 1e4, poisson_ratio = 0.3 }\n\
                 [[point_clouds]]\nname = \"b\"\nmaterial = \"m\"\nfile = \"grains.csv\"\nvelocity = [\"speed\", 0]\n";
    let path = inside.join(name(b"sc\xe8ne.toml"));
    fs::write(&path, scene).unwrap();
    let run = |words: &[&str], more: &[&std::ffi::OsStr]| {
        let output = workplace.command(words).args(more).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{words:?}: {said}");
    };
    let out = name(b"r\xe9sults");
    run(&["check"], &[path.as_os_str()]);
    run(&["run", "--out"], &[&out, path.as_os_str()]);
    // Its name cannot be written down.
    run(&["resume", "--until", "2 ms", "--scene"], &[path.as_os_str(), &out]);
    run(&["render"], &[&out]);
    run(&["sweep", "--set", "speed=1,2", "--out"], &[&name(b"sw\xe9ep"), path.as_os_str()]);
}

/// Names of bodies that a file of particles gives go into tables, and onto the terminal.
#[test]
fn names_in_files_of_particles_have_no_control_characters() {
    let workplace = Workplace::new();
    let scene = "[space]\ndimension = \"2d\"\ninterior = \"grid\"\ncell = 0.1\n[time]\nend = 1e-3\n[materials.m]\ndensity = 1000\n\
                 neo_hookean = { young_modulus = 1e4, poisson_ratio = 0.3 }\n\
                 [[point_clouds]]\nname = \"b\"\nmaterial = \"m\"\nfile = \"grains.csv\"\n";
    workplace.write("scene.toml", scene);
    let write = |head: &str, name: &str| {
        let places = (0..64).map(|i| [0.025 + 0.05 * f64::from(i % 8), 0.025 + 0.05 * f64::from(i / 8)]);
        let rows: String = places.map(|[x, y]| format!("{x},{y},0.0025,\"{name}\"\n")).collect();
        workplace.write("grains.csv", &format!("{head}\n{rows}"));
    };
    for name in ["a\u{1b}[31m", "a\nb", "a\u{7}", "\u{9b}31m", "a\u{fffe}", "a\u{202e}gnp"] {
        write("x,y,volume,body", name);
        for command in ["check", "run"] {
            let ran = workplace.run(&[command, "scene.toml"]);
            refused(&ran, "without control characters");
            assert!(ran.stderr.contains("grains.csv, line 2, column 4"), "{}", ran.stderr);
            let steers = |letter: char| letter.is_control() && letter != '\n' || letter == '\u{202e}';
            assert!(!(ran.stdout + &ran.stderr).contains(steers), "{name:?}");
        }
    }
    write("x,y,volume,body", &"long ".repeat(1000));
    refused(&workplace.run(&["check", "scene.toml"]), "at most 200 bytes");
    // The head of a table is quoted where a column lacks.
    write("x,y\u{1b}[31m,volume,body", "a");
    let ran = workplace.run(&["check", "scene.toml"]);
    refused(&ran, "no column y");
    assert!(!ran.stderr.contains('\u{1b}'), "{:?}", ran.stderr);
    write(&format!("x,{},volume,body", "c".repeat(1_000_000)), "a");
    let ran = workplace.run(&["check", "scene.toml"]);
    refused(&ran, "no column y");
    assert!(ran.stderr.len() < 20_000, "{} bytes said", ran.stderr.len());
    write("x,y,volume,body", "grain 7");
    assert_eq!(workplace.run(&["run", "scene.toml"]).code, Some(0));
    assert!(workplace.succeed(&["plot", "scene.results", "--out", "plot.svg"]).contains("plot.svg"));
}

#[test]
fn control_characters_do_not_reach_files_and_terminals() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene().replace("name = \"disk\"", "name = \"di\\u001b[31msk\""));
    let ran = workplace.run(&["check", "scene.toml"]);
    refused(&ran, "control character");
    assert!(!ran.stderr.contains('\u{1b}'), "{:?}", ran.stderr);
    // Keys, parameters and formulas are shown where they are wrong, with the lines around them.
    for (place, words) in [
        ("\"k\\u001b]0;x\\u0007\" = 1\n", ""),
        ("", "\"p\\u001b[31m\" = 1\n"),
        ("title2 = \"\u{9b}31m\"\n", ""),
        ("", "p = \"\\u001b[31m 1 +\"\n"),
    ] {
        let scene = new_scene().replacen("[parameters]\n", &format!("[parameters]\n{words}"), 1);
        workplace.write("scene.toml", &(place.to_owned() + &scene));
        let ran = workplace.run(&["check", "scene.toml"]);
        assert_eq!(ran.code, Some(2), "{place}{words}");
        assert!(!ran.stderr.contains(['\u{1b}', '\u{7}', '\u{9b}']), "{place}{words}: {:?}", ran.stderr);
    }
    // What is no letter in XML.
    workplace.write("scene.toml", &new_scene().replace("name = \"disk\"", "name = \"di\\uFFFEsk\""));
    refused(&workplace.run(&["check", "scene.toml"]), "control character");
}

/// Of a log that lies on a full disk, or goes through a pipe that is closed.
#[test]
#[cfg(unix)]
fn a_log_that_takes_nothing_does_not_end_a_run() {
    let workplace = workplace();
    for progress in ["auto", "json"] {
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        let words = [&["run", "scene.toml", "--out", progress, "--progress", progress][..], &QUICK].concat();
        let status = workplace.command(&words).stdout(Stdio::null()).stderr(full).status().unwrap();
        assert_eq!(status.code(), Some(0), "{progress}");
        let record = fs::read_to_string(workplace.path(progress).join("run.json")).unwrap();
        assert!(record.contains("\"finished\"") && workplace.path(progress).join("picture.png").exists());
    }
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let refused = workplace.command(&["check", "nowhere.toml"]).stderr(writer).status().unwrap();
    assert_eq!(refused.code(), Some(2));
}

/// Of a folder that somebody else made.
#[test]
fn control_characters_in_results_do_not_reach_files_and_terminals() {
    let workplace = workplace();
    assert_eq!(run(&workplace, &[]).code, Some(0));
    let replace = |name: &str, from: &str, to: &str| {
        let path = workplace.path("scene.results").join(name);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{name}");
        fs::write(&path, text.replace(from, to)).unwrap();
    };
    replace("run.json", "disk", "di\\u001b[31msk");
    for (words, out) in [
        (&["plot", "scene.results", "--out", "plot.svg"][..], Some("plot.svg")),
        (&["plot", "scene.results", "--out", "plot.png"], None),
        (&["render", "scene.results"], None),
        (&["resume", "scene.results", "--until", "1 ms"], None),
    ] {
        let ran = workplace.run(words);
        assert!(!(ran.stdout + &ran.stderr).contains('\u{1b}'), "{words:?}");
        if let Some(out) = out {
            assert!(!fs::read_to_string(workplace.path(out)).unwrap().contains('\u{1b}'), "{words:?}");
        }
    }
    replace("bodies.csv", ",disk,", ",di\u{1b}[31msk,");
    let ran = workplace.run(&["plot", "scene.results"]);
    refused(&ran, "a name without control characters");
    assert!(!ran.stderr.contains('\u{1b}'), "{:?}", ran.stderr);
}

#[test]
#[cfg(unix)]
fn a_pipe_in_the_place_of_a_mesh_is_refused_and_not_waited_for() {
    let workplace = Workplace::new();
    assert!(workplace.command(&[]).arg("--version").stdout(Stdio::null()).status().unwrap().success());
    let pipe = workplace.path("pipe.stl");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let solid = |file: &str| {
        format!(
            "[space]\ndimension = \"3d\"\ninterior = \"grid\"\ncell = 0.1\n[time]\nend = 1\n[materials.m]\ndensity = 1\n\
             neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }}\n[[bodies]]\nname = \"a\"\nmaterial = \"m\"\n\
             shape.mesh = {{ file = \"{file}\" }}\n"
        )
    };
    workplace.write("scene.toml", &solid("pipe.stl"));
    refused(&workplace.run(&["check", "scene.toml"]), "no file");
    workplace.write("nan.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    workplace.write("scene.toml", &solid("nan.obj"));
    refused(&workplace.run(&["check", "scene.toml"]), "which is no place");
}

/// Nor is a file without an end read to its end.
#[test]
#[cfg(unix)]
fn a_pipe_among_results_is_named_and_not_waited_for() {
    let workplace = workplace();
    assert_eq!(run(&workplace, &[]).code, Some(0));
    for name in ["energy.csv", "particles/00000.vtu"] {
        let place = workplace.path("scene.results").join(name);
        let kept = fs::read(&place).unwrap();
        fs::remove_file(&place).unwrap();
        assert!(std::process::Command::new("mkfifo").arg(&place).status().unwrap().success());
        refused(&workplace.run(&["check", "scene.results"]), "it is no file");
        fs::remove_file(&place).unwrap();
        fs::write(&place, kept).unwrap();
    }
    refused(&workplace.run(&["check", "/dev/zero"]), "more than 256 MiB");
}

#[test]
fn a_million_frames_are_the_most() {
    let workplace = workplace();
    let fringes = "\n[outputs.fringes]\ninterval = 1e-300\nstress_parameter = 1\n";
    workplace.write("scene.toml", &(new_scene() + fringes));
    refused(&workplace.run(&["check", "scene.toml"]), "at most 1e6 frames");
}

#[test]
fn times_that_were_not_recorded_are_refused() {
    let workplace = workplace();
    assert_eq!(run(&workplace, &[]).code, Some(0));
    for time in ["1e300", "nan", "inf", "-1"] {
        refused(&workplace.run(&["render", "scene.results", "--time", time]), "allowed: 0 s to 0.02 s");
    }
    assert_eq!(workplace.run(&["render", "scene.results", "--time", "0.02"]).code, Some(0));
}

#[test]
fn files_of_others_are_not_replaced() {
    let workplace = workplace();
    assert_eq!(run(&workplace, &[]).code, Some(0));
    for name in ["thesis.gif", "thesis.png", "thesis.svg", "index.html", "picture_00000.png"] {
        workplace.write(name, "years of work");
    }
    for arguments in [
        &["render", "scene.results", "--animate", "--out", "thesis.gif"][..],
        &["render", "scene.results", "--out", "thesis.png"],
        &["render", "scene.results", "--animate", "--out", "thesis.png"],
        &["render", "scene.results", "--all", "--out", "."],
        &["plot", "scene.results", "--out", "thesis.svg"],
        &["validate", "B21-loaded", "--out", "."],
    ] {
        let ran = workplace.run(arguments);
        assert_eq!(ran.code, Some(2), "{arguments:?}: {}", ran.stderr);
        assert!(ran.stderr.contains("it is there already"), "{arguments:?}: {}", ran.stderr);
    }
    // Files of the same kind, which others made.
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, 1, 1);
    encoder.add_text_chunk("Software".to_owned(), "Camera 1.0".to_owned()).unwrap();
    encoder.write_header().unwrap().write_image_data(&[7]).unwrap();
    for (name, bytes, command) in [
        ("own.png", &png[..], "render"),
        ("own.svg", b"<svg xmlns=\"http://www.w3.org/2000/svg\"/>", "plot"),
        ("own.gif", b"GIF89a, and so on", "render --animate"),
    ] {
        fs::write(workplace.path(name), bytes).unwrap();
        let words: Vec<&str> = command.split(' ').chain(["scene.results", "--out", name]).collect();
        let ran = workplace.run(&words);
        assert_eq!(ran.code, Some(2), "{name}: {}", ran.stderr);
        assert!(ran.stderr.contains("does not say that Stickslip made it"), "{name}: {}", ran.stderr);
        assert_eq!(fs::read(workplace.path(name)).unwrap(), bytes, "{name}");
        fs::remove_file(workplace.path(name)).unwrap();
        for _ in 0..2 {
            workplace.succeed(&words);
        }
    }
    // Scenes of measurements are written by their names; one of them is somebody's own.
    let listed = workplace.succeed(&["bench", "--scenes", "scenes", "--only", "P1", "--tiny"]);
    let own = fs::read_dir(workplace.path("scenes")).unwrap().next().unwrap().unwrap().path();
    workplace.succeed(&["bench", "--scenes", "scenes", "--only", "P1", "--tiny"]);
    let edited = fs::read_to_string(&own).unwrap().replacen("title = \"", "title = \"My \"", 1);
    for mine in ["years of work", &edited] {
        fs::write(&own, mine).unwrap();
        let again = workplace.run(&["bench", "--scenes", "scenes", "--only", "P1", "--tiny"]);
        assert_eq!(again.code, Some(2), "{listed}{}", again.stderr);
        assert_eq!(fs::read_to_string(&own).unwrap(), mine);
    }
    for name in ["thesis.gif", "thesis.png", "thesis.svg", "index.html", "picture_00000.png"] {
        assert_eq!(fs::read_to_string(workplace.path(name)).unwrap(), "years of work", "{name}");
    }
}

#[test]
fn a_run_that_needs_more_memory_than_it_may_take_is_refused() {
    let workplace = workplace();
    let ran = run(&workplace, &["--max-memory", "10 kB"]);
    refused(&ran, "may take 10.0 kB");
    assert!(!workplace.path("scene.results").exists());
    assert_eq!(run(&workplace, &["--max-memory", "1 GiB"]).code, Some(0));
    refused(&run(&workplace, &["--max-memory", "much"]), "--max-memory");
}

#[test]
fn two_runs_into_one_folder_are_told_apart() {
    let workplace = workplace();
    let mut first = (workplace.command(&["run", "scene.toml", "--set", "time.end=0.9"]))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while !workplace.path("scene.results/energy.csv").exists() {
        assert!(begun.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(2));
    }
    refused(&run(&workplace, &[]), "another run is writing to scene.results");
    first.kill().unwrap();
    first.wait().unwrap();
    assert_eq!(run(&workplace, &[]).code, Some(0), "the lock goes with whoever had it");
}

/// A limit on the length of files, which the system enforces by a signal that ends a program.
#[test]
#[cfg(target_os = "linux")]
fn a_limit_on_the_length_of_files_is_an_error_like_a_full_disk() {
    let workplace = workplace();
    let program = workplace.command(&[]).get_program().to_owned();
    let line = format!("ulimit -f 40; exec '{}' run scene.toml", program.to_str().unwrap());
    let mut shell = std::process::Command::new("bash");
    let output = shell.args(["-c", &line]).current_dir(workplace.path("")).output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(told.contains("cannot write scene.results"), "{told}");
    let record: serde_json::Value =
        serde_json::from_slice(&fs::read(workplace.path("scene.results/run.json")).unwrap()).unwrap();
    assert_eq!(record["status"], "failed");
}

#[test]
fn a_probe_that_sees_nothing_is_told() {
    let workplace = workplace();
    let probe = "\n[[outputs.probes]]\nname = \"lonely\"\nat = [\"-2 * radius\", \"3.5 * radius\"]\nfixed_in = \"space\"\n";
    workplace.write("scene.toml", &(new_scene() + probe));
    let ran = run(&workplace, &[]);
    assert!(
        ran.stdout.contains("no material ever came to the probe `lonely`"),
        "{}{}",
        ran.stdout,
        ran.stderr
    );
    let record: serde_json::Value =
        serde_json::from_slice(&fs::read(workplace.path("scene.results/run.json")).unwrap()).unwrap();
    let warned = record["warnings"].as_array().unwrap().iter().find(|warning| warning["kind"] == "probe");
    assert!(warned.is_some_and(|warning| warning["count"] == 1), "{record}");
    let strict = run(&workplace, &["--strict"]);
    assert_eq!(strict.code, Some(3), "{}", strict.stderr);
}

/// A domain that everything leaves, as the scene allows.
#[test]
fn a_run_of_which_nothing_is_left_is_no_failure() {
    let workplace = workplace();
    let scene = "[space]\ndimension = \"plane-strain\"\ninterior = \"grid\"\ncell = 0.1\n\
        domain = { min = [0, 0], max = [1, 1], leaving = \"remove\" }\n[time]\nend = 0.2\n\
        [materials.rubber]\ndensity = 1000\nneo_hookean = { young_modulus = 1e5, poisson_ratio = 0.3 }\n\
        [[bodies]]\nname = \"ball\"\nmaterial = \"rubber\"\nshape.ball = { center = [0.5, 0.5], radius = 0.2 }\n\
        velocity = [5, 0]\n";
    workplace.write("scene.toml", scene);
    let ran = workplace.run(&["run", "scene.toml"]);
    assert_eq!(ran.code, Some(0), "{}{}", ran.stdout, ran.stderr);
    assert!(!workplace.path("scene.results/picture.png").exists());
}

/// Files and folders below a path, by their names from there.
fn below(path: &std::path::Path) -> std::collections::BTreeSet<String> {
    let mut found = std::collections::BTreeSet::new();
    let mut open = vec![path.to_path_buf()];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder).unwrap().flatten() {
            found.insert(entry.path().strip_prefix(path).unwrap().display().to_string());
            if entry.path().is_dir() {
                open.push(entry.path());
            }
        }
    }
    found
}

/// A scene in which everything that has a name has that of a place outside.
const ELSEWHERE: &str = r#"
title = "TOP {word}"
gravity = [0, -10]
space = { dimension = "plane-strain", interior = "grid", cell = 0.25 }
time.end = 0.01
parameters = { word = "w" }
[materials."TOP"]
density = 1000
neo_hookean = { young_modulus = 1e5, poisson_ratio = 0.3 }
[[bodies]]
name = "TOP/a"
material = "TOP"
shape.ball = { center = [0, 0.5], radius = 0.5 }
[[bodies]]
name = "TOP/b"
material = "TOP"
shape.box = { min = [2, 0], max = [2.5, 1] }
rigid.free = {}
[[packings]]
name = "TOP/p"
material = "TOP"
count = 1
shape.ball = { center = [0, 0], radius = 0.5 }
within.box = { min = [3, 0], max = [5, 2] }
[[images]]
name = "TOP/i"
file = "labels.png"
pixel = 0.25
origin = [6, 0]
material = "TOP"
[[joints]]
name = "TOP/j"
body = "TOP/b"
hinge = { point = [2.2, 0.5] }
[[supports]]
name = "TOP/s"
body = "TOP/a"
on = "y_min"
[[loads]]
name = "TOP/l"
body = "TOP/a"
on = "y_max"
force = [0, -1]
[[references]]
body = "TOP/a"
quantity = "y"
value = 0.5
label = "TOP/r"
[outputs]
particles = 0.005
grid = 0.005
samples = 0.001
checkpoints = 0.005
[outputs.fringes]
interval = 0.005
stress_parameter = 1e3
width = 40
[[outputs.sections]]
name = "TOP/c"
point = [0, 0.5]
normal = [0, 1]
[[outputs.probes]]
name = "TOP/o"
at = [0, 0.5]
fixed_in = "material"
[[outputs.arrivals]]
quantity = "speed"
threshold = 1e-3
bodies = ["TOP/a"]
[[outputs.fronts]]
name = "TOP/f"
quantity = "speed"
threshold = 1e-3
from = [0, 1]
direction = [0, -1]
bodies = ["TOP/a"]
"#;

#[test]
fn nothing_that_a_scene_names_is_written_outside_its_results() {
    let workplace = Workplace::new();
    fs::create_dir_all(workplace.path("in/side")).unwrap();
    let labels = fs::File::create(workplace.path("in/side/labels.png")).unwrap();
    let mut encoder = png::Encoder::new(labels, 4, 4);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.write_header().unwrap().write_image_data(&[7; 16]).unwrap();
    let absolute = workplace.path("absolute").display().to_string();
    // Further ways up take the same paths; one is enough for a test that always runs.
    for (number, outside) in ["../../out", &absolute].iter().enumerate() {
        let (scene, results) = (format!("in/side/{number}.toml"), format!("in/side/{number}.results"));
        let text = ELSEWHERE.replace("TOP", outside);
        workplace.write(&scene, &text);
        let mut expected = below(&workplace.path(""));
        workplace.succeed(&["run", &scene, "--out", &results]);
        for words in [&["render", &results][..], &["plot", &results]] {
            workplace.succeed(words);
        }
        workplace.succeed(&["render", &results, "--all"]);
        workplace.succeed(&["view", &results, "--html", &format!("{results}/view.html")]);
        let swept = format!("word=\"{outside}/x\",\"{outside}/y\"");
        let sweep = format!("in/side/{number}.sweep");
        workplace.succeed(&["sweep", &scene, "--set", &swept, "--out", &sweep]);
        expected.extend([results.clone(), sweep.clone()]);
        let mut found = below(&workplace.path(""));
        found.retain(|path| ![&results, &sweep].iter().any(|folder| path.starts_with(&format!("{folder}/"))));
        assert_eq!(found, expected);
        // What is there has fixed names, or numbers.
        let named = below(&workplace.path(&results));
        let stranger = named.iter().find(|path| path.contains("out") || path.contains("absolute"));
        assert_eq!(stranger, None);
        for table in ["bodies.csv", "fringes.png", "probes.csv", "sections.csv", "joints.csv", "loads.csv"] {
            assert!(named.contains(table), "{table}: {named:?}");
        }
    }
}

#[test]
fn colours_of_what_no_law_remembers_are_refused() {
    let workplace = workplace();
    assert_eq!(run(&workplace, &[]).code, Some(0));
    refused(&workplace.run(&["render", "scene.results", "--color", "plastic_strain"]), "plastic_strain");
}

/// A body that jumps out of all that the grid can number, where there is no domain that could be larger.
#[test]
fn a_scene_without_a_domain_is_not_told_to_make_it_larger() {
    let workplace = workplace();
    let scene = new_scene();
    let domain = scene.lines().find(|line| line.starts_with("domain = ")).unwrap();
    let bar = scene.lines().find(|line| line.contains("\"7 * radius\", 0")).unwrap();
    let thrown = format!("{bar}\nrigid = {{ displacement = [0, \"if(t < 1 ms, 0, -1e9 m)\"] }}");
    let scene = scene.replace(domain, "").replace(bar, &thrown);
    workplace.write("scene.toml", &scene);
    let ran = run(&workplace, &[]);
    assert_eq!(ran.code, Some(1), "{}{}", ran.stdout, ran.stderr);
    assert!(!ran.stderr.contains("make the domain larger"), "{}", ran.stderr);
    assert!(ran.stderr.contains("give the scene a domain"), "{}", ran.stderr);
}

/// Intervals shorter than a step are those of every step, and the first signal ends the run.
#[test]
#[cfg(unix)]
fn an_interval_of_nothing_neither_hangs_nor_holds_a_run_that_is_to_end() {
    let workplace = workplace();
    let shortest = ["--set", "outputs.tables=1e-300", "--set", "time.end=9"];
    let mut child = (workplace.command(&[&["run", "scene.toml"][..], &QUICK[..2], &shortest].concat()))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    let rows = || {
        fs::read_to_string(workplace.path("scene.results/energy.csv")).map_or(0, |text| text.lines().count())
    };
    while rows() < 20 {
        assert!(begun.elapsed() < Duration::from_secs(60) && child.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(2));
    }
    let pid = child.id().to_string();
    assert!(std::process::Command::new("kill").args(["-s", "INT", &pid]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
}

/// A limit on the length of files leaves none that is cut.
#[test]
#[cfg(target_os = "linux")]
fn a_picture_that_finds_no_space_is_not_there() {
    let workplace = workplace();
    assert_eq!(run(&workplace, &[]).code, Some(0));
    let program = workplace.command(&[]).get_program().to_str().unwrap().to_owned();
    for (command, name) in [("render", "picture.png"), ("plot", "plot.svg")] {
        // Blocks of 1024 bytes.
        let line = format!("ulimit -f 1; exec '{program}' {command} scene.results --out {name}");
        let ran = std::process::Command::new("bash")
            .args(["-c", &line])
            .current_dir(workplace.path(""))
            .output()
            .unwrap();
        let said = String::from_utf8(ran.stderr).unwrap();
        if workplace.path(name).exists() {
            assert!(fs::metadata(workplace.path(name)).unwrap().len() <= 1024, "{command}: {said}");
            continue;
        }
        assert_eq!(ran.status.code(), Some(1), "{command}: {said}");
        assert!(said.contains(name) && said.contains("File too large"), "{command}: {said}");
    }
    assert!(!workplace.path("picture.png").exists());
    let names = fs::read_dir(workplace.path("")).unwrap().map(|entry| entry.unwrap().file_name());
    assert!(names.into_iter().all(|name| !name.to_string_lossy().ends_with(".part")));
}

/// Files are made under names that nobody has: one that is called so, or a link, is the user's.
#[test]
#[cfg(unix)]
fn files_that_are_called_like_a_part_stay_and_links_are_not_followed() {
    use std::os::unix::fs::symlink;
    let workplace = workplace();
    assert_eq!(run(&workplace, &[]).code, Some(0));
    workplace.write("target", "victim");
    for (command, name) in [
        (&["render"][..], "picture.png"),
        (&["plot"], "plot.svg"),
        (&["view", "--html"], "page.html"),
        (&["render", "--animate"], "film.gif"),
    ] {
        let beside = workplace.path(&format!("{name}.part"));
        let words = match command {
            ["view", html] => vec!["view", "scene.results", html, name],
            _ => [&command[..1], &["scene.results", "--out", name], &command[1..]].concat(),
        };
        for is_link in [false, true] {
            if is_link {
                fs::remove_file(&beside).unwrap();
                symlink(workplace.path("target"), &beside).unwrap();
            } else {
                fs::write(&beside, "precious").unwrap();
            }
            let ran = workplace.run(&words);
            assert_eq!(ran.code, Some(0), "{words:?}: {}", ran.stderr);
            assert!(fs::symlink_metadata(workplace.path(name)).unwrap().is_file());
            assert_eq!(fs::read_to_string(&beside).unwrap(), if is_link { "victim" } else { "precious" });
            assert_eq!(beside.is_symlink(), is_link);
        }
        // A link of the name itself, to nowhere or to somebody's.
        fs::remove_file(workplace.path(name)).unwrap();
        symlink(workplace.path("nowhere"), workplace.path(name)).unwrap();
        assert_eq!(workplace.run(&words).code, Some(0), "{words:?}");
        assert!(!workplace.path("nowhere").exists(), "{name}");
    }
    assert_eq!(fs::read_to_string(workplace.path("target")).unwrap(), "victim");
}

/// A folder of somebody's, reached by a link among results, is neither cleared nor written to.
#[test]
#[cfg(unix)]
fn links_among_results_are_refused() {
    let workplace = workplace();
    fs::create_dir(workplace.path("elsewhere")).unwrap();
    workplace.write("elsewhere/00000.vtu", "mine");
    assert_eq!(run(&workplace, &[]).code, Some(0));
    fs::remove_dir_all(workplace.path("scene.results/particles")).unwrap();
    std::os::unix::fs::symlink("../elsewhere", workplace.path("scene.results/particles")).unwrap();
    refused(&run(&workplace, &[]), "particles is a link");
    refused(&run(&workplace, &["--overwrite"]), "particles is a link");
    refused(&workplace.run(&["resume", "scene.results", "--until", "30 ms"]), "particles is a link");
    assert_eq!(fs::read_to_string(workplace.path("elsewhere/00000.vtu")).unwrap(), "mine");
    assert_eq!(fs::read_dir(workplace.path("elsewhere")).unwrap().count(), 1);
    // The whole folder may be one.
    std::os::unix::fs::symlink("elsewhere", workplace.path("linked")).unwrap();
    fs::remove_file(workplace.path("elsewhere/00000.vtu")).unwrap();
    assert_eq!(run(&workplace, &["--out", "linked"]).code, Some(0));
}

/// Of a run, and of a sweep, before its record is whole: what is left is no reason to refuse a folder.
#[test]
fn a_kill_inside_the_first_record_leaves_a_folder_that_is_used() {
    let workplace = workplace();
    for (left, words) in [
        ("run.json.0a1b2c3d.part", &["run", "scene.toml", "--out", "out"][..]),
        ("sweep.json.0a1b2c3d.part", &["sweep", "scene.toml", "--out", "out", "--set", "friction=0.2,0.3"]),
    ] {
        for more in [&[][..], &["--overwrite"]] {
            let _ = fs::remove_dir_all(workplace.path("out"));
            fs::create_dir(workplace.path("out")).unwrap();
            workplace.write(&format!("out/{left}"), "{\"program\": \"sti");
            if words[0] == "run" {
                // Which scene it was, nobody knows.
                refused(&workplace.run(&["resume", "out"]), "run.json");
            } else if !more.is_empty() {
                continue;
            }
            let ran = workplace.run(&[words, more, &QUICK].concat());
            assert_eq!(ran.code, Some(0), "{left}: {}", ran.stderr);
            assert!(!workplace.path(&format!("out/{left}")).exists());
        }
    }
    // What is somebody else's still is.
    fs::create_dir(workplace.path("mine")).unwrap();
    workplace.write("mine/run.json.0a1b2c3d.part", "{");
    workplace.write("mine/thesis.tex", "years of work");
    refused(&run(&workplace, &["--out", "mine"]), "thesis.tex");
}
