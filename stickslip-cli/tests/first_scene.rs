//! From `stickslip new` to numbers and pictures, as a new user goes.

mod stickslip;

use std::fs;
use std::time::{Duration, Instant};
use stickslip::{Workplace, new_scene};

/// The new scene, coarse and short: what a test needs of it.
const QUICK: [&str; 4] = ["--set", "cells_per_radius=4", "--set", "friction=0.3"];

#[test]
fn shells_complete_and_man_has_pages() {
    let workplace = Workplace::new();
    for shell in ["bash", "zsh", "fish"] {
        let script = workplace.succeed(&["completions", shell]);
        assert!(script.contains("checkpoint-every") && script.contains("validate"), "{shell}");
    }
    let refused = workplace.run(&["completions", "tcsh"]);
    assert!(refused.code == Some(2) && refused.stderr.contains("bash"), "{}", refused.stderr);
    workplace.succeed(&["manual", "pages"]);
    let page = std::fs::read_to_string(workplace.path("pages/stickslip-run.1")).unwrap();
    assert!(page.contains("checkpoint") && workplace.path("pages/stickslip.1").exists());
    // Its own are made anew; another's stay.
    workplace.succeed(&["manual", "pages"]);
    workplace.write("pages/stickslip-run.1", ".ie \\n(.g .ds Aq \\(aq\n.TH runner 1\n");
    let refused = workplace.run(&["manual", "pages"]);
    assert_eq!(refused.code, Some(2));
    assert!(refused.stderr.contains("stickslip-run.1: it is there already"), "{}", refused.stderr);
}

#[test]
fn the_schema_is_json() {
    let schema = Workplace::new().succeed(&["schema"]);
    let schema: serde_json::Value = serde_json::from_str(&schema).unwrap();
    assert!(schema["properties"]["bodies"].is_object());
}

#[test]
fn check_counts_particles() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let report = workplace.succeed(&["check", "scene.toml"]);
    assert!(report.contains("disk") && report.contains("bar") && report.contains("particles"), "{report}");
    assert!(!workplace.path("scene.results").exists());
}

#[test]
fn run_render_and_plot_leave_numbers_and_pictures() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let summary = workplace.succeed(&[&["run", "scene.toml"][..], &QUICK].concat());
    assert!(summary.contains("A soft disk") && summary.contains("finished"), "{summary}");
    for file in
        ["bodies.csv", "energy.csv", "contacts.csv", "run.json", "particles.pvd", "plot.png", "picture.png"]
    {
        assert!(workplace.path("scene.results").join(file).metadata().unwrap().len() > 0, "{file}");
    }
    workplace.succeed(&["render", "scene.results", "--frame", "0", "--color", "pressure", "--out", "p.png"]);
    workplace.succeed(&["render", "scene.results", "--all", "--size", "400x300", "--out", "all"]);
    workplace.succeed(&["plot", "scene.results", "--body", "disk", "--quantity", "x,vx", "--out", "p.svg"]);
    assert_eq!(&fs::read(workplace.path("p.png")).unwrap()[1..4], b"PNG");
    assert!(fs::read_to_string(workplace.path("p.svg")).unwrap().contains("disk vx"));
    assert!(fs::read_dir(workplace.path("all")).unwrap().count() >= 20);

    let missing = workplace.run(&["render", "scene.results", "--frame", "9999"]);
    assert_eq!(missing.code, Some(2));
    assert!(missing.stderr.contains("allowed: 0 to"), "{}", missing.stderr);
    let unknown = workplace.run(&["plot", "scene.results", "--body", "disc"]);
    assert_eq!(unknown.code, Some(2));
    assert!(unknown.stderr.contains("disk"), "{}", unknown.stderr);
}

