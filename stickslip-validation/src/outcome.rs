//! What a benchmark measured.

use crate::trial::{RunRecord, Trial};

/// What one case measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// The measured quantities, in the order in which the benchmark took them.
    pub measurements: Vec<Measurement>,
    /// What every run records, the worst of all runs.
    pub record: RunRecord,
    /// The scenes that were run, by name, as `stickslip run` takes them.
    pub scenes: Vec<(String, String)>,
}

/// A quantity and its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Name of the quantity.
    pub metric: &'static str,
    /// Its value.
    pub value: f64,
}

impl Outcome {
    /// Notes a value.
    pub fn measure(&mut self, metric: &'static str, value: f64) {
        self.measurements.push(Measurement { metric, value });
    }

    /// Takes in what a finished run recorded.
    pub fn include(&mut self, trial: Trial) {
        let (name, text, record) = trial.finish();
        self.record.include(&record);
        self.scenes.push((name, text));
    }

    /// The value of a quantity, if it was measured.
    pub fn value(&self, metric: &str) -> Option<f64> {
        self.measurements.iter().find(|measurement| measurement.metric == metric).map(|found| found.value)
    }
}
