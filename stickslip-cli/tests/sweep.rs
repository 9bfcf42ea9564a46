//! `stickslip sweep`: every combination is run, one failure does not stop the others, mistakes cost nothing.

mod stickslip;

use std::collections::BTreeMap;
use std::fs;
use stickslip::{Workplace, new_scene};

/// The scene of `stickslip new` with a probe and a threshold, short and coarse.
fn place() -> (Workplace, Vec<&'static str>) {
    let workplace = Workplace::new();
    let measured =
        "[[outputs.arrivals]]\nquantity = \"speed\"\nthreshold = \"0.02 m/s\"\nbodies = [\"disk\"]\n";
    workplace.write("scene.toml", &format!("{}\n{measured}", new_scene()));
    let short =
        ["--set", "cells_per_radius=2", "--set", "time.end=10 ms", "--set", "outputs.particles=never"];
    (workplace, short.to_vec())
}

/// `sweep.csv`: the rows by column.
fn table(workplace: &Workplace, folder: &str) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(workplace.path(folder).join("sweep.csv")).unwrap();
    reader.deserialize().map(|row| row.unwrap()).collect()
}

#[test]
fn every_combination_is_run_and_stands_in_the_table() {
    let (workplace, short) = place();
    let values = ["--set", "friction=0,0.5", "--set", "bodies[0].velocity=[0, 0],[0, 1e-3]", "--jobs", "2"];
    let said = workplace.succeed(&[&["sweep", "scene.toml"][..], &values, &short].concat());
    assert!(said.contains("4 of 4 runs finished") && said.contains("scene.sweep"), "{said}");
    let heading = said.lines().next().expect("a table of what differs");
    assert!(heading.contains("friction  bodies[0].velocity") && !heading.contains("particles"), "{said}");
    let rows = table(&workplace, "scene.sweep");
    assert_eq!(rows.len(), 4);
    let column = |name: &str| rows.iter().map(|row| row[name].as_str()).collect::<Vec<_>>();
    assert_eq!(column("friction")[..3], ["0", "0", "0.5"], "the last parameter changes fastest");
    assert_eq!(column("status"), ["finished"; 4]);
    assert_eq!(column("time"), ["0.01"; 4]);
    for row in &rows {
        let results = workplace.path("scene.sweep").join(&row["run"]);
        for file in ["run.json", "bodies.csv", "arrivals.csv", "plot.png"] {
            assert!(results.join(file).exists(), "{}: {file}", row["run"]);
        }
        // Gravity alone: 0.02 m/s, less the push at the start, after some two milliseconds.
        let arrival: f64 = row["arrival speed disk"].parse().unwrap();
        assert!((1.5e-3..4e-3).contains(&arrival), "{row:?}");
    }
    assert!(workplace.path("scene.sweep/plot.png").exists());
    workplace.succeed(&["plot", "scene.sweep", "--out", "sweep.svg"]);
    assert!(fs::read_to_string(workplace.path("sweep.svg")).unwrap().contains("friction"));
    let chosen = ["plot", "scene.sweep", "--quantity", "kinetic_energy,energy_drift", "--out", "chosen.svg"];
    workplace.succeed(&chosen);
    let drawn = fs::read_to_string(workplace.path("chosen.svg")).unwrap();
    assert!(drawn.contains("kinetic energy at the end") && drawn.contains("energy drift, relative"));
    let refused = workplace.run(&["plot", "scene.sweep", "--quantity", "x"]);
    assert_eq!(refused.code, Some(2), "{}", refused.stderr);
    assert!(refused.stderr.contains("found `x`; allowed: time, steps"), "{}", refused.stderr);

    let alone = ["run", "scene.toml", "--set", "friction=0.5", "--set", "bodies[0].velocity=[0, 0]"];
    workplace.succeed(&[&alone[..], &short].concat());
    let same = ["scene.results", "scene.sweep/friction=0.5,bodies_0_.velocity=_0,_0_"]
        .map(|folder| fs::read(workplace.path(folder).join("bodies.csv")).unwrap());
    assert_eq!(same[0], same[1], "a run of a sweep is that run");
}

