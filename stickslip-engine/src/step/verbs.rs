//! The verbs of the step: what each does to a node, and which pass it makes over the particles.
//!
//! What a pass does to a particle is written in `pass/group.rs`, what a verb does to a node in [`Node`].

use super::Engine;
use super::build::spin;
use super::mechanism::Coupling;
use super::state::{Disorder, Settings, Workspace};
use crate::Kernels;
use crate::body::Body;
use crate::clock::signal_speed;
use crate::contact::{ContactUse, Near, Solve, TimeStep};
use crate::door::StepError;
use crate::grid::{Blocks, Disjoint, Lattice, Node, locate, node_at, nodes_per_block};
use crate::lanes::{Laned, Processor};
use crate::particles::{ColumnStart, spin_entries};
use crate::pass::{FaultKind, FaultReport, Found, ParticleFault, ParticleLoop, Pass, Verbs};
use crate::tensor::{Matrix, Vector, cross};
use crate::threads::{each, each_of};
use crate::transfer::{SETTLES_EVERY, Share, begin_filter, end_filter, filter_once_more, filters, settles};
use std::time::Instant;

/// Bodies that a thread takes at a time.
const BODIES: usize = 16;

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Brings the cell lists of the particles up to date, and with them the blocks of nodes that bodies have.
    pub(super) fn find_active_blocks(&mut self) {
        let mut start = Instant::now();
        self.rebalance();
        let (bodies, lattice) = (&self.state.bodies, &self.settings.lattice);
        let left = self.workspace.listed.then_some(&self.workspace.left[..]);
        let idle = self.needs_no_grid();
        let references = &self.settings.references;
        let apart = |body: usize| references.binary_search_by_key(&body, |reference| reference.body).is_ok();
        let count = |body: usize| if idle || apart(body) { 0 } else { bodies[body].particles.len() };
        let reach = self.kernels.width as i32 - 1;
        let base = |body: usize, particle: usize| {
            (self.kernels.home)(lattice, bodies[body].particles.place(particle))
        };
        let number = |body: usize, particle: usize| bodies[body].particles.numbers()[particle];
        let blocks = if self.among.is_some() {
            let lost = |block: [i32; D]| self.among.as_ref().is_some_and(|among| among.has_lost(block));
            let (all, looks) = ((bodies.len(), count, reach), (base, number));
            self.workspace.active.find_movers(all, left, looks, lost);
            let blocks = self.cross_borders();
            let blocks = blocks.max(self.spread(blocks));
            self.watch.lap("blocks", start);
            start = Instant::now();
            let blocks = self.cover_blocks(blocks);
            self.watch.lap("borders", start);
            start = Instant::now();
            blocks
        } else {
            let blocks = self.workspace.active.update((bodies.len(), count, reach), left, (base, number));
            blocks.max(self.spread(blocks))
        };
        if !idle {
            self.sort_particles();
        }
        if self.among.is_some() {
            self.watch.lap("blocks", start);
            start = Instant::now();
            self.dismiss_guests();
        }
        let Workspace { active, field, boundary, left, moved, damped, listed, .. } = &mut self.workspace;
        if blocks == Blocks::New {
            boundary.find_nodes(active);
        }
        let tiles = active.tiles.len();
        left.clear();
        left.resize(tiles, 0);
        moved.clear();
        moved.resize(tiles, 0);
        damped.clear();
        damped.resize(tiles, 0.0);
        *listed = true;
        field.clear(active);
        self.watch.lap("blocks", start);
    }

    /// Bodies that may have particles here, in their order.
    pub(super) fn bodies_here(&self) -> impl Iterator<Item = usize> {
        let Workspace { active, listed, .. } = &self.workspace;
        let count = if *listed { active.here().len() } else { self.state.bodies.len() };
        (0..count).map(|place| if *listed { active.here()[place] as usize } else { place })
    }

    /// Whether no body deforms on the common grid, and nothing acts on parts of rigid ones: they move without a grid.
    pub(super) fn needs_no_grid(&self) -> bool {
        self.settings.rigid.len() + self.settings.references.len() == self.state.bodies.len()
            && self.settings.loads.iter().all(|load| self.reference_of(load.body).is_some())
            && self.settings.springs.iter().all(|spring| {
                spring.ends.iter().any(|end| self.reference_of(end.body).is_some())
                    || spring.ends.iter().all(|end| {
                        let prescribed = self.state.bodies[end.body].motion.as_ref();
                        prescribed.is_some_and(|motion| motion.as_free().is_none())
                    })
            })
    }

    /// Sorts particles in memory into the order in which tiles visit them,
    /// where disorder has cost as much as that does.
    fn sort_particles(&mut self) {
        let Workspace { active, disorder, .. } = &mut self.workspace;
        let unknown = self.state.bodies.iter().skip(disorder.len());
        disorder.extend(unknown.map(|body| Disorder::any(body.particles.len())));
        let costly = |body: usize, count: usize| disorder[body].is_costly(count);
        each_of(&mut self.state.bodies, active.here(), BODIES, |i, body| {
            if costly(i, body.particles.len()) {
                body.particles.permute(active.order_of(i));
            }
        });
        for place in 0..active.here().len() {
            let body = active.here()[place] as usize;
            if disorder[body].is_costly(self.state.bodies[body].particles.len()) {
                disorder[body] = Disorder::default();
                active.tidied(body);
            }
        }
    }

    /// Counts the particles that changed their cells in the step.
    pub(super) fn count_disorder(&mut self) {
        let Workspace { disorder, moved, active, .. } = &mut self.workspace;
        for body in active.here().iter().map(|&body| body as usize) {
            let moved = &moved[active.tiles_of_body(body)];
            disorder[body].add(moved.iter().map(|&moved| moved as usize).sum());
        }
    }

    /// P2G: the particles' share in the nodes.
    pub(super) fn particles_to_grid(&mut self, share: Share) {
        if share.has_force() && self.settings.averages_volume {
            self.scatter(Share::Mass);
            self.workspace.field.find_present(|_| {});
            self.average_mean_stress();
            self.scatter(Share::Force);
        } else {
            self.scatter(share);
        }
    }

    /// The pass that gives a share to the nodes.
    pub(super) fn scatter(&mut self, share: Share) {
        let verbs = Verbs { scatter: Some(share), ..Verbs::default() };
        self.run_pass("P2G", verbs, T::ZERO).expect("a scatter changes no particle");
    }

    /// G2P and P2G of momentum:
    ///
    /// ```text
    /// v_p = (1 - a) (v_p + sum S_i (v_i - v_i^0)) + a sum S_i v_i,   a: PIC share; the particle's rotation likewise
    /// ```
    pub(super) fn update_particle_velocities(&mut self, dt: T) -> Result<(), StepError> {
        let verbs = Verbs { update_velocity: true, scatter: Some(Share::Momentum), ..Verbs::default() };
        self.run_pass("velocity update", verbs, dt)
    }

    /// G2P of velocity gradients, and P2G of forces:  F = (I + L dt) F,  sigma = law(F),  f = -sum V sigma grad S
    pub(super) fn update_stress(&mut self, dt: T) -> Result<(), StepError> {
        let averages = self.settings.averages_volume;
        let scatter = (!averages && !self.has_laws_over_arrays()).then_some(Share::Force);
        self.run_pass("stress update", Verbs { update_stress: true, scatter, ..Verbs::default() }, dt)?;
        self.respond_together(dt)?;
        if averages {
            self.average_mean_stress();
        }
        if scatter.is_none() {
            self.scatter(Share::Force);
        }
        Ok(())
    }

    /// G2P:  v_p += dv,  x += v dt
    pub(super) fn update_velocities_and_positions(&mut self, dt: T) -> Result<(), StepError> {
        self.run_pass("advection", Verbs { update_velocity: true, advect: true, ..Verbs::default() }, dt)
    }

    /// G2P:  v_p += dv,  F = (I + L dt) F,  sigma = law(F),  x += v dt
    pub(super) fn update_particles(&mut self, dt: T) -> Result<(), StepError> {
        self.run_pass(
            "stress update",
            Verbs { update_velocity: true, update_stress: true, advect: true, ..Verbs::default() },
            dt,
        )?;
        self.respond_together(dt)
    }

    /// G2P:  F = (I + L dt) F,  sigma = law(F),  x += v dt
    pub(super) fn update_stress_and_positions(&mut self, dt: T) -> Result<(), StepError> {
        self.run_pass("stress update", Verbs { update_stress: true, advect: true, ..Verbs::default() }, dt)?;
        self.respond_together(dt)
    }

    pub(super) fn run_pass(&mut self, name: &'static str, verbs: Verbs, dt: T) -> Result<(), StepError> {
        let start = Instant::now();
        let settles = verbs.update_stress && settles(self.settings.transfer);
        let now = (self.state.steps % SETTLES_EVERY + self.state.phase).is_multiple_of(SETTLES_EVERY);
        let verbs = Verbs { settle: settles && now, ..verbs };
        let found = self.pass(&Pass {
            verbs,
            dt,
            transfer: self.settings.transfer,
            pic: self.settings.pic_share,
            viscosity: self.settings.viscosity,
            lattice: self.settings.lattice,
            domain: self.settings.held.filter(|_| !self.removes_leavers()),
        });
        if verbs.update_velocity || verbs.update_stress {
            let Workspace { sums, damped, .. } = &mut self.workspace;
            damped.iter().for_each(|&damped| sums.damped().add(damped));
        }
        if verbs.advect {
            self.state.signal = Some(found.signal.f64());
        }
        if let Some(share) = verbs.scatter {
            self.workspace.boundary.add_images(&mut self.workspace.field, share);
        }
        self.watch.lap(name, start);
        self.judge(found.fault)
    }

    /// v = p / m, and v^0 = v, of nodes that have mass; with XPIC v(m) beside it, see [`crate::transfer::Xpic`].
    pub(super) fn interpolate_velocities(&mut self) {
        let start = Instant::now();
        self.workspace.field.find_present(Node::begin);
        self.workspace.boundary.count(true);
        self.watch.lap("grid", start);
        if filters(self.settings.transfer) {
            self.filter_velocities();
        }
    }

    /// v(m) of the interpolated velocities.
    fn filter_velocities(&mut self) {
        self.workspace.field.each_filtered(begin_filter);
        for _ in 1..self.settings.time.xpic_order {
            let verbs = Verbs { smooth: true, scatter: Some(Share::Momentum), ..Verbs::default() };
            self.run_pass("P2G", verbs, T::ZERO).expect("it changes no particle");
            self.workspace.field.each_filtered(filter_once_more);
        }
        self.workspace.field.each_present(end_filter);
    }

    /// v = p / m of the particles' new velocities.
    pub(super) fn interpolate_again(&mut self) {
        self.at_nodes("grid", Node::divide_by_mass);
        self.workspace.boundary.count(false);
    }

    /// v += dt (f / m + g)
    pub(super) fn update_velocities(&mut self, dt: T) {
        let gravity = self.gravity(dt);
        self.at_nodes("grid", |node| node.accelerate(gravity, dt));
    }

    /// Keeps the nodes' velocities, for the particles to take later: in USL those whose change they take, in USF those
    /// that strained them and move them.
    pub(super) fn keep_velocities(&mut self) {
        self.at_nodes("grid", Node::keep);
    }

    /// Keeps the nodes' velocities, whose change the particles take, and makes room for the momentum of the second P2G.
    pub(super) fn keep_velocities_and_clear_momentum(&mut self) {
        self.at_nodes("grid", Node::keep_and_clear);
    }

    /// Takes the velocities that were kept, and keeps those of now, whose change the particles take.
    pub(super) fn exchange_velocities(&mut self) {
        self.at_nodes("grid", Node::exchange);
    }

    /// Does something to each node that has mass.
    fn at_nodes(&mut self, name: &'static str, f: impl Fn(&mut Node<T, D>) + Sync) {
        let start = Instant::now();
        self.workspace.field.each_present(f);
        self.watch.lap(name, start);
    }

    /// Damps the velocities whose change the particles take, see [`crate::damping`]; what mirrors repeat, too.
    pub(super) fn damp(&mut self, dt: T) {
        let damping = self.settings.damping.with_viscous(self.relaxing_rate(dt));
        if !damping.acts() {
            return;
        }
        let start = Instant::now();
        let Workspace { field, damping_impulses, .. } = &mut self.workspace;
        field.each_with((damping_impulses, Vector::ZERO), |node, impulse| damping.act(node, impulse, dt));
        self.watch.lap("damping", start);
    }

    /// Sets the velocities that rigid bodies and walls prescribe.
    pub(super) fn impose_boundary_conditions(&mut self) {
        let start = Instant::now();
        let n = nodes_per_block(D);
        let Workspace { active, field, boundary, .. } = &mut self.workspace;
        for body in active.here().iter().map(|&body| body as usize) {
            let Some(motion) = &self.state.bodies[body].motion else { continue };
            for slot in active.slots_of_body(body) {
                let (_, block) = active.slots[slot];
                for local in 0..n {
                    let position = self.settings.lattice.position_near(node_at(block, local), motion.center);
                    field.nodes[slot * n + local].prescribe(motion.velocity_at(position));
                }
            }
        }
        boundary.impose(field);
        self.watch.lap("grid", start);
    }

    /// Where bodies meet: surfaces, normals and gaps at the nodes that they share; `ahead` how long they still move
    /// before contact acts on them [s].
    pub(super) fn detect_contact(&mut self, ahead: Option<T>) {
        let mut start = Instant::now();
        if self.among.is_some() {
            self.invite_guests(self.guests_show(ahead.is_some()));
            self.watch.lap("guests", start);
            start = Instant::now();
        }
        let near = Near {
            active: &self.workspace.active,
            bodies: &self.state.bodies,
            field: &self.workspace.field,
            lattice: self.settings.lattice,
            boundary: &self.workspace.boundary,
            rules: &self.settings.rules,
            ahead,
            time: self.state.time,
            kernels: self.kernels,
            processor: match self.settings.path {
                ParticleLoop::Lanes(processor) => processor,
                _ => Processor::Any,
            },
        };
        near.survey(&mut self.workspace.survey);
        self.watch.lap("contact detection", start);
    }

    /// Contact on the interpolated velocities. Where these strain the particles all laws act; else only laws that judge
    /// each use of contact by itself ([`crate::contact::Span::EachUse`]), as the paper's do.
    pub(super) fn contact_on_interpolated(&mut self, dt: T, purpose: ContactUse) {
        if purpose == ContactUse::Strain || self.settings.rules.judge_interpolated() {
            self.apply_contact(dt, (0, purpose));
        }
    }

    /// Contact on the integrated velocities, after what it gave to the interpolated ones.
    pub(super) fn contact_on_integrated(&mut self, dt: T) {
        self.apply_contact(dt, (1, ContactUse::VelocityChange));
    }

    /// Contact on the velocities that strain and move the particles. It enters no sum of forces and no sum of works,
    /// for no particle takes it as a change of its velocity.
    pub(super) fn contact_on_straining(&mut self, dt: T) {
        self.apply_contact(dt, (2, ContactUse::Strain));
    }

    /// The first, second or third contact of a step, and what for.
    fn apply_contact(&mut self, duration: T, (number, purpose): (usize, ContactUse)) {
        let start = Instant::now();
        let Workspace { impulses, survey, field, boundary, mechanism, active, .. } = &mut self.workspace;
        let (before, listed) = impulses.split_at_mut(number);
        let (given, listed) = ((number == 1).then(|| &before[0]), &mut listed[0]);
        let step = TimeStep { duration, cell: self.settings.lattice.cell, purpose };
        let nodes = Disjoint::new(&mut field.nodes);
        let (rules, free) = (&self.settings.rules, &self.settings.free[..]);
        let solve = Solve { survey, rules, nodes, step, given, free };
        if number == 2 || mechanism.bodies.is_empty() {
            solve.impulses(listed);
        } else {
            let (joints, surfaces) = match number {
                1 => (&self.settings.joints[..], Some(&self.settings.surfaces)),
                _ => (&[][..], None),
            };
            let ranks = self.among.as_ref().map(|among| &*among.ranks);
            let lattice = &self.settings.lattice;
            let coupling = Coupling { solve, lattice, joints, surfaces, active, ranks };
            let settled = coupling.settle(&mut self.state.bodies, mechanism, listed);
            self.state.contact_sums.unsettled += u64::from(!settled);
        }
        boundary.impose(field);
        let listed = &self.workspace.impulses[number];
        let active = &self.workspace.active;
        let unsettled = listed.unsettled().filter(|&&node| active.books(locate(node).0)).count();
        self.workspace.sums.unsettled().add(unsettled as f64);
        if number == 2 {
            self.count_pushes();
        }
        self.watch.lap("contact", start);
    }

    /// Moves rigid bodies by the velocities that they have.
    pub(super) fn move_rigid_bodies(&mut self, dt: T) -> Result<(), StepError> {
        let start = Instant::now();
        let is_listed = !self.needs_no_grid();
        let Settings { lattice, held, rigid, .. } = &self.settings;
        let (bodies, unbounded) = (Disjoint::new(&mut self.state.bodies), &self.state.unbounded);
        let (room, kernels) = (&mut self.workspace.displaced, self.kernels);
        room.clear();
        room.resize(rigid.len(), None);
        each(room, BODIES, |place, displaced| {
            let i = rigid[place];
            // One without bounds is everywhere: its particles stand for what the others are near.
            let domain = held.filter(|_| !unbounded.iter().any(|unbounded| unbounded.body == i));
            // SAFETY: every body is listed once.
            let body = unsafe { bodies.get(i) };
            *displaced = move_rigid_body(kernels, (i, body, is_listed), (lattice, domain), dt);
        });
        let mut found = Found { signal: T::of(self.state.signal.unwrap_or(0.0)), ..Found::NOTHING };
        for (&i, displaced) in rigid.iter().zip(&self.workspace.displaced) {
            let Some((of_body, moved_on)) = displaced else { continue };
            found = found.and(*of_body);
            let tiles = self.workspace.active.tiles_of_body(i);
            self.workspace.left[tiles.clone()].fill(u64::MAX);
            if let [first, ..] = &mut self.workspace.moved[tiles] {
                *first = *moved_on;
            }
        }
        self.state.signal = Some(found.signal.f64());
        self.watch.lap("rigid", start);
        self.judge(found.fault)
    }

    /// What the step makes of a fault: an error, or where there are other ranks a note, for all of them to end the step
    /// together.
    pub(super) fn judge(&mut self, fault: Option<ParticleFault>) -> Result<(), StepError> {
        let report = fault.map(|fault| self.report(&fault));
        if let Some(among) = &mut self.among {
            among.take_note(report);
            return Ok(());
        }
        report.map_or(Ok(()), |report| Err(self.error(&report)))
    }

    /// What there is to say of a fault.
    pub(super) fn report(
        &self,
        &ParticleFault { body, particle, number, kind }: &ParticleFault,
    ) -> FaultReport {
        let particle = self.state.bodies[body].particles.get(particle);
        let determinant = particle.deformation.det().f64();
        FaultReport { body, number, kind, position: particle.position.space(), determinant }
    }

    /// The error that a fault is.
    pub(super) fn error(&self, report: &FaultReport) -> StepError {
        let &FaultReport { body, number, kind, position, determinant } = report;
        let (body, time) = (self.name_of(body).to_string(), self.state.time);
        match kind {
            FaultKind::Inverted => StepError::Inverted { body, number, position, time, determinant },
            FaultKind::Escaped => {
                StepError::Escaped { bounded: self.settings.domain.is_some(), body, number, position, time }
            }
            FaultKind::NoThickness => StepError::NoThickness { body, number, position, time },
            FaultKind::NotFinite => StepError::NotFinite { body, number, position, time },
            FaultKind::Shrunk => StepError::Shrunk { body, number, position, time },
        }
    }
}

