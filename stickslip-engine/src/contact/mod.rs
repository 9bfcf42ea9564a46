//! Contact: what bodies do to each other at the nodes that they share.
//!
//! [`Survey`] finds the nodes and asks the particles around each for the surfaces there; a law turns that and the
//! bodies' velocities into changes of velocity, pair by pair. A *use* of contact is one such change of all velocities:
//! of the interpolated ones, of the integrated ones, and with MUSL of those that strain particles. All uses of a step
//! share one survey. [`ContactUse`] says what the velocities of a use are for.

mod around;
mod block_sums;
mod contact_sums;
mod exchange;
mod friction;
mod law;
mod pair;
mod press;
mod rules;
mod solve;
mod spread;
mod survey;

pub use crate::surroundings::ReferenceMap;
pub use block_sums::BlockSums;
pub use contact_sums::{ContactSums, RigidTouch};
pub use exchange::{common_normal, own_normals};
pub use friction::{Friction, SurfaceLoad};
pub use law::{PairLaw, Span};
pub use pair::{Change, ContactUse, Pair, SurfaceEstimate, TimeStep};
pub use press::Growth;
pub use rules::{Rule, Rules};
pub use solve::{Impulse, Impulses, Solve};
pub use survey::{BodyShare, Encounter, Facing, LawInputs, Near, SharedNode, Survey, SurveyPart, room};
