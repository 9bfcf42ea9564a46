//! `stickslip bench`: a table, a file, and clear words about what is missing. How fast anything is, is never a test.

mod stickslip;

use serde_json::Value;
use stickslip::Workplace;

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

#[test]
fn a_benchmark_prints_tables_and_writes_json() {
    let workplace = Workplace::new();
    let printed = workplace.succeed(&[
        "bench",
        "--tiny",
        "--threads",
        "2",
        "--json",
        "speed.json",
        "--draw",
        "many.svg",
    ]);
    assert!(std::fs::read_to_string(workplace.path("many.svg")).unwrap().contains("weak scaling"));
    for word in [
        "copy GB/s",
        "P1 cube, linear f64 last",
        "P2 two blocks",
        "P3 8 balls",
        "P4",
        "P5",
        "sphere",
        "P7",
        "Goals",
    ] {
        assert!(printed.contains(word), "{word}: {printed}");
    }

    let text = std::fs::read(workplace.path("speed.json")).unwrap();
    let record: Value = serde_json::from_slice(&text).unwrap();
    let documented = [
        "program",
        "version",
        "unix_time",
        "machine",
        "results",
        "skipped",
        "end_to_end",
        "on_ranks",
        "weak_scaling",
        "models",
        "peers",
        "goals",
    ];
    assert_eq!(keys(&record), documented);
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
    assert_eq!(keys(&record["machine"]), ["processor", "cores", "instructions", "limits"]);
    assert_eq!(record["machine"]["limits"].as_array().unwrap().len(), 2, "one thread, and two");
    let results = record["results"].as_array().unwrap();
    let of = |problem: &str| results.iter().filter(|result| result["problem"] == problem).count();
    assert_eq!(["P1", "P2", "P3", "P4", "P5"].map(|problem| of(problem) > 0), [true; 5]);
    for result in results {
        assert!(result["rate"].as_f64().unwrap() > 0.0, "{result}");
        assert!(!result["verbs"].as_array().unwrap().is_empty(), "{result}");
    }
    let run = &record["end_to_end"][0];
    assert!(run["steps"].as_u64().unwrap() > 0 && run["ratio"].as_f64().unwrap() > 0.0, "{run}");
    let goals = record["goals"].as_array().unwrap();
    assert!(goals.iter().any(|goal| goal["name"].as_str().unwrap().starts_with("P2")), "{goals:?}");
}

#[test]
fn scenes_of_problems_can_be_run_by_hand() {
    let workplace = Workplace::new();
    workplace.succeed(&["bench", "--tiny", "--only", "p3", "--scenes", "problems"]);
    let scene = "problems/P3_8_balls_linear_f64_modified-last.toml";
    workplace.succeed(&["run", scene, "--set", "time.end=1 ms", "--out", "balls.results"]);
    assert!(workplace.path("balls.results/bodies.csv").exists());
}

#[test]
fn an_unknown_problem_is_refused_with_those_that_are_known() {
    let ran = Workplace::new().run(&["bench", "--only", "P1", "--draw", "many.svg"]);
    assert_eq!((ran.code, ran.stderr.contains("P7")), (Some(2), true), "{}", ran.stderr);
    let ran = Workplace::new().run(&["bench", "--only", "P8"]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.stderr.contains("P7"), "{}", ran.stderr);
}

#[cfg(unix)]
#[test]
fn without_python_other_programs_are_not_measured_and_it_says_why() {
    let workplace = Workplace::new();
    let arguments = ["bench", "--tiny", "--only", "P1", "--peers", "--environment", "peers"];
    let output = workplace.command(&arguments).env("PATH", workplace.path("")).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("Python") && said.contains("venv"), "{said}");
}

#[test]
#[ignore = "slow: installs Taichi and Warp from the Python package index, and compiles with both"]
fn other_programs_run_the_same_problem() {
    let workplace = Workplace::new();
    let arguments =
        ["bench", "--tiny", "--only", "P1", "--peers", "--environment", "peers", "--json", "speed.json"];
    workplace.succeed(&arguments);
    let text = std::fs::read(workplace.path("speed.json")).unwrap();
    let record: Value = serde_json::from_slice(&text).unwrap();
    let peers = record["peers"].as_array().unwrap();
    assert_eq!(peers.len(), 6, "two ways of Taichi and one of Warp, linear and quadratic");
    assert!(peers.iter().all(|peer| peer["particles"] == 512), "{peers:?}");
}
