//! The same pass where nobody looks at the particles, for elastic bodies: several cells at a time, one in each lane.
//!
//! Particles of whole cells lie at the same places, so that their functions are products of the same numbers, and sums
//! over nodes go axis by axis: a quarter of the multiplications. Nothing is written but forces. Stress depends on F F^T
//! alone, so that F may be taken along the axes of the body's grid.

// Sums over axes read better by their indices.
#![allow(clippy::needless_range_loop)]

use crate::cells::{ALONG, Block, SITES, Table};
use stickslip_kernels::lanes::{Laned, Lanes, MOST_LANES};
use stickslip_mechanics::geometry::form::Form;
use stickslip_mechanics::geometry::form::spline::{Axis, WIDTH};
use stickslip_mechanics::material::{Law, Motion, NeoHookean};
use stickslip_mechanics::tensor::{Matrix, Number, Real, Symmetric, Vector};

/// Places across the axes but the first.
const ACROSS: usize = SITES / 2;

/// Vectors of the nodes component by component, so that those of cells one after the other lie side by side.
#[derive(Debug)]
pub(super) struct Rows<const D: usize> {
    numbers: Vec<f64>,
    /// Numbers of a component: as many as there are nodes, and lanes that may reach beyond.
    stride: usize,
}

impl<const D: usize> Rows<D> {
    /// So many components at nodes, all zero.
    fn zero(components: usize, nodes: usize) -> Self {
        let stride = nodes + MOST_LANES;
        Rows { numbers: vec![0.0; components * stride], stride }
    }

    /// Places after the first one.
    pub fn places(all: &[Vector<f64, D>]) -> Self {
        let mut rows = Self::zero(D, all.len());
        for c in 0..D {
            let (row, first) = (&mut rows.numbers[c * rows.stride..], all[0][c]);
            row.iter_mut().zip(all).for_each(|(number, place)| *number = place[c] - first);
        }
        rows
    }

    /// Forces, none yet: what cells give to each of their nodes along the last axis, apart from each other, so that
    /// lanes never add to what others have just written.
    pub fn forces(nodes: usize) -> Self {
        Self::zero(D * WIDTH, nodes)
    }

    /// Adds the forces to those on the nodes.
    pub fn add_to(&self, forces: &mut [Vector<f64, D>]) {
        for c in 0..D {
            let row = |k: usize| &self.numbers[(c * WIDTH + k) * self.stride..];
            let [first, middle, last] = [row(0), row(1), row(2)];
            for (node, force) in forces.iter_mut().enumerate() {
                let before = |row: &[f64], n: usize| if node >= n { row[node - n] } else { 0.0 };
                force[c] += before(last, 2) + before(middle, 1) + first[node];
            }
        }
    }

    /// A component at nodes one after the other, in lanes of double precision.
    ///
    /// # Safety
    /// The node must be one of a cell of the grid.
    #[inline(always)]
    unsafe fn load<V: Lanes>(&self, component: usize, node: usize) -> V {
        debug_assert!(node + MOST_LANES <= self.stride);
        // SAFETY: rows go on for as many numbers as any machine has lanes, which are of double precision.
        unsafe { V::load(self.numbers.as_ptr().add(component * self.stride + node).cast()) }
    }

    /// Adds to a component at nodes one after the other.
    ///
    /// # Safety
    /// As above.
    #[inline(always)]
    unsafe fn add<V: Lanes>(&mut self, component: usize, node: usize, more: V) {
        debug_assert!(node + MOST_LANES <= self.stride);
        // SAFETY: as above; nobody else uses them.
        unsafe {
            let first = self.numbers.as_mut_ptr().add(component * self.stride + node).cast();
            (V::load(first) + more).store(first);
        }
    }
}

/// An elastic body, in lanes.
pub(super) struct Elastic<V> {
    law: NeoHookean<V>,
    per_density: V,
    /// Whether particles share the dilatation of their cell, in space.
    pub averages: bool,
}

impl<V: Lanes> Elastic<V> {
    #[inline(always)]
    pub fn new((law, averages): (&NeoHookean<V::Real>, bool), density: V::Real) -> Self {
        Elastic { law: law.map(V::splat), per_density: V::splat(V::Real::ONE / density), averages }
    }

