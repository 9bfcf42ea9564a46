//! Loads and supports at the nodes.
//!
//! Nodes take the forces of the points that they move, see [`crate::load`]. A support's force falls while its part
//! moves within the step, which the nodes feel as inertia along axes that are held:
//!
//! ```text
//! v_i += dt (f_i + m_i g + F_i) / (m_i + M_i)       F_i = sum_s N_is f_s,   M_i = sum_s |N_is| dt (dt k_s + c_s)
//! ```
//! M_i is the sum of a row of the springs' matrix, and no smaller than the matrix: however stiff a support, the step
//! stays stable and as long as it was. What M_i keeps from the node is the support's doing, and is booked as its force.

use super::Engine;
use crate::body::Body;
use crate::boundary::{Boundary, reflect};
use crate::door::StepError;
use crate::exact::ExactSum;
use crate::grid::{ActiveBlocks, Node};
use crate::lanes::Laned;
use crate::load::{CarriedPoint, LoadPoints, LoadSums, LoadTime, PointForce, place_of};
use crate::part::PartPoint;
use crate::particles::by_number;
use crate::scene::{Face, MeanRoom, OutsideValue};
use crate::tensor::{Real, Vector, cross};
use crate::threads::each;
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// Points that a thread takes at a time.
const POINTS: usize = 32;
/// The place in memory of a particle that has left the domain.
pub(super) const NOWHERE: u32 = u32::MAX;
/// That of one which must be looked for.
pub(super) const UNKNOWN: u32 = u32::MAX - 1;

/// Room for loads in a step.
#[derive(Clone, Debug)]
pub struct LoadRoom<T, const D: usize> {
    /// Of each load, where the particle lies in memory that carries each of its points.
    places: Vec<Vec<u32>>,
    /// Load of each of all points that are here, and its place among that one's, one load after the other.
    pub(super) numbers: Vec<[u32; 2]>,
    /// The points likewise.
    pub(super) points: Vec<LoadedPoint<T, D>>,
    /// Those of other ranks at nodes that are here, too, by load and number.
    pub(super) foreign: Vec<ForeignPoint<T, D>>,
    /// What each node takes, for all nodes; those that no load reaches have nothing.
    nodes: Vec<NodeLoad<T, D>>,
    /// Nodes that loads reach.
    reached: Vec<u32>,
    /// Whether forces were taken where the step ends.
    late: bool,
    /// Of each load, places of its points times their measures, and the measures.
    middles: Vec<ExactSum>,
    /// Of each load, its impulse, the moment of that, and its work in a step.
    booked: Vec<ExactSum>,
    /// Of each load, the means over the step of what it prescribes at all points alike.
    means: Vec<[Option<f64>; 3]>,
    /// What functions from outside are asked and say.
    outside: OutsideRoom,
}

/// Room for functions from outside.
#[derive(Clone, Debug, Default)]
struct OutsideRoom {
    /// Where the points of a load are, and where they were at the start [m].
    now: Vec<[f64; 3]>,
    start: Vec<[f64; 3]>,
    /// What the functions said of each point of all loads, the mean over the step; nothing where no load has one.
    values: Vec<[f64; 3]>,
    /// Room for their means.
    said: Vec<[f64; 3]>,
    bend: Vec<[f64; 3]>,
}

/// A point of a load in a step.
#[derive(Clone, Debug)]
pub(super) struct LoadedPoint<T, const D: usize> {
    pub felt: PointForce<T, D>,
    /// Where it was when the step began [m].
    before: Vector<T, D>,
    /// How fast its nodes were then [m/s].
    begun: Vector<T, D>,
    pub nodes: Vec<LoadedNode<T>>,
}

/// A point of another rank in a step.
#[derive(Clone, Debug)]
pub(super) struct ForeignPoint<T, const D: usize> {
    /// Its load, and its number among the points of that.
    pub key: [u32; 2],
    pub felt: PointForce<T, D>,
    pub nodes: Vec<LoadedNode<T>>,
}

/// A node that moves a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct LoadedNode<T> {
    pub index: u32,
    /// Axes along which the node is a mirror image, a bit each.
    pub mirrored: u32,
    /// N_i [-]
    pub weight: T,
}

