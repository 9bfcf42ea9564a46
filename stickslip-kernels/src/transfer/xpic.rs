//! XPIC(m): PIC that leaves alone what the nodes can tell (Hammerquist and Nairn 2017, Comput. Methods Appl. Mech.
//! Eng. 318).
//!
//! With S the interpolation from nodes to particles, and S+ = m^-1 S^T m_p that from particles to nodes:
//!
//! ```text
//! v    = S+ v_p                                                as every transfer begins a step
//! v(m) = sum_(j < m) (1 - S+ S)^j v                            m: `xpic_order`; v(1) = v is PIC
//! v_p  = S (v(m) + dv)                                         dv: the step's change, by forces, contact and walls
//! ```
//! S v(m) goes to the particle velocities without those that no node sees as m grows: noise goes, waves and rotation
//! that cells resolve stay. Each order above the first costs a pass over the particles.

use super::TransferRule;
use crate::grid::Node;
use crate::tensor::{Real, Vector};

/// See the module. What it takes instead of the nodes' velocities is made by [`begin_filter`] and what follows it.
#[derive(Clone, Copy, Debug)]
pub struct Xpic;

impl TransferRule for Xpic {
    const ALWAYS_PIC: bool = true;
    const FILTERS: bool = true;
}

/// At each node before the passes that make v(m): u_0 = v.
///
/// u_j = (1 - S+ S)^j v stands in `integrated`, where every pass finds it, and m S+ S u_j comes into `velocity`.
pub fn begin_filter<T: Real, const D: usize>(node: &mut Node<T, D>, filtered: &mut Vector<T, D>) {
    *filtered = node.velocity;
    node.keep_and_clear();
}

/// After each pass: u_j+1 = u_j - S+ S u_j, added to v(m).
pub fn filter_once_more<T: Real, const D: usize>(node: &mut Node<T, D>, filtered: &mut Vector<T, D>) {
    node.divide_by_mass();
    node.integrated -= node.velocity;
    node.velocity = Vector::ZERO;
    *filtered += node.integrated;
}

/// After the last pass: the node gets its velocity back.
pub fn end_filter<T: Real, const D: usize>(node: &mut Node<T, D>) {
    node.velocity = node.start;
}
