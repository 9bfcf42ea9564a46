//! Where bodies meet, and what the particles there say of their surfaces.

use super::law::law;
use super::surroundings::{Nodes, Sums, nodes_where};
use super::{Pair, Rules, Step, Surface};
use crate::basis::Basis;
use crate::body::Body;
use crate::boundary::Boundary;
use crate::grid::{Cover, Field, Lattice, Meeting, SIDE, node_at, nodes_per_block};
use crate::scene::{ContactLaw, Face};
use crate::tensor::{Matrix, Real, Vector};
use rayon::prelude::*;
use std::ops::Range;

/// A node that two or more bodies share.
#[derive(Clone, Debug)]
pub struct Site<const D: usize> {
    /// The node.
    pub node: [i32; D],
    /// Its bodies, in [`Survey::sides`].
    pub sides: Range<usize>,
    /// Its pairs, in [`Survey::encounters`].
    pub encounters: Range<usize>,
}

/// One body's share of a site.
#[derive(Clone, Copy, Debug)]
pub struct Side<T, const D: usize> {
    /// Index of the body.
    pub body: usize,
    /// Its node in the field.
    pub index: usize,
    /// Its surface there.
    pub surface: Surface<T, D>,
    /// Gradient of its volume, into the body [m^2].
    pub volume_gradient: Vector<T, D>,
}

/// How two bodies face each other at a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facing<T, const D: usize> {
    /// Common normal from the first to the second [-].
    pub normal: Option<Vector<T, D>>,
    /// Distance between their surfaces, negative where they overlap [cells].
    pub gap: T,
}

/// What a law may look at to tell how two bodies face each other.
pub struct Look<'a, T, const D: usize> {
    /// Everything near.
    pub near: &'a Near<'a, T, D>,
    /// All bodies at the node.
    pub sides: &'a [Side<T, D>],
    /// The two among them.
    pub pair: [usize; 2],
    /// The node.
    pub node: [i32; D],
}

/// Two sides of a site.
#[derive(Clone, Copy, Debug)]
pub struct Encounter<T, const D: usize> {
    /// The two sides, in [`Survey::sides`].
    pub sides: [usize; 2],
    /// Number of the pair's rule.
    pub rule: usize,
    pub(super) facing: Facing<T, D>,
    /// The node's share of the contact area [m^2], in the plane per depth [m].
    pub(super) area: T,
}

/// All sites of a step.
#[derive(Clone, Debug)]
pub struct Survey<T, const D: usize> {
    /// Nodes that two or more bodies share.
    pub sites: Vec<Site<D>>,
    /// Bodies at the sites.
    pub sides: Vec<Side<T, D>>,
    /// Pairs at the sites.
    pub encounters: Vec<Encounter<T, D>>,
}

impl<T, const D: usize> Default for Survey<T, D> {
    fn default() -> Self {
        Survey { sites: Vec::new(), sides: Vec::new(), encounters: Vec::new() }
    }
}

/// Mass below this fraction of a full cell's does not make a node shared: that of a particle which reaches into the node's
/// surroundings by round-off of a cell. More would leave parts of a glued body that stick out by less to themselves.
fn trace<T: Real>() -> T {
    T::EPSILON * T::EPSILON
}

/// What a survey looks at.
pub struct Near<'a, T, const D: usize> {
    /// The blocks.
    pub cover: &'a Cover<D>,
    /// The bodies.
    pub bodies: &'a [Body<T, D>],
    /// The field, scattered.
    pub field: &'a Field<T, D>,
    /// Where the nodes are.
    pub lattice: Lattice<T, D>,
    /// The walls.
    pub boundary: &'a Boundary,
    /// Which law holds for which pair.
    pub rules: &'a Rules<T>,
}

