//! Grains that are near each other, by cells of a grid: they are found anew hundreds of times, and are of like sizes.
//! Bodies of a scene, of any sizes, are paired once, by a tree (`check/neighbours`).

use std::collections::HashMap;

/// For each of some balls, those whose surfaces are nearer than `margin` [m], by number.
pub fn near(positions: &[[f64; 3]], radii: &[f64], margin: f64, dimension: usize) -> Vec<Vec<u32>> {
    let largest = radii.iter().fold(0.0, |a: f64, &b| a.max(b));
    let side = 2.0 * largest + margin;
    let cell = |x: &[f64; 3]| -> [i64; 3] {
        std::array::from_fn(|k| if k < dimension { (x[k] / side).floor() as i64 } else { 0 })
    };
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    for (i, position) in positions.iter().enumerate() {
        cells.entry(cell(position)).or_default().push(i as u32);
    }
    let around = |i: usize| {
        let [x, y, z] = cell(&positions[i]);
        let depth = if dimension == 3 { -1..=1 } else { 0..=0 };
        let mut found: Vec<u32> = Vec::new();
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
        found.sort_unstable();
        found
    };
    (0..positions.len()).map(around).collect()
}
