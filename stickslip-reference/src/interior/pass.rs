//! The one pass of a step over the particles: F from places, stress, forces on the nodes.
//!
//! All particles of a cell at a time, one in each lane: they see the same nodes. Sums of many terms go register by
//! register. Whole cells of elastic bodies go by [`super::blocks`], and their particles are told only when somebody
//! looks.

// Sums over nodes and components read better by their indices.
#![allow(clippy::needless_range_loop)]

use super::Interior;
use super::blocks::{Elastic, Rows, Whole, determinant};
use crate::cells::{SITES, Table};
use std::mem::MaybeUninit;
use stickslip_kernels::lanes::{Laned, Lanes, MOST_LANES, Machine, Pack, Processor, Work};
use stickslip_kernels::matter::Matter;
use stickslip_kernels::natural::Natural;
use stickslip_kernels::particles::{ColumnStart, Columns, Particles, deformation_entries};
use stickslip_kernels::pass::members::{Copies, HistoryOfGroup, Members};
use stickslip_kernels::pass::{FaultKind, Found, ParticleFault, Verbs};
use stickslip_kernels::viscosity::BulkViscosity;
use stickslip_mechanics::geometry::form::{Cell, Form};
use stickslip_mechanics::material::{Material, Motion, NeoHookean, Thickening, Thickness};
use stickslip_mechanics::scheme::VolumeChange;
use stickslip_mechanics::tensor::{Matrix, Number, Symmetric, Vector};

/// What the pass is told.
#[derive(Clone, Copy, Debug)]
pub struct Straining<T> {
    /// Which body it is, for what is said of faults.
    pub body: usize,
    /// How long the step took that led to these places; zero for none [s].
    pub dt: T,
    /// Bulk viscosity.
    pub viscosity: Option<BulkViscosity<T>>,
    /// What the processor has.
    pub processor: Processor,
    /// What of it is asked for.
    pub asked: Asked,
}

/// What the particles are asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Asked {
    /// Forces on the nodes. Particles of elastic bodies stay behind; others take their state as well.
    Forces,
    /// What somebody sees who looks at particles that stayed behind: forces stay as they are.
    State,
}

/// Lets the particles take the deformation that the nodes' places say, and the stress of their law, and adds up the
/// forces on the nodes:
///
/// ```text
/// F = sum x_I (x) grad N_I      sigma = law(F, F F_before^-1, dt)      P = J sigma F^-T      f_I = -sum V_p P grad N_I
/// x_p = sum N_I x_I             v_p = sum N_I v_I
/// ```
/// Initial stress, heat and bulk viscosity act as on the common grid. Particles of a material that averages its volume
/// share the dilatation of their cell, and its pressure, which is the transpose of that (Hughes 1980, Int. J. Numer.
/// Methods Eng. 15; D: dimensions, in which traces and I are taken):
///
/// ```text
/// Jm = sum V_q J_q / sum V_q      F <- (Jm/J)^(1/D) F
/// p = tr_D(sigma)/D               P = J sigma F^-T with F as it was and J sigma <- Jm (sigma - p I) + J pm I
/// pm = sum V_q p_q / sum V_q
/// ```
///
/// What it found has the fastest wave in undeformed lengths, c |F^-1 n|, which the stable step asks for. With it goes
/// what bulk viscosity took [J].
pub fn strain<T: Laned, const D: usize>(
    interior: &mut Interior<D>,
    table: &Table<T, D>,
    (matter, particles): (&Matter<T>, &mut Particles<T, D>),
    straining: Straining<T>,
) -> (Found<T>, f64) {
    let Straining { body, dt, viscosity, processor, asked } = straining;
    let (mut found, mut damped) = (Found::NOTHING, 0.0);
    // In plane strain a body may have the thickness that plane stress gave it before.
    let thickness = ColumnStart::<D>::DEFORMATION + deformation_entries(D).len() - 1;
    let plane = D == 3
        || matter.thickness == Thickness::Moved
            && particles.line(thickness).iter().all(|&stretch| stretch == T::ONE);
    let columns = particles.open();
    let (found_here, damped_here) = (&mut found, &mut damped);
    let visit = Visit {
        interior,
        table,
        matter,
        columns,
        body,
        dt,
        viscosity,
        plane,
        asked,
        found: found_here,
        damped: damped_here,
    };
    T::run(processor, visit);
    // Cells know particles by their places, which ascend as their numbers do.
    let fault =
        found.fault.map(|fault| ParticleFault { number: particles.numbers()[fault.particle], ..fault });
    (Found { fault, ..found }, damped)
}