#[test]
fn fringes_and_animations_come_from_a_run_and_from_its_snapshots() {
    let workplace = Workplace::new();
    workplace.write(
        "scene.toml",
        &format!(
            "{}\n[outputs.fringes]\ninterval = \"50 ms\"\nexposure = \"10 ms\"\nstress_parameter = \"2 kPa\"\nwidth = 200\noverlay = \"force-chains\"\n",
            new_scene()
        ),
    );
    let short = ["--set", "time.end=0.3 s", "--set", "outputs.particles=60 ms"];
    let said = workplace.succeed(&[&["run", "scene.toml"][..], &QUICK, &short].concat());
    assert!(said.contains("fringes.png"), "{said}");
    let frames = fs::read_dir(workplace.path("scene.results").join("fringes")).unwrap().count();
    assert_eq!(frames, 6);

    let count = |file: &str| {
        let file = fs::read(workplace.path(file)).unwrap();
        let control = file.windows(4).position(|name| name == b"acTL").unwrap() + 4;
        u32::from_be_bytes(file[control..control + 4].try_into().unwrap())
    };
    assert_eq!(count("scene.results/fringes.png"), 6);
    let render = |flags: &[&str]| workplace.succeed(&[&["render", "scene.results"], flags].concat());
    render(&["--animate", "--rate", "4", "--size", "300x200"]);
    assert_eq!(count("scene.results/animation.png"), 6);
    let said = render(&["--fringes", "--animate", "--size", "300x200"]);
    assert!(said.contains("stress parameter 2.0000e3 Pa"), "as in the scene: {said}");
    assert_eq!(count("scene.results/fringes_animation.png"), 6);
    let said =
        render(&["--fringes", "--stress-optic-coefficient", "5e-9", "--thickness", "0.02", "--out", "f.png"]);
    assert!(said.contains("a fringe is 5.4610e3 Pa"), "{said}");
    assert_eq!(&fs::read(workplace.path("f.png")).unwrap()[1..4], b"PNG");

    for (flags, allowed) in [
        (&["--fringes", "--stress-optic-coefficient", "5e-9"][..], "--thickness"),
        (&["--fringes", "--bodies", "disc"], "disk"),
        (&["--fringes", "--stress-parameter", "0"], "above 0"),
        (&["--fringes", "--light", "gray"], "grey"),
        (&["--light", "grey"], "--fringes"),
        (&["--fringes", "--color", "pressure"], "--color"),
    ] {
        let ran = workplace.run(&[&["render", "scene.results"], flags].concat());
        assert_eq!(ran.code, Some(2), "{flags:?}");
        assert!(ran.stderr.contains(allowed), "{flags:?}: {}", ran.stderr);
    }
}

#[test]
fn tables_do_not_depend_on_the_number_of_threads() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let tables = ["1", "2"].map(|threads| {
        let out = format!("{threads}.results");
        let arguments = ["run", "scene.toml", "--threads", threads, "--out", &out];
        workplace.succeed(&[&arguments[..], &QUICK].concat());
        fs::read(workplace.path(&out).join("bodies.csv")).unwrap()
    });
    assert_eq!(tables[0], tables[1]);
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_run_cleanly() {
    let workplace = Workplace::new();
    // Long enough that it is still running when the signal comes, on any machine.
    workplace.write("scene.toml", &new_scene().replace("\"0.5 s\"", "\"1000 s\""));
    let mut run = workplace.command(&["run", "scene.toml"]).spawn().unwrap();
    let table = workplace.path("scene.results").join("bodies.csv");
    let give_up = Instant::now() + Duration::from_secs(60);
    while !table.exists() {
        assert!(Instant::now() < give_up, "the run does not start");
        std::thread::sleep(Duration::from_millis(50));
    }
    let killed = std::process::Command::new("kill").args(["-INT", &run.id().to_string()]).status().unwrap();
    assert!(killed.success());
    assert_eq!(run.wait().unwrap().code(), Some(130));
    let record = fs::read(workplace.path("scene.results").join("run.json")).unwrap();
    let record: serde_json::Value = serde_json::from_slice(&record).unwrap();
    assert_eq!(record["status"], "interrupted");
    workplace.succeed(&["render", "scene.results"]);
    workplace.succeed(&["plot", "scene.results"]);
}