/// A folder that another sweep has filled is taken over, and the user is told.
#[test]
fn another_sweep_in_a_folder_says_so_and_checkpoints_may_be_left_out() {
    let (workplace, short) = place();
    let sweep = |friction: &str, more: &[&str]| {
        let words = [&["sweep", "scene.toml", "--set", friction][..], &short, more].concat();
        let ran = workplace.run(&words);
        assert_eq!(ran.code, Some(0), "{}", ran.stderr);
        ran.stderr
    };
    let checkpoints = |run: &str| workplace.path("scene.sweep").join(run).join("checkpoints").exists();
    let told = sweep("friction=0,0.5", &["--checkpoint-every", "never"]);
    assert!(!told.contains("note"), "{told}");
    assert!(!checkpoints("friction=0"));
    assert!(!sweep("friction=0,0.5", &[]).contains("note"));
    assert!(checkpoints("friction=0"));
    let told = sweep("friction=0.1,0.5", &[]);
    assert!(told.contains("note: scene.sweep had a sweep of another scene or other values"), "{told}");
    assert_eq!(table(&workplace, "scene.sweep").len(), 2);
    assert!(workplace.path("scene.sweep/friction=0").exists());
}

/// Any number of any table stands in the table of the sweep, and is what the run's own table has.
#[test]
fn columns_of_ones_own_are_taken_from_the_tables_of_the_runs() {
    let (workplace, short) = place();
    let columns = [
        "--column=fell=last bodies.y of disk",
        "--column=highest=largest bodies.vy of d*",
        "--column=mean=mean energy.kinetic",
        "--column=least=smallest energy.total",
        "--column=nobody=last bodies.y of disc",
    ];
    let sweep = [&["sweep", "scene.toml", "--set", "bodies[0].velocity=[0, 0],[0, 1]"][..], &columns, &short];
    let said = workplace.succeed(&sweep.concat());
    assert!(
        said.lines().next().is_some_and(|head| head.contains("fell") && head.contains("highest")),
        "{said}"
    );
    for row in table(&workplace, "scene.sweep") {
        let read = |file: &str| -> Vec<BTreeMap<String, String>> {
            let path = workplace.path("scene.sweep").join(&row["run"]).join(file);
            csv::Reader::from_path(path).unwrap().deserialize().map(|row| row.unwrap()).collect()
        };
        let number = |text: &str| text.parse::<f64>().unwrap();
        let of = |rows: &[BTreeMap<String, String>], column: &str| -> Vec<f64> {
            rows.iter().map(|row| number(&row[column])).collect()
        };
        let mut bodies = read("bodies.csv");
        bodies.retain(|row| row["body"] == "disk");
        let energy = read("energy.csv");
        assert_eq!(Some(&number(&row["fell"])), of(&bodies, "y").last());
        assert_eq!(number(&row["highest"]), of(&bodies, "vy").into_iter().fold(f64::NEG_INFINITY, f64::max));
        let kinetic = of(&energy, "kinetic");
        let mean = kinetic.iter().sum::<f64>() / kinetic.len() as f64;
        assert!((number(&row["mean"]) / mean - 1.0).abs() < 1e-12, "{row:?}");
        assert_eq!(number(&row["least"]), of(&energy, "total").into_iter().fold(f64::INFINITY, f64::min));
        assert!(!row.contains_key("nobody") || row["nobody"].is_empty(), "{row:?}");
        assert_eq!(row["error"], "column `nobody`: bodies.csv has no number of `disc` in y");
    }
    let refused =
        workplace.run(&["sweep", "scene.toml", "--set", "friction=0,1", "--column", "a=last bodies.q"]);
    assert_eq!(refused.code, Some(2), "{}", refused.stderr);
    assert!(
        refused.stderr.contains("found the column `q` of bodies; allowed: x, y, z"),
        "{}",
        refused.stderr
    );
}

