//! The particles of a group in memory: side by side, or copied so that they are.

use super::{FaultKind, Verbs};
use crate::lanes::{Lanes, MOST_LANES, Numbers, prefetch};
use crate::material::{Keep, MOST_HISTORY, Recall};
use crate::natural::{self, Natural};
use crate::particles::{ColumnStart, Columns, deformation_entries, spin_entries, stress_entries};
use crate::tensor::{Matrix, Real, Symmetric, Vector};
use crate::transfer::Share;
use std::mem::MaybeUninit;
use std::ops::Range;

/// How many particles ahead of the present ones numbers are fetched into the cache:
/// columns are too many for a processor to do so by itself.
pub const AHEAD: usize = 32;

/// Fetches what a pass needs of a particle and those beside it.
#[inline(always)]
pub fn fetch<T: Real, const D: usize>(columns: &Columns<T, D>, particle: usize, verbs: &Verbs) {
    for range in Reads::of(verbs, columns).columns(columns) {
        for column in range {
            // SAFETY: the particle exists.
            prefetch(unsafe { columns.at(column, particle) });
        }
    }
}

/// What a pass reads of particles besides the columns that every pass reads.
#[derive(Clone, Copy)]
struct Reads {
    spin: bool,
    volume: bool,
    /// Mass and half the side of the box, where particles are not alike.
    mass: bool,
    deformation: bool,
    stress: bool,
    /// Entries of the history.
    history: usize,
    /// Entries of what the transfer carries.
    transfer: usize,
    /// Entries of what bulk viscosity needs.
    viscosity: usize,
    /// Entries of what initial stress and heat need.
    natural: usize,
}

impl Reads {
    /// Of particles with these columns.
    #[inline(always)]
    fn of<T: Real, const D: usize>(verbs: &Verbs, columns: &Columns<T, D>) -> Self {
        let gives_momentum = verbs.scatter.is_some_and(Share::has_momentum);
        let gives_stress = verbs.scatter.is_some_and(|share| share.has_force() || share == Share::MeanStress);
        let carries = verbs.advect && !columns.transfer_columns().is_empty();
        Reads {
            spin: verbs.update_velocity || gives_momentum || verbs.settle || carries,
            volume: verbs.update_stress || gives_stress,
            mass: columns.alike().is_none(),
            deformation: verbs.update_stress || verbs.advect,
            stress: verbs.update_stress || gives_stress,
            history: if verbs.update_stress || verbs.advect { columns.history() } else { 0 },
            transfer: if verbs.update_velocity || gives_momentum || verbs.advect {
                columns.transfer_columns().len()
            } else {
                0
            },
            viscosity: if verbs.update_stress || verbs.scatter.is_some_and(Share::has_force) {
                columns.viscosity_columns().len()
            } else {
                0
            },
            natural: if verbs.update_stress || verbs.advect { columns.natural_columns().len() } else { 0 },
        }
    }

    /// All columns that are read.
    #[inline(always)]
    fn columns<T: Real, const D: usize>(self, of: &Columns<T, D>) -> [Range<usize>; 11] {
        let only = |read: bool, columns: Range<usize>| if read { columns } else { 0..0 };
        [
            0..ColumnStart::<D>::SPIN,
            only(self.spin, ColumnStart::<D>::SPIN..ColumnStart::<D>::MASS),
            only(self.mass, ColumnStart::<D>::MASS..ColumnStart::<D>::VOLUME),
            only(self.volume, ColumnStart::<D>::VOLUME..ColumnStart::<D>::HALF_WIDTH),
            only(self.mass, ColumnStart::<D>::HALF_WIDTH..ColumnStart::<D>::DEFORMATION),
            only(self.deformation, ColumnStart::<D>::DEFORMATION..ColumnStart::<D>::STRESS),
            only(self.stress, ColumnStart::<D>::STRESS..ColumnStart::<D>::START),
            ColumnStart::<D>::HISTORY..ColumnStart::<D>::HISTORY + self.history,
            of.transfer_columns().start..of.transfer_columns().start + self.transfer,
            of.viscosity_columns().start..of.viscosity_columns().start + self.viscosity,
            of.natural_columns().start..of.natural_columns().start + self.natural,
        ]
    }
}

