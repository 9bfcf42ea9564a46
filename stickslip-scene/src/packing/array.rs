//! Regular arrays: copies of a shape on a lattice, in a ring, or along a path.

use super::Placement;
use crate::geometry::{Bounds, Rotation, Shape};
use crate::tensor::{Vector, cross};

/// Where copies of a shape lie.
#[derive(Clone, Debug)]
pub enum Array<'a> {
    /// On a lattice, each as the shape is.
    Lattice {
        /// How rows lie beside each other.
        kind: Lattice,
        /// Distance between the middles of neighbours [m].
        spacing: f64,
        /// How far the lattice goes.
        extent: Extent<'a>,
    },
    /// Around an axis: the first is the shape itself.
    Ring {
        /// A point of the axis [m].
        center: [f64; 3],
        /// Its direction; in the plane (0, 0, 1).
        axis: [f64; 3],
        /// How many.
        count: usize,
        /// Angle from each to the next, right-handed about the axis [rad].
        angle: f64,
        /// Whether they are turned by that angle, too.
        turned: bool,
    },
    /// At equal distances along a path, from its first point on.
    Path {
        /// Its corners, at least two, no two in a row the same [m]; if the last is the first, the path is closed.
        points: Vec<[f64; 3]>,
        /// Distance along the path between middles [m]; on a closed path changed by a little, so that copies come out
        /// even.
        spacing: f64,
        /// Whether they are turned with the path: what lies along x lies along the path.
        turned: bool,
    },
}

/// How rows of a lattice lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lattice {
    /// Rows side by side; in space cubes.
    Square,
    /// Every other row shifted by half of the spacing; in space layers of these, as balls lie closest.
    Hexagonal,
}

/// How far a lattice goes.
#[derive(Clone, Debug)]
pub enum Extent<'a> {
    /// So many along each axis, from the shape on.
    Counts([usize; 3]),
    /// All copies that lie in a container; the lattice begins in the lower corner of the box around it.
    Within(&'a Shape),
}

/// Why there is no array.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoArray {
    /// The shape has no bounds, or nothing is inside.
    Shape,
    /// The container has no bounds.
    Container,
    /// No copy lies in the container.
    NoRoom,
    /// About so many copies.
    TooMany(f64),
}

/// Copies of an array.
pub const MOST_COPIES: usize = 1_000_000;

/// How far a copy may reach out of its container, over the size of that: round-off.
const TOLERANCE: f64 = 1e-9;

impl Array<'_> {
    /// Each copy of a shape in its place.
    ///
    /// # Errors
    /// See [`NoArray`].
    pub fn place(&self, shape: &Shape, dimension: usize) -> Result<Vec<Placement>, NoArray> {
        let bounds = shape.bounds(dimension).filter(|bounds| !bounds.is_empty() && bounds.is_finite());
        let bounds = bounds.ok_or(NoArray::Shape)?;
        let middle = bounds.middle();
        // What is round is the same however it is turned.
        let is_turned = |turned: bool| turned && !matches!(shape, Shape::Ball { .. });
        match self {
            Array::Lattice { kind, spacing, extent: Extent::Counts(counts) } => {
                let all = counts.map(|count| count as f64).iter().product::<f64>();
                within_reason(all)?;
                Ok(kind.sites(*counts).map(|site| moved(middle, site.map(|x| x * spacing))).collect())
            }
            Array::Lattice { kind, spacing, extent: Extent::Within(container) } => {
                kind.fill(*spacing, container, &Copied { shape, bounds, dimension })
            }
            &Array::Ring { center, axis, count, angle, turned } => {
                within_reason(count as f64)?;
                let place = |i: usize| {
                    let angle = i as f64 * angle;
                    let position = Rotation::new(center, axis, angle, dimension).forward(middle);
                    Placement {
                        scale: 1.0,
                        position,
                        turn: (axis, if is_turned(turned) { angle } else { 0.0 }),
                    }
                };
                Ok((0..count).map(place).collect())
            }
            Array::Path { points, spacing, turned } => along(points, *spacing, is_turned(*turned)),
        }
    }
}

/// A shape that is copied.
struct Copied<'a> {
    shape: &'a Shape,
    bounds: Bounds,
    dimension: usize,
}

impl Lattice {
    /// Places of a lattice with neighbours at a distance of 1, row by row.
    ///
    /// In space the hexagonal one is the hexagonal close packing of balls of diameter 1.
    fn sites(self, counts: [usize; 3]) -> impl Iterator<Item = [f64; 3]> {
        let [columns, rows, layers] = counts;
        let rows = (0..layers).flat_map(move |k| (0..rows).map(move |j| (j, k)));
        rows.flat_map(move |(j, k)| (0..columns).map(move |i| self.site([i, j, k])))
    }

    fn site(self, [i, j, k]: [usize; 3]) -> [f64; 3] {
        let [x, y, z] = [i, j, k].map(|n| n as f64);
        let half = |n: usize| (n % 2) as f64;
        let [_, row, layer] = self.pitch();
        match self {
            Lattice::Square => [x, y, z],
            Lattice::Hexagonal => [x + 0.5 * half(j + k), row * (y + half(k) / 3.0), layer * z],
        }
    }