#[test]
fn a_run_that_fails_is_named_and_the_others_go_on() {
    let (workplace, short) = place();
    // Thrown out of the domain within the run.
    let values = ["--set", "bodies[0].velocity=[0, \"100 m/s\"],[0, 0]"];
    let ran = workplace.run(&[&["sweep", "scene.toml"][..], &values, &short].concat());
    assert_eq!(ran.code, Some(1), "{}", ran.stderr);
    assert!(
        ran.stderr.contains("1 of 2 runs failed") && ran.stderr.contains("left the domain"),
        "{}",
        ran.stderr
    );
    let rows = table(&workplace, "scene.sweep");
    assert_eq!([&rows[0]["status"], &rows[1]["status"]], ["failed", "finished"]);
    assert!(rows[0]["error"].contains("left the domain") && rows[1]["error"].is_empty());
}

#[test]
fn mistakes_are_refused_before_anything_is_run() {
    let (workplace, _) = place();
    let cases = [
        (&["--set", "fricton=0,1"][..], "friction"),
        (&["--set", "friction=0,-1"], "a number from 0 on"),
        (&["--set", "friction=0,,1"], "empty value"),
        (&["--set", "friction="], "name=value"),
        (&["--set", "friction=1,1"], "twice"),
        (&["--set", "friction=0.5"], "stickslip run"),
        (&["--set", "friction=0,1", "--set", "friction=2"], "`friction` twice"),
        (&[], "--set"),
    ];
    for (arguments, expected) in cases {
        let ran = workplace.run(&[&["sweep", "scene.toml"][..], arguments].concat());
        assert_eq!(ran.code, Some(2), "{arguments:?}: {}", ran.stderr);
        assert!(ran.stderr.contains(expected), "{arguments:?}: {}", ran.stderr);
        assert!(!workplace.path("scene.sweep").exists(), "{arguments:?}");
    }
}

#[test]
fn a_folder_with_other_files_is_left_alone() {
    let (workplace, short) = place();
    fs::create_dir(workplace.path("mine")).unwrap();
    workplace.write("mine/thesis.txt", "years of work");
    let arguments = ["sweep", "scene.toml", "--set", "friction=0,1", "--out", "mine"];
    let ran = workplace.run(&[&arguments[..], &short].concat());
    assert_eq!(ran.code, Some(2), "{}", ran.stderr);
    assert!(ran.stderr.contains("thesis.txt"), "{}", ran.stderr);
    assert_eq!(fs::read_dir(workplace.path("mine")).unwrap().count(), 1);
}

