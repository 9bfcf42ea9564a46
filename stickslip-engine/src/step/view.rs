//! What others may see of the engine.

use super::Engine;
use super::loads;
use super::mechanism::JointSums;
use super::relax::RelaxationProgress;
use super::state::{ByBody, of_body};
use super::walls::WallSums;
use crate::body::{Body, Particle, Totals};
use crate::clock::{Fastest, fastest_motion};
use crate::column::{ColumnDescription, Kind};
use crate::contact::Span;
use crate::door::{
    BodyState, ColumnPlace, ColumnRef, ColumnSource, ContactPatch, ContactPoint, ContactSum, GridSnapshot,
    JointState, Ledger, LoadState, NoColumn, ParticleSnapshot, ParticleView, RankShare, RelaxationState,
    RemovedParticles, SnapshotColumn, StepLimit, TracedParticle, View, WallState, WrittenValues,
};
use crate::grid::{node_at, nodes_per_block};
use crate::lanes::Laned;
use crate::load::{LoadPoints, LoadSums};
use crate::particles::by_number;
use crate::rigid::{Pose, RigidMotion};
use crate::tensor::{Real, Vector, cross};
use crate::threads::by_parts;
use rayon::prelude::*;
use std::convert::Infallible;
use std::ops::Range;
use std::sync::{Arc, PoisonError};

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + b[i])
}

/// A body of prescribed motion as it moves at `time`, where its particles have the mean over the last step. It turns
/// about an axis that stays, so its inertia is the same.
fn as_prescribed(state: BodyState, motion: &RigidMotion, time: f64) -> BodyState {
    let (was, turned) = (motion.velocity(), motion.spin());
    let [velocity, spin] = motion.velocities_at(time);
    if [velocity, spin] == [was, turned] {
        return state;
    }
    let faster = if turned == [0.0; 3] { 1.0 } else { dot(spin, turned) / dot(turned, turned) };
    let orbit = |v: [f64; 3]| cross(state.position, v.map(|v| state.mass * v));
    let (before, after) = (orbit(was), orbit(velocity));
    let whole = |v: [f64; 3]| 0.5 * state.mass * dot(v, v);
    BodyState {
        velocity,
        spin,
        angular_momentum: [0, 1, 2].map(|k| after[k] + faster * (state.angular_momentum[k] - before[k])),
        kinetic: whole(velocity) + faster * faster * (state.kinetic - whole(was)),
        ..state
    }
}

/// A particle as others see it.
fn shown<T: Real, const D: usize>(particle: &Particle<T, D>) -> ParticleView {
    ParticleView {
        number: particle.number,
        mass: particle.mass.f64(),
        volume: particle.volume.f64(),
        position: particle.position.space(),
        velocity: particle.velocity.space(),
        stress: particle.stress.0.map(Real::f64),
    }
}

/// The particles of all bodies as a snapshot has them: by body, then by number.
struct SnapshotRows<'a, T, const D: usize> {
    bodies: &'a [Body<T, D>],
    /// Each particle's body, and its place in memory there.
    places: Vec<[u32; 2]>,
}

impl<'a, T: Laned, const D: usize> SnapshotRows<'a, T, D> {
    fn of(bodies: &'a [Body<T, D>]) -> Self {
        let mut places = Vec::with_capacity(bodies.iter().map(|body| body.particles.len()).sum());
        for (i, body) in bodies.iter().enumerate() {
            let first = places.len();
            places.resize(first + body.particles.len(), [i as u32, 0]);
            let by_number = by_number(body.particles.numbers());
            places[first..].iter_mut().zip(by_number).for_each(|(row, place)| row[1] = place);
        }
        SnapshotRows { bodies, places }
    }

    /// From a body and a number up to another.
    fn between(
        bodies: &'a [Body<T, D>],
        [from, to]: [(u32, u32); 2],
        wanted: &dyn Fn(u32, u32) -> bool,
    ) -> Self {
        let mut places = Vec::new();
        for (body, i) in bodies.iter().zip(0..).take(to.0 as usize + 1).skip(from.0 as usize) {
            let numbers = body.particles.numbers();
            let first = places.len();
            let inside = |number: u32| from <= (i, number) && (i, number) < to && wanted(i, number);
            places.extend(
                numbers.iter().zip(0..).filter(|(number, _)| inside(**number)).map(|(_, place)| [i, place]),
            );
            places[first..].sort_unstable_by_key(|&[_, place]| numbers[place as usize]);
        }
        SnapshotRows { bodies, places }
    }

