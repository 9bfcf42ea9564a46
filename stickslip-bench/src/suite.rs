//! Which problems are measured, one after the other.

use crate::end_to_end::wholes;
use crate::goals::{Findings, goals};
use crate::on_ranks::{self, OnRanks, WeakScaling};
use crate::peers::Peers;
use crate::record::DeveloperRecord;
use crate::scaling::StepModel;
use stickslip_cli::bench::{BenchExtent, BenchSuite, Failure, grown};

/// What is to be measured.
pub struct DeveloperSuite {
    /// How much of which problems, `P6` and `P7` among them, on how many threads.
    pub problems: BenchSuite,
    /// Other programs, if they are to be measured too.
    pub peers: Option<Peers>,
}

/// Names of the problems.
pub const PROBLEMS: [&str; 7] = ["P1", "P2", "P3", "P4", "P5", "P6", "P7"];

/// How often problems on ranks take turns with threads.
const TURNS_ON_RANKS: usize = 3;

impl DeveloperSuite {
    /// Measures everything, and says on standard error what it is at.
    ///
    /// # Errors
    /// Other programs cannot be installed, or a measurement fails.
    pub fn run(&self) -> Result<DeveloperRecord, Failure> {
        let BenchSuite { extent, threads, .. } = self.problems;
        // First what may be missing, then what takes long.
        let python = self.peers.as_ref().map(Peers::prepare).transpose()?;
        let mut record = DeveloperRecord {
            problems: self.problems.run()?,
            end_to_end: Vec::new(),
            on_ranks: Vec::new(),
            weak_scaling: Vec::new(),
            models: Vec::new(),
            peers: Vec::new(),
            goals: Vec::new(),
        };
        if self.problems.wants("P6") {
            for whole in wholes(extent) {
                eprintln!("P6 {}, with and without outputs ...", whole.name);
                record.end_to_end.push(whole.measure(threads)?);
            }
        }
        if self.problems.wants("P7") {
            let (effort, body) = (self.problems.effort(), on_ranks::body_elsewhere(extent)?);
            for case in on_ranks::problems(extent) {
                let turns = if extent == BenchExtent::Tiny { 1 } else { TURNS_ON_RANKS };
                let measured = OnRanks::measure(&case, effort, turns)?;
                let bigger = |times: usize| grown(&case, extent, times);
                let grown = WeakScaling::measure(&case, &bigger, (effort, turns))?;
                let bodies = measured.first().map_or(0.0, |one| one.bodies as f64 / one.particles as f64);
                record.models.extend(StepModel::fit(&grown, case.scheme, (bodies, body)));
                record.on_ranks.extend(measured);
                record.weak_scaling.extend(grown);
            }
        }
        if let Some((peers, python)) = self.peers.as_ref().zip(python) {
            record.peers = peers.measure(&python)?;
        }
        let findings = Findings {
            results: &record.problems.results,
            end_to_end: &record.end_to_end,
            on_ranks: &record.on_ranks,
            models: &record.models,
            peers: &record.peers,
        };
        record.goals = goals(findings);
        Ok(record)
    }
}
