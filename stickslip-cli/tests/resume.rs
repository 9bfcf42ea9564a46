//! `stickslip resume` as a user goes on: after a kill, a signal, a limit of time, and to a later end.

mod stickslip;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};
use stickslip::{Workplace, has_checkpoint, new_scene, outcome, record};

/// The new scene, so long that there is time to kill it.
const SETTINGS: [&str; 4] = ["--set", "time.end=0.9", "--set", "outputs.checkpoints=0.01"];
/// Cells in a radius of its disk.
const COARSE: &str = "cells_per_radius=4";
const FINE: &str = "cells_per_radius=14";

/// Numbers whose order nobody knows, the same in every run of the tests (Marsaglia 2003, xorshift).
struct Numbers(u64);

impl Numbers {
    /// From 0 to 1.
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 as f64 / u64::MAX as f64
    }
}

/// The run of the scene in a folder, or its resumption if there is something to go on from.
fn spawn(workplace: &Workplace, (folder, cells): (&str, &str), threads: usize) -> Child {
    let threads = threads.to_string();
    let arguments = match has_checkpoint(&workplace.path(folder)) {
        true => vec!["resume", folder, "--threads", &threads],
        false => {
            [&["run", "scene.toml", "--out", folder, "--threads", &threads, "--set", cells][..], &SETTINGS]
                .concat()
        }
    };
    workplace.command(&arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

/// The newest two checkpoints are kept, or as many as are asked for.
#[test]
fn as_many_checkpoints_are_kept_as_are_asked_for() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let run = ["run", "scene.toml", "--out", "out", "--set", COARSE, "--set", "outputs.checkpoints=0.01"];
    let kept = |more: &[&str]| {
        workplace.succeed(&[&run[..], more].concat());
        fs::read_dir(workplace.path("out/checkpoints")).unwrap().count()
    };
    assert_eq!([kept(&[]), kept(&["--keep-checkpoints", "4"])], [2, 4]);
    assert_eq!(workplace.run(&[&run[..], &["--keep-checkpoints", "0"]].concat()).code, Some(2));
}

/// When a run is killed.
#[derive(Clone, Copy)]
enum Instants {
    Any,
    /// While a file is written that has not its own name yet.
    InWrites,
}

/// Whether there is a file of a run that has not its own name yet.
fn writes(out: &Path) -> bool {
    let folders = ["checkpoints", "particles", "."].map(|name| fs::read_dir(out.join(name)));
    let mut entries = folders.into_iter().flatten().flatten().flatten();
    entries.any(|entry| entry.path().extension().is_some_and(|ending| ending == "part"))
}

/// Kills a run and what goes on from it, so often; then lets it end, and holds it against one that nobody killed. Gives
/// how many were killed inside a write.
fn chaos(kills: usize, cells: &str, instants: Instants) -> usize {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let begun = Instant::now();
    workplace.succeed(&[&["run", "scene.toml", "--out", "whole", "--set", cells][..], &SETTINGS].concat());
    let longest = begun.elapsed();
    let parts = workplace.path("parts");
    let mut numbers = Numbers(0x9e37_79b9_7f4a_7c15);
    let mut inside = 0;
    for kill in 0..kills {
        let mut child = spawn(&workplace, ("parts", cells), 1 + kill % 2);
        std::thread::sleep(longest.mul_f64(3.0 / kills as f64 * numbers.next()) + Duration::from_millis(30));
        if let Instants::InWrites = instants {
            while !writes(&parts) && child.try_wait().unwrap().is_none() {
                std::hint::spin_loop();
            }
        }
        child.kill().unwrap();
        child.wait().unwrap();
        inside += usize::from(writes(&parts));
    }
    assert!(spawn(&workplace, ("parts", cells), 2).wait().unwrap().success());
    assert!(!record(&parts)["resumed"].as_array().unwrap().is_empty());
    let [(whole, whole_sum), (parts_files, sum)] = [outcome(&workplace.path("whole")), outcome(&parts)];
    let all: BTreeSet<_> = whole.keys().chain(parts_files.keys()).collect();
    let differ: Vec<_> = all.into_iter().filter(|name| whole.get(*name) != parts_files.get(*name)).collect();
    assert!(differ.is_empty(), "{differ:?} differ after {kills} kills");
    assert_eq!(whole_sum, sum);
    assert!(!writes(&parts), "what was half-written is cleared");
    inside
}

#[test]
fn a_run_that_is_killed_again_and_again_ends_as_one_that_is_not() {
    chaos(10, COARSE, Instants::Any);
}

#[test]
#[ignore = "slow"]
fn a_run_that_is_killed_two_hundred_times_ends_as_one_that_is_not() {
    let inside = chaos(200, FINE, Instants::Any);
    println!("{inside} of 200 kills were inside a write");
}

#[test]
#[ignore = "slow"]
fn a_run_that_is_killed_a_hundred_times_while_it_writes_ends_as_one_that_is_not() {
    let inside = chaos(100, FINE, Instants::InWrites);
    println!("{inside} of 100 kills were inside a write");
    assert!(inside >= 5, "{inside} of 100");
}

/// Whether the tests run under `nohup`, whose children ignore hangups, too.
fn hangups_are_ignored() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask & 1 == 1)
}

