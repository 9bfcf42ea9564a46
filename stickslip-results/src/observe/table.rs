//! Tables in CSV: a header, then whole rows only, whatever stops the run.

use super::file::{FileSum, OutputError, ReadError, ReadProblem, SummedFile, read_bytes};
use super::folder::OutputFolder;
use super::memory::Memory;
use super::waiting::Waiting;
use super::writer::Writer;
use crate::scene::steers_terminal;
use serde::Serialize;
use std::fs::{self, File};
use std::io::{self, Read, Seek, Write};
use std::marker::PhantomData;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A row of a table through time. The list of its columns serves writing, reading and looking up.
pub trait TableRow: Clone + Default {
    /// Its columns in the order of the file, the time among them: name, and where the row keeps the entry.
    fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)>;

    /// The number in a column by the column's name; `None` for a name that is no column of numbers.
    fn number(&self, column: &str) -> Option<f64> {
        match self.clone().columns().into_iter().find(|(name, _)| *name == column)?.1 {
            CellValue::Number(number) => Some(*number),
            CellValue::Count(count) => Some(*count as f64),
            CellValue::Name(_) => None,
        }
    }
}

/// What a row has in a column.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub enum CellValue<'a> {
    /// A number.
    Number(&'a mut f64),
    /// How many.
    Count(&'a mut usize),
    /// A name.
    Name(&'a mut String),
}

/// Columns that are called as the variables that borrow their entries.
macro_rules! columns {
    ($($name:ident),*) => {
        vec![$((stringify!($name), $crate::observe::table::CellValue::from($name))),*]
    };
}
pub(super) use columns;

impl<'a> From<&'a mut f64> for CellValue<'a> {
    fn from(number: &'a mut f64) -> Self {
        CellValue::Number(number)
    }
}

impl<'a> From<&'a mut usize> for CellValue<'a> {
    fn from(count: &'a mut usize) -> Self {
        CellValue::Count(count)
    }
}

impl<'a> From<&'a mut String> for CellValue<'a> {
    fn from(name: &'a mut String) -> Self {
        CellValue::Name(name)
    }
}

impl CellValue<'_> {
    /// Takes what a file has; the error says what is allowed there.
    fn take(self, text: &str) -> Result<(), &'static str> {
        match self {
            CellValue::Number(number) => *number = text.parse().map_err(|_| "a number")?,
            CellValue::Count(count) => *count = text.parse().map_err(|_| "a whole number from 0")?,
            CellValue::Name(_) if text.contains(steers_terminal) => {
                return Err("a name without control characters");
            }
            CellValue::Name(name) => text.clone_into(name),
        }
        Ok(())
    }
}

/// Column of the time in the scene's own unit, after those of the row.
pub(super) const TIME_UNITS: &str = "time_units";

/// A growing table whose columns are those of a row and, if the scene has a unit of time, the time in it.
/// A thread of its own writes it.
pub(super) struct CsvTable<R> {
    writer: Writer<Sheet>,
    /// What it holds without rows: its header.
    header: FileSum,
    /// Length of the scene's unit of time [s].
    unit: Option<f64>,
    row: PhantomData<R>,
}

/// The file of a table.
struct Sheet {
    path: PathBuf,
    /// It holds whole rows only.
    file: SummedFile<File>,
}

impl<R: TableRow> CsvTable<R> {
    /// A table with its header; one that is there already, of a run that goes on, keeps its rows.
    pub(super) fn create(folder: &OutputFolder, name: &str, unit: Option<f64>) -> Result<Self, OutputError> {
        Self::open(&folder.join(name), unit, folder.waiting())
    }

    fn open(path: &Path, unit: Option<f64>, waiting: &Arc<Waiting>) -> Result<Self, OutputError> {
        let mut row = R::default();
        let names = row.columns().into_iter().map(|(name, _)| name).chain(unit.map(|_| TIME_UNITS));
        let header = names.collect::<Vec<_>>().join(",") + "\n";
        let sheet = Sheet::open(path, &header)?;
        let header = FileSum { bytes: header.len() as u64, crc: crc32fast::hash(header.as_bytes()) };
        Ok(CsvTable { writer: Writer::start(sheet, path, waiting)?, header, unit, row: PhantomData })
    }

