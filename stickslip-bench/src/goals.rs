//! Ratios of what was measured, and what they are to be.

use crate::on_ranks::OnRanks;
use crate::record::{EndToEnd, PeerResult};
use crate::scaling::{CLUSTER, StepModel};
use serde::Serialize;
use stickslip_cli::bench::{BLOCKS_APART, BLOCKS_IN_CONTACT, Measured, median};

/// A number that is to be so large or so small.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Goal {
    /// What it is.
    pub name: String,
    /// What was measured.
    pub value: f64,
    /// `at least` or `at most`.
    pub sense: Sense,
    /// What it is to be.
    pub goal: f64,
    /// What would be very good.
    pub stretch: Option<f64>,
    /// Of a goal that is known to be missed, what it may not be worse than.
    pub bound: Option<f64>,
    /// Whether the goal is met.
    pub met: bool,
}

impl Goal {
    /// Whether it is worse than is known.
    pub fn is_beyond_bound(&self) -> bool {
        self.bound.is_some_and(|bound| !self.sense.holds(self.value, bound))
    }
}

/// Which way is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sense {
    /// The more the better.
    AtLeast,
    /// The less the better.
    AtMost,
}

impl Sense {
    /// Whether a value is at least, or at most, so large.
    fn holds(self, value: f64, limit: f64) -> bool {
        match self {
            Sense::AtLeast => value >= limit,
            Sense::AtMost => value <= limit,
        }
    }
}

/// Everything that goals are about.
#[derive(Clone, Copy, Debug)]
pub struct Findings<'a> {
    /// Problems P1 to P5.
    pub results: &'a [Measured],
    /// Problem P6.
    pub end_to_end: &'a [EndToEnd],
    /// Problem P7.
    pub on_ranks: &'a [OnRanks],
    /// The models that were fitted to it.
    pub models: &'a [StepModel],
    /// Other programs.
    pub peers: &'a [PeerResult],
}

/// What two ranks and borders of a million particles may cost at most, as long as they cost more than they should: the
/// worst of all measurements so far is 0.85 and 0.27.
const LEAST_SPEED_OF_RANKS: f64 = 0.75;
const MOST_AT_BORDERS: f64 = 0.4;

/// Fewest balls from which on time and memory per particle are to be flat.
const MANY_BALLS: usize = 64;