#[test]
fn doubtful_results_are_told_and_with_strict_are_an_error() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    // No run keeps its energy as exactly as that.
    let short = ["--set", "time.end=50 ms", "--set", "time.energy_drift=1e-9", "--set", "cells_per_radius=2"];
    let run = |flags: &[&str]| workplace.run(&[&["run", "scene.toml"][..], &short, flags].concat());
    let lax = run(&[]);
    assert_eq!(lax.code, Some(0), "{}", lax.stderr);
    assert!(lax.stderr.contains("warning: energy "), "{}", lax.stderr);
    assert!(lax.stdout.contains("  warning    from t = "), "{}", lax.stdout);
    let strict = run(&["--strict"]);
    assert_eq!(strict.code, Some(3), "{}", strict.stderr);
    assert!(strict.stderr.contains("error: the results are doubtful: "), "{}", strict.stderr);
    let record = fs::read(workplace.path("scene.results").join("run.json")).unwrap();
    let record: serde_json::Value = serde_json::from_slice(&record).unwrap();
    assert_eq!(record["status"], "finished");
    let warnings = record["warnings"].as_array().unwrap();
    let energy = warnings.iter().find(|warning| warning["kind"] == "energy").unwrap();
    assert!(energy["worst"].as_f64().unwrap().abs() > 1e-9 && energy["time"].as_f64().unwrap() <= 0.05);
    assert!(energy["count"].as_u64().unwrap() > 0 && energy["body"].is_null());
    assert!(energy["message"].is_string() && energy["advice"].is_string(), "{energy}");

    let sound = ["--set", "time.end=50 ms", "--set", "cells_per_radius=4", "--strict"];
    let sound = workplace.run(&[&["run", "scene.toml"][..], &sound].concat());
    assert_eq!(sound.code, Some(0), "{} {}", sound.stdout, sound.stderr);
}

/// 200 disks of 118 particles, which fall and lie for 0.15 s, leave at most 13 MB in a run that asks for no outputs:
/// its pictures, its record and the checkpoint at its end included.
#[test]
fn two_hundred_disks_leave_thirteen_megabytes() {
    let workplace = Workplace::new();
    workplace.write(
        "disks.toml",
        r#"
gravity = [0, "-9.81 m/s^2"]
time.end = "0.15 s"
parameters = { radius = "5 mm", width = "20 cm" }
space = { dimension = "plane-strain", interior = "grid", cell = "radius / 2.77" }
materials.rubber = { density = "1000 kg/m^3", neo_hookean = { young_modulus = "25 kPa", poisson_ratio = 0.3 } }
contact = [{ friction = 0.3 }]

[[packings]]
name = "disk"
material = "rubber"
shape.ball = { center = [0, 0], radius = "radius" }
within.box = { min = [0, 0], max = ["width", "16 cm"] }
count = 200

[[bodies]]
name = "walls"
material = "rubber"
rigid = {}
shape.union = [
    { half_space = { point = [0, 0], normal = [0, 1] } },
    { half_space = { point = [0, 0], normal = [1, 0] } },
    { half_space = { point = ["width", 0], normal = [-1, 0] } },
]
"#,
    );
    workplace.succeed(&["run", "disks.toml"]);
    let mut parts = std::collections::BTreeMap::<String, u64>::new();
    let mut folders = vec![workplace.path("disks.results")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap().map(Result::unwrap) {
            if entry.path().is_dir() {
                folders.push(entry.path());
                continue;
            }
            let kind = entry.path().extension().unwrap_or_default().to_string_lossy().into_owned();
            *parts.entry(kind).or_default() += entry.metadata().unwrap().len();
        }
    }
    let all: u64 = parts.values().sum();
    println!("{all} bytes: {parts:?}");
    let run: serde_json::Value =
        serde_json::from_slice(&fs::read(workplace.path("disks.results/run.json")).unwrap()).unwrap();
    // Those of the walls among them.
    assert!(run["performance"]["particles"].as_f64().unwrap() > 200.0 * 118.0);
    assert!(all <= 13_000_000, "{all} bytes: {parts:?}");
}
