//! What contact did to each pair of bodies, summed over nodes and steps.

use super::Impulse;
use crate::door::ContactState;
use crate::tensor::Real;
use std::collections::BTreeMap;

#[derive(Clone, Debug, Default)]
struct Sum {
    /// On the second body [N s].
    impulse: [f64; 3],
    normal: f64,
    tangential: [f64; 3],
    nodes: usize,
    last_use: u64,
}

/// Impulses by pair since the last look, and works since the start.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    pairs: BTreeMap<[usize; 2], Sum>,
    since: f64,
    /// What was taken last.
    taken: Vec<ContactState>,
    uses: u64,
    /// Work that friction took from the bodies [J].
    pub friction: f64,
    /// Work that rigid bodies' prescribed motion did on the others [J].
    pub work: f64,
}

impl Tally {
    /// Adds the impulses of one use of contact.
    pub fn add<T: Real, const D: usize>(&mut self, impulses: &[Impulse<T, D>]) {
        self.uses += 1;
        for impulse in impulses {
            let [on_a, on_b] = impulse.change.impulse.map(|j| j.space());
            if on_a == [0.0; 3] && on_b == [0.0; 3] {
                continue;
            }
            let sum = self.pairs.entry(impulse.bodies).or_default();
            if sum.last_use != self.uses {
                (sum.last_use, sum.nodes) = (self.uses, 0);
            }
            sum.nodes += 1;
            let tangential = impulse.change.tangential.space();
            for i in 0..3 {
                sum.tangential[i] += tangential[i];
                // The paper's own normals give impulses that are not quite opposite; the force is their mean.
                sum.impulse[i] += 0.5 * (on_b[i] - on_a[i]);
            }
            sum.normal -= impulse.change.normal.f64();
            self.friction += impulse.friction.f64();
            self.work += impulse.work.f64();
        }
    }

    /// The mean forces between the last call and time `now` [s], ordered by pair.
    pub fn take(&mut self, now: f64) -> Vec<ContactState> {
        if now > self.since {
            self.taken = self.means(now);
        } else {
            self.taken.clear();
        }
        self.since = now;
        self.pairs.clear();
        self.taken.clone()
    }

    /// What [`Tally::take`] would give, or gave at this very time.
    pub fn look(&self, now: f64) -> Vec<ContactState> {
        if now > self.since { self.means(now) } else { self.taken.clone() }
    }

    fn means(&self, now: f64) -> Vec<ContactState> {
        let elapsed = now - self.since;
        (self.pairs.iter())
            .map(|(&[body_a, body_b], sum)| ContactState {
                body_a,
                body_b,
                force: sum.impulse.map(|j| j / elapsed),
                normal: sum.normal / elapsed,
                tangential: sum.tangential.iter().map(|j| j * j).sum::<f64>().sqrt() / elapsed,
                nodes: sum.nodes,
            })
            .collect()
    }
}