    /// Keeps how long it is and what is in it, or cuts off what was written later.
    ///
    /// # Errors
    /// The disk is full or refuses; the table is shorter than it was, or something else is in it.
    pub(super) fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        // What the checkpoint does not know was not there.
        let mut sum = match memory.is_taking_up() {
            true => self.header,
            false => self.secured()?,
        };
        memory.keep("length", &mut sum.bytes)?;
        memory.keep("sum", &mut sum.crc)?;
        if memory.is_taking_up() { self.cut(sum, memory.is_in_earnest()) } else { Ok(()) }
    }

    /// What it holds without rows.
    pub(super) fn header(&self) -> FileSum {
        self.header
    }

    /// What is in it with all that was appended, once that is on the disk.
    ///
    /// # Errors
    /// The disk is full or refuses.
    pub(super) fn secured(&mut self) -> Result<FileSum, OutputError> {
        self.writer.ask(Sheet::secured)
    }

    /// Cuts off all but what it held once, or only looks whether it could, if not in earnest.
    ///
    /// # Errors
    /// The disk refuses; the table is shorter, or something else is in it.
    pub(super) fn cut(&mut self, then: FileSum, in_earnest: bool) -> Result<(), OutputError> {
        self.writer.ask(move |sheet| sheet.cut(then, in_earnest))
    }

    /// Adds rows. They are complete when they are in the file, which is soon.
    ///
    /// # Errors
    /// The disk was full or refused when rows were added before; then the file ends with those before them. A number is
    /// not finite; then none of these rows is added.
    pub(super) fn append(&mut self, rows: impl IntoIterator<Item = R>) -> Result<(), OutputError> {
        self.writer.make_room()?;
        let bytes = encode(rows, self.unit);
        let bytes = bytes.map_err(|what| OutputError::no_number(self.writer.about(), what))?;
        self.writer.hand_over(bytes.len(), move |sheet| sheet.write(&bytes));
        Ok(())
    }

    /// Waits until all rows are in the file.
    ///
    /// # Errors
    /// As [`CsvTable::append`].
    pub(super) fn finish(&mut self) -> Result<(), OutputError> {
        self.writer.finish()
    }
}

impl Sheet {
    /// The file of a table, with its header if it is new.
    fn open(path: &Path, header: &str) -> Result<Self, OutputError> {
        let at = OutputError::at;
        // One that is new is nobody's; one that is there is no link, as the folder was searched for these.
        let mut options = File::options();
        let file =
            options.read(true).write(true).create_new(true).open(path).or_else(|error| match error.kind() {
                io::ErrorKind::AlreadyExists => File::options().read(true).write(true).open(path),
                _ => Err(error),
            });
        let file = file.map_err(at(path))?;
        let about = file.metadata().map_err(at(path))?;
        let there = about.len();
        let mut sheet = Sheet { path: path.to_path_buf(), file: SummedFile::new(file) };
        if there == 0 {
            return match sheet.write(header.as_bytes()) {
                Ok(()) => Ok(sheet),
                Err(error) => {
                    // A table without its header is better not there; what is no file stays, such as a device.
                    if about.is_file() {
                        let _ = fs::remove_file(path);
                    }
                    Err(error)
                }
            };
        }
        let mut found = vec![0; header.len()];
        let same = sheet.file.inner.read_exact(&mut found).is_ok() && found == header.as_bytes();
        if !same {
            let other = io::Error::new(io::ErrorKind::InvalidData, "it is a table with other columns");
            return Err(OutputError { path: path.to_path_buf(), source: other });
        }
        sheet.take_in(there)?;
        Ok(sheet)
    }

    /// Sums its first bytes, and goes to their end.
    fn take_in(&mut self, bytes: u64) -> Result<FileSum, OutputError> {
        let file = &mut self.file.inner;
        let sum =
            file.rewind().and_then(|()| FileSum::of(file, bytes)).map_err(OutputError::at(&self.path))?;
        self.file.go_on_from(sum);
        Ok(sum)
    }

