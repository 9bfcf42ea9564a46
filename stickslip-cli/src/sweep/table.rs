//! What differs between the runs of a sweep, as text for the terminal.

use super::record::{Sweep, SweepRow};

/// A line for each run: the parameters that vary, and every figure that is not the same in all runs.
///
/// Of what only says how the work was done, the wall time is left in.
pub fn table(sweep: &Sweep) -> String {
    let mut columns: Vec<Vec<String>> = Vec::new();
    for (i, name) in sweep.record.parameters.iter().enumerate() {
        columns.push(column(name, sweep, |row| row.parameters[i].clone()));
    }
    for name in sweep.figures() {
        let figure =
            |row: &SweepRow| row.figures.iter().find(|(other, _)| other == name).map(|(_, value)| *value);
        let first = sweep.rows.first().and_then(figure);
        if sweep.rows.iter().any(|row| figure(row) != first) {
            columns.push(column(name, sweep, |row| figure(row).map_or("-".to_owned(), short)));
        }
    }
    if !sweep.unfinished().is_empty() {
        columns.push(column("status", sweep, |row| row.status.clone()));
    }
    let mut text = String::new();
    for line in 0..=sweep.rows.len() {
        let cells: Vec<String> = columns
            .iter()
            .map(|column| {
                let width = column.iter().map(|cell| cell.chars().count()).max().unwrap_or(0);
                format!("{:>width$}", column[line])
            })
            .collect();
        text += cells.join("  ").trim_end();
        text.push('\n');
    }
    text
}

fn column(name: &str, sweep: &Sweep, cell: impl Fn(&SweepRow) -> String) -> Vec<String> {
    [name.to_owned()].into_iter().chain(sweep.rows.iter().map(cell)).collect()
}

/// Four digits, with a power of ten where the number is large or small.
fn short(value: f64) -> String {
    match value.abs() {
        size if size >= 1e5 || (size > 0.0 && size < 1e-3) => format!("{value:.3e}"),
        size if size >= 1000.0 => format!("{value:.0}"),
        _ => format!("{value:.4}"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::plan::Plan;
    use super::super::record::SweepRecord;
    use super::*;

    #[test]
    fn what_is_the_same_in_all_runs_is_left_out() {
        let row = |law: &str, drift: f64, failed: bool| SweepRow {
            status: if failed { "failed" } else { "finished" }.to_owned(),
            parameters: vec![law.to_owned()],
            figures: if failed {
                Vec::new()
            } else {
                vec![("particles".to_owned(), 96.0), ("energy_drift".to_owned(), drift)]
            },
            ..SweepRow::default()
        };
        let record = SweepRecord::new("laws", vec!["law".to_owned()], Plan::default());
        let rows = vec![row("surface", -0.0312, false), row("gap", 4e-5, false)];
        let mut sweep = Sweep { record, rows };
        assert_eq!(table(&sweep), "    law  energy_drift\nsurface       -0.0312\n    gap      4.000e-5\n");
        sweep.rows.push(row("none", 0.0, true));
        assert!(table(&sweep).ends_with("   none          -             -    failed\n"), "{}", table(&sweep));
    }
}
