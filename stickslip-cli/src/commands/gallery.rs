//! `stickslip gallery`: scenes that the program brings along, listed, shown, run and checked.

use super::{render, say, stop_on_interrupt};
use crate::failure::Failure;
use crate::gallery::{EXHIBITS, Exhibit};
use crate::jobs::{Earlier, Job, JobRunner};
use clap::{Args, Subcommand};
use miette::{IntoDiagnostic, miette};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use stickslip::observe::{Results, SceneSource};

/// List, show, run and check the scenes of the gallery.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(subcommand)]
    what: Option<What>,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Name all scenes, what each shows, how long it takes, and what is checked of its physics.
    List,
    /// Print a scene file.
    Show {
        /// Name of the scene.
        #[arg(value_parser = exhibit)]
        scene: &'static Exhibit,
    },
    /// Run scenes, draw the picture and the animation of each, and check their physics; exit code 3 if a check fails.
    /// A scene that fails does not stop the others.
    Run(Run),
    /// Run all scenes and check their physics, without pictures; exit code 3 if a check fails.
    /// A scene that fails does not stop the others.
    Check(Where),
}

#[derive(Debug, Args)]
struct Run {
    /// Names of scenes.
    #[arg(required = true, value_parser = exhibit)]
    scenes: Vec<&'static Exhibit>,

    #[command(flatten)]
    at: Where,
}

/// Where runs are made, and by how many threads.
#[derive(Debug, Args)]
struct Where {
    /// Folder for the scenes with their files, `DIR/scenes`, and for the results of each, `DIR/NAME`. Results that are
    /// there already stand.
    #[arg(long, value_name = "DIR", default_value = "gallery.results")]
    out: PathBuf,

    /// Threads; as many as there are processors without this.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

fn exhibit(name: &str) -> Result<&'static Exhibit, String> {
    Exhibit::named(name).ok_or_else(|| {
        let names: Vec<_> = EXHIBITS.iter().map(|exhibit| exhibit.name).collect();
        format!("allowed: {}", names.join(", "))
    })
}

impl Arguments {
    pub fn execute(self) -> Result<(), Failure> {
        match self.what.unwrap_or(What::List) {
            What::List => say(&list()),
            What::Show { scene } => say(scene.scene),
            What::Run(Run { scenes, at }) => at.run(&scenes, draw),
            What::Check(at) => at.run(&EXHIBITS.iter().collect::<Vec<_>>(), |_, _| Ok(())),
        }
    }
}

impl Where {
    /// Runs scenes, does something with the folder of each, and says what their checks say.
    fn run(
        &self,
        scenes: &[&'static Exhibit],
        with_each: impl Fn(&Exhibit, &Path) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let mut seen = HashSet::new();
        let scenes: Vec<&Exhibit> = scenes.iter().copied().filter(|scene| seen.insert(scene.name)).collect();
        let jobs = scenes.iter().map(|scene| self.job(scene)).collect::<Result<Vec<Job>, Failure>>()?;
        let threads = match self.threads {
            Some(threads) => usize::from(threads),
            None => std::thread::available_parallelism().map_or(1, usize::from),
        };
        let folder = self.out.clone();
        let runner = JobRunner { folder, threads, stop: stop_on_interrupt()?, earlier: Earlier::Keep };
        let mut outcomes = runner.work(&jobs)?;
        let (mut failed, mut untrue, mut code) = (Vec::new(), Vec::new(), None);
        for scene in &scenes {
            let Some(outcome) = outcomes.remove(scene.name) else { continue };
            let folder = self.out.join(scene.name);
            let judged = outcome
                .map_err(|error| Failure::Run(miette!("{} did not run: {error}", folder.display())))
                .and_then(|results| with_each(scene, &folder).and_then(|()| tell(scene, &results)));
            match judged {
                Ok(true) => {}
                Ok(false) => untrue.push(scene.name),
                Err(failure) if scenes.len() == 1 => return Err(failure),
                // The others are looked at all the same.
                Err(failure) => {
                    failure.print();
                    code.get_or_insert(failure.exit_code());
                    failed.push(scene.name);
                }
            }
        }
        if failed.is_empty() && untrue.is_empty() {
            return Ok(());
        }
        Err(Failure::Gallery { failed: (failed, code.unwrap_or_default()), untrue })
    }

    /// The scene, written with its files and read from there.
    fn job(&self, scene: &Exhibit) -> Result<Job, Failure> {
        let folder = self.out.join("scenes");
        let path = scene.write(&folder).map_err(|error| {
            Failure::Input(miette!(
                help = "name another folder with --out",
                "cannot write the scene to {}: {error}",
                folder.display()
            ))
        })?;
        let path = std::path::absolute(path).into_diagnostic().map_err(Failure::Run)?;
        let loaded = super::load(&path, &[]).map_err(Failure::input)?;
        let text = Some(loaded.source.text().to_owned());
        let source = Some(SceneSource { path, set: Vec::new(), until: None, text });
        Ok(Job { name: scene.name.to_owned(), loaded, source })
    }
}

/// Draws a scene's picture and its animation into the folder of its results.
fn draw(scene: &Exhibit, folder: &Path) -> Result<(), Failure> {
    let draw = |size: &str, words: &[&str], file: &str| {
        let out = folder.join(file);
        let words = [scene.look, words, &["--size", size]].concat();
        render::Arguments::of(folder, &words, &out).execute()
    };
    draw(scene.size, &[], "picture.png")?;
    draw(scene.small_size, &["--animate"], "animation.gif")
}

/// Says what the check of a scene says, and whether it holds.
fn tell(scene: &Exhibit, results: &Results) -> Result<bool, Failure> {
    let check = &scene.check;
    let value = (check.measure)(results).map_err(Failure::input)?;
    let holds = check.holds(value);
    let [low, high] = check.bounds;
    let verdict = if holds { "holds" } else { "DOES NOT HOLD" };
    let performance = &results.manifest().performance;
    say(&format!(
        "{}: {}: {value:.4}, allowed {low} to {high}: {verdict}; {:.0} s by {} threads",
        scene.name, check.what, performance.wall_time, performance.threads
    ))?;
    for warning in &results.manifest().warnings {
        say(&format!("  warning: {}", warning.message))?;
    }
    Ok(holds)
}

fn list() -> String {
    let width = EXHIBITS.iter().map(|exhibit| exhibit.name.len()).max().unwrap_or(0);
    let line = |exhibit: &Exhibit| {
        let Exhibit { name, check, .. } = exhibit;
        let [low, high] = check.bounds;
        let title = exhibit.title();
        format!(
            "{name:width$}  {:>6}  {title}\n{:width$}          {}, {low} to {high}",
            exhibit.time(),
            "",
            check.what
        )
    };
    let lines: Vec<String> = EXHIBITS.iter().map(line).collect();
    format!(
        "{}\n\nTimes are those on two cores. `stickslip gallery show NAME` prints a scene, `stickslip gallery run NAME` \
         runs it, draws it and checks it.",
        lines.join("\n")
    )
}