/// Up to as many particles as there are lanes, as columns: the body's own where they lie side by side, else copies.
/// They are read and written whole registers at a time: those that do not fill the lanes from copies.
pub struct Members<'a, T, const D: usize> {
    columns: &'a Columns<T, D>,
    /// How many.
    count: usize,
    first: *mut T,
    stride: usize,
    /// Whence they were copied, if they were.
    runs: Option<&'a ParticleRuns>,
}

/// Columns of particles that do not lie side by side or do not fill the lanes, with room for a register from any lane
/// on.
pub struct Copies<T> {
    columns: [[MaybeUninit<Numbers<T>>; 2]; MOST_COLUMNS],
    runs: ParticleRuns,
}

/// Particles of a group that lie side by side in memory.
#[derive(Clone, Copy)]
struct ParticleRun {
    /// Lane of the first.
    lane: usize,
    /// Its index.
    first: usize,
    count: usize,
}

/// All particles of a group.
struct ParticleRuns {
    runs: [ParticleRun; MOST_LANES],
    count: usize,
}

impl ParticleRuns {
    const NONE: Self =
        ParticleRuns { runs: [ParticleRun { lane: 0, first: 0, count: 0 }; MOST_LANES], count: 0 };

    /// The runs of a group's indices, one after the other.
    #[inline(always)]
    fn find(&mut self, index: &[u32]) {
        self.count = 0;
        for (lane, &i) in index.iter().enumerate().take(MOST_LANES) {
            let first = i as usize;
            match self.runs[..self.count].last_mut() {
                Some(run) if run.first + run.count == first => run.count += 1,
                _ => {
                    self.runs[self.count] = ParticleRun { lane, first, count: 1 };
                    self.count += 1;
                }
            }
        }
    }
}

/// Columns of a particle in space.
const MOST_COLUMNS: usize =
    ColumnStart::<3>::HISTORY + MOST_HISTORY + stress_entries(3) + 1 + natural::most_entries(3);

impl<'a, T: Real, const D: usize> Members<'a, T, D> {
    /// Particles that lie side by side.
    #[inline(always)]
    pub fn in_a_row(columns: &'a Columns<T, D>, index: &[u32]) -> Self {
        // SAFETY: the particle exists.
        let first = unsafe { columns.at(0, index[0] as usize) };
        Members { columns, count: index.len(), first, stride: columns.stride(), runs: None }
    }

    /// Particles anywhere.
    #[inline(always)]
    pub fn copied<V: Lanes<Real = T>>(
        columns: &'a Columns<T, D>,
        index: &[u32],
        verbs: &Verbs,
        copies: &'a mut Copies<T>,
    ) -> Self {
        // SAFETY: the tile's particles are this pass' alone.
        unsafe { copies.take::<V, D>(columns, index, Reads::of(verbs, columns)) };
        Members {
            columns,
            count: index.len(),
            first: copies.columns.as_mut_ptr().cast(),
            stride: Copies::<T>::STRIDE,
            runs: Some(&copies.runs),
        }
    }

    /// Entries of their history.
    #[inline(always)]
    pub fn history(&self) -> usize {
        self.columns.history()
    }

    /// How many.
    #[inline(always)]
    pub fn count(&self) -> usize {
        self.count
    }

    /// A column; lanes beyond repeat the first particle.
    #[inline(always)]
    pub fn load<V: Lanes<Real = T>>(&self, column: usize) -> V {
        // SAFETY: the tile's particles are this pass' alone.
        unsafe {
            let first = self.first.add(column * self.stride);
            V::load(first)
        }
    }

    /// Writes a column.
    #[inline(always)]
    pub fn store<V: Lanes<Real = T>>(&self, column: usize, numbers: V) {
        // SAFETY: as above.
        unsafe {
            let first = self.first.add(column * self.stride);
            numbers.store(first)
        }
    }