#[test]
#[cfg(unix)]
fn a_run_that_is_asked_to_end_leaves_a_checkpoint_and_goes_on() {
    for signal in ["TERM", "HUP", "INT", "USR1", "USR2", "XCPU"] {
        if signal == "HUP" && hangups_are_ignored() {
            continue;
        }
        let workplace = Workplace::new();
        workplace.write("scene.toml", &new_scene());
        let child = spawn(&workplace, ("out", COARSE), 1);
        let out = workplace.path("out");
        let since = Instant::now();
        while !has_checkpoint(&out) {
            assert!(since.elapsed() < Duration::from_secs(60), "{signal}: no checkpoint");
            std::thread::sleep(Duration::from_millis(5));
        }
        let pid = child.id().to_string();
        assert!(std::process::Command::new("kill").args(["-s", signal, &pid]).status().unwrap().success());
        assert_eq!(child.wait_with_output().unwrap().status.code(), Some(130), "{signal}");
        assert_eq!(record(&out)["status"], "interrupted", "{signal}");
        assert!(out.join("picture.png").exists(), "{signal}");
        // To the end is too long for a test; the results of what was done are whole.
        workplace.succeed(&["check", "scene.toml"]);
        let limited = workplace.run(&["resume", "out", "--max-time", "100ms"]);
        assert_eq!(limited.code, Some(4), "{}", limited.stderr);
        assert!(limited.stdout.contains("go on with: stickslip resume out"), "{}", limited.stdout);
        assert_eq!(record(&out)["status"], "out_of_time");
    }
}

/// As `nohup` starts it: a terminal that closes does not end it.
#[test]
#[cfg(target_os = "linux")]
fn a_run_that_is_to_ignore_hangups_does() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let program = workplace.command(&[]).get_program().to_str().unwrap().to_owned();
    let line =
        format!("trap '' HUP; exec '{program}' run scene.toml --out out --set time.end=0.1 --set {COARSE}");
    let mut shell = std::process::Command::new("sh");
    shell.args(["-c", &line]).current_dir(workplace.path("")).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = shell.spawn().unwrap();
    let since = Instant::now();
    while !workplace.path("out/energy.csv").exists() {
        assert!(since.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(1));
    }
    let pid = child.id().to_string();
    let _ = std::process::Command::new("kill").args(["-s", "HUP", &pid]).status();
    assert!(child.wait().unwrap().success());
    assert_eq!(record(&workplace.path("out"))["status"], "finished");
}

#[test]
fn a_later_end_is_remembered_until_another_is_named() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    workplace.succeed(&["run", "scene.toml", "--set", COARSE, "--set", "time.end=0.02"]);
    let stopped = workplace.run(&["resume", "scene.results", "--until", "0.9 s", "--max-time", "20ms"]);
    assert_eq!(stopped.code, Some(4), "{}", stopped.stderr);
    let again = workplace.run(&["resume", "scene.results", "--max-time", "20ms"]);
    assert_eq!(again.code, Some(4), "{}", again.stderr);
    let nearer = workplace.run(&["resume", "scene.results", "--until", "0.3 s"]);
    assert_eq!(nearer.code, Some(0), "{}", nearer.stderr);
    assert!(nearer.stdout.contains("finished at t = 0.300000 s"), "{}", nearer.stdout);
}

#[test]
fn a_run_that_can_go_on_is_not_begun_anew_by_mistake() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let again = ["run", "scene.toml", "--set", COARSE, "--set", "time.end=0.9", "--max-time", "20ms"];
    assert_eq!(workplace.run(&again).code, Some(4));
    let refused = workplace.run(&again);
    assert_eq!(refused.code, Some(2));
    assert!(refused.stderr.contains("stickslip resume scene.results"), "{}", refused.stderr);
    assert_eq!(workplace.run(&["resume", "scene.results", "--max-time", "20ms"]).code, Some(4));
    assert_eq!(workplace.run(&[&again[..], &["--overwrite"]].concat()).code, Some(4));
}