/// What acts on a free rigid body at a point.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct ForceOnBody {
    /// The load, and the number of its point.
    key: [u32; 2],
    /// Index of the body.
    pub body: usize,
    /// The force [N].
    pub force: [f64; 3],
    /// Where it acts [m].
    pub place: [f64; 3],
}

/// What a node takes from loads.
#[derive(Clone, Copy, Debug)]
struct NodeLoad<T, const D: usize> {
    reached: bool,
    /// F_i [N]
    force: Vector<T, D>,
    /// M_i [kg]
    inertia: Vector<T, D>,
    /// Its part of springs, sum_s |N_is| dt^2 k_s [kg].
    held_by: Vector<T, D>,
    /// What that moves with, sum_s |N_is| dt^2 k_s v*_s [kg m/s].
    momentum: Vector<T, D>,
    /// Acceleration [m/s^2]: M_i times this is what supports keep from the node.
    acceleration: Vector<T, D>,
    /// What supports took from the velocity when they held it, and what they would take from that at the start of the
    /// step [m/s].
    held: Vector<T, D>,
    held_before: Vector<T, D>,
}

impl<T: Real, const D: usize> Default for NodeLoad<T, D> {
    fn default() -> Self {
        let nothing = Vector::ZERO;
        NodeLoad {
            reached: false,
            force: nothing,
            inertia: nothing,
            held_by: nothing,
            momentum: nothing,
            acceleration: nothing,
            held: nothing,
            held_before: nothing,
        }
    }
}

impl<T: Laned, const D: usize> Engine<T, D> {
    /// What loads and supports do to points of bodies, and which nodes feel it. Where particles have strained but still
    /// move, `ahead` is how long [s].
    ///
    /// # Errors
    /// A function from outside that has no answer.
    pub(super) fn feel_loads(&mut self, dt: T, ahead: Option<T>) -> Result<(), StepError> {
        if self.settings.loads.is_empty() {
            return Ok(());
        }
        let start = Instant::now();
        self.find_loaded_particles();
        self.ask_functions(dt)?;
        self.load_points(dt, ahead);
        self.share_points();
        if ahead.is_none() {
            let time = (self.state.time, dt.f64());
            let loads = self.settings.loads.iter().zip(&mut self.state.loads);
            loads.for_each(|(load, sums)| load.drive(time, sums));
        }
        let count = self.workspace.field.nodes.len();
        let LoadRoom { numbers, points, foreign, nodes, reached, .. } = &mut self.workspace.loads;
        nodes.resize(count, NodeLoad::default());
        let mut load = |felt: &PointForce<T, D>, points: &[LoadedNode<T>]| {
            for &LoadedNode { index, mirrored, weight } in points {
                let node = &mut nodes[index as usize];
                if !std::mem::replace(&mut node.reached, true) {
                    reached.push(index);
                }
                node.force += mirror(felt.force, mirrored) * weight;
                // No less than nothing, where straight lines beyond a particle's reach have turned negative.
                let springs = felt.spring * (dt * dt * weight.abs());
                node.inertia += felt.inertia * weight.abs();
                node.held_by += springs;
                let speed = mirror(felt.speed, mirrored);
                node.momentum += Vector::from_fn(|i| springs[i] * speed[i]);
            }
        };
        // In the order of all ranks' points.
        let mut foreign = foreign.iter().peekable();
        for (point, &number) in points.iter().zip(numbers.iter()) {
            let key = key_of(&self.settings.loads, number);
            while let Some(ForeignPoint { felt, nodes, .. }) = foreign.next_if(|other| other.key < key) {
                load(felt, nodes);
            }
            load(&point.felt, &point.nodes);
        }
        foreign.for_each(|ForeignPoint { felt, nodes, .. }| load(felt, nodes));
        self.watch.lap("loads", start);
        Ok(())
    }