    /// Writes what was stored in copies of some columns to the particles.
    #[inline(always)]
    pub fn give_back<V: Lanes<Real = T>>(&self, columns: Range<usize>) {
        let Some(ParticleRuns { runs, count }) = self.runs else { return };
        for run in &runs[..*count] {
            for column in columns.clone() {
                // SAFETY: the tile's particles are this pass' alone, and copies have room for a register from any lane
                // on.
                unsafe {
                    let copy = V::load(self.first.add(column * self.stride + run.lane));
                    copy.store_part(self.columns.at(column, run.first), run.count);
                }
            }
        }
    }

    /// Their masses [kg].
    #[inline(always)]
    pub fn mass<V: Lanes<Real = T>>(&self) -> V {
        match self.columns.alike() {
            Some([mass, _]) => V::splat(mass),
            None => self.load(ColumnStart::<D>::MASS),
        }
    }

    /// Half the sides of their undeformed boxes [m].
    #[inline(always)]
    pub fn half_width<V: Lanes<Real = T>>(&self) -> V {
        match self.columns.alike() {
            Some([_, half_width]) => V::splat(half_width),
            None => self.load(ColumnStart::<D>::HALF_WIDTH),
        }
    }

    /// A vector, from its first component on.
    #[inline(always)]
    pub fn vector<V: Lanes<Real = T>>(&self, column: usize) -> Vector<V, D> {
        // No closure: the compiler may leave one of this size uninlined, and then its instructions are calls.
        let mut vector = Vector::ZERO;
        for i in 0..D {
            vector[i] = self.load(column + i);
        }
        vector
    }

    /// Writes a vector.
    #[inline(always)]
    pub fn store_vector<V: Lanes<Real = T>>(&self, column: usize, vector: &Vector<V, D>) {
        for i in 0..D {
            self.store(column + i, vector[i]);
        }
    }

    /// Angular velocity, in the plane about the third axis.
    #[inline(always)]
    pub fn spin<V: Lanes<Real = T>>(&self) -> Vector<V, 3> {
        let mut spin = Vector::ZERO;
        for k in 0..spin_entries(D) {
            spin[3 - spin_entries(D) + k] = self.load(ColumnStart::<D>::SPIN + k);
        }
        spin
    }

    /// Writes the angular velocity.
    #[inline(always)]
    pub fn store_spin<V: Lanes<Real = T>>(&self, spin: &Vector<V, 3>) {
        for k in 0..spin_entries(D) {
            self.store(ColumnStart::<D>::SPIN + k, spin[3 - spin_entries(D) + k]);
        }
    }

    /// The rate of strain that the transfer carries; zero if it carries none.
    #[inline(always)]
    pub fn strain_rate<V: Lanes<Real = T>>(&self) -> Symmetric<V> {
        let mut rate = Symmetric::ZERO;
        for (entry, column) in rate.0.iter_mut().zip(self.columns.transfer_columns()) {
            *entry = self.load(column);
        }
        rate
    }

    /// Writes the rate of strain that the transfer carries.
    #[inline(always)]
    pub fn store_strain_rate<V: Lanes<Real = T>>(&self, rate: &Symmetric<V>) {
        for (&entry, column) in rate.0.iter().zip(self.columns.transfer_columns()) {
            self.store(column, entry);
        }
        self.give_back::<V>(self.columns.transfer_columns());
    }

    /// Pressure of the bulk viscosity [Pa]; zero if there is none.
    #[inline(always)]
    pub fn viscosity<V: Lanes<Real = T>>(&self) -> V {
        let mut pressure = V::ZERO;
        for column in self.columns.viscosity_columns() {
            pressure = self.load(column);
        }
        pressure
    }

    /// Writes the pressure of the bulk viscosity.
    #[inline(always)]
    pub fn store_viscosity<V: Lanes<Real = T>>(&self, pressure: V) {
        for column in self.columns.viscosity_columns() {
            self.store(column, pressure);
        }
        self.give_back::<V>(self.columns.viscosity_columns());
    }

    /// The state without stress; `None` where that is the one in which the body is drawn.
    #[inline(always)]
    pub fn natural<V: Lanes<Real = T>>(&self, expansion: V) -> Option<Natural<V>> {
        let columns = self.columns.natural_columns();
        if columns.is_empty() {
            return None;
        }
        let mut entries = [V::ZERO; natural::most_entries(3)];
        for (entry, column) in entries.iter_mut().zip(columns.clone()) {
            *entry = self.load(column);
        }
        Some(Natural::new::<D>((&entries, columns.len()), expansion))
    }

