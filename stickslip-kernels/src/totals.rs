//! Sums over the particles of a body, several at a time.

use crate::exact::ExactSum;
use crate::lanes::{Laned, Lanes, MOST_LANES, Machine, Processor, Work};
use crate::material::{Material, Recall};
use crate::matter::{Gyration, Matter};
use crate::natural::{self, Natural};
use crate::particles::{ColumnStart, Columns, Particles, deformation_entries, spin_entries, stress_entries};
use crate::tensor::{Matrix, Real, Symmetric, cross};
use crate::threads::by_parts;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Sums over the particles of one body, in `f64` and SI units whatever the precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Totals {
    /// sum m [kg]
    pub mass: f64,
    /// sum m x [kg m]
    pub first_moment: [f64; 3],
    /// sum m v [kg m/s]
    pub momentum: [f64; 3],
    /// sum m (x cross v + k^2 w), about the origin; k: radius of gyration, w: angular velocity of a particle [kg m^2/s]
    pub angular_momentum: [f64; 3],
    /// sum m (v^2 + k^2 w^2 + k^2/2 |E|^2) / 2, E: rate of strain that a particle carries by APIC [J]
    pub kinetic: f64,
    /// sum V W [J]
    pub strain: f64,
    /// sum V D, what the material dissipated: by plastic flow, viscosity or damage [J]
    pub plastic: f64,
}

/// Particles that are summed up by one thread.
const PART: usize = 1 << 14;

/// The sums of [`Totals`] before they are rounded.
#[derive(Clone, Default)]
pub struct TotalSums {
    mass: ExactSum,
    first_moment: [ExactSum; 3],
    momentum: [ExactSum; 3],
    angular_momentum: [ExactSum; 3],
    kinetic: ExactSum,
    strain: ExactSum,
    plastic: ExactSum,
}

impl TotalSums {
    /// All of them.
    pub fn all(&mut self) -> impl Iterator<Item = &mut ExactSum> {
        let TotalSums { mass, first_moment, momentum, angular_momentum, kinetic, strain, plastic } = self;
        let vectors = first_moment.iter_mut().chain(momentum).chain(angular_momentum);
        [mass, kinetic, strain, plastic].into_iter().chain(vectors)
    }

    /// The sums of both.
    fn with(mut self, mut other: Self) -> Self {
        self.all().zip(other.all()).for_each(|(sum, other)| sum.merge(other));
        self
    }

    /// The totals.
    pub fn rounded(&self) -> Totals {
        let vector = |sums: &[ExactSum; 3]| std::array::from_fn(|i| sums[i].value());
        Totals {
            mass: self.mass.value(),
            first_moment: vector(&self.first_moment),
            momentum: vector(&self.momentum),
            angular_momentum: vector(&self.angular_momentum),
            kinetic: self.kinetic.value(),
            strain: self.strain.value(),
            plastic: self.plastic.value(),
        }
    }
}

/// A number of each particle of a chunk.
type Each = [f64; MOST_LANES];

/// Mass and motion of a few particles that lie side by side in memory; zero in the lanes beyond.
struct ParticleChunk {
    mass: Each,
    position: [Each; 3],
    velocity: [Each; 3],
    spin: [Each; 3],
    /// Moment of inertia of the particle itself, m k^2 [kg m^2].
    inertia: Each,
}

impl ParticleChunk {
    /// # Safety
    /// The particles must exist, and nobody may write to them meanwhile.
    #[inline(always)]
    unsafe fn new<V: Lanes, const D: usize>(
        columns: &Columns<V::Real, D>,
        gyration: &Gyration<f64>,
        (first, count): (usize, usize),
    ) -> Self {
        let mut chunk = ParticleChunk {
            mass: [0.0; MOST_LANES],
            position: [[0.0; MOST_LANES]; 3],
            velocity: [[0.0; MOST_LANES]; 3],
            spin: [[0.0; MOST_LANES]; 3],
            inertia: [0.0; MOST_LANES],
        };
        // SAFETY: the caller's.
        unsafe {
            chunk.mass = each(V::load_first(columns.at(ColumnStart::<D>::MASS, first), count));
            for i in 0..D {
                chunk.position[i] =
                    each(V::load_first(columns.at(ColumnStart::<D>::POSITION + i, first), count));
                chunk.velocity[i] =
                    each(V::load_first(columns.at(ColumnStart::<D>::VELOCITY + i, first), count));
            }
            for k in 0..spin_entries(D) {
                chunk.spin[3 - spin_entries(D) + k] =
                    each(V::load_first(columns.at(ColumnStart::<D>::SPIN + k, first), count));
            }
            let half_width = each(V::load_first(columns.at(ColumnStart::<D>::HALF_WIDTH, first), count));
            let of_each = chunk.mass.iter().zip(&half_width);
            for (inertia, (mass, &half_width)) in chunk.inertia.iter_mut().zip(of_each) {
                *inertia = mass * gyration.squared(half_width);
            }
        }
        chunk
    }

