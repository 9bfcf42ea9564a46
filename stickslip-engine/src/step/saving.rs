//! The state as data, and back.

use super::Engine;
use super::build::spin;
use super::state::State;
use super::unbounded::Unbounded;
use crate::basis::Basis;
use crate::body::{Body, Particle};
use crate::column::{HALF_EDGES, INITIAL_STRETCH};
use crate::door::{
    RemovedParticles, RestoreError, SavedBody, SavedColumn, SavedShare, SavedState, SavedUnbounded,
    WrittenValues,
};
use crate::geometry::ParticleSite;
use crate::lanes::Laned;
use crate::load::{LoadPoints, place_of};
use crate::particles::{ColumnStart, Particles, by_number, number_of};
use crate::scene::{ContactLaw, StartVelocities, Transfer};
use crate::tensor::{Matrix, Real, Symmetric, Vector, cross};
use crate::transfer::{SETTLES_EVERY, columns as columns_of};
use std::collections::HashMap;
use std::convert::Infallible;
use std::ops::Range;
use std::sync::Mutex;

impl<T: Laned, const D: usize, B: Basis<T>> Engine<T, D, B> {
    /// The state as data.
    pub(super) fn saved(&self) -> SavedState {
        let mut saved = self.saved_rest();
        for (saved, body) in saved.bodies.iter_mut().zip(&self.state.bodies) {
            saved.numbers = body.particles.numbers().to_vec();
            saved.columns = columns(&body.particles).collect();
        }
        saved
    }

    /// The particles of the state, body by body, at most so many at a time.
    pub(super) fn share_out(&self, most: usize, take: &mut dyn FnMut(Vec<SavedShare>)) {
        let bodies = &self.state.bodies;
        let share = |body: usize, some: Range<usize>| {
            let particles = &bodies[body].particles;
            let columns = columns_of_some(particles, some.clone()).collect();
            SavedShare { body, numbers: particles.numbers()[some].to_vec(), columns }
        };
        let mut take = |shares| {
            take(shares);
            Ok(())
        };
        let counts = bodies.iter().map(|body| body.particles.len());
        let Ok(()) = SavedShare::deal::<Infallible>(counts, most, share, &mut take);
    }

    /// The state without particles.
    pub(super) fn saved_rest(&self) -> SavedState {
        let State { time, steps, phase, signal, damping, impacts, gravity_work, relaxation, .. } = self.state;
        let bodies = self.state.bodies.iter().zip(&self.settings.filled).zip(self.counts_of_all());
        SavedState {
            time,
            steps,
            phase,
            bodies: bodies
                .map(|((body, filled), count)| SavedBody {
                    name: body.name.clone(),
                    numbers: Vec::new(),
                    columns: if count == 0 { columns(&body.particles).collect() } else { Vec::new() },
                    missing: filled.saturating_sub(count),
                    motion: body.motion.as_deref().map(|motion| motion.state()),
                })
                .collect(),
            signal,
            damping,
            impacts,
            gravity_work,
            relaxation,
            loads: self.state.loads.clone(),
            contact_sums: self.state.contact_sums.clone().in_order(),
            unbounded: self.state.unbounded.iter().map(Unbounded::saved).collect(),
            moved: self.settings.loads.iter().map(moved).collect(),
            joints: self.state.joints.clone(),
            springs: self.state.springs.clone(),
            touch_forces: self.state.touch_forces.clone(),
            walls: self.state.walls.clone(),
            longest_rigid: Some(self.state.longest_rigid).filter(|step| step.is_finite()),
            removed: self.state.removed.iter().copied().filter(|_| self.has_removed()).collect(),
            written: self.state.written.iter().copied().filter(|_| self.was_written()).collect(),
            of_snapshot: false,
        }
    }

    /// Refuses to give one of several ranks the state of all of them.
    pub(super) fn is_whole(&self) -> Result<(), RestoreError> {
        let whole = self.among.is_none();
        whole
            .then_some(())
            .ok_or_else(|| RestoreError("it is of one rank, and several share this simulation".into()))
    }

    fn has_removed(&self) -> bool {
        self.state.removed.iter().any(|removed| removed.count > 0)
    }

