//! One measurement, in a process of its own: its threads, its memory from nothing, and nobody else's leftovers.

use super::memory;
use crate::failure::Failure;
use miette::miette;
use serde::{Deserialize, Serialize};
use std::io::{Read, Write};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::Instant;
use stickslip::door::{RankShare, Simulation};
use stickslip::march::March;
use stickslip::observe::{PROGRAM, present_state_sum};
use stickslip::run::RunOptions;
use stickslip::scene::Scene;
use stickslip::shared;

/// What a process is asked to measure.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Order {
    /// The scene.
    pub scene: String,
    /// Parameters of the scene with other values.
    pub overrides: Vec<(String, String)>,
    /// Threads.
    pub threads: usize,
    /// What to do with it.
    pub task: BenchTask,
}

/// What to do with a scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum BenchTask {
    /// Step, and look at the clock.
    Steps(Effort),
    /// The same by so many ranks, each with one thread.
    Ranks(Effort, usize),
    /// Run it from end to end, with the outputs that the scene asks for in this folder.
    Run(PathBuf),
}

/// How long to step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Effort {
    /// Steps before the first that counts: memory is allocated and caches and predictors settle.
    pub warm_up: u64,
    /// Repetitions, each of as many steps as the other.
    pub repetitions: usize,
    /// Fewest steps in a repetition: enough that sorting is paid for as often as it is due.
    pub least: u64,
    /// Most steps in a repetition.
    pub steps: u64,
    /// Wall time for all repetitions, unless that is less than the fewest steps take [s].
    pub seconds: f64,
}

/// What was measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BenchSample {
    /// Bodies.
    pub bodies: usize,
    /// Particles in all bodies.
    pub particles: usize,
    /// Steps of one repetition.
    pub steps: u64,
    /// Wall time of each repetition [s].
    pub repetitions: Vec<f64>,
    /// Wall time in each verb of the step, in all repetitions, and in what a run does beside [s].
    pub verbs: Vec<(String, f64)>,
    /// Processor time of a run from end to end, that of threads which write outputs included [s].
    pub processor_time: Option<f64>,
    /// Most memory that the process held from before the scene was read [bytes].
    pub memory: Option<u64>,
    /// Part of the repetitions' wall time in which the threads together had a core, over the number of threads.
    pub at_work: Option<f64>,
    /// What each rank had, and did in all repetitions.
    pub shares: Vec<RankShare>,
    /// The sum of the state before the first step that counts, which is always the same one.
    pub sum: Option<String>,
}

impl BenchSample {
    /// Adds the repetitions of another process, which took as many steps.
    pub fn add(&mut self, other: BenchSample) {
        let parts = [&*self, &other].map(|sample| sample.repetitions.iter().sum::<f64>());
        self.at_work = self
            .at_work
            .zip(other.at_work)
            .map(|(own, others)| (own * parts[0] + others * parts[1]) / (parts[0] + parts[1]));
        self.repetitions.extend(other.repetitions);
        for (verb, seconds) in &mut self.verbs {
            *seconds +=
                other.verbs.iter().find(|(name, _)| name == verb).map_or(0.0, |(_, seconds)| *seconds);
        }
        self.memory = self.memory.max(other.memory);
    }
}

/// The words by which a program starts itself for a measurement, of which it has an [`answer`].
pub const MEASURE: [&str; 2] = ["bench", "--measure"];

impl Order {
    /// Has a process of its own measure this.
    ///
    /// # Errors
    /// The process cannot be started, or fails; what it says goes where this process's own errors go.
    pub fn measure(&self) -> Result<BenchSample, Failure> {
        let wrong = |what: &dyn std::fmt::Display| Failure::Run(miette!("cannot measure: {what}"));
        let program = std::env::current_exe().map_err(|error| wrong(&error))?;
        let mut process = Command::new(program)
            .args(MEASURE)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|error| wrong(&error))?;
        let order = serde_json::to_vec(self).expect("an order is plain data");
        let mut input = process.stdin.take().expect("its input is a pipe");
        // Whoever ended before reading says why by its exit.
        let _ = input.write_all(&order);
        drop(input);
        let output = process.wait_with_output().map_err(|error| wrong(&error))?;
        if !output.status.success() {
            return Err(wrong(&format!("the process that measures ended with {}", output.status)));
        }
        serde_json::from_slice(&output.stdout).map_err(|error| wrong(&error))
    }
}

/// Reads an order from standard input, measures, and writes the sample to standard output.
///
/// # Errors
/// The order is none, its scene has mistakes, or a step fails.
pub fn answer() -> Result<(), Failure> {
    let before = memory::peak();
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text).map_err(|error| Failure::Input(miette!("{error}")))?;
    let order: Order = serde_json::from_str(&text).map_err(|error| Failure::Input(miette!("{error}")))?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(order.threads).build_global();
    pool.map_err(|error| Failure::Run(miette!("{error}")))?;
    let mut sample = take(&order)?;
    sample.memory = memory::peak().zip(before).map(|(peak, before)| peak.saturating_sub(before));
    let sample = serde_json::to_vec(&sample).expect("a sample is plain data");
    std::io::stdout().write_all(&sample).map_err(|error| Failure::Run(miette!("{error}")))
}