    /// F.
    #[inline(always)]
    pub fn deformation<V: Lanes<Real = T>>(&self) -> Matrix<V> {
        let mut f = Matrix::ZERO;
        for (k, &[row, column]) in deformation_entries(D).iter().enumerate() {
            f.0[row][column] = self.load(ColumnStart::<D>::DEFORMATION + k);
        }
        f
    }

    /// Writes F.
    #[inline(always)]
    pub fn store_deformation<V: Lanes<Real = T>>(&self, f: &Matrix<V>) {
        for (k, &[row, column]) in deformation_entries(D).iter().enumerate() {
            self.store(ColumnStart::<D>::DEFORMATION + k, f.0[row][column]);
        }
    }

    /// Cauchy stress [Pa].
    #[inline(always)]
    pub fn stress<V: Lanes<Real = T>>(&self) -> Symmetric<V> {
        let mut stress = Symmetric::ZERO;
        for k in 0..stress_entries(D) {
            stress.0[k] = self.load(ColumnStart::<D>::STRESS + k);
        }
        stress
    }

    /// Writes the stress.
    #[inline(always)]
    pub fn store_stress<V: Lanes<Real = T>>(&self, stress: &Symmetric<V>) {
        for k in 0..stress_entries(D) {
            self.store(ColumnStart::<D>::STRESS + k, stress.0[k]);
        }
    }
}

impl<T: Real, const D: usize> Members<'_, T, D> {
    /// Keeps of a particle with a fault what a picture of it shows: F and volume, if these are numbers.
    #[inline(always)]
    pub fn store_for_report<V: Lanes<Real = T>>(
        &self,
        (deformation, volume): (&Matrix<V>, V),
        kind: FaultKind,
    ) {
        if kind == FaultKind::Inverted {
            self.store_deformation(deformation);
            self.store(ColumnStart::<D>::VOLUME, volume);
        }
    }
}

/// The history of a group: what its particles remember, and what they will once the pass is known to be sound.
pub struct HistoryOfGroup<'a, 'b, T, const D: usize> {
    members: &'a Members<'b, T, D>,
    /// An entry after the other, as the registers were stored; only those that were kept.
    after: [MaybeUninit<Numbers<T>>; MOST_HISTORY],
    /// Whether it was kept.
    pub changed: bool,
}

impl<'a, 'b, T: Real, const D: usize> HistoryOfGroup<'a, 'b, T, D> {
    /// As the particles remember it.
    #[inline(always)]
    pub fn new(members: &'a Members<'b, T, D>) -> Self {
        HistoryOfGroup { members, after: [const { MaybeUninit::uninit() }; MOST_HISTORY], changed: false }
    }

    /// How many entries.
    #[inline(always)]
    fn entries(&self) -> usize {
        self.members.history()
    }

    /// Where the lanes of an entry lie that was kept.
    #[inline(always)]
    fn lanes(&mut self, entry: usize) -> *mut T {
        self.after[entry].as_mut_ptr().cast()
    }

    /// The same to be read.
    #[inline(always)]
    fn kept(&self, entry: usize) -> *const T {
        self.after[entry].as_ptr().cast()
    }

    /// Writes what was kept to the particles.
    #[inline(always)]
    pub fn store<V: Lanes<Real = T>>(&mut self) {
        let first = ColumnStart::<D>::HISTORY;
        for entry in 0..self.entries() {
            // SAFETY: it was kept.
            let numbers = unsafe { V::load(self.lanes(entry)) };
            self.members.store(first + entry, numbers);
        }
        self.members.give_back::<V>(first..first + self.entries());
    }
}

impl<V: Lanes, const D: usize> Recall<V> for HistoryOfGroup<'_, '_, V::Real, D> {
    const DIMENSION: usize = D;
    #[inline(always)]
    fn recall(&self, entry: usize) -> V {
        match self.changed {
            // SAFETY: it was kept.
            true => unsafe { V::load(self.kept(entry)) },
            false => self.members.load(ColumnStart::<D>::HISTORY + entry),
        }
    }
}