    fn was_written(&self) -> bool {
        self.state.written.iter().any(|written| written.count > 0)
    }

    /// Takes up a state of the same scene.
    ///
    /// # Errors
    /// It is of another scene; then nothing is changed.
    pub(super) fn take_up(&mut self, saved: SavedState) -> Result<(), RestoreError> {
        self.check_rest(&saved)?;
        let state = &self.state;
        let without_bounds = |i: usize| state.unbounded.iter().any(|unbounded| unbounded.body == i);
        let restored = (saved.bodies.iter().zip(&state.bodies).enumerate()).map(|(i, (saved, body))| {
            let filled = self.settings.filled[i];
            particles(saved, body, (!without_bounds(i)).then_some(filled))
        });
        let restored: Vec<Particles<T, D>> = restored.collect::<Result<_, _>>()?;
        for (body, particles) in self.state.bodies.iter_mut().zip(restored) {
            body.particles.become_others(particles);
        }
        self.take_up_rest(saved);
        Ok(())
    }

    /// Looks whether a state is of the same scene, but for particles.
    ///
    /// # Errors
    /// It is not.
    pub(super) fn check_rest(&self, saved: &SavedState) -> Result<(), RestoreError> {
        let state = &self.state;
        let [found, wanted] = [saved.bodies.len(), state.bodies.len()];
        if found != wanted {
            return Err(RestoreError(format!("it has {found} bodies, and the scene {wanted}")));
        }
        if saved.loads.len() != state.loads.len() || saved.unbounded.len() != state.unbounded.len() {
            return Err(RestoreError(
                "it has other supports, loads or bodies without bounds than the scene".into(),
            ));
        }
        if saved.joints.len() != state.joints.len() || saved.springs.len() != state.springs.len() {
            return Err(RestoreError("it has other joints or springs than the scene".into()));
        }
        let numbers =
            [saved.time, saved.damping, saved.impacts, saved.gravity_work, saved.signal.unwrap_or(1.0)];
        let forces = saved.touch_forces.iter().flat_map(|touch| touch.place.iter().chain(&touch.force));
        if !numbers.iter().chain(forces).all(|x| x.is_finite())
            || saved.time < 0.0
            || !saved.contact_sums.are_of(wanted)
        {
            return Err(RestoreError("it has numbers that no run has".to_string()));
        }
        for (body, saved) in state.bodies.iter().zip(&saved.bodies) {
            if body.motion.is_some() != saved.motion.is_some() {
                return Err(RestoreError(format!("body `{}` is rigid in one of the two only", body.name)));
            }
            let motions = body.motion.as_deref().zip(saved.motion.as_ref());
            if motions.is_some_and(|(motion, saved)| !motion.is_like(saved)) {
                return Err(RestoreError(format!("body `{}` is free in one of the two only", body.name)));
            }
            if saved.name != body.name {
                let found = &saved.name;
                return Err(RestoreError(format!("body `{}` stands where it has `{found}`", body.name)));
            }
        }
        Ok(())
    }

    /// Takes up a state of the same scene, but for particles.
    pub(super) fn take_up_rest(&mut self, saved: SavedState) {
        let (state, wanted) = (&mut self.state, saved.bodies.len());
        for (body, saved) in state.bodies.iter_mut().zip(&saved.bodies) {
            if let (Some(motion), Some(saved)) = (&mut body.motion, &saved.motion) {
                motion.restore(saved);
            }
        }
        state
            .unbounded
            .iter_mut()
            .zip(&saved.unbounded)
            .for_each(|(unbounded, saved)| unbounded.take_up(saved));
        for (load, moved) in self.settings.loads.iter_mut().zip(saved.moved) {
            load.points.iter_mut().zip(moved).for_each(|(point, moved)| point.moved = moved);
        }
        state.contact_sums = saved.contact_sums.indexed();
        state.removed = match saved.removed.len() {
            count if count == wanted => saved.removed,
            _ => vec![RemovedParticles::default(); wanted],
        };
        state.written = match saved.written.len() {
            count if count == wanted => saved.written,
            _ => vec![WrittenValues::default(); wanted],
        };
        (state.loads, state.joints, state.springs) = (saved.loads, saved.joints, saved.springs);
        state.touch_forces = saved.touch_forces;
        state.longest_rigid = saved.longest_rigid.unwrap_or(state.longest_rigid);
        (state.damping, state.relaxation) = (saved.damping, saved.relaxation);
        (state.impacts, state.gravity_work) = (saved.impacts, saved.gravity_work);
        // Outputs may be others.
        if saved.walls.len() == state.walls.len() {
            state.walls = saved.walls;
        }
        (state.signal, state.time) = (saved.signal, saved.time);
        (state.steps, state.phase) = (saved.steps, saved.phase % SETTLES_EVERY);
    }