/// Runs that finished stand, bit for bit and untouched; those that were killed or failed are run, and the table is that
/// of a sweep that was never interrupted.
#[test]
fn a_sweep_goes_on_where_it_was() {
    let (workplace, short) = place();
    let values = ["--set", "friction=0,0.3,0.6"];
    workplace.succeed(&[&["sweep", "scene.toml", "--out", "whole"][..], &values, &short].concat());
    workplace.succeed(&[&["sweep", "scene.toml", "--out", "part"][..], &values, &short].concat());
    // As if the second had been killed, and the third had not begun.
    let part = |file: &str| workplace.path("part").join(file);
    fs::remove_file(part("rows/friction=0.3.csv")).unwrap();
    let record = fs::read_to_string(part("friction=0.3/run.json")).unwrap();
    fs::write(part("friction=0.3/run.json"), record.replace("\"finished\"", "\"running\"")).unwrap();
    fs::remove_file(part("rows/friction=0.6.csv")).unwrap();
    fs::remove_dir_all(part("friction=0.6")).unwrap();
    let kept = fs::metadata(part("friction=0/bodies.csv")).unwrap().modified().unwrap();

    let said = workplace.succeed(&["sweep", "part", "--gather"]);
    assert!(said.contains("2 of 3 runs have not finished: stickslip sweep 'part'"), "{said}");
    let statuses = |rows: &[BTreeMap<String, String>]| -> Vec<String> {
        rows.iter().map(|row| row["status"].clone()).collect()
    };
    assert_eq!(statuses(&table(&workplace, "part")), ["finished", "pending", "pending"]);

    let said = workplace.succeed(&["sweep", "part"]);
    assert!(said.contains("3 of 3 runs finished"), "{said}");
    assert_eq!(fs::metadata(part("friction=0/bodies.csv")).unwrap().modified().unwrap(), kept);
    let [whole, part] = ["whole", "part"].map(|folder| table(&workplace, folder));
    for (whole, part) in whole.iter().zip(&part) {
        for (name, value) in whole.iter().filter(|(name, _)| *name != "wall_time") {
            assert_eq!(&part[name], value, "{}: {name}", whole["run"]);
        }
    }
    let resumed = fs::read_to_string(workplace.path("part/friction=0.3/run.json")).unwrap();
    assert!(resumed.contains("\"resumed\": [\n"), "{resumed}");

    // Killed between its end and its row: it takes no step again.
    let steps =
        |folder: &str| table(&workplace, folder).iter().map(|row| row["steps"].clone()).collect::<Vec<_>>();
    fs::remove_file(workplace.path("part/rows/friction=0.csv")).unwrap();
    workplace.succeed(&["sweep", "part"]);
    assert_eq!(steps("part"), steps("whole"));
    let again = fs::read_to_string(workplace.path("part/friction=0/run.json")).unwrap();
    assert!(again.contains("\"resumed\": [\n"), "{again}");

    let refused = [
        (&["sweep", "part", "--set", "friction=0,1"][..], "goes on as it was begun"),
        (&["sweep", "part", "--only", "3"], "numbers from 0 to 2"),
        (&["sweep", "scene.toml", "--gather"], "the folder of a sweep"),
        (&["sweep", "."], "is not the folder of a sweep"),
        (&["sweep", "nowhere.sweep"], "No such file"),
    ];
    for (arguments, expected) in refused {
        let ran = workplace.run(arguments);
        assert_eq!(ran.code, Some(2), "{arguments:?}: {}", ran.stderr);
        assert!(ran.stderr.contains(expected), "{arguments:?}: {}", ran.stderr);
    }
}

