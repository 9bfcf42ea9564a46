//! Several processes that share a run, by MPI: the files of one, an end that is told once, and runs that go on after a
//! process was killed, with another number of them.
//!
//! Needs `mpirun`, and a program that was built with the feature `mpi`.

mod stickslip;

use std::collections::BTreeMap;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use stickslip::{LONG, Ran, SHORT, Workplace, new_scene, outcome, ranks, record, with, with_results};

/// So many processes of the program with these words, on as few processors as there are.
fn together(workplace: &Workplace, count: usize, words: &[&str]) -> Command {
    let mut command = Command::new("mpirun");
    command.args(["--oversubscribe", "--bind-to", "none", "-n", &count.to_string()]);
    command.args([env!("CARGO_BIN_EXE_stickslip")]).args(words).current_dir(workplace.path(""));
    // Containers have no other user.
    command.envs([("OMPI_ALLOW_RUN_AS_ROOT", "1"), ("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")]);
    command
}

fn run(workplace: &Workplace, count: usize, words: &[&str]) -> Ran {
    let output =
        together(workplace, count, words).output().expect("mpirun is there: apt install openmpi-bin");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    Ran { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
}

/// Every file has the bytes of one process's; the summary and the balance are told once.
#[test]
fn processes_write_what_one_writes() {
    let workplace = with_results(&SHORT);
    for count in [2, 3] {
        let out = count.to_string();
        let ran = run(&workplace, count, &with(&["run", "scene.toml", "--verbose", "--out", &out], &SHORT));
        assert_eq!(ran.code, Some(0), "{}", ran.stderr);
        assert_eq!(ran.stdout.matches("finished at t =").count(), 1, "{}", ran.stdout);
        assert!(ran.stdout.contains("the slowest rank computes"), "{}", ran.stdout);
        let [one, several] = ["one", &out].map(|out| outcome(&workplace.path(out)));
        assert_eq!(one.0.keys().collect::<Vec<_>>(), several.0.keys().collect::<Vec<_>>());
        for (name, bytes) in &one.0 {
            assert!(several.0[name] == *bytes, "{} differs with {count} processes", name.display());
        }
        assert_eq!(one.1, several.1);
        let ranks = record(&workplace.path(&out))["performance"]["ranks"].clone();
        assert_eq!(ranks.as_array().map(Vec::len), Some(count));
    }
    // Made again by one process, and by two.
    for count in [1, 2] {
        let again = ["run", "--again", "2", "--threads", "1"];
        let ran = if count == 1 { workplace.run(&again) } else { run(&workplace, count, &again) };
        assert_eq!(ran.code, Some(0), "{}{}", ran.stdout, ran.stderr);
        assert!(ran.stdout.contains("the same bits"), "{}", ran.stdout);
        std::fs::remove_dir_all(workplace.path("2.again")).unwrap();
    }
}

/// A second process that finds other files than the first one, as on another machine: by a mount that only it sees. It
/// is named with the file, and nothing is run.
#[test]
fn a_file_that_is_another_on_one_machine_is_named() {
    let workplace = Workplace::new();
    let rows = |volume: &str| {
        let places = (0..64).map(|i| [0.025 + 0.05 * f64::from(i % 8), 0.025 + 0.05 * f64::from(i / 8)]);
        places.map(|[x, y]| format!("{x},{y},{volume}\n")).collect::<String>()
    };
    workplace.write("cloud.csv", &format!("x,y,volume\n{}", rows("0.0025")));
    workplace.write("stale.csv", &format!("x,y,volume\n{}", rows("0.0024")));
    let cloud = "[[point_clouds]]\nname = \"cloud\"\nmaterial = \"m\"\nfile = \"cloud.csv\"\n";
    let scene = "[parameters]\nfriction = 0.3\n[space]\ndimension = \"2d\"\ninterior = \"grid\"\ncell = 0.1\n[time]\nend = 1e-3\n\
                 [materials.m]\ndensity = 1000\nneo_hookean = { young_modulus = 1e4, poisson_ratio = 0.3 }\n";
    workplace.write("scene.toml", &format!("{scene}{cloud}"));
    let program = env!("CARGO_BIN_EXE_stickslip");
    for words in [&["run", "scene.toml"][..], &["sweep", "scene.toml", "--set", "friction=0.1,0.2"]] {
        let apart = format!("mount --bind stale.csv cloud.csv && exec {program} {}", words.join(" "));
        let mut command = together(&workplace, 1, words);
        command.args([":", "-n", "1", "unshare", "--mount", "bash", "-c", &apart]);
        let output = command.output().unwrap();
        let told = String::from_utf8(output.stderr).unwrap();
        if told.contains("unshare failed") {
            eprintln!("skipped: the test may not mount");
            return;
        }
        assert!(!output.status.success(), "{told}");
        let named = told.contains("rank 1 ") && told.contains("has another ") && told.contains("cloud.csv: ");
        assert!(named, "{told}");
        assert!(!workplace.path("scene.results").exists());
    }
}

/// The same program with a byte more.
#[test]
fn another_build_on_one_machine_is_named() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let other = workplace.path("other");
    let mut bytes = std::fs::read(env!("CARGO_BIN_EXE_stickslip")).unwrap();
    bytes.push(0);
    std::fs::copy(env!("CARGO_BIN_EXE_stickslip"), &other).unwrap();
    std::fs::write(&other, bytes).unwrap();
    let words = ["run", "scene.toml"];
    let mut command = together(&workplace, 1, &words);
    command.args([":", "-n", "1", other.to_str().unwrap()]).args(words);
    let output = command.output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(!output.status.success() && told.contains("rank 1 on "), "{told}");
    assert!(told.contains("runs another program: stickslip "), "{told}");
    assert!(!workplace.path("scene.results").exists());
}

