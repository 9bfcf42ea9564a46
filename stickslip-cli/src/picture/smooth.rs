//! Columns of particles averaged over neighbours of the same body, as photoelastic fringes average stress.
//!
//! Moving least squares (Lancaster and Salkauskas 1981), in the plane or in space: around a place a linear function
//! a + b.(x - place) is fitted to the particles within a reach R of two distances between particles, with weights
//!
//! ```text
//! w = V (1 - r^2/R^2)^3          V: the particle's volume
//! ```
//!
//! so what varies linearly is met exactly, up to the body's surface, and nothing smears across contacts.

use super::quantity::Parts;
use stickslip::door::ParticleSnapshot;

/// Reach of the kernel in distances between particles.
const REACH: f64 = 2.0;
/// Part of the points' mean square distance (in reaches) added to that of every fit: a single row of particles has no
/// slope across itself.
const RIDGE: f64 = 1e-3;

/// Numbers of each particle, to be had at any place of its body.
pub struct Smoother {
    dimension: usize,
    /// By index of the body.
    bodies: Vec<Option<BodyCells>>,
}

/// The particles of a body, sorted into cells that are as wide as the reach.
struct BodyCells {
    reach: f64,
    /// Side of a cell [m]; the reach, or more where particles flew far away.
    side: f64,
    low: [f64; 3],
    counts: [usize; 3],
    starts: Vec<u32>,
    points: Vec<Point>,
}

#[derive(Clone, Copy)]
struct Point {
    place: [f64; 3],
    volume: f64,
    parts: Parts,
}

/// Sums over the points around a place, with lengths in reaches: w, w dx, w dy, w dz times 1, dx, dy, dz and the parts.
#[derive(Default)]
struct FitSums {
    moments: [[f64; 4]; 4],
    parts: [Parts; 4],
}

impl Smoother {
    /// Sorts the particles of a snapshot with six numbers of each.
    pub fn new(particles: &ParticleSnapshot, parts: impl Fn(usize) -> Parts) -> Self {
        let count = particles.body.iter().max().map_or(0, |last| *last as usize + 1);
        let mut points: Vec<Vec<Point>> = vec![Vec::new(); count];
        for (i, &body) in particles.body.iter().enumerate() {
            let volume = particles.volume[i].max(f64::MIN_POSITIVE);
            points[body as usize].push(Point { place: particles.position[i], volume, parts: parts(i) });
        }
        let dimension = particles.dimension;
        let cells = |points: Vec<Point>| (!points.is_empty()).then(|| BodyCells::new(points, dimension));
        Smoother { dimension, bodies: points.into_iter().map(cells).collect() }
    }

    /// The numbers at a place of a body; `None` where none of its particles is near.
    pub fn at(&self, body: u32, place: [f64; 3]) -> Option<Parts> {
        let cells = self.bodies.get(body as usize)?.as_ref()?;
        let mut sums = FitSums::default();
        cells.near(place, |point| sums.add(point, place, cells.reach));
        sums.fit(self.dimension)
    }
}

impl BodyCells {
    fn new(points: Vec<Point>, dimension: usize) -> Self {
        let mean = points.iter().map(|point| point.volume).sum::<f64>() / points.len() as f64;
        let reach = REACH * mean.powf(1.0 / dimension as f64);
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for point in &points {
            for axis in 0..3 {
                low[axis] = low[axis].min(point.place[axis]);
                high[axis] = high[axis].max(point.place[axis]);
            }
        }
        // A few particles that flew far away must not ask for a cell on every square metre between.
        let most = 4.0 * points.len() as f64 + 64.0;
        let cells = |side: f64| [0, 1, 2].map(|k| ((high[k] - low[k]) / side).floor() + 1.0);
        let mut side = reach;
        while cells(side).iter().product::<f64>() > most {
            side *= 2.0;
        }
        let counts = [0, 1, 2].map(|k| ((high[k] - low[k]) / side) as usize + 1);
        let mut sorted = BodyCells { reach, side, low, counts, starts: Vec::new(), points: Vec::new() };
        let index = |point: &Point| {
            let [x, y, z] = sorted.cell(point.place).map(|cell| cell as usize);
            (z * counts[1] + y) * counts[0] + x
        };
        let mut starts = vec![0u32; counts.iter().product::<usize>() + 1];
        points.iter().for_each(|point| starts[index(point) + 1] += 1);
        (1..starts.len()).for_each(|i| starts[i] += starts[i - 1]);
        let mut order: Vec<usize> = (0..points.len()).collect();
        order.sort_by_key(|&i| index(&points[i]));
        let points = order.into_iter().map(|i| points[i]).collect();
        (sorted.starts, sorted.points) = (starts, points);
        sorted
    }

    fn cell(&self, place: [f64; 3]) -> [i64; 3] {
        [0, 1, 2].map(|k| ((place[k] - self.low[k]) / self.side).floor() as i64)
    }

    /// Visits the points in the cells around a place: all that are nearer than the reach, and some more.
    fn near(&self, place: [f64; 3], mut visit: impl FnMut(&Point)) {
        let cell = self.cell(place);
        let span = |axis: usize| (cell[axis] - 1).max(0)..(cell[axis] + 2).min(self.counts[axis] as i64);
        let row = span(0);
        if row.is_empty() {
            return;
        }
        for z in span(2) {
            for y in span(1) {
                // The cells of a row follow one another.
                let first = (z as usize * self.counts[1] + y as usize) * self.counts[0];
                let start = |x: i64| self.starts[first + x as usize] as usize;
                self.points[start(row.start)..start(row.end)].iter().for_each(&mut visit);
            }
        }
    }
}