/// A check stops it, as the scene asks; the same scene would go on, and another one begins anew.
#[test]
fn a_run_that_did_not_finish_stays_until_another_has() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let run = |more: &[&str]| {
        workplace.run(&[&["run", "scene.toml", "--set", "time.end=0.05", "--set"][..], more].concat())
    };
    let stops = ["--set", "health.speed={ then = 'stop', bound = 1e-9 }"];
    let stopped = run(&[&[COARSE][..], &stops].concat());
    assert_eq!(stopped.code, Some(1), "{}", stopped.stderr);
    let out = workplace.path("scene.results");
    let before = fs::read(out.join("energy.csv")).unwrap();
    assert_eq!((&record(&out)["status"], has_checkpoint(&out)), (&"stopped".into(), true));
    // Health is no physics: resumed with another, the run goes on.
    let refused = run(&[COARSE]);
    assert_eq!(refused.code, Some(2), "{}", refused.stderr);
    assert!(refused.stderr.contains("stickslip resume scene.results"), "{}", refused.stderr);
    assert_eq!(fs::read(out.join("energy.csv")).unwrap(), before);

    let changed = run(&[&["cells_per_radius=5"][..], &stops].concat());
    assert_eq!(changed.code, Some(1), "{}", changed.stderr);
    assert!(changed.stderr.contains("unfinished"), "{}", changed.stderr);
    let kept = out.join("unfinished");
    assert!(fs::read(kept.join("energy.csv")).unwrap() == before && has_checkpoint(&kept));
    let finished = run(&[COARSE, "--overwrite"]);
    assert_eq!(finished.code, Some(0), "{}", finished.stderr);
    assert!(!kept.exists());
    assert_eq!(run(&[COARSE]).code, Some(0), "a finished run is no reason to ask");
}

/// Disks that were let fall into a box, and are stirred by its floor.
const PACKING: &str = r#"
gravity = [0, "-9.81 m/s^2"]
[space]
dimension = "plane-strain"
interior = "grid"
cell = "2 mm"
[time]
end = "25 ms"
[materials.rubber]
density = "1100 kg/m^3"
neo_hookean = { young_modulus = "100 kPa", poisson_ratio = 0.4 }
[[packings]]
name = "disk"
material = "rubber"
shape.ball = { center = [0, 0], radius = "5 mm" }
sizes.numbers = [[1, 1], [1.4, 1]]
within.box = { min = [0, 0], max = ["6 cm", "9 cm"] }
count = 24
settle = [0, -1]
[[bodies]]
name = "walls"
material = "rubber"
shape.union = [
    { half_space = { point = [0, 0], normal = [0, 1] } },
    { half_space = { point = [0, 0], normal = [1, 0] } },
    { half_space = { point = ["6 cm", 0], normal = [-1, 0] } },
]
rigid = { velocity = [0, "0.1 * sin(500 * t)"] }
[[contact]]
between = ["disk *", "any"]
friction = 0.3
[outputs]
tables = "1 ms"
checkpoints = "1 ms"
"#;

