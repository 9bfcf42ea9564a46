//! Springs and dashpots between parts of bodies.
//!
//! A spring acts on the mean place of the points of each of its parts ([`crate::load`] says how points move with
//! nodes), along the line between the two. Its force falls while the parts move within the step:
//!
//! ```text
//! f = -(k (l - l_0) + c dl/dt) / (1 + dt (dt k + c) / m)          1/m = sum_i |g_i|^2 / m_i
//! v_i += dt f g_i / m_i,   g_i = +-e sum_s (a_s/a) N_is           a_s: area of a point, a: of all of a part
//! ```
//! with dl/dt as all other forces leave it, and for rigid bodies what they yield at the point. So the step stays stable
//! and as long as it was, however stiff a spring. One spring follows another.

use super::Engine;
use super::loads::{NOWHERE, find, find_carriers, mirror};
use crate::basis::Basis;
use crate::exact::ExactSum;
use crate::grid::{node_at, nodes_per_block};
use crate::lanes::Laned;
use crate::load::{SpringPoints, nodes_of, place_of};
use crate::part::{PartPoint, PartPoints};
use crate::tensor::Vector;
use std::time::Instant;

/// The nodes that move a part, each with g_i.
type PartNodes<T, const D: usize> = Vec<(u32, Vector<T, D>)>;

/// Room for springs in a step.
#[derive(Clone, Debug)]
pub struct SpringRoom<T, const D: usize> {
    /// Place in memory of the particles of each body at which springs end, by number.
    places: Vec<Vec<u32>>,
    springs: Vec<SpringStep>,
    /// Nodes of the parts of one spring, with g_i.
    nodes: [PartNodes<T, D>; 2],
}

/// What a spring does in a step.
#[derive(Clone, Copy, Debug, Default)]
struct SpringStep {
    /// e, from the second part to the first.
    direction: [f64; 3],
    /// f [N]
    force: f64,
    /// k as the step feels it [N/m].
    stiffness: f64,
    /// How far prescribed ends move along e in the step: by so much the length grows with no work on what is free [m].
    driven: f64,
    /// By how much the length has grown since the step began where the force is taken [m].
    gone: f64,
}

impl<T, const D: usize> Default for SpringRoom<T, D> {
    fn default() -> Self {
        SpringRoom { places: Vec::new(), springs: Vec::new(), nodes: [Vec::new(), Vec::new()] }
    }
}

impl<T: Laned, const D: usize, B: Basis<T>> Engine<T, D, B> {
    /// Springs pull at the velocities that all other forces give to nodes and free rigid bodies. Where particles are to
    /// move yet by the velocities that strained them, `ahead` is how long [s].
    pub(super) fn pull_springs(&mut self, dt: T, ahead: Option<T>) {
        if self.settings.springs.is_empty() {
            return;
        }
        let start = Instant::now();
        let (dt, ahead) = (dt.f64(), ahead.unwrap_or(T::ZERO));
        self.find_spring_carriers();
        let mut room = std::mem::take(&mut self.workspace.springs);
        room.springs.resize(self.settings.springs.len(), SpringStep::default());
        for i in 0..self.settings.springs.len() {
            room.springs[i] = self.pull(i, (dt, ahead), (&room.places, &mut room.nodes));
        }
        self.workspace.springs = room;
        self.watch.lap("springs", start);
    }

