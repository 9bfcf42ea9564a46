//! Bodies that begin as those of the same names were in another run.
//!
//! Of several ranks each has some of the particles of that run, whichever, and does with them what one process does
//! with all: what belongs to a whole body they find together.

use super::Engine;
use super::build::spin;
use super::loads::{NOWHERE, find_carriers};
use crate::Kernels;
use crate::body::{Body, Particle, TotalSums, Totals, TurningSums};
use crate::column::INITIAL_STRETCH;
use crate::door::{RestoreError, SavedBody, SavedColumn, SavedState};
use crate::exact::ExactSum;
use crate::lanes::Laned;
use crate::load::place_of;
use crate::particles::{ColumnStart, Particles, by_number};
use crate::ranks::{Ranks, add_up_each, added, combined, gathered};
use crate::rigid::RigidMotion;
use crate::scene::{ContactLaw, StartVelocities, Transfer};
use crate::tensor::{Matrix, Real, Vector, cross};
use crate::transfer::{SETTLES_EVERY, columns as columns_of};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::sync::Mutex;

/// The ranks that have particles of the other run, if they are several.
type Others<'a> = Option<&'a dyn Ranks>;

/// The particles of a body with some numbers as they fill it, in any order.
type Fresh<'a, T, const D: usize> = &'a dyn Fn(usize, &[u32]) -> Result<Particles<T, D>, RestoreError>;

/// Bodies of a scene as they were in another run, with the particles that are here; none of new ones.
pub(super) type Carried<T, const D: usize> = Vec<Option<Body<T, D>>>;

/// Places that differ by this share of half a particle's width are one: a grid that begins elsewhere rounds otherwise.
const NEAR: f64 = 1e-3;

/// Every way between particles and grid.
const TRANSFERS: [Transfer; 5] =
    [Transfer::Rflip, Transfer::Flip, Transfer::Apic, Transfer::Xpic, Transfer::Pic];

/// Bodies whose sums are in memory at a time.
const SUMMED_AT_A_TIME: usize = 64;

/// Particles of a body in another one.
#[derive(Clone, Serialize, Deserialize)]
struct Overlap {
    /// The other one, and the body.
    bodies: [usize; 2],
    count: usize,
    /// The one with the smallest number, and its place [m].
    first: (u32, [f64; 3]),
}