/// The goals about which something was measured.
pub fn goals(findings: Findings) -> Vec<Goal> {
    let goal = |name: &str, value: Option<f64>, (sense, goal, stretch): (Sense, f64, Option<f64>)| {
        let value = value.filter(|value| value.is_finite())?;
        let met = sense.holds(value, goal);
        Some(Goal { name: name.to_owned(), value, sense, goal, stretch, bound: None, met })
    };
    let bounded = |goal: Option<Goal>, bound: f64| goal.map(|goal| Goal { bound: Some(bound), ..goal });
    use Sense::{AtLeast, AtMost};
    let linear = findings.one("P1", ["linear", "double", "last"]);
    let default = |problem| findings.one(problem, ["linear", "double", "modified-last"]);
    let rate = |measured: Option<&Measured>| measured.map(|measured| measured.rate);
    let memory = |measured: Option<&Measured>| measured?.memory;
    let [gimp, single] =
        [["gimp", "double", "last"], ["linear", "single", "last"]].map(|how| findings.one("P1", how));
    let [cube, blocks, wide] = ["P1", "P2", "P4"].map(default);
    let own = findings.own("P1").next();
    let own_packs: Vec<&Measured> = findings.own("P3").filter(|pack| pack.bodies >= MANY_BALLS).collect();
    let own_pack_rates: Vec<f64> = own_packs.iter().map(|pack| pack.rate).collect();
    let contact = |basis| {
        let [on, off] =
            [BLOCKS_IN_CONTACT, BLOCKS_APART].map(|variant| rate(findings.blocks(variant, basis)));
        ratio(off, on)
    };
    let packs = findings.packs();
    let pack_rates: Vec<f64> = packs.iter().map(|pack| pack.rate).collect();
    let pack_memory: Vec<f64> = packs.iter().filter_map(|pack| pack.memory).collect();
    let growth: Vec<f64> = findings.of("P5").map(|measured| measured.rate).collect();
    let millions = |rate: Option<f64>| rate.map(|rate| rate / 1e6);
    let slowest =
        |rates: &[f64]| (!rates.is_empty()).then(|| rates.iter().copied().fold(f64::INFINITY, f64::min));
    let slowest_pack = slowest(&pack_rates);

    let mut goals = vec![
        goal(
            "P1 linear f64, M particle-steps per core-second",
            millions(rate(linear)),
            (AtLeast, 20.0, Some(40.0)),
        ),
        goal(
            "P1 GIMP f64, M particle-steps per core-second",
            millions(rate(gimp)),
            (AtLeast, 10.0, Some(20.0)),
        ),
        goal("P1 linear, f32 over f64", ratio(rate(single), rate(linear)), (AtLeast, 1.6, Some(1.9))),
        goal("P2 linear, contact on over off", contact("linear"), (AtMost, 1.25, Some(1.1))),
        goal("P2 GIMP, contact on over off", contact("gimp"), (AtMost, 1.25, Some(1.1))),
        goal("P2 time over P1's", ratio(rate(cube), rate(blocks)), (AtMost, 1.25, Some(1.1))),
        goal(
            "P3 time a particle, 64 balls and more: most over least",
            extremes(&pack_rates),
            (AtMost, 1.1, None),
        ),
        goal(
            "P3 memory a particle, 64 balls and more: most over least",
            extremes(&pack_memory),
            (AtMost, 1.1, None),
        ),
        goal("P3 time a particle over P1's", ratio(rate(cube), slowest_pack), (AtMost, 1.6, Some(1.3))),
        goal("P4 time over P1's", ratio(rate(cube), rate(wide)), (AtMost, 1.02, None)),
        goal("P4 memory over P1's", ratio(memory(wide), memory(cube)), (AtMost, 1.02, None)),
        goal("P5 time a particle: most over least", extremes(&growth), (AtMost, 1.1, None)),
        goal("P1 bytes of memory a particle", memory(cube), (AtMost, 450.0, Some(300.0))),
        goal(
            "P1 own grid, M particle-steps per core-second",
            millions(rate(own)),
            (AtLeast, 30.0, Some(45.0)),
        ),
        goal(
            "P3 own grids, time a particle over P1's",
            ratio(rate(own), slowest(&own_pack_rates)),
            (AtMost, 2.5, Some(1.5)),
        ),
        goal(
            "P3 own grids, time a particle: most over least",
            extremes(&own_pack_rates),
            (AtMost, 1.5, None),
        ),
    ];
    let quadratic = findings.peers.iter().filter(|peer| peer.basis == "quadratic");
    let best = quadratic.map(|peer| median(&peer.repetitions)).reduce(f64::max);
    goals.push(goal(
        "P1 own grid over the best of quadratic peers",
        ratio(rate(own), best),
        (AtLeast, 8.0, None),
    ));
    for (measured, speedup) in findings.speedups() {
        let threads = measured.case.threads;
        let scheme = measured.case.scheme;
        let how = if scheme.is_reference() { "own grids" } else { scheme.basis };
        let name = format!("{} {how} on {threads} threads over one", measured.case.problem);
        goals.push(goal(&name, Some(speedup), (AtLeast, 0.95 * threads as f64, None)));
    }
    for run in findings.end_to_end {
        let name = format!("P6 {}: time with outputs over time without", run.scene);
        goals.push(goal(&name, Some(run.ratio), (AtMost, 1.05, None)));
        let name = format!("P6 {}: time with checks of the run over time without", run.scene);
        goals.push(goal(&name, Some(run.checks), (AtMost, 1.02, None)));
        let name = format!("P6 {}: time with a checkpoint each minute over time without", run.scene);
        goals.push(goal(&name, Some(run.checkpoints), (AtMost, 1.01, None)));
    }
    for shared in findings.on_ranks.iter().filter(|shared| shared.ranks == 2) {
        let name = format!("P7 {}: speed of two ranks over that of two threads", shared.problem);
        goals.push(bounded(goal(&name, Some(shared.speed), (AtLeast, 0.9, None)), LEAST_SPEED_OF_RANKS));
    }
    for model in findings.models {
        let name =
            format!("P7 {}: part of borders in a step, 10^6 particles a rank, by the model", model.problem);
        let borders = goal(&name, Some(model.halo(1e6, CLUSTER)), (AtMost, 0.05, None));
        goals.push(bounded(borders, MOST_AT_BORDERS));
    }
    for peer in findings.peers.iter().filter(|peer| peer.basis == "linear") {
        let least = match peer.program.as_str() {
            "Warp" => 1.8,
            "Taichi" => 6.0,
            _ => continue,
        };
        let name = format!("P1 linear f64 over {}", peer.program);
        goals.push(goal(&name, ratio(rate(linear), Some(median(&peer.repetitions))), (AtLeast, least, None)));
    }
    goals.into_iter().flatten().collect()
}

