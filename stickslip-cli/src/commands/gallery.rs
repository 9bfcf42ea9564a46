//! `stickslip gallery`: scenes that the program brings along, listed, shown, and run.

use super::{run, say};
use crate::failure::Failure;
use crate::gallery::{EXHIBITS, Exhibit};
use clap::{Args, Subcommand};
use miette::miette;
use std::path::PathBuf;

/// List, show and run the scenes of the gallery.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(subcommand)]
    what: Option<What>,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Name all scenes, and how long they take.
    List,
    /// Say what a scene shows, and what is known of that.
    Show {
        /// Name of the scene.
        #[arg(value_parser = exhibit)]
        scene: &'static Exhibit,
    },
    /// Write a scene and the files that it needs into a folder, to be changed.
    Copy {
        /// Name of the scene.
        #[arg(value_parser = exhibit)]
        scene: &'static Exhibit,
        /// The folder; that of the scene's name without this.
        folder: Option<PathBuf>,
    },
    /// Copy a scene and run it.
    Run {
        /// Name of the scene.
        #[arg(value_parser = exhibit)]
        scene: &'static Exhibit,
        /// The folder; that of the scene's name without this.
        folder: Option<PathBuf>,
        /// Threads; as many as there are processors without this.
        #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
        threads: Option<u16>,
    },
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
            What::Show { scene } => say(&shown(scene)),
            What::Copy { scene, folder } => {
                let path = copied(scene, folder)?;
                say(&format!("{0} is written; now: stickslip run {0}", path.display()))
            }
            What::Run { scene, folder, threads } => {
                let path = copied(scene, folder)?;
                let out = path.with_extension("results");
                run::Arguments::plain(path, out, threads).execute()
            }
        }
    }
}

fn copied(scene: &Exhibit, folder: Option<PathBuf>) -> Result<PathBuf, Failure> {
    let folder = folder.unwrap_or_else(|| PathBuf::from(scene.name));
    scene.write(&folder).map_err(|error| {
        Failure::Input(miette!(
            help = "name another folder behind the scene's name",
            "cannot write the scene to {}: {error}",
            folder.display()
        ))
    })
}

fn time(seconds: f64) -> String {
    if seconds < 90.0 { format!("{seconds:.0} s") } else { format!("{:.0} min", seconds / 60.0) }
}

fn list() -> String {
    let width = EXHIBITS.iter().map(|exhibit| exhibit.name.len()).max().unwrap_or(0);
    let line = |exhibit: &Exhibit| {
        format!("{:width$}  {:>6}  {}", exhibit.name, time(exhibit.seconds), exhibit.title())
    };
    let lines: Vec<String> = EXHIBITS.iter().map(line).collect();
    format!(
        "{}\n\nTimes are those on two cores. `stickslip gallery show NAME` says more, `stickslip gallery run NAME` runs it.",
        lines.join("\n")
    )
}

fn shown(scene: &Exhibit) -> String {
    let Exhibit { name, seconds, .. } = scene;
    format!(
        "{}\n\n{}\n\nIt takes about {} on two cores: stickslip gallery run {name}",
        scene.title(),
        scene.about().trim_end(),
        time(*seconds)
    )
}
