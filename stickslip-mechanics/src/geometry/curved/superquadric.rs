//! A superquadric: between ellipsoid, cylinder and box by two exponents.

use super::{Curved, Solid, length_fault, point_fault};
use crate::geometry::Bounds;
use crate::geometry::distance::SignedDistance;
use crate::tensor::{Vector, cross};
use serde::Serialize;

/// A convex superquadric, a superellipsoid; in the plane a superellipse.
///
/// ```text
/// F(x) = ((|x|/a)^m + (|y|/b)^m)^(n/m) + (|z|/c)^n <= 1,   in the plane (|x|/a)^m + (|y|/b)^m <= 1
/// ```
/// Barr (1981), Superquadrics and angle-preserving transformations, with m = 2 / e2 and n = 2 / e1. The exponents m, n
/// are 2 for an ellipsoid; the larger, the nearer to a box. The nearest point of the surface is where the way to it has
/// no part along the surface: Newton's method on the surface, which finds it to round-off from outside. From deep
/// inside, where several places are nearly as near, it is the nearest of those found from four starts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Superquadric {
    /// Centre [m].
    pub center: [f64; 3],
    /// Half of its extent along each axis: a, b and c [m].
    pub semi_axes: [f64; 3],
    /// m of sections across z, and n of sections along it [-], from 2 to [`MOST_EXPONENT`].
    pub exponents: [f64; 2],
}

/// The largest exponent.
pub const MOST_EXPONENT: f64 = 20.0;

/// Steps of Newton's method.
const STEPS: usize = 100;
/// A way along the surface, over the size, that is round-off.
const STILL: f64 = 1e-14;
/// The least curvature of the squared distance along the surface that a step counts with.
const LEAST_CURVATURE: f64 = 0.05;

/// F with its gradient and its second derivatives.
struct Derivatives {
    gradient: Vector<f64, 3>,
    second: [[f64; 3]; 3],
}

impl Superquadric {
    /// F at x >= 0; `flat` leaves out z.
    fn value(&self, x: [f64; 3], dimension: usize) -> f64 {
        let ([a, b, c], [m, n]) = (self.semi_axes, self.exponents);
        let plane = (x[0] / a).powf(m) + (x[1] / b).powf(m);
        if dimension == 2 { plane } else { plane.powf(n / m) + (x[2] / c).powf(n) }
    }

    /// The point of the surface in the direction of x >= 0; F^(1/n) is a norm.
    fn scaled(&self, x: Vector<f64, 3>, dimension: usize) -> Option<Vector<f64, 3>> {
        // To the size of the shape first, so that no power is beyond numbers.
        let size = (0..dimension).map(|k| x[k] / self.semi_axes[k]).fold(0.0, f64::max);
        if size <= 0.0 || !size.is_finite() {
            return None;
        }
        let x = x / size;
        let exponent = self.exponents[dimension - 2];
        Some(x / self.value(x.0, dimension).powf(1.0 / exponent))
    }

    /// At a point x >= 0 of the surface.
    fn derivatives(&self, x: [f64; 3], dimension: usize) -> Derivatives {
        let ([a, b, c], [m, n]) = (self.semi_axes, self.exponents);
        let n = if dimension == 2 { m } else { n };
        let mut gradient = [0.0; 3];
        let mut second = [[0.0; 3]; 3];
        let (u, v) = (x[0] / a, x[1] / b);
        let plane = u.powf(m) + v.powf(m);
        if plane > f64::MIN_POSITIVE {
            let steep = [u.powf(m - 1.0) / a, v.powf(m - 1.0) / b];
            let outer = n * plane.powf(n / m - 1.0);
            let bend = n * (n - m) * plane.powf(n / m - 2.0);
            for i in 0..2 {
                gradient[i] = outer * steep[i];
                for j in 0..2 {
                    // 0 where the power of a small sum is none.
                    let mixed = bend * steep[i] * steep[j];
                    second[i][j] = if mixed.is_finite() { mixed } else { 0.0 };
                }
            }
            second[0][0] += outer * (m - 1.0) * u.powf(m - 2.0) / (a * a);
            second[1][1] += outer * (m - 1.0) * v.powf(m - 2.0) / (b * b);
        }
        if dimension == 3 {
            gradient[2] = n * (x[2] / c).powf(n - 1.0) / c;
            second[2][2] = n * (n - 1.0) * (x[2] / c).powf(n - 2.0) / (c * c);
        }
        Derivatives { gradient: Vector(gradient), second }
    }