    /// What functions from outside say of the points on which they act, as these are now: the mean over the step.
    fn ask_functions(&mut self, dt: T) -> Result<(), StepError> {
        let LoadRoom { places, outside, .. } = &mut self.workspace.loads;
        let OutsideRoom { now, start, values, said, bend } = outside;
        let (time, dt) = (self.state.time, dt.f64());
        let mut first = 0;
        for (load, places) in self.settings.loads.iter().zip(places) {
            let points = first..first + load.points.len();
            first = points.end;
            let Some(function) = load.action.outside().and_then(OutsideValue::function) else { continue };
            values.resize(points.end.max(values.len()), [0.0; 3]);
            // Nodes have asked for those of bodies on grids of their own.
            if self.settings.references.iter().any(|own| own.body == load.body) {
                continue;
            }
            let particles = &self.state.bodies[load.body].particles;
            now.clear();
            now.extend(load.points.iter().zip(places).map(|(point, place)| match *place {
                NOWHERE => point.position,
                place => place_of(&particles.get(place as usize), point).space(),
            }));
            start.clear();
            start.extend(load.points.iter().map(|point| point.position));
            for room in [&mut *said, &mut *bend] {
                room.clear();
                room.resize(points.len(), [0.0; 3]);
            }
            let room = MeanRoom { values: &mut values[points], said, bend };
            room.mean(function, (time, dt), [now, start]).map_err(|reason| {
                let what = format!("the load on body `{}`", self.state.bodies[load.body].name);
                StepError::Outside { what, time, reason }
            })?;
        }
        Ok(())
    }

    /// Loads and supports change the velocities that the forces of the stress and gravity gave to the nodes.
    pub(super) fn apply_loads(&mut self, dt: T) {
        let gravity = self.gravity(dt);
        let (room, field) = (&mut self.workspace.loads, &mut self.workspace.field);
        for &index in &room.reached {
            room.nodes[index as usize].accelerate(&mut field.nodes[index as usize], gravity, dt);
        }
    }

    /// Supports hold the velocities that strain and move the particles as they hold those that are integrated: what
    /// acts on one and not on the other feeds noise with energy.
    pub(super) fn hold_supported_nodes(&mut self) {
        let (room, field) = (&mut self.workspace.loads, &mut self.workspace.field);
        for &index in &room.reached {
            room.nodes[index as usize].hold(&mut field.nodes[index as usize]);
        }
    }

    /// Gives nodes the velocities back that they had before supports held them.
    pub(super) fn release_supported_nodes(&mut self) {
        let (room, field) = (&self.workspace.loads, &mut self.workspace.field);
        for &index in &room.reached {
            field.nodes[index as usize].velocity += room.nodes[index as usize].held;
        }
    }

    /// Where the particles that carry points lie in memory.
    fn find_loaded_particles(&mut self) {
        for (i, load) in self.settings.loads.iter().enumerate() {
            let places = self.workspace.loads.places_of(i, load);
            find_carriers(places, self.state.bodies[load.body].particles.numbers(), &load.points);
        }
    }

    /// What acts on free rigid bodies, point by point in the order of loads.
    pub(super) fn forces_on_free_bodies(&self) -> Vec<ForceOnBody> {
        let (room, loads, free) = (&self.workspace.loads, &self.settings.loads, &self.settings.free);
        let on_free = room.numbers.iter().zip(&room.points).filter_map(|(&number, loaded)| {
            let [load, point] = number.map(|number| number as usize);
            let body = loads[load].body;
            let is_here = free[body] && room.places[load][point] != NOWHERE;
            let (force, place) = (loaded.felt.force.space(), loaded.before.space());
            is_here.then(|| ForceOnBody { key: key_of(loads, number), body, force, place })
        });
        let mut forces: Vec<ForceOnBody> = on_free.collect();
        if let Some(among) = &self.among {
            forces = among.gathered(&forces).concat();
            forces.sort_unstable_by_key(|force| force.key);
        }
        forces
    }