impl<T: Real, const D: usize> Near<'_, T, D> {
    /// Surveys every node that two or more bodies share.
    pub fn survey<B: Basis<T>>(&self) -> Survey<T, D> {
        let parts: Vec<Survey<T, D>> = (self.cover.meetings.par_chunks(8))
            .map_init(Vec::new, |sums, meetings| {
                let mut part = Survey::default();
                meetings.iter().for_each(|meeting| self.survey_block::<B>(meeting, sums, &mut part));
                part
            })
            .collect();
        let mut whole = Survey::default();
        for part in parts {
            let (sides, encounters) = (whole.sides.len(), whole.encounters.len());
            whole.sides.extend(part.sides);
            whole.encounters.extend(
                part.encounters.into_iter().map(|e| Encounter { sides: e.sides.map(|s| s + sides), ..e }),
            );
            whole.sites.extend(part.sites.into_iter().map(|site| Site {
                node: site.node,
                sides: site.sides.start + sides..site.sides.end + sides,
                encounters: site.encounters.start + encounters..site.encounters.end + encounters,
            }));
        }
        whole
    }

    /// h^D [m^3]
    fn cell_volume(&self) -> T {
        (0..D).fold(T::ONE, |v, _| v * self.lattice.cell)
    }

    fn survey_block<B: Basis<T>>(
        &self,
        meeting: &Meeting<D>,
        sums: &mut Vec<Sums<T, D>>,
        survey: &mut Survey<T, D>,
    ) {
        let (n, slots) = (nodes_per_block(D), self.cover.slots_of(meeting));
        let body = |slot: u32| self.cover.slots[slot as usize].0 as usize;
        let trace = trace::<T>() * self.cell_volume();
        let present: Vec<Nodes> = (slots.iter())
            .map(|&slot| {
                let least = trace * self.bodies[body(slot)].density;
                nodes_where::<D>(|local| self.field.nodes[slot as usize * n + local].mass > least)
            })
            .collect();
        let governed = nodes_where::<D>(|local| self.governed(node_at(meeting.block, local)));
        let pairs: Vec<[usize; 3]> = self.pairs(slots).collect();
        let shared = (pairs.iter()).fold(0, |nodes, &[a, b, _]| nodes | present[a] & present[b]) & !governed;
        if shared == 0 {
            return;
        }
        sums.clear();
        sums.resize(slots.len() * n, Sums::EMPTY);
        for ((&slot, present), sums) in slots.iter().zip(&present).zip(sums.chunks_mut(n)) {
            self.sum_around::<B>((body(slot), meeting.block), present & shared, sums);
        }
        // Where each body of the block stands among the sides of a node.
        let mut seats = vec![None; slots.len()];
        for local in (0..n).filter(|local| shared >> local & 1 == 1) {
            let node = node_at(meeting.block, local);
            let first = survey.sides.len();
            for (i, &slot) in slots.iter().enumerate() {
                let here = present[i] >> local & 1 == 1;
                seats[i] = here.then_some(survey.sides.len());
                if here {
                    let index = slot as usize * n + local;
                    survey.sides.push(self.side(index, node, &sums[i * n + local]));
                }
            }
            let start = survey.encounters.len();
            for &[a, b, rule] in &pairs {
                if let (Some(a), Some(b)) = (seats[a], seats[b]) {
                    let pair = [a - first, b - first];
                    let look = Look { near: self, sides: &survey.sides[first..], pair, node };
                    let facing = law(self.rules.rule(rule).law).facing(&look);
                    let area = area(&look, &facing);
                    survey.encounters.push(Encounter { sides: [a, b], rule, facing, area });
                }
            }
            survey.sites.push(Site {
                node,
                sides: first..survey.sides.len(),
                encounters: start..survey.encounters.len(),
            });
        }
    }

    /// Whether a wall decides what a node does.
    fn governed(&self, node: [i32; D]) -> bool {
        self.boundary.walls.iter().any(|wall| match wall.face {
            Face::Fixed => wall.depth(node) <= 0,
            _ => wall.depth(node) < 0,
        })
    }

    /// Places in `slots` of two bodies that may touch, and the number of their rule.
    fn pairs(&self, slots: &[u32]) -> impl Iterator<Item = [usize; 3]> {
        let body = |place: usize| self.cover.slots[slots[place] as usize].0 as usize;
        let places = (0..slots.len()).flat_map(move |a| (a + 1..slots.len()).map(move |b| [a, b]));
        places.filter_map(move |[a, b]| {
            let bodies = [body(a), body(b)];
            let rule = self.rules.number(bodies[0], bodies[1]);
            let rigid = bodies.map(|body| self.bodies[body].rigid);
            let touch = self.rules.rule(rule).law != ContactLaw::None && rigid != [true; 2];
            touch.then_some([a, b, rule])
        })
    }

    fn side(&self, index: usize, node: [i32; D], sums: &Sums<T, D>) -> Side<T, D> {
        let body = self.cover.slots[index / nodes_per_block(D)].0 as usize;
        let owner = &self.bodies[body];
        let arm = Vector::from_fn(|i| T::of(f64::from(node[i].rem_euclid(SIDE))) * self.lattice.cell);
        let mass = self.field.nodes[index].mass;
        let surface = Surface {
            inverse_mass: if owner.rigid { T::ZERO } else { T::ONE / mass },
            normal: (-sums.mass_gradient).direction(),
            stress: sums.stress * (T::ONE / sums.volume),
            volume: sums.volume,
            modulus: owner.wave_modulus(&Matrix::IDENTITY, T::ONE),
            // A node on a mirror carries its half of the mass, and so of the force.
            force: sums.force * (mass / sums.mass),
            place: sums.place.over(sums.volume).seen_from(arm),
        };
        Side { body, index, surface, volume_gradient: sums.volume_gradient }
    }
}