/// Made, killed, gone on with, and the beginning of another scene.
#[test]
fn a_settled_packing_outlives_a_kill_and_begins_another_scene() {
    let workplace = Workplace::new();
    workplace.write("packing.toml", PACKING);
    workplace.succeed(&["run", "packing.toml", "--out", "whole"]);
    let mut child = workplace.command(&["run", "packing.toml", "--out", "parts"]);
    let mut child = child.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let parts = workplace.path("parts");
    let since = Instant::now();
    while !has_checkpoint(&parts) {
        assert!(since.elapsed() < Duration::from_secs(60), "no checkpoint");
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(record(&parts)["status"], "running", "killed before its end");
    workplace.succeed(&["resume", "parts"]);
    assert_eq!(record(&parts)["resumed"].as_array().unwrap().len(), 1);
    assert!(outcome(&workplace.path("whole")) == outcome(&parts));

    let stamp = "[[bodies]]\nname = \"stamp\"\nmaterial = \"rubber\"\n\
        shape.box = { min = [\"1 cm\", \"9 cm\"], max = [\"5 cm\", \"10 cm\"] }\n[start]\nfrom = \"parts\"\n";
    workplace.write("pressed.toml", &(PACKING.to_owned() + stamp));
    let pressed = workplace.run(&["run", "pressed.toml", "--set", "time.end=2 ms"]);
    assert_eq!(pressed.code, Some(0), "{}", pressed.stderr);
    assert!(
        pressed.stderr.contains("25 of 26 bodies begin as they were at t = 0.025 s"),
        "{}",
        pressed.stderr
    );
}

/// From the scene of a run that settled: what is new and what is left out is told before the run.
#[test]
fn check_says_what_begins_from_another_run_and_refuses_what_the_run_would() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    workplace.succeed(&["run", "scene.toml", "--set", COARSE, "--set", "time.end=0.05", "--out", "first"]);
    let start = "\n[start]\nfrom = \"first\"\n";
    workplace.write("second.toml", &(new_scene() + start));
    let report = workplace.succeed(&["check", "second.toml", "--set", COARSE]);
    assert!(
        report.contains("2 of 2 bodies begin as they were at t = 0.05 s in first/checkpoints"),
        "{report}"
    );
    let renamed = new_scene().replace("\"bar\"", "\"rod\"") + start;
    workplace.write("second.toml", &renamed);
    let report = workplace.succeed(&["check", "second.toml", "--set", COARSE]);
    assert!(report.contains("new         `rod`") && report.contains("left out    `bar`"), "{report}");
    let finer = workplace.run(&["check", "second.toml", "--set", "cells_per_radius=5"]);
    assert_eq!(finer.code, Some(2), "{}", finer.stdout);
    assert!(finer.stderr.contains("cannot begin from first"), "{}", finer.stderr);
    let ran = workplace.run(&["run", "second.toml", "--set", COARSE, "--set", "time.end=0.01"]);
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    assert!(ran.stderr.contains("1 of 2 bodies begin"), "{}", ran.stderr);
}

#[test]
fn a_run_without_checkpoints_has_nothing_to_go_on_from() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let settings = ["--set", COARSE, "--set", "time.end=0.02", "--checkpoint-every", "never"];
    workplace.succeed(&[&["run", "scene.toml"][..], &settings].concat());
    let ran = workplace.run(&["resume", "scene.results", "--until", "0.04"]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.stderr.contains("finished without a checkpoint"), "{}", ran.stderr);
    let foreign = workplace.run(&["resume", "."]);
    assert_eq!(foreign.code, Some(2));
    assert!(foreign.stderr.contains("run.json"), "{}", foreign.stderr);
}

#[test]
fn a_run_that_is_made_again_ends_in_the_same_bits_or_says_that_it_does_not() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    workplace.succeed(&["run", "scene.toml", "--set", COARSE, "--set", "time.end=0.05", "--threads", "1"]);
    let again = workplace.succeed(&["run", "--again", "scene.results", "--threads", "2"]);
    let sum = record(&workplace.path("scene.results"))["state_sum"].as_str().unwrap().to_owned();
    assert!(again.contains(&format!("the same bits as scene.results: {sum}")), "{again}");
    assert_eq!(record(&workplace.path("scene.results.again"))["state_sum"], sum);

    // A record of other bits, as another version of the program may have made.
    let path = workplace.path("scene.results/run.json");
    let whole = fs::read_to_string(&path).unwrap();
    fs::write(&path, whole.replace(&sum, &sum.replace(['0', '1', '2', '3'], "f"))).unwrap();
    let differs = workplace.run(&["run", "--again", "scene.results", "--out", "third"]);
    assert_eq!(differs.code, Some(3));
    assert!(differs.stdout.contains("other bits than scene.results"), "{}", differs.stdout);
    workplace.write("scene.toml", &new_scene().replace("friction = 0.3\n", "friction = 0.4\n"));
    let text = fs::read_to_string(workplace.path("scene.toml")).unwrap();
    assert!(text != new_scene(), "the scene has such a line");
    fs::write(&path, &whole).unwrap();
    // What was run is run again, whatever became of its file.
    for changed in ["scene.toml has changed since", "scene.toml cannot be read any more"] {
        let again = workplace.run(&["run", "--again", "scene.results"]);
        assert_eq!(again.code, Some(0), "{}", again.stderr);
        assert!(again.stderr.contains(changed), "{}", again.stderr);
        assert!(again.stdout.contains(&format!("the same bits as scene.results: {sum}")), "{}", again.stdout);
        let _ = fs::remove_file(workplace.path("scene.toml"));
    }
    assert_eq!(workplace.run(&["run"]).code, Some(2));

    // Without the text in the record its file counts.
    let mut without: serde_json::Value = serde_json::from_str(&whole).unwrap();
    without["source"].as_object_mut().unwrap().remove("text").unwrap();
    fs::write(&path, without.to_string()).unwrap();
    assert_eq!(workplace.run(&["run", "--again", "scene.results"]).code, Some(2));
    workplace.write("scene.toml", &text);
    let changed = workplace.run(&["run", "--again", "scene.results"]);
    assert_eq!(changed.code, Some(2), "{}", changed.stderr);
    assert!(changed.stderr.contains("was made with another scene"), "{}", changed.stderr);
}

