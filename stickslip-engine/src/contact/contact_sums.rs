//! What contact did to each pair of bodies, summed over nodes and steps.

use super::BlockSums;
use super::spread::Spread;
use crate::boundary::Boundary;
use crate::door::{ContactPatch, ContactSum};
use crate::grid::Lattice;
use crate::tensor::{Real, Vector, cross};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// What two rigid bodies did to each other at a point in a step.
#[derive(Clone, Copy, Debug)]
pub struct RigidTouch {
    /// Indices of the bodies, the smaller first.
    pub bodies: [usize; 2],
    /// Impulse on the first along the normal [N s].
    pub push: [f64; 3],
    /// Impulse on the first across the normal [N s].
    pub rub: [f64; 3],
    /// That along the normal, positive where they push [N s].
    pub normal: f64,
    /// Where [m].
    pub place: [f64; 3],
    /// Work of friction [J].
    pub friction: f64,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct ImpulseSums {
    /// On the second body [N s].
    impulse: [f64; 3],
    normal: f64,
    tangential: [f64; 3],
    /// Magnitudes of the nodes' impulses, and with their places [N s, N s m].
    magnitude: f64,
    moment: [f64; 3],
    /// Where the grid repeats, the place of the block that was added last: the next one is that image which is nearest
    /// to it, so that a contact through a face is in one piece, and one that travels through it goes on [m].
    place: Option<[f64; 3]>,
    /// Of the impulse, about the origin [N m s].
    turn: [f64; 3],
    /// Work of friction [J].
    friction: f64,
    /// Way of slip, the mean over the area of each use [m].
    slip: f64,
    /// Impulses at nodes, and those of them that were reduced to the rule's largest strain.
    pushes: u64,
    reduced: u64,
    /// Area times duration [m^2 s], and with the gap [m^3 s].
    area: f64,
    gap: f64,
    /// The last use in which the pair touched.
    last_use: u64,
    last: Touching,
}

/// What a pair is like in one use of contact.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct Touching {
    /// For how long [s].
    duration: f64,
    nodes: usize,
    spread: Spread,
    /// Mirrors that the contact goes through, a bit each.
    mirrors: u32,
    /// Area times gap [m^3] and area times slip [m^3].
    gap: f64,
    slip: f64,
}

/// Impulses and works of contact since the start, by pair.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct ContactSums {
    /// Pairs that ever touched, in any order.
    pairs: Vec<TouchedPair>,
    /// Where each of them stands.
    #[serde(skip)]
    places: HashMap<[usize; 2], usize, BuildHasherDefault<Mixer>>,
    /// Those that are part of a use.
    present: Vec<usize>,
    uses: u64,
    /// Work that friction took from the bodies [J].
    pub friction: f64,
    /// How many impulses were reduced, so that no cell strains by more than its rule allows.
    pub scaled: u64,
    /// At how many nodes pairs had not come to rest when the last sweep over them was done.
    pub unsettled: u64,
    /// Work that bonds took from the bodies where they gave way [J].
    pub adhesion: f64,
    /// Work that rigid bodies' prescribed motion did on the others [J].
    pub work: f64,
}

/// Two bodies that touched.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct TouchedPair {
    bodies: [usize; 2],
    sum: ImpulseSums,
    /// Largest area over which they touched since the start, images in mirrors included, if they pushed.
    largest: Option<ContactPatch>,
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

impl ImpulseSums {
    /// Area times duration [m^2 s], and with the gap [m^3 s], with those of the last use.
    fn touched(&self) -> [f64; 2] {
        let Touching { duration, spread: Spread { area, .. }, gap, .. } = self.last;
        [self.area + area * duration, self.gap + gap * duration]
    }

    /// Way of slip with that of the last use [m].
    fn slipped(&self) -> f64 {
        let area = self.last.spread.area;
        if area > 0.0 { self.slip + self.last.slip / area } else { self.slip }
    }

    /// Closes the use before `next`, whose touching nodes are all known now.
    fn close(&mut self, next: u64) {
        if self.last_use != next {
            [self.area, self.gap] = self.touched();
            (self.slip, self.last_use, self.last) = (self.slipped(), next, Touching::default());
        }
    }
}

