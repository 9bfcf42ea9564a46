//! M1: contact of any number of bodies at a node keeps momentum.

use super::bodies_at_node::{BODIES, meet};
use super::reasons::OWN_NORMALS;
use crate::benchmark::{Allowed, Benchmark, Case, Laws, Resolution, Target};
use crate::failure::CaseFailure;
use crate::outcome::Outcome;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "M1",
    title: "Momentum at a node",
    source: "Newton's third law; the normals of Bardenhagen et al. (2001) keep it only where their eq. (16) holds",
    picture: "
             \\   |   /
              \\  v  /       2 to 5 pieces of a ball
           ->  \\ | /  <-    meet at one node
                \\|/
",
    set_up: "Plane strain and space; a ball of radius R cut into 2, 3, 4 or 5 pieces through an axis near a node, \
densities from 1 to 10, E = 1, nu = 0.3, which fly at the node from all sides at drawn velocities of about 0.02; mu \
= 0.3 and infinite; 25 steps. Eight draws of each (quick: one).",
    exact: "The impulses of contact on the bodies of a node add up to nothing. Measured is the largest sum at any \
node in any step, over the sum of the bodies' momenta there before contact.",
    laws: Laws::All,
    measure: "R/h",
    resolutions: &[Resolution::quick(3.0), Resolution::full(6.0)],
    targets: &[
        Target::new(METRICS[0], 0.0, Allowed::AtMost(1e-13), ROUND_OFF),
        Target::new(METRICS[1], 0.0, Allowed::AtMost(1e-13), ROUND_OFF),
        Target::new(METRICS[2], 0.0, Allowed::AtMost(1e-13), ROUND_OFF),
        Target::new(METRICS[3], 0.0, Allowed::AtMost(1e-13), ROUND_OFF),
    ],
    reasons: &[OWN_NORMALS],
    run,
};

const METRICS: [&str; 4] = ["momentum from nowhere, 2 bodies", "3 bodies", "4 bodies", "5 bodies"];
const ROUND_OFF: &str = "round-off of some hundred sums of impulses";

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut outcome = Outcome::default();
    for (metric, bodies) in METRICS.into_iter().zip(BODIES) {
        let mut worst = 0.0_f64;
        meet(case, (bodies, 25), &mut outcome, &mut |sides| {
            let mut sum = [0.0; 3];
            let mut scale = 0.0;
            for side in sides {
                (0..3).for_each(|i| sum[i] += side.impulse[i]);
                scale += side.mass * norm(side.free());
            }
            worst = worst.max(norm(sum) / scale);
        })?;
        outcome.measure(metric, worst);
    }
    Ok(outcome)
}

fn norm(a: [f64; 3]) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}
