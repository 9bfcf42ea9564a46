//! Smooth curves through points, as polygons.

use std::collections::VecDeque;

/// How far a polygon may be from its curve, over the size of the box around the points.
const TOLERANCE: f64 = 1e-5;

/// Sides for a span between two points at most.
const MOST_PARTS: f64 = 1000.0;

/// The closed curve through points as a polygon, whose sides are nowhere further from it than 1e-5 of the size of the
/// box around the points.
///
/// ```text
/// x(u) = a x_i + b x_(i+1) + ((a^3 - a) M_i + (b^3 - b) M_(i+1)) l^2 / 6,   a = 1 - b,   b = (u - u_i) / l
/// ```
/// The periodic cubic spline over the lengths l of the chords, with continuous curvature: M are its second derivatives;
/// de Boor (1978), A Practical Guide to Splines, chapter IV. Sides come as many to each span as the largest of its
/// second derivatives asks for: a chord over h is off by h^2 M / 8 at most.
pub fn closed<const N: usize>(points: &[[f64; N]]) -> Vec<[f64; N]> {
    let count = points.len();
    let lengths: Vec<f64> = (0..count).map(|i| length(points[i], points[(i + 1) % count])).collect();
    let bends = std::array::from_fn(|k| second_derivatives(&lengths, |i| points[i][k]));
    polygon(points, &lengths, &bends)
}

/// The curve from the first of some points through the others to the last, as [`closed`]; at its ends it is straight
/// (the natural spline). At least two points, no two in a row the same.
pub fn open<const N: usize>(points: &[[f64; N]]) -> Vec<[f64; N]> {
    let spans = points.len() - 1;
    let lengths: Vec<f64> = (0..spans).map(|i| length(points[i], points[i + 1])).collect();
    let bends = std::array::from_fn(|k| {
        let slope = |i: usize| (points[i + 1][k] - points[i][k]) / lengths[i];
        let inner = 1..spans;
        let diagonal: Vec<f64> = inner.clone().map(|i| 2.0 * (lengths[i - 1] + lengths[i])).collect();
        let right: Vec<f64> = inner.map(|i| 6.0 * (slope(i) - slope(i - 1))).collect();
        let inside = tridiagonal(&diagonal, lengths.get(1..).unwrap_or_default(), &right);
        [0.0].into_iter().chain(inside).chain([0.0]).collect()
    });
    let mut polygon = polygon(points, &lengths, &bends);
    polygon.push(points[spans]);
    polygon
}

fn length<const N: usize>(from: [f64; N], to: [f64; N]) -> f64 {
    (0..N).map(|k| (to[k] - from[k]).powi(2)).sum::<f64>().sqrt()
}

/// Points on the spans of a curve with these second derivatives at its points; of each span the first, and not the
/// last.
fn polygon<const N: usize>(points: &[[f64; N]], lengths: &[f64], bends: &[Vec<f64>; N]) -> Vec<[f64; N]> {
    let next = |i: usize| (i + 1) % points.len();
    let norm = |of: &dyn Fn(usize) -> f64| (0..N).map(of).fold(0.0, f64::hypot);
    let extent = |k: usize| {
        let most = points.iter().map(|point| point[k]).fold(f64::NEG_INFINITY, f64::max);
        most - points.iter().map(|point| point[k]).fold(f64::INFINITY, f64::min)
    };
    let tolerance = TOLERANCE * norm(&extent);
    let mut polygon = Vec::new();
    for i in 0..lengths.len() {
        let bend = |i: usize| norm(&|k| bends[k][i]);
        let most = bend(i).max(bend(next(i)));
        let parts = (lengths[i] * (most / (8.0 * tolerance)).sqrt()).ceil().clamp(1.0, MOST_PARTS) as usize;
        for part in 0..parts {
            let b = part as f64 / parts as f64;
            let a = 1.0 - b;
            polygon.push(std::array::from_fn(|k| {
                let cubic = (a * a * a - a) * bends[k][i] + (b * b * b - b) * bends[k][next(i)];
                a * points[i][k] + b * points[next(i)][k] + cubic * lengths[i] * lengths[i] / 6.0
            }));
        }
    }
    polygon
}

/// The outline of what a curve from the axis back to it sweeps around that: through points of which the first and the
/// last are on the axis, and which it leaves at right angles. The first coordinate is the distance from the axis.
pub fn from_axis_to_axis(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let image = points[1..points.len() - 1].iter().rev().map(|&[rho, z]| [-rho, z]);
    let whole: Vec<_> = points.iter().copied().chain(image).collect();
    let mut polygon = VecDeque::from(closed(&whole));
    // The image is the half of the curve behind the point that is last on the axis.
    let last = points[points.len() - 1];
    while polygon.back().is_some_and(|&point| point != last) {
        polygon.pop_back();
    }
    polygon.into()
}