    /// From a point x of the surface to one no further from y >= 0, as near as Newton's steps lead.
    fn descend(&self, mut x: Vector<f64, 3>, y: Vector<f64, 3>, dimension: usize) -> Vector<f64, 3> {
        let size = self.semi_axes[..dimension].iter().fold(0.0_f64, |size, &a| size.max(a));
        for _ in 0..STEPS {
            let Derivatives { gradient, second } = self.derivatives(x.0, dimension);
            let Some(normal) = gradient.direction() else { break };
            // Of |y - x|^2 / 2 on the surface: slopes and second derivatives along two tangents.
            let tangents = tangents(normal, dimension);
            let multiplier = (y - x).dot(gradient) / gradient.dot(gradient);
            let slope = tangents.map(|t| (x - y).dot(t));
            let along = |s: Vector<f64, 3>, t: Vector<f64, 3>| -> f64 {
                (0..3)
                    .flat_map(|i| (0..3).map(move |j| (i, j)))
                    .map(|(i, j)| s[i] * second[i][j] * t[j])
                    .sum()
            };
            let [s, t] = tangents;
            let (ss, st, tt) =
                (1.0 + multiplier * along(s, s), multiplier * along(s, t), 1.0 + multiplier * along(t, t));
            let way = downhill([ss, st, tt], slope);
            let step = s * way[0] + t * way[1];
            if step.norm() <= STILL * (size + y.norm()) {
                break;
            }
            // Shorter until it leads nearer; mirrored into the octant, where the same surface is.
            let here = (y - x).dot(y - x);
            let mut share = 1.0;
            let next = loop {
                let there = Vector((x + step * share).0.map(f64::abs));
                let on_surface = self.scaled(there, dimension);
                if let Some(next) = on_surface.filter(|&next| (y - next).dot(y - next) < here) {
                    break Some(next);
                }
                share *= 0.5;
                if share < 1e-6 {
                    break None;
                }
            };
            let Some(next) = next else { break };
            x = next;
        }
        x
    }

    /// The point of the surface nearest to y >= 0.
    fn nearest(&self, y: Vector<f64, 3>, dimension: usize) -> Vector<f64, 3> {
        let inside = self.value(y.0, dimension) < 1.0;
        // Along the way from the centre; from inside also along each axis.
        let lifted = (0..dimension).filter(|_| inside).map(|k| {
            let mut lifted = y;
            lifted[k] = 0.0;
            let rest = (1.0 - self.value(lifted.0, dimension)).max(0.0);
            let whole = if k == 2 || dimension == 2 {
                rest.powf(1.0 / self.exponents[k / 2])
            } else {
                let [m, n] = self.exponents;
                let plane = (1.0 - (y[2] / self.semi_axes[2]).powf(n)).max(0.0).powf(m / n);
                let other = (y[1 - k] / self.semi_axes[1 - k]).powf(m);
                (plane - other).max(0.0).powf(1.0 / m)
            };
            lifted[k] = self.semi_axes[k] * whole;
            lifted
        });
        let starts = std::iter::once(y).chain(lifted).filter_map(|x| self.scaled(x, dimension));
        let found = starts.map(|x| self.descend(x, y, dimension));
        let squared = |x: &Vector<f64, 3>| (y - *x).dot(y - *x);
        found.min_by(|a, b| squared(a).total_cmp(&squared(b))).unwrap_or(y)
    }
}

/// Two directions at right angles to a unit normal and to each other; in the plane the second counts for nothing.
fn tangents(normal: Vector<f64, 3>, dimension: usize) -> [Vector<f64, 3>; 2] {
    if dimension == 2 {
        return [Vector([-normal[1], normal[0], 0.0]), Vector([0.0; 3])];
    }
    let least = (0..3).min_by(|&i, &j| normal[i].abs().total_cmp(&normal[j].abs())).unwrap_or(0);
    let mut other = [0.0; 3];
    other[least] = 1.0;
    let first = Vector(cross(normal.0, other));
    let first = first / first.norm();
    [first, Vector(cross(normal.0, first.0))]
}

/// Newton's step down a slope, with curvatures that are small or negative taken as small and positive.
fn downhill([ss, st, tt]: [f64; 3], slope: [f64; 2]) -> [f64; 2] {
    let (mean, difference) = (0.5 * (ss + tt), 0.5 * (ss - tt));
    let spread = difference.hypot(st);
    // Eigenvectors of the symmetric matrix, at half the angle of (difference, st).
    let angle = 0.5 * libm::atan2(st, difference);
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    let mut way = [0.0; 2];
    for (value, [x, y]) in [(mean + spread, [cosine, sine]), (mean - spread, [-sine, cosine])] {
        let part = -(slope[0] * x + slope[1] * y) / value.abs().max(LEAST_CURVATURE);
        (way[0], way[1]) = (way[0] + part * x, way[1] + part * y);
    }
    way
}

