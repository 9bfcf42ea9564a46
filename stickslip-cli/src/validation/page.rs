//! The results of validation as a page: law by benchmark, then each benchmark with its report.

use super::text::short;
use crate::page::{Cell, Column, Making, Page, Section, Table, Verdict, address};
use std::time::Duration;
use stickslip_validation::{
    Benchmark, Entry, Law, Measurement, Record, Report, Resolution, Run, Target, Tier, Verdict as Judgement,
};

/// The page; it took so long.
pub fn page(report: &Report, took: Duration) -> Page {
    let tier = match report.tier {
        Tier::Quick => "the quick tier: coarse resolutions and few variants",
        Tier::Full => "the full tier: every resolution and variant",
    };
    let mut page = Page::new("Contact laws against known answers", Making::now(took))
        .lead("Each contact law of the engine runs problems with known answers, all with one setting: nothing is tuned to a problem.")
        .lead(format!(
            "This is {tier}. A law is judged at the finest resolution that was run, or at the one that a target names; targets at other resolutions stay open."
        ))
        .section(overview(report))
        .section(words(&laws(report)));
    for benchmark in benchmarks(report) {
        page = page.section(section(benchmark, report));
    }
    let due = |entry: &Entry| entry.benchmark.due(report.tier).count();
    let (all, done) = report.entries.iter().fold((0, 0), |(a, d), e| (a + due(e), d + e.runs.len()));
    if done < all {
        page = page.warning(format!(
            "Only {done} of {all} runs have ended: where finer ones are still to come, the finest that have ended are judged."
        ));
    }
    page
}

fn benchmarks(report: &Report) -> Vec<&'static Benchmark> {
    let mut benchmarks: Vec<&'static Benchmark> =
        report.entries.iter().map(|entry| entry.benchmark).collect();
    benchmarks.dedup_by_key(|benchmark| benchmark.name);
    benchmarks
}

fn laws(report: &Report) -> Vec<Law> {
    let mut laws: Vec<Law> = Vec::new();
    for entry in &report.entries {
        if !laws.contains(&entry.law) {
            laws.push(entry.law);
        }
    }
    laws
}

fn entries<'a>(benchmark: &'a Benchmark, report: &'a Report) -> impl Iterator<Item = &'a Entry> {
    report.entries.iter().filter(move |entry| entry.benchmark.name == benchmark.name)
}

fn title(benchmark: &Benchmark) -> String {
    format!("{} {}", benchmark.name, benchmark.title)
}

/// A law's word, with a star where it is what scenes get that name none.
fn word(law: &Law) -> String {
    if law.default { format!("{} *", law.word) } else { law.word.to_owned() }
}

fn colour(judgement: Judgement) -> Verdict {
    match judgement {
        Judgement::Reached => Verdict::Passed,
        Judgement::Missed => Verdict::Failed,
        Judgement::Open => Verdict::Known,
    }
}

/// How many targets each law reaches in each benchmark.
fn overview(report: &Report) -> Section {
    let laws = laws(report);
    let mut columns = vec![Column::text("benchmark")];
    columns.extend(laws.iter().map(|law| Column::number(word(law))));
    let mut table =
        Table::new("Targets reached of targets judged. * what a scene gets that names no law.", columns);
    for benchmark in benchmarks(report) {
        let mut row = vec![Cell::text(title(benchmark))];
        for law in &laws {
            row.push(entries(benchmark, report).find(|entry| entry.law == *law).map_or(Cell::Empty, reached));
        }
        table = table.row(row);
    }
    Section::new("Law by benchmark").table(table).table(times(report))
}

/// How long each law took for each benchmark.
fn times(report: &Report) -> Table {
    let laws = laws(report);
    let mut columns = vec![Column::text("benchmark")];
    columns.extend(laws.iter().map(|law| Column::number(word(law))));
    let mut table = Table::new("Time taken [s], all resolutions together; one thread a run.", columns);
    for benchmark in benchmarks(report) {
        let mut row = vec![Cell::text(title(benchmark))];
        for law in &laws {
            let entry = entries(benchmark, report).find(|entry| entry.law == *law);
            let outcomes =
                entry.iter().flat_map(|entry| &entry.runs).filter_map(|run| run.result.as_ref().ok());
            let times: Vec<f64> = outcomes.map(|outcome| outcome.record.wall_time).collect();
            row.push(if times.is_empty() { Cell::Empty } else { Cell::number(times.iter().sum(), 1) });
        }
        table = table.row(row);
    }
    table
}

fn reached(entry: &Entry) -> Cell {
    let verdicts: Vec<_> = entry.benchmark.targets.iter().map(|target| entry.verdict(target)).collect();
    let count = |wanted| verdicts.iter().filter(|verdict| **verdict == wanted).count();
    let (reached, missed) = (count(Judgement::Reached), count(Judgement::Missed));
    let text =
        if reached + missed == 0 { "open".to_owned() } else { format!("{reached} of {}", reached + missed) };
    Cell::Judged(text, colour(entry.overall()), address(&title(entry.benchmark)))
}

fn words(laws: &[Law]) -> Section {
    let columns = vec![Column::text("law"), Column::text("bodies push on each other")];
    let row = |table: Table, law: &Law| table.row(vec![Cell::text(word(law)), Cell::text(law.meaning)]);
    Section::new("The laws").table(laws.iter().fold(Table::new("As scene files name them.", columns), row))
}

