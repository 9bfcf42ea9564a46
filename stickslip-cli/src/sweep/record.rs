//! `sweep.json` and `sweep.csv`: what a sweep varied, and what each run came to. Each run that ends writes its row into a
//! file of its own in `rows/`, of which the table is made: runs of a sweep may be those of several programs.

use super::plan::Plan;
use crate::failure::Failure;
use miette::miette;
use serde::{Deserialize, Serialize};
use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use stickslip::observe::{replace, whole_name};

/// What was swept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepRecord {
    /// `stickslip`.
    program: String,
    /// Version of the program.
    version: String,
    /// Title of the scene with the first values.
    pub title: String,
    /// Names of the parameters that vary, in the order of the columns.
    pub parameters: Vec<String>,
    /// What is run.
    pub plan: Plan,
}

/// One run; a row of `sweep.csv`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SweepRow {
    /// Name of its folder.
    pub run: String,
    /// `finished`, `interrupted`, `failed`, or `pending`.
    pub status: String,
    /// Values of the parameters that vary.
    pub parameters: Vec<String>,
    /// Numbers by the names of their columns.
    pub figures: Vec<(String, f64)>,
    /// What went wrong.
    pub error: String,
}

/// A sweep that was run.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// What was swept.
    pub record: SweepRecord,
    /// The runs in the order of the plan.
    pub rows: Vec<SweepRow>,
}

impl SweepRow {
    /// Whether the run came to its end.
    pub fn is_finished(&self) -> bool {
        self.status == "finished"
    }
}

impl Sweep {
    /// Numbers of the runs that have not come to their end.
    pub fn unfinished(&self) -> Vec<usize> {
        (0..self.rows.len()).filter(|&number| !self.rows[number].is_finished()).collect()
    }

