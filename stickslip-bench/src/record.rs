//! What was found: the JSON file.

use crate::goals::Goal;
use crate::on_ranks::{OnRanks, WeakScaling};
use crate::scaling::StepModel;
use serde::{Deserialize, Serialize};
use stickslip_cli::bench::BenchRecord;

/// Everything that one call found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DeveloperRecord {
    /// The machine, and problems P1 to P5.
    #[serde(flatten)]
    pub problems: BenchRecord,
    /// Problem P6.
    pub end_to_end: Vec<EndToEnd>,
    /// Problem P7.
    pub on_ranks: Vec<OnRanks>,
    /// Problem P7, growing with the ranks.
    pub weak_scaling: Vec<WeakScaling>,
    /// What a step of these takes by the model that was fitted to them.
    pub models: Vec<StepModel>,
    /// Other programs on problem P1.
    pub peers: Vec<PeerResult>,
    /// Ratios, and what they are to be.
    pub goals: Vec<Goal>,
}

/// A scene run from start to end, with and without outputs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EndToEnd {
    /// The scene.
    pub scene: String,
    /// Threads.
    pub threads: usize,
    /// Particles.
    pub particles: usize,
    /// Steps.
    pub steps: u64,
    /// Wall times with the outputs that the scene asks for [s].
    pub with_outputs: Vec<f64>,
    /// Wall times without outputs but the first and last rows [s].
    pub without_outputs: Vec<f64>,
    /// The fastest with over the fastest without outputs.
    pub ratio: f64,
    /// Wall time with the checks of a run over that without, as the run counts them.
    pub checks: f64,
    /// Processor time with a checkpoint each minute of it over that without, by what a checkpoint adds.
    pub checkpoints: f64,
}

/// Another program on problem P1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PeerResult {
    /// The program, and how it is used.
    pub program: String,
    /// Its version.
    pub version: String,
    /// `linear` or `quadratic`.
    pub basis: String,
    /// Threads that it uses.
    pub threads: usize,
    /// Particles.
    pub particles: usize,
    /// Steps of a repetition.
    pub steps: u64,
    /// Particle-steps per core-second of each repetition.
    pub repetitions: Vec<f64>,
    /// Wall time until the first step was done: compilation [s].
    pub first_step: f64,
}