    /// The components in space of a column, and zeros where a body has no such column.
    fn values<const N: usize>(&self, column: &ColumnDescription) -> Vec<[f64; N]> {
        let of_body = |body: &'a Body<T, D>| body.particles.column(column.name).map(|(_, lines)| lines);
        let bodies: Vec<_> = self.bodies.iter().map(of_body).collect();
        let row = |&[body, place]: &[u32; 2]| {
            let Some(lines) = &bodies[body as usize] else { return [0.0; N] };
            std::array::from_fn(|k| lines[k].map_or(0.0, |line| line[place as usize].f64()))
        };
        self.places.par_iter().map(row).collect()
    }
}

impl<T: Laned, const D: usize> ColumnSource for SnapshotRows<'_, T, D> {
    type Error = Infallible;
    fn column<const N: usize>(&self, column: &ColumnDescription) -> Result<Vec<[f64; N]>, Infallible> {
        Ok(self.values(column))
    }
}

impl<T: Laned, const D: usize> Engine<T, D> {
    /// The bodies, of which no particle is behind.
    ///
    /// # Panics
    /// Some are: who looks asks for [`Simulation::show`] before.
    pub(super) fn shown(&self) -> &[Body<T, D>] {
        assert!(!self.state.references.behind, "particles are shown before somebody looks at them");
        &self.state.bodies
    }

    /// What the particles of each body add up to, by body, summed once a step for whoever asks: on the first of several
    /// ranks of all, on the others of those of which they have particles.
    pub(super) fn totals(&self) -> Arc<ByBody<Totals>> {
        let mut known = self.workspace.totals.lock().unwrap_or_else(PoisonError::into_inner);
        let (bodies, kernels) = (self.shown(), self.kernels);
        let sum = |range: Range<usize>| {
            (range.start, self.with_nodes(range.start, bodies[range.start].totals(kernels)))
        };
        known
            .get_or_insert_with(|| match &self.among {
                Some(among) => {
                    let all = among.totals(bodies, kernels);
                    all.iter().map(|(body, totals)| (*body, self.with_nodes(*body, *totals))).collect()
                }
                None => by_parts(bodies.len(), 1, sum).into(),
            })
            .clone()
    }

    /// What the particles of a body add up to.
    pub(super) fn totals_of(&self, number: usize) -> Totals {
        let body = &self.shown()[number];
        let totals = match &self.among {
            Some(among) => among.totals_of(body, self.kernels),
            None => body.totals(self.kernels),
        };
        self.with_nodes(number, totals)
    }

    /// What a snapshot has of some particles.
    fn snapshot_of(&self, rows: &SnapshotRows<T, D>) -> ParticleSnapshot {
        let Ok(snapshot) = ParticleSnapshot::of_columns(D, rows);
        ParticleSnapshot {
            body: rows.places.par_iter().map(|&[body, _]| body).collect(),
            number: (rows.places.iter())
                .map(|&[body, place]| rows.bodies[body as usize].particles.numbers()[place as usize])
                .collect(),
            history: self.remembered(rows),
            ..snapshot
        }
    }

    /// What the laws of the bodies remember and their transfer has: what two laws call alike is one column.
    fn remembered(&self, rows: &SnapshotRows<T, D>) -> Vec<SnapshotColumn> {
        let mut declared: Vec<ColumnDescription> = Vec::new();
        for column in self.state.bodies.iter().flat_map(|body| body.particles.own_columns()) {
            if !declared.iter().any(|known| known.name == column.name) {
                declared.push(column);
            }
        }
        let column = |column: ColumnDescription| SnapshotColumn {
            name: String::from(column.name),
            unit: String::from(column.unit),
            kind: column.kind,
            values: match column.kind {
                Kind::Number => rows.values::<1>(&column).into_flattened(),
                Kind::Vector | Kind::Rotation => rows.values::<3>(&column).into_flattened(),
                Kind::Symmetric => rows.values::<6>(&column).into_flattened(),
                Kind::Tensor => rows.values::<9>(&column).into_flattened(),
            },
        };
        declared.into_iter().map(column).collect()
    }
}

