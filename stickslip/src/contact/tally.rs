//! What contact did to each pair of bodies, summed over nodes and steps.

use super::Impulse;
use crate::door::{ContactState, Patch};
use crate::grid::Lattice;
use crate::tensor::Real;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

#[derive(Clone, Debug, Default)]
struct Sum {
    /// On the second body [N s].
    impulse: [f64; 3],
    normal: f64,
    tangential: [f64; 3],
    /// Magnitudes of the nodes' impulses, and with their places [N s, N s m].
    magnitude: f64,
    moment: [f64; 3],
    /// Work of friction since the last look [J].
    friction: f64,
    /// Way of slip, the mean over the area of each use [m].
    slip: f64,
    /// The last use in which the pair touched.
    last_use: u64,
    last: Touching,
}

/// What a pair is like in one use of contact.
#[derive(Clone, Copy, Debug, Default)]
struct Touching {
    nodes: usize,
    /// [m^2]
    area: f64,
    /// Area times gap [m^3] and area times slip [m^3].
    gap: f64,
    slip: f64,
}

/// Surfaces closer than this are part of the area over which bodies touch, pushing in this step or not: single nodes push by turns [cells].
const CLOSE: f64 = 0.01;

/// Impulses by pair since the last look, and works since the start.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Pairs that ever touched, in the order in which they first did.
    pairs: Vec<Touched>,
    /// Where each of them stands.
    places: HashMap<[usize; 2], usize, BuildHasherDefault<Mixer>>,
    /// Those that are part of a use.
    present: Vec<usize>,
    since: f64,
    /// What was taken last.
    taken: Vec<ContactState>,
    uses: u64,
    /// Work that friction took from the bodies [J].
    pub friction: f64,
    /// How many impulses were reduced, so that no cell strains by more than its rule allows.
    pub scaled: u64,
    /// Work that rigid bodies' prescribed motion did on the others [J].
    pub work: f64,
}

/// Two bodies that touched.
#[derive(Clone, Debug)]
struct Touched {
    bodies: [usize; 2],
    sum: Sum,
    /// Largest area over which they touched since the start [m^2], if they pushed.
    largest: Option<f64>,
}

/// Mixes the numbers of two bodies: nobody chooses them to collide.
#[derive(Clone, Debug, Default)]
struct Mixer(u64);

impl Hasher for Mixer {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for bytes in bytes.chunks(8) {
            let mut number = [0; 8];
            number[..bytes.len()].copy_from_slice(bytes);
            // The golden ratio in fixed point spreads every bit over those above it.
            let mixed = self.0.rotate_left(32) ^ u64::from_le_bytes(number);
            self.0 = mixed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        }
    }
}

impl Sum {
    /// Way of slip with that of the last use [m].
    fn slipped(&self) -> f64 {
        if self.last.area > 0.0 { self.slip + self.last.slip / self.last.area } else { self.slip }
    }

    /// Closes the use before `next`, whose touching nodes are all known now.
    fn close(&mut self, next: u64) {
        if self.last_use != next {
            (self.slip, self.last_use, self.last) = (self.slipped(), next, Touching::default());
        }
    }
}

