//! A family of runs: planned, run side by side, by one process or several, recorded in one table.

pub mod among;
mod chart;
mod column;
mod plan;
mod record;
mod script;
mod table;

pub use among::Family;
pub use chart::chart;
pub use column::OwnColumn;
pub use plan::{Member, Plan, Variation, members, varied};
pub use record::{
    Sweep, SweepRecord, SweepRow, forget_row, is_sweep, prepare, read, read_record, read_row, write_row,
    write_table,
};
pub use script::{submit, write_script};
pub use table::table;

use crate::illustration::illustrate;
use crate::jobs;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use stickslip::observe::{ArrivalRow, ContactRow, Results, SceneSource, Status};
use stickslip::ranks::Ranks;
use stickslip::run::{Checkpointing, RunError, RunOptions, Summary};
use stickslip::scene::{Loaded, Parameter};

/// How a process runs its part of a family.
pub struct Crew {
    /// Runs at a time.
    pub jobs: usize,
    /// Threads of each run.
    pub threads: usize,
    /// Folder of the sweep.
    pub folder: PathBuf,
    /// The scene file, for the record of each run.
    pub scene: PathBuf,
    /// Columns of the user's own.
    pub columns: Vec<OwnColumn>,
    /// Wall time between the checkpoints of a run; without one there are none.
    pub checkpoint_every: Option<Duration>,
    /// Set by whoever wants the runs to stop.
    pub stop: Arc<AtomicBool>,
}

/// What happens to the run of this number.
#[derive(Serialize, Deserialize)]
pub enum News {
    /// It has come so far, as a share of its end time.
    Progress(usize, f64),
    /// It has ended.
    Ended(usize, Box<SweepRow>),
    /// It has not begun, for the user stopped before.
    Left(usize),
}

/// Values of the varied parameters in a scene: in SI units where they are numbers, else as they were given.
pub fn values(loaded: &Loaded, member: &Member, varied: &[String]) -> Vec<String> {
    let value = |name: &String| match loaded.scene.parameters.get(name) {
        Some(Parameter::Number(number)) => number.to_string(),
        Some(Parameter::Text(text)) => text.clone(),
        None => {
            member.settings.iter().find(|(other, _)| other == name).map_or(String::new(), |(_, v)| v.clone())
        }
    };
    varied.iter().map(value).collect()
}

/// The row of a run that has finished as it would finish now: by this scene and this version of the program.
pub fn finished(
    folder: &Path,
    record: &SweepRecord,
    (member, loaded): &(Member, Loaded),
) -> Option<SweepRow> {
    let row = read_row(folder, record, &member.folder).filter(SweepRow::is_finished)?;
    jobs::finished(&folder.join(&member.folder), &loaded.scene).map(|_| row)
}

impl Crew {
    /// Runs those of the scenes that are `wanted`, by their numbers, side by side, each in its folder, and tells
    /// `listen` what happens, on this thread. One that was killed or stopped goes on from its newest checkpoint. Runs
    /// that have not begun when the user stops are not begun. Other processes run their part where there are any.
    pub fn run(
        &self,
        scenes: &[Arc<(Member, Loaded)>],
        wanted: &[usize],
        (ranks, mut listen): (Option<&dyn Ranks>, impl FnMut(News)),
    ) {
        let scene_of = |number: usize| Ok(Arc::clone(&scenes[number]));
        match ranks {
            Some(ranks) => among::lead(ranks, (self, wanted), &scene_of, listen),
            None => self.work(&scene_of, |begin, news| {
                wanted.iter().for_each(|&number| begin.send(number).expect("threads take all numbers"));
                drop(begin);
                news.iter().for_each(&mut listen);
            }),
        }
    }

