//! The report on the terminal.

use crate::goals::{Goal, Sense};
use crate::record::DeveloperRecord;
use crate::scaling::CLUSTER;
use std::fmt::{Display, Formatter, Result};
use stickslip_cli::bench::{TextTable, median, percent};

impl Display for DeveloperRecord {
    fn fmt(&self, f: &mut Formatter) -> Result {
        self.problems.fmt(f)?;
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

impl DeveloperRecord {
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