impl Tally {
    /// Adds the impulses of one use of contact.
    pub fn add<'a, T: Real, const D: usize>(
        &mut self,
        impulses: impl Iterator<Item = &'a Impulse<T, D>>,
        lattice: &Lattice<T, D>,
    ) {
        self.uses += 1;
        self.present.clear();
        let mut last: Option<([usize; 2], usize)> = None;
        for impulse in impulses {
            let [on_a, on_b] = impulse.change.impulse.map(|j| j.space());
            let pushes = on_a != [0.0; 3] || on_b != [0.0; 3];
            if !pushes && impulse.gap > T::of(CLOSE) {
                continue;
            }
            // Pairs follow one another at the nodes of a block.
            let place = match last {
                Some((bodies, place)) if bodies == impulse.bodies => place,
                _ => self.place(impulse.bodies),
            };
            last = Some((impulse.bodies, place));
            let sum = &mut self.pairs[place].sum;
            if sum.last_use != self.uses {
                sum.close(self.uses);
                self.present.push(place);
            }
            let area = impulse.area.f64();
            sum.last.area += area;
            sum.last.gap += area * (impulse.gap * lattice.cell).f64();
            sum.last.slip += area * impulse.slip.f64();
            if !pushes {
                continue;
            }
            sum.last.nodes += 1;
            let (place, tangential) =
                (lattice.position(impulse.node).space(), impulse.change.tangential.space());
            let magnitude =
                impulse.change.impulse[0].norm().f64().max(impulse.change.impulse[1].norm().f64());
            sum.magnitude += magnitude;
            for i in 0..3 {
                sum.tangential[i] += tangential[i];
                // The paper's own normals give impulses that are not quite opposite; the force is their mean.
                sum.impulse[i] += 0.5 * (on_b[i] - on_a[i]);
                sum.moment[i] += magnitude * place[i];
            }
            sum.normal -= impulse.change.normal.f64();
            sum.friction += impulse.friction.f64();
            self.scaled += u64::from(impulse.change.scale < T::ONE);
            self.friction += impulse.friction.f64();
            self.work += impulse.work.f64();
        }
        for &place in &self.present {
            let Touched { sum, largest, .. } = &mut self.pairs[place];
            if sum.last.nodes > 0 {
                *largest = Some(largest.unwrap_or_default().max(sum.last.area));
            }
        }
    }

    /// Where a pair stands, from now on if not before.
    fn place(&mut self, bodies: [usize; 2]) -> usize {
        let Tally { pairs, places, .. } = self;
        *places.entry(bodies).or_insert_with(|| {
            pairs.push(Touched { bodies, sum: Sum::default(), largest: None });
            pairs.len() - 1
        })
    }

    /// Those of all pairs that something is known of, ordered by pair.
    fn ordered<X>(&self, known: impl Fn(&Touched) -> Option<X>) -> Vec<X> {
        let mut all: Vec<_> =
            self.pairs.iter().filter_map(|pair| known(pair).map(|x| (pair.bodies, x))).collect();
        all.sort_unstable_by_key(|(bodies, _)| *bodies);
        all.into_iter().map(|(_, x)| x).collect()
    }

    /// The mean forces between the last call and time `now` [s], ordered by pair.
    pub fn take(&mut self, now: f64) -> Vec<ContactState> {
        if now > self.since {
            self.taken = self.means(now);
        } else {
            self.taken.clear();
        }
        self.since = now;
        self.pairs.iter_mut().for_each(|pair| pair.sum = Sum::default());
        self.taken.clone()
    }

    /// What [`Tally::take`] would give, or gave at this very time.
    pub fn look(&self, now: f64) -> Vec<ContactState> {
        if now > self.since { self.means(now) } else { self.taken.clone() }
    }

    fn means(&self, now: f64) -> Vec<ContactState> {
        let elapsed = now - self.since;
        self.ordered(|Touched { bodies: [body_a, body_b], sum, .. }| {
            (sum.magnitude > 0.0).then(|| ContactState {
                body_a: *body_a,
                body_b: *body_b,
                force: sum.impulse.map(|j| j / elapsed),
                normal: sum.normal / elapsed,
                tangential: sum.tangential.iter().map(|j| j * j).sum::<f64>().sqrt() / elapsed,
                nodes: sum.last.nodes,
                position: sum.moment.map(|x| x / sum.magnitude),
                area: sum.last.area,
                gap: if sum.last.area > 0.0 { sum.last.gap / sum.last.area } else { 0.0 },
                slip: sum.slipped(),
                friction: sum.friction,
            })
        })
    }

    /// The largest area over which each pair touched since the start, ordered by pair.
    pub fn patches(&self) -> Vec<Patch> {
        self.ordered(|Touched { bodies: [body_a, body_b], largest, .. }| {
            largest.map(|area| Patch { body_a: *body_a, body_b: *body_b, area })
        })
    }
}