impl<'a> Findings<'a> {
    /// What was measured of a problem on the common grid, on one thread.
    fn of(self, problem: &'static str) -> impl Iterator<Item = &'a Measured> {
        self.alone(problem).filter(|measured| !measured.case.scheme.is_reference())
    }

    /// The same on grids of their own.
    fn own(self, problem: &'static str) -> impl Iterator<Item = &'a Measured> {
        self.alone(problem).filter(|measured| measured.case.scheme.is_reference())
    }

    fn alone(self, problem: &'static str) -> impl Iterator<Item = &'a Measured> {
        self.results
            .iter()
            .filter(move |measured| measured.case.problem == problem && measured.case.threads == 1)
    }

    fn one(
        self,
        problem: &'static str,
        [basis, precision, stress_update]: [&str; 3],
    ) -> Option<&'a Measured> {
        self.of(problem).find(|measured| {
            let scheme = measured.case.scheme;
            (scheme.basis, scheme.precision, scheme.stress_update) == (basis, precision, stress_update)
        })
    }

    /// Two blocks in contact, or without it.
    fn blocks(self, variant: &str, basis: &str) -> Option<&'a Measured> {
        self.of("P2").find(|Measured { case, .. }| case.variant == variant && case.scheme.basis == basis)
    }

    fn packs(self) -> Vec<&'a Measured> {
        self.of("P3").filter(|measured| measured.bodies >= MANY_BALLS).collect()
    }

    /// How many times faster than one thread is each case on several.
    fn speedups(self) -> Vec<(&'a Measured, f64)> {
        let parallel = self.results.iter().filter(|measured| measured.case.threads > 1);
        let over_one = |many: &'a Measured| {
            let alone = |one: &&Measured| {
                let (one, many) = (&one.case, &many.case);
                one.threads == 1
                    && (one.problem, &one.variant, one.scheme) == (many.problem, &many.variant, many.scheme)
            };
            let one = self.results.iter().find(alone)?;
            Some((many, many.rate * many.case.threads as f64 / one.rate))
        };
        parallel.filter_map(over_one).collect()
    }
}

fn ratio(above: Option<f64>, below: Option<f64>) -> Option<f64> {
    Some(above? / below?)
}

/// The largest over the smallest of at least two.
fn extremes(values: &[f64]) -> Option<f64> {
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    (values.len() > 1).then_some(most / least)
}

#[cfg(test)]
mod tests {
    use super::*;
    use stickslip_cli::bench::{BenchCase, BenchScheme};

