//! Tables of times and values in CSV files: which columns, and in which units.

use super::Context;
use super::files::read_file;
use super::loads::per_depth;
use super::quantity::{Duration, Measure, QuantityInput};
use super::read::Read;
use super::text::Text;
use crate::scene::TimeTable;
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::error::Fault;
use crate::scene::parameters::Dependence;
use csv::StringRecord;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;

/// Bytes that a file of a table may have.
const LARGEST_TABLE: u64 = 1 << 26;

/// The columns of the time and the value, by name or by number from 1.
pub struct TableColumns([DocumentNode; 2]);

impl Read for TableColumns {
    fn wanted() -> String {
        "the columns of the time and the value, by name or by number from 1: [\"t\", \"Fx\"], [1, 3]"
            .to_string()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        let Value::List(items) = &node.value else { return Err(node.fault(Self::wanted())) };
        match &items[..] {
            [time, value] => Ok(TableColumns([time.clone(), value.clone()])),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl JsonSchema for TableColumns {
    fn schema_name() -> Cow<'static, str> {
        "TableColumns".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let column = json_schema!({ "type": ["integer", "string"] });
        json_schema!({ "type": "array", "items": column, "minItems": 2, "maxItems": 2 })
    }
}

/// A table in a file.
pub struct CsvTable<'a, 'c> {
    /// The key that names the file.
    pub file: &'a Text,
    pub columns: Option<&'a TableColumns>,
    pub context: &'a Context<'c>,
}

/// What the head of a file says: where the time and the value stand, and what a 1 is there in SI units.
struct Layout {
    places: [usize; 2],
    scales: [f64; 2],
}

impl CsvTable<'_, '_> {
    /// The table in SI units; values are of the measure `M`.
    pub fn read<M: Measure>(&self) -> Result<TimeTable, Fault> {
        let name = self.file.value(self.context)?;
        let path = self.context.folder.join(&name);
        let bytes = read_file(self.file, (&name, &path), (self.context.files, LARGEST_TABLE))?;
        // What some programs put before text.
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
        let mut format = csv::ReaderBuilder::new();
        format.has_headers(false).flexible(true).trim(csv::Trim::All);
        let mut table: Vec<[f64; 2]> = Vec::new();
        let mut layout = None;
        for (line, record) in format.from_reader(bytes).records().enumerate() {
            let wrong = |found: String, allowed: &str| self.wrong((&name, line), found, allowed);
            let record = record.map_err(|reason| wrong(reason.to_string(), "text"))?;
            let is_head = line == 0 && record.iter().all(|field| !begins_as_number(field));
            let Layout { places, scales } = match layout.take() {
                Some(layout) => layout,
                None => {
                    self.layout::<M>(&record, is_head).map_err(|(found, allowed)| wrong(found, &allowed))?
                }
            };
            layout = Some(Layout { places, scales });
            if is_head {
                continue;
            }
            self.has_two(&record).map_err(|(found, allowed)| wrong(found, &allowed))?;
            let number = |side: usize| {
                let number =
                    record.get(places[side])?.parse().ok().filter(|number: &f64| number.is_finite())?;
                Some(number * scales[side])
            };
            let (Some(time), Some(value)) = (number(0), number(1)) else {
                let allowed = "a time and a value, numbers in SI units with a comma between them, or in those that the \
                               first line has in brackets";
                return Err(wrong(format!("`{}`", listed(&record)), allowed));
            };
            if table.last().is_some_and(|[before, _]| *before >= time) {
                return Err(wrong(format!("the time {time} s"), "a time after that of the row before"));
            }
            table.push([time, value]);
        }
        TimeTable::new(table)
            .ok_or_else(|| self.file.refused(&name, "a file with at least one row of a time and a value"))
    }

    fn wrong(&self, (name, line): (&str, usize), found: String, allowed: &str) -> Fault {
        let mut fault = self.file.refused(name, allowed);
        fault.problem.found = format!("in row {} of {name}: {found}", line + 1);
        fault
    }

    /// Refuses columns of which nobody says that they are not meant.
    fn has_two(&self, record: &StringRecord) -> Result<(), (String, String)> {
        let last = (0..record.len()).rfind(|&column| !record[column].is_empty()).map_or(0, |last| last + 1);
        if last <= 2 || self.columns.is_some() {
            return Ok(());
        }
        let allowed = "two, a time and a value; of more, columns = [1, 3] beside `csv` takes the first and the third, \
                       and columns = [\"t\", \"Fx\"] those of these names";
        Err((format!("{last} columns, `{}`", listed(record)), allowed.to_string()))
    }

    /// From the first line, which names the columns or does not.
    fn layout<M: Measure>(&self, first: &StringRecord, is_head: bool) -> Result<Layout, (String, String)> {
        self.has_two(first)?;
        let heads: Vec<&str> = if is_head { first.iter().collect() } else { Vec::new() };
        let places = match self.columns {
            None => [0, 1],
            Some(TableColumns([time, value])) => [place(time, &heads)?, place(value, &heads)?],
        };
        let unit = |side: usize, read: &dyn Fn(&str) -> Option<f64>, example: String| {
            heads.get(places[side]).map_or(Ok(1.0), |head| scale(head, read, &example))
        };
        let node = |text: &str| self.file.node().with(Value::Text(text.to_string()));
        let time =
            |unit: &str| QuantityInput::<Duration>::new(&node(&format!("1 {unit}"))).value(self.context).ok();
        let value = |unit: &str| {
            let node = node(&if matches!(unit, "-" | "1") { "1".to_string() } else { format!("1 {unit}") });
            per_depth::<M>(&node, (self.context, Dependence::Constant)).ok()?.constant()
        };
        let scales = [unit(0, &time, Duration::name())?, unit(1, &value, M::name())?];
        Ok(Layout { places, scales })
    }
}

/// Where a column stands that is named or numbered.
fn place(column: &DocumentNode, heads: &[&str]) -> Result<usize, (String, String)> {
    match &column.value {
        Value::Number(number) if *number >= 1.0 && number.fract() == 0.0 && *number <= 1e6 => {
            Ok(*number as usize - 1)
        }
        Value::Text(text) => {
            let is_it = |head: &&str| {
                head.eq_ignore_ascii_case(text) || split(head).0.eq_ignore_ascii_case(text.trim())
            };
            heads.iter().position(is_it).ok_or_else(|| {
                (format!("no column `{text}`"), format!("one of those that it names: {}", heads.join(", ")))
            })
        }
        _ => Err((format!("the column {}", column.found()), TableColumns::wanted())),
    }
}

/// A name and the unit in brackets behind it: `F [kN]`, `F (kN)`.
fn split(head: &str) -> (&str, Option<&str>) {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((name, unit)) = head.strip_suffix(close).and_then(|rest| rest.rsplit_once(open)) {
            return (name.trim(), Some(unit.trim()));
        }
    }
    (head, None)
}

/// What a 1 under this head is in SI units.
fn scale(head: &str, unit: &dyn Fn(&str) -> Option<f64>, example: &str) -> Result<f64, (String, String)> {
    if let (_, Some(written)) = split(head) {
        let allowed = || format!("the unit of {example} in brackets behind the name, or none: then it is SI");
        return unit(written).ok_or_else(|| (format!("`{head}`"), allowed()));
    }
    if let Some(scale) = head.rsplit_once('/').and_then(|(_, last)| unit(last.trim())) {
        return Ok(scale);
    }
    // A name that ends in a unit is not SI by chance.
    let last = head.rsplit([' ', '_']).next().filter(|last| last.len() < head.len());
    match last.and_then(unit).filter(|&scale| scale != 1.0) {
        Some(_) => {
            let (name, last) = (head.trim_end_matches(last.unwrap_or("")), last.unwrap_or(""));
            let name = name.trim_end_matches([' ', '_']);
            Err((
                format!("`{head}`"),
                format!("units in brackets, `{name} [{last}]`, or numbers in SI units"),
            ))
        }
        None => Ok(1.0),
    }
}

fn listed(record: &StringRecord) -> String {
    record.iter().collect::<Vec<_>>().join(", ")
}

fn begins_as_number(field: &str) -> bool {
    field.starts_with(|first: char| first.is_ascii_digit() || "+-.".contains(first))
}