impl<T: Laned, const D: usize> View for Engine<T, D> {
    fn time(&self) -> f64 {
        self.state.time
    }

    fn steps(&self) -> u64 {
        self.state.steps
    }

    fn particles(&self) -> usize {
        self.state.bodies.iter().map(|body| body.particles.len()).sum()
    }

    fn stable_step(&self) -> f64 {
        self.stable()
    }

    fn step_limit(&self) -> Option<StepLimit> {
        self.limit()
    }

    fn bodies(&self) -> Vec<BodyState> {
        let all = self.totals();
        let spins = self.among.as_ref().map(|among| among.spins(&self.state.bodies, &all, self.kernels));
        if self.among.as_ref().is_some_and(|among| among.ranks.rank() > 0) {
            return Vec::new();
        }
        (self.state.bodies.iter().enumerate())
            .map(|(i, body)| {
                if let Some(motion) = self.without_bounds(i) {
                    let [velocity, spin] = motion.velocities_at(self.state.time);
                    return BodyState {
                        mass: 0.0,
                        position: motion.center,
                        velocity,
                        spin,
                        angular_momentum: [0.0; 3],
                        kinetic: 0.0,
                        strain: 0.0,
                    };
                }
                if let Some(free) = body.motion.as_deref().and_then(RigidMotion::as_free) {
                    let motion = body.motion.as_deref().expect("it is rigid");
                    let orbit = cross(motion.center, free.state.momentum);
                    return BodyState {
                        mass: free.mass,
                        position: motion.center,
                        velocity: motion.velocity(),
                        spin: motion.spin(),
                        angular_momentum: add(orbit, free.state.angular_momentum),
                        kinetic: free.kinetic(),
                        strain: 0.0,
                    };
                }
                // Else all its particles have left.
                let found = of_body(&all, i).filter(|totals| totals.mass > 0.0);
                let Some(totals) = found else { return BodyState::default() };
                let by_nodes = self.reference_of(i).map(|place| self.spin_of(place, totals));
                let spin = match &spins {
                    Some(spins) => *of_body(spins, i).expect("what has a mass turns somehow"),
                    None => body.spin(self.kernels, totals),
                };
                let spin = by_nodes.unwrap_or(spin);
                let over_step = BodyState {
                    mass: totals.mass,
                    position: totals.first_moment.map(|x| x / totals.mass),
                    velocity: totals.momentum.map(|p| p / totals.mass),
                    spin,
                    angular_momentum: totals.angular_momentum,
                    kinetic: totals.kinetic,
                    strain: totals.strain,
                };
                match body.motion.as_deref() {
                    Some(motion) => as_prescribed(over_step, motion, self.state.time),
                    None => over_step,
                }
            })
            .collect()
    }