    fn pull(
        &mut self,
        number: usize,
        (dt, ahead): (f64, T),
        (places, nodes): (&[Vec<u32>], &mut [PartNodes<T, D>; 2]),
    ) -> SpringStep {
        let spring = &self.settings.springs[number];
        let Some(centers) = self.centers(spring, places) else { return SpringStep::default() };
        let apart = Vector(std::array::from_fn(|i| centers[0][i] - centers[1][i]));
        let Some(direction) = apart.direction() else { return SpringStep::default() };
        let (mut rate, mut yields, mut driven) = (0.0, 0.0, 0.0);
        // Of the nodes: of each that several ranks have, one.
        let mut sums = [0; 3].map(|_| ExactSum::default());
        for side in 0..2 {
            let end = &spring.ends[side];
            let along = direction * if side == 0 { 1.0 } else { -1.0 };
            let body = &self.state.bodies[end.body];
            nodes[side].clear();
            if let Some(motion) = &body.motion {
                let speed = Vector(motion.velocity_at(centers[side])).dot(along);
                rate += speed;
                if motion.as_free().is_some() {
                    let arm = (Vector(centers[side]) - Vector(motion.center)).0;
                    yields += self.workspace.mechanism.yields(end.body, arm, along.0);
                } else {
                    driven += dt * speed;
                }
                continue;
            }
            let along = Vector::<T, D>::of(along.0);
            self.find_nodes((end, &places[end.body]), along, &mut nodes[side]);
            let [of_rate, of_gone, of_yields] = &mut sums;
            for (index, pull) in &nodes[side] {
                let (_, block) = self.workspace.active.slots[*index as usize / nodes_per_block(D)];
                if self.workspace.active.books(block) {
                    let node = &self.workspace.field.nodes[*index as usize];
                    of_rate.add(pull.dot(node.velocity).f64());
                    of_gone.add((pull.dot(node.integrated) * ahead).f64());
                    of_yields.add((pull.dot(*pull) / node.mass).f64());
                }
            }
        }
        self.add_up(&mut sums);
        let [of_nodes, gone, of_all] = sums.each_ref().map(ExactSum::value);
        (rate, yields) = (rate + of_nodes, yields + of_all);
        let softer = 1.0 / (1.0 + dt * (dt * spring.stiffness + spring.dashpot) * yields);
        let stretch = spring.drawn + self.state.springs[number].way + gone - spring.rest;
        let force = -(spring.stiffness * stretch + spring.dashpot * rate) * softer;
        for (side, nodes) in nodes.iter().enumerate() {
            let along = direction * if side == 0 { 1.0 } else { -1.0 };
            let (body, impulse) = (spring.ends[side].body, along * (dt * force));
            self.workspace.mechanism.push(&mut self.state.bodies, (body, dt), (centers[side], impulse.0));
            for (index, pull) in nodes {
                let node = &mut self.workspace.field.nodes[*index as usize];
                node.velocity += *pull * (T::of(dt * force) / node.mass);
            }
        }
        SpringStep { direction: direction.0, force, stiffness: spring.stiffness * softer, driven, gone }
    }

    /// The nodes that move the mean place of a part, each with g_i along a direction.
    fn find_nodes(
        &self,
        (end, places): (&PartPoints, &[u32]),
        along: Vector<T, D>,
        nodes: &mut PartNodes<T, D>,
    ) {
        let (active, boundary) = (&self.workspace.active, &self.workspace.boundary);
        let n = nodes_per_block(D);
        let mut found: Vec<(u32, [i32; 3], [f64; 3])> = Vec::new();
        for (point, number) in end.points.iter().zip(0..) {
            let particles = &self.state.bodies[end.body].particles;
            let place = match places[point.particle] {
                // Another rank has it.
                NOWHERE => continue,
                place => place as usize,
            };
            let (lattice, seen) = (&self.settings.lattice, (&particles.get(place), &particles.edges(place)));
            let share = T::of(point.measure / end.measure);
            for (node, [_, weight]) in nodes_of::<T, D, B>(lattice, seen, point) {
                let Some((index, mirrored)) = find(active, boundary, (end.body, node)) else { continue };
                if self.workspace.field.nodes[index as usize].mass > T::ZERO {
                    let pull = mirror(along, mirrored) * (weight * share);
                    if self.among.is_none() {
                        nodes.push((index, pull));
                        continue;
                    }
                    let (_, block) = active.slots[index as usize / n];
                    let node: [i32; D] = node_at(block, index as usize % n);
                    let node = std::array::from_fn(|k| if k < D { node[k] } else { 0 });
                    found.push((number, node, pull.space()));
                }
            }
        }
        if let Some(among) = &self.among {
            let mut all = among.gathered(&found).concat();
            all.sort_by_key(|(number, ..)| *number);
            nodes.extend(all.into_iter().filter_map(|(_, node, pull)| {
                // One without mass is beyond what this rank has of the block.
                let index = active.node_index(end.body, std::array::from_fn(|k| node[k]))?;
                (self.workspace.field.nodes[index].mass > T::ZERO).then(|| (index as u32, Vector::of(pull)))
            }));
        }
        nodes.sort_by_key(|(index, _)| *index);
        nodes.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
    }

