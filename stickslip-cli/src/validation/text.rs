//! The results of validation as text.

use std::fmt::Write;
use stickslip_validation::{Candidate, Finished, SuiteEntry, SuiteReport, Target, Verdict, schemes};

/// One case that ended, on one line.
pub fn line(finished: &Finished) -> String {
    let Finished { entry, run, done, all } = finished;
    let outcome = match &run.result {
        Ok(outcome) => format!("{:.1} s", outcome.record.wall_time),
        Err(failure) => failure.to_string(),
    };
    let (benchmark, cells) = (entry.benchmark, run.resolution.cells);
    format!(
        "[{done}/{all}] {} {}, {} = {cells}: {outcome}",
        benchmark.name,
        entry.way.word(),
        benchmark.measure
    )
}

/// What the default law, the default scheme and glue miss and are not known to miss; `None` if there is nothing.
pub fn broken(report: &SuiteReport) -> Option<String> {
    let lines: Vec<String> = (report.entries.iter())
        .flat_map(|entry| entry.broken().map(move |target| (entry, target)))
        .map(|(entry, target)| {
            let (name, law, cells) = (
                entry.benchmark.name,
                entry.way.word(),
                entry.judged(target).map(|run| run.resolution.cells),
            );
            let cells =
                cells.map_or(String::new(), |cells| format!(", {} = {cells}", entry.benchmark.measure));
            format!("{name} by {law}{cells}: {}, asked {target}", target.metric)
        })
        .collect();
    (!lines.is_empty()).then(|| format!("missed, and not known to be missed:\n{}", lines.join("\n")))
}

/// A number in few characters.
pub fn short(value: f64) -> String {
    match value.abs() {
        size if size == 0.0 || (0.01..1000.0).contains(&size) => format!("{value:.4}"),
        _ => format!("{value:.1e}"),
    }
}

/// A table for each benchmark: a line for each law or scheme and quantity.
pub fn table(report: &SuiteReport) -> String {
    let mut text = String::new();
    let mut heading = "";
    for entry in &report.entries {
        if heading != entry.benchmark.name {
            heading = entry.benchmark.name;
            write_heading(entry, &mut text);
        }
        write_entry(entry, &mut text);
    }
    text
}

fn write_heading(entry: &SuiteEntry, text: &mut String) {
    let benchmark = entry.benchmark;
    let cells: String = entry.runs.iter().map(|run| format!("{:>11}", run.resolution.cells)).collect();
    let title = format!("{} {} ({})", benchmark.name, benchmark.title, benchmark.measure);
    let width = 42 + column(entry);
    let _ = writeln!(text, "\n{title:<width$}{cells}  {:>5}  target", "order");
}

/// Width of the column of laws or schemes.
fn column(entry: &SuiteEntry) -> usize {
    match entry.way {
        Candidate::Law(_) | Candidate::Own => 10,
        Candidate::Scheme(_) => schemes().iter().map(|scheme| scheme.word.len()).fold(10, usize::max),
    }
}

fn write_entry(entry: &SuiteEntry, text: &mut String) {
    let width = column(entry);
    let targets = entry.benchmark.targets.iter().filter(|target| !repeated(entry, target));
    for (i, target) in targets.enumerate() {
        let law = if i == 0 { entry.way.word() } else { "" };
        let order = entry.order(target).map_or(String::new(), |order| format!("{order:.1}"));
        let values: String = values(entry, target).map(|value| format!("{value:>11}")).collect();
        let verdict = match entry.verdict(target) {
            Verdict::Reached => "reached",
            Verdict::Missed if entry.way.is_default() && entry.broken().all(|broken| broken != target) => {
                "missed, as known"
            }
            Verdict::Missed => "missed",
            Verdict::Open => "not judged at these cells",
        };
        let _ = writeln!(
            text,
            "  {law:<width$} {:<39}{values}  {order:>5}  {:<18} {verdict}",
            target.metric,
            target.at.map_or(target.to_string(), |cells| format!("{target} at {cells}"))
        );
    }
    for run in &entry.runs {
        match &run.result {
            Ok(outcome) => {
                let record = &outcome.record;
                let drift = |drift: Option<f64>| drift.map_or("-".to_owned(), |drift| format!("{drift:.0e}"));
                let _ = writeln!(
                    text,
                    "  {:<width$} at {}: energy {:+.1e}, most gained {:.0e}; momentum {}, angular {}; deepest {:.2} h; {:.1} s",
                    "",
                    run.resolution.cells,
                    record.energy_drift,
                    record.energy_gain,
                    drift(record.momentum_drift),
                    drift(record.angular_drift),
                    record.penetration,
                    record.wall_time
                );
            }
            Err(failure) => {
                let _ = writeln!(text, "  {:<width$} at {}: {failure}", "", run.resolution.cells);
            }
        }
    }
}

/// Whether a target that is not judged asks something of a quantity that another target judges.
fn repeated(entry: &SuiteEntry, target: &Target) -> bool {
    let judges = |other: &Target| other.metric == target.metric && entry.verdict(other) != Verdict::Open;
    entry.verdict(target) == Verdict::Open && entry.benchmark.targets.iter().any(judges)
}

/// What was measured at each resolution.
fn values<'a>(entry: &'a SuiteEntry, target: &'a Target) -> impl Iterator<Item = String> + 'a {
    entry.runs.iter().map(|run| {
        let value = run.result.as_ref().ok().and_then(|outcome| outcome.value(target.metric));
        value.map_or("-".to_owned(), short)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use stickslip_validation::{BENCHMARKS, Outcome, Run, Tier, laws};

    /// First contact as if measured a cell too early by every law.
    #[test]
    fn a_miss_of_the_default_law_that_is_not_known_is_named_and_those_of_others_are_not() {
        let benchmark = BENCHMARKS.iter().find(|benchmark| benchmark.name == "M4").unwrap();
        let resolution = *benchmark.due(Tier::Quick).last().unwrap();
        for law in laws() {
            let mut outcome = Outcome::default();
            benchmark.targets.iter().for_each(|target| outcome.measure(target.metric, 1.0));
            let entry = SuiteEntry {
                benchmark,
                way: Candidate::Law(law),
                runs: vec![Run { resolution, result: Ok(outcome) }],
            };
            let said = broken(&SuiteReport { tier: Tier::Quick, entries: vec![entry] });
            let expected = format!("M4 by {}, {} = {}: ", law.word, benchmark.measure, resolution.cells);
            let held = law.default || law.word == "glued";
            assert_eq!(said.is_some(), held, "{}: {said:?}", law.word);
            assert!(!held || said.unwrap().contains(&expected), "{expected}");
        }
    }
}