    /// What acts on each point, and which nodes feel it.
    fn load_points(&mut self, dt: T, ahead: Option<T>) {
        let room = &mut self.workspace.loads;
        let loads = &self.settings.loads;
        room.begin(loads);
        room.means.clear();
        room.means.extend(loads.iter().map(|load| load.means(self.state.time, dt.f64())));
        room.late = ahead.is_some();
        let (numbers, means, values) = (&room.numbers, &room.means, &room.outside.values);
        let (places, bodies, sums) = (&room.places, &self.state.bodies, &self.state.loads);
        let (active, boundary, lattice) =
            (&self.workspace.active, &self.workspace.boundary, &self.settings.lattice);
        let (nodes, nodes_of) = (&self.workspace.field.nodes, self.kernels.nodes_of);
        let (time, references) = (self.state.time, &self.settings.references);
        let now = time + ahead.map_or(0.0, |ahead| ahead.f64());
        each(&mut room.points, POINTS, |i, loaded| {
            let [number, point] = numbers[i].map(|number| number as usize);
            let (load, place) = (&loads[number], places[number][point]);
            let (body, point) = (&bodies[load.body], &load.points[point]);
            loaded.nodes.clear();
            let apart = references.binary_search_by_key(&load.body, |reference| reference.body).is_ok();
            if place == NOWHERE || apart {
                loaded.felt = PointForce::default();
                return;
            }
            let mut particle = body.particles.get(place as usize);
            let (mut velocity, mut moves) = (Vector::ZERO, Vector::ZERO);
            // A rigid body feels the force itself, see `mechanism/`.
            let moved_by_nodes = !body.is_rigid();
            let mut take = |node: [i32; D], [own, weight]: [T; 2]| {
                let Some((index, mirrored)) = find(active, boundary, (load.body, node)) else { return };
                if nodes[index as usize].mass > T::ZERO {
                    velocity += mirror(nodes[index as usize].start, mirrored) * weight;
                    moves += mirror(nodes[index as usize].integrated, mirrored) * own;
                    loaded.nodes.push(LoadedNode { index, mirrored, weight });
                }
            };
            if moved_by_nodes {
                nodes_of(lattice, &particle, &point.arm, &mut take);
            }
            match ahead {
                None => loaded.before = place_of(&particle, point),
                Some(ahead) => particle.position += moves * ahead,
            }
            loaded.begun = freely_moved(body, place_of(&particle, point)).unwrap_or(velocity);
            let outside = values.get(i).copied().unwrap_or_default();
            let carried = CarriedPoint { point, particle: &particle, velocity, outside };
            let time = LoadTime { time, now, dt: dt.f64(), means: means[number] };
            loaded.felt = load.at(carried, time, &sums[number]);
        });
    }

