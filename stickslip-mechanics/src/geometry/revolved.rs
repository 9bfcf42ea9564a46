//! Shapes of revolution: a polygon turned around an axis.

use super::distance::SignedDistance;
use super::mirrored_shape::{Mirror, drawn_out, on};
use super::surface::{frame, middles, turn};
use super::{Bounds, Outline, SurfacePoint, polygon};
use crate::tensor::Vector;
use serde::Serialize;
use std::f64::consts::TAU;

/// What a polygon sweeps that is turned around an axis; three dimensions only.
///
/// ```text
/// d(x) = distance of (rho, z) from those sides of the polygon that are off the axis,
/// rho = |arm - z n|,   z = arm . n,   arm = x - center,   n = axis / |axis|
/// ```
/// Exact.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Revolved {
    /// Corners in order: distance from the axis, not negative, and place along it from the centre [m].
    pub points: Outline,
    /// A point on the axis [m].
    pub center: [f64; 3],
    /// Axis, any length [-].
    pub axis: [f64; 3],
}

/// A side of the polygon that sweeps a surface: one on the axis does not.
fn sweeps(a: [f64; 2], b: [f64; 2]) -> bool {
    a[0] > 0.0 || b[0] > 0.0
}

impl Revolved {
    fn direction(&self) -> Vector<f64, 3> {
        Vector(self.axis).direction().unwrap_or(Vector([0.0, 0.0, 1.0]))
    }

    /// Distance from the axis, place along it, and the way off it.
    fn profile(&self, point: [f64; 3]) -> ([f64; 2], Vector<f64, 3>) {
        let (axis, arm) = (self.direction(), Vector(point) - Vector(self.center));
        let along = arm.dot(axis);
        let across = arm - axis * along;
        ([across.norm(), along], across)
    }

    /// Round surfaces are open, so that the shape keeps its symmetry; of its ends the lower one is in.
    pub(super) fn contains(&self, point: [f64; 3], nudged: [f64; 3], margin: f64) -> bool {
        let ([rho, _], _) = self.profile(point);
        let ([_, along], _) = self.profile(nudged);
        self.points.contains([rho + margin, along])
    }

    pub(super) fn level(&self, point: [f64; 3]) -> SignedDistance {
        let ([rho, along], across) = self.profile(point);
        let (distance, [out, up]) = self.points.distance_to_some([rho, along], sweeps);
        // On the axis no direction off it stands out.
        let off = if rho > 0.0 { across * (out / rho) } else { Vector([0.0; 3]) };
        let gradient = off + self.direction() * up;
        SignedDistance { distance, gradient: gradient.direction().map_or([0.0; 3], |gradient| gradient.0) }
    }

    pub(super) fn bounds(&self) -> Bounds {
        let axis = self.direction();
        // A circle of radius r around n reaches r sqrt(1 - n_k^2) along axis k.
        let circle = |&[rho, along]: &[f64; 2]| {
            let middle = Vector(self.center) + axis * along;
            let reach = axis.0.map(|n| rho * (1.0 - n * n).max(0.0).sqrt());
            Bounds {
                min: std::array::from_fn(|k| middle[k] - reach[k]),
                max: std::array::from_fn(|k| middle[k] + reach[k]),
            }
        };
        self.points.iter().map(circle).fold(Bounds::EMPTY, |all, circle| all.united(&circle))
    }

    /// Pappus's theorem, side by side: V = 2 pi |sum of (a_rho^2 + a_rho b_rho + b_rho^2)(b_z - a_z)| / 6.
    pub(super) fn volume(&self) -> f64 {
        let sides = self.points.iter().zip(self.points.iter().cycle().skip(1));
        let part =
            |(a, b): (&[f64; 2], &[f64; 2])| (a[0] * a[0] + a[0] * b[0] + b[0] * b[0]) * (b[1] - a[1]) / 6.0;
        TAU * sides.map(part).sum::<f64>().abs()
    }

    /// Belts around the axis, each in equal pieces of exactly its area.
    pub(super) fn surface(&self, spacing: f64) -> Vec<SurfacePoint> {
        let axis = self.direction();
        let [first, second] = frame(axis.0).map(Vector);
        let mut points = Vec::new();
        for (a, b, [out, up]) in polygon::sides(&self.points).filter(|&(a, b, _)| sweeps(a, b) && a != b) {
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            let (along, part) = middles([0.0, length], spacing);
            for x in along {
                let [rho, z] = [0, 1].map(|k| a[k] + (b[k] - a[k]) * (x / length));
                let (angles, sector) = turn(spacing / rho);
                for angle in angles {
                    let off = first * libm::cos(angle) + second * libm::sin(angle);
                    points.push(SurfacePoint {
                        position: (Vector(self.center) + axis * z + off * rho).0,
                        normal: (off * out + axis * up).0,
                        area: part * rho * sector,
                    });
                }
            }
        }
        points
    }

    /// Points around the axis of each corner, and the corners on the axis [m].
    pub fn rims(&self, count: usize) -> Vec<[f64; 3]> {
        let axis = self.direction();
        let [first, second] = frame(axis.0).map(Vector);
        let mut points = Vec::new();
        for &[rho, z] in self.points.iter() {
            for i in 0..if rho > 0.0 { count } else { 1 } {
                let angle = TAU * i as f64 / count as f64;
                let off = first * libm::cos(angle) + second * libm::sin(angle);
                points.push((Vector(self.center) + axis * z + off * rho).0);
            }
        }
        points
    }

    pub(super) fn copied(&self, factor: f64, place: impl Fn([f64; 3]) -> [f64; 3]) -> Revolved {
        Revolved {
            points: self.points.iter().map(|point| point.map(|x| factor * x)).collect(),
            center: place(self.center),
            axis: self.axis,
        }
    }

