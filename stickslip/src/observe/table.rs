//! Tables in CSV: a header, then whole rows only, whatever stops the run.

use super::file::{OutputError, ReadError, ReadProblem};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs::{self, File};
use std::io::{self, Write};
use std::marker::PhantomData;
use std::path::{Path, PathBuf};

/// A growing table whose columns are the fields of `Row`.
pub(super) struct Table<Row> {
    path: PathBuf,
    file: File,
    /// Bytes of the whole rows written so far.
    length: u64,
    row: PhantomData<Row>,
}

impl<Row: Serialize + Default> Table<Row> {
    /// A table with its header and no rows yet.
    pub(super) fn create(path: PathBuf) -> Result<Self, OutputError> {
        let file = File::create(&path).map_err(OutputError::at(&path))?;
        let mut table = Table { path, file, length: 0, row: PhantomData };
        let with_header = encode([Row::default()], true);
        let header = with_header.split_inclusive(|&byte| byte == b'\n').next().unwrap_or_default();
        table.write(header)?;
        Ok(table)
    }

    /// Adds rows. They are in the file, complete, when this returns.
    ///
    /// # Errors
    /// The disk is full or refuses; then the file ends with the rows it had before.
    pub(super) fn append(&mut self, rows: impl IntoIterator<Item = Row>) -> Result<(), OutputError> {
        self.write(&encode(rows, false))
    }

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

fn encode<Row: Serialize>(rows: impl IntoIterator<Item = Row>, header: bool) -> Vec<u8> {
    let mut writer = csv::WriterBuilder::new().has_headers(header).from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).expect("rows are flat structs of numbers and names");
    }
    writer.into_inner().expect("a vector takes all bytes")
}

/// All whole rows of a table.
///
/// # Errors
/// The file is missing or is not a table of such rows. A last line that is cut short is ignored: a run may be writing it.
pub(super) fn read_rows<Row: DeserializeOwned>(path: &Path) -> Result<Vec<Row>, ReadError> {
    let rows = || -> Result<Vec<Row>, ReadProblem> {
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
    struct Row {
        time: f64,
        body: String,
    }

    fn row(time: f64, body: &str) -> Row {
        Row { time, body: body.into() }
    }

    #[test]
    fn numbers_and_names_come_back_exactly() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        let mut table = Table::create(path.clone()).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "time,body\n");
        table.append([row(0.1 + 0.2, "a"), row(-1e-300, "ball, \"left\"")]).unwrap();
        assert_eq!(read_rows::<Row>(&path).unwrap(), [row(0.1 + 0.2, "a"), row(-1e-300, "ball, \"left\"")]);
        fs::OpenOptions::new().append(true).open(&path).unwrap().write_all(b"0.5,ca").unwrap();
        assert_eq!(read_rows::<Row>(&path).unwrap().len(), 2);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_full_disk_is_an_error_that_names_the_table() {
        let error = Table::<Row>::create("/dev/full".into()).err().unwrap();
        assert!(error.to_string().contains("/dev/full"), "{error}");
        assert_eq!(error.source.kind(), io::ErrorKind::StorageFull);
    }
}
