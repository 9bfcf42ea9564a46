//! The results of validation as a page: law or scheme by benchmark, then each benchmark with its report.

use super::text::short;
use crate::page::{Cell, Column, Making, Mark, Page, Section, Table, address};
use std::time::Duration;
use stickslip_validation::{
    Benchmark, Candidate, Laws, Measurement, Miss, Resolution, Run, RunRecord, SuiteEntry, SuiteReport,
    Target, Tier, Verdict, own_misses,
};

/// The page; it took so long.
pub fn page(report: &SuiteReport, took: Duration) -> Page {
    let tier = match report.tier {
        Tier::Quick => "the quick tier: coarse resolutions and few variants",
        Tier::Full => "the full tier: every resolution and variant",
    };
    let mut page = Page::new("Contact laws and schemes against known answers", Making::now(took))
        .lead("Each contact law and each scheme of the step runs problems with known answers, all with one setting: nothing is tuned to a problem.")
        .lead(format!(
            "This is {tier}. A law or scheme is judged at the finest resolution that was run, or at the one that a target names; targets at other resolutions stay open."
        ));
    for chapter in Chapter::all(report) {
        page = page.section(chapter.overview(report)).section(chapter.words());
    }
    for benchmark in benchmarks(report) {
        page = page.section(section(benchmark, report));
    }
    let due = |entry: &SuiteEntry| entry.benchmark.due(report.tier).count();
    let (all, done) = report.entries.iter().fold((0, 0), |(a, d), e| (a + due(e), d + e.runs.len()));
    if done < all {
        page = page.warning(format!(
            "Only {done} of {all} runs have ended: where finer ones are still to come, the finest that have ended are judged."
        ));
    }
    page
}

fn benchmarks(report: &SuiteReport) -> Vec<&'static Benchmark> {
    let mut benchmarks: Vec<&'static Benchmark> =
        report.entries.iter().map(|entry| entry.benchmark).collect();
    benchmarks.dedup_by_key(|benchmark| benchmark.name);
    benchmarks
}

/// Ways to run benchmarks that stand side by side.
struct Chapter {
    /// What one of them is.
    kind: &'static str,
    ways: Vec<Candidate>,
}

impl Chapter {
    /// The laws and the schemes that were chosen, as far as there are any.
    fn all(report: &SuiteReport) -> Vec<Chapter> {
        let mut laws = Chapter { kind: "law", ways: Vec::new() };
        let mut schemes = Chapter { kind: "scheme", ways: Vec::new() };
        for entry in &report.entries {
            let chapter = if entry.benchmark.laws == Laws::Bulk { &mut schemes } else { &mut laws };
            if !chapter.ways.contains(&entry.way) {
                chapter.ways.push(entry.way);
            }
        }
        [laws, schemes].into_iter().filter(|chapter| !chapter.ways.is_empty()).collect()
    }

    /// How many targets each law or scheme reaches in each benchmark.
    fn overview(&self, report: &SuiteReport) -> Section {
        let kind = self.kind;
        let caption = format!("Targets reached of targets judged. * what a scene gets that names no {kind}.");
        let counts = self.by_benchmark(caption, report, |entry| entry.map_or(Cell::Empty, reached));
        let heading = if kind == "law" { "Law by benchmark" } else { "Scheme by benchmark" };
        Section::new(heading).table(counts).table(self.times(report))
    }

    /// How long each law or scheme took for each benchmark.
    fn times(&self, report: &SuiteReport) -> Table {
        let caption = "Time taken [s], all resolutions together; one thread a run.".to_owned();
        self.by_benchmark(caption, report, |entry| {
            let outcomes =
                entry.iter().flat_map(|entry| &entry.runs).filter_map(|run| run.result.as_ref().ok());
            let times: Vec<f64> = outcomes.map(|outcome| outcome.record.wall_time).collect();
            if times.is_empty() { Cell::Empty } else { Cell::number(times.iter().sum(), 1) }
        })
    }

    /// A row for each benchmark that was put to one of these, with a cell for each.
    fn by_benchmark(
        &self,
        caption: String,
        report: &SuiteReport,
        cell: impl Fn(Option<&SuiteEntry>) -> Cell,
    ) -> Table {
        let mut columns = vec![Column::text("benchmark")];
        columns.extend(self.ways.iter().map(|way| Column::number(word(way))));
        let mut table = Table::new(caption, columns);
        for benchmark in benchmarks(report) {
            let entry = |way: &Candidate| entries(benchmark, report).find(|entry| entry.way == *way);
            if self.ways.iter().all(|way| entry(way).is_none()) {
                continue;
            }
            let mut row = vec![Cell::text(title(benchmark))];
            row.extend(self.ways.iter().map(|way| cell(entry(way))));
            table = table.row(row);
        }
        table
    }

    /// What each law or scheme does.
    fn words(&self) -> Section {
        let (heading, does) = match self.kind {
            "law" => ("The laws", "bodies push on each other"),
            _ => ("The schemes", "what moves between particles and grid, and when"),
        };
        let columns = vec![Column::text(self.kind), Column::text(does)];
        let row =
            |table: Table, way: &Candidate| table.row(vec![Cell::text(word(way)), Cell::text(way.meaning())]);
        Section::new(heading)
            .table(self.ways.iter().fold(Table::new("As scene files name them.", columns), row))
    }
}

fn entries<'a>(benchmark: &'a Benchmark, report: &'a SuiteReport) -> impl Iterator<Item = &'a SuiteEntry> {
    report.entries.iter().filter(move |entry| entry.benchmark.name == benchmark.name)
}

fn title(benchmark: &Benchmark) -> String {
    format!("{} {}", benchmark.name, benchmark.title)
}