impl FitSums {
    fn add(&mut self, point: &Point, place: [f64; 3], reach: f64) {
        let d = [0, 1, 2].map(|k| (point.place[k] - place[k]) / reach);
        let gap = 1.0 - d.iter().map(|d| d * d).sum::<f64>();
        if gap <= 0.0 {
            return;
        }
        let weight = point.volume * gap * gap * gap;
        let basis = [1.0, d[0], d[1], d[2]];
        for (k, (moments, parts)) in self.moments.iter_mut().zip(&mut self.parts).enumerate() {
            let factor = weight * basis[k];
            moments.iter_mut().zip(basis).for_each(|(sum, other)| *sum += factor * other);
            parts.iter_mut().zip(point.parts).for_each(|(sum, part)| *sum += factor * part);
        }
    }

    /// The fitted function at the place itself: the sums of the parts times the first row of the inverse of the matrix
    /// of moments, made regular by [`RIDGE`].
    fn fit(&self, dimension: usize) -> Option<Parts> {
        let weight = self.moments[0][0];
        if weight <= 0.0 {
            return None;
        }
        let size = dimension + 1;
        let mut rows = [[0.0; 5]; 4];
        for (i, row) in rows.iter_mut().enumerate().take(size) {
            row[..4].copy_from_slice(&self.moments[i].map(|moment| moment / weight));
            row[i] += if i == 0 { 0.0 } else { RIDGE };
            row[4] = f64::from(u8::from(i == 0));
        }
        // The matrix is symmetric and positive definite: elimination needs no pivots.
        for i in 0..size {
            let pivot = rows[i];
            for row in rows.iter_mut().take(size).skip(i + 1) {
                let factor = row[i] / pivot[i];
                row.iter_mut().zip(pivot).skip(i).for_each(|(entry, other)| *entry -= factor * other);
            }
        }
        let mut first = [0.0; 4];
        for i in (0..size).rev() {
            let known: f64 = (i + 1..size).map(|j| rows[i][j] * first[j]).sum();
            first[i] = (rows[i][4] - known) / rows[i][i];
        }
        let sum = |k: usize| (0..size).map(|i| first[i] * self.parts[i][k]).sum::<f64>() / weight;
        Some(std::array::from_fn(sum))
    }
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;
    use stickslip::polariscope::{ImageWindow, stress_maps};

    fn stressed(dimension: usize, stress: impl Fn([f64; 3]) -> [f64; 6]) -> ParticleSnapshot {
        let mut particles = sample::ball_on_slab(dimension, 0.1);
        particles.stress = particles.position.iter().map(|x| stress(*x)).collect();
        particles
    }

    #[test]
    fn what_varies_linearly_stays_and_what_alternates_goes() {
        for dimension in [2, 3] {
            let linear = |x: [f64; 3]| [3.0 + x[0], x[1], -2.0 * x[2], x[0] - x[1], 0.0, 1.0];
            let particles = stressed(dimension, linear);
            let smoother = Smoother::new(&particles, |i| particles.stress[i]);
            for (i, &place) in particles.position.iter().enumerate() {
                let fitted = smoother.at(particles.body[i], place).unwrap();
                let exact = linear(place);
                // The ridge bends slopes at the surface by a part in a hundred of a reach.
                assert!((0..6).all(|k| (fitted[k] - exact[k]).abs() < 0.01), "{fitted:?} {exact:?}");
            }
            let odd = |x: [f64; 3]| x.iter().map(|x| (x / 0.1).floor() as i64).sum::<i64>() % 2 == 0;
            let particles = stressed(dimension, |x| [if odd(x) { 1.0 } else { -1.0 }; 6]);
            let smoother = Smoother::new(&particles, |i| particles.stress[i]);
            let mut middle = [-1.0, 0.0, 0.0];
            middle[dimension - 1] = 1.0;
            assert!(smoother.at(0, middle).unwrap()[0].abs() < 0.1);
            assert_eq!(smoother.at(0, [9.0; 3]), None);
            assert_eq!(smoother.at(7, middle), None);
        }
    }

    #[test]
    fn in_the_plane_stress_is_that_of_the_fringes() {
        let particles =
            stressed(2, |x| [(3.0 * x[0]).sin(), (2.0 * x[1]).cos(), x[0] * x[1], 0.5 * x[1], 0.0, 0.0]);
        let smoother = Smoother::new(&particles, |i| particles.stress[i]);
        let window = ImageWindow { low: [-3.0, -0.5], high: [3.0, 2.0], size: [120, 50] };
        for map in stress_maps(&particles, &window) {
            for (place, ray) in map.rays.iter().enumerate().filter(|(_, ray)| ray.coverage > 0.9) {
                let [column, row] =
                    [place % map.size[0] + map.corner[0], place / map.size[0] + map.corner[1]];
                let [x, y] = window.position(column, row);
                let [xx, yy, _, xy, ..] = smoother.at(map.body as u32, [x, y, 0.0]).unwrap();
                let [a, b, c] = ray.stress;
                assert!((xx - a).abs().max((yy - b).abs()).max((xy - c).abs()) < 1e-9);
            }
        }
    }

    #[test]
    fn a_particle_far_away_costs_no_cells() {
        let mut particles = stressed(2, |_| [1.0; 6]);
        particles.position[0] = [1e9, 1e9, 0.0];
        let smoother = Smoother::new(&particles, |i| particles.stress[i]);
        assert!((smoother.at(0, [1e9, 1e9, 0.0]).unwrap()[0] - 1.0).abs() < 1e-12);
    }
}
