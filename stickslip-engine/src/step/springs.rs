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
use super::loads::{NOWHERE, find, mirror};
use super::reference::{center_of, feel, pull_of, push};
use crate::exact::ExactSum;
use crate::grid::{node_at, nodes_per_block};
use crate::lanes::Laned;
use crate::load::place_of;
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
    /// Nodes of the parts of all springs, with g_i.
    nodes: Vec<PartNodes<T, D>>,
}

/// Where a spring is.
struct Line {
    /// Of its two parts [m].
    centers: [[f64; 3]; 2],
    /// From the second to the first.
    direction: Vector<f64, 3>,
}

/// What a spring does in a step.
#[derive(Clone, Copy, Debug, Default)]
pub struct SpringStep {
    /// e, from the second part to the first.
    pub direction: [f64; 3],
    /// f [N]
    pub force: f64,
    /// k as the step feels it [N/m].
    pub stiffness: f64,
    /// How far prescribed ends move along e in the step: by so much the length grows with no work on what is free [m].
    pub driven: f64,
    /// By how much the length has grown since the step began where the force is taken [m].
    pub gone: f64,
}

impl<T, const D: usize> Default for SpringRoom<T, D> {
    fn default() -> Self {
        SpringRoom { places: Vec::new(), springs: Vec::new(), nodes: Vec::new() }
    }
}

