//! FLIP: particles take the changes of the nodes' velocities (Brackbill and Ruppel 1986, J. Comput. Phys. 65;
//! Sulsky, Chen and Schreyer 1994 for MPM), with a share of PIC if the scene wants one (Stomakhin et al. 2013).
//!
//! ```text
//! m_i v_i = sum_p m_p S_ip v_p
//! v_p += sum_i S_ip dv_i
//! v_p  = (1 - a) v_p + a sum_i S_ip v_i                        a: `pic_share`
//! ```
//! The second line is the transpose of the first, so forces at the nodes do the same work on the particles as on the
//! nodes, and no kinetic energy is lost but what `a` takes. A body loses spin at its rim, see [`super::rflip`].

use super::TransferRule;

/// What [`TransferRule`] says unless a rule says otherwise.
#[derive(Clone, Copy, Debug)]
pub struct Flip;

impl TransferRule for Flip {}