    /// Lets bodies begin as those of the same name were in another run.
    ///
    /// # Errors
    /// One of them is another body there; then nothing is changed.
    pub(super) fn carry_over(
        &mut self,
        saved: &SavedState,
        velocities: StartVelocities,
    ) -> Result<(), RestoreError> {
        let state = &self.state;
        let most = T::HALF * self.settings.lattice.cell;
        let named: HashMap<&str, &SavedBody> =
            saved.bodies.iter().map(|saved| (saved.name.as_str(), saved)).collect();
        let carried = state.bodies.iter().enumerate().map(|(i, body)| {
            let without_bounds = state.unbounded.iter().any(|unbounded| unbounded.body == i);
            let begin = |own: &&SavedBody| begun((saved, own), body, (without_bounds, velocities, most));
            named.get(body.name.as_str()).map(begin).transpose()
        });
        let carried: Vec<Option<Body<T, D>>> = carried.collect::<Result<_, _>>()?;
        if carried.iter().all(Option::is_none) {
            return Err(RestoreError("it has no body with the name of one of the scene".to_string()));
        }
        self.find_overlap(&carried)?;
        for (i, body) in carried.into_iter().enumerate() {
            let Some(body) = body else { continue };
            let here = &mut self.state.bodies[i];
            here.motion = body.motion;
            here.particles.become_others(body.particles);
        }
        // Round-off is no way.
        let near = f64::from(f32::EPSILON) * self.settings.lattice.cell.f64();
        for load in &mut self.settings.loads {
            let particles = &self.state.bodies[load.body].particles;
            let filled = self.settings.filled[load.body];
            let places = places(particles.numbers(), filled).expect("each particle has a number of its own");
            for i in 0..load.points.len() {
                let point = &load.points[i];
                // Where the particle left the domain, the point went with it.
                let Some(particle) = places.get(point.particle).filter(|place| **place != usize::MAX) else {
                    continue;
                };
                let (now, start) =
                    (place_of::<T, D>(&particles.get(*particle), point).space(), load.start(point));
                let way: [f64; 3] = std::array::from_fn(|k| if k < D { now[k] - start[k] } else { 0.0 });
                load.points[i].moved = way.map(|way| if way.abs() < near { 0.0 } else { way });
            }
        }
        for (joint, sums) in self.settings.joints.iter().zip(&mut self.state.joints) {
            sums.begin(joint, &self.state.bodies);
        }
        self.begin_springs();
        self.state.phase = (saved.phase % SETTLES_EVERY + saved.steps % SETTLES_EVERY) % SETTLES_EVERY;
        (self.state.signal, self.workspace.totals) = (None, Mutex::default());
        Ok(())
    }

