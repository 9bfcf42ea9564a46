//! Half-spaces at rest in space: drawn as slabs with clean edges, which reach as far as the scene does.

use super::camera::{Camera, Point, unit};
use super::setting::Floor;
use stickslip::tensor::Vector;

/// The half-spaces of a picture, cut off by a box.
pub struct Slabs {
    /// Those whose surface can be seen: one that turns its back to the eye would hide what is in front of it.
    floors: Vec<Floor>,
    /// Lower and upper corner [m].
    cut: [Point; 2],
}

/// Slabs as a camera sees them.
pub struct SlabsInView {
    slabs: Vec<(u32, Vec<Side>)>,
}

/// A plane that bounds a slab, as lines of sight cross it.
struct Side {
    outward: Point,
    /// How fast a line of sight towards the eye leaves the slab through it: from inside to outside where positive.
    slope: f64,
    /// Where it crosses, as depth c[0] x + c[1] y + c[2] of a pixel; of a plane along the view how far outside it is.
    crossing: [f64; 3],
}

/// What a line of sight meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlabHit {
    /// Towards the eye [m].
    pub depth: f64,
    /// Outward, unit length.
    pub normal: Point,
    /// Index of the body.
    pub body: u32,
    /// Tells faces apart.
    face: usize,
}

/// How far slabs reach beyond the scene, and how thick they are at least, over its diagonal.
const MARGIN: f64 = 0.04;

impl Slabs {
    /// The half-spaces that face a camera, as far as a box around the scene reaches and a little beyond.
    pub fn new(floors: &[Floor], camera: &Camera, [low, high]: [Point; 2]) -> Self {
        let facing = |floor: &&Floor| {
            let normal = Vector(floor.normal).direction();
            normal.is_some_and(|normal| normal.dot(camera.toward) > -1e-9)
        };
        let margin = Vector([MARGIN * (high - low).norm(); 3]);
        Slabs { floors: floors.iter().filter(facing).copied().collect(), cut: [low - margin, high + margin] }
    }

    /// The corners of all slabs.
    pub fn corners(&self) -> Vec<Point> {
        let [low, high] = self.cut;
        let corner =
            |i: usize| Vector::from_fn(|axis| if i >> axis & 1 == 0 { low[axis] } else { high[axis] });
        let mut corners = Vec::new();
        for floor in &self.floors {
            let above = |x: Point| Vector(floor.normal).dot(x - Vector(floor.point));
            for i in 0..8 {
                let (from, height) = (corner(i), above(corner(i)));
                if height < 0.0 {
                    corners.push(from);
                }
                // Edges from here, on which the surface may lie.
                for axis in (0..3).filter(|axis| i >> axis & 1 == 0) {
                    let to = corner(i | 1 << axis);
                    let end = above(to);
                    if (height < 0.0) != (end < 0.0) {
                        corners.push(from + (to - from) * (height / (height - end)));
                    }
                }
            }
        }
        corners
    }

    /// The slabs as a camera sees them.
    pub fn seen(&self, camera: &Camera) -> SlabsInView {
        let [low, high] = self.cut;
        let side = |(outward, point): (Point, Point)| {
            let slope = outward.dot(camera.toward);
            let slope = if slope.abs() < 1e-12 { 0.0 } else { slope };
            // Inside where outward.(x - point) < 0; x = the pixel's place at depth 0 + depth toward.
            let outside = |x: f64, y: f64| outward.dot(camera.unproject([x, y, 0.0]) - point);
            let constant = outside(0.0, 0.0);
            let linear = [outside(1.0, 0.0) - constant, outside(0.0, 1.0) - constant, constant];
            let crossing = if slope == 0.0 { linear } else { linear.map(|term| -term / slope) };
            Side { outward, slope, crossing }
        };
        let slab = |floor: &Floor| {
            let sides = (0..3).flat_map(|axis| [(unit(axis), high), (-unit(axis), low)]);
            let top = Vector(floor.normal).direction().map(|normal| (normal, Vector(floor.point)));
            (floor.body, sides.chain(top).map(side).collect())
        };
        SlabsInView { slabs: self.floors.iter().map(slab).collect() }
    }
}

