//! An ellipsoid with axes along those of space.

use super::{Curved, Solid, length_fault, point_fault};
use crate::geometry::Bounds;
use crate::geometry::distance::SignedDistance;
use crate::tensor::Vector;
use serde::Serialize;
use std::f64::consts::PI;

/// An ellipsoid; in the plane an ellipse.
///
/// ```text
/// sum of (y_i / e_i)^2 <= 1;   the nearest point x of its surface to y has x_i = e_i^2 y_i / (t + e_i^2),
/// with the largest root of F(t) = sum of (e_i y_i / (t + e_i^2))^2 - 1
/// ```
/// Eberly (2013), Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid, sections 2 and 3. F falls and
/// is convex, so Newton's steps from a point left of the root go up to it and pass it only by round-off. Exact to that.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ellipsoid {
    /// Centre [m].
    pub center: [f64; 3],
    /// Half of its extent along each axis [m].
    pub semi_axes: [f64; 3],
}

/// Coordinates below this share of the smallest semi-axis are on the plane across it.
const ON_PLANE: f64 = 1e-14;

/// Steps of Newton's method that are enough from any start.
const STEPS: usize = 200;

/// The point nearest to y >= 0 on an ellipsoid of semi-axes e in falling order.
fn nearest(e: &[f64], y: &[f64]) -> [f64; 3] {
    let mut x = [0.0; 3];
    for last in (0..e.len()).rev() {
        let (e, y) = (&e[..=last], &y[..=last]);
        if y[last] > ON_PLANE * e[last] {
            let s = root(e, y);
            for i in 0..=last {
                x[i] = e[i] * e[i] * y[i] / (s + (e[i] * e[i] - e[last] * e[last]));
            }
            return x;
        }
        // On the plane across the shortest axis: the nearest point is off it, where there is one, at t = -e_last^2.
        let share = |i: usize| match (y[i] > 0.0, e[i] * e[i] - e[last] * e[last]) {
            (false, _) => 0.0,
            (true, squares) => e[i] * y[i] / squares,
        };
        let rest = 1.0 - (0..last).map(|i| share(i).powi(2)).sum::<f64>();
        if rest > 0.0 {
            (0..last).for_each(|i| x[i] = e[i] * share(i));
            x[last] = e[last] * rest.sqrt();
            return x;
        }
    }
    x
}

/// The largest root of F, as s = t + e_last^2: what is left of t near the poles keeps its digits.
fn root(e: &[f64], y: &[f64]) -> f64 {
    let last = e[e.len() - 1];
    let below = |e: f64| e * e - last * last;
    let mut s = e.iter().zip(y).map(|(&e, y)| e * y - below(e)).fold(f64::NEG_INFINITY, f64::max);
    for _ in 0..STEPS {
        let (mut value, mut slope) = (-1.0, 0.0);
        for (&e, y) in e.iter().zip(y) {
            let part = e * y / (s + below(e));
            value += part * part;
            slope -= 2.0 * part * part / (s + below(e));
        }
        let next = s - value / slope;
        if value <= 0.0 || next <= s {
            break;
        }
        s = next;
    }
    s
}

impl Solid for Ellipsoid {
    fn level(&self, point: [f64; 3], dimension: usize) -> SignedDistance {
        let mut order = [0, 1, 2];
        order[..dimension].sort_by(|&i, &j| self.semi_axes[j].total_cmp(&self.semi_axes[i]));
        let arm: [f64; 3] = std::array::from_fn(|k| point[k] - self.center[k]);
        let e: [f64; 3] = std::array::from_fn(|i| self.semi_axes[order[i]]);
        let y: [f64; 3] = std::array::from_fn(|i| arm[order[i]].abs());
        let x = nearest(&e[..dimension], &y[..dimension]);
        let (mut squared, mut inside, mut normal) = (0.0, -1.0, Vector([0.0; 3]));
        for i in 0..dimension {
            squared += (y[i] - x[i]).powi(2);
            inside += (y[i] / e[i]).powi(2);
            normal[order[i]] = (x[i] / (e[i] * e[i])).copysign(arm[order[i]]);
        }
        let distance: f64 = squared.sqrt();
        let gradient = normal.direction().map_or([0.0; 3], |normal| normal.0);
        SignedDistance { distance: if inside < 0.0 { -distance } else { distance }, gradient }
    }

    fn bounds(&self, _: usize) -> Bounds {
        let [min, max] = [-1.0, 1.0].map(|s| std::array::from_fn(|k| self.center[k] + s * self.semi_axes[k]));
        Bounds { min, max }
    }

    fn volume(&self, dimension: usize) -> Option<f64> {
        let [a, b, c] = self.semi_axes;
        Some(if dimension == 2 { PI * a * b } else { 4.0 / 3.0 * PI * a * b * c })
    }

    fn copied(&self, factor: f64, place: &dyn Fn([f64; 3]) -> [f64; 3]) -> Curved {
        let semi_axes = self.semi_axes.map(|a| factor * a);
        Curved::Ellipsoid(Ellipsoid { center: place(self.center), semi_axes })
    }

    fn fault(&self, dimension: usize) -> Option<(&'static str, String, &'static str)> {
        point_fault("center", &self.center)
            .or_else(|| self.semi_axes[..dimension].iter().find_map(|&a| length_fault("semi_axes", a)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(semi_axes: [f64; 3], point: [f64; 3]) -> SignedDistance {
        Ellipsoid { center: [0.0; 3], semi_axes }.level(point, 3)
    }

    /// On the axes, at the centre, and on the plane where the nearest point is off it.
    #[test]
    fn on_planes_of_symmetry_it_is_as_far_as_known() {
        let axes = [3.0, 1.0, 2.0];
        for (point, distance) in [
            ([5.0, 0.0, 0.0], 2.0),
            ([0.0, -4.0, 0.0], 3.0),
            ([0.0, 0.0, 2.5], 0.5),
            ([0.0, 0.0, 0.0], -1.0),
            // Nearest: x = 3 s, y = sqrt(1 - s^2) with s = 3 x / 8.
            ([1.0, 0.0, 0.0], -(0.125f64.powi(2) + 1.0 - (3.0f64 / 8.0).powi(2)).sqrt()),
        ] {
            assert!((level(axes, point).distance - distance).abs() < 1e-14, "{point:?}");
        }
    }

    /// Equal axes make it a ball; thin ones keep their digits.
    #[test]
    fn balls_and_needles() {
        for point in [[0.3, -0.2, 0.5], [2.0, 1.0, -3.0], [1e-9, 0.0, 0.0]] {
            let exact = Vector(point).norm() - 1.5;
            assert!((level([1.5; 3], point).distance - exact).abs() < 1e-14, "{point:?}");
        }
        let needle = level([1.0, 1e-4, 1e-4], [0.5, 0.3, 0.0]);
        assert!((needle.distance - (0.3 - 1e-4 * 0.75f64.sqrt())).abs() < 1e-7, "{needle:?}");
        assert!((needle.gradient[1] - 1.0).abs() < 1e-6);
    }
}