#[test]
fn a_run_without_checkpoints_says_in_which_bits_it_ended() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let run = ["run", "scene.toml", "--set", COARSE, "--set", "time.end=0.02"];
    workplace.succeed(&[&run[..], &["--out", "with"]].concat());
    workplace.succeed(&[&run[..], &["--out", "without", "--checkpoint-every", "never"]].concat());
    assert!(has_checkpoint(&workplace.path("with")) && !has_checkpoint(&workplace.path("without")));
    let [with, without] = ["with", "without"].map(|out| record(&workplace.path(out))["state_sum"].clone());
    assert!(with.is_string() && with == without, "{with} {without}");
    assert!(workplace.succeed(&["run", "--again", "without"]).contains("the same bits as without"));
}

#[test]
fn a_finished_run_goes_on_to_a_later_end() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let settings = ["--set", "cells_per_radius=4", "--set", "time.end=20 ms"];
    workplace.succeed(&[&["run", "scene.toml"][..], &settings].concat());
    let rows = || fs::read_to_string(workplace.path("scene.results/energy.csv")).unwrap().lines().count();
    let before = rows();
    let summary = workplace.succeed(&["resume", "scene.results", "--until", "0.04 s"]);
    assert!(summary.contains("t = 0.040000 s"), "{summary}");
    assert!(rows() > before + 8, "{} rows after {before}", rows());

    let past = workplace.run(&["resume", "scene.results", "--until", "10 ms"]);
    assert_eq!(past.code, Some(2));
    assert!(past.stderr.contains("past its new end"), "{}", past.stderr);
    let twice = workplace.succeed(&["resume", "scene.results", "--until", "0.05 s"]);
    assert!(twice.contains("t = 0.050000 s"), "{twice}");
    // Its steps ended at 20 ms and at 40 ms, and do so again.
    let again = workplace.succeed(&["run", "--again", "scene.results"]);
    assert!(again.contains("the same bits as scene.results"), "{again}");
    let ends = &record(&workplace.path("scene.results"))["ends"];
    assert_eq!(ends.as_array().map(Vec::len), Some(2), "{ends}");

    let wrong = workplace.run(&["resume", "scene.results", "--until", "soon"]);
    assert_eq!(wrong.code, Some(2));
    assert!(wrong.stderr.contains("soon"), "{}", wrong.stderr);
    let nothing = workplace.run(&["resume", "elsewhere"]);
    assert_eq!(nothing.code, Some(2));

    // A scene that was changed since is told by its key; one that has gone is taken as it was run.
    let scene = new_scene();
    workplace
        .write("scene.toml", &scene.replacen("density = ", "density = 2 * ", 1).replace("2 * \"", "\"2 * "));
    let changed = workplace.run(&["resume", "scene.results", "--until", "55 ms"]);
    assert_eq!(changed.code, Some(2), "{}", changed.stderr);
    assert!(changed.stderr.contains("density") || changed.stderr.contains("materials"), "{}", changed.stderr);
    fs::remove_file(workplace.path("scene.toml")).unwrap();
    let gone = workplace.run(&["resume", "scene.results", "--until", "55 ms"]);
    assert_eq!(gone.code, Some(0), "{}", gone.stderr);
    assert!(gone.stderr.contains("scene.toml is not there; the run goes on"), "{}", gone.stderr);
    let unknown = workplace.run(&["resume", "scene.results", "--until", "60 ms", "--scene", "moved.toml"]);
    assert_eq!(unknown.code, Some(2));
    assert!(unknown.stderr.contains("moved.toml is not there"), "{}", unknown.stderr);
    workplace.write("moved.toml", &scene);
    workplace.succeed(&["resume", "scene.results", "--until", "60 ms", "--scene", "moved.toml"]);
}
