//! The report on the terminal.

use super::goals::{Goal, Sense};
use super::record::{BenchRecord, Computer, Measured, median};
use super::scaling::CLUSTER;
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
        if !self.end_to_end.is_empty() {
            f.write_str(&self.whole_runs())?;
        }
        if !self.on_ranks.is_empty() {
            f.write_str(&self.shared())?;
        }
        if !self.peers.is_empty() {
            f.write_str(&self.other_programs())?;
        }
        f.write_str(&goals(&self.goals))
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

impl BenchRecord {
    fn whole_runs(&self) -> String {
        let mut table = TextTable::new(&[
            "<scene",
            "particles",
            "steps",
            "threads",
            "with s",
            "without s",
            "ratio",
            "checks",
            "checkpoints",
        ]);
        for run in &self.end_to_end {
            let fastest =
                |times: &[f64]| format!("{:.2}", times.iter().copied().fold(f64::INFINITY, f64::min));
            table.row([
                run.scene.clone(),
                run.particles.to_string(),
                run.steps.to_string(),
                run.threads.to_string(),
                fastest(&run.with_outputs),
                fastest(&run.without_outputs),
                format!("{:.3}", run.ratio),
                format!("{:.4}", run.checks),
                format!("{:.5}", run.checkpoints),
            ]);
        }
        format!(
            "P6, whole runs with and without outputs; ratios of time with and without checks, and of processor time \
             with and without a checkpoint each minute.\n{table}\n"
        )
    }

    fn shared(&self) -> String {
        let mut table = TextTable::new(&[
            "<problem",
            "particles",
            "ranks",
            "threads ms",
            "ranks ms",
            "speed",
            "kB sent",
            "by model",
            "messages",
            "waiting",
            "imbalance",
        ]);
        for shared in &self.on_ranks {
            let milliseconds = |times: &[f64]| format!("{:.2}", 1e3 * median(times));
            table.row([
                shared.problem.clone(),
                shared.particles.to_string(),
                shared.ranks.to_string(),
                milliseconds(&shared.threads),
                milliseconds(&shared.seconds),
                format!("{:.2}", shared.speed),
                format!("{:.0}", shared.bytes / 1e3),
                format!("{:.0}", shared.modelled / 1e3),
                format!("{:.0}", shared.messages),
                percent(shared.waiting),
                format!("{:.2}", shared.imbalance),
            ]);
        }
        let mut weak = TextTable::new(&[
            "<problem",
            "particles",
            "ranks",
            "alone ms",
            "ranks ms",
            "by model",
            "efficiency",
            "kB sent",
            "by model",
            "imbalance",
        ]);
        for grown in &self.weak_scaling {
            let model = self.models.iter().find(|model| model.problem == grown.problem);
            let modelled =
                model.map_or(f64::NAN, |model| model.without_network(grown.ranks, grown.particles));
            let milliseconds = |time: f64| format!("{:.2}", 1e3 * time);
            weak.row([
                grown.problem.clone(),
                grown.particles.to_string(),
                grown.ranks.to_string(),
                milliseconds(grown.particle * grown.particles as f64 / grown.ranks as f64),
                milliseconds(median(&grown.seconds)),
                milliseconds(modelled),
                percent(grown.efficiency()),
                format!("{:.0}", grown.bytes / 1e3),
                format!("{:.0}", grown.modelled / 1e3),
                format!("{:.2}", grown.imbalance),
            ]);
        }
        let mut models = TextTable::new(&[
            "<model",
            "ns a particle",
            "ns a byte",
            "ns a body",
            "100 ranks",
            "1000",
            "10000",
            "borders",
        ]);
        for model in &self.models {
            let one = model.step(1.0, 1e6, CLUSTER).sum();
            let weak = |ranks: f64| percent(one / model.step(ranks, 1e6, CLUSTER).sum());
            models.row([
                model.problem.clone(),
                format!("{:.1}", 1e9 * model.particle),
                format!("{:.2}", 1e9 * model.byte),
                format!("{:.1}", 1e9 * model.body),
                weak(100.0),
                weak(1e3),
                weak(1e4),
                percent(model.halo(1e6, CLUSTER)),
            ]);
        }
        let strong = format!(
            "P7, a step by ranks of one thread against as many threads of one process, with the same bits; what a rank \
             sends\nin a step, and by the model without contact; more ranks than cores take turns.\n{table}\n"
        );
        if self.weak_scaling.is_empty() {
            return strong
                + "On one core nothing is measured that grows with the ranks, and no model is fitted.\n\n";
        }
        let network = CLUSTER.name;
        format!(
            "{strong}The same grown with the ranks, against as many single ranks, each with all of it.\n{weak}\n\
             By the model of a step, {network}: efficiency with 10^6\nparticles a rank, and the part of borders in a \
             step.\n{models}\n"
        )
    }

    fn other_programs(&self) -> String {
        let mut table =
            TextTable::new(&["<program", "<version", "<basis", "threads", "M/core s", "first step s"]);
        for peer in &self.peers {
            table.row([
                peer.program.clone(),
                peer.version.clone(),
                peer.basis.clone(),
                peer.threads.to_string(),
                format!("{:.2}", median(&peer.repetitions) / 1e6),
                format!("{:.1}", peer.first_step),
            ]);
        }
        format!("Other programs on P1, f64.\n{table}\n")
    }
}

fn goals(goals: &[Goal]) -> String {
    let mut table = TextTable::new(&["<goal", "measured", "<", "goal", "stretch", "<"]);
    for goal in goals {
        let number = |value: f64| if value < 100.0 { format!("{value:.2}") } else { format!("{value:.0}") };
        table.row([
            goal.name.clone(),
            number(goal.value),
            match goal.sense {
                Sense::AtLeast => ">=",
                Sense::AtMost => "<=",
            }
            .to_owned(),
            number(goal.goal),
            goal.stretch.map_or(String::new(), number),
            match (goal.met, goal.bound) {
                (true, _) => "met".to_owned(),
                (false, None) => "missed".to_owned(),
                (false, Some(bound)) if goal.is_beyond_bound() => format!("missed, beyond {}", number(bound)),
                (false, Some(bound)) => format!("missed, within {}", number(bound)),
            },
        ]);
    }
    format!("Goals.\n{table}")
}

fn percent(share: f64) -> String {
    if share.is_finite() { format!("{:.0} %", 100.0 * share) } else { "-".to_owned() }
}

/// Columns under a head; those whose head starts with `<` stand left, the others right.
struct TextTable {
    rows: Vec<Vec<String>>,
    left: Vec<bool>,
}

impl TextTable {
    fn new(head: &[&str]) -> Self {
        let left = head.iter().map(|name| name.starts_with('<')).collect();
        let names = head.iter().map(|name| name.trim_start_matches('<').to_owned()).collect();
        TextTable { rows: vec![names], left }
    }

    fn row(&mut self, cells: impl Into<Vec<String>>) {
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