impl SlabsInView {
    /// What the line of sight through a pixel meets first: it is in a slab between the last plane that it comes in by
    /// and the first that it leaves by.
    pub fn hit(&self, [x, y]: [f64; 2]) -> Option<SlabHit> {
        let mut nearest: Option<SlabHit> = None;
        'slabs: for (number, (body, sides)) in self.slabs.iter().enumerate() {
            let (mut depth, mut back, mut first) = (f64::INFINITY, f64::NEG_INFINITY, 0);
            for (i, Side { slope, crossing: [a, b, c], .. }) in sides.iter().enumerate() {
                let at = a * x + b * y + c;
                if *slope > 0.0 {
                    if at < depth {
                        (depth, first) = (at, i);
                    }
                } else if *slope < 0.0 {
                    back = back.max(at);
                } else if at > 0.0 {
                    continue 'slabs;
                }
            }
            if depth > back && depth.is_finite() && nearest.is_none_or(|nearest| nearest.depth < depth) {
                let normal = sides[first].outward;
                nearest = Some(SlabHit { depth, normal, body: *body, face: 8 * number + first });
            }
        }
        nearest
    }
}

impl SlabHit {
    /// Whether both are on one face of one slab.
    pub fn is_beside(&self, other: Option<SlabHit>) -> bool {
        other.is_some_and(|other| other.face == self.face)
    }
}

#[cfg(test)]
mod tests {
    use super::super::camera::Viewpoint;
    use super::super::setting::Setting;
    use super::*;

    fn floor(normal: [f64; 3]) -> Floor {
        Floor { body: 3, point: [0.0; 3], normal }
    }

    #[test]
    fn a_slab_has_a_top_and_a_front_and_ends() {
        let around = [Vector([-1.0, -1.0, -0.2]), Vector([1.0, 1.0, 1.0])];
        let camera = Camera::new(Viewpoint::Angles(0.0, 30.0), &Setting::default());
        let slabs = Slabs::new(&[floor([0.0, 0.0, 2.0])], &camera, around);
        let camera = camera.fit(slabs.corners(), [0.0, 0.0, 200.0, 100.0]);
        let view = slabs.seen(&camera);
        let seen = |point: [f64; 3]| {
            let [x, y, depth] = camera.project(Vector(point));
            (view.hit([x, y]), depth)
        };
        let (top, depth) = seen([0.3, 0.2, 0.0]);
        let top = top.unwrap();
        assert!((top.depth - depth).abs() < 1e-9 && top.body == 3);
        assert_eq!(top.normal, unit(2));
        let margin = MARGIN * (4.0f64 + 4.0 + 1.44).sqrt();
        let front = seen([0.0, -1.0 - margin, -0.1]).0.unwrap();
        assert_eq!(front.normal, -unit(1));
        assert!(!front.is_beside(Some(top)) && front.is_beside(Some(front)));
        assert_eq!(seen([0.0, 0.0, 1.5]).0, None);
        let edge = slabs.corners().iter().map(|corner| corner[2]).fold(f64::MIN, f64::max);
        assert!(edge.abs() < 1e-12, "nothing stands above the surface");
    }

    #[test]
    fn a_wall_that_turns_its_back_to_the_eye_is_left_out() {
        let around = [Vector([-1.0; 3]), Vector([1.0; 3])];
        let camera = Camera::new(Viewpoint::Angles(0.0, 20.0), &Setting::default());
        let walls = [floor([0.0, 1.0, 0.0]), floor([0.0, -1.0, 0.0])];
        let slabs = Slabs::new(&walls, &camera, around);
        assert_eq!(slabs.floors, [walls[1]], "the eye stands on the negative side of y");
    }
}
