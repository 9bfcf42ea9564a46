//! Rigid bodies as those on grids of their own meet them. Of a step's start are their places; their velocities are
//! those that they have by then.

use crate::body::Body;
use crate::geometry::{Bounds, MirroredShape, SignedDistance};
use crate::rigid::{Pose, RigidMotion};
use crate::tensor::Vector;
use stickslip_reference::contact::{Obstacle, PeriodLengths};

/// A rigid body, where it is when a step begins.
pub(super) struct RigidBody<'a> {
    body: usize,
    whole: &'a MirroredShape,
    motion: &'a RigidMotion,
    pose: Pose,
    bounds: [[f64; 3]; 2],
    images: Images,
}

/// Where images of a rigid body are between periodic faces.
struct Images {
    /// After which length there is one along each axis; 0 where there is none, or the body has no end [m].
    periods: [f64; 3],
    /// The body's middle, and how far from there its surface is at most [m].
    middle: [f64; 3],
    reach: f64,
}

impl<'a> RigidBody<'a> {
    /// That of a body; none of one that deforms.
    pub fn new<T, const D: usize>(
        body: usize,
        of: &'a Body<T, D>,
        lengths: PeriodLengths<D>,
    ) -> Option<Self> {
        let motion = of.motion.as_deref()?;
        let pose = motion.pose();
        let everywhere = [[f64::NEG_INFINITY; 3], [f64::INFINITY; 3]];
        let bounds = of.whole.bounds().filter(Bounds::is_finite).map_or(everywhere, |bounds| {
            let turned = Bounds::around(bounds.corners().map(|corner| pose.now(corner)));
            [turned.min, turned.max]
        });
        let images = Images::new(&of.whole, &pose, lengths);
        Some(RigidBody { body, whole: &of.whole, motion, pose, bounds, images })
    }
}

impl Images {
    fn new<const D: usize>(whole: &MirroredShape, pose: &Pose, lengths: PeriodLengths<D>) -> Self {
        let bounds = whole.bounds_of_one().filter(|_| lengths.any());
        let Some(bounds) = bounds else {
            return Images { periods: [0.0; 3], middle: [0.0; 3], reach: f64::INFINITY };
        };
        let ends = |k: usize| (bounds.max[k] - bounds.min[k]).is_finite();
        let middle = [0, 1, 2].map(|k| if ends(k) { bounds.middle()[k] } else { 0.0 });
        let has_images = |k: usize| k < D && ends(k) && !whole.is_joined(k);
        Images {
            periods: [0, 1, 2].map(|k| if has_images(k) { lengths.0[k] } else { 0.0 }),
            middle: pose.now(middle),
            reach: 0.5 * Vector([0, 1, 2].map(|k| bounds.max[k] - bounds.min[k])).norm(),
        }
    }

    /// From the body to those images of it that may be nearest to a place [m], the likeliest first, with how far the
    /// place is from each at least [m].
    fn ways(&self, place: [f64; 3]) -> impl Iterator<Item = (f64, [f64; 3])> {
        let off = move |k: usize| place[k] - self.middle[k];
        let steps = (0..27).map(|n| [n % 3, n / 3 % 3, n / 9].map(|n: usize| [0.0, -1.0, 1.0][n]));
        let is_one = |steps: &[f64; 3]| (0..3).all(|k| self.periods[k] > 0.0 || steps[k] == 0.0);
        steps.filter(is_one).map(move |steps| {
            let ends = (0..3).filter(|&k| self.periods[k] > 0.0);
            let (mut away, mut least) = ([0.0; 3], f64::NEG_INFINITY);
            for k in ends {
                away[k] = self.periods[k] * ((off(k) / self.periods[k]).round() + steps[k]);
                least = least.max((off(k) - away[k]).abs() - self.reach);
            }
            (least, away)
        })
    }
}

impl Obstacle for RigidBody<'_> {
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

    fn nearest(&self, place: [f64; 3]) -> (SignedDistance, [f64; 3]) {
        let mut found: Option<(SignedDistance, [f64; 3])> = None;
        for (least, away) in self.images.ways(place) {
            if found.is_some_and(|(level, _)| least >= level.distance) {
                continue;
            }
            let level = self.level([0, 1, 2].map(|k| place[k] - away[k]));
            if found.is_none_or(|(nearest, _)| level.distance < nearest.distance) {
                found = Some((level, away));
            }
        }
        found.expect("there is an image")
    }

    fn has_energy(&self) -> bool {
        self.motion.as_free().is_some()
    }
}
