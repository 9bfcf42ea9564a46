//! The engine behind its door: what others may see of it, and the step that they may ask for.

use super::Engine;
use super::relax::Relaxation;
use super::state::Workspace;
use crate::basis::Basis;
use crate::body::{Body, Totals};
use crate::boundary::Boundary;
use crate::column::{ColumnDescription, Kind};
use crate::contact::Span;
use crate::door::{
    BodyState, ContactPatch, ContactSum, GridSnapshot, Ledger, ParticleSnapshot, ParticleView,
    RelaxationState, Simulation, SnapshotColumn, StepError, TracedParticle, View,
};
use crate::grid::{node_at, nodes_per_block};
use crate::lanes::Laned;
use crate::particles::{ColumnStart, Columns};
use crate::tensor::{Real, Vector};
use crate::threads::by_parts;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::{Arc, PoisonError};

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + b[i])
}

impl<T: Laned, const D: usize, B: Basis<T>> Engine<T, D, B> {
    /// What the particles of each body add up to, summed once a step for whoever asks.
    pub(super) fn totals(&self) -> Arc<[Totals]> {
        let mut known = self.workspace.totals.lock().unwrap_or_else(PoisonError::into_inner);
        let sum = |range: Range<usize>| Body::totals(&self.state.bodies[range.start]);
        known.get_or_insert_with(|| by_parts(self.state.bodies.len(), 1, sum).into()).clone()
    }

    /// Where the columns of this name begin in each body, if it has them.
    fn places_of(&self, name: &str, kind: Kind) -> Vec<Option<(usize, Columns<T, D>)>> {
        let of_body = |body: &Body<T, D>| {
            let mut columns = body.particles.described();
            let found = columns.find(|(_, column)| column.name == name && column.kind == kind);
            found.map(|(first, _)| (first, body.particles.view()))
        };
        self.state.bodies.iter().map(of_body).collect()
    }

    /// A column of all particles, given by body and place in memory: the components in space,
    /// and zeros where a body has no such column.
    fn column<const N: usize>(&self, rows: &[[u32; 2]], (name, kind): (&str, Kind)) -> Vec<[f64; N]> {
        let places = self.places_of(name, kind);
        let of_row = |&[body, place]: &[u32; 2]| {
            let mut values = [0.0; N];
            if let Some((first, columns)) = &places[body as usize] {
                for entry in 0..kind.entries(D) {
                    // SAFETY: the particle is the body's, which is borrowed for reading.
                    let value = unsafe { *columns.at(first + entry, place as usize) };
                    values[kind.place(D, entry)] = value.f64();
                }
            }
            values
        };
        rows.par_iter().map(of_row).collect()
    }

    /// A column of one component.
    fn numbers(&self, rows: &[[u32; 2]], name: &str) -> Vec<f64> {
        self.column::<1>(rows, (name, Kind::Number)).into_flattened()
    }

    /// What the laws of the bodies remember: what two laws call alike is one column.
    fn remembered(&self, rows: &[[u32; 2]]) -> Vec<SnapshotColumn> {
        let mut declared: Vec<ColumnDescription> = Vec::new();
        for history in self.state.bodies.iter().flat_map(|body| body.particles.history()) {
            if !declared
                .iter()
                .any(|known| (known.name, known.kind) == (history.column.name, history.column.kind))
            {
                declared.push(history.column);
            }
        }
        let column = |ColumnDescription { name, unit, kind }| SnapshotColumn {
            name: String::from(name),
            unit: String::from(unit),
            kind,
            values: match kind {
                Kind::Number => self.numbers(rows, name),
                Kind::Vector | Kind::Rotation => self.column::<3>(rows, (name, kind)).into_flattened(),
                Kind::Symmetric => self.column::<6>(rows, (name, kind)).into_flattened(),
                Kind::Tensor => self.column::<9>(rows, (name, kind)).into_flattened(),
            },
        };
        declared.into_iter().map(column).collect()
    }
}

impl<T: Laned, const D: usize, B: Basis<T>> View for Engine<T, D, B> {
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

    fn bodies(&self) -> Vec<BodyState> {
        let all = self.totals();
        (self.state.bodies.iter().enumerate())
            .map(|(i, body)| {
                if let Some(motion) = self.without_bounds(i) {
                    return BodyState {
                        mass: 0.0,
                        position: motion.center,
                        velocity: motion.velocity(),
                        spin: motion.spin(),
                        angular_momentum: [0.0; 3],
                        kinetic: 0.0,
                        strain: 0.0,
                    };
                }
                let totals = &all[i];
                BodyState {
                    mass: totals.mass,
                    position: totals.first_moment.map(|x| x / totals.mass),
                    velocity: totals.momentum.map(|p| p / totals.mass),
                    spin: body.spin(totals),
                    angular_momentum: totals.angular_momentum,
                    kinetic: totals.kinetic,
                    strain: totals.strain,
                }
            })
            .collect()
    }

