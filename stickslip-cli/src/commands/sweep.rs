//! `stickslip sweep SCENE --set nu=0.22,0.30`: a family of runs, and one table of what they came to.

use super::run::default_folder;
use super::{assignment, load, say, stop_on_interrupt};
use crate::chart::draw;
use crate::drawing::DrawError;
use crate::failure::Failure;
use crate::progress::{Family, terminal};
use crate::sweep::{self, Crew, Member, News, Sweep, SweepRecord, SweepRow, Variation};
use clap::Args;
use miette::miette;
use std::num::NonZero;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use stickslip::scene::Loaded;

/// Run a scene with every combination of some values, each in a folder of its own, and write one table of the results.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file.
    scene: PathBuf,

    /// Values of a named parameter, separated by commas; a single value holds for all runs; may be repeated.
    #[arg(long = "set", value_name = "NAME=VALUE,...", value_parser = variation, required = true)]
    variations: Vec<Variation>,

    /// Folder for the results; the name of the scene with `.sweep`, in this folder, without this.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Runs at a time; as many as there are processors without this.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,

    /// Threads of all runs together; as many as there are processors without this.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

fn variation(text: &str) -> Result<Variation, String> {
    let (name, list) = assignment(text)?;
    Variation::new(&name, &list)
}

impl Arguments {
    pub fn execute(self) -> Result<(), Failure> {
        let varied = sweep::varied(&self.variations);
        self.check(&varied)?;
        // All scenes are read before anything is run or written: a mistake costs no time.
        let read = |member: Member| match load(&self.scene, &member.settings) {
            Ok(loaded) => Ok((member, loaded)),
            Err(error) => Err(Failure::input(error)),
        };
        let members: Result<Vec<(Member, Loaded)>, Failure> =
            sweep::members(&self.variations).into_iter().map(read).collect();
        let members = members?;
        let pending = |(member, loaded): &(Member, Loaded)| SweepRow {
            run: member.folder.clone(),
            status: "pending".to_owned(),
            parameters: sweep::values(loaded, member, &varied),
            ..SweepRow::default()
        };
        let record = SweepRecord::new(&members[0].1.scene.title, varied.clone());
        let mut table = Sweep { record, rows: members.iter().map(pending).collect() };
        let folder = self.out.clone().unwrap_or_else(|| default_folder(&self.scene, "sweep"));
        sweep::prepare(&folder, &table.record)?;
        sweep::write_table(&folder, &table)?;

        let processors = std::thread::available_parallelism().map_or(1, NonZero::get);
        let threads = self.threads.map_or(processors, usize::from);
        let jobs = self.jobs.map_or(threads, usize::from).clamp(1, members.len());
        let crew = Crew { jobs, threads: (threads / jobs).max(1), folder, stop: stop_on_interrupt()? };
        let mut written = Ok(());
        let mut display = Family::new(members.len(), terminal());
        crew.run(&members, |news| {
            for each in news {
                match each {
                    News::Progress(number, share) => display.show(number, share),
                    News::Ended(number, row) => {
                        let place = &mut table.rows[number];
                        *place =
                            SweepRow { run: place.run.clone(), parameters: place.parameters.clone(), ..*row };
                        display.ended(number, &format!("{}: {} {}", place.run, place.status, place.error));
                        if written.is_ok() {
                            written = sweep::write_table(&crew.folder, &table);
                        }
                    }
                }
            }
        });
        display.finish();
        written?;
        conclude(&crew, &table)
    }

    fn check(&self, varied: &[String]) -> Result<(), Failure> {
        let names: Vec<&str> = self.variations.iter().map(|variation| variation.name.as_str()).collect();
        if let Some(again) = (1..names.len()).find(|&i| names[..i].contains(&names[i])) {
            return Err(Failure::Input(miette!(
                "--set: found `{}` twice; allowed: each name once, its values separated by commas",
                names[again]
            )));
        }
        if varied.is_empty() {
            return Err(Failure::Input(miette!(
                help = "for a single run there is `stickslip run`",
                "--set: found one value for each name; allowed: several for at least one, such as {}=1,2",
                names[0]
            )));
        }
        Ok(())
    }
}

/// Draws the chart, says where everything is, and names what failed.
fn conclude(crew: &Crew, table: &Sweep) -> Result<(), Failure> {
    let chart = sweep::chart(table, &[]);
    let drawn = match draw(&chart, &crew.folder.join("plot.png"), chart.size()) {
        Ok(()) => ", plot.png",
        Err(DrawError::Empty(_)) => "",
        Err(error) => return Err(error.into()),
    };
    let count = |status: &str| table.rows.iter().filter(|row| row.status == status).count();
    let runs = table.rows.len();
    say(&sweep::table(table))?;
    say(&format!(
        "{} of {runs} runs finished\nresults in {}/: sweep.csv{drawn}, a folder for each run",
        count("finished"),
        crew.folder.display()
    ))?;
    let failed = table.rows.iter().filter(|row| row.status == "failed");
    let failed: Vec<String> = failed.map(|row| format!("{}: {}", row.run, row.error)).collect();
    if !failed.is_empty() {
        return Err(Failure::Run(miette!(
            "{} of {runs} runs failed\n  {}",
            failed.len(),
            failed.join("\n  ")
        )));
    }
    if crew.stop.load(Ordering::Relaxed) { Err(Failure::Interrupted) } else { Ok(()) }
}
