//! `stickslip reproduce`: the whole paper from one command.

use super::{say, stop_on_interrupt};
use crate::failure::Failure;
use crate::jobs::{Earlier, JobRunner};
use crate::reproduce::{PaperResolution, STUDIES, Study, reproduce};
use clap::Args;
use clap::builder::PossibleValuesParser;
use miette::miette;
use std::path::PathBuf;

/// Run every application of the paper and write a report of it, one HTML file.
///
/// Runs that are finished stand, and are not run again: what was stopped goes on where it was.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Coarse: minutes instead of hours on two cores.
    #[arg(long)]
    quick: bool,

    /// As coarse as anything runs, to try the report itself.
    #[arg(long, hide = true)]
    sketch: bool,

    /// Folder for the report and the results of the runs.
    #[arg(long, value_name = "DIR", default_value = "reproduce.results")]
    out: PathBuf,

    /// Only these parts of the paper, separated by commas.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = PossibleValuesParser::new(names()))]
    only: Vec<String>,

    /// Run everything again, also what is finished.
    #[arg(long)]
    fresh: bool,

    /// Threads for all runs together; as many as there are processors without this.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

/// Name of the report in its folder.
const REPORT: &str = "report.html";

fn names() -> Vec<&'static str> {
    STUDIES.iter().map(|study| study.name()).collect()
}

impl Arguments {
    pub fn execute(self) -> Result<(), Failure> {
        let chosen =
            |study: &&&dyn Study| self.only.is_empty() || self.only.iter().any(|name| name == study.name());
        let studies: Vec<&dyn Study> = STUDIES.iter().filter(chosen).copied().collect();
        let level = match (self.sketch, self.quick) {
            (true, _) => PaperResolution::Sketch,
            (false, true) => PaperResolution::Quick,
            (false, false) => PaperResolution::Full,
        };
        std::fs::create_dir_all(&self.out)
            .map_err(|error| Failure::Input(miette!("cannot make {}: {error}", self.out.display())))?;
        let processors = || std::thread::available_parallelism().map_or(1, usize::from);
        let jobs = JobRunner {
            folder: self.out.join("runs"),
            threads: self.threads.map_or_else(processors, usize::from),
            stop: stop_on_interrupt()?,
            earlier: if self.fresh { Earlier::Replace } else { Earlier::Keep },
        };
        let (page, runs) = reproduce(&studies, level, &jobs)?;
        let report = self.out.join(REPORT);
        page.write(&report)?;
        say(&format!("{} is written; open it in a browser", report.display()))?;
        let failures = runs.failures();
        let names: Vec<&str> = failures.iter().map(|failure| failure.name).collect();
        match names.len() {
            0 => Ok(()),
            count => Err(Failure::Run(miette!("{count} runs failed: {}", names.join(", ")))),
        }
    }
}