    /// Books what loads did in this step, once particles have moved: forces, moments, and works.
    ///
    /// ```text
    /// springs    W = sum_s (f_s -+ k_s (du_s - v*_s dt)/2) . du_s - sum_si |N_is| dt^2 k_s a_i . v^0_s dt
    /// others     W = sum_s f_s . (du_s + v_s dt)/2 - sum_si |N_is| dt c_s a_i . (u_i + v_i) dt/2
    /// ```
    /// du_s: change of the place of a point; u_i: velocities of nodes that move points; v_s, v_i: those at the start of
    /// the step, held by supports as u_i are (not with `first`, where closing is not shown); a_i: acceleration; v*_s:
    /// the velocity that a support prescribes, the mean over the step, and v^0_s where the step begins. Minus where f_s
    /// was taken before the points moved, plus where it was taken after.
    ///
    /// A step changes the kinetic energy by the forces at the nodes times the mean of their velocities interpolated
    /// before and after, and the strain energy by the stress times u_i. As all forces at a node together are m_i a_i,
    /// these works are the sum of both, but for the difference of a number at the end of the step and at its start,
    /// dt/2 (m_i a_i - f_s) . u_i. So the ledger swings a little in each step, and does not drift.
    pub(super) fn account_loads(&mut self, dt: T) {
        if self.settings.loads.is_empty() {
            return;
        }
        let start = Instant::now();
        let (mut middles, mut booked) = {
            let room = &mut self.workspace.loads;
            (std::mem::take(&mut room.middles), std::mem::take(&mut room.booked))
        };
        let count = self.settings.loads.len();
        middles.clear();
        middles.resize(4 * count, ExactSum::default());
        booked.clear();
        booked.resize(7 * count, ExactSum::default());
        let mut rest = &self.workspace.loads.points[..];
        let of_loads = self.settings.loads.iter().zip(&self.workspace.loads.places);
        for ((load, places), sums) in of_loads.zip(middles.as_chunks_mut().0) {
            let points = rest.split_off(..load.points.len()).expect("each load has its points");
            add_middle((load, points), places, sums);
        }
        self.add_up(&mut middles);
        let room = &self.workspace.loads;
        let field = &self.workspace.field;
        let half = if room.late { T::HALF } else { -T::HALF };
        let mut rest = &room.points[..];
        let of_loads = middles.as_chunks().0.iter().zip(booked.as_chunks_mut::<7>().0);
        for ((load, places), (middle, sums)) in self.settings.loads.iter().zip(&room.places).zip(of_loads) {
            let body = &self.state.bodies[load.body];
            let points = rest.split_off(..load.points.len()).expect("each load has its points");
            let center = middle_of(middle);
            let [impulse_x, impulse_y, impulse_z, moment_x, moment_y, moment_z, work] = sums;
            for ((point, &place), loaded) in load.points.iter().zip(places).zip(points) {
                let LoadedPoint { felt, before, begun, nodes } = loaded;
                if place == NOWHERE {
                    continue;
                }
                let particle = body.particles.get(place as usize);
                let way = place_of(&particle, point) - *before;
                let mut held = Vector::ZERO;
                let mut given = if body.is_rigid() { felt.force } else { Vector::ZERO };
                for &LoadedNode { index, mirrored, weight } in nodes {
                    let (taken, node) = (&room.nodes[index as usize], &field.nodes[index as usize]);
                    let acceleration = mirror(taken.acceleration, mirrored);
                    let mean = mirror(node.velocity + node.start - taken.held_before, mirrored) * T::HALF;
                    held += mirror(taken.held_before, mirrored) * weight;
                    given += felt.force * weight;
                    for i in 0..D {
                        let share = weight.abs() * acceleration[i];
                        let springs = felt.spring[i] * share * dt * dt;
                        let dashpots = felt.inertia[i] * share - springs;
                        given[i] -= springs + dashpots;
                        work.add(-((springs * felt.begun[i] + dashpots * mean[i]) * dt).f64());
                    }
                }
                let mean = (way + (*begun - held) * dt) * T::HALF;
                let is_prescribed = body.motion.as_deref().is_some_and(|motion| motion.as_free().is_none());
                for i in 0..D {
                    let pushed = if is_prescribed { way[i] } else { mean[i] };
                    let closer = way[i] - felt.speed[i] * dt;
                    let springs = (felt.pull[i] + felt.spring[i] * closer * half) * way[i];
                    work.add((springs + (felt.force[i] - felt.pull[i]) * pushed).f64());
                }
                let (arm, given) = (Vector(before.space()) - center, Vector(given.space()) * dt.f64());
                let moment = cross(arm.0, given.0);
                [&mut *impulse_x, impulse_y, impulse_z]
                    .into_iter()
                    .zip(given.0)
                    .for_each(|(sum, x)| sum.add(x));
                [&mut *moment_x, moment_y, moment_z].into_iter().zip(moment).for_each(|(sum, x)| sum.add(x));
            }
        }
        self.add_up(&mut booked);
        for (sums, booked) in self.state.loads.iter_mut().zip(booked.as_chunks::<7>().0) {
            let [impulse @ .., x, y, z, work] = booked.each_ref().map(ExactSum::value);
            sums.impulse.iter_mut().zip(impulse).for_each(|(sum, x)| *sum += x);
            sums.moment.iter_mut().zip([x, y, z]).for_each(|(sum, x)| *sum += x);
            sums.work += work;
        }
        let room = &mut self.workspace.loads;
        (room.middles, room.booked) = (middles, booked);
        self.watch.lap("loads", start);
    }

    /// How far the points of a load are from where they were, the mean over those that are there [m].
    pub(super) fn load_displacement(&self, load: &LoadPoints) -> [f64; 3] {
        let particles = &self.shown()[load.body].particles;
        let mut places = Vec::new();
        find_carriers(&mut places, particles.numbers(), &load.points);
        // Places, measures, and how many.
        let mut sums = [0; 5].map(|_| ExactSum::default());
        let [sum @ .., measure, count] = &mut sums;
        for (point, &place) in load.points.iter().zip(&places).filter(|(_, place)| **place != NOWHERE) {
            let now = place_of(&particles.get(place as usize), point).space();
            (0..D).for_each(|i| sum[i].add(point.measure * (now[i] - load.start(point)[i])));
            measure.add(point.measure);
            count.add(1.0);
        }
        self.add_up(&mut sums);
        let [sum @ .., measure, count] = sums.each_ref().map(ExactSum::value);
        let measure = if count == load.count as f64 { load.measure } else { measure };
        if count == 0.0 { [0.0; 3] } else { sum.map(|sum| sum / measure) }
    }
}

