//! Springs and dashpots between parts of bodies.

use super::Part;
use serde::Serialize;

/// A spring with a dashpot between parts of two bodies, along the line between their centres:
///
/// ```text
/// f = -(k (l - l_0) + c dl/dt) e          l e = x_a - x_b,   x: the mean over the points of a part, by their areas
/// ```
/// f acts on the first part, -f on the other, each shared out evenly. In the plane per metre of depth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spring {
    /// Its name in `joints.csv`, unique among springs and joints.
    pub name: String,
    /// The parts.
    pub ends: [SpringEnd; 2],
    /// k [N/m]
    pub stiffness: f64,
    /// c [N s/m]
    pub dashpot: f64,
    /// l_0, its length without a force, if not that of the start [m].
    pub length: Option<f64>,
}

/// A part of a body at which a spring ends.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpringEnd {
    /// Index into [`super::Scene::bodies`].
    pub body: usize,
    /// Which part of it, as it is at the start; it moves with the body.
    pub part: Part,
}