impl Solid for Superquadric {
    fn level(&self, point: [f64; 3], dimension: usize) -> SignedDistance {
        let arm: [f64; 3] =
            std::array::from_fn(|k| if k < dimension { point[k] - self.center[k] } else { 0.0 });
        let mut y = Vector(arm.map(f64::abs));
        if y.0 == [0.0; 3] {
            // As near along the shortest axis to either side; a start from there.
            let shortest = (0..dimension).min_by(|&i, &j| self.semi_axes[i].total_cmp(&self.semi_axes[j]));
            y[shortest.unwrap_or(0)] = f64::MIN_POSITIVE.sqrt();
        }
        let x = self.nearest(y, dimension);
        let length = (y - x).norm();
        // The surface is convex: inside is behind the plane that touches it there.
        let normal = self.derivatives(x.0, dimension).gradient.direction().unwrap_or(Vector([0.0; 3]));
        let distance = length.copysign((y - x).dot(normal));
        SignedDistance { distance, gradient: std::array::from_fn(|k| normal[k].copysign(arm[k])) }
    }

    fn bounds(&self, _: usize) -> Bounds {
        let [min, max] = [-1.0, 1.0].map(|s| std::array::from_fn(|k| self.center[k] + s * self.semi_axes[k]));
        Bounds { min, max }
    }

    /// 2 a b c e1 e2 B(e1 / 2 + 1, e1) B(e2 / 2, e2 / 2), in the plane a b e2 B(e2 / 2, e2 / 2), by the beta function;
    /// Jaklic, Leonardis and Solina (2000), Segmentation and Recovery of Superquadrics, section 2.3.
    fn volume(&self, dimension: usize) -> Option<f64> {
        let beta = |x: f64, y: f64| libm::exp(libm::lgamma(x) + libm::lgamma(y) - libm::lgamma(x + y));
        let ([a, b, c], [m, n]) = (self.semi_axes, self.exponents);
        let (e1, e2) = (2.0 / n, 2.0 / m);
        // 4 a b G(1 + e2/2)^2 / G(1 + e2) = a b e2 B(e2/2, e2/2)
        let section = a * b * e2 * beta(0.5 * e2, 0.5 * e2);
        Some(if dimension == 2 { section } else { 2.0 * c * section * e1 * beta(0.5 * e1 + 1.0, e1) })
    }

    fn copied(&self, factor: f64, place: &dyn Fn([f64; 3]) -> [f64; 3]) -> Curved {
        Curved::Superquadric(Superquadric {
            center: place(self.center),
            semi_axes: self.semi_axes.map(|a| factor * a),
            exponents: self.exponents,
        })
    }

    fn fault(&self, dimension: usize) -> Option<(&'static str, String, &'static str)> {
        let beyond = self.exponents[..dimension - 1].iter().find(|e| !(2.0..=MOST_EXPONENT).contains(*e));
        point_fault("center", &self.center)
            .or_else(|| self.semi_axes[..dimension].iter().find_map(|&a| length_fault("semi_axes", a)))
            .or_else(|| beyond.map(|e| ("exponents", format!("{e}"), "numbers from 2 to 20")))
    }
}

#[cfg(test)]
mod tests {
    use super::super::Ellipsoid;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn with_exponents_of_two_it_is_an_ellipsoid(
            semi_axes in prop::array::uniform3(0.3..1.5f64),
            point in prop::array::uniform3(-2.0..2.0f64),
            dimension in 2..=3usize,
        ) {
            let exact = Ellipsoid { center: [0.1; 3], semi_axes }.level(point, dimension);
            let found = Superquadric { center: [0.1; 3], semi_axes, exponents: [2.0, 2.0] }.level(point, dimension);
            prop_assert!((found.distance - exact.distance).abs() < 1e-11, "{found:?} {exact:?}");
        }
    }

    /// Near its faces, edges and corners a superquadric of large exponents is a box.
    #[test]
    fn with_large_exponents_it_is_nearly_a_box() {
        let solid = Superquadric { center: [0.0; 3], semi_axes: [1.0, 0.6, 0.8], exponents: [20.0, 20.0] };
        for (point, distance) in
            [([2.0, 0.1, 0.2], 1.0), ([0.1, 0.5, -0.1], -0.1), ([0.0; 3], -0.6), ([0.1, 0.0, 0.9], 0.1)]
        {
            let level = solid.level(point, 3);
            assert!((level.distance - distance).abs() < 1e-3, "{point:?} {level:?}");
        }
    }
}