/// Any of them, the first one too: the launcher ends the others and names it, and another number of processes goes on.
#[test]
fn a_run_whose_process_was_killed_goes_on_with_another_number() {
    let workplace = with_results(&LONG);
    let out = "killed by the test";
    let mut words = with(&["run", "scene.toml", "--quiet", "--out", out], &LONG);
    for (count, killed) in [(3, 1), (2, 0)] {
        let before = newest(&workplace, out);
        let launcher = together(&workplace, count, &words).stderr(Stdio::piped()).spawn().unwrap();
        let begun = Instant::now();
        while newest(&workplace, out) == before {
            assert!(begun.elapsed() < Duration::from_secs(100), "there is a checkpoint soon");
            std::thread::sleep(Duration::from_millis(10));
        }
        let process = ranks(out)[&killed].to_string();
        assert!(Command::new("kill").args(["-KILL", &process]).status().unwrap().success());
        let ended = launcher.wait_with_output().unwrap();
        let told = String::from_utf8_lossy(&ended.stderr);
        assert!(!ended.status.success() && told.contains(&format!("rank {killed}")), "{told}");
        assert_eq!(record(&workplace.path(out))["status"], "running");
        words = vec!["resume", out, "--quiet", "--threads", "1"];
    }
    let ran = run(&workplace, 4, &words);
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    let [one, several] = ["one", out].map(|out| outcome(&workplace.path(out)));
    assert!(one == several, "the run ends as one that nobody killed");
}

/// `kill -USR1` of the launcher, as batch systems do before a job's time is over: the last step is saved.
#[test]
fn a_signal_stops_all_with_a_checkpoint() {
    let workplace = with_results(&LONG);
    let launcher = together(&workplace, 2, &with(&["run", "scene.toml", "--out", "stopped"], &LONG))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while newest(&workplace, "stopped").is_none() {
        assert!(begun.elapsed() < Duration::from_secs(100), "there is a checkpoint soon");
        std::thread::sleep(Duration::from_millis(10));
    }
    let process = launcher.id().to_string();
    assert!(Command::new("kill").args(["-USR1", &process]).status().unwrap().success());
    let ended = launcher.wait_with_output().unwrap();
    let [out, error] = [&ended.stdout, &ended.stderr].map(|text| String::from_utf8_lossy(text));
    assert_eq!(ended.status.code(), Some(130), "{out}{error}");
    assert_eq!(out.matches("go on with: stickslip resume stopped").count(), 1, "{out}");
    assert_eq!(record(&workplace.path("stopped"))["status"], "interrupted");
    let ran = run(&workplace, 3, &["resume", "stopped", "--quiet", "--threads", "1"]);
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    let [one, several] = ["one", "stopped"].map(|out| outcome(&workplace.path(out)));
    assert!(one == several, "the run ends as one that nobody stopped");
}