    /// What is in it, once that is on the disk.
    fn secured(&mut self) -> Result<FileSum, OutputError> {
        self.file.inner.sync_data().map_err(OutputError::at(&self.path))?;
        Ok(self.file.sum())
    }

    fn cut(&mut self, then: FileSum, in_earnest: bool) -> Result<(), OutputError> {
        let all = self.file.sum();
        let found = self.take_in(then.bytes)?;
        if found != then {
            let differs = io::Error::new(io::ErrorKind::InvalidData, then.differs(found).to_string());
            return Err(OutputError { path: self.path.clone(), source: differs });
        }
        if in_earnest {
            return self.file.inner.set_len(then.bytes).map_err(OutputError::at(&self.path));
        }
        self.take_in(all.bytes).map(drop)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), OutputError> {
        let before = self.file.sum();
        if let Err(source) = self.file.write_all(bytes) {
            // Cutting off the half of a row that went in; the write's own error is the one to report.
            let _ = self.file.inner.set_len(before.bytes);
            self.file.go_on_from(before);
            return Err(OutputError { path: self.path.clone(), source });
        }
        Ok(())
    }
}

/// The lines of rows, each with its time in the scene's own unit [s] if there is one; or which number is not finite.
fn encode<R: TableRow>(rows: impl IntoIterator<Item = R>, unit: Option<f64>) -> Result<Vec<u8>, String> {
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    for mut row in rows {
        let mut in_units = unit.map(|unit| row.number("time").expect("every row has its time") / unit);
        if let Some(what) = no_number(&row) {
            return Err(what);
        }
        let columns = row.columns().into_iter().map(|(_, entry)| entry);
        let entries: Vec<CellValue> = columns.chain(in_units.as_mut().map(CellValue::Number)).collect();
        writer.serialize(entries).expect("entries are numbers and names");
    }
    Ok(writer.into_inner().expect("a vector takes all bytes"))
}

/// What of a row is not a finite number: its column, its names and its time.
fn no_number<R: TableRow>(row: &R) -> Option<String> {
    let mut row = row.clone();
    let columns = row.columns();
    let is_bad = |value: &CellValue| matches!(value, CellValue::Number(number) if !number.is_finite());
    let (column, _) = columns.iter().find(|(_, value)| is_bad(value))?;
    let told = |(name, value): &(&str, CellValue)| match value {
        CellValue::Name(of) => Some(format!("{name} `{of}`")),
        CellValue::Number(time) if *name == "time" => Some(format!("t = {time:.6e} s")),
        _ => None,
    };
    let told: Vec<String> = columns.iter().filter_map(told).collect();
    Some(format!("`{column}` ({})", told.join(", ")))
}

