//! Problem P7: what several ranks of one thread take for a problem, against as many threads of one process.
//!
//! The ranks are threads of a process whose only way to each other are messages ([`stickslip::ranks::Threads`]): what
//! they send is what processes send, but for the time that a network takes.

use crate::scaling::halo;
use miette::miette;
use serde::Serialize;
use stickslip::check::free_memory;
use stickslip::door::RankShare;
use stickslip_cli::bench::{
    BLOCKS_IN_CONTACT, BenchCase, BenchExtent, BenchSample, BenchScheme, BenchTask, Effort, Failure, Order,
    cases, median,
};

/// A problem on so many ranks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OnRanks {
    /// The problem, in a few words.
    pub problem: String,
    /// Ranks, of one thread each.
    pub ranks: usize,
    /// Particles.
    pub particles: usize,
    /// Bodies.
    pub bodies: usize,
    /// Wall time of a step by one process of as many threads, repetition by repetition [s].
    pub threads: Vec<f64>,
    /// Wall time of a step by the ranks likewise [s].
    pub seconds: Vec<f64>,
    /// The median of the former over that of the latter.
    pub speed: f64,
    /// What a rank sends in a step, the mean over ranks [bytes].
    pub bytes: f64,
    /// The same by the model in the book, without what contact adds [bytes].
    pub modelled: f64,
    /// In so many messages.
    pub messages: f64,
    /// Time in which a rank computed in a step, the mean over ranks [s].
    pub computed: f64,
    /// Part of the time in steps in which ranks waited, the mean over ranks.
    pub waiting: f64,
    /// Time in which the slowest rank computed over the mean.
    pub imbalance: f64,
}

/// The problems that are shared: P1, P2 with GIMP, and a pack of P3.
pub fn problems(extent: BenchExtent) -> Vec<BenchCase> {
    let plain = BenchScheme::default();
    let gimp = BenchScheme { basis: "gimp", ..plain };
    let pack = if extent == BenchExtent::Tiny { "8 balls" } else { "64 balls" };
    let wanted = [("P1", "cube", plain), ("P2", BLOCKS_IN_CONTACT, gimp), ("P3", pack, plain)];
    let all = cases(extent, 1);
    let found = wanted.iter().filter_map(|(problem, variant, scheme)| {
        all.iter().find(|case| (case.problem, &*case.variant, case.scheme) == (*problem, variant, *scheme))
    });
    found.cloned().collect()
}

impl OnRanks {
    /// Measures a problem on 1, 2 and 4 ranks, and on 8, 16 and so on if there are as many cores, by turns with as many
    /// threads, so often.
    ///
    /// # Errors
    /// A measurement fails, or ranks end in other bits than threads.
    pub fn measure(case: &BenchCase, effort: Effort, turns: usize) -> Result<Vec<Self>, Failure> {
        let counts = (0..).map(|power| 1 << power).take_while(|&ranks| ranks <= cores().max(4));
        counts.map(|ranks| Self::of(case, (effort, turns), ranks)).collect()
    }

    fn of(case: &BenchCase, (mut effort, turns): (Effort, usize), ranks: usize) -> Result<Self, Failure> {
        let problem = case.label();
        eprintln!("P7 {problem}, {ranks} ranks ...");
        let (mut threads, mut seconds, mut shares) = (Vec::new(), Vec::new(), Vec::new());
        let (mut particles, mut bodies) = (0, 0);
        for _ in 0..turns {
            let order = |task: BenchTask, threads: usize| Order {
                scene: case.scene.clone(),
                overrides: Vec::new(),
                threads,
                task,
            };
            let alone = order(BenchTask::Steps(effort), ranks).measure()?;
            // All repetitions have as many steps as the first.
            (effort.steps, effort.least, effort.seconds) = (alone.steps, alone.steps, f64::MAX);
            let shared = order(BenchTask::Ranks(effort, ranks), 1).measure()?;
            if shared.sum != alone.sum || alone.sum.is_none() {
                return Err(Failure::Run(miette!(
                    "{problem} ends in other bits on {ranks} ranks than on one"
                )));
            }
            let each = |all: &[f64]| all.iter().map(|time| time / alone.steps as f64).collect::<Vec<_>>();
            threads.extend(each(&alone.repetitions));
            seconds.extend(each(&shared.repetitions));
            (particles, bodies, shares) = (shared.particles, shared.bodies, shared.shares);
        }
        let mean = |of: &dyn Fn(&RankShare) -> f64| shares.iter().map(of).sum::<f64>() / ranks as f64;
        let computed = mean(&|share| share.computed);
        let slowest = shares.iter().map(|share| share.computed).fold(0.0, f64::max);
        Ok(OnRanks {
            ranks,
            particles,
            bodies,
            speed: median(&threads) / median(&seconds),
            threads,
            seconds,
            bytes: mean(&|share| share.traffic.bytes as f64 / steps_of(share)),
            modelled: halo(case.scheme, (particles, ranks)),
            messages: mean(&|share| share.traffic.messages as f64 / steps_of(share)),
            computed: mean(&|share| share.computed / steps_of(share)),
            waiting: mean(&|share| {
                let waited = share.traffic.waited;
                waited / (waited + share.computed).max(f64::MIN_POSITIVE)
            }),
            imbalance: slowest / computed.max(f64::MIN_POSITIVE),
            problem,
        })
    }
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// A problem that grows with the ranks, against as many single ones side by side, each with all of it: cores share what
/// memory gives, so one that is alone computes faster, and the larger a problem is, the more of its particles have
/// neighbours to meet.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WeakScaling {
    /// The problem, in a few words, as it is for one rank.
    pub problem: String,
    /// Ranks, of one thread each, and each with a core.
    pub ranks: usize,
    /// Particles of all of them.
    pub particles: usize,
    /// Wall time of a step by the ranks, repetition by repetition [s].
    pub seconds: Vec<f64>,
    /// Time in which a rank computed in a step, the mean over ranks [s].
    pub computed: f64,
    /// Time in which a particle of the same problem is computed in a step by single ranks, side by side [s].
    pub particle: f64,
    /// What a rank sends in a step, the mean over ranks [bytes].
    pub bytes: f64,
    /// The same by the model in the book, without what contact adds [bytes].
    pub modelled: f64,
    /// Time in which the slowest rank computed over the mean.
    pub imbalance: f64,
}