    /// Where the particles that carry ends of springs lie in memory.
    pub(super) fn find_spring_carriers(&mut self) {
        let (places, bodies) = (&mut self.workspace.springs.places, &self.state.bodies);
        places.resize_with(bodies.len(), Vec::new);
        if self.among.is_some() {
            // Who was with another rank may have come.
            let ends = self.settings.springs.iter().flat_map(|spring| &spring.ends);
            ends.for_each(|end| places[end.body].clear());
        }
        for end in self.settings.springs.iter().flat_map(|spring| &spring.ends) {
            if !bodies[end.body].is_rigid() {
                find_carriers(&mut places[end.body], bodies[end.body].particles.numbers(), &end.points);
            }
        }
    }

    /// Books what springs did in the step, once bodies have moved: forces, and works along the change of length. For
    /// the spring itself this is exactly what it loses.
    ///
    /// ```text
    /// W = (f - k (dl/2 - a)) (dl - what prescribed ends moved)
    /// ```
    /// a: by how much it has grown where f is taken.
    pub(super) fn account_springs(&mut self, dt: T) {
        if self.settings.springs.is_empty() {
            return;
        }
        let (room, dt) = (&self.workspace.springs, dt.f64());
        for (i, (spring, step)) in self.settings.springs.iter().zip(&room.springs).enumerate() {
            let length = self.length(spring, &room.places);
            let sums = &mut self.state.springs[i];
            let Some(length) = length else { continue };
            let way = length - spring.drawn;
            let change = way - sums.way;
            (sums.way, sums.speed) = (way, change / dt);
            (0..3).for_each(|k| sums.impulse[k] += dt * step.force * step.direction[k]);
            sums.work += (step.force - step.stiffness * (0.5 * change - step.gone)) * (change - step.driven);
        }
    }

    /// Measures springs where bodies begin.
    pub(super) fn begin_springs(&mut self) {
        self.find_spring_carriers();
        for i in 0..self.settings.springs.len() {
            let (spring, places) = (&self.settings.springs[i], &self.workspace.springs.places);
            self.state.springs[i].way =
                self.length(spring, places).map_or(0.0, |length| length - spring.drawn);
        }
    }

    /// Mean places of the parts of a spring now [m]; `None` once a particle that carries one has left the domain: the
    /// spring lets go.
    fn centers(&self, spring: &SpringPoints, places: &[Vec<u32>]) -> Option<[[f64; 3]; 2]> {
        let [a, b] = spring.ends.each_ref().map(|end| self.center(end, places));
        Some([a?, b?])
    }

    /// The mean place of an end.
    fn center(&self, end: &PartPoints, places: &[Vec<u32>]) -> Option<[f64; 3]> {
        let body = &self.state.bodies[end.body];
        if let Some(motion) = &body.motion {
            return Some(motion.pose().now(end.center));
        }
        let here = |(number, point): (u32, &PartPoint)| match places[end.body][point.particle] {
            NOWHERE => None,
            place => Some((number, place_of(&body.particles.get(place as usize), point).space())),
        };
        let mut found: Vec<(u32, [f64; 3])> = (0..).zip(&end.points).filter_map(here).collect();
        if let Some(among) = &self.among {
            found = among.gathered(&found).concat();
            found.sort_by_key(|(number, _)| *number);
        }
        let share = |(number, place): &(u32, [f64; 3])| {
            Vector(*place) * (end.points[*number as usize].measure / end.measure)
        };
        (found.len() == end.points.len()).then(|| found.iter().map(share).sum::<Vector<f64, 3>>().0)
    }

    /// Length of a spring now [m].
    fn length(&self, spring: &SpringPoints, places: &[Vec<u32>]) -> Option<f64> {
        let [a, b] = self.centers(spring, places)?;
        Some((Vector(a) - Vector(b)).norm())
    }
}
