//! The report on the terminal.

use super::record::{BenchRecord, Computer, Measured};
use std::fmt::{Display, Formatter, Result, Write};

impl Display for BenchRecord {
    fn fmt(&self, f: &mut Formatter) -> Result {
        writeln!(f, "{}", self.machine)?;
        if !self.results.is_empty() {
            f.write_str(&results(&self.results))?;
            f.write_str(&verbs(&self.results))?;
        }
        if let Some(share) = busiest(&self.results) {
            writeln!(
                f,
                "This machine was busy with other things: a thread had a core for {} of the time. Rates are too low.\n",
                percent(share)
            )?;
        }
        for skipped in &self.skipped {
            writeln!(f, "left out: {}: {}", skipped.case.label(), skipped.reason)?;
        }
        Ok(())
    }
}

impl Display for Computer {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let cores = if self.cores == 1 { "core" } else { "cores" };
        writeln!(f, "{}, {} {cores}, {}", self.processor, self.cores, self.instructions)?;
        let mut table =
            TextTable::new(&["<threads", "copy GB/s", "f64 G multiply-adds/s", "f32 G multiply-adds/s"]);
        for limits in &self.limits {
            let giga = |rate: f64| format!("{:.1}", rate / 1e9);
            let adds = limits.multiply_add;
            table.row([limits.threads.to_string(), giga(limits.copy), giga(adds.double), giga(adds.single)]);
        }
        write!(f, "{table}")
    }
}

fn results(results: &[Measured]) -> String {
    let mut table = TextTable::new(&[
        "<problem",
        "particles",
        "M/core s",
        "+-",
        "bytes",
        "of copy",
        "of m-adds",
        "memory B",
    ]);
    for measured in results {
        table.row([
            measured.case.label(),
            measured.particles.to_string(),
            format!("{:.2}", measured.rate / 1e6),
            percent(measured.spread),
            format!("{:.0}", measured.bytes),
            percent(measured.of_copy),
            percent(measured.of_multiply_add),
            measured.memory.map_or("-".to_owned(), |bytes| format!("{bytes:.0}")),
        ]);
    }
    format!(
        "Million particle-steps per core-second, median and half the spread; bytes that a particle and a step must move,\n\
         and the share of the copy and multiply-add limits that this is; peak memory a particle.\n{table}\n"
    )
}

/// Part of the time for which single threads had a core, where that is too little to believe the rates.
fn busiest(results: &[Measured]) -> Option<f64> {
    /// Less than this is not the clock's own unrest.
    const UNDISTURBED: f64 = 0.95;
    let alone = results.iter().filter(|measured| measured.case.threads == 1);
    alone.filter_map(|measured| measured.at_work).min_by(f64::total_cmp).filter(|share| *share < UNDISTURBED)
}

fn verbs(results: &[Measured]) -> String {
    let mut names: Vec<&str> = Vec::new();
    for verb in results.iter().flat_map(|measured| &measured.verbs) {
        if !names.contains(&verb.verb.as_str()) {
            names.push(&verb.verb);
        }
    }
    let mut head = vec!["<problem"];
    head.extend(&names);
    head.extend(["rest", "all"]);
    let mut table = TextTable::new(&head);
    for measured in results {
        let all = 1e9 / measured.rate;
        let known: f64 = measured.verbs.iter().map(|verb| verb.nanoseconds).sum();
        let cell = |name: &&str| {
            let verb = measured.verbs.iter().find(|verb| verb.verb == *name);
            verb.map_or("-".to_owned(), |verb| format!("{:.1}", verb.nanoseconds))
        };
        let mut row = vec![measured.case.label()];
        row.extend(names.iter().map(cell));
        row.extend([(all - known).max(0.0), all].map(|time| format!("{time:.1}")));
        table.row(row);
    }
    format!("Where the time goes: core-nanoseconds for a particle and a step.\n{table}\n")
}

/// A share in hundredths; nothing of what is no number.
pub fn percent(share: f64) -> String {
    if share.is_finite() { format!("{:.0} %", 100.0 * share) } else { "-".to_owned() }
}

/// Columns under a head; those whose head starts with `<` stand left, the others right.
pub struct TextTable {
    rows: Vec<Vec<String>>,
    left: Vec<bool>,
}

impl TextTable {
    /// One without rows.
    pub fn new(head: &[&str]) -> Self {
        let left = head.iter().map(|name| name.starts_with('<')).collect();
        let names = head.iter().map(|name| name.trim_start_matches('<').to_owned()).collect();
        TextTable { rows: vec![names], left }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl Into<Vec<String>>) {
        self.rows.push(cells.into());
    }
}

impl Display for TextTable {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let width =
            |column: usize| self.rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..self.left.len()).map(width).collect();
        for row in &self.rows {
            let mut line = String::new();
            for ((cell, &width), &left) in row.iter().zip(&widths).zip(&self.left) {
                if left {
                    write!(line, "{cell:<width$}  ")?;
                } else {
                    write!(line, "{cell:>width$}  ")?;
                }
            }
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_stand_under_their_heads() {
        let mut table = TextTable::new(&["<name", "rate"]);
        table.row(["a longer name".to_owned(), "1.5".to_owned()]);
        table.row(["b".to_owned(), "12.25".to_owned()]);
        assert_eq!(table.to_string(), "name            rate\na longer name    1.5\nb              12.25\n");
    }
}
