//! Where bodies touch, and what they do to each other there.
//!
//! Points of a body's surface are looked for in its partner: where the partner was undeformed, and how deep below its
//! surface. A point that lies inside is pushed out by a layer that stores energy, and held by the same layer in shear
//! as far as friction and cohesion bear. A bond lets the layer pull as far as adhesion bears. What acts at a point acts
//! on the nodes of both bodies by the functions there, so momentum is kept to round-off, and spin as closely as the
//! place in the partner is known.
//!
//! ```text
//! x(X_b) = q                        q: the point, X_b: its place in the partner
//! g = phi(X_b) / |F^-T N|           gap: undeformed distance phi and normal N of the partner's surface
//! n = F^-T N / |F^-T N|             normal, out of the partner
//! p = k (-g),  g < 0                k = beta / (h_a / M_a + h_b / M_b), M: P-wave modulus, h: cell
//!     and 0 <= k g <= a             where the point is bonded, a: adhesion; beyond, the bond gives way
//! tau = -k_t s                      s: slip that the layer stores, k_t: the same of shear moduli
//! ds/dt = u_t - w                   u_t: velocity along the surface against the partner's, w: slip
//! |tau| <= mu max(p, 0) + c + eta |w|                   equal where it slips, w along s; c: cohesion, eta: viscosity
//! f_I += N_I(X) A (p n + tau)       A: undeformed area of the point; half of it where the partner looks back
//! ```
//! A point touches while g < 0, while it is bonded, and, where its rule has cohesion or viscosity, while g is less than
//! a hundredth of a cell. Points that touch at the start are bonded by adhesion, and all others once they press.
//!
//! Forces that follow from places alone keep energy, and need no solution for all points together; what friction takes
//! is what the layer cannot bear. Points of both surfaces, each with half its area: Papadopoulos and Taylor (1992); a
//! layer in shear: Oden and Pires (1983); friction that remembers pressure: Prakash and Clifton (1993).

mod act;
mod friction;
mod images;
mod look;
mod near;
#[cfg(test)]
mod tests;

use act::relative_velocity;
pub use act::{approach, begin, follow, press, slip};
pub use friction::Friction;
pub use images::PeriodLengths;
pub use look::{Seen, look};
pub use near::{Bond, Neighbours, Partner, Search, find};

use crate::interior::Interior;
use crate::surface::SurfacePoint;
use serde::{Deserialize, Serialize};
use stickslip_mechanics::geometry::form::Weights;
use stickslip_mechanics::geometry::{MirroredShape, SignedDistance};
use stickslip_mechanics::tensor::Vector;

/// Stiffness of the layer over that of a cell of both bodies.
pub const STIFFNESS: f64 = 4.0;

/// A point that is at most so many times as deep as it comes in a step came there by its speed: the one or two steps
/// before were longer, as the body touched nobody.
const LANDED: f64 = 5.0;

/// How much longer than others its layer takes to feel all of its depth: bodies gain by that while they are pressed.
const PATIENCE: f64 = 10.0;

/// A body that deforms, as contact sees it.
pub struct Deforming<'a, const D: usize> {
    /// Its number among all bodies.
    pub body: usize,
    /// Its nodes.
    pub interior: &'a mut Interior<D>,
    /// Its undeformed shape, with its images behind faces that hold it.
    pub shape: &'a MirroredShape,
    /// Points of its surface.
    pub surface: &'a [SurfacePoint<D>],
    /// Moduli of its longitudinal and its shear wave at rest [Pa].
    pub moduli: [f64; 2],
    /// How long its layers take to feel the depth at which its points came to touch [s].
    pub settling: f64,
}

/// What has no grid of its own, as contact sees it: a rigid body, a face of the domain, a body on the common grid.
pub trait Obstacle: Sync {
    /// Its number among all bodies.
    fn body(&self) -> usize;
    /// Distance from a place to its surface, and the direction out of it; no number where it is not known.
    fn level(&self, place: [f64; 3]) -> SignedDistance;
    /// Its velocity at a place [m/s].
    fn velocity(&self, place: [f64; 3]) -> [f64; 3];
    /// A box that holds it [m].
    fn bounds(&self) -> [[f64; 3]; 2];
    /// The same distance to that image of it between periodic faces which is nearest, and from the body to the image
    /// [m].
    fn nearest(&self, place: [f64; 3]) -> (SignedDistance, [f64; 3]) {
        (self.level(place), [0.0; 3])
    }
    /// Whether it has energy of its own: forces move it, not a prescription.
    fn has_energy(&self) -> bool {
        false
    }
    /// Its cell over the moduli of its longitudinal and its shear wave [m/Pa].
    fn softness(&self) -> [f64; 2] {
        [0.0; 2]
    }
    /// Whether its velocities say how far its surface has moved; of others all points in their box are looked at.
    fn is_tracked(&self) -> bool {
        true
    }
}