struct Visit<'a, T, const D: usize> {
    interior: &'a mut Interior<D>,
    table: &'a Table<T, D>,
    matter: &'a Matter<T>,
    columns: Columns<T, D>,
    body: usize,
    dt: T,
    viscosity: Option<BulkViscosity<T>>,
    /// Whether F has a one beyond the plane.
    plane: bool,
    asked: Asked,
    found: &'a mut Found<T>,
    /// What bulk viscosity took [J].
    damped: &'a mut f64,
}

impl<T: Laned, const D: usize> Work for Visit<'_, T, D> {
    type Real = T;
    type Output = ();
    const BY_AVX512: bool = D == 3 && size_of::<T>() == size_of::<f64>();

    #[inline(always)]
    fn run<M: Machine<T>>(mut self) {
        if const { D == 3 } { self.cells::<M::Wide>() } else { self.cells::<M::Quad>() }
    }

    /// One particle at a time on x86-64: laws for several that few processors need would be a tenth of the program.
    #[cfg(all(target_arch = "x86_64", not(portable_lanes)))]
    fn run_anywhere(mut self) {
        if self.asked == Asked::State {
            return;
        }
        self.interior.forces.fill(Vector::ZERO);
        let (constants, form) = (self.constants(true), self.interior.form.clone());
        form.cells.iter().enumerate().for_each(|(number, cell)| self.one_by_one(&constants, (number, cell)));
    }
}

/// What a body's particles have in common, in lanes.
struct Constants<V> {
    material: Material<V>,
    per_density: V,
    dt: V,
    /// Expansion by temperature [1/K].
    expansion: V,
    /// c_1 h and c_2 h^2 of bulk viscosity [m, m^2].
    viscosity: Option<[V; 2]>,
    /// Whether the law asks for the deformation of the step.
    by_increments: bool,
    /// Whether particles share the dilatation of their cell.
    averages: bool,
    /// Whether forces are asked for.
    pushes: bool,
}

/// What particles answer to their deformation, before it is given to the nodes.
struct Answer<V> {
    /// Cauchy stress that gives forces [Pa].
    stress: Symmetric<V>,
    /// F^-1.
    inverse: Matrix<V>,
    /// V_0 J, zero of those that there are not [m^3].
    volume: V,
    /// J over the mean of the cell.
    share: V,
}

impl<V: Number> Answer<V> {
    /// tr_D(sigma) / D
    #[inline(always)]
    fn mean_stress<const D: usize>(&self) -> V {
        let mut sum = V::ZERO;
        for i in 0..D {
            sum += self.stress.0[i];
        }
        sum * V::of(1.0 / D as f64)
    }

    /// Its own part of a mean over the cell, in the place of the mean stress that it has.
    #[inline(always)]
    fn share_mean<const D: usize>(&mut self, mean: V) {
        let more = self.share.times_plus(mean, -self.mean_stress::<D>());
        for i in 0..D {
            self.stress.0[i] += more;
        }
    }

    /// -V P
    #[inline(always)]
    fn pulls<const D: usize>(&self) -> Matrix<V> {
        let mut pulls = Matrix::ZERO;
        for i in 0..D {
            for a in 0..D {
                let mut sum = V::NOTHING;
                for j in 0..D {
                    sum = self.stress.at(i, j).times_plus(self.inverse.0[a][j], sum);
                }
                pulls.0[i][a] = -(sum * self.volume);
            }
        }
        pulls
    }
}

/// Particles of a cell at most.
const MOST_PARTICLES: usize = SITES;