    /// Refuses particles that begin deeper in another body than half their distance, where that is new or rigid and its
    /// surface is known.
    fn find_overlap(&self, carried: &[Option<Body<T, D>>]) -> Result<(), RestoreError> {
        let body = |i: usize| carried[i].as_ref().unwrap_or(&self.state.bodies[i]);
        let known = |&a: &usize| body(a).is_rigid() || carried[a].is_none();
        for a in (0..carried.len()).filter(known) {
            let holder = body(a);
            let level = |x: [f64; 3]| {
                let start = holder.motion.as_deref().map_or(x, |motion| motion.pose().start(x));
                holder.whole.level(start).distance
            };
            let together = |&b: &usize| carried[a].is_some() && carried[b].is_some();
            for b in (0..carried.len()).filter(|b| a != *b && !body(*b).is_rigid() && !together(b)) {
                let rule = self.settings.rules.rule(self.settings.rules.number(a, b));
                if matches!(rule.law, ContactLaw::None | ContactLaw::Glued) {
                    continue;
                }
                let inside = body(b).particles.iter().filter_map(|particle| {
                    let x = particle.position.space();
                    (level(x) < -particle.half_width.f64()).then_some(x)
                });
                let inside: Vec<[f64; 3]> = inside.collect();
                if let Some(near) = inside.first() {
                    let (holder, other, count) = (&holder.name, &body(b).name, inside.len());
                    let near: Vec<String> = near[..D].iter().map(|x| format!("{x:.4}")).collect();
                    return Err(RestoreError(format!(
                        "`{holder}` overlaps `{other}` in {count} particles near ({}) m",
                        near.join(", ")
                    )));
                }
            }
        }
        Ok(())
    }
}

/// Every way between particles and grid.
const TRANSFERS: [Transfer; 5] =
    [Transfer::Rflip, Transfer::Flip, Transfer::Apic, Transfer::Xpic, Transfer::Pic];

/// A body as one of the same name was in another run.
fn begun<T: Laned, const D: usize>(
    (state, saved): (&SavedState, &SavedBody),
    fresh: &Body<T, D>,
    (without_bounds, velocities, most): (bool, StartVelocities, T),
) -> Result<Body<T, D>, RestoreError> {
    let off = |what: &str| RestoreError(format!("body `{}` {what}", fresh.name));
    let mut body = fresh.clone();
    match (&mut body.motion, &saved.motion) {
        // Without bounds and where it was drawn: where it is drawn now.
        (Some(_), Some(saved)) if without_bounds && !saved.has_moved() => return Ok(body),
        (Some(motion), Some(saved)) => {
            let near = |[a, b]: [f64; 2]| (a - b).abs() <= NEAR;
            if without_bounds && !(0..3).all(|i| near([saved.start()[i], motion.state().start()[i]])) {
                return Err(off("has moved in it, and its shape is another in the scene"));
            }
            if !motion.is_like(saved) {
                return Err(off("is free in one of the two, and moves as prescribed in the other"));
            }
            motion.restore(saved);
            motion.set_time(0.0).map_err(|fault| off(&format!("has no motion: {fault}")))?;
            if velocities == StartVelocities::Zero {
                motion.stop();
            }
        }
        (Some(_), None) if !state.of_snapshot => {
            return Err(off("is rigid in the scene, and deformed in it"));
        }
        (Some(_) | None, _) => {}
    }
    if without_bounds {
        return Ok(body);
    }
    let count = saved.numbers.len();
    if count.checked_add(saved.missing) != Some(fresh.particles.len()) {
        let [count, wanted] = [count, fresh.particles.len()];
        return Err(off(&format!(
            "has {wanted} particles in the scene, and {count} in it: its shape or its filling is another"
        )));
    }
    let filled = fresh.particles.len();
    let places =
        places(&saved.numbers, filled).ok_or_else(|| off("has particles that are numbered twice"))?;
    let gone = fresh.particles.numbers().iter().zip(0..);
    let gone: Vec<u32> =
        gone.filter(|(number, _)| places[**number as usize] == usize::MAX).map(|(_, place)| place).collect();
    body.particles.remove(&gone);
    let numbers = body.particles.numbers().to_vec();
    let density = body.density;
    // What carries velocities follows from the transfer, and domains from F by the basis; both may be others.
    let of_scheme = |name: &str| {
        let of_motion = |way: &Transfer| columns_of(*way).iter().any(|own| own.column.name == name);
        name == HALF_EDGES || TRANSFERS.iter().any(of_motion)
    };
    let known = |name: &str| fresh.particles.described().any(|(_, column)| column.name == name);
    let forgotten = saved.columns.iter().find(|saved| {
        let remembers = saved.bytes.iter().any(|&byte| byte != 0);
        remembers && !known(&saved.name) && !of_scheme(&saved.name)
    });
    if let Some(column) = forgotten {
        let name = &column.name;
        return Err(off(&format!(
            "has `{name}` in it, which its material in the scene does not remember: what flowed or broke would spring \
             back"
        )));
    }
    let stretched = |name: &str| name == INITIAL_STRETCH;
    if known(INITIAL_STRETCH) && !saved.columns.iter().any(|saved| stretched(&saved.name)) {
        return Err(off("begins with a `stress` in the scene, and has that of its particles from it"));
    }
    for (first, column) in fresh.particles.described() {
        let Some(saved) = saved.columns.iter().find(|saved| saved.name == column.name) else { continue };
        let entries = column.kind.entries(D);
        let values: Vec<T> = saved.numbers().collect();
        if ![4, 8].contains(&saved.width) || values.len() != entries * count {
            return Err(off(&format!("has another kind of column `{}` in it", column.name)));
        }
        for (k, values) in (0..entries).zip(values.chunks(count.max(1))) {
            let line = body.particles.line_mut(first + k);
            line.iter_mut().zip(&numbers).for_each(|(x, &number)| *x = values[places[number as usize]]);
        }
    }
    body.particles.compare();
    if !same_start(&body.particles, &fresh.particles, NEAR) {
        return Err(off("began elsewhere than it does in the scene: its shape or its filling is another"));
    }
    // As the scene rounds it, with which the run goes on.
    for entry in ColumnStart::<D>::START..ColumnStart::<D>::COUNT {
        let mut starts = vec![T::ZERO; filled];
        let known = fresh.particles.numbers().iter().zip(fresh.particles.line(entry));
        known.for_each(|(&number, &start)| starts[number as usize] = start);
        let line = body.particles.line_mut(entry).iter_mut();
        line.zip(&numbers).for_each(|(x, &number)| *x = starts[number as usize]);
    }
    if state.of_snapshot {
        complete(&mut body, fresh).map_err(off)?;
        if velocities == StartVelocities::Zero
            && let Some(motion) = &mut body.motion
        {
            motion.stop();
        }
    }
    for i in 0..body.particles.len() {
        let mut particle = body.particles.get(i);
        // Of another density: m = rho V / J.
        let mass = density * particle.volume / particle.deformation.det();
        if (mass - particle.mass).abs() > T::of(1e-5) * mass {
            particle.mass = mass;
        }
        if let Some(motion) = &body.motion {
            particle.velocity = Vector::of(motion.velocity_at(particle.position.space()));
            particle.spin = spin::<T, D>(motion.spin());
        }
        body.particles.set(i, &particle);
    }
    body.particles.deform_domains(most);
    if velocities == StartVelocities::Zero && body.motion.is_none() {
        body.particles.stop();
    }
    Ok(body)
}