    /// From a copy to the next in its row, from row to row, and from layer to layer.
    fn pitch(self) -> [f64; 3] {
        match self {
            Lattice::Square => [1.0; 3],
            Lattice::Hexagonal => [1.0, 0.75_f64.sqrt(), (2.0_f64 / 3.0).sqrt()],
        }
    }

    /// The copies that lie in a container.
    fn fill(self, spacing: f64, container: &Shape, copied: &Copied) -> Result<Vec<Placement>, NoArray> {
        let Copied { shape, bounds, dimension } = copied;
        let around = container.bounds(*dimension).filter(Bounds::is_finite).ok_or(NoArray::Container)?;
        let (middle, size) = (bounds.middle(), bounds.size());
        let count = |k: usize| match k < *dimension {
            true => ((around.size()[k] - size[k]) / (spacing * self.pitch()[k]) + TOLERANCE).floor() + 1.0,
            false => 1.0,
        };
        let counts: [f64; 3] = std::array::from_fn(|k| count(k).max(0.0));
        within_reason(counts.iter().product())?;
        let first: [f64; 3] = std::array::from_fn(|k| match k < *dimension {
            true => around.min[k] + 0.5 * size[k] - middle[k],
            false => 0.0,
        });
        let extent = |size: [f64; 3]| Vector(size).norm();
        let tolerance = TOLERANCE * extent(around.size());
        // What is round needs no look at its surface, and nothing does that is far from the container's.
        let radius = match shape {
            Shape::Ball { radius, .. } => *radius,
            _ => 0.5 * extent(size),
        };
        let surface: Vec<[f64; 3]> = match shape {
            Shape::Ball { .. } => Vec::new(),
            _ => {
                let points = shape.surface(extent(size) / 32.0, *dimension, bounds);
                let corners =
                    bounds.corners().filter(|corner| shape.distance(*corner, *dimension) <= tolerance);
                points.into_iter().map(|point| point.position).chain(corners).collect()
            }
        };
        let holds = |point: [f64; 3]| container.distance(point, *dimension) <= tolerance;
        let fits = |by: [f64; 3]| {
            let depth = -container.distance((Vector(middle) + Vector(by)).0, *dimension);
            depth >= radius - tolerance
                || depth > 0.0
                    && !surface.is_empty()
                    && surface.iter().all(|point| holds((Vector(*point) + Vector(by)).0))
        };
        let places: Vec<Placement> = self
            .sites(counts.map(|count| count as usize))
            .map(|site| std::array::from_fn(|k| first[k] + spacing * site[k]))
            .filter(|by| fits(*by))
            .map(|by| moved(middle, by))
            .collect();
        if places.is_empty() { Err(NoArray::NoRoom) } else { Ok(places) }
    }
}

/// The shape with its middle here, moved by so much.
fn moved(middle: [f64; 3], by: [f64; 3]) -> Placement {
    Placement { scale: 1.0, position: (Vector(middle) + Vector(by)).0, turn: ([0.0, 0.0, 1.0], 0.0) }
}

fn within_reason(count: f64) -> Result<(), NoArray> {
    if count <= MOST_COPIES as f64 { Ok(()) } else { Err(NoArray::TooMany(count)) }
}

/// Copies along a path.
fn along(points: &[[f64; 3]], spacing: f64, turned: bool) -> Result<Vec<Placement>, NoArray> {
    let sides = || points.windows(2).map(|pair| (Vector(pair[0]), Vector(pair[1]) - Vector(pair[0])));
    let length: f64 = sides().map(|(_, side)| side.norm()).sum();
    let is_closed = points.first() == points.last();
    let (count, spacing) = match is_closed {
        true => {
            let count = (length / spacing).round().max(1.0);
            (count, length / count)
        }
        false => ((length / spacing + TOLERANCE).floor() + 1.0, spacing),
    };
    within_reason(count)?;
    let mut sides = sides().peekable();
    let (mut before, mut places) = (0.0, Vec::new());
    for i in 0..count as usize {
        let at = i as f64 * spacing;
        while let Some((_, side)) = sides.peek().filter(|(_, side)| before + side.norm() <= at) {
            before += side.norm();
            // Round-off may put the last copy beyond the last side.
            if before >= length * (1.0 - TOLERANCE) {
                before -= side.norm();
                break;
            }
            sides.next();
        }
        let Some((from, side)) = sides.peek() else { break };
        let along = *side / side.norm();
        let turn = if turned { turn_to(along.0) } else { ([0.0, 0.0, 1.0], 0.0) };
        places.push(Placement { scale: 1.0, position: (*from + along * (at - before)).0, turn });
    }
    Ok(places)
}

