//! `stickslip run SCENE`: from a scene file to numbers, a chart and a picture.

use super::{assignment, load, report, say, stop_on_interrupt};
use crate::failure::Failure;
use crate::illustration::illustrate;
use crate::progress::Display;
use clap::Args;
use miette::IntoDiagnostic;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use stickslip::observe::{ArrivalRow, FrontSpeedRow, Results, Status};
use stickslip::run::{RunError, RunOptions};
use stickslip::scene::Scene;

/// Run a scene and write its results.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file.
    scene: PathBuf,

    /// Folder for the results; the name of the scene with `.results`, in this folder, without this.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Give a named parameter of the scene another value; may be repeated.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    parameters: Vec<(String, String)>,

    /// Threads; as many as there are processors without this.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,

    /// Exit with code 3 if the summary warns that results are doubtful.
    #[arg(long)]
    strict: bool,
}

/// Where the results go if the user does not say.
pub fn default_folder(scene: &Path, kind: &str) -> PathBuf {
    let mut name = scene.file_stem().unwrap_or(scene.as_os_str()).to_owned();
    name.push(format!(".{kind}"));
    PathBuf::from(name)
}

#[test]
fn results_go_beside_the_user_not_beside_the_scene() {
    let folder = default_folder(Path::new("scenes/paper/inclined_plane_no_slip.toml"), "results");
    assert_eq!(folder, PathBuf::from("inclined_plane_no_slip.results"));
}

impl Arguments {
    pub fn execute(self) -> Result<(), Failure> {
        let loaded = load(&self.scene, &self.parameters).map_err(Failure::input)?;
        let scene = &loaded.scene;
        let threads = use_threads(self.threads)?;
        for warning in report(&loaded)?.warnings {
            eprintln!("warning: {warning}");
        }
        let mut simulation =
            stickslip::step::build(scene).map_err(|problem| Failure::input(loaded.source.locate(problem)))?;
        let out = self.out.clone().unwrap_or_else(|| default_folder(&self.scene, "results"));
        let options = RunOptions { out: out.clone(), stop: stop_on_interrupt()?, threads };
        let display = Display::new(scene.time.end, std::io::stderr().is_terminal());
        let outcome =
            stickslip::run::run(scene, &mut *simulation, &options, &mut |progress| display.show(progress));
        display.finish();
        let summary = match outcome {
            Ok(summary) => summary,
            Err(error @ RunError::Folder(_)) => return Err(Failure::input(error)),
            Err(error) => {
                // The failure is the news; a picture of it is welcome but must not hide it.
                let _ = illustrate(&out);
                return Err(Failure::run(error));
            }
        };
        say(&format!("{}\n{summary}{}", scene.title, measured(&out, scene)?))?;
        let drawn = illustrate(&out)?;
        say(&format!("results in {}/: {drawn}", out.display()))?;
        match summary.warnings.len() {
            _ if summary.status == Status::Interrupted => Err(Failure::Interrupted),
            warnings @ 1.. if self.strict => Err(Failure::Doubtful(warnings)),
            _ => Ok(()),
        }
    }
}

/// A line for each arrival and each front's speed; a threshold that was not passed has none.
fn measured(folder: &Path, scene: &Scene) -> Result<String, Failure> {
    let results = Results::open(folder).map_err(Failure::input)?;
    let unit = scene.outputs.measurements.unit();
    let arrival = |row: &ArrivalRow| {
        let units = unit.map_or(String::new(), |unit| format!(", {:.4} time units", row.time / unit));
        let ArrivalRow { time, quantity, threshold, place, reading, .. } = row;
        format!("  arrival    {quantity} {threshold:.3e} at {place} ({reading}): t = {time:.6e} s{units}\n")
    };
    let speed = |row: &FrontSpeedRow| {
        let FrontSpeedRow { front, speed, error, .. } = row;
        format!("  front      {front}: {speed:.6} m/s by fit, standard error {error:.2}\n")
    };
    let arrivals = results.arrivals_table().map_err(Failure::input)?;
    let speeds = results.front_speeds_table().map_err(Failure::input)?;
    Ok(arrivals.iter().map(arrival).chain(speeds.iter().map(speed)).collect())
}

/// Makes the threads of the run, and says how many there are.
fn use_threads(threads: Option<u16>) -> Result<usize, Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.map_or(0, usize::from));
    pool.build_global().into_diagnostic().map_err(Failure::Run)?;
    Ok(rayon::current_num_threads())
}