impl<T, const D: usize> Default for LoadRoom<T, D> {
    fn default() -> Self {
        let (places, numbers, points, foreign) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let (nodes, reached, outside) = (Vec::new(), Vec::new(), OutsideRoom::default());
        let (middles, booked, means) = (Vec::new(), Vec::new(), Vec::new());
        let late = false;
        LoadRoom { places, numbers, points, foreign, nodes, reached, late, middles, booked, means, outside }
    }
}

impl<T: Real, const D: usize> LoadRoom<T, D> {
    /// Forgets the last step, and has room for all points.
    fn begin(&mut self, loads: &[LoadPoints]) {
        for index in self.reached.drain(..) {
            if let Some(node) = self.nodes.get_mut(index as usize) {
                *node = NodeLoad::default();
            }
        }
        let numbers =
            |(i, load): (usize, &LoadPoints)| (0..load.points.len()).map(move |p| [i as u32, p as u32]);
        self.numbers.clear();
        self.numbers.extend(loads.iter().enumerate().flat_map(numbers));
        self.points.resize(
            self.numbers.len(),
            LoadedPoint {
                felt: PointForce::default(),
                before: Vector::ZERO,
                begun: Vector::ZERO,
                nodes: Vec::new(),
            },
        );
    }

    /// Where the particles lie that carry the points of a load, which is at this place among all, as far as known.
    pub(super) fn places_of(&mut self, i: usize, load: &LoadPoints) -> &mut Vec<u32> {
        if self.places.len() <= i {
            self.places.resize_with(i + 1, Vec::new);
        }
        let places = &mut self.places[i];
        if places.len() != load.points.len() {
            places.clear();
            places.resize(load.points.len(), UNKNOWN);
        }
        places
    }

    /// Takes note that particles of a body have moved in memory, each from one place to another.
    pub(super) fn follow(&mut self, loads: &[LoadPoints], (body, moves): (usize, &[[u32; 2]])) {
        let Some(&[first, _]) = moves.first() else { return };
        let of_body = loads.iter().zip(&mut self.places).filter(|(load, _)| load.body == body);
        // They come from behind all that stay, in ascending order.
        for place in of_body.flat_map(|(_, places)| places).filter(|place| **place >= first) {
            if let Ok(at) = moves.binary_search_by_key(place, |[from, _]| *from) {
                *place = moves[at][1];
            }
        }
    }
}

impl<T: Real, const D: usize> NodeLoad<T, D> {
    /// Gives the node what it takes, and gives back what it takes no more of other forces.
    fn accelerate(&mut self, node: &mut Node<T, D>, gravity: Vector<T, D>, dt: T) {
        for i in 0..D {
            let other = node.force[i] + node.mass * gravity[i];
            let acceleration = (other + self.force[i]) / (node.mass + self.inertia[i]);
            node.velocity[i] += (acceleration - other / node.mass) * dt;
            self.acceleration[i] = acceleration;
        }
    }

    /// Gives the node the velocity that it and the inertia of springs have together.
    fn hold(&mut self, node: &mut Node<T, D>) {
        let held = |velocity: Vector<T, D>| {
            Vector::from_fn(|i| {
                let momentum = node.mass * velocity[i] + self.momentum[i];
                momentum / (node.mass + self.held_by[i])
            })
        };
        let velocity = held(node.velocity);
        self.held = node.velocity - velocity;
        self.held_before = node.start - held(node.start);
        node.velocity = velocity;
    }
}

/// The load of a point and its number among all points of that, by its place among those here.
pub(super) fn key_of(loads: &[LoadPoints], [load, point]: [u32; 2]) -> [u32; 2] {
    [load, loads[load as usize].points[point as usize].number]
}

/// Particles of a body for one that is looked for among them from the end on, where it has just come.
const MANY: usize = 16;