/// Turns the deformations of a body's particles on by the rotation of a step, and gives all of them a spin.
fn turn_particles<T: Laned, const D: usize>(body: &mut Body<T, D>, turn: &Matrix<T>, spin: Vector<T, 3>) {
    for k in 0..spin_entries(D) {
        body.particles.line_mut(ColumnStart::<D>::SPIN + k).fill(spin[3 - spin_entries(D) + k]);
    }
    let (count, columns) = (body.particles.len(), body.particles.open());
    for column in 0..D {
        let row = |row: usize| ColumnStart::<D>::DEFORMATION + D * row + column;
        for p in 0..count {
            // SAFETY: the particle exists, and nobody else uses it.
            let at = |i: usize| unsafe { columns.at(row(i), p) };
            // SAFETY: as above.
            let of = |i: usize| if i < D { unsafe { *at(i) } } else { T::ZERO };
            let before = [of(0), of(1), of(2)];
            for i in 0..D {
                let [a, b, c] = turn.0[i];
                let after = a.times_plus(before[0], b.times_plus(before[1], c * before[2]));
                // SAFETY: as above.
                unsafe { *at(i) = after };
            }
        }
    }
    if D == 2 {
        body.particles
            .line_mut(ColumnStart::<D>::DEFORMATION + 4)
            .iter_mut()
            .for_each(|f| *f = turn.0[2][2] * *f);
    }
}

