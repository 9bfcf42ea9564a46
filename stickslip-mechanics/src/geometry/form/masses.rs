//! Masses of nodes with the mass, the centre and the inertia of the shape.

use super::Form;
use super::linear::solve;
use crate::geometry::Shape;
use crate::tensor::Vector;

/// Terms of a quadratic polynomial in space.
const MOST: usize = 10;
/// How far the factor of a mass may be from one; beyond, masses stay as they are.
const FACTORS: std::ops::Range<f64> = 0.4..2.0;

impl<const D: usize> Form<D> {
    /// Multiplies the volumes of nodes by a quadratic polynomial of their places, so that volume, centre and second
    /// moments are those of the shape.
    ///
    /// Lumped masses alone spread a body: its inertia is that of the shape and m h^2/4 an axis beside it.
    pub(super) fn weigh(&mut self, shape: &Shape) {
        let Some(moments) = shape.moments(D) else { return };
        let scale = self.cell * self.counts.iter().fold(0, |a, &b| a.max(b)) as f64 * 0.5;
        let arm =
            |form: &Self, node: usize| (form.node_place(node) - Vector::of(moments.center)) * (1.0 / scale);
        let count = 1 + D + D * (D + 1) / 2;
        let mut rows = [[0.0; MOST + 1]; MOST];
        for (node, &volume) in self.node_volumes.iter().enumerate().filter(|(_, volume)| **volume > 0.0) {
            let terms = terms(arm(self, node));
            for i in 0..count {
                for j in 0..count {
                    rows[i][j] += volume * terms[i] * terms[j];
                }
                rows[i][MOST] -= volume * terms[i];
            }
        }
        let mut pair = 0;
        for a in 0..D {
            for b in a..D {
                rows[1 + D + pair][MOST] += moments.second.0[a][b] / (scale * scale);
                pair += 1;
            }
        }
        rows[0][MOST] += moments.volume;
        let least = 1e-12 * moments.volume;
        let Some(factors) = solve(&mut rows[..count], least) else { return };
        let factor = |node: usize, form: &Self| {
            let terms = terms(arm(form, node));
            (0..count).fold(1.0, |sum, i| sum + factors[i] * terms[i])
        };
        let all: Vec<f64> = (0..self.nodes()).map(|node| factor(node, self)).collect();
        let sound = (self.node_volumes.iter().zip(&all)).all(|(v, f)| *v <= 0.0 || FACTORS.contains(f));
        if sound {
            self.node_volumes.iter_mut().zip(all).for_each(|(volume, factor)| *volume *= factor);
        }
    }
}

/// 1, x, y, z, xx, xy, xz, yy, yz, zz.
fn terms<const D: usize>(x: Vector<f64, D>) -> [f64; MOST] {
    let mut terms = [0.0; MOST];
    terms[0] = 1.0;
    let mut next = 1 + D;
    for a in 0..D {
        terms[1 + a] = x[a];
        for b in a..D {
            terms[next] = x[a] * x[b];
            next += 1;
        }
    }
    terms
}
