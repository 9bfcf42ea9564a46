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
    let printed = workplace.succeed(&["bench", "--tiny", "--threads", "2", "--json", "speed.json"]);
    for word in ["copy GB/s", "P1 cube, linear f64 last", "P2 two blocks", "P3 8 balls", "P4", "P5"] {
        assert!(printed.contains(word), "{word}: {printed}");
    }

    let text = std::fs::read(workplace.path("speed.json")).unwrap();
    let record: Value = serde_json::from_slice(&text).unwrap();
    assert_eq!(keys(&record), ["program", "version", "unix_time", "machine", "results", "skipped"]);
    assert_eq!(keys(&record["machine"]), ["processor", "cores", "instructions", "limits"]);
    assert_eq!(record["machine"]["limits"].as_array().unwrap().len(), 2, "one thread, and two");
    let results = record["results"].as_array().unwrap();
    let of = |problem: &str| results.iter().filter(|result| result["problem"] == problem).count();
    assert_eq!(["P1", "P2", "P3", "P4", "P5"].map(|problem| of(problem) > 0), [true; 5]);
    for result in results {
        assert!(result["rate"].as_f64().unwrap() > 0.0, "{result}");
        assert!(!result["verbs"].as_array().unwrap().is_empty(), "{result}");
    }
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
    let ran = Workplace::new().run(&["bench", "--only", "P8"]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.stderr.contains("P5"), "{}", ran.stderr);
}