fn section(benchmark: &'static Benchmark, report: &Report) -> Section {
    let mut section = Section::new(title(benchmark))
        .text(format!("Source: {}.", benchmark.source.trim_end_matches('.')))
        .sketch(benchmark.picture.trim_matches('\n'))
        .text(format!("Set-up: {}", benchmark.set_up))
        .text(format!("Exact: {}", benchmark.exact));
    for entry in entries(benchmark, report) {
        for run in &entry.runs {
            if let Err(failure) = &run.result {
                let Resolution { cells, .. } = run.resolution;
                section = section
                    .warning(format!("{} at {} = {cells}: {failure}", entry.law.word, benchmark.measure));
            }
        }
    }
    section = section.table(results(benchmark, report));
    for entry in entries(benchmark, report).filter(|entry| entry.overall() == Judgement::Missed) {
        for reason in benchmark.reasons(entry.law.word) {
            section = section.text(format!("What {} misses: {reason}", entry.law.word));
        }
    }
    section.table(targets(benchmark)).table(records(benchmark, report))
}

/// What each law measured at each resolution, against the targets.
fn results(benchmark: &'static Benchmark, report: &Report) -> Table {
    let mut columns = vec![Column::text("law"), Column::text("quantity")];
    let heading = |r: &Resolution| Column::number(format!("{} = {}", benchmark.measure, r.cells));
    columns.extend(benchmark.due(report.tier).map(heading));
    columns.extend([Column::number("order"), Column::text("target"), Column::text("verdict")]);
    let caption = format!(
        "Measured by each law; the observed order of convergence is that of the two finest resolutions. {} counts cells.",
        benchmark.measure
    );
    let mut table = Table::new(caption, columns);
    for entry in entries(benchmark, report) {
        for (i, target) in benchmark.targets.iter().enumerate() {
            let law = if i == 0 { Cell::text(word(&entry.law)) } else { Cell::Empty };
            let mut row = vec![law, Cell::text(target.metric)];
            for resolution in benchmark.due(report.tier) {
                let run = entry.runs.iter().find(|run| run.resolution == *resolution);
                row.push(run.map_or(Cell::text("not run yet"), |run| value(run, target)));
            }
            row.push(entry.order(target).map_or(Cell::Empty, |order| Cell::number(order, 1)));
            row.push(Cell::text(stated(benchmark, target)));
            row.push(match entry.verdict(target) {
                Judgement::Open => Cell::text("not run at these cells"),
                verdict => Cell::Verdict(colour(verdict)),
            });
            table = table.row(row);
        }
    }
    table
}

/// The target, with the resolution that it is stated for.
fn stated(benchmark: &Benchmark, target: &Target) -> String {
    match target.at {
        Some(cells) => format!("{target} at {} = {cells}", benchmark.measure),
        None => target.to_string(),
    }
}

fn value(run: &Run, target: &Target) -> Cell {
    let Ok(outcome) = &run.result else { return Cell::text("failed") };
    let found = outcome.measurements.iter().find(|measurement| measurement.metric == target.metric);
    found.map_or(Cell::Empty, |Measurement { value, .. }| Cell::Number(short(*value)))
}

/// What is asked, and why that much.
fn targets(benchmark: &Benchmark) -> Table {
    let columns = ["quantity", "exact", "target", "why"].map(Column::text).into();
    benchmark.targets.iter().fold(
        Table::new("What is asked, and why that much.", columns),
        |table, target| {
            table.row(vec![
                Cell::text(target.metric),
                Cell::text(target.exact.to_string()),
                Cell::text(stated(benchmark, target)),
                Cell::text(target.why),
            ])
        },
    )
}

/// What every run records.
fn records(benchmark: &'static Benchmark, report: &Report) -> Table {
    let numbers = [
        benchmark.measure,
        "energy drift",
        "most energy gained",
        "momentum drift",
        "angular momentum drift",
        "deepest overlap [cells]",
        "first contact [s]",
        "particle-steps",
        "time taken [s]",
    ];
    let mut columns = vec![Column::text("law")];
    columns.extend(numbers.map(Column::number));
    let caption = "The worst of all runs at a resolution: energy over the largest that moved or was stored, momentum over the sum of the \
bodies' momenta, where nothing outside acts; the overlap of round particles of two bodies; one thread a run.";
    let mut table = Table::new(caption, columns);
    for entry in entries(benchmark, report) {
        for run in &entry.runs {
            if let Ok(outcome) = &run.result {
                let mut row =
                    vec![Cell::text(word(&entry.law)), Cell::Number(run.resolution.cells.to_string())];
                row.extend(record(&outcome.record));
                table = table.row(row);
            }
        }
    }
    table
}

fn record(record: &Record) -> [Cell; 8] {
    let optional = |drift: Option<f64>| drift.map_or(Cell::Empty, Cell::scientific);
    [
        Cell::percent(record.energy_drift, 2),
        Cell::percent(record.energy_gain, 2),
        optional(record.momentum_drift),
        optional(record.angular_drift),
        Cell::number(record.penetration, 2),
        record.first_contact.map_or(Cell::Empty, |time| Cell::Number(short(time))),
        Cell::scientific(record.particle_steps),
        Cell::number(record.wall_time, 1),
    ]
}