/// Finds what a snapshot does not have of a body: its particles turn as the whole does, and a rigid one is where they
/// are. Masses and volumes follow from the filling.
///
/// # Errors
/// Its particles have other volumes, or belong to no rigid body although it is one.
fn complete<T: Laned, const D: usize>(body: &mut Body<T, D>, fresh: &Body<T, D>) -> Result<(), &'static str> {
    for i in 0..body.particles.len() {
        let (mut particle, filled) = (body.particles.get(i), fresh.particles.get(i));
        let volume = filled.volume * particle.deformation.det();
        if !(volume > T::ZERO && (volume - particle.volume).abs() <= T::of(NEAR) * volume) {
            return Err("has particles of another volume in it: its filling is another");
        }
        (particle.volume, particle.mass, particle.spin) = (volume, filled.mass, Vector::ZERO);
        body.particles.set(i, &particle);
    }
    if body.particles.is_empty() {
        return Ok(());
    }
    let totals = body.totals();
    let turning = body.spin_of_points(&totals);
    let Some(motion) = &mut body.motion else {
        for i in 0..body.particles.len() {
            let particle = body.particles.get(i);
            body.particles.set(i, &Particle { spin: spin::<T, D>(turning), ..particle });
        }
        return Ok(());
    };
    let [first, began] = [&body.particles, &fresh.particles].map(|particles| particles.get(0));
    let turn = Matrix::from_fn(|i, j| first.deformation.0[i][j].f64());
    if (turn.det() - 1.0).abs() > NEAR {
        return Err("is rigid in the scene, and deformed in it");
    }
    motion.put(turn, [began.position.space(), first.position.space()]);
    let [mean, center] = [&totals.momentum, &totals.first_moment].map(|sum| sum.map(|x| x / totals.mass));
    let turned = cross(turning, std::array::from_fn(|i| motion.center[i] - center[i]));
    motion.set_velocities([std::array::from_fn(|i| mean[i] + turned[i]), turning]);
    motion.set_time(0.0).map_err(|_| "has no motion that its formulas or functions give")
}

