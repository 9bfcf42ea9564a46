//! What the layers of bodies on grids of their own do to free rigid bodies, at the places where a step begins.
//!
//! ```text
//! p -= dt sum_s f_s,   L -= dt sum_s r_s x f_s         f_s = A (p n + tau), on the body that deforms
//! w^2 <= |M^-1 K|,     K = sum_s A J_s^T (k n n^T + k_t (1 - n n^T)) J_s
//! ```
//! r: from the centre, J: how a body moves at r with its velocities, M: its inertia; the norm is Frobenius'. What the
//! layers add to the square of the fastest motion of all is no more: that of a sum of two is at most the sum of theirs.

use super::six::{self, Six, SixFactor, SixMatrix};
use super::{FreeBody, Mechanism};
use crate::body::Body;
use crate::tensor::Vector;
use stickslip_reference::contact::Touch;

impl Mechanism {
    /// Adds impulses of the layers in a step of `dt` [s] on the free bodies to these, and says how fast the layers let
    /// the fastest move, w^2 [1/s^2].
    pub(super) fn add_layers<T, const D: usize>(
        &self,
        bodies: &[Body<T, D>],
        (touches, dt): (&[Touch<D>], f64),
        impulses: &mut [Six],
    ) -> f64 {
        let mut layers: Vec<Option<SixMatrix>> = vec![None; impulses.len()];
        for touch in touches {
            let Some(slot) = self.slot(touch.memory.partner as usize) else { continue };
            let center = bodies[self.bodies[slot].index].motion.as_deref().expect("it is rigid").center;
            let arm = (Vector((touch.at - touch.away).space()) - Vector(center)).0;
            six::add(&mut impulses[slot], -dt, &six::at(arm, touch.force().space()));
            let [normal, shear] = touch.stiffness.map(|stiffness| stiffness * touch.area);
            let layer = layers[slot].get_or_insert_default();
            layer.add(normal - shear, &six::at(arm, touch.normal.space()));
            for k in 0..D {
                let axis = std::array::from_fn(|i| f64::from(u8::from(i == k)));
                layer.add(shear, &six::at(arm, axis));
            }
        }
        let rates =
            self.bodies.iter().zip(&layers).filter_map(|(free, layer)| Some(rate(free, layer.as_ref()?)));
        rates.fold(0.0, f64::max)
    }
}

/// The norm of M^-1 K of a body.
fn rate(free: &FreeBody, layer: &SixMatrix) -> f64 {
    let inertia: SixFactor = free.inertia.factor();
    let column = |k: usize| {
        let axis: Six = std::array::from_fn(|i| f64::from(u8::from(i == k)));
        inertia.solve(&layer.times(&axis))
    };
    let columns: [Six; 6] = std::array::from_fn(column);
    let square = |i: usize| (0..6).map(|k| columns[i][k] * columns[k][i]).sum::<f64>();
    (0..6).map(square).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::Matrix;

    /// A body on two springs at the ends of an arm: sqrt(2 k / m) up and down, sqrt(2 k r^2 / I) as it rocks.
    #[test]
    fn the_rate_is_that_of_a_body_on_springs() {
        let (mass, inertia, stiffness, arm) = (2.0, 0.5, 30.0, 0.1);
        let free = FreeBody {
            index: 0,
            start: [0.0; 6],
            target: [0.0; 6],
            momenta: [0.0; 6],
            inertia: SixMatrix::inertia(mass, &(Matrix::IDENTITY * inertia)),
            radius: 1.0,
        };
        let mut layer = SixMatrix::default();
        for x in [-arm, arm] {
            layer.add(stiffness, &six::at([x, 0.0, 0.0], [0.0, 1.0, 0.0]));
        }
        let squares = [2.0 * stiffness / mass, 2.0 * stiffness * arm * arm / inertia];
        let expected = squares[0].hypot(squares[1]);
        assert!((rate(&free, &layer) / expected - 1.0).abs() < 1e-12, "{}", rate(&free, &layer));
    }
}