impl<T: Laned, const D: usize> Visit<'_, T, D> {
    #[inline(always)]
    fn constants<V: Lanes<Real = T>>(&self, pushes: bool) -> Constants<V> {
        Constants {
            material: self.matter.material.map(V::splat),
            per_density: V::splat(T::ONE / self.matter.density),
            dt: V::splat(self.dt),
            expansion: V::splat(self.matter.expansion),
            viscosity: self.viscosity.filter(|_| self.dt > T::ZERO).map(|BulkViscosity { coefficients }| {
                let cell = T::of(self.interior.form.cell);
                [coefficients[0] * cell, coefficients[1] * cell * cell].map(V::splat)
            }),
            by_increments: self.viscosity.is_some()
                || !matches!(*self.matter.material, Material::NeoHookean(_)),
            averages: self.averages(),
            pushes,
        }
    }

    /// Whether particles share the dilatation of their cell.
    #[inline(always)]
    fn averages(&self) -> bool {
        self.matter.volume_change == VolumeChange::Averaged
    }

    #[inline(always)]
    fn cells<V: Lanes<Real = T>>(&mut self) {
        let (form, elastic) = (self.interior.form.clone(), self.elastic());
        let pushes = self.asked == Asked::Forces;
        if pushes {
            self.interior.forces.fill(Vector::ZERO);
            // If one has a fault, who that is is found one by one.
            if let Some(law) = elastic
                && self.pull::<V>(&form, &law)
            {
                return;
            }
        } else if elastic.is_none() {
            return;
        }
        self.each::<V>(&form, pushes);
    }

    /// The law of a body whose particles may stay behind. In single precision, cells side by side would have to share
    /// one place from which theirs are measured.
    fn elastic(&self) -> Option<NeoHookean<T>> {
        // Its pressure depends on J alone, of which in space a mean can take the place.
        let is_plain = self.plane
            && (D == 3 || !self.averages())
            && self.viscosity.is_none()
            && self.columns.natural_columns().is_empty();
        match *self.matter.material {
            Material::NeoHookean(law) if const { size_of::<T>() == size_of::<f64>() } && is_plain => {
                Some(law)
            }
            _ => None,
        }
    }

    /// Forces of an elastic body, unless a particle is not sound; whether all are.
    #[inline(always)]
    fn pull<V: Lanes<Real = T>>(&mut self, form: &Form<D>, law: &NeoHookean<T>) -> bool {
        let mut sound = true;
        // Never otherwise, which compilers see here.
        if const { size_of::<T>() == size_of::<f64>() } {
            let density = self.matter.density;
            let mut fastest = V::Register::ZERO;
            let table = self.table;
            if !table.blocks.is_empty() {
                let whole = Whole::<V::Register, D>::new(form, (law, self.averages()), density);
                let places = Rows::places(&self.interior.places);
                let mut forces = Rows::forces(form.nodes());
                for block in &table.blocks {
                    let rows = (&places, &mut forces);
                    sound &= whole.strain((table, block), &form.offsets, rows, &mut fastest);
                }
                forces.add_to(&mut self.interior.forces);
            }
            let elastic = Elastic::new((law, self.averages()), density);
            for &number in &table.others {
                let at = (number as usize, &form.cells[number as usize]);
                sound &= self.pull_cell::<V>(&elastic, &form.volumes, at, &mut fastest);
            }
            if sound {
                self.take(&fastest.numbers().0[..V::Register::COUNT]);
            } else {
                self.interior.forces.fill(Vector::ZERO);
            }
        }
        sound
    }

    /// Forces of a cell of an elastic body whose particles lie anywhere; whether all are sound.
    #[inline(always)]
    fn pull_cell<V: Lanes<Real = T>>(
        &mut self,
        elastic: &Elastic<V::Register>,
        volumes: &[f64],
        (number, cell): (usize, &Cell),
        fastest: &mut V::Register,
    ) -> bool {
        let (mut pulls, mut sound) = (Matrix::<V>::ZERO, true);
        let volumes = &volumes[cell.first as usize..(cell.first + cell.count) as usize];
        let registers = (0..V::REGISTERS).filter(|n| n * V::Register::COUNT < volumes.len());
        let volume = |first: usize| {
            V::Register::from_fn(|lane| volumes.get(first + lane).map_or(T::ZERO, |&v| T::of(v)))
        };
        let mut mean = None;
        if D == 3 && elastic.averages {
            let mut sums = [T::ZERO; 2];
            for n in registers.clone() {
                let first = n * V::Register::COUNT;
                let own = self.deformation::<V::Register>((number, cell, first));
                let volume = volume(first);
                let here = [volume * determinant(&own), volume].map(total);
                sums = [sums[0] + here[0], sums[1] + here[1]];
            }
            mean = Some(V::Register::splat(sums[0] / sums[1]));
        }
        for n in registers {
            let first = n * V::Register::COUNT;
            let own = self.deformation::<V::Register>((number, cell, first));
            let (here, all) = elastic.pulls::<D>(own, (volume(first), mean), fastest);
            sound &= all;
            for i in 0..D {
                for a in 0..D {
                    pulls.0[i][a].put(n, here.0[i][a]);
                }
            }
        }
        self.scatter(&pulls, (number, cell, 0));
        sound
    }

    /// Lets the particles of all cells take their state, and adds up forces if they are asked for.
    #[inline(always)]
    fn each<V: Lanes<Real = T>>(&mut self, form: &Form<D>, pushes: bool) {
        let constants = self.constants::<V>(pushes);
        let (mut copies, mut fastest) = (Copies::EMPTY, V::ZERO);
        for (number, cell) in form.cells.iter().enumerate() {
            let mut index = [0; MOST_LANES];
            let count = cell.count as usize;
            index.iter_mut().zip(cell.first..).for_each(|(index, particle)| *index = particle);
            let columns = self.columns;
            let members = if count == V::COUNT {
                Members::in_a_row(&columns, &index[..count])
            } else {
                let verbs = Verbs { update_stress: true, ..Verbs::default() };
                Members::copied::<V>(&columns, &index[..count], &verbs, &mut copies)
            };
            if self.lanes(&constants, (number, cell, 0), &members, &mut fastest).is_err() {
                self.one_by_one(&self.constants(pushes), (number, cell));
            }
        }
        if pushes {
            self.take(&fastest.numbers().0[..V::COUNT]);
        }
    }

    /// Takes note of squares of the speeds of waves.
    #[inline(always)]
    fn take(&mut self, squares: &[T]) {
        let most =
            squares.iter().fold(T::ZERO, |most, &square| if square > most { square } else { most }).sqrt();
        self.found.signal = if most > self.found.signal { most } else { self.found.signal };
    }

    /// Takes the particles of a cell one by one, and finds out what is wrong with whom.
    #[inline(never)]
    fn one_by_one(&mut self, constants: &Constants<Pack<T, 1>>, (number, cell): (usize, &Cell)) {
        let (columns, all) = (self.columns, cell.first..cell.first + cell.count);
        let lanes = all.clone().enumerate();
        let alone = |particle: u32| Cell { first: particle, count: 1, ..*cell };
        let form = self.interior.form.clone();
        let volume = |particle: u32| Pack([T::of(form.volumes[particle as usize])]);
        let total = all.clone().fold(Pack::ZERO, |sum, particle| sum + volume(particle));
        let mut dilatation = None;
        if constants.averages {
            let own = |(lane, particle): (usize, u32)| {
                let f = self.deformation::<Pack<T, 1>>((number, &alone(particle), lane));
                volume(particle) * plane_jacobian::<_, D>(&f)
            };
            dilatation = Some(lanes.clone().map(own).fold(Pack::ZERO, |sum, own| sum + own) / total);
        }
        let mut fastest = Pack::ZERO;
        let mut answers: [Option<Answer<Pack<T, 1>>>; MOST_PARTICLES] = [const { None }; MOST_PARTICLES];
        for (lane, particle) in lanes.clone() {
            let index = [particle];
            let members = Members::in_a_row(&columns, &index);
            let at = (number, &alone(particle), lane);
            let own = self.deformation(at);
            match self.respond(constants, (own, dilatation), at, &members, &mut fastest) {
                Ok(answer) => answers[lane] = Some(answer),
                Err(kind) => {
                    let particle = particle as usize;
                    let fault = ParticleFault { body: self.body, particle, number: particle as u32, kind };
                    *self.found = self.found.and(Found { fault: Some(fault), signal: T::ZERO });
                }
            }
        }
        let of = |(_, particle): (usize, u32), answer: &Option<Answer<Pack<T, 1>>>| {
            answer.as_ref().map_or(Pack::ZERO, |answer| volume(particle) * answer.mean_stress::<D>())
        };
        let sum = lanes.clone().zip(&answers).fold(Pack::ZERO, |sum, (at, answer)| sum + of(at, answer));
        let mean = sum / total;
        for (lane, particle) in lanes.filter(|_| constants.pushes) {
            if let Some(answer) = &mut answers[lane] {
                if constants.averages {
                    answer.share_mean::<D>(mean);
                }
                let pulls = answer.pulls::<D>();
                self.scatter(&pulls, (number, &alone(particle), lane));
            }
        }
        self.take(&fastest.0);
    }

    /// F of the particles of a cell from a lane of its table on: sum x_I (x) grad N_I.
    #[inline(always)]
    fn deformation<V: Lanes<Real = T>>(&self, (number, cell, lane): (usize, &Cell, usize)) -> Matrix<V> {
        let entries = self.table.of(number);
        let anchor = self.interior.places[cell.node as usize];
        let mut own = Matrix::<V>::ZERO;
        for k in 0..Form::<D>::NODES {
            let x =
                self.interior.places[cell.node as usize + self.interior.form.offsets[k] as usize] - anchor;
            for a in 0..D {
                // SAFETY: a table has as many numbers as any machine has lanes; a single lane reads one.
                let slope: V =
                    unsafe { V::load(entries[k * Table::<T, D>::ENTRIES + 1 + a].0[lane..].as_ptr()) };
                for i in 0..D {
                    own.0[i][a] = slope.times_plus(V::splat(T::of(x[i])), own.0[i][a]);
                }
            }
        }
        own
    }

    /// Places after that of the cell's first node, and velocities: sum N_I x_I, sum N_I v_I.
    #[inline(always)]
    fn motion<V: Lanes<Real = T>>(&self, (number, cell, lane): (usize, &Cell, usize)) -> [Vector<V, D>; 2] {
        let entries = self.table.of(number);
        let anchor = self.interior.places[cell.node as usize];
        let [mut place, mut velocity] = [Vector::<V, D>::ZERO; 2];
        for k in 0..Form::<D>::NODES {
            let at = cell.node as usize + self.interior.form.offsets[k] as usize;
            let (x, v) = (self.interior.places[at] - anchor, self.interior.velocities[at]);
            // SAFETY: as above.
            let value: V = unsafe { V::load(entries[k * Table::<T, D>::ENTRIES].0[lane..].as_ptr()) };
            for i in 0..D {
                place[i] = value.times_plus(V::splat(T::of(x[i])), place[i]);
                velocity[i] = value.times_plus(V::splat(T::of(v[i])), velocity[i]);
            }
        }
        for i in 0..D {
            place[i] += V::splat(T::of(anchor[i]));
        }
        [place, velocity]
    }

    /// The particles of a cell from a lane of its table on.
    #[inline(always)]
    fn lanes<V: Lanes<Real = T>>(
        &mut self,
        constants: &Constants<V>,
        (number, cell, lane): (usize, &Cell, usize),
        members: &Members<'_, T, D>,
        fastest: &mut V,
    ) -> Result<(), FaultKind> {
        let mut own = Matrix::<V>::ZERO;
        for n in 0..V::REGISTERS {
            let here = self.deformation::<V::Register>((number, cell, lane + n * V::Register::COUNT));
            for i in 0..D {
                for a in 0..D {
                    own.0[i][a].put(n, here.0[i][a]);
                }
            }
        }
        let mut dilatation = None;
        if constants.averages {
            let volume = self.undeformed(constants, members);
            let sums = [volume * plane_jacobian::<V, D>(&own), volume].map(total);
            dilatation = Some(V::splat(sums[0] / sums[1]));
        }
        let mut answer =
            self.respond(constants, (own, dilatation), (number, cell, lane), members, fastest)?;
        if constants.averages {
            let volume = self.undeformed(constants, members);
            let sums = [volume * answer.mean_stress::<D>(), volume].map(total);
            answer.share_mean::<D>(V::splat(sums[0] / sums[1]));
        }
        if constants.pushes {
            self.scatter(&answer.pulls::<D>(), (number, cell, lane));
        }
        Ok(())
    }

    /// Undeformed volumes of the particles that there are, and zero beyond [m^3].
    #[inline(always)]
    fn undeformed<V: Lanes<Real = T>>(&self, constants: &Constants<V>, members: &Members<'_, T, D>) -> V {
        (members.mass::<V>() * constants.per_density).first(members.count())
    }

    /// Gives particles F, of which they share the dilatation if one is given, their places and their velocities, and
    /// the stress that their law answers with. `fastest` becomes the larger of itself and the squares of their waves'
    /// speeds in undeformed lengths, lane by lane [m^2/s^2].
    ///
    /// # Errors
    /// A particle has a fault; of several lanes nothing is stored, of a single one what a report shows.
    #[inline(always)]
    fn respond<V: Lanes<Real = T>>(
        &mut self,
        constants: &Constants<V>,
        (own, dilatation): (Matrix<V>, Option<V>),
        (number, cell, lane): (usize, &Cell, usize),
        members: &Members<'_, T, D>,
        fastest: &mut V,
    ) -> Result<Answer<V>, FaultKind> {
        let before = members.deformation::<V>();
        let mut deformation = own;
        if const { D == 2 } {
            deformation.0[2][2] = before.0[2][2];
        }
        let mut jacobian = deformation.det();
        let mut own = deformation;
        let mut sound = u32::MAX;
        let mut fault = None;
        let mut require = |lanes: u32, kind: FaultKind| {
            sound &= lanes;
            if fault.is_none() && lanes & 1 == 0 {
                fault = Some(kind);
            }
        };
        require(V::splat(T::LARGEST).at_least(jacobian.abs()), FaultKind::NotFinite);
        require(jacobian.at_least(V::splat(T::TINY)), FaultKind::Inverted);
        let mut share = V::ONE;
        if let Some(mean) = dilatation {
            share = plane_jacobian::<V, D>(&own) / mean;
            let ratio = mean / plane_jacobian::<V, D>(&own);
            let stretch = if const { D == 2 } { ratio.sqrt() } else { ratio.cbrt() };
            for i in 0..D {
                for a in 0..D {
                    deformation.0[i][a] *= stretch;
                }
            }
            jacobian *= ratio;
        }
        let increment =
            if constants.by_increments { deformation * before.inverse() } else { Matrix::IDENTITY };
        let stress = if constants.by_increments { members.stress::<V>() } else { Symmetric::ZERO };
        let mut history = HistoryOfGroup::new(members);
        let mut motion = Motion { deformation, jacobian, increment, stress, dt: constants.dt };
        let natural: Option<Natural<V>> = members.natural::<V>(constants.expansion);
        let thickness_is_free = D == 2 && self.matter.thickness == Thickness::Free;
        if let Some(natural) = &natural {
            motion = if const { D == 2 } && thickness_is_free {
                natural.seen_with_free_thickness(&motion)
            } else {
                natural.seen(&motion)
            };
        }
        if const { D == 2 } && thickness_is_free {
            let Thickening { stretch, found } = constants.material.thickening(&motion, &history);
            require(found, FaultKind::NoThickness);
            motion = motion.thickened(stretch);
            let stretch = natural.as_ref().map_or(stretch, |natural| natural.thickening(stretch));
            deformation.0[2][2] *= stretch;
            own.0[2][2] *= stretch;
            jacobian *= stretch;
        }
        let (stress, modulus) = constants.material.respond_with_modulus((&motion, true), &mut history);
        let modulus = natural.as_ref().map_or(modulus, |natural| modulus / natural.volume);
        history.changed = true;
        let [mut bulk, mut damped] = [V::ZERO; 2];
        if let Some([linear, quadratic]) = constants.viscosity {
            let mut strain = V::ZERO;
            for i in 0..D {
                strain += increment.0[i][i] - V::ONE;
            }
            let (rate, speed) = (strain / constants.dt, (modulus * constants.per_density).sqrt());
            let over_density = BulkViscosity::<T>::over_density([linear, quadratic], rate, speed);
            // Its pressure acts on the nodes in the step that comes, and did in that before.
            let before = members.viscosity::<V>() * constants.per_density;
            bulk = over_density / (constants.per_density * jacobian);
            damped = -(before * jacobian + over_density) * strain;
        }
        let sum = stress.0.iter().fold(V::ZERO, |sum, &entry| sum + entry);
        require(V::splat(T::LARGEST).at_least(sum.abs()), FaultKind::NotFinite);
        let all = (1 << V::COUNT) - 1;
        if sound & all != all {
            let kind = fault.unwrap_or(FaultKind::NotFinite);
            if V::COUNT == 1 {
                members.store_for_report((&deformation, jacobian * members.mass::<V>()), kind);
            }
            return Err(kind);
        }
        let inverse = own.inverse();
        let volume = members.mass::<V>() * constants.per_density;
        let speed = modulus * constants.per_density * squared_shrinking::<V, D>(&inverse);
        // What is no number is passed over, on all machines: they give the second one then.
        *fastest = speed.max(*fastest);
        let [place, velocity] = self.motion::<V>((number, cell, lane));
        members.store_vector(ColumnStart::<D>::POSITION, &place);
        members.store_vector(ColumnStart::<D>::VELOCITY, &velocity);
        members.give_back::<V>(ColumnStart::<D>::POSITION..ColumnStart::<D>::SPIN);
        members.store_deformation(&deformation);
        members.store_stress(&stress);
        members.give_back::<V>(ColumnStart::<D>::DEFORMATION..ColumnStart::<D>::START);
        members.store(ColumnStart::<D>::VOLUME, volume * jacobian);
        members.give_back::<V>(ColumnStart::<D>::VOLUME..ColumnStart::<D>::VOLUME + 1);
        history.store::<V>();
        let mut stress = stress;
        if constants.viscosity.is_some() {
            members.store_viscosity(bulk);
            for i in 0..D {
                stress.0[i] -= bulk;
            }
            let energies = (damped * members.mass::<V>()).numbers();
            for energy in &energies.0[..members.count().min(V::COUNT)] {
                *self.damped += 0.5 * energy.f64();
            }
        }
        // Of the particles that there are.
        Ok(Answer { stress, inverse, volume: (volume * jacobian).first(members.count()), share })
    }

    /// f_I += sum over the lanes of -V P grad N_I
    #[inline(always)]
    fn scatter<V: Lanes<Real = T>>(
        &mut self,
        pulls: &Matrix<V>,
        (number, cell, lane): (usize, &Cell, usize),
    ) {
        const { assert!(V::REGISTERS <= 2) };
        let entries = self.table.of(number);
        // What the first of two registers gives.
        let mut lower = [MaybeUninit::<[V::Register; 3]>::uninit(); Form::<3>::NODES];
        for n in 0..V::REGISTERS {
            let mut own = Matrix::<V::Register>::ZERO;
            for i in 0..D {
                for a in 0..D {
                    own.0[i][a] = pulls.0[i][a].register(n);
                }
            }
            let lane = lane + n * V::Register::COUNT;
            for k in 0..Form::<D>::NODES {
                let mut force = [V::Register::NOTHING; 3];
                for a in 0..D {
                    // SAFETY: as above.
                    let slope = unsafe {
                        V::Register::load(entries[k * Table::<T, D>::ENTRIES + 1 + a].0[lane..].as_ptr())
                    };
                    for i in 0..D {
                        force[i] = own.0[i][a].times_plus(slope, force[i]);
                    }
                }
                if n + 1 < V::REGISTERS {
                    lower[k].write(force);
                    continue;
                }
                if V::REGISTERS > 1 {
                    // SAFETY: written for the first register.
                    let lower = unsafe { lower[k].assume_init() };
                    for i in 0..D {
                        force[i] = lower[i] + force[i];
                    }
                }
                let [x, y, z] = force;
                let sums = V::Register::sums([x, y, z, V::Register::ZERO]);
                let at = cell.node as usize + self.interior.form.offsets[k] as usize;
                let force = &mut self.interior.forces[at];
                for i in 0..D {
                    force[i] += sums[i].f64();
                }
            }
        }
    }
}

/// Sum over the lanes.
#[inline(always)]
fn total<V: Lanes>(of: V) -> V::Real {
    of.numbers().0[..V::COUNT].iter().fold(V::Real::ZERO, |sum, &number| sum + number)
}

/// det F in the dimensions of the body's grid.
#[inline(always)]
fn plane_jacobian<V: Number, const D: usize>(f: &Matrix<V>) -> V {
    if D == 2 { f.0[0][0] * f.0[1][1] - f.0[0][1] * f.0[1][0] } else { f.det() }
}

/// A bound of |F^-1 n|^2 over all directions, from the inverse of F: the largest sum of magnitudes in a row of F^-1
/// F^-T.
#[inline(always)]
fn squared_shrinking<V: Number, const D: usize>(inverse: &Matrix<V>) -> V {
    let mut most = V::ZERO;
    for i in 0..D {
        let mut row = V::ZERO;
        for j in 0..D {
            let mut product = V::ZERO;
            for k in 0..D {
                product += inverse.0[i][k] * inverse.0[j][k];
            }
            row += product.abs();
        }
        most = most.max(row);
    }
    most
}