impl<V: Lanes, const D: usize> Keep<V> for HistoryOfGroup<'_, '_, V::Real, D> {
    #[inline(always)]
    fn keep(&mut self, entry: usize, value: V) {
        // SAFETY: there is room for any machine's lanes.
        unsafe { value.store(self.lanes(entry)) };
    }
}

impl<T: Real> Copies<T> {
    /// Nothing yet.
    pub const EMPTY: Self =
        Copies { columns: [const { [MaybeUninit::uninit(); 2] }; MOST_COLUMNS], runs: ParticleRuns::NONE };

    /// Entries from a column to the next.
    const STRIDE: usize = size_of::<[Numbers<T>; 2]>() / size_of::<T>();

    /// What a pass reads; lanes beyond repeat the first particle, but where masks see to that.
    ///
    /// # Safety
    /// The particles must exist, and nobody may write to them meanwhile.
    #[inline(always)]
    unsafe fn take<V: Lanes<Real = T>, const D: usize>(
        &mut self,
        columns: &Columns<T, D>,
        index: &[u32],
        reads: Reads,
    ) {
        self.runs.find(index);
        for i in 0..self.runs.count {
            let run = self.runs.runs[i];
            // SAFETY: the caller's.
            unsafe {
                self.take_run::<V, D>(columns, run, 0..ColumnStart::<D>::SPIN);
                if reads.spin {
                    self.take_run::<V, D>(columns, run, ColumnStart::<D>::SPIN..ColumnStart::<D>::MASS);
                }
                if reads.mass {
                    self.take_run::<V, D>(columns, run, ColumnStart::<D>::MASS..ColumnStart::<D>::VOLUME);
                    let half_width = ColumnStart::<D>::HALF_WIDTH..ColumnStart::<D>::DEFORMATION;
                    self.take_run::<V, D>(columns, run, half_width);
                }
                if reads.volume {
                    self.take_run::<V, D>(
                        columns,
                        run,
                        ColumnStart::<D>::VOLUME..ColumnStart::<D>::HALF_WIDTH,
                    );
                }
                if reads.deformation {
                    self.take_run::<V, D>(
                        columns,
                        run,
                        ColumnStart::<D>::DEFORMATION..ColumnStart::<D>::STRESS,
                    );
                }
                if reads.stress {
                    self.take_run::<V, D>(columns, run, ColumnStart::<D>::STRESS..ColumnStart::<D>::START);
                }
                if reads.history > 0 {
                    let first = ColumnStart::<D>::HISTORY;
                    self.take_run::<V, D>(columns, run, first..first + reads.history);
                }
                if reads.transfer > 0 {
                    self.take_run::<V, D>(columns, run, columns.transfer_columns());
                }
                if reads.viscosity > 0 {
                    self.take_run::<V, D>(columns, run, columns.viscosity_columns());
                }
                if reads.natural > 0 {
                    self.take_run::<V, D>(columns, run, columns.natural_columns());
                }
            }
        }
        if self.runs.count > 1 && index.len() < V::COUNT {
            for column in reads.columns(columns).into_iter().flatten() {
                let copy = &mut self.columns[column];
                let copy = copy.as_mut_ptr().cast::<T>();
                // SAFETY: the first was copied, and there is room for a register from any lane on.
                unsafe { V::splat(*copy).store(copy.add(index.len())) };
            }
        }
    }

    /// Columns whose number the compiler knows, so that it needs no loop.
    #[inline(always)]
    unsafe fn take_run<V: Lanes<Real = T>, const D: usize>(
        &mut self,
        columns: &Columns<T, D>,
        run: ParticleRun,
        which: Range<usize>,
    ) {
        // SAFETY: the caller's, and there is room for a register from any lane on.
        unsafe {
            let mut there = columns.at(which.start, run.first);
            let mut place = self.columns.as_mut_ptr().cast::<T>().add(which.start * Self::STRIDE + run.lane);
            for _ in which {
                V::load_part(there, run.count, *there).store(place);
                (there, place) = (there.wrapping_add(columns.stride()), place.wrapping_add(Self::STRIDE));
            }
        }
    }
}