/// The script runs each run by its number, as a scheduler would; what failed is named, and how it is submitted again.
#[cfg(unix)]
#[test]
fn a_job_array_makes_the_same_table() {
    let (workplace, short) = place();
    // The last is thrown out of the domain.
    let values = ["--set", "bodies[0].velocity=[0, 0],[0, 1e-3],[0, \"100 m/s\"]"];
    let said = workplace.succeed(&[&["sweep", "scene.toml", "--script"][..], &values, &short].concat());
    assert!(said.contains("sbatch --array=0-2 'scene.sweep/array.sh'"), "{said}");
    assert!(!workplace.path("scene.sweep/bodies_0_.velocity=_0,_0_").exists(), "nothing is run");
    let script = fs::read_to_string(workplace.path("scene.sweep/array.sh")).unwrap();
    assert!(script.contains("#SBATCH --array=0-2\n"), "{script}");
    let job = |number: &str| {
        let mut shell = std::process::Command::new("sh");
        shell.arg("scene.sweep/array.sh").current_dir(workplace.path(""));
        let output = shell.env("SLURM_ARRAY_TASK_ID", number).output().unwrap();
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    assert_eq!([job("0"), job("1")].map(|(code, _)| code), [Some(0); 2]);
    let (code, said) = job("2");
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("left the domain"), "{said}");
    let gathered = workplace.run(&["sweep", "scene.sweep", "--gather"]);
    assert_eq!(gathered.code, Some(1), "{}", gathered.stderr);
    assert!(gathered.stderr.contains("sbatch --array=2 "), "{}", gathered.stderr);
    let rows = table(&workplace, "scene.sweep");
    assert_eq!(
        rows.iter().map(|row| row["status"].as_str()).collect::<Vec<_>>(),
        ["finished", "finished", "failed"]
    );
    assert_eq!([&rows[0]["time"], &rows[1]["time"]], ["0.01"; 2]);

    // What has finished stands when the script is written once more; the rest is submitted.
    let script = [&["sweep", "scene.toml", "--script"][..], &values, &short].concat();
    let said = workplace.succeed(&script);
    assert!(said.contains("1 of 3 runs to do\nsbatch --array=2 'scene.sweep/array.sh'"), "{said}");
    let statuses: Vec<String> =
        table(&workplace, "scene.sweep").iter().map(|row| row["status"].clone()).collect();
    assert_eq!(statuses, ["finished", "finished", "pending"]);
    let sound = ["--set", "bodies[0].velocity=[0, 0],[0, 1e-3]"];
    let said = workplace.succeed(&[&["sweep", "scene.toml", "--script"][..], &sound, &short].concat());
    assert!(said.contains("all 2 runs have finished: stickslip sweep scene.sweep --gather"), "{said}");

    for (option, value) in [("--jobs", "2"), ("--threads", "2")] {
        for mode in ["--script", "--gather"] {
            let refused = workplace.run(&["sweep", "scene.sweep", mode, option, value]);
            assert_eq!(refused.code, Some(2), "{}", refused.stderr);
            assert!(refused.stderr.contains("cannot be used with"), "{}", refused.stderr);
        }
    }
}

/// The scene lies in the folder of its sweep, which is moved; SLURM runs a copy of the script, which asks it where the
/// script came from.
#[cfg(unix)]
#[test]
fn a_folder_that_was_moved_goes_on_where_it_lies() {
    use std::os::unix::fs::PermissionsExt;
    let (workplace, short) = place();
    fs::create_dir(workplace.path("first")).unwrap();
    fs::rename(workplace.path("scene.toml"), workplace.path("first/scene.toml")).unwrap();
    let values = ["--set", "friction=0,0.5", "--script", "--out", "first"];
    workplace.succeed(&[&["sweep", "first/scene.toml"][..], &values, &short].concat());
    fs::rename(workplace.path("first"), workplace.path("moved here")).unwrap();

    fs::create_dir(workplace.path("spool")).unwrap();
    fs::copy(workplace.path("moved here/array.sh"), workplace.path("spool/job")).unwrap();
    let origin = workplace.path("moved here/array.sh");
    let scontrol =
        format!("#!/bin/sh\necho 'JobId=7 JobName=stickslip'\necho '   Command={}'\n", origin.display());
    workplace.write("spool/scontrol", &scontrol);
    fs::set_permissions(workplace.path("spool/scontrol"), fs::Permissions::from_mode(0o755)).unwrap();
    let path = format!("{}:{}", workplace.path("spool").display(), std::env::var("PATH").unwrap());
    let mut shell = std::process::Command::new("sh");
    shell.arg("spool/job").current_dir(workplace.path(""));
    shell.env("SLURM_ARRAY_TASK_ID", "0").env("SLURM_JOB_ID", "7").env("PATH", path);
    assert!(shell.status().unwrap().success());
    assert!(workplace.path("moved here/rows/friction=0.csv").exists());
    shell.env("PATH", "/usr/bin:/bin");
    assert_eq!(shell.status().unwrap().code(), Some(2), "nobody says where the script came from");

    let said = workplace.succeed(&["sweep", "moved here"]);
    assert!(said.contains("2 of 2 runs finished"), "{said}");
    assert!(!workplace.path("first").exists());
}