impl WeakScaling {
    /// Measures a problem on 2, 4, 8 ranks and so on as far as there are cores, and memory for as many of it, so often:
    /// `grown` is the problem with so many times as many particles.
    ///
    /// # Errors
    /// A measurement fails.
    pub fn measure(
        case: &BenchCase,
        grown: &dyn Fn(usize) -> BenchCase,
        (effort, turns): (Effort, usize),
    ) -> Result<Vec<Self>, Failure> {
        let counts = (1..).map(|power| 1 << power).take_while(|&ranks| ranks <= cores());
        let cases = counts.map(|ranks| (grown(ranks), ranks));
        let fit = cases.take_while(|(grown, ranks)| {
            let scene = stickslip::scene::parse("bench", &grown.scene, &[]);
            let report = scene.ok().and_then(|read| stickslip::check::report(&read.scene).ok());
            let fits = report.is_none_or(|report| report.memory * *ranks as f64 <= free_memory());
            if !fits {
                eprintln!("P7 {}, grown to {ranks} ranks: left out for want of memory", case.label());
            }
            fits
        });
        fit.map(|(grown, ranks)| Self::of((case.label(), &grown), (effort, turns), ranks)).collect()
    }

    fn of(
        (problem, grown): (String, &BenchCase),
        (effort, turns): (Effort, usize),
        ranks: usize,
    ) -> Result<Self, Failure> {
        eprintln!("P7 {problem}, grown to {ranks} ranks ...");
        let order = |ranks: usize| Order {
            scene: grown.scene.clone(),
            overrides: Vec::new(),
            threads: 1,
            task: BenchTask::Ranks(effort, ranks),
        };
        let (mut apart, mut shared, mut seconds) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..turns {
            apart.extend(side_by_side(&order(1), ranks)?);
            let sample = order(ranks).measure()?;
            seconds.extend(sample.repetitions.iter().map(|time| time / sample.steps as f64));
            shared.push(sample);
        }
        let of_shares = |of: &dyn Fn(&RankShare) -> f64| -> Vec<f64> {
            shared.iter().flat_map(|sample| &sample.shares).map(|share| of(share) / steps_of(share)).collect()
        };
        let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
        let computed = of_shares(&|share| share.computed);
        let slowest = |shares: &[f64]| shares.iter().copied().fold(0.0, f64::max) / mean(shares);
        let imbalances: Vec<f64> = computed.chunks(ranks).map(slowest).collect();
        let per_particle = |sample: &BenchSample| {
            let share = sample.shares.first().copied().unwrap_or_default();
            share.computed / steps_of(&share) / sample.particles as f64
        };
        let particles = shared.first().map_or(0, |sample| sample.particles);
        Ok(WeakScaling {
            problem,
            ranks,
            particles,
            seconds,
            computed: mean(&computed),
            particle: median(&apart.iter().map(per_particle).collect::<Vec<_>>()),
            bytes: mean(&of_shares(&|share| share.traffic.bytes as f64)),
            modelled: halo(grown.scheme, (particles, ranks)),
            imbalance: median(&imbalances),
        })
    }