    fn measured(
        problem: &'static str,
        [basis, precision, stress_update]: [&'static str; 3],
        rate: f64,
    ) -> Measured {
        let scheme = BenchScheme { basis, precision, stress_update, ..BenchScheme::default() };
        Measured {
            case: BenchCase {
                problem,
                variant: if problem == "P2" { BLOCKS_IN_CONTACT.to_owned() } else { String::new() },
                scheme,
                threads: 1,
                scene: String::new(),
                expected: 0,
            },
            bodies: 1,
            particles: 1000,
            steps: 1,
            repetitions: vec![rate],
            rate,
            spread: 0.0,
            bytes: 0.0,
            of_copy: 0.0,
            of_multiply_add: 0.0,
            memory: Some(400.0),
            at_work: None,
            verbs: Vec::new(),
        }
    }

    fn value(goals: &[Goal], start: &str) -> Option<(f64, bool)> {
        goals.iter().find(|goal| goal.name.starts_with(start)).map(|goal| (goal.value, goal.met))
    }

    #[test]
    fn a_known_miss_may_not_become_worse() {
        let goal = |value, sense, goal, bound| {
            let met = Sense::holds(sense, value, goal);
            Goal { name: String::new(), value, sense, goal, stretch: None, bound, met }.is_beyond_bound()
        };
        use Sense::{AtLeast, AtMost};
        assert!(!goal(0.3, AtMost, 0.05, Some(0.4)) && goal(0.41, AtMost, 0.05, Some(0.4)));
        assert!(!goal(0.8, AtLeast, 0.9, Some(0.75)) && goal(0.74, AtLeast, 0.9, Some(0.75)));
        assert!(!goal(0.41, AtMost, 0.05, None));
    }

    #[test]
    fn ratios_are_those_of_the_measurements() {
        let one_pass = ["linear", "double", "last"];
        let plain = ["linear", "double", "modified-last"];
        let mut results = vec![
            measured("P1", one_pass, 20e6),
            measured("P1", ["gimp", "double", "last"], 8e6),
            measured("P1", ["linear", "single", "last"], 36e6),
            measured("P2", plain, 16e6),
            measured("P3", plain, 10e6),
            measured("P3", plain, 16e6),
            measured("P3", plain, 14.4e6),
            measured("P4", plain, 19e6),
            measured("P1", plain, 20e6),
        ];
        results[4].bodies = 8; // Too few balls to be asked about.
        results[5].bodies = 64;
        results[6].bodies = 4096;
        results[6].memory = Some(500.0);
        let mut apart = measured("P2", plain, 20e6);
        apart.case.variant = BLOCKS_APART.to_owned();
        results.push(apart);
        let mut parallel = measured("P1", plain, 19.5e6);
        parallel.case.threads = 2;
        results.push(parallel);
        for (problem, bodies, rate) in [("P1", 1, 32e6), ("P3", 8, 10e6), ("P3", 64, 16e6), ("P3", 216, 20e6)]
        {
            let mut own = measured(problem, plain, rate);
            (own.bodies, own.case.scheme) = (bodies, BenchScheme::reference());
            results.push(own);
        }
        let peer = |program: &str, rate| PeerResult {
            program: program.into(),
            version: String::new(),
            basis: "linear".into(),
            threads: 1,
            particles: 1000,
            steps: 1,
            repetitions: vec![rate],
            first_step: 0.0,
        };
        let mut peers = vec![peer("Warp", 10e6), peer("Taichi", 4e6), peer("Taichi, serial", 9e6)];
        for (program, rate) in [("Warp", 4e6), ("Taichi, serial", 3e6)] {
            peers.push(PeerResult { basis: "quadratic".into(), ..peer(program, rate) });
        }
        let goals =
            goals(Findings { results: &results, end_to_end: &[], on_ranks: &[], models: &[], peers: &peers });

        assert_eq!(value(&goals, "P1 linear f64, M"), Some((20.0, true)));
        assert_eq!(value(&goals, "P1 GIMP"), Some((8.0, false)));
        assert_eq!(value(&goals, "P1 linear, f32"), Some((1.8, true)));
        assert_eq!(value(&goals, "P2 time over P1's"), Some((1.25, true)));
        assert_eq!(value(&goals, "P2 linear, contact"), Some((1.25, true)));
        assert_eq!(value(&goals, "P2 GIMP"), None, "nothing was measured");
        let (flatness, met) = value(&goals, "P3 time a particle, 64").unwrap();
        assert!((flatness - 16.0 / 14.4).abs() < 1e-12 && !met);
        assert_eq!(value(&goals, "P3 memory"), Some((1.25, false)));
        let (slower, met) = value(&goals, "P3 time a particle over").unwrap();
        assert!((slower - 20.0 / 14.4).abs() < 1e-12 && met);
        assert_eq!(value(&goals, "P4 time"), Some((20.0 / 19.0, false)));
        assert_eq!(value(&goals, "P4 memory"), Some((1.0, true)));
        assert_eq!(value(&goals, "P5"), None, "nothing was measured");
        assert_eq!(value(&goals, "P1 linear on 2"), Some((1.95, true)));
        assert_eq!(value(&goals, "P1 linear f64 over Warp"), Some((2.0, true)));
        assert_eq!(value(&goals, "P1 linear f64 over Taichi"), Some((5.0, false)));
        assert_eq!(goals.iter().filter(|goal| goal.name.contains("serial")).count(), 0);
        assert_eq!(value(&goals, "P1 own grid, M"), Some((32.0, true)));
        assert_eq!(value(&goals, "P1 own grid over"), Some((8.0, true)));
        assert_eq!(value(&goals, "P3 own grids, time a particle over"), Some((2.0, true)));
        assert_eq!(value(&goals, "P3 own grids, time a particle: most"), Some((1.25, true)));
    }
}