/// The particle of a rigid body with the smallest number.
#[derive(Clone, Serialize, Deserialize)]
struct FirstParticle {
    number: u32,
    deformation: [[f64; 3]; 3],
    /// Where it began in the scene, and where it is [m].
    places: [[f64; 3]; 2],
}

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Lets bodies begin as those of the same name were in another run.
    ///
    /// # Errors
    /// One of them is another body there; then nothing is changed.
    pub(super) fn carry_over(
        &mut self,
        saved: &SavedState,
        velocities: StartVelocities,
    ) -> Result<(), RestoreError> {
        let nodes = self.carried_nodes(saved, velocities)?;
        let bodies = &self.state.bodies;
        let fresh = |body: usize, numbers: &[u32]| Ok(bodies[body].particles.with_numbers(numbers));
        let carried = self.carried((saved, velocities), None, &fresh)?;
        self.find_overlap(&carried, None)?;
        self.put_in(carried);
        self.begin_nodes(nodes);
        self.begin_points();
        self.begin_sums(saved);
        Ok(())
    }

    /// Bodies as they were in the other run, whose particles that are here the state has; `fresh` gives those that fill
    /// the scene's bodies.
    ///
    /// # Errors
    /// One of them is another body there: all ranks say so.
    pub(super) fn carried(
        &self,
        (saved, velocities): (&SavedState, StartVelocities),
        ranks: Others,
        fresh: Fresh<T, D>,
    ) -> Result<Carried<T, D>, RestoreError> {
        let named: HashMap<&str, usize> =
            saved.bodies.iter().zip(0..).map(|(saved, place)| (saved.name.as_str(), place)).collect();
        let counts: Vec<usize> = saved.bodies.iter().map(|saved| saved.numbers.len()).collect();
        let counts = ranks.map_or_else(|| counts.clone(), |ranks| combined(ranks, &counts, added));
        let carried = (0..self.state.bodies.len()).map(|i| {
            let place = named.get(self.name_of(i));
            let carry =
                |&place: &usize| self.carried_body(i, (saved, place, counts[place]), (velocities, fresh));
            place.map(carry).transpose().map_err(|problem| (i, problem))
        });
        let mut carried: Carried<T, D> = first_of_all(ranks, carried.collect())?;
        if carried.iter().all(Option::is_none) {
            return Err(RestoreError::new("it has no body with the name of one of the scene"));
        }
        let mut here: Vec<&mut Body<T, D>> = carried.iter_mut().flatten().collect();
        if saved.of_snapshot {
            complete(self.kernels, &mut here, velocities, ranks)?;
        }
        here.into_iter().for_each(|body| finish(body, velocities));
        Ok(carried)
    }

    /// A body as one of the same name was in another run, at a place among that one's bodies and with so many particles
    /// on all ranks.
    fn carried_body(
        &self,
        i: usize,
        (state, place, count): (&SavedState, usize, usize),
        (velocities, fresh): (StartVelocities, Fresh<T, D>),
    ) -> Result<Body<T, D>, RestoreError> {
        let (here, saved) = (&self.state.bodies[i], &state.bodies[place]);
        let off = |what: &str| RestoreError::new(format!("body `{}` {what}", self.name_of(i)));
        let without_bounds = self.state.unbounded.iter().any(|unbounded| unbounded.body == i);
        let motion =
            carried_motion((state, saved), here, (without_bounds, velocities)).map_err(|what| off(&what))?;
        if without_bounds {
            return Ok(here.like(here.particles.clone(), motion).into());
        }
        let filled = self.settings.filled[i];
        if count.checked_add(saved.missing) != Some(filled) {
            return Err(off(&format!(
                "has {filled} particles in the scene, and {count} in it: its shape or its filling is another"
            )));
        }
        if saved.numbers.is_empty() && count > 0 {
            // What the others have it with, they see.
            return Ok(match here {
                Body::Elsewhere(_) => here.clone(),
                Body::Here(here) => here.like(fresh(i, &[])?, motion).into(),
            });
        }
        let (here, fresh) = (self.brought(here, i), fresh(i, &saved.numbers)?);
        let filling = state.of_snapshot.then(|| {
            [ColumnStart::<D>::VOLUME, ColumnStart::<D>::MASS].map(|entry| fresh.line(entry).to_vec())
        });
        let mut particles = carried_particles(saved, fresh).map_err(|what| off(&what))?;
        if let Some(filling) = filling {
            weigh(&mut particles, &filling).map_err(off)?;
        }
        Ok(here.like(particles, motion).into())
    }

    /// Refuses particles that begin deeper in another body than half their distance, where that is new or rigid and its
    /// surface is known.
    pub(super) fn find_overlap(&self, carried: &Carried<T, D>, ranks: Others) -> Result<(), RestoreError> {
        let own = self.first_overlap(carried);
        let found = ranks.map_or_else(|| own.clone(), |ranks| combined(ranks, &own, joined));
        let Some(Overlap { bodies, count, first: (_, near) }) = found else { return Ok(()) };
        let [holder, other] = bodies.map(|body| self.name_of(body));
        let near: Vec<String> = near[..D].iter().map(|x| format!("{x:.4}")).collect();
        let near = near.join(", ");
        Err(RestoreError::new(format!("`{holder}` overlaps `{other}` in {count} particles near ({near}) m")))
    }

    /// Of the particles that are here.
    fn first_overlap(&self, carried: &Carried<T, D>) -> Option<Overlap> {
        let body = |i: usize| carried[i].as_ref().unwrap_or(&self.state.bodies[i]);
        let known = |&a: &usize| body(a).is_rigid() || carried[a].is_none();
        for a in (0..carried.len()).filter(known) {
            let holder = self.brought(body(a), a);
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
                    let one = Overlap { bodies: [a, b], count: 1, first: (particle.number, x) };
                    (level(x) < -particle.half_width.f64()).then_some(Some(one))
                });
                if let Some(found) = inside.reduce(joined) {
                    return found;
                }
            }
        }
        None
    }

    /// Puts bodies of the other run in the place of the scene's.
    pub(super) fn put_in(&mut self, carried: Carried<T, D>) {
        for (here, body) in self.state.bodies.iter_mut().zip(carried) {
            match (here.here_mut(), body) {
                (Some(here), Some(Body::Here(body))) => {
                    here.motion = body.motion;
                    here.particles.become_others(body.particles);
                }
                (_, Some(body)) => *here = body,
                (_, None) => {}
            }
        }
    }

    /// Finds how far the points of loads are from where they began.
    pub(super) fn begin_points(&mut self) {
        // Round-off is no way.
        let near = f64::from(f32::EPSILON) * self.settings.lattice.cell.f64();
        for load in &mut self.settings.loads {
            let particles = &self.state.bodies[load.body].particles;
            let mut places = Vec::new();
            find_carriers(&mut places, particles.numbers(), &load.points);
            // Where a particle left the domain, the point went with it.
            for i in (0..places.len()).filter(|&i| places[i] != NOWHERE) {
                let point = &load.points[i];
                let now = place_of::<T, D>(&particles.get(places[i] as usize), point).space();
                let start = load.start(point);
                let way: [f64; 3] = std::array::from_fn(|k| if k < D { now[k] - start[k] } else { 0.0 });
                load.points[i].moved = way.map(|way| if way.abs() < near { 0.0 } else { way });
            }
        }
    }

    /// Begins all that is summed up where bodies begin.
    pub(super) fn begin_sums(&mut self, saved: &SavedState) {
        for (joint, sums) in self.settings.joints.iter().zip(&mut self.state.joints) {
            sums.begin(joint, &self.state.bodies);
        }
        self.begin_springs();
        self.state.phase = (saved.phase % SETTLES_EVERY + saved.steps % SETTLES_EVERY) % SETTLES_EVERY;
        (self.state.signal, self.workspace.totals) = (None, Mutex::default());
    }
}