    /// How much of what single ranks do is done by these.
    pub fn efficiency(&self) -> f64 {
        self.particle * self.particles as f64 / self.ranks as f64 / median(&self.seconds)
    }
}

fn steps_of(share: &RankShare) -> f64 {
    share.steps.max(1) as f64
}

/// So many processes that measure the same side by side.
fn side_by_side(order: &Order, count: usize) -> Result<Vec<BenchSample>, Failure> {
    let samples: Vec<_> = std::thread::scope(|scope| {
        let started: Vec<_> = (0..count).map(|_| scope.spawn(|| order.measure())).collect();
        started.into_iter().map(|one| one.join().expect("a measurement does not panic")).collect()
    });
    samples.into_iter().collect()
}

/// A block, and what the other rank has: as many particles in the same places, each a grain or in strings of such
/// grains. There are so many that what each of them costs the block's rank can be told from noise.
const BLOCK: &str = r#"
[space]
dimension = "3d"
interior = "grid"
cell = 1
basis = "linear"
[time]
end = 100
[materials]
sand = { density = 1000, neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 } }
[[bodies]]
name = "block"
material = "sand"
shape.box = { min = [-48, 0, 0], max = [-32, 16, 16] }
[[bodies]]
material = "sand"
particles_per_side = 1
"#;
const GRAINS: &str = r#"
name = "grain {i} {j} {k}"
repeat = { i = 32, j = 32, k = 32 }
shape.box = { min = ["4 * i + 1", "4 * j + 1", "4 * k + 1"], max = ["4 * i + 2", "4 * j + 2", "4 * k + 2"] }
"#;

/// As many grains on each string.
const ON_A_STRING: usize = 32;

/// The same grains on strings along the last axis, a body each.
fn strings_of_grains() -> String {
    let ends = |k: usize| [4 * k + 1, 4 * k + 2].map(|z| format!("[\"4 * i + 1\", \"4 * j + 1\", {z}]"));
    let grain = |k: usize| {
        let [min, max] = ends(k);
        format!("{{ box = {{ min = {min}, max = {} }} }}", max.replace("+ 1", "+ 2"))
    };
    let grains: Vec<String> = (0..ON_A_STRING).map(grain).collect();
    format!(
        "name = \"string {{i}} {{j}}\"\nrepeat = {{ i = 32, j = 32 }}\nshape.union = [{}]\n",
        grains.join(", ")
    )
}

/// Before ranks compare their times, and the one with the grains would give some away.
const UNDIVIDED: Effort = Effort { warm_up: 1, repetitions: 1, least: 12, steps: 12, seconds: 0.0 };
/// The least of so many measurements counts: whatever else a machine does makes it longer.
const TIMES: usize = 3;

/// What computing a step takes for a body that another rank has [s]: a block's rank beside grains, and beside the same
/// grains in fewer bodies. What the other rank does with its memory slows the block in both.
///
/// # Errors
/// A measurement fails.
pub fn body_elsewhere(extent: BenchExtent) -> Result<f64, Failure> {
    eprintln!("P7 bodies that are elsewhere ...");
    let times = if extent == BenchExtent::Tiny { 1 } else { TIMES };
    let computed = |other: &str| -> Result<(f64, usize), Failure> {
        let scene = [BLOCK, other].concat();
        let (mut least, mut bodies) = (f64::INFINITY, 0);
        for _ in 0..times {
            let task = BenchTask::Ranks(UNDIVIDED, 2);
            let found = Order { scene: scene.clone(), overrides: Vec::new(), threads: 1, task }.measure()?;
            let first = found.shares.first().copied().unwrap_or_default();
            (least, bodies) = (least.min(first.computed / steps_of(&first)), found.bodies);
        }
        Ok((least, bodies))
    };
    let ((with_few, few), (with_many, many)) = (computed(&strings_of_grains())?, computed(GRAINS)?);
    Ok(((with_many - with_few) / (many - few) as f64).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The other rank has the same particles in the same places, in fewer bodies or in more.
    #[test]
    fn strings_have_the_grains() {
        let parse =
            |other: &str| stickslip::scene::parse("bench", &[BLOCK, other].concat(), &[]).unwrap().scene;
        let [few, many] = [&*strings_of_grains(), GRAINS].map(parse);
        assert_eq!([few.bodies.len(), many.bodies.len()], [1 + 1024, 1 + 32_768]);
        let particles = [&few, &many].map(|scene| stickslip::check::report(scene).unwrap().particles);
        assert_eq!(particles, [2 * 32_768; 2]);
    }

    #[test]
    fn three_problems_are_shared() {
        for extent in [BenchExtent::Full, BenchExtent::Quick, BenchExtent::Tiny] {
            assert_eq!(
                problems(extent).iter().map(|case| case.problem).collect::<Vec<_>>(),
                ["P1", "P2", "P3"]
            );
        }
    }
}
