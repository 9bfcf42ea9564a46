//! What joins rigid bodies to each other and to the ground.

use super::{Expression, Scene};
use serde::Serialize;

/// What joins a free rigid body to another rigid body, or to the ground.
///
/// Places and axes are those of the start; they move with the bodies. In the plane, forces are per metre of depth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Joint {
    /// Its name in `joints.csv`, unique among joints.
    pub name: String,
    /// Index into [`super::Scene::bodies`] of the free rigid body that it holds.
    pub body: usize,
    /// Index of the rigid body to which it holds it; `None`: the ground.
    pub to: Option<usize>,
    /// Which motion it leaves.
    pub kind: JointKind,
}

/// Which relative motion a joint leaves, and what drives that.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum JointKind {
    /// Turning about an axis through a point.
    Hinge {
        /// A point of the axis [m].
        point: [f64; 3],
        /// Unit vector along the axis; in the plane the third [-].
        axis: [f64; 3],
        /// What drives it.
        motor: Motor,
    },
    /// Sliding along a direction, without turning.
    Slider {
        /// Unit vector along the direction [-].
        axis: [f64; 3],
        /// What drives it.
        motor: Motor,
    },
    /// Moving in a plane and turning about its normal.
    Planar {
        /// Unit vector along the normal; in the plane the third, and it leaves all motion [-].
        axis: [f64; 3],
        /// What drives the turning.
        motor: Motor,
    },
    /// Turning about a point in every way.
    Ball {
        /// The point [m].
        point: [f64; 3],
    },
    /// None: two bodies are one.
    Weld,
    /// All of it; a spring acts along the line between two points.
    Spring {
        /// A point of the body, and one of what it is joined to [m].
        points: [[f64; 3]; 2],
        /// Length without a force, if not that of the start [m].
        length: Option<f64>,
        /// Force over the change of length [N/m].
        stiffness: f64,
        /// Force over the speed at which the length changes [N s/m].
        dashpot: f64,
    },
}

/// What drives the motion that a hinge or a slider leaves, or the turning of a planar joint: moments [N m], forces of a
/// slider [N].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Motor {
    /// Moment or force at time t.
    pub push: Expression,
    /// Speed at time t that the motor keeps up [rad/s, m/s]; `None`: any.
    pub speed: Option<Expression>,
    /// Largest moment or force with which it does so; infinite by default.
    #[serde(serialize_with = "super::infinity_as_text")]
    pub limit: f64,
    /// Moment or force against the way from the start, over the way [N m/rad, N/m].
    pub stiffness: f64,
    /// Moment or force against the speed, over the speed [N m s/rad, N s/m].
    pub dashpot: f64,
}

impl Default for Motor {
    /// None.
    fn default() -> Self {
        Motor {
            push: Expression::Constant(0.0),
            speed: None,
            limit: f64::INFINITY,
            stiffness: 0.0,
            dashpot: 0.0,
        }
    }
}

impl Joint {
    /// Whether it leaves bodies less than all motion against each other; springs leave it.
    pub fn holds(&self) -> bool {
        !matches!(self.kind, JointKind::Spring { .. })
    }
}

impl Scene {
    /// Whether a joint to the ground lets a free rigid body neither move along an axis nor turn but about it: it stays
    /// on a mirror across that axis.
    pub fn slides_along(&self, body: usize, mirror: usize) -> bool {
        let stays = |joint: &Joint| match &joint.kind {
            JointKind::Slider { axis, .. } => axis[mirror].abs() <= 1e-12,
            JointKind::Planar { axis, .. } => axis[mirror].abs() >= 1.0 - 1e-12,
            JointKind::Weld => true,
            JointKind::Hinge { .. } | JointKind::Ball { .. } | JointKind::Spring { .. } => false,
        };
        self.joints.iter().any(|joint| joint.body == body && joint.to.is_none() && stays(joint))
    }
}

impl JointKind {
    /// Its name in reports.
    pub fn name(&self) -> &'static str {
        match self {
            JointKind::Hinge { .. } => "hinge",
            JointKind::Slider { .. } => "slider",
            JointKind::Planar { .. } => "planar",
            JointKind::Ball { .. } => "ball",
            JointKind::Weld => "weld",
            JointKind::Spring { .. } => "spring",
        }
    }
}