/// What is wrong with the first body with which something is, on any rank, for all.
fn first_of_all<X>(ranks: Others, own: Result<X, (usize, RestoreError)>) -> Result<X, RestoreError> {
    let Some(ranks) = ranks else { return own.map_err(|(_, problem)| problem) };
    let all: Vec<Option<(usize, RestoreError)>> = gathered(ranks, &own.as_ref().err().cloned());
    let first = all.into_iter().flatten().min_by_key(|(body, _)| *body);
    match (first, own) {
        (None, Ok(own)) => Ok(own),
        (Some((_, problem)), _) | (None, Err((_, problem))) => Err(problem),
    }
}

/// The first of two overlaps, or both of the same bodies.
fn joined(one: Option<Overlap>, other: Option<Overlap>) -> Option<Overlap> {
    let (Some(one), Some(other)) = (&one, &other) else { return one.or(other) };
    let of_same = one.bodies == other.bodies;
    let first = if one.bodies <= other.bodies { one } else { other };
    let count = if of_same { one.count + other.count } else { first.count };
    let nearest = if of_same && other.first.0 < one.first.0 { other.first } else { first.first };
    Some(Overlap { bodies: first.bodies, count, first: nearest })
}

/// How a rigid body moves that was so in another run.
fn carried_motion<T: Laned, const D: usize>(
    (state, saved): (&SavedState, &SavedBody),
    here: &Body<T, D>,
    (without_bounds, velocities): (bool, StartVelocities),
) -> Result<Option<Box<RigidMotion>>, String> {
    let mut motion = here.motion.clone();
    match (&mut motion, &saved.motion) {
        // Without bounds and where it was drawn: where it is drawn now.
        (Some(_), Some(saved)) if without_bounds && !saved.has_moved() => {}
        (Some(motion), Some(saved)) => {
            let near = |[a, b]: [f64; 2]| (a - b).abs() <= NEAR;
            if without_bounds && !(0..3).all(|i| near([saved.start()[i], motion.state().start()[i]])) {
                return Err("has moved in it, and its shape is another in the scene".to_string());
            }
            if !motion.is_like(saved) {
                return Err("is free in one of the two, and moves as prescribed in the other".to_string());
            }
            motion.restore(saved);
            motion.set_time(0.0).map_err(|fault| format!("has no motion: {fault}"))?;
            if velocities == StartVelocities::Zero {
                motion.stop();
            }
        }
        (Some(_), None) if !state.of_snapshot => {
            return Err("is rigid in the scene, and deformed in it".to_string());
        }
        (Some(_) | None, _) => {}
    }
    Ok(motion)
}