    fn ledger(&self) -> Ledger {
        let mut ledger = Ledger {
            friction: self.state.contact_sums.friction,
            external_work: self.state.contact_sums.work,
            adhesion: self.state.contact_sums.adhesion,
            damping: self.state.damping,
            scaled_impulses: self.state.contact_sums.scaled,
            unsettled_nodes: self.state.contact_sums.unsettled,
            ..Ledger::default()
        };
        let gravity = self.settings.gravity.space();
        let all = self.totals();
        for (_, totals) in self.state.bodies.iter().zip(&*all).filter(|(body, _)| !body.rigid) {
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
        ledger
    }

    fn relaxation(&self) -> Option<RelaxationState> {
        let Relaxation { residual, peaks, at_rest, .. } = self.state.relaxation;
        self.settings.time.relax.map(|_| RelaxationState { residual, peaks, at_rest })
    }

    fn contact_sums(&self) -> Vec<ContactSum> {
        self.state.contact_sums.sums()
    }

    fn patches(&self) -> Vec<ContactPatch> {
        self.state.contact_sums.patches()
    }

    fn snapshot(&self) -> ParticleSnapshot {
        // By body, then by number: where each particle stands.
        let mut rows = Vec::with_capacity(self.particles());
        for (i, body) in self.state.bodies.iter().enumerate() {
            let first = rows.len();
            rows.resize(first + body.particles.len(), [i as u32, 0]);
            for (place, &number) in body.particles.numbers().iter().enumerate() {
                rows[first + number as usize][1] = place as u32;
            }
        }
        ParticleSnapshot {
            dimension: D,
            body: rows.par_iter().map(|&[body, _]| body).collect(),
            number: (self.state.bodies.iter()).flat_map(|body| 0..body.particles.len() as u32).collect(),
            position: self.column(&rows, ("position", Kind::Vector)),
            velocity: self.column(&rows, ("velocity", Kind::Vector)),
            mass: self.numbers(&rows, "mass"),
            volume: self.numbers(&rows, "volume"),
            stress: self.column(&rows, ("stress", Kind::Symmetric)),
            deformation: self.column(&rows, ("deformation", Kind::Tensor)),
            history: self.remembered(&rows),
        }
    }

    fn visit(&self, body: usize, look: &mut dyn FnMut(&ParticleView)) {
        for particle in self.state.bodies[body].particles.iter() {
            look(&ParticleView {
                number: particle.number,
                mass: particle.mass.f64(),
                position: particle.position.space(),
                velocity: particle.velocity.space(),
                stress: particle.stress.0.map(Real::f64),
            });
        }
    }

    fn starts(&self, body: usize) -> Vec<[f64; 3]> {
        let particles = &self.state.bodies[body].particles;
        let columns = particles.view();
        let mut starts = vec![[0.0; 3]; particles.len()];
        for (i, &number) in particles.numbers().iter().enumerate() {
            // SAFETY: the particle is the body's, which is borrowed for reading.
            let at = |k: usize| unsafe { *columns.at(ColumnStart::<D>::START + k, i) };
            starts[number as usize] = Vector::<T, D>::from_fn(at).space();
        }
        starts
    }

    fn trace(&self, body: usize, wanted: &(dyn Fn(u32) -> bool + Sync)) -> Vec<TracedParticle> {
        let particles = &self.state.bodies[body].particles;
        let traced = |i: usize| {
            let particle = particles.get(i);
            TracedParticle {
                number: particle.number,
                half_width: particle.half_width.f64(),
                position: particle.position.space(),
                velocity: particle.velocity.space(),
                deformation: particle.deformation.0.map(|row| row.map(Real::f64)),
            }
        };
        let numbers = particles.numbers().iter().enumerate();
        numbers.filter(|&(_, &number)| wanted(number)).map(|(i, _)| traced(i)).collect()
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
                if node.mass > T::ZERO && !self.workspace.boundary.mirrors(place) {
                    snapshot.body.push(body);
                    snapshot.position.push(self.settings.lattice.position(place).space());
                    snapshot.mass.push(node.mass.f64());
                    snapshot.velocity.push(node.velocity.space());
                    snapshot.force.push(node.force.space());
                    snapshot.contact_impulse.push(impulse[slot * n + local]);
                }
            }
        }
        snapshot
    }

    fn timings(&self) -> Vec<(&'static str, f64)> {
        self.watch.seconds()
    }
}

impl<T: Laned, const D: usize, B: Basis<T>> Simulation for Engine<T, D, B> {
    fn step(&mut self, longest: f64) -> Result<f64, StepError> {
        *self.workspace.totals.get_mut().unwrap_or_else(PoisonError::into_inner) = None;
        let dt = self.stable().min(longest);
        for motion in self.state.rigid.iter_mut().flatten() {
            motion.set_time(self.state.time + 0.5 * dt);
        }
        // One of the pool's threads takes the whole step: handing it every loop from outside would cost more than many
        // a loop.
        rayon::scope(|_| self.advance(T::of(dt)))?;
        self.count_disorder();
        self.relax();
        self.state.time += dt;
        self.state.steps += 1;
        Ok(dt)
    }

    fn rebuild_workspace(&mut self) {
        let walls = std::mem::take(&mut self.workspace.boundary.walls);
        self.workspace = Workspace::new(Boundary::new(walls));
    }
}
