//! Stretch by the deformation gradient against stretch by positions: what a law sees, and where the particles are.

use super::neighbours::Neighbours;
use super::{Check, CheckInputs, Finding, exceeds, minus, norm, place};
use crate::observe::{Memory, OutputError};
use crate::scene::{HealthCheck, Scene};
use std::collections::BTreeMap;

/// Holds the distances of neighbours against those that their deformation gradients give.
///
/// ```text
/// e = |F dX| / |dX| - 1,   d = (|dx| - |F dX|) / |dX|        F: mean of both particles'
/// ```
/// What matters is the part of d that neighbours share: the mean over pairs of a direction in a region, `m`. Its square
/// is estimated from products of different pairs, so that noise of single particles adds nothing:
///
/// ```text
/// m^2 = ((sum d)^2 - sum d^2) / (n (n - 1))
/// ```
#[derive(Default)]
pub(super) struct StrainCheck {
    bodies: Vec<Stretch>,
    /// Largest root mean square of e so far, body by body [-].
    largest: Vec<f64>,
}

/// How far a body was stretched, and which of its pairs belong together.
#[derive(Default)]
struct Stretch {
    /// Group of each pair: its region and direction.
    group: Vec<u32>,
    /// Groups.
    groups: usize,
}

/// By how much more positions may differ from the stretch where material flows: it is sheared so far that the mean of
/// two gradients says less.
const FLOW: f64 = 2.0;
/// Stretch that counts at least: with less, positions that are off by a part of it harm nobody.
const LEAST_STRETCH: f64 = 1e-3;
/// Cells along the side of a region.
const REGION: f64 = 4.0;

/// Sums over the pairs of a group.
#[derive(Clone, Copy, Default)]
struct PairSums {
    count: f64,
    difference: f64,
    squares: f64,
    /// One of the particles.
    particle: u32,
}

impl Check for StrainCheck {
    fn kind(&self) -> HealthCheck {
        HealthCheck::Strain
    }

    fn advice(&self, _: &Scene) -> &'static str {
        "particles move without straining, or strain without moving: try interior = \"reference\" for bodies that stay \
         whole, another time.stress_update, smaller cells"
    }

    fn look(&mut self, look: &CheckInputs) -> Vec<Finding> {
        let side = REGION * look.scene.discretization.cell;
        self.bodies.resize_with(look.neighbours.len(), Stretch::default);
        for (stretch, neighbours) in self.bodies.iter_mut().zip(look.neighbours) {
            // At first, and where particles have left the domain.
            if stretch.group.len() != neighbours.pairs.len() {
                *stretch = Stretch::new(neighbours, side);
            }
        }
        self.largest.resize(self.bodies.len(), 0.0);
        look.on_grid()
            .filter_map(|body| self.bodies[body].look(look, body, &mut self.largest[body]))
            .collect()
    }

    fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        memory.keep("largest", &mut self.largest)?;
        Ok(())
    }

    fn carry(&mut self, memory: &mut Memory, origins: &[Option<usize>]) -> Result<(), OutputError> {
        let mut there: Vec<f64> = Vec::new();
        memory.keep("largest", &mut there)?;
        let largest =
            |origin: &Option<usize>| origin.and_then(|body| there.get(body).copied()).unwrap_or(0.0);
        self.largest = origins.iter().map(largest).collect();
        Ok(())
    }
}

impl Stretch {
    fn new(neighbours: &Neighbours, side: f64) -> Self {
        let mut known = BTreeMap::new();
        let group = |&[p, q]: &[u32; 2]| {
            let [from, to] = [p, q].map(|i| neighbours.start[i as usize]);
            let region = from.map(|x| (x / side).floor() as i64);
            let next = known.len() as u32;
            *known.entry((region, direction(minus(to, from)))).or_insert(next)
        };
        let group = neighbours.pairs.iter().map(group).collect();
        Stretch { group, groups: known.len() }
    }