    /// K/2 (J - 1/J) [Pa]
    #[inline(always)]
    fn pressure(&self, jacobian: V) -> V {
        V::HALF * self.law.elastic.bulk_modulus * (jacobian - V::ONE / jacobian)
    }

    /// -V P = -V sigma J F^-T, zero where the volume is, and whether all are sound; in the plane F has a one beyond.
    /// With a mean Jm of J over the cell the pressure is that of Jm, which is all that the law takes from it:
    /// W = U(Jm) + G/2 (J^(-2/3) tr(F F^T) - 3). `fastest` becomes the larger of itself and the squares of waves'
    /// speeds in undeformed lengths [m^2/s^2].
    #[inline(always)]
    pub fn pulls<const D: usize>(
        &self,
        of: Matrix<V>,
        (volume, mean): (V, Option<V>),
        fastest: &mut V,
    ) -> (Matrix<V>, bool) {
        let all = (1 << V::COUNT) - 1;
        let absent = V::ZERO.at_least(volume) & all;
        let mut deformation = of;
        if const { D == 2 } {
            deformation.0[2][2] = V::ONE;
        }
        if absent != 0 {
            let unit = |i: usize, a: usize| if i == a { V::ONE } else { V::ZERO };
            deformation = Matrix::from_fn(|i, a| V::select(absent, unit(i, a), deformation.0[i][a]));
        }
        let cofactor = cofactor::<V, D>(&deformation);
        let mut jacobian = deformation.0[0][0] * cofactor.0[0][0];
        for a in 1..D {
            jacobian = deformation.0[0][a].times_plus(cofactor.0[0][a], jacobian);
        }
        let motion = Motion {
            deformation,
            jacobian,
            increment: Matrix::IDENTITY,
            stress: Symmetric::ZERO,
            dt: V::ZERO,
        };
        let mut stress = self.law.respond(&motion, &[]).stress;
        if let Some(mean) = mean {
            let more = self.pressure(mean) - self.pressure(jacobian);
            for i in 0..D {
                stress.0[i] += more;
            }
        }
        let modulus = self.law.wave_modulus(&deformation, jacobian, &[]);
        let inverse = V::ONE / jacobian;
        let mut speed = modulus * self.per_density * (shrinking::<V, D>(&cofactor) * (inverse * inverse));
        if absent != 0 {
            speed = V::select(absent, V::ZERO, speed);
        }
        *fastest = speed.max(*fastest);
        let largest = V::splat(V::Real::LARGEST);
        let sound =
            jacobian.at_least(V::splat(V::Real::TINY)) & largest.at_least(jacobian) & largest.at_least(speed);
        let mut pulls = Matrix::ZERO;
        for i in 0..D {
            for a in 0..D {
                let mut sum = stress.at(i, 0) * cofactor.0[0][a];
                for j in 1..D {
                    sum = stress.at(i, j).times_plus(cofactor.0[j][a], sum);
                }
                pulls.0[i][a] = -(sum * volume);
            }
        }
        (pulls, sound & all == all)
    }
}

/// What the particles of whole cells have in common, in lanes.
pub(super) struct Whole<V, const D: usize> {
    /// Values of the functions along an axis.
    value: [[V; WIDTH]; 2],
    /// Their slopes [1/m].
    slope: [[V; WIDTH]; 2],
    elastic: Elastic<V>,
}

/// Components by axes, at the particles of a cell, a cell in each lane.
type AtSites<V> = [[[V; SITES]; 3]; 3];

impl<V: Lanes<Real: Laned>, const D: usize> Whole<V, D> {
    /// Particles of a cell.
    const COUNT: usize = 1 << D;
    /// Rows of nodes across the last two axes, and particles there: in the plane one axis is left.
    const ROWS: usize = if D == 3 { WIDTH } else { 1 };
    const SIDES: usize = if D == 3 { 2 } else { 1 };

    #[inline(always)]
    pub fn new(form: &Form<D>, law: (&NeoHookean<V::Real>, bool), density: V::Real) -> Self {
        let along = ALONG.map(|at| Axis::in_cell(0, at));
        Whole {
            value: along.map(|axis| axis.value.map(V::of)),
            slope: along.map(|axis| axis.slope.map(|slope| V::of(slope / form.cell))),
            elastic: Elastic::new(law, density),
        }
    }

