//! How fast Stickslip is, for developers: beside the problems of `stickslip bench`, more problems, and goals.
//!
//! The rooms in the order of data: whole runs with and without outputs, problems on ranks, what they would take on
//! many, other programs, ratios against goals, and the report of it all.

mod end_to_end;
mod goals;
mod on_ranks;
mod peers;
mod record;
mod report;
mod scaling;
mod suite;

use clap::Parser;
use miette::miette;
use peers::Peers;
use scaling::CLUSTER;
use std::path::PathBuf;
use std::process::ExitCode;
use stickslip::observe::replace;
use stickslip_cli::bench::{BenchExtent, BenchSuite, Failure, MEASURE, answer, draw, problem_of};
use suite::{DeveloperSuite, PROBLEMS};

/// Measure this machine's limits and all problems, and hold them against their goals.
#[derive(Debug, Parser)]
#[command(name = "stickslip-bench")]
struct Arguments {
    /// Fewer and smaller problems: a few minutes.
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

    /// A few hundred particles each: whether everything works.
    #[arg(long, hide = true)]
    tiny: bool,
}

fn problem(text: &str) -> Result<String, String> {
    problem_of(&PROBLEMS, text)
}

fn main() -> ExitCode {
    // What the program starts itself.
    let ended = if std::env::args().skip(1).eq(MEASURE) { answer() } else { Arguments::parse().execute() };
    match ended {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.print();
            ExitCode::from(failure.exit_code())
        }
    }
}

impl Arguments {
    fn execute(self) -> Result<(), Failure> {
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
        let threads = self.threads.map_or(all, usize::from);
        let record = DeveloperSuite {
            problems: BenchSuite { extent, only: self.only, threads },
            peers: self.peers.then_some(Peers { environment: self.environment, extent }),
        }
        .run()?;
        println!("{record}");
        if let Some(file) = &self.draw {
            let chart = scaling::chart(&record.models, CLUSTER);
            draw(&chart, file, chart.size())?;
            println!("{} is written", file.display());
        }
        if let Some(file) = &self.json {
            let text = serde_json::to_string_pretty(&record).expect("a record is plain data") + "\n";
            replace(file, |file| file.write_all(text.as_bytes())).map_err(Failure::input)?;
            println!("{} is written", file.display());
        }
        // A moment's measurements say nothing of speed.
        let beyond = record.goals.iter().filter(|goal| goal.is_beyond_bound() && extent != BenchExtent::Tiny);
        let beyond: Vec<&str> = beyond.map(|goal| goal.name.as_str()).collect();
        match beyond.is_empty() {
            true => Ok(()),
            false => Err(Failure::Run(miette!("worse than is known: {}", beyond.join("; ")))),
        }
    }
}