/// All whole rows of a table. Columns are found by their names, and others passed over.
///
/// # Errors
/// The file is missing or is not a table of such rows. A last line that is cut short is ignored:
/// a run may be writing it.
pub(super) fn read_rows<R: TableRow>(path: &Path) -> Result<Vec<R>, ReadError> {
    let rows = || -> Result<Vec<R>, ReadProblem> {
        let bytes = read_bytes(path)?;
        let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |last| last + 1);
        if whole == 0 {
            return Err(io::Error::from(io::ErrorKind::UnexpectedEof).into());
        }
        let mut reader = csv::Reader::from_reader(&bytes[..whole]);
        let header = reader.headers()?.clone();
        let mut row = R::default();
        let place = |(name, _): (&str, CellValue)| {
            let found = header.iter().position(|found| found == name);
            found.ok_or_else(|| ReadProblem::Layout(format!("it has no column `{name}`")))
        };
        let places: Vec<usize> = row.columns().into_iter().map(place).collect::<Result<_, _>>()?;
        let read = |record: csv::Result<csv::StringRecord>| {
            let record = record?;
            for ((name, entry), &place) in row.columns().into_iter().zip(&places) {
                let (line, text) = (record.position().map_or(0, csv::Position::line), &record[place]);
                entry.take(text).map_err(|allowed| {
                    ReadProblem::Layout(format!("line {line}: found `{text}` as {name}; allowed: {allowed}"))
                })?;
            }
            Ok(row.clone())
        };
        reader.records().map(read).collect()
    };
    rows().map_err(|problem| problem.at(path))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[derive(Clone, Debug, Default, PartialEq)]
    struct FieldPlace {
        time: f64,
        body: String,
    }

    impl TableRow for FieldPlace {
        fn columns(&mut self) -> Vec<(&'static str, CellValue<'_>)> {
            let Self { time, body } = self;
            columns![time, body]
        }
    }

    fn row(time: f64, body: &str) -> FieldPlace {
        FieldPlace { time, body: body.into() }
    }

    #[test]
    fn numbers_and_names_come_back_exactly() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        let mut table = CsvTable::open(&path, None, &Arc::default()).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "time,body\n");
        table.append([row(0.1 + 0.2, "a"), row(-1e-300, "ball, \"left\"")]).unwrap();
        table.finish().unwrap();
        assert_eq!(
            read_rows::<FieldPlace>(&path).unwrap(),
            [row(0.1 + 0.2, "a"), row(-1e-300, "ball, \"left\"")]
        );
        fs::OpenOptions::new().append(true).open(&path).unwrap().write_all(b"0.5,ca").unwrap();
        assert_eq!(read_rows::<FieldPlace>(&path).unwrap().len(), 2);
    }

    #[test]
    fn numbers_are_known_by_the_names_of_their_columns() {
        let row = row(0.5, "a");
        assert_eq!(["time", "body", "mass"].map(|column| row.number(column)), [Some(0.5), None, None]);
    }

    #[test]
    fn a_number_that_is_not_finite_ends_the_table_before_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        let mut table = CsvTable::open(&path, None, &Arc::default()).unwrap();
        table.append([row(0.5, "a")]).unwrap();
        for number in [f64::NAN, f64::INFINITY] {
            let error = table.append([row(1.0, "a"), row(number, "b")]).unwrap_err();
            assert!(error.is_no_number());
            assert!(error.to_string().contains("`time` (t = "), "{error}");
            assert!(error.to_string().contains("body `b`) is not a finite number"), "{error}");
        }
        table.finish().unwrap();
        assert_eq!(read_rows::<FieldPlace>(&path).unwrap(), [row(0.5, "a")]);
    }

    #[test]
    fn what_is_no_table_of_such_rows_says_why() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        for (text, expected) in [
            ("time,name\n", "no column `body`"),
            ("body,time\na,1\nb,x\n", "line 3: found `x` as time; allowed: a number"),
            ("body,time\nb\u{1b}[31m,0\n", "found `b\\u{1b}[31m` as body; allowed: a name without control"),
        ] {
            fs::write(&path, text).unwrap();
            let error = read_rows::<FieldPlace>(&path).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }

    #[test]
    fn a_unit_of_time_adds_a_column_that_readers_may_leave_out() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        let mut table = CsvTable::open(&path, Some(0.25), &Arc::default()).unwrap();
        table.append([row(0.5, "a"), row(1.0, "b, c")]).unwrap();
        table.finish().unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "time,body,time_units\n0.5,a,2.0\n1.0,\"b, c\",4.0\n");
        assert_eq!(read_rows::<FieldPlace>(&path).unwrap(), [row(0.5, "a"), row(1.0, "b, c")]);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_disk_that_gets_full_is_an_error_at_the_end_at_the_latest() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        let full = SummedFile::new(File::create("/dev/full").unwrap());
        let sheet = Sheet { path: path.clone(), file: full };
        let mut table = CsvTable::<FieldPlace> {
            writer: Writer::start(sheet, &path, &Arc::default()).unwrap(),
            header: FileSum::default(),
            unit: None,
            row: PhantomData,
        };
        let error = table.append([row(0.5, "a")]).and_then(|()| table.finish()).unwrap_err();
        assert_eq!((error.path, error.source.kind()), (path, io::ErrorKind::StorageFull));
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_full_disk_is_an_error_that_names_the_table() {
        let error =
            CsvTable::<FieldPlace>::open(Path::new("/dev/full"), None, &Arc::default()).err().unwrap();
        assert!(error.to_string().contains("/dev/full"), "{error}");
        assert_eq!(error.source.kind(), io::ErrorKind::StorageFull);
    }
}
