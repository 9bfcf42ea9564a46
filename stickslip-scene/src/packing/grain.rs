//! A grain: where its surface is, whatever its shape.

use super::Placement;
use super::walls::Wall;
use crate::geometry::{Curved, Shape, SignedDistance};
use crate::tensor::{Matrix, Vector, cross};
use std::f64::consts::TAU;

/// A grain in its place.
#[derive(Clone, Copy, Debug)]
pub struct Grain {
    pub scale: f64,
    /// Of the middle of its box [m].
    pub position: [f64; 3],
    pub orientation: Matrix<f64>,
}

impl Grain {
    pub fn placement(&self) -> Placement {
        let [[a, b, c], [d, e, f], [g, h, i]] = self.orientation.0;
        // The vector of the antisymmetric part has length sin, the trace is 1 + 2 cos.
        let axis = [h - f, c - g, d - b];
        let twice_sine = Vector(axis).norm();
        let angle = libm::atan2(twice_sine, a + e + i - 1.0);
        let axis =
            if twice_sine > 1e-9 { axis.map(|x| x / twice_sine) } else { half_turn_axis(&self.orientation) };
        Placement { scale: self.scale, position: self.position, turn: (axis, angle) }
    }

    /// Where its middle is [m], and its size.
    pub fn ball(&self) -> [f64; 4] {
        let [x, y, z] = self.position;
        [x, y, z, self.scale]
    }

    /// Turns it on about its middle, by a vector along the axis with the angle as its length [rad].
    pub fn turn(&mut self, by: [f64; 3]) {
        self.orientation = Matrix::rotation_by(by) * self.orientation;
    }

    /// A direction of the undeformed grain as it is now.
    fn forward(&self, direction: [f64; 3]) -> [f64; 3] {
        self.orientation.times(direction)
    }

    /// A direction of the grain as it is now, before it was turned.
    fn back(&self, direction: [f64; 3]) -> [f64; 3] {
        self.orientation.transpose().times(direction)
    }
}

/// The axis of a rotation by nothing or by half a turn: n n' = (Q + I) / 2.
fn half_turn_axis(q: &Matrix<f64>) -> [f64; 3] {
    let largest = (0..3).max_by(|&i, &j| q.0[i][i].total_cmp(&q.0[j][j])).unwrap_or(2);
    let column: [f64; 3] =
        std::array::from_fn(|i| 0.5 * (q.0[i][largest] + if i == largest { 1.0 } else { 0.0 }));
    Vector(column).direction().map_or([0.0, 0.0, 1.0], |axis| axis.0)
}

/// The shape of all grains, about the middle of its box.
pub struct GrainShape<'a> {
    shape: &'a Shape,
    middle: [f64; 3],
    /// Radius of a ball about the middle that holds it [m].
    pub radius: f64,
    /// Points of its surface about the middle; none of a ball, which is known without [m].
    pub points: Vec<[f64; 3]>,
    /// Distances on a lattice, where the shape is slow to ask.
    lattice: Option<LevelLattice>,
    /// How far grains keep apart for what lies between the points of their surfaces, over their radius [-].
    between: f64,
    dimension: usize,
}

/// How far grains that are not balls stay apart for what lies between the points of their surfaces, over their radius,
/// in the plane and in space: two edges at right angles are in each other by half the distance of their points at most.
const BETWEEN: [f64; 2] = [0.01, 0.05];

/// The same of grains that are several shapes combined, whose edges are not all known.
const BETWEEN_PARTS: [f64; 2] = [0.1, 0.15];

/// How near to the surface points of an edge lie on it, over the size: those of a part may lie in another one.
const ON_SURFACE: f64 = 1e-6;

/// Points of a surface along the radius.
const POINTS: [f64; 2] = [12.0, 5.0];

/// Points of an edge along the radius.
const ALONG_EDGES: f64 = 12.0;

/// What one grain does to another that it overlaps, or nearly.
#[derive(Clone, Copy, Debug, Default)]
pub struct Push {
    /// Sum over the places of overlap of depth times direction [m].
    pub force: [f64; 3],
    /// Of their moments about the middle of the other [m^2].
    pub moment: [f64; 3],
    /// Deepest overlap of what is asked for, over the grain's size; negative where there is none [-].
    pub excess: f64,
}

impl Push {
    pub const NONE: Push = Push { force: [0.0; 3], moment: [0.0; 3], excess: f64::NEG_INFINITY };