/// Where each of so many particles stands among these numbers, by its own, `usize::MAX` of those that are not there;
/// none if two have one number.
fn places(numbers: &[u32], filled: usize) -> Option<Vec<usize>> {
    let mut places = vec![usize::MAX; filled];
    for (place, &number) in numbers.iter().enumerate() {
        let known = places.get_mut(number as usize).filter(|known| **known == usize::MAX)?;
        *known = place;
    }
    Some(places)
}

impl SavedColumn {
    /// Its numbers, one entry behind the other.
    fn numbers<T: Real>(&self) -> impl Iterator<Item = T> {
        self.bytes.chunks_exact(self.width.max(1)).map(number_of)
    }
}

/// How far the points of a load were from their places where the run began; none if they were there.
fn moved(load: &LoadPoints) -> Vec<[f64; 3]> {
    let moved = load.points.iter().map(|point| point.moved);
    if moved.clone().all(|way| way == [0.0; 3]) { Vec::new() } else { moved.collect() }
}

impl<const D: usize> Unbounded<D> {
    fn saved(&self) -> SavedUnbounded {
        SavedUnbounded { served: self.served.iter().map(|block| block.to_vec()).collect(), pose: self.pose }
    }

    fn take_up(&mut self, saved: &SavedUnbounded) {
        let block = |block: &Vec<i32>| std::array::from_fn(|k| block.get(k).copied().unwrap_or_default());
        (self.served, self.pose) = (saved.served.iter().map(block).collect(), saved.pose);
    }
}

pub(super) fn columns<T: Real, const D: usize>(
    particles: &Particles<T, D>,
) -> impl Iterator<Item = SavedColumn> {
    columns_of_some(particles, 0..particles.len())
}

/// The columns of particles at some places in memory.
fn columns_of_some<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    some: Range<usize>,
) -> impl Iterator<Item = SavedColumn> {
    particles.described().map(move |(first, column)| {
        let entries = first..first + column.kind.entries(D);
        let mut bytes = Vec::with_capacity(entries.len() * some.len() * size_of::<T>());
        for line in entries.map(|entry| &particles.line(entry)[some.clone()]) {
            match size_of::<T>() {
                4 => bytes.extend(line.iter().flat_map(|x| (x.f64() as f32).to_le_bytes())),
                _ => bytes.extend(line.iter().flat_map(|x| x.f64().to_le_bytes())),
            }
        }
        SavedColumn { name: column.name.to_string(), width: size_of::<T>(), bytes }
    })
}