    fn ledger(&self) -> Ledger {
        let all_removed = &self.state.removed;
        // A sum of nothing is 0, without a sign.
        let removed =
            |of: &dyn Fn(&RemovedParticles) -> f64| all_removed.iter().map(of).fold(0.0, |sum, x| sum + x);
        let mut ledger = Ledger {
            friction: self.state.contact_sums.friction,
            external_work: self.state.contact_sums.work
                + self.state.gravity_work
                + loads::work(&self.state.loads)
                + self.state.joints.iter().chain(&self.state.springs).map(|joint| joint.work).sum::<f64>()
                + self.state.written.iter().fold(0.0, |sum, written| sum + written.energy)
                - removed(&|removed| removed.energy),
            adhesion: self.state.contact_sums.adhesion,
            damping: self.state.damping,
            impacts: self.state.impacts,
            scaled_impulses: self.state.contact_sums.scaled,
            unsettled_nodes: self.state.contact_sums.unsettled,
            plastic: removed(&|removed| removed.plastic),
            removed_mass: removed(&|removed| removed.mass),
            removed_energy: removed(&|removed| removed.energy),
            removed_momentum: [0, 1, 2].map(|i| removed(&|removed| removed.momentum[i])),
            removed_angular_momentum: [0, 1, 2].map(|i| removed(&|removed| removed.angular_momentum[i])),
            half_step: self.work_of_half_a_step(),
            ..Ledger::default()
        };
        let gravity = Vector::<T, D>::of(self.settings.gravity.constant().unwrap_or_default()).space();
        let all = self.totals();
        for motion in self.state.bodies.iter().filter_map(|body| body.motion.as_deref()) {
            let Some(free) = motion.as_free() else { continue };
            ledger.kinetic += free.kinetic();
            ledger.potential -= free.mass * dot(gravity, motion.center);
            ledger.momentum = add(ledger.momentum, free.state.momentum);
            let orbit = cross(motion.center, free.state.momentum);
            ledger.angular_momentum = add(ledger.angular_momentum, add(orbit, free.state.angular_momentum));
        }
        for (_, totals) in all.iter().filter(|(body, _)| !self.state.bodies[*body].is_rigid()) {
            ledger.kinetic += totals.kinetic;
            ledger.strain += totals.strain;
            ledger.plastic += totals.plastic;
            ledger.potential -= dot(gravity, totals.first_moment);
            ledger.momentum = add(ledger.momentum, totals.momentum);
            ledger.angular_momentum = add(ledger.angular_momentum, totals.angular_momentum);
        }
        ledger.total = ledger.kinetic
            + ledger.strain
            + ledger.potential
            + ledger.friction
            + ledger.adhesion
            + ledger.plastic
            + ledger.damping
            - ledger.external_work;
        // The first rank knows the totals of all bodies.
        self.first_says(ledger)
    }

    fn relaxation(&self) -> Option<RelaxationState> {
        let RelaxationProgress { residual, peaks, at_rest, .. } = self.state.relaxation;
        self.settings.time.relax.map(|_| RelaxationState { residual, peaks, at_rest })
    }

    fn contact_sums(&self) -> Vec<ContactSum> {
        self.state.contact_sums.sums()
    }

    fn loads(&self) -> Vec<LoadState> {
        let state = |(load, sums): (&LoadPoints, &LoadSums)| LoadState {
            impulse: sums.impulse,
            moment: sums.moment,
            work: sums.work,
            displacement: self.load_displacement(load),
        };
        self.settings.loads.iter().zip(&self.state.loads).map(state).collect()
    }

    fn joints(&self) -> Vec<JointState> {
        let state = |sums: &JointSums| JointState {
            impulse: sums.impulse,
            moment: sums.moment,
            way: sums.way,
            speed: sums.speed,
            work: sums.work,
        };
        self.state.joints.iter().chain(&self.state.springs).map(state).collect()
    }

    fn walls(&self) -> Vec<WallState> {
        let bodies = self.state.bodies.len();
        let sums = self.state.walls.iter().enumerate().filter(|(_, sums)| **sums != WallSums::default());
        let state = |(i, sums): (usize, &WallSums)| {
            let wall = &self.settings.walls[i / bodies];
            let (upper, body) = (wall.inward < 0, i % bodies);
            WallState { axis: wall.axis, upper, body, impulse: sums.impulse, moment: sums.moment }
        };
        sums.map(state).collect()
    }

    fn patches(&self) -> Vec<ContactPatch> {
        self.state.contact_sums.patches()
    }

    fn contact_points(&self) -> Vec<ContactPoint> {
        self.pressed_points()
    }

    fn removed(&self) -> Vec<RemovedParticles> {
        let mut all = self.state.removed.clone();
        let count = if self.removes_leavers() { self.state.bodies.len() } else { 0 };
        all.resize(count, RemovedParticles::default());
        all
    }

    fn written(&self) -> Vec<WrittenValues> {
        self.state.written.clone()
    }

    fn poses(&self) -> Vec<Option<Pose>> {
        self.state.bodies.iter().map(|body| body.motion.as_deref().map(RigidMotion::pose)).collect()
    }

    fn snapshot(&self) -> ParticleSnapshot {
        self.snapshot_of(&SnapshotRows::of(self.shown()))
    }

