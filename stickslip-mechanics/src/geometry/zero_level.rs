//! The surface of a shape of which only its distances are known, in pieces.

use super::{Bounds, SignedDistance, SurfacePoint};
use crate::tensor::{Vector, cross};

/// Orders of the axes: each leads from the lower to the upper corner of a cell along its edges, through the corners of
/// a triangle in the plane and of a tetrahedron in space; all of them fill the cell (Kuhn 1960).
const WAYS: [&[[usize; 3]]; 2] =
    [&[[0, 1, 2], [1, 0, 2]], &[[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]]];

/// A piece of a surface between points: a line in the plane, a triangle in space; seen from outside, its points go
/// round counterclockwise. In the plane the third is not used, and outside is to the right of the way to the second.
pub(super) type Facet = [[f64; 3]; 3];

/// Values at the corners of the cells of a lattice.
pub(super) struct Corners<'a> {
    /// The first corner [m].
    pub origin: [f64; 3],
    /// Between corners [m].
    pub spacing: f64,
    /// Corners along each axis; in the plane one along z.
    pub counts: [usize; 3],
    /// By x, then y, then z; negative inside, and never zero.
    pub values: &'a [f64],
}

impl Corners<'_> {
    fn number(&self, index: [usize; 3]) -> usize {
        (index[0] * self.counts[1] + index[1]) * self.counts[2] + index[2]
    }

    fn place(&self, index: [usize; 3]) -> [f64; 3] {
        std::array::from_fn(|k| self.origin[k] + self.spacing * index[k] as f64)
    }

    /// Where the line between two corners crosses the surface: the same point, whichever is first.
    fn crossing(&self, a: [usize; 3], b: [usize; 3]) -> [f64; 3] {
        let (a, b) = if a <= b { (a, b) } else { (b, a) };
        let [from, to] = [a, b].map(|corner| self.values[self.number(corner)]);
        let part = from / (from - to);
        let [from, to] = [a, b].map(|corner| self.place(corner));
        std::array::from_fn(|k| from[k] + part * (to[k] - from[k]))
    }

    /// The facets of the surface in each cell that it crosses: marching tetrahedra (Doi and Koide 1991).
    pub fn each_cell(&self, dimension: usize, mut found: impl FnMut(&[Facet])) {
        let cells = self.counts.map(|count| count.saturating_sub(1));
        let mut facets = Vec::new();
        for i in 0..cells[0] {
            for j in 0..cells[1] {
                for k in 0..if dimension == 2 { 1 } else { cells[2] } {
                    facets.clear();
                    self.cross_cell([i, j, k], dimension, &mut facets);
                    if !facets.is_empty() {
                        found(&facets);
                    }
                }
            }
        }
    }

    fn cross_cell(&self, lower: [usize; 3], dimension: usize, facets: &mut Vec<Facet>) {
        let is_inside = |corner: [usize; 3]| self.values[self.number(corner)] < 0.0;
        let corners = (0..1_usize << dimension).map(|i| std::array::from_fn(|k| lower[k] + (i >> k & 1)));
        let inside = corners.filter(|&corner| is_inside(corner)).count();
        if inside == 0 || inside == 1 << dimension {
            return;
        }
        for way in WAYS[dimension - 2] {
            let mut corner = lower;
            let (mut within, mut beyond) = (Vec::with_capacity(4), Vec::with_capacity(4));
            let mut put = |corner| if is_inside(corner) { within.push(corner) } else { beyond.push(corner) };
            put(corner);
            for &axis in &way[..dimension] {
                corner[axis] += 1;
                put(corner);
            }
            if within.is_empty() || beyond.is_empty() {
                continue;
            }
            let out = Vector(self.mean(&beyond)) - Vector(self.mean(&within));
            let rim: Vec<_> = match (within.len(), beyond.len()) {
                (2, 2) => {
                    let [(a, c), (b, d)] = [(within[0], beyond[0]), (within[1], beyond[1])];
                    [(a, c), (a, d), (b, d), (b, c)].map(|(x, y)| self.crossing(x, y)).to_vec()
                }
                (1, _) => beyond.iter().map(|&corner| self.crossing(within[0], corner)).collect(),
                _ => within.iter().map(|&corner| self.crossing(corner, beyond[0])).collect(),
            };
            let faced = |facet: Facet| {
                if out.dot(Vector(area(&facet, dimension))) < 0.0 { turned(facet, dimension) } else { facet }
            };
            facets.push(faced([rim[0], rim[1], rim[if dimension == 2 { 1 } else { 2 }]]));
            if rim.len() == 4 {
                facets.push(faced([rim[0], rim[2], rim[3]]));
            }
        }
    }

    fn mean(&self, corners: &[[usize; 3]]) -> [f64; 3] {
        let sum = corners.iter().fold(Vector([0.0; 3]), |sum, &corner| sum + Vector(self.place(corner)));
        (sum / corners.len() as f64).0
    }
}