    fn look(&self, look: &CheckInputs, body: usize, largest: &mut f64) -> Option<Finding> {
        let (Neighbours { start, pairs, .. }, now) = (&look.neighbours[body], &look.particles[body]);
        let mut squares = 0.0;
        let mut sums = vec![PairSums::default(); self.groups];
        for (&[p, q], &group) in pairs.iter().zip(&self.group) {
            let (a, b) = (&now[p as usize], &now[q as usize]);
            let before = minus(start[q as usize], start[p as usize]);
            let strained = [0, 1, 2].map(|i| {
                let (f, g) = (a.deformation[i], b.deformation[i]);
                (0..3).map(|j| 0.5 * (f[j] + g[j]) * before[j]).sum()
            });
            let length = norm(before);
            squares += (norm(strained) / length - 1.0).powi(2);
            let difference = (norm(minus(b.position, a.position)) - norm(strained)) / length;
            let sum = &mut sums[group as usize];
            sum.count += 1.0;
            sum.difference += difference;
            sum.squares += difference * difference;
            sum.particle = p;
        }
        *largest = largest.max((squares / pairs.len().max(1) as f64).sqrt());
        let (off, worst) = shared(&sums)?;
        let share = off / largest.max(LEAST_STRETCH);
        let trusted = look.scene.materials[look.scene.bodies[body].material].law.trusts_deformation();
        let bound = look.bound(HealthCheck::Strain) * if trusted { 1.0 } else { FLOW };
        if !exceeds(share, bound) {
            return None;
        }
        let position = now[worst as usize].position;
        let name = &look.scene.bodies[body].name;
        let message = format!(
            "distances in `{name}` differ by {off:.1e} from what its deformation gradients say, \
             which is {share:.2} of its stretch, most near {}",
            place(position)
        );
        Some(Finding { body: Some(body), position: Some(position), worst: share, message })
    }
}

/// Which of the 13 ways to a neighbour on a lattice is nearest.
fn direction(way: [f64; 3]) -> i64 {
    let length = norm(way);
    let steps = way.map(|x| (1.5 * x / length).round() as i64);
    (steps[0] + 3 * steps[1] + 9 * steps[2]).abs()
}

/// Root mean square of the difference that pairs of a group share [-], and a particle where it is largest; `None`
/// without pairs enough.
fn shared(sums: &[PairSums]) -> Option<(f64, u32)> {
    let several = || sums.iter().filter(|sum| sum.count > 1.0);
    let square = |sum: &PairSums| (sum.difference * sum.difference - sum.squares) / (sum.count - 1.0);
    let count: f64 = several().map(|sum| sum.count).sum();
    let worst = several().max_by(|a, b| (square(a) / a.count).total_cmp(&(square(b) / b.count)))?;
    let total: f64 = several().map(square).sum();
    let mean = total / count;
    Some((if mean < 0.0 { 0.0 } else { mean.sqrt() }, worst.particle))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_pairs_share_counts() {
        let sum = |differences: &[f64]| PairSums {
            count: differences.len() as f64,
            difference: differences.iter().sum(),
            squares: differences.iter().map(|d| d * d).sum(),
            particle: differences.len() as u32,
        };
        assert!(shared(&[sum(&[0.5])]).is_none());
        let (both, particle) = shared(&[sum(&[0.1, 0.1]), sum(&[-0.3, -0.3, -0.3])]).unwrap();
        assert!((both - ((2.0 * 0.01 + 3.0 * 0.09) / 5.0_f64).sqrt()).abs() < 1e-12);
        assert_eq!(particle, 3);
        assert_eq!(shared(&[sum(&[0.2, -0.2]), sum(&[0.1, -0.1])]).unwrap().0, 0.0);
    }

    #[test]
    fn a_way_and_its_opposite_are_one_direction() {
        for way in [[1.0, 0.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 1.0], [0.9, 0.1, -1.0]] {
            assert_eq!(direction(way), direction(way.map(|x| -x)));
        }
        assert_ne!(direction([1.0, 1.0, 0.0]), direction([1.0, -1.0, 0.0]));
    }
}