/// A point of a body's surface that touches a partner: what is known of it from one step to the next.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    /// Number of the body.
    pub body: u32,
    /// Number of the point of its surface.
    pub point: u32,
    /// Number of the partner.
    pub partner: u32,
    /// Where the partner was undeformed there [m].
    pub place: [f64; 3],
    /// Pressure that friction remembers [Pa]; negative where it has none yet.
    pub remembered: f64,
    /// Slip that the layer stores, with that of the last step [m].
    pub stored: [f64; 3],
    /// What of it friction bore before that step [m].
    pub borne: [f64; 3],
    /// Energy that the layer stored in shear before that step [J].
    pub energy: f64,
    /// Speed at which it slipped in the step before; zero where it stuck [m/s].
    pub speed: f64,
    /// How long it has touched [s].
    pub age: f64,
    /// Of the depth at which it came to touch, what its layer does not feel yet; negative: the gap at which it was
    /// bonded at the start, which its layer never feels [m].
    pub unfelt: f64,
    /// How long the layer takes to feel it, over how long its bodies settle.
    pub patience: f64,
    /// The depth that the layer felt in the step before, negative where a bond was stretched, and how much more of the
    /// first depth it then came to feel [m].
    pub felt: [f64; 2],
    /// Energy that its bond stores, stretched [J]; none where it has no bond.
    pub bond: Option<f64>,
}

impl Memory {
    /// Body, point and partner, by which points that touch are ordered.
    pub fn key(&self) -> (u32, u32, u32) {
        (self.body, self.point, self.partner)
    }
}

/// A point that touches, in a step.
#[derive(Clone, Copy, Debug)]
pub struct Touch<const D: usize> {
    /// What it is known by.
    pub memory: Memory,
    /// Place of the body in the list of those that deform.
    pub side: usize,
    /// Its partner.
    pub met: Met<D>,
    /// From the partner to that image of it between periodic faces which is touched [m].
    pub away: Vector<f64, D>,
    /// Where it is [m].
    pub at: Vector<f64, D>,
    /// Normal, out of the partner.
    pub normal: Vector<f64, D>,
    /// Gap that the layer feels, negative where it presses [m].
    pub gap: f64,
    /// Whether it does not touch yet.
    pub is_ahead: bool,
    /// Undeformed area times the share of this side [m^2], in the plane length [m].
    pub area: f64,
    /// Stiffness of the layer against pressure and against shear [Pa/m].
    pub stiffness: [f64; 2],
    /// Traction of friction on the body [Pa].
    pub traction: Vector<f64, D>,
    /// Work that friction, cohesion and viscosity took in the step [J].
    pub friction: f64,
    /// Work that its bond took as it gave way in the step [J].
    pub torn: f64,
    /// Work by which the layer came to feel more of the depth since the step before [J].
    pub deepening: f64,
    /// Velocity along the surface, against the partner's, that moves the bodies in the step [m/s].
    pub slip: Vector<f64, D>,
}

/// What a point of a surface touches.
#[derive(Clone, Copy, Debug)]
pub enum Met<const D: usize> {
    /// A body that deforms, by its place in the list of these, and its functions there.
    Deforming(usize, Weights<D>),
    /// An obstacle, by its place in the list of these.
    Obstacle(usize),
}

/// The points that touched and do no longer; both lists are ordered by body, point and partner. What their layers
/// stored in shear is lost to the bodies, as to friction, and what their bonds stored, as to adhesion.
pub fn parted<'a, const D: usize>(
    known: &'a [Memory],
    touches: &'a [Touch<D>],
) -> impl Iterator<Item = &'a Memory> {
    let touches_yet =
        |memory: &Memory| touches.binary_search_by_key(&memory.key(), |touch| touch.memory.key()).is_ok();
    let stores = |memory: &Memory| memory.energy > 0.0 || memory.bond > Some(0.0);
    known.iter().filter(move |memory| stores(memory) && !touches_yet(memory))
}

impl<const D: usize> Touch<D> {
    /// The body and its partner, by their places in the list of those that deform; the body twice at an obstacle.
    pub fn sides(&self) -> [usize; 2] {
        match self.met {
            Met::Deforming(b, _) => [self.side, b],
            Met::Obstacle(_) => [self.side; 2],
        }
    }

    /// Depth that the layer feels, negative where a bond is stretched [m].
    pub fn depth(&self) -> f64 {
        if self.memory.bond.is_some() { -self.gap } else { (-self.gap).max(0.0) }
    }

    /// Pressure of the layer, negative where a bond pulls [Pa].
    pub fn pressure(&self) -> f64 {
        self.stiffness[0] * self.depth()
    }

    /// Pressure that friction follows: none where a bond pulls [Pa].
    pub fn push(&self) -> f64 {
        self.stiffness[0] * (-self.gap).max(0.0)
    }

    /// Force on the body [N].
    pub fn force(&self) -> Vector<f64, D> {
        (self.normal * self.pressure() + self.traction) * self.area
    }

    /// Energy that the layer stores [J].
    pub fn energy(&self) -> f64 {
        let pressure = self.pressure();
        0.5 * self.area * pressure * pressure / self.stiffness[0] + self.memory.energy
    }

    /// Force that the layer has yet to feel where it is now [N].
    pub fn unfelt_force(&self) -> f64 {
        if self.memory.patience == f64::INFINITY {
            return 0.0;
        }
        self.area * self.stiffness[0] * (self.memory.unfelt - self.gap.max(0.0)).max(0.0)
    }
}
