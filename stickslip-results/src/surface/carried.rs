//! A surface carried along by the particles of its body.

use super::Skin;
use std::collections::HashMap;

/// How far around a corner particles carry it, in mean distances of the particles.
const REACH: f64 = 1.8;

/// A skin tied to the particles around each of its corners, as they were when nothing had moved.
///
/// ```text
/// x(X) = sum_p w_p (x_p + F_p (X - X_p)) / sum_p w_p,   w_p = (1 - |X - X_p|^2 / reach^2)^2
/// ```
/// x_p, F_p: place and deformation gradient of particle p now; X, X_p: the corner and the particle at the start [m].
/// A corner that no particle is near goes with the nearest.
#[derive(Clone, Debug)]
pub struct CarriedSkin {
    skin: Skin,
    /// Where the ties of each corner begin, and where those of the last one end.
    starts: Vec<u32>,
    /// Particle and share; shares of a corner add up to one.
    ties: Vec<(u32, f32)>,
    /// The particles at the start [m].
    reference: Vec<[f64; 3]>,
}

impl CarriedSkin {
    /// Ties a skin to the particles of its body, which are about `spacing` apart and at the start lie at `reference`
    /// [m]. There must be one.
    pub fn new(skin: Skin, reference: Vec<[f64; 3]>, spacing: f64) -> Self {
        let reach = REACH * spacing;
        let cell = |x: &[f64; 3]| x.map(|c| (c / reach).floor() as i64);
        let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        for (particle, x) in reference.iter().enumerate() {
            cells.entry(cell(x)).or_default().push(particle as u32);
        }
        let square = |x: &[f64; 3], particle: u32| -> f64 {
            let p = reference[particle as usize];
            (0..3).map(|k| (x[k] - p[k]).powi(2)).sum()
        };
        let (mut starts, mut ties) = (vec![0], Vec::new());
        for x in &skin.corners {
            let [i, j, k] = cell(x);
            let begin = ties.len();
            for n in 0..27 {
                let beside = [i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1];
                for &particle in cells.get(&beside).into_iter().flatten() {
                    let weight = 1.0 - square(x, particle) / (reach * reach);
                    if weight > 0.0 {
                        ties.push((particle, (weight * weight) as f32));
                    }
                }
            }
            if ties.len() == begin {
                let all = 0..reference.len() as u32;
                let nearest = all.min_by(|&a, &b| square(x, a).total_cmp(&square(x, b)));
                ties.push((nearest.expect("a body has particles"), 1.0));
            }
            let sum: f32 = ties[begin..].iter().map(|(_, weight)| weight).sum();
            ties[begin..].iter_mut().for_each(|(_, weight)| *weight /= sum);
            starts.push(ties.len() as u32);
        }
        CarriedSkin { skin, starts, ties, reference }
    }

    /// The same tied to some of its particles only, as many as it takes, and their numbers, which ascend.
    pub fn thinned(self) -> (Self, Vec<u32>) {
        let mut carriers: Vec<u32> = self.ties.iter().map(|(particle, _)| *particle).collect();
        carriers.sort_unstable();
        carriers.dedup();
        let place = |particle: u32| carriers.partition_point(|&other| other < particle) as u32;
        let thinned = CarriedSkin {
            ties: self.ties.iter().map(|&(particle, share)| (place(particle), share)).collect(),
            reference: carriers.iter().map(|&particle| self.reference[particle as usize]).collect(),
            ..self
        };
        (thinned, carriers)
    }

    /// The skin at the start.
    pub fn skin(&self) -> &Skin {
        &self.skin
    }

    /// The corners now [m], from the places [m] and the deformation gradients (row by row) of the particles.
    pub fn corners(&self, positions: &[[f64; 3]], deformations: &[[f64; 9]]) -> Vec<[f64; 3]> {
        let carried = |(corner, x): (usize, &[f64; 3])| {
            let mut sum = [0.0; 3];
            for &(particle, weight) in self.ties_of(corner) {
                let p = particle as usize;
                let arm = [0, 1, 2].map(|k| x[k] - self.reference[p][k]);
                let f = &deformations[p];
                for (k, sum) in sum.iter_mut().enumerate() {
                    let turned = (0..3).map(|l| f[3 * k + l] * arm[l]).sum::<f64>();
                    *sum += f64::from(weight) * (positions[p][k] + turned);
                }
            }
            sum
        };
        self.skin.corners.iter().enumerate().map(carried).collect()
    }

    /// What the particles have, at the corners.
    pub fn at_corners(&self, values: &[f32]) -> Vec<f32> {
        let mean = |corner: usize| -> f32 {
            self.ties_of(corner).iter().map(|&(particle, weight)| weight * values[particle as usize]).sum()
        };
        (0..self.skin.corners.len()).map(mean).collect()
    }

    /// The particle that has the largest share in a corner.
    pub fn nearest(&self, corner: usize) -> usize {
        let ties = self.ties_of(corner).iter();
        ties.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |&(particle, _)| particle as usize)
    }

    fn ties_of(&self, corner: usize) -> &[(u32, f32)] {
        &self.ties[self.starts[corner] as usize..self.starts[corner + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Shape;

    #[test]
    fn an_even_deformation_carries_every_corner_exactly() {
        let skin = Skin::of(&Shape::ball([0.0; 3], 0.5), 0.1, 3, None).unwrap();
        let lattice = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(|k| 0.1 * k as f64 - 0.45));
        let reference: Vec<[f64; 3]> =
            lattice.filter(|x| x.iter().map(|c| c * c).sum::<f64>() < 0.25).collect();
        let f = [1.2, 0.3, 0.0, -0.1, 0.9, 0.2, 0.0, 0.1, 1.1];
        let moved = |x: &[f64; 3]| [0, 1, 2].map(|k| 2.0 + (0..3).map(|l| f[3 * k + l] * x[l]).sum::<f64>());
        let positions: Vec<[f64; 3]> = reference.iter().map(moved).collect();
        let deformations = vec![f; reference.len()];
        let carried = CarriedSkin::new(skin, reference, 0.1);
        for (x, now) in carried.skin().corners.iter().zip(carried.corners(&positions, &deformations)) {
            let expected = moved(x);
            // Shares are kept in single precision.
            assert!((0..3).all(|k| (now[k] - expected[k]).abs() < 1e-6), "{now:?} {expected:?}");
        }
        let height: Vec<f32> = carried.reference.iter().map(|x| x[2] as f32).collect();
        let values = carried.at_corners(&height);
        assert!(
            carried.skin().corners.iter().zip(values).all(|(x, value)| (x[2] as f32 - value).abs() < 0.1)
        );
    }
}