/// The smallest turn of the x axis to a direction: axis and angle [rad].
fn turn_to(direction: [f64; 3]) -> ([f64; 3], f64) {
    let axis = cross([1.0, 0.0, 0.0], direction);
    let angle = libm::atan2(Vector(axis).norm(), direction[0]);
    // Straight back, about whichever axis.
    if axis == [0.0; 3] { ([0.0, 0.0, 1.0], angle) } else { (axis, angle) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lattice(kind: Lattice, extent: Extent) -> Array {
        Array::Lattice { kind, spacing: 1.0, extent }
    }

    fn distance(a: &Placement, b: &Placement) -> f64 {
        (Vector(a.position) - Vector(b.position)).norm()
    }

    #[test]
    fn neighbours_on_lattices_are_a_spacing_apart() {
        for (kind, dimension, around) in [
            (Lattice::Square, 2, 4),
            (Lattice::Hexagonal, 2, 6),
            (Lattice::Square, 3, 6),
            (Lattice::Hexagonal, 3, 12),
        ] {
            let ball = Shape::ball([0.3, 0.1, 0.0], 0.5);
            let counts = [5, 5, if dimension == 3 { 5 } else { 1 }];
            let places = lattice(kind, Extent::Counts(counts)).place(&ball, dimension).unwrap();
            assert!((Vector(places[0].position) - Vector([0.3, 0.1, 0.0])).norm() < 1e-15);
            let mut most = 0;
            for one in &places {
                let others = places.iter().filter(|other| *other != one);
                assert!(others.clone().all(|other| distance(one, other) > 1.0 - 1e-12));
                most = most.max(others.filter(|other| distance(one, other) < 1.0 + 1e-12).count());
            }
            assert_eq!(most, around, "{kind:?} in {dimension} dimensions");
        }
    }

    #[test]
    fn a_container_holds_what_lies_in_it() {
        let disk = Shape::disk([7.0, 7.0], 0.5);
        let square = Shape::rectangle([1.0, 2.0], [5.0, 4.0]);
        let filled = |kind, shape: &Shape, container: &Shape| {
            lattice(kind, Extent::Within(container)).place(shape, 2).map(|places| places.len())
        };
        assert_eq!(filled(Lattice::Square, &disk, &square), Ok(8));
        // Two rows, of four and of three; a third row would need 1 + 2 * 0.866.
        assert_eq!(filled(Lattice::Hexagonal, &disk, &square), Ok(7));
        let brick = Shape::rectangle([0.0, 0.0], [1.0, 0.5]);
        assert_eq!(filled(Lattice::Square, &brick, &square), Ok(8));
        let round = Shape::disk([0.0, 0.0], 2.0);
        let places = lattice(Lattice::Square, Extent::Within(&round)).place(&brick, 2).unwrap();
        for place in &places {
            let corners = place.shape(&brick, 2).bounds(2).unwrap();
            assert!(corners.corners().all(|corner| round.distance(corner, 2) < 1e-8), "{place:?}");
        }
        // Of the rows of four, the middle two of all but the lowest.
        assert_eq!(places.len(), 6);
        assert_eq!(filled(Lattice::Square, &round, &square), Err(NoArray::NoRoom));
        let below = Shape::half_space([0.0; 3], [0.0, 1.0, 0.0]);
        assert_eq!(filled(Lattice::Square, &disk, &below), Err(NoArray::Container));
        assert_eq!(filled(Lattice::Square, &below, &square), Err(NoArray::Shape));
    }

    #[test]
    fn a_ring_turns_its_copies() {
        let blade = Shape::rectangle([1.0, -0.1], [2.0, 0.1]);
        let quarter = std::f64::consts::FRAC_PI_2;
        let ring =
            Array::Ring { center: [0.0; 3], axis: [0.0, 0.0, 1.0], count: 4, angle: quarter, turned: true };
        let copies: Vec<Shape> =
            ring.place(&blade, 2).unwrap().iter().map(|place| place.shape(&blade, 2)).collect();
        assert_eq!(copies[0], blade);
        for (copy, tip) in copies.iter().zip([[1.9, 0.05], [-0.05, 1.9], [-1.9, -0.05], [0.05, -1.9]]) {
            assert!(copy.contains([tip[0], tip[1], 0.0], 2), "{copy:?} {tip:?}");
        }
    }

    #[test]
    fn copies_along_a_path_are_a_spacing_apart_and_look_along_it() {
        let brick = Shape::rectangle([-0.4, -0.1], [0.4, 0.1]);
        let points = vec![[0.0; 3], [3.0, 0.0, 0.0], [3.0, 3.0, 0.0]];
        let path = Array::Path { points: points.clone(), spacing: 1.0, turned: true };
        let places = path.place(&brick, 2).unwrap();
        let at: Vec<[f64; 2]> = places.iter().map(|place| [place.position[0], place.position[1]]).collect();
        assert_eq!(at, [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [3.0, 1.0], [3.0, 2.0], [3.0, 3.0]]);
        assert!(places[5].shape(&brick, 2).contains([3.05, 2.35, 0.0], 2));
        let mut closed = points;
        closed.push([0.0; 3]);
        let path = Array::Path { points: closed, spacing: 1.0, turned: false };
        // 6 + 3 sqrt(2) is ten spacings and a quarter.
        assert_eq!(path.place(&brick, 2).unwrap().len(), 10);
    }
}