    /// m (x cross v + k^2 w), about a point that moves.
    #[inline(always)]
    fn angular_momentum(&self, lane: usize, center: [f64; 3], mean: [f64; 3]) -> [f64; 3] {
        let [r, v] = [(&self.position, center), (&self.velocity, mean)]
            .map(|(x, of)| [x[0][lane] - of[0], x[1][lane] - of[1], x[2][lane] - of[2]]);
        let orbital = cross(r, v);
        [0, 1, 2].map(|i| self.mass[lane] * orbital[i] + self.inertia[lane] * self.spin[i][lane])
    }
}

#[inline(always)]
fn each<V: Lanes>(numbers: V) -> Each {
    let numbers = numbers.numbers();
    let mut each = [0.0; MOST_LANES];
    for (x, number) in each.iter_mut().zip(numbers.0) {
        *x = number.f64();
    }
    each
}

/// The particles of a part, chunk by chunk.
#[inline(always)]
fn chunks<V: Lanes>(part: &Range<usize>) -> impl Iterator<Item = (usize, usize)> + use<V> {
    let end = part.end;
    part.clone().step_by(V::COUNT).map(move |first| (first, V::COUNT.min(end - first)))
}

/// Totals of some particles of a body.
struct SumOfRange<'a, T, const D: usize> {
    columns: Columns<T, D>,
    part: Range<usize>,
    gyration: Gyration<f64>,
    /// The law, but for rigid bodies.
    material: Option<&'a Material<T>>,
    /// Mass per undeformed volume [kg/m^3].
    density: f64,
    /// Expansion by temperature [1/K].
    expansion: T,
}

impl<T: Laned, const D: usize> Work for SumOfRange<'_, T, D> {
    type Real = T;
    type Output = TotalSums;

    #[inline(always)]
    fn run<M: Machine<T>>(self) -> TotalSums {
        let mut sums = TotalSums::default();
        let material = self.material.map(|material| material.map(M::Wide::splat));
        let carries_strain = !self.columns.transfer_columns().is_empty();
        for (first, count) in chunks::<M::Wide>(&self.part) {
            // SAFETY: the particles are the body's, which is borrowed for reading.
            let some =
                unsafe { ParticleChunk::new::<M::Wide, D>(&self.columns, &self.gyration, (first, count)) };
            let rates = if carries_strain {
                // SAFETY: as above.
                unsafe { strain_rates::<M::Wide, D>(&self.columns, (first, count)) }
            } else {
                [0.0; MOST_LANES]
            };
            for (lane, rate) in rates.into_iter().enumerate().take(count) {
                let (m, inertia) = (some.mass[lane], some.inertia[lane]);
                let l = some.angular_momentum(lane, [0.0; 3], [0.0; 3]);
                let mut kinetic = 0.25 * inertia * rate;
                sums.mass.add(m);
                for (i, &l) in l.iter().enumerate() {
                    let (v, w) = (some.velocity[i][lane], some.spin[i][lane]);
                    sums.angular_momentum[i].add(l);
                    kinetic += 0.5 * (m * v * v + inertia * w * w);
                    if i < D {
                        sums.first_moment[i].add(m * some.position[i][lane]);
                        sums.momentum[i].add(m * v);
                    }
                }
                sums.kinetic.add(kinetic);
            }
            if let Some(material) = &material {
                // SAFETY: as above.
                let [energy, dissipation, jacobian] = unsafe {
                    stored(&self.columns, (material, M::Wide::splat(self.expansion)), first, count)
                };
                for lane in 0..count {
                    // A particle that turned inside out has stopped the run and has no energy.
                    if jacobian[lane] > 0.0 {
                        let undeformed = some.mass[lane] / self.density;
                        sums.strain.add(undeformed * energy[lane]);
                        sums.plastic.add(undeformed * dissipation[lane]);
                    }
                }
            }
        }
        sums
    }
}