    fn snapshot_between(&self, ends: [(u32, u32); 2], wanted: &dyn Fn(u32, u32) -> bool) -> ParticleSnapshot {
        self.snapshot_of(&SnapshotRows::between(self.shown(), ends, wanted))
    }

    fn visit(&self, body: usize, look: &mut dyn FnMut(&ParticleView)) {
        self.shown()[body].particles.iter().for_each(|particle| look(&shown(&particle)));
    }

    fn fastest(&self, body: usize, against: [f64; 3]) -> Option<ParticleView> {
        let Fastest { particle, .. } = fastest_motion(self.shown(), body, against)?;
        Some(shown(&self.state.bodies[body].particles.get(particle)))
    }

    fn columns(&self, body: usize) -> Vec<ColumnDescription> {
        self.state.bodies[body].particles.described().map(|(_, column)| column).collect()
    }

    fn column(&self, body: usize, name: &str) -> Result<ColumnRef<'_>, NoColumn> {
        let particles = &self.shown()[body].particles;
        let found = particles.column(name);
        let (described, components) = found.ok_or_else(|| NoColumn::among(&self.columns(body), name))?;
        let at =
            move |row: usize, component: usize| components[component].map_or(0.0, |line| line[row].f64());
        Ok(ColumnRef::new(described, particles.numbers(), at))
    }

    fn column_place(&self, body: usize, name: &str) -> Option<ColumnPlace> {
        if self.without_bounds(body).is_some() || self.removes_leavers() || self.among.is_some() {
            None
        } else {
            self.shown()[body].particles.column_place(name)
        }
    }

    fn trace(&self, body: usize, wanted: &[u32]) -> Vec<TracedParticle> {
        let particles = &self.shown()[body].particles;
        let lattice = &self.settings.lattice;
        let traced = |i: usize| {
            let particle = particles.get(i);
            TracedParticle {
                number: particle.number,
                half_width: particle.half_width.f64(),
                half_side: (lattice.seen_half_side(particle.half_width) * lattice.cell).f64(),
                position: particle.position.space(),
                velocity: particle.velocity.space(),
                deformation: particle.deformation.0.map(|row| row.map(Real::f64)),
            }
        };
        let numbers = particles.numbers().iter().enumerate();
        let is_wanted = |&(_, number): &(usize, &u32)| wanted.binary_search(number).is_ok();
        let mut all: Vec<_> = numbers.filter(is_wanted).map(|(i, _)| traced(i)).collect();
        all.sort_unstable_by_key(|particle| particle.number);
        all
    }

    fn grid_snapshot(&self) -> GridSnapshot {
        let mut snapshot =
            GridSnapshot { dimension: D, cell: self.settings.lattice.cell.f64(), ..GridSnapshot::default() };
        let mut impulse = vec![[0.0; 3]; self.workspace.field.nodes.len()];
        let [first, second, _] = &self.workspace.impulses;
        let first = first.iter().filter(|impulse| impulse.span == Span::EachUse);
        for contact in first.chain(second.iter()) {
            for (node, on_body) in contact.nodes.into_iter().zip(contact.change.impulse) {
                impulse[node] = add(impulse[node], on_body.space());
            }
        }
        let n = nodes_per_block(D);
        for (slot, &(body, block)) in self.workspace.active.slots.iter().enumerate() {
            for local in 0..n {
                let node = &self.workspace.field.nodes[slot * n + local];
                let place = node_at(block, local);
                let shown = self.workspace.active.books(block) && !self.workspace.boundary.is_mirrored(place);
                if shown && node.mass > T::ZERO {
                    snapshot.body.push(body);
                    snapshot.position.push(self.settings.lattice.position(place).space());
                    snapshot.mass.push(node.mass.f64());
                    snapshot.velocity.push(node.velocity.space());
                    snapshot.force.push(node.force.space());
                    snapshot.contact_impulse.push(impulse[slot * n + local]);
                }
            }
        }
        GridSnapshot::merged(vec![snapshot])
    }

    fn timings(&self) -> Vec<(&'static str, f64)> {
        self.watch.seconds()
    }

    fn shares(&self) -> Vec<RankShare> {
        self.among.iter().map(|among| among.share(self.particles())).collect()
    }
}
