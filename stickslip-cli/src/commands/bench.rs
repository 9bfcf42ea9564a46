//! `stickslip bench`: how fast the program is, and how fast this machine could be.

use super::say;
use crate::bench::{BenchExtent, BenchSuite, CLUSTER, PROBLEMS, Peers, answer, scaling_chart, write_scenes};
use crate::chart::draw;
use crate::failure::Failure;
use crate::files;
use clap::Args;
use miette::miette;
use std::path::PathBuf;

/// Measure this machine's limits, and how near the program comes to them.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Fewer and smaller problems: under a minute.
    #[arg(long)]
    quick: bool,

    /// Only these problems, separated by commas: P1 to P7.
    #[arg(long, value_name = "PROBLEM", value_delimiter = ',', value_parser = problem)]
    only: Vec<String>,

    /// Most threads; as many as there are processors without this.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,

    /// Write what was found to this file, too.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,

    /// Draw to this file how a step would scale to many ranks by the model that problem P7 is fitted with: SVG or PNG.
    #[arg(long, value_name = "FILE")]
    draw: Option<PathBuf>,

    /// Run problem P1 with Taichi and NVIDIA Warp, too; needs Python 3 and installs both from the Python package index.
    #[arg(long)]
    peers: bool,

    /// Where the Python environment of `--peers` is made, and kept.
    #[arg(long, value_name = "DIR", default_value = "target/peers", requires = "peers")]
    environment: PathBuf,

    /// Measure nothing: write the scenes of the problems into this folder.
    #[arg(long, value_name = "DIR")]
    scenes: Option<PathBuf>,

    /// A few hundred particles each: whether everything works.
    #[arg(long, hide = true)]
    tiny: bool,

    /// Measure what standard input asks for: what the other options start, in a process of its own.
    #[arg(long, hide = true)]
    measure: bool,
}

fn problem(text: &str) -> Result<String, String> {
    let name = text.trim().to_uppercase();
    if PROBLEMS.contains(&name.as_str()) {
        Ok(name)
    } else {
        Err(format!("allowed: {}", PROBLEMS.join(", ")))
    }
}

#[test]
fn problems_are_known_by_name() {
    assert_eq!(problem("p3").as_deref(), Ok("P3"));
    assert!(problem("P8").unwrap_err().contains("P7"));
}

impl Arguments {
    pub fn execute(self) -> Result<(), Failure> {
        if self.measure {
            return answer();
        }
        let extent = match (self.tiny, self.quick) {
            (true, _) => BenchExtent::Tiny,
            (_, true) => BenchExtent::Quick,
            _ => BenchExtent::Full,
        };
        if self.draw.is_some() && !self.only.is_empty() && !self.only.iter().any(|only| only == "P7") {
            return Err(Failure::Input(miette!(
                "--draw: found no problem P7 to draw; allowed: with --only P7"
            )));
        }
        let all = std::thread::available_parallelism().map_or(1, usize::from);
        if self.draw.is_some() && all < 2 {
            return Err(Failure::Input(miette!(
                "--draw: found 1 core; allowed: 2 or more, on which ranks are measured side by side"
            )));
        }
        let suite = BenchSuite {
            extent,
            only: self.only,
            threads: self.threads.map_or(all, usize::from),
            peers: self.peers.then_some(Peers { environment: self.environment, extent }),
        };
        if let Some(folder) = self.scenes {
            let written = write_scenes(&suite, &folder)?;
            return say(&format!("{}/ holds {written} scenes", folder.display()));
        }
        let record = suite.run()?;
        say(&record.to_string())?;
        if let Some(file) = &self.draw {
            let chart = scaling_chart(&record.models, CLUSTER);
            draw(&chart, file, chart.size())?;
            say(&format!("{} is written", file.display()))?;
        }
        // A moment's measurements say nothing of speed.
        let beyond = record.goals.iter().filter(|goal| goal.is_beyond_bound() && extent != BenchExtent::Tiny);
        let beyond: Vec<&str> = beyond.map(|goal| goal.name.as_str()).collect();
        let sound = if beyond.is_empty() {
            Ok(())
        } else {
            Err(Failure::Run(miette!("worse than is known: {}", beyond.join("; "))))
        };
        let Some(file) = self.json else { return sound };
        let text = serde_json::to_string_pretty(&record).expect("a record is plain data") + "\n";
        files::write(&file, files::MEASUREMENTS, |file| file.write_all(text.as_bytes()))
            .map_err(|error| Failure::unwritten(&file, &error))?;
        say(&format!("{} is written", file.display()))?;
        sound
    }
}