/// Each process makes some runs of a family; the table is that of one process, and what failed is named once.
#[test]
fn processes_share_a_family_of_runs() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let words =
        ["sweep", "scene.toml", "--set", "bodies[0].velocity=[0, 0],[0, 1e-3],[0, \"100 m/s\"],[1e-3, 0]"];
    let short = ["--set", "cells_per_radius=2", "--set", "time.end=10 ms", "--jobs", "1", "--threads", "1"];
    let words = with(&words, &short);
    let alone = workplace.run(&with(&words, &["--out", "one"]));
    let several = run(&workplace, 3, &with(&words, &["--out", "several"]));
    for ran in [&alone, &several] {
        assert_eq!(ran.code, Some(1), "{}", ran.stderr);
        assert_eq!(ran.stderr.matches("1 of 4 runs failed").count(), 1, "{}", ran.stderr);
        assert_eq!(ran.stdout.matches("3 of 4 runs finished").count(), 1, "{}", ran.stdout);
    }
    let rows = |folder: &str| {
        let mut reader = csv::Reader::from_path(workplace.path(folder).join("sweep.csv")).unwrap();
        let rows = reader.deserialize().map(|row| {
            let mut row: BTreeMap<String, String> = row.unwrap();
            row.remove("wall_time");
            row
        });
        rows.collect::<Vec<_>>()
    };
    assert_eq!(rows("one"), rows("several"));
    for row in rows("one").iter().filter(|row| row["status"] == "finished") {
        let [one, several] =
            ["one", "several"].map(|folder| outcome(&workplace.path(folder).join(&row["run"])));
        assert!(one == several, "{row:?}");
    }
    // As if all had been killed while one run was on its way.
    std::fs::remove_file(workplace.path("several/rows/bodies_0_.velocity=_0,_0_.csv")).unwrap();
    let ran = run(&workplace, 2, &["sweep", "several", "--threads", "1"]);
    assert_eq!(ran.code, Some(1), "{}", ran.stderr);
    assert_eq!(ran.stderr.matches("2 of 2 runs").count(), 1, "two are left: {}", ran.stderr);
    assert_eq!(rows("one"), rows("several"));
}

/// What is wrong is told once, with the exit code of one process.
#[test]
fn what_is_wrong_is_told_once() {
    let workplace = Workplace::new();
    let scene = new_scene();
    workplace.write("scene.toml", &scene);
    workplace.write("wrong.toml", &scene.replace("density = ", "density_ = "));
    let thrown = scene.replace("\"-0.5 m/s\"", "\"20 m/s\"");
    assert_ne!(thrown, scene);
    workplace.write("lost.toml", &thrown);
    for (words, code, told) in [
        (&["run", "wrong.toml"][..], 2, "density_"),
        (&["run", "no such file.toml"], 2, "no such file.toml"),
        (&["run", "scene.toml", "--no-such-flag"], 2, "--no-such-flag"),
        (&["run", "lost.toml", "--quiet"], 1, "left the domain"),
        (&["check", "lost.toml", "--no-such-flag"], 2, "--no-such-flag"),
        (&["sweep", "scene.toml", "--set", "friction=0.3"], 2, "found one value for each name"),
    ] {
        let alone = workplace.run(words);
        let ran = run(&workplace, 3, words);
        assert_eq!((ran.code, alone.code), (Some(code), Some(code)), "{words:?}: {}", ran.stderr);
        let count = |text: &str| text.matches(told).count();
        assert!(count(&alone.stderr) > 0, "{}", alone.stderr);
        assert_eq!(count(&ran.stderr), count(&alone.stderr), "{words:?}: {}", ran.stderr);
    }
    // Nobody but the first does what is for one.
    let ran = run(&workplace, 3, &["check", "scene.toml"]);
    assert_eq!((ran.code, ran.stdout.matches("particles").count() > 0), (Some(0), true), "{}", ran.stderr);
    assert_eq!(ran.stdout, workplace.succeed(&["check", "scene.toml"]));
}

/// The newest checkpoint of a run, by name.
fn newest(workplace: &Workplace, out: &str) -> Option<String> {
    let names = std::fs::read_dir(workplace.path(out).join("checkpoints")).ok()?.flatten();
    let names = names.filter_map(|name| name.file_name().into_string().ok());
    names.filter(|name| name.ends_with(".checkpoint")).max()
}
