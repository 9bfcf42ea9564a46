//! APIC: particles carry the affine field of velocities around them (Jiang, Schroeder, Selle, Teran and Stomakhin 2015,
//! ACM Trans. Graph. 34), here with a constant inertia of their own.
//!
//! ```text
//! m_i v_i = sum_p m_p S_ip (v_p + C_p (x_i - x_p))                                                              (a)
//! v_p = sum_i S_ip v_i
//! q C_p += sum_i S_ip v_i (x) (x_i - x_p) - C_p D_p,   D_p = sum_i S_ip (x_i - x_p) (x) (x_i - x_p)              (b)
//! ```
//! In the paper q is D_p, so that C_p on the right of (b) is that on the left. But D_p changes while a particle moves,
//! by a third to either side with GIMP, and a particle that keeps C_p until the next scatter then gives another angular
//! momentum than it took. Here q = k^2/2 of [`super::Rflip`], the mean of D_p over all places, stays. With splines,
//! whose D_p is the same everywhere, nothing differs. (b) is the transpose of (a) for what the nodes' velocities are
//! beside those that the particle gave, so particles and nodes change their angular momentum by the same,
//!
//! ```text
//! sum_p m_p (x_p x v_p + k^2 w_p),   w_p: spin of C_p
//! ```
//! and (a) followed by (b) makes no kinetic energy m (v^2 + q |C|^2)/2 as long as D_p <= 2 q. It is 3/2 q at most, by
//! tent functions in the middle of a cell.
//!
//! Where the velocities v~_i that move particles are those of a second scatter, x_p and v_p part: x_p x v_p changes by
//! dt v~_p x v_p. No angular momentum changes where every share S_ip of a particle moves with its node, for
//! m_i v~_i x v~_i = 0. What the shares then have about their particle goes to its spin:
//!
//! ```text
//! k^2 w_p += dt sum_i S_ip v~_i x (C_p (x_i - x_p))                                                             (c)
//! ```
//! As in PIC, what a cell cannot tell apart is averaged away in every step, but for linear fields: a body that turns as
//! a whole keeps its spin, one that vibrates loses energy, the faster the smaller the step.
//!
//! The ledger closes as for FLIP: first velocities take the changes at the nodes by the transpose of (a), which leaves
//! all of their work, and what (b) then takes is damping.
//!
//! ```text
//! v_p += sum_i S_ip dv_i,   q C_p += sum_i S_ip dv_i (x) (x_i - x_p)
//! ```
//! C is kept as its two parts: the spin, which every particle has, and the rate of strain, a column of its own.

use super::{Rflip, TransferRule, VelocityState, rotation};
use crate::column::{Kind, STRAIN_RATE};
use crate::lanes::Lanes;
use crate::material::History;
use crate::tensor::{Matrix, Vector};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct Apic;

impl Apic {
    /// C_p of (b) from the one that was given [1/s], `moments` = sum_i S_ip v_i (x) (x_i - x_p) / h, `spread` = D_p /
    /// h^2, `cell` = h and `scale` = h / k^2.
    #[inline(always)]
    pub fn taken<V: Lanes>(
        given: &Matrix<V>,
        (moments, spread): (&Matrix<V>, &Matrix<V>),
        (cell, scale): (V, V),
    ) -> Matrix<V> {
        let mut widest = V::ZERO;
        for row in &spread.0 {
            widest = widest.max(row[0].abs() + row[1].abs() + row[2].abs());
        }
        // D_p / q <= 3/2, whatever round-off does.
        let share = (scale + scale).min(V::of(1.5) / (widest * cell));
        let others = *moments - *given * *spread * cell;
        *given + others * share
    }

    /// w_p of (c) [rad/s]: `moments` are those of v~, `turn` = dt h / k^2.
    #[inline(always)]
    pub fn carried<V: Lanes, const D: usize>(
        state: &VelocityState<V, D>,
        moments: &Matrix<V>,
        turn: V,
    ) -> Vector<V, 3> {
        let given = Apic::gradient(state, V::ZERO);
        state.spin + rotation::moment::<V, D>(&(given * moments.transpose())) * turn
    }
}

impl TransferRule for Apic {
    const HAS_SPIN: bool = true;
    const COLUMNS: &'static [History] = &[History::new(STRAIN_RATE, "1/s", Kind::Symmetric)];
    const ALWAYS_PIC: bool = true;
    const AFFINE: bool = true;

    #[inline(always)]
    fn take_change<V: Lanes, const D: usize>(
        state: &mut VelocityState<V, D>,
        change: Vector<V, D>,
        (moments, scale): (&Matrix<V>, V),
    ) {
        Rflip::take_change(state, change, (moments, scale));
        state.strain_rate += moments.symmetric_part() * (scale + scale);
    }

    #[inline(always)]
    fn take_share<V: Lanes, const D: usize>(
        state: &mut VelocityState<V, D>,
        (mean, gradient): (Vector<V, D>, &Matrix<V>),
        _share: V,
    ) {
        state.velocity = mean;
        state.spin = rotation::toward(state.spin, gradient, V::ONE);
        state.strain_rate = gradient.symmetric_part();
    }

    #[inline(always)]
    fn gradient<V: Lanes, const D: usize>(state: &VelocityState<V, D>, _half_step: V) -> Matrix<V> {
        rotation::gradient::<V, D>(&state.spin, V::ZERO) + state.strain_rate.matrix()
    }
}