/// Where the particles of a body lie in memory that carry points, from the numbers in the order of memory; [`NOWHERE`]
/// for those that have left the domain. What is known of them may be out of date, or not there.
pub(super) fn find_carriers(places: &mut Vec<u32>, numbers: &[u32], points: &[PartPoint]) {
    places.resize(points.len(), UNKNOWN);
    let is_lost = |(place, point): (&u32, &PartPoint)| {
        *place != NOWHERE && numbers.get(*place as usize) != Some(&point.particle)
    };
    let known = places.iter().zip(points).zip(0..);
    let lost = known.filter(|(known, _)| is_lost(*known)).map(|((_, point), i)| (point.particle, i));
    let mut lost: Vec<(u32, usize)> = lost.collect();
    lost.sort_unstable();
    lost.iter().for_each(|&(_, i)| places[i] = NOWHERE);
    let mut found = 0;
    let find = |place: u32| {
        let number = numbers[place as usize];
        let first = lost.partition_point(|(wanted, _)| *wanted < number);
        for &(_, i) in lost[first..].iter().take_while(|(wanted, _)| *wanted == number) {
            places[i] = place;
            found += 1;
        }
        found < lost.len()
    };
    if MANY * lost.len() < numbers.len() {
        (0..numbers.len() as u32).rev().all(find);
        return;
    }
    let mut order = by_number(numbers).into_iter().peekable();
    for (wanted, i) in lost {
        while order.next_if(|&place| numbers[place as usize] < wanted).is_some() {}
        if let Some(&place) = order.peek().filter(|place| numbers[**place as usize] == wanted) {
            places[i] = place;
        }
    }
}

/// The field's index of a body's node, for one behind mirrors that of its image before them, and the axes along which
/// it is one; `None` where the body has no node.
pub(super) fn find<const D: usize>(
    active: &ActiveBlocks<D>,
    boundary: &Boundary,
    (body, node): (usize, [i32; D]),
) -> Option<(u32, u32)> {
    let (node, mirrored) = before_mirrors(boundary, node);
    Some((active.node_index(body, node)? as u32, mirrored))
}

/// A node, of one behind mirrors its image before them, and the axes along which it is one, a bit each.
pub(super) fn before_mirrors<const D: usize>(boundary: &Boundary, mut node: [i32; D]) -> ([i32; D], u32) {
    let mut mirrored = 0;
    for wall in boundary.walls.iter().filter(|wall| wall.face == Face::Symmetry) {
        if wall.depth(node) < 0 {
            node = wall.image(node);
            mirrored ^= 1 << wall.axis;
        }
    }
    (node, mirrored)
}

/// A vector's image across axes, a bit each.
pub(super) fn mirror<T: Real, const D: usize>(v: Vector<T, D>, axes: u32) -> Vector<T, D> {
    (0..D).filter(|axis| axes >> axis & 1 == 1).fold(v, reflect)
}

/// Velocity of a free rigid body at a place [m/s].
fn freely_moved<T: Real, const D: usize>(body: &Body<T, D>, place: Vector<T, D>) -> Option<Vector<T, D>> {
    let motion = body.motion.as_deref().filter(|motion| motion.as_free().is_some())?;
    Some(Vector::of(motion.velocity_at(place.space())))
}

/// Adds the places of a load's points that are there, times their measures, and the measures.
fn add_middle<T: Real, const D: usize>(
    (load, points): (&LoadPoints, &[LoadedPoint<T, D>]),
    places: &[u32],
    [x, y, z, measure]: &mut [ExactSum; 4],
) {
    let there = load.points.iter().zip(places).zip(points).filter(|((_, place), _)| **place != NOWHERE);
    for ((point, _), loaded) in there {
        let place = loaded.before.space();
        [&mut *x, y, z].into_iter().zip(place).for_each(|(sum, x)| sum.add(x * point.measure));
        measure.add(point.measure);
    }
}

/// The middle of a load's part: the mean place of its points that are there [m].
fn middle_of(sums: &[ExactSum; 4]) -> Vector<f64, 3> {
    let [x, y, z, measure] = sums.each_ref().map(ExactSum::value);
    if measure > 0.0 { Vector([x, y, z]) / measure } else { Vector::ZERO }
}

/// Work of all loads since the start [J].
pub(super) fn work(loads: &[LoadSums]) -> f64 {
    loads.iter().map(|sums| sums.work).sum()
}
