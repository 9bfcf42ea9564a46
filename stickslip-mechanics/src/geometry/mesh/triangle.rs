//! The point of a triangle nearest to another point.

use crate::tensor::Vector;

/// What part of a triangle a point lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// A corner, by its number.
    Corner(usize),
    /// The edge from this corner to the next.
    Edge(usize),
    /// Between them.
    Face,
}

/// The point of a triangle nearest to `point` [m] (Ericson 2005, Real-Time Collision Detection, section 5.1.5).
pub fn closest([a, b, c]: [[f64; 3]; 3], point: [f64; 3]) -> ([f64; 3], Feature) {
    let [a, b, c, p] = [a, b, c, point].map(Vector);
    let (ab, ac) = (b - a, c - a);
    let (from_a, from_b, from_c) = (p - a, p - b, p - c);
    let (d1, d2) = (ab.dot(from_a), ac.dot(from_a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a.0, Feature::Corner(0));
    }
    let (d3, d4) = (ab.dot(from_b), ac.dot(from_b));
    if d3 >= 0.0 && d4 <= d3 {
        return (b.0, Feature::Corner(1));
    }
    let beyond_ab = d1 * d4 - d3 * d2;
    if beyond_ab <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return ((a + ab * (d1 / (d1 - d3))).0, Feature::Edge(0));
    }
    let (d5, d6) = (ab.dot(from_c), ac.dot(from_c));
    if d6 >= 0.0 && d5 <= d6 {
        return (c.0, Feature::Corner(2));
    }
    let beyond_ca = d5 * d2 - d1 * d6;
    if beyond_ca <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return ((a + ac * (d2 / (d2 - d6))).0, Feature::Edge(2));
    }
    let beyond_bc = d3 * d6 - d5 * d4;
    if beyond_bc <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let along = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return ((b + (c - b) * along).0, Feature::Edge(1));
    }
    let share = 1.0 / (beyond_bc + beyond_ca + beyond_ab);
    ((a + ab * (beyond_ca * share) + ac * (beyond_ab * share)).0, Feature::Face)
}
