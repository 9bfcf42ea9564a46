//! FLIP of particles that carry the rotation of the material around them, the default.
//!
//! FLIP gives a node the velocity of its particles' centre of mass. At a rim that is not the velocity at the node:
//! rigid rotation strains the rim, and forces there act with too short an arm, so bodies lose their spin. Here a
//! particle has an angular velocity w_p of its own beside v_p, as in the rigid particle-in-cell method (RPIC: Jiang,
//! Schroeder, Selle, Teran and Stomakhin 2015, ACM Trans. Graph. 34, section 5.3), and takes changes of both,
//! as FLIP does:
//!
//! ```text
//! m_i v_i = sum_p m_p S_ip (v_p + w_p x (x_i - x_p))                                                            (a)
//! v_p += sum_i S_ip dv_i,    k_p^2 w_p += sum_i S_ip (x_i - x_p) x dv_i                                         (b)
//! ```
//! (b) is the transpose of (a) for masses m_p and moments of inertia m_p k_p^2. So forces at the nodes do the same work
//! on the particles' kinetic energy, sum m_p (v_p^2 + k_p^2 w_p^2)/2, as on the nodes' velocities,
//! and give them all of their torque:
//!
//! ```text
//! sum_p m_p (x_p x dv_p + k_p^2 dw_p) = sum_i x_i x m_i dv_i
//! ```
//! k_p must not change while a particle moves, or energy is made; it is that for which the nodes' moment of inertia and
//! the particles' are the same in the mean over places, k^2 = 2 (h^2/6 + b l^2) with
//! b = [`crate::basis::Basis::BOX_SPREAD`]. Rigid rotation is a state of (a) and (b): nothing is strained.
//!
//! Within a step particles turn. Velocities that are scattered in its middle, at places of its start,
//! so have the gradient
//!
//! ```text
//! W + (dt/2) W^2,    W = w x                                                                                    (c)
//! ```
//! without which a body spins up by 1e-4 of its angular momentum in a turn at five cells a radius.
//!
//! Changes alone let the noise of angular velocities grow from turn to turn, for a particle's own moment of inertia
//! among the nodes changes with its place while k does not. So with each radian that it turns,
//! a particle takes a part of the rotation around it:
//!
//! ```text
//! w_p += NOISE |w_p| dt (curl v / 2 - w_p)                                                                      (d)
//! ```
//! which takes next to nothing from a body that only vibrates. The ledger's damping counts what it takes. It is taken
//! in every eighth step, with dt eight times that step: in a single one w_p changes by less than reading and writing it
//! is worth.

use super::{TransferRule, VelocityState, rotation};
use crate::lanes::Lanes;
use crate::tensor::{Matrix, Number, Vector};

/// FLIP with rotation: equations in `transfer/rflip.rs`.
#[derive(Clone, Copy, Debug)]
pub struct Rflip;

impl TransferRule for Rflip {
    const HAS_SPIN: bool = true;
    const SETTLES: bool = true;

    #[inline(always)]
    fn take_change<V: Lanes, const D: usize>(
        state: &mut VelocityState<V, D>,
        change: Vector<V, D>,
        (moments, scale): (&Matrix<V>, V),
    ) {
        state.velocity += change;
        state.spin += rotation::moment::<V, D>(moments) * scale;
    }

    #[inline(always)]
    fn take_share<V: Lanes, const D: usize>(
        state: &mut VelocityState<V, D>,
        (mean, gradient): (Vector<V, D>, &Matrix<V>),
        share: V,
    ) {
        state.velocity = state.velocity * (V::ONE - share) + mean * share;
        state.spin = rotation::toward(state.spin, gradient, share);
    }

    #[inline(always)]
    fn settle<N: Number, const D: usize>(spin: Vector<N, 3>, gradient: &Matrix<N>, dt: N) -> Vector<N, 3> {
        let speed = if D == 2 { spin[2].abs() } else { spin.norm() };
        rotation::toward(spin, gradient, (N::of(NOISE) * speed * dt).min(N::ONE))
    }
}

/// What a particle takes of the rotation around it with each radian that it turns (d): without it the strain energy of
/// a disk of eight cells a radius, whose rim moves at a tenth of the wave speed, doubles in ten turns;
/// three times as much takes no more noise [-].
const NOISE: f64 = 0.3;

/// Once in so many steps particles take it.
pub const SETTLES_EVERY: u64 = 8;
