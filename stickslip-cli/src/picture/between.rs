//! What lies between the particles of a body: squares that do not stand in rows leave holes.
//!
//! A place between three particles of a body belongs to it if they are neighbours. That they are if the circle through
//! them, before they deformed, is small (alpha shapes: Edelsbrunner, Kirkpatrick and Seidel 1983):
//!
//! ```text
//! a b c / (4 A) <= 0.8 s      a, b, c, A: sides and area of the triangle, s: mean side of the particles' squares
//! ```
//!
//! Between particles in rows the radius is 0.71 s; disks of fitted particles, of up to 80 rings, have no holes left
//! with 0.72 s. Across a gap of w s between two rows that face each other it is sqrt(1 + (1 + w)^2) s / 2: gaps of a
//! quarter of a side close, wider ones stay.

use super::grains::Grain;
use rayon::prelude::*;
use std::collections::HashMap;

/// Radius of the largest circle through neighbours, in sides of their squares.
const WIDEST: f64 = 0.8;
/// Bodies that stretch by more have holes where their particles are farthest apart.
const MOST_STRETCH: f64 = 4.0;
/// Neighbours of one particle at most; where there are more, their squares lie on each other.
const MOST: usize = 24;

/// Two by two numbers, row by row.
type Plane = [f64; 4];
/// A body, and a square of the plane in which its particles are sorted.
type Bin = (u32, [i64; 2]);

/// Three neighbours each, among some of the grains.
pub fn triangles(grains: &[Grain], meant: &[u32]) -> Vec<[u32; 3]> {
    let mut reach: HashMap<u32, f64> = HashMap::new();
    for &i in meant {
        let grain = &grains[i as usize];
        let own = 2.0 * WIDEST * grain.side * stretch(plane(grain)).min(MOST_STRETCH);
        let reach = reach.entry(grain.body).or_insert(own);
        *reach = reach.max(own);
    }
    let bin = |grain: &Grain| {
        [0, 1].map(|axis| (grain.position[axis] / reach[&grain.body].max(f64::MIN_POSITIVE)).floor() as i64)
    };
    let mut bins: HashMap<Bin, Vec<u32>> = HashMap::new();
    for &i in meant {
        let grain = &grains[i as usize];
        bins.entry((grain.body, bin(grain))).or_default().push(i);
    }
    let of_first = |&i: &u32| {
        let grain = &grains[i as usize];
        let [x, y] = bin(grain);
        let around = (0..9).filter_map(|k| bins.get(&(grain.body, [x + k % 3 - 1, y + k / 3 - 1])));
        let later = around.flatten().filter(|&&j| j > i && are_near(grain, &grains[j as usize]));
        let near: Vec<u32> = later.copied().take(MOST).collect();
        let pairs = (0..near.len()).flat_map(|k| (0..k).map(move |l| [k, l]));
        let all = pairs.map(|[k, l]| [i, near[k], near[l]]);
        all.filter(|three| are_neighbours(three.map(|i| &grains[i as usize]))).collect::<Vec<_>>()
    };
    meant.par_iter().flat_map_iter(of_first).collect()
}

fn plane(grain: &Grain) -> Plane {
    let f = &grain.deformation;
    [f[0], f[1], f[3], f[4]]
}

/// The largest principal stretch of a deformation gradient.
fn stretch(f: Plane) -> f64 {
    let (sum, det) = (f.iter().map(|f| f * f).sum::<f64>(), f[0] * f[3] - f[1] * f[2]);
    (0.5 * (sum + (sum * sum - 4.0 * det * det).max(0.0).sqrt())).sqrt()
}

/// What `offset` was before a deformation; `None` where that leaves no area.
fn undone(f: Plane, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
    let det = f[0] * f[3] - f[1] * f[2];
    (det > 0.0).then(|| [(f[3] * x - f[1] * y) / det, (f[0] * y - f[2] * x) / det])
}

fn offset(from: &Grain, to: &Grain) -> [f64; 2] {
    [0, 1].map(|axis| to.position[axis] - from.position[axis])
}

/// Whether a circle through two grains may be small enough.
fn are_near(one: &Grain, other: &Grain) -> bool {
    let (f, g) = (plane(one), plane(other));
    let mean = std::array::from_fn(|k| 0.5 * (f[k] + g[k]));
    let apart = undone(mean, offset(one, other));
    apart.is_some_and(|[x, y]| x.hypot(y) <= WIDEST * (one.side + other.side))
}

/// Whether the circle through three grains is.
fn are_neighbours(three: [&Grain; 3]) -> bool {
    let planes = three.map(plane);
    let mean = std::array::from_fn(|k| planes.iter().map(|f| f[k]).sum::<f64>() / 3.0);
    let side = three.iter().map(|grain| grain.side).sum::<f64>() / 3.0;
    let sides = [undone(mean, offset(three[0], three[1])), undone(mean, offset(three[0], three[2]))];
    let [Some(u), Some(v)] = sides else { return false };
    let area = 0.5 * (u[0] * v[1] - u[1] * v[0]).abs();
    let lengths = u[0].hypot(u[1]) * v[0].hypot(v[1]) * (u[0] - v[0]).hypot(u[1] - v[1]);
    lengths <= 4.0 * area * WIDEST * side
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grains(places: impl IntoIterator<Item = [f64; 2]>, deformation: [f64; 9]) -> Vec<Grain> {
        let grain = |[x, y]: [f64; 2]| {
            let f = &deformation;
            let position = [f[0] * x + f[1] * y, f[3] * x + f[4] * y, 0.0];
            Grain { body: 0, position, side: 1.0, deformation, color: [0.5; 3] }
        };
        places.into_iter().map(grain).collect()
    }

    /// The four corners of a square are neighbours, whichever three of them, however they have deformed together; those
    /// a gap of 0.3 sides apart are not.
    #[test]
    fn neighbours_stay_neighbours() {
        let rows = |high: f64| [[0.0, 0.0], [1.0, 0.0], [0.0, high], [1.0, high]];
        let plain = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let sheared = [1.5, 2.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0];
        for deformation in [plain, sheared] {
            let of = |high: f64| triangles(&grains(rows(high), deformation), &[0, 1, 2, 3]);
            assert_eq!([of(1.0).len(), of(1.2).len(), of(1.3).len()], [4, 4, 0]);
        }
        assert_eq!(triangles(&grains(rows(1.0), plain), &[0, 1, 3]), [[0, 3, 1]]);
    }

    #[test]
    fn particles_on_one_place_cost_no_more_than_others() {
        let heap = grains(
            (0..2000).map(|i| [1e-9 * f64::from(i), 0.0]),
            [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        );
        let all: Vec<u32> = (0..2000).collect();
        assert!(triangles(&heap, &all).is_empty());
    }
}