/// Seen from the other side.
fn turned([a, b, c]: Facet, dimension: usize) -> Facet {
    if dimension == 2 { [b, a, a] } else { [a, c, b] }
}

/// Area times the normal [m^2], in the plane length times it [m].
fn area([a, b, c]: &Facet, dimension: usize) -> [f64; 3] {
    let first = Vector(*b) - Vector(*a);
    if dimension == 2 {
        return [first[1], -first[0], 0.0];
    }
    (Vector(cross(first.0, (Vector(*c) - Vector(*a)).0)) * 0.5).0
}

/// Pieces of a surface in the cells of a lattice of `spacing` about its bounds, one for each cell that it crosses.
///
/// The corners of facets are moved onto the surface, so that areas lack its curvature to the second order in the
/// spacing. The pieces close the surface: their areas times their normals add up to nothing.
pub(super) fn pieces(
    level: &dyn Fn([f64; 3]) -> SignedDistance,
    bounds: &Bounds,
    spacing: f64,
    dimension: usize,
) -> Vec<SurfacePoint> {
    if bounds.is_empty() || !bounds.is_finite() {
        return Vec::new();
    }
    // Symmetric about the middle, a cell beyond each side; in two halves of a turn the same.
    let (size, middle) = (bounds.size(), bounds.middle());
    let counts: [usize; 3] =
        std::array::from_fn(|k| if k < dimension { (size[k] / spacing).ceil() as usize + 3 } else { 1 });
    let origin: [f64; 3] = std::array::from_fn(|k| middle[k] - 0.5 * spacing * (counts[k] - 1) as f64);
    let mut values = Vec::with_capacity(counts.iter().product());
    for i in 0..counts[0] {
        for j in 0..counts[1] {
            for k in 0..counts[2] {
                let index = [i, j, k];
                let at = std::array::from_fn(|axis| origin[axis] + spacing * index[axis] as f64);
                let distance = level(at).distance;
                values.push(if distance.abs() < TIE * spacing { TIE * spacing } else { distance });
            }
        }
    }
    let onto = |x: [f64; 3]| {
        let SignedDistance { distance, gradient } = level(x);
        std::array::from_fn(|k| x[k] - distance * gradient[k])
    };
    let mut points = Vec::new();
    Corners { origin, spacing, counts, values: &values }.each_cell(dimension, |facets| {
        let (mut whole, mut center, mut weight) = (Vector([0.0; 3]), Vector([0.0; 3]), 0.0);
        for facet in facets {
            let facet = facet.map(onto);
            let area = Vector(area(&facet, dimension));
            let share = area.norm() / dimension as f64;
            let corners = facet[..dimension].iter().fold(Vector([0.0; 3]), |sum, &x| sum + Vector(x));
            (whole, center, weight) = (whole + area, center + corners * share, weight + share);
        }
        if let Some(normal) = whole.direction() {
            let position = onto((center / (weight * dimension as f64)).0);
            points.push(SurfacePoint { position, normal: normal.0, area: whole.norm() });
        }
    });
    points
}

/// Corners this near to the surface, over the spacing, count as outside.
const TIE: f64 = 1e-9;
