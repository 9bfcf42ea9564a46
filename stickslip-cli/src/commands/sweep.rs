//! `stickslip sweep SCENE --set nu=0.22,0.30`: a family of runs, and one table of what they came to; `stickslip sweep
//! DIR` goes on with it.

use super::run::{WallTime, default_folder, wall_time};
use super::{assignment, load, say, stop_on_interrupt};
use crate::chart::draw;
use crate::drawing::DrawError;
use crate::failure::Failure;
use crate::progress::{FamilyDisplay, terminal};
use crate::ranks;
use crate::sweep::{
    self, Crew, Family, Member, News, OwnColumn, Plan, Sweep, SweepRecord, SweepRow, Variation,
};
use crate::tell::tell;
use clap::Args;
use miette::{IntoDiagnostic, miette};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use stickslip::scene::{FileRead, Loaded};

/// Run a scene with every combination of some values, each in a folder of its own, and write one table of the results.
///
/// Of the folder of a sweep, the runs that have not finished are run, those that were killed or stopped from their newest
/// checkpoint.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file, or the folder of a sweep to go on with.
    #[arg(value_name = "SCENE|DIR")]
    scene: PathBuf,

    /// Values of a named parameter, separated by commas; a single value holds for all runs; may be repeated.
    #[arg(long = "set", value_name = "NAME=VALUE,...", value_parser = variation)]
    variations: Vec<Variation>,

    /// A column of sweep.csv of your own: `peak=largest contacts.normal`, `sink=last bodies.y of pile`; of a table as
    /// `stickslip plot --table` names it, the `largest`, `smallest`, `last` or `mean` of a column, of all rows or those
    /// of a name or pattern; may be repeated.
    #[arg(long = "column", value_name = "NAME=WHICH TABLE.COLUMN [of ROW]", value_parser = column)]
    columns: Vec<OwnColumn>,

    /// Folder for the results; the name of the scene with `.sweep`, in this folder, without this.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Run nothing, but write array.sh into the folder, by which SLURM runs the sweep as a job array.
    #[arg(long)]
    script: bool,

    /// Of a folder, only the runs of these numbers, from 0 in the order of sweep.csv, which is not written; for jobs of
    /// an array.
    #[arg(long, value_name = "NUMBER,...", value_delimiter = ',', conflicts_with_all = ["script", "gather"])]
    only: Vec<usize>,

    /// Of a folder, run nothing: make the table of the runs that have ended, and name the others.
    #[arg(long, conflicts_with = "script")]
    gather: bool,

    /// Runs at a time, in each process; as many as it has processors without this.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024), conflicts_with_all = ["script", "gather"])]
    jobs: Option<u16>,

    /// Threads of all runs together, in each process; as many as it has processors without this.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024), conflicts_with_all = ["script", "gather"])]
    threads: Option<u16>,

    /// Wall time between the checkpoints of a run, from which it goes on: "10min", "1h 30min"; "never" leaves out the
    /// one at the end, too.
    #[arg(
        long,
        value_name = "TIME",
        default_value = "10min",
        value_parser = wall_time,
        conflicts_with_all = ["script", "gather"]
    )]
    checkpoint_every: WallTime,
}

fn variation(text: &str) -> Result<Variation, String> {
    let (name, list) = assignment(text)?;
    Variation::new(&name, &list)
}

fn column(text: &str) -> Result<OwnColumn, String> {
    let (name, what) = assignment(text)?;
    OwnColumn::new(&name, &what)
}

