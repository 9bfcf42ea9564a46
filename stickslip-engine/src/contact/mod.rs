//! Contact: what bodies do to each other at the nodes that they share.
//!
//! [`Survey`] finds the nodes and asks the particles around each for the surfaces there; a law turns that and the
//! bodies' velocities into changes of velocity, pair by pair. Contact is applied twice a step, to interpolated and to
//! integrated velocities; both uses share one survey.

mod around;
mod contact_sums;
mod exchange;
mod friction;
mod law;
mod pair;
mod place;
mod rules;
mod solve;
mod spread;
mod surroundings;
mod survey;

pub use contact_sums::ContactSums;
pub use exchange::{common_normal, own_normals};
pub use friction::{Friction, Load};
pub use law::{Law, Span};
pub use pair::{Change, Pair, Step, Surface, Use};
pub use place::Place;
pub use rules::{Rule, Rules};
pub use solve::{Impulse, Impulses, Record, Solve};
pub use survey::{Encounter, Facing, Look, Near, Part, Side, Site, Survey, room};
