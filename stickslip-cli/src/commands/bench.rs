//! `stickslip bench`: how fast the program is, and how fast this machine could be.

use super::say;
use crate::bench::{BenchExtent, BenchSuite, PROBLEMS, answer, problem_of, write_scenes};
use crate::failure::Failure;
use crate::files;
use clap::Args;
use std::path::PathBuf;

/// Measure this machine's limits, and how near the program comes to them.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Fewer and smaller problems: under a minute.
    #[arg(long)]
    quick: bool,

    /// Only these problems, separated by commas: P1 to P5.
    #[arg(long, value_name = "PROBLEM", value_delimiter = ',', value_parser = problem)]
    only: Vec<String>,

    /// Most threads; as many as there are processors without this.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,

    /// Write what was found to this file, too.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,

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
    problem_of(&PROBLEMS, text)
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
        let all = std::thread::available_parallelism().map_or(1, usize::from);
        let suite = BenchSuite { extent, only: self.only, threads: self.threads.map_or(all, usize::from) };
        if let Some(folder) = self.scenes {
            let written = write_scenes(&suite, &folder)?;
            return say(&format!("{}/ holds {written} scenes", folder.display()));
        }
        let record = suite.run()?;
        say(&record.to_string())?;
        let Some(file) = self.json else { return Ok(()) };
        let text = serde_json::to_string_pretty(&record).expect("a record is plain data") + "\n";
        files::write(&file, files::MEASUREMENTS, |file| file.write_all(text.as_bytes()))
            .map_err(|error| Failure::unwritten(&file, &error))?;
        say(&format!("{} is written", file.display()))
    }
}