    /// Makes the runs whose numbers `direct` sends, with scenes that are found when they begin; `direct`, on this
    /// thread, hears what happens to them.
    fn work(
        &self,
        scene_of: &(dyn Fn(usize) -> Result<Arc<(Member, Loaded)>, String> + Sync),
        direct: impl FnOnce(Sender<usize>, &Receiver<News>),
    ) {
        let (begin, numbers) = channel();
        let numbers = &Mutex::new(numbers);
        let (sender, receiver) = channel();
        let next = || numbers.lock().unwrap_or_else(PoisonError::into_inner).recv();
        std::thread::scope(|scope| {
            for _ in 0..self.jobs {
                let sender = sender.clone();
                scope.spawn(move || {
                    while let Ok(number) = next() {
                        let news = if self.stop.load(Ordering::Relaxed) {
                            News::Left(number)
                        } else {
                            let made = scene_of(number).map(|scene| self.run_one(&scene, (number, &sender)));
                            News::Ended(number, Box::new(made.unwrap_or_else(failed)))
                        };
                        // Nobody listens only if the listener has failed, which is told elsewhere.
                        let _ = sender.send(news);
                    }
                });
            }
            drop(sender);
            direct(begin, &receiver);
        });
    }

    fn run_one(
        &self,
        (member, loaded): &(Member, Loaded),
        (number, sender): (usize, &Sender<News>),
    ) -> SweepRow {
        let out = &self.folder.join(&member.folder);
        forget_row(&self.folder, &member.folder);
        let pool = match rayon::ThreadPoolBuilder::new().num_threads(self.threads).build() {
            Ok(pool) => pool,
            Err(error) => return failed(error.to_string()),
        };
        let mut progress = |progress: &stickslip::run::Progress| {
            let _ = sender.send(News::Progress(number, progress.time / progress.end));
        };
        let outcome = pool.install(|| {
            let scene = &loaded.scene;
            let build = || {
                let built = stickslip::step::build(scene);
                built.map_err(|problem| loaded.source.locate(problem).to_string())
            };
            let options = self.options(out, (member, loaded));
            // One that finished and has no row was ended while its row was made, and takes no further step.
            let has_finished = jobs::finished(out, scene).is_some();
            if has_finished || matches!(stickslip::run::unfinished(out, scene), Ok(Some(_))) {
                match stickslip::run::resume(scene, &mut *build()?, &options, &mut progress) {
                    // Made by another scene: the run begins anew.
                    Err(RunError::Resume(_)) => {}
                    outcome => return outcome.map_err(|error| error.to_string()),
                }
            }
            stickslip::run::run(scene, &mut *build()?, &options, &mut progress)
                .map_err(|error| error.to_string())
        });
        let drawn = illustrate(out);
        match outcome {
            Err(error) => failed(error),
            Ok(summary) => match (drawn, Results::open(out)) {
                (Ok(_), Ok(results)) => self.with_own_columns(row(&summary, loaded, &results), &results),
                (Err(failure), _) => failed(failure.to_string()),
                (_, Err(error)) => failed(error.to_string()),
            },
        }
    }

    /// The row with what the user's own columns have of the results; of a column without a number it says why.
    fn with_own_columns(&self, mut row: SweepRow, results: &Results) -> SweepRow {
        let mut missing = Vec::new();
        // Of a name that the table has already, the user's own stands there.
        row.figures.retain(|(name, _)| self.columns.iter().all(|column| column.name != *name));
        for column in &self.columns {
            match column.of(results) {
                Ok(value) => row.figures.push((column.name.clone(), value)),
                Err(why) => missing.push(format!("column `{}`: {why}", column.name)),
            }
        }
        row.error = missing.join("; ");
        row
    }

    /// As `stickslip run` makes a run of the scene with these settings.
    fn options(&self, out: &Path, (member, loaded): (&Member, &Loaded)) -> RunOptions {
        let text = Some(loaded.source.text().to_owned());
        let (path, set, every) = (self.scene.clone(), member.settings.clone(), self.checkpoint_every);
        let at_end = every.is_some() || loaded.scene.outputs.checkpoints.is_some();
        RunOptions {
            stop: Arc::clone(&self.stop),
            threads: self.threads,
            source: Some(SceneSource { path, set, until: None, text }),
            checkpoints: Checkpointing { every, at_end, keep: 2 },
            ..RunOptions::new(out)
        }
    }
}