    /// Without flat ends on a mirror across the axis: the shape goes straight on behind it.
    pub(super) fn continued(self, mirror: &Mirror) -> Revolved {
        let along = self.direction()[mirror.axis];
        let level = |&[_, z]: &[f64; 2]| on(mirror, self.center[mirror.axis] + along * z);
        if along.abs() < 1.0 - 1e-12 || !self.points.iter().any(level) {
            return self;
        }
        let position = (mirror.position - self.center[mirror.axis]) * along;
        let across = Mirror { axis: 1, position, inward: mirror.inward * along.signum() };
        Revolved { points: drawn_out(&self.points, &across).into(), ..self }
    }

    /// What is wrong with it: the key, what was found and what is allowed.
    pub fn fault(&self) -> Option<(&'static str, String, &'static str)> {
        let finite = |values: &[f64]| values.iter().all(|x| x.is_finite());
        let before = self.points.iter().find(|point| point[0] < 0.0);
        let direction = finite(&self.axis) && self.axis != [0.0; 3];
        let volume = self.volume();
        if !self.points.iter().all(|point| finite(point)) {
            Some(("points", "a corner that is not finite".to_string(), "finite numbers"))
        } else if let Some([rho, _]) = before {
            Some(("points", format!("a distance of {rho} m from the axis"), "distances from 0 on"))
        } else if self.points.len() < 3 || volume <= 0.0 {
            Some(("points", "no area between the corners".to_string(), "corners round an area"))
        } else if !finite(&self.center) {
            Some(("center", format!("{:?}", self.center), "finite numbers"))
        } else {
            (!direction).then(|| ("axis", format!("{:?}", self.axis), "a vector of some length"))
        }
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::geometry::Shape;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    /// Cones, rings, and what has a groove.
    pub fn any_revolved() -> impl Strategy<Value = Shape> {
        let point = || prop::array::uniform3(-1.0..1.0f64);
        let axis = || prop::array::uniform3(0.1..1.0f64);
        prop_oneof![
            (point(), point(), prop::array::uniform2(0.0..0.9f64))
                .prop_map(|(start, end, radii)| Shape::cone(start, end, radii)),
            (point(), axis(), 0.1..0.6f64, 0.2..1.0f64).prop_map(|(center, axis, inner, width)| Shape::tube(
                center,
                axis,
                ([inner, inner + 0.4], width)
            )),
            (point(), axis()).prop_map(|(center, axis)| {
                let points = vec![[0.0, -0.8], [0.7, -0.5], [0.3, 0.0], [0.8, 0.6], [0.0, 0.2]];
                Shape::revolved(points, center, axis)
            }),
        ]
    }

    #[test]
    fn a_revolved_rectangle_is_a_cylinder() {
        let (start, end) = ([0.1, -0.2, 0.3], [0.5, 0.4, 0.9]);
        let (can, cone) = (Shape::Cylinder { start, end, radius: 0.4 }, Shape::cone(start, end, [0.4, 0.4]));
        for i in 0..200 {
            let at = |k: i32| f64::from((i * k) % 41) / 20.0 - 1.0;
            let point = [at(7), at(11), at(17)];
            let (a, b) = (can.level(point, 3), cone.level(point, 3));
            assert!((a.distance - b.distance).abs() < 1e-12, "{point:?} {a:?} {b:?}");
            assert_eq!(can.contains(point, 3), cone.contains(point, 3));
        }
        assert!((can.volume(3).unwrap() - cone.volume(3).unwrap()).abs() < 1e-14);
        let [a, b] = [&can, &cone].map(|shape| shape.bounds(3).expect("bounded"));
        assert!((0..3).all(|k| (a.min[k] - b.min[k]).abs() < 1e-12 && (a.max[k] - b.max[k]).abs() < 1e-12));
    }

    /// V = pi h (r^2 + r s + s^2) / 3, and the lateral area pi (r + s) sqrt(h^2 + (r - s)^2).
    #[test]
    fn a_truncated_cone_has_its_volume_and_its_surface() {
        let cone = Shape::cone([0.0; 3], [0.0, 0.0, 2.0], [1.0, 0.5]);
        assert!((cone.volume(3).unwrap() - PI * 2.0 * (1.0 + 0.5 + 0.25) / 3.0).abs() < 1e-12);
        let surface: f64 = cone.surface(0.05, 3, &cone.bounds(3).unwrap()).iter().map(|p| p.area).sum();
        let exact = PI * 1.5 * (4.0f64 + 0.25).sqrt() + PI * 1.25;
        assert!((surface / exact - 1.0).abs() < 1e-12, "{surface} {exact}");
        // The tip of a whole cone is as far as it is, and no side on the axis is near.
        let tip = Shape::cone([0.0; 3], [0.0, 0.0, 2.0], [1.0, 0.0]);
        assert_eq!(tip.distance([0.0, 0.0, 3.0], 3), 1.0);
        assert!((tip.distance([0.0, 0.0, 1.0], 3) + 1.0 / 5f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn a_ring_upon_a_mirror_goes_on_behind_it() {
        let mirror = Mirror { axis: 2, position: 0.0, inward: 1.0 };
        for axis in [1.0, -2.0] {
            let half = Shape::tube([0.0, 0.0, 0.25], [0.0, 0.0, axis], ([0.5, 1.0], 0.5));
            let Shape::Revolved(half) = half else { panic!("a ring") };
            let whole = Shape::Revolved(half.continued(&mirror));
            let level = whole.level([0.9, 0.0, 0.01], 3);
            assert!((level.distance + 0.1).abs() < 1e-12 && level.gradient[0] > 0.999, "{level:?}");
        }
    }
}
