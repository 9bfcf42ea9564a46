//! Columns of `sweep.csv` that the user asks for: of any table of a run, one number.

use crate::chart::{ChartTable, rows_of_any};
use clap::ValueEnum;
use serde::{Deserialize, Serialize};
use stickslip::observe::Results;
use stickslip::scene::NamePattern;

/// A number that is taken of each run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OwnColumn {
    /// Name of the column.
    pub name: String,
    /// Which of the numbers over time.
    which: Which,
    /// The table, as `stickslip plot --table` names it.
    table: String,
    /// Its column.
    column: String,
    /// Only of rows of this name, or whose names this pattern matches.
    of: Option<String>,
}

/// Which number stands for those of all times.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
enum Which {
    Largest,
    Smallest,
    Last,
    Mean,
}

impl OwnColumn {
    /// From its name and `largest contacts.normal of disk`.
    ///
    /// # Errors
    /// No such word, table or column, in words.
    pub fn new(name: &str, what: &str) -> Result<Self, String> {
        let form = "allowed: NAME=WHICH TABLE.COLUMN [of ROW], such as peak=largest contacts.normal";
        let (which, rest) = what.trim().split_once(' ').ok_or_else(|| format!("found `{what}`; {form}"))?;
        let which = Which::from_str(which, false).map_err(|_| {
            format!("found `{which}`; allowed: largest, smallest, last or mean, such as peak=largest contacts.normal")
        })?;
        let (place, of) = match rest.split_once(" of ") {
            Some((place, of)) => (place.trim(), Some(of.trim().to_owned())),
            None => (rest.trim(), None),
        };
        let (table, column) = place.split_once('.').ok_or_else(|| format!("found `{place}`; {form}"))?;
        let known = table_of(table).ok_or_else(|| {
            let tables: Vec<String> = ChartTable::value_variants().iter().filter_map(word).collect();
            format!("found the table `{table}`; allowed: {}", tables.join(", "))
        })?;
        if !known.columns().contains(&column) {
            return Err(format!(
                "found the column `{column}` of {table}; allowed: {}",
                known.columns().join(", ")
            ));
        }
        let (name, table, column) = (name.to_owned(), table.to_owned(), column.to_owned());
        Ok(OwnColumn { name, which, table, column, of })
    }

    /// Its number in the results of a run.
    ///
    /// # Errors
    /// The table cannot be read, has no row of that name, or several at its last time, in words.
    pub fn of(&self, results: &Results) -> Result<f64, String> {
        let file = format!("{}.csv", self.table.replace('-', "_"));
        let table = table_of(&self.table).ok_or_else(|| format!("there is no table {}", self.table))?;
        let rows = rows_of_any(results, table).map_err(|error| error.to_string())?;
        let pattern = self.of.as_deref().map(NamePattern::new);
        let wanted = |name: &str| {
            let matches =
                |pattern: &NamePattern| name.split(", ").chain([name]).any(|part| pattern.matches(part));
            pattern.as_ref().is_none_or(matches)
        };
        let rows: Vec<_> = rows.into_iter().filter(|row| wanted(&row.name)).collect();
        let number = |(name, value): &(&'static str, f64)| (*name == self.column).then_some(*value);
        let values: Vec<f64> = rows
            .iter()
            .filter_map(|row| row.numbers.iter().find_map(number))
            .filter(|x| !x.is_nan())
            .collect();
        if values.is_empty() {
            let of = self.of.as_ref().map_or(String::new(), |of| format!(" of `{of}`"));
            return Err(format!("{file} has no number{of} in {}", self.column));
        }
        Ok(match self.which {
            Which::Largest => values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            Which::Smallest => values.iter().copied().fold(f64::INFINITY, f64::min),
            Which::Mean => values.iter().sum::<f64>() / values.len() as f64,
            Which::Last => {
                let last = rows.iter().map(|row| row.time).fold(f64::NEG_INFINITY, f64::max);
                let names: Vec<&str> =
                    rows.iter().filter(|row| row.time == last).map(|row| row.name.as_str()).collect();
                if names.len() > 1 {
                    let first = names[..2].join("` and `");
                    return Err(format!(
                        "{file} has {} rows at its last time, of `{first}` ...; name one: of ROW",
                        names.len()
                    ));
                }
                values[values.len() - 1]
            }
        })
    }
}

fn word(table: &ChartTable) -> Option<String> {
    table.to_possible_value().map(|value| value.get_name().to_owned())
}

fn table_of(name: &str) -> Option<ChartTable> {
    ChartTable::from_str(name, false).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_says_which_number_of_which_table() {
        let column = OwnColumn::new("peak", "largest contacts.normal of disk").unwrap();
        assert_eq!(column.of.as_deref(), Some("disk"));
        assert_eq!((column.which, &*column.table, &*column.column), (Which::Largest, "contacts", "normal"));
        for (wrong, told) in [
            ("contacts.normal", "found `contacts.normal`; allowed: NAME=WHICH"),
            ("most contacts.normal", "found `most`; allowed: largest, smallest, last or mean"),
            ("last contact.normal", "found the table `contact`; allowed: bodies, energy, contacts"),
            ("last energy.heat", "found the column `heat` of energy; allowed: total"),
        ] {
            let error = OwnColumn::new("peak", wrong).unwrap_err();
            assert!(error.starts_with(told), "{error}");
        }
    }
}
