//! Particles to grid (P2G, scatter) and grid to particles (G2P, gather): the sums over the nodes that particles reach.
//!
//! [`Group`] takes one or several particles of a tile at once. The tests hold it against a naive transfer, one particle
//! and one node after the other as the equations read (`naive.rs`): the place to read them first.
//!
//! | sum | what for |
//! |---|---|
//! | [`Group::interpolate`] | G2P of velocities: sum S_i v_i, sum S_i dv_i |
//! | [`Group::flow`] | G2P of the velocity gradient L, and of the velocity with it |
//! | [`Group::moments`], [`Group::spread`] | G2P of rotation and of affine velocities |
//! | [`Group::scatter`] | P2G of mass, momentum and force |

mod apic;
mod flip;
mod group;
mod naive;
mod pic;
mod rflip;
pub mod rotation;
mod xpic;

pub use apic::Apic;
pub use flip::Flip;
pub use group::{CellGroup, Group, Momentum, Own, ScatterTerms, Start, pairs};
pub use naive::Stencil;
pub use pic::Pic;
pub use rflip::{Rflip, SETTLES_EVERY};
pub use xpic::{Xpic, begin_filter, end_filter, filter_once_more};

use crate::lanes::Lanes;
use crate::material::History;
use crate::scheme::Transfer;
use crate::tensor::{Matrix, Number, Symmetric, Vector};

/// What a particle carries of the velocities around it from step to step.
#[derive(Clone, Copy, Debug)]
pub struct VelocityState<V, const D: usize> {
    /// v_p [m/s]
    pub velocity: Vector<V, D>,
    /// w_p, in the plane about the third axis [rad/s].
    pub spin: Vector<V, 3>,
    /// Symmetric part of the velocity gradient that it carries, if its transfer has that column, embedded in
    /// space [1/s].
    pub strain_rate: Symmetric<V>,
}

/// How velocities go from particles to nodes and back; what a rule does not say is FLIP. The sums over nodes, which are
/// most of the work, are the same for all rules.
///
/// To add a transfer: write its file with this, name it in [`crate::scheme::Transfer`], and put both on the list below.
/// The changes that it takes of the nodes' velocities must be the transpose of what it gives to the nodes: then they do
/// the same work on both, and the ledger knows that all else that it takes is damping.
pub trait TransferRule {
    /// Whether particles keep their spin from step to step; else only those of rigid bodies have any.
    const HAS_SPIN: bool = false;
    /// Columns that particles have for it: none, or the rate of strain.
    const COLUMNS: &'static [History] = &[];
    /// Whether particles take the nodes' velocities themselves, and not a share of them.
    const ALWAYS_PIC: bool = false;
    /// Whether these velocities are v(m) + dv of [`Xpic`].
    const FILTERS: bool = false;

    /// Whether they take the gradient of the nodes' velocities from their moments, by [`Apic::taken`], and not by the
    /// gradients of the shape functions.
    const AFFINE: bool = false;

    /// G2P of the changes of the nodes' velocities: v_p += sum_i S_ip dv_i = `change`, and what else particles carry,
    /// by `moments` = sum_i S_ip dv_i (x) (x_i - x_p) / h and `scale` = h / k^2, see [`Rflip`].
    #[inline(always)]
    fn take_change<V: Lanes, const D: usize>(
        state: &mut VelocityState<V, D>,
        change: Vector<V, D>,
        _moments: (&Matrix<V>, V),
    ) {
        state.velocity += change;
    }

    /// G2P of a share a of the nodes' velocities themselves, all of it where they are [`TransferRule::ALWAYS_PIC`]:
    /// v_p = (1 - a) v_p + a sum_i S_ip v_i, and what else particles carry, by the gradient of these velocities [1/s].
    #[inline(always)]
    fn take_share<V: Lanes, const D: usize>(
        state: &mut VelocityState<V, D>,
        (mean, _gradient): (Vector<V, D>, &Matrix<V>),
        share: V,
    ) {
        state.velocity = state.velocity * (V::ONE - share) + mean * share;
    }

    /// Whether spins [settle](TransferRule::settle).
    const SETTLES: bool = false;