impl<T: Laned, const D: usize> Engine<T, D> {
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
        let centers = self.centers(&room.places);
        let directions: Vec<Option<Vector<f64, 3>>> = centers.iter().map(direction).collect();
        self.find_nodes((&directions, &room.places), &mut room.nodes);
        room.springs.clear();
        let of_springs = centers.into_iter().zip(directions).zip(room.nodes.as_chunks().0).enumerate();
        for (number, ((centers, direction), nodes)) in of_springs {
            let line = centers.zip(direction).map(|(centers, direction)| Line { centers, direction });
            let step = line.map(|line| self.pull(number, (dt, ahead), (line, nodes)));
            room.springs.push(step.unwrap_or_default());
        }
        self.workspace.springs = room;
        self.watch.lap("springs", start);
    }

    /// A spring along a line.
    fn pull(
        &mut self,
        number: usize,
        (dt, ahead): (f64, T),
        (Line { centers, direction }, nodes): (Line, &[PartNodes<T, D>; 2]),
    ) -> SpringStep {
        let spring = &self.settings.springs[number];
        let (mut rate, mut yields, mut driven) = (0.0, 0.0, 0.0);
        let own = spring.ends.each_ref().map(|end| self.reference_of(end.body));
        // What ends on grids of their own feel, which all ranks know.
        let mut pulls: [Vec<Vector<f64, D>>; 2] = Default::default();
        // Of the nodes of the common grid: of each that several ranks have, one.
        let mut sums = [0; 3].map(|_| ExactSum::default());
        for side in 0..2 {
            let end = &spring.ends[side];
            let along = along(direction, side);
            if let Some(motion) = &self.state.bodies[end.body].motion {
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
            if let Some(place) = own[side] {
                let nodes = &self.state.references.nodes[place];
                pulls[side] = pull_of(end, along, nodes);
                let [of_rate, of_yields] = feel(nodes, &pulls[side]);
                (rate, yields) = (rate + of_rate, yields + of_yields);
                continue;
            }
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
        let is_on_common_grid =
            |side: usize| own[side].is_none() && self.state.bodies[spring.ends[side].body].motion.is_none();
        if (0..2).any(is_on_common_grid) {
            self.add_up(&mut sums);
        }
        let [of_nodes, gone, of_all] = sums.each_ref().map(ExactSum::value);
        (rate, yields) = (rate + of_nodes, yields + of_all);
        let softer = 1.0 / (1.0 + dt * (dt * spring.stiffness + spring.dashpot) * yields);
        let stretch = spring.drawn + self.state.springs[number].way + gone - spring.rest;
        let force = -(spring.stiffness * stretch + spring.dashpot * rate) * softer;
        for (side, nodes) in nodes.iter().enumerate() {
            let (body, impulse) = (spring.ends[side].body, along(direction, side) * (dt * force));
            self.workspace.mechanism.push(&mut self.state.bodies, (body, dt), (centers[side], impulse.0));
            if let Some(place) = own[side] {
                push(&mut self.state.references.nodes[place], &pulls[side], dt * force);
            }
            for (index, pull) in nodes {
                let node = &mut self.workspace.field.nodes[*index as usize];
                node.velocity += *pull * (T::of(dt * force) / node.mass);
            }
        }
        SpringStep { direction: direction.0, force, stiffness: spring.stiffness * softer, driven, gone }
    }

    /// The ends of all springs, two of each.
    fn ends(&self) -> impl Iterator<Item = &PartPoints> {
        self.settings.springs.iter().flat_map(|spring| &spring.ends)
    }

    /// The nodes that move the mean places of ends, each with g_i along the direction of its spring.
    fn find_nodes(
        &self,
        (directions, places): (&[Option<Vector<f64, 3>>], &[Vec<u32>]),
        nodes: &mut Vec<PartNodes<T, D>>,
    ) {
        let (active, boundary) = (&self.workspace.active, &self.workspace.boundary);
        let n = nodes_per_block(D);
        nodes.resize_with(2 * directions.len(), Vec::new);
        nodes.iter_mut().for_each(Vec::clear);
        // Of each point of each end the nodes with what they feel of it.
        let mut found: Vec<([u32; 2], [i32; 3], [f64; 3])> = Vec::new();
        for (e, end) in self.ends().enumerate() {
            let body = &self.state.bodies[end.body];
            let is_elsewhere = body.is_rigid() || self.reference_of(end.body).is_some();
            let Some(direction) = directions[e / 2].filter(|_| !is_elsewhere) else { continue };
            let along = Vector::<T, D>::of(along(direction, e % 2).0);
            for (point, number) in end.points.iter().zip(0..) {
                let place = match places[end.body][point.particle as usize] {
                    // Another rank has it.
                    NOWHERE => continue,
                    place => place as usize,
                };
                let carrier = body.particles.get(place);
                let share = T::of(point.measure / end.measure);
                let mut take = |node: [i32; D], [_, weight]: [T; 2]| {
                    let Some((index, mirrored)) = find(active, boundary, (end.body, node)) else { return };
                    if self.workspace.field.nodes[index as usize].mass > T::ZERO {
                        let pull = mirror(along, mirrored) * (weight * share);
                        if self.among.is_none() {
                            nodes[e].push((index, pull));
                            return;
                        }
                        let (_, block) = active.slots[index as usize / n];
                        let node: [i32; D] = node_at(block, index as usize % n);
                        let node = std::array::from_fn(|k| if k < D { node[k] } else { 0 });
                        found.push(([e as u32, number], node, pull.space()));
                    }
                };
                (self.kernels.nodes_of)(&self.settings.lattice, &carrier, &point.arm, &mut take);
            }
        }
        if let Some(among) = &self.among {
            let mut all = among.gathered(&found).concat();
            all.sort_by_key(|(key, ..)| *key);
            for ([e, _], node, pull) in all {
                let body = self.settings.springs[e as usize / 2].ends[e as usize % 2].body;
                // One without mass is beyond what this rank has of the block.
                let index = active.node_index(body, std::array::from_fn(|k| node[k]));
                let index = index.filter(|&index| self.workspace.field.nodes[index].mass > T::ZERO);
                nodes[e as usize].extend(index.map(|index| (index as u32, Vector::of(pull))));
            }
        }
        for nodes in nodes {
            nodes.sort_by_key(|(index, _)| *index);
            nodes.dedup_by(|next, kept| {
                let same = next.0 == kept.0;
                if same {
                    kept.1 += next.1;
                }
                same
            });
        }
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
        let lengths = self.centers(&room.places).into_iter().map(length);
        let of_springs = lengths.zip(&self.settings.springs).zip(&room.springs).zip(&mut self.state.springs);
        for (((length, spring), step), sums) in of_springs {
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
        let lengths = self.centers(&self.workspace.springs.places).into_iter().map(length);
        for ((length, spring), sums) in lengths.zip(&self.settings.springs).zip(&mut self.state.springs) {
            sums.way = length.map_or(0.0, |length| length - spring.drawn);
        }
    }

    /// Mean places of the two parts of each spring now [m]; `None` once a particle that carries one has left the
    /// domain: that spring lets go.
    fn centers(&self, places: &[Vec<u32>]) -> Vec<Option<[[f64; 3]; 2]>> {
        let bodies = &self.state.bodies;
        // Where the points of each end are.
        let mut found: Vec<([u32; 2], [f64; 3])> = Vec::new();
        let on_nodes =
            |end: &PartPoints| !bodies[end.body].is_rigid() && self.reference_of(end.body).is_none();
        for (end, e) in self.ends().zip(0..).filter(|(end, _)| on_nodes(end)) {
            for (point, number) in end.points.iter().zip(0..) {
                let place = places[end.body][point.particle as usize];
                if place != NOWHERE {
                    let particle = bodies[end.body].particles.get(place as usize);
                    found.push(([e, number], place_of(&particle, point).space()));
                }
            }
        }
        if let Some(among) = self.among.as_ref().filter(|_| !self.settings.springs.is_empty()) {
            found = among.gathered(&found).concat();
            found.sort_by_key(|(key, _)| *key);
        }
        let mut rest = &found[..];
        let center = |(end, e): (&PartPoints, u32)| {
            if let Some(motion) = &bodies[end.body].motion {
                return Some(motion.pose().now(end.center));
            }
            if let Some(place) = self.reference_of(end.body) {
                let spring = &self.settings.springs[e as usize / 2];
                return Some(center_of(spring, e as usize % 2, &self.state.references.nodes[place]));
            }
            let count = rest.iter().take_while(|([of, _], _)| *of == e).count();
            let points = rest.split_off(..count).expect("so many are left");
            let share = |([_, number], place): &([u32; 2], [f64; 3])| {
                Vector(*place) * (end.points[*number as usize].measure / end.measure)
            };
            (count == end.points.len()).then(|| points.iter().map(share).sum::<Vector<f64, 3>>().0)
        };
        let centers: Vec<Option<[f64; 3]>> = self.ends().zip(0..).map(center).collect();
        centers.as_chunks().0.iter().map(|&[a, b]| Some([a?, b?])).collect()
    }
}

/// Direction from the second part of a spring to the first.
fn direction(centers: &Option<[[f64; 3]; 2]>) -> Option<Vector<f64, 3>> {
    centers.and_then(|[a, b]| (Vector(a) - Vector(b)).direction())
}

/// Where a spring pushes a part in its direction.
fn along(direction: Vector<f64, 3>, side: usize) -> Vector<f64, 3> {
    direction * if side == 0 { 1.0 } else { -1.0 }
}

/// Length of a spring between such places [m].
fn length(centers: Option<[[f64; 3]; 2]>) -> Option<f64> {
    centers.map(|[a, b]| (Vector(a) - Vector(b)).norm())
}

/// Where the particles of a body that carry points lie in memory, by number, from the numbers in the order of memory;
/// [`NOWHERE`] for those that have left the domain.
fn find_carriers(places: &mut Vec<u32>, numbers: &[u32], points: &[PartPoint]) {
    let lies = |number: usize| {
        places
            .get(number)
            .is_some_and(|&place| place == NOWHERE || numbers.get(place as usize) == Some(&(number as u32)))
    };
    if !points.iter().all(|point| lies(point.particle as usize)) {
        let points = points.iter().map(|point| point.particle as usize);
        let most = points.chain(numbers.iter().map(|&number| number as usize)).max();
        places.clear();
        places.resize(most.map_or(0, |most| most + 1), NOWHERE);
        for (place, &number) in numbers.iter().enumerate() {
            places[number as usize] = place as u32;
        }
    }
}