    fn add(&mut self, depth: f64, out: [f64; 3], arm: [f64; 3]) {
        let force = out.map(|n| n * depth);
        let moment = cross(arm, force);
        for k in 0..3 {
            self.force[k] += force[k];
            self.moment[k] += moment[k];
        }
    }

    /// As of surfaces that are so many times as stiff.
    pub fn times(self, stiffness: f64) -> Push {
        let [force, moment] = [self.force, self.moment].map(|of| of.map(|x| stiffness * x));
        Push { force, moment, ..self }
    }

    pub fn join(&mut self, other: Push) {
        for k in 0..3 {
            self.force[k] += other.force[k];
            self.moment[k] += other.moment[k];
        }
        self.excess = self.excess.max(other.excess);
    }
}

impl<'a> GrainShape<'a> {
    /// `None` without bounds.
    pub fn new(shape: &'a Shape, dimension: usize) -> Option<Self> {
        let bounds = shape.bounds(dimension).filter(|bounds| !bounds.is_empty())?;
        let middle = bounds.middle();
        let about = |x: [f64; 3]| -> [f64; 3] {
            std::array::from_fn(|k| if k < dimension { x[k] - middle[k] } else { 0.0 })
        };
        if let Shape::Ball { radius, .. } = shape {
            return Some(GrainShape {
                shape,
                middle,
                radius: *radius,
                points: Vec::new(),
                lattice: None,
                between: 0.0,
                dimension,
            });
        }
        let size = Vector(bounds.size()).norm();
        let spacing = 0.5 * size / POINTS[dimension - 2];
        let mut points: Vec<_> = shape
            .surface(spacing, dimension, &bounds)
            .into_iter()
            .map(|point| about(point.position))
            .collect();
        let along = 0.5 * size / ALONG_EDGES;
        let on_surface = |&x: &[f64; 3]| shape.distance(x, dimension).abs() < ON_SURFACE * size;
        let on_edges = edges(shape, dimension).into_iter().flat_map(|edge| on_edge(edge, along));
        points.extend(on_edges.filter(on_surface).map(about));
        let radius = points.iter().map(|&point| Vector(point).norm()).fold(0.0, f64::max);
        let lattice = is_slow(shape, dimension).then(|| LevelLattice::new(shape, middle, radius));
        let between = if is_combined(shape) { BETWEEN_PARTS } else { BETWEEN }[dimension - 2];
        (radius > 0.0).then_some(GrainShape { shape, middle, radius, points, lattice, between, dimension })
    }