fn take(order: &Order) -> Result<BenchSample, Failure> {
    let (start, processor_time) = (Instant::now(), memory::processor_time());
    let loaded =
        stickslip::scene::parse("benchmark", &order.scene, &order.overrides).map_err(Failure::input)?;
    let located = |problem| Failure::input(loaded.source.locate(problem));
    if let BenchTask::Ranks(effort, count) = order.task {
        return shared::among_threads(&loaded.scene, (count, PROGRAM), |simulation| {
            let mut simulation = simulation.map_err(located)?;
            let mut sample = BenchSample {
                bodies: loaded.scene.bodies.len(),
                particles: simulation.particles(),
                ..BenchSample::default()
            };
            step((&loaded.scene, &mut *simulation), effort, &mut sample)?;
            Ok(sample)
        });
    }
    let mut simulation = stickslip::step::build(&loaded.scene).map_err(located)?;
    let mut sample = BenchSample {
        bodies: loaded.scene.bodies.len(),
        particles: simulation.particles(),
        ..BenchSample::default()
    };
    match &order.task {
        BenchTask::Ranks(..) => unreachable!("they are measured above"),
        BenchTask::Steps(effort) => step((&loaded.scene, &mut *simulation), *effort, &mut sample)?,
        BenchTask::Run(folder) => {
            let options = RunOptions { threads: order.threads, ..RunOptions::new(folder) };
            let summary = stickslip::run::run(&loaded.scene, &mut *simulation, &options, &mut |_| {})
                .map_err(Failure::run)?;
            sample.steps = simulation.steps();
            sample.repetitions = vec![start.elapsed().as_secs_f64()];
            let spent = memory::processor_time().zip(processor_time);
            sample.processor_time = spent.map(|(after, before)| after - before);
            let timings = summary.performance.timings;
            sample.verbs = timings.into_iter().map(|timing| (timing.verb, timing.seconds)).collect();
        }
    }
    Ok(sample)
}

fn step(
    (scene, simulation): (&Scene, &mut dyn Simulation),
    effort: Effort,
    sample: &mut BenchSample,
) -> Result<(), Failure> {
    advance(simulation, effort.warm_up)?;
    sample.steps = effort.steps_in(advance(simulation, 1)?);
    sample.sum = present_state_sum(scene, simulation);
    let (before, shares) = (verbs(simulation), simulation.shares());
    let core_time = memory::core_time();
    for _ in 0..effort.repetitions {
        sample.repetitions.push(advance(simulation, sample.steps)?);
    }
    let offered = rayon::current_num_threads() as f64 * sample.repetitions.iter().sum::<f64>();
    sample.at_work = memory::core_time().zip(core_time).map(|(after, before)| (after - before) / offered);
    sample.shares = simulation.shares();
    sample.shares.iter_mut().zip(shares).for_each(|(share, before)| *share = share.since(before));
    sample.verbs = verbs(simulation);
    for (verb, seconds) in &mut sample.verbs {
        *seconds -= before.iter().find(|(name, _)| name == verb).map_or(0.0, |(_, seconds)| *seconds);
    }
    Ok(())
}

/// Wall time of so many steps [s]. As in a run, particles may stay behind until somebody looks.
fn advance(simulation: &mut dyn Simulation, steps: u64) -> Result<f64, Failure> {
    let start = Instant::now();
    let mut march = March::to(f64::INFINITY).unseen();
    for _ in 0..steps {
        march.step(simulation).map_err(|error| Failure::Run(miette!("{error}")))?;
    }
    let taken = start.elapsed().as_secs_f64();
    simulation.show();
    Ok(taken)
}

impl Effort {
    /// Steps of a repetition if a step takes `pace` [s].
    fn steps_in(&self, pace: f64) -> u64 {
        let affordable = self.seconds / (self.repetitions as f64 * pace.max(1e-9));
        (affordable as u64).clamp(self.least, self.steps)
    }
}

fn verbs(simulation: &dyn Simulation) -> Vec<(String, f64)> {
    simulation.timings().into_iter().map(|(verb, seconds)| (verb.to_owned(), seconds)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::problems::{BenchExtent, cases};
    use super::*;

    #[test]
    fn steps_fit_into_the_time_that_there_is() {
        let effort = Effort { warm_up: 0, repetitions: 5, least: 1, steps: 64, seconds: 10.0 };
        assert_eq!(effort.steps_in(0.1), 20);
        assert_eq!(effort.steps_in(1e-3), 64);
        assert_eq!(effort.steps_in(60.0), 1);
    }

    #[test]
    fn samples_of_one_case_add_up() {
        let sample = |seconds: f64, at_work| BenchSample {
            steps: 4,
            repetitions: vec![seconds; 2],
            verbs: vec![("scatter".to_owned(), seconds)],
            at_work: Some(at_work),
            memory: Some((100.0 * seconds) as u64),
            ..BenchSample::default()
        };
        let mut sum = sample(1.0, 1.0);
        sum.add(sample(3.0, 0.6));
        assert_eq!((sum.repetitions, sum.verbs[0].1), (vec![1.0, 1.0, 3.0, 3.0], 4.0));
        assert_eq!((sum.at_work, sum.memory, sum.steps), (Some(0.7), Some(300), 4));
    }

    #[test]
    fn steps_are_counted_and_timed() {
        let case = cases(BenchExtent::Tiny, 1).swap_remove(0);
        let effort = Effort { warm_up: 2, repetitions: 3, least: 1, steps: 4, seconds: 60.0 };
        let order =
            Order { scene: case.scene, overrides: Vec::new(), threads: 1, task: BenchTask::Steps(effort) };
        let sample = take(&order).unwrap();
        assert_eq!((sample.bodies, sample.particles, sample.steps), (1, 512, 4));
        assert_eq!(sample.repetitions.len(), 3);
        let (all, verbs): (f64, f64) =
            (sample.repetitions.iter().sum(), sample.verbs.iter().map(|(_, seconds)| seconds).sum());
        assert!(verbs > 0.0 && verbs <= all, "{sample:?}");
    }
}
