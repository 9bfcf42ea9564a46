//! The state as data, and back.

use super::Engine;
use super::loads::{NOWHERE, find_carriers};
use super::state::State;
use super::unbounded::Unbounded;
use crate::body::{Body, Particle};
use crate::door::{RestoreError, SavedBody, SavedColumn, SavedShare, SavedState, SavedUnbounded};
use crate::geometry::ParticleSite;
use crate::lanes::Laned;
use crate::particles::{ColumnStart, Particles, by_number, number_of};
use crate::tensor::{Matrix, Real, Symmetric, Vector};
use crate::transfer::SETTLES_EVERY;
use std::convert::Infallible;
use std::ops::Range;
use stickslip_reference::contact::Neighbours;

impl<T: Laned, const D: usize> Engine<T, D> {
    /// The state as data.
    pub(super) fn saved(&self) -> SavedState {
        let mut saved = self.saved_rest();
        for (saved, body) in saved.bodies.iter_mut().zip(self.shown()) {
            saved.numbers = body.particles.numbers().to_vec();
            saved.columns = columns(&body.particles).collect();
        }
        saved
    }

    /// The particles of the state, body by body, at most so many at a time.
    pub(super) fn share_out(&self, most: usize, take: &mut dyn FnMut(Vec<SavedShare>)) {
        let bodies = self.shown();
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
        let bodies =
            self.state.bodies.iter().enumerate().zip(&self.settings.filled).zip(self.counts_of_all());
        let (nodes, touching) = self.saved_nodes();
        SavedState {
            time,
            steps,
            phase,
            bodies: bodies
                .map(|(((i, body), filled), count)| SavedBody {
                    name: self.name_of(i).to_string(),
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
            moved: self.moved_points(),
            joints: self.state.joints.clone(),
            springs: self.state.springs.clone(),
            touch_forces: self.state.touch_forces.clone(),
            nodes,
            touching,
            walls: self.state.walls.clone(),
            longest_rigid: Some(self.state.longest_rigid).filter(|step| step.is_finite()),
            removed: self.state.removed.clone(),
            written: self.state.written.clone(),
            of_snapshot: false,
        }
    }

    /// How far the points of each load were from their places where the run began; none of a load if they were there.
    /// Of several ranks the first knows.
    fn moved_points(&self) -> Vec<Vec<[f64; 3]>> {
        let own = self.settings.loads.iter().map(|load| {
            if load.points.iter().all(|point| point.moved == [0.0; 3]) {
                return Vec::new();
            }
            let mut places = Vec::new();
            find_carriers(&mut places, self.state.bodies[load.body].particles.numbers(), &load.points);
            // Of those that have gone nobody asks.
            let there = load.points.iter().zip(places).filter(|(_, place)| *place != NOWHERE);
            let moved = there.map(|(point, _)| (point.number, point.moved));
            moved.filter(|(_, way)| *way != [0.0; 3]).collect::<Vec<_>>()
        });
        let own: Vec<Vec<(u32, [f64; 3])>> = own.collect();
        let mut all = vec![Vec::new(); own.len()];
        for of_rank in self.told_first(own) {
            for ((all, moved), load) in all.iter_mut().zip(of_rank).zip(&self.settings.loads) {
                for (number, way) in moved {
                    all.resize(load.count, [0.0; 3]);
                    all[number as usize] = way;
                }
            }
        }
        all
    }

    /// Refuses to give one of several ranks the state of all of them.
    pub(super) fn is_whole(&self) -> Result<(), RestoreError> {
        let whole = self.among.is_none();
        whole
            .then_some(())
            .ok_or_else(|| RestoreError("it is of one rank, and several share this simulation".into()))
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
        for (number, particles) in restored.into_iter().enumerate() {
            self.state.bodies[number].particles.become_others(particles);
            self.order_by_number(number);
        }
        self.take_up_rest(saved);
        Ok(())
    }

    /// Orders the particles of a body on a grid of its own: its cells know them by their numbers.
    pub(super) fn order_by_number(&mut self, body: usize) {
        let here = self.state.bodies[body].here_mut();
        if let Some(here) = here.filter(|_| self.settings.references.iter().any(|own| own.body == body)) {
            let order = by_number(here.particles.numbers());
            here.particles.permute(&order);
        }
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
        if !self.are_nodes(&saved.nodes) {
            return Err(RestoreError(
                "it has other nodes of bodies with interior \"reference\" than the scene".into(),
            ));
        }
        for (i, (body, saved)) in state.bodies.iter().zip(&saved.bodies).enumerate() {
            let name = self.name_of(i);
            if body.motion.is_some() != saved.motion.is_some() {
                return Err(RestoreError(format!("body `{name}` is rigid in one of the two only")));
            }
            let motions = body.motion.as_deref().zip(saved.motion.as_ref());
            if motions.is_some_and(|(motion, saved)| !motion.is_like(saved)) {
                return Err(RestoreError(format!("body `{name}` is free in one of the two only")));
            }
            if saved.name != name {
                let found = &saved.name;
                return Err(RestoreError(format!("body `{name}` stands where it has `{found}`")));
            }
        }
        Ok(())
    }

    /// Takes up a state of the same scene, but for particles.
    pub(super) fn take_up_rest(&mut self, saved: SavedState) {
        let (state, wanted) = (&mut self.state, saved.bodies.len());
        for (body, saved) in state.bodies.iter_mut().zip(&saved.bodies) {
            let motion = body.here_mut().and_then(|body| body.motion.as_mut());
            if let Some((motion, saved)) = motion.zip(saved.motion.as_ref()) {
                motion.restore(saved);
            }
        }
        state
            .unbounded
            .iter_mut()
            .zip(&saved.unbounded)
            .for_each(|(unbounded, saved)| unbounded.take_up(saved));
        for (load, moved) in self.settings.loads.iter_mut().zip(saved.moved) {
            for point in &mut load.points {
                point.moved = moved.get(point.number as usize).copied().unwrap_or(point.moved);
            }
        }
        state.contact_sums = saved.contact_sums.indexed();
        state.removed = match saved.removed.len() {
            count if count == wanted => saved.removed,
            _ => Vec::new(),
        };
        state.written = match saved.written.len() {
            count if count == wanted => saved.written,
            _ => Vec::new(),
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
        self.take_up_nodes(&saved.nodes, saved.touching);
        self.workspace.neighbours = Neighbours::default();
    }
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
    pub(super) fn numbers<T: Real>(&self) -> impl Iterator<Item = T> {
        self.bytes.chunks_exact(self.width.max(1)).map(number_of)
    }
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
    if filled.is_some() && !same_start(&particles, fresh) {
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

/// Whether particles began where others are that have not moved, number by number.
fn same_start<T: Real, const D: usize>(particles: &Particles<T, D>, fresh: &Particles<T, D>) -> bool {
    let first = ColumnStart::<D>::START;
    (first..first + D).all(|entry| {
        // Those that are not there any more may have begun anywhere.
        let most =
            particles.numbers().iter().chain(fresh.numbers()).max().map_or(0, |&most| most as usize + 1);
        let mut start = vec![None; most];
        for (&number, &x) in fresh.numbers().iter().zip(fresh.line(entry)) {
            start[number as usize] = Some(x);
        }
        (particles.numbers().iter().zip(particles.line(entry)))
            .all(|(&number, &x)| start[number as usize].is_none_or(|start| start == x))
    })
}
