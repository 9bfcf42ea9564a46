//! Particles to grid (P2G, scatter) and grid to particles (G2P, gather): the sums over the nodes that particles reach.
//!
//! [`Group`] takes one or several particles of a tile at once. The tests hold it against a naive transfer, one particle
//! and one node after the other as the equations read (`naive.rs`): the place to read them first.
//!
//! | sum | what for |
//! |---|---|
//! | [`Group::interpolate`] | G2P of velocities: sum S_i v_i, sum S_i dv_i |
//! | [`Group::flow`] | G2P of the velocity gradient L, and of the velocity with it |
//! | [`Group::moment`] | G2P of angular velocities, see [`turning`] |
//! | [`Group::scatter`] | P2G of mass, momentum and force |

mod group;
#[cfg(test)]
mod naive;
pub mod turning;

pub use group::{CellGroup, Group, Momentum, Own, ScatterTerms, Start, pairs};
#[cfg(test)]
pub use naive::Stencil;

/// What a scatter gives to the nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Share {
    /// Mass and momentum.
    Mass,
    /// Momentum alone, where the nodes have their mass already.
    Momentum,
    /// Force.
    Force,
    /// Mass, momentum and force.
    Everything,
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