/// The particles of a body as they were saved, of so many at the start; those of a body without bounds may be any
/// number.
fn particles<T: Real, const D: usize>(
    saved: &SavedBody,
    body: &Body<T, D>,
    filled: Option<usize>,
) -> Result<Particles<T, D>, RestoreError> {
    let off = |what: String| RestoreError(format!("body `{}` {what}", body.name));
    let fresh = &body.particles;
    let count = saved.numbers.len();
    if let Some(filled) = filled.filter(|&filled| count.checked_add(saved.missing) != Some(filled)) {
        return Err(off(format!("has {filled} particles in the scene, and {count} in it")));
    }
    let room = filled.unwrap_or(count);
    places(&saved.numbers, room).ok_or_else(|| off("has particles that are numbered twice".into()))?;
    let blank = |i: usize| Particle {
        position: Vector::ZERO,
        velocity: Vector::ZERO,
        spin: Vector::ZERO,
        mass: T::ZERO,
        volume: T::ZERO,
        half_width: T::ZERO,
        deformation: Matrix::IDENTITY,
        stress: Symmetric::ZERO,
        number: saved.numbers.get(i).copied().unwrap_or_default(),
    };
    let mut particles = Particles::from_fn(room, fresh.own(), blank);
    particles.truncate(count);
    if saved.columns.len() != fresh.described().count() {
        return Err(off("has other columns of particles in it than in the scene".into()));
    }
    for ((first, column), saved) in fresh.described().zip(&saved.columns) {
        let entries = column.kind.entries(D);
        let fits = saved.name == column.name
            && saved.width == size_of::<T>()
            && saved.bytes.len() == entries * count * saved.width;
        if !fits {
            let (found, wanted) = (&saved.name, column.name);
            return Err(off(format!(
                "has the column `{found}` in it, of another size than `{wanted}` in the scene"
            )));
        }
        let mut numbers = saved.numbers();
        for entry in first..first + entries {
            particles.line_mut(entry).iter_mut().zip(&mut numbers).for_each(|(x, saved)| *x = saved);
        }
    }
    particles.compare();
    if filled.is_some() && !same_start(&particles, fresh, 0.0) {
        return Err(off("began elsewhere than it does in the scene".into()));
    }
    Ok(particles)
}

/// Puts particles that were saved behind those of the body of this name.
///
/// # Errors
/// They have other columns than these.
pub(super) fn append<T: Real, const D: usize>(
    name: &str,
    particles: &mut Particles<T, D>,
    saved: &SavedShare,
) -> Result<(), RestoreError> {
    let count = saved.numbers.len();
    let same = saved.columns.len() == particles.described().count()
        && (particles.described().zip(&saved.columns)).all(|((_, column), saved)| {
            let bytes = column.kind.entries(D) * count * size_of::<T>();
            (&saved.name[..], saved.width, saved.bytes.len()) == (column.name, size_of::<T>(), bytes)
        });
    if !same {
        return Err(RestoreError(format!(
            "body `{name}` has other columns of particles in it than in the scene"
        )));
    }
    let mut bytes: Vec<u8> = saved.numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    bytes.reserve(particles.message_bytes(count));
    saved.columns.iter().for_each(|column| bytes.extend_from_slice(&column.bytes));
    particles.take_in(&bytes, count);
    Ok(())
}

/// Whether each of some particles began where that of its number fills its body.
pub(super) fn began_at<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    sites: impl Iterator<Item = ParticleSite>,
) -> bool {
    let (numbers, order) = (particles.numbers(), by_number(particles.numbers()));
    let mut rest = order.iter().map(|&place| place as usize).peekable();
    let first = ColumnStart::<D>::START;
    for (site, number) in sites.zip(0..) {
        let Some(place) = rest.next_if(|&place| numbers[place] == number) else { continue };
        if (0..D).any(|k| particles.line(first + k)[place] != T::of(site.position[k])) {
            return false;
        }
    }
    // One that is left has a number twice, or one that the body does not have.
    rest.next().is_none()
}

/// Places that differ by this share of half a particle's width are one: a grid that begins elsewhere rounds otherwise.
const NEAR: f64 = 1e-3;

/// Whether particles began where others are that have not moved, number by number, to a share of their half-widths.
fn same_start<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    fresh: &Particles<T, D>,
    near: f64,
) -> bool {
    let first = ColumnStart::<D>::START;
    (first..first + D).all(|entry| {
        // Those that are not there any more may have begun anywhere.
        let most =
            particles.numbers().iter().chain(fresh.numbers()).max().map_or(0, |&most| most as usize + 1);
        let mut start = vec![[T::ZERO, T::of(f64::INFINITY)]; most];
        let widths = fresh.line(ColumnStart::<D>::HALF_WIDTH);
        for ((&number, &x), &width) in fresh.numbers().iter().zip(fresh.line(entry)).zip(widths) {
            start[number as usize] = [x, T::of(near) * width];
        }
        (particles.numbers().iter().zip(particles.line(entry))).all(|(&number, &x)| {
            let [start, near] = start[number as usize];
            (start - x).abs() <= near
        })
    })
}
