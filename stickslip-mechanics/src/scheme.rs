//! What of a scheme has a name in scenes, and a place in the kernels.

use serde::{Deserialize, Serialize};

/// Shape functions between particles and grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum BasisKind {
    /// Tent functions of the particle's centre.
    Linear,
    /// Tent functions averaged over the particle's undeformed box (uniform GIMP; Bardenhagen and Kober 2004).
    #[default]
    Gimp,
    /// Quadratic B-splines of the particle's centre (Steffen, Kirby and Berzins 2008).
    Spline,
    /// Cubic ones.
    Cubic,
}

/// Where a body that deforms is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Interior {
    /// On the grid that all bodies share, by the material point method.
    #[default]
    Grid,
    /// On a grid of its own undeformed places, by quadratic B-splines whose nodes stay.
    Reference,
}

/// What a face of the domain does. Faces other than `Open` lie on grid nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Face {
    /// Nothing; material that reaches it stops the run.
    #[default]
    Open,
    /// A mirror: no velocity through it, none of its resistance along it.
    Symmetry,
    /// Material sticks to it: no velocity at all.
    Fixed,
    /// What leaves through it comes in through the other face across its axis, which is periodic, too.
    Periodic,
}

/// What velocities particles take from the grid and give to it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Transfer {
    /// FLIP of particles that also carry the rotation of the material around them.
    #[default]
    Rflip,
    /// FLIP: particles take the grid's change of velocity (Brackbill and Ruppel 1986).
    Flip,
    /// PIC: particles take the grid's velocity (Harlow 1964).
    Pic,
    /// XPIC(m): PIC that leaves alone what the grid resolves (Hammerquist and Nairn 2017).
    Xpic,
    /// APIC: particles take the grid's velocity and its affine field around them (Jiang et al. 2015).
    Apic,
}

/// Whose change of volume a particle takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum VolumeChange {
    /// Its own.
    #[default]
    Own,
    /// The mean around the nodes that it reaches: cells of nearly incompressible material do not lock.
    Averaged,
}
