//! Polygons in the plane.

/// Edges as pairs of corners, the last corner joined to the first.
fn edges(points: &[[f64; 2]]) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
    points.iter().zip(points.iter().cycle().skip(1)).map(|(&a, &b)| (a, b))
}

/// Each edge with its outward unit normal; an edge without length has none to speak of.
pub(super) fn sides(points: &[[f64; 2]]) -> impl Iterator<Item = ([f64; 2], [f64; 2], [f64; 2])> {
    let turn = if is_clockwise(points) { -1.0 } else { 1.0 };
    edges(points).map(move |(a, b)| {
        let [x, y] = [b[0] - a[0], b[1] - a[1]];
        let length = turn * x.hypot(y);
        (a, b, [y / length, -x / length])
    })
}

/// Whether a point is inside by the even-odd rule: a ray to the right crosses the border an odd number of times.
///
/// An edge holds its lower end and not its upper one, and a point on an edge is to the right of it. An edge is always
/// walked upwards, so that two polygons that share it never both hold or both lose a point.
pub(super) fn contains(points: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let mut inside = false;
    for (a, b) in edges(points) {
        inside ^= crosses(a, b, [x, y]);
    }
    inside
}

/// Whether a ray to the right of a point crosses an edge.
pub(super) fn crosses(a: [f64; 2], b: [f64; 2], [x, y]: [f64; 2]) -> bool {
    if (a[1] > y) == (b[1] > y) {
        return false;
    }
    let (low, high) = if a[1] < b[1] { (a, b) } else { (b, a) };
    let crossing = low[0] + (y - low[1]) / (high[1] - low[1]) * (high[0] - low[0]);
    x < crossing
}

/// Points this near an edge, over its length, are on it: their way to the edge is round-off.
const ON_BORDER: f64 = 1e-9;

/// The edge that is nearest to a point, of those that were looked at: the first one of equals.
pub(super) struct Nearest {
    point: [f64; 2],
    square: f64,
    arm: [f64; 2],
    edge: [f64; 2],
    number: usize,
}

impl Nearest {
    pub fn new(point: [f64; 2]) -> Nearest {
        Nearest { point, square: f64::INFINITY, arm: [0.0; 2], edge: [0.0; 2], number: 0 }
    }

    pub fn point(&self) -> [f64; 2] {
        self.point
    }

    /// Distance to the nearest edge [m].
    pub fn distance(&self) -> f64 {
        self.square.sqrt()
    }

    pub fn look_at(&mut self, (number, a, b): (usize, [f64; 2], [f64; 2])) {
        let [x, y] = self.point;
        let (edge, from) = ([b[0] - a[0], b[1] - a[1]], [x - a[0], y - a[1]]);
        let squared = edge[0] * edge[0] + edge[1] * edge[1];
        let along = if squared > 0.0 {
            ((from[0] * edge[0] + from[1] * edge[1]) / squared).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let arm = [from[0] - along * edge[0], from[1] - along * edge[1]];
        let square = arm[0] * arm[0] + arm[1] * arm[1];
        if square < self.square || square == self.square && number < self.number {
            *self = Nearest { square, arm, edge, number, ..*self };
        }
    }

    /// Distance to the border [m], negative inside, and its gradient, of a polygon that goes round `anticlockwise`.
    pub fn signed_distance(&self, inside: bool, anticlockwise: impl FnOnce() -> bool) -> (f64, [f64; 2]) {
        let Nearest { arm, edge, .. } = *self;
        let (nearest, length) = (self.distance(), edge[0].hypot(edge[1]));
        let sign = if inside { -1.0 } else { 1.0 };
        let gradient = if nearest > ON_BORDER * length {
            arm.map(|a| sign * a / nearest)
        } else {
            // The edge's normal, out of the polygon.
            let turn = if anticlockwise() { 1.0 } else { -1.0 } / length;
            [edge[1] * turn, -edge[0] * turn]
        };
        (sign * nearest, gradient)
    }
}

/// Distance to the border [m], negative inside, and its gradient: to those edges of the border that count.
pub(super) fn distance_to_some(
    points: &[[f64; 2]],
    point: [f64; 2],
    counts: impl Fn([f64; 2], [f64; 2]) -> bool,
) -> (f64, [f64; 2]) {
    let mut nearest = Nearest::new(point);
    for (number, (a, b)) in edges(points).enumerate().filter(|&(_, (a, b))| counts(a, b)) {
        nearest.look_at((number, a, b));
    }
    nearest.signed_distance(contains(points, point), || !is_clockwise(points))
}

/// Whether the corners go round clockwise.
pub(super) fn is_clockwise(points: &[[f64; 2]]) -> bool {
    signed_area(points) < 0.0
}

/// Area [m^2] of a polygon that does not cross itself, whichever way round its corners go.
pub(super) fn area(points: &[[f64; 2]]) -> f64 {
    signed_area(points).abs()
}

/// Area [m^2], negative where the corners go round clockwise.
fn signed_area(points: &[[f64; 2]]) -> f64 {
    // Corners are taken from the first one, so that a small polygon far from the origin keeps its digits.
    let Some(&[x0, y0]) = points.first() else { return 0.0 };
    edges(points).map(|(a, b)| (a[0] - x0) * (b[1] - y0) - (b[0] - x0) * (a[1] - y0)).sum::<f64>() / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn distance(points: &[[f64; 2]], point: [f64; 2]) -> (f64, [f64; 2]) {
        distance_to_some(points, point, |_, _| true)
    }

    const L: [[f64; 2]; 6] = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];

