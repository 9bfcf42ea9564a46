//! Grains that are near each other, by cells of a grid: they are found anew hundreds of times, and are of like sizes.
//! Points of a surface are balls without a radius. Bodies of a scene, of any sizes, are paired once, by a tree
//! (`check/neighbours`).

use rayon::prelude::*;
use std::collections::HashMap;

/// For each of some balls, those that are near.
#[derive(Default)]
pub struct Near {
    /// Where those of each begin, and where those of the last end.
    starts: Vec<usize>,
    others: Vec<u32>,
}

impl Near {
    /// Those near ball `i`, by number.
    pub fn of(&self, i: usize) -> impl Iterator<Item = usize> {
        self.others[self.starts[i]..self.starts[i + 1]].iter().map(|&j| j as usize)
    }

    /// Those of the first `count` balls, where the others are images of them: `of` says of which.
    pub fn with_images(&self, count: usize, of: &[u32]) -> Near {
        let mut near = Near { starts: vec![0], others: Vec::new() };
        for i in 0..count {
            let mut found: Vec<u32> = self.of(i).map(|j| of[j]).collect();
            found.sort_unstable();
            found.dedup();
            near.others.extend(found);
            near.starts.push(near.others.len());
        }
        near
    }
}

/// Balls that one thread takes at a time.
const BATCH: usize = 1024;

/// For each of some balls, those whose surfaces are nearer than `margin` [m], by number.
pub fn near(positions: &[[f64; 3]], radii: &[f64], margin: f64, dimension: usize) -> Near {
    let largest = radii.iter().fold(0.0, |a: f64, &b| a.max(b));
    let side = 2.0 * largest + margin;
    let cell = |x: &[f64; 3]| -> [i64; 3] {
        std::array::from_fn(|k| if k < dimension { (x[k] / side).floor() as i64 } else { 0 })
    };
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    for (i, position) in positions.iter().enumerate() {
        cells.entry(cell(position)).or_default().push(i as u32);
    }
    let add_around = |i: usize, found: &mut Vec<u32>| {
        let [x, y, z] = cell(&positions[i]);
        let depth = if dimension == 3 { -1..=1 } else { 0..=0 };
        let begin = found.len();
        for dx in -1..=1 {
            for dy in -1..=1 {
                for dz in depth.clone() {
                    let inside = cells.get(&[x + dx, y + dy, z + dz]).map_or(&[][..], |list| &list[..]);
                    found.extend(inside.iter().filter(|&&j| {
                        let j = j as usize;
                        let apart =
                            (0..dimension).map(|k| (positions[i][k] - positions[j][k]).powi(2)).sum::<f64>();
                        j != i && apart < (radii[i] + radii[j] + margin).powi(2)
                    }));
                }
            }
        }
        found[begin..].sort_unstable();
    };
    let count = positions.len();
    let batch = |first: usize| {
        let (mut ends, mut found) = (Vec::with_capacity(BATCH), Vec::new());
        for i in first..count.min(first + BATCH) {
            add_around(i, &mut found);
            ends.push(found.len());
        }
        (ends, found)
    };
    let batches: Vec<_> = (0..count).into_par_iter().step_by(BATCH).map(batch).collect();
    let mut near = Near { starts: vec![0], others: Vec::new() };
    for (ends, found) in batches {
        let before = near.others.len();
        near.starts.extend(ends.iter().map(|end| before + end));
        near.others.extend(found);
    }
    near
}