    /// Names of the numbers that its runs have, in the order of the columns.
    pub fn figures(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for (name, _) in self.rows.iter().flat_map(|row| &row.figures) {
            if !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
        names
    }
}

const RECORD: &str = "sweep.json";
const TABLE: &str = "sweep.csv";
/// Folder of the rows.
const ROWS: &str = "rows";

impl SweepRecord {
    pub fn new(title: &str, parameters: Vec<String>, plan: Plan) -> Self {
        let (program, version) = ("stickslip".to_owned(), env!("CARGO_PKG_VERSION").to_owned());
        SweepRecord { program, version, title: title.to_owned(), parameters, plan }
    }
}

/// Whether a folder is that of a sweep.
pub fn is_sweep(folder: &Path) -> bool {
    read_record(folder).is_some()
}

/// What was swept in a folder; `None` if it is not that of a sweep.
pub fn read_record(folder: &Path) -> Option<SweepRecord> {
    let record: SweepRecord = serde_json::from_slice(&fs::read(folder.join(RECORD)).ok()?).ok()?;
    (record.program == "stickslip").then_some(record)
}

/// Makes the folder of a sweep, which may hold its scene already, or takes over that of an earlier one. There, of the
/// runs only those rows are left that are `kept`; the others are replaced as they are run again.
///
/// # Errors
/// The folder holds files that are not those of a sweep, or cannot be written.
pub fn prepare(folder: &Path, record: &SweepRecord, kept: &[&str]) -> Result<(), Failure> {
    let unusable = |source: io::Error| {
        let help = "give a folder that you may write to with --out";
        Failure::Input(miette!(help = help, "cannot write results to {}: {source}", folder.display()))
    };
    fs::create_dir_all(folder).map_err(unusable)?;
    let own = record.plan.scene_file(folder);
    if !is_sweep(folder) {
        for entry in fs::read_dir(folder).map_err(unusable)? {
            let entry = entry.map_err(unusable)?;
            if entry.path() == own || is_of_killed(&entry.path()) {
                continue;
            }
            return Err(Failure::Input(miette!(
                help = "give a folder that is new or empty, or one that `stickslip sweep` wrote, with --out",
                "{} holds files that are not the results of a sweep, such as `{}`",
                folder.display(),
                entry.file_name().display()
            )));
        }
    }
    for entry in fs::read_dir(folder).map_err(unusable)? {
        let path = entry.map_err(unusable)?.path();
        if path.file_name().and_then(OsStr::to_str).and_then(whole_name) == Some(RECORD) {
            fs::remove_file(&path).map_err(unusable)?;
        }
    }
    let text = serde_json::to_vec_pretty(record).expect("a record is plain data");
    let rows = folder.join(ROWS);
    if rows.exists() {
        for entry in fs::read_dir(&rows).map_err(unusable)? {
            let path = entry.map_err(unusable)?.path();
            if !kept.iter().any(|run| path == row_file(folder, run)) {
                fs::remove_file(&path).map_err(unusable)?;
            }
        }
    } else {
        fs::create_dir(&rows).map_err(unusable)?;
    }
    write(&folder.join(RECORD), &text).map_err(unusable)
}

/// Whether a sweep that is killed before its record is whole leaves this: the half of that, or the folder of rows, with
/// none in it.
fn is_of_killed(path: &Path) -> bool {
    let name = path.file_name().and_then(OsStr::to_str).unwrap_or_default();
    let is_empty = || fs::read_dir(path).is_ok_and(|mut entries| entries.next().is_none());
    whole_name(name) == Some(RECORD) || name == ROWS && is_empty()
}

/// Where the row of a run is.
fn row_file(folder: &Path, run: &str) -> PathBuf {
    folder.join(ROWS).join(format!("{run}.csv"))
}

/// Writes the row of a run, as `sweep.csv` has it.
///
/// # Errors
/// It cannot be written.
pub fn write_row(folder: &Path, record: &SweepRecord, row: &SweepRow) -> Result<(), Failure> {
    let alone = Sweep { record: record.clone(), rows: vec![row.clone()] };
    write_rows(&row_file(folder, &row.run), &alone)
}

/// Removes the row of a run that begins.
pub fn forget_row(folder: &Path, run: &str) {
    // One that stays is that of another scene or program, and is not believed.
    let _ = fs::remove_file(row_file(folder, run));
}

/// The row of a run that has ended.
pub fn read_row(folder: &Path, record: &SweepRecord, run: &str) -> Option<SweepRow> {
    read_rows(&row_file(folder, run), record).ok()?.pop()
}

/// Writes `sweep.csv` as it stands.
///
/// # Errors
/// It cannot be written.
pub fn write_table(folder: &Path, sweep: &Sweep) -> Result<(), Failure> {
    write_rows(&folder.join(TABLE), sweep)
}

fn write_rows(path: &Path, sweep: &Sweep) -> Result<(), Failure> {
    let figures = sweep.figures();
    let mut writer = csv::Writer::from_writer(Vec::new());
    let parameters = sweep.record.parameters.iter().map(String::as_str);
    // A parameter may have the name of a figure.
    let figure_name = |name: &&str| {
        let taken = sweep.record.parameters.iter().any(|parameter| parameter == name);
        if taken { format!("{name}_of_run") } else { (*name).to_owned() }
    };
    let header = ["run", "status"].into_iter().chain(parameters).map(str::to_owned);
    let header = header.chain(figures.iter().map(figure_name)).chain(["error".to_owned()]);
    writer.write_record(header).expect("a vector takes all bytes");
    for row in &sweep.rows {
        let value = |name: &&str| {
            let figure = row.figures.iter().find(|(other, _)| other == name);
            figure.map_or(String::new(), |(_, value)| value.to_string())
        };
        let mut fields = vec![row.run.clone(), row.status.clone()];
        fields.extend(row.parameters.iter().cloned());
        fields.extend(figures.iter().map(value));
        fields.push(row.error.clone());
        writer.write_record(fields).expect("rows are as long as the header");
    }
    let bytes = writer.into_inner().expect("a vector takes all bytes");
    write(path, &bytes).map_err(|source| Failure::Run(miette!("cannot write {}: {source}", path.display())))
}

/// Reads the folder of a sweep.
///
/// # Errors
/// It is none, or its table is damaged.
pub fn read(folder: &Path) -> Result<Sweep, Failure> {
    let path = folder.join(TABLE);
    let damaged = |why: &str| Failure::Input(miette!("cannot read {}: {why}", path.display()));
    let record = read_record(folder).ok_or_else(|| damaged("the folder is not that of a sweep"))?;
    let rows = read_rows(&path, &record).map_err(|why| damaged(&why))?;
    Ok(Sweep { record, rows })
}

fn read_rows(path: &Path, record: &SweepRecord) -> Result<Vec<SweepRow>, String> {
    let mut reader = csv::Reader::from_path(path).map_err(|error| error.to_string())?;
    let header = reader.headers().map_err(|error| error.to_string())?.clone();
    let end = 2 + record.parameters.len();
    if header.len() <= end {
        return Err("columns are missing".to_owned());
    }
    if !header.iter().skip(2).zip(&record.parameters).all(|(found, name)| found == name) {
        return Err("its parameters are those of another sweep".to_owned());
    }
    let mut rows = Vec::new();
    for line in reader.records() {
        let line = line.map_err(|error| error.to_string())?;
        let figures =
            (end..header.len() - 1).filter_map(|i| Some((header[i].to_owned(), line[i].parse().ok()?)));
        rows.push(SweepRow {
            run: line[0].to_owned(),
            status: line[1].to_owned(),
            parameters: (2..end).map(|i| line[i].to_owned()).collect(),
            figures: figures.collect(),
            error: line[header.len() - 1].to_owned(),
        });
    }
    Ok(rows)
}

/// Under another name first: a reader sees the old file or the new one.
fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    replace(path, |file| file.write_all(bytes)).map_err(|error| error.source)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_comes_back_with_its_holes() {
        let folder = tempfile::tempdir().unwrap();
        let record = SweepRecord::new("waves", vec!["nu".to_owned()], Plan::default());
        prepare(folder.path(), &record, &[]).unwrap();
        let row = |run: &str, figures: &[(&str, f64)], error: &str| SweepRow {
            run: run.to_owned(),
            status: "finished".to_owned(),
            parameters: vec![run.to_owned()],
            figures: figures.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
            error: error.to_owned(),
        };
        let rows = vec![
            row("0.3", &[("time", 0.1 + 0.2)], ""),
            row("0.4", &[("time", 1.0), ("speed fringe", 2.5e3)], "a, \"b\""),
            row("0.5", &[], ""),
        ];
        let sweep = Sweep { record, rows };
        write_table(folder.path(), &sweep).unwrap();
        assert_eq!(read(folder.path()).unwrap(), sweep);
        write_row(folder.path(), &sweep.record, &sweep.rows[1]).unwrap();
        assert_eq!(read_row(folder.path(), &sweep.record, "0.4").as_ref(), Some(&sweep.rows[1]));
        assert_eq!(read_row(folder.path(), &sweep.record, "0.5"), None);
        let other = SweepRecord::new("waves", vec!["cell".to_owned()], Plan::default());
        assert_eq!(read_row(folder.path(), &other, "0.4"), None, "of another sweep");
        write_row(folder.path(), &sweep.record, &sweep.rows[0]).unwrap();
        prepare(folder.path(), &sweep.record, &["0.3"]).unwrap();
        let left = ["0.3", "0.4"].map(|run| read_row(folder.path(), &sweep.record, run).is_some());
        assert_eq!(left, [true, false], "only what is kept");
        assert!(is_sweep(folder.path()));
    }

    #[test]
    fn a_parameter_with_the_name_of_a_figure_keeps_it() {
        let folder = tempfile::tempdir().unwrap();
        let record = SweepRecord::new("waves", vec!["steps".to_owned()], Plan::default());
        let figures = vec![("steps".to_owned(), 7.0)];
        let row = SweepRow { parameters: vec!["3".to_owned()], figures, ..SweepRow::default() };
        write_table(folder.path(), &Sweep { record, rows: vec![row] }).unwrap();
        let text = fs::read_to_string(folder.path().join(TABLE)).unwrap();
        assert_eq!(text, "run,status,steps,steps_of_run,error\n,,3,7,\n");
    }

    #[test]
    fn a_folder_with_other_files_is_refused_and_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("thesis.tex"), "years of work").unwrap();
        let refused = prepare(folder.path(), &SweepRecord::new("waves", Vec::new(), Plan::default()), &[]);
        assert!(matches!(refused, Err(Failure::Input(_))));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