/// The word of a law or scheme, with a star where it is what scenes get that name none.
fn word(way: &Candidate) -> String {
    if way.is_default() { format!("{} *", way.word()) } else { way.word().to_owned() }
}

/// What a benchmark is put to.
fn kind(benchmark: &Benchmark) -> &'static str {
    if benchmark.laws == Laws::Bulk { "scheme" } else { "law" }
}

fn colour(judgement: Verdict) -> Mark {
    match judgement {
        Verdict::Reached => Mark::Passed,
        Verdict::Missed => Mark::Failed,
        Verdict::Open => Mark::Known,
    }
}

fn reached(entry: &SuiteEntry) -> Cell {
    let verdicts: Vec<_> = entry.benchmark.targets.iter().map(|target| entry.verdict(target)).collect();
    let count = |wanted| verdicts.iter().filter(|verdict| **verdict == wanted).count();
    let (reached, missed) = (count(Verdict::Reached), count(Verdict::Missed));
    let text =
        if reached + missed == 0 { "open".to_owned() } else { format!("{reached} of {}", reached + missed) };
    Cell::Judged(text, colour(entry.overall()), address(&title(entry.benchmark)))
}

fn section(benchmark: &'static Benchmark, report: &SuiteReport) -> Section {
    let mut section = Section::new(title(benchmark))
        .text(format!("Source: {}.", benchmark.source.trim_end_matches('.')))
        .sketch(benchmark.picture.trim_matches('\n'))
        .text(format!("Set-up: {}", benchmark.set_up))
        .text(format!("Exact: {}", benchmark.exact));
    for entry in entries(benchmark, report) {
        for run in &entry.runs {
            if let Err(failure) = &run.result {
                let Resolution { cells, .. } = run.resolution;
                section = section.warning(format!(
                    "{} at {} = {cells}: {failure}",
                    entry.way.word(),
                    benchmark.measure
                ));
            }
        }
    }
    section = section.table(results(benchmark, report));
    for entry in entries(benchmark, report).filter(|entry| entry.overall() == Verdict::Missed) {
        for reason in entry.reasons() {
            section = section.text(format!("What {} misses: {reason}", entry.way.word()));
        }
    }
    section.table(targets(benchmark)).table(records(benchmark, report))
}

/// What each law or scheme measured at each resolution, against the targets.
fn results(benchmark: &'static Benchmark, report: &SuiteReport) -> Table {
    let mut columns = vec![Column::text(kind(benchmark)), Column::text("quantity")];
    let heading = |r: &Resolution| Column::number(format!("{} = {}", benchmark.measure, r.cells));
    columns.extend(benchmark.due(report.tier).map(heading));
    columns.extend([Column::number("order"), Column::text("target"), Column::text("verdict")]);
    let caption = format!(
        "Measured by each; the observed order of convergence is that of the two finest resolutions. {} counts cells.",
        benchmark.measure
    );
    let mut table = Table::new(caption, columns);
    for entry in entries(benchmark, report) {
        for (i, target) in benchmark.targets.iter().enumerate() {
            let way = if i == 0 { Cell::text(word(&entry.way)) } else { Cell::Empty };
            let mut row = vec![way, Cell::text(target.metric)];
            for resolution in benchmark.due(report.tier) {
                let run = entry.runs.iter().find(|run| run.resolution == *resolution);
                row.push(run.map_or(Cell::text("not run yet"), |run| value(run, target)));
            }
            row.push(entry.order(target).map_or(Cell::Empty, |order| Cell::number(order, 1)));
            row.push(Cell::text(stated(benchmark, target)));
            row.push(match entry.verdict(target) {
                Verdict::Open => Cell::text("not run at these cells"),
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
    let columns =
        ["quantity", "exact", "target", "why", "known misses, at most off by"].map(Column::text).into();
    benchmark.targets.iter().fold(
        Table::new("What is asked, and why that much.", columns),
        |table, target| {
            table.row(vec![
                Cell::text(target.metric),
                Cell::text(target.exact.to_string()),
                Cell::text(stated(benchmark, target)),
                Cell::text(target.why),
                Cell::text(misses(benchmark, target)),
            ])
        },
    )
}

/// Where the law or scheme of scenes that name none is known to miss a target, and how far it may be off there.
fn misses(benchmark: &Benchmark, target: &Target) -> String {
    let miss = |miss: &Miss| format!("{} at {} = {}", miss.off, benchmark.measure, miss.cells);
    let own = |it: &Miss| format!("{} on own grids", miss(it));
    target
        .misses
        .iter()
        .map(miss)
        .chain(own_misses(benchmark, target).iter().map(own))
        .collect::<Vec<_>>()
        .join(", ")
}

/// What every run records.
fn records(benchmark: &'static Benchmark, report: &SuiteReport) -> Table {
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
    let mut columns = vec![Column::text(kind(benchmark))];
    columns.extend(numbers.map(Column::number));
    let caption = "The worst of all runs at a resolution: energy over the largest that moved or was stored, momentum over the sum of the \
bodies' sqrt(2 mass * kinetic energy), where nothing outside acts; the overlap of round particles of two bodies; one thread a run.";
    let mut table = Table::new(caption, columns);
    for entry in entries(benchmark, report) {
        for run in &entry.runs {
            if let Ok(outcome) = &run.result {
                let mut row =
                    vec![Cell::text(word(&entry.way)), Cell::Number(run.resolution.cells.to_string())];
                row.extend(record(&outcome.record));
                table = table.row(row);
            }
        }
    }
    table
}

fn record(record: &RunRecord) -> [Cell; 8] {
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
