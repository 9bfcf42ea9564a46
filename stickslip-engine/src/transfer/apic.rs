//! APIC: particles carry the affine field of velocities around them (Jiang, Schroeder, Selle, Teran and Stomakhin 2015,
//! ACM Trans. Graph. 34).
//!
//! ```text
//! m_i v_i = sum_p m_p S_ip (v_p + C_p (x_i - x_p))
//! v_p = sum_i S_ip v_i
//! C_p = (sum_i S_ip v_i (x) (x_i - x_p)) D_p^-1,   D_p = sum_i S_ip (x_i - x_p) (x) (x_i - x_p)
//! ```
//! D is diagonal, for functions are products over axes, and for linear functions C is the velocity gradient. As in PIC,
//! what a cell cannot tell apart is averaged away in every step, but for linear fields: a body that turns as a whole
//! keeps its spin, one that vibrates loses energy, the faster the smaller the step.
//!
//! The ledger closes as for FLIP: first velocities take the changes at the nodes by the transpose of the first line,
//! with a second moment q = k^2/2 that does not depend on the place, which leaves all of their work,
//!
//! ```text
//! v_p += sum_i S_ip dv_i,   q C_p += sum_i S_ip dv_i (x) (x_i - x_p),   kinetic energy  m (v^2 + q |C|^2)/2
//! ```
//! and what the second and third line then take is damping.
//!
//! C is kept as its two parts: the spin, which every particle has, and the rate of strain, a column of its own.

use super::{Rflip, TransferRule, VelocityState, rotation};
use crate::column::{Kind, STRAIN_RATE};
use crate::lanes::Lanes;
use crate::material::History;
use crate::tensor::{Matrix, Vector};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct Apic;

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
