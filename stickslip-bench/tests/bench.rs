//! `stickslip-bench`: tables, a chart, a file, and clear words about what is missing. How fast anything is, is never a
//! test.

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

/// What it does in a folder, of a few hundred particles each.
fn bench(folder: &Path, words: &[&str], path: Option<&Path>) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stickslip-bench"));
    command.args(words).arg("--tiny").current_dir(folder);
    if let Some(path) = path {
        command.env("PATH", path);
    }
    command.output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn record(folder: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(folder.join("speed.json")).unwrap()).unwrap()
}

#[test]
fn everything_is_measured_and_held_against_goals() {
    let folder = tempfile::tempdir().unwrap();
    let drawn = std::thread::available_parallelism().unwrap().get() > 1;
    let words = ["--threads", "2", "--json", "speed.json", "--draw", "many.svg"];
    let output = bench(folder.path(), if drawn { &words } else { &words[..4] }, None);
    assert!(output.status.success(), "{}", said(&output));
    let printed = String::from_utf8(output.stdout).unwrap();
    for word in ["copy GB/s", "P1 cube, linear f64 last", "P5", "sphere", "P7", "Goals"] {
        assert!(printed.contains(word), "{word}: {printed}");
    }
    if drawn {
        let chart = std::fs::read_to_string(folder.path().join("many.svg")).unwrap();
        assert!(chart.contains("weak scaling"));
    }
    let record = record(folder.path());
    let keys: Vec<&str> = record.as_object().unwrap().keys().map(String::as_str).collect();
    let own = ["end_to_end", "on_ranks", "weak_scaling", "models", "peers", "goals"];
    assert_eq!(keys[keys.len() - own.len()..], own);
    assert_eq!(keys[..2], ["program", "version"]);
    // With the same bits, or it would have failed.
    let shared = record["on_ranks"].as_array().unwrap();
    let ranks = |shared: &Value| shared["ranks"].as_u64();
    assert_eq!(shared.iter().filter_map(ranks).collect::<Vec<_>>(), [1, 2, 4, 1, 2, 4, 1, 2, 4]);
    assert!(
        shared
            .iter()
            .all(|shared| (shared["bytes"].as_f64() > Some(0.0)) && shared["speed"].as_f64() > Some(0.0))
    );
    let grown = record["weak_scaling"].as_array().unwrap();
    let cores = std::thread::available_parallelism().unwrap().get() as u64;
    assert!(grown.iter().all(|grown| ranks(grown) <= Some(cores) && grown["particle"].as_f64() > Some(0.0)));
    assert_eq!(grown.iter().filter(|grown| ranks(grown) == Some(2)).count(), if cores > 1 { 3 } else { 0 });
    let run = &record["end_to_end"][0];
    assert!(run["steps"].as_u64().unwrap() > 0 && run["ratio"].as_f64().unwrap() > 0.0, "{run}");
    let goals = record["goals"].as_array().unwrap();
    assert!(goals.iter().any(|goal| goal["name"].as_str().unwrap().starts_with("P2")), "{goals:?}");
}

#[test]
fn a_chart_of_what_is_not_measured_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refused = bench(folder.path(), &["--only", "P1", "--draw", "many.svg"], None);
    assert_eq!((refused.status.code(), said(&refused).contains("P7")), (Some(2), true), "{}", said(&refused));
}

#[cfg(unix)]
#[test]
fn without_python_other_programs_are_not_measured_and_it_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let words = ["--only", "P1", "--peers", "--environment", "peers"];
    let output = bench(folder.path(), &words, Some(folder.path()));
    assert_eq!(output.status.code(), Some(1));
    assert!(said(&output).contains("Python") && said(&output).contains("venv"), "{}", said(&output));
}

#[test]
#[ignore = "slow: installs Taichi and Warp from the Python package index, and compiles with both"]
fn other_programs_run_the_same_problem() {
    let folder = tempfile::tempdir().unwrap();
    let words = ["--only", "P1", "--peers", "--environment", "peers", "--json", "speed.json"];
    let output = bench(folder.path(), &words, None);
    assert!(output.status.success(), "{}", said(&output));
    let record = record(folder.path());
    let peers = record["peers"].as_array().unwrap();
    assert_eq!(peers.len(), 6, "two ways of Taichi and one of Warp, linear and quadratic");
    assert!(peers.iter().all(|peer| peer["particles"] == 512), "{peers:?}");
}
