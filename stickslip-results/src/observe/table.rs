//! Tables in CSV: a header, then whole rows only, whatever stops the run.

use super::file::{OutputError, ReadError, ReadProblem};
use super::writer::Writer;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs::{self, File};
use std::io::{self, Write};
use std::marker::PhantomData;
use std::path::{Path, PathBuf};

/// A row of a table through time.
pub(super) trait TableRow: Serialize + Default {
    /// Simulated time [s].
    fn time(&self) -> f64;
}

/// Column of the time in the scene's own unit, after those of the row.
pub(super) const TIME_UNITS: &str = "time_units";

/// A growing table whose columns are the fields of a row and, if the scene has a unit of time, the time in it.
/// A thread of its own writes it.
pub(super) struct CsvTable<R> {
    writer: Writer<Sheet>,
    /// Length of the scene's unit of time [s].
    unit: Option<f64>,
    row: PhantomData<R>,
}

/// The file of a table.
struct Sheet {
    path: PathBuf,
    file: File,
    /// Bytes of the whole rows written so far.
    length: u64,
}

impl<R: TableRow> CsvTable<R> {
    /// A table with its header and no rows yet.
    pub(super) fn create(path: PathBuf, unit: Option<f64>) -> Result<Self, OutputError> {
        let file = File::create(&path).map_err(OutputError::at(&path))?;
        let mut sheet = Sheet { path: path.clone(), file, length: 0 };
        let with_header = encode([R::default()], true);
        let header = with_header.split(|&byte| byte == b'\n').next().unwrap_or_default();
        let more = if unit.is_some() { format!(",{TIME_UNITS}\n") } else { "\n".to_string() };
        sheet.write(&[header, more.as_bytes()].concat())?;
        Ok(CsvTable { writer: Writer::start(sheet).map_err(OutputError::at(&path))?, unit, row: PhantomData })
    }

    /// Adds rows. They are complete when they are in the file, which is soon.
    ///
    /// # Errors
    /// The disk was full or refused when rows were added before; then the file ends with those before them.
    pub(super) fn append(&mut self, rows: impl IntoIterator<Item = R>) -> Result<(), OutputError> {
        self.writer.make_room()?;
        let bytes = match self.unit {
            None => encode(rows, false),
            Some(unit) => {
                let timed = rows.into_iter().map(|row| {
                    let time = row.time() / unit;
                    (row, time)
                });
                encode(timed, false)
            }
        };
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
    fn write(&mut self, bytes: &[u8]) -> Result<(), OutputError> {
        if let Err(source) = self.file.write_all(bytes) {
            // Cutting off the half of a row that went in; the write's own error is the one to report.
            let _ = self.file.set_len(self.length);
            return Err(OutputError { path: self.path.clone(), source });
        }
        self.length += bytes.len() as u64;
        Ok(())
    }
}

fn encode<R: Serialize>(rows: impl IntoIterator<Item = R>, header: bool) -> Vec<u8> {
    let mut writer = csv::WriterBuilder::new().has_headers(header).from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).expect("rows are flat structs of numbers and names");
    }
    writer.into_inner().expect("a vector takes all bytes")
}

/// All whole rows of a table.
///
/// # Errors
/// The file is missing or is not a table of such rows. A last line that is cut short is ignored:
/// a run may be writing it.
pub(super) fn read_rows<R: DeserializeOwned>(path: &Path) -> Result<Vec<R>, ReadError> {
    let rows = || -> Result<Vec<R>, ReadProblem> {
        let bytes = fs::read(path)?;
        let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |last| last + 1);
        if whole == 0 {
            return Err(io::Error::from(io::ErrorKind::UnexpectedEof).into());
        }
        Ok(csv::Reader::from_reader(&bytes[..whole]).deserialize().collect::<Result<_, _>>()?)
    };
    rows().map_err(|problem| problem.at(path))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;

    #[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
    struct FieldPlace {
        time: f64,
        body: String,
    }

    impl TableRow for FieldPlace {
        fn time(&self) -> f64 {
            self.time
        }
    }

    fn row(time: f64, body: &str) -> FieldPlace {
        FieldPlace { time, body: body.into() }
    }

    #[test]
    fn numbers_and_names_come_back_exactly() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        let mut table = CsvTable::create(path.clone(), None).unwrap();
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
    fn a_unit_of_time_adds_a_column_that_readers_may_leave_out() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        let mut table = CsvTable::create(path.clone(), Some(0.25)).unwrap();
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
        let sheet = Sheet { path: path.clone(), file: File::create("/dev/full").unwrap(), length: 0 };
        let mut table =
            CsvTable::<FieldPlace> { writer: Writer::start(sheet).unwrap(), unit: None, row: PhantomData };
        let error = table.append([row(0.5, "a")]).and_then(|()| table.finish()).unwrap_err();
        assert_eq!((error.path, error.source.kind()), (path, io::ErrorKind::StorageFull));
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_full_disk_is_an_error_that_names_the_table() {
        let error = CsvTable::<FieldPlace>::create("/dev/full".into(), None).err().unwrap();
        assert!(error.to_string().contains("/dev/full"), "{error}");
        assert_eq!(error.source.kind(), io::ErrorKind::StorageFull);
    }
}