impl Arguments {
    pub fn execute(self) -> Result<(), Failure> {
        let (plan, folder) = self.plan()?;
        let folder_of_all = std::path::absolute(&folder).into_diagnostic().map_err(Failure::Run)?;
        if ranks::count() > 1 && folder_of_all.to_str().is_none() {
            let found = folder_of_all.display();
            return Err(Failure::Input(miette!(
                "found the folder {found}; allowed: a name in UTF-8, where processes share a sweep"
            )));
        }
        let varied = sweep::varied(&plan.variations);
        // All scenes are read before anything is run or written: a mistake costs no time.
        let scene = std::path::absolute(plan.scene_file(&folder)).into_diagnostic().map_err(Failure::Run)?;
        let read = |member: Member| match load(&scene, &member.settings) {
            Ok(loaded) => Ok(Arc::new((member, loaded))),
            Err(error) => Err(Failure::input(error)),
        };
        let members: Result<Vec<Arc<(Member, Loaded)>>, Failure> =
            sweep::members(&plan.variations).into_iter().map(read).collect();
        let members = members?;
        if let Some(unknown) = self.only.iter().find(|&&number| number >= members.len()) {
            let last = members.len() - 1;
            return Err(Failure::Input(miette!(
                "--only: found {unknown}; allowed: numbers from 0 to {last}"
            )));
        }
        let record = SweepRecord::new(&members[0].1.scene.title, varied.clone(), plan.clone());
        let pending = |(member, loaded): &(Member, Loaded)| SweepRow {
            run: member.folder.clone(),
            status: "pending".to_owned(),
            parameters: sweep::values(loaded, member, &varied),
            ..SweepRow::default()
        };
        let ended = |each: &(Member, Loaded)| {
            let unfinished = || sweep::read_row(&folder, &record, &each.0.folder).filter(|_| self.gather);
            let finished = sweep::finished(&folder, &record, each);
            finished.or_else(|| unfinished().filter(|row| !row.is_finished()))
        };
        // One that begins runs everything; a script is for what is left of it.
        let stands = self.goes_on() || self.script;
        let row = |each: &Arc<(Member, Loaded)>| {
            Some(each).filter(|_| stands).and_then(|each| ended(each)).unwrap_or_else(|| pending(each))
        };
        let rows: Vec<SweepRow> = members.iter().map(row).collect();
        if !self.goes_on() {
            self.tell_of_another(&folder, &plan);
            let kept = rows.iter().filter(|row| row.is_finished()).map(|row| row.run.as_str());
            sweep::prepare(&folder, &record, &kept.collect::<Vec<_>>())?;
        }
        let mut table = Sweep { record, rows };
        if self.script {
            return self.submit_later(&folder, &table);
        }
        let is_considered = |number: &usize| self.only.is_empty() || self.only.contains(number);
        let left = |table: &Sweep| table.unfinished().into_iter().filter(is_considered).collect::<Vec<_>>();
        let wanted = if self.gather { Vec::new() } else { left(&table) };
        let limits = [self.jobs, self.threads].map(|limit| limit.map(usize::from));
        let text = members[0].1.source.text().to_owned();
        let WallTime(checkpoint_every) = self.checkpoint_every;
        let (folder_of_all, scene) = (folder_of_all, (scene, text));
        let files: BTreeSet<FileRead> = members.iter().flat_map(|each| each.1.files.clone()).collect();
        let (files, runs) = (files.into_iter().collect(), wanted.len());
        let family = Family { plan, folder: folder_of_all, scene, files, runs, limits, checkpoint_every };
        let crew = family.crew(folder, [ranks::count(), ranks::neighbours()], stop_on_interrupt()?);
        self.run(&crew, (&family, &members), &wanted, &mut table)?;
        if self.only.is_empty() {
            draw_and_tell(&crew, &table)?;
        }
        conclude(&crew, &table, &left(&table))
    }

    /// Tells the user that the folder has the results of another sweep, if it has.
    fn tell_of_another(&self, folder: &Path, plan: &Plan) {
        let before = sweep::read_record(folder).map(|record| record.plan);
        if before.is_some_and(|before| before != *plan) {
            let folder = folder.display();
            tell!(
                "note: {folder} had a sweep of another scene or other values: sweep.csv is made anew, and folders of \
                   runs that are not of this one stay"
            );
        }
    }

    /// Whether it goes on with a sweep that there is.
    fn goes_on(&self) -> bool {
        self.scene.is_dir()
    }

    /// What is run, and the folder of the sweep.
    fn plan(&self) -> Result<(Plan, PathBuf), Failure> {
        let folder = &self.scene;
        if !self.goes_on() {
            if self.gather || !self.only.is_empty() {
                let option = if self.gather { "--gather" } else { "--only" };
                return Err(Failure::Input(miette!(
                    "{option}: found a scene file; allowed: the folder of a sweep"
                )));
            }
            if !self.scene.exists() {
                load(&self.scene, &[]).map_err(Failure::input)?;
            }
            self.check()?;
            let folder = self.out.clone().unwrap_or_else(|| default_folder(&self.scene, "sweep"));
            let plan = Plan::new(&self.scene, &folder, self.variations.clone());
            let plan = plan.into_diagnostic().map_err(Failure::Run)?;
            return Ok((Plan { columns: self.columns.clone(), ..plan }, folder));
        }
        let given = [
            ("--out", self.out.is_some()),
            ("--set", !self.variations.is_empty()),
            ("--column", !self.columns.is_empty()),
        ];
        if let Some((option, _)) = given.into_iter().find(|(_, is_given)| *is_given) {
            return Err(Failure::Input(miette!(
                "{option}: found the folder of a sweep, which goes on as it was begun; allowed: with a scene file"
            )));
        }
        let record = sweep::read_record(folder).ok_or_else(|| {
            Failure::Input(miette!(
                help = "name a scene file, or a folder that `stickslip sweep` wrote",
                "{} is not the folder of a sweep",
                folder.display()
            ))
        })?;
        Ok((record.plan, folder.clone()))
    }

