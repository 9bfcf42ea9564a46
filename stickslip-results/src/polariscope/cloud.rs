//! One body as light sees it: points of the plane, each with its area, the stress along the ray through it, and the way
//! through the body.

use super::seen::{SeenBody, SeenParticle};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A particle of a plane scene, or the particles of a scene in space that lie one behind the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloudPoint {
    /// Place in the plane [m].
    pub place: [f64; 2],
    /// Area that it stands for [m^2].
    pub area: f64,
    /// Cauchy stress xx, yy, xy, averaged along the ray [Pa], and the ray's way through the body [m].
    pub values: [f64; 4],
}

/// Where the points of a body are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outline {
    /// Index of the body.
    pub body: usize,
    /// How many points it has.
    pub points: usize,
    /// How far points are looked for, twice the side of a bin [m].
    pub reach: f64,
    /// Lower and upper corner of the points [m].
    pub bounds: [[f64; 2]; 2],
    /// Centre of mass [m].
    pub center: [f64; 2],
}

/// The points of one body, sorted into square bins.
pub struct Cloud {
    pub outline: Outline,
    bins: [usize; 2],
    starts: Vec<u32>,
    points: Vec<CloudPoint>,
}

/// A particle of a plane scene: its volume is per metre of depth, and so is its way.
fn flat(particle: &SeenParticle) -> CloudPoint {
    let &SeenParticle { place, stress: [xx, yy, xy], volume, .. } = particle;
    CloudPoint { place, area: volume, values: [xx, yy, xy, 1.0] }
}

/// Particles in columns along the third axis, a column for each square of side `side` [m] that holds any:
///
/// ```text
/// way = sum V / side^2,   stress = sum V sigma / sum V
/// ```
fn columns(particles: &[SeenParticle], side: f64) -> Vec<CloudPoint> {
    let low = [0, 1].map(|axis| {
        particles.iter().map(|particle| particle.place[axis]).fold(f64::INFINITY, f64::min) - 0.5 * side
    });
    // V, V x, V y, V sigma
    let mut columns: BTreeMap<[i64; 2], [f64; 6]> = BTreeMap::new();
    for &SeenParticle { place: [x, y], stress: [xx, yy, xy], volume, .. } in particles {
        let key = [((x - low[0]) / side).floor() as i64, ((y - low[1]) / side).floor() as i64];
        let sum = columns.entry(key).or_default();
        for (sum, value) in sum.iter_mut().zip([1.0, x, y, xx, yy, xy]) {
            *sum += volume * value;
        }
    }
    let point = |[volume, x, y, xx, yy, xy]: [f64; 6]| CloudPoint {
        place: [x / volume, y / volume],
        area: side * side,
        values: [xx / volume, yy / volume, xy / volume, volume / (side * side)],
    };
    columns.into_values().map(point).collect()
}

/// The smallest rectangle around two, each given by its lower and upper corner.
pub fn joined([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    [[a[0].min(c[0]), a[1].min(c[1])], [b[0].max(d[0]), b[1].max(d[1])]]
}

impl Cloud {
    /// The points of a body; `reach` is in distances between particles, and at least `least` [m].
    pub fn of(seen: &SeenBody, reach: f64, least: f64) -> Self {
        let SeenBody { particles, .. } = seen;
        let size = |particle: &SeenParticle| particle.volume.max(f64::MIN_POSITIVE);
        let mean = particles.iter().map(size).sum::<f64>() / particles.len() as f64;
        let (points, spacing) = if seen.dimension == 2 {
            (particles.iter().map(flat).collect(), mean.sqrt())
        } else {
            (columns(particles, mean.cbrt()), mean.cbrt())
        };
        let mass: f64 = particles.iter().map(|particle| particle.mass).sum();
        let moment =
            |axis: usize| particles.iter().map(|particle| particle.mass * particle.place[axis]).sum::<f64>();
        let center = [moment(0) / mass, moment(1) / mass];
        Cloud::sorted(seen.body, points, (center, (reach * spacing).max(least)))
    }

    fn sorted(body: usize, points: Vec<CloudPoint>, (center, reach): ([f64; 2], f64)) -> Self {
        let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for point in &points {
            bounds = joined(bounds, [point.place; 2]);
        }
        // A few particles that flew far away must not ask for a bin on every square metre between.
        let most = (4 * points.len()).max(64) as f64;
        let wide = [0, 1].map(|axis| (bounds[1][axis] - bounds[0][axis]) / reach + 1.0);
        let reach = reach * (wide[0] * wide[1] / most).sqrt().max(1.0);
        let bins = [0, 1].map(|axis| (2.0 * (bounds[1][axis] - bounds[0][axis]) / reach) as usize + 1);
        let outline = Outline { body, points: points.len(), reach, bounds, center };
        let mut cloud = Cloud { outline, bins, starts: Vec::new(), points: Vec::new() };
        let bin = |point: &CloudPoint| {
            let [column, row] = cloud.bin(point.place).map(|index| index as usize);
            row * bins[0] + column
        };
        let mut starts = vec![0u32; bins[0] * bins[1] + 1];
        points.iter().for_each(|point| starts[bin(point) + 1] += 1);
        (1..starts.len()).for_each(|i| starts[i] += starts[i - 1]);
        let mut order: Vec<usize> = (0..points.len()).collect();
        order.sort_by_key(|&i| bin(&points[i]));
        cloud.points = order.into_iter().map(|i| points[i]).collect();
        cloud.starts = starts;
        cloud
    }

    fn bin(&self, x: [f64; 2]) -> [i64; 2] {
        let Outline { bounds, reach, .. } = self.outline;
        [0, 1].map(|axis| (2.0 * (x[axis] - bounds[0][axis]) / reach).floor() as i64)
    }

    /// Points in the bins around a place: all that are nearer than `reach`, and some more.
    pub fn near(&self, x: [f64; 2]) -> impl Iterator<Item = &CloudPoint> {
        let [column, row] = self.bin(x);
        let [columns, rows] = self.bins.map(|count| count as i64);
        let (left, right) = ((column - 2).max(0), (column + 3).min(columns));
        ((row - 2).max(0)..(row + 3).min(rows)).flat_map(move |row| {
            // The bins of a row follow one another.
            let bin = |column: i64| self.starts[(row * columns + column) as usize] as usize;
            if left < right { &self.points[bin(left)..bin(right)] } else { &[] }
        })
    }

    /// Points in the rows of bins around a height: all that are nearer to it than `reach`, and some more.
    pub fn across(&self, y: f64) -> &[CloudPoint] {
        let [_, row] = self.bin([self.outline.bounds[0][0], y]);
        let start = |row: i64| {
            let row = row.clamp(0, self.bins[1] as i64) as usize;
            self.starts[row * self.bins[0]] as usize
        };
        &self.points[start(row - 2)..start(row + 3)]
    }

    /// All points.
    pub fn points(&self) -> &[CloudPoint] {
        &self.points
    }
}