/// Particles as they fill a body, with what they had in another run.
fn carried_particles<T: Laned, const D: usize>(
    saved: &SavedBody,
    fresh: Particles<T, D>,
) -> Result<Particles<T, D>, String> {
    let count = saved.numbers.len();
    let [own, there] = [fresh.numbers(), &saved.numbers].map(by_number);
    let mut places = vec![0; count];
    let mut both = own.iter().zip(&there).map(|(&place, &from)| [place as usize, from as usize]);
    let same = both.all(|[place, from]| {
        places[place] = from;
        fresh.numbers()[place] == saved.numbers[from]
    });
    if fresh.len() != count || !same {
        return Err("has particles that are numbered twice".to_string());
    }
    // What carries velocities follows from the transfer, which may be another.
    let of_transfer = |name: &str| {
        let of_motion = |way: &Transfer| columns_of(*way).iter().any(|own| own.column.name == name);
        TRANSFERS.iter().any(of_motion)
    };
    let known = |name: &str| fresh.described().any(|(_, column)| column.name == name);
    let forgotten = saved.columns.iter().find(|saved| {
        let remembers = saved.bytes.iter().any(|&byte| byte != 0);
        remembers && !known(&saved.name) && !of_transfer(&saved.name)
    });
    if let Some(SavedColumn { name, .. }) = forgotten {
        return Err(format!(
            "has `{name}` in it, which its material in the scene does not remember: what flowed or broke would spring \
             back"
        ));
    }
    if known(INITIAL_STRETCH) && !saved.columns.iter().any(|saved| saved.name == INITIAL_STRETCH) {
        return Err("begins with a `stress` in the scene, and has that of its particles from it".to_string());
    }
    let widths = fresh.line(ColumnStart::<D>::HALF_WIDTH).to_vec();
    let described: Vec<_> = fresh.described().collect();
    let mut particles = fresh;
    for (first, column) in described {
        let Some(saved) = saved.columns.iter().find(|saved| saved.name == column.name) else { continue };
        let entries = column.kind.entries(D);
        let values: Vec<T> = saved.numbers().collect();
        if ![4, 8].contains(&saved.width) || values.len() != entries * count {
            return Err(format!("has another kind of column `{}` in it", column.name));
        }
        for (k, values) in (0..entries).zip(values.chunks(count.max(1))) {
            let line = particles.line_mut(first + k).iter_mut().zip(&places).zip(&widths);
            if first != ColumnStart::<D>::START {
                line.for_each(|((x, &place), _)| *x = values[place]);
                continue;
            }
            // They begin as the scene rounds it, with which the run goes on.
            let is_near = |((x, &place), &width): ((&mut T, &usize), &T)| {
                (*x - values[place]).abs() <= T::of(NEAR) * width
            };
            if !line.into_iter().all(is_near) {
                return Err("began elsewhere than it does in the scene: its shape or its filling is another"
                    .to_string());
            }
        }
    }
    particles.compare();
    Ok(particles)
}

/// Gives particles of a snapshot, which knows their volumes only, those and the masses of a filling with these.
fn weigh<T: Laned, const D: usize>(
    particles: &mut Particles<T, D>,
    [volumes, masses]: &[Vec<T>; 2],
) -> Result<(), &'static str> {
    for (i, (&filled, &mass)) in volumes.iter().zip(masses).enumerate() {
        let mut particle = particles.get(i);
        let volume = filled * particle.deformation.det();
        if !(volume > T::ZERO && (volume - particle.volume).abs() <= T::of(NEAR) * volume) {
            return Err("has particles of another volume in it: its filling is another");
        }
        (particle.volume, particle.mass, particle.spin) = (volume, mass, Vector::ZERO);
        particles.set(i, &particle);
    }
    Ok(())
}

/// Finds what a snapshot does not have of bodies: their particles turn as the whole does, and a rigid one is where they
/// are.
///
/// # Errors
/// The particles of a rigid one belong to none.
fn complete<T: Laned, const D: usize>(
    kernels: &Kernels<T, D>,
    bodies: &mut [&mut Body<T, D>],
    velocities: StartVelocities,
    ranks: Others,
) -> Result<(), RestoreError> {
    let first = |body: &&mut Body<T, D>| {
        let particles = &body.particles;
        let (&number, place) = particles.numbers().iter().zip(0..).min().filter(|_| body.is_rigid())?;
        let particle = particles.get(place);
        let start = [0, 1, 2]
            .map(|k| if k < D { particles.line(ColumnStart::<D>::START + k)[place].f64() } else { 0.0 });
        Some(FirstParticle {
            number,
            deformation: particle.deformation.0.map(|row| row.map(Real::f64)),
            places: [start, particle.position.space()],
        })
    };
    let firsts: Vec<Option<FirstParticle>> = bodies.iter().map(first).collect();
    let firsts = ranks.map_or_else(|| firsts.clone(), |ranks| combined(ranks, &firsts, first_of_each));
    for (bodies, firsts) in bodies.chunks_mut(SUMMED_AT_A_TIME).zip(firsts.chunks(SUMMED_AT_A_TIME)) {
        let whole = turning(kernels, bodies, ranks);
        for ((body, first), (totals, spins)) in bodies.iter_mut().zip(firsts).zip(whole) {
            if totals.mass > 0.0 {
                let turned = turn(body, (totals, spins), first.as_ref());
                turned.map_err(|what| RestoreError::new(format!("body `{}` {what}", body.name)))?;
            }
            if velocities == StartVelocities::Zero
                && let Some(motion) = body.here_mut().and_then(|body| body.motion.as_mut())
            {
                motion.stop();
            }
        }
    }
    Ok(())
}