/// Moves a body, if it is rigid, with its particles; says what it found, and how many of them changed their cells.
fn move_rigid_body<T: Laned, const D: usize>(
    kernels: &Kernels<T, D>,
    (number, body, is_listed): (usize, &mut Body<T, D>, bool),
    (lattice, domain): (&Lattice<T, D>, Option<[Vector<T, D>; 2]>),
    dt: T,
) -> Option<(Found<T>, u32)> {
    // Taken out while the particles change, and put back moved on.
    let mut motion = body.motion.take()?;
    let dt = dt.f64();
    let rotation = motion.rotation(dt);
    let turn = Matrix::from_fn(|i, j| T::of(rotation.0[i][j]));
    turn_particles(body, &turn, spin::<T, D>(motion.spin()));
    let (center, velocity, spin) = (motion.center, motion.velocity(), motion.spin());
    let (mut fastest, mut moved_on, mut lost) = (T::ZERO, 0, Vec::new());
    let mut bounds = [Vector([T::of(f64::INFINITY); D]), Vector([T::of(f64::NEG_INFINITY); D])];
    let (count, columns) = (body.particles.len(), body.particles.open());
    for p in 0..count {
        // SAFETY: the particle exists, and nobody else uses it.
        let at = |column: usize, k: usize| unsafe { columns.at(column + k, p) };
        // SAFETY: as above.
        let start = Vector::<T, D>::from_fn(|k| unsafe { *at(ColumnStart::<D>::POSITION, k) });
        let arm: [f64; 3] = std::array::from_fn(|k| if k < D { start[k].f64() } else { 0.0 } - center[k]);
        let swing = cross(spin, arm);
        let (mut moved, mut speed) = (start, T::ZERO);
        for k in 0..D {
            let [a, b, c] = rotation.0[k];
            moved[k] = T::of(center[k] + velocity[k] * dt + (a * arm[0] + b * arm[1] + c * arm[2]));
            let v = T::of(velocity[k] + swing[k]);
            // SAFETY: as above.
            unsafe { *at(ColumnStart::<D>::VELOCITY, k) = v };
            bounds[0][k] = bounds[0][k].min(moved[k]);
            bounds[1][k] = bounds[1][k].max(moved[k]);
            speed += v * v;
        }
        // What has no place any more is told where it was.
        if !moved.is_finite() {
            lost.push(p);
            continue;
        }
        for k in 0..D {
            // SAFETY: as above.
            unsafe { *at(ColumnStart::<D>::POSITION, k) = moved[k] };
        }
        fastest = fastest.max(speed);
        // Without a grid there are no lists of cells.
        if is_listed {
            let home = |place| (kernels.home)(lattice, (place, body.particles.half_width(p)));
            moved_on += u32::from(home(moved) != home(start));
        }
    }
    // No wave runs in a rigid body.
    let mut found = Found { fault: None, signal: signal_speed([T::ZERO, fastest]) };
    let escapes =
        |corner: &Vector<T, D>| kernels.escaped((*corner, body.particles.half_width(0)), lattice, domain);
    if !lost.is_empty() || count > 0 && bounds.iter().any(escapes) {
        for p in 0..count {
            let place = body.particles.place(p);
            let kind = if lost.binary_search(&p).is_ok() {
                Some(FaultKind::NotFinite)
            } else {
                kernels.escaped(place, lattice, domain).then_some(FaultKind::Escaped)
            };
            let own = body.particles.numbers()[p];
            let fault = kind.map(|kind| ParticleFault { body: number, particle: p, number: own, kind });
            found = found.and(Found { fault, ..Found::NOTHING });
        }
    }
    motion.advance(&rotation, dt);
    body.motion = Some(motion);
    Some((found, moved_on))
}