    /// Adds what the cells of a block give to the nodes; `fastest` becomes the larger of itself and the squares of
    /// waves' speeds in undeformed lengths [m^2/s^2]. Whether all particles are sound.
    #[inline(always)]
    pub fn strain(
        &self,
        (table, block): (&Table<V::Real, D>, &Block),
        offsets: &[u32],
        (places, forces): (&Rows<D>, &mut Rows<D>),
        fastest: &mut V,
    ) -> bool {
        let volumes = table.volumes(block);
        let mut sound = true;
        for first in (0..block.count as usize).step_by(V::COUNT) {
            let node = block.node as usize + first;
            let mut own = self.slopes(places, (node, offsets));
            // SAFETY: there are as many as any machine has lanes.
            let volume = |p: usize| unsafe { V::load(volumes[p].0[first..].as_ptr()) };
            let mut mean = None;
            if D == 3 && self.elastic.averages {
                let [mut sum, mut all] = [V::ZERO; 2];
                for p in 0..Self::COUNT {
                    sum = determinant(&Matrix::from_fn(|i, a| own[i][a][p])).times_plus(volume(p), sum);
                    all += volume(p);
                }
                mean = Some(V::select(V::ZERO.at_least(all), V::ONE, sum / all));
            }
            for p in 0..Self::COUNT {
                sound &= self.respond(&mut own, p, (volume(p), mean), fastest);
            }
            self.scatter(&own, forces, (node, offsets));
        }
        sound
    }

    /// Node of a cell.
    #[inline(always)]
    fn node(i: usize, j: usize) -> usize {
        if D == 3 { (i * WIDTH + j) * WIDTH } else { i * WIDTH }
    }

    /// F along the axes of the grid: sum x_I (x) grad N_I.
    #[inline(always)]
    fn slopes(&self, places: &Rows<D>, (node, offsets): (usize, &[u32])) -> AtSites<V> {
        let mut own = [[[V::ZERO; SITES]; 3]; 3];
        for c in 0..D {
            // By values, by slopes along the second axis of three, and along the last one.
            let [mut plain, mut across, mut along] = [[[V::ZERO; WIDTH]; ACROSS]; 3];
            for i in 0..WIDTH {
                let (mut last, mut sloped) = ([[V::ZERO; WIDTH]; 2], [[V::ZERO; WIDTH]; 2]);
                for j in 0..Self::ROWS {
                    let at = node + offsets[Self::node(i, j)] as usize;
                    // SAFETY: a node of the cell, and two that follow it.
                    let x: [V; WIDTH] =
                        unsafe { [places.load(c, at), places.load(c, at + 1), places.load(c, at + 2)] };
                    for z in 0..2 {
                        last[z][j] = dot(&self.value[z], &x);
                        sloped[z][j] = dot(&self.slope[z], &x);
                    }
                }
                for y in 0..Self::SIDES {
                    for z in 0..2 {
                        let q = 2 * y + z;
                        if D == 3 {
                            plain[q][i] = dot(&self.value[y], &last[z]);
                            across[q][i] = dot(&self.slope[y], &last[z]);
                            along[q][i] = dot(&self.value[y], &sloped[z]);
                        } else {
                            (plain[q][i], along[q][i]) = (last[z][0], sloped[z][0]);
                        }
                    }
                }
            }
            for x in 0..2 {
                for q in 0..2 * Self::SIDES {
                    let p = x * 2 * Self::SIDES + q;
                    own[c][0][p] = dot(&self.slope[x], &plain[q]);
                    if D == 3 {
                        own[c][1][p] = dot(&self.value[x], &across[q]);
                    }
                    own[c][D - 1][p] = dot(&self.value[x], &along[q]);
                }
            }
        }
        own
    }

    /// Turns F of a particle of each cell into -V P, zero where the volume is, and tells whether all are sound.
    #[inline(always)]
    fn respond(&self, own: &mut AtSites<V>, p: usize, by: (V, Option<V>), fastest: &mut V) -> bool {
        let deformation = Matrix::from_fn(|i, a| own[i][a][p]);
        let (pulls, sound) = self.elastic.pulls::<D>(deformation, by, fastest);
        for i in 0..D {
            for a in 0..D {
                own[i][a][p] = pulls.0[i][a];
            }
        }
        sound
    }