    /// The ball that holds it, in its stead.
    pub fn ball(&self) -> GrainShape<'a> {
        GrainShape { points: Vec::new(), lattice: None, between: 0.0, ..*self }
    }

    /// How far grains keep apart, over their radius, beside the gap.
    pub fn apart(&self) -> f64 {
        self.between
    }

    /// What `other` and its surface do to `grain`, which are to be `gap` [m] apart, and on the way `extra` of their
    /// radii more.
    pub fn push(&self, (grain, other): (&Grain, &Grain), gap: f64, extra: f64) -> Push {
        let arm: [f64; 3] = std::array::from_fn(|k| grain.position[k] - other.position[k]);
        let reach = self.radius * (grain.scale + other.scale);
        let beyond = gap + (extra + self.apart()) * reach;
        let mut push = Push::NONE;
        if Vector(arm).norm() >= reach + beyond {
            return push;
        }
        let size = self.radius * grain.scale.min(other.scale);
        let mut deepest = f64::NEG_INFINITY;
        // The points of one in the other, both ways round.
        for (of, inside, sign) in [(grain, other, 1.0), (other, grain, -1.0)] {
            let near = self.radius * inside.scale + beyond;
            for &point in &self.points {
                let turned = of.forward(point);
                let from: [f64; 3] =
                    std::array::from_fn(|k| of.position[k] + of.scale * turned[k] - inside.position[k]);
                if from.iter().map(|x| x * x).sum::<f64>() >= near * near {
                    continue;
                }
                let level = self.level(inside.back(from).map(|x| x / inside.scale));
                let depth = beyond - level.distance * inside.scale;
                if depth > 0.0 {
                    deepest = deepest.max(depth);
                    let out = inside.forward(level.gradient).map(|n| sign * n);
                    let at = std::array::from_fn(|k| from[k] + inside.position[k] - grain.position[k]);
                    push.add(depth, out, at);
                }
            }
        }
        push.excess = (deepest - extra * reach) / size;
        push
    }

    /// The same of balls, by their middles and sizes.
    pub fn push_ball(&self, ([x, y, z, scale], other): (&[f64; 4], &[f64; 4]), gap: f64, extra: f64) -> Push {
        let arm = [x - other[0], y - other[1], z - other[2]];
        let reach = self.radius * (scale + other[3]);
        let beyond = gap + (extra + self.apart()) * reach;
        let mut push = Push::NONE;
        let apart = Vector(arm).norm();
        if apart >= reach + beyond {
            return push;
        }
        let out = if apart > 0.0 { arm.map(|x| x / apart) } else { [1.0, 0.0, 0.0] };
        let depth = reach + beyond - apart;
        push.force = out.map(|n| n * depth);
        push.excess = (depth - extra * reach) / (self.radius * scale.min(other[3]));
        push
    }

    /// What a wall does to a grain.
    pub fn held(&self, grain: &Grain, wall: &Wall, gap: f64, extra: f64) -> Push {
        let size = self.radius * grain.scale;
        let beyond = gap + (extra + self.apart()) * size;
        let level = wall.level(grain.position, self.dimension);
        let mut push = Push::NONE;
        if level.distance + size + beyond <= 0.0 {
            return push;
        }
        if self.points.is_empty() {
            let depth = level.distance + size + beyond;
            push.add(depth, level.gradient.map(|n| -n), [0.0; 3]);
            push.excess = (depth - extra * size) / size;
            return push;
        }
        for &point in &self.points {
            let turned = grain.forward(point).map(|x| x * grain.scale);
            let level = wall.level(std::array::from_fn(|k| grain.position[k] + turned[k]), self.dimension);
            let depth = level.distance + beyond;
            if depth > 0.0 {
                push.add(depth, level.gradient.map(|n| -n), turned);
                push.excess = push.excess.max((depth - extra * size) / size);
            }
        }
        push
    }

    fn level(&self, about: [f64; 3]) -> SignedDistance {
        let direct = || self.shape.level(std::array::from_fn(|k| about[k] + self.middle[k]), self.dimension);
        self.lattice.as_ref().map_or_else(direct, |lattice| lattice.level(about))
    }
}

/// Where a shape has edges; in the plane only their ends count, its corners.
fn edges(shape: &Shape, dimension: usize) -> Vec<[[f64; 3]; 2]> {
    match shape {
        Shape::Box { min, max } => {
            let base = vec![[min[0], min[1]], [max[0], min[1]], [max[0], max[1]], [min[0], max[1]]];
            prism(&base, [min[2], max[2]], dimension)
        }
        Shape::Polygon { points, height } => prism(points, *height, dimension),
        Shape::Cylinder { start, end, radius } if dimension == 3 => {
            let axis = Vector(*end) - Vector(*start);
            let least = (0..3).min_by(|&i, &j| axis.0[i].abs().total_cmp(&axis.0[j].abs())).unwrap_or(0);
            let across = cross(axis.0, std::array::from_fn(|k| if k == least { 1.0 } else { 0.0 }));
            let first = Vector(across) / Vector(across).norm();
            let second = Vector(cross(axis.0, first.0)) / axis.norm();
            let rim = |center: [f64; 3]| {
                let at = move |i: usize| {
                    let angle = TAU * i as f64 / RIM as f64;
                    (Vector(center) + (first * libm::cos(angle) + second * libm::sin(angle)) * *radius).0
                };
                (0..RIM).map(move |i| [at(i); 2])
            };
            rim(*start).chain(rim(*end)).collect()
        }
        Shape::Mesh(mesh) => mesh.triangle_corners().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]).collect(),
        Shape::Rotated { shape, center, axis, angle } => {
            let turned = |corner| Shape::turned_point(corner, (*center, *axis, *angle), dimension);
            edges(shape, dimension).into_iter().map(|edge| edge.map(turned)).collect()
        }
        Shape::Union(shapes) | Shape::Intersection(shapes) | Shape::Difference(shapes) => {
            shapes.iter().flat_map(|shape| edges(shape, dimension)).collect()
        }
        Shape::Revolved(revolved) if dimension == 3 => {
            revolved.rims(RIM).into_iter().map(|point| [point; 2]).collect()
        }
        Shape::Ball { .. }
        | Shape::Cylinder { .. }
        | Shape::HalfSpace { .. }
        | Shape::Revolved(_)
        | Shape::Curved(_) => Vec::new(),
    }
}

