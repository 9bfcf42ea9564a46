//! Contact laws, one file each: from the velocities of two bodies at a node to what contact does to them.

mod gap;
mod glued;
mod kinematic;
mod none;
mod traction;

use super::{Change, Pair};
use crate::scene::ContactLaw;
use crate::tensor::{Real, Vector};

/// What a pair of bodies does at a node that they share.
pub trait Law<T: Real, const D: usize>: Sync {
    /// What contact does to two bodies with these velocities [m/s], before it is scaled.
    fn change(&self, pair: &Pair<T, D>, velocities: [Vector<T, D>; 2]) -> Change<T, D>;
}

/// The shelf: the law of each word in scene files.
pub fn law<T: Real, const D: usize>(law: ContactLaw) -> &'static dyn Law<T, D> {
    match law {
        ContactLaw::None => &none::None,
        ContactLaw::Kinematic => &kinematic::Kinematic,
        ContactLaw::Traction => &traction::Traction,
        ContactLaw::Gap => &gap::Gap,
        ContactLaw::Glued => &glued::Glued,
    }
}
