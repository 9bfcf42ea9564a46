//! Tables of a run as the page reads them, kept until their files change.

use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::SystemTime;
use stickslip::observe::{BodyRow, CellValue, ContactRow, EnergyRow, ReadError, Results, TableRow};

/// Rows of a chart; a longer table is thinned.
const MOST_ROWS: usize = 2000;

/// The tables of a folder of results.
pub struct Tables {
    folder: PathBuf,
    energy: Kept<Vec<EnergyRow>>,
    bodies: Kept<Vec<BodyRow>>,
    contacts: Kept<Vec<ContactRow>>,
}

/// What was read from a file, with the length and the age that it had.
type Kept<T> = Mutex<Option<(Stamp, Arc<T>)>>;

/// Length and last change of a file: if both are as they were, so is the file.
pub type Stamp = (u64, Option<SystemTime>);

/// The stamp of a file; that of an empty one if there is none.
pub fn stamp(path: &Path) -> Stamp {
    std::fs::metadata(path).map_or((0, None), |about| (about.len(), about.modified().ok()))
}

impl Tables {
    /// Those of a folder; nothing is read yet.
    pub fn of(folder: &Path) -> Self {
        Tables {
            folder: folder.to_path_buf(),
            energy: Mutex::default(),
            bodies: Mutex::default(),
            contacts: Mutex::default(),
        }
    }

    fn kept<T>(
        &self,
        name: &str,
        kept: &Kept<T>,
        read: impl FnOnce() -> Result<T, ReadError>,
    ) -> Result<Arc<T>, ReadError> {
        let stamp = stamp(&self.folder.join(name));
        let mut kept = kept.lock().expect("no thread panics while it reads a table");
        match &*kept {
            Some((known, table)) if *known == stamp => Ok(table.clone()),
            _ => {
                let table = Arc::new(read()?);
                *kept = Some((stamp, table.clone()));
                Ok(table)
            }
        }
    }

    /// `energy.csv`: each column by its name.
    ///
    /// # Errors
    /// The table is missing or damaged; so for the others.
    pub fn energy(&self, results: &Results) -> Result<Value, ReadError> {
        let table = self.kept("energy.csv", &self.energy, || results.energy_table())?;
        Ok(columns(&table))
    }

    /// The rows of a body in `bodies.csv`, each column by its name.
    ///
    /// # Errors
    /// The table is missing or damaged.
    pub fn body(&self, results: &Results, name: &str) -> Result<Value, ReadError> {
        let table = self.kept("bodies.csv", &self.bodies, || results.bodies_table())?;
        let rows: Vec<BodyRow> = table.iter().filter(|row| row.body == name).cloned().collect();
        Ok(columns(&rows))
    }

    /// Forces between bodies in the row of `contacts.csv` whose mean holds a time [s], and the largest of all times
    /// [N].
    ///
    /// # Errors
    /// The table is missing or damaged.
    pub fn contacts(&self, results: &Results, time: f64) -> Result<Value, ReadError> {
        let table = self.kept("contacts.csv", &self.contacts, || results.contacts_table())?;
        // Pairs without a force have no row, so the times of rows are not all that there are.
        let times = self.kept("energy.csv", &self.energy, || results.energy_table())?;
        let later = times.iter().map(|row| row.time).find(|row| *row >= time);
        let places: std::collections::HashMap<&str, usize> =
            results.body_names().iter().enumerate().map(|(i, name)| (name.as_str(), i)).collect();
        let rows = table.iter().filter(|row| Some(row.time) == later);
        let rows = rows.filter_map(|row| {
            let mean = &row.mean;
            Some(json!({
                "a": places.get(row.body_a.as_str())?,
                "b": places.get(row.body_b.as_str())?,
                "force": mean.force,
                "normal": mean.normal,
                "tangential": mean.tangential,
                "at": mean.position,
            }))
        });
        let rows: Vec<Value> = rows.collect();
        let largest = table.iter().fold(0.0, |largest: f64, row| largest.max(row.mean.normal));
        Ok(json!({ "contacts": rows, "largest": largest }))
    }
}

/// The columns of numbers of a table by their names, thinned to what a chart can show; the last row stays.
fn columns<R: TableRow>(rows: &[R]) -> Value {
    let step = rows.len().div_ceil(MOST_ROWS).max(1);
    let shown = rows.iter().enumerate().filter(|(i, _)| i % step == 0 || i + 1 == rows.len());
    let mut columns = Map::new();
    for (_, row) in shown {
        for (name, cell) in row.clone().columns() {
            if let CellValue::Number(number) = cell {
                let column = columns.entry(name).or_insert_with(|| Value::Array(Vec::new()));
                column.as_array_mut().expect("made as one").push(json!(*number));
            }
        }
    }
    Value::Object(columns)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_table_is_thinned_and_keeps_its_end() {
        let row = |i: usize| EnergyRow { time: i as f64, ..EnergyRow::default() };
        let rows: Vec<EnergyRow> = (0..5001).map(row).collect();
        let table = columns(&rows);
        let times = table["time"].as_array().unwrap();
        assert_eq!(
            (times.len(), times[1].as_f64(), times.last().unwrap().as_f64()),
            (1668, Some(3.0), Some(5000.0))
        );
        assert_eq!(table["kinetic"].as_array().unwrap().len(), 1668);
    }
}
