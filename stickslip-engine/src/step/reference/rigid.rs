//! Rigid bodies as those on grids of their own meet them.

use crate::body::Body;
use crate::geometry::{Bounds, MirroredShape, SignedDistance};
use crate::rigid::{Pose, RigidMotion};
use stickslip_reference::contact::Rigid;

/// A rigid body of prescribed motion, where it is.
pub(super) struct RigidBody<'a> {
    body: usize,
    whole: &'a MirroredShape,
    motion: &'a RigidMotion,
    pose: Pose,
    bounds: [[f64; 3]; 2],
}

impl<'a> RigidBody<'a> {
    /// That of a body; none of one that deforms or is free.
    pub fn new<T, const D: usize>(body: usize, of: &'a Body<T, D>) -> Option<Self> {
        let motion = of.motion.as_deref().filter(|motion| motion.as_free().is_none())?;
        let pose = motion.pose();
        let everywhere = [[f64::NEG_INFINITY; 3], [f64::INFINITY; 3]];
        let bounds = of.whole.bounds().filter(Bounds::is_finite).map_or(everywhere, |bounds| {
            let turned = Bounds::around(bounds.corners().map(|corner| pose.now(corner)));
            [turned.min, turned.max]
        });
        Some(RigidBody { body, whole: &of.whole, motion, pose, bounds })
    }
}

impl Rigid for RigidBody<'_> {
    fn body(&self) -> usize {
        self.body
    }

    fn level(&self, place: [f64; 3]) -> SignedDistance {
        let level = self.whole.level(self.pose.start(place));
        SignedDistance { gradient: self.pose.turned(level.gradient), ..level }
    }

    fn velocity(&self, place: [f64; 3]) -> [f64; 3] {
        self.motion.velocity_at(place)
    }

    fn bounds(&self) -> [[f64; 3]; 2] {
        self.bounds
    }
}