/// What the particles of bodies on all ranks add up to, and how fast each body turns [rad/s].
fn turning<T: Laned, const D: usize>(
    kernels: &Kernels<T, D>,
    bodies: &[&mut Body<T, D>],
    ranks: Others,
) -> Vec<(Totals, [f64; 3])> {
    let mut sums: Vec<TotalSums> = bodies.iter().map(|body| body.total_sums(kernels)).collect();
    let add_up = |sums: &mut dyn Iterator<Item = &mut ExactSum>| {
        ranks.into_iter().for_each(|ranks| add_up_each(ranks, &mut *sums));
    };
    add_up(&mut sums.iter_mut().flat_map(TotalSums::all));
    let totals: Vec<Totals> = sums.iter().map(TotalSums::rounded).collect();
    let mut sums: Vec<[TurningSums; 2]> =
        bodies.iter().zip(&totals).map(|(body, totals)| body.turning_of_points(kernels, totals)).collect();
    add_up(&mut sums.iter_mut().flatten().flat_map(TurningSums::all));
    totals.into_iter().zip(sums.iter().map(TurningSums::spin_of_points::<D>)).collect()
}

/// Lets a body turn and, if it is rigid, be where its first particle is.
fn turn<T: Laned, const D: usize>(
    body: &mut Body<T, D>,
    (totals, turning): (Totals, [f64; 3]),
    first: Option<&FirstParticle>,
) -> Result<(), &'static str> {
    let Some(body) = body.here_mut() else { return Ok(()) };
    let Some((motion, first)) = body.motion.as_mut().zip(first) else {
        for i in 0..body.particles.len() {
            let particle = body.particles.get(i);
            body.particles.set(i, &Particle { spin: spin::<T, D>(turning), ..particle });
        }
        return Ok(());
    };
    let turn = Matrix(first.deformation);
    if (turn.det() - 1.0).abs() > NEAR {
        return Err("is rigid in the scene, and deformed in it");
    }
    motion.put(turn, first.places);
    let [mean, center] = [&totals.momentum, &totals.first_moment].map(|sum| sum.map(|x| x / totals.mass));
    let turned = cross(turning, std::array::from_fn(|i| motion.center[i] - center[i]));
    motion.set_velocities([std::array::from_fn(|i| mean[i] + turned[i]), turning]);
    motion.set_time(0.0).map_err(|_| "has no motion that its formulas or functions give")
}

/// Of each body the one with the smaller number.
fn first_of_each(
    all: Vec<Option<FirstParticle>>,
    others: Vec<Option<FirstParticle>>,
) -> Vec<Option<FirstParticle>> {
    let smaller = |(one, other): (Option<FirstParticle>, Option<FirstParticle>)| {
        one.into_iter().chain(other).min_by_key(|first| first.number)
    };
    all.into_iter().zip(others).map(smaller).collect()
}

/// Gives particles what follows from their body: of another density m = rho V / J, and of a rigid one its motion.
fn finish<T: Laned, const D: usize>(body: &mut Body<T, D>, velocities: StartVelocities) {
    let Some(body) = body.here_mut() else { return };
    for i in 0..body.particles.len() {
        let mut particle = body.particles.get(i);
        let mass = body.matter.density * particle.volume / particle.deformation.det();
        if (mass - particle.mass).abs() > T::of(1e-5) * mass {
            particle.mass = mass;
        }
        if let Some(motion) = &body.motion {
            particle.velocity = Vector::of(motion.velocity_at(particle.position.space()));
            particle.spin = spin::<T, D>(motion.spin());
        }
        body.particles.set(i, &particle);
    }
    if velocities == StartVelocities::Zero && body.motion.is_none() {
        body.particles.stop();
    }
}