/// Normal along the difference of the volume gradients, and the gap from the room that the bodies leave around the node [cells].
///
/// ```text
/// gap / h = 1 - sum_a V_a / h^D,   V_a = sum_p V_p S_i(x_p)
/// ```
/// Where material fills space without a gap, the volumes interpolated to a node are a whole cell; a thin gap through the node
/// takes its width times h^(D-1) from that. Overlap is negative. Needs no normal, and stairs of the particles' lattice
/// average out. All bodies that touch either of the two count. A surface of radius R seems h^2/(6R) further away than its nearest point.
pub fn room<T: Real, const D: usize>(look: &Look<T, D>) -> Facing<T, D> {
    let Look { near, sides, pair, .. } = look;
    let touches = |a: &Side<T, D>, b: &Side<T, D>| {
        near.rules.rule(near.rules.number(a.body, b.body)).law != ContactLaw::None
    };
    let counts = |(i, side): &(usize, &Side<T, D>)| {
        pair.contains(i) || pair.iter().any(|&of_pair| touches(side, &sides[of_pair]))
    };
    let volumes = sides.iter().enumerate().filter(counts).map(|(_, side)| side.surface.volume);
    let [a, b] = pair.map(|side| sides[side].volume_gradient);
    Facing { normal: (b - a).direction(), gap: T::ONE - volumes.sum::<T>() / near.cell_volume() }
}

/// A node's share of the area over which a pair faces each other [m^2].
///
/// ```text
/// integral of S_i n dA over a body's surface = integral of grad S_i dV = -sum_p V_p grad S_i(x_p)
/// ```
/// by the divergence theorem, so the volume gradient along the normal is the surface that the node sees; the pair shares the smaller
/// of the two. Summed over nodes it is the whole area, as the functions S_i sum to one.
fn area<T: Real, const D: usize>(look: &Look<T, D>, facing: &Facing<T, D>) -> T {
    let Some(normal) = facing.normal else { return T::ZERO };
    let [a, b] = look.pair.map(|side| look.sides[side].volume_gradient.dot(normal));
    (-a).min(b).max(T::ZERO)
}

impl<T: Real, const D: usize> Survey<T, D> {
    /// The pair of an encounter.
    pub fn pair<'a>(
        &'a self,
        encounter: &Encounter<T, D>,
        rules: &'a Rules<T>,
        step: Step<T>,
    ) -> Pair<'a, T, D> {
        let [a, b] = encounter.sides.map(|side| &self.sides[side]);
        let rule = rules.rule(encounter.rule);
        Pair {
            rule,
            surfaces: [&a.surface, &b.surface],
            normal: encounter.facing.normal,
            gap: encounter.facing.gap,
            area: encounter.area,
            step,
        }
    }
}