    fn check(&self) -> Result<(), Failure> {
        let names: Vec<&str> = self.variations.iter().map(|variation| variation.name.as_str()).collect();
        if names.is_empty() {
            return Err(Failure::Input(miette!(
                "--set: found none; allowed: at least one with several values, such as friction=0,0.3"
            )));
        }
        if let Some(again) = (1..names.len()).find(|&i| names[..i].contains(&names[i])) {
            return Err(Failure::Input(miette!(
                "--set: found `{}` twice; allowed: each name once, its values separated by commas",
                names[again]
            )));
        }
        let columns: Vec<&str> = self.columns.iter().map(|column| column.name.as_str()).collect();
        if let Some(again) = (1..columns.len()).find(|&i| columns[..i].contains(&columns[i])) {
            return Err(Failure::Input(miette!(
                "--column: found `{}` twice; allowed: each name once",
                columns[again]
            )));
        }
        if sweep::varied(&self.variations).is_empty() {
            return Err(Failure::Input(miette!(
                help = "for a single run there is `stickslip run`",
                "--set: found one value for each name; allowed: several for at least one, such as {}=1,2",
                names[0]
            )));
        }
        Ok(())
    }

    /// Runs what is wanted, and writes what each run came to as it ends.
    fn run(
        &self,
        crew: &Crew,
        (family, members): (&Family, &[Arc<(Member, Loaded)>]),
        wanted: &[usize],
        table: &mut Sweep,
    ) -> Result<(), Failure> {
        let mut written = Ok(());
        if self.only.is_empty() {
            sweep::write_table(&crew.folder, table)?;
        }
        let mut display = FamilyDisplay::new(wanted.len(), terminal());
        let place_in_family = |number: usize| wanted.iter().position(|&other| other == number).unwrap_or(0);
        let listen = |news| match news {
            News::Progress(number, share) => display.show(place_in_family(number), share),
            News::Left(_) => {}
            News::Ended(number, row) => {
                let place = &mut table.rows[number];
                *place = SweepRow { run: place.run.clone(), parameters: place.parameters.clone(), ..*row };
                let told = format!("{}: {} {}", place.run, place.status, place.error);
                display.ended(place_in_family(number), &told);
                let row = sweep::write_row(&crew.folder, &table.record, &table.rows[number]);
                let whole = self.only.is_empty().then(|| sweep::write_table(&crew.folder, table));
                // The first trouble counts; what can be written is, all the same.
                if let Err(trouble) = row.and(whole.unwrap_or(Ok(())))
                    && written.is_ok()
                {
                    written = Err(trouble);
                }
            }
        };
        crew.run(members, wanted, (ranks::share_family(family).as_deref(), listen));
        display.finish();
        written
    }

    /// Writes the script of a job array, and says how it is used.
    fn submit_later(&self, folder: &Path, table: &Sweep) -> Result<(), Failure> {
        sweep::write_table(folder, table)?;
        let runs = table.rows.len();
        sweep::write_script(folder, runs)?;
        let (left, gather) = (table.unfinished(), format!("stickslip sweep {} --gather", folder.display()));
        if left.is_empty() {
            return say(&format!("all {runs} runs have finished: {gather}"));
        }
        say(&format!("{} of {runs} runs to do\n{}\nthen {gather}", left.len(), sweep::submit(folder, &left)))
    }
}

/// Draws the chart, and says what the runs came to and where everything is.
fn draw_and_tell(crew: &Crew, table: &Sweep) -> Result<(), Failure> {
    let (chart, file) = (sweep::chart(table, &[]), crew.folder.join("plot.png"));
    let drawn = match draw(&chart, &file, chart.size()) {
        Ok(()) => ", plot.png",
        Err(DrawError::Empty(_)) => {
            // One that is there shows an earlier sweep.
            let _ = std::fs::remove_file(&file);
            ""
        }
        Err(error) => return Err(error.into()),
    };
    let runs = table.rows.len();
    say(&sweep::table(table))?;
    say(&format!(
        "{} of {runs} runs finished\nresults in {}/: sweep.csv{drawn}, a folder for each run",
        runs - table.unfinished().len(),
        crew.folder.display()
    ))
}

/// Names what failed and what has not ended of the runs that are left, and how they are run again.
fn conclude(crew: &Crew, table: &Sweep, left: &[usize]) -> Result<(), Failure> {
    let again = sweep::submit(&crew.folder, left);
    let rows = left.iter().map(|&number| &table.rows[number]);
    let failed: Vec<String> =
        rows.filter(|row| row.status == "failed").map(|row| format!("{}: {}", row.run, row.error)).collect();
    let runs = table.rows.len();
    if !failed.is_empty() {
        return Err(Failure::Run(miette!(
            help = format!("{again} runs what did not finish again"),
            "{} of {runs} runs failed\n  {}",
            failed.len(),
            failed.join("\n  ")
        )));
    }
    if crew.stop.load(Ordering::Relaxed) {
        return Err(Failure::Interrupted);
    }
    if !left.is_empty() {
        say(&format!("{} of {runs} runs have not finished: {again}", left.len()))?;
    }
    Ok(())
}
