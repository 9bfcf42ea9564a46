//! What holds, presses, pulls or drives parts of bodies from outside.

use super::{Expression, OutsideValue};
use crate::geometry::Shape;
use serde::Serialize;

/// A load or a support: what acts on a part of a body from outside.
///
/// In the plane, forces and stiffnesses are per metre of depth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Load {
    /// Its name in tables, unique among loads and supports.
    pub name: String,
    /// Index into [`super::Scene::bodies`].
    pub body: usize,
    /// Where it acts, on the undeformed body; it moves with the material there.
    pub part: Part,
    /// What it does.
    pub action: Action,
}

/// A part of a body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// Its surface, a face of that, or its volume.
    pub on: Extent,
    /// Only what lies in this shape.
    pub within: Option<Shape>,
}

/// The surface of a body, a face of that, or its volume.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Extent {
    /// All of its undeformed surface.
    #[default]
    Surface,
    /// Where the outward normal of the undeformed surface is within 45 degrees of an axis.
    Face {
        /// 0, 1 or 2.
        axis: usize,
        /// Along the axis, or against it.
        upper: bool,
    },
    /// All of its particles.
    Volume,
}

/// What acts on a part of a body.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Action {
    /// A force, shared out evenly over the part [N].
    Force([Expression; 3]),
    /// A force per undeformed area [Pa].
    Traction([Expression; 3]),
    /// A force per deformed area against the outward normal, which it follows [Pa].
    Pressure(Expression),
    /// A force per mass [m/s^2].
    Acceleration([Expression; 3]),
    /// How much warmer its particles are than in the state in which they are drawn [K].
    Temperature(Expression),
    /// A force toward where the part should be.
    Support(Support),
}

/// What holds a part of a body, or drives it.
///
/// Along each axis that is not free, and shared out evenly over the part:
///
/// ```text
/// f = -k (u - u*) - c (v - v*)         u* and v*: what the support prescribes
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Support {
    /// How the support moves along each axis; `None` where the part is free.
    pub motion: [Option<SupportMotion>; 3],
    /// Stiffness k of all of the part [N/m]; `None` is none beside a dashpot, else as good as rigid: as stiff
    /// as [`RIGID`] says.
    pub stiffness: Option<f64>,
    /// Dashpot, if it has one.
    pub dashpot: Option<Dashpot>,
}

/// What resists the velocity of a part.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Dashpot {
    /// A force over velocity, c, of all of the part [N s/m].
    Whole(f64),
    /// What the material behind a surface would be to waves: per area rho c_L along its normal now and rho c_T across
    /// (Lysmer and Kuhlemeyer 1969, J. Eng. Mech. Div. ASCE 95).
    Absorbing,
}

/// How a support moves along an axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SupportMotion {
    /// Displacement from the start [m].
    Displacement(Expression),
    /// Velocity [m/s].
    Velocity(Expression),
}

/// Stiffness of a rigid support in units of its part's mass over the square of the longest step: it gives way as much
/// as C^2 / RIGID of a cell does, a tenth with the Courant number C = 0.4. Between stiffer ones and single nodes more
/// of what a sudden stop sets free goes to and fro: 22 % of the energy with 4, 3 % with this [-].
pub const RIGID: f64 = 1.6;

impl Load {
    /// A load on all of a body's surface, or volume where it acts on mass.
    pub fn new(name: &str, body: usize, action: Action) -> Self {
        let on = if action.is_on_particles() { Extent::Volume } else { Extent::Surface };
        Load { name: name.to_string(), body, part: Part { on, within: None }, action }
    }

    /// The same on another part of the body.
    pub fn on(self, on: Extent) -> Self {
        Load { part: Part { on, ..self.part }, ..self }
    }

    /// The same only within a shape.
    pub fn within(self, shape: Shape) -> Self {
        Load { part: Part { within: Some(shape), ..self.part }, ..self }
    }

    /// Whether it holds its part.
    pub fn is_support(&self) -> bool {
        matches!(self.action, Action::Support(_))
    }
}

impl Action {
    /// Whether only particles feel it, and no surface.
    pub fn is_on_particles(&self) -> bool {
        matches!(self, Action::Acceleration(_) | Action::Temperature(_))
    }

    /// All of its values that may vary.
    pub fn values(&self) -> impl Iterator<Item = &Expression> {
        let (vector, support) = match self {
            Action::Force(vector) | Action::Traction(vector) | Action::Acceleration(vector) => {
                (&vector[..], None)
            }
            Action::Pressure(value) | Action::Temperature(value) => (std::slice::from_ref(value), None),
            Action::Support(support) => (&[][..], Some(support)),
        };
        let motions = support.into_iter().flat_map(|support| support.motion.iter().flatten());
        vector.iter().chain(motions.map(|motion| match motion {
            SupportMotion::Displacement(value) | SupportMotion::Velocity(value) => value,
        }))
    }
}

impl Action {
    /// Its key in scene files; that of a support is said by its motion.
    pub fn key(&self) -> &'static str {
        match self {
            Action::Force(_) => "force",
            Action::Traction(_) => "traction",
            Action::Pressure(_) => "pressure",
            Action::Acceleration(_) => "acceleration",
            Action::Temperature(_) => "temperature",
            Action::Support(_) => "displacement",
        }
    }

    /// The function from outside that says its values, if one does.
    pub fn outside(&self) -> Option<&OutsideValue> {
        self.values().find_map(Expression::outside)
    }
}

impl Support {
    /// Holds a part where it is.
    pub fn fixed() -> Self {
        let still = || Some(SupportMotion::Displacement(Expression::Constant(0.0)));
        Support { motion: [still(), still(), still()], stiffness: None, dashpot: None }
    }

    /// Whether it is as good as rigid.
    pub fn is_rigid(&self) -> bool {
        self.stiffness.is_none() && self.dashpot.is_none()
    }
}

impl Extent {
    /// Whether a surface with this outward normal belongs to it; a volume has none.
    pub fn has(self, normal: [f64; 3]) -> bool {
        match self {
            Extent::Surface => true,
            Extent::Face { axis, upper } => {
                let along = if upper { normal[axis] } else { -normal[axis] };
                along >= std::f64::consts::FRAC_1_SQRT_2 - 1e-9
            }
            Extent::Volume => false,
        }
    }
}
