//! Masses of nodes with the mass, the centre and the inertia of the shape.

use super::Form;
use super::held::HeldFaces;
use super::linear::solve;
use crate::geometry::{Shape, ShapeMoments};
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
    ///
    /// Half a model has the masses of the whole. Those on which fixed faces act do not turn: they stay as they are.
    pub(super) fn weigh(&mut self, shape: &Shape) {
        let Some(moments) = shape.moments(D).and_then(|half| whole(half, &self.faces)) else { return };
        let scale = self.cell * self.counts.iter().fold(0, |a, &b| a.max(b)) as f64 * 0.5;
        let center = Vector::<f64, D>::of(moments.center);
        let arm = |place: Vector<f64, D>| (place - center) * (1.0 / scale);
        let count = 1 + D + D * (D + 1) / 2;
        let mut rows = [[0.0; MOST + 1]; MOST];
        for (node, &volume) in self.node_volumes.iter().enumerate().filter(|(_, volume)| **volume > 0.0) {
            for place in images(self.node_place(node), &self.faces) {
                let terms = terms(arm(place));
                for i in 0..count {
                    for j in 0..count {
                        rows[i][j] += volume * terms[i] * terms[j];
                    }
                    rows[i][MOST] -= volume * terms[i];
                }
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
        let factor = |node: usize| {
            let terms = terms(arm(self.node_place(node)));
            (0..count).fold(1.0, |sum, i| sum + factors[i] * terms[i])
        };
        let all: Vec<f64> = (0..self.nodes()).map(factor).collect();
        let sound = (self.node_volumes.iter().zip(&all)).all(|(v, f)| *v <= 0.0 || FACTORS.contains(f));
        if sound {
            let images = self.held.iter_mut().flat_map(|held| &mut held.images);
            images.for_each(|image| image.volume *= all[image.master as usize]);
            self.node_volumes.iter_mut().zip(all).for_each(|(volume, factor)| *volume *= factor);
        }
    }
}

/// Moments of the whole of which a shape is the half before mirrors; `None` where it has no end, or fixed faces hold
/// it.
fn whole(half: ShapeMoments, faces: &HeldFaces) -> Option<ShapeMoments> {
    let mut whole = half;
    for (axis, _, face) in faces.iter() {
        if face.is_fixed || faces.0[axis].iter().all(Option::is_some) {
            return None;
        }
        let arm = whole.center[axis] - face.at;
        whole.second.0[axis][axis] += whole.volume * arm * arm;
        whole.center[axis] = face.at;
        whole.volume *= 2.0;
        for a in 0..3 {
            for b in 0..3 {
                let turns = (a == axis) != (b == axis);
                whole.second.0[a][b] *= if turns { 0.0 } else { 2.0 };
            }
        }
    }
    Some(whole)
}

/// A place and its images in all mirrors.
fn images<const D: usize>(place: Vector<f64, D>, faces: &HeldFaces) -> Vec<Vector<f64, D>> {
    let mut all = vec![place];
    for (axis, _, face) in faces.iter() {
        let behind = all.clone().into_iter().map(|mut image| {
            image[axis] = 2.0 * face.at - image[axis];
            image
        });
        all.extend(behind);
    }
    all
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
