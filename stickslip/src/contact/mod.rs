//! Contact: what bodies do to each other at the nodes that they share.
//!
//! [`Survey`] finds the nodes and asks the particles around each for the surfaces there; a law turns that and the
//! bodies' velocities into changes of velocity, pair by pair. Contact is applied twice a step, to interpolated and to
//! integrated velocities; both uses share one survey.

mod exchange;
mod law;
mod pair;
mod rules;
mod solve;
mod survey;
mod tally;

pub use exchange::{common_normal, own_normals, sticking};
pub use law::Law;
pub use pair::{Change, Pair, Surface};
pub use rules::{Rule, Rules};
pub use solve::{Impulse, solve};
pub use survey::{Encounter, Near, Side, Site, Survey};
pub use tally::Tally;