fn is_combined(shape: &Shape) -> bool {
    match shape {
        Shape::Union(_) | Shape::Intersection(_) | Shape::Difference(_) => true,
        Shape::Rotated { shape, .. } => is_combined(shape),
        _ => false,
    }
}

/// Points around the end of a cylinder.
const RIM: usize = 72;

fn prism(points: &[[f64; 2]], [low, high]: [f64; 2], dimension: usize) -> Vec<[[f64; 3]; 2]> {
    let count = points.len();
    let at = |i: usize, z: f64| [points[i % count][0], points[i % count][1], z];
    if dimension == 2 {
        return (0..count).map(|i| [at(i, 0.0); 2]).collect();
    }
    let around = |z: f64| (0..count).map(move |i| [at(i, z), at(i + 1, z)]);
    around(low).chain(around(high)).chain((0..count).map(|i| [at(i, low), at(i, high)])).collect()
}

/// Points of an edge, no further apart than `spacing`, without its end.
fn on_edge([from, to]: [[f64; 3]; 2], spacing: f64) -> impl Iterator<Item = [f64; 3]> {
    let way: [f64; 3] = std::array::from_fn(|k| to[k] - from[k]);
    let count = (Vector(way).norm() / spacing).ceil().max(1.0) as usize;
    (0..count).map(move |i| std::array::from_fn(|k| from[k] + way[k] * (i as f64 / count as f64)))
}

/// In the plane, what takes a lattice of space is never.
fn is_slow(shape: &Shape, dimension: usize) -> bool {
    let is_slow = |shape: &Shape| is_slow(shape, dimension);
    match shape {
        Shape::Mesh(_) | Shape::Revolved(_) | Shape::Curved(Curved::Superquadric(_)) => dimension == 3,
        Shape::Rotated { shape, .. } => is_slow(shape),
        Shape::Union(shapes) | Shape::Intersection(shapes) | Shape::Difference(shapes) => {
            shapes.iter().any(is_slow)
        }
        _ => false,
    }
}

/// Distances to a shape at the points of a cubic lattice about its middle.
struct LevelLattice {
    lower: f64,
    spacing: f64,
    levels: Vec<f64>,
}

/// Points of the lattice along a side.
const SIDE: usize = 49;

impl LevelLattice {
    fn new(shape: &Shape, middle: [f64; 3], radius: f64) -> Self {
        let lower = -1.2 * radius;
        let spacing = -2.0 * lower / (SIDE - 1) as f64;
        let mut levels = Vec::with_capacity(SIDE.pow(3));
        for n in 0..SIDE.pow(3) {
            let index = [n / (SIDE * SIDE), n / SIDE % SIDE, n % SIDE];
            let point = std::array::from_fn(|k| middle[k] + lower + spacing * index[k] as f64);
            levels.push(shape.distance(point, 3));
        }
        LevelLattice { lower, spacing, levels }
    }

    /// Linear between the points along each axis, as is its gradient.
    fn level(&self, x: [f64; 3]) -> SignedDistance {
        let along = x.map(|x| ((x - self.lower) / self.spacing).clamp(0.0, (SIDE - 1) as f64 - 1e-9));
        // From beyond the lattice, at least the way to it.
        let beyond: [f64; 3] = std::array::from_fn(|k| x[k] - self.lower - self.spacing * along[k]);
        let cell = along.map(|x| x as usize);
        let part: [f64; 3] = std::array::from_fn(|k| along[k] - cell[k] as f64);
        let (mut distance, mut gradient) = (0.0, [0.0; 3]);
        for corner in 0..8_usize {
            let upper = [corner >> 2 & 1, corner >> 1 & 1, corner & 1];
            let [i, j, l]: [usize; 3] = std::array::from_fn(|k| cell[k] + upper[k]);
            let level = self.levels[(i * SIDE + j) * SIDE + l];
            let weight: [f64; 3] =
                std::array::from_fn(|k| if upper[k] == 1 { part[k] } else { 1.0 - part[k] });
            distance += level * weight[0] * weight[1] * weight[2];
            for k in 0..3 {
                let sign = if upper[k] == 1 { 1.0 } else { -1.0 };
                gradient[k] += sign * level * weight[(k + 1) % 3] * weight[(k + 2) % 3];
            }
        }
        let gradient = Vector(gradient).direction().map_or([0.0; 3], |direction| direction.0);
        SignedDistance { distance: distance + Vector(beyond).norm(), gradient }
    }
}