    /// f_I += sum -V P grad N_I
    #[inline(always)]
    fn scatter(&self, own: &AtSites<V>, forces: &mut Rows<D>, (node, offsets): (usize, &[u32])) {
        for c in 0..D {
            for i in 0..WIDTH {
                let (value, slope) =
                    ([self.value[0][i], self.value[1][i]], [self.slope[0][i], self.slope[1][i]]);
                let [mut plain, mut across, mut along] = [[V::ZERO; ACROSS]; 3];
                for q in 0..2 * Self::SIDES {
                    let both = |a: usize| [own[c][a][q], own[c][a][q + 2 * Self::SIDES]];
                    plain[q] = pair(&slope, both(0));
                    if D == 3 {
                        across[q] = pair(&value, both(1));
                    }
                    along[q] = pair(&value, both(D - 1));
                }
                for j in 0..Self::ROWS {
                    let (mut last, mut sloped) = ([V::ZERO; 2], [V::ZERO; 2]);
                    for z in 0..2 {
                        if D == 3 {
                            let (value, slope) =
                                ([self.value[0][j], self.value[1][j]], [self.slope[0][j], self.slope[1][j]]);
                            let sum = pair(&value, [plain[z], plain[2 + z]]);
                            let sum = slope[0].times_plus(across[z], sum);
                            last[z] = slope[1].times_plus(across[2 + z], sum);
                            sloped[z] = pair(&value, [along[z], along[2 + z]]);
                        } else {
                            (last[z], sloped[z]) = (plain[z], along[z]);
                        }
                    }
                    for k in 0..WIDTH {
                        let sum = self.value[0][k] * last[0];
                        let sum = self.slope[0][k].times_plus(sloped[0], sum);
                        let sum = self.value[1][k].times_plus(last[1], sum);
                        let sum = self.slope[1][k].times_plus(sloped[1], sum);
                        // SAFETY: a node of the cell.
                        unsafe { forces.add(c * WIDTH + k, node + offsets[Self::node(i, j)] as usize, sum) };
                    }
                }
            }
        }
    }
}

#[inline(always)]
fn dot<V: Number>(factors: &[V; WIDTH], x: &[V; WIDTH]) -> V {
    let sum = factors[1].times_plus(x[1], factors[0] * x[0]);
    factors[2].times_plus(x[2], sum)
}

#[inline(always)]
fn pair<V: Number>(factors: &[V; 2], of: [V; 2]) -> V {
    factors[1].times_plus(of[1], factors[0] * of[0])
}

/// det F in space.
#[inline(always)]
pub(super) fn determinant<V: Number>(f: &Matrix<V>) -> V {
    let minor = |j: usize, k: usize| f.0[1][j].times_plus(f.0[2][k], -(f.0[1][k] * f.0[2][j]));
    let sum = f.0[0][1].times_plus(minor(2, 0), f.0[0][0] * minor(1, 2));
    f.0[0][2].times_plus(minor(0, 1), sum)
}

/// J F^-T; in the plane F has ones beyond.
#[inline(always)]
fn cofactor<V: Number, const D: usize>(f: &Matrix<V>) -> Matrix<V> {
    if D == 2 {
        let [[a, b, _], [c, d, _], _] = f.0;
        return Matrix([[d, -c, V::ZERO], [-b, a, V::ZERO], [V::ZERO, V::ZERO, a * d - b * c]]);
    }
    Matrix::from_fn(|i, a| {
        let (j, k, b, c) = ((i + 1) % 3, (i + 2) % 3, (a + 1) % 3, (a + 2) % 3);
        f.0[j][b].times_plus(f.0[k][c], -(f.0[j][c] * f.0[k][b]))
    })
}

/// A bound of |J F^-1 n|^2 over all directions, from J F^-T: the largest sum of magnitudes in a row of J^2 F^-1 F^-T.
#[inline(always)]
fn shrinking<V: Number, const D: usize>(cofactor: &Matrix<V>) -> V {
    let product = |a: usize, b: usize| {
        let mut sum = cofactor.0[0][a] * cofactor.0[0][b];
        for i in 1..D {
            sum = cofactor.0[i][a].times_plus(cofactor.0[i][b], sum);
        }
        sum
    };
    let mut rows = [V::ZERO; 3];
    for a in 0..D {
        rows[a] += product(a, a);
        for b in a + 1..D {
            let both = product(a, b).abs();
            rows[a] += both;
            rows[b] += both;
        }
    }
    rows[0].max(rows[1]).max(rows[2])
}