impl ContactSums {
    /// Sums that were saved, with where each pair stands.
    pub fn indexed(mut self) -> Self {
        self.places = self.pairs.iter().enumerate().map(|(place, pair)| (pair.bodies, place)).collect();
        self
    }

    /// Whether all bodies that they name are among so many.
    pub fn are_of(&self, bodies: usize) -> bool {
        self.pairs.iter().all(|pair| {
            let largest = pair.largest.iter().all(|patch| [patch.body_a, patch.body_b] == pair.bodies);
            pair.bodies[0] < pair.bodies[1] && pair.bodies[1] < bodies && largest
        }) && self.present.iter().all(|&place| place < self.pairs.len())
    }

    /// Adds what pairs did in one use of contact, ordered by pair and block; surfaces count as touching for `duration`
    /// [s]. Works of all pairs together are not among it.
    pub fn add<T: Real, const D: usize>(
        &mut self,
        touches: &[BlockSums],
        (lattice, boundary): (&Lattice<T, D>, &Boundary),
        duration: f64,
    ) {
        self.uses += 1;
        self.present.clear();
        for touch in touches {
            let place = self.place(touch.bodies);
            let sum = &mut self.pairs[place].sum;
            if touch.is_of_parted() {
                sum.friction += touch.friction;
                continue;
            }
            if sum.last_use != self.uses {
                sum.close(self.uses);
                sum.last.duration = duration;
                self.present.push(place);
            }
            let (touch, there) = touch.near(lattice, sum.place);
            if lattice.periods.any() {
                sum.place = Some(there);
            }
            sum.last.mirrors |= touch.mirrors;
            sum.last.spread.merge(&touch.spread);
            sum.last.gap += touch.gap;
            sum.last.slip += touch.slip;
            sum.last.nodes += touch.nodes as usize;
            for i in 0..3 {
                sum.turn[i] += touch.turn[i];
                sum.tangential[i] += touch.tangential[i];
                sum.impulse[i] += touch.impulse[i];
                sum.moment[i] += touch.moment[i];
            }
            sum.magnitude += touch.magnitude;
            sum.normal += touch.normal;
            sum.friction += touch.friction;
            (sum.pushes, sum.reduced) = (sum.pushes + touch.nodes, sum.reduced + touch.reduced);
        }
        for &place in &self.present {
            let TouchedPair { bodies: [body_a, body_b], sum: ImpulseSums { last, .. }, largest, .. } =
                &mut self.pairs[place];
            let images = f64::from(1_u32 << last.mirrors.count_ones());
            let wider = largest.is_none_or(|patch| last.spread.area * images > patch.area);
            if last.nodes > 0 && wider {
                let through = |i: usize| last.mirrors >> i & 1 == 1;
                let mirrors = boundary.walls.iter().enumerate().filter(|(i, _)| through(*i));
                let whole = mirrors.fold(last.spread, |spread, (_, wall)| {
                    spread.with_image(wall.axis, lattice.position([wall.node; D])[wall.axis].f64())
                });
                let area = whole.area;
                let half_width = if D == 2 { 0.5 * area } else { whole.half_width(lattice.cell.f64()) };
                let (body_a, body_b) = (*body_a, *body_b);
                *largest = Some(ContactPatch { body_a, body_b, area, half_width, impulse: 0.0 });
            }
        }
    }

    /// Counts the impulses of a use that enters no sum, and how many of them were reduced.
    pub fn count(&mut self, touches: &[BlockSums]) {
        for touch in touches {
            if let Some(&place) = self.places.get(&touch.bodies) {
                let sum = &mut self.pairs[place].sum;
                (sum.pushes, sum.reduced) = (sum.pushes + touch.nodes, sum.reduced + touch.reduced);
            }
        }
    }