    #[test]
    fn an_l_has_its_area_its_notch_and_its_distances() {
        assert_eq!(area(&L), 5.0);
        assert!(contains(&L, [0.5, 2.5]) && contains(&L, [2.5, 0.5]) && !contains(&L, [1.5, 1.5]));
        assert!((distance(&L, [2.0, 2.0]).0 - 1.0).abs() < 1e-15);
        assert!((distance(&L, [0.5, 2.0]).0 + 0.5).abs() < 1e-15);
        assert!((distance(&L, [4.0, 2.0]).0 - 2f64.sqrt()).abs() < 1e-15);
    }

    /// However an edge runs, and on whichever side of it round-off puts a point, its normal there is the edge's.
    #[test]
    fn on_an_edge_the_normal_is_the_edges() {
        for i in 1..200 {
            let angle = 0.0317 * f64::from(i);
            let turned =
                L.map(|[x, y]| [x * angle.cos() - y * angle.sin(), x * angle.sin() + y * angle.cos()]);
            let along = f64::from(i) / 200.0;
            let point = [0, 1].map(|k| turned[0][k] + along * (turned[1][k] - turned[0][k]));
            let (length, gradient) = distance(&turned, point);
            assert!(length.abs() < 1e-15);
            let off = [gradient[0] - angle.sin(), gradient[1] + angle.cos()];
            assert!(off[0].hypot(off[1]) < 1e-12, "{angle}: {gradient:?}");
        }
    }

    #[test]
    fn points_on_lattice_lines_through_corners_count_once() {
        // Two triangles tile the square: each lattice point of the half-open square is in exactly one.
        let (lower, upper) = ([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]], [[0.0, 0.0], [4.0, 4.0], [0.0, 4.0]]);
        for i in -1..=5 {
            for j in -1..=5 {
                let point = [f64::from(i), f64::from(j)];
                let held = usize::from(contains(&lower, point)) + usize::from(contains(&upper, point));
                assert_eq!(held, usize::from((0..4).contains(&i) && (0..4).contains(&j)), "{point:?}");
            }
        }
    }

    proptest! {
        #[test]
        fn a_fan_of_triangles_tiles_a_star(
            radii in prop::collection::vec(0.3..2.0f64, 5..12),
            point in prop::array::uniform2(-2.0..2.0f64),
        ) {
            let corner = |i: usize| {
                let angle = std::f64::consts::TAU * i as f64 / radii.len() as f64;
                [radii[i % radii.len()] * angle.cos(), radii[i % radii.len()] * angle.sin()]
            };
            let star: Vec<_> = (0..radii.len()).map(corner).collect();
            let next = |i: usize| star[(i + 1) % star.len()];
            let triangles: Vec<_> = (0..star.len()).map(|i| [[0.0, 0.0], star[i], next(i)]).collect();
            let held = triangles.iter().filter(|triangle| contains(*triangle, point)).count();
            prop_assert_eq!(held, usize::from(contains(&star, point)));
            let sum: f64 = triangles.iter().map(|triangle| area(triangle)).sum();
            prop_assert!((sum - area(&star)).abs() < 1e-12);
        }
    }
}