/// |E|^2 of the rate of strain that a transfer carries [1/s^2].
///
/// # Safety
/// As for [`stored`].
#[inline(always)]
unsafe fn strain_rates<V: Lanes, const D: usize>(
    columns: &Columns<V::Real, D>,
    (first, count): (usize, usize),
) -> Each {
    let mut rate = Symmetric::ZERO;
    for (entry, column) in rate.0.iter_mut().zip(columns.transfer_columns()) {
        // SAFETY: the caller's.
        *entry = unsafe { V::load_first(columns.at(column, first), count) };
    }
    each(rate.double_dot(&rate))
}

/// Strain energy and dissipation per undeformed volume [J/m^3], and J [-], of a material and its expansion by
/// temperature.
///
/// # Safety
/// The particles must exist, and nobody may write to them meanwhile.
#[inline(always)]
unsafe fn stored<V: Lanes, const D: usize>(
    columns: &Columns<V::Real, D>,
    (material, expansion): (&Material<V>, V),
    first: usize,
    count: usize,
) -> [Each; 3] {
    let (mut f, mut stress) = (Matrix::ZERO, Symmetric::ZERO);
    // SAFETY: the caller's.
    unsafe {
        for (k, &[row, column]) in deformation_entries(D).iter().enumerate() {
            f.0[row][column] = V::load_first(columns.at(ColumnStart::<D>::DEFORMATION + k, first), count);
        }
        for k in 0..stress_entries(D) {
            stress.0[k] = V::load_first(columns.at(ColumnStart::<D>::STRESS + k, first), count);
        }
    }
    let jacobian = f.det();
    let mut per_volume = V::ONE;
    let natural = columns.natural_columns();
    if !natural.is_empty() {
        let mut entries = [V::ZERO; natural::most_entries(3)];
        for (entry, column) in entries.iter_mut().zip(natural.clone()) {
            // SAFETY: the caller's.
            *entry = unsafe { V::load_first(columns.at(column, first), count) };
        }
        let natural = Natural::new::<D>((&entries, natural.len()), expansion);
        (f, per_volume) = (natural.elastic(&f, jacobian).0, V::ONE / natural.volume);
    }
    let [energy, dissipation] = material.energies(&f, &stress, &HistoryOfSome { columns, first, count });
    [each(energy * per_volume), each(dissipation * per_volume), each(jacobian)]
}

/// The history of particles that lie side by side; zero in the lanes beyond.
struct HistoryOfSome<'a, T, const D: usize> {
    columns: &'a Columns<T, D>,
    first: usize,
    count: usize,
}

impl<V: Lanes, const D: usize> Recall<V> for HistoryOfSome<'_, V::Real, D> {
    const DIMENSION: usize = D;
    #[inline(always)]
    fn recall(&self, entry: usize) -> V {
        // SAFETY: the particles are the body's, which is borrowed for reading.
        unsafe { V::load_first(self.columns.at(ColumnStart::<D>::HISTORY + entry, self.first), self.count) }
    }
}

/// Inertia tensor [kg m^2] and angular momentum [kg m^2/s] of some particles of a body about a point that moves.
struct Turning<T, const D: usize> {
    columns: Columns<T, D>,
    part: Range<usize>,
    gyration: Gyration<f64>,
    center: [f64; 3],
    mean: [f64; 3],
}

impl<T: Laned, const D: usize> Work for Turning<T, D> {
    type Real = T;
    type Output = TurningSums;

    #[inline(always)]
    fn run<M: Machine<T>>(self) -> TurningSums {
        let TurningSums { mut moments, mut angular } = TurningSums::default();
        for (first, count) in chunks::<M::Wide>(&self.part) {
            // SAFETY: the particles are the body's, which is borrowed for reading.
            let some =
                unsafe { ParticleChunk::new::<M::Wide, D>(&self.columns, &self.gyration, (first, count)) };
            for lane in 0..count {
                let (m, l) = (some.mass[lane], some.angular_momentum(lane, self.center, self.mean));
                let [x, y, z] = [0, 1, 2].map(|i| some.position[i][lane] - self.center[i]);
                // Moments of the particle itself: half of its k^2 along each axis.
                let own = 0.5 * some.inertia[lane];
                let squares = [x * x, y * y, z * z].map(|square| m * square + own);
                let products = [x * y, y * z, x * z].map(|product| m * product);
                moments.iter_mut().zip(squares.into_iter().chain(products)).for_each(|(sum, x)| sum.add(x));
                angular.iter_mut().zip(l).for_each(|(sum, l)| sum.add(l));
            }
        }
        TurningSums { moments, angular }
    }
}