/// Second derivatives at the points of the periodic cubic spline.
///
/// l_(i-1) M_(i-1) + 2 (l_(i-1) + l_i) M_i + l_i M_(i+1) = 6 ((x_(i+1) - x_i) / l_i - (x_i - x_(i-1)) / l_(i-1)), all
/// round: a tridiagonal system with corners, by the Sherman-Morrison formula.
fn second_derivatives(lengths: &[f64], x: impl Fn(usize) -> f64) -> Vec<f64> {
    let count = lengths.len();
    let before = |i: usize| (i + count - 1) % count;
    let slope = |i: usize| (x((i + 1) % count) - x(i)) / lengths[i];
    let right: Vec<f64> = (0..count).map(|i| 6.0 * (slope(i) - slope(before(i)))).collect();
    let mut diagonal: Vec<f64> = (0..count).map(|i| 2.0 * (lengths[before(i)] + lengths[i])).collect();
    // A = T + u v' with u = (g, 0, ..., c), v = (1, 0, ..., c / g): the corners are c.
    let (corner, shift) = (lengths[count - 1], -diagonal[0]);
    diagonal[0] -= shift;
    diagonal[count - 1] -= corner * corner / shift;
    let mut u = vec![0.0; count];
    (u[0], u[count - 1]) = (shift, corner);
    let [y, z] = [&right, &u].map(|right| tridiagonal(&diagonal, lengths, right));
    let of = |w: &[f64]| w[0] + corner / shift * w[count - 1];
    let factor = of(&y) / (1.0 + of(&z));
    y.iter().zip(&z).map(|(y, z)| y - factor * z).collect()
}

/// Solves a symmetric tridiagonal system: `beside[i]` is between rows i and i + 1. Its diagonal outweighs its rows.
fn tridiagonal(diagonal: &[f64], beside: &[f64], right: &[f64]) -> Vec<f64> {
    let count = diagonal.len();
    let (mut pivots, mut x) = (diagonal.to_vec(), right.to_vec());
    for i in 1..count {
        let factor = beside[i - 1] / pivots[i - 1];
        pivots[i] -= factor * beside[i - 1];
        x[i] -= factor * x[i - 1];
    }
    for i in (0..count).rev() {
        let above = if i + 1 < count { beside[i] * x[i + 1] } else { 0.0 };
        x[i] = (x[i] - above) / pivots[i];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon;
    use crate::tensor::Vector;
    use std::f64::consts::{PI, TAU};

    fn around(count: usize) -> Vec<[f64; 2]> {
        (0..count).map(|i| TAU * i as f64 / count as f64).map(|a| [2.0 + a.cos(), a.sin()]).collect()
    }

    /// The curve through points of a circle comes nearer to it with the fourth power of their distance.
    #[test]
    fn points_of_a_circle_make_a_circle() {
        let off = |count| {
            let from_center = |[x, y]: [f64; 2]| ((x - 2.0).hypot(y) - 1.0).abs();
            closed(&around(count)).into_iter().map(from_center).fold(0.0, f64::max)
        };
        let [coarse, fine] = [off(8), off(16)];
        assert!(coarse < 2e-3 && (12.0..24.0).contains(&(coarse / fine)), "{coarse} {fine}");
        let polygon = closed(&around(32));
        assert!(
            (polygon::area(&polygon) / PI - 1.0).abs() < 5e-5 && polygon.len() < 800,
            "{}",
            polygon.len()
        );
    }

    /// Its points are corners, and from side to side it turns by little, also where points are first and last.
    #[test]
    fn it_goes_through_its_points_and_has_no_corner() {
        let points = [[0.0, 0.0], [2.0, 0.3], [2.5, 1.5], [1.0, 1.0], [-0.5, 2.0]];
        let curve = closed(&points);
        assert!(points.iter().all(|point| curve.contains(point)));
        let way = |i: usize| {
            let [a, b] = [curve[i % curve.len()], curve[(i + 1) % curve.len()]];
            (b[1] - a[1]).atan2(b[0] - a[0])
        };
        for i in 0..curve.len() {
            let turn = (way(i + 1) - way(i) + 3.0 * PI).rem_euclid(TAU) - PI;
            // Sides of a circle of radius r that are off it by s turn by sqrt(8 s / r); here r is 0.05 or more.
            assert!(turn.abs() < 0.08, "{i}: {turn}");
        }
    }

    /// From end to end, in space, and straight where there are two points.
    #[test]
    fn an_open_curve_goes_through_its_points_from_the_first_to_the_last() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.5, 0.2], [2.0, 0.0, 1.0], [2.5, -1.0, 1.5]];
        let curve = open(&points);
        assert!(points.iter().all(|point| curve.contains(point)) && curve.len() > 100);
        assert_eq!((curve[0], curve[curve.len() - 1]), (points[0], points[3]));
        let way = |i: usize| Vector(curve[i + 1]) - Vector(curve[i]);
        for i in 0..curve.len() - 2 {
            let [one, next] = [way(i), way(i + 1)].map(|way| way / way.norm());
            assert!((one - next).norm() < 0.05, "{i}");
        }
        assert_eq!(open(&points[..2]), points[..2]);
    }

    /// Half a circle upon the axis sweeps a ball, round at its poles.
    #[test]
    fn a_curve_from_the_axis_to_the_axis_is_round_there() {
        let half: Vec<_> =
            (0..=8).map(|i| PI * f64::from(i) / 8.0).map(|a| [a.sin().max(0.0), -a.cos()]).collect();
        let half: Vec<_> =
            half.into_iter().map(|[rho, z]| [if rho < 1e-12 { 0.0 } else { rho }, z]).collect();
        let outline = from_axis_to_axis(&half);
        assert!(outline.iter().all(|point| point[0] >= 0.0 && (point[0].hypot(point[1]) - 1.0).abs() < 2e-4));
        assert_eq!((outline[0], outline[outline.len() - 1]), (half[0], half[8]));
        let [rho, z] = outline[1];
        assert!((z + 1.0) < 0.6 * rho * rho, "{rho} {z}");
    }
}
