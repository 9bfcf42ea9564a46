//! What a benchmark found: the JSON file.

use super::limits::Limits;
use super::measure::BenchSample;
use super::problems::BenchCase;
use serde::Serialize;

/// Everything that one call of `stickslip bench` found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BenchRecord {
    /// `stickslip`.
    pub program: &'static str,
    /// Version of the program.
    pub version: &'static str,
    /// When it was measured: seconds since 1970.
    pub unix_time: u64,
    /// Where.
    pub machine: Computer,
    /// Problems P1 to P5.
    pub results: Vec<Measured>,
    /// What was left out, and why.
    pub skipped: Vec<Skipped>,
}

/// The machine.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Computer {
    /// What the processor calls itself.
    pub processor: String,
    /// Cores that this process may use.
    pub cores: usize,
    /// The vector instructions that limits were measured with.
    pub instructions: &'static str,
    /// Limits of one thread, and of all.
    pub limits: Vec<Limits>,
}

/// One case of P1 to P5, measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Measured {
    /// The case.
    #[serde(flatten)]
    pub case: BenchCase,
    /// Bodies.
    pub bodies: usize,
    /// Particles.
    pub particles: usize,
    /// Steps of a repetition.
    pub steps: u64,
    /// Particle-steps per core-second of each repetition.
    pub repetitions: Vec<f64>,
    /// Their median.
    pub rate: f64,
    /// Half the distance between the fastest and the slowest, as a part of the median.
    pub spread: f64,
    /// Bytes that a particle and a step must move, by the model in the book.
    pub bytes: f64,
    /// Those bytes in a second, as a part of what the machine copies.
    pub of_copy: f64,
    /// Multiply-adds in a second by the same model, as a part of what the machine does.
    pub of_multiply_add: f64,
    /// Most memory of the process over its particles [bytes].
    pub memory: Option<f64>,
    /// Part of the time in which each thread had a core: less than all where the machine did other things too,
    /// and the rate is too low.
    pub at_work: Option<f64>,
    /// Time in each verb of the step for each particle and step, on all threads together [ns].
    pub verbs: Vec<Verb>,
}

/// A verb of the step.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verb {
    /// Its name.
    pub verb: String,
    /// Core time for a particle and a step [ns].
    pub nanoseconds: f64,
}

/// A case that was not measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Skipped {
    /// The case.
    #[serde(flatten)]
    pub case: BenchCase,
    /// Why.
    pub reason: String,
}

impl Measured {
    /// What a sample says about a case on a machine.
    pub fn new(case: BenchCase, sample: BenchSample, machine: &Computer) -> Self {
        let limits = machine.limits.iter().find(|limits| limits.threads == case.threads);
        let particle_steps = sample.particles as f64 * sample.steps as f64;
        let cores = case.threads as f64;
        let repetitions: Vec<f64> =
            sample.repetitions.iter().map(|seconds| particle_steps / (seconds * cores)).collect();
        let rate = median(&repetitions);
        let single = case.scheme.precision == "single";
        let copy = limits.map_or(f64::NAN, |limits| limits.copy / cores);
        let adds = limits.map_or(f64::NAN, |limits| {
            let rate = if single { limits.multiply_add.single } else { limits.multiply_add.double };
            rate / cores
        });
        let verb = |(verb, seconds): (String, f64)| Verb {
            verb,
            nanoseconds: 1e9 * seconds * cores / (particle_steps * sample.repetitions.len() as f64),
        };
        Measured {
            bodies: sample.bodies,
            particles: sample.particles,
            steps: sample.steps,
            rate,
            spread: spread(&repetitions),
            bytes: case.scheme.bytes(),
            of_copy: rate * case.scheme.bytes() / copy,
            of_multiply_add: rate * case.scheme.multiply_adds() / adds,
            memory: sample.memory.map(|bytes| bytes as f64 / sample.particles as f64),
            at_work: sample.at_work,
            verbs: sample.verbs.into_iter().map(verb).collect(),
            repetitions,
            case,
        }
    }
}

/// The middle one, or the mean of the two in the middle; of none, not a number.
pub fn median(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => f64::NAN,
        odd if odd % 2 == 1 => values[middle],
        _ => 0.5 * (values[middle - 1] + values[middle]),
    }
}

/// Half the distance between the extremes as a part of the median.
fn spread(values: &[f64]) -> f64 {
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    0.5 * (most - least) / median(values)
}

#[cfg(test)]
mod tests {
    use super::super::multiply_add::MultiplyAdds;
    use super::super::problems::BenchScheme;
    use super::*;

    #[test]
    fn rates_are_per_core_and_fractions_of_the_limits() {
        let scheme = BenchScheme { stress_update: "last", ..BenchScheme::default() };
        let case = BenchCase {
            problem: "P1",
            variant: "cube".into(),
            scheme,
            threads: 2,
            scene: String::new(),
            expected: 0,
        };
        let multiply_add = MultiplyAdds { double: 446e6 * 8.0, single: 1.0 };
        let limits = Limits { threads: 2, copy: 4e6 * scheme.bytes(), multiply_add };
        let machine = Computer { processor: String::new(), cores: 2, instructions: "", limits: vec![limits] };
        let sample = BenchSample {
            bodies: 1,
            particles: 1_000_000,
            steps: 10,
            repetitions: vec![5.0, 10.0, 4.0],
            verbs: vec![("scatter".into(), 9.5)],
            processor_time: None,
            memory: Some(500_000_000),
            at_work: None,
            shares: Vec::new(),
            sum: None,
        };
        let measured = Measured::new(case, sample, &machine);
        assert_eq!(measured.repetitions, [1e6, 0.5e6, 1.25e6]);
        assert_eq!((measured.rate, measured.spread), (1e6, 0.375));
        assert_eq!((measured.of_copy, measured.of_multiply_add), (0.5, 0.25));
        assert_eq!(measured.memory, Some(500.0));
        assert!((measured.verbs[0].nanoseconds - 9.5 * 2.0 * 1e9 / 30e6).abs() < 1e-9);
    }

    #[test]
    fn medians() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(&[]).is_nan());
    }
}