/// Sums over particles about a point that moves.
#[derive(Clone, Default)]
pub struct TurningSums {
    /// sum m x x: xx, yy, zz, xy, yz, xz.
    moments: [ExactSum; 6],
    /// sum m x cross v
    angular: [ExactSum; 3],
}

impl TurningSums {
    /// All of them.
    pub fn all(&mut self) -> impl Iterator<Item = &mut ExactSum> {
        self.moments.iter_mut().chain(&mut self.angular)
    }

    /// Inertia tensor [kg m^2] and angular momentum [kg m^2/s].
    fn rounded(&self) -> (Matrix<f64>, [f64; 3]) {
        let [xx, yy, zz, xy, yz, xz] = self.moments.each_ref().map(|sum| sum.value());
        let inertia = Matrix([[yy + zz, -xy, -xz], [-xy, xx + zz, -yz], [-xz, -yz, xx + yy]]);
        (inertia, self.angular.each_ref().map(|sum| sum.value()))
    }

    /// Angular velocity [rad/s].
    pub fn spin<const D: usize>(&self) -> [f64; 3] {
        let (inertia, angular) = self.rounded();
        quotient::<D>(&inertia, angular)
    }

    /// Angular velocity of a body whose particles have velocities and no spins yet: as if they were points. Where these
    /// stand on one line, which cannot tell how it turns about itself, they keep a little of their own inertia [rad/s].
    /// Of the particles as points, and as they are.
    pub fn spin_of_points<const D: usize>([points, whole]: &[Self; 2]) -> [f64; 3] {
        let ((points, angular), (whole, _)) = (points.rounded(), whole.rounded());
        let size = |inertia: &Matrix<f64>| if D == 2 { inertia.0[2][2] } else { inertia.det() };
        if size(&points) > ON_A_LINE * size(&whole) {
            return quotient::<D>(&points, angular);
        }
        quotient::<D>(&(points * (1.0 - OWN_SHARE) + whole * OWN_SHARE), angular)
    }

    /// The sums of both.
    fn with(mut self, mut other: Self) -> Self {
        self.all().zip(other.all()).for_each(|(sum, other)| sum.merge(other));
        self
    }
}

/// Angular velocity of what has this inertia tensor and angular momentum; in the plane about the third axis.
fn quotient<const D: usize>(inertia: &Matrix<f64>, angular: [f64; 3]) -> [f64; 3] {
    if D == 2 {
        return [0.0, 0.0, angular[2] / inertia.0[2][2]];
    }
    let inverse = inertia.inverse();
    std::array::from_fn(|i| (0..3).map(|j| inverse.0[i][j] * angular[j]).sum())
}

/// Points stand on a line (in the plane: are one) where their inertia tensor has no more than this part of the
/// determinant of the body's.
const ON_A_LINE: f64 = 1e-6;
/// What points on a line keep of the inertia of their particles: so much is lost of the spin across the line, and
/// round-off of single precision makes no spin about it.
const OWN_SHARE: f64 = 1e-3;

/// The sums over the particles of a body before they are rounded; one that is rigid stores no energy.
pub fn total_sums<T: Laned, const D: usize>(
    matter: &Matter<T>,
    particles: &Particles<T, D>,
    is_rigid: bool,
) -> TotalSums {
    let sum = |part| {
        let material = (!is_rigid).then_some(&*matter.material);
        let density = matter.density.f64();
        let (columns, gyration, expansion) = (particles.view(), matter.gyration(), matter.expansion);
        T::run(Processor::best(), SumOfRange { columns, part, gyration, material, density, expansion })
    };
    by_parts(particles.len(), PART, sum).into_iter().reduce(TotalSums::with).unwrap_or_default()
}

/// Inertia and angular momentum about the centre of mass, for particles of this size, of these particles of a body with
/// these totals.
pub fn turning_sums<T: Laned, const D: usize>(
    particles: &Particles<T, D>,
    totals: &Totals,
    gyration: Gyration<f64>,
) -> TurningSums {
    let center = totals.first_moment.map(|x| x / totals.mass);
    let mean = totals.momentum.map(|p| p / totals.mass);
    let turning = |part| {
        let columns = particles.view();
        T::run(Processor::best(), Turning { columns, part, gyration, center, mean })
    };
    by_parts(particles.len(), PART, turning).into_iter().reduce(TurningSums::with).unwrap_or_default()
}