    /// The spin after a time [s] in which velocities had this gradient, embedded in space [1/s]. Asked for once in
    /// [`SETTLES_EVERY`] steps.
    #[inline(always)]
    fn settle<N: Number, const D: usize>(spin: Vector<N, 3>, _gradient: &Matrix<N>, _dt: N) -> Vector<N, 3> {
        spin
    }

    /// Gradient of the velocities that a particle gives to its nodes, embedded in space [1/s]; `half_step` is dt/2 in
    /// the middle of a step, else 0 [s]. Particles of rigid bodies turn, whatever the transfer.
    #[inline(always)]
    fn gradient<V: Lanes, const D: usize>(state: &VelocityState<V, D>, half_step: V) -> Matrix<V> {
        rotation::gradient::<V, D>(&state.spin, half_step)
    }
}

/// The list of transfers: does one thing with the rule of whichever transfer is at hand.
macro_rules! of_transfer {
    ($transfer:expr, $rule:ident => $does:expr) => {
        of_transfer!($transfer, $rule => $does; Rflip Flip Pic Apic Xpic)
    };
    ($transfer:expr, $rule:ident => $does:expr; $($name:ident)*) => {
        match $transfer {
            $($crate::scheme::Transfer::$name => {
                type $rule = $crate::transfer::$name;
                $does
            })*
        }
    };
}

pub(crate) use of_transfer;

/// [`TransferRule::HAS_SPIN`]
#[inline(always)]
pub fn has_spin(transfer: Transfer) -> bool {
    of_transfer!(transfer, Rule => Rule::HAS_SPIN)
}

/// [`TransferRule::COLUMNS`]
pub fn columns(transfer: Transfer) -> &'static [History] {
    of_transfer!(transfer, Rule => Rule::COLUMNS)
}

/// [`TransferRule::FILTERS`]
pub fn filters(transfer: Transfer) -> bool {
    of_transfer!(transfer, Rule => Rule::FILTERS)
}

/// [`TransferRule::SETTLES`]
pub fn settles(transfer: Transfer) -> bool {
    of_transfer!(transfer, Rule => Rule::SETTLES)
}

/// [`TransferRule::AFFINE`]
#[inline(always)]
pub fn is_affine(transfer: Transfer) -> bool {
    of_transfer!(transfer, Rule => Rule::AFFINE)
}

/// The share of the nodes' velocities themselves that particles take, where a scene wants this one.
pub fn pic_share(transfer: Transfer, wanted: f64) -> f64 {
    if of_transfer!(transfer, Rule => Rule::ALWAYS_PIC) { 1.0 } else { wanted }
}

/// What a scatter gives to the nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Share {
    /// Mass and momentum.
    Mass,
    /// Momentum alone, where the nodes have their mass already.
    Momentum,
    /// Force.
    Force,
    /// Mass times the dilatation rate, in the place of the mass: see `step/average.rs`.
    Dilatation,
    /// Volume times the mean stress, in the place of the mass.
    MeanStress,
    /// Mass, momentum and force.
    Everything,
}

impl Share {
    /// Whether mass is in it, or what is summed in its place.
    #[inline(always)]
    pub fn has_mass(self) -> bool {
        matches!(self, Share::Mass | Share::Everything) || self.is_averaged()
    }

    /// Whether momentum is in it.
    #[inline(always)]
    pub fn has_momentum(self) -> bool {
        matches!(self, Share::Mass | Share::Momentum | Share::Everything)
    }

    /// Whether it is something of which nodes take the mean.
    #[inline(always)]
    pub fn is_averaged(self) -> bool {
        matches!(self, Share::Dilatation | Share::MeanStress)
    }

    /// Whether force is in it.
    #[inline(always)]
    pub fn has_force(self) -> bool {
        matches!(self, Share::Force | Share::Everything)
    }
}

/// Whole steps from 0 to below `width` along every axis: the nodes that a basis reaches from its base node.
pub fn offsets<const D: usize>(width: usize) -> impl Iterator<Item = [usize; D]> {
    (0..width.pow(D as u32)).map(move |i| {
        let mut rest = i;
        let mut offset = [0; D];
        for o in offset.iter_mut().rev() {
            *o = rest % width;
            rest /= width;
        }
        offset
    })
}