    /// Adds what two rigid bodies did to each other at a point in a step of `duration` [s]; points have no area.
    pub fn touch(&mut self, touch: &RigidTouch, duration: f64) {
        let RigidTouch { bodies, push, rub, normal, place, friction } = touch;
        let pair = self.place(*bodies);
        let sum = &mut self.pairs[pair].sum;
        if sum.last_use != self.uses {
            sum.close(self.uses);
            sum.last.duration = duration;
        }
        sum.last.nodes += 1;
        let (push, rub) = (Vector(*push), Vector(*rub));
        let magnitude = (push + rub).norm();
        sum.magnitude += magnitude;
        sum.normal += normal;
        sum.tangential = (Vector(sum.tangential) + rub).0;
        sum.impulse = (Vector(sum.impulse) - push - rub).0;
        sum.moment = (Vector(sum.moment) + Vector(*place) * magnitude).0;
        sum.turn = (Vector(sum.turn) - Vector(cross(*place, (push + rub).0))).0;
        sum.friction += friction;
    }

    /// Keeps the pairs that are wanted.
    pub fn keep(&mut self, wanted: impl Fn([usize; 2]) -> bool) {
        let mut all = std::mem::take(self);
        all.pairs.retain(|pair| wanted(pair.bodies));
        *self = all.in_order().indexed();
    }

    /// The sums of pairs that several keep, and what else the first one knows as all of them do.
    pub fn merged(all: Vec<Self>) -> Self {
        let mut all = all.into_iter();
        let mut first = all.next().unwrap_or_default();
        first.pairs.extend(all.flat_map(|other| other.pairs));
        first.in_order()
    }

    /// With its pairs in the order of their bodies, as they are saved: [`ContactSums::indexed`] makes them found again.
    pub fn in_order(mut self) -> Self {
        self.pairs.sort_unstable_by_key(|pair| pair.bodies);
        self.present.clear();
        self
    }

    /// Where a pair stands, from now on if not before.
    fn place(&mut self, bodies: [usize; 2]) -> usize {
        let ContactSums { pairs, places, .. } = self;
        *places.entry(bodies).or_insert_with(|| {
            pairs.push(TouchedPair { bodies, sum: ImpulseSums::default(), largest: None });
            pairs.len() - 1
        })
    }

    /// Those of all pairs that something is known of, ordered by pair.
    fn ordered<X>(&self, known: impl Fn(&TouchedPair) -> Option<X>) -> Vec<X> {
        let mut all: Vec<_> =
            self.pairs.iter().filter_map(|pair| known(pair).map(|x| (pair.bodies, x))).collect();
        all.sort_unstable_by_key(|(bodies, _)| *bodies);
        all.into_iter().map(|(_, x)| x).collect()
    }

    /// What contact did since the start, of pairs whose surfaces touched, ordered by pair.
    pub fn sums(&self) -> Vec<ContactSum> {
        self.ordered(|TouchedPair { bodies, sum, .. }| {
            let [area, gap] = sum.touched();
            Some(ContactSum {
                bodies: *bodies,
                impulse: sum.impulse,
                normal: sum.normal,
                tangential: sum.tangential,
                magnitude: sum.magnitude,
                moment: sum.moment,
                turn: sum.turn,
                area,
                gap,
                slip: sum.slipped(),
                friction: sum.friction,
                nodes: sum.last.nodes,
                pushes: sum.pushes,
                reduced: sum.reduced,
            })
        })
    }

