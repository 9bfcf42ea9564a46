//! Charts of several runs, and of any table.

mod stickslip;

use std::fs;
use stickslip::{Workplace, new_scene};

#[test]
fn several_runs_share_a_chart() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    for (name, friction) in [("rough", "0.5"), ("smooth", "0")] {
        let (out, friction) = (format!("{name}.results"), format!("friction={friction}"));
        let coarse = ["--set", "cells_per_radius=3", "--set", "time.end=0.1 s", "--set", &friction];
        workplace.succeed(&[&["run", "scene.toml", "--quiet", "--out", &out][..], &coarse].concat());
    }
    let runs = ["plot", "rough.results", "smooth.results"];
    let plot = |flags: &[&str]| workplace.succeed(&[&runs[..], flags].concat());
    plot(&["--body", "disk", "--quantity", "wz", "--out", "spin.svg"]);
    let chart = fs::read_to_string(workplace.path("spin.svg")).unwrap();
    for label in ["rough: disk wz", "smooth: disk wz", "angular velocity [rad/s]"] {
        assert!(chart.contains(label), "{label}");
    }
    let own = fs::read(workplace.path("rough.results/plot.png")).unwrap();
    assert!(plot(&[]).starts_with("plot.png is written"));
    assert_eq!(fs::read(workplace.path("rough.results/plot.png")).unwrap(), own, "each run keeps its own");

    plot(&["--table", "contacts", "--quantity", "normal,gap,area", "--out", "c.svg"]);
    let chart = fs::read_to_string(workplace.path("c.svg")).unwrap();
    assert!(chart.contains("rough: disk") && chart.contains("smooth: disk"), "{chart}");
    let columns = workplace.run(&["plot", "rough.results", "--table", "loads", "--quantity", "force"]);
    assert!(columns.code == Some(2) && columns.stderr.contains("fx, fy, fz, mx, my, mz, ux, uy, uz, work"));
    let none = workplace.run(&["plot", "rough.results", "--table", "joints"]);
    assert!(none.code != Some(0) && none.stderr.contains("nothing to draw"), "{}", none.stderr);
    let missing = workplace.run(&["plot", "rough.results", "nowhere"]);
    assert!(missing.code == Some(2) && missing.stderr.contains("nowhere"), "{}", missing.stderr);
    let taken = workplace.path("mine.svg");
    fs::write(&taken, "a thesis").unwrap();
    let kept = workplace.run(&["plot", "rough.results", "--out", "mine.svg"]);
    assert!(kept.code != Some(0) && fs::read(&taken).unwrap() == b"a thesis", "what is no SVG stays");
}