fn failed(error: String) -> SweepRow {
    SweepRow { status: "failed".to_owned(), error, ..SweepRow::default() }
}

/// What a run that reached its end, or was stopped, came to.
fn row(summary: &Summary, loaded: &Loaded, results: &Results) -> SweepRow {
    let performance = &summary.performance;
    let mut figures = vec![
        ("time".to_owned(), performance.time),
        ("steps".to_owned(), performance.steps as f64),
        ("particles".to_owned(), performance.particles as f64),
        ("wall_time".to_owned(), performance.wall_time),
        ("kinetic_energy".to_owned(), summary.end.kinetic),
        ("strain_energy".to_owned(), summary.end.strain),
        ("friction_heat".to_owned(), summary.end.friction),
        ("external_work".to_owned(), summary.end.external_work),
        ("energy_drift".to_owned(), summary.relative_energy_drift()),
    ];
    figures.extend(contact(&results.contacts_table().unwrap_or_default()));
    figures.extend(loaded.scene.outputs.measurements.unit().map(|unit| ("time_unit".to_owned(), unit)));
    let ratio = |reference: &stickslip::run::ReferenceResult| {
        (format!("ratio {} {}", reference.body, reference.quantity), reference.ratio())
    };
    figures.extend(summary.references.iter().map(ratio));
    figures.extend(arrivals(results.arrivals_table().unwrap_or_default()));
    let speeds = results.front_speeds_table().unwrap_or_default();
    figures.extend(speeds.into_iter().map(|row| (format!("speed {}", row.front), row.speed)));
    let status = if summary.status == Status::Interrupted { "interrupted" } else { "finished" };
    SweepRow { status: status.to_owned(), figures, ..SweepRow::default() }
}

/// When bodies first pushed on each other, to a row of the table, and the largest push of a pair.
/// Without contact there is neither.
fn contact(rows: &[ContactRow]) -> Vec<(String, f64)> {
    let Some(first) = rows.iter().find(|row| row.mean.normal > 0.0) else { return Vec::new() };
    let largest = rows.iter().map(|row| row.mean.normal).fold(0.0, f64::max);
    vec![("first_contact".to_owned(), first.time), ("largest_push".to_owned(), largest)]
}

/// Columns of arrivals. Thresholds may differ from run to run, so their names leave them out; where one place watches
/// several of a quantity, they are numbered from the lowest.
fn arrivals(mut rows: Vec<ArrivalRow>) -> Vec<(String, f64)> {
    rows.sort_by(|a, b| a.threshold.abs().total_cmp(&b.threshold.abs()));
    let mut columns: Vec<(String, f64)> = Vec::new();
    for row in rows {
        let reading = if row.reading == "any" || row.reading == "mean" {
            format!(" {}", row.reading)
        } else {
            String::new()
        };
        let name = format!("arrival {} {}{reading}", row.quantity, row.place);
        let same = columns.iter().filter(|(other, _)| other.split(" #").next() == Some(&name)).count();
        columns.push((if same > 0 { format!("{name} #{}", same + 1) } else { name }, row.time));
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrivals_of_several_thresholds_are_told_apart() {
        let row = |threshold: f64, reading: &str, time: f64| ArrivalRow {
            time,
            threshold,
            quantity: "xx".to_owned(),
            place: "bar".to_owned(),
            reading: reading.to_owned(),
            ..ArrivalRow::default()
        };
        let columns =
            arrivals(vec![row(-2.0, "center", 3.0), row(-1.0, "center", 1.0), row(-1.0, "any", 0.5)]);
        let names: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["arrival xx bar", "arrival xx bar any", "arrival xx bar #2"]);
        assert_eq!(columns[2].1, 3.0);
    }
}