    /// The largest area over which each pair touched since the start, ordered by pair, and what the pair bore.
    pub fn patches(&self) -> Vec<ContactPatch> {
        self.ordered(|pair| pair.largest.map(|patch| ContactPatch { impulse: pair.sum.magnitude, ..patch }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::boundary::Wall;
    use crate::contact::{Change, Impulse, Span};
    use crate::scene::Face;
    use crate::tensor::Vector;

    fn pushing<const D: usize>(node: [i32; D]) -> Impulse<f64, D> {
        let push = Vector::from_fn(|i| if i == D - 1 { 1.0 } else { 0.0 });
        Impulse {
            bodies: [0, 1],
            nodes: [0, 1],
            node,
            gap: -0.2,
            area: 0.5,
            slip: 0.0,
            change: Change { impulse: [push, -push], normal: -1.0, ..Change::NONE },
            velocity: [Vector::ZERO; 2],
            span: Span::WholeStep,
            work: 0.0,
        }
    }

    /// Adds the impulses of one use of contact.
    fn add<const D: usize>(
        sums: &mut ContactSums,
        impulses: &[Impulse<f64, D>],
        place: (&Lattice<f64, D>, &Boundary),
        duration: f64,
    ) {
        let mut touches = Vec::new();
        BlockSums::list(&mut touches, impulses.iter(), place, |_| [0.0; 2]);
        sums.add(&touches, place, duration);
    }

    /// Two nodes of 0.5 m touch for a quarter of the time: mean force and mean area have the pressure of that quarter.
    /// The first use of a step counts for no time.
    #[test]
    fn area_and_gap_are_means_over_time() {
        let (mut contact_sums, lattice) = (ContactSums::default(), Lattice::new(Vector::ZERO, 0.5));
        let nodes = [pushing([3, 0]), pushing([4, 0])];
        add(&mut contact_sums, &nodes, (&lattice, &Boundary::default()), 0.0);
        add(&mut contact_sums, &nodes, (&lattice, &Boundary::default()), 0.1);
        add(&mut contact_sums, &[], (&lattice, &Boundary::default()), 0.3);
        let found = &contact_sums.sums()[0];
        assert!((found.area - 0.1).abs() < 1e-15 && (found.gap + 0.01).abs() < 1e-15, "{found:?}");
        assert_eq!(contact_sums.patches()[0].area, 1.0);
    }

    /// Surfaces that touch and do not push are in the sums: else the first mean with a push would begin with all that
    /// went before.
    #[test]
    fn surfaces_that_only_touch_are_summed() {
        let (mut sums, lattice) = (ContactSums::default(), Lattice::new(Vector::ZERO, 0.5));
        let near = Impulse { change: Change::NONE, ..pushing([3, 0]) };
        add(&mut sums, &[near], (&lattice, &Boundary::default()), 0.1);
        let found = sums.sums();
        assert!(found.len() == 1 && found[0].area > 0.0 && found[0].magnitude == 0.0, "{found:?}");
    }

    /// On the mirror half a node's surface is the image's, and the patch is twice what is before the mirror.
    #[test]
    fn a_patch_goes_on_behind_the_mirror() {
        let (mut contact_sums, lattice) = (ContactSums::default(), Lattice::new(Vector::ZERO, 0.5));
        let mirror = Wall { axis: 0, node: 3, inward: 1, face: Face::Symmetry };
        let boundary = Boundary::new(vec![mirror]);
        add(&mut contact_sums, &[pushing([3, 0]), pushing([4, 0])], (&lattice, &boundary), 1.0);
        assert_eq!((contact_sums.sums()[0].area, contact_sums.patches()[0].area), (0.75, 1.5));
        let (mut aside, far) = (ContactSums::default(), pushing([4, 0]));
        add(&mut aside, &[far], (&lattice, &boundary), 1.0);
        assert_eq!(aside.patches()[0].area, 0.5);
    }

    /// A strip of 41 nodes by 4, or its half with a mirror across its length.
    #[test]
    fn a_strip_is_as_wide_by_its_half_and_a_mirror() {
        let lattice = Lattice::new(Vector::ZERO, 0.5);
        let patch = |first: i32, boundary: &Boundary| {
            let row = |y: i32| (first..=23).map(move |x| Impulse { area: 0.25, ..pushing([x, y, 0]) });
            let nodes: Vec<_> = (0..4).flat_map(row).collect();
            let mut contact_sums = ContactSums::default();
            add(&mut contact_sums, &nodes, (&lattice, boundary), 1.0);
            contact_sums.patches()[0]
        };
        let mirror = Wall { axis: 0, node: 3, inward: 1, face: Face::Symmetry };
        let [whole, half] = [patch(-17, &Boundary::default()), patch(3, &Boundary::new(vec![mirror]))];
        assert!((whole.area - 41.0).abs() < 1e-12 && (half.area - 41.0).abs() < 1e-12);
        assert!((half.half_width / whole.half_width - 1.0).abs() < 1e-12, "{half:?} {whole:?}");
        assert!((whole.half_width - 1.1).abs() < 0.05, "{whole:?}");
    }
}
