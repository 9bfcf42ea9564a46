//! Contact laws, one file each: from the velocities of two bodies at a node to what contact does to them.

mod gap;
mod glued;
mod kinematic;
mod none;
mod regression;
mod separation;
mod surface;
mod traction;

pub use regression::NearParticle;

use super::{Change, Facing, LawInputs, Pair, room};
use crate::scene::ContactLaw;
use crate::tensor::{Real, Vector};

/// Over how much of a step a law judges its impulse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Span {
    /// Each use of contact by itself, as the paper does.
    EachUse,
    /// The whole of it, in the use for [`crate::contact::ContactUse::VelocityChange`]; impulses on velocities that
    /// strain are no part.
    WholeStep,
}

/// What a pair of bodies does at a node that they share.
pub trait PairLaw<T: Real, const D: usize>: Sync {
    /// What contact does to two bodies with these velocities [m/s], before it is scaled.
    fn change(&self, pair: &Pair<T, D>, velocities: [Vector<T, D>; 2]) -> Change<T, D>;

    /// Over how much of a step the impulse is judged.
    fn span(&self) -> Span {
        Span::EachUse
    }

    /// Normal and gap of a pair at a node, unless they are so far apart that they cannot touch in this step. A law that
    /// looks at single particles lists them in `points`, which are the thread's and kept from step to step.
    fn facing(&self, look: &LawInputs<T, D>, _points: &mut Vec<NearParticle<T, D>>) -> Option<Facing<T, D>> {
        Some(room(look))
    }

    /// Whether of what the bodies are like at a node the law looks at their places, volumes and forces alone, not at
    /// their stresses and own normals.
    fn by_place(&self) -> bool {
        false
    }
}

/// The list: the law of each word in scene files.
pub fn law<T: Real, const D: usize>(law: ContactLaw) -> &'static dyn PairLaw<T, D> {
    match law {
        ContactLaw::None => &none::None,
        ContactLaw::Kinematic => &kinematic::Kinematic,
        ContactLaw::Traction => &traction::Traction,
        ContactLaw::Gap => &gap::Gap,
        ContactLaw::Separation => &separation::Separation,
        ContactLaw::Regression => &regression::Regression,
        ContactLaw::Surface => &surface::Surface,
        ContactLaw::Glued => &glued::Glued,
    }
}
