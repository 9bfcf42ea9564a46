//! M2: contact gives no node energy.

use super::bodies_at_node::{BODIES, BodyAtNode, meet};
use super::reasons::OWN_NORMALS;
use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target};
use crate::failure::CaseFailure;
use crate::outcome::Outcome;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "M2",
    title: "Energy at a node",
    source: "Second law: contact and friction of bodies that have not been strained yet can only take kinetic energy",
    picture: "
             \\   |   /
              \\  v  /       2 to 5 pieces of a ball
           ->  \\ | /  <-    meet at one node
                \\|/
",
    set_up: "The scenes of M1. Judged is the first step, in which no stress acts yet, so that what contact does to \
a node is all that happens to it.",
    exact: "The kinetic energy of a node's bodies is not larger than before contact. Measured is the largest gain \
at any node over the energy there before.",
    laws: Laws::All,
    measure: "R/h",
    resolutions: &[Resolution::quick(3.0), Resolution::full(6.0)],
    targets: &[
        Target::new(METRICS[0], 0.0, Allowed::AtMost(1e-12), ROUND_OFF),
        Target::new(METRICS[1], 0.0, Allowed::AtMost(1e-12), ROUND_OFF),
        Target::new(METRICS[2], 0.0, Allowed::AtMost(1e-12), ROUND_OFF),
        Target::new(METRICS[3], 0.0, Allowed::AtMost(1e-12), ROUND_OFF),
    ],
    reasons: &[OWN_NORMALS],
    run,
};

const METRICS: [&str; 4] = ["energy gained, 2 bodies", "3 bodies", "4 bodies", "5 bodies"];
const ROUND_OFF: &str = "round-off of some hundred sums of squares; a gain is never right";

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut outcome = Outcome::default();
    for (metric, bodies) in METRICS.into_iter().zip(BODIES) {
        let mut worst = f64::NEG_INFINITY;
        meet(case, (bodies, 1), &mut outcome, &mut |sides| {
            let before = kinetic(sides, BodyAtNode::free);
            worst = worst.max(kinetic(sides, |side| side.velocity) / before - 1.0);
        })?;
        outcome.measure(metric, worst);
    }
    Ok(outcome)
}

fn kinetic(sides: &[BodyAtNode], velocity: impl Fn(&BodyAtNode) -> [f64; 3]) -> f64 {
    sides.iter().map(|side| 0.5 * side.mass * velocity(side).iter().map(|v| v * v).sum::<f64>()).sum()
}
