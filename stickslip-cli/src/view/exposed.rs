//! Which particles of a body in space can be seen from outside: the others need not be drawn.

use super::open_frame::Run;
use rayon::prelude::*;

/// Side of a box of space, in mean sides of a particle: no box inside a body is empty, even where the body is strained.
const REACH: f64 = 1.6;
/// A body that takes more boxes than this is scattered: all of its particles can be seen.
const MOST_BOXES: f64 = 3e7;

/// For each particle whether it lies in a box of space that has an empty one beside it, or one side or corner away.
/// Particles stand body by body, as the runs say; `sides` are those of their cubes [m].
pub fn exposed(runs: &[Run], positions: &[[f64; 3]], sides: &[f64]) -> Vec<bool> {
    let mut starts = Vec::with_capacity(runs.len());
    let mut start = 0;
    for run in runs {
        starts.push(start..start + run.count as usize);
        start += run.count as usize;
    }
    let of_run = |range: std::ops::Range<usize>| of_body(&positions[range.clone()], &sides[range]);
    starts.into_par_iter().map(of_run).collect::<Vec<_>>().concat()
}

fn of_body(positions: &[[f64; 3]], sides: &[f64]) -> Vec<bool> {
    let everything = || vec![true; positions.len()];
    let side = REACH * sides.iter().sum::<f64>() / sides.len() as f64;
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for x in positions {
        for axis in 0..3 {
            low[axis] = low[axis].min(x[axis]);
            high[axis] = high[axis].max(x[axis]);
        }
    }
    // A margin of one box on either side, so that each box has neighbours.
    let counts = [0, 1, 2].map(|axis| ((high[axis] - low[axis]) / side).floor() + 3.0);
    let boxes = counts.iter().product::<f64>();
    if !boxes.is_finite() || boxes > MOST_BOXES {
        return everything();
    }
    let [nx, ny, nz] = counts.map(|count| count as usize);
    let place = |x: &[f64; 3]| {
        let [i, j, k] = [0, 1, 2].map(|axis| 1 + ((x[axis] - low[axis]) / side) as usize);
        (k * ny + j) * nx + i
    };
    let mut occupied = vec![false; nx * ny * nz];
    positions.iter().for_each(|x| occupied[place(x)] = true);
    let beside = |at: usize, i: usize| {
        let [dx, dy, dz] = [i % 3, i / 3 % 3, i / 9];
        at + (dz * ny + dy) * nx + dx - (ny + 1) * nx - 1
    };
    let open: Vec<bool> =
        (0..occupied.len()).map(|at| occupied[at] && (0..27).any(|i| !occupied[beside(at, i)])).collect();
    positions.iter().map(|x| open[place(x)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inside_of_a_cube_is_hidden_and_its_skin_is_not() {
        let n = 20;
        let point = |i: usize| [i % n, i / n % n, i / n / n].map(|k| k as f64);
        let positions: Vec<[f64; 3]> = (0..n * n * n).map(point).collect();
        let run = Run { body: 0, count: positions.len() as u32, first: 0, step: 1 };
        let open = exposed(&[run], &positions, &vec![1.0; positions.len()]);
        for (x, open) in positions.iter().zip(&open) {
            let depth = x.iter().map(|c| c.min(n as f64 - 1.0 - c)).fold(f64::MAX, f64::min);
            assert!(if depth < 1.0 { *open } else { depth < 4.0 || !open }, "{x:?}");
        }
        let scattered: Vec<[f64; 3]> = (0..100).map(|i| [i as f64 * 3.0, 0.0, 0.0]).collect();
        let run = Run { body: 0, count: 100, first: 0, step: 1 };
        assert!(exposed(&[run], &scattered, &[1.0; 100]).iter().all(|open| *open));
    }
}
